/* A block on the floor of a wide hole. It is free to move but not to turn; its weight presses it against the wall,
 * where it starts at rest at the depth w/K. Coulomb friction stops it at v0/(mu g) after v0^2/(2 mu g). */
#include "contact_scene.h"

static const double g = 9.81;
static const double stiffness = 1e8;

/* Mass 1 kg, speed v along the hole, gravity tilted by `slope` [rad] from the vertical towards +x. */
static dmb_id block(rig *scene, dmb_wall_def *wall, double slope, double v, const dmb_sim_options *options)
{
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_body_def body = scene_ball(1.0, -g * cos(slope) / stiffness, DMB_FREE_X | DMB_FREE_Y | DMB_FREE_Z);
    wall->diameter = 4.1;
    wall->normal_law = DMB_NORMAL_HUNT_CROSSLEY;
    wall->stiffness = stiffness;
    body.velocity[0] = v;
    environment.gravity[0] = g * sin(slope);
    environment.gravity[2] = -g * cos(slope);
    scene_open(scene, g);
    scene_must(scene, dmb_model_set_environment(scene->model, &environment));
    add_wall(scene, wall);
    const dmb_id id = add_body(scene, &body);
    rig_start_with(scene, NULL, options);
    return id;
}

static dmb_wall_def friction(int32_t law, double mu_s, double mu_d)
{
    dmb_wall_def wall = dmb_wall_def_default();
    wall.friction_law = law;
    wall.mu_static = mu_s;
    wall.mu_dynamic = mu_d;
    wall.smoothing_speed = 1e-7;
    wall.bristle_stiffness = 1e6;
    wall.bristle_damping = 300.0; /* half of what is critical under the weight, 2 sqrt(sigma0/g) */
    return wall;
}

/* Friction sets in at once at time 0, or over mu/sigma0 = .3 um; steps of about 1 us there keep that to 1e-6. */
static dmb_sim_options fine_options(void)
{
    dmb_sim_options options = dmb_sim_options_default();
    options.tolerance_translation = 1e-12;
    options.newton_tolerance = 1e-11;
    return options;
}

/* Time at which the speed first reaches zero, by a straight line between two instants. */
static double stop_of(rig *scene, dmb_id id)
{
    double t = 0.67, v = 0.0;
    scene_advance(scene, t);
    for (;;) {
        v = scene_speed(scene, id, DMB_X);
        scene_advance(scene, t + 1e-5);
        const double next = scene_speed(scene, id, DMB_X);
        if (next < 1e-6) return t + 1e-5 * v / (v - next);
        t += 1e-5;
        assert_true(t < 0.7);
    }
}

/* CASES: mu .3, v0 2 m/s: .679578661 s and .679578661 m; 1e-5. Smoothed and with bristles. */
static void stops(void **state)
{
    static const int32_t laws[] = {DMB_FRICTION_COULOMB, DMB_FRICTION_STRIBECK, DMB_FRICTION_BRISTLE};
    (void)state;
    for (int i = 0; i < 3; i++) {
        dmb_wall_def wall = friction(laws[i], 0.3, 0.3);
        const dmb_sim_options options = fine_options();
        rig scene;
        const dmb_id id = block(&scene, &wall, 0.0, 2.0, &options);
        const double stop = stop_of(&scene, id);
        scene_advance(&scene, 1.0);
        const double way = scene_displacement(&scene, id, 0);
        print_message("law %d: %.9f s, %.9f m\n", laws[i], stop, way);
        CHECK_RELATIVE(stop, 0.679578661, 1e-5);
        CHECK_RELATIVE(way, 0.679578661, 1e-5);
        CHECK_BELOW(fabs(scene_speed(&scene, id, DMB_X)), 1e-6);
        const dmb_energy energy = energy_of(&scene);
        CHECK_RELATIVE(energy.friction, 2.0, 1e-5); /* all of m v0^2/2 */
        CHECK_BELOW(fabs(energy.unexplained), 1e-8);
        rig_close(&scene);
    }
}

/* Ambrosio's law rubs less below full_speed: the last stretch is v' = -mu g (v - v0)/(v1 - v0), which ends at v0. */
static void ambrosio_lets_go(void **state)
{
    dmb_wall_def wall = friction(DMB_FRICTION_AMBROSIO, 0.3, 0.3);
    const dmb_sim_options options = fine_options();
    rig scene;
    (void)state;
    wall.smoothing_speed = 0.01;
    wall.full_speed = 0.02;
    const dmb_id id = block(&scene, &wall, 0.0, 2.0, &options);
    const double full = (2.0 - 0.02) / (0.3 * g), decay = 0.3 * g / 0.01;
    scene_advance(&scene, full + 2.0 / decay);
    CHECK_RELATIVE(scene_speed(&scene, id, DMB_X), 0.01 + 0.01 * exp(-2.0), 1e-5);
    scene_advance(&scene, full + 30.0 / decay);
    CHECK_RELATIVE(scene_speed(&scene, id, DMB_X), 0.01, 1e-5);
    rig_close(&scene);
}

/* CASES: 20 degrees at mu .4 sticks. Bristles hold without creep: after the first swing has died out the block does not
 * move in 10 s, and stands tan(20 deg)/sigma0 down the slope. */
