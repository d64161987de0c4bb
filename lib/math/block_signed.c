/* Right-looking elimination, by scalar rows inside a block, by blocks outside. With row p of U,
 *
 *     u_pp = sqrt(s a_pp),   u_pj = s a_pj/u_pp,   a_ij -= s u_pi u_pj   (i, j > p)
 *
 * The diagonal stores 1/u_pp. An excluded row is 0, including its diagonal. The sign s of each pivot is prescribed: +
 * for the first `plus` rows of a block (coordinates), - for the others (equations), as for the quasi-definite matrix of
 * eq:joints.quasi-definite, whose elimination needs no exchanges for stability. A row of an equation whose pivot is
 * small against its length is redundant: `factor` excludes rows below `weak`, `choose` also finds which ones, by taking
 * the largest remainder first. */
#include "math/block_signed.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define DMB_SIGNED_PIVOT_MIN 1e-16

/* y -= f x */
static inline void row_subtract(uint32_t n, double f, const double *restrict x, double *restrict y)
{
    for (uint32_t j = 0; j < n; j++) y[j] -= f * x[j];
}

static inline uint32_t size_at(const dmb_block_pattern *pattern, const dmb_block_signed *matrix, uint32_t position)
{
    return matrix->size[pattern->order[position]];
}

void dmb_block_signed_clear(const dmb_block_pattern *pattern, const dmb_block_signed *matrix)
{
    for (uint32_t k = 0; k < pattern->n; k++) {
        const size_t n = size_at(pattern, matrix, k);
        if (n == 0) continue;
        memset(matrix->values + pattern->diagonal[k], 0, n * n * sizeof(double));
        for (uint32_t e = pattern->column[k]; e < pattern->column[k + 1]; e++)
            memset(matrix->values + pattern->upper[e], 0,
                   n * size_at(pattern, matrix, pattern->later[e]) * sizeof(double));
    }
}

/* ---- One block --------------------------------------------------------------------------------------------------- */

/* A block during elimination. */
typedef struct front {
    const dmb_block_pattern *pattern;
    const dmb_block_signed *matrix;
    uint32_t k, n, plus; /* position, rows, rows with positive pivots */
    double *D;           /* diagonal block */
    double *length;
} front;

/* Scales row p of all blocks of the position and subtracts its multiples from the rows below. */
static void eliminate_row(const front *f, uint32_t p, double scale, double sign)
{
    const uint32_t n = f->n;
    double *row = f->D + (size_t)n * p;
    row[p] = fabs(scale);
    for (uint32_t j = p + 1; j < n; j++) row[j] *= scale;
    for (uint32_t i = p + 1; i < n && scale != 0.0; i++)
        if (row[i] != 0.0) row_subtract(n - i, sign * row[i], row + i, f->D + (size_t)n * i + i);
    for (uint32_t e = f->pattern->column[f->k]; e < f->pattern->column[f->k + 1]; e++) {
        const uint32_t m = size_at(f->pattern, f->matrix, f->pattern->later[e]);
        double *A = f->matrix->values + f->pattern->upper[e], *x = A + (size_t)m * p;
        for (uint32_t j = 0; j < m; j++) x[j] *= scale;
        for (uint32_t i = p + 1; i < n && scale != 0.0; i++)
            if (row[i] != 0.0) row_subtract(m, sign * row[i], x, A + (size_t)m * i);
    }
}

/* Pivot of row p over its length; for positive rows the pivot itself. */
static double ratio_of(const front *f, uint32_t p)
{
    const double pivot = f->D[(size_t)(f->n + 1) * p];
    if (p < f->plus) return pivot;
    return f->length[p] > 0.0 ? -pivot / f->length[p] : 0.0;
}

