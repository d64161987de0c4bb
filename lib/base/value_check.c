#include "base/value_check.h"

static void fail_component(dmb_check *check, int32_t status, const char *field, uint32_t component, double value,
                           const char *bound)
{
    if (check->status < 0) return;
    check->status = status;
    dmb_message_component(check->message, check->part, check->index, field, component, value, bound);
}

void dmb_check_fail(dmb_check *check, int32_t status, const char *field, double value, const char *bound)
{
    fail_component(check, status, field, DMB_NONE, value, bound);
}

/* The verdict on one number; `holds` is what was asked of a finite value. */
static void judge(dmb_check *check, const char *field, uint32_t component, double value, bool holds, const char *bound)
{
    if (!dmb_is_finite(value)) {
        fail_component(check, DMB_ERR_NOT_FINITE, field, component, value, bound);
    } else if (!holds) {
        fail_component(check, DMB_ERR_VALUE, field, component, value, bound);
    }
}

static void judge_bound(dmb_check *check, const char *field, uint32_t component, double value, bool holds,
                        const char *relation, double bound)
{
    dmb_message text;
    if (check->status < 0 || (holds && dmb_is_finite(value))) return;
    dmb_message_set(&text, "finite and %s %g", relation, bound);
    judge(check, field, component, value, holds, text.text);
}

static void judge_range(dmb_check *check, const char *field, double value, bool holds, const char *format_low,
                        double low, const char *format_high, double high)
{
    dmb_message text;
    if (check->status < 0 || (holds && dmb_is_finite(value))) return;
    dmb_message_set(&text, "finite, %s %g and %s %g", format_low, low, format_high, high);
    judge(check, field, DMB_NONE, value, holds, text.text);
}

void dmb_check_finite(dmb_check *check, const char *field, double value)
{
    judge(check, field, DMB_NONE, value, true, "finite");
}

void dmb_check_above(dmb_check *check, const char *field, double value, double bound)
{
    judge_bound(check, field, DMB_NONE, value, value > bound, ">", bound);
}

void dmb_check_at_least(dmb_check *check, const char *field, double value, double bound)
{
    judge_bound(check, field, DMB_NONE, value, value >= bound, ">=", bound);
}

void dmb_check_within(dmb_check *check, const char *field, double value, double low, double high)
{
    judge_range(check, field, value, value >= low && value <= high, ">=", low, "<=", high);
}

void dmb_check_between(dmb_check *check, const char *field, double value, double low, double high)
{
    judge_range(check, field, value, value > low && value < high, ">", low, "<", high);
}

static void judge_field(dmb_check *check, const char *field, double value, bool holds, const char *relation,
                        const char *other, double bound)
{
    dmb_message text;
    if (check->status < 0 || (holds && dmb_is_finite(value) && dmb_is_finite(bound))) return;
    dmb_message_set(&text, "finite and %s %s (%g)", relation, other, bound);
    judge(check, field, DMB_NONE, value, holds && dmb_is_finite(bound), text.text);
}

void dmb_check_above_field(dmb_check *check, const char *field, double value, const char *other, double bound)
{
    judge_field(check, field, value, value > bound, ">", other, bound);
}

void dmb_check_at_least_field(dmb_check *check, const char *field, double value, const char *other, double bound)
{
    judge_field(check, field, value, value >= bound, ">=", other, bound);
}

void dmb_check_all_finite(dmb_check *check, const char *field, const double *values, size_t count)
{
    for (size_t i = 0; i < count; ++i) judge(check, field, (uint32_t)i, values[i], true, "finite");
}

void dmb_check_increasing(dmb_check *check, const char *field, const double *values, size_t count, size_t stride)
{
    for (size_t i = 0; i < count; ++i) {
        double value = values[i * stride];
        if (i == 0) {
            judge(check, field, 0, value, true, "finite");
        } else {
            judge_bound(check, field, (uint32_t)i, value, value > values[(i - 1) * stride], ">",
                        values[(i - 1) * stride]);
        }
    }
}

void dmb_check_choice(dmb_check *check, const char *field, int32_t value, int32_t low, int32_t high)
{
    dmb_message text;
    if (value >= low && value <= high) return;
    dmb_message_set(&text, "%d .. %d", low, high);
    dmb_check_fail(check, DMB_ERR_VALUE, field, value, text.text);
}

void dmb_check_count(dmb_check *check, const char *field, uint32_t value, uint32_t low, uint32_t high)
{
    dmb_message text;
    if (value >= low && value <= high) return;
    dmb_message_set(&text, "%u .. %u", low, high);
    dmb_check_fail(check, DMB_ERR_VALUE, field, value, text.text);
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
