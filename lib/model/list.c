/* Lists of parts, kept by the growable array of base/vector.h. */
#include "base/vector.h"
#include "model/describe.h"
#include "model/limits.h"

static dmb_vector vector_of(const dmb_list *list, size_t item_size)
{
    dmb_vector vector = dmb_vector_of(item_size);
    vector.items = list->items;
    vector.count = list->count;
    vector.capacity = list->capacity;
    return vector;
}

int32_t dmb_list_append(dmb_list *list, const dmb_allocator *allocator, const void *item, size_t item_size)
{
    dmb_vector vector = vector_of(list, item_size);
    int32_t status;
    if (list->count >= (uint32_t)DMB_PARTS_MAX) return DMB_ERR_TOO_LARGE;
    status = dmb_vector_append(&vector, allocator, item, 1);
    if (status < 0) return status;
    list->items = vector.items;
    list->count = (uint32_t)vector.count; /* below 2^24, the capacity below 1.5 times that */
    list->capacity = (uint32_t)vector.capacity;
    return DMB_OK;
}

void dmb_list_release(dmb_list *list, const dmb_allocator *allocator, size_t item_size)
{
    dmb_vector vector = vector_of(list, item_size);
    dmb_vector_release(&vector, allocator);
    list->items = NULL;
    list->count = list->capacity = 0;
}
