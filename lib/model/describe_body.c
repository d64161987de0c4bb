/* Rigid bodies: rig heads and other bodies fixed to a string, bodies of their own, bits. */
#include "model/describe.h"
#include "model/field_check.h"
#include "model/model.h"
#include "model/section.h"

/* Moments of inertia are positive; the row of the list has the range of the products. */
static void relate_body(dmb_check *check, dmb_model *model, const void *part)
{
    const dmb_body_def *def = part;
    (void)model;
    dmb_check_each_within(check, "inertia", def->inertia, 3, DMB_INERTIA_MIN, DMB_INERTIA_MAX);
    dmb_check_inertia_matrix(check, "inertia", def->inertia);
}

int32_t dmb_model_add_body(dmb_model *model, const dmb_body_def *def, dmb_id *body)
{
    dmb_body_def read = dmb_body_def_default();
    return dmb_describe_add(model, DMB_FIELDS_OF(dmb_body_def), def, &read, relate_body, body);
}

/* ---- Bits -------------------------------------------------------------------------------------------------------- */

/* One of the two moments of inertia may be that of a solid cylinder. */
static void relate_bit(dmb_check *check, dmb_model *model, const void *part)
{
    const dmb_bit_def *def = part;
    dmb_rigid_part body;
    (void)model;
    dmb_bit_body_of(def, &body);
    dmb_check_inertia_of_revolution(check, "inertia", body.inertia);
    if (!(def->radius - def->inner_radius >= DMB_LENGTH_MIN))
        dmb_check_fail(check, DMB_ERR_VALUE, "inner_radius", def->inner_radius, "below radius by at least 1e-6 m");
}

static uint32_t string_of_bit(const dmb_model *model, const dmb_bit_def *def)
{
    return dmb_id_is_none(def->string) ? 0 : dmb_model_part_index(model, def->string, DMB_PART_STRING);
}

int32_t dmb_model_add_bit(dmb_model *model, const dmb_bit_def *def, dmb_id *bit)
{
    dmb_bit_def read = dmb_bit_def_default();
    int32_t status = dmb_describe_open(model, "bit", def);
    if (status < 0) return status;
    status = dmb_bit_def_read(&read, def);
    const dmb_bit_def given = read;
    if (status >= 0) status = dmb_describe_check(model, DMB_FIELDS_OF(dmb_bit_def), &read, relate_bit);
    if (status >= 0 && dmb_id_is_none(read.stabiliser))
        status = dmb_string_is_open(model, "bit", string_of_bit(model, &read));
    if (!dmb_id_is_none(read.stabiliser)) /* those of the ring */
        read.diameter = read.displaced_volume = read.added_mass[0] = read.added_mass[1] = 0.0;
    if (status >= 0) status = dmb_describe_append(model, &model->bits, &read, sizeof read, DMB_PART_BIT, bit);
    return dmb_describe_end(model, "bit", &given, sizeof given, status);
}
