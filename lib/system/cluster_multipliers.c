/* Multipliers of the constraints: forces that balance the dependent rows. */
#include "system/cluster_parts.h"
#include "system/sparse.h"

/* C_d^T f = -residual in the dependent columns. */
static void solve_multipliers(dmb_sim *sim, uint32_t k)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const dmb_partition partition = dmb_cluster_partition(sim, k);
    const uint32_t *row_of = sim->scene->cluster_columns + cluster->column;
    double *f = sim->cluster_rows;
    for (uint32_t i = 0; i < partition.rank; i++) f[i] = -sim->correction[row_of[partition.column_order[i]]];
    dmb_partition_solve_transposed(&partition, sim->cluster_lu + cluster->square, sim->cluster_pivot + cluster->row, f);
    for (uint32_t r = 0; r < cluster->rows; r++) sim->trial.multiplier[cluster->row + r] = 0.0;
    for (uint32_t i = 0; i < partition.rank; i++) sim->trial.multiplier[cluster->row + partition.row_order[i]] = f[i];
}

static void add_multipliers(dmb_sim *sim, uint32_t k)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const uint32_t *row_of = sim->scene->cluster_columns + cluster->column;
    const double *B = dmb_cluster_matrix(sim, cluster);
    for (uint32_t r = 0; r < cluster->rows; r++) {
        const double f = sim->trial.multiplier[cluster->row + r];
        for (uint32_t c = 0; c < cluster->columns && f != 0.0; c++) {
            const double force = f * B[(size_t)r * cluster->columns + c];
            sim->correction[row_of[c]] += force;
            sim->scale_row[row_of[c]] += fabs(force);
        }
    }
}

/* Dependent rows balance by construction; what is left there is rounding. */
static void clear_dependent(dmb_sim *sim, uint32_t k)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const uint32_t *order = sim->partition_column + cluster->column;
    for (uint32_t i = 0; i < sim->partition_rank[k]; i++)
        sim->correction[sim->scene->cluster_columns[cluster->column + order[i]]] = 0.0;
}

/* What does the same with the least forces: no change where no row is dropped. */
static void least_norm(dmb_sim *sim, uint32_t k)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const dmb_partition partition = dmb_cluster_partition(sim, k);
    if (partition.rank == dmb_cluster_active_rows(sim, cluster)) return;
    dmb_partition_least_norm(dmb_cluster_matrix(sim, cluster), cluster->columns, &partition,
                             sim->cluster_lu + cluster->square, sim->cluster_pivot + cluster->row,
                             sim->cluster_gram + cluster->square, sim->trial.multiplier + cluster->row);
}

void dmb_clusters_balance(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    const int given = sim->linked_mode->multipliers;
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++) {
        if (sim->scene->clusters[k].sparse) continue;
        if (!given) solve_multipliers(sim, k);
        add_multipliers(sim, k);
        if (!given) clear_dependent(sim, k);
    }
    dmb_sparse_balance(sim, given);
}

void dmb_clusters_least_norm(dmb_sim *sim)
{
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++)
        if (!sim->scene->clusters[k].sparse) least_norm(sim, k);
    dmb_sparse_least_norm(sim);
}
