#include "scene_draw.h"

#include <math.h>
#include <string.h>

enum {
    TOPIC_FAMILY,
    TOPIC_RUN,
    TOPIC_MUD,
    TOPIC_HOLE,
    TOPIC_STRING,
    TOPIC_PIPE,
    TOPIC_JOINT,
    TOPIC_DRIVE,
    TOPIC_LOAD,
    TOPIC_BODY,
    TOPIC_BIT,
    TOPIC_MOTION
};

/* ---- Tools ------------------------------------------------------------------------------------------------------ */

static stream topic_of(const scene *s, uint32_t topic)
{
    return stream_of(s->seed, s->number, topic);
}

static void scaled(double size, const double unit[3], double out[3])
{
    for (int i = 0; i < 3; ++i) out[i] = size * unit[i];
}

/* ---- Time functions -------------------------------------------------------------------------------------------------
 */

static time_function_data constant(double value)
{
    time_function_data p = {1, {dmb_segment_default(), dmb_segment_default()}};
    p.term[0].h0 = value;
    return p;
}

/* From 0 to value in the first `time` seconds. */
static time_function_data run_up(double value, double time)
{
    time_function_data p = constant(0.0);
    p.term[0].kind = DMB_SEGMENT_STEP;
    p.term[0].x1 = time;
    p.term[0].h1 = value;
    return p;
}

time_function_data time_function_step(double c, double more, double begin, double time)
{
    time_function_data p = constant(c);
    p.terms = 2;
    p.term[1].kind = DMB_SEGMENT_STEP5;
    p.term[1].x0 = begin;
    p.term[1].x1 = begin + time;
    p.term[1].h1 = more;
    return p;
}

static time_function_data shaken(double value, double part, double omega)
{
    time_function_data p = constant(value);
    p.terms = 2;
    p.term[1].kind = DMB_SEGMENT_HARMONIC;
    p.term[1].h1 = part * value;
    p.term[1].omega = omega;
    return p;
}

/* ---- Surroundings ----------------------------------------------------------------------------------------------- */

static void draw_mud(scene *s, uint32_t flags)
{
    stream t = topic_of(s, TOPIC_MUD);
    dmb_environment_def *const e = &s->environment;
    const double drag = flags & WISH_DAMPED ? draw_size(&t, 20.0, 200.0) : fmax(0.0, draw_number(&t, -50.0, 50.0));
    *e = dmb_environment_def_default();
    e->fluid_density = fmax(0.0, draw_number(&t, -1500.0, 1500.0));
    e->lateral_damping = drag;
    e->axial_damping = flags & WISH_DAMPED ? drag : 0.1 * drag;
    e->torsional_damping = flags & WISH_DAMPED ? 0.1 * drag : 1e-3 * drag;
}

/* Straight for a tenth of the length, then bent all along in one direction, by 50 degrees at most. */
static void draw_survey(scene *s, stream *t, double inclination, double length)
{
    const double straight = 0.1 * length, bend = fmin(draw_size(t, 1e-3, 1.0 / 30.0), 50.0 * PI / 180.0 / length);
    const double side = draw_number(t, -PI, PI);
    s->survey_count = SCENE_SURVEY;
    for (int i = 0; i < SCENE_SURVEY; ++i) {
        const double depth = i > 0 ? straight + (i - 1) * (length - straight) / (SCENE_SURVEY - 2) : 0.0;
        const double turned = bend * fmax(0.0, depth - straight);
        s->survey[i][0] = depth;
        s->survey[i][1] = 0.5 * PI + inclination + turned * cos(side);
        s->survey[i][2] = turned * sin(side);
    }
}

static void draw_wall(scene *s, uint32_t flags, double outer, double length)
{
    stream t = topic_of(s, TOPIC_HOLE);
    dmb_wall_def *const w = &s->wall;
    const double inclination = draw_number(&t, -30.0, 30.0) * PI / 180.0;
    const int32_t law = (int32_t)draw_count(&t, 0, 5), friction = (int32_t)draw_count(&t, 0, 4) - 1;
    s->has_wall = 1;
    *w = dmb_wall_def_default();
    w->direction[0] = cos(inclination);
    w->direction[2] = sin(inclination);
    for (int i = 0; i < 3; ++i) w->origin[i] = draw_number(&t, -2.0, 2.0);
    w->diameter = outer + 2.0 * draw_number(&t, 0.003, 0.040);
    w->normal_law = flags & WISH_HARD ? DMB_NORMAL_KELVIN_VOIGT : law;
    w->stiffness = draw_size(&t, 1e5, flags & WISH_STILL ? 1e7 : 1e9);
    w->restitution = draw_number(&t, 0.1, 0.9);
    w->damping = 0.3 * sqrt(w->stiffness * 15.0); /* of a pipe's metre on a linear spring */
    w->friction_law = flags & (WISH_NO_FRICTION | WISH_CONSERVATIVE) ? DMB_FRICTION_NONE : friction;
    w->mu_static = draw_number(&t, 0.0, 0.6);
    w->mu_dynamic = 0.85 * w->mu_static;
    if (s->family == FAMILY_BENT) draw_survey(s, &t, inclination, length + 2.0);
}

