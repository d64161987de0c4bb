/* Rigid mass on a node, one at a time: rigid_mass_math.h with the constants of a rigid_mass. */
#ifndef DMB_ELEMENT_RIGID_MASS_H
#define DMB_ELEMENT_RIGID_MASS_H

#include "element/rigid_mass_math.h"

/* p = M v [kg m/s, kg m2/s] */
static inline void dmb_rigid_mass_times(const dmb_rigid_mass *rigid_mass, const double v[6], double p[6])
{
    dmb_rigid_mass_constants c;
    dmb_rigid_mass_load(rigid_mass, 0, &c);
    dmb_rigid_mass_momentum(&c, v, p);
}

#endif
