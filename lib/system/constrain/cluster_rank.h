/* Rank of the equations of a scene at the accepted state, by LAPACK, for the model check. Nothing of the sim is
 * written: rows and matrices are evaluated in memory of their own. */
#ifndef DMB_SYSTEM_CONSTRAIN_CLUSTER_RANK_H
#define DMB_SYSTEM_CONSTRAIN_CLUSTER_RANK_H

#include "constraint/joint.h"
#include "sim/sim.h"

typedef struct dmb_cluster_rank {
    uint32_t rows;          /* that act */
    uint32_t rank;          /* by LAPACK, sum of the clusters */
    uint32_t differing;     /* clusters of which the partition has another rank */
    uint32_t poorest;       /* cluster of the condition below */
    double condition;       /* smallest over largest singular value, worst cluster; 1 without equations */
    double violation;       /* [m, -] largest of an equation of position */
    uint32_t violation_row; /* where; DMB_NONE: none */
    uint32_t reserved;
    uint8_t *redundant; /* 1 of rows that are redundant: those the partition drops, or LAPACK's where the two differ;
                           shape (constraint_row_count) */
    void *block;        /* the memory of it */
    size_t block_size;
} dmb_cluster_rank;

/* Fills *rank; its memory is given back by dmb_cluster_rank_release, on error it holds none. Errors: DMB_ERR_NO_MEMORY,
 * DMB_ERR_CALLBACK, DMB_ERR_NOT_FINITE. */
int32_t dmb_cluster_rank_make(const dmb_sim *sim, dmb_cluster_rank *rank);
/* NULL memory and a struct of zeros are fine. */
void dmb_cluster_rank_release(const dmb_sim *sim, dmb_cluster_rank *rank);

/* "joint 3 (crank): rotation about y": a constraint row by name. */
void dmb_constraint_row_text(const dmb_sim *sim, uint32_t row, dmb_message *text);

#endif
