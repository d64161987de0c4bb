/* Time functions as sums of segments: value, rate, integral and breakpoints (eq:drive.step; segments given by numbers
 * alone: time_segment.c).
 *
 *     segment           rate                                   integral
 *     ---------------   ------------------------------------   ------------------------------------------------------
 *     numbers alone     exact                                  exact
 *     callback          its own, or a central difference       its own, or five-point Gauss rules of 0.05 s
 *     per revolution    exact                                  eq:drive.per-revolution; the part of h1 by Gauss rules
 */
#include "force/time_function.h"

#include <math.h>
#include <stddef.h>

#include "force/time_segment.h"
#include "math/elementary.h"
#include "math/quadrature.h"

#define DMB_RATE_STEP 1e-5         /* [s] half width of the central difference that replaces a missing rate */
#define DMB_RATE_STEP_FACTOR 1e-10 /* [-] the same relative to |t|, for times beyond 1e5 s */
#define DMB_GAUSS_PART 0.05        /* [s] longest interval of one 5-point rule */
#define DMB_GAUSS_PARTS_MAX 1000.0
#define DMB_GAUSS_ANGLE 0.5     /* [rad] of a sine, longest interval of one 5-point rule: an error of 1e-15 */
#define DMB_SWING_PARTS_MAX 1e5 /* [-] intervals of one integral of a swing */

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

/* ---- PER_REVOLUTION ---------------------------------------------------------------------------------------------- */

/* Of a segment whose callback_context is the time function w that it follows, with theta(t) the integral of w from 0 to
 * t and psi = order theta + phase (eq:drive.per-revolution). */

/* Sum of the integrals of w from t0 to t1, whatever their order. */
static double angle_between(const dmb_time_function *turning, double t0, double t1)
{
    double sum = 0.0;

    for (uint32_t i = 0; i < turning->count; ++i)
        sum += dmb_time_segment_integral(turning->segments + i, fmin(t0, t1), fmax(t0, t1));
    return t1 < t0 ? -sum : sum;
}

/* w at t and its rate, from the left if `before`. */
static void speed_at(const dmb_time_function *turning, double t, int before, double *speed, double *slope)
{
    *speed = *slope = 0.0;
    for (uint32_t i = 0; i < turning->count; ++i) {
        double value, rate;
        dmb_time_segment_value(turning->segments + i, t, &value, &rate);
        *speed += value;
        *slope += before ? dmb_time_segment_rate_before(turning->segments + i, t) : rate;
    }
}

/* h0 + (h1 + share w) sin psi, and its rate share w' sin psi + (h1 + share w) order w cos psi. */
static void swing_value(const dmb_segment *segment, double t, int before, double *value, double *rate)
{
    const dmb_time_function *turning = segment->callback_context;
    double speed, slope, sine, cosine;

    speed_at(turning, t, before, &speed, &slope);
    dmb_sin_cos(segment->order * angle_between(turning, 0.0, t) + segment->phase, &sine, &cosine);
    const double amplitude = segment->h1 + segment->share * speed;
    *value = segment->h0 + amplitude * sine;
    *rate = segment->share * slope * sine + amplitude * segment->order * speed * cosine;
}

static double breakpoint_of(const dmb_time_function *turning, double t)
{
    double breakpoint = (double)INFINITY;

    for (uint32_t i = 0; i < turning->count; ++i)
        breakpoint = fmin(breakpoint, dmb_time_segment_next_breakpoint(turning->segments + i, t));
    return breakpoint;
}

/* Intervals of Gauss rules between the neighbouring breakpoints a and b of w, for sin psi. Each interval covers at most
 * DMB_GAUSS_ANGLE of psi and of the fastest change of w itself. */
static double swing_parts(const dmb_segment *segment, double a, double b)
{
    const dmb_time_function *turning = segment->callback_context;
    double speed = 0.0, fastest = 0.0;

    for (uint32_t i = 0; i < turning->count; ++i) {
        double bound, pace;
        dmb_time_segment_scales(turning->segments + i, a, b, &bound, &pace);
        speed += bound;
        fastest = fmax(fastest, pace);
    }
    fastest = fmax(fastest, fabs(segment->order) * speed);
    return ceil(fmax((b - a) * fastest / DMB_GAUSS_ANGLE, 1.0));
}

/* Integral of sin psi over one interval; `angle` is theta at its start, and at its end after the call. */
static double swing_part(const dmb_segment *segment, double a, double b, double *angle)
{
    const dmb_time_function *turning = segment->callback_context;
    const dmb_gauss_rule *rule = dmb_gauss(5);
    double sum = 0.0;

    for (int i = 0; i < rule->count; ++i) {
        const double theta = *angle + angle_between(turning, a, a + (b - a) * rule->node[i]);
        sum += (b - a) * rule->weight[i] * dmb_sin(segment->order * theta + segment->phase);
    }
    *angle += angle_between(turning, a, b);
    return sum;
}

