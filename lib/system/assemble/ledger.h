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

/* ---- Work of forces over a step (eq:motion.work) against the trapezoidal rule of their powers -------------------- */

/* [s] Parts of the step that the forces at its start and end stand for. */
typedef struct dmb_ledger_parts {
    double first, second;
} dmb_ledger_parts;

/* [J] first f0 s0 + second f1 s1 less (first f0 + second f1) (s0 + s1)/2: by how much the trapezoidal rule is above
 * the work of a force [N, N m] at a speed [m/s, rad/s], both at the start and at the end of the step
 * (eq:motion.trapezoid-excess). */
static inline double dmb_ledger_excess(const dmb_ledger_parts *parts, double f0, double s0, double f1, double s1)
{
    return 0.5 * (parts->first * f0 - parts->second * f1) * (s0 - s1);
}

/* [J] The same of the friction of pipes on the axis. */
double dmb_ledger_friction_excess(const dmb_sim *sim, const dmb_ledger_parts *parts);
/* [J] Of the dampers of springs between points. */
double dmb_ledger_spring_excess(const dmb_sim *sim, const dmb_ledger_parts *parts);
/* [J] Of the rock on all bits. */
double dmb_ledger_rock_excess(const dmb_sim *sim, const dmb_ledger_parts *parts);
/* [J] Of friction and dampers of joints. */
void dmb_ledger_joint_excess(const dmb_sim *sim, const dmb_ledger_parts *parts, double *friction, double *damping);
/* [J] Of external damping, and of material damping where it stretches and twists. */
double dmb_ledger_damping_excess(const dmb_sim *sim, const dmb_ledger_parts *parts);
/* [J] Of the friction of rings that touched the wall a few steps ago, and what the friction of those that open in the
 * step (released) has of the trapezoidal rule behind the opening. */
double dmb_ledger_wall_excess(const dmb_sim *sim, const dmb_ledger_parts *parts, int released);
/* now <- trial: the forces and speeds that the next step begins with. */
void dmb_ledger_take_forces(dmb_sim *sim);

#endif