/* ---- Strings ---------------------------------------------------------------------------------------------------- */

static int32_t draw_kind(scene *s, stream *t, uint32_t flags)
{
    const double u = draw_number(t, 0.0, 1.0);
    const int alone = flags & WISH_FLEXIBLE || s->family == FAMILY_STABILISER;
    if (alone || u < 0.8) return DMB_PIPE_FLEXIBLE;
    if (u < 0.9) return s->family & (FAMILY_HOLE | FAMILY_BENT) ? DMB_PIPE_AXIAL_TORSIONAL : DMB_PIPE_FLEXIBLE;
    return s->family == FAMILY_BENT ? DMB_PIPE_FLEXIBLE : DMB_PIPE_RIGID; /* would not fit into a bent hole */
}

/* The pipes of a scene have one make; eccentricity, its angle and the damping are each pipe's own. */
static dmb_pipe_def draw_make(scene *s, uint32_t flags)
{
    stream t = topic_of(s, TOPIC_STRING);
    dmb_pipe_def p = dmb_pipe_def_default();
    p.kind = draw_kind(s, &t, flags);
    p.length = draw_number(&t, 0.75, 3.0);
    p.outer_diameter = draw_number(&t, 0.042, 0.089);
    p.inner_diameter = p.outer_diameter - 2.0 * draw_number(&t, 0.004, 0.012);
    p.elements = draw_count(&t, 1, 3);
    if (draw_chance(&t, 0.3)) p.joint_length = 0.1 * p.length;
    if (p.joint_length > 0.0) p.joint_outer_diameter = p.outer_diameter * draw_number(&t, 1.0, 1.05);
    p.damping_time = flags & WISH_DAMPED ? 1e-3 : draw_chance(&t, 0.5) ? 0.0 : 1e-4;
    return p;
}

static void draw_pipes(scene *s, uint32_t k, uint32_t count, const dmb_pipe_def *make, uint32_t flags)
{
    stream t = stream_of(s->seed, s->number, TOPIC_PIPE + 1000 * (k + 1));
    s->string[k].pipes = count;
    for (uint32_t i = 0; i < count; ++i) {
        dmb_pipe_def *const p = &s->string[k].pipe[i];
        *p = *make;
        p->eccentricity = flags & WISH_ROUND ? 0.0 : draw_number(&t, 0.0, 2e-3);
        p->eccentricity_angle = draw_number(&t, -PI, PI);
        s->span += p->length;
    }
}

static void draw_springs(stream *t, int32_t kind, uint32_t flags, dmb_joint_def *j)
{
    const double sliding = draw_size(t, 1e4, 1e8), twisting = draw_size(t, 1e2, 1e6);
    const double bending = draw_chance(t, 0.4) && !(flags & WISH_ELASTIC) ? 0.0 : draw_size(t, 1e2, 1e6);
    if (kind == DMB_JOINT_PRISMATIC || kind == DMB_JOINT_CYLINDRICAL) j->stiffness[DMB_X] = sliding;
    if (kind == DMB_JOINT_REVOLUTE || kind == DMB_JOINT_CYLINDRICAL || kind == DMB_JOINT_SPHERICAL)
        j->stiffness[DMB_RX] = twisting;
    if (kind == DMB_JOINT_UNIVERSAL || kind == DMB_JOINT_SPHERICAL)
        j->stiffness[DMB_RY] = j->stiffness[DMB_RZ] = bending;
    for (int i = 0; i < 6; ++i) j->damping[i] = (flags & WISH_DAMPED ? 1e-2 : 1e-3) * j->stiffness[i];
}

static joint_data *new_joint(scene *s, part_ref a, part_ref b)
{
    joint_data *const j = &s->joint[s->joints++];
    j->def = dmb_joint_def_default();
    j->def.match = 1;
    j->def.normal_a[1] = 1.0;
    j->a = a;
    j->b = b;
    return j;
}

