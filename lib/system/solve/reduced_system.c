/* Linear system of chains connected by joints. Its blocks are the constraint components and the other nodes of those
 * chains; the block of a component is reduced to its independent coordinates,
 *
 *     R^T S R y = -R^T residual,   z = R y,   R = [G; I]   (eq:static.newton)                (DMB_METHOD_INDEPENDENT)
 *     [S B^T; B 0] [z; df] = -[residual; 0] over all its coordinates and its pivot rows      (DMB_METHOD_MULTIPLIERS)
 *
 * (eq:joints.reduced-system, eq:joints.saddle; of statics eq:static.reduced), with S the iteration matrix of the nodes
 * (blocks of the block-tridiagonal storage) and of the joints. Sequence: put_nodes, put_constraints, make_null_space,
 * reduce_cluster or border_cluster for each dense component; assemble_off_diagonal between blocks; sparse components by
 * reduced_system_sparse.
 *
 *     block                              unknowns y                                     z of its nodes
 *     --------------------------------   --------------------------------------------   ---------------------------
 *     dense component, independent       independent coordinates, columns - rank        R y
 *     dense component, multipliers       all coordinates and pivot multipliers          the first ones
 *     node of a sparse component         its rows, and multipliers of chosen rows       the first ones
 *     other node of a jointed chain      its rows                                       y
 *
 * Chains without joints are not in this system; they have block-tridiagonal factors of their own (solve.c). */
#include "system/solve/solve.h"

#include <string.h>

#include "math/inertia.h"
#include "system/constrain/constrain.h"

/* ---- Columns of nodes in their block ----------------------------------------------------------------------------- */

static int is_bordered(const dmb_sim *sim)
{
    return sim->reduced_mode->bordered;
}

/* Dense constraint component of a node, or DMB_NONE: the node is a block by itself. */
static uint32_t cluster_of(const dmb_scene *scene, uint32_t node)
{
    const uint32_t k = scene->node_cluster[node];
    return k != DMB_NONE && scene->clusters[k].sparse ? DMB_NONE : k;
}

/* Number of unknowns of the block of a component. */
static uint32_t cluster_size(const dmb_sim *sim, uint32_t k)
{
    const uint32_t columns = sim->scene->clusters[k].columns, rank = sim->partition_rank[k];
    return is_bordered(sim) ? columns + rank : columns - rank;
}

/* Row of R for column c of component k: that of G, or a single 1. *one: column of the 1, or DMB_NONE. */
static const double *row_of_null_space(const dmb_sim *sim, uint32_t k, uint32_t c, uint32_t *one)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const uint32_t rank = sim->partition_rank[k], place = sim->cluster_place[cluster->column + c];
    *one = DMB_NONE;
    if (is_bordered(sim))
        *one = c;
    else if (place >= rank)
        *one = place - rank;
    return sim->cluster_null + cluster->dense + (size_t)(*one == DMB_NONE ? place : 0) * (cluster->columns - rank);
}

const double *dmb_reduced_null_space_row(const dmb_sim *sim, uint32_t k, uint32_t c, uint32_t *one)
{
    const double *row = row_of_null_space(sim, k, c, one);
    return *one == DMB_NONE ? row : NULL;
}

/* out (rows x size of node's block) += X (rows x size of node) R_node */
static void times_null_space(const dmb_sim *sim, uint32_t node, const double *X, uint32_t rows, double *out)
{
    const uint32_t k = cluster_of(sim->scene, node), size = sim->scene->layout.size[node];
    const uint32_t width = k == DMB_NONE ? size : cluster_size(sim, k);
    for (uint32_t c = 0; c < size; c++) {
        uint32_t one = c;
        const double *G = NULL;
        if (k != DMB_NONE) G = row_of_null_space(sim, k, sim->scene->node_place[node] + c, &one);
        for (uint32_t r = 0; r < rows; r++) {
            const double x = X[(size_t)r * size + c];
            double *to = out + (size_t)r * width;
            if (one != DMB_NONE) {
                to[one] += x;
                continue;
            }
            for (uint32_t m = 0; m < width; m++) to[m] += x * G[m];
        }
    }
}

