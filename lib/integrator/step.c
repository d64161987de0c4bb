/* dmb_sim_step: one step of the asked length, divided at programme corners and where Newton does not converge. */
#include <string.h>

#include "base/sized_struct.h"
#include "drillmbd/sim.h"
#include "integrator/attempt.h"
#include "integrator/corner.h"
#include "integrator/walk.h"

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
            dmb_state_keep(sim);
            walk->set_aside = 1;
        }
        const int32_t status = dmb_attempt_step(sim, &end, last && !walk->set_aside, &attempt);
        if (status >= 0) {
            dmb_walk_commit(sim, &attempt, walk);
            dmb_walk_corner(sim);
            walk->arrived = last;
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
