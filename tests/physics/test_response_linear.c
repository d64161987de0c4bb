/* Frequency response about a state of rest against closed forms: Jeffcott rotor, receptance of a cantilever with
 * structural damping, rods that drives move, a controlled mass; reciprocity; joints against shared nodes; growth of the
 * scene's own excitations with frequency. Equations: eq:response.direct, eq:response.eccentric, eq:motion.unbalance. */
#include <stdio.h>

#include "harmonic.h"

/* |got - want| / |want| */
static double violation(double complex got, double complex want)
{
    return cabs(got - want) / cabs(want);
}

/* ---- Jeffcott rotor ---------------------------------------------------------------------------------------------- */

/* k 1e6 N/m, m 50 kg, e 1e-4 m, damping ratio 0.02: e r^2/(1 - r^2 + 2 i zeta r), CASES "Modes and frequency
 * response". */
static void jeffcott_rotor(void **state)
{
    (void)state;
    const double ratio[5] = {0.5, 0.9, 1.0, 1.1, 2.0};
    const double amplitude[5] = {3.3321487799e-5, 4.1886342861e-4, 2.5e-3, 5.6394477810e-4, 1.3328595119e-4};
    const double natural = sqrt(1e6 / 50.0);
    double frequencies[5];
    double complex y[5], z[5], given[5];
    rig s;
    const dmb_id body = open_rotor(&s, 0.0);
    for (int i = 0; i < 5; i++) frequencies[i] = ratio[i] * natural / (2.0 * PI);
    const dmb_excitation own = input_of(DMB_EXCITATION_ECCENTRICITY, (dmb_id){0, 0}, DMB_X);
    dmb_excitation unbalance = force_at(dmb_station(body, 0, 0.0), DMB_RX);
    unbalance.kind = DMB_EXCITATION_UNBALANCE;
    const dmb_output at_y = output_at(DMB_OUTPUT_VIBRATION, dmb_station(body, 0, 0.0), DMB_Y);
    const dmb_output at_z = output_at(DMB_OUTPUT_VIBRATION, dmb_station(body, 0, 0.0), DMB_Z);
    transfer(&s, NULL, &own, &at_y, frequencies, 5, y);
    transfer(&s, NULL, &own, &at_z, frequencies, 5, z);
    transfer(&s, NULL, &unbalance, &at_y, frequencies, 5, given);
    for (int i = 0; i < 5; i++) {
        char what[64];
        const double r = ratio[i];
        const double complex exact = 1e-4 * r * r / (1.0 - r * r + 2.0 * i_ * 0.02 * r);
        (void)snprintf(what, sizeof what, "Jeffcott at r = %g: amplitude of the table", r);
        check_relative(what, cabs(y[i]), amplitude[i], 1e-6);
        check_below("    with phase, of the closed form", violation(y[i], exact), 1e-11);
        check_below("    z a quarter of a turn behind y", violation(z[i], -i_ * exact), 1e-11);
        check_below("    the same as a given unbalance of m e", violation(given[i] * 50.0 * 1e-4, exact), 1e-11);
    }
    check_close("phase at resonance", carg(y[2]) * 180.0 / PI, -90.0, 1e-9);
    rig_close(&s);
}

/* A disc that turns in itself: a centre of mass off along y or z alone, products of inertia alone. With W = w e_x the
 * centrifugal wrench is w^2 (m c_y, m c_z; I_xz, -I_xy) in the axes that turn: g_y + i g_z along y, g_z - i g_y along
 * z, of each half, against k - m w^2 or k_r - I w^2. */
static void eccentric_in_one_way(void **state)
{
    (void)state;
    const double k = 1e6, k_r = 4e4, m = 50.0, inertia = 2.0, frequency = 11.0, w = 2.0 * PI * frequency;
    for (int way = 0; way < 4; way++) {
        rig s;
        dmb_body_def disc = dmb_body_def_default();
        rig_open(&s, 0.0, 0.0, 0.0);
        disc.mass = m;
        for (int i = 0; i < 3; i++) disc.inertia[i] = inertia;
        disc.centre[1] = way == 0 ? 1e-4 : 0.0;
        disc.centre[2] = way == 1 ? 1e-4 : 0.0;
        disc.inertia[3] = way == 2 ? 0.01 : 0.0;
        disc.inertia[4] = way == 3 ? 0.01 : 0.0;
        disc.free_mask = way < 2 ? DMB_FREE_YZ : DMB_FREE_SPHERICAL;
        const dmb_place place = dmb_station(add_body(&s, &disc), 0, 0.0);
        dmb_joint_def shaft = joint_between(DMB_JOINT_FREE, dmb_station((dmb_id){0, 0}, 0, 0.0), place);
        shaft.stiffness[DMB_Y] = shaft.stiffness[DMB_Z] = k;
        shaft.stiffness[DMB_RY] = shaft.stiffness[DMB_RZ] = k_r;
        shaft.stiffness[DMB_RX] = 1e12; /* products of inertia couple it */
        (void)add_joint(&s, &shaft);
        (void)rig_start(&s, NULL);
        const double size = way < 2 ? m * 1e-4 : 0.01, left = way < 2 ? k - m * w * w : k_r - inertia * w * w;
        const double g[2] = {way == 0 || way == 3 ? size : 0.0, way == 1 ? size : way == 2 ? -size : 0.0};
        const dmb_excitation own = input_of(DMB_EXCITATION_ECCENTRICITY, (dmb_id){0, 0}, DMB_X);
        double complex got[2];
        for (int c = 0; c < 2; c++) {
            const dmb_output move = output_at(DMB_OUTPUT_VIBRATION, place, (way < 2 ? DMB_Y : DMB_RY) + c);
            transfer(&s, NULL, &own, &move, &frequency, 1, got + c);
        }
        check_below("eccentric in one way: y", violation(got[0], w * w * (g[0] + i_ * g[1]) / left), 1e-11);
        check_below("    z", violation(got[1], w * w * (g[1] - i_ * g[0]) / left), 1e-11);
        rig_close(&s);
    }
}

