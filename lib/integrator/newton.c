/* Newton iteration of a step and reuse of its factors.
 *
 * One iteration (iterate):
 *     evaluate     residual at the trial; tangent only if no factors are at hand
 *     judge        residual against its bound -> done | work limit | failed | correction due
 *     factors      reused while two corrections reach the bound, otherwise factorised at the trial
 *     correct      z += dz; half of dz if the correction before overshot steep friction
 *
 * The iteration is done at the first of:
 *     1. norm and error below the bound (eq:integration.stop) and power below its bound (eq:integration.stop-power)
 *     2. residual at the rounding of the forces at the start (is_rounding)
 *     3. residual that stagnates at the accuracy of a nearly singular partition (is_unsharp)
 *     4. with reused factors, bound reached but not their lower aim, when they converge no more (is_met)
 * It fails with DMB_ERR_NO_CONVERGENCE if residuals alternate, grow by 1e6 or overflow, or at max_iterations; with
 * `bounded_work` the last case is accepted with DMB_NOTE_WORK_LIMITED. */
#include "integrator/newton.h"

#include <float.h>
#include <string.h>

#include "integrator/prediction.h"
#include "integrator/step_motion.h"
#include "kernel/kernels.h"
#include "sim/access.h"
#include "system/assemble/assemble.h"
#include "system/assemble/bounces.h"
#include "system/constrain/constrain.h"
#include "system/solve/solve.h"
#include "system/system.h"

/* [-] Growth of the residual over its start at which the iteration fails. */
#define DMB_NEWTON_GROWTH 1e6

/* 1: the bound follows the local error of the step (newton_tolerance = 0). */
static int32_t follows_error(const dmb_sim *sim)
{
    return !(sim->options.newton_tolerance > 0.0);
}

/* True if the residual is at the rounding level of the initial forces. In free flight after a contact no other force
 * remains for comparison. */
static int32_t is_rounding(const dmb_trial_step *trial_step, double balance, dmb_convergence_history *history)
{
    if (history->balance > 0.0) return trial_step->residual * balance <= 4.0 * DBL_EPSILON * history->balance;
    history->balance = balance;
    return 0;
}

/* Near a singular configuration of joints, poses projected to 2e-15 leave the null space of the partition inaccurate by
 * that over the squared quality of the partition (measured: up to 4e-14/quality^2 of the forces). A residual that
 * stagnates below this level cannot be reduced further and is accepted. */
static int32_t is_unsharp(const dmb_sim *sim, const dmb_trial_step *trial_step, const dmb_convergence_history *history)
{
    double quality = 1.0;
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++) quality = fmin(quality, sim->cluster_quality[k]);
    if (!(quality < 0.1) || !(history->last > 0.0) || trial_step->residual <= 0.5 * history->last) return 0;
    return trial_step->residual <= fmin(1e-4, 4e-14 / (quality * quality));
}

/* [-] Difference of residuals two iterations apart over that of neighbouring ones, below which they count as
 * alternating. */
#define DMB_NEWTON_ALIKE 0.1

/* A contact that opens if treated as closed and closes if treated as open has no solution at this end of the step,
 * because the damping of the wall jumps at contact: the iteration alternates between the two. Detecting it saves
 * iterations to the limit. */
static int32_t goes_to_and_fro(const dmb_sim *sim, const dmb_trial_step *trial_step, dmb_convergence_history *history)
{
    const double now = trial_step->residual;
    const int32_t found = history->corrections > 3 && now > 0.5 * history->last &&
                          fabs(now - history->earlier) <= DMB_NEWTON_ALIKE * fabs(now - history->last);
    history->earlier = history->last;
    return found && sim->scene->site_count > 0 && follows_error(sim) && !sim->options.bounded_work;
}

/* 1: the iteration may continue; DMB_NOTE_WORK_LIMITED: accepted at the limit; < 0: failed. */
static int32_t check_convergence(const dmb_sim *sim, const dmb_trial_step *trial_step, dmb_convergence_history *history)
{
    if (goes_to_and_fro(sim, trial_step, history)) return DMB_ERR_NO_CONVERGENCE;
    if (history->first == 0.0) history->first = history->last = trial_step->residual;
    if (!(trial_step->residual <= DMB_NEWTON_GROWTH * history->first)) return DMB_ERR_NO_CONVERGENCE; /* also NaN */
    if (trial_step->residual > DBL_MAX) return DMB_ERR_NO_CONVERGENCE;
    if (trial_step->iterations < sim->options.max_iterations) return 1;
    return sim->options.bounded_work ? DMB_NOTE_WORK_LIMITED : DMB_ERR_NO_CONVERGENCE;
}

