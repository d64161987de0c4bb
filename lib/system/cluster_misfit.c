/* How far a trial is from satisfying its equations of position, in metres. */
#include "system/cluster_parts.h"
#include "system/sparse.h"

/* [m] least move that satisfies a row of a cluster alone: its misfit over the length of its row in weighted columns. */
static double way_of(const dmb_sim *sim, uint32_t k, uint32_t row)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const double *b = dmb_cluster_matrix(sim, cluster) + (size_t)row * cluster->columns;
    const double *weight = sim->cluster_weight + cluster->column;
    const double value = fabs(sim->constraint_value[cluster->row + row]);
    double sum = 0.0;
    if (value == 0.0) return 0.0;
    for (uint32_t c = 0; c < cluster->columns; c++) sum += b[c] * b[c] * weight[c] * weight[c];
    return sum > 0.0 ? value / sqrt(sum) : value;
}

/* Largest misfit of the pivot rows, or of the dropped ones. */
static double misfit_of(const dmb_sim *sim, uint32_t k, int32_t dropped, uint32_t *row)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const uint32_t *order = sim->partition_row + cluster->row, rank = sim->partition_rank[k];
    double most = 0.0;
    for (uint32_t i = dropped ? rank : 0; i < (dropped ? cluster->rows : rank); i++) {
        const double misfit = way_of(sim, k, order[i]);
        if (!(misfit > most)) continue;
        most = misfit;
        *row = cluster->row + order[i];
    }
    return most;
}

double dmb_clusters_pivot_misfit(const dmb_sim *sim, uint32_t *row)
{
    double most = 0.0;
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++)
        if (!sim->scene->clusters[k].sparse) most = fmax(most, misfit_of(sim, k, 0, row));
    if (sim->scene->sparse_count == 0) return most;
    uint32_t found = *row;
    const double here = dmb_sparse_misfit(sim, 0, &found);
    if (here > most) *row = found;
    return fmax(most, here);
}

double dmb_clusters_misfit(const dmb_sim *sim, int32_t dropped, uint32_t *row)
{
    double most = 0.0;
    *row = UINT32_MAX;
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++)
        for (int32_t which = dropped; which <= 1; which++) {
            uint32_t found = UINT32_MAX;
            if (sim->scene->clusters[k].sparse) continue;
            const double here = misfit_of(sim, k, which, &found);
            if (!(here > most)) continue;
            most = here;
            *row = found;
        }
    for (int32_t which = dropped; which <= 1 && sim->scene->sparse_count; which++) {
        uint32_t found = UINT32_MAX;
        const double here = dmb_sparse_misfit(sim, which, &found);
        if (here > most) *row = found;
        most = fmax(most, here);
    }
    return most;
}