/* out (size of node's block x columns) += R_node^T X (size of node x columns) */
static void null_space_times(const dmb_sim *sim, uint32_t node, const double *X, uint32_t columns, double *out)
{
    const uint32_t k = cluster_of(sim->scene, node), size = sim->scene->layout.size[node];
    const uint32_t height = k == DMB_NONE ? size : cluster_size(sim, k);
    for (uint32_t c = 0; c < size; c++) {
        const double *x = X + (size_t)c * columns, *G = NULL;
        uint32_t one = c;
        if (k != DMB_NONE) G = row_of_null_space(sim, k, sim->scene->node_place[node] + c, &one);
        for (uint32_t m = one != DMB_NONE ? one : 0; m < (one != DMB_NONE ? one + 1 : height); m++) {
            const double factor = one != DMB_NONE ? 1.0 : G[m];
            double *to = out + (size_t)m * columns;
            for (uint32_t i = 0; i < columns; i++) to[i] += factor * x[i];
        }
    }
}

/* ---- Blocks of clusters ------------------------------------------------------------------------------------------ */

static void put(const double *from, uint32_t rows, uint32_t columns, double *to, size_t stride)
{
    for (uint32_t r = 0; r < rows; r++)
        for (uint32_t c = 0; c < columns; c++) to[r * stride + c] += from[r * columns + c];
}

/* Blocks of nodes, and off-diagonal blocks between two nodes of the component. */
static void put_nodes(const dmb_sim *sim, const dmb_cluster *cluster, double *D)
{
    const dmb_scene *scene = sim->scene;
    const dmb_block_layout *layout = &scene->layout;
    const size_t n = cluster->columns;
    for (uint32_t i = cluster->node; i < cluster->node + cluster->node_count; i++) {
        const uint32_t node = scene->cluster_nodes[i], size = layout->size[node];
        const size_t at = scene->node_place[node];
        put(dmb_stiffness_of(sim, node), size, size, D + (n + 1) * at, n);
        if (scene->node_element[node] == DMB_NONE || scene->node_block[node + 1] != scene->node_block[node]) continue;
        const size_t next = scene->node_place[node + 1];
        put(sim->stiffness_upper + layout->link[node], size, layout->size[node + 1], D + n * at + next, n);
        put(sim->stiffness_lower + layout->link[node], layout->size[node + 1], size, D + n * next + at, n);
    }
}

/* Terms of joints between their nodes, in solved rows. constraint_tangent holds tangents of springs, joints and
 * callers' forces, and the curvature of the equations: together with the nodes' blocks it is S_c of
 * eq:joints.reduced-system. */
static void put_constraints(const dmb_sim *sim, const dmb_cluster *cluster, double *D)
{
    const dmb_scene *scene = sim->scene;
    const double *weight = sim->cluster_weight + cluster->column;
    for (uint32_t i = cluster->constraint; i < cluster->constraint + cluster->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        for (uint32_t a = 0; a < c->node_count; a++)
            for (uint32_t r = 0; r < scene->layout.size[c->node[a]]; r++)
                for (uint32_t b = 0; b < c->node_count; b++)
                    for (uint32_t s = 0; s < scene->layout.size[c->node[b]]; s++) {
                        const size_t row = scene->node_place[c->node[a]] + r,
                                     column = scene->node_place[c->node[b]] + s;
                        if (weight[row] > 0.0 && weight[column] > 0.0)
                            D[row * cluster->columns + column] +=
                                sim->constraint_tangent[c->tangent + (size_t)(c->column[a] + r) * c->columns +
                                                        c->column[b] + s];
                    }
    }
}

static double *full_matrix(const dmb_sim *sim, const dmb_cluster *cluster)
{
    double *D = sim->cluster_full + cluster->full;
    memset(D, 0, (size_t)cluster->columns * cluster->columns * sizeof(double));
    put_nodes(sim, cluster, D);
    put_constraints(sim, cluster, D);
    return D;
}

