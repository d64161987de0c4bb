/* Symmetric elimination of one block after the other. The front holds a block and the next one,
 *     [S_i, U_i; U_i^T, D_{i+1}]   ->   S_{i+1} = D_{i+1} - U_i^T S_i^-1 U_i
 * with pivots of one or two rows chosen inside S_i (Bunch, Parlett 1971); each pivot tells its signs. */
#include "math/block_inertia.h"

#include <math.h>
#include <string.h>

#include "math/dense_inertia.h"

typedef struct front {
    double a[2 * DMB_BLOCK_SIZE_MAX][2 * DMB_BLOCK_SIZE_MAX];
    int n, rows; /* of the block that is eliminated, and in all */
} front;

static void exchange(front *f, int i, int j)
{
    if (i == j) return;
    for (int k = 0; k < f->rows; k++) {
        const double t = f->a[i][k];
        f->a[i][k] = f->a[j][k];
        f->a[j][k] = t;
    }
    for (int k = 0; k < f->rows; k++) {
        const double t = f->a[k][i];
        f->a[k][i] = f->a[k][j];
        f->a[k][j] = t;
    }
}

/* Largest diagonal and off-diagonal entries among the rows k .. n-1 that are left. */
static void look_for_pivot(const front *f, int k, int *p, int *r, int *s)
{
    *p = *r = *s = k;
    double off = 0.0;
    for (int i = k; i < f->n; i++) {
        if (fabs(f->a[i][i]) > fabs(f->a[*p][*p])) *p = i;
        for (int j = k; j < i; j++) {
            if (!(fabs(f->a[i][j]) > off)) continue;
            off = fabs(f->a[i][j]);
            *r = i;
            *s = j;
        }
    }
}

static uint32_t eliminate_one(front *f, int k)
{
    const double pivot = f->a[k][k];
    if (pivot == 0.0) return 0; /* the whole row within the block is 0 */
    for (int i = k + 1; i < f->rows; i++) {
        const double factor = f->a[i][k] / pivot;
        for (int j = k + 1; j < f->rows; j++) f->a[i][j] -= factor * f->a[k][j];
    }
    return pivot < 0.0;
}

/* A pivot of two rows has one eigenvalue of each sign. */
static uint32_t eliminate_two(front *f, int k)
{
    const double a = f->a[k][k], b = f->a[k][k + 1], c = f->a[k + 1][k + 1], determinant = a * c - b * b;
    for (int i = k + 2; i < f->rows; i++) {
        const double x = (c * f->a[i][k] - b * f->a[i][k + 1]) / determinant;
        const double y = (a * f->a[i][k + 1] - b * f->a[i][k]) / determinant;
        for (int j = k + 2; j < f->rows; j++) f->a[i][j] -= x * f->a[k][j] + y * f->a[k + 1][j];
    }
    return 1;
}

/* Bunch and Parlett's bound on the growth of the entries: (1 + sqrt 17)/8 */
#define DMB_PIVOT_RATIO 0.6403882032022076

static uint32_t eliminate(front *f)
{
    uint32_t negative = 0;
    for (int k = 0; k < f->n;) {
        int p, r, s;
        look_for_pivot(f, k, &p, &r, &s);
        if (!(r != s && fabs(f->a[p][p]) < DMB_PIVOT_RATIO * fabs(f->a[r][s]))) {
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

/* The block that was left of the step before becomes the one to eliminate. */
static void shift(front *f)
{
    const int from = f->n, size = f->rows - f->n;
    for (int i = 0; i < size; i++) memmove(f->a[i], f->a[from + i] + from, (size_t)size * sizeof(double));
    f->n = f->rows = size;
}

static void append(front *f, int m, const double *D, const double *raise, const double *U, const double *L)
{
    const int n = f->n;
    for (int i = 0; i < m; i++)
        for (int j = 0; j < m; j++) f->a[n + i][n + j] = 0.5 * (D[m * i + j] + D[m * j + i]);
    for (int i = 0; i < m && raise != NULL; i++) f->a[n + i][n + i] += raise[i];
    for (int i = 0; i < n; i++)
        for (int j = 0; j < m; j++) f->a[i][n + j] = f->a[n + j][i] = 0.5 * (U[m * i + j] + L[n * j + i]);
    f->rows = n + m;
}

uint32_t dmb_block_negative(const dmb_block_layout *layout, const double *diagonal, const double *lower,
                            const double *upper, const double *raise, uint32_t first, uint32_t count)
{
    uint32_t negative = 0;
    front f = {.n = 0, .rows = 0};
    for (uint32_t i = first; i < first + count; i++) {
        const uint32_t link = i > first ? layout->link[i - 1] : 0;
        append(&f, layout->size[i], diagonal + layout->diag[i], raise != NULL ? raise + layout->row[i] : NULL,
               upper + link, lower + link);
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
