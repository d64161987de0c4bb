/* A string's state over its length. */
#ifndef DMB_QUERY_PROFILE_H
#define DMB_QUERY_PROFILE_H

#include "drillmbd/query.h"
#include "sim/sim.h"

/* Groups of quantities that are computed together, and only where one of them is asked for. */
enum {
    DMB_TAKES_STATION = 0,
    DMB_TAKES_POSE = 1,
    DMB_TAKES_SECTION = 2,
    DMB_TAKES_CONTACT = 4,
    DMB_TAKES_LIMITS = 8,
    DMB_TAKES_MOTION = 16
};

/* Groups that DMB_PROFILE_... takes; -1: there is no such quantity. */
int32_t dmb_profile_groups(int32_t quantity);

/* A quantity DMB_PROFILE_... at a place of a string. Errors: DMB_ERR_VALUE, _ID, _NOT_FINITE. O(runs of pipes). */
int32_t dmb_profile_value(const dmb_sim *sim, dmb_place place, int32_t quantity, double *value);

#endif
