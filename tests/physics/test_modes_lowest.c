/* The lowest modes of long strings that lie in their hole: lateral modes k of a beam on the wall, s_k^2 = -(k_wall + EI
 * (k pi/L)^4)/m, crowd at the lower edge of their band, at 4.3 Hz here, which few modes reach in short strings and in
 * long ones only many. Equations: eq:modes.count, eq:modes.shift-invert, eq:modes.nearer. */
#include <stdio.h>

#include "mechanism.h"
#include "modal.h"

/* On the low side of a hole, with or without friction, its start held along and about the axis, its end under a thrust
 * [N]; or in two strings that a joint connects. */
static void open_lying(rig *s, uint32_t pipes, int joint, double thrust)
{
    dmb_load_def load = dmb_load_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    rig_open(s, 0.0, 0.0, -9.81);
    wall.diameter = 0.1;
    if (joint) wall.friction_law = DMB_FRICTION_NONE;
    add_wall(s, &wall);
    const dmb_id first = pipe.string = add_string(s, &string);
    pipe.damping_time = 1e-4;
    (void)add_pipes(s, &pipe, joint ? pipes / 2 : pipes);
    if (joint) {
        string.start_depth = pipe.length * (pipes / 2);
        pipe.string = add_string(s, &string);
        (void)add_pipes(s, &pipe, pipes - pipes / 2);
        (void)add_joint_between(s, DMB_JOINT_FIXED, dmb_station(first, pipes / 2 - 1, 1.0),
                                dmb_station(pipe.string, 0, 0.0));
    }
    const dmb_id zero = add_constant(s, 0.0);
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, first, DMB_RX, zero);
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, first, DMB_X, zero);
    load.place = dmb_station(pipe.string, (joint ? pipes - pipes / 2 : pipes) - 1, 1.0);
    load.force[0] = -thrust;
    (void)add_load(s, &load);
    (void)rig_start(s, NULL);
    assert_true(dmb_analysis_static(s->sim, NULL, NULL) >= 0); /* a string that buckles lies straight, unstable */
}

/* The lowest ones are those of the band below the last of them, each as often as there. */
static void check_lowest(const rig *s, uint32_t count, uint32_t solves)
{
    dmb_modes *lowest = lowest_modes(s, DMB_MODES_UNDAMPED, count);
    const double last = frequency_at(lowest, count - 1);
    dmb_modes *band = modes_in_band(s, DMB_MODES_UNDAMPED, 0.0, last * (1.0 + 1e-10));
    double worst = 0.0;
    assert_int_equal(info_of(lowest).count, count);
    assert_int_equal(info_of(lowest).dense, 0);
    assert_true(info_of(band).count >= count);
    for (uint32_t i = 0; i < count; i++)
        worst = fmax(worst, fabs(frequency_at(lowest, i) / frequency_at(band, i) - 1.0));
    print_message("%u coordinates: %u modes up to %.9g Hz, %u solves\n", info_of(lowest).coordinates, count, last,
                  info_of(lowest).solves);
    check_below("  against those of the band", worst, 1e-10);
    check_below("  residual", info_of(lowest).residual, 1e-10);
    assert_true(info_of(lowest).solves <= solves);
    dmb_modes_destroy(&band);
    dmb_modes_destroy(&lowest);
}

static void lying_strings(void **state)
{
    (void)state;
    static const uint32_t pipes[] = {200, 500}, counts[] = {1, 3, 10, 20};
    for (size_t n = 0; n < sizeof pipes / sizeof *pipes; n++) {
        rig s;
        open_lying(&s, pipes[n], 0, 0.0);
        for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) check_lowest(&s, counts[k], 130);
        rig_close(&s);
    }
}

static void a_thousand_pipes(void **state)
{
    (void)state;
    rig s;
    open_lying(&s, 1000, 0, 0.0);
    check_lowest(&s, 10, 130);
    rig_close(&s);
}

/* The counts hold where joints connect chains, too. */
static void jointed_lying_string(void **state)
{
    (void)state;
    rig s;
    open_lying(&s, 400, 1, 0.0);
    check_lowest(&s, 3, 130);
    check_lowest(&s, 10, 130);
    rig_close(&s);
}

/* Under thrust the crowd moves down, and beyond 34 kN some of its squares are negative: against all modes by the dense
 * method. Result: number of the lowest modes that grow. */
static uint32_t check_thrust(double thrust, uint32_t count)
{
    rig s;
    uint32_t growing = 0;
    double worst = 0.0;
    open_lying(&s, 120, 0, thrust);
    dmb_modes *lowest = lowest_modes(&s, DMB_MODES_UNDAMPED, count), *all = all_modes(&s, DMB_MODES_UNDAMPED);
    assert_int_equal(info_of(lowest).count, count);
    assert_int_equal(info_of(lowest).dense, 0);
    for (uint32_t i = 0; i < count; i++) {
        const dmb_mode mode = mode_at(lowest, i), same = mode_at(all, i);
        worst = fmax(worst, fabs(mode.frequency / same.frequency - 1.0));
        assert_int_equal(mode.eigenvalue[0] > 0.0, same.eigenvalue[0] > 0.0);
        growing += mode.eigenvalue[0] > 0.0;
    }
    print_message("thrust %g kN: %u modes, %u grow, %u solves\n", 1e-3 * thrust, count, growing,
                  info_of(lowest).solves);
    check_below("  against all modes", worst, 1e-10);
    dmb_modes_destroy(&all);
    dmb_modes_destroy(&lowest);
    rig_close(&s);
    return growing;
}

static void strings_under_thrust(void **state)
{
    (void)state;
    assert_int_equal(check_thrust(-5e4, 10), 0);
    assert_int_equal(check_thrust(3e4, 10), 0);
    assert_true(check_thrust(4.2e4, 5) > 0);
    assert_true(check_thrust(9e4, 17) > 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(lying_strings), cmocka_unit_test(a_thousand_pipes),
                                       cmocka_unit_test(jointed_lying_string), cmocka_unit_test(strings_under_thrust)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
