/* Force of a one-sided law over a step in which it closes or opens (eq:unilateral.mean): the mean force that removes as
 * much energy from the bodies as the law stores. Pure functions. */
#ifndef DMB_FORCE_UNILATERAL_H
#define DMB_FORCE_UNILATERAL_H

#include "force/spring_law.h"
#include "math/real.h"

/* ---- Mean elastic force over a step: the discrete gradient of the stored energy (eq:unilateral.mean) ------------- */

/* [-] of the places, below which the mean over the way is the force in its middle. */
#define DMB_MEAN_NEAR 1e-9

/* Place x [m, rad] of a force, energy V(x) that it stores [J], dV/dx and d2V/dx2. */
typedef struct dmb_mean_end {
    dmb_real place, energy, force, slope;
} dmb_mean_end;

/* (V1 - V0)/(x1 - x0) and its derivative by x1. */
static inline void dmb_mean_elastic(const dmb_mean_end *a, const dmb_mean_end *b, dmb_real *force, dmb_real *by_place)
{
    const dmb_real way = b->place - a->place, middle = 0.5 * (a->force + b->force);
    const dmb_mask far =
        dmb_mask_less(DMB_MEAN_NEAR * (dmb_real_abs(a->place) + dmb_real_abs(b->place)), dmb_real_abs(way));
    const dmb_real divisor = dmb_real_select(far, way, dmb_real_of(1.0));
    *force = dmb_real_select(far, (b->energy - a->energy) / divisor, middle);
    *by_place = dmb_real_select(far, (b->force - *force) / divisor, 0.5 * b->slope);
}

/* ---- Stops and one-sided springs --------------------------------------------------------------------------------- */

/* State of a law at one place x of its coordinate (elongation of a spring, coordinate of a joint). */
typedef struct dmb_unilateral_end {
    double place;  /* [m, rad] x */
    double depth;  /* [m, rad] beyond the bound, with the sign of its side; 0: open */
    double energy; /* [J] V(x) */
    double force;  /* [N, N m] dV/dx; the force on the body is the opposite */
    double slope;  /* [N/m, N m/rad] d2V/dx2 */
    int32_t closed;
    int32_t reserved;
} dmb_unilateral_end;

typedef struct dmb_unilateral_mean {
    double force;      /* [N, N m] G = (V1 - V0)/(x1 - x0) + c (d1 - d0)/h, never pulling */
    double by_place;   /* dG/dx1 */
    double dissipated; /* [J] G (x1 - x0) - (V1 - V0), never negative */
} dmb_unilateral_mean;

/* 1 if the stop of a joint's coordinate can act. */
int dmb_stop_acts(const dmb_joint_law *law);
void dmb_stop_at(const dmb_joint_law *law, double place, dmb_unilateral_end *end);

/* The spring of a joint's coordinate, which acts on both sides and is never open. */
void dmb_joint_spring_end_at(const dmb_joint_law *law, double place, dmb_unilateral_end *end);

/* 1 if the elastic force of a spring may begin or end: one-sided, or by a table. */
int dmb_spring_can_open(const dmb_spring_law *law);
void dmb_spring_end_at(const dmb_spring_law *law, const dmb_spring_point *points, double elongation,
                       dmb_unilateral_end *end);

/* 1 if it closes between a and b, also if it changes from one side to the other. */
int dmb_unilateral_touches(const dmb_unilateral_end *a, const dmb_unilateral_end *b);
/* Computes the mean force from a to b in a step of length [s]; damping [N s/m, N m s/rad] acts along the closed part of
 * the displacement. */
void dmb_unilateral_mean_of(const dmb_unilateral_end *a, const dmb_unilateral_end *b, double damping, double step,
                            dmb_unilateral_mean *mean);

#endif
