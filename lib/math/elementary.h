/* Sine, cosine, angle and power by additions, multiplications, divisions and square roots alone, which IEEE 754 rounds
 * in one way: the same bits on every processor and with every C library, which choose among theirs at run time. A step
 * and the compile of a scene take such functions from here and from real.h, never from the C library
 * (tests/abi/step_calls). NaN of a NaN. */
#ifndef DMB_MATH_ELEMENTARY_H
#define DMB_MATH_ELEMENTARY_H

#include "math/real.h"

/* Of any x [rad], to 0.8 units in the last place; NaN of infinity. */
double dmb_sin(double x);
double dmb_cos(double x);
void dmb_sin_cos(double x, double *sine, double *cosine);

/* x^y of x >= 0, to 0.9 units in the last place; 0 below 1e-307, NaN for x < 0. x^0 = 1. */
double dmb_pow(double x, double y);

/* Angle of the direction (x, y) [rad], to 2 units in the last place; 0 where both are 0, -0 counts as 0. */
double dmb_atan2(double y, double x);

/* Lane by lane. */
static inline dmb_real dmb_real_pow(dmb_real x, double exponent)
{
    for (int lane = 0; lane < DMB_REAL_LANES; lane++)
        dmb_real_set_lane(&x, lane, dmb_pow(dmb_real_lane(&x, lane), exponent));
    return x;
}

#endif
