/* Sine, cosine, exponential, power and angle of our own held against the C library's in long double, which has 11 bits
 * more (where it has none: against its doubles), and against stored bits: every processor and compiler gives these. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "math/elementary.h"
#include "math/real.h"
#include "math/real_sine.h"

enum { DRAWS = 20000 };

/* The error of the reference itself, in units of the last place of a double. */
#define DMB_REFERENCE (LDBL_MANT_DIG > DBL_MANT_DIG ? 0.01 : 1.0)

static uint64_t state_of_draws;

/* splitmix64 */
static uint64_t next_random(void)
{
    uint64_t z = state_of_draws += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ z >> 30) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ z >> 27) * UINT64_C(0x94D049BB133111EB);
    return z ^ z >> 31;
}

static double between(double low, double high)
{
    return low + (high - low) * (double)(next_random() >> 11) * 0x1p-53;
}

/* Any size from 2^low to 2^high, either sign; by bits, so that the draws are the same everywhere. */
static double sized(int low, int high)
{
    const int exponent = low + (int)(next_random() % (uint64_t)(high - low));
    const double x = ldexp(between(1.0, 2.0), exponent);
    return next_random() & 1 ? -x : x;
}

static uint64_t hash;

static void add_to_hash(double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    hash = (hash ^ bits) * UINT64_C(0x100000001B3);
    hash ^= hash >> 29;
}

/* Worst error so far of one function, in units of the last place. */
static double worst;

static void compare(const char *name, double x, double y, double found, long double wanted)
{
    int exponent;
    add_to_hash(found);
    (void)frexpl(wanted, &exponent);
    if (exponent < -1021) exponent = -1021;
    const double off = (double)fabsl(((long double)found - wanted) / ldexpl(1.0L, exponent - 53));
    worst = fmax(worst, off);
    if (!(off < 4.0)) fail_msg("%s(%.17g, %.17g) = %.17g, %g units off", name, x, y, found, off);
}

static void begin(void)
{
    state_of_draws = 1;
    hash = 0;
    worst = 0.0;
}

/* `bits` is what the hash of all results has to be. */
static void end(const char *name, double bound, uint64_t bits)
{
    if (worst > bound + DMB_REFERENCE) fail_msg("%s: %g units in the last place, must be <= %g", name, worst, bound);
    if (hash != bits) fail_msg("%s: other bits than stored, 0x%016llX", name, (unsigned long long)hash);
}

static void sines_of(double x)
{
    double sine, cosine;
    dmb_sin_cos(x, &sine, &cosine);
    compare("sin", x, 0.0, sine, sinl((long double)x));
    compare("cos", x, 0.0, cosine, cosl((long double)x));
    assert_true(sine == dmb_sin(x) && cosine == dmb_cos(x));
}

static void sines(void **state)
{
    (void)state;
    begin();
    for (int i = 0; i < DRAWS; i++) {
        sines_of(between(-4.0, 4.0));
        sines_of(between(-1.7e6, 1.7e6));
        sines_of(sized(-1000, 20));
        sines_of(sized(20, 1023));
    }
    end("sines", 0.8, UINT64_C(0xBF3BF4D9AF6672FF));
}

/* Next to multiples of pi/2, where nearly all digits cancel; the worst double of all is 6381956970095103 2^797. */
static void sines_near_zero(void **state)
{
    (void)state;
    begin();
    for (int i = 1; i < DRAWS; i++) {
        sines_of((double)(i * 1.57079632679489661923132169163975144L));
        sines_of((double)((i << 16) * 1.57079632679489661923132169163975144L));
    }
    sines_of(ldexp(6381956970095103.0, 797));
    sines_of(1e22);
    sines_of(1.6e6);
    sines_of(nextafter(1.6e6, 2e6));
    sines_of(DBL_MAX);
    assert_true(dmb_sin(0.0) == 0.0 && dmb_cos(0.0) == 1.0);
    assert_true(isnan(dmb_sin((double)INFINITY)) && isnan(dmb_cos((double)NAN)));
    end("sines near zero", 0.8, UINT64_C(0x72FDD12B38FF6D94));
}

