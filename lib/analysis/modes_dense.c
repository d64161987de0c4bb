/* All modes of R^T M R z'' + R^T C R z' + R^T K R z = 0 by LAPACK. */
#include <math.h>
#include <string.h>

#include "analysis/modes.h"
#include "base/allocator.h"
#include "math/eigen.h"

typedef struct dense {
    size_t n;
    double *M, *C, *K, *half; /* shape (n, n), column by column */
    double *companion, *V;    /* shape (2n, 2n) where damped, else (n, n) */
    double *re, *im, *work, *x, *y;
    void *block;
    size_t bytes;
} dense;

static int32_t open_dense(const dmb_mode_search *search, dense *d)
{
    const size_t n = search->linear->coordinates, rows = search->linear->rows;
    const int with_rates = search->options->kind == DMB_MODES_DAMPED;
    const size_t m = search->general ? (with_rates ? 2 * n : n) : 0, work = dmb_eigen_work(m > n ? m : n);
    memset(d, 0, sizeof *d);
    d->n = n;
    if (work == SIZE_MAX) return DMB_ERR_TOO_LARGE;
    d->bytes = (4 * n * n + 2 * m * m + 4 * n + work + 2 * rows) * sizeof(double);
    d->block = dmb_allocate(&search->linear->allocator, d->bytes);
    if (d->block == NULL) return DMB_ERR_NO_MEMORY;
    d->M = d->block;
    d->C = d->M + n * n;
    d->K = d->C + n * n;
    d->half = d->K + n * n;
    d->companion = d->half + n * n;
    d->V = d->companion + m * m;
    d->re = d->V + m * m;
    d->im = d->re + 2 * n;
    d->work = d->im + 2 * n;
    d->x = d->work + work;
    d->y = d->x + rows;
    return DMB_OK;
}

static void symmetrise(size_t n, double *A)
{
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < i; j++) A[n * i + j] = A[n * j + i] = 0.5 * (A[n * i + j] + A[n * j + i]);
}

static int32_t symmetric(dmb_mode_search *search, dense *d)
{
    symmetrise(d->n, d->K);
    if (dmb_eigen_pair(d->n, d->K, d->M, d->re, d->work) != 0) return DMB_ERR_NO_CONVERGENCE;
    int32_t status = DMB_OK;
    for (size_t i = 0; i < d->n && status >= 0; i++) {
        dmb_linear_expand(search->linear, d->K + d->n * i, d->x);
        status = dmb_modes_add_square(search, d->re[i], d->x);
    }
    return status;
}

/* Vectors of the reduced problem back to rows. */
static void expand(const dmb_mode_search *search, const dense *d, const double *from, double *to)
{
    double *z = d->half;
    memcpy(z, from, d->n * sizeof(double));
    (void)dmb_cholesky_back(d->n, d->M, z);
    dmb_linear_expand(search->linear, z, to);
}

/* K z = -s^2 M z, K unsymmetric: s^2 may be complex (flutter), and then s and its negative are both modes of growth and
 * decay; the one that grows is told. */
static int32_t unsymmetric(dmb_mode_search *search, dense *d)
{
    const size_t n = d->n;
    int32_t status = DMB_OK;
    memcpy(d->companion, d->K, n * n * sizeof(double));
    if (dmb_eigen_general(n, d->companion, d->re, d->im, d->V, d->work) != 0) return DMB_ERR_NO_CONVERGENCE;
    for (size_t i = 0; i < n && status >= 0; i++) {
        const double size = hypot(d->re[i], d->im[i]);
        if (d->im[i] < 0.0) continue;
        expand(search, d, d->V + n * i, d->x);
        if (d->im[i] > 0.0) expand(search, d, d->V + n * (i + 1), d->y);
        const double grow = sqrt(0.5 * fmax(size - d->re[i], 0.0)), turn = sqrt(0.5 * fmax(size + d->re[i], 0.0));
        status = dmb_modes_add(search, d->im[i] > 0.0 || d->re[i] < 0.0 ? grow : 0.0, turn, d->x,
                               d->im[i] > 0.0 ? d->y : NULL);
    }
    return status;
}

/* [0 f; -K/f -C] (z; z'/f) = s (z; z'/f), f a frequency that makes both halves of one size. */
static void fill_companion(dense *d)
{
    const size_t n = d->n, m = 2 * n;
    double size = 0.0;
    for (size_t i = 0; i < n; i++) size = fmax(size, fabs(d->K[(n + 1) * i]));
    const double f = size > 0.0 ? sqrt(size) : 1.0;
    memset(d->companion, 0, m * m * sizeof(double));
    for (size_t j = 0; j < n; j++) {
        d->companion[m * (n + j) + j] = f;
        for (size_t i = 0; i < n; i++) {
            d->companion[m * j + n + i] = -d->K[n * j + i] / f;
            d->companion[m * (n + j) + n + i] = -d->C[n * j + i];
        }
    }
}

static int32_t damped(dmb_mode_search *search, dense *d)
{
    const size_t n = d->n, m = 2 * n;
    int32_t status = DMB_OK;
    if (dmb_cholesky_reduce(n, d->M, d->C, d->half) != 0) return DMB_ERR_NO_CONVERGENCE;
    fill_companion(d);
    if (dmb_eigen_general(m, d->companion, d->re, d->im, d->V, d->work) != 0) return DMB_ERR_NO_CONVERGENCE;
    for (size_t i = 0; i < m && status >= 0; i++) {
        if (d->im[i] < 0.0) continue;
        expand(search, d, d->V + m * i, d->x);
        if (d->im[i] > 0.0) expand(search, d, d->V + m * (i + 1), d->y);
        status = dmb_modes_add(search, d->re[i], d->im[i], d->x, d->im[i] > 0.0 ? d->y : NULL);
    }
    return status;
}

static int32_t general(dmb_mode_search *search, dense *d)
{
    if (dmb_cholesky(d->n, d->M) != 0) return DMB_ERR_SINGULAR;
    if (dmb_cholesky_reduce(d->n, d->M, d->K, d->half) != 0) return DMB_ERR_NO_CONVERGENCE;
    return search->options->kind == DMB_MODES_DAMPED ? damped(search, d) : unsymmetric(search, d);
}

int32_t dmb_modes_dense(dmb_mode_search *search)
{
    dmb_linear *linear = search->linear;
    dense d;
    int32_t status = open_dense(search, &d);
    if (status < 0) return status;
    dmb_linear_dense(linear, &linear->mass, search->work, d.M);
    dmb_linear_dense(linear, &linear->stiffness, search->work, d.K);
    if (search->options->kind == DMB_MODES_DAMPED) dmb_linear_dense(linear, &linear->damping, search->work, d.C);
    search->modes->info.dense = 1;
    status = search->general ? general(search, &d) : symmetric(search, &d);
    dmb_release(&linear->allocator, d.block, d.bytes);
    return status;
}
