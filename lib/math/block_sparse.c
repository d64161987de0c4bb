/* Block elimination, one position k after another. With D = A_kk and the later blocks i, j that k is coupled with,
 *
 *     W_kj = D^-1 A_kj,    A_ij -= A_ik W_kj,    solve: b_k <- D^-1 b_k,  b_i -= A_ik b_k;  backwards x_k = b_k - W_kj
 * x_j
 *
 * (block LU; Golub and Van Loan, Matrix Computations, 3.2.10 and 4.5.1 for chains). The pattern contains each A_ij that
 * the update changes.
 *
 * The kernels for 6 rows have that size as a constant; other sizes use the dense kernels. Inner loops run along rows,
 * so that they vectorise without a change in the order of a sum. */
#include "math/block_sparse.h"

#include <math.h>
#include <string.h>

#include "math/dense.h"

enum { SIX = 6 };

/* y -= f x */
static inline void row_subtract(double f, const double *restrict x, double *restrict y)
{
    for (int j = 0; j < SIX; j++) y[j] -= f * x[j];
}

/* As dmb_dense_factor. Rows are processed in a copy and subtracted over their full, fixed length; columns that are
 * already finished then contain irrelevant values. */
static int64_t factor_six(double *restrict D, uint32_t *restrict pivot)
{
    double A[SIX * SIX];
    memcpy(A, D, sizeof A);
    for (int k = 0; k < SIX; k++) {
        const int p = (int)dmb_block_pivot_row(SIX, (size_t)k, A);
        if (!dmb_block_pivot_holds(A[SIX * p + k])) return k;
        pivot[k] = (uint32_t)p;
        if (p != k) {
            dmb_block_swap(SIX, A + SIX * k, A + SIX * p);
            dmb_block_swap(SIX, D + SIX * k, D + SIX * p);
        }
        const double r = 1.0 / A[SIX * k + k];
        D[SIX * k + k] = r;
        for (int i = k + 1; i < SIX; i++) {
            const double f = A[SIX * i + k] * r;
            D[SIX * i + k] = f;
            row_subtract(f, A + SIX * k, A + SIX * i);
        }
    }
    for (int i = 0; i < SIX; i++)
        for (int j = i + 1; j < SIX; j++) D[SIX * i + j] = A[SIX * i + j];
    return -1;
}

/* W <- D^-1 W */
static void solve_six(const double *restrict D, const uint32_t *restrict pivot, double *restrict W)
{
    for (int k = 0; k < SIX; k++)
        if (pivot[k] != (uint32_t)k) dmb_block_swap(SIX, W + SIX * k, W + SIX * pivot[k]);
    for (int i = 1; i < SIX; i++) {
        double y[SIX];
        memcpy(y, W + SIX * i, sizeof y);
        for (int j = 0; j < i; j++) row_subtract(D[SIX * i + j], W + SIX * j, y);
        memcpy(W + SIX * i, y, sizeof y);
    }
    for (int i = SIX - 1; i >= 0; i--) {
        double y[SIX];
        memcpy(y, W + SIX * i, sizeof y);
        for (int j = i + 1; j < SIX; j++) row_subtract(D[SIX * i + j], W + SIX * j, y);
        for (int j = 0; j < SIX; j++) W[SIX * i + j] = D[SIX * i + i] * y[j];
    }
}

/* A -= L W */
static void update_six(const double *restrict L, const double *restrict W, double *restrict A)
{
    for (int i = 0; i < SIX; i++) {
        double y[SIX];
        memcpy(y, A + SIX * i, sizeof y);
        for (int c = 0; c < SIX; c++) row_subtract(L[SIX * i + c], W + SIX * c, y);
        memcpy(A + SIX * i, y, sizeof y);
    }
}

/* b <- D^-1 b */
static void solve_vector_six(const double *restrict D, const uint32_t *restrict pivot, double *restrict b)
{
    for (int k = 0; k < SIX; k++) {
        const double t = b[k];
        b[k] = b[pivot[k]];
        b[pivot[k]] = t;
    }
    for (int i = 1; i < SIX; i++)
        for (int j = 0; j < i; j++) b[i] -= D[SIX * i + j] * b[j];
    for (int i = SIX - 1; i >= 0; i--) {
        for (int j = SIX - 1; j > i; j--) b[i] -= D[SIX * i + j] * b[j];
        b[i] *= D[SIX * i + i];
    }
}

