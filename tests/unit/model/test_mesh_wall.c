/* Contact sites against the drawing: where they are, for how many metres of wall they stand, where there are none. */
#include "model_test.h"

static double sum_of_lengths(const dmb_scene *scene)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < scene->site_count; ++i) sum += scene->sites[i].length;
    return sum;
}

static dmb_model *free_start(void)
{
    dmb_model *model = new_model();
    dmb_string_def string = dmb_string_def_default();
    add_wall(model);
    string.start_free = DMB_FREE_ALL;
    assert_ok(dmb_model_add_string(model, &string, NULL));
    return model;
}

/* Contact per metre does not depend on the mesh: the lengths add up to that of the string. */
static void lengths_add_up(void **state)
{
    (void)state;
    for (uint32_t kinds = 0; kinds < 8; ++kinds) {
        dmb_model *model = free_start();
        dmb_pipe_def pipe = s1_pipe();
        const dmb_scene *scene;
        for (uint32_t run = 0; run < 3; ++run) {
            pipe.kind = kinds >> run & 1 ? DMB_PIPE_RIGID : DMB_PIPE_FLEXIBLE;
            pipe.elements = run + 1;
            pipe.joint_length = 0.2 * run;
            add_pipes(model, &pipe, 2);
        }
        scene = compiled(model);
        assert_near(sum_of_lengths(scene), 9.0, 1e-14);
        for (uint32_t i = 0; i < scene->site_count; ++i) {
            assert_near(scene->sites[i].clearance, 0.0105, 1e-13);
            assert_int_equal(scene->sites[i].part.index, DMB_PART_STRING << 24);
        }
        dmb_model_destroy(&model);
    }
}

/* Sites stand at the same places whatever the pipes are. */
static void places_do_not_depend_on_the_kind(void **state)
{
    (void)state;
    for (uint32_t kinds = 0; kinds < 16; ++kinds) {
        dmb_model *model = free_start();
        dmb_pipe_def pipe = s1_pipe();
        const dmb_scene *scene;
        for (uint32_t run = 0; run < 4; ++run) {
            pipe.kind = kinds >> run & 1 ? DMB_PIPE_RIGID : DMB_PIPE_FLEXIBLE;
            pipe.joint_length = run % 2 ? 0.0 : 0.3;
            add_pipes(model, &pipe, run + 1);
        }
        scene = compiled(model);
        assert_int_equal(scene->site_count, 11);
        for (uint32_t i = 0; i < 11; ++i) {
            const dmb_site *site = &scene->sites[i];
            assert_close(scene->reference_position[3 * site->node] + site->offset, 1.5 * i, 1e-12);
            assert_near(site->length, i == 0 || i == 10 ? 0.75 : 1.5, 1e-14);
            assert_int_equal(site->pipe, i - 1);
        }
        dmb_model_destroy(&model);
    }
}

static void supportd_rig_end_has_none(void **state)
{
    static const struct {
        int32_t mask;
        uint32_t sites;
    } cases[] = {
        {DMB_FREE_NONE, 3}, {DMB_FREE_CYLINDRICAL, 3}, {DMB_FREE_SPHERICAL, 3}, {DMB_FREE_Z, 4}, {DMB_FREE_ALL, 4}};
    (void)state;
    for (size_t i = 0; i < 5; ++i) {
        dmb_model *model = new_model();
        dmb_string_def string = dmb_string_def_default();
        const dmb_pipe_def pipe = s1_pipe();
        add_wall(model);
        string.start_free = cases[i].mask;
        assert_ok(dmb_model_add_string(model, &string, NULL));
        add_pipes(model, &pipe, 3);
        assert_int_equal(compiled(model)->site_count, cases[i].sites);
        dmb_model_destroy(&model);
    }
}

/* A rigid string on a spherical support tilts: all its places but the guided one move sideways. */
static void tilting_body(void **state)
{
    dmb_model *model = new_model();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    const dmb_scene *scene;
    (void)state;
    add_wall(model);
    string.start_free = DMB_FREE_SPHERICAL;
    assert_ok(dmb_model_add_string(model, &string, NULL));
    pipe.kind = DMB_PIPE_RIGID;
    add_pipes(model, &pipe, 3);
    scene = compiled(model);
    assert_int_equal(scene->site_count, 3);
    assert_near(scene->sites[0].offset, 1.5, 0.0);
    dmb_model_destroy(&model);
}

/* A whole rigid string in a cylindrical support cannot reach the wall. */
static void supportd_rigid_string_has_none(void **state)
{
    dmb_model *model = new_model();
    const dmb_pipe_def pipe = s1_pipe();
    (void)state;
    add_wall(model);
    add_pipes(model, &pipe, 3);
    assert_int_equal(compiled_with(model, DMB_FEATURE_ALL, DMB_PIPE_RIGID)->site_count, 0);
    dmb_model_destroy(&model);
}

