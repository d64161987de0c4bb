/* Springs, dampers, stops and friction along joint coordinates against closed forms, what dmb_query_joint tells of
 * them, and the energy ledger over all of them. */
#include <string.h>

#include "mechanism.h"

static const double mass = 2.0, inertia = 0.3, g = 9.81;

/* ---- One body on one joint --------------------------------------------------------------------------------------- */

typedef struct single {
    rig s;
    dmb_id body, joint;
} single;

/* A joint that asks for no more than its kind and laws say; gravity along -z, the joint's axis along x. */
static single single_of(const dmb_joint_def *like, double gravity_x, const double velocity[6], double tolerance)
{
    single m;
    dmb_body_def body = dmb_body_def_default();
    const dmb_sim_options options = sharp_options(0.9, tolerance);
    rig_open(&m.s, gravity_x, 0.0, 0.0);
    body.mass = mass;
    for (int i = 0; i < 3; i++) body.inertia[i] = inertia;
    if (velocity != NULL) memcpy(body.velocity, velocity, sizeof body.velocity);
    m.body = add_body(&m.s, &body);
    dmb_joint_def def = *like;
    def.place_b = dmb_station(m.body, 0, 0.0);
    m.joint = add_joint(&m.s, &def);
    (void)mechanism_start(&m.s, &options);
    return m;
}

static dmb_joint_def joint_of(int32_t kind)
{
    dmb_joint_def def = dmb_joint_def_default();
    def.kind = kind;
    return def;
}

/* ---- Oscillators ------------------------------------------------------------------------------------------------- */

/* x of m x'' + c x' + k (x - rest) = 0 from x = 0 with speed v. */
static double oscillator(double m, double c, double k, double rest, double v, double t, double *speed)
{
    const double d = c / (2.0 * m), w = sqrt(k / m - d * d), a = -rest, b = (v + d * a) / w;
    *speed = exp(-d * t) * ((b * w - d * a) * cos(w * t) - (a * w + d * b) * sin(w * t));
    return rest + exp(-d * t) * (a * cos(w * t) + b * sin(w * t));
}

/* Largest error over 2 s against the closed form, over the amplitude. */
static double oscillator_error(int32_t kind, int32_t component, double c, double step)
{
    const double v = 1.5, k = 500.0, rest = 0.05, m = component == DMB_X ? mass : inertia;
    double velocity[6] = {0.0}, worst = 0.0;
    dmb_joint_def def = joint_of(kind);
    def.stiffness[component] = k;
    def.damping[component] = c;
    def.rest[component] = rest;
    velocity[component] = v;
    single one = single_of(&def, 0.0, velocity, 1e-10);
    for (double t = step; t < 2.0; t += step) {
        double speed;
        take_steps(&one.s, step, 1);
        const dmb_joint_state joint = joint_at(&one.s, one.joint);
        const double want = oscillator(m, c, k, rest, v, dmb_sim_time(one.s.sim), &speed);
        worst = fmax(worst, fabs(joint.position[component] - want));
    }
    const dmb_energy energy = energy_of(&one.s);
    const double start = 0.5 * m * v * v + 0.5 * k * rest * rest;
    tell("balance over the energy at the start", energy.balance / start);
    rig_close(&one.s);
    return worst / (v / sqrt(k / m));
}

static void check_oscillator(const char *what, int32_t kind, int32_t component, double c)
{
    const double coarse = oscillator_error(kind, component, c, 1e-3), fine = oscillator_error(kind, component, c, 5e-4);
    check_below(what, fine, 2e-3);
    check_order("order of the error", coarse, fine, 2.0, 0.1);
}

static void oscillators(void **state)
{
    (void)state;
    check_oscillator("prismatic: spring alone", DMB_JOINT_PRISMATIC, DMB_X, 0.0);
    check_oscillator("prismatic: spring and damper", DMB_JOINT_PRISMATIC, DMB_X, 4.0);
    check_oscillator("revolute: torsion spring and damper", DMB_JOINT_REVOLUTE, DMB_RX, 0.6);
    check_oscillator("free joint: along X", DMB_JOINT_FREE, DMB_X, 1.0);
}

