/* Companion steps: one step of a perturbed simulation beside the accepted step of the nominal one.
 *
 *     nominal step                          factors                                     corrections
 *     -----------------------------------   -----------------------------------------   ---------------------------
 *     no contact opened, matrix exact       one matrix, shared by all followers         one, refined (correct_once)
 *     no contact opened, matrix inexact     the same                                    up to 12 (correct_often)
 *     contacts opened, no joints and no     shared: before opening, mass, after         up to 12 before, then as above
 *       free rigid bodies
 *     contacts opened otherwise             the follower's own, twice                   as above, on its own factors
 *
 * A follower tests no convergence: it uses the contact modes and the sequence of stages of the leader. */
#include "integrator/companion.h"

#include <math.h>
#include <string.h>

#include "system/assemble/bounces.h"
#include "system/assemble/drives.h"
#include "system/constrain/constrain.h"
#include "system/constrain/rotor.h"
#include "system/solve/solve.h"
#include "system/system.h"

/* A follower during the leader's step, with its own trial step. */
typedef struct companion {
    dmb_sim *sim;
    const dmb_nominal_step *nominal;
    dmb_generalized_alpha c;
    dmb_trial_step trial_step;
} companion;

static companion course_of(dmb_sim *follower, const dmb_nominal_step *nominal)
{
    companion to;
    memset(&to, 0, sizeof to);
    to.sim = follower;
    to.nominal = nominal;
    to.c = dmb_generalized_alpha_of(follower->options.spectral_radius);
    to.trial_step.end = nominal->trial_step->end;
    to.trial_step.block = DMB_NONE;
    return to;
}

static int32_t evaluate(companion *of, int32_t tangent)
{
    dmb_evaluation *evaluation = &of->trial_step.evaluation;
    evaluation->tangent = tangent;
    const int32_t status = of->sim->scene->cluster_count ? dmb_clusters_settle(evaluation, DMB_SETTLE_ALL, 1) : DMB_OK;
    return status < 0 ? status : dmb_system_evaluate(evaluation);
}

/* Prediction from the follower's accepted state (eq:integration.prediction with slope 0). */
static int32_t predict(companion *of)
{
    dmb_trial_step_set_up(of->sim, &of->trial_step.end, &of->trial_step.evaluation);
    dmb_step_motion_predict(of->sim, &of->c, of->trial_step.end.step, 0.0);
    const int32_t status = dmb_system_prescribe(&of->trial_step.evaluation);
    if (status < 0) return status;
    if (of->sim->scene->cluster_count) dmb_step_motion_keep_prescribed(of->sim);
    dmb_step_motion_place(of->sim);
    return DMB_OK;
}

static void keep_matrix(const dmb_sim *sim, dmb_block_matrix *to)
{
    const dmb_block_layout *layout = &sim->scene->layout;
    const uint32_t n = sim->scene->node_count;
    memcpy(to->diagonal, sim->stiffness_diagonal, layout->diag[n] * sizeof(double));
    memcpy(to->lower, sim->stiffness_lower, layout->link[n - 1] * sizeof(double));
    memcpy(to->upper, sim->stiffness_upper, layout->link[n - 1] * sizeof(double));
}

/* Residual, tangent and factors of the iteration matrix at the trial. */
static int32_t factor(companion *of)
{
    const int32_t status = evaluate(of, 1);
    if (status < 0) return status;
    dmb_system_iteration_matrix_constrained(&of->trial_step.evaluation, of->nominal->workspace->constrained_row);
    if (of->nominal->workspace->exact) keep_matrix(of->sim, &of->nominal->workspace->matrix);
    return dmb_factor_matrix(of->sim, of->sim->options.constraint_method) >= 0 ? DMB_ERR_SINGULAR : DMB_OK;
}

/* ---- Factors at the nominal step, shared by all followers -------------------------------------------------------- */

/* Joints and free rigid bodies need further factors (partition, centre of mass): each follower then makes its own if
 * contacts open. */
static int shares(const dmb_scene *scene)
{
    return scene->cluster_count == 0 && scene->free_rigid_count == 0;
}

