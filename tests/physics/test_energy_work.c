/* Work that the ledger counts is the work that the integrator does (eq:motion.work): at spectral radius 1 a
 * linear structure with any friction, dampers and controllers balances to rounding at every step length; a ring that
 * whirls backward on the wall and leaves it balances within a thousandth. Checks eq:motion.force-recursion and
 * eq:motion.trapezoid-excess. */
#include "contact_scene.h"

/* ---- Bars with friction, dampers, a controller, and rock --------------------------------------------------------- */

/* A horizontal string of bars on the floor of its hole, pushed and turned by speed control from rest. */
static dmb_energy run_bars(double h, double radius, int32_t friction, int32_t rock)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_body_def head = dmb_body_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    rig scene;
    options.newton_tolerance = 1e-13;
    options.spectral_radius = radius;
    environment.axial_damping = environment.torsional_damping = 20.0;
    wall.friction_law = friction;
    wall.smoothing_speed = 1e-2;
    wall.full_speed = 2e-2;
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    pipe.damping_time = 2e-4;
    scene_open(&scene, 9.81);
    scene_must(&scene, dmb_model_set_environment(scene.model, &environment));
    add_wall(&scene, &wall);
    string.start_free = DMB_FREE_X | DMB_FREE_RX;
    add_string(&scene, &string);
    add_pipes(&scene, &pipe, 6);
    head.attach = DMB_ATTACH_START;
    head.mass = 50.0;
    for (int i = 0; i < 3; i++) head.inertia[i] = 1.0;
    add_body(&scene, &head);
    bit.rock_law = rock;
    bit.bottom = 1e-3;
    scene_add_bit(&scene, &bit);
    drive.kind = DMB_DRIVE_CONTROL;
    drive.gain = 2e5;
    drive.integral_gain = 1e6;
    drive.time_function = add_constant(&scene, 0.02);
    add_drive(&scene, &drive);
    drive.component = DMB_RX;
    drive.gain = 500.0;
    drive.integral_gain = 5000.0;
    drive.time_function = add_constant(&scene, 8.0);
    add_drive(&scene, &drive);
    rig_start_with(&scene, NULL, &options);
    while (dmb_sim_time(scene.sim) < 0.2) scene_step(&scene, h);
    const dmb_energy e = energy_of(&scene);
    rig_close(&scene);
    return e;
}

/* Newmark's rule with (f0 + f1)/2 changes kinetic and strain energy by exactly the work of all other forces. */
static void bars_balance_to_rounding(void **state)
{
    static const int32_t laws[] = {DMB_FRICTION_NONE, DMB_FRICTION_COULOMB, DMB_FRICTION_STRIBECK,
                                   DMB_FRICTION_AMBROSIO, DMB_FRICTION_BRISTLE};
    (void)state;
    for (int k = 0; k < 5; k++)
        for (double h = 1e-4; h < 4e-3; h *= 3.0) {
            const dmb_energy e = run_bars(h, 1.0, laws[k], DMB_ROCK_NONE);
            print_message("friction law %d, step %g: drives %.4f friction %.4f damping %.4f J, error %.2e\n", laws[k],
                          h, e.drives, e.friction, e.damping, e.error);
            CHECK_BELOW(e.error, 1e-9);
            assert_true(e.drives > 0.0 && e.damping > 0.0 && (e.friction > 0.0) == (laws[k] != DMB_FRICTION_NONE));
        }
}

/* With the rock, too, whose step may be divided where it meets the bit. */
static void rock_balances(void **state)
{
    (void)state;
    for (double h = 1e-4; h < 2e-3; h *= 3.0) {
        const dmb_energy whole = run_bars(h, 1.0, DMB_FRICTION_STRIBECK, DMB_ROCK_RATE);
        const dmb_energy damped = run_bars(h, 0.8, DMB_FRICTION_STRIBECK, DMB_ROCK_RATE);
        print_message("rock, step %g: rock %.4f of %.4f J, error %.2e at spectral radius 1, %.2e at 0.8\n", h,
                      whole.rock, whole.input, whole.error, damped.error);
        CHECK_BELOW(whole.error, 1e-6);
        CHECK_BELOW(damped.error, 1e-2);
        assert_true(whole.rock > 0.05 * whole.input);
    }
}

