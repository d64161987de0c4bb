/* Joints that do not fit the scene: status, what the message names, and that the model goes on unharmed. */
#include "model_test.h"

static void expect_refusal(dmb_model *model, int32_t status, const char *part, const char *text)
{
    const int32_t got = dmb_model_compile(model, NULL);
    if (got != status) print_error("%s: %s\n", dmb_status_name(got), dmb_model_message(model));
    assert_int_equal(got, status);
    assert_null(model->scene);
    if (strncmp(dmb_model_message(model), part, strlen(part)) != 0 || strstr(dmb_model_message(model), text) == NULL) {
        print_error("message without \"%s\" or \"%s\": %s\n", part, text, dmb_model_message(model));
        fail();
    }
    dmb_model_destroy(&model);
}

static dmb_model *with_pipes(const dmb_pipe_def *pipe, uint32_t count, dmb_id *string)
{
    dmb_model *model = new_model();
    *string = add_pipes(model, pipe, count);
    return model;
}

static dmb_joint_def joint_between(dmb_place a, dmb_place b)
{
    dmb_joint_def joint = dmb_joint_def_default();
    joint.kind = DMB_JOINT_SPHERICAL;
    joint.place_a = a;
    joint.place_b = b;
    memcpy(joint.name, "crank", 6);
    return joint;
}

static const dmb_place ground;

static void add_joint(dmb_model *model, dmb_place a, dmb_place b)
{
    dmb_joint_def joint = joint_between(a, b);
    if (model->joints.count > 0) joint.name[0] = '\0';
    assert_ok(dmb_model_add_joint(model, &joint, NULL));
}

static void places_without_a_node(void **state)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_id string;
    dmb_model *model;
    (void)state;
    pipe.elements = 4;
    model = with_pipes(&pipe, 2, &string);
    add_joint(model, ground, dmb_station(string, 1, 0.3));
    expect_refusal(model, DMB_ERR_VALUE, "joint 0 (crank): place_b.fraction = 0.3", "a node: 0, 1 or k/elements");
    model = with_pipes(&pipe, 2, &string);
    add_joint(model, dmb_station(string, 0, 0.25 + 1e-8), dmb_station(string, 1, 0.5));
    expect_refusal(model, DMB_ERR_VALUE, "joint 0 (crank): place_a.fraction = 0.25", "a node");
    model = with_pipes(&pipe, 2, &string);
    add_joint(model, ground, dmb_station(string, 2, 0.0));
    expect_refusal(model, DMB_ERR_VALUE, "joint 0 (crank): place_b.pipe = 2", "0 .. 1");
}

static void one_rigid_body(void **state)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    const dmb_bit_def bit = dmb_bit_def_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_id string, on_end, tool;
    dmb_model *model = with_pipes(&pipe, 2, &string);
    (void)state;
    body.attach = DMB_ATTACH_END;
    assert_ok(dmb_model_add_body(model, &body, &on_end));
    assert_ok(dmb_model_add_bit(model, &bit, &tool));
    add_joint(model, dmb_station(on_end, 0, 0.0), dmb_station(tool, 0, 0.0)); /* both are fixed to one node */
    expect_refusal(model, DMB_ERR_VALUE, "joint 0 (crank): place_b = node 2 as place_a", "one rigid body");
    model = with_pipes(&pipe, 2, &string);
    add_joint(model, dmb_station(string, 0, 1.0), dmb_station(string, 1, 0.0)); /* one node by two names */
    expect_refusal(model, DMB_ERR_VALUE, "joint 0 (crank): place_b = node 1", "one rigid body");
    pipe.kind = DMB_PIPE_RIGID;
    model = with_pipes(&pipe, 2, &string);
    add_joint(model, dmb_station(string, 0, 0.0), dmb_station(string, 1, 1.0));
    expect_refusal(model, DMB_ERR_VALUE, "joint 0 (crank): place_b = node 0", "one rigid body");
}

static void no_hole(void **state)
{
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_id string;
    dmb_model *model = with_pipes(&pipe, 2, &string);
    dmb_joint_def joint = joint_between(ground, dmb_station(string, 1, 1.0));
    (void)state;
    joint.kind = DMB_JOINT_POINT_ON_HOLE;
    assert_ok(dmb_model_add_joint(model, &joint, NULL));
    expect_refusal(model, DMB_ERR_GEOMETRY, "joint 0 (crank): kind = 8", "there is no hole");
}

static int32_t nothing(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                       double *jacobian)
{
    (void)context, (void)time, (void)count, (void)poses, (void)value, (void)jacobian;
    return 0;
}

