/* Number of negative eigenvalues of a symmetric matrix (Sylvester's law of inertia). It decides whether a stiffness is
 * positive definite, and counts the critical factors below a given one (Sturm sequence). The order of operations is
 * fixed: statics, path following and buckling call no BLAS. */
#ifndef DMB_MATH_INERTIA_H
#define DMB_MATH_INERTIA_H

#include "math/block_sparse.h"
#include "math/block_tridiagonal.h"

/* Number of negative eigenvalues of the symmetric part of A (n x n, row-major), which is overwritten. A pivot of 0
 * counts as positive. */
uint32_t dmb_dense_negative(uint32_t n, double *A);
/* Computes A (n x n) from its factors, as dmb_dense_factor and the block-sparse solver store them: reciprocal pivots on
 * the diagonal, pivot: the row exchanged with row k at step k. */
void dmb_dense_from_factors(uint32_t n, const double *LU, const uint32_t *pivot, double *A);

/* Rounding size of the rows of a symmetric block D (n x n) of stiffnesses, displacements first and then as many
 * rotations (eq:signs.size): the diagonal entry of the row, and at least `floor` of the largest of the block in units
 * of the row, rotations over arm_square [m2]. Rows that are not in `solved` (n; NULL: all) have size 0. */
void dmb_block_row_sizes(uint32_t n, const double *D, double arm_square, const uint8_t *solved, double floor,
                         double *size);

/* Addition to the diagonal before the signs are counted: `part` times the size of each row as above, plus `share` times
 * `amount`. */
typedef struct dmb_block_raise {
    double part, share;
    const double *amount;  /* (rows of the layout); NULL: none */
    double arm_square;     /* [m2] > 0 if part > 0 */
    double floor;          /* [-] */
    const uint8_t *solved; /* (rows of the layout); NULL: all */
} dmb_block_raise;

/* Number of negative eigenvalues of the symmetric part of blocks [first, first + count) of a chain, not factored; the
 * matrix is unchanged. raise may be NULL. A pivot of 0 counts as positive. Linear in the number of blocks. The count is
 * exact for a matrix whose entries differ from the given ones by some eps sqrt(A_ii A_jj) (backward error). */
uint32_t dmb_block_negative(const dmb_block_layout *layout, const double *diagonal, const double *lower,
                            const double *upper, const dmb_block_raise *raise, uint32_t first, uint32_t count);

/* Number of negative eigenvalues of a symmetric block-sparse matrix, from its factors: the diagonal blocks at their
 * elimination have together as many as the matrix (Haynsworth 1968). room: workspace, the square of the largest block
 * of those with more than 6 rows. */
uint32_t dmb_block_sparse_negative(const dmb_block_pattern *pattern, const dmb_block_sparse *factored, double *room);

#endif
