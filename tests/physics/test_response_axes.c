/* Responses of what turns, in axes at rest: a shaft out of balance against the same in axes that turn with it, a string
 * that turns on the wall of its hole against runs in time, and the speeds at which a turning shaft is shaken against
 * its forward whirl. */
#include <string.h>

#include "harmonic.h"
#include "modal.h"

/* ---- A shaft ----------------------------------------------------------------------------------------------------- */

#define LENGTH 2.0
#define SPEED 20.0    /* [rad/s] */
#define UNBALANCE 0.3 /* [kg m] */

/* Pinned at both ends, turning, damped from outside. */
static dmb_id open_shaft(rig *s)
{
    dmb_pipe_def pipe = beam_pipe(LENGTH, 16, 1e9, 1e12, 1e6, 1e3);
    dmb_string_def string = dmb_string_def_default();
    dmb_environment_def oil = dmb_environment_def_default();
    rig_open(s, 0.0, 0.0, 0.0);
    memset(oil.gravity, 0, sizeof oil.gravity);
    oil.lateral_damping = 3.0;
    must_model(s, dmb_model_set_environment(s->model, &oil));
    pipe.section_mass = 2.0;
    pipe.section_inertia[0] = 0.1;
    pipe.section_inertia[1] = 0.05;
    string.start_free = string.end_free = DMB_FREE_SPHERICAL;
    string.velocity[3] = SPEED;
    pipe.string = add_string(s, &string);
    (void)add_pipes(s, &pipe, 1);
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, pipe.string, DMB_RX, add_constant(s, SPEED));
    rig_start(s, NULL);
    return pipe.string;
}

static double complex in_axes(const rig *s, int32_t axes, dmb_excitation input, dmb_output output, double frequency)
{
    dmb_response_options options = dmb_response_options_default();
    double complex value;
    options.axes = axes;
    transfer(s, &options, &input, &output, &frequency, 1, &value);
    return value;
}

/* [m/N] of a force that goes round with w in the axes that turn: y + z/i, or against it where w < 0. */
static double complex round_in_turning_axes(const rig *s, dmb_place place, dmb_output output, double w)
{
    const double complex z = w < 0.0 ? i_ : -i_;
    dmb_excitation along[2] = {force_at(place, DMB_Y), force_at(place, DMB_Z)};
    double complex sum = 0.0;
    for (int k = 0; k < 2; k++) {
        along[k].frame = DMB_FRAME_BODY;
        const double complex value = in_axes(s, DMB_RESPONSE_AXES_TURNING, along[k], output, fabs(w) / (2.0 * PI));
        sum += k == 0 ? value : z * value;
    }
    return sum;
}

/* A force that goes round with w goes round with w - W as seen from the shaft, with the same amplitude. */
static void out_of_balance(void **state)
{
    const double speeds[] = {5.0, 20.0, 60.0, 200.0};
    (void)state;
    rig s;
    const dmb_id shaft = open_shaft(&s);
    const dmb_place place = dmb_station(shaft, 0, 0.4);
    const dmb_output output = output_at(DMB_OUTPUT_VIBRATION, dmb_station(shaft, 0, 0.7), DMB_Y);
    dmb_output inside = output;
    dmb_excitation unbalance = force_at(place, DMB_RX);
    inside.quantity += DMB_OUTPUT_VIBRATION_BODY - DMB_OUTPUT_VIBRATION;
    unbalance.kind = DMB_EXCITATION_UNBALANCE;
    unbalance.frame = DMB_FRAME_BODY;
    for (int k = 0; k < 4; k++) {
        const double w = speeds[k];
        const double complex outside =
            in_axes(&s, DMB_RESPONSE_AXES_AT_REST, unbalance, output, w / (2.0 * PI)) / (w * w);
        const double complex turning = round_in_turning_axes(&s, place, inside, w - SPEED);
        tell("goes round with [rad/s]", w);
        check_relative("    amplitude from the shaft", cabs(turning), cabs(outside), 1e-8);
        check_close("    phase, by the sense in which it is seen", carg(w < SPEED ? conj(turning) : turning),
                    carg(outside), 1e-7);
    }
    rig_close(&s);
}

/* The scene's own eccentric masses shake a turning shaft at its speed: worst where forward whirl has that speed. */
static void speeds_of_a_turning_shaft(void **state)
{
    const double limit = 1e-3;
    (void)state;
    rig s;
    const dmb_id shaft = open_shaft(&s);
    dmb_modes_options how = dmb_modes_options_default();
    dmb_speeds_options options = dmb_speeds_options_default();
    dmb_order order = dmb_order_default();
    dmb_speed_band band = dmb_speed_band_default();
    uint32_t bands = 1;
    const dmb_output output = output_at(DMB_OUTPUT_VIBRATION, dmb_station(shaft, 0, 0.5), DMB_Y);
    how.kind = DMB_MODES_DAMPED;
    how.axes = DMB_MODES_AXES_AT_REST;
    dmb_modes *modes = find_modes(&s, &how);
    double forward = 0.0;
    for (uint32_t i = 0; i < info_of(modes).count && forward == 0.0; i++)
        if (mode_at(modes, i).whirl > 0.5) forward = 2.0 * PI * frequency_at(modes, i);
    dmb_modes_destroy(&modes);
    order.excitation = force_at(dmb_station(shaft, 0, 0.5), DMB_RX);
    order.excitation.kind = DMB_EXCITATION_UNBALANCE;
    order.excitation.amplitude = 1e-3;
    options.speed_low = 20.0;
    options.speed_high = 150.0;
    must(&s, dmb_analysis_speeds(s.sim, &options, &order, 1, &output, &limit, 1, &band, &bands, NULL));
    assert_int_equal(bands, 1);
    check_relative("worst speed, by the forward whirl", band.speed, forward, 2e-3);
    rig_close(&s);
}

