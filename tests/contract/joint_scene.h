/* A scene with joints of every kind at work, for the contract tests: a string in a curved hole on a carriage that a
 * drive feeds, with a controlled rotary head and a centraliser on the hole's axis; a four-bar with springs, stops,
 * friction and a load; gears and a screw; a disc that rolls, a sledge on a knife edge, a ball on the caller's sphere; a
 * pendulum whose elbow is locked, opened and closed by the tests. */
#ifndef DMB_TESTS_JOINT_SCENE_H
#define DMB_TESTS_JOINT_SCENE_H

#include <stdio.h>
#include <string.h>

#include "mechanism.h"

enum { JOINT_SCENE_JOINTS = 32 };

typedef struct joint_scene {
    rig s;
    dmb_id joint[JOINT_SCENE_JOINTS]; /* all of them */
    uint32_t joints;
    dmb_id elbow, feed, turning, push, gear, screw, shell, string;
    int32_t callback_status; /* what the callback returns; not 0: it fails */
} joint_scene;

static inline dmb_id scene_joint(joint_scene *c, const dmb_joint_def *def)
{
    const dmb_id id = add_joint(&c->s, def);
    assert_true(c->joints < JOINT_SCENE_JOINTS);
    c->joint[c->joints++] = id;
    return id;
}

/* Frame b where frame a is, at a place a on the way. */
static inline dmb_joint_def matched(int32_t kind, dmb_id a, dmb_id b)
{
    dmb_joint_def def = dmb_joint_def_default();
    def.kind = kind;
    def.place_a = dmb_station(a, 0, 0.0);
    def.place_b = dmb_station(b, 0, 0.0);
    def.match = 1;
    return def;
}

static inline dmb_id scene_body(joint_scene *c, double x, double y, double z)
{
    dmb_body_def body = dmb_body_def_default();
    body.position[0] = x;
    body.position[1] = y;
    body.position[2] = z;
    body.mass = 2.0;
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.02 + 0.01 * i;
    return add_body(&c->s, &body);
}

static inline dmb_id scene_ramp(joint_scene *c, double h1)
{
    dmb_segment term = dmb_segment_default();
    term.kind = DMB_SEGMENT_STEP;
    term.x0 = 0.002;
    term.x1 = 0.0513;
    term.h1 = h1;
    return add_time_function(&c->s, &term, 1);
}

/* ---- The string and what carries it ------------------------------------------------------------------------------ */

static inline void scene_hole(joint_scene *c)
{
    static const double survey[9] = {0.0, 0.5 * PI, 0.0, 5.0, 0.5 * PI, 0.0, 30.0, 0.5 * PI + 0.2, 0.1};
    dmb_wall_def wall = dmb_wall_def_default();
    wall.survey = survey;
    wall.survey_count = 3;
    (void)add_wall(&c->s, &wall);
}

static inline void scene_string(joint_scene *c)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    def.start_free = DMB_FREE_ALL;
    pipe.damping_time = 1e-5;
    pipe.string = c->string = add_string(&c->s, &def);
    (void)add_pipes(&c->s, &pipe, 6);
}

static inline void scene_carriage(joint_scene *c)
{
    const dmb_id carriage = scene_body(c, -0.5, 0.0, 0.0), head = scene_body(c, -0.2, 0.0, 0.0);
    dmb_joint_def def = matched(DMB_JOINT_PRISMATIC, ground_id, carriage);
    const dmb_id rail = scene_joint(c, &def);
    def = matched(DMB_JOINT_REVOLUTE, carriage, head);
    const dmb_id spindle = scene_joint(c, &def);
    def = matched(DMB_JOINT_FIXED, head, c->string);
    (void)scene_joint(c, &def);
    dmb_drive_def drive = dmb_drive_def_default();
    drive.part = rail;
    drive.time_function = scene_ramp(c, 0.02);
    c->feed = add_drive(&c->s, &drive);
    drive.kind = DMB_DRIVE_CONTROL;
    drive.part = spindle;
    drive.component = DMB_RX;
    drive.time_function = scene_ramp(c, 5.0);
    drive.gain = 200.0;
    drive.integral_gain = 400.0;
    drive.limit_low = -300.0;
    drive.limit_high = 300.0;
    c->turning = add_drive(&c->s, &drive);
}

