#include "base/vector.h"

#include <string.h>

#include "base/checked_size.h"

int32_t dmb_vector_reserve(dmb_vector *vector, const dmb_allocator *allocator, size_t capacity)
{
    size_t size;
    void *grown;
    if (capacity <= vector->capacity) return DMB_OK;
    if (!dmb_checked_mul_size(capacity, vector->item_size, &size)) return DMB_ERR_TOO_LARGE;
    grown = dmb_allocate(allocator, size);
    if (grown == NULL) return DMB_ERR_NO_MEMORY;
    if (vector->count > 0) memcpy(grown, vector->items, vector->count * vector->item_size);
    dmb_release(allocator, vector->items, vector->capacity * vector->item_size);
    vector->items = grown;
    vector->capacity = capacity;
    return DMB_OK;
}

int32_t dmb_vector_append(dmb_vector *vector, const dmb_allocator *allocator, const void *items, size_t count)
{
    size_t total, bytes = count * vector->item_size;
    unsigned char *end;
    if (count == 0) return DMB_OK;
    if (!dmb_checked_add_size(vector->count, count, &total)) return DMB_ERR_TOO_LARGE;
    if (total > vector->capacity) {
        size_t half_more = vector->capacity + vector->capacity / 2; /* no overflow: the old capacity fits in memory */
        int32_t status = dmb_vector_reserve(vector, allocator, total > half_more ? total : half_more);
        if (status < 0) return status;
    }
    end = dmb_vector_at(vector, vector->count);
    if (items != NULL) {
        memcpy(end, items, bytes);
    } else {
        memset(end, 0, bytes);
    }
    vector->count = total;
    return DMB_OK;
}

void dmb_vector_release(dmb_vector *vector, const dmb_allocator *allocator)
{
    dmb_release(allocator, vector->items, vector->capacity * vector->item_size);
    *vector = dmb_vector_of(vector->item_size);
}