/* G of the present matrix (eq:joints.partition); columns that are not solved do not move. */
static void make_null_space(dmb_sim *sim, uint32_t k)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const dmb_partition partition = dmb_cluster_partition(sim, k);
    const uint32_t width = partition.columns - partition.rank;
    double *G = sim->cluster_null + cluster->dense;
    dmb_partition_null_space(sim->cluster_matrix + cluster->dense, cluster->columns, &partition,
                             sim->cluster_lu + cluster->square, sim->cluster_pivot + cluster->row, G);
    for (uint32_t m = 0; m < width; m++) {
        if (sim->cluster_weight[cluster->column + partition.column_order[partition.rank + m]] > 0.0) continue;
        for (uint32_t i = 0; i < partition.rank; i++) G[(size_t)i * width + m] = 0.0;
    }
}

/* A += G^T X for the dependent rows and X for the independent ones, X = D R. R is not formed: rows of independent
 * columns are unit rows, which are added without multiplication. */
static void reduce_cluster(dmb_sim *sim, uint32_t k, const double *D, double *A)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const uint32_t n = cluster->columns, width = n - sim->partition_rank[k];
    double *half = sim->cluster_half + cluster->full; /* D R, shape (n, width) */
    memset(half, 0, (size_t)n * width * sizeof(double));
    for (uint32_t c = 0; c < n; c++) {
        uint32_t one;
        const double *G = row_of_null_space(sim, k, c, &one);
        for (uint32_t r = 0; r < n; r++) {
            const double x = D[(size_t)r * n + c];
            if (x == 0.0) continue;
            for (uint32_t m = one != DMB_NONE ? one : 0; m < (one != DMB_NONE ? one + 1 : width); m++)
                half[(size_t)r * width + m] += one != DMB_NONE ? x : x * G[m];
        }
    }
    for (uint32_t r = 0; r < n; r++) {
        uint32_t one;
        const double *G = row_of_null_space(sim, k, r, &one);
        for (uint32_t m = one != DMB_NONE ? one : 0; m < (one != DMB_NONE ? one + 1 : width); m++)
            for (uint32_t s = 0; s < width; s++)
                A[(size_t)m * width + s] += (one != DMB_NONE ? 1.0 : G[m]) * half[(size_t)r * width + s];
    }
}

/* [D B^T; B 0] with the pivot rows of B; columns that are not solved become identity. */
static void border_cluster(const dmb_sim *sim, uint32_t k, const double *D, double *A)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const dmb_partition partition = dmb_cluster_partition(sim, k);
    const uint32_t n = cluster->columns, size = n + partition.rank;
    const double *B = sim->cluster_matrix + cluster->dense;
    put(D, n, n, A, size);
    for (uint32_t i = 0; i < partition.rank; i++)
        for (uint32_t c = 0; c < n; c++) {
            if (!(sim->cluster_weight[cluster->column + c] > 0.0)) continue;
            const double b = B[(size_t)partition.row_order[i] * n + c];
            A[(size_t)(n + i) * size + c] = A[(size_t)c * size + n + i] = b;
        }
}

/* ---- Assembly ---------------------------------------------------------------------------------------------------- */

static dmb_block_sparse matrix_of(const dmb_sim *sim)
{
    const dmb_block_sparse matrix = {sim->reduced_value, sim->reduced_pivot, sim->reduced_size};
    return matrix;
}

/* Sizes change with the rank: a joint that opens or locks needs no other pattern, only other sizes. */
static void set_sizes(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    uint32_t row = 0;
    for (uint32_t i = 0; i < scene->node_count; i++)
        if (scene->node_block[i] != DMB_NONE && cluster_of(scene, i) == DMB_NONE)
            sim->reduced_size[scene->node_block[i]] = scene->layout.size[i];
    for (uint32_t k = 0; k < scene->cluster_count; k++)
        if (!scene->clusters[k].sparse) sim->reduced_size[scene->clusters[k].block] = cluster_size(sim, k);
    if (scene->sparse_count) dmb_reduced_sparse_sizes(sim);
    for (uint32_t b = 0; b < scene->block_count; b++) {
        sim->reduced_row[b] = row;
        row += sim->reduced_size[b];
    }
}

