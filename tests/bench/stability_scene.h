/* A model of what has been drawn. */
#ifndef BENCH_STABILITY_SCENE_H
#define BENCH_STABILITY_SCENE_H

#include "stability_draw.h"

enum { SURVEYS = 8, MOST_STRINGS = 5 };
static const double start_up = 0.05; /* [s] */

typedef struct random_scene {
    drawn d;
    dmb_model *model;
    dmb_id strings[MOST_STRINGS]; /* [-] d.joints + 1 */
    uint32_t pipes[MOST_STRINGS]; /* [-] of each */
} random_scene;

/* ---- Surroundings --------------------------------------------------------------------------------------------------
 */

/* [kg/m] */
static double mass_of_metre(const drawn *d)
{
    return 7850.0 * PI * d->thickness * (d->outer - d->thickness);
}

/* [N s/m2] of the laws that have no restitution, that of a pipe's metre on a linear spring. */
static double wall_damping(const drawn *d)
{
    const double decay = -log(d->restitution);
    return 2.0 * decay / sqrt(PI * PI + decay * decay) * sqrt(d->stiffness * mass_of_metre(d));
}

/* Straight for a tenth of the string, then bent all along in one direction, by 50 degrees at most. */
static void survey_hole(const drawn *d, double survey[SURVEYS][3])
{
    const double length = d->pipes * d->length + 2.0, straight = 0.1 * length;
    const double bend = fmin(d->bend, 50.0 * PI / 180.0 / length);
    for (int i = 0; i < SURVEYS; ++i) {
        const double depth = i > 0 ? straight + (i - 1) * (length - straight) / (SURVEYS - 2) : 0.0;
        const double turned = bend * fmax(0.0, depth - straight);
        survey[i][0] = depth;
        survey[i][1] = 0.5 * PI + d->inclination + turned * cos(d->bend_side);
        survey[i][2] = turned * sin(d->bend_side);
    }
}

static int32_t add_hole(random_scene *s)
{
    double survey[SURVEYS][3];
    dmb_wall_def wall = dmb_wall_def_default();
    if (s->d.hole == HOLE_ABSENT) return DMB_OK;
    survey_hole(&s->d, survey);
    if (s->d.hole == HOLE_BENT) wall.survey = survey[0], wall.survey_count = SURVEYS;
    wall.direction[0] = cos(s->d.inclination);
    wall.direction[2] = sin(s->d.inclination);
    wall.diameter = s->d.outer + 2.0 * s->d.clearance;
    wall.normal_law = s->d.normal;
    wall.stiffness = s->d.stiffness;
    wall.restitution = s->d.restitution;
    wall.damping = wall_damping(&s->d);
    wall.friction_law = s->d.friction;
    wall.mu_static = s->d.mu;
    wall.mu_dynamic = 0.85 * s->d.mu;
    return dmb_model_add_wall(s->model, &wall, NULL);
}

static int32_t add_mud(const random_scene *s)
{
    dmb_environment_def environment = dmb_environment_def_default();
    environment.fluid_density = s->d.fluid;
    environment.lateral_damping = s->d.drag;
    environment.axial_damping = 0.1 * s->d.drag;
    environment.torsional_damping = 1e-3 * s->d.drag;
    return dmb_model_set_environment(s->model, &environment);
}

/* ---- Strings -------------------------------------------------------------------------------------------------------
 */

static int32_t add_pipes(random_scene *s, uint32_t k)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.string = s->strings[k];
    pipe.kind = s->d.kind;
    pipe.elements = s->d.elements;
    pipe.length = s->d.length;
    pipe.outer_diameter = s->d.outer;
    pipe.inner_diameter = s->d.outer - 2.0 * s->d.thickness;
    pipe.damping_time = s->d.damping;
    pipe.eccentricity = s->d.eccentricity;
    pipe.angle_spread = PI;
    pipe.seed = s->d.number + 1 + 1000 * k;
    return dmb_model_add_pipes(s->model, &pipe, s->pipes[k], NULL);
}

/* In a hole a string of one rigid piece could not move if its head held it in line: there it swings and tilts. */
static int32_t add_string(random_scene *s, uint32_t k, uint32_t before)
{
    dmb_string_def string = dmb_string_def_default();
    const double along = before * s->d.length;
    if (k > 0 || (s->d.kind == DMB_PIPE_RIGID && s->d.hole != HOLE_ABSENT)) string.start_free = DMB_FREE_ALL;
    string.start_depth = along;
    string.velocity[3] = s->d.begins_turning * PI / 30.0;
    if (s->d.hole == HOLE_ABSENT) {
        string.position[0] = along * cos(s->d.inclination);
        string.position[2] = along * sin(s->d.inclination);
        string.rotation[1] = -s->d.inclination;
    }
    s->pipes[k] = s->d.pipes / (s->d.joints + 1) + (k < s->d.pipes % (s->d.joints + 1));
    const int32_t status = dmb_model_add_string(s->model, &string, &s->strings[k]);
    return status < 0 ? status : add_pipes(s, k);
}

