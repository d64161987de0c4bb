#include "integrator/step_motion.h"

#include "kernel/kernels.h"
#include "sim/parts.h"
#include "system/assemble/assemble.h"
#include "system/assemble/evaluation.h"
#include "system/constrain/rotor.h"

/* Rows that a part takes at least. */
enum { ROWS = 6 * DMB_GRAIN };

typedef struct predict_rows {
    const dmb_kernels *kernels;
    const dmb_predict_job *job;
} predict_rows;

/* place: the poses of the nodes follow their rows. */
typedef struct correct_nodes {
    dmb_sim *sim;
    const dmb_correct_job *job;
    int32_t place, reserved;
} correct_nodes;

static void predict(void *work, uint32_t first, uint32_t end)
{
    const predict_rows *rows = work;
    dmb_predict_job job = *rows->job;
    job.count = end - first;
    job.now_velocity += first;
    job.now_acceleration += first;
    job.now_pseudo_acceleration += first;
    job.velocity += first;
    job.acceleration += first;
    job.pseudo_acceleration += first;
    job.increment += first;
    job.change += first;
    rows->kernels->predict(&job);
}

void dmb_step_motion_predict(dmb_sim *sim, const dmb_generalized_alpha *c, double h, double slope)
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
        .slope = slope,
        .a_from_change = (1.0 - c->af) / whole,
        .z_from_change = h * h * c->beta * (1.0 - c->af) / whole,
        .change = sim->correction,
        .now_velocity = sim->now.velocity,
        .now_acceleration = sim->now.acceleration,
        .now_pseudo_acceleration = sim->now.pseudo_acceleration,
        .velocity = to.velocity,
        .acceleration = to.acceleration,
        .pseudo_acceleration = to.pseudo_acceleration,
        .increment = sim->increment,
    };
    predict_rows rows = {sim->scene->kernels, &job};
    dmb_parts_run(sim, job.count, ROWS, predict, &rows);
    if (sim->scene->free_rigid_count) dmb_free_rigids_predict(sim, &job);
    if (sim->scene->rotor_count) dmb_rotors_predict(sim, &job);
    for (uint32_t i = 0; i < sim->scene->held_count && slope != 0.0; i++)
        sim->correction[sim->scene->layout.row[sim->scene->held_node[i]] + sim->scene->held_component[i]] = 0.0;
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

static void correct(void *work, uint32_t first, uint32_t end)
{
    const correct_nodes *nodes = work;
    const dmb_scene *scene = nodes->sim->scene;
    const uint32_t row = scene->layout.row[first];
    dmb_correct_job job = *nodes->job;
    job.count = scene->layout.row[end] - row;
    job.correction += row;
    job.velocity += row;
    job.acceleration += row;
    job.pseudo_acceleration += row;
    job.increment += row;
    scene->kernels->correct(&job);
    if (nodes->place) dmb_system_move_nodes(nodes->sim, first, end);
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
    correct_nodes nodes = {sim, &job, sim->scene->free_rigid_count == 0, 0};
    dmb_parts_run(sim, sim->scene->node_count, DMB_GRAIN, correct, &nodes);
    if (sim->scene->rotor_count) {
        dmb_rotors_correct(sim, &job);
        dmb_rotors_place(sim);
    }
    if (nodes.place) return;
    dmb_free_rigids_correct(sim, &job);
    dmb_step_motion_place(sim);
}

void dmb_step_motion_place(dmb_sim *sim)
{
    dmb_system_move(sim);
    if (sim->scene->free_rigid_count) dmb_free_rigids_place(sim);
    if (sim->scene->rotor_count) dmb_rotors_place(sim);
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
