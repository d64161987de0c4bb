/* Segments of time functions that numbers alone describe: STEP, STEP5 (eq:drive.step), HARMONIC, TABLE, PERIODIC and
 * the reference of an input (eq:drive.reference). Integrals are written as the length of the interval times a mean, not
 * as differences of antiderivatives, so that short steps late in a run keep their digits. */
#include "force/time_segment.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "math/elementary.h"
#include "math/quadrature.h"

/* ---- STEP and STEP5 ---------------------------------------------------------------------------------------------- */

/* D^2 (3 - 2D) or D^3 (10 - 15 D + 6 D^2), 0 <= D <= 1 */
static double ramp(int32_t kind, double d)
{
    if (kind == DMB_SEGMENT_STEP5) return d * d * d * (10.0 + d * (6.0 * d - 15.0));
    return d * d * (3.0 - 2.0 * d);
}

static double ramp_slope(int32_t kind, double d)
{
    const double bump = d * (1.0 - d);

    return kind == DMB_SEGMENT_STEP5 ? 30.0 * bump * bump : 6.0 * bump;
}

static void step_value(const dmb_segment *segment, double t, double *value, double *rate)
{
    const double width = segment->x1 - segment->x0;
    const double rise = segment->h1 - segment->h0;

    if (t < segment->x0 || t >= segment->x1) {
        *value = t < segment->x0 ? segment->h0 : segment->h1;
        *rate = 0.0;
        return;
    }
    *value = segment->h0 + rise * ramp(segment->kind, (t - segment->x0) / width);
    *rate = rise / width * ramp_slope(segment->kind, (t - segment->x0) / width);
}

/* Integral of the ramp over [a, b] inside [x0, x1]. The ramp is a polynomial of degree 3 or 5, so the three-point Gauss
 * rule is its exact integral; unlike a difference of antiderivatives it keeps all digits when b - a is small. */
static double step_inside(const dmb_segment *segment, double a, double b)
{
    const dmb_gauss_rule *rule = dmb_gauss(3);
    const double width = segment->x1 - segment->x0;
    double mean = 0.0;

    for (int i = 0; i < rule->count; ++i)
        mean += rule->weight[i] * ramp(segment->kind, (a - segment->x0 + (b - a) * rule->node[i]) / width);
    return (b - a) * (segment->h0 + (segment->h1 - segment->h0) * mean);
}

static double step_integral(const dmb_segment *segment, double t0, double t1)
{
    double sum = 0.0;

    if (t0 < segment->x0) sum += segment->h0 * (fmin(t1, segment->x0) - t0);
    if (t0 < segment->x1 && t1 > segment->x0) sum += step_inside(segment, fmax(t0, segment->x0), fmin(t1, segment->x1));
    if (t1 > segment->x1) sum += segment->h1 * (t1 - fmax(t0, segment->x1));
    return sum;
}

/* ---- HARMONIC ---------------------------------------------------------------------------------------------------- */

static void harmonic_value(const dmb_segment *segment, double t, double *value, double *rate)
{
    const double angle = segment->omega * t + segment->phase;
    double sine, cosine;

    dmb_sin_cos(angle, &sine, &cosine);
    *value = segment->h0 + segment->h1 * sine;
    *rate = segment->h1 * segment->omega * cosine;
}

/* (cos A - cos B)/omega = 2 sin((A+B)/2) sin((B-A)/2)/omega = (t1-t0) sin(middle) sin(half)/half */
static double harmonic_integral(const dmb_segment *segment, double t0, double t1)
{
    const double middle = segment->omega * (0.5 * t0 + 0.5 * t1) + segment->phase;
    const double half = 0.5 * segment->omega * (t1 - t0);
    const double shape = half != 0.0 ? dmb_sin(half) / half : 1.0;

    return (t1 - t0) * (segment->h0 + segment->h1 * dmb_sin(middle) * shape);
}

/* ---- TABLE and PERIODIC ------------------------------------------------------------------------------------------ */

/* One passage of a table: knot j is at table_time[j] + shift, the last one at `end`, the first one of the next passage.
 * A TABLE has one passage, without a shift. */
typedef struct passage {
    const dmb_segment *segment;
    double shift, end; /* [s] */
} passage;