/* Springs hold the coordinates that a joint leaves free along and about the string: nothing else would hold it. */
static int32_t join(random_scene *s, uint32_t k)
{
    dmb_joint_def joint = dmb_joint_def_default();
    const int32_t kind = joint_kinds[s->d.joint];
    joint.kind = kind;
    joint.match = 1;
    joint.place_a = dmb_station(s->strings[k - 1], s->pipes[k - 1] - 1, 1.0);
    joint.place_b = dmb_station(s->strings[k], 0, 0.0);
    if (kind == DMB_JOINT_PRISMATIC || kind == DMB_JOINT_CYLINDRICAL) joint.stiffness[DMB_X] = s->d.springs[0];
    if (kind == DMB_JOINT_REVOLUTE || kind == DMB_JOINT_CYLINDRICAL || kind == DMB_JOINT_SPHERICAL)
        joint.stiffness[DMB_RX] = s->d.springs[1];
    if (kind == DMB_JOINT_UNIVERSAL || kind == DMB_JOINT_SPHERICAL)
        joint.stiffness[DMB_RY] = joint.stiffness[DMB_RZ] = s->d.springs[2];
    for (int i = 0; i < 6; ++i) joint.damping[i] = 1e-3 * joint.stiffness[i];
    return dmb_model_add_joint(s->model, &joint, NULL);
}

static int32_t add_strings(random_scene *s)
{
    int32_t status = DMB_OK;
    uint32_t before = 0;
    for (uint32_t k = 0; k <= s->d.joints && status >= 0; ++k) {
        status = add_string(s, k, before);
        before += s->pipes[k];
        if (k > 0 && status >= 0) status = join(s, k);
    }
    return status;
}

static int32_t add_bit(random_scene *s)
{
    dmb_bit_def bit = dmb_bit_def_default();
    if (s->d.bit == BIT_ABSENT) return DMB_OK;
    bit.rock_law = s->d.bit - BIT_IDLE;
    bit.string = s->strings[s->d.joints];
    bit.diameter = s->d.outer + 2.0 * s->d.clearance - 2e-3;
    bit.radius = 0.5 * bit.diameter;
    return dmb_model_add_bit(s->model, &bit, NULL);
}

/* The part that a controller pushes and turns. */
static int32_t add_head(random_scene *s)
{
    dmb_body_def head = dmb_body_def_default();
    if (!(s->d.head > 0.0)) return DMB_OK;
    head.attach = DMB_ATTACH_START;
    head.string = s->strings[0];
    head.mass = s->d.head;
    head.inertia[0] = 0.5 * s->d.head * 0.2 * 0.2;
    head.inertia[1] = head.inertia[2] = head.inertia[0];
    return dmb_model_add_body(s->model, &head, NULL);
}

/* ---- Drives --------------------------------------------------------------------------------------------------------
 */

/* control: NULL where the motion is prescribed. */
static int32_t add_drive(random_scene *s, int32_t component, double speed, const controller *control)
{
    dmb_segment term = dmb_segment_default();
    dmb_drive_def drive = dmb_drive_def_default();
    term.kind = DMB_SEGMENT_STEP;
    term.x1 = start_up;
    term.h1 = speed;
    const int32_t status = dmb_model_add_time_function(s->model, &term, 1, &drive.time_function);
    drive.part = s->strings[0];
    drive.component = component;
    if (control) {
        drive.kind = DMB_DRIVE_CONTROL;
        drive.gain = control->gain;
        drive.integral_gain = control->integral_gain;
        drive.limit_high = control->limit;
        drive.limit_low = -control->limit;
    }
    return status < 0 ? status : dmb_model_add_drive(s->model, &drive, NULL);
}

static int32_t add_drives(random_scene *s)
{
    const controller *const feed = s->d.control & CONTROL_FEED ? &s->d.feed_control : NULL;
    const controller *const spin = s->d.control & CONTROL_SPIN ? &s->d.spin_control : NULL;
    const int32_t status = add_drive(s, DMB_X, s->d.feed, feed);
    return status < 0 ? status : add_drive(s, DMB_RX, s->d.speed * PI / 30.0, spin);
}

static int32_t random_scene_make(random_scene *s)
{
    int32_t status = dmb_model_create(NULL, &s->model);
    if (status >= 0) status = add_mud(s);
    if (status >= 0) status = add_hole(s);
    if (status >= 0) status = add_strings(s);
    if (status >= 0) status = add_head(s);
    if (status >= 0) status = add_bit(s);
    if (status >= 0) status = add_drives(s);
    return status < 0 ? status : dmb_model_compile(s->model, NULL);
}

#endif
