/* Sparse components in the reduced system (eq:joints.saddle; form and scaling: solve.h). Multipliers are eliminated
 * with the node of their constraint's block, in the order of sparse_slot:
 *
 *     block of a node      columns of the node   of its multipliers
 *     -----------------    -------------------   ------------------
 *     rows of the node     S                     B^T D
 *     its multipliers      D B                   0
 *
 * Rows of a constraint between two nodes thus are in the block of one of them and in the off-diagonal blocks to the
 * other, which the pattern of the scene provides. A body at rest that joints alone hold has S = 0, hence `hold`. LU
 * factors exchange rows inside a block. */
#include "system/solve/solve.h"

#include "system/constrain/constrain.h"

void dmb_reduced_sparse_sizes(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t k = 0; k < scene->cluster_count; k++) {
        const dmb_cluster *cluster = scene->clusters + k;
        for (uint32_t i = cluster->node; i < cluster->node + cluster->node_count && cluster->sparse; i++) {
            const uint32_t block = scene->node_block[scene->cluster_nodes[i]];
            sim->reduced_size[block] = sim->sparse_size[block];
        }
    }
}

uint32_t dmb_reduced_sparse_rows(const dmb_sim *sim)
{
    uint32_t rows = 0;
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++)
        if (sim->scene->clusters[k].sparse) rows += sim->partition_rank[k];
    return rows;
}

/* ---- Stiffness beside a row -------------------------------------------------------------------------------------- */

/* [N/m] Largest diagonal entry of a node in weighted columns. */
static double stiffness_of(const dmb_sim *sim, uint32_t node)
{
    const double *weight = sim->cluster_weight + dmb_sparse_column(sim->scene, node), *S = dmb_stiffness_of(sim, node);
    const uint32_t size = sim->scene->layout.size[node];
    double most = 0.0;
    for (uint32_t c = 0; c < size; c++) most = fmax(most, fabs(S[(size_t)(size + 1) * c]) * weight[c] * weight[c]);
    return most;
}

/* [N/m] Largest diagonal entry of all nodes of sparse components, for nodes without stiffness. */
static double largest_stiffness(const dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    double most = 0.0;
    for (uint32_t k = 0; k < scene->cluster_count; k++) {
        const dmb_cluster *cluster = scene->clusters + k;
        for (uint32_t i = cluster->node; i < cluster->node + cluster->node_count && cluster->sparse; i++)
            most = fmax(most, stiffness_of(sim, scene->cluster_nodes[i]));
    }
    return most > 0.0 ? most : 1.0;
}

/* Stiffness of the softer node of a constraint: the stiffer one would dominate the pivot. Below 1e-6 of the largest
 * stiffness it is limited, so that a node without stiffness does not make its rows vanish. */
static double stiffness_beside(const dmb_sim *sim, const dmb_constraint *c, double largest)
{
    double least = (double)INFINITY;
    for (uint32_t n = 0; n < c->node_count; n++) least = fmin(least, stiffness_of(sim, c->node[n]));
    return least > 1e-6 * largest ? least : 1e-6 * largest;
}

/* ---- Blocks ------------------------------------------------------------------------------------------------------ */

static double *block_of(const dmb_sim *sim, uint32_t i, uint32_t j)
{
    return sim->reduced_value + dmb_block_pattern_offset(&sim->scene->pattern, i, j);
}

/* Tangent of joint forces and of B^T lambda. Constrained columns have weight 0 and stay as they are. */
static void put_tangent(dmb_sim *sim, const dmb_constraint *c)
{
    const dmb_scene *scene = sim->scene;
    const double *K = sim->constraint_tangent + c->tangent;
    for (uint32_t m = 0; m < c->node_count; m++)
        for (uint32_t n = 0; n < c->node_count; n++) {
            const uint32_t i = scene->node_block[c->node[m]], j = scene->node_block[c->node[n]];
            const double *wi = sim->cluster_weight + dmb_sparse_column(scene, c->node[m]);
            const double *wj = sim->cluster_weight + dmb_sparse_column(scene, c->node[n]);
            double *to = block_of(sim, i, j);
            for (uint32_t r = 0; r < scene->layout.size[c->node[m]]; r++)
                for (uint32_t s = 0; s < scene->layout.size[c->node[n]]; s++)
                    if (wi[r] > 0.0 && wj[s] > 0.0)
                        to[(size_t)r * sim->reduced_size[j] + s] +=
                            K[(size_t)(c->column[m] + r) * c->columns + c->column[n] + s];
        }
}

