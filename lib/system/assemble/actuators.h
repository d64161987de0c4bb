/* Actuators of drives: force of a command after delay, rate limit, lag and torque-speed curve (force/actuator_law.h),
 * and their memory. */
#ifndef DMB_SYSTEM_ASSEMBLE_ACTUATORS_H
#define DMB_SYSTEM_ASSEMBLE_ACTUATORS_H

#include "system/assemble/evaluation.h"

/* Flow through actuator i in a configuration. */
static inline dmb_actuator_flow *dmb_actuator_flow_of(const dmb_configuration *configuration, uint32_t i)
{
    return (dmb_actuator_flow *)(void *)(configuration->actuator + 4 * (size_t)i);
}

/* Force on the part of a drive with an actuator, for its command at a speed; *slope, the derivative of the command by
 * the speed, becomes that of the force. Also stored in the flow of the trial. In statics, and before there is a state,
 * the force equals its steady value. */
double dmb_actuator_force(const dmb_evaluation *evaluation, uint32_t drive, double command, double speed,
                          double *slope);
/* The drive is idle in the trial: its actuator keeps its state, and without a state its past commands are 0. */
void dmb_actuator_idle(dmb_sim *sim, uint32_t drive);

/* At the start: clears the states of all actuators; then fills delay lines as if the present command had always been
 * given. */
void dmb_actuators_clear(dmb_sim *sim);
void dmb_actuators_settle(dmb_sim *sim);
/* End of an accepted step, or of a static analysis, whose flow also becomes that of now. */
void dmb_actuators_accept(const dmb_evaluation *evaluation);
/* Copies the flow of the trial into now. */
void dmb_actuators_copy_flow(dmb_sim *sim);

/* 1: some delayed commands may jump. */
int32_t dmb_actuators_may_jump(const dmb_scene *scene);
/* 1: a delayed command jumps at the present time. */
int32_t dmb_actuators_jump(const dmb_sim *sim);
/* [s] The first breakpoint of a delayed command later than t; INFINITY: none. */
double dmb_actuators_next_breakpoint(const dmb_sim *sim, double t);

/* Linear analyses contain motion and integrals of controllers, but no states of actuators. DMB_ERR_UNSUPPORTED with a
 * message if a controller has an actuator that is not direct; with `driven`, if any drive has one, because forces of
 * drives are outputs or excitations. */
int32_t dmb_actuators_check_linear(const dmb_sim *sim, const char *analysis, int driven, dmb_message *message);

/* 1: the force equals the command without delay, lag or limit of its rate, so that its linearisation is complete. */
static inline int dmb_actuator_is_direct(const dmb_scene *scene, uint32_t drive)
{
    const uint32_t i = scene->drives[drive].actuator;
    if (i == DMB_NONE) return 1;
    const dmb_actuator_law *law = scene->actuators + i;
    return !(law->delay > 0.0 || law->rate_limit > 0.0 || law->lag > 0.0);
}

#endif
