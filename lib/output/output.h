/* Recorders, windows and the counting of cycles, as sources of this folder use each other. */
#ifndef DMB_OUTPUT_OUTPUT_H
#define DMB_OUTPUT_OUTPUT_H

#include <stdint.h>

#include "drillmbd/output.h"

/* ---- Recorders --------------------------------------------------------------------------------------------------- */

/* Copies the caller's struct. Errors: DMB_ERR_NULL, _STRUCT_SIZE, _NOT_FINITE, _VALUE. */
int32_t dmb_recorder_take_struct(dmb_recorder *out, const dmb_recorder *given);

/* 1: the next sample is due: samples belong to whole multiples of the interval [s] since the first one, so that they do
 * not drift with the steps; with an interval of 0 each is. */
int dmb_sample_is_due(double interval, double first, double last, double time);

/* Rows of `width` doubles written to a table with room for `capacity`: 1 if all sizes fit. */
int dmb_table_fits(uint64_t row_count, uint64_t capacity, uint64_t width);

/* ---- Windows ----------------------------------------------------------------------------------------------------- */

/* A number of a window, as a channel of a recorder. */

/* The value of a channel DMB_CHANNEL_WINDOW_MINIMUM .. _WINDOW_LOW_SHARE. Errors: those of dmb_window_get. */
int32_t dmb_window_value(const dmb_window *window, const dmb_channel *channel, double *value);

/* ---- Cycles of fatigue ------------------------------------------------------------------------------------------- */

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
