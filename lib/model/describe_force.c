/* Springs between two points, and forces by the caller's functions. */
#include "base/memory.h"
#include "constraint/joint.h"
#include "drillmbd/scene.h"
#include "model/describe.h"
#include "model/field_check.h"
#include "model/model.h"

/* ---- Points ------------------------------------------------------------------------------------------------------ */

/* On a part an offset is an arm; on the ground it is a position, whose range the list has. */
static void check_arm(dmb_check *check, const dmb_place *place, const char *field, const double offset[3])
{
    if (!dmb_id_is_none(place->part)) dmb_check_each_within(check, field, offset, 3, -DMB_LENGTH_MAX, DMB_LENGTH_MAX);
}

static bool is_same_point(const dmb_spring_def *def)
{
    const dmb_place *a = &def->place_a, *b = &def->place_b;
    if (a->part.index != b->part.index || a->part.generation != b->part.generation || a->pipe != b->pipe) return false;
    if (a->fraction < b->fraction || a->fraction > b->fraction) return false;
    for (int k = 0; k < 3; ++k)
        if (def->offset_a[k] < def->offset_b[k] || def->offset_a[k] > def->offset_b[k]) return false;
    return true;
}

static void check_points(dmb_check *check, const dmb_spring_def *def)
{
    check_arm(check, &def->place_a, "offset_a", def->offset_a);
    check_arm(check, &def->place_b, "offset_b", def->offset_b);
    if (check->status < 0) return;
    if (dmb_id_is_none(def->place_a.part) && dmb_id_is_none(def->place_b.part)) {
        check->status = DMB_ERR_VALUE;
        dmb_message_set(check->message, "%s: place_b = the ground as place_a, must be on a part", check->part);
    } else if (is_same_point(def)) {
        check->status = DMB_ERR_VALUE;
        dmb_message_set(check->message, "%s: place_b with offset_b = the point of place_a, must be another one",
                        check->part);
    }
}

/* ---- Characteristic ---------------------------------------------------------------------------------------------- */

static void check_table(dmb_check *check, const dmb_spring_def *def)
{
    const double *x = def->table_elongation, *f = def->table_force;
    dmb_check_increasing(check, "table_elongation", x, def->table_count, 1);
    for (uint32_t i = 1; i < def->table_count && check->status == DMB_OK; ++i) {
        if (x[i] - x[i - 1] < DMB_DEPTH_MIN)
            dmb_check_fail(check, DMB_ERR_VALUE, "table_elongation", x[i], "> the one before by 1e-12 m");
        if (def->acts != DMB_SPRING_BOTH && f[i] < f[i - 1])
            dmb_check_fail(check, DMB_ERR_VALUE, "table_force", f[i], ">= the one before in a one-sided spring");
    }
}

static void relate_spring(dmb_check *check, dmb_model *model, const void *part)
{
    const dmb_spring_def *def = part;
    (void)model;
    check_points(check, def);
    if (check->status >= 0) check_table(check, def);
    if (def->stiffness > 0.0 || def->damping > 0.0 || fabs(def->preload) > 0.0 || def->table_count > 0) return;
    dmb_check_fail(check, DMB_ERR_VALUE, "stiffness", def->stiffness,
                   "> 0, or damping, preload or a table: nothing acts");
}

/* ---- The model's copy -------------------------------------------------------------------------------------------- */

void dmb_spring_release(dmb_spring_plan *spring, const dmb_allocator *allocator)
{
    dmb_release(allocator, spring->points, spring->law.count * sizeof *spring->points);
    spring->points = NULL;
}

static int32_t copy_table(dmb_model *model, dmb_spring_plan *spring)
{
    const dmb_spring_def *def = &spring->def;
    if (def->table_count == 0) return DMB_OK;
    spring->points = dmb_allocate(&model->allocator, def->table_count * sizeof *spring->points);
    if (spring->points == NULL) return DMB_ERR_NO_MEMORY;
    for (uint32_t i = 0; i < def->table_count; ++i) {
        spring->points[i].elongation = def->table_elongation[i];
        spring->points[i].force = def->table_force[i];
    }
    dmb_spring_table_prepare(spring->points, def->table_count, def->table_kind == DMB_TABLE_CUBIC);
    spring->law.count = def->table_count;
    return DMB_OK;
}

static int32_t make_law(dmb_model *model, dmb_spring_plan *spring)
{
    const dmb_spring_def *def = &spring->def;
    dmb_message part;
    spring->law = (dmb_spring_law){
        .stiffness = def->stiffness, .damping = def->damping, .preload = def->preload, .acts = def->acts};
    const int32_t status = copy_table(model, spring);
    if (status < 0 || dmb_spring_law_prepare(&spring->law, spring->points)) return status;
    dmb_message_set(&model->message,
                    "%s: acts = %d, must be 0 (both sides) where the elastic force does not pass through 0 within "
                    "+-1e9 m: give a stiffness, or a table that does",
                    dmb_part_text(&part, "spring", model->springs.count, def->name, sizeof def->name), (int)def->acts);
    return DMB_ERR_VALUE;
}

