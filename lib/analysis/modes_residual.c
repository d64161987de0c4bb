/* How well the modes satisfy their equations. */
#include <math.h>
#include <string.h>

#include "analysis/modes.h"
#include "math/dot.h"

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
    double sum = 0.0;
    for (uint32_t i = 0; i < layout->n; i++)
        for (uint32_t c = 0; c < layout->size[i]; c++) {
            const double k = fabs(dmb_linear_diagonal(linear, &linear->stiffness, i, c));
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
