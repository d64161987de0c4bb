/* The parameters of a random scene, drawn from a point of a Latin hypercube. Two sets. The first, 20 axes: a string in
 * a straight hole, motion drives, fixed steps. The second keeps these axes, the same for the same seed, and adds 23:
 * bent holes and none, explicit joints, speed controllers, mud, error-controlled and bounded steps.
 */
#ifndef BENCH_STABILITY_DRAW_H
#define BENCH_STABILITY_DRAW_H

#include <drillmbd/drillmbd.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#define PI 3.14159265358979323846

enum { SCENES = 1000 };

/* ---- Latin hypercube -----------------------------------------------------------------------------------------------
 */

enum {
    AXIS_PIPES,
    AXIS_LENGTH,
    AXIS_OUTER,
    AXIS_THICKNESS,
    AXIS_CLEARANCE,
    AXIS_STIFFNESS,
    AXIS_NORMAL,
    AXIS_RESTITUTION,
    AXIS_FRICTION,
    AXIS_MU,
    AXIS_SPEED,
    AXIS_FEED,
    AXIS_ECCENTRICITY,
    AXIS_BIT,
    AXIS_INCLINATION,
    AXIS_STEP,
    AXIS_RADIUS,
    AXIS_ELEMENTS,
    AXIS_KIND,
    AXIS_DAMPING,
    AXIS_FIRST_COUNT, /* of the first set; those of the second follow */
    AXIS_HOLE = AXIS_FIRST_COUNT,
    AXIS_BEND,
    AXIS_BEND_SIDE,
    AXIS_JOINTS,
    AXIS_JOINT_KIND,
    AXIS_JOINT_SLIDING,
    AXIS_JOINT_TWISTING,
    AXIS_JOINT_BENDING,
    AXIS_CONTROL,
    AXIS_SPIN_GAIN,
    AXIS_SPIN_INTEGRAL,
    AXIS_SPIN_LIMIT,
    AXIS_FEED_GAIN,
    AXIS_FEED_INTEGRAL,
    AXIS_FEED_LIMIT,
    AXIS_FLUID,
    AXIS_DRAG,
    AXIS_WALK,
    AXIS_TOLERANCE,
    AXIS_BOUND,
    AXIS_RESTART,
    AXIS_TURNED,
    AXIS_HEAD,
    AXIS_COUNT
};

static double samples[AXIS_COUNT][SCENES]; /* [-] 0 .. 1 */