static void sticks_on_incline(void **state)
{
    const double slope = 20.0 * PI / 180.0;
    dmb_wall_def wall = friction(DMB_FRICTION_BRISTLE, 0.4, 0.4);
    dmb_sim_options options = fine_options();
    rig scene;
    (void)state;
    wall.bristle_stiffness = 1e5;
    wall.bristle_damping = 5e2; /* no overshoot beyond mu at the start: damping ratio 2.4 */
    options.newton_tolerance = 1e-12;
    const dmb_id id = block(&scene, &wall, slope, 0.0, &options);
    scene_advance(&scene, 1.0);
    const double early = scene_displacement(&scene, id, 0);
    scene_advance(&scene, 10.0);
    const double late = scene_displacement(&scene, id, 0);
    const dmb_contact contact = scene_contact(&scene, 0);
    print_message("stands at %.9e m, creep in 9 s %.2e m\n", late, late - early);
    CHECK_CLOSE(late, early, 1e-13);
    CHECK_RELATIVE(late, tan(slope) / 1e5, 1e-6); /* 4e-7: bristles add up speeds, the pose does better */
    assert_int_equal(contact.sticks, 1);
    CHECK_RELATIVE(contact.friction[0], -g * sin(slope), 1e-7);
    rig_close(&scene);
}

/* On a slope steeper than mu_s it slides at a = g (sin - mu cos). Bristles without damping first swing as a spring, x =
 * A (1 - cos w t) with A = tan/sigma0, w^2 = g cos sigma0, and let go at x = mu/sigma0. */
static void slides_on_steep_incline(void **state)
{
    static const int32_t laws[] = {DMB_FRICTION_COULOMB, DMB_FRICTION_BRISTLE};
    const double slope = 25.0 * PI / 180.0, a = g * (sin(slope) - 0.4 * cos(slope));
    const double w = sqrt(g * cos(slope) * 1e6), c = 1.0 - 0.4 / tan(slope);
    const double let_go = tan(slope) * 1e-6 * w * sqrt(1.0 - c * c) - a * acos(c) / w;
    (void)state;
    for (int i = 0; i < 2; i++) {
        dmb_wall_def wall = friction(laws[i], 0.4, 0.4);
        const dmb_sim_options options = fine_options();
        rig scene;
        wall.bristle_damping = 0.0;
        const dmb_id id = block(&scene, &wall, slope, 0.0, &options);
        scene_advance(&scene, 1.0);
        print_message("law %d: %.9f m/s\n", laws[i], scene_speed(&scene, id, DMB_X));
        CHECK_RELATIVE(scene_speed(&scene, id, DMB_X), a + (laws[i] == DMB_FRICTION_BRISTLE ? let_go : 0.0), 1e-5);
        rig_close(&scene);
    }
}

/* A smoothed law creeps under load, as documented: mu v/s = tan(slope) with s^2 = v^2 + v_eps^2 gives the speed. */
static void smoothed_law_creeps(void **state)
{
    const double slope = 20.0 * PI / 180.0, k = tan(slope);
    dmb_wall_def wall = friction(DMB_FRICTION_COULOMB, 0.4, 0.4);
    rig scene;
    (void)state;
    wall.smoothing_speed = 1e-3;
    const dmb_id id = block(&scene, &wall, slope, 0.0, NULL);
    scene_advance(&scene, 10.0);
    CHECK_RELATIVE(scene_speed(&scene, id, DMB_X), 1e-3 * k / sqrt(0.16 - k * k), 1e-6);
    rig_close(&scene);
}

/* CASES: v_ax .05 m/s, 200 rpm, R .0365 m: friction acts against the sliding velocity, so its axial share is
 * .05/|(.05, omega R)| = .06526669; 1e-6. */
static void direction(void **state)
{
    dmb_wall_def wall = friction(DMB_FRICTION_COULOMB, 0.3, 0.3);
    dmb_body_def body = scene_ball(1.0, -1e-3, DMB_FREE_ALL);
    rig scene;
    (void)state;
    wall.normal_law = DMB_NORMAL_HUNT_CROSSLEY;
    wall.diameter = 4.0 + 2.0 * 0.0365;
    body.contact_diameter = 2.0 * 0.0365;
    body.velocity[0] = 0.05;
    body.velocity[3] = 200.0 * 2.0 * PI / 60.0;
    scene_open(&scene, g);
    add_wall(&scene, &wall);
    add_body(&scene, &body);
    rig_start_with(&scene, NULL, NULL);
    const dmb_contact contact = scene_contact(&scene, 0);
    const double size = hypot(contact.friction[0], contact.friction[1]);
    CHECK_RELATIVE(size, 0.3 * contact.normal_force, 1e-12);
    CHECK_CLOSE(-contact.friction[0] / size, 0.06526669, 5.1e-9);
    CHECK_CLOSE(contact.slip[0], 0.05, 1e-15);
    CHECK_CLOSE(fabs(contact.slip[1]), 0.0365 * body.velocity[3], 1e-15);
    assert_true(contact.friction[1] * contact.slip[1] < 0.0);
    rig_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stops),
        cmocka_unit_test(ambrosio_lets_go),
        cmocka_unit_test(sticks_on_incline),
        cmocka_unit_test(slides_on_steep_incline),
        cmocka_unit_test(smoothed_law_creeps),
        cmocka_unit_test(direction),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
