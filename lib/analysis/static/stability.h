/* Whether a static state is stable; how far an iteration matrix of statics is from a symmetric one, and its symmetric
 * part. */
#ifndef DMB_ANALYSIS_STATIC_STABILITY_H
#define DMB_ANALYSIS_STATIC_STABILITY_H

#include "analysis/static/static.h"
#include "sim/sim.h"
#include "system/assemble/evaluation.h"

/* Asymmetry, as of dmb_asymmetry_of, above which a stiffness counts as unsymmetric. Rounding leaves 1e-12. */
#define DMB_UNSYMMETRIC 1e-9

/* [-] largest |A_ij - A_ji| / sqrt(A_ii A_jj) of the iteration matrix in the stiffness_ blocks, not factored; with
 * joints of the reduced system in reduced_value, just assembled. `rounding` [N/m]: a difference that counts as 0, per
 * unit of the weights 1 of displacements and length_scale^2 of rotations. */
double dmb_asymmetry_of(const dmb_sim *sim, double rounding);

/* Blocks of the scene's layout, and values of its pattern at the sim's present sizes, become their symmetric part. */
void dmb_make_blocks_symmetric(const dmb_block_layout *layout, double *diagonal, double *lower, double *upper);
void dmb_make_reduced_symmetric(const dmb_sim *sim, double *values);

/* Whether a static state is stable: by the signs of its stiffness K where that is symmetric, and where it is not by the
 * real negative eigenvalues of K x = mu D x, D the weights 1 of displacements and length_scale^2 of rotations. A single
 * one comes or goes through det K = 0, whatever D; two together may come of a complex pair, at a place that depends on
 * D (analysis/buckling/path.h). They are looked for among the eigenvalues nearest 0, unless a positive definite
 * symmetric part, with or without what friction adds to it (analysis/static/stability_friction.h), says that there is
 * none: by Krylov subspaces on x -> K^-1 D x, as many vectors as some hundreds of millions of products allow, until the
 * symmetric part H leaves none further out: mu >= -rho where H + rho D is positive definite, x.Hx = mu x.Dx; or so many
 * have been seen, and the sign of det K agrees with their number. The sign alone would not do: what is round diverges
 * in two directions at once. Flutter is not looked for: it depends on mass and damping (modes). */

typedef struct dmb_stability {
    int32_t stiffness; /* DMB_STIFFNESS_... */
    int32_t negative;  /* eigenvalues as above, those of rounding size apart; -1: they could not be counted */
    double asymmetry;  /* [-] dmb_asymmetry_of */
    double rounding;   /* [N/m] of eigenvalues in D */
} dmb_stability;

/* After an evaluation with the true tangent: forms the iteration matrix, judges it and leaves it factored as
 * dmb_factor_stiffness, whose result *bad is; not judged where that is >= 0. `thorough` 1: of a state that was asked
 * for, looked at once more where rounding may decide; 0: of one on a path, where what counts is that the same is
 * counted at each point. The residual is left as it was. Errors: DMB_ERR_NO_MEMORY, and as dmb_system_evaluate. */
int32_t dmb_stability_judge(dmb_static_search *state, int thorough, dmb_block_weakest *weakest, int64_t *bad,
                            dmb_stability *out);

/* Whether rings that slip leave a state without divergence, without an eigenvalue being sought.
 *
 * A ring with the stiffness k of the wall behind it adds k (n + f) n^T to K: n its normal, f friction for a unit of
 * normal force. The symmetric part of this alone has a negative eigenvalue, however little friction there is. With
 *
 *     W = I - f n^T,      W (n + f) n^T = n n^T,
 *
 * K x = mu D x has no real mu below -rounding/(1 - |f|/2) if
 *
 *     sym(W K) + rounding D     is positive definite, |f| < 2 in the weights D:
 *
 * then so is sym(W (K + rho D)) for rho beyond that, and K + rho D is regular. f n^T of nodes without contact is taken
 * between those of their neighbours, since a W that is the same for neighbours leaves the stiffness between them nearly
 * symmetric. */

/* Multiplies the rows of chains without joints in the iteration matrix, which is not factored, by W. 1: done; 0: no
 * ring slips, or |f| is too large, and the matrix is left as it is; DMB_ERR_NO_MEMORY. */
int32_t dmb_stability_turn_friction(const dmb_evaluation *evaluation);

#endif
