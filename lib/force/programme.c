#include "force/programme.h"

#include <math.h>
#include <stddef.h>

#include "math/elementary.h"
#include "math/quadrature.h"

#define DMB_RATE_STEP 1e-5         /* [s] half width of the difference that replaces a missing rate */
#define DMB_RATE_STEP_FACTOR 1e-10 /* [-] the same relative to |t|, for times beyond 1e5 s */
#define DMB_GAUSS_PART 0.05        /* [s] longest part under one 5-point rule */
#define DMB_GAUSS_PARTS_MAX 1000.0

/* ---- STEP and STEP5 ---------------------------------------------------------------------------------------------- */

/* D^2 (3 - 2D) or D^3 (10 - 15 D + 6 D^2), 0 <= D <= 1 */
static double ramp(int32_t kind, double d)
{
    if (kind == DMB_TERM_STEP5) return d * d * d * (10.0 + d * (6.0 * d - 15.0));
    return d * d * (3.0 - 2.0 * d);
}

static double ramp_slope(int32_t kind, double d)
{
    const double bump = d * (1.0 - d);

    return kind == DMB_TERM_STEP5 ? 30.0 * bump * bump : 6.0 * bump;
}

static void step_value(const dmb_term *term, double t, double *value, double *rate)
{
    const double width = term->x1 - term->x0;
    const double rise = term->h1 - term->h0;

    if (t < term->x0 || t >= term->x1) {
        *value = t < term->x0 ? term->h0 : term->h1;
        *rate = 0.0;
        return;
    }
    *value = term->h0 + rise * ramp(term->kind, (t - term->x0) / width);
    *rate = rise / width * ramp_slope(term->kind, (t - term->x0) / width);
}

/* Integral of the ramp over [a, b] inside [x0, x1]. The ramp is a polynomial of degree 3 or 5, so the three-point Gauss
 * rule is its exact integral; unlike a difference of antiderivatives it keeps all digits when b - a is small. */
static double step_inside(const dmb_term *term, double a, double b)
{
    const dmb_gauss_rule *rule = dmb_gauss(3);
    const double width = term->x1 - term->x0;
    double mean = 0.0;

    for (int i = 0; i < rule->count; ++i)
        mean += rule->weight[i] * ramp(term->kind, (a - term->x0 + (b - a) * rule->node[i]) / width);
    return (b - a) * (term->h0 + (term->h1 - term->h0) * mean);
}

static double step_integral(const dmb_term *term, double t0, double t1)
{
    double sum = 0.0;

    if (t0 < term->x0) sum += term->h0 * (fmin(t1, term->x0) - t0);
    if (t0 < term->x1 && t1 > term->x0) sum += step_inside(term, fmax(t0, term->x0), fmin(t1, term->x1));
    if (t1 > term->x1) sum += term->h1 * (t1 - fmax(t0, term->x1));
    return sum;
}

/* ---- HARMONIC ---------------------------------------------------------------------------------------------------- */

static void harmonic_value(const dmb_term *term, double t, double *value, double *rate)
{
    const double angle = term->omega * t + term->phase;
    double sine, cosine;

    dmb_sin_cos(angle, &sine, &cosine);
    *value = term->h0 + term->h1 * sine;
    *rate = term->h1 * term->omega * cosine;
}

/* (cos A - cos B)/omega = 2 sin((A+B)/2) sin((B-A)/2)/omega = (t1-t0) sin(middle) sin(half)/half */
static double harmonic_integral(const dmb_term *term, double t0, double t1)
{
    const double middle = term->omega * (0.5 * t0 + 0.5 * t1) + term->phase;
    const double half = 0.5 * term->omega * (t1 - t0);
    const double shape = half != 0.0 ? dmb_sin(half) / half : 1.0;

    return (t1 - t0) * (term->h0 + term->h1 * dmb_sin(middle) * shape);
}

/* ---- TABLE ------------------------------------------------------------------------------------------------------- */

