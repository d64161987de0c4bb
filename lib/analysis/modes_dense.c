/* All modes of R^T M R z'' + R^T C R z' + R^T K R z = 0 by LAPACK: K X = M X diag(square) for the symmetric part of K,
 * and where damping or an unsymmetric K couples these modes, their own equations (modes_coupled). */
#include "analysis/modes_dense.h"

#include <string.h>

#include "base/allocator.h"
#include "math/eigen.h"

/* `rows`: of the eigenproblem. */
static int32_t refuse_size(const dmb_mode_search *search, size_t rows)
{
    dmb_message_set(search->message,
                    "modes: all modes at once are an eigenproblem of %zu rows (%u coordinates%s), must be <= %d: ask for "
                    "the lowest ones or a band",
                    rows, search->linear->coordinates, rows > search->linear->coordinates ? ", damped" : "",
                    DMB_EIGEN_MAX);
    return DMB_ERR_TOO_LARGE;
}

static int32_t open_dense(const dmb_mode_search *search, dmb_dense *d)
{
    const size_t n = search->linear->coordinates, rows = search->linear->rows;
    const size_t m = dmb_coupled_size(search), pair = dmb_eigen_work(n), coupled = dmb_eigen_general_work(m);
    memset(d, 0, sizeof *d);
    d->n = n;
    if (pair == SIZE_MAX || coupled == SIZE_MAX) return refuse_size(search, m > n ? m : n);
    const size_t square = search->general ? 4 * n * n + n : 2 * n * n, work = pair > coupled ? pair : coupled;
    const double bytes = ((double)square + 2.0 * (double)m * (double)m + 6.0 * (double)n + (double)work +
                          2.0 * (double)rows) * (double)sizeof(double);
    if (bytes > 0.5 * (double)SIZE_MAX) return refuse_size(search, m > n ? m : n);
    d->bytes = (size_t)bytes;
    d->block = dmb_allocate(&search->linear->allocator, d->bytes);
    if (d->block == NULL) return DMB_ERR_NO_MEMORY;
    d->M = d->block;
    d->X = d->M + n * n;
    d->coupling = d->X + n * n;
    d->half = d->coupling + n * n;
    d->system = (double *)d->block + square;
    d->V = d->system + m * m;
    d->square = d->V + m * m;
    d->rate = d->square + n;
    d->re = d->rate + n;
    d->im = d->re + 2 * n;
    d->work = d->im + 2 * n;
    d->x = d->work + work;
    d->y = d->x + rows;
    return DMB_OK;
}

/* K into its symmetric part in X and, where asked for, its skew one. */
static void split_stiffness(size_t n, double *K, double *skew)
{
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j <= i; j++) {
            const double a = K[n * i + j], b = K[n * j + i];
            K[n * i + j] = K[n * j + i] = 0.5 * (a + b);
            if (skew == NULL) continue;
            skew[n * i + j] = 0.5 * (a - b);
            skew[n * j + i] = 0.5 * (b - a);
        }
}

static int32_t take_symmetric(dmb_mode_search *search, dmb_dense *d)
{
    int32_t status = DMB_OK;
    for (size_t i = 0; i < d->n && status >= 0; i++) {
        dmb_linear_expand(search->linear, d->X + d->n * i, d->x);
        status = dmb_modes_add_square(search, d->square[i], d->x);
    }
    return status;
}

static int32_t solve(dmb_mode_search *search, dmb_dense *d)
{
    const dmb_linear *linear = search->linear;
    dmb_linear_dense(linear, &linear->mass, search->work, d->M);
    dmb_linear_dense(linear, &linear->stiffness, search->work, d->X);
    split_stiffness(d->n, d->X, search->general ? d->coupling : NULL);
    const int32_t failed = dmb_eigen_pair(d->n, d->X, d->M, d->square, d->work);
    if (failed > (int32_t)d->n) {
        dmb_message_set(search->message, "modes: something that moves has no mass");
        return DMB_ERR_SINGULAR;
    }
    if (failed != 0) return DMB_ERR_NO_CONVERGENCE;
    return search->general ? dmb_modes_coupled(search, d) : take_symmetric(search, d);
}

int32_t dmb_modes_dense(dmb_mode_search *search)
{
    dmb_dense d;
    int32_t status = open_dense(search, &d);
    if (status < 0) return status;
    search->modes->info.dense = 1;
    status = solve(search, &d);
    dmb_release(&search->linear->allocator, d.block, d.bytes);
    return status;
}
