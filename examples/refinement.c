/* How fine a mesh? Elements per pipe against the state of rest on the wall and against a smooth motion.
 *
 * Between nodes the element is exact for linear statics and of fourth order for motion; the wall acts at the nodes,
 * which is quadrature of second order, disturbed where the string lifts off between two nodes. The table shows both:
 * values, change from the mesh before, and the order that two changes in a row tell. */
#include <drillmbd/drillmbd.h>
#include <math.h>
#include <stdio.h>

#include "command_line.h"

enum { MESHES = 5, ANSWERS = 4 };
static const char *const heads[ANSWERS] = {"support force [N]", "wall force sum [N]", "z of pipe 3 [mm]", "swing [mm]"};

static int fail(const char *message)
{
    fprintf(stderr, "%s\n", message);
    return -1;
}

/* A 20-pipe string at rest in its hole, the wall soft enough for its bed to be longer than an element. */
static int rest(unsigned elements, double answer[3])
{
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    dmb_id string;
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_contact_total sum = dmb_contact_total_default();
    dmb_pose pose = dmb_pose_default();
    double reaction[6];
    wall.stiffness = 1e5;
    pipe.elements = elements;
    dmb_model_create(NULL, &model);
    dmb_model_add_wall(model, &wall, NULL);
    dmb_model_add_pipes(model, &pipe, 20, &string);
    if (dmb_model_compile(model, NULL) < 0) return fail(dmb_model_message(model));
    dmb_sim_create(model, NULL, &sim);
    if (dmb_analysis_static(sim, NULL, NULL) < 0) return fail(dmb_sim_message(sim));
    dmb_query_reaction(sim, string, reaction);
    dmb_query_contact_total(sim, &sum);
    dmb_query_pose(sim, dmb_station(string, 2, 1.0), &pose);
    answer[0] = reaction[2];
    answer[1] = sum.normal_force;
    answer[2] = 1e3 * pose.position[2];
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return 0;
}

/* Five pipes held at the rig, no wall, at rest under a dead load at the tip that a quarter of a second takes away. */
static int swing(unsigned elements, double *answer)
{
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    dmb_string_def held = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_segment term = dmb_segment_default();
    dmb_pose pose = dmb_pose_default();
    dmb_sim_options options = dmb_sim_options_default();
    dmb_id string;
    options.newton_tolerance = 1e-10; /* what iterations leave over must not hide what refinement changes */
    held.start_free = DMB_FREE_NONE;
    pipe.elements = elements;
    term.kind = DMB_SEGMENT_STEP5;
    term.x1 = 0.25;
    term.h0 = 1.0;
    dmb_model_create(NULL, &model);
    dmb_model_add_string(model, &held, &string);
    dmb_model_add_pipes(model, &pipe, 5, &string);
    dmb_model_add_time_function(model, &term, 1, &load.time_function);
    load.place = dmb_station(string, 4, 1.0);
    load.force[1] = 500.0;
    dmb_model_add_load(model, &load, NULL);
    if (dmb_model_compile(model, NULL) < 0) return fail(dmb_model_message(model));
    dmb_sim_create(model, &options, &sim);
    if (dmb_analysis_static(sim, NULL, NULL) < 0) return fail(dmb_sim_message(sim));
    for (int i = 0; i < 1500; i++)
        if (dmb_sim_step(sim, 2e-4, NULL) < 0) return fail(dmb_sim_message(sim));
    dmb_query_pose(sim, dmb_station(string, 4, 1.0), &pose);
    *answer = 1e3 * pose.position[1];
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return 0;
}

int main(int count, char **words)
{
    if (count > 1) return command_line(count, words, "How fine a mesh?", NULL, 0);
    double value[MESHES][ANSWERS];
    for (int m = 0; m < MESHES; m++)
        if (rest(1U << m, value[m]) < 0 || swing(1U << m, &value[m][3]) < 0) return 1;
    for (int k = 0; k < ANSWERS; k++) {
        printf("%s\n  elements per pipe        value       change   order\n", heads[k]);
        for (int m = 0; m < MESHES; m++) {
            const double change = m > 0 ? value[m][k] - value[m - 1][k] : 0.0;
            const double before = m > 1 ? value[m - 1][k] - value[m - 2][k] : 0.0;
            printf("  %17d %12.6f", 1 << m, value[m][k]);
            if (m > 0) printf(" %12.2e", change);
            if (m > 1) printf(" %7.1f", log2(fabs(before / change)));
            printf("\n");
        }
    }
    return 0;
}
