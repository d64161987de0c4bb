#include "restitution.h"

#include <math.h>

enum { ITERATIONS = 60 };

/* x - ln(1 + x) for x > -1, to round-off also where the two nearly cancel: series x^2/2 - x^3/3 + ... */
static double log_deficit(double x)
{
    double power = x * x;
    double sum = 0.0;

    if (fabs(x) > 0.5) return x - log1p(x);
    for (int k = 2; k < 64; ++k) {
        sum += power / (double)k;
        power *= -x;
    }
    return sum;
}

/* Small mu: Newton for u = mu e in -u - ln(1 - u) = mu - ln(1 + mu), started above the root of a convex function. */
static double restitution_of_small(double mu)
{
    const double target = log_deficit(mu);
    double u = mu;

    for (int i = 0; i < ITERATIONS; ++i) {
        const double next = u - (log_deficit(-u) - target) * (1.0 - u) / u;
        if (!(next < u)) break;
        u = next;
    }
    return fmin(u / mu, 1.0);
}

double restitution_of(double mu)
{
    double y = 0.0;

    if (!(mu > 0.0)) return 1.0;
    if (mu < 0.5) return restitution_of_small(mu);
    /* y = 1 - mu e = -W0(-(1+mu) exp(-(1+mu))), Newton in y = exp(y - 1 - (mu - ln(1 + mu))) from below */
    const double shift = 1.0 + log_deficit(mu);
    for (int i = 0; i < ITERATIONS; ++i) {
        const double image = exp(y - shift);
        const double next = y + (image - y) / (1.0 - image);
        if (!(next > y)) break;
        y = next;
    }
    return (1.0 - y) / mu;
}
