/* Sums, products and rounding of sizes, up to those that overflow. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"

static void sums(void **state)
{
    size_t size = 1;
    (void)state;
    assert_true(dmb_checked_add_size(SIZE_MAX - 2, 2, &size));
    assert_true(size == SIZE_MAX);
    assert_false(dmb_checked_add_size(SIZE_MAX, 1, &size));
    assert_true(size == SIZE_MAX);
}

static void products(void **state)
{
    size_t size = 1;
    (void)state;
    assert_true(dmb_checked_mul_size(0, SIZE_MAX, &size));
    assert_true(size == 0);
    assert_true(dmb_checked_mul_size(SIZE_MAX, 1, &size));
    assert_false(dmb_checked_mul_size(SIZE_MAX / 2 + 1, 2, &size));
    assert_true(size == SIZE_MAX);
}

static void rounding(void **state)
{
    size_t size = 1;
    (void)state;
    assert_true(dmb_checked_round_up(0, 64, &size));
    assert_true(size == 0);
    assert_true(dmb_checked_round_up(65, 64, &size));
    assert_true(size == 128);
    assert_true(dmb_checked_round_up(128, 64, &size));
    assert_true(size == 128);
    assert_false(dmb_checked_round_up(SIZE_MAX - 5, 64, &size));
    assert_true(size == 128);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums),
        cmocka_unit_test(products),
        cmocka_unit_test(rounding),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
