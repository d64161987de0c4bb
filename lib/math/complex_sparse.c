/* The method of block_sparse.c for complex numbers: with D = A_kk and the later blocks i, j that k is coupled with,
 *
 *     W_kj = D^-1 A_kj,    A_ij -= A_ik W_kj,    b_k <- D^-1 b_k,  b_i -= A_ik b_k;   backwards  b_k -= W_kj b_j
 *
 * (Golub and Van Loan, Matrix Computations, 3.2.10). Kernels are written once, with the sizes of beams' nodes
 * as constants and for any size. Inner loops run along rows of doubles. */
#include "math/complex_sparse.h"

#include <math.h>
#include <string.h>

#include "math/block_kernel.h"

enum { SIX = 6 };

static dmb_complex_array part(dmb_complex_array array, size_t offset)
{
    const dmb_complex_array out = {array.re + offset, array.im + offset};
    return out;
}

/* y -= (fr + i fi) x */
DMB_BLOCK_KERNEL void row_subtract(size_t n, double fr, double fi, dmb_complex_array x, dmb_complex_array y)
{
    const double *restrict xr = x.re, *restrict xi = x.im;
    double *restrict yr = y.re, *restrict yi = y.im;
    for (size_t j = 0; j < n; j++) yr[j] -= fr * xr[j] - fi * xi[j];
    for (size_t j = 0; j < n; j++) yi[j] -= fr * xi[j] + fi * xr[j];
}

/* x *= fr + i fi */
DMB_BLOCK_KERNEL void row_scale(size_t n, double fr, double fi, double *restrict xr, double *restrict xi)
{
    for (size_t j = 0; j < n; j++) {
        const double re = xr[j], im = xi[j];
        xr[j] = fr * re - fi * im;
        xi[j] = fr * im + fi * re;
    }
}

/* ---- Blocks ------------------------------------------------------------------------------------------------------ */

DMB_BLOCK_KERNEL size_t pivot_of_column(size_t n, size_t k, dmb_complex_array D)
{
    size_t p = k;
    double most = fabs(D.re[n * k + k]) + fabs(D.im[n * k + k]);
    for (size_t i = k + 1; i < n; i++) {
        const double size = fabs(D.re[n * i + k]) + fabs(D.im[n * i + k]);
        if (size > most) most = size, p = i;
    }
    return p;
}

/* Computes 1/(a + i b) in place (Smith 1962). */
static void invert(double *re, double *im)
{
    const double a = *re, b = *im;
    if (fabs(a) >= fabs(b)) {
        const double q = b / a, d = a + b * q;
        *re = 1.0 / d;
        *im = -q / d;
    } else {
        const double q = a / b, d = a * q + b;
        *re = q / d;
        *im = -1.0 / d;
    }
}

/* Factors a block. Returns the column without a pivot, or -1. */
DMB_BLOCK_KERNEL int64_t factor_sized(size_t n, dmb_complex_array D, uint32_t *pivot)
{
    for (size_t k = 0; k < n; k++) {
        const size_t p = pivot_of_column(n, k, D), at = n * k + k;
        if (!dmb_block_pivot_holds(fabs(D.re[n * p + k]) + fabs(D.im[n * p + k]))) return (int64_t)k;
        pivot[k] = (uint32_t)p;
        if (p != k) {
            dmb_block_swap(n, D.re + n * k, D.re + n * p);
            dmb_block_swap(n, D.im + n * k, D.im + n * p);
        }
        invert(D.re + at, D.im + at);
        for (size_t i = k + 1; i < n; i++) {
            const size_t below = n * i + k;
            row_scale(1, D.re[at], D.im[at], D.re + below, D.im + below);
            row_subtract(n - k - 1, D.re[below], D.im[below], part(D, at + 1), part(D, below + 1));
        }
    }
    return -1;
}

static int64_t factor_block(size_t n, dmb_complex_array D, uint32_t *pivot)
{
    return n == SIX ? factor_sized(SIX, D, pivot) : factor_sized(n, D, pivot);
}

