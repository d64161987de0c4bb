/* Internal functions of this folder: events, requirements of a snapshot, state transfer. */
#ifndef DMB_RUN_RUN_H
#define DMB_RUN_RUN_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "sim/layout.h"
#include "sim/sim.h"

/* ---- Events ------------------------------------------------------------------------------------------------------ */

/* Initial state of events of a new sim: none is held. */
void dmb_events_begin(dmb_sim *sim);
/* Checks that all outputs of events exist in the present state; otherwise the error of the query, with a message. */
int32_t dmb_events_check(dmb_sim *sim);

/* ---- Snapshots --------------------------------------------------------------------------------------------------- */

#define DMB_ROTATION_ROUNDING \
    1e-6 /* [-] of lengths and products of unit vectors: larger than the rounding accumulated in a run */

/* Checks the fields as they stand in a snapshot, from `from` on, one after the other. Uses scratch memory of the sim
 * and writes its message. DMB_OK or DMB_ERR_VALUE. O(bytes). */
int32_t dmb_snapshot_check(dmb_sim *sim, const dmb_field *fields, size_t count, const unsigned char *from);
/* Checks relations between the fields of `now` and the memory, after each field has passed. Writes the message of the
 * sim. DMB_OK or DMB_ERR_VALUE. O(size of the state). run/snapshot_relations */
int32_t dmb_snapshot_relations(dmb_sim *sim);
/* 1: a constrained component deviates from its described support. O(constrained rows). */
int dmb_is_off_supports(const dmb_sim *sim);

/* ---- Fingerprints ------------------------------------------------------------------------------------------------ */

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

/* Fingerprint required of a snapshot: the numbers of the compiled scene and of the options, without addresses and
 * stamps, so that the same description compiled in another process has the same fingerprint. */

/* O(number of nodes and elements). Callbacks of time functions count as equal. */
uint64_t dmb_scene_fingerprint(const dmb_scene *scene);
uint64_t dmb_options_fingerprint(const dmb_sim_options *options);

/* ---- State transfer ---------------------------------------------------------------------------------------------- */

/* Parts of dmb_sim_transfer_state. Strings are numbered from their rig ends, where pipes are added and removed, so
 * pipes and nodes of two scenes are matched by counting from the far end. */

/* Matching pipes and nodes of a string in two scenes. */
typedef struct dmb_common_string {
    uint32_t pipes;    /* matched */
    uint32_t nodes;    /* matched */
    uint32_t to, from; /* first matched node in the scene of the sim, and in the source scene */
} dmb_common_string;

/* The scenes must have passed dmb_state_transfer_check, or at least its part on pipes. O(1). */
dmb_common_string dmb_common_string_of(const dmb_scene *scene, const dmb_scene *from, uint32_t string);

/* Checks that sim and from differ in pipes at the rig ends only. DMB_ERR_VALUE with a message if they do not.
 * run/state_transfer_check */
int32_t dmb_state_transfer_check(dmb_sim *sim, const dmb_sim *from);

/* Poses, turns and speeds of all nodes of now. DMB_ERR_VALUE with a message if axial-torsional pipes would leave their
 * line. run/state_transfer_nodes */
int32_t dmb_state_transfer_nodes(dmb_sim *sim, const dmb_sim *from);
enum { DMB_TRANSFER_ALL = 0, DMB_TRANSFER_AGAIN = 1 };
/* Memory of the wall contacts; or only what an evaluation of new contacts has overwritten: bristles (without elapsed
 * time, one sliding at its limit is indistinguishable from one sticking there) and ages. run/state_transfer_sites */
void dmb_state_transfer_sites(dmb_sim *sim, const dmb_sim *from, int32_t what);

/* [m] Offset of a node in `from` to that in the scene, along body x: rigid pipes added or removed move the node of
 * their body. Both nodes are of string `string`, matched. */
double dmb_state_transfer_arm(const dmb_scene *scene, uint32_t node, const dmb_scene *from, uint32_t old,
                              uint32_t string);

#endif
