/* Flexible beams in large motion: the spin-up beam of Simo and Vu-Quoc, free flight, order of the scheme. */
#include <stdio.h>

#include "rig.h"

/* ---- Spin-up ----------------------------------------------------------------------------------------------------- */

/* Simo, Vu-Quoc 1986: psi' = (Om/T)(t - T/(2 pi) sin(2 pi t/T)) up to T, Om after; Om 6 rad/s, T 15 s. */
#define SPIN 6.0
#define RISE 15.0

static int32_t spin_up(void *context, double t, double out[3])
{
    const double k = 2.0 * PI / RISE, s = t < RISE ? t : RISE;
    (void)context;
    out[0] = SPIN / RISE * (s - sin(k * s) / k);
    out[1] = SPIN / RISE * (1.0 - cos(k * s));
    out[2] = SPIN / RISE * (0.5 * s * s + (cos(k * s) - 1.0) / (k * k)) + SPIN * (t - s);
    return 0;
}

/* EI 1.4e4, EA 2.8e7, GA 1e7, rho A 1.2, rho I 6e-4, L 10; turned about z at its rig end. */
static dmb_id open_spinning_beam(rig *s, uint32_t elements, double r, double tolerance)
{
    dmb_pipe_def beam = beam_pipe(10.0, elements, 2.8e7, 1e7, 1e4, 1.4e4);
    dmb_sim_options options = dmb_sim_options_default();
    beam.section_mass = 1.2;
    beam.section_inertia[0] = 1.2e-3;
    beam.section_inertia[1] = 6e-4;
    rig_open(s, 0.0, 0.0, 0.0);
    const dmb_id string = add_beam(s, &beam, DMB_FREE_RZ);
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, string, DMB_RZ, add_callback(s, spin_up, NULL));
    options.spectral_radius = r;
    options.newton_tolerance = tolerance;
    (void)rig_start(s, &options);
    return string;
}

/* Tip in the frame that turns with the rig end, less its place at rest. */
static void tip_of(const rig *s, dmb_id string, double u[2])
{
    const dmb_pose root = pose_at(s, dmb_station(string, 0, 0.0)), tip = pose_at(s, dmb_station(string, 0, 1.0));
    const double c = root.rotation[0], d = root.rotation[3];
    u[0] = c * tip.position[0] + d * tip.position[1] - 10.0;
    u[1] = -d * tip.position[0] + c * tip.position[1];
}

static void spin_up_beam(void **state)
{
    (void)state;
    rig s;
    double u[2], deepest = 0.0, when = 0.0;
    const double h = 2e-3;
    const dmb_id string = open_spinning_beam(&s, 16, 0.8, 1e-8);
    for (int i = 1; i <= 4000; i++) {
        take_steps(&s, h, 1);
        tip_of(&s, string, u);
        const double t = i * h;
        if (u[1] < deepest) deepest = u[1], when = t;
        if (i == 3750) {
            check_close("at 7.5 s: along", u[0], -0.017742, 2e-4);
            check_close("    across", u[1], -0.55908, 2e-4);
        }
    }
    check_close("largest deflection", deepest, -0.57383, 2e-4);
    check_close("    when [s]", when, 6.762, 5e-3);
    rig_close(&s);
}

/* Turning at 6 rad/s from the start, settled by material damping: the stretch tan(k L)/k - L, k^2 = rho A Om^2/EA. */
static double settled_stretch(uint32_t elements)
{
    rig s;
    double u[2];
    dmb_pipe_def beam = beam_pipe(10.0, elements, 2.8e7, 1e7, 1e4, 1.4e4);
    dmb_string_def def = dmb_string_def_default();
    beam.section_mass = 1.2;
    beam.section_inertia[0] = 1.2e-3;
    beam.section_inertia[1] = 6e-4;
    beam.damping_time = 0.2;
    def.start_free = DMB_FREE_RZ;
    def.velocity[5] = SPIN;
    rig_open(&s, 0.0, 0.0, 0.0);
    beam.string = add_string(&s, &def);
    const dmb_id string = add_pipes(&s, &beam, 1);
    (void)add_simple_drive(&s, DMB_DRIVE_MOTION, string, DMB_RZ, add_constant(&s, SPIN));
    (void)rig_start(&s, NULL);
    take_steps(&s, 5e-3, 4000);
    tip_of(&s, string, u);
    rig_close(&s);
    check_below("    across, settled", u[1], 1e-8);
    return u[0];
}

/* The mass, constant in the body frame, spreads the centrifugal force of an element by its cubic shapes: rho A Om^2
 * Le^2/60 too much at the far end, a stretch of second order in Le, 2e-4 of it with 16 elements. */
static void steady_stretch(void **state)
{
    (void)state;
    const double k = sqrt(1.2 * SPIN * SPIN / 2.8e7), want = 5.143174550e-4;
    check_relative("closed form of the stretch", tan(10.0 * k) / k - 10.0, want, 1e-9);
    const double coarse = settled_stretch(8), fine = settled_stretch(16);
    check_relative("steady stretch, 16 elements", fine, want, 2.2e-4);
    check_order("    8 and 16 elements", coarse - want, fine - want, 2.0, 0.1);
}

/* ---- Order ------------------------------------------------------------------------------------------------------- */