/* Factorises the iteration matrix at the present trial. DMB_ERR_SINGULAR with trial_step->block. */
static int32_t refactor(dmb_sim *sim, dmb_trial_step *trial_step)
{
    if (!trial_step->evaluation.tangent) {
        trial_step->evaluation.tangent = 1;
        const int32_t status = dmb_system_evaluate(&trial_step->evaluation);
        if (status < 0) return status;
    }
    dmb_system_iteration_matrix(&trial_step->evaluation);
    const int64_t bad = dmb_factor_matrix(sim, sim->options.constraint_method);
    trial_step->factored = DMB_FACTORS_FRESH;
    if (bad < 0) return DMB_OK;
    trial_step->block = (uint32_t)bad;
    return DMB_ERR_SINGULAR;
}

/* ---- Stopping rule -----------------------------------------------------------------------------------------------
 *
 * With newton_tolerance = 0 the bound follows the local error of the step, given by corrector minus predictor
 * (eq:integration.milne). The error of z after the last correction accumulates in the velocities
 * (eq:integration.left-impulse), so the bound falls with the frequency of the motion (eq:integration.stop). Derivation:
 * theory/integration.md, "Where Newton stops". */

#define DMB_NEWTON_PART 0.01  /* [-] of the local error of the step */
#define DMB_NEWTON_LINEAR 0.7 /* [-] factor on that after a linear prediction (small corrections) */
#define DMB_NEWTON_PACE 0.05  /* [-] h w above which DMB_NEWTON_PART applies; PART/PACE = 0.2 of eq:integration.stop */
#define DMB_NEWTON_MOST 1e-3  /* [-] largest permitted relative residual */
#define DMB_NEWTON_LEAST 1e-8 /* [-] relative residual that always suffices */
#define DMB_NEWTON_WORK 1e-7  /* [-] power of the residual over the power exchanged by the forces */

/* [-] Permitted error over the error of the predictor for fast motion (eq:integration.milne). */
static double fraction_of(const dmb_sim *sim)
{
    const dmb_generalized_alpha c = dmb_generalized_alpha_of(sim->options.spectral_radius);
    return DMB_NEWTON_PART * fabs(c.error) * (1.0 - c.am) / (c.beta * (1.0 - c.af));
}

/* [-] A linear prediction may satisfy the bound in step after step, and the errors left would accumulate: without a
 * correction, the bound is reduced by this factor (theory/integration.md, "Where Newton stops"). */
#define DMB_LINEAR_AIM 0.01

/* Bound of the residual, times `aim`: below 1 for reused factors and linear predictions. */
static dmb_residual_bound bound_of(const dmb_sim *sim, const dmb_convergence_history *history, double aim)
{
    if (history->linear && history->corrections == 0) aim *= DMB_LINEAR_AIM;
    const dmb_residual_bound given = {aim * sim->options.newton_tolerance, 0.0, 0.0, 0};
    const dmb_residual_bound following = {aim * DMB_NEWTON_LEAST, fraction_of(sim), DMB_NEWTON_MOST,
                                          history->corrections == 0 && !history->linear};
    return follows_error(sim) ? following : given;
}

/* [J] |z . residual| of the present correction z. */
static double work_of(const dmb_sim *sim)
{
    return fabs(sim->scene->kernels->product(sim->scene->row_count, sim->correction, sim->residual));
}

/* [W] Power of the residual, and sum of the magnitudes of the powers of all forces. */
typedef struct powers {
    double left, exchanged;
} powers;

static powers powers_of(const dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    dmb_power_args args = {.count = scene->row_count,
                           .residual = sim->residual,
                           .scale = sim->scale_row,
                           .velocity = sim->trial.velocity,
                           .solved = scene->solved_row};
    scene->kernels->powers(&args);
    const powers p = {args.left, args.exchanged};
    return p;
}

/* [-] h times the frequency of the motion (eq:integration.pace) over DMB_NEWTON_PACE, at most 1. */
static double pace_of(const dmb_trial_step *trial_step, const dmb_convergence_history *history, double exchanged)
{
    const double energy = trial_step->end.step * exchanged * history->first;
    const double scaled_work = 4.0 / (DMB_NEWTON_PACE * DMB_NEWTON_PACE) * history->most_work;
    return energy > scaled_work ? sqrt(scaled_work / energy) : 1.0;
}

