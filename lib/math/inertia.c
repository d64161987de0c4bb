/* Symmetric elimination with pivots of one or two rows (Bunch, Parlett 1971); the pivots give the signs of the
 * eigenvalues. A chain is eliminated from block to block. The front contains a block and the next one,
 *     [S_i, U_i; U_i^T, D_{i+1}]   ->   S_{i+1} = D_{i+1} - U_i^T S_i^-1 U_i
 * with pivots chosen inside S_i. */
#include "math/inertia.h"

#include <math.h>
#include <string.h>

#include "math/block_kernel.h"
#include "math/block_rows.h"

/* Rows and columns of a symmetric matrix, stored in full with rows `stride` numbers apart: the first n are eliminated,
 * the others up to `rows` are updated. */
typedef struct front {
    double *a;
    size_t stride, n, rows;
} front;

static double *row(const front *f, size_t i)
{
    return f->a + f->stride * i;
}

static void exchange(front *f, size_t i, size_t j)
{
    if (i == j) return;
    dmb_block_swap(f->rows, row(f, i), row(f, j));
    for (size_t k = 0; k < f->rows; k++) {
        const double t = row(f, k)[i];
        row(f, k)[i] = row(f, k)[j];
        row(f, k)[j] = t;
    }
}

/* Largest diagonal entry p, and off-diagonal entry (r, s), r > s, among the remaining rows k .. n-1. */
static void look_for_pivot(const front *f, size_t k, size_t *p, size_t *r, size_t *s)
{
    double off = 0.0;
    *p = *r = *s = k;
    for (size_t i = k; i < f->n; i++) {
        if (fabs(row(f, i)[i]) > fabs(row(f, *p)[*p])) *p = i;
        for (size_t j = k; j < i; j++) {
            if (!(fabs(row(f, i)[j]) > off)) continue;
            off = fabs(row(f, i)[j]);
            *r = i;
            *s = j;
        }
    }
}

static uint32_t eliminate_one(front *f, size_t k)
{
    const double *x = row(f, k), pivot = x[k];
    if (pivot == 0.0) return 0; /* the remaining part of the n rows is zero */
    for (size_t i = k + 1; i < f->rows; i++) {
        double *y = row(f, i);
        const double factor = y[k] / pivot;
        for (size_t j = k + 1; j < f->rows; j++) y[j] -= factor * x[j];
    }
    return pivot < 0.0;
}

/* A pivot of two rows has one eigenvalue of each sign. */
static uint32_t eliminate_two(front *f, size_t k)
{
    const double *x = row(f, k), *y = row(f, k + 1);
    const double a = x[k], b = x[k + 1], c = y[k + 1], determinant = a * c - b * b;
    for (size_t i = k + 2; i < f->rows; i++) {
        double *z = row(f, i);
        const double by_x = (c * z[k] - b * z[k + 1]) / determinant, by_y = (a * z[k + 1] - b * z[k]) / determinant;
        for (size_t j = k + 2; j < f->rows; j++) z[j] -= by_x * x[j] + by_y * y[j];
    }
    return 1;
}

/* Bunch and Parlett's bound on the growth of the entries: (1 + sqrt 17)/8 */
#define DMB_PIVOT_RATIO 0.6403882032022076

/* Eliminates rows k .. n-1. */
static uint32_t eliminate(front *f, size_t k)
{
    uint32_t negative = 0;
    while (k < f->n) {
        size_t p, r, s;
        look_for_pivot(f, k, &p, &r, &s);
        if (!(r != s && fabs(row(f, p)[p]) < DMB_PIVOT_RATIO * fabs(row(f, r)[s]))) {
            exchange(f, k, p);
            negative += eliminate_one(f, k);
            k += 1;
        } else {
            exchange(f, k, s); /* s < r */
            exchange(f, k + 1, r);
            negative += eliminate_two(f, k);
            k += 2;
        }
    }
    return negative;
}

/* ---- Dense ------------------------------------------------------------------------------------------------------- */

uint32_t dmb_dense_negative(uint32_t n, double *A)
{
    front f = {.a = A, .stride = n, .n = n, .rows = n};
    for (size_t i = 0; i < f.n; i++)
        for (size_t j = 0; j < i; j++) row(&f, i)[j] = row(&f, j)[i] = 0.5 * (row(&f, i)[j] + row(&f, j)[i]);
    return eliminate(&f, 0);
}