/* y -= A x */
static void update_vector_six(const double *restrict A, const double *restrict x, double *restrict y)
{
    for (int i = 0; i < SIX; i++) {
        double s = y[i];
        for (int j = 0; j < SIX; j++) s -= A[SIX * i + j] * x[j];
        y[i] = s;
    }
}

static inline int64_t factor_block(uint32_t n, double *D, uint32_t *pivot)
{
    return n == SIX ? factor_six(D, pivot) : dmb_dense_factor(n, D, pivot);
}

static inline void solve_block(uint32_t n, uint32_t m, const double *D, const uint32_t *pivot, double *W)
{
    if (n == SIX && m == SIX)
        solve_six(D, pivot, W);
    else
        dmb_dense_solve(n, m, D, pivot, W);
}

static inline void update_block(uint32_t p, uint32_t n, uint32_t q, const double *L, const double *W, double *A)
{
    if (p == SIX && n == SIX && q == SIX)
        update_six(L, W, A);
    else
        dmb_dense_subtract_product(p, n, q, L, W, A);
}

static inline void update_vector(uint32_t p, uint32_t q, const double *A, const double *x, double *y)
{
    if (p == SIX && q == SIX)
        update_vector_six(A, x, y);
    else
        dmb_dense_subtract_vector(p, q, A, x, y);
}

void dmb_block_sparse_clear(const dmb_block_pattern *pattern, dmb_block_sparse *matrix)
{
    memset(matrix->values, 0, sizeof(double) * pattern->values);
}

/* Rows at run time of the block at a position, and of the later block of an entry. */
static inline uint32_t size_at(const dmb_block_pattern *pattern, const dmb_block_sparse *matrix, uint32_t position)
{
    return matrix->size[pattern->order[position]];
}

/* A_ij -= A_ik W_kj for the later blocks i of entry a, and j of entry a and of each later entry, in both orders. */
static void update_from(const dmb_block_pattern *pattern, const dmb_block_sparse *matrix, uint32_t n, uint32_t a,
                        uint32_t end)
{
    double *v = matrix->values;
    const double *L = v + pattern->lower[a], *W = v + pattern->upper[a];
    const uint32_t i = pattern->later[a], p = size_at(pattern, matrix, i);
    if (p == 0) return;
    update_block(p, n, p, L, W, v + pattern->diagonal[i]);
    for (uint32_t b = a + 1; b < end; b++) {
        const uint32_t j = pattern->later[b], q = size_at(pattern, matrix, j);
        if (q == 0) continue;
        const uint32_t target = dmb_block_pattern_entry(pattern, i, j);
        update_block(p, n, q, L, v + pattern->upper[b], v + pattern->upper[target]);
        update_block(q, n, p, v + pattern->lower[b], W, v + pattern->lower[target]);
    }
}

/* Eliminates position k. Returns the column without a pivot, or -1. */
static int64_t eliminate(const dmb_block_pattern *pattern, const dmb_block_sparse *matrix, uint32_t k, uint32_t n)
{
    const uint32_t begin = pattern->column[k], end = pattern->column[k + 1];
    double *D = matrix->values + pattern->diagonal[k];
    uint32_t *pivot = matrix->pivot + pattern->pivot[k];
    const int64_t failed = factor_block(n, D, pivot);
    if (failed >= 0) return failed;
    for (uint32_t e = begin; e < end; e++) {
        const uint32_t m = size_at(pattern, matrix, pattern->later[e]);
        solve_block(n, m, D, pivot, matrix->values + pattern->upper[e]);
    }
    for (uint32_t e = begin; e < end; e++) update_from(pattern, matrix, n, e, end);
    return -1;
}

