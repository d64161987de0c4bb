/* A frequency response refuses bad arguments with a message, changes nothing and gives all memory back. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "scarce.h"

typedef struct scene {
    scarce memory;
    dmb_model *model;
    dmb_sim *sim;
    dmb_id string, drive, load;
    dmb_response_options options;
    dmb_excitation input;
    dmb_output output;
} scene;

/* Ten pipes without a wall, rig end free in `free_mask`, turned and pushed; gravity downwards. */
static void begin(scene *s, int32_t free_mask, double gravity)
{
    dmb_environment_def around = dmb_environment_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    const dmb_segment zero = dmb_segment_default();
    memset(s, 0, sizeof *s);
    const dmb_allocator allocator = scarce_allocator(&s->memory);
    options.allocator = &allocator;
    around.gravity[2] = gravity;
    string.start_free = free_mask;
    drive.component = DMB_RX;
    assert_int_equal(dmb_model_create(NULL, &s->model), DMB_OK);
    assert_int_equal(dmb_model_set_environment(s->model, &around), DMB_OK);
    assert_int_equal(dmb_model_add_string(s->model, &string, &s->string), DMB_OK);
    assert_int_equal(dmb_model_add_pipes(s->model, &pipe, 10, NULL), DMB_OK);
    assert_int_equal(dmb_model_add_time_function(s->model, &zero, 1, &drive.time_function), DMB_OK);
    if (free_mask & DMB_FREE_RX) assert_int_equal(dmb_model_add_drive(s->model, &drive, &s->drive), DMB_OK);
    load.place = dmb_station(s->string, 9, 1.0);
    assert_int_equal(dmb_model_add_load(s->model, &load, &s->load), DMB_OK);
    assert_int_equal(dmb_model_compile(s->model, NULL), DMB_OK);
    assert_int_equal(dmb_sim_create(s->model, &options, &s->sim), DMB_OK);
    s->options = dmb_response_options_default();
    s->options.points = 3;
    s->input = dmb_excitation_default();
    s->input.place = load.place;
    s->output = (dmb_output){.quantity = DMB_OUTPUT_VIBRATION};
    s->output.place = load.place;
}

static void end(scene *s)
{
    dmb_sim_destroy(&s->sim);
    dmb_model_destroy(&s->model);
    assert_int_equal(s->memory.live, 0);
}

static int32_t ask(scene *s, dmb_response **response)
{
    return dmb_analysis_response(s->sim, &s->options, &s->input, 1, &s->output, 1, response);
}

/* The status, words of the message, the state and the memory as before. */
static void expect(scene *s, int32_t status, const char *first, const char *second)
{
    dmb_response *response = (dmb_response *)(void *)s;
    uint64_t before, after;
    const size_t live = s->memory.live;
    assert_int_equal(dmb_sim_hash(s->sim, &before), DMB_OK);
    assert_int_equal(ask(s, &response), status);
    assert_null(response);
    assert_int_equal(dmb_sim_hash(s->sim, &after), DMB_OK);
    assert_true(before == after);
    assert_int_equal(s->memory.live, live);
    const char *message = dmb_sim_message(s->sim);
    if (strstr(message, first) == NULL || strstr(message, second) == NULL)
        fail_msg("the message lacks \"%s\" or \"%s\": %s", first, second, message);
    print_message("    %s\n", message);
}

static void frequency_zero_with_a_free_part(void **state)
{
    (void)state;
    scene s;
    begin(&s, DMB_FREE_CYLINDRICAL, 0.0);
    dmb_response *response = NULL;
    assert_int_equal(ask(&s, &response), DMB_OK); /* free to slide, held by its inertia */
    dmb_response_destroy(&response);
    s.options.frequency_low = 0.0;
    expect(&s, DMB_ERR_SINGULAR, "frequency 0 Hz", "string 0");
    end(&s);
}

static void motion_drive_at_frequency_zero(void **state)
{
    (void)state;
    scene s;
    begin(&s, DMB_FREE_RX, 0.0);
    s.options.frequency_low = 0.0;
    s.input = dmb_excitation_default();
    s.input.kind = DMB_EXCITATION_DRIVE;
    s.input.place = dmb_station(s.drive, 0, 0.0);
    expect(&s, DMB_ERR_SINGULAR, "excitation 0", "frequency 0");
    end(&s);
}

static void state_out_of_balance(void **state)
{
    (void)state;
    scene s;
    begin(&s, DMB_FREE_NONE, -9.81);
    expect(&s, DMB_ERR_VALUE, "not an equilibrium", "must be <= 1");
    assert_int_equal(dmb_analysis_static(s.sim, NULL, NULL), DMB_OK);
    dmb_response *response = NULL;
    assert_int_equal(ask(&s, &response), DMB_OK);
    dmb_response_destroy(&response);
    end(&s);
}

