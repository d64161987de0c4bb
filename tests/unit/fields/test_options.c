/* Every field of every list of fields/options.h: defaults and bounds are accepted, values beyond the bounds are refused
 * with the name of the field and the range, in the message and in dmb_last_error. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include <math.h>

#include "base/failure.h"
#include "drillmbd/analyse.h"
#include "drillmbd/run.h"
#include "model/field_check.h"

typedef union options {
    uint32_t struct_size;
    double aligned[32];
} options;

#define LIST(number, T, word, kind, oldest, FIELDS) DMB_OPTIONS_OF(T),
static const dmb_field_list *const lists[] = {DMB_OPTIONS(LIST)};
enum { LISTS = sizeof lists / sizeof lists[0] };

static bool is_real(const dmb_def_field *field)
{
    return field->type == DMB_TYPE_REAL;
}

static void put(const dmb_def_field *field, options *o, size_t i, double value)
{
    void *at = (char *)o + field->offset;
    if (is_real(field)) ((double *)at)[i] = value;
    if (field->type == DMB_TYPE_INT) ((int32_t *)at)[i] = (int32_t)value;
    if (field->type == DMB_TYPE_COUNT) ((uint32_t *)at)[i] = (uint32_t)value;
}

/* Defaults, with values for the two fields that have none: curve_stress and slope of fatigue. */
static options good(const dmb_field_list *list)
{
    options o;
    memset(&o, 0, sizeof o);
    memcpy(&o, list->defaults, list->size);
    o.struct_size = list->size;
    if (list == DMB_OPTIONS_OF(dmb_fatigue_options)) {
        dmb_fatigue_options *fatigue = (dmb_fatigue_options *)(void *)&o;
        fatigue->curve_stress = 1e8;
        fatigue->slope = 4.0;
    }
    return o;
}

static int32_t status_of(const dmb_field_list *list, const options *given, dmb_message *message)
{
    dmb_check check = dmb_check_of(message, list->word, DMB_NONE);
    options out;
    dmb_options_get(&check, list, given, &out);
    return check.status;
}

/* ---- Tests ------------------------------------------------------------------------------------------------------- */

static void rows_do_not_overlap(void **state)
{
    (void)state;
    for (size_t i = 0; i < LISTS; ++i) {
        unsigned char used[sizeof(options)] = {0};
        assert_true(lists[i]->size <= sizeof(options));
        for (uint32_t k = 0; k < lists[i]->count; ++k) {
            const dmb_def_field *field = &lists[i]->fields[k];
            assert_int_equal(field->number, k + 1);
            assert_true(field->offset >= sizeof(uint32_t) && field->offset + field->size <= lists[i]->size);
            for (size_t byte = 0; byte < field->size; ++byte) assert_int_equal(used[field->offset + byte]++, 0);
        }
    }
}

static void defaults_are_accepted_and_no_options_are_defaults(void **state)
{
    dmb_message message;
    (void)state;
    for (size_t i = 0; i < LISTS; ++i) {
        const options o = good(lists[i]);
        if (status_of(lists[i], &o, &message) != DMB_OK) fail_msg("%s", message.text);
        if (lists[i] == DMB_OPTIONS_OF(dmb_fatigue_options)) continue; /* an S-N curve is required */
        if (status_of(lists[i], NULL, &message) != DMB_OK) fail_msg("%s", message.text);
    }
}

static void a_struct_of_another_size_is_refused(void **state)
{
    dmb_message message;
    (void)state;
    for (size_t i = 0; i < LISTS; ++i) {
        options o = good(lists[i]);
        o.struct_size = 7;
        assert_int_equal(status_of(lists[i], &o, &message), DMB_ERR_STRUCT_SIZE);
        assert_non_null(strstr(message.text, "struct_size = 7"));
    }
}

static void refuse(const dmb_field_list *list, const dmb_def_field *field, double value)
{
    dmb_message message;
    dmb_error error = dmb_error_default();
    options o = good(list);
    put(field, &o, 0, value);
    const int32_t wanted = isfinite(value) ? DMB_ERR_VALUE : DMB_ERR_NOT_FINITE;
    const int32_t status = status_of(list, &o, &message);
    if (status != wanted || strstr(message.text, field->name) == NULL)
        fail_msg("%s: %s = %g: %s: %s", list->word, field->name, value, dmb_status_name(status), message.text);
    (void)dmb_failure(NULL, NULL, status, "test", message.text);
    assert_int_equal(dmb_last_error(&error), DMB_OK);
    assert_string_equal(error.field, field->name);
    if (!(fabs(error.low - field->low) <= 0.0 && (isinf(field->high) || fabs(error.high - field->high) <= 0.0)))
        fail_msg("%s: %s: range %g .. %g, must be %g .. %g", list->word, field->name, error.low, error.high, field->low,
                 field->high);
}

static void accept(const dmb_field_list *list, const dmb_def_field *field, double value)
{
    dmb_message message;
    options o = good(list);
    for (size_t i = dmb_field_elements(field, &o); i-- > 0;) put(field, &o, i, value);
    if (status_of(list, &o, &message) != DMB_OK) fail_msg("%s = %g: %s", field->name, value, message.text);
}

static void check_field(const dmb_field_list *list, const dmb_def_field *field)
{
    const double step = is_real(field) ? 0.5 * fabs(field->low) + (field->low == 0.0) : 1.0;
    const bool unsigned_from_zero = field->type == DMB_TYPE_COUNT && field->low < 1.0;
    const bool above = field->bound == DMB_BOUND_ABOVE;
    if (!unsigned_from_zero && field->bound != DMB_BOUND_NOT_GIVEN_OR) refuse(list, field, field->low - step);
    if (field->bound == DMB_BOUND_NOT_GIVEN_OR) refuse(list, field, -0.5);
    if (above) refuse(list, field, field->low);
    if (!above) refuse(list, field, is_real(field) ? 1.5 * field->high : field->high + 1.0);
    if (is_real(field)) refuse(list, field, (double)NAN);
    accept(list, field, above ? 1e-300 : field->low);
    accept(list, field, above ? 1e300 : field->high);
}

static void values_beyond_bounds_are_refused(void **state)
{
    uint32_t checked = 0;
    (void)state;
    for (size_t i = 0; i < LISTS; ++i)
        for (uint32_t k = 0; k < lists[i]->count; ++k) {
            if (lists[i]->fields[k].bound == DMB_BOUND_ANY) continue;
            check_field(lists[i], &lists[i]->fields[k]);
            checked++;
        }
    assert_true(checked > 90);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_do_not_overlap),
        cmocka_unit_test(defaults_are_accepted_and_no_options_are_defaults),
        cmocka_unit_test(a_struct_of_another_size_is_refused),
        cmocka_unit_test(values_beyond_bounds_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