/* Number of knots at or before t: 0 .. table_count. */
static uint32_t knots_until(const dmb_term *term, double t)
{
    uint32_t low = 0;
    uint32_t high = term->table_count;

    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (term->table_time[middle] <= t)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Number of knots before t. */
static uint32_t knots_before(const dmb_term *term, double t)
{
    const uint32_t until = knots_until(term, t);
    return until > 0 && term->table_time[until - 1] == t ? until - 1 : until;
}

/* Value at t given the number of knots at or before it. */
static double table_at(const dmb_term *term, uint32_t before, double t)
{
    const double *x = term->table_time;
    const double *y = term->table_value;

    if (before == 0) return y[0];
    if (before == term->table_count) return y[before - 1];
    return y[before - 1] + (y[before] - y[before - 1]) * ((t - x[before - 1]) / (x[before] - x[before - 1]));
}

/* Slope of the part after `before` knots. */
static double table_slope(const dmb_term *term, uint32_t before)
{
    if (before == 0 || before == term->table_count) return 0.0;
    return (term->table_value[before] - term->table_value[before - 1]) /
           (term->table_time[before] - term->table_time[before - 1]);
}

static void table_value(const dmb_term *term, double t, double *value, double *rate)
{
    const uint32_t before = knots_until(term, t);

    *value = table_at(term, before, t);
    *rate = table_slope(term, before);
}

/* Trapezia from knot to knot: exact. */
static double table_integral(const dmb_term *term, double t0, double t1)
{
    uint32_t next = knots_until(term, t0);
    double start = t0;
    double start_value = table_at(term, next, t0);
    double sum = 0.0;

    for (; next < term->table_count && term->table_time[next] < t1; ++next) {
        sum += 0.5 * (start_value + term->table_value[next]) * (term->table_time[next] - start);
        start = term->table_time[next];
        start_value = term->table_value[next];
    }
    return sum + 0.5 * (start_value + table_at(term, next, t1)) * (t1 - start);
}

/* ---- CALLBACK ---------------------------------------------------------------------------------------------------- */

/* True of a number, NaN not being one, within bounds. */
static int is_sound(double x)
{
    return fabs(x) <= DMB_CALLBACK_MAX;
}

/* One call; out[0 .. needed] of the announced kinds must come back, and within bounds. */
static int32_t call(const dmb_term *term, double t, int32_t needed, double out[3])
{
    out[0] = out[1] = out[2] = (double)NAN;
    if (term->callback == NULL || term->callback(term->callback_context, t, out) != 0) return DMB_ERR_CALLBACK;
    if (needed == 0 && !is_sound(out[0])) return DMB_ERR_CALLBACK;
    if ((needed & DMB_PROVIDES_RATE) != 0 && !(is_sound(out[0]) && is_sound(out[1]))) return DMB_ERR_CALLBACK;
    if ((needed & DMB_PROVIDES_INTEGRAL) != 0 && !is_sound(out[2])) return DMB_ERR_CALLBACK;
    return DMB_OK;
}

/* Central difference; divides by the width that the rounded times really have. */
static int32_t callback_difference(const dmb_term *term, double t, double *rate)
{
    const double width = fmax(DMB_RATE_STEP, DMB_RATE_STEP_FACTOR * fabs(t));
    const double later = t + width;
    const double earlier = t - width;
    double above[3], below[3];

    if (call(term, later, 0, above) != DMB_OK || call(term, earlier, 0, below) != DMB_OK) return DMB_ERR_CALLBACK;
    *rate = (above[0] - below[0]) / (later - earlier);
    return DMB_OK;
}

static int32_t callback_value(const dmb_term *term, double t, double *value, double *rate)
{
    const int32_t provided = rate != NULL ? term->provides & DMB_PROVIDES_RATE : 0;
    double out[3];
    const int32_t status = call(term, t, provided, out);

    if (status != DMB_OK) return status;
    *value = out[0];
    if (rate == NULL) return DMB_OK;
    *rate = out[1];
    return provided != 0 ? DMB_OK : callback_difference(term, t, rate);
}

/* Five-point Gauss-Legendre over one part: exact to degree 9. */
static int32_t callback_part(const dmb_term *term, double a, double b, double *sum)
{
    const dmb_gauss_rule *rule = dmb_gauss(5);

    for (int i = 0; i < rule->count; ++i) {
        double out[3];
        if (call(term, a + (b - a) * rule->node[i], 0, out) != DMB_OK) return DMB_ERR_CALLBACK;
        *sum += (b - a) * rule->weight[i] * out[0];
    }
    return DMB_OK;
}

static int32_t callback_integral(const dmb_term *term, double t0, double t1, double *integral)
{
    const double parts = fmin(fmax(ceil((t1 - t0) / DMB_GAUSS_PART), 1.0), DMB_GAUSS_PARTS_MAX);
    int32_t status = DMB_OK;

    if ((term->provides & DMB_PROVIDES_INTEGRAL) != 0) {
        double start[3], end[3];
        if (call(term, t0, DMB_PROVIDES_INTEGRAL, start) != DMB_OK ||
            call(term, t1, DMB_PROVIDES_INTEGRAL, end) != DMB_OK)
            return DMB_ERR_CALLBACK;
        *integral = end[2] - start[2];
        return DMB_OK;
    }
    *integral = 0.0;
    for (double i = 0.0; i < parts && status == DMB_OK; i += 1.0)
        status = callback_part(term, t0 + (t1 - t0) * (i / parts), t0 + (t1 - t0) * ((i + 1.0) / parts), integral);
    return status;
}

/* ---- Sum of terms ------------------------------------------------------------------------------------------------ */

static int32_t term_value(const dmb_term *term, double t, double *value, double *rate)
{
    double unused = 0.0;
    double *slope = rate != NULL ? rate : &unused;

    switch (term->kind) {
    case DMB_TERM_STEP:
    case DMB_TERM_STEP5: step_value(term, t, value, slope); return DMB_OK;
    case DMB_TERM_HARMONIC: harmonic_value(term, t, value, slope); return DMB_OK;
    case DMB_TERM_TABLE: table_value(term, t, value, slope); return DMB_OK;
    case DMB_TERM_CALLBACK: return callback_value(term, t, value, rate);
    case DMB_TERM_REFERENCE: dmb_reference_value(term->callback_context, t, value, slope); return DMB_OK;
    default:
        *value = term->h0;
        *slope = 0.0;
        return DMB_OK;
    }
}

/* Integral of one term over t0 <= t1. */
static int32_t term_integral(const dmb_term *term, double t0, double t1, double *integral)
{
    switch (term->kind) {
    case DMB_TERM_STEP:
    case DMB_TERM_STEP5: *integral = step_integral(term, t0, t1); return DMB_OK;
    case DMB_TERM_HARMONIC: *integral = harmonic_integral(term, t0, t1); return DMB_OK;
    case DMB_TERM_TABLE: *integral = table_integral(term, t0, t1); return DMB_OK;
    case DMB_TERM_CALLBACK: return callback_integral(term, t0, t1, integral);
    case DMB_TERM_REFERENCE: *integral = dmb_reference_integral(term->callback_context, t0, t1); return DMB_OK;
    default: *integral = term->h0 * (t1 - t0); return DMB_OK;
    }
}

int32_t dmb_programme_value(const dmb_programme *programme, double t, double *value, double *rate)
{
    double sum = 0.0;
    double slope_sum = 0.0;

    if (!isfinite(t)) return DMB_ERR_NOT_FINITE;
    for (uint32_t i = 0; i < programme->count; ++i) {
        double part = 0.0;
        double slope = 0.0;
        const int32_t status = term_value(&programme->terms[i], t, &part, rate != NULL ? &slope : NULL);
        if (status != DMB_OK) return status;
        sum += part;
        slope_sum += slope;
    }
    if (!isfinite(sum) || !isfinite(slope_sum)) return DMB_ERR_NOT_FINITE;
    *value = sum;
    if (rate != NULL) *rate = slope_sum;
    return DMB_OK;
}

int32_t dmb_programme_rate_before(const dmb_programme *programme, double t, double *rate)
{
    double sum = 0.0;

    if (!isfinite(t)) return DMB_ERR_NOT_FINITE;
    for (uint32_t i = 0; i < programme->count; ++i) {
        const dmb_term *term = &programme->terms[i];
        double value, slope = 0.0;
        const int32_t status = term_value(term, t, &value, &slope);
        if (status != DMB_OK) return status;
        if (term->kind == DMB_TERM_TABLE) slope = table_slope(term, knots_before(term, t));
        if (term->kind == DMB_TERM_REFERENCE) slope = dmb_reference_rate_before(term->callback_context, t);
        sum += slope;
    }
    if (!isfinite(sum)) return DMB_ERR_NOT_FINITE;
    *rate = sum;
    return DMB_OK;
}

int32_t dmb_programme_integral(const dmb_programme *programme, double t0, double t1, double *integral)
{
    const double sign = t1 < t0 ? -1.0 : 1.0;
    double sum = 0.0;

    if (!isfinite(t0) || !isfinite(t1)) return DMB_ERR_NOT_FINITE;
    for (uint32_t i = 0; i < programme->count; ++i) {
        double part = 0.0;
        const int32_t status = term_integral(&programme->terms[i], fmin(t0, t1), fmax(t0, t1), &part);
        if (status != DMB_OK) return status;
        sum += part;
    }
    if (!isfinite(sum)) return DMB_ERR_NOT_FINITE;
    *integral = sign * sum;
    return DMB_OK;
}

double dmb_programme_next_corner(const dmb_programme *programme, double t)
{
    double corner = (double)INFINITY;

    for (uint32_t i = 0; i < programme->count; ++i) {
        const dmb_term *term = &programme->terms[i];
        if (term->kind == DMB_TERM_STEP || term->kind == DMB_TERM_STEP5) {
            if (term->x0 > t)
                corner = fmin(corner, term->x0);
            else if (term->x1 > t)
                corner = fmin(corner, term->x1);
        } else if (term->kind == DMB_TERM_TABLE) {
            const uint32_t next = knots_until(term, t);
            if (next < term->table_count) corner = fmin(corner, term->table_time[next]);
        } else if (term->kind == DMB_TERM_REFERENCE) {
            corner = fmin(corner, dmb_reference_next_corner(term->callback_context, t));
        }
    }
    return corner;
}
