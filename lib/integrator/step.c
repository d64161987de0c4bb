#include "integrator/step.h"

#include <float.h>
#include <string.h>

#include "base/sized_struct.h"
#include "base/value_check.h"
#include "drillmbd/sim.h"
#include "integrator/attempt.h"
#include "integrator/corner.h"
#include "sim/access.h"
#include "sim/layout.h"
#include "system/assemble/drives.h"
#include "system/assemble/stuck.h"
#include "system/jump.h"
#include "system/solve/solve.h"
#include "system/start.h"

DMB_DECLARE_STRUCT(dmb_step_report)

int32_t dmb_walk_begin(dmb_sim *sim, const dmb_step_report *report, dmb_walk *walk)
{
    memset(walk, 0, sizeof *walk);
    (void)dmb_step_report_init(&walk->report, (uint32_t)sizeof walk->report);
    walk->counters = *sim->counters;
    dmb_step_report unused; /* only its size matters: what the caller's report holds is from an earlier call */
    return report == NULL ? DMB_OK : dmb_step_report_read(&unused, report);
}

int32_t dmb_walk_check(dmb_sim *sim, const char *field, double value, double bound)
{
    dmb_check check = dmb_check_of(&sim->message, "step", DMB_NONE);
    dmb_check_above(&check, field, value, bound);
    return check.status;
}

int32_t dmb_walk_check_at_most(dmb_sim *sim, const char *field, double value, double bound)
{
    dmb_check check = dmb_check_of(&sim->message, "step", DMB_NONE);
    dmb_check_within(&check, field, value, 0.0, bound);
    return check.status;
}

int32_t dmb_walk_commit(dmb_sim *sim, dmb_attempt *attempt, dmb_walk *walk)
{
    if (sim->follower != NULL) {
        if (dmb_stuck_largest_share(sim, &sim->trial, 1) >= 1.0) {
            dmb_message_set(&sim->message,
                            "step to time %g: a stuck place lets go there, which a derivative along the run must not "
                            "meet; end the run before it, or leave out the parameters",
                            attempt->end.time);
            return DMB_ERR_UNSUPPORTED;
        }
        const int32_t status = sim->follower->follow(sim->follower->context, attempt);
        if (status < 0) return status;
    }
    walk->report.steps++;
    walk->report.iterations += attempt->iterations;
    if (attempt->iterations > walk->report.most_iterations) walk->report.most_iterations = attempt->iterations;
    walk->report.residual = fmax(walk->report.residual, attempt->residual);
    walk->report.last_step = attempt->end.step;
    walk->rejected = walk->report.rejected;
    walk->iterations = walk->report.iterations;
    dmb_attempt_commit(sim, attempt);
    return DMB_OK;
}

/* A failure here leaves everything as before, the accelerations of before included, which is what there was anyway. */
void dmb_walk_corner(dmb_sim *sim)
{
    const uint32_t freed = sim->scene->stuck_count > 0 ? dmb_stuck_let_go(sim) : 0;
    if (freed > 0) dmb_forget_factors(sim);
    if (freed == 0 && !dmb_system_rate_jumps(sim)) return;
    sim->busy = DMB_BUSY_CHANGING;
    (void)dmb_system_jump(sim);
    sim->busy = DMB_BUSY_READABLE;
}

int32_t dmb_walk_stuck(dmb_sim *sim, const char *field, double step)
{
    const double t = sim->clock->time;
    dmb_message_set(&sim->message,
                    "step: %s = %g s is lost in the rounding of time at %g s, must be >= %g s there; leave it out or "
                    "add it to the next step",
                    field, step, t, 4.0 * DBL_EPSILON * t);
    return DMB_ERR_VALUE;
}

void dmb_walk_reject(dmb_sim *sim, const dmb_attempt *attempt, dmb_walk *walk)
{
    walk->report.rejected++;
    walk->report.iterations += attempt->iterations;
    if (attempt->status < 0) dmb_attempt_explain(sim, attempt);
}

