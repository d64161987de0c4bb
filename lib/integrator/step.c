/* dmb_sim_step: one step of the asked length, divided at programme corners and where Newton does not converge. */
#include <string.h>

#include "base/sized_struct.h"
#include "drillmbd/sim.h"
#include "integrator/attempt.h"
#include "integrator/corner.h"
#include "integrator/walk.h"

DMB_DECLARE_STRUCT(dmb_step_report)

/* The next substep: not over a corner, nor leaving a sliver before the end. */
static double substep(const dmb_sim *sim, double end, double cut)
{
    const double t = sim->clock->time, left = end - t;
    double h = fmin(left, cut);
    if (!sim->options.bounded_work) h = fmin(h, dmb_next_corner(sim, t + 1e-9 * left) - t);
    return left - h < 1e-6 * h ? left : h;
}

/* One accepted step of at most `cut`, halving on failure. */
static int32_t take_substep(dmb_sim *sim, double end, double *cut, uint32_t *cuts, dmb_walk *walk)
{
    dmb_attempt attempt;
    for (;;) {
        const double h = substep(sim, end, *cut);
        if (!(sim->clock->time + h > sim->clock->time)) return dmb_walk_stuck(sim, h);
        const int last = !(sim->clock->time + h < end);
        if (!last && !walk->set_aside) {
            dmb_state_keep(sim);
            walk->set_aside = 1;
        }
        const int32_t status = dmb_attempt_step(sim, h, last && !walk->set_aside, &attempt);
        if (status >= 0) {
            if (last) attempt.evaluation.time = end;
            dmb_walk_commit(sim, &attempt, walk);
            dmb_walk_corner(sim);
            *cut = *cuts > 0 ? 2.0 * h : (double)INFINITY; /* a corner nearby does not shorten what follows */
            if (*cuts > 0) --*cuts;
            return status;
        }
        dmb_walk_reject(sim, &attempt, walk);
        if (sim->options.bounded_work || status == DMB_ERR_CALLBACK || *cuts >= sim->options.max_cuts ||
            0.5 * h < sim->options.step_min)
            return status;
        ++*cuts;
        *cut = 0.5 * h;
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
    const double end = sim->clock->time + duration;
    if (!(end > sim->clock->time)) return dmb_walk_check(sim, "duration", 0.0, 0.0);
    while (status >= 0 && sim->clock->time < end) {
        status = take_substep(sim, end, &cut, &cuts, &walk);
        if (status == DMB_NOTE_WORK_LIMITED) walk.limited = 1;
    }
    return dmb_walk_end(sim, status, 1, report, &walk);
}

int32_t dmb_sim_step(dmb_sim *sim, double duration, dmb_step_report *report)
{
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    return status < 0 ? status : dmb_sim_leave(sim, step(sim, duration, report));
}
