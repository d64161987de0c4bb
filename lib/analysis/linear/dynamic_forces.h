/* Forces that a motion at one frequency takes: products with the dynamic stiffness A as the scene has it, rows that are
 * held included, and the forces of constraint that balance them,
 *
 *     A x + B^T multiplier = f
 *
 * in the dependent rows of each cluster of joints. The residual in rows that are held is the force of their guides. */
#ifndef DMB_ANALYSIS_LINEAR_DYNAMIC_FORCES_H
#define DMB_ANALYSIS_LINEAR_DYNAMIC_FORCES_H

#include "analysis/linear/dynamic_stiffness.h"

/* y -= A p in the rows that are solved. */
void dmb_dynamic_subtract(const dmb_dynamic_stiffness *stiffness, dmb_complex_array p, dmb_complex_array y);
/* Row of component c of a node of A x. */
dmb_complex_number dmb_dynamic_row(const dmb_dynamic_stiffness *stiffness, uint32_t node, uint32_t c,
                                   dmb_complex_array x);
/* Multipliers of the rows of cluster k, of least norm where some are redundant, shape (rows of the cluster). x, f:
 * shape (rows). */
void dmb_dynamic_multipliers(const dmb_dynamic_stiffness *stiffness, uint32_t k, dmb_complex_array x,
                             dmb_complex_array f, dmb_complex_array multipliers);

#endif
