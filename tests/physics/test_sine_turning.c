/* Stepped sine about a state that turns as a rigid body, a blade whose speed is shaken, held against the linear
 * response about that state at second order in the step; drive torque, axial force by the change of the centrifugal
 * force and bending at the root, lag and axial motion being coupled by Coriolis forces. Displacements in axes that do
 * not turn do not settle, and are told so. Equations: eq:response.sine. */
#include <string.h>

#include "rig.h"

#include <complex.h> /* after rig.h, in which I is no number */

#define LENGTH 10.0
#define EI 1.0e4
#define MASS 1.5

typedef double complex number;

typedef struct blade {
    rig rig;
    dmb_id string, drive;
} blade;

/* The speed is mean + shake sin (2 pi frequency t). */
static void open_blade(blade *b, int32_t component, double mean, double shake, double frequency)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = beam_pipe(LENGTH, 8, 1e6, 1e10, 1e6, EI); /* soft along, so that it stretches */
    dmb_segment terms[2] = {dmb_segment_default(), dmb_segment_default()};
    rig_open(&b->rig, 0.0, 0.0, 0.0);
    def.follows_hole = 0;
    def.start_free = DMB_FREE_X << component;
    pipe.section_mass = MASS;
    pipe.section_inertia[0] = 2e-3;
    pipe.section_inertia[1] = 1e-3;
    pipe.damping_time = 0.03;
    b->string = pipe.string = add_string(&b->rig, &def);
    (void)add_pipes(&b->rig, &pipe, 1);
    terms[0].h0 = mean;
    terms[1].kind = DMB_SEGMENT_HARMONIC;
    terms[1].h1 = shake;
    terms[1].omega = 2.0 * PI * frequency;
    const dmb_id time_function = add_time_function(&b->rig, terms, shake != 0.0 ? 2 : 1);
    b->drive = add_simple_drive(&b->rig, DMB_DRIVE_MOTION, b->string, component, time_function);
    dmb_sim_options options = dmb_sim_options_default();
    options.newton_tolerance = 1e-12;
    (void)rig_start(&b->rig, &options);
    dmb_static_options statics = dmb_static_options_default();
    statics.tolerance = 1e-13;
    assert_int_equal(find_equilibrium(&b->rig, &statics).steady, DMB_STEADY_RIGID);
}

enum { OUTPUTS = 3 };

static void outputs_of(const blade *b, int32_t component, dmb_output out[OUTPUTS])
{
    for (int i = 0; i < OUTPUTS; i++) out[i] = (dmb_output){.quantity = DMB_OUTPUT_VIBRATION};
    out[0].quantity = DMB_OUTPUT_DRIVE_FORCE;
    out[0].place.part = b->drive;
    out[1].quantity = out[2].quantity = DMB_OUTPUT_SECTION_FORCE;
    out[1].place = out[2].place = dmb_station(b->string, 0, 0.0);
    out[1].quantity += DMB_X;
    out[2].quantity += component;
}

static void respond(int32_t component, double mean, double frequency, number out[OUTPUTS])
{
    blade b;
    dmb_response_options options = dmb_response_options_default();
    dmb_excitation input = dmb_excitation_default();
    dmb_output outputs[OUTPUTS];
    dmb_response *response = NULL;
    open_blade(&b, component, mean, 0.0, frequency);
    outputs_of(&b, component, outputs);
    input.kind = DMB_EXCITATION_DRIVE;
    input.place.part = b.drive;
    options.frequencies = &frequency;
    options.points = 1;
    options.refinement = 0;
    must(&b.rig, dmb_analysis_response(b.rig.sim, &options, &input, 1, outputs, OUTPUTS, &response));
    for (uint32_t k = 0; k < OUTPUTS; k++) {
        double value[2];
        must(&b.rig, dmb_response_transfer(response, 0, k, value));
        out[k] = value[0] + value[1] * (number)_Complex_I;
    }
    dmb_response_destroy(&response);
    rig_close(&b.rig);
}