/* A load that its part takes along goes round in axes at rest. */
static void refused_in_axes_at_rest(void **state)
{
    (void)state;
    rig s;
    dmb_response *response = NULL;
    dmb_load_def load = dmb_load_def_default();
    dmb_pipe_def pipe = beam_pipe(LENGTH, 2, 1e9, 1e12, 1e6, 1e3);
    dmb_string_def string = dmb_string_def_default();
    dmb_response_options options = dmb_response_options_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    string.velocity[3] = SPEED;
    string.start_free = DMB_FREE_RX;
    pipe.string = add_string(&s, &string);
    (void)add_pipes(&s, &pipe, 1);
    load.frame = DMB_FRAME_BODY;
    load.place = dmb_station(pipe.string, 0, 1.0);
    load.time_function = add_constant(&s, 0.0);
    load.force[1] = 1.0;
    const dmb_id across = add_load(&s, &load);
    load.force[1] = 0.0;
    load.force[0] = 1.0;
    const dmb_id along = add_load(&s, &load);
    const dmb_id held = add_simple_drive(&s, DMB_DRIVE_LOAD, pipe.string, DMB_RX, add_constant(&s, 0.0));
    rig_start(&s, NULL);
    const dmb_output output = output_at(DMB_OUTPUT_VIBRATION, load.place, DMB_X);
    dmb_excitation input = input_of(DMB_EXCITATION_LOAD, across, DMB_X);
    options.axes = DMB_RESPONSE_AXES_AT_REST;
    assert_int_equal(dmb_analysis_response(s.sim, &options, &input, 1, &output, 1, &response), DMB_ERR_UNSUPPORTED);
    assert_non_null(strstr(dmb_sim_message(s.sim), "excitation 0: the load turns with its part"));
    assert_null(response);
    input = input_of(DMB_EXCITATION_LOAD, along, DMB_X);
    must(&s, dmb_analysis_response(s.sim, &options, &input, 1, &output, 1, &response));
    dmb_response_destroy(&response);
    input = input_of(DMB_EXCITATION_DRIVE, held, DMB_X);
    must(&s, dmb_analysis_response(s.sim, &options, &input, 1, &output, 1, &response));
    dmb_response_destroy(&response);
    options.axes = 2;
    assert_int_equal(dmb_analysis_response(s.sim, &options, &input, 1, &output, 1, &response), DMB_ERR_VALUE);
    rig_close(&s);
}

/* ---- On the wall ------------------------------------------------------------------------------------------------- */

enum { OUTPUTS = 10 };

typedef struct turning {
    rig rig;
    dmb_id string;
} turning;

/* Three pipes that turn on the wall, settled there, and a force across that swings by `shake` [N]. */
static void open_turning(turning *s, double shake, double frequency)
{
    dmb_environment_def mud = dmb_environment_def_default();
    dmb_wall_def wall = s1_hole();
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def def = dmb_string_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_segment term = dmb_segment_default();
    dmb_static_options statics = dmb_static_options_default();
    dmb_sim_options options = dmb_sim_options_default();
    rig_open(&s->rig, 0.0, 0.0, -9.81);
    mud.gravity[2] = -9.81;
    mud.lateral_damping = 200.0;
    must_model(&s->rig, dmb_model_set_environment(s->rig.model, &mud));
    wall.friction_law = DMB_FRICTION_COULOMB;
    wall.mu_static = wall.mu_dynamic = 0.3;
    wall.normal_law = DMB_NORMAL_KELVIN_VOIGT;
    wall.stiffness = 1e6;
    wall.damping = 1e3;
    (void)add_wall(&s->rig, &wall);
    def.start_free = DMB_FREE_RX;
    s->string = pipe.string = add_string(&s->rig, &def);
    (void)add_pipes(&s->rig, &pipe, 3);
    (void)add_simple_drive(&s->rig, DMB_DRIVE_MOTION, s->string, DMB_RX, add_constant(&s->rig, SPEED));
    term.kind = DMB_SEGMENT_HARMONIC;
    term.h1 = shake;
    term.omega = 2.0 * PI * frequency;
    load.place = dmb_station(s->string, 2, 0.0);
    load.force[1] = 1.0;
    load.time_function = add_time_function(&s->rig, &term, 1);
    (void)add_load(&s->rig, &load);
    options.newton_tolerance = 1e-12;
    (void)rig_start(&s->rig, &options);
    statics.tolerance = 1e-12;
    (void)find_equilibrium(&s->rig, &statics);
}

