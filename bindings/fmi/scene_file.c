#include "scene_file.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LARGEST_FILE = 1 << 30 };

static int refuse(scene_file *scene, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(scene->message, sizeof scene->message, format, arguments);
    va_end(arguments);
    return -1;
}

static int read_bytes(scene_file *scene, const char *path, FILE *file)
{
    if (fseek(file, 0, SEEK_END) != 0) return refuse(scene, "scene refused: %s cannot be read", path);
    const long size = ftell(file);
    if (size < (long)sizeof(scene_header) || size > LARGEST_FILE || size % 8 != 0)
        return refuse(scene,
                      "scene refused: %s has %ld bytes, must be a multiple of 8 in %zu .. %d; export the unit anew",
                      path, size, sizeof(scene_header), LARGEST_FILE);
    rewind(file);
    scene->size = (uint64_t)size;
    scene->bytes = malloc((size_t)size);
    if (!scene->bytes) return refuse(scene, "scene refused: no memory for the %ld bytes of %s", size, path);
    if (fread(scene->bytes, 1, (size_t)size, file) != (size_t)size)
        return refuse(scene, "scene refused: %s cannot be read", path);
    return 0;
}

static int check_header(scene_file *scene, const char *path)
{
    const scene_header *header = (const scene_header *)scene->bytes;
    if (memcmp(header->magic, SCENE_MAGIC, sizeof header->magic) != 0)
        return refuse(scene, "scene refused: %s does not begin with " SCENE_MAGIC "; export the unit anew", path);
    if (header->format != SCENE_FORMAT || header->layout != SCENE_LAYOUT || sizeof(void *) != SCENE_LAYOUT)
        return refuse(scene,
                      "scene refused: %s has format %u and pointers of %u bytes, must be %d and %d; export the unit "
                      "by the version that this library is of",
                      path, header->format, header->layout, SCENE_FORMAT, SCENE_LAYOUT);
    const uint32_t found = scene_checksum(header->token, scene->size - sizeof *header + sizeof header->token);
    if (header->length != scene->size || header->checksum != found || header->reserved != 0 ||
        !memchr(header->token, 0, sizeof header->token))
        return refuse(scene, "scene refused: %s is damaged, checksum %08x, must be %08x; export the unit anew", path,
                      found, header->checksum);
    return 0;
}

/* ---- Pointers and ids of structs ----------------------------------------------------------------------------------
 */
typedef struct pointer_field {
    const char *call;
    size_t pointer, count, width; /* offsets; width 0: always NULL */
} pointer_field;

#define ARRAY_FIELD(call, type, pointer, count, width) {#call, offsetof(type, pointer), offsetof(type, count), width},
#define NULL_FIELD(call, type, pointer) {#call, offsetof(type, pointer), 0, 0},
static const pointer_field pointer_fields[] = {SCENE_ARRAYS(ARRAY_FIELD) SCENE_NULLS(NULL_FIELD)};

typedef struct open_record {
    const scene_record *head;
    unsigned char *structs;
    const uint32_t *ids; /* pairs */
    const double *doubles;
} open_record;

/* Points the struct's arrays at the numbers that are left; how many are left then, or -1 where they are too few. */
static int64_t set_pointers(const open_record *record, unsigned char *one, int64_t left)
{
    for (size_t i = 0; i < sizeof pointer_fields / sizeof *pointer_fields; ++i) {
        const pointer_field *field = &pointer_fields[i];
        if (strcmp(field->call, record->head->call) != 0) continue;
        uint32_t count = 0;
        const double *array = NULL;
        if (field->width > 0) memcpy(&count, one + field->count, sizeof count);
        const int64_t numbers = (int64_t)count * (int64_t)field->width;
        if (numbers > left) return -1;
        if (numbers > 0) array = record->doubles + (record->head->doubles - left);
        memcpy(one + field->pointer, &array, sizeof array);
        left -= numbers;
    }
    return left;
}

/* Ids were given out by another model of the same calls: they get the stamp of this one. */
static int set_ids(const scene_file *scene, const open_record *record)
{
    const scene_record *head = record->head;
    for (uint32_t i = 0; i < head->ids; ++i) {
        const uint32_t number = record->ids[2 * i], offset = record->ids[2 * i + 1];
        if (number >= head->structs || offset % 4 != 0 || offset > head->struct_size - sizeof(dmb_id)) return -1;
        unsigned char *id = record->structs + (size_t)number * head->struct_size + offset;
        memcpy(id + offsetof(dmb_id, generation), &scene->generation, sizeof scene->generation);
    }
    return 0;
}

