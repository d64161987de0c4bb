/* Mean elastic force over a step, the discrete gradient of the energy that a force stores (eq:unilateral.mean), in a
 * number that is a double or lanes of doubles (math/real.h). Pure. */
#ifndef DMB_FORCE_MEAN_FORCE_H
#define DMB_FORCE_MEAN_FORCE_H

#include "math/real.h"

/* [-] of the places, below which the mean over the way is the force in its middle. */
#define DMB_MEAN_NEAR 1e-9

/* Place x [m, rad] of a force, energy V(x) that it stores [J], dV/dx and d2V/dx2. */
typedef struct dmb_mean_end {
    dmb_real place, energy, force, slope;
} dmb_mean_end;

/* (V1 - V0)/(x1 - x0) and its derivative by x1. */
static inline void dmb_mean_elastic(const dmb_mean_end *a, const dmb_mean_end *b, dmb_real *force, dmb_real *by_place)
{
    const dmb_real way = b->place - a->place, middle = 0.5 * (a->force + b->force);
    const dmb_mask far =
        dmb_mask_less(DMB_MEAN_NEAR * (dmb_real_abs(a->place) + dmb_real_abs(b->place)), dmb_real_abs(way));
    const dmb_real divisor = dmb_real_select(far, way, dmb_real_of(1.0));
    *force = dmb_real_select(far, (b->energy - a->energy) / divisor, middle);
    *by_place = dmb_real_select(far, (b->force - *force) / divisor, 0.5 * b->slope);
}

#endif