/* The sines of lanes, alone: the same bits up to 3.9 rad. */
static void sines_of_lanes(void **state)
{
    (void)state;
    for (int i = 0; i <= 8 * DRAWS; i++) {
        const double x = 3.9 * ((double)i / (4 * DRAWS) - 1.0);
        double lane[2], alone[2];
        dmb_real_sin_cos(x, lane, lane + 1);
        dmb_sin_cos(x, alone, alone + 1);
        assert_memory_equal(lane, alone, sizeof lane);
    }
}

static void exponential_of(double x)
{
    compare("exp", x, 0.0, dmb_real_exp(x), expl((long double)x));
}

static void exponentials(void **state)
{
    (void)state;
    begin();
    for (int i = 0; i < DRAWS; i++) {
        exponential_of(between(-708.0, 709.0));
        exponential_of(between(-100.0, 0.0));
        exponential_of(between(-1.0, 1.0));
        exponential_of(sized(-1000, 5));
    }
    end("exponentials", 0.9, UINT64_C(0x4A792C89DD17F701));
    assert_true(dmb_real_exp(0.0) == 1.0 && dmb_real_exp(-708.1) == 0.0 && dmb_real_exp(-(double)INFINITY) == 0.0);
    assert_true(isinf(dmb_real_exp(709.1)) && isinf(dmb_real_exp(DBL_MAX)) && isnan(dmb_real_exp((double)NAN)));
}

static void powers_of(double x, double low, double high)
{
    const double y = between(low, high);
    const long double wanted = powl((long double)x, (long double)y);
    if (wanted > 1e-307L && wanted < 1e307L) compare("pow", x, y, dmb_pow(x, y), wanted);
}

static void powers(void **state)
{
    (void)state;
    begin();
    for (int i = 0; i < DRAWS; i++) {
        powers_of(fabs(sized(-60, 20)), 0.0, 3.0);
        powers_of(fabs(sized(-1074, 1023)), -1.5, 1.5);
        powers_of(between(0.5, 2.0), -900.0, 900.0);
        powers_of(1.0 + between(-1e-6, 1e-6), -1e8, 1e8);
        powers_of(fabs(sized(-300, 300)), -1.0 / 3.0, -1.0 / 3.0);
    }
    end("powers", 0.95, UINT64_C(0x7F45538D0509461F));
    assert_true(dmb_pow(0.0, 0.5) == 0.0 && isinf(dmb_pow(0.0, -0.5)) && dmb_pow(0.0, 0.0) == 1.0);
    assert_true(dmb_pow((double)INFINITY, -0.5) == 0.0 && isinf(dmb_pow((double)INFINITY, 0.5)));
    assert_true(isnan(dmb_pow(-1.0, 0.5)) && isnan(dmb_pow((double)NAN, 0.5)) && isnan(dmb_pow(2.0, (double)NAN)));
    assert_true(dmb_pow(2.0, 1e300) > DBL_MAX && dmb_pow(2.0, -1e300) == 0.0 && dmb_pow(0.5, 1e300) == 0.0);
    assert_true(dmb_pow(4.0, 0.5) == 2.0 && dmb_pow(2.0, 10.0) == 1024.0);
}

static void angle_of(double y, double x)
{
    const long double wanted = atan2l((long double)y, (long double)x);
    if (fabsl(wanted) > 1e-300L) compare("atan2", y, x, dmb_atan2(y, x), wanted);
}

static void angles(void **state)
{
    (void)state;
    begin();
    for (int i = 0; i < DRAWS; i++) {
        double y = between(-1.0, 1.0), x = between(-1.0, 1.0);
        angle_of(y, x);
        y = sized(-300, 300);
        x = sized(-300, 300);
        angle_of(y, x);
    }
    end("angles", 2.0, UINT64_C(0x8AD03F36151E54E2));
    assert_true(dmb_atan2(0.0, 0.0) == 0.0 && dmb_atan2(0.0, 1.0) == 0.0 && dmb_atan2(1.0, 0.0) == 0.5 * DMB_PI);
    assert_true(dmb_atan2(0.0, -1.0) == DMB_PI && isnan(dmb_atan2((double)NAN, 1.0)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sines),        cmocka_unit_test(sines_near_zero), cmocka_unit_test(sines_of_lanes),
        cmocka_unit_test(exponentials), cmocka_unit_test(powers),          cmocka_unit_test(angles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
