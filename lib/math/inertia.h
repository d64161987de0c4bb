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

/* Rounding size of the rows of a symmetric block D (n x n) of stiffnesses, displacements first and then as many
 * rotations (eq:signs.size): the diagonal entry of the row, and at least `floor` of the largest of the block in units
 * of the row, rotations over arm_square [m2]. Rows that `solved` (n; NULL: all) leaves out have 0. */
void dmb_block_row_sizes(uint32_t n, const double *D, double arm_square, const uint8_t *solved, double floor,
                         double *size);

/* Addition to the diagonal before the signs are counted: `part` times the size of each row as above, and `share` of
 * `amount`. */
typedef struct dmb_block_raise {
    double part, share;
    const double *amount;  /* (rows of the layout); NULL: none */
    double arm_square;     /* [m2] */
    double floor;          /* [-] */
    const uint8_t *solved; /* (rows of the layout); NULL: all */
} dmb_block_raise;

/* Of the symmetric part of blocks [first, first + count) of a chain, none of them factored; the matrix is left alone.
 * raise may be NULL. A pivot of 0 counts as positive. Linear in the number of blocks. The count is exact for a matrix
 * whose entries differ from the given ones by some eps sqrt(A_ii A_jj) (backward error). */
uint32_t dmb_block_negative(const dmb_block_layout *layout, const double *diagonal, const double *lower,
                            const double *upper, const dmb_block_raise *raise, uint32_t first, uint32_t count);

/* Of a symmetric block-sparse matrix, from its factors: what the elimination has left of each block when its turn came
 * has as many in all as the matrix (Haynsworth 1968). room: the square of the largest block, of those that have more
 * than 6 rows. */
uint32_t dmb_block_sparse_negative(const dmb_block_pattern *pattern, const dmb_block_sparse *factored, double *room);

#endif