/* [-] Error left (eq:integration.contraction) over the permitted one (eq:integration.stop) at pace 1. */
static double excess_of_error(const dmb_sim *sim, double residual, const dmb_convergence_history *history)
{
    if (!(history->work > 0.0)) return (double)INFINITY; /* no rate is known; fmax would ignore a NaN */
    const double rate = fmax(residual / history->last, work_of(sim) / history->work);
    if (!(rate < 1.0)) return (double)INFINITY;
    return rate * sqrt(history->work / history->most_work) / (fraction_of(sim) * (1.0 - rate));
}

/* [-] Power of the residual over the permitted one (eq:integration.stop-power). */
static double excess_of_power(const powers *p)
{
    return p->left != 0.0 ? fabs(p->left) / (DMB_NEWTON_WORK * p->exchanged) : 0.0;
}

/* The residual of the constant prediction, which the linear one has reduced, is the start of the iteration. If the
 * linear prediction has increased it, the motion is stiffer than its inertia, and the present residual is the start. */
static void note_start(const dmb_evaluation *evaluation, dmb_convergence_history *history, dmb_residual_norm *norm,
                       const dmb_residual_bound *bound)
{
    if (norm->relative < norm->start) {
        history->first = history->last = norm->start;
        return;
    }
    dmb_residual_bound at_hand = *bound;
    at_hand.start = 1;
    history->linear = 0;
    history->work = history->most_work = 0.0;
    *norm = dmb_residual_norm_within(evaluation, &at_hand);
}

/* Compares the residual with its bound: by its norm first, then by the estimated error and the power
 * (eq:integration.stop). */
static dmb_residual_norm compare(const dmb_sim *sim, const dmb_trial_step *trial_step, dmb_convergence_history *history,
                                 double aim)
{
    const dmb_residual_bound bound = bound_of(sim, history, aim);
    dmb_residual_norm norm = dmb_residual_norm_within(&trial_step->evaluation, &bound);
    if (history->linear && history->corrections == 0) note_start(&trial_step->evaluation, history, &norm, &bound);
    if (norm.converged != DMB_SMALL_PART) return norm;
    const powers p = powers_of(sim);
    const double share = history->linear ? DMB_NEWTON_LINEAR : 1.0;
    const double of_error =
        excess_of_error(sim, norm.relative, history) / (share * pace_of(trial_step, history, p.exchanged));
    const double excess = fmax(of_error, excess_of_power(&p) / share);
    if (excess <= 1.0) return norm;
    norm.converged = 0;
    norm.bound = fmax(bound.tolerance, norm.relative / excess);
    return norm;
}

/* 1: the requested bound is reached, although reused factors aim lower. */
static int32_t is_met(const dmb_sim *sim, const dmb_trial_step *trial_step, dmb_convergence_history *history)
{
    return trial_step->factored == DMB_FACTORS_REUSED && compare(sim, trial_step, history, 1.0).converged != 0;
}

/* Projects the trial onto the constraints and computes the residual, with the tangent if factors are needed next. */
static int32_t evaluate(dmb_sim *sim, dmb_trial_step *trial_step, const dmb_convergence_history *history)
{
    dmb_evaluation *evaluation = &trial_step->evaluation;
    evaluation->predicted = history->corrections == 0 && !trial_step->released && *sim->sites_bounce;
    evaluation->tangent = trial_step->factored == DMB_FACTORS_NONE && !(history->linear && history->corrections == 0);
    const int32_t status = sim->scene->cluster_count ? dmb_clusters_settle(evaluation, DMB_SETTLE_ALL, 1) : DMB_OK;
    return status < 0 ? status : dmb_system_evaluate(evaluation);
}

/* 1: the residual contains tangents to mean contact forces instead of the forces, so that a small residual does not
 * indicate a solution. */
static int32_t from_tangent(const dmb_sim *sim, const dmb_trial_step *trial_step)
{
    return trial_step->evaluation.predicted && dmb_sites_have_mean(sim);
}

