/* Small scenes that have something in every field of a snapshot between them, a step of some 20 us: a string in a
 * curved hole with all that rubs, drills, sticks, is set and is waited for; joints of many kinds with dense clusters,
 * the same with sparse ones; a string that cuts sideways. A failing call ends the program: for tests and fuzz targets.
 */
#ifndef DMB_TESTS_SAVED_SCENES_H
#define DMB_TESTS_SAVED_SCENES_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drillmbd/drillmbd.h"
#include "model/model.h"

enum { SAVED_STRING = 0, SAVED_JOINTS = 1, SAVED_SPARSE = 2, SAVED_SIDEWAYS = 3, SAVED_SCENES = 4 };

typedef struct saved_scene {
    dmb_model *model;
    dmb_id string, turning, event; /* of those that have one */
} saved_scene;

#define SAVED_MUST(scene, call)                                                                               \
    do {                                                                                                      \
        const int32_t status_ = (call);                                                                       \
        if (status_ < 0) {                                                                                    \
            fprintf(stderr, "%s:%d: %s: %s\n", __FILE__, __LINE__, #call, dmb_model_message((scene)->model)); \
            abort();                                                                                          \
        }                                                                                                     \
    } while (0)

static inline dmb_id saved_constant(saved_scene *s, double value)
{
    dmb_segment term = dmb_segment_default();
    dmb_id id;
    term.h0 = value;
    SAVED_MUST(s, dmb_model_add_time_function(s->model, &term, 1, &id));
    return id;
}

static inline dmb_id saved_ramp(saved_scene *s, double x0, double x1, double h1)
{
    dmb_segment term = dmb_segment_default();
    dmb_id id;
    term.kind = DMB_SEGMENT_STEP;
    term.x0 = x0;
    term.x1 = x1;
    term.h1 = h1;
    SAVED_MUST(s, dmb_model_add_time_function(s->model, &term, 1, &id));
    return id;
}

static inline void saved_name(char name[24], const char *text)
{
    (void)snprintf(name, 24, "%s", text);
}

/* ---- A string and all that it meets ------------------------------------------------------------------------------ */

static inline void saved_hole(saved_scene *s)
{
    static const double survey[12] = {0.0, 1.5, 0.0, 1.5, 1.5, 0.0, 2.5, 1.55, 0.02, 9.0, 1.6, 0.02};
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_wall_def wall = dmb_wall_def_default();
    environment.fluid_density = 1000.0;
    environment.lateral_damping = environment.axial_damping = 2.0;
    environment.torsional_damping = 0.1;
    wall.survey = survey;
    wall.survey_count = 4;
    wall.normal_law = DMB_NORMAL_EXACT;
    wall.friction_law = DMB_FRICTION_BRISTLE;
    SAVED_MUST(s, dmb_model_set_environment(s->model, &environment));
    SAVED_MUST(s, dmb_model_add_wall(s->model, &wall, NULL));
}

static inline void saved_pipes(saved_scene *s)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_stabiliser_def ring = dmb_stabiliser_def_default();
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    SAVED_MUST(s, dmb_model_add_pipes(s->model, &pipe, 1, &s->string));
    pipe.kind = DMB_PIPE_FLEXIBLE;
    pipe.damping_time = 1e-5;
    pipe.eccentricity = 1e-3;
    SAVED_MUST(s, dmb_model_add_pipes(s->model, &pipe, 1, NULL));
    pipe.contact_points = 3;
    SAVED_MUST(s, dmb_model_add_pipes(s->model, &pipe, 1, NULL));
    ring.pipe = 2;
    ring.fraction = 0.4;
    SAVED_MUST(s, dmb_model_add_stabiliser(s->model, &ring, NULL));
}

static inline void saved_feed(saved_scene *s, dmb_id part)
{
    dmb_drive_def feed = dmb_drive_def_default();
    feed.part = part;
    feed.time_function = saved_ramp(s, 0.0, 0.02, 0.05);
    SAVED_MUST(s, dmb_model_add_drive(s->model, &feed, NULL));
}

