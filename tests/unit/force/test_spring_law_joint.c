/* Spring, damper, friction and stops along a joint coordinate: formulas, energy, derivatives, clipping. */
#include "force/spring_law.h"

#include "force_test.h"

static const dmb_joint_law none = {0, 0, 0, 0, 1e-3, -1e30, 1e30, 0, 0};
static const dmb_joint_law all = {70, 3, 0.1, 5, 0.02, -0.4, 0.6, 9e3, 40};

static dmb_joint_force force_at(const dmb_joint_law *law, double x, double s)
{
    dmb_joint_force f;
    dmb_joint_force_at(law, x, s, &f);
    return f;
}

static void acts_if_any_part_does(void **state)
{
    dmb_joint_law law = none;
    (void)state;
    assert_int_equal(dmb_joint_law_acts(&law), 0);
    law.stop_stiffness = law.stop_damping = law.rest = 1.0; /* stops nowhere */
    assert_int_equal(dmb_joint_law_acts(&law), 0);
    law.stop_low = -1.0;
    assert_int_equal(dmb_joint_law_acts(&law), 1);
    law.stop_low = -1e30;
    law.stop_high = 1.0;
    assert_int_equal(dmb_joint_law_acts(&law), 1);
    law.stop_stiffness = 0.0; /* a stop without stiffness is none */
    assert_int_equal(dmb_joint_law_acts(&law), 0);
    assert_true(force_at(&law, 2.0, 1.0).force == 0.0);
    law = none;
    law.stiffness = 1.0;
    assert_int_equal(dmb_joint_law_acts(&law), 1);
    law = none;
    law.damping = 1.0;
    assert_int_equal(dmb_joint_law_acts(&law), 1);
    law = none;
    law.friction = 1.0;
    assert_int_equal(dmb_joint_law_acts(&law), 1);
}

static void formulas(void **state)
{
    (void)state;
    dmb_joint_force f = force_at(&all, 0.3, -0.05); /* between the stops */
    CHECK_RELATIVE(f.spring, -70 * 0.2, 1e-14);
    CHECK_RELATIVE(f.damper, 3 * 0.05, 1e-15);
    CHECK_RELATIVE(f.friction, 5 * 0.05 / sqrt(0.0029), 1e-14);
    assert_true(f.stop == 0.0 && f.stop_damper == 0.0);
    f = force_at(&all, 0.61, 0.5); /* in the upper one, inwards: K d + c s */
    CHECK_RELATIVE(f.stop, -90, 1e-12);
    CHECK_RELATIVE(f.stop_damper, -20, 1e-15);
    f = force_at(&all, -0.42, 1.0); /* coming out of the lower one: K d - c s */
    CHECK_RELATIVE(f.stop, 180, 1e-12);
    CHECK_RELATIVE(f.stop_damper, -40, 1e-15);
}

/* The stop never pulls: out of it faster than K d/c, its damper takes back the share of its spring. */
static void stops_do_not_pull(void **state)
{
    dmb_joint_law law = all;
    (void)state;
    law.stiffness = law.damping = law.friction = 0.0;
    for (int side = -1; side <= 1; side += 2) {
        const double x = side > 0 ? 0.61 : -0.41;
        const dmb_joint_force f = force_at(&law, x, -3.0 * side);
        CHECK_RELATIVE(f.stop, -90.0 * side, 1e-12);
        assert_true(f.force == 0.0 && f.stop_damper == -f.stop && f.by_position == 0.0 && f.by_speed == 0.0);
        for (double s = -5.0; s <= 5.0; s += 0.01) assert_true(side * force_at(&law, x, s).force <= 0.0);
    }
}

