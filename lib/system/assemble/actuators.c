/* Actuators: command, delay, limit of the rate, lag, torque-speed curve, less the drag (force/actuator_law.h). Memory:
 * the flow through each actuator, and the line of samples of a delay. */
#include "system/assemble/actuators.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "sim/node.h"

static const dmb_actuator_law *law_of(const dmb_sim *sim, uint32_t drive)
{
    return sim->scene->actuators + sim->scene->drives[drive].actuator;
}

static dmb_delay_line line_of(const dmb_sim *sim, const dmb_actuator_law *law)
{
    double *line = sim->delay_line + 2 * (size_t)DMB_DELAY_SAMPLES * law->line;
    const dmb_delay_line found = {line, line + DMB_DELAY_SAMPLES};
    return found;
}

#define DMB_TIME_ROUNDING (8.0 * DBL_EPSILON) /* [-] relative difference of times that counts as rounding */

/* ---- A step ------------------------------------------------------------------------------------------------------ */

/* Writes the delayed command at the end of the step into flow, and that at its start to *u0; returns d delayed/d
 * command. In a step longer than the delay the command is interpolated linearly between start and end. Commands are
 * known at the ends of steps. A delayed command that was given before the step is read from the line; one that was
 * given within it depends on the command of this step, which is the only case in which its derivative is not 0.
 *
 *     time    -----+-------------------+------------------>
 *                begin                end
 *                  |<-- delay -->|            part = (end - delay - begin)/h > 0: interpolated */
static double delay(const dmb_evaluation *evaluation, const dmb_actuator_law *law, const dmb_actuator_flow *from,
                    dmb_actuator_flow *flow, double *u0)
{
    const dmb_sim *sim = evaluation->sim;
    *u0 = from->command;
    flow->delayed = flow->command;
    if (!(law->delay > 0.0)) return 1.0;
    const dmb_delay_line line = line_of(sim, law);
    const double begin = sim->clock->time, h = evaluation->step;
    *u0 = dmb_delay_after(&line, begin - law->delay);
    flow->delayed = h > 0.0 ? dmb_delay_before(&line, evaluation->time - law->delay) : *u0;
    const double beyond = evaluation->time - law->delay - begin; /* s, more than rounding */
    if (!(h > 0.0 && beyond > DMB_TIME_ROUNDING * fabs(evaluation->time))) return 0.0;
    const double part = beyond / h;
    flow->delayed = from->command + part * (flow->command - from->command);
    return part;
}

/* Order along the signal: command, delay, rate limit and lag, torque-speed curve and limits, drag (eq:drive.actuator,
 * eq:drive.lag). The slope is multiplied along the same way. Without a state (statics, or before the first one) the
 * flow takes the steady value, the command itself. */
double dmb_actuator_force(const dmb_evaluation *evaluation, uint32_t drive, double command, double speed, double *slope)
{
    const dmb_sim *sim = evaluation->sim;
    const dmb_actuator_law *law = law_of(sim, drive);
    const dmb_actuator_flow *from = dmb_actuator_flow_of(&sim->now, sim->scene->drives[drive].actuator);
    dmb_actuator_flow *flow = dmb_actuator_flow_of(&sim->trial, sim->scene->drives[drive].actuator);
    const double drag = law->drag[speed < 0.0];
    double u0;
    flow->command = command;
    if (!evaluation->dynamic || isnan(from->force)) {
        flow->delayed = flow->limited = flow->force = command;
    } else {
        *slope *= delay(evaluation, law, from, flow, &u0);
        *slope *= dmb_actuator_follow(law, evaluation->step, u0, from, flow);
    }
    const double force = dmb_actuator_within(law, flow->force, speed, slope);
    *slope -= drag;
    return force - drag * speed;
}

void dmb_actuator_idle(dmb_sim *sim, uint32_t drive)
{
    const uint32_t i = sim->scene->drives[drive].actuator;
    const dmb_actuator_flow nothing = {0.0, 0.0, 0.0, 0.0};
    if (i == DMB_NONE) return;
    const dmb_actuator_flow *from = dmb_actuator_flow_of(&sim->now, i);
    *dmb_actuator_flow_of(&sim->trial, i) = isnan(from->force) ? nothing : *from;
}

/* ---- State ------------------------------------------------------------------------------------------------------- */

void dmb_actuators_clear(dmb_sim *sim)
{
    const dmb_actuator_flow none = {(double)NAN, (double)NAN, (double)NAN, (double)NAN};
    for (uint32_t i = 0; i < sim->scene->actuator_count; i++) *dmb_actuator_flow_of(&sim->now, i) = none;
}

void dmb_actuators_settle(dmb_sim *sim)
{
    for (uint32_t i = 0; i < sim->scene->actuator_count; i++) {
        const dmb_actuator_law *law = sim->scene->actuators + i;
        const dmb_delay_line line = line_of(sim, law);
        if (law->delay > 0.0) dmb_delay_fill(&line, sim->clock->time, dmb_actuator_flow_of(&sim->now, i)->command);
    }
}

void dmb_actuators_copy_flow(dmb_sim *sim)
{
    const uint32_t count = sim->scene->actuator_count;
    if (count > 0) memcpy(sim->now.actuator, sim->trial.actuator, count * sizeof(dmb_actuator_flow));
}

