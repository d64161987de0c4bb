/* Segments of time functions that are given by numbers alone: all kinds but CALLBACK and PER_REVOLUTION. Pure
 * functions; nothing fails. */
#ifndef DMB_FORCE_TIME_SEGMENT_H
#define DMB_FORCE_TIME_SEGMENT_H

#include "drillmbd/scene.h"
#include "force/reference.h"

/* Kind of a segment in addition to those of drillmbd/scene.h: its callback_context is the dmb_reference
 * (force/reference.h) of an input. Definitions cannot use it. */
enum { DMB_SEGMENT_REFERENCE = 64 };

/* Value at t and its rate, from the right at breakpoints. */
void dmb_time_segment_value(const dmb_segment *segment, double t, double *value, double *rate);
/* Rate at t from the left. */
double dmb_time_segment_rate_before(const dmb_segment *segment, double t);
/* [unit s] Integral over t0 <= t1, exact to round-off. */
double dmb_time_segment_integral(const dmb_segment *segment, double t0, double t1);
/* [s] Smallest breakpoint later than t; INFINITY if there is none. */
double dmb_time_segment_next_breakpoint(const dmb_segment *segment, double t);
/* Between two neighbouring breakpoints, a < b: a bound of |value|, and [1/s] the inverse of the time in which the
 * segment changes smoothly (1 rad of a harmonic, half a ramp). */
void dmb_time_segment_scales(const dmb_segment *segment, double a, double b, double *bound, double *pace);

#endif
