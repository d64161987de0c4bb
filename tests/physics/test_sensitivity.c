/* Derivatives along runs against differences of whole runs (central, extrapolated), and the spring by its formula.
 * Equations: eq:sensitivity.step. */
#include <stdio.h>
#include <string.h>

#include "rig.h"

enum { OUTPUTS_MAX = 8 };

/* A scene and one of its parameters. */
typedef struct scene_case {
    const char *name;
    void (*describe)(rig *s);
    double *parameter;
    uint32_t (*outputs)(const rig *s, dmb_output *out);
    double step;       /* of the sims on both sides of it */
    double difference; /* of the whole runs that it is held against */
    double time_step;
    double bound; /* [-] of the error over the largest derivative of its output along the run */
    uint32_t steps;
    int settled; /* 1: begins with dmb_analysis_static */
} scene_case;

static int32_t one_sided; /* 1: derivatives of the sims in between and above */

static dmb_sim_options sharp(void)
{
    dmb_sim_options options = dmb_sim_options_default();
    options.newton_tolerance = 1e-13;
    options.max_iterations = 40;
    options.tolerance_translation = 1e-9;
    return options;
}

/* With the parameter so much beside its value. */
static rig begin(const scene_case *c, double beside)
{
    const dmb_sim_options options = sharp();
    const double value = *c->parameter;
    rig s;
    *c->parameter = value + beside;
    c->describe(&s);
    *c->parameter = value;
    (void)rig_start(&s, &options);
    if (c->settled) {
        dmb_static_options statics = dmb_static_options_default();
        statics.tolerance = 1e-12;
        (void)find_equilibrium(&s, &statics);
    }
    return s;
}

static dmb_id last_string, last_body, last_drive, last_bit, last_joint;

static dmb_output output_of(dmb_place place, int32_t quantity)
{
    const dmb_output output = {place, quantity, 0};
    return output;
}

static void run_to_end(const scene_case *c, double beside, double *out)
{
    dmb_output outputs[OUTPUTS_MAX];
    rig s = begin(c, beside);
    const uint32_t count = c->outputs(&s, outputs);
    double table[OUTPUTS_MAX + 1];
    for (uint32_t i = 0; i < c->steps; i++) must(&s, dmb_sim_step(s.sim, c->time_step, NULL));
    dmb_recorder recorder = dmb_recorder_default();
    recorder.outputs = outputs;
    recorder.output_count = count;
    recorder.table = table;
    recorder.capacity = 1;
    must(&s, dmb_recorder_take(&recorder, s.sim));
    memcpy(out, table + 1, count * sizeof *out);
    rig_close(&s);
}

/* (4 D(d) - D(2 d))/3 */
static void differences(const scene_case *c, double *out)
{
    double low[OUTPUTS_MAX], high[OUTPUTS_MAX], far_low[OUTPUTS_MAX], far_high[OUTPUTS_MAX];
    const double d = c->difference;
    memset(low, 0, sizeof low), memset(high, 0, sizeof high);
    memset(far_low, 0, sizeof far_low), memset(far_high, 0, sizeof far_high);
    run_to_end(c, -d, low);
    run_to_end(c, d, high);
    run_to_end(c, -2.0 * d, far_low);
    run_to_end(c, 2.0 * d, far_high);
    for (int i = 0; i < OUTPUTS_MAX; i++)
        out[i] = (4.0 * (high[i] - low[i]) / (2.0 * d) - (far_high[i] - far_low[i]) / (4.0 * d)) / 3.0;
}

static void check_case(const scene_case *c)
{
    dmb_output outputs[OUTPUTS_MAX];
    double derivatives[OUTPUTS_MAX] = {0.0}, reference[OUTPUTS_MAX], largest[OUTPUTS_MAX] = {0.0};
    rig low = begin(c, -c->step), high = begin(c, c->step);
    rig s = begin(c, 0.0); /* last, for the ids */
    dmb_sensitivity *sensitivity;
    dmb_parameter parameter = dmb_parameter_default();
    const uint32_t count = c->outputs(&s, outputs);
    parameter.step = c->step;
    parameter.one_sided = one_sided;
    parameter.low = low.sim;
    parameter.high = high.sim;
    must(&s, dmb_sensitivity_create(s.sim, &parameter, 1, &sensitivity));
    rig_close(&low);
    rig_close(&high);
    for (uint32_t i = 0; i < c->steps; i++) {
        must(&s, dmb_sensitivity_step(sensitivity, c->time_step, NULL));
        must(&s, dmb_sensitivity_outputs(sensitivity, outputs, count, NULL, derivatives));
        for (uint32_t k = 0; k < count; k++) largest[k] = fmax(largest[k], fabs(derivatives[k]));
    }
    differences(c, reference);
    double worst = 0.0;
    uint64_t kinks = 0;
    must(&s, dmb_sensitivity_kinks(sensitivity, 0, &kinks));
    for (uint32_t k = 0; k < count; k++) {
        const double error = fabs(derivatives[k] - reference[k]) / largest[k];
        printf("%s, output %d: derivative %.12g, by runs %.12g, error %.1e, kinks %llu\n", c->name, outputs[k].quantity,
               derivatives[k], reference[k], error, (unsigned long long)kinks);
        worst = fmax(worst, error);
    }
    if (worst > c->bound) print_message("%s: worst error %.2e, bound %.1e\n", c->name, worst, c->bound);
    assert_true(worst <= c->bound);
    dmb_sensitivity_destroy(&sensitivity);
    rig_close(&s);
}

