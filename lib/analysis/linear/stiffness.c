#include "analysis/linear/stiffness.h"

#include "math/inertia.h"
#include "sim/node.h"
#include "system/solve/reduced_system.h"
#include "system/solve/solve.h"

/* Part of the largest stiffness, rotations over the length scale, that counts as 0. */
#define DMB_STIFFNESS_ROUNDING 1e-14

/* Shift of the diagonal with which eigenvalues of rounding size are positive. */
static double rounding_of(const dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    const double turning = scene->length_scale * scene->length_scale;
    double most = 0.0;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t size = scene->layout.size[i], row = scene->layout.row[i];
        for (uint32_t c = 0; c < size; c++) {
            const double weight = 2 * c < size ? 1.0 : turning;
            const double stiffness = dmb_stiffness_of(sim, i)[(size_t)(size + 1) * c] / weight;
            if (scene->solved_row[row + c]) most = fmax(most, fabs(stiffness));
        }
    }
    return DMB_STIFFNESS_ROUNDING * most;
}

uint32_t dmb_stiffness_negative_of_chains(const dmb_sim *sim, double *rounding)
{
    const dmb_scene *scene = sim->scene;
    uint32_t negative = 0;
    *rounding = rounding_of(sim);
    const double raise[2] = {*rounding, scene->length_scale * scene->length_scale * *rounding};
    for (uint32_t c = 0; c < scene->chain_count; c++)
        if (!scene->chains[c].jointed)
            negative += dmb_block_negative(&scene->layout, sim->stiffness_diagonal, sim->stiffness_lower,
                                           sim->stiffness_upper, raise, scene->chains[c].first, scene->chains[c].count);
    return negative;
}

int64_t dmb_stiffness_factor(dmb_sim *sim, dmb_block_weakest *weakest, int32_t *negative)
{
    double rounding;
    const uint32_t chains = dmb_stiffness_negative_of_chains(sim, &rounding);
    const int64_t bad = dmb_factor_stiffness(sim, weakest);
    *negative = bad >= 0 ? 0 : (int32_t)(chains + (sim->scene->cluster_count ? dmb_reduced_negative(sim) : 0));
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
