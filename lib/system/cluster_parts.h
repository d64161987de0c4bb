/* What the files cluster_*.c share. */
#ifndef DMB_SYSTEM_CLUSTER_PARTS_H
#define DMB_SYSTEM_CLUSTER_PARTS_H

#include "system/cluster.h"

/* B of a cluster at the rows at hand, shape (rows, columns). */
static inline double *dmb_cluster_matrix(const dmb_sim *sim, const dmb_cluster *cluster)
{
    return sim->cluster_matrix + cluster->dense;
}

/* Rows of a cluster that count at present. */
uint32_t dmb_cluster_active_rows(const dmb_sim *sim, const dmb_cluster *cluster);
/* cluster_place: where each column stands in the order of the choice. */
void dmb_cluster_note_places(dmb_sim *sim, uint32_t k);
/* DMB_ERR_SINGULAR, with the row and its misfit for the message. */
int32_t dmb_cluster_singular(dmb_sim *sim, uint32_t row, double misfit);
/* Factors the dependent part of every matrix, and tells its quality. DMB_OK, DMB_ERR_SINGULAR. */
int32_t dmb_clusters_factor(dmb_sim *sim);
/* Largest misfit of the pivot rows; *row stays where there is none. */
double dmb_clusters_pivot_misfit(const dmb_sim *sim, uint32_t *row);

#endif
