/* Writes a scene file (scene_format.h) from C: note each call that describes the model beside making it. */
#ifndef DMB_FMI_SCENE_RECORD_H
#define DMB_FMI_SCENE_RECORD_H

#include <stddef.h>

#include "scene_format.h"

typedef struct scene_book {
    unsigned char *bytes;
    size_t size, room; /* [byte] */
    int is_full;       /* 1: memory was not to be had; nothing more is noted */
} scene_book;          /* begins with 0 */

/* Notes a call by name, "add_body", with its `structs` structs (1 but of add_time_function and add_hole_sections) of
 * struct_size bytes; count: of pipes, else 1. */
void scene_note(scene_book *book, const char *call, const void *structs, size_t struct_size, uint32_t struct_count,
                uint32_t count);
/* For calls with one struct. */
#define SCENE_NOTE(book, call, def) scene_note((book), (call), &(def), sizeof(def), 1, 1)
/* Notes an output of the unit, in the order of their value references. */
void scene_note_output(scene_book *book, dmb_output noted);
/* Notes the length of steps [s], 0: chosen by the library. */
void scene_note_step(scene_book *book, double step);
/* Writes the file and forgets what was noted. 0, or -1 where memory or the file could not be had. */
int scene_write(scene_book *book, const char *path, const char *token);

#endif