static void take_factors(dmb_arena *arena, const dmb_scene *scene, dmb_factor_set *factors)
{
    const dmb_block_layout *layout = &scene->layout;
    const uint32_t own = shares(scene) && (scene->site_count > 0 || scene->unilateral_count > 0) ? 1 : 0,
                   n = scene->node_count;
    factors->diagonal = DMB_ARENA_DOUBLES(arena, own * (size_t)layout->diag[n]);
    factors->lower = DMB_ARENA_DOUBLES(arena, own * (size_t)layout->link[n - 1]);
    factors->upper = DMB_ARENA_DOUBLES(arena, own * (size_t)layout->link[n - 1]);
    factors->pivot = DMB_ARENA_ARRAY(arena, uint8_t, own * (size_t)scene->row_count);
}

static void take_matrix(dmb_arena *arena, const dmb_scene *scene, dmb_block_matrix *matrix)
{
    const dmb_block_layout *layout = &scene->layout;
    const uint32_t n = scene->node_count;
    matrix->diagonal = DMB_ARENA_DOUBLES(arena, layout->diag[n]);
    matrix->lower = DMB_ARENA_DOUBLES(arena, layout->link[n - 1]);
    matrix->upper = DMB_ARENA_DOUBLES(arena, layout->link[n - 1]);
}

void dmb_companion_workspace_allocate(dmb_arena *arena, const dmb_scene *scene, dmb_companion_workspace *workspace)
{
    workspace->opening = DMB_ARENA_DOUBLES(arena, scene->row_count);
    workspace->released = DMB_ARENA_DOUBLES(arena, scene->row_count);
    workspace->product = DMB_ARENA_DOUBLES(arena, scene->row_count);
    workspace->constrained_row = DMB_ARENA_DOUBLES(arena, 18 * (size_t)scene->constrained_count);
    workspace->constrained_residual = DMB_ARENA_DOUBLES(arena, scene->constrained_count);
    take_matrix(arena, scene, &workspace->matrix);
    take_factors(arena, scene, &workspace->before);
    take_factors(arena, scene, &workspace->mass);
}

/* 1: a contact point touches the wall in this step. Its tangent neglects the change of the speed at first touch. */
static int meets(const dmb_sim *sim)
{
    for (uint32_t s = 0; s < sim->scene->site_count; s++)
        if (!(sim->now.site_penetration[s] > 0.0) && sim->trial.site_penetration[s] > 0.0) return 1;
    return 0;
}

/* The tangents of bits, of axial-torsional contact points (through the tension of their elements), of actuators, of
 * caller's forces and of mean forces are not exact; nor is the iteration matrix of joints, which neglects the rotation
 * of the projection with the pose. */
static int32_t is_exact(const dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    return scene->cluster_count == 0 && scene->free_rigid_count == 0 && scene->bit_count == 0 &&
           scene->axial_torsional_site_count == 0 && scene->actuator_count == 0 && scene->force_count == 0 &&
           scene->stuck_count == 0 && !meets(sim) && !dmb_sites_have_mean(sim);
}

/* ---- Corrections ------------------------------------------------------------------------------------------------- */

static double size_of_correction(const dmb_sim *sim)
{
    double size = 0.0;
    for (uint32_t i = 0; i < sim->scene->row_count; i++) size = fmax(size, fabs(sim->correction[i]));
    return size;
}

/* Corrections end below this fraction of the first correction, or below this size [m, rad], which no force resolves. */
#define DMB_SETTLED_PART 1e-8
#define DMB_SETTLED_SIZE 1e-15
enum { DMB_CORRECTIONS_MAX = 12 };

/* One correction and the memory fields linear in it; the residual of constrained rows is updated with their rows of the
 * matrix. One correction suffices because residual and matrix are exact: the follower is linear in its difference to
 * the leader, and what is left is of second order in it. */