/* Hangs at m g/k, found by statics. */
static void spring_at_rest(void **state)
{
    (void)state;
    dmb_joint_def def = joint_of(DMB_JOINT_PRISMATIC);
    def.stiffness[DMB_X] = 500.0;
    def.rest[DMB_X] = 0.1;
    single one = single_of(&def, g, NULL, 1e-10);
    (void)find_equilibrium(&one.s, NULL);
    const dmb_joint_state joint = joint_at(&one.s, one.joint);
    check_relative("place of rest", joint.position[DMB_X], 0.1 + mass * g / 500.0, 1e-12);
    check_relative("action of the spring", joint.action[DMB_X], -mass * g, 1e-12);
    rig_close(&one.s);
}

/* ---- What the query tells ---------------------------------------------------------------------------------------- */

static double law(const dmb_joint_def *def, int i, double x, double s)
{
    const double n = sqrt(s * s + def->friction_speed * def->friction_speed);
    double force = -def->stiffness[i] * (x - def->rest[i]) - def->damping[i] * s - def->friction[i] * s / n;
    if (x > def->stop_high[i])
        force -= fmax(0.0, def->stop_stiffness * (x - def->stop_high[i]) + def->stop_damping * s);
    if (x < def->stop_low[i]) force -= fmin(0.0, def->stop_stiffness * (x - def->stop_low[i]) + def->stop_damping * s);
    return force;
}

static void action_is_the_law(void **state)
{
    (void)state;
    const double velocity[6] = {0.8, 0.0, 0.0, 3.0, 0.0, 0.0};
    dmb_joint_def def = joint_of(DMB_JOINT_CYLINDRICAL);
    for (int i = 0; i < 4; i += 3) {
        def.stiffness[i] = 40.0;
        def.damping[i] = 0.3;
        def.rest[i] = 0.02;
        def.friction[i] = 0.5;
        def.stop_high[i] = 0.1;
        def.stop_low[i] = -0.05;
    }
    def.stop_stiffness = 5e3;
    def.stop_damping = 20.0;
    single one = single_of(&def, 0.0, velocity, 1e-10);
    double worst = 0.0, push = 0.0;
    for (int k = 0; k < 1000; k++) {
        take_steps(&one.s, 1e-3, 1);
        const dmb_joint_state joint = joint_at(&one.s, one.joint);
        double want[6] = {0.0};
        for (int i = 0; i < 4; i += 3) want[i] = law(&def, i, joint.position[i], joint.speed[i]);
        worst = fmax(worst, largest_difference(6, joint.action, want));
        push = fmax(push, fabs(want[DMB_X]));
        worst = fmax(worst, fabs(mass * joint.acceleration[DMB_X] - want[DMB_X]));
    }
    tell("largest force along X on the way [N]", push);
    check_below("action against the law, and against m a [N, N m]", worst, 1e-7);
    rig_close(&one.s);
}

/* ---- Stops ------------------------------------------------------------------------------------------------------- */

