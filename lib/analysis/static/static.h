/* Steady states (static equilibria and relative equilibria): equations, nonlinear solution, and stability. */
#ifndef DMB_ANALYSIS_STATIC_STATIC_H
#define DMB_ANALYSIS_STATIC_STATIC_H

#include "analysis/linear/linear.h"
#include "drillmbd/analyse.h"
#include "sim/sim.h"
#include "system/assemble/evaluation.h"

/* ---- Steady states ----------------------------------------------------------------------------------------------- */

/* Steady states of scenes with moving motion drives: relative equilibria, in which every node keeps its body-frame
 * velocity.
 *
 * SLIDING, inertial axes: a node of a string moves by v along the hole (without a hole along its own axis) and rotates
 * by Omega about its own axis. With t the tangent of the hole, k its curvature vector, R the node's rotation and ad as
 * in math/mat6.h,
 *
 *     V = (R^T v t; R^T (v t x k) + Omega e_x) = g + w,   w = (0; Omega e_x)        V' = -ad(w) g (eq:sliding.motion)
 *
 * No force depends on the rotation angle if all rotating parts are axisymmetric (Sonneville et al. 2014 for the
 * residual; a string on a hole is the relative equilibrium of Simo, Lewis, Marsden 1991 with the material symmetry as
 * its group). RIGID: the whole scene rotates about a fixed axis, and may move along it, like one rigid body with the
 * world twist X = (vo; omega):
 *
 *     V = Ad(H^-1) X = g                V' = 0
 *
 * The equations of statics are those of motion with these V and V'. They include the centrifugal force -ad(V)^T M V,
 * friction at the actual slip, damping, drag and rock cutting. Under d, H = H0 exp(d), V changes by ad(g) d, so the
 * tangent is (eq:sliding.tangent)
 *
 *     K = dr/dH + (dr/dV) ad(g)          (RIGID: exact; SLIDING: without the change of V', of the order M v Omega) */

typedef struct dmb_steady {
    int32_t kind; /* DMB_STEADY_AT_REST, _SLIDING, _RIGID */
    int32_t reserved;
    double twist[6];           /* [m/s, rad/s] RIGID: X; world axes, velocity of the world's origin */
    double *speed;             /* [m/s, rad/s] SLIDING: v and Omega of each string, shape (string_count, 2) */
    uint32_t *string;          /* string of each node, shape (node_count); DMB_NONE: node of a body */
    double *frame_velocity;    /* g, shape (rows) */
    double *before;            /* velocities before projection on the joints, shape (rows) */
    double violation;          /* [-] largest change of the prescribed velocities by the joints, relative */
    double *increment;         /* copy of the sim's increment during an evaluation, shape (rows) */
    dmb_linear_matrix damping; /* dr/dV */
    dmb_allocator allocator;
    void *block;
    size_t block_size;
} dmb_steady;

/* Steady state selected by `wanted` (DMB_STEADY_...) and by the motion drives at the sim's present time. assumed: the
 * caller assumes a slip. If AUTO finds no steady motion, the state is AT_REST; if drives move nevertheless, the result
 * is DMB_NOTE_NOT_STEADY with a message. DMB_ERR_UNSUPPORTED, _VALUE with a message; _CALLBACK, _NO_MEMORY.
 * dmb_steady_release frees the memory. */
int32_t dmb_steady_choose(dmb_sim *sim, int32_t wanted, int assumed, dmb_steady *out);
void dmb_steady_release(dmb_steady *steady);

/* Velocities [m/s, rad/s] and accelerations of the trial's nodes in body frames, for the trial's poses; RIGID: scaled
 * by `factor`. Velocities of bodies that slide with strings follow from the joints. DMB_ERR_CALLBACK, and errors of
 * dmb_clusters_settle. */
int32_t dmb_steady_move(dmb_steady *steady, dmb_evaluation *evaluation, double factor);
/* Residual and, on request, tangent by poses of the trial in its steady motion, stored as by dmb_system_evaluate. */
int32_t dmb_steady_evaluate(dmb_steady *steady, dmb_evaluation *evaluation);
/* DMB_ERR_UNSUPPORTED with a message if the length of a joint spring changes in the motion of the trial. */
int32_t dmb_steady_check_springs(const dmb_evaluation *evaluation);
/* DMB_ERR_UNSUPPORTED with a message of `who` in `sim` if `work`, a copy of it, is in the steady motion of its drives:
 * stability criteria for a state at rest do not apply to a moving state. The trial of `work` is workspace. Else DMB_OK,
 * or _CALLBACK, _NO_MEMORY. */
