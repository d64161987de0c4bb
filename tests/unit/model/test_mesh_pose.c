/* Poses and speeds at time 0 against closed forms: straight and bent strings, and those that follow a hole. */
#include "model_test.h"

#include "element/beam.h"
#include "math/so3.h"

static const double *position(const dmb_scene *scene, uint32_t node)
{
    return scene->reference_position + 3 * node;
}

static const double *quaternion(const dmb_scene *scene, uint32_t node)
{
    return scene->reference_quaternion + 4 * node;
}

static void strain_of(const dmb_scene *scene, uint32_t e, double d[6])
{
    const uint32_t a = scene->element_node[e];
    double R[9];
    dmb_beam_shape shape;
    dmb_quat_to_matrix(quaternion(scene, a), R);
    assert_int_equal(dmb_beam_deform(&scene->types[scene->element_type[e]], quaternion(scene, a), R,
                                     quaternion(scene, a + 1), scene->element_span + 3 * e, &shape),
                     0);
    memcpy(d, shape.d, sizeof shape.d);
}

static dmb_model *free_string(const double rotation[3], const dmb_pipe_def *pipe, uint32_t count)
{
    dmb_model *model = new_model();
    dmb_string_def string = dmb_string_def_default();
    string.follows_hole = 0;
    dmb_vec3_set(1.0, 2.0, 3.0, string.position);
    dmb_vec3_copy(rotation, string.rotation);
    dmb_vec3_set(0.5, -1.0, 2.0, string.velocity);
    dmb_vec3_set(3.0, 0.25, -0.5, string.velocity + 3);
    string.start_free = DMB_FREE_ALL;
    assert_ok(dmb_model_add_string(model, &string, NULL));
    add_pipes(model, pipe, count);
    return model;
}

/* Spans are direction times length to the last digit: 0.7 is not a binary fraction, 500 of them are far away. */
static void straight_string_has_exact_spans(void **state)
{
    dmb_pipe_def pipe = s1_pipe();
    const double rotation[3] = {0.0, 0.0, 0.5 * DMB_PI};
    dmb_model *model;
    const dmb_scene *scene;
    double d[6];
    (void)state;
    pipe.length = 0.7;
    model = free_string(rotation, &pipe, 500);
    scene = compiled(model);
    for (uint32_t e = 0; e < 500; ++e) {
        strain_of(scene, e, d);
        assert_close(d[0] - 0.7, 0.0, 2e-16);
        for (int i = 1; i < 6; ++i) assert_close(d[i], 0.0, 1e-16);
    }
    assert_close(position(scene, 500)[0], 1.0, 1e-12);
    assert_near(position(scene, 500)[1], 352.0, 1e-15);
    assert_near(position(scene, 500)[2], 3.0, 1e-15);
    assert_near(scene->reference_depth[500], 0.0, 0.0);
    dmb_model_destroy(&model);
}

/* v_P = v_0 + w x r in the world; the body frame of every node is that of the rig end here. */
static void velocity_is_that_of_a_rigid_body(void **state)
{
    dmb_pipe_def pipe = s1_pipe();
    const double rotation[3] = {0.3, -0.4, 0.5};
    dmb_model *model = free_string(rotation, &pipe, 10);
    const dmb_scene *scene = compiled(model);
    (void)state;
    for (uint32_t i = 0; i <= 10; ++i) {
        const double *v = scene->initial_velocity + 6 * i, x = 1.5 * i;
        assert_near(v[0], 0.5, 1e-14);
        assert_near(v[1], -1.0 + x * -0.5, 1e-13);
        assert_near(v[2], 2.0 - x * 0.25, 1e-13);
        assert_near(v[3], 3.0, 1e-15);
        assert_near(v[4], 0.25, 1e-15);
        assert_near(v[5], -0.5, 1e-15);
    }
    dmb_model_destroy(&model);
}