static void assemble_clusters(dmb_sim *sim, dmb_block_sparse *matrix)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t k = 0; k < scene->cluster_count; k++) {
        const dmb_cluster *cluster = scene->clusters + k;
        if (cluster->sparse) continue;
        const double *D = full_matrix(sim, cluster);
        double *A = dmb_block_sparse_diagonal(&scene->pattern, matrix, cluster->block);
        if (is_bordered(sim)) {
            border_cluster(sim, k, D, A);
            continue;
        }
        reduce_cluster(sim, k, D, A);
    }
}

/* A_ij += R_i^T S_ij R_j; the workspace is that of a component to which one of the nodes belongs. */
static void assemble_off_diagonal(dmb_sim *sim, uint32_t i, uint32_t j, const double *S, size_t offset)
{
    const dmb_scene *scene = sim->scene;
    const uint32_t size = scene->layout.size[i], width = sim->reduced_size[scene->node_block[j]];
    const uint32_t ki = cluster_of(scene, i), kj = cluster_of(scene, j);
    if (ki == DMB_NONE && kj == DMB_NONE) {
        put(S, size, scene->layout.size[j], sim->reduced_value + offset, width);
        return;
    }
    if (kj == DMB_NONE && width == scene->layout.size[j]) {
        null_space_times(sim, i, S, width, sim->reduced_value + offset);
        return;
    }
    double *half = sim->reduced_half;
    memset(half, 0, (size_t)size * width * sizeof(double));
    if (kj == DMB_NONE)
        put(S, size, scene->layout.size[j], half, width);
    else
        times_null_space(sim, j, S, size, half);
    null_space_times(sim, i, half, width, sim->reduced_value + offset);
}

static void assemble_off_diagonals(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i + 1 < scene->node_count; i++) {
        if (scene->off_diagonal_offset[2 * (size_t)i] == SIZE_MAX) continue;
        assemble_off_diagonal(sim, i, i + 1, sim->stiffness_upper + scene->layout.link[i],
                              scene->off_diagonal_offset[2 * (size_t)i]);
        assemble_off_diagonal(sim, i + 1, i, sim->stiffness_lower + scene->layout.link[i],
                              scene->off_diagonal_offset[2 * (size_t)i + 1]);
    }
}

static void assemble_nodes(dmb_sim *sim, const dmb_block_sparse *matrix)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        if (scene->node_block[i] == DMB_NONE || cluster_of(scene, i) != DMB_NONE) continue;
        const uint32_t size = scene->layout.size[i];
        put(dmb_stiffness_of(sim, i), size, size,
            dmb_block_sparse_diagonal(&scene->pattern, matrix, scene->node_block[i]),
            sim->reduced_size[scene->node_block[i]]);
    }
}

static uint32_t node_of_block(const dmb_scene *scene, uint32_t block)
{
    for (uint32_t i = 0; i < scene->node_count; i++)
        if (scene->node_block[i] == block) return i;
    return 0;
}

/* hold: of statics, see reduced_sparse.h */
static void assemble(dmb_sim *sim, int32_t method, int hold)
{
    const dmb_scene *scene = sim->scene;
    dmb_block_sparse matrix = matrix_of(sim);
    sim->reduced_mode->bordered = method == DMB_METHOD_MULTIPLIERS;
    set_sizes(sim);
    dmb_block_sparse_clear(&scene->pattern, &matrix);
    for (uint32_t k = 0; k < scene->cluster_count && !is_bordered(sim); k++)
        if (!scene->clusters[k].sparse) make_null_space(sim, k);
    assemble_nodes(sim, &matrix);
    assemble_clusters(sim, &matrix);
    assemble_off_diagonals(sim);
    dmb_reduced_sparse_put(sim, hold);
}

void dmb_reduced_assemble(dmb_sim *sim)
{
    assemble(sim, DMB_METHOD_INDEPENDENT, 0);
}

