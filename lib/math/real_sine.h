/* Sine and cosine in numbers that are doubles or lanes of doubles (math/real.h), and their parts, which
 * math/elementary.c uses for doubles of any size: the same operations, therefore the same bits. */
#ifndef DMB_MATH_REAL_SINE_H
#define DMB_MATH_REAL_SINE_H

#include "math/real.h"

/* A number as high + low, |low| at most half a unit of high (Dekker 1971, Knuth). */
typedef struct dmb_sum {
    dmb_real high, low;
} dmb_sum;

/* a + b exactly */
static inline dmb_sum dmb_two_sum(dmb_real a, dmb_real b)
{
    const dmb_real sum = a + b, of_b = sum - a;
    const dmb_sum p = {sum, (a - (sum - of_b)) + (b - of_b)};
    return p;
}

/* x = *n pi/2 + rest, |rest| <= pi/4, *n an integer, of |x| <= 1.6e6: pi/2 in parts of 33 bits, whose products with n
 * are exact (Cody, Waite 1980). */
static inline dmb_sum dmb_reduce_near(dmb_real x, dmb_real *n)
{
    const dmb_real shifted = x * 0x1.45f306dc9c883p-1 + DMB_ROUNDING;
    *n = shifted - DMB_ROUNDING;
    const dmb_sum second = dmb_two_sum(x - *n * 0x1.921fb544p+0, -*n * 0x1.0b4611a6p-34);
    const dmb_sum third = dmb_two_sum(second.high, -*n * 0x1.3198a2ep-69);
    return dmb_two_sum(third.high, (second.low + third.low) - *n * 0x1.b839a252049c1p-104);
}

/* x - x^3/3! + ... - x^19/19! of |x| <= pi/4 */
static inline dmb_real dmb_sine_near(dmb_sum x)
{
    static const double series[9] = {-1.0 / 6.0,
                                     1.0 / 120.0,
                                     -1.0 / 5040.0,
                                     1.0 / 362880.0,
                                     -1.0 / 39916800.0,
                                     1.0 / 6227020800.0,
                                     -1.0 / 1307674368000.0,
                                     1.0 / 355687428096000.0,
                                     -1.0 / 121645100408832000.0};
    const dmb_real z = x.high * x.high;
    dmb_real sum = dmb_real_of(series[8]);
    for (int i = 7; i >= 0; i--) sum = sum * z + series[i];
    return x.high + (x.high * z * sum + x.low * (1.0 - 0.5 * z));
}

/* 1 - x^2/2! + ... - x^18/18! */
static inline dmb_real dmb_cosine_near(dmb_sum x)
{
    static const double series[8] = {
        1.0 / 24.0,        -1.0 / 720.0,         1.0 / 40320.0,          -1.0 / 3628800.0,
        1.0 / 479001600.0, -1.0 / 87178291200.0, 1.0 / 20922789888000.0, -1.0 / 6402373705728000.0};
    const dmb_real z = x.high * x.high, half = 0.5 * z, most = 1.0 - half;
    dmb_real sum = dmb_real_of(series[7]);
    for (int i = 6; i >= 0; i--) sum = sum * z + series[i];
    return most + (((1.0 - most) - half) + (z * z * sum - x.high * x.low));
}

/* Sine and cosine of |x| <= 3.9: the number n of quarters is -2 .. 2. Bits of dmb_sin_cos. */
static inline void dmb_real_sin_cos(dmb_real x, dmb_real *sine, dmb_real *cosine)
{
    dmb_real n;
    const dmb_sum rest = dmb_reduce_near(x, &n);
    const dmb_real s = dmb_sine_near(rest), c = dmb_cosine_near(rest), size = dmb_real_abs(n);
    const dmb_mask whole = dmb_mask_less(dmb_real_of(1.5), size); /* n = -2 or 2 */
    const dmb_mask odd = dmb_mask_less(dmb_real_of(0.5), size) & dmb_mask_not(whole);
    *sine = dmb_real_select(odd, dmb_real_follow(n, c), dmb_real_select(whole, -s, s));
    *cosine = dmb_real_select(odd, dmb_real_follow(-n, s), dmb_real_select(whole, -c, c));
}

#endif