/* Decides on the residual. 1: a correction is due, 0 or DMB_NOTE_WORK_LIMITED: done, < 0: failed. */
static int32_t judge(dmb_sim *sim, dmb_trial_step *trial_step, dmb_convergence_history *history)
{
    const double aim = trial_step->factored == DMB_FACTORS_REUSED ? DMB_REUSE_TOLERANCE : 1.0;
    const dmb_residual_norm norm = compare(sim, trial_step, history, aim);
    trial_step->residual = norm.relative;
    trial_step->bound = norm.bound;
    history->hidden = norm.converged == DMB_AT_ROUNDING && dmb_factor_reuse_still_pay(sim, trial_step, history);
    if (norm.converged && !history->hidden && !from_tangent(sim, trial_step)) return 0;
    if (is_rounding(trial_step, norm.balance, history) || is_unsharp(sim, trial_step, history)) return 0;
    const int32_t status = check_convergence(sim, trial_step, history);
    return status != 1 && is_met(sim, trial_step, history) ? 0 : status;
}

/* [-] Ratio of the work of the residual along the last correction, after to before it, below which the correction
 * overshot. */
#define DMB_NEWTON_BEYOND -0.5

/* [J] Work of the residual along the present correction, if contacts have mean forces; otherwise 0. */
static double work_along(const dmb_sim *sim)
{
    if (!dmb_sites_have_mean(sim)) return 0.0;
    return sim->scene->kernels->product(sim->scene->row_count, sim->correction, sim->residual);
}

/* 1: the last correction overshot, and the next one is halved. Friction of contacts with mean forces is steep in their
 * slip, so that full corrections alternate between its two sides. */
static int32_t went_beyond(const dmb_sim *sim, const dmb_convergence_history *history)
{
    const double before = history->along;
    return before != 0.0 && work_along(sim) / before < DMB_NEWTON_BEYOND;
}

static void halve(dmb_sim *sim)
{
    for (uint32_t i = 0; i < sim->scene->row_count; i++) sim->correction[i] *= 0.5;
}

/* Solves for a correction with the present factors and moves the trial by it. */
static void correct(dmb_sim *sim, const dmb_generalized_alpha *c, dmb_trial_step *trial_step,
                    dmb_convergence_history *history)
{
    const int32_t beyond = went_beyond(sim, history);
    dmb_solve_correction(sim);
    if (beyond) halve(sim);
    history->along = work_along(sim);
    if (follows_error(sim)) {
        history->work = work_of(sim);
        history->most_work = fmax(history->most_work, history->work);
    }
    trial_step->iterations++;
    if (trial_step->factored == DMB_FACTORS_FRESH) { /* reused factors are replaced by a tangent at the true stress */
        dmb_system_extrapolate_stress(sim, sim->correction);
        trial_step->evaluation.extrapolated = 1;
    }
    dmb_step_motion_correct(sim, c, trial_step->end.step);
}

/* One Newton iteration. 1: continue, otherwise the result of dmb_newton. */
static int32_t iterate(dmb_sim *sim, const dmb_generalized_alpha *c, dmb_trial_step *trial_step,
                       dmb_convergence_history *history)
{
    int32_t status = dmb_progress_pulse(sim);
    if (status >= 0) status = evaluate(sim, trial_step, history);
    if (status >= 0) status = judge(sim, trial_step, history);
    if (status != 1) return status;
    if (!history->hidden && !dmb_factor_reuse_will_do(sim, trial_step, history)) {
        if (history->corrections > 0 && is_met(sim, trial_step, history)) return 0;
        status = refactor(sim, trial_step);
        if (status < 0) return status;
    }
    history->last = trial_step->residual;
    history->corrections++;
    correct(sim, c, trial_step, history);
    return 1;
}

/* The change by a linear prediction counts as a first correction; if there is none, as after a jump, the prediction is
 * the constant one. */
static void begin_linear(dmb_sim *sim, dmb_trial_step *trial_step, dmb_convergence_history *history)
{
    history->work = history->most_work = dmb_prediction_saved(sim, trial_step);
    history->linear = trial_step->linear = history->work > 0.0;
}

int32_t dmb_newton(dmb_sim *sim, const dmb_generalized_alpha *c, dmb_trial_step *trial_step)
{
    dmb_convergence_history history;
    int32_t status;
    memset(&history, 0, sizeof history);
    dmb_factor_reuse_begin(sim, trial_step);
    if (trial_step->linear && !trial_step->released) begin_linear(sim, trial_step, &history);
    do status = iterate(sim, c, trial_step, &history);
    while (status == 1);
    return status;
}

/* [-] Relative difference up to which steps count as equally long: the rounding of times, without effect on the rate of
 * convergence. */
#define DMB_REUSE_STEP 1e-6
/* [-] Initial residual above which reused factors make no correction: bodies touch in this step, and such a correction
 * would diverge. */
