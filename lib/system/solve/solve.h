/* Linear algebra of a Newton iteration, shared by steps and statics. */
#ifndef DMB_SYSTEM_SOLVE_SOLVE_H
#define DMB_SYSTEM_SOLVE_SOLVE_H

#include "sim/sim.h"
#include "system/assemble/evaluation.h"

/* DMB_AT_ROUNDING: above the tolerance, but rounding of the poses alone makes a residual as large. Next to very stiff
 * elements small loads are below that, so it ends an iteration and does not stand for one. DMB_SMALL_PART: above the
 * tolerance too, but a small part of the residual that the iteration began with. */
enum { DMB_CONVERGED = 1, DMB_AT_ROUNDING = 2, DMB_SMALL_PART = 3 };

typedef struct dmb_residual_norm {
    double relative;   /* [-] norm of the residual over that of the terms that balance in it, of the worst chain */
    double balance;    /* [N] norm of those terms, all chains */
    double start;      /* [-] likewise, of the residual that chain_start tells */
    double bound;      /* [-] what the relative residual of the chain furthest above its bound must come down to */
    int32_t converged; /* how it compares with the tolerance; 0: none of the above */
    int32_t reserved;
} dmb_residual_norm;

/* Bound of a relative residual: `tolerance`, or `share` of what sim->chain_start says of the chain where that is more;
 * of that at most `most`. share 0: the tolerance alone. With `start` the residual at hand is what chain_start says
 * from now on. */
typedef struct dmb_residual_bound {
    double tolerance, share, most;
    int32_t start;
} dmb_residual_bound;

/* Moments count over the length of their chain; unknown rows only; chain by chain, so that a light body is not judged
 * by a heavy string. */
dmb_residual_norm dmb_residual_norm_of(const dmb_evaluation *evaluation, double tolerance);
dmb_residual_norm dmb_residual_norm_within(const dmb_evaluation *evaluation, const dmb_residual_bound *bound);
/* chain_start tells the residual at hand from now on. */
void dmb_residual_begins_at(dmb_sim *sim);
/* Factors the iteration matrix in place, that of joints by DMB_METHOD_.... Index of a singular block, or -1. */
int64_t dmb_factor_matrix(dmb_sim *sim, int32_t method);
/* The same for statics, by independent coordinates, telling the weakest pivot: what nothing holds shows as one of
 * rounding size. */
int64_t dmb_factor_stiffness(dmb_sim *sim, dmb_block_weakest *weakest);
/* Evaluates with the factors the evaluation has, 1 for mass and 0 for velocity, and factors the mass matrix alone; the
 * residual is in `residual`. Errors as dmb_system_evaluate, DMB_ERR_SINGULAR with the node in evaluation->element. */
int32_t dmb_factor_mass(dmb_evaluation *evaluation);
/* The same within a step, by dmb_factor_matrix: from both ends, in parts where there are threads. */
int32_t dmb_factor_mass_in_step(dmb_evaluation *evaluation);
/* z with S z = -residual in the rows that are solved, 0 in others, by the factors that sim->factors tells; `z` may be
 * `residual` itself. Multipliers of the trial move too where they are solved for. */
void dmb_solve_for(dmb_sim *sim, const double *residual, double *z);
/* The same from sim->residual into sim->correction. */
void dmb_solve_correction(dmb_sim *sim);

/* Factors of another matrix than that at hand, to be borrowed. */
typedef struct dmb_factor_set {
    double *diagonal, *lower, *upper;
    uint8_t *pivot;
    int32_t kind; /* DMB_FACTORS_... */
    int32_t reserved;
} dmb_factor_set;

/* The factors at hand and these change places. Without joints. */
void dmb_factors_swap(dmb_sim *sim, dmb_factor_set *with);
/* dmb_solve_correction, refined once by the matrix that was factored (its rows that are held: identity), since blocks
 * are solved by their inverses, whose rounding (3e-9 of the correction) is felt in the force of stiff elements.
 * product: room, shape (row). Without joints. */
void dmb_solve_refined(dmb_sim *sim, const dmb_block_matrix *matrix, double *product);

/* Factors of an iteration matrix that serve in later steps (when: integrator/newton).
 *
 * The wall stays where it is while pipes turn in it, and pipes are round: the iteration matrix of a pipe that has
 * turned about its axis is the old one in the old frame. So with a wall, reused factors are taken in the frames in
 * which they were made. (Where only one of two directions across is held this mixes it with the other: an approximate
 * inverse may.) */

/* The factors of this step at hand, by inverses, become those to be reused, in the frames that the step reached: four
 * numbers of each node. */
void dmb_keep_factors(dmb_sim *sim, const double *quaternion);
/* No factors are left to be reused: the state does not go on from the steps that made them. */
void dmb_forget_factors(dmb_sim *sim);
/* z: right-hand side in, solution by the reused factors out; no joints. */
void dmb_solve_reused(const dmb_sim *sim, double *z);

/* ---- The reduced system ------------------------------------------------------------------------------------------ */

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
