#include "system/solve.h"

#include <float.h>

/* Rounding of a pose reaches a stiff element's force multiplied by EA/L: this many units of it count as zero. */
#define DMB_ROUNDING_UNITS 4.0

double dmb_relative_residual(const dmb_evaluation *evaluation, double tolerance, int32_t *converged)
{
    const dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    const double arm = 1.0 / (scene->length_scale * scene->length_scale);
    double rest = 0.0, all = 0.0;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t size = scene->layout.size[i], row = scene->layout.row[i];
        for (uint32_t c = 0; c < size; c++) {
            if (!scene->solved_row[row + c]) continue;
            const double weight = 2 * c < size ? 1.0 : arm;
            rest += weight * sim->correction[row + c] * sim->correction[row + c];
            all += weight * sim->scale_row[row + c] * sim->scale_row[row + c];
        }
    }
    const double floor = DMB_ROUNDING_UNITS * DBL_EPSILON;
    *converged = rest <= tolerance * tolerance * all || rest <= floor * floor * evaluation->rounding;
    return all > 0.0 ? sqrt(rest / all) : 0.0;
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
        const int64_t bad = dmb_block_factor(&scene->layout, &matrix, scene->chains[c].first, scene->chains[c].count);
        if (bad >= 0) return bad;
    }
    return -1;
}

int64_t dmb_factor_stiffness(dmb_sim *sim, dmb_block_weakest *weakest)
{
    const dmb_scene *scene = sim->scene;
    dmb_block_matrix matrix = matrix_of(sim);
    dmb_block_weakest chain_weakest;
    weakest->ratio = (double)INFINITY;
    for (uint32_t c = 0; c < scene->chain_count; c++) {
        const dmb_chain *chain = scene->chains + c;
        const int64_t bad =
            dmb_block_factor_watched(&scene->layout, &matrix, chain->first, chain->count, &chain_weakest);
        if (chain_weakest.ratio < weakest->ratio) *weakest = chain_weakest;
        if (bad >= 0) return bad;
    }
    return -1;
}

void dmb_solve_correction(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    const dmb_block_matrix matrix = matrix_of(sim);
    for (uint32_t i = 0; i < scene->row_count; i++)
        sim->correction[i] = scene->solved_row[i] ? -sim->correction[i] : 0.0;
    for (uint32_t c = 0; c < scene->chain_count; c++)
        dmb_block_solve(&scene->layout, &matrix, scene->chains[c].first, scene->chains[c].count, sim->correction);
}
