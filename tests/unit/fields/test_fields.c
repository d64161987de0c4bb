/* Every field of every list of fields/lists.h through the public calls: its default is within its bounds, its bounds
 * are, and a value beyond them is refused with its name, the value and the range, in the message and in
 * dmb_last_error. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include <math.h>

#include "model/field_check.h"

#define assert_ok(call) assert_int_equal((call), DMB_OK)

/* ---- A model with parts to refer to, and one good definition of each kind -----------------------------------------
 */

static struct {
    dmb_model *model;
    dmb_id time_function, body, joint[2], drive;
} scene;

typedef union definition {
    dmb_environment_def environment;
    dmb_segment segment;
    dmb_wall_def wall;
    dmb_hole_section section;
    dmb_string_def string;
    dmb_pipe_def pipe;
    dmb_stabiliser_def stabiliser;
    dmb_body_def body;
    dmb_bit_def bit;
    dmb_joint_def joint;
    dmb_coupling_def coupling;
    dmb_constraint_def constraint;
    dmb_drive_def drive;
    dmb_load_def load;
    dmb_spring_def spring;
    dmb_force_def force;
    dmb_stuck_def stuck;
    dmb_sub_def sub;
    dmb_input_def input;
    dmb_event_def event;
    dmb_compile_options options;
} definition;

static int32_t no_constraint(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                             double *jacobian)
{
    (void)context, (void)time, (void)count, (void)poses, (void)jacobian;
    value[0] = 0.0;
    return 0;
}

static int32_t no_force(void *context, double time, uint32_t count, const double (*poses)[12],
                        const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                        const dmb_law_memory *memory)
{
    (void)memory;
    (void)context, (void)time, (void)count, (void)poses, (void)velocities, (void)forces, (void)tangent, (void)potential;
    return 0;
}

static void add_drive(void)
{
    dmb_drive_def drive = dmb_drive_def_default();
    drive.kind = DMB_DRIVE_CONTROL;
    drive.component = DMB_RX;
    drive.time_function = scene.time_function;
    assert_ok(dmb_model_add_drive(scene.model, &drive, &scene.drive));
}

static void fresh(void)
{
    const dmb_segment segment = dmb_segment_default();
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    const dmb_body_def body = dmb_body_def_default();
    dmb_joint_def joint = dmb_joint_def_default();
    dmb_model_destroy(&scene.model);
    assert_ok(dmb_model_create(NULL, &scene.model));
    assert_ok(dmb_model_add_time_function(scene.model, &segment, 1, &scene.time_function));
    assert_ok(dmb_model_add_pipes(scene.model, &pipe, 2, NULL));
    joint.kind = DMB_JOINT_REVOLUTE;
    for (int i = 0; i < 2; ++i) {
        assert_ok(dmb_model_add_body(scene.model, &body, &scene.body));
        joint.place_b = dmb_station(scene.body, 0, 0.0);
        assert_ok(dmb_model_add_joint(scene.model, &joint, &scene.joint[i]));
    }
    add_drive();
}

static double elongations[2], tensions[2];

static void good_drive(dmb_drive_def *drive)
{
    drive->kind = DMB_DRIVE_CONTROL;
    drive->component = DMB_RX;
    drive->time_function = scene.time_function;
    drive->curve_count = drive->gain_count = 2;
    drive->curve_speed[1] = drive->gain_error[1] = 1.0;
}

