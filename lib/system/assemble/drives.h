/* Forces and speeds of drives of nodes and joints. */
#ifndef DMB_SYSTEM_ASSEMBLE_DRIVES_H
#define DMB_SYSTEM_ASSEMBLE_DRIVES_H

#include "system/assemble/evaluation.h"

/* Force of a LOAD or CONTROL drive at a speed of its component, also stored in trial.drives[].force; *slope: its
 * derivative by that speed. */
double dmb_drive_force(dmb_evaluation *evaluation, uint32_t drive, double speed, double *slope);
/* [m/s, rad/s] of the driven component or coordinate in a configuration. */
double dmb_drive_speed(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t drive);

/* [N s/m, N m s] Derivative of the force of a CONTROL drive by its error in a configuration, without integral and
 * limits; of a table the slope of the segment that ends at the error or continues beyond it. *room: decrease of the
 * error until that segment ends; INFINITY without a table. */
double dmb_drive_gain(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t drive, double *room);

/* Targets of all drives at evaluation->time, factors of loads, and motion of prescribed rows over the step: increment,
 * velocity and acceleration of the trial. Once per step, before the first evaluation. DMB_ERR_CALLBACK. */
int32_t dmb_system_prescribe(dmb_evaluation *evaluation);
/* 1 if the time function of a motion drive continues after `time` [s] (or the breakpoint `breakpoint` [s] if that is
 * later) with another slope than at the end of the trial. DMB_ERR_CALLBACK with a message. */
int32_t dmb_system_rate_jumps(dmb_sim *sim, double time, double breakpoint);
void dmb_assemble_drives(dmb_evaluation *evaluation);

/* All fields of drives are written here and by the calls below; their meaning: sim/sim.h. */

/* Updates a drive of a joint from its coordinate and speed in the trial; `open`: the joint is open, and the drive has
 * no force and tracks the coordinate. */
void dmb_drive_on_joint(dmb_sim *sim, uint32_t drive, double value, double speed, int open);
/* Positions and speeds at the end of an accepted step. */
void dmb_drives_accept(const dmb_evaluation *evaluation);
/* Forces of motion drives, from the multipliers of the trial or, for drives of nodes, from the residual, into a
 * configuration. */
void dmb_drives_read_reactions(dmb_sim *sim, dmb_configuration *to);
/* Copies of the trial into now: targets; motion of joint coordinates; targets, forces, and speeds and rates of joints.
 */
void dmb_drives_copy_targets(dmb_sim *sim);
void dmb_drives_copy_motion(dmb_sim *sim);
void dmb_drives_copy_forces(dmb_sim *sim);

#endif