static part_ref string_place(uint32_t string, uint32_t pipe, double fraction)
{
    const part_ref r = {PART_STRING, string, pipe, fraction};
    return r;
}

static part_ref body_place(uint32_t body)
{
    const part_ref r = {PART_BODY, body, 0, 0.0};
    return r;
}

/* The end of the string before and the start of string k. */
static void join_strings(scene *s, uint32_t k, stream *t, uint32_t flags)
{
    static const int32_t kinds[] = {DMB_JOINT_FIXED,       DMB_JOINT_REVOLUTE,  DMB_JOINT_PRISMATIC,
                                    DMB_JOINT_CYLINDRICAL, DMB_JOINT_UNIVERSAL, DMB_JOINT_SPHERICAL};
    joint_data *const j = new_joint(s, string_place(k - 1, s->string[k - 1].pipes - 1, 1.0), string_place(k, 0, 0.0));
    j->def.kind = kinds[draw_count(t, 0, 5)];
    draw_springs(t, j->def.kind, flags, &j->def);
}

/* Where string k begins, `before` metres from the rig end of the first, which stands at x with its axis along `axis`.
 */
static void draw_start(scene *s, uint32_t k, double before, const double x[3], const double rotation[3],
                       const double axis[3])
{
    dmb_string_def *const d = &s->string[k].def;
    *d = dmb_string_def_default();
    if (k > 0) d->start_free = DMB_FREE_ALL;
    d->start_depth = before;
    for (int i = 0; i < 3; ++i) {
        d->position[i] = x[i] + before * axis[i];
        d->rotation[i] = rotation[i];
    }
}

static uint32_t draw_joint_count(const scene *s, stream *t, const dmb_pipe_def *make, uint32_t flags)
{
    uint32_t count = draw_chance(t, 0.5) ? 0 : draw_count(t, 1, SCENE_STRINGS - 1);
    if (flags & WISH_JOINTS && count == 0) count = 1;
    if (flags & WISH_NO_JOINTS || (make->kind == DMB_PIPE_AXIAL_TORSIONAL && s->family == FAMILY_BENT)) count = 0;
    return count;
}

/* Strings in a row, joined. */
static void draw_strings(scene *s, const scene_wish *wish, const double x[3], const double rotation[3],
                         const double axis[3])
{
    stream t = topic_of(s, TOPIC_JOINT);
    const dmb_pipe_def make = draw_make(s, wish->flags);
    const uint32_t most = wish->most_pipes > 0 ? wish->most_pipes : 6;
    const uint32_t joints = draw_joint_count(s, &t, &make, wish->flags);
    s->strings = joints + 1;
    for (uint32_t k = 0; k < s->strings; ++k) {
        draw_start(s, k, s->span, x, rotation, axis);
        draw_pipes(s, k, draw_count(&t, joints > 0 ? 1 : 2, most), &make, wish->flags);
        if (k > 0) join_strings(s, k, &t, wish->flags);
    }
}

/* ---- Drives and bits -------------------------------------------------------------------------------------------- */

static drive_data *new_drive(scene *s, int32_t component, time_function_data time_function)
{
    drive_data *const d = &s->drive[s->drives++];
    const part_ref rig = {PART_STRING, 0, 0, 0.0};
    d->def = dmb_drive_def_default();
    d->def.component = component;
    d->part = rig;
    d->time_function = time_function;
    return d;
}

/* Around the impedance of a string of 73 mm: 74 kN s/m and 48 N m s. */
static void control(drive_data *d, stream *t, double gain, double limit)
{
    d->def.kind = DMB_DRIVE_CONTROL;
    d->def.gain = draw_size(t, 0.1 * gain, 10.0 * gain);
    d->def.integral_gain = d->def.gain * draw_size(t, 0.1, 50.0);
    d->def.limit_high = draw_size(t, 0.1 * limit, 10.0 * limit);
    d->def.limit_low = -d->def.limit_high;
}

static void draw_head(scene *s, stream *t)
{
    body_data *const b = &s->body[s->bodies++];
    b->def = dmb_body_def_default();
    b->def.attach = DMB_ATTACH_START;
    b->def.mass = draw_size(t, 20.0, 2000.0);
    for (int i = 0; i < 3; ++i) b->def.inertia[i] = 0.5 * b->def.mass * 0.2 * 0.2;
    b->string = 0;
}

