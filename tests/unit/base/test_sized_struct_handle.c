/* Stamps of handles that live, are dead or of another kind; lines of the log against the calls that made them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/message.h"
#include "base/sized_struct.h"

static void stamps(void **state)
{
    uint32_t object[2] = {DMB_HANDLE_MODEL, 7};
    (void)state;
    assert_true(dmb_handle_is(object, DMB_HANDLE_MODEL));
    assert_false(dmb_handle_is(object, DMB_HANDLE_SIM));
    assert_false(dmb_handle_is(NULL, DMB_HANDLE_MODEL));
    object[0] = DMB_HANDLE_DEAD;
    assert_false(dmb_handle_is(object, DMB_HANDLE_MODEL));
    assert_int_not_equal(DMB_HANDLE_MODEL, DMB_HANDLE_SIM);
}

static void keep(void *context, int32_t level, const char *text)
{
    char *line = context;
    line[0] = (char)('0' + level);
    strcpy(line + 1, text);
}

static void log_lines(void **state)
{
    char line[32] = "";
    const dmb_log log = {keep, line}, silent = {NULL, NULL};
    (void)state;
    dmb_log_text(&log, DMB_LOG_INFO, "compiled");
    assert_string_equal(line, "2compiled");
    dmb_log_text(&silent, DMB_LOG_ERROR, "lost");
    assert_string_equal(line, "2compiled");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stamps),
        cmocka_unit_test(log_lines),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
