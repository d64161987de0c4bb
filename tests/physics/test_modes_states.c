/* Modes about states: spinning, hanging, lying on the wall, and the one a run has come to. */
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

/* In the frame that spins a standing wave of frequency w is two that run against each other, at w + spin and |w -
 * spin|; and what moves straight on outside turns there at the frequency of the spin. */
static void check_campbell(uint32_t elements, double spin)
{
    rig s;
    double w[3], growth = 0.0;
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
        check_below(what, closest_mode(modes, fabs(w[i] - spin)), 2e-6);
        (void)snprintf(what, sizeof what, "pair %u: forward whirl, w + spin", i + 1);
        check_below(what, closest_mode(modes, w[i] + spin), 2e-6);
    }
    check_below("straight motion turns with the spin", closest_mode(modes, spin), 1e-6);
    for (uint32_t i = 0; i < info_of(modes).count; i++)
        growth = fmax(growth, fabs(mode_at(modes, i).eigenvalue[0]) / spin);
    check_below("nothing grows or decays", growth, 1e-8);
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

/* A rigid pipe that hangs from its support swings about it with sqrt(m g L/2 / J), J of its end: the reaction of a
 * support holds it as a joint does. */
static void rigid_pipe_on_its_support(void **state)
{
    (void)state;
    const double L = 2.0, g = 9.81, mass = 3.0, across = 0.02,
                 want = sqrt(mass * g * L / 2.0 / (mass * L * L / 3.0 + across * L));
    const int32_t masks[2] = {DMB_FREE_RY, DMB_FREE_SPHERICAL};
    for (int i = 0; i < 2; i++) {
        rig s;
        dmb_pipe_def pipe = beam_pipe(L, 1, 1e6, 1e6, 1.0, 4e-4);
        dmb_string_def string = dmb_string_def_default();
        rig_open(&s, 0, 0, -g);
        pipe.kind = DMB_PIPE_RIGID;
        pipe.section_mass = mass / L;
        pipe.section_inertia[0] = 2.0 * across;
        pipe.section_inertia[1] = across;
        string.start_free = masks[i];
        string.rotation[1] = 0.5 * PI; /* x down */
        pipe.string = add_string(&s, &string);
        (void)add_pipes(&s, &pipe, 1);
        rig_start(&s, NULL);
        dmb_modes *modes = all_modes(&s, DMB_MODES_UNDAMPED);
        check_below("a rigid pipe hangs from its support and swings", closest_mode(modes, want), 1e-12);
        assert_int_equal(info_of(modes).rigid, i); /* on a ball it spins freely */
        dmb_modes_destroy(&modes);
        rig_close(&s);
    }
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
    body.free_mask = DMB_FREE_TRANSLATIONS;
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

/* ---- A run ------------------------------------------------------------------------------------------------------- */

/* A cantilever let go under its weight comes to rest by its damping: its modes are then those of the static state.
 * While it still moves, that is told. */
static void state_that_a_run_has_come_to(void **state)
{
    (void)state;
    rig s;
    dmb_pipe_def pipe = s1_pipe();
    rig_open(&s, 0, 0, -9.81);
    pipe.length = 6.0;
    pipe.elements = 4;
    pipe.damping_time = 5e-2;
    (void)add_beam(&s, &pipe, DMB_FREE_NONE);
    rig_start(&s, NULL);
    take_steps(&s, 2e-3, 10);
    const modes_refusal moving = refused_modes(&s, NULL);
    assert_int_equal(moving.status, DMB_ERR_VALUE);
    assert_non_null(strstr(moving.text, "no equilibrium"));
    take_steps(&s, 5e-3, 2000);
    dmb_modes *run = lowest_modes(&s, DMB_MODES_UNDAMPED, 6);
    check_below("after 10 s of a run: out of balance", info_of(run).residual_of_state, 1e-6);
    (void)find_equilibrium(&s, NULL);
    dmb_modes *rest = lowest_modes(&s, DMB_MODES_UNDAMPED, 6);
    for (uint32_t i = 0; i < 6; i++)
        check_relative("    frequency, against the static state", frequency_at(run, i), frequency_at(rest, i), 1e-8);
    dmb_modes_destroy(&run);
    dmb_modes_destroy(&rest);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(whirl_of_a_spinning_pipe),
        cmocka_unit_test(hanging_chain),
        cmocka_unit_test(rigid_pipe_on_its_support),
        cmocka_unit_test(body_on_the_wall),
        cmocka_unit_test(friction_overdamps),
        cmocka_unit_test(frozen_closed_contact),
        cmocka_unit_test(wall_left_out_of_a_lying_string),
        cmocka_unit_test(state_that_a_run_has_come_to),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
