/* Few modes: the inverse of K - shift M makes the wanted eigenvalues the largest of an operator.
 *
 *     symmetric:  A = (K - p M)^-1 M in the metric M,           s^2 = -(p + 1/value)       (eq:modes.shift-invert)
 *     general:    (x; w), w = s x, from s (x; M w) = (w; -K x - C w) with a real shift p:
 *                 A (a; b) = (x; w),  Q x = -(M b + (C + p M) a),  Q = K + p C + p^2 M,  w = a + p x,
 *                 s = p + 1/value, in the metric blkdiag(f^2 M, M), f scales both parts equally (eq:modes.general)
 * If rigid-body motions r_i are separated, the inverse is between P^T and P, P = I - sum r_i r_i^T M; if they are
 * pinned, p = 0 and K + pins replaces K. */
#include <complex.h>
#include <math.h>
#include <string.h>

#include "analysis/linear/linear.h"
#include "analysis/modes/modes.h"
#include "base/memory.h"
#include "math/bridge.h"
#include "math/dense.h"
#include "math/krylov.h"
#include "sim/access.h"

/* Residual of a converged operator value: its error is the square of this if symmetric. */
#define DMB_MODES_SYMMETRIC_TOLERANCE 1e-9
#define DMB_MODES_GENERAL_TOLERANCE 1e-11

typedef struct inverse {
    const dmb_mode_search *search;
    dmb_linear *linear;
    const dmb_linear_matrix *damping; /* NULL: omitted */
    double shift, scale;              /* p and f */
    double *work;                     /* shape (2 rows) */
} inverse;

static void mass_times(const dmb_linear *linear, const double *x, double *y)
{
    dmb_linear_multiply(linear, &linear->mass, x, y);
}

static void draw_rows(dmb_linear *linear, uint64_t *seed, double *x)
{
    for (uint32_t i = 0; i < linear->rows; i++) {
        *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        x[i] = (double)(*seed >> 11) * 0x1p-52 - 1.0;
    }
}

/* Random start vector: the motion under random forces, which is smooth and in the space of the coordinates. */
static void draw_motion(dmb_linear *linear, uint64_t *seed, double *x, double *work)
{
    draw_rows(linear, seed, x);
    mass_times(linear, x, work);
    memcpy(x, work, linear->rows * sizeof(double));
    dmb_linear_solve(linear, x);
}

/* ---- Symmetric --------------------------------------------------------------------------------------------------- */

static void symmetric_metric(void *context, const double *x, double *y)
{
    const inverse *A = context;
    mass_times(A->linear, x, y);
}

/* A x = P (K - p M)^-1 P^T M x (eq:modes.shift-invert), from M x, which the iteration has computed for its inner
 * products. Without P a rigid-body motion has the value -1/p, the largest of all for a small shift, and each would cost
 * vectors. */
static void symmetric_apply(void *context, const double *x, const double *Mx, double *y)
{
    const inverse *A = context;
    const dmb_mode_search *s = A->search;
    (void)x;
    memcpy(y, Mx, A->linear->rows * sizeof(double));
    dmb_modes_add_rigid(s, s->rigid, s->rigid_momentum, y);
    dmb_linear_solve(A->linear, y);
    dmb_modes_add_rigid(s, s->rigid_momentum, s->rigid, y);
}

static void symmetric_draw(void *context, uint64_t *seed, double *x)
{
    const inverse *A = context;
    draw_motion(A->linear, seed, x, A->work);
    dmb_modes_add_rigid(A->search, A->search->rigid_momentum, A->search->rigid, x);
}

/* X^T A X of vectors by rows, AX in `products`. */
static void project(const dmb_linear *linear, const dmb_linear_matrix *A, const double *X, size_t count,
                    double *products, double *out)
{
    const size_t rows = linear->rows;
    for (size_t j = 0; j < count; j++) dmb_linear_multiply(linear, A, X + rows * j, products + rows * j);
    for (size_t j = 0; j < count; j++)
        for (size_t i = 0; i < count; i++) {
            double sum = 0.0;
            for (size_t r = 0; r < rows; r++) sum += X[rows * i + r] * products[rows * j + r];
            out[count * j + i] = sum;
        }
    for (size_t j = 0; j < count; j++)
        for (size_t i = 0; i < j; i++)
            out[count * j + i] = out[count * i + j] = 0.5 * (out[count * j + i] + out[count * i + j]);
}

