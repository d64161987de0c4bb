/* Hard case 8: the concentric pose has no normal and no force and gives no NaN; no clearance at all is a pipe pinned to
 * the axis; a ring larger than the hole is refused with part, field, value and bound. */
#include "contact_scene.h"

static dmb_body_def ring(double diameter, int32_t free_mask)
{
    dmb_body_def body = dmb_body_def_default();
    body.mass = 2.0;
    body.contact_diameter = diameter;
    body.free_mask = free_mask;
    return body;
}

static void check_finite(const rig *scene, dmb_id id)
{
    for (int i = 0; i < 3; i++) assert_true(isfinite(scene_position(scene, id, i)));
    for (int i = 0; i < 6; i++) assert_true(isfinite(scene_speed(scene, id, i)));
    const dmb_contact contact = scene_contact(scene, 0);
    assert_true(isfinite(contact.normal_force) && isfinite(contact.gap));
    CHECK_CLOSE(contact.normal[0] * contact.normal[0] + contact.normal[1] * contact.normal[1] +
                    contact.normal[2] * contact.normal[2],
                1.0, 1e-14);
}

/* Exactly on the axis, turning and sliding: it stays there, and nothing acts on it. */
static void concentric(void **state)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_body_def body = ring(0.073, DMB_FREE_ALL);
    rig scene;
    (void)state;
    body.velocity[0] = 1.0;
    body.velocity[3] = 20.0;
    scene_open(&scene, 0.0);
    add_wall(&scene, &wall);
    const dmb_id id = add_body(&scene, &body);
    rig_start_with(&scene, NULL, NULL);
    for (int i = 0; i < 200; i++) {
        const dmb_contact contact = scene_contact(&scene, 0);
        assert_int_equal(contact.closed, 0);
        CHECK_CLOSE(contact.normal_force, 0.0, 0.0);
        CHECK_CLOSE(contact.gap, 0.0105, 1e-15);
        scene_step(&scene, 1e-3);
    }
    check_finite(&scene, id);
    CHECK_CLOSE(scene_position(&scene, id, 1), 0.0, 0.0);
    CHECK_CLOSE(scene_position(&scene, id, 2), 0.0, 0.0);
    CHECK_RELATIVE(scene_speed(&scene, id, DMB_RX), 20.0, 1e-13);
    rig_close(&scene);
}

/* From the axis it falls straight down, and comes to rest on the floor. */
static void leaves_the_axis(void **state)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_body_def body = ring(0.073, DMB_FREE_ALL);
    rig scene;
    (void)state;
    scene_open(&scene, 9.81);
    add_wall(&scene, &wall);
    const dmb_id id = add_body(&scene, &body);
    rig_start_with(&scene, NULL, NULL);
    for (int i = 0; i < 4000; i++) scene_step(&scene, 1e-3);
    check_finite(&scene, id);
    CHECK_CLOSE(scene_position(&scene, id, 1), 0.0, 1e-12);
    CHECK_RELATIVE(scene_contact(&scene, 0).gap, -2.0 * 9.81 / 1e7, 1e-3);
    rig_close(&scene);
}

/* Oscillating through the axis, the normal turns over at once; the path stays straight. */
static void through_the_axis(void **state)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_body_def body = ring(0.073, DMB_FREE_X | DMB_FREE_Y | DMB_FREE_Z);
    rig scene;
    (void)state;
    wall.restitution = 1.0;
    wall.friction_law = DMB_FRICTION_NONE;
    body.velocity[1] = 0.3;
    body.velocity[2] = 0.4;
    scene_open(&scene, 0.0);
    add_wall(&scene, &wall);
    const dmb_id id = add_body(&scene, &body);
    rig_start_with(&scene, NULL, NULL);
    for (int i = 0; i < 20000; i++) scene_step(&scene, 1e-5);
    check_finite(&scene, id);
    CHECK_CLOSE(4.0 * scene_position(&scene, id, 1) - 3.0 * scene_position(&scene, id, 2), 0.0, 1e-12);
    CHECK_RELATIVE(hypot(scene_speed(&scene, id, 1), scene_speed(&scene, id, 2)), 0.5, 1e-3);
    rig_close(&scene);
}

/* Hole and ring of one diameter: a pipe pinned to the axis by K in every direction. It sinks by m g/K, and swings with
 * sqrt(K/m) however it was pushed. */
