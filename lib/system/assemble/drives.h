/* Forces and speeds of drives, whatever they act on. */
#ifndef DMB_SYSTEM_ASSEMBLE_DRIVES_H
#define DMB_SYSTEM_ASSEMBLE_DRIVES_H

#include "system/assemble/evaluation.h"

/* Force of a LOAD or CONTROL drive at a speed of its component, into trial.drive_force too; *slope: by that speed. */
double dmb_drive_force(dmb_evaluation *evaluation, uint32_t drive, double speed, double *slope);
/* [m/s, rad/s] of the driven component or coordinate in a configuration. */
double dmb_drive_speed(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t drive);

/* [N s/m, N m s] By which the force of a CONTROL drive grows with its error in a configuration, but for its integral
 * and limits; of a table that of the piece that ends at the error or goes on beyond it. *room: by which the error may
 * fall on that piece; INFINITY without a table. */
double dmb_drive_gain(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t drive, double *room);

/* Targets of all drives at evaluation->time, loads' factors, and the motion of prescribed rows over the step:
 * increment, velocity and acceleration of the trial. Once a step, before the first evaluation. DMB_ERR_CALLBACK. */
int32_t dmb_system_prescribe(dmb_evaluation *evaluation);
/* 1 if after `time` [s], or after the breakpoint `breakpoint` [s] where that is later, the time function of a motion
 * drive goes on with another slope than the trial ends with. DMB_ERR_CALLBACK with a message. */
int32_t dmb_system_rate_jumps(dmb_sim *sim, double time, double breakpoint);
void dmb_assemble_drives(dmb_evaluation *evaluation);

/* All fields of drives are written here and by the calls below; what they mean: sim/sim.h. */

/* Drive of a joint whose coordinate has this value and speed in the trial; `open`: the joint is, the drive does
 * nothing and follows the coordinate. */
void dmb_drive_on_joint(dmb_sim *sim, uint32_t drive, double value, double speed, int open);
/* Positions and speeds at the end of an accepted step. */
void dmb_drives_accept(const dmb_evaluation *evaluation);
/* Forces of the motion drives, from the multipliers of the trial and, of those that hold a row, from the residual, into
 * a configuration. */
void dmb_drives_take_reactions(dmb_sim *sim, dmb_configuration *to);
/* Of trial, into now: targets; motion of joints' coordinates; targets, forces, and speeds and rates of joints. */
void dmb_drives_take_targets(dmb_sim *sim);
void dmb_drives_take_motion(dmb_sim *sim);
void dmb_drives_take_forces(dmb_sim *sim);

#endif
