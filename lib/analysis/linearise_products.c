/* Products with the matrices of a linear system. */
#include <math.h>
#include <string.h>

#include "analysis/linearise.h"
#include "math/dot.h"

static void add_joint_products(const dmb_scene *scene, const double *joints, const double *x, double *y)
{
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        const double *A = joints + c->tangent;
        double part[DMB_CONSTRAINT_COLUMNS];
        for (uint32_t k = 0; k < c->node_count; k++)
            memcpy(part + c->column[k], x + scene->layout.row[c->node[k]],
                   scene->layout.size[c->node[k]] * sizeof(double));
        for (uint32_t k = 0; k < c->node_count; k++)
            for (uint32_t r = 0; r < scene->layout.size[c->node[k]]; r++) {
                const double *row = A + (size_t)(c->column[k] + r) * c->columns;
                for (uint32_t s = 0; s < c->columns; s++) y[scene->layout.row[c->node[k]] + r] += row[s] * part[s];
            }
    }
}

void dmb_linear_multiply(const dmb_linear *linear, const dmb_linear_matrix *A, const double *x, double *y)
{
    const dmb_scene *scene = &linear->scene;
    const dmb_block_matrix blocks = {A->diagonal, A->lower, A->upper, NULL};
    for (uint32_t c = 0; c < scene->chain_count; c++)
        dmb_block_multiply(&scene->layout, &blocks, scene->chains[c].first, scene->chains[c].count, x, y);
    add_joint_products(scene, A->joints, x, y);
}

void dmb_linear_dense(const dmb_linear *linear, const dmb_linear_matrix *A, double *work, double *out)
{
    const size_t n = linear->coordinates, rows = linear->rows;
    double *x = work, *y = work + rows, *unit = work + 2 * rows;
    memset(unit, 0, n * sizeof(double));
    for (size_t i = 0; i < n; i++) {
        unit[i] = 1.0;
        dmb_linear_expand(linear, unit, x);
        dmb_linear_multiply(linear, A, x, y);
        dmb_linear_restrict(linear, y, out + n * i);
        unit[i] = 0.0;
    }
}

/* +-1 by a linear congruential generator, over the root of the diagonal; 0 where there is none. */
static void draw_signs(const dmb_linear *linear, const dmb_linear_matrix *A, uint64_t *seed, double *x)
{
    const dmb_block_layout *layout = &linear->scene.layout;
    for (uint32_t i = 0; i < layout->n; i++)
        for (uint32_t c = 0; c < layout->size[i]; c++) {
            const double size = fabs(A->diagonal[layout->diag[i] + (layout->size[i] + 1) * c]);
            *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
            x[layout->row[i] + c] = size > 0.0 ? ((*seed >> 40 & 1) != 0 ? 1.0 : -1.0) / sqrt(size) : 0.0;
        }
}

/* Signs on the coordinates, carried on to the rows that joints make dependent. */
static void draw(const dmb_linear *linear, const dmb_linear_matrix *A, uint64_t *seed, double *z, double *x)
{
    draw_signs(linear, A, seed, x);
    for (uint32_t i = 0; i < linear->coordinates; i++) z[i] = x[linear->row_of[i]];
    dmb_linear_expand(linear, z, x);
}

double dmb_linear_asymmetry(const dmb_linear *linear, const dmb_linear_matrix *A, double *work)
{
    const size_t rows = linear->rows;
    double *x = work, *y = x + rows, *product = y + rows, *z = product + rows, most = 0.0;
    uint64_t seed = 1;
    for (int k = 0; k < 4; k++) {
        draw(linear, A, &seed, z, x);
        draw(linear, A, &seed, z, y);
        dmb_linear_multiply(linear, A, y, product);
        const double one = dmb_dot(rows, x, product);
        dmb_linear_multiply(linear, A, x, product);
        most = fmax(most, fabs(one - dmb_dot(rows, y, product)));
    }
    return most / sqrt(1.0 + linear->coordinates);
}
