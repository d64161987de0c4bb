#include "scarce.h"

#include <stdlib.h>

#include "check.h"

static void *take(void *context, size_t size, size_t alignment)
{
    scarce *memory = context;
    if (++memory->calls == memory->refused) return NULL;
    ++memory->live;
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void give(void *context, void *block, size_t size, size_t alignment)
{
    scarce *memory = context;
    (void)size, (void)alignment;
    --memory->live;
    free(block);
}

dmb_allocator scarce_allocator(scarce *memory)
{
    dmb_allocator allocator = dmb_allocator_default();
    allocator.context = memory;
    allocator.allocate = take;
    allocator.release = give;
    return allocator;
}
