#include "interval.h"

#include <math.h>

/* P(X <= k) of n trials with the probability p, 0 < p < 1. */
static double at_most(int k, int n, double p)
{
    double sum = 0.0;
    for (int i = 0; i <= k; i++) {
        const double ways = lgamma(n + 1.0) - lgamma(i + 1.0) - lgamma(n - i + 1.0);
        sum += exp(ways + i * log(p) + (n - i) * log1p(-p));
    }
    return sum;
}

/* The p at which P(X <= k) has come down to `share`. */
static double where(int k, int n, double share)
{
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 100; i++) {
        const double middle = 0.5 * (low + high);
        if (at_most(k, n, middle) > share)
            low = middle;
        else
            high = middle;
    }
    return 0.5 * (low + high);
}

void interval_of(int failures, int samples, double confidence, double ends[2])
{
    const double rest = 0.5 * (1.0 - confidence);
    ends[0] = failures == 0 ? 0.0 : where(failures - 1, samples, 1.0 - rest);
    ends[1] = failures == samples ? 1.0 : where(failures, samples, rest);
}
