/* A scene with every kind of part, for the contract tests: a curved hole that the bit widens, a string of all three
 * kinds of pipes with tool joints, eccentricity, a rig head and a regenerative bit, a second string, a body of its own,
 * drives of all kinds with time functions of all kinds, dead and follower loads; an arm hinged to the body and hung
 * from the string by springs, with a wheel that is geared and driven, and a function that watches. Small enough to be
 * run some thousand times. */
#ifndef DMB_TESTS_WHOLE_SCENE_H
#define DMB_TESTS_WHOLE_SCENE_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "drillmbd/drillmbd.h"

enum { WHOLE_PIPES = 8, WHOLE_OUTPUTS = 4, WHOLE_ROWS = 8 };

/* The parts, and what the scene's callbacks look at. Has to outlive model and sims. */
typedef struct whole_parts {
    dmb_id wall, string, second, head, body, bit;
    dmb_id constant, step, step5, harmonic, table, smooth, plain;
    dmb_id feed, turning, pushing, spinning;
    dmb_id arm, wheel, hinge, axle, spring, gear, watch, winding, rope, jam;
    int32_t callback_status; /* what the callbacks return; not 0: they fail */
} whole_parts;

/* ---- Time functions
 * -------------------------------------------------------------------------------------------------- */

/* 2 sin(3 t) with all that can be told */
static inline int32_t whole_smooth(void *context, double time, double out[3])
{
    const whole_parts *parts = context;
    out[0] = 2.0 * sin(3.0 * time);
    out[1] = 6.0 * cos(3.0 * time);
    out[2] = 2.0 * (1.0 - cos(3.0 * time)) / 3.0;
    return parts->callback_status;
}

/* A value and nothing else. */
static inline int32_t whole_plain(void *context, double time, double out[3])
{
    const whole_parts *parts = context;
    out[0] = 1.0 + 0.5 * sin(2.0 * time);
    return parts->callback_status;
}

static inline int32_t whole_add_segment(dmb_model *model, const dmb_segment *term, dmb_id *id)
{
    return dmb_model_add_time_function(model, term, 1, id);
}

static inline int32_t whole_add_constant(dmb_model *model, whole_parts *parts)
{
    dmb_segment term = dmb_segment_default();
    term.h0 = 4.0;
    return whole_add_segment(model, &term, &parts->constant);
}

/* Up, and down again before the end of a run. */
static inline int32_t whole_add_step(dmb_model *model, whole_parts *parts)
{
    dmb_segment terms[2] = {dmb_segment_default(), dmb_segment_default()};
    terms[0].kind = terms[1].kind = DMB_SEGMENT_STEP;
    terms[0].x1 = 0.0107;
    terms[0].h1 = 0.02;
    terms[1].x0 = 0.0153;
    terms[1].x1 = 0.0254;
    terms[1].h1 = -0.01;
    return dmb_model_add_time_function(model, terms, 2, &parts->step);
}

static inline int32_t whole_add_step5(dmb_model *model, whole_parts *parts)
{
    dmb_segment term = dmb_segment_default();
    term.kind = DMB_SEGMENT_STEP5;
    term.x1 = 0.02;
    term.h1 = 8.0;
    return whole_add_segment(model, &term, &parts->step5);
}

static inline int32_t whole_add_harmonic(dmb_model *model, whole_parts *parts)
{
    dmb_segment term = dmb_segment_default();
    term.kind = DMB_SEGMENT_HARMONIC;
    term.h1 = 1e-3;
    term.omega = 300.0;
    term.phase = 0.2;
    return whole_add_segment(model, &term, &parts->harmonic);
}

static inline int32_t whole_add_table(dmb_model *model, whole_parts *parts)
{
    static const double time[4] = {0.0, 0.0042, 0.0131, 0.5}, value[4] = {0.0, 60.0, -30.0, 10.0};
    dmb_segment term = dmb_segment_default();
    term.kind = DMB_SEGMENT_TABLE;
    term.table_time = time;
    term.table_value = value;
    term.table_count = 4;
    return whole_add_segment(model, &term, &parts->table);
}

