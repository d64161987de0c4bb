/* The energy ledger: the balance closes up to what the time integration takes, that part falls with the step as its
 * order says, and each term is what its force does. balance = drives + loads - friction - impact - damping - rock -
 * change of energy = scheme + unexplained unexplained is the residual's own work; with Newton's tolerance eps it stays
 * below eps times the work that is done. */
#include "contact_scene.h"

static double relative(double x, double scale)
{
    return fabs(x) / scale;
}

static double sum_of_works(const dmb_energy *e)
{
    return fabs(e->drives) + fabs(e->loads) + fabs(e->friction) + fabs(e->impact) + fabs(e->damping) + fabs(e->rock) +
           fabs(e->kinetic) + fabs(e->strain) + fabs(e->gravity) + fabs(e->contact);
}

static void check_closed(const dmb_energy *e, double tolerance)
{
    CHECK_CLOSE(e->balance, e->scheme + e->unexplained, 1e-12 * sum_of_works(e));
    CHECK_BELOW(relative(e->unexplained, sum_of_works(e)), tolerance);
}

/* ---- A rig with everything in it --------------------------------------------------------------------------------- */

static dmb_energy run_rig(double h, double newton_tolerance, int32_t friction_law)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_environment_def environment = dmb_environment_def_default();
    const dmb_segment feed = scene_step_segment(0.0, 0.0, 0.1, 0.01), turn = scene_step_segment(0.0, 0.0, 0.1, 20.0);
    const dmb_segment push = scene_step_segment(0.05, 0.0, 0.15, 1.0);
    dmb_sim_options options = dmb_sim_options_default();
    rig scene;
    options.newton_tolerance = newton_tolerance;
    environment.lateral_damping = environment.axial_damping = environment.torsional_damping = 5.0;
    wall.friction_law = friction_law;
    pipe.eccentricity = 1e-3;
    pipe.damping_time = 1e-4;
    bit.rock_law = DMB_ROCK_RATE;
    bit.bottom = 5e-4;
    scene_open(&scene, 9.81);
    scene_must(&scene, dmb_model_set_environment(scene.model, &environment));
    add_wall(&scene, &wall);
    const dmb_id id = add_pipes(&scene, &pipe, 10);
    scene_add_bit(&scene, &bit);
    load.place = dmb_station(id, 4, 1.0);
    load.force[1] = 200.0;
    load.time_function = add_time_function(&scene, &push, 1);
    add_load(&scene, &load);
    drive.time_function = add_time_function(&scene, &feed, 1);
    add_drive(&scene, &drive);
    drive.component = DMB_RX;
    drive.time_function = add_time_function(&scene, &turn, 1);
    add_drive(&scene, &drive);
    rig_start_with(&scene, NULL, &options);
    for (int i = 0; i < (int)(0.25 / h + 0.5); i++) scene_step(&scene, h);
    const dmb_energy energy = energy_of(&scene);
    rig_close(&scene);
    return energy;
}

static void rig_closes(void **state)
{
    static const int32_t laws[] = {DMB_FRICTION_STRIBECK, DMB_FRICTION_BRISTLE};
    (void)state;
    for (int k = 0; k < 2; k++) {
        const dmb_energy e = run_rig(1e-4, 1e-8, laws[k]);
        print_message("rig: drives %.4f loads %.4f friction %.4f impact %.4f damping %.4f rock %.4f scheme %.2e "
                      "unexplained %.2e of %.3f J\n",
                      e.drives, e.loads, e.friction, e.impact, e.damping, e.rock, e.scheme, e.unexplained,
                      sum_of_works(&e));
        check_closed(&e, 1e-7);
        assert_true(e.drives > 0.0 && e.friction > 0.0 && e.impact > 0.0 && e.damping > 0.0 && e.rock > 0.0);
        assert_true(e.loads > 0.0 && e.input >= e.drives + e.loads);
        CHECK_RELATIVE(e.error, fabs(e.balance) / e.input, 1e-12);
        CHECK_BELOW(relative(e.scheme, sum_of_works(&e)), 2e-2);
    }
}