int32_t dmb_steady_refuse_moving(dmb_sim *sim, dmb_sim *work, const char *who);

/* Functions shared by the source files of steady states. */

/* [-] Relative difference below which two directions or speeds count as equal. */
#define DMB_STEADY_SAME 1e-9

#define DMB_STEADY_REFUSE(sim, ...) (dmb_message_set(&(sim)->message, "static: " __VA_ARGS__), DMB_ERR_UNSUPPORTED)

/* Speed prescribed by a motion drive [m/s or rad/s] at the present time, from the trial (dmb_system_prescribe). */
static inline double dmb_steady_target(const dmb_sim *sim, uint32_t drive)
{
    return sim->trial.drives[drive].target;
}

/* Speeds of the strings, from the drives. Errors: DMB_ERR_UNSUPPORTED with a message, DMB_ERR_NO_MEMORY. */
int32_t dmb_steady_choose_sliding(dmb_sim *sim, dmb_steady *steady);
/* Checks that joints and the accepted state's poses permit the velocities; else DMB_ERR_UNSUPPORTED with a message. */
int32_t dmb_steady_check_joints(dmb_steady *steady, dmb_evaluation *evaluation);

/* ---- Nonlinear solution ------------------------------------------------------------------------------------------ */

/* Iteration towards equilibrium, on the trial configuration. */

/* An unconstrained rotation of a string about its own axis (static_spin.c). */
#define DMB_STATIC_SPINS 8 /* largest number of strings examined */
typedef struct dmb_static_spin {
    uint32_t node; /* node whose rotation about its axis is constrained */
    uint32_t reserved;
    double stiffness; /* [N m] added to the tangent in that row */
    double torque;    /* [N m] unbalanced torque about the axis: residual of that row in the last evaluation */
} dmb_static_spin;

typedef struct dmb_static_search {
    dmb_sim *sim;
    const dmb_static_options *options;
    dmb_evaluation evaluation;
    dmb_steady *steady;  /* NULL: at rest */
    uint32_t iterations; /* total */
    uint32_t load_steps; /* of the last attempt */
    uint32_t cuts;       /* number of halved load steps */
    uint32_t line_searches;
    int32_t searching;     /* 1: line search after corrections that overshoot */
    int32_t winding;       /* 1: pipes in a hole rotate about their axes before the move (eq:static.move) */
    int32_t rolling;       /* 1: rings in contact roll around the wall, as rotating pipes climb it */
    uint32_t block;        /* block found singular */
    int32_t unconstrained; /* 1: unconstrained_block seems unconstrained in the starting pose */
    uint32_t unconstrained_block;
    double residual;       /* [-] relative, last */
    double moved;          /* [-] largest component of the last correction, in length scales */
    double moved_before;   /* [-] the same of the correction before the last */
    uint32_t at_rounding;  /* consecutive iterations whose residual is at the rounding level */
    int32_t slides;        /* 1: the solution slides a string along its hole, with a message */
    double caution;        /* [-] divisor of the correction size in the relaxation */
    double gimbal_margin;  /* [-] 1 - cos RZ, largest so far of joints whose RX and RY are needed; 0: none */
    uint32_t gimbal_joint; /* index of that joint */
    uint32_t spin_count;   /* number of constrained rotations in evaluations */
    uint32_t unbalanced;   /* index of the spin whose torques do not sum to 0; DMB_NONE: none */
    dmb_static_spin spins[DMB_STATIC_SPINS];
} dmb_static_search;

/* Initialises at the sim's present time, without friction; options may be NULL if no iteration follows. */
void dmb_static_set_up(dmb_static_search *search, dmb_sim *sim, const dmb_static_options *options);
/* Slip speeds [m/s, rad/s] that friction assumes; both 0: no friction. */
void dmb_static_slip(dmb_static_search *search, double axial, double rotation);

/* Residual and tangent of the trial, at rest or in its steady motion. */
int32_t dmb_static_evaluate(dmb_static_search *search);

/* Finds the unconstrained rotations of strings at the trial; later evaluations constrain them. Errors as
 * dmb_static_evaluate. */
int32_t dmb_static_find_spins(dmb_static_search *search);
/* Component of a node that is its spin, and the entry of the stiffness on it. */
uint32_t dmb_static_spin_row(const dmb_scene *scene, uint32_t node);
double *dmb_static_spin_stiffness(dmb_sim *sim, uint32_t node);
/* In an evaluation: stiffness and residual of the nodes that are held. In a correction: the rotation of whole strings
 * is taken out. */