/* ---- Scenes ------------------------------------------------------------------------------------------------------ */

/* Their parameters. */
static double mu = 0.3, stiffness = 1e6, diameter = 0.073, damping = 5.0, young = 210e9, energy = 3e7, speed = 6.0;
static double joint_spring = 8.0, rotor_speed = 200.0;
static double lag = 0.0, back_drag = 0.0, direction = 1.0; /* of an actuator; 0: none */
static int32_t friction_law = DMB_FRICTION_STRIBECK, pipe_kind = DMB_PIPE_FLEXIBLE, rock_law = DMB_ROCK_RATE;

static void drive_string(rig *s)
{
    dmb_drive_def turn = dmb_drive_def_default(), push = dmb_drive_def_default();
    turn.kind = DMB_DRIVE_CONTROL;
    turn.component = DMB_RX;
    dmb_segment ramp = dmb_segment_default();
    ramp.kind = DMB_SEGMENT_STEP5;
    ramp.x1 = 0.1;
    ramp.h1 = direction * speed;
    turn.lag = lag;
    if (lag > 0.0) {
        turn.force_rate = 2e5;
        turn.drag = 3.0;
        turn.back_drag = back_drag;
    }
    turn.time_function = add_time_function(s, &ramp, 1);
    turn.gain = 400.0;
    turn.integral_gain = 200.0;
    turn.part = last_string;
    last_drive = add_drive(s, &turn);
    push.kind = DMB_DRIVE_CONTROL;
    push.component = DMB_X;
    push.time_function = add_constant(s, 0.01);
    push.gain = 2e5;
    push.integral_gain = 1e5;
    push.part = last_string;
    (void)add_drive(s, &push);
}

static void describe_string(rig *s)
{
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_wall_def wall = s1_hole();
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def string = dmb_string_def_default();
    rig_open(s, 0.0, 0.0, -9.81);
    environment.lateral_damping = damping;
    must_model(s, dmb_model_set_environment(s->model, &environment));
    wall.stiffness = stiffness;
    wall.normal_law = DMB_NORMAL_HUNT_CROSSLEY; /* EXACT lets go within the differences of whole runs */
    wall.mu_dynamic = mu;
    wall.mu_static = 1.2 * mu;
    wall.friction_law = friction_law;
    wall.smoothing_speed = 0.05;
    wall.stribeck_speed = 0.1;
    (void)add_wall(s, &wall);
    pipe.outer_diameter = diameter;
    pipe.young_modulus = young;
    pipe.kind = pipe_kind;
    last_string = add_string(s, &string);
    (void)dmb_model_add_pipes(s->model, &pipe, 6, NULL);
    drive_string(s);
}

static void describe_drilling(rig *s)
{
    dmb_bit_def bit = dmb_bit_def_default();
    describe_string(s);
    bit.rock_law = rock_law;
    bit.intrinsic_energy = energy;
    bit.string = last_string;
    bit.diameter = 0.0;
    must_model(s, dmb_model_add_bit(s->model, &bit, &last_bit));
}

static void describe_bristles(rig *s)
{
    friction_law = DMB_FRICTION_BRISTLE;
    describe_string(s);
    friction_law = DMB_FRICTION_STRIBECK;
}

static void describe_bars(rig *s)
{
    pipe_kind = DMB_PIPE_AXIAL_TORSIONAL;
    describe_string(s);
    pipe_kind = DMB_PIPE_FLEXIBLE;
}

static void describe_regenerative(rig *s)
{
    rock_law = DMB_ROCK_REGENERATIVE;
    describe_drilling(s);
    rock_law = DMB_ROCK_RATE;
}

