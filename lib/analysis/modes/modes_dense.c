/* All modes of R^T M R z'' + R^T C R z' + R^T K R z = 0 by LAPACK: K X = M X diag(square) for the symmetric part of K,
 * and, if damping or a non-symmetric K couples these modes, the coupled equations (modes_coupled). */
#include "analysis/modes/modes.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "math/bridge.h"
#include "math/dense.h"
#include "sim/access.h"

/* `rows`: size of the eigenproblem. */
static int32_t refuse_size(const dmb_mode_search *search, size_t rows)
{
    dmb_message_set(
        search->message,
        "modes: all modes at once are an eigenproblem of %zu rows (%u coordinates%s), must be <= %d: ask for "
        "the lowest ones or a band",
        rows, search->linear->coordinates, rows > search->linear->coordinates ? ", damped" : "", DMB_EIGEN_MAX);
    return DMB_ERR_TOO_LARGE;
}

static int32_t open_dense(const dmb_mode_search *search, dmb_dense *d)
{
    const size_t n = search->linear->coordinates, rows = search->linear->rows;
    const size_t m = dmb_coupled_size(search), pair = dmb_eigen_work(n), coupled = dmb_eigen_general_work(m);
    memset(d, 0, sizeof *d);
    d->n = n;
    d->m = search->rigid_count;
    if (pair == SIZE_MAX || coupled == SIZE_MAX) return refuse_size(search, m > n ? m : n);
    const size_t square = search->general ? 4 * n * n + n : 2 * n * n, work = pair > coupled ? pair : coupled;
    const size_t motions = 2 * (size_t)search->rigid_count * n;
    const double bytes = ((double)square + 2.0 * (double)m * (double)m + 6.0 * (double)n + (double)work +
                          (double)motions + 2.0 * (double)rows) *
                         (double)sizeof(double);
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
    d->motion = d->y + rows;
    return DMB_OK;
}

/* Splits K into its symmetric part in X and, on request, its skew part. */
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

/* ---- Rigid-body motions ------------------------------------------------------------------------------------------ */

/* Multiple of the largest K_ii/M_ii, which is an eigenvalue itself if elements are equal. */
#define DMB_AMONG_HIGHEST 1.2345

static double *motion(const dmb_dense *d, size_t i)
{
    return d->motion + d->n * i;
}

static void add_motions(const dmb_mode_search *search, const dmb_dense *d)
{
    const size_t m = search->rigid_count, rows = search->linear->rows;
    for (size_t i = 0; i < m; i++) {
        for (size_t k = 0; k < d->n; k++) motion(d, i)[k] = search->rigid[rows * i + search->linear->row_of[k]];
        dmb_linear_restrict(search->linear, search->rigid_momentum + rows * i, motion(d, m + i));
    }
}

/* K <- P^T K P + sigma M r r^T M, P = 1 - r r^T M: r is an eigenvector, of an eigenvalue sigma among the highest, so
 * that rounding does not mix it with the lowest. K is symmetric, its columns those of d->X. */
static void move_motion(const dmb_mode_search *search, dmb_dense *d, size_t i)
{
    const size_t n = d->n;
    const double *r = motion(d, i), *g = motion(d, search->rigid_count + i);
    double *u = d->work, sigma = search->noise / DMB_NOISE;
    dmb_dense_times(n, d->X, r, u);
    sigma = dmb_dot(n, r, u) + (sigma > 0.0 ? DMB_AMONG_HIGHEST * sigma : 1.0);
    for (size_t k = 0; k < n; k++)
        for (size_t j = 0; j < n; j++) d->X[n * k + j] += sigma * g[j] * g[k] - g[j] * u[k] - u[j] * g[k];
}

/* Squared fraction of the motions in vector k. */
static double made_of_motions(const dmb_dense *d, size_t k)
{
    double sum = 0.0;
    for (size_t i = 0; i < d->m; i++) {
        const double part = dmb_dot(d->n, motion(d, d->m + i), d->X + d->n * k);
        sum += part * part;
    }
    return sum;
}

