/* Modes whose roots come in pairs: flutter, rigid-body motions with drag, real modes among complex ones. */
#include <stdio.h>

#include "modal.h"

/* ---- Flutter ----------------------------------------------------------------------------------------------------- */

/* Beck's column, clamped at the start, pushed at its end along its own axis by P = 22 EI/L^2: above 20.05 EI/L^2 its
 * two lowest bending modes have met, one grows and the other decays (Beck 1952). */
static dmb_id open_column(rig *s, uint32_t pipes)
{
    const s1_section v = s1_values();
    const double L = 1.5 * pipes;
    dmb_pipe_def pipe = s1_pipe();
    dmb_load_def load = dmb_load_def_default();
    const dmb_id string = lay_string(s, &pipe, pipes, DMB_FREE_NONE, DMB_FREE_ALL);
    load.place = dmb_station(string, pipes - 1, 1.0);
    load.frame = DMB_FRAME_BODY;
    load.force[0] = -22.0 * v.EI / (L * L);
    (void)add_load(s, &load);
    rig_start(s, NULL);
    (void)find_equilibrium(s, NULL);
    return string;
}

/* [1/s] growth of the modes in flutter; two of them grow and two decay, in both planes. */
static double check_flutter(const char *what, const dmb_modes *modes)
{
    uint32_t growing = 0, decaying = 0;
    double growth = 0.0;
    for (uint32_t i = 0; i < info_of(modes).count; i++) {
        const dmb_mode mode = mode_at(modes, i);
        if (!(mode.eigenvalue[1] > 0.0) || fabs(mode.eigenvalue[0]) < 1e-3 * mode.eigenvalue[1]) continue;
        growing += mode.eigenvalue[0] > 0.0;
        decaying += mode.eigenvalue[0] < 0.0;
        growth = fmax(growth, mode.eigenvalue[0]);
    }
    print_message("%s: %u modes grow, %u decay, at %.6g 1/s\n", what, growing, decaying, growth);
    assert_int_equal(growing, 2);
    assert_int_equal(decaying, 2);
    check_below("  residual", info_of(modes).residual, 1e-9);
    return growth;
}

/* Sine of the angle by which the middle leads the end in a mode that grows, sideways: its sign is that of the shape's
 * imaginary part. */
static double phase_of(const dmb_modes *modes, dmb_place middle, dmb_place end)
{
    for (uint32_t i = 0; i < info_of(modes).count; i++) {
        if (!(mode_at(modes, i).eigenvalue[0] > 1e-3 * mode_at(modes, i).eigenvalue[1])) continue;
        const dmb_mode_shape a = shape_at(modes, i, middle), b = shape_at(modes, i, end);
        const uint32_t c = hypot(b.re[1], b.im[1]) > hypot(b.re[2], b.im[2]) ? 1 : 2;
        return (a.im[c] * b.re[c] - a.re[c] * b.im[c]) / (hypot(a.re[c], a.im[c]) * hypot(b.re[c], b.im[c]));
    }
    fail_msg("no mode grows");
    return 0.0;
}

/* Dense and sparse, without damping and by the equations with damping: the same pairs in the same shapes. */
static void flutter_grows_in_one_shape(void **state)
{
    (void)state;
    static const uint32_t pipes[2] = {8, 40};
    for (int way = 0; way < 2; way++) {
        rig s;
        double phase[2], growth[2];
        const dmb_id string = open_column(&s, pipes[way]);
        const dmb_place middle = dmb_station(string, pipes[way] / 2, 0.0),
                        end = dmb_station(string, pipes[way] - 1, 1.0);
        for (int32_t kind = DMB_MODES_UNDAMPED; kind <= DMB_MODES_DAMPED; kind++) {
            dmb_modes *modes = lowest_modes(&s, kind, 12);
            assert_int_equal(info_of(modes).dense, way == 0);
            growth[kind] = check_flutter(way == 0 ? "dense" : "sparse", modes);
            phase[kind] = phase_of(modes, middle, end);
            dmb_modes_destroy(&modes);
        }
        check_relative("  growth, undamped against damped equations", growth[0], growth[1], 1e-7);
        check_close("  phase of the middle against the end", phase[0], phase[1], 1e-6);
        assert_true(fabs(phase[1]) > 1e-2);
        rig_close(&s);
    }
}

