#include "force/time_function.h"

#include <math.h>
#include <stddef.h>

#include "math/elementary.h"
#include "math/quadrature.h"

#define DMB_RATE_STEP 1e-5         /* [s] half width of the central difference that replaces a missing rate */
#define DMB_RATE_STEP_FACTOR 1e-10 /* [-] the same relative to |t|, for times beyond 1e5 s */
#define DMB_GAUSS_PART 0.05        /* [s] longest interval of one 5-point rule */
#define DMB_GAUSS_PARTS_MAX 1000.0

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

/* ---- TABLE ------------------------------------------------------------------------------------------------------- */

/* Number of knots at or before t: 0 .. table_count. */
static uint32_t knots_until(const dmb_segment *segment, double t)
{
    uint32_t low = 0;
    uint32_t high = segment->table_count;

    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (segment->table_time[middle] <= t)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Number of knots before t. */
static uint32_t knots_before(const dmb_segment *segment, double t)
{
    const uint32_t until = knots_until(segment, t);
    return until > 0 && segment->table_time[until - 1] == t ? until - 1 : until;
}

/* Value at t given the number of knots at or before it. */
static double table_at(const dmb_segment *segment, uint32_t before, double t)
{
    const double *x = segment->table_time;
    const double *y = segment->table_value;

    if (before == 0) return y[0];
    if (before == segment->table_count) return y[before - 1];
    return y[before - 1] + (y[before] - y[before - 1]) * ((t - x[before - 1]) / (x[before] - x[before - 1]));
}

/* Slope of the interval after `before` knots. */
static double table_slope(const dmb_segment *segment, uint32_t before)
{
    if (before == 0 || before == segment->table_count) return 0.0;
    return (segment->table_value[before] - segment->table_value[before - 1]) /
           (segment->table_time[before] - segment->table_time[before - 1]);
}

static void table_value(const dmb_segment *segment, double t, double *value, double *rate)
{
    const uint32_t before = knots_until(segment, t);

    *value = table_at(segment, before, t);
    *rate = table_slope(segment, before);
}

/* Trapezoidal rule from knot to knot: exact. */
static double table_integral(const dmb_segment *segment, double t0, double t1)
{
    uint32_t next = knots_until(segment, t0);
    double start = t0;
    double start_value = table_at(segment, next, t0);
    double sum = 0.0;

    for (; next < segment->table_count && segment->table_time[next] < t1; ++next) {
        sum += 0.5 * (start_value + segment->table_value[next]) * (segment->table_time[next] - start);
        start = segment->table_time[next];
        start_value = segment->table_value[next];
    }
    return sum + 0.5 * (start_value + table_at(segment, next, t1)) * (t1 - start);
}

/* ---- CALLBACK ---------------------------------------------------------------------------------------------------- */

/* True for numbers within bounds; false for NaN. */
static int is_sound(double x)
{
    return fabs(x) <= DMB_CALLBACK_MAX;
}

/* Calls the callback once. Fails unless it writes the `needed` values of out, within bounds. */
static int32_t call(const dmb_segment *segment, double t, int32_t needed, double out[3])
{
    out[0] = out[1] = out[2] = (double)NAN;
    if (segment->callback == NULL || segment->callback(segment->callback_context, t, out) != 0) return DMB_ERR_CALLBACK;
    if (needed == 0 && !is_sound(out[0])) return DMB_ERR_CALLBACK;
    if ((needed & DMB_PROVIDES_RATE) != 0 && !(is_sound(out[0]) && is_sound(out[1]))) return DMB_ERR_CALLBACK;
    if ((needed & DMB_PROVIDES_INTEGRAL) != 0 && !is_sound(out[2])) return DMB_ERR_CALLBACK;
    return DMB_OK;
}

/* Central difference; divides by the actual distance of the rounded times. */
static int32_t callback_difference(const dmb_segment *segment, double t, double *rate)
{
    const double width = fmax(DMB_RATE_STEP, DMB_RATE_STEP_FACTOR * fabs(t));
    const double later = t + width;
    const double earlier = t - width;
    double above[3], below[3];

    if (call(segment, later, 0, above) != DMB_OK || call(segment, earlier, 0, below) != DMB_OK) return DMB_ERR_CALLBACK;
    *rate = (above[0] - below[0]) / (later - earlier);
    return DMB_OK;
}

static int32_t callback_value(const dmb_segment *segment, double t, double *value, double *rate)
{
    const int32_t provided = rate != NULL ? segment->provides & DMB_PROVIDES_RATE : 0;
    double out[3];
    const int32_t status = call(segment, t, provided, out);

    if (status != DMB_OK) return status;
    *value = out[0];
    if (rate == NULL) return DMB_OK;
    *rate = out[1];
    return provided != 0 ? DMB_OK : callback_difference(segment, t, rate);
}

/* Five-point Gauss-Legendre rule over one interval: exact to degree 9. */
static int32_t callback_part(const dmb_segment *segment, double a, double b, double *sum)
{
    const dmb_gauss_rule *rule = dmb_gauss(5);

    for (int i = 0; i < rule->count; ++i) {
        double out[3];
        if (call(segment, a + (b - a) * rule->node[i], 0, out) != DMB_OK) return DMB_ERR_CALLBACK;
        *sum += (b - a) * rule->weight[i] * out[0];
    }
    return DMB_OK;
}

static int32_t callback_integral(const dmb_segment *segment, double t0, double t1, double *integral)
{
    const double parts = fmin(fmax(ceil((t1 - t0) / DMB_GAUSS_PART), 1.0), DMB_GAUSS_PARTS_MAX);
    int32_t status = DMB_OK;

    if ((segment->provides & DMB_PROVIDES_INTEGRAL) != 0) {
        double start[3], end[3];
        if (call(segment, t0, DMB_PROVIDES_INTEGRAL, start) != DMB_OK ||
            call(segment, t1, DMB_PROVIDES_INTEGRAL, end) != DMB_OK)
            return DMB_ERR_CALLBACK;
        *integral = end[2] - start[2];
        return DMB_OK;
    }
    *integral = 0.0;
    for (double i = 0.0; i < parts && status == DMB_OK; i += 1.0)
        status = callback_part(segment, t0 + (t1 - t0) * (i / parts), t0 + (t1 - t0) * ((i + 1.0) / parts), integral);
    return status;
}

/* ---- Sum of segments --------------------------------------------------------------------------------------------- */

static int32_t segment_value(const dmb_segment *segment, double t, double *value, double *rate)
{
    double unused = 0.0;
    double *slope = rate != NULL ? rate : &unused;

    switch (segment->kind) {
    case DMB_SEGMENT_STEP:
    case DMB_SEGMENT_STEP5: step_value(segment, t, value, slope); return DMB_OK;
    case DMB_SEGMENT_HARMONIC: harmonic_value(segment, t, value, slope); return DMB_OK;
    case DMB_SEGMENT_TABLE: table_value(segment, t, value, slope); return DMB_OK;
    case DMB_SEGMENT_CALLBACK: return callback_value(segment, t, value, rate);
    case DMB_SEGMENT_REFERENCE: dmb_reference_value(segment->callback_context, t, value, slope); return DMB_OK;
    default:
        *value = segment->h0;
        *slope = 0.0;
        return DMB_OK;
    }
}

/* Integral of one segment over t0 <= t1. */
static int32_t segment_integral(const dmb_segment *segment, double t0, double t1, double *integral)
{
    switch (segment->kind) {
    case DMB_SEGMENT_STEP:
    case DMB_SEGMENT_STEP5: *integral = step_integral(segment, t0, t1); return DMB_OK;
    case DMB_SEGMENT_HARMONIC: *integral = harmonic_integral(segment, t0, t1); return DMB_OK;
    case DMB_SEGMENT_TABLE: *integral = table_integral(segment, t0, t1); return DMB_OK;
    case DMB_SEGMENT_CALLBACK: return callback_integral(segment, t0, t1, integral);
    case DMB_SEGMENT_REFERENCE: *integral = dmb_reference_integral(segment->callback_context, t0, t1); return DMB_OK;
    default: *integral = segment->h0 * (t1 - t0); return DMB_OK;
    }
}

int32_t dmb_time_function_value(const dmb_time_function *time_function, double t, double *value, double *rate)
{
    double sum = 0.0;
    double slope_sum = 0.0;

    if (!isfinite(t)) return DMB_ERR_NOT_FINITE;
    for (uint32_t i = 0; i < time_function->count; ++i) {
        double part = 0.0;
        double slope = 0.0;
        const int32_t status = segment_value(&time_function->segments[i], t, &part, rate != NULL ? &slope : NULL);
        if (status != DMB_OK) return status;
        sum += part;
        slope_sum += slope;
    }
    if (!isfinite(sum) || !isfinite(slope_sum)) return DMB_ERR_NOT_FINITE;
    *value = sum;
    if (rate != NULL) *rate = slope_sum;
    return DMB_OK;
}

int32_t dmb_time_function_rate_before(const dmb_time_function *time_function, double t, double *rate)
{
    double sum = 0.0;

    if (!isfinite(t)) return DMB_ERR_NOT_FINITE;
    for (uint32_t i = 0; i < time_function->count; ++i) {
        const dmb_segment *segment = &time_function->segments[i];
        double value, slope = 0.0;
        const int32_t status = segment_value(segment, t, &value, &slope);
        if (status != DMB_OK) return status;
        if (segment->kind == DMB_SEGMENT_TABLE) slope = table_slope(segment, knots_before(segment, t));
        if (segment->kind == DMB_SEGMENT_REFERENCE) slope = dmb_reference_rate_before(segment->callback_context, t);
        sum += slope;
    }
    if (!isfinite(sum)) return DMB_ERR_NOT_FINITE;
    *rate = sum;
    return DMB_OK;
}

int32_t dmb_time_function_integral(const dmb_time_function *time_function, double t0, double t1, double *integral)
{
    const double sign = t1 < t0 ? -1.0 : 1.0;
    double sum = 0.0;

    if (!isfinite(t0) || !isfinite(t1)) return DMB_ERR_NOT_FINITE;
    for (uint32_t i = 0; i < time_function->count; ++i) {
        double part = 0.0;
        const int32_t status = segment_integral(&time_function->segments[i], fmin(t0, t1), fmax(t0, t1), &part);
        if (status != DMB_OK) return status;
        sum += part;
    }
    if (!isfinite(sum)) return DMB_ERR_NOT_FINITE;
    *integral = sign * sum;
    return DMB_OK;
}

double dmb_time_function_next_breakpoint(const dmb_time_function *time_function, double t)
{
    double breakpoint = (double)INFINITY;

    for (uint32_t i = 0; i < time_function->count; ++i) {
        const dmb_segment *segment = &time_function->segments[i];
        if (segment->kind == DMB_SEGMENT_STEP || segment->kind == DMB_SEGMENT_STEP5) {
            if (segment->x0 > t)
                breakpoint = fmin(breakpoint, segment->x0);
            else if (segment->x1 > t)
                breakpoint = fmin(breakpoint, segment->x1);
        } else if (segment->kind == DMB_SEGMENT_TABLE) {
            const uint32_t next = knots_until(segment, t);
            if (next < segment->table_count) breakpoint = fmin(breakpoint, segment->table_time[next]);
        } else if (segment->kind == DMB_SEGMENT_REFERENCE) {
            breakpoint = fmin(breakpoint, dmb_reference_next_breakpoint(segment->callback_context, t));
        }
    }
    return breakpoint;
}