/* ---- Backward whirl ---------------------------------------------------------------------------------------------- */

enum { BODY_RADIUS_MM = 40, CLEARANCE_MM = 8 };

/* A driven disc in a vertical hole, thrown at its wall: friction drives its centre backward until it rolls. Returns how
 * often the centre went round, against the rotation < 0. */
static double run_whirl(double h, double mu, int32_t law, int32_t friction, dmb_energy *e)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_body_def body = scene_ball(30.0, 0.0, DMB_FREE_Y | DMB_FREE_Z | DMB_FREE_RX);
    dmb_drive_def drive = dmb_drive_def_default();
    rig scene;
    double turns = 0.0, last = 0.0;
    wall.diameter = 2e-3 * (BODY_RADIUS_MM + CLEARANCE_MM);
    wall.normal_law = law;
    wall.stiffness = 2e7;
    wall.restitution = 0.5;
    wall.damping = 5e3;
    wall.friction_law = friction;
    wall.mu_static = wall.mu_dynamic = mu;
    body.contact_diameter = 2e-3 * BODY_RADIUS_MM;
    body.position[2] = 0.0;
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.03;
    body.velocity[1] = 0.3;
    body.velocity[3] = 15.0;
    scene_open(&scene, 0.0);
    add_wall(&scene, &wall);
    drive.part = add_body(&scene, &body);
    drive.kind = DMB_DRIVE_CONTROL;
    drive.component = DMB_RX;
    drive.gain = 200.0;
    drive.time_function = add_constant(&scene, 15.0);
    add_drive(&scene, &drive);
    rig_start_with(&scene, NULL, NULL);
    for (int i = 0; dmb_sim_time(scene.sim) < 1.0; i++) {
        scene_step(&scene, h);
        const double angle = atan2(scene_position(&scene, drive.part, 2), scene_position(&scene, drive.part, 1));
        if (i > 0) turns += remainder(angle - last, 2.0 * PI) / (2.0 * PI);
        last = angle;
    }
    *e = energy_of(&scene);
    rig_close(&scene);
    return turns;
}

/* The wall's spring takes four steps of 1 ms to throw the disc back; what the scheme loses in it is of second order. */
static double worst_whirl(double h)
{
    static const int32_t laws[] = {DMB_NORMAL_KELVIN_VOIGT, DMB_NORMAL_EXACT};
    static const int32_t frictions[] = {DMB_FRICTION_COULOMB, DMB_FRICTION_STRIBECK, DMB_FRICTION_BRISTLE};
    double worst = 0.0;
    for (int k = 0; k < 6; k++) {
        dmb_energy e;
        const double turns = run_whirl(h, 0.4, laws[k % 2], frictions[k / 2], &e);
        print_message("whirl, normal law %d, friction law %d, step %g: %.2f turns, drives %.2f friction %.2f impact "
                      "%.2f kinetic %.2f J, error %.2e\n",
                      laws[k % 2], frictions[k / 2], h, turns, e.drives, e.friction, e.impact, e.kinetic, e.error);
        assert_true(turns < -2.0 && e.friction > 0.1 * e.input);
        worst = fmax(worst, e.error);
    }
    return worst;
}

static void whirl_balances(void **state)
{
    (void)state;
    CHECK_BELOW(worst_whirl(2e-4), 1e-3);
    CHECK_BELOW(worst_whirl(5e-4), 5e-3);
    CHECK_BELOW(worst_whirl(1e-3), 2e-2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bars_balance_to_rounding),
        cmocka_unit_test(rock_balances),
        cmocka_unit_test(whirl_balances),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
