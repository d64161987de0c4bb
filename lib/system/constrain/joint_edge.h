/* Poses in which a joint has no coordinates or no equations.
 *
 * RX and RY turn about axes that fall together where RZ is a right angle: with n = R^T e_y, the y axis of a in the axes
 * of b, s = cos RZ = |(n_y, n_z)| is 0 there, and their gradients grow as 1/s. Beyond it both jump by half a turn.
 * Springs, drives and couplings would jump with them, and a universal joint would tell other angles than it stands at.
 * A rim that rolls has no lowest point where it lies flat: its equations of speed are rows of zeros there. */
#ifndef DMB_SYSTEM_CONSTRAIN_JOINT_EDGE_H
#define DMB_SYSTEM_CONSTRAIN_JOINT_EDGE_H

#include "system/constrain/joint_state.h"

/* Refuses active joints whose trial stands where their angles or equations are not defined: a universal joint, or one
 * with springs, drives or couplings on its angles, at a right angle of RZ; a rim that lies flat. moving: the way from
 * now counts too. DMB_ERR_GEOMETRY with a message. system/constrain/joint_edge */
int32_t dmb_joints_refuse_edges(dmb_sim *sim, int moving, double time);
/* Refuses active universal joints with something on their angles whose trial stands beyond the right angle that `now`
 * is before: on the way of a search for equilibrium, however long, they would have passed it. DMB_ERR_GEOMETRY with a
 * message. */
int32_t dmb_joints_refuse_folds(dmb_sim *sim);
/* [-] smallest cos RZ of the joints of the trial with something on their angles, and which one it is; 1, DMB_NONE: of
 * none.
 */
double dmb_joints_nearest_edge(const dmb_sim *sim, uint32_t *joint);

#endif
