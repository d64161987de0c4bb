/* The hard scenes of limits.c, beside C, B and R of scenes.h. Each is described, compiled, given a sim and, where it
 * begins at rest, its static start. */
#ifndef BENCH_LIMITS_SCENES_H
#define BENCH_LIMITS_SCENES_H

#include <drillmbd/drillmbd.h>

#include <math.h>
#include <string.h>

#include "answers.h"

enum {
    LIMIT_C,
    LIMIT_B,
    LIMIT_R,
    LIMIT_CHATTER,    /* 99 pipes 1 um above a wall of 1e9 N/m a metre, hard case 1 */
    LIMIT_STICK_SLIP, /* block on a spring, falling branch of Stribeck's law, hard case 2 */
    LIMIT_WITHDRAWAL, /* stop, rest, reverse start of 40 pipes, hard case 13 */
    LIMIT_WHIRL,      /* 4 eccentric pipes, clamped at a turning end, no damping, no gravity */
    LIMIT_PENDULUM,
    LIMIT_FOUR_BARS, /* five equal bars through their change points */
    LIMIT_RATE_BIT,  /* 30 pipes turned slowly, rate law at the bit: it sticks and slips */
    LIMIT_COUNT
};
static const char *const limit_names[LIMIT_COUNT] = {"C",          "B",     "R",        "chatter",   "stick_slip",
                                                     "withdrawal", "whirl", "pendulum", "four_bars", "rate_bit"};
/* [s] of a run, where the steps allowed get that far */
static const double limit_times[LIMIT_COUNT] = {2.0, 2.0, 3.0, 0.25, 3.0, 4.5, 10.0, 10.0, 10.0, 5.0};

typedef struct limit_scene {
    int kind;
    scene tube; /* of C, B, R */
    dmb_model *model;
    dmb_sim *sim;
    int32_t status; /* of the first call that failed */
} limit_scene;

/* ---- Parts: nothing is done once a call has failed -----------------------------------------------------------------
 */

static void limit_note(limit_scene *s, int32_t status)
{
    if (s->status >= 0 && status < 0) s->status = status;
}

static void limit_open(limit_scene *s, double gx, double gz)
{
    dmb_environment_def environment = dmb_environment_def_default();
    environment.gravity[0] = gx;
    environment.gravity[2] = gz;
    limit_note(s, dmb_model_create(NULL, &s->model));
    limit_note(s, dmb_model_set_environment(s->model, &environment));
}

static dmb_id limit_string(limit_scene *s, const dmb_string_def *string, const dmb_pipe_def *pipe, uint32_t count)
{
    dmb_pipe_def own = *pipe;
    limit_note(s, dmb_model_add_string(s->model, string, &own.string));
    limit_note(s, dmb_model_add_pipes(s->model, &own, count, NULL));
    return own.string;
}

/* A sum of cubic steps, each (time, to time, by how much), the first value before. */
static dmb_id limit_time_function(limit_scene *s, double first, const double (*steps)[3], uint32_t count)
{
    dmb_segment terms[4];
    dmb_id id = {0, 0};
    for (uint32_t i = 0; i <= count; ++i) {
        terms[i] = dmb_segment_default();
        if (i == 0) {
            terms[i].h0 = first;
            continue;
        }
        terms[i].kind = DMB_SEGMENT_STEP;
        terms[i].x0 = steps[i - 1][0];
        terms[i].x1 = steps[i - 1][1];
        terms[i].h1 = steps[i - 1][2];
    }
    limit_note(s, dmb_model_add_time_function(s->model, terms, count + 1, &id));
    return id;
}

static void limit_drive(limit_scene *s, dmb_id part, int32_t component, dmb_id time_function)
{
    dmb_drive_def drive = dmb_drive_def_default();
    drive.part = part;
    drive.component = component;
    drive.time_function = time_function;
    limit_note(s, dmb_model_add_drive(s->model, &drive, NULL));
}

static dmb_pipe_def limit_pipe(void)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.length = 1.5;
    pipe.inner_diameter = 0.055;
    return pipe;
}

/* ---- Scenes --------------------------------------------------------------------------------------------------------
 */

static void limit_chatter(limit_scene *s)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = limit_pipe();
    limit_open(s, 0.0, -9.81);
    wall.stiffness = 1e9;
    limit_note(s, dmb_model_add_wall(s->model, &wall, NULL));
    string.start_free = DMB_FREE_ALL;
    string.offset[1] = -(0.5 * (0.094 - 0.073) - 1e-6);
    pipe.damping_time = 5e-4;
    (void)limit_string(s, &string, &pipe, 99);
}

