#include "ode.h"

#include <math.h>
#include <string.h>

/* Gragg's smoothed midpoint rule with k substeps over h. */
static void gragg(ode_fn f, void *context, double t, double h, int k, size_t n, const double *y, double *out)
{
    double before[ODE_MAX], at[ODE_MAX], rate[ODE_MAX];
    const double s = h / k;
    f(context, t, y, rate);
    for (size_t i = 0; i < n; i++) {
        before[i] = y[i];
        at[i] = y[i] + s * rate[i];
    }
    for (int j = 1; j < k; j++) {
        f(context, t + j * s, at, rate);
        for (size_t i = 0; i < n; i++) {
            const double next = before[i] + 2.0 * s * rate[i];
            before[i] = at[i];
            at[i] = next;
        }
    }
    f(context, t + h, at, rate);
    for (size_t i = 0; i < n; i++) out[i] = 0.5 * (at[i] + before[i] + s * rate[i]);
}

/* One step of order 12: substeps 2, 4 .. 12, extrapolated in h^2 (Bulirsch, Stoer). */
static void step(ode_fn f, void *context, double t, double h, size_t n, double *y)
{
    double table[6][ODE_MAX];
    for (int j = 0; j < 6; j++) {
        gragg(f, context, t, h, 2 * (j + 1), n, y, table[j]);
        for (int m = j; m > 0; m--) {
            const double ratio = (double)(j + 1) / m, factor = 1.0 / (ratio * ratio - 1.0);
            for (size_t i = 0; i < n; i++) table[m - 1][i] = table[m][i] + factor * (table[m][i] - table[m - 1][i]);
        }
    }
    memcpy(y, table[0], n * sizeof *y);
}

void ode_solve(ode_fn f, void *context, double t0, double t1, size_t steps, size_t n, double *y)
{
    const double h = (t1 - t0) / (double)steps;
    for (size_t k = 0; k < steps; k++) step(f, context, t0 + (double)k * h, h, n, y);
}
