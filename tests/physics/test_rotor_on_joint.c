/* Rotors that spin fast on joints: the slow precession of a heavy top against its closed form, at up to 3 rad of spin a
 * step.
 *
 * A rotor with the moments A' about the fixed point and C about its axis spins at w3 along the axis, which stands at
 * the angle T to the vertical and goes round the vertical at p. A carrier that goes round with it has C_c about the
 * axis. With m the mass of both and l the height of their centre along the axis (Goldstein, Classical Mechanics, 5.7),
 *     m g l = (C w3 + C_c p cos T) p - A' p^2 cos T
 * A ring that only turns about the vertical has no part in it. In axes that do not spin with the rotor a step errs by
 * (p h)^2; in axes that do it erred by 0.69 (w3 h)^2. Checks eq:motion.rotor-step. */
#include <math.h>
#include <string.h>

#include "mechanism.h"

#define GRAVITY 9.81 /* [m/s2] */
#define TILT 1.0     /* [rad] T */
#define SPIN 1000.0  /* [rad/s] w3 */

enum { ALONE, SUPPORTD, IN_CARRIER, IN_GIMBALS, KINDS };

static const char *const names[KINDS] = {"on a spherical joint", "on a fixed point", "in a carrier", "in gimbals"};

/* [kg, m, kg m2] */
static const double mass = 2.0, arm = 0.1, C = 0.004, A = 0.003, carrier_mass = 0.5, carrier_C = 0.0004,
                    carrier_A = 0.0006;

typedef struct gyroscope {
    rig s;
    dmb_id rotor;
    double precession; /* [rad/s] p */
} gyroscope;

/* Slow root of the equation of the head. */
static double precession_of(int kind)
{
    const int carried = kind >= IN_CARRIER;
    const double m = mass + carried * carrier_mass, J = A + carried * carrier_A + m * arm * arm;
    const double a = (carried * carrier_C - J) * cos(TILT), b = C * SPIN, c = -m * GRAVITY * arm;
    return 2.0 * -c / (b + sqrt(b * b - 4.0 * a * c));
}

/* A body whose x axis is that of the rotor, its reference point at `along` from the fixed point, that goes round the
 * vertical at p and spins at w3. z of the body is across the axis and upwards. */
static dmb_body_def body_on_axis(double along, double p, double w3)
{
    dmb_body_def body = dmb_body_def_default();
    const double w[3] = {w3, 0.0, p * sin(TILT)};
    body.rotation[1] = TILT - 0.5 * PI;
    body.position[0] = along * sin(TILT);
    body.position[2] = along * cos(TILT);
    memcpy(body.velocity + 3, w, sizeof w);
    body.velocity[1] = w[2] * along; /* w x (along, 0, 0) */
    return body;
}

static void take_inertia(double m, double about, double across, dmb_body_def *body)
{
    body->mass = m;
    body->inertia[0] = about;
    body->inertia[1] = body->inertia[2] = across;
}

static void add_tip(rig *s, dmb_id body)
{
    dmb_joint_def joint = joint_between(DMB_JOINT_SPHERICAL, dmb_station(ground_id, 0, 0.0), dmb_station(body, 0, 0.0));
    joint.origin_b[0] = -arm;
    (void)add_joint(s, &joint);
}

/* A ring about the fixed point that turns about the vertical, and carries the body on a horizontal hinge. */
static void add_gimbals(rig *s, dmb_id body, double p)
{
    const double vertical[3] = {0.0, 0.0, 1.0}, horizontal[3] = {0.0, 1.0, 0.0};
    dmb_body_def ring = dmb_body_def_default();
    ring.mass = 0.3;
    ring.inertia[0] = 4e-4, ring.inertia[1] = 5e-4, ring.inertia[2] = 6e-4;
    ring.velocity[5] = p;
    const dmb_id outer = add_body(s, &ring);
    dmb_joint_def stand = joint_between(DMB_JOINT_REVOLUTE, dmb_station(ground_id, 0, 0.0), dmb_station(outer, 0, 0.0));
    dmb_joint_def hinge = joint_between(DMB_JOINT_REVOLUTE, dmb_station(outer, 0, 0.0), dmb_station(body, 0, 0.0));
    memcpy(stand.axis_a, vertical, sizeof vertical);
    memcpy(stand.axis_b, vertical, sizeof vertical);
    (void)add_joint(s, &stand);
    memcpy(hinge.axis_a, horizontal, sizeof horizontal);
    memcpy(hinge.axis_b, horizontal, sizeof horizontal);
    hinge.origin_b[0] = -arm;
    (void)add_joint(s, &hinge);
}

