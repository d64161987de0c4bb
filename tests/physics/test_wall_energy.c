/* Energy of bounces at the wall of the hole that steps resolve or not: never above 1.01 of the initial energy, for
 * steps of h w from 0.01 to 100, every spectral radius, every law of the normal force, in fixed and in controlled
 * steps. w = sqrt(K l/m) is the frequency of the ball on its wall. */
#include "contact_scene.h"

/* Of the initial energy. */
static const double bound = 1.01;

static const double mass = 1.0, stiffness = 1e6, clearance = 0.05, speed = 1.0;

typedef struct law {
    const char *name;
    int32_t kind;
    double exponent, ratio, restitution; /* ratio [-]: damping over the critical one */
} law;

static const law laws[] = {
    {"elastic", DMB_NORMAL_KELVIN_VOIGT, 1.0, 0.0, 1.0},
    {"damping ratio 0.01", DMB_NORMAL_KELVIN_VOIGT, 1.0, 0.01, 1.0},
    {"damping ratio 0.1", DMB_NORMAL_KELVIN_VOIGT, 1.0, 0.1, 1.0},
    {"damping ratio 0.5", DMB_NORMAL_KELVIN_VOIGT, 1.0, 0.5, 1.0},
    {"damping ratio 5", DMB_NORMAL_KELVIN_VOIGT, 1.0, 5.0, 1.0},
    {"damping ratio 0.3, exponent 1.5", DMB_NORMAL_KELVIN_VOIGT, 1.5, 0.3, 1.0},
    {"Hunt-Crossley 0.4", DMB_NORMAL_HUNT_CROSSLEY, 1.0, 0.0, 0.4},
    {"exact 0.9", DMB_NORMAL_EXACT, 1.0, 0.0, 0.9},
    {"exact 0.1", DMB_NORMAL_EXACT, 1.5, 0.0, 0.1},
    {"impact function 0.3", DMB_NORMAL_IMPACT, 1.5, 0.3, 1.0},
};
enum { LAWS = sizeof laws / sizeof laws[0] };

static const double radii[] = {0.0, 0.2, 0.5, 0.8, 0.95, 1.0};
enum { RADII = sizeof radii / sizeof radii[0] };

static const double steps_of[] = {0.01, 0.1, 0.3, 0.7, 1.0, 2.0, 3.0, 5.0, 10.0, 30.0, 100.0};
enum { STEPS = sizeof steps_of / sizeof steps_of[0] };

static double frequency(void)
{
    return sqrt(stiffness / mass);
}

static dmb_wall_def wall_of(const law *of)
{
    dmb_wall_def wall = scene_wide_wall(of->kind, stiffness, of->exponent, of->restitution);
    wall.diameter = 0.1 + 2.0 * clearance;
    wall.damping = 2.0 * of->ratio * sqrt(stiffness * mass);
    wall.impact_depth = 1e-4;
    wall.approach_speed = 1e-3;
    return wall;
}

static dmb_sim_options options_of(double radius)
{
    dmb_sim_options options = dmb_sim_options_default();
    options.spectral_radius = radius;
    return options;
}

/* A ball on the axis that flies at the wall, sideways too if it spins: then the wall rubs. */
static void open_ball(rig *scene, const law *of, double radius, int spins)
{
    const dmb_sim_options options = options_of(radius);
    dmb_wall_def wall = wall_of(of);
    dmb_body_def ball = scene_ball(mass, 0.0, DMB_FREE_Z);
    ball.position[2] = 0.0;
    ball.velocity[2] = -speed;
    if (spins) {
        wall.friction_law = DMB_FRICTION_COULOMB;
        wall.mu_static = wall.mu_dynamic = 0.3;
        wall.smoothing_speed = 0.01;
        ball.free_mask = DMB_FREE_X | DMB_FREE_Y | DMB_FREE_Z | DMB_FREE_RX;
        ball.inertia[0] = ball.inertia[1] = ball.inertia[2] = 1e-3;
        ball.position[1] = 0.4 * clearance;
        ball.velocity[0] = 0.3 * speed;
        ball.velocity[3] = 20.0;
    }
    scene_open(scene, 0.0);
    add_wall(scene, &wall);
    add_body(scene, &ball);
    rig_start_with(scene, NULL, &options);
}

static uint32_t steps_for(double hw)
{
    const double crossing = 2.0 * clearance / speed * frequency() / hw;
    return (uint32_t)fmin(4.0 * crossing + 100.0, 2500.0);
}

/* Largest energy in `count` steps over the initial one. */
static double most_of(rig *scene, double step, uint32_t count)
{
    const double start = scene_total_energy(scene);
    double most = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        scene_step(scene, step);
        most = fmax(most, scene_total_energy(scene) / start);
    }
    return most;
}

static double worst_ball(const law *of, int spins)
{
    double worst = 0.0;
    for (int r = 0; r < RADII; r++)
        for (int i = 0; i < STEPS; i++) {
            rig scene;
            open_ball(&scene, of, radii[r], spins);
            const double most = most_of(&scene, steps_of[i] / frequency(), steps_for(steps_of[i]));
            if (most > bound)
                print_message("%s, radius %g, h w = %g: %g of the initial energy\n", of->name, radii[r], steps_of[i],
                              most);
            worst = fmax(worst, most);
            rig_close(&scene);
        }
    return worst;
}

static void check_balls(int spins)
{
    double worst = 0.0;
    for (int l = 0; l < LAWS; l++) {
        const double most = worst_ball(laws + l, spins);
        print_message("%s: at most %.6f of the initial energy\n", laws[l].name, most);
        worst = fmax(worst, most);
    }
    CHECK_BELOW(worst, bound);
}

