/* The kernels of block_tridiagonal.h, for the files that compile them: each is written once with the sizes n (this block)
 * and m (the next, 0 at the end of a chain) as arguments. BY_SIZE passes constants for 6-6 and 2-2, so the compiler makes
 * kernels of fixed size; other pairs take the same source with sizes from memory. Inner loops run along rows or columns,
 * so they vectorise without any change in the order of a sum: every width gives the same bits. */
#ifndef DMB_MATH_BLOCK_KERNELS_H
#define DMB_MATH_BLOCK_KERNELS_H

#include <math.h>

#include "math/block_pivot.h"
#include "math/block_tridiagonal.h"

#define MAX DMB_BLOCK_SIZE_MAX

/* The kernels must be folded for constant sizes even where the compiler finds them long. */
#if defined(__GNUC__)
#define KERNEL static inline __attribute__((always_inline))
#else
#define KERNEL static inline
#endif

/* Triangles are too irregular for gcc to unroll of its own accord. */
#if defined(__GNUC__) && !defined(__clang__)
#define UNROLL _Pragma("GCC unroll 6")
#else
#define UNROLL
#endif

/* One row of the work array: the row of D_i and behind it the row of U_i. */
typedef double work_row[2 * MAX];

/* kernel(n, m, ...) with constants for the two frequent pairs of neighbours */
#define BY_SIZE(kernel, n, m, ...)                      \
    ((n) == 6 && (m) == 6   ? kernel(6, 6, __VA_ARGS__) \
     : (n) == 2 && (m) == 2 ? kernel(2, 2, __VA_ARGS__) \
                            : kernel(n, m, __VA_ARGS__))

/* y[j] -= f x[j] */
KERNEL void row_subtract(int n, double f, const double *restrict x, double *restrict y)
{
    for (int j = 0; j < n; j++) y[j] -= f * x[j];
}

KERNEL void row_swap(int n, double *restrict x, double *restrict y)
{
    for (int j = 0; j < n; j++) {
        const double t = x[j];
        x[j] = y[j];
        y[j] = t;
    }
}

/* The rows of D_i and U_i side by side. */
KERNEL void gather(int n, int m, const double *restrict D, const double *restrict U, work_row *restrict a)
{
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) a[i][j] = D[n * i + j];
        for (int j = 0; j < m; j++) a[i][n + j] = U[m * i + j];
    }
}

KERNEL int pivot_of_column(int n, int k, work_row *a)
{
    int p = k;
    for (int i = k + 1; i < n; i++)
        if (fabs(a[i][k]) > fabs(a[p][k])) p = i;
    return p;
}

/* Gaussian elimination of the work rows. D receives the multipliers below its diagonal and the reciprocal pivots on
 * it. Work rows are subtracted in full length, a fixed one; the columns already done then hold nothing of use.
 * Returns the column without a pivot, or -1. */
KERNEL int eliminate(int n, int m, work_row *restrict a, double *restrict D, uint8_t *restrict pivot)
{
    for (int k = 0; k < n; k++) {
        const int p = pivot_of_column(n, k, a);
        if (!dmb_block_pivot_holds(a[p][k])) return k;
        pivot[k] = (uint8_t)p;
        if (p != k) {
            row_swap(n + m, a[k], a[p]);
            row_swap(n, D + n * k, D + n * p);
        }
        const double r = 1.0 / a[k][k];
        D[n * k + k] = r;
        for (int i = k + 1; i < n; i++) {
            const double f = a[i][k] * r;
            D[n * i + k] = f;
            row_subtract(n + m, f, a[k], a[i]);
        }
    }
    return -1;
}

/* The eliminated rows of D_i go above the diagonal of its factors. */
KERNEL void store_upper(int n, work_row *restrict a, double *restrict D)
{
    for (int i = 0; i < n; i++)
        for (int j = i + 1; j < n; j++) D[n * i + j] = a[i][j];
}

/* Back substitution on the eliminated rows of U_i: W_i = D_i^-1 U_i */
KERNEL void substitute_back(int n, int m, work_row *restrict a, const double *restrict D, double *restrict W)
{
    UNROLL
    for (int k = n - 1; k >= 0; k--) {
        double y[MAX];
        for (int j = 0; j < m; j++) y[j] = a[k][n + j]; /* NOLINT(clang-analyzer-core.uninitialized.Assign) */
        UNROLL
        for (int c = k + 1; c < n; c++) row_subtract(m, a[k][c], W + m * c, y);
        for (int j = 0; j < m; j++) W[m * k + j] = D[n * k + k] * y[j];
    }
}

/* D_{i+1} -= L_i W_i */
KERNEL void update_next(int n, int m, const double *restrict L, const double *restrict W, double *restrict next)
{
    for (int i = 0; i < m; i++) {
        double y[MAX];
        for (int j = 0; j < m; j++) y[j] = next[m * i + j];
        for (int c = 0; c < n; c++) row_subtract(m, L[n * i + c], W + m * c, y);
        for (int j = 0; j < m; j++) next[m * i + j] = y[j];
    }
}

