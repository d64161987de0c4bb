/* States at rest and in steady motion: their equations, the search for them, and whether they are stable. */
#ifndef DMB_ANALYSIS_STATIC_STATIC_H
#define DMB_ANALYSIS_STATIC_STATIC_H

#include "analysis/linear/linear.h"
#include "drillmbd/analysis.h"
#include "sim/sim.h"
#include "system/assemble/evaluation.h"

/* ---- Steady states ----------------------------------------------------------------------------------------------- */

/* Steady states of scenes whose motion drives move: relative equilibria, in which every node keeps its body-frame
 * velocity.
 *
 * SLIDING, the axes at rest: a node of a string moves by v along the hole (without a hole along its own axis) and turns
 * by Omega about its own axis. With t the tangent of the hole, k its curvature vector, R the node's rotation and ad as
 * in math/mat6.h,
 *
 *     V = (R^T v t; R^T (v t x k) + Omega e_x) = g + w,   w = (0; Omega e_x)        V' = -ad(w) g (eq:sliding.motion)
 *
 * which no force feels the turn of as long as all that turns is round (Sonneville et al. 2014 for the residual; a
 * string on a hole is the relative equilibrium of Simo, Lewis, Marsden 1991 with the material symmetry as its group).
 * RIGID: all turns about a fixed axis, and may move along it, like one rigid body with the world twist X = (vo; omega):
 *
 *     V = Ad(H^-1) X = g                V' = 0
 *
 * The equations of statics are those of motion with these V and V', so that the centrifugal force -ad(V)^T M V,
 * friction by the slip that there is, damping, drag and cutting of rock act. Under d, H = H0 exp(d), V changes by ad(g)
 * d, so the tangent is (eq:sliding.tangent)
 *
 *     K = dr/dH + (dr/dV) ad(g)          (RIGID: exact; SLIDING: without the change of V', of the order M v Omega)  */

typedef struct dmb_steady {
    int32_t kind; /* DMB_STEADY_AT_REST, _SLIDING, _RIGID */
    int32_t reserved;
    double twist[6];           /* [m/s, rad/s] RIGID: X; world axes, velocity of the world's origin */
    double *speed;             /* [m/s, rad/s] SLIDING: v and Omega of each string, shape (string_count, 2) */
    uint32_t *string;          /* of each node; DMB_NONE: of a body, shape (node_count) */
    double *frame_velocity;    /* g, shape (rows) */
    double *before;            /* velocities before joints, shape (rows) */
    double violation;          /* [-] what joints change of the given speeds, over the largest */
    double *increment;         /* the sum of moves, while poses are taken as they are, shape (rows) */
    dmb_linear_matrix damping; /* dr/dV */
    dmb_allocator allocator;
    void *block;
    size_t block_size;
} dmb_steady;

/* The steady state that `wanted` (DMB_STEADY_...) and the motion drives at the sim's present time ask for. assumed: the
 * caller assumes a slip. Where AUTO finds none, it is AT_REST, with DMB_NOTE_NOT_STEADY and a message if drives move
 * all the same. DMB_ERR_UNSUPPORTED, _VALUE with a message; _CALLBACK, _NO_MEMORY. dmb_steady_release gives memory
 * back. */
int32_t dmb_steady_choose(dmb_sim *sim, int32_t wanted, int assumed, dmb_steady *out);
void dmb_steady_release(dmb_steady *steady);

/* Velocities and accelerations of the trial's nodes, for its poses; RIGID: `factor` times as fast. Bodies that slide
 * with strings, as joints let them. DMB_ERR_CALLBACK, and those of dmb_clusters_settle. */
int32_t dmb_steady_move(dmb_steady *steady, dmb_evaluation *evaluation, double factor);
/* Residual and, if asked for, tangent by poses of the trial in its steady motion, as dmb_system_evaluate leaves them.
 */
int32_t dmb_steady_evaluate(dmb_steady *steady, dmb_evaluation *evaluation);
/* DMB_ERR_UNSUPPORTED with a message where a spring of a joint changes its length in the motion of the trial. */
int32_t dmb_steady_check_springs(const dmb_evaluation *evaluation);
/* DMB_ERR_UNSUPPORTED with a message of `who` in `sim` where `work`, a copy of it, is in the steady motion of its
 * drives: what judges a stiffness at rest does not judge that one. The trial of `work` is room. Else DMB_OK, or
 * _CALLBACK, _NO_MEMORY. */
int32_t dmb_steady_refuse_moving(dmb_sim *sim, dmb_sim *work, const char *who);

/* Functions shared by the files of steady states. */

/* [-] Directions and speeds that differ by no more than this are one. */
#define DMB_STEADY_SAME 1e-9

