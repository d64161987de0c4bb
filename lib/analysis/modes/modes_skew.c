/* The symmetric part of a stiffness in its place, and back (eq:modes.skew). */
#include <string.h>

#include "analysis/linear/linear.h"
#include "analysis/modes/modes.h"
#include "analysis/static/static.h"
#include "base/memory.h"

static size_t doubles_of(const dmb_scene *scene)
{
    const dmb_block_layout *layout = &scene->layout;
    return layout->diag[layout->n] + 2 * (size_t)layout->link[layout->n - 1] + scene->tangent_count;
}

static void average_joint(const dmb_constraint *c, double *T)
{
    for (uint32_t i = 0; i < c->columns; i++)
        for (uint32_t j = 0; j < i; j++) {
            double *one = T + (size_t)c->columns * i + j, *other = T + (size_t)c->columns * j + i;
            *one = *other = 0.5 * (*one + *other);
        }
}

int32_t dmb_modes_keep_symmetric(dmb_linear *linear, dmb_linear_matrix *K)
{
    const dmb_scene *scene = &linear->scene;
    const dmb_block_layout *layout = &scene->layout;
    const dmb_linear_matrix *A = &linear->stiffness;
    double *kept = dmb_allocate(&linear->allocator, doubles_of(scene) * sizeof(double));
    if (kept == NULL) return DMB_ERR_NO_MEMORY;
    K->diagonal = kept;
    K->lower = K->diagonal + layout->diag[layout->n];
    K->upper = K->lower + layout->link[layout->n - 1];
    K->joints = K->upper + layout->link[layout->n - 1];
    memset(kept, 0, doubles_of(scene) * sizeof(double));
    dmb_linear_add(scene, 1.0, A, K);
    dmb_make_blocks_symmetric(layout, A->diagonal, A->lower, A->upper);
    for (uint32_t k = 0; k < scene->constraint_count; k++)
        average_joint(scene->constraints + k, A->joints + scene->constraints[k].tangent);
    return DMB_OK;
}

void dmb_modes_put_back(dmb_linear *linear, dmb_linear_matrix *K)
{
    const dmb_scene *scene = &linear->scene;
    dmb_linear_clear(linear, &linear->stiffness);
    dmb_linear_add(scene, 1.0, K, &linear->stiffness);
    dmb_release(&linear->allocator, K->diagonal, doubles_of(scene) * sizeof(double));
}
