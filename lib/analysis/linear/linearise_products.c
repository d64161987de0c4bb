/* Products and factors of the matrices of a linear system. */
#include <math.h>
#include <string.h>

#include "analysis/linear/linearise.h"
#include "analysis/linear/stiffness.h"
#include "math/dense.h"
#include "math/inertia.h"
#include "system/solve/solve.h"

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

void dmb_linear_clear(const dmb_linear *linear, dmb_linear_matrix *A)
{
    const dmb_block_layout *layout = &linear->scene.layout;
    memset(A->diagonal, 0, layout->diag[layout->n] * sizeof(double));
    memset(A->lower, 0, layout->link[layout->n - 1] * sizeof(double));
    memset(A->upper, 0, layout->link[layout->n - 1] * sizeof(double));
    memset(A->joints, 0, linear->scene.tangent_count * sizeof(double));
}

void dmb_linear_multiply(const dmb_linear *linear, const dmb_linear_matrix *A, const double *x, double *y)
{
    const dmb_scene *scene = &linear->scene;
    const dmb_block_matrix blocks = {A->diagonal, A->lower, A->upper, NULL};
    for (uint32_t c = 0; c < scene->chain_count; c++)
        dmb_block_multiply(&scene->layout, &blocks, scene->chains[c].first, scene->chains[c].count, x, y);
    add_joint_products(scene, A->joints, x, y);
}

/* y += |A| |x|, A of that shape, by rows */
static void add_terms(const double *A, uint32_t rows, uint32_t columns, const double *x, double *y)
{
    for (uint32_t r = 0; r < rows; r++)
        for (uint32_t c = 0; c < columns; c++) y[r] += fabs(A[(size_t)columns * r + c] * x[c]);
}

static void add_joint_terms(const dmb_scene *scene, const double *joints, const double *x, double *y)
{
    const dmb_block_layout *layout = &scene->layout;
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        for (uint32_t k = 0; k < c->node_count; k++)
            for (uint32_t r = 0; r < layout->size[c->node[k]]; r++) {
                const double *row = joints + c->tangent + (size_t)(c->column[k] + r) * c->columns;
                for (uint32_t l = 0; l < c->node_count; l++)
                    add_terms(row + c->column[l], 1, layout->size[c->node[l]], x + layout->row[c->node[l]],
                              y + layout->row[c->node[k]] + r);
            }
    }
}

void dmb_linear_terms(const dmb_linear *linear, const dmb_linear_matrix *A, const double *x, double *y)
{
    const dmb_scene *scene = &linear->scene;
    const dmb_block_layout *layout = &scene->layout;
    memset(y, 0, linear->rows * sizeof(double));
    for (uint32_t i = 0; i < layout->n; i++) {
        const uint32_t size = layout->size[i], row = layout->row[i];
        add_terms(A->diagonal + layout->diag[i], size, size, x + row, y + row);
        if (i + 1 == layout->n || scene->node_chain[i + 1] != scene->node_chain[i]) continue;
        const uint32_t next = layout->size[i + 1], below = layout->row[i + 1];
        add_terms(A->upper + layout->link[i], size, next, x + below, y + row);
        add_terms(A->lower + layout->link[i], next, size, x + row, y + below);
    }
    add_joint_terms(scene, A->joints, x, y);
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

void dmb_linear_take_stiffness_size(dmb_linear *linear)
{
    const dmb_scene *scene = &linear->scene;
    const dmb_block_layout *layout = &scene->layout;
    double *size = linear->stiffness_size;
    for (uint32_t i = 0; i < layout->n; i++)
        for (uint32_t c = 0; c < layout->size[i]; c++)
            size[layout->row[i] + c] = dmb_linear_diagonal(linear, &linear->stiffness, i, c);
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        const double *A = linear->stiffness.joints + c->tangent;
        for (uint32_t k = 0; k < c->node_count; k++)
            for (uint32_t r = c->column[k]; r < c->column[k] + layout->size[c->node[k]]; r++)
                size[layout->row[c->node[k]] + r - c->column[k]] += A[(size_t)r * c->columns + r];
    }
    for (uint32_t r = 0; r < linear->rows; r++) size[r] = fabs(size[r]);
}

/* A stiffness below this part of the largest one has rounding of that in it, of 1e-11 of it. */
#define DMB_STIFFNESS_SMALL 1e-5

double dmb_linear_stiffness_at_least(const dmb_linear *linear)
{
    const dmb_block_layout *layout = &linear->scene.layout;
    double most = 0.0;
    for (uint32_t i = 0; i < layout->n; i++)
        for (uint32_t c = 0; c < layout->size[i]; c++)
            most = fmax(most, linear->stiffness_size[layout->row[i] + c] / dmb_linear_weight(linear, i, c));
    return DMB_STIFFNESS_SMALL * most;
}

/* +-(1/2 .. 3/2) by a linear congruential generator, over the root of the stiffness; 0 where there is none. Of signs
 * alone x_i y_j - x_j y_i is 0 every second time, and with it all that two coordinates that are not symmetric would
 * show. */