static uint32_t string_outputs(const rig *s, dmb_output *out)
{
    (void)s;
    out[0] = output_of(dmb_station(last_string, 5, 1.0), DMB_OUTPUT_ROTATION);
    out[1] = output_of(dmb_station(last_string, 5, 1.0), DMB_OUTPUT_SPIN);
    out[2] = output_of(dmb_station(last_string, 2, 0.5), DMB_OUTPUT_TORQUE);
    out[3] = output_of(dmb_station(last_drive, 0, 0.0), DMB_OUTPUT_DRIVE_FORCE);
    out[4] = output_of(dmb_station(last_string, 2, 0.5), DMB_OUTPUT_AXIAL_FORCE);
    out[5] = output_of(dmb_station(last_string, 5, 1.0), DMB_OUTPUT_POSITION_X);
    return 6;
}

static uint32_t bending_outputs(const rig *s, dmb_output *out)
{
    (void)string_outputs(s, out);
    out[6] = output_of(dmb_station(last_string, 3, 0.0), DMB_OUTPUT_POSITION_Z);
    out[7] = output_of(dmb_station(last_string, 3, 0.0), DMB_OUTPUT_NORMAL_FORCE);
    return 8;
}

static uint32_t drilling_outputs(const rig *s, dmb_output *out)
{
    (void)string_outputs(s, out);
    out[6] = output_of(dmb_station(last_bit, 0, 0.0), DMB_OUTPUT_BIT_WEIGHT);
    return 7;
}

/* A heavy ball that falls onto the wall and bounces off. */
static void describe_ball(rig *s)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_body_def body = dmb_body_def_default();
    rig_open(s, 0.0, 0.0, -9.81);
    wall.diameter = 0.2;
    wall.stiffness = stiffness;
    (void)add_wall(s, &wall);
    body.mass = 3.0;
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.01;
    body.contact_diameter = 0.1;
    body.position[2] = -0.04;
    body.velocity[3] = 20.0;
    last_body = add_body(s, &body);
}

static uint32_t ball_outputs(const rig *s, dmb_output *out)
{
    (void)s;
    out[0] = output_of(dmb_station(last_body, 0, 0.0), DMB_OUTPUT_POSITION_Z);
    out[1] = output_of(dmb_station(last_body, 0, 0.0), DMB_OUTPUT_VELOCITY_Z);
    out[2] = output_of(dmb_station(last_body, 0, 0.0), DMB_OUTPUT_SPIN);
    return 3;
}

/* Two rods on revolutes, the parameter being the stiffness of the second's spring. */
static void describe_rods(rig *s)
{
    dmb_body_def body = dmb_body_def_default();
    rig_open(s, 0.0, 0.0, -9.81);
    body.mass = 2.0;
    body.centre[0] = 0.5;
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.1;
    const dmb_id first = add_body(s, &body);
    body.position[0] = 1.0;
    body.rotation[1] = 0.3;
    last_body = add_body(s, &body);
    const dmb_place ground = {{0, 0}, 0, 0, 0.0};
    dmb_joint_def joint = joint_between(DMB_JOINT_REVOLUTE, ground, dmb_station(first, 0, 0.0));
    joint.axis_a[0] = joint.axis_b[0] = 0.0;
    joint.axis_a[1] = joint.axis_b[1] = 1.0;
    (void)add_joint(s, &joint);
    joint = joint_between(DMB_JOINT_REVOLUTE, dmb_station(first, 0, 0.0), dmb_station(last_body, 0, 0.0));
    joint.axis_a[0] = joint.axis_b[0] = 0.0;
    joint.axis_a[1] = joint.axis_b[1] = 1.0;
    joint.origin_a[0] = 1.0;
    joint.stiffness[DMB_RX] = joint_spring;
    last_joint = add_joint(s, &joint);
}

/* A rotor in a carrier on a pivot, the parameter being its speed: each sim turns the axes of its steps by its own. */
static void describe_rotor(rig *s)
{
    const dmb_place ground = {{0, 0}, 0, 0, 0.0};
    dmb_body_def body = dmb_body_def_default();
    rig_open(s, 0.0, 0.0, -9.81);
    body.mass = 0.5;
    body.position[0] = 0.2;
    body.inertia[0] = 0.002, body.inertia[1] = 0.003, body.inertia[2] = 0.004;
    const dmb_id carrier = add_body(s, &body);
    body.mass = 2.0;
    body.inertia[0] = 0.02, body.inertia[1] = body.inertia[2] = 0.012;
    body.velocity[3] = rotor_speed;
    last_body = add_body(s, &body);
    dmb_joint_def pivot = joint_between(DMB_JOINT_SPHERICAL, ground, dmb_station(carrier, 0, 0.0));
    pivot.origin_b[0] = -0.2;
    (void)add_joint(s, &pivot);
    last_joint = add_joint_between(s, DMB_JOINT_REVOLUTE, dmb_station(carrier, 0, 0.0), dmb_station(last_body, 0, 0.0));
}

