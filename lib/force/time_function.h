/* Time functions: values over time as a sum of segments, with rate, integral and breakpoints (eq:drive.step).
 * A time function is read-only here; its segments and their tables belong to the model. Pure functions; thread-safe if
 * the callbacks are. */
#ifndef DMB_FORCE_TIME_FUNCTION_H
#define DMB_FORCE_TIME_FUNCTION_H

#include <stdint.h>

#include "drillmbd/scene.h"

/* [units of a time function, a constraint] Largest absolute value that a callback may return; the bound of numbers of a
 * model. */
#define DMB_CALLBACK_MAX DMB_UNLIMITED

typedef struct dmb_time_function {
    const dmb_segment *segments; /* full-size segments, checked by the model, shape (count); the callback_context of
                                    PER_REVOLUTION is the dmb_time_function that it follows */
    uint32_t count;              /* [-] */
} dmb_time_function;

/* Value at time t [unit] and its rate [unit/s]; rate may be NULL. At a breakpoint the rate is the one from the right.
 * If a callback does not provide its rate, the rate is a central difference over +-1e-5 s (over +-1e-10 |t| beyond 1e5
 * s), so that it is also called at slightly negative times. Nothing is written on failure.
 * Errors: DMB_ERR_CALLBACK (nonzero return, or a value beyond
 * +-DMB_CALLBACK_MAX, not finite or not written), DMB_ERR_NOT_FINITE (t is
 * not finite, or the sum overflows). O(count), plus log2(table_count) per table. */
int32_t dmb_time_function_value(const dmb_time_function *time_function, double t, double *value, double *rate);

/* Rate at t from the left [unit/s]; at a knot of a table it is the slope of the interval that ends there. Otherwise as
 * dmb_time_function_value. */
int32_t dmb_time_function_rate_before(const dmb_time_function *time_function, double t, double *rate);

/* Integral from t0 to t1 [unit s]; t1 < t0 gives the negative. Exact to round-off relative to the integral over the
 * interval, whatever the size of t0, for every kind except CALLBACK, which gives the difference of the provided
 * integral, or 5-point Gauss rules over intervals of at most 0.05 s (at most 1000 intervals), and for h1 of
 * PER_REVOLUTION, by Gauss rules over intervals of at most 0.5 rad. Errors as above, and DMB_ERR_TOO_LARGE where these
 * would be more than 1e5. O(count), of PER_REVOLUTION O(points from 0 to t1) for each table that it follows. */
int32_t dmb_time_function_integral(const dmb_time_function *time_function, double t0, double t1, double *integral);

/* [s] Smallest breakpoint later than t: x0 and x1 of STEP and STEP5, knots of tables, breakpoints of references and of
 * what PER_REVOLUTION follows; INFINITY if there is none. */
double dmb_time_function_next_breakpoint(const dmb_time_function *time_function, double t);

#endif
