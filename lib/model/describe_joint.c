/* Joints, couplings of their coordinates, and the caller's constraints. */
#include "constraint/joint.h"
#include "math/so3.h"
#include "math/vec3.h"
#include "model/describe.h"
#include "model/field_check.h"
#include "model/model.h"

/* ---- Joints ------------------------------------------------------------------------------------------------------ */

static bool same_place(const dmb_place *a, const dmb_place *b)
{
    return a->part.index == b->part.index && a->part.generation == b->part.generation && a->pipe == b->pipe &&
           !(a->fraction < b->fraction) && !(a->fraction > b->fraction);
}

/* Place b is on a part, place a on another one or the ground. */
static void check_places(dmb_check *check, const dmb_model *model, const dmb_joint_def *def)
{
    if (dmb_id_is_none(def->place_a.part) && dmb_id_is_none(def->place_b.part)) {
        check->status = DMB_ERR_VALUE;
        dmb_message_set(check->message, "%s: place_b = the ground as place_a, must be on a part", check->part);
    }
    dmb_check_place(check, model, "place_b", &def->place_b);
    if (check->status < 0 || !same_place(&def->place_a, &def->place_b)) return;
    check->status = DMB_ERR_VALUE;
    dmb_message_set(check->message, "%s: place_b = place_a, must be on another part", check->part);
}

static void check_axes(dmb_check *check, const char *axis_field, const double axis[3], const char *normal_field,
                       const double normal[3])
{
    double M[9];
    dmb_check_all_finite(check, axis_field, axis, 3);
    dmb_check_all_finite(check, normal_field, normal, 3);
    if (check->status < 0 || dmb_frame_axes(axis, normal, M)) return;
    if (fabs(axis[0]) > 0.0 || fabs(axis[1]) > 0.0 || fabs(axis[2]) > 0.0) {
        dmb_check_fail(check, DMB_ERR_VALUE, normal_field, dmb_vec3_norm(normal), "0 or away from the axis");
    } else {
        dmb_check_fail(check, DMB_ERR_VALUE, axis_field, 0.0, "of length > 0");
    }
}

/* Frame b does not count where it is found by matching, nor frame a where it is the hole's. */
static void check_frames(dmb_check *check, const dmb_joint_def *def)
{
    const double reach = dmb_id_is_none(def->place_a.part) ? DMB_POSITION_MAX : DMB_LENGTH_MAX;
    dmb_check_choice(check, "match", def->match, 0, def->kind == DMB_JOINT_POINT_ON_HOLE ? 0 : 1);
    dmb_check_each_within(check, "origin_a", def->origin_a, 3, -reach, reach);
    check_axes(check, "axis_a", def->axis_a, "normal_a", def->normal_a);
    if (def->match != 0) return;
    dmb_check_each_within(check, "origin_b", def->origin_b, 3, -DMB_LENGTH_MAX, DMB_LENGTH_MAX);
    check_axes(check, "axis_b", def->axis_b, "normal_b", def->normal_b);
}

static void check_stops(dmb_check *check, const dmb_joint_def *def)
{
    dmb_message field, other;
    for (unsigned k = 0; k < 6 && check->status >= 0; ++k) {
        dmb_message_set(&field, "stop_high[%u]", k);
        dmb_message_set(&other, "stop_low[%u]", k);
        dmb_check_above_field(check, field.text, def->stop_high[k], other.text, def->stop_low[k]);
    }
}

/* The place along the hole is not a coordinate with an origin of its own, so no law can act on it. */
static void check_bare(dmb_check *check, const dmb_joint_def *def)
{
    const dmb_joint_def none = dmb_joint_def_default();
    dmb_message field;
    for (unsigned k = 0; k < 6 && check->status >= 0; ++k) {
        const double given[] = {def->stiffness[k], def->damping[k], def->friction[k], def->stop_low[k],
                                def->stop_high[k]};
        const double allowed[] = {0.0, 0.0, 0.0, none.stop_low[k], none.stop_high[k]};
        static const char *const name[] = {"stiffness", "damping", "friction", "stop_low", "stop_high"};
        for (int i = 0; i < 5; ++i) {
            if (!(given[i] < allowed[i]) && !(given[i] > allowed[i])) continue;
            dmb_message_set(&field, "%s[%u]", name[i], k);
            dmb_check_fail(check, DMB_ERR_VALUE, field.text, given[i], "left alone for DMB_JOINT_POINT_ON_HOLE");
        }
    }
}

static void check_point_on_hole(dmb_check *check, const dmb_joint_def *def)
{
    if (def->kind != DMB_JOINT_POINT_ON_HOLE || check->status < 0) return;
    if (!dmb_id_is_none(def->place_a.part)) {
        check->status = DMB_ERR_VALUE;
        dmb_message_set(check->message, "%s: place_a.part = {%u, %u}, must be {0, 0}: the ground, that of the hole",
                        check->part, def->place_a.part.index, def->place_a.part.generation);
    }
    check_bare(check, def);
}

/* A coordinate that the joint holds has no initial value. */
static void check_initial_free(dmb_check *check, const dmb_joint_def *def)
{
    static const char *const names[] = {"X", "Y", "Z", "RX", "RY", "RZ"};
    const uint32_t held = dmb_free_set(def->initial_mask) & ~dmb_joint_free_mask(def->kind);
    dmb_message bound;
    uint32_t k = 0;
    if (held == 0) return;
    while ((held >> k & 1) == 0) ++k;
    dmb_message_set(&bound, "a set of coordinates that are free in this kind of joint, without DMB_FREE_%s", names[k]);
    dmb_check_fail(check, DMB_ERR_VALUE, "initial_mask", def->initial_mask, bound.text);
}

