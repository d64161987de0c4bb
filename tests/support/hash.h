/* The hash of a sim's state, for tests that hold two states against each other to the last bit. */
#ifndef DMB_TESTS_HASH_H
#define DMB_TESTS_HASH_H

#include <drillmbd/drillmbd.h>
#include <stdio.h>
#include <stdlib.h>

static inline uint64_t hash_of(const dmb_sim *sim)
{
    uint64_t hash = 0;
    const int32_t status = dmb_sim_hash(sim, &hash);
    if (status != DMB_OK) {
        fprintf(stderr, "dmb_sim_hash: %s\n", dmb_status_name(status));
        abort();
    }
    return hash;
}

#endif
