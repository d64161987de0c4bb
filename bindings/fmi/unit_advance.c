#include "unit.h"

#include <math.h>

/* Shares of a step that count as rounding: of the times that the importer adds up, and of a last step. */
static const double same_time = 1e-9, no_step = 1e-6;

static unit_status failed(const unit *u, int32_t status)
{
    return unit_tell(u, UNIT_ERROR, "step failed at %.9g s: %s: %s", dmb_sim_time(u->sim), dmb_status_name(status),
                     dmb_sim_message(u->sim));
}

/* The status of a step that was done. */
static unit_status noted(const unit *u, int32_t status)
{
    if (status == DMB_NOTE_WORK_LIMITED || status == DMB_NOTE_TOLERANCE)
        return unit_tell(u, UNIT_WARNING, "%s: %s", dmb_status_text(status), dmb_sim_message(u->sim));
    return UNIT_OK;
}

static unit_status worse(unit_status a, unit_status b)
{
    return a > b ? a : b;
}

/* Equal steps, and a shorter last one where they do not fit. */
static unit_status by_steps(unit *u, double length)
{
    const double count = floor(length / u->step + no_step), rest = length - count * u->step;
    unit_status result = UNIT_OK;
    for (uint64_t left = (uint64_t)fmin(count, 1e18); left > 0; --left) {
        const int32_t status = dmb_sim_step(u->sim, u->step, NULL);
        if (status < 0) return failed(u, status);
        result = worse(result, noted(u, status));
    }
    if (rest <= no_step * u->step) return result;
    const int32_t status = dmb_sim_step(u->sim, rest, NULL);
    return status < 0 ? failed(u, status) : worse(result, noted(u, status));
}

/* The library's own steps; max_steps of the scene bounds one call of them only. */
static unit_status by_library(unit *u, double end)
{
    int32_t status;
    unit_status result = UNIT_OK;
    do {
        status = dmb_sim_advance(u->sim, end, NULL);
        if (status < 0) return failed(u, status);
        result = worse(result, noted(u, status));
    } while (status == DMB_NOTE_STOPPED);
    return result;
}

static unit_status to_events(unit *u, double end, int stops_early, int *at_event)
{
    unit_status result = UNIT_OK;
    while (dmb_sim_time(u->sim) < end) {
        dmb_event_report event = dmb_event_report_default();
        const int32_t status = dmb_sim_advance_to_event(u->sim, end, &event, NULL);
        if (status < 0) return failed(u, status);
        result = worse(result, noted(u, status));
        *at_event = event.count > 0;
        for (uint32_t i = 0; i < u->event_count; ++i) u->told[i] += (uint32_t)(event.events >> i & 1u);
        if (event.count > 0 && stops_early) break;
        if (status != DMB_NOTE_EVENT && status != DMB_NOTE_STOPPED) break;
    }
    return result;
}

static unit_status check_advance(const unit *u, double time, double length)
{
    const double now = dmb_sim_time(u->sim);
    if (!(length >= 0.0 && length <= 1e18))
        return unit_tell(u, UNIT_ERROR, "step refused: communication step size = %g s, must be 0 .. 1e18", length);
    if (!(fabs(time - now) <= same_time * (1.0 + fabs(now)) + no_step * u->step))
        return unit_tell(u, UNIT_ERROR,
                         "step refused: communication point = %.9g s, the unit is at %.9g s; save its state to "
                         "go back",
                         time, now);
    return UNIT_OK;
}

unit_status unit_advance(unit *u, double time, double length, int stops_early, unit_reached *reached)
{
    unit_status result = unit_require(u, 1u << UNIT_STEPPING, "do step");
    if (result == UNIT_OK) result = check_advance(u, time, length);
    if (result != UNIT_OK) return result;
    const double now = dmb_sim_time(u->sim), end = time + length;
    reached->at_event = 0;
    if (length > 0.0) {
        /* where only rounding lies between the importer's time and ours, its step is taken as it is */
        const double left = fabs(time - now) <= same_time * length ? length : end - now;
        if (u->event_count > 0)
            result = to_events(u, end, stops_early, &reached->at_event);
        else if (u->step > 0.0)
            result = by_steps(u, left);
        else
            result = by_library(u, end);
    }
    reached->time = reached->at_event && stops_early ? dmb_sim_time(u->sim) : end;
    return result;
}
