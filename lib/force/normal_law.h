/* Normal contact laws: force as a function of penetration depth and its rate, per metre of pipe.
 * eq:contact.normal with the damping factor mu of Hunt-Crossley, Lankarani-Nikravesh, Flores (eq:contact.factors) or
 * the exact one; Kelvin-Voigt and IMPACT with a damping constant (eq:contact.kelvin-voigt). Pure functions. */
#ifndef DMB_FORCE_NORMAL_LAW_H
#define DMB_FORCE_NORMAL_LAW_H

#include <stdint.h>

#include "drillmbd/scene.h"
#include "force/unilateral.h"
#include "math/elementary.h"

typedef struct dmb_normal_law {
    int32_t kind; /* DMB_NORMAL_... */
    int32_t reserved;
    double stiffness;    /* [N/m^(n+1)] K per metre of pipe */
    double exponent;     /* [-] n >= 1 */
    double damping;      /* [N s/m2] c per metre of pipe, of KELVIN_VOIGT and IMPACT */
    double impact_depth; /* [m] depth from which damping is full, of IMPACT */
    double mu;           /* [-] damping factor of the restitution laws, 0 for the others */
    double impact_floor; /* [m/s] smallest v0 */
} dmb_normal_law;

/* Returns the law with mu from the restitution e in 0 .. 1. For FLORES and EXACT, whose mu grows like 1/e, e is at
 * least 1e-6 and 1e-3. An unknown kind becomes DMB_NORMAL_NONE. Other values are not checked (the model has checked
 * them). */
dmb_normal_law dmb_normal_law_of(dmb_normal_law law, double restitution);

/* [-] Damping factor mu for which K d^n (1 + mu d'/v0) reproduces the restitution e, for any n and v0: mu (1 + e) =
 * ln((1 + mu)/(1 - mu e)) (eq:contact.exact). To 1e-15 relative. e >= 1 gives 0; e below 1e-6 (or NaN) counts as 1e-6.
 */
double dmb_exact_restitution_factor(double e);

/* d mu/d restitution of a law whose mu was computed from the restitution e. */
double dmb_normal_factor_slope(const dmb_normal_law *law, double e);

/* Force [N/m, >= 0, pushing the bodies apart] at penetration depth [m] growing at rate [m/s], and its derivatives
 * [N/m2] and [N s/m2]. impact_speed [m/s]: d' at first touch, stored by the caller. The force and its derivatives are 0
 * for depth <= 0 and if the law would pull. NaN gives NaN. */
void dmb_normal_force(const dmb_normal_law *law, double depth, double rate, double impact_speed, double *force,
                      double *d_depth, double *d_rate);

/* [J/m] Elastic energy K d^(n+1)/(n+1) stored at penetration depth [m]; 0 for depth <= 0. */
double dmb_normal_energy(const dmb_normal_law *law, double depth);

/* The normal contact laws for numbers that are doubles or lanes of doubles (math/real.h). */

/* A law with constants of the place, which differ from lane to lane in a hole of sections. */
typedef struct dmb_local_normal {
    const dmb_normal_law *law;       /* all other constants */
    dmb_real stiffness, damping, mu; /* as there */
} dmb_local_normal;

static inline dmb_local_normal dmb_local_normal_of(const dmb_normal_law *law)
{
    const dmb_local_normal local = {law, dmb_real_of(law->stiffness), dmb_real_of(law->damping), dmb_real_of(law->mu)};
    return local;
}

/* Per metre of pipe. */
typedef struct dmb_normal_response {
    dmb_real force;   /* [N/m] */
    dmb_real elastic; /* [N/m] elastic part, which the wall stores: the force at rate 0 */
    dmb_real d_depth; /* [N/m2] */
    dmb_real d_rate;  /* [N s/m2] */
    dmb_real whole;   /* [N/m] force without the restriction that it must push */
} dmb_normal_response;

/* d^(n-1), without a power for the line contact n = 1 and the sphere n = 3/2 */
static inline dmb_real dmb_normal_reduced_power(double exponent, dmb_real depth)
{
    if (exponent == 1.0) return dmb_real_of(1.0);
    if (exponent == 1.5) return dmb_real_sqrt(depth);
    return dmb_real_pow(depth, exponent - 1.0);
}

