#include "system/solve.h"

#include <float.h>
#include <string.h>

#include "system/linked.h"

/* Rounding of a pose reaches a stiff element's force multiplied by EA/L: this many units of it count as zero. */
#define DMB_ROUNDING_UNITS 4.0

typedef struct norms {
    double rest, all; /* squares of residual and of the terms that balance, [N2] */
} norms;

static norms norms_of(const dmb_sim *sim, const dmb_chain *chain)
{
    const dmb_scene *scene = sim->scene;
    const double arm = 1.0 / (chain->length * chain->length);
    norms n = {0.0, 0.0};
    for (uint32_t i = chain->first; i < chain->first + chain->count; i++) {
        const uint32_t size = scene->layout.size[i], row = scene->layout.row[i];
        for (uint32_t c = 0; c < size; c++) {
            if (!scene->solved_row[row + c]) continue;
            const double weight = 2 * c < size ? 1.0 : arm;
            n.rest += weight * sim->correction[row + c] * sim->correction[row + c];
            n.all += weight * sim->scale_row[row + c] * sim->scale_row[row + c];
        }
    }
    return n;
}

/* Rounding of poses counts where there are elements, joints or, alone and at rest, a wall; overflow never converges:
 * anything is small beside infinity.
 */
static int32_t judge(const dmb_evaluation *evaluation, const dmb_chain *chain, double tolerance, norms n)
{
    const double floor = DMB_ROUNDING_UNITS * DBL_EPSILON;
    if (!(n.all <= DBL_MAX)) return 0;
    if (n.rest <= tolerance * tolerance * n.all) return DMB_CONVERGED;
    const int stiff =
        chain->count > 1 || chain->linked || (!evaluation->dynamic && evaluation->sim->scene->element_count == 0);
    return stiff && n.rest <= floor * floor * evaluation->rounding ? DMB_AT_ROUNDING : 0;
}

double dmb_relative_residual(const dmb_evaluation *evaluation, double tolerance, int32_t *converged)
{
    const dmb_scene *scene = evaluation->sim->scene;
    double worst = 0.0;
    *converged = DMB_CONVERGED;
    for (uint32_t c = 0; c < scene->chain_count; c++) {
        const norms n = norms_of(evaluation->sim, scene->chains + c);
        const int32_t verdict = judge(evaluation, scene->chains + c, tolerance, n);
        if (verdict == 0) *converged = 0;
        if (verdict == DMB_AT_ROUNDING && *converged) *converged = DMB_AT_ROUNDING;
        worst = fmax(worst, !(n.all <= DBL_MAX) ? (double)INFINITY : n.all > 0.0 ? sqrt(n.rest / n.all) : 0.0);
    }
    return worst;
}

double dmb_balance_norm(const dmb_sim *sim)
{
    double all = 0.0;
    for (uint32_t c = 0; c < sim->scene->chain_count; c++) all += norms_of(sim, sim->scene->chains + c).all;
    return sqrt(all);
}

static dmb_block_matrix matrix_of(const dmb_sim *sim)
{
    const dmb_block_matrix matrix = {sim->stiffness_diagonal, sim->stiffness_lower, sim->stiffness_upper, sim->pivot};
    return matrix;
}

int64_t dmb_factor_matrix(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    dmb_block_matrix matrix = matrix_of(sim);
    for (uint32_t c = 0; c < scene->chain_count; c++) {
        if (scene->chains[c].linked) continue;
        const int64_t bad = dmb_block_factor(&scene->layout, &matrix, scene->chains[c].first, scene->chains[c].count);
        if (bad >= 0) return bad;
    }
    return scene->cluster_count ? dmb_linked_factor(sim, NULL) : -1;
}

int64_t dmb_factor_stiffness(dmb_sim *sim, dmb_block_weakest *weakest)
{
    const dmb_scene *scene = sim->scene;
    dmb_block_matrix matrix = matrix_of(sim);
    dmb_block_weakest chain_weakest;
    weakest->ratio = (double)INFINITY;
    for (uint32_t c = 0; c < scene->chain_count; c++) {
        const dmb_chain *chain = scene->chains + c;
        if (chain->linked) continue;
        const int64_t bad =
            dmb_block_factor_watched(&scene->layout, &matrix, chain->first, chain->count, &chain_weakest);
        if (chain_weakest.ratio < weakest->ratio) *weakest = chain_weakest;
        if (bad >= 0) return bad;
    }
    if (scene->cluster_count == 0) return -1;
    const int64_t bad = dmb_linked_factor(sim, &chain_weakest);
    if (chain_weakest.ratio < weakest->ratio) *weakest = chain_weakest;
    return bad;
}

/* The iteration matrix with the stiffness taken away. */
int32_t dmb_factor_mass(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_block_layout *layout = &sim->scene->layout;
    const uint32_t n = sim->scene->node_count;
    const int32_t status = dmb_system_evaluate(evaluation);
    if (status < 0) return status;
    memset(sim->stiffness_diagonal, 0, layout->diag[n] * sizeof(double));
    memset(sim->stiffness_upper, 0, layout->link[n - 1] * sizeof(double));
    memset(sim->stiffness_lower, 0, layout->link[n - 1] * sizeof(double));
    memset(sim->constraint_tangent, 0, sim->scene->tangent_count * sizeof(double));
    dmb_system_iteration_matrix(evaluation);
    const int64_t bad = dmb_factor_matrix(sim);
    evaluation->element = (uint32_t)bad;
    return bad >= 0 ? DMB_ERR_SINGULAR : DMB_OK;
}

void dmb_solve_correction(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    const dmb_block_matrix matrix = matrix_of(sim);
    for (uint32_t i = 0; i < scene->row_count; i++)
        sim->correction[i] = scene->solved_row[i] ? -sim->correction[i] : 0.0;
    for (uint32_t c = 0; c < scene->chain_count; c++)
        if (!scene->chains[c].linked)
            dmb_block_solve(&scene->layout, &matrix, scene->chains[c].first, scene->chains[c].count, sim->correction);
    if (scene->cluster_count) dmb_linked_solve(sim);
}
