/* Residual of modes in their equations, and its reduction by inverse iteration. */
#include <complex.h>
#include <float.h>
#include <math.h>
#include <string.h>

#include "analysis/linear/linear.h"
#include "analysis/modes/modes.h"
#include "base/memory.h"
#include "math/dense.h"
#include "math/real.h"
#include "sim/access.h"

/* Largest residual of a computed mode: fraction of the forces in its equation, plus a multiple of the rounding of their
 * terms. */
#define DMB_MODE_CONVERGED 1e-10
#define DMB_MODE_ROUNDING 1024.0
/* Modes above this fraction of the bound are refined too: their residual in the norm of dmb_modes_residual may be
 * larger. */
#define DMB_MODE_SHARP 0.1

typedef struct complex_rows {
    double *re, *im, *product;
} complex_rows;

/* out += (a + i b) A d, d real or imaginary */
static void add_product(const dmb_linear *linear, const dmb_linear_matrix *A, const double factor[2], const double *d,
                        int imaginary, const complex_rows *out)
{
    const double a = factor[0], b = factor[1];
    dmb_linear_multiply(linear, A, d, out->product);
    for (uint32_t i = 0; i < linear->rows; i++) {
        out->re[i] += (imaginary ? -b : a) * out->product[i];
        out->im[i] += (imaginary ? a : b) * out->product[i];
    }
}

/* Square of the norm of (|K_ii| + |s|^2 M_ii) x_i: the size of the forces that balance in the equations of a mode, by
 * the diagonals. A stiffness below the rounding of the largest one (dmb_linear_stiffness_at_least) counts as that: its
 * row can hold no smaller residual. */
static double norm_of_terms(const dmb_linear *linear, const double *x, double square)
{
    const dmb_block_layout *layout = &linear->scene.layout;
    const double least = dmb_linear_stiffness_at_least(linear);
    double sum = 0.0;
    for (uint32_t i = 0; i < layout->n; i++)
        for (uint32_t c = 0; c < layout->size[i]; c++) {
            const double k = fmax(linear->stiffness_size[layout->row[i] + c], least * dmb_linear_weight(linear, i, c));
            const double m = dmb_linear_diagonal(linear, &linear->mass, i, c), z = x[layout->row[i] + c];
            sum += (k + square * m) * (k + square * m) * z * z;
        }
    return sum;
}

/* |R^T (K + s C + s^2 M) d| over the norm of its terms, d = x + i y with real matrices: products with x and y are added
 * to real and imaginary part with the factor of their matrix. */
double dmb_modes_residual(const dmb_mode_search *search, uint32_t k)
{
    const dmb_linear *linear = search->linear;
    const size_t rows = linear->rows;
    const complex_rows out = {search->work, search->work + rows, search->work + 2 * rows};
    const double *s = search->modes->s + 2 * (size_t)k;
    const double one[2] = {1.0, 0.0}, square[2] = {s[0] * s[0] - s[1] * s[1], 2.0 * s[0] * s[1]};
    double left = 0.0, terms = 0.0;
    memset(out.re, 0, 2 * rows * sizeof(double));
    for (int imaginary = 0; imaginary < (search->modes->im != NULL ? 2 : 1); imaginary++) {
        const double *d = (imaginary ? search->modes->im : search->modes->re) + rows * k;
        add_product(linear, &linear->stiffness, one, d, imaginary, &out);
        add_product(linear, &linear->mass, square, d, imaginary, &out);
        if (search->options->kind == DMB_MODES_DAMPED) add_product(linear, &linear->damping, s, d, imaginary, &out);
        terms += norm_of_terms(linear, d, s[0] * s[0] + s[1] * s[1]);
    }
    for (int imaginary = 0; imaginary < 2; imaginary++) {
        double *g = search->work + 3 * rows;
        dmb_linear_restrict(linear, imaginary ? out.im : out.re, g);
        left += dmb_dot(linear->coordinates, g, g);
    }
    return terms > 0.0 ? sqrt(left / terms) : 0.0;
}

