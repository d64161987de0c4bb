/* Reads a scene record (model/record.h) into a new model, part by part by the public calls. */
#include <string.h>

#include "base/memory.h"
#include "base/sized_struct.h"
#include "model/describe.h"
#include "model/record.h"

enum { SEGMENTS_MAX = 64, FIELDS_MAX = 64 };

typedef struct reader {
    const unsigned char *bytes;
    size_t size, at;
    dmb_model *model;
    double *numbers; /* behind pointers of the structs of one entry */
    size_t used;     /* of them */
    int32_t status;  /* DMB_OK, or the first failure, with its message */
    dmb_message message;
    dmb_segment segments[SEGMENTS_MAX];
} reader;

static void refuse(reader *r, const char *what)
{
    if (r->status < 0) return;
    r->status = DMB_ERR_VALUE;
    dmb_message_set(&r->message, "scene record: %s at byte %zu; the record is damaged, write it again", what, r->at);
}

static uint64_t get(reader *r, unsigned width)
{
    uint64_t value = 0;
    if (r->size - r->at < width) refuse(r, "ends in a number");
    if (r->status < 0) return 0;
    for (unsigned i = 0; i < width; ++i) value |= (uint64_t)r->bytes[r->at++] << 8 * i;
    return value;
}

static uint32_t get_u32(reader *r)
{
    return (uint32_t)get(r, 4);
}

