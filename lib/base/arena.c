#include "base/arena.h"

#include <string.h>

#include "base/allocator.h"
#include "base/checked_size.h"

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
