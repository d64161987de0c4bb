#include "cycle.h"

#include <math.h>

#define RADIANS_PER_SECOND(rpm) ((rpm)*3.14159265358979323846 / 30.0)

rig_cycle rig_cycle_full(void)
{
    const rig_cycle cycle = {{0.0, 1.0, 19.0, 20.0, 21.0, 22.0, 40.0}};
    return cycle;
}

/* The same ramps, with 2 s of drilling and of pulling out. */
rig_cycle rig_cycle_quick(void)
{
    const rig_cycle cycle = {{0.0, 1.0, 3.0, 4.0, 5.0, 6.0, 8.0}};
    return cycle;
}

const char *rig_stage_name(int stage)
{
    static const char *const names[RIG_STAGES] = {"start", "drill", "stop", "rest", "reverse start", "pull out"};
    return stage >= 0 && stage < RIG_STAGES ? names[stage] : "";
}

/* ---- Time functions
 * --------------------------------------------------------------------------------------------------- Rotation and feed
 * go up in stage 0, down in stage 2, and the other way in stage 4. */

/* A rise by `height` in the course of one stage: height STEP(t, begin, 0, end, 1). */
static dmb_segment rise(const rig_cycle *cycle, int stage, double height)
{
    dmb_segment term = dmb_segment_default();
    term.kind = DMB_SEGMENT_STEP;
    term.x0 = cycle->time[stage];
    term.x1 = cycle->time[stage + 1];
    term.h1 = height;
    return term;
}

static int32_t add_there_and_back(dmb_model *model, const rig_cycle *cycle, double speed, dmb_id *time_function)
{
    const dmb_segment terms[3] = {rise(cycle, 0, speed), rise(cycle, 2, -speed), rise(cycle, 4, -speed)};
    return dmb_model_add_time_function(model, terms, 3, time_function);
}

int32_t rig_add_rotation(dmb_model *model, const rig_cycle *cycle, dmb_id *time_function)
{
    return add_there_and_back(model, cycle, RADIANS_PER_SECOND(RIG_ROTATION_RPM), time_function);
}

int32_t rig_add_feed(dmb_model *model, const rig_cycle *cycle, dmb_id *time_function)
{
    return add_there_and_back(model, cycle, RIG_FEED, time_function);
}

/* The rock pushes while the bit drills, and not any more when it is pulled out. */
int32_t rig_add_bottom_load(dmb_model *model, const rig_cycle *cycle, dmb_id *time_function)
{
    const dmb_segment terms[2] = {rise(cycle, 0, RIG_BOTTOM_LOAD), rise(cycle, 2, -RIG_BOTTOM_LOAD)};
    return dmb_model_add_time_function(model, terms, 2, time_function);
}

/* ---- Excitation ---------------------------------------------------------------------------------------------------
 * A worn gear in the head makes the speed swing once a revolution: with theta the angle turned so far and w its rate,
 *     speed added  s w sin(theta),   its rate  s (w' sin(theta) + w^2 cos(theta)),   its integral  s (1 - cos(theta)).
 * It rests when the head rests. No sum of library terms says this, so it is a callback. */

typedef struct ramp {
    double rate, value, integral;
} ramp;

/* STEP(t, begin, 0, end, 1) with its rate and its integral from the beginning. */
static ramp ramp_at(double t, double begin, double end)
{
    const double length = end - begin, x = (t - begin) / length;
    ramp r = {0.0, 0.0, 0.0};
    if (x <= 0.0) return r;
    if (x < 1.0) {
        r.rate = 6.0 * x * (1.0 - x) / length;
        r.value = x * x * (3.0 - 2.0 * x);
        r.integral = length * x * x * x * (1.0 - 0.5 * x);
        return r;
    }
    r.value = 1.0;
    r.integral = 0.5 * length + (t - end);
    return r;
}

static int32_t shake(void *context, double time, double out[3])
{
    const rig_cycle *cycle = context;
    const double speed = RADIANS_PER_SECOND(RIG_ROTATION_RPM);
    double w = 0.0, w_rate = 0.0, theta = 0.0;
    for (int stage = 0; stage < 6; stage += 2) {
        const ramp r = ramp_at(time, cycle->time[stage], cycle->time[stage + 1]);
        const double height = stage == 0 ? speed : -speed;
        w += height * r.value;
        w_rate += height * r.rate;
        theta += height * r.integral;
    }
    out[0] = RIG_SHAKE * w * sin(theta);
    out[1] = RIG_SHAKE * (w_rate * sin(theta) + w * w * cos(theta));
    out[2] = RIG_SHAKE * (1.0 - cos(theta));
    return 0;
}

int32_t rig_add_shake(dmb_model *model, rig_cycle *cycle, dmb_id *time_function)
{
    dmb_segment term = dmb_segment_default();
    term.kind = DMB_SEGMENT_CALLBACK;
    term.callback = shake;
    term.callback_context = cycle;
    term.provides = DMB_PROVIDES_RATE | DMB_PROVIDES_INTEGRAL;
    return dmb_model_add_time_function(model, &term, 1, time_function);
}
