#include "integrator/newton.h"

#include <float.h>
#include <string.h>

#include "integrator/step_motion.h"
#include "sim/access.h"
#include "system/assemble/assemble.h"
#include "system/constrain/constrain.h"
#include "system/solve/solve.h"
#include "system/system.h"

/* Newton gives up when the residual has grown this much over its start. */
#define DMB_NEWTON_GROWTH 1e6

/* True if what is left is the rounding of the forces at the start: in free flight after a contact nothing else is there
 * to compare it with. */
static int32_t is_rounding(const dmb_attempt *attempt, double balance, dmb_newton_course *course)
{
    if (course->balance > 0.0) return attempt->residual * balance <= 4.0 * DBL_EPSILON * course->balance;
    course->balance = balance;
    return 0;
}

/* Near a singular place of the joints: poses settled to 2e-15 leave the null space unsharp by as much over the quality
 * of the partition squared (measured: up to 4e-14/quality^2 of the forces). A residual that no longer falls is as good
 * as it gets there. */
static int32_t is_unsharp(const dmb_sim *sim, const dmb_attempt *attempt, const dmb_newton_course *course)
{
    double quality = 1.0;
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++) quality = fmin(quality, sim->cluster_quality[k]);
    if (!(quality < 0.1) || !(course->last > 0.0) || attempt->residual <= 0.5 * course->last) return 0;
    return attempt->residual <= fmin(1e-4, 4e-14 / (quality * quality));
}

/* 1: as it should be. */
static int32_t check_course(const dmb_sim *sim, const dmb_attempt *attempt, dmb_newton_course *course)
{
    if (course->first == 0.0) course->first = course->last = attempt->residual;
    if (!(attempt->residual <= DMB_NEWTON_GROWTH * course->first)) return DMB_ERR_NO_CONVERGENCE; /* NaN, too */
    if (attempt->residual > DBL_MAX) return DMB_ERR_NO_CONVERGENCE;
    if (attempt->iterations < sim->options.max_iterations) return 1;
    return sim->options.bounded_work ? DMB_NOTE_WORK_LIMITED : DMB_ERR_NO_CONVERGENCE;
}

/* Fresh factors at the present trial. */
static int32_t refactor(dmb_sim *sim, dmb_attempt *attempt)
{
    if (!attempt->evaluation.tangent) {
        attempt->evaluation.tangent = 1;
        const int32_t status = dmb_system_evaluate(&attempt->evaluation);
        if (status < 0) return status;
    }
    dmb_system_iteration_matrix(&attempt->evaluation);
    const int64_t bad = dmb_factor_matrix(sim, sim->options.constraint_method);
    attempt->factored = DMB_FACTORS_FRESH;
    if (bad < 0) return DMB_OK;
    attempt->block = (uint32_t)bad;
    return DMB_ERR_SINGULAR;
}

/* The tolerance asked for is reached: reused factors only aimed lower. */
static int32_t is_met(const dmb_sim *sim, const dmb_attempt *attempt)
{
    return attempt->factored == DMB_FACTORS_REUSED &&
           dmb_residual_norm_of(&attempt->evaluation, sim->options.newton_tolerance).converged != 0;
}

/* Residual, and the tangent where it will be needed at once, on the constraints. */
static int32_t evaluate(dmb_sim *sim, dmb_attempt *attempt)
{
    dmb_evaluation *evaluation = &attempt->evaluation;
    evaluation->tangent = attempt->factored == DMB_FACTORS_NONE;
    const int32_t status = sim->scene->cluster_count ? dmb_clusters_settle(evaluation, DMB_SETTLE_ALL, 1) : DMB_OK;
    return status < 0 ? status : dmb_system_evaluate(evaluation);
}

/* Verdict of the residual. 1: a correction is due, 0 or DMB_NOTE_WORK_LIMITED: done, < 0: given up. */
static int32_t judge(const dmb_sim *sim, dmb_attempt *attempt, dmb_newton_course *course)
{
    const dmb_residual_norm norm = dmb_residual_norm_of(&attempt->evaluation, dmb_factor_reuse_aim(sim, attempt));
    attempt->residual = norm.relative;
    course->hidden = norm.converged == DMB_AT_ROUNDING && dmb_factor_reuse_still_pay(sim, attempt, course);
    if (norm.converged && !course->hidden) return 0;
    if (is_rounding(attempt, norm.balance, course) || is_unsharp(sim, attempt, course)) return 0;
    const int32_t status = check_course(sim, attempt, course);
    return status != 1 && is_met(sim, attempt) ? 0 : status;
}

/* Moves the trial by the correction that the factors at hand give. */
static void correct(dmb_sim *sim, const dmb_generalized_alpha *c, dmb_attempt *attempt)
{
    dmb_solve_correction(sim);
    attempt->iterations++;
    if (attempt->factored == DMB_FACTORS_FRESH) { /* kept ones give way to a tangent at the true stress */
        dmb_system_extrapolate_stress(sim, sim->correction);
        attempt->evaluation.extrapolated = 1;
    }
    dmb_step_motion_correct(sim, c, attempt->end.step);
}

