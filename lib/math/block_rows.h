/* Common operations of block eliminations on rows and columns of blocks, in kernels of block_kernel.h. Inner loops run
 * along rows or columns, so that they vectorise without a change in the order of a sum: results are bitwise equal for
 * every width. */
#ifndef DMB_MATH_BLOCK_ROWS_H
#define DMB_MATH_BLOCK_ROWS_H

#include <math.h>

#include "math/block_kernel.h"
#include "math/block_tridiagonal.h"

/* One row of the work array: the row of D_i followed by the row of U_i. */
typedef double work_row[2 * DMB_BLOCK_SIZE_MAX];

/* y[j] -= f x[j] */
DMB_BLOCK_KERNEL void row_subtract(int n, double f, const double *restrict x, double *restrict y)
{
    for (int j = 0; j < n; j++) y[j] -= f * x[j];
}

DMB_BLOCK_KERNEL int pivot_of_column(int n, int k, work_row *a)
{
    int p = k;
    for (int i = k + 1; i < n; i++)
        if (fabs(a[i][k]) > fabs(a[p][k])) p = i;
    return p;
}

/* Transposes to column-major order: the solver processes one column after another, which vectorises. */
DMB_BLOCK_KERNEL void turn_round(int rows, int columns, const double *restrict A, double *restrict turned)
{
    for (int j = 0; j < columns; j++)
        for (int i = 0; i < rows; i++) turned[rows * j + i] = A[columns * i + j];
}

/* y -= A x, one column after another */
DMB_BLOCK_KERNEL void subtract_product(int rows, int columns, const double *restrict A, const double *restrict x,
                                       double *restrict y)
{
    double sum[DMB_BLOCK_SIZE_MAX];
    for (int i = 0; i < rows; i++) sum[i] = y[i];
    for (int j = 0; j < columns; j++) row_subtract(rows, x[j], A + rows * j, sum);
    for (int i = 0; i < rows; i++) y[i] = sum[i];
}

/* b -= W_i x_{i+1} */
DMB_BLOCK_KERNEL void solve_up(int n, int m, const double *restrict W, const double *restrict x, double *restrict b)
{
    subtract_product(n, m, W, x, b);
}

#endif