/* Row i of the multipliers in the block of the constraint, and the corresponding column. */
static void put_row(dmb_sim *sim, const dmb_constraint *c, const double *b, double factor, uint32_t i)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t n = 0; n < c->node_count; n++) {
        const uint32_t block = scene->node_block[c->node[n]];
        const double *w = sim->cluster_weight + dmb_sparse_column(scene, c->node[n]);
        double *row = block_of(sim, c->block, block) + (size_t)i * sim->reduced_size[block];
        double *column = block_of(sim, block, c->block) + i;
        for (uint32_t s = 0; s < scene->layout.size[c->node[n]]; s++) {
            if (!(w[s] > 0.0)) continue;
            row[s] = factor * b[c->column[n] + s];
            column[(size_t)s * sim->reduced_size[c->block]] = factor * b[c->column[n] + s];
        }
    }
}

/* S += factor b^T b. B^T B times a stiffness: changes no solution, since B z = 0. */
static void hold_row(dmb_sim *sim, const dmb_constraint *c, const double *b, double factor)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t m = 0; m < c->node_count; m++)
        for (uint32_t n = 0; n < c->node_count; n++) {
            const uint32_t i = scene->node_block[c->node[m]], j = scene->node_block[c->node[n]];
            const double *wi = sim->cluster_weight + dmb_sparse_column(scene, c->node[m]);
            const double *wj = sim->cluster_weight + dmb_sparse_column(scene, c->node[n]);
            double *to = block_of(sim, i, j);
            for (uint32_t r = 0; r < scene->layout.size[c->node[m]]; r++)
                for (uint32_t s = 0; s < scene->layout.size[c->node[n]]; s++)
                    if (wi[r] > 0.0 && wj[s] > 0.0)
                        to[(size_t)r * sim->reduced_size[j] + s] += factor * b[c->column[m] + r] * b[c->column[n] + s];
        }
}

/* Row k is scaled by stiffness over its length in weighted columns: D B W then has entries of the size of the stiffness
 * beside it. With `hold` B^T B times that stiffness over the squared length is added to S. */
void dmb_reduced_sparse_put(dmb_sim *sim, int hold)
{
    const dmb_scene *scene = sim->scene;
    if (scene->sparse_count == 0) return;
    const double largest = largest_stiffness(sim);
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        if (!dmb_is_sparse(scene, i)) continue;
        const double stiffness = stiffness_beside(sim, c, largest);
        put_tangent(sim, c);
        for (uint32_t k = 0; k < c->rows; k++) {
            if (sim->sparse_slot[c->row + k] == DMB_NONE) continue;
            const double *b = dmb_sparse_row(sim, c, k), square = dmb_sparse_length(sim, c, k, sim->cluster_weight);
            sim->sparse_scale[c->row + k] = stiffness / sqrt(square);
            put_row(sim, c, b, sim->sparse_scale[c->row + k], sim->sparse_slot[c->row + k]);
            if (hold) hold_row(sim, c, b, stiffness / square);
        }
    }
}

/* The unknown is D^-1 df: its multiplier moves by D times it. */
void dmb_reduced_sparse_move(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        for (uint32_t r = c->row; r < c->row + c->rows && dmb_is_sparse(scene, i); r++)
            if (sim->sparse_slot[r] != DMB_NONE)
                dmb_cluster_move_multiplier(
                    sim, r,
                    sim->sparse_scale[r] * sim->reduced_solution[sim->reduced_row[c->block] + sim->sparse_slot[r]]);
    }
}
