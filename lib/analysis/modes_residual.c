/* How well the modes satisfy their equations. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "analysis/modes.h"
#include "math/dot.h"

/* A mode that a search has found leaves this part of the forces that balance in it, and so many times the rounding of
 * their terms. */
#define DMB_MODE_CONVERGED 1e-10
#define DMB_MODE_ROUNDING 1024.0

/* out += (a + i b) A (x + i y), real and imaginary part */
typedef struct complex_rows {
    double *re, *im, *product;
} complex_rows;

static void add_product(const dmb_linear *linear, const dmb_linear_matrix *A, double a, double b, const double *d,
                        int imaginary, const complex_rows *out)
{
    dmb_linear_multiply(linear, A, d, out->product);
    for (uint32_t i = 0; i < linear->rows; i++) {
        out->re[i] += (imaginary ? -b : a) * out->product[i];
        out->im[i] += (imaginary ? a : b) * out->product[i];
    }
}

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

double dmb_modes_residual(const dmb_mode_search *search, uint32_t k)
{
    const dmb_linear *linear = search->linear;
    const size_t rows = linear->rows;
    const complex_rows out = {search->work, search->work + rows, search->work + 2 * rows};
    const double *s = search->modes->s + 2 * (size_t)k;
    double left = 0.0, terms = 0.0;
    memset(out.re, 0, 2 * rows * sizeof(double));
    for (int imaginary = 0; imaginary < (search->modes->im != NULL ? 2 : 1); imaginary++) {
        const double *d = (imaginary ? search->modes->im : search->modes->re) + rows * k;
        add_product(linear, &linear->stiffness, 1.0, 0.0, d, imaginary, &out);
        add_product(linear, &linear->mass, s[0] * s[0] - s[1] * s[1], 2.0 * s[0] * s[1], d, imaginary, &out);
        if (search->options->kind == DMB_MODES_DAMPED)
            add_product(linear, &linear->damping, s[0], s[1], d, imaginary, &out);
        terms += norm_of_terms(linear, d, s[0] * s[0] + s[1] * s[1]);
    }
    for (int imaginary = 0; imaginary < 2; imaginary++) {
        double *g = search->work + 3 * rows;
        dmb_linear_restrict(linear, imaginary ? out.im : out.re, g);
        left += dmb_dot(linear->coordinates, g, g);
    }
    return terms > 0.0 ? sqrt(left / terms) : 0.0;
}

/* ---- Whether a mode is one --------------------------------------------------------------------------------------- */

/* Of forces by rows, on the coordinates and over the root of the mass of each, so that forces and moments are of one
 * kind: for an undamped mode with x^T M x = 1 the norm of M x is about 1, that of K x about its eigenvalue. */
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

/* Diagonal of R^T M R, couplings between the nodes of a joint left out. */
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
static void add_terms(const dmb_linear *linear, const dmb_linear_matrix *A, double factor, const double *x, double *y,
                      double *to)
{
    dmb_linear_terms(linear, A, x, y);
    for (uint32_t i = 0; i < linear->rows; i++) to[i] += factor * y[i];
}

dmb_mode_defect dmb_modes_defect(const dmb_mode_search *search, uint32_t k)
{
    const dmb_linear *linear = search->linear;
    const dmb_modes *modes = search->modes;
    const size_t rows = linear->rows;
    const double *s = modes->s + 2 * (size_t)k;
    const int parts = modes->im != NULL ? 2 : 1, damped = search->options->kind == DMB_MODES_DAMPED;
    const dmb_linear_matrix *matrix[3] = {&linear->stiffness, &linear->mass, damped ? &linear->damping : NULL};
    const double factor[3][2] = {{1.0, 0.0}, {s[0] * s[0] - s[1] * s[1], 2.0 * s[0] * s[1]}, {s[0], s[1]}};
    double *left = search->work + 3 * rows, *one = left + 2 * rows, *terms = search->work;
    double forces = 0.0;
    memset(left, 0, 2 * rows * sizeof(double));
    for (int m = 0; m < 3; m++) {
        const complex_rows out = {one, one + rows, search->work};
        if (matrix[m] == NULL) continue;
        memset(one, 0, 2 * rows * sizeof(double));
        for (int part = 0; part < parts; part++)
            add_product(linear, matrix[m], factor[m][0], factor[m][1], (part ? modes->im : modes->re) + rows * k, part,
                        &out);
        for (size_t i = 0; i < 2 * rows; i++) left[i] += one[i];
        forces += norm_of(search, one, one + rows, 0);
    }
    dmb_mode_defect defect = {norm_of(search, left, left + rows, 0), 0.0};
    memset(terms, 0, rows * sizeof(double));
    for (int m = 0; m < 3; m++)
        for (int part = 0; part < parts && matrix[m] != NULL; part++)
            add_terms(linear, matrix[m], hypot(factor[m][0], factor[m][1]), (part ? modes->im : modes->re) + rows * k,
                      one, terms);
    double rounding = DBL_EPSILON * norm_of(search, terms, NULL, 1);
    if (modes->info.dense) rounding += search->noise;
    defect.value = forces > 0.0 ? defect.value / forces : 0.0;
    defect.bound = DMB_MODE_CONVERGED + (forces > 0.0 ? DMB_MODE_ROUNDING * rounding / forces : 0.0);
    return defect;
}

/* ---- Refusal ----------------------------------------------------------------------------------------------------- */

/* Where forces are rounding, the root may still be told by the strain: with d^H M d = 1 and e twice its energy,
 * s^2 + s d^H C d + e = 0, unless most of the stiffness is not of strain. */
#define DMB_ENERGY_TELLS 0.5

static int energy_tells(const dmb_mode_search *search, uint32_t k)
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

/* A mode is one only if its equations balance to rounding, and only where its forces are more than that. */
int32_t dmb_modes_check(dmb_mode_search *search)
{
    const dmb_modes *modes = search->modes;
    for (uint32_t k = 0; k < modes->count; k++) {
        const double frequency = dmb_modes_size(modes, k) / 6.283185307179586;
        if (modes->rigid[k]) continue;
        const dmb_mode_defect defect = dmb_modes_defect(search, k);
        if (!(defect.value <= defect.bound)) {
            dmb_message_set(
                search->message,
                "modes: mode %u of %g Hz was not found sharply: residual = %g of the forces that balance in it, "
                "must be <= %g: ask for fewer modes, another band, or all of them",
                k, frequency, defect.value, defect.bound);
            return DMB_ERR_NO_CONVERGENCE;
        }
        if (defect.bound < 1.0 || energy_tells(search, k)) continue;
        dmb_message_set(
            search->message,
            "modes: mode %u of %g Hz cannot be told from a rigid-body motion: rounding is %g of its forces, must be "
            "< 1: hold what may move freely, soften what is stiffest, or ask for a band above it",
            k, frequency, defect.bound);
        return DMB_ERR_NO_CONVERGENCE;
    }
    return DMB_OK;
}