static void largest_diameter_touches(void **state)
{
    dmb_model *model = free_start();
    dmb_pipe_def pipe = s1_pipe();
    const dmb_scene *scene;
    (void)state;
    pipe.joint_length = 0.2;
    pipe.joint_outer_diameter = 0.085;
    pipe.elements = 2;
    add_pipes(model, &pipe, 1);
    pipe.joint_length = 0.0;
    pipe.outer_diameter = 0.08;
    pipe.elements = 1;
    add_pipes(model, &pipe, 2);
    scene = compiled(model);
    assert_int_equal(scene->site_count, 5);
    assert_near(scene->sites[0].radius, 0.0365, 1e-15);
    assert_near(scene->sites[1].radius, 0.0365, 1e-15); /* the joint is at the far end only */
    assert_near(scene->sites[2].radius, 0.0425, 1e-15);
    assert_near(scene->sites[3].radius, 0.04, 1e-15);
    assert_near(scene->sites[4].radius, 0.04, 1e-15);
    assert_int_equal(scene->sites[0].pipe, DMB_NONE);
    assert_int_equal(scene->sites[1].pipe, 0);
    assert_int_equal(scene->sites[2].pipe, 0);
    assert_int_equal(scene->sites[3].pipe, 1);
    dmb_model_destroy(&model);
}

static void rings_of_bodies_and_bits_come_last(void **state)
{
    dmb_model *model = new_model();
    const dmb_pipe_def pipe = s1_pipe();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_id bit_id, body_id;
    const dmb_scene *scene;
    (void)state;
    add_wall(model);
    add_pipes(model, &pipe, 2);
    bit.diameter = 0.094; /* no clearance at all */
    assert_ok(dmb_model_add_bit(model, &bit, &bit_id));
    body.attach = DMB_ATTACH_START;
    body.contact_diameter = 0.09;
    assert_ok(dmb_model_add_body(model, &body, NULL)); /* guided: cannot touch */
    body.attach = DMB_ATTACH_NONE;
    body.contact_length = 0.25;
    assert_ok(dmb_model_add_body(model, &body, &body_id));
    scene = compiled(model);
    assert_int_equal(scene->site_count, 4);
    assert_int_equal(scene->bodies[0].site, DMB_NONE);
    assert_int_equal(scene->bodies[1].site, 2);
    assert_int_equal(scene->bodies[2].site, 3);
    assert_int_equal(scene->sites[2].part.index, body_id.index);
    assert_near(scene->sites[2].length, 0.25, 0.0);
    assert_near(scene->sites[2].clearance, 0.002, 1e-13);
    assert_int_equal(scene->sites[2].node, 3);
    assert_int_equal(scene->sites[3].part.index, bit_id.index);
    assert_near(scene->sites[3].offset, 0.05, 0.0);
    assert_near(scene->sites[3].length, 0.1, 0.0);
    assert_near(scene->sites[3].clearance, 0.0, 0.0);
    assert_int_equal(scene->sites[3].node, 2);
    dmb_model_destroy(&model);
}

static void path_nodes_rub(void **state)
{
    static const struct {
        int32_t features;
        uint32_t sites, axial_torsional_sites;
    } cases[] = {{DMB_FEATURE_ALL, 2, 3},
                 {DMB_FEATURE_ALL & ~DMB_FEATURE_FRICTION, 2, 0},
                 {DMB_FEATURE_ALL & ~DMB_FEATURE_CONTACT, 0, 0}};
    (void)state;
    for (size_t i = 0; i < 3; ++i) {
        dmb_model *model = new_model();
        dmb_pipe_def pipe = s1_pipe();
        const dmb_scene *scene;
        add_wall(model);
        pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
        add_pipes(model, &pipe, 3);
        pipe.kind = DMB_PIPE_FLEXIBLE;
        add_pipes(model, &pipe, 1);
        scene = compiled_with(model, cases[i].features, -1);
        assert_int_equal(scene->site_count, cases[i].sites);
        assert_int_equal(scene->axial_torsional_site_count, cases[i].axial_torsional_sites);
        if (cases[i].axial_torsional_sites > 0) {
            assert_near(scene->axial_torsional_sites[0].length, 0.75, 0.0);
            assert_near(scene->axial_torsional_sites[1].length, 1.5, 0.0);
            assert_int_equal(scene->axial_torsional_sites[2].node, 2);
            assert_int_equal(scene->axial_torsional_sites[0].pipe, DMB_NONE);
            assert_int_equal(scene->axial_torsional_sites[2].pipe, 1);
            assert_near(scene->axial_torsional_sites[2].radius, 0.0365, 0.0);
        }
        dmb_model_destroy(&model);
    }
}

static void laws_are_taken_over(void **state)
{
    dmb_model *model = new_model();
    const dmb_pipe_def pipe = s1_pipe();
    const dmb_scene *scene;
    (void)state;
    add_wall(model);
    add_pipes(model, &pipe, 1);
    scene = compiled(model);
    assert_int_equal(scene->normal_law.kind, DMB_NORMAL_EXACT);
    assert_near(scene->normal_law.stiffness, 1e7, 0.0);
    assert_near(scene->normal_law.mu, 2.08249816, 1e-8); /* root of eq:contact.exact at 0.4 */
    assert_int_equal(scene->friction_law.kind, DMB_FRICTION_STRIBECK);
    assert_near(scene->friction_law.mu_static, 0.35, 0.0);
    assert_near(scene->hole.radius, 0.047, 0.0);
    assert_int_equal(scene->features, DMB_FEATURE_GRAVITY | DMB_FEATURE_CONTACT | DMB_FEATURE_FRICTION);
    dmb_model_destroy(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(lengths_add_up),
        TEST(places_do_not_depend_on_the_kind),
        TEST(supportd_rig_end_has_none),
        TEST(tilting_body),
        TEST(supportd_rigid_string_has_none),
        TEST(largest_diameter_touches),
        TEST(rings_of_bodies_and_bits_come_last),
        TEST(path_nodes_rub),
        TEST(laws_are_taken_over),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
