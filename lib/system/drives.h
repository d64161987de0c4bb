/* Forces and speeds of drives, whatever they act on. */
#ifndef DMB_SYSTEM_DRIVES_H
#define DMB_SYSTEM_DRIVES_H

#include "system/evaluation.h"

/* Force of a LOAD or CONTROL drive at a speed of its component, into trial.drive_force too; *slope: by that speed. */
double dmb_drive_force(dmb_evaluation *evaluation, uint32_t drive, double speed, double *slope);
/* [m/s, rad/s] of the driven component or coordinate in a configuration. */
double dmb_drive_speed(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t drive);

#endif
