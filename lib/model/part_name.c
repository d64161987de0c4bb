/* Names of parts: their storage by kind, permitted names, and their use in messages. */
#include "model/model.h"

#include <string.h>

#include "base/sized_struct.h"
#include "model/field_check.h"

/* ---- Where names are --------------------------------------------------------------------------------------------- */

/* In a list of the model. */
typedef struct name_place {
    const char *word;
    size_t item, name; /* [byte] of an item of the model's list; of the name in it */
} name_place;

#define PLACE(word, T)                        \
    {                                         \
        word, sizeof(T), offsetof(T, name[0]) \
    }
#define PLAN(word, T)                             \
    {                                             \
        word, sizeof(T), offsetof(T, def.name[0]) \
    }

enum { KINDS = DMB_PART_EVENT + 1 };

static const name_place places[KINDS] = {
    [DMB_PART_TIME_FUNCTION] = {"time function", 0, 0},
    [DMB_PART_WALL] = {"wall", 0, 0},
    [DMB_PART_STRING] = PLAN("string", dmb_string_plan),
    [DMB_PART_BODY] = PLACE("body", dmb_body_def),
    [DMB_PART_BIT] = PLACE("bit", dmb_bit_def),
    [DMB_PART_DRIVE] = PLACE("drive", dmb_drive_def),
    [DMB_PART_LOAD] = PLACE("load", dmb_load_def),
    [DMB_PART_JOINT] = PLACE("joint", dmb_joint_def),
    [DMB_PART_COUPLING] = PLACE("coupling", dmb_coupling_def),
    [DMB_PART_CONSTRAINT] = PLACE("constraint", dmb_constraint_def),
    [DMB_PART_SPRING] = PLAN("spring", dmb_spring_plan),
    [DMB_PART_FORCE] = PLACE("force", dmb_force_def),
    [DMB_PART_STABILISER] = PLACE("stabiliser", dmb_stabiliser_def),
    [DMB_PART_STUCK] = PLACE("stuck", dmb_stuck_def),
    [DMB_PART_INPUT] = PLACE("input", dmb_input_def),
    [DMB_PART_EVENT] = PLACE("event", dmb_event_def),
};

const char *dmb_part_word(uint32_t kind)
{
    return kind < KINDS ? places[kind].word : NULL;
}

static uint32_t name_of_time_function(const dmb_model *model, uint32_t index)
{
    for (uint32_t i = 0; i < model->names.count; ++i)
        if (DMB_LIST_AT(const dmb_time_function_name, model->names, i)->time_function == index) return i;
    return DMB_NONE;
}

/* The part is there. */
const char *dmb_part_name(const dmb_model *model, uint32_t kind, uint32_t index)
{
    const name_place *place = places + kind;
    if (kind == DMB_PART_WALL) return model->wall.name;
    if (kind == DMB_PART_TIME_FUNCTION) {
        const uint32_t i = name_of_time_function(model, index);
        return i == DMB_NONE ? "" : DMB_LIST_AT(const dmb_time_function_name, model->names, i)->name;
    }
    return (const char *)dmb_model_list(model, kind)->items + index * place->item + place->name;
}

/* The part of a kind that has the name; DMB_NONE: none. */
static uint32_t find_in(const dmb_model *model, uint32_t kind, const char *name)
{
    const uint32_t count = dmb_model_part_count(model, kind);
    if (name[0] == '\0') return DMB_NONE;
    for (uint32_t i = 0; i < count; ++i)
        if (strncmp(dmb_part_name(model, kind, i), name, DMB_NAME_SIZE) == 0) return i; /* an end may be missing */
    return DMB_NONE;
}

static uint32_t find_run(const dmb_model *model, const char *name)
{
    if (name[0] == '\0') return DMB_NONE;
    for (uint32_t i = 0; i < model->runs.count; ++i)
        if (strncmp(DMB_LIST_AT(const dmb_pipe_run, model->runs, i)->def.name, name, DMB_NAME_SIZE) == 0) return i;
    return DMB_NONE;
}

/* ---- Checks ------------------------------------------------------------------------------------------------------ */

static void refuse_used(dmb_check *check, const char *word, uint32_t index, const char *name)
{
    check->status = DMB_ERR_VALUE;
    dmb_message_set(check->message, "%s: name = %s, must be of its own, and %s %u has it; give another", check->part,
                    name, word, index);
}

