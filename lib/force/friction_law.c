#include "force/friction_law.h"

#include <math.h>

#include "force/time_function.h"

/* ---- Maximum of the smoothed law (eq:friction.peak) --------------------------------------------------------------
 * 1/kappa = max over s of r E, r = sqrt(1 - v_eps^2/s^2). For E = exp(-s/v_s) it is where s^3 - v_eps^2 s = v_eps^2
 * v_s; for a falling linear segment E = a + b s of a table it is where v_eps^2 (a + b s) + b s (s^2 - v_eps^2) = 0.
 * Both sides change sign once. */

#define DECAY_LEAST 0.3  /* [-] of v_eps: smoothing does not resolve a faster decay */
#define KAPPA_MOST 100.0 /* [-] tables whose static part ends below v_eps are raised by no more than this factor */
#define HALVINGS 100

static double smoothed_decay(const dmb_friction_law *law, double s)
{
    const double ratio = law->smoothing_speed / s;
    double slope;
    if (!(ratio < 1.0)) return 0.0;
    return sqrt((1.0 - ratio) * (1.0 + ratio)) *
           (law->points > 0 ? dmb_friction_table_decay(law, s, &slope) : dmb_stribeck_decay(law, s, &slope));
}

/* 1/kappa by bisection for the maximum, which lies between v_eps and v_eps + v_s. */
static double peak_of_curve(const dmb_friction_law *law)
{
    const double eps = law->smoothing_speed, right = eps * eps * law->stribeck_speed;
    double low = eps, high = eps + law->stribeck_speed;
    for (int i = 0; i < HALVINGS; i++) {
        const double s = 0.5 * (low + high);
        if (s * (s - eps) * (s + eps) < right)
            low = s;
        else
            high = s;
    }
    return smoothed_decay(law, low);
}

/* Largest value on the falling segment from x to x1: at its ends, where E has fallen to 1, or between. */
static double peak_of_piece(const dmb_friction_law *law, int k)
{
    const double *x = law->table_speed, *y = law->table_mu, last = y[law->points - 1], height = y[0] - last;
    const double b = (y[k + 1] - y[k]) / (x[k + 1] - x[k]) / height, a = (y[k] - last) / height - b * x[k];
    const double eps = law->smoothing_speed;
    double low = fmax(x[k], eps), high = fmax(x[k + 1], eps), most = fmax(smoothed_decay(law, low), 0.0);
    most = fmax(most, smoothed_decay(law, high));
    if (b >= 0.0) return most;
    const double one = (1.0 - a) / b;
    if (one > low && one < high) most = fmax(most, smoothed_decay(law, one));
    for (int i = 0; i < HALVINGS; i++) {
        const double s = 0.5 * (low + high);
        if (eps * eps * (a + b * s) + b * s * (s - eps) * (s + eps) > 0.0)
            low = s;
        else
            high = s;
    }
    return fmax(most, smoothed_decay(law, low));
}

static double peak_of_table(const dmb_friction_law *law)
{
    double most = 1.0 / KAPPA_MOST;
    for (int k = 0; k + 1 < law->points; k++) most = fmax(most, peak_of_piece(law, k));
    return most;
}

/* A = peak_bump and B = peak_level of eq:friction.peak; both 0 for laws without a static maximum. */
dmb_friction_law dmb_friction_law_of(dmb_friction_law law)
{
    law.peak_bump = law.peak_level = 0.0;
    if (law.kind != DMB_FRICTION_STRIBECK || !(law.smoothing_speed > 0.0)) return law;
    if (law.points > 0 && !(law.table_mu[0] > law.table_mu[law.points - 1])) return law;
    law.stribeck_speed = fmax(law.stribeck_speed, DECAY_LEAST * law.smoothing_speed);
    const double kappa = 1.0 / (law.points > 0 ? peak_of_table(&law) : peak_of_curve(&law));
    law.peak_bump = (kappa - 1.0) * kappa * kappa * kappa;
    law.peak_level = kappa * kappa * kappa * kappa;
    return law;
}

/* ---- Law of the caller ------------------------------------------------------------------------------------------- */

static double size_of(const double *x, uint32_t count)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < count; i++) sum += fabs(x[i]);
    return sum;
}

int32_t dmb_friction_call(const dmb_friction_law *law, const dmb_friction_at *at, const dmb_law_memory *memory,
                          dmb_friction_result *to)
{
    static const dmb_friction_result nothing = {{0.0}, {0.0}, {0.0}};
    *to = nothing;
    for (uint32_t i = 0; i < law->states; i++) memory->trial[i] = memory->accepted[i];
    const int32_t stopped = law->callback(law->context, at, to->force, to->by_slip, to->by_normal, memory);
    const double size = size_of(to->force, 2) + size_of(to->by_slip, 4) + size_of(to->by_normal, 2) +
                        size_of(memory->trial, law->states);
    if (stopped == 0 && size <= DMB_CALLBACK_MAX) return DMB_OK; /* nor is a NaN */
    to->force[0] = to->force[1] = (double)NAN;
    return DMB_ERR_CALLBACK;
}