/* Rayleigh-Ritz with K and M in the computed space: the error of an eigenvalue is the square of the vector's error,
 * without the operator's rounding. */
static int32_t refine(dmb_mode_search *search, const dmb_krylov *found)
{
    dmb_linear *linear = search->linear;
    const size_t k = found->count, rows = linear->rows, work = dmb_eigen_work(k);
    if (work == SIZE_MAX) return DMB_ERR_TOO_LARGE;
    const size_t bytes = (2 * k * k + k + work + k * rows + rows) * sizeof(double);
    double *K = dmb_allocate(&linear->allocator, bytes);
    if (K == NULL) return DMB_ERR_NO_MEMORY;
    double *M = K + k * k, *values = M + k * k, *lapack = values + k, *products = lapack + work,
           *x = products + k * rows;
    project(linear, &linear->mass, found->x, k, products, M);
    project(linear, &linear->stiffness, found->x, k, products, K);
    int32_t status = dmb_eigen_pair(k, K, M, values, lapack) == 0 ? DMB_OK : DMB_ERR_NO_CONVERGENCE;
    for (size_t i = 0; i < k && status >= 0; i++) {
        memset(x, 0, rows * sizeof(double));
        for (size_t j = 0; j < k; j++)
            for (size_t r = 0; r < rows; r++) x[r] += K[k * i + j] * found->x[rows * j + r];
        if (dmb_modes_is_rigid_root(search, sqrt(fabs(values[i])), 0.0, x, NULL)) continue;
        status = dmb_modes_add_square(search, values[i], x);
    }
    dmb_release(&linear->allocator, K, bytes);
    return status;
}

/* ---- General ----------------------------------------------------------------------------------------------------- */

static void general_metric(void *context, const double *x, double *y)
{
    const inverse *A = context;
    const uint32_t rows = A->linear->rows;
    mass_times(A->linear, x, y);
    for (uint32_t i = 0; i < rows; i++) y[i] *= A->scale * A->scale;
    mass_times(A->linear, x + rows, y + rows);
}

/* A (a; b) of the head comment. Gx is the product by the metric, (f^2 M a; M b): it gives M b, and over f^2 also p M a,
 * so that only C a is a further product. w = a + p x follows without the mass matrix, from the upper half of (A - p)
 * (x; w) = (a; b). */
static void general_apply(void *context, const double *x, const double *Gx, double *y)
{
    const inverse *A = context;
    const uint32_t rows = A->linear->rows;
    const double mass_factor = A->shift / (A->scale * A->scale);
    memset(y, 0, rows * sizeof(double));
    if (A->damping != NULL) dmb_linear_multiply(A->linear, A->damping, x, y);
    for (uint32_t i = 0; i < rows; i++) y[i] = -(Gx[rows + i] + y[i] + mass_factor * Gx[i]);
    dmb_modes_add_rigid(A->search, A->search->rigid, A->search->rigid_momentum, y);
    dmb_linear_solve(A->linear, y);
    dmb_modes_add_rigid(A->search, A->search->rigid_momentum, A->search->rigid, y);
    for (uint32_t i = 0; i < rows; i++) y[rows + i] = x[i] + A->shift * y[i];
}

static void general_draw(void *context, uint64_t *seed, double *x)
{
    const inverse *A = context;
    const size_t rows = A->linear->rows;
    for (size_t part = 0; part < 2; part++) {
        draw_motion(A->linear, seed, x + part * rows, A->work);
        dmb_modes_add_rigid(A->search, A->search->rigid_momentum, A->search->rigid, x + part * rows);
    }
}

/* From values 1/(s - p) back to roots, s = p + conj(value)/|value|^2. Of a complex pair the iteration returns one
 * member; its conjugate, with im > 0, is the one that is listed. */
static int32_t add_general(dmb_mode_search *search, const dmb_krylov *found)
{
    const size_t rows = search->linear->rows;
    int32_t status = DMB_OK;
    for (uint32_t k = 0; k < found->count && status >= 0; k++) {
        const double size2 = found->re[k] * found->re[k] + found->im[k] * found->im[k];
        const double re = search->shift + found->re[k] / size2, im = -found->im[k] / size2;
        double *x = found->x + 2 * rows * k, *y = found->y + 2 * rows * k;
        for (size_t i = 0; i < rows; i++) y[i] = -y[i]; /* the conjugate, im > 0 */
        status = dmb_modes_add_root(search, re, fabs(im), x, y);
    }
    return status;
}