/* weakest is NULL if it is not requested */
static int64_t factor(const dmb_block_pattern *pattern, const dmb_block_sparse *matrix, dmb_block_weakest *weakest)
{
    for (uint32_t k = 0; k < pattern->n; k++) {
        const uint32_t block = pattern->order[k], n = matrix->size[block];
        if (n == 0) continue; /* without any block there are no values */
        const double *D = matrix->values + pattern->diagonal[k];
        const double largest = weakest ? dmb_block_largest(n, D) : 0.0;
        const int64_t failed = eliminate(pattern, matrix, k, n);
        if (weakest) dmb_block_watch(n, D, largest, failed, block, weakest);
        if (failed >= 0) return (int64_t)block;
    }
    return -1;
}

int64_t dmb_block_sparse_factor(const dmb_block_pattern *pattern, dmb_block_sparse *matrix)
{
    return factor(pattern, matrix, NULL);
}

int64_t dmb_block_sparse_factor_watched(const dmb_block_pattern *pattern, dmb_block_sparse *matrix,
                                        dmb_block_weakest *weakest)
{
    weakest->ratio = (double)INFINITY;
    weakest->block = 0;
    weakest->unknown = 0;
    return factor(pattern, matrix, weakest);
}

/* b_k <- D^-1 b_k, then b_i -= A_ik b_k */
static void solve_down(const dmb_block_pattern *pattern, const dmb_block_sparse *matrix, const uint32_t *row,
                       uint32_t k, double *rhs)
{
    const uint32_t block = pattern->order[k], n = matrix->size[block];
    const double *D = matrix->values + pattern->diagonal[k];
    const uint32_t *pivot = matrix->pivot + pattern->pivot[k];
    double *b = rhs + row[block];
    if (n == SIX)
        solve_vector_six(D, pivot, b);
    else
        dmb_dense_solve_vector(n, D, pivot, b);
    for (uint32_t e = pattern->column[k]; e < pattern->column[k + 1]; e++) {
        const uint32_t other = pattern->order[pattern->later[e]];
        update_vector(matrix->size[other], n, matrix->values + pattern->lower[e], b, rhs + row[other]);
    }
}

/* b_k -= W_kj x_j */
static void solve_up(const dmb_block_pattern *pattern, const dmb_block_sparse *matrix, const uint32_t *row, uint32_t k,
                     double *rhs)
{
    const uint32_t block = pattern->order[k], n = matrix->size[block];
    for (uint32_t e = pattern->column[k]; e < pattern->column[k + 1]; e++) {
        const uint32_t other = pattern->order[pattern->later[e]];
        update_vector(n, matrix->size[other], matrix->values + pattern->upper[e], rhs + row[other], rhs + row[block]);
    }
}

void dmb_block_sparse_solve(const dmb_block_pattern *pattern, const dmb_block_sparse *matrix, const uint32_t *row,
                            double *rhs)
{
    for (uint32_t k = 0; k < pattern->n; k++)
        if (matrix->size[pattern->order[k]] > 0) solve_down(pattern, matrix, row, k, rhs);
    for (uint32_t k = pattern->n; k-- > 0;)
        if (matrix->size[pattern->order[k]] > 0) solve_up(pattern, matrix, row, k, rhs);
}

/* y += A x */
static void add_product(uint32_t rows, uint32_t columns, const double *A, const double *x, double *y)
{
    for (uint32_t i = 0; i < rows; i++)
        for (uint32_t j = 0; j < columns; j++) y[i] += A[(size_t)columns * i + j] * x[j];
}

void dmb_block_sparse_multiply(const dmb_block_pattern *pattern, const dmb_block_sparse *matrix, const uint32_t *row,
                               const double *x, double *y)
{
    for (uint32_t i = 0; i < pattern->n; i++)
        for (uint32_t r = 0; r < matrix->size[i]; r++) y[row[i] + r] = 0.0;
    for (uint32_t k = 0; k < pattern->n; k++) {
        const uint32_t i = pattern->order[k], n = matrix->size[i];
        add_product(n, n, matrix->values + pattern->diagonal[k], x + row[i], y + row[i]);
        for (uint32_t e = pattern->column[k]; e < pattern->column[k + 1]; e++) {
            const uint32_t j = pattern->order[pattern->later[e]], m = matrix->size[j];
            add_product(n, m, matrix->values + pattern->upper[e], x + row[j], y + row[i]);
            add_product(m, n, matrix->values + pattern->lower[e], x + row[i], y + row[j]);
        }
    }
}