/* Statics have no past: the line is filled with the present command, as if it had always been given. */
void dmb_actuators_accept(const dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    if (!evaluation->dynamic) {
        dmb_actuators_copy_flow(sim);
        dmb_actuators_settle(sim);
        return;
    }
    for (uint32_t i = 0; i < sim->scene->actuator_count; i++) {
        const dmb_actuator_law *law = sim->scene->actuators + i;
        const dmb_delay_line line = line_of(sim, law);
        if (!(law->delay > 0.0)) continue;
        dmb_delay_push(&line, law->delay, sim->clock->time, dmb_actuator_flow_of(&sim->now, i)->command,
                       evaluation->time, dmb_actuator_flow_of(&sim->trial, i)->command);
    }
}

/* ---- Breakpoints ------------------------------------------------------------------------------------------------- */

#define DMB_JUMP_ROUNDING 1e-12 /* [-] relative jump of a command that counts as rounding */

/* 1: the command is delayed without lag or rate limit, so that its jumps pass. */
static int passes_jumps(const dmb_actuator_law *law)
{
    return law->delay > 0.0 && !(law->rate_limit > 0.0) && !(law->lag > 0.0);
}

int32_t dmb_actuators_may_jump(const dmb_scene *scene)
{
    for (uint32_t i = 0; i < scene->actuator_count; i++)
        if (passes_jumps(scene->actuators + i)) return 1;
    return 0;
}

/* A lag or a rate limit makes a delayed jump continuous; without them accelerations have to be computed again. */
int32_t dmb_actuators_jump(const dmb_sim *sim)
{
    for (uint32_t i = 0; i < sim->scene->actuator_count; i++) {
        const dmb_actuator_law *law = sim->scene->actuators + i;
        if (!passes_jumps(law)) continue;
        const dmb_delay_line line = line_of(sim, law);
        const double time = sim->clock->time - law->delay;
        const double before = dmb_delay_before(&line, time), after = dmb_delay_after(&line, time);
        if (fabs(after - before) > DMB_JUMP_ROUNDING * (fabs(after) + fabs(before))) return 1;
    }
    return 0;
}

/* [s] The first breakpoint of a time function that is later than t when delayed. */
static double time_function_breakpoint(const dmb_scene *scene, uint32_t time_function, double delay, double t)
{
    double breakpoint = t - delay;
    if (time_function == DMB_NONE) return (double)INFINITY;
    for (int i = 0; i < 3; i++) { /* t - delay may be rounded to before a breakpoint already reached */
        breakpoint = dmb_time_function_next_breakpoint(scene->time_functions + time_function, breakpoint);
        if (breakpoint + delay > t) return breakpoint + delay;
    }
    return (double)INFINITY;
}

/* [s] First jump in a delay line later than t. A command set at the present time is in the line only at the end of the
 * step. */
static double jump_breakpoint(const dmb_sim *sim, uint32_t i, const dmb_delay_line *line, double t)
{
    const double delay = sim->scene->actuators[i].delay, now = sim->clock->time;
    const int set_now = line->value[DMB_DELAY_SAMPLES - 1] != dmb_actuator_flow_of(&sim->now, i)->command;
    double breakpoint = dmb_delay_next_jump(line, t - delay);
    for (int k = 0; k < 2 && !(breakpoint + delay > t); k++) breakpoint = dmb_delay_next_jump(line, breakpoint);
    if (set_now && now + delay > t) breakpoint = fmin(breakpoint, now);
    return breakpoint + delay > t ? breakpoint + delay : (double)INFINITY;
}

double dmb_actuators_next_breakpoint(const dmb_sim *sim, double t)
{
    const dmb_scene *scene = sim->scene;
    double next = (double)INFINITY;
    for (uint32_t i = 0; i < scene->drive_count && scene->actuator_count > 0; i++) {
        const dmb_scene_drive *drive = scene->drives + i;
        if (drive->actuator == DMB_NONE || !(law_of(sim, i)->delay > 0.0)) continue;
        const double delay = law_of(sim, i)->delay;
        const dmb_delay_line line = line_of(sim, law_of(sim, i));
        next = fmin(next, jump_breakpoint(sim, drive->actuator, &line, t));
        next = fmin(next, time_function_breakpoint(scene, drive->time_function, delay, t));
        next = fmin(next, time_function_breakpoint(scene, drive->excitation, delay, t));
    }
    return next;
}

/* ---- Refused with actuators -------------------------------------------------------------------------------------- */

int32_t dmb_actuators_check_linear(const dmb_sim *sim, const char *analysis, int driven, dmb_message *message)
{
    const dmb_scene *scene = sim->scene;
    dmb_message name;
    for (uint32_t i = 0; i < scene->drive_count && scene->actuator_count > 0; i++) {
        const dmb_scene_drive *drive = scene->drives + i;
        if (drive->actuator == DMB_NONE) continue;
        if (!driven && (drive->kind != DMB_DRIVE_CONTROL || dmb_actuator_is_direct(scene, i))) continue;
        dmb_message_set(message,
                        "%s: %s has an actuator (%s), must have none there; leave it out for this analysis, or "
                        "run in time instead",
                        analysis, dmb_drive_text(scene, i, &name),
                        dmb_actuator_is_direct(scene, i) ? "curve or drag" : "delay, force_rate or lag");
        return DMB_ERR_UNSUPPORTED;
    }
    return DMB_OK;
}
