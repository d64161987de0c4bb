#include "scene_file.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LARGEST_FILE = 1 << 30, LEAST_OUTPUT = 20 };

typedef struct reader {
    scene_file *scene;
    const char *path;
    unsigned char *bytes;
    size_t size, at; /* [byte] */
    int failed;      /* 1: the first reason is in scene->message */
} reader;

static int refuse(reader *r, const char *format, ...)
{
    va_list arguments;
    if (r->failed) return -1;
    r->failed = 1;
    va_start(arguments, format);
    vsnprintf(r->scene->message, sizeof r->scene->message, format, arguments);
    va_end(arguments);
    return -1;
}

static int read_bytes(reader *r)
{
    FILE *file = fopen(r->path, "rb");
    if (!file) return refuse(r, "scene refused: %s cannot be opened; the unit's resources must be unpacked", r->path);
    const long size = fseek(file, 0, SEEK_END) == 0 ? ftell(file) : -1;
    if (size < SCENE_HEADER + SCENE_TOKEN || size > LARGEST_FILE)
        refuse(r, "scene refused: %s has %ld bytes, must have %d .. %d; export the unit anew", r->path, size,
               SCENE_HEADER + SCENE_TOKEN, LARGEST_FILE);
    r->bytes = r->failed ? NULL : malloc((size_t)size);
    if (!r->bytes) refuse(r, "scene refused: no memory for the %ld bytes of %s", size, r->path);
    rewind(file);
    if (!r->failed && fread(r->bytes, 1, (size_t)size, file) != (size_t)size)
        refuse(r, "scene refused: %s cannot be read", r->path);
    fclose(file);
    r->size = r->failed ? 0 : (size_t)size;
    return r->failed ? -1 : 0;
}

/* ---- Numbers: 0 after a failure ----------------------------------------------------------------------------------
 * As in lib/model/record_read.c, written again: a unit is built from public headers and a library whose internal
 * functions are hidden, and a reader of bytes is no part of the public interface. */