/* splitmix64 */
static uint64_t random_bits(uint64_t *state)
{
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

static double random_number(uint64_t *state)
{
    return (double)(random_bits(state) >> 11) * 0x1p-53;
}

/* Each of the SCENES equal parts of the axis is hit once. */
static void draw_axis(uint64_t *state, double *axis)
{
    for (uint32_t i = 0; i < SCENES; ++i) axis[i] = i;
    for (uint32_t i = SCENES - 1; i > 0; --i) {
        const uint32_t k = (uint32_t)(random_bits(state) % (i + 1));
        const double other = axis[k];
        axis[k] = axis[i];
        axis[i] = other;
    }
    for (uint32_t i = 0; i < SCENES; ++i) axis[i] = (axis[i] + random_number(state)) / SCENES;
}

static void draw_samples(uint64_t seed)
{
    for (int i = 0; i < AXIS_COUNT; ++i) draw_axis(&seed, samples[i]);
}

/* ---- What is drawn -------------------------------------------------------------------------------------------------
 */

enum { BIT_ABSENT = 0, BIT_IDLE = 1, BIT_RATE = 2, BIT_REGENERATIVE = 3 };
enum { HOLE_STRAIGHT = 0, HOLE_BENT = 1, HOLE_ABSENT = 2 };
enum { WALK_FIXED = 0, WALK_CONTROLLED = 1, WALK_BOUNDED = 2 };
enum { CONTROL_SPIN = 1, CONTROL_FEED = 2 };
static const char *const bit_names[] = {"absent", "idle", "rate", "regenerative"};
static const char *const kind_names[] = {"flexible", "axial_torsional", "rigid"};
static const char *const normal_names[] = {"kelvin_voigt", "hunt_crossley", "lankarani", "flores", "exact", "impact"};
static const char *const friction_names[] = {"none", "coulomb", "ambrosio", "stribeck", "bristle"};
static const char *const hole_names[] = {"straight", "bent", "absent"};
static const char *const walk_names[] = {"fixed", "controlled", "bounded"};
static const char *const control_names[] = {"none", "spin", "feed", "both"};
static const char *const joint_names[] = {"fixed", "revolute", "prismatic", "cylindrical", "universal", "spherical"};
static const int32_t joint_kinds[] = {DMB_JOINT_FIXED,       DMB_JOINT_REVOLUTE,  DMB_JOINT_PRISMATIC,
                                      DMB_JOINT_CYLINDRICAL, DMB_JOINT_UNIVERSAL, DMB_JOINT_SPHERICAL};

typedef struct controller {
    double gain, integral_gain, limit; /* [N s/m, N/m, N] or [N m s, N m, N m] */
} controller;

typedef struct drawn {
    uint32_t number, pipes, elements;
    int32_t kind, normal, friction, bit;
    double length, outer, thickness; /* [m] of a pipe */
    double clearance;                /* [m] radial */
    double stiffness, restitution, mu;
    double speed, feed;           /* [rpm, m/s] */
    double eccentricity, damping; /* [m, s] */
    double inclination;           /* [rad] of the hole, upwards */
    double step, radius;          /* [s, -] */
    /* the second set; 0 in the first */
    int32_t hole, control, walk;
    double bend, bend_side; /* [1/m] curvature of a bent hole, [rad] from upwards to the side */
    uint32_t joints;        /* [-] explicit ones, between as many strings and one more */
    int32_t joint;          /* [-] index of joint_kinds */
    double springs[3];      /* [N/m, N m/rad, N m/rad] sliding, twisting and bending, in free coordinates of joints */
    controller spin_control, feed_control;
    double head;           /* [kg] of the rig head that a controller moves; with the inertia of a disc of 0.2 m */
    double fluid, drag;    /* [kg/m3, N s/m2] */
    double tolerance;      /* [m] of error control; ten times as much in rad */
    uint32_t bound;        /* [-] iterations of bounded work */
    double restart;        /* [-] part of the run after which a snapshot is taken; 0: none */
    double begins_turning; /* [rpm] of straight strings at time 0, where the spin is not prescribed */
} drawn;

static double between(double u, double low, double high)
{
    return low + u * (high - low);
}

static double between_log(double u, double low, double high)
{
    return low * pow(high / low, u);
}

static uint32_t one_of(double u, uint32_t count)
{
    return (uint32_t)(u * count);
}

static void draw_string(uint32_t i, drawn *d)
{
    const double kind = samples[AXIS_KIND][i];
    d->pipes = 3 + one_of(samples[AXIS_PIPES][i], 58);
    d->length = between(samples[AXIS_LENGTH][i], 0.75, 3.0);
    d->outer = between(samples[AXIS_OUTER][i], 0.042, 0.089);
    d->thickness = between(samples[AXIS_THICKNESS][i], 0.004, 0.012);
    d->eccentricity = between(samples[AXIS_ECCENTRICITY][i], 0.0, 2e-3);
    d->elements = 1 + one_of(samples[AXIS_ELEMENTS][i], 3);
    d->kind = kind < 0.8 ? DMB_PIPE_FLEXIBLE : kind < 0.9 ? DMB_PIPE_AXIAL_TORSIONAL : DMB_PIPE_RIGID;
    d->damping = samples[AXIS_DAMPING][i] < 0.5 ? 0.0 : 1e-4;
    d->bit = (int32_t)one_of(samples[AXIS_BIT][i], 4);
}

static drawn draw_first(uint32_t i)
{
    drawn d;
    memset(&d, 0, sizeof d);
    d.number = i;
    draw_string(i, &d);
    d.clearance = between(samples[AXIS_CLEARANCE][i], 0.003, 0.040);
    d.stiffness = between_log(samples[AXIS_STIFFNESS][i], 1e5, 1e9);
    d.normal = (int32_t)one_of(samples[AXIS_NORMAL][i], 6);
    d.restitution = between(samples[AXIS_RESTITUTION][i], 0.1, 0.9);
    d.friction = (int32_t)one_of(samples[AXIS_FRICTION][i], 5) - 1;
    d.mu = between(samples[AXIS_MU][i], 0.0, 0.6);
    d.speed = between(samples[AXIS_SPEED][i], 0.0, 250.0);
    d.feed = between(samples[AXIS_FEED][i], 0.0, 0.05);
    d.inclination = between(samples[AXIS_INCLINATION][i], -30.0, 30.0) * PI / 180.0;
    d.step = between_log(samples[AXIS_STEP][i], 2e-4, 2e-3);
    d.radius = between(samples[AXIS_RADIUS][i], 0.5, 1.0);
    return d;
}

static void draw_joints(uint32_t i, drawn *d)
{
    const double bending = samples[AXIS_JOINT_BENDING][i];
    d->joints = one_of(samples[AXIS_JOINTS][i], 5);
    if (d->joints > d->pipes - 1) d->joints = d->pipes - 1;
    if (d->kind == DMB_PIPE_AXIAL_TORSIONAL && d->hole == HOLE_BENT) d->joints = 0; /* refused */
    d->joint = (int32_t)one_of(samples[AXIS_JOINT_KIND][i], 6);
    d->springs[0] = between_log(samples[AXIS_JOINT_SLIDING][i], 1e4, 1e8);
    d->springs[1] = between_log(samples[AXIS_JOINT_TWISTING][i], 1e2, 1e6);
    d->springs[2] = bending < 0.4 ? 0.0 : between_log((bending - 0.4) / 0.6, 1e1, 1e6);
}

/* Around the impedance of the string, 74 kNs/m and 48 Nms of a pipe of 73 mm; limits that bind and such that do not. */
static void draw_control(uint32_t i, drawn *d)
{
    const double u = samples[AXIS_CONTROL][i];
    d->control = u < 0.5 ? 0 : 1 + (int32_t)one_of(2.0 * (u - 0.5), 3);
    d->spin_control.gain = between_log(samples[AXIS_SPIN_GAIN][i], 5.0, 5e3);
    d->spin_control.integral_gain = d->spin_control.gain * between_log(samples[AXIS_SPIN_INTEGRAL][i], 0.1, 50.0);
    d->spin_control.limit = between_log(samples[AXIS_SPIN_LIMIT][i], 1e2, 1e5);
    d->feed_control.gain = between_log(samples[AXIS_FEED_GAIN][i], 5e3, 5e6);
    d->feed_control.integral_gain = d->feed_control.gain * between_log(samples[AXIS_FEED_INTEGRAL][i], 0.1, 50.0);
    d->feed_control.limit = between_log(samples[AXIS_FEED_LIMIT][i], 1e3, 1e6);
    /* About one axis: a bent string would be thrown against the wall. */
    if (d->control) d->head = between_log(samples[AXIS_HEAD][i], 20.0, 2000.0);
    if (d->control & CONTROL_SPIN && d->hole != HOLE_BENT)
        d->begins_turning = between(samples[AXIS_TURNED][i], -100.0, 250.0);
}

static drawn draw_second(uint32_t i)
{
    drawn d = draw_first(i);
    const double hole = samples[AXIS_HOLE][i], walk = samples[AXIS_WALK][i];
    d.hole = hole < 0.2 ? HOLE_STRAIGHT : hole < 0.8 ? HOLE_BENT : HOLE_ABSENT;
    if (d.hole == HOLE_BENT && d.kind == DMB_PIPE_RIGID) d.hole = HOLE_STRAIGHT; /* would not fit in */
    d.bend = between_log(samples[AXIS_BEND][i], 1e-3, 1.0 / 30.0);
    d.bend_side = between(samples[AXIS_BEND_SIDE][i], -PI, PI);
    draw_joints(i, &d);
    draw_control(i, &d);
    d.fluid = fmax(0.0, between(samples[AXIS_FLUID][i], -1500.0, 1500.0));
    d.drag = fmax(0.0, between(samples[AXIS_DRAG][i], -50.0, 50.0));
    d.walk = walk < 0.5 ? WALK_FIXED : walk < 0.75 ? WALK_CONTROLLED : WALK_BOUNDED;
    d.tolerance = between_log(samples[AXIS_TOLERANCE][i], 1e-6, 1e-3);
    d.bound = 2 + one_of(samples[AXIS_BOUND][i], 11);
    d.restart = between(samples[AXIS_RESTART][i], 0.5, 0.95);
    return d;
}

static void print_second(const drawn *d)
{
    printf("hole=%s bend_per_m=%.4g bend_side_deg=%.4g joints=%u joint=%s ", hole_names[d->hole], d->bend,
           d->bend_side * 180.0 / PI, (unsigned)d->joints, joint_names[d->joint]);
    printf("springs=%.4g,%.4g,%.4g control=%s ", d->springs[0], d->springs[1], d->springs[2],
           control_names[d->control]);
    printf("spin_control=%.4g,%.4g,%.4g feed_control=%.4g,%.4g,%.4g begins_rpm=%.4g ", d->spin_control.gain,
           d->spin_control.integral_gain, d->spin_control.limit, d->feed_control.gain, d->feed_control.integral_gain,
           d->feed_control.limit, d->begins_turning);
    printf("head=%.4g fluid=%.4g drag=%.4g walk=%s tolerance=%.3g bound=%u restart=%.3g ", d->head, d->fluid, d->drag,
           walk_names[d->walk], d->tolerance, (unsigned)d->bound, d->restart);
}

static void print_drawn(const drawn *d)
{
    printf("pipes=%u elements=%u kind=%s length=%.4g od_mm=%.4g wall_mm=%.4g clearance_mm=%.4g ", (unsigned)d->pipes,
           (unsigned)d->elements, kind_names[d->kind], d->length, 1e3 * d->outer, 1e3 * d->thickness,
           1e3 * d->clearance);
    printf("stiffness=%.4g normal=%s restitution=%.4g friction=%s mu=%.4g ", d->stiffness, normal_names[d->normal],
           d->restitution, friction_names[d->friction + 1], d->mu);
    printf("rpm=%.4g feed_mm_s=%.4g eccentricity_mm=%.4g damping_time=%g bit=%s ", d->speed, 1e3 * d->feed,
           1e3 * d->eccentricity, d->damping, bit_names[d->bit]);
    if (d->restart > 0.0) print_second(d);
    printf("inclination_deg=%.4g dt=%.4g radius=%.4g\n", d->inclination * 180.0 / PI, d->step, d->radius);
}

#endif