/* One Newton iteration; 1: go on, otherwise as dmb_newton. */
static int32_t iterate(dmb_sim *sim, const dmb_generalized_alpha *c, dmb_attempt *attempt, dmb_newton_course *course)
{
    int32_t status = dmb_progress_pulse(sim);
    if (status >= 0) status = evaluate(sim, attempt);
    if (status >= 0) status = judge(sim, attempt, course);
    if (status != 1) return status;
    if (!course->hidden && !dmb_factor_reuse_will_do(sim, attempt, course)) {
        if (course->corrections > 0 && is_met(sim, attempt)) return 0;
        status = refactor(sim, attempt);
        if (status < 0) return status;
    }
    course->last = attempt->residual;
    course->corrections++;
    correct(sim, c, attempt);
    return 1;
}

int32_t dmb_newton(dmb_sim *sim, const dmb_generalized_alpha *c, dmb_attempt *attempt)
{
    dmb_newton_course course;
    int32_t status;
    memset(&course, 0, sizeof course);
    dmb_factor_reuse_begin(sim, attempt);
    do status = iterate(sim, c, attempt, &course);
    while (status == 1);
    return status;
}

/* Steps count as equally long that differ by this part: by the rounding of times, and what no rate of convergence
 * feels. */
#define DMB_REUSE_STEP 1e-6
/* Steps that begin with a residual above this part of their forces are those in which bodies meet: a correction by
 * reused factors would lead astray. */
#define DMB_REUSE_START 0.1
/* Longest pause in steps between tries of reused factors. */
#define DMB_PAUSE_MAX 31
/* New factors cost about as much as this many corrections with old ones. */
#define DMB_EXCESS_MAX 2

void dmb_factor_reuse_begin(dmb_sim *sim, dmb_attempt *attempt)
{
    const double step = attempt->end.step;
    const int usable = attempt->whole && !attempt->astray && fabs(sim->reuse->step - step) <= DMB_REUSE_STEP * step &&
                       sim->reuse->pause == 0;
    attempt->factored = usable ? DMB_FACTORS_REUSED : DMB_FACTORS_NONE;
    attempt->tried |= usable;
    *sim->factors = attempt->factored;
}

int32_t dmb_factor_reuse_still_pay(const dmb_sim *sim, const dmb_attempt *attempt, const dmb_newton_course *course)
{
    if (attempt->factored != DMB_FACTORS_REUSED || dmb_contact_changes(sim)) return 0;
    return course->corrections == 0 || (course->corrections < 3 && attempt->residual < 0.25 * course->last);
}

int32_t dmb_factor_reuse_will_do(const dmb_sim *sim, const dmb_attempt *attempt, const dmb_newton_course *course)
{
    if (attempt->factored == DMB_FACTORS_NONE) return 0;
    if (attempt->factored == DMB_FACTORS_REUSED && dmb_contact_changes(sim)) return 0;
    if (attempt->factored == DMB_FACTORS_REUSED && course->corrections == 0)
        return attempt->residual <= DMB_REUSE_START;
    const double rate = attempt->residual / course->last;
    return rate * rate * attempt->residual <= dmb_factor_reuse_aim(sim, attempt);
}

/* Kept factors have done for a whole step. */
static void count_success(dmb_factor_reuse *reuse, uint32_t corrections)
{
    if (reuse->corrections == 0 || corrections < reuse->corrections) reuse->corrections = corrections;
    reuse->excess += corrections - reuse->corrections;
    reuse->back_off = 0;
    if (reuse->excess >= DMB_EXCESS_MAX) reuse->step = 0.0;
}

/* Fresh factors were needed, after kept ones had been tried or without a try. */
static void count_pause(dmb_factor_reuse *reuse, int32_t tried)
{
    if (tried) {
        reuse->back_off = 2 * reuse->back_off + 1 < DMB_PAUSE_MAX ? 2 * reuse->back_off + 1 : DMB_PAUSE_MAX;
        reuse->pause = reuse->back_off - 1;
    } else if (reuse->pause > 0) {
        reuse->pause--;
    }
}

void dmb_factor_reuse_end(dmb_sim *sim, const dmb_attempt *attempt)
{
    if (!attempt->whole) return;
    if (attempt->factored == DMB_FACTORS_REUSED) {
        count_success(sim->reuse, attempt->iterations);
    } else if (attempt->factored == DMB_FACTORS_FRESH) {
        count_pause(sim->reuse, attempt->tried);
        dmb_keep_factors(sim);
        sim->reuse->step = attempt->end.step;
        sim->reuse->corrections = sim->reuse->excess = 0;
    }
}
