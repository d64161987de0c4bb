/* Rigid mass on a node, one at a time: lump_math.h with the constants of a lump. */
#ifndef DMB_ELEMENT_LUMP_H
#define DMB_ELEMENT_LUMP_H

#include "element/lump_math.h"

/* p = M v [kg m/s, kg m2/s] */
static inline void dmb_lump_mass_times(const dmb_lump *lump, const double v[6], double p[6])
{
    dmb_lump_constants c;
    dmb_lump_load(lump, 0, &c);
    dmb_lump_momentum(&c, v, p);
}

#endif
