/* Stuck places that let go, and the energy that is lost then. */
#ifndef DMB_SYSTEM_LET_GO_H
#define DMB_SYSTEM_LET_GO_H

#include "sim/sim.h"

/* The ledger takes the energy `before` [J] less that which is stored now for lost. */
void dmb_stuck_lose(dmb_sim *sim, double before);
/* Those of the accepted state whose share has come to 1 let go; returns how many. */
uint32_t dmb_stuck_let_go(dmb_sim *sim);

#endif
