#include "analysis/linear/stiffness.h"

#include "math/inertia.h"
#include "sim/node.h"
#include "system/solve/reduced_sparse.h"
#include "system/solve/solve.h"

/* Part of the largest stiffness, rotations over the length scale, that counts as 0. */
#define DMB_STIFFNESS_ROUNDING 1e-14

/* Shift of the diagonal with which eigenvalues of rounding size are positive. */
static void raise_rounding(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    const double turning = scene->length_scale * scene->length_scale;
    double most = 0.0;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t size = scene->layout.size[i], row = scene->layout.row[i];
        for (uint32_t c = 0; c < size; c++) {
            const double weight = 2 * c < size ? 1.0 : turning;
            const double stiffness = dmb_stiffness_of(sim, i)[(size_t)(size + 1) * c] / weight;
            sim->scale_row[row + c] = weight;
            if (scene->solved_row[row + c]) most = fmax(most, fabs(stiffness));
        }
    }
    for (uint32_t i = 0; i < scene->row_count; i++) sim->scale_row[i] *= DMB_STIFFNESS_ROUNDING * most;
}

double dmb_stiffness_rounding(const dmb_sim *sim)
{
    return sim->scale_row[0]; /* a displacement, of weight 1 */
}

uint32_t dmb_stiffness_negative_of_chains(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    uint32_t negative = 0;
    raise_rounding(sim);
    for (uint32_t c = 0; c < scene->chain_count; c++)
        if (!scene->chains[c].jointed)
            negative +=
                dmb_block_negative(&scene->layout, sim->stiffness_diagonal, sim->stiffness_lower, sim->stiffness_upper,
                                   sim->scale_row, scene->chains[c].first, scene->chains[c].count);
    return negative;
}

/* The room is that of the largest cluster, whose reduction is done with. */
static uint32_t negative_of_blocks(const dmb_sim *sim)
{
    const dmb_block_sparse factored = {sim->reduced_value, sim->reduced_pivot, sim->reduced_size};
    const uint32_t negative = dmb_block_sparse_negative(&sim->scene->pattern, &factored, sim->cluster_full);
    const uint32_t held = dmb_reduced_sparse_rows(sim);
    return negative > held ? negative - held : 0;
}

int64_t dmb_stiffness_factor(dmb_sim *sim, dmb_block_weakest *weakest, int32_t *negative)
{
    const uint32_t chains = dmb_stiffness_negative_of_chains(sim);
    const int64_t bad = dmb_factor_stiffness(sim, weakest);
    *negative = bad >= 0 ? 0 : (int32_t)(chains + (sim->scene->cluster_count ? negative_of_blocks(sim) : 0));
    return bad;
}

/* Residual of a state, relative to the forces that balance in it, up to which it counts as equilibrium. */
#define DMB_STATE_BALANCED 1e-6

int32_t dmb_stiffness_balanced(dmb_sim *sim, const char *who, const dmb_evaluation *evaluation)
{
    const dmb_residual_norm norm = dmb_residual_norm_of(evaluation, DMB_STATE_BALANCED);
    if (norm.converged) return DMB_OK;
    dmb_message_set(&sim->message,
                    "%s: the state is no equilibrium, relative residual = %g, must be <= %g; call dmb_analysis_static "
                    "first",
                    who, norm.relative, DMB_STATE_BALANCED);
    return DMB_ERR_ORDER;
}

int32_t dmb_stiffness_explain(dmb_sim *sim, const char *who, uint32_t node)
{
    const dmb_owner owner = dmb_owner_of_node(sim->scene, node);
    dmb_message_set(&sim->message, "%s: %s: nothing holds it, the stiffness is singular", who, owner.text.text);
    return DMB_ERR_SINGULAR;
}