static inline void scene_centraliser(joint_scene *c)
{
    dmb_joint_def def = dmb_joint_def_default();
    const dmb_id ring = scene_body(c, 4.5, 0.0, 0.0);
    def.kind = DMB_JOINT_POINT_ON_HOLE;
    def.place_b = dmb_station(ring, 0, 0.0);
    (void)scene_joint(c, &def);
    def = matched(DMB_JOINT_REVOLUTE, c->string, ring);
    def.place_a = dmb_station(c->string, 3, 0.0);
    (void)scene_joint(c, &def);
}

/* ---- Mechanisms beside it ---------------------------------------------------------------------------------------- */

static inline void scene_four_bar(joint_scene *c)
{
    const bar left = {{0.0, 2.0}, {0.0, 3.0}, 1.0}, top = {{0.0, 3.0}, {2.0, 3.4}, 1.0},
              right = {{2.2, 2.0}, {2.0, 3.4}, 1.0};
    const double half[2] = {0.5 * sqrt(4.16), 0.5 * sqrt(2.0)};
    const dmb_id a = add_bar(&c->s, &left), b = add_bar(&c->s, &top), d = add_bar(&c->s, &right);
    dmb_joint_def def = hinge_of("crank", DMB_JOINT_REVOLUTE, pin_ground(0.0, 2.0), pin_on(a, -0.5));
    def.stiffness[DMB_RX] = 30.0;
    def.rest[DMB_RX] = 1.0;
    def.damping[DMB_RX] = 0.5;
    def.friction[DMB_RX] = 0.4;
    def.stop_high[DMB_RX] = 1.65;
    def.stop_damping = 50.0;
    const dmb_id crank = scene_joint(c, &def);
    def = hinge_of("", DMB_JOINT_SPHERICAL, pin_on(a, 0.5), pin_on(b, -half[0]));
    (void)scene_joint(c, &def);
    def = hinge_of("", DMB_JOINT_UNIVERSAL, pin_on(b, half[0]), pin_on(d, half[1]));
    def.axis_a[0] = def.axis_b[0] = 1.0, def.axis_a[1] = def.axis_b[1] = 0.0;
    def.normal_a[0] = def.normal_b[0] = 0.0, def.normal_a[1] = def.normal_b[1] = 1.0;
    (void)scene_joint(c, &def);
    def = hinge_of("", DMB_JOINT_CYLINDRICAL, pin_ground(2.2, 2.0), pin_on(d, -half[1]));
    (void)scene_joint(c, &def);
    c->push = add_simple_drive(&c->s, DMB_DRIVE_LOAD, crank, DMB_RX, scene_ramp(c, 12.0));
}

static inline void scene_gears(joint_scene *c)
{
    dmb_coupling_def gear = dmb_coupling_def_default();
    for (int i = 0; i < 2; i++) {
        dmb_joint_def def = matched(DMB_JOINT_REVOLUTE, ground_id, scene_body(c, 0.0, 3.0 + i, 0.0));
        def.origin_a[1] = 3.0 + i;
        def.initial_mask = i == 0 ? DMB_FREE_RX : DMB_FREE_NONE;
        def.initial_speed[DMB_RX] = 3.0;
        gear.joint[i] = scene_joint(c, &def);
    }
    gear.ratio = -2.0;
    must_model(&c->s, dmb_model_add_coupling(c->s.model, &gear, &c->gear));
    dmb_joint_def def = matched(DMB_JOINT_CYLINDRICAL, ground_id, scene_body(c, 0.0, 5.0, 0.0));
    def.origin_a[1] = 5.0;
    def.axis_a[0] = 0.0;
    def.axis_a[2] = -1.0;
    gear.joint[0] = gear.joint[1] = scene_joint(c, &def);
    gear.component[0] = DMB_X;
    gear.ratio = 0.05 / (2.0 * PI);
    must_model(&c->s, dmb_model_add_coupling(c->s.model, &gear, &c->screw));
}

static inline int32_t scene_sphere(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                                   double *jacobian)
{
    const double *x = poses[0];
    const joint_scene *c = (const joint_scene *)context;
    (void)time, (void)count, (void)jacobian;
    value[0] = 0.5 * (x[0] * x[0] + (x[1] - 7.0) * (x[1] - 7.0) + x[2] * x[2] - 1.0);
    return c->callback_status;
}