static void step_sine(int32_t component, double mean, double frequency, uint32_t steps, number out[OUTPUTS])
{
    blade b;
    const double shake = 1e-4 * mean;
    dmb_stepped_sine_options options = dmb_stepped_sine_options_default();
    dmb_stepped_sine_report report = dmb_stepped_sine_report_default();
    dmb_output outputs[OUTPUTS];
    double amplitudes[OUTPUTS][2][2];
    open_blade(&b, component, mean, shake, frequency);
    outputs_of(&b, component, outputs);
    options.steps_per_period = steps;
    options.harmonics = 1;
    options.tolerance = 1e-6;
    must(&b.rig,
         dmb_analysis_stepped_sine(b.rig.sim, frequency, &options, outputs, OUTPUTS, &amplitudes[0][0][0], &report));
    assert_int_equal(report.settled, 1);
    for (int k = 0; k < OUTPUTS; k++) /* a sine is the real part of -i e^(i w t) */
        out[k] = (amplitudes[k][1][0] + amplitudes[k][1][1] * (number)_Complex_I) * (number)_Complex_I / shake;
    rig_close(&b.rig);
}

static double worst_of(const number a[OUTPUTS], const number b[OUTPUTS])
{
    double worst = 0.0;
    for (int k = 0; k < OUTPUTS; k++) worst = fmax(worst, cabs(a[k] - b[k]) / cabs(b[k]));
    return worst;
}

static void shaken_while_it_turns(void **state)
{
    static const struct {
        int32_t component;
        double mean, frequency;
    } cases[] = {{DMB_RZ, 2.0, 0.9}, {DMB_RZ, 8.0, 2.5}, {DMB_RY, 5.0, 1.6}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        number linear[OUTPUTS], coarse[OUTPUTS], fine[OUTPUTS];
        respond(cases[i].component, cases[i].mean, cases[i].frequency, linear);
        step_sine(cases[i].component, cases[i].mean, cases[i].frequency, 100, coarse);
        step_sine(cases[i].component, cases[i].mean, cases[i].frequency, 200, fine);
        for (int k = 0; k < OUTPUTS; k++)
            print_message("%d %g rad/s %g Hz: %g %+gi, in time %g %+gi\n", (int)cases[i].component, cases[i].mean,
                          cases[i].frequency, creal(linear[k]), cimag(linear[k]), creal(fine[k]), cimag(fine[k]));
        check_order("stepped sine", worst_of(coarse, linear), worst_of(fine, linear), 2.0, 0.1);
        check_below("stepped sine, 200 steps a period", worst_of(fine, linear), 2e-3);
    }
}

/* Forces of the state alone do not shake: no harmonic where the speed is steady. */
static void not_shaken(void **state)
{
    (void)state;
    blade b;
    dmb_stepped_sine_options options = dmb_stepped_sine_options_default();
    dmb_output outputs[OUTPUTS];
    double amplitudes[OUTPUTS][2][2];
    open_blade(&b, DMB_RZ, 5.0, 0.0, 1.0);
    outputs_of(&b, DMB_RZ, outputs);
    options.harmonics = 1;
    options.floor = 1e-4;
    must(&b.rig, dmb_analysis_stepped_sine(b.rig.sim, 1.3, &options, outputs, OUTPUTS, &amplitudes[0][0][0], NULL));
    for (int k = 0; k < OUTPUTS; k++)
        check_below("harmonic of what is steady", hypot(amplitudes[k][1][0], amplitudes[k][1][1]),
                    1e-7 * MASS * 25.0 * LENGTH * LENGTH);
    check_relative("mean axial force", amplitudes[1][0][0], 0.5 * MASS * 25.0 * LENGTH * LENGTH, 5e-3);
    rig_close(&b.rig);
}

static void displacement_that_turns(void **state)
{
    (void)state;
    blade b;
    dmb_stepped_sine_options options = dmb_stepped_sine_options_default();
    dmb_stepped_sine_report report = dmb_stepped_sine_report_default();
    dmb_output output = {.quantity = DMB_OUTPUT_VIBRATION};
    double amplitudes[2][2];
    open_blade(&b, DMB_RZ, 5.0, 5e-3, 1.3);
    output.place = dmb_station(b.string, 0, 1.0);
    output.quantity += DMB_Y;
    options.harmonics = 1;
    options.windows = 20;
    assert_int_equal(dmb_analysis_stepped_sine(b.rig.sim, 1.3, &options, &output, 1, &amplitudes[0][0], &report),
                     DMB_NOTE_STOPPED);
    assert_int_equal(report.settled, 0);
    rig_close(&b.rig);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shaken_while_it_turns),
        cmocka_unit_test(not_shaken),
        cmocka_unit_test(displacement_that_turns),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
