/* Dense matrices: scalar product of long vectors with eight interleaved sums, LU factors, and products for analyses. */
#ifndef DMB_MATH_DENSE_H
#define DMB_MATH_DENSE_H

#include <stddef.h>
#include <stdint.h>

static inline double dmb_dot(size_t n, const double *a, const double *b)
{
    double part[8] = {0.0}, sum = 0.0;
    size_t i = 0;
    for (; i + 8 <= n; i += 8)
        for (size_t k = 0; k < 8; k++) part[k] += a[i + k] * b[i + k];
    for (; i < n; i++) sum += a[i] * b[i];
    for (size_t k = 0; k < 8; k++) sum += part[k];
    return sum;
}

/* Dense LU factors with row pivoting, for blocks of any size; matrices are row-major without gaps. No allocation; the
 * order of operations is fixed. For blocks of up to some hundred rows: a block larger than the cache is processed in
 * panels that fit it. */

/* Factors A (n x n) in place: the multipliers below the diagonal, the reciprocal pivots on it, the remaining part of U
 * above. pivot (n): the row exchanged with row k at step k. Returns -1 on success, otherwise the first column without a
 * pivot (dmb_block_pivot_holds). */
int64_t dmb_dense_factor(uint32_t n, double *A, uint32_t *pivot);

/* B (n x m) <- A^-1 B with a factored A */
void dmb_dense_solve(uint32_t n, uint32_t m, const double *A, const uint32_t *pivot, double *B);

/* b (n) <- A^-1 b with a factored A */
void dmb_dense_solve_vector(uint32_t n, const double *A, const uint32_t *pivot, double *b);

/* Y (p x r) -= F (p x q) X (q x r); Y overlaps neither */
void dmb_dense_subtract_product(uint32_t p, uint32_t q, uint32_t r, const double *F, const double *X, double *Y);

/* y (p) -= F (p x q) x (q) */
void dmb_dense_subtract_vector(uint32_t p, uint32_t q, const double *F, const double *x, double *y);

/* Products of dense square matrices, column-major without gaps, for analyses; never called by steps. */

/* A <- X^T A X, all of shape (n, n); work: shape (n + 1, n). O(n^3) */
void dmb_dense_congruence(size_t n, const double *X, double *A, double *work);
/* y = A x, A of shape (n, n). */
void dmb_dense_times(size_t n, const double *A, const double *x, double *y);

#endif
