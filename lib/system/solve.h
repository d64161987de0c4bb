/* Linear algebra of a Newton iteration, shared by steps and statics. */
#ifndef DMB_SYSTEM_SOLVE_H
#define DMB_SYSTEM_SOLVE_H

#include "system/evaluation.h"

/* DMB_AT_ROUNDING: above the tolerance, but rounding of the poses alone makes a residual as large. Next to very stiff
 * elements small loads are below that, so it ends an iteration and does not stand for one. */
enum { DMB_CONVERGED = 1, DMB_AT_ROUNDING = 2 };

/* Norm of the residual over the norm of the terms that balance in it, moments over the length scale; unknown rows only;
 * chain by chain, so that a light body is not judged by a heavy string. Returns the largest.
 * *converged tells how it compares with the tolerance; 0: neither of the above. */
double dmb_relative_residual(const dmb_evaluation *evaluation, double tolerance, int32_t *converged);
/* [N] Norm of the terms that balance in the residual, weighted as there. */
double dmb_balance_norm(const dmb_sim *sim);
/* Factors the iteration matrix in place. Index of a singular block, or -1. */
int64_t dmb_factor_matrix(dmb_sim *sim);
/* The same for statics, telling the weakest pivot: what nothing holds shows as one of rounding size. */
int64_t dmb_factor_stiffness(dmb_sim *sim, dmb_block_weakest *weakest);
/* Evaluates with the factors the evaluation has, 1 for mass and 0 for velocity, and factors the mass matrix alone; the
 * residual is in `correction`. Errors as dmb_system_evaluate, DMB_ERR_SINGULAR with the node in evaluation->element. */
int32_t dmb_factor_mass(dmb_evaluation *evaluation);
/* Residual in, Newton correction out, both in `correction`, by the factors at hand. */
void dmb_solve_correction(dmb_sim *sim);

#endif
