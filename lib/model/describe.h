/* What every dmb_model_add_ function does alike: refuse wrong objects, read the caller's struct, append, give out an
 * id, tell the log. */
#ifndef DMB_MODEL_DESCRIBE_H
#define DMB_MODEL_DESCRIBE_H

#include "model/model.h"

/* DMB_OK for a model that may still be described and a definition that is there; the model is busy then until
 * dmb_describe_close. Errors: DMB_ERR_NULL, _HANDLE; _ORDER for a busy model, and for a compiled one, whose message stays
 * because other threads may be reading it. */
int32_t dmb_describe_open(dmb_model *model, const char *part, const void *def);
/* Ends a call: a refusal without a message gets one, `part` before the text of the status, and the log is told. */
int32_t dmb_describe_close(dmb_model *model, const char *part, int32_t status);
/* Ends a call that adds a part: the same, and a refusal is remembered, or forgotten where the part was added after all. */
int32_t dmb_describe_part(dmb_model *model, const dmb_described *part, int32_t status);
/* Of a kind with one definition a part; the size is that of the whole struct. */
static inline int32_t dmb_describe_end(dmb_model *model, const char *part, const void *definition, size_t size,
                                       int32_t status)
{
    const dmb_described given = {part, definition, size, 1};
    return dmb_describe_part(model, &given, status);
}

/* Appends an item. Errors: DMB_ERR_NO_MEMORY, DMB_ERR_TOO_LARGE; the list is as it was then. */
int32_t dmb_list_append(dmb_list *list, const dmb_allocator *allocator, const void *item, size_t item_size);
void dmb_list_release(dmb_list *list, const dmb_allocator *allocator, size_t item_size);
#define DMB_LIST_AT(T, list, i) ((T *)(list).items + (i))

/* The id of a part; and an append that writes it to *id unless that is NULL. */
dmb_id dmb_model_id(const dmb_model *model, uint32_t kind, uint32_t index);
int32_t dmb_describe_append(dmb_model *model, dmb_list *list, const void *item, size_t item_size, uint32_t kind,
                            dmb_id *id);

/* Frees a programme's copy of terms and tables, or the wall's copy of the survey. */
void dmb_programme_release(dmb_programme *programme, const dmb_allocator *allocator);
void dmb_wall_release(dmb_wall_def *wall, const dmb_allocator *allocator);

#endif
