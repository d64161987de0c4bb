/* Inputs of an accepted state. */
#ifndef DMB_QUERY_INPUT_QUERY_H
#define DMB_QUERY_INPUT_QUERY_H

#include "sim/sim.h"

/* Value and rate of input i that are in force now: what stands in the place of its programme, else what is set. Errors:
 * those of the programme's callback. */
int32_t dmb_input_present(const dmb_sim *sim, uint32_t i, double *value, double *rate);

#endif
