/* Roots of the general problem nearest a complex shift p = g + i w, in real numbers: with A as in modes_sparse,
 *
 *     T = Re (A - p)^-1,   value = ((s - p)^-1 + (s - p*)^-1)/2 = t/(t^2 + w^2),   t = s - g,
 *
 * has the eigenvectors (x; s x) of A (Parlett, Saad 1987), and its largest values are those of the roots next to p and
 * p*. t = (1 +- sqrt(1 - 4 value^2 w^2))/(2 value): the one that x . M (s x) tells. */
#include <complex.h>
#include <math.h>
#include <string.h>

#include "analysis/dynamic_stiffness.h"
#include "analysis/modes.h"
#include "base/allocator.h"
#include "math/dot.h"
#include "math/krylov.h"

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
    return 1.0 / cabs(omega > 0.0 ? t + omega * omega / t : t);
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
    dmb_modes_take_rigid(s, s->rigid, s->rigid_momentum, T->f.re);
    dmb_modes_take_rigid(s, s->rigid, s->rigid_momentum, T->f.im);
    dmb_dynamic_stiffness_solve(&T->stiffness, 0, T->f);
    dmb_modes_take_rigid(s, s->rigid_momentum, s->rigid, T->f.re);
    dmb_modes_take_rigid(s, s->rigid_momentum, s->rigid, T->f.im);
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

/* Motions that random forces give. */
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

static int32_t go_on(void *context)
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
        double *x = found->x + 2 * n * k, *y = found->y + 2 * n * k, im = cimag(s);
        const int real = !(found->im[k] > 0.0);
        for (size_t i = 0; i < n && im < 0.0; i++) y[i] = -y[i]; /* its conjugate */
        im = real ? 0.0 : fabs(im);
        if (search->options->kind == DMB_MODES_UNDAMPED && real && creal(s) < 0.0) continue;
        if (dmb_modes_is_rigid_root(search, creal(s), im, x, real ? NULL : y)) continue;
        status = dmb_modes_add(search, creal(s), im, x, real ? NULL : y);
    }
    return status;
}

static int32_t run(shifted *T, uint32_t wanted, double *least)
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
    operator.go_on = go_on;
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

int32_t dmb_modes_shifted(dmb_mode_search *search, double *growth, double omega, uint32_t wanted, double *least)
{
    const size_t n = search->linear->rows, bytes = 3 * n * sizeof(double);
    shifted T = {.search = search, .omega = omega, .scale = fmax(hypot(*growth, omega), 1e-3)};
    double *block = dmb_allocate(&search->linear->allocator, bytes);
    if (block == NULL) return DMB_ERR_NO_MEMORY;
    T.f = (dmb_complex_array){block, block + n};
    T.product = block + 2 * n;
    int32_t status = dmb_dynamic_stiffness_make(search->linear, 0.0, &T.stiffness);
    int64_t bad = status < 0 ? -1 : 0;
    for (int i = 0; i < 3 && bad >= 0; i++) { /* a shift may hit a root */
        T.growth = *growth + 1e-3 * i * T.scale;
        bad = dmb_dynamic_stiffness_factor_at(&T.stiffness, T.growth, omega);
    }
    *growth = T.growth;
    if (status >= 0) status = bad < 0 ? run(&T, wanted, least) : DMB_ERR_SINGULAR;
    dmb_dynamic_stiffness_release(&T.stiffness);
    dmb_release(&search->linear->allocator, block, bytes);
    return status;
}
