/* Reference solutions of small ordinary differential equations. */
#ifndef DMB_TESTS_ODE_H
#define DMB_TESTS_ODE_H

#include <stddef.h>

#define ODE_MAX 16

/* rate <- f(t, y), both of length n. */
typedef void (*ode_fn)(void *context, double t, const double *y, double *rate);

/* y from t0 to t1 in equal steps of extrapolated midpoint rules, order 12 (Gragg; Bulirsch, Stoer). */
void ode_solve(ode_fn f, void *context, double t0, double t1, size_t steps, size_t n, double *y);

#endif