static void draw_drives(scene *s, uint32_t flags)
{
    stream t = topic_of(s, TOPIC_DRIVE);
    const int still = flags & WISH_STILL, controls = flags & WISH_NO_CONTROL ? 0 : 1;
    const double speed = still ? 0.0 : draw_number(&t, 0.0, 250.0) * PI / 30.0;
    const double feed = still ? 0.0 : draw_number(&t, 0.0, 0.05);
    const int feed_controlled = draw_chance(&t, 0.25) && controls, spin_controlled = draw_chance(&t, 0.25) && controls;
    const double turning = draw_number(&t, -100.0, 250.0) * PI / 30.0;
    drive_data *const x = new_drive(s, DMB_X, run_up(feed, 0.05));
    drive_data *const rx = new_drive(s, DMB_RX, run_up(speed, 0.05));
    if (feed_controlled) control(x, &t, 74e3, 1e5);
    if (spin_controlled) control(rx, &t, 48.0, 1e4);
    if (feed_controlled || spin_controlled) draw_head(s, &t);
    if (spin_controlled && !still && s->survey_count == 0)
        for (uint32_t k = 0; k < s->strings; ++k) s->string[k].def.velocity[3] = turning;
}

static void draw_bit(scene *s, uint32_t flags)
{
    stream t = topic_of(s, TOPIC_BIT);
    const uint32_t kind = draw_count(&t, 0, 3);
    if (kind == 0 || flags & WISH_NO_BIT) return;
    s->has_bit = 1;
    s->bit = dmb_bit_def_default();
    s->bit.rock_law = flags & WISH_STILL ? DMB_ROCK_NONE : (int32_t)kind - 1;
    s->bit.diameter = s->wall.diameter - 2e-3;
    s->bit.radius = 0.5 * s->bit.diameter;
    s->bit.bottom = 1e-4 * draw_number(&t, 0.0, 1.0);
    s->bit_string = s->strings - 1;
    if (draw_chance(&t, 0.5) && !(flags & WISH_NO_LOADS)) s->bit_load = run_up(draw_number(&t, 0.0, 3e3), 0.05);
    if (s->bit_load.terms > 0 && flags & WISH_STILL) s->bit_load = constant(s->bit_load.term[0].h1);
}

static void draw_in_hole(scene *s, const scene_wish *wish)
{
    const double zero[3] = {0.0, 0.0, 0.0}, along[3] = {1.0, 0.0, 0.0};
    draw_strings(s, wish, zero, zero, along);
    draw_wall(s, wish->flags, s->string[0].pipe[0].outer_diameter * 1.05, s->span);
    /* A string of one rigid piece could not move if its head held it in line: there it swings and tilts. */
    if (s->string[0].pipe[0].kind == DMB_PIPE_RIGID) s->string[0].def.start_free = DMB_FREE_ALL;
    draw_drives(s, wish->flags);
    draw_bit(s, wish->flags);
}

/* ---- Strings without a hole ------------------------------------------------------------------------------------- */

/* [N] Euler's push of the strings as one clamped-free column: the scale of what loads may be. */
static double column_load(const scene *s)
{
    const dmb_pipe_def *const p = &s->string[0].pipe[0];
    const double o = p->outer_diameter, i = p->inner_diameter;
    return 0.25 * PI * PI * p->young_modulus * PI / 64.0 * (pow(o, 4) - pow(i, 4)) / (s->span * s->span);
}

/* Pull or push, a side force and a torque at the far end. Moments with a fixed axis make the stiffness unsymmetric. */
static void draw_end_load(scene *s, uint32_t flags, const double axis[3])
{
    stream t = topic_of(s, TOPIC_LOAD);
    const double column = column_load(s), along = column * draw_number(&t, -0.4, 2.0);
    double side[3], moment[3];
    load_data *const l = &s->load[0];
    if (flags & WISH_NO_LOADS) return;
    draw_direction(&t, side);
    draw_direction(&t, moment);
    const int follows = draw_chance(&t, 0.3), twists = draw_chance(&t, 0.5), shakes = draw_chance(&t, 0.5);
    const double size = 0.2 * column * draw_number(&t, 0.0, 1.0), turn = 0.1 * column * s->span;
    l->def = dmb_load_def_default();
    s->loads = 1;
    l->def.frame = follows && !(flags & WISH_CONSERVATIVE) ? DMB_FRAME_BODY : DMB_FRAME_WORLD;
    for (int i = 0; i < 3; ++i) {
        l->def.force[i] = along * axis[i] + size * side[i];
        l->def.moment[i] = twists && !(flags & WISH_CONSERVATIVE) ? turn * moment[i] : 0.0;
    }
    l->place = string_place(s->strings - 1, s->string[s->strings - 1].pipes - 1, 1.0);
    if (shakes && !(flags & WISH_STILL)) l->time_function = shaken(1.0, 0.3, draw_size(&t, 1.0, 100.0));
}

