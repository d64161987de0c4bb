/* Stiffness of forces whose direction turns with the motion, in modes and responses: weight and loads of a string on
 * the axis of a bent hole, loads in hole axes on a body, dampers of joints that spin. Closed forms: a pendulum on an
 * arc, a body on springs, internal damping of a rotor. Checks eq:motion.weight-along, eq:motion.turn, eq:modes.skew and
 * eq:joints.speed-tangent. */
#include "harmonic.h"
#include "mechanism.h"
#include "modal.h"

#define RADIUS 50.0 /* [m] of the arc */
#define LENGTH 2.0  /* [m] of the string */

/* An arc of 60 degrees in a vertical plane, its middle at the world's origin and there along x; open above (sign 1) or
 * below (-1), without friction. */
static void add_arc(rig *s, double sign)
{
    const double half = PI / 6.0;
    const double survey[6] = {0.0, 0.5 * PI - sign * half, 0.0, 2.0 * half * RADIUS, 0.5 * PI + sign * half, 0.0};
    dmb_wall_def wall = dmb_wall_def_default();
    wall.survey = survey;
    wall.survey_count = 2;
    wall.origin[0] = -RADIUS * sin(half);
    wall.origin[2] = sign * RADIUS * (1.0 - cos(half));
    wall.friction_law = DMB_FRICTION_NONE;
    (void)add_wall(s, &wall);
}

/* Two axial-torsional pipes that slide along the middle of the arc. */
static dmb_id add_slider(rig *s)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    string.start_depth = RADIUS * PI / 6.0 - 0.5 * LENGTH;
    string.start_free = DMB_FREE_CYLINDRICAL;
    pipe.string = add_string(s, &string);
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    pipe.length = 0.5 * LENGTH;
    pipe.outer_diameter = 0.08;
    pipe.inner_diameter = 0.06;
    (void)add_pipes(s, &pipe, 2);
    return pipe.string;
}

/* s^2 of the lowest axial motion, by its eigenvalue. */
static double square_of_sliding(const rig *s)
{
    dmb_modes *modes = all_modes(s, DMB_MODES_UNDAMPED);
    double square = 0.0, least = (double)INFINITY;
    for (uint32_t i = 0; i < info_of(modes).count; i++) {
        const dmb_mode mode = mode_at(modes, i);
        const double re = mode.eigenvalue[0], im = mode.eigenvalue[1];
        if (mode.share[0] < 0.5 || re * re + im * im >= least) continue;
        least = re * re + im * im;
        square = re * re - im * im;
    }
    dmb_modes_destroy(&modes);
    return square;
}

/* w^2 = g/R times the mean of the cosines at the nodes, with which half of the weight is in the middle; at the top of
 * an arch it falls off either side at that rate. */
static void weight_on_an_arc(void **state)
{
    (void)state;
    for (int sign = 1; sign >= -1; sign -= 2) {
        const double want = -sign * 9.81 / RADIUS * 0.5 * (1.0 + cos(0.5 * LENGTH / RADIUS));
        rig s;
        rig_open(&s, 0.0, 0.0, -9.81);
        add_arc(&s, sign);
        (void)add_slider(&s);
        (void)rig_start(&s, NULL);
        (void)find_equilibrium(&s, NULL);
        check_relative(sign > 0 ? "string in a sag: s^2" : "string on a crest: s^2", square_of_sliding(&s), want, 1e-6);
        rig_close(&s);
    }
}

/* A load in world axes at the middle node in place of the weight: the string slides until its tangent is across it, and
 * swings there with w^2 = F/(R m). */
static void load_on_an_arc(void **state)
{
    (void)state;
    const double mass = dmb_pipe_def_default().density * 0.25 * PI * (0.08 * 0.08 - 0.06 * 0.06) * LENGTH;
    for (int side = -1; side <= 1; side += 2) {
        dmb_load_def load = dmb_load_def_default();
        rig s;
        rig_open(&s, 0.0, 0.0, 0.0);
        add_arc(&s, 1.0);
        load.place = dmb_station(add_slider(&s), 0, 1.0);
        load.force[0] = 100.0 * side;
        load.force[2] = -500.0;
        (void)add_load(&s, &load);
        (void)rig_start(&s, NULL);
        (void)find_equilibrium(&s, NULL);
        check_relative("string under a load: s^2", square_of_sliding(&s), -hypot(100.0, 500.0) / (RADIUS * mass), 1e-6);
        rig_close(&s);
    }
}

