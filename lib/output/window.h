/* A number of a window, as a channel of a recorder. */
#ifndef DMB_OUTPUT_WINDOW_H
#define DMB_OUTPUT_WINDOW_H

#include "drillmbd/output.h"

/* The value of a channel DMB_CHANNEL_WINDOW_MINIMUM .. _WINDOW_LOW_SHARE. Errors: those of dmb_window_get. */
int32_t dmb_window_value(const dmb_window *window, const dmb_channel *channel, double *value);

#endif
