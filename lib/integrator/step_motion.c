#include "integrator/step_motion.h"

#include "system/evaluation.h"

void dmb_step_motion_predict(dmb_sim *sim, const dmb_generalized_alpha *c, double h)
{
    const double ratio = dmb_step_motion_ratio(sim, h), am = c->am, beta = c->beta, whole = 1.0 - am;
    const double to_v0 = h * (1.0 - c->gamma), to_v1 = h * c->gamma;
    const dmb_step_motion to = dmb_step_motion_of(sim);
    const uint32_t rows = sim->scene->row_count;
    const double *restrict now_v = sim->now.velocity, *restrict now_dv = sim->now.acceleration,
                           *restrict now_a =
                               sim->now.pseudo_acceleration; /* nothing overlaps, so that this vectorises */
    double *restrict v = to.velocity, *restrict dv = to.acceleration, *restrict a = to.pseudo_acceleration,
                     *restrict increment = sim->increment;
    for (uint32_t i = 0; i < rows; i++) {
        const double a0 = now_dv[i] + ratio * (now_a[i] - now_dv[i]), a1 = (now_dv[i] - am * a0) / whole;
        dv[i] = now_dv[i];
        a[i] = a1;
        v[i] = now_v[i] + to_v0 * a0 + to_v1 * a1;
        increment[i] = h * now_v[i] + h * h * ((0.5 - beta) * a0 + beta * a1);
    }
}

void dmb_step_motion_keep_prescribed(dmb_sim *sim)
{
    const dmb_step_motion to = dmb_step_motion_of(sim);
    for (uint32_t i = 0; i < sim->scene->drive_count; i++) {
        const uint32_t row = sim->scene->drives[i].row;
        if (sim->scene->drives[i].kind != DMB_DRIVE_MOTION || row == UINT32_MAX) continue;
        to.velocity[row] = sim->trial.velocity[row];
        to.acceleration[row] = sim->trial.acceleration[row];
        to.pseudo_acceleration[row] = sim->trial.pseudo_acceleration[row];
    }
}

void dmb_step_motion_correct(dmb_sim *sim, const dmb_generalized_alpha *c, double h)
{
    const double to_a = 1.0 / (h * h * c->beta), to_v = c->gamma / (h * c->beta);
    const double to_dv = to_a * (1.0 - c->am) / (1.0 - c->af);
    const dmb_step_motion to = dmb_step_motion_of(sim);
    const uint32_t rows = sim->scene->row_count;
    const double *restrict z = sim->correction;
    double *restrict v = to.velocity, *restrict dv = to.acceleration, *restrict a = to.pseudo_acceleration,
                     *restrict increment = sim->increment;
    for (uint32_t i = 0; i < rows; i++) {
        increment[i] += z[i];
        v[i] += to_v * z[i];
        dv[i] += to_dv * z[i];
        a[i] += to_a * z[i];
    }
    dmb_system_move(sim);
}
