/* Steps of fixed length (dmb_sim_step, dmb_sim_steps) and steps with error control (dmb_sim_advance). Both try trial
 * steps (integrator/trial_step) and accept or reject them here.
 *
 *     trial step            fixed length                             error control
 *     -------------------   --------------------------------------   -----------------------------------------------
 *     succeeds              accept; after cuts double the length     error <= 1, or h = step_min: accept, h from the
 *                                                                    error ahead; otherwise repeat with <= 0.8 h
 *     work limit reached    accept with DMB_NOTE_WORK_LIMITED        counts as no convergence
 *     does not converge     repeat with h/2, at most max_cuts times  repeat with h/4, not below step_min
 *                           and not below step_min
 *     cancelled, callback   return the status                        return the status
 *       or memory failed
 *     stuck place releases  shorten the step to the release, accept  the same
 *
 * A failing dmb_sim_step restores the state before the call; dmb_sim_advance keeps the steps accepted so far. With
 * bounded_work, a fixed step is neither divided nor repeated. After acceptance (accept): release of stuck places,
 * widening of the hole, jumps of commands and of prescribed rates; any of them restarts the accelerations. */
#include "integrator/step.h"

#include <float.h>
#include <string.h>

#include "base/sized_struct.h"
#include "base/value_check.h"
#include "drillmbd/run.h"
#include "integrator/breakpoint.h"
#include "integrator/newton.h"
#include "integrator/trial_step.h"
#include "math/elementary.h"
#include "sim/access.h"
#include "sim/layout.h"
#include "system/assemble/actuators.h"
#include "system/assemble/assemble.h"
#include "system/assemble/caller_force.h"
#include "system/assemble/drives.h"
#include "system/solve/solve.h"
#include "system/system.h"

DMB_DECLARE_STRUCT(dmb_step_report)

int32_t dmb_stepping_begin(dmb_sim *sim, const dmb_step_report *report, dmb_stepping *stepping)
{
    memset(stepping, 0, sizeof *stepping);
    (void)dmb_step_report_init(&stepping->report, (uint32_t)sizeof stepping->report);
    stepping->counters = *sim->counters;
    dmb_step_report unused; /* only the size is checked: the contents of the report are those of an earlier call */
    return report == NULL ? DMB_OK : dmb_step_report_read(&unused, report);
}

int32_t dmb_stepping_check(dmb_sim *sim, const char *field, double value, double bound)
{
    dmb_check check = dmb_check_of(&sim->message, "step", DMB_NONE);
    dmb_check_above(&check, field, value, bound);
    return check.status;
}

int32_t dmb_stepping_check_at_most(dmb_sim *sim, const char *field, double value, double bound)
{
    dmb_check check = dmb_check_of(&sim->message, "step", DMB_NONE);
    dmb_check_within(&check, field, value, 0.0, bound);
    return check.status;
}

/* 1 if forces or the rate of a time function may jump at the end of the step, so that accelerations may have to be
 * recomputed. *rate_jumps: the rate jumps. DMB_ERR_CALLBACK. */
static int32_t may_jump(dmb_sim *sim, const dmb_trial_step *trial_step, int32_t *rate_jumps)
{
    const dmb_scene *scene = sim->scene;
    *rate_jumps =
        dmb_system_rate_jumps(sim, trial_step->end.time, fmax(trial_step->end.breakpoint, sim->clock->breakpoint));
    if (*rate_jumps != 0) return *rate_jumps;
    return scene->hole.cuts > 0 || dmb_stuck_largest_ratio(sim, &sim->trial, 1) >= DMB_STUCK_REACHED ||
           dmb_actuators_may_jump(scene);
}

/* Recomputes the accelerations if forces or the rate of a time function jump at the time reached; *jumped: they do.
 * Stuck places and the hole change the equations, commands and prescribed rates only their right side; one solution for
 * the accelerations serves all of them. It runs callbacks while accelerations and forces do not belong together, so
 * that queries are refused meanwhile. A released place removes its spring from the iteration matrix: factors made with
 * it are discarded. */
static int32_t stepping_breakpoint(dmb_sim *sim, int32_t rate_jumps, int *jumped)
{
    const uint32_t freed = sim->scene->stuck_count > 0 ? dmb_stuck_let_go(sim) : 0;
    const int widened = sim->scene->hole.cuts > 0 && dmb_hole_cut(sim);
    *jumped = freed > 0 || widened || rate_jumps || dmb_actuators_jump(sim);
    if (!*jumped) return DMB_OK;
    sim->busy = DMB_BUSY_CHANGING;
    const int32_t status = dmb_system_jump(sim);
    sim->busy = DMB_BUSY_READABLE;
    if (status >= 0 && freed > 0) dmb_forget_factors(sim);
    return status;
}

