/* Questions to the scenes, and their exact answers where known. */
#ifndef BENCH_ANSWERS_H
#define BENCH_ANSWERS_H

#include "scenes.h"

/* Two quantities at the present time: quantity_names. */
static int32_t scene_ask(const scene *s, const dmb_sim *sim, double values[2])
{
    const dmb_place tip = dmb_station(s->string, s->pipes - 1, 1.0);
    dmb_motion motion = dmb_motion_default();
    dmb_contact_total sum = dmb_contact_total_default();
    dmb_drive_state drive = dmb_drive_state_default();
    dmb_pose pose = dmb_pose_default();
    int32_t status = DMB_OK;
    values[0] = values[1] = 0.0;
    if (s->kind == SCENE_C) {
        motion.frame = DMB_FRAME_BODY;
        status = dmb_query_motion(sim, tip, &motion);
        values[0] = motion.velocity[3];
    } else if (s->kind == SCENE_R) {
        status = dmb_query_drive(sim, s->turn, &drive);
        if (status >= 0) status = dmb_query_pose(sim, tip, &pose);
        values[0] = drive.force;
        values[1] = 1e3 * pose.position[2];
    } else {
        status = dmb_query_rotation(sim, tip, &values[0]);
        if (status >= 0) status = dmb_query_contact_total(sim, &sum);
        if (status >= 0) status = dmb_query_pose(sim, tip, &pose);
        values[1] = s->kind == SCENE_B_COSINE ? sum.normal_force : 1e3 * pose.position[2];
    }
    return status;
}

/* Speed of the free end of a rod driven at the other with the speed w(t): every wave that arrives doubles, and comes
 * back turned over from the driven end, 2 w(t - T) - 2 w(t - 3T) + ..., T = L sqrt(rho/G) (d'Alembert). */
static double exact_tip_speed(double length, double time)
{
    const double shear = BENCH_YOUNG / (2.0 * (1.0 + BENCH_POISSON)), passage = length * sqrt(BENCH_DENSITY / shear);
    double sum = 0.0, sign = 2.0;
    for (double t = time - passage; t > 0.0; t -= 2.0 * passage, sign = -sign) {
        const double x = t < 1.0 ? t : 1.0;
        sum += sign * 2.0 * BENCH_PI * x * x * (3.0 - 2.0 * x);
    }
    return sum;
}

#endif