static inline void scene_rolling(joint_scene *c)
{
    dmb_body_def body = dmb_body_def_default();
    body.position[1] = 9.0;
    body.position[2] = 0.3;
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.03;
    body.velocity[0] = 0.5;
    body.velocity[4] = 0.5 / 0.3;
    dmb_joint_def def = dmb_joint_def_default();
    def.kind = DMB_JOINT_ROLLING;
    def.place_b = dmb_station(add_body(&c->s, &body), 0, 0.0);
    def.axis_a[0] = 0.0, def.axis_a[2] = 1.0; /* the plane z = 0 */
    def.axis_b[0] = 0.0, def.axis_b[1] = 1.0;
    def.length = 0.3;
    (void)scene_joint(c, &def);
    body.position[1] = 11.0;
    body.position[2] = 0.0;
    def = dmb_joint_def_default();
    def.kind = DMB_JOINT_PLANAR;
    def.place_b = dmb_station(add_body(&c->s, &body), 0, 0.0);
    def.axis_a[0] = def.axis_b[0] = 0.0, def.axis_a[2] = def.axis_b[2] = 1.0;
    (void)scene_joint(c, &def);
    def = dmb_joint_def_default();
    def.kind = DMB_JOINT_KNIFE_EDGE;
    def.place_b = dmb_station(add_body(&c->s, &body), 0, 0.0); /* a knife that falls: another body */
    (void)scene_joint(c, &def);
}

static inline void scene_shell(joint_scene *c)
{
    dmb_constraint_def def = dmb_constraint_def_default();
    (void)snprintf(def.name, sizeof def.name, "shell");
    def.place[0] = dmb_station(scene_body(c, 1.0, 7.0, 0.0), 0, 0.0);
    def.callback = scene_sphere;
    def.callback_context = c;
    must_model(&c->s, dmb_model_add_constraint(c->s.model, &def, &c->shell));
}

static inline void scene_pendulum(joint_scene *c)
{
    const bar first = {{0.0, -2.0}, {0.8, -2.0}, 1.5}, second = {{0.8, -2.0}, {1.6, -2.0}, 1.5};
    const dmb_id a = add_bar(&c->s, &first), b = add_bar(&c->s, &second), last = scene_body(c, 2.5, 0.0, -2.0);
    dmb_joint_def def = hinge_of("", DMB_JOINT_REVOLUTE, pin_ground(0.0, -2.0), pin_on(a, -0.4));
    (void)scene_joint(c, &def);
    def = hinge_of("elbow", DMB_JOINT_REVOLUTE, pin_on(a, 0.4), pin_on(b, -0.4));
    c->elbow = scene_joint(c, &def);
    def = hinge_of("", DMB_JOINT_DISTANCE, pin_on(b, 0.4), pin_on(last, 0.0));
    def.length = 0.9;
    (void)scene_joint(c, &def);
    def = matched(DMB_JOINT_FREE, ground_id, last);
    def.damping[DMB_Y] = 1.0;
    def.friction[DMB_Z] = 1.0;
    (void)scene_joint(c, &def);
}

/* ---- The whole --------------------------------------------------------------------------------------------------- */

/* The scene must stay where it is: its callback looks at it. */
static inline void joint_scene_describe(joint_scene *c)
{
    dmb_environment_def environment = dmb_environment_def_default();
    must_model(&c->s, dmb_model_set_environment(c->s.model, &environment));
    scene_hole(c);
    scene_string(c);
    scene_carriage(c);
    scene_centraliser(c);
    scene_four_bar(c);
    scene_gears(c);
    scene_rolling(c);
    scene_shell(c);
    scene_pendulum(c);
    must_model(&c->s, dmb_model_compile(c->s.model, NULL));
}

static inline void joint_scene_open(joint_scene *c, const dmb_model_options *options)
{
    memset(c, 0, sizeof *c);
    assert_int_equal(dmb_model_create(options, &c->s.model), DMB_OK);
    joint_scene_describe(c);
}

static inline dmb_sim_options scene_options(int32_t method)
{
    dmb_sim_options options = dmb_sim_options_default();
    options.constraint_method = method;
    return options;
}

#endif
