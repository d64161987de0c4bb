/* Checks of the caller's values. A dmb_check collects the result for one part: the first value that fails sets the
 * status and the message, later checks do nothing. For each value DMB_ERR_NOT_FINITE has priority over DMB_ERR_VALUE.
 *
 *     dmb_check check = dmb_check_of(&model->message, "pipe", index);
 *     dmb_check_above(&check, "length", def->length, 0.0);
 *     dmb_check_above_field(&check, "outer_diameter", def->outer_diameter, "inner_diameter", def->inner_diameter);
 *     if (check.status < 0) return check.status; */
#ifndef DMB_BASE_VALUE_CHECK_H
#define DMB_BASE_VALUE_CHECK_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/message.h"
#include "drillmbd/base.h"

static inline bool dmb_is_finite(double value)
{
    return isfinite(value) != 0;
}

typedef struct dmb_check {
    dmb_message *message; /* may be NULL */
    const char *part;     /* "pipe", "wall", ... */
    uint32_t index;       /* number of the part, or DMB_NONE */
    int32_t status;       /* DMB_OK, or the first failure */
} dmb_check;

static inline dmb_check dmb_check_of(dmb_message *message, const char *part, uint32_t index)
{
    dmb_check check;
    check.message = message;
    check.part = part;
    check.index = index;
    check.status = DMB_OK;
    return check;
}

/* Fails with status and "<part> <index>: <field> = <value>, must be <bound>", unless a check has failed before. */
void dmb_check_fail(dmb_check *check, int32_t status, const char *field, double value, const char *bound);
/* The same of an element of an array, with a bound that may be a range. */
typedef struct dmb_check_bound {
    const char *text;
    double low, high; /* NaN: no range */
} dmb_check_bound;
void dmb_check_fail_value(dmb_check *check, int32_t status, const dmb_field_value *is, const dmb_check_bound *must);

/* One number. */
void dmb_check_finite(dmb_check *check, const char *field, double value);
void dmb_check_above(dmb_check *check, const char *field, double value, double bound);              /* value > bound */
void dmb_check_at_least(dmb_check *check, const char *field, double value, double bound);           /* value >= bound */
void dmb_check_within(dmb_check *check, const char *field, double value, double low, double high);  /* low..high */
void dmb_check_between(dmb_check *check, const char *field, double value, double low, double high); /* low < . < high */

/* One number against another field. A bound that is not finite makes the check fail too. */
void dmb_check_above_field(dmb_check *check, const char *field, double value, const char *other, double bound);
void dmb_check_at_least_field(dmb_check *check, const char *field, double value, const char *other, double bound);

/* Arrays: the message names the component. */
void dmb_check_all_finite(dmb_check *check, const char *field, const double *values, size_t count);
void dmb_check_increasing(dmb_check *check, const char *field, const double *values, size_t count, size_t stride);

/* Integers: low <= value <= high. */
void dmb_check_choice(dmb_check *check, const char *field, int32_t value, int32_t low, int32_t high);
void dmb_check_count(dmb_check *check, const char *field, uint32_t value, uint32_t low, uint32_t high);
/* Fails for any bit outside the mask `allowed`, a nonnegative number. */
void dmb_check_mask(dmb_check *check, const char *field, int32_t value, int32_t allowed);

/* A pointer that must not be NULL: DMB_ERR_NULL. */
void dmb_check_pointer(dmb_check *check, const char *field, const void *pointer);

#endif