/* ---- Both -------------------------------------------------------------------------------------------------------- */

/* [1/s] Scale f of the lowest frequencies: root of x . M x/(x . M K^-1 M x), the Rayleigh quotient of the inverse, of a
 * motion x = K^-1 M r under random forces, in which modes count by omega^-4, so that the quotient is near those that
 * are wanted. With w = s x, the two parts of the metric are then of the same size for them, and orthogonality in it
 * loses no digits of either. */
static double low_frequency(dmb_mode_search *search)
{
    dmb_linear *linear = search->linear;
    const uint32_t rows = linear->rows;
    double *x = search->work, *y = x + rows, *z = y + rows, up = 0.0, down = 0.0;
    uint64_t seed = 7;
    draw_motion(linear, &seed, x, y);
    dmb_modes_add_rigid(search, search->rigid_momentum, search->rigid, x);
    mass_times(linear, x, y);
    memcpy(z, y, rows * sizeof(double));
    dmb_linear_solve(linear, z);
    for (uint32_t i = 0; i < rows; i++) {
        up += x[i] * y[i];
        down += z[i] * y[i];
    }
    return down != 0.0 && isfinite(up / down) ? sqrt(fabs(up / down)) : 1.0;
}

static int32_t factor(dmb_mode_search *search)
{
    const double p = search->shift;
    const int damped = search->options->kind == DMB_MODES_DAMPED;
    if (search->pinned) return DMB_OK;
    const int64_t bad = search->general ? dmb_linear_factor(search->linear, 1.0, damped ? p : 0.0, p * p, NULL)
                                        : dmb_linear_factor(search->linear, 1.0, 0.0, -p, NULL);
    if (bad < 0) return DMB_OK;
    dmb_message_set(search->message, "modes: K - shift M is singular at node %u", (uint32_t)bad);
    return DMB_ERR_SINGULAR;
}

static uint32_t apart_count(const dmb_mode_search *search)
{
    return search->apart ? search->rigid_count : 0;
}

static int32_t go_on(void *context)
{
    const inverse *A = context;
    return dmb_progress_pulse(A->linear->work);
}

/* Separated rigid-body motions are not in the image of P: they take away dimensions, without which the iteration would
 * expect values that do not exist. */
static dmb_operator operator_of(const dmb_mode_search *search, inverse *A)
{
    const int general = search->general;
    dmb_operator operator;
    memset(&operator, 0, sizeof operator);
    operator.context = A;
    operator.length =(general ? 2 : 1) * (size_t)search->linear->rows;
    operator.dimension =(general ? 2 : 1) * ((size_t)search->linear->coordinates - apart_count(search));
    operator.symmetric = !general;
    operator.partly = search->partly;
    operator.counted = search->counted;
    operator.enough = search->enough;
    for (int side = 0; side < 2 && search->enough > 0; side++) /* of (s^2 - shift)^-1, shift inside the window */
        operator.beyond[side] = 1.0 /(search->window[side] - search->shift);
    operator.most = search->most;
    operator.positive = search->above;
    operator.metric = general ? general_metric : symmetric_metric;
    operator.apply = general ? general_apply : symmetric_apply;
    operator.draw = general ? general_draw : symmetric_draw;
    operator.go_on = go_on;
    return operator;
}

int32_t dmb_modes_sparse(dmb_mode_search *search, uint32_t wanted)
{
    dmb_linear *linear = search->linear;
    inverse A = {search, linear, NULL, search->shift, 1.0, search->work};
    dmb_krylov found;
    int32_t status = factor(search);
    if (status < 0 || (!search->above && wanted <= apart_count(search))) return status;
    if (search->options->kind == DMB_MODES_DAMPED) A.damping = &linear->damping;
    if (search->general) A.scale = low_frequency(search);
    /* Motions that are not separated are found too, each with one root 0 or two, and omitted. */
    const uint32_t values = search->above   ? wanted
                            : search->apart ? wanted - search->rigid_count
                                            : wanted + search->rigid_count;
    const dmb_operator operator= operator_of(search, &A);
    status = dmb_krylov_largest(&operator, values, search->shift != 0.0 && !search->counted ? 4 : 2,
                                search->general ? DMB_MODES_GENERAL_TOLERANCE : DMB_MODES_SYMMETRIC_TOLERANCE,
                                &linear->allocator, &found);
    if (status < 0) return status;
    search->modes->info.solves += found.applications;
    search->reach = found.next > 0.0 ? 1.0 / found.next : 0.0;
    search->next = found.bound > 0.0 ? 1.0 / found.bound : 0.0;
    if (found.count > 0) status = search->general ? add_general(search, &found) : refine(search, &found);
    dmb_krylov_release(&found);
    return status;
}

