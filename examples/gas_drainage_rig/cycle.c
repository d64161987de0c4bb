#include "cycle.h"

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
 * It rests when the head rests. */

int32_t rig_add_shake(dmb_model *model, dmb_id rotation, dmb_id *time_function)
{
    dmb_segment term = dmb_segment_default();
    term.kind = DMB_SEGMENT_PER_REVOLUTION;
    term.of = rotation;
    term.share = RIG_SHAKE;
    return dmb_model_add_time_function(model, &term, 1, time_function);
}