/* W (n x m) <- D^-1 W */
DMB_BLOCK_KERNEL void solve_sized(size_t n, size_t m, dmb_complex_array D, const uint32_t *pivot, dmb_complex_array W)
{
    for (size_t k = 0; k < n; k++) {
        if (pivot[k] == k) continue;
        dmb_block_swap(m, W.re + m * k, W.re + m * pivot[k]);
        dmb_block_swap(m, W.im + m * k, W.im + m * pivot[k]);
    }
    for (size_t i = 1; i < n; i++)
        for (size_t j = 0; j < i; j++)
            row_subtract(m, D.re[n * i + j], D.im[n * i + j], part(W, m * j), part(W, m * i));
    for (size_t i = n; i-- > 0;) {
        for (size_t j = i + 1; j < n; j++)
            row_subtract(m, D.re[n * i + j], D.im[n * i + j], part(W, m * j), part(W, m * i));
        row_scale(m, D.re[n * i + i], D.im[n * i + i], W.re + m * i, W.im + m * i);
    }
}

static void solve_block(size_t n, size_t m, dmb_complex_array D, const uint32_t *pivot, dmb_complex_array W)
{
    if (n == SIX && m == SIX)
        solve_sized(SIX, SIX, D, pivot, W);
    else
        solve_sized(n, m, D, pivot, W);
}

/* A (p x q) -= L (p x n) W (n x q) */
DMB_BLOCK_KERNEL void update_sized(size_t p, size_t n, size_t q, dmb_complex_array L, dmb_complex_array W,
                                   dmb_complex_array A)
{
    for (size_t i = 0; i < p; i++)
        for (size_t c = 0; c < n; c++)
            row_subtract(q, L.re[n * i + c], L.im[n * i + c], part(W, q * c), part(A, q * i));
}

static void update_block(size_t p, size_t n, size_t q, dmb_complex_array L, dmb_complex_array W, dmb_complex_array A)
{
    if (p == SIX && n == SIX && q == SIX)
        update_sized(SIX, SIX, SIX, L, W, A);
    else
        update_sized(p, n, q, L, W, A);
}

/* y (p) -= A (p x n) x (n) */
static void update_vector(size_t p, size_t n, dmb_complex_array A, dmb_complex_array x, dmb_complex_array y)
{
    for (size_t i = 0; i < p; i++) {
        double re = y.re[i], im = y.im[i];
        for (size_t j = 0; j < n; j++) {
            const double ar = A.re[n * i + j], ai = A.im[n * i + j];
            re -= ar * x.re[j] - ai * x.im[j];
            im -= ar * x.im[j] + ai * x.re[j];
        }
        y.re[i] = re;
        y.im[i] = im;
    }
}

/* ---- Factors ----------------------------------------------------------------------------------------------------- */

/* Rows at run time of the block at a position. */
static uint32_t size_at(const dmb_block_pattern *pattern, const dmb_complex_sparse *matrix, uint32_t position)
{
    return matrix->size[pattern->order[position]];
}

/* A_ij -= A_ik W_kj for the later blocks i of entry a, and j of entry a and of each later entry, in both orders. */
static void update_from(const dmb_block_pattern *pattern, const dmb_complex_sparse *matrix, uint32_t n, uint32_t a,
                        uint32_t end)
{
    const dmb_complex_array v = matrix->values, L = part(v, pattern->lower[a]), W = part(v, pattern->upper[a]);
    const uint32_t i = pattern->later[a], p = size_at(pattern, matrix, i);
    update_block(p, n, p, L, W, part(v, pattern->diagonal[i]));
    for (uint32_t b = a + 1; b < end; b++) {
        const uint32_t j = pattern->later[b], q = size_at(pattern, matrix, j);
        const uint32_t target = dmb_block_pattern_entry(pattern, i, j);
        update_block(p, n, q, L, part(v, pattern->upper[b]), part(v, pattern->upper[target]));
        update_block(q, n, p, part(v, pattern->lower[b]), W, part(v, pattern->lower[target]));
    }
}

int64_t dmb_complex_sparse_factor(const dmb_block_pattern *pattern, const dmb_complex_sparse *matrix)
{
    for (uint32_t k = 0; k < pattern->n; k++) {
        const uint32_t n = size_at(pattern, matrix, k), begin = pattern->column[k], end = pattern->column[k + 1];
        const dmb_complex_array D = part(matrix->values, pattern->diagonal[k]);
        uint32_t *pivot = matrix->pivot + pattern->pivot[k];
        if (n == 0) continue;
        if (factor_block(n, D, pivot) >= 0) return (int64_t)pattern->order[k];
        for (uint32_t e = begin; e < end; e++) {
            const uint32_t m = size_at(pattern, matrix, pattern->later[e]);
            const dmb_complex_array W = part(matrix->values, pattern->upper[e]);
            solve_block(n, m, D, pivot, W);
        }
        for (uint32_t e = begin; e < end; e++) update_from(pattern, matrix, n, e, end);
    }
    return -1;
}

