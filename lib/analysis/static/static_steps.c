/* Load steps of statics: the whole load at once where that converges, and else steps that are halved where Newton fails
 * and doubled where it does not. */
#include <string.h>

#include "analysis/static/static.h"
#include "sim/access.h"
#include "sim/layout.h"

/* Shortest load step, which is tried with the line search: with the extrapolated stress Newton overshoots in its first
 * iteration and is the faster for it as a rule. Where the first step fails, shorter ones hardly help. A step of few
 * iterations doubles the next one. */
#define DMB_SHORTEST_LOAD_STEP (1.0 / 64.0)
#define DMB_SHORTEST_FIRST_STEP (1.0 / 16.0)
#define DMB_EASY_ITERATIONS 12

/* The trial and its increments are set aside as the step reached, and back. */
static void keep(dmb_sim *sim)
{
    dmb_configuration_copy(sim, &sim->trial, &sim->now);
    memcpy(sim->load_step_increment, sim->increment, sim->scene->row_count * sizeof(double));
}

static void go_back(dmb_sim *sim)
{
    dmb_configuration_copy(sim, &sim->now, &sim->trial);
    memcpy(sim->increment, sim->load_step_increment, sim->scene->row_count * sizeof(double));
}

int32_t dmb_static_equal_steps(dmb_static_search *search, dmb_static_method method, uint32_t steps)
{
    int32_t status = dmb_static_begin(search);
    search->load_steps = steps;
    for (uint32_t k = 1; k <= steps && status >= 0; k++) {
        dmb_progress_at(search->sim, (k - 1.0) / steps);
        search->evaluation.load_factor = (double)k / steps;
        status = method(search);
    }
    return status;
}

/* One load step from `reached`; a failing one goes back and halves it. 0, or why no shorter step is left. */
static int32_t step(dmb_static_search *search, double *reached, double *length)
{
    const uint32_t before = search->iterations;
    const double target = fmin(1.0, *reached + *length);
    const double shortest = *reached > 0.0 ? DMB_SHORTEST_LOAD_STEP : DMB_SHORTEST_FIRST_STEP;
    search->searching = *length <= shortest;
    search->evaluation.load_factor = target;
    dmb_progress_at(search->sim, *reached);
    const int32_t status = dmb_static_newton(search);
    if (status >= 0) {
        *reached = target;
        search->load_steps++;
        if (search->iterations - before <= DMB_EASY_ITERATIONS) *length *= 2.0;
        if (target < 1.0) keep(search->sim);
        return DMB_OK;
    }
    *length *= 0.5;
    search->cuts++;
    go_back(search->sim);
    return dmb_is_final(status) || *length < shortest ? status : DMB_OK;
}

int32_t dmb_static_growing_steps(dmb_static_search *search)
{
    double reached = 0.0, length = 0.25;
    int32_t status = dmb_static_begin(search);
    search->load_steps = 0;
    if (status >= 0) keep(search->sim);
    while (status >= 0 && reached < 1.0) status = step(search, &reached, &length);
    search->searching = 0;
    return status;
}

/* ---- Line search ------------------------------------------------------------------------------------------------- */

/* A correction may leave this part of the work it began with; it is shortened no further than that. */
#define DMB_WORK_LEFT 0.8
#define DMB_SHORTEST_MOVE 0.1
#define DMB_SEARCHES 4

/* Regula falsi on the work g(s) of the residual along the move (Crisfield 1991, 9.2). */
int32_t dmb_static_line_search(dmb_static_search *search, const double *direction, double before)
{
    double low = 0.0, high = 1.0, at_low = before, at_high = dmb_static_work(search, direction, 1.0), s = 1.0;
    if (!(before < 0.0) || !(fabs(at_high) > DMB_WORK_LEFT * fabs(before))) return DMB_OK;
    search->line_searches++;
    for (int k = 0; k < DMB_SEARCHES; k++) {
        const double guess = at_high > 0.0 ? low + (high - low) * at_low / (at_low - at_high) : 0.5 * s;
        const double next = fmax(guess, DMB_SHORTEST_MOVE);
        if (next >= s && at_high <= 0.0) return DMB_OK;
        dmb_static_move_back(search, direction, s);
        int32_t status = dmb_static_move(search, direction, next);
        if (status < 0) return status;
        s = next;
        search->evaluation.extrapolated = 0;
        status = dmb_static_evaluate(search);
        if (status < 0) return status;
        const double work = dmb_static_work(search, direction, s);
        if (fabs(work) <= DMB_WORK_LEFT * fabs(before) || s <= DMB_SHORTEST_MOVE) return DMB_OK;
        if (work > 0.0) {
            high = s;
            at_high = work;
        } else {
            low = s;
            at_low = work;
        }
    }
    return DMB_OK;
}
