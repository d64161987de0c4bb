/* Symmetric elimination with pivots of one or two rows (Bunch, Parlett 1971); the pivots give the signs of the
 * eigenvalues. A chain is eliminated from block to block. The front contains a block and the next one,
 *     [S_i, U_i; U_i^T, D_{i+1}]   ->   S_{i+1} = D_{i+1} - U_i^T S_i^-1 U_i
 * with pivots chosen inside S_i. */
#include "math/inertia.h"

#include <math.h>
#include <string.h>

#include "math/block_kernel.h"

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

static uint32_t eliminate(front *f)
{
    uint32_t negative = 0;
    for (size_t k = 0; k < f->n;) {
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
    return eliminate(&f);
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

/* The remaining block of the last step becomes the one to eliminate. */
static void shift(front *f)
{
    const size_t from = f->n, size = f->rows - f->n;
    for (size_t i = 0; i < size; i++) memmove(row(f, i), row(f, from + i) + from, size * sizeof(double));
    f->n = f->rows = size;
}

static void append(front *f, size_t m, const double *D, const double *U, const double *L)
{
    const size_t n = f->n;
    for (size_t i = 0; i < m; i++)
        for (size_t j = 0; j < m; j++) row(f, n + i)[n + j] = 0.5 * (D[m * i + j] + D[m * j + i]);
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < m; j++) row(f, i)[n + j] = row(f, n + j)[i] = 0.5 * (U[m * i + j] + L[n * j + i]);
    f->rows = n + m;
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

/* Adds to the diagonal of the block D that was appended last, whose first row is `at`. */
static void raise_last(front *f, const dmb_block_raise *raise, const double *D, uint32_t at)
{
    double size[DMB_BLOCK_SIZE_MAX] = {0.0};
    if (raise->part > 0.0) /* else arm_square is not set */
        dmb_block_row_sizes((uint32_t)(f->rows - f->n), D, raise->arm_square,
                            raise->solved != NULL ? raise->solved + at : NULL, raise->floor, size);
    for (size_t i = f->n; i < f->rows; i++) {
        const size_t k = i - f->n;
        row(f, i)[i] += raise->part * size[k];
        if (raise->amount != NULL) row(f, i)[i] += raise->share * raise->amount[at + k];
    }
}

uint32_t dmb_block_negative(const dmb_block_layout *layout, const double *diagonal, const double *lower,
                            const double *upper, const dmb_block_raise *raise, uint32_t first, uint32_t count)
{
    double a[4 * DMB_BLOCK_SIZE_MAX * DMB_BLOCK_SIZE_MAX];
    front f = {.a = a, .stride = 2 * DMB_BLOCK_SIZE_MAX};
    uint32_t negative = 0;
    for (uint32_t i = first; i < first + count; i++) {
        const uint32_t link = i > first ? layout->link[i - 1] : 0;
        append(&f, layout->size[i], diagonal + layout->diag[i], upper + link, lower + link);
        if (raise != NULL) raise_last(&f, raise, diagonal + layout->diag[i], layout->row[i]);
        if (i > first) negative += eliminate(&f);
        shift(&f);
    }
    return negative + eliminate(&f);
}

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
