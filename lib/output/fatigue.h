/* Rainflow counting of a sequence of levels as it arrives (ASTM E1049, 5.4.4; Matsuishi, Endo 1968). Turning points
 * whose ranges shrink are not counted yet: of levels 0 .. n - 1 at most n + 2. */
#ifndef DMB_OUTPUT_FATIGUE_H
#define DMB_OUTPUT_FATIGUE_H

#include <stdint.h>

typedef struct dmb_rainflow {
    uint32_t *turns; /* levels not counted yet, shape (levels + 2) */
    uint32_t count;
    uint32_t reserved;
} dmb_rainflow;

/* Told of a cycle or half of one (weight 1 or 0.5) between two levels. */
typedef void (*dmb_rainflow_fn)(void *context, uint32_t low, uint32_t high, double weight);

void dmb_rainflow_add(dmb_rainflow *flow, uint32_t level, dmb_rainflow_fn count, void *context);
/* Tells the turning points not counted yet, as half cycles; they stay. */
void dmb_rainflow_rest(const dmb_rainflow *flow, dmb_rainflow_fn count, void *context);

#endif