/* The equations of a joint and its initial coordinates are put together at time 0 in the room of six rows. */
static void check_initial_room(dmb_check *check, const dmb_joint_def *def)
{
    uint32_t rows = dmb_joint_row_count(def->kind), given = 0;
    dmb_message bound;
    if (def->state == DMB_JOINT_OPEN) rows = 0;
    if (def->state == DMB_JOINT_LOCKED) rows = DMB_ROWS_MAX;
    for (uint32_t k = 0; k < 6; ++k) given += (uint32_t)dmb_free_set(def->initial_mask) >> k & 1U;
    if (rows + given <= DMB_ROWS_MAX) return;
    dmb_message_set(&bound, "of %u bits at most: with its %u equations no more than %d", DMB_ROWS_MAX - rows, rows,
                    DMB_ROWS_MAX);
    dmb_check_fail(check, DMB_ERR_VALUE, "initial_mask", def->initial_mask, bound.text);
}

static void check_initial(dmb_check *check, const dmb_joint_def *def)
{
    check_initial_free(check, def);
    if (check->status >= 0) check_initial_room(check, def);
}

static void relate_joint(dmb_check *check, dmb_model *model, const void *part)
{
    const dmb_joint_def *def = part;
    const bool sized = def->kind == DMB_JOINT_DISTANCE || def->kind == DMB_JOINT_ROLLING;
    check_places(check, model, def);
    check_frames(check, def);
    dmb_check_within(check, "length", def->length, sized ? DMB_LENGTH_MIN : 0.0, DMB_LENGTH_MAX);
    check_stops(check, def);
    check_point_on_hole(check, def);
    check_initial(check, def);
}

int32_t dmb_model_add_joint(dmb_model *model, const dmb_joint_def *def, dmb_id *joint)
{
    dmb_joint_def read = dmb_joint_def_default();
    return dmb_describe_add(model, DMB_FIELDS_OF(dmb_joint_def), def, &read, relate_joint, joint);
}

/* ---- Couplings --------------------------------------------------------------------------------------------------- */

static void check_ratio(dmb_check *check, const char *field, double ratio)
{
    dmb_check_finite(check, field, ratio);
    if (fabs(ratio) >= DMB_RATIO_MIN && fabs(ratio) <= DMB_RATIO_MAX) return;
    dmb_message bound;
    dmb_message_set(&bound, "of size >= %g and <= %g", DMB_RATIO_MIN, DMB_RATIO_MAX);
    dmb_check_fail(check, DMB_ERR_VALUE, field, ratio, bound.text);
}

static void check_coordinate(dmb_check *check, const dmb_model *model, const dmb_coupled_coordinate *c)
{
    const uint32_t joint = dmb_model_part_index(model, c->joint, DMB_PART_JOINT);
    dmb_message name, bound;
    dmb_check_id(check, model, c->joint_field, c->joint, DMB_PART_JOINT, "joint");
    dmb_check_choice(check, c->component_field, c->component, DMB_X, DMB_RZ);
    if (check->status < 0) return;
    const dmb_joint_def *of = DMB_LIST_AT(const dmb_joint_def, model->joints, joint);
    if ((dmb_joint_free_mask(of->kind) >> c->component & 1) != 0) return;
    dmb_message_set(&bound, "free in its joint: %s", dmb_part_text(&name, "joint", joint, of->name, sizeof of->name));
    dmb_check_fail(check, DMB_ERR_VALUE, c->component_field, c->component, bound.text);
}

/* Each coordinate once. */
static void check_another(dmb_check *check, const dmb_coupling_def *def, uint32_t k)
{
    const dmb_coupled_coordinate c = dmb_coupled_coordinate_of(def, k);
    for (uint32_t i = 0; i < k; ++i) {
        const dmb_coupled_coordinate before = dmb_coupled_coordinate_of(def, i);
        dmb_message bound;
        if (before.joint.index != c.joint.index || before.component != c.component) continue;
        dmb_message_set(&bound, "another coordinate than %s of the same joint", before.component_field);
        dmb_check_fail(check, DMB_ERR_VALUE, c.component_field, c.component, bound.text);
    }
}

static void relate_coupling(dmb_check *check, dmb_model *model, const void *part)
{
    const dmb_coupling_def *def = part;
    for (uint32_t k = 0; k < DMB_COUPLED; ++k) {
        const dmb_coupled_coordinate c = dmb_coupled_coordinate_of(def, k);
        if (k >= 2 && dmb_id_is_none(c.joint)) continue;
        check_coordinate(check, model, &c);
        check_another(check, def, k);
        if (k > 0) check_ratio(check, c.ratio_field, c.ratio);
    }
}

int32_t dmb_model_add_coupling(dmb_model *model, const dmb_coupling_def *def, dmb_id *coupling)
{
    dmb_coupling_def read = dmb_coupling_def_default();
    return dmb_describe_add(model, DMB_FIELDS_OF(dmb_coupling_def), def, &read, relate_coupling, coupling);
}

/* ---- Constraints that the caller's function defines -------------------------------------------------------------- */

static void relate_constraint(dmb_check *check, dmb_model *model, const void *part)
{
    const dmb_constraint_def *def = part;
    (void)model;
    if (def->kind == DMB_CONSTRAINT_NONHOLONOMIC && (def->provides & DMB_PROVIDES_JACOBIAN) == 0)
        dmb_check_fail(check, DMB_ERR_VALUE, "provides", def->provides, "1 for a nonholonomic constraint");
}

int32_t dmb_model_add_constraint(dmb_model *model, const dmb_constraint_def *def, dmb_id *constraint)
{
    dmb_constraint_def read = dmb_constraint_def_default();
    return dmb_describe_add(model, DMB_FIELDS_OF(dmb_constraint_def), def, &read, relate_constraint, constraint);
}
