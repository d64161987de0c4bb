/* Block elimination with the inverse X_i of each eliminated block: G_i = L_i X_i, D_{i+1} -= G_i U_i, W_i = X_i U_i. A
 * solution takes one product a block down the chain and one up; with LU factors two triangles lie on the way besides.
 * Where a block's stiffnesses lie 15 decades apart an inverse loses the soft ones, which LU factors keep; so this is
 * for steps, whose Newton iterations look at the residual again, and block_tridiagonal for statics.
 *
 * For the files that compile it in one width each, kernel/lanes.h. Functions as dmb_block_factor and dmb_block_solve;
 * factors are X in `diagonal`, W in `upper`, G in `lower`, column-major. */
#ifndef DMB_MATH_BLOCK_INVERSE_H
#define DMB_MATH_BLOCK_INVERSE_H

#include "math/block_rows.h"

/* The rows of D_i and of the identity side by side. */
DMB_BLOCK_KERNEL void gather(int n, const double *restrict D, work_row *restrict a)
{
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) a[i][j] = D[n * i + j];
        for (int j = 0; j < n; j++) a[i][n + j] = i == j ? 1.0 : 0.0;
    }
}

/* Gaussian elimination of the work rows; pivots come back as reciprocals. Rows are subtracted in full length, a fixed
 * one; the columns already done then hold nothing of use. Returns the column without a pivot, or -1. */
DMB_BLOCK_KERNEL int eliminate(int n, work_row *restrict a, double *restrict reciprocal)
{
    for (int k = 0; k < n; k++) {
        const int p = pivot_of_column(n, k, a);
        if (!dmb_block_pivot_holds(a[p][k])) return k;
        if (p != k) dmb_block_swap(2 * (size_t)n, a[k], a[p]);
        reciprocal[k] = 1.0 / a[k][k];
        for (int i = k + 1; i < n; i++) row_subtract(2 * n, a[i][k] * reciprocal[k], a[k], a[i]);
    }
    return -1;
}

/* Back substitution on the right half of the eliminated rows: X = D_i^-1 */
DMB_BLOCK_KERNEL void substitute_back(int n, work_row *restrict a, const double *restrict reciprocal,
                                      double *restrict X)
{
    DMB_BLOCK_UNROLL
    for (int k = n - 1; k >= 0; k--) {
        double y[DMB_BLOCK_SIZE_MAX];
        for (int j = 0; j < n; j++) y[j] = a[k][n + j]; /* NOLINT(clang-analyzer-core.uninitialized.Assign) */
        DMB_BLOCK_UNROLL
        for (int c = k + 1; c < n; c++) row_subtract(n, a[k][c], X + n * c, y);
        for (int j = 0; j < n; j++) X[n * k + j] = reciprocal[k] * y[j];
    }
}

/* C = A B */
DMB_BLOCK_KERNEL void multiply(int rows, int inner, int columns, const double *restrict A, const double *restrict B,
                               double *restrict C)
{
    for (int i = 0; i < rows; i++) {
        double y[DMB_BLOCK_SIZE_MAX];
        for (int j = 0; j < columns; j++) y[j] = A[inner * i] * B[j];
        for (int k = 1; k < inner; k++)
            for (int j = 0; j < columns; j++) y[j] += A[inner * i + k] * B[columns * k + j];
        for (int j = 0; j < columns; j++) C[columns * i + j] = y[j];
    }
}

/* C -= A B */
DMB_BLOCK_KERNEL void multiply_off(int rows, int inner, int columns, const double *restrict A, const double *restrict B,
                                   double *restrict C)
{
    for (int i = 0; i < rows; i++) {
        double y[DMB_BLOCK_SIZE_MAX];
        for (int j = 0; j < columns; j++) y[j] = C[columns * i + j];
        for (int k = 0; k < inner; k++) row_subtract(columns, A[inner * i + k], B + columns * k, y);
        for (int j = 0; j < columns; j++) C[columns * i + j] = y[j];
    }
}

/* One block of the factorisation. Returns the column without a pivot, or -1. */
DMB_BLOCK_KERNEL int factor_block(int n, int m, double *restrict D, double *restrict U, double *restrict L,
                                  double *restrict next)
{
    work_row a[DMB_BLOCK_SIZE_MAX];
    double reciprocal[DMB_BLOCK_SIZE_MAX], X[DMB_BLOCK_SIZE_MAX * DMB_BLOCK_SIZE_MAX],
        G[DMB_BLOCK_SIZE_MAX * DMB_BLOCK_SIZE_MAX], W[DMB_BLOCK_SIZE_MAX * DMB_BLOCK_SIZE_MAX];
    gather(n, D, a);
    const int failed = eliminate(n, a, reciprocal);
    if (failed >= 0) return failed;
    substitute_back(n, a, reciprocal, X);
    turn_round(n, n, X, D);
    if (m == 0) return -1;
    multiply(m, n, n, L, X, G);
    multiply_off(m, n, m, G, U, next);
    multiply(n, n, m, X, U, W);
    turn_round(m, n, G, L);
    turn_round(n, m, W, U);
    return -1;
}