/* A tighter Newton tolerance leaves less unexplained. */
static void unexplained_follows_newton(void **state)
{
    (void)state;
    const dmb_energy loose = run_rig(1e-4, 1e-4, DMB_FRICTION_STRIBECK);
    const dmb_energy tight = run_rig(1e-4, 1e-10, DMB_FRICTION_STRIBECK);
    print_message("unexplained: %.2e J at 1e-4, %.2e J at 1e-10\n", loose.unexplained, tight.unexplained);
    check_closed(&tight, 1e-9);
    CHECK_BELOW(fabs(tight.unexplained), fabs(loose.unexplained));
}

/* ---- Order of the scheme's part ---------------------------------------------------------------------------------- */

/* Pipe S1 in free flight with vibration, no damping: what the scheme takes within .05 s. */
static double scheme_of_vibration(double h, double radius)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_load_def load = dmb_load_def_default();
    const dmb_segment pulse[2] = {scene_step_segment(0.0, 0.0, 0.01, 1.0), scene_step_segment(0.01, 0.0, 0.02, -1.0)};
    dmb_sim_options options = dmb_sim_options_default();
    rig scene;
    options.spectral_radius = radius;
    options.newton_tolerance = 1e-12;
    string.start_free = DMB_FREE_NONE;
    pipe.length = 10.0;
    pipe.elements = 4;
    scene_open(&scene, 0.0);
    add_string(&scene, &string);
    const dmb_id id = add_pipes(&scene, &pipe, 1);
    load.place = dmb_station(id, 0, 1.0);
    load.force[1] = 100.0;
    load.time_function = add_time_function(&scene, pulse, 2);
    add_load(&scene, &load);
    rig_start_with(&scene, NULL, &options);
    for (int i = 0; i < (int)(0.5 / h + 0.5); i++) scene_step(&scene, h);
    const dmb_energy e = energy_of(&scene);
    check_closed(&e, 1e-9);
    rig_close(&scene);
    return e.scheme / e.loads;
}

static void scheme_falls_with_the_step(void **state)
{
    double last = 0.0;
    (void)state;
    for (int k = 0; k < 4; k++) {
        const double h = 4e-4 / pow(2.0, k), part = scheme_of_vibration(h, 0.8);
        print_message("step %g: scheme %.4e of the work put in\n", h, part);
        if (k > 1) assert_true(fabs(last / part) > 3.0); /* second order or better */
        last = part;
    }
    CHECK_BELOW(fabs(last), 1e-3);
}

/* Radius 1, no damping, no friction: kinetic and strain energy stay together. */
static void undamped_keeps_energy(void **state)
{
    (void)state;
    CHECK_BELOW(fabs(scheme_of_vibration(1e-4, 1.0)), 1e-3);
    CHECK_BELOW(fabs(scheme_of_vibration(2.5e-5, 1.0)), 1e-4);
}

/* Hard case 12 in small: a linear axial-torsional bar over 1e5 steps with radius 1, energy to 1e-9. */
static void linear_bar_keeps_energy(void **state)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    rig scene;
    double low = 1e300, high = 0.0;
    (void)state;
    options.spectral_radius = 1.0;
    options.newton_tolerance = 1e-14;
    string.start_free = DMB_FREE_NONE;
    string.velocity[0] = 0.0;
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    scene_open(&scene, 0.0);
    add_string(&scene, &string);
    const dmb_id id = add_pipes(&scene, &pipe, 10);
    dmb_load_def load = dmb_load_def_default();
    const dmb_segment pulse[2] = {scene_step_segment(0.0, 0.0, 0.005, 1.0), scene_step_segment(0.005, 0.0, 0.01, -1.0)};
    load.place = dmb_station(id, 9, 1.0);
    load.force[0] = 1e5;
    load.moment[0] = 1e3;
    load.time_function = add_time_function(&scene, pulse, 2);
    add_load(&scene, &load);
    rig_start_with(&scene, NULL, &options);
    while (dmb_sim_time(scene.sim) < 0.0101) scene_step(&scene, 1e-4);
    for (int i = 0; i < 100000; i++) {
        scene_step(&scene, 1e-4);
        if (i % 100) continue;
        const double energy = scene_total_energy(&scene);
        low = fmin(low, energy);
        high = fmax(high, energy);
    }
    print_message("linear bar: energy within %.2e over 1e5 steps\n", (high - low) / high);
    CHECK_BELOW((high - low) / high, 1e-9);
    rig_close(&scene);
}

