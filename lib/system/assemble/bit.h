/* Bits at work: bottom-hole load and the rock law, along and about the axis of the hole. */
#ifndef DMB_SYSTEM_ASSEMBLE_BIT_H
#define DMB_SYSTEM_ASSEMBLE_BIT_H

#include "sim/sim.h"
#include "system/assemble/evaluation.h"

typedef struct dmb_bit_rock_result dmb_bit_rock_result;

/* Rock law's answer and the bottom-hole load [N] of a bit in the accepted state. */
void dmb_bit_force_of(const dmb_sim *sim, uint32_t bit, dmb_bit_rock_result *out, double *load);
/* [m/s] of a bit along the axis of the hole in the accepted state, the rate of its advance. */
/* [N] of the rock across the bit's axis, world frame; the speed across it [m/s]. 0 where it does not cut sideways. */
double dmb_bit_side_of(const dmb_sim *sim, uint32_t k, double force[3]);
double dmb_bit_speed_of(const dmb_sim *sim, uint32_t bit);
/* Motion of a bit along and about the axis of the hole, in the body frame of its node, and slopes of weight and torque
 * by advance, angle, speed and spin. */
typedef struct dmb_bit_slope {
    double along[6], about[6];
    double weight[4]; /* [N/m, N/rad, N s/m, N s/rad] */
    double torque[4]; /* [N, N m/rad, N s, N m s/rad] */
} dmb_bit_slope;
void dmb_bit_slope_of(const dmb_sim *sim, uint32_t bit, dmb_bit_slope *out);
/* The history of a bit as the rock law takes it. */
dmb_bit_history dmb_bit_history_of(const dmb_sim *sim, uint32_t bit);
/* Flat rock at the described distance, at the start. */
void dmb_bit_start(dmb_sim *sim, uint32_t bit);
/* 1: the bit stands on the rock; at time 0 as described. */
int dmb_bit_on_bottom(const dmb_sim *sim, uint32_t bit);
/* Rock as after drilling on for long at the speed and spin of the accepted state. */
void dmb_bit_start_steady(dmb_sim *sim, uint32_t bit);
/* Stores what a finished step cut. */
void dmb_bit_accept(const dmb_evaluation *evaluation, uint32_t bit);

void dmb_gather_bits(dmb_evaluation *evaluation);

#endif
