/* Block elimination down the chain, W_i = D_i^-1 U_i, D_{i+1} -= L_i W_i (block Thomas algorithm; Golub and Van Loan,
 * Matrix Computations, 4.5.1), in complex numbers. Kernels as in block_tridiagonal.c (block_kernel.h). */
#include "math/block_complex.h"

#include <math.h>

#include "math/block_kernel.h"

/* The row of D_i and behind it the row of U_i. */
typedef struct work_row {
    double re[2 * DMB_BLOCK_SIZE_MAX], im[2 * DMB_BLOCK_SIZE_MAX];
} work_row;

typedef struct complex_number {
    double re, im;
} complex_number;

static dmb_complex_array part(dmb_complex_array array, uint32_t offset)
{
    const dmb_complex_array out = {array.re + offset, array.im + offset};
    return out;
}

/* The magnitude LAPACK pivots by. */
DMB_BLOCK_KERNEL double magnitude(double re, double im)
{
    return fabs(re) + fabs(im);
}

/* 1/(a + ib) without overflow of squares (Smith 1962). */
DMB_BLOCK_KERNEL complex_number reciprocal(double a, double b)
{
    complex_number out;
    if (fabs(a) >= fabs(b)) {
        const double q = b / a, d = a + b * q;
        out.re = 1.0 / d;
        out.im = -q / d;
    } else {
        const double q = a / b, d = a * q + b;
        out.re = q / d;
        out.im = -1.0 / d;
    }
    return out;
}

/* y[j] -= f x[j] */
DMB_BLOCK_KERNEL void row_subtract(int n, complex_number f, const double *restrict xr, const double *restrict xi,
                                   double *restrict yr, double *restrict yi)
{
    const double fr = f.re, fi = f.im;
    for (int j = 0; j < n; j++) yr[j] -= fr * xr[j] - fi * xi[j];
    for (int j = 0; j < n; j++) yi[j] -= fr * xi[j] + fi * xr[j];
}

DMB_BLOCK_KERNEL void gather(int n, int m, dmb_complex_array D, dmb_complex_array U, work_row *restrict a)
{
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) a[i].re[j] = D.re[n * i + j], a[i].im[j] = D.im[n * i + j];
        for (int j = 0; j < m; j++) a[i].re[n + j] = U.re[m * i + j], a[i].im[n + j] = U.im[m * i + j];
    }
}

DMB_BLOCK_KERNEL int pivot_of_column(int n, int k, const work_row *a)
{
    int p = k;
    for (int i = k + 1; i < n; i++)
        if (magnitude(a[i].re[k], a[i].im[k]) > magnitude(a[p].re[k], a[p].im[k])) p = i;
    return p;
}

DMB_BLOCK_KERNEL void exchange(int n, int m, int k, int p, work_row *restrict a, dmb_complex_array D)
{
    dmb_block_swap((size_t)n + (size_t)m, a[k].re, a[p].re);
    dmb_block_swap((size_t)n + (size_t)m, a[k].im, a[p].im);
    dmb_block_swap((size_t)n, D.re + n * k, D.re + n * p);
    dmb_block_swap((size_t)n, D.im + n * k, D.im + n * p);
}

/* Gaussian elimination of the work rows. D receives the multipliers below its diagonal and the reciprocal pivots on it.
 * Returns the column without a pivot, or -1. */
DMB_BLOCK_KERNEL int eliminate(int n, int m, work_row *restrict a, dmb_complex_array D, uint8_t *restrict pivot)
{
    for (int k = 0; k < n; k++) {
        const int p = pivot_of_column(n, k, a);
        if (!dmb_block_pivot_holds(magnitude(a[p].re[k], a[p].im[k]))) return k;
        pivot[k] = (uint8_t)p;
        if (p != k) exchange(n, m, k, p, a, D);
        const complex_number r = reciprocal(a[k].re[k], a[k].im[k]);
        D.re[n * k + k] = r.re;
        D.im[n * k + k] = r.im;
        for (int i = k + 1; i < n; i++) {
            const complex_number f = {a[i].re[k] * r.re - a[i].im[k] * r.im, a[i].re[k] * r.im + a[i].im[k] * r.re};
            D.re[n * i + k] = f.re;
            D.im[n * i + k] = f.im;
            row_subtract(n + m, f, a[k].re, a[k].im, a[i].re, a[i].im);
        }
    }
    return -1;
}

DMB_BLOCK_KERNEL void store_upper(int n, const work_row *restrict a, dmb_complex_array D)
{
    for (int i = 0; i < n; i++)
        for (int j = i + 1; j < n; j++) D.re[n * i + j] = a[i].re[j], D.im[n * i + j] = a[i].im[j];
}

/* Back substitution on the eliminated rows of U_i: W_i = D_i^-1 U_i */
DMB_BLOCK_KERNEL void substitute_back(int n, int m, const work_row *restrict a, dmb_complex_array D,
                                      dmb_complex_array W)
{
    for (int k = n - 1; k >= 0; k--) {
        double yr[DMB_BLOCK_SIZE_MAX], yi[DMB_BLOCK_SIZE_MAX];
        const double dr = D.re[n * k + k], di = D.im[n * k + k];
        for (int j = 0; j < m; j++) yr[j] = a[k].re[n + j], yi[j] = a[k].im[n + j];
        for (int c = k + 1; c < n; c++)
            row_subtract(m, (complex_number){a[k].re[c], a[k].im[c]}, W.re + m * c, W.im + m * c, yr, yi);
        for (int j = 0; j < m; j++) {
            W.re[m * k + j] = dr * yr[j] - di * yi[j];
            W.im[m * k + j] = dr * yi[j] + di * yr[j];
        }
    }
}

