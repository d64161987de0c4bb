/* Sparse constraint components: large ones without dense matrices. Instead of dependent and independent coordinates
 * only rows are chosen, and every task is a linear system over the nodes and the multipliers of those rows, in the
 * blocks of the scene's pattern (eq:joints.quasi-definite),
 *
 *     [I  (BW)^T] [ x ]   [ a ]
 *     [BW   0   ] [-f ] = [ d ]        W: metric of the columns
 *
 * with a = 0 it gives the shortest move with B W x = d; with d = 0 the multipliers that minimise the remainder of a.
 * The corrections of Newton come from [S B^T; B 0] (system/solve/reduced_system_sparse). The cost is linear in the
 * number of bodies for chains and trees; for loops it depends on their width in the order of elimination. */
#include "system/constrain/constrain.h"

#include <string.h>

#include "constraint/partition.h"

/* One storage for all tasks, in this order within an evaluation:
 *
 *     call                      rows and columns                     result
 *     -----------------------   ----------------------------------   ------------------------------------------------
 *     dmb_sparse_choose         all active rows, cluster_weight      rows kept, quality; when the partition is chosen
 *     dmb_sparse_factor         chosen rows, cluster_metric          factors, near-redundant rows noted; places of
 *                                                                    the rows first (dmb_sparse_note)
 *       drop_near_redundant     without these                        projections of speeds and accelerations
 *     dmb_sparse_project        a = 0, d given                       move, read by dmb_sparse_get
 *     dmb_sparse_balance        d = 0, a = W (residual + B^T f)      change of the multipliers f
 *
 * The metric lets displacements absorb more of a projection than rotations of bodies (dmb_clusters_weigh). */
dmb_block_signed dmb_sparse_matrix(const dmb_sim *sim)
{
    const dmb_block_signed matrix = {sim->sparse_value, sim->sparse_size,   sim->sparse_plus,
                                     sim->sparse_row,   sim->sparse_length, sim->reduced_pivot};
    return matrix;
}

double dmb_sparse_length(const dmb_sim *sim, const dmb_constraint *c, uint32_t k, const double *weight)
{
    const dmb_scene *scene = sim->scene;
    const double *b = dmb_sparse_row(sim, c, k);
    double sum = 0.0;
    for (uint32_t n = 0; n < c->node_count; n++) {
        const double *w = weight + dmb_sparse_column(scene, c->node[n]), *part = b + c->column[n];
        for (uint32_t i = 0; i < scene->layout.size[c->node[n]]; i++) sum += part[i] * w[i] * (part[i] * w[i]);
    }
    return sum;
}

/* ---- Sizes and places -------------------------------------------------------------------------------------------- */

uint32_t dmb_sparse_number(dmb_sim *sim)
{
    uint32_t row = 0;
    for (uint32_t b = 0; b < sim->scene->block_count; b++) {
        sim->sparse_row[b] = row;
        row += sim->sparse_size[b];
    }
    return row;
}

/* Numbers the rows with a slot consecutively in their blocks. */
static void place_rows(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    memset(sim->sparse_plus, 0, scene->block_count * sizeof(uint32_t));
    for (uint32_t k = 0; k < scene->cluster_count; k++) {
        const dmb_cluster *cluster = scene->clusters + k;
        for (uint32_t i = cluster->node; i < cluster->node + cluster->node_count && cluster->sparse; i++)
            sim->sparse_plus[scene->node_block[scene->cluster_nodes[i]]] = scene->layout.size[scene->cluster_nodes[i]];
    }
    memcpy(sim->sparse_size, sim->sparse_plus, scene->block_count * sizeof(uint32_t));
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        for (uint32_t r = c->row; r < c->row + c->rows && dmb_is_sparse(scene, i); r++)
            if (sim->sparse_slot[r] != DMB_NONE) sim->sparse_slot[r] = sim->sparse_size[c->block]++;
    }
    (void)dmb_sparse_number(sim);
}

void dmb_sparse_note(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t k = 0; k < scene->cluster_count; k++) {
        const dmb_cluster *cluster = scene->clusters + k;
        const uint32_t *order = sim->partition_row + cluster->row;
        for (uint32_t i = 0; i < cluster->rows; i++)
            sim->sparse_slot[cluster->row + order[i]] = i < sim->partition_rank[k] ? 0 : DMB_NONE;
    }
    place_rows(sim);
}

/* ---- The matrix -------------------------------------------------------------------------------------------------- */

/* Offsets of B^T of row i of a block, of a node's column c at to[step * c]. *before: the node is eliminated with the
 * row or before it. */
