/* The main job in one page: describe a drill string in a hole, compile it, run it, ask it. */
#include <drillmbd/drillmbd.h>
#include <stdio.h>

#include "command_line.h"

/* The rig moves its end of the string: up to `speed` within the first second. */
static int32_t add_drive(dmb_model *model, int32_t component, double speed)
{
    dmb_drive_def drive = dmb_drive_def_default();
    drive.component = component;
    const int32_t status = dmb_model_add_ramp(model, 0.0, speed, 0.0, 1.0, &drive.time_function);
    return status < 0 ? status : dmb_model_add_drive(model, &drive, NULL);
}

/* A hole of 94 mm, ten steel pipes of 1 m and a bit of 5 kg: what is not said here stays at its default. */
static int32_t describe(dmb_model *model, dmb_id *string)
{
    dmb_wall_def wall = dmb_wall_def_default();
    wall.diameter = 0.094;
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.outer_diameter = 0.073;
    pipe.inner_diameter = 0.061;
    dmb_bit_def bit = dmb_bit_def_default();
    bit.mass = 5.0;
    int32_t status = dmb_model_add_wall(model, &wall, NULL);
    if (status >= 0) status = dmb_model_add_pipes(model, &pipe, 10, string);
    if (status >= 0) status = dmb_model_add_bit(model, &bit, NULL);
    if (status >= 0) status = add_drive(model, DMB_X, 0.010); /* feed, m/s */
    if (status >= 0) status = add_drive(model, DMB_RX, 20.0); /* rotation, rad/s */
    return status < 0 ? status : dmb_model_compile(model, NULL);
}

int main(int count, char **words)
{
    if (count > 1)
        return command_line(count, words,
                            "The main job in one page: describe a drill string in a hole, compile it, run it, ask it.",
                            NULL, 0);
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    dmb_id string;
    dmb_pose pose = dmb_pose_default();
    dmb_contact_total contact = dmb_contact_total_default();
    int32_t status = dmb_model_create(NULL, &model);
    if (status >= 0) status = describe(model, &string);
    if (status >= 0) status = dmb_sim_create(model, NULL, &sim);
    if (status >= 0) status = dmb_analysis_static(sim, NULL, NULL); /* lies down on the low side of the hole */
    if (status >= 0) status = dmb_sim_steps(sim, 1e-3, 2000, NULL, NULL);

    /* Pipes count from 0 at the rig; 1.0 is the far end of a pipe. */
    if (status >= 0) status = dmb_query_pose(sim, dmb_station(string, 9, 1.0), &pose);
    if (status >= 0) status = dmb_query_contact_total(sim, &contact);
    if (status < 0)
        fprintf(stderr, "%s: %s%s\n", dmb_status_text(status), dmb_model_message(model), dmb_sim_message(sim));
    printf("time %.3f s, pipe 10: %.3f mm along, %.3f mm sideways, %.3f mm up\n", dmb_sim_time(sim),
           1e3 * pose.displacement[0], 1e3 * pose.displacement[1], 1e3 * pose.displacement[2]);
    printf("wall: %.1f N, friction %.2f N along and %.2f N around the pipes\n", contact.normal_force,
           contact.friction[0], contact.friction[1]);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return status < 0;
}