static inline int64_t factor_blocks(const dmb_block_layout *layout, dmb_block_matrix *matrix, uint32_t first,
                                    uint32_t count)
{
    const uint32_t end = first + count;
    for (uint32_t i = first; i < end; i++) {
        const int n = layout->size[i], m = i + 1 < end ? layout->size[i + 1] : 0;
        double *D = matrix->diagonal + layout->diag[i], *next = matrix->diagonal + layout->diag[i + 1];
        double *U = matrix->upper + layout->link[i], *L = matrix->lower + layout->link[i];
        if (DMB_BLOCK_BY_SIZE(factor_block, n, m, D, U, L, next) >= 0) return (int64_t)i;
    }
    return -1;
}

/* The next b -= G_i b, then b <- X_i b: only the first is on the way down the chain. */
DMB_BLOCK_KERNEL void solve_down(int n, int m, const double *restrict X, const double *restrict G, double *restrict b,
                                 double *restrict next)
{
    double y[DMB_BLOCK_SIZE_MAX] = {0.0};
    subtract_product(m, n, G, b, next);
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) y[i] += b[j] * X[n * j + i];
    for (int i = 0; i < n; i++) b[i] = y[i];
}

/* A chain whose blocks all have n rows: they follow one another, and what goes down or up it stays in registers. */
DMB_BLOCK_KERNEL void solve_even(int n, uint32_t count, const double *restrict X, const double *restrict G,
                                 const double *restrict W, double *restrict b)
{
    const size_t block = (size_t)n * (size_t)n;
    double x[DMB_BLOCK_SIZE_MAX], next[DMB_BLOCK_SIZE_MAX] = {0.0};
    for (int i = 0; i < n; i++) x[i] = b[i];
    for (uint32_t k = 0; k < count; k++) {
        double y[DMB_BLOCK_SIZE_MAX] = {0.0};
        if (k + 1 < count) {
            for (int i = 0; i < n; i++) next[i] = b[n + i];
            for (int j = 0; j < n; j++) row_subtract(n, x[j], G + block * k + n * j, next);
        }
        for (int j = 0; j < n; j++)
            for (int i = 0; i < n; i++) y[i] += x[j] * X[block * k + (size_t)(n * j + i)];
        for (int i = 0; i < n; i++) b[i] = y[i];
        for (int i = 0; i < n; i++) x[i] = next[i];
        b += n;
    }
    b -= n;
    for (int i = 0; i < n; i++) x[i] = b[i];
    for (uint32_t k = count - 1; k-- > 0;) {
        b -= n;
        for (int i = 0; i < n; i++) next[i] = b[i];
        for (int j = 0; j < n; j++) row_subtract(n, x[j], W + block * k + n * j, next);
        for (int i = 0; i < n; i++) b[i] = x[i] = next[i];
    }
}

/* Rows of every block of a range if they all have as many, else 0: the mean of the squares is the square of the mean
 * for equal numbers only. */
static inline int even_size(const dmb_block_layout *layout, uint32_t first, uint32_t count)
{
    const uint32_t n = layout->size[first], end = first + count;
    const int even =
        layout->row[end] - layout->row[first] == n * count && layout->diag[end] - layout->diag[first] == n * n * count;
    return even ? (int)n : 0;
}

static inline void solve_blocks(const dmb_block_layout *layout, const dmb_block_matrix *matrix, uint32_t first,
                                uint32_t count, double *rhs)
{
    const uint32_t end = first + count, *row = layout->row;
    const double *D0 = matrix->diagonal + layout->diag[first], *L0 = matrix->lower + layout->link[first];
    const double *U0 = matrix->upper + layout->link[first];
    const int even = even_size(layout, first, count);
    if (even == 6) {
        solve_even(6, count, D0, L0, U0, rhs + row[first]);
        return;
    }
    if (even == 2) {
        solve_even(2, count, D0, L0, U0, rhs + row[first]);
        return;
    }
    for (uint32_t i = first; i < end; i++) {
        const int n = layout->size[i], m = i + 1 < end ? layout->size[i + 1] : 0;
        const double *D = matrix->diagonal + layout->diag[i], *L = matrix->lower + layout->link[i];
        DMB_BLOCK_BY_SIZE(solve_down, n, m, D, L, rhs + row[i], rhs + row[i + 1]);
    }
    for (uint32_t i = end; i-- > first;) {
        if (i + 1 == end) continue;
        const int n = layout->size[i], m = layout->size[i + 1];
        DMB_BLOCK_BY_SIZE(solve_up, n, m, matrix->upper + layout->link[i], rhs + row[i + 1], rhs + row[i]);
    }
}

#endif
