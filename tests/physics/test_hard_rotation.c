/* Hard case 10: relative rotation near pi within one element is refused, never flipped silently; the state before the
 * call is kept. The bound is 2.5 rad. */
#include "contact_scene.h"

/* A cantilever of one soft element without gravity, under a moment about `axis` that grows to `moment` within 1 s. */
static dmb_id build(rig *scene, uint32_t elements, int axis, double moment)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_segment ramp = scene_step_segment(0.0, 0.0, 1.0, 1.0);
    pipe.elements = elements;
    pipe.damping_time = 1e-2;
    for (int i = 0; i < 3; i++) {
        pipe.section_stiffness[i] = 1e6;
        pipe.section_stiffness[3 + i] = 100.0;
    }
    pipe.section_mass = 10.0;
    pipe.section_inertia[0] = pipe.section_inertia[1] = 0.1;
    string.start_free = DMB_FREE_NONE;
    scene_open(scene, 0.0);
    add_string(scene, &string);
    const dmb_id id = add_pipes(scene, &pipe, 1);
    load.frame = DMB_FRAME_BODY;
    load.place = dmb_station(id, 0, 1.0);
    load.moment[axis] = moment;
    load.time_function = add_time_function(scene, &ramp, 1);
    add_load(scene, &load);
    rig_start_with(scene, NULL, NULL);
    return id;
}

static double largest_strain(const rig *scene, dmb_id id)
{
    dmb_section section = dmb_section_default();
    assert_int_equal(dmb_query_section(scene->sim, dmb_station(id, 0, 0.5), &section), DMB_OK);
    return fmax(fabs(section.strain[3]), fmax(fabs(section.strain[4]), fabs(section.strain[5])));
}

/* In steps: the rotation follows the moment up to 2.5 rad; the step that would pass it is refused with part and bound,
 * and every further try too; nothing changes by that. */
static void refused_in_steps(void **state)
{
    (void)state;
    for (int axis = 0; axis < 3; axis++) {
        rig scene;
        const dmb_id id = build(&scene, 1, axis, 400.0);
        int32_t status = DMB_OK;
        uint64_t before = 0;
        int steps = 0;
        while (status >= 0 && steps++ < 2000) {
            before = rig_hash(&scene);
            status = dmb_sim_step(scene.sim, 1e-3, NULL);
            if (status >= 0) CHECK_BELOW(largest_strain(&scene, id), 2.5);
        }
        print_message("axis %d: %s\n", axis, dmb_sim_message(scene.sim));
        assert_int_equal(status, DMB_ERR_ROTATION);
        assert_non_null(strstr(dmb_sim_message(scene.sim), "string 0"));
        assert_non_null(strstr(dmb_sim_message(scene.sim), "pipe 0"));
        assert_non_null(strstr(dmb_sim_message(scene.sim), "2.5"));
        assert_true(rig_hash(&scene) == before);
        assert_true(largest_strain(&scene, id) > 2.3); /* it came close */
        assert_int_equal(dmb_sim_step(scene.sim, 1e-3, NULL), DMB_ERR_ROTATION);
        assert_true(rig_hash(&scene) == before);
        rig_close(&scene);
    }
}

/* With step control the last accepted state is kept, and its time told. */
static void refused_with_step_control(void **state)
{
    rig scene;
    (void)state;
    const dmb_id id = build(&scene, 1, 2, 400.0);
    assert_int_equal(dmb_sim_advance(scene.sim, 2.0, NULL), DMB_ERR_ROTATION);
    assert_true(dmb_sim_time(scene.sim) > 0.5 && dmb_sim_time(scene.sim) < 1.0);
    assert_true(largest_strain(&scene, id) > 2.4 && largest_strain(&scene, id) <= 2.5);
    const double before = dmb_sim_time(scene.sim);
    assert_int_equal(dmb_sim_advance(scene.sim, 2.0, NULL), DMB_ERR_ROTATION);
    CHECK_CLOSE(dmb_sim_time(scene.sim), before, 1e-6);
    CHECK_BELOW(largest_strain(&scene, id), 2.5);
    rig_close(&scene);
}

