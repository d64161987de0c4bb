/* Names of parts: where each kind keeps them, what they may be, how messages tell them. */
#ifndef DMB_MODEL_PART_NAME_H
#define DMB_MODEL_PART_NAME_H

#include "base/message.h"
#include "base/value_check.h"
#include "model/model.h"

/* A programme is an array of terms, which has no room for one. */
typedef struct dmb_programme_name {
    uint32_t programme;
    uint32_t reserved;
    char name[DMB_NAME_SIZE];
} dmb_programme_name;

/* Fails the check where `name`, the field of that length, is no text or another part of the kind has it. */
void dmb_check_part_name(dmb_check *check, const dmb_model *model, uint32_t kind, const char *name);
/* The same for pipes that are added together. */
void dmb_check_pipes_name(dmb_check *check, const dmb_model *model, const char *name);

/* "string 0 (main)", "bit 0"; into text. */
const char *dmb_model_part_text(const dmb_model *model, uint32_t kind, uint32_t index, dmb_message *text);
/* The same by the word for its kind. */
const char *dmb_model_word_text(const dmb_model *model, const char *word, uint32_t index, dmb_message *text);
/* "string 0 (main), pipe 12 (collars)" */
const char *dmb_model_pipe_text(const dmb_model *model, uint32_t string, uint32_t pipe, dmb_message *text);
/* "pipes of string 0 (collars)": those added together. */
const char *dmb_pipes_text(dmb_message *text, uint32_t string, const dmb_pipe_def *def);

#endif