static double *place_of(const dmb_sim *sim, uint32_t block, uint32_t i, uint32_t node_block, size_t *step, int *before)
{
    const dmb_block_pattern *pattern = &sim->scene->pattern;
    const uint32_t p = pattern->position[node_block], q = pattern->position[block];
    *before = p <= q;
    *step = p <= q ? sim->sparse_size[block] : 1;
    if (p == q) return sim->sparse_value + pattern->diagonal[q] + i;
    const uint32_t e = dmb_block_pattern_entry(pattern, p < q ? p : q, p < q ? q : p);
    return sim->sparse_value + pattern->upper[e] + (p < q ? i : (size_t)i * sim->sparse_size[node_block]);
}

/* Adds a row of B W; its part eliminated with it or before defines the length that scales its pivot. */
static void put_row(dmb_sim *sim, const dmb_constraint *c, uint32_t k, const double *weight)
{
    const dmb_scene *scene = sim->scene;
    const uint32_t i = sim->sparse_slot[c->row + k];
    const double *b = dmb_sparse_row(sim, c, k);
    double length = 0.0;
    for (uint32_t n = 0; n < c->node_count; n++) {
        size_t step;
        int before;
        const double *w = weight + dmb_sparse_column(scene, c->node[n]), *part = b + c->column[n];
        double *to = place_of(sim, c->block, i, scene->node_block[c->node[n]], &step, &before);
        for (uint32_t s = 0; s < scene->layout.size[c->node[n]]; s++) {
            const double value = part[s] * w[s];
            to[step * s] = value;
            if (before) length += value * value;
        }
    }
    sim->sparse_length[sim->sparse_row[c->block] + i] = length;
}

/* Identity in the rows of nodes, B W in those of the chosen multipliers, upper blocks only. */
static void put_matrix(dmb_sim *sim, const double *weight)
{
    const dmb_scene *scene = sim->scene;
    const dmb_block_signed matrix = dmb_sparse_matrix(sim);
    dmb_block_signed_clear(&scene->pattern, &matrix);
    for (uint32_t b = 0; b < scene->block_count; b++) {
        double *D = sim->sparse_value + scene->pattern.diagonal[scene->pattern.position[b]];
        for (uint32_t s = 0; s < sim->sparse_plus[b]; s++) D[(sim->sparse_size[b] + (size_t)1) * s] = 1.0;
    }
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        for (uint32_t k = 0; k < c->rows && dmb_is_sparse(scene, i); k++)
            if (sim->sparse_slot[c->row + k] != DMB_NONE) put_row(sim, c, k, weight);
    }
}

/* ---- Choice ------------------------------------------------------------------------------------------------------ */

/* Orders the rows of a component: chosen ones first, both groups ascending. Returns the quality, the smallest sine. */
static double order_rows(dmb_sim *sim, uint32_t k)
{
    const dmb_scene *scene = sim->scene;
    const dmb_cluster *cluster = scene->clusters + k;
    uint32_t *order = sim->partition_row + cluster->row, count = 0;
    double least = 1.0;
    for (int chosen = 1; chosen >= 0; chosen--) {
        for (uint32_t i = cluster->constraint; i < cluster->constraint + cluster->constraint_count; i++) {
            const dmb_constraint *c = scene->constraints + i;
            for (uint32_t r = c->row; r < c->row + c->rows; r++) {
                const uint32_t slot = sim->sparse_slot[r];
                const double ratio = slot == DMB_NONE ? 0.0 : sim->sparse_length[sim->sparse_row[c->block] + slot];
                if ((ratio > 0.0) != chosen) continue;
                order[count++] = r - cluster->row;
                if (chosen) least = fmin(least, ratio);
            }
        }
        if (chosen) sim->partition_rank[k] = count;
    }
    return sqrt(least);
}

/* All active rows are entered; elimination keeps those whose squared sine against the earlier ones is above
 * DMB_SPARSE_RANK. Pivots need no search among blocks, because the matrix is quasi-definite. */
void dmb_sparse_choose(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    const dmb_block_signed matrix = dmb_sparse_matrix(sim);
    if (scene->sparse_count == 0) return;
    for (uint32_t r = 0; r < scene->constraint_row_count; r++)
        sim->sparse_slot[r] = sim->constraint_type[r] != DMB_ROW_IDLE ? 0 : DMB_NONE;
    place_rows(sim);
    put_matrix(sim, sim->cluster_weight);
    dmb_block_signed_choose(&scene->pattern, &matrix, DMB_SPARSE_RANK);
    for (uint32_t k = 0; k < scene->cluster_count; k++)
        if (scene->clusters[k].sparse) sim->partition_quality[k] = order_rows(sim, k);
    sim->reduced_mode->metric = 0;
}

