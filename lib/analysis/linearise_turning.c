/* Products with the velocities of the state, which its frames turn with. */
#include <string.h>

#include "analysis/linearise_parts.h"
#include "math/mat6.h"

/* to += factor A v^ in rows of six columns: row^T v^ = ad(v)^T row */
static void add_row_products(double factor, const double *A, uint32_t rows, size_t stride, const double v[6],
                             double *to)
{
    for (uint32_t r = 0; r < rows; r++) {
        double product[6];
        dmb_ad_transpose(v, A + stride * r, product);
        for (int i = 0; i < 6; i++) to[stride * r + (size_t)i] += factor * product[i];
    }
}

static void add_node_products(const dmb_scene *scene, double factor, const dmb_linear_matrix *A, const double *rows,
                              uint32_t node, dmb_linear_matrix *to)
{
    const dmb_block_layout *layout = &scene->layout;
    const double *v = rows + layout->row[node];
    add_row_products(factor, A->diagonal + layout->diag[node], 6, 6, v, to->diagonal + layout->diag[node]);
    if (node > 0)
        add_row_products(factor, A->upper + layout->link[node - 1], layout->size[node - 1], 6, v,
                         to->upper + layout->link[node - 1]);
    if (node + 1 < layout->n)
        add_row_products(factor, A->lower + layout->link[node], layout->size[node + 1], 6, v,
                         to->lower + layout->link[node]);
}

void dmb_linear_add_products(const dmb_scene *scene, double factor, const dmb_linear_matrix *A, const double *rows,
                             dmb_linear_matrix *to)
{
    for (uint32_t i = 0; i < scene->node_count; i++)
        if (scene->layout.size[i] == DMB_NODE_FULL) add_node_products(scene, factor, A, rows, i, to);
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        for (uint32_t k = 0; k < c->node_count; k++)
            if (scene->layout.size[c->node[k]] == DMB_NODE_FULL)
                add_row_products(factor, A->joints + c->tangent + c->column[k], c->columns, c->columns,
                                 rows + scene->layout.row[c->node[k]], to->joints + c->tangent + c->column[k]);
    }
}

/* The spin that the axes of d leave out, and the rest of the velocities. */
static void part_velocities(dmb_linear *linear, int32_t still)
{
    const dmb_scene *scene = &linear->scene;
    memcpy(linear->rest, linear->work->now.velocity, linear->rows * sizeof(double));
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t row = scene->layout.row[i] + 3;
        if (!still || scene->layout.size[i] != DMB_NODE_FULL) continue;
        linear->spin[row] = linear->rest[row];
        linear->rest[row] = 0.0;
    }
}

/* The matrices with their frames' velocities (linearise.h): a row that is held has no d, nor any v^ d, but what the
 * others do to it counts. */
void dmb_linear_turn_frames(dmb_linear *linear, int32_t still)
{
    part_velocities(linear, still);
    dmb_linear_keep_held(linear, 1);
    dmb_linear_add_whole_joints(linear, 1.0);
    dmb_linear_hold(linear, 1);
    dmb_linear_add_whole_joints(linear, -1.0); /* columns that are held are left of it */
    if (still) dmb_linear_add_products(&linear->scene, -1.0, &linear->mass, linear->spin, &linear->damping);
    dmb_linear_add_products(&linear->scene, 1.0, &linear->damping, linear->rest, &linear->stiffness);
    dmb_linear_add_products(&linear->scene, 1.0, &linear->mass, linear->work->now.acceleration, &linear->stiffness);
    dmb_linear_add_products(&linear->scene, 1.0, &linear->mass, linear->rest, &linear->damping);
    dmb_linear_hold(linear, 1);
    dmb_linear_keep_held(linear, 0);
    dmb_linear_add_whole_joints(linear, 1.0);
    dmb_linear_hold(linear, 0);
}
