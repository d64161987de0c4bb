/* Inputs that the caller sets between steps: a constant in the place of a drive's programme, the state of a joint. */
#include <math.h>

#include "model/limits.h"
#include "sim/access.h"
#include "sim/node.h"
#include "system/constrain/joint_motion.h"
#include "system/jump.h"
#include "system/start.h"

static int32_t refuse(dmb_sim *sim, int32_t status, const char *why)
{
    dmb_message_set(&sim->message, "%s", why);
    return status;
}

/* The force of the drive jumps: without accelerations that fit it, the steps after would be of first order only. */
static int32_t jump_to(dmb_sim *sim, uint32_t index, double value)
{
    const double before = sim->drive_input[index];
    if (before == value || (isnan(before) && isnan(value))) return DMB_OK;
    sim->drive_input[index] = value;
    const int32_t status = dmb_system_jump(sim);
    if (status < 0) sim->drive_input[index] = before;
    return status;
}

/* The input whose set point is this drive's: one of them moves it. */
static int32_t refuse_input(dmb_sim *sim, uint32_t drive)
{
    dmb_message name;
    for (uint32_t i = 0; i < sim->scene->input_count; i++) {
        const dmb_scene_input *input = sim->scene->inputs + i;
        if (input->target != DMB_TARGET_SET_POINT || input->index != drive) continue;
        dmb_message_set(&sim->message, "%s: its set point is input %u (%s), set that by dmb_sim_set_input",
                        dmb_drive_text(sim->scene, drive, &name), i, input->name);
        return DMB_ERR_UNSUPPORTED;
    }
    return DMB_OK;
}

static int32_t set_drive(dmb_sim *sim, dmb_id drive, double value)
{
    const uint32_t index = dmb_model_part_index(sim->model, drive, DMB_PART_DRIVE);
    dmb_message name;
    if (index >= sim->scene->drive_count) return refuse(sim, DMB_ERR_ID, "drive: the id names no drive of this model");
    if (sim->scene->drives[index].kind == DMB_DRIVE_MOTION) {
        dmb_message_set(
            &sim->message,
            "%s: its kind is DMB_DRIVE_MOTION, whose speed may not jump; describe an input of its set point",
            dmb_drive_text(sim->scene, index, &name));
        return DMB_ERR_UNSUPPORTED;
    }
    if (refuse_input(sim, index) < 0) return DMB_ERR_UNSUPPORTED;
    if (isinf(value)) {
        dmb_message_field(&sim->message, dmb_drive_text(sim->scene, index, &name), DMB_NONE, "value", value,
                          "finite, or NaN for the programme");
        return DMB_ERR_NOT_FINITE;
    }
    if (fabs(value) > DMB_FORCE_MAX) { /* as what is described: beyond it work and power overflow */
        dmb_message_field(&sim->message, dmb_drive_text(sim->scene, index, &name), DMB_NONE, "value", value,
                          "from -1e30 to 1e30, or NaN for the programme");
        return DMB_ERR_VALUE;
    }
    return jump_to(sim, index, isnan(value) ? (double)NAN : value); /* one NaN, so that equal states hash alike */
}

int32_t dmb_sim_set_drive(dmb_sim *sim, dmb_id drive, double value)
{
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_CHANGING);
    return status < 0 ? status : dmb_sim_leave(sim, set_drive(sim, drive, value));
}

/* The caller's hand on a joint. */

static int32_t set_joint(dmb_sim *sim, dmb_id joint, int32_t state)
{
    const uint32_t j = dmb_model_part_index(sim->model, joint, DMB_PART_JOINT);
    if (j >= sim->scene->joint_count) {
        dmb_message_set(&sim->message, "joint: the id names no joint of this model");
        return DMB_ERR_ID;
    }
    if (state < DMB_JOINT_ACTIVE || state > DMB_JOINT_OPEN) {
        dmb_message_field(&sim->message, "joint", j, "state", state, "from 0 to 2");
        return DMB_ERR_VALUE;
    }
    return dmb_joint_switch(sim, j, state);
}

int32_t dmb_sim_set_joint(dmb_sim *sim, dmb_id joint, int32_t state)
{
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_CHANGING);
    return status < 0 ? status : dmb_sim_leave(sim, set_joint(sim, joint, state));
}
