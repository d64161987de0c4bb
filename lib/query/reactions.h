/* Joints and constraints at the accepted state. */
#ifndef DMB_QUERY_REACTIONS_H
#define DMB_QUERY_REACTIONS_H

#include "sim/sim.h"

/* Rows that act, the first of its room; and those of them that are dropped because others hold what they hold. */
uint32_t dmb_constraint_active(const dmb_sim *sim, uint32_t constraint);
uint32_t dmb_constraint_redundant(const dmb_sim *sim, uint32_t constraint);
/* Largest violation of an equation of position that joint j holds. */
double dmb_joint_violation(const dmb_sim *sim, uint32_t j);

#endif
