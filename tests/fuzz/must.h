/* MUST of fuzz targets: a condition that fails ends the program there. */
#ifndef DMB_TESTS_MUST_H
#define DMB_TESTS_MUST_H

#include <stdio.h>
#include <stdlib.h>

#include "drillmbd/run.h"

#define MUST(condition)                                                     \
    do {                                                                    \
        if (!(condition)) {                                                 \
            fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition); \
            abort();                                                        \
        }                                                                   \
    } while (0)

static inline uint64_t hash_of(const dmb_sim *sim)
{
    uint64_t hash = 0;
    MUST(dmb_sim_hash(sim, &hash) == DMB_OK);
    return hash;
}

#endif
