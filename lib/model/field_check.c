#include "model/field_check.h"

#include <string.h>

static bool within(double value, double low, double high)
{
    return value >= low && value <= high;
}

static bool is_zero(double value)
{
    return !(value < 0.0) && !(value > 0.0) && dmb_is_finite(value);
}

static void judge_each(dmb_check *check, const char *field, const double *values, size_t count, bool zero_allowed,
                       double low, double high)
{
    dmb_message bound;
    for (size_t i = 0; i < count && check->status == DMB_OK; ++i) {
        if (within(values[i], low, high) || (zero_allowed && is_zero(values[i]))) continue;
        dmb_message_set(&bound, "finite%s, >= %g and <= %g", zero_allowed ? ", 0 or" : "", low, high);
        check->status = dmb_is_finite(values[i]) ? DMB_ERR_VALUE : DMB_ERR_NOT_FINITE;
        dmb_message_component(check->message, check->part, check->index, field, (uint32_t)i, values[i], bound.text);
    }
}

void dmb_check_zero_or_within(dmb_check *check, const char *field, double value, double low, double high)
{
    if (!is_zero(value)) dmb_check_within(check, field, value, low, high);
}

void dmb_check_each_within(dmb_check *check, const char *field, const double *values, size_t count, double low,
                           double high)
{
    judge_each(check, field, values, count, false, low, high);
}

void dmb_check_each_zero_or_within(dmb_check *check, const char *field, const double *values, size_t count, double low,
                                   double high)
{
    judge_each(check, field, values, count, true, low, high);
}

void dmb_check_name(dmb_check *check, const char *field, const char *name, size_t size)
{
    dmb_message bound;
    if (memchr(name, '\0', size) != NULL) return;
    dmb_message_set(&bound, "characters, at most %zu, and a 0", size - 1);
    dmb_check_fail(check, DMB_ERR_VALUE, field, (double)size, bound.text);
}

void dmb_check_id(dmb_check *check, const dmb_model *model, const char *field, dmb_id id, uint32_t kind,
                  const char *what)
{
    if (check->status < 0 || dmb_model_part_index(model, id, kind) != DMB_NONE) return;
    check->status = DMB_ERR_ID;
    if (check->index == DMB_NONE) {
        dmb_message_set(check->message, "%s: %s = {%u, %u}, must name a %s of this model", check->part, field, id.index,
                        id.generation, what);
    } else {
        dmb_message_set(check->message, "%s %u: %s = {%u, %u}, must name a %s of this model", check->part, check->index,
                        field, id.index, id.generation, what);
    }
}

void dmb_check_id_or_none(dmb_check *check, const dmb_model *model, const char *field, dmb_id id, uint32_t kind,
                          const char *what)
{
    if (!dmb_id_is_none(id)) dmb_check_id(check, model, field, id, kind, what);
}

void dmb_check_place(dmb_check *check, const dmb_model *model, const char *field, const dmb_place *place)
{
    const bool on_body = dmb_model_part_index(model, place->part, DMB_PART_BODY) != DMB_NONE ||
                         dmb_model_part_index(model, place->part, DMB_PART_BIT) != DMB_NONE;
    dmb_message part, pipe, fraction;
    dmb_message_set(&part, "%s.part", field);
    dmb_message_set(&pipe, "%s.pipe", field);
    dmb_message_set(&fraction, "%s.fraction", field);
    dmb_check_finite(check, fraction.text, place->fraction);
    if (!on_body) dmb_check_id(check, model, part.text, place->part, DMB_PART_STRING, "string, a body or a bit");
    dmb_check_within(check, fraction.text, place->fraction, 0.0, on_body ? 0.0 : 1.0);
    if (on_body) dmb_check_count(check, pipe.text, place->pipe, 0, 0);
}

void dmb_check_motion_mask(dmb_check *check, const char *field, int32_t mask)
{
    dmb_check_mask(check, field, mask, DMB_FREE_ALL);
    if (dmb_mask_is_closed(mask)) return;
    dmb_check_fail(check, DMB_ERR_UNSUPPORTED, field, mask,
                   "closed under motion: none, all, one, axial and spin, spherical, translations or planar");
}