static void good(const dmb_field_list *list, definition *def)
{
    memset(def, 0, sizeof *def);
    memcpy(def, list->defaults, list->size);
    memcpy(def, &list->size, sizeof list->size);
    if (list == DMB_FIELDS_OF(dmb_wall_def)) {
        def->wall.friction_table_count = 2;
        def->wall.friction_table_speed[1] = 1.0;
        def->wall.friction_table_mu[0] = def->wall.friction_table_mu[1] = 0.3;
    }
    if (list == DMB_FIELDS_OF(dmb_joint_def)) {
        def->joint.kind = DMB_JOINT_FREE;
        def->joint.place_b = dmb_station(scene.body, 0, 0.0);
    }
    if (list == DMB_FIELDS_OF(dmb_coupling_def)) memcpy(def->coupling.joint, scene.joint, sizeof scene.joint);
    if (list == DMB_FIELDS_OF(dmb_constraint_def)) {
        def->constraint.place[0] = dmb_station(scene.body, 0, 0.0);
        def->constraint.callback = no_constraint;
    }
    if (list == DMB_FIELDS_OF(dmb_drive_def)) good_drive(&def->drive);
    if (list == DMB_FIELDS_OF(dmb_load_def)) def->load.place = dmb_station(scene.body, 0, 0.0);
    if (list == DMB_FIELDS_OF(dmb_spring_def)) {
        elongations[0] = tensions[0] = 0.0;
        elongations[1] = tensions[1] = 1.0;
        def->spring.place_b = dmb_station(scene.body, 0, 0.0);
        def->spring.offset_b[0] = 1.0;
        def->spring.table_count = 2;
        def->spring.table_elongation = elongations;
        def->spring.table_force = tensions;
    }
    if (list == DMB_FIELDS_OF(dmb_force_def)) {
        def->force.place[0] = dmb_station(scene.body, 0, 0.0);
        def->force.callback = no_force;
    }
    if (list == DMB_FIELDS_OF(dmb_stuck_def)) def->stuck.place = dmb_station(scene.body, 0, 0.0);
    if (list == DMB_FIELDS_OF(dmb_input_def)) {
        def->input.part = scene.drive;
        def->input.name[0] = 'i';
    }
    if (list == DMB_FIELDS_OF(dmb_event_def)) def->event.name[0] = 'e';
}

static int32_t add(const dmb_field_list *list, const definition *def)
{
    dmb_sub sub = dmb_sub_default();
    switch (list - dmb_field_lists) {
    case dmb_environment_def_index: return dmb_model_set_environment(scene.model, &def->environment);
    case dmb_segment_index: return dmb_model_add_time_function(scene.model, &def->segment, 1, NULL);
    case dmb_wall_def_index: return dmb_model_add_wall(scene.model, &def->wall, NULL);
    case dmb_hole_section_index: return dmb_model_add_hole_sections(scene.model, &def->section, 1);
    case dmb_string_def_index: return dmb_model_add_string(scene.model, &def->string, NULL);
    case dmb_pipe_def_index: return dmb_model_add_pipes(scene.model, &def->pipe, 1, NULL);
    case dmb_stabiliser_def_index: return dmb_model_add_stabiliser(scene.model, &def->stabiliser, NULL);
    case dmb_body_def_index: return dmb_model_add_body(scene.model, &def->body, NULL);
    case dmb_bit_def_index: return dmb_model_add_bit(scene.model, &def->bit, NULL);
    case dmb_joint_def_index: return dmb_model_add_joint(scene.model, &def->joint, NULL);
    case dmb_coupling_def_index: return dmb_model_add_coupling(scene.model, &def->coupling, NULL);
    case dmb_constraint_def_index: return dmb_model_add_constraint(scene.model, &def->constraint, NULL);
    case dmb_drive_def_index: return dmb_model_add_drive(scene.model, &def->drive, NULL);
    case dmb_load_def_index: return dmb_model_add_load(scene.model, &def->load, NULL);
    case dmb_spring_def_index: return dmb_model_add_spring(scene.model, &def->spring, NULL);
    case dmb_force_def_index: return dmb_model_add_force(scene.model, &def->force, NULL);
    case dmb_stuck_def_index: return dmb_model_add_stuck(scene.model, &def->stuck, NULL);
    case dmb_sub_def_index: return dmb_model_add_sub(scene.model, &def->sub, &sub);
    case dmb_input_def_index: return dmb_model_add_input(scene.model, &def->input, NULL);
    case dmb_event_def_index: return dmb_model_add_event(scene.model, &def->event, NULL);
    default: return dmb_model_compile(scene.model, &def->options);
    }
}

/* ---- Values ------------------------------------------------------------------------------------------------------ */

static int is_number(const dmb_def_field *field)
{
    return field->type == DMB_TYPE_REAL || field->type == DMB_TYPE_REALS || field->type == DMB_TYPE_INT ||
           field->type == DMB_TYPE_COUNT;
}

static int is_real(const dmb_def_field *field)
{
    return field->type == DMB_TYPE_REAL || field->type == DMB_TYPE_REALS;
}

static void put(const dmb_def_field *field, definition *def, size_t i, double value)
{
    void *at = (char *)def + field->offset;
    if (field->type == DMB_TYPE_REALS) at = strcmp(field->name, "table_force") == 0 ? tensions : elongations;
    if (is_real(field)) ((double *)at)[i] = value;
    if (field->type == DMB_TYPE_INT) ((int32_t *)at)[i] = (int32_t)value;
    if (field->type == DMB_TYPE_COUNT) ((uint32_t *)at)[i] = (uint32_t)value;
}

