/* Parts that were refused against what compile says: it fails with the first of them until each was added after all or
 * the caller lets them go; another part of its kind is not the one that was refused. */
#include "sim_test.h"

static dmb_model *begin(dmb_id *string)
{
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_model *model;
    must(dmb_model_create(NULL, &model));
    must(dmb_model_add_pipes(model, &pipe, 3, string));
    return model;
}

static void expect_refused(dmb_model *model, int32_t status, const char *a, const char *b)
{
    assert_int_equal(dmb_model_compile(model, NULL), status);
    const char *message = dmb_model_message(model);
    if (strstr(message, a) == NULL || strstr(message, b) == NULL) fail_msg("%s", message);
}

static void end(dmb_model *model)
{
    if (dmb_model_compile(model, NULL) != DMB_OK) fail_msg("%s", dmb_model_message(model));
    dmb_model_destroy(&model);
}

/* One field, or one array, corrected. */
static void added_after_all(void **state)
{
    dmb_id string;
    dmb_model *model = begin(&string);
    dmb_body_def body = dmb_body_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    (void)state;
    body.mass = -1.0;
    assert_int_equal(dmb_model_add_body(model, &body, NULL), DMB_ERR_VALUE);
    expect_refused(model, DMB_ERR_VALUE, "1 refused part missing", "body 0: mass = -1");
    expect_refused(model, DMB_ERR_VALUE, "dmb_model_clear_refused", "body 0: mass = -1"); /* it stays */
    body.mass = 1.0;
    must(dmb_model_add_body(model, &body, NULL));
    body.position[0] = 3.0;
    body.inertia[0] = 0.3;
    assert_int_equal(dmb_model_add_body(model, &body, NULL), DMB_ERR_VALUE);
    pipe.density = -1.0;
    assert_int_equal(dmb_model_add_pipes(model, &pipe, 2, NULL), DMB_ERR_VALUE);
    expect_refused(model, DMB_ERR_VALUE, "2 refused parts missing", "body 1: inertia gives");
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.3;
    must(dmb_model_add_body(model, &body, NULL));
    expect_refused(model, DMB_ERR_VALUE, "1 refused part missing", "density = -1");
    pipe.density = 7800.0;
    must(dmb_model_add_pipes(model, &pipe, 2, NULL));
    end(model);
}

/* A loop that overlooks the status: the next load, joint, run of pipes is not the one that is missing. */
static void others_do_not_stand_in(void **state)
{
    dmb_id string;
    dmb_model *model = begin(&string);
    dmb_pipe_def pipe = dmb_pipe_def_default();
    (void)state;
    for (uint32_t i = 0; i < 3; i++) {
        dmb_load_def load = dmb_load_def_default();
        load.place = dmb_station(string, i, 1.0);
        load.force[1] = i == 1 ? (double)NAN : 10.0;
        assert_int_equal(dmb_model_add_load(model, &load, NULL), i == 1 ? DMB_ERR_NOT_FINITE : DMB_OK);
    }
    expect_refused(model, DMB_ERR_NOT_FINITE, "1 refused part missing", "load 1: force[1] = nan");
    must(dmb_model_clear_refused(model));
    pipe.outer_diameter = 0.1, pipe.inner_diameter = 0.2;
    assert_int_equal(dmb_model_add_pipes(model, &pipe, 2, NULL), DMB_ERR_VALUE);
    pipe.outer_diameter = 0.09, pipe.inner_diameter = 0.04;
    must(dmb_model_add_pipes(model, &pipe, 2, NULL));
    expect_refused(model, DMB_ERR_VALUE, "1 refused part missing", "outer_diameter = 0.1");
    pipe.outer_diameter = 0.1, pipe.inner_diameter = 0.05;
    must(dmb_model_add_pipes(model, &pipe, 2, NULL));
    end(model);
}

/* With a name the part is the one of that name, whatever else has changed. */
static void names_tell(void **state)
{
    dmb_id string;
    dmb_model *model = begin(&string);
    dmb_joint_def joint = dmb_joint_def_default();
    (void)state;
    strcpy(joint.name, "support");
    joint.kind = 99;
    joint.place_b = dmb_station(string, 1, 1.0);
    assert_int_equal(dmb_model_add_joint(model, &joint, NULL), DMB_ERR_VALUE);
    strcpy(joint.name, "other");
    joint.kind = DMB_JOINT_FREE;
    must(dmb_model_add_joint(model, &joint, NULL));
    expect_refused(model, DMB_ERR_VALUE, "1 refused part missing", "(support)");
    strcpy(joint.name, "support");
    joint.place_b = dmb_station(string, 2, 1.0);
    joint.match = 1;
    joint.damping[0] = 1.0;
    must(dmb_model_add_joint(model, &joint, NULL));
    end(model);
}