static int32_t append_spring(dmb_model *model, const dmb_spring_def *def, dmb_id *id)
{
    dmb_spring_plan spring = {.def = *def};
    int32_t status = make_law(model, &spring);
    spring.def.table_elongation = spring.def.table_force = NULL;
    if (status >= 0) status = dmb_describe_append(model, &model->springs, &spring, sizeof spring, DMB_PART_SPRING, id);
    if (status < 0) dmb_spring_release(&spring, &model->allocator);
    return status;
}

int32_t dmb_model_add_spring(dmb_model *model, const dmb_spring_def *def, dmb_id *spring)
{
    dmb_spring_def read = dmb_spring_def_default();
    int32_t status = dmb_describe_open(model, "spring", def);
    if (status < 0) return status;
    status = dmb_spring_def_read(&read, def);
    if (status >= 0) status = dmb_describe_check(model, DMB_FIELDS_OF(dmb_spring_def), &read, relate_spring);
    if (status >= 0) status = append_spring(model, &read, spring);
    return dmb_describe_end(model, "spring", &read, sizeof read, status);
}

/* ---- Forces by the caller's functions ---------------------------------------------------------------------------- */

static void check_coordinate(dmb_check *check, const dmb_model *model, const dmb_force_def *def, uint32_t i,
                             uint32_t joint)
{
    const dmb_joint_def *of = DMB_LIST_AT(const dmb_joint_def, model->joints, joint);
    const int on_hole = of->kind == DMB_JOINT_POINT_ON_HOLE;
    dmb_message field, name, bound;
    dmb_message_set(&field, "component[%u]", i);
    dmb_check_choice(check, field.text, def->component[i], DMB_X, DMB_RZ);
    if (check->status < 0 || (!on_hole && (dmb_joint_free_mask(of->kind) >> def->component[i] & 1) != 0)) return;
    dmb_message_set(&bound, "free in its joint: %s", dmb_part_text(&name, "joint", joint, of->name, sizeof of->name));
    dmb_check_fail(check, DMB_ERR_VALUE, field.text, def->component[i], bound.text);
}

static void check_argument(dmb_check *check, const dmb_model *model, const dmb_force_def *def, uint32_t i)
{
    const uint32_t joint = dmb_model_part_index(model, def->place[i].part, DMB_PART_JOINT);
    dmb_message place, offset;
    if (joint != DMB_NONE) {
        check_coordinate(check, model, def, i, joint);
        return;
    }
    dmb_message_set(&place, "place[%u]", i);
    dmb_message_set(&offset, "offset of place %u", i);
    dmb_check_place(check, model, place.text, &def->place[i]);
    dmb_check_each_within(check, offset.text, def->offset + 3 * i, 3, -DMB_LENGTH_MAX, DMB_LENGTH_MAX);
}

static void relate_force(dmb_check *check, dmb_model *model, const void *part)
{
    const dmb_force_def *def = part;
    for (uint32_t i = 0; i < def->place_count && check->status >= 0; ++i) check_argument(check, model, def, i);
    if (check->status >= 0 && def->state_count > 0 && (def->provides & DMB_PROVIDES_POTENTIAL) != 0)
        dmb_check_fail(check, DMB_ERR_UNSUPPORTED, "provides", def->provides,
                       "without DMB_PROVIDES_POTENTIAL where state_count > 0: its power is work of loads");
}

int32_t dmb_model_add_force(dmb_model *model, const dmb_force_def *def, dmb_id *force)
{
    dmb_force_def read = dmb_force_def_default();
    return dmb_describe_add(model, DMB_FIELDS_OF(dmb_force_def), def, &read, relate_force, force);
}

/* ---- Places that can be stuck ------------------------------------------------------------------------------------ */

static void relate_stuck(dmb_check *check, dmb_model *model, const void *part)
{
    const dmb_stuck_def *def = part;
    (void)model;
    if (def->holds == 0) dmb_check_fail(check, DMB_ERR_VALUE, "holds", def->holds, "> 0: nothing is held");
    if (def->overtorque > def->stiffness[1])
        dmb_check_fail(check, DMB_ERR_VALUE, "overtorque", def->overtorque, "<= stiffness[1] times 1 rad");
}

int32_t dmb_model_add_stuck(dmb_model *model, const dmb_stuck_def *def, dmb_id *stuck)
{
    dmb_stuck_def read = dmb_stuck_def_default();
    return dmb_describe_add(model, DMB_FIELDS_OF(dmb_stuck_def), def, &read, relate_stuck, stuck);
}