typedef struct spin_state {
    double place[3], velocity[3], reaction[6];
} spin_state;

static spin_state spin_to(double t, double h)
{
    rig s;
    spin_state out;
    const dmb_id string = open_spinning_beam(&s, 4, 0.8, 1e-13);
    take_steps(&s, h, (uint32_t)lround(t / h));
    const dmb_pose pose = pose_at(&s, dmb_station(string, 0, 1.0));
    const dmb_motion motion = motion_at(&s, dmb_station(string, 0, 1.0), DMB_FRAME_WORLD);
    for (int i = 0; i < 3; i++) out.place[i] = pose.position[i], out.velocity[i] = motion.velocity[i];
    must(&s, dmb_query_reaction(s.sim, string, out.reaction));
    rig_close(&s);
    return out;
}

/* Steps that resolve the bending of 4 elements; the reference takes 1/16 of the smallest. */
static void prescribed_rotation_is_of_second_order(void **state)
{
    (void)state;
    const spin_state exact = spin_to(2.0, 1e-3 / 64.0);
    double place[3], velocity[3], reaction[3];
    for (int k = 0; k < 3; k++) {
        const spin_state got = spin_to(2.0, 1e-3 / (1 << k));
        place[k] = largest_difference(3, got.place, exact.place);
        velocity[k] = largest_difference(3, got.velocity, exact.velocity);
        reaction[k] = largest_difference(6, got.reaction, exact.reaction);
        print_message("    h %.3g: place %.3g m, velocity %.3g m/s, reaction %.3g N, N m\n", 1e-3 / (1 << k), place[k],
                      velocity[k], reaction[k]);
    }
    check_order("place", place[1], place[2], 2.0, 0.05);
    check_order("velocity", velocity[1], velocity[2], 2.0, 0.05);
    check_order("reaction", reaction[1], reaction[2], 2.0, 0.05);
}

/* ---- Free flight ------------------------------------------------------------------------------------------------- */

/* L - c x p, and its size. Momentum about a point far away would tell the drift of p once more. */
static double moment_about_centre(const dmb_momentum *m, double out[3])
{
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = m->angular[i] - (m->centre[j] * m->linear[k] - m->centre[k] * m->linear[j]);
    }
    return largest(3, out);
}

typedef struct flight {
    double linear, angular, energy;
} flight;

/* S1 pipe of 4 elements, v (1, 2, 3), omega (20, 0, 6), free of everything for 2 s; largest drifts, relative. */
static flight fly(double h, double r)
{
    rig s;
    flight worst = {0.0, 0.0, 0.0};
    double about[2][3];
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def def = dmb_string_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    const double velocity[6] = {1.0, 2.0, 3.0, 20.0, 0.0, 6.0};
    rig_open(&s, 0.0, 0.0, 0.0);
    def.start_free = DMB_FREE_ALL;
    for (int i = 0; i < 6; i++) def.velocity[i] = velocity[i];
    pipe.elements = 4;
    pipe.string = add_string(&s, &def);
    (void)add_pipes(&s, &pipe, 1);
    options.spectral_radius = r;
    options.newton_tolerance = 1e-12;
    assert_int_equal(rig_start(&s, &options), DMB_OK);
    const dmb_momentum first = momentum_of(&s);
    const dmb_energy start = energy_of(&s);
    for (int i = 0; i < lround(2.0 / h); i++) {
        take_steps(&s, h, 1);
        const dmb_momentum m = momentum_of(&s);
        const dmb_energy e = energy_of(&s);
        worst.linear = fmax(worst.linear, largest_difference(3, m.linear, first.linear) / largest(3, first.linear));
        const double moment[2] = {moment_about_centre(&first, about[0]), moment_about_centre(&m, about[1])};
        worst.angular = fmax(worst.angular, largest_difference(3, about[1], about[0]) / moment[0]);
        assert_true(moment[1] > 0.0);
        worst.energy = fmax(worst.energy, fabs(e.kinetic + e.strain - start.kinetic) / start.kinetic);
    }
    rig_close(&s);
    return worst;
}

static void free_flight_keeps_momentum_and_energy(void **state)
{
    (void)state;
    const double radius[2] = {0.9, 1.0};
    for (int r = 0; r < 2; r++) {
        flight f[3];
        tell("spectral radius", radius[r]);
        for (int k = 0; k < 3; k++) {
            f[k] = fly(1e-3 / (1 << k), radius[r]);
            print_message("    h %.3g: drift of momentum %.3g, of moment of momentum %.3g, of energy %.3g\n",
                          1e-3 / (1 << k), f[k].linear, f[k].angular, f[k].energy);
        }
        check_below("    h 1e-3: momentum", f[0].linear, 1e-3);
        check_below("    moment of momentum", f[0].angular, 1e-3);
        check_below("    energy", f[0].energy, 1e-3);
        check_order("    momentum", f[1].linear, f[2].linear, 2.0, 0.1);
        check_order("    moment of momentum", f[1].angular, f[2].angular, 2.0, 0.2);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spin_up_beam),
        cmocka_unit_test(steady_stretch),
        cmocka_unit_test(prescribed_rotation_is_of_second_order),
        cmocka_unit_test(free_flight_keeps_momentum_and_energy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
