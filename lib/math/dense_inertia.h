/* Signs of the eigenvalues of a dense symmetric matrix, from itself or from its LU factors. */
#ifndef DMB_MATH_DENSE_INERTIA_H
#define DMB_MATH_DENSE_INERTIA_H

#include <stdint.h>

/* Number of negative eigenvalues of the symmetric part of A (n x n, row-major), which is overwritten. A pivot of 0
 * counts as positive. */
uint32_t dmb_dense_negative(uint32_t n, double *A);
/* A (n x n) from its factors as dmb_dense_factor and the block-sparse solver leave them: reciprocal pivots on the
 * diagonal, pivot: the row exchanged with row k at step k. */
void dmb_dense_from_factors(uint32_t n, const double *LU, const uint32_t *pivot, double *A);

#endif
