/* Time functions: values over time as a sum of segments, with rate, integral and breakpoints (eq:drive.step).
 * A time function is read-only here; its segments and their tables belong to the model. Pure functions, safe from any
 * thread as far as the callbacks are. */
#ifndef DMB_FORCE_TIME_FUNCTION_H
#define DMB_FORCE_TIME_FUNCTION_H

#include <stdint.h>

#include "drillmbd/model.h"
#include "force/reference.h"

/* [units of a time function, a constraint] Callbacks may give no more, as numbers of a model may not. */
#define DMB_CALLBACK_MAX 1e30

/* Kind of a segment beside those of drillmbd/model.h: its callback_context is a dmb_reference (force/reference.h), that
 * of an input. No definition can have it. */
enum { DMB_SEGMENT_REFERENCE = 6 };

typedef struct dmb_time_function {
    const dmb_segment *segments; /* full-size segments, checked by the model, shape (count) */
    uint32_t count;              /* [-] */
} dmb_time_function;

/* Value at time t [unit] and its rate [unit/s]; rate may be NULL. At a breakpoint the rate is the one from the right.
 * A callback that does not provide its rate is differenced over +-1e-5 s (over +-1e-10 |t| beyond 1e5 s), so it is also
 * called at slightly negative times. Nothing is written on failure.
 * Errors: DMB_ERR_CALLBACK (nonzero return, or a value beyond
 * +-DMB_CALLBACK_MAX, not finite or not written), DMB_ERR_NOT_FINITE (t is
 * not finite, or the sum overflows). O(count), plus log2(table_count) per table. */
int32_t dmb_time_function_value(const dmb_time_function *time_function, double t, double *value, double *rate);

/* The rate at t from the left, which at a knot of a table is the slope that ends there [unit/s]. Otherwise as above. */
int32_t dmb_time_function_rate_before(const dmb_time_function *time_function, double t, double *rate);

/* Integral from t0 to t1 [unit s]; t1 < t0 gives the negative. Exact to round-off relative to the integral over the
 * interval, whatever the size of t0, for every kind but CALLBACK: there the difference of the provided integral, or
 * 5-point Gauss over parts of at most 0.05 s (at most 1000 parts). Errors as above. */
int32_t dmb_time_function_integral(const dmb_time_function *time_function, double t0, double t1, double *integral);

/* [s] Smallest breakpoint later than t: x0 and x1 of STEP and STEP5, knots of tables, those of references; INFINITY if
 * there is none. */
double dmb_time_function_next_breakpoint(const dmb_time_function *time_function, double t);

#endif
