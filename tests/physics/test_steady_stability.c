/* The stability of states that move: shafts under end torque that turn with their axes at rest, held against the same
 * shafts at rest and the closed forms of their torque; a shaft that turns as a rigid body, held against its critical
 * speed; strings that slip along and around a hole, for which a symmetric part alone tells nothing. */
#include "modal.h"

#define EI 2e5 /* [N m2] stiff in stretch and shear, which the closed forms leave out */
#define LENGTH 10.0
#define MASS 20.0                                       /* [kg/m] */
#define CLAMPED (2.0 * 4.493409457909064 * EI / LENGTH) /* [N m] tan x = x, T = 2 x EI/L */

typedef struct choice {
    int32_t end_free, steady;
    double torque, spin; /* [N m, rad/s] */
} choice;

static dmb_static_report judge(const choice *c)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = beam_pipe(LENGTH, 32, 1e6 * EI, 1e6 * EI, EI / 1.3, EI);
    dmb_static_options options = dmb_static_options_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_static_report report = dmb_static_report_default();
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    string.follows_hole = 0;
    string.start_free = DMB_FREE_RX;
    string.end_free = c->end_free;
    pipe.section_mass = MASS;
    pipe.section_inertia[0] = 2e-4;
    pipe.section_inertia[1] = 1e-4;
    pipe.string = add_string(&s, &string);
    (void)add_pipes(&s, &pipe, 1);
    load.place = dmb_station(pipe.string, 0, 1.0);
    load.frame = DMB_FRAME_WORLD;
    load.moment[0] = c->torque;
    if (c->torque != 0.0) (void)add_load(&s, &load);
    (void)add_simple_drive(&s, DMB_DRIVE_MOTION, pipe.string, DMB_RX, add_constant(&s, c->spin));
    (void)rig_start(&s, NULL);
    options.steady = c->steady;
    must(&s, dmb_analysis_static(s.sim, &options, &report));
    print_message("    torque %8.0f N m, %5.2f rad/s, kind %d: %d negative, stiffness %d\n", c->torque, c->spin,
                  (int)report.steady, (int)report.negative, (int)report.stiffness);
    assert_int_equal(report.steady, c->steady);
    rig_close(&s);
    return report;
}

/* Axes at rest: the torque that the shaft bears is that at rest, whatever it turns by. A moment with a fixed axis at a
 * free end does not let it diverge at all, though its symmetric part has negative eigenvalues. */
static void shaft_bears_the_torque_it_bears_at_rest(void **state)
{
    (void)state;
    static const struct {
        int32_t end_free, stiffness, negative;
        double torque;
    } want[] = {{DMB_FREE_CYLINDRICAL, DMB_STIFFNESS_SYMMETRIC, 0, 0.99 * CLAMPED},
                {DMB_FREE_CYLINDRICAL, DMB_STIFFNESS_SYMMETRIC, 2, 1.01 * CLAMPED},
                {DMB_FREE_CYLINDRICAL, DMB_STIFFNESS_SYMMETRIC, 2, -1.01 * CLAMPED},
                {DMB_FREE_ALL, DMB_STIFFNESS_UNSYMMETRIC, 0, 6.0 * EI / LENGTH},
                {DMB_FREE_ALL, DMB_STIFFNESS_UNSYMMETRIC, 0, -15.0 * EI / LENGTH}};
    for (size_t i = 0; i < sizeof want / sizeof want[0]; i++)
        for (int turns = 0; turns < 3; turns++) {
            const choice c = {want[i].end_free, turns ? DMB_STEADY_SLIDING : DMB_STEADY_AT_REST, want[i].torque,
                              turns == 2 ? -30.0 : 5.0 * turns};
            const dmb_static_report report = judge(&c);
            assert_int_equal(report.negative, want[i].negative);
            assert_int_equal(report.stiffness, want[i].stiffness);
        }
}

/* As a rigid body about its own axis: K - Omega^2 M loses two directions at each critical speed, 3.516 and 22.034
 * sqrt(EI/m L^4) of a cantilever. */
static void shaft_passes_its_critical_speeds(void **state)
{
    (void)state;
    static const double part[4] = {0.995 * 3.51601527, 1.005 * 3.51601527, 0.995 * 22.0344916, 1.005 * 22.0344916};
    static const int32_t want[4] = {0, 2, 2, 4};
    for (int i = 0; i < 4; i++) {
        const choice c = {DMB_FREE_ALL, DMB_STEADY_RIGID, 0.0, part[i] * sqrt(EI / MASS) / (LENGTH * LENGTH)};
        const dmb_static_report report = judge(&c);
        assert_int_equal(report.negative, want[i]);
        assert_int_equal(report.stiffness, DMB_STIFFNESS_SYMMETRIC);
    }
}

/* Pushed and pulled, turned, and both, in a hole that bends: friction makes the stiffness unsymmetric, and nothing
 * diverges. A wall that is softer or stiffer does not matter. */
static void slipping_strings_are_stable(void **state)
{
    (void)state;
    static const double speed[][2] = {{0.05, 0.0}, {-0.05, 0.0}, {0.0, 10.0}, {0.05, -10.0}, {1e-3, 20.0}};
    for (size_t i = 0; i < sizeof speed / sizeof speed[0]; i++)
        for (int stiff = 0; stiff < 2; stiff++) {
            const double survey[6] = {0.0, 1.5, 0.0, 200.0, 1.5 + 200.0 * 5e-4, 0.02};
            dmb_wall_def wall = s1_hole();
            dmb_string_def string = dmb_string_def_default();
            dmb_pipe_def pipe = s1_pipe();
            dmb_static_report report = dmb_static_report_default();
            rig s;
            rig_open(&s, 0.0, 0.0, -9.81);
            wall.survey = survey;
            wall.survey_count = 2;
            wall.friction_law = DMB_FRICTION_COULOMB;
            wall.mu_static = wall.mu_dynamic = 0.3;
            wall.smoothing_speed = 1e-6;
            wall.stiffness = stiff ? 1e9 : 1e7;
            (void)add_wall(&s, &wall);
            string.start_free = DMB_FREE_CYLINDRICAL;
            pipe.string = add_string(&s, &string);
            (void)add_pipes(&s, &pipe, 60);
            (void)add_simple_drive(&s, DMB_DRIVE_MOTION, pipe.string, DMB_X, add_constant(&s, speed[i][0]));
            (void)add_simple_drive(&s, DMB_DRIVE_MOTION, pipe.string, DMB_RX, add_constant(&s, speed[i][1]));
            (void)rig_start(&s, NULL);
            must(&s, dmb_analysis_static(s.sim, NULL, &report));
            print_message("    %g m/s, %g rad/s, wall %g: %d negative, stiffness %d\n", speed[i][0], speed[i][1],
                          wall.stiffness, (int)report.negative, (int)report.stiffness);
            assert_int_equal(report.steady, DMB_STEADY_SLIDING);
            assert_int_equal(report.stiffness, DMB_STIFFNESS_UNSYMMETRIC);
            assert_int_equal(report.negative, 0);
            rig_close(&s);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shaft_bears_the_torque_it_bears_at_rest),
        cmocka_unit_test(shaft_passes_its_critical_speeds),
        cmocka_unit_test(slipping_strings_are_stable),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
