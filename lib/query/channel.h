/* Channels: one number asked of a sim, for recorders, windows, responses and events. channel_name has their names;
 * dmb_channel_value is the one owner of their values. */
#ifndef DMB_QUERY_CHANNEL_H
#define DMB_QUERY_CHANNEL_H

#include "drillmbd/output.h"

/* Kinds of places that channels take. */
enum {
    DMB_AT_PLACE = 0,   /* any place on a string, body or bit */
    DMB_AT_SECTION = 1, /* a place on a flexible or axial-torsional pipe */
    DMB_AT_PIPE = 2,    /* a place on a string */
    DMB_AT_PART = 3,    /* a pipe of a string, a body or a bit */
    DMB_AT_STRING = 4,  /* a string or {0, 0} */
    DMB_AT_BIT = 5,     /* and so on: place.part alone */
    DMB_AT_DRIVE = 6,
    DMB_AT_JOINT = 7,
    DMB_AT_CONSTRAINT = 8, /* a joint, coupling, constraint or joint drive */
    DMB_AT_SITE = 9,       /* place.pipe alone, a contact site */
    DMB_AT_SCENE = 10,     /* ignored */
    DMB_AT_WINDOW = 11,    /* place.pipe alone, a watched channel */
    DMB_AT_STUCK = 12,     /* place.part alone */
    DMB_AT_SPRING = 13,
    DMB_AT_INPUT = 14
};

typedef struct dmb_channel_entry {
    const char *name;
    const char *unit;
    int32_t quantity;
    int32_t place; /* DMB_AT_... */
} dmb_channel_entry;

/* NULL for an unknown quantity. */
const dmb_channel_entry *dmb_channel_name_of(int32_t quantity);

/* The present value. Errors: those of dmb_query_channel. */
int32_t dmb_channel_value(const dmb_sim *sim, const dmb_channel *channel, double *value);

/* Those of a driller, DMB_CHANNEL_HOOK_LOAD .. _RIG_TORQUE; an unknown number is DMB_ERR_VALUE. */
int32_t dmb_driller_value(const dmb_sim *sim, const dmb_channel *channel, double *value);
/* The string that such a channel means: the id and its number, the model's first for {0, 0}. DMB_ERR_ID. */
int32_t dmb_channel_string(const dmb_sim *sim, const dmb_channel *channel, dmb_id *string, uint32_t *index);

#endif
