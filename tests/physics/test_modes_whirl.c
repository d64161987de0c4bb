/* Modes of turning strings as they are seen from outside (Campbell): forward and backward whirl of a shaft, the same in
 * axes that turn, and of a string that turns on the wall of its hole. Equations: eq:modes.still-axes. */
#include <stdio.h>
#include <string.h>

#include "modal.h"

/* ---- A shaft ----------------------------------------------------------------------------------------------------- */

#define LENGTH 2.0
#define BENDING 1e3 /* [N m2] EI */
#define MASS 2.0    /* [kg/m] */
#define ROTARY 0.05 /* [kg m] across, half of that about the axis */

/* Pinned at both ends, without shear. */
static void open_shaft(rig *s, uint32_t elements, double speed)
{
    dmb_pipe_def pipe = beam_pipe(LENGTH, elements, 1e9, 1e12, 1e6, BENDING);
    dmb_string_def string = dmb_string_def_default();
    pipe.section_mass = MASS;
    pipe.section_inertia[0] = 2.0 * ROTARY;
    pipe.section_inertia[1] = ROTARY;
    rig_open(s, 0, 0, 0);
    string.start_free = string.end_free = DMB_FREE_SPHERICAL;
    string.velocity[3] = speed;
    pipe.string = add_string(s, &string);
    (void)add_pipes(s, &pipe, 1);
    rig_start(s, NULL);
}

/* [1/s] Rayleigh's turning beam: (m + J b^2) w^2 -+ 2 J b^2 W w - EI b^4 = 0, b = n pi/L, upper sign forward. */
static double shaft_frequency(uint32_t n, double speed, double sense)
{
    const double b2 = pow(n * PI / LENGTH, 2), J = ROTARY * b2, total = MASS + J;
    return (sense * J * speed + sqrt(J * J * speed * speed + total * BENDING * b2 * b2)) / total;
}

static dmb_modes *modes_in_axes(const rig *s, int32_t axes, double spin, uint32_t count)
{
    dmb_modes_options options = dmb_modes_options_default();
    options.kind = DMB_MODES_DAMPED;
    options.count = count;
    options.axes = axes;
    options.spin = spin;
    return find_modes(s, &options);
}

/* Lateral mode number n from 0 that whirls in a sense. */
static dmb_mode whirling(const dmb_modes *modes, double sense, uint32_t n)
{
    for (uint32_t i = 0; i < info_of(modes).count; i++) {
        const dmb_mode mode = mode_at(modes, i);
        if (!mode.rigid && mode.whirl * sense > 0.5 && n-- == 0) return mode;
    }
    fail_msg("no such whirl of sense %g", sense);
    return mode_at(modes, 0);
}

static void check_shaft(const dmb_modes *modes, double speed, double tolerance)
{
    for (uint32_t n = 1; n <= 3; n++)
        for (int sense = 1; sense >= -1; sense -= 2) {
            char what[80];
            const dmb_mode mode = whirling(modes, sense, n - 1);
            (void)snprintf(what, sizeof what, "    %s whirl %u", sense > 0 ? "forward" : "backward", n);
            check_relative(what, mode.eigenvalue[1], shaft_frequency(n, speed, sense), tolerance);
            check_close("        all of it in circles", mode.whirl, sense, 1e-9);
        }
}

/* Turned by the option, and turning in the state. */
static void whirl_of_a_shaft(void **state)
{
    (void)state;
    const double speeds[2] = {20.0, 300.0}, tolerances[2] = {1e-6, 4e-4};
    for (int i = 0; i < 2; i++) {
        rig still, turning;
        open_shaft(&still, 64, 0.0);
        open_shaft(&turning, 64, speeds[i]);
        dmb_modes *by_option = modes_in_axes(&still, DMB_MODES_AXES_AT_REST, speeds[i], 12);
        dmb_modes *by_state = modes_in_axes(&turning, DMB_MODES_AXES_AT_REST, 0.0, 12);
        tell("shaft turning at [rad/s]", speeds[i]);
        check_shaft(by_option, speeds[i], tolerances[i]);
        for (uint32_t k = 0; k < 6; k++)
            check_relative("    the same by the state", frequency_at(by_state, 1 + k), frequency_at(by_option, 1 + k),
                           1e-9);
        dmb_modes_destroy(&by_option);
        dmb_modes_destroy(&by_state);
        rig_close(&still);
        rig_close(&turning);
    }
}

static double shaft_error(uint32_t elements, double speed)
{
    rig s;
    open_shaft(&s, elements, 0.0);
    dmb_modes *modes = modes_in_axes(&s, DMB_MODES_AXES_AT_REST, speed, 8);
    const double error = whirling(modes, 1.0, 0).eigenvalue[1] / shaft_frequency(1, speed, 1.0) - 1.0;
    dmb_modes_destroy(&modes);
    rig_close(&s);
    return fabs(error);
}

