/* Forces as outputs of a frequency response - of contacts, drives, supports, joints, constraints, of the bit - against
 * stepped sine in time at small amplitudes. */
#include <stdio.h>
#include <string.h>

#include "harmonic.h"

enum { OUTPUTS_MAX = 8 };

typedef struct named_output {
    const char *name;
    dmb_output output;
} named_output;

/* The linear response about the state of `still` against the first harmonic of `shaken`, whose time function is a sine;
 * its `others` are the same outputs there. */
static void compare(const rig *still, const rig *shaken, double tolerance, double frequency,
                    const dmb_excitation *input, double amplitude, const named_output *outputs,
                    const named_output *others, uint32_t count)
{
    dmb_response_options about = dmb_response_options_default();
    dmb_stepped_sine_options options = dmb_stepped_sine_options_default();
    dmb_output asked[OUTPUTS_MAX];
    double amplitudes[OUTPUTS_MAX][4][2];
    double complex linear[OUTPUTS_MAX];
    about.equilibrium_tolerance = tolerance;
    options.steps_per_period = 400;
    options.tolerance = 1e-4;
    for (uint32_t k = 0; k < count; k++) {
        asked[k] = others[k].output;
        transfer(still, &about, input, &outputs[k].output, &frequency, 1, linear + k);
    }
    const int32_t status =
        dmb_analysis_stepped_sine(shaken->sim, frequency, &options, asked, count, &amplitudes[0][0][0], NULL);
    must(shaken, status);
    assert_int_equal(status, DMB_OK);
    for (uint32_t k = 0; k < count; k++) {
        const double complex want = amplitude * linear[k] / i_, got = amplitudes[k][1][0] + i_ * amplitudes[k][1][1];
        assert_true(cabs(want) > 0.0);
        check_below(outputs[k].name, cabs(got - want) / cabs(want), 1e-3);
    }
}

static dmb_id add_shaking(rig *s, double mean, double amplitude, double frequency)
{
    dmb_segment terms[2] = {dmb_segment_default(), dmb_segment_default()};
    terms[0].h0 = mean;
    terms[1].kind = DMB_SEGMENT_HARMONIC;
    terms[1].h1 = amplitude;
    terms[1].omega = 2.0 * PI * frequency;
    return add_time_function(s, terms, 2);
}

static named_output named(const char *name, int32_t kind, dmb_place place, int32_t component)
{
    const named_output out = {name, output_at(kind, place, component)};
    return out;
}

static dmb_place number(uint32_t n)
{
    return dmb_station((dmb_id){0, 0}, n, 0.0);
}

static dmb_place part(dmb_id id)
{
    return dmb_station(id, 0, 0.0);
}

/* ---- Contacts, drives and supports ---------------------------------------------------------------------------------
 */

/* Ten pipes at rest on the wall of their hole. */
static dmb_id open_string(rig *s, int32_t start_free, int32_t kind)
{
    rig_open(s, 0.0, 0.0, -9.81);
    dmb_wall_def hole = s1_hole();
    hole.normal_law = DMB_NORMAL_KELVIN_VOIGT;
    hole.damping = 3e3;
    hole.friction_law = DMB_FRICTION_COULOMB;
    hole.smoothing_speed = 1e-2;
    (void)add_wall(s, &hole);
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    def.start_free = start_free;
    pipe.kind = kind;
    pipe.damping_time = 2e-3;
    pipe.string = add_string(s, &def);
    (void)add_pipes(s, &pipe, 10);
    return pipe.string;
}

static void start(rig *s)
{
    (void)rig_start(s, NULL);
    (void)find_equilibrium(s, NULL);
}