/* Accepts the step: trial becomes now, then the accelerations restart if something jumps at the time reached.
 *
 *     order                                         on failure
 *     -------------------------------------------   --------------------------------------------------------------
 *     1. may_jump: is a restart possible?           nothing has changed yet
 *     2. back up the state, if so and if this call
 *        has no backup                              (cannot fail)
 *     3. commit                                     (cannot fail)
 *     4. restart of the accelerations               state from the backup (of the call: dmb_stepping_end restores it),
 *                                                   factors made by this step are discarded
 *
 * Most steps end at step 3 without the copy of the state. If a callback may still fail in 4, factors are kept only
 * after it (DMB_KEEP_AFTER_JUMP), and not at all if the accelerations were recomputed. */
static int32_t accept(dmb_sim *sim, dmb_trial_step *trial_step, dmb_stepping *stepping)
{
    const dmb_factor_reuse kept = *sim->reuse;
    int jumped = 0;
    int32_t rate_jumps = 0, status = may_jump(sim, trial_step, &rate_jumps);
    if (status >= 0) {
        if (status > 0 && sim->scene->has_callback && trial_step->keep == DMB_KEEP_AT_COMMIT)
            trial_step->keep = DMB_KEEP_AFTER_JUMP;
        if (status > 0 && !stepping->backed_up) dmb_state_back_up(sim);
        dmb_trial_step_commit(sim, trial_step);
        status = stepping_breakpoint(sim, rate_jumps, &jumped);
        if (status >= 0) {
            if (trial_step->keep == DMB_KEEP_AFTER_JUMP && !jumped) dmb_factor_reuse_end(sim, trial_step, &sim->now);
            return DMB_OK;
        }
        if (!stepping->backed_up) dmb_state_restore(sim);
        dmb_factor_reuse_revert(sim, trial_step, &kept);
    }
    stepping->report.steps--;
    stepping->report.rejected++;
    return status;
}

/* A companion looks at the step first, while now and trial are both complete: its refusal then leaves the state as it
 * was. */
int32_t dmb_stepping_commit(dmb_sim *sim, dmb_trial_step *trial_step, dmb_stepping *stepping)
{
    if (sim->follower != NULL) {
        if (dmb_stuck_largest_ratio(sim, &sim->trial, 1) >= DMB_STUCK_REACHED) {
            dmb_message_set(
                &sim->message,
                "step to time %g: a stuck place is released there, which a derivative along the run must not "
                "meet; end the run before it, or leave out the parameters",
                trial_step->end.time);
            return DMB_ERR_UNSUPPORTED;
        }
        const int32_t status = sim->follower->follow(sim->follower->context, trial_step);
        if (status < 0) return status;
    }
    stepping->report.steps++;
    stepping->report.iterations += trial_step->iterations;
    if (trial_step->iterations > stepping->report.most_iterations)
        stepping->report.most_iterations = trial_step->iterations;
    stepping->report.residual = fmax(stepping->report.residual, trial_step->residual);
    stepping->report.last_step = trial_step->end.step;
    stepping->rejected = stepping->report.rejected;
    stepping->iterations = stepping->report.iterations;
    return accept(sim, trial_step, stepping);
}

int32_t dmb_stepping_stuck(dmb_sim *sim, const char *field, double step)
{
    const double t = sim->clock->time;
    dmb_message_set(&sim->message,
                    "step: %s = %g s is lost in the rounding of time at %g s, must be >= %g s there; leave it out or "
                    "add it to the next step",
                    field, step, t, 4.0 * DBL_EPSILON * t);
    return DMB_ERR_VALUE;
}

void dmb_stepping_reject(dmb_sim *sim, const dmb_trial_step *trial_step, dmb_stepping *stepping)
{
    stepping->report.rejected++;
    stepping->report.iterations += trial_step->iterations;
    if (trial_step->status < 0) dmb_trial_step_explain(sim, trial_step);
}

int dmb_stepping_ends(dmb_sim *sim)
{
    if (sim->scene->force_count > 0) dmb_caller_laws_accept(sim);
    dmb_friction_accept(sim);
    return sim->on_step != NULL && sim->on_step(sim->on_step_context, sim) != 0;
}