void dmb_static_apply_spins(dmb_static_search *search);
void dmb_static_correct_spins(dmb_static_search *search);
/* DMB_OK if the torques about the constrained axes sum to 0; DMB_ERR_SINGULAR with `unbalanced` and `block`; errors as
 * dmb_static_evaluate. */
int32_t dmb_static_check_spins(dmb_static_search *search);
/* 1: a far rotation or displacement may engage a spring, a stop or a caller's force. */
int dmb_static_may_be_caught(const dmb_scene *scene);

typedef int32_t (*dmb_static_method)(dmb_static_search *search);

/* Sets the trial to the starting pose, with drives and loads at their present values. */
int32_t dmb_static_begin(dmb_static_search *search);
/* From the starting pose to the full load in equal steps, or in steps that are halved and doubled, with the line
 * search. The latter stores the reached step in `now`; the caller must have backed up its accepted state. */
int32_t dmb_static_equal_steps(dmb_static_search *search, dmb_static_method method, uint32_t steps);
int32_t dmb_static_growing_steps(dmb_static_search *search);
/* From the trial, which is in equilibrium without ring friction, to full friction in halved and doubled steps. */
int32_t dmb_static_growing_friction(dmb_static_search *search);
/* Projects the poses of the trial onto the joints and ensures a well-conditioned partition there. */
int32_t dmb_static_settle(dmb_static_search *search);
/* Displaces the trial to the low side of the hole if the scene has gravity and a wall. */
void dmb_static_guess_on_wall(dmb_sim *sim);
/* Largest tension of a string in a curved hole. */
typedef struct dmb_static_pull {
    double tension; /* [N] */
    double bending; /* [m] sqrt(EI/T): bending length at the wall */
    double element; /* [m] element length */
    uint32_t string;
} dmb_static_pull;
/* Limit of element length: longer elements of a tensioned string open and close contacts of a stiff wall in turn. */
#define DMB_SHORT_ELEMENT 4.0 /* [-] multiples of sqrt(EI/T) */
/* Largest tension by the forces of the starting pose, at which the iteration restarts. 1: found, 0: none, < 0: error
 * that ends the analysis. */
int32_t dmb_static_find_pull(dmb_static_search *search, dmb_static_pull *most);
/* Equilibrium from the soft-string initial guess, first with a soft wall, then with stiffer walls. DMB_OK, or the
 * reason of failure. */
int32_t dmb_static_from_pull(dmb_static_search *search);
/* Workspace by nodes, before an iteration begins, in the array of its correction (a node has at least two rows): [N]
 * tension of the element after each node, [m] elongation up to each node. */
static inline double *dmb_static_pulls(const dmb_sim *sim)
{
    return sim->correction;
}
static inline double *dmb_static_stretches(const dmb_sim *sim)
{
    return sim->correction + sim->scene->node_count;
}
/* Tensions [N] of a string in wall contact, by the residual of the starting pose. 0: not determined, because the string
 * is free along at both ends or at neither. */
int dmb_static_tensions(dmb_sim *sim, uint32_t string);
int dmb_static_is_free_along(const dmb_scene *scene, uint32_t node);
/* 1: a full node is free in y and z; laterally constrained nodes get no initial guess on the wall and do not roll. */
int dmb_static_is_free_across(const dmb_scene *scene, uint32_t node);
/* After a displacement of a full node outside the equations: removes the part of the move `back` [m] along its axis if
 * the node is constrained or driven there. */
void dmb_static_stay_along(dmb_sim *sim, uint32_t node, const double back[3]);
/* Soft-string initial guess from the starting pose, after its evaluation. */
void dmb_static_guess_by_pull(dmb_static_search *search);
/* [-] Factor by which the wall must be softened for the tension to press a ring into it by `part` of its clearance, 1
 * .. DMB_SOFTEST. */
#define DMB_SOFTEST 1e6
double dmb_static_softness(const dmb_static_search *search, const dmb_static_pull *pull, double part);
/* Stiff wall: penetration under weight below this fraction of the clearance; contacts then open and close in turn. */
#define DMB_STIFF_WALL 1e-2
typedef struct dmb_static_stiff_wall {
    double depth;     /* [m] penetration under the weight at a ring */
    double clearance; /* [m] of that ring */
    double element;   /* [m] length of the preceding element */
    double softer;    /* [N/m^(n+1)] stiffness at which the penetration is a tenth of the clearance */
} dmb_static_stiff_wall;
/* Finds the ring with the smallest penetration relative to its clearance; 1 if one exists below DMB_STIFF_WALL. */
int dmb_static_find_stiff_wall(const dmb_scene *scene, dmb_static_stiff_wall *out);
/* Shortens the last move along `direction` (row_count), at whose end the residual was just evaluated; `before` is
 * direction . residual at its start. Residual and tangent are those of the final position. */
