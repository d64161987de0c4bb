/* Checks of values: status and message of each against what the header says, at the bounds and beyond. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/value_check.h"

static dmb_message message;

static dmb_check fresh(void)
{
    dmb_message_clear(&message);
    return dmb_check_of(&message, "pipe", 3);
}

/* One check on a fresh verdict gives this status and, where it fails, this message. */
#define EXPECT(expected_status, expected_text, call)      \
    do {                                                  \
        dmb_check check = fresh();                        \
        call;                                             \
        assert_int_equal(check.status, expected_status);  \
        assert_string_equal(message.text, expected_text); \
    } while (0)

static const double not_a_number = (double)NAN, infinite = (double)INFINITY;

static void finite_values(void **state)
{
    (void)state;
    assert_true(dmb_is_finite(1e308) && dmb_is_finite(-0.0));
    assert_false(dmb_is_finite(not_a_number) || dmb_is_finite(infinite) || dmb_is_finite(-infinite));
    EXPECT(DMB_OK, "", dmb_check_finite(&check, "length", 1.0));
    EXPECT(DMB_ERR_NOT_FINITE, "pipe 3: length = inf, must be finite", dmb_check_finite(&check, "length", infinite));
}

static void one_bound(void **state)
{
    (void)state;
    EXPECT(DMB_OK, "", dmb_check_above(&check, "length", 5e-324, 0.0));
    EXPECT(DMB_ERR_VALUE, "pipe 3: length = 0, must be finite and > 0", dmb_check_above(&check, "length", 0.0, 0.0));
    EXPECT(DMB_ERR_NOT_FINITE, "pipe 3: length = nan, must be finite and > 0",
           dmb_check_above(&check, "length", not_a_number, 0.0));
    EXPECT(DMB_ERR_NOT_FINITE, "pipe 3: length = inf, must be finite and > 0",
           dmb_check_above(&check, "length", infinite, 0.0));
    EXPECT(DMB_OK, "", dmb_check_at_least(&check, "damping", 0.0, 0.0));
    EXPECT(DMB_ERR_VALUE, "pipe 3: damping = -1, must be finite and >= 0",
           dmb_check_at_least(&check, "damping", -1.0, 0.0));
}

static void ranges(void **state)
{
    (void)state;
    EXPECT(DMB_OK, "", dmb_check_within(&check, "exponent", 1.0, 1.0, 3.0));
    EXPECT(DMB_OK, "", dmb_check_within(&check, "exponent", 3.0, 1.0, 3.0));
    EXPECT(DMB_ERR_VALUE, "pipe 3: exponent = 3.5, must be finite, >= 1 and <= 3",
           dmb_check_within(&check, "exponent", 3.5, 1.0, 3.0));
    EXPECT(DMB_OK, "", dmb_check_between(&check, "poisson_ratio", 0.3, -1.0, 0.5));
    EXPECT(DMB_ERR_VALUE, "pipe 3: poisson_ratio = 0.5, must be finite, > -1 and < 0.5",
           dmb_check_between(&check, "poisson_ratio", 0.5, -1.0, 0.5));
    EXPECT(DMB_ERR_VALUE, "pipe 3: poisson_ratio = -1, must be finite, > -1 and < 0.5",
           dmb_check_between(&check, "poisson_ratio", -1.0, -1.0, 0.5));
    EXPECT(DMB_ERR_NOT_FINITE, "pipe 3: poisson_ratio = nan, must be finite, > -1 and < 0.5",
           dmb_check_between(&check, "poisson_ratio", not_a_number, -1.0, 0.5));
}

static void other_fields(void **state)
{
    (void)state;
    EXPECT(DMB_OK, "", dmb_check_above_field(&check, "outer", 0.073, "inner", 0.061));
    EXPECT(DMB_ERR_VALUE, "pipe 3: outer = 0.061, must be finite and > inner (0.061)",
           dmb_check_above_field(&check, "outer", 0.061, "inner", 0.061));
    EXPECT(DMB_ERR_NOT_FINITE, "pipe 3: outer = nan, must be finite and > inner (0.061)",
           dmb_check_above_field(&check, "outer", not_a_number, "inner", 0.061));
    EXPECT(DMB_ERR_VALUE, "pipe 3: outer = 1, must be finite and > inner (nan)",
           dmb_check_above_field(&check, "outer", 1.0, "inner", not_a_number));
    EXPECT(DMB_ERR_VALUE, "pipe 3: outer = 1, must be finite and > inner (-inf)",
           dmb_check_above_field(&check, "outer", 1.0, "inner", -infinite));
    EXPECT(DMB_OK, "", dmb_check_at_least_field(&check, "mu_static", 0.3, "mu_dynamic", 0.3));
    EXPECT(DMB_ERR_VALUE, "pipe 3: mu_static = 0.2, must be finite and >= mu_dynamic (0.3)",
           dmb_check_at_least_field(&check, "mu_static", 0.2, "mu_dynamic", 0.3));
}