void dmb_stepping_tell_end(dmb_sim *sim, uint32_t steps)
{
    dmb_message_set(&sim->message, "stopped at time %g after %u steps by the caller's function of accepted steps",
                    sim->clock->time, steps);
}

int32_t dmb_stepping_stops(dmb_sim *sim, double time, const dmb_stepping *stepping)
{
    sim->counters->rejected = stepping->counters.rejected + stepping->report.rejected;
    sim->counters->iterations = stepping->counters.iterations + stepping->report.iterations;
    const int ended = dmb_stepping_ends(sim);
    if (!(sim->clock->time < time)) return 0;
    if (ended) return 2;
    return stepping->report.steps == sim->options.max_steps;
}

/* Status of the call, the first that applies:
 *
 *     cancelled, steps kept (dmb_sim_advance)     DMB_NOTE_CANCELLED
 *     failure                                     the failure; state and counters as before the call if it restores
 *                                                 or accepted no step
 *     stopped by the caller, or by max_steps      DMB_NOTE_STOPPED: the requested time was not reached
 *     work limit reached in some step             DMB_NOTE_WORK_LIMITED
 *     error above the tolerance at step_min       DMB_NOTE_TOLERANCE
 *     the requested step was divided              DMB_NOTE_STEP_CUT */
int32_t dmb_stepping_end(dmb_sim *sim, int32_t status, int32_t restore, dmb_step_report *report,
                         const dmb_stepping *stepping)
{
    dmb_step_report out = stepping->report;
    if (status == DMB_ERR_CANCELLED) { /* the next call repeats this work and obtains the same bits */
        out.rejected = stepping->rejected;
        out.iterations = stepping->iterations;
    }
    if (status < 0 && (restore || out.steps == 0)) { /* counters are restored too: a failing call changes nothing */
        if (restore && stepping->backed_up) dmb_state_restore(sim);
        *sim->counters = stepping->counters;
        out.steps = 0;
    } else { /* rejected work counts */
        sim->counters->rejected = stepping->counters.rejected + out.rejected;
        sim->counters->iterations = stepping->counters.iterations + out.iterations;
    }
    out.time = sim->clock->time;
    if (report != NULL) (void)dmb_step_report_write(report, &out);
    if (status == DMB_ERR_CANCELLED && !restore) {
        dmb_message_set(&sim->message, "stopped at time %g after %u steps by the caller's progress function", out.time,
                        out.steps);
        return DMB_NOTE_CANCELLED;
    }
    if (status < 0) return status;
    /* Before the notes on accuracy: the requested time was not reached. */
    if (stepping->stopped == 2) {
        dmb_stepping_tell_end(sim, out.steps);
        return DMB_NOTE_STOPPED;
    }
    if (stepping->stopped) {
        dmb_message_set(&sim->message, "stopped at time %g after max_steps = %u steps", out.time,
                        sim->options.max_steps);
        return DMB_NOTE_STOPPED;
    }
    if (stepping->limited) {
        dmb_message_set(&sim->message, "step to time %g: relative residual = %g after %u iterations, accepted as asked",
                        out.time, out.residual, out.most_iterations);
        return DMB_NOTE_WORK_LIMITED;
    }
    if (stepping->too_coarse) {
        dmb_message_set(&sim->message, "steps of step_min = %g were taken above the error tolerance",
                        sim->options.step_min);
        return DMB_NOTE_TOLERANCE;
    }
    dmb_message_clear(&sim->message);
    if (!stepping->was_cut) return DMB_OK;
    dmb_message_set(&sim->message, "step to time %g: divided into %u steps, %u rejected", out.time, out.steps,
                    out.rejected);
    return DMB_NOTE_STEP_CUT;
}

/* ---- dmb_sim_step: one step of the requested length, divided at breakpoints of time functions and if Newton does not
 * converge ----------------------------------------------------------------------------------------------------------
 */

/* [s] Longer steps are mistakes; their division at breakpoints by halving would not end. */
#define DMB_DURATION_MAX 1e18

/* End of the next substep: at most `cut` long, not beyond a breakpoint, and without a sliver before the end. With
 * bounded_work the step is never divided; a breakpoint inside it is passed on to the drives, which integrate over it.
 */