/* A model that is described by hand: a body, a joint to the ground, a motion drive, a string of eccentric pipes. */
static void describe_body(scene *s, int32_t free_mask, int32_t joint_kind, int32_t driven)
{
    dmb_environment_def none = dmb_environment_def_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_joint_def joint = dmb_joint_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    const dmb_segment zero = dmb_segment_default();
    none.gravity[2] = 0.0;
    body.free_mask = free_mask;
    joint.kind = joint_kind;
    drive.component = DMB_RX;
    assert_int_equal(dmb_model_create(NULL, &s->model), DMB_OK);
    assert_int_equal(dmb_model_set_environment(s->model, &none), DMB_OK);
    assert_int_equal(dmb_model_add_body(s->model, &body, &drive.part), DMB_OK);
    joint.place_b = dmb_station(drive.part, 0, 0.0);
    assert_int_equal(dmb_model_add_joint(s->model, &joint, NULL), DMB_OK);
    assert_int_equal(dmb_model_add_time_function(s->model, &zero, 1, &drive.time_function), DMB_OK);
    if (driven) assert_int_equal(dmb_model_add_drive(s->model, &drive, &s->drive), DMB_OK);
    s->input = dmb_excitation_default();
    s->output = (dmb_output){.quantity = DMB_OUTPUT_VIBRATION};
    s->input.place = s->output.place = joint.place_b;
}

static void start(scene *s)
{
    assert_true(dmb_model_compile(s->model, NULL) >= 0);
    assert_true(dmb_sim_create(s->model, NULL, &s->sim) >= 0);
    s->options = dmb_response_options_default();
    s->options.points = 3;
}

/* A wheel that turns freely in its bearing. */
static void frequency_zero_with_a_free_joint(void **state)
{
    (void)state;
    scene s;
    memset(&s, 0, sizeof s);
    describe_body(&s, DMB_FREE_ALL, DMB_JOINT_REVOLUTE, 0);
    start(&s);
    dmb_response *response = NULL;
    assert_int_equal(ask(&s, &response), DMB_OK);
    dmb_response_destroy(&response);
    s.options.frequency_low = 0.0;
    expect(&s, DMB_ERR_SINGULAR, "frequency 0 Hz", "body 0");
    end(&s);
}

/* Three wheels on bearings, with springs between them that leave all three free to turn together: what the elimination
 * leaves is of rounding size. */
static void frequency_zero_with_free_wheels(void **state)
{
    (void)state;
    scene s;
    dmb_environment_def none = dmb_environment_def_default();
    dmb_place last = dmb_station((dmb_id){0, 0}, 0, 0.0);
    memset(&s, 0, sizeof s);
    none.gravity[2] = 0.0;
    assert_int_equal(dmb_model_create(NULL, &s.model), DMB_OK);
    assert_int_equal(dmb_model_set_environment(s.model, &none), DMB_OK);
    for (int i = 0; i < 3; i++) {
        dmb_body_def body = dmb_body_def_default();
        dmb_joint_def joint = dmb_joint_def_default();
        dmb_id id = {0, 0};
        body.position[0] = 0.1 * i;
        assert_int_equal(dmb_model_add_body(s.model, &body, &id), DMB_OK);
        const dmb_place wheel = dmb_station(id, 0, 0.0);
        joint.kind = DMB_JOINT_REVOLUTE;
        joint.place_b = wheel;
        joint.match = 1;
        assert_int_equal(dmb_model_add_joint(s.model, &joint, NULL), DMB_OK);
        joint.kind = DMB_JOINT_FREE;
        joint.place_a = last;
        joint.stiffness[DMB_RX] = i == 1 ? 0.1 : 0.2;
        if (i > 0) assert_int_equal(dmb_model_add_joint(s.model, &joint, NULL), DMB_OK);
        last = wheel;
    }
    start(&s);
    s.input = dmb_excitation_default();
    s.output = (dmb_output){.quantity = DMB_OUTPUT_VIBRATION};
    s.input.place = s.output.place = last;
    s.input.component = DMB_RX;
    s.output.quantity += DMB_RX;
    dmb_response *response = NULL;
    assert_int_equal(ask(&s, &response), DMB_OK);
    dmb_response_destroy(&response);
    s.options.frequency_low = 0.0;
    expect(&s, DMB_ERR_SINGULAR, "frequency 0 Hz", "body");
    end(&s);
}

/* A drive at rest may turn what a joint to the ground does not let turn; its speed has no response. */
static void drive_that_joints_hold(void **state)
{
    (void)state;
    scene s;
    memset(&s, 0, sizeof s);
    describe_body(&s, DMB_FREE_RX, DMB_JOINT_FIXED, 1);
    start(&s);
    s.input.kind = DMB_EXCITATION_DRIVE;
    s.input.place.part = s.drive;
    expect(&s, DMB_ERR_VALUE, "excitation 0", "joints hold the part");
    end(&s);
}

static void eccentric_masses_that_nothing_feels(void **state)
{
    (void)state;
    scene s;
    dmb_pipe_def pipe = dmb_pipe_def_default();
    memset(&s, 0, sizeof s);
    assert_int_equal(dmb_model_create(NULL, &s.model), DMB_OK);
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    pipe.eccentricity = 1e-3;
    assert_int_equal(dmb_model_add_pipes(s.model, &pipe, 3, &s.string), DMB_OK);
    start(&s);
    s.input = dmb_excitation_default();
    s.output = (dmb_output){.quantity = DMB_OUTPUT_VIBRATION};
    s.output.place = dmb_station(s.string, 2, 1.0);
    s.input.kind = DMB_EXCITATION_ECCENTRICITY;
    expect(&s, DMB_ERR_UNSUPPORTED, "excitation 0", "axial-torsional");
    end(&s);
}

