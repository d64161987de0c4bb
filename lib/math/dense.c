/* LU by panels of columns (Golub and Van Loan, Matrix Computations, 3.2.11): with the rows and columns of a panel
 * first,
 *
 *     | A11 A12 |   | L11    | | U11 U12 |      factor the panel | A11; A21 |,  U12 = L11^-1 A12,
 *     | A21 A22 | = | L21  I | |     A'22 |      A'22 = A22 - L21 U12,  continue with A'22
 *
 * and the two substitutions by panels too. All operations outside the panels are in one loop, subtract_product. */
#include "math/dense.h"

#include <stddef.h>
#include <string.h>

#include "math/block_kernel.h"

/* Columns of a panel: 32 rows of 600 columns are 150 kB, which fits a second-level cache. */
#define DMB_PANEL 32

static size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* y -= f0 x0 + f1 x1 + f2 x2 + f3 x3, one term after another; x0.. are rows of X, stride apart. Four rows together read
 * and write y once instead of four times. */
static inline void subtract_four(size_t n, const double *f, const double *restrict X, size_t stride, double *restrict y)
{
    const double *x0 = X, *x1 = x0 + stride, *x2 = x1 + stride, *x3 = x2 + stride;
    const double f0 = f[0], f1 = f[1], f2 = f[2], f3 = f[3];
    for (size_t j = 0; j < n; j++) y[j] = (((y[j] - f0 * x0[j]) - f1 * x1[j]) - f2 * x2[j]) - f3 * x3[j];
}

static inline void subtract_one(size_t n, double f, const double *restrict x, double *restrict y)
{
    for (size_t j = 0; j < n; j++) y[j] -= f * x[j];
}

/* Rows `stride` numbers apart. */
typedef struct rows {
    const double *values;
    size_t stride;
} rows;

/* Y (p x r) -= F (p x q) X (q x r); the rows of Y have the stride of X. */
static void subtract_product(size_t p, size_t q, size_t r, rows F, rows of_X, double *Y)
{
    const double *X = of_X.values;
    const size_t x_stride = of_X.stride;
    for (size_t i = 0; i < p; i++) {
        const double *f = F.values + F.stride * i;
        double *y = Y + x_stride * i;
        size_t c = 0;
        for (; c + 4 <= q; c += 4) subtract_four(r, f + c, X + x_stride * c, x_stride, y);
        for (; c < q; c++) subtract_one(r, f[c], X + x_stride * c, y);
    }
}

void dmb_dense_subtract_product(uint32_t p, uint32_t q, uint32_t r, const double *F, const double *X, double *Y)
{
    for (size_t c = 0; c < q; c += DMB_PANEL)
        subtract_product(p, smaller(DMB_PANEL, q - c), r, (rows){F + c, q}, (rows){X + r * c, r}, Y);
}

/* Factors columns [begin, end) of rows [begin, n). Rows are exchanged in full length. Returns the column without a
 * pivot, or -1. */
static int64_t factor_panel(size_t n, size_t begin, size_t end, double *A, uint32_t *pivot)
{
    for (size_t k = begin; k < end; k++) {
        const size_t p = dmb_block_pivot_row(n, k, A);
        if (!dmb_block_pivot_holds(A[n * p + k])) return (int64_t)k;
        pivot[k] = (uint32_t)p;
        if (p != k) dmb_block_swap(n, A + n * k, A + n * p);
        const double r = 1.0 / A[n * k + k];
        A[n * k + k] = r;
        for (size_t i = k + 1; i < n; i++) {
            double *a = A + n * i;
            a[k] *= r;
            subtract_one(end - k - 1, a[k], A + n * k + k + 1, a + k + 1);
        }
    }
    return -1;
}

int64_t dmb_dense_factor(uint32_t size, double *A, uint32_t *pivot)
{
    const size_t n = size;
    for (size_t begin = 0; begin < n; begin += DMB_PANEL) {
        const size_t end = smaller(begin + DMB_PANEL, n), rest = n - end;
        const int64_t failed = factor_panel(n, begin, end, A, pivot);
        if (failed >= 0) return failed;
        double *top = A + n * begin + end; /* U12 */
        for (size_t i = begin + 1; i < end; i++)
            subtract_product(1, i - begin, rest, (rows){A + n * i + begin, n}, (rows){top, n}, A + n * i + end);
        subtract_product(rest, end - begin, rest, (rows){A + n * end + begin, n}, (rows){top, n}, A + n * end + end);
    }
    return -1;
}