static inline int32_t whole_add_smooth(dmb_model *model, whole_parts *parts)
{
    dmb_segment term = dmb_segment_default();
    term.kind = DMB_SEGMENT_CALLBACK;
    term.provides = DMB_PROVIDES_RATE | DMB_PROVIDES_INTEGRAL;
    term.callback = whole_smooth;
    term.callback_context = parts;
    return whole_add_segment(model, &term, &parts->smooth);
}

static inline int32_t whole_add_plain(dmb_model *model, whole_parts *parts)
{
    dmb_segment term = dmb_segment_default();
    term.kind = DMB_SEGMENT_CALLBACK;
    term.callback = whole_plain;
    term.callback_context = parts;
    return whole_add_segment(model, &term, &parts->plain);
}

/* ---- Hole, strings, bodies --------------------------------------------------------------------------------------- */

static inline int32_t whole_set_environment(dmb_model *model, whole_parts *parts)
{
    dmb_environment_def environment = dmb_environment_def_default();
    (void)parts;
    environment.fluid_density = 1000.0;
    environment.lateral_damping = 5.0;
    environment.axial_damping = 2.0;
    environment.torsional_damping = 0.1;
    return dmb_model_set_environment(model, &environment);
}

/* Straight along +x for 10 m, then gently upwards and sideways. */
static inline int32_t whole_add_wall(dmb_model *model, whole_parts *parts)
{
    static const double survey[5][3] = {{0.0, 1.5707963267948966, 0.0},
                                        {10.0, 1.5707963267948966, 0.0},
                                        {20.0, 1.60, 0.01},
                                        {30.0, 1.63, 0.02},
                                        {60.0, 1.65, 0.02}};
    dmb_wall_def wall = dmb_wall_def_default();
    wall.survey = survey[0];
    wall.survey_count = 5;
    wall.normal_law = DMB_NORMAL_EXACT;
    wall.friction_law = DMB_FRICTION_BRISTLE;
    wall.cut_spacing = 0.01;
    wall.cut_end = 30.0;
    return dmb_model_add_wall(model, &wall, &parts->wall);
}

static inline dmb_pipe_def whole_pipe(int32_t kind)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.kind = kind;
    pipe.damping_time = 1e-5;
    pipe.joint_length = 0.1;
    pipe.joint_outer_diameter = 0.08;
    pipe.joint_inner_diameter = 0.05;
    pipe.eccentricity = 1e-3;
    pipe.eccentricity_spread = 5e-4;
    pipe.angle_spread = 3.0;
    return pipe;
}

static inline int32_t whole_add_string(dmb_model *model, whole_parts *parts)
{
    const dmb_string_def string = dmb_string_def_default();
    return dmb_model_add_string(model, &string, &parts->string);
}

static inline int32_t whole_add_path_pipes(dmb_model *model, whole_parts *parts)
{
    dmb_pipe_def pipe = whole_pipe(DMB_PIPE_AXIAL_TORSIONAL);
    (void)parts;
    pipe.eccentricity = pipe.eccentricity_spread = 0.0;
    return dmb_model_add_pipes(model, &pipe, 2, NULL);
}

static inline int32_t whole_add_flexible_pipes(dmb_model *model, whole_parts *parts)
{
    dmb_pipe_def pipe = whole_pipe(DMB_PIPE_FLEXIBLE);
    pipe.string = parts->string;
    pipe.elements = 2;
    pipe.length = 1.5;
    return dmb_model_add_pipes(model, &pipe, 3, &parts->string);
}

static inline int32_t whole_add_rigid_pipes(dmb_model *model, whole_parts *parts)
{
    dmb_pipe_def pipe = whole_pipe(DMB_PIPE_RIGID);
    pipe.string = parts->string;
    pipe.length = 0.5;
    return dmb_model_add_pipes(model, &pipe, 2, NULL);
}

static inline int32_t whole_add_last_pipe(dmb_model *model, whole_parts *parts)
{
    dmb_pipe_def pipe = whole_pipe(DMB_PIPE_FLEXIBLE);
    pipe.string = parts->string;
    return dmb_model_add_pipes(model, &pipe, 1, NULL);
}

