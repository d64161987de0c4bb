/* Slivers of steps, as sums of times that do not come out even make them: a step of next to nothing is done, and the
 * run after it is the run without it but for the time that it took. */
#include "whole_scene.h"

enum { BEFORE = 5, AFTER = 20 };
static const double step = 1e-3;

static struct {
    whole_parts parts;
    dmb_model *model;
    dmb_sim *sim;
} scene;

static int set_up(void **state)
{
    (void)state;
    memset(&scene, 0, sizeof scene);
    scene.model = whole_model(&scene.parts);
    scene.sim = whole_sim(scene.model, NULL);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    dmb_sim_destroy(&scene.sim);
    dmb_model_destroy(&scene.model);
    return 0;
}

static dmb_pose tip(const dmb_sim *sim)
{
    dmb_pose pose = dmb_pose_default();
    assert_int_equal(dmb_query_pose(sim, dmb_station(scene.parts.string, 4, 1.0), &pose), DMB_OK);
    return pose;
}

static dmb_motion tip_motion(const dmb_sim *sim)
{
    dmb_motion motion = dmb_motion_default();
    assert_int_equal(dmb_query_motion(sim, dmb_station(scene.parts.string, 4, 1.0), &motion), DMB_OK);
    return motion;
}

/* The same place to a micrometre and the same speed to a millimetre a second. */
static void compare(const char *what, const dmb_sim *sim, const dmb_sim *other)
{
    const dmb_pose a = tip(sim), b = tip(other);
    const dmb_motion u = tip_motion(sim), v = tip_motion(other);
    for (int i = 0; i < 3; i++) {
        if (!(fabs(a.position[i] - b.position[i]) <= 1e-6))
            fail_msg("%s: position[%d] %.12g, without it %.12g", what, i, a.position[i], b.position[i]);
        if (!(fabs(u.velocity[i] - v.velocity[i]) <= 1e-3))
            fail_msg("%s: velocity[%d] %.9g, without it %.9g", what, i, u.velocity[i], v.velocity[i]);
    }
}

static dmb_sim *undisturbed(uint32_t steps)
{
    dmb_sim *sim = whole_sim(scene.model, NULL);
    whole_run(sim, steps, step);
    return sim;
}

/* At time 0 there is no smallest step but that of the numbers themselves. */
static void first_step_may_be_a_sliver(void **state)
{
    static const double slivers[] = {4.9e-324, 1e-300, 1e-200, 1e-160, 1e-100, 1e-30, 1e-20, 1e-15, 1e-12, 1e-9};
    dmb_sim *other = undisturbed(AFTER);
    (void)state;
    for (size_t i = 0; i < sizeof slivers / sizeof slivers[0]; i++) {
        dmb_sim *sim = whole_sim(scene.model, NULL);
        assert_true(dmb_sim_step(sim, slivers[i], NULL) >= 0);
        assert_true(dmb_sim_time(sim) == slivers[i]);
        whole_run(sim, AFTER, step);
        compare("first step", sim, other);
        dmb_sim_destroy(&sim);
    }
    dmb_sim_destroy(&other);
}

static void sliver_on_the_way_does_no_harm(void **state)
{
    static const double slivers[] = {1e-18, 1e-17, 1e-16, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8};
    dmb_sim *other = undisturbed(BEFORE + AFTER);
    (void)state;
    for (size_t i = 0; i < sizeof slivers / sizeof slivers[0]; i++) {
        dmb_sim *sim = undisturbed(BEFORE);
        const double time = dmb_sim_time(sim);
        const int32_t status = dmb_sim_step(sim, slivers[i], NULL);
        assert_true(status >= 0 || time + slivers[i] == time);
        whole_run(sim, AFTER, step);
        compare("sliver", sim, other);
        dmb_sim_destroy(&sim);
    }
    dmb_sim_destroy(&other);
}

/* Many of them, between all the steps. */
static void slivers_between_all_steps_do_no_harm(void **state)
{
    dmb_sim *other = undisturbed(BEFORE + AFTER);
    (void)state;
    for (int i = 0; i < BEFORE + AFTER; i++) {
        assert_true(dmb_sim_step(scene.sim, 1e-13, NULL) >= 0);
        whole_run(scene.sim, 1, step);
    }
    compare("slivers", scene.sim, other);
    dmb_sim_destroy(&other);
}

static void next_time_is_reached(void **state)
{
    (void)state;
    whole_run(scene.sim, BEFORE, step);
    for (int i = 0; i < 10; i++) {
        const double next = nextafter(dmb_sim_time(scene.sim), 1.0);
        assert_true(dmb_sim_advance(scene.sim, next, NULL) >= 0);
        assert_true(dmb_sim_time(scene.sim) == next);
    }
    whole_run(scene.sim, AFTER, step);
}

/* The last step to a time that is no multiple of the steps. */
static void time_is_reached_exactly(void **state)
{
    const double end = 0.0305;
    (void)state;
    while (dmb_sim_time(scene.sim) < end) {
        const double left = end - dmb_sim_time(scene.sim);
        assert_true(dmb_sim_step(scene.sim, left < step ? left : step, NULL) >= 0);
    }
    assert_true(dmb_sim_time(scene.sim) <= nextafter(end, 1.0));
    assert_true(dmb_sim_advance(scene.sim, 0.05, NULL) >= 0);
    assert_true(dmb_sim_time(scene.sim) == 0.05);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(first_step_may_be_a_sliver),
        TEST(sliver_on_the_way_does_no_harm),
        TEST(slivers_between_all_steps_do_no_harm),
        TEST(next_time_is_reached),
        TEST(time_is_reached_exactly),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
