/* Sums and products of sizes that say when they overflow. Each returns true and writes *out, or returns false and
 * leaves *out as it was. */
#ifndef DMB_BASE_CHECKED_SIZE_H
#define DMB_BASE_CHECKED_SIZE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define DMB_DEFINE_CHECKED(suffix, type, maximum)                          \
    static inline bool dmb_checked_add_##suffix(type a, type b, type *out) \
    {                                                                      \
        if (b > (maximum)-a) return false;                                 \
        *out = a + b;                                                      \
        return true;                                                       \
    }                                                                      \
    static inline bool dmb_checked_mul_##suffix(type a, type b, type *out) \
    {                                                                      \
        if (a != 0 && b > (maximum) / a) return false;                     \
        *out = a * b;                                                      \
        return true;                                                       \
    }

DMB_DEFINE_CHECKED(size, size_t, SIZE_MAX)
DMB_DEFINE_CHECKED(u32, uint32_t, UINT32_MAX)
DMB_DEFINE_CHECKED(u64, uint64_t, UINT64_MAX)
#undef DMB_DEFINE_CHECKED

/* Rounds size up to a multiple of alignment, a power of two. */
static inline bool dmb_checked_round_up(size_t size, size_t alignment, size_t *out)
{
    size_t sum;
    if (!dmb_checked_add_size(size, alignment - 1, &sum)) return false;
    *out = sum & ~(alignment - 1);
    return true;
}

#endif
