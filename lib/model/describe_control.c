/* Inputs, which the caller moves in each sim, with name, unit and bounds; and events, at which a run stops. */
#include "model/describe.h"

#include <math.h>
#include <string.h>

#include "base/sized_struct.h"
#include "drillmbd/scene.h"
#include "model/field_check.h"
#include "model/model.h"

DMB_DECLARE_STRUCT(dmb_input_info)

DMB_DEFINE_INIT(dmb_input_info, 96, {.target = 0})

/* ---- Targets ----------------------------------------------------------------------------------------------------- */

/* Kind of part, and bounds of the value; a kind of 0: wall or environment. */
typedef struct target_rule {
    uint32_t part;
    const char *what;
    double low, high;
    const char *unit[2]; /* along, about an axis */
} target_rule;

static const target_rule targets[DMB_TARGET_FLOW_RATE + 1] = {
    [DMB_TARGET_SET_POINT] = {DMB_PART_DRIVE, "drive", -DMB_FORCE_MAX, DMB_FORCE_MAX, {"m/s", "rad/s"}},
    [DMB_TARGET_GAIN] = {DMB_PART_DRIVE, "drive", 0.0, DMB_FORCE_MAX, {"N s/m", "N m s"}},
    [DMB_TARGET_INTEGRAL_GAIN] = {DMB_PART_DRIVE, "drive", 0.0, DMB_FORCE_MAX, {"N/m", "N m"}},
    [DMB_TARGET_LIMIT_LOW] = {DMB_PART_DRIVE, "drive", -DMB_FORCE_MAX, DMB_FORCE_MAX, {"N", "N m"}},
    [DMB_TARGET_LIMIT_HIGH] = {DMB_PART_DRIVE, "drive", -DMB_FORCE_MAX, DMB_FORCE_MAX, {"N", "N m"}},
    [DMB_TARGET_LOAD_FACTOR] = {DMB_PART_LOAD, "load", -DMB_FORCE_MAX, DMB_FORCE_MAX, {"-", "-"}},
    [DMB_TARGET_BIT_LOAD] = {DMB_PART_BIT, "bit", -DMB_FORCE_MAX, DMB_FORCE_MAX, {"N", "N"}},
    [DMB_TARGET_FRICTION] = {0, "", 0.0, DMB_NUMBER_MAX, {"-", "-"}},
    [DMB_TARGET_FLUID_DENSITY] = {0, "", 0.0, DMB_DENSITY_MAX, {"kg/m3", "kg/m3"}},
    [DMB_TARGET_LATERAL_DAMPING] = {0, "", 0.0, DMB_DAMPING_MAX, {"N s/m2", "N s/m2"}},
    [DMB_TARGET_AXIAL_DAMPING] = {0, "", 0.0, DMB_DAMPING_MAX, {"N s/m2", "N s/m2"}},
    [DMB_TARGET_TORSIONAL_DAMPING] = {0, "", 0.0, DMB_DAMPING_MAX, {"N s", "N s"}},
    [DMB_TARGET_FLOW_RATE] = {0, "", 0.0, DMB_FLOW_MAX, {"m3/s", "m3/s"}},
    [DMB_TARGET_STUCK] = {DMB_PART_STUCK, "stuck place", 0.0, 1.0, {"-", "-"}},
};

static const dmb_drive_def *drive_of(const dmb_model *model, const dmb_input_def *def)
{
    const uint32_t i = dmb_model_part_index(model, def->part, DMB_PART_DRIVE);
    return i == DMB_NONE ? NULL : DMB_LIST_AT(const dmb_drive_def, model->drives, i);
}

const char *dmb_input_unit(const dmb_model *model, const dmb_input_def *def)
{
    const dmb_drive_def *drive = drive_of(model, def);
    const int about = drive != NULL && drive->component >= DMB_RX;
    const int forced = drive != NULL && drive->kind == DMB_DRIVE_LOAD && def->target == DMB_TARGET_SET_POINT;
    return targets[forced ? DMB_TARGET_LIMIT_LOW : def->target].unit[about];
}

double dmb_input_low(const dmb_input_def *def)
{
    return fmax(def->low, targets[def->target].low);
}

double dmb_input_high(const dmb_input_def *def)
{
    return fmin(def->high, targets[def->target].high);
}

int dmb_input_is_time_function(int32_t target)
{
    return target == DMB_TARGET_SET_POINT || target == DMB_TARGET_LOAD_FACTOR || target == DMB_TARGET_BIT_LOAD;
}

/* ---- Checks ------------------------------------------------------------------------------------------------------ */

static int same_id(dmb_id a, dmb_id b)
{
    return a.index == b.index && a.generation == b.generation;
}

