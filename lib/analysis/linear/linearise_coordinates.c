/* Constrained rows (supports and motion drives), and independent coordinates of scenes with joints. */
#include <math.h>
#include <string.h>

#include "analysis/linear/linear.h"
#include "base/memory.h"
#include "math/dense.h"
#include "math/inertia.h"
#include "system/constrain/constrain.h"
#include "system/solve/solve.h"

/* Rows of prescribed motion (supports, motion drives) are not unknowns: their rows and columns are cleared from M, C
 * and K, after what is still needed has been copied:
 *
 *     column, by all rows     forces by which a prescribed motion acts on the others
 *     row, by all columns     reaction of the support or drive
 *
 * All blocks of a row are on the diagonal and beside it, and in the constraints of its node. */
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

/* Copies a column, with those parts of it in the neighbours' rows, before columns are cleared. */
static void keep_column(const dmb_block_layout *layout, uint32_t node, uint32_t c, const dmb_linear_matrix *A,
                        double *to)
{
    const uint32_t size = layout->size[node];
    copy_column(A->diagonal + layout->diag[node], size, size, c, to + 6);
    if (node > 0) copy_column(A->upper + layout->link[node - 1], layout->size[node - 1], size, c, to);
    if (node + 1 < layout->n) copy_column(A->lower + layout->link[node], layout->size[node + 1], size, c, to + 12);
}

/* Copies a row, with those parts of it in the neighbours' columns, before rows are cleared. */
static void keep_row(const dmb_block_layout *layout, uint32_t node, uint32_t c, const dmb_linear_matrix *A, double *to)
{
    copy_row(A->diagonal + layout->diag[node], layout->size[node], c, to + 6);
    if (node > 0) copy_row(A->lower + layout->link[node - 1], layout->size[node - 1], c, to);
    if (node + 1 < layout->n) copy_row(A->upper + layout->link[node], layout->size[node + 1], c, to + 12);
}

/* Copies columns, or rows, of constrained rows. */
void dmb_linear_keep_constrained(dmb_linear *linear, int columns)
{
    const dmb_scene *scene = &linear->scene;
    const dmb_linear_matrix *all[3] = {&linear->mass, &linear->damping, &linear->stiffness};
    double *lines = columns ? linear->constrained_columns : linear->constrained_rows;
    for (uint32_t i = 0; i < scene->constrained_count; i++)
        for (size_t m = 0; m < 3; m++)
            (columns ? keep_column : keep_row)(&scene->layout, scene->constrained_node[i],
                                               scene->constrained_component[i], all[m],
                                               lines + 54 * (size_t)i + 18 * m);
}

void dmb_linear_add_whole_joints(dmb_linear *linear, double factor)
{
    const dmb_linear_matrix *all[3] = {&linear->mass, &linear->damping, &linear->stiffness};
    const size_t count = linear->scene.tangent_count;
    for (size_t m = 0; m < 3; m++)
        dmb_linear_add_array(factor, all[m]->joints, count, linear->whole_joints + m * count);
}

/* Clears rows or columns of constrained rows from all three matrices, with the constraints' parts, after they were
 * kept. */
void dmb_linear_hold(dmb_linear *linear, int columns)
{
    const dmb_scene *scene = &linear->scene;
    dmb_linear_matrix *all[3] = {&linear->mass, &linear->damping, &linear->stiffness};
    for (int m = 0; m < 3; m++) {
        for (uint32_t i = 0; i < scene->constrained_count; i++)
            (columns ? clear_columns_of : clear_rows_of)(&scene->layout, scene->constrained_node[i],
                                                         scene->constrained_component[i], all[m]);
        for (uint32_t i = 0; i < scene->constraint_count; i++)
            clear_in_joint(scene, scene->constraints + i, columns, all[m]->joints + scene->constraints[i].tangent);
    }
}

/* ---- Independent coordinates z of the motions d = R z permitted by joints (eq:joints.partition) ---- */

/* Marks the dependent rows, and computes G = -C_d^-1 C_i of each component. */
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

/* R by rows: an independent row has a single 1, a dependent one its row of G without constrained columns, a constrained
 * one nothing. Coordinates are numbered in the order of their rows. */
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

/* d = R z */
void dmb_linear_expand(const dmb_linear *linear, const double *z, double *d)
{
    for (uint32_t r = 0; r < linear->rows; r++) {
        d[r] = 0.0;
        for (uint32_t i = linear->start[r]; i < linear->start[r + 1]; i++)
            d[r] += linear->value[i] * z[linear->column[i]];
    }
}

/* g = R^T f */
void dmb_linear_restrict(const dmb_linear *linear, const double *f, double *g)
{
    memset(g, 0, linear->coordinates * sizeof(double));
    for (uint32_t r = 0; r < linear->rows; r++)
        for (uint32_t i = linear->start[r]; i < linear->start[r + 1]; i++)
            g[linear->column[i]] += linear->value[i] * f[r];
}

