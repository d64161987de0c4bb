/* Scenes that do not fit together: the status, what the message names, and that the model goes on unharmed. */
#include "model_test.h"

static void expect_refusal(dmb_model *model, int32_t status, const char *part, const char *field)
{
    const int32_t got = dmb_model_compile(model, NULL);
    if (got != status) print_error("%s: %s\n", dmb_status_name(got), dmb_model_message(model));
    assert_int_equal(got, status);
    assert_null(model->scene);
    if (strstr(dmb_model_message(model), part) == NULL || strstr(dmb_model_message(model), field) == NULL) {
        print_error("message without \"%s\" or \"%s\": %s\n", part, field, dmb_model_message(model));
        fail();
    }
    dmb_model_destroy(&model);
}

static dmb_model *with_pipes(uint32_t count)
{
    dmb_model *model = new_model();
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    add_pipes(model, &pipe, count);
    return model;
}

static void nothing_described(void **state)
{
    (void)state;
    expect_refusal(new_model(), DMB_ERR_VALUE, "model", "strings + bodies");
}

static void string_without_pipes(void **state)
{
    dmb_model *model = with_pipes(1);
    const dmb_string_def string = dmb_string_def_default();
    (void)state;
    assert_ok(dmb_model_add_string(model, &string, NULL));
    expect_refusal(model, DMB_ERR_VALUE, "string 1", "pipes");
}

static void no_string_to_belong_to(void **state)
{
    const dmb_bit_def bit = dmb_bit_def_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_model *model = new_model();
    (void)state;
    assert_ok(dmb_model_add_body(model, &body, NULL));
    assert_ok(dmb_model_add_bit(model, &bit, NULL));
    expect_refusal(model, DMB_ERR_ID, "bit 0", "first string");
    model = new_model();
    body.attach = DMB_ATTACH_END;
    assert_ok(dmb_model_add_body(model, &body, NULL));
    expect_refusal(model, DMB_ERR_ID, "body 0", "first string");
    model = new_model();
    body.attach = DMB_ATTACH_NONE;
    assert_ok(dmb_model_add_body(model, &body, NULL));
    drive.time_function = add_constant(model, 1.0);
    assert_ok(dmb_model_add_drive(model, &drive, NULL));
    expect_refusal(model, DMB_ERR_ID, "drive 0", "first string");
}

static void two_bits_on_a_string(void **state)
{
    dmb_model *model = with_pipes(1);
    const dmb_bit_def bit = dmb_bit_def_default();
    (void)state;
    assert_ok(dmb_model_add_bit(model, &bit, NULL));
    assert_ok(dmb_model_add_bit(model, &bit, NULL));
    expect_refusal(model, DMB_ERR_GEOMETRY, "bit 1", "bit 0");
}

static void larger_than_the_hole(void **state)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_model *model = with_pipes(1);
    (void)state;
    add_wall(model);
    pipe.outer_diameter = 0.0941;
    add_pipes(model, &pipe, 1);
    expect_refusal(model, DMB_ERR_GEOMETRY, "pipes of string 0: outer_diameter = 0.0941", "0.094");
    model = with_pipes(1);
    add_wall(model);
    pipe = dmb_pipe_def_default();
    pipe.joint_length = 0.1;
    pipe.joint_outer_diameter = 0.1;
    add_pipes(model, &pipe, 1);
    expect_refusal(model, DMB_ERR_GEOMETRY, "pipes of string 0", "joint_outer_diameter");
    model = with_pipes(1);
    add_wall(model);
    bit.diameter = 0.095;
    assert_ok(dmb_model_add_bit(model, &bit, NULL));
    expect_refusal(model, DMB_ERR_GEOMETRY, "bit 0", "diameter");
    model = with_pipes(1);
    add_wall(model);
    body.contact_diameter = 0.2;
    assert_ok(dmb_model_add_body(model, &body, NULL));
    expect_refusal(model, DMB_ERR_GEOMETRY, "body 0", "contact_diameter");
}

/* A pipe that just fits is held on the axis; one in a hole without a wall law may be of any size. */
static void just_fits(void **state)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_model *model = new_model();
    (void)state;
    add_wall(model);
    pipe.outer_diameter = 0.094;
    add_pipes(model, &pipe, 2);
    assert_near(compiled(model)->sites[0].clearance, 0.0, 0.0);
    dmb_model_destroy(&model);
    model = new_model();
    wall.normal_law = DMB_NORMAL_NONE;
    assert_ok(dmb_model_add_wall(model, &wall, NULL));
    pipe.outer_diameter = 0.2;
    add_pipes(model, &pipe, 2);
    assert_int_equal(compiled(model)->site_count, 0);
    assert_int_equal(model->scene->has_hole, 1);
    dmb_model_destroy(&model);
}