/* ---- Single terms ------------------------------------------------------------------------------------------------ */

/* A block pushed along the wall by a load against friction: loads = friction + kinetic, and friction = mu N way. */
static void friction_work(void **state)
{
    dmb_wall_def wall = scene_wide_wall(DMB_NORMAL_HUNT_CROSSLEY, 1e8, 1.0, 0.5);
    dmb_body_def body = scene_ball(1.0, -9.81e-8, DMB_FREE_X | DMB_FREE_Y | DMB_FREE_Z);
    dmb_load_def load = dmb_load_def_default();
    rig scene;
    (void)state;
    wall.friction_law = DMB_FRICTION_COULOMB;
    wall.mu_static = wall.mu_dynamic = 0.3;
    wall.smoothing_speed = 1e-6;
    body.velocity[0] = 1.0;
    scene_open(&scene, 9.81);
    add_wall(&scene, &wall);
    const dmb_id id = add_body(&scene, &body);
    load.place = dmb_station(id, 0, 0.0);
    load.force[0] = 5.0;
    add_load(&scene, &load);
    rig_start_with(&scene, NULL, NULL);
    for (int i = 0; i < 1000; i++) scene_step(&scene, 1e-3);
    const dmb_energy e = energy_of(&scene);
    const double way = scene_displacement(&scene, id, 0);
    CHECK_RELATIVE(e.friction, 0.3 * 9.81 * way, 1e-6);
    CHECK_RELATIVE(e.loads, 5.0 * way, 1e-6);
    CHECK_RELATIVE(e.kinetic - 0.5, e.loads - e.friction, 1e-6);
    check_closed(&e, 1e-9);
    rig_close(&scene);
}

/* One impact takes (1 - e^2) of the energy of arrival, whatever the law asks for. */
static void impact_loss(void **state)
{
    static const double asked[] = {0.1, 0.5, 0.9, 1.0};
    (void)state;
    for (int k = 0; k < 4; k++) {
        const dmb_wall_def wall = scene_wide_wall(DMB_NORMAL_EXACT, 1e7, 1.5, asked[k]);
        dmb_body_def ball = scene_ball(2.0, 0.01, DMB_FREE_Z);
        dmb_sim_options options = dmb_sim_options_default();
        rig scene;
        options.tolerance_translation = 1e-12;
        options.step_min = 1e-13;
        options.newton_tolerance = 1e-8; /* what iterations leave is looked at by itself */
        ball.velocity[2] = -3.0;
        scene_open(&scene, 0.0);
        add_wall(&scene, &wall);
        add_body(&scene, &ball);
        rig_start_with(&scene, NULL, &options);
        scene_advance(&scene, 0.1);
        const dmb_energy e = energy_of(&scene);
        CHECK_CLOSE(e.impact, 9.0 * (1.0 - asked[k] * asked[k]), 1e-5 * 9.0);
        CHECK_CLOSE(e.kinetic, 9.0 * asked[k] * asked[k], 1e-5 * 9.0);
        CHECK_CLOSE(e.contact, 0.0, 0.0);
        check_closed(&e, 1e-9);
        rig_close(&scene);
    }
}

/* Lifted at constant speed by a motion drive: drives = weight times way; turned up to speed: J w^2/2. */
static void drive_work(void **state)
{
    dmb_body_def body = dmb_body_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_drive_state told = dmb_drive_state_default();
    const dmb_segment up = scene_step_segment(0.0, 0.0, 0.5, 2.0);
    rig scene;
    (void)state;
    body.mass = 3.0;
    body.free_mask = DMB_FREE_Z;
    scene_open(&scene, 9.81);
    drive.part = add_body(&scene, &body);
    drive.component = DMB_Z;
    drive.time_function = add_time_function(&scene, &up, 1);
    const dmb_id id = add_drive(&scene, &drive);
    rig_start_with(&scene, NULL, NULL);
    for (int i = 0; i < 1000; i++) scene_step(&scene, 1e-3);
    const dmb_energy e = energy_of(&scene);
    CHECK_RELATIVE(scene_displacement(&scene, drive.part, 2), 1.5, 1e-12); /* .5 on the way up, 1 after it */
    CHECK_RELATIVE(e.gravity, 3.0 * 9.81 * 1.5, 1e-12);
    CHECK_RELATIVE(e.kinetic, 6.0, 1e-12);
    CHECK_RELATIVE(e.drives, e.gravity + e.kinetic, 1e-5);
    assert_int_equal(dmb_query_drive(scene.sim, id, &told), DMB_OK);
    CHECK_RELATIVE(told.work, e.drives, 1e-12);
    CHECK_RELATIVE(told.force, 3.0 * 9.81, 1e-12);
    CHECK_RELATIVE(told.power, 2.0 * told.force, 1e-12);
    CHECK_RELATIVE(told.position, 1.5, 1e-12);
    check_closed(&e, 1e-12);
    rig_close(&scene);
}

