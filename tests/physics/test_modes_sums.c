/* Results of modes against each other: sums over all of them, energies of parts and directions, shapes between nodes,
 * frames of their animation; the few, a band and all of them beside each other. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "modal.h"

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

static double sum_of(const double share[3])
{
    return share[0] + share[1] + share[2];
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
    double mass[3] = {0.0}, parts = 0.0, shares = 0.0, participation = 0.0;
    for (uint32_t i = 0; i < info.count; i++) {
        const dmb_mode mode = mode_at(modes, i);
        double kinetic[2], strain[2];
        for (int k = 0; k < 3; k++) {
            mass[k] += mode.effective_mass[k];
            participation =
                fmax(participation, fabs(mode.participation[k] * mode.participation[k] - mode.effective_mass[k]));
        }
        shares = fmax(shares, fabs(sum_of(mode.share) - 1.0));
        shares = fmax(shares, fabs(sum_of(mode.strain_share) - (mode.rigid && mode.strain == 0.0 ? 0.0 : 1.0)));
        for (uint32_t p = 0; p < 2; p++)
            assert_int_equal(dmb_modes_part(modes, i, string, p, kinetic + p, strain + p), DMB_OK);
        if (!mode.rigid) parts = fmax(parts, fabs((strain[0] + strain[1]) / mode.strain - 1.0));
        if (!mode.rigid && fabs(mode.strain / mode.kinetic - 1.0) > 1e-9)
            fail_msg("mode %u: strain %g, kinetic %g", i, mode.strain, mode.kinetic);
    }
    for (int k = 0; k < 3; k++)
        check_relative("effective masses of all modes: the whole mass", mass[k], model.mass, 1e-11);
    check_below("effective mass: the square of the participation", participation, 1e-12);
    check_below("shares of the directions add up to 1", shares, 1e-12);
    check_below("strain energies of the pipes add up to that of the mode", parts, 1e-9);
    tell("largest residual of an eigenvalue", info.residual);
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

/* A pipe has half of what is fixed to its ends: with the other half of the body the kinetic energies are that of the
 * mode, and those of the whole string are the pipes'. */
static void kinetic_energies_of_parts(void **state)
{
    (void)state;
    rig s;
    dmb_pipe_def pipe = s1_pipe();
    dmb_body_def def = dmb_body_def_default();
    const dmb_id string = lay_string(&s, &pipe, 3, DMB_FREE_NONE, DMB_FREE_ALL);
    def.attach = DMB_ATTACH_END;
    def.string = string;
    def.mass = 5.0;
    const dmb_id body = add_body(&s, &def);
    rig_start(&s, NULL);
    double worst = 0.0;
    for (int32_t kind = DMB_MODES_UNDAMPED; kind <= DMB_MODES_DAMPED; kind++) {
        dmb_modes *modes = all_modes(&s, kind);
        for (uint32_t i = 0; i < info_of(modes).count; i++) {
            const dmb_mode mode = mode_at(modes, i);
            double kinetic[3], whole, end, strain, sum = 0.0;
            for (uint32_t p = 0; p < 3; p++) {
                assert_int_equal(dmb_modes_part(modes, i, string, p, kinetic + p, &strain), DMB_OK);
                sum += kinetic[p];
            }
            assert_int_equal(dmb_modes_part(modes, i, string, DMB_NONE, &whole, &strain), DMB_OK);
            assert_int_equal(dmb_modes_part(modes, i, body, 0, &end, &strain), DMB_OK);
            assert_true(strain == 0.0);
            worst = fmax(worst, fabs((sum + 0.5 * end) / mode.kinetic - 1.0));
            worst = fmax(worst, fabs(whole / sum - 1.0));
        }
        dmb_modes_destroy(&modes);
    }
    check_below("kinetic energies of the parts add up to that of the mode", worst, 1e-11);
    rig_close(&s);
}