/* Gyroscopic terms of thick elements follow their shape: fourth order. In a constant mass the spin of an element's ends
 * would tilt with them, and its part be of second order. */
static void whirl_converges(void **state)
{
    (void)state;
    check_order("forward whirl at 300 rad/s", shaft_error(8, 300.0), shaft_error(16, 300.0), 4.0, 0.05);
}

/* In axes that turn, forward whirl of w is one of |w - W|, backward whirl one of w + W. */
static void axes_that_turn_shift_by_the_speed(void **state)
{
    (void)state;
    const double speed = 20.0;
    rig s;
    open_shaft(&s, 64, 0.0);
    dmb_modes *outside = modes_in_axes(&s, DMB_MODES_AXES_AT_REST, speed, 12);
    dmb_modes *inside = modes_in_axes(&s, DMB_MODES_AXES_TURNING, speed, 16);
    for (uint32_t n = 0; n < 3; n++) {
        check_below("forward, w - W", closest_mode(inside, fabs(whirling(outside, 1.0, n).eigenvalue[1] - speed)),
                    1e-6);
        check_below("backward, w + W", closest_mode(inside, whirling(outside, -1.0, n).eigenvalue[1] + speed), 1e-6);
    }
    dmb_modes_destroy(&outside);
    dmb_modes_destroy(&inside);
    rig_close(&s);
}

/* ---- A gyroscope ------------------------------------------------------------------------------------------------- */

/* A rigid pipe on a pivot that spins about its level axis at W and goes round by gravity: C W P = m g l, steady in axes
 * that go round with it and do not spin. It nods with n^2 = P^2 + (C W/A)^2 (Lagrange's top about its level state: with
 * the angle e from level A e'' = -(A P^2 + (C W)^2/A) e). */
static void nutation_of_a_gyroscope(void **state)
{
    const double speeds[] = {400.0, 100.0, 40.0}, m = 1.0, l = 0.25, C = 0.05, A = 0.025 + m * 0.25 / 3.0;
    (void)state;
    for (int k = 0; k < 3; k++) {
        rig s;
        dmb_pipe_def pipe = beam_pipe(0.5, 1, 1e9, 1e12, 1e6, 1e3);
        dmb_string_def string = dmb_string_def_default();
        const double precession = m * 9.81 * l / (C * speeds[k]);
        const double nutation = hypot(precession, C * speeds[k] / A);
        rig_open(&s, 0, 0, -9.81);
        pipe.kind = DMB_PIPE_RIGID;
        pipe.section_mass = m / 0.5;
        pipe.section_inertia[0] = C / 0.5;
        pipe.section_inertia[1] = 0.5 * C / 0.5;
        string.start_free = DMB_FREE_SPHERICAL;
        string.end_free = DMB_FREE_ALL;
        string.velocity[3] = speeds[k];
        string.velocity[5] = precession;
        pipe.string = add_string(&s, &string);
        (void)add_pipes(&s, &pipe, 1);
        rig_start(&s, NULL);
        dmb_modes_options options = dmb_modes_options_default();
        options.kind = DMB_MODES_DAMPED;
        options.axes = DMB_MODES_AXES_AT_REST;
        options.select = DMB_MODES_BAND;
        options.band[0] = 0.5;
        options.band[1] = 100.0;
        dmb_modes *modes = find_modes(&s, &options);
        tell("gyroscope that spins at [rad/s]", speeds[k]);
        check_below("    out of balance", info_of(modes).residual_of_state, 1e-12);
        assert_int_equal(info_of(modes).count, 1);
        check_relative("    nods", mode_at(modes, 0).eigenvalue[1], nutation, 1e-9);
        check_close("    without decay", mode_at(modes, 0).eigenvalue[0], 0.0, 1e-9 * nutation);
        dmb_modes_destroy(&modes);
        rig_close(&s);
    }
}

/* ---- On the wall ------------------------------------------------------------------------------------------------- */

/* A rigid pipe that turns on the wall climbs to atan(mu) and swings there: with N = m g cos(atan(mu)) at rest and the
 * friction mu N along the wall, w^2 = g sqrt(1 + mu^2)/e, e the distance of its axis from the hole's. */