/* ---- Rigid-body motions ------------------------------------------------------------------------------------------ */

/* Rigid modes are real, and effective masses sum to the mass: shape parts of other modes, or motions that are not
 * orthogonal, would add to it. */
static void check_rigid(const dmb_modes *modes, dmb_id string, uint32_t want, double mass, double tolerance)
{
    double sum[3] = {0.0, 0.0, 0.0}, imaginary = 0.0;
    for (uint32_t i = 0; i < info_of(modes).count; i++) {
        const dmb_mode mode = mode_at(modes, i);
        if (!mode.rigid) continue;
        for (int c = 0; c < 3; c++) sum[c] += mode.effective_mass[c];
        const dmb_mode_shape shape = shape_at(modes, i, dmb_station(string, 0, 1.0));
        for (int c = 0; c < 6; c++) imaginary = fmax(imaginary, fabs(shape.im[c]));
    }
    print_message("    %u of %u modes are rigid\n", info_of(modes).rigid, info_of(modes).count);
    assert_int_equal(info_of(modes).rigid, want);
    check_below("    imaginary part of rigid modes", imaginary, 1e-300);
    for (int c = 0; c < 3; c++) check_relative("    effective mass of rigid modes", sum[c], mass, tolerance);
}

/* Damped by the stress alone, and free at both ends: by LAPACK, the motions apart. */
static void rigid_modes_of_a_damped_string_are_real(void **state)
{
    (void)state;
    rig s;
    dmb_pipe_def pipe = s1_pipe();
    pipe.damping_time = 1e-3;
    const dmb_id string = lay_string(&s, &pipe, 8, DMB_FREE_ALL, DMB_FREE_ALL);
    rig_start(&s, NULL);
    dmb_modes *modes = lowest_modes(&s, DMB_MODES_DAMPED, 12);
    check_rigid(modes, string, 6, 8 * 1.5 * s1_values().mass, 1e-6);
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

/* With drag each of the six motions has a root 0 and one of its own; some of the roots 0 come out as complex pairs. */
static void rigid_modes_with_drag(void **state)
{
    (void)state;
    rig s;
    dmb_pipe_def pipe = s1_pipe();
    dmb_environment_def environment = dmb_environment_def_default();
    environment.axial_damping = environment.lateral_damping = environment.torsional_damping = 0.1;
    environment.gravity[2] = 0.0;
    const dmb_id string = lay_string(&s, &pipe, 40, DMB_FREE_ALL, DMB_FREE_ALL);
    must_model(&s, dmb_model_set_environment(s.model, &environment));
    rig_start(&s, NULL);
    dmb_modes *modes = lowest_modes(&s, DMB_MODES_DAMPED, 12);
    check_rigid(modes, string, 6, 40 * 1.5 * s1_values().mass, 1e-6);
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

/* However slow the drag, the motion along the axis dies out at its rate beside the root 0: drag over mass. */
static void slow_drag_of(double drag, uint32_t pipes, int32_t select, double tolerance)
{
    rig s;
    const dmb_pipe_def pipe = s1_pipe();
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_modes_options options = dmb_modes_options_default();
    double least = 1.0;
    environment.axial_damping = drag;
    environment.gravity[2] = 0.0;
    options.kind = DMB_MODES_DAMPED;
    options.select = select;
    (void)lay_string(&s, &pipe, pipes, DMB_FREE_ALL, DMB_FREE_ALL);
    must_model(&s, dmb_model_set_environment(s.model, &environment));
    rig_start(&s, NULL);
    dmb_modes *modes = find_modes(&s, &options);
    for (uint32_t i = 0; i < info_of(modes).count; i++)
        least = fmin(least, fabs(mode_at(modes, i).eigenvalue[0] * s1_values().mass / drag + 1.0));
    print_message("    %u pipes, drag %g N s/m2\n", pipes, drag);
    check_below("        rate", least, tolerance);
    assert_int_equal(info_of(modes).rigid, 6);
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

static void slow_drag(void **state)
{
    (void)state;
    for (double drag = 1.0; drag > 1e-7; drag *= 1e-2) slow_drag_of(drag, 8, DMB_MODES_ALL, 1e-9 + 1e-13 / drag);
    for (double drag = 1.0; drag > 5e-4; drag *= 1e-1) slow_drag_of(drag, 40, DMB_MODES_LOWEST, 1e-9);
}

/* ---- Whirl ------------------------------------------------------------------------------------------------------- */

/* Eccentric mass is not round: forward and backward circles are not orthogonal in it. */
static void whirl_stays_within_one(void **state)
{
    (void)state;
    rig s;
    dmb_pipe_def pipe = s1_pipe();
    dmb_modes_options options = dmb_modes_options_default();
    pipe.eccentricity = 2.5e-3;
    (void)lay_string(&s, &pipe, 8, DMB_FREE_NONE, DMB_FREE_ALL);
    rig_start(&s, NULL);
    options.kind = DMB_MODES_DAMPED;
    options.select = DMB_MODES_ALL;
    options.axes = DMB_MODES_AXES_TURNING;
    options.spin = 64.0;
    options.equilibrium_tolerance = 1e30; /* out of balance as it turns */
    dmb_modes *modes = find_modes(&s, &options);
    double most = 0.0;
    for (uint32_t i = 0; i < info_of(modes).count; i++) most = fmax(most, fabs(mode_at(modes, i).whirl));
    tell("largest whirl of an eccentric string, less 1", most - 1.0);
    assert_true(most <= 1.0 + 1e-12);
    assert_true(most > 0.9);
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

/* ---- Drag across pipes ------------------------------------------------------------------------------------------- */

/* Drag over mass times the decay of the first bending mode of a pipe of 6 m, less its value 1/2 in a continuous beam,
 * over that value: the error of its damping. */
static double drag_error(uint32_t elements, int32_t start_free, int32_t end_free)
{
    const double drag = 0.1;
    rig s;
    dmb_pipe_def pipe = s1_pipe();
    dmb_environment_def environment = dmb_environment_def_default();
    environment.lateral_damping = drag;
    environment.gravity[2] = 0.0;
    pipe.length = 6.0;
    pipe.elements = elements;
    (void)lay_string(&s, &pipe, 1, start_free, end_free);
    must_model(&s, dmb_model_set_environment(s.model, &environment));
    rig_start(&s, NULL);
    dmb_modes *modes = lowest_modes(&s, DMB_MODES_DAMPED, 1);
    const double rate = -mode_at(modes, 0).eigenvalue[0];
    dmb_modes_destroy(&modes);
    rig_close(&s);
    return 2.0 * rate * s1_values().mass / drag - 1.0;
}

/* Drag acts at the ends of elements, half of it at each: the trapezoidal rule for the square of the shape, too large by
 * L^2/(12 n^2) times its slope at the free end. One element between two bearings has none. */
static void drag_acts_at_the_nodes(void **state)
{
    (void)state;
    for (uint32_t n = 2; n <= 8; n *= 2)
        check_relative("drag on a clamped pipe, too large by", drag_error(n, DMB_FREE_NONE, DMB_FREE_ALL),
                       0.9177 / (n * n), 0.03);
    check_close("one element between bearings", drag_error(1, DMB_FREE_RZ, DMB_FREE_RZ), -1.0, 1e-9);
    check_close("two elements between bearings", drag_error(2, DMB_FREE_RZ, DMB_FREE_RZ), 0.0, 0.02);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flutter_grows_in_one_shape), cmocka_unit_test(rigid_modes_of_a_damped_string_are_real),
        cmocka_unit_test(rigid_modes_with_drag),      cmocka_unit_test(slow_drag),
        cmocka_unit_test(whirl_stays_within_one),     cmocka_unit_test(drag_acts_at_the_nodes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
