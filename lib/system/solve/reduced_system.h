/* The linear system of chains that joints connect. Its blocks are the clusters and the other nodes of those chains; a
 * cluster's block is reduced to its independent coordinates,
 *
 *     R^T S R y = -R^T residual,   z = R y,   R = [G; I]                                     (DMB_METHOD_INDEPENDENT)
 *     [S B^T; B 0] [z; df] = -[residual; 0] over all its coordinates and its pivot rows      (DMB_METHOD_MULTIPLIERS)
 *
 * with S the iteration matrix of the nodes (blocks of the block-tridiagonal storage) and of the joints. */
#ifndef DMB_SYSTEM_SOLVE_REDUCED_SYSTEM_H
#define DMB_SYSTEM_SOLVE_REDUCED_SYSTEM_H

#include "system/assemble/evaluation.h"

/* Assembles the reduced system from the iteration matrix, in independent coordinates. */
void dmb_reduced_assemble(dmb_sim *sim);
/* Assembles by DMB_METHOD_..., and factors. The functions below take the system as it was made last. Node of a singular
 * block, or -1. weakest may be NULL; its block is a node too. */
int64_t dmb_reduced_factor(dmb_sim *sim, int32_t method, dmb_block_weakest *weakest);
/* z: right-hand side in, solution out, in the rows of jointed chains; multipliers of the trial move too where they are
 * solved for. */
void dmb_reduced_solve(dmb_sim *sim, double *z);
/* Negative eigenvalues of the system made and factored last, in independent coordinates. */
uint32_t dmb_reduced_negative(dmb_sim *sim);
/* Row of R of column c of cluster k: G's, or NULL where it is a single 1 at *one. After assembling independent
 * coordinates. */
const double *dmb_reduced_null_space_row(const dmb_sim *sim, uint32_t k, uint32_t c, uint32_t *one);
/* z = R y: reduced_solution into the rows of jointed chains. */
void dmb_reduced_expand(const dmb_sim *sim, double *z);

/* ---- Sparse clusters: reduced_system_sparse.c -------------------------------------------------------------------- */

/* Sparse clusters in the reduced system: the blocks of their nodes hold the multipliers of the rows that are chosen,
 *
 *     [S  B^T D] [ z      ]     [residual]
 *     [D B   0 ] [ D^-1 df] = - [0       ]
 *
 * D: factors that make the rows as large as the stiffness beside them, so that pivots can be compared. */

/* Unknowns of the blocks of sparse clusters into reduced_size. */
void dmb_reduced_sparse_sizes(dmb_sim *sim);
/* Tangents of joints and rows of constraints into the blocks; those of the nodes are there. hold: B^T D B is added to
 * S, which changes nothing where B z = 0, and holds what only the constraints hold: a body at rest has no S of its
 * own. */
void dmb_reduced_sparse_put(dmb_sim *sim, int hold);
/* The solution moves the multipliers of the trial. */
void dmb_reduced_sparse_move(dmb_sim *sim);
/* Rows that are chosen: each adds a negative eigenvalue to the system. */
uint32_t dmb_reduced_sparse_rows(const dmb_sim *sim);

#endif
