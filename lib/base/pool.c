/* An allocator in a block of the caller. Free memory is a list of gaps in the order of their addresses; a block that is
 * given out carries nothing, since its size comes back with it. */
#include <stdint.h>
#include <string.h>

#include "base/memory.h"

typedef struct gap {
    size_t size; /* [byte] a multiple of DMB_ALIGNMENT */
    struct gap *next;
} gap;

typedef struct pool {
    gap *first;
    unsigned char *end; /* of the last block that can be given out */
    size_t used, peak;  /* [byte] */
} pool;

enum { FIRST_RELEASE = offsetof(dmb_allocator, release) + sizeof(void (*)(void)) }; /* [byte] of a dmb_allocator */

_Static_assert(sizeof(pool) <= DMB_ALIGNMENT && sizeof(gap) <= DMB_ALIGNMENT, "a gap fits where anything was");

/* Rounded up; 0 where that overflows. */
static size_t rounded(size_t size)
{
    return (size + DMB_ALIGNMENT - 1) / DMB_ALIGNMENT * DMB_ALIGNMENT;
}

static void *pool_take(void *context, size_t size, size_t alignment)
{
    pool *p = context;
    gap **link = &p->first;
    const size_t wanted = rounded(size);
    if (wanted < size || wanted == 0 || alignment > DMB_ALIGNMENT) return NULL;
    while (*link != NULL && (*link)->size < wanted) link = &(*link)->next;
    gap *found = *link;
    if (found == NULL) return NULL;
    if (found->size == wanted) {
        *link = found->next;
    } else {
        gap *rest = (gap *)(void *)((unsigned char *)found + wanted);
        rest->size = found->size - wanted;
        rest->next = found->next;
        *link = rest;
    }
    p->used += wanted;
    if (p->used > p->peak) p->peak = p->used;
    return found;
}

static int touch(const gap *low, const gap *high)
{
    return high != NULL && (const unsigned char *)low + low->size == (const unsigned char *)high;
}

static void join(gap *low)
{
    if (!touch(low, low->next)) return;
    low->size += low->next->size;
    low->next = low->next->next;
}

/* A block that cannot be one of those given out stays: one of other memory, or one that is a gap already. */
static int is_out(const pool *p, const gap *before, const gap *after, const unsigned char *block, size_t size)
{
    const unsigned char *first = (const unsigned char *)p + DMB_ALIGNMENT;
    if ((uintptr_t)block % DMB_ALIGNMENT != 0 || (uintptr_t)block < (uintptr_t)first) return 0;
    if (size == 0 || (uintptr_t)block >= (uintptr_t)p->end || size > (size_t)(p->end - block)) return 0;
    if (before != NULL && (size_t)(block - (const unsigned char *)before) < before->size) return 0;
    return after == NULL || (size_t)((const unsigned char *)after - block) >= size;
}

static void pool_give(void *context, void *block, size_t size, size_t alignment)
{
    pool *p = context;
    gap *before = NULL, *after = p->first, *back = block;
    (void)alignment;
    while (after != NULL && (uintptr_t)after <= (uintptr_t)block) {
        before = after;
        after = after->next;
    }
    if (!is_out(p, before, after, block, rounded(size))) return;
    back->size = rounded(size);
    back->next = after;
    p->used -= back->size;
    join(back);
    if (before == NULL) {
        p->first = back;
        return;
    }
    before->next = back;
    join(before);
}

/* The fields of the first release: a caller compiled against it has room for no more. */
static void describe(dmb_allocator *allocator, pool *p)
{
    const dmb_allocator none = {0};
    memcpy(allocator, &none, FIRST_RELEASE);
    allocator->struct_size = FIRST_RELEASE;
    allocator->context = p;
    allocator->allocate = pool_take;
    allocator->release = pool_give;
}

int32_t dmb_pool_allocator(void *memory, size_t size, dmb_allocator *allocator)
{
    if (memory == NULL || allocator == NULL) return DMB_ERR_NULL;
    if (size < 4 * (size_t)DMB_ALIGNMENT || size > UINTPTR_MAX - (uintptr_t)memory) return DMB_ERR_VALUE;
    const size_t start = (size_t)(-(uintptr_t)memory % DMB_ALIGNMENT);
    pool *p = (pool *)(void *)((unsigned char *)memory + start);
    p->first = (gap *)(void *)((unsigned char *)p + DMB_ALIGNMENT);
    p->first->size = (size - start) / DMB_ALIGNMENT * DMB_ALIGNMENT - DMB_ALIGNMENT;
    p->first->next = NULL;
    p->end = (unsigned char *)p->first + p->first->size;
    p->used = p->peak = DMB_ALIGNMENT;
    describe(allocator, p);
    return DMB_OK;
}

size_t dmb_pool_peak(const dmb_allocator *allocator)
{
    if (allocator == NULL || allocator->allocate != pool_take || allocator->context == NULL) return 0;
    return ((const pool *)allocator->context)->peak;
}
