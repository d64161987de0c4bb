/* Length and end of steps at breakpoints of time functions.
 *
 * The clock is a double and the rounding error of its sums (two-sum), so that n steps of h end at the double next to
 * n h: 1000 s of 1 ms end at 1000 s, and sums that reach a breakpoint reach it exactly. A step that no breakpoint cuts
 * keeps the requested length to the last bit instead of the difference of two rounded times, because lengths that
 * differ by an ulp of the time excite the same vibration as a change of step (eq:integration.energy-left).
 *
 * Next breakpoint at distance d, length left l, sliver s = 1e-6 min(l, h):
 *     d > l + s                                    the step ends at the goal
 *     |d - l| <= s, no second breakpoint near      the step ends at the goal and counts as at the breakpoint
 *     d <= l otherwise                             the step ends at the breakpoint */
#include "integrator/breakpoint.h"

#include <float.h>
#include <math.h>

#include "system/assemble/actuators.h"

#define DMB_SLIVER 1e-6         /* [-] fraction of a step below which no separate step is taken */
#define DMB_DELAYED_SLIVER 1e-9 /* [-] the same if commands are delayed */
#define DMB_BREAKPOINT_ROUNDING \
    4.0 /* [ulp] permitted difference between the caller's sum of steps and the breakpoint */

/* [s] Smallest breakpoint later than t of a time function; INFINITY if none. */
static double breakpoint_of(const dmb_scene *scene, uint32_t time_function, double t)
{
    return time_function == DMB_NONE ? (double)INFINITY
                                     : dmb_time_function_next_breakpoint(scene->time_functions + time_function, t);
}

/* [s] Smallest breakpoint later than t of any time function in use; INFINITY if none. */
static double next_breakpoint(const dmb_sim *sim, double t)
{
    const dmb_scene *scene = sim->scene;
    double next = (double)INFINITY;
    for (uint32_t i = 0; i < scene->drive_count; i++) {
        if (!isnan(sim->drive_input[i])) continue;
        next = fmin(next, breakpoint_of(scene, scene->drives[i].time_function, t));
        next = fmin(next, breakpoint_of(scene, scene->drives[i].excitation, t));
    }
    if (scene->delay_count) next = fmin(next, dmb_actuators_next_breakpoint(sim, t));
    for (uint32_t i = 0; i < scene->load_count; i++)
        next = fmin(next, breakpoint_of(scene, scene->loads[i].time_function, t));
    for (uint32_t i = 0; i < scene->bit_count; i++) next = fmin(next, breakpoint_of(scene, scene->bits[i].load, t));
    return next;
}

/* [s] First breakpoint at which no step has ended yet. */
static double breakpoint_ahead(const dmb_sim *sim)
{
    return next_breakpoint(sim, fmax(sim->clock->time, sim->clock->breakpoint));
}

/* True if the two times differ only by the rounding of sums of steps. */
static int is_same_time(double a, double b)
{
    return fabs(a - b) <= DMB_BREAKPOINT_ROUNDING * DBL_EPSILON * fabs(b);
}

/* [s] Length of a step from the present time to `time`. */
static double length_to(const dmb_sim *sim, double time)
{
    return time - sim->clock->time;
}

/* [-] Fraction of a step below which no separate step is taken. Delayed commands keep their edges at any steepness,
 * because they are read at the ends of steps: the fraction is smaller there. */
static double sliver_of(const dmb_sim *sim)
{
    return sim->scene->delay_count > 0 ? DMB_DELAYED_SLIVER : DMB_SLIVER;
}

/* [s] Length from the present time to the goal; exactly the requested length if no part of it is done. */
static double length_left(const dmb_sim *sim, const dmb_step_end *goal)
{
    return goal->begin == sim->clock->time ? goal->step : length_to(sim, goal->time);
}

dmb_step_end dmb_step_end_after(const dmb_sim *sim, double step)
{
    dmb_step_end end = {.step = step, .begin = sim->clock->time};
    const double t = sim->clock->time, sum = t + step, part = sum - t;
    const double error =
        ((t - (sum - part)) + (step - part)) + sim->clock->rest; /* rounding error of sum (two-sum: Moller, Knuth) */
    end.time = sum + error;
    end.rest = (sum - end.time) + error;
    return end;
}

dmb_step_end dmb_step_end_at(const dmb_sim *sim, double time)
{
    const dmb_step_end end = {.step = length_to(sim, time), .begin = sim->clock->time, .time = time};
    return end;
}

dmb_step_end dmb_step_end_before_breakpoint(const dmb_sim *sim, const dmb_step_end *goal, double h)
{
    const double left = length_left(sim, goal), sliver = sliver_of(sim) * fmin(left, h);
    const double breakpoint = breakpoint_ahead(sim), distance = length_to(sim, breakpoint);
    dmb_step_end end = *goal;
    end.step = left;
    end.arrives = 1;
    if (distance > left + sliver) return end;
    const int alone = distance >= left - sliver && length_to(sim, next_breakpoint(sim, breakpoint)) > left + sliver;
    if (alone || is_same_time(goal->time, breakpoint)) {
        end.breakpoint = breakpoint;
        return end;
    }
    if (distance > left) return end;
    end = dmb_step_end_at(sim, breakpoint);
    end.breakpoint = breakpoint;
    return end;
}

dmb_step_end dmb_step_end_over_breakpoints(const dmb_sim *sim, const dmb_step_end *goal)
{
    const double left = length_left(sim, goal), sliver = sliver_of(sim) * left;
    const double first = breakpoint_ahead(sim), second = next_breakpoint(sim, first);
    const double to_first = length_to(sim, first), to_second = length_to(sim, second);
    dmb_step_end end = *goal;
    end.step = left;
    end.arrives = 1;
    if (to_second <= left + sliver) return end;
    if (fabs(to_first - left) <= sliver)
        end.breakpoint = first;
    else if (to_first < left)
        end.inside = first;
    return end;
}

dmb_step_end dmb_step_end_on_breakpoint(dmb_step_end end)
{
    if (!(end.breakpoint > 0.0) || !is_same_time(end.time, end.breakpoint)) return end;
    end.rest += end.time - end.breakpoint;
    end.step -= end.time - end.breakpoint;
    end.time = end.breakpoint;
    return end;
}
