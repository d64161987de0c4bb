/* Rate limit and lag of an actuator over a step (eq:drive.lag), and the delay line of its commands.
 *
 * The line is a list of samples in the order of time, read linearly between them. Two samples of one time are a jump:
 * dmb_delay_before reads its left side, dmb_delay_after its right side. Samples are kept DMB_DELAY_PARTS to a delay;
 * those of jumps and breakpoints are extra. */
#include "force/actuator_law.h"

#include <math.h>
#include <string.h>

#include "math/real.h"

/* w(x) = 1 - (1 - exp(-x))/x, x = h/tau */
static double weight_of(double x, double decayed)
{
    if (x < 1e-2) return x * (1.0 / 2.0 - x * (1.0 / 6.0 - x * (1.0 / 24.0 - x * (1.0 / 120.0 - x / 720.0))));
    return 1.0 - (1.0 - decayed) / x;
}

static double decay_of(double x)
{
    return dmb_real_exp(-x);
}

/* r1 is u1 within R h of r0 (eq:drive.actuator). Without a rate limit r is taken as linear between the commands u0 and
 * u1. Returns the derivative of the force by the delayed command, w dr1/du1: 0 while the rate limit acts. */
double dmb_actuator_follow(const dmb_actuator_law *law, double h, double u0, const dmb_actuator_flow *from,
                           dmb_actuator_flow *flow)
{
    double by_delayed = 1.0, r0 = u0;
    flow->limited = flow->delayed;
    if (law->rate_limit > 0.0) {
        const double room = law->rate_limit * h;
        r0 = from->limited;
        flow->limited = fmin(fmax(flow->delayed, r0 - room), r0 + room);
        if (flow->limited != flow->delayed) by_delayed = 0.0;
    }
    flow->force = flow->limited;
    if (!(law->lag > 0.0)) return by_delayed;
    const double x = h / law->lag, decayed = decay_of(x), weight = weight_of(x, decayed);
    flow->force = decayed * from->force + (1.0 - decayed) * r0 + weight * (flow->limited - r0);
    return weight * by_delayed;
}

/* ---- The delay line ---------------------------------------------------------------------------------------------- */

enum { N = DMB_DELAY_SAMPLES };

/* [s] Times that differ by no more count as equal. The difference is rounding of the present time, near the newest
 * sample, minus the delay. */
static double rounding_of(const dmb_delay_line *line, double time)
{
    return 8.0 * DBL_EPSILON * (fabs(time) + fabs(line->time[N - 1]));
}

/* Number of samples before `time`. Times are sorted; the result is within 0 .. N for any content. */
static size_t count_before(const dmb_delay_line *line, double time)
{
    size_t low = 0, high = N;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (line->time[middle] < time)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Linear interpolation between sample i - 1 and sample i. */
static double between(const dmb_delay_line *line, size_t i, double time)
{
    if (i == 0) return line->value[0];
    if (i == N) return line->value[N - 1];
    const double length = line->time[i] - line->time[i - 1];
    const double part = length > 0.0 ? (time - line->time[i - 1]) / length : 1.0;
    return line->value[i - 1] + fmin(fmax(part, 0.0), 1.0) * (line->value[i] - line->value[i - 1]);
}

double dmb_delay_before(const dmb_delay_line *line, double time)
{
    return between(line, count_before(line, time - rounding_of(line, time)), time);
}

double dmb_delay_after(const dmb_delay_line *line, double time)
{
    return between(line, count_before(line, time + rounding_of(line, time)), time);
}

double dmb_delay_next_jump(const dmb_delay_line *line, double time)
{
    for (size_t i = count_before(line, time); i + 1 < N; i++)
        if (line->time[i] > time && line->time[i] == line->time[i + 1] && line->value[i] != line->value[i + 1])
            return line->time[i];
    return (double)INFINITY;
}

void dmb_delay_fill(const dmb_delay_line *line, double time, double value)
{
    for (size_t i = 0; i < N; i++) {
        line->time[i] = time;
        line->value[i] = value;
    }
}

static void append(const dmb_delay_line *line, double time, double value)
{
    memmove(line->time, line->time + 1, (N - 1) * sizeof *line->time);
    memmove(line->value, line->value + 1, (N - 1) * sizeof *line->value);
    line->time[N - 1] = time;
    line->value[N - 1] = value;
}

/* 1 if the newest sample is a breakpoint of the polygon that continues to `value` at `time`. A smooth command bends
 * less between two samples. */
static int is_breakpoint(const dmb_delay_line *line, double time, double value)
{
    const double *t = line->time, *v = line->value;
    const double straight = v[N - 2] + (value - v[N - 2]) * (t[N - 1] - t[N - 2]) / (time - t[N - 2]);
    return fabs(v[N - 1] - straight) > 0.05 * (fabs(v[N - 1] - v[N - 2]) + fabs(value - v[N - 1]));
}

/* 1 if a sample of a jump or breakpoint can be stored: the newest 512 samples must then still cover the delay. At most
 * 257 other samples occur within a delay, so that the line always covers it. */
static int has_room(const dmb_delay_line *line, double delay, double time)
{
    const double oldest = line->time[N - 2 * DMB_DELAY_PARTS];
    return oldest <= time - delay || oldest == line->time[0];
}

/* A sample close to its predecessor is replaced by the next one, unless it is a breakpoint or the second sample of a
 * jump. */
void dmb_delay_push(const dmb_delay_line *line, double delay, double begin, double start, double time, double value)
{
    const double part = delay / DMB_DELAY_PARTS, *t = line->time;
    if (line->value[N - 1] != start) {
        if (has_room(line, delay, begin))
            append(line, begin, start);
        else
            line->value[N - 1] = start;
    }
    const int near = t[N - 1] - t[N - 2] < part && t[N - 1] != t[N - 2];
    if (near && !(has_room(line, delay, time) && is_breakpoint(line, time, value))) {
        line->time[N - 1] = time;
        line->value[N - 1] = value;
    } else {
        append(line, time, value);
    }
}
