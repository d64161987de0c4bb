/* Energy of stops and one-sided springs over bounces that steps resolve or not: never above 1.01 of the initial energy,
 * for steps of h w from 0.01 to 100, every spectral radius, with and without dampers, in fixed and in controlled steps.
 * DMB_BOUNCE_SEEDS: number of random scenes of balls between springs (default 20). Equations: eq:unilateral.energy,
 * eq:unilateral.mean. Equations: eq:unilateral.resolved. */
#include <stdlib.h>

#include "drillmbd/scene.h"
#include "mechanism.h"

/* Of the initial energy. */
static const double bound = 1.01;

typedef struct bouncing {
    double frequency; /* [rad/s] of the mass on its stop or spring */
    double ratio;     /* [-] damping over the critical one */
    double start;     /* [J] */
} bouncing;

/* Steps may be divided where several contacts close at once. */
static void must_step(rig *s, double step)
{
    const int32_t status = dmb_sim_step(s->sim, step, NULL);
    assert_true(status == DMB_OK || status == DMB_NOTE_STEP_CUT);
}

/* Largest energy in `count` steps of h w over the initial one. */
static double most_of(rig *s, const bouncing *b, double hw, uint32_t count)
{
    double most = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        must_step(s, hw / b->frequency);
        most = fmax(most, energy_now(s) / b->start);
    }
    return most;
}

/* ---- A rod with play --------------------------------------------------------------------------------------------- */

static const double stiffness = 1e6, inertia = 0.02, play = 0.1, speed = 10.0;

/* between: the other side is a body of the same inertia, as of a splined shaft; both fly on. */
static bouncing open_rod(rig *s, int between, double ratio, double radius)
{
    const dmb_sim_options options = sharp_options(radius, 1e-11);
    const double reduced = between ? 0.5 * inertia : inertia;
    const bouncing b = {sqrt(stiffness / reduced), ratio, 0.5 * inertia * speed * speed};
    dmb_body_def rod = dmb_body_def_default();
    dmb_joint_def hinge = dmb_joint_def_default();
    rig_open(s, 0.0, 0.0, 0.0);
    rod.mass = 12.0;
    rod.inertia[0] = inertia;
    rod.inertia[1] = rod.inertia[2] = 1.0;
    if (between) {
        dmb_joint_def bearing = dmb_joint_def_default();
        bearing.kind = DMB_JOINT_REVOLUTE;
        bearing.place_b = dmb_station(add_body(s, &rod), 0, 0.0);
        (void)add_joint(s, &bearing);
        hinge.place_a = bearing.place_b;
    }
    hinge.kind = DMB_JOINT_REVOLUTE;
    hinge.place_b = dmb_station(add_body(s, &rod), 0, 0.0);
    hinge.stop_low[DMB_RX] = -play;
    hinge.stop_high[DMB_RX] = play;
    hinge.stop_stiffness = stiffness;
    hinge.stop_damping = 2.0 * ratio * sqrt(stiffness * reduced);
    hinge.initial_mask = DMB_FREE_RX;
    hinge.initial_speed[DMB_RX] = speed;
    (void)add_joint(s, &hinge);
    (void)mechanism_start(s, &options);
    return b;
}

static const double steps_of[] = {0.01, 0.1, 0.3, 0.7, 1.0, 2.0, 3.0, 5.0, 10.0, 30.0, 100.0};
enum { STEPS = sizeof steps_of / sizeof steps_of[0] };

static double worst_rod(int between, double ratio, double radius)
{
    double worst = 0.0;
    for (int i = 0; i < STEPS; i++) {
        rig s;
        const bouncing b = open_rod(&s, between, ratio, radius);
        const double crossing = 2.0 * play / speed * b.frequency / steps_of[i]; /* steps from stop to stop */
        worst = fmax(worst, most_of(&s, &b, steps_of[i], (uint32_t)fmin(4.0 * crossing + 100.0, 2500.0)));
        rig_close(&s);
    }
    return worst;
}

static void a_rod_with_play_gains_nothing(void **state)
{
    static const double radii[] = {0.0, 0.2, 0.5, 0.8, 0.95, 1.0}, ratios[] = {0.0, 0.01, 0.3, 1.0, 5.0};
    (void)state;
    for (int i = 0; i < 5; i++) {
        double worst = 0.0;
        for (int k = 0; k < 6; k++) worst = fmax(worst, worst_rod(k % 2, ratios[i], radii[k]));
        check_below("largest over the initial energy, by damping ratio", worst, bound);
    }
}

/* At radius 1 a bounce takes nothing from the energy, at any step; at 0.8 least where it is resolved. */
static void bounces_give_back(void **state)
{
    (void)state;
    for (int i = 0; i < STEPS; i++) {
        rig s;
        const bouncing b = open_rod(&s, 0, 0.0, 1.0);
        (void)most_of(&s, &b, steps_of[i], 2000);
        check_close("energy after 2000 steps at radius 1", energy_now(&s) / b.start, 1.0, 1e-3);
        rig_close(&s);
    }
}

