/* Double roots of one shape, which rounding parts by its root: critical damping and straight motion in axes that spin,
 * by all ways of the search, against closed forms; and roots next to each other that are none. Equations:
 * eq:modes.double. */
#include <math.h>
#include <stdio.h>

#include "modal.h"

/* ---- Critical damping -------------------------------------------------------------------------------------------- */

enum { MASS_COUNT = 3 };
static const double mass = 2.0, stiffness[MASS_COUNT] = {18.0, 50.0, 7200.0}; /* 3, 5 and 60 rad/s */

/* Bodies that slide, each on a spring with a damper of `damping` times the critical one; beside them a clamped string
 * of `pipes` pipes. */
static void open_oscillators(rig *s, double damping, uint32_t pipes)
{
    rig_open(s, 0, 0, 0);
    if (pipes > 0) {
        dmb_string_def string = dmb_string_def_default();
        dmb_pipe_def pipe = s1_pipe();
        string.start_free = DMB_FREE_NONE;
        pipe.string = add_string(s, &string);
        (void)add_pipes(s, &pipe, pipes);
    }
    for (int i = 0; i < MASS_COUNT; i++) {
        dmb_body_def body = dmb_body_def_default();
        dmb_spring_def spring = dmb_spring_def_default();
        body.mass = mass;
        body.position[1] = 1.0 + i;
        body.free_mask = DMB_FREE_X;
        spring.place_b = dmb_station(add_body(s, &body), 0, 0.0);
        spring.offset_a[0] = -1.0;
        spring.offset_a[1] = 1.0 + i;
        spring.stiffness = stiffness[i];
        spring.damping = 2.0 * damping * sqrt(stiffness[i] * mass);
        must_model(s, dmb_model_add_spring(s->model, &spring, NULL));
    }
    rig_start(s, NULL);
}

/* Distance of a mode from a root re + i im, relative: of the next one (rank 0), the one after it, and so on. */
static double distance_of(const dmb_modes *modes, uint32_t rank, double re, double im)
{
    double found[3] = {1e9, 1e9, 1e9};
    for (uint32_t i = 0; i < info_of(modes).count; i++) {
        const dmb_mode mode = mode_at(modes, i);
        double d = hypot(mode.eigenvalue[0] - re, mode.eigenvalue[1] - im) / hypot(re, im);
        for (int k = 0; k < 3; k++) {
            const double larger = fmax(d, found[k]);
            found[k] = fmin(d, found[k]);
            d = larger;
        }
    }
    return found[rank];
}

static void check_critical(const char *what, dmb_modes *modes, int count)
{
    print_message("%s: %s, %u double roots of %u\n", what, info_of(modes).dense ? "dense" : "Krylov",
                  info_of(modes).double_roots, info_of(modes).count);
    for (int i = 0; i < count; i++)
        for (uint32_t k = 0; k < 2; k++)
            check_below("  -w twice", distance_of(modes, k, -sqrt(stiffness[i] / mass), 0.0), 1e-10);
    assert_int_equal(info_of(modes).double_roots, 2 * count);
    dmb_modes_destroy(&modes);
}

static void critical_damping(void **state)
{
    (void)state;
    rig s;
    open_oscillators(&s, 1.0, 0);
    check_critical("bodies alone", all_modes(&s, DMB_MODES_DAMPED), MASS_COUNT);
    rig_close(&s);
    open_oscillators(&s, 1.0, 10);
    check_critical("beside a string, all", all_modes(&s, DMB_MODES_DAMPED), MASS_COUNT);
    rig_close(&s);
    open_oscillators(&s, 1.0, 20);
    check_critical("beside a string, lowest", lowest_modes(&s, DMB_MODES_DAMPED, 38), MASS_COUNT);
    check_critical("beside a string, a band", modes_in_band(&s, DMB_MODES_DAMPED, 0.0, 12.0), MASS_COUNT);
    rig_close(&s);
}

