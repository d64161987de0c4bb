/* Texts of messages against printf, for the conversions it knows; cut texts, fields, names of parts. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include <math.h>

#include "base/message.h"

static void conversions(void **state)
{
    dmb_message m;
    const char *volatile none = NULL; /* volatile: the compiler warns of what it can see */
    (void)state;
    dmb_message_set(&m, "%s %d %u %zu %llu %g %%", "pipe", -3, UINT32_MAX, (size_t)12, 1ull << 63, 0.5);
    assert_string_equal(m.text, "pipe -3 4294967295 12 9223372036854775808 0.5 %");
    dmb_message_set(&m, "plain");
    assert_string_equal(m.text, "plain");
    dmb_message_set(&m, "%s", none);
    assert_string_equal(m.text, "?");
    dmb_message_set(&m, "%g %g %g %g %g", 0.073, 2.1e11, 1048577.0, 1.0 / 3.0, -4294967295.0);
    assert_string_equal(m.text, "0.073 2.1e+11 1048577 0.333333 -4294967295");
    dmb_message_set(&m, "%g %g %g %g", (double)NAN, (double)INFINITY, (double)-INFINITY, 0.0);
    assert_string_equal(m.text, "nan inf -inf 0");
}

static void conversions_it_does_not_know(void **state)
{
    dmb_message m;
    const char *volatile format = "a %x b %d"; /* not seen by the compiler's check of formats */
    const char *volatile open = "50 %";
    void (*set)(dmb_message *, const char *, ...) = dmb_message_set;
    (void)state;
    set(&m, format, 1u, 2);
    assert_string_equal(m.text, "a ?");
    set(&m, open);
    assert_string_equal(m.text, "50 ?");
    static const char *const others[] = {"%zd", "%z", "%l", "%ld", "%ll", "%lld", "%lx", "%p"};
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        const char *volatile other = others[i];
        set(&m, other, 1ull);
        assert_string_equal(m.text, "?");
    }
}

/* UTF-8 (RFC 3629): characters of one to four bytes at the bounds of each; overlong forms, surrogates, codes beyond
 * 0x10FFFF, bytes that go on without a beginning and the other way round, and control characters are none. */
static void characters(void **state)
{
    static const char *const texts[] = {" ",
                                        "~",
                                        "\xC2\xA0",
                                        "\xDF\xBF",
                                        "\xE0\xA0\x80",
                                        "\xED\x9F\xBF",
                                        "\xEE\x80\x80",
                                        "\xEF\xBF\xBD",
                                        "\xF0\x90\x80\x80",
                                        "\xF4\x8F\xBF\xBF",
                                        "a\xC3\xBCz"};
    static const char *const none[] = {"\x1F",
                                       "\x7F",
                                       "\t",
                                       "\xC2\x80",
                                       "\xC2\x9F",
                                       "\xC1\xBF",
                                       "\xE0\x9F\xBF",
                                       "\xED\xA0\x80",
                                       "\xED\xBF\xBF",
                                       "\xF0\x8F\xBF\xBF",
                                       "\xF4\x90\x80\x80",
                                       "\xF8\x88\x80\x80",
                                       "\x80",
                                       "\xBF",
                                       "\xC3z",
                                       "\xE2\x82z",
                                       "\xC3",
                                       "\xE2\x82",
                                       "\xF0\x90\x80",
                                       "\xFF"};
    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++)
        if (!dmb_is_text(texts[i], strlen(texts[i]) + 1)) fail_msg("text %zu is refused", i);
    for (size_t i = 0; i < sizeof none / sizeof none[0]; i++)
        if (dmb_is_text(none[i], strlen(none[i]) + 1)) fail_msg("number %zu is taken for text", i);
}

static void too_long_a_text_is_cut(void **state)
{
    dmb_message m[2];
    char line[400];
    (void)state;
    memset(line, 'x', sizeof line - 1);
    line[sizeof line - 1] = '\0';
    memset(m, 0x5A, sizeof m);
    dmb_message_set(&m[0], "%s%s", line, line);
    assert_int_equal(strlen(m[0].text), sizeof m[0].text - 1);
    assert_int_equal(m[1].text[0], 0x5A);
}

static void fields(void **state)
{
    dmb_message m;
    (void)state;
    dmb_message_field(&m, "pipe", 3, "outer_diameter", (double)NAN, "finite and > inner_diameter");
    assert_string_equal(m.text, "pipe 3: outer_diameter = nan, must be finite and > inner_diameter");
    dmb_message_field(&m, "wall", DMB_NONE, "diameter", -0.094, "> 0");
    assert_string_equal(m.text, "wall: diameter = -0.094, must be > 0");
    const dmb_field_value is = {"velocity", 5, (double)INFINITY};
    dmb_message_component(&m, "string", 0, &is, "finite");
    assert_string_equal(m.text, "string 0: velocity[5] = inf, must be finite");
    dmb_message_clear(&m);
    assert_string_equal(m.text, "");
}

static void names_of_parts(void **state)
{
    const char unfinished[4] = {'r', 'o', 'd', 's'};
    dmb_message m;
    (void)state;
    assert_string_equal(dmb_part_text(&m, "joint", 3, "crank", 6), "joint 3 (crank)");
    assert_ptr_equal(dmb_part_text(&m, "joint", 3, "", 1), m.text);
    assert_string_equal(m.text, "joint 3");
    assert_string_equal(dmb_part_text(&m, "coupling", 0, unfinished, 4), "coupling 0");
    assert_string_equal(dmb_part_text(&m, "coupling", 1, "100%s", 6), "coupling 1 (100%s)");
    assert_string_equal(dmb_part_text(&m, "joint", 3, "", 0), "joint 3");
}

static void no_message(void **state)
{
    (void)state;
    dmb_message_set(NULL, "%s", "lost");
    dmb_message_field(NULL, "pipe", 0, "length", 0.0, "> 0");
    dmb_message_clear(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(conversions),
        cmocka_unit_test(characters),
        cmocka_unit_test(conversions_it_does_not_know),
        cmocka_unit_test(too_long_a_text_is_cut),
        cmocka_unit_test(fields),
        cmocka_unit_test(names_of_parts),
        cmocka_unit_test(no_message),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