int32_t dmb_walk_end(dmb_sim *sim, int32_t status, int32_t restore, dmb_step_report *report, const dmb_walk *walk)
{
    dmb_step_report out = walk->report;
    if (status ==
        DMB_ERR_CANCELLED) { /* tried again by the call that goes on from here, whose bits are then the same */
        out.rejected = walk->rejected;
        out.iterations = walk->iterations;
    }
    if (status < 0 && restore) { /* counters too: a failing call changes nothing */
        if (walk->set_aside) dmb_state_restore(sim);
        *sim->counters = walk->counters;
        out.steps = 0;
    } else { /* work spent in vain on the way counts */
        sim->counters->rejected = walk->counters.rejected + out.rejected;
        sim->counters->iterations = walk->counters.iterations + out.iterations;
    }
    out.time = sim->clock->time;
    if (report != NULL) (void)dmb_step_report_write(report, &out);
    if (status == DMB_ERR_CANCELLED && !restore) {
        dmb_message_set(&sim->message, "stopped at time %g after %u steps by the caller's progress function", out.time,
                        out.steps);
        return DMB_NOTE_CANCELLED;
    }
    if (status < 0) return status;
    if (walk->limited) {
        dmb_message_set(&sim->message, "step to time %g: relative residual = %g after %u iterations, accepted as asked",
                        out.time, out.residual, out.most_iterations);
        return DMB_NOTE_WORK_LIMITED;
    }
    if (walk->too_coarse) {
        dmb_message_set(&sim->message, "steps of step_min = %g were taken above the error tolerance",
                        sim->options.step_min);
        return DMB_NOTE_TOLERANCE;
    }
    dmb_message_clear(&sim->message);
    if (walk->stopped) {
        dmb_message_set(&sim->message, "stopped at time %g after max_steps = %u steps", out.time,
                        sim->options.max_steps);
        return DMB_NOTE_STOPPED;
    }
    if (!walk->was_cut) return DMB_OK;
    dmb_message_set(&sim->message, "step to time %g: divided into %u steps, %u rejected", out.time, out.steps,
                    out.rejected);
    return DMB_NOTE_STEP_CUT;
}

/* dmb_sim_step: one step of the asked length, divided at programme corners and where Newton does not converge. */

DMB_DECLARE_STRUCT(dmb_step_report)

/* [s] Longer steps are mistakes; halved on the way to each corner, they would not end either. */
#define DMB_DURATION_MAX 1e18

/* The next substep: not over a corner, nor leaving a sliver before the end. */
static dmb_step_end substep(const dmb_sim *sim, const dmb_step_end *goal, double cut)
{
    if (sim->options.bounded_work) return dmb_step_end_on_corner(dmb_step_end_over_corners(sim, goal));
    const dmb_step_end end = dmb_step_end_before_corner(sim, goal, cut);
    if (end.step - cut < 1e-6 * cut) return dmb_step_end_on_corner(end);
    return dmb_step_end_after(sim, cut);
}

/* One accepted step of at most `cut`, halving on failure. */
static int32_t take_substep(dmb_sim *sim, const dmb_step_end *goal, double *cut, uint32_t *cuts, dmb_walk *walk)
{
    dmb_attempt attempt;
    for (;;) {
        const dmb_step_end end = substep(sim, goal, *cut);
        if (!(end.time > sim->clock->time)) return dmb_walk_stuck(sim, "length", end.step);
        const int last = end.arrives;
        if (!last && !walk->set_aside) {
            dmb_state_back_up(sim);
            walk->set_aside = 1;
        }
        int32_t status = dmb_attempt_step(sim, &end, last && !walk->set_aside, &attempt);
        if (status >= 0 && sim->scene->stuck_count > 0 && !sim->options.bounded_work)
            status = dmb_attempt_to_release(sim, &attempt);
        if (status >= 0) {
            if (!attempt.end.arrives && !walk->set_aside) {
                dmb_state_back_up(sim);
                walk->set_aside = 1;
            }
            const int32_t refused = dmb_walk_commit(sim, &attempt, walk);
            if (refused < 0) return refused;
            dmb_walk_corner(sim);
            walk->arrived = attempt.end.arrives;
            *cut = *cuts > 0 ? 2.0 * end.step : (double)INFINITY; /* a corner nearby does not shorten what follows */
            if (*cuts > 0) --*cuts;
            return status;
        }
        dmb_walk_reject(sim, &attempt, walk);
        if (sim->options.bounded_work || dmb_is_final(status) || *cuts >= sim->options.max_cuts ||
            0.5 * end.step < sim->options.step_min)
            return status;
        ++*cuts;
        *cut = 0.5 * end.step;
        walk->was_cut = 1;
    }
}

static int32_t step(dmb_sim *sim, double duration, dmb_step_report *report)
{
    dmb_walk walk;
    double cut = (double)INFINITY;
    uint32_t cuts = 0;
    int32_t status = dmb_walk_begin(sim, report, &walk);
    if (status < 0) return status;
    status = dmb_walk_check(sim, "duration", duration, 0.0);
    if (status < 0) return status;
    status = dmb_walk_check_at_most(sim, "duration", duration, DMB_DURATION_MAX);
    if (status < 0) return status;
    const dmb_step_end goal = dmb_step_end_after(sim, duration);
    if (!(goal.time > sim->clock->time)) return dmb_walk_stuck(sim, "duration", duration);
    while (status >= 0 && !walk.arrived) {
        status = take_substep(sim, &goal, &cut, &cuts, &walk);
        if (status == DMB_NOTE_WORK_LIMITED) walk.limited = 1;
    }
    return dmb_walk_end(sim, status, 1, report, &walk);
}

int32_t dmb_sim_step(dmb_sim *sim, double duration, dmb_step_report *report)
{
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    return status < 0 ? status : dmb_sim_leave(sim, step(sim, duration, report));
}
