/* The state at time 0, and accelerations that fit a given pose and speed. */
#ifndef DMB_SYSTEM_START_H
#define DMB_SYSTEM_START_H

#include "sim/sim.h"

/* Described poses and speeds, speeds projected onto the allowed motion, consistent accelerations, ledger at zero.
 * Returns DMB_OK, DMB_NOTE_PROJECTED with a message, or why there is no start. */
int32_t dmb_system_start(dmb_sim *sim);
/* After a jump of a force or of a prescribed acceleration at the present time: a0 = v' = what fits the state now
 * (THEORY 4). On failure nothing has changed but trial and work. */
int32_t dmb_system_jump(dmb_sim *sim);
/* Consistent accelerations, drive forces, contact state and ledger for the pose and speeds of now. */
int32_t dmb_system_restart(dmb_sim *sim);

#endif