static void check_apart(dmb_check *check, const dmb_model *model, const dmb_input_def *def)
{
    for (uint32_t i = 0; i < model->inputs.count && check->status >= 0; i++) {
        const dmb_input_def *other = DMB_LIST_AT(const dmb_input_def, model->inputs, i);
        if (other->target != def->target || !same_id(other->part, def->part)) continue;
        check->status = DMB_ERR_VALUE;
        dmb_message_set(check->message, "%s: its target is that of input %u (%s); one input moves it, name that one",
                        check->part, i, other->name);
    }
}

/* Inputs and events are found by their names. */
static void check_has_name(dmb_check *check, const char *name, const char *why)
{
    if (name[0] != '\0') return;
    check->status = DMB_ERR_VALUE;
    dmb_message_set(check->message, "%s: name is empty, %s", check->part, why);
}

/* The part has such a target. */
static void check_target(dmb_check *check, const dmb_model *model, const dmb_input_def *def)
{
    const target_rule *t = targets + def->target;
    const int of_drive = def->target >= DMB_TARGET_GAIN && def->target <= DMB_TARGET_LIMIT_HIGH;
    if (check->status < 0) return;
    if (t->part != 0) {
        dmb_check_id(check, model, "part", def->part, t->part, t->what);
    } else if (!dmb_id_is_none(def->part)) {
        check->status = DMB_ERR_ID;
        dmb_message_set(check->message, "%s: part must be {0, 0}: its target is of the wall or the environment",
                        check->part);
    }
    if (check->status >= 0 && def->target == DMB_TARGET_GAIN && drive_of(model, def)->gain_count > 0)
        dmb_check_fail(check, DMB_ERR_UNSUPPORTED, "target", def->target,
                       "another one than DMB_TARGET_GAIN: the drive has a table (gain_count) in the place of its gain");
    if (check->status < 0 || !of_drive || drive_of(model, def)->kind == DMB_DRIVE_CONTROL) return;
    check->status = DMB_ERR_UNSUPPORTED;
    dmb_message_set(check->message,
                    "%s: target = %d, a gain or limit, must be of a drive of kind DMB_DRIVE_CONTROL; the others have "
                    "DMB_TARGET_SET_POINT alone",
                    check->part, (int)def->target);
}

static void check_bounds(dmb_check *check, const dmb_input_def *def)
{
    const double low = dmb_input_low(def), high = dmb_input_high(def);
    dmb_check_at_least_field(check, "high", def->high, "low", def->low);
    if (check->status >= 0 && low > high)
        dmb_check_fail(check, DMB_ERR_VALUE, def->low > targets[def->target].high ? "low" : "high",
                       def->low > targets[def->target].high ? def->low : def->high, "within what its target allows");
    if (!isnan(def->initial)) dmb_check_within(check, "initial", def->initial, low, high);
    if (def->target == DMB_TARGET_STUCK && def->initial > 0.0 && def->initial < 1.0)
        dmb_check_fail(check, DMB_ERR_VALUE, "initial", def->initial, "0 (free) or 1 (stuck)");
}

static void check_limits(dmb_check *check, const dmb_model *model, const dmb_input_def *def)
{
    const dmb_drive_def *drive = drive_of(model, def);
    if (check->status < 0) return;
    if (!dmb_input_is_time_function(def->target) && (def->rate_limit > 0.0 || def->slope_limit > 0.0))
        dmb_check_fail(check, DMB_ERR_UNSUPPORTED, def->rate_limit > 0.0 ? "rate_limit" : "slope_limit",
                       def->rate_limit > 0.0 ? def->rate_limit : def->slope_limit,
                       "0: only set points, load factors and bit loads have limits");
    if (drive != NULL && drive->kind == DMB_DRIVE_MOTION && !(def->rate_limit > 0.0))
        dmb_check_fail(check, DMB_ERR_VALUE, "rate_limit", def->rate_limit,
                       "> 0, the largest acceleration of a drive of kind DMB_DRIVE_MOTION, whose speed may not jump");
}

static void relate_input(dmb_check *check, dmb_model *model, const void *part)
{
    const dmb_input_def *def = part;
    check_has_name(check, def->name, "must be there: inputs are looked up by it");
    if (check->status >= 0) check_target(check, model, def);
    if (check->status < 0) return;
    check_apart(check, model, def);
    check_bounds(check, def);
    check_limits(check, model, def);
}

int32_t dmb_model_add_input(dmb_model *model, const dmb_input_def *def, dmb_id *input)
{
    dmb_input_def read = dmb_input_def_default();
    return dmb_describe_add(model, DMB_FIELDS_OF(dmb_input_def), def, &read, relate_input, input);
}

/* ---- Questions --------------------------------------------------------------------------------------------------- */

uint32_t dmb_model_input_count(const dmb_model *model)
{
    return dmb_handle_is(model, DMB_HANDLE_MODEL) ? model->inputs.count : 0;
}