/* The rotor without eccentricity while it spins at W: in axes that spin with it, zeta = (y + i z) e^(-i W t), a force
 * f = f_y + i f_z there gives m (zeta'' + 2 i W zeta' - W^2 zeta) + c (zeta' + i W zeta) + k zeta = f. Two equations
 * for the amplitudes of y and z, [a, -b; b, a] with a = k - m (w^2 + W^2) + i w c, b = 2 i w m W + c W. */
static void spinning_rotor(void **state)
{
    (void)state;
    const double k = 1e6, m = 50.0, c = 2.0 * 0.02 * sqrt(k * m), W = 90.0;
    const double frequencies[3] = {3.0, 9.0, 40.0};
    double complex y[3], z[3];
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    dmb_body_def disc = dmb_body_def_default();
    disc.mass = m;
    disc.free_mask = DMB_FREE_Y | DMB_FREE_Z | DMB_FREE_RX;
    disc.velocity[3] = W;
    const dmb_id body = add_body(&s, &disc);
    dmb_joint_def shaft = dmb_joint_def_default();
    shaft.kind = DMB_JOINT_FREE;
    shaft.place_b = dmb_station(body, 0, 0.0);
    shaft.stiffness[1] = shaft.stiffness[2] = k;
    shaft.damping[1] = shaft.damping[2] = c;
    must_model(&s, dmb_model_add_joint(s.model, &shaft, NULL));
    (void)add_simple_drive(&s, DMB_DRIVE_MOTION, body, DMB_RX, add_constant(&s, W));
    (void)rig_start(&s, NULL);
    take_steps(&s, 1e-3, 7);
    dmb_excitation force = force_at(shaft.place_b, DMB_Y);
    const dmb_output at_y = output_at(DMB_OUTPUT_VIBRATION_BODY, shaft.place_b, DMB_Y);
    const dmb_output at_z = output_at(DMB_OUTPUT_VIBRATION_BODY, shaft.place_b, DMB_Z);
    force.frame = DMB_FRAME_BODY;
    transfer(&s, NULL, &force, &at_y, frequencies, 3, y);
    transfer(&s, NULL, &force, &at_z, frequencies, 3, z);
    for (int i = 0; i < 3; i++) {
        const double w = 2.0 * PI * frequencies[i];
        const double complex a = k - m * (w * w + W * W) + i_ * w * c, b = 2.0 * i_ * w * m * W + c * W;
        check_below("spinning rotor, its own axes: along the force", violation(y[i], a / (a * a + b * b)), 1e-9);
        check_below("    across it", violation(z[i], -b / (a * a + b * b)), 1e-9);
    }
    rig_close(&s);
}

/* ---- Cantilever -------------------------------------------------------------------------------------------------- */

static dmb_pipe_def euler_bernoulli(uint32_t elements)
{
    dmb_pipe_def pipe = s1_pipe();
    pipe.elements = elements;
    pipe.shear_factor = 1e6; /* no shear, no rotary inertia */
    pipe.section_inertia[1] = 1e-9;
    return pipe;
}

