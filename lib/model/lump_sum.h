/* Adding rigid masses to the spatial inertia of a node. */
#ifndef DMB_MODEL_LUMP_SUM_H
#define DMB_MODEL_LUMP_SUM_H

#include "element/element_type.h"

/* Adds a body of that mass [kg], centre [m] from the node and inertia [kg m2] xx, yy, zz, xy, xz, yz at its centre. */
void dmb_lump_add(dmb_lump *lump, double mass, const double centre[3], const double inertia[6]);

/* Moves a mass [kg] that is already counted at (x, 0, 0) [m] to (x, e_y, e_z): the node gains a first moment and
 * inertia, but no mass. */
void dmb_lump_shift(dmb_lump *lump, double mass, double x, const double e[2]);

#endif
