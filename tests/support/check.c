#include "check.h"

const int difference6_place[6] = {-3, -2, -1, 1, 2, 3};

static void judge(const char *what, double figure, double tolerance, double got, double want)
{
    print_message("    %-66s %9.3g  (<= %.3g)\n", what, figure, tolerance);
    if (!(figure <= tolerance))
        fail_msg("%s: %.12g, wanted %.12g: off by %.4g, must be <= %.4g", what, got, want, figure, tolerance);
}

void check_below(const char *what, double figure, double tolerance)
{
    judge(what, fabs(figure), tolerance, figure, 0.0);
}

void check_close(const char *what, double got, double want, double tolerance)
{
    judge(what, fabs(got - want), tolerance, got, want);
}

void check_relative(const char *what, double got, double want, double tolerance)
{
    judge(what, fabs(got - want) / fabs(want), tolerance, got, want);
}

void check_order(const char *what, double coarse, double fine, double order, double tolerance)
{
    const double got = log2(coarse / fine);
    print_message("    %-66s %9.4f  (%.3g +- %.2g; errors %.3g, %.3g)\n", what, got, order, tolerance, coarse, fine);
    if (!(fabs(got - order) <= tolerance))
        fail_msg("%s: order %.4f, wanted %.3g +- %.3g (errors %.4g, %.4g)", what, got, order, tolerance, coarse, fine);
}

void tell(const char *what, double figure)
{
    print_message("    %-66s %9.6g\n", what, figure);
}

double largest_difference(size_t n, const double *a, const double *b)
{
    double most = 0.0;
    for (size_t i = 0; i < n; i++) {
        const double d = fabs(a[i] - b[i]);
        if (!(d <= most)) most = d;
    }
    return most;
}

double largest(size_t n, const double *a)
{
    double most = 0.0;
    for (size_t i = 0; i < n; i++)
        if (!(fabs(a[i]) <= most)) most = fabs(a[i]);
    return most;
}

/* xorshift64* */
double draw_between(uint64_t *seed, double low, double high)
{
    *seed ^= *seed >> 12;
    *seed ^= *seed << 25;
    *seed ^= *seed >> 27;
    return low + (high - low) * (double)((*seed * UINT64_C(2685821657736338717)) >> 11) * 0x1p-53;
}

double difference6(const double f[6], double h)
{
    return (45.0 * (f[3] - f[2]) - 9.0 * (f[4] - f[1]) + (f[5] - f[0])) / (60.0 * h);
}