int32_t dmb_static_line_search(dmb_static_search *search, const double *direction, double before);
/* Displaces the trial by body-frame increments: plainly, or as the solution does it (winding, rolling) with joints
 * closed. */
void dmb_static_displace(dmb_sim *sim, const double *correction, double factor);
int32_t dmb_static_move(dmb_static_search *search, const double *correction, double factor);
/* Reverses such a move, without closing the joints. */
void dmb_static_move_back(dmb_static_search *search, const double *correction, double factor);
/* Work [J] of the residual per unit step along `direction`, after the fraction `part` of the move. */
double dmb_static_work(const dmb_static_search *search, const double *direction, double part);
/* Transforms the tangent of the residual from axes of the nodes to axes that do not spin with them. */
void dmb_static_fix_axes(dmb_sim *sim);
/* Newton iteration with the extrapolated element stress (eq:static.extrapolated) at the present load factor. DMB_OK, or
 * the reason of failure. */
int32_t dmb_static_newton(dmb_static_search *search);
/* A single such correction. */
int32_t dmb_static_correct(dmb_static_search *search);
/* Pseudo-transient continuation: (K + D/tau^2) z = -residual with increasing tau and limited corrections
 * (eq:static.relaxation); slower and more robust than Newton. */
int32_t dmb_static_relaxation(dmb_static_search *search);
/* Perturbs the trial by random displacements that are the same for each number. */
int32_t dmb_static_push_aside(dmb_static_search *search, uint32_t number);
/* Returns strings without axial constraint to the initial position of their rig end, if they are in equilibrium
 * there. */
int32_t dmb_static_revert(dmb_static_search *search);

/* Sets the message of a failed analysis: the part, the value with its bound, and the remedy. */
void dmb_static_explain(dmb_static_search *search, int32_t status);
/* 1, with a message, if the trial slides a string along its hole to a place far from the starting pose. */
int dmb_static_note_slide(dmb_sim *sim);

/* Options of the static analysis, checked. */

/* Defaults overlaid with `given` (may be NULL); an invalid value is refused with a message that names the field. */
int32_t dmb_static_options_get(dmb_sim *sim, const dmb_static_options *given, dmb_static_options *out);

/* ---- Stability --------------------------------------------------------------------------------------------------- */

/* [-] Asymmetry (dmb_asymmetry_of) above which a stiffness counts as non-symmetric. Rounding causes 1e-12. */
#define DMB_UNSYMMETRIC 1e-9

/* [-] largest |A_ij - A_ji| / sqrt(A_ii A_jj) of the unfactored iteration matrix in the stiffness_ blocks; with joints
 * that of the reduced system in reduced_value, just assembled. `rounding` [N/m]: a difference that counts as 0, per
 * unit of the weights 1 of displacements and length_scale^2 of rotations. */
double dmb_asymmetry_of(const dmb_sim *sim, double rounding);

/* Replaces the blocks of the scene's layout, and the values of its pattern at the sim's present sizes, by their
 * symmetric part. */
void dmb_make_blocks_symmetric(const dmb_block_layout *layout, double *diagonal, double *lower, double *upper);
void dmb_make_reduced_symmetric(const dmb_sim *sim, double *values);

/* Stability of a static state: by the signs of its stiffness K if that is symmetric, and otherwise by the real negative
 * eigenvalues of K x = mu D x, D the weights 1 of displacements and length_scale^2 of rotations. A single real
 * eigenvalue changes sign through det K = 0, whatever D; two real negative eigenvalues may arise together from a
 * complex pair, at a place that depends on D (analysis/buckling/buckling.h).
 *
 * Non-symmetric K: no eigenvalue is computed if a positive definite symmetric part, with or without the contribution of
 * friction (analysis/static/stability_friction.c), excludes negative ones. Otherwise the eigenvalues nearest 0 are
 * computed by Krylov subspaces on x -> K^-1 D x, with as many vectors as some hundreds of millions of products permit.
 * Their number increases until the symmetric part H excludes further negative ones (mu >= -rho if H + rho D is positive
 * definite, x.Hx = mu x.Dx), or until a minimum number is reached and the sign of det K agrees with the count. The sign
 * alone is not sufficient: an axisymmetric structure diverges in two directions at once. For a state that the caller
 * requested, all eigenvalues are computed up to 400 coordinates; beyond, the result -1 (not counted) is returned if
 * none is found among the nearest and the symmetric part does not exclude others. Flutter is not examined: it depends
 * on mass and damping (modes). */