/* ---- Check of a mode --------------------------------------------------------------------------------------------- */

/* Norm of forces by rows, on the coordinates and over the root of the mass of each, so that forces and moments are
 * comparable: for an undamped mode with x^T M x = 1 the norm of M x is about 1, that of K x about its eigenvalue. */
static double norm_of(const dmb_mode_search *search, const double *re, const double *im, int terms)
{
    const dmb_linear *linear = search->linear;
    double *g = search->work + 8 * (size_t)linear->rows, sum = 0.0;
    for (int part = 0; part < (im != NULL ? 2 : 1); part++) {
        (terms ? dmb_linear_restrict_terms : dmb_linear_restrict)(linear, part ? im : re, g);
        for (uint32_t i = 0; i < linear->coordinates; i++)
            if (search->coordinate_mass[i] > 0.0) sum += g[i] * g[i] / search->coordinate_mass[i];
    }
    return sqrt(sum);
}

/* Diagonal of R^T M R, without couplings between the nodes of a joint. */
void dmb_modes_weigh_coordinates(const dmb_mode_search *search)
{
    const dmb_linear *linear = search->linear;
    const dmb_block_layout *layout = &linear->scene.layout;
    memset(search->coordinate_mass, 0, linear->coordinates * sizeof(double));
    for (uint32_t n = 0; n < layout->n; n++)
        for (uint32_t c = 0; c < layout->size[n]; c++) {
            const double m = fabs(dmb_linear_diagonal(linear, &linear->mass, n, c));
            const uint32_t row = layout->row[n] + c;
            for (uint32_t i = linear->start[row]; i < linear->start[row + 1]; i++)
                search->coordinate_mass[linear->column[i]] += linear->value[i] * linear->value[i] * m;
        }
}

/* sum |A_ij| |x_j| by rows, added to `to` with a factor */
static void add_segments(const dmb_linear *linear, const dmb_linear_matrix *A, double factor, const double *x,
                         double *y, double *to)
{
    dmb_linear_terms(linear, A, x, y);
    for (uint32_t i = 0; i < linear->rows; i++) to[i] += factor * y[i];
}

/* Matrices and factors of K, s^2 M and s C; without damping the last one is NULL. */
typedef struct equation_terms {
    const dmb_linear_matrix *matrix[3];
    double factor[3][2];
} equation_terms;

static equation_terms terms_of(const dmb_mode_search *search, uint32_t k)
{
    const dmb_linear *linear = search->linear;
    const double *s = search->modes->s + 2 * (size_t)k;
    const int damped = search->options->kind == DMB_MODES_DAMPED;
    return (equation_terms){{&linear->stiffness, &linear->mass, damped ? &linear->damping : NULL},
                            {{1.0, 0.0}, {s[0] * s[0] - s[1] * s[1], 2.0 * s[0] * s[1]}, {s[0], s[1]}}};
}

/* Norm of the sum of the terms of mode k; *forces: the sum of their norms. */
static double imbalance_of(const dmb_mode_search *search, uint32_t k, double *forces)
{
    const dmb_linear *linear = search->linear;
    const dmb_modes *modes = search->modes;
    const size_t rows = linear->rows;
    const equation_terms t = terms_of(search, k);
    double *left = search->work + 3 * rows, *one = left + 2 * rows;
    const complex_rows out = {one, one + rows, search->work};
    *forces = 0.0;
    memset(left, 0, 2 * rows * sizeof(double));
    for (int m = 0; m < 3; m++) {
        if (t.matrix[m] == NULL) continue;
        memset(one, 0, 2 * rows * sizeof(double));
        for (int part = 0; part < (modes->im != NULL ? 2 : 1); part++)
            add_product(linear, t.matrix[m], t.factor[m], (part ? modes->im : modes->re) + rows * k, part, &out);
        for (size_t i = 0; i < 2 * rows; i++) left[i] += one[i];
        *forces += norm_of(search, one, one + rows, 0);
    }
    return norm_of(search, left, left + rows, 0);
}