/* Of kinds of which there is one: a later success counts, whatever it says. A second wall can only be let go. */
static void one_of_a_kind(void **state)
{
    dmb_id string;
    dmb_model *model = begin(&string);
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_environment_def environment = dmb_environment_def_default();
    (void)state;
    wall.diameter = -1.0;
    environment.gravity[2] = (double)NAN;
    assert_int_equal(dmb_model_add_wall(model, &wall, NULL), DMB_ERR_VALUE);
    assert_int_equal(dmb_model_set_environment(model, &environment), DMB_ERR_NOT_FINITE);
    wall.diameter = 0.0;
    assert_int_equal(dmb_model_add_wall(model, &wall, NULL), DMB_ERR_VALUE);
    expect_refused(model, DMB_ERR_VALUE, "3 refused parts missing", "wall: diameter = -1");
    wall = dmb_wall_def_default();
    wall.diameter = 0.2, wall.stiffness = 1e6;
    must(dmb_model_add_wall(model, &wall, NULL));
    expect_refused(model, DMB_ERR_NOT_FINITE, "1 refused part missing", "environment: gravity[2] = nan");
    environment.gravity[2] = -1.0, environment.fluid_density = 1000.0;
    must(dmb_model_set_environment(model, &environment));
    assert_int_equal(dmb_model_add_wall(model, &wall, NULL), DMB_ERR_ORDER);
    expect_refused(model, DMB_ERR_ORDER, "1 refused part missing", "wall: the model has one already");
    must(dmb_model_clear_refused(model));
    end(model);
}

static void time_functions_and_structs(void **state)
{
    dmb_id string;
    dmb_model *model = begin(&string);
    dmb_segment term = dmb_segment_default();
    dmb_bit_def bit = dmb_bit_def_default();
    (void)state;
    term.kind = DMB_SEGMENT_STEP;
    term.x1 = -1.0;
    assert_int_equal(dmb_model_add_time_function(model, &term, 1, NULL), DMB_ERR_VALUE);
    expect_refused(model, DMB_ERR_VALUE, "1 refused part missing", "time function 0, segment 0");
    assert_int_equal(dmb_model_add_time_function(model, &term, 0, NULL), DMB_ERR_VALUE);
    bit.struct_size = 3;
    assert_int_equal(dmb_model_add_bit(model, &bit, NULL), DMB_ERR_STRUCT_SIZE);
    assert_int_equal(dmb_model_add_bit(model, NULL, NULL), DMB_ERR_NULL);
    expect_refused(model, DMB_ERR_VALUE, "4 refused parts missing", "time function 0, segment 0");
    term.x1 = 1.0;
    must(dmb_model_add_time_function(model, &term, 1, NULL));
    expect_refused(model, DMB_ERR_VALUE, "3 refused parts missing", "segment_count = 0");
    must(dmb_model_clear_refused(model));
    end(model);
}

/* More refusals than are kept are counted. */
static void a_thousand_refusals(void **state)
{
    dmb_id string;
    dmb_model *model = begin(&string);
    dmb_body_def body = dmb_body_def_default();
    (void)state;
    body.mass = -1.0;
    for (int i = 0; i < 1000; i++) assert_int_equal(dmb_model_add_body(model, &body, NULL), DMB_ERR_VALUE);
    expect_refused(model, DMB_ERR_VALUE, "1000 refused parts missing", "body 0: mass = -1");
    body.mass = 1.0;
    for (int i = 0; i < 20; i++) must(dmb_model_add_body(model, &body, NULL));
    expect_refused(model, DMB_ERR_ORDER, "992 refused parts missing", "dmb_model_clear_refused");
    must(dmb_model_clear_refused(model));
    end(model);
}

static void handles(void **state)
{
    dmb_id string;
    dmb_model *model = begin(&string);
    (void)state;
    assert_int_equal(dmb_model_clear_refused(NULL), DMB_ERR_NULL);
    must(dmb_model_clear_refused(model));
    must(dmb_model_compile(model, NULL));
    assert_int_equal(dmb_model_clear_refused(model), DMB_ERR_ORDER);
    dmb_model_destroy(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(added_after_all),
        cmocka_unit_test(others_do_not_stand_in),
        cmocka_unit_test(names_tell),
        cmocka_unit_test(one_of_a_kind),
        cmocka_unit_test(time_functions_and_structs),
        cmocka_unit_test(a_thousand_refusals),
        cmocka_unit_test(handles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
