/* Stepped sine in time: a spinning Jeffcott rotor, small motions against the linear response, an oscillator that meets
 * a stop against its ordinary differential equation. */
#include <stdio.h>
#include <string.h>

#include "harmonic.h"
#include "ode.h"

static double complex number(const double *pair)
{
    return pair[0] + i_ * pair[1];
}

/* ---- Jeffcott rotor ---------------------------------------------------------------------------------------------- */

/* The rotor of CASES, k 1e6 N/m, m 50 kg, e 1e-4 m, damping ratio 0.02, turned at r times its natural frequency. */
static double complex rotor_amplitude(double r, dmb_stepped_sine_report *report)
{
    const double natural = sqrt(1e6 / 50.0), frequency = r * natural / (2.0 * PI);
    double amplitudes[2][2][2];
    rig s;
    const dmb_id body = open_rotor(&s, r * natural);
    dmb_stepped_sine_options options = dmb_stepped_sine_options_default();
    options.steps_per_period = 400;
    options.harmonics = 1;
    options.tolerance = 1e-4;
    const dmb_output outputs[2] = {output_at(DMB_OUTPUT_VIBRATION, dmb_station(body, 0, 0.0), DMB_Y),
                                   output_at(DMB_OUTPUT_VIBRATION, dmb_station(body, 0, 0.0), DMB_Z)};
    const int32_t status =
        dmb_analysis_stepped_sine(s.sim, frequency, &options, outputs, 2, &amplitudes[0][0][0], report);
    must(&s, status);
    assert_int_equal(status, DMB_OK);
    rig_close(&s);
    check_below("    z a quarter of a turn behind y", cabs(number(amplitudes[1][1]) / number(amplitudes[0][1]) + i_),
                1e-3);
    return number(amplitudes[0][1]);
}

static void spinning_jeffcott_rotor(void **state)
{
    (void)state;
    const double ratio[5] = {0.5, 0.9, 1.0, 1.1, 2.0};
    const double amplitude[5] = {3.3321487799e-5, 4.1886342861e-4, 2.5e-3, 5.6394477810e-4, 1.3328595119e-4};
    for (int i = 0; i < 5; i++) {
        char what[64];
        dmb_stepped_sine_report report = dmb_stepped_sine_report_default();
        const double r = ratio[i];
        const double complex got = rotor_amplitude(r, &report);
        (void)snprintf(what, sizeof what, "rotor at r = %g: amplitude of the table", r);
        check_relative(what, cabs(got), amplitude[i], 1e-3);
        check_close("    phase [rad]", carg(got * (1.0 - r * r + 2.0 * i_ * 0.02 * r)), 0.0, 1e-2);
        print_message("        settled after %u windows, %.1e to come\n", report.windows, report.remaining);
        assert_int_equal(report.settled, 1);
    }
}

/* ---- Small motions ----------------------------------------------------------------------------------------------- */

enum { OUTPUTS = 4 };

static void compare_with_linear(const rig *s, const char *what, double frequency, const dmb_excitation *input,
                                double amplitude, const dmb_output *outputs)
{
    dmb_stepped_sine_options options = dmb_stepped_sine_options_default();
    dmb_stepped_sine_report report = dmb_stepped_sine_report_default();
    double amplitudes[OUTPUTS][4][2];
    double complex linear[OUTPUTS];
    options.steps_per_period = 400;
    options.tolerance = 1e-4;
    for (int k = 0; k < OUTPUTS; k++) transfer(s, NULL, input, outputs + k, &frequency, 1, linear + k);
    const int32_t status =
        dmb_analysis_stepped_sine(s->sim, frequency, &options, outputs, OUTPUTS, &amplitudes[0][0][0], &report);
    must(s, status);
    print_message("%s, %g Hz: %u windows, %.1e to come\n", what, frequency, report.windows, report.remaining);
    assert_int_equal(status, DMB_OK);
    for (int k = 0; k < OUTPUTS; k++) {
        const double complex want = amplitude * linear[k] / i_; /* a sine */
        const double complex got = number(amplitudes[k][1]);
        check_below("    first harmonic of an output against the linear response", cabs(got - want) / cabs(want), 1e-3);
        check_below("        second harmonic over the first", cabs(number(amplitudes[k][2])) / cabs(got), 1e-3);
    }
}

static dmb_id add_sine(rig *s, double amplitude, double frequency)
{
    dmb_segment term = dmb_segment_default();
    term.kind = DMB_SEGMENT_HARMONIC;
    term.h1 = amplitude;
    term.omega = 2.0 * PI * frequency;
    return add_time_function(s, &term, 1);
}