/* A speed control brings a rotor up: what it gives is in the rotor and nowhere else. */
static void control_work(void **state)
{
    dmb_body_def body = dmb_body_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    rig scene;
    (void)state;
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.2;
    body.free_mask = DMB_FREE_RX;
    scene_open(&scene, 0.0);
    drive.kind = DMB_DRIVE_CONTROL;
    drive.part = add_body(&scene, &body);
    drive.component = DMB_RX;
    drive.gain = 1.0;
    drive.integral_gain = 0.5;
    drive.time_function = add_constant(&scene, 30.0);
    add_drive(&scene, &drive);
    rig_start_with(&scene, NULL, NULL);
    for (int i = 0; i < 2000; i++) scene_step(&scene, 1e-3);
    const dmb_energy e = energy_of(&scene);
    CHECK_RELATIVE(e.drives, e.kinetic, 1e-5);
    CHECK_RELATIVE(e.kinetic, 0.1 * pow(scene_speed(&scene, drive.part, DMB_RX), 2.0), 1e-12);
    check_closed(&e, 1e-9);
    rig_close(&scene);
}

/* External damping of a sliding pipe: v = v0 exp(-c t/m), and damping takes what the motion loses. */
static void damping_work(void **state)
{
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_motion motion = dmb_motion_default();
    rig scene;
    (void)state;
    environment.axial_damping = 10.0;
    string.velocity[0] = 2.0;
    string.start_free = string.end_free = DMB_FREE_ALL;
    scene_open(&scene, 0.0);
    environment.gravity[2] = 0.0;
    scene_must(&scene, dmb_model_set_environment(scene.model, &environment));
    add_string(&scene, &string);
    const dmb_id id = add_pipes(&scene, &pipe, 4);
    rig_start_with(&scene, NULL, NULL);
    for (int i = 0; i < 1000; i++) scene_step(&scene, 1e-3);
    const dmb_energy e = energy_of(&scene);
    const double mass = scene_info(&scene).mass, decay = exp(-10.0 * 4.0 / mass);
    assert_int_equal(dmb_query_motion(scene.sim, dmb_station(id, 2, 0.0), &motion), DMB_OK);
    CHECK_RELATIVE(motion.velocity[0], 2.0 * decay, 1e-6);
    CHECK_RELATIVE(e.damping, 0.5 * mass * 4.0 * (1.0 - decay * decay), 1e-5);
    check_closed(&e, 1e-9);
    rig_close(&scene);
}

/* The ledger can be left out: no answer then, and less memory. */
static void left_out(void **state)
{
    dmb_sim_options options = dmb_sim_options_default();
    dmb_energy energy = dmb_energy_default();
    const dmb_body_def body = dmb_body_def_default();
    rig scene;
    (void)state;
    options.energy_ledger = 0;
    scene_open(&scene, 9.81);
    add_body(&scene, &body);
    rig_start_with(&scene, NULL, &options);
    scene_step(&scene, 1e-3);
    assert_int_equal(dmb_query_energy(scene.sim, &energy), DMB_ERR_UNSUPPORTED);
    rig_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rig_closes),
        cmocka_unit_test(unexplained_follows_newton),
        cmocka_unit_test(scheme_falls_with_the_step),
        cmocka_unit_test(undamped_keeps_energy),
        cmocka_unit_test(linear_bar_keeps_energy),
        cmocka_unit_test(friction_work),
        cmocka_unit_test(impact_loss),
        cmocka_unit_test(drive_work),
        cmocka_unit_test(control_work),
        cmocka_unit_test(damping_work),
        cmocka_unit_test(left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