/* The check of one field by its row alone. */
static int32_t status_of(const dmb_field_list *list, const dmb_def_field *field, const void *def)
{
    dmb_field_list one = *list;
    dmb_check check = dmb_check_of(NULL, "part", DMB_NONE);
    one.fields = field;
    one.count = 1;
    dmb_check_fields(&check, scene.model, &one, def);
    return check.status;
}

static double below(const dmb_def_field *field)
{
    if (!is_real(field)) return field->low - 1.0;
    return field->low > 0.0 ? 0.5 * field->low : field->low < 0.0 ? 1.5 * field->low : -0.5;
}

static double above(const dmb_def_field *field)
{
    return is_real(field) ? 1.5 * field->high : field->high + 1.0;
}

/* The definition is refused for this number, and its error says so as data. */
static void refuse_number(const dmb_field_list *list, const dmb_def_field *field, size_t i, double value)
{
    const int is_array = field->type == DMB_TYPE_REALS || field->size > dmb_field_element_size(field);
    const int32_t wanted = isfinite(value) ? DMB_ERR_VALUE : DMB_ERR_NOT_FINITE;
    dmb_error error = dmb_error_default();
    definition def;
    fresh();
    good(list, &def);
    put(field, &def, i, value);
    const int32_t status = add(list, &def);
    if (status != wanted || strstr(dmb_model_message(scene.model), field->name) == NULL)
        fail_msg("%s, %s[%zu] = %g: %s: %s", list->word, field->name, i, value, dmb_status_name(status),
                 dmb_model_message(scene.model));
    assert_ok(dmb_last_error(&error));
    assert_int_equal(error.status, wanted);
    assert_string_equal(error.field, field->name);
    assert_int_equal(error.component, is_array ? (uint32_t)i : DMB_NONE);
    if (isfinite(value)) assert_true(fabs(error.value - value) <= 0.0);
    const int is_range = field->bound >= DMB_BOUND_WITHIN && field->bound <= DMB_BOUND_NOT_GIVEN_OR;
    if (is_range && !(fabs(error.low - field->low) <= 0.0 && fabs(error.high - field->high) <= 0.0))
        fail_msg("%s, %s: range %g .. %g, must be %g .. %g", list->word, field->name, error.low, error.high, field->low,
                 field->high);
}

static void refuse_numbers(const dmb_field_list *list, const dmb_def_field *field, size_t i)
{
    const int is_unsigned = field->type == DMB_TYPE_COUNT;
    if (is_real(field)) refuse_number(list, field, i, (double)NAN);
    if (is_real(field)) refuse_number(list, field, i, -(double)INFINITY);
    if (field->bound == DMB_BOUND_FINITE) return;
    if (field->bound == DMB_BOUND_BITS || field->bound == DMB_BOUND_SET || field->bound == DMB_BOUND_MOTION) {
        refuse_number(list, field, i, field->high + 1.0);
        if (field->bound != DMB_BOUND_BITS) refuse_number(list, field, i, 0.0);
        refuse_number(list, field, i, -1.0);
        return;
    }
    if (!is_unsigned || field->low >= 1.0) refuse_number(list, field, i, below(field));
    refuse_number(list, field, i, above(field));
    if (field->bound == DMB_BOUND_BETWEEN) refuse_number(list, field, i, field->low);
    if (field->bound == DMB_BOUND_BETWEEN) refuse_number(list, field, i, field->high);
}

static void accept_numbers(const dmb_field_list *list, const dmb_def_field *field, size_t i)
{
    const double values[] = {field->low, field->high, field->bound == DMB_BOUND_NOT_GIVEN_OR ? -1.0 : 0.0};
    const int count = field->bound == DMB_BOUND_ZERO_OR || field->bound == DMB_BOUND_NOT_GIVEN_OR ? 3 : 2;
    definition def;
    fresh();
    good(list, &def);
    const int is_set = field->bound == DMB_BOUND_SET || field->bound == DMB_BOUND_MOTION;
    if (is_set || field->bound < DMB_BOUND_WITHIN || field->bound == DMB_BOUND_BETWEEN) return;
    for (int k = 0; k < count; ++k) {
        put(field, &def, i, values[k]);
        if (status_of(list, field, &def) != DMB_OK)
            fail_msg("%s: %s = %g is refused", list->word, field->name, values[k]);
    }
}

