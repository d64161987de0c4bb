/* Events of a sim. */
#ifndef DMB_RUN_EVENTS_H
#define DMB_RUN_EVENTS_H

#include "sim/sim.h"

/* Of a new sim: none is held. */
void dmb_events_begin(dmb_sim *sim);
/* All outputs can be asked of the present state; else the query's error, with a message. */
int32_t dmb_events_check(dmb_sim *sim);

#endif