/* Tip receptance of S1, 1.5 m, structural damping 0.01; CASES. */
static void receptance_of_a_cantilever(void **state)
{
    (void)state;
    const double frequencies[5] = {10.0, 29.0, 30.0, 100.0, 200.0};
    const double receptance[5] = {6.3904810132e-6, 1.9389114783e-4, 1.2818985402e-4, 2.9504126059e-7, 8.7433906581e-7};
    double complex h[5];
    double last = 1.0;
    dmb_response_options options = dmb_response_options_default();
    options.structural_damping = 0.01;
    for (uint32_t elements = 2; elements <= 16; elements *= 2) {
        rig s;
        double worst = 0.0;
        const dmb_pipe_def pipe = euler_bernoulli(elements);
        rig_open(&s, 0.0, 0.0, 0.0);
        const dmb_id string = add_beam(&s, &pipe, DMB_FREE_NONE);
        (void)rig_start(&s, NULL);
        const dmb_place tip = dmb_station(string, 0, 1.0);
        const dmb_excitation force = force_at(tip, DMB_Z);
        const dmb_output move = output_at(DMB_OUTPUT_VIBRATION, tip, DMB_Z);
        transfer(&s, &options, &force, &move, frequencies, 5, h);
        for (int i = 0; i < 5; i++) worst = fmax(worst, fabs(cabs(h[i]) / receptance[i] - 1.0));
        print_message("tip receptance, %u elements: worst of five frequencies %.3e\n", elements, worst);
        assert_true(worst < last);
        last = worst;
        rig_close(&s);
    }
    check_below("tip receptance, 16 elements, of the table", last, 1e-4);
}

/* ---- Drives ------------------------------------------------------------------------------------------------------ */

/* A rod that a drive moves along at unit speed at its rig end: displacement 1/(i w) cos(k x)/cos(k L) from the free
 * end, normal force there 0 and at the drive EA k tan(k L)/(i w), k = w/c; and the same in torsion (component DMB_RX).
 * The larger of the two errors over three frequencies. */
static double rod_moved_at_its_end(int32_t c, uint32_t elements)
{
    const double frequencies[3] = {1.0, 5.0, 12.0};
    const s1_section v = s1_values();
    const double stiffness = c == DMB_X ? v.EA : v.GJ, inertia = c == DMB_X ? v.mass : 7850.0 * 2.0 * v.I;
    double complex tip[3], section[3];
    double worst = 0.0;
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    def.follows_hole = 0;
    pipe.elements = elements;
    pipe.string = add_string(&s, &def);
    (void)add_pipes(&s, &pipe, 100);
    const dmb_id drive = add_simple_drive(&s, DMB_DRIVE_MOTION, pipe.string, c, add_constant(&s, 0.0));
    (void)rig_start(&s, NULL);
    const dmb_place end = dmb_station(pipe.string, 99, 1.0), start = dmb_station(pipe.string, 0, 0.0);
    const dmb_excitation input = input_of(DMB_EXCITATION_DRIVE, drive, DMB_X);
    const dmb_output move = output_at(DMB_OUTPUT_VIBRATION, end, c);
    const dmb_output load = output_at(DMB_OUTPUT_SECTION_FORCE, start, c);
    transfer(&s, NULL, &input, &move, frequencies, 3, tip);
    transfer(&s, NULL, &input, &load, frequencies, 3, section);
    for (int i = 0; i < 3; i++) {
        const double w = 2.0 * PI * frequencies[i], k = w * sqrt(inertia / stiffness);
        worst = fmax(worst, violation(tip[i], 1.0 / (i_ * w * cos(k * 150.0))));
        worst = fmax(worst, violation(section[i], stiffness * k * tan(k * 150.0) / (i_ * w)));
    }
    rig_close(&s);
    return worst;
}

/* Linear shapes along the rod: second order. */
static void moved_rods(void **state)
{
    (void)state;
    for (int32_t c = DMB_X; c <= DMB_RX; c += 3) {
        const double coarse = rod_moved_at_its_end(c, 1), fine = rod_moved_at_its_end(c, 2);
        check_below(c == DMB_X ? "rod moved along, 200 elements" : "rod turned, 200 elements", fine, 2e-4);
        check_order("    order in the length of elements", coarse, fine, 2.0, 0.1);
    }
}

/* m v' = kp (v* - v) + ki integral(v* - v): v/v* = (kp + ki/(i w))/(i w m + kp + ki/(i w)). And a load drive: F/(i w
 * m). */
