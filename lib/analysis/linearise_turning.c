/* Products with the velocities of the state, which its frames turn with. */
#include "analysis/linearise_parts.h"
#include "math/mat6.h"

/* to += A v^ in rows of six columns: row^T v^ = ad(v)^T row */
static void add_row_products(const double *A, uint32_t rows, size_t stride, const double v[6], double *to)
{
    for (uint32_t r = 0; r < rows; r++) {
        double product[6];
        dmb_ad_transpose(v, A + stride * r, product);
        for (int i = 0; i < 6; i++) to[stride * r + (size_t)i] += product[i];
    }
}

static void add_node_products(const dmb_scene *scene, const dmb_linear_matrix *A, const double *rows, uint32_t node,
                              dmb_linear_matrix *to)
{
    const dmb_block_layout *layout = &scene->layout;
    const double *v = rows + layout->row[node];
    add_row_products(A->diagonal + layout->diag[node], 6, 6, v, to->diagonal + layout->diag[node]);
    if (node > 0)
        add_row_products(A->upper + layout->link[node - 1], layout->size[node - 1], 6, v,
                         to->upper + layout->link[node - 1]);
    if (node + 1 < layout->n)
        add_row_products(A->lower + layout->link[node], layout->size[node + 1], 6, v, to->lower + layout->link[node]);
}

/* to += A blkdiag(v^), v by rows; a PATH node turns about its own axis alone and has none. */
static void add_products(const dmb_scene *scene, const dmb_linear_matrix *A, const double *rows, dmb_linear_matrix *to)
{
    for (uint32_t i = 0; i < scene->node_count; i++)
        if (scene->layout.size[i] == DMB_NODE_FULL) add_node_products(scene, A, rows, i, to);
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        for (uint32_t k = 0; k < c->node_count; k++)
            if (scene->layout.size[c->node[k]] == DMB_NODE_FULL)
                add_row_products(A->joints + c->tangent + c->column[k], c->columns, c->columns,
                                 rows + scene->layout.row[c->node[k]], to->joints + c->tangent + c->column[k]);
    }
}

/* C += M v^, K += C_v v^ + M a^: a row that is held has no d, nor any v^ d, but what the others do to it counts. */
void dmb_linear_turn_frames(dmb_linear *linear)
{
    dmb_sim *work = linear->work;
    dmb_linear_keep_held(linear, 1);
    dmb_linear_add_whole_joints(linear, 1.0);
    dmb_linear_hold(linear, 1);
    dmb_linear_add_whole_joints(linear, -1.0); /* columns that are held are left of it */
    add_products(&linear->scene, &linear->damping, work->now.velocity, &linear->stiffness);
    add_products(&linear->scene, &linear->mass, work->now.acceleration, &linear->stiffness);
    add_products(&linear->scene, &linear->mass, work->now.velocity, &linear->damping);
    dmb_linear_hold(linear, 1);
    dmb_linear_keep_held(linear, 0);
    dmb_linear_add_whole_joints(linear, 1.0);
    dmb_linear_hold(linear, 0);
}
