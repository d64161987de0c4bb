/* Sparse clusters in the reduced system: the blocks of their nodes hold the multipliers of the rows that are chosen,
 *
 *     [S  B^T D] [ z      ]     [residual]
 *     [D B   0 ] [ D^-1 df] = - [0       ]
 *
 * D: factors that make the rows as large as the stiffness beside them, so that pivots can be compared. */
#ifndef DMB_SYSTEM_SOLVE_REDUCED_SPARSE_H
#define DMB_SYSTEM_SOLVE_REDUCED_SPARSE_H

#include "system/assemble/evaluation.h"

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
