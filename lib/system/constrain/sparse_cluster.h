/* Sparse clusters: large ones, of which there are no dense matrices. Instead of dependent and independent coordinates
 * there is a choice of rows alone, and every question is a system over the nodes and the multipliers of those rows, in
 * the blocks of the scene's pattern,
 *
 *     [I  (BW)^T] [ x ]   [ a ]
 *     [BW   0   ] [-f ] = [ d ]        W: metric of the columns
 *
 * with a = 0 the least move with B W x = d; with d = 0 the multipliers for which the rest of a is least. The
 * corrections of Newton come from [S B^T; B 0] (system/solve/reduced_system_sparse). All of it is linear in the number
 * of bodies of chains and trees; a loop costs what its width in the order of elimination asks. */
#ifndef DMB_SYSTEM_CONSTRAIN_SPARSE_CLUSTER_H
#define DMB_SYSTEM_CONSTRAIN_SPARSE_CLUSTER_H

#include "math/block_signed.h"
#include "system/assemble/evaluation.h"

/* A row of which elimination leaves less than this square of the sine to those before it is redundant. The rows that
 * close a ring of n bodies have 13/n^3, and leave up to 1e-16 n^3 of rounding to redundant ones behind them: measured
 * up to n = 800, where the least is 2.6e-8. */
#define DMB_SPARSE_RANK 1e-9

static inline int32_t dmb_is_sparse(const dmb_scene *scene, uint32_t constraint)
{
    return scene->clusters[scene->constraints[constraint].cluster].sparse;
}

/* Chooses the rows of every sparse cluster from the rows at hand, and tells the quality of the choice. */
void dmb_sparse_choose(dmb_sim *sim);
/* Sizes of blocks and places of the rows that are chosen: the choice may have come back with an older state. */
void dmb_sparse_note(dmb_sim *sim);
/* Factors of the rows at hand in the metric of projections. leave_weak: without rows that those before nearly hold.
 * DMB_OK, or DMB_ERR_SINGULAR with the row for the message. */
int32_t dmb_sparse_factor(dmb_sim *sim, int leave_weak);
/* The same where the factors are not those of the rows at hand. */
int32_t dmb_sparse_refresh(dmb_sim *sim);

/* Least move with B x = d of the chosen rows; d by constraint row. */
void dmb_sparse_project(dmb_sim *sim, const double *d);
/* Result of dmb_sparse_project for cluster k, in its columns. */
void dmb_sparse_take(const dmb_sim *sim, uint32_t k, double *x);
/* d = -(level + B v) in the rows of sparse clusters. */
void dmb_sparse_deficit(const dmb_sim *sim, const double *level, const double *v, double *d);
/* As dmb_clusters_balance, of sparse clusters. */
void dmb_sparse_balance(dmb_sim *sim, int given);
/* As dmb_clusters_least_norm, of sparse clusters. system/constrain/sparse_cluster_least_norm */
void dmb_sparse_least_norm(dmb_sim *sim);
/* As dmb_clusters_violation, of the chosen rows or of the dropped ones; *row stays where there is none. */
double dmb_sparse_violation(const dmb_sim *sim, int32_t dropped, uint32_t *row);

/* ---- For the files sparse*.c and reduced_sparse.c ---- */

/* Row k of a constraint, its columns. */
static inline const double *dmb_sparse_row(const dmb_sim *sim, const dmb_constraint *c, uint32_t k)
{
    return sim->constraint_jacobian + c->jacobian + (size_t)k * c->columns;
}

/* First column of a node in the arrays by columns of clusters. */
static inline uint32_t dmb_sparse_column(const dmb_scene *scene, uint32_t node)
{
    return scene->clusters[scene->node_cluster[node]].column + scene->node_place[node];
}

/* Square of the length of row k of a constraint in weighted columns. */
double dmb_sparse_length(const dmb_sim *sim, const dmb_constraint *c, uint32_t k, const double *weight);
/* sparse_row from sparse_size; returns their sum. */
uint32_t dmb_sparse_number(dmb_sim *sim);
/* The matrix in the sim's memory. */
dmb_block_signed dmb_sparse_matrix(const dmb_sim *sim);

#endif