static double get_real(reader *r)
{
    const uint64_t bits = get(r, 8);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static dmb_id get_id(reader *r)
{
    const uint32_t index = get_u32(r);
    return (dmb_id){index, index == 0 ? 0 : r->model->stamp};
}

static dmb_place get_place(reader *r)
{
    const dmb_id part = get_id(r);
    const uint32_t pipe = get_u32(r);
    return dmb_station(part, pipe, get_real(r));
}

/* One element to where it belongs. */
static void get_element(reader *r, const dmb_def_field *field, char *at)
{
    if (field->type == DMB_TYPE_REAL || field->type == DMB_TYPE_REALS) {
        const double value = get_real(r);
        memcpy(at, &value, sizeof value);
    } else if (field->type == DMB_TYPE_TEXT) {
        *at = (char)get(r, 1);
    } else if (field->type == DMB_TYPE_ID) {
        const dmb_id id = get_id(r);
        memcpy(at, &id, sizeof id);
    } else if (field->type == DMB_TYPE_PLACE) {
        const dmb_place place = get_place(r);
        memcpy(at, &place, sizeof place);
    } else if (field->type == DMB_TYPE_OUTPUT) {
        const dmb_place place = get_place(r);
        const dmb_output output = {place, (int32_t)get_u32(r), 0};
        memcpy(at, &output, sizeof output);
    } else {
        const uint32_t word = get_u32(r);
        memcpy(at, &word, sizeof word);
    }
}

/* Where the elements of a field go: into the struct, or behind its pointer. Each number takes 8 bytes of the record, so
 * that there is room for as many as it has. NULL: too many. */
static char *room_for(reader *r, const dmb_def_field *field, void *def, size_t count)
{
    char *at = (char *)def + field->offset;
    if (field->type != DMB_TYPE_REALS) return count <= field->size / dmb_field_element_size(field) ? at : NULL;
    if (count > (r->size - r->at) / sizeof(double)) return NULL;
    const double *numbers = count > 0 ? r->numbers + r->used : NULL;
    memcpy(at, &numbers, sizeof numbers);
    r->used += count;
    return count > 0 ? (char *)(r->numbers + r->used - count) : at;
}

static const dmb_def_field *find_field(const dmb_field_list *list, uint32_t number)
{
    for (uint32_t i = 0; i < list->count; ++i)
        if (list->fields[i].number == number) return &list->fields[i];
    return NULL;
}

static void get_field(reader *r, const dmb_field_list *list, void *def, size_t given[FIELDS_MAX])
{
    const uint32_t number = get_u32(r), count = get_u32(r);
    const dmb_def_field *field = find_field(list, number);
    if (r->status < 0) return;
    if (field == NULL || field->type == DMB_TYPE_POINTER) {
        r->status = DMB_ERR_UNSUPPORTED;
        dmb_message_set(&r->message,
                        "scene record: field %u of a %s at byte %zu is not known to this version (%u); use the version "
                        "that wrote the record, or a newer one",
                        number, list->word, r->at, dmb_version());
        return;
    }
    if (given[number] > 0) refuse(r, "has a field twice");
    char *at = r->status < 0 ? NULL : room_for(r, field, def, count);
    if (at == NULL) refuse(r, "has more elements than its field");
    given[number] = count;
    for (size_t i = 0; i < count && r->status >= 0; ++i) get_element(r, field, at + i * dmb_field_element_size(field));
}

/* A struct with the defaults and the fields that the record has; arrays behind pointers are as long as their counts. */
static void get_struct(reader *r, const dmb_field_list *list, void *def)
{
    size_t given[FIELDS_MAX] = {0};
    memcpy(def, list->defaults, list->size);
    memcpy(def, &list->size, sizeof list->size);
    const uint32_t fields = get_u32(r);
    for (uint32_t i = 0; i < fields && r->status >= 0; ++i) get_field(r, list, def, given);
    for (uint32_t i = 0; i < list->count; ++i) {
        const dmb_def_field *field = &list->fields[i];
        if (field->type == DMB_TYPE_REALS && dmb_field_elements(field, def) != given[field->number])
            refuse(r, "has a table of another length than its count");
    }
}

#define DMB_ADDED(call, T)                                                 \
    case T##_index:                                                        \
        get_struct(r, list, &def.of_##T);                                  \
        if (r->status >= 0) r->status = call(r->model, &def.of_##T, NULL); \
        break;
#define DMB_ADDS(X)                                 \
    X(dmb_model_add_wall, dmb_wall_def)             \
    X(dmb_model_add_string, dmb_string_def)         \
    X(dmb_model_add_stabiliser, dmb_stabiliser_def) \
    X(dmb_model_add_body, dmb_body_def)             \
    X(dmb_model_add_bit, dmb_bit_def)               \
    X(dmb_model_add_joint, dmb_joint_def)           \
    X(dmb_model_add_coupling, dmb_coupling_def)     \
    X(dmb_model_add_drive, dmb_drive_def)           \
    X(dmb_model_add_load, dmb_load_def)             \
    X(dmb_model_add_spring, dmb_spring_def)         \
    X(dmb_model_add_stuck, dmb_stuck_def)           \
    X(dmb_model_add_input, dmb_input_def)           \
    X(dmb_model_add_event, dmb_event_def)
#define DMB_MEMBER(call, T) T of_##T;

/* One part by the public call that adds it. */
static void add_part(reader *r, const dmb_field_list *list, uint32_t count)
{
    union {
        dmb_environment_def environment;
        dmb_hole_section section;
        dmb_pipe_def pipe;
        DMB_ADDS(DMB_MEMBER)
    } def;
    switch (list - dmb_field_lists) {
        DMB_ADDS(DMB_ADDED)
    case dmb_environment_def_index:
        get_struct(r, list, &def.environment);
        if (r->status >= 0) r->status = dmb_model_set_environment(r->model, &def.environment);
        break;
    case dmb_hole_section_index:
        get_struct(r, list, &def.section);
        if (r->status >= 0) r->status = dmb_model_add_hole_sections(r->model, &def.section, 1);
        break;
    case dmb_pipe_def_index:
        get_struct(r, list, &def.pipe);
        if (r->status >= 0) r->status = dmb_model_add_pipes(r->model, &def.pipe, count, NULL);
        break;
    default: refuse(r, "has a part that no record holds");
    }
}

static void add_time_function(reader *r, uint32_t count)
{
    if (count < 1 || count > SEGMENTS_MAX) refuse(r, "has a time function of no or too many segments");
    for (uint32_t i = 0; i < count && r->status >= 0; ++i) get_struct(r, DMB_FIELDS_OF(dmb_segment), &r->segments[i]);
    if (r->status >= 0) r->status = dmb_model_add_time_function(r->model, r->segments, count, NULL);
}

static void set_name(reader *r, uint32_t index)
{
    char name[DMB_NAME_SIZE];
    for (int i = 0; i < DMB_NAME_SIZE; ++i) name[i] = (char)get(r, 1);
    if (name[DMB_NAME_SIZE - 1] != '\0') refuse(r, "has a name without end");
    if (r->status >= 0) r->status = dmb_model_set_name(r->model, (dmb_id){index, r->model->stamp}, name);
}

static void set_continued(reader *r, uint32_t string, uint32_t by)
{
    const uint32_t count = r->model->strings.count;
    if (string >= count || by >= count || by <= string) refuse(r, "has a string that continues none");
    if (r->status >= 0) DMB_LIST_AT(dmb_string_plan, r->model->strings, string)->continued = 1 + by;
}

static void get_entry(reader *r)
{
    const uint32_t number = get_u32(r), count = get_u32(r), structs = get_u32(r);
    dmb_message_clear(&r->message);
    r->used = 0;
    if (r->status < 0) return;
    if (number == DMB_RECORD_NAME) {
        set_name(r, count);
    } else if (number == DMB_RECORD_CONTINUES) {
        set_continued(r, count, structs);
    } else if (number < 1 || number > DMB_FIELD_LISTS) {
        r->status = DMB_ERR_UNSUPPORTED;
        dmb_message_set(&r->message, "scene record: part of kind %u at byte %zu is not known to this version (%u)",
                        number, r->at, dmb_version());
    } else if (number == dmb_field_lists[dmb_segment_index].number) {
        add_time_function(r, structs);
    } else {
        if (structs != 1) refuse(r, "has several structs of one part");
        if (r->status >= 0) add_part(r, &dmb_field_lists[number - 1], count);
    }
}

static uint32_t get_header(reader *r)
{
    const int is_record =
        r->size >= DMB_RECORD_HEADER && memcmp(r->bytes, dmb_record_magic, sizeof dmb_record_magic) == 0;
    if (!is_record) refuse(r, "has no header: this is no scene record, or none of this kind of file");
    r->at = is_record ? sizeof dmb_record_magic : 0;
    const uint32_t version = get_u32(r), flags = get_u32(r);
    const uint64_t length = get(r, 8);
    const uint32_t sum = get_u32(r), zero = get_u32(r);
    if (r->status >= 0 && (length != r->size || zero != 0 || sum != dmb_record_checksum(r->bytes, r->size)))
        refuse(r, "has a wrong length or checksum");
    if (r->status >= 0 && (version != DMB_RECORD_VERSION || flags > DMB_RECORD_PLACED_WITHOUT_HOLE)) {
        r->status = DMB_ERR_UNSUPPORTED;
        dmb_message_set(&r->message,
                        "scene record: version %u, must be %d; use the version of the library that wrote it", version,
                        DMB_RECORD_VERSION);
    }
    return flags;
}

static void get_parts(reader *r)
{
    const uint32_t flags = get_header(r);
    while (r->status >= 0 && r->at < r->size) get_entry(r);
    if (r->status < 0) return;
    r->model->placed_without_hole = flags & DMB_RECORD_PLACED_WITHOUT_HOLE;
}

/* The first failure is that of the record, or of the call whose part it was. */
static int32_t read_into(dmb_model *model, const void *bytes, size_t size, dmb_message *message)
{
    reader *r = dmb_allocate(&model->allocator, sizeof *r);
    if (r == NULL) return DMB_ERR_NO_MEMORY;
    *r = (reader){.bytes = bytes, .size = size, .model = model};
    r->numbers = dmb_allocate(&model->allocator, size + sizeof(double));
    if (r->numbers == NULL)
        r->status = DMB_ERR_NO_MEMORY;
    else
        get_parts(r);
    const int32_t status = r->status;
    const int own = r->message.text[0] != '\0';
    if (status < 0)
        dmb_message_set(message, own ? "%s" : "scene record: %s", own ? r->message.text : dmb_model_message(model));
    if (r->numbers != NULL) dmb_release(&model->allocator, r->numbers, size + sizeof(double));
    dmb_release(&model->allocator, r, sizeof *r);
    return status;
}

int32_t dmb_model_read(const void *bytes, size_t size, const dmb_model_options *options, dmb_model **model)
{
    dmb_message message;
    dmb_message_set(&message, "scene record: %s", dmb_status_text(DMB_ERR_NO_MEMORY));
    if (model != NULL) *model = NULL;
    if (bytes == NULL || model == NULL) return dmb_failure(NULL, NULL, DMB_ERR_NULL, "scene record", NULL);
    if (size > UINT32_MAX / 2) return dmb_failure(NULL, NULL, DMB_ERR_TOO_LARGE, "scene record", NULL);
    dmb_model *made;
    int32_t status = dmb_model_create(options, &made);
    if (status < 0) return status;
    const dmb_error_handler handler = made->on_error;
    made->on_error = (dmb_error_handler){NULL, NULL}; /* it sees the failure of this call, not that of a part */
    status = read_into(made, bytes, size, &message);
    made->on_error = handler;
    if (status >= 0) {
        *model = made;
        return DMB_OK;
    }
    dmb_model_destroy(&made);
    return dmb_failure(NULL, &handler, status, "scene record", message.text);
}