static int read_row(const front *f, uint32_t p, double weak)
{
    const double ratio = ratio_of(f, p), sign = p < f->plus ? 1.0 : -1.0;
    const int left_out = p >= f->plus && weak > 0.0 && ratio < weak;
    if (!left_out && !(ratio > (p < f->plus ? DBL_MIN : DMB_SIGNED_PIVOT_MIN) && ratio <= DBL_MAX)) return 0;
    eliminate_row(f, p, left_out ? 0.0 : sign / sqrt(sign * f->D[(size_t)(f->n + 1) * p]), sign);
    if (p >= f->plus) f->length[p] = ratio;
    return 1;
}

static void swap(double *a, double *b)
{
    const double t = *a;
    *a = *b;
    *b = t;
}

/* Exchanges rows p < q of the block, their columns and their lengths. */
static void exchange(const front *f, uint32_t p, uint32_t q)
{
    const size_t n = f->n;
    double *D = f->D;
    for (uint32_t i = 0; i < p; i++) swap(D + n * i + p, D + n * i + q);
    for (uint32_t i = p + 1; i < q; i++) swap(D + n * p + i, D + n * i + q);
    for (uint32_t j = q + 1; j < n; j++) swap(D + n * p + j, D + n * q + j);
    swap(D + (n + 1) * p, D + (n + 1) * q);
    swap(f->length + p, f->length + q);
    for (uint32_t e = f->pattern->column[f->k]; e < f->pattern->column[f->k + 1]; e++) {
        const size_t m = size_at(f->pattern, f->matrix, f->pattern->later[e]);
        double *A = f->matrix->values + f->pattern->upper[e];
        for (size_t j = 0; j < m; j++) swap(A + m * p + j, A + m * q + j);
    }
}

/* Row with the largest remainder from p on; the first of equal ones, with a tolerance wider than rounding. */
static uint32_t longest_from(const front *f, uint32_t p)
{
    uint32_t at = p;
    double most = ratio_of(f, p);
    for (uint32_t i = p + 1; i < f->n; i++) {
        const double here = ratio_of(f, i);
        if (!(here > most * (1.0 + 1e-6))) continue;
        most = here;
        at = i;
    }
    return at;
}

/* A_ij -= X_a^T S X_b */
static void update(const front *f, uint32_t p_size, uint32_t q_size, const double *Xa, const double *Xb, double *A)
{
    for (uint32_t p = 0; p < f->n; p++) {
        const double sign = p < f->plus ? 1.0 : -1.0, *a = Xa + (size_t)p_size * p, *b = Xb + (size_t)q_size * p;
        for (uint32_t i = 0; i < p_size; i++)
            if (a[i] != 0.0) row_subtract(q_size, sign * a[i], b, A + (size_t)q_size * i);
    }
}

static void update_later(const front *f)
{
    const dmb_block_pattern *pattern = f->pattern;
    double *v = f->matrix->values;
    const uint32_t end = pattern->column[f->k + 1];
    for (uint32_t a = pattern->column[f->k]; a < end; a++) {
        const uint32_t i = pattern->later[a], m = size_at(pattern, f->matrix, i);
        if (m == 0) continue;
        update(f, m, m, v + pattern->upper[a], v + pattern->upper[a], v + pattern->diagonal[i]);
        for (uint32_t b = a + 1; b < end; b++) {
            const uint32_t j = pattern->later[b], q = size_at(pattern, f->matrix, j);
            if (q > 0)
                update(f, m, q, v + pattern->upper[a], v + pattern->upper[b],
                       v + pattern->upper[dmb_block_pattern_entry(pattern, i, j)]);
        }
    }
}

static front front_at(const dmb_block_pattern *pattern, const dmb_block_signed *matrix, uint32_t k)
{
    const uint32_t block = pattern->order[k];
    const front f = {pattern,
                     matrix,
                     k,
                     matrix->size[block],
                     matrix->plus[block],
                     matrix->values + pattern->diagonal[k],
                     matrix->length + matrix->row[block]};
    return f;
}

/* ---- All --------------------------------------------------------------------------------------------------------- */

