/* Modes of strings of very short elements: rounding of K, eps k/(m h^2) of w^2, grows as elements become shorter, but
 * neither takes a vibration for a rigid-body motion nor moves it, as long as it is below w^2. Gravity bends the strings
 * by 1e-4 rad, so that they can turn about their own axis otherwise than as rigid bodies. Frequencies are those of
 * Timoshenko's cantilever (Huang 1961) and of the compound pendulum. Equations: eq:modes.rigid, eq:modes.refine. */
#include <stdio.h>
#include <string.h>

#include "modal.h"

#define SLOPE 1e-4
#define ACCURACY 1e-6

typedef struct section {
    double mass, EI, kGA, gyration; /* [kg/m], [N m2], [N], [m2] I/A */
} section;

static section section_of(const dmb_pipe_def *pipe)
{
    const double outer = pipe->outer_diameter, inner = pipe->inner_diameter;
    const double A = 0.25 * PI * (outer * outer - inner * inner);
    const double I = PI / 64.0 * (pow(outer, 4.0) - pow(inner, 4.0));
    const double G = 0.5 * pipe->young_modulus / (1.0 + pipe->poisson_ratio);
    const section of = {pipe->density * A, pipe->young_modulus * I, pipe->shear_factor * G * A, I / A};
    return of;
}

/* Frequency equation of the clamped-free Timoshenko beam; b^2 = m L^4 w^2/EI. */
static double cantilever(const section *of, double length, double b)
{
    const double r = of->gyration / (length * length), s = of->EI / (of->kGA * length * length);
    const double root = sqrt((r - s) * (r - s) + 4.0 / (b * b));
    const double x = b * sqrt(0.5 * (root - r - s)), y = b * sqrt(0.5 * (root + r + s));
    return 2.0 + (b * b * (r - s) * (r - s) + 2.0) * cosh(x) * cos(y) -
           b * (r + s) / sqrt(1.0 - b * b * r * s) * sinh(x) * sin(y);
}

/* [Hz] by bisection below the root of the slender beam, which is the higher one. */
static double cantilever_frequency(const section *of, double length, double root)
{
    double low = 0.7 * root * root, high = root * root;
    const double sign = cantilever(of, length, low);
    for (int i = 0; i < 60; i++) {
        const double middle = 0.5 * (low + high);
        *(cantilever(of, length, middle) * sign > 0.0 ? &low : &high) = middle;
    }
    return low * sqrt(of->EI / of->mass) / (2.0 * PI * length * length);
}

static void open_string(rig *s, uint32_t pipes, double length, int32_t start_free, const double gravity[3])
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    rig_open(s, gravity[0], gravity[1], gravity[2]);
    string.start_free = start_free;
    pipe.string = add_string(s, &string);
    pipe.length = length;
    (void)add_pipes(s, &pipe, pipes);
    rig_start(s, NULL);
    (void)find_equilibrium(s, NULL);
}

/* ---- Cantilevers ------------------------------------------------------------------------------------------------- */