static void hole_that_turns_back(void **state)
{
    static const double survey[] = {0.0, 0.1, 0.0, 10.0, 0.2, 0.0, 20.0, 3.1, 0.0};
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_model *model = with_pipes(1);
    (void)state;
    wall.survey = survey;
    wall.survey_count = 3;
    assert_ok(dmb_model_add_wall(model, &wall, NULL));
    expect_refusal(model, DMB_ERR_GEOMETRY, "station 2", "inclination 3.1");
}

static void curved_pipes_that_cannot_be(void **state)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_model *model = new_model();
    dmb_compile_options options = dmb_compile_options_default();
    (void)state;
    pipe.curvature[2] = 0.1;
    pipe.kind = DMB_PIPE_RIGID;
    add_pipes(model, &pipe, 1);
    expect_refusal(model, DMB_ERR_UNSUPPORTED, "pipes of string 0", "curvature");
    model = new_model();
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    add_pipes(model, &pipe, 1);
    expect_refusal(model, DMB_ERR_UNSUPPORTED, "pipes of string 0", "axial-torsional");
    model = new_model(); /* a failed compile leaves the model: other options may do */
    pipe.kind = DMB_PIPE_FLEXIBLE;
    add_pipes(model, &pipe, 1);
    options.pipe_kind = DMB_PIPE_RIGID;
    assert_int_equal(dmb_model_compile(model, &options), DMB_ERR_UNSUPPORTED);
    assert_ok(dmb_model_compile(model, NULL));
    dmb_model_destroy(&model);
}

static void axial_torsional_off_its_axis(void **state)
{
    static const double survey[] = {0.0, 1.5, 0.0, 50.0, 1.2, 0.0};
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    (void)state;
    wall.survey = survey;
    wall.survey_count = 2;
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    for (int i = 0; i < 3; ++i) {
        dmb_model *model = new_model();
        dmb_string_def string = dmb_string_def_default();
        string.follows_hole = i != 0;
        string.offset[0] = i == 1 ? 1e-3 : 0.0;
        assert_ok(dmb_model_add_wall(model, &wall, NULL));
        assert_ok(dmb_model_add_string(model, &string, NULL));
        add_pipes(model, &pipe, 3);
        if (i < 2) {
            expect_refusal(model, DMB_ERR_GEOMETRY, "pipes of string 0", i == 0 ? "follows_hole" : "offset");
        } else {
            (void)compiled(model);
            dmb_model_destroy(&model);
        }
    }
}

static void drives_that_do_not_fit(void **state)
{
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_model *model = with_pipes(1);
    (void)state;
    drive.time_function = add_constant(model, 1.0);
    drive.component = DMB_Y;
    assert_ok(dmb_model_add_drive(model, &drive, NULL));
    expect_refusal(model, DMB_ERR_VALUE, "drive 0", "component = 1");
    model = with_pipes(1);
    drive.time_function = add_constant(model, 1.0);
    drive.component = DMB_RX;
    assert_ok(dmb_model_add_drive(model, &drive, NULL));
    assert_ok(dmb_model_add_drive(model, &drive, NULL));
    expect_refusal(model, DMB_ERR_VALUE, "drive 1", "one MOTION drive");
    model = with_pipes(1); /* a force beside the motion is fine */
    drive.time_function = add_constant(model, 1.0);
    assert_ok(dmb_model_add_drive(model, &drive, NULL));
    drive.kind = DMB_DRIVE_LOAD;
    assert_ok(dmb_model_add_drive(model, &drive, NULL));
    (void)compiled(model);
    dmb_model_destroy(&model);
    model = with_pipes(1);
    body.attach = DMB_ATTACH_END;
    drive.time_function = add_constant(model, 1.0);
    assert_ok(dmb_model_add_body(model, &body, &drive.part));
    assert_int_equal(dmb_model_add_drive(model, &drive, NULL), DMB_ERR_UNSUPPORTED);
    assert_non_null(strstr(dmb_model_message(model), "body 0"));
    dmb_model_destroy(&model);
}

static void drive_sideways_on_a_path_node(void **state)
{
    dmb_model *model = new_model();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    (void)state;
    string.start_free = DMB_FREE_ALL;
    assert_ok(dmb_model_add_string(model, &string, NULL));
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    add_pipes(model, &pipe, 1);
    drive.time_function = add_constant(model, 1.0);
    drive.component = DMB_Z;
    assert_ok(dmb_model_add_drive(model, &drive, NULL));
    expect_refusal(model, DMB_ERR_VALUE, "drive 0", "component = 2");
}

