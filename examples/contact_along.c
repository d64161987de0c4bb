/* A rod between two tool joints lies in a hole that bends: where it touches the wall, and with what force, when the
 * wall meets its nodes alone and when it meets points along its elements (contact_points). */
#include <drillmbd/drillmbd.h>
#include <stdio.h>

#include "command_line.h"

static int32_t describe(dmb_model *model, uint32_t elements, uint32_t points)
{
    const double level = 1.5707963267948966;
    const double survey[2][3] = {{0.0, level, 0.0}, {27.0, level - 0.4, 0.0}}; /* it drops: the rods press on top */
    dmb_environment_def around = dmb_environment_def_default();
    dmb_wall_def hole = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def rod = dmb_pipe_def_default();
    dmb_load_def pull = dmb_load_def_default();
    around.fluid_density = 1000.0;
    hole.survey = &survey[0][0];
    hole.survey_count = 2;
    hole.diameter = 0.096;
    hole.friction_law = DMB_FRICTION_NONE;
    string.start_free = DMB_FREE_NONE;
    rod.length = 9.0;
    rod.elements = elements;
    rod.contact_points = points;
    rod.joint_length = 0.3;
    rod.joint_outer_diameter = 0.085;
    pull.frame = DMB_FRAME_BODY;
    pull.force[0] = 60e3;
    int32_t status = dmb_model_set_environment(model, &around);
    if (status >= 0) status = dmb_model_add_wall(model, &hole, NULL);
    if (status >= 0) status = dmb_model_add_string(model, &string, &rod.string);
    if (status >= 0) status = dmb_model_add_pipes(model, &rod, 3, NULL);
    pull.place = dmb_station(rod.string, 2, 1.0);
    if (status >= 0) status = dmb_model_add_load(model, &pull, NULL);
    return status < 0 ? status : dmb_model_compile(model, NULL);
}

/* The middle rod between its tool joints: length on the wall, the force there, and what all points bear. */
static void tell(const dmb_sim *sim, uint32_t elements, uint32_t points)
{
    dmb_contact contact = dmb_contact_default();
    double touching = 0.0, force = 0.0, all = 0.0;
    for (uint32_t number = 0; dmb_query_contact(sim, number, &contact) >= 0; number++) {
        all += contact.normal_force;
        if (contact.pipe != 1 || !contact.closed) continue;
        touching += contact.length;
        force += contact.normal_force;
    }
    printf("%2u elements, %s: %4.2f m of the middle rod on the wall, %6.1f N; the whole string %6.1f N\n", elements,
           points == 0   ? "nodes alone"
           : points == 3 ? "3 points   "
                         : "5 points   ",
           touching, force, all);
}

static int32_t lay(uint32_t elements, uint32_t points)
{
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    int32_t status = dmb_model_create(NULL, &model);
    if (status >= 0) status = describe(model, elements, points);
    if (status >= 0) status = dmb_sim_create(model, NULL, &sim);
    if (status >= 0) status = dmb_analysis_static(sim, NULL, NULL);
    if (status >= 0) tell(sim, elements, points);
    if (status < 0) fprintf(stderr, "%s\n%s\n", dmb_model_message(model), dmb_sim_message(sim));
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return status;
}

int main(int count, char **words)
{
    if (count > 1)
        return command_line(count, words, "Contact of a rod between tool joints along its elements.", NULL, 0);
    return lay(3, 0) < 0 || lay(3, 5) < 0 || lay(6, 0) < 0 || lay(6, 5) < 0 || lay(24, 0) < 0 || lay(24, 5) < 0;
}
