/* Rows that guides and motion drives hold. */
#include <string.h>

#include "analysis/linearise_parts.h"

static void clear_row(double *block, uint32_t columns, uint32_t row)
{
    memset(block + (size_t)columns * row, 0, columns * sizeof(double));
}

static void clear_column(double *block, uint32_t rows, uint32_t columns, uint32_t column)
{
    for (uint32_t r = 0; r < rows; r++) block[(size_t)columns * r + column] = 0.0;
}

static void clear_rows_of(const dmb_block_layout *layout, uint32_t node, uint32_t c, dmb_linear_matrix *A)
{
    clear_row(A->diagonal + layout->diag[node], layout->size[node], c);
    if (node > 0) clear_row(A->lower + layout->link[node - 1], layout->size[node - 1], c);
    if (node + 1 < layout->n) clear_row(A->upper + layout->link[node], layout->size[node + 1], c);
}

static void clear_columns_of(const dmb_block_layout *layout, uint32_t node, uint32_t c, dmb_linear_matrix *A)
{
    const uint32_t size = layout->size[node];
    clear_column(A->diagonal + layout->diag[node], size, size, c);
    if (node > 0) clear_column(A->upper + layout->link[node - 1], layout->size[node - 1], size, c);
    if (node + 1 < layout->n) clear_column(A->lower + layout->link[node], layout->size[node + 1], size, c);
}

static void clear_in_joint(const dmb_scene *scene, const dmb_constraint *c, int columns, double *joint)
{
    for (uint32_t k = 0; k < c->node_count; k++)
        for (uint32_t r = 0; r < scene->layout.size[c->node[k]]; r++) {
            if (scene->solved_row[scene->layout.row[c->node[k]] + r]) continue;
            if (columns)
                clear_column(joint, c->columns, c->columns, c->column[k] + r);
            else
                clear_row(joint, c->columns, c->column[k] + r);
        }
}

static void copy_column(const double *block, uint32_t rows, uint32_t columns, uint32_t c, double *to)
{
    for (uint32_t r = 0; r < rows; r++) to[r] = block[(size_t)columns * r + c];
}

static void copy_row(const double *block, uint32_t columns, uint32_t c, double *to)
{
    memcpy(to, block + (size_t)columns * c, columns * sizeof(double));
}

/* Before the columns are cleared. */
static void keep_column(const dmb_block_layout *layout, uint32_t node, uint32_t c, const dmb_linear_matrix *A,
                        double *to)
{
    const uint32_t size = layout->size[node];
    copy_column(A->diagonal + layout->diag[node], size, size, c, to + 6);
    if (node > 0) copy_column(A->upper + layout->link[node - 1], layout->size[node - 1], size, c, to);
    if (node + 1 < layout->n) copy_column(A->lower + layout->link[node], layout->size[node + 1], size, c, to + 12);
}

/* Likewise. */
static void keep_row(const dmb_block_layout *layout, uint32_t node, uint32_t c, const dmb_linear_matrix *A, double *to)
{
    copy_row(A->diagonal + layout->diag[node], layout->size[node], c, to + 6);
    if (node > 0) copy_row(A->lower + layout->link[node - 1], layout->size[node - 1], c, to);
    if (node + 1 < layout->n) copy_row(A->upper + layout->link[node], layout->size[node + 1], c, to + 12);
}

/* Columns, or rows, of what is held. */
void dmb_linear_keep_held(dmb_linear *linear, int columns)
{
    const dmb_scene *scene = &linear->scene;
    const dmb_linear_matrix *all[3] = {&linear->mass, &linear->damping, &linear->stiffness};
    double *lines = columns ? linear->held_columns : linear->held_rows;
    for (uint32_t i = 0; i < scene->held_count; i++)
        for (size_t m = 0; m < 3; m++)
            (columns ? keep_column : keep_row)(&scene->layout, scene->held_node[i], scene->held_component[i], all[m],
                                               lines + 54 * (size_t)i + 18 * m);
}

void dmb_linear_add_whole_joints(dmb_linear *linear, double factor)
{
    const dmb_linear_matrix *all[3] = {&linear->mass, &linear->damping, &linear->stiffness};
    const size_t count = linear->scene.tangent_count;
    for (size_t m = 0; m < 3; m++)
        dmb_linear_add_array(factor, all[m]->joints, count, linear->whole_joints + m * count);
}

void dmb_linear_hold(dmb_linear *linear, int columns)
{
    const dmb_scene *scene = &linear->scene;
    dmb_linear_matrix *all[3] = {&linear->mass, &linear->damping, &linear->stiffness};
    for (int m = 0; m < 3; m++) {
        for (uint32_t i = 0; i < scene->held_count; i++)
            (columns ? clear_columns_of : clear_rows_of)(&scene->layout, scene->held_node[i], scene->held_component[i],
                                                         all[m]);
        for (uint32_t i = 0; i < scene->constraint_count; i++)
            clear_in_joint(scene, scene->constraints + i, columns, all[m]->joints + scene->constraints[i].tangent);
    }
}