static void controlled_mass(void **state)
{
    (void)state;
    const double frequencies[4] = {0.01, 0.3, 2.0, 50.0};
    double complex h[4], free[4];
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    dmb_body_def def = dmb_body_def_default();
    def.mass = 7.0;
    def.free_mask = DMB_FREE_X;
    const dmb_id body = add_body(&s, &def);
    dmb_drive_def drive = dmb_drive_def_default();
    drive.kind = DMB_DRIVE_CONTROL;
    drive.part = body;
    drive.gain = 40.0;
    drive.integral_gain = 300.0;
    drive.time_function = add_constant(&s, 0.0);
    const dmb_id control = add_drive(&s, &drive);
    const dmb_id other = add_body(&s, &def);
    const dmb_id push = add_simple_drive(&s, DMB_DRIVE_LOAD, other, DMB_X, add_constant(&s, 0.0));
    (void)rig_start(&s, NULL);
    const dmb_excitation input = input_of(DMB_EXCITATION_DRIVE, control, DMB_X),
                         force = input_of(DMB_EXCITATION_DRIVE, push, DMB_X);
    const dmb_output v = output_at(DMB_OUTPUT_VIBRATION_VELOCITY, dmb_station(body, 0, 0.0), DMB_X);
    const dmb_output a = output_at(DMB_OUTPUT_VIBRATION_ACCELERATION, dmb_station(other, 0, 0.0), DMB_X);
    transfer(&s, NULL, &input, &v, frequencies, 4, h);
    transfer(&s, NULL, &force, &a, frequencies, 4, free);
    for (int i = 0; i < 4; i++) {
        const double complex iw = 2.0 * PI * frequencies[i] * i_, c = 40.0 + 300.0 / iw;
        check_below("controlled mass: speed over target", violation(h[i], c / (7.0 * iw + c)), 1e-8);
        check_below("    acceleration of a free mass under a load drive", violation(free[i], 1.0 / 7.0), 1e-12);
    }
    rig_close(&s);
}

/* ---- Reciprocity, joints ----------------------------------------------------------------------------------------- */

enum { PIPES = 6, MANY = 60 };

/* Six pipes of S1 with damping, clamped at the rig end; with joints: in two strings that a fixed joint connects. */
static void open_chain(rig *s, int32_t joined, dmb_place *near, dmb_place *far)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    const uint32_t first = joined ? PIPES / 2 : PIPES;
    rig_open(s, 0.0, 0.0, -9.81);
    def.follows_hole = 0;
    def.start_free = DMB_FREE_NONE;
    pipe.damping_time = 1e-4;
    pipe.string = add_string(s, &def);
    (void)add_pipes(s, &pipe, first);
    *near = dmb_station(pipe.string, 1, 0.4);
    if (joined) {
        dmb_joint_def joint = dmb_joint_def_default();
        joint.place_a = dmb_station(pipe.string, first - 1, 1.0);
        def.position[0] = 1.5 * first;
        def.start_free = DMB_FREE_ALL;
        pipe.string = add_string(s, &def);
        (void)add_pipes(s, &pipe, PIPES - first);
        joint.place_b = dmb_station(pipe.string, 0, 0.0);
        must_model(s, dmb_model_add_joint(s->model, &joint, NULL));
    }
    *far = dmb_station(pipe.string, PIPES - 1 - (PIPES - (joined ? PIPES - first : PIPES)), 0.7);
    (void)rig_start(s, NULL);
    (void)find_equilibrium(s, NULL);
}

/* H_ab = H_ba between any two components of two places inside pipes that sag under their weight (Maxwell, Betti). */
static void reciprocity(void **state)
{
    (void)state;
    const double frequencies[3] = {0.0, 3.0, 70.0};
    rig s;
    dmb_place a, b;
    double worst = 0.0;
    open_chain(&s, 0, &a, &b);
    for (int32_t i = DMB_X; i <= DMB_RZ; i++)
        for (int32_t k = DMB_X; k <= DMB_RZ; k++) {
            double complex there[3], back[3], own_a[3], own_b[3];
            const dmb_excitation at_a = force_at(a, i), at_b = force_at(b, k);
            const dmb_output of_a = output_at(DMB_OUTPUT_VIBRATION, a, i);
            const dmb_output of_b = output_at(DMB_OUTPUT_VIBRATION, b, k);
            transfer(&s, NULL, &at_a, &of_b, frequencies, 3, there);
            transfer(&s, NULL, &at_b, &of_a, frequencies, 3, back);
            transfer(&s, NULL, &at_a, &of_a, frequencies, 3, own_a);
            transfer(&s, NULL, &at_b, &of_b, frequencies, 3, own_b);
            for (int f = 0; f < 3; f++)
                worst = fmax(worst, cabs(there[f] - back[f]) / sqrt(cabs(own_a[f]) * cabs(own_b[f])));
        }
    check_below("reciprocity of 36 pairs, of the direct receptances", worst, 1e-9);
    rig_close(&s);
}

/* Forces on what supports hold, and eccentric masses there, go into the supports. Of a pipe that only slides and turns
 * at its rig end, half an eccentric element hangs on the first node: the rest shakes as if that half were not there. */
