/* The double integrator value' = rate, rate' = slope with |slope| <= J and |rate| <= A, from (v0, a0) to (v1, 0) in
 * minimum time: bang, zero, bang (Pontryagin; Bryson, Ho, Applied Optimal Control, 1975, section 3.9). d = sign(v1 - v0
 * - a0 |a0|/(2 J)) is the side of the target on which the value would end if the rate were brought to 0 at once. With
 * all quantities multiplied by d, so that the value has to rise,
 *     a_p = min(A, sqrt(J (v1 - v0) + a0^2/2)),  lengths |a_p - a0|/J,  (v1 - v0 - |a_p^2 - a0^2| s/(2 J) - a_p^2/(2
 * J)) /a_p,  a_p/J,  s = sign(a_p - a0). Without a slope limit the rate is A. End times of phases are compared as
 * absolute times, not as differences, so that every caller gets the same number for a breakpoint. */
#include "force/reference.h"

#include <math.h>
#include <stddef.h>

enum { PHASES = 3 };
#define SLIVER 1e-6 /* [-] of the whole transition: a shorter phase ends without a breakpoint of its own */

/* Initial value and rate of each phase and its slope; the transition ends with the last phase. */
typedef struct way {
    double value[PHASES], rate[PHASES], slope[PHASES], begin[PHASES], end[PHASES];
} way;

static double or_none(double limit)
{
    return limit > 0.0 ? limit : (double)INFINITY;
}

/* Sets the phases one after the other; the last one ends at the target. */
static void lay(const dmb_reference *r, const double first_rate, const double slope[PHASES],
                const double length[PHASES], way *w)
{
    double value = r->value, rate = first_rate, at = r->time;
    for (int k = 0; k < PHASES; k++) {
        w->value[k] = value;
        w->rate[k] = rate;
        w->slope[k] = slope[k];
        w->begin[k] = at;
        value += length[k] * (rate + 0.5 * slope[k] * length[k]);
        rate += slope[k] * length[k];
        at += length[k];
        w->end[k] = at;
    }
}

static void way_at_rate(const dmb_reference *r, double most, way *w)
{
    const double rise = r->target - r->value, none[PHASES] = {0.0, 0.0, 0.0};
    const double length[PHASES] = {isinf(most) ? 0.0 : fabs(rise) / most, 0.0, 0.0};
    lay(r, length[0] > 0.0 ? copysign(most, rise) : 0.0, none, length, w);
}

/* The middle phase exists only at the rate limit; without it peak is the rate at which acceleration turns into
 * deceleration. */
static void way_of(const dmb_reference *r, way *w)
{
    const double most = or_none(r->rate_limit), slope = r->slope_limit, a0 = r->rate;
    const double rise = r->target - r->value;
    if (!(slope > 0.0)) {
        way_at_rate(r, most, w);
        return;
    }
    const double d = rise >= a0 * fabs(a0) / (2.0 * slope) ? 1.0 : -1.0, a = d * a0;
    const double peak = fmin(most, sqrt(fmax(0.0, slope * d * rise + 0.5 * a * a)));
    const double way_up = fabs(peak - a) / slope, turned = peak < a ? -1.0 : 1.0;
    const double left = d * rise - 0.5 * (a + peak) * way_up - 0.5 * peak * peak / slope;
    const double length[PHASES] = {way_up, peak > 0.0 && peak == most ? fmax(0.0, left / peak) : 0.0, peak / slope};
    const double slopes[PHASES] = {turned * d * slope, 0.0, -d * slope};
    lay(r, a0, slopes, length, w);
}

/* Phase at time t, from the right (before: from the left); -1 before the transition, PHASES after it. */
static int phase_at(const way *w, double t, int before)
{
    if (before ? t <= w->begin[0] : t < w->begin[0]) return -1;
    for (int k = 0; k < PHASES; k++)
        if (before ? t <= w->end[k] && w->end[k] > w->begin[k] : t < w->end[k]) return k;
    return PHASES;
}

void dmb_reference_value(const dmb_reference *reference, double t, double *value, double *rate)
{
    way w;
    way_of(reference, &w);
    const int k = phase_at(&w, t, 0);
    if (rate != NULL) *rate = 0.0;
    *value = k < 0 ? reference->value : reference->target;
    if (k < 0 || k == PHASES) return;
    const double s = t - w.begin[k];
    *value = w.value[k] + s * (w.rate[k] + 0.5 * w.slope[k] * s);
    if (rate != NULL) *rate = w.rate[k] + w.slope[k] * s;
}

double dmb_reference_rate_before(const dmb_reference *reference, double t)
{
    way w;
    way_of(reference, &w);
    const int k = phase_at(&w, t, 1);
    return k < 0 || k == PHASES ? 0.0 : w.rate[k] + w.slope[k] * (t - w.begin[k]);
}

/* Integral over the part of a phase between two times. */
static double integral_of(const way *w, int k, double t0, double t1)
{
    const double a = fmax(t0, w->begin[k]), b = fmin(t1, w->end[k]);
    if (!(b > a)) return 0.0;
    const double s = a - w->begin[k], h = b - a;
    const double value = w->value[k] + s * (w->rate[k] + 0.5 * w->slope[k] * s), rate = w->rate[k] + w->slope[k] * s;
    return h * (value + h * (0.5 * rate + h * w->slope[k] / 6.0));
}

/* Parts before, within and after the transition: exact, as motion drives require. */
double dmb_reference_integral(const dmb_reference *reference, double t0, double t1)
{
    way w;
    way_of(reference, &w);
    double sum = reference->value * fmax(0.0, fmin(t1, w.begin[0]) - t0);
    for (int k = 0; k < PHASES; k++) sum += integral_of(&w, k, t0, t1);
    return sum + reference->target * fmax(0.0, t1 - fmax(t0, w.end[PHASES - 1]));
}

double dmb_reference_next_breakpoint(const dmb_reference *reference, double t)
{
    way w;
    way_of(reference, &w);
    const double whole = w.end[PHASES - 1] - w.begin[0];
    if (!(whole > 0.0)) return (double)INFINITY;
    for (int k = 0; k < PHASES; k++) {
        const int last = k + 1 == PHASES || !(w.end[PHASES - 1] - w.end[k] > SLIVER * whole);
        if (last) return w.end[PHASES - 1] > t ? w.end[PHASES - 1] : (double)INFINITY;
        if (w.end[k] - w.begin[0] > SLIVER * whole && w.end[k] > t) return w.end[k];
    }
    return (double)INFINITY;
}

double dmb_reference_arrival(const dmb_reference *reference)
{
    way w;
    way_of(reference, &w);
    return w.end[PHASES - 1];
}