static uint32_t rod_outputs(const rig *s, dmb_output *out)
{
    (void)s;
    for (int i = 0; i < 2; i++) {
        out[2 * i] = output_of(dmb_station(last_body, 0, 0.0), DMB_OUTPUT_POSITION_X + 2 * i);
        out[2 * i + 1] = output_of(dmb_station(last_body, 0, 0.0), DMB_OUTPUT_VELOCITY_X + 2 * i);
    }
    return 4;
}

/* Bars turned by a motion drive whose speed has corners, the parameter being its values. */
static void describe_corners(rig *s)
{
    const double time[4] = {0.0, 0.02, 0.05, 0.2}, speeds[4] = {0.0, speed, 0.5 * speed, speed};
    dmb_segment term = dmb_segment_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    rig_open(s, 0.0, 0.0, 0.0);
    term.kind = DMB_SEGMENT_TABLE;
    term.table_time = time;
    term.table_value = speeds;
    term.table_count = 4;
    string.start_free = DMB_FREE_RX;
    last_string = add_string(s, &string);
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    pipe.damping_time = 1e-4;
    (void)dmb_model_add_pipes(s->model, &pipe, 6, NULL);
    last_drive = add_simple_drive(s, DMB_DRIVE_MOTION, last_string, DMB_RX, add_time_function(s, &term, 1));
}

static uint32_t turning_outputs(const rig *s, dmb_output *out)
{
    (void)s;
    out[0] = output_of(dmb_station(last_string, 5, 1.0), DMB_OUTPUT_ROTATION);
    out[1] = output_of(dmb_station(last_string, 5, 1.0), DMB_OUTPUT_SPIN);
    out[2] = output_of(dmb_station(last_string, 2, 0.5), DMB_OUTPUT_TORQUE);
    out[3] = output_of(dmb_station(last_drive, 0, 0.0), DMB_OUTPUT_DRIVE_FORCE);
    return 4;
}

/* The string that drills, in mud, with an input of every kind of target; the parameters are what they are set to. */
static double set_to[10] = {6.0, 1.0, 300.0, 400.0, 200.0, 9e3, -9e3, 1.0, 1100.0, 6.0};
enum { SETTINGS = 10 };

static void describe_settable(rig *s)
{
    static const int32_t targets[SETTINGS] = {
        DMB_TARGET_SET_POINT,     DMB_TARGET_LOAD_FACTOR,    DMB_TARGET_BIT_LOAD,  DMB_TARGET_GAIN,
        DMB_TARGET_INTEGRAL_GAIN, DMB_TARGET_LIMIT_HIGH,     DMB_TARGET_LIMIT_LOW, DMB_TARGET_FRICTION,
        DMB_TARGET_FLUID_DENSITY, DMB_TARGET_LATERAL_DAMPING};
    dmb_load_def load = dmb_load_def_default();
    describe_drilling(s);
    load.place = dmb_station(last_string, 4, 0.3);
    load.force[2] = -400.0;
    const dmb_id parts[SETTINGS] = {last_drive, add_load(s, &load), last_bit, last_drive, last_drive,
                                    last_drive, last_drive,         {0, 0},   {0, 0},     {0, 0}};
    for (int i = 0; i < SETTINGS; i++) {
        dmb_input_def def = dmb_input_def_default();
        (void)snprintf(def.name, sizeof def.name, "input %d", i);
        def.target = targets[i];
        def.part = parts[i];
        def.initial = set_to[i];
        if (targets[i] >= DMB_TARGET_GAIN && targets[i] != DMB_TARGET_LIMIT_LOW) def.low = 0.0;
        dmb_id input;
        must_model(s, dmb_model_add_input(s->model, &def, &input));
    }
}

/* ---- Held at both ends ------------------------------------------------------------------------------------------- */

static void describe_held(rig *s)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    rig_open(s, 0.0, 0.0, -9.81);
    string.follows_hole = 0;
    string.start_free = string.end_free = DMB_FREE_NONE;
    last_string = add_string(s, &string);
    pipe.young_modulus = young;
    pipe.damping_time = 1e-4;
    (void)add_pipes(s, &pipe, 3);
}

static uint32_t held_outputs(const rig *s, dmb_output *out)
{
    const dmb_place end = dmb_station(last_string, 0, 0.0);
    (void)s;
    out[0] = output_of(end, DMB_OUTPUT_REACTION + DMB_Z);
    out[1] = output_of(end, DMB_OUTPUT_REACTION + DMB_RY);
    out[2] = output_of(dmb_station(last_string, 1, 0.5), DMB_OUTPUT_DISPLACEMENT_Z);
    return 3;
}

/* ---- Tests ------------------------------------------------------------------------------------------------------- */

