/* Actuators of drives: the force that a command becomes on its way (force/actuator_law.h), and what they remember. */
#ifndef DMB_SYSTEM_ASSEMBLE_ACTUATORS_H
#define DMB_SYSTEM_ASSEMBLE_ACTUATORS_H

#include "system/assemble/evaluation.h"

/* Flow through actuator i in a configuration. */
static inline dmb_actuator_flow *dmb_actuator_flow_of(const dmb_configuration *configuration, uint32_t i)
{
    return (dmb_actuator_flow *)(void *)(configuration->actuator + 4 * (size_t)i);
}

/* Force on the part of a drive with an actuator for its command at a speed; *slope, of the command by the speed,
 * becomes that of the force. Into the flow of the trial too. In statics, and before there is a state, the force has
 * come to its command. */
double dmb_actuator_force(const dmb_evaluation *evaluation, uint32_t drive, double command, double speed,
                          double *slope);
/* The drive does nothing in the trial: its actuator stays as it is, and where it has no state yet nothing was
 * commanded. */
void dmb_actuator_idle(dmb_sim *sim, uint32_t drive);

/* At the start all actuators have no state yet; then delay lines as if the present command had always been given. */
void dmb_actuators_clear(dmb_sim *sim);
void dmb_actuators_settle(dmb_sim *sim);
/* The end of an accepted step, or of a static search, whose flow becomes that of now too. */
void dmb_actuators_accept(const dmb_evaluation *evaluation);
/* Of the trial, into now. */
void dmb_actuators_take(dmb_sim *sim);

/* 1: there are delayed commands that may jump. */
int32_t dmb_actuators_may_jump(const dmb_scene *scene);
/* 1: a delayed command jumps at the present time. */
int32_t dmb_actuators_jump(const dmb_sim *sim);
/* [s] The first breakpoint of a delayed command later than t; INFINITY: none. */
double dmb_actuators_next_breakpoint(const dmb_sim *sim, double t);

/* Linear analyses know motion and integrals of controllers; what an actuator does with a command beside them is in time
 * only. DMB_ERR_UNSUPPORTED with a message where a controller has one that is not direct; `driven`: where any drive has
 * one at all, since forces of drives are asked for or excited. */
int32_t dmb_actuators_check_linear(const dmb_sim *sim, const char *analysis, int driven, dmb_message *message);

/* The drive answers to its command at once, so that a linearisation tells all of it. */
static inline int dmb_actuator_is_direct(const dmb_scene *scene, uint32_t drive)
{
    const uint32_t i = scene->drives[drive].actuator;
    if (i == DMB_NONE) return 1;
    const dmb_actuator_law *law = scene->actuators + i;
    return !(law->delay > 0.0 || law->rate_limit > 0.0 || law->lag > 0.0);
}

#endif