static int32_t correct_once(companion *of)
{
    dmb_sim *sim = of->sim;
    const dmb_scene *scene = sim->scene;
    double *held = of->nominal->workspace->constrained_residual;
    dmb_solve_refined(sim, &of->nominal->workspace->matrix, of->nominal->workspace->product);
    dmb_system_constrained_times(sim, of->nominal->workspace->constrained_row, sim->correction, held);
    for (uint32_t i = 0; i < scene->constrained_count; i++)
        held[i] += sim->residual[scene->layout.row[scene->constrained_node[i]] + scene->constrained_component[i]];
    dmb_step_motion_correct(sim, &of->c, of->trial_step.end.step);
    dmb_system_remember(&of->trial_step.evaluation, held);
    return DMB_OK;
}

/* Repeats corrections with the present factors until one is small. Tangents of contacts that close and of bits that
 * reach the rock have relative errors of about 1e-5, and the iteration matrix of joints of about 1e-2, so that a few
 * corrections are enough. */
static int32_t correct_often(companion *of)
{
    const int jointed = of->sim->scene->cluster_count > 0; /* the evaluation projects the trial onto the constraints */
    double first = 0.0;
    for (uint32_t k = 0; k < DMB_CORRECTIONS_MAX; k++) {
        dmb_solve_correction(of->sim);
        const double size = size_of_correction(of->sim);
        dmb_step_motion_correct(of->sim, &of->c, of->trial_step.end.step);
        if (k == 0) first = size;
        const int done = k > 0 && size <= fmax(DMB_SETTLED_PART * first, DMB_SETTLED_SIZE);
        const int32_t status = done && !jointed ? DMB_OK : evaluate(of, 0);
        if (status < 0) return status;
        if (done) break;
    }
    return DMB_OK;
}

static int32_t correct(companion *of)
{
    return of->nominal->workspace->exact ? correct_once(of) : correct_often(of);
}

/* Copies the leader's treatment (law, mean force, opening) of contact points, stops and springs. */
static void take_modes(companion *of)
{
    *of->sim->sites_bounce = *of->nominal->sim->sites_bounce;
    *of->sim->laws_bounce = *of->nominal->sim->laws_bounce;
    memcpy(of->sim->site_coarse, of->nominal->sim->site_coarse, of->sim->scene->site_count * sizeof(uint8_t));
    memcpy(of->sim->site_mode, of->nominal->sim->site_mode, of->sim->scene->site_count * sizeof(uint8_t));
    memcpy(of->sim->bounce_mode, of->nominal->sim->bounce_mode, of->sim->scene->unilateral_count * sizeof(uint8_t));
    memcpy(of->sim->bounce_turns, of->nominal->sim->bounce_turns, of->sim->scene->unilateral_count * sizeof(uint8_t));
}

/* Corrects the follower to its state before contacts opened, and computes the accelerations of the opening forces from
 * there with the shared factors. The matrix of the workspace is that of the repeated step, in which a contact may be
 * closed again, and does not belong to these factors. */
static int32_t open_beside(companion *of)
{
    dmb_sim *sim = of->sim;
    dmb_companion_workspace *workspace = of->nominal->workspace;
    dmb_factors_swap(sim, &workspace->before);
    int32_t status = evaluate(of, 0);
    if (status >= 0) status = correct_often(of);
    dmb_factors_swap(sim, &workspace->before);
    if (status < 0) return status;
    take_modes(of);
    dmb_factors_swap(sim, &workspace->mass);
    status = dmb_released_beside(&of->trial_step.evaluation, workspace->released, sim->correction, sim->released_part,
                                 workspace->product);
    dmb_factors_swap(sim, &workspace->mass);
    return status;
}

static int32_t open_alone(companion *of)
{
    int32_t status = factor(of);
    if (status >= 0) status = correct(of);
    if (status < 0) return status;
    take_modes(of);
    return dmb_released_acceleration(&of->trial_step.evaluation, of->sim->correction, of->sim->released_part);
}

/* Repeats the step without the forces of opening contacts, from the leader's final increments (eq:contact.release). */
static void go_again(companion *of)
{
    dmb_step_motion_set(of->sim, of->nominal->sim->increment);
    dmb_trial_step_refit(of->sim, &of->c, of->trial_step.end.step);
    dmb_step_motion_place(of->sim);
    dmb_trial_step_set_up(of->sim, &of->trial_step.end, &of->trial_step.evaluation);
}

