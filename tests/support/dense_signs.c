#include "dense_signs.h"

#include <stdlib.h>

/* Symmetric A (n x n) to a tridiagonal matrix d, e by Householder's reflections. */
static void tridiagonalise(uint32_t n, double *A, double *d, double *e, double *p)
{
    for (uint32_t k = 0; k + 1 < n; k++) {
        double *v = A + (size_t)n * k, norm = 0.0, vv = 0.0, vp = 0.0;
        for (uint32_t j = k + 1; j < n; j++) norm = hypot(norm, v[j]);
        d[k] = v[k];
        e[k] = v[k + 1] > 0.0 ? -norm : norm;
        if (norm == 0.0) continue;
        v[k + 1] -= e[k];
        for (uint32_t j = k + 1; j < n; j++) vv += v[j] * v[j];
        for (uint32_t i = k + 1; i < n; i++) {
            p[i] = 0.0;
            for (uint32_t j = k + 1; j < n; j++) p[i] += A[(size_t)n * i + j] * v[j];
            p[i] *= 2.0 / vv;
            vp += v[i] * p[i];
        }
        for (uint32_t i = k + 1; i < n; i++) p[i] -= vp / vv * v[i];
        for (uint32_t i = k + 1; i < n; i++)
            for (uint32_t j = k + 1; j < n; j++) A[(size_t)n * i + j] -= v[i] * p[j] + p[i] * v[j];
    }
    d[n - 1] = A[(size_t)n * n - 1];
}

/* Eigenvalues below x (Sturm). */
static int32_t count_below(uint32_t n, const double *d, const double *e, double x)
{
    int32_t count = 0;
    double q = 1.0;
    for (uint32_t k = 0; k < n; k++) {
        q = d[k] - x - (k > 0 ? e[k - 1] * e[k - 1] / q : 0.0);
        if (q == 0.0) q = 1e-300;
        count += q < 0.0;
    }
    return count;
}

/* A sparse matrix of the state by triplets into a dense one, its first row and column at `from`. */
static void add_matrix(const rig *s, const dmb_state_space *space, int32_t which, uint32_t n, uint32_t from, double *A)
{
    uint64_t count = 0;
    must(s, dmb_state_space_sparse(space, which, NULL, NULL, NULL, &count));
    uint32_t *rows = malloc(2 * (count + 1) * sizeof *rows), *columns = rows + count;
    double *values = malloc((count + 1) * sizeof *values);
    must(s, dmb_state_space_sparse(space, which, rows, columns, values, &count));
    for (uint64_t i = 0; i < count; i++) A[(size_t)n * (from + rows[i]) + columns[i]] = values[i];
    free(rows);
    free(values);
}

static void clear_row(uint32_t n, uint32_t row, double *A)
{
    for (uint32_t j = 0; j < n; j++) A[(size_t)n * row + j] = A[(size_t)n * j + row] = 0.0;
}

/* [K J^T; J 0], J times the largest entry of K; rows that supports and drives hold are 0 but for a diagonal of that
 * size. Returns its rows, *joints those of J. */
static uint32_t bordered_matrix(const rig *s, double **A, uint32_t *joints)
{
    dmb_state_space *space = NULL;
    dmb_state_space_info info = dmb_state_space_info_default();
    dmb_state_space_options options = dmb_state_space_options_default();
    double most = 0.0;
    options.form = DMB_STATE_MATRICES;
    must(s, dmb_analysis_state_space(s->sim, &options, NULL, 0, NULL, 0, &space));
    must(s, dmb_state_space_get_info(space, &info));
    const uint32_t rows = info.rows, n = rows + info.constraint_rows;
    *joints = info.constraint_rows;
    *A = calloc((size_t)n * n, sizeof **A);
    add_matrix(s, space, DMB_MATRIX_STIFFNESS, n, 0, *A);
    for (size_t i = 0; i < (size_t)n * n; i++) most = fmax(most, fabs((*A)[i]));
    add_matrix(s, space, DMB_MATRIX_JACOBIAN, n, rows, *A);
    dmb_state_space_destroy(&space);
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = 0; j < i; j++) {
            double *low = *A + (size_t)n * i + j, *high = *A + (size_t)n * j + i;
            *low = *high = i < rows ? 0.5 * (*low + *high) : j < rows ? most * *low : 0.0;
        }
    for (uint32_t i = 0; i < rows; i++) {
        dmb_row row = dmb_row_default();
        must(s, dmb_query_row(s->sim, i, &row));
        if (row.state == DMB_ROW_FREE) continue;
        clear_row(n, i, *A);
        (*A)[(size_t)(n + 1) * i] = most;
    }
    return n;
}

dense_signs dense_signs_of(const rig *s, double part)
{
    double *A = NULL, norm = 0.0;
    uint32_t joints = 0;
    const uint32_t n = bordered_matrix(s, &A, &joints);
    double *d = malloc(3 * (size_t)n * sizeof *d);
    tridiagonalise(n, A, d, d + n, d + 2 * (size_t)n);
    for (uint32_t k = 0; k < n; k++) norm = fmax(norm, fabs(d[k]));
    dense_signs signs = {.bound = part * norm};
    const int32_t below = count_below(n, d, d + n, -signs.bound);
    signs.negative = below - (int32_t)joints;
    signs.between = count_below(n, d, d + n, signs.bound) - below;
    free(A);
    free(d);
    return signs;
}