static dmb_step_end substep(const dmb_sim *sim, const dmb_step_end *goal, double cut)
{
    if (sim->options.bounded_work) return dmb_step_end_on_breakpoint(dmb_step_end_over_breakpoints(sim, goal));
    const dmb_step_end end = dmb_step_end_before_breakpoint(sim, goal, cut);
    if (end.step - cut < 1e-6 * cut) return dmb_step_end_on_breakpoint(end);
    return dmb_step_end_after(sim, cut);
}

/* Takes one accepted substep of at most `cut` [s], halved after each failure. `cuts` counts the halvings in force, not
 * all that were made: each accepted substep undoes one by doubling the length, and without one in force the next
 * substep goes to the end of the requested step. The state is backed up before the first substep that does not end the
 * call: a single step that fails has written the trial only. A step that is shortened to the release of a stuck place
 * no longer ends the call, hence the second place where the backup is made. */
static int32_t advance_substep(dmb_sim *sim, const dmb_step_end *goal, double *cut, uint32_t *cuts,
                               dmb_stepping *stepping)
{
    dmb_trial_step trial_step;
    for (;;) {
        dmb_step_end end = substep(sim, goal, *cut);
        end.asked = goal->step;
        if (!(end.time > sim->clock->time)) return dmb_stepping_stuck(sim, "length", end.step);
        const int last = end.arrives;
        if (!last && !stepping->backed_up) {
            dmb_state_back_up(sim);
            stepping->backed_up = 1;
        }
        int32_t status = dmb_trial_step_run(sim, &end, last && !stepping->backed_up, &trial_step);
        if (status >= 0 && sim->scene->stuck_count > 0 && !sim->options.bounded_work)
            status = dmb_trial_step_to_release(sim, &trial_step);
        if (status >= 0) {
            if (!trial_step.end.arrives && !stepping->backed_up) {
                dmb_state_back_up(sim);
                stepping->backed_up = 1;
            }
            const int32_t refused = dmb_stepping_commit(sim, &trial_step, stepping);
            if (refused < 0) return refused;
            stepping->arrived = trial_step.end.arrives;
            *cut = *cuts > 0 ? 2.0 * end.step : (double)INFINITY; /* a breakpoint does not shorten later substeps */
            if (*cuts > 0) --*cuts;
            return status;
        }
        dmb_stepping_reject(sim, &trial_step, stepping);
        if (sim->options.bounded_work || dmb_is_final(status) || *cuts >= sim->options.max_cuts ||
            0.5 * end.step < sim->options.step_min)
            return status;
        ++*cuts;
        *cut = 0.5 * end.step;
        stepping->was_cut = 1;
    }
}

static int32_t step(dmb_sim *sim, double duration, dmb_step_report *report)
{
    dmb_stepping stepping;
    double cut = (double)INFINITY;
    uint32_t cuts = 0;
    int32_t status = dmb_stepping_begin(sim, report, &stepping);
    if (status < 0) return status;
    status = dmb_stepping_check(sim, "duration", duration, 0.0);
    if (status < 0) return status;
    status = dmb_stepping_check_at_most(sim, "duration", duration, DMB_DURATION_MAX);
    if (status < 0) return status;
    const dmb_step_end goal = dmb_step_end_after(sim, duration);
    if (!(goal.time > sim->clock->time)) return dmb_stepping_stuck(sim, "duration", duration);
    while (status >= 0 && !stepping.arrived) {
        status = advance_substep(sim, &goal, &cut, &cuts, &stepping);
        if (status == DMB_NOTE_WORK_LIMITED) stepping.limited = 1;
    }
    return dmb_stepping_end(sim, status, 1, report, &stepping);
}

int32_t dmb_sim_step(dmb_sim *sim, double duration, dmb_step_report *report)
{
    int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    if (status < 0) return status;
    status = step(sim, duration, report);
    if (status >= 0) (void)dmb_stepping_ends(sim);
    return dmb_sim_leave(sim, status);
}

/* ---- Equal steps in one call ------------------------------------------------------------------------------------- */

/* Adds the work of one step to the total; a failing step adds its rejected trial steps. */
static void add_report(dmb_step_report *sum, const dmb_step_report *one)
{
    sum->steps += one->steps;
    sum->iterations += one->iterations;
    sum->rejected += one->rejected;
    if (one->steps == 0) return;
    if (one->most_iterations > sum->most_iterations) sum->most_iterations = one->most_iterations;
    sum->residual = fmax(sum->residual, one->residual);
    sum->last_step = one->last_step;
}