/* D_{i+1} -= L_i W_i */
DMB_BLOCK_KERNEL void update_next(int n, int m, dmb_complex_array L, dmb_complex_array W, dmb_complex_array next)
{
    for (int i = 0; i < m; i++) {
        double yr[DMB_BLOCK_SIZE_MAX], yi[DMB_BLOCK_SIZE_MAX];
        for (int j = 0; j < m; j++) yr[j] = next.re[m * i + j], yi[j] = next.im[m * i + j];
        for (int c = 0; c < n; c++)
            row_subtract(m, (complex_number){L.re[n * i + c], L.im[n * i + c]}, W.re + m * c, W.im + m * c, yr, yi);
        for (int j = 0; j < m; j++) next.re[m * i + j] = yr[j], next.im[m * i + j] = yi[j];
    }
}

/* A block row: D_i, U_i, L_i, D_i+1, and the pivots of D_i. */
typedef struct block_row {
    dmb_complex_array D, U, L, next;
    uint8_t *pivot;
} block_row;

static block_row row_of(const dmb_block_layout *layout, const dmb_complex_block_matrix *matrix, uint32_t i)
{
    const block_row row = {.D = part(matrix->diagonal, layout->diag[i]),
                           .U = part(matrix->upper, layout->link[i]),
                           .L = part(matrix->lower, layout->link[i]),
                           .next = part(matrix->diagonal, layout->diag[i + 1]),
                           .pivot = matrix->pivot + layout->row[i]};
    return row;
}

/* One block of the factorisation. Returns the column without a pivot, or -1. */
DMB_BLOCK_KERNEL int factor_block(int n, int m, const block_row *row)
{
    work_row a[DMB_BLOCK_SIZE_MAX];
    gather(n, m, row->D, row->U, a);
    const int failed = eliminate(n, m, a, row->D, row->pivot);
    if (failed >= 0) return failed;
    store_upper(n, a, row->D);
    substitute_back(n, m, a, row->D, row->U);
    update_next(n, m, row->L, row->U, row->next);
    return -1;
}

int64_t dmb_complex_block_factor(const dmb_block_layout *layout, const dmb_complex_block_matrix *matrix, uint32_t first,
                                 uint32_t count)
{
    const uint32_t end = first + count;
    for (uint32_t i = first; i < end; i++) {
        const int n = layout->size[i], m = i + 1 < end ? layout->size[i + 1] : 0;
        const block_row row = row_of(layout, matrix, i);
        if (DMB_BLOCK_BY_SIZE(factor_block, n, m, &row) >= 0) return (int64_t)i;
    }
    return -1;
}

/* y_i -= sum_j A_ij x_j */
DMB_BLOCK_KERNEL void subtract_product(int rows, int columns, dmb_complex_array A, dmb_complex_array x,
                                       dmb_complex_array y)
{
    for (int i = 0; i < rows; i++) {
        double re = y.re[i], im = y.im[i];
        for (int j = 0; j < columns; j++) {
            const double ar = A.re[columns * i + j], ai = A.im[columns * i + j];
            re -= ar * x.re[j] - ai * x.im[j];
            im -= ar * x.im[j] + ai * x.re[j];
        }
        y.re[i] = re;
        y.im[i] = im;
    }
}

DMB_BLOCK_KERNEL void exchange_rows(int n, const uint8_t *restrict pivot, double *restrict b)
{
    for (int k = 0; k < n; k++) {
        const double t = b[k];
        b[k] = b[pivot[k]];
        b[pivot[k]] = t;
    }
}

/* b_i -= D_ij b_j */
DMB_BLOCK_KERNEL void subtract_term(int n, int i, int j, dmb_complex_array D, dmb_complex_array b)
{
    const double dr = D.re[n * i + j], di = D.im[n * i + j];
    b.re[i] -= dr * b.re[j] - di * b.im[j];
    b.im[i] -= dr * b.im[j] + di * b.re[j];
}

/* b <- D_i^-1 b, then the next b -= L_i b */
DMB_BLOCK_KERNEL void solve_down(int n, int m, const block_row *row, dmb_complex_array b, dmb_complex_array next)
{
    const dmb_complex_array D = row->D;
    exchange_rows(n, row->pivot, b.re);
    exchange_rows(n, row->pivot, b.im);
    for (int i = 1; i < n; i++)
        for (int j = 0; j < i; j++) subtract_term(n, i, j, D, b);
    for (int i = n - 1; i >= 0; i--) {
        for (int j = n - 1; j > i; j--) subtract_term(n, i, j, D, b);
        const double dr = D.re[n * i + i], di = D.im[n * i + i], re = b.re[i], im = b.im[i];
        b.re[i] = dr * re - di * im;
        b.im[i] = dr * im + di * re;
    }
    subtract_product(m, n, row->L, b, next);
}

void dmb_complex_block_solve(const dmb_block_layout *layout, const dmb_complex_block_matrix *matrix, uint32_t first,
                             uint32_t count, dmb_complex_array rhs)
{
    const uint32_t end = first + count, *row = layout->row;
    for (uint32_t i = first; i < end; i++) {
        const int n = layout->size[i], m = i + 1 < end ? layout->size[i + 1] : 0;
        const block_row at = row_of(layout, matrix, i);
        DMB_BLOCK_BY_SIZE(solve_down, n, m, &at, part(rhs, row[i]), part(rhs, row[i + 1]));
    }
    for (uint32_t i = end; i-- > first;) {
        if (i + 1 == end) continue;
        const int n = layout->size[i], m = layout->size[i + 1];
        const dmb_complex_array W = part(matrix->upper, layout->link[i]);
        DMB_BLOCK_BY_SIZE(subtract_product, n, m, W, part(rhs, row[i + 1]), part(rhs, row[i]));
    }
}