static int complete_structs(scene_file *scene, const open_record *record)
{
    const scene_record *head = record->head;
    int64_t left = head->doubles;
    int fits = set_ids(scene, record) == 0;
    for (uint32_t i = 0; fits && i < head->structs; ++i) {
        unsigned char *one = record->structs + (size_t)i * head->struct_size;
        left = set_pointers(record, one, left);
        fits = left >= 0 && memcmp(one, &head->struct_size, sizeof head->struct_size) == 0;
    }
    if (!fits || left != 0)
        return refuse(scene, "scene refused: ids or arrays of a call %s do not fit its structs; export the unit anew",
                      head->call);
    return 0;
}

/* The next record, *at moved beyond it. */
static int next_record(scene_file *scene, uint64_t *at, open_record *record)
{
    const uint64_t left = scene->size - *at;
    const scene_record *head = (const scene_record *)((const unsigned char *)scene->bytes + *at);
    record->head = head;
    int fits = left >= sizeof *head && memchr(head->call, 0, sizeof head->call);
    uint64_t size = 0;
    if (fits) {
        const uint64_t structs = (uint64_t)head->structs * head->struct_size;
        size = sizeof *head + structs + 8u * (uint64_t)head->ids + 8u * (uint64_t)head->doubles;
        fits = head->struct_size % 8 == 0 && head->struct_size >= sizeof(dmb_id) && head->structs > 0 &&
               structs <= left && size <= left;
    }
    if (!fits) {
        refuse(scene, "scene refused: a record at byte %llu is cut; export the unit anew", (unsigned long long)*at);
        return -1;
    }
    record->structs = (unsigned char *)scene->bytes + *at + sizeof *head;
    record->ids = (const uint32_t *)(const void *)(record->structs + (size_t)head->structs * head->struct_size);
    record->doubles = (const double *)(const void *)(record->ids + 2u * (size_t)head->ids);
    *at += size;
    return complete_structs(scene, record);
}

/* ---- Calls --------------------------------------------------------------------------------------------------------
 */
static int is_call(const open_record *record, const char *call)
{
    return strcmp(record->head->call, call) == 0;
}

static int has_size(const open_record *record, size_t size)
{
    return record->head->struct_size == size;
}

static int wrong_size(scene_file *scene, const open_record *record)
{
    return refuse(scene,
                  "scene refused: structs of %s have %u bytes, which is not their size in this version (%u); export "
                  "the unit by the same version",
                  record->head->call, record->head->struct_size, dmb_version());
}

static int add_output(scene_file *scene, const open_record *record)
{
    const size_t size = (scene->output_count + 1u) * sizeof(dmb_output);
    dmb_output *grown = realloc(scene->outputs, size);
    if (!grown) return refuse(scene, "scene refused: no memory for %zu bytes of outputs", size);
    scene->outputs = grown;
    scene->outputs[scene->output_count++] = ((const scene_output *)(const void *)record->structs)->noted;
    return 0;
}

/* Settings of the run; -2 where the call is none of these. */
static int settings_call(scene_file *scene, const open_record *record)
{
    const void *one = record->structs;
    if (is_call(record, "sim")) {
        if (!has_size(record, sizeof scene->sim)) return wrong_size(scene, record);
        memcpy(&scene->sim, one, sizeof scene->sim);
    } else if (is_call(record, "static")) {
        if (!has_size(record, sizeof scene->statics)) return wrong_size(scene, record);
        memcpy(&scene->statics, one, sizeof scene->statics);
        scene->has_static = 1;
    } else if (is_call(record, "run")) {
        if (!has_size(record, sizeof(scene_run))) return wrong_size(scene, record);
        scene->step = ((const scene_run *)one)->step;
    } else if (is_call(record, "output")) {
        if (!has_size(record, sizeof(scene_output))) return wrong_size(scene, record);
        return add_output(scene, record);
    } else {
        return -2;
    }
    return 0;
}

/* One way to call them all. */
typedef int32_t (*model_fn)(dmb_model *model, const scene_record *head, const void *structs, dmb_id *id);
#define DEFINITION_FUNCTION(name, type)                                                              \
    static int32_t name(dmb_model *model, const scene_record *head, const void *structs, dmb_id *id) \
    {                                                                                                \
        (void)head;                                                                                  \
        return dmb_model_##name(model, (const type *)structs, id);                                   \
    }
SCENE_DEFINITIONS(DEFINITION_FUNCTION)

