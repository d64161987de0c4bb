/* Energy ledger: work of each class of force by the trapezoidal rule over accepted steps. At every accepted instant the
 * powers of all forces sum to zero (residual times velocity), so what is missing between their integrals and the
 * energies is what the time integration took out; nothing is set by closing the balance. */
#ifndef DMB_SYSTEM_LEDGER_H
#define DMB_SYSTEM_LEDGER_H

#include "system/assemble/evaluation.h"

/* Sets the ledger to zero at the present state (now) with the powers of the evaluation. */
void dmb_ledger_start(dmb_sim *sim, const dmb_evaluation *evaluation);
/* The powers of the evaluation hold from now on; nothing is added. */
void dmb_ledger_jump(dmb_sim *sim, const dmb_evaluation *evaluation);
/* Adds the step from now to trial; before the swap. */
/* Losses of an impact between two steps [J]: kinetic energy of bodies, and stored energy that is let go. */
void dmb_ledger_take_impact(dmb_sim *sim, double kinetic, double stored);
/* The caller has changed what stores energy, and the poses store this much more [J]: work of loads. */
void dmb_ledger_take_change(dmb_sim *sim, double stored);
void dmb_ledger_add(dmb_sim *sim, const dmb_evaluation *evaluation);

#endif
