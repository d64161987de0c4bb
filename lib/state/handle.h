/* Is it a live sim? The first check of every public function that takes one. */
#ifndef DMB_STATE_HANDLE_H
#define DMB_STATE_HANDLE_H

#include "base/handle.h"
#include "state.h"

/* DMB_OK, DMB_ERR_NULL, DMB_ERR_HANDLE, or DMB_ERR_ORDER from within a call that is changing its state. */
static inline int32_t dmb_sim_check(const dmb_sim *sim)
{
    if (sim == NULL) return DMB_ERR_NULL;
    if (!dmb_handle_is(sim, DMB_HANDLE_SIM)) return DMB_ERR_HANDLE;
    return sim->busy == DMB_BUSY_CHANGING ? DMB_ERR_ORDER : DMB_OK;
}

#endif
