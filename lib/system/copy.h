/* A copy of a sim for analyses to work on; the sim stays as it is. */
#ifndef DMB_SYSTEM_COPY_H
#define DMB_SYSTEM_COPY_H

#include "sim/sim.h"

/* A sim of its own in the accepted state of `sim`, its trial too, for analyses that leave the sim alone; memory from
 * the sim's allocator, NULL if there is none. It is no handle for callers (no stamp, no hold on the model) and must not
 * outlive the sim. system/copy */
dmb_sim *dmb_state_copy(const dmb_sim *sim);
/* DMB_ERR_TOO_LARGE, with a message that begins with `who`, where such a copy cannot be: it has dense matrices of
 * clusters. */
int32_t dmb_state_copy_check(dmb_sim *sim, const char *who);
/* The accepted state of a sim of the same model into a copy, its trial too. */
void dmb_state_take(const dmb_sim *sim, dmb_sim *copy);
/* NULL is fine. */
void dmb_state_discard(dmb_sim *copy);

#endif
