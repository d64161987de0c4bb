#include "base/value_check.h"

#include "base/failure.h"

void dmb_check_fail_value(dmb_check *check, int32_t status, const dmb_field_value *is, const dmb_check_bound *must)
{
    if (check->status < 0) return;
    check->status = status;
    dmb_message_component(check->message, check->part, check->index, is, must->text);
    const dmb_refused_number number = {is->value, must->low, must->high};
    dmb_failure_note(check->message, &number);
}

void dmb_check_fail(dmb_check *check, int32_t status, const char *field, double value, const char *bound)
{
    const dmb_field_value is = {field, DMB_NONE, value};
    const dmb_check_bound must = {bound, (double)NAN, (double)NAN};
    dmb_check_fail_value(check, status, &is, &must);
}

static const dmb_check_bound any_finite = {"finite", -(double)INFINITY, (double)INFINITY};

/* Checks one number; `holds` is the result for a finite value. */
static void judge(dmb_check *check, const dmb_field_value *is, bool holds, const dmb_check_bound *must)
{
    if (!dmb_is_finite(is->value)) {
        dmb_check_fail_value(check, DMB_ERR_NOT_FINITE, is, must);
    } else if (!holds) {
        dmb_check_fail_value(check, DMB_ERR_VALUE, is, must);
    }
}

static void judge_bound(dmb_check *check, const dmb_field_value *is, bool holds, const char *relation, double bound)
{
    dmb_message text;
    if (check->status < 0 || (holds && dmb_is_finite(is->value))) return;
    dmb_message_set(&text, "finite and %s %g", relation, bound);
    const dmb_check_bound must = {text.text, bound, (double)INFINITY};
    judge(check, is, holds, &must);
}

/* low < value < high; low <= value <= high if `closed`. */
static void judge_range(dmb_check *check, const dmb_field_value *is, bool closed, double low, double high)
{
    const double value = is->value;
    const bool holds = closed ? value >= low && value <= high : value > low && value < high;
    dmb_message text;
    if (check->status < 0 || (holds && dmb_is_finite(value))) return;
    dmb_message_set(&text, closed ? "finite, >= %g and <= %g" : "finite, > %g and < %g", low, high);
    const dmb_check_bound must = {text.text, low, high};
    judge(check, is, holds, &must);
}

void dmb_check_finite(dmb_check *check, const char *field, double value)
{
    const dmb_field_value is = {field, DMB_NONE, value};
    judge(check, &is, true, &any_finite);
}

void dmb_check_above(dmb_check *check, const char *field, double value, double bound)
{
    const dmb_field_value is = {field, DMB_NONE, value};
    judge_bound(check, &is, value > bound, ">", bound);
}

void dmb_check_at_least(dmb_check *check, const char *field, double value, double bound)
{
    const dmb_field_value is = {field, DMB_NONE, value};
    judge_bound(check, &is, value >= bound, ">=", bound);
}

void dmb_check_within(dmb_check *check, const char *field, double value, double low, double high)
{
    const dmb_field_value is = {field, DMB_NONE, value};
    judge_range(check, &is, true, low, high);
}

void dmb_check_between(dmb_check *check, const char *field, double value, double low, double high)
{
    const dmb_field_value is = {field, DMB_NONE, value};
    judge_range(check, &is, false, low, high);
}

/* Checks a value against that of another field. */
static void judge_field(dmb_check *check, const dmb_field_value *is, bool holds, const char *relation,
                        const dmb_field_value *other)
{
    dmb_message text;
    if (check->status < 0 || (holds && dmb_is_finite(is->value) && dmb_is_finite(other->value))) return;
    dmb_message_set(&text, "finite and %s %s (%g)", relation, other->field, other->value);
    const dmb_check_bound must = {text.text, other->value, (double)INFINITY};
    judge(check, is, holds && dmb_is_finite(other->value), &must);
}

void dmb_check_above_field(dmb_check *check, const char *field, double value, const char *other, double bound)
{
    const dmb_field_value is = {field, DMB_NONE, value}, least = {other, DMB_NONE, bound};
    judge_field(check, &is, value > bound, ">", &least);
}

void dmb_check_at_least_field(dmb_check *check, const char *field, double value, const char *other, double bound)
{
    const dmb_field_value is = {field, DMB_NONE, value}, least = {other, DMB_NONE, bound};
    judge_field(check, &is, value >= bound, ">=", &least);
}

void dmb_check_all_finite(dmb_check *check, const char *field, const double *values, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        const dmb_field_value is = {field, (uint32_t)i, values[i]};
        judge(check, &is, true, &any_finite);
    }
}

void dmb_check_increasing(dmb_check *check, const char *field, const double *values, size_t count, size_t stride)
{
    for (size_t i = 0; i < count; ++i) {
        const dmb_field_value is = {field, (uint32_t)i, values[i * stride]};
        if (i == 0) {
            judge(check, &is, true, &any_finite);
        } else {
            const double before = values[(i - 1) * stride];
            judge_bound(check, &is, is.value > before, ">", before);
        }
    }
}

void dmb_check_choice(dmb_check *check, const char *field, int32_t value, int32_t low, int32_t high)
{
    dmb_message text;
    if (value >= low && value <= high) return;
    dmb_message_set(&text, "%d .. %d", low, high);
    const dmb_field_value is = {field, DMB_NONE, value};
    const dmb_check_bound must = {text.text, low, high};
    dmb_check_fail_value(check, DMB_ERR_VALUE, &is, &must);
}

void dmb_check_count(dmb_check *check, const char *field, uint32_t value, uint32_t low, uint32_t high)
{
    dmb_message text;
    if (value >= low && value <= high) return;
    dmb_message_set(&text, "%u .. %u", low, high);
    const dmb_field_value is = {field, DMB_NONE, value};
    const dmb_check_bound must = {text.text, low, high};
    dmb_check_fail_value(check, DMB_ERR_VALUE, &is, &must);
}

void dmb_check_mask(dmb_check *check, const char *field, int32_t value, int32_t allowed)
{
    dmb_message text;
    if (((uint32_t)value & ~(uint32_t)allowed) == 0) return;
    dmb_message_set(&text, "made of the bits of %d", allowed);
    dmb_check_fail(check, DMB_ERR_VALUE, field, value, text.text);
}

void dmb_check_pointer(dmb_check *check, const char *field, const void *pointer)
{
    if (pointer != NULL || check->status < 0) return;
    check->status = DMB_ERR_NULL;
    if (check->index == DMB_NONE) {
        dmb_message_set(check->message, "%s: %s is NULL", check->part, field);
    } else {
        dmb_message_set(check->message, "%s %u: %s is NULL", check->part, check->index, field);
    }
}
