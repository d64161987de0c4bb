/* Dense LU factors with row pivoting, for blocks of any size; matrices are row-major without gaps. No allocation,
 * always the same order of operations. Meant for blocks of up to some hundred rows: what does not fit a cache is
 * worked off in panels that do. */
#ifndef DMB_MATH_DENSE_LU_H
#define DMB_MATH_DENSE_LU_H

#include <stdint.h>

/* Factors A (n x n) in place: the multipliers below the diagonal, the reciprocal pivots on it, the rest of U above.
 * pivot (n): the row exchanged with row k at step k. -1 when done, else the first column without a pivot
 * (dmb_block_pivot_holds). */
int64_t dmb_dense_factor(uint32_t n, double *A, uint32_t *pivot);

/* B (n x m) <- A^-1 B with a factored A */
void dmb_dense_solve(uint32_t n, uint32_t m, const double *A, const uint32_t *pivot, double *B);

/* b (n) <- A^-1 b with a factored A */
void dmb_dense_solve_vector(uint32_t n, const double *A, const uint32_t *pivot, double *b);

/* Y (p x r) -= F (p x q) X (q x r); Y overlaps neither */
void dmb_dense_subtract_product(uint32_t p, uint32_t q, uint32_t r, const double *F, const double *X, double *Y);

/* y (p) -= F (p x q) x (q) */
void dmb_dense_subtract_vector(uint32_t p, uint32_t q, const double *F, const double *x, double *y);

#endif