static void pinned(void **state)
{
    static const double push[3][2] = {{0.1, 0.0}, {0.0, 0.1}, {0.06, -0.08}};
    (void)state;
    for (int k = 0; k < 3; k++) {
        dmb_wall_def wall = dmb_wall_def_default();
        dmb_body_def body = ring(0.094, DMB_FREE_X | DMB_FREE_Y | DMB_FREE_Z);
        rig scene;
        const double w = sqrt(1e7 / 2.0), quarter = 0.5 * PI / w;
        wall.restitution = 1.0;
        wall.friction_law = DMB_FRICTION_NONE;
        body.velocity[1] = push[k][0];
        body.velocity[2] = push[k][1];
        scene_open(&scene, 0.0);
        add_wall(&scene, &wall);
        const dmb_id id = add_body(&scene, &body);
        rig_start_with(&scene, NULL, NULL);
        for (int i = 0; i < 500; i++) scene_step(&scene, quarter / 500.0);
        CHECK_RELATIVE(hypot(scene_position(&scene, id, 1), scene_position(&scene, id, 2)), 0.1 / w, 1e-4);
        for (int i = 0; i < 500; i++) scene_step(&scene, quarter / 500.0);
        CHECK_CLOSE(scene_speed(&scene, id, 1), -push[k][0], 1e-4 * 0.1);
        CHECK_CLOSE(scene_speed(&scene, id, 2), -push[k][1], 1e-4 * 0.1);
        check_finite(&scene, id);
        rig_close(&scene);
    }
}

static void pinned_under_weight(void **state)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_body_def body = ring(0.094, DMB_FREE_X | DMB_FREE_Y | DMB_FREE_Z);
    rig scene;
    (void)state;
    wall.normal_law = DMB_NORMAL_KELVIN_VOIGT;
    wall.damping = 4e3;
    scene_open(&scene, 9.81);
    add_wall(&scene, &wall);
    const dmb_id id = add_body(&scene, &body);
    rig_start_with(&scene, NULL, NULL);
    for (int i = 0; i < 500; i++) scene_step(&scene, 1e-4);
    CHECK_RELATIVE(scene_position(&scene, id, 2), -2.0 * 9.81 / 1e7, 1e-6);
    CHECK_RELATIVE(scene_contact(&scene, 0).normal_force, 2.0 * 9.81, 1e-6);
    rig_close(&scene);
}

/* A whole pinned string in statics: the weight goes into the wall node by node. */
static void pinned_string(void **state)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_contact_total sum = dmb_contact_total_default();
    dmb_static_report report = dmb_static_report_default();
    rig scene;
    (void)state;
    wall.diameter = pipe.outer_diameter;
    scene_open(&scene, 9.81);
    add_wall(&scene, &wall);
    add_pipes(&scene, &pipe, 20);
    rig_start_with(&scene, NULL, NULL);
    scene_must(&scene, dmb_analysis_static(scene.sim, NULL, &report));
    assert_int_equal(dmb_query_contact_total(scene.sim, &sum), DMB_OK);
    const double weight = scene_info(&scene).mass * 9.81;
    print_message("pinned string: %u iterations, %.6f of the weight on the wall\n", report.iterations,
                  sum.normal_force / weight);
    CHECK_CLOSE(sum.normal_force / weight, 1.0, 0.05); /* the support of the rig end takes the rest, half a pipe */
    CHECK_BELOW(report.iterations, 20);
    for (int i = 0; i < 100; i++) scene_step(&scene, 1e-3);
    CHECK_BELOW(energy_of(&scene).kinetic, 1e-12);
    rig_close(&scene);
}

/* ---- Refusals ---------------------------------------------------------------------------------------------------- */

static void refuse(rig *scene, const char *part, const char *field, const char *value)
{
    assert_int_equal(dmb_model_compile(scene->model, NULL), DMB_ERR_GEOMETRY);
    const char *text = dmb_model_message(scene->model);
    print_message("%s\n", text);
    assert_non_null(strstr(text, part));
    assert_non_null(strstr(text, field));
    assert_non_null(strstr(text, value));
    assert_non_null(strstr(text, "0.094"));
    rig_close(scene);
}

static void negative_clearance(void **state)
{
    const dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    const dmb_body_def body = ring(0.095, DMB_FREE_ALL);
    rig scene;
    (void)state;
    scene_open(&scene, 9.81);
    add_wall(&scene, &wall);
    add_body(&scene, &body);
    refuse(&scene, "body 0", "contact_diameter", "0.095");
    scene_open(&scene, 9.81);
    add_wall(&scene, &wall);
    pipe.outer_diameter = 0.0945;
    add_pipes(&scene, &pipe, 2);
    refuse(&scene, "string 0", "outer_diameter", "0.0945");
    scene_open(&scene, 9.81);
    add_wall(&scene, &wall);
    pipe.outer_diameter = 0.073;
    pipe.joint_length = 0.1;
    pipe.joint_outer_diameter = 0.0975;
    add_pipes(&scene, &pipe, 2);
    refuse(&scene, "string 0", "joint_outer_diameter", "0.0975");
    scene_open(&scene, 9.81);
    add_wall(&scene, &wall);
    pipe.joint_outer_diameter = 0.08;
    add_pipes(&scene, &pipe, 2);
    bit.diameter = 0.1;
    scene_add_bit(&scene, &bit);
    refuse(&scene, "bit 0", "diameter", "0.1");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(concentric),          cmocka_unit_test(leaves_the_axis),
        cmocka_unit_test(through_the_axis),    cmocka_unit_test(pinned),
        cmocka_unit_test(pinned_under_weight), cmocka_unit_test(pinned_string),
        cmocka_unit_test(negative_clearance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