/* Fed to and fro so slowly that smoothed friction is a damper; beams, and an axial-torsional string. */
static void fed_on_the_wall(void **state)
{
    (void)state;
    for (int path = 0; path < 2; path++) {
        rig s;
        const double frequency = 7.0, amplitude = 1e-5;
        const dmb_id string = open_string(&s, DMB_FREE_X, path ? DMB_PIPE_AXIAL_TORSIONAL : DMB_PIPE_FLEXIBLE);
        const dmb_id drive =
            add_simple_drive(&s, DMB_DRIVE_MOTION, string, DMB_X, add_shaking(&s, 0.0, amplitude, frequency));
        start(&s);
        const dmb_excitation input = input_of(DMB_EXCITATION_DRIVE, drive, DMB_X);
        const named_output outputs[4] = {
            named("fed on the wall: friction of a ring", DMB_OUTPUT_CONTACT_FRICTION_AXIAL, number(5), 0),
            named("    force of the drive", DMB_OUTPUT_DRIVE_FORCE, part(drive), 0),
            named("    reaction of support and drive", DMB_OUTPUT_REACTION, part(string), DMB_X),
            named("    strain of a section", DMB_OUTPUT_SECTION_STRAIN, dmb_station(string, 5, 0.5), DMB_X),
        };
        compare(&s, &s, 1e-6, frequency, &input, amplitude, outputs, outputs, 4);
        rig_close(&s);
    }
}

/* A beam held at both ends and pushed in its middle next to statically: half the force and an eighth of its moment at
 * the rig end, of the opposite sign, though the far end is held too. */
static void held_at_both_ends(void **state)
{
    (void)state;
    const double frequency = 1e-3, L = 2.0;
    const dmb_pipe_def pipe = beam_pipe(L, 4, 1e9, 1e9, 1e4, 1e4);
    dmb_string_def string = dmb_string_def_default();
    dmb_load_def load = dmb_load_def_default();
    double complex value;
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    string.follows_hole = 0;
    string.start_free = string.end_free = DMB_FREE_NONE;
    const dmb_id id = add_string(&s, &string);
    (void)add_pipes(&s, &pipe, 1);
    load.place = dmb_station(id, 0, 0.5);
    load.force[2] = 1.0;
    load.time_function = add_constant(&s, 0.0);
    const dmb_excitation input = input_of(DMB_EXCITATION_LOAD, add_load(&s, &load), DMB_X);
    start(&s);
    const dmb_output force = output_at(DMB_OUTPUT_REACTION, part(id), DMB_Z);
    const dmb_output moment = output_at(DMB_OUTPUT_REACTION, part(id), DMB_RY);
    transfer(&s, NULL, &input, &force, &frequency, 1, &value);
    check_close("held at both ends: force of the clamp", creal(value), -0.5, 1e-6);
    transfer(&s, NULL, &input, &moment, &frequency, 1, &value);
    check_close("    its moment", fabs(creal(value)), L / 8.0, 1e-6);
    rig_close(&s);
}

static void pulled_on_the_wall(void **state)
{
    (void)state;
    rig s;
    const double frequency = 7.0, amplitude = 2.0;
    const dmb_id string = open_string(&s, DMB_FREE_NONE, DMB_PIPE_FLEXIBLE);
    dmb_load_def load = dmb_load_def_default();
    load.place = dmb_station(string, 1, 1.0);
    load.force[2] = -1.0;
    load.time_function = add_shaking(&s, 0.0, amplitude, frequency);
    const dmb_excitation input = input_of(DMB_EXCITATION_LOAD, add_load(&s, &load), DMB_X);
    start(&s);
    const named_output outputs[3] = {
        named("pulled on the wall: normal force of a ring", DMB_OUTPUT_CONTACT_NORMAL_FORCE, number(3), 0),
        named("    force of the clamp", DMB_OUTPUT_REACTION, part(string), DMB_Z),
        named("    moment of the clamp", DMB_OUTPUT_REACTION, part(string), DMB_RY),
    };
    compare(&s, &s, 1e-6, frequency, &input, amplitude, outputs, outputs, 3);
    rig_close(&s);
}

/* The axial-torsional string of fed_on_the_wall, clamped at its rig end, rubbed by a unit of coefficient along the hole
 * and around it at frequency 0: its normal forces N at the depths x stretch it by sum N x/(E A) and wind it up by
 * sum N r x/(G J). */