static void check_cantilever(uint32_t pipes, double length, int32_t start_free, uint32_t rigid, uint32_t count)
{
    const double roots[2] = {1.875104068712, 4.694091132974}, whole = pipes * length;
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    const section of = section_of(&pipe);
    const double weight = 6.0 * of.EI * SLOPE / (of.mass * whole * whole * whole);
    const double gravity[3] = {0.0, -0.6 * weight, -0.8 * weight};
    rig s;
    open_string(&s, pipes, length, start_free, gravity);
    dmb_modes *modes = lowest_modes(&s, DMB_MODES_UNDAMPED, count);
    print_message("%u pipes of %g m, %u modes:\n", pipes, length, count);
    assert_int_equal(info_of(modes).count, count);
    assert_int_equal(info_of(modes).rigid, rigid);
    for (uint32_t i = 0; i < 4 && rigid + i < count; i++)
        check_relative("  frequency", frequency_at(modes, rigid + i), cantilever_frequency(&of, whole, roots[i / 2]),
                       ACCURACY);
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

static void cantilevers(void **state)
{
    (void)state;
    check_cantilever(500, 1e-3, DMB_FREE_NONE, 0, 5);
    check_cantilever(1000, 1e-3, DMB_FREE_NONE, 0, 5);
    check_cantilever(2000, 1e-3, DMB_FREE_NONE, 0, 10);
    check_cantilever(2000, 2e-3, DMB_FREE_NONE, 0, 5);
    check_cantilever(2000, 1e-2, DMB_FREE_NONE, 0, 5);
}

/* Two motions are free, X and the turn about the axis, which the sag is no part of. */
static void free_along_the_axis(void **state)
{
    (void)state;
    check_cantilever(500, 1e-3, DMB_FREE_CYLINDRICAL, 2, 6);
    check_cantilever(1000, 1e-3, DMB_FREE_CYLINDRICAL, 2, 6);
    check_cantilever(2000, 2e-3, DMB_FREE_CYLINDRICAL, 2, 6);
}

/* ---- Pendulum ---------------------------------------------------------------------------------------------------- */

/* w^2 = g (L/2)/(L^2/3 + I/A), twice, and the turn about the axis. */
static void pendulums(void **state)
{
    (void)state;
    static const double lengths[] = {1e-2, 1e-3}, gravity[3] = {9.81, 0.0, 0.0};
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    for (size_t k = 0; k < sizeof lengths / sizeof *lengths; k++) {
        const double whole = 1000 * lengths[k], gyration = section_of(&pipe).gyration;
        const double want = sqrt(0.5 * 9.81 * whole / (whole * whole / 3.0 + gyration)) / (2.0 * PI);
        rig s;
        open_string(&s, 1000, lengths[k], DMB_FREE_SPHERICAL, gravity);
        dmb_modes *modes = lowest_modes(&s, DMB_MODES_UNDAMPED, 3);
        assert_int_equal(info_of(modes).count, 3);
        assert_int_equal(info_of(modes).rigid, 1);
        for (uint32_t i = 1; i < 3; i++) check_relative("pendulum", frequency_at(modes, i), want, 1e-3);
        dmb_modes_destroy(&modes);
        rig_close(&s);
    }
}

/* Of elements so short that rounding hides the pendulum, w^2 < 64 eps sum |r| |K| |r|, it is refused, not rigid; bands
 * above it are found, and so are all modes without gravity, where the pendulum's motions are rigid. */
static void hidden_pendulum(void **state)
{
    (void)state;
    static const double gravity[3] = {9.81, 0.0, 0.0}, none[3] = {0.0, 0.0, 0.0};
    dmb_modes_options options = dmb_modes_options_default();
    rig s;
    open_string(&s, 2000, 1e-4, DMB_FREE_SPHERICAL, gravity);
    options.count = 3;
    const modes_refusal refusal = refused_modes(&s, &options);
    assert_int_equal(refusal.status, DMB_ERR_NO_CONVERGENCE);
    assert_non_null(strstr(refusal.text, "1.33"));
    assert_non_null(strstr(refusal.text, "elements of 0.0001 m"));
    dmb_modes *modes = modes_in_band(&s, DMB_MODES_UNDAMPED, 2000.0, 6000.0);
    const double bending = frequency_at(modes, 0);
    assert_int_equal(info_of(modes).rigid, 0);
    dmb_modes_destroy(&modes);
    rig_close(&s);
    open_string(&s, 2000, 1e-4, DMB_FREE_SPHERICAL, none);
    modes = lowest_modes(&s, DMB_MODES_UNDAMPED, 4);
    assert_int_equal(info_of(modes).rigid, 3);
    check_relative("bending, with and without gravity", frequency_at(modes, 3), bending, 1e-4);
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(cantilevers), cmocka_unit_test(free_along_the_axis),
                                       cmocka_unit_test(pendulums), cmocka_unit_test(hidden_pendulum)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
