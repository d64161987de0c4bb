/* The number type of vec3, mat6, so3, se3 and element/beam_math: a double; or, in a file that defines DMB_LANES before
 * it includes them, a compiler vector of that many doubles. Each lane performs the same operations in the same order as
 * a single double, so that results are bitwise equal. Where a double would branch, all lanes take the frequent branch
 * together and the others are corrected one by one. */
#ifndef DMB_MATH_REAL_H
#define DMB_MATH_REAL_H

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>
#if FLT_EVAL_METHOD == 1 || FLT_EVAL_METHOD == 2
#error "doubles must be evaluated as doubles, on 32-bit x86 with -msse2 -mfpmath=sse"
#endif

#define DMB_PI 3.14159265358979323846
#define DMB_TWO_PI 6.283185307179586477
#define DMB_ROUNDING 0x1.8p52 /* added and subtracted again, it rounds a number below 2^51 to an integer */

/* Short, frequent products are always inlined: a call with lanes would pass its vectors through memory. */
#if defined(__GNUC__) && defined(DMB_LANES) && !defined(DMB_COUNTED)
#define DMB_REAL_INLINE static inline __attribute__((always_inline))
#else
#define DMB_REAL_INLINE static inline
#endif

#ifndef DMB_LANES

#define DMB_REAL_LANES 1
typedef double dmb_real;

static inline dmb_real dmb_real_of(double x)
{
    return x;
}
static inline double dmb_real_lane(const dmb_real *x, int lane)
{
    (void)lane;
    return *x;
}
static inline void dmb_real_set_lane(dmb_real *x, int lane, double value)
{
    (void)lane;
    *x = value;
}
static inline dmb_real dmb_real_abs(dmb_real x)
{
    return fabs(x);
}
static inline dmb_real dmb_real_max(dmb_real a, dmb_real b)
{
    return a > b ? a : b;
}
/* x with its sign changed if s < 0 */
static inline dmb_real dmb_real_follow(dmb_real s, dmb_real x)
{
    return s < 0.0 ? -x : x;
}
/* 1 if every lane of a is below that of b; 0 for NaN */
static inline int dmb_real_below(dmb_real a, dmb_real b)
{
    return a < b;
}

/* Result of a comparison, lane by lane; combined by & and |. */
typedef int dmb_mask;

static inline dmb_mask dmb_mask_less(dmb_real a, dmb_real b)
{
    return a < b;
}
static inline dmb_mask dmb_mask_at_most(dmb_real a, dmb_real b)
{
    return a <= b;
}
static inline dmb_mask dmb_mask_not(dmb_mask mask)
{
    return !mask;
}
static inline int dmb_mask_any(dmb_mask mask)
{
    return mask;
}
static inline uint32_t dmb_mask_bits(dmb_mask mask)
{
    return mask != 0;
}
/* a where the mask holds, else b */
static inline dmb_real dmb_real_select(dmb_mask mask, dmb_real a, dmb_real b)
{
    return mask ? a : b;
}
/* 2^k for k from -1022 to 1023, given as k + DMB_ROUNDING: its lowest bits are k. */
static inline dmb_real dmb_real_power_of_two(dmb_real shifted)
{
    uint64_t bits;
    memcpy(&bits, &shifted, sizeof bits);
    bits = (bits << 52) + (UINT64_C(1023) << 52);
    memcpy(&shifted, &bits, sizeof bits);
    return shifted;
}

#else

/* Processors have instructions for operations that the language of compiler vectors lacks. */
#if (DMB_LANES == 4 && defined(__AVX2__)) || (DMB_LANES == 8 && defined(__AVX512F__))
#include <immintrin.h>
#define DMB_LANES_NATIVE
#endif

#define DMB_REAL_LANES DMB_LANES
typedef double dmb_real __attribute__((vector_size(8 * DMB_LANES)));
typedef int64_t dmb_real_bits __attribute__((vector_size(8 * DMB_LANES)));
typedef uint64_t dmb_real_word __attribute__((vector_size(8 * DMB_LANES)));

static inline dmb_real dmb_real_of(double x)
{
    return x - (dmb_real){0.0};
}
static inline double dmb_real_lane(const dmb_real *x, int lane)
{
    return (*x)[lane];
}
static inline void dmb_real_set_lane(dmb_real *x, int lane, double value)
{
    (*x)[lane] = value;
}
static inline dmb_real dmb_real_abs(dmb_real x)
{
    return (dmb_real)((dmb_real_bits)x & INT64_MAX);
}
static inline dmb_real dmb_real_max(dmb_real a, dmb_real b)
{
    const dmb_real_bits first = (dmb_real_bits)(a > b);
    return (dmb_real)(((dmb_real_bits)a & first) | ((dmb_real_bits)b & ~first));
}
static inline dmb_real dmb_real_follow(dmb_real s, dmb_real x)
{
    const dmb_real_bits turned = (dmb_real_bits)(s < dmb_real_of(0.0));
    return (dmb_real)((dmb_real_bits)x ^ (turned & INT64_MIN));
}
typedef dmb_real_bits dmb_mask;

