/* Places that can be stuck. */
#include "drillmbd/bha.h"
#include "model/describe.h"
#include "model/field_check.h"
#include "model/part_name.h"

enum { EVERYTHING = DMB_STUCK_AXIAL | DMB_STUCK_ROTATION | DMB_STUCK_LATERAL };

static void check_release(dmb_check *check, const dmb_stuck_def *def)
{
    dmb_check_zero_or_within(check, "overpull", def->overpull, DMB_DEPTH_MIN, DMB_FORCE_MAX);
    dmb_check_zero_or_within(check, "overtorque", def->overtorque, DMB_DEPTH_MIN, DMB_FORCE_MAX);
    if (check->status < 0 || def->overtorque <= def->stiffness[1]) return;
    dmb_check_fail(check, DMB_ERR_VALUE, "overtorque", def->overtorque, "<= stiffness[1] times 1 rad");
}

static int32_t check_stuck(dmb_model *model, const dmb_stuck_def *def)
{
    dmb_message part;
    dmb_check check = dmb_check_of(
        &model->message, dmb_part_text(&part, "stuck", model->stuck.count, def->name, sizeof def->name), DMB_NONE);
    dmb_check_part_name(&check, model, DMB_PART_STUCK, def->name);
    dmb_check_mask(&check, "holds", def->holds, EVERYTHING);
    if (check.status >= 0 && def->holds == 0)
        dmb_check_fail(&check, DMB_ERR_VALUE, "holds", def->holds, "> 0: nothing is held");
    dmb_check_place(&check, model, "place", &def->place);
    dmb_check_choice(&check, "stuck", def->stuck, 0, 1);
    dmb_check_each_within(&check, "stiffness", def->stiffness, 3, DMB_DEPTH_MIN, DMB_STIFFNESS_MAX);
    dmb_check_each_within(&check, "damping", def->damping, 3, 0.0, DMB_DAMPING_MAX);
    check_release(&check, def);
    return check.status;
}

int32_t dmb_model_add_stuck(dmb_model *model, const dmb_stuck_def *def, dmb_id *stuck)
{
    dmb_stuck_def read = dmb_stuck_def_default();
    int32_t status = dmb_describe_open(model, "stuck", def);
    if (status < 0) return status;
    status = dmb_stuck_def_read(&read, def);
    if (status >= 0) status = check_stuck(model, &read);
    if (status >= 0) status = dmb_describe_append(model, &model->stuck, &read, sizeof read, DMB_PART_STUCK, stuck);
    return dmb_describe_end(model, "stuck", &read, sizeof read, status);
}