static void arrays(void **state)
{
    const double values[4] = {0.0, 1.0, infinite, not_a_number}, falling[3] = {0.0, 2.0, 2.0};
    const double rows[6] = {0.0, 9.0, 1.0, 9.0, 0.5, 9.0};
    (void)state;
    EXPECT(DMB_OK, "", dmb_check_all_finite(&check, "gravity", values, 2));
    EXPECT(DMB_ERR_NOT_FINITE, "pipe 3: gravity[2] = inf, must be finite",
           dmb_check_all_finite(&check, "gravity", values, 4));
    EXPECT(DMB_OK, "", dmb_check_increasing(&check, "time", falling, 2, 1));
    EXPECT(DMB_ERR_VALUE, "pipe 3: time[2] = 2, must be finite and > 2",
           dmb_check_increasing(&check, "time", falling, 3, 1));
    EXPECT(DMB_ERR_NOT_FINITE, "pipe 3: time[2] = inf, must be finite and > 1",
           dmb_check_increasing(&check, "time", values, 3, 1));
    EXPECT(DMB_ERR_NOT_FINITE, "pipe 3: time[0] = nan, must be finite",
           dmb_check_increasing(&check, "time", &values[3], 1, 1));
    EXPECT(DMB_OK, "", dmb_check_increasing(&check, "survey", rows, 2, 2));
    EXPECT(DMB_ERR_VALUE, "pipe 3: survey[2] = 0.5, must be finite and > 1",
           dmb_check_increasing(&check, "survey", rows, 3, 2));
}

static void whole_numbers(void **state)
{
    (void)state;
    EXPECT(DMB_OK, "", dmb_check_choice(&check, "kind", -1, -1, 5));
    EXPECT(DMB_ERR_VALUE, "pipe 3: kind = 6, must be -1 .. 5", dmb_check_choice(&check, "kind", 6, -1, 5));
    EXPECT(DMB_ERR_VALUE, "pipe 3: kind = -2147483648, must be -1 .. 5",
           dmb_check_choice(&check, "kind", INT32_MIN, -1, 5));
    EXPECT(DMB_OK, "", dmb_check_count(&check, "elements", 1024, 1, 1024));
    EXPECT(DMB_ERR_VALUE, "pipe 3: elements = 4294967295, must be 1 .. 1024",
           dmb_check_count(&check, "elements", UINT32_MAX, 1, 1024));
    EXPECT(DMB_OK, "", dmb_check_mask(&check, "free_mask", 63, 63));
    EXPECT(DMB_ERR_VALUE, "pipe 3: free_mask = 64, must be made of the bits of 63",
           dmb_check_mask(&check, "free_mask", 64, 63));
    EXPECT(DMB_ERR_VALUE, "pipe 3: free_mask = -1, must be made of the bits of 63",
           dmb_check_mask(&check, "free_mask", -1, 63));
}

static void pointers(void **state)
{
    dmb_check whole = dmb_check_of(&message, "wall", DMB_NONE);
    (void)state;
    EXPECT(DMB_OK, "", dmb_check_pointer(&check, "table", &message));
    EXPECT(DMB_ERR_NULL, "pipe 3: table is NULL", dmb_check_pointer(&check, "table", NULL));
    dmb_check_pointer(&whole, "survey", NULL);
    assert_string_equal(message.text, "wall: survey is NULL");
}

static void the_first_failure_stays(void **state)
{
    dmb_check check = fresh();
    const double bad[1] = {not_a_number};
    (void)state;
    dmb_check_above(&check, "length", 1.0, 0.0);
    dmb_check_above(&check, "density", -1.0, 0.0);
    dmb_check_finite(&check, "angle", not_a_number);
    dmb_check_within(&check, "exponent", 9.0, 1.0, 3.0);
    dmb_check_above_field(&check, "outer", 0.0, "inner", 1.0);
    dmb_check_all_finite(&check, "gravity", bad, 1);
    dmb_check_choice(&check, "kind", 9, 0, 1);
    dmb_check_count(&check, "elements", 9, 0, 1);
    dmb_check_mask(&check, "mask", 9, 1);
    dmb_check_pointer(&check, "table", NULL);
    assert_int_equal(check.status, DMB_ERR_VALUE);
    assert_string_equal(message.text, "pipe 3: density = -1, must be finite and > 0");
}

static void no_message(void **state)
{
    dmb_check check = dmb_check_of(NULL, "pipe", 0);
    (void)state;
    dmb_check_above(&check, "length", 0.0, 0.0);
    assert_int_equal(check.status, DMB_ERR_VALUE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finite_values), cmocka_unit_test(one_bound),
        cmocka_unit_test(ranges),        cmocka_unit_test(other_fields),
        cmocka_unit_test(arrays),        cmocka_unit_test(whole_numbers),
        cmocka_unit_test(pointers),      cmocka_unit_test(the_first_failure_stays),
        cmocka_unit_test(no_message),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
