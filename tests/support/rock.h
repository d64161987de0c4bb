/* Steady weight and torque of the rock law, in closed form (eq:bit.forces). */
#ifndef DRILLMBD_TESTS_ROCK_H
#define DRILLMBD_TESTS_ROCK_H

#include "drillmbd/drillmbd.h"

/* [N] at the depth of cut d a revolution. */
static inline double weight_at(const dmb_bit_def *b, double d)
{
    return (b->radius - b->inner_radius) *
           (b->cutting_ratio * b->intrinsic_energy * d + b->contact_strength * b->wear_length);
}

/* [N m] */
static inline double torque_at(const dmb_bit_def *b, double d)
{
    return 0.5 * (b->radius * b->radius - b->inner_radius * b->inner_radius) *
           (b->intrinsic_energy * d + b->contact_friction * b->contact_strength * b->wear_length);
}

#endif
