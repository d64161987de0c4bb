#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

#include "base/build.h"
#include "base/sized_struct.h"

#if DMB_WITH_HEAP
#if defined(_WIN32)
#include <malloc.h> /* its heap has no aligned_alloc, whose blocks free takes */
#define TAKE(alignment, size) _aligned_malloc(size, alignment)
#define GIVE(block) _aligned_free(block)
#else
#define TAKE(alignment, size) aligned_alloc(alignment, size)
#define GIVE(block) free(block)
#endif
#else /* a model needs its own allocator: the default one has nothing to give */
#define TAKE(alignment, size) ((void)(alignment), (void)(size), NULL)
#define GIVE(block) ((void)(block))
#endif

static void *default_allocate(void *context, size_t size, size_t alignment)
{
    size_t rounded;
    (void)context;
    /* C11 7.22.3.1 asks for a size that is a multiple of the alignment */
    if (!dmb_checked_round_up(size, alignment, &rounded)) return NULL;
    return TAKE(alignment, rounded);
}

static void default_release(void *context, void *block, size_t size, size_t alignment)
{
    (void)context;
    (void)size;
    (void)alignment;
    GIVE(block);
}

DMB_DEFINE_INIT(dmb_allocator, 32, {.allocate = default_allocate, .release = default_release})

int32_t dmb_allocator_copy(dmb_allocator *out, const dmb_allocator *given)
{
    dmb_allocator read = dmb_allocator_default();
    if (given != NULL) {
        int32_t status = dmb_allocator_read(&read, given);
        if (status < 0) return status;
        if (read.allocate == NULL || read.release == NULL) return DMB_ERR_NULL;
    }
    *out = read;
    return DMB_OK;
}

static size_t at_least_one(size_t size)
{
    return size > 0 ? size : 1;
}

void *dmb_allocate(const dmb_allocator *allocator, size_t size)
{
    size_t asked = at_least_one(size);
    void *block = allocator->allocate(allocator->context, asked, DMB_ALIGNMENT);
    if (block == NULL) return NULL;
    if ((uintptr_t)block % DMB_ALIGNMENT != 0) { /* an allocator that ignores the alignment would crash vector loads */
        allocator->release(allocator->context, block, asked, DMB_ALIGNMENT);
        return NULL;
    }
    return memset(block, 0, asked);
}

void *dmb_allocate_array(const dmb_allocator *allocator, size_t count, size_t item_size)
{
    size_t size;
    if (!dmb_checked_mul_size(count, item_size, &size)) return NULL;
    return dmb_allocate(allocator, size);
}

void dmb_release(const dmb_allocator *allocator, void *block, size_t size)
{
    if (block == NULL) return;
    allocator->release(allocator->context, block, at_least_one(size), DMB_ALIGNMENT);
}

void dmb_arena_count(dmb_arena *arena)
{
    arena->base = NULL;
    arena->size = SIZE_MAX;
    arena->used = 0;
    arena->overflow = false;
}

size_t dmb_arena_block_size(const dmb_arena *arena)
{
    size_t size;
    /* the block may begin anywhere, so base may lie up to one alignment less a byte behind its start */
    if (arena->overflow || !dmb_checked_add_size(arena->used, DMB_ALIGNMENT - 1, &size)) return SIZE_MAX;
    return size;
}

void dmb_arena_place(dmb_arena *arena, void *block, size_t size)
{
    size_t gap = (size_t)(-(uintptr_t)block % DMB_ALIGNMENT);
    dmb_arena_count(arena);
    arena->size = 0;
    if (block == NULL || gap > size) {
        arena->overflow = true;
        return;
    }
    arena->base = (unsigned char *)block + gap;
    arena->size = size - gap;
}

void *dmb_arena_take(dmb_arena *arena, size_t count, size_t item_size, size_t align)
{
    size_t start = 0, length = 0, end = 0;
    bool valid = align != 0 && (align & (align - 1)) == 0 && align <= DMB_ALIGNMENT;
    if (arena->overflow) return NULL;
    if (!valid || !dmb_checked_round_up(arena->used, align, &start) ||
        !dmb_checked_mul_size(count, item_size, &length) || !dmb_checked_add_size(start, length, &end) ||
        end > arena->size) {
        arena->overflow = true;
        return NULL;
    }
    if (arena->base != NULL) memset(arena->base + arena->used, 0, end - arena->used);
    arena->used = end;
    return arena->base != NULL ? arena->base + start : NULL;
}

/* ---- Growing arrays ---------------------------------------------------------------------------------------------- */

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
