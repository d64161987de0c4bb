/* Drives and loads. */
#include "constraint/joint.h"
#include "model/defaults.h"
#include "model/describe.h"
#include "model/field_check.h"
#include "model/limits.h"

/* ---- Drives ------------------------------------------------------------------------------------------------------ */

/* A body that is not fixed to a string. */
static void check_driven_body(dmb_check *check, const dmb_model *model, uint32_t body)
{
    if (check->status < 0 || DMB_LIST_AT(const dmb_body_def, model->bodies, body)->attach == DMB_ATTACH_NONE) return;
    check->status = DMB_ERR_UNSUPPORTED;
    dmb_message_set(check->message, "%s %u: part = body %u, must be a body of its own: drive the string it is fixed to",
                    check->part, check->index, body);
}

/* A coordinate that the joint does not hold, as far as its kind goes. */
static void check_driven_joint(dmb_check *check, const dmb_model *model, uint32_t joint, int32_t component)
{
    const dmb_joint_def *def = DMB_LIST_AT(const dmb_joint_def, model->joints, joint);
    dmb_message name, bound;
    if (check->status < 0 || (dmb_joint_free_mask(def->kind) >> component & 1) != 0) return;
    dmb_message_set(&bound, "free in the joint: %s", dmb_part_text(&name, "joint", joint, def->name, sizeof def->name));
    dmb_check_fail(check, DMB_ERR_VALUE, "component", component, bound.text);
}

static void check_driven_part(dmb_check *check, const dmb_model *model, const dmb_drive_def *def)
{
    const uint32_t body = dmb_model_part_index(model, def->part, DMB_PART_BODY);
    const uint32_t joint = dmb_model_part_index(model, def->part, DMB_PART_JOINT);
    if (body != UINT32_MAX) {
        check_driven_body(check, model, body);
    } else if (joint != UINT32_MAX) {
        check_driven_joint(check, model, joint, def->component);
    } else {
        dmb_check_id_or_none(check, model, "part", def->part, DMB_PART_STRING, "string, a body or a joint");
    }
}

static int32_t check_drive(dmb_model *model, const dmb_drive_def *def)
{
    dmb_check check = dmb_check_of(&model->message, "drive", model->drives.count);
    dmb_check_choice(&check, "kind", def->kind, DMB_DRIVE_MOTION, DMB_DRIVE_CONTROL);
    dmb_check_choice(&check, "component", def->component, DMB_X, DMB_RZ);
    check_driven_part(&check, model, def);
    dmb_check_id(&check, model, "programme", def->programme, DMB_PART_PROGRAMME, "programme");
    dmb_check_id_or_none(&check, model, "excitation", def->excitation, DMB_PART_PROGRAMME, "programme");
    dmb_check_within(&check, "gain", def->gain, 0.0, DMB_FORCE_MAX);
    dmb_check_within(&check, "integral_gain", def->integral_gain, 0.0, DMB_FORCE_MAX);
    dmb_check_within(&check, "limit_low", def->limit_low, -DMB_FORCE_MAX, DMB_FORCE_MAX);
    dmb_check_within(&check, "limit_high", def->limit_high, -DMB_FORCE_MAX, DMB_FORCE_MAX);
    dmb_check_above_field(&check, "limit_high", def->limit_high, "limit_low", def->limit_low);
    return check.status;
}

int32_t dmb_model_add_drive(dmb_model *model, const dmb_drive_def *def, dmb_id *drive)
{
    dmb_drive_def read = dmb_drive_def_default();
    int32_t status = dmb_describe_open(model, "drive", def);
    if (status < 0) return status;
    status = dmb_drive_def_read(&read, def);
    if (status >= 0) status = check_drive(model, &read);
    if (status >= 0) status = dmb_describe_append(model, &model->drives, &read, sizeof read, DMB_PART_DRIVE, drive);
    return dmb_describe_end(model, "drive", &read, sizeof read, status);
}

/* ---- Loads ------------------------------------------------------------------------------------------------------- */

/* Elements take loads at their ends only. */
static void check_place(dmb_check *check, const dmb_model *model, const dmb_place *place)
{
    dmb_check_place(check, model, "place", place);
    if (place->fraction > 0.0 && place->fraction < 1.0) {
        dmb_check_within(check, "place.fraction (0 or 1)", place->fraction, 1.0, 1.0);
    }
}

static int32_t check_load(dmb_model *model, const dmb_load_def *def)
{
    dmb_check check = dmb_check_of(&model->message, "load", model->loads.count);
    dmb_check_choice(&check, "frame", def->frame, DMB_FRAME_WORLD, DMB_FRAME_HOLE);
    check_place(&check, model, &def->place);
    dmb_check_each_within(&check, "force", def->force, 3, -DMB_FORCE_MAX, DMB_FORCE_MAX);
    dmb_check_each_within(&check, "moment", def->moment, 3, -DMB_FORCE_MAX, DMB_FORCE_MAX);
    dmb_check_id_or_none(&check, model, "programme", def->programme, DMB_PART_PROGRAMME, "programme");
    return check.status;
}

int32_t dmb_model_add_load(dmb_model *model, const dmb_load_def *def, dmb_id *load)
{
    dmb_load_def read = dmb_load_def_default();
    int32_t status = dmb_describe_open(model, "load", def);
    if (status < 0) return status;
    status = dmb_load_def_read(&read, def);
    if (status >= 0) status = check_load(model, &read);
    if (status >= 0) status = dmb_describe_append(model, &model->loads, &read, sizeof read, DMB_PART_LOAD, load);
    return dmb_describe_end(model, "load", &read, sizeof read, status);
}
