#include "system/kept.h"

#include <string.h>

#include "kernel/kernels.h"
#include "system/node.h"

static void swap_blocks(double **a, double **b)
{
    double *const other = *a;
    *a = *b;
    *b = other;
}

void dmb_keep_factors(dmb_sim *sim)
{
    swap_blocks(&sim->stiffness_diagonal, &sim->kept_diagonal);
    swap_blocks(&sim->stiffness_lower, &sim->kept_lower);
    swap_blocks(&sim->stiffness_upper, &sim->kept_upper);
    if (sim->scene->site_count)
        memcpy(sim->kept_quaternion, sim->trial.quaternion, 4 * sim->scene->node_count * sizeof(double));
}

void dmb_forget_factors(dmb_sim *sim)
{
    const dmb_block_layout *layout = &sim->scene->layout;
    const uint32_t n = sim->scene->node_count;
    memset(sim->kept, 0, sizeof *sim->kept);
    if (sim->scene->cluster_count) return; /* no room for any */
    memset(sim->kept_diagonal, 0, layout->diag[n] * sizeof(double));
    memset(sim->kept_lower, 0, layout->link[n - 1] * sizeof(double));
    memset(sim->kept_upper, 0, layout->link[n - 1] * sizeof(double));
    if (sim->scene->site_count) memset(sim->kept_quaternion, 0, 4 * n * sizeof(double));
}

/* Rows of FULL nodes from one set of their frames to another, by the twist between the two. */
static void twist_rows(dmb_sim *sim, const double *from, const double *to)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0, count; i < scene->node_count; i += count) {
        count = dmb_full_nodes_at(scene, i);
        const dmb_twist_run run = {count, 0, from + 4 * i, to + 4 * i, sim->correction + scene->layout.row[i]};
        if (count > 0)
            scene->kernels->twist(&run);
        else
            count = 1;
    }
}

static void clear_held(dmb_sim *sim)
{
    for (uint32_t i = 0; i < sim->scene->row_count; i++)
        if (!sim->scene->solved_row[i]) sim->correction[i] = 0.0;
}

static void solve_chains(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    const dmb_block_matrix factors = {sim->kept_diagonal, sim->kept_lower, sim->kept_upper, NULL};
    for (uint32_t c = 0; c < scene->chain_count; c++) {
        const dmb_chain *chain = scene->chains + c;
        scene->kernels->solve(&scene->layout, &factors, chain->first, chain->count, sim->correction);
    }
}

void dmb_solve_kept(dmb_sim *sim)
{
    const int twisted = sim->scene->site_count > 0;
    if (twisted) twist_rows(sim, sim->trial.quaternion, sim->kept_quaternion);
    solve_chains(sim);
    if (!twisted) return;
    twist_rows(sim, sim->kept_quaternion, sim->trial.quaternion);
    clear_held(sim);
}