static void rubbed_on_the_wall(void **state)
{
    (void)state;
    rig s;
    const double zero = 0.0;
    const s1_section v = s1_values();
    const dmb_id string = open_string(&s, DMB_FREE_NONE, DMB_PIPE_AXIAL_TORSIONAL);
    dmb_model_info info = dmb_model_info_default();
    double stretch = 0.0, wind = 0.0;
    double complex got[2];
    start(&s);
    must_model(&s, dmb_model_get_info(s.model, &info));
    for (uint32_t i = 0; i < info.contact_points; i++) {
        dmb_contact contact = dmb_contact_default();
        must(&s, dmb_query_contact(s.sim, i, &contact));
        const double x = contact.pipe == DMB_NONE ? 0.0 : 1.5 * (contact.pipe + 1);
        stretch += contact.normal_force * x / v.EA;
        wind += contact.normal_force * 0.5 * 0.073 * x / v.GJ;
    }
    for (int around = 0; around < 2; around++) {
        const int32_t c = around ? DMB_RX : DMB_X;
        const dmb_excitation input = input_of(DMB_EXCITATION_FRICTION, (dmb_id){0, 0}, c);
        const dmb_output move = output_at(DMB_OUTPUT_VIBRATION, dmb_station(string, 9, 1.0), c);
        transfer(&s, NULL, &input, &move, &zero, 1, got + around);
    }
    check_relative("rubbed on the wall: stretch", creal(got[0]), stretch, 1e-11);
    check_relative("    wind-up", creal(got[1]), wind, 1e-11);
    rig_close(&s);
}

/* A string that hangs from its clamp onto the low side of the hole, a unit force on it at frequency 0. Rings within the
 * gap count as closed: the forces of clamp and rings on the string balance the unit, and what an open ring adds is its
 * stiffness, that of the wall over its length, times what it moves. */
static void rings_that_count_as_closed(void **state)
{
    (void)state;
    rig s;
    const double zero = 0.0;
    dmb_response_options options = dmb_response_options_default();
    dmb_model_info info = dmb_model_info_default();
    const dmb_id string = open_string(&s, DMB_FREE_NONE, DMB_PIPE_FLEXIBLE);
    const dmb_excitation force = force_at(dmb_station(string, 1, 1.0), DMB_Z);
    start(&s);
    must_model(&s, dmb_model_get_info(s.model, &info));
    double complex sum[3], last = 0.0;
    uint32_t closed[3] = {0, 0, 0};
    for (int k = 0; k < 3; k++) { /* as they are, all within 6 mm, all of them */
        options.contact = k == 0 ? DMB_CONTACT_AS_IS : DMB_CONTACT_CLOSED;
        options.contact_gap = k == 1 ? 6e-3 : 1.0;
        const dmb_output clamp = output_at(DMB_OUTPUT_REACTION, part(string), DMB_Z);
        transfer(&s, &options, &force, &clamp, &zero, 1, sum + k);
        for (uint32_t i = 0; i < info.contact_points; i++) {
            dmb_contact contact = dmb_contact_default();
            double complex normal;
            must(&s, dmb_query_contact(s.sim, i, &contact));
            const dmb_output press = output_at(DMB_OUTPUT_CONTACT_NORMAL_FORCE, number(i), 0);
            transfer(&s, &options, &force, &press, &zero, 1, &normal);
            closed[k] += cabs(normal) > 0.0;
            sum[k] -= normal * contact.normal[2];
            if (k == 0 || contact.closed || contact.pipe == DMB_NONE) continue;
            const dmb_output move = output_at(DMB_OUTPUT_VIBRATION, dmb_station(string, contact.pipe, 1.0), DMB_Z);
            transfer(&s, &options, &force, &move, &zero, 1, &last);
            const double stiffness = contact.gap <= options.contact_gap ? s1_hole().stiffness * contact.length : 0.0;
            check_below("an open ring that counts as closed: its force, less k d",
                        cabs(normal - stiffness * last * contact.normal[2]), 1e-9);
        }
        check_close("forces of clamp and rings", creal(sum[k]), -1.0, 1e-8);
    }
    print_message("    rings that press: %u, %u, %u\n", closed[0], closed[1], closed[2]);
    assert_true(closed[0] < closed[1] && closed[1] < closed[2]);
    rig_close(&s);
}

/* ---- Joints ------------------------------------------------------------------------------------------------------ */