/* Into the stop and out again: half a period of the damped spring, ended where it no longer pushes. */
static void stop_bounces(void **state)
{
    (void)state;
    const double K = 2e4, c = 40.0, v = 1.0, velocity[6] = {1.0, 0.0, 0.0, 0.0, 0.0, 0.0}, step = 2e-5;
    const double d = c / (2.0 * mass), w = sqrt(K / mass - d * d);
    dmb_joint_def def = joint_of(DMB_JOINT_PRISMATIC);
    def.stop_high[DMB_X] = 0.01;
    def.stop_stiffness = K;
    def.stop_damping = c;
    single one = single_of(&def, 0.0, velocity, 1e-10);
    while (joint_at(&one.s, one.joint).speed[DMB_X] > 0.0 || joint_at(&one.s, one.joint).position[DMB_X] > 0.01)
        take_steps(&one.s, step, 1);
    take_steps(&one.s, step, 100);
    /* it leaves where K x + c x' = 0: tan(w t) = 2 d w/(d^2 - w^2) of x = v/w exp(-d t) sin(w t), between 0 and pi */
    const double phase = atan2(2.0 * d * w, d * d - w * w), t = phase / w; /* x'' = 0 */
    const double out = v * exp(-d * t) * (cos(phase) - d / w * sin(phase));
    const dmb_energy energy = energy_of(&one.s);
    const double start = 0.5 * mass * v * v;
    check_relative("speed after the bounce", joint_at(&one.s, one.joint).speed[DMB_X], out,
                   c * step / mass); /* the damper's force jumps somewhere in a step */
    check_relative("energy into impact", energy.impact, start - 0.5 * mass * out * out, 1e-3);
    check_below("balance over the energy", energy.balance / start, 1e-4);
    check_below("unexplained over the energy", energy.unexplained / start, 1e-9);
    rig_close(&one.s);
}

/* Without damping it gives back what it took; bounces between two stops. */
static void stops_without_damping(void **state)
{
    (void)state;
    const double velocity[6] = {0.0, 0.0, 0.0, 2.0, 0.0, 0.0};
    dmb_joint_def def = joint_of(DMB_JOINT_REVOLUTE);
    def.stop_high[DMB_RX] = 0.2;
    def.stop_low[DMB_RX] = -0.1;
    def.stop_stiffness = 5e3;
    single one = single_of(&def, 0.0, velocity, 1e-10);
    double most = 0.0, least = 0.0;
    for (int i = 0; i < 10000; i++) {
        take_steps(&one.s, 1e-4, 1);
        const double angle = joint_at(&one.s, one.joint).position[DMB_RX];
        most = fmax(most, angle), least = fmin(least, angle);
    }
    const double start = 0.5 * inertia * 4.0, depth = sqrt(inertia / 5e3) * 2.0;
    check_relative("deepest in the upper stop", most, 0.2 + depth, 1e-3);
    check_relative("deepest in the lower stop", least, -0.1 - depth, 1e-3);
    check_below("balance over the energy after 1 s", energy_of(&one.s).balance / start, 1e-3);
    check_below("energy into impact", energy_of(&one.s).impact / start, 1e-12);
    rig_close(&one.s);
}

/* ---- Friction ---------------------------------------------------------------------------------------------------- */

/* Coasting from v with friction f s/sqrt(s^2 + s0^2): m s ds = -f s/n dx, so x = m/f integral of n ds from s to v. */
static double coasted(double m, double f, double s0, double v, double s)
{
    const double a = 0.5 * (v * sqrt(v * v + s0 * s0) + s0 * s0 * asinh(v / s0));
    return m / f * (a - 0.5 * (s * sqrt(s * s + s0 * s0) + s0 * s0 * asinh(s / s0)));
}

static void check_coasting(const char *what, int32_t kind, int32_t component, double v)
{
    const double f = 1.2, s0 = 1e-2, m = component == DMB_X ? mass : inertia;
    double velocity[6] = {0.0};
    dmb_joint_def def = joint_of(kind);
    def.friction[component] = f;
    def.friction_speed = s0;
    velocity[component] = v;
    single one = single_of(&def, 0.0, velocity, 1e-11);
    const double stop = m * v / f;
    take_steps(&one.s, stop / 2000.0, 2100);
    const dmb_joint_state joint = joint_at(&one.s, one.joint);
    const dmb_energy energy = energy_of(&one.s);
    const double start = 0.5 * m * v * v;
    tell("without smoothing it would stop at", 0.5 * m * v * v / f);
    check_relative(what, joint.position[component], coasted(m, f, s0, v, joint.speed[component]), 1e-5);
    check_below("speed left over the smoothing speed", joint.speed[component] / s0, 0.2);
    check_relative("energy into friction", energy.friction, start - energy.kinetic, 1e-5);
    check_below("balance over the energy", energy.balance / start, 1e-5);
    rig_close(&one.s);
}

