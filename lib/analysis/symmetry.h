/* How far an iteration matrix of statics is from a symmetric one, and its symmetric part. */
#ifndef DMB_ANALYSIS_SYMMETRY_H
#define DMB_ANALYSIS_SYMMETRY_H

#include "state.h"

/* Asymmetry, as of dmb_asymmetry_of, above which a stiffness counts as unsymmetric. Rounding leaves 1e-12. */
#define DMB_UNSYMMETRIC 1e-9

/* [-] largest |A_ij - A_ji| / sqrt(A_ii A_jj) of the iteration matrix in the stiffness_ blocks, not factored; with joints of
 * the reduced system in linked_value, just assembled. `rounding` [N/m]: a difference that counts as 0, per unit of the
 * weights 1 of displacements and length_scale^2 of rotations. */
double dmb_asymmetry_of(const dmb_sim *sim, double rounding);

/* Blocks of the scene's layout, and values of its pattern at the sim's present sizes, become their symmetric part. */
void dmb_make_blocks_symmetric(const dmb_block_layout *layout, double *diagonal, double *lower, double *upper);
void dmb_make_linked_symmetric(const dmb_sim *sim, double *values);

#endif
