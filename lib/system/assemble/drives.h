/* Forces and speeds of drives, whatever they act on. */
#ifndef DMB_SYSTEM_ASSEMBLE_DRIVES_H
#define DMB_SYSTEM_ASSEMBLE_DRIVES_H

#include "system/assemble/evaluation.h"

/* Force of a LOAD or CONTROL drive at a speed of its component, into trial.drive_force too; *slope: by that speed. */
double dmb_drive_force(dmb_evaluation *evaluation, uint32_t drive, double speed, double *slope);
/* [m/s, rad/s] of the driven component or coordinate in a configuration. */
double dmb_drive_speed(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t drive);

/* Targets of all drives at evaluation->time, loads' factors, and the motion of prescribed rows over the step:
 * increment, velocity and acceleration of the trial. Once a step, before the first evaluation. DMB_ERR_CALLBACK. */
int32_t dmb_system_prescribe(dmb_evaluation *evaluation);
/* 1 if after the corner reached the programme of a motion drive goes on with another slope than the step before ended
 * with. */
int32_t dmb_system_rate_jumps(const dmb_sim *sim);
void dmb_gather_drives(dmb_evaluation *evaluation);

#endif
