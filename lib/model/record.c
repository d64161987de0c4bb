#include "model/record.h"

#include <string.h>

#include "base/sized_struct.h"
#include "model/describe.h"

const char dmb_record_magic[8] = {'D', 'M', 'B', 'M', 'O', 'D', 'E', 'L'};

uint32_t dmb_record_checksum(const unsigned char *bytes, size_t size)
{
    uint32_t rest = UINT32_MAX;
    for (size_t i = 0; i < size; ++i) {
        if (i >= DMB_RECORD_CHECKSUM_AT && i < DMB_RECORD_CHECKSUM_AT + 4) continue;
        rest ^= bytes[i];
        for (int bit = 0; bit < 8; ++bit) rest = (rest >> 1) ^ (UINT32_C(0xEDB88320) & (0u - (rest & 1u)));
    }
    return ~rest;
}

typedef struct writer {
    unsigned char *bytes;
    size_t room, size; /* size counts on where there is no room */
    const dmb_model *model;
    const dmb_spring_plan *spring; /* whose table the model has in its own form; NULL: another part */
} writer;

static void put(writer *w, uint64_t value, unsigned width)
{
    for (unsigned i = 0; i < width; ++i, ++w->size)
        if (w->size < w->room) w->bytes[w->size] = (unsigned char)(value >> 8 * i);
}

static void put_u32(writer *w, uint32_t value)
{
    put(w, value, 4);
}

static void put_real(writer *w, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put(w, bits, 8);
}

static void put_place(writer *w, const dmb_place *place)
{
    put_u32(w, place->part.index);
    put_u32(w, place->pipe);
    put_real(w, place->fraction);
}

static double real_at(const writer *w, const dmb_def_field *field, const void *def, size_t i)
{
    if (w->spring == NULL || field->type != DMB_TYPE_REALS) return dmb_field_number(field, def, i);
    const dmb_spring_point *point = &w->spring->points[i];
    return field->offset == offsetof(dmb_spring_def, table_elongation) ? point->elongation : point->force;
}

static void put_element(writer *w, const dmb_def_field *field, const void *def, size_t i)
{
    const char *at = (const char *)def + field->offset + i * dmb_field_element_size(field);
    uint32_t word;
    switch (field->type) {
    case DMB_TYPE_REAL:
    case DMB_TYPE_REALS: put_real(w, real_at(w, field, def, i)); break;
    case DMB_TYPE_TEXT: put(w, (unsigned char)*at, 1); break;
    case DMB_TYPE_PLACE: put_place(w, (const dmb_place *)(const void *)at); break;
    case DMB_TYPE_OUTPUT:
        put_place(w, &((const dmb_output *)(const void *)at)->place);
        put_u32(w, (uint32_t)((const dmb_output *)(const void *)at)->quantity);
        break;
    default: /* whole numbers, and ids by their index */ memcpy(&word, at, sizeof word); put_u32(w, word);
    }
}

static void put_struct(writer *w, const dmb_field_list *list, const void *def)
{
    uint32_t fields = 0;
    for (uint32_t i = 0; i < list->count; ++i) fields += list->fields[i].type != DMB_TYPE_POINTER;
    put_u32(w, fields);
    for (uint32_t i = 0; i < list->count; ++i) {
        const dmb_def_field *field = &list->fields[i];
        if (field->type == DMB_TYPE_POINTER) continue;
        const size_t count = dmb_field_elements(field, def);
        put_u32(w, field->number);
        put_u32(w, (uint32_t)count);
        for (size_t k = 0; k < count; ++k) put_element(w, field, def, k);
    }
}

static void put_head(writer *w, uint32_t number, uint32_t count, uint32_t structs)
{
    put_u32(w, number);
    put_u32(w, count);
    put_u32(w, structs);
}

static void put_part(writer *w, const dmb_field_list *list, const void *def, uint32_t count)
{
    put_head(w, list->number, count, 1);
    put_struct(w, list, def);
}

/* The parts of a list of definitions, or of plans that begin with one. */
static void put_list(writer *w, const dmb_field_list *list, const dmb_list *parts, size_t item)
{
    for (uint32_t i = 0; i < parts->count; ++i) put_part(w, list, (const char *)parts->items + i * item, 1);
}

static int32_t put_time_functions(writer *w, dmb_message *message)
{
    const dmb_list *list = &w->model->time_functions;
    for (uint32_t i = 0; i < list->count; ++i) {
        const dmb_time_function *function = DMB_LIST_AT(const dmb_time_function, *list, i);
        put_head(w, dmb_field_lists[dmb_segment_index].number, 1, function->count);
        for (uint32_t k = 0; k < function->count; ++k) {
            put_struct(w, DMB_FIELDS_OF(dmb_segment), &function->segments[k]);
            if (function->segments[k].kind != DMB_SEGMENT_CALLBACK) continue;
            dmb_message_set(message,
                            "scene record: segment %u of time function %u is a function of the caller, which no record "
                            "holds; give it as a table",
                            k, i);
            return DMB_ERR_UNSUPPORTED;
        }
    }
    for (uint32_t i = 0; i < w->model->names.count; ++i) {
        const dmb_time_function_name *named = DMB_LIST_AT(const dmb_time_function_name, w->model->names, i);
        put_head(w, DMB_RECORD_NAME, (uint32_t)DMB_PART_TIME_FUNCTION << DMB_KIND_SHIFT | named->time_function, 0);
        for (int k = 0; k < DMB_NAME_SIZE; ++k) put(w, (unsigned char)named->name[k], 1);
    }
    return DMB_OK;
}