/* A rigid start has its node ahead of the rig end. */
static void velocity_of_a_rigid_start(void **state)
{
    dmb_pipe_def pipe = s1_pipe();
    const double rotation[3] = {0.0, 0.0, 0.0};
    dmb_model *model;
    const dmb_scene *scene;
    (void)state;
    pipe.kind = DMB_PIPE_RIGID;
    model = free_string(rotation, &pipe, 2);
    pipe.kind = DMB_PIPE_FLEXIBLE;
    add_pipes(model, &pipe, 1);
    scene = compiled(model);
    assert_near(position(scene, 0)[0], 4.0, 1e-15);
    assert_near(scene->initial_velocity[1], -1.0 - 3.0 * 0.5, 1e-15);
    assert_near(scene->initial_velocity[2], 2.0 - 3.0 * 0.25, 1e-15);
    dmb_model_destroy(&model);
}

/* A quarter circle of unstressed curvature about y ends at (R, 0, -R); every element is at rest. */
static void curved_string_is_at_rest(void **state)
{
    dmb_pipe_def pipe = s1_pipe();
    const double rotation[3] = {0.0, 0.0, 0.0};
    const double R = 10.0;
    dmb_model *model;
    const dmb_scene *scene;
    double d[6];
    (void)state;
    pipe.length = 0.5 * DMB_PI * R / 8.0;
    pipe.curvature[1] = 1.0 / R;
    model = free_string(rotation, &pipe, 8);
    scene = compiled(model);
    for (uint32_t e = 0; e < 8; ++e) {
        strain_of(scene, e, d);
        for (int i = 0; i < 6; ++i) assert_close(d[i], scene->types[0].rest[i], 1e-15);
    }
    assert_near(position(scene, 8)[0], 1.0 + R, 1e-14);
    assert_near(position(scene, 8)[2], 3.0 - R, 1e-14);
    dmb_model_destroy(&model);
}

/* Arms are straight and between the bent parts. */
static void curved_string_with_joints(void **state)
{
    dmb_pipe_def pipe = s1_pipe();
    const double rotation[3] = {0.2, 0.1, -0.3};
    dmb_model *model;
    const dmb_scene *scene;
    (void)state;
    pipe.joint_length = 0.5;
    pipe.elements = 2;
    pipe.curvature[2] = 0.2;
    model = free_string(rotation, &pipe, 3);
    scene = compiled(model);
    for (uint32_t e = 0; e < 6; ++e) { /* take the arms off: the rest is exp(d0) */
        const uint32_t a = scene->element_node[e];
        const dmb_element_type *type = &scene->types[scene->element_type[e]];
        double far_arm[3] = {type->arm[1], 0.0, 0.0}, x[3], q[4], d[6];
        dmb_quat_rotate(quaternion(scene, a + 1), far_arm, far_arm);
        dmb_vec3_sub(scene->element_span + 3 * e, far_arm, x);
        dmb_quat_rotate_inverse(quaternion(scene, a), x, x);
        dmb_quat_between(quaternion(scene, a), quaternion(scene, a + 1), q);
        dmb_se3_log_from_quat(q, x, NULL, d);
        for (int i = 0; i < 6; ++i) assert_close(d[i], type->rest[i], 1e-15);
    }
    dmb_model_destroy(&model);
}

/* Behind two rigid pipes, with the node at either end of them, the bent pipes begin 3 m from the rig end. */
static void curved_string_behind_rigid_pipes(void **state)
{
    static const int32_t masks[] = {DMB_FREE_ALL, DMB_FREE_SPHERICAL};
    double end[2][3];
    (void)state;
    for (int i = 0; i < 2; ++i) {
        dmb_model *model = new_model();
        dmb_string_def string = dmb_string_def_default();
        dmb_pipe_def pipe = s1_pipe();
        const dmb_scene *scene;
        string.start_free = masks[i];
        assert_ok(dmb_model_add_string(model, &string, NULL));
        pipe.kind = DMB_PIPE_RIGID;
        add_pipes(model, &pipe, 2);
        pipe.kind = DMB_PIPE_FLEXIBLE;
        pipe.curvature[2] = 0.1;
        add_pipes(model, &pipe, 4);
        scene = compiled(model);
        assert_close(position(scene, 0)[0], i == 0 ? 3.0 : 0.0, 0.0);
        memcpy(end[i], position(scene, 4), sizeof end[i]);
        assert_near(scene->element_span[0], (i == 0 ? 0.0 : 3.0) + sin(0.15) / 0.1, 1e-14);
        dmb_model_destroy(&model);
    }
    assert_near(end[0][0], 3.0 + sin(0.6) / 0.1, 1e-14);
    assert_near(end[0][1], (1.0 - cos(0.6)) / 0.1, 1e-14);
    for (int k = 0; k < 3; ++k) assert_close(end[0][k], end[1][k], 1e-14);
}

