/* One call at a time: what a function of the caller's may do with the sim it is called for. */
#include "sim/access.h"

#include <math.h>

#include "base/handle.h"
#include "drillmbd/sim.h"
#include "sim/sim.h"

void dmb_sim_refuse_re_entry(dmb_sim *sim)
{
    dmb_message_set(&sim->message,
                    "sim: in a call of its own at time %g, whose callback, allocator or log function may "
                    "not change it; do so when that call has returned",
                    sim->clock->time);
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
    if (status == DMB_OK) {
        dmb_message_clear(&sim->message);
        dmb_progress_begin(sim);
    }
    return status;
}

int32_t dmb_sim_occupy(const dmb_sim *sim)
{
    const int32_t status = take((dmb_sim *)sim, DMB_BUSY_READABLE);
    if (status == DMB_OK) dmb_progress_begin((dmb_sim *)sim);
    return status;
}

/* However a failure on the way was explained, that the caller ended the call is why. */
int32_t dmb_sim_leave(dmb_sim *sim, int32_t status)
{
    sim->busy = DMB_BUSY_NOT;
    if (status >= 0 || !sim->progress->cancelled) return status;
    dmb_message_set(&sim->message,
                    "sim: the caller's progress function ended the call at time %g, %.0f %% of it done; make "
                    "it again for its answer",
                    sim->clock->time, 100.0 * sim->progress->done);
    return DMB_ERR_CANCELLED;
}

void dmb_sim_hand_on(dmb_sim *sim, double from, double to)
{
    sim->busy = DMB_BUSY_NOT;
    sim->progress->nested++;
    sim->progress->from = from;
    sim->progress->to = to;
}

void dmb_sim_take_back(dmb_sim *sim)
{
    sim->busy = DMB_BUSY_READABLE;
    sim->progress->nested--;
    sim->progress->from = 0.0;
    sim->progress->to = 1.0;
}

/* The caller's progress function: told at bounded intervals of a long call, which it may end. */

void dmb_progress_begin(dmb_sim *sim)
{
    if (sim->progress->nested > 0 || sim->progress->function == NULL) return;
    sim->progress->done = sim->progress->from = 0.0;
    sim->progress->to = 1.0;
    sim->progress->cancelled = 0;
}

void dmb_progress_at(const dmb_sim *sim, double fraction)
{
    dmb_progress *progress = sim->progress;
    if (progress->function == NULL) return;
    const double part = fmin(fmax(fraction, 0.0), 1.0);
    progress->done = fmax(progress->done, progress->from + (progress->to - progress->from) * part);
}

int32_t dmb_progress_tell(const dmb_sim *sim)
{
    dmb_progress *progress = sim->progress;
    if (!progress->cancelled) progress->cancelled = progress->function(progress->context, progress->done) != 0;
    return progress->cancelled ? DMB_ERR_CANCELLED : DMB_OK;
}

int32_t dmb_progress_end(const dmb_sim *sim, int32_t status)
{
    return sim->progress->cancelled ? DMB_ERR_CANCELLED : status;
}

int32_t dmb_sim_set_progress(dmb_sim *sim, dmb_progress_fn function, void *context)
{
    const int32_t status = dmb_sim_occupy(sim); /* the message stays */
    if (status < 0) return status;
    sim->progress->cancelled = 0;
    sim->progress->function = function;
    sim->progress->context = context;
    return dmb_sim_leave(sim, DMB_OK);
}
