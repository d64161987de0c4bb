/* The matrices of clusters, and their factors. */
#include <string.h>

#include "system/cluster_parts.h"
#include "system/constraint_rows.h"
#include "system/sparse.h"

dmb_partition dmb_cluster_partition(const dmb_sim *sim, uint32_t k)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    dmb_partition partition;
    partition.rows = cluster->rows;
    partition.columns = cluster->columns;
    partition.rank = sim->partition_rank[k];
    partition.reserved = 0;
    partition.row_order = sim->partition_row + cluster->row;
    partition.column_order = sim->partition_column + cluster->column;
    return partition;
}

void dmb_cluster_note_places(dmb_sim *sim, uint32_t k)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const uint32_t *order = sim->partition_column + cluster->column;
    for (uint32_t i = 0; i < cluster->columns; i++) sim->cluster_place[cluster->column + order[i]] = i;
}

uint32_t dmb_cluster_active_rows(const dmb_sim *sim, const dmb_cluster *cluster)
{
    uint32_t count = 0;
    for (uint32_t r = cluster->row; r < cluster->row + cluster->rows; r++)
        count += sim->constraint_type[r] != DMB_ROW_IDLE;
    return count;
}

/* B of a cluster from the blocks of its constraints. */
static void gather_matrix(dmb_sim *sim, const dmb_cluster *cluster)
{
    const dmb_scene *scene = sim->scene;
    double *B = dmb_cluster_matrix(sim, cluster);
    memset(B, 0, (size_t)cluster->rows * cluster->columns * sizeof(double));
    for (uint32_t i = cluster->constraint; i < cluster->constraint + cluster->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        for (uint32_t k = 0; k < c->rows; k++) {
            const double *from = sim->constraint_jacobian + c->jacobian + (size_t)k * c->columns;
            double *to = B + (size_t)(c->row - cluster->row + k) * cluster->columns;
            for (uint32_t n = 0; n < c->node_count; n++)
                memcpy(to + scene->node_place[c->node[n]], from + c->column[n],
                       scene->layout.size[c->node[n]] * sizeof(double));
        }
    }
}

int32_t dmb_clusters_gather(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    const int32_t status = dmb_constraint_rows(evaluation);
    sim->linked_mode->metric = 0;
    for (uint32_t k = 0; k < sim->scene->cluster_count && status >= 0; k++)
        if (!sim->scene->clusters[k].sparse) gather_matrix(sim, sim->scene->clusters + k);
    return status;
}

int32_t dmb_cluster_singular(dmb_sim *sim, uint32_t row, double misfit)
{
    sim->linked_mode->row = row;
    sim->linked_mode->misfit = misfit;
    return DMB_ERR_SINGULAR;
}

int32_t dmb_clusters_factor(dmb_sim *sim)
{
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++) {
        const dmb_cluster *cluster = sim->scene->clusters + k;
        const dmb_partition partition = dmb_cluster_partition(sim, k);
        if (cluster->sparse) continue;
        dmb_cluster_note_places(sim, k); /* the choice may have come back with an older state */
        sim->cluster_quality[k] = dmb_partition_factor(
            dmb_cluster_matrix(sim, cluster), cluster->columns, sim->cluster_weight + cluster->column, &partition,
            sim->cluster_lu + cluster->square, sim->cluster_pivot + cluster->row);
        if (!(sim->cluster_quality[k] > 0.0)) return dmb_cluster_singular(sim, cluster->row, 0.0);
    }
    return sim->scene->sparse_count ? dmb_sparse_refresh(sim) : DMB_OK;
}