/* ---- Load in hole axes ------------------------------------------------------------------------------------------- */

/* A body of MASS on springs (turned: stiffness of its rotation) at rest under a force in hole axes; its place. */
#define MASS 10.0

static dmb_id open_held_body(rig *s, double sign, const double stiffness[3], double turned, double along, double across)
{
    dmb_body_def body = dmb_body_def_default();
    dmb_load_def load = dmb_load_def_default();
    rig_open(s, 0.0, 0.0, 0.0);
    add_arc(s, sign);
    body.mass = MASS;
    for (int i = 0; i < 3; i++) body.inertia[i] = 1.0;
    const dmb_id id = add_body(s, &body);
    load.place = dmb_station(id, 0, 0.0);
    dmb_joint_def joint = joint_between(DMB_JOINT_FREE, dmb_station(ground_id, 0, 0.0), load.place);
    for (int i = 0; i < 6; i++) joint.stiffness[i] = i < 3 ? stiffness[i] : turned;
    (void)add_joint(s, &joint);
    load.frame = DMB_FRAME_HOLE;
    load.force[0] = along, load.force[2] = across;
    (void)add_load(s, &load);
    (void)rig_start(s, NULL);
    (void)find_equilibrium(s, NULL);
    return id;
}

/* A body on springs k, pulled by F towards the centre of the arc: it moves in by d = F/k and swings about the centre
 * under k R/(R - d). */
static void body_pulled_to_the_centre(void **state)
{
    (void)state;
    const double k = 4000.0, springs[3] = {k, k, k};
    for (int sign = 1; sign >= -1; sign -= 2) {
        rig s;
        (void)open_held_body(&s, sign, springs, 3.0 * k, 0.0, sign * 0.2 * k);
        dmb_modes *modes = all_modes(&s, DMB_MODES_UNDAMPED);
        check_below("body pulled to the centre of a bend: swing along the hole",
                    closest_mode(modes, sqrt(k / MASS / (1.0 - 0.2 / RADIUS))), 1e-9);
        check_below("body pulled to the centre of a bend: across the hole", closest_mode(modes, sqrt(k / MASS)), 1e-9);
        dmb_modes_destroy(&modes);
        rig_close(&s);
    }
}

/* A body on springs kx, kz, pushed by F along the hole: F is constant and its direction t turns, K = diag(kx, kz) - F/r
 * n t^T in the plane of the arc, r the distance from its centre, which is not symmetric (eq:motion.turn). Its modes,
 * and displacements by a force of 40 rad/s. */
static void check_pushed(double sign, double F)
{
    const double k[2] = {4000.0, 7000.0}, springs[3] = {k[0], k[1], k[1]}, m = MASS, w = 40.0;
    rig s;
    const dmb_place place = dmb_station(open_held_body(&s, sign, springs, 30.0 * k[1], F, 0.0), 0, 0.0);
    const dmb_pose at = pose_at(&s, place);
    const double r[2] = {at.displacement[0], at.displacement[2] - sign * RADIUS}, c = F / hypot(r[0], r[1]);
    const double t[2] = {-sign * r[1] / hypot(r[0], r[1]), sign * r[0] / hypot(r[0], r[1])},
                 n[2] = {-sign * t[1], sign * t[0]};
    double K[2][2];
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) K[i][j] = (i == j ? k[i] : 0.0) - c * n[i] * t[j];
    const double mean = 0.5 * (K[0][0] + K[1][1]), half = sqrt(pow(0.5 * (K[0][0] - K[1][1]), 2) + K[0][1] * K[1][0]);
    dmb_modes *modes = all_modes(&s, DMB_MODES_UNDAMPED);
    check_below("body pushed along a bend: first mode", closest_mode(modes, sqrt((mean - half) / m)), 1e-10);
    check_below("  second mode", closest_mode(modes, sqrt((mean + half) / m)), 1e-10);
    dmb_modes_destroy(&modes);
    const double D[2][2] = {{K[0][0] - m * w * w, K[0][1]}, {K[1][0], K[1][1] - m * w * w}};
    const double det = D[0][0] * D[1][1] - D[0][1] * D[1][0];
    const double want[2][2] = {{D[1][1] / det, -D[0][1] / det}, {-D[1][0] / det, D[0][0] / det}};
    for (int out = 0; out < 2; out++)
        for (int in = 0; in < 2; in++) {
            const dmb_excitation force = force_at(place, in == 0 ? DMB_X : DMB_Z);
            const dmb_output moved = output_at(DMB_OUTPUT_VIBRATION, place, out == 0 ? DMB_X : DMB_Z);
            const double frequency = w / (2.0 * PI);
            double complex value;
            transfer(&s, NULL, &force, &moved, &frequency, 1, &value);
            check_below("  displacement by a force", cabs(value - want[out][in]) / fabs(want[0][0]), 1e-9);
        }
    rig_close(&s);
}

