/* What joints remember from step to step, how a scene with joints is put together, and how joints change in a run. */
#ifndef DMB_SYSTEM_JOINT_STATE_H
#define DMB_SYSTEM_JOINT_STATE_H

#include "system/evaluation.h"

/* Turns of the coordinates of the trial; in statics after every move. */
void dmb_joints_follow(dmb_evaluation *evaluation);
/* After the last evaluation of a state: multipliers of least norm where rows are redundant (iterations need only some
 * that balance: B^T f is the same), forces of the motion drives of joints, power of the callers' constraints. */
void dmb_joint_reactions(dmb_evaluation *evaluation);
/* End of an accepted step: turns of the coordinates, multipliers of least norm, partition where it has become poor. */
void dmb_joints_accept(dmb_evaluation *evaluation);
/* Joint j is locked from now on, or no longer: where it holds frame b, in the pose of now. */
void dmb_joint_hold(dmb_sim *sim, uint32_t j);
void dmb_joint_release(dmb_sim *sim, uint32_t j);
/* [J] in springs and stops of the joints. */
double dmb_joint_energy(const dmb_sim *sim, const dmb_configuration *configuration);

/* Closes the joints from the described poses of now: poses move until every equation holds and joints stand where their
 * initial coordinates say, speeds likewise. Fills counters->assembly. Errors with a message: DMB_ERR_GEOMETRY (the joint
 * that does not fit, and by how much), DMB_ERR_CALLBACK. system/assembly */
int32_t dmb_assemble(dmb_sim *sim);

/* Refuses a joint whose frames, in the trial, point against each other where it keeps them parallel: its equations hold
 * there too. DMB_ERR_GEOMETRY with a message. */
int32_t dmb_joint_refuse_flip(dmb_sim *sim, uint32_t joint);

/* Refuses active joints whose trial stands where their angles or equations are not defined: a universal joint, or one
 * with springs, drives or couplings on its angles, at a right angle of RZ; a rim that lies flat. moving: the way from now
 * counts too. DMB_ERR_GEOMETRY with a message. system/joint_edge */
int32_t dmb_joints_refuse_edges(dmb_sim *sim, int moving, double time);

/* Largest changes of the speeds from now to trial into counters->projection. */
void dmb_note_projection(dmb_sim *sim);
/* Refuses speeds of the trial that do not satisfy an equation, one that was dropped included: DMB_ERR_GEOMETRY. */
int32_t dmb_assembled_speeds(dmb_evaluation *evaluation);

/* dmb_sim_set_joint for a joint that exists. system/joint_switch */
int32_t dmb_joint_switch(dmb_sim *sim, uint32_t joint, int32_t state);

#endif
