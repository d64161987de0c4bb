/* The nodes that joints act on, condensed out of the dynamic stiffness of their chains. */
#ifndef DMB_ANALYSIS_JOINT_CONDENSATION_H
#define DMB_ANALYSIS_JOINT_CONDENSATION_H

#include "analysis/dynamic_stiffness.h"
#include "base/arena.h"

/* Solved rows of nodes that joints act on. */
uint32_t dmb_condensation_rows(const dmb_linear *linear);
void dmb_condensation_lay_out(dmb_arena *arena, const dmb_linear *linear, uint32_t rows, dmb_condensation *out);
/* Numbers rows and coordinates. */
void dmb_condensation_number(const dmb_linear *linear, dmb_condensation *out);
/* With the chains factored: Schur complement, reduced and factored. A node that nothing holds, or -1. */
int64_t dmb_condensation_factor(dmb_dynamic_stiffness *stiffness);
/* Before the chains are solved: takes the forces of the rows, or the displacements p that drives of joints ask for, out
 * of x. */
void dmb_condensation_take(dmb_dynamic_stiffness *stiffness, int32_t joint_moves, dmb_complex_array x);
/* After: x_J = p + R (R^T S R)^-1 R^T (f_J - A_JI x_I - S p), x_I -= A_II^-1 A_IJ x_J. */
void dmb_condensation_give(dmb_dynamic_stiffness *stiffness, dmb_complex_array x);

#endif
