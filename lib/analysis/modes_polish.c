/* A mode sharper than the subspace gave it, by inverse iteration at p next to its root (Ruhe 1973):
 *
 *     general:    Q(p) y = Q'(s) x,   Q(s) = s^2 M + s C + K,   and s from y^H Q(s) y = 0
 *     symmetric:  (K - p M) y = M x,  and s^2 from Rayleigh's quotient
 *
 * Each turn takes |s - p| over the distance to the next root off the error. */
#include <complex.h>
#include <math.h>
#include <string.h>

#include "analysis/dynamic_stiffness.h"
#include "analysis/modes.h"
#include "base/allocator.h"
#include "math/dot.h"

/* How far p is from the root, for pivots; and turns at most. */
#define DMB_POLISH_ASIDE 1e-7
enum { DMB_POLISH_TURNS = 3 };

typedef double complex number;

static number number_of(double re, double im)
{
    return re + im * (number)_Complex_I;
}

typedef struct polish {
    dmb_mode_search *search;
    dmb_dynamic_stiffness stiffness;
    dmb_complex_array x, f; /* shape (rows) */
    double *product;        /* shape (2 rows) */
} polish;

/* x^H A x */
static number form(const polish *p, const dmb_linear_matrix *A)
{
    const dmb_linear *linear = p->search->linear;
    const size_t n = linear->rows;
    double *re = p->product, *im = re + n;
    dmb_linear_multiply(linear, A, p->x.re, re);
    dmb_linear_multiply(linear, A, p->x.im, im);
    return number_of(dmb_dot(n, p->x.re, re) + dmb_dot(n, p->x.im, im),
                     dmb_dot(n, p->x.re, im) - dmb_dot(n, p->x.im, re));
}

/* f += factor A x */
static void add_forces(const polish *p, const dmb_linear_matrix *A, number factor)
{
    const dmb_linear *linear = p->search->linear;
    const size_t n = linear->rows;
    double *re = p->product, *im = re + n;
    dmb_linear_multiply(linear, A, p->x.re, re);
    dmb_linear_multiply(linear, A, p->x.im, im);
    for (size_t i = 0; i < n; i++) {
        p->f.re[i] += creal(factor) * re[i] - cimag(factor) * im[i];
        p->f.im[i] += creal(factor) * im[i] + cimag(factor) * re[i];
    }
}

/* The root of y^H Q(s) y that is next to s. */
static number root_next_to(const polish *p, number s)
{
    const dmb_linear *linear = p->search->linear;
    const number m = form(p, &linear->mass), c = form(p, &linear->damping), k = form(p, &linear->stiffness);
    const number half = -0.5 * c / m, away = csqrt(half * half - k / m);
    const number a = half + away, b = half - away;
    return cabs(a - s) < cabs(b - s) ? a : b;
}

static int turn(polish *p, number s)
{
    const dmb_linear *linear = p->search->linear;
    const size_t bytes = linear->rows * sizeof(double);
    const number at = s * (1.0 + DMB_POLISH_ASIDE);
    double most = 0.0;
    if (dmb_dynamic_stiffness_factor_at(&p->stiffness, creal(at), cimag(at)) >= 0) return 0;
    memset(p->f.re, 0, bytes);
    memset(p->f.im, 0, bytes);
    add_forces(p, &linear->mass, 2.0 * s);
    add_forces(p, &linear->damping, 1.0);
    memcpy(p->x.re, p->f.re, bytes);
    memcpy(p->x.im, p->f.im, bytes);
    dmb_dynamic_stiffness_solve(&p->stiffness, 0, p->x);
    for (uint32_t i = 0; i < linear->rows; i++) most = fmax(most, hypot(p->x.re[i], p->x.im[i]));
    if (!(most > 0.0) || !isfinite(most)) return 0;
    for (uint32_t i = 0; i < linear->rows; i++) {
        p->x.re[i] /= most;
        p->x.im[i] /= most;
    }
    return 1;
}