/* A string of three pipes in a bearing with spring and damper, its chuck turned by a controller; gravity sideways. */
static dmb_id open_bearing(rig *s, double target, double pull, double frequency, dmb_id parts[4])
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_body_def chuck = dmb_body_def_default();
    dmb_joint_def bearing = dmb_joint_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_load_def load = dmb_load_def_default();
    rig_open(s, 0.0, 0.0, -9.81);
    def.follows_hole = 0;
    def.start_free = DMB_FREE_ALL;
    pipe.damping_time = 1e-3;
    pipe.string = add_string(s, &def);
    (void)add_pipes(s, &pipe, 3);
    chuck.mass = 40.0;
    chuck.free_mask = DMB_FREE_RX;
    parts[0] = add_body(s, &chuck);
    bearing.kind = DMB_JOINT_REVOLUTE;
    bearing.place_a = part(parts[0]);
    bearing.place_b = part(pipe.string);
    bearing.stiffness[DMB_RX] = 900.0;
    bearing.damping[DMB_RX] = 12.0;
    must_model(s, dmb_model_add_joint(s->model, &bearing, parts + 1));
    drive.kind = DMB_DRIVE_CONTROL;
    drive.part = parts[0];
    drive.component = DMB_RX;
    drive.gain = 60.0;
    drive.integral_gain = 200.0;
    drive.time_function = add_shaking(s, 0.0, target, frequency);
    parts[2] = add_drive(s, &drive);
    load.place = dmb_station(pipe.string, 2, 1.0);
    load.force[1] = 1.0;
    load.force[2] = 0.5;
    load.time_function = add_shaking(s, 0.0, pull, frequency);
    parts[3] = add_load(s, &load);
    start(s);
    return pipe.string;
}

static void turned_in_a_bearing(void **state)
{
    (void)state;
    rig s;
    dmb_id p[4];
    (void)open_bearing(&s, 1e-4, 0.0, 9.0, p);
    const dmb_excitation input = input_of(DMB_EXCITATION_DRIVE, p[2], DMB_X);
    const named_output outputs[5] = {
        named("turned in a bearing: force of the controller", DMB_OUTPUT_DRIVE_FORCE, part(p[2]), 0),
        named("    angle of the bearing", DMB_OUTPUT_JOINT_POSITION, part(p[1]), DMB_RX),
        named("    its speed", DMB_OUTPUT_JOINT_SPEED, part(p[1]), DMB_RX),
        named("    its acceleration", DMB_OUTPUT_JOINT_ACCELERATION, part(p[1]), DMB_RX),
        named("    torque of its spring and damper", DMB_OUTPUT_JOINT_ACTION, part(p[1]), DMB_RX),
    };
    compare(&s, &s, 1e-6, 9.0, &input, 1e-4, outputs, outputs, 5);
    rig_close(&s);
}

static void pulled_in_a_bearing(void **state)
{
    (void)state;
    rig s;
    dmb_id p[4];
    (void)open_bearing(&s, 0.0, 0.1, 9.0, p);
    const dmb_excitation input = input_of(DMB_EXCITATION_LOAD, p[3], DMB_X);
    named_output outputs[6] = {
        named("pulled in a bearing: force on it", DMB_OUTPUT_JOINT_REACTION, part(p[1]), DMB_Z),
        named("    moment on it", DMB_OUTPUT_JOINT_REACTION, part(p[1]), DMB_RZ),
        named("    moment in its own axes", DMB_OUTPUT_JOINT_REACTION, part(p[1]), DMB_RY),
        named("    multiplier of its second equation", DMB_OUTPUT_MULTIPLIER, part(p[1]), 1),
        named("    force of the chuck's support", DMB_OUTPUT_REACTION, part(p[0]), DMB_Y),
        named("    moment of the chuck's support", DMB_OUTPUT_REACTION, part(p[0]), DMB_RY),
    };
    outputs[2].output.quantity += DMB_OUTPUT_JOINT_REACTION_BODY - DMB_OUTPUT_JOINT_REACTION;
    compare(&s, &s, 1e-6, 9.0, &input, 0.1, outputs, outputs, 6);
    rig_close(&s);
}