/* ---- Factors ----------------------------------------------------------------------------------------------------- */

/* Smallest sine of each component; 1 if any row is near-redundant. */
static int note_quality(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    int near_redundant = 0;
    for (uint32_t k = 0; k < scene->cluster_count; k++)
        if (scene->clusters[k].sparse) sim->cluster_quality[k] = 1.0;
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        for (uint32_t r = c->row; r < c->row + c->rows && dmb_is_sparse(scene, i); r++) {
            if (sim->sparse_slot[r] == DMB_NONE) continue;
            const double ratio = sim->sparse_length[sim->sparse_row[c->block] + sim->sparse_slot[r]];
            near_redundant = near_redundant || ratio < DMB_NEAR_REDUNDANT_PIVOT;
            sim->cluster_quality[c->cluster] = fmin(sim->cluster_quality[c->cluster], sqrt(fmax(ratio, 0.0)));
        }
    }
    return near_redundant;
}

/* First constraint row of a block, for the message. */
static uint32_t row_of_block(const dmb_scene *scene, uint32_t block)
{
    for (uint32_t i = 0; i < scene->constraint_count; i++)
        if (dmb_is_sparse(scene, i) && scene->constraints[i].block == block) return scene->constraints[i].row;
    return 0;
}

/* drop_near_redundant: second factorisation in a step that has such rows, for projections of speeds and accelerations.
 * Places of the rows stay those of the first one; excluded rows get 0. */
int32_t dmb_sparse_factor(dmb_sim *sim, int drop_near_redundant)
{
    const dmb_scene *scene = sim->scene;
    const dmb_block_signed matrix = dmb_sparse_matrix(sim);
    if (!drop_near_redundant) dmb_sparse_note(sim);
    put_matrix(sim, sim->cluster_metric);
    const int64_t bad =
        dmb_block_signed_factor(&scene->pattern, &matrix, drop_near_redundant ? DMB_NEAR_REDUNDANT_PIVOT : 0.0);
    if (bad >= 0) return dmb_cluster_singular(sim, row_of_block(scene, (uint32_t)bad), 0.0);
    if (!drop_near_redundant) sim->reduced_mode->near_redundant = note_quality(sim);
    sim->reduced_mode->metric = 1;
    return DMB_OK;
}

int32_t dmb_sparse_refresh(dmb_sim *sim)
{
    return sim->reduced_mode->metric ? DMB_OK : dmb_sparse_factor(sim, 0);
}

/* ---- Projection -------------------------------------------------------------------------------------------------- */

/* Copies d into the rows of the multipliers. */
static void put_rows(dmb_sim *sim, const double *d)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        for (uint32_t r = c->row; r < c->row + c->rows && dmb_is_sparse(scene, i); r++)
            if (sim->sparse_slot[r] != DMB_NONE)
                sim->sparse_vector[sim->sparse_row[c->block] + sim->sparse_slot[r]] = d[r];
    }
}

void dmb_sparse_project(dmb_sim *sim, const double *d)
{
    const dmb_block_signed matrix = dmb_sparse_matrix(sim);
    memset(sim->sparse_vector, 0, sim->scene->pattern.rows * sizeof(double));
    put_rows(sim, d);
    dmb_block_signed_solve(&sim->scene->pattern, &matrix, sim->sparse_vector);
}

/* The unknowns are x/W: the metric turns them into moves. */
void dmb_sparse_get(const dmb_sim *sim, uint32_t k, double *x)
{
    const dmb_scene *scene = sim->scene;
    const dmb_cluster *cluster = scene->clusters + k;
    const double *metric = sim->cluster_metric + cluster->column;
    for (uint32_t i = cluster->node; i < cluster->node + cluster->node_count; i++) {
        const uint32_t node = scene->cluster_nodes[i], at = scene->node_place[node];
        const double *from = sim->sparse_vector + sim->sparse_row[scene->node_block[node]];
        for (uint32_t c = 0; c < scene->layout.size[node]; c++) x[at + c] = metric[at + c] * from[c];
    }
}

void dmb_sparse_deficit(const dmb_sim *sim, const double *level, const double *v, double *d)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        for (uint32_t k = 0; k < c->rows && dmb_is_sparse(scene, i); k++) {
            const double *b = dmb_sparse_row(sim, c, k);
            double sum = level[c->row + k];
            for (uint32_t n = 0; n < c->node_count; n++)
                for (uint32_t s = 0; s < scene->layout.size[c->node[n]]; s++)
                    sum += b[c->column[n] + s] * v[scene->layout.row[c->node[n]] + s];
            d[c->row + k] = -sum;
        }
    }
}

/* ---- Multipliers ------------------------------------------------------------------------------------------------- */

