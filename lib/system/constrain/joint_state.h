/* Memory of joints from step to step. */
#ifndef DMB_SYSTEM_CONSTRAIN_JOINT_STATE_H
#define DMB_SYSTEM_CONSTRAIN_JOINT_STATE_H

#include "constraint/joint.h"
#include "system/assemble/evaluation.h"

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
