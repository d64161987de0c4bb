/* The exponential, in the number of math/real.h. */
#ifndef DMB_MATH_EXPONENTIAL_H
#define DMB_MATH_EXPONENTIAL_H

#include "math/real.h"

#define DMB_LN2_HIGH 0x1.62e42fefa4000p-1 /* 41 bits, so that its product with an exponent is exact */
#define DMB_LN2_LOW -0x1.8432a1b0e2634p-43
#define DMB_LOG2_E 0x1.71547652b82fep+0

/* e^(x + tail) of -708 <= x <= 709, |tail| tiny beside x: e^x = 2^k e^r, k the integer nearest to x/ln 2, |r| <= 0.35, with
 * e^r = 1 + r + r^2 (1/2! + r/3! + ... + r^11/13!). No call, so that it goes side by side. */
static inline dmb_real dmb_real_exp_near(dmb_real x, dmb_real tail)
{
    static const double series[12] = {1.0 / 2.0,       1.0 / 6.0,        1.0 / 24.0,        1.0 / 120.0,
                                      1.0 / 720.0,     1.0 / 5040.0,     1.0 / 40320.0,     1.0 / 362880.0,
                                      1.0 / 3628800.0, 1.0 / 39916800.0, 1.0 / 479001600.0, 1.0 / 6227020800.0};
    const dmb_real shifted = x * DMB_LOG2_E + DMB_ROUNDING, k = shifted - DMB_ROUNDING;
    const dmb_real high = x - k * DMB_LN2_HIGH, low = tail - k * DMB_LN2_LOW;
    const dmb_real r = high + low, rest = (high - r) + low;
    dmb_real sum = dmb_real_of(series[11]);
    for (int i = 10; i >= 0; i--) sum = sum * r + series[i];
    return (1.0 + (r + (r * r * sum + rest))) * dmb_real_power_of_two(shifted);
}

/* e^x to 0.9 units in the last place; 0 below -708, where it would be denormal before long; infinity above 709. */
static inline dmb_real dmb_real_exp(dmb_real x)
{
    const dmb_mask low = dmb_mask_less(x, dmb_real_of(-708.0)), high = dmb_mask_less(dmb_real_of(709.0), x);
    const dmb_real y = dmb_real_exp_near(dmb_real_select(low | high, dmb_real_of(0.0), x), dmb_real_of(0.0));
    return dmb_real_select(low, dmb_real_of(0.0), dmb_real_select(high, dmb_real_of((double)INFINITY), y));
}

#endif