static void refuse(const dmb_field_list *list, const definition *def, const dmb_def_field *field, int32_t wanted)
{
    const int32_t status = add(list, def);
    if (status != wanted || strstr(dmb_model_message(scene.model), field->name) == NULL)
        fail_msg("%s, %s: %s: %s", list->word, field->name, dmb_status_name(status), dmb_model_message(scene.model));
}

static void refuse_other(const dmb_field_list *list, const dmb_def_field *field)
{
    definition def;
    fresh();
    good(list, &def);
    char *at = (char *)&def + field->offset;
    if (field->bound == DMB_BOUND_TEXT) memset(at, 'n', field->size);
    if (field->bound == DMB_BOUND_TEXT) refuse(list, &def, field, DMB_ERR_VALUE);
    if (field->bound == DMB_BOUND_POINTER) memset(at, 0, field->size);
    if (field->bound == DMB_BOUND_POINTER) refuse(list, &def, field, DMB_ERR_NULL);
    if (field->bound < DMB_BOUND_PART || field->bound == DMB_BOUND_POINTER) return;
    const dmb_id wall = {(uint32_t)DMB_PART_WALL << 24, scene.body.generation};
    memcpy(at, &wall, sizeof wall); /* places begin with an id */
    refuse(list, &def, field, DMB_ERR_ID);
}

/* ---- Tests ------------------------------------------------------------------------------------------------------- */

static void lists_are_whole(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < DMB_FIELD_LISTS; ++i) {
        const dmb_field_list *list = &dmb_field_lists[i];
        unsigned char used[sizeof(definition)] = {0}, numbers[64] = {0};
        assert_int_equal(list->number, i + 1);
        assert_true(list->size <= sizeof used && list->size <= DMB_REFUSED_BYTES);
        for (uint32_t k = 0; k < list->count; ++k) {
            const dmb_def_field *field = &list->fields[k];
            assert_in_range(field->number, 1, list->count);
            assert_int_equal(numbers[field->number]++, 0);
            assert_int_equal(field->size % dmb_field_element_size(field), 0);
            assert_true(field->offset >= sizeof(uint32_t) && field->offset + field->size <= list->size);
            for (size_t byte = 0; byte < field->size; ++byte) assert_int_equal(used[field->offset + byte]++, 0);
        }
    }
}

static void defaults_are_within_their_bounds(void **state)
{
    (void)state;
    fresh();
    for (uint32_t i = 0; i < DMB_FIELD_LISTS; ++i) {
        const dmb_field_list *list = &dmb_field_lists[i];
        for (uint32_t k = 0; k < list->count; ++k) {
            const dmb_def_field *field = &list->fields[k];
            if (field->bound == DMB_BOUND_PART || field->bound == DMB_BOUND_PLACE || field->bound == DMB_BOUND_POINTER)
                continue; /* required: there is no default */
            if (status_of(list, field, list->defaults) != DMB_OK)
                fail_msg("%s: the default of %s is refused", list->word, field->name);
        }
    }
}

static void good_definitions_are_accepted(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < DMB_FIELD_LISTS; ++i) {
        definition def;
        fresh();
        good(&dmb_field_lists[i], &def);
        const int32_t status = add(&dmb_field_lists[i], &def);
        if (status != DMB_OK)
            fail_msg("%s: %s: %s", dmb_field_lists[i].word, dmb_status_name(status), dmb_model_message(scene.model));
    }
}

static void values_beyond_bounds_are_refused(void **state)
{
    uint32_t checked = 0, all = 0;
    (void)state;
    for (uint32_t i = 0; i < DMB_FIELD_LISTS; ++i) {
        const dmb_field_list *list = &dmb_field_lists[i];
        for (uint32_t k = 0; k < list->count; ++k) {
            const dmb_def_field *field = &list->fields[k];
            definition def;
            all++;
            if (field->bound == DMB_BOUND_ANY) continue;
            checked++;
            fresh();
            good(list, &def);
            if (!is_number(field)) refuse_other(list, field);
            const size_t last = dmb_field_elements(field, &def) - 1;
            for (size_t e = 0; is_number(field) && e <= last; e += last > 0 ? last : 1) {
                refuse_numbers(list, field, e);
                accept_numbers(list, field, e);
            }
        }
    }
    assert_true(checked > 200 && 10 * checked > 7 * all); /* most fields have a bound of their own */
}

static int tear_down(void **state)
{
    (void)state;
    dmb_model_destroy(&scene.model);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lists_are_whole),
        cmocka_unit_test(defaults_are_within_their_bounds),
        cmocka_unit_test(good_definitions_are_accepted),
        cmocka_unit_test(values_beyond_bounds_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, tear_down);
}