static inline int32_t whole_add_second(dmb_model *model, whole_parts *parts)
{
    dmb_string_def string = dmb_string_def_default();
    string.start_depth = 20.0;
    string.offset[1] = -0.004;
    string.start_free = DMB_FREE_RX;
    return dmb_model_add_string(model, &string, &parts->second);
}

static inline int32_t whole_add_second_pipes(dmb_model *model, whole_parts *parts)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.string = parts->second;
    return dmb_model_add_pipes(model, &pipe, 3, NULL);
}

static inline int32_t whole_add_head(dmb_model *model, whole_parts *parts)
{
    dmb_body_def head = dmb_body_def_default();
    head.attach = DMB_ATTACH_START;
    head.string = parts->string;
    head.mass = 40.0;
    return dmb_model_add_body(model, &head, &parts->head);
}

static inline int32_t whole_add_body(dmb_model *model, whole_parts *parts)
{
    dmb_body_def body = dmb_body_def_default();
    body.mass = 3.0;
    body.position[0] = 5.0;
    body.position[2] = -0.005;
    body.velocity[0] = 0.1;
    body.inertia[3] = 1e-4;
    body.contact_diameter = 0.08;
    body.contact_length = 0.2;
    return dmb_model_add_body(model, &body, &parts->body);
}

static inline int32_t whole_add_bit(dmb_model *model, whole_parts *parts)
{
    dmb_bit_def bit = dmb_bit_def_default();
    bit.rock_law = DMB_ROCK_REGENERATIVE;
    bit.string = parts->string;
    bit.load = parts->table;
    bit.history = 128;
    bit.radius = 0.049; /* leaves a wider hole */
    return dmb_model_add_bit(model, &bit, &parts->bit);
}

/* ---- Drives and loads -------------------------------------------------------------------------------------------- */

static inline int32_t whole_add_feed(dmb_model *model, whole_parts *parts)
{
    dmb_drive_def drive = dmb_drive_def_default();
    drive.part = parts->string;
    drive.time_function = parts->step;
    drive.excitation = parts->harmonic;
    return dmb_model_add_drive(model, &drive, &parts->feed);
}

static inline int32_t whole_add_turning(dmb_model *model, whole_parts *parts)
{
    dmb_drive_def drive = dmb_drive_def_default();
    drive.kind = DMB_DRIVE_CONTROL;
    drive.part = parts->string;
    drive.component = DMB_RX;
    drive.time_function = parts->step5;
    drive.gain = 200.0;
    drive.integral_gain = 50.0;
    drive.limit_low = -3000.0;
    drive.limit_high = 3000.0;
    return dmb_model_add_drive(model, &drive, &parts->turning);
}

static inline int32_t whole_add_pushing(dmb_model *model, whole_parts *parts)
{
    dmb_drive_def drive = dmb_drive_def_default();
    drive.kind = DMB_DRIVE_LOAD;
    drive.part = parts->body;
    drive.time_function = parts->plain;
    drive.excitation = parts->constant;
    return dmb_model_add_drive(model, &drive, &parts->pushing);
}

static inline int32_t whole_add_spinning(dmb_model *model, whole_parts *parts)
{
    dmb_drive_def drive = dmb_drive_def_default();
    drive.part = parts->second;
    drive.component = DMB_RX;
    drive.value = 0.5;
    return dmb_model_add_drive(model, &drive, &parts->spinning);
}

static inline int32_t whole_add_dead_load(dmb_model *model, whole_parts *parts)
{
    dmb_load_def load = dmb_load_def_default();
    load.place = dmb_station(parts->string, 3, 1.0);
    load.force[1] = 1.0;
    load.time_function = parts->table;
    return dmb_model_add_load(model, &load, NULL);
}

static inline int32_t whole_add_follower(dmb_model *model, whole_parts *parts)
{
    dmb_load_def load = dmb_load_def_default();
    load.frame = DMB_FRAME_BODY;
    load.place = dmb_station(parts->body, 0, 0.0);
    load.force[2] = -2.0;
    load.moment[0] = 0.01;
    load.time_function = parts->plain;
    return dmb_model_add_load(model, &load, NULL);
}