static void draw_end_mass(scene *s, uint32_t flags)
{
    stream t = topic_of(s, TOPIC_BODY);
    body_data *const b = &s->body[s->bodies];
    if (draw_chance(&t, 0.5)) return;
    ++s->bodies;
    b->def = dmb_body_def_default();
    b->def.attach = DMB_ATTACH_END;
    b->def.mass = draw_size(&t, 0.5, 50.0);
    for (int i = 0; i < 3; ++i) b->def.inertia[i] = b->def.mass * draw_number(&t, 0.01, 0.015);
    b->def.inertia[3] = flags & WISH_ROUND ? 0.0 : b->def.mass * draw_number(&t, -2e-3, 2e-3);
    for (int i = 0; i < 3; ++i) b->def.centre[i] = flags & WISH_ROUND ? 0.0 : draw_number(&t, -0.05, 0.05);
    b->string = s->strings - 1;
}

static void draw_line(scene *s, const scene_wish *wish)
{
    stream t = topic_of(s, TOPIC_MOTION);
    double x[3], axis[3], along[3] = {1.0, 0.0, 0.0}, rotation[3];
    draw_direction(&t, axis);
    scaled(draw_number(&t, 0.0, PI), axis, rotation);
    for (int i = 0; i < 3; ++i) x[i] = draw_number(&t, -3.0, 3.0);
    /* x axis of exp(rotation), Rodrigues */
    const double angle = sqrt(rotation[0] * rotation[0] + rotation[1] * rotation[1] + rotation[2] * rotation[2]);
    along[0] = cos(angle) + (1.0 - cos(angle)) * axis[0] * axis[0];
    along[1] = sin(angle) * axis[2] + (1.0 - cos(angle)) * axis[0] * axis[1];
    along[2] = -sin(angle) * axis[1] + (1.0 - cos(angle)) * axis[0] * axis[2];
    draw_strings(s, wish, x, rotation, along);
    const int clamped = draw_chance(&t, 0.5), weightless = draw_chance(&t, 0.5);
    if (s->family == FAMILY_FREE) {
        double velocity[6];
        for (int i = 0; i < 6; ++i) velocity[i] = draw_number(&t, -1.0, 1.0);
        for (int i = 0; i < 6 && !(wish->flags & WISH_STILL) && s->strings == 1; ++i)
            s->string[0].def.velocity[i] = velocity[i];
        s->string[0].def.start_free = DMB_FREE_ALL;
        if (weightless) s->environment.gravity[2] = 0.0;
    } else {
        s->string[0].def.start_free = clamped ? DMB_FREE_NONE : DMB_FREE_CYLINDRICAL;
        if (!clamped) draw_drives(s, wish->flags);
        draw_end_load(s, wish->flags, along);
    }
    draw_end_mass(s, wish->flags);
}

/* Pipes of curvature 2 pi/(n L) about z close upon themselves; a fixed joint holds the ends together. */
static void draw_stabiliser(scene *s, const scene_wish *wish)
{
    stream t = topic_of(s, TOPIC_MOTION);
    dmb_pipe_def make = draw_make(s, wish->flags | WISH_FLEXIBLE);
    const uint32_t n = draw_count(&t, 6, 10);
    make.kind = DMB_PIPE_FLEXIBLE;
    make.joint_length = 0.0;
    make.joint_outer_diameter = 0.0;
    make.curvature[2] = 2.0 * PI / (n * make.length);
    s->strings = 1;
    s->string[0].def = dmb_string_def_default();
    s->string[0].def.follows_hole = 0;
    s->string[0].def.start_free = draw_chance(&t, 0.5) ? DMB_FREE_NONE : DMB_FREE_ALL;
    for (int i = 0; i < 3; ++i) s->string[0].def.rotation[i] = draw_number(&t, -1.0, 1.0);
    draw_pipes(s, 0, n, &make, wish->flags);
    joint_data *const j = new_joint(s, string_place(0, n - 1, 1.0), string_place(0, 0, 0.0));
    j->def.kind = DMB_JOINT_FIXED;
    if (s->string[0].def.start_free == DMB_FREE_ALL) s->environment.gravity[2] = 0.0;
}