/* residual += B^T f of a constraint; scale (may be NULL) += the magnitudes. */
static void add_forces(const dmb_sim *sim, const dmb_constraint *c, double *residual, double *scale)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t k = 0; k < c->rows; k++) {
        const double f = sim->trial.multiplier[c->row + k], *b = dmb_sparse_row(sim, c, k);
        for (uint32_t n = 0; n < c->node_count && f != 0.0; n++)
            for (uint32_t s = 0; s < scene->layout.size[c->node[n]]; s++) {
                const double force = f * b[c->column[n] + s];
                residual[scene->layout.row[c->node[n]] + s] += force;
                if (scale != NULL) scale[scene->layout.row[c->node[n]] + s] += fabs(force);
            }
    }
}

static void add_all_forces(const dmb_sim *sim, double *residual, double *scale)
{
    for (uint32_t i = 0; i < sim->scene->constraint_count; i++)
        if (dmb_is_sparse(sim->scene, i)) add_forces(sim, sim->scene->constraints + i, residual, scale);
}

/* Initial multipliers: 0 in rows that are not chosen, and after a diverged iteration in all rows. */
static void begin_multipliers(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        for (uint32_t r = c->row; r < c->row + c->rows && dmb_is_sparse(scene, i); r++)
            if (sim->sparse_slot[r] == DMB_NONE || !isfinite(sim->trial.multiplier[r])) sim->trial.multiplier[r] = 0.0;
    }
}

/* W (residual + B^T f) by nodes into sparse_vector, 0 by rows. Right-hand side a of the system; d = 0. */
static void put_residual(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    memset(sim->sparse_vector, 0, scene->pattern.rows * sizeof(double));
    for (uint32_t k = 0; k < scene->cluster_count; k++) {
        const dmb_cluster *cluster = scene->clusters + k;
        for (uint32_t i = cluster->node; i < cluster->node + cluster->node_count && cluster->sparse; i++) {
            const uint32_t node = scene->cluster_nodes[i];
            const double *metric = sim->cluster_metric + dmb_sparse_column(scene, node);
            double *to = sim->sparse_vector + sim->sparse_row[scene->node_block[node]];
            for (uint32_t s = 0; s < scene->layout.size[node]; s++)
                to[s] = metric[s] * sim->raw_residual[scene->layout.row[node] + s];
        }
    }
}

static void update_multipliers(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        for (uint32_t r = c->row; r < c->row + c->rows && dmb_is_sparse(scene, i); r++)
            if (sim->sparse_slot[r] != DMB_NONE)
                sim->trial.multiplier[r] -= sim->sparse_vector[sim->sparse_row[c->block] + sim->sparse_slot[r]];
    }
}

/* Changes the multipliers by those that minimise W (residual + B^T f). Rows left out of the factors keep their values
 * from Newton. */
void dmb_sparse_balance(dmb_sim *sim, int given)
{
    const dmb_scene *scene = sim->scene;
    const dmb_block_signed matrix = dmb_sparse_matrix(sim);
    if (scene->sparse_count == 0) return;
    if (!given && dmb_sparse_refresh(sim) >= 0) {
        begin_multipliers(sim);
        memcpy(sim->raw_residual, sim->residual, scene->row_count * sizeof(double));
        add_all_forces(sim, sim->raw_residual, NULL);
        put_residual(sim);
        dmb_block_signed_solve(&scene->pattern, &matrix, sim->sparse_vector);
        update_multipliers(sim);
    }
    add_all_forces(sim, sim->residual, sim->scale_row);
}

/* ---- Violation --------------------------------------------------------------------------------------------------- */

double dmb_sparse_violation(const dmb_sim *sim, int32_t dropped, uint32_t *row)
{
    const dmb_scene *scene = sim->scene;
    double most = 0.0;
    for (uint32_t k = 0; k < scene->cluster_count; k++) {
        const dmb_cluster *cluster = scene->clusters + k;
        for (uint32_t i = cluster->constraint; i < cluster->constraint + cluster->constraint_count && cluster->sparse;
             i++) {
            const dmb_constraint *c = scene->constraints + i;
            for (uint32_t r = 0; r < c->rows; r++) {
                const double value = fabs(sim->constraint_value[c->row + r]);
                if (value == 0.0 || (sim->sparse_slot[c->row + r] == DMB_NONE) != dropped) continue;
                const double length = dmb_sparse_length(sim, c, r, sim->cluster_weight);
                const double violation = length > 0.0 ? value / sqrt(length) : value;
                if (!(violation > most)) continue;
                most = violation;
                *row = c->row + r;
            }
        }
    }
    return most;
}
