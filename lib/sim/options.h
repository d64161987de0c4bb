/* Options of a sim, read from the caller's struct and checked. */
#ifndef DMB_SIM_OPTIONS_H
#define DMB_SIM_OPTIONS_H

#include "base/message.h"
#include "drillmbd/sim.h"

/* Fills out from given (NULL: all defaults). The message names field, value and bound of the first that is refused.
 * The allocator is checked and copied by the caller. Errors: DMB_ERR_STRUCT_SIZE, _VALUE, _NOT_FINITE. */
int32_t dmb_sim_options_take(dmb_sim_options *out, const dmb_sim_options *given, dmb_message *message);

#endif
