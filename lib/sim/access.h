/* Start and end of calls on a sim: a live handle, one call at a time, progress and cancellation; and the options of a
 * sim. */
#ifndef DMB_SIM_ACCESS_H
#define DMB_SIM_ACCESS_H

#include "base/message.h"
#include "base/sized_struct.h"
#include "drillmbd/run.h"
#include "sim/sim.h"

/* DMB_OK, DMB_ERR_NULL, DMB_ERR_HANDLE, or DMB_ERR_ORDER from within a call that is changing its state. */
static inline int32_t dmb_sim_check(const dmb_sim *sim)
{
    if (sim == NULL) return DMB_ERR_NULL;
    if (!dmb_handle_is(sim, DMB_HANDLE_SIM)) return DMB_ERR_HANDLE;
    return sim->busy == DMB_BUSY_CHANGING ? DMB_ERR_ORDER : DMB_OK;
}

/* First check of every query: a live sim, and a place for the result. */

/* DMB_OK, DMB_ERR_NULL or DMB_ERR_HANDLE. */
static inline int32_t dmb_ask(const dmb_sim *sim, const void *answer)
{
    const int32_t status = dmb_sim_check(sim);
    if (status < 0) return status;
    return answer != NULL ? DMB_OK : DMB_ERR_NULL;
}

/* Failure of a call on the sim: reported to dmb_last_error and the error handler. text NULL: that of the status.
 * Returns status. */
int32_t dmb_sim_fail(const dmb_sim *sim, int32_t status, const char *call, const char *text);
/* The same for a query; a status that is no failure is returned unchanged. */
static inline int32_t dmb_sim_failed(const dmb_sim *sim, const char *call, int32_t status)
{
    return status >= 0 ? status : dmb_sim_fail(sim, status, call, NULL);
}

/* Begins a call that changes the sim or runs functions of the caller's: the message is clear and the sim busy until
 * dmb_sim_leave. Errors: DMB_ERR_NULL, _HANDLE; DMB_ERR_ORDER with a message where it is busy already. sim/access */
int32_t dmb_sim_enter(dmb_sim *sim, int32_t busy);
/* The same for a query, which keeps the message; it writes `busy` only, since no sim is defined const. */
int32_t dmb_sim_occupy(const dmb_sim *sim);
/* Ends the call and returns the status; a failure becomes the thread's last error, with the message of the sim. */
int32_t dmb_sim_leave(dmb_sim *sim, int32_t status);
/* Passes the sim to a public call that is part of the present one, from .. to of it; and takes it back. */
void dmb_sim_hand_on(dmb_sim *sim, double from, double to);
void dmb_sim_resume(dmb_sim *sim);
/* Writes the message of a call rejected for re-entry. */
void dmb_sim_refuse_re_entry(dmb_sim *sim);
/* Progress of a call: start, fraction done, report to the caller. DMB_ERR_CANCELLED if the caller cancels, then and at
 * all later calls. dmb_progress_end: returns that status instead of one caused by it. sim/access */
void dmb_progress_begin(dmb_sim *sim);
void dmb_progress_at(const dmb_sim *sim, double fraction);
int32_t dmb_progress_report(const dmb_sim *sim);
int32_t dmb_progress_end(const dmb_sim *sim, int32_t status);
static inline int32_t dmb_progress_pulse(const dmb_sim *sim)
{
    return sim->progress->function == NULL ? DMB_OK : dmb_progress_report(sim);
}

/* Options of a sim, read from the caller's struct and checked. */

/* Fills out from given (NULL: all defaults). The message names field, value and bound of the first invalid option. The
 * allocator is checked and copied by the caller. Errors: DMB_ERR_STRUCT_SIZE, _VALUE, _NOT_FINITE. */
int32_t dmb_sim_options_get(dmb_sim_options *out, const dmb_sim_options *given, dmb_message *message);

#endif
