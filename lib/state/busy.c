/* One call at a time: what a function of the caller's may do with the sim it is called for. */
#include "base/handle.h"
#include "state.h"

void dmb_sim_refuse_re_entry(dmb_sim *sim)
{
    dmb_message_set(&sim->message, "sim: in a call of its own at time %g, whose callback, allocator or log function may "
                                   "not change it; do so when that call has returned", sim->clock->time);
}

static int32_t take(dmb_sim *sim, int32_t busy)
{
    if (sim == NULL) return DMB_ERR_NULL;
    if (!dmb_handle_is(sim, DMB_HANDLE_SIM)) return DMB_ERR_HANDLE;
    if (sim->busy != DMB_BUSY_NOT) {
        dmb_sim_refuse_re_entry(sim);
        return DMB_ERR_ORDER;
    }
    sim->busy = busy;
    return DMB_OK;
}

int32_t dmb_sim_enter(dmb_sim *sim, int32_t busy)
{
    const int32_t status = take(sim, busy);
    if (status == DMB_OK) dmb_message_clear(&sim->message);
    return status;
}

int32_t dmb_sim_occupy(const dmb_sim *sim)
{
    return take((dmb_sim *)sim, DMB_BUSY_READABLE);
}

int32_t dmb_sim_leave(dmb_sim *sim, int32_t status)
{
    sim->busy = DMB_BUSY_NOT;
    return status;
}
