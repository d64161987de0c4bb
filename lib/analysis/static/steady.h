/* Steady states of scenes whose motion drives move: relative equilibria, in which every node keeps its body-frame
 * velocity.
 *
 * SLIDING, the axes at rest: a node of a string moves by v along the hole (without a hole along its own axis) and turns
 * by Omega about its own axis. With t the tangent of the hole, k its curvature vector, R the node's rotation and ad as
 * in math/mat6.h,
 *
 *     V = (R^T v t; R^T (v t x k) + Omega e_x) = g + w,   w = (0; Omega e_x)        V' = -ad(w) g
 *
 * which no force feels the turn of as long as all that turns is round (Sonneville et al. 2014 for the residual; a
 * string on a hole is the relative equilibrium of Simo, Lewis, Marsden 1991 with the material symmetry as its group).
 * RIGID: all turns about a fixed axis, and may move along it, like one rigid body with the world twist X = (vo; omega):
 *
 *     V = Ad(H^-1) X = g                V' = 0
 *
 * The equations of statics are those of motion with these V and V', so that the centrifugal force -ad(V)^T M V,
 * friction by the slip that there is, damping, drag and cutting of rock act. Under d, H = H0 exp(d), V changes by ad(g)
 * d, so the tangent is
 *
 *     K = dr/dH + (dr/dV) ad(g)          (RIGID: exact; SLIDING: without the change of V', of the order M v Omega)  */
#ifndef DMB_ANALYSIS_STATIC_STEADY_H
#define DMB_ANALYSIS_STATIC_STEADY_H

#include "analysis/linear/linear.h"
#include "system/assemble/evaluation.h"

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

#define REFUSE(sim, ...) (dmb_message_set(&(sim)->message, "static: " __VA_ARGS__), DMB_ERR_UNSUPPORTED)

/* Speed that a motion drive prescribes; the trial holds those of the present time (dmb_system_prescribe). */
static inline double dmb_steady_target(const dmb_sim *sim, uint32_t drive)
{
    return sim->trial.drive_target[drive];
}

/* Speeds of the strings, from the drives. DMB_ERR_UNSUPPORTED with a message, DMB_ERR_NO_MEMORY. */
int32_t dmb_steady_choose_sliding(dmb_sim *sim, dmb_steady *steady);
/* Joints and the accepted state's poses allow the velocities; or DMB_ERR_UNSUPPORTED with a message. */
int32_t dmb_steady_check_joints(dmb_steady *steady, dmb_evaluation *evaluation);

#endif