/* S1 cantilever of 1.5 m with material damping, a sideways force at its tip below and above its first resonance. */
static void shaken_cantilever(void **state)
{
    (void)state;
    const double frequencies[2] = {20.0, 40.0};
    for (int i = 0; i < 2; i++) {
        rig s;
        rig_open(&s, 0.0, 0.0, -9.81);
        dmb_pipe_def pipe = s1_pipe();
        pipe.elements = 3;
        pipe.damping_time = 5e-4;
        const dmb_id string = add_beam(&s, &pipe, DMB_FREE_NONE);
        dmb_load_def load = dmb_load_def_default();
        load.place = dmb_station(string, 0, 1.0);
        load.force[2] = 1.0;
        load.time_function = add_sine(&s, 0.5, frequencies[i]);
        const dmb_id push = add_load(&s, &load);
        (void)rig_start(&s, NULL);
        (void)find_equilibrium(&s, NULL);
        const dmb_place inside = dmb_station(string, 0, 0.45), clamp = dmb_station(string, 0, 0.0);
        const dmb_excitation input = input_of(DMB_EXCITATION_LOAD, push, DMB_X);
        const dmb_output outputs[OUTPUTS] = {output_at(DMB_OUTPUT_VIBRATION, inside, DMB_Z),
                                             output_at(DMB_OUTPUT_VIBRATION_VELOCITY, load.place, DMB_Z),
                                             output_at(DMB_OUTPUT_VIBRATION_ACCELERATION, inside, DMB_RY),
                                             output_at(DMB_OUTPUT_SECTION_FORCE, clamp, DMB_RY)};
        compare_with_linear(&s, "cantilever", frequencies[i], &input, 0.5, outputs);
        rig_close(&s);
    }
}

/* Ten pipes at rest on the wall of their hole, fed to and fro so slowly that smoothed friction is a damper, and pulled
 * down while they press on the wall. */
static void string_on_its_wall(void **state)
{
    (void)state;
    for (int pulled = 0; pulled < 2; pulled++) {
        const double frequency = 7.0, amplitude = pulled ? 2.0 : 1e-5;
        rig s;
        rig_open(&s, 0.0, 0.0, -9.81);
        dmb_wall_def hole = s1_hole();
        hole.normal_law = DMB_NORMAL_KELVIN_VOIGT;
        hole.damping = 3e3;
        hole.friction_law = DMB_FRICTION_COULOMB;
        hole.smoothing_speed = 1e-2;
        (void)add_wall(&s, &hole);
        dmb_string_def def = dmb_string_def_default();
        dmb_pipe_def pipe = s1_pipe();
        def.start_free = pulled ? DMB_FREE_NONE : DMB_FREE_X;
        pipe.damping_time = 2e-3;
        pipe.string = add_string(&s, &def);
        (void)add_pipes(&s, &pipe, 10);
        dmb_excitation input;
        if (pulled) {
            dmb_load_def load = dmb_load_def_default();
            load.place = dmb_station(pipe.string, 4, 1.0);
            load.force[2] = -1.0;
            load.time_function = add_sine(&s, amplitude, frequency);
            input = input_of(DMB_EXCITATION_LOAD, add_load(&s, &load), DMB_X);
        } else {
            input = input_of(
                DMB_EXCITATION_DRIVE,
                add_simple_drive(&s, DMB_DRIVE_MOTION, pipe.string, DMB_X, add_sine(&s, amplitude, frequency)), DMB_X);
        }
        (void)rig_start(&s, NULL);
        (void)find_equilibrium(&s, NULL);
        const int32_t c = pulled ? DMB_Z : DMB_X;
        const dmb_place middle = dmb_station(pipe.string, 5, 0.3);
        const dmb_output outputs[OUTPUTS] = {
            output_at(DMB_OUTPUT_VIBRATION, middle, c),
            output_at(DMB_OUTPUT_VIBRATION_VELOCITY, dmb_station(pipe.string, 5, 1.0), c),
            output_at(DMB_OUTPUT_VIBRATION_ACCELERATION, middle, c),
            output_at(DMB_OUTPUT_SECTION_FORCE, dmb_station(pipe.string, 5, 0.0), pulled ? DMB_RY : DMB_X)};
        compare_with_linear(&s, pulled ? "pulled down on the wall" : "fed to and fro on the wall", frequency, &input,
                            amplitude, outputs);
        rig_close(&s);
    }
}

/* Bottom-hole load and a force of the drive at one frequency, each with its own amplitude and phase: the response of
 * both together. */
