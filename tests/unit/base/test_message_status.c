/* Names and texts of results, and the version, against the header. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "drillmbd/drillmbd.h"

static void names_and_texts(void **state)
{
    (void)state;
#define EXPECT(name, value, text)                       \
    assert_int_equal(name, value);                      \
    assert_string_equal(dmb_status_name(value), #name); \
    assert_string_equal(dmb_status_text(value), text);
    DMB_STATUS_LIST(EXPECT)
#undef EXPECT
}

static void unknown_status(void **state)
{
    const int32_t values[] = {-500, 999, -1000, INT32_MIN, INT32_MAX};
    (void)state;
    for (size_t i = 0; i < sizeof values / sizeof values[0]; ++i) {
        assert_string_equal(dmb_status_name(values[i]), "DMB_UNKNOWN");
        assert_true(strlen(dmb_status_text(values[i])) > 0);
    }
}

static void version(void **state)
{
    (void)state;
    assert_int_equal(dmb_version(), 10000 * DMB_VERSION_MAJOR + 100 * DMB_VERSION_MINOR + DMB_VERSION_PATCH);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_and_texts),
        cmocka_unit_test(unknown_status),
        cmocka_unit_test(version),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