static void controlled_steps_gain_nothing(void **state)
{
    (void)state;
    for (int between = 0; between < 2; between++) {
        rig s;
        double most = 0.0;
        const bouncing b = open_rod(&s, between, 0.0, 0.8);
        for (int i = 1; i <= 100; i++) {
            must(&s, dmb_sim_advance(s.sim, 0.05 * i, NULL));
            most = fmax(most, energy_now(&s) / b.start);
        }
        check_below("controlled steps: largest energy over the initial one", most, bound);
        tell("energy after 5 s over the initial one", energy_now(&s) / b.start);
        rig_close(&s);
    }
}

/* ---- Balls between springs --------------------------------------------------------------------------------------- */

static double uniform(uint64_t *seed)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 11) / 9007199254740992.0;
}

static dmb_place ball_at(rig *s, double x, double v, double mass)
{
    dmb_body_def body = dmb_body_def_default();
    body.mass = mass;
    body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
    body.position[0] = x;
    body.velocity[0] = v;
    return dmb_station(add_body(s, &body), 0, 0.0);
}

static void put_spring(rig *s, dmb_place a, dmb_place b, double at, double k, double c)
{
    dmb_spring_def def = dmb_spring_def_default();
    dmb_id id = {0, 0};
    def.place_a = a;
    def.place_b = b;
    def.offset_a[0] = at;
    def.acts = DMB_SPRING_COMPRESSION;
    def.stiffness = k;
    def.damping = c;
    def.free_length = 0.5;
    must_model(s, dmb_model_add_spring(s->model, &def, &id));
}

/* Five balls in a row between two fixed places; springs of 0.5 m push where two come near. */
static const double apart = 0.52; /* [m] */

static double worst_row(uint64_t seed)
{
    static const double radii[] = {0.0, 0.2, 0.5, 0.8, 0.95, 1.0};
    const double hw = pow(10.0, 4.0 * uniform(&seed) - 2.0), ratio = uniform(&seed) < 0.5 ? 0.0 : uniform(&seed);
    const dmb_sim_options options = sharp_options(radii[(int)(6.0 * uniform(&seed))], 1e-11);
    const double k = 1e6, c = 2.0 * ratio * sqrt(k);
    dmb_place place = dmb_station(ground_id, 0, 0.0);
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    for (int i = 0; i < 5; i++) {
        const double mass = pow(10.0, uniform(&seed) - 0.5);
        const dmb_place ball = ball_at(&s, apart * (1.0 + i), 4.0 * uniform(&seed) - 2.0, mass);
        put_spring(&s, place, ball, 0.0, k, c);
        place = ball;
    }
    put_spring(&s, dmb_station(ground_id, 0, 0.0), place, 6.0 * apart, k, c);
    (void)mechanism_start(&s, &options);
    const bouncing b = {1000.0, ratio, energy_now(&s)};
    const double most = most_of(&s, &b, hw, (uint32_t)fmin(60.0 / hw + 200.0, 2000.0));
    rig_close(&s);
    return most;
}

static void balls_between_springs_gain_nothing(void **state)
{
    const char *more = getenv("DMB_BOUNCE_SEEDS");
    const long seeds = more != NULL ? strtol(more, NULL, 10) : 20;
    double worst = 0.0;
    (void)state;
    for (long i = 1; i <= seeds; i++) worst = fmax(worst, worst_row((uint64_t)i));
    check_below("largest energy of five balls over the initial one", worst, bound);
}

/* ---- What is told ------------------------------------------------------------------------------------------------ */

static void unresolved_bounces_are_counted(void **state)
{
    static const double steps[] = {0.05, 3.0};
    (void)state;
    for (int i = 0; i < 2; i++) {
        rig s;
        const bouncing b = open_rod(&s, 0, 0.0, 1.0);
        dmb_statistics statistics = dmb_statistics_default();
        const double crossing = 2.0 * play / speed * b.frequency;
        (void)most_of(&s, &b, steps[i], (uint32_t)(3.0 * crossing / steps[i]));
        must(&s, dmb_query_statistics(s.sim, &statistics));
        if (i == 0) assert_int_equal(statistics.bounces, 0); /* a bounce takes pi/0.05 steps */
        if (i == 1) assert_in_range(statistics.bounces, 2, 4);
        rig_close(&s);
    }
}

/* Without any drive the error is that of the energy that is there. */
static void the_error_counts_without_drives(void **state)
{
    rig s;
    const bouncing b = open_rod(&s, 0, 0.0, 0.0);
    (void)state;
    (void)most_of(&s, &b, 3.0, 2000);
    const dmb_energy e = energy_of(&s);
    check_close("scale [J]", e.scale, b.start, 1e-2);
    check_close("error, all of what the scheme took", e.error, 1.0 - energy_now(&s) / b.start, 1e-9);
    assert_true(e.error > 0.5);
    assert_true(e.growth < 0.1);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_rod_with_play_gains_nothing),  cmocka_unit_test(bounces_give_back),
        cmocka_unit_test(controlled_steps_gain_nothing),  cmocka_unit_test(balls_between_springs_gain_nothing),
        cmocka_unit_test(unresolved_bounces_are_counted), cmocka_unit_test(the_error_counts_without_drives),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