static void fields_out_of_bounds(void **state)
{
    (void)state;
    scene s;
    begin(&s, DMB_FREE_NONE, 0.0);
    const scene good = s;
    const double falling[3] = {1.0, 3.0, 2.0};
#define REFUSED(status, change, field) \
    do {                               \
        const scarce kept = s.memory;  \
        s = good;                      \
        s.memory = kept;               \
        change;                        \
        expect(&s, status, field, ""); \
    } while (0)
    REFUSED(DMB_ERR_VALUE, s.options.frequency_high = 0.5, "frequency_high");
    REFUSED(DMB_ERR_VALUE, s.options.frequency_low = -1.0, "frequency_low");
    REFUSED(DMB_ERR_NOT_FINITE, s.options.frequency_low = (double)NAN, "frequency_low");
    REFUSED(DMB_ERR_VALUE, s.options.points = 1, "points");
    REFUSED(DMB_ERR_VALUE, s.options.points = 0, "points");
    REFUSED(DMB_ERR_VALUE, s.options.logarithmic = 2, "logarithmic");
    REFUSED(DMB_ERR_VALUE, (s.options.logarithmic = 1, s.options.frequency_low = 0.0), "frequency_low");
    REFUSED(DMB_ERR_VALUE, s.options.frequencies = falling, "frequencies");
    REFUSED(DMB_ERR_VALUE, s.options.refinement = 41, "refinement");
    REFUSED(DMB_ERR_VALUE, s.options.structural_damping = -0.1, "structural_damping");
    REFUSED(DMB_ERR_VALUE, s.options.equilibrium_tolerance = 1e-9, "equilibrium_tolerance");
    REFUSED(DMB_ERR_VALUE, s.options.contact = 3, "contact");
    REFUSED(DMB_ERR_VALUE, s.options.friction = -1, "friction");
    REFUSED(DMB_ERR_VALUE, s.options.contact_gap = -1.0, "contact_gap");
    REFUSED(DMB_ERR_STRUCT_SIZE, s.options.struct_size = 3, "struct_size");
    REFUSED(DMB_ERR_VALUE, s.input.kind = 8, "excitation 0: kind");
    REFUSED(DMB_ERR_VALUE, s.input.component = 6, "excitation 0: component");
    REFUSED(DMB_ERR_VALUE, s.input.frame = DMB_FRAME_HOLE, "excitation 0: frame");
    REFUSED(DMB_ERR_NOT_FINITE, s.input.amplitude = (double)INFINITY, "excitation 0: amplitude");
    REFUSED(DMB_ERR_NOT_FINITE, s.input.phase = (double)NAN, "excitation 0: phase");
    REFUSED(DMB_ERR_VALUE, s.input.place.pipe = 10, "excitation 0: place");
    REFUSED(DMB_ERR_ID, s.input.place.part = s.drive, "excitation 0: place");
    REFUSED(DMB_ERR_VALUE, (s.input.kind = DMB_EXCITATION_UNBALANCE, s.input.component = DMB_RY),
            "excitation 0: component");
    REFUSED(DMB_ERR_VALUE, (s.input.kind = DMB_EXCITATION_FRICTION, s.input.component = DMB_Y),
            "excitation 0: component");
    REFUSED(DMB_ERR_ID, s.input.kind = DMB_EXCITATION_LOAD, "excitation 0: place.part names no load");
    REFUSED(DMB_ERR_ID, s.input.kind = DMB_EXCITATION_DRIVE, "excitation 0: place.part names no drive");
    REFUSED(DMB_ERR_ID, s.input.kind = DMB_EXCITATION_BIT_LOAD, "excitation 0: place.part names no bit");
    REFUSED(DMB_ERR_STRUCT_SIZE, s.input.struct_size = 4, "excitation 0: struct_size");
    REFUSED(DMB_ERR_VALUE, s.output.quantity = 99, "output 0: quantity = 99, must be a DMB_OUTPUT_ number");
    REFUSED(DMB_ERR_VALUE, s.output.quantity = -1, "output 0: quantity = -1");
    REFUSED(DMB_ERR_VALUE, s.output.quantity = DMB_OUTPUT_VIBRATION + 6, "output 0: quantity = 466");
    REFUSED(DMB_ERR_VALUE, s.output.place.fraction = 1.5, "output 0, vibration_x of string 0 pipe 9 at 1.5: ");
    REFUSED(DMB_ERR_ID, s.output.place.part = s.load, "output 0, vibration_x of load 0 pipe 9 at 1: ");
    REFUSED(DMB_ERR_ID, (s.output.quantity = DMB_OUTPUT_SECTION_STRAIN, s.output.place.part = s.drive),
            "output 0, section_strain_x of no part pipe 9 at 1: ");
    REFUSED(DMB_ERR_VALUE, (s.output.quantity = DMB_OUTPUT_CONTACT_NORMAL_FORCE, s.output.place.pipe = 7),
            "output 0, contact_normal_force of contact point 7: place.pipe");
    REFUSED(DMB_ERR_UNSUPPORTED, (s.output.quantity = DMB_OUTPUT_CONTACT_GAP, s.output.place.pipe = 0),
            "output 0, contact_gap of contact point 0: a magnitude");
    REFUSED(DMB_ERR_UNSUPPORTED,
            (s.output.quantity = DMB_OUTPUT_CONTACT_FRICTION_AXIAL, s.options.contact = DMB_CONTACT_OPEN),
            ": contact is left out");
    REFUSED(DMB_ERR_ID, s.output.quantity = DMB_OUTPUT_BIT_ROCK_WEIGHT, "place.part names no bit");
    REFUSED(DMB_ERR_UNSUPPORTED, s.output.quantity = DMB_OUTPUT_ENERGY_KINETIC, "energy_kinetic: a magnitude");
#define OUTPUT(number, of) (s.output.quantity = (number), s.output.place = dmb_station((of), 0, 0.0))
    REFUSED(DMB_ERR_ID, OUTPUT(DMB_OUTPUT_HOOK_LOAD, s.load), "place.part names no string");
    REFUSED(DMB_ERR_ID, OUTPUT(DMB_OUTPUT_WEIGHT_ON_BIT, s.load), "place.part names no string");
    REFUSED(DMB_ERR_UNSUPPORTED, OUTPUT(DMB_OUTPUT_WEIGHT_ON_BIT, s.string), "the string must have one bit");
    REFUSED(DMB_ERR_UNSUPPORTED, OUTPUT(DMB_OUTPUT_TORQUE_ON_BIT, s.string), "the string must have one bit");
    REFUSED(DMB_ERR_UNSUPPORTED, OUTPUT(DMB_OUTPUT_STRETCH, s.string), "has no linear answer");
    REFUSED(DMB_ERR_ID, OUTPUT(DMB_OUTPUT_BIT_WEIGHT, s.string), "place.part names no bit");
    REFUSED(DMB_ERR_ID, OUTPUT(DMB_OUTPUT_BIT_TORQUE, s.string), "place.part names no bit");
    REFUSED(DMB_ERR_ID, OUTPUT(DMB_OUTPUT_DRIVE_FORCE, s.string), "place.part names no drive");
    REFUSED(DMB_ERR_ID, OUTPUT(DMB_OUTPUT_JOINT_POSITION, s.string), "place.part names no joint");
    REFUSED(DMB_ERR_ID, OUTPUT(DMB_OUTPUT_MULTIPLIER, s.string), "with that row");
    REFUSED(DMB_ERR_ID, OUTPUT(DMB_OUTPUT_REACTION, s.load), "place.part names no string or body");
#undef OUTPUT
#undef REFUSED
    end(&s);
}

