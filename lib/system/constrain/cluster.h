/* Clusters of constraint rows: their partition into dependent and independent coordinates, and the projection of a
 * trial onto its constraints.
 *
 * A trial satisfies its constraints at all three levels before its residual is formed (settle): poses, speeds and
 * accelerations move by the least change, in the metric of cluster_weight, that makes C = 0, B v + rate = 0 and
 * B v' + convective = 0. This does not depend on the partition, so the partition may change between any two steps. R^T
 * residual = 0 remains to be solved in the independent coordinates, R = [G; I] (constraint/partition.h). */
#ifndef DMB_SYSTEM_CONSTRAIN_CLUSTER_H
#define DMB_SYSTEM_CONSTRAIN_CLUSTER_H

#include "constraint/joint.h"
#include "constraint/partition.h"
#include "sim/sim.h"
#include "system/assemble/evaluation.h"

enum { DMB_SETTLE_POSE = 1, DMB_SETTLE_SPEED = 2, DMB_SETTLE_ACCELERATION = 4, DMB_SETTLE_ALL = 7 };

/* Units of the columns and the first partition, from the rows at the trial. Once a sim, when its memory is new. */
void dmb_clusters_prepare(dmb_sim *sim);
/* Rows and matrices at the trial. DMB_OK, DMB_ERR_CALLBACK, DMB_ERR_NOT_FINITE. */
int32_t dmb_clusters_gather(dmb_evaluation *evaluation);
/* One step of Gauss-Newton towards C = 0 with a partition of its own, at most DMB_CORRECTION_MOST long.
 * DMB_NOTE_STOPPED: it no longer moves. Errors as dmb_clusters_settle. */
int32_t dmb_clusters_correct(dmb_evaluation *evaluation);
/* Chooses the partition of every cluster from the matrices at hand. */
void dmb_clusters_choose(dmb_sim *sim);
/* Chooses anew where the conditioning has fallen or rows are dropped; counts the changes. */
void dmb_clusters_watch(dmb_sim *sim);
/* The same, and factors what was chosen: for searches that move far. */
int32_t dmb_clusters_refresh(dmb_evaluation *evaluation);

/* Projects the trial, levels being a sum of DMB_SETTLE_..., and leaves rows and factored matrices there. Speeds and
 * accelerations start from raw_ fields if from_raw, else from what the trial has. DMB_OK, DMB_ERR_CALLBACK,
 * _NOT_FINITE, DMB_ERR_SINGULAR (reduced_mode->row tells which row), DMB_ERR_NO_CONVERGENCE (likewise). */
int32_t dmb_clusters_settle(dmb_evaluation *evaluation, int32_t levels, int32_t from_raw);

/* Multipliers that balance the residual in the dependent rows, into trial.multiplier; and B^T multiplier into the
 * residual. Those of the trial are taken as they are where evaluation->given says so. */
void dmb_clusters_balance(dmb_evaluation *evaluation);
/* Multipliers of the trial: those of least norm where rows are redundant. Once a state, not in iterations. */
void dmb_clusters_least_norm(dmb_sim *sim);
/* Multipliers of the trial become 0, for residuals without forces of constraint. */
void dmb_clusters_clear_multipliers(dmb_sim *sim);
/* A multiplier of the trial is moved by what an iteration has found for it. */
void dmb_cluster_move_multiplier(dmb_sim *sim, uint32_t row, double change);
/* Multipliers of trial into now. */
void dmb_clusters_take_multipliers(dmb_sim *sim);

/* Largest violation of an equation of position at the rows at hand, *row telling which; dropped: of dropped rows
 * only. */
double dmb_clusters_violation(const dmb_sim *sim, int32_t dropped, uint32_t *row);

/* The partition of cluster k, its storage in the sim. */
dmb_partition dmb_cluster_partition(const dmb_sim *sim, uint32_t k);
/* Message for a row that could not be satisfied: `what` follows its owner's name. */
void dmb_clusters_explain(dmb_sim *sim, const char *what);

/* Functions that the files cluster_*.c share. */

/* B of a cluster at the rows at hand, shape (rows, columns). */
static inline double *dmb_cluster_matrix(const dmb_sim *sim, const dmb_cluster *cluster)
{
    return sim->cluster_matrix + cluster->dense;
}

/* Rows of a cluster that count at present. */
uint32_t dmb_cluster_active_rows(const dmb_sim *sim, const dmb_cluster *cluster);
/* cluster_place: where each column stands in the order of the choice. */
void dmb_cluster_note_places(dmb_sim *sim, uint32_t k);
/* DMB_ERR_SINGULAR, with the row and its violation for the message. */
int32_t dmb_cluster_singular(dmb_sim *sim, uint32_t row, double violation);
/* Factors the dependent part of every matrix, and tells its quality. DMB_OK, DMB_ERR_SINGULAR. */
int32_t dmb_clusters_factor(dmb_sim *sim);
/* Largest violation of the pivot rows; *row stays where there is none. */
double dmb_clusters_pivot_violation(const dmb_sim *sim, uint32_t *row);

/* ---- Rank for the model check: cluster_rank.c -------------------------------------------------------------------- */

/* Rank of the equations of a scene at the accepted state, by LAPACK, for the model check. Nothing of the sim is
 * written: rows and matrices are evaluated in memory of their own. */

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

/* ---- Assembly: cluster_projection.c ------------------------------------------------------------------------------ */

/* Putting a scene together: Gauss-Newton on all equations of position, shortest moves first (Wehage, Haug 1982). */

/* Closes the joints from the described poses of now: poses move until every equation holds and joints stand where their
 * initial coordinates say, speeds likewise. Fills counters->assembly. Errors with a message: DMB_ERR_GEOMETRY (the
 * joint that does not fit, and by how much), DMB_ERR_CALLBACK. system/constrain/cluster_projection */
int32_t dmb_assemble(dmb_sim *sim);
/* Refuses a joint whose frames, in the trial, point against each other where it keeps them parallel: its equations hold
 * there too. DMB_ERR_GEOMETRY with a message. */
int32_t dmb_joint_refuse_flip(dmb_sim *sim, uint32_t joint);
/* Largest changes of the speeds from now to trial into counters->projection. */
void dmb_note_projection(dmb_sim *sim);
/* Refuses speeds of the trial that do not satisfy an equation, one that was dropped included: DMB_ERR_GEOMETRY. */
int32_t dmb_assembled_speeds(dmb_evaluation *evaluation);

#endif