/* Multiplies L U and reverses the exchanges from the last to the first. */
void dmb_dense_from_factors(uint32_t n, const double *LU, const uint32_t *pivot, double *A)
{
    const size_t rows = n;
    for (size_t i = 0; i < rows; i++)
        for (size_t j = 0; j < rows; j++) {
            double sum = 0.0;
            for (size_t k = 0; k <= i && k <= j; k++)
                sum += (k == i ? 1.0 : LU[rows * i + k]) * (k == j ? 1.0 / LU[rows * k + k] : LU[rows * k + j]);
            A[rows * i + j] = sum;
        }
    for (size_t k = rows; k-- > 0;)
        if (pivot[k] != k) dmb_block_swap(rows, A + rows * k, A + rows * pivot[k]);
}

/* ---- Blocks ------------------------------------------------------------------------------------------------------ */

/* The block that is eliminated, as full rows [S_i, U_i], and the next one. */
typedef struct block_front {
    work_row a[DMB_BLOCK_SIZE_MAX];
    double next[DMB_BLOCK_SIZE_MAX * DMB_BLOCK_SIZE_MAX];
} block_front;

/* out = (A + B^T)/2, A (n x m) in rows `stride` numbers apart */
DMB_BLOCK_KERNEL void average(int n, int m, const double *A, const double *B, double *out, int stride)
{
    for (int i = 0; i < n; i++)
        for (int j = 0; j < m; j++) out[stride * i + j] = 0.5 * (A[m * i + j] + B[n * j + i]);
}

/* Pivots of one row, chosen as those of `eliminate`. Returns the row at which a pivot of two rows is needed, or n. */
DMB_BLOCK_KERNEL int eliminate_rows(int n, int m, work_row *a, uint32_t *negative)
{
    DMB_BLOCK_UNROLL
    for (int k = 0; k < n; k++) {
        double off = 0.0;
        int p = k;
        for (int i = k + 1; i < n; i++) {
            if (fabs(a[i][i]) > fabs(a[p][p])) p = i;
            for (int j = k; j < i; j++) off = fabs(a[i][j]) > off ? fabs(a[i][j]) : off;
        }
        const double pivot = a[p][p];
        if (pivot == 0.0 || fabs(pivot) < DMB_PIVOT_RATIO * off) return k;
        if (p != k) {
            dmb_block_swap((size_t)n + (size_t)m, a[k], a[p]);
            for (int i = 0; i < n; i++) {
                const double t = a[i][k];
                a[i][k] = a[i][p];
                a[i][p] = t;
            }
        }
        *negative += pivot < 0.0;
        for (int i = k + 1; i < n; i++) row_subtract(n + m, a[i][k] / pivot, a[k], a[i]);
    }
    return n;
}

/* next -= V^T P^-1 V of `count` eliminated rows, with their pivots P */
DMB_BLOCK_KERNEL void update_next(int n, int m, int count, work_row *a, double *next)
{
    for (int k = 0; k < count; k++)
        for (int i = 0; i < m; i++) row_subtract(m, a[k][n + i] / a[k][k], a[k] + n, next + m * i);
}

/* From row k on, with pivots of two rows; rows before it are eliminated. The slow way for blocks that need pivots of
 * two rows: the front is copied into one full matrix and eliminated by `eliminate`; the rows eliminated before keep
 * their pivots. */
static uint32_t eliminate_from(int k, int n, int m, block_front *b)
{
    double all[4 * DMB_BLOCK_SIZE_MAX * DMB_BLOCK_SIZE_MAX] = {0.0};
    const int size = n + m;
    front f = {.a = all, .stride = (size_t)size, .n = (size_t)n, .rows = (size_t)size};
    update_next(n, m, k, b->a, b->next);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < size; j++) all[size * i + j] = all[size * j + i] = b->a[i][j];
    for (int i = 0; i < m; i++)
        for (int j = 0; j < m; j++) all[size * (n + i) + n + j] = b->next[m * i + j];
    const uint32_t negative = eliminate(&f, (size_t)k);
    for (int i = 0; i < m; i++)
        for (int j = 0; j < m; j++) b->next[m * i + j] = all[size * (n + i) + n + j];
    return negative;
}

