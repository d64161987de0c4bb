/* Momentum of a system that nothing acts on is constant; what acts on it changes it by its impulse. */
#include "contact_scene.h"

/* Flexible and rigid pipes, an eccentric mass and a bit, thrown with v (1, 2, 3) and omega (20, 0, 6). */
static void build(rig *scene, double g, double radius)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_body_def head = dmb_body_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    const double velocity[6] = {1.0, 2.0, 3.0, 20.0, 0.0, 6.0};
    memcpy(string.velocity, velocity, sizeof velocity);
    string.start_free = string.end_free = DMB_FREE_ALL;
    pipe.length = 1.5;
    pipe.elements = 2;
    pipe.eccentricity = 1e-3;
    head.attach = DMB_ATTACH_START;
    head.mass = 4.0;
    head.centre[1] = 0.05;
    options.spectral_radius = radius;
    options.newton_tolerance = 1e-12;
    scene_open(scene, g);
    add_string(scene, &string);
    add_pipes(scene, &pipe, 2);
    pipe.kind = DMB_PIPE_RIGID;
    pipe.length = 0.5;
    add_pipes(scene, &pipe, 1);
    add_body(scene, &head);
    scene_add_bit(scene, &bit);
    rig_start_with(scene, NULL, &options);
}

static double norm(const double a[3])
{
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

static double change(const double a[3], const double b[3])
{
    const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return norm(d);
}

typedef struct drift {
    double linear, angular, energy; /* [-] largest change over .2 s, relative */
} drift;

static drift free_flight(double h)
{
    drift most = {0.0, 0.0, 0.0};
    rig scene;
    build(&scene, 0.0, 0.9);
    const dmb_momentum start = momentum_of(&scene);
    const double energy = scene_total_energy(&scene);
    for (int i = 0; i < (int)(0.2 / h + 0.5); i++) {
        scene_step(&scene, h);
        const dmb_momentum now = momentum_of(&scene);
        most.linear = fmax(most.linear, change(now.linear, start.linear) / norm(start.linear));
        most.angular = fmax(most.angular, change(now.angular, start.angular) / norm(start.angular));
        most.energy = fmax(most.energy, fabs(scene_total_energy(&scene) / energy - 1.0));
    }
    rig_close(&scene);
    return most;
}

/* Drift below 1e-3 at 1e-3 s and second order in the step (CASES: free flight). */
static void constant_in_free_flight(void **state)
{
    drift last = {0.0, 0.0, 0.0};
    (void)state;
    for (int k = 0; k < 3; k++) {
        const drift d = free_flight(1e-3 / pow(2.0, k));
        print_message("step %g: linear %.2e, angular %.2e, energy %.2e\n", 1e-3 / pow(2.0, k), d.linear, d.angular,
                      d.energy);
        CHECK_BELOW(d.linear, 1e-3);
        CHECK_BELOW(d.angular, 1e-3);
        CHECK_BELOW(d.energy, 1e-3);
        if (k > 0) {
            assert_true(last.linear / d.linear > 3.5);
            assert_true(last.angular / d.angular > 3.5);
        }
        last = d;
    }
}

/* Under its weight the momentum grows by m g t, the centre of mass flies on a parabola. */
static void falls_on_a_parabola(void **state)
{
    rig scene;
    (void)state;
    build(&scene, 9.81, 0.9);
    const dmb_momentum start = momentum_of(&scene);
    for (int i = 0; i < 2000; i++) scene_step(&scene, 1e-4);
    const dmb_momentum now = momentum_of(&scene);
    const double t = dmb_sim_time(scene.sim);
    CHECK_RELATIVE(now.mass, scene_info(&scene).mass, 1e-13);
    for (int i = 0; i < 3; i++) {
        const double g = i == 2 ? -9.81 : 0.0, v = start.linear[i] / start.mass;
        CHECK_CLOSE(now.linear[i], start.linear[i] + now.mass * g * t, 1e-5 * norm(start.linear));
        CHECK_CLOSE(now.centre[i], start.centre[i] + v * t + 0.5 * g * t * t, 1e-5);
    }
    rig_close(&scene);
}

/* A wall gives what it takes: a flat impact turns the momentum across it round by 1 + e, and leaves that along it. */
static void impulse_of_the_wall(void **state)
{
    const dmb_wall_def wall = scene_wide_wall(DMB_NORMAL_EXACT, 1e7, 1.0, 0.6);
    dmb_body_def ball = scene_ball(2.0, 0.01, DMB_FREE_X | DMB_FREE_Y | DMB_FREE_Z);
    dmb_sim_options options = dmb_sim_options_default();
    rig scene;
    (void)state;
    options.tolerance_translation = 1e-11;
    options.step_min = 1e-12;
    ball.velocity[0] = 1.0;
    ball.velocity[2] = -2.0;
    scene_open(&scene, 0.0);
    add_wall(&scene, &wall);
    add_body(&scene, &ball);
    rig_start_with(&scene, NULL, &options);
    scene_advance(&scene, 0.1);
    const dmb_momentum now = momentum_of(&scene);
    CHECK_RELATIVE(now.linear[0], 2.0, 1e-12);
    CHECK_CLOSE(now.linear[1], 0.0, 1e-12);
    CHECK_RELATIVE(now.linear[2], 2.0 * 2.0 * 0.6, 1e-5);
    rig_close(&scene);
}

/* A rolling ring: friction at the rim gives linear momentum as it takes spin, R dp = -dL, until v = -omega R. In a hole
 * of 100 m radius the floor is level within the few centimetres that this takes. */
static void friction_couples_spin_and_travel(void **state)
{
    dmb_wall_def wall = scene_wide_wall(DMB_NORMAL_HUNT_CROSSLEY, 1e7, 1.0, 0.5);
    dmb_body_def ring = scene_ball(2.0, -2.0 * 9.81 / 1e7, DMB_FREE_Y | DMB_FREE_Z | DMB_FREE_RX);
    rig scene;
    (void)state;
    wall.friction_law = DMB_FRICTION_COULOMB;
    wall.smoothing_speed = 1e-4;
    wall.diameter = 200.1;
    ring.position[2] = -100.0 - 2.0 * 9.81 / 1e7;
    ring.inertia[0] = 5e-3; /* a ring: m R^2, half of it across */
    ring.inertia[1] = ring.inertia[2] = 2.5e-3;
    ring.velocity[3] = 10.0;
    scene_open(&scene, 9.81);
    add_wall(&scene, &wall);
    const dmb_id id = add_body(&scene, &ring);
    rig_start_with(&scene, NULL, NULL);
    for (int i = 0; i < 1000; i++) scene_step(&scene, 1e-4);
    const double v = scene_speed(&scene, id, DMB_Y), w = scene_speed(&scene, id, DMB_RX);
    CHECK_RELATIVE(w, 5.0, 2e-3); /* half of the spin is left, the other half became travel */
    CHECK_RELATIVE(fabs(v), 0.05 * 5.0, 1e-2);
    assert_true(v < 0.0); /* turning from y to z, the lowest point moves to +y, friction pushes to -y */
    rig_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(constant_in_free_flight),
        cmocka_unit_test(falls_on_a_parabola),
        cmocka_unit_test(impulse_of_the_wall),
        cmocka_unit_test(friction_couples_spin_and_travel),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