/* B <- L^-1 B */
static void substitute_down(size_t n, size_t m, const double *A, double *B)
{
    for (size_t begin = 0; begin < n; begin += DMB_PANEL) {
        const size_t end = smaller(begin + DMB_PANEL, n);
        for (size_t i = begin + 1; i < end; i++)
            subtract_product(1, i - begin, m, (rows){A + n * i + begin, n}, (rows){B + m * begin, m}, B + m * i);
        subtract_product(n - end, end - begin, m, (rows){A + n * end + begin, n}, (rows){B + m * begin, m},
                         B + m * end);
    }
}

/* B <- U^-1 B */
static void substitute_up(size_t n, size_t m, const double *A, double *B)
{
    for (size_t end = n, begin; end > 0; end = begin) {
        begin = (end - 1) / DMB_PANEL * DMB_PANEL;
        for (size_t i = end; i-- > begin;) {
            subtract_product(1, end - i - 1, m, (rows){A + n * i + i + 1, n}, (rows){B + m * (i + 1), m}, B + m * i);
            for (size_t j = 0; j < m; j++) B[m * i + j] *= A[n * i + i];
        }
        subtract_product(begin, end - begin, m, (rows){A + begin, n}, (rows){B + m * begin, m}, B);
    }
}

void dmb_dense_solve(uint32_t n, uint32_t m, const double *A, const uint32_t *pivot, double *B)
{
    for (size_t k = 0; k < n; k++)
        if (pivot[k] != k) dmb_block_swap(m, B + m * k, B + (size_t)m * pivot[k]);
    substitute_down(n, m, A, B);
    substitute_up(n, m, A, B);
}

/* a . x with four interleaved sums, each in order */
static double dot(size_t n, const double *a, const double *x)
{
    double s0 = 0.0, s1 = 0.0, s2 = 0.0, s3 = 0.0;
    size_t j = 0;
    for (; j + 4 <= n; j += 4) {
        s0 += a[j] * x[j];
        s1 += a[j + 1] * x[j + 1];
        s2 += a[j + 2] * x[j + 2];
        s3 += a[j + 3] * x[j + 3];
    }
    for (; j < n; j++) s0 += a[j] * x[j];
    return (s0 + s1) + (s2 + s3);
}

void dmb_dense_solve_vector(uint32_t size, const double *A, const uint32_t *pivot, double *b)
{
    const size_t n = size;
    for (size_t k = 0; k < n; k++) {
        const double t = b[k];
        b[k] = b[pivot[k]];
        b[pivot[k]] = t;
    }
    for (size_t i = 1; i < n; i++) b[i] -= dot(i, A + n * i, b);
    for (size_t i = n; i-- > 0;) b[i] = (b[i] - dot(n - i - 1, A + n * i + i + 1, b + i + 1)) * A[n * i + i];
}

void dmb_dense_subtract_vector(uint32_t p, uint32_t q, const double *F, const double *x, double *y)
{
    for (size_t i = 0; i < p; i++) y[i] -= dot(q, F + q * i, x);
}

/* y += A(:, k .. k+3) x(k .. k+3) */
static void add_four(size_t n, const double *restrict A, const double *x, double *restrict y)
{
    const double *b = A + n, *c = b + n, *d = c + n;
    for (size_t i = 0; i < n; i++) y[i] += A[i] * x[0] + b[i] * x[1] + c[i] * x[2] + d[i] * x[3];
}

void dmb_dense_times(size_t n, const double *A, const double *x, double *y)
{
    size_t k = 0;
    memset(y, 0, n * sizeof(double));
    for (; k + 4 <= n; k += 4) add_four(n, A + n * k, x + k, y);
    for (; k < n; k++)
        for (size_t i = 0; i < n; i++) y[i] += A[n * k + i] * x[k];
}

/* out = (A X)^T */
static void times_transposed(size_t n, const double *A, const double *X, double *column, double *out)
{
    for (size_t j = 0; j < n; j++) {
        dmb_dense_times(n, A, X + n * j, column);
        for (size_t i = 0; i < n; i++) out[n * i + j] = column[i];
    }
}

/* (A X)^T X is the transpose of the result. */
void dmb_dense_congruence(size_t n, const double *X, double *A, double *work)
{
    double *column = work + n * n;
    times_transposed(n, A, X, column, work);
    times_transposed(n, work, X, column, A);
}