/* The rotation head is an actuator with all that it can have. */
static inline void saved_head(saved_scene *s, dmb_id part)
{
    dmb_drive_def head = dmb_drive_def_default();
    head.part = part;
    head.component = DMB_RX;
    head.kind = DMB_DRIVE_CONTROL;
    head.gain = 200.0;
    head.integral_gain = 50.0;
    head.limit_low = -3000.0;
    head.limit_high = 3000.0;
    head.time_function = saved_ramp(s, 0.0, 0.02, 10.0);
    head.delay = 2e-3;
    head.lag = 1e-3;
    head.force_rate = 1e6;
    head.back_drag = 1.0;
    head.curve_count = 2;
    head.curve_speed[1] = 30.0;
    head.curve_force[0] = 3000.0;
    head.curve_force[1] = 500.0;
    SAVED_MUST(s, dmb_model_add_drive(s->model, &head, &s->turning));
}

static inline dmb_id saved_bit(saved_scene *s)
{
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_id id;
    bit.rock_law = DMB_ROCK_REGENERATIVE;
    bit.string = s->string;
    bit.load = saved_constant(s, 1000.0);
    bit.history = 64;
    SAVED_MUST(s, dmb_model_add_bit(s->model, &bit, &id));
    return id;
}

static inline dmb_id saved_load(saved_scene *s)
{
    dmb_load_def load = dmb_load_def_default();
    dmb_id id;
    load.place = dmb_station(s->string, 1, 0.6);
    load.force[2] = -20.0;
    SAVED_MUST(s, dmb_model_add_load(s->model, &load, &id));
    return id;
}

static inline dmb_id saved_stuck(saved_scene *s)
{
    dmb_stuck_def stuck = dmb_stuck_def_default();
    dmb_id id;
    stuck.place = dmb_station(s->string, 2, 0.8);
    stuck.overpull = 1e6;
    SAVED_MUST(s, dmb_model_add_stuck(s->model, &stuck, &id));
    return id;
}

static inline int32_t saved_push(void *context, double time, uint32_t count, const double (*poses)[12],
                                 const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                                 const dmb_law_memory *memory)
{
    (void)memory;
    (void)context, (void)time, (void)count, (void)velocities, (void)tangent;
    forces[0][2] = -3.0;
    *potential = 3.0 * poses[0][2];
    return 0;
}

/* A law with a state: a force of at most 1 N that follows it. */
static inline int32_t saved_law(void *context, double time, uint32_t count, const double (*poses)[12],
                                const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                                const dmb_law_memory *memory)
{
    (void)context, (void)time, (void)count, (void)poses, (void)velocities, (void)tangent, (void)potential;
    for (int i = 0; i < 6; i++) forces[0][i] = 0.0;
    forces[0][1] = fmin(1.0, fmax(-1.0, memory->accepted[0]));
    memory->trial[0] = 0.5 * memory->accepted[0] + 0.1;
    return 0;
}

static inline void saved_force(saved_scene *s, dmb_id part, uint32_t pipe)
{
    dmb_force_def force = dmb_force_def_default(), law = dmb_force_def_default();
    law.place[0] = dmb_station(part, pipe, 0.0);
    law.state_count = 1;
    law.callback = saved_law;
    SAVED_MUST(s, dmb_model_add_force(s->model, &law, NULL));
    force.place[0] = dmb_station(part, pipe, 0.0);
    force.provides = DMB_PROVIDES_POTENTIAL;
    force.callback = saved_push;
    SAVED_MUST(s, dmb_model_add_force(s->model, &force, NULL));
}

static inline void saved_input(saved_scene *s, int32_t target, dmb_id part)
{
    dmb_input_def input = dmb_input_def_default();
    (void)snprintf(input.name, sizeof input.name, "target %d", (int)target);
    input.target = target;
    input.part = part;
    if (target == DMB_TARGET_SET_POINT) input.rate_limit = 500.0, input.slope_limit = 1e5;
    SAVED_MUST(s, dmb_model_add_input(s->model, &input, NULL));
}

static inline void saved_inputs(saved_scene *s, dmb_id bit, dmb_id load, dmb_id stuck)
{
    const dmb_id none = {0, 0};
    for (int32_t target = 0; target < DMB_TARGET_FLOW_RATE; target++) {
        const dmb_id part = target <= DMB_TARGET_LIMIT_HIGH    ? s->turning
                            : target == DMB_TARGET_LOAD_FACTOR ? load
                            : target == DMB_TARGET_BIT_LOAD    ? bit
                            : target == DMB_TARGET_STUCK       ? stuck
                                                               : none;
        saved_input(s, target, part);
    }
}

