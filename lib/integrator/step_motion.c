/* Formulas of generalized-alpha by rows, in chunks of nodes. With the pseudo-accelerations a0 at the start (carried to
 * the length of the step, eq:integration.carry) and a1 at the end:
 *
 *     predict   v1' = v0' + slope (a0 - v0')                             eq:integration.prediction; slope 0: constant
 *               a1  = (v0' - am a0)/(1 - am)                             eq:integration.recursion with v1' = v0'
 *               z   = h v0 + h^2 (1/2 - beta) a0 + h^2 beta a1           eq:integration.newmark
 *               v1  = v0 + h (1 - gamma) a0 + h gamma a1
 *               and for slope != 0 the changes by v1' - v0':  a1 by (1 - af)/(1 - am), z by 1/beta' of it
 *     correct   z += dz,  v1 += gamma' dz,  v1' += beta' dz,             eq:integration.factors
 *               a1 += dz/(h^2 beta)
 *
 *     rows                          motion that the formulas act on
 *     ---------------------------   -------------------------------------------------------------------------
 *     nodes, no joints in scene     the trial itself
 *     nodes, joints in the scene    raw_ fields: the motion before its projection onto the constraints
 *     free rigid bodies             at the centre of mass (eq:integration.free-rigid)
 *     rotors                        in axes that do not spin with them (eq:motion.rotor-step) */
#include "integrator/step_motion.h"

#include "kernel/kernels.h"
#include "sim/chunks.h"
#include "system/assemble/assemble.h"
#include "system/assemble/evaluation.h"
#include "system/constrain/rotor.h"

/* Smallest number of rows of a work chunk. */
enum { ROWS = 6 * DMB_GRAIN };

typedef struct predict_rows {
    const dmb_kernels *kernels;
    const dmb_predict_args *args;
} predict_rows;

/* place: 1, the poses of the nodes are updated with their rows. */
typedef struct correct_nodes {
    dmb_sim *sim;
    const dmb_correct_args *args;
    int32_t place, reserved;
} correct_nodes;

static void predict(void *work, uint32_t first, uint32_t end)
{
    const predict_rows *rows = work;
    dmb_predict_args args = *rows->args;
    args.count = end - first;
    args.now_velocity += first;
    args.now_acceleration += first;
    args.now_pseudo_acceleration += first;
    args.velocity += first;
    args.acceleration += first;
    args.pseudo_acceleration += first;
    args.increment += first;
    args.change += first;
    rows->kernels->predict(&args);
}

/* a_from_change and z_from_change are da1/dv1' = (1 - af)/(1 - am) and dz/dv1' = 1/beta'
 * (eq:integration.prediction-increment). Prescribed rows follow their drive whatever the prediction: their change is 0.
 */
void dmb_step_motion_predict(dmb_sim *sim, const dmb_generalized_alpha *c, double h, double slope)
{
    const double whole = 1.0 - c->am;
    const dmb_step_motion to = dmb_step_motion_of(sim);
    const dmb_predict_args args = {
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
    predict_rows rows = {sim->scene->kernels, &args};
    dmb_chunks_run(sim, args.count, ROWS, predict, &rows);
    if (sim->scene->free_rigid_count) dmb_free_rigids_predict(sim, &args);
    if (sim->scene->rotor_count) dmb_rotors_predict(sim, &args);
    for (uint32_t i = 0; i < sim->scene->constrained_count && slope != 0.0; i++)
        sim->correction[sim->scene->layout.row[sim->scene->constrained_node[i]] +
                        sim->scene->constrained_component[i]] = 0.0;
}

/* dmb_system_prescribe writes the trial; in scenes with joints, Newton corrects the raw motion, which the projection
 * reads. */
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
    dmb_correct_args args = *nodes->args;
    args.count = scene->layout.row[end] - row;
    args.correction += row;
    args.velocity += row;
    args.acceleration += row;
    args.pseudo_acceleration += row;
    args.increment += row;
    scene->kernels->correct(&args);
    if (nodes->place) dmb_system_move_nodes(nodes->sim, first, end);
}

/* Nodes are placed chunk by chunk while their rows are in the cache. With free rigid bodies this has to wait: the
 * increments of their nodes follow from the motion of the centre of mass. */
void dmb_step_motion_correct(dmb_sim *sim, const dmb_generalized_alpha *c, double h)
{
    const double to_a = 1.0 / (h * h * c->beta);
    const dmb_step_motion to = dmb_step_motion_of(sim);
    const dmb_correct_args args = {
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
    correct_nodes nodes = {sim, &args, sim->scene->free_rigid_count == 0, 0};
    dmb_chunks_run(sim, sim->scene->node_count, DMB_GRAIN, correct, &nodes);
    if (sim->scene->rotor_count) {
        dmb_rotors_correct(sim, &args);
        dmb_rotors_place(sim);
    }
    if (nodes.place) return;
    dmb_free_rigids_correct(sim, &args);
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

void dmb_step_motion_set(dmb_sim *sim, const double *increment)
{
    for (uint32_t i = 0; i < sim->scene->row_count; i++)
        if (sim->scene->solved_row[i]) sim->increment[i] = increment[i];
}