/* One block: b->a holds S_i; b->next, D_i+1, becomes S_i+1. */
DMB_BLOCK_KERNEL uint32_t eliminate_block(int n, int m, const double *U, const double *L, block_front *b)
{
    uint32_t negative = 0;
    average(n, m, U, L, b->a[0] + n, 2 * DMB_BLOCK_SIZE_MAX);
    const int k = eliminate_rows(n, m, b->a, &negative);
    if (k == n)
        update_next(n, m, n, b->a, b->next);
    else
        negative += eliminate_from(k, n, m, b);
    for (int i = 0; i < m; i++)
        for (int j = 0; j < m; j++) b->a[i][j] = b->next[m * i + j];
    return negative;
}

void dmb_block_row_sizes(uint32_t n, const double *D, double arm_square, const uint8_t *solved, double floor,
                         double *size)
{
    double most = 0.0;
    for (uint32_t i = 0; i < n; i++) {
        const double weight = 2 * i < n ? 1.0 : arm_square, own = fabs(D[(size_t)(n + 1) * i]);
        size[i] = solved == NULL || solved[i] ? own : 0.0;
        most = fmax(most, size[i] / weight);
    }
    for (uint32_t i = 0; i < n; i++)
        if (solved == NULL || solved[i]) size[i] = fmax(size[i], floor * most * (2 * i < n ? 1.0 : arm_square));
}

/* Adds to the diagonal of the block S (n x n), D before symmetrisation, whose first row is `at`. */
static void add_raise(uint32_t n, const dmb_block_raise *raise, const double *D, uint32_t at, double *S,
                      uint32_t stride)
{
    double size[DMB_BLOCK_SIZE_MAX] = {0.0};
    if (raise->part > 0.0) /* else arm_square is not set */
        dmb_block_row_sizes(n, D, raise->arm_square, raise->solved != NULL ? raise->solved + at : NULL, raise->floor,
                            size);
    for (uint32_t k = 0; k < n; k++) {
        S[(size_t)(stride + 1) * k] += raise->part * size[k];
        if (raise->amount != NULL) S[(size_t)(stride + 1) * k] += raise->share * raise->amount[at + k];
    }
}

/* D_i+1 is averaged and raised when it enters the front, so that K itself stays as it is. */
uint32_t dmb_block_negative(const dmb_block_layout *layout, const double *diagonal, const double *lower,
                            const double *upper, const dmb_block_raise *raise, uint32_t first, uint32_t count)
{
    enum { STRIDE = 2 * DMB_BLOCK_SIZE_MAX };
    const uint32_t end = first + count;
    block_front b = {.next = {0.0}};
    uint32_t negative = 0;
    for (uint32_t i = first; i < end; i++) {
        const int n = layout->size[i], m = i + 1 < end ? layout->size[i + 1] : 0;
        const uint32_t link = layout->link[i];
        const double *D = diagonal + layout->diag[i], *next = diagonal + layout->diag[i + 1];
        if (i == first) {
            average(n, n, D, D, b.a[0], STRIDE);
            if (raise != NULL) add_raise((uint32_t)n, raise, D, layout->row[i], b.a[0], STRIDE);
        }
        average(m, m, next, next, b.next, m);
        if (raise != NULL) add_raise((uint32_t)m, raise, next, layout->row[i + 1], b.next, (uint32_t)m);
        negative += DMB_BLOCK_BY_SIZE(eliminate_block, n, m, upper + link, lower + link, &b);
    }
    return negative;
}

/* The block D_kk that elimination left is rebuilt from its factors; by Haynsworth's formula the counts of these blocks
 * add up (eq:signs.inertia). */
uint32_t dmb_block_sparse_negative(const dmb_block_pattern *pattern, const dmb_block_sparse *factored, double *room)
{
    double small[DMB_BLOCK_SIZE_MAX * DMB_BLOCK_SIZE_MAX];
    uint32_t negative = 0;
    for (uint32_t k = 0; k < pattern->n; k++) {
        const uint32_t n = factored->size[pattern->order[k]];
        double *A = n <= DMB_BLOCK_SIZE_MAX ? small : room;
        dmb_dense_from_factors(n, factored->values + pattern->diagonal[k], factored->pivot + pattern->pivot[k], A);
        negative += dmb_dense_negative(n, A);
    }
    return negative;
}