static inline dmb_mask dmb_mask_less(dmb_real a, dmb_real b)
{
    return (dmb_mask)(a < b);
}
static inline dmb_mask dmb_mask_at_most(dmb_real a, dmb_real b)
{
    return (dmb_mask)(a <= b);
}
static inline dmb_mask dmb_mask_not(dmb_mask mask)
{
    return ~mask;
}
/* One bit for each lane. */
static inline uint32_t dmb_mask_bits(dmb_mask mask)
{
#ifndef DMB_LANES_NATIVE
    uint32_t bits = 0;
    for (int lane = 0; lane < DMB_LANES; lane++) bits |= (uint32_t)(mask[lane] & 1) << lane;
    return bits;
#elif DMB_LANES == 4
    return (uint32_t)_mm256_movemask_pd((__m256d)mask);
#else
    return _mm512_test_epi64_mask((__m512i)mask, (__m512i)mask);
#endif
}
static inline int dmb_mask_any(dmb_mask mask)
{
    return dmb_mask_bits(mask) != 0;
}
static inline int dmb_real_below(dmb_real a, dmb_real b)
{
    return dmb_mask_bits(dmb_mask_less(a, b)) == (1u << DMB_LANES) - 1;
}
static inline dmb_real dmb_real_select(dmb_mask mask, dmb_real a, dmb_real b)
{
    return (dmb_real)(((dmb_real_bits)a & mask) | ((dmb_real_bits)b & ~mask));
}
static inline dmb_real dmb_real_power_of_two(dmb_real shifted)
{
    return (dmb_real)(((dmb_real_word)shifted << 52) + (UINT64_C(1023) << 52));
}

#endif

/* Square root, which IEEE 754 rounds exactly. */
static inline dmb_real dmb_real_sqrt(dmb_real x)
{
#ifndef DMB_LANES_NATIVE
    for (int lane = 0; lane < DMB_REAL_LANES; lane++) dmb_real_set_lane(&x, lane, sqrt(dmb_real_lane(&x, lane)));
    return x;
#elif DMB_LANES == 4
    return (dmb_real)_mm256_sqrt_pd((__m256d)x);
#else
    return (dmb_real)_mm512_sqrt_pd((__m512d)x);
#endif
}

/* atan2(y, x) by atan(r) = sum (-r^2)^k r/(2k+1), r the smaller of |x|, |y| over the larger, brought below tan(pi/8) by
 * atan(r) = pi/4 + atan((r - 1)/(r + 1)). No call, so that it goes side by side; NaN where both are 0,
 * and -0 counts as 0. */
static inline dmb_real dmb_real_atan2(dmb_real y, dmb_real x)
{
    static const double odd[22] = {1.0,        1.0 / 3.0,  1.0 / 5.0,  1.0 / 7.0,  1.0 / 9.0,  1.0 / 11.0,
                                   1.0 / 13.0, 1.0 / 15.0, 1.0 / 17.0, 1.0 / 19.0, 1.0 / 21.0, 1.0 / 23.0,
                                   1.0 / 25.0, 1.0 / 27.0, 1.0 / 29.0, 1.0 / 31.0, 1.0 / 33.0, 1.0 / 35.0,
                                   1.0 / 37.0, 1.0 / 39.0, 1.0 / 41.0, 1.0 / 43.0};
    const dmb_real zero = dmb_real_of(0.0), ax = dmb_real_abs(x), ay = dmb_real_abs(y);
    const dmb_mask steep = dmb_mask_less(ax, ay);
    const dmb_real large = dmb_real_select(steep, ay, ax), small = dmb_real_select(steep, ax, ay);
    const dmb_mask wide = dmb_mask_less(0.41421356237309503 * large, small);
    const dmb_real r = dmb_real_select(wide, small - large, small) / dmb_real_select(wide, small + large, large);
    const dmb_real z = -(r * r);
    dmb_real angle = dmb_real_of(odd[21]);
    for (int k = 20; k >= 0; k--) angle = angle * z + odd[k];
    angle = angle * r + dmb_real_select(wide, dmb_real_of(0.25 * DMB_PI), zero);
    angle = dmb_real_select(steep, 0.5 * DMB_PI - angle, angle);
    angle = dmb_real_select(dmb_mask_less(x, zero), DMB_PI - angle, angle);
    return dmb_real_follow(y, angle);
}

#define DMB_LN2_HIGH 0x1.62e42fefa4000p-1 /* 41 bits, so that its product with an exponent is exact */
#define DMB_LN2_LOW -0x1.8432a1b0e2634p-43
#define DMB_LOG2_E 0x1.71547652b82fep+0

/* e^(x + tail) of -708 <= x <= 709, |tail| much smaller than |x|: e^x = 2^k e^r, k the integer nearest to x/ln 2, |r|
 * <= 0.35, with e^r = 1 + r + r^2 (1/2! + r/3! + ... + r^11/13!). No call, so that it vectorises. */
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

/* e^x to 0.9 units in the last place; 0 below -708, near the denormal range; infinity above 709. */
static inline dmb_real dmb_real_exp(dmb_real x)
{
    const dmb_mask low = dmb_mask_less(x, dmb_real_of(-708.0)), high = dmb_mask_less(dmb_real_of(709.0), x);
    const dmb_real y = dmb_real_exp_near(dmb_real_select(low | high, dmb_real_of(0.0), x), dmb_real_of(0.0));
    return dmb_real_select(low, dmb_real_of(0.0), dmb_real_select(high, dmb_real_of((double)INFINITY), y));
}

#endif
