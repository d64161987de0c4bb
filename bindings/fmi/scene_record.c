#include "scene_record.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Offsets of ids in structs. */
typedef struct id_field {
    const char *call;
    size_t offset;
} id_field;
/* clang-format off */
static const id_field id_fields[] = {
    {"add_pipes", offsetof(dmb_pipe_def, string)},
    {"add_time_function", offsetof(dmb_segment, of)},
    {"add_body", offsetof(dmb_body_def, string)},
    {"add_bit", offsetof(dmb_bit_def, string)}, {"add_bit", offsetof(dmb_bit_def, load)},
    {"add_stabiliser", offsetof(dmb_stabiliser_def, string)},
    {"add_joint", offsetof(dmb_joint_def, place_a)}, {"add_joint", offsetof(dmb_joint_def, place_b)},
    {"add_coupling", offsetof(dmb_coupling_def, joint)},
    {"add_coupling", offsetof(dmb_coupling_def, joint) + sizeof(dmb_id)},
    {"add_coupling", offsetof(dmb_coupling_def, third_joint)}, {"add_coupling", offsetof(dmb_coupling_def, fourth_joint)},
    {"add_drive", offsetof(dmb_drive_def, part)}, {"add_drive", offsetof(dmb_drive_def, time_function)},
    {"add_drive", offsetof(dmb_drive_def, excitation)},
    {"add_load", offsetof(dmb_load_def, place)}, {"add_load", offsetof(dmb_load_def, time_function)},
    {"add_spring", offsetof(dmb_spring_def, place_a)}, {"add_spring", offsetof(dmb_spring_def, place_b)},
    {"add_stuck", offsetof(dmb_stuck_def, place)},
    {"add_input", offsetof(dmb_input_def, part)},
    {"add_event", offsetof(dmb_event_def, output)},
    {"set_name", offsetof(scene_name, part)},
    {"output", offsetof(scene_output, noted)}};
/* clang-format on */

typedef struct array_field {
    const char *call;
    size_t pointer, count, width;
} array_field;
#define ARRAY_FIELD(call, type, pointer, count, width) {#call, offsetof(type, pointer), offsetof(type, count), width},
static const array_field array_fields[] = {SCENE_ARRAYS(ARRAY_FIELD)};

static void append(scene_book *book, const void *bytes, size_t size)
{
    if (book->is_full) return;
    if (book->size + size > book->room) {
        const size_t room = 2 * (book->size + size) + 4096;
        unsigned char *grown = realloc(book->bytes, room);
        if (!grown) {
            book->is_full = 1;
            return;
        }
        book->bytes = grown;
        book->room = room;
    }
    if (size > 0) memcpy(book->bytes + book->size, bytes, size);
    book->size += size;
}

/* The pairs of a struct that name a part; how many. */
static uint32_t note_ids(scene_book *book, const char *call, const unsigned char *one, uint32_t number)
{
    uint32_t count = 0;
    for (size_t i = 0; i < sizeof id_fields / sizeof *id_fields; ++i) {
        dmb_id id;
        if (strcmp(id_fields[i].call, call) != 0) continue;
        memcpy(&id, one + id_fields[i].offset, sizeof id);
        if (id.generation == 0) continue;
        const uint32_t pair[2] = {number, (uint32_t)id_fields[i].offset};
        append(book, pair, sizeof pair);
        ++count;
    }
    return count;
}

/* The arrays of a struct; how many numbers. Pointers do not matter: the reader sets them. */
static uint32_t note_arrays(scene_book *book, const char *call, const unsigned char *one)
{
    uint32_t total = 0;
    for (size_t i = 0; i < sizeof array_fields / sizeof *array_fields; ++i) {
        const array_field *field = &array_fields[i];
        uint32_t count;
        const double *values;
        if (strcmp(field->call, call) != 0) continue;
        memcpy(&count, one + field->count, sizeof count);
        memcpy(&values, one + field->pointer, sizeof values);
        const uint32_t numbers = values ? count * (uint32_t)field->width : 0;
        append(book, values, numbers * sizeof *values);
        total += numbers;
    }
    return total;
}

void scene_note(scene_book *book, const char *call, const void *structs, size_t struct_size, uint32_t struct_count,
                uint32_t count)
{
    scene_record head;
    memset(&head, 0, sizeof head);
    memcpy(head.call, call, strlen(call));
    head.count = count;
    head.structs = struct_count;
    head.struct_size = (uint32_t)struct_size;
    const size_t start = book->size;
    append(book, &head, sizeof head);
    append(book, structs, struct_count * struct_size);
    for (uint32_t i = 0; i < struct_count; ++i)
        head.ids += note_ids(book, call, (const unsigned char *)structs + i * struct_size, i);
    for (uint32_t i = 0; i < struct_count; ++i)
        head.doubles += note_arrays(book, call, (const unsigned char *)structs + i * struct_size);
    if (!book->is_full) memcpy(book->bytes + start, &head, sizeof head);
}

void scene_note_output(scene_book *book, dmb_output noted)
{
    const scene_output output = {(uint32_t)sizeof output, 0, noted};
    SCENE_NOTE(book, "output", output);
}

void scene_note_step(scene_book *book, double step)
{
    const scene_run run = {(uint32_t)sizeof run, 0, step};
    SCENE_NOTE(book, "run", run);
}

static int write_file(const scene_book *book, const char *path, scene_header *header)
{
    const size_t size = sizeof header->token + book->size;
    unsigned char *named = malloc(size);
    FILE *file = named ? fopen(path, "wb") : NULL;
    int is_written = 0;
    if (file) {
        memcpy(named, header->token, sizeof header->token);
        memcpy(named + sizeof header->token, book->bytes, book->size);
        header->checksum = scene_checksum(named, size);
        is_written = fwrite(header, offsetof(scene_header, token), 1, file) == 1 && fwrite(named, size, 1, file) == 1;
        is_written &= fclose(file) == 0;
    }
    free(named);
    return is_written ? 0 : -1;
}

int scene_write(scene_book *book, const char *path, const char *token)
{
    scene_header header;
    memset(&header, 0, sizeof header);
    memcpy(header.magic, SCENE_MAGIC, sizeof header.magic);
    header.format = SCENE_FORMAT;
    header.layout = SCENE_LAYOUT;
    header.length = sizeof header + book->size;
    int result = -1;
    if (!book->is_full && strlen(token) < sizeof header.token) {
        memcpy(header.token, token, strlen(token));
        result = write_file(book, path, &header);
    }
    free(book->bytes);
    memset(book, 0, sizeof *book);
    return result;
}
