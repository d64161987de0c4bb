/* Writing text to a file, numbers alike in every locale. A failure is kept until the file is closed. */
#ifndef DMB_STATE_TEXT_FILE_H
#define DMB_STATE_TEXT_FILE_H

#include <stdint.h>
#include <stdio.h>

typedef struct dmb_text_file {
    FILE *stream;
    int failed;
} dmb_text_file;

/* Opens for writing; DMB_OK or DMB_ERR_IO. Every opened file must be closed. */
int32_t dmb_text_open(dmb_text_file *file, const char *path);
void dmb_text_put(dmb_text_file *file, const char *text);
void dmb_text_put_number(dmb_text_file *file, double value); /* 17 digits: reads back the same */
void dmb_text_put_short(dmb_text_file *file, double value);  /* 6 digits */
void dmb_text_put_count(dmb_text_file *file, uint64_t value);
/* DMB_OK if everything has reached the file, else DMB_ERR_IO. */
int32_t dmb_text_close(dmb_text_file *file);

#endif
