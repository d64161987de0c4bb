/* Shared by the tests of lib/math: comparison, repeatable random numbers, long double references. */
#ifndef DMB_TESTS_MATH_TEST_H
#define DMB_TESTS_MATH_TEST_H

#include <string.h>

#include "close.h"
#include "math/vec3.h"

#define CHECK_BELOW(error, tolerance) CHECK_CLOSE(error, 0.0, tolerance)

/* largest |a_i - b_i| ; NaN when there is one */
static inline double max_difference(int n, const double *a, const double *b)
{
    double d = 0.0;
    for (int i = 0; i < n; i++) {
        const double e = fabs(a[i] - b[i]);
        if (!(e <= d)) d = e;
    }
    return d;
}

static inline double max_abs(int n, const double *a)
{
    double d = 0.0;
    for (int i = 0; i < n; i++) d = fmax(d, fabs(a[i]));
    return d;
}

/* xorshift64*, uniform on [-1, 1] */
typedef struct random_stream {
    uint64_t state;
} random_stream;

static inline double draw(random_stream *r)
{
    r->state ^= r->state >> 12;
    r->state ^= r->state << 25;
    r->state ^= r->state >> 27;
    return (double)((r->state * UINT64_C(2685821657736338717)) >> 11) * 0x1p-52 - 1.0;
}

static inline void draw_vector(random_stream *r, int n, double *v)
{
    for (int i = 0; i < n; i++) v[i] = draw(r);
}

/* a rotation vector of the given length in a random direction */
static inline void draw_rotation(random_stream *r, double angle, double O[3])
{
    double n;
    do {
        draw_vector(r, 3, O);
        n = dmb_vec3_norm(O);
    } while (n < 0.1 || n > 1.0);
    dmb_vec3_scale(angle / n, O, O);
}

/* C = A B, n x n */
static inline void multiply(int n, const double *A, const double *B, double *C)
{
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            C[n * i + j] = 0.0;
            for (int k = 0; k < n; k++) C[n * i + j] += A[n * i + k] * B[n * k + j];
        }
}

static inline void transpose(int n, const double *A, double *T)
{
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) T[n * i + j] = A[n * j + i];
}

static inline double identity_error(int n, const double *A)
{
    double d = 0.0;
    for (int i = 0; i < n * n; i++) d = fmax(d, fabs(A[i] - (i % (n + 1) == 0 ? 1.0 : 0.0)));
    return d;
}

/* The angles every operator is tried at: 1e-9 .. 6, the borders between formulas, and the middle of each. */
static const double test_angles[] = {1e-9,  1e-8, 1e-7, 1e-6, 1e-5,      1e-4, 1e-3,      1e-2,  0.05, 0.1,   0.2,
                                     0.249, 0.25, 0.3,  0.45, 0.4999999, 0.5,  0.5000001, 0.6,   0.9,  0.999, 1.0,
                                     1.5,   2.0,  2.5,  3.0,  3.14,      3.2,  3.24,      3.241, 4.0,  5.0,   6.0};
#define TEST_ANGLE_COUNT ((int)(sizeof test_angles / sizeof test_angles[0]))

/* The references need the 64 bits of an x87 long double; valgrind and some hosts compute fewer. */
static inline int long_double_is_short(void)
{
    volatile long double one = 1.0L, small = 0x1p-62L, sum = one + small;
    return sum == one;
}

#define NEEDS_LONG_DOUBLE()                 \
    do {                                    \
        if (long_double_is_short()) skip(); \
    } while (0)

/* The functions of x = t^2 that the library evaluates, in long double by other ways. */
typedef struct exact_coefficients {
    long double a, b, a2, db, da2, c, e, e2;
} exact_coefficients;

/* (2 d/dx)^order of sum (-x)^k/(2k+shift)! */
static inline long double exact_series(long double x, int shift, int order)
{
    long double sum = 0.0L;
    for (int k = 40; k >= order; k--) {
        long double term = (k % 2) ? -1.0L : 1.0L;
        for (int i = 2; i <= 2 * k + shift; i++) term /= i;
        for (int i = 0; i < order; i++) term *= 2.0L * (k - i);
        for (int i = 0; i < k - order; i++) term *= x;
        sum += term;
    }
    return sum;
}

/* Inverse coefficients by quotients: c = -db/(2b), then e = 2 dc/dx, e2 = 2 de/dx. */
static inline void exact_inverse(exact_coefficients *k, long double ddb, long double dddb)
{
    const long double b = k->b, db = k->db;
    const long double numerator = db * db - ddb * b;
    k->c = -db / (2.0L * b);
    k->e = numerator / (2.0L * b * b);
    k->e2 = (db * ddb - dddb * b) / (2.0L * b * b) - numerator * db / (b * b * b);
}

static inline exact_coefficients exact_small(long double x)
{
    exact_coefficients k = {0};
    k.a = exact_series(x, 1, 0);
    k.b = exact_series(x, 2, 0);
    k.a2 = exact_series(x, 3, 0);
    k.db = exact_series(x, 2, 1);
    k.da2 = exact_series(x, 3, 1);
    exact_inverse(&k, exact_series(x, 2, 2), exact_series(x, 2, 3));
    return k;
}

static inline exact_coefficients exact_large(long double x)
{
    const long double t = sqrtl(x), s = sinl(0.5L * t);
    exact_coefficients k = {0};
    k.a = sinl(t) / t;
    k.b = 2.0L * s * s / x;
    k.a2 = (t - sinl(t)) / (t * x);
    k.db = (k.a - 2.0L * k.b) / x;
    k.da2 = (k.b - 3.0L * k.a2) / x;
    const long double da = (cosl(t) - k.a) / x, dda = (-k.a - 3.0L * da) / x;
    const long double ddb = (da - 4.0L * k.db) / x;
    exact_inverse(&k, ddb, (dda - 6.0L * ddb) / x);
    return k;
}

static inline exact_coefficients exact_at(long double x)
{
    return x < 4.0L ? exact_small(x) : exact_large(x);
}

#endif
