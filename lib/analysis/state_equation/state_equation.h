/* The state equation y' = f(t, y) of a scene without memory, in independent coordinates (eq:joints.state-equation).
 *
 * Each node has chart coordinates z about an origin, a state of the scene with pose (R0, x0):
 *
 *     x = x0 + R0 p,   R = R0 exp(0, a, b) Rx(phi),   z = (p, phi, a, b)               (eq:joints.chart)
 *
 * so that the rotation phi about the axis of a pipe is unbounded, and the tilt is below half a turn. With the velocity
 * (u, w) in the body frame, S = R0^T R and T the tangent of the exponential at (0, a, b):
 *
 *     p' = S u,   T (0, a', b') + phi' e_x = Rx(phi) w                                 (eq:joints.chart-rate)
 *
 * z of supports is 0 and that of motion drives the integral of their time function. Joints make some coordinates
 * dependent, those of the partition at the origin (eq:joints.partition): C(z, t) = 0 and B v + rate = 0 are solved for
 * them. y holds z of the independent rows, then v of the same rows. */
#ifndef DMB_ANALYSIS_STATE_EQUATION_STATE_EQUATION_H
#define DMB_ANALYSIS_STATE_EQUATION_STATE_EQUATION_H

#include "drillmbd/analyse.h"
#include "sim/access.h"
#include "system/assemble/evaluation.h"

/* The choice of dependent coordinates, kept while another one is tried. */
typedef struct dmb_kept_partition {
    uint32_t *rank, *row, *column;
    double *quality;
} dmb_kept_partition;

struct dmb_state_equation {
    uint32_t magic;
    int32_t busy; /* 1: a call on it is under way */
    dmb_allocator allocator;
    size_t bytes; /* size of this block */
    dmb_sim *work;
    dmb_model *model; /* reference kept */
    double since;     /* [s] time of the sim, from which the functions of its inputs are known */
    uint32_t count;   /* independent coordinates */
    uint32_t reserved;
    uint32_t *row_of;  /* their rows, ascending, shape (count) */
    uint8_t *kind;     /* DMB_STATE_..., shape (rows) */
    double *z, *older; /* chart coordinates of all rows, and those of the place before, shape (rows) */
    /* The origin: time, pose, turns of nodes and joints, positions of drives, velocities. */
    double time, *displacement, *quaternion, *turn, *joint_turn, *drive_position, *velocity;
    dmb_kept_partition kept;
};

/* Rows of the scene: independent, dependent by joints, moved by a drive, held by a support. */
enum { DMB_STATE_FREE = 0, DMB_STATE_DEPENDENT = 1, DMB_STATE_DRIVEN = 2, DMB_STATE_HELD = 3 };

/* DMB_OK, or DMB_ERR_UNSUPPORTED with a message where a part of the scene has a memory, or an equation of velocities or
 * a drive makes its positions depend on its path. */
int32_t dmb_state_check_memory(dmb_sim *sim);
/* The evaluation at a time, for the poses of the origin (step 0). */
dmb_evaluation dmb_state_evaluation(const dmb_state_equation *s, double time);
/* Trial pose and chart coordinates of y at `time`. DMB_ERR_GEOMETRY, _SINGULAR, _NO_CONVERGENCE, _CALLBACK,
 * _NOT_FINITE, with a message. */
int32_t dmb_state_find_pose(dmb_state_equation *s, double time, const double *y);
/* Trial velocities of y in that pose. */
int32_t dmb_state_find_velocity(dmb_state_equation *s, double time, const double *u);
/* Rates of the chart coordinates of a node, by its body-frame velocity: z' by v, shape (size of the node). */
void dmb_state_chart_rate(const dmb_state_equation *s, uint32_t node, const double *v, double *rate);

#endif
