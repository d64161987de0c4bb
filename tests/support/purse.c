#include "purse.h"

#include <stdlib.h>

static void *take(void *context, size_t size, size_t alignment)
{
    purse *p = context;
    if (p->left-- <= 0) return NULL;
    p->held++;
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void give(void *context, void *block, size_t size, size_t alignment)
{
    purse *p = context;
    (void)size;
    (void)alignment;
    p->held--;
    free(block);
}

dmb_allocator purse_allocator(purse *p)
{
    dmb_allocator allocator = dmb_allocator_default();
    allocator.context = p;
    allocator.allocate = take;
    allocator.release = give;
    return allocator;
}
