/* Linear algebra of a Newton iteration, shared by steps and statics. */
#ifndef DMB_SYSTEM_SOLVE_H
#define DMB_SYSTEM_SOLVE_H

#include "system/evaluation.h"

/* Norm of the residual over the norm of the terms that balance in it, moments over the length scale; unknown rows only.
 * *converged is 1 at or below the tolerance, or where rounding of the poses alone makes a residual as large. */
double dmb_relative_residual(const dmb_evaluation *evaluation, double tolerance, int32_t *converged);
/* Factors the iteration matrix in place. Index of a singular block, or -1. */
int64_t dmb_factor_matrix(dmb_sim *sim);
/* The same for statics, telling the weakest pivot: what nothing holds shows as one of rounding size. */
int64_t dmb_factor_stiffness(dmb_sim *sim, dmb_block_weakest *weakest);
/* Residual in, Newton correction out, both in `correction`, by the factors at hand. */
void dmb_solve_correction(dmb_sim *sim);

#endif