static void two_inputs_together(void **state)
{
    (void)state;
    const double frequency = 11.0, load = 30.0, push = 20.0, lead = 0.9;
    double complex h[2];
    double amplitudes[2][4][2];
    dmb_segment terms[2] = {dmb_segment_default(), dmb_segment_default()};
    dmb_id bit = {0, 0};
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    dmb_bit_def def = dmb_bit_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_joint_def spring = dmb_joint_def_default();
    for (int k = 0; k < 2; k++) {
        terms[k].kind = DMB_SEGMENT_HARMONIC;
        terms[k].omega = 2.0 * PI * frequency;
    }
    terms[0].h1 = load;
    terms[1].h1 = push;
    terms[1].phase = lead;
    string.start_free = DMB_FREE_X;
    pipe.damping_time = 1e-3;
    pipe.string = add_string(&s, &string);
    (void)add_pipes(&s, &pipe, 4);
    def.string = pipe.string;
    def.load = add_time_function(&s, terms, 1);
    must_model(&s, dmb_model_add_bit(s.model, &def, &bit));
    spring.kind = DMB_JOINT_FREE;
    spring.place_b = dmb_station(pipe.string, 0, 0.0);
    spring.stiffness[0] = 4e5;
    spring.damping[0] = 2e3;
    must_model(&s, dmb_model_add_joint(s.model, &spring, NULL));
    const dmb_id drive = add_simple_drive(&s, DMB_DRIVE_LOAD, pipe.string, DMB_X, add_time_function(&s, terms + 1, 1));
    (void)rig_start(&s, NULL);
    dmb_excitation inputs[2] = {input_of(DMB_EXCITATION_BIT_LOAD, bit, DMB_X),
                                input_of(DMB_EXCITATION_DRIVE, drive, DMB_X)};
    inputs[0].amplitude = load;
    inputs[1].amplitude = push;
    inputs[1].phase = lead;
    const dmb_output outputs[2] = {output_at(DMB_OUTPUT_VIBRATION, dmb_station(bit, 0, 0.0), DMB_X),
                                   output_at(DMB_OUTPUT_SECTION_FORCE, dmb_station(pipe.string, 1, 0.5), DMB_X)};
    dmb_response_options about = dmb_response_options_default();
    dmb_stepped_sine_options options = dmb_stepped_sine_options_default();
    dmb_response *response = NULL;
    about.frequencies = &frequency;
    about.points = 1;
    about.equilibrium_tolerance = 1.0; /* at time 0 the second is not at rest: the scene is linear all the same */
    options.steps_per_period = 400;
    options.tolerance = 1e-4;
    must(&s, dmb_analysis_response(s.sim, &about, inputs, 2, outputs, 2, &response));
    must(&s, dmb_analysis_stepped_sine(s.sim, frequency, &options, outputs, 2, &amplitudes[0][0][0], NULL));
    for (uint32_t k = 0; k < 2; k++) {
        assert_int_equal(dmb_response_transfer(response, DMB_COMBINED, k, (double *)(h + k)), DMB_OK);
        check_below(k == 0 ? "bit load and drive together: motion of the bit" : "    force in the string",
                    cabs(number(amplitudes[k][1]) - h[k] / i_) / cabs(h[k]), 1e-3);
    }
    dmb_response_destroy(&response);
    rig_close(&s);
}

/* Four eccentric pipes of S1 in a fluid that damps them from outside, without weight: turned in time, against the
 * response of the string at rest to its own eccentric masses, which only rotary inertia knows apart. */
static void open_eccentric(rig *s, double speed, dmb_id *string)
{
    dmb_environment_def fluid = dmb_environment_def_default();
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    rig_open(s, 0.0, 0.0, 0.0);
    fluid.gravity[2] = 0.0;
    fluid.lateral_damping = 30.0;
    must_model(s, dmb_model_set_environment(s->model, &fluid));
    def.follows_hole = 0;
    def.velocity[3] = speed;
    pipe.eccentricity = 1e-4;
    pipe.string = *string = add_string(s, &def);
    (void)add_pipes(s, &pipe, 4);
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, pipe.string, DMB_RX, add_constant(s, speed));
    (void)rig_start(s, NULL);
}

