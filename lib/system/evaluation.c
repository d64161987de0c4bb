#include "system/evaluation.h"

#include <string.h>

#include "kernel/kernels.h"
#include "system/node.h"

static void clear(const dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    const dmb_block_layout *layout = &scene->layout;
    const uint32_t n = scene->node_count;
    const size_t diagonal = layout->diag[n] * sizeof(double);
    const size_t link = layout->link[n - 1] * sizeof(double);
    memset(sim->correction, 0, scene->row_count * sizeof(double));
    memset(sim->scale_row, 0, scene->row_count * sizeof(double));
    if (!evaluation->tangent) return;
    memset(sim->stiffness_diagonal, 0, diagonal);
    memset(sim->inertia_diagonal, 0, diagonal);
    if (scene->beams_only) return; /* beams write their links */
    memset(sim->stiffness_lower, 0, link);
    memset(sim->stiffness_upper, 0, link);
}

/* Along the axis and about it, from node `first` on as long as there are PATH nodes; what else a pose has stays.
 * Returns how many they are. */
static uint32_t move_path_nodes(dmb_sim *sim, uint32_t first)
{
    const dmb_scene *scene = sim->scene;
    const double *z = sim->increment + scene->layout.row[first];
    uint32_t i = first;
    for (; i < scene->node_count && scene->layout.size[i] == DMB_NODE_PATH; i++, z += DMB_NODE_PATH) {
        sim->trial.displacement[3 * i] = sim->now.displacement[3 * i] + z[0];
        sim->trial.turn[i] = sim->now.turn[i] + z[1];
    }
    return i - first;
}

void dmb_system_move(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0, count; i < scene->node_count; i += count) {
        const double *z = sim->increment + scene->layout.row[i];
        count = dmb_full_nodes_at(scene, i);
        if (count > 0) {
            const dmb_node_run run = {count,
                                      0,
                                      z,
                                      sim->now.displacement + 3 * i,
                                      sim->now.quaternion + 4 * i,
                                      sim->trial.displacement + 3 * i,
                                      sim->trial.quaternion + 4 * i};
            scene->kernels->advance(&run);
            continue;
        }
        count = move_path_nodes(sim, i);
    }
}

static int32_t finite_status(const dmb_sim *sim)
{
    double sums[8] = {0.0}; /* side by side */
    const double *r = sim->correction;
    const uint32_t rows = sim->scene->row_count, even = rows - rows % 8;
    for (uint32_t i = 0; i < even; i += 8)
        for (uint32_t k = 0; k < 8; k++) sums[k] += fabs(r[i + k]);
    for (uint32_t i = even; i < rows; i++) sums[0] += fabs(r[i]);
    for (uint32_t k = 1; k < 8; k++) sums[0] += sums[k];
    return isfinite(sums[0]) ? DMB_OK : DMB_ERR_NOT_FINITE;
}

int32_t dmb_system_evaluate(dmb_evaluation *evaluation)
{
    const dmb_scene *scene = evaluation->sim->scene;
    evaluation->status = DMB_OK;
    evaluation->rounding = 0.0;
    memset(evaluation->power, 0, sizeof evaluation->power);
    clear(evaluation);
    for (int i = 0; i < 2; i++)
        evaluation->sim->trial.friction_slip[i] = evaluation->slipping ? evaluation->slip[i] : 0.0;
    dmb_gather_elements(evaluation);
    if (evaluation->status < 0) return evaluation->status;
    dmb_gather_nodes(evaluation);
    if (scene->site_count) dmb_gather_contacts(evaluation);
    if (scene->path_site_count) dmb_gather_path_friction(evaluation);
    if (scene->load_count) dmb_gather_loads(evaluation);
    if (scene->drive_count) dmb_gather_drives(evaluation);
    if (scene->bit_count) dmb_gather_bits(evaluation);
    if (scene->cluster_count) evaluation->status = dmb_gather_joints(evaluation);
    if (evaluation->status >= 0) evaluation->status = finite_status(evaluation->sim);
    return evaluation->status;
}