typedef struct dmb_stability {
    int32_t stiffness;  /* DMB_STIFFNESS_... */
    int32_t negative;   /* negative eigenvalues beyond the rounding level; -1: they could not be counted */
    int32_t unresolved; /* eigenvalues at the rounding level, of unknown sign; computed if `thorough` */
    int32_t odd;        /* 1: det K < 0, known without a count */
    double bound;     /* [N/m] largest magnitude of the unresolved eigenvalues, rotations over the square of the length
                         scale */
    double asymmetry; /* [-] dmb_asymmetry_of */
    double rounding;  /* [N/m] rounding level of eigenvalues in D for non-symmetric K */
    double *amount;   /* (rows) in: NULL or workspace; out: rounding level of the rows (eq:signs.amount) */
} dmb_stability;

/* After an evaluation with the true tangent: forms the iteration matrix, assesses its stability and leaves it factored
 * as dmb_factor_stiffness, whose result *bad is; not assessed if *bad >= 0. `thorough` 1: a state requested by the
 * caller, with the eigenvalues at the rounding level; 0: a state on a path, which requires only the same counting rule
 * at every point. The residual is unchanged. Errors: DMB_ERR_NO_MEMORY, and as dmb_system_evaluate. */
int32_t dmb_stability_judge(dmb_static_search *state, int thorough, dmb_block_weakest *weakest, int64_t *bad,
                            dmb_stability *out);

/* Lowest eigenvalue of K x = mu E x, K symmetric, E the lateral displacements of the nodes (softest.c). */
typedef struct dmb_softest {
    dmb_sim *sim;
    double *diagonal, *lower, *upper; /* K, unfactored, in the storage of the scene's layout */
    double *lateral;                  /* (rows) diagonal of E */
    double *product, *solution;       /* (rows) */
    const double *guess;              /* (rows) expected shape; NULL: none, or already used */
    double *multiplier;               /* (rows of constraints) of the trial: solutions change those that are unknowns */
    uint32_t dimension;               /* rank of E, without joints */
    uint32_t reserved;
    void *block;
    size_t bytes;
} dmb_softest;

/* Allocates memory, from zeros; dmb_softest_close frees it in any case. */
int32_t dmb_softest_open(const dmb_sim *sim, dmb_softest *softest);
void dmb_softest_close(dmb_softest *softest, const dmb_sim *sim);
/* Value [N/m] and shape (rows), of unit length in E, by the unfactored iteration matrix in the stiffness_ blocks, which
 * is overwritten. guessed 1: value and shape are those of a nearby state. DMB_ERR_NO_CONVERGENCE also if nothing moves
 * laterally; errors of dmb_progress_pulse. */
int32_t dmb_softest_find(dmb_softest *softest, dmb_sim *sim, int guessed, double *value, double *shape);

/* Sufficient condition for the absence of divergence with slipping rings, without eigenvalues.
 *
 * A ring with the wall stiffness k adds k (n + f) n^T to K: n its normal, f friction for a unit of normal force. The
 * symmetric part of this term alone has a negative eigenvalue, however small the friction. With
 *
 *     W = I - f n^T,      W (n + f) n^T = n n^T,               (eq:static.friction-turned)
 *
 * K x = mu D x has no real mu below -rho/(1 - |f|/2) if
 *
 *     sym(W K) + rho D     is positive definite, |f| < 2 in the weights D:
 *
 * sym(W D) >= (1 - |f|/2) D, so sym(W (K + s D)) is positive definite for s beyond that, and K + s D is regular. For
 * nodes without contact f n^T is interpolated between neighbouring contacts, since a W that is equal for neighbours
 * leaves the stiffness between them nearly symmetric. */

/* Multiplies the rows of chains without joints in the unfactored iteration matrix by W. 1: done, *most is the largest
 * |f|; 0: no ring slips, or |f| is too large, and the matrix is unchanged; DMB_ERR_NO_MEMORY. */
int32_t dmb_stability_turn_friction(const dmb_evaluation *evaluation, double *most);

#endif
