/* Energy ledger: work of each class of force over accepted steps. At every accepted instant the powers of all forces
 * sum to zero (residual times velocity), so what is missing between their integrals and the energies is what the time
 * integration took out; nothing is set by closing the balance. */
#ifndef DMB_SYSTEM_ASSEMBLE_LEDGER_H
#define DMB_SYSTEM_ASSEMBLE_LEDGER_H

#include "sim/sim.h"
#include "system/assemble/evaluation.h"

/* [J] what went in less what was spent and what is stored, of which there is `stored` now; 0 in continuous time. */
double dmb_ledger_balance(const dmb_ledger *ledger, double stored);
/* [J] the same at an earlier time, from the balances that are kept; 0 before the first of them. */
double dmb_ledger_balance_before(const dmb_ledger *ledger, double time);
/* Sets the ledger to zero at the present state (now) with the powers of the evaluation. */
void dmb_ledger_start(dmb_sim *sim, const dmb_evaluation *evaluation);
/* The powers of the evaluation, and the forces of the trial, hold from now on; nothing is added. */
void dmb_ledger_jump(dmb_sim *sim, const dmb_evaluation *evaluation);
/* Losses of an impact between two steps [J]: kinetic energy of bodies, and stored energy that is let go. */
void dmb_ledger_take_impact(dmb_sim *sim, double kinetic, double stored);
/* [J] that the wall stored where cutters have widened the hole: it goes with the rock. */
void dmb_ledger_take_rock(dmb_sim *sim, double stored);
/* The caller has changed what stores energy, and the poses store this much more [J]: work of loads. */
void dmb_ledger_take_change(dmb_sim *sim, double stored);
/* [J] of the powers in `kind` that the trapezoidal rule has beyond what the step did: work of potential forces. */
void dmb_ledger_move(dmb_sim *sim, int kind, double excess);
/* Adds the step from now to trial; before the swap. released: contacts opened in it, which took released_power. */
void dmb_ledger_add(dmb_sim *sim, const dmb_evaluation *evaluation, int released);

#endif
