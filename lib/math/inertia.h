/* Number of negative eigenvalues of a symmetric matrix (Sylvester's law of inertia): what the sign of a stiffness is
 * judged by, and what counts the critical factors below a given one (Sturm sequence). Always the same order of
 * operations: statics, paths and buckling call no BLAS. */
#ifndef DMB_MATH_INERTIA_H
#define DMB_MATH_INERTIA_H

#include "math/block_sparse.h"
#include "math/block_tridiagonal.h"

/* Of the symmetric part of A (n x n, row-major), which is overwritten. A pivot of 0 counts as positive. */
uint32_t dmb_dense_negative(uint32_t n, double *A);
/* A (n x n) from its factors as dmb_dense_factor and the block-sparse solver leave them: reciprocal pivots on the
 * diagonal, pivot: the row exchanged with row k at step k. */
void dmb_dense_from_factors(uint32_t n, const double *LU, const uint32_t *pivot, double *A);

/* Of the symmetric part of blocks [first, first + count) of a chain, none of them factored; the matrix is left alone.
 * raise, if not NULL, is added to the diagonal: [0] in the first half of the rows of each block, [1] in the rest (to
 * displacements, to rotations). A pivot of 0 counts as positive. Linear in the
 * number of blocks. */
uint32_t dmb_block_negative(const dmb_block_layout *layout, const double *diagonal, const double *lower,
                            const double *upper, const double raise[2], uint32_t first, uint32_t count);

/* Of a symmetric block-sparse matrix, from its factors: what the elimination has left of each block when its turn came
 * has as many in all as the matrix (Haynsworth 1968). room: the square of the largest block, of those that have more
 * than 6 rows. */
uint32_t dmb_block_sparse_negative(const dmb_block_pattern *pattern, const dmb_block_sparse *factored, double *room);

#endif