/* 0.5 kg pressed on the floor with 1000 N, drawn at 5 m/s by 73 N/m; mu from 0.3 down to 0.2 within 1 mm/s. */
static void limit_stick_slip(limit_scene *s)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    limit_open(s, 0.0, 0.0);
    wall.diameter = 4.1;
    wall.stiffness = 1e9;
    wall.mu_static = 0.3;
    wall.mu_dynamic = 0.2;
    wall.stribeck_speed = 1e-3;
    wall.smoothing_speed = 1e-4;
    limit_note(s, dmb_model_add_wall(s->model, &wall, NULL));
    body.mass = 0.5;
    body.contact_diameter = 0.1;
    body.position[2] = -(2.0 + 1e-6);
    body.free_mask = DMB_FREE_X | DMB_FREE_Y | DMB_FREE_Z;
    limit_note(s, dmb_model_add_body(s->model, &body, &drive.part));
    load.place = dmb_station(drive.part, 0, 0.0);
    load.force[2] = -1000.0;
    limit_note(s, dmb_model_add_load(s->model, &load, NULL));
    drive.kind = DMB_DRIVE_CONTROL;
    drive.integral_gain = 73.0;
    drive.time_function = limit_time_function(s, 5.0, NULL, 0);
    limit_note(s, dmb_model_add_drive(s->model, &drive, NULL));
}

/* From 18.5 s of the rig's cycle on; scene of physics_hard_withdrawal. */
static void limit_withdrawal(limit_scene *s)
{
    static const double feed = 0.01, turning = 200.0 * BENCH_PI / 30.0;
    const double feeds[][3] = {{0.5, 1.5, -feed}, {2.5, 3.5, -feed}};
    const double turns[][3] = {{0.5, 1.5, -turning}, {2.5, 3.5, -turning}};
    const double loads[][3] = {{0.5, 1.5, -2960.0}};
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    limit_open(s, 0.0, -9.81);
    limit_note(s, dmb_model_add_wall(s->model, &wall, NULL));
    string.velocity[0] = feed;
    string.velocity[3] = turning;
    pipe.damping_time = 1e-4;
    bit.string = limit_string(s, &string, &pipe, 40);
    bit.load = limit_time_function(s, 2960.0, loads, 1);
    limit_note(s, dmb_model_add_bit(s->model, &bit, NULL));
    limit_drive(s, bit.string, DMB_X, limit_time_function(s, feed, feeds, 2));
    limit_drive(s, bit.string, DMB_RX, limit_time_function(s, turning, turns, 2));
}

/* At 90 rpm, below its first critical speed of 110 rpm; nothing damps it but the scheme. */
static void limit_whirl(limit_scene *s)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = limit_pipe();
    const double turning = 90.0 * BENCH_PI / 30.0;
    limit_open(s, 0.0, 0.0);
    string.start_free = DMB_FREE_RX;
    string.velocity[3] = turning;
    pipe.eccentricity = 1e-3;
    const dmb_id id = limit_string(s, &string, &pipe, 4);
    limit_drive(s, id, DMB_RX, limit_time_function(s, turning, NULL, 0));
}

/* A bar of 1 kg in the plane of x and z; reference point in its middle, x along it. */
static dmb_id limit_bar(limit_scene *s, const double from[2], const double to[2], const double velocity[6])
{
    dmb_body_def body = dmb_body_def_default();
    const double dx = to[0] - from[0], dz = to[1] - from[1], length = hypot(dx, dz);
    dmb_id id = {0, 0};
    body.position[0] = 0.5 * (from[0] + to[0]);
    body.position[2] = 0.5 * (from[1] + to[1]);
    body.rotation[1] = -atan2(dz, dx);
    body.inertia[1] = body.inertia[2] = length * length / 12.0;
    if (velocity) memcpy(body.velocity, velocity, sizeof body.velocity);
    limit_note(s, dmb_model_add_body(s->model, &body, &id));
    return id;
}

/* Hinge about -y; a place on the ground is (x, z), on a bar (along it, 0). */
static void limit_hinge(limit_scene *s, dmb_id a, double xa, double za, dmb_id b, double xb)
{
    dmb_joint_def joint = dmb_joint_def_default();
    joint.kind = DMB_JOINT_REVOLUTE;
    joint.place_a = dmb_station(a, 0, 0.0);
    joint.place_b = dmb_station(b, 0, 0.0);
    joint.origin_a[0] = xa;
    joint.origin_a[2] = za;
    joint.origin_b[0] = xb;
    joint.axis_a[0] = joint.axis_b[0] = 0.0;
    joint.axis_a[1] = joint.axis_b[1] = -1.0;
    joint.normal_a[0] = joint.normal_b[0] = 1.0;
    limit_note(s, dmb_model_add_joint(s->model, &joint, NULL));
}