int32_t dmb_model_get_input(const dmb_model *model, uint32_t index, dmb_input_info *info)
{
    dmb_input_info answer = dmb_input_info_default();
    if (model == NULL || info == NULL) return dmb_model_failed(model, "model", DMB_ERR_NULL);
    if (!dmb_handle_is(model, DMB_HANDLE_MODEL)) return dmb_model_failed(model, "model", DMB_ERR_HANDLE);
    if (index >= model->inputs.count) return dmb_model_failed(model, "model", DMB_ERR_ID);
    const dmb_input_def *def = DMB_LIST_AT(const dmb_input_def, model->inputs, index);
    const char *unit = dmb_input_unit(model, def);
    answer.target = def->target;
    answer.input = dmb_model_id(model, DMB_PART_INPUT, index);
    answer.part = def->part;
    memcpy(answer.name, def->name, sizeof answer.name);
    memcpy(answer.unit, unit, strlen(unit)); /* the rest is 0 */
    answer.low = dmb_input_low(def);
    answer.high = dmb_input_high(def);
    answer.rate_limit = def->rate_limit;
    answer.slope_limit = def->slope_limit;
    return dmb_model_failed(model, "model", dmb_input_info_write(info, &answer));
}

int32_t dmb_model_find_input(const dmb_model *model, const char *name, dmb_id *input)
{
    if (model == NULL || name == NULL || input == NULL) return dmb_model_failed(model, "find", DMB_ERR_NULL);
    if (!dmb_handle_is(model, DMB_HANDLE_MODEL)) return dmb_model_failed(model, "find", DMB_ERR_HANDLE);
    for (uint32_t i = 0; i < model->inputs.count; i++) {
        if (strcmp(DMB_LIST_AT(const dmb_input_def, model->inputs, i)->name, name) != 0) continue;
        *input = dmb_model_id(model, DMB_PART_INPUT, i);
        return DMB_OK;
    }
    return dmb_model_refuse_name(model, "input", name);
}

/* ---- Events: an output that crosses a level ---------------------------------------------------------------------- */

/* That the scene has the output is found out when a sim is made. */
static void relate_event(dmb_check *check, dmb_model *model, const void *part)
{
    const dmb_event_def *def = part;
    check_has_name(check, def->name, "is required: events are reported by it");
    if (check->status >= 0 && def->direction == DMB_EVENT_EITHER && def->hold != 0.0)
        dmb_check_fail(check, DMB_ERR_VALUE, "hold", def->hold,
                       "0 with DMB_EVENT_EITHER: an output that crosses either way is on no side to be held on");
    if (check->status < 0 || model->events.count < DMB_EVENTS_MAX) return;
    check->status = DMB_ERR_TOO_LARGE;
    dmb_message_set(check->message, "%s: events = %d, must be <= %d, a bit for each", check->part, DMB_EVENTS_MAX + 1,
                    DMB_EVENTS_MAX);
}

int32_t dmb_model_add_event(dmb_model *model, const dmb_event_def *def, dmb_id *event)
{
    dmb_event_def read = dmb_event_def_default();
    return dmb_describe_add(model, DMB_FIELDS_OF(dmb_event_def), def, &read, relate_event, event);
}

/* ---- Events: questions ------------------------------------------------------------------------------------------- */

uint32_t dmb_model_event_count(const dmb_model *model)
{
    return dmb_handle_is(model, DMB_HANDLE_MODEL) ? model->events.count : 0;
}

int32_t dmb_model_get_event(const dmb_model *model, uint32_t index, dmb_event_def *event)
{
    if (model == NULL || event == NULL) return dmb_model_failed(model, "model", DMB_ERR_NULL);
    if (!dmb_handle_is(model, DMB_HANDLE_MODEL)) return dmb_model_failed(model, "model", DMB_ERR_HANDLE);
    if (index >= model->events.count) return dmb_model_failed(model, "model", DMB_ERR_ID);
    return dmb_model_failed(model, "model",
                            dmb_event_def_write(event, DMB_LIST_AT(const dmb_event_def, model->events, index)));
}

int32_t dmb_model_find_event(const dmb_model *model, const char *name, dmb_id *event)
{
    if (model == NULL || name == NULL || event == NULL) return dmb_model_failed(model, "find", DMB_ERR_NULL);
    if (!dmb_handle_is(model, DMB_HANDLE_MODEL)) return dmb_model_failed(model, "find", DMB_ERR_HANDLE);
    for (uint32_t i = 0; i < model->events.count; i++) {
        if (strcmp(DMB_LIST_AT(const dmb_event_def, model->events, i)->name, name) != 0) continue;
        *event = dmb_model_id(model, DMB_PART_EVENT, i);
        return DMB_OK;
    }
    return dmb_model_refuse_name(model, "event", name);
}
