/* The number that vec3, mat6, so3, se3 and element/beam_math are written in: a double; or, in a file that defines
 * DMB_LANES before it includes them, that many doubles side by side, a vector of the compiler. Each lane goes through the
 * very operations, in the same order, that a double alone goes through, so all of them give the same bits. Where a
 * double would branch, lanes take the frequent branch together and the few others are put right one by one. */
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
#define DMB_ROUNDING 0x1.8p52 /* added and taken off again, it rounds a number below 2^51 to an integer */

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
/* x with its sign changed where s < 0 */
static inline dmb_real dmb_real_follow(dmb_real s, dmb_real x)
{
    return s < 0.0 ? -x : x;
}
/* 1 if every lane of a is below that of b; not so for a NaN */
static inline int dmb_real_below(dmb_real a, dmb_real b)
{
    return a < b;
}

/* Where something holds, lane by lane: what comparisons give, joined by & and |. */
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
/* 2^k of a k from -1022 to 1023, given as k + DMB_ROUNDING: the lowest bits of that are k. */
static inline dmb_real dmb_real_power_of_two(dmb_real shifted)
{
    uint64_t bits;
    memcpy(&bits, &shifted, sizeof bits);
    bits = (bits << 52) + (UINT64_C(1023) << 52);
    memcpy(&shifted, &bits, sizeof bits);
    return shifted;
}

#else

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
static inline int dmb_real_below(dmb_real a, dmb_real b)
{
    const dmb_real_bits below = (dmb_real_bits)(a < b);
    int64_t all = -1;
    for (int lane = 0; lane < DMB_LANES; lane++) all &= below[lane];
    return all != 0;
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
static inline int dmb_mask_any(dmb_mask mask)
{
    int64_t any = 0;
    for (int lane = 0; lane < DMB_LANES; lane++) any |= mask[lane];
    return any != 0;
}
/* One bit for each lane. */
static inline uint32_t dmb_mask_bits(dmb_mask mask)
{
    uint32_t bits = 0;
    for (int lane = 0; lane < DMB_LANES; lane++) bits |= (uint32_t)(mask[lane] & 1) << lane;
    return bits;
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
    for (int lane = 0; lane < DMB_REAL_LANES; lane++) dmb_real_set_lane(&x, lane, sqrt(dmb_real_lane(&x, lane)));
    return x;
}

#endif
