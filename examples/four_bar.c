/* What must the motor of a four-bar linkage do? Steel rods between points of the y-z plane; x is the axis of a joint.
 * In space the four pins hold three equations more than a loop can take: the sim finds them and leaves them out. */
#include <drillmbd/drillmbd.h>
#include <math.h>
#include <stdio.h>

#include "command_line.h"

static const double at[4][2] = {{0.0, 0.0}, {0.0, 0.3}, {0.9, 0.7}, {0.6, 0.0}}; /* [m] y and z */

/* Crank, coupler and rocker, each pinned to the one before, then the rocker to the ground. */
static int32_t add_rods(dmb_model *model, dmb_id pins[4])
{
    dmb_joint_def pin = dmb_joint_def_default(); /* places are {0, 0}, the ground */
    int32_t status = DMB_OK;
    pin.kind = DMB_JOINT_REVOLUTE, pin.match = 1; /* the place on b: where that on a is at time 0 */
    for (int k = 0; k < 3; ++k) {
        const double dy = at[k + 1][0] - at[k][0], dz = at[k + 1][1] - at[k][1], length = hypot(dy, dz);
        dmb_body_def rod = dmb_body_def_default();
        rod.position[1] = at[k][0], rod.position[2] = at[k][1], rod.rotation[0] = atan2(dz, dy);
        rod.mass = 8.0 * length, rod.centre[1] = 0.5 * length;
        rod.inertia[0] = rod.inertia[2] = rod.mass * length * length / 12.0;
        if (status >= 0) status = dmb_model_add_body(model, &rod, &pin.place_b.part);
        if (status >= 0) status = dmb_model_add_joint(model, &pin, &pins[k]);
        pin.place_a = pin.place_b, pin.origin_a[1] = length;
    }
    pin.place_a = dmb_station((dmb_id){0, 0}, 0, 0.0), pin.origin_a[1] = at[3][0];
    return status < 0 ? status : dmb_model_add_joint(model, &pin, &pins[3]);
}

int main(int count, char **words)
{
    if (count > 1) return command_line(count, words, "What must the motor of a four-bar linkage do?", NULL, 0);
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    dmb_segment speed = dmb_segment_default();
    dmb_drive_def motor = dmb_drive_def_default();
    dmb_drive_state drive = dmb_drive_state_default();
    dmb_joint_state knee = dmb_joint_state_default();
    dmb_id pins[4], id;
    int32_t status = dmb_model_create(NULL, &model);
    if (status >= 0) status = add_rods(model, pins);
    speed.h0 = 6.283185307179586; /* one revolution a second, from the start */
    if (status >= 0) status = dmb_model_add_time_function(model, &speed, 1, &motor.time_function);
    motor.part = pins[0], motor.component = DMB_RX;
    if (status >= 0) status = dmb_model_add_drive(model, &motor, &id);
    if (status >= 0) status = dmb_model_compile(model, NULL);
    if (status >= 0) status = dmb_sim_create(model, NULL, &sim);
    for (int k = 0; k <= 1000 && status >= 0; ++k) {
        if (k % 125 == 0) {
            dmb_query_drive(sim, id, &drive), dmb_query_joint(sim, pins[1], &knee);
            printf(
                "crank %3.0f deg: coupler %9.5f deg, force at the knee %9.3f N, torque %9.4f N m, violation %.1e m\n",
                57.29577951308232 * drive.position, 57.29577951308232 * (drive.position + knee.position[DMB_RX]),
                hypot(knee.reaction[1], knee.reaction[2]), drive.force, knee.violation);
        }
        status = dmb_sim_step(sim, 1e-3, NULL);
    }
    if (status < 0) fprintf(stderr, "%s%s\n", dmb_model_message(model), dmb_sim_message(sim));
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return status < 0;
}
