/* Shared by the tests of lib/force: comparison and repeatable random numbers. */
#ifndef DMB_TESTS_FORCE_TEST_H
#define DMB_TESTS_FORCE_TEST_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define PI 3.14159265358979323846

#define CHECK_CLOSE(got, want, tolerance)                                                             \
    do {                                                                                              \
        const double g_ = (got), w_ = (want), t_ = (tolerance);                                       \
        if (!(fabs(g_ - w_) <= t_))                                                                   \
            fail_msg("%s: %.17g, wanted %.17g, off by %.3g > %.3g", #got, g_, w_, fabs(g_ - w_), t_); \
    } while (0)

#define CHECK_RELATIVE(got, want, tolerance) CHECK_CLOSE(got, want, (tolerance)*fabs((double)(want)))

/* xorshift64*, uniform on [low, high] */
static inline double draw(uint64_t *state, double low, double high)
{
    *state ^= *state >> 12;
    *state ^= *state << 25;
    *state ^= *state >> 27;
    return low + (high - low) * (double)((*state * UINT64_C(2685821657736338717)) >> 11) * 0x1p-53;
}

#endif