int64_t dmb_block_signed_factor(const dmb_block_pattern *pattern, const dmb_block_signed *matrix, double weak)
{
    for (uint32_t k = 0; k < pattern->n; k++) {
        const front f = front_at(pattern, matrix, k);
        for (uint32_t p = 0; p < f.n; p++)
            if (!read_row(&f, p, weak)) return (int64_t)pattern->order[k];
        if (f.n > 0) update_later(&f);
    }
    return -1;
}

/* Moves the pivots back to the places of their rows by the same exchanges in reverse order. */
static void choose_rows(const front *f, double weak)
{
    uint32_t *exchanged = f->matrix->order + f->matrix->row[f->pattern->order[f->k]], p = f->plus;
    for (; p < f->n; p++) {
        const uint32_t at = longest_from(f, p);
        exchanged[p] = at;
        if (at != p) exchange(f, p, at);
        if (!(ratio_of(f, p) > weak)) break;
        if (!read_row(f, p, weak)) break;
    }
    const uint32_t taken = p;
    for (; p < f->n; p++) {
        eliminate_row(f, p, 0.0, -1.0);
        f->length[p] = 0.0;
    }
    for (p = taken < f->n ? taken + 1 : taken; p-- > f->plus;)
        if (exchanged[p] != p) swap(f->length + p, f->length + exchanged[p]);
}

void dmb_block_signed_choose(const dmb_block_pattern *pattern, const dmb_block_signed *matrix, double weak)
{
    for (uint32_t k = 0; k < pattern->n; k++) {
        const front f = front_at(pattern, matrix, k);
        for (uint32_t p = 0; p < f.plus; p++) (void)read_row(&f, p, 0.0);
        choose_rows(&f, weak);
        if (f.n > 0) update_later(&f);
    }
}

/* y = U^-T x, then S y */
static void solve_down(const front *f, const uint32_t *row, double *x)
{
    double *b = x + row[f->pattern->order[f->k]];
    for (uint32_t p = 0; p < f->n; p++) {
        const double *u = f->D + (size_t)f->n * p, y = b[p] * u[p];
        row_subtract(f->n - p - 1, y, u + p + 1, b + p + 1);
        for (uint32_t e = f->pattern->column[f->k]; e < f->pattern->column[f->k + 1]; e++) {
            const uint32_t other = f->pattern->order[f->pattern->later[e]], m = f->matrix->size[other];
            row_subtract(m, y, f->matrix->values + f->pattern->upper[e] + (size_t)m * p, x + row[other]);
        }
        b[p] = p < f->plus ? y : -y;
    }
}

/* U x = S y */
static void solve_up(const front *f, const uint32_t *row, double *x)
{
    double *b = x + row[f->pattern->order[f->k]];
    for (uint32_t p = f->n; p-- > 0;) {
        const double *u = f->D + (size_t)f->n * p;
        double sum = b[p];
        for (uint32_t j = p + 1; j < f->n; j++) sum -= u[j] * b[j];
        for (uint32_t e = f->pattern->column[f->k]; e < f->pattern->column[f->k + 1]; e++) {
            const uint32_t other = f->pattern->order[f->pattern->later[e]], m = f->matrix->size[other];
            const double *u_e = f->matrix->values + f->pattern->upper[e] + (size_t)m * p, *z = x + row[other];
            for (uint32_t j = 0; j < m; j++) sum -= u_e[j] * z[j];
        }
        b[p] = sum * u[p];
    }
}

void dmb_block_signed_solve(const dmb_block_pattern *pattern, const dmb_block_signed *matrix, double *x)
{
    for (uint32_t k = 0; k < pattern->n; k++) {
        const front f = front_at(pattern, matrix, k);
        if (f.n > 0) solve_down(&f, matrix->row, x);
    }
    for (uint32_t k = pattern->n; k-- > 0;) {
        const front f = front_at(pattern, matrix, k);
        if (f.n > 0) solve_up(&f, matrix->row, x);
    }
}
