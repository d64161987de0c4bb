/* Responses by and of parts of a kind: controllers with and without an integral, drives beside joints and of open ones,
 * what turns with its part, places at ends, speeds that leave a joint out. */
#include <string.h>

#include "harmonic.h"
#include "mechanism.h"

static double off(double complex got, double complex wanted)
{
    return cabs(got - wanted) / cabs(wanted);
}

static dmb_place at(dmb_id part)
{
    return dmb_station(part, 0, 0.0);
}

static dmb_id add_slider(rig *s, double mass)
{
    dmb_body_def def = dmb_body_def_default();
    def.mass = mass;
    def.free_mask = DMB_FREE_X;
    return add_body(s, &def);
}

/* A mass on a controller, v/v* = c/(m s + c), c = kp + ki/s. */
static void controllers(void **state)
{
    const double frequencies[3] = {0.01, 0.3, 20.0};
    (void)state;
    for (int integral = 0; integral < 2; integral++) {
        rig s;
        double complex h[3];
        dmb_drive_def drive = dmb_drive_def_default();
        rig_open(&s, 0.0, 0.0, 0.0);
        drive.kind = DMB_DRIVE_CONTROL;
        drive.part = add_slider(&s, 7.0);
        drive.gain = 40.0;
        drive.integral_gain = integral ? 300.0 : 0.0;
        drive.time_function = add_constant(&s, 0.0);
        const dmb_id control = add_drive(&s, &drive);
        (void)rig_start(&s, NULL);
        const dmb_excitation input = input_of(DMB_EXCITATION_DRIVE, control, DMB_X);
        const dmb_output speed = output_at(DMB_OUTPUT_VIBRATION_VELOCITY, at(drive.part), DMB_X);
        transfer(&s, NULL, &input, &speed, frequencies, 3, h);
        for (int i = 0; i < 3; i++) {
            const double complex iw = 2.0 * PI * frequencies[i] * i_, c = drive.gain + drive.integral_gain / iw;
            check_below("speed over target", off(h[i], c / (7.0 * iw + c)), 1e-8);
        }
        rig_close(&s);
    }
}

/* A wheel on a bearing with a controller, a slider with a motion drive that no joint has part in. */
static void drives_beside_joints(void **state)
{
    const double frequency = 3.0;
    rig s;
    double complex h;
    dmb_body_def wheel = dmb_body_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    (void)state;
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id slider = add_slider(&s, 2.0), body = add_body(&s, &wheel);
    const dmb_id motion = add_simple_drive(&s, DMB_DRIVE_MOTION, slider, DMB_X, add_constant(&s, 0.0));
    const dmb_id bearing = add_joint_between(&s, DMB_JOINT_REVOLUTE, at(ground_id), at(body));
    drive.kind = DMB_DRIVE_CONTROL;
    drive.part = bearing;
    drive.component = DMB_RX;
    drive.gain = 5.0;
    drive.time_function = add_constant(&s, 0.0);
    const dmb_id control = add_drive(&s, &drive);
    (void)rig_start(&s, NULL);
    const dmb_excitation moved = input_of(DMB_EXCITATION_DRIVE, motion, DMB_X), torque = force_at(at(body), DMB_RX);
    const dmb_output speed = output_at(DMB_OUTPUT_VIBRATION_VELOCITY, at(slider), DMB_X);
    const dmb_output held = output_at(DMB_OUTPUT_DRIVE_FORCE, at(control), 0);
    const dmb_output action = output_at(DMB_OUTPUT_JOINT_ACTION, at(bearing), DMB_RX);
    transfer(&s, NULL, &moved, &speed, &frequency, 1, &h);
    check_below("slider, speed over speed", off(h, 1.0), 1e-12);
    transfer(&s, NULL, &torque, &held, &frequency, 1, &h);
    const double complex iw = 2.0 * PI * frequency * i_;
    check_below("controller of the bearing", off(h, -5.0 / (wheel.inertia[0] * iw + 5.0)), 1e-9);
    transfer(&s, NULL, &torque, &action, &frequency, 1, &h);
    assert_true(cabs(h) == 0.0); /* it has neither spring nor friction */
    must(&s, dmb_sim_set_joint(s.sim, bearing, DMB_JOINT_OPEN));
    transfer(&s, NULL, &torque, &held, &frequency, 1, &h);
    assert_true(cabs(h) == 0.0);
    rig_close(&s);
}

static void refuses(const rig *s, const dmb_excitation *input, const dmb_output *output, int32_t status,
                    const char *words)
{
    dmb_response_options options = dmb_response_options_default();
    dmb_response *response = NULL;
    options.axes = DMB_RESPONSE_AXES_AT_REST;
    assert_int_equal(dmb_analysis_response(s->sim, &options, input, 1, output, 1, &response), status);
    assert_null(response);
    if (strstr(dmb_sim_message(s->sim), words) == NULL) fail_msg("%s: %s", words, dmb_sim_message(s->sim));
}

/* A disc that spins freely: what pushes it across in its own axes goes round in those at rest, a torque along does not.
 */