/* Damping coefficient c(d) of KELVIN_VOIGT and IMPACT and its slope; c STEP(d; 0, 0, impact_depth, 1) for the latter.
 */
static inline dmb_real dmb_normal_damping(const dmb_normal_law *law, dmb_real damping, dmb_real depth, dmb_real *slope)
{
    const dmb_mask full = dmb_mask_at_most(dmb_real_of(law->impact_depth), depth);
    *slope = dmb_real_of(0.0);
    if (law->kind == DMB_NORMAL_KELVIN_VOIGT || !dmb_mask_any(dmb_mask_not(full))) return damping;
    const dmb_real x = depth / law->impact_depth;
    *slope = dmb_real_select(full, *slope, damping * 6.0 * x * (1.0 - x) / law->impact_depth);
    return dmb_real_select(full, damping, damping * x * x * (3.0 - 2.0 * x));
}

/* ---- Touch that a step resolves ---------------------------------------------------------------------------------- */

#define DMB_TOUCH_FIRST (11.0 / 6.0)
#define DMB_TOUCH_MOST 4.0 /* [-] largest weight, reached after steps that are much shorter than the previous one */

/* History of a contact point (eq:touch.weights, eq:touch.time): w - 1 of the last step; D [s], the time that the
 * weights are still short of; p, the closed fraction of the step with touch while w2 is due, else 0; and without
 * contact the (tensile) force [N/m] that the law would give. */
enum { DMB_TOUCH_EXCESS, DMB_TOUCH_TIME, DMB_TOUCH_PART, DMB_TOUCH_FORCE, DMB_TOUCH_SIZE };

/* Weight w [-] of the damping and its derivative with respect to the depth [1/m]. */
typedef struct dmb_normal_touch {
    dmb_real weight, by_depth;
} dmb_normal_touch;

/* Computes the weight at depth > 0 [m] after a step h [s] from the depth `before`. was, is: previous and new state of
 * the contact point, without its force. eq:touch.weights, unequal steps: eq:touch.time. */
static inline void dmb_normal_touch_at(dmb_real before, dmb_real depth, dmb_real h, const dmb_real was[DMB_TOUCH_SIZE],
                                       dmb_normal_touch *out, dmb_real is[DMB_TOUCH_SIZE])
{
    const dmb_real zero = dmb_real_of(0.0), one = dmb_real_of(1.0), p = was[DMB_TOUCH_PART];
    const dmb_mask closes = dmb_mask_at_most(before, zero), second = dmb_mask_less(zero, p);
    const dmb_real rest = dmb_real_abs(was[DMB_TOUCH_TIME]) + dmb_real_abs(was[DMB_TOUCH_EXCESS]);
    out->weight = one;
    out->by_depth = is[DMB_TOUCH_EXCESS] = is[DMB_TOUCH_TIME] = is[DMB_TOUCH_PART] = zero;
    if (!dmb_mask_any(closes | second | dmb_mask_less(zero, rest)))
        return; /* the same result as below, without divisions */
    const dmb_real way = dmb_real_select(closes, depth - before, one), part = depth / way;
    const dmb_real first = DMB_TOUCH_FIRST * part, next = DMB_TOUCH_FIRST - p * (5.0 / 3.0 - 0.5 * p);
    const dmb_real time = was[DMB_TOUCH_TIME], excess = was[DMB_TOUCH_EXCESS];
    const dmb_real missing = dmb_real_max(zero, 1.0 + time / h - 0.5 * excess);
    const dmb_real last =
        dmb_real_select(dmb_mask_less(dmb_real_of(DMB_TOUCH_MOST), missing), dmb_real_of(DMB_TOUCH_MOST), missing);
    out->weight = dmb_real_select(closes, first, dmb_real_select(second, next, last));
    out->by_depth = dmb_real_select(closes, -DMB_TOUCH_FIRST * before / (way * way), zero);
    is[DMB_TOUCH_EXCESS] = out->weight - 1.0;
    is[DMB_TOUCH_TIME] =
        dmb_real_select(closes, h * (part - 0.5 * out->weight), time - 0.5 * h * (excess + is[DMB_TOUCH_EXCESS]));
    is[DMB_TOUCH_PART] = dmb_real_select(closes, part, zero);
}

