/* Whether rings that slip leave a state without divergence, without an eigenvalue being sought.
 *
 * A ring with the stiffness k of the wall behind it adds k (n + f) n^T to K: n its normal, f friction for a unit of
 * normal force. The symmetric part of this alone has a negative eigenvalue, however little friction there is. With
 *
 *     W = I - f n^T,      W (n + f) n^T = n n^T,
 *
 * K x = mu D x has no real mu below -rounding/(1 - |f|/2) if
 *
 *     sym(W K) + rounding D     is positive definite, |f| < 2 in the weights D:
 *
 * then so is sym(W (K + rho D)) for rho beyond that, and K + rho D is regular. f n^T of nodes without contact is taken
 * between those of their neighbours, since a W that is the same for neighbours leaves the stiffness between them nearly
 * symmetric. */
#ifndef DMB_ANALYSIS_STATIC_STABILITY_FRICTION_H
#define DMB_ANALYSIS_STATIC_STABILITY_FRICTION_H

#include "system/assemble/evaluation.h"

/* Multiplies the rows of chains without joints in the iteration matrix, which is not factored, by W. 1: done; 0: no
 * ring slips, or |f| is too large, and the matrix is left as it is; DMB_ERR_NO_MEMORY. */
int32_t dmb_stability_turn_friction(const dmb_evaluation *evaluation);

#endif