/* Rounding of the terms of mode k, as a norm of forces. */
static double rounding_of(const dmb_mode_search *search, uint32_t k)
{
    const dmb_linear *linear = search->linear;
    const dmb_modes *modes = search->modes;
    const size_t rows = linear->rows;
    const equation_terms t = terms_of(search, k);
    double *terms = search->work, *one = search->work + 5 * rows;
    memset(terms, 0, rows * sizeof(double));
    for (int m = 0; m < 3; m++)
        for (int part = 0; part < (modes->im != NULL ? 2 : 1) && t.matrix[m] != NULL; part++)
            add_segments(linear, t.matrix[m], hypot(t.factor[m][0], t.factor[m][1]),
                         (part ? modes->im : modes->re) + rows * k, one, terms);
    return DBL_EPSILON * norm_of(search, terms, NULL, 1) + (modes->info.dense ? search->noise : 0.0);
}

dmb_mode_defect dmb_modes_defect(const dmb_mode_search *search, uint32_t k)
{
    double forces;
    const double left = imbalance_of(search, k, &forces), rounding = rounding_of(search, k);
    if (!(forces > 0.0)) return (dmb_mode_defect){0.0, DMB_MODE_CONVERGED};
    return (dmb_mode_defect){left / forces, DMB_MODE_CONVERGED + DMB_MODE_ROUNDING * rounding / forces};
}

/* 1: the residual of mode k is far below its bound; the rounding, which is long to compute, decides only if necessary.
 */
static int is_sharp(const dmb_mode_search *search, uint32_t k)
{
    double forces;
    const double left = imbalance_of(search, k, &forces);
    if (left <= DMB_MODE_SHARP * DMB_MODE_CONVERGED * forces) return 1;
    const dmb_mode_defect defect = dmb_modes_defect(search, k);
    return defect.value <= DMB_MODE_SHARP * defect.bound;
}

/* ---- Refusal ----------------------------------------------------------------------------------------------------- */

/* If forces are at the rounding level, the strain energy may still determine the root: with d^H M d = 1 and e twice its
 * energy, s^2 + s d^H C d + e = 0, unless most of the stiffness is not of strain. */
#define DMB_ENERGY_TELLS 0.5

static int energy_decides(const dmb_mode_search *search, uint32_t k)
{
    const dmb_linear *linear = search->linear;
    const dmb_modes *modes = search->modes;
    const size_t rows = linear->rows;
    double *x = modes->re + rows * k, *y = modes->im != NULL ? modes->im + rows * k : NULL;
    double *Cx = search->work, *Cy = Cx + rows, c[2] = {0.0, 0.0};
    const double *s = modes->s + 2 * (size_t)k;
    if (search->options->kind == DMB_MODES_DAMPED) {
        dmb_linear_multiply(linear, &linear->damping, x, Cx);
        c[0] = dmb_dot(rows, x, Cx);
        if (y != NULL) {
            dmb_linear_multiply(linear, &linear->damping, y, Cy);
            c[0] += dmb_dot(rows, y, Cy);
            c[1] = dmb_dot(rows, x, Cy) - dmb_dot(rows, y, Cx);
        }
    }
    const double e =
        dmb_modes_twice_strain_energy(modes, x) + (y != NULL ? dmb_modes_twice_strain_energy(modes, y) : 0.0);
    const double re = s[0] * s[0] - s[1] * s[1] + s[0] * c[0] - s[1] * c[1] + e;
    const double im = 2.0 * s[0] * s[1] + s[0] * c[1] + s[1] * c[0];
    const double size = hypot(s[0], s[1]);
    return hypot(re, im) <= DMB_ENERGY_TELLS * (size * size + size * hypot(c[0], c[1]) + e);
}

/* A mode is accepted only if its equations balance to rounding, and only if its forces exceed rounding. 0, with a
 * message, if mode k is refused. */