/* A step as large as the whole ramp must not jump over pi. */
static void refused_in_one_step(void **state)
{
    rig scene;
    (void)state;
    build(&scene, 1, 2, 628.0); /* two turns, were they allowed */
    const uint64_t before = rig_hash(&scene);
    assert_int_equal(dmb_sim_step(scene.sim, 1.0, NULL), DMB_ERR_ROTATION);
    assert_true(rig_hash(&scene) == before);
    rig_close(&scene);
}

static void refused_in_statics(void **state)
{
    (void)state;
    for (int axis = 0; axis < 3; axis++) {
        rig scene;
        dmb_static_options options = dmb_static_options_default();
        const dmb_id id = build(&scene, 1, axis, 400.0);
        while (dmb_sim_time(scene.sim) < 0.5) scene_step(&scene, 1e-2); /* half of the moment: 2 rad */
        scene_must(&scene, dmb_analysis_static(scene.sim, NULL, NULL));
        CHECK_RELATIVE(largest_strain(&scene, id), 2.0, 1e-9);
        while (dmb_sim_time(scene.sim) < 0.57) scene_step(&scene, 1e-2);
        scene_step(&scene, 2e-3);
        const uint64_t before = rig_hash(&scene);
        options.load_steps = 10;
        scene_must(&scene, dmb_analysis_static(scene.sim, &options, NULL)); /* 2.43 rad */
        assert_true(rig_hash(&scene) != before);
        CHECK_BELOW(largest_strain(&scene, id), 2.5);
        rig_close(&scene);
    }
    rig scene;
    dmb_static_options options = dmb_static_options_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_string_def string = dmb_string_def_default();
    string.start_free = DMB_FREE_NONE;
    scene_open(&scene, 0.0);
    add_string(&scene, &string);
    for (int i = 0; i < 3; i++) pipe.section_stiffness[i] = 1e6, pipe.section_stiffness[3 + i] = 100.0;
    const dmb_id id = add_pipes(&scene, &pipe, 1);
    load.frame = DMB_FRAME_BODY;
    load.place = dmb_station(id, 0, 1.0);
    load.moment[2] = 400.0;
    add_load(&scene, &load);
    rig_start_with(&scene, NULL, NULL);
    const uint64_t before = rig_hash(&scene);
    options.load_steps = 20;
    const int32_t status = dmb_analysis_static(scene.sim, &options, NULL);
    print_message("statics: %s, %s\n", dmb_status_name(status), dmb_sim_message(scene.sim));
    assert_true(status == DMB_ERR_ROTATION || status == DMB_ERR_NO_CONVERGENCE);
    assert_true(rig_hash(&scene) == before);
    rig_close(&scene);
}

/* Divided into elements the same pipe takes the same moment: 4 rad over four elements. */
static void divided_it_goes_on(void **state)
{
    rig scene;
    double angle = 0.0;
    (void)state;
    const dmb_id id = build(&scene, 4, 0, 400.0);
    while (dmb_sim_time(scene.sim) < 4.0) scene_step(&scene, 1e-2);
    assert_int_equal(dmb_query_rotation(scene.sim, dmb_station(id, 0, 1.0), &angle), DMB_OK);
    CHECK_RELATIVE(angle, 4.0, 1e-3);
    rig_close(&scene);
}

/* Many revolutions of the whole pipe are not relative rotation. */
static void spinning_is_not_refused(void **state)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_string_def string = dmb_string_def_default();
    rig scene;
    double angle = 0.0;
    (void)state;
    string.start_free = string.end_free = DMB_FREE_ALL;
    string.velocity[3] = 100.0;
    scene_open(&scene, 0.0);
    add_string(&scene, &string);
    const dmb_id id = add_pipes(&scene, &pipe, 2);
    rig_start_with(&scene, NULL, NULL);
    for (int i = 0; i < 1000; i++) scene_step(&scene, 1e-2);
    assert_int_equal(dmb_query_rotation(scene.sim, dmb_station(id, 1, 1.0), &angle), DMB_OK);
    CHECK_RELATIVE(angle, 1000.0, 1e-12);
    rig_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(refused_in_steps),    cmocka_unit_test(refused_with_step_control),
        cmocka_unit_test(refused_in_one_step), cmocka_unit_test(refused_in_statics),
        cmocka_unit_test(divided_it_goes_on),  cmocka_unit_test(spinning_is_not_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
