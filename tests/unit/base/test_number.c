/* Numbers as text against printf of the C locale, and back to the same bits, in any locale. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/number.h"

/* printf of the C locale is the reference. */
static void expect_like_printf(double value, int digits)
{
    char text[DMB_NUMBER_SIZE], reference[64];
    size_t length = dmb_number_from_double(text, value, digits);
    snprintf(reference, sizeof reference, "%.*g", digits, value);
    assert_string_equal(text, reference);
    assert_int_equal(length, strlen(reference));
}

static uint64_t next_bits(uint64_t *seed)
{
    *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return *seed ^ (*seed >> 29);
}

static void special_values(void **state)
{
    const double values[] = {0.0,
                             -0.0,
                             1.0,
                             -1.0,
                             0.1,
                             0.073,
                             0.094,
                             2.1e11,
                             9.5,
                             10.5,
                             0.5,
                             1.5,
                             2.5,
                             99999.5,
                             999999.5,
                             9999995.0,
                             1e5,
                             1e6,
                             1e15,
                             1e16,
                             1e17,
                             1e-4,
                             1e-5,
                             123456.5,
                             5e-324,
                             DBL_MIN,
                             DBL_MAX,
                             DBL_EPSILON,
                             1e22,
                             1e23,
                             9007199254740993.0,
                             0.30000000000000004,
                             100.0,
                             1e100,
                             1e-100};
    char text[DMB_NUMBER_SIZE];
    (void)state;
    for (size_t i = 0; i < sizeof values / sizeof values[0]; ++i) {
        for (int digits = 1; digits <= 17; ++digits) {
            expect_like_printf(values[i], digits);
            expect_like_printf(-values[i], digits);
        }
    }
    dmb_number_from_double(text, (double)NAN, 6);
    assert_string_equal(text, "nan");
    dmb_number_from_double(text, (double)-INFINITY, 6);
    assert_string_equal(text, "-inf");
    dmb_number_from_double(text, (double)INFINITY, 6);
    assert_string_equal(text, "inf");
    dmb_number_from_double(text, 1234.5, 0); /* digits are brought into 1 .. 17 */
    assert_string_equal(text, "1e+03");
    dmb_number_from_double(text, 0.1, 99);
    assert_string_equal(text, "0.10000000000000001");
}

static void any_bit_pattern(void **state)
{
    uint64_t seed = 1;
    (void)state;
    for (int i = 0; i < 100000; ++i) {
        uint64_t bits = next_bits(&seed);
        double value;
        memcpy(&value, &bits, sizeof value);
        if (isfinite(value)) expect_like_printf(value, 1 + i % 17);
    }
}

static void everyday_values_come_back(void **state)
{
    uint64_t seed = 2;
    char text[DMB_NUMBER_SIZE];
    (void)state;
    for (int i = 0; i < 100000; ++i) {
        double value = ldexp((double)(int64_t)next_bits(&seed), -63 + i % 60 - 30);
        dmb_number_from_double(text, value, DMB_NUMBER_EXACT);
        assert_true(strtod(text, NULL) == value);
    }
}

static void whole_numbers(void **state)
{
    char text[DMB_NUMBER_SIZE];
    (void)state;
    assert_int_equal(dmb_number_from_u64(text, 0), 1);
    assert_string_equal(text, "0");
    assert_int_equal(dmb_number_from_u64(text, UINT64_MAX), 20);
    assert_string_equal(text, "18446744073709551615");
    assert_int_equal(dmb_number_from_i64(text, INT64_MIN), 20);
    assert_string_equal(text, "-9223372036854775808");
    assert_int_equal(dmb_number_from_i64(text, -7), 2);
    assert_string_equal(text, "-7");
    assert_int_equal(dmb_number_from_i64(text, INT64_MAX), 19);
    assert_string_equal(text, "9223372036854775807");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(special_values),
        cmocka_unit_test(any_bit_pattern),
        cmocka_unit_test(everyday_values_come_back),
        cmocka_unit_test(whole_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
