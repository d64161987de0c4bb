/* A recorder as the caller filled it, checked. */
#ifndef DMB_OUTPUT_RECORDER_H
#define DMB_OUTPUT_RECORDER_H

#include "drillmbd/output.h"

/* Copies the caller's struct. Errors: DMB_ERR_NULL, _STRUCT_SIZE, _NOT_FINITE, _VALUE. */
int32_t dmb_recorder_take_struct(dmb_recorder *out, const dmb_recorder *given);

/* 1: the next sample is due: samples belong to whole multiples of the interval [s] since the first one, so that they do
 * not drift with the steps; with an interval of 0 each is. */
int dmb_sample_is_due(double interval, double first, double last, double time);

/* Rows of `width` doubles written to a table with room for `capacity`: 1 if all sizes fit. */
int dmb_table_fits(uint64_t row_count, uint64_t capacity, uint64_t width);

#endif