/* A drive of the rig end has no joint whose coordinate its speed is. */
static void speed_of_a_drive_without_a_joint(void **state)
{
    (void)state;
    scene s;
    begin(&s, DMB_FREE_RX, 0.0);
    s.output.place = dmb_station(s.drive, 0, 0.0);
    s.output.quantity = DMB_OUTPUT_DRIVE_SPEED;
    expect(&s, DMB_ERR_UNSUPPORTED, "output 0, drive_speed of drive 0: ", "at the rig end instead");
    s.output.quantity = DMB_OUTPUT_DRIVE_POSITION;
    expect(&s, DMB_ERR_UNSUPPORTED, "output 0, drive_position of drive 0: ", "at the rig end instead");
    s.output.quantity = DMB_OUTPUT_DRIVE_POWER;
    expect(&s, DMB_ERR_UNSUPPORTED, "output 0, drive_power of drive 0: ", "has no linear answer");
    end(&s);
}

/* A profile is of pipes, for queries and responses alike. */
static void profile_of_a_body(void **state)
{
    (void)state;
    static const int32_t asked[] = {DMB_PROFILE_X, DMB_PROFILE_DISPLACEMENT_Z, DMB_PROFILE_ROTATION,
                                    DMB_PROFILE_VELOCITY_AXIAL};
    scene s;
    double value;
    memset(&s, 0, sizeof s);
    describe_body(&s, DMB_FREE_ALL, DMB_JOINT_REVOLUTE, 0);
    start(&s);
    for (size_t i = 0; i < sizeof asked / sizeof asked[0]; i++) {
        s.output.quantity = DMB_OUTPUT_PROFILE + asked[i];
        assert_int_equal(dmb_query_output(s.sim, &s.output, &value), DMB_ERR_ID);
        expect(&s, DMB_ERR_ID, "output 0, profile_", "must be on a pipe of a string");
    }
    end(&s);
}