static void swing_of_a_pipe_that_turns_on_the_wall(void **state)
{
    (void)state;
    const double mu = 0.3, speed = 20.0;
    rig s;
    dmb_wall_def wall = s1_hole();
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def string = dmb_string_def_default();
    dmb_static_options rest = dmb_static_options_default();
    rig_open(&s, 0, 0, -9.81);
    wall.friction_law = DMB_FRICTION_COULOMB;
    wall.mu_static = wall.mu_dynamic = mu;
    wall.smoothing_speed = 1e-6;
    wall.stiffness = 1e9;
    add_wall(&s, &wall);
    string.start_free = string.end_free = DMB_FREE_ALL;
    pipe.kind = DMB_PIPE_RIGID;
    pipe.string = add_string(&s, &string);
    const dmb_id pipes = add_pipes(&s, &pipe, 1);
    for (int32_t c = DMB_X; c <= DMB_RX; c += DMB_RX - DMB_X)
        (void)add_simple_drive(&s, DMB_DRIVE_MOTION, pipes, c, add_constant(&s, 0.0));
    rig_start(&s, NULL);
    rest.slip_rotation = speed;
    (void)find_equilibrium(&s, &rest);
    const dmb_pose pose = pose_at(&s, dmb_station(pipes, 0, 0.5));
    check_relative("climbed, tangent of the angle", fabs(pose.position[1] / pose.position[2]), mu, 1e-6);
    const double e = hypot(pose.position[1], pose.position[2]), want = sqrt(9.81 * sqrt(1.0 + mu * mu) / e);
    dmb_modes *modes = modes_in_axes(&s, DMB_MODES_AXES_AT_REST, speed, 4);
    check_below("turning on the wall: out of balance", info_of(modes).residual_of_state, 1e-6);
    check_below("    swings with sqrt(g sqrt(1 + mu^2)/e)", closest_mode(modes, want), 1e-5);
    tell("    [Hz]", want / (2.0 * PI));
    dmb_modes_destroy(&modes);
    dmb_modes_options options = dmb_modes_options_default();
    options.spin = speed; /* in axes that turn the wall goes round */
    const modes_refusal refusal = refused_modes(&s, &options);
    assert_int_equal(refusal.status, DMB_ERR_UNSUPPORTED);
    assert_non_null(strstr(refusal.text, "turns on the wall at 20 rad/s"));
    options.contact = DMB_CONTACT_OPEN;
    options.count = 2;
    dmb_modes *without = find_modes(&s, &options);
    dmb_modes_destroy(&without);
    rig_close(&s);
}

/* A string of thirty pipes that turns on the wall: friction makes its stiffness unsymmetric. All modes and the lowest
 * agree, damped or not, with their whirl. */
static void few_and_all_of_a_turning_string(void **state)
{
    (void)state;
    const double speed = 15.0;
    rig s;
    dmb_wall_def wall = s1_hole();
    dmb_pipe_def pipe = s1_pipe();
    dmb_static_options rest = dmb_static_options_default();
    rig_open(&s, 0, 0, -9.81);
    add_wall(&s, &wall);
    const dmb_string_def string = dmb_string_def_default();
    pipe.string = add_string(&s, &string);
    (void)add_pipes(&s, &pipe, 30);
    for (int32_t c = DMB_X; c <= DMB_RX; c += DMB_RX - DMB_X)
        (void)add_simple_drive(&s, DMB_DRIVE_MOTION, pipe.string, c, add_constant(&s, 0.0));
    rig_start(&s, NULL);
    rest.slip_rotation = speed;
    (void)find_equilibrium(&s, &rest);
    dmb_modes_options options = dmb_modes_options_default();
    options.axes = DMB_MODES_AXES_AT_REST;
    options.spin = speed;
    options.equilibrium_tolerance = 1e-4; /* the rest slips around the hole's axis, the pipes turn about their own */
    for (options.kind = DMB_MODES_UNDAMPED; options.kind <= DMB_MODES_DAMPED; options.kind++) {
        options.select = DMB_MODES_LOWEST;
        dmb_modes *few = find_modes(&s, &options);
        options.select = DMB_MODES_ALL;
        dmb_modes *all = find_modes(&s, &options);
        assert_int_equal(info_of(few).dense, 0);
        assert_int_equal(info_of(all).dense, 1);
        assert_true(info_of(all).asymmetry > 0.01);
        double worst = 0.0, whirl = 0.0;
        for (uint32_t i = 0; i < info_of(few).count; i++) {
            worst = fmax(worst, fabs(frequency_at(few, i) / frequency_at(all, i) - 1.0));
            whirl = fmax(whirl, fabs(mode_at(few, i).whirl - mode_at(all, i).whirl));
        }
        check_below(options.kind ? "damped: lowest ten against all" : "undamped: lowest ten against all", worst, 1e-8);
        check_below("    their whirl", whirl, 1e-6);
        dmb_modes_destroy(&few);
        dmb_modes_destroy(&all);
    }
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(whirl_of_a_shaft),
        cmocka_unit_test(whirl_converges),
        cmocka_unit_test(axes_that_turn_shift_by_the_speed),
        cmocka_unit_test(nutation_of_a_gyroscope),
        cmocka_unit_test(swing_of_a_pipe_that_turns_on_the_wall),
        cmocka_unit_test(few_and_all_of_a_turning_string),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