#define DMB_REUSE_START 0.1
/* [-] Largest weight of the damping at touch (eq:touch.weights) in factors that are kept. */
#define DMB_REUSE_WEIGHT 1e-3
/* Number of corrections that cost as much as new factors. */
#define DMB_EXCESS_MAX 2

void dmb_factor_reuse_begin(dmb_sim *sim, dmb_trial_step *trial_step)
{
    const double step = trial_step->end.step;
    const int usable = trial_step->keep != DMB_KEEP_NOTHING && trial_step->stage < DMB_STAGE_OWN &&
                       fabs(sim->reuse->step - step) <= DMB_REUSE_STEP * step && sim->reuse->pause == 0;
    trial_step->factored = usable ? DMB_FACTORS_REUSED : DMB_FACTORS_NONE;
    trial_step->tried |= usable;
    *sim->factors = trial_step->factored;
}

int32_t dmb_factor_reuse_still_pay(const dmb_sim *sim, const dmb_trial_step *trial_step,
                                   const dmb_convergence_history *history)
{
    if (trial_step->factored != DMB_FACTORS_REUSED || dmb_contact_changes(sim)) return 0;
    return history->corrections == 0 || (history->corrections < 3 && trial_step->residual < 0.25 * history->last);
}

int32_t dmb_factor_reuse_will_do(const dmb_sim *sim, const dmb_trial_step *trial_step,
                                 const dmb_convergence_history *history)
{
    if (trial_step->factored == DMB_FACTORS_NONE) return 0;
    if (trial_step->factored == DMB_FACTORS_REUSED && dmb_contact_changes(sim)) return 0;
    if (trial_step->factored == DMB_FACTORS_REUSED && history->corrections == 0)
        return trial_step->residual <= DMB_REUSE_START;
    const double rate = trial_step->residual / history->last;
    return rate * rate * trial_step->residual <= trial_step->bound;
}

/* Reused factors were sufficient for a whole step. */
static void count_success(dmb_factor_reuse *reuse, uint32_t corrections)
{
    if (reuse->corrections == 0 || corrections < reuse->corrections) reuse->corrections = corrections;
    if (corrections > reuse->corrections)
        reuse->excess += corrections - reuse->corrections;
    else if (reuse->excess > 0)
        reuse->excess--;
    reuse->back_off = 0;
    if (reuse->excess >= DMB_EXCESS_MAX) reuse->step = 0.0;
}

/* Fresh factors were needed; `tried`: after reused ones had failed, which doubles the back-off. */
static void count_pause(dmb_factor_reuse *reuse, int32_t tried)
{
    if (tried) {
        reuse->back_off = 2 * reuse->back_off + 1 < DMB_PAUSE_MAX ? 2 * reuse->back_off + 1 : DMB_PAUSE_MAX;
        reuse->pause = reuse->back_off - 1;
    } else if (reuse->pause > 0) {
        reuse->pause--;
    }
}

/* 1: a contact point is near touch. The factors contain the weight of its damping and fit no other step. */
static int32_t is_near_touch(const dmb_sim *sim, const dmb_configuration *reached)
{
    for (uint32_t s = 0; dmb_scene_has_touch(sim->scene) && s < sim->scene->site_count; s++)
        if (fabs(reached->site_touch[DMB_TOUCH_SIZE * (size_t)s + DMB_TOUCH_EXCESS]) > DMB_REUSE_WEIGHT) return 1;
    return 0;
}

void dmb_factor_reuse_end(dmb_sim *sim, const dmb_trial_step *trial_step, const dmb_configuration *reached)
{
    if (trial_step->keep == DMB_KEEP_NOTHING || trial_step->iterations == 0) return;
    if (trial_step->factored == DMB_FACTORS_REUSED) {
        count_success(sim->reuse, trial_step->iterations);
    } else if (trial_step->factored == DMB_FACTORS_FRESH) {
        count_pause(sim->reuse, trial_step->tried);
        dmb_keep_factors(sim, reached->quaternion);
        sim->reuse->step = is_near_touch(sim, reached) ? 0.0 : trial_step->end.step;
        sim->reuse->corrections = sim->reuse->excess = 0;
    }
}

void dmb_factor_reuse_revert(dmb_sim *sim, const dmb_trial_step *trial_step, const dmb_factor_reuse *kept)
{
    *sim->reuse = *kept;
    if (trial_step->keep == DMB_KEEP_AT_COMMIT && trial_step->factored == DMB_FACTORS_FRESH) dmb_forget_factors(sim);
}