static dmb_id add_carrier(gyroscope *g)
{
    dmb_body_def carrier = body_on_axis(arm, g->precession, g->precession * cos(TILT));
    take_inertia(carrier_mass, carrier_C, carrier_A, &carrier);
    const dmb_id id = add_body(&g->s, &carrier);
    (void)add_joint_between(&g->s, DMB_JOINT_REVOLUTE, dmb_station(id, 0, 0.0), dmb_station(g->rotor, 0, 0.0));
    return id;
}

static gyroscope open_gyroscope(int kind, const dmb_sim_options *options)
{
    gyroscope g = {.precession = precession_of(kind)};
    rig_open(&g.s, 0.0, 0.0, -GRAVITY);
    dmb_body_def rotor = body_on_axis(kind == SUPPORTD ? 0.0 : arm, g.precession, SPIN);
    take_inertia(mass, C, A, &rotor);
    if (kind == SUPPORTD) rotor.free_mask = DMB_FREE_SPHERICAL, rotor.centre[0] = arm;
    g.rotor = add_body(&g.s, &rotor);
    if (kind == ALONE) add_tip(&g.s, g.rotor);
    if (kind == IN_CARRIER) add_tip(&g.s, add_carrier(&g));
    if (kind == IN_GIMBALS) add_gimbals(&g.s, add_carrier(&g), g.precession);
    assert_int_equal(mechanism_start(&g.s, options), DMB_OK);
    return g;
}

/* [rad] of the axis round the vertical, and to it. */
static void angles_of(const gyroscope *g, double *round, double *tilt)
{
    const dmb_pose pose = pose_at(&g->s, dmb_station(g->rotor, 0, 0.0));
    *round = atan2(pose.rotation[3], pose.rotation[0]);
    *tilt = acos(pose.rotation[6]);
}

/* Relative errors, but for the tilt in rad. */
typedef struct course {
    double rate, tilt, energy, momentum, iterations;
} course;

static course run(int kind, double per_step, double radius)
{
    const double h = per_step / SPIN;
    const uint32_t n = (uint32_t)lround(0.9 / h);
    dmb_sim_options options = sharp_options(radius, 1e-12);
    gyroscope g = open_gyroscope(kind, &options);
    const dmb_energy e0 = energy_of(&g.s);
    const dmb_momentum m0 = momentum_of(&g.s);
    double round, tilt;
    take_steps(&g.s, h, n);
    const dmb_energy e1 = energy_of(&g.s);
    angles_of(&g, &round, &tilt);
    const dmb_statistics statistics = statistics_of(&g.s);
    const course c = {.rate = round / (g.precession * n * h) - 1.0,
                      .tilt = tilt - TILT,
                      .energy = (e1.kinetic + e1.gravity - e0.kinetic - e0.gravity) / e0.kinetic,
                      .momentum = momentum_of(&g.s).angular[2] / m0.angular[2] - 1.0,
                      .iterations = (double)statistics.iterations / n};
    check_below("        violation of the joints", statistics.violation, 1e-13);
    rig_close(&g.s);
    return c;
}

static void check_convergence(int kind, double per_step, double radius)
{
    const course c = run(kind, per_step, radius);
    const double p = precession_of(kind), ph = p * per_step / SPIN;
    print_message("    %s, w3 h = %g, radius %g: p is off by %.2e, (p h)^2 = %.2e\n", names[kind], per_step, radius,
                  c.rate, ph * ph);
    check_below("        precession, of (p h)^2", c.rate / (0.03 * ph * ph + 1e-12), 1.0);
    check_below("        tilt [rad]", c.tilt, 1e-10);
    check_below("        energy", c.energy, 1e-12);
    check_below("        angular momentum about the vertical", c.momentum, 1e-10);
    check_below("        iterations a step", c.iterations, 2.1);
}

static void precession_does_not_depend_on_the_spin_a_step(void **state)
{
    (void)state;
    for (int kind = 0; kind < KINDS; kind++)
        for (double radius = 0.8; radius < 1.1; radius += 0.2)
            for (int i = 0; i < 5; i++) check_convergence(kind, (const double[]){0.1, 0.3, 1.0, 2.0, 3.0}[i], radius);
    check_convergence(IN_CARRIER, 0.01, 0.8);
}