/* Removes vector number `from` and moves those before it up by one. */
static void move_up(dmb_dense *d, size_t from)
{
    for (size_t k = from; k > 0; k--) {
        d->square[k] = d->square[k - 1];
        d->rate[k] = d->rate[k - 1];
        memcpy(d->X + d->n * k, d->X + d->n * (k - 1), d->n * sizeof(double));
    }
}

/* Replaces the vectors nearest to the motions by these, in the first positions, and projects the motions out of the
 * other vectors. The projection is rounding, unless an eigenvalue equals sigma by chance: then it is at most 2/3, of
 * three vectors. */
static void put_motions(dmb_dense *d)
{
    const size_t n = d->n;
    for (size_t k = 0; k < n; k++) d->rate[k] = made_of_motions(d, k);
    for (size_t i = 0; i < d->m; i++) {
        size_t most = i;
        for (size_t k = i; k < n; k++)
            if (d->rate[k] > d->rate[most]) most = k;
        move_up(d, most);
        d->square[0] = d->rate[0] = 0.0;
    }
    for (size_t i = 0; i < d->m; i++) memcpy(d->X + n * i, motion(d, i), n * sizeof(double));
    for (size_t k = d->m; k < n; k++) {
        double *x = d->X + n * k;
        const double left = 1.0 / sqrt(1.0 - d->rate[k]);
        for (size_t i = 0; i < d->m; i++) {
            const double part = dmb_dot(n, motion(d, d->m + i), x);
            for (size_t j = 0; j < n; j++) x[j] -= part * motion(d, i)[j];
        }
        for (size_t j = 0; j < n; j++) x[j] *= left;
    }
}

/* ---- All modes --------------------------------------------------------------------------------------------------- */

/* [1/s2] Rayleigh quotient of vector k, whose rows are in d->x: the eigenvalue of LAPACK has the rounding of the
 * highest one, the quotient that of the forces of its own shape, with the square of the vector's error. */
static double quotient(const dmb_mode_search *search, const dmb_dense *d, size_t k)
{
    const dmb_linear *linear = search->linear;
    double *product = search->work;
    dmb_linear_expand(linear, d->X + d->n * k, d->x);
    dmb_linear_multiply(linear, &linear->mass, d->x, product);
    const double mass = dmb_dot(linear->rows, d->x, product);
    dmb_linear_multiply(linear, &linear->stiffness, d->x, product);
    return dmb_dot(linear->rows, d->x, product) / mass;
}

static int32_t add_symmetric(dmb_mode_search *search, dmb_dense *d)
{
    int32_t status = DMB_OK;
    for (size_t i = d->m; i < d->n && status >= 0; i++) {
        const double square = quotient(search, d, i);
        status = dmb_modes_add_square(search, square, d->x);
    }
    return status;
}