/* Keeps the most important status with its message: a failure, otherwise the largest of the notes 0 < 1 < 2. */
static void note_step(const dmb_sim *sim, int32_t status, int32_t *worst, dmb_message *message)
{
    if (status > 0 && status < *worst) return;
    if (status == DMB_OK) return;
    *worst = status;
    *message = sim->message;
}

/* Checks the arguments as dmb_sim_step does, before the first step. */
static int32_t check_steps(dmb_sim *sim, double duration, const dmb_step_report *report)
{
    dmb_stepping unused;
    int32_t status = dmb_stepping_begin(sim, report, &unused);
    if (status >= 0) status = dmb_stepping_check(sim, "duration", duration, 0.0);
    return status < 0 ? status : dmb_stepping_check_at_most(sim, "duration", duration, DMB_DURATION_MAX);
}

/* After an accepted step: the watch, whose failure is that of the call, and the caller's function. */
static int32_t look(dmb_sim *sim, const dmb_step_watch *watch, int32_t *worst, dmb_message *message, int *ended)
{
    const int32_t seen = watch != NULL ? watch->look(watch->context) : DMB_OK;
    if (seen < 0) note_step(sim, seen, worst, message);
    *ended = dmb_stepping_ends(sim);
    return seen;
}

int32_t dmb_steps_watched(dmb_sim *sim, double duration, uint32_t count, uint32_t *done, dmb_step_report *report,
                          const dmb_step_watch *watch)
{
    dmb_step_report sum = dmb_step_report_default();
    dmb_message message;
    uint32_t accepted = 0;
    int ended = 0;
    int32_t worst = DMB_OK, seen = 0, status = check_steps(sim, duration, report);
    if (status < 0) return status;
    while (status >= 0 && seen == 0 && accepted < count && !ended) {
        dmb_step_report one = dmb_step_report_default();
        dmb_progress_at(sim, (double)accepted / count);
        status = step(sim, duration, &one);
        add_report(&sum, &one);
        note_step(sim, status, &worst, &message);
        if (status < 0) break;
        accepted++;
        seen = look(sim, watch, &worst, &message, &ended);
    }
    if (ended && seen == 0 && accepted < count) {
        dmb_stepping_tell_end(sim, sum.steps);
        note_step(sim, DMB_NOTE_STOPPED, &worst, &message);
    }
    if (worst != DMB_OK) sim->message = message;
    sum.time = sim->clock->time;
    if (done != NULL) *done = accepted;
    if (report != NULL) (void)dmb_step_report_write(report, &sum);
    return worst;
}

int32_t dmb_sim_steps(dmb_sim *sim, double duration, uint32_t count, uint32_t *done, dmb_step_report *report)
{
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    return status < 0 ? status : dmb_sim_leave(sim, dmb_steps_watched(sim, duration, count, done, report, NULL));
}

/* dmb_sim_advance: steps whose local error satisfies the tolerances. The estimate is of third order, therefore
 *     h_new = h clamp(0.9 err^(-1/3), 0.2, 2)                                              (eq:integration.local-error)
 * with the error ahead of the step instead of its own (eq:integration.error-ahead): steps that follow the error through
 * the zeros of an oscillation change four times a period, and each change leaves a part of h_1^2 - h_2^2 of the energy
 * that equal steps return (eq:integration.energy-left). */

/* ---- Error-controlled steps -------------------------------------------------------------------------------------- */

/* Step length after an error of `error` tolerances. Without constraint components, factors of a step of the same length
 * can be reused, so the length is kept while the ratio lies in 0.9 .. 1.2; with them, each step makes its own factors.
 */
static double next_step(const dmb_sim *sim, double h, double error)
{
    double ratio = error > 0.0 ? 0.9 * dmb_pow(error, -1.0 / 3.0) : 2.0;
    ratio = fmin(fmax(ratio, 0.2), 2.0);
    if (sim->scene->cluster_count == 0 && ratio > 0.9 && ratio < 1.2) ratio = 1.0;
    return fmin(fmax(ratio * h, sim->options.step_min), sim->options.step_max);
}

/* Step length after a rejected step: always shorter, because the same length would be rejected again. */
static double retry_step(const dmb_sim *sim, double h, double error)
{
    return fmax(fmin(next_step(sim, h, error), 0.8 * h), sim->options.step_min);
}

