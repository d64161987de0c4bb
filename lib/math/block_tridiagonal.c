/* Block elimination down the chain, W_i = D_i^-1 U_i, D_{i+1} -= L_i W_i (block Thomas algorithm; Golub and
 * Van Loan, Matrix Computations, 4.5.1). */
#include "math/block_tridiagonal.h"

#include <string.h>

#include "math/block_rows.h"

/* Storage, by blocks in the order of the chain, each row-major:
 *
 *     row[i]     first row of block i
 *     diag[i]    D_i, size_i x size_i
 *     link[i]    U_i, size_i x size_i+1, and L_i, size_i+1 x size_i: both have equally many numbers
 *
 * After the factorisation D_i contains its factors, U_i is W_i; all three are then stored by columns, which the
 * solution reads in sequence. */
int32_t dmb_block_count(uint32_t n, const uint8_t *size, dmb_block_totals *totals)
{
    uint64_t rows = 0, diagonal = 0, link = 0;
    for (uint32_t i = 0; i < n; i++) {
        if (size[i] < 1 || size[i] > DMB_BLOCK_SIZE_MAX) return -1;
        rows += size[i];
        diagonal += (uint64_t)size[i] * size[i];
        if (i + 1 < n) link += (uint64_t)size[i] * size[i + 1];
    }
    if (diagonal > UINT32_MAX || link > UINT32_MAX) return -1;
    totals->rows = (uint32_t)rows;
    totals->diagonal = (uint32_t)diagonal;
    totals->link = (uint32_t)link;
    return 0;
}

void dmb_block_fill(uint32_t n, const uint8_t *size, uint32_t *row, uint32_t *diag, uint32_t *link)
{
    row[0] = diag[0] = 0;
    if (n > 0) link[0] = 0;
    for (uint32_t i = 0; i < n; i++) {
        row[i + 1] = row[i] + size[i];
        diag[i + 1] = diag[i] + (uint32_t)size[i] * size[i];
        if (i + 1 < n) link[i + 1] = link[i] + (uint32_t)size[i] * size[i + 1];
    }
}

/* The rows of D_i and U_i side by side. */
DMB_BLOCK_KERNEL void gather(int n, int m, const double *restrict D, const double *restrict U, work_row *restrict a)
{
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) a[i][j] = D[n * i + j];
        for (int j = 0; j < m; j++) a[i][n + j] = U[m * i + j];
    }
}

/* Gaussian elimination of the work rows. D receives the multipliers below its diagonal and the reciprocal pivots on it.
 * Work rows are subtracted over their full, fixed length; columns that are already finished then contain irrelevant
 * values. Returns the column without a pivot, or -1. */
