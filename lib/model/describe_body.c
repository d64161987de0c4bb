/* Rigid bodies: rig heads and other bodies fixed to a string, bodies of their own, bits. */
#include "model/describe.h"
#include "model/field_check.h"
#include "model/model.h"
#include "model/section.h"

enum { BLADES_MAX = 64, HISTORY_MIN = 64, HISTORY_MAX = 1 << 20 };

/* ---- Bodies ------------------------------------------------------------------------------------------------------ */

static void check_inertia(dmb_check *check, const dmb_body_def *def)
{
    dmb_check_each_within(check, "inertia", def->inertia, 3, DMB_INERTIA_MIN, DMB_INERTIA_MAX);
    dmb_check_each_within(check, "products of inertia", def->inertia + 3, 3, -DMB_INERTIA_MAX, DMB_INERTIA_MAX);
    dmb_check_inertia_matrix(check, "inertia", def->inertia);
}

static void check_pose(dmb_check *check, const dmb_body_def *def)
{
    dmb_check_each_within(check, "position", def->position, 3, -DMB_POSITION_MAX, DMB_POSITION_MAX);
    dmb_check_each_within(check, "rotation", def->rotation, 3, -DMB_ANGLE_MAX, DMB_ANGLE_MAX);
    dmb_check_each_within(check, "velocity", def->velocity, 6, -DMB_SPEED_MAX, DMB_SPEED_MAX);
    dmb_check_motion_mask(check, "free_mask", def->free_mask);
}

static int32_t check_body(dmb_model *model, const dmb_body_def *def)
{
    dmb_message part;
    dmb_check check = dmb_check_of(
        &model->message, dmb_part_text(&part, "body", model->bodies.count, def->name, sizeof def->name), DMB_NONE);
    dmb_check_part_name(&check, model, DMB_PART_BODY, def->name);
    dmb_check_choice(&check, "attach", def->attach, DMB_ATTACH_NONE, DMB_ATTACH_END);
    dmb_check_id_or_none(&check, model, "string", def->string, DMB_PART_STRING, "string");
    dmb_check_within(&check, "mass", def->mass, DMB_MASS_MIN, DMB_MASS_MAX);
    dmb_check_within(&check, "displaced_volume", def->displaced_volume, 0.0, DMB_MASS_MAX);
    dmb_check_each_within(&check, "added_mass", def->added_mass, 2, 0.0, DMB_MASS_MAX);
    dmb_check_each_within(&check, "centre", def->centre, 3, -DMB_LENGTH_MAX, DMB_LENGTH_MAX);
    check_inertia(&check, def);
    check_pose(&check, def);
    dmb_check_zero_or_within(&check, "contact_diameter", def->contact_diameter, DMB_LENGTH_MIN, DMB_LENGTH_MAX);
    dmb_check_within(&check, "contact_length", def->contact_length, DMB_LENGTH_MIN, DMB_LENGTH_MAX);
    return check.status;
}

int32_t dmb_model_add_body(dmb_model *model, const dmb_body_def *def, dmb_id *body)
{
    dmb_body_def read = dmb_body_def_default();
    int32_t status = dmb_describe_open(model, "body", def);
    if (status < 0) return status;
    status = dmb_body_def_read(&read, def);
    if (status >= 0) status = check_body(model, &read);
    if (status >= 0) status = dmb_describe_append(model, &model->bodies, &read, sizeof read, DMB_PART_BODY, body);
    return dmb_describe_end(model, "body", &read, sizeof read, status);
}

/* ---- Bits -------------------------------------------------------------------------------------------------------- */

