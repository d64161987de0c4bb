/* dmb_sim_advance: steps whose local error holds the tolerances. The estimate is of third order, so
 *     h_new = h clamp(0.9 err^(-1/3), 0.2, 2)
 * with the error ahead of the step, not its own (dmb_step_error): steps that follow the error through the zeros of an
 * oscillation change four times a period, and each change leaves a part of h_1^2 - h_2^2 of what equal steps take back
 * (THEORY 4). */
#include "integrator/advance.h"

#include "base/sized_struct.h"
#include "integrator/corner.h"
#include "math/elementary.h"
#include "sim/access.h"

/* Step length that the control chooses after an error of `error` tolerances. Without clusters the factors of a step of
 * the same length may serve (factor reuse), so a length is held while the ratio lies in 0.9 .. 1.2; with them every
 * step makes its own. */
static double next_step(const dmb_sim *sim, double h, double error)
{
    double ratio = error > 0.0 ? 0.9 * dmb_pow(error, -1.0 / 3.0) : 2.0;
    ratio = fmin(fmax(ratio, 0.2), 2.0);
    if (sim->scene->cluster_count == 0 && ratio > 0.9 && ratio < 1.2) ratio = 1.0;
    return fmin(fmax(ratio * h, sim->options.step_min), sim->options.step_max);
}

/* After a step whose error was too large: always shorter, or the same step would be tried for ever. */
static double retry_step(const dmb_sim *sim, double h, double error)
{
    return fmax(fmin(next_step(sim, h, error), 0.8 * h), sim->options.step_min);
}

double dmb_advance_first(const dmb_sim *sim)
{
    if (sim->clock->next_step > 0.0) return sim->clock->next_step;
    return fmin(sim->options.step_max, fmax(1e-4, sim->options.step_min));
}

/* A step of about h that ends neither beyond `time` nor a corner; without leaving a sliver. */
static dmb_step_end fit(const dmb_sim *sim, double h, double time)
{
    const dmb_step_end goal = dmb_step_end_at(sim, time);
    const dmb_step_end end = dmb_step_end_before_corner(sim, &goal, h);
    if (h >= end.step) return end;
    return dmb_step_end_after(sim, h > 0.5 * end.step ? 0.5 * end.step : h);
}

/* The step wanted after one of length h; of one that was cut short only when it tells more. */
static double wanted_after(const dmb_sim *sim, double h, double wanted, double error, int retried)
{
    const double next = next_step(sim, h, error);
    if (next > wanted && retried) return wanted; /* it has just failed at more */
    return next > wanted || h >= wanted * 0.999 || next < h ? next : wanted;
}

void dmb_advance_propose(dmb_sim *sim, double wanted)
{
    sim->clock->next_step = wanted;
}

int32_t dmb_advance_once(dmb_sim *sim, double time, double *wanted, dmb_walk *walk)
{
    dmb_attempt attempt;
    for (int retried = 0;; retried = 1) {
        const dmb_step_end end = fit(sim, *wanted, time);
        const double h = end.step;
        if (!(end.time > sim->clock->time)) return dmb_walk_stuck(sim, "length", h);
        int32_t status = dmb_attempt_step(sim, &end, 1, &attempt);
        if (status == DMB_NOTE_WORK_LIMITED)
            status = attempt.status = DMB_ERR_NO_CONVERGENCE; /* a step is a step here */
        if (status >= 0 && sim->scene->stuck_count > 0) status = dmb_attempt_to_release(sim, &attempt);
        const double taken = attempt.end.step;
        const int smallest = !(h > sim->options.step_min * 1.0001);
        const dmb_step_error error = status >= 0 ? dmb_attempt_error(sim, taken) : (dmb_step_error){0.0, 0.0};
        if (status >= 0 && (error.here <= 1.0 || smallest)) {
            if (!(taken < h)) *wanted = wanted_after(sim, h, *wanted, error.ahead, retried);
            if (error.here > 1.0) walk->too_coarse = 1;
            const int32_t refused = dmb_walk_commit(sim, &attempt, walk);
            if (refused < 0) return refused;
            dmb_walk_corner(sim);
            dmb_advance_propose(sim, *wanted);
            return status;
        }
        dmb_walk_reject(sim, &attempt, walk);
        if (status < 0 && (smallest || dmb_is_final(status))) return status;
        *wanted = status >= 0 ? retry_step(sim, h, error.ahead) : fmax(0.25 * h, sim->options.step_min);
    }
}

static int32_t advance(dmb_sim *sim, double time, dmb_step_report *report)
{
    dmb_walk walk;
    int32_t status = dmb_walk_begin(sim, report, &walk);
    if (status < 0) return status;
    status = dmb_walk_check(sim, "time", time, sim->clock->time);
    if (status < 0) return status;
    const double start = sim->clock->time;
    double wanted = dmb_advance_first(sim);
    while (status >= 0 && sim->clock->time < time && !walk.stopped) {
        dmb_progress_at(sim, (sim->clock->time - start) / (time - start));
        status = dmb_advance_once(sim, time, &wanted, &walk);
        walk.stopped = walk.report.steps == sim->options.max_steps && sim->clock->time < time;
    }
    return dmb_walk_end(sim, status, 0, report, &walk);
}

int32_t dmb_sim_advance(dmb_sim *sim, double time, dmb_step_report *report)
{
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    return status < 0 ? status : dmb_sim_leave(sim, advance(sim, time, report));
}