static int is_mode(const dmb_mode_search *search, uint32_t k)
{
    const double frequency = dmb_modes_size(search->modes, k) / DMB_TWO_PI;
    const dmb_mode_defect defect = dmb_modes_defect(search, k);
    if (!(defect.value <= defect.bound)) {
        dmb_message_set(
            search->message,
            "modes: mode %u of %g Hz was not found sharply: residual = %g of the forces that balance in it, "
            "must be <= %g: ask for fewer modes, another band, or all of them",
            k, frequency, defect.value, defect.bound);
        return 0;
    }
    if (defect.bound < 1.0 || energy_decides(search, k)) return 1;
    dmb_message_set(
        search->message,
        "modes: mode %u of %g Hz cannot be distinguished from a rigid-body motion: rounding is %g of its forces, must "
        "be < 1: support parts that move freely, soften the stiffest one, or choose a band above it",
        k, frequency, defect.bound);
    return 0;
}

/* Of the lowest modes, those before the first refused one are a result (DMB_NOTE_INCOMPLETE): none below them is
 * missing. Of a band or a neighbourhood every one may be the one that is wanted, and the analysis fails. */
int32_t dmb_modes_check(dmb_mode_search *search)
{
    dmb_modes *modes = search->modes;
    const int lowest = search->options->select == DMB_MODES_LOWEST;
    const uint32_t count = modes->count;
    for (uint32_t k = 0; k < count; k++) {
        if (modes->rigid[k] || is_mode(search, k)) continue;
        if (!lowest || k <= search->rigid_count) return DMB_ERR_NO_CONVERGENCE;
        modes->count = k;
        break;
    }
    if (modes->count == count && search->crowded == 0.0) return DMB_OK;
    if (modes->count == count)
        dmb_message_set(search->message,
                        "modes: the %u lowest of %u modes are returned: the roots beyond them crowd near %g Hz and did "
                        "not converge (overdamped motions have such roots near 1/(2 pi damping_time)): ask for at "
                        "most %u modes, or for a band",
                        modes->count, search->options->count, search->crowded / DMB_TWO_PI, modes->count);
    return DMB_NOTE_INCOMPLETE;
}

/* Refinement of a mode by inverse iteration at p next to its root (Ruhe 1973; eq:modes.refine):
 *
 *     general:    Q(p) y = Q'(s) x,   Q(s) = s^2 M + s C + K,   and s from y^H Q(s) y = 0
 *     symmetric:  (K - p M) y = M x,  and s^2 from the Rayleigh quotient
 *
 * Each iteration multiplies the error by |s - p| over the distance to the next root. Rounding of the solution, mostly
 * in stiff motions, is reduced by one step of iterative refinement, which does not change x itself. */

/* Relative distance of p from the root, which keeps pivots regular; and the largest number of iterations. */
#define DMB_REFINE_ASIDE 1e-7
enum { DMB_REFINE_TURNS = 3 };

typedef double complex number;

static number number_of(double re, double im)
{
    return re + im * (number)_Complex_I;
}

typedef struct refinement {
    dmb_mode_search *search;
    dmb_dynamic_stiffness stiffness;
    dmb_complex_array x, f; /* shape (rows) */
    double *product;        /* shape (2 rows) */
} refinement;

/* x^H A x */
static number form(const refinement *p, const dmb_linear_matrix *A)
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
static void add_forces(const refinement *p, const dmb_linear_matrix *A, number factor)
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

/* Root of y^H Q(s) y nearest to s: m s^2 + c s + k = 0, m = y^H M y and so on, has half +- sqrt(half^2 - k/m), half =
 * -c/(2 m). */
static number root_next_to(const refinement *p, number s)
{
    const dmb_linear *linear = p->search->linear;
    const number m = form(p, &linear->mass), c = form(p, &linear->damping), k = form(p, &linear->stiffness);
    const number half = -0.5 * c / m, away = csqrt(half * half - k / m);
    const number a = half + away, b = half - away;
    return cabs(a - s) < cabs(b - s) ? a : b;
}