static void forces_on_supports(void **state)
{
    (void)state;
    const double frequency = 3.0;
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    def.follows_hole = 0;
    pipe.eccentricity = 1e-3;
    pipe.string = add_string(&s, &def);
    (void)add_pipes(&s, &pipe, 2);
    (void)rig_start(&s, NULL);
    const dmb_place support = dmb_station(pipe.string, 0, 0.0), tip = dmb_station(pipe.string, 1, 1.0);
    const dmb_place middle = dmb_station(pipe.string, 0, 1.0);
    const dmb_output move = output_at(DMB_OUTPUT_VIBRATION, tip, DMB_Y);
    double complex none, own, at_middle, at_tip;
    dmb_excitation force = force_at(support, DMB_Y);
    transfer(&s, NULL, &force, &move, &frequency, 1, &none);
    check_below("force on a support: displacement of the tip", cabs(none), 0.0);
    const dmb_excitation eccentric = input_of(DMB_EXCITATION_ECCENTRICITY, (dmb_id){0, 0}, DMB_X);
    transfer(&s, NULL, &eccentric, &move, &frequency, 1, &own);
    force = force_at(middle, DMB_Y);
    force.kind = DMB_EXCITATION_UNBALANCE;
    transfer(&s, NULL, &force, &move, &frequency, 1, &at_middle);
    force.place = tip;
    transfer(&s, NULL, &force, &move, &frequency, 1, &at_tip);
    const double unbalance = 1.5 * s1_values().mass * 1e-3;
    check_below("eccentric pipes against unbalance at their free nodes",
                violation(own, unbalance * (at_middle + 0.5 * at_tip)), 1e-12);
    rig_close(&s);
}

/* Drawn in two strings with a fixed joint, the nodes of the joint are condensed; the response is that of one string. */
static void joint_against_shared_node(void **state)
{
    (void)state;
    const double frequencies[4] = {0.0, 0.6, 3.0, 70.0};
    rig one, two;
    dmb_place a, b, c, d;
    double worst = 0.0;
    open_chain(&one, 0, &a, &b);
    open_chain(&two, 1, &c, &d);
    for (int32_t i = DMB_X; i <= DMB_RZ; i++) {
        double complex x[4], y[4], p[4], q[4];
        const dmb_excitation at_a = force_at(a, i), at_c = force_at(c, i);
        const dmb_output of_b = output_at(DMB_OUTPUT_VIBRATION, b, i);
        const dmb_output of_d = output_at(DMB_OUTPUT_VIBRATION, d, i);
        const dmb_output load_b = output_at(DMB_OUTPUT_SECTION_FORCE, a, i);
        const dmb_output load_d = output_at(DMB_OUTPUT_SECTION_FORCE, c, i);
        transfer(&one, NULL, &at_a, &of_b, frequencies, 4, x);
        transfer(&two, NULL, &at_c, &of_d, frequencies, 4, y);
        transfer(&one, NULL, &at_a, &load_b, frequencies, 4, p);
        transfer(&two, NULL, &at_c, &load_d, frequencies, 4, q);
        for (int f = 0; f < 4; f++) worst = fmax(worst, fmax(violation(y[f], x[f]), violation(q[f], p[f])));
    }
    check_below("two strings and a fixed joint against one string", worst, 1e-9);
    rig_close(&one);
    rig_close(&two);
}

/* Sixty pipes of S1, clamped at the rig end, as one string or each as a string of its own, fixed to the one before. */
static dmb_place open_many(rig *s, int32_t joined)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    rig_open(s, 0.0, 0.0, 0.0);
    def.follows_hole = 0;
    pipe.damping_time = 1e-4;
    dmb_joint_def joint = dmb_joint_def_default();
    for (uint32_t i = 0; i < (joined ? MANY : 1); i++) {
        def.position[0] = 1.5 * i;
        def.start_free = i == 0 ? DMB_FREE_NONE : DMB_FREE_ALL;
        pipe.string = add_string(s, &def);
        (void)add_pipes(s, &pipe, joined ? 1 : MANY);
        joint.place_b = dmb_station(pipe.string, 0, 0.0);
        if (i > 0) must_model(s, dmb_model_add_joint(s->model, &joint, NULL));
        joint.place_a = dmb_station(pipe.string, 0, 1.0);
    }
    (void)rig_start(s, NULL);
    return dmb_station(pipe.string, joined ? 0 : MANY - 1, 1.0);
}

static void many_joints_against_none(void **state)
{
    (void)state;
    const double frequencies[4] = {0.0, 0.01, 3.0, 70.0};
    rig one, many;
    double worst = 0.0;
    const dmb_place a = open_many(&one, 0), b = open_many(&many, 1);
    for (int32_t c = DMB_X; c <= DMB_RZ; c++) {
        double complex x[4], y[4];
        const dmb_excitation at_a = force_at(a, c), at_b = force_at(b, c);
        const dmb_output of_a = output_at(DMB_OUTPUT_VIBRATION, a, c);
        const dmb_output of_b = output_at(DMB_OUTPUT_VIBRATION, b, c);
        transfer(&one, NULL, &at_a, &of_a, frequencies, 4, x);
        transfer(&many, NULL, &at_b, &of_b, frequencies, 4, y);
        for (int f = 0; f < 4; f++) worst = fmax(worst, violation(y[f], x[f]));
    }
    check_below("59 fixed joints against one string, tip receptances", worst, 1e-7);
    rig_close(&one);
    rig_close(&many);
}