/* The 0 at the end, and the characters before it. */
static void check_text(dmb_check *check, const char *name)
{
    if (check->status >= 0 && memchr(name, '\0', DMB_NAME_SIZE) == NULL) {
        check->status = DMB_ERR_VALUE;
        dmb_message_set(check->message,
                        "%s: name = %d characters without an end, must be at most %d and a 0 behind them; shorten it",
                        check->part, (int)DMB_NAME_SIZE, DMB_NAME_SIZE - 1);
    } else if (check->status >= 0 && !dmb_is_text(name, DMB_NAME_SIZE)) {
        check->status = DMB_ERR_VALUE;
        dmb_message_set(check->message, "%s: name is no text, must be UTF-8 without control characters", check->part);
    }
}

void dmb_check_part_name(dmb_check *check, const dmb_model *model, uint32_t kind, const char *name)
{
    check_text(check, name);
    if (check->status < 0) return;
    const uint32_t other = find_in(model, kind, name);
    if (other != DMB_NONE) refuse_used(check, places[kind].word, other, name);
}

void dmb_check_pipes_name(dmb_check *check, const dmb_model *model, const char *name)
{
    if (check->status < 0) return;
    const uint32_t other = find_run(model, name);
    if (other == DMB_NONE) return;
    refuse_used(check, "pipes of string", DMB_LIST_AT(const dmb_pipe_run, model->runs, other)->string, name);
}

/* ---- In messages ------------------------------------------------------------------------------------------------- */

const char *dmb_model_part_text(const dmb_model *model, uint32_t kind, uint32_t index, dmb_message *text)
{
    return dmb_part_text(text, places[kind].word, index, dmb_part_name(model, kind, index), DMB_NAME_SIZE);
}

const char *dmb_model_word_text(const dmb_model *model, const char *word, uint32_t index, dmb_message *text)
{
    for (uint32_t kind = 1; kind < KINDS; ++kind)
        if (places[kind].word != NULL && strcmp(places[kind].word, word) == 0)
            return dmb_model_part_text(model, kind, index, text);
    return dmb_part_text(text, word, index, "", 1);
}

const char *dmb_model_pipe_text(const dmb_model *model, uint32_t string, uint32_t pipe, dmb_message *text)
{
    dmb_message of_string, of_pipe;
    const char *name = "";
    for (uint32_t i = 0; i < model->runs.count; ++i) {
        const dmb_pipe_run *run = DMB_LIST_AT(const dmb_pipe_run, model->runs, i);
        if (run->string == string && pipe >= run->first && pipe - run->first < run->count) name = run->def.name;
    }
    (void)dmb_model_part_text(model, DMB_PART_STRING, string, &of_string);
    dmb_message_set(text, "%s, %s", of_string.text, dmb_part_text(&of_pipe, "pipe", pipe, name, DMB_NAME_SIZE));
    return text->text;
}

const char *dmb_pipes_text(dmb_message *text, uint32_t string, const dmb_pipe_def *def)
{
    return dmb_part_text(text, "pipes of string", string, def->name, sizeof def->name);
}

/* ---- Calls ------------------------------------------------------------------------------------------------------- */

/* Kind and index of an id of this model. DMB_ERR_ID. */
static int32_t read_id(const dmb_model *model, dmb_id id, uint32_t *kind, uint32_t *index)
{
    *kind = id.index >> DMB_KIND_SHIFT;
    *index = dmb_model_part_index(model, id, *kind);
    return *index == DMB_NONE || *kind >= KINDS || places[*kind].word == NULL ? DMB_ERR_ID : DMB_OK;
}

static int32_t put_name(dmb_model *model, uint32_t kind, uint32_t index, const char name[DMB_NAME_SIZE])
{
    if (kind == DMB_PART_TIME_FUNCTION && name_of_time_function(model, index) == DMB_NONE) {
        dmb_time_function_name item = {index, 0, ""};
        memcpy(item.name, name, sizeof item.name);
        return dmb_list_append(&model->names, &model->allocator, &item, sizeof item);
    }
    char *own;
    const char *read = dmb_part_name(model, kind, index);
    memcpy(&own, &read, sizeof own); /* the model is the caller's to change */
    memcpy(own, name, DMB_NAME_SIZE);
    return DMB_OK;
}

static int32_t check_new_name(dmb_model *model, uint32_t kind, uint32_t index, const char *name)
{
    dmb_message part;
    dmb_check check = dmb_check_of(&model->message, dmb_model_part_text(model, kind, index, &part), DMB_NONE);
    if (find_in(model, kind, name) == index) return DMB_OK;
    dmb_check_part_name(&check, model, kind, name);
    if (check.status < 0 || name[0] != '\0' || kind < DMB_PART_INPUT) return check.status;
    dmb_message_set(&model->message, "%s: name is empty, is required: inputs and events are reported by it", part.text);
    return DMB_ERR_VALUE;
}

