/* Modes about states: spinning, hanging, lying on the wall, damped; what sums and parts they have; and a free decay in
 * time beside them. */
#include <stdio.h>
#include <string.h>

#include "modal.h"

/* ---- Steady rotation --------------------------------------------------------------------------------------------- */

/* A free pipe of 4 m without rotary inertia to speak of, spinning about its axis. */
static void open_spinning(rig *s, uint32_t elements, double spin)
{
    dmb_pipe_def pipe = beam_pipe(4.0, elements, 1e6, 1e9, 1e4, 500.0);
    dmb_string_def string = dmb_string_def_default();
    pipe.section_mass = 2.0;
    pipe.section_inertia[0] = 1e-7;
    pipe.section_inertia[1] = 1e-8;
    rig_open(s, 0, 0, 0);
    string.start_free = DMB_FREE_ALL;
    string.velocity[3] = spin;
    pipe.string = add_string(s, &string);
    (void)add_pipes(s, &pipe, 1);
    rig_start(s, NULL);
}

/* Distance of the closest damped mode from a frequency [1/s], relative. */
static double closest(const dmb_modes *modes, double w)
{
    double least = 1e9;
    for (uint32_t i = 0; i < info_of(modes).count; i++)
        least = fmin(least, fabs(mode_at(modes, i).eigenvalue[1] - w) / w);
    return least;
}

/* In the frame that spins a standing wave of frequency w is two that run against each other, at w + spin and |w -
 * spin|; and what moves straight on outside turns there at the frequency of the spin. */