/* Whether one smooth piece of the law spans x +- h, s +- h. */
static int smooth_near(const dmb_joint_law *law, double x, double s, double h)
{
    if (fabs(x - law->stop_high) < 2 * h || fabs(x - law->stop_low) < 2 * h) return 0;
    const double d = x > law->stop_high ? x - law->stop_high : x < law->stop_low ? x - law->stop_low : 0.0;
    return fabs(law->stop_stiffness * d + law->stop_damping * s) > 2 * h * (law->stop_stiffness + law->stop_damping) ||
           d == 0.0;
}

static void derivatives_and_sum(void **state)
{
    uint64_t seed = 11;
    int checked = 0;
    (void)state;
    for (int i = 0; i < 5000; ++i) {
        const double x = draw(&seed, -0.6, 0.8), s = draw(&seed, -1, 1) * pow(10, draw(&seed, -3, 1)), h = 1e-6;
        if (!smooth_near(&all, x, s, h)) continue;
        const dmb_joint_force f = force_at(&all, x, s);
        const double by_position = (force_at(&all, x + h, s).force - force_at(&all, x - h, s).force) / (2 * h);
        const double by_speed = (force_at(&all, x, s + h).force - force_at(&all, x, s - h).force) / (2 * h);
        CHECK_CLOSE(f.by_position, by_position, 1e-5 * (1 + fabs(f.by_position)));
        CHECK_CLOSE(f.by_speed, by_speed, 1e-5 * (1 + fabs(f.by_speed)));
        CHECK_CLOSE(f.force, f.spring + f.damper + f.friction + f.stop + f.stop_damper, 1e-11);
        ++checked;
    }
    assert_true(checked > 4500);
}

/* spring + stop = -dE/dx; the rest never gives energy away. */
static void energy(void **state)
{
    uint64_t seed = 12;
    (void)state;
    for (int i = 0; i < 2000; ++i) {
        const double x = draw(&seed, -0.6, 0.8), s = draw(&seed, -3, 3), h = 1e-4;
        const dmb_joint_force f = force_at(&all, x, s);
        CHECK_CLOSE(f.spring + f.stop,
                    (dmb_joint_law_energy(&all, x - h) - dmb_joint_law_energy(&all, x + h)) / (2 * h),
                    (fabs(x - 0.6) < h || fabs(x + 0.4) < h) ? 1.0 : 1e-7);
        assert_true((f.damper + f.friction) * s <= 0.0);
        assert_true(f.stop_damper * s <= 0.0);
        assert_true(dmb_joint_law_energy(&all, x) >= 0.0);
    }
    CHECK_RELATIVE(dmb_joint_law_energy(&all, 0.62), 0.5 * 70 * 0.52 * 0.52 + 0.5 * 9e3 * 4e-4, 1e-12);
    CHECK_RELATIVE(dmb_joint_law_energy(&all, -0.43), 0.5 * 70 * 0.53 * 0.53 + 0.5 * 9e3 * 9e-4, 1e-12);
}

/* Friction saturates at its force, is finite at rest, and without smoothing is still a number. */
static void friction_limits(void **state)
{
    dmb_joint_law law = none;
    (void)state;
    law.friction = 8.0;
    CHECK_RELATIVE(force_at(&law, 0, 1e3).force, -8.0, 1e-11);
    CHECK_RELATIVE(force_at(&law, 0, -1e3).force, 8.0, 1e-11);
    assert_true(force_at(&law, 0, 0).force == 0.0);
    CHECK_RELATIVE(force_at(&law, 0, 0).by_speed, -8.0 / 1e-3, 1e-14);
    law.friction_speed = 0.0;
    assert_true(force_at(&law, 0, 0).force == 0.0 && force_at(&law, 0, 0).by_speed == 0.0);
    assert_true(force_at(&law, 0, 2).force == -8.0 && force_at(&law, 0, 2).by_speed == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(acts_if_any_part_does), cmocka_unit_test(formulas), cmocka_unit_test(stops_do_not_pull),
        cmocka_unit_test(derivatives_and_sum),   cmocka_unit_test(energy),   cmocka_unit_test(friction_limits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