static void outputs_of(const turning *s, dmb_output out[OUTPUTS])
{
    out[0] = output_at(DMB_OUTPUT_VIBRATION, dmb_station(s->string, 1, 0.5), DMB_Y);
    out[1] = output_at(DMB_OUTPUT_VIBRATION, dmb_station(s->string, 1, 0.5), DMB_Z);
    out[2] = output_at(DMB_OUTPUT_VIBRATION_VELOCITY, dmb_station(s->string, 2, 1.0), DMB_Y);
    out[3] = output_at(DMB_OUTPUT_CONTACT_NORMAL_FORCE, dmb_station(s->string, 2, 0.0), 0); /* site 2, the end */
    out[4] = output_at(DMB_OUTPUT_VIBRATION, dmb_station(s->string, 1, 0.5), DMB_RY); /* while the pipe turns on */
    out[5] = output_at(DMB_OUTPUT_VIBRATION_BODY, dmb_station(s->string, 1, 0.5), DMB_RZ);
    out[6] = output_at(DMB_OUTPUT_VIBRATION_VELOCITY, dmb_station(s->string, 2, 1.0), DMB_RZ);
    out[7] = output_at(DMB_OUTPUT_VIBRATION_VELOCITY_BODY, dmb_station(s->string, 1, 0.5), DMB_Y);
    out[8] = output_at(DMB_OUTPUT_VIBRATION_ACCELERATION_BODY, dmb_station(s->string, 1, 0.5), DMB_Z);
    out[9] = output_at(DMB_OUTPUT_VIBRATION_ACCELERATION, dmb_station(s->string, 1, 0.5), DMB_RY);
}

static void linear_on_the_wall(double frequency, double complex out[OUTPUTS])
{
    turning s;
    dmb_output outputs[OUTPUTS];
    open_turning(&s, 0.0, frequency);
    outputs_of(&s, outputs);
    for (int k = 0; k < OUTPUTS; k++)
        out[k] = in_axes(&s.rig, DMB_RESPONSE_AXES_AT_REST, force_at(dmb_station(s.string, 2, 0.0), DMB_Y), outputs[k],
                         frequency);
    rig_close(&s.rig);
}

static void in_time(double frequency, uint32_t steps, double complex out[OUTPUTS])
{
    turning s;
    const double shake = 0.01;
    dmb_stepped_sine_options options = dmb_stepped_sine_options_default();
    dmb_stepped_sine_report report = dmb_stepped_sine_report_default();
    dmb_output outputs[OUTPUTS];
    double amplitudes[OUTPUTS][2][2];
    open_turning(&s, shake, frequency);
    outputs_of(&s, outputs);
    options.steps_per_period = steps;
    options.harmonics = 1;
    options.tolerance = 1e-5;
    must(&s.rig,
         dmb_analysis_stepped_sine(s.rig.sim, frequency, &options, outputs, OUTPUTS, &amplitudes[0][0][0], &report));
    assert_int_equal(report.settled, 1);
    for (int k = 0; k < OUTPUTS; k++) /* a sine is the real part of -i e^(i w t) */
        out[k] = (amplitudes[k][1][0] + amplitudes[k][1][1] * i_) * i_ / shake;
    rig_close(&s.rig);
}

static double worst_of(const double complex a[OUTPUTS], const double complex b[OUTPUTS])
{
    double worst = 0.0;
    for (int k = 0; k < OUTPUTS; k++) worst = fmax(worst, cabs(a[k] - b[k]) / cabs(b[k]));
    return worst;
}

static void shaken_while_it_turns_on_the_wall(void **state)
{
    const double frequencies[] = {2.0, 9.0};
    (void)state;
    for (int i = 0; i < 2; i++) {
        double complex linear[OUTPUTS], coarse[OUTPUTS], fine[OUTPUTS];
        linear_on_the_wall(frequencies[i], linear);
        in_time(frequencies[i], 200, coarse);
        in_time(frequencies[i], 400, fine);
        for (int k = 0; k < OUTPUTS; k++)
            print_message("%g Hz: %g %+gi, in time %g %+gi\n", frequencies[i], creal(linear[k]), cimag(linear[k]),
                          creal(fine[k]), cimag(fine[k]));
        check_order("stepped sine", worst_of(coarse, linear), worst_of(fine, linear), 2.0, 0.1);
        for (int k = 0; k < OUTPUTS; k++) fine[k] += (fine[k] - coarse[k]) / 3.0;
        check_below("    extrapolated to steps of 0", worst_of(fine, linear), 1e-5);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(out_of_balance),
        cmocka_unit_test(speeds_of_a_turning_shaft),
        cmocka_unit_test(refused_in_axes_at_rest),
        cmocka_unit_test(shaken_while_it_turns_on_the_wall),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
