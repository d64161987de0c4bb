#include "integrator/step_motion.h"

#include "kernel/kernels.h"
#include "system/assemble/assemble.h"
#include "system/assemble/evaluation.h"

void dmb_step_motion_predict(dmb_sim *sim, const dmb_generalized_alpha *c, double h)
{
    const double whole = 1.0 - c->am;
    const dmb_step_motion to = dmb_step_motion_of(sim);
    const dmb_predict_job job = {
        .count = sim->scene->row_count,
        .step = h,
        .ratio = dmb_step_motion_ratio(sim, h),
        .a_from_dv = 1.0 / whole,
        .a_from_a0 = -c->am / whole,
        .v_from_a0 = h * (1.0 - c->gamma),
        .v_from_a1 = h * c->gamma,
        .z_from_a0 = h * h * (0.5 - c->beta),
        .z_from_a1 = h * h * c->beta,
        .now_velocity = sim->now.velocity,
        .now_acceleration = sim->now.acceleration,
        .now_pseudo_acceleration = sim->now.pseudo_acceleration,
        .velocity = to.velocity,
        .acceleration = to.acceleration,
        .pseudo_acceleration = to.pseudo_acceleration,
        .increment = sim->increment,
    };
    sim->scene->kernels->predict(&job);
    if (sim->scene->free_rigid_count) dmb_free_rigids_predict(sim, &job);
}

void dmb_step_motion_keep_prescribed(dmb_sim *sim)
{
    const dmb_step_motion to = dmb_step_motion_of(sim);
    for (uint32_t i = 0; i < sim->scene->drive_count; i++) {
        const uint32_t row = sim->scene->drives[i].row;
        if (sim->scene->drives[i].kind != DMB_DRIVE_MOTION || row == DMB_NONE) continue;
        to.velocity[row] = sim->trial.velocity[row];
        to.acceleration[row] = sim->trial.acceleration[row];
        to.pseudo_acceleration[row] = sim->trial.pseudo_acceleration[row];
    }
}

void dmb_step_motion_correct(dmb_sim *sim, const dmb_generalized_alpha *c, double h)
{
    const double to_a = 1.0 / (h * h * c->beta);
    const dmb_step_motion to = dmb_step_motion_of(sim);
    const dmb_correct_job job = {
        .count = sim->scene->row_count,
        .to_velocity = c->gamma / (h * c->beta),
        .to_acceleration = to_a * (1.0 - c->am) / (1.0 - c->af),
        .to_pseudo_acceleration = to_a,
        .correction = sim->correction,
        .velocity = to.velocity,
        .acceleration = to.acceleration,
        .pseudo_acceleration = to.pseudo_acceleration,
        .increment = sim->increment,
    };
    sim->scene->kernels->correct(&job);
    if (sim->scene->free_rigid_count) dmb_free_rigids_correct(sim, &job);
    dmb_step_motion_place(sim);
}

void dmb_step_motion_place(dmb_sim *sim)
{
    dmb_system_move(sim);
    if (sim->scene->free_rigid_count) dmb_free_rigids_place(sim);
}

void dmb_step_motion_go_to(dmb_sim *sim, const dmb_generalized_alpha *c, double h, const double *increment)
{
    for (uint32_t i = 0; i < sim->scene->row_count; i++)
        sim->correction[i] = sim->scene->solved_row[i] ? increment[i] - sim->increment[i] : 0.0;
    dmb_step_motion_correct(sim, c, h);
}

void dmb_step_motion_take(dmb_sim *sim, const double *increment)
{
    for (uint32_t i = 0; i < sim->scene->row_count; i++)
        if (sim->scene->solved_row[i]) sim->increment[i] = increment[i];
}
