/* Rigid mass on a node, one at a time: lump_math.h with the constants of a rigid_mass. */
#ifndef DMB_ELEMENT_LUMP_H
#define DMB_ELEMENT_LUMP_H

#include "element/rigid_mass.h"

/* p = M v [kg m/s, kg m2/s] */
static inline void dmb_rigid_mass_times(const dmb_rigid_mass *rigid_mass, const double v[6], double p[6])
{
    dmb_rigid_mass_constants c;
    dmb_rigid_mass_load(rigid_mass, 0, &c);
    dmb_rigid_mass_momentum(&c, v, p);
}

#endif
