/* A bit that cuts sideways. */
#ifndef DMB_FORCE_SIDE_CUTTING_H
#define DMB_FORCE_SIDE_CUTTING_H

#include <math.h>

#include "force/bit_rock.h"

/* Per revolution a bit cuts W/(zeta eps a) deep along its axis under a force W, and sideways `steerability` times as
 * much under the same force across, turned by the walk angle psi about the axis (Ho 1987; Menand et al. 2002):
 *
 *     v = steerability w/(2 pi zeta eps a) Rot(psi) F,   w = sqrt(Omega^2 + O^2)
 *
 * O is the spin below which the laws are faded (DMB_BIT_SPIN_FLOOR): a bit that stands still creeps as at O. Inverted,
 * the rock pushes the bit with -D/w Rot(-psi) v, D = 2 pi zeta eps a/steerability, and takes D/w cos psi |v|^2. */
typedef struct dmb_side_law {
    double resistance; /* [N rad/m] D; 0: it does not cut sideways, and nothing pushes */
    double cosine, sine;
} dmb_side_law;

typedef struct dmb_side_force {
    double force[2];   /* [N] on the bit, y and z */
    double eta;        /* [N s/m] D/w */
    double by_spin[2]; /* [N s/rad] derivative of force by Omega */
} dmb_side_force;

static inline void dmb_side_force_at(const dmb_side_law *law, const double v[2], double spin, dmb_side_force *out)
{
    const double squared = spin * spin + DMB_BIT_SPIN_FLOOR * DMB_BIT_SPIN_FLOOR;
    out->eta = law->resistance / sqrt(squared);
    out->force[0] = -out->eta * (law->cosine * v[0] + law->sine * v[1]);
    out->force[1] = -out->eta * (law->cosine * v[1] - law->sine * v[0]);
    out->by_spin[0] = -out->force[0] * spin / squared;
    out->by_spin[1] = -out->force[1] * spin / squared;
}

#endif