int64_t dmb_reduced_factor(dmb_sim *sim, int32_t method, dmb_block_weakest *weakest)
{
    const dmb_scene *scene = sim->scene;
    dmb_block_sparse matrix = matrix_of(sim);
    assemble(sim, method, weakest != NULL);
    const int64_t bad = weakest != NULL ? dmb_block_sparse_factor_watched(&scene->pattern, &matrix, weakest)
                                        : dmb_block_sparse_factor(&scene->pattern, &matrix);
    if (weakest != NULL) weakest->block = node_of_block(scene, weakest->block);
    return bad < 0 ? -1 : (int64_t)node_of_block(scene, (uint32_t)bad);
}

/* Uses the workspace of the largest component, which is no longer needed; equations in the system have one negative
 * eigenvalue each. */
uint32_t dmb_reduced_negative(dmb_sim *sim)
{
    const dmb_block_sparse factored = matrix_of(sim);
    const uint32_t negative = dmb_block_sparse_negative(&sim->scene->pattern, &factored, sim->cluster_full);
    const uint32_t held = dmb_reduced_sparse_rows(sim);
    return negative > held ? negative - held : 0;
}

/* ---- Solution ---------------------------------------------------------------------------------------------------- */

/* R^T times the rows of a node, into the node's part of the right-hand side. */
static void assemble_node(const dmb_sim *sim, uint32_t node, const double *rows)
{
    const dmb_scene *scene = sim->scene;
    double *to = sim->reduced_solution + sim->reduced_row[scene->node_block[node]];
    null_space_times(sim, node, rows + scene->layout.row[node], 1, to);
}

/* z = R y of one node. */
static void scatter_node(const dmb_sim *sim, uint32_t node, double *rows)
{
    const dmb_scene *scene = sim->scene;
    const uint32_t k = cluster_of(scene, node), size = scene->layout.size[node];
    const double *y = sim->reduced_solution + sim->reduced_row[scene->node_block[node]];
    double *z = rows + scene->layout.row[node];
    for (uint32_t c = 0; c < size; c++) {
        uint32_t one = c;
        const double *G = NULL;
        if (k != DMB_NONE) G = row_of_null_space(sim, k, scene->node_place[node] + c, &one);
        z[c] = one != DMB_NONE ? y[one] : 0.0;
        for (uint32_t m = 0; one == DMB_NONE && m < cluster_size(sim, k); m++) z[c] += G[m] * y[m];
    }
}

/* DMB_METHOD_MULTIPLIERS alone: the corrections behind the coordinates. */
static void move_multipliers(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t k = 0; k < scene->cluster_count; k++) {
        const dmb_cluster *cluster = scene->clusters + k;
        if (cluster->sparse) continue;
        const double *change = sim->reduced_solution + sim->reduced_row[cluster->block] + cluster->columns;
        for (uint32_t i = 0; i < sim->partition_rank[k]; i++)
            dmb_cluster_move_multiplier(sim, cluster->row + sim->partition_row[cluster->row + i], change[i]);
    }
}

void dmb_reduced_expand(const dmb_sim *sim, double *z)
{
    for (uint32_t i = 0; i < sim->scene->node_count; i++)
        if (sim->scene->node_block[i] != DMB_NONE) scatter_node(sim, i, z);
}

/* R^T of the right-hand side, solution by blocks, z = R y; multipliers that are unknowns move with it. */
void dmb_reduced_solve(dmb_sim *sim, double *z)
{
    const dmb_scene *scene = sim->scene;
    const dmb_block_sparse matrix = matrix_of(sim);
    memset(sim->reduced_solution, 0, scene->pattern.rows * sizeof(double));
    for (uint32_t i = 0; i < scene->node_count; i++)
        if (scene->node_block[i] != DMB_NONE) assemble_node(sim, i, z);
    dmb_block_sparse_solve(&scene->pattern, &matrix, sim->reduced_row, sim->reduced_solution);
    dmb_reduced_expand(sim, z);
    if (is_bordered(sim)) move_multipliers(sim);
    if (scene->sparse_count) dmb_reduced_sparse_move(sim);
}
