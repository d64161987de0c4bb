/* The caller's allocator, arenas, growing arrays, and an allocator in a block of the caller. All blocks are aligned for
 * vector loads (DMB_ALIGNMENT) and zero, so that no result depends on what memory held before. An arena is used twice
 * with the same code, first to count and then to place; red zones between its arrays (sanitizer builds) are part of the
 * count. */
#include "base/memory.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/build.h"
#include "base/failure.h"
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
#else /* a model needs its own allocator: the default one always returns NULL */
#define TAKE(alignment, size) ((void)(alignment), (void)(size), NULL)
#define GIVE(block) ((void)(block))
#endif

#if DMB_RED_ZONES > 0
extern void __asan_poison_memory_region(const volatile void *start, size_t size); /* sanitizer/asan_interface.h */
extern void __asan_unpoison_memory_region(const volatile void *start, size_t size);
#define CLOSE(start, size) __asan_poison_memory_region(start, size)
#define OPEN(start, size) __asan_unpoison_memory_region(start, size)
#else
#define CLOSE(start, size) ((void)(start), (void)(size))
#define OPEN(start, size) ((void)(start), (void)(size))
#endif

static void *default_allocate(void *context, size_t size, size_t alignment)
{
    size_t rounded;
    (void)context;
    /* C11 7.22.3.1 requires a size that is a multiple of the alignment */
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
    if (size > PTRDIFF_MAX) return NULL; /* no object can be larger, so the allocator is not called */
    void *block = allocator->allocate(allocator->context, asked, DMB_ALIGNMENT);
    if (block == NULL) return NULL;
    if ((uintptr_t)block % DMB_ALIGNMENT != 0) { /* misaligned blocks would crash vector loads, so an allocator that
                                                    ignores the alignment counts as failed */
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
    OPEN(block, at_least_one(size));
    allocator->release(allocator->context, block, at_least_one(size), DMB_ALIGNMENT);
}

void dmb_arena_open(const void *block, size_t size)
{
    OPEN(block, size);
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
    /* the block may begin at any address, so base may lie up to one alignment less one byte behind its start */
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
    OPEN(block, size);
    arena->base = (unsigned char *)block + gap;
    arena->size = size - gap;
}

void *dmb_arena_allocate(dmb_arena *arena, size_t count, size_t item_size, size_t align)
{
    size_t start = 0, length = 0, end = 0;
    bool valid = align != 0 && (align & (align - 1)) == 0 && align <= DMB_ALIGNMENT;
    if (arena->overflow) return NULL;
    if (!valid || !dmb_checked_round_up(arena->used, align, &start) ||
        !dmb_checked_mul_size(count, item_size, &length) || !dmb_checked_add_size(start, length, &end) ||
        !dmb_checked_add_size(end, DMB_RED_ZONES, &end) || end > arena->size) {
        arena->overflow = true;
        return NULL;
    }
    if (arena->base != NULL) memset(arena->base + arena->used, 0, end - arena->used);
    arena->used = end;
    if (arena->base != NULL) CLOSE(arena->base + end - DMB_RED_ZONES, DMB_RED_ZONES);
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

/* An allocator in a block of the caller. Free memory is a list of gaps, sorted by address. Blocks in use carry no
 * header, because the caller passes their size on release. */

typedef struct gap {
    size_t size; /* [byte] a multiple of DMB_ALIGNMENT */
    struct gap *next;
} gap;

typedef struct pool {
    gap *first;
    unsigned char *end; /* of the last block that can be allocated */
    size_t peak;        /* [byte] from the pool's first byte to the end of the highest block so far */
} pool;

enum { FIRST_RELEASE = offsetof(dmb_allocator, release) + sizeof(void (*)(void)) }; /* [byte] of a dmb_allocator */

_Static_assert(sizeof(pool) <= DMB_ALIGNMENT && sizeof(gap) <= DMB_ALIGNMENT, "a gap fits where anything was");

/* Size rounded up to a multiple of DMB_ALIGNMENT; 0 if that overflows. */
static size_t rounded(size_t size)
{
    return (size + DMB_ALIGNMENT - 1) / DMB_ALIGNMENT * DMB_ALIGNMENT;
}

/* First fit: the lowest gap that is large enough. Its cost is the number of gaps, which is small, because objects are
 * blocks of their own; and equal calls take equal places, so that a program that ran once in a pool runs in it again.
 */
static void *pool_allocate(void *context, size_t size, size_t alignment)
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
    /* A pool that ends with the highest block suffices for the same calls: first fit takes the same gaps in it. */
    const size_t high = (size_t)((unsigned char *)found - (unsigned char *)p) + wanted;
    if (high > p->peak) p->peak = high;
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

/* 1 if the block can be one that was allocated. Memory outside the pool and blocks that are already free are ignored on
 * release. */
static int is_out(const pool *p, const gap *before, const gap *after, const unsigned char *block, size_t size)
{
    const unsigned char *first = (const unsigned char *)p + DMB_ALIGNMENT;
    if ((uintptr_t)block % DMB_ALIGNMENT != 0 || (uintptr_t)block < (uintptr_t)first) return 0;
    if (size == 0 || (uintptr_t)block >= (uintptr_t)p->end || size > (size_t)(p->end - block)) return 0;
    if (before != NULL && (size_t)(block - (const unsigned char *)before) < before->size) return 0;
    return after == NULL || (size_t)((const unsigned char *)after - block) >= size;
}

/* The gap is entered in the order of addresses, where neighbours touch, and joined with both: no two gaps are ever
 * adjacent, and freeing everything leaves one. */
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
    join(back);
    if (before == NULL) {
        p->first = back;
        return;
    }
    before->next = back;
    join(before);
}

/* Sets the fields of the first release only: the struct of a caller compiled against it is no longer. */
static void describe(dmb_allocator *allocator, pool *p)
{
    const dmb_allocator none = {0};
    memcpy(allocator, &none, FIRST_RELEASE);
    allocator->struct_size = FIRST_RELEASE;
    allocator->context = p;
    allocator->allocate = pool_allocate;
    allocator->release = pool_give;
}

int32_t dmb_pool_allocator(void *memory, size_t size, dmb_allocator *allocator)
{
    if (memory == NULL || allocator == NULL) return dmb_failed("pool", DMB_ERR_NULL);
    if (size < 4 * (size_t)DMB_ALIGNMENT || size > UINTPTR_MAX - (uintptr_t)memory)
        return dmb_failed("pool", DMB_ERR_VALUE);
    const size_t start = (size_t)(-(uintptr_t)memory % DMB_ALIGNMENT);
    pool *p = (pool *)(void *)((unsigned char *)memory + start);
    p->first = (gap *)(void *)((unsigned char *)p + DMB_ALIGNMENT);
    p->first->size = (size - start) / DMB_ALIGNMENT * DMB_ALIGNMENT - DMB_ALIGNMENT;
    p->first->next = NULL;
    p->end = (unsigned char *)p->first + p->first->size;
    p->peak = DMB_ALIGNMENT;
    describe(allocator, p);
    return DMB_OK;
}

size_t dmb_pool_peak(const dmb_allocator *allocator)
{
    if (allocator == NULL || allocator->allocate != pool_allocate || allocator->context == NULL) return 0;
    return ((const pool *)allocator->context)->peak;
}
