/* Writes a scene file (scene_format.h) from C. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene_format.h"

typedef struct writer {
    unsigned char *bytes;
    size_t at;
} writer;

static void put(writer *w, uint64_t value, unsigned width)
{
    for (unsigned i = 0; i < width; ++i) w->bytes[w->at++] = (unsigned char)(value >> 8 * i);
}

static void put_real(writer *w, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put(w, bits, 8);
}

static double option_value(const scene_option *option, const char *options)
{
    double real;
    uint32_t count;
    int32_t whole;
    memcpy(&count, options + option->offset, sizeof count);
    memcpy(&whole, options + option->offset, sizeof whole);
    if (option->type != SCENE_REAL) return option->type == SCENE_COUNT ? (double)count : (double)whole;
    memcpy(&real, options + option->offset, sizeof real);
    return real;
}

static void put_settings(writer *w, const scene_settings *settings)
{
    for (int i = 0; i < SCENE_LISTS; ++i) {
        const scene_options *list = &scene_option_lists[i];
        put(w, list->count, 4);
        for (uint32_t k = 0; k < list->count; ++k)
            put_real(w, option_value(&list->options[k], (const char *)settings + list->offset));
    }
    put_real(w, settings->step);
    put(w, settings->output_count, 4);
    for (uint32_t i = 0; i < settings->output_count; ++i) {
        const dmb_output *output = &settings->outputs[i];
        put(w, output->place.part.index, 4);
        put(w, output->place.pipe, 4);
        put_real(w, output->place.fraction);
        put(w, (uint32_t)output->quantity, 4);
    }
}

static size_t settings_size(const scene_settings *settings)
{
    size_t size = 8u + 4u + 20u * (size_t)settings->output_count;
    for (int i = 0; i < SCENE_LISTS; ++i) size += 4u + 8u * (size_t)scene_option_lists[i].count;
    return size;
}

/* All but the header, then the header. 0, or -1. */
static int fill(writer *w, size_t size, const char *token, const dmb_model *model, size_t record,
                const scene_settings *settings)
{
    w->at = SCENE_HEADER;
    memcpy(w->bytes + w->at, token, strlen(token));
    w->at += SCENE_TOKEN;
    put(w, record, 4);
    if (dmb_model_write(model, w->bytes + w->at, record, &record) < 0) return -1;
    w->at += record;
    put_settings(w, settings);
    const uint32_t checksum = scene_checksum(w->bytes + SCENE_HEADER, size - SCENE_HEADER);
    memcpy(w->bytes, SCENE_MAGIC, 8);
    w->at = 8;
    put(w, SCENE_FORMAT, 4);
    put(w, settings->has_static ? SCENE_HAS_STATIC : 0, 4);
    put(w, size, 8);
    put(w, checksum, 4);
    return 0;
}

static int write_file(const char *path, const unsigned char *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    if (!file) return -1;
    const int is_written = fwrite(bytes, 1, size, file) == size;
    return fclose(file) == 0 && is_written ? 0 : -1;
}

int scene_write(const char *path, const char *token, const dmb_model *model, const scene_settings *settings)
{
    size_t record;
    if (strlen(token) >= SCENE_TOKEN || dmb_model_write(model, NULL, 0, &record) < 0) return -1;
    const size_t size = SCENE_HEADER + SCENE_TOKEN + 4u + record + settings_size(settings);
    writer w = {calloc(1, size), 0};
    int result = w.bytes ? fill(&w, size, token, model, record, settings) : -1;
    if (result == 0) result = write_file(path, w.bytes, size);
    free(w.bytes);
    return result;
}