/* Roots of the general problem nearest a complex shift p = g + i w, in real numbers: with A as in modes_sparse,
 *
 *     T = Re (A - p)^-1,   value = ((s - p)^-1 + (s - p*)^-1)/2 = t/(t^2 + w^2),   t = s - g,
 *
 * has the eigenvectors (x; s x) of A (Parlett, Saad 1987), and its largest values are those of the roots next to p and
 * p*. t = (1 +- sqrt(1 - 4 value^2 w^2))/(2 value): the sign follows from x . M (s x). */

#define DMB_SHIFTED_TOLERANCE 1e-11

typedef double complex number;

typedef struct shifted {
    dmb_mode_search *search;
    dmb_dynamic_stiffness stiffness;
    double growth, omega, scale;
    dmb_complex_array f; /* shape (rows) */
    double *product;     /* shape (rows) */
} shifted;

double dmb_shifted_value(double growth, double omega, double re, double im)
{
    const number t = re - growth + im * (number)_Complex_I;
    if (re == growth && im == 0.0) return omega > 0.0 ? 0.0 : (double)INFINITY; /* its limit, without a division by 0 */
    const double size = cabs(omega > 0.0 ? t + omega * omega / t : t);
    return size > 0.0 ? 1.0 / size : (double)INFINITY;
}

static void metric(void *context, const double *x, double *y)
{
    const shifted *T = context;
    const dmb_linear *linear = T->search->linear;
    const size_t n = linear->rows;
    dmb_linear_multiply(linear, &linear->mass, x, y);
    for (size_t i = 0; i < n; i++) y[i] *= T->scale * T->scale;
    dmb_linear_multiply(linear, &linear->mass, x + n, y + n);
}

static void solve(shifted *T)
{
    const dmb_mode_search *s = T->search;
    dmb_modes_add_rigid(s, s->rigid, s->rigid_momentum, T->f.re);
    dmb_modes_add_rigid(s, s->rigid, s->rigid_momentum, T->f.im);
    dmb_dynamic_stiffness_solve(&T->stiffness, 0, T->f);
    dmb_modes_add_rigid(s, s->rigid_momentum, s->rigid, T->f.re);
    dmb_modes_add_rigid(s, s->rigid_momentum, s->rigid, T->f.im);
}

static void apply(void *context, const double *x, const double *Gx, double *y)
{
    shifted *T = context;
    const dmb_linear *linear = T->search->linear;
    const size_t n = linear->rows;
    const double mass = 1.0 / (T->scale * T->scale);
    dmb_linear_multiply(linear, &linear->damping, x, T->product);
    for (size_t i = 0; i < n; i++) {
        T->f.re[i] = -(Gx[n + i] + T->product[i] + T->growth * mass * Gx[i]);
        T->f.im[i] = -T->omega * mass * Gx[i];
    }
    solve(T);
    for (size_t i = 0; i < n; i++) {
        y[i] = T->f.re[i];
        y[n + i] = x[i] + T->growth * T->f.re[i] - T->omega * T->f.im[i];
    }
}

/* Random start vectors: motions under random forces. */
static void draw(void *context, uint64_t *seed, double *x)
{
    shifted *T = context;
    const dmb_linear *linear = T->search->linear;
    const size_t n = linear->rows;
    for (size_t part = 0; part < 2; part++) {
        for (size_t i = 0; i < n; i++) {
            *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
            T->product[i] = (double)(*seed >> 11) * 0x1p-52 - 1.0;
        }
        dmb_linear_multiply(linear, &linear->mass, T->product, T->f.re);
        memset(T->f.im, 0, n * sizeof(double));
        solve(T);
        for (size_t i = 0; i < n; i++) x[n * part + i] = T->f.re[i] + T->f.im[i];
    }
}

static int32_t go_on_shifted(void *context)
{
    const shifted *T = context;
    return dmb_progress_pulse(T->search->linear->work);
}

