/* Sections of the hole, as the caller gives them. */
#include <string.h>

#include "drillmbd/hole.h"
#include "model/describe.h"
#include "model/field_check.h"
#include "model/model.h"

enum { SECTIONS_MAX = 1 << 18 };
#define BY_WALL (-1.0) /* a field that is the wall's */

/* clang-format off */
DMB_DEFINE_INIT(dmb_hole_section, 104, {
    .shape = DMB_HOLE_STEP,
    .transition = 0.1,
    .diameter = BY_WALL,
    .stiffness = BY_WALL,
    .restitution = BY_WALL,
    .damping = BY_WALL,
    .mu_static = BY_WALL,
    .mu_dynamic = BY_WALL,
})
/* clang-format on */

/* -1, or low <= value <= high */
static void check_value(dmb_check *check, const char *field, double value, double low, double high)
{
    if (value != BY_WALL) dmb_check_within(check, field, value, low, high);
}

static void check_section(dmb_check *check, const dmb_hole_section *section)
{
    dmb_check_choice(check, "shape", section->shape, DMB_HOLE_STEP, DMB_HOLE_LINE);
    dmb_check_within(check, "depth", section->depth, -DMB_POSITION_MAX, DMB_POSITION_MAX);
    dmb_check_within(check, "transition", section->transition, DMB_LENGTH_MIN, DMB_LENGTH_MAX);
    check_value(check, "diameter", section->diameter, DMB_LENGTH_MIN, DMB_LENGTH_MAX);
    check_value(check, "stiffness", section->stiffness, DMB_STIFFNESS_MIN, DMB_STIFFNESS_MAX);
    check_value(check, "restitution", section->restitution, 0.0, 1.0);
    check_value(check, "damping", section->damping, 0.0, DMB_DAMPING_MAX);
    check_value(check, "mu_static", section->mu_static, 0.0, DMB_NUMBER_MAX);
    check_value(check, "mu_dynamic", section->mu_dynamic, 0.0, DMB_NUMBER_MAX);
    dmb_check_within(check, "strength", section->strength, 0.0, DMB_MODULUS_MAX);
    dmb_check_name(check, "name", section->name, sizeof section->name);
}

/* Sections stand one after the other, as far apart as the first one says. All say the same. */
static int32_t read_section(const dmb_hole_section *sections, uint32_t i, dmb_hole_section *out)
{
    const unsigned char *item = (const unsigned char *)sections + (size_t)i * sections->struct_size;
    uint32_t size;
    memcpy(&size, item, sizeof size);
    *out = dmb_hole_section_default();
    return size == sections->struct_size ? dmb_hole_section_read(out, item) : DMB_ERR_STRUCT_SIZE;
}

static int32_t check_sections(dmb_model *model, const dmb_hole_section *sections, uint32_t count)
{
    const uint32_t before = model->sections.count;
    double above = before > 0 ? DMB_LIST_AT(const dmb_hole_section, model->sections, before - 1)->depth : 0.0;
    for (uint32_t i = 0; i < count; i++) {
        dmb_hole_section read;
        dmb_check check = dmb_check_of(&model->message, "hole section", before + i);
        const int32_t status = read_section(sections, i, &read);
        if (status < 0) return status;
        check_section(&check, &read);
        if (before + i > 0) dmb_check_at_least(&check, "depth", read.depth, above + DMB_LENGTH_MIN);
        if (check.status < 0) return check.status;
        above = read.depth;
    }
    return DMB_OK;
}

static int32_t append_sections(dmb_model *model, const dmb_hole_section *sections, uint32_t count)
{
    const uint32_t before = model->sections.count;
    for (uint32_t i = 0; i < count; i++) {
        dmb_hole_section read;
        (void)read_section(sections, i, &read);
        const int32_t status = dmb_list_append(&model->sections, &model->allocator, &read, sizeof read);
        if (status >= 0) continue;
        model->sections.count = before;
        return status;
    }
    return DMB_OK;
}

int32_t dmb_model_add_hole_sections(dmb_model *model, const dmb_hole_section *sections, uint32_t count)
{
    dmb_hole_section first = dmb_hole_section_default();
    const dmb_described given = {"hole sections", &first, sizeof first, count};
    int32_t status = dmb_describe_open(model, "hole sections", sections);
    if (status < 0) return status;
    dmb_check check = dmb_check_of(&model->message, "hole sections", DMB_NONE);
    dmb_check_count(&check, "count", count, 1, SECTIONS_MAX - model->sections.count);
    status = check.status;
    if (status >= 0) status = read_section(sections, 0, &first);
    if (status >= 0) status = check_sections(model, sections, count);
    if (status >= 0) status = append_sections(model, sections, count);
    return dmb_describe_part(model, &given, status);
}
