/* What every query begins with: a live sim, and somewhere to put the answer. */
#ifndef DMB_QUERY_ASK_H
#define DMB_QUERY_ASK_H

#include "base/sized_struct.h"
#include "state/handle.h"

/* DMB_OK, DMB_ERR_NULL or DMB_ERR_HANDLE. */
static inline int32_t dmb_ask(const dmb_sim *sim, const void *answer)
{
    const int32_t status = dmb_sim_check(sim);
    if (status < 0) return status;
    return answer != NULL ? DMB_OK : DMB_ERR_NULL;
}

#endif