DMB_BLOCK_KERNEL int eliminate(int n, int m, work_row *restrict a, double *restrict D, uint8_t *restrict pivot)
{
    for (int k = 0; k < n; k++) {
        const int p = pivot_of_column(n, k, a);
        if (!dmb_block_pivot_holds(a[p][k])) return k;
        pivot[k] = (uint8_t)p;
        if (p != k) {
            dmb_block_swap((size_t)n + (size_t)m, a[k], a[p]);
            dmb_block_swap((size_t)n, D + n * k, D + n * p);
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

/* Stores the eliminated rows of D_i above the diagonal of its factors. */
DMB_BLOCK_KERNEL void store_upper(int n, work_row *restrict a, double *restrict D)
{
    for (int i = 0; i < n; i++)
        for (int j = i + 1; j < n; j++) D[n * i + j] = a[i][j];
}

/* Back substitution on the eliminated rows of U_i: W_i = D_i^-1 U_i */
DMB_BLOCK_KERNEL void substitute_back(int n, int m, work_row *restrict a, const double *restrict D, double *restrict W)
{
    DMB_BLOCK_UNROLL
    for (int k = n - 1; k >= 0; k--) {
        double y[DMB_BLOCK_SIZE_MAX];
        for (int j = 0; j < m; j++) y[j] = a[k][n + j]; /* NOLINT(clang-analyzer-core.uninitialized.Assign) */
        DMB_BLOCK_UNROLL
        for (int c = k + 1; c < n; c++) row_subtract(m, a[k][c], W + m * c, y);
        for (int j = 0; j < m; j++) W[m * k + j] = D[n * k + k] * y[j];
    }
}

/* D_{i+1} -= L_i W_i */
DMB_BLOCK_KERNEL void update_next(int n, int m, const double *restrict L, const double *restrict W,
                                  double *restrict next)
{
    for (int i = 0; i < m; i++) {
        double y[DMB_BLOCK_SIZE_MAX];
        for (int j = 0; j < m; j++) y[j] = next[m * i + j];
        for (int c = 0; c < n; c++) row_subtract(m, L[n * i + c], W + m * c, y);
        for (int j = 0; j < m; j++) next[m * i + j] = y[j];
    }
}

DMB_BLOCK_KERNEL void to_columns(int rows, int columns, double *A)
{
    double turned[DMB_BLOCK_SIZE_MAX * DMB_BLOCK_SIZE_MAX];
    turn_round(rows, columns, A, turned);
    memcpy(A, turned, (size_t)rows * (size_t)columns * sizeof *A);
}

/* A block row: D_i, U_i, L_i, D_i+1, and the pivots of D_i. */
typedef struct block_row {
    double *D, *U, *L, *next;
    uint8_t *pivot;
} block_row;

static block_row row_of(const dmb_block_layout *layout, const dmb_block_matrix *matrix, uint32_t i)
{
    const block_row row = {matrix->diagonal + layout->diag[i], matrix->upper + layout->link[i],
                           matrix->lower + layout->link[i], matrix->diagonal + layout->diag[i + 1],
                           matrix->pivot + layout->row[i]};
    return row;
}

/* One block of the factorisation. Returns the column without a pivot, or -1. */
DMB_BLOCK_KERNEL int factor_block(int n, int m, const block_row *row)
{
    double *restrict D = row->D, *restrict U = row->U, *restrict L = row->L, *restrict next = row->next;
    uint8_t *restrict pivot = row->pivot;
    work_row a[DMB_BLOCK_SIZE_MAX];
    gather(n, m, D, U, a);
    const int failed = eliminate(n, m, a, D, pivot);
    if (failed >= 0) return failed;
    store_upper(n, a, D);
    substitute_back(n, m, a, D, U);
    update_next(n, m, L, U, next);
    to_columns(n, n, D);
    to_columns(n, m, U);
    to_columns(m, n, L);
    return -1;
}

/* The factorisation; weakest is NULL, a constant, if it is not requested. */
DMB_BLOCK_KERNEL int64_t factor_blocks(const dmb_block_layout *layout, dmb_block_matrix *matrix, uint32_t first,
                                       uint32_t count, dmb_block_weakest *weakest)
{
    const uint32_t end = first + count;
    for (uint32_t i = first; i < end; i++) {
        const int n = layout->size[i], m = i + 1 < end ? layout->size[i + 1] : 0;
        const block_row row = row_of(layout, matrix, i);
        const double largest = weakest ? dmb_block_largest((size_t)n, row.D) : 0.0;
        const int failed = DMB_BLOCK_BY_SIZE(factor_block, n, m, &row);
        if (weakest) dmb_block_watch((size_t)n, row.D, largest, failed, i, weakest);
        if (failed >= 0) return (int64_t)i;
    }
    return -1;
}

/* b <- D_i^-1 b, then the next b -= L_i b */
DMB_BLOCK_KERNEL void solve_down(int n, int m, const block_row *row, double *restrict b, double *restrict next)
{
    const double *restrict D = row->D, *restrict L = row->L;
    const uint8_t *restrict pivot = row->pivot;
    double x[DMB_BLOCK_SIZE_MAX];
    for (int k = 0; k < n; k++) {
        const double t = b[k];
        b[k] = b[pivot[k]];
        b[pivot[k]] = t;
    }
    for (int k = 0; k < n; k++) x[k] = b[k];
    DMB_BLOCK_UNROLL
    for (int k = 0; k < n; k++) {
        DMB_BLOCK_UNROLL
        for (int i = k + 1; i < n; i++) x[i] -= D[n * k + i] * x[k];
    }
    DMB_BLOCK_UNROLL
    for (int k = n - 1; k >= 0; k--) {
        x[k] *= D[n * k + k];
        DMB_BLOCK_UNROLL
        for (int i = 0; i < k; i++) x[i] -= D[n * k + i] * x[k];
    }
    for (int k = 0; k < n; k++) b[k] = x[k];
    subtract_product(m, n, L, x, next);
}

int64_t dmb_block_factor(const dmb_block_layout *layout, dmb_block_matrix *matrix, uint32_t first, uint32_t count)
{
    return factor_blocks(layout, matrix, first, count, NULL);
}

int64_t dmb_block_factor_watched(const dmb_block_layout *layout, dmb_block_matrix *matrix, uint32_t first,
                                 uint32_t count, dmb_block_weakest *weakest)
{
    weakest->ratio = (double)INFINITY;
    weakest->block = first;
    weakest->unknown = 0;
    return factor_blocks(layout, matrix, first, count, weakest);
}

/* Down the chain y_i = D_i^-1 (b_i - L_i-1 y_i-1), up again x_i = y_i - W_i x_i+1. */
void dmb_block_solve(const dmb_block_layout *layout, const dmb_block_matrix *matrix, uint32_t first, uint32_t count,
                     double *rhs)
{
    const uint32_t end = first + count, *row = layout->row;
    for (uint32_t i = first; i < end; i++) {
        const int n = layout->size[i], m = i + 1 < end ? layout->size[i + 1] : 0;
        const block_row at = row_of(layout, matrix, i);
        DMB_BLOCK_BY_SIZE(solve_down, n, m, &at, rhs + row[i], rhs + row[i + 1]);
    }
    for (uint32_t i = end; i-- > first;) {
        if (i + 1 == end) continue;
        const int n = layout->size[i], m = layout->size[i + 1];
        DMB_BLOCK_BY_SIZE(solve_up, n, m, matrix->upper + layout->link[i], rhs + row[i + 1], rhs + row[i]);
    }
}

/* y_i += D_i x_i + U_i x_{i+1}, and the next y += L_i x_i */
DMB_BLOCK_KERNEL void add_product(int rows, int columns, const double *restrict A, const double *restrict x,
                                  double *restrict y)
{
    for (int i = 0; i < rows; i++) {
        double s = y[i];
        for (int j = 0; j < columns; j++) s += A[columns * i + j] * x[j];
        y[i] = s;
    }
}

void dmb_block_multiply(const dmb_block_layout *layout, const dmb_block_matrix *matrix, uint32_t first, uint32_t count,
                        const double *x, double *y)
{
    const uint32_t end = first + count, *row = layout->row;
    for (uint32_t r = row[first]; r < row[end]; r++) y[r] = 0.0;
    for (uint32_t i = first; i < end; i++) {
        const int n = layout->size[i], m = i + 1 < end ? layout->size[i + 1] : 0;
        const uint32_t link = layout->link[i];
        DMB_BLOCK_BY_SIZE(add_product, n, n, matrix->diagonal + layout->diag[i], x + row[i], y + row[i]);
        DMB_BLOCK_BY_SIZE(add_product, n, m, matrix->upper + link, x + row[i + 1], y + row[i]);
        DMB_BLOCK_BY_SIZE(add_product, m, n, matrix->lower + link, x + row[i], y + row[i + 1]);
    }
}
