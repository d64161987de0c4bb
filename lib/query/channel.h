/* Channels of a recorder: one number asked of a sim. */
#ifndef DMB_QUERY_CHANNEL_H
#define DMB_QUERY_CHANNEL_H

#include "drillmbd/query.h"

typedef struct dmb_channel_name {
    const char *name;
    const char *unit;
} dmb_channel_name;

/* Name and unit of a quantity DMB_CHANNEL_...; NULL for an unknown one. */
const dmb_channel_name *dmb_channel_name_of(int32_t quantity);

/* The present value. Errors: those of the query behind it, DMB_ERR_VALUE for an unknown quantity. */
int32_t dmb_channel_value(const dmb_sim *sim, const dmb_channel *channel, double *value);

#endif