/* ---- Joints ------------------------------------------------------------------------------------------------------ */

static inline int32_t whole_add_one_body(dmb_model *model, double x, double y, dmb_id *id)
{
    dmb_body_def body = dmb_body_def_default();
    body.mass = 2.0;
    body.position[0] = x;
    body.position[1] = y;
    body.position[2] = -0.005;
    body.velocity[0] = 0.1;
    return dmb_model_add_body(model, &body, id);
}

static inline int32_t whole_add_arm(dmb_model *model, whole_parts *parts)
{
    return whole_add_one_body(model, 5.3, 0.0, &parts->arm);
}

static inline int32_t whole_add_wheel(dmb_model *model, whole_parts *parts)
{
    return whole_add_one_body(model, 5.6, 0.2, &parts->wheel);
}

/* The arm turns about y of the body, up to a stop, with friction. */
static inline int32_t whole_add_hinge(dmb_model *model, whole_parts *parts)
{
    dmb_joint_def joint = dmb_joint_def_default();
    joint.kind = DMB_JOINT_REVOLUTE;
    joint.place_a = dmb_station(parts->body, 0, 0.0);
    joint.place_b = dmb_station(parts->arm, 0, 0.0);
    joint.axis_a[0] = 0.0;
    joint.axis_a[1] = 1.0;
    joint.match = 1;
    joint.friction[DMB_RX] = 0.01;
    joint.stop_high[DMB_RX] = 0.05;
    joint.stop_stiffness = 100.0;
    return dmb_model_add_joint(model, &joint, &parts->hinge);
}

/* The wheel turns on the arm. */
static inline int32_t whole_add_axle(dmb_model *model, whole_parts *parts)
{
    dmb_joint_def joint = dmb_joint_def_default();
    joint.kind = DMB_JOINT_CYLINDRICAL;
    joint.place_a = dmb_station(parts->arm, 0, 0.0);
    joint.place_b = dmb_station(parts->wheel, 0, 0.0);
    joint.match = 1;
    memcpy(joint.name, "axle", 5);
    return dmb_model_add_joint(model, &joint, &parts->axle);
}

static inline int32_t whole_add_spring(dmb_model *model, whole_parts *parts)
{
    dmb_joint_def joint = dmb_joint_def_default();
    joint.kind = DMB_JOINT_FREE;
    joint.place_a = dmb_station(parts->string, 3, 1.0);
    joint.place_b = dmb_station(parts->arm, 0, 0.0);
    joint.match = 1;
    joint.stiffness[DMB_Y] = joint.stiffness[DMB_Z] = 50.0;
    joint.damping[DMB_Z] = 5.0;
    return dmb_model_add_joint(model, &joint, &parts->spring);
}

/* From inside a pipe to a point off the arm. */
static inline int32_t whole_add_rope(dmb_model *model, whole_parts *parts)
{
    static const double elongation[3] = {0.0, 0.1, 0.2}, force[3] = {0.0, 1.0, 3.0};
    dmb_spring_def rope = dmb_spring_def_default();
    rope.acts = DMB_SPRING_TENSION;
    rope.place_a = dmb_station(parts->string, 3, 0.4);
    rope.place_b = dmb_station(parts->arm, 0, 0.0);
    rope.offset_b[1] = 0.1;
    rope.table_elongation = elongation;
    rope.table_force = force;
    rope.table_count = 3;
    rope.table_kind = DMB_TABLE_CUBIC;
    rope.damping = 1.0;
    return dmb_model_add_spring(model, &rope, &parts->rope);
}

/* Within a body, and inside a pipe. */
static inline int32_t whole_add_guy(dmb_model *model, whole_parts *parts)
{
    dmb_spring_def guy = dmb_spring_def_default();
    guy.place_b = dmb_station(parts->string, 3, 0.6);
    guy.offset_a[2] = 4.0;
    guy.stiffness = 2.0;
    return dmb_model_add_spring(model, &guy, NULL);
}