/* Six pipes that are turned at the rig end, by a drive of the string or of a joint that holds it. */
static dmb_id open_turned(rig *s, int32_t jointed, int32_t kind, dmb_place *tip)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_drive_def drive = dmb_drive_def_default();
    rig_open(s, 0.0, 0.0, 0.0);
    def.follows_hole = 0;
    def.start_free = jointed ? DMB_FREE_ALL : DMB_FREE_RX;
    pipe.damping_time = 1e-4;
    pipe.string = add_string(s, &def);
    (void)add_pipes(s, &pipe, PIPES);
    drive.part = pipe.string;
    if (jointed) {
        dmb_joint_def bearing = dmb_joint_def_default();
        bearing.kind = DMB_JOINT_REVOLUTE;
        bearing.place_b = dmb_station(pipe.string, 0, 0.0);
        must_model(s, dmb_model_add_joint(s->model, &bearing, &drive.part));
    }
    drive.kind = kind;
    drive.component = DMB_RX;
    drive.time_function = add_constant(s, 0.0);
    drive.gain = 300.0;
    drive.integral_gain = 2000.0;
    drive.limit_low = -500.0;
    drive.limit_high = 700.0;
    const dmb_id id = add_drive(s, &drive);
    *tip = dmb_station(pipe.string, PIPES - 1, 1.0);
    (void)rig_start(s, NULL);
    return id;
}

/* Speed, torque and control of a revolute joint against those of the string's own support. */
static void drives_of_joints(void **state)
{
    (void)state;
    const double frequencies[3] = {0.5, 11.0, 200.0};
    for (int32_t kind = DMB_DRIVE_MOTION; kind <= DMB_DRIVE_CONTROL; kind++) {
        static const char *const names[3] = {"motion", "load", "control"};
        char what[64];
        double complex x[3], y[3];
        double worst = 0.0;
        rig own, jointed;
        dmb_place a, b;
        const dmb_excitation of_string = input_of(DMB_EXCITATION_DRIVE, open_turned(&own, 0, kind, &a), DMB_X);
        const dmb_excitation of_joint = input_of(DMB_EXCITATION_DRIVE, open_turned(&jointed, 1, kind, &b), DMB_X);
        const dmb_output at_a = output_at(DMB_OUTPUT_VIBRATION, a, DMB_RX);
        const dmb_output at_b = output_at(DMB_OUTPUT_VIBRATION, b, DMB_RX);
        transfer(&own, NULL, &of_string, &at_a, frequencies, 3, x);
        transfer(&jointed, NULL, &of_joint, &at_b, frequencies, 3, y);
        for (int f = 0; f < 3; f++) worst = fmax(worst, violation(y[f], x[f]));
        (void)snprintf(what, sizeof what, "%s drive of a joint against that of the string", names[kind]);
        check_below(what, worst, 1e-9);
        rig_close(&own);
        rig_close(&jointed);
    }
}

/* The same string fixed to a chuck, a body that a motion drive turns, against its own drive. */
static void drive_of_a_part_with_joints(void **state)
{
    (void)state;
    const double frequencies[3] = {0.5, 11.0, 200.0};
    double complex x[3], y[3], p[3], q[3];
    double worst = 0.0;
    rig own, s;
    dmb_place a;
    const dmb_excitation of_string = input_of(DMB_EXCITATION_DRIVE, open_turned(&own, 0, DMB_DRIVE_MOTION, &a), DMB_X);
    rig_open(&s, 0.0, 0.0, 0.0);
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_body_def chuck = dmb_body_def_default();
    dmb_joint_def jaws = dmb_joint_def_default();
    chuck.mass = 40.0;
    chuck.free_mask = DMB_FREE_RX;
    def.follows_hole = 0;
    def.start_free = DMB_FREE_ALL;
    pipe.damping_time = 1e-4;
    pipe.string = add_string(&s, &def);
    (void)add_pipes(&s, &pipe, PIPES);
    jaws.place_a = dmb_station(add_body(&s, &chuck), 0, 0.0);
    jaws.place_b = dmb_station(pipe.string, 0, 0.0);
    must_model(&s, dmb_model_add_joint(s.model, &jaws, NULL));
    const dmb_id drive = add_simple_drive(&s, DMB_DRIVE_MOTION, jaws.place_a.part, DMB_RX, add_constant(&s, 0.0));
    (void)rig_start(&s, NULL);
    const dmb_place b = dmb_station(pipe.string, PIPES - 1, 1.0);
    const dmb_excitation of_chuck = input_of(DMB_EXCITATION_DRIVE, drive, DMB_X);
    const dmb_output at_a = output_at(DMB_OUTPUT_VIBRATION, a, DMB_RX);
    const dmb_output at_b = output_at(DMB_OUTPUT_VIBRATION, b, DMB_RX);
    const dmb_output in_a = output_at(DMB_OUTPUT_SECTION_FORCE, dmb_station(a.part, 0, 0.0), DMB_RX);
    const dmb_output in_b = output_at(DMB_OUTPUT_SECTION_FORCE, jaws.place_b, DMB_RX);
    transfer(&own, NULL, &of_string, &at_a, frequencies, 3, x);
    transfer(&s, NULL, &of_chuck, &at_b, frequencies, 3, y);
    transfer(&own, NULL, &of_string, &in_a, frequencies, 3, p);
    transfer(&s, NULL, &of_chuck, &in_b, frequencies, 3, q);
    for (int f = 0; f < 3; f++) worst = fmax(worst, fmax(violation(y[f], x[f]), violation(q[f], p[f])));
    check_below("motion drive of a chuck against that of the string", worst, 1e-9);
    rig_close(&own);
    rig_close(&s);
}