static void precession_is_of_second_order(void **state)
{
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) {
        tell(names[kind], precession_of(kind));
        check_order("    precession", run(kind, 3.0, 0.8).rate, run(kind, 1.5, 0.8).rate, 2.0, 0.02);
    }
}

/* ---- Strings ----------------------------------------------------------------------------------------------------- */

/* A light, stiff string on a fixed point that carries the rotor at its far end: on a bearing, or fixed to it. */
static gyroscope open_on_string(int bearing)
{
    const double p = precession_of(ALONE);
    gyroscope g = {.precession = p};
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = beam_pipe(arm, 2, 1e8, 4e7, 1e6, 1e6);
    dmb_body_def rotor = body_on_axis(arm, p, SPIN);
    rig_open(&g.s, 0.0, 0.0, -GRAVITY);
    take_inertia(mass, C, A, &rotor);
    string.follows_hole = 0;
    string.start_free = DMB_FREE_SPHERICAL;
    string.rotation[1] = TILT - 0.5 * PI;
    string.velocity[3] = bearing ? p * cos(TILT) : SPIN;
    string.velocity[5] = p * sin(TILT);
    pipe.density = 1.0;
    pipe.string = add_string(&g.s, &string);
    (void)add_pipes(&g.s, &pipe, 1);
    if (!bearing) {
        dmb_body_def fixed = dmb_body_def_default();
        take_inertia(mass, C, A, &fixed);
        fixed.attach = DMB_ATTACH_END;
        fixed.string = pipe.string;
        g.rotor = add_body(&g.s, &fixed);
    } else {
        g.rotor = add_body(&g.s, &rotor);
        (void)add_joint_between(&g.s, DMB_JOINT_REVOLUTE, dmb_station(pipe.string, 0, 1.0),
                                dmb_station(g.rotor, 0, 0.0));
    }
    assert_int_equal(mechanism_start(&g.s, NULL), DMB_OK);
    return g;
}

static double error_on_string(int bearing, double per_step)
{
    const double h = per_step / SPIN;
    const uint32_t n = (uint32_t)lround(0.9 / h);
    gyroscope g = open_on_string(bearing);
    double round, tilt;
    take_steps(&g.s, h, n);
    angles_of(&g, &round, &tilt);
    rig_close(&g.s);
    return round / (g.precession * n * h) - 1.0;
}

/* The closed form leaves out the bending of the string. */
static void a_rotor_at_the_end_of_a_string_precesses_right(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++)
        check_below("on a bearing at the end of a string: precession",
                    error_on_string(1, (const double[]){0.1, 0.3, 1.0}[i]), 2e-5);
}

/* The bound of lib/theory/limits.md. */
static void fixed_to_a_string_the_error_grows_with_the_square_of_the_spin_a_step(void **state)
{
    (void)state;
    check_close("fixed to a string: error over (w3 h)^2 at 0.05", error_on_string(0, 0.05) / -0.0025, 0.69, 0.02);
    check_close("    at 0.1", error_on_string(0, 0.1) / -0.01, 0.69, 0.02);
    check_close("    error at 1", error_on_string(0, 1.0), -0.47, 0.01);
}

/* ---- Turns ------------------------------------------------------------------------------------------------------- */

/* A disc on a bearing that a torque on it accelerates: its own turn, the joint's coordinate and the drive's count. */
static void turns_are_counted_at_ten_radians_a_step(void **state)
{
    (void)state;
    const double torque = 3.0, J = 0.5, speed = 100.0, h = 0.1, n = 40.0;
    const double want = speed * n * h + 0.5 * torque / J * n * h * n * h;
    rig s;
    dmb_body_def disc = dmb_body_def_default();
    dmb_drive_state drive = dmb_drive_state_default();
    rig_open(&s, 0.0, 0.0, -GRAVITY);
    take_inertia(2.0, J, 0.4, &disc);
    disc.velocity[3] = speed;
    const dmb_id body = add_body(&s, &disc);
    const dmb_id joint =
        add_joint_between(&s, DMB_JOINT_REVOLUTE, dmb_station(ground_id, 0, 0.0), dmb_station(body, 0, 0.0));
    const dmb_id motor = add_simple_drive(&s, DMB_DRIVE_LOAD, body, DMB_RX, add_constant(&s, torque));
    assert_int_equal(mechanism_start(&s, NULL), DMB_OK);
    take_steps(&s, h, (uint32_t)n);
    must(&s, dmb_query_drive(s.sim, motor, &drive));
    check_relative("turn of the body", rotation_at(&s, dmb_station(body, 0, 0.0)), want, 1e-12);
    check_relative("coordinate of the bearing", joint_at(&s, joint).position[DMB_RX], want, 1e-12);
    check_relative("position of the drive", drive.position, want, 1e-12);
    rig_close(&s);
}