/* Between the wheel's axle and a place inside a pipe: dampers, and a constant pull. */
static inline int32_t whole_force(void *context, double time, uint32_t count, const double (*poses)[12],
                                  const double (*velocities)[6], double (*forces)[6], double *tangent,
                                  double *potential, const dmb_law_memory *memory)
{
    (void)memory;
    const whole_parts *parts = context;
    (void)time, (void)count, (void)tangent;
    forces[0][0] = -0.1 * velocities[0][0];
    forces[1][1] = -0.2 * velocities[1][1];
    forces[1][2] = 0.3;
    *potential = -0.3 * poses[1][2];
    return parts->callback_status;
}

/* A damper whose force follows the speed with a lag of 10 ms, which is its state. */
static inline int32_t whole_law(void *context, double time, uint32_t count, const double (*poses)[12],
                                const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                                const dmb_law_memory *memory)
{
    const whole_parts *parts = context;
    const double share = memory->step / (0.01 + memory->step);
    (void)time, (void)count, (void)poses, (void)tangent, (void)potential;
    for (int i = 0; i < 3; i++) {
        memory->trial[i] = memory->accepted[i] + share * (velocities[0][i] - memory->accepted[i]);
        forces[0][i] = -0.2 * memory->trial[i];
    }
    return parts->callback_status;
}

static inline int32_t whole_add_law(dmb_model *model, whole_parts *parts)
{
    dmb_force_def force = dmb_force_def_default();
    force.place[0] = dmb_station(parts->string, 2, 0.35);
    force.state_count = 3;
    force.callback = whole_law;
    force.callback_context = parts;
    return dmb_model_add_force(model, &force, NULL);
}

/* Inside an element. */
static inline int32_t whole_add_stabiliser(dmb_model *model, whole_parts *parts)
{
    dmb_stabiliser_def ring = dmb_stabiliser_def_default();
    ring.string = parts->second;
    ring.pipe = 1;
    ring.fraction = 0.37;
    return dmb_model_add_stabiliser(model, &ring, NULL);
}

static inline int32_t whole_add_force(dmb_model *model, whole_parts *parts)
{
    dmb_force_def force = dmb_force_def_default();
    force.place_count = 2;
    force.place[0] = dmb_station(parts->axle, 0, 0.0);
    force.component[0] = DMB_RX;
    force.place[1] = dmb_station(parts->string, 3, 0.45);
    force.provides = DMB_PROVIDES_POTENTIAL;
    force.callback = whole_force;
    force.callback_context = parts;
    return dmb_model_add_force(model, &force, NULL);
}

/* Somewhere inside a pipe; free. */
static inline int32_t whole_add_stuck(dmb_model *model, whole_parts *parts)
{
    dmb_stuck_def stuck = dmb_stuck_def_default();
    stuck.place = dmb_station(parts->string, 3, 0.55);
    stuck.stuck = 0;
    return dmb_model_add_stuck(model, &stuck, &parts->jam);
}

static inline int32_t whole_add_point_load(dmb_model *model, whole_parts *parts)
{
    dmb_load_def load = dmb_load_def_default();
    load.place = dmb_station(parts->string, 3, 0.3);
    load.offset[1] = 0.02;
    load.force[2] = -3.0;
    return dmb_model_add_load(model, &load, NULL);
}

/* The wheel moves along its axle as it turns. */
static inline int32_t whole_add_gear(dmb_model *model, whole_parts *parts)
{
    dmb_coupling_def coupling = dmb_coupling_def_default();
    coupling.joint[0] = coupling.joint[1] = parts->axle;
    coupling.component[0] = DMB_X;
    coupling.ratio = 0.01;
    return dmb_model_add_coupling(model, &coupling, &parts->gear);
}

/* The arm keeps its place across. */
static inline int32_t whole_level(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                                  double *jacobian)
{
    const whole_parts *parts = context;
    (void)time, (void)count, (void)jacobian;
    value[0] = poses[0][1];
    return parts->callback_status;
}

