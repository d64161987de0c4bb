/* Fingerprints of scenes and states by FNV-1a with 64 bits (Fowler, Noll, Vo), which finds mistakes, not forgery. */
#ifndef DMB_RUN_FINGERPRINT_H
#define DMB_RUN_FINGERPRINT_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "sim/sim.h"

#define DMB_FNV_START UINT64_C(0xcbf29ce484222325)
#define DMB_FNV_PRIME UINT64_C(0x100000001b3)

static inline uint64_t dmb_fnv_bytes(uint64_t hash, const void *data, size_t size)
{
    const unsigned char *bytes = data;
    for (size_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * DMB_FNV_PRIME;
    return hash;
}

/* The same over whole words, eight times as fast, with a shift that lets the upper bits of a word reach the lower ones
 * of the hash. For checks inside one build; gives other values than the bytes do. */
static inline uint64_t dmb_fnv_word(uint64_t hash, uint64_t word)
{
    hash = (hash ^ word) * DMB_FNV_PRIME;
    return hash ^ (hash >> 32);
}

static inline uint64_t dmb_fnv_block(uint64_t hash, const void *data, size_t size)
{
    const unsigned char *bytes = data;
    size_t i = 0;
    for (; i + 8 <= size; i += 8) {
        uint64_t word;
        memcpy(&word, bytes + i, sizeof word);
        hash = dmb_fnv_word(hash, word);
    }
    return dmb_fnv_bytes(hash, bytes + i, size - i);
}

static inline uint64_t dmb_fnv_number(uint64_t hash, double value)
{
    uint64_t word;
    memcpy(&word, &value, sizeof word);
    return dmb_fnv_word(hash, word);
}

static inline uint64_t dmb_fnv_numbers(uint64_t hash, const double *values, size_t count)
{
    for (size_t i = 0; i < count; ++i) hash = dmb_fnv_number(hash, values[i]);
    return hash;
}

/* Fingerprint that a snapshot must fit: the numbers of the compiled scene and of the options, without addresses and
 * stamps, so that the same description compiled in another process has the same fingerprint. */

/* O(number of nodes and elements). Callbacks of programmes count as equal. */
uint64_t dmb_scene_fingerprint(const dmb_scene *scene);
uint64_t dmb_options_fingerprint(const dmb_sim_options *options);

#endif