static void test_strings(void **state)
{
    const scene_case cases[] = {
        {"friction", describe_string, &mu, bending_outputs, 1e-4, 1e-4, 1e-3, 1e-6, 80, 0},
        {"stiffness of the wall", describe_string, &stiffness, bending_outputs, 300.0, 3000.0, 1e-3, 1e-6, 80, 0},
        {"outer diameter", describe_string, &diameter, bending_outputs, 1e-6, 1e-5, 1e-3, 1e-6, 80, 0},
        {"damping by mud", describe_string, &damping, bending_outputs, 0.07, 0.3, 1e-3, 1e-6, 80, 0},
        {"modulus", describe_string, &young, bending_outputs, 1e8, 3e8, 1e-3, 1e-6, 80, 0},
        {"modulus of a beam held at both ends", describe_held, &young, held_outputs, 1e8, 3e8, 1e-3, 1e-6, 80, 0},
        {"friction of bars", describe_bars, &mu, string_outputs, 1e-5, 1e-4, 1e-3, 1e-6, 80, 0},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) check_case(&cases[i]);
}

/* Inputs of control.h are parameters like others. */
static void test_settings(void **state)
{
    static const double size[SETTINGS] = {1.0, 0.3, 300.0, 400.0, 2e4, 0.0, 0.0, 1.0, 1000.0, 6.0};
    static const double largest[SETTINGS] = {1.0, 1.0, 300.0, 400.0, 2e4, 0.0, 0.0, 1.0, 1000.0, 6.0};
    (void)state;
    for (int i = 0; i < SETTINGS; i++) {
        if (size[i] == 0.0) continue; /* limits that are not reached */
        const scene_case c = {"setting",
                              describe_settable,
                              &set_to[i],
                              drilling_outputs,
                              1e-3 * size[i],
                              3e-3 * largest[i],
                              1e-3,
                              1e-5,
                              60,
                              0};
        printf("input %d: ", i);
        check_case(&c);
    }
}

/* Inputs that nobody sets leave the derivatives by others alone, bit for bit; one that is set, or on its way, is told.
 */
static void test_settings_stay(void **state)
{
    dmb_parameter parameter = dmb_parameter_default();
    dmb_sensitivity *sensitivity = NULL;
    dmb_id input;
    rig sides[3];
    (void)state;
    for (int i = 0; i < 3; i++) {
        dmb_input_def def = dmb_input_def_default();
        stiffness += 100.0 * (i - 1);
        describe_string(&sides[i]);
        stiffness -= 100.0 * (i - 1);
        strcpy(def.name, "speed");
        def.part = last_drive;
        def.rate_limit = 10.0;
        must_model(&sides[i], dmb_model_add_input(sides[i].model, &def, &input));
        (void)rig_start(&sides[i], NULL);
        if (i == 1) must(&sides[i], dmb_sim_set_input(sides[i].sim, input, 1.0));
        if (i == 1) must(&sides[i], dmb_sim_step(sides[i].sim, 1e-3, NULL));
        if (i != 1) must(&sides[i], dmb_sim_step(sides[i].sim, 1e-3, NULL));
    }
    rig *s = &sides[2]; /* any two of the three */
    parameter.step = 100.0;
    parameter.low = sides[1].sim;
    parameter.high = sides[2].sim;
    assert_int_equal(dmb_sensitivity_create(s->sim, &parameter, 1, &sensitivity), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_sim_message(s->sim), "inputs set by the caller"));
    parameter.low = sides[0].sim;
    must(s, dmb_sensitivity_create(s->sim, &parameter, 1, &sensitivity));
    must(s, dmb_sensitivity_step(sensitivity, 1e-3, NULL));
    must(s, dmb_sim_set_input(s->sim, input, 2.0));
    assert_int_equal(dmb_sensitivity_step(sensitivity, 1e-3, NULL), DMB_ERR_ORDER);
    assert_non_null(strstr(dmb_sim_message(s->sim), "inputs were set since it was made"));
    dmb_sensitivity_destroy(&sensitivity);
    assert_int_equal(dmb_sensitivity_create(s->sim, &parameter, 1, &sensitivity), DMB_ERR_VALUE);
    for (int i = 0; i < 3; i++) rig_close(&sides[i]);
}

