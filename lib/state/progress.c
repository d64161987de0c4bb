/* The caller's progress function: told at bounded intervals of a long call, which it may end. */
#include <math.h>

#include "drillmbd/sim.h"
#include "state.h"

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
