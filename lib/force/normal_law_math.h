/* The normal contact laws in a number that is a double or lanes of doubles (math/real.h). */
#ifndef DMB_FORCE_NORMAL_LAW_MATH_H
#define DMB_FORCE_NORMAL_LAW_MATH_H

#include "force/normal_law.h"
#include "math/elementary.h"

/* Per metre of pipe. */
typedef struct dmb_normal_response {
    dmb_real force;   /* [N/m] */
    dmb_real elastic; /* [N/m] part of it that the wall stores: the force at rate 0 */
    dmb_real d_depth; /* [N/m2] */
    dmb_real d_rate;  /* [N s/m2] */
} dmb_normal_response;

/* d^(n-1), without a power for the line contact n = 1 and the sphere n = 3/2 */
static inline dmb_real dmb_normal_reduced_power(double exponent, dmb_real depth)
{
    if (exponent == 1.0) return dmb_real_of(1.0);
    if (exponent == 1.5) return dmb_real_sqrt(depth);
    return dmb_real_pow(depth, exponent - 1.0);
}

/* Damping "constant" c(d) of KELVIN_VOIGT and IMPACT and its slope; c STEP(d; 0, 0, impact_depth, 1) for the latter. */
static inline dmb_real dmb_normal_damping(const dmb_normal_law *law, dmb_real depth, dmb_real *slope)
{
    const dmb_mask full = dmb_mask_at_most(dmb_real_of(law->impact_depth), depth);
    *slope = dmb_real_of(0.0);
    if (law->kind == DMB_NORMAL_KELVIN_VOIGT || !dmb_mask_any(dmb_mask_not(full))) return dmb_real_of(law->damping);
    const dmb_real x = depth / law->impact_depth;
    *slope = dmb_real_select(full, *slope, law->damping * 6.0 * x * (1.0 - x) / law->impact_depth);
    return dmb_real_select(full, dmb_real_of(law->damping), law->damping * x * x * (3.0 - 2.0 * x));
}

/* At penetration depth > 0 [m] (or NaN) growing at rate [m/s], approach [m/s] the speed at first touch. The force is 0
 * with zero derivatives where the law would pull. */
static inline void dmb_normal_response_at(const dmb_normal_law *law, dmb_real depth, dmb_real rate, dmb_real approach,
                                          dmb_normal_response *out)
{
    const dmb_real zero = dmb_real_of(0.0);
    out->force = out->elastic = out->d_depth = out->d_rate = zero;
    if (law->kind == DMB_NORMAL_NONE) return;
    const dmb_real stiffness = law->stiffness * dmb_normal_reduced_power(law->exponent, depth); /* K d^(n-1) */
    out->elastic = stiffness * depth;
    if (law->kind == DMB_NORMAL_KELVIN_VOIGT || law->kind == DMB_NORMAL_IMPACT) {
        dmb_real slope;
        out->d_rate = dmb_normal_damping(law, depth, &slope);
        out->force = out->elastic + out->d_rate * rate;
        out->d_depth = law->exponent * stiffness + slope * rate;
    } else {
        const dmb_real factor = law->mu / dmb_real_max(approach, dmb_real_of(law->approach_floor));
        out->force = out->elastic * (1.0 + factor * rate);
        out->d_depth = law->exponent * stiffness * (1.0 + factor * rate);
        out->d_rate = out->elastic * factor;
    }
    const dmb_mask pulls = dmb_mask_less(out->force, zero);
    out->force = dmb_real_select(pulls, zero, out->force);
    out->d_depth = dmb_real_select(pulls, zero, out->d_depth);
    out->d_rate = dmb_real_select(pulls, zero, out->d_rate);
}

#endif