static double period_of(const dmb_segment *segment)
{
    return segment->table_time[segment->table_count - 1] - segment->table_time[0];
}

/* Passage number n of a PERIODIC segment. Each knot is one rounded number, whatever the time at which it is asked. */
static passage passage_number(const dmb_segment *segment, double n)
{
    const double period = period_of(segment);
    const passage found = {segment, n * period, segment->table_time[0] + (n + 1.0) * period};
    return found;
}

static double passage_start(const dmb_segment *segment, double n)
{
    return segment->table_time[0] + n * period_of(segment);
}

/* Number of the passage that has t: its start <= t < its end. */
static double number_at(const dmb_segment *segment, double t)
{
    double n = floor((t - segment->table_time[0]) / period_of(segment));

    if (passage_start(segment, n) > t) n -= 1.0;
    if (passage_start(segment, n + 1.0) <= t) n += 1.0;
    return n;
}

static passage passage_at(const dmb_segment *segment, double t)
{
    const passage whole = {segment, 0.0, segment->table_time[segment->table_count - 1]};
    return segment->kind == DMB_SEGMENT_PERIODIC ? passage_number(segment, number_at(segment, t)) : whole;
}

static double knot(const passage *p, uint32_t j)
{
    return j + 1 == p->segment->table_count ? p->end : p->segment->table_time[j] + p->shift;
}

