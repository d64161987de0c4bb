/* The scene record: the description of a model as bytes that are the same for all machines, without pointers and struct
 * layout. Numbers are little-endian: u32, u64, and f64 by its 64 bits of IEEE 754.
 *
 *     header   "DMBMODEL", u32 version, u32 flags, u64 length of all, u32 checksum (CRC-32 of all but itself), u32 0
 *     entry    u32 number, u32 count, u32 structs, then the structs
 *     struct   u32 fields; each: u32 number, u32 elements, the elements
 *
 * Numbers of entries and fields are those of fields/lists.h; count is that of dmb_model_add_pipes, else 1. An element
 * is f64, u32 (int32_t in two's complement), a byte of a text, an id (u32 kind << 24 | index, 0: none), a place (id,
 * u32 pipe, f64 fraction) or an output (place, u32 quantity). Two entries have no structs: NAME (count: id of a time
 * function) with DMB_NAME_SIZE bytes, and CONTINUES (count: string; structs: the string that continues it after a sub).
 * Parts stand in an order in which each comes after those it refers to, so that the public calls read them again. */
#include <string.h>

#include "base/memory.h"
#include "base/sized_struct.h"
#include "model/describe.h"

enum { VERSION = 1, HEADER = 32, CHECKSUM_AT = 24, NAME = 1000, CONTINUES = 1001, SEGMENTS_MAX = 64, FIELDS_MAX = 64 };
enum { PLACED_WITHOUT_HOLE = 1 }; /* flags */
static const char magic[8] = {'D', 'M', 'B', 'M', 'O', 'D', 'E', 'L'};

/* CRC-32 of ISO 3309, x^32 + x^26 + ... + 1 reflected, over all but the checksum itself. */
static uint32_t checksum(const unsigned char *bytes, size_t size)
{
    uint32_t rest = UINT32_MAX;
    for (size_t i = 0; i < size; ++i) {
        if (i >= CHECKSUM_AT && i < CHECKSUM_AT + 4) continue;
        rest ^= bytes[i];
        for (int bit = 0; bit < 8; ++bit) rest = (rest >> 1) ^ (UINT32_C(0xEDB88320) & (0u - (rest & 1u)));
    }
    return ~rest;
}

/* ---- Writing ----------------------------------------------------------------------------------------------------- */

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
        put_head(w, NAME, (uint32_t)DMB_PART_TIME_FUNCTION << DMB_KIND_SHIFT | named->time_function, 0);
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
        if (by > 0) put_head(w, CONTINUES, i, by - 1);
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
    if (model->constraints.count == 0 && model->forces.count == 0) return DMB_OK;
    dmb_message_set(message, "scene record: %s 0 is a function of the caller, which no record holds; leave it out",
                    model->forces.count > 0 ? "force" : "constraint");
    return DMB_ERR_UNSUPPORTED;
}
#undef DMB_PUT

/* Writes at CHECKSUM_AT and before, for which there is room. */
static void put_header(writer *w, size_t length)
{
    w->size = 0;
    for (size_t i = 0; i < sizeof magic; ++i) put(w, (unsigned char)magic[i], 1);
    put_u32(w, VERSION);
    put_u32(w, w->model->placed_without_hole ? PLACED_WITHOUT_HOLE : 0);
    put(w, length, 8);
    put(w, 0, HEADER - CHECKSUM_AT);
}

int32_t dmb_model_write(const dmb_model *model, void *bytes, size_t room, size_t *size)
{
    dmb_message message;
    if (model == NULL || size == NULL || (bytes == NULL && room > 0))
        return dmb_model_told(model, "model", DMB_ERR_NULL);
    if (!dmb_handle_is(model, DMB_HANDLE_MODEL)) return dmb_model_told(model, "model", DMB_ERR_HANDLE);
    writer w = {bytes, room, HEADER, model, NULL};
    int32_t status = dmb_refused_check(&model->refused, &message);
    if (status >= 0) status = put_parts(&w, &message);
    if (status < 0) return dmb_model_fail(model, status, "scene record", message.text);
    *size = w.size;
    if (bytes == NULL) return DMB_OK;
    if (room < *size) {
        dmb_message_set(&message, "scene record: %zu bytes of room, must be >= %zu", room, *size);
        return dmb_model_fail(model, DMB_ERR_TOO_LARGE, "scene record", message.text);
    }
    put_header(&w, *size);
    const uint32_t sum = checksum(bytes, *size);
    w.size = CHECKSUM_AT;
    put_u32(&w, sum);
    return DMB_OK;
}

/* ---- Reading ----------------------------------------------------------------------------------------------------- */

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
    if (number == NAME) {
        set_name(r, count);
    } else if (number == CONTINUES) {
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
    const int is_record = r->size >= HEADER && memcmp(r->bytes, magic, sizeof magic) == 0;
    if (!is_record) refuse(r, "has no header: this is no scene record, or none of this kind of file");
    r->at = is_record ? sizeof magic : 0;
    const uint32_t version = get_u32(r), flags = get_u32(r);
    const uint64_t length = get(r, 8);
    const uint32_t sum = get_u32(r), zero = get_u32(r);
    if (r->status >= 0 && (length != r->size || zero != 0 || sum != checksum(r->bytes, r->size)))
        refuse(r, "has a wrong length or checksum");
    if (r->status >= 0 && (version != VERSION || flags > PLACED_WITHOUT_HOLE)) {
        r->status = DMB_ERR_UNSUPPORTED;
        dmb_message_set(&r->message,
                        "scene record: version %u, must be %d; use the version of the library that wrote it", version,
                        VERSION);
    }
    return flags;
}

static void get_parts(reader *r)
{
    const uint32_t flags = get_header(r);
    while (r->status >= 0 && r->at < r->size) get_entry(r);
    if (r->status < 0) return;
    r->model->placed_without_hole = flags & PLACED_WITHOUT_HOLE;
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
