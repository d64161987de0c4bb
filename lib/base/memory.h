/* Memory: checked sizes, the caller's allocator, arenas, growing arrays. */
#ifndef DMB_BASE_MEMORY_H
#define DMB_BASE_MEMORY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "drillmbd/base.h"

/* Sums and products of sizes with overflow detection. Each returns true and writes *out, or returns false and leaves
 * *out unchanged. */
static inline bool dmb_checked_add_size(size_t a, size_t b, size_t *out)
{
    if (b > SIZE_MAX - a) return false;
    *out = a + b;
    return true;
}

static inline bool dmb_checked_mul_size(size_t a, size_t b, size_t *out)
{
    if (a != 0 && b > SIZE_MAX / a) return false;
    *out = a * b;
    return true;
}

/* Rounds size up to a multiple of alignment, a power of two. */
static inline bool dmb_checked_round_up(size_t size, size_t alignment, size_t *out)
{
    size_t sum;
    if (!dmb_checked_add_size(size, alignment - 1, &sum)) return false;
    *out = sum & ~(alignment - 1);
    return true;
}

/* Memory comes from the caller's allocator, in blocks that are aligned to DMB_ALIGNMENT and zeroed. An arena places
 * many arrays in one such block. */

enum { DMB_ALIGNMENT = 64 }; /* [byte] a cache line; sufficient for any vector load */

/* Copies the caller's allocator, or the default one if given is NULL. Errors: DMB_ERR_STRUCT_SIZE; DMB_ERR_NULL if one
 * of its two functions is missing. *out is unchanged after an error. */
int32_t dmb_allocator_copy(dmb_allocator *out, const dmb_allocator *given);

/* Returns a zeroed block of size bytes (0 counts as 1), or NULL. Sizes above PTRDIFF_MAX, as after an overflow of an
 * arena, give NULL without a call of the allocator. */
void *dmb_allocate(const dmb_allocator *allocator, size_t size);

/* Returns a zeroed block of count items of item_size bytes, or NULL; an overflow counts as lack of memory. */
void *dmb_allocate_array(const dmb_allocator *allocator, size_t count, size_t item_size);

/* Releases a block. size must be the size passed to dmb_allocate. block may be NULL. */
void dmb_release(const dmb_allocator *allocator, void *block, size_t size);

/* Many arrays in one block. The same code runs twice: once counting, once placing.
 *
 *     dmb_arena arena;
 *     dmb_arena_count(&arena);                       lay_out(&arena, &state);   every take returns NULL
 *     block = dmb_allocate(allocator, dmb_arena_block_size(&arena));
 *     dmb_arena_place(&arena, block, size);          lay_out(&arena, &state);   the same takes return memory
 *     if (arena.overflow) ...
 */

typedef struct dmb_arena {
    unsigned char *base; /* first aligned byte of the block; NULL while counting */
    size_t size;         /* [byte] from base on; SIZE_MAX while counting */
    size_t used;         /* [byte] allocated so far, alignment gaps included */
    bool overflow;       /* an array did not fit, or its size overflowed; stays set */
} dmb_arena;

/* Begins the counting pass. */
void dmb_arena_count(dmb_arena *arena);

/* [byte] Size of a block of any alignment that has space for all arrays counted; SIZE_MAX after an overflow. */
size_t dmb_arena_block_size(const dmb_arena *arena);

/* Begins the placing pass in a block of any alignment. NULL or too small a block sets overflow. */
void dmb_arena_place(dmb_arena *arena, void *block, size_t size);

/* Returns an array of count items of item_size bytes, zeroed. align is a power of two up to DMB_ALIGNMENT. Returns NULL
 * while counting and after an overflow; otherwise not NULL, even for no items. */
void *dmb_arena_allocate(dmb_arena *arena, size_t count, size_t item_size, size_t align);

/* Arrays of doubles begin on a cache line; other items have the alignment of their type. */
#define DMB_ARENA_DOUBLES(arena, count) ((double *)dmb_arena_allocate((arena), (count), sizeof(double), 64))
#define DMB_ARENA_ARRAY(arena, T, count) ((T *)dmb_arena_allocate((arena), (count), sizeof(T), _Alignof(T)))

/* Makes an arena's block accessible again in builds with DMB_RED_ZONES. Releasing or placing does it too. */
void dmb_arena_open(const void *block, size_t size);

/* A growable array of items of one size. A failing call leaves it unchanged. Item pointers are valid until the next
 * growth. */

typedef struct dmb_vector {
    void *items;
    size_t count;     /* [-] items in use */
    size_t capacity;  /* [-] items that fit without a new allocation */
    size_t item_size; /* [byte] > 0 */
} dmb_vector;

/* Returns an empty vector, which owns no memory. */
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

/* Reserves memory for capacity items in total. Errors: DMB_ERR_NO_MEMORY, DMB_ERR_TOO_LARGE (the size overflows). */
int32_t dmb_vector_reserve(dmb_vector *vector, const dmb_allocator *allocator, size_t capacity);

/* Appends count items, copied from items, or zeroed if items is NULL. Errors as of dmb_vector_reserve. Amortised
 * O(count). */
int32_t dmb_vector_append(dmb_vector *vector, const dmb_allocator *allocator, const void *items, size_t count);

/* Releases the memory and empties the vector. */
void dmb_vector_release(dmb_vector *vector, const dmb_allocator *allocator);

#endif