/* ---- Bodies ----------------------------------------------------------------------------------------------------- */

static void draw_body(scene *s, stream *t, const double x[3])
{
    body_data *const b = &s->body[s->bodies++];
    b->def = dmb_body_def_default();
    b->def.mass = draw_size(t, 0.5, 20.0);
    for (int i = 0; i < 3; ++i) b->def.inertia[i] = b->def.mass * draw_number(t, 0.02, 0.03);
    for (int i = 3; i < 6; ++i) b->def.inertia[i] = b->def.mass * draw_number(t, -2e-3, 2e-3);
    for (int i = 0; i < 3; ++i) b->def.centre[i] = draw_number(t, -0.1, 0.1);
    for (int i = 0; i < 3; ++i) b->def.rotation[i] = draw_number(t, -1.0, 1.0);
    for (int i = 0; i < 3; ++i) b->def.position[i] = x[i];
}

/* A joint between body i (or the ground) and the next, whose frame is on a, its axis along `axis` of the world where a
 * is the ground, else drawn. */
static void join_bodies(scene *s, stream *t, part_ref a, part_ref b, const double x[3], uint32_t flags)
{
    static const int32_t kinds[] = {DMB_JOINT_REVOLUTE,  DMB_JOINT_CYLINDRICAL, DMB_JOINT_UNIVERSAL,
                                    DMB_JOINT_SPHERICAL, DMB_JOINT_PRISMATIC,   DMB_JOINT_REVOLUTE};
    joint_data *const j = new_joint(s, a, b);
    double normal[3];
    j->def.kind = kinds[draw_count(t, 0, 5)];
    draw_direction(t, j->def.axis_a);
    draw_direction(t, normal);
    for (int i = 0; i < 3; ++i) {
        j->def.normal_a[i] = normal[i];
        j->def.origin_a[i] = a.kind == PART_NONE ? x[i] : draw_number(t, -0.3, 0.3);
    }
    draw_springs(t, j->def.kind, flags, &j->def);
    for (int i = 0; i < 6; ++i) {
        j->def.stiffness[i] *= 0.1;
        j->def.damping[i] *= 0.1;
    }
}

static void draw_bodies(scene *s, const scene_wish *wish)
{
    stream t = topic_of(s, TOPIC_BODY);
    const uint32_t count = draw_count(&t, 2, 5);
    part_ref before = {PART_NONE, 0, 0, 0.0};
    double x[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < 3; ++i) x[i] = draw_number(&t, -1.0, 1.0);
    for (uint32_t i = 0; i < count; ++i) {
        double away[3];
        const double hinge[3] = {x[0], x[1], x[2]};
        draw_direction(&t, away);
        for (int k = 0; k < 3; ++k) x[k] += 0.5 * away[k];
        draw_body(s, &t, x);
        join_bodies(s, &t, before, body_place(i), hinge, wish->flags);
        before = body_place(i);
        s->span += 0.5;
    }
}

/* ---- All -------------------------------------------------------------------------------------------------------- */

static uint32_t draw_family(const scene *s, uint32_t families)
{
    stream t = topic_of(s, TOPIC_FAMILY);
    uint32_t count = 0, chosen;
    for (uint32_t f = 1; f <= FAMILY_ALL; f <<= 1) count += (families & f) != 0;
    chosen = draw_count(&t, 0, count - 1);
    for (uint32_t f = 1; f <= FAMILY_ALL; f <<= 1)
        if (families & f && chosen-- == 0) return f;
    return FAMILY_HOLE;
}

void scene_draw(uint64_t seed, uint32_t number, const scene_wish *wish, scene *out)
{
    memset(out, 0, sizeof *out);
    out->seed = seed;
    out->number = number;
    out->family = draw_family(out, wish->families);
    stream t = topic_of(out, TOPIC_RUN);
    out->step = draw_size(&t, 2e-4, 1e-3);
    out->radius = draw_number(&t, 0.5, 1.0);
    draw_mud(out, wish->flags);
    if (out->family & (FAMILY_HOLE | FAMILY_BENT)) draw_in_hole(out, wish);
    if (out->family & (FAMILY_LINE | FAMILY_FREE)) draw_line(out, wish);
    if (out->family == FAMILY_STABILISER) draw_stabiliser(out, wish);
    if (out->family == FAMILY_BODIES) draw_bodies(out, wish);
}

int scene_drives_tilt(const scene *s)
{
    return s->drives > 0 && s->string[0].def.start_free == DMB_FREE_ALL;
}