static inline int32_t whole_add_watch(dmb_model *model, whole_parts *parts)
{
    dmb_constraint_def constraint = dmb_constraint_def_default();
    constraint.place[0] = dmb_station(parts->arm, 0, 0.0);
    constraint.callback = whole_level;
    constraint.callback_context = parts;
    return dmb_model_add_constraint(model, &constraint, &parts->watch);
}

static inline int32_t whole_add_winding(dmb_model *model, whole_parts *parts)
{
    dmb_drive_def drive = dmb_drive_def_default();
    drive.part = parts->axle;
    drive.component = DMB_RX;
    drive.time_function = parts->smooth;
    return dmb_model_add_drive(model, &drive, &parts->winding);
}

/* ---- The whole --------------------------------------------------------------------------------------------------- */

static inline int32_t whole_compile(dmb_model *model, whole_parts *parts)
{
    (void)parts;
    return dmb_model_compile(model, NULL);
}

typedef int32_t (*whole_call)(dmb_model *model, whole_parts *parts);

/* Every call of the description, compile last. */
static const whole_call whole_calls[] = {
    whole_set_environment,  whole_add_constant,       whole_add_step,        whole_add_step5,     whole_add_harmonic,
    whole_add_table,        whole_add_smooth,         whole_add_plain,       whole_add_wall,      whole_add_string,
    whole_add_path_pipes,   whole_add_flexible_pipes, whole_add_rigid_pipes, whole_add_last_pipe, whole_add_second,
    whole_add_second_pipes, whole_add_head,           whole_add_body,        whole_add_bit,       whole_add_feed,
    whole_add_turning,      whole_add_pushing,        whole_add_spinning,    whole_add_dead_load, whole_add_follower,
    whole_add_arm,          whole_add_wheel,          whole_add_hinge,       whole_add_axle,      whole_add_spring,
    whole_add_gear,         whole_add_watch,          whole_add_winding,     whole_add_rope,      whole_add_guy,
    whole_add_point_load,   whole_add_force,          whole_add_law,         whole_add_stuck,     whole_add_stabiliser,
    whole_compile};
enum { WHOLE_CALLS = sizeof whole_calls / sizeof whole_calls[0] };

static inline void whole_must(const dmb_model *model, int32_t status)
{
    if (status < 0) fail_msg("%s: %s", dmb_status_name(status), dmb_model_message(model));
}

/* Describes the first `count` of the calls above. options: NULL or those of the model. */
static inline dmb_model *whole_model_with(const dmb_model_options *options, whole_parts *parts, size_t count)
{
    dmb_model *model = NULL;
    memset(parts, 0, sizeof *parts);
    assert_int_equal(dmb_model_create(options, &model), DMB_OK);
    for (size_t i = 0; i < count; i++) whole_must(model, whole_calls[i](model, parts));
    return model;
}

static inline dmb_model *whole_model_until(whole_parts *parts, size_t count)
{
    return whole_model_with(NULL, parts, count);
}

static inline dmb_model *whole_model(whole_parts *parts)
{
    return whole_model_until(parts, WHOLE_CALLS);
}

static inline dmb_sim *whole_sim(dmb_model *model, const dmb_sim_options *options)
{
    dmb_sim *sim = NULL;
    whole_must(model, dmb_sim_create(model, options, &sim));
    return sim;
}

static inline uint64_t whole_hash(const dmb_sim *sim)
{
    uint64_t hash = 0;
    assert_int_equal(dmb_sim_hash(sim, &hash), DMB_OK);
    return hash;
}

/* n steps of h [s], each of which has to be accepted. */
static inline void whole_run(dmb_sim *sim, uint32_t n, double h)
{
    for (uint32_t i = 0; i < n; i++) {
        const int32_t status = dmb_sim_step(sim, h, NULL);
        if (status < 0) fail_msg("step %u: %s: %s", i, dmb_status_name(status), dmb_sim_message(sim));
    }
}

/* ---- Every question ---------------------------------------------------------------------------------------------- */

