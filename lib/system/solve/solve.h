/* Linear algebra of a Newton iteration, shared by steps and statics. */
#ifndef DMB_SYSTEM_SOLVE_SOLVE_H
#define DMB_SYSTEM_SOLVE_SOLVE_H

#include "sim/sim.h"
#include "system/assemble/evaluation.h"

/* DMB_AT_ROUNDING: above the tolerance, but the rounding of poses alone causes a residual of that size. Beside very
 * stiff elements small loads are below that level, so it ends an iteration but does not indicate a solution.
 * DMB_SMALL_PART: above the tolerance, but a small fraction of the initial residual. */
enum { DMB_CONVERGED = 1, DMB_AT_ROUNDING = 2, DMB_SMALL_PART = 3 };

typedef struct dmb_residual_norm {
    double relative;   /* [-] norm of the residual over the norm of its terms, largest of all chains */
    double balance;    /* [N] norm of its terms, all chains */
    double start;      /* [-] the same of the initial residual chain_start */
    double bound;      /* [-] bound of the relative residual in the chain that exceeds its bound most */
    int32_t converged; /* DMB_CONVERGED, ...; 0: above the tolerance */
    int32_t reserved;
} dmb_residual_norm;

/* Bound of a relative residual: the larger of `tolerance` and `share` times the initial residual of the chain
 * (sim->chain_start), the latter at most `most`. share 0: the tolerance alone. start: the present residual becomes
 * chain_start. */
typedef struct dmb_residual_bound {
    double tolerance, share, most;
    int32_t start;
} dmb_residual_bound;

/* Norm of the residual by chains, so that the residual of a light body is not compared with the forces of a heavy
 * string. Moments are divided by the length of their chain; solved rows only. */
dmb_residual_norm dmb_residual_norm_of(const dmb_evaluation *evaluation, double tolerance);
dmb_residual_norm dmb_residual_norm_within(const dmb_evaluation *evaluation, const dmb_residual_bound *bound);
/* The present residual becomes chain_start. */
void dmb_residual_begins_at(dmb_sim *sim);
/* Factorises the iteration matrix in place, with joints by DMB_METHOD_.... Returns the index of a singular block, or
 * -1. */
int64_t dmb_factor_matrix(dmb_sim *sim, int32_t method);
/* The same for statics, in independent coordinates; returns also the weakest pivot, which is of rounding size for an
 * unconstrained motion. */
int64_t dmb_factor_stiffness(dmb_sim *sim, dmb_block_weakest *weakest);
/* Evaluates with mass factor 1 and velocity factor 0, and factorises the mass matrix; the residual is in `residual`.
 * Errors as dmb_system_evaluate, DMB_ERR_SINGULAR with the node in evaluation->element. */
int32_t dmb_factor_mass(dmb_evaluation *evaluation);
/* The same within a step, by dmb_factor_matrix: elimination from both ends, in chunks if there are threads. */
int32_t dmb_factor_mass_in_step(dmb_evaluation *evaluation);
/* Solves S z = -residual in the solved rows, z = 0 in the others, with the factors of kind sim->factors; `z` may be
 * `residual` itself. Multipliers of the trial are updated if they are unknowns. */
void dmb_solve_for(dmb_sim *sim, const double *residual, double *z);
/* The same, from sim->residual into sim->correction. */
void dmb_solve_correction(dmb_sim *sim);

/* Factors of another matrix, exchangeable with the present ones. */
typedef struct dmb_factor_set {
    double *diagonal, *lower, *upper;
    uint8_t *pivot;
    int32_t kind; /* DMB_FACTORS_... */
    int32_t reserved;
} dmb_factor_set;

/* Exchanges the present factors with these. Without joints. */
void dmb_factors_swap(dmb_sim *sim, dmb_factor_set *with);
/* dmb_solve_correction with one step of iterative refinement by the matrix before factorisation (constrained rows:
 * identity). Blocks are solved by their inverses, whose rounding (3e-9 of the correction) affects the force of stiff
 * elements. product: workspace, shape (row). Without joints. */
void dmb_solve_refined(dmb_sim *sim, const dmb_block_matrix *matrix, double *product);

/* Factors of an iteration matrix that are reused in later steps (conditions: integrator/newton). The wall does not
 * rotate with the pipes, and pipes are axisymmetric: after a rotation about its axis, the iteration matrix of a pipe is
 * unchanged in the frame before the rotation. With a wall, reused factors are therefore applied in the frames in which
 * they were made. (If only one of the two transverse directions is constrained, this mixes it with the other, which an
 * approximate inverse may do.) */

/* Keeps the factors of this step (inverses of blocks) for reuse, with the frames reached: four numbers per node. */
void dmb_keep_factors(dmb_sim *sim, const double *quaternion);
/* Discards the reusable factors, because the state no longer continues the steps that made them. */
void dmb_forget_factors(dmb_sim *sim);
/* Solves with the reused factors. z: right-hand side in, solution out; no joints. */
void dmb_solve_reused(const dmb_sim *sim, double *z);

/* ---- The reduced system ------------------------------------------------------------------------------------------ */

/* Assembles the reduced system from the iteration matrix, in independent coordinates. */
void dmb_reduced_assemble(dmb_sim *sim);
/* Assembles by DMB_METHOD_... and factorises; the functions below use the system assembled last. Returns the node of a
 * singular block, or -1. weakest may be NULL; its block is also a node. */
int64_t dmb_reduced_factor(dmb_sim *sim, int32_t method, dmb_block_weakest *weakest);
/* z: right-hand side in, solution out, in the rows of jointed chains; multipliers of the trial are updated if they are
 * unknowns. */
void dmb_reduced_solve(dmb_sim *sim, double *z);
/* Number of negative eigenvalues of the last system, in independent coordinates. */
uint32_t dmb_reduced_negative(dmb_sim *sim);
/* Row of R of column c of constraint component k: that of G, or NULL if it is a single 1 at *one. After assembling
 * independent coordinates. */
const double *dmb_reduced_null_space_row(const dmb_sim *sim, uint32_t k, uint32_t c, uint32_t *one);
/* z = R y: reduced_solution into the rows of jointed chains. */
void dmb_reduced_expand(const dmb_sim *sim, double *z);

/* ---- Sparse clusters: reduced_system_sparse.c -------------------------------------------------------------------- */

/* Sparse constraint components in the reduced system: the blocks of their nodes contain the multipliers of the chosen
 * rows,
 *
 *     [S  B^T D] [ z      ]     [residual]
 *     [D B   0 ] [ D^-1 df] = - [0       ]
 *
 * D: factors that scale the rows to the adjacent stiffness, so that pivots are comparable. */

/* Numbers of unknowns of the blocks of sparse components into reduced_size. */
void dmb_reduced_sparse_sizes(dmb_sim *sim);
/* Adds tangents of joints and rows of constraints to the blocks, after those of the nodes. hold: adds B^T D B to S,
 * which changes nothing if B z = 0, and makes S regular for motion constrained by joints alone: a body at rest has no
 * stiffness of its own. */
void dmb_reduced_sparse_put(dmb_sim *sim, int hold);
/* Adds the solution to the multipliers of the trial. */
void dmb_reduced_sparse_move(dmb_sim *sim);
/* Number of chosen rows: each adds a negative eigenvalue to the system. */
uint32_t dmb_reduced_sparse_rows(const dmb_sim *sim);

#endif
