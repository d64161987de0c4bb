/* One number of a profile. */
#ifndef DMB_QUERY_PROFILE_H
#define DMB_QUERY_PROFILE_H

#include "drillmbd/query.h"
#include "sim/sim.h"

/* A quantity DMB_PROFILE_... at a place of a string. Errors: DMB_ERR_VALUE, _ID, _NOT_FINITE. O(runs of pipes). */
int32_t dmb_profile_value(const dmb_sim *sim, dmb_place place, int32_t quantity, double *value);

#endif
