/* Factors of combinations of the matrices, and solutions with them. */
#include <string.h>

#include "analysis/linearise_parts.h"
#include "analysis/stiffness.h"
#include "math/block_inertia.h"
#include "system/solve.h"

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

uint32_t dmb_linear_count_below(dmb_linear *linear, double square)
{
    const dmb_scene *scene = &linear->scene;
    const dmb_linear_matrix A = combine(linear, 1.0, 0.0, -square);
    uint32_t count = 0;
    for (uint32_t c = 0; c < scene->chain_count; c++)
        count += dmb_block_negative(&scene->layout, A.diagonal, A.lower, A.upper, NULL, scene->chains[c].first,
                                    scene->chains[c].count);
    return count;
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
    double *correction = linear->work->correction; /* solves for its negative */
    for (uint32_t r = 0; r < linear->rows; r++) correction[r] = -x[r];
    dmb_solve_correction(linear->work);
    memcpy(x, correction, linear->rows * sizeof(double));
}