#define DMB_STEADY_REFUSE(sim, ...) (dmb_message_set(&(sim)->message, "static: " __VA_ARGS__), DMB_ERR_UNSUPPORTED)

/* Speed that a motion drive prescribes; the trial holds those of the present time (dmb_system_prescribe). */
static inline double dmb_steady_target(const dmb_sim *sim, uint32_t drive)
{
    return sim->trial.drive_target[drive];
}

/* Speeds of the strings, from the drives. DMB_ERR_UNSUPPORTED with a message, DMB_ERR_NO_MEMORY. */
int32_t dmb_steady_choose_sliding(dmb_sim *sim, dmb_steady *steady);
/* Joints and the accepted state's poses allow the velocities; or DMB_ERR_UNSUPPORTED with a message. */
int32_t dmb_steady_check_joints(dmb_steady *steady, dmb_evaluation *evaluation);

/* ---- The search -------------------------------------------------------------------------------------------------- */

/* Iterations towards equilibrium, on the trial configuration. */

/* A rotation of a string about its own axis that nothing resists (static_spin.c). */
#define DMB_STATIC_SPINS 8 /* strings beyond these are not looked at */
typedef struct dmb_static_spin {
    uint32_t node; /* whose rotation about its axis is held */
    uint32_t reserved;
    double stiffness; /* [N m] added to the tangent there */
    double torque;    /* [N m] of the last evaluation in that row: the unbalanced torque about the axis */
} dmb_static_spin;

typedef struct dmb_static_search {
    dmb_sim *sim;
    const dmb_static_options *options;
    dmb_evaluation evaluation;
    dmb_steady *steady;  /* NULL: at rest */
    uint32_t iterations; /* in all */
    uint32_t load_steps; /* of the last try */
    uint32_t cuts;       /* load steps that were cut */
    uint32_t line_searches;
    int32_t searching; /* 1: corrections that overshoot are shortened */
    int32_t winding;   /* 1: pipes spin about their axes of before, in a hole */
    int32_t rolling;   /* 1: rings that touch go round the wall, where pipes turn and so climb it */
    uint32_t block;    /* block found singular */
    int32_t loose;     /* 1: nothing seems to hold loose_block in the starting pose */
    uint32_t loose_block;
    double residual;      /* [-] relative, last */
    double moved;         /* [-] largest correction before it, in length scales */
    double moved_before;  /* [-] the one before that */
    uint32_t at_rounding; /* iterations in a row whose residual is of rounding size */
    uint32_t reserved;
    double caution;      /* [-] the relaxation's corrections are this much shorter */
    double edge;         /* [-] 1 - cos RZ, largest on the way of joints whose RX and RY are needed; 0: of none */
    uint32_t edge_joint; /* which one it was */
    uint32_t spin_count; /* rotations held in evaluations */
    uint32_t unbalanced; /* number of the spin whose torques do not sum to 0; DMB_NONE: none */
    dmb_static_spin spins[DMB_STATIC_SPINS];
} dmb_static_search;

/* At the sim's present time, without friction; options may be NULL where nothing iterates. */
void dmb_static_set_up(dmb_static_search *search, dmb_sim *sim, const dmb_static_options *options);
/* Friction acts as at these speeds, both 0: not at all. */
void dmb_static_slip(dmb_static_search *search, double axial, double rotation);

/* Residual and tangent of the trial at rest, or in its steady motion. */
int32_t dmb_static_evaluate(dmb_static_search *search);

/* Finds the rotations of strings that nothing resists at the trial, which evaluations hold from now on. Errors as
 * dmb_static_evaluate. */
int32_t dmb_static_find_spins(dmb_static_search *search);
/* In an evaluation: stiffness and residual of the nodes that are held. In a correction: the rotation of whole strings
 * is taken out. */
void dmb_static_apply_spins(dmb_static_search *search);
void dmb_static_correct_spins(dmb_static_search *search);
/* DMB_OK if torques about the axes that are held sum to 0; DMB_ERR_SINGULAR with `unbalanced` and `block`; errors as
 * dmb_static_evaluate. */
int32_t dmb_static_check_spins(dmb_static_search *search);
/* 1: a part that turns or moves far may meet a spring, stop or force of the caller. */
int dmb_static_may_be_caught(const dmb_scene *scene);

typedef int32_t (*dmb_static_method)(dmb_static_search *search);

/* Trial at the starting pose, drives and loads at their present values. */
int32_t dmb_static_begin(dmb_static_search *search);
/* From the start to the whole load in equal steps, or in steps that are halved and doubled, with the line search. The
 * latter keeps the step reached as `now`, whose accepted state has to be in the backup. */
