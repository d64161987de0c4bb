/* Parts of a model: ids, lists that grow, start and end of each description. */
#include "model/model.h"

#include "base/memory.h"
#include "base/message.h"
#include "base/sized_struct.h"
#include "drillmbd/scene.h"
#include "model/field_check.h"

void dmb_model_refuse_re_entry(dmb_model *model)
{
    if (model->message.text[0] != '\0') return; /* message of the present call */
    dmb_message_set(&model->message, "model: in a call of its own, whose allocator or log function may not change it; "
                                     "do so when that call has returned");
}

static int32_t refuse_compiled(const dmb_model *model, const char *part)
{
    dmb_message message;
    dmb_message_set(&message, "%s: the model is compiled and does not change any more; describe a new one", part);
    return dmb_model_fail(model, DMB_ERR_ORDER, part, message.text);
}

dmb_id dmb_model_id(const dmb_model *model, uint32_t kind, uint32_t index)
{
    dmb_id id;
    id.index = kind << DMB_KIND_SHIFT | index;
    id.generation = model->stamp;
    return id;
}

const dmb_list *dmb_model_list(const dmb_model *model, uint32_t kind)
{
    static const size_t lists[DMB_PART_EVENT + 1] = {[DMB_PART_TIME_FUNCTION] = offsetof(dmb_model, time_functions),
                                                     [DMB_PART_STRING] = offsetof(dmb_model, strings),
                                                     [DMB_PART_BODY] = offsetof(dmb_model, bodies),
                                                     [DMB_PART_BIT] = offsetof(dmb_model, bits),
                                                     [DMB_PART_DRIVE] = offsetof(dmb_model, drives),
                                                     [DMB_PART_LOAD] = offsetof(dmb_model, loads),
                                                     [DMB_PART_JOINT] = offsetof(dmb_model, joints),
                                                     [DMB_PART_COUPLING] = offsetof(dmb_model, couplings),
                                                     [DMB_PART_CONSTRAINT] = offsetof(dmb_model, constraints),
                                                     [DMB_PART_INPUT] = offsetof(dmb_model, inputs),
                                                     [DMB_PART_SPRING] = offsetof(dmb_model, springs),
                                                     [DMB_PART_EVENT] = offsetof(dmb_model, events),
                                                     [DMB_PART_FORCE] = offsetof(dmb_model, forces),
                                                     [DMB_PART_STUCK] = offsetof(dmb_model, stuck),
                                                     [DMB_PART_STABILISER] = offsetof(dmb_model, rings)};
    if (kind >= sizeof lists / sizeof lists[0] || lists[kind] == 0) return NULL;
    return (const dmb_list *)(const void *)((const char *)model + lists[kind]);
}

uint32_t dmb_model_part_count(const dmb_model *model, uint32_t kind)
{
    const dmb_list *list = dmb_model_list(model, kind);
    return kind == DMB_PART_WALL ? model->wall_count : list == NULL ? 0 : list->count;
}

uint32_t dmb_model_part_index(const dmb_model *model, dmb_id id, uint32_t kind)
{
    const uint32_t index = id.index & (uint32_t)DMB_CHUNKS_MAX;
    if (id.generation != model->stamp || id.index >> DMB_KIND_SHIFT != kind) return DMB_NONE;
    return index < dmb_model_part_count(model, kind) ? index : DMB_NONE;
}

dmb_coupled_coordinate dmb_coupled_coordinate_of(const dmb_coupling_def *def, uint32_t k)
{
    const dmb_coupled_coordinate all[4] = {
        {def->joint[0], def->component[0], 1.0, "joint[0]", "component[0]", "ratio"},
        {def->joint[1], def->component[1], def->ratio, "joint[1]", "component[1]", "ratio"},
        {def->third_joint, def->third_component, def->third_ratio, "third_joint", "third_component", "third_ratio"},
        {def->fourth_joint, def->fourth_component, def->fourth_ratio, "fourth_joint", "fourth_component",
         "fourth_ratio"}};
    return all[k];
}

int32_t dmb_describe_open(dmb_model *model, const char *part, const void *def)
{
    if (model == NULL) return dmb_model_fail(model, DMB_ERR_NULL, part, NULL);
    if (!dmb_handle_is(model, DMB_HANDLE_MODEL)) return dmb_model_fail(model, DMB_ERR_HANDLE, part, NULL);
    if (model->scene != NULL) return refuse_compiled(model, part);
    if (model->busy) {
        dmb_model_refuse_re_entry(model);
        return dmb_model_fail(model, DMB_ERR_ORDER, part, model->message.text);
    }
    model->busy = 1;
    dmb_model_failure_forget(model);
    dmb_message_clear(&model->message);
    if (def != NULL) return DMB_OK;
    return dmb_describe_end(model, part, NULL, 0, DMB_ERR_NULL);
}