/* Two wheels on bearings, geared 1 : 3, the first turned by a motion drive, the second against a spring. */
static void driven_gears(void **state)
{
    (void)state;
    const double frequency = 6.0, amplitude = 1e-3;
    rig s;
    dmb_id joint[2], gear = {0, 0};
    rig_open(&s, 0.0, 0.0, 0.0);
    for (int i = 0; i < 2; i++) {
        dmb_body_def wheel = dmb_body_def_default();
        dmb_joint_def bearing = dmb_joint_def_default();
        wheel.mass = 5.0 * (i + 1);
        wheel.position[1] = 1.0 * i;
        bearing.kind = DMB_JOINT_REVOLUTE;
        bearing.place_b = part(add_body(&s, &wheel));
        bearing.stiffness[DMB_RX] = i * 400.0;
        bearing.damping[DMB_RX] = i * 3.0;
        must_model(&s, dmb_model_add_joint(s.model, &bearing, joint + i));
    }
    dmb_coupling_def def = dmb_coupling_def_default();
    def.joint[0] = joint[0];
    def.joint[1] = joint[1];
    def.ratio = 3.0;
    must_model(&s, dmb_model_add_coupling(s.model, &def, &gear));
    const dmb_id drive =
        add_simple_drive(&s, DMB_DRIVE_MOTION, joint[0], DMB_RX, add_shaking(&s, 0.0, amplitude, frequency));
    (void)rig_start(&s, NULL);
    const dmb_excitation input = input_of(DMB_EXCITATION_DRIVE, drive, DMB_X);
    const named_output outputs[4] = {
        named("geared wheels: torque of the drive", DMB_OUTPUT_DRIVE_FORCE, part(drive), 0),
        named("    multiplier of the gears", DMB_OUTPUT_MULTIPLIER, part(gear), 0),
        named("    angle of the second wheel", DMB_OUTPUT_JOINT_POSITION, part(joint[1]), DMB_RX),
        named("    torque of its spring", DMB_OUTPUT_JOINT_ACTION, part(joint[1]), DMB_RX),
    };
    compare(&s, &s, 1e-6, frequency, &input, amplitude, outputs, outputs, 4);
    rig_close(&s);
}

/* A wheel on its bearing's spring, loaded by a drive of the bearing. */
static dmb_id open_loaded_wheel(rig *s, dmb_id *bearing, dmb_place *wheel)
{
    dmb_body_def body = dmb_body_def_default();
    dmb_joint_def def = dmb_joint_def_default();
    rig_open(s, 0.0, 0.0, 0.0);
    body.free_mask = DMB_FREE_ALL;
    def.kind = DMB_JOINT_REVOLUTE;
    def.place_b = *wheel = part(add_body(s, &body));
    def.stiffness[DMB_RX] = 400.0;
    must_model(s, dmb_model_add_joint(s->model, &def, bearing));
    const dmb_id drive = add_simple_drive(s, DMB_DRIVE_LOAD, *bearing, DMB_RX, add_constant(s, 0.0));
    (void)rig_start(s, NULL);
    return drive;
}

/* The force of a load is its target. While its joint is open there is none, nor one of the joint's spring. */
static void load_of_a_joint_that_opens(void **state)
{
    (void)state;
    const dmb_response_options options = dmb_response_options_default();
    const double frequency = 5.0;
    rig s;
    dmb_id bearing = {0, 0};
    dmb_place wheel;
    double complex value;
    dmb_response *response = NULL;
    const dmb_id drive = open_loaded_wheel(&s, &bearing, &wheel);
    const dmb_excitation input = input_of(DMB_EXCITATION_DRIVE, drive, DMB_X);
    dmb_excitation torque = input_of(DMB_EXCITATION_FORCE, wheel.part, DMB_RX);
    torque.place = wheel;
    const dmb_output force = output_at(DMB_OUTPUT_DRIVE_FORCE, part(drive), 0);
    const dmb_output action = output_at(DMB_OUTPUT_JOINT_ACTION, part(bearing), DMB_RX);
    transfer(&s, &options, &input, &force, &frequency, 1, &value);
    check_below("a load of a joint: its force over its target, off 1 by", cabs(value - 1.0), 1e-15);
    transfer(&s, &options, &torque, &action, &frequency, 1, &value);
    assert_true(cabs(value) > 0.0);
    must(&s, dmb_sim_set_joint(s.sim, bearing, DMB_JOINT_OPEN));
    transfer(&s, &options, &torque, &force, &frequency, 1, &value);
    assert_true(cabs(value) == 0.0);
    transfer(&s, &options, &torque, &action, &frequency, 1, &value);
    assert_true(cabs(value) == 0.0);
    assert_int_equal(dmb_analysis_response(s.sim, &options, &input, 1, &force, 1, &response), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_sim_message(s.sim), "the joint of the drive is open"));
    rig_close(&s);
}

/* A shaft on two bearings that hold it more than once, each by five equations: of the forces and moments on it the two
 * take equal shares, which are the least ones, and together they balance it: F + m w^2 d = 0 with what does not move.
 */