static void check_campbell(uint32_t elements, double spin)
{
    rig s;
    double w[3];
    open_spinning(&s, elements, 0.0);
    dmb_modes *modes = lowest_modes(&s, DMB_MODES_UNDAMPED, 14);
    for (uint32_t i = 0; i < 3; i++) w[i] = 2.0 * PI * frequency_of_kind(modes, 2, 2 * i);
    assert_int_equal(info_of(modes).rigid, 6);
    dmb_modes_destroy(&modes);
    rig_close(&s);
    open_spinning(&s, elements, spin);
    modes = lowest_modes(&s, DMB_MODES_DAMPED, elements > 8 ? 14 : 28);
    print_message("  %u elements, %g rad/s, %s\n", elements, spin, info_of(modes).dense ? "LAPACK" : "Krylov");
    for (uint32_t i = 0; i < (elements > 8 ? 2 : 3); i++) {
        char what[80];
        (void)snprintf(what, sizeof what, "pair %u: backward whirl, |w - spin|", i + 1);
        check_below(what, closest(modes, fabs(w[i] - spin)), 2e-6);
        (void)snprintf(what, sizeof what, "pair %u: forward whirl, w + spin", i + 1);
        check_below(what, closest(modes, w[i] + spin), 2e-6);
    }
    check_below("straight motion turns with the spin", closest(modes, spin), 1e-6);
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

static void whirl_of_a_spinning_pipe(void **state)
{
    (void)state;
    check_campbell(8, 7.0);
    check_campbell(8, 40.0);
    check_campbell(40, 7.0);
}

/* ---- Preload ----------------------------------------------------------------------------------------------------- */

/* A chain of 2 m that hangs from a ball: j0n/2 sqrt(g/L), j0n the zeros of J0 (Bernoulli). Its bending stiffness makes
 * it stiffer by its boundary layer, sqrt(EI/weight)/L here 1.6e-3. */
static void hanging_chain(void **state)
{
    (void)state;
    const double zero[3] = {2.404825557695773, 5.520078110286311, 8.653727912911013}, L = 2.0, g = 9.81;
    rig s;
    dmb_pipe_def pipe = beam_pipe(L, 100, 1e6, 1e6, 1.0, 4e-4);
    dmb_string_def string = dmb_string_def_default();
    rig_open(&s, 0, 0, -g);
    pipe.section_mass = 2.0;
    pipe.section_inertia[0] = 1e-4;
    pipe.section_inertia[1] = 1e-8;
    string.start_free = DMB_FREE_SPHERICAL;
    string.rotation[1] = 0.5 * PI; /* x down */
    pipe.string = add_string(&s, &string);
    (void)add_pipes(&s, &pipe, 1);
    rig_start(&s, NULL);
    (void)find_equilibrium(&s, NULL);
    dmb_modes *modes = lowest_modes(&s, DMB_MODES_UNDAMPED, 9);
    for (uint32_t i = 0; i < 3; i++) {
        char what[80];
        const double want = 0.5 * zero[i] * sqrt(g / L) / (2.0 * PI);
        (void)snprintf(what, sizeof what, "hanging chain, pair %u", i + 1);
        check_relative(what, frequency_of_kind(modes, 2, 2 * i), want, 2e-3);
    }
    assert_int_equal(info_of(modes).rigid, 1); /* it spins freely */
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

/* ---- Wall -------------------------------------------------------------------------------------------------------- */

/* A body of 2 kg on the floor of a wide hole of stiffness 1e6 N/m, free to move across it and along. */
static void open_lying(rig *s, int32_t friction_law)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_body_def body = dmb_body_def_default();
    rig_open(s, 0, 0, -9.81);
    wall.diameter = 4.0;
    wall.stiffness = 1e6;
    wall.restitution = 1.0;
    wall.friction_law = friction_law;
    add_wall(s, &wall);
    body.mass = 2.0;
    body.contact_diameter = 0.2;
    body.position[2] = -1.9;
    body.free_mask = DMB_FREE_X | 2 | 4;
    (void)add_body(s, &body);
    rig_start(s, NULL);
    (void)find_equilibrium(s, NULL);
}

static void body_on_the_wall(void **state)
{
    (void)state;
    rig s;
    dmb_modes_options options = dmb_modes_options_default();
    const double N = 2.0 * 9.81, e = 1.9 + N / 1e6;
    open_lying(&s, DMB_FRICTION_NONE);
    options.count = 3;
    dmb_modes *modes = find_modes(&s, &options);
    assert_int_equal(mode_at(modes, 0).rigid, 1); /* along the hole */
    check_relative("it swings around the hole's axis, N/e", frequency_at(modes, 1), sqrt(N / e / 2.0) / (2.0 * PI),
                   1e-9);
    check_relative("it bounces on the wall", frequency_at(modes, 2), sqrt(1e6 / 2.0) / (2.0 * PI), 1e-9);
    dmb_modes_destroy(&modes);
    options.contact = DMB_CONTACT_OPEN;
    modes = find_modes(&s, &options);
    assert_int_equal(info_of(modes).rigid, 3);
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

/* Friction that is smooth at rest is a damper c = mu N/v_eps: s = -c/m along the hole, and the swing, which it would
 * slide in, becomes two real roots: overdamped, one creeping and one fast. */
static void friction_overdamps(void **state)
{
    (void)state;
    rig s;
    const double N = 2.0 * 9.81, c = 0.3 * N / 1e-3, k = N / (1.9 + N / 1e6), m = 2.0;
    const double root = sqrt(c * c - 4.0 * m * k), slow = 2.0 * k / (c + root), fast = (c + root) / (2.0 * m);
    open_lying(&s, DMB_FRICTION_COULOMB);
    dmb_modes *modes = all_modes(&s, DMB_MODES_DAMPED);
    double slowest = 1e9, fastest = 0.0, along = 0.0;
    for (uint32_t i = 0; i < info_of(modes).count; i++) {
        const dmb_mode mode = mode_at(modes, i);
        if (mode.rigid || mode.eigenvalue[1] != 0.0) continue;
        check_close("an overdamped root shows damping", mode.damping, 1.0, 0.0);
        slowest = fmin(slowest, -mode.eigenvalue[0]);
        fastest = fmax(fastest, -mode.eigenvalue[0]);
        if (mode.share[0] > 0.99) along = -mode.eigenvalue[0];
    }
    check_relative("creeping around, k/c", slowest, slow, 1e-8);
    check_relative("stopped around and along, c/m", fastest, fmax(fast, c / m), 1e-8);
    check_relative("stopped along, c/m", along, c / m, 1e-8);
    dmb_modes_destroy(&modes);
    dmb_modes_options options = dmb_modes_options_default();
    options.kind = DMB_MODES_DAMPED;
    options.friction = 0;
    options.count = 3;
    modes = find_modes(&s, &options);
    check_close("without the slope of friction nothing damps", mode_at(modes, 2).damping, 0.0, 1e-12);
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

/* Rings 10.5 mm from the wall held across it: the string between two rings is a beam on stiff supports, much above the
 * string that hangs free. */
static void frozen_closed_contact(void **state)
{
    (void)state;
    rig s;
    dmb_pipe_def pipe = s1_pipe();
    dmb_wall_def wall = s1_hole();
    dmb_string_def string = dmb_string_def_default();
    dmb_modes_options options = dmb_modes_options_default();
    rig_open(&s, 0, 0, 0);
    wall.friction_law = DMB_FRICTION_NONE;
    wall.stiffness = 1e9;
    add_wall(&s, &wall);
    string.start_free = DMB_FREE_NONE;
    pipe.string = add_string(&s, &string);
    pipe.elements = 4;
    (void)add_pipes(&s, &pipe, 1);
    rig_start(&s, NULL);
    options.count = 4;
    dmb_modes *modes = find_modes(&s, &options);
    check_relative("in the middle of the hole: free", frequency_at(modes, 0), 29.295710, 1e-3);
    dmb_modes_destroy(&modes);
    options.contact = DMB_CONTACT_CLOSED;
    options.contact_gap = 0.011;
    modes = find_modes(&s, &options);
    check_relative("held down: only the other plane moves", frequency_at(modes, 0), 29.295710, 1e-3);
    check_relative("and has the second frequency next", frequency_at(modes, 1), 180.059423, 5e-3);
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

/* Without its wall a string keeps the forces it lies on as dead loads: it bends as if it hung in space, alike in both
 * planes. */
static void wall_left_out_of_a_lying_string(void **state)
{
    (void)state;
    rig s;
    dmb_pipe_def pipe = s1_pipe();
    dmb_wall_def wall = s1_hole();
    dmb_string_def string = dmb_string_def_default();
    dmb_modes_options options = dmb_modes_options_default();
    const s1_section v = s1_values();
    rig_open(&s, 0, 0, -9.81);
    add_wall(&s, &wall);
    string.start_free = DMB_FREE_NONE;
    pipe.string = add_string(&s, &string);
    (void)add_pipes(&s, &pipe, 100);
    rig_start(&s, NULL);
    (void)find_equilibrium(&s, NULL);
    options.contact = DMB_CONTACT_OPEN;
    options.friction = 0;
    options.count = 4;
    dmb_modes *modes = find_modes(&s, &options);
    const double want = pow(1.875104068712 / 150.0, 2) * sqrt(v.EI / v.mass) / (2.0 * PI);
    check_below("lying string, wall left out: asymmetry of K", info_of(modes).asymmetry, 1e-10);
    check_relative("  its first frequency", frequency_at(modes, 0), want, 1e-4);
    check_relative("  the other plane", frequency_at(modes, 1), frequency_at(modes, 0), 1e-5);
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

/* ---- Sums and parts ---------------------------------------------------------------------------------------------- */

/* Two pipes with a tool joint each and a body at the end, nothing held. */
static dmb_id open_free_string(rig *s)
{
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def string = dmb_string_def_default();
    dmb_body_def body = dmb_body_def_default();
    rig_open(s, 0, 0, 0);
    string.start_free = DMB_FREE_ALL;
    string.rotation[2] = 0.4;
    pipe.string = add_string(s, &string);
    pipe.joint_length = 0.2;
    pipe.joint_outer_diameter = 0.089;
    pipe.elements = 4;
    (void)add_pipes(s, &pipe, 2);
    body.attach = DMB_ATTACH_END;
    body.string = pipe.string;
    body.mass = 5.0;
    body.centre[0] = 0.1;
    (void)add_body(s, &body);
    rig_start(s, NULL);
    return pipe.string;
}

static void sums_over_all_modes(void **state)
{
    (void)state;
    rig s;
    dmb_model_info model = dmb_model_info_default();
    const dmb_id string = open_free_string(&s);
    must_model(&s, dmb_model_get_info(s.model, &model));
    dmb_modes *modes = all_modes(&s, DMB_MODES_UNDAMPED);
    const dmb_modes_info info = info_of(modes);
    assert_int_equal(info.count, info.coordinates);
    assert_int_equal(info.rigid, 6);
    double mass[3] = {0.0}, parts = 0.0, shares = 0.0;
    for (uint32_t i = 0; i < info.count; i++) {
        const dmb_mode mode = mode_at(modes, i);
        double kinetic[2], strain[2];
        for (int k = 0; k < 3; k++) mass[k] += mode.effective_mass[k];
        shares = fmax(shares, fabs(mode.share[0] + mode.share[1] + mode.share[2] - 1.0));
        for (uint32_t p = 0; p < 2; p++)
            assert_int_equal(dmb_modes_part(modes, i, string, p, kinetic + p, strain + p), DMB_OK);
        if (!mode.rigid) parts = fmax(parts, fabs((strain[0] + strain[1]) / mode.strain - 1.0));
        if (!mode.rigid && fabs(mode.strain / mode.kinetic - 1.0) > 1e-9)
            fail_msg("mode %u: strain %g, kinetic %g", i, mode.strain, mode.kinetic);
    }
    for (int k = 0; k < 3; k++)
        check_relative("effective masses of all modes: the whole mass", mass[k], model.mass, 1e-11);
    check_below("shares of the directions add up to 1", shares, 1e-12);
    check_below("strain energies of the pipes add up to that of the mode", parts, 1e-9);
    tell("largest residual of an eigenvalue", info.residual);
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

/* The few, the band and all of them agree; the band is complete. */
static void few_and_all_agree(void **state)
{
    (void)state;
    rig s;
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def string = dmb_string_def_default();
    rig_open(&s, 0, 0, 0);
    pipe.string = add_string(&s, &string);
    pipe.damping_time = 1e-5;
    (void)add_pipes(&s, &pipe, 30);
    rig_start(&s, NULL);
    for (int32_t kind = DMB_MODES_UNDAMPED; kind <= DMB_MODES_DAMPED; kind++) {
        dmb_modes *all = all_modes(&s, kind), *few = lowest_modes(&s, kind, 20),
                  *band = modes_in_band(&s, kind, 5.0, 15.0);
        assert_int_equal(info_of(few).dense, 0);
        assert_int_equal(info_of(band).dense, 0);
        double worst = 0.0, damping = 0.0;
        uint32_t rigid = info_of(all).rigid, inside = 0, first = 0;
        assert_int_equal(info_of(few).rigid, 2);
        for (uint32_t i = 2; i < 20; i++) {
            worst = fmax(worst, fabs(frequency_at(few, i) / frequency_at(all, rigid - 2 + i) - 1.0));
            damping = fmax(damping, fabs(mode_at(few, i).damping - mode_at(all, rigid - 2 + i).damping));
        }
        check_below(kind ? "damped: lowest twenty against all" : "undamped: lowest twenty against all", worst, 1e-7);
        check_below("  their damping", damping, 1e-7);
        for (uint32_t i = 0; i < info_of(all).count; i++) {
            const double f = frequency_at(all, i);
            if (f < 5.0) first = i + 1;
            inside += f >= 5.0 && f <= 15.0;
        }
        assert_int_equal(info_of(band).count, inside);
        worst = 0.0;
        for (uint32_t i = 0; i < inside; i++)
            worst = fmax(worst, fabs(frequency_at(band, i) / frequency_at(all, first + i) - 1.0));
        check_below("  those from 5 to 15 Hz", worst, 1e-8);
        dmb_modes_destroy(&all);
        dmb_modes_destroy(&few);
        dmb_modes_destroy(&band);
    }
    rig_close(&s);
}

/* Shape of a cantilever's first mode between the nodes, against the exact one, and its tip as 1. */
static void shapes_between_nodes(void **state)
{
    (void)state;
    rig s;
    dmb_pipe_def pipe = beam_pipe(1.0, 8, 1e8, 1e12, 1e6, 100.0);
    dmb_string_def string = dmb_string_def_default();
    rig_open(&s, 0, 0, 0);
    pipe.section_mass = 2.0;
    pipe.section_inertia[1] = 1e-10;
    string.start_free = DMB_FREE_NONE;
    pipe.string = add_string(&s, &string);
    (void)add_pipes(&s, &pipe, 1);
    rig_start(&s, NULL);
    dmb_modes *modes = lowest_modes(&s, DMB_MODES_UNDAMPED, 2);
    const double b = 1.875104068711961, ratio = (sinh(b) - sin(b)) / (cosh(b) + cos(b));
    const dmb_mode_shape tip = shape_at(modes, 0, dmb_station(pipe.string, 0, 1.0));
    const int axis = fabs(tip.re[1]) > fabs(tip.re[2]) ? 1 : 2;
    double worst = 0.0, slope = 0.0;
    for (int i = 1; i < 20; i++) {
        const double x = 0.05 * i, z = b * x;
        const dmb_mode_shape shape = shape_at(modes, 0, dmb_station(pipe.string, 0, x));
        const double want = 0.5 * (cosh(z) - cos(z) - ratio * (sinh(z) - sin(z)));
        const double want_slope = 0.5 * b * (sinh(z) + sin(z) - ratio * (cosh(z) - cos(z)));
        worst = fmax(worst, fabs(shape.re[axis] / tip.re[axis] - want));
        slope = fmax(slope, fabs((axis == 1 ? shape.re[5] : -shape.re[4]) / tip.re[axis] - want_slope));
    }
    check_below("first shape of a cantilever in 8 elements, displacement", worst, 1e-4);
    check_below("  its slope", slope, 1e-3);
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

/* ---- Damping ----------------------------------------------------------------------------------------------------- */

/* Damping in proportion to the stress: zeta = tau w/2 in every mode. */
static void stress_proportional_damping(void **state)
{
    (void)state;
    rig s;
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def string = dmb_string_def_default();
    rig_open(&s, 0, 0, 0);
    string.start_free = DMB_FREE_NONE;
    pipe.string = add_string(&s, &string);
    pipe.damping_time = 3e-5;
    (void)add_pipes(&s, &pipe, 20);
    rig_start(&s, NULL);
    dmb_modes *modes = lowest_modes(&s, DMB_MODES_DAMPED, 12);
    double worst = 0.0;
    for (uint32_t i = 0; i < 12; i++) {
        const dmb_mode mode = mode_at(modes, i);
        worst = fmax(worst, fabs(mode.damping / (0.5 * 3e-5 * 2.0 * PI * mode.frequency) - 1.0));
    }
    check_below("damping of 12 modes against tau w/2", worst, 1e-6);
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

/* ---- A free decay in time ---------------------------------------------------------------------------------------- */

enum { SAMPLES = 40000 };

/* Amplitude of a damped oscillation e^((-d + i w) t) in samples with a Hann window. */
static double amplitude(const double *x, double h, double w)
{
    double re = 0.0, im = 0.0;
    for (int i = 0; i < SAMPLES; i++) {
        const double t = i * h, window = 0.5 - 0.5 * cos(2.0 * PI * i / SAMPLES);
        re += window * x[i] * cos(w * t);
        im += window * x[i] * sin(w * t);
    }
    return hypot(re, im);
}

/* Frequency of the highest amplitude near a guess, by golden sections. */
static double peak(const double *x, double h, double guess)
{
    const double golden = 0.5 * (sqrt(5.0) - 1.0);
    double low = guess - PI / (SAMPLES * h), high = guess + PI / (SAMPLES * h);
    for (int i = 0; i < 40; i++) {
        const double a = high - golden * (high - low), b = low + golden * (high - low);
        if (amplitude(x, h, a) > amplitude(x, h, b))
            high = b;
        else
            low = a;
    }
    return 0.5 * (low + high);
}

/* A clamped string of 12 m lets go of a load at its end; three modes ring, lightly damped. With spectral radius 1
 * generalized-alpha is the midpoint rule, which turns w into 2/h atan(w h/2): that is taken back. */
static void free_decay_rings_at_the_modes(void **state)
{
    (void)state;
    static double x[SAMPLES];
    rig s;
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def string = dmb_string_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_term let_go = dmb_term_default();
    dmb_sim_options options = dmb_sim_options_default();
    rig_open(&s, 0, 0, 0);
    string.start_free = DMB_FREE_NONE;
    pipe.string = add_string(&s, &string);
    pipe.damping_time = 2e-5;
    (void)add_pipes(&s, &pipe, 8);
    options.spectral_radius = 1.0;
    options.newton_tolerance = 1e-13;
    options.energy_ledger = 0;
    let_go.kind = DMB_TERM_STEP;
    let_go.h0 = 1.0;
    let_go.x1 = 1e-3;
    load.place = dmb_station(pipe.string, 7, 1.0);
    load.force[2] = 1.0;
    load.programme = add_programme(&s, &let_go, 1);
    (void)add_load(&s, &load);
    rig_start(&s, &options);
    (void)find_equilibrium(&s, NULL);
    dmb_modes *modes = lowest_modes(&s, DMB_MODES_DAMPED, 8);
    const double h = 1.0 / (60.0 * frequency_of_kind(modes, 2, 4));
    take_steps(&s, 2e-3, 1);
    for (int i = 0; i < SAMPLES; i++) {
        x[i] = pose_at(&s, load.place).displacement[2];
        take_steps(&s, h, 1);
    }
    for (uint32_t i = 0; i < 3; i++) {
        char what[80];
        const double w = 2.0 * PI * frequency_of_kind(modes, 2, 2 * i);
        (void)snprintf(what, sizeof what, "Fourier peak of a free decay at mode %u", i + 1);
        check_relative(what, 2.0 / h * tan(0.5 * h * peak(x, h, 2.0 / h * atan(0.5 * h * w))), w, 1e-5);
    }
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(whirl_of_a_spinning_pipe),
        cmocka_unit_test(hanging_chain),
        cmocka_unit_test(body_on_the_wall),
        cmocka_unit_test(friction_overdamps),
        cmocka_unit_test(frozen_closed_contact),
        cmocka_unit_test(wall_left_out_of_a_lying_string),
        cmocka_unit_test(sums_over_all_modes),
        cmocka_unit_test(few_and_all_agree),
        cmocka_unit_test(shapes_between_nodes),
        cmocka_unit_test(stress_proportional_damping),
        cmocka_unit_test(free_decay_rings_at_the_modes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