static uint64_t get(reader *r, unsigned width)
{
    uint64_t value = 0;
    if (r->size - r->at < width)
        refuse(r, "scene refused: %s ends within a number at byte %zu; export the unit anew", r->path, r->at);
    if (r->failed) return 0;
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

/* ---- Header ------------------------------------------------------------------------------------------------------ */
static void get_header(reader *r)
{
    if (memcmp(r->bytes, SCENE_MAGIC, 8) != 0)
        refuse(r, "scene refused: %s does not begin with " SCENE_MAGIC "; export the unit anew", r->path);
    r->at = 8;
    const uint32_t format = get_u32(r), flags = get_u32(r);
    const uint64_t length = get(r, 8);
    const uint32_t checksum = get_u32(r), zero = get_u32(r);
    if (!r->failed && (format != SCENE_FORMAT || flags > SCENE_HAS_STATIC))
        refuse(r,
               "scene refused: %s has format %u, flags %u, must be %d, at most %d; export the unit by the version that "
               "this library is of (%u)",
               r->path, format, flags, SCENE_FORMAT, SCENE_HAS_STATIC, dmb_version());
    const uint32_t found = r->failed ? 0 : scene_checksum(r->bytes + SCENE_HEADER, r->size - SCENE_HEADER);
    if (length != r->size || checksum != found || zero != 0 || !memchr(r->bytes + SCENE_HEADER, 0, SCENE_TOKEN))
        refuse(r, "scene refused: %s is damaged, checksum %08x, must be %08x; export the unit anew", r->path, found,
               checksum);
    if (r->failed) return;
    r->scene->settings.has_static = (int)flags;
    memcpy(r->scene->token, r->bytes + SCENE_HEADER, SCENE_TOKEN);
    r->at = SCENE_HEADER + SCENE_TOKEN;
}

/* ---- Settings ---------------------------------------------------------------------------------------------------- */
static void set_option(reader *r, const scene_options *list, const scene_option *option, double value)
{
    static const double low[] = {0.0, 0.0, INT32_MIN}, high[] = {0.0, UINT32_MAX, INT32_MAX};
    char *at = (char *)&r->scene->settings + list->offset + option->offset;
    const uint32_t word = option->type == SCENE_REAL || !(value >= low[option->type] && value <= high[option->type])
                              ? 0
                              : (uint32_t)(int64_t)value;
    if (r->failed) return;
    if (option->type == SCENE_REAL) {
        memcpy(at, &value, sizeof value);
    } else if (!(value >= low[option->type] && value <= high[option->type] && value == floor(value))) {
        refuse(r, "scene refused: %s, %s of %s = %g, must be a whole number in %.0f .. %.0f; export the unit anew",
               r->path, option->name, list->name, value, low[option->type], high[option->type]);
    } else {
        memcpy(at, &word, sizeof word);
    }
}

static void get_options(reader *r, const scene_options *list)
{
    const uint32_t count = get_u32(r);
    if (count > list->count)
        refuse(r,
               "scene refused: %s has %u options of %s, this version (%u) knows %u; use the version that exported the "
               "unit, or a newer one",
               r->path, count, list->name, dmb_version(), list->count);
    for (uint32_t i = 0; i < count && !r->failed; ++i) set_option(r, list, &list->options[i], get_real(r));
}

static dmb_output get_output(reader *r)
{
    dmb_output output;
    memset(&output, 0, sizeof output);
    const uint32_t index = get_u32(r);
    output.place.pipe = get_u32(r);
    output.place.fraction = get_real(r);
    const uint32_t quantity = get_u32(r);
    memcpy(&output.quantity, &quantity, sizeof quantity);
    if (!r->failed && index != 0 && dmb_model_part(r->scene->model, index, &output.place.part) < 0)
        refuse(r, "scene refused: %s has an output of part %u, which its scene does not have; export the unit anew",
               r->path, index);
    return output;
}

static void get_settings(reader *r)
{
    scene_settings *settings = &r->scene->settings;
    for (int i = 0; i < SCENE_LISTS; ++i) get_options(r, &scene_option_lists[i]);
    settings->step = get_real(r);
    if (!(settings->step >= 0.0 && settings->step <= 1e18))
        refuse(r, "scene refused: %s, step = %g s, must be 0 .. 1e18; export the unit anew", r->path, settings->step);
    const uint32_t count = get_u32(r);
    if (!r->failed && (r->size - r->at) / LEAST_OUTPUT != count)
        refuse(r, "scene refused: %s has bytes for other than its %u outputs; export the unit anew", r->path, count);
    if (r->failed) return;
    settings->outputs = calloc(count + 1u, sizeof *settings->outputs);
    if (!settings->outputs) refuse(r, "scene refused: no memory for %u outputs", count);
    while (settings->output_count < count && !r->failed) settings->outputs[settings->output_count++] = get_output(r);
    if (!r->failed && r->at != r->size)
        refuse(r, "scene refused: %s goes on after its outputs; export the unit anew", r->path);
}

/* ---- Model ------------------------------------------------------------------------------------------------------- */
static void get_model(reader *r, dmb_log_fn log, void *log_context)
{
    dmb_model_options options = dmb_model_options_default();
    options.log = log;
    options.log_context = log_context;
    const uint32_t size = get_u32(r);
    if (size > r->size - r->at)
        refuse(r, "scene refused: %s ends within its scene record; export the unit anew", r->path);
    if (r->failed) return;
    if (dmb_model_read(r->bytes + r->at, size, &options, &r->scene->model) < 0) {
        dmb_error error = dmb_error_default();
        (void)dmb_last_error(&error);
        refuse(r, "scene refused: %s", error.message);
    }
    r->at += size;
}

int scene_open(scene_file *scene, const char *path, dmb_log_fn log, void *log_context)
{
    reader r = {.scene = scene, .path = path};
    memset(scene, 0, sizeof *scene);
    scene->settings = scene_settings_default();
    if (read_bytes(&r) == 0) {
        get_header(&r);
        get_model(&r, log, log_context);
        get_settings(&r);
    }
    free(r.bytes);
    if (!r.failed && dmb_model_compile(scene->model, &scene->settings.compile) < 0)
        refuse(&r, "scene refused: %s", dmb_model_message(scene->model));
    return r.failed ? -1 : 0;
}

void scene_close(scene_file *scene)
{
    dmb_model_destroy(&scene->model);
    free(scene->settings.outputs);
    memset(scene, 0, sizeof *scene);
}
