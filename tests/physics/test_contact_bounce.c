/* CASES: a ball dropped from h0 = 1 m on a floor of restitution .8 first meets it at sqrt(2 h0/g) = .451523640986 s,
 * rises to e^(2n) h0 after n impacts, and comes to rest after infinitely many at sqrt(2 h0/g) (1+e)/(1-e)
 * = 4.063712768872 s; 1e-3 for a compliant wall.
 *
 * The wall is stiff enough (1e10 N/m on 1 kg, contacts of 31 us) for their duration, about 0.9 pi sqrt(m/K) each, to
 * stay below 1e-3 s in all. The floor of the approach speed, 1e-5 m/s, is where the bounces end. */
#include "contact_scene.h"

static const double g = 9.81, e = 0.8;

typedef struct flight {
    rig scene;
    dmb_id ball;
} flight;

static void drop(flight *f, double tolerance)
{
    dmb_wall_def wall = scene_wide_wall(DMB_NORMAL_EXACT, 1e10, 1.0, e);
    const dmb_body_def ball = scene_ball(1.0, 1.0, DMB_FREE_Z);
    dmb_sim_options options = dmb_sim_options_default();
    options.tolerance_translation = tolerance;
    options.step_min = 1e-12;
    options.newton_tolerance = 1e-8; /* what iterations leave is looked at by itself */
    wall.approach_speed = 1e-5;
    scene_open(&f->scene, g);
    add_wall(&f->scene, &wall);
    f->ball = add_body(&f->scene, &ball);
    rig_start_with(&f->scene, NULL, &options);
}

static double height(const flight *f)
{
    return scene_contact(&f->scene, 0).gap;
}

/* Height of the top of the present parabola. */
static double apex(const flight *f)
{
    const double v = scene_speed(&f->scene, f->ball, DMB_Z);
    return height(f) + 0.5 * v * v / g;
}

/* Ideal times of the impacts, n = 1, 2, ... */
static double impact_time(int n)
{
    double t = sqrt(2.0 / g), bounce = 2.0 * e * t;
    for (int i = 1; i < n; i++, bounce *= e) t += bounce;
    return t;
}

static void first_impact(void **state)
{
    flight f;
    double before = 0.0, t = 0.45;
    (void)state;
    drop(&f, 1e-11);
    scene_advance(&f.scene, t);
    while (scene_contact(&f.scene, 0).closed == 0 && t < 0.46) {
        before = t - height(&f) / scene_speed(&f.scene, f.ball, DMB_Z); /* the rest of the way is 0.1 us long */
        scene_advance(&f.scene, t += 1e-5);
    }
    print_message("first impact %.12f s\n", before);
    CHECK_RELATIVE(impact_time(1), 0.451523640986, 1e-11);
    CHECK_RELATIVE(before, 0.451523640986, 1e-8); /* 1e-3 asked */
    rig_close(&f.scene);
}

/* Asked in the middle of each flight. */
static void apex_heights(void **state)
{
    flight f;
    (void)state;
    drop(&f, 1e-13);
    for (int n = 1; n <= 10; n++) {
        scene_advance(&f.scene, 0.5 * (impact_time(n) + impact_time(n + 1)));
        const double want = pow(e, 2.0 * n);
        CHECK_RELATIVE(apex(&f), want, 1e-3); /* the weight acts during the contact: g T/v, 8e-4 at n = 10 */
    }
    rig_close(&f.scene);
}

/* The last instant at which the ball is faster than 2e-4 m/s; the bounces left out take 2 v/(g (1-e)) = 2e-4 s. */
static void stop_time(void **state)
{
    flight f;
    double stop = 0.0;
    (void)state;
    drop(&f, 1e-11);
    for (double t = 3.9; t < 4.2; t += 1e-5) {
        scene_advance(&f.scene, t);
        if (fabs(scene_speed(&f.scene, f.ball, DMB_Z)) > 2e-4) stop = t;
    }
    const dmb_statistics statistics = statistics_of(&f.scene);
    print_message("stop %.9f s, %llu steps, %llu rejected\n", stop, (unsigned long long)statistics.steps,
                  (unsigned long long)statistics.rejected);
    CHECK_RELATIVE(stop, 4.063712768872, 1e-3);
    CHECK_CLOSE(height(&f), -g / 1e10, 1e-12); /* rests at m g/K */
    rig_close(&f.scene);
}

/* Each impact takes (1 - e^2) of the energy of arrival: the ledger's impact term after n of them is
 * m g h0 (1 - e^(2n)). */
static void energy_of_impacts(void **state)
{
    flight f;
    (void)state;
    drop(&f, 1e-13);
    for (int n = 1; n <= 8; n++) {
        scene_advance(&f.scene, 0.5 * (impact_time(n) + impact_time(n + 1)));
        const dmb_energy energy = energy_of(&f.scene);
        CHECK_RELATIVE(energy.impact, g * (1.0 - pow(e, 2.0 * n)), 1e-4);
        CHECK_CLOSE(energy.unexplained, 0.0, 1e-9 * g);
        CHECK_CLOSE(energy.scheme, 0.0, 1e-5 * g);
    }
    rig_close(&f.scene);
}

/* ---- Bounces that steps do not resolve --------------------------------------------------------------------------- */

/* [-] Largest energy of a ball that bounces between two sides, over its first; h w = per_period, w^2 = K l/m. */
static double largest_energy(int32_t law, double radius, double per_period)
{
    const double stiffness = 1e6, mass = 1.0, h = per_period / sqrt(stiffness / mass);
    dmb_sim_options options = dmb_sim_options_default();
    dmb_wall_def wall = scene_wide_wall(law, stiffness, 1.0, 0.4);
    dmb_body_def ball = scene_ball(mass, 0.0, DMB_FREE_Z);
    double most = 0.0;
    rig scene;
    options.spectral_radius = radius;
    wall.diameter = 0.2;
    ball.position[2] = 0.0;
    ball.velocity[2] = -1.0;
    scene_open(&scene, 0.0);
    add_wall(&scene, &wall);
    add_body(&scene, &ball);
    rig_start_with(&scene, NULL, &options);
    const double start = scene_total_energy(&scene);
    for (int i = 0; i < 400; i++) {
        scene_step(&scene, h);
        most = fmax(most, scene_total_energy(&scene) / start);
    }
    rig_close(&scene);
    return most;
}

/* As stated at `stiffness` of dmb_wall_def: to rounding. More laws: physics_wall_energy. */
static void check_unresolved(int32_t law)
{
    const double radii[] = {0.0, 0.2, 0.5, 0.8, 0.95, 1.0}, steps[] = {0.1, 1.0, 2.0, 3.0, 5.0, 10.0, 30.0, 100.0};
    double most = 0.0;
    for (int r = 0; r < 6; r++)
        for (int i = 0; i < 8; i++) {
            const double found = largest_energy(law, radii[r], steps[i]);
            if (found > most) print_message("    radius %g, h w %g: %g\n", radii[r], steps[i], found);
            most = fmax(most, found);
        }
    CHECK_BELOW(most, 1.0 + 1e-9);
}

static void unresolved_bounces_gain_nothing(void **state)
{
    (void)state;
    check_unresolved(DMB_NORMAL_EXACT);
    check_unresolved(DMB_NORMAL_HUNT_CROSSLEY);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(first_impact),
        cmocka_unit_test(apex_heights),
        cmocka_unit_test(stop_time),
        cmocka_unit_test(energy_of_impacts),
        cmocka_unit_test(unresolved_bounces_gain_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