int32_t dmb_model_set_name(dmb_model *model, dmb_id part, const char *name)
{
    char padded[DMB_NAME_SIZE] = {0};
    uint32_t kind, index;
    int32_t status = dmb_describe_open(model, "name", model);
    if (status < 0) return status;
    status = name == NULL ? DMB_ERR_NULL : read_id(model, part, &kind, &index);
    for (size_t i = 0; status >= 0 && i < sizeof padded && (i == 0 || padded[i - 1] != '\0'); ++i) padded[i] = name[i];
    if (status >= 0) status = check_new_name(model, kind, index, padded);
    if (status >= 0) status = put_name(model, kind, index, padded);
    return dmb_describe_close(model, "name", status);
}

int32_t dmb_model_get_name(const dmb_model *model, dmb_id part, char *name, uint32_t size)
{
    uint32_t kind, index;
    if (model == NULL || name == NULL) return dmb_model_failed(model, "model", DMB_ERR_NULL);
    if (!dmb_handle_is(model, DMB_HANDLE_MODEL)) return dmb_model_failed(model, "model", DMB_ERR_HANDLE);
    if (size < DMB_NAME_SIZE) return dmb_model_failed(model, "model", DMB_ERR_VALUE);
    const int32_t status = read_id(model, part, &kind, &index);
    if (status < 0) return dmb_model_failed(model, "model", status);
    const char *own = dmb_part_name(model, kind, index);
    memcpy(name, own, strlen(own) + 1);
    return DMB_OK;
}

int32_t dmb_model_refuse_name(const dmb_model *model, const char *word, const char *name)
{
    dmb_message text;
    dmb_message_set(&text, "%s: no %s of this model has the name \"%s\"; upper and lower case differ", word, word,
                    dmb_is_text(name, strlen(name) + 1) && strlen(name) < 2 * DMB_NAME_SIZE ? name : "?");
    return dmb_model_fail(model, DMB_ERR_ID, word, text.text);
}

int32_t dmb_model_find(const dmb_model *model, int32_t kind, const char *name, dmb_id *part)
{
    uint32_t found = DMB_NONE, found_kind = 0;
    if (model == NULL || name == NULL || part == NULL) return dmb_model_failed(model, "find", DMB_ERR_NULL);
    if (!dmb_handle_is(model, DMB_HANDLE_MODEL)) return dmb_model_failed(model, "find", DMB_ERR_HANDLE);
    if (kind < 0 || kind >= KINDS || (kind > 0 && places[kind].word == NULL))
        return dmb_model_failed(model, "find", DMB_ERR_VALUE);
    for (uint32_t k = 1; k < KINDS; ++k) {
        if (places[k].word == NULL || (kind != DMB_PART_ANY && k != (uint32_t)kind)) continue;
        const uint32_t index = find_in(model, k, name);
        if (index == DMB_NONE) continue;
        if (found != DMB_NONE)
            return dmb_model_fail(model, DMB_ERR_VALUE, "find",
                                  "find: parts of two kinds have this name; give the kind");
        found = index;
        found_kind = k;
    }
    if (found == DMB_NONE) return dmb_model_refuse_name(model, kind == DMB_PART_ANY ? "part" : places[kind].word, name);
    *part = dmb_model_id(model, found_kind, found);
    return DMB_OK;
}

int32_t dmb_model_part(const dmb_model *model, uint32_t index, dmb_id *part)
{
    uint32_t kind, number;
    if (model == NULL || part == NULL) return dmb_model_failed(model, "find", DMB_ERR_NULL);
    if (!dmb_handle_is(model, DMB_HANDLE_MODEL)) return dmb_model_failed(model, "find", DMB_ERR_HANDLE);
    const dmb_id found = {index, model->stamp};
    if (read_id(model, found, &kind, &number) < 0) return dmb_model_failed(model, "find", DMB_ERR_ID);
    *part = found;
    return DMB_OK;
}

int32_t dmb_model_find_pipes(const dmb_model *model, const char *name, dmb_id *string, uint32_t *first, uint32_t *count)
{
    if (model == NULL || name == NULL) return dmb_model_failed(model, "find", DMB_ERR_NULL);
    if (!dmb_handle_is(model, DMB_HANDLE_MODEL)) return dmb_model_failed(model, "find", DMB_ERR_HANDLE);
    const uint32_t found = find_run(model, name);
    if (found == DMB_NONE) return dmb_model_refuse_name(model, "run of pipes", name);
    const dmb_pipe_run *run = DMB_LIST_AT(const dmb_pipe_run, model->runs, found);
    if (string != NULL) *string = dmb_model_id(model, DMB_PART_STRING, run->string);
    if (first != NULL) *first = run->first;
    if (count != NULL) *count = run->count;
    return DMB_OK;
}