/* Rows of bars: along the hole and about it, as outputs tell them. */
static void test_rows_of_bars(void **state)
{
    const scene_case c = {"rows of bars", describe_bars, &mu, string_outputs, 1e-5, 1e-4, 1e-3, 1e-6, 30, 0};
    rig low = begin(&c, -c.step), high = begin(&c, c.step), s = begin(&c, 0.0);
    dmb_sensitivity *sensitivity;
    dmb_parameter parameter = dmb_parameter_default();
    double pose[14], velocity[14];
    uint32_t rows = 0;
    (void)state;
    parameter.step = c.step;
    parameter.low = low.sim;
    parameter.high = high.sim;
    must(&s, dmb_sensitivity_create(s.sim, &parameter, 1, &sensitivity));
    for (uint32_t i = 0; i < c.steps; i++) must(&s, dmb_sensitivity_step(sensitivity, c.time_step, NULL));
    must(&s, dmb_sensitivity_rows(sensitivity, 0, pose, velocity, &rows));
    assert_int_equal(rows, 14);
    for (uint32_t k = 0; k < 6; k++) {
        const dmb_place end = dmb_station(last_string, k, 1.0);
        const dmb_output outputs[4] = {output_of(end, DMB_OUTPUT_POSITION_X), output_of(end, DMB_OUTPUT_ROTATION),
                                       output_of(end, DMB_OUTPUT_BODY_VELOCITY + DMB_X),
                                       output_of(end, DMB_OUTPUT_SPIN)};
        const double *row = pose + 2 * (size_t)(k + 1), *rate = velocity + 2 * (size_t)(k + 1);
        const double got[4] = {row[0], row[1], rate[0], rate[1]};
        double want[4];
        must(&s, dmb_sensitivity_outputs(sensitivity, outputs, 4, NULL, want));
        for (int i = 0; i < 4; i++) check_close("a row of bars", got[i], want[i], 1e-6 * fabs(want[i]) + 1e-10);
    }
    dmb_sensitivity_destroy(&sensitivity);
    rig_close(&low);
    rig_close(&high);
    rig_close(&s);
}

static void test_bristles(void **state)
{
    const scene_case c = {
        "friction of bristles", describe_bristles, &mu, string_outputs, 3e-5, 3e-4, 1e-3, 1e-6, 80, 0};
    const scene_case bars = {"bristles of bars", describe_bristles, &mu, string_outputs, 3e-5, 3e-4, 1e-3, 1e-6, 80, 0};
    (void)state;
    check_case(&c);
    pipe_kind = DMB_PIPE_AXIAL_TORSIONAL;
    check_case(&bars);
    pipe_kind = DMB_PIPE_FLEXIBLE;
}

/* A drive with a lag, whose force changes no faster than it may, turned both ways against a drag that is another one
 * backwards. */
static void test_actuators(void **state)
{
    const scene_case cases[2] = {
        {"lag of an actuator", describe_bars, &lag, string_outputs, 2e-5, 2e-4, 1e-3, 1e-5, 80, 0},
        {"drag of an actuator, backwards", describe_bars, &back_drag, string_outputs, 1e-3, 3e-3, 1e-3, 1e-5, 80, 0},
    };
    (void)state;
    lag = 0.02;
    back_drag = 9.0;
    check_case(&cases[0]);
    direction = -1.0;
    check_case(&cases[1]);
    direction = 1.0;
    lag = back_drag = 0.0;
}

/* One side: the same derivatives but for the step times the second one. */
static void test_one_side(void **state)
{
    const scene_case cases[2] = {
        {"modulus, one side", describe_string, &young, bending_outputs, 1e8, 3e8, 1e-3, 2e-3, 80, 0},
        {"spring of a joint, one side", describe_rods, &joint_spring, rod_outputs, 1e-6, 1e-3, 2e-3, 1e-5, 300, 0},
    };
    (void)state;
    one_sided = 1;
    for (int i = 0; i < 2; i++) check_case(&cases[i]);
    one_sided = 0;
}

static void test_drilling(void **state)
{
    const scene_case cases[] = {
        /* runs by other differences scatter by 3e-6 of the largest */
        {"energy of the rock", describe_drilling, &energy, drilling_outputs, 1e4, 3e4, 1e-3, 1e-5, 240, 0},
        {"rotary speed", describe_drilling, &speed, drilling_outputs, 5e-5, 5e-4, 1e-3, 1e-5, 240, 0},
        {"energy, regenerative", describe_regenerative, &energy, drilling_outputs, 1e4, 3e4, 1e-3, 1e-6, 240, 0},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) check_case(&cases[i]);
}

static void test_ball(void **state)
{
    const scene_case c = {
        "stiffness under a ball", describe_ball, &stiffness, ball_outputs, 10.0, 100.0, 1e-4, 1e-6, 1200, 0};
    (void)state;
    check_case(&c);
}

/* At a corner, in the step after it, and later. */
static void test_corners(void **state)
{
    const uint32_t steps[3] = {20, 21, 100};
    (void)state;
    for (int i = 0; i < 3; i++) {
        const scene_case c = {
            "table of a motion drive", describe_corners, &speed, turning_outputs, 1e-2, 1e-1, 1e-3, 1e-9, steps[i], 0};
        check_case(&c);
    }
}