static void body_pushed_along_the_hole(void **state)
{
    (void)state;
    for (int sign = 1; sign >= -1; sign -= 2) {
        check_pushed(sign, 2000.0);
        check_pushed(sign, -9000.0);
    }
}

/* ---- String that lies in a bend ---------------------------------------------------------------------------------- */

/* Pipes on the low side of a bend, pushed along it by a load or by a bit at their end; undamped. */
static rig open_lying(uint32_t pipes, double radius, int bit, double push)
{
    const double length = 1.5 * pipes + 10.0, survey[6] = {0.0, 0.5 * PI, 0.0, length, 0.5 * PI, length / radius};
    dmb_wall_def wall = s1_hole();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_load_def load = dmb_load_def_default();
    dmb_bit_def drill = dmb_bit_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, -9.81);
    wall.friction_law = DMB_FRICTION_NONE;
    wall.restitution = 1.0;
    wall.survey = survey;
    wall.survey_count = 2;
    (void)add_wall(&s, &wall);
    string.start_free = DMB_FREE_NONE;
    drill.string = pipe.string = add_string(&s, &string);
    pipe.damping_time = 0.0;
    (void)add_pipes(&s, &pipe, pipes);
    drill.load = add_constant(&s, push);
    load.frame = DMB_FRAME_HOLE;
    load.place = dmb_station(pipe.string, pipes - 1, 1.0);
    load.force[0] = -push;
    if (bit)
        must_model(&s, dmb_model_add_bit(s.model, &drill, NULL));
    else
        (void)add_load(&s, &load);
    (void)rig_start(&s, NULL);
    (void)find_equilibrium(&s, NULL);
    return s;
}

/* Undamped modes by the symmetric part and refined, and by the general iteration of damped ones, all without damping:
 * dense and sparse, weak and stronger asymmetry. */
static void string_in_a_bend(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        rig s = open_lying(k & 1 ? 60 : 20, k & 2 ? 40.0 : 1500.0, k == 1 || k == 2, k & 2 ? 5e4 : 1e4);
        dmb_modes *modes = lowest_modes(&s, DMB_MODES_UNDAMPED, 10), *general = lowest_modes(&s, DMB_MODES_DAMPED, 10);
        double worst = 0.0;
        tell("string in a bend: asymmetry", info_of(modes).asymmetry);
        assert_true(info_of(modes).asymmetry > 1e-9);
        assert_int_equal(info_of(modes).count, 10);
        for (uint32_t i = 0; i < 10; i++)
            worst = fmax(worst, fabs(frequency_at(modes, i) / frequency_at(general, i) - 1.0));
        check_below("  modes by the general iteration", worst, 1e-9);
        check_below("  residual", info_of(modes).residual, 1e-9);
        dmb_modes_destroy(&modes);
        dmb_modes_destroy(&general);
        rig_close(&s);
    }
}

