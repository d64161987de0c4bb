/* Modes whose roots come in pairs: rigid-body motions with drag, real modes among complex ones. */
#include <stdio.h>

#include "modal.h"

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

/* ---- Whirl ------------------------------------------------------------------------------------------------------- */

/* Eccentric mass is not round: forward and backward circles are not orthogonal in it. */
static void whirl_stays_within_one(void **state)
{
    (void)state;
    rig s;
    dmb_pipe_def pipe = s1_pipe();
    dmb_modes_options options = dmb_modes_options_default();
    pipe.eccentricity = 2.5e-3;
    (void)lay_string(&s, &pipe, 8, DMB_FREE_ALL, DMB_FREE_ALL);
    rig_start(&s, NULL);
    options.kind = DMB_MODES_DAMPED;
    options.select = DMB_MODES_ALL;
    options.axes = DMB_MODES_STILL;
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rigid_modes_of_a_damped_string_are_real),
        cmocka_unit_test(rigid_modes_with_drag),
        cmocka_unit_test(whirl_stays_within_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