/* Number of knots at or before t: 0 .. table_count. */
static uint32_t knots_until(const passage *p, double t)
{
    uint32_t low = 0;
    uint32_t high = p->segment->table_count;

    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (knot(p, middle) <= t)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Slope of the interval after `before` knots. */
static double table_slope(const dmb_segment *segment, uint32_t before)
{
    if (before == 0 || before == segment->table_count) return 0.0;
    return (segment->table_value[before] - segment->table_value[before - 1]) /
           (segment->table_time[before] - segment->table_time[before - 1]);
}

/* Value at t given the number of knots at or before it, or the next knot. Rounded knots far from 0 may be further apart
 * than those of the table. */
static double table_at(const passage *p, uint32_t before, double t)
{
    const double *x = p->segment->table_time;
    const double *y = p->segment->table_value;

    if (before == 0) return y[0];
    if (before == p->segment->table_count) return y[before - 1];
    const double part = fmin((t - knot(p, before - 1)) / (x[before] - x[before - 1]), 1.0);
    return y[before - 1] + (y[before] - y[before - 1]) * part;
}

static void table_value(const dmb_segment *segment, double t, double *value, double *rate)
{
    const passage here = passage_at(segment, t);
    const uint32_t before = knots_until(&here, t);

    *value = table_at(&here, before, t);
    *rate = table_slope(segment, before);
}

/* Slope of the interval that ends at or after t; of a PERIODIC at its first knot the last one of the passage before. */
static double table_rate_before(const dmb_segment *segment, double t)
{
    const passage here = passage_at(segment, t);
    const uint32_t until = knots_until(&here, t);
    const uint32_t before = until > 0 && knot(&here, until - 1) == t ? until - 1 : until;

    if (before == 0 && segment->kind == DMB_SEGMENT_PERIODIC) return table_slope(segment, segment->table_count - 1);
    return table_slope(segment, before);
}

/* Trapezoidal rule from knot to knot: exact. */
static double passage_integral(const passage *p, double t0, double t1)
{
    const double *y = p->segment->table_value;
    uint32_t next = knots_until(p, t0);
    double start = t0;
    double start_value = table_at(p, next, t0);
    double sum = 0.0;

    for (; next < p->segment->table_count && knot(p, next) < t1; ++next) {
        sum += 0.5 * (start_value + y[next]) * (knot(p, next) - start);
        start = knot(p, next);
        start_value = y[next];
    }
    return sum + 0.5 * (start_value + table_at(p, next, t1)) * (t1 - start);
}

/* The rest of the passage of t0, whole passages, the beginning of that of t1. Whole passages count by their mean and
 * the time between their rounded ends: their number times the period differs from that time by the rounding of t. */
static double table_integral(const dmb_segment *segment, double t0, double t1)
{
    const passage here = passage_at(segment, t0);
    if (segment->kind != DMB_SEGMENT_PERIODIC || t1 <= here.end) return passage_integral(&here, t0, t1);

    const double last = number_at(segment, t1), start = passage_start(segment, last), first = segment->table_time[0];
    const passage base = passage_number(segment, 0.0), there = passage_number(segment, last);
    double sum = passage_integral(&here, t0, here.end);
    if (start > here.end) sum += (start - here.end) * (passage_integral(&base, first, base.end) / (base.end - first));
    return sum + passage_integral(&there, start, t1);
}

static double table_next_breakpoint(const dmb_segment *segment, double t)
{
    const passage here = passage_at(segment, t);
    const uint32_t next = knots_until(&here, t);

    return next < segment->table_count ? knot(&here, next) : (double)INFINITY;
}

/* ---- Any of them ------------------------------------------------------------------------------------------------- */

void dmb_time_segment_value(const dmb_segment *segment, double t, double *value, double *rate)
{
    switch (segment->kind) {
    case DMB_SEGMENT_STEP:
    case DMB_SEGMENT_STEP5: step_value(segment, t, value, rate); return;
    case DMB_SEGMENT_HARMONIC: harmonic_value(segment, t, value, rate); return;
    case DMB_SEGMENT_TABLE:
    case DMB_SEGMENT_PERIODIC: table_value(segment, t, value, rate); return;
    case DMB_SEGMENT_REFERENCE: dmb_reference_value(segment->callback_context, t, value, rate); return;
    default: *value = segment->h0; *rate = 0.0;
    }
}

double dmb_time_segment_rate_before(const dmb_segment *segment, double t)
{
    double value, rate;

    if (segment->kind == DMB_SEGMENT_TABLE || segment->kind == DMB_SEGMENT_PERIODIC)
        return table_rate_before(segment, t);
    if (segment->kind == DMB_SEGMENT_REFERENCE) return dmb_reference_rate_before(segment->callback_context, t);
    dmb_time_segment_value(segment, t, &value, &rate);
    return rate;
}

double dmb_time_segment_integral(const dmb_segment *segment, double t0, double t1)
{
    switch (segment->kind) {
    case DMB_SEGMENT_STEP:
    case DMB_SEGMENT_STEP5: return step_integral(segment, t0, t1);
    case DMB_SEGMENT_HARMONIC: return harmonic_integral(segment, t0, t1);
    case DMB_SEGMENT_TABLE:
    case DMB_SEGMENT_PERIODIC: return table_integral(segment, t0, t1);
    case DMB_SEGMENT_REFERENCE: return dmb_reference_integral(segment->callback_context, t0, t1);
    default: return segment->h0 * (t1 - t0);
    }
}

/* Ends of ramps and knots of tables, at which steps end. */
double dmb_time_segment_next_breakpoint(const dmb_segment *segment, double t)
{
    switch (segment->kind) {
    case DMB_SEGMENT_STEP:
    case DMB_SEGMENT_STEP5:
        if (segment->x0 > t) return segment->x0;
        return segment->x1 > t ? segment->x1 : (double)INFINITY;
    case DMB_SEGMENT_TABLE:
    case DMB_SEGMENT_PERIODIC: return table_next_breakpoint(segment, t);
    case DMB_SEGMENT_REFERENCE: return dmb_reference_next_breakpoint(segment->callback_context, t);
    default: return (double)INFINITY;
    }
}

void dmb_time_segment_scales(const dmb_segment *segment, double a, double b, double *bound, double *pace)
{
    double first, last, rate;

    *pace = 0.0;
    if (segment->kind == DMB_SEGMENT_HARMONIC) {
        *bound = fabs(segment->h0) + fabs(segment->h1);
        *pace = fabs(segment->omega);
        return;
    }
    dmb_time_segment_value(segment, a, &first, &rate);
    dmb_time_segment_value(segment, b, &last, &rate);
    *bound = fmax(fabs(first), fabs(last)); /* a ramp and a straight line are monotonic */
    if (segment->kind != DMB_SEGMENT_STEP && segment->kind != DMB_SEGMENT_STEP5) return;
    if (a >= segment->x0 && a < segment->x1) *pace = 2.0 / (segment->x1 - segment->x0);
}