static const double survey_3d[] = {
    /* a build and a turn at the same time */
    0.0, 0.2, 0.0, 30.0, 0.5, 0.6, 60.0, 1.0, 1.2, 100.0, 1.5, 1.2,
};

static dmb_model *curved_hole(const double *survey, uint32_t stations)
{
    dmb_model *model = new_model();
    dmb_wall_def wall = dmb_wall_def_default();
    wall.survey = survey;
    wall.survey_count = stations;
    dmb_vec3_set(100.0, 200.0, -300.0, wall.origin);
    assert_ok(dmb_model_add_wall(model, &wall, NULL));
    return model;
}

static void string_follows_a_curved_hole(void **state)
{
    dmb_model *model = curved_hole(survey_3d, 4);
    dmb_string_def string = dmb_string_def_default();
    const dmb_pipe_def pipe = s1_pipe();
    const dmb_scene *scene;
    double d[6], x[3], t[3], axis[3], turn = 0.0;
    const double ex[3] = {1.0, 0.0, 0.0};
    (void)state;
    string.start_depth = 2.0;
    assert_ok(dmb_model_add_string(model, &string, NULL));
    add_pipes(model, &pipe, 60);
    scene = compiled(model);
    assert_int_equal(scene->hole.stations, 4);
    for (uint32_t i = 0; i <= 60; ++i) {
        dmb_hole_frame(&scene->hole, 2.0 + 1.5 * i, x, t, NULL);
        assert_near(scene->reference_depth[i], 2.0 + 1.5 * i, 1e-15);
        dmb_quat_rotate(quaternion(scene, i), ex, axis);
        for (int k = 0; k < 3; ++k) {
            assert_close(position(scene, i)[k], x[k], 0.0);
            assert_close(axis[k], t[k], 1e-13);
        }
    }
    for (uint32_t e = 0; e < 60; ++e) { /* no twist; shorter than the arc by less than its bend */
        strain_of(scene, e, d);
        assert_close(d[3], 0.0, 1e-13);
        assert_true(d[0] < 1.5 + 1e-13 && d[0] > 1.4999);
        turn += d[4] * d[4] + d[5] * d[5];
    }
    assert_true(turn > 0.01);
    dmb_model_destroy(&model);
}

/* In a vertical plane the frame stays the hole's own, y horizontal. */
static void planar_hole_keeps_the_hole_frame(void **state)
{
    static const double survey[] = {0.0, 0.0, 0.4, 50.0, 1.5, 0.4, 80.0, 1.5, 0.4};
    dmb_model *model = curved_hole(survey, 3);
    dmb_string_def string = dmb_string_def_default();
    const dmb_pipe_def pipe = s1_pipe();
    const dmb_scene *scene;
    double R[9], Rq[9];
    (void)state;
    string.start_depth = 5.0; /* not at the vertical start, where the hole has no horizontal of its own */
    assert_ok(dmb_model_add_string(model, &string, NULL));
    add_pipes(model, &pipe, 50);
    scene = compiled(model);
    for (uint32_t i = 0; i <= 50; ++i) {
        dmb_hole_frame_rotation(&scene->hole, scene->reference_depth[i], R);
        dmb_quat_to_matrix(quaternion(scene, i), Rq);
        for (int k = 0; k < 9; ++k) assert_close(R[k], Rq[k], 1e-12);
    }
    for (uint32_t e = 40; e < 50; ++e) { /* the straight part: exact lengths, though the coordinates are large */
        double d[6];
        strain_of(scene, e, d);
        assert_close(d[0] - 1.5, 0.0, 5e-16);
        for (int i = 1; i < 6; ++i) assert_close(d[i], 0.0, 1e-15);
    }
    dmb_model_destroy(&model);
}