/* Computes eq:contact.normal at penetration depth > 0 [m] (or NaN) with rate [m/s]; impact_speed [m/s] is the speed at
 * first touch. The force and its derivatives are 0 if the law would pull. touch: NULL if damping is not weighted. */
static inline void dmb_normal_response_at(const dmb_local_normal *local, dmb_real depth, dmb_real rate,
                                          dmb_real impact_speed, const dmb_normal_touch *touch,
                                          dmb_normal_response *out)
{
    const dmb_real zero = dmb_real_of(0.0);
    const dmb_normal_law *law = local->law;
    out->force = out->elastic = out->d_depth = out->d_rate = out->whole = zero;
    if (law->kind == DMB_NORMAL_NONE) return;
    const dmb_real stiffness = local->stiffness * dmb_normal_reduced_power(law->exponent, depth); /* K d^(n-1) */
    out->elastic = stiffness * depth;
    if (law->kind == DMB_NORMAL_KELVIN_VOIGT || law->kind == DMB_NORMAL_IMPACT) {
        dmb_real slope;
        out->d_rate = dmb_normal_damping(law, local->damping, depth, &slope);
        if (touch != NULL && law->kind == DMB_NORMAL_KELVIN_VOIGT) {
            slope = out->d_rate * touch->by_depth;
            out->d_rate = out->d_rate * touch->weight;
        }
        out->force = out->elastic + out->d_rate * rate;
        out->d_depth = law->exponent * stiffness + slope * rate;
    } else {
        const dmb_real factor = local->mu / dmb_real_max(impact_speed, dmb_real_of(law->impact_floor));
        out->force = out->elastic * (1.0 + factor * rate);
        out->d_depth = law->exponent * stiffness * (1.0 + factor * rate);
        out->d_rate = out->elastic * factor;
    }
    out->whole = out->force;
    const dmb_mask pulls = dmb_mask_less(out->force, zero);
    out->force = dmb_real_select(pulls, zero, out->force);
    out->d_depth = dmb_real_select(pulls, zero, out->d_depth);
    out->d_rate = dmb_real_select(pulls, zero, out->d_rate);
}

/* ---- Touch and release that a step does not resolve --------------------------------------------------------------
 *
 * In a step of length h from the depth x0 to x1 (< 0: off the wall) in which a contact closes or opens, it has its mean
 * force (eq:contact.mean). With d = max(x, 0), the energy V = K d^(n+1)/(n+1) and the impulse D(d) of the damping on
 * the way to the depth d, integral of c dd, mu V/v0 of restitution laws,
 *     G = (V1 - V0)/(x1 - x0) + (D1 - D0)/h, never pulling
 * so that the wall takes G (x1 - x0) - (V1 - V0) >= 0 out of the bodies.
 */

/* Per metre of pipe. */
typedef struct dmb_normal_parts {
    dmb_real elastic, elastic_by_depth; /* [N/m], [N/m2] (V1 - V0)/(x1 - x0) */
    dmb_real damper, damper_by_depth;   /* [N/m], [N/m2] (D1 - D0)/h */
    dmb_real rise;                      /* [J/m] V1 - V0 */
} dmb_normal_parts;

/* V, dV/dx, d2V/dx2 at x. */
static inline dmb_mean_end dmb_normal_end(const dmb_local_normal *local, dmb_real x)
{
    const dmb_real zero = dmb_real_of(0.0), d = dmb_real_max(x, zero);
    const dmb_mask closed = dmb_mask_less(zero, x);
    const double n = local->law->exponent;
    const dmb_real stiffness = local->stiffness * dmb_normal_reduced_power(n, d);
    dmb_mean_end end;
    end.place = x;
    end.force = stiffness * d;
    end.energy = end.force * d / (n + 1.0);
    end.slope = dmb_real_select(closed, n * stiffness, zero);
    return end;
}

/* [N s/m2] D at d >= 0 and dD/dd; of a fading damper c (x^3 - x^4/2) impact_depth up to x = d/impact_depth = 1. */
static inline dmb_real dmb_normal_damped(const dmb_local_normal *local, dmb_real d, dmb_real *by_depth)
{
    const dmb_normal_law *law = local->law;
    const dmb_real zero = dmb_real_of(0.0), full = d * local->damping;
    dmb_real slope;
    *by_depth = zero;
    if (law->kind != DMB_NORMAL_KELVIN_VOIGT && law->kind != DMB_NORMAL_IMPACT) return zero;
    *by_depth = dmb_normal_damping(law, local->damping, d, &slope);
    if (law->kind == DMB_NORMAL_KELVIN_VOIGT) return full;
    const dmb_real x = d / law->impact_depth;
    const dmb_real fades = local->damping * law->impact_depth * (x * x * x * (1.0 - 0.5 * x));
    return dmb_real_select(dmb_mask_less(d, dmb_real_of(law->impact_depth)), fades,
                           full - 0.5 * local->damping * law->impact_depth);
}