static void test_joints(void **state)
{
    const scene_case c = {
        "spring of a joint", describe_rods, &joint_spring, rod_outputs, 1e-6, 1e-3, 2e-3, 1e-6, 300, 0};
    const scene_case rotor = {
        "speed of a rotor", describe_rotor, &rotor_speed, rod_outputs, 1e-4, 1e-2, 2e-3, 1e-6, 300, 0};
    (void)state;
    check_case(&c);
    check_case(&rotor);
}

/* x'' = -w^2 x - 2 z x', x(0) = 0, x'(0) = v: x = v exp(-z t) sin(u t)/u, u^2 = w^2 - z^2. */
typedef struct oscillator {
    double w2, z, v, force;
} oscillator;

static rig describe_oscillator(const oscillator *o)
{
    const dmb_place ground = {{0, 0}, 0, 0, 0.0};
    const dmb_sim_options options = sharp();
    dmb_body_def body = dmb_body_def_default();
    dmb_drive_def load = dmb_drive_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    body.mass = 2.0;
    body.free_mask = DMB_FREE_X;
    body.velocity[0] = o->v;
    last_body = add_body(&s, &body);
    dmb_joint_def spring = joint_between(DMB_JOINT_FREE, ground, dmb_station(last_body, 0, 0.0));
    spring.stiffness[0] = 2.0 * o->w2;
    spring.damping[0] = 4.0 * o->z;
    (void)add_joint(&s, &spring);
    load.kind = DMB_DRIVE_LOAD;
    load.part = last_body;
    load.time_function = add_constant(&s, o->force);
    last_drive = add_drive(&s, &load);
    (void)rig_start(&s, &options);
    return s;
}

static double speed_of(const oscillator *o, double t)
{
    const double u = sqrt(o->w2 - o->z * o->z);
    return o->v * exp(-o->z * t) * (cos(u * t) - o->z / u * sin(u * t));
}

static double place_of(const oscillator *o, double t)
{
    const double u = sqrt(o->w2 - o->z * o->z);
    return o->v * exp(-o->z * t) * sin(u * t) / u;
}

/* Largest error of the derivatives of place and speed by w^2, z and v at 1 s with steps of h, over their size; 0: by
 * error-controlled steps. */
static double oscillator_error(double h)
{
    const oscillator middle = {400.0, 1.5, 0.3, 0.0};
    const double step[3] = {1e-3, 1e-5, 1e-5};
    dmb_parameter parameters[3];
    rig sides[3][2];
    oscillator low[3], high[3];
    for (int i = 0; i < 3; i++) {
        double *of_low[3] = {&low[i].w2, &low[i].z, &low[i].v}, *of_high[3] = {&high[i].w2, &high[i].z, &high[i].v};
        low[i] = high[i] = middle;
        *of_low[i] -= step[i];
        *of_high[i] += step[i];
        sides[i][0] = describe_oscillator(&low[i]);
        sides[i][1] = describe_oscillator(&high[i]);
        parameters[i] = dmb_parameter_default();
        parameters[i].step = step[i];
        parameters[i].low = sides[i][0].sim;
        parameters[i].high = sides[i][1].sim;
    }
    rig s = describe_oscillator(&middle);
    dmb_sensitivity *sensitivity;
    must(&s, dmb_sensitivity_create(s.sim, parameters, 3, &sensitivity));
    if (h > 0.0)
        for (int i = 0; i < lround(1.0 / h); i++) must(&s, dmb_sensitivity_step(sensitivity, h, NULL));
    else
        must(&s, dmb_sensitivity_advance(sensitivity, 1.0, NULL));
    const dmb_output outputs[2] = {output_of(dmb_station(last_body, 0, 0.0), DMB_OUTPUT_DISPLACEMENT_X),
                                   output_of(dmb_station(last_body, 0, 0.0), DMB_OUTPUT_VELOCITY_X)};
    double values[2], derivatives[6], pose[6], velocity[6], error = 0.0;
    uint32_t rows = 0;
    must(&s, dmb_sensitivity_outputs(sensitivity, outputs, 2, values, derivatives));
    for (int i = 0; i < 3; i++) {
        const double place = (place_of(&high[i], 1.0) - place_of(&low[i], 1.0)) / (2.0 * step[i]);
        const double rate = (speed_of(&high[i], 1.0) - speed_of(&low[i], 1.0)) / (2.0 * step[i]);
        error = fmax(error, fabs(derivatives[i] - place) / hypot(place, rate / 20.0));
        error = fmax(error, fabs(derivatives[3 + i] - rate) / hypot(20.0 * place, rate));
        must(&s, dmb_sensitivity_rows(sensitivity, (uint32_t)i, pose, velocity, &rows));
        assert_int_equal(rows, 6);
        assert_true(fabs(pose[0] - derivatives[i]) <= 1e-9 * fabs(place) + 1e-12);
        assert_true(fabs(velocity[0] - derivatives[3 + i]) <= 1e-9 * fabs(rate) + 1e-12);
    }
    dmb_sensitivity_destroy(&sensitivity);
    for (int i = 0; i < 3; i++) rig_close(&sides[i][0]), rig_close(&sides[i][1]);
    rig_close(&s);
    return error;
}