static void bearings_that_share(void **state)
{
    (void)state;
    const double frequency = 5.0;
    rig s;
    dmb_id bearing[2];
    dmb_body_def shaft = dmb_body_def_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    shaft.mass = 4.0;
    const dmb_place place = dmb_station(add_body(&s, &shaft), 0, 0.0);
    for (int i = 0; i < 2; i++) {
        dmb_joint_def joint = joint_between(DMB_JOINT_REVOLUTE, dmb_station((dmb_id){0, 0}, 0, 0.0), place);
        joint.origin_a[0] = joint.origin_b[0] = i == 0 ? -0.5 : 0.5;
        bearing[i] = add_joint(&s, &joint);
    }
    (void)rig_start(&s, NULL);
    for (int32_t c = DMB_Y; c <= DMB_Z; c++) {
        const dmb_excitation force = force_at(place, c);
        double complex got[2];
        for (int i = 0; i < 2; i++) {
            const dmb_output reaction = output_at(DMB_OUTPUT_JOINT_REACTION, part(bearing[i]), c);
            transfer(&s, NULL, &force, &reaction, &frequency, 1, got + i);
        }
        check_below("bearings that share: the sum against the force", cabs(got[0] + got[1] + 1.0), 1e-12);
        check_below("    their difference", cabs(got[0] - got[1]), 1e-12);
    }
    rig_close(&s);
}

/* ---- The bit ----------------------------------------------------------------------------------------------------- */

/* Drills coal at 20 mm/s and 200 rpm by the rate law, two pipes between drives and bit; the feed shakes. */
static dmb_id open_drilling(rig *s, double amplitude, double frequency, named_output outputs[4])
{
    const double feed = 0.02, turning = 20.943951;
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_id id = {0, 0};
    rig_open(s, 0.0, 0.0, 0.0);
    def.velocity[0] = feed;
    def.velocity[3] = turning;
    pipe.damping_time = 1e-3;
    pipe.string = add_string(s, &def);
    (void)add_pipes(s, &pipe, 2);
    bit.rock_law = DMB_ROCK_RATE;
    must_model(s, dmb_model_add_bit(s->model, &bit, &id));
    const dmb_id advance =
        add_simple_drive(s, DMB_DRIVE_MOTION, pipe.string, DMB_X, add_shaking(s, feed, amplitude, frequency));
    const dmb_id turn = add_simple_drive(s, DMB_DRIVE_MOTION, pipe.string, DMB_RX, add_constant(s, turning));
    (void)rig_start(s, NULL);
    outputs[0] = named("drilling: weight on the bit", DMB_OUTPUT_BIT_ROCK_WEIGHT, part(id), 0);
    outputs[1] = named("    torque on the bit", DMB_OUTPUT_BIT_TORQUE, part(id), 0);
    outputs[2] = named("    force of the feed", DMB_OUTPUT_DRIVE_FORCE, part(advance), 0);
    outputs[3] = named("    torque of the drive", DMB_OUTPUT_DRIVE_FORCE, part(turn), 0);
    return advance;
}

static void shaken_bit(void **state)
{
    (void)state;
    const double frequency = 8.0, amplitude = 2e-5;
    named_output outputs[4], others[4];
    rig still, shaken;
    const dmb_excitation input = input_of(DMB_EXCITATION_DRIVE, open_drilling(&still, 0.0, frequency, outputs), DMB_X);
    (void)open_drilling(&shaken, amplitude, frequency, others);
    take_steps(&still, 1e-3, 1000);
    compare(&still, &shaken, 1e-3, frequency, &input, amplitude, outputs, others, 4);
    rig_close(&still);
    rig_close(&shaken);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fed_on_the_wall),
        cmocka_unit_test(pulled_on_the_wall),
        cmocka_unit_test(held_at_both_ends),
        cmocka_unit_test(rubbed_on_the_wall),
        cmocka_unit_test(rings_that_count_as_closed),
        cmocka_unit_test(turned_in_a_bearing),
        cmocka_unit_test(pulled_in_a_bearing),
        cmocka_unit_test(driven_gears),
        cmocka_unit_test(bearings_that_share),
        cmocka_unit_test(shaken_bit),
        cmocka_unit_test(load_of_a_joint_that_opens),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