/* Modes that crowd, which the general iteration does not resolve: as many as asked for. */
static void long_string_in_a_bend(void **state)
{
    (void)state;
    rig s = open_lying(300, 1500.0, 1, 1e4);
    dmb_modes *modes = lowest_modes(&s, DMB_MODES_UNDAMPED, 10);
    assert_true(info_of(modes).asymmetry > 1e-9);
    assert_int_equal(info_of(modes).count, 10);
    check_below("300 pipes in a bend: residual of 10 modes", info_of(modes).residual, 1e-9);
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

/* ---- Damper that spins ------------------------------------------------------------------------------------------- */

#define AXIAL 1.2       /* [kg m2] of the rotor */
#define ACROSS 0.9      /* [kg m2] */
#define STIFFNESS 400.0 /* [N m/rad] */
#define DAMPING 3.0     /* [N m s] */

/* A rotor on a ball joint to a plate that is fixed. Coordinates of a joint are relative to its frame a: the plate's, or
 * the rotor's, whose damper then spins with it. */
static rig open_ball_rotor(int spins, double spin)
{
    dmb_body_def plate = dmb_body_def_default(), rotor = dmb_body_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    plate.mass = rotor.mass = 3.0;
    for (int i = 0; i < 3; i++) plate.inertia[i] = 1.0, rotor.inertia[i] = i == 0 ? AXIAL : ACROSS;
    rotor.velocity[3] = spin;
    const dmb_place on_plate = dmb_station(add_body(&s, &plate), 0, 0.0);
    const dmb_place on_rotor = dmb_station(add_body(&s, &rotor), 0, 0.0);
    (void)add_joint_between(&s, DMB_JOINT_FIXED, dmb_station(ground_id, 0, 0.0), on_plate);
    dmb_joint_def ball = joint_between(DMB_JOINT_SPHERICAL, spins ? on_rotor : on_plate, spins ? on_plate : on_rotor);
    for (int i = 4; i < 6; i++) {
        ball.stiffness[i] = STIFFNESS;
        ball.damping[i] = DAMPING;
    }
    (void)add_joint(&s, &ball);
    (void)rig_start(&s, NULL);
    return s;
}

/* Tilt z = y + i z in axes at rest: A z'' - i C w z' + k z + c (z' - i w z) = 0, without i w z of a damper at rest. A
 * damper that spins takes damping from the forward precession and gives it to the backward one. */
static void check_damper(int spins, double spin)
{
    const double complex b = DAMPING - AXIAL * spin * (double complex)_Complex_I;
    const double complex c = STIFFNESS - (spins ? spin * DAMPING : 0.0) * (double complex)_Complex_I;
    const double complex root = csqrt(b * b - 4.0 * ACROSS * c);
    rig s = open_ball_rotor(spins, spin);
    dmb_modes_options options = dmb_modes_options_default();
    options.kind = DMB_MODES_DAMPED;
    options.select = DMB_MODES_ALL;
    options.axes = DMB_MODES_AXES_AT_REST;
    dmb_modes *modes = find_modes(&s, &options);
    for (int sign = -1; sign <= 1; sign += 2) {
        const double complex want = (-b + sign * root) / (2.0 * ACROSS);
        double nearest = (double)INFINITY;
        for (uint32_t i = 0; i < info_of(modes).count; i++) {
            const dmb_mode mode = mode_at(modes, i);
            nearest = fmin(nearest, hypot(mode.eigenvalue[0] - creal(want), mode.eigenvalue[1] - fabs(cimag(want))));
        }
        print_message("    spin %g rad/s: %g %+g i\n", spin, creal(want), cimag(want));
        check_below(spins ? "damper that spins: eigenvalue" : "damper at rest: eigenvalue", nearest / cabs(want), 1e-9);
    }
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

static void dampers_of_a_rotor(void **state)
{
    (void)state;
    for (double spin = 10.0; spin < 100.0; spin *= 3.0)
        for (int spins = 0; spins < 2; spins++) check_damper(spins, spin);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(weight_on_an_arc),          cmocka_unit_test(load_on_an_arc),
        cmocka_unit_test(body_pulled_to_the_centre), cmocka_unit_test(body_pushed_along_the_hole),
        cmocka_unit_test(string_in_a_bend),          cmocka_unit_test(long_string_in_a_bend),
        cmocka_unit_test(dampers_of_a_rotor),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
