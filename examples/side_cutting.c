/* A short assembly, tilted in a support and pushed aside, that turns and drills ahead: how fast it builds angle by its
 * tilt and by the steerability of its bit. */
#include <drillmbd/drillmbd.h>
#include <stdio.h>

#include "command_line.h"

static int32_t describe(dmb_model *model, double side_cutting, dmb_id *string)
{
    dmb_environment_def light = dmb_environment_def_default();
    dmb_string_def assembly = dmb_string_def_default();
    dmb_pipe_def collar = dmb_pipe_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_load_def push = dmb_load_def_default();
    dmb_joint_def support = dmb_joint_def_default();
    light.gravity[2] = 0.0;
    assembly.follows_hole = 0;
    assembly.start_free = DMB_FREE_ALL;
    assembly.rotation[2] = 0.01;
    assembly.velocity[0] = 0.02;
    assembly.velocity[3] = 10.0; /* rad/s */
    collar.kind = DMB_PIPE_RIGID;
    collar.length = 3.0;
    bit.diameter = 0.0; /* it makes its own hole */
    bit.side_cutting = side_cutting;
    int32_t status = dmb_model_set_environment(model, &light);
    if (status >= 0) status = dmb_model_add_string(model, &assembly, string);
    if (status >= 0) status = dmb_model_add_pipes(model, &collar, 1, NULL);
    if (status >= 0) status = dmb_model_add_bit(model, &bit, NULL);
    support.kind = DMB_JOINT_POINT_ON_LINE; /* the rear end slides along the hole that is there */
    support.place_b = dmb_station(*string, 0, 0.0);
    push.place = dmb_station(*string, 0, 1.0);
    push.force[1] = 5.0;
    if (status >= 0) status = dmb_model_add_load(model, &push, NULL);
    if (status >= 0) status = dmb_model_add_joint(model, &support, NULL);
    return status < 0 ? status : dmb_model_compile(model, NULL);
}

static int32_t drill(double side_cutting)
{
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    dmb_id string;
    dmb_pose rear = dmb_pose_default(), front = dmb_pose_default();
    int32_t status = dmb_model_create(NULL, &model);
    if (status >= 0) status = describe(model, side_cutting, &string);
    if (status >= 0) status = dmb_sim_create(model, NULL, &sim);
    for (int i = 0; i < 3000 && status >= 0; i++) status = dmb_sim_step(sim, 0.01, NULL);
    if (status >= 0) status = dmb_query_pose(sim, dmb_station(string, 0, 0.0), &rear);
    if (status >= 0) status = dmb_query_pose(sim, dmb_station(string, 0, 1.0), &front);
    if (status >= 0)
        printf("side cutting %4.2f: after %.3f m the tilt is %.5f rad\n", side_cutting, rear.position[0],
               (front.position[1] - rear.position[1]) / 3.0);
    if (status < 0) fprintf(stderr, "%s\n", dmb_model_message(model));
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return status;
}

int main(int count, char **words)
{
    if (count > 1)
        return command_line(count, words,
                            "A short assembly, tilted in a support and pushed aside, that turns and drills ahead: how "
                            "fast it builds angle by its tilt and by the steerability of its bit.",
                            NULL, 0);
    const double steerability[] = {0.01, 0.5, 1.0};
    for (int i = 0; i < 3; i++)
        if (drill(steerability[i]) < 0) return 1;
    return 0;
}