/* A body that slides along and turns about the x axis as it was made to: its axes turn in those of the world. */
static void outputs_of_what_moves(void **state)
{
    (void)state;
    scene s;
    dmb_environment_def none = dmb_environment_def_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_response *response = NULL;
    dmb_id id = {0, 0};
    memset(&s, 0, sizeof s);
    none.gravity[2] = 0.0;
    body.velocity[DMB_X] = 0.3;
    body.velocity[DMB_RX] = 2.0;
    assert_int_equal(dmb_model_create(NULL, &s.model), DMB_OK);
    assert_int_equal(dmb_model_set_environment(s.model, &none), DMB_OK);
    assert_int_equal(dmb_model_add_body(s.model, &body, &id), DMB_OK);
    start(&s);
    s.input = dmb_excitation_default();
    s.output = (dmb_output){.quantity = DMB_OUTPUT_VIBRATION};
    s.input.place = s.output.place = dmb_station(id, 0, 0.0);
    static const int32_t refused[5] = {DMB_OUTPUT_DISPLACEMENT_X, DMB_OUTPUT_VELOCITY_Z, DMB_OUTPUT_WORLD_ACCELERATION,
                                       DMB_OUTPUT_BODY_VELOCITY + DMB_Y, DMB_OUTPUT_BODY_ACCELERATION + DMB_RZ};
    static const int32_t answered[4] = {DMB_OUTPUT_ROTATION, DMB_OUTPUT_SPIN, DMB_OUTPUT_BODY_VELOCITY + DMB_X,
                                        DMB_OUTPUT_BODY_ACCELERATION + DMB_RX};
    for (int i = 0; i < 5; i++) {
        s.output.quantity = refused[i];
        expect(&s, DMB_ERR_UNSUPPORTED, "the place moves in the state", "vibration_velocity_");
    }
    for (int i = 0; i < 4; i++) {
        s.output.quantity = answered[i];
        assert_int_equal(ask(&s, &response), DMB_OK);
        dmb_response_destroy(&response);
    }
    end(&s);
}

/* A controller that turns a wheel against a spring until it gives all that it may: it answers to nothing then, and the
 * wheel to a torque as to the spring alone. */
static void at_a_limit(double speed, double gain)
{
    scene s;
    dmb_environment_def none = dmb_environment_def_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_joint_def joint = dmb_joint_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_segment target = dmb_segment_default();
    dmb_response *response = NULL;
    double value[2] = {0.0, 0.0};
    memset(&s, 0, sizeof s);
    none.gravity[2] = 0.0;
    joint.kind = DMB_JOINT_REVOLUTE;
    joint.stiffness[DMB_RX] = 400.0;
    drive.kind = DMB_DRIVE_CONTROL;
    drive.component = DMB_RX;
    drive.gain = gain;
    drive.limit_high = 8.0;
    drive.limit_low = -8.0;
    target.h0 = speed;
    assert_int_equal(dmb_model_create(NULL, &s.model), DMB_OK);
    assert_int_equal(dmb_model_set_environment(s.model, &none), DMB_OK);
    dmb_id id = {0, 0};
    assert_int_equal(dmb_model_add_body(s.model, &body, &id), DMB_OK);
    joint.place_b = dmb_station(id, 0, 0.0);
    assert_int_equal(dmb_model_add_joint(s.model, &joint, &drive.part), DMB_OK);
    assert_int_equal(dmb_model_add_time_function(s.model, &target, 1, &drive.time_function), DMB_OK);
    assert_int_equal(dmb_model_add_drive(s.model, &drive, &s.drive), DMB_OK);
    start(&s);
    assert_int_equal(dmb_analysis_static(s.sim, NULL, NULL), DMB_OK);
    s.options.points = 1;
    s.options.frequency_low = s.options.frequency_high = 0.0;
    s.input = dmb_excitation_default();
    s.output = (dmb_output){.quantity = DMB_OUTPUT_VIBRATION};
    s.input.place = s.output.place = joint.place_b;
    s.input.component = DMB_RX;
    s.output.quantity += DMB_RX;
    assert_int_equal(ask(&s, &response), DMB_OK);
    assert_int_equal(dmb_response_transfer(response, 0, 0, value), DMB_OK);
    dmb_response_destroy(&response);
    assert_true(fabs(value[0] * 400.0 - 1.0) < 1e-12 && value[1] == 0.0);
    s.output.quantity = DMB_OUTPUT_DRIVE_FORCE;
    s.output.place.part = s.drive;
    assert_int_equal(ask(&s, &response), DMB_OK);
    assert_int_equal(dmb_response_transfer(response, 0, 0, value), DMB_OK);
    dmb_response_destroy(&response);
    assert_true(value[0] == 0.0 && value[1] == 0.0);
    s.input.kind = DMB_EXCITATION_DRIVE;
    s.input.place.part = s.drive;
    expect(&s, DMB_ERR_VALUE, "excitation 0", gain > 0.0 ? "the drive is at its limit" : "the drive has no gain");
    end(&s);
}

static void controller_at_its_limit(void **state)
{
    (void)state;
    at_a_limit(1.0, 60.0);
    at_a_limit(-1.0, 60.0);
    at_a_limit(1.0, 0.0); /* it has no gain, and answers to nothing either */
}

/* Normal forces of a wall with bristles are outputs, their friction is not. */
static void friction_of_bristles(void **state)
{
    (void)state;
    scene s;
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_response *response = NULL;
    memset(&s, 0, sizeof s);
    wall.friction_law = DMB_FRICTION_BRISTLE;
    assert_int_equal(dmb_model_create(NULL, &s.model), DMB_OK);
    assert_int_equal(dmb_model_add_wall(s.model, &wall, NULL), DMB_OK);
    dmb_string_def string = dmb_string_def_default();
    assert_int_equal(dmb_model_add_string(s.model, &string, &s.string), DMB_OK);
    assert_int_equal(dmb_model_add_pipes(s.model, &pipe, 3, NULL), DMB_OK);
    start(&s);
    assert_int_equal(dmb_analysis_static(s.sim, NULL, NULL), DMB_NOTE_INCOMPLETE); /* nothing holds it along the hole */
    s.input = dmb_excitation_default();
    s.input.place = dmb_station(s.string, 2, 1.0);
    s.input.component = DMB_Z;
    s.output = (dmb_output){.quantity = DMB_OUTPUT_VIBRATION};
    s.output.place.pipe = 2;
    s.output.quantity = DMB_OUTPUT_CONTACT_FRICTION_AXIAL;
    expect(&s, DMB_ERR_UNSUPPORTED, "output 0", "friction of bristles is not an output");
    s.output.quantity = DMB_OUTPUT_CONTACT_NORMAL_FORCE;
    assert_int_equal(ask(&s, &response), DMB_OK);
    dmb_response_destroy(&response);
    end(&s);
}

