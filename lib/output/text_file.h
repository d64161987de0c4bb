/* Writing text to a file; numbers are independent of the locale. A failure is stored until the file is closed. Text is
 * written to a temporary file in the same folder, which replaces the target when it is complete: a write that fails
 * leaves the old file and no other. Devices and pipes are written to directly. */
#ifndef DMB_OUTPUT_TEXT_FILE_H
#define DMB_OUTPUT_TEXT_FILE_H

#include <stdint.h>

#include "base/build.h"
#include "base/message.h"

#if DMB_WITH_FILES
#include <stdio.h>

typedef FILE dmb_stream;
#else
typedef void dmb_stream; /* no file can be opened */
#endif

enum { DMB_PATH_MAX = 4096 };

typedef struct dmb_text_file {
    dmb_stream *stream;
    int failed;
    int beside;                      /* 1: `part` is written and then replaces `path`; 0: `path` is written directly */
    int looking;                     /* 1: numbers are only inspected, see output/vtk */
    int strange;                     /* 1: a number was not finite */
    int base64;                      /* 1: numbers are written as words in base 64 */
    uint32_t waiting, waiting_count; /* bytes of an incomplete group of three */
    char path[DMB_PATH_MAX], part[DMB_PATH_MAX + 16];
} dmb_text_file;

/* Opens for writing; DMB_OK, DMB_ERR_IO, or DMB_ERR_UNSUPPORTED in a build without files. Every opened file must be
 * closed. */
int32_t dmb_text_open(dmb_text_file *file, const char *path);
void dmb_text_put(dmb_text_file *file, const char *text);
void dmb_text_put_number(dmb_text_file *file, double value); /* 17 digits: exact when read back */
void dmb_text_put_count(dmb_text_file *file, uint64_t value);
/* 64-bit words in base 64, least significant byte first, between begin and end (RFC 4648). */
void dmb_text_begin_base64(dmb_text_file *file);
void dmb_text_put_word(dmb_text_file *file, uint64_t word);
void dmb_text_end_base64(dmb_text_file *file);
/* The message of a public call that failed to write the file: that the path cannot be written, or `why` as it is. */
const char *dmb_file_message(dmb_message *why, const char *call, const char *path, int32_t status);
/* DMB_OK if all data have reached the file, else DMB_ERR_IO. */
int32_t dmb_text_close(dmb_text_file *file);

#endif
