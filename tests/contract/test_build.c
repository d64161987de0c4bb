/* The words in which a build tells of itself, against dmb_has: all that it was made with is there to be called. */
#include <string.h>

#include "check.h"
#include "drillmbd/drillmbd.h"

static void has_what_it_says(void **state)
{
    (void)state;
    const char *info = dmb_build_info();
    assert_non_null(strstr(info, "libdrillmbd "));
    assert_int_equal(dmb_has(DMB_HAS_LAPACK), strstr(info, "LAPACKE") != NULL);
    assert_int_equal(dmb_has(DMB_HAS_FILES), strstr(info, "files: yes") != NULL);
    assert_int_equal(dmb_has(DMB_HAS_HEAP), strstr(info, "malloc") != NULL);
}

static void others_are_refused(void **state)
{
    (void)state;
    static const int32_t wrong[] = {-1, 3, 1000, INT32_MAX, INT32_MIN};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) assert_int_equal(dmb_has(wrong[i]), DMB_ERR_VALUE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(has_what_it_says), cmocka_unit_test(others_are_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