static void draw_numbers(const dmb_linear *linear, uint64_t *seed, double *x)
{
    const dmb_block_layout *layout = &linear->scene.layout;
    const double least = dmb_linear_stiffness_at_least(linear);
    for (uint32_t i = 0; i < layout->n; i++)
        for (uint32_t c = 0; c < layout->size[i]; c++) {
            const uint32_t row = layout->row[i] + c;
            const double size = fmax(linear->stiffness_size[row], least * dmb_linear_weight(linear, i, c));
            *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
            const double number = 0.5 + (double)(*seed >> 41) * 0x1p-23;
            x[row] = size > 0.0 ? ((*seed >> 40 & 1) != 0 ? number : -number) / sqrt(size) : 0.0;
        }
}

/* Numbers on the coordinates, carried on to the rows that joints make dependent. */
static void draw(const dmb_linear *linear, uint64_t *seed, double *z, double *x)
{
    draw_numbers(linear, seed, x);
    for (uint32_t i = 0; i < linear->coordinates; i++) z[i] = x[linear->row_of[i]];
    dmb_linear_expand(linear, z, x);
}

double dmb_linear_asymmetry(const dmb_linear *linear, double *work)
{
    const size_t rows = linear->rows;
    const dmb_linear_matrix *A = &linear->stiffness;
    double *x = work, *y = x + rows, *product = y + rows, *z = product + rows, most = 0.0;
    uint64_t seed = 1;
    for (int k = 0; k < 4; k++) {
        draw(linear, &seed, z, x);
        draw(linear, &seed, z, y);
        dmb_linear_multiply(linear, A, y, product);
        const double one = dmb_dot(rows, x, product);
        dmb_linear_multiply(linear, A, x, product);
        most = fmax(most, fabs(one - dmb_dot(rows, y, product)));
    }
    return most / sqrt(1.0 + linear->coordinates);
}

/* d.C d of random motions: 0 where C is skew, as gyroscopic terms are, or nothing. */
int32_t dmb_linear_is_undamped(const dmb_linear *linear, double *work)
{
    const size_t rows = linear->rows;
    double *x = work, *product = x + rows, *terms = product + rows, *z = terms + rows, motion = 0.0;
    uint64_t seed = 1;
    for (int k = 0; k < 4; k++) {
        double size = 0.0;
        draw(linear, &seed, z, x);
        dmb_linear_multiply(linear, &linear->damping, x, product);
        dmb_linear_terms(linear, &linear->damping, x, terms);
        for (size_t i = 0; i < rows; i++) size += fabs(x[i]) * terms[i];
        motion += dmb_dot(rows, x, x);
        if (fabs(dmb_dot(rows, x, product)) > 1e-12 * size) return 0;
    }
    return motion > 0.0;
}

/* Factors of combinations of the matrices, and solutions with them. */

/* k K + c C + m M in the blocks of `work`, ones where rows are held. */
static dmb_linear_matrix combine(dmb_linear *linear, double k, double c, double m)
{
    const dmb_scene *scene = &linear->scene;
    const dmb_block_layout *layout = &scene->layout;
    dmb_linear_matrix to = dmb_linear_stiffness_of(linear->work);
    memset(to.diagonal, 0, layout->diag[layout->n] * sizeof(double));
    memset(to.lower, 0, layout->link[layout->n - 1] * sizeof(double));
    memset(to.upper, 0, layout->link[layout->n - 1] * sizeof(double));
    memset(to.joints, 0, scene->tangent_count * sizeof(double));
    if (k != 0.0) dmb_linear_add(scene, k, &linear->stiffness, &to);
    if (c != 0.0) dmb_linear_add(scene, c, &linear->damping, &to);
    if (m != 0.0) dmb_linear_add(scene, m, &linear->mass, &to);
    for (uint32_t i = 0; i < scene->held_count; i++) {
        const uint32_t node = scene->held_node[i];
        to.diagonal[layout->diag[node] + (layout->size[node] + 1) * scene->held_component[i]] = 1.0;
    }
    return to;
}

int64_t dmb_linear_factor(dmb_linear *linear, double k, double c, double m, dmb_block_weakest *weakest)
{
    dmb_block_weakest unused;
    (void)combine(linear, k, c, m);
    return dmb_factor_stiffness(linear->work, weakest != NULL ? weakest : &unused);
}

uint32_t dmb_linear_negative(dmb_linear *linear, double k, double c, double m)
{
    const dmb_scene *scene = &linear->scene;
    const dmb_linear_matrix A = combine(linear, k, c, m);
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->chain_count; i++)
        count += dmb_block_negative(&scene->layout, A.diagonal, A.lower, A.upper, NULL, scene->chains[i].first,
                                    scene->chains[i].count);
    return count;
}

uint32_t dmb_linear_count_below(dmb_linear *linear, double square)
{
    return dmb_linear_negative(linear, 1.0, 0.0, -square);
}

int64_t dmb_linear_count(dmb_linear *linear, double square)
{
    dmb_block_weakest unused;
    int32_t negative = 0;
    (void)combine(linear, 1.0, 0.0, -square);
    return dmb_stiffness_factor(linear->work, &unused, &negative) >= 0 ? -1 : negative;
}

void dmb_linear_solve(dmb_linear *linear, double *x)
{
    for (uint32_t r = 0; r < linear->rows; r++) x[r] = -x[r]; /* the solver takes a residual */
    dmb_solve_for(linear->work, x, x);
}