/* ---- Solution ---------------------------------------------------------------------------------------------------- */

/* b_k <- D^-1 b_k, then b_i -= A_ik b_k */
static void solve_down(const dmb_block_pattern *pattern, const dmb_complex_sparse *matrix, const uint32_t *row,
                       uint32_t k, dmb_complex_array rhs)
{
    const uint32_t block = pattern->order[k], n = matrix->size[block];
    const dmb_complex_array b = part(rhs, row[block]);
    solve_block(n, 1, part(matrix->values, pattern->diagonal[k]), matrix->pivot + pattern->pivot[k], b);
    for (uint32_t e = pattern->column[k]; e < pattern->column[k + 1]; e++) {
        const uint32_t other = pattern->order[pattern->later[e]];
        const dmb_complex_array A = part(matrix->values, pattern->lower[e]);
        update_vector(matrix->size[other], n, A, b, part(rhs, row[other]));
    }
}

/* b_k -= W_kj x_j */
static void solve_up(const dmb_block_pattern *pattern, const dmb_complex_sparse *matrix, const uint32_t *row,
                     uint32_t k, dmb_complex_array rhs)
{
    const uint32_t block = pattern->order[k], n = matrix->size[block];
    for (uint32_t e = pattern->column[k]; e < pattern->column[k + 1]; e++) {
        const uint32_t other = pattern->order[pattern->later[e]];
        const dmb_complex_array W = part(matrix->values, pattern->upper[e]);
        update_vector(n, matrix->size[other], W, part(rhs, row[other]), part(rhs, row[block]));
    }
}

void dmb_complex_sparse_solve(const dmb_block_pattern *pattern, const dmb_complex_sparse *matrix, const uint32_t *row,
                              dmb_complex_array rhs)
{
    for (uint32_t k = 0; k < pattern->n; k++) solve_down(pattern, matrix, row, k, rhs);
    for (uint32_t k = pattern->n; k-- > 0;) solve_up(pattern, matrix, row, k, rhs);
}

/* ---- Chains ------------------------------------------------------------------------------------------------------ */

/* Chains: the same elimination from block to block, of which each has one later neighbour. */
int64_t dmb_complex_block_factor(const dmb_block_layout *layout, const dmb_complex_block_matrix *matrix, uint32_t first,
                                 uint32_t count)
{
    const uint32_t end = first + count;
    for (uint32_t i = first; i < end; i++) {
        const size_t n = layout->size[i];
        const dmb_complex_array D = part(matrix->diagonal, layout->diag[i]), U = part(matrix->upper, layout->link[i]);
        uint32_t *pivot = matrix->pivot + layout->row[i];
        if (factor_block(n, D, pivot) >= 0) return (int64_t)i;
        if (i + 1 == end) continue;
        const size_t m = layout->size[i + 1];
        solve_block(n, m, D, pivot, U);
        update_block(m, n, m, part(matrix->lower, layout->link[i]), U, part(matrix->diagonal, layout->diag[i + 1]));
    }
    return -1;
}

void dmb_complex_block_solve(const dmb_block_layout *layout, const dmb_complex_block_matrix *matrix, uint32_t first,
                             uint32_t count, dmb_complex_array rhs)
{
    const uint32_t end = first + count;
    for (uint32_t i = first; i < end; i++) {
        const size_t n = layout->size[i];
        const dmb_complex_array b = part(rhs, layout->row[i]);
        solve_block(n, 1, part(matrix->diagonal, layout->diag[i]), matrix->pivot + layout->row[i], b);
        if (i + 1 < end)
            update_vector(layout->size[i + 1], n, part(matrix->lower, layout->link[i]), b,
                          part(rhs, layout->row[i + 1]));
    }
    for (uint32_t i = end; i-- > first;)
        if (i + 1 < end)
            update_vector(layout->size[i], layout->size[i + 1], part(matrix->upper, layout->link[i]),
                          part(rhs, layout->row[i + 1]), part(rhs, layout->row[i]));
}
