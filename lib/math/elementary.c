#include "math/elementary.h"

#include <stdint.h>
#include <string.h>

#include "math/real.h"
#include "math/real_sine.h"

typedef dmb_sum pair;

/* The upper 26 bits of a. */
static double upper(double a)
{
    const double c = 134217729.0 * a; /* 2^27 + 1 */
    return c - (c - a);
}

/* a b exactly, of moderate size */
static pair two_product(double a, double b)
{
    const double product = a * b, ah = upper(a), al = a - ah, bh = upper(b), bl = b - bh;
    const pair p = {product, ((ah * bh - product) + ah * bl + al * bh) + al * bl};
    return p;
}

static pair pair_sum(pair a, pair b)
{
    const pair s = dmb_two_sum(a.high, b.high);
    return dmb_two_sum(s.high, s.low + (a.low + b.low));
}

static pair pair_product(pair a, pair b)
{
    const pair p = two_product(a.high, b.high);
    return dmb_two_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
}

/* ---- Reduction of an angle: x = quarter pi/2 + rest, |rest| <= pi/4 ---------------------------------------------- */

#define DMB_REDUCE_NEAR 1.6e6 /* [rad] up to which the number of quarters has 20 bits */

static pair reduce_near(double x, uint32_t *quarter)
{
    double n;
    const pair rest = dmb_reduce_near(x, &n);
    *quarter = (uint32_t)(int32_t)n;
    return rest;
}

/* Bits of 2/pi after its point. */
static const uint32_t two_over_pi[40] = {
    0xA2F9836E, 0x4E441529, 0xFC2757D1, 0xF534DDC0, 0xDB629599, 0x3C439041, 0xFE5163AB, 0xDEBBC561,
    0xB7246E3A, 0x424DD2E0, 0x06492EEA, 0x09D1921C, 0xFE1DEB1C, 0xB129A73E, 0xE88235F5, 0x2EBB4484,
    0xE99C7026, 0xB45F7E41, 0x3991D639, 0x835339F4, 0x9C845F8B, 0xBDF9283B, 0x1FF897FF, 0xDE05980F,
    0xEF2F118B, 0x5A0A6D1F, 0x6D367ECF, 0x27CB09B7, 0x4F463F66, 0x9E5FEA2D, 0x7527BAC7, 0xEBE5F17B,
    0x3D0739F7, 0x8A5292EA, 0x6BFB5FB1, 0x1F8D5D08, 0x56033046, 0xFC7B6BAB, 0xF0CFBC20, 0x9AF4361D};

enum { WINDOW = 7, PRODUCT = WINDOW + 2 }; /* significant words of 2/pi, and words of their product with 53 bits */

/* Multiplies the significand of x > 0 by WINDOW words of 2/pi from `first` on; least significant word first. */
static void multiply_window(uint64_t significand, int first, uint32_t product[PRODUCT])
{
    const uint64_t low = significand & UINT32_MAX, high = significand >> 32;
    uint64_t carry = 0; /* carry into the next digit and the one after it */
    for (int i = 0; i < WINDOW; i++) {
        const uint64_t word = two_over_pi[first + WINDOW - 1 - i];
        const uint64_t digit = word * low + (carry & UINT32_MAX);
        product[i] = (uint32_t)digit;
        carry = word * high + (carry >> 32) + (digit >> 32); /* below 2^64: high has 21 bits */
    }
    product[WINDOW] = (uint32_t)carry;
    product[WINDOW + 1] = (uint32_t)(carry >> 32);
}

/* 2^exponent, for a normal number */
static double power_of_two(int exponent)
{
    const uint64_t bits = (uint64_t)(1023 + exponent) << 52;
    double power;
    memcpy(&power, &bits, sizeof power);
    return power;
}

/* The bits of the product below the binary point, as a fraction; if it is above one half, the fraction minus 1. */
static pair fraction_of(const uint32_t product[PRODUCT], int point, int negative)
{
    pair sum = {0.0, 0.0};
    for (int i = PRODUCT - 1; i >= 0; i--) {
        const int below = point - 32 * i; /* bits of this word under the point */
        uint32_t word = negative ? ~product[i] : product[i];
        if (below <= 0) continue;
        if (below < 32) word &= (UINT32_C(1) << below) - 1;
        const pair s = dmb_two_sum(sum.high, (double)word * power_of_two(-below));
        sum = dmb_two_sum(s.high, s.low + sum.low);
    }
    if (negative) sum.high = -sum.high, sum.low = -sum.low; /* the last bit of 224 that ~ omits is insignificant */
    return sum;
}

/* x = significand 2^exponent: words of 2/pi whose contribution to x 2/pi is a multiple of 4 are omitted (Payne, Hanek
 * 1983). */