/* The law as if it went on pulling off the wall, to x < 0: V(-x). */
static inline dmb_mean_end dmb_normal_mirrored(const dmb_mean_end *end, const dmb_mean_end *mirrored, dmb_mask where)
{
    const dmb_mean_end to = {end->place, dmb_real_select(where, mirrored->energy, end->energy),
                             dmb_real_select(where, -mirrored->force, end->force),
                             dmb_real_select(where, mirrored->slope, end->slope)};
    return to;
}

/* factor [s/m]: mu/v0. plastic: where a contact opens, the force falls as the law does till it would pull, so that the
 * wall keeps what is stored there. */
static inline void dmb_normal_parts_of(const dmb_local_normal *local, dmb_real before, dmb_real depth, dmb_real factor,
                                       dmb_mask plastic, double h, dmb_normal_parts *out)
{
    const dmb_real zero = dmb_real_of(0.0);
    const dmb_mask off = plastic & dmb_mask_less(zero, before) & dmb_mask_less(depth, zero);
    const dmb_mean_end a = dmb_normal_end(local, before), b = dmb_normal_end(local, depth);
    dmb_real slope0, slope1;
    out->rise = b.energy - a.energy;
    if (dmb_mask_any(off)) {
        const dmb_mean_end behind = dmb_normal_end(local, -depth), to = dmb_normal_mirrored(&b, &behind, off);
        dmb_mean_elastic(&a, &to, &out->elastic, &out->elastic_by_depth);
    } else {
        dmb_mean_elastic(&a, &b, &out->elastic, &out->elastic_by_depth);
    }
    const dmb_real damped0 = dmb_normal_damped(local, dmb_real_max(before, zero), &slope0);
    const dmb_real damped1 = dmb_normal_damped(local, dmb_real_max(depth, zero), &slope1);
    out->damper = (damped1 - damped0 + factor * out->rise) / h;
    out->damper_by_depth = dmb_real_select(dmb_mask_less(zero, depth), (slope1 + factor * b.force) / h, zero);
}

static inline dmb_real dmb_normal_factor(const dmb_local_normal *local, dmb_real impact_speed)
{
    return local->mu / dmb_real_max(impact_speed, dmb_real_of(local->law->impact_floor));
}

/* G as `force`, its derivative by x1, and [J/m] what the wall takes. */
typedef struct dmb_normal_mean {
    dmb_real force, d_depth, taken;
} dmb_normal_mean;

static inline void dmb_normal_mean_at(const dmb_local_normal *local, dmb_real before, dmb_real depth,
                                      dmb_real impact_speed, dmb_mask plastic, double h, dmb_normal_mean *out)
{
    const dmb_real zero = dmb_real_of(0.0);
    dmb_normal_parts p;
    out->force = out->d_depth = out->taken = zero;
    if (local->law->kind == DMB_NORMAL_NONE) return;
    dmb_normal_parts_of(local, before, depth, dmb_normal_factor(local, impact_speed), plastic, h, &p);
    out->force = p.elastic + p.damper;
    const dmb_mask pulls = dmb_mask_less(out->force, zero);
    out->force = dmb_real_select(pulls, zero, out->force);
    out->d_depth = dmb_real_select(pulls, zero, p.elastic_by_depth + p.damper_by_depth);
    out->taken = out->force * (depth - before) - p.rise;
}

/* Newton's correction of the depth x at which a ring comes to rest against its mean force that would come to `depth`
 * without: x + yield G(x) = depth. G is convex, so that from `depth` on all of them go the same way. */
static inline void dmb_normal_mean_correct(dmb_real depth, dmb_real yield, const dmb_normal_mean *mean, dmb_real *x)
{
    *x = *x - (*x - depth + yield * mean->force) / (1.0 + yield * mean->d_depth);
}

#endif
