/* Modes of z'' + C z' + (diag(square) + S) z = 0, z the amplitudes of the undamped modes X of the symmetric part of K:
 * C = X^T C X, S = X^T (K - K^T)/2 X.
 *
 * These equations are small where the motions are: in the coordinates of the nodes K is as large as its stiffest
 * element throughout, and rounding of it is felt in the lowest frequencies as the square of the highest over the
 * lowest. With displacements measured by their own frequency, y = rate z, rate = sqrt |square|,
 *
 *     y' = rate z',     z'' = -(diag(square) + S)/rate y - C z',
 *
 * and the highest modes first, the matrix falls off from its first row to its last, which the QR algorithm keeps. */
#include <math.h>
#include <string.h>

#include "analysis/modes_dense.h"
#include "math/dense_product.h"
#include "math/eigen.h"

static int is_damped(const dmb_mode_search *search)
{
    return search->options->kind == DMB_MODES_DAMPED;
}

size_t dmb_coupled_size(const dmb_mode_search *search)
{
    if (!search->general) return 0;
    return (is_damped(search) ? 2 : 1) * (size_t)search->linear->coordinates;
}

/* Squares as sharp as they can be had, 0 of rigid motions; these are measured by the lowest rate of the others. */
static void take_rates(const dmb_mode_search *search, dmb_dense *d)
{
    double least = 0.0;
    for (size_t i = 0; i < d->n; i++) {
        dmb_linear_expand(search->linear, d->X + d->n * i, d->x);
        d->square[i] = dmb_modes_sharpen(search, d->square[i], d->x);
        d->rate[i] = sqrt(fabs(d->square[i]));
        if (i < d->m) d->square[i] = d->rate[i] = 0.0;
        if (d->rate[i] > 0.0 && (least == 0.0 || d->rate[i] < least)) least = d->rate[i];
    }
    for (size_t i = 0; i < d->n; i++)
        if (d->rate[i] == 0.0) d->rate[i] = least > 0.0 ? least : 1.0;
}

/* X^T A X of what stands in `coupling`. */
static void couple(dmb_dense *d)
{
    dmb_dense_congruence(d->n, d->X, d->coupling, d->half);
}

/* X^T K r = 0 of a rigid-body motion r to the last digit, of which the symmetric part has been taken off K: its skew
 * part is as much as what r^T K X has of it, and the other way round. */
static void couple_motions(dmb_dense *d)
{
    const size_t n = d->n;
    for (size_t k = 0; k < d->m; k++)
        for (size_t i = 0; i < n; i++) {
            d->coupling[n * k + i] = 0.0; /* of row i by motion k */
            if (i >= d->m) d->coupling[n * i + k] *= 2.0;
        }
}

/* Damping that leaves the motions alone does so to the last digit. */
static void uncouple_motions(dmb_dense *d)
{
    for (size_t k = 0; k < d->m; k++)
        for (size_t i = 0; i < d->n; i++) d->coupling[d->n * k + i] = d->coupling[d->n * i + k] = 0.0;
}

/* A skew part that is rounding is left out. */
static void couple_stiffness(const dmb_mode_search *search, dmb_dense *d)
{
    if (search->modes->info.asymmetry <= DMB_MODES_ASYMMETRY)
        memset(d->coupling, 0, d->n * d->n * sizeof(double));
    else
        couple(d);
    couple_motions(d);
}

/* Place of mode i, the highest first. */
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

/* Displacement and speed of each mode beside each other. */
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

/* Rows of the motion whose amplitudes in X are those of a vector of the system. */
static void expand(const dmb_mode_search *search, const dmb_dense *d, const double *v, double *rows)
{
    double *z = d->half, *motion = z + d->n;
    const int damped = is_damped(search);
    for (size_t i = 0; i < d->n; i++) z[i] = damped ? v[2 * place_of(d, i)] / d->rate[i] : v[place_of(d, i)];
    dmb_dense_times(d->n, d->X, z, motion);
    dmb_linear_expand(search->linear, motion, rows);
}

/* The root of eigenvalue i: s itself, or of s^2 = -value the one that grows, where that is complex (flutter) or
 * negative. The vector V of a complex value belongs to the roots -+ s*: where s grows, to -s*, and its conjugate to s.
 */
static void root_of(const dmb_mode_search *search, const dmb_dense *d, size_t i, double s[2])
{
    const double re = d->re[i], im = d->im[i], size = hypot(re, im);
    s[0] = re;
    s[1] = im;
    if (is_damped(search)) return;
    s[0] = im > 0.0 || re < 0.0 ? sqrt(0.5 * fmax(size - re, 0.0)) : 0.0;
    s[1] = sqrt(0.5 * fmax(size + re, 0.0));
}

/* Of two undamped modes that meet in flutter one grows and the other decays, in conjugate shapes. */
static int32_t add_flutter(dmb_mode_search *search, dmb_dense *d, const double s[2])
{
    const int32_t status = dmb_modes_add(search, -s[0], s[1], d->x, d->y);
    for (uint32_t i = 0; i < search->linear->rows; i++) d->y[i] = -d->y[i];
    return status < 0 ? status : dmb_modes_add(search, s[0], s[1], d->x, d->y);
}

/* A motion that nothing turns back has a column of zeros, which the balancing of dgeev sets aside: its root is 0
 * sharply. */
static int is_motion(const dmb_mode_search *search, const dmb_dense *d, size_t i)
{
    return search->rigid_count > 0 && d->re[i] == 0.0 && d->im[i] == 0.0;
}

static int32_t take_modes(dmb_mode_search *search, dmb_dense *d, size_t m)
{
    int32_t status = DMB_OK;
    for (size_t i = 0; i < m && status >= 0; i++) {
        double s[2];
        const int paired = d->im[i] > 0.0;
        if (d->im[i] < 0.0 || is_motion(search, d, i)) continue;
        root_of(search, d, i, s);
        expand(search, d, d->V + m * i, d->x);
        if (paired) expand(search, d, d->V + m * (i + 1), d->y);
        status = paired && !is_damped(search) ? add_flutter(search, d, s)
                                              : dmb_modes_add(search, s[0], s[1], d->x, paired ? d->y : NULL);
    }
    return status;
}

int32_t dmb_modes_coupled(dmb_mode_search *search, dmb_dense *d)
{
    const size_t m = dmb_coupled_size(search);
    take_rates(search, d);
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
    return take_modes(search, d, m);
}
