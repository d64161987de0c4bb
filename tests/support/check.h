/* Comparisons of the physics tests: each prints what it measured beside the tolerance, and fails above it. */
#ifndef DMB_TESTS_CHECK_H
#define DMB_TESTS_CHECK_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define PI 3.14159265358979323846

/* |figure| <= tolerance */
void check_below(const char *what, double figure, double tolerance);
/* |got - want| <= tolerance */
void check_close(const char *what, double got, double want, double tolerance);
/* |got - want| <= tolerance |want| */
void check_relative(const char *what, double got, double want, double tolerance);
/* Observed order log2(coarse/fine) of two errors whose steps differ by 2, within `tolerance` of `order`. */
void check_order(const char *what, double coarse, double fine, double order, double tolerance);
/* Prints a figure that is told and not judged. */
void tell(const char *what, double figure);

/* Largest |a_i - b_i|; NaN where there is one. */
double largest_difference(size_t n, const double *a, const double *b);
double largest(size_t n, const double *a);

/* Repeatable random numbers, uniform on low .. high; the seed is not 0. */
double draw_between(uint64_t *seed, double low, double high);

/* Derivative from six values of f at -3h, -2h, -h, h, 2h, 3h; the error is of order h^6. */
double difference6(const double f[6], double h);
/* The places of those values, in units of h. */
extern const int difference6_place[6];

#endif