static void test_oscillator(void **state)
{
    const double coarse = oscillator_error(2e-3), fine = oscillator_error(1e-3), chosen = oscillator_error(0.0);
    (void)state;
    printf("oscillator: errors %.3e, halved %.3e, order %.2f; chosen steps %.1e\n", coarse, fine, log2(coarse / fine),
           chosen);
    assert_true(fabs(log2(coarse / fine) - 2.0) < 0.1);
    assert_true(chosen < 1e-3);
}

/* A force set between steps: what it has done since, F -> x by the linear oscillator's step response, in both
 * directions of one input; and a motion of the sim by other calls is refused. */
static void test_input(void **state)
{
    const oscillator still = {400.0, 1.5, 0.0, 0.0};
    rig low = describe_oscillator(&still), high = describe_oscillator(&still), s = describe_oscillator(&still);
    dmb_sensitivity *sensitivity;
    dmb_parameter parameter = dmb_parameter_default();
    dmb_id drive = last_drive;
    (void)state;
    must(&s, dmb_sim_set_drive(s.sim, drive, 5.0));
    /* ids of the other models differ in their stamp only */
    rig *sides[2] = {&low, &high};
    for (int i = 0; i < 2; i++) {
        rig_close(sides[i]);
        *sides[i] = describe_oscillator(&still);
        must(sides[i], dmb_sim_set_drive(sides[i]->sim, last_drive, 5.0 + (i ? 1e-4 : -1e-4)));
    }
    parameter.step = 1e-4;
    parameter.low = low.sim;
    parameter.high = high.sim;
    must(&s, dmb_sensitivity_create(s.sim, &parameter, 1, &sensitivity));
    for (int i = 0; i < 500; i++) {
        if (i == 250) must(&s, dmb_sim_set_drive(s.sim, drive, 7.0)); /* the input by its step up: 1 still */
        must(&s, dmb_sensitivity_step(sensitivity, 1e-3, NULL));
    }
    dmb_id body = {0, 0};
    body = last_body;
    body.generation = drive.generation;
    const dmb_output output = output_of(dmb_station(body, 0, 0.0), DMB_OUTPUT_DISPLACEMENT_X);
    const double u = sqrt(still.w2 - still.z * still.z), t = 0.5;
    const double formula = (1.0 - exp(-still.z * t) * (cos(u * t) + still.z / u * sin(u * t))) / (2.0 * still.w2);
    double derivative;
    must(&s, dmb_sensitivity_outputs(sensitivity, &output, 1, NULL, &derivative));
    printf("input: derivative %.9g, formula %.9g\n", derivative, formula);
    assert_true(fabs(derivative - formula) <= 5e-4 * fabs(formula));
    must(&s, dmb_sim_step(s.sim, 1e-3, NULL));
    assert_int_equal(dmb_sensitivity_step(sensitivity, 1e-3, NULL), DMB_ERR_ORDER);
    const double told = derivative; /* of where the sim has been: not of where it is */
    double velocity[6];
    uint32_t rows = 0;
    assert_int_equal(dmb_sensitivity_outputs(sensitivity, &output, 1, NULL, &derivative), DMB_ERR_ORDER);
    assert_non_null(strstr(dmb_sim_message(s.sim), "moved by other calls"));
    assert_int_equal(dmb_sensitivity_rows(sensitivity, 0, NULL, velocity, &rows), DMB_ERR_ORDER);
    assert_int_equal(dmb_sensitivity_rows(sensitivity, 0, NULL, NULL, &rows), DMB_OK);
    assert_true(derivative == told && rows <= 6);
    dmb_sensitivity_destroy(&sensitivity);
    rig_close(&low);
    rig_close(&high);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_oscillator), cmocka_unit_test(test_input),         cmocka_unit_test(test_joints),
        cmocka_unit_test(test_corners),    cmocka_unit_test(test_strings),       cmocka_unit_test(test_rows_of_bars),
        cmocka_unit_test(test_bristles),   cmocka_unit_test(test_actuators),     cmocka_unit_test(test_one_side),
        cmocka_unit_test(test_settings),   cmocka_unit_test(test_settings_stay), cmocka_unit_test(test_ball),
        cmocka_unit_test(test_drilling),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