/* The last mode asked for is one of a double root. */
static void double_root_at_the_end(void **state)
{
    (void)state;
    rig s;
    open_oscillators(&s, 1.0, 20);
    dmb_modes *many = lowest_modes(&s, DMB_MODES_DAMPED, 38);
    uint32_t first = 0;
    while (fabs(mode_at(many, first).eigenvalue[0] + 5.0) > 1e-3) first++;
    dmb_modes_destroy(&many);
    for (uint32_t count = first + 1; count <= first + 2; count++) {
        dmb_modes *modes = lowest_modes(&s, DMB_MODES_DAMPED, count);
        assert_int_equal(info_of(modes).count, count);
        check_below("last mode, -w", distance_of(modes, 0, -5.0, 0.0), 1e-10);
        dmb_modes_destroy(&modes);
    }
    rig_close(&s);
}

/* Beside the critical damping by a part e the two roots are parted by sqrt(2 e), to real ones or to a pair. */
static void check_beside(double part, uint32_t pipes)
{
    rig s;
    open_oscillators(&s, 1.0 + part, pipes);
    dmb_modes *modes = lowest_modes(&s, DMB_MODES_DAMPED, pipes > 0 ? 38 : 3);
    print_message("%g beside the critical damping: %s\n", part, info_of(modes).dense ? "dense" : "Krylov");
    assert_int_equal(info_of(modes).double_roots, 0);
    for (int i = 0; i < (pipes > 0 ? MASS_COUNT : 1); i++) {
        const double w = sqrt(stiffness[i] / mass);
        const double half = w * sqrt(fabs(part) * (2.0 + part)), middle = -w * (1.0 + part);
        const double real = part > 0.0 ? half : 0.0, imaginary = part > 0.0 ? 0.0 : half;
        check_below("  root", distance_of(modes, 0, middle + real, imaginary), 1e-8);
        if (part > 0.0) check_below("  the other", distance_of(modes, 0, middle - real, imaginary), 1e-8);
    }
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

static void roots_beside_each_other(void **state)
{
    (void)state;
    for (uint32_t pipes = 0; pipes <= 20; pipes += 20) {
        check_beside(1e-6, pipes);
        check_beside(-1e-6, pipes);
    }
}

/* ---- Straight motion in axes that spin --------------------------------------------------------------------------- */

/* A free string that spins as one piece moves straight on outside and keeps a small tilt there, and it wobbles slowly:
 * in its own axes these are roots i spin, of two shapes twice, but for one, which is i spin (1 - I_p/I_t). None of them
 * grows or decays. The stiffness of the nodes is rounded to 1e-16 of itself, 1e-7 of what the slow motion feels. */
static void check_straight(uint32_t elements, double spin)
{
    rig s;
    const double length = 4.5, rotary = 7850.0 * 9.448151e-7 * length;
    const double wobble = 2.0 * rotary / (rotary + 14.20503 * length * length * length / 12.0);
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def string = dmb_string_def_default();
    double growth = 0.0;
    rig_open(&s, 0, 0, 0);
    string.start_free = DMB_FREE_ALL;
    string.velocity[3] = spin;
    pipe.string = add_string(&s, &string);
    pipe.elements = elements;
    (void)add_pipes(&s, &pipe, 3);
    rig_start(&s, NULL);
    dmb_modes *modes = lowest_modes(&s, DMB_MODES_DAMPED, 8);
    for (uint32_t i = 0; i < 8; i++)
        if (fabs(mode_at(modes, i).eigenvalue[1] - spin) < 0.1 * spin)
            growth = fmax(growth, fabs(mode_at(modes, i).eigenvalue[0]) / spin);
    print_message("%u elements, %g rad/s, %s: %u double roots\n", 3 * elements, spin,
                  info_of(modes).dense ? "dense" : "Krylov", info_of(modes).double_roots);
    assert_true(info_of(modes).double_roots >= 2);
    check_below("  growth or decay", growth, 1e-8);
    check_below("  straight motion and tilt, i spin, the worst of three", distance_of(modes, 2, 0.0, spin), 2e-6);
    check_below("  wobble, i spin (1 - I_p/I_t)", distance_of(modes, 0, 0.0, spin * (1.0 - wobble)), 2e-6);
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

static void straight_motion(void **state)
{
    (void)state;
    check_straight(2, 7.0);
    check_straight(2, 40.0);
    check_straight(16, 7.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(critical_damping),
        cmocka_unit_test(double_root_at_the_end),
        cmocka_unit_test(roots_beside_each_other),
        cmocka_unit_test(straight_motion),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