static void limit_pendulum(limit_scene *s)
{
    static const double foot[2] = {0.0, 0.0}, tip[2] = {-1.0, 0.0};
    const dmb_id ground = {0, 0};
    limit_open(s, 0.0, -9.81);
    const dmb_id bar = limit_bar(s, foot, tip, NULL);
    limit_hinge(s, ground, 0.0, 0.0, bar, -0.5);
}

static void limit_four_bars(limit_scene *s)
{
    static const double crank_speed[6] = {0.0, 0.0, -0.5, 0.0, 1.0, 0.0}, coupler_speed[6] = {1.0};
    const dmb_id ground = {0, 0};
    dmb_id bars[5];
    limit_open(s, 0.0, -9.81);
    for (int i = 0; i < 5; ++i) {
        const double x = i < 3 ? i : i - 3, foot[2] = {x, 0.0}, tip[2] = {x, 1.0}, next[2] = {x + 1.0, 1.0};
        bars[i] = i < 3 ? limit_bar(s, foot, tip, crank_speed) : limit_bar(s, tip, next, coupler_speed);
    }
    for (int i = 0; i < 3; ++i) limit_hinge(s, ground, i, 0.0, bars[i], -0.5);
    for (int i = 0; i < 4; ++i) limit_hinge(s, bars[(i + 1) / 2], 0.5, 0.0, bars[3 + i / 2], i % 2 ? 0.5 : -0.5);
}

static void limit_rate_bit(limit_scene *s)
{
    static const double feeds[][3] = {{0.0, 0.5, 2e-3}}, turns[][3] = {{0.0, 0.5, 30.0 * BENCH_PI / 30.0}};
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    limit_open(s, 0.0, -9.81);
    limit_note(s, dmb_model_add_wall(s->model, &wall, NULL));
    bit.string = limit_string(s, &string, &pipe, 30);
    bit.rock_law = DMB_ROCK_RATE;
    limit_note(s, dmb_model_add_bit(s->model, &bit, NULL));
    limit_drive(s, bit.string, DMB_X, limit_time_function(s, 0.0, feeds, 1));
    limit_drive(s, bit.string, DMB_RX, limit_time_function(s, 0.0, turns, 1));
}

/* ---- All -----------------------------------------------------------------------------------------------------------
 */

static void limit_tube(limit_scene *s)
{
    s->tube.kind = s->kind == LIMIT_C ? SCENE_C : s->kind == LIMIT_B ? SCENE_B : SCENE_R;
    s->tube.pipes = 100;
    s->tube.per_pipe = 1;
    s->tube.length = 1.0;
    limit_note(s, scene_open(&s->tube));
    s->model = s->tube.model;
}

static void limit_statics(limit_scene *s)
{
    dmb_static_options options = dmb_static_options_default();
    if (s->kind == LIMIT_WITHDRAWAL) options.slip_axial = 0.01, options.slip_rotation = 200.0 * BENCH_PI / 30.0;
    if (s->kind == LIMIT_R || s->kind == LIMIT_WITHDRAWAL || s->kind == LIMIT_RATE_BIT)
        limit_note(s, dmb_analysis_static(s->sim, &options, NULL));
}

static int32_t limit_start(limit_scene *s, const dmb_sim_options *options)
{
    if (s->status >= 0) limit_note(s, dmb_sim_create(s->model, options, &s->sim));
    if (s->status >= 0) limit_statics(s);
    return s->status;
}

/* [-] C: tip speed of a run that has come to `time`, against d'Alembert's solution; of the others NaN. */
static double limit_error(const limit_scene *s, double time)
{
    double values[2];
    if (s->kind != LIMIT_C || scene_ask(&s->tube, s->sim, values) < 0) return (double)NAN;
    const double exact = exact_tip_speed(s->tube.pipes * s->tube.length, time);
    return fabs(values[0] - exact) / (2.0 * BENCH_PI);
}

/* The model. */
static int32_t limit_make(limit_scene *s, int kind)
{
    static void (*const describe[LIMIT_COUNT])(limit_scene *) = {
        limit_tube,       limit_tube,  limit_tube,     limit_chatter,   limit_stick_slip,
        limit_withdrawal, limit_whirl, limit_pendulum, limit_four_bars, limit_rate_bit};
    memset(s, 0, sizeof *s);
    s->kind = kind;
    describe[kind](s);
    if (kind > LIMIT_R && s->status >= 0) limit_note(s, dmb_model_compile(s->model, NULL));
    return s->status;
}

#endif
