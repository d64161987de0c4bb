#include "integrator/walk.h"

#include <float.h>
#include <string.h>

#include "base/check.h"
#include "base/sized_struct.h"
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
    dmb_check check = dmb_check_of(&sim->message, "step", DMB_NO_INDEX);
    dmb_check_above(&check, field, value, bound);
    return check.status;
}

int32_t dmb_walk_check_at_most(dmb_sim *sim, const char *field, double value, double bound)
{
    dmb_check check = dmb_check_of(&sim->message, "step", DMB_NO_INDEX);
    dmb_check_within(&check, field, value, 0.0, bound);
    return check.status;
}

void dmb_walk_commit(dmb_sim *sim, dmb_attempt *attempt, dmb_walk *walk)
{
    walk->report.steps++;
    walk->report.iterations += attempt->iterations;
    if (attempt->iterations > walk->report.worst) walk->report.worst = attempt->iterations;
    walk->report.residual = fmax(walk->report.residual, attempt->residual);
    walk->report.last_step = attempt->end.step;
    walk->rejected = walk->report.rejected;
    walk->iterations = walk->report.iterations;
    dmb_attempt_commit(sim, attempt);
}

/* A failure here leaves everything as before, the accelerations of before included, which is what there was anyway. */
void dmb_walk_corner(dmb_sim *sim)
{
    if (!dmb_system_rate_jumps(sim)) return;
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
    if (status == DMB_ERR_CANCELLED) { /* tried again by the call that goes on from here, whose bits are then the same */
        out.rejected = walk->rejected;
        out.iterations = walk->iterations;
    }
    if (status < 0 && restore) { /* counters too: a failing call changes nothing */
        if (walk->set_aside) dmb_state_bring_back(sim);
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
                        out.time, out.residual, out.worst);
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