static int32_t add_pipes(dmb_model *model, const scene_record *head, const void *structs, dmb_id *id)
{
    return dmb_model_add_pipes(model, structs, head->count, id);
}

static int32_t add_time_function(dmb_model *model, const scene_record *head, const void *structs, dmb_id *id)
{
    return dmb_model_add_time_function(model, structs, head->structs, id);
}

static int32_t add_hole_sections(dmb_model *model, const scene_record *head, const void *structs, dmb_id *id)
{
    (void)id;
    return dmb_model_add_hole_sections(model, structs, head->structs);
}

static int32_t set_environment(dmb_model *model, const scene_record *head, const void *structs, dmb_id *id)
{
    (void)head, (void)id;
    return dmb_model_set_environment(model, structs);
}

static int32_t set_name(dmb_model *model, const scene_record *head, const void *structs, dmb_id *id)
{
    const scene_name *one = structs;
    (void)head, (void)id;
    if (!memchr(one->name, 0, sizeof one->name)) return DMB_ERR_VALUE;
    return dmb_model_set_name(model, one->part, one->name);
}

static int32_t compile(dmb_model *model, const scene_record *head, const void *structs, dmb_id *id)
{
    (void)head, (void)id;
    return dmb_model_compile(model, structs);
}

typedef struct call_entry {
    const char *name;
    size_t struct_size;
    model_fn function;
} call_entry;

#define DEFINITION_ENTRY(name, type) {#name, sizeof(type), name},
static const call_entry calls[] = {SCENE_DEFINITIONS(DEFINITION_ENTRY) /* */
                                   {"add_pipes", sizeof(dmb_pipe_def), add_pipes},
                                   {"add_time_function", sizeof(dmb_segment), add_time_function},
                                   {"add_hole_sections", sizeof(dmb_hole_section), add_hole_sections},
                                   {"set_environment", sizeof(dmb_environment_def), set_environment},
                                   {"set_name", sizeof(scene_name), set_name},
                                   {"compile", sizeof(dmb_compile_options), compile}};

static int model_call(scene_file *scene, const open_record *record)
{
    for (size_t i = 0; i < sizeof calls / sizeof *calls; ++i) {
        if (!is_call(record, calls[i].name)) continue;
        if (!has_size(record, calls[i].struct_size)) return wrong_size(scene, record);
        dmb_id id = {0, 0};
        const int32_t status = calls[i].function(scene->model, record->head, record->structs, &id);
        if (status < 0)
            return refuse(scene, "scene refused: %s: %s", record->head->call, dmb_model_message(scene->model));
        if (id.generation != 0) scene->generation = id.generation;
        return 0;
    }
    return refuse(scene, "scene refused: this version (%u) does not know the call %s; use the library of the exporter",
                  dmb_version(), record->head->call);
}

static int replay(scene_file *scene)
{
    uint64_t at = sizeof(scene_header);
    while (at < scene->size) {
        open_record record = {0};
        if (next_record(scene, &at, &record) != 0) return -1;
        int result = settings_call(scene, &record);
        if (result == -2) result = model_call(scene, &record);
        if (result != 0) return -1;
    }
    return 0;
}

int scene_open(scene_file *scene, const char *path, dmb_log_fn log, void *log_context)
{
    memset(scene, 0, sizeof *scene);
    scene->sim = dmb_sim_options_default();
    FILE *file = fopen(path, "rb");
    if (!file) return refuse(scene, "scene refused: %s cannot be opened; the unit's resources must be unpacked", path);
    const int is_read = read_bytes(scene, path, file);
    fclose(file);
    if (is_read != 0 || check_header(scene, path) != 0) return -1;
    dmb_model_options options = dmb_model_options_default();
    options.log = log;
    options.log_context = log_context;
    if (dmb_model_create(&options, &scene->model) < 0) return refuse(scene, "scene refused: no memory for its model");
    if (replay(scene) != 0) return -1;
    if (!(scene->step >= 0.0 && scene->step <= 1e18))
        return refuse(scene, "scene refused: run, step = %g s, must be 0 .. 1e18; export the unit anew", scene->step);
    dmb_model_info info = dmb_model_info_default();
    if (dmb_model_get_info(scene->model, &info) < 0)
        return refuse(scene, "scene refused: %s has no call compile; export the unit anew", path);
    return 0;
}

const char *scene_token(const scene_file *scene)
{
    return ((const scene_header *)scene->bytes)->token;
}

void scene_close(scene_file *scene)
{
    dmb_model_destroy(&scene->model);
    free(scene->outputs);
    free(scene->bytes);
    memset(scene, 0, sizeof *scene);
}