double dmb_advance_first(const dmb_sim *sim)
{
    if (sim->clock->next_step > 0.0) return sim->clock->next_step;
    return fmin(sim->options.step_max, fmax(1e-4, sim->options.step_min));
}

/* A step of about h that ends neither beyond `time` nor beyond a breakpoint, and leaves no sliver. If more than half of
 * the distance is wanted, the distance is halved: two equal steps instead of one and a short rest. */
static dmb_step_end fit(const dmb_sim *sim, double h, double time)
{
    const dmb_step_end goal = dmb_step_end_at(sim, time);
    const dmb_step_end end = dmb_step_end_before_breakpoint(sim, &goal, h);
    if (h >= end.step) return end;
    return dmb_step_end_after(sim, h > 0.5 * end.step ? 0.5 * end.step : h);
}

/* Proposed length after a step of length h. A step cut short at a breakpoint changes the proposal only downwards or
 * beyond it. */
static double wanted_after(const dmb_sim *sim, double h, double wanted, double error, int retried)
{
    const double next = next_step(sim, h, error);
    if (next > wanted && retried) return wanted; /* a longer step has just failed */
    return next > wanted || h >= wanted * 0.999 || next < h ? next : wanted;
}

void dmb_advance_propose(dmb_sim *sim, double wanted)
{
    sim->clock->next_step = wanted;
}

/* A step without a solution has no error estimate: it is quartered. A result at the work limit counts as such a step,
 * because eq:integration.local-error supposes that the equations of the scheme are satisfied. Whether a step is
 * accepted depends on its own error, the length of the next on the error ahead. At step_min the step is accepted with
 * any error, so that the call always comes to an end; DMB_NOTE_TOLERANCE reports it. */
int32_t dmb_advance_once(dmb_sim *sim, double time, double *wanted, dmb_stepping *stepping)
{
    dmb_trial_step trial_step;
    for (int retried = 0;; retried = 1) {
        const dmb_step_end end = fit(sim, *wanted, time);
        const double h = end.step;
        if (!(end.time > sim->clock->time)) return dmb_stepping_stuck(sim, "length", h);
        int32_t status = dmb_trial_step_run(sim, &end, 1, &trial_step);
        if (status == DMB_NOTE_WORK_LIMITED)
            status = trial_step.status = DMB_ERR_NO_CONVERGENCE; /* steps are not accepted at the work limit here */
        if (status >= 0 && sim->scene->stuck_count > 0) status = dmb_trial_step_to_release(sim, &trial_step);
        const double taken = trial_step.end.step;
        const int smallest = !(h > sim->options.step_min * 1.0001);
        const dmb_step_error error = status >= 0 ? dmb_trial_step_error(sim, taken) : (dmb_step_error){0.0, 0.0};
        if (status >= 0 && (error.here <= 1.0 || smallest)) {
            if (!(taken < h)) *wanted = wanted_after(sim, h, *wanted, error.ahead, retried);
            if (error.here > 1.0) stepping->too_coarse = 1;
            const int32_t refused = dmb_stepping_commit(sim, &trial_step, stepping);
            if (refused < 0) return refused;
            dmb_advance_propose(sim, *wanted);
            return status;
        }
        dmb_stepping_reject(sim, &trial_step, stepping);
        if (status < 0 && (smallest || dmb_is_final(status))) return status;
        *wanted = status >= 0 ? retry_step(sim, h, error.ahead) : fmax(0.25 * h, sim->options.step_min);
    }
}

static int32_t advance(dmb_sim *sim, double time, dmb_step_report *report)
{
    dmb_stepping stepping;
    int32_t status = dmb_stepping_begin(sim, report, &stepping);
    if (status < 0) return status;
    status = dmb_stepping_check(sim, "time", time, sim->clock->time);
    if (status < 0) return status;
    const double start = sim->clock->time;
    double wanted = dmb_advance_first(sim);
    while (status >= 0 && sim->clock->time < time && !stepping.stopped) {
        dmb_progress_at(sim, (sim->clock->time - start) / (time - start));
        status = dmb_advance_once(sim, time, &wanted, &stepping);
        if (status >= 0) stepping.stopped = dmb_stepping_stops(sim, time, &stepping);
    }
    return dmb_stepping_end(sim, status, 0, report, &stepping);
}

int32_t dmb_sim_advance(dmb_sim *sim, double time, dmb_step_report *report)
{
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    return status < 0 ? status : dmb_sim_leave(sim, advance(sim, time, report));
}