int32_t dmb_describe_close(dmb_model *model, const char *part, int32_t status)
{
    const dmb_log log = {model->log, model->log_context};
    if (status < 0) {
        if (model->message.text[0] == '\0') dmb_message_set(&model->message, "%s: %s", part, dmb_status_text(status));
        dmb_log_text(&log, DMB_LOG_ERROR, model->message.text);
    }
    model->busy = 0;
    return status < 0 ? dmb_model_fail(model, status, part, model->message.text) : status;
}

int32_t dmb_describe_part(dmb_model *model, const dmb_described *part, int32_t status)
{
    (void)dmb_describe_close(model, part->part, status);
    if (status < 0)
        dmb_refused_remember(&model->refused, part, status, &model->message);
    else
        dmb_refused_added(&model->refused, part);
    return status;
}

int32_t dmb_string_is_open(dmb_model *model, const char *part, uint32_t string)
{
    if (string >= model->strings.count) return DMB_OK;
    const uint32_t continued = DMB_LIST_AT(const dmb_string_plan, model->strings, string)->continued;
    if (continued == 0) return DMB_OK;
    dmb_message_set(&model->message,
                    "%s: string %u ends at a sub, must be one that nothing continues; take string %u, which continues "
                    "it",
                    part, string, continued - 1);
    return DMB_ERR_ORDER;
}

int32_t dmb_model_clear_refused(dmb_model *model)
{
    if (model == NULL) return dmb_model_fail(model, DMB_ERR_NULL, "model", NULL);
    if (!dmb_handle_is(model, DMB_HANDLE_MODEL)) return dmb_model_fail(model, DMB_ERR_HANDLE, "model", NULL);
    if (model->scene != NULL) return refuse_compiled(model, "model");
    if (model->busy) return dmb_model_fail(model, DMB_ERR_ORDER, "model", model->message.text);
    model->refused.kept = model->refused.further = 0; /* keeps the message: the refusal caused this call */
    return DMB_OK;
}

int32_t dmb_describe_append(dmb_model *model, dmb_list *list, const void *item, size_t item_size, uint32_t kind,
                            dmb_id *id)
{
    const int32_t status = dmb_list_append(list, &model->allocator, item, item_size);
    if (status >= 0 && id != NULL) *id = dmb_model_id(model, kind, list->count - 1);
    return status;
}

static dmb_vector vector_of(const dmb_list *list, size_t item_size)
{
    dmb_vector vector = dmb_vector_of(item_size);
    vector.items = list->items;
    vector.count = list->count;
    vector.capacity = list->capacity;
    return vector;
}

int32_t dmb_list_append(dmb_list *list, const dmb_allocator *allocator, const void *item, size_t item_size)
{
    dmb_vector vector = vector_of(list, item_size);
    int32_t status;
    if (list->count >= (uint32_t)DMB_CHUNKS_MAX) return DMB_ERR_TOO_LARGE;
    status = dmb_vector_append(&vector, allocator, item, 1);
    if (status < 0) return status;
    list->items = vector.items;
    list->count = (uint32_t)vector.count; /* below 2^24, the capacity below 1.5 times that */
    list->capacity = (uint32_t)vector.capacity;
    return DMB_OK;
}

void dmb_list_release(dmb_list *list, const dmb_allocator *allocator, size_t item_size)
{
    dmb_vector vector = vector_of(list, item_size);
    dmb_vector_release(&vector, allocator);
    list->items = NULL;
    list->count = list->capacity = 0;
}

dmb_failed_object dmb_failed_model(const dmb_model *model)
{
    const dmb_failed_object of = {model, model->stamp};
    return of;
}

int32_t dmb_model_fail(const dmb_model *model, int32_t status, const char *call, const char *text)
{
    if (model == NULL) return dmb_failure(NULL, NULL, status, call, text);
    if (!dmb_handle_is(model, DMB_HANDLE_MODEL)) return dmb_failure(NULL, NULL, status, call, text);
    const dmb_failed_object of = dmb_failed_model(model);
    return dmb_failure(&of, &model->on_error, status, call, text);
}

void dmb_model_failure_forget(const dmb_model *model)
{
    const dmb_failed_object of = dmb_failed_model(model);
    dmb_failure_forget(&of);
}