static int32_t solve(dmb_mode_search *search, dmb_dense *d)
{
    const dmb_linear *linear = search->linear;
    dmb_linear_dense(linear, &linear->mass, search->work, d->M);
    dmb_linear_dense(linear, &linear->stiffness, search->work, d->X);
    split_stiffness(d->n, d->X, search->general ? d->coupling : NULL);
    add_motions(search, d);
    for (size_t i = 0; i < search->rigid_count; i++) move_motion(search, d, i);
    int32_t status = dmb_progress_pulse(linear->work);
    if (status < 0) return status;
    const int32_t failed = dmb_eigen_pair(d->n, d->X, d->M, d->square, d->work);
    if (failed > (int32_t)d->n) {
        dmb_message_set(search->message, "modes: something that moves has no mass");
        return DMB_ERR_SINGULAR;
    }
    if (failed != 0) return DMB_ERR_NO_CONVERGENCE;
    status = dmb_progress_pulse(linear->work);
    if (status < 0) return status;
    put_motions(d);
    return search->general ? dmb_modes_coupled(search, d) : add_symmetric(search, d);
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

/* Modes of z'' + C z' + (diag(square) + S) z = 0, z the amplitudes of the undamped modes X of the symmetric part of K:
 * C = X^T C X, S = X^T (K - K^T)/2 X.
 *
 * These equations are small for low modes: in the coordinates of the nodes K has the magnitude of its stiffest element
 * throughout, and its rounding affects the lowest frequencies as the square of the highest over the lowest. With
 * displacements scaled by their own frequency, y = rate z, rate = sqrt |square|,
 *
 *     y' = rate z',     z'' = -(diag(square) + S)/rate y - C z',
 *
 * and the highest modes first, the matrix is graded from its first row to its last, which the QR algorithm
 * preserves. */

static int is_damped(const dmb_mode_search *search)
{
    return search->options->kind == DMB_MODES_DAMPED;
}

size_t dmb_coupled_size(const dmb_mode_search *search)
{
    if (!search->general) return 0;
    return (is_damped(search) ? 2 : 1) * (size_t)search->linear->coordinates;
}

/* Refined squares; 0 for rigid motions, which are scaled by the lowest rate of the others. */
static void add_rates(const dmb_mode_search *search, dmb_dense *d)
{
    double least = 0.0;
    for (size_t i = 0; i < d->n; i++) {
        d->square[i] = quotient(search, d, i);
        d->square[i] = dmb_modes_refine(search, d->square[i], d->x);
        d->rate[i] = sqrt(fabs(d->square[i]));
        if (i < d->m) d->square[i] = d->rate[i] = 0.0;
        if (d->rate[i] > 0.0 && (least == 0.0 || d->rate[i] < least)) least = d->rate[i];
    }
    for (size_t i = 0; i < d->n; i++)
        if (d->rate[i] == 0.0) d->rate[i] = least > 0.0 ? least : 1.0;
}

/* X^T A X of the matrix in `coupling`. */
static void couple(dmb_dense *d)
{
    dmb_dense_congruence(d->n, d->X, d->coupling, d->half);
}

/* X^T K r = 0 of a rigid-body motion r exactly. The symmetric part has been separated from K: the skew part equals the
 * contribution to r^T K X, and conversely. */
static void couple_motions(dmb_dense *d)
{
    const size_t n = d->n;
    for (size_t k = 0; k < d->m; k++)
        for (size_t i = 0; i < n; i++) {
            d->coupling[n * k + i] = 0.0; /* row i, motion k */
            if (i >= d->m) d->coupling[n * i + k] *= 2.0;
        }
}

/* Damping that does not act on the motions has exact zeros there. */
static void uncouple_motions(dmb_dense *d)
{
    for (size_t k = 0; k < d->m; k++)
        for (size_t i = 0; i < d->n; i++) d->coupling[d->n * k + i] = d->coupling[d->n * i + k] = 0.0;
}

/* A skew part at the rounding level is omitted. */
static void couple_stiffness(const dmb_mode_search *search, dmb_dense *d)
{
    if (search->symmetric)
        memset(d->coupling, 0, d->n * d->n * sizeof(double));
    else
        couple(d);
    couple_motions(d);
}

/* Position of mode i, the highest first. */
static size_t place_of(const dmb_dense *d, size_t i)
{
    return d->n - 1 - i;
}

static void fill_undamped(dmb_dense *d)
{
    const size_t n = d->n;
    for (size_t j = 0; j < n; j++)
        for (size_t i = 0; i < n; i++)
            d->system[n * place_of(d, j) + place_of(d, i)] = d->coupling[n * j + i] + (i == j ? d->square[i] : 0.0);
}

/* Displacement and speed of each mode are adjacent. */
static void fill_stiffness(dmb_dense *d)
{
    const size_t n = d->n, m = 2 * n;
    memset(d->system, 0, m * m * sizeof(double));
    for (size_t j = 0; j < n; j++) {
        double *by_displacement = d->system + m * (2 * place_of(d, j));
        double *by_speed = by_displacement + m;
        by_speed[2 * place_of(d, j)] = d->rate[j];
        for (size_t i = 0; i < n; i++)
            by_displacement[2 * place_of(d, i) + 1] =
                -(d->coupling[n * j + i] + (i == j ? d->square[i] : 0.0)) / d->rate[j];
    }
}

static void fill_damping(dmb_dense *d)
{
    const size_t n = d->n, m = 2 * n;
    for (size_t j = 0; j < n; j++)
        for (size_t i = 0; i < n; i++)
            d->system[m * (2 * place_of(d, j) + 1) + 2 * place_of(d, i) + 1] = -d->coupling[n * j + i];
}

/* Rows of the motion whose amplitudes in X are given by a vector of the system. */
static void expand(const dmb_mode_search *search, const dmb_dense *d, const double *v, double *rows)
{
    double *z = d->half, *motion = z + d->n;
    const int damped = is_damped(search);
    for (size_t i = 0; i < d->n; i++) z[i] = damped ? v[2 * place_of(d, i)] / d->rate[i] : v[place_of(d, i)];
    dmb_dense_times(d->n, d->X, z, motion);
    dmb_linear_expand(search->linear, motion, rows);
}

/* Root of eigenvalue i: s itself, or of s^2 = -value the growing one if that is complex (flutter) or negative. The
 * vector V of a complex value belongs to the roots -+ s*: for growing s, to -s*, and its conjugate to s. */
static void root_of(const dmb_mode_search *search, const dmb_dense *d, size_t i, double s[2])
{
    const double re = d->re[i], im = d->im[i];
    s[0] = re;
    s[1] = im;
    if (is_damped(search)) return;
    const double larger = sqrt(0.5 * (hypot(re, im) + fabs(re))), smaller = im > 0.0 ? 0.5 * im / larger : 0.0;
    s[0] = re < 0.0 ? larger : smaller;
    s[1] = re < 0.0 ? smaller : larger;
}

/* Of two undamped modes in flutter one grows and the other decays, in conjugate shapes. */
static int32_t add_flutter(dmb_mode_search *search, dmb_dense *d, const double s[2])
{
    const int32_t status = dmb_modes_add(search, -s[0], s[1], d->x, d->y);
    for (uint32_t i = 0; i < search->linear->rows; i++) d->y[i] = -d->y[i];
    return status < 0 ? status : dmb_modes_add(search, s[0], s[1], d->x, d->y);
}

/* Adds a pair as a mode, or as two modes if it is a real root of two shapes. */
static int32_t add_pair(dmb_mode_search *search, dmb_dense *d, const double s[2])
{
    const int flutters = !is_damped(search) && !dmb_modes_is_real_pair(search, s[0], s[1], d->x, d->y);
    return flutters ? add_flutter(search, d, s) : dmb_modes_add_root(search, s[0], s[1], d->x, d->y);
}

/* An unresisted motion has a column of zeros, which the balancing of dgeev separates: its root is exactly 0. */
static int is_motion(const dmb_mode_search *search, const dmb_dense *d, size_t i)
{
    return search->rigid_count > 0 && d->re[i] == 0.0 && d->im[i] == 0.0;
}

static int32_t add_modes(dmb_mode_search *search, dmb_dense *d, size_t m)
{
    int32_t status = DMB_OK;
    for (size_t i = 0; i < m && status >= 0; i++) {
        double s[2];
        const int paired = d->im[i] > 0.0;
        if (d->im[i] < 0.0 || is_motion(search, d, i)) continue;
        root_of(search, d, i, s);
        expand(search, d, d->V + m * i, d->x);
        if (paired) expand(search, d, d->V + m * (i + 1), d->y);
        if (!paired && s[1] == 0.0) {
            status = dmb_modes_add_root(search, s[0], 0.0, d->x, NULL);
            continue;
        }
        if (dmb_modes_is_rigid_root(search, s[0], s[1], d->x, paired ? d->y : NULL)) continue;
        status = paired ? add_pair(search, d, s) : dmb_modes_add(search, s[0], s[1], d->x, NULL);
    }
    return status;
}

int32_t dmb_modes_coupled(dmb_mode_search *search, dmb_dense *d)
{
    const size_t m = dmb_coupled_size(search);
    add_rates(search, d);
    couple_stiffness(search, d);
    if (is_damped(search)) {
        fill_stiffness(d);
        dmb_linear_dense(search->linear, &search->linear->damping, search->work, d->coupling);
        couple(d);
        if (search->apart) uncouple_motions(d);
        fill_damping(d);
    } else {
        fill_undamped(d);
    }
    if (dmb_eigen_general(m, d->system, d->re, d->im, d->V, d->work) != 0) return DMB_ERR_NO_CONVERGENCE;
    return add_modes(search, d, m);
}