static void what_turns_with_its_part(void **state)
{
    rig s;
    dmb_body_def disc = dmb_body_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_response_options options = dmb_response_options_default();
    dmb_id loads[3];
    const double frequency = 3.0;
    double complex h;
    (void)state;
    rig_open(&s, 0.0, 0.0, 0.0);
    disc.velocity[3] = 20.0;
    const dmb_id body = add_body(&s, &disc);
    const dmb_id push = add_simple_drive(&s, DMB_DRIVE_LOAD, body, DMB_Y, add_constant(&s, 0.0));
    const dmb_id along = add_simple_drive(&s, DMB_DRIVE_LOAD, body, DMB_X, add_constant(&s, 0.0));
    load.place = at(body);
    load.frame = DMB_FRAME_BODY;
    load.time_function = add_constant(&s, 0.0);
    for (int k = 0; k < 3; k++) {
        for (int c = 0; c < 3; c++) load.moment[c] = k == c;
        loads[k] = add_load(&s, &load);
    }
    (void)rig_start(&s, NULL);
    const dmb_output output = output_at(DMB_OUTPUT_VIBRATION_ACCELERATION, at(body), DMB_X);
    dmb_excitation input = input_of(DMB_EXCITATION_DRIVE, push, DMB_X);
    refuses(&s, &input, &output, DMB_ERR_UNSUPPORTED, "the drive turns with its part");
    for (int k = 1; k < 3; k++) {
        input = input_of(DMB_EXCITATION_LOAD, loads[k], DMB_X);
        refuses(&s, &input, &output, DMB_ERR_UNSUPPORTED, "the load turns with its part");
    }
    options.axes = DMB_RESPONSE_AXES_AT_REST;
    input = input_of(DMB_EXCITATION_DRIVE, along, DMB_X);
    transfer(&s, &options, &input, &output, &frequency, 1, &h);
    check_below("along the axis", off(h, 1.0 / disc.mass), 1e-12);
    const dmb_output spin = output_at(DMB_OUTPUT_VIBRATION_ACCELERATION, at(body), DMB_RX);
    input = input_of(DMB_EXCITATION_LOAD, loads[0], DMB_X);
    transfer(&s, &options, &input, &spin, &frequency, 1, &h);
    check_below("about it", off(h, 1.0 / disc.inertia[0]), 1e-12);
    rig_close(&s);
}

/* A pull at the end of a rod is the force in it there, and far below its first mode all along it. */
static void section_at_the_end(void **state)
{
    const double frequency = 0.01;
    rig s;
    double complex h;
    const dmb_pipe_def pipe = s1_pipe();
    (void)state;
    rig_open(&s, 0.0, 0.0, 0.0);
    dmb_pipe_def first = pipe;
    const dmb_id rod = add_beam(&s, &first, DMB_FREE_NONE);
    (void)rig_start(&s, NULL);
    const dmb_place end = dmb_station(rod, 0, 1.0), begin = dmb_station(rod, 0, 0.0);
    dmb_excitation pull = force_at(end, DMB_X);
    for (int i = 0; i < 2; i++) {
        const dmb_output force = output_at(DMB_OUTPUT_SECTION_FORCE, i == 0 ? begin : end, DMB_X);
        transfer(&s, NULL, &pull, &force, &frequency, 1, &h);
        check_below("force over force", off(h, 1.0), 1e-6);
    }
    pull.kind = DMB_EXCITATION_UNBALANCE;
    pull.component = DMB_RX;
    pull.place.pipe = 7;
    const dmb_output motion = output_at(DMB_OUTPUT_VIBRATION, end, DMB_Y);
    refuses(&s, &pull, &motion, DMB_ERR_VALUE, "excitation 0");
    rig_close(&s);
}

/* A rotor spins across the x axes: the equations of its bearing turn, which a response tells, and so do speeds. */
static void speeds_that_leave_a_bearing_out(void **state)
{
    rig s;
    dmb_body_def carrier = dmb_body_def_default(), rotor = dmb_body_def_default();
    dmb_speeds_options options = dmb_speeds_options_default();
    dmb_order order = dmb_order_default();
    dmb_speed_band band = dmb_speed_band_default();
    uint32_t bands = 1;
    const double limit = 1e3;
    (void)state;
    rig_open(&s, 0.0, 0.0, 0.0);
    rotor.velocity[4] = 20.0;
    const dmb_id frame = add_body(&s, &carrier), wheel = add_body(&s, &rotor);
    dmb_joint_def ball = joint_between(DMB_JOINT_SPHERICAL, at(ground_id), at(frame));
    for (int k = 3; k < 6; k++) ball.stiffness[k] = 100.0;
    for (int k = 3; k < 6; k++) ball.damping[k] = 1.0;
    (void)add_joint(&s, &ball);
    dmb_joint_def bearing = joint_between(DMB_JOINT_REVOLUTE, at(frame), at(wheel));
    for (int k = 0; k < 3; k++) bearing.axis_a[k] = bearing.axis_b[k] = k == 1;
    for (int k = 0; k < 3; k++) bearing.normal_a[k] = bearing.normal_b[k] = k == 2;
    (void)strcpy(bearing.name, "bearing");
    (void)add_joint(&s, &bearing);
    (void)rig_start(&s, NULL);
    order.excitation = force_at(at(frame), DMB_RY);
    const dmb_output output = output_at(DMB_OUTPUT_VIBRATION, at(frame), DMB_RY);
    assert_int_equal(dmb_analysis_speeds(s.sim, &options, &order, 1, &output, &limit, 1, &band, &bands, NULL),
                     DMB_NOTE_INCOMPLETE);
    assert_non_null(strstr(dmb_sim_message(s.sim), "speeds: "));
    assert_non_null(strstr(dmb_sim_message(s.sim), "bearing"));
    assert_int_equal(bands, 0);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(controllers),
        cmocka_unit_test(drives_beside_joints),
        cmocka_unit_test(what_turns_with_its_part),
        cmocka_unit_test(section_at_the_end),
        cmocka_unit_test(speeds_that_leave_a_bearing_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