static void eccentric_string_that_turns(void **state)
{
    (void)state;
    const double frequencies[2] = {1.5, 4.0};
    for (int i = 0; i < 2; i++) {
        const double frequency = frequencies[i];
        double complex linear;
        double amplitudes[1][4][2];
        dmb_stepped_sine_options options = dmb_stepped_sine_options_default();
        dmb_id at_rest, string;
        rig still, turning;
        open_eccentric(&still, 0.0, &at_rest);
        open_eccentric(&turning, 2.0 * PI * frequency, &string);
        const dmb_excitation own = input_of(DMB_EXCITATION_ECCENTRICITY, (dmb_id){0, 0}, DMB_X);
        const dmb_output there = output_at(DMB_OUTPUT_VIBRATION, dmb_station(at_rest, 3, 1.0), DMB_Y);
        const dmb_output here = output_at(DMB_OUTPUT_VIBRATION, dmb_station(string, 3, 1.0), DMB_Y);
        options.steps_per_period = 400;
        options.tolerance = 1e-4;
        transfer(&still, NULL, &own, &there, &frequency, 1, &linear);
        must(&turning,
             dmb_analysis_stepped_sine(turning.sim, frequency, &options, &here, 1, &amplitudes[0][0][0], NULL));
        check_below("eccentric string that turns: whirl of its end",
                    cabs(number(amplitudes[0][1]) - linear) / cabs(linear), 1e-3);
        rig_close(&still);
        rig_close(&turning);
    }
}

/* ---- Axes -------------------------------------------------------------------------------------------------------- */

enum { TURNED_OUTPUTS = 36 };

/* A body that stands turned by `tilt`, on springs and dampers that are the same in every direction, shaken by a force
 * and a moment along the axes of the world: 2 kg on 800 N/m and 8 N s/m, 0.5 kg m2 on 300 N m/rad and 4 N m s. */
static dmb_id open_turned_body(rig *s, const double tilt[3], double frequency, const double force[3],
                               const double moment[3])
{
    dmb_body_def def = dmb_body_def_default();
    dmb_load_def load = dmb_load_def_default();
    rig_open(s, 0.0, 0.0, 0.0);
    def.mass = 2.0;
    for (int k = 0; k < 3; k++) {
        def.inertia[k] = 0.5;
        def.rotation[k] = tilt[k];
        load.force[k] = force[k];
        load.moment[k] = moment[k];
    }
    const dmb_id body = add_body(s, &def);
    load.place = dmb_station(body, 0, 0.0);
    load.time_function = add_sine(s, 1.0, frequency);
    (void)add_load(s, &load);
    dmb_joint_def springs = joint_between(DMB_JOINT_FREE, dmb_station((dmb_id){0, 0}, 0, 0.0), load.place);
    springs.match = 1;
    for (int k = 0; k < 6; k++) {
        springs.stiffness[k] = k < 3 ? 800.0 : 300.0;
        springs.damping[k] = k < 3 ? 8.0 : 4.0;
    }
    (void)add_joint(s, &springs);
    (void)rig_start(s, NULL);
    return body;
}

/* Displacements and small rotations, their rates and second rates, along the axes of the world and along those of the
 * body: (i w)^rate F/(k - m w^2 + i w c), R^T of that in the body's axes. */
static void body_in_its_own_axes(void **state)
{
    (void)state;
    const double tilt[3] = {0.3, -0.7, 0.5}, force[3] = {0.02, -0.03, 0.05}, moment[3] = {0.01, 0.02, -0.015};
    const double frequency = 4.0, w = 2.0 * PI * frequency;
    const double complex by_force = 1.0 / (800.0 - 2.0 * w * w + i_ * w * 8.0);
    const double complex by_moment = 1.0 / (300.0 - 0.5 * w * w + i_ * w * 4.0);
    double amplitudes[TURNED_OUTPUTS][4][2];
    dmb_output outputs[TURNED_OUTPUTS];
    dmb_stepped_sine_options options = dmb_stepped_sine_options_default();
    rig s;
    const dmb_id body = open_turned_body(&s, tilt, frequency, force, moment);
    const dmb_pose pose = pose_at(&s, dmb_station(body, 0, 0.0));
    for (int k = 0; k < TURNED_OUTPUTS; k++)
        outputs[k] = output_at(DMB_OUTPUT_VIBRATION + 10 * (k / 6), dmb_station(body, 0, 0.0), k % 6);
    options.steps_per_period = 400;
    options.tolerance = 1e-4;
    must(&s,
         dmb_analysis_stepped_sine(s.sim, frequency, &options, outputs, TURNED_OUTPUTS, &amplitudes[0][0][0], NULL));
    for (int k = 0; k < TURNED_OUTPUTS; k++) {
        const int c = k % 3, own = k / 6 % 2;
        const double *load = k % 6 < 3 ? force : moment, *R = pose.rotation;
        const double along = own ? R[c] * load[0] + R[3 + c] * load[1] + R[6 + c] * load[2] : load[c];
        const double complex rate = cpow(i_ * w, k / 12), want = rate * along * (k % 6 < 3 ? by_force : by_moment) / i_;
        check_below(!own ? "turned body, axes of the world" : "turned body, its own axes",
                    cabs(number(amplitudes[k][1]) - want) / cabs(want), 1e-3);
    }
    rig_close(&s);
}