/* Integral of sin psi from t0 to t1 by Gauss rules between breakpoints of w. */
static int32_t sine_integral(const dmb_segment *segment, double t0, double t1, double *integral)
{
    const dmb_time_function *turning = segment->callback_context;
    double angle = angle_between(turning, 0.0, t0);
    double used = 0.0, sum = 0.0;

    while (t0 < t1) {
        const double end = fmin(t1, breakpoint_of(turning, t0));
        const double parts = swing_parts(segment, t0, end);
        used += parts;
        if (!(used <= DMB_SWING_PARTS_MAX)) return DMB_ERR_TOO_LARGE;
        for (uint32_t i = 0; i < (uint32_t)parts; i++)
            sum += swing_part(segment, t0 + (end - t0) * (i / parts), t0 + (end - t0) * ((i + 1.0) / parts), &angle);
        t0 = end;
    }
    *integral = sum;
    return DMB_OK;
}

/* The integral of w sin psi is (cos psi0 - cos psi1)/order = turn sin(middle) sin(half)/half: exact to round-off. */
static int32_t swing_integral(const dmb_segment *segment, double t0, double t1, double *integral)
{
    const dmb_time_function *turning = segment->callback_context;
    const double start = angle_between(turning, 0.0, t0), turn = angle_between(turning, t0, t1);
    const double middle = segment->order * (start + 0.5 * turn) + segment->phase;
    const double half = 0.5 * segment->order * turn;
    const double shape = half != 0.0 ? dmb_sin(half) / half : 1.0;
    double sine = 0.0;

    const int32_t status = segment->h1 != 0.0 ? sine_integral(segment, t0, t1, &sine) : DMB_OK;
    if (status != DMB_OK) return status;
    *integral = segment->h0 * (t1 - t0) + segment->h1 * sine + segment->share * turn * dmb_sin(middle) * shape;
    return DMB_OK;
}

/* ---- Sum of segments --------------------------------------------------------------------------------------------- */

static int32_t segment_value(const dmb_segment *segment, double t, double *value, double *rate)
{
    double unused = 0.0;

    if (segment->kind == DMB_SEGMENT_CALLBACK) return callback_value(segment, t, value, rate);
    if (segment->kind == DMB_SEGMENT_PER_REVOLUTION)
        swing_value(segment, t, 0, value, rate != NULL ? rate : &unused);
    else
        dmb_time_segment_value(segment, t, value, rate != NULL ? rate : &unused);
    return DMB_OK;
}

static int32_t segment_rate_before(const dmb_segment *segment, double t, double *rate)
{
    double value;

    if (segment->kind == DMB_SEGMENT_CALLBACK) return callback_value(segment, t, &value, rate);
    if (segment->kind == DMB_SEGMENT_PER_REVOLUTION)
        swing_value(segment, t, 1, &value, rate);
    else
        *rate = dmb_time_segment_rate_before(segment, t);
    return DMB_OK;
}

/* Integral of one segment over t0 <= t1. */
static int32_t segment_integral(const dmb_segment *segment, double t0, double t1, double *integral)
{
    if (segment->kind == DMB_SEGMENT_CALLBACK) return callback_integral(segment, t0, t1, integral);
    if (segment->kind == DMB_SEGMENT_PER_REVOLUTION) return swing_integral(segment, t0, t1, integral);
    *integral = dmb_time_segment_integral(segment, t0, t1);
    return DMB_OK;
}

/* Rates at a breakpoint are those after it; dmb_time_function_rate_before gives those before. */
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
        double slope = 0.0;
        const int32_t status = segment_rate_before(&time_function->segments[i], t, &slope);
        if (status != DMB_OK) return status;
        sum += slope;
    }
    if (!isfinite(sum)) return DMB_ERR_NOT_FINITE;
    *rate = sum;
    return DMB_OK;
}

/* Motion drives move by it: an error would be a drift of their position. */
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

/* Breakpoints of a segment are its own, or those of the time function that it follows. */
static double breakpoint_after(const dmb_segment *segment, double t)
{
    if (segment->kind == DMB_SEGMENT_PER_REVOLUTION) return breakpoint_of(segment->callback_context, t);
    return dmb_time_segment_next_breakpoint(segment, t);
}

double dmb_time_function_next_breakpoint(const dmb_time_function *time_function, double t)
{
    double breakpoint = (double)INFINITY;

    for (uint32_t i = 0; i < time_function->count; ++i)
        breakpoint = fmin(breakpoint, breakpoint_after(&time_function->segments[i], t));
    return breakpoint;
}
