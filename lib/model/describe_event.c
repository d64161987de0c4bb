/* Events: an output that crosses a level. */
#include <math.h>
#include <string.h>

#include "base/handle.h"
#include "drillmbd/control.h"
#include "model/describe.h"
#include "model/field_check.h"
#include "model/limits.h"
#include "model/model.h"

/* clang-format off */
DMB_DEFINE_INIT(dmb_event_def, 88, {.direction = DMB_EVENT_RISING, .tolerance = 1e-9})
/* clang-format on */

static void check_hold(dmb_check *check, const dmb_event_def *def)
{
    dmb_check_within(check, "hold", def->hold, 0.0, DMB_TIME_MAX);
    if (check->status < 0 || def->direction != DMB_EVENT_EITHER || def->hold == 0.0) return;
    dmb_check_fail(check, DMB_ERR_VALUE, "hold", def->hold,
                   "0 with DMB_EVENT_EITHER: an output that crosses either way is on no side to be held on");
}

static void check_apart(dmb_check *check, const dmb_model *model, const char *name)
{
    for (uint32_t i = 0; i < model->events.count && check->status >= 0; i++) {
        if (strcmp(DMB_LIST_AT(const dmb_event_def, model->events, i)->name, name) != 0) continue;
        check->status = DMB_ERR_VALUE;
        dmb_message_set(check->message, "%s: its name is that of event %u; give it a name of its own", check->part, i);
    }
}

/* That the output can be asked of the scene is found out when a sim is made. */
static int32_t check_event(dmb_model *model, const dmb_event_def *def)
{
    dmb_message part;
    dmb_check check = dmb_check_of(
        &model->message, dmb_part_text(&part, "event", model->events.count, def->name, sizeof def->name), DMB_NONE);
    dmb_check_name(&check, "name", def->name, sizeof def->name);
    if (check.status >= 0 && def->name[0] == '\0') {
        check.status = DMB_ERR_VALUE;
        dmb_message_set(check.message, "%s: name is empty, must be there: events are told by it", check.part);
    }
    dmb_check_choice(&check, "direction", def->direction, DMB_EVENT_EITHER, DMB_EVENT_FALLING);
    dmb_check_within(&check, "level", def->level, -DMB_FORCE_MAX, DMB_FORCE_MAX);
    dmb_check_within(&check, "tolerance", def->tolerance, DMB_TIME_MIN, 1.0);
    check_hold(&check, def);
    check_apart(&check, model, def->name);
    if (check.status < 0 || model->events.count < DMB_EVENTS_MAX) return check.status;
    dmb_message_set(&model->message, "%s: events = %d, must be <= %d, a bit for each", part.text, DMB_EVENTS_MAX + 1,
                    DMB_EVENTS_MAX);
    return DMB_ERR_TOO_LARGE;
}

int32_t dmb_model_add_event(dmb_model *model, const dmb_event_def *def, dmb_id *event)
{
    dmb_event_def read = dmb_event_def_default();
    int32_t status = dmb_describe_open(model, "event", def);
    if (status < 0) return status;
    status = dmb_event_def_read(&read, def);
    if (status >= 0) status = check_event(model, &read);
    if (status >= 0) status = dmb_describe_append(model, &model->events, &read, sizeof read, DMB_PART_EVENT, event);
    return dmb_describe_end(model, "event", &read, sizeof read, status);
}

/* ---- Questions --------------------------------------------------------------------------------------------------- */

uint32_t dmb_model_event_count(const dmb_model *model)
{
    return dmb_handle_is(model, DMB_HANDLE_MODEL) ? model->events.count : 0;
}

int32_t dmb_model_get_event(const dmb_model *model, uint32_t index, dmb_event_def *event)
{
    if (model == NULL || event == NULL) return DMB_ERR_NULL;
    if (!dmb_handle_is(model, DMB_HANDLE_MODEL)) return DMB_ERR_HANDLE;
    if (index >= model->events.count) return DMB_ERR_ID;
    return dmb_event_def_write(event, DMB_LIST_AT(const dmb_event_def, model->events, index));
}

int32_t dmb_model_find_event(const dmb_model *model, const char *name, dmb_id *event)
{
    if (model == NULL || name == NULL || event == NULL) return DMB_ERR_NULL;
    if (!dmb_handle_is(model, DMB_HANDLE_MODEL)) return DMB_ERR_HANDLE;
    for (uint32_t i = 0; i < model->events.count; i++) {
        if (strcmp(DMB_LIST_AT(const dmb_event_def, model->events, i)->name, name) != 0) continue;
        *event = dmb_model_id(model, DMB_PART_EVENT, i);
        return DMB_OK;
    }
    return DMB_ERR_ID;
}
