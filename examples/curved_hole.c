/* Where does a string press against a curved hole?
 *
 * The hole is given as a survey: depth, inclination and azimuth at a few stations. The string is bent into it and lies
 * at rest, without friction; the rig holds its near end. Side forces come from the weight and from the bending that the
 * hole forces on the pipes. At the ends of the bend, where the curvature jumps, the string cuts the corner within its
 * clearance and does not touch. */
#include <drillmbd/drillmbd.h>
#include <math.h>
#include <stdio.h>

#include "command_line.h"

#define PIPES 60
#define DEGREE (3.14159265358979323846 / 180.0)

/* Measured depth [m], inclination from the downward vertical [rad], azimuth [rad]. Horizontal for 20 m, then up by 6
 * degrees over 20 m, then straight on. */
static const double survey[][3] = {
    {0.0, 90.0 * DEGREE, 0.0}, {20.0, 90.0 * DEGREE, 0.0}, {40.0, 96.0 * DEGREE, 0.0}, {70.0, 96.0 * DEGREE, 0.0}};

static int32_t describe(dmb_model **model, dmb_id *string)
{
    const dmb_segment rest = dmb_segment_default();
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    int32_t status = dmb_model_create(NULL, model);
    wall.survey = &survey[0][0];
    wall.survey_count = sizeof survey / sizeof survey[0];
    pipe.elements = 2;
    if (status >= 0) status = dmb_model_add_wall(*model, &wall, NULL);
    if (status >= 0) status = dmb_model_add_pipes(*model, &pipe, PIPES, string);
    if (status >= 0) status = dmb_model_add_time_function(*model, &rest, 1, &drive.time_function);
    drive.component = DMB_X;
    if (status >= 0) status = dmb_model_add_drive(*model, &drive, NULL);
    drive.component = DMB_RX;
    if (status >= 0) status = dmb_model_add_drive(*model, &drive, NULL);
    return status < 0 ? status : dmb_model_compile(*model, NULL);
}

/* Side force of one pipe: that of all its places of contact, upwards where the upper wall holds it. */
static int32_t side_forces(const dmb_sim *sim, uint32_t points, double upward[PIPES], double total[PIPES])
{
    dmb_contact contact = dmb_contact_default();
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < PIPES; ++i) upward[i] = total[i] = 0.0;
    for (uint32_t number = 0; status >= 0 && number < points; ++number) {
        status = dmb_query_contact(sim, number, &contact);
        if (status < 0 || contact.pipe >= PIPES) continue; /* the rig end belongs to no pipe */
        total[contact.pipe] += contact.normal_force;
        upward[contact.pipe] += contact.normal_force * contact.normal[2];
    }
    return status;
}

static int32_t print_pipes(const dmb_sim *sim, dmb_id string, const double upward[PIPES], const double total[PIPES])
{
    dmb_pose pose = dmb_pose_default();
    dmb_section section = dmb_section_default();
    int32_t status = DMB_OK;
    printf("%6s %10s %12s %14s %14s %14s\n", "pipe", "depth [m]", "height [m]", "on wall [N]", "of that up [N]",
           "bending [N m]");
    for (uint32_t i = 4; status >= 0 && i < PIPES; i += 5) {
        const dmb_place middle = dmb_station(string, i, 0.5);
        status = dmb_query_pose(sim, middle, &pose);
        if (status >= 0) status = dmb_query_section(sim, middle, &section);
        if (status >= 0)
            printf("%6u %10.3f %12.5f %14.3f %14.3f %14.3f\n", i + 1, pose.depth, pose.position[2], total[i], upward[i],
                   hypot(section.force[4], section.force[5]));
    }
    return status;
}

static int32_t ask(dmb_model *model, dmb_sim *sim, dmb_id string)
{
    double upward[PIPES], total[PIPES], reaction[6];
    dmb_model_info info = dmb_model_info_default();
    dmb_contact_total sum = dmb_contact_total_default();
    int32_t status = dmb_model_get_info(model, &info);
    if (status >= 0) status = side_forces(sim, info.contact_points, upward, total);
    if (status >= 0) status = print_pipes(sim, string, upward, total);
    if (status >= 0) status = dmb_query_contact_total(sim, &sum);
    if (status >= 0) status = dmb_query_reaction(sim, string, reaction);
    if (status >= 0)
        printf("weight %.3f N, on the wall %.3f N at %u places, held by the rig %.3f N\n", 9.81 * info.mass,
               sum.normal_force, sum.closed, reaction[0]);
    return status;
}

int main(int count, char **words)
{
    if (count > 1) return command_line(count, words, "Where does a string press against a curved hole?", NULL, 0);
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    dmb_id string;
    dmb_static_report found = dmb_static_report_default();
    int32_t status = describe(&model, &string);
    if (status >= 0) status = dmb_sim_create(model, NULL, &sim);
    if (status >= 0) status = dmb_analysis_static(sim, NULL, &found);
    if (status >= 0) status = ask(model, sim, string);
    if (status < 0)
        fprintf(stderr, "%s: %s%s\n", dmb_status_text(status), dmb_model_message(model), dmb_sim_message(sim));
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return status < 0;
}