/* Sum of the amounts of the terms of R^T f: what rounding of g is compared with. */
void dmb_linear_restrict_terms(const dmb_linear *linear, const double *f, double *g)
{
    memset(g, 0, linear->coordinates * sizeof(double));
    for (uint32_t r = 0; r < linear->rows; r++)
        for (uint32_t i = linear->start[r]; i < linear->start[r + 1]; i++)
            g[linear->column[i]] += fabs(linear->value[i] * f[r]);
}

/* ---- Products ---------------------------------------------------------------------------------------------------- */

/* Products and factors of the matrices of a linear system. */

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
static void add_segments(const double *A, uint32_t rows, uint32_t columns, const double *x, double *y)
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
                    add_segments(row + c->column[l], 1, layout->size[c->node[l]], x + layout->row[c->node[l]],
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
        add_segments(A->diagonal + layout->diag[i], size, size, x + row, y + row);
        if (i + 1 == layout->n || scene->node_chain[i + 1] != scene->node_chain[i]) continue;
        const uint32_t next = layout->size[i + 1], below = layout->row[i + 1];
        add_segments(A->upper + layout->link[i], size, next, x + below, y + row);
        add_segments(A->lower + layout->link[i], next, size, x + row, y + below);
    }
    add_joint_terms(scene, A->joints, x, y);
}

/* R^T A R in full, column by column by products with unit coordinates: column i begins at n i. */
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

/* Absolute diagonal of K by rows, with the terms of joints: random motions and limits of rounding are scaled by it. */
void dmb_linear_set_stiffness_size(dmb_linear *linear)
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

/* [-] Fraction of the largest stiffness below which a stiffness consists of its rounding. */
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

/* +-(1/2 .. 3/2) by a linear congruential generator, over the root of the stiffness; 0 without stiffness. Signs alone
 * would not suffice: x_i y_j - x_j y_i would be 0 every second time, and hide an asymmetry between two coordinates. */
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

/* Random numbers of the coordinates, expanded to dependent rows. */
static void draw(const dmb_linear *linear, uint64_t *seed, double *z, double *x)
{
    draw_numbers(linear, seed, x);
    for (uint32_t i = 0; i < linear->coordinates; i++) z[i] = x[linear->row_of[i]];
    dmb_linear_expand(linear, z, x);
}

/* x . K y - y . K x is the sum of (K - K^T)_ij x_i y_j. The numbers are scaled so that each term K_ij x_i y_j is of
 * order 1; the sum of random signs grows with the root of their number, by which it is divided. */
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

/* d . C d of random motions vanishes if C is skew, as gyroscopic terms are, or 0. Damping that takes energy from one
 * motion and gives it to another could cancel for one d, hardly for four. */
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

/* ---- Factors of combinations of the matrices ---- */

/* k K + c C + m M in the blocks of `work`, with ones on the diagonal of constrained rows. */
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
    for (uint32_t i = 0; i < scene->constrained_count; i++) {
        const uint32_t node = scene->constrained_node[i];
        to.diagonal[layout->diag[node] + (layout->size[node] + 1) * scene->constrained_component[i]] = 1.0;
    }
    return to;
}

/* Factors of the combination in the blocks of the copy `work`, so that dmb_linear_solve uses the solver of the sim. */
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

/* Number of eigenvalues of (K, M) below `square`: by Sylvester's law K - square M has as many negative eigenvalues as
 * there are (eq:modes.count). */
uint32_t dmb_linear_count_below(dmb_linear *linear, double square)
{
    return dmb_linear_negative(linear, 1.0, 0.0, -square);
}

/* Without the shift by rounding of a static state (eq:signs.amount), which would move the eigenvalues that are
 * counted. */
int64_t dmb_linear_count(dmb_linear *linear, double square)
{
    const dmb_scene *scene = &linear->scene;
    const dmb_linear_matrix A = combine(linear, 1.0, 0.0, -square);
    dmb_block_weakest unused;
    int64_t count = 0;
    for (uint32_t i = 0; i < scene->chain_count; i++)
        if (!scene->chains[i].jointed)
            count += dmb_block_negative(&scene->layout, A.diagonal, A.lower, A.upper, NULL, scene->chains[i].first,
                                        scene->chains[i].count);
    if (scene->cluster_count == 0) return count;
    if (dmb_factor_stiffness(linear->work, &unused) >= 0) return -1;
    return count + dmb_reduced_negative(linear->work);
}

void dmb_linear_solve(dmb_linear *linear, double *x)
{
    for (uint32_t r = 0; r < linear->rows; r++) x[r] = -x[r]; /* the solver takes a residual */
    dmb_solve_for(linear->work, x, x);
}