static void loads_that_do_not_fit(void **state)
{
    dmb_load_def load = dmb_load_def_default();
    dmb_model *model = with_pipes(3);
    (void)state;
    load.place = dmb_station(dmb_model_id(model, DMB_PART_STRING, 0), 3, 0.0);
    assert_ok(dmb_model_add_load(model, &load, NULL));
    expect_refusal(model, DMB_ERR_VALUE, "load 0", "place.pipe = 3");
    model = with_pipes(3);
    load.place = dmb_station(dmb_model_id(model, DMB_PART_STRING, 0), 2, 1.0);
    load.frame = DMB_FRAME_HOLE;
    assert_ok(dmb_model_add_load(model, &load, NULL));
    expect_refusal(model, DMB_ERR_GEOMETRY, "load 0", "frame");
}

static void rigid_string_held_at_both_ends(void **state)
{
    dmb_model *model = new_model();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    (void)state;
    string.start_free = string.end_free = DMB_FREE_SPHERICAL;
    assert_ok(dmb_model_add_string(model, &string, NULL));
    pipe.kind = DMB_PIPE_RIGID;
    add_pipes(model, &pipe, 2);
    expect_refusal(model, DMB_ERR_UNSUPPORTED, "string 0", "start_free");
}

static void too_many_nodes(void **state)
{
    dmb_model *model = new_model();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    (void)state;
    pipe.elements = 1024;
    add_pipes(model, &pipe, 1u << 20);
    expect_refusal(model, DMB_ERR_TOO_LARGE, "model", "nodes");
}

/* Spherical joints between bodies, told to be solved by dense matrices, however many: 201 bodies have 1206 coordinates.
 */
static void too_large_a_cluster(void **state)
{
    dmb_model *model = new_model();
    dmb_id last = {0, 0};
    (void)state;
    model->sparse_nodes = UINT32_MAX;
    for (uint32_t i = 0; i < 201; i++) {
        dmb_body_def body = dmb_body_def_default();
        dmb_joint_def joint = dmb_joint_def_default();
        dmb_id id = {0, 0};
        body.position[0] = i;
        assert_ok(dmb_model_add_body(model, &body, &id));
        joint.kind = DMB_JOINT_SPHERICAL;
        joint.place_a = dmb_station(last, 0, 0.0);
        joint.place_b = dmb_station(id, 0, 0.0);
        joint.match = 1;
        assert_ok(dmb_model_add_joint(model, &joint, NULL));
        last = id;
    }
    expect_refusal(model, DMB_ERR_TOO_LARGE, "coordinates = 1206", "must be <= 1200");
}

static void wrong_options(void **state)
{
    dmb_model *model = with_pipes(1);
    dmb_compile_options options = dmb_compile_options_default();
    (void)state;
    options.features = 128;
    assert_int_equal(dmb_model_compile(model, &options), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_model_message(model), "features"));
    options.features = DMB_FEATURE_ALL;
    options.pipe_kind = 3;
    assert_int_equal(dmb_model_compile(model, &options), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_model_message(model), "pipe_kind"));
    options.struct_size = 4;
    assert_int_equal(dmb_model_compile(model, &options), DMB_ERR_STRUCT_SIZE);
    assert_true(strlen(dmb_model_message(model)) > 0);
    (void)compiled(model);
    dmb_model_destroy(&model);
}

/* Closed under motion, or refused when described. */
static void masks(void **state)
{
    static const int32_t closed[] = {0,          1,          2,     4,      8,      16,    32,    9,
                                     18,         36,         56,    7,      1 | 2,  1 | 4, 2 | 4, 2 | 4 | 8,
                                     1 | 4 | 16, 1 | 2 | 32, 7 | 8, 7 | 16, 7 | 32, 63};
    int found = 0;
    (void)state;
    for (int32_t mask = 0; mask < 64; ++mask) {
        dmb_model *model = new_model();
        dmb_string_def string = dmb_string_def_default();
        bool expected = false;
        for (size_t i = 0; i < sizeof closed / sizeof closed[0]; ++i) expected = expected || closed[i] == mask;
        string.end_free = DMB_FREE_NONE | DMB_FREE_X * mask;
        assert_int_equal(dmb_model_add_string(model, &string, NULL), expected ? DMB_OK : DMB_ERR_UNSUPPORTED);
        found += expected;
        dmb_model_destroy(&model);
    }
    assert_int_equal(found, 22);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(nothing_described),
        TEST(string_without_pipes),
        TEST(no_string_to_belong_to),
        TEST(two_bits_on_a_string),
        TEST(larger_than_the_hole),
        TEST(just_fits),
        TEST(hole_that_turns_back),
        TEST(curved_pipes_that_cannot_be),
        TEST(axial_torsional_off_its_axis),
        TEST(drives_that_do_not_fit),
        TEST(drive_sideways_on_a_path_node),
        TEST(loads_that_do_not_fit),
        TEST(rigid_string_held_at_both_ends),
        TEST(too_large_a_cluster),
        TEST(too_many_nodes),
        TEST(wrong_options),
        TEST(masks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
