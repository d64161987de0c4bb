/* Rows that guides and motion drives hold, and the independent coordinates where joints are. */
#include <math.h>
#include <string.h>

#include "analysis/linear/linearise.h"
#include "base/memory.h"
#include "system/constrain/cluster.h"

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

/* Independent coordinates z of the motions d = R z that joints leave. */

/* Marks in `column` (shape (rows), to begin with) the rows that joints make dependent, and makes G of each cluster. */
static void find_dependent(dmb_linear *linear, uint8_t *dependent)
{
    dmb_sim *work = linear->work;
    for (uint32_t k = 0; k < linear->scene.cluster_count; k++) {
        const dmb_cluster *cluster = linear->scene.clusters + k;
        const dmb_partition partition = dmb_cluster_partition(work, k);
        dmb_partition_null_space(work->cluster_matrix + cluster->dense, cluster->columns, &partition,
                                 work->cluster_lu + cluster->square, work->cluster_pivot + cluster->row,
                                 work->cluster_null + cluster->dense);
        for (uint32_t i = 0; i < partition.rank; i++)
            dependent[linear->scene.cluster_columns[cluster->column + partition.column_order[i]]] = 1;
    }
}

/* The row of G of a dependent row, as entries of R; number_of: coordinate of each row. */
static uint32_t put_dependent(const dmb_linear *linear, uint32_t k, uint32_t place, const uint32_t *number_of,
                              uint32_t at)
{
    const dmb_cluster *cluster = linear->scene.clusters + k;
    const dmb_partition partition = dmb_cluster_partition(linear->work, k);
    const uint32_t width = partition.columns - partition.rank;
    const double *G = linear->work->cluster_null + cluster->dense + (size_t)place * width;
    for (uint32_t m = 0; m < width; m++) {
        const uint32_t row =
            linear->scene.cluster_columns[cluster->column + partition.column_order[partition.rank + m]];
        if (!linear->scene.solved_row[row] || G[m] == 0.0) continue;
        linear->column[at] = number_of[row];
        linear->value[at++] = G[m];
    }
    return at;
}

static uint32_t put_row(const dmb_linear *linear, uint32_t node, uint32_t c, const uint8_t *dependent,
                        const uint32_t *number_of, uint32_t at)
{
    const dmb_scene *scene = &linear->scene;
    const uint32_t row = scene->layout.row[node] + c;
    if (!scene->solved_row[row]) return at;
    if (!dependent[row]) {
        linear->column[at] = number_of[row];
        linear->value[at] = 1.0;
        return at + 1;
    }
    const uint32_t k = scene->node_cluster[node];
    const uint32_t place = linear->work->cluster_place[scene->clusters[k].column + scene->node_place[node] + c];
    return put_dependent(linear, k, place, number_of, at);
}

int32_t dmb_linear_make_coordinates(dmb_linear *linear)
{
    const dmb_scene *scene = &linear->scene;
    const size_t rows = linear->rows, bytes = rows * (sizeof(uint32_t) + 1);
    uint32_t *number_of = dmb_allocate(&linear->allocator, bytes), at = 0;
    if (number_of == NULL) return DMB_ERR_NO_MEMORY;
    uint8_t *dependent = (uint8_t *)(number_of + rows);
    find_dependent(linear, dependent);
    for (uint32_t r = 0; r < rows; r++) {
        if (dependent[r] || !scene->solved_row[r]) continue;
        number_of[r] = linear->coordinates;
        linear->row_of[linear->coordinates++] = r;
    }
    for (uint32_t i = 0; i < scene->node_count; i++)
        for (uint32_t c = 0; c < scene->layout.size[i]; c++) {
            linear->start[scene->layout.row[i] + c] = at;
            at = put_row(linear, i, c, dependent, number_of, at);
        }
    linear->start[rows] = at;
    dmb_release(&linear->allocator, number_of, bytes);
    return DMB_OK;
}

void dmb_linear_expand(const dmb_linear *linear, const double *z, double *d)
{
    for (uint32_t r = 0; r < linear->rows; r++) {
        d[r] = 0.0;
        for (uint32_t i = linear->start[r]; i < linear->start[r + 1]; i++)
            d[r] += linear->value[i] * z[linear->column[i]];
    }
}

void dmb_linear_restrict(const dmb_linear *linear, const double *f, double *g)
{
    memset(g, 0, linear->coordinates * sizeof(double));
    for (uint32_t r = 0; r < linear->rows; r++)
        for (uint32_t i = linear->start[r]; i < linear->start[r + 1]; i++)
            g[linear->column[i]] += linear->value[i] * f[r];
}

void dmb_linear_restrict_terms(const dmb_linear *linear, const double *f, double *g)
{
    memset(g, 0, linear->coordinates * sizeof(double));
    for (uint32_t r = 0; r < linear->rows; r++)
        for (uint32_t i = linear->start[r]; i < linear->start[r + 1]; i++)
            g[linear->column[i]] += fabs(linear->value[i] * f[r]);
}
