/* Strings without their pipes. */
#include "model/defaults.h"
#include "model/describe.h"
#include "model/field_check.h"
#include "model/limits.h"
#include "model/motion_mask.h"

static int32_t check_string(dmb_model *model, const dmb_string_def *def)
{
    dmb_check check = dmb_check_of(&model->message, "string", model->strings.count);
    dmb_check_choice(&check, "follows_hole", def->follows_hole, 0, 1);
    dmb_check_within(&check, "start_depth", def->start_depth, -DMB_POSITION_MAX, DMB_POSITION_MAX);
    dmb_check_each_within(&check, "offset", def->offset, 2, -DMB_LENGTH_MAX, DMB_LENGTH_MAX);
    dmb_check_each_within(&check, "position", def->position, 3, -DMB_POSITION_MAX, DMB_POSITION_MAX);
    dmb_check_each_within(&check, "rotation", def->rotation, 3, -DMB_ANGLE_MAX, DMB_ANGLE_MAX);
    dmb_check_each_within(&check, "velocity", def->velocity, 6, -DMB_SPEED_MAX, DMB_SPEED_MAX);
    dmb_check_motion_mask(&check, "start_free", def->start_free);
    dmb_check_motion_mask(&check, "end_free", def->end_free);
    return check.status;
}

int32_t dmb_model_add_string(dmb_model *model, const dmb_string_def *def, dmb_id *string)
{
    dmb_string_plan plan = {dmb_string_def_default(), 0, 0};
    int32_t status = dmb_describe_open(model, "string", def);
    if (status < 0) return status;
    status = dmb_string_def_read(&plan.def, def);
    if (status >= 0) status = check_string(model, &plan.def);
    if (status >= 0) {
        status = dmb_describe_append(model, &model->strings, &plan, sizeof plan, DMB_PART_STRING, string);
    }
    return dmb_describe_end(model, "string", &plan.def, sizeof plan.def, status);
}