/* ---- Stops ------------------------------------------------------------------------------------------------------- */

/* [-] Energy that a body between undamped stops gains in 4000 steps, of its kinetic energy; moments across its axis
 * 0.006 and `across` kg m2. */
static double energy_gained_between_stops(double per_step, double stiffness, double across)
{
    const double speed = 100.0, h = per_step / speed;
    const dmb_sim_options options = sharp_options(1.0, 1e-10);
    double gained = 0.0;
    rig s;
    dmb_body_def body = dmb_body_def_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    take_inertia(2.0, 0.004, 0.006, &body);
    body.inertia[2] = across;
    const double start[6] = {0.0, 0.5, 0.31, speed, 3.0, 0.0};
    memcpy(body.velocity, start, sizeof start);
    const dmb_id id = add_body(&s, &body);
    dmb_joint_def play = joint_between(DMB_JOINT_FREE, dmb_station(ground_id, 0, 0.0), dmb_station(id, 0, 0.0));
    play.origin_a[0] = play.origin_b[0] = 0.1;
    for (int c = 0; c < 3; c++) play.stop_low[c] = -0.02, play.stop_high[c] = 0.02;
    play.stop_stiffness = stiffness;
    (void)add_joint(&s, &play);
    assert_int_equal(mechanism_start(&s, &options), DMB_OK);
    const double before = energy_of(&s).kinetic;
    for (int i = 0; i < 4000; i++) {
        must(&s, dmb_sim_step(s.sim, h, NULL));
        const dmb_energy now = energy_of(&s);
        gained = fmax(gained, (now.kinetic + now.strain) / before - 1.0);
    }
    tell("    bounces", (double)statistics_of(&s).bounces);
    rig_close(&s);
    return gained;
}

/* Forces of stops that open are taken off the rotor's history in the right axes. */
static void a_rotor_between_stops_gains_no_energy(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++)
        check_below("energy gained in 4000 steps, of the kinetic",
                    energy_gained_between_stops((const double[]){0.1, 0.3, 1.0}[i], 1e3, 0.006), 1e-3);
}

/* A body that is not of revolution: more in test_spinning_stops. */
static void another_body_between_stops_gains_no_energy(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        const double stiffness = (const double[]){1e5, 1e7}[i % 2];
        check_below("energy gained at 0.01 and 0.1 rad a step",
                    energy_gained_between_stops(i < 2 ? 0.01 : 0.1, stiffness, 0.005), 0.01);
    }
}

/* ---- Steps by the error ------------------------------------------------------------------------------------------ */

/* Steps follow the precession, not the spin: 1e-6 m and rad a step take no more than a few. */
static void advance_takes_steps_of_the_precession(void **state)
{
    (void)state;
    gyroscope g = open_gyroscope(IN_CARRIER, NULL);
    dmb_step_report report = dmb_step_report_default();
    double round, tilt;
    must(&g.s, dmb_sim_advance(g.s.sim, 1.0, &report));
    angles_of(&g, &round, &tilt);
    tell("steps in 1 s at 1000 rad/s", report.steps);
    assert_true(report.steps < 200);
    check_below("precession", round / g.precession - 1.0, 1e-4);
    rig_close(&g.s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(precession_does_not_depend_on_the_spin_a_step),
        cmocka_unit_test(precession_is_of_second_order),
        cmocka_unit_test(a_rotor_at_the_end_of_a_string_precesses_right),
        cmocka_unit_test(fixed_to_a_string_the_error_grows_with_the_square_of_the_spin_a_step),
        cmocka_unit_test(turns_are_counted_at_ten_radians_a_step),
        cmocka_unit_test(a_rotor_between_stops_gains_no_energy),
        cmocka_unit_test(another_body_between_stops_gains_no_energy),
        cmocka_unit_test(advance_takes_steps_of_the_precession),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