/* Items of an array are as far apart as the first one says, and all of that size. */
static void items_of_another_size(void **state)
{
    (void)state;
    scene s;
    begin(&s, DMB_FREE_NONE, 0.0);
    dmb_excitation inputs[2] = {s.input, s.input};
    dmb_output outputs[2] = {s.output, s.output};
    dmb_order orders[2] = {dmb_order_default(), dmb_order_default()};
    dmb_speed_band band = dmb_speed_band_default();
    dmb_response *response = NULL;
    double limits[2] = {1.0, 1.0}, amplitudes[2][4][2] = {{{7.0}}};
    const double falling[4] = {1.0, 3.0, 2.0, 4.0};
    uint32_t room = 1;
    uint64_t before, after;
    assert_int_equal(dmb_sim_hash(s.sim, &before), DMB_OK);
    inputs[1].struct_size -= 8;
    assert_int_equal(dmb_analysis_response(s.sim, NULL, inputs, 2, outputs, 2, &response), DMB_ERR_STRUCT_SIZE);
    assert_non_null(
        strstr(dmb_sim_message(s.sim), "excitation 1: struct_size is not one of this library, or not that"));
    inputs[1] = inputs[0];
    s.options.frequencies = falling;
    s.options.points = 4;
    assert_int_equal(dmb_analysis_response(s.sim, &s.options, inputs, 2, outputs, 2, &response), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_sim_message(s.sim), "frequencies = 2"));
    outputs[1].quantity = -1;
    assert_int_equal(dmb_analysis_response(s.sim, NULL, inputs, 2, outputs, 2, &response), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_sim_message(s.sim), "output 1: quantity = -1, must be"));
    outputs[1] = outputs[0];
    assert_null(response);
    orders[1].struct_size -= 8;
    assert_int_equal(dmb_analysis_speeds(s.sim, NULL, orders, 2, outputs, limits, 2, &band, &room, NULL),
                     DMB_ERR_STRUCT_SIZE);
    assert_non_null(strstr(dmb_sim_message(s.sim), "order 1"));
    orders[1] = orders[0];
    limits[0] = limits[1] = -1.0;
    assert_int_equal(dmb_analysis_speeds(s.sim, NULL, orders, 2, outputs, limits, 2, &band, &room, NULL),
                     DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_sim_message(s.sim), "limits = -1"));
    assert_int_equal(dmb_sim_hash(s.sim, &after), DMB_OK);
    assert_true(before == after && room == 1 && amplitudes[0][0][0] == 7.0);
    end(&s);
}

/* A stepped sine that is refused has not begun. */
static void stepped_sine_out_of_bounds(void **state)
{
    (void)state;
    scene s;
    begin(&s, DMB_FREE_NONE, 0.0);
    const dmb_stepped_sine_options good = dmb_stepped_sine_options_default();
    dmb_stepped_sine_report report = dmb_stepped_sine_report_default();
    double amplitudes[2 * 17] = {7.0};
    uint64_t before, after;
    assert_int_equal(dmb_sim_hash(s.sim, &before), DMB_OK);
#define REFUSED(status, frequency, change, field)                                                                \
    do {                                                                                                         \
        dmb_stepped_sine_options options = good;                                                                 \
        dmb_output output = s.output;                                                                            \
        change;                                                                                                  \
        assert_int_equal(dmb_analysis_stepped_sine(s.sim, frequency, &options, &output, 1, amplitudes, &report), \
                         status);                                                                                \
        if (strstr(dmb_sim_message(s.sim), field) == NULL) fail_msg("%s", dmb_sim_message(s.sim));               \
        assert_int_equal(dmb_sim_hash(s.sim, &after), DMB_OK);                                                   \
        assert_true(before == after && amplitudes[0] == 7.0);                                                    \
    } while (0)
    REFUSED(DMB_ERR_VALUE, 0.0, (void)options, "frequency = 0");
    REFUSED(DMB_ERR_NOT_FINITE, (double)NAN, (void)options, "frequency");
    REFUSED(DMB_ERR_VALUE, 5.0, options.steps_per_period = 15, "steps_per_period = 15");
    REFUSED(DMB_ERR_VALUE, 5.0, options.periods = 0, "periods = 0");
    REFUSED(DMB_ERR_VALUE, 5.0, options.windows = 2, "windows = 2");
    REFUSED(DMB_ERR_VALUE, 5.0, options.harmonics = 17, "harmonics = 17, must be 1 .. 16");
    REFUSED(DMB_ERR_VALUE, 5.0, (options.steps_per_period = 16, options.harmonics = 3), "<= steps_per_period/8");
    REFUSED(DMB_ERR_VALUE, 5.0, (options.steps_per_period = 0, options.harmonics = 3), "steps_per_period = 0");
    REFUSED(DMB_ERR_VALUE, 5.0, options.tolerance = 0.0, "tolerance = 0");
    REFUSED(DMB_ERR_VALUE, 5.0, options.floor = 0.0, "floor = 0");
    REFUSED(DMB_ERR_STRUCT_SIZE, 5.0, options.struct_size = 5, "struct_size");
    REFUSED(DMB_ERR_VALUE, 5.0, output.place.pipe = 10, "output 0, vibration_x of string 0 pipe 10 at 1: ");
    REFUSED(DMB_ERR_ID, 5.0, output.place.part = s.load, "output 0, vibration_x of load 0 pipe 9 at 1: ");
#undef REFUSED
    report.struct_size = 3;
    assert_int_equal(dmb_analysis_stepped_sine(s.sim, 5.0, NULL, &s.output, 1, amplitudes, &report),
                     DMB_ERR_STRUCT_SIZE);
    assert_int_equal(dmb_analysis_stepped_sine(s.sim, 5.0, NULL, &s.output, 0, amplitudes, NULL), DMB_ERR_VALUE);
    dmb_sim *none = (dmb_sim *)(void *)s.model;
    assert_int_equal(dmb_analysis_stepped_sine(none, 5.0, NULL, &s.output, 1, amplitudes, NULL), DMB_ERR_HANDLE);
    assert_true(amplitudes[0] == 7.0);
    end(&s);
}

