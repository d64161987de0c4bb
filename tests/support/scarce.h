/* Memory that runs out: an allocator that counts its calls, refuses one of them, and knows what was not given back. */
#ifndef DMB_TESTS_SCARCE_H
#define DMB_TESTS_SCARCE_H

#include <drillmbd/drillmbd.h>

typedef struct scarce {
    size_t calls;   /* so far */
    size_t refused; /* number of the call, from 1, that gets nothing; 0: none */
    size_t live;    /* blocks that were not given back */
} scarce;

dmb_allocator scarce_allocator(scarce *memory);

#endif
