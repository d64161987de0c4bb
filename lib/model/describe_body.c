/* Rigid bodies: rig heads and other bodies fixed to a string, bodies of their own, bits. */
#include "model/defaults.h"
#include "model/describe.h"
#include "model/field_check.h"
#include "model/limits.h"
#include "model/motion_mask.h"

enum { BLADES_MAX = 64, HISTORY_MIN = 64, HISTORY_MAX = 1 << 20 };

/* ---- Bodies ------------------------------------------------------------------------------------------------------ */

/* Cholesky of the matrix scaled to a unit diagonal, so that neither large nor small inertias over- or underflow. */
static bool is_positive_definite(const double J[6])
{
    if (!(J[0] > 0.0 && J[1] > 0.0 && J[2] > 0.0)) return false;
    const double xy = J[3] / (sqrt(J[0]) * sqrt(J[1]));
    const double xz = J[4] / (sqrt(J[0]) * sqrt(J[2]));
    const double yz = J[5] / (sqrt(J[1]) * sqrt(J[2]));
    const double second = 1.0 - xy * xy;
    if (!(second > 0.0)) return false;
    return 1.0 - xz * xz - (yz - xy * xz) * (yz - xy * xz) / second > 0.0;
}

static void check_inertia(dmb_check *check, const dmb_body_def *def)
{
    dmb_check_each_within(check, "inertia", def->inertia, 3, DMB_INERTIA_MIN, DMB_INERTIA_MAX);
    dmb_check_each_within(check, "products of inertia", def->inertia + 3, 3, -DMB_INERTIA_MAX, DMB_INERTIA_MAX);
    if (check->status < 0 || is_positive_definite(def->inertia)) return;
    check->status = DMB_ERR_VALUE;
    dmb_message_set(check->message, "%s %u: inertia = (%g, %g, %g, %g, %g, %g), must be positive definite", check->part,
                    check->index, def->inertia[0], def->inertia[1], def->inertia[2], def->inertia[3], def->inertia[4],
                    def->inertia[5]);
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
    dmb_check check = dmb_check_of(&model->message, "body", model->bodies.count);
    dmb_check_choice(&check, "attach", def->attach, DMB_ATTACH_NONE, DMB_ATTACH_END);
    dmb_check_id_or_none(&check, model, "string", def->string, DMB_PART_STRING, "string");
    dmb_check_within(&check, "mass", def->mass, DMB_MASS_MIN, DMB_MASS_MAX);
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
    int32_t status = dmb_describe_open(model, def);
    if (status < 0) return status;
    status = dmb_body_def_read(&read, def);
    if (status >= 0) status = check_body(model, &read);
    if (status >= 0) status = dmb_describe_append(model, &model->bodies, &read, sizeof read, DMB_PART_BODY, body);
    return dmb_describe_close(model, "body", status);
}

/* ---- Bits -------------------------------------------------------------------------------------------------------- */

static void check_rock(dmb_check *check, const dmb_bit_def *def)
{
    dmb_check_choice(check, "rock_law", def->rock_law, DMB_ROCK_NONE, DMB_ROCK_REGENERATIVE);
    dmb_check_within(check, "radius", def->radius, DMB_LENGTH_MIN, DMB_LENGTH_MAX);
    dmb_check_within(check, "intrinsic_energy", def->intrinsic_energy, DMB_MODULUS_MIN, DMB_MODULUS_MAX);
    dmb_check_within(check, "cutting_ratio", def->cutting_ratio, DMB_NUMBER_MIN, DMB_NUMBER_MAX);
    dmb_check_within(check, "contact_strength", def->contact_strength, 0.0, DMB_MODULUS_MAX);
    dmb_check_within(check, "wear_length", def->wear_length, 0.0, DMB_LENGTH_MAX);
    dmb_check_within(check, "contact_friction", def->contact_friction, 0.0, DMB_NUMBER_MAX);
    dmb_check_within(check, "intrusion_depth", def->intrusion_depth, DMB_DEPTH_MIN, DMB_LENGTH_MAX);
    dmb_check_within(check, "bottom", def->bottom, 0.0, DMB_LENGTH_MAX);
    dmb_check_count(check, "blades", def->blades, 1, BLADES_MAX);
    dmb_check_count(check, "history", def->history, HISTORY_MIN, HISTORY_MAX);
}

static int32_t check_bit(dmb_model *model, const dmb_bit_def *def)
{
    dmb_check check = dmb_check_of(&model->message, "bit", model->bits.count);
    dmb_check_id_or_none(&check, model, "string", def->string, DMB_PART_STRING, "string");
    dmb_check_id_or_none(&check, model, "load", def->load, DMB_PART_PROGRAMME, "programme");
    dmb_check_within(&check, "mass", def->mass, DMB_MASS_MIN, DMB_MASS_MAX);
    dmb_check_each_zero_or_within(&check, "inertia", def->inertia, 2, DMB_INERTIA_MIN, DMB_INERTIA_MAX);
    dmb_check_zero_or_within(&check, "diameter", def->diameter, DMB_LENGTH_MIN, DMB_LENGTH_MAX);
    dmb_check_within(&check, "length", def->length, DMB_LENGTH_MIN, DMB_LENGTH_MAX);
    check_rock(&check, def);
    return check.status;
}

int32_t dmb_model_add_bit(dmb_model *model, const dmb_bit_def *def, dmb_id *bit)
{
    dmb_bit_def read = dmb_bit_def_default();
    int32_t status = dmb_describe_open(model, def);
    if (status < 0) return status;
    status = dmb_bit_def_read(&read, def);
    if (status >= 0) status = check_bit(model, &read);
    if (status >= 0) status = dmb_describe_append(model, &model->bits, &read, sizeof read, DMB_PART_BIT, bit);
    return dmb_describe_close(model, "bit", status);
}