static pair reduce_far(double x, uint32_t *quarter)
{
    static const pair half_pi = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
    uint32_t product[PRODUCT];
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    const int exponent = (int)(bits >> 52 & 0x7ff) - 1075, first = exponent > 2 ? (exponent - 2) / 32 : 0;
    const int point = 32 * (first + WINDOW) - exponent;
    multiply_window((bits & ((UINT64_C(1) << 52) - 1)) | UINT64_C(1) << 52, first, product);
    const int half = point - 1, up = (int)(product[half / 32] >> half % 32 & 1);
    const uint32_t one = product[point / 32] >> point % 32 & 1, two = product[(point + 1) / 32] >> (point + 1) % 32 & 1;
    pair rest = pair_product(fraction_of(product, point, up), half_pi);
    *quarter = (one | two << 1) + (uint32_t)up;
    if (x > 0.0) return rest;
    *quarter = 0u - *quarter;
    rest.high = -rest.high, rest.low = -rest.low;
    return rest;
}

static pair reduce(double x, uint32_t *quarter)
{
    return fabs(x) <= DMB_REDUCE_NEAR ? reduce_near(x, quarter) : reduce_far(x, quarter);
}

/* ---- Sine and cosine --------------------------------------------------------------------------------------------- */

static double in_quarter(pair rest, uint32_t quarter)
{
    const double value = quarter & 1 ? dmb_cosine_near(rest) : dmb_sine_near(rest);
    return quarter & 2 ? -value : value;
}

void dmb_sin_cos(double x, double *sine, double *cosine)
{
    uint32_t quarter;
    *sine = *cosine = x - x;
    if (!isfinite(x)) return;
    const pair rest = reduce(x, &quarter);
    *sine = in_quarter(rest, quarter);
    *cosine = in_quarter(rest, quarter + 1);
}

double dmb_sin(double x)
{
    uint32_t quarter;
    if (!isfinite(x)) return x - x;
    const pair rest = reduce(x, &quarter);
    return in_quarter(rest, quarter);
}

double dmb_cos(double x)
{
    uint32_t quarter;
    if (!isfinite(x)) return x - x;
    const pair rest = reduce(x, &quarter);
    return in_quarter(rest, quarter + 1);
}

/* ---- Power ------------------------------------------------------------------------------------------------------- */

/* log x as a pair, with a relative error of about 2^-64: x = 2^e m, m from sqrt(1/2) to sqrt 2, s = (m - 1)/(m + 1),
 * log m = 2 s (1 + s^2/3 + s^4/5 + ... + s^28/29) */
static pair logarithm(double x)
{
    static const double odd[13] = {1.0 / 5.0,  1.0 / 7.0,  1.0 / 9.0,  1.0 / 11.0, 1.0 / 13.0, 1.0 / 15.0, 1.0 / 17.0,
                                   1.0 / 19.0, 1.0 / 21.0, 1.0 / 23.0, 1.0 / 25.0, 1.0 / 27.0, 1.0 / 29.0};
    static const pair third = {0x1.5555555555555p-2, 0x1.5555555555555p-56};
    int exponent = 0;
    uint64_t bits;
    if (x < 0x1p-1022) x *= 0x1p54, exponent = -54;
    memcpy(&bits, &x, sizeof bits);
    exponent += (int)(bits >> 52) - 1023;
    bits = (bits & ((UINT64_C(1) << 52) - 1)) | UINT64_C(1023) << 52;
    double m;
    memcpy(&m, &bits, sizeof m);
    if (m > 1.4142135623730951) m *= 0.5, exponent++;
    const pair below = dmb_two_sum(1.0, m);
    pair s = {(m - 1.0) / below.high, 0.0};
    const pair back = two_product(s.high, below.high);
    s.low = (((m - 1.0 - back.high) - back.low) - s.high * below.low) / below.high;
    const pair z = pair_product(s, s);
    double sum = odd[12];
    for (int i = 11; i >= 0; i--) sum = sum * z.high + odd[i];
    const pair tail = {z.high * sum, 0.0}, part = pair_product(z, pair_sum(third, tail));
    const pair twice = {2.0 * s.high, 2.0 * s.low}, log_m = pair_sum(twice, pair_product(twice, part));
    const double e = exponent;
    const pair scale = dmb_two_sum(e * DMB_LN2_HIGH, e * -0x1.8432a1b0e2000p-43);
    const pair log_2 = {scale.high, scale.low + e * -0x1.8cff81a12a17ep-85};
    return pair_sum(log_2, log_m);
}

double dmb_pow(double x, double y)
{
    if (y == 0.0 || x == 1.0) return 1.0;
    if (!(x >= 0.0) || isnan(y)) return (double)NAN;
    if (x == 0.0 || isinf(x)) return (x == 0.0) == (y > 0.0) ? 0.0 : (double)INFINITY;
    if (fabs(y) > 0x1p64) return (x > 1.0) == (y > 0.0) ? (double)INFINITY : 0.0;
    const pair log_x = logarithm(x), product = two_product(y, log_x.high);
    const pair power = dmb_two_sum(product.high, product.low + y * log_x.low);
    if (power.high < -708.0) return 0.0;
    if (power.high > 709.0) return (double)INFINITY;
    return dmb_real_exp_near(power.high, power.low);
}

double dmb_atan2(double y, double x)
{
    return x == 0.0 && y == 0.0 ? 0.0 : dmb_real_atan2(y, x);
}
