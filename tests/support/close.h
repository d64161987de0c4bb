/* |got - want| <= tolerance, with both told on failure. */
#ifndef DMB_TESTS_CLOSE_H
#define DMB_TESTS_CLOSE_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define CHECK_CLOSE(got, want, tolerance)                                                             \
    do {                                                                                              \
        const double g_ = (got), w_ = (want), t_ = (tolerance);                                       \
        if (!(fabs(g_ - w_) <= t_))                                                                   \
            fail_msg("%s: %.17g, wanted %.17g, off by %.3g > %.3g", #got, g_, w_, fabs(g_ - w_), t_); \
    } while (0)

#endif