/* ---- Peaks, all inputs together ---------------------------------------------------------------------------------- */

/* x/F of a mass of 1 kg on 1000 N/m with damping ratio 1e-4: a peak far narrower than the grid is found to the width of
 * the last interval; two inputs with amplitudes and phases add up. */
static void peaks_and_sums(void **state)
{
    (void)state;
    enum { GRID = 40, LEVELS = 24, ROOM = GRID + 8 * LEVELS };
    const double natural = sqrt(1000.0) / (2.0 * PI);
    double frequencies[ROOM], highest = 0.0, at = 0.0, off = 0.0;
    double complex all[ROOM], one[ROOM], two[ROOM];
    uint32_t shape[3];
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    dmb_body_def mass = dmb_body_def_default();
    mass.free_mask = DMB_FREE_X;
    const dmb_id body = add_body(&s, &mass);
    dmb_joint_def spring = dmb_joint_def_default();
    spring.kind = DMB_JOINT_FREE;
    spring.place_b = dmb_station(body, 0, 0.0);
    spring.stiffness[0] = 1000.0;
    spring.damping[0] = 2.0 * 1e-4 * sqrt(1000.0);
    must_model(&s, dmb_model_add_joint(s.model, &spring, NULL));
    (void)rig_start(&s, NULL);
    dmb_excitation inputs[2] = {force_at(spring.place_b, DMB_X), force_at(spring.place_b, DMB_X)};
    inputs[0].amplitude = 2.0;
    inputs[1].kind = DMB_EXCITATION_UNBALANCE;
    inputs[1].amplitude = 0.3;
    inputs[1].phase = 0.7;
    const dmb_output output = output_at(DMB_OUTPUT_VIBRATION, spring.place_b, DMB_X);
    dmb_response_options options = dmb_response_options_default();
    dmb_response *response = NULL;
    options.points = GRID;
    options.logarithmic = 1;
    options.refinement = LEVELS;
    must(&s, dmb_analysis_response(s.sim, &options, inputs, 2, &output, 1, &response));
    assert_int_equal(dmb_response_dimensions(response, shape), DMB_OK);
    assert_true(shape[0] > GRID && shape[0] <= ROOM);
    assert_int_equal(dmb_response_frequencies(response, frequencies), DMB_OK);
    assert_int_equal(dmb_response_transfer(response, 0, 0, (double *)one), DMB_OK);
    assert_int_equal(dmb_response_transfer(response, 1, 0, (double *)two), DMB_OK);
    assert_int_equal(dmb_response_transfer(response, DMB_COMBINED, 0, (double *)all), DMB_OK);
    for (uint32_t i = 0; i < shape[0]; i++) {
        if (i > 0) assert_true(frequencies[i] > frequencies[i - 1]);
        off = fmax(off, violation(all[i], 2.0 * one[i] + 0.3 * cexp(0.7 * i_) * two[i]));
        if (cabs(one[i]) > highest) highest = cabs(one[i]), at = frequencies[i];
    }
    print_message("%u points\n", shape[0]);
    check_relative("refined peak: frequency", at, natural * sqrt(1.0 - 2e-8), 1e-6);
    check_relative("    height", highest, 1.0 / (1000.0 * 2e-4 * sqrt(1.0 - 1e-8)), 1e-3);
    check_below("    combined response less the sum of both", off, 1e-12);
    dmb_response_destroy(&response);
    rig_close(&s);
}

/* ---- The scene's own excitations --------------------------------------------------------------------------------- */

/* S1 at rest in its hole, eccentric pipes: rubbing is as strong at any frequency, eccentric forces grow with its
 * square, so that below all resonances one leads and the other above a crossover (lib/theory/reference-study.md). */