/* x^H M w of two complex vectors */
static number form(const shifted *T, const double *x, const double *y, const double *w, const double *v)
{
    const dmb_linear *linear = T->search->linear;
    const size_t n = linear->rows;
    dmb_linear_multiply(linear, &linear->mass, w, T->f.re);
    dmb_linear_multiply(linear, &linear->mass, v, T->f.im);
    return dmb_dot(n, x, T->f.re) + dmb_dot(n, y, T->f.im) +
           (dmb_dot(n, x, T->f.im) - dmb_dot(n, y, T->f.re)) * (number)_Complex_I;
}

static number root_of(const shifted *T, const dmb_krylov *found, uint32_t k)
{
    const size_t n = T->search->linear->rows;
    const double *x = found->x + 2 * n * k, *y = found->y + 2 * n * k;
    const number value = found->re[k] + found->im[k] * (number)_Complex_I;
    const number told = form(T, x, y, x + n, y + n) / form(T, x, y, x, y);
    const number root = csqrt(1.0 - 4.0 * value * value * T->omega * T->omega);
    const number a = T->growth + (1.0 + root) / (2.0 * value), b = T->growth + (1.0 - root) / (2.0 * value);
    return cabs(a - told) < cabs(b - told) ? a : b;
}

static int32_t take(shifted *T, const dmb_krylov *found)
{
    dmb_mode_search *search = T->search;
    const size_t n = search->linear->rows;
    int32_t status = DMB_OK;
    for (uint32_t k = 0; k < found->count && status >= 0; k++) {
        const number s = root_of(T, found, k);
        double *x = found->x + 2 * n * k, *y = found->y + 2 * n * k;
        for (size_t i = 0; i < n && cimag(s) < 0.0; i++) y[i] = -y[i]; /* its conjugate */
        status = dmb_modes_add_root(search, creal(s), found->im[k] > 0.0 ? fabs(cimag(s)) : 0.0, x, y);
    }
    return status;
}

static int32_t find_about(shifted *T, uint32_t wanted, double *least)
{
    const dmb_linear *linear = T->search->linear;
    dmb_operator operator;
    dmb_krylov found;
    memset(&operator, 0, sizeof operator);
    operator.context = T;
    operator.length = 2 *(size_t) linear->rows;
    operator.dimension = 2 *((size_t)linear->coordinates - (T->search->apart ? (size_t)T->search->rigid_count : 0));
    operator.partly = 1;
    operator.metric = metric;
    operator.apply = apply;
    operator.draw = draw;
    operator.go_on = go_on_shifted;
    int32_t status = dmb_krylov_largest(&operator, wanted, 4, DMB_SHIFTED_TOLERANCE, &linear->allocator, &found);
    if (status < 0) return status;
    *least = found.applications >= operator.dimension && found.count<wanted
                 ? 0.0
                 : hypot(found.re[found.count - 1], found.im[found.count - 1]);
    T->search->modes->info.solves += found.applications;
    status = take(T, &found);
    dmb_krylov_release(&found);
    return status;
}

int32_t dmb_modes_shifted(dmb_mode_search *search, double *growth, double omega, double aside, uint32_t wanted,
                          double *least)
{
    const size_t n = search->linear->rows, bytes = 3 * n * sizeof(double);
    shifted T = {.search = search, .omega = omega, .scale = fmax(hypot(*growth, omega), aside)};
    double *block = dmb_allocate(&search->linear->allocator, bytes);
    if (block == NULL) return DMB_ERR_NO_MEMORY;
    T.f = (dmb_complex_array){block, block + n};
    T.product = block + 2 * n;
    int32_t status = dmb_dynamic_stiffness_make(search->linear, 0.0, &T.stiffness);
    int64_t bad = status < 0 ? -1 : 0;
    for (int i = 0; i < 3 && bad >= 0; i++) { /* a shift may hit a root */
        T.growth = *growth + i * aside;
        bad = dmb_dynamic_stiffness_factor_at(&T.stiffness, T.growth, omega);
    }
    *growth = T.growth;
    if (status >= 0) status = bad < 0 ? find_about(&T, wanted, least) : DMB_ERR_NO_CONVERGENCE;
    dmb_dynamic_stiffness_release(&T.stiffness);
    dmb_release(&search->linear->allocator, block, bytes);
    return status;
}