/* A straight string stretches, twists or bends: each mode strains and moves in one way only. */
static void each_mode_is_of_one_kind(void **state)
{
    (void)state;
    rig s;
    dmb_pipe_def pipe = s1_pipe();
    (void)lay_string(&s, &pipe, 4, DMB_FREE_NONE, DMB_FREE_ALL);
    rig_start(&s, NULL);
    dmb_modes *modes = all_modes(&s, DMB_MODES_UNDAMPED);
    uint32_t count[3] = {0, 0, 0};
    for (uint32_t i = 0; i < info_of(modes).count; i++) {
        const dmb_mode mode = mode_at(modes, i);
        for (int k = 0; k < 3; k++) {
            if (mode.share[k] < 0.5) continue;
            count[k]++;
            assert_true(mode.share[k] > 1.0 - 1e-9 && mode.strain_share[k] > 1.0 - 1e-9);
        }
    }
    assert_int_equal(count[0], 4);
    assert_int_equal(count[1], 4);
    assert_int_equal(count[2], 16);
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

/* The few, the band and all of them agree; the band is complete. */
static void few_and_all_agree(void **state)
{
    (void)state;
    rig s;
    dmb_pipe_def pipe = s1_pipe();
    pipe.damping_time = 1e-5;
    (void)lay_string(&s, &pipe, 30, dmb_string_def_default().start_free, DMB_FREE_ALL);
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
    pipe.section_mass = 2.0;
    pipe.section_inertia[1] = 1e-10;
    pipe.string = lay_string(&s, &pipe, 1, DMB_FREE_NONE, DMB_FREE_ALL);
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

/* ---- Animation --------------------------------------------------------------------------------------------------- */

/* The last three numbers of an array of a VTK file. */
static void last_of_array(const char *path, const char *name, double out[3])
{
    static char text[100000];
    char mark[64];
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    assert_int_equal(fclose(file), 0);
    (void)snprintf(mark, sizeof mark, "Name=\"%s\"", name);
    const char *at = strstr(text, mark);
    assert_non_null(at);
    at = strchr(at, '>') + 1;
    for (char *next = NULL;; at = next) {
        const double number = strtod(at, &next);
        if (next == at) break;
        out[0] = out[1];
        out[1] = out[2];
        out[2] = number;
    }
}

/* Frames at phases 0 and a third of a turn: position, displacement and rotation of the tip. */
static void frames_show_the_shape(void **state)
{
    (void)state;
    static const char path[] = "mode_frame.vtp";
    rig s;
    dmb_pipe_def pipe = s1_pipe();
    pipe.damping_time = 1e-3;
    const dmb_id string = lay_string(&s, &pipe, 2, DMB_FREE_NONE, DMB_FREE_ALL);
    rig_start(&s, NULL);
    dmb_modes *modes = lowest_modes(&s, DMB_MODES_DAMPED, 4);
    const dmb_place tip = dmb_station(string, 1, 1.0);
    for (int frame = 0; frame < 2; frame++)
        for (uint32_t i = 0; i < 4; i++) {
            const double phase = frame * 2.0 * PI / 3.0, scale = 0.05;
            const dmb_mode_shape shape = shape_at(modes, i, tip);
            double position[3] = {0.0}, displacement[3] = {0.0}, rotation[3] = {0.0}, worst = 0.0;
            assert_int_equal(dmb_write_vtk_mode(modes, i, scale, phase, 4, path), DMB_OK);
            last_of_array(path, "position", position);
            last_of_array(path, "displacement", displacement);
            last_of_array(path, "rotation", rotation);
            for (int k = 0; k < 3; k++) {
                const double u = scale * (shape.re[k] * cos(phase) - shape.im[k] * sin(phase));
                const double turn = scale * (shape.re[3 + k] * cos(phase) - shape.im[3 + k] * sin(phase));
                worst = fmax(worst, fabs(displacement[k] - u) + fabs(rotation[k] - turn));
                worst = fmax(worst, fabs(position[k] - (k == 0 ? 3.0 : 0.0) - u));
            }
            check_below("frame of an animation: tip", worst, 1e-8);
        }
    assert_int_equal(remove(path), 0);
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums_over_all_modes),      cmocka_unit_test(kinetic_energies_of_parts),
        cmocka_unit_test(each_mode_is_of_one_kind), cmocka_unit_test(few_and_all_agree),
        cmocka_unit_test(shapes_between_nodes),     cmocka_unit_test(frames_show_the_shape),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