/* Axial-torsional pipes carry joints where their axis is straight. */
static void path_nodes(void **state)
{
    static const double survey[] = {0.0, 1.5, 0.0, 50.0, 1.2, 0.0};
    dmb_pipe_def pipe = dmb_pipe_def_default();
    (void)state;
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    for (int curved = 0; curved < 2; ++curved) {
        for (int callback = 0; callback < 2; ++callback) {
            dmb_id string;
            dmb_model *model = with_pipes(&pipe, 2, &string);
            dmb_wall_def wall = dmb_wall_def_default();
            dmb_constraint_def constraint = dmb_constraint_def_default();
            if (curved) wall.survey = survey;
            if (curved) wall.survey_count = 2;
            assert_ok(dmb_model_add_wall(model, &wall, NULL));
            constraint.callback = nothing;
            constraint.place[0] = dmb_station(string, 0, 1.0);
            if (callback) assert_ok(dmb_model_add_constraint(model, &constraint, NULL));
            if (!callback) add_joint(model, dmb_station(string, 0, 0.0), dmb_station(string, 1, 1.0));
            if (curved) {
                expect_refusal(model, DMB_ERR_UNSUPPORTED,
                               callback ? "constraint 0: place[0]" : "joint 0 (crank): place_a",
                               "axial-torsional in a curved hole");
                continue;
            }
            const dmb_scene *scene = compiled(model);
            assert_int_equal(scene->constraints[0].columns, callback ? 2 : 4);
            dmb_model_destroy(&model);
        }
    }
}

static void two_motions_of_a_coordinate(void **state)
{
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_id string;
    dmb_model *model = with_pipes(&pipe, 2, &string);
    dmb_joint_def joint = joint_between(ground, dmb_station(string, 1, 1.0));
    dmb_drive_def drive = dmb_drive_def_default();
    (void)state;
    joint.kind = DMB_JOINT_CYLINDRICAL;
    drive.time_function = add_constant(model, 1.0);
    assert_ok(dmb_model_add_joint(model, &joint, &drive.part));
    assert_ok(dmb_model_add_drive(model, &drive, NULL));
    drive.component = DMB_RX;
    assert_ok(dmb_model_add_drive(model, &drive, NULL)); /* another coordinate */
    drive.kind = DMB_DRIVE_LOAD;
    assert_ok(dmb_model_add_drive(model, &drive, NULL)); /* a torque beside the motion */
    drive.kind = DMB_DRIVE_MOTION;
    assert_ok(dmb_model_add_drive(model, &drive, NULL));
    expect_refusal(model, DMB_ERR_VALUE, "drive 3: component = 3", "one MOTION drive");
}

/* A chain of bodies, each joined to the next: one cluster. */
static dmb_model *chain_of_bodies(uint32_t count)
{
    dmb_model *model = new_model();
    dmb_id last = {0, 0};
    for (uint32_t i = 0; i < count; ++i) {
        dmb_body_def body = dmb_body_def_default();
        dmb_id id;
        body.position[0] = i;
        assert_ok(dmb_model_add_body(model, &body, &id));
        if (i > 0) add_joint(model, dmb_station(last, 0, 0.0), dmb_station(id, 0, 0.0));
        last = id;
    }
    return model;
}

/* Dense below six bodies; beyond 1200 coordinates there is no dense scene for analyses. */
static void kinds_of_clusters(void **state)
{
    static const uint32_t bodies[] = {2, 5, 6, 200, 201, 1000};
    (void)state;
    for (int i = 0; i < 6; ++i) {
        dmb_model *model = chain_of_bodies(bodies[i]);
        const dmb_scene *scene = compiled(model);
        assert_int_equal(scene->clusters[0].columns, 6 * bodies[i]);
        assert_int_equal(scene->clusters[0].sparse, bodies[i] >= 6);
        assert_int_equal(scene->sparse_count, bodies[i] >= 6);
        assert_int_equal(scene->dense != NULL, bodies[i] >= 6 && bodies[i] <= 200);
        assert_int_equal(scene->dense_count > 0, bodies[i] < 6);
        dmb_model_destroy(&model);
    }
}

static void too_large_a_cluster(void **state)
{
    dmb_model *model = chain_of_bodies(2);
    (void)state;
    for (int i = 0; i < 800; ++i) {
        add_joint(model, dmb_station(dmb_model_id(model, DMB_PART_BODY, 0), 0, 0.0),
                  dmb_station(dmb_model_id(model, DMB_PART_BODY, 1), 0, 0.0));
    }
    expect_refusal(model, DMB_ERR_TOO_LARGE, "cluster of joint 0 (crank): equations = 4806", "must be <= 4800");
}

/* A failed compile leaves the model: other options may do. */
static void other_options_may_do(void **state)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_id string;
    dmb_model *model = with_pipes(&pipe, 2, &string);
    dmb_compile_options options = dmb_compile_options_default();
    (void)state;
    add_joint(model, dmb_station(string, 0, 0.0), dmb_station(string, 1, 1.0));
    options.pipe_kind = DMB_PIPE_RIGID;
    assert_int_equal(dmb_model_compile(model, &options), DMB_ERR_VALUE);
    assert_ok(dmb_model_compile(model, NULL));
    dmb_model_destroy(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(places_without_a_node),
        TEST(one_rigid_body),
        TEST(no_hole),
        TEST(path_nodes),
        TEST(two_motions_of_a_coordinate),
        TEST(kinds_of_clusters),
        TEST(too_large_a_cluster),
        TEST(other_options_may_do),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
