/* Work that forces do over a step of generalized-alpha, against the trapezoidal rule of their powers (THEORY 4, "Energy
 * ledger"). */
#ifndef DMB_SYSTEM_ASSEMBLE_LEDGER_WORK_H
#define DMB_SYSTEM_ASSEMBLE_LEDGER_WORK_H

#include "sim/sim.h"

/* [s] Parts of the step that the forces at its start and end stand for. */
typedef struct dmb_ledger_parts {
    double first, second;
} dmb_ledger_parts;

/* [J] first f0 s0 + second f1 s1 less (first f0 + second f1) (s0 + s1)/2: by how much the trapezoidal rule is above
 * the work of a force [N, N m] at a speed [m/s, rad/s], both at the start and at the end of the step. */
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