static void sharpen_general(polish *p, uint32_t k)
{
    dmb_modes *modes = p->search->modes;
    const size_t rows = modes->rows, bytes = rows * sizeof(double);
    number s = number_of(modes->s[2 * (size_t)k], modes->s[2 * (size_t)k + 1]);
    const int real = cimag(s) == 0.0;
    memcpy(p->x.re, modes->re + rows * k, bytes);
    memcpy(p->x.im, modes->im + rows * k, bytes);
    for (int i = 0; i < DMB_POLISH_TURNS; i++) {
        if (!turn(p, s)) return;
        if (real) memset(p->x.im, 0, bytes);
        s = root_next_to(p, s);
        if (real ? cimag(s) != 0.0 : !(cimag(s) > 0.0)) return;
        dmb_modes_put(p->search, k, creal(s), cimag(s), p->x.re, real ? NULL : p->x.im);
        const dmb_mode_defect defect = dmb_modes_defect(p->search, k);
        if (defect.value <= defect.bound) return;
    }
}

static void sharpen_symmetric(polish *p, uint32_t k)
{
    dmb_mode_search *search = p->search;
    dmb_linear *linear = search->linear;
    const dmb_modes *modes = search->modes;
    const size_t rows = modes->rows;
    double *x = p->x.re, *Ax = p->product;
    memcpy(x, modes->re + rows * k, rows * sizeof(double));
    for (int i = 0; i < DMB_POLISH_TURNS; i++) {
        const double size = dmb_modes_size(modes, k),
                     square = modes->s[2 * (size_t)k] > 0.0 ? -size * size : size * size;
        if (dmb_linear_factor(linear, 1.0, 0.0, -square * (1.0 + DMB_POLISH_ASIDE), NULL) >= 0) return;
        dmb_linear_multiply(linear, &linear->mass, x, Ax);
        memcpy(x, Ax, rows * sizeof(double));
        dmb_linear_solve(linear, x);
        dmb_modes_take_rigid(search, search->rigid_momentum, search->rigid, x);
        dmb_linear_multiply(linear, &linear->mass, x, Ax);
        const double mass = dmb_dot(rows, x, Ax);
        if (!(mass > 0.0) || !isfinite(mass)) return;
        for (size_t r = 0; r < rows; r++) x[r] /= sqrt(mass);
        dmb_linear_multiply(linear, &linear->stiffness, x, Ax);
        dmb_modes_put_square(search, k, dmb_dot(rows, x, Ax), x);
        const dmb_mode_defect defect = dmb_modes_defect(search, k);
        if (defect.value <= defect.bound) return;
    }
}

int32_t dmb_modes_polish(dmb_mode_search *search)
{
    const size_t rows = search->linear->rows, bytes = 6 * rows * sizeof(double);
    polish p = {.search = search};
    double *block = NULL;
    int32_t status = DMB_OK;
    for (uint32_t k = 0; k < search->modes->count && status >= 0; k++) {
        dmb_progress_at(search->linear->work, 0.8 + 0.2 * k / search->modes->count);
        status = dmb_progress_pulse(search->linear->work);
        if (status < 0) break;
        const dmb_mode_defect defect = dmb_modes_defect(search, k);
        if (search->modes->rigid[k] || defect.value <= defect.bound) continue;
        if (block == NULL) {
            block = dmb_allocate(&search->linear->allocator, bytes);
            status = block != NULL ? DMB_OK : DMB_ERR_NO_MEMORY;
            if (status >= 0 && search->general) status = dmb_dynamic_stiffness_make(search->linear, 0.0, &p.stiffness);
            p.x = (dmb_complex_array){block, block + rows};
            p.f = (dmb_complex_array){block + 2 * rows, block + 3 * rows};
            p.product = block + 4 * rows;
        }
        if (status >= 0) (search->general ? sharpen_general : sharpen_symmetric)(&p, k);
    }
    dmb_dynamic_stiffness_release(&p.stiffness);
    if (block != NULL) dmb_release(&search->linear->allocator, block, bytes);
    return status;
}