/* Stored column by column from now on: the solver takes one column after another, which vectorises. */
KERNEL void turn_round(int rows, int columns, double *A)
{
    double turned[MAX * MAX];
    for (int j = 0; j < columns; j++)
        for (int i = 0; i < rows; i++) turned[rows * j + i] = A[columns * i + j];
    for (int i = 0; i < rows * columns; i++) A[i] = turned[i];
}

/* One block of the factorisation. Returns the column without a pivot, or -1. */
KERNEL int factor_block(int n, int m, double *restrict D, double *restrict U, double *restrict L,
                        double *restrict next, uint8_t *restrict pivot)
{
    work_row a[MAX];
    gather(n, m, D, U, a);
    const int failed = eliminate(n, m, a, D, pivot);
    if (failed >= 0) return failed;
    store_upper(n, a, D);
    substitute_back(n, m, a, D, U);
    update_next(n, m, L, U, next);
    turn_round(n, n, D);
    turn_round(n, m, U);
    turn_round(m, n, L);
    return -1;
}

/* The factorisation; weakest is NULL, a constant, where nobody watches. */
KERNEL int64_t factor_blocks(const dmb_block_layout *layout, dmb_block_matrix *matrix, uint32_t first, uint32_t count,
                      dmb_block_weakest *weakest)
{
    const uint32_t end = first + count;
    for (uint32_t i = first; i < end; i++) {
        const int n = layout->size[i], m = i + 1 < end ? layout->size[i + 1] : 0;
        double *D = matrix->diagonal + layout->diag[i], *next = matrix->diagonal + layout->diag[i + 1];
        double *U = matrix->upper + layout->link[i], *L = matrix->lower + layout->link[i];
        const double largest = weakest ? dmb_block_largest((size_t)n, D) : 0.0;
        const int failed = BY_SIZE(factor_block, n, m, D, U, L, next, matrix->pivot + layout->row[i]);
        if (weakest) dmb_block_watch((size_t)n, D, largest, failed, i, weakest);
        if (failed >= 0) return (int64_t)i;
    }
    return -1;
}

/* y -= A x, column after column */
KERNEL void subtract_product(int rows, int columns, const double *restrict A, const double *restrict x,
                             double *restrict y)
{
    double sum[MAX];
    for (int i = 0; i < rows; i++) sum[i] = y[i];
    for (int j = 0; j < columns; j++) row_subtract(rows, x[j], A + rows * j, sum);
    for (int i = 0; i < rows; i++) y[i] = sum[i];
}

/* b <- D_i^-1 b, then the next b -= L_i b */
KERNEL void solve_down(int n, int m, const double *restrict D, const uint8_t *restrict pivot, const double *restrict L,
                       double *restrict b, double *restrict next)
{
    double x[MAX];
    for (int k = 0; k < n; k++) {
        const double t = b[k];
        b[k] = b[pivot[k]];
        b[pivot[k]] = t;
    }
    for (int k = 0; k < n; k++) x[k] = b[k];
    UNROLL
    for (int k = 0; k < n; k++) {
        UNROLL
        for (int i = k + 1; i < n; i++) x[i] -= D[n * k + i] * x[k];
    }
    UNROLL
    for (int k = n - 1; k >= 0; k--) {
        x[k] *= D[n * k + k];
        UNROLL
        for (int i = 0; i < k; i++) x[i] -= D[n * k + i] * x[k];
    }
    for (int k = 0; k < n; k++) b[k] = x[k];
    subtract_product(m, n, L, x, next);
}

/* b -= W_i x_{i+1} */
KERNEL void solve_up(int n, int m, const double *restrict W, const double *restrict x, double *restrict b)
{
    subtract_product(n, m, W, x, b);
}

static inline void solve_blocks(const dmb_block_layout *layout, const dmb_block_matrix *matrix, uint32_t first,
                                uint32_t count, double *rhs)
{
    const uint32_t end = first + count, *row = layout->row;
    for (uint32_t i = first; i < end; i++) {
        const int n = layout->size[i], m = i + 1 < end ? layout->size[i + 1] : 0;
        const double *D = matrix->diagonal + layout->diag[i], *L = matrix->lower + layout->link[i];
        BY_SIZE(solve_down, n, m, D, matrix->pivot + row[i], L, rhs + row[i], rhs + row[i + 1]);
    }
    for (uint32_t i = end; i-- > first;) {
        if (i + 1 == end) continue;
        const int n = layout->size[i], m = layout->size[i + 1];
        BY_SIZE(solve_up, n, m, matrix->upper + layout->link[i], rhs + row[i + 1], rhs + row[i]);
    }
}

#endif