/* ---- A stop ------------------------------------------------------------------------------------------------------ */

/* m 2 kg, k 800 N/m, c 8 N s/m, stop of 1e5 N/m at 5 mm, force 20 sin(w t) N. */
static void oscillator(void *context, double t, const double *y, double *rate)
{
    const double omega = *(const double *)context, stop = y[0] > 5e-3 ? 1e5 * (y[0] - 5e-3) : 0.0;
    rate[0] = y[1];
    rate[1] = (20.0 * sin(omega * t) - 8.0 * y[1] - 800.0 * y[0] - stop) / 2.0;
}

/* Harmonics 0 .. 3 of the settled motion by the differential equation. */
static void reference_harmonics(double frequency, double complex *harmonics)
{
    enum { SAMPLES = 400, SETTLING = 60 };
    double omega = 2.0 * PI * frequency, y[2] = {0.0, 0.0};
    const double h = 1.0 / (frequency * SAMPLES);
    memset(harmonics, 0, 4 * sizeof *harmonics);
    for (int j = 0; j < (SETTLING + 1) * SAMPLES; j++) {
        for (int k = 0; j >= SETTLING * SAMPLES && k < 4; k++)
            harmonics[k] += (k > 0 ? 2.0 : 1.0) / SAMPLES * y[0] * cexp(-i_ * k * omega * (j * h));
        ode_solve(oscillator, &omega, j * h, (j + 1) * h, 4, 2, y);
    }
}

static void oscillator_that_meets_a_stop(void **state)
{
    (void)state;
    const double frequencies[2] = {2.0, 5.0};
    for (int i = 0; i < 2; i++) {
        rig s;
        double amplitudes[1][4][2];
        double complex want[4];
        dmb_stepped_sine_report report = dmb_stepped_sine_report_default();
        rig_open(&s, 0.0, 0.0, 0.0);
        dmb_body_def mass = dmb_body_def_default();
        mass.mass = 2.0;
        mass.free_mask = DMB_FREE_X;
        const dmb_id body = add_body(&s, &mass);
        dmb_joint_def spring = dmb_joint_def_default();
        spring.kind = DMB_JOINT_FREE;
        spring.place_b = dmb_station(body, 0, 0.0);
        spring.stiffness[0] = 800.0;
        spring.damping[0] = 8.0;
        spring.stop_high[0] = 5e-3;
        spring.stop_stiffness = 1e5;
        must_model(&s, dmb_model_add_joint(s.model, &spring, NULL));
        (void)add_simple_drive(&s, DMB_DRIVE_LOAD, body, DMB_X, add_sine(&s, 20.0, frequencies[i]));
        (void)rig_start(&s, NULL);
        dmb_stepped_sine_options options = dmb_stepped_sine_options_default();
        options.steps_per_period = 4000;
        options.periods = 1;
        const dmb_output output = output_at(DMB_OUTPUT_VIBRATION, dmb_station(body, 0, 0.0), DMB_X);
        must(&s, dmb_analysis_stepped_sine(s.sim, frequencies[i], &options, &output, 1, &amplitudes[0][0][0], &report));
        assert_int_equal(report.settled, 1);
        reference_harmonics(frequencies[i], want);
        print_message("stop, %g Hz: %u windows; mean and three harmonics %.3e %.3e %.3e %.3e m\n", frequencies[i],
                      report.windows, creal(want[0]), cabs(want[1]), cabs(want[2]), cabs(want[3]));
        for (int k = 0; k < 4; k++)
            check_below("    difference over the first harmonic",
                        cabs(number(amplitudes[0][k]) - want[k]) / cabs(want[1]), 1e-3);
        rig_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spinning_jeffcott_rotor),      cmocka_unit_test(shaken_cantilever),
        cmocka_unit_test(string_on_its_wall),           cmocka_unit_test(two_inputs_together),
        cmocka_unit_test(eccentric_string_that_turns),  cmocka_unit_test(body_in_its_own_axes),
        cmocka_unit_test(oscillator_that_meets_a_stop),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
