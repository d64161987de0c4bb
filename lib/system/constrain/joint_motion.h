/* Frame b of a joint seen from frame a in a configuration, and how rows and wrenches there reach the rows of its
 * nodes. */
#ifndef DMB_SYSTEM_CONSTRAIN_JOINT_MOTION_H
#define DMB_SYSTEM_CONSTRAIN_JOINT_MOTION_H

#include "constraint/joint.h"
#include "sim/sim.h"
#include "system/assemble/evaluation.h"

/* Added to joint_segment while a DMB_JOINT_POINT_ON_HOLE is locked: frame a stands at joint_depth and does not ride. */
#define DMB_SEGMENT_HELD 0x80000000u

/* Motion of the axis of the hole at a point on it: frame_rate: turning of the hole frame per metre, curvature, tangent,
 * in frame a. */
typedef struct dmb_hole_bend {
    double frame_rate[3], curvature[3], tangent[3]; /* [rad/m], [1/m], [-] world axes */
    double normal[2][3];                            /* [-] y and z axes of the frame, world */
    double M[9];                                    /* [-] axes of frame b in the world */
} dmb_hole_bend;

/* Pose, maps and motion of joint j. In a configuration that may be written, joint_depth and joint_segment follow; bend
 * (only of DMB_JOINT_POINT_ON_HOLE) may be NULL. */
void dmb_joint_motion(const dmb_scene *scene, dmb_configuration *configuration, uint32_t j, dmb_relative *relative,
                      dmb_hole_bend *bend);
/* The place of joint j on the hole's axis in trial is that of now: what a trial before found does not count. */
void dmb_joint_place_begin(dmb_sim *sim, uint32_t j);
/* Joint j is held where it stands on the hole's axis in now, or rides along again. */
void dmb_joint_place_hold(dmb_sim *sim, uint32_t j, int held);
/* The same motion without a trace in the configuration. */
void dmb_joint_motion_of(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t j,
                         dmb_relative *relative, dmb_hole_bend *bend);

/* First column of a node in a constraint; the node must be one of its nodes. */
uint32_t dmb_constraint_column(const dmb_constraint *constraint, uint32_t node);
/* columns += the part of a 6-vector of a node that its rows feel. */
void dmb_add_node_columns(const dmb_scene *scene, uint32_t node, const double vector[6], double *columns);
/* row (shape (columns)) += factor J [to_a, to_b] of joint j. */
void dmb_add_joint_row(const dmb_scene *scene, const dmb_constraint *constraint, uint32_t j,
                       const dmb_relative *relative, double factor, const double J[6], double *row);

/* ---- Edges ------------------------------------------------------------------------------------------------------- */

/* Poses in which a joint has no coordinates or no equations.
 *
 * RX and RY turn about axes that fall together where RZ is a right angle: with n = R^T e_y, the y axis of a in the axes
 * of b, s = cos RZ = |(n_y, n_z)| is 0 there, and their gradients grow as 1/s. Beyond it both jump by half a turn.
 * Springs, drives and couplings would jump with them, and a universal joint would tell other angles than it stands at.
 * A rim that rolls has no lowest point where it lies flat: its equations of speed are rows of zeros there. */

/* Refuses active joints whose trial stands where their angles or equations are not defined: a universal joint, or one
 * with springs, drives or couplings on its angles, at a right angle of RZ; a rim that lies flat. moving: the way from
 * now counts too. DMB_ERR_GEOMETRY with a message. */
int32_t dmb_joints_refuse_edges(dmb_sim *sim, int moving, double time);
/* Refuses active universal joints with something on their angles whose trial stands beyond the right angle that `now`
 * is before: on the way of a search for equilibrium, however long, they would have passed it. DMB_ERR_GEOMETRY with a
 * message. */
int32_t dmb_joints_refuse_folds(dmb_sim *sim);
/* [-] smallest cos RZ of the joints of the trial with something on their angles, and which one it is; 1, DMB_NONE: of
 * none.
 */
double dmb_joints_nearest_edge(const dmb_sim *sim, uint32_t *joint);

/* ---- Memory from step to step ------------------------------------------------------------------------------------ */

/* Turns of the coordinates of the trial; in statics after every move. */
void dmb_joints_follow(dmb_evaluation *evaluation);
/* After the last evaluation of a state: multipliers of least norm where rows are redundant (iterations need only some
 * that balance: B^T f is the same), power of the callers' constraints. */
void dmb_joint_reactions(dmb_evaluation *evaluation);
/* End of an accepted step: turns of the coordinates, multipliers of least norm, partition where it has become poor. */
void dmb_joints_accept(dmb_evaluation *evaluation);
/* Turns of the trial by the coordinates of joint j. */
void dmb_joint_take_turns(dmb_sim *sim, uint32_t j, const dmb_joint_coordinates *c);
/* The pose in which joint j would hold frame b if it were locked in the pose of now. */
void dmb_joint_hold(dmb_sim *sim, uint32_t j);
/* The state of joint j from now on, DMB_JOINT_...; where that is LOCKED it holds frame b as it is in the pose of now.
 */
void dmb_joint_take_state(dmb_sim *sim, uint32_t j, int32_t state);
/* [J] in springs and stops of the joints. */
double dmb_joint_energy(const dmb_sim *sim, const dmb_configuration *configuration);

#endif