static void put_strings(writer *w)
{
    const dmb_model *model = w->model;
    put_list(w, DMB_FIELDS_OF(dmb_string_def), &model->strings, sizeof(dmb_string_plan));
    for (uint32_t i = 0; i < model->runs.count; ++i) {
        const dmb_pipe_run *run = DMB_LIST_AT(const dmb_pipe_run, model->runs, i);
        put_part(w, DMB_FIELDS_OF(dmb_pipe_def), &run->def, run->count);
    }
}

static void put_springs(writer *w)
{
    for (uint32_t i = 0; i < w->model->springs.count; ++i) {
        w->spring = DMB_LIST_AT(const dmb_spring_plan, w->model->springs, i);
        put_part(w, DMB_FIELDS_OF(dmb_spring_def), &w->spring->def, 1);
    }
    w->spring = NULL;
}

static void put_continued(writer *w)
{
    for (uint32_t i = 0; i < w->model->strings.count; ++i) {
        const uint32_t by = DMB_LIST_AT(const dmb_string_plan, w->model->strings, i)->continued;
        if (by > 0) put_head(w, DMB_RECORD_CONTINUES, i, by - 1);
    }
}

#define DMB_PUT(T, list) put_list(w, DMB_FIELDS_OF(T), &model->list, sizeof(T))
static int32_t put_parts(writer *w, dmb_message *message)
{
    const dmb_model *model = w->model;
    put_part(w, DMB_FIELDS_OF(dmb_environment_def), &model->environment, 1);
    if (model->wall_count > 0) put_part(w, DMB_FIELDS_OF(dmb_wall_def), &model->wall, 1);
    DMB_PUT(dmb_hole_section, sections);
    const int32_t status = put_time_functions(w, message);
    if (status < 0) return status;
    put_strings(w);
    DMB_PUT(dmb_stabiliser_def, rings);
    DMB_PUT(dmb_body_def, bodies);
    DMB_PUT(dmb_bit_def, bits);
    DMB_PUT(dmb_joint_def, joints);
    DMB_PUT(dmb_coupling_def, couplings);
    DMB_PUT(dmb_drive_def, drives);
    DMB_PUT(dmb_load_def, loads);
    put_springs(w);
    DMB_PUT(dmb_stuck_def, stuck);
    DMB_PUT(dmb_input_def, inputs);
    DMB_PUT(dmb_event_def, events);
    put_continued(w);
    if (model->wall_count > 0 && model->wall.friction_law == DMB_FRICTION_CALLBACK) {
        dmb_message_set(message, "scene record: wall: friction_callback is a function of the caller, which no record "
                                 "holds; take another friction_law");
        return DMB_ERR_UNSUPPORTED;
    }
    if (model->constraints.count == 0 && model->forces.count == 0) return DMB_OK;
    dmb_message_set(message, "scene record: %s 0 is a function of the caller, which no record holds; leave it out",
                    model->forces.count > 0 ? "force" : "constraint");
    return DMB_ERR_UNSUPPORTED;
}
#undef DMB_PUT

/* Writes at DMB_RECORD_CHECKSUM_AT and before, for which there is room. */
static void put_header(writer *w, size_t length)
{
    w->size = 0;
    for (size_t i = 0; i < sizeof dmb_record_magic; ++i) put(w, (unsigned char)dmb_record_magic[i], 1);
    put_u32(w, DMB_RECORD_VERSION);
    put_u32(w, w->model->placed_without_hole ? DMB_RECORD_PLACED_WITHOUT_HOLE : 0);
    put(w, length, 8);
    put(w, 0, DMB_RECORD_HEADER - DMB_RECORD_CHECKSUM_AT);
}

/* All but the header, with as much of it as there is room for. */
static int32_t put_record(writer *w, dmb_message *message)
{
    const int32_t status = dmb_refused_check(&w->model->refused, message);
    w->size = DMB_RECORD_HEADER;
    return status < 0 ? status : put_parts(w, message);
}

/* The length is found first, so that a call that fails writes nothing. */
int32_t dmb_model_write(const dmb_model *model, void *bytes, size_t room, size_t *size)
{
    dmb_message message;
    if (model == NULL || size == NULL || (bytes == NULL && room > 0))
        return dmb_model_failed(model, "scene record", DMB_ERR_NULL);
    if (!dmb_handle_is(model, DMB_HANDLE_MODEL)) return dmb_model_failed(model, "scene record", DMB_ERR_HANDLE);
    writer w = {NULL, 0, 0, model, NULL};
    const int32_t status = put_record(&w, &message);
    const size_t length = w.size;
    if (status < 0) return dmb_model_fail(model, status, "scene record", message.text);
    if (bytes != NULL && room < length) {
        dmb_message_set(&message, "scene record: room = %zu bytes, must be >= %zu", room, length);
        return dmb_model_fail(model, DMB_ERR_TOO_LARGE, "scene record", message.text);
    }
    *size = length;
    if (bytes == NULL) return DMB_OK;
    w.bytes = bytes;
    w.room = length;
    (void)put_record(&w, &message);
    put_header(&w, length);
    const uint32_t sum = dmb_record_checksum(bytes, length);
    w.size = DMB_RECORD_CHECKSUM_AT;
    put_u32(&w, sum);
    return DMB_OK;
}