static void offset_is_along_the_hole_frame(void **state)
{
    dmb_model *model = new_model();
    dmb_string_def string = dmb_string_def_default();
    const dmb_pipe_def pipe = s1_pipe();
    const dmb_scene *scene;
    (void)state;
    add_wall(model);
    string.start_depth = 3.0;
    string.offset[0] = 0.002;
    string.offset[1] = -0.01;
    assert_ok(dmb_model_add_string(model, &string, NULL));
    add_pipes(model, &pipe, 3);
    scene = compiled(model);
    for (uint32_t i = 0; i < 4; ++i) {
        assert_near(position(scene, i)[0], 3.0 + 1.5 * i, 1e-15);
        assert_near(position(scene, i)[1], 0.002, 1e-15);
        assert_near(position(scene, i)[2], -0.01, 1e-15);
        assert_near(scene->reference_depth[i], 3.0 + 1.5 * i, 1e-15);
    }
    dmb_model_destroy(&model);
}

/* PATH nodes have the frame that the axis of the hole carries along without twist, and slide as the rig end does. */
static void path_nodes_in_a_curved_hole(void **state)
{
    dmb_model *model = curved_hole(survey_3d, 4);
    dmb_string_def string = dmb_string_def_default();
    const dmb_pipe_def pipe = s1_pipe();
    const dmb_scene *scene;
    double R[9], Rq[9];
    (void)state;
    string.velocity[0] = 0.25;
    string.velocity[3] = 20.0;
    assert_ok(dmb_model_add_string(model, &string, NULL));
    add_pipes(model, &pipe, 40);
    scene = compiled_with(model, DMB_FEATURE_ALL, DMB_PIPE_AXIAL_TORSIONAL);
    for (uint32_t i = 0; i <= 40; ++i) {
        dmb_hole_carried_rotation(&scene->hole, scene->reference_depth[i], R);
        dmb_quat_to_matrix(quaternion(scene, i), Rq);
        for (int k = 0; k < 9; ++k) assert_close(R[k], Rq[k], 1e-14);
        assert_near(scene->initial_velocity[2 * i], 0.25, 0.0);
        assert_near(scene->initial_velocity[2 * i + 1], 20.0, 0.0);
    }
    dmb_model_destroy(&model);
}

/* A string that does not follow the hole still has its depth, for the wall to be found. */
static void depth_of_what_does_not_follow(void **state)
{
    dmb_model *model = new_model();
    dmb_string_def string = dmb_string_def_default();
    dmb_body_def body = dmb_body_def_default();
    const dmb_pipe_def pipe = s1_pipe();
    const dmb_scene *scene;
    (void)state;
    add_wall(model);
    string.follows_hole = 0;
    string.position[0] = 7.0;
    string.position[1] = 0.005;
    assert_ok(dmb_model_add_string(model, &string, NULL));
    add_pipes(model, &pipe, 2);
    body.position[0] = -4.0;
    body.position[2] = 0.01;
    body.rotation[2] = 0.1;
    assert_ok(dmb_model_add_body(model, &body, NULL));
    scene = compiled(model);
    assert_near(scene->reference_depth[2], 10.0, 1e-15);
    assert_near(scene->reference_depth[3], -4.0, 1e-15);
    assert_near(quaternion(scene, 3)[3], sin(0.05), 1e-15);
    dmb_model_destroy(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(straight_string_has_exact_spans), TEST(velocity_is_that_of_a_rigid_body),
        TEST(velocity_of_a_rigid_start),       TEST(curved_string_is_at_rest),
        TEST(curved_string_with_joints),       TEST(curved_string_behind_rigid_pipes),
        TEST(string_follows_a_curved_hole),    TEST(planar_hole_keeps_the_hole_frame),
        TEST(offset_is_along_the_hole_frame),  TEST(path_nodes_in_a_curved_hole),
        TEST(depth_of_what_does_not_follow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