static void a_ball_gains_nothing(void **state)
{
    (void)state;
    check_balls(0);
}

static void a_ball_that_spins_and_rubs_gains_nothing(void **state)
{
    (void)state;
    check_balls(1);
}

/* Restitutions 0.1 to 0.9 as they are given, at the steps where contacts cease to be resolved (eq:contact.coarse): at
 * h w = 1.4 for the exponent 1, and where K (v h/2)^(n-1) takes the place of K for others (h w = 6.0 for 1.5, 53 for
 * 3).
 */
static void restitutions_gain_nothing(void **state)
{
    static const double exponents[] = {1.0, 1.5, 3.0}, some_radii[] = {0.0, 0.8, 1.0};
    static const double near[] = {0.3, 0.8, 1.2, 1.38, 1.45, 1.7, 1.95, 2.1, 2.6, 4.0, 5.8, 6.2, 7.0, 9.0, 50.0, 56.0};
    double worst = 0.0;
    (void)state;
    for (int e = 1; e < 10; e++)
        for (int k = 0; k < 9; k++)
            for (int i = 0; i < 16; i++) {
                const law of = {"exact", DMB_NORMAL_EXACT, exponents[k / 3], 0.0, 0.1 * e};
                rig scene;
                open_ball(&scene, &of, some_radii[k % 3], 0);
                const double most = most_of(&scene, near[i] / frequency(), steps_for(near[i]));
                if (most > bound)
                    print_message("restitution %g, exponent %g, radius %g, h w = %g: %g\n", of.restitution, of.exponent,
                                  some_radii[k % 3], near[i], most);
                worst = fmax(worst, most);
                rig_close(&scene);
            }
    print_message("restitutions 0.1 to 0.9: at most %.9f of the initial energy\n", worst);
    CHECK_BELOW(worst, bound);
}

/* At radius 1 an elastic bounce takes nothing from the energy where steps do not resolve it, and little where they do
 * (h w = 1.4 is the limit between; below it the loss is of second order, at h w = 1 0.4 % a bounce). */
static void bounces_give_back(void **state)
{
    (void)state;
    for (int i = 0; i < STEPS; i++) {
        rig scene;
        if (steps_of[i] > 30.0) continue; /* crosses the hole in one step */
        if (steps_of[i] > 0.1 && steps_of[i] < 2.0) continue;
        open_ball(&scene, laws, 1.0, 0);
        const double start = scene_total_energy(&scene);
        (void)most_of(&scene, steps_of[i] / frequency(), 2000);
        CHECK_CLOSE(scene_total_energy(&scene) / start, 1.0, steps_of[i] >= 2.0 ? 1e-4 : 1e-2);
        rig_close(&scene);
    }
}

static void controlled_steps_gain_nothing(void **state)
{
    (void)state;
    for (int l = 0; l < LAWS; l++) {
        rig scene;
        double most = 0.0;
        open_ball(&scene, laws + l, 0.8, l % 2);
        const double start = scene_total_energy(&scene);
        for (int i = 1; i <= 50; i++) {
            scene_advance(&scene, 0.05 * i);
            most = fmax(most, scene_total_energy(&scene) / start);
        }
        CHECK_BELOW(most, bound);
        rig_close(&scene);
    }
}

/* ---- Pipes ------------------------------------------------------------------------------------------------------- */

static const double gravity = 9.81;

/* Four pipes fall from the axis of a level hole onto its wall. */
static void open_pipes(rig *scene, const law *of, double radius)
{
    const dmb_sim_options options = options_of(radius);
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_wall_def wall = wall_of(of);
    dmb_id id = {0, 0};
    wall.diameter = 0.073 + 2.0 * clearance;
    wall.stiffness = 1e7;
    wall.damping = 2.0 * of->ratio * sqrt(wall.stiffness * 10.0);
    scene_open(scene, gravity);
    add_wall(scene, &wall);
    string.start_free = DMB_FREE_ALL;
    must_model(scene, dmb_model_add_string(scene->model, &string, &id));
    pipe.string = id;
    pipe.length = 1.0;
    must_model(scene, dmb_model_add_pipes(scene->model, &pipe, 4, NULL));
    rig_start_with(scene, NULL, &options);
}

static double weight_of(const rig *scene)
{
    dmb_momentum momentum = dmb_momentum_default();
    must(scene, dmb_query_momentum(scene->sim, &momentum));
    return momentum.mass * gravity;
}

static void falling_pipes_gain_nothing(void **state)
{
    static const double steps[] = {1e-4, 1e-3, 5e-3, 0.03};
    static const int chosen[] = {0, 2, 3, 6, 8};
    double worst = 0.0;
    (void)state;
    for (int l = 0; l < 5; l++)
        for (int r = 0; r < RADII; r += 1 + l % 2)
            for (int i = 0; i < 4; i++) {
                rig scene;
                open_pipes(&scene, laws + chosen[l], radii[r]);
                const double start = scene_total_energy(&scene), weight = weight_of(&scene);
                for (uint32_t k = 0; k < (uint32_t)fmin(0.4 / steps[i] + 100.0, 2000.0); k++) {
                    scene_step(&scene, steps[i]);
                    worst = fmax(worst, (scene_total_energy(&scene) - start) / (weight * clearance));
                }
                rig_close(&scene);
            }
    print_message("falling pipes: energy gained over that of the fall %.2e\n", worst);
    CHECK_BELOW(worst, bound - 1.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_gains_nothing),          cmocka_unit_test(a_ball_that_spins_and_rubs_gains_nothing),
        cmocka_unit_test(restitutions_gain_nothing),     cmocka_unit_test(bounces_give_back),
        cmocka_unit_test(controlled_steps_gain_nothing), cmocka_unit_test(falling_pipes_gain_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