static void counts_and_pointers(void **state)
{
    (void)state;
    scene s;
    dmb_response *response = NULL;
    uint32_t shape[3];
    double number;
    begin(&s, DMB_FREE_NONE, 0.0);
    assert_int_equal(dmb_analysis_response(s.sim, NULL, &s.input, 0, &s.output, 1, &response), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_sim_message(s.sim), "excitation_count"));
    assert_int_equal(dmb_analysis_response(s.sim, NULL, &s.input, 1, &s.output, 1025, &response), DMB_ERR_VALUE);
    assert_int_equal(dmb_analysis_response(NULL, NULL, &s.input, 1, &s.output, 1, &response), DMB_ERR_NULL);
    assert_int_equal(dmb_analysis_response(s.sim, NULL, NULL, 1, &s.output, 1, &response), DMB_ERR_NULL);
    assert_int_equal(dmb_analysis_response(s.sim, NULL, &s.input, 1, NULL, 1, &response), DMB_ERR_NULL);
    assert_int_equal(dmb_analysis_response(s.sim, NULL, &s.input, 1, &s.output, 1, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_analysis_response((dmb_sim *)(void *)s.model, NULL, &s.input, 1, &s.output, 1, &response),
                     DMB_ERR_HANDLE);
    assert_int_equal(ask(&s, &response), DMB_OK);
    assert_int_equal(dmb_response_dimensions(response, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_response_dimensions(NULL, shape), DMB_ERR_NULL);
    assert_int_equal(dmb_response_dimensions((const dmb_response *)(const void *)s.sim, shape), DMB_ERR_HANDLE);
    assert_int_equal(dmb_response_dimensions(response, shape), DMB_OK);
    assert_true(shape[0] == 3 && shape[1] == 1 && shape[2] == 1);
    assert_int_equal(dmb_response_frequencies(response, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_response_transfer(response, 1, 0, &number), DMB_ERR_VALUE);
    assert_int_equal(dmb_response_transfer(response, 0, 1, &number), DMB_ERR_VALUE);
    assert_int_equal(dmb_response_write_csv(response, NULL, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_response_write_csv(response, NULL, "/nowhere at all/response.csv"), DMB_ERR_IO);
    dmb_response_destroy(&response);
    dmb_response_destroy(&response);
    dmb_response_destroy(NULL);
    end(&s);
}

/* Every allocation fails once; the call says so, and nothing is left behind. */
static void memory_runs_out(void **state)
{
    (void)state;
    scene s;
    dmb_response *response = NULL;
    begin(&s, DMB_FREE_NONE, 0.0);
    s.options.points = 20;
    s.options.refinement = 3;
    const size_t before = s.memory.calls;
    assert_int_equal(ask(&s, &response), DMB_OK);
    dmb_response_destroy(&response);
    const size_t calls = s.memory.calls - before;
    assert_true(calls > 5);
    for (size_t k = 1; k <= calls; k++) {
        s.memory.refused = s.memory.calls + k;
        expect(&s, DMB_ERR_NO_MEMORY, "no memory", "");
    }
    end(&s);
}

/* ---- Speeds to avoid --------------------------------------------------------------------------------------------- */

/* The state stays as it is, and on error so does what would be written. */
static int32_t ask_speeds(scene *s, const dmb_speeds_options *options, const dmb_order *order, double limit,
                          dmb_speed_band *band)
{
    uint32_t room = 1;
    uint64_t before, after;
    double severity[200];
    const dmb_speed_band kept = *band;
    memset(severity, 0x5A, sizeof severity);
    const double mark = severity[0];
    assert_int_equal(dmb_sim_hash(s->sim, &before), DMB_OK);
    const int32_t status = dmb_analysis_speeds(s->sim, options, order, 1, &s->output, &limit, 1, band, &room, severity);
    assert_int_equal(dmb_sim_hash(s->sim, &after), DMB_OK);
    assert_true(before == after);
    if (status >= 0) return status;
    assert_true(room == 1 && severity[0] == mark && severity[199] == mark);
    assert_memory_equal(band, &kept, sizeof kept);
    return status;
}

static void speeds_that_are_refused(void **state)
{
    (void)state;
    scene s;
    begin(&s, DMB_FREE_NONE, 0.0);
    const dmb_speeds_options good = dmb_speeds_options_default();
    dmb_speeds_options options = good;
    dmb_order order = dmb_order_default();
    dmb_speed_band band = dmb_speed_band_default();
    double limit = 1.0;
    const size_t live = s.memory.live;
#define REFUSED(status, change, field)                                                             \
    do {                                                                                           \
        options = good;                                                                            \
        order = dmb_order_default();                                                               \
        limit = 1.0;                                                                               \
        change;                                                                                    \
        assert_int_equal(ask_speeds(&s, &options, &order, limit, &band), status);                  \
        if (strstr(dmb_sim_message(s.sim), field) == NULL) fail_msg("%s", dmb_sim_message(s.sim)); \
        assert_int_equal(s.memory.live, live);                                                     \
    } while (0)
    REFUSED(DMB_ERR_VALUE, options.points = 1, "points");
    REFUSED(DMB_ERR_VALUE, options.speed_low = 0.0, "speed_low");
    REFUSED(DMB_ERR_VALUE, options.speed_high = 0.5, "speed_high");
    REFUSED(DMB_ERR_NOT_FINITE, options.speed_high = (double)INFINITY, "speed_high");
    REFUSED(DMB_ERR_VALUE, options.threshold = 0.0, "threshold");
    REFUSED(DMB_ERR_VALUE, options.margin = 0.6, "margin");
    REFUSED(DMB_ERR_VALUE, options.refinement = 99, "refinement");
    REFUSED(DMB_ERR_STRUCT_SIZE, options.struct_size = 7, "struct_size");
    REFUSED(DMB_ERR_VALUE, order.order = 0.0, "order 0: order");
    REFUSED(DMB_ERR_STRUCT_SIZE, order.struct_size = 9, "order 0: struct_size");
    REFUSED(DMB_ERR_VALUE, order.excitation.kind = -1, "excitation 0: kind");
    REFUSED(DMB_ERR_VALUE, limit = 0.0, "limits");
    dmb_speeds_report report = dmb_speeds_report_default();
    report.struct_size = 4;
    REFUSED(DMB_ERR_STRUCT_SIZE, options.report = &report, "report's struct_size");
#undef REFUSED
    options = good;
    limit = 1.0;
    const size_t before = s.memory.calls;
    assert_int_equal(ask_speeds(&s, &options, &order, limit, &band), DMB_NOTE_INCOMPLETE); /* no eccentric masses */
    const size_t calls = s.memory.calls - before;
    for (size_t k = 1; k <= calls; k++) {
        s.memory.refused = s.memory.calls + k;
        assert_int_equal(ask_speeds(&s, &options, &order, limit, &band), DMB_ERR_NO_MEMORY);
        assert_int_equal(s.memory.live, live);
    }
    assert_int_equal(ask_speeds(&s, &options, NULL, limit, &band), DMB_ERR_NULL);
    band.struct_size = 1;
    assert_int_equal(ask_speeds(&s, &options, &order, limit, &band), DMB_ERR_STRUCT_SIZE);
    end(&s);
}

static void speeds_of_a_state_out_of_balance(void **state)
{
    (void)state;
    scene s;
    begin(&s, DMB_FREE_NONE, -9.81);
    const dmb_speeds_options options = dmb_speeds_options_default();
    const dmb_order order = dmb_order_default();
    dmb_speed_band band = dmb_speed_band_default();
    assert_int_equal(ask_speeds(&s, &options, &order, 1.0, &band), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_sim_message(s.sim), "not an equilibrium"));
    end(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frequency_zero_with_a_free_part),
        cmocka_unit_test(motion_drive_at_frequency_zero),
        cmocka_unit_test(state_out_of_balance),
        cmocka_unit_test(frequency_zero_with_a_free_joint),
        cmocka_unit_test(frequency_zero_with_free_wheels),
        cmocka_unit_test(drive_that_joints_hold),
        cmocka_unit_test(eccentric_masses_that_nothing_feels),
        cmocka_unit_test(fields_out_of_bounds),
        cmocka_unit_test(speed_of_a_drive_without_a_joint),
        cmocka_unit_test(profile_of_a_body),
        cmocka_unit_test(outputs_of_what_moves),
        cmocka_unit_test(controller_at_its_limit),
        cmocka_unit_test(friction_of_bristles),
        cmocka_unit_test(items_of_another_size),
        cmocka_unit_test(stepped_sine_out_of_bounds),
        cmocka_unit_test(counts_and_pointers),
        cmocka_unit_test(memory_runs_out),
        cmocka_unit_test(speeds_that_are_refused),
        cmocka_unit_test(speeds_of_a_state_out_of_balance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