static inline void saved_events(saved_scene *s, dmb_id place, int32_t quantity)
{
    dmb_event_def event = dmb_event_def_default();
    saved_name(event.name, "first");
    event.output.quantity = quantity;
    event.output.place = dmb_station(place, 0, 0.0);
    event.level = 0.3;
    SAVED_MUST(s, dmb_model_add_event(s->model, &event, &s->event));
    saved_name(event.name, "held");
    event.hold = 2e-3;
    event.level = 0.1;
    SAVED_MUST(s, dmb_model_add_event(s->model, &event, NULL));
}

static inline void saved_describe_string(saved_scene *s)
{
    saved_hole(s);
    saved_pipes(s);
    const dmb_id bit = saved_bit(s);
    saved_feed(s, s->string);
    saved_head(s, s->string);
    const dmb_id load = saved_load(s), stuck = saved_stuck(s);
    saved_force(s, s->string, 2);
    saved_inputs(s, bit, load, stuck);
    saved_events(s, s->turning, DMB_OUTPUT_DRIVE_SPEED);
}

/* ---- Joints ------------------------------------------------------------------------------------------------------ */

static inline dmb_id saved_body(saved_scene *s, double x, double y)
{
    dmb_body_def body = dmb_body_def_default();
    dmb_id id;
    body.position[0] = x;
    body.position[1] = y;
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.02;
    SAVED_MUST(s, dmb_model_add_body(s->model, &body, &id));
    return id;
}

static inline dmb_joint_def saved_joint(int32_t kind, dmb_id a, dmb_id b)
{
    dmb_joint_def joint = dmb_joint_def_default();
    joint.kind = kind;
    joint.place_a = dmb_station(a, 0, 0.0);
    joint.place_b = dmb_station(b, 0, 0.0);
    joint.match = 1;
    return joint;
}

static inline dmb_id saved_add_joint(saved_scene *s, const dmb_joint_def *joint)
{
    dmb_id id;
    SAVED_MUST(s, dmb_model_add_joint(s->model, joint, &id));
    return id;
}

static inline int32_t saved_level(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                                  double *jacobian)
{
    (void)context, (void)time, (void)count, (void)jacobian;
    value[0] = poses[0][1] - 2.0;
    return 0;
}

/* A carriage that is fed, a spindle that is turned through an actuator, a screw, a pendulum with spring, stop and
 * friction, of which one joint is locked and one is open, and a body led along the hole. */
static inline void saved_describe_joints(saved_scene *s)
{
    const dmb_id ground = {0, 0}, carriage = saved_body(s, 0.0, 1.0), spindle = saved_body(s, 0.2, 1.0),
                 nut = saved_body(s, 0.4, 1.0), arm = saved_body(s, 0.0, 2.0), hand = saved_body(s, 0.5, 2.0),
                 led = saved_body(s, 2.0, 0.0);
    dmb_coupling_def screw = dmb_coupling_def_default();
    dmb_constraint_def level = dmb_constraint_def_default();
    saved_hole(s);
    dmb_joint_def joint = saved_joint(DMB_JOINT_PRISMATIC, ground, carriage);
    saved_feed(s, saved_add_joint(s, &joint));
    joint = saved_joint(DMB_JOINT_REVOLUTE, carriage, spindle);
    saved_head(s, saved_add_joint(s, &joint));
    joint = saved_joint(DMB_JOINT_CYLINDRICAL, spindle, nut);
    screw.joint[0] = screw.joint[1] = saved_add_joint(s, &joint);
    screw.component[0] = DMB_X;
    screw.ratio = 0.01;
    SAVED_MUST(s, dmb_model_add_coupling(s->model, &screw, NULL));
    joint = saved_joint(DMB_JOINT_UNIVERSAL, ground, arm);
    joint.origin_a[0] = -0.5, joint.origin_a[1] = 2.0;
    joint.stiffness[DMB_RY] = 30.0;
    joint.friction[DMB_RZ] = 0.1;
    joint.stop_high[DMB_RY] = 0.05;
    joint.stop_stiffness = 100.0;
    (void)saved_add_joint(s, &joint);
    joint = saved_joint(DMB_JOINT_SPHERICAL, arm, hand);
    joint.state = DMB_JOINT_LOCKED;
    (void)saved_add_joint(s, &joint);
    joint = saved_joint(DMB_JOINT_FIXED, ground, hand);
    joint.state = DMB_JOINT_OPEN;
    (void)saved_add_joint(s, &joint);
    level.place[0] = dmb_station(hand, 0, 0.0);
    level.callback = saved_level;
    SAVED_MUST(s, dmb_model_add_constraint(s->model, &level, NULL));
    joint = dmb_joint_def_default();
    joint.kind = DMB_JOINT_POINT_ON_HOLE;
    joint.place_b = dmb_station(led, 0, 0.0);
    (void)saved_add_joint(s, &joint);
    saved_force(s, hand, 0);
    saved_input(s, DMB_TARGET_SET_POINT, s->turning);
    saved_events(s, s->turning, DMB_OUTPUT_DRIVE_SPEED);
}

