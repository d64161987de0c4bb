/* A sim of a saved scene, its snapshot, and room for one that is forged from it. After cmocka.h. */
#ifndef DMB_TESTS_FORGED_H
#define DMB_TESTS_FORGED_H

#include "saved_scenes.h"

enum { HEADER = 48, CONTENT_AT = 40 };

typedef struct subject {
    saved_scene scene;
    dmb_sim *sim;
    unsigned char *sound, *forged;
    size_t size;
    uint64_t hash;
} subject;

static inline uint64_t hash_of(const dmb_sim *sim)
{
    uint64_t hash = 0;
    assert_int_equal(dmb_sim_hash(sim, &hash), DMB_OK);
    return hash;
}

#endif
