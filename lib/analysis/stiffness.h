/* The stiffness of a static state, as the static iteration leaves it, and what its signs tell. */
#ifndef DMB_ANALYSIS_STIFFNESS_H
#define DMB_ANALYSIS_STIFFNESS_H

#include "state.h"

/* Negative eigenvalues of the iteration matrix in the stiffness_ blocks (held rows identity, not factored), of its
 * symmetric part where friction makes it unsymmetric; -1 in a scene with joints, whose reduced matrix is not there. */
int32_t dmb_stiffness_negative(const dmb_sim *sim);

#endif