static void check_rock(dmb_check *check, const dmb_bit_def *def)
{
    dmb_check_choice(check, "rock_law", def->rock_law, DMB_ROCK_NONE, DMB_ROCK_REGENERATIVE);
    dmb_check_within(check, "intrinsic_energy", def->intrinsic_energy, DMB_MODULUS_MIN, DMB_MODULUS_MAX);
    dmb_check_within(check, "cutting_ratio", def->cutting_ratio, DMB_NUMBER_MIN, DMB_NUMBER_MAX);
    dmb_check_within(check, "contact_strength", def->contact_strength, 0.0, DMB_MODULUS_MAX);
    dmb_check_within(check, "wear_length", def->wear_length, 0.0, DMB_LENGTH_MAX);
    dmb_check_within(check, "contact_friction", def->contact_friction, 0.0, DMB_NUMBER_MAX);
    dmb_check_within(check, "intrusion_depth", def->intrusion_depth, DMB_DEPTH_MIN, DMB_LENGTH_MAX);
    dmb_check_within(check, "bottom", def->bottom, 0.0, DMB_LENGTH_MAX);
    dmb_check_within(check, "side_cutting", def->side_cutting, 0.0, 1e3);
    dmb_check_within(check, "displaced_volume", def->displaced_volume, 0.0, DMB_MASS_MAX);
    dmb_check_each_within(check, "added_mass", def->added_mass, 2, 0.0, DMB_MASS_MAX);
    dmb_check_within(check, "walk_angle", def->walk_angle, -1.5, 1.5);
    dmb_check_count(check, "blades", def->blades, 1, BLADES_MAX);
    dmb_check_count(check, "history", def->history, HISTORY_MIN, HISTORY_MAX);
}

/* One of the two may be that of a solid cylinder. */
static void check_bit_inertia(dmb_check *check, const dmb_bit_def *def)
{
    dmb_rigid_part part;
    dmb_check_each_zero_or_within(check, "inertia", def->inertia, 2, DMB_INERTIA_MIN, DMB_INERTIA_MAX);
    dmb_check_zero_or_within(check, "diameter", def->diameter, DMB_LENGTH_MIN, DMB_LENGTH_MAX);
    dmb_check_within(check, "length", def->length, DMB_LENGTH_MIN, DMB_LENGTH_MAX);
    dmb_check_within(check, "radius", def->radius, DMB_LENGTH_MIN, DMB_LENGTH_MAX);
    if (check->status < 0) return;
    dmb_bit_body_of(def, &part);
    dmb_check_inertia_of_revolution(check, "inertia", part.inertia);
}

static int32_t check_bit(dmb_model *model, const dmb_bit_def *def)
{
    dmb_message part;
    dmb_check check = dmb_check_of(
        &model->message, dmb_part_text(&part, "bit", model->bits.count, def->name, sizeof def->name), DMB_NONE);
    dmb_check_part_name(&check, model, DMB_PART_BIT, def->name);
    dmb_check_id_or_none(&check, model, "string", def->string, DMB_PART_STRING, "string");
    dmb_check_id_or_none(&check, model, "load", def->load, DMB_PART_TIME_FUNCTION, "time function");
    dmb_check_id_or_none(&check, model, "stabiliser", def->stabiliser, DMB_PART_STABILISER, "stabiliser");
    dmb_check_within(&check, "mass", def->mass, DMB_MASS_MIN, DMB_MASS_MAX);
    check_bit_inertia(&check, def);
    check_rock(&check, def);
    dmb_check_within(&check, "inner_radius", def->inner_radius, 0.0, DMB_LENGTH_MAX);
    if (check.status >= 0 && !(def->radius - def->inner_radius >= DMB_LENGTH_MIN))
        dmb_check_fail(&check, DMB_ERR_VALUE, "inner_radius", def->inner_radius, "below radius by at least 1e-6 m");
    return check.status;
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
    if (status >= 0) status = check_bit(model, &read);
    if (status >= 0 && dmb_id_is_none(read.stabiliser))
        status = dmb_string_is_open(model, "bit", string_of_bit(model, &read));
    if (!dmb_id_is_none(read.stabiliser)) /* those of the ring */
        read.diameter = read.displaced_volume = read.added_mass[0] = read.added_mass[1] = 0.0;
    if (status >= 0) status = dmb_describe_append(model, &model->bits, &read, sizeof read, DMB_PART_BIT, bit);
    return dmb_describe_end(model, "bit", &given, sizeof given, status);
}
