/* Memory from the allocator the caller gave. Every block is aligned to DMB_ALIGNMENT and zeroed. */
#ifndef DMB_BASE_ALLOCATOR_H
#define DMB_BASE_ALLOCATOR_H

#include "drillmbd/base.h"

enum { DMB_ALIGNMENT = 64 }; /* [byte] a cache line, and enough for any vector load */

/* Copies the caller's allocator, or the default one where given is NULL. Errors: DMB_ERR_STRUCT_SIZE; DMB_ERR_NULL if
 * one of its two functions is missing. *out is unchanged then. */
int32_t dmb_allocator_copy(dmb_allocator *out, const dmb_allocator *given);

/* A zeroed block of size bytes (0 counts as 1), or NULL. */
void *dmb_allocate(const dmb_allocator *allocator, size_t size);

/* A zeroed block of count items of item_size bytes, or NULL; an overflow counts as no memory. */
void *dmb_allocate_array(const dmb_allocator *allocator, size_t count, size_t item_size);

/* Gives a block back, with the size it was asked for. block may be NULL. */
void dmb_release(const dmb_allocator *allocator, void *block, size_t size);

#endif