typedef struct whole_answers {
    dmb_pose pose[WHOLE_PIPES];
    dmb_motion motion;
    dmb_section section;
    dmb_contact contact;
    dmb_contact_total contact_total;
    dmb_energy energy;
    dmb_momentum momentum;
    dmb_drive_state drive;
    dmb_joint_state joint;
    dmb_bit_state bit;
    dmb_statistics statistics;
    double rotation, kinetic_energy, reaction[6], multipliers[6];
    uint32_t multiplier_count, reserved;
    dmb_output outputs[WHOLE_OUTPUTS];
    double table[WHOLE_ROWS * (1 + WHOLE_OUTPUTS)];
    dmb_recorder recorder;
} whole_answers;

static inline void whole_answers_init(whole_answers *a, const whole_parts *parts)
{
    static const int32_t quantities[WHOLE_OUTPUTS] = {DMB_OUTPUT_POSITION_Z, DMB_OUTPUT_AXIAL_FORCE,
                                                      DMB_OUTPUT_DRIVE_FORCE, DMB_OUTPUT_BIT_WEIGHT};
    memset(a, 0, sizeof *a);
    for (uint32_t i = 0; i < WHOLE_PIPES; i++) a->pose[i] = dmb_pose_default();
    a->motion = dmb_motion_default();
    a->section = dmb_section_default();
    a->contact = dmb_contact_default();
    a->contact_total = dmb_contact_total_default();
    a->energy = dmb_energy_default();
    a->momentum = dmb_momentum_default();
    a->drive = dmb_drive_state_default();
    a->joint = dmb_joint_state_default();
    a->bit = dmb_bit_state_default();
    a->statistics = dmb_statistics_default();
    for (uint32_t i = 0; i < WHOLE_OUTPUTS; i++) a->outputs[i].quantity = quantities[i];
    a->outputs[0].place = a->outputs[1].place = dmb_station(parts->string, 3, 0.3);
    a->outputs[2].place = dmb_station(parts->feed, 0, 0.0);
    a->outputs[3].place = dmb_station(parts->bit, 0, 0.0);
    a->recorder = dmb_recorder_default();
    a->recorder.outputs = a->outputs;
    a->recorder.output_count = WHOLE_OUTPUTS;
    a->recorder.table = a->table;
    a->recorder.capacity = WHOLE_ROWS;
}

/* The worst status of all queries. */
static inline int32_t whole_ask(const dmb_sim *sim, const whole_parts *parts, whole_answers *a)
{
    const dmb_place middle = dmb_station(parts->string, 3, 0.3);
    int32_t worst = 0;
#define WHOLE_ASK(call)                       \
    do {                                      \
        const int32_t status_ = (call);       \
        if (status_ < worst) worst = status_; \
    } while (0)
    for (uint32_t i = 0; i < WHOLE_PIPES; i++)
        WHOLE_ASK(dmb_query_pose(sim, dmb_station(parts->string, i, 0.7), &a->pose[i]));
    WHOLE_ASK(dmb_query_motion(sim, middle, &a->motion));
    WHOLE_ASK(dmb_query_rotation(sim, middle, &a->rotation));
    WHOLE_ASK(dmb_query_section(sim, middle, &a->section));
    WHOLE_ASK(dmb_query_contact(sim, 0, &a->contact));
    WHOLE_ASK(dmb_query_contact_total(sim, &a->contact_total));
    WHOLE_ASK(dmb_query_kinetic_energy(sim, parts->string, 3, &a->kinetic_energy));
    WHOLE_ASK(dmb_query_energy(sim, &a->energy));
    WHOLE_ASK(dmb_query_momentum(sim, &a->momentum));
    WHOLE_ASK(dmb_query_drive(sim, parts->turning, &a->drive));
    WHOLE_ASK(dmb_query_reaction(sim, parts->second, a->reaction));
    WHOLE_ASK(dmb_query_joint(sim, parts->hinge, &a->joint));
    WHOLE_ASK(dmb_query_multipliers(sim, parts->axle, a->multipliers, &a->multiplier_count));
    WHOLE_ASK(dmb_query_bit(sim, parts->bit, &a->bit));
    WHOLE_ASK(dmb_query_statistics(sim, &a->statistics));
    WHOLE_ASK(dmb_recorder_take(&a->recorder, sim));
#undef WHOLE_ASK
    return worst;
}

#endif
