/* Energy ledger: work of each class of force over accepted steps. At every accepted instant the powers of all forces
 * sum to zero (residual times velocity), so the difference between their integrals and the energies is the error of the
 * time integration; no term is computed by closing the balance. */
#ifndef DMB_SYSTEM_ASSEMBLE_LEDGER_H
#define DMB_SYSTEM_ASSEMBLE_LEDGER_H

#include "sim/sim.h"
#include "system/assemble/evaluation.h"

/* [J] Error of the balance: work done less dissipation and present energy `stored`; 0 in continuous time. */
double dmb_ledger_balance(const dmb_ledger *ledger, double stored);
/* [J] The same at an earlier time, from stored balances; 0 before the first. */
double dmb_ledger_balance_before(const dmb_ledger *ledger, double time);
/* Sets the ledger to zero at the present state (now) with the powers of the evaluation. */
void dmb_ledger_start(dmb_sim *sim, const dmb_evaluation *evaluation);
/* After a jump: powers of the evaluation and forces of the trial apply from now on; no work is added. */
void dmb_ledger_jump(dmb_sim *sim, const dmb_evaluation *evaluation);
/* Adds the losses of an impact between two steps [J]: kinetic energy of bodies, and released stored energy. */
void dmb_ledger_add_impact(dmb_sim *sim, double kinetic, double stored);
/* Adds the loss of energy [J] stored in the wall that cutters have removed. */
void dmb_ledger_add_rock(dmb_sim *sim, double stored);
/* After a change of parameters by the caller: the poses store this much more energy [J], added to the work of loads. */
void dmb_ledger_add_change(dmb_sim *sim, double stored);
/* Moves [J] of the trapezoidal rule of the powers `kind`, in excess of the work of the step, to the work of potential
 * forces. */
void dmb_ledger_move(dmb_sim *sim, int kind, double excess);
/* Adds the step from now to trial; before they are exchanged. released: contacts opened in it, with released_power. */
void dmb_ledger_add(dmb_sim *sim, const dmb_evaluation *evaluation, int released);

/* ---- Work of forces over a step (eq:motion.work) against the trapezoidal rule of their powers -------------------- */

/* [s] Weights of the forces at the start and end of the step. */
typedef struct dmb_ledger_parts {
    double first, second;
} dmb_ledger_parts;

/* [J] first f0 s0 + second f1 s1 less (first f0 + second f1) (s0 + s1)/2: excess of the trapezoidal rule over the work
 * of a force [N, N m] at a speed [m/s, rad/s], both at the start and at the end of the step
 * (eq:motion.trapezoid-excess). */
static inline double dmb_ledger_excess(const dmb_ledger_parts *parts, double f0, double s0, double f1, double s1)
{
    return 0.5 * (parts->first * f0 - parts->second * f1) * (s0 - s1);
}

/* [J] The same for friction of axial-torsional contact points. */
double dmb_ledger_friction_excess(const dmb_sim *sim, const dmb_ledger_parts *parts);
/* [J] The same for dampers of springs between points. */
double dmb_ledger_spring_excess(const dmb_sim *sim, const dmb_ledger_parts *parts);
/* [J] The same for the rock on all bits. */
double dmb_ledger_rock_excess(const dmb_sim *sim, const dmb_ledger_parts *parts);
/* [J] The same for friction and dampers of joints. */
void dmb_ledger_joint_excess(const dmb_sim *sim, const dmb_ledger_parts *parts, double *friction, double *damping);
/* [J] The same for external damping, and for material damping in axial and torsional deformation. */
double dmb_ledger_damping_excess(const dmb_sim *sim, const dmb_ledger_parts *parts);
/* [J] The same for friction of contact points that touched the wall a few steps ago, and the trapezoidal rule after the
 * opening for friction of those that open in the step (released). */
double dmb_ledger_wall_excess(const dmb_sim *sim, const dmb_ledger_parts *parts, int released);
/* now <- trial: forces and speeds at the start of the next step. */
void dmb_ledger_copy_forces(dmb_sim *sim);

#endif
