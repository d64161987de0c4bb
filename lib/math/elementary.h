/* Sine, cosine, angle and power from additions, multiplications, divisions and square roots only, which IEEE 754 rounds
 * uniquely: results are bitwise equal on every processor and with every C library. (C libraries select among their
 * implementations at run time.) A step and the compile of a scene use these functions and those of real.h, never those
 * of the C library (tests/abi/step_calls). NaN gives NaN. */
#ifndef DMB_MATH_ELEMENTARY_H
#define DMB_MATH_ELEMENTARY_H

#include "math/real.h"

/* For any x [rad], to 0.8 units in the last place; NaN for infinity. */
double dmb_sin(double x);
double dmb_cos(double x);
void dmb_sin_cos(double x, double *sine, double *cosine);

/* x^y for x >= 0, to 0.9 units in the last place; 0 below 1e-307, NaN for x < 0. x^0 = 1. */
double dmb_pow(double x, double y);

/* Angle of the direction (x, y) [rad], to 2 units in the last place; 0 if both are 0; -0 counts as 0. */
double dmb_atan2(double y, double x);

/* Lane by lane. */
static inline dmb_real dmb_real_pow(dmb_real x, double exponent)
{
    for (int lane = 0; lane < DMB_REAL_LANES; lane++)
        dmb_real_set_lane(&x, lane, dmb_pow(dmb_real_lane(&x, lane), exponent));
    return x;
}

#endif