int32_t dmb_static_equal_steps(dmb_static_search *search, dmb_static_method method, uint32_t steps);
int32_t dmb_static_growing_steps(dmb_static_search *search);
/* From the trial, which is in equilibrium without the friction of rings, to all of it in such steps. */
int32_t dmb_static_growing_friction(dmb_static_search *search);
/* Poses of the trial onto the joints, with a partition that suits the place. */
int32_t dmb_static_settle(dmb_static_search *search);
/* Displaces the trial to the low side of the hole, where there is gravity and a wall. */
void dmb_static_lay_on_wall(dmb_sim *sim);
/* The largest pull in a string whose hole bends. */
typedef struct dmb_static_pull {
    double tension; /* [N] */
    double bending; /* [m] sqrt(EI/T): over this length it bends where it meets the wall */
    double element; /* [m] its length */
    uint32_t string;
} dmb_static_pull;
/* Elements that are long beside the length over which a pulled string bends open and close a stiff wall in turn. */
#define DMB_SHORT_ELEMENT 4.0 /* [-] lengths sqrt(EI/T) */
/* By the forces of the starting pose, from which the search begins anew. 1 if there is one, < 0: the caller ends it. */
int32_t dmb_static_find_pull(dmb_static_search *search, dmb_static_pull *most);
/* The equilibrium from where a soft string lies under its pull, on a soft wall, then on harder ones. DMB_OK, or why it
 * failed. */
int32_t dmb_static_from_pull(dmb_static_search *search);
/* By nodes, before an iteration begins, where its correction will be (a node has two rows at least): [N] pull of the
 * element after each, [m] stretch up to each. */
static inline double *dmb_static_pulls(const dmb_sim *sim)
{
    return sim->correction;
}
static inline double *dmb_static_stretches(const dmb_sim *sim)
{
    return sim->correction + sim->scene->node_count;
}
/* The pulls of a string that meets the wall, by the residual of the starting pose; 0: it is not known,
 * since the string is free at both ends or at none. */
int dmb_static_tensions(dmb_sim *sim, uint32_t string);
int dmb_static_is_free_along(const dmb_scene *scene, uint32_t node);
/* Of a full node, in y and z: what something holds sideways is neither laid nor rolled. */
int dmb_static_is_free_across(const dmb_scene *scene, uint32_t node);
/* After a full node was moved beside its equations: where it is held or driven along its axis, that part of the way
 * `back` [m] is gone. */
void dmb_static_stay_along(dmb_sim *sim, uint32_t node, const double back[3]);
/* From the starting pose, after its evaluation. */
void dmb_static_lay_by_pull(dmb_static_search *search);
/* [-] How much softer the wall must be for the pull to press a ring into it by `part` of its clearance, 1 ..
 * DMB_SOFTEST. */
#define DMB_SOFTEST 1e6
double dmb_static_softness(const dmb_static_search *search, const dmb_static_pull *pull, double part);
/* A wall that the weight presses a ring into by less than this part of its clearance opens and closes contacts in turn.
 */
#define DMB_STIFF_WALL 1e-2
typedef struct dmb_static_stiff_wall {
    double depth;     /* [m] under the weight of a ring */
    double clearance; /* [m] of that ring */
    double element;   /* [m] length of the element before it */
    double softer;    /* [N/m^(n+1)] stiffness with which the depth is a tenth of the clearance */
} dmb_static_stiff_wall;
/* The ring for which the wall is stiffest; 1 if there is one. */
int dmb_static_find_stiff_wall(const dmb_scene *scene, dmb_static_stiff_wall *out);
/* Shortens the last move, by `direction` (row_count), which ended where the residual was just
 * evaluated; `before` is direction . residual at its start. Leaves the residual and tangent of where it ends. */
int32_t dmb_static_line_search(dmb_static_search *search, const double *direction, double before);
/* The trial displaced by body-frame increments: as it comes, and as the search moves it (winding, rolling), closed
 * at its joints. */
void dmb_static_displace(dmb_sim *sim, const double *correction, double factor);
int32_t dmb_static_move(dmb_static_search *search, const double *correction, double factor);
/* Back to where such a move came from, joints as they come. */
void dmb_static_move_back(dmb_static_search *search, const double *correction, double factor);
/* Work of the residual along the move by `direction`, after this part of it. */
double dmb_static_work(const dmb_static_search *search, const double *direction, double part);
/* The tangent of the residual in axes of the nodes becomes that in axes which do not spin with them. */
void dmb_static_fix_axes(dmb_sim *sim);
/* Newton with the extrapolated element stress (eq:static.extrapolated) at the search's load factor. DMB_OK, or why it
 * failed. */
int32_t dmb_static_newton(dmb_static_search *search);
/* One such correction. */
int32_t dmb_static_correct(dmb_static_search *search);
/* Pseudo-transient continuation: (K + D/tau^2) z = -residual with growing tau and limited corrections
 * (eq:static.relaxation); slower and surer. */
