/* The stiffness of a static state, as the static iteration leaves it, and what its signs tell. */
#ifndef DMB_ANALYSIS_LINEAR_STIFFNESS_H
#define DMB_ANALYSIS_LINEAR_STIFFNESS_H

#include "system/assemble/evaluation.h"

/* Factors the iteration matrix in the stiffness_ blocks (held rows identity) as dmb_factor_stiffness, and counts its
 * negative eigenvalues in the independent coordinates, of its symmetric part where friction makes it unsymmetric. A
 * pivot that is 0 but for rounding does not count in chains without joints: a buckled column may turn about its load.
 */
int64_t dmb_stiffness_factor(dmb_sim *sim, dmb_block_weakest *weakest, int32_t *negative);
/* Of the chains that no joint connects, from the iteration matrix as it is formed; raised by rounding: *rounding [N/m]
 * of displacements, below which an eigenvalue counts as 0. */
uint32_t dmb_stiffness_negative_of_chains(const dmb_sim *sim, double *rounding);
/* DMB_ERR_ORDER, with a message of `who` in sim, unless the residual just evaluated is that of an equilibrium. */
int32_t dmb_stiffness_balanced(dmb_sim *sim, const char *who, const dmb_evaluation *evaluation);
/* Tells which part nothing holds. DMB_ERR_SINGULAR. */
int32_t dmb_stiffness_explain(dmb_sim *sim, const char *who, uint32_t node);

#endif
