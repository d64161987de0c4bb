/* A value that moves to a target with limits on its rate and on the slope of its rate: for a speed, acceleration and
 * jerk. It reaches the target in minimum time, by at most three phases of constant slope (eq:drive.reference). Pure
 * functions. */
#ifndef DMB_FORCE_REFERENCE_H
#define DMB_FORCE_REFERENCE_H

typedef struct dmb_reference {
    double time;        /* [s] start of the transition */
    double value, rate; /* [unit, unit/s] at the start */
    double target;      /* [unit] */
    double rate_limit;  /* [unit/s] 0: none */
    double slope_limit; /* [unit/s2] 0: none */
} dmb_reference;

/* Value at t and its rate, from the right at breakpoints; rate may be NULL. Before `time` it returns `value` with rate
 * 0. */
void dmb_reference_value(const dmb_reference *reference, double t, double *value, double *rate);
/* Rate at t from the left. */
double dmb_reference_rate_before(const dmb_reference *reference, double t);
/* [unit s] Integral from t0 to t1 >= t0, exact to round-off. */
double dmb_reference_integral(const dmb_reference *reference, double t0, double t1);
/* [s] Smallest breakpoint later than t; INFINITY if there is none. */
double dmb_reference_next_breakpoint(const dmb_reference *reference, double t);
/* [s] Time at which the target is reached. */
double dmb_reference_arrival(const dmb_reference *reference);

#endif