/* ---- Sideways ---------------------------------------------------------------------------------------------------- */

/* In a straight hole, with pipes on its axis and a bit that cuts sideways beyond it and leaves a wider hole. */
static inline void saved_describe_sideways(saved_scene *s)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    wall.normal_law = DMB_NORMAL_KELVIN_VOIGT;
    wall.cut_spacing = 0.1;
    wall.cut_end = 4.0;
    SAVED_MUST(s, dmb_model_add_wall(s->model, &wall, NULL));
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    SAVED_MUST(s, dmb_model_add_pipes(s->model, &pipe, 2, &s->string));
    pipe.kind = DMB_PIPE_FLEXIBLE;
    SAVED_MUST(s, dmb_model_add_pipes(s->model, &pipe, 1, NULL));
    bit.rock_law = DMB_ROCK_RATE;
    bit.diameter = 0.0;
    bit.side_cutting = 0.1;
    bit.walk_angle = 0.2;
    SAVED_MUST(s, dmb_model_add_bit(s->model, &bit, NULL));
    drive.time_function = saved_constant(s, 0.0);
    SAVED_MUST(s, dmb_model_add_drive(s->model, &drive, NULL));
    drive.component = DMB_RX;
    drive.time_function = saved_ramp(s, 0.0, 0.02, 10.0);
    SAVED_MUST(s, dmb_model_add_drive(s->model, &drive, &s->turning));
}

/* ---- The whole --------------------------------------------------------------------------------------------------- */

static inline saved_scene saved_scene_open(int which)
{
    saved_scene s;
    memset(&s, 0, sizeof s);
    SAVED_MUST(&s, dmb_model_create(NULL, &s.model));
    if (which == SAVED_SPARSE) s.model->sparse_nodes = 2;
    if (which == SAVED_STRING) saved_describe_string(&s);
    if (which == SAVED_JOINTS || which == SAVED_SPARSE) saved_describe_joints(&s);
    if (which == SAVED_SIDEWAYS) saved_describe_sideways(&s);
    SAVED_MUST(&s, dmb_model_compile(s.model, NULL));
    return s;
}

/* Steps that do not converge end soon. */
static inline dmb_sim *saved_sim(const saved_scene *s)
{
    dmb_sim_options options = dmb_sim_options_default();
    dmb_sim *sim = NULL;
    options.max_iterations = 5;
    options.max_cuts = 1;
    options.max_steps = 3;
    SAVED_MUST(s, dmb_sim_create(s->model, &options, &sim));
    return sim;
}

/* So far that contacts are closed, factors reused and an input on its way. */
static inline void saved_run(const saved_scene *s, dmb_sim *sim)
{
    dmb_id input;
    for (int i = 0; i < 12; i++) {
        if (i == 6 && dmb_model_find_input(s->model, "target 0", &input) >= 0)
            SAVED_MUST(s, dmb_sim_set_input(sim, input, 3.0));
        SAVED_MUST(s, dmb_sim_step(sim, 5e-4, NULL));
    }
    if (s->event.generation != 0) SAVED_MUST(s, dmb_sim_advance_to_event(sim, dmb_sim_time(sim) + 1e-3, NULL, NULL));
}

#endif