static void eccentricity_grows_friction_does_not(void **state)
{
    (void)state;
    const double frequencies[3] = {1e-4, 1e-3, 1e-2};
    double complex rub[3], whirl[3];
    rig s;
    rig_open(&s, 0.0, 0.0, -9.81);
    dmb_wall_def hole = s1_hole();
    dmb_pipe_def pipe = s1_pipe();
    pipe.eccentricity = 1e-3;
    hole.friction_law = DMB_FRICTION_NONE;
    (void)add_wall(&s, &hole);
    dmb_string_def def = dmb_string_def_default();
    def.start_free = DMB_FREE_NONE;
    pipe.string = add_string(&s, &def);
    (void)add_pipes(&s, &pipe, 20);
    (void)rig_start(&s, NULL);
    (void)find_equilibrium(&s, NULL);
    const dmb_excitation friction = input_of(DMB_EXCITATION_FRICTION, (dmb_id){0, 0}, DMB_X);
    const dmb_excitation own = input_of(DMB_EXCITATION_ECCENTRICITY, (dmb_id){0, 0}, DMB_X);
    const dmb_output axial = output_at(DMB_OUTPUT_SECTION_FORCE, dmb_station(pipe.string, 0, 0.0), DMB_X);
    const dmb_output sideways = output_at(DMB_OUTPUT_VIBRATION, dmb_station(pipe.string, 10, 0.5), DMB_Y);
    transfer(&s, NULL, &friction, &axial, frequencies, 3, rub);
    transfer(&s, NULL, &own, &sideways, frequencies, 3, whirl);
    check_close("friction: slope of the response by frequency", log10(cabs(rub[1]) / cabs(rub[0])), 0.0, 1e-6);
    check_close("eccentricity: slope", log10(cabs(whirl[1]) / cabs(whirl[0])), 2.0, 1e-6);
    const dmb_excitation around = input_of(DMB_EXCITATION_FRICTION, (dmb_id){0, 0}, DMB_RX);
    const dmb_output torque = output_at(DMB_OUTPUT_SECTION_FORCE, dmb_station(pipe.string, 0, 0.0), DMB_RX);
    double complex turn[3];
    transfer(&s, NULL, &around, &torque, frequencies, 3, turn);
    check_relative("torque of the rings over their normal forces times their radius",
                   cabs(turn[0]) / contacts_of(&s).normal_force, 0.0365, 1e-5);
    /* a coefficient of one drags with the weight of the string on its rings; the rig end's own ring rests on its
     * support
     */
    const double weight = s1_values().weight * 30.0;
    print_message("    drag for a coefficient of 1: %.3f of the weight\n", creal(rub[0]) / weight);
    check_close("    drag of the rings over the sum of their normal forces",
                creal(rub[0]) / contacts_of(&s).normal_force, 1.0, 1e-9);
    rig_close(&s);
}

/* Bottom-hole load acts against the feed at the bit, as a force there does. */
static void load_on_the_bit(void **state)
{
    (void)state;
    const double frequencies[3] = {0.0, 4.0, 90.0};
    double complex by_load[3], by_force[3];
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    dmb_bit_def def = dmb_bit_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_id bit = {0, 0};
    string.start_free = DMB_FREE_NONE;
    pipe.string = add_string(&s, &string);
    (void)add_pipes(&s, &pipe, 4);
    def.string = pipe.string;
    def.load = add_constant(&s, 100.0);
    must_model(&s, dmb_model_add_bit(s.model, &def, &bit));
    (void)rig_start(&s, NULL);
    (void)find_equilibrium(&s, NULL);
    const dmb_excitation load = input_of(DMB_EXCITATION_BIT_LOAD, bit, DMB_X);
    const dmb_excitation force = force_at(dmb_station(bit, 0, 0.0), DMB_X);
    const dmb_output thrust = output_at(DMB_OUTPUT_SECTION_FORCE, dmb_station(pipe.string, 0, 0.0), DMB_X);
    transfer(&s, NULL, &load, &thrust, frequencies, 3, by_load);
    transfer(&s, NULL, &force, &thrust, frequencies, 3, by_force);
    for (int i = 0; i < 3; i++)
        check_below("bottom-hole load against a force on the bit", violation(by_load[i], -by_force[i]), 1e-9);
    check_relative("    thrust at the clamp at frequency 0", creal(by_load[0]), -1.0, 1e-9);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(jeffcott_rotor),
        cmocka_unit_test(eccentric_in_one_way),
        cmocka_unit_test(spinning_rotor),
        cmocka_unit_test(receptance_of_a_cantilever),
        cmocka_unit_test(moved_rods),
        cmocka_unit_test(controlled_mass),
        cmocka_unit_test(reciprocity),
        cmocka_unit_test(forces_on_supports),
        cmocka_unit_test(joint_against_shared_node),
        cmocka_unit_test(many_joints_against_none),
        cmocka_unit_test(drives_of_joints),
        cmocka_unit_test(drive_of_a_part_with_joints),
        cmocka_unit_test(peaks_and_sums),
        cmocka_unit_test(eccentricity_grows_friction_does_not),
        cmocka_unit_test(load_on_the_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
