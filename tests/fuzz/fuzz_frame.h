/* Frame of the fuzz targets that describe a model out of bytes and run it: statuses are known ones, what has to hold
 * ends the program where it does not, and a state that is saved and restored is the same. */
#ifndef DMB_TESTS_FUZZ_FRAME_H
#define DMB_TESTS_FUZZ_FRAME_H

#include "must.h"
#include "random_scene.h"

static inline void known(int32_t status)
{
    MUST(strcmp(dmb_status_name(status), "DMB_UNKNOWN") != 0);
}

static inline void check_restore(dmb_sim *sim)
{
    static unsigned char block[1 << 17];
    size_t size = 0;
    MUST(dmb_sim_snapshot_size(sim, &size) == DMB_OK && size <= sizeof block);
    MUST(dmb_sim_snapshot(sim, block, size) == DMB_OK);
    const uint64_t hash = hash_of(sim);
    MUST(dmb_sim_restore(sim, block, size) == DMB_OK && hash_of(sim) == hash);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* subject: a type with members `source`, `model` and `more`, the last byte of the input: 0 in those that were stored
 * before there was more. describe: describes and compiles, 0 where there is nothing to run. */
#define FUZZ_ENTRY(subject, describe, run)                       \
    int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) \
    {                                                            \
        subject c;                                               \
        memset(&c, 0, sizeof c);                                 \
        c.source.data = data;                                    \
        c.source.size = size > 0 ? size - 1 : 0;                 \
        c.more = size > 0 ? data[size - 1] : 0;                  \
        MUST(dmb_model_create(NULL, &c.model) == DMB_OK);        \
        if (describe(&c)) run(&c);                               \
        dmb_model_destroy(&c.model);                             \
        return 0;                                                \
    }

#endif