/* One inverse iteration, y = Q(p)^-1 Q'(s) x with Q'(s) = 2 s M + C, by which the error of x goes down with the
 * distance |p - s| although Q is quadratic in s (Ruhe 1973). Scaled to a largest component of 1, since Q(p) is nearly
 * singular and y as long as 1/|p - s|. 0: p is singular, or y is not finite; the mode stays as it was. */
static int turn(refinement *p, number s)
{
    const dmb_linear *linear = p->search->linear;
    const size_t bytes = linear->rows * sizeof(double);
    const number at = s * (1.0 + DMB_REFINE_ASIDE);
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

/* Reduces rounding of the solution, mostly in stiff motions: x -= (I - x x^H M/(x^H M x)) Q(at)^-1 Q(s) x. The inverse
 * blows up the part of the residual along the mode itself, which is no error of the shape: the projector removes it. */
static void correct_general(refinement *p, number s)
{
    const dmb_linear *linear = p->search->linear;
    const size_t n = linear->rows;
    const double *Mx = p->product, *My = p->product + n;
    memset(p->f.re, 0, n * sizeof(double));
    memset(p->f.im, 0, n * sizeof(double));
    add_forces(p, &linear->stiffness, 1.0);
    add_forces(p, &linear->damping, s);
    add_forces(p, &linear->mass, s * s);
    dmb_dynamic_stiffness_solve(&p->stiffness, 0, p->f);
    const number mass = form(p, &linear->mass); /* M x stays in product */
    const number along = number_of(dmb_dot(n, Mx, p->f.re) + dmb_dot(n, My, p->f.im),
                                   dmb_dot(n, Mx, p->f.im) - dmb_dot(n, My, p->f.re)) /
                         mass;
    for (size_t i = 0; i < n; i++) {
        const number x = number_of(p->x.re[i], p->x.im[i]), change = number_of(p->f.re[i], p->f.im[i]) - along * x;
        p->x.re[i] -= creal(change);
        p->x.im[i] -= cimag(change);
    }
}

/* A real root keeps a real shape: the imaginary part that rounding leaves is cleared in each turn. If the root leaves
 * its kind, real or complex, the iteration has gone to another mode, and the mode is left as it was. */
static void refine_general(refinement *p, uint32_t k)
{
    dmb_modes *modes = p->search->modes;
    const size_t rows = modes->rows, bytes = rows * sizeof(double);
    number s = number_of(modes->s[2 * (size_t)k], modes->s[2 * (size_t)k + 1]);
    const int real = cimag(s) == 0.0;
    memcpy(p->x.re, modes->re + rows * k, bytes);
    memcpy(p->x.im, modes->im + rows * k, bytes);
    for (int i = 0; i < DMB_REFINE_TURNS; i++) {
        if (!turn(p, s)) return;
        if (real) memset(p->x.im, 0, bytes);
        s = root_next_to(p, s);
        correct_general(p, s);
        if (real) memset(p->x.im, 0, bytes);
        s = root_next_to(p, s);
        if (real ? cimag(s) != 0.0 : !(cimag(s) > 0.0)) return;
        dmb_modes_put(p->search, k, creal(s), cimag(s), p->x.re, real ? NULL : p->x.im);
        const dmb_mode_defect defect = dmb_modes_defect(p->search, k);
        if (defect.value <= defect.bound) return;
    }
}

/* Divides x by its length in M; 0 if that is not positive and finite. */
static int set_length(const dmb_linear *linear, double *x, double *Mx)
{
    const size_t rows = linear->rows;
    dmb_linear_multiply(linear, &linear->mass, x, Mx);
    const double mass = dmb_dot(rows, x, Mx);
    if (!(mass > 0.0) || !isfinite(mass)) return 0;
    for (size_t r = 0; r < rows; r++) x[r] /= sqrt(mass);
    return 1;
}

/* Reduces rounding of the solution, mostly in stiff motions, by a correction of the residual: x -= (I - x x^T M) (K - p
 * M)^-1 (K - s M) x, s the Rayleigh quotient. */
static void correct(const refinement *p, double *x)
{
    const dmb_mode_search *search = p->search;
    dmb_linear *linear = search->linear;
    const size_t rows = linear->rows;
    double *Kx = p->product, *Mx = p->product + rows;
    dmb_linear_multiply(linear, &linear->stiffness, x, Kx);
    dmb_linear_multiply(linear, &linear->mass, x, Mx);
    const double square = dmb_dot(rows, x, Kx);
    for (size_t r = 0; r < rows; r++) Kx[r] -= square * Mx[r];
    dmb_modes_add_rigid(search, search->rigid, search->rigid_momentum, Kx);
    dmb_linear_solve(linear, Kx);
    dmb_modes_add_rigid(search, search->rigid_momentum, search->rigid, Kx);
    const double along = dmb_dot(rows, Mx, Kx);
    for (size_t r = 0; r < rows; r++) x[r] -= Kx[r] - along * x[r];
}

static void refine_symmetric(refinement *p, uint32_t k)
{
    dmb_mode_search *search = p->search;
    dmb_linear *linear = search->linear;
    const dmb_modes *modes = search->modes;
    const size_t rows = modes->rows;
    double *x = p->x.re, *Ax = p->product;
    memcpy(x, modes->re + rows * k, rows * sizeof(double));
    for (int i = 0; i < DMB_REFINE_TURNS; i++) {
        const double size = dmb_modes_size(modes, k),
                     square = modes->s[2 * (size_t)k] > 0.0 ? -size * size : size * size;
        if (dmb_linear_factor(linear, 1.0, 0.0, -square * (1.0 + DMB_REFINE_ASIDE), NULL) >= 0) return;
        dmb_linear_multiply(linear, &linear->mass, x, Ax);
        memcpy(x, Ax, rows * sizeof(double));
        dmb_linear_solve(linear, x);
        dmb_modes_add_rigid(search, search->rigid_momentum, search->rigid, x);
        if (!set_length(linear, x, Ax)) return;
        correct(p, x);
        if (!set_length(linear, x, Ax)) return;
        dmb_linear_multiply(linear, &linear->stiffness, x, Ax);
        dmb_modes_put_square(search, k, dmb_dot(rows, x, Ax), x);
        const dmb_mode_defect defect = dmb_modes_defect(search, k);
        if (defect.value <= defect.bound) return;
    }
}

int32_t dmb_modes_refine_shapes(dmb_mode_search *search)
{
    const size_t rows = search->linear->rows, bytes = 6 * rows * sizeof(double);
    refinement p = {.search = search};
    double *block = NULL;
    int32_t status = DMB_OK;
    for (uint32_t k = 0; k < search->modes->count && status >= 0; k++) {
        dmb_progress_at(search->linear->work, 0.8 + 0.2 * k / search->modes->count);
        status = dmb_progress_pulse(search->linear->work);
        if (status < 0) break;
        if (search->modes->rigid[k] || is_sharp(search, k)) continue;
        if (block == NULL) {
            block = dmb_allocate(&search->linear->allocator, bytes);
            status = block != NULL ? DMB_OK : DMB_ERR_NO_MEMORY;
            if (status >= 0 && search->general) status = dmb_dynamic_stiffness_make(search->linear, 0.0, &p.stiffness);
            p.x = (dmb_complex_array){block, block + rows};
            p.f = (dmb_complex_array){block + 2 * rows, block + 3 * rows};
            p.product = block + 4 * rows;
        }
        if (status >= 0) (search->general ? refine_general : refine_symmetric)(&p, k);
    }
    dmb_dynamic_stiffness_release(&p.stiffness);
    if (block != NULL) dmb_release(&search->linear->allocator, block, bytes);
    return status;
}
