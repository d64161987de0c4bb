#include "force/normal_law.h"

#include <math.h>

#include "math/real.h"

#define DMB_RESTITUTION_FLOOR 1e-6 /* [-] smallest e for laws whose mu grows like 1/e */
#define DMB_RESTITUTION_LEAST 1e-3 /* [-] smallest e of EXACT, for which mu is 1000 */
#define DMB_SPEED_FLOOR 1e-12      /* [m/s] lower bound of v0 for every law */
#define DMB_NORMAL_LAW_ITERATIONS 60

/* ---- Restitution and damping factor ------------------------------------------------------------------------------
 * One impact under K d^n (1 + mu d'/v0) obeys m v dv/(1 + mu v/v0) = -K d^n dd, so that the ratio of final to initial
 * speed does not depend on n:  ln(1 + mu) - mu = ln(1 - mu e) + mu e, called (1) here (eq:contact.exact).
 * mu = 0 solves it for any e; the required root is the other one. */

/* (1) divided by mu^2 as a series: sum_{k>=2} mu^(k-2) (e^k - (-1)^k)/k. Free of the root at 0 and of cancellation. */
static double balance(double e, double mu, double *slope)
{
    double mu_power = 1.0;    /* mu^(k-2) */
    double slope_power = 0.0; /* (k-2) mu^(k-3) */
    double e_power = e * e;
    double sum = -0.5 * (1.0 - e) * (1.0 + e);

    *slope = 0.0;
    for (int k = 3; k < 400 && mu_power > 1e-19; ++k) {
        slope_power = (double)(k - 2) * mu_power;
        mu_power *= mu;
        e_power *= e;
        const double coefficient = (k % 2 != 0 ? e_power + 1.0 : e_power - 1.0) / (double)k;
        sum += coefficient * mu_power;
        *slope += coefficient * slope_power;
    }
    return sum;
}

/* e near 1 (mu below 0.85): Newton's method on the series, within a shrinking bracket. */
static double factor_of_bouncy(double e)
{
    double low = 0.0;
    double high = 0.9;
    double mu = 1.5 * (1.0 - e) / (1.0 - e + e * e); /* root of the first two terms */

    for (int i = 0; i < DMB_NORMAL_LAW_ITERATIONS; ++i) {
        double slope;
        const double value = balance(e, mu, &slope);
        if (value < 0.0)
            low = mu;
        else
            high = mu;
        double next = mu - value / slope;
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        if (fabs(next - mu) <= 1e-16 * mu) return next;
        mu = next;
    }
    return mu;
}

/* e near 0: Newton's method for y = 1 - mu e in y = (1 + mu) exp(-mu (1 + e)). y minus the right side is concave and
 * increasing between 0 and the required root, so that the iteration increases monotonically to it from y = 0. */
static double factor_of_dull(double e)
{
    double y = 0.0;

    for (int i = 0; i < DMB_NORMAL_LAW_ITERATIONS; ++i) {
        const double mu = (1.0 - y) / e;
        const double decay = dmb_real_exp(-mu * (1.0 + e));
        const double value = y - (1.0 + mu) * decay;
        const double slope = 1.0 - decay * (e + mu * (1.0 + e)) / e;
        const double next = y - value / slope;
        if (!(next > y)) break;
        y = next;
    }
    return (1.0 - y) / e;
}

double dmb_exact_restitution_factor(double e)
{
    if (e >= 1.0) return 0.0;
    if (!(e > DMB_RESTITUTION_FLOOR)) e = DMB_RESTITUTION_FLOOR;
    return e > 0.62 ? factor_of_bouncy(e) : factor_of_dull(e);
}

/* ---- Laws -------------------------------------------------------------------------------------------------------- */

static double restitution_factor(int32_t kind, double e)
{
    switch (kind) {
    case DMB_NORMAL_HUNT_CROSSLEY: /* eq:contact.factors */ return 1.5 * (1.0 - e);
    case DMB_NORMAL_LANKARANI_NIKRAVESH: /* Lankarani, Nikravesh 1990 */ return 0.75 * (1.0 - e) * (1.0 + e);
    case DMB_NORMAL_FLORES: /* Flores, Machado, Silva, Martins 2011 */
        return 1.6 * (1.0 - e) / fmax(e, DMB_RESTITUTION_FLOOR);
    case DMB_NORMAL_EXACT: return dmb_exact_restitution_factor(fmax(e, DMB_RESTITUTION_LEAST));
    default: return 0.0;
    }
}

dmb_normal_law dmb_normal_law_of(dmb_normal_law law, double restitution)
{
    law.mu = restitution_factor(law.kind, restitution);
    if (law.kind < DMB_NORMAL_KELVIN_VOIGT || law.kind > DMB_NORMAL_IMPACT) law.kind = DMB_NORMAL_NONE;
    law.reserved = 0;
    law.impact_floor = fmax(law.impact_floor, DMB_SPEED_FLOOR);
    return law;
}

/* For EXACT, with F = ln(1 + mu) - mu - ln(1 - mu e) - mu e: dmu/de = -F_e/F_mu. */
double dmb_normal_factor_slope(const dmb_normal_law *law, double e)
{
    const double mu = law->mu;
    switch (law->kind) {
    case DMB_NORMAL_HUNT_CROSSLEY: return -1.5;
    case DMB_NORMAL_LANKARANI_NIKRAVESH: return -1.5 * e;
    case DMB_NORMAL_FLORES: return e > DMB_RESTITUTION_FLOOR ? -1.6 / (e * e) : -1.6 / DMB_RESTITUTION_FLOOR;
    case DMB_NORMAL_EXACT: {
        const double by_e = mu * mu * e / (1.0 - mu * e), by_mu = e * e * mu / (1.0 - mu * e) - mu / (1.0 + mu);
        return e > DMB_RESTITUTION_LEAST && e < 1.0 && by_mu != 0.0 ? -by_e / by_mu : 0.0;
    }
    default: return 0.0;
    }
}

void dmb_normal_force(const dmb_normal_law *law, double depth, double rate, double impact_speed, double *force,
                      double *d_depth, double *d_rate)
{
    dmb_normal_response out;
    *force = *d_depth = *d_rate = 0.0;
    if (depth <= 0.0) return;
    const dmb_local_normal local = dmb_local_normal_of(law);
    dmb_normal_response_at(&local, depth, rate, impact_speed, NULL, &out);
    *force = out.force;
    *d_depth = out.d_depth;
    *d_rate = out.d_rate;
}

/* K d^(n+1)/(n+1) per metre of wall (eq:contact.normal without damping). */
double dmb_normal_energy(const dmb_normal_law *law, double depth)
{
    if (depth <= 0.0 || law->kind == DMB_NORMAL_NONE) return 0.0;
    return law->stiffness * dmb_normal_reduced_power(law->exponent, depth) * depth * depth / (law->exponent + 1.0);
}
