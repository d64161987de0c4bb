/* What block eliminations share: rows and columns of blocks. Each kernel is written once with the sizes n (this block)
 * and m (the next, 0 at the end of a chain) as arguments. BY_SIZE passes constants for 6-6 and 2-2, so the compiler
 * makes kernels of fixed size; other pairs take the same source with sizes from memory. Inner loops run along rows or
 * columns, so they vectorise without any change in the order of a sum: every width gives the same bits. */
#ifndef DMB_MATH_BLOCK_ROWS_H
#define DMB_MATH_BLOCK_ROWS_H

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

KERNEL int pivot_of_column(int n, int k, work_row *a)
{
    int p = k;
    for (int i = k + 1; i < n; i++)
        if (fabs(a[i][k]) > fabs(a[p][k])) p = i;
    return p;
}

/* To columns: the solver takes one after another, which vectorises. */
KERNEL void turn_round(int rows, int columns, const double *restrict A, double *restrict turned)
{
    for (int j = 0; j < columns; j++)
        for (int i = 0; i < rows; i++) turned[rows * j + i] = A[columns * i + j];
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

/* b -= W_i x_{i+1} */
KERNEL void solve_up(int n, int m, const double *restrict W, const double *restrict x, double *restrict b)
{
    subtract_product(n, m, W, x, b);
}

#endif