int32_t dmb_static_relaxation(dmb_static_search *search);
/* Moves the trial aside by random displacements, the same for each number. */
int32_t dmb_static_push_aside(dmb_static_search *search, uint32_t number);
/* Strings that nothing holds along their hole go back to where their rig end was, if they rest there too. */
int32_t dmb_static_take_back(dmb_static_search *search);

/* Puts the message of a search that failed: the part, the figure and its bound, and what may help. */
void dmb_static_explain(dmb_static_search *search, int32_t status);

/* Options of the static start, checked. */

/* Defaults overlaid with what is given (may be NULL); on refusal a message naming the field. */
int32_t dmb_static_options_take(dmb_sim *sim, const dmb_static_options *given, dmb_static_options *out);

/* ---- Stability --------------------------------------------------------------------------------------------------- */

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
 * D (analysis/buckling/buckling.h). They are looked for among the eigenvalues nearest 0, unless a positive definite
 * symmetric part, with or without what friction adds to it (analysis/static/stability_friction.c), says that there is
 * none: by Krylov subspaces on x -> K^-1 D x, as many vectors as some hundreds of millions of products allow, until the
 * symmetric part H leaves none further out: mu >= -rho where H + rho D is positive definite, x.Hx = mu x.Dx; or so many
 * have been seen, and the sign of det K agrees with their number. The sign alone would not do: what is round diverges
 * in two directions at once. Of a state that was asked for, up to 400 coordinates have all their eigenvalues found;
 * beyond, none found among the nearest is not counted (-1) unless the symmetric part excludes others. Flutter is not
 * looked for: it depends on mass and damping (modes). */

typedef struct dmb_stability {
    int32_t stiffness;  /* DMB_STIFFNESS_... */
    int32_t negative;   /* eigenvalues as above, those of rounding size apart; -1: they could not be counted */
    int32_t unresolved; /* eigenvalues of rounding size, whose signs are not known; looked for where `thorough` */
    int32_t reserved;
    double bound;     /* [N/m] largest size of those, rotations over the square of the length scale */
    double asymmetry; /* [-] dmb_asymmetry_of */
    double rounding;  /* [N/m] of eigenvalues in D, K being unsymmetric */
    double *amount;   /* (rows) in: NULL or room; out: rounding of the rows (eq:signs.amount) */
} dmb_stability;

/* After an evaluation with the true tangent: forms the iteration matrix, judges it and leaves it factored as
 * dmb_factor_stiffness, whose result *bad is; not judged where that is >= 0. `thorough` 1: of a state that was asked
 * for, with the eigenvalues of rounding size; 0: of one on a path, where what counts is that the same is
 * counted at each point. The residual is left as it was. Errors: DMB_ERR_NO_MEMORY, and as dmb_system_evaluate. */
int32_t dmb_stability_judge(dmb_static_search *state, int thorough, dmb_block_weakest *weakest, int64_t *bad,
                            dmb_stability *out);

/* Eigenvalue of K x = mu E x nearest 0 [N/m], K symmetric, E the displacements across the axes of the nodes, by the
 * factors at hand, and its shape (rows), of length 1 in E. `guessed` 1: shape is that of a state nearby.
 * DMB_ERR_NO_CONVERGENCE also where nothing moves across; other errors of dmb_krylov_largest. */
int32_t dmb_stability_softest(dmb_sim *sim, int guessed, double *value, double *shape);

/* Whether rings that slip leave a state without divergence, without an eigenvalue being sought.
 *
 * A ring with the stiffness k of the wall behind it adds k (n + f) n^T to K: n its normal, f friction for a unit of
 * normal force. The symmetric part of this alone has a negative eigenvalue, however little friction there is. With
 *
 *     W = I - f n^T,      W (n + f) n^T = n n^T,               (eq:static.friction-turned)
 *
 * K x = mu D x has no real mu below -rho/(1 - |f|/2) if
 *
 *     sym(W K) + rho D     is positive definite, |f| < 2 in the weights D:
 *
 * sym(W D) >= (1 - |f|/2) D, so sym(W (K + s D)) is positive definite for s beyond that, and K + s D is regular. f n^T
 * of nodes without contact is taken between those of their neighbours, since a W that is the same for neighbours leaves
 * the stiffness between them nearly symmetric. */

/* Multiplies the rows of chains without joints in the iteration matrix, which is not factored, by W. 1: done, *most is
 * the largest |f|; 0: no ring slips, or |f| is too large, and the matrix is left as it is; DMB_ERR_NO_MEMORY. */
int32_t dmb_stability_turn_friction(const dmb_evaluation *evaluation, double *most);

#endif