/* A step in which contacts open, in the two stages of integrator/trial_step: the leader's increments before the
 * opening, then those after it. */
static int32_t follow_release(companion *of)
{
    dmb_sim *sim = of->sim;
    const int shared = shares(sim->scene);
    dmb_step_motion_go_to(of->sim, &of->c, of->trial_step.end.step, of->nominal->workspace->opening);
    int32_t status = shared ? open_beside(of) : open_alone(of);
    if (status < 0) return status;
    go_again(of);
    status = shared ? evaluate(of, 0) : factor(of);
    if (status >= 0) status = correct(of);
    return status;
}

/* Accelerations after mean forces (dmb_bounces_end); the factors shared by the followers are preserved. */
static int32_t end_bounces(companion *of)
{
    const int shared = shares(of->sim->scene);
    int32_t found = 0;
    if (of->nominal->trial_step->bounced) {
        if (shared) dmb_factors_swap(of->sim, &of->nominal->workspace->mass);
        const int32_t status = dmb_bounces_end(&of->trial_step.evaluation, &found);
        if (shared) dmb_factors_swap(of->sim, &of->nominal->workspace->mass);
        if (status < 0) return status;
    }
    of->trial_step.bounced = found;
    return DMB_OK;
}

/* Starts from the leader's increments, not from the follower's prediction: the difference of both solutions is all that
 * the corrections have to find. */
static int32_t follow(companion *of)
{
    int32_t status = predict(of);
    if (status < 0) return status;
    if (of->nominal->trial_step->released) return follow_release(of);
    dmb_step_motion_go_to(of->sim, &of->c, of->trial_step.end.step, of->nominal->sim->increment);
    status = evaluate(of, 0);
    return status < 0 ? status : correct(of);
}

/* Shared factors of a step in which contacts opened: iteration matrix before the opening, mass matrix there, and
 * iteration matrix of the repeated step. */
static int32_t prepare_release(companion *of)
{
    dmb_sim *sim = of->sim;
    dmb_companion_workspace *workspace = of->nominal->workspace;
    if (!shares(sim->scene)) return DMB_OK;
    dmb_step_motion_go_to(sim, &of->c, of->trial_step.end.step, workspace->opening);
    int32_t status = factor(of);
    if (status < 0) return status;
    dmb_factors_swap(sim, &workspace->before);
    take_modes(of);
    status = dmb_released_acceleration(&of->trial_step.evaluation, sim->correction, sim->released_part);
    memcpy(workspace->released, sim->correction, sim->scene->row_count * sizeof(double));
    dmb_factors_swap(sim, &workspace->mass);
    if (status >= 0) {
        go_again(of);
        status = factor(of);
    }
    return status;
}

int32_t dmb_companion_prepare(dmb_sim *follower, const dmb_nominal_step *nominal)
{
    companion of = course_of(follower, nominal);
    dmb_bounces_begin(follower, dmb_step_end_asked(&nominal->trial_step->end));
    if (!nominal->trial_step->released) take_modes(&of);
    int32_t status = predict(&of);
    if (status < 0) return status;
    nominal->workspace->exact = is_exact(nominal->sim);
    if (nominal->trial_step->released) return prepare_release(&of);
    dmb_step_motion_go_to(of.sim, &of.c, of.trial_step.end.step, nominal->sim->increment);
    return factor(&of);
}

int32_t dmb_companion_step(dmb_sim *follower, const dmb_nominal_step *nominal)
{
    companion of = course_of(follower, nominal);
    dmb_bounces_begin(follower, dmb_step_end_asked(&nominal->trial_step->end));
    if (!nominal->trial_step->released) take_modes(&of);
    int32_t status = follow(&of);
    if (status >= 0) status = end_bounces(&of);
    if (status < 0) return status;
    dmb_system_unwrap(of.sim);
    dmb_rotors_unwrap(of.sim);
    dmb_system_accept(&of.trial_step.evaluation);
    dmb_bounces_accept(&of.trial_step.evaluation, of.trial_step.bounced);
    return DMB_OK;
}