static void friction_stops(void **state)
{
    (void)state;
    check_coasting("revolute: angle until it stops", DMB_JOINT_REVOLUTE, DMB_RX, 4.0);
    check_coasting("prismatic: way until it stops", DMB_JOINT_PRISMATIC, DMB_X, 2.0);
    check_coasting("cylindrical: friction on X", DMB_JOINT_CYLINDRICAL, DMB_X, 2.0);
}

/* Below its friction a pushed body creeps at the speed where friction holds the push; above it runs away. */
static void friction_holds(void **state)
{
    (void)state;
    const double f = 30.0, s0 = 1e-3, push = mass * g;
    dmb_joint_def def = joint_of(DMB_JOINT_PRISMATIC);
    def.friction[DMB_X] = f;
    def.friction_speed = s0;
    single one = single_of(&def, g, NULL, 1e-10);
    take_steps(&one.s, 1e-3, 500);
    const double creep = s0 * push / sqrt(f * f - push * push);
    check_relative("creep where friction holds", joint_at(&one.s, one.joint).speed[DMB_X], creep, 1e-8);
    check_relative("action", joint_at(&one.s, one.joint).action[DMB_X], -push, 1e-8);
    rig_close(&one.s);
}

/* ---- Ledger ------------------------------------------------------------------------------------------------------ */

/* Everything at once on a joint that a motor turns and pushes: balance over what went in. */
static double ledger_error(double step, uint32_t n, dmb_energy *energy)
{
    dmb_joint_def def = joint_of(DMB_JOINT_CYLINDRICAL);
    dmb_segment term = dmb_segment_default();
    dmb_body_def body = dmb_body_def_default();
    const dmb_sim_options options = sharp_options(0.9, 1e-11);
    rig s;
    rig_open(&s, 0.0, 0.0, -g);
    body.mass = mass;
    for (int i = 0; i < 3; i++) body.inertia[i] = inertia;
    for (int i = 0; i < 4; i += 3) {
        def.stiffness[i] = 20.0;
        def.damping[i] = 0.5;
        def.friction[i] = 1.0;
        def.stop_high[i] = 0.3;
        def.stop_low[i] = -0.2;
    }
    def.friction_speed = 0.05;
    def.stop_stiffness = 400.0;
    def.stop_damping = 8.0;
    def.place_b = dmb_station(add_body(&s, &body), 0, 0.0);
    const dmb_id joint = add_joint(&s, &def);
    term.kind = DMB_SEGMENT_HARMONIC;
    term.h1 = 30.0;
    term.omega = 7.0;
    const dmb_id time_function = add_time_function(&s, &term, 1);
    (void)add_simple_drive(&s, DMB_DRIVE_LOAD, joint, DMB_X, time_function);
    (void)add_simple_drive(&s, DMB_DRIVE_LOAD, joint, DMB_RX, time_function);
    (void)mechanism_start(&s, &options);
    take_steps(&s, step, n);
    *energy = energy_of(&s);
    rig_close(&s);
    return fabs(energy->balance) / energy->input;
}

static void ledger_balances(void **state)
{
    (void)state;
    dmb_energy energy;
    const double coarse = ledger_error(4e-4, 5000, &energy), fine = ledger_error(1e-4, 20000, &energy);
    tell("put in [J]", energy.input);
    tell("into dampers [J]", energy.damping);
    tell("into friction [J]", energy.friction);
    tell("into stops [J]", energy.impact);
    tell("balance over input, steps of 4e-4 s", coarse);
    check_below("balance over input, steps of 1e-4 s", fine, 1e-6);
    check_below("unexplained over input", energy.unexplained / energy.input, 1e-10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(oscillators),    cmocka_unit_test(spring_at_rest),        cmocka_unit_test(action_is_the_law),
        cmocka_unit_test(stop_bounces),   cmocka_unit_test(stops_without_damping), cmocka_unit_test(friction_stops),
        cmocka_unit_test(friction_holds), cmocka_unit_test(ledger_balances),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
