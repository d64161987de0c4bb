/* Is it a live sim? The first check of every public function that takes one. */
#ifndef DMB_STATE_HANDLE_H
#define DMB_STATE_HANDLE_H

#include "base/handle.h"
#include "state.h"

/* DMB_OK, DMB_ERR_NULL or DMB_ERR_HANDLE. */
static inline int32_t dmb_sim_check(const dmb_sim *sim)
{
    if (sim == NULL) return DMB_ERR_NULL;
    return dmb_handle_is(sim, DMB_HANDLE_SIM) ? DMB_OK : DMB_ERR_HANDLE;
}

#endif
