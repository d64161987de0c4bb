/* A growable array of equal items. A failing call leaves it as it was. Item pointers hold until the next growth. */
#ifndef DMB_BASE_VECTOR_H
#define DMB_BASE_VECTOR_H

#include "base/memory.h"

typedef struct dmb_vector {
    void *items;
    size_t count;     /* [-] items in use */
    size_t capacity;  /* [-] items there is room for */
    size_t item_size; /* [byte] > 0 */
} dmb_vector;

/* An empty vector; holds no memory. */
static inline dmb_vector dmb_vector_of(size_t item_size)
{
    dmb_vector vector = {NULL, 0, 0, item_size};
    return vector;
}

/* Item i, i < count. */
static inline void *dmb_vector_at(const dmb_vector *vector, size_t i)
{
    return (unsigned char *)vector->items + i * vector->item_size;
}
#define DMB_VECTOR_AT(T, vector, i) ((T *)dmb_vector_at((vector), (i)))

/* Makes room for capacity items altogether. Errors: DMB_ERR_NO_MEMORY, DMB_ERR_TOO_LARGE (the size overflows). */
int32_t dmb_vector_reserve(dmb_vector *vector, const dmb_allocator *allocator, size_t capacity);

/* Appends count items, copied from items, or zeroed where items is NULL. Errors as of reserve. Amortised O(count). */
int32_t dmb_vector_append(dmb_vector *vector, const dmb_allocator *allocator, const void *items, size_t count);

/* Gives the memory back and empties the vector. */
void dmb_vector_release(dmb_vector *vector, const dmb_allocator *allocator);

#endif
