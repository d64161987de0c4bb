/* Motion without slip: a knife edge on an incline, Chaplygin's sledge, discs that roll, against closed forms; and the
 * caller's constraints, of position and of speed, with and without a Jacobian, against joints that say the same. Checks
 * eq:joints.nonholonomic and eq:joints.rolling. */
#include <string.h>

#include "mechanism.h"

static const double g = 9.81;

static void row_of(const double pose[12], const double force[3], double J[6])
{
    for (int i = 0; i < 3; i++) {
        J[i] = force[0] * pose[3 + i] + force[1] * pose[6 + i] + force[2] * pose[9 + i];
        J[3 + i] = 0.0;
    }
}

static dmb_id add_user(rig *s, int32_t kind, dmb_constraint_fn callback, int32_t provides, dmb_id body, void *context)
{
    dmb_constraint_def def = dmb_constraint_def_default();
    dmb_id id = {0, 0};
    def.kind = kind;
    def.place[0] = dmb_station(body, 0, 0.0);
    def.provides = provides;
    def.callback = callback;
    def.callback_context = context;
    must_model(s, dmb_model_add_constraint(s->model, &def, &id));
    return id;
}

/* ---- Knife edge on an incline ------------------------------------------------------------------------------------ */

/* A body that stays in the plane z = 0, its edge along its x axis; the incline is in gravity: along +x of the world. */
typedef struct edge {
    rig s;
    dmb_id body, knife;
} edge;

/* y of the body does not move: A v + b = 0 with A = (0, 1, 0, 0, 0, 0). */
static int32_t no_side_slip(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                            double *jacobian)
{
    (void)context, (void)time, (void)count, (void)poses;
    value[0] = 0.0;
    for (int i = 0; i < 6; i++) jacobian[i] = i == 1 ? 1.0 : 0.0;
    return 0;
}

static edge edge_of(const dmb_body_def *body, double slope, int by_callback, double tolerance)
{
    edge e;
    const double up[3] = {0.0, 0.0, 1.0};
    const dmb_sim_options options = sharp_options(0.9, tolerance);
    dmb_joint_def plane = dmb_joint_def_default(), knife = dmb_joint_def_default();
    rig_open(&e.s, g * sin(slope), 0.0, -g * cos(slope));
    e.body = add_body(&e.s, body);
    plane.kind = DMB_JOINT_PLANAR;
    plane.place_b = knife.place_b = dmb_station(e.body, 0, 0.0);
    memcpy(plane.axis_a, up, sizeof up);
    memcpy(plane.axis_b, up, sizeof up);
    (void)add_joint(&e.s, &plane);
    knife.kind = DMB_JOINT_KNIFE_EDGE;
    e.knife = by_callback
                  ? add_user(&e.s, DMB_CONSTRAINT_NONHOLONOMIC, no_side_slip, DMB_PROVIDES_JACOBIAN, e.body, NULL)
                  : add_joint(&e.s, &knife);
    (void)mechanism_start(&e.s, &options);
    return e;
}

/* Spins at w from rest: x = g sin(a)/(2 w^2) sin^2(w t), y = g sin(a)/(2 w^2) (w t - sin(2 w t)/2). It does not slide
 * down on the mean. */
static double knife_error(double step, int by_callback, double *energy)
{
    const double slope = 0.4, w = 3.0, k = g * sin(slope) / (2.0 * w * w);
    dmb_body_def body = dmb_body_def_default();
    double worst = 0.0;
    body.velocity[5] = w;
    edge e = edge_of(&body, slope, by_callback, 1e-11);
    const double start = energy_of(&e.s).kinetic;
    *energy = 0.0;
    while (dmb_sim_time(e.s.sim) < 3.0 - 0.5 * step) {
        take_steps(&e.s, step, 1);
        const double t = dmb_sim_time(e.s.sim);
        const dmb_pose pose = pose_at(&e.s, dmb_station(e.body, 0, 0.0));
        const double want[3] = {k * sin(w * t) * sin(w * t), k * (w * t - 0.5 * sin(2.0 * w * t)), 0.0};
        const dmb_energy now = energy_of(&e.s);
        worst = fmax(worst, largest_difference(3, pose.position, want));
        *energy = fmax(*energy, fabs(now.kinetic + now.gravity - start));
    }
    rig_close(&e.s);
    return worst;
}

static void knife_on_an_incline(void **state)
{
    (void)state;
    double energy;
    const double coarse = knife_error(2e-3, 0, &energy), fine = knife_error(1e-3, 0, &energy);
    check_below("knife edge: place over 3 s [m]", fine, 1e-5);
    check_order("order of the error", coarse, fine, 2.0, 0.1);
    check_below("energy that comes or goes [J]", energy, 1e-5);
    const double user = knife_error(1e-3, 1, &energy);
    check_close("the same by the caller's A v + b: error [m]", user, fine, 1e-8);
}

/* ---- Chaplygin's sledge ------------------------------------------------------------------------------------------ */

/* Centre of mass at a ahead of the edge: v' = a w^2, w' = -m a v w/(J + m a^2). With E = m v^2 + (J + m a^2) w^2 both
 * go along a circle: v = V tanh(k t), w = W/cosh(k t) from v = 0 with V = W sqrt((J + m a^2)/m), k = a W^2/V. */
static void sledge(void **state)
{
    (void)state;
    const double m = 1.5, J = 0.2, a = 0.3, W = 4.0, I = J + m * a * a, V = W * sqrt(I / m), k = a * W * W / V;
    dmb_body_def body = dmb_body_def_default();
    double worst = 0.0;
    body.mass = m;
    body.centre[0] = a;
    body.inertia[0] = body.inertia[1] = body.inertia[2] = J;
    body.velocity[5] = W;
    edge e = edge_of(&body, 0.0, 0, 1e-11);
    for (int i = 0; i < 2000; i++) {
        take_steps(&e.s, 1e-3, 1);
        const double t = dmb_sim_time(e.s.sim);
        const dmb_motion motion = motion_at(&e.s, dmb_station(e.body, 0, 0.0), DMB_FRAME_BODY);
        worst = fmax(worst, fabs(motion.velocity[0] - V * tanh(k * t)));
        worst = fmax(worst, fabs(motion.velocity[5] - W / cosh(k * t)));
        worst = fmax(worst, fabs(motion.velocity[1]));
    }
    const dmb_energy energy = energy_of(&e.s);
    check_below("Chaplygin's sledge: speeds over 2 s over V", worst / V, 1e-5);
    check_below("kinetic energy", energy.kinetic / (0.5 * I * W * W) - 1.0, 1e-5);
    rig_close(&e.s);
}

/* ---- Rolling discs ----------------------------------------------------------------------------------------------- */

/* A uniform disc of radius r about its y axis on the plane z = 0. */
static dmb_body_def disc_of(double m, double r)
{
    dmb_body_def body = dmb_body_def_default();
    body.mass = m;
    body.inertia[0] = body.inertia[2] = 0.25 * m * r * r;
    body.inertia[1] = 0.5 * m * r * r;
    body.position[2] = r;
    return body;
}

static dmb_id roll(rig *s, dmb_id body, double r)
{
    dmb_joint_def def = dmb_joint_def_default();
    def.kind = DMB_JOINT_ROLLING;
    def.place_b = dmb_station(body, 0, 0.0);
    def.axis_a[0] = 0.0, def.axis_a[2] = 1.0;
    def.axis_b[0] = 0.0, def.axis_b[1] = 1.0;
    def.length = r;
    return add_joint(s, &def);
}

static void rolling_down(void **state)
{
    (void)state;
    const double m = 2.0, r = 0.25, slope = 0.3, a = 2.0 / 3.0 * g * sin(slope);
    const dmb_body_def body = disc_of(m, r);
    double f[6];
    rig s;
    rig_open(&s, g * sin(slope), 0.0, -g * cos(slope));
    const dmb_id disc = add_body(&s, &body), joint = roll(&s, disc, r);
    (void)mechanism_start(&s, NULL);
    const dmb_place at = dmb_station(disc, 0, 0.0);
    check_relative("disc on an incline: acceleration", motion_at(&s, at, DMB_FRAME_WORLD).acceleration[0], a, 1e-12);
    take_steps(&s, 1e-3, 1000);
    const dmb_motion motion = motion_at(&s, at, DMB_FRAME_WORLD);
    const dmb_pose pose = pose_at(&s, at);
    check_relative("speed after 1 s", motion.velocity[0], a, 1e-6);
    check_relative("spin goes with the speed", motion.velocity[4] * r, motion.velocity[0], 1e-12);
    check_relative("way after 1 s", pose.position[0], 0.5 * a, 5e-6);
    check_close("height of the centre [m]", pose.position[2], r, 1e-14);
    assert_int_equal(multipliers_of(&s, joint, f), 3);
    check_relative("normal force", -f[0], m * g * cos(slope), 1e-9);
    check_relative("friction that rolling needs", fabs(f[1]), m * (g * sin(slope) - a), 1e-6);
    const dmb_energy energy = energy_of(&s);
    check_below("energy over the kinetic", (energy.kinetic + energy.gravity) / energy.kinetic, 1e-5);
    rig_close(&s);
}

/* Steady circular rolling: tilted by th from the plane's normal.. the disc's plane leans by angle b from the vertical
 * inwards, the centre goes round at radius R with rate p; the contact rolls on a circle of radius R + r sin b.
 *     spin about its own axis w3 = p (R/r) (its component along the axis, from v = p R = w3 r)
 *     moment balance: r m g sin b + ... with A = m r^2/4 (diameter), C = m r^2/2 (axis):
 *         (C + m r^2) w3 p cos b - A p^2 cos b sin b - m g r sin b = 0,  w3 = p R/r + 0
 * with the angular velocity w = p e_z + n' a, a the axis: components along a: w3 = n' + p (e_z . a). */
static double lean_balance(double p, double R, double r, double m, double lean)
{
    const double A = 0.25 * m * r * r, C = 0.5 * m * r * r, w3 = p * R / r;
    return (C + m * r * r) * w3 * p * cos(lean) + A * p * p * cos(lean) * sin(lean) - m * g * r * sin(lean);
}

/* Rate of going round that balances. */
static double steady_rate(double R, double r, double m, double lean)
{
    const double at_one = lean_balance(1.0, R, r, m, lean) + m * g * r * sin(lean);
    return sqrt(m * g * r * sin(lean) / at_one);
}

/* Goes along +x at (0, -R), centre of the circle at the world's z axis, on the left (+y): leans towards +y, about -x.
 */
static double circle_error(double step, double *balance)
{
    const double m = 2.0, r = 0.25, R = 1.0, lean = 0.35, p = steady_rate(R, r, m, lean);
    dmb_body_def body = disc_of(m, r);
    const dmb_sim_options options = sharp_options(0.9, 1e-11);
    double worst = 0.0;
    body.position[1] = -R;
    body.position[2] = r * cos(lean);
    body.rotation[0] = -lean;
    /* angular velocity: p about z, and the spin about the axis so that the contact stands still */
    const double axis[3] = {0.0, cos(lean), -sin(lean)}, spin = p * R / r + p * sin(lean);
    const double w[3] = {0.0, spin * axis[1], spin * axis[2] + p};
    body.velocity[0] = p * R;
    body.velocity[4] = cos(lean) * w[1] - sin(lean) * w[2]; /* R^T w, R about x by -lean */
    body.velocity[5] = sin(lean) * w[1] + cos(lean) * w[2];
    rig s;
    rig_open(&s, 0.0, 0.0, -g);
    const dmb_id disc = add_body(&s, &body);
    (void)roll(&s, disc, r);
    (void)mechanism_start(&s, &options);
    check_below("start fits rolling: correction of the speeds", statistics_of(&s).projection[0], 1e-12);
    while (dmb_sim_time(s.sim) < 2.0 - 0.5 * step) {
        take_steps(&s, step, 1);
        const double angle = p * dmb_sim_time(s.sim);
        const dmb_pose pose = pose_at(&s, dmb_station(disc, 0, 0.0));
        const double want[3] = {R * sin(angle), -R * cos(angle), r * cos(lean)};
        worst = fmax(worst, largest_difference(3, pose.position, want));
    }
    const dmb_energy energy = energy_of(&s);
    *balance = fabs(energy.balance) / energy.kinetic;
    rig_close(&s);
    return worst;
}

static void rolling_in_a_circle(void **state)
{
    (void)state;
    double balance;
    tell("rate of going round [rad/s]", steady_rate(1.0, 0.25, 2.0, 0.35));
    const double coarse = circle_error(2e-3, &balance), fine = circle_error(1e-3, &balance);
    check_below("tilted disc in a circle: place over 2 s [m]", fine, 1e-4);
    check_order("order of the error", coarse, fine, 2.0, 0.2);
    check_below("balance over the kinetic energy", balance, 1e-5);
}

/* A coin that wobbles keeps its energy. */
static void wobbling_coin(void **state)
{
    (void)state;
    const double m = 2.0, r = 0.25;
    dmb_body_def body = disc_of(m, r);
    rig s;
    double worst = 0.0;
    body.rotation[0] = -0.5;
    body.position[2] = r * cos(0.5);
    body.velocity[4] = 6.0;
    body.velocity[5] = 3.0;
    const dmb_sim_options options = sharp_options(0.9, 1e-11);
    rig_open(&s, 0.0, 0.0, -g);
    (void)roll(&s, add_body(&s, &body), r);
    (void)mechanism_start(&s, &options);
    const double start = energy_of(&s).kinetic + energy_of(&s).gravity;
    for (int i = 0; i < 20000; i++) {
        take_steps(&s, 1e-4, 1);
        const dmb_energy energy = energy_of(&s);
        worst = fmax(worst, fabs(energy.kinetic + energy.gravity - start));
    }
    check_below("wobbling coin: energy over 2 s over that of the start", worst / start, 1e-5);
    check_below("largest violation", statistics_of(&s).violation, 1e-14);
    rig_close(&s);
}

/* ---- The caller's C(q, t) = 0 ------------------------------------------------------------------------------------ */

/* On the sphere of 1 m about the origin: the spherical pendulum. */
static int32_t on_sphere(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                         double *jacobian)
{
    const double *x = poses[0];
    (void)context, (void)time, (void)count;
    value[0] = 0.5 * (x[0] * x[0] + x[1] * x[1] + x[2] * x[2] - 1.0);
    if (jacobian != NULL) row_of(poses[0], x, jacobian);
    return 0;
}

/* 0: with a Jacobian, 1: without, 2: as a joint of distance 1. */
static void open_sphere(rig *s, int way, dmb_id *ball)
{
    dmb_body_def body = dmb_body_def_default();
    dmb_joint_def def = dmb_joint_def_default();
    const dmb_sim_options options = sharp_options(0.9, 1e-10);
    rig_open(s, 0.0, 0.0, -g);
    body.position[0] = 1.0;
    body.velocity[1] = 2.0;
    *ball = add_body(s, &body);
    def.kind = DMB_JOINT_DISTANCE;
    def.place_b = dmb_station(*ball, 0, 0.0);
    if (way == 2)
        (void)add_joint(s, &def);
    else
        (void)add_user(s, DMB_CONSTRAINT_HOLONOMIC, on_sphere, way == 0 ? DMB_PROVIDES_JACOBIAN : 0, *ball, NULL);
    (void)mechanism_start(s, &options);
}

static void three_ways_to_a_sphere(void **state)
{
    (void)state;
    rig s[3];
    dmb_id ball[3];
    double worst[2] = {0.0, 0.0}, off = 0.0, momentum = 0.0;
    uint32_t iterations[3];
    for (int i = 0; i < 3; i++) open_sphere(s + i, i, ball + i);
    for (int k = 0; k < 2000; k++) {
        for (int i = 0; i < 3; i++) take_steps(s + i, 1e-3, 1);
        for (int i = 0; i < 2; i++) worst[i] = fmax(worst[i], motion_difference(s + i, s + 2, ball + i, ball + 2, 1));
        const dmb_pose pose = pose_at(s + 1, dmb_station(ball[1], 0, 0.0));
        off = fmax(off, fabs(sqrt(pose.position[0] * pose.position[0] + pose.position[1] * pose.position[1] +
                                  pose.position[2] * pose.position[2]) -
                             1.0));
        momentum = fmax(momentum, fabs(momentum_of(s + 1).angular[2] - 2.0));
    }
    for (int i = 0; i < 3; i++) {
        iterations[i] = (uint32_t)statistics_of(s + i).iterations;
        rig_close(s + i);
    }
    check_below("caller's sphere with a Jacobian against a joint, 2 s", worst[0], 1e-7);
    check_below("caller's sphere without a Jacobian against a joint, 2 s", worst[1], 1e-7);
    check_below("distance from the sphere [m]", off, 1e-13);
    check_below("angular momentum about z [kg m2/s]", momentum, 1e-5);
    tell("iterations a step with a Jacobian", iterations[0] / 2000.0);
    tell("without", iterations[1] / 2000.0);
    tell("as a joint", iterations[2] / 2000.0);
}

/* The same sphere far from the origin, where rounding of a place is 2e-13 m and more. */
static const double far[3] = {2000.0, 500.0, -1500.0};

static int32_t on_far_sphere(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                             double *jacobian)
{
    double x[3];
    (void)context, (void)time, (void)count;
    for (int i = 0; i < 3; i++) x[i] = poses[0][i] - far[i];
    value[0] = 0.5 * (x[0] * x[0] + x[1] * x[1] + x[2] * x[2] - 1.0);
    if (jacobian != NULL) row_of(poses[0], x, jacobian);
    return 0;
}

static void check_far_sphere(const char *what, int32_t provides)
{
    dmb_body_def body = dmb_body_def_default();
    rig s, near;
    dmb_id ball;
    double worst = 0.0;
    open_sphere(&near, 2, &ball);
    rig_open(&s, 0.0, 0.0, -g);
    memcpy(body.position, far, sizeof far);
    body.position[0] += 1.0;
    body.velocity[1] = 2.0;
    const dmb_id id = add_body(&s, &body);
    (void)add_user(&s, DMB_CONSTRAINT_HOLONOMIC, on_far_sphere, provides, id, NULL);
    const dmb_sim_options options = sharp_options(0.9, 1e-10);
    (void)mechanism_start(&s, &options);
    for (int k = 0; k < 2000; k++) {
        take_steps(&s, 1e-3, 1); /* none of them is divided */
        take_steps(&near, 1e-3, 1);
        const dmb_pose a = pose_at(&s, dmb_station(id, 0, 0.0)), b = pose_at(&near, dmb_station(ball, 0, 0.0));
        worst = fmax(worst, largest_difference(3, a.displacement, b.displacement));
    }
    check_below(what, worst, 1e-7);
    tell("iterations a step", (double)statistics_of(&s).iterations / 2000.0);
    rig_close(&s);
    rig_close(&near);
}

static void far_from_the_origin(void **state)
{
    (void)state;
    check_far_sphere("2.5 km away: caller's sphere with a Jacobian [m]", DMB_PROVIDES_JACOBIAN);
    check_far_sphere("2.5 km away: caller's sphere without a Jacobian [m]", 0);
}

/* On a plane z = h(t) = 0.2 sin(3 t) that moves, without and with a Jacobian. */
static int32_t on_moving_plane(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                               double *jacobian)
{
    static const double up[3] = {0.0, 0.0, 1.0};
    (void)context, (void)count;
    value[0] = poses[0][2] - 0.2 * sin(3.0 * time);
    if (jacobian != NULL) row_of(poses[0], up, jacobian);
    return 0;
}

static void check_plane(int32_t provides)
{
    const double m = 2.5;
    dmb_body_def body = dmb_body_def_default();
    double worst[3] = {0.0, 0.0, 0.0}, f[6], work = 0.0, last = 0.0;
    rig s;
    rig_open(&s, 0.0, 0.0, -g);
    body.mass = m;
    body.centre[1] = 0.1; /* it rocks */
    body.inertia[0] = body.inertia[1] = body.inertia[2] = 0.3;
    body.velocity[0] = 1.0;
    body.velocity[2] = 0.6;
    const dmb_id id = add_body(&s, &body),
                 plane = add_user(&s, DMB_CONSTRAINT_HOLONOMIC, on_moving_plane, provides, id, NULL);
    const dmb_sim_options options = sharp_options(0.9, 1e-10);
    (void)mechanism_start(&s, &options);
    (void)multipliers_of(&s, plane, f);
    last = -f[0] * 0.6;
    for (int k = 0; k < 2000; k++) {
        take_steps(&s, 1e-3, 1);
        const double t = dmb_sim_time(s.sim);
        const dmb_place at = dmb_station(id, 0, 0.0);
        const dmb_motion motion = motion_at(&s, at, DMB_FRAME_WORLD);
        worst[0] = fmax(worst[0], fabs(pose_at(&s, at).position[2] - 0.2 * sin(3.0 * t)));
        worst[1] = fmax(worst[1], fabs(motion.velocity[2] - 0.6 * cos(3.0 * t)));
        (void)multipliers_of(&s, plane, f);
        const double power = -f[0] * 0.6 * cos(3.0 * t);
        work += 0.5e-3 * (last + power);
        last = power;
    }
    const dmb_energy energy = energy_of(&s);
    check_below("height on the moving plane [m]", worst[0], 1e-13);
    check_below("speed on the moving plane [m/s]", worst[1], 1e-9);
    check_relative("work of the plane is among the loads", energy.loads, work, 1e-9);
    check_below("balance over input", energy.error, 1e-5);
    rig_close(&s);
}

static void moving_plane(void **state)
{
    (void)state;
    check_plane(DMB_PROVIDES_JACOBIAN);
    check_plane(0);
}

/* A v + b with b of time: a body pushed along by a conveyor, x' = sin(2 t). */
static int32_t conveyor(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                        double *jacobian)
{
    static const double along[3] = {1.0, 0.0, 0.0};
    (void)context, (void)count;
    value[0] = -sin(2.0 * time);
    row_of(poses[0], along, jacobian);
    return 0;
}

static void speed_of_time(void **state)
{
    (void)state;
    dmb_body_def body = dmb_body_def_default();
    double worst[2] = {0.0, 0.0};
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    body.velocity[5] = 1.5; /* A turns in the body's frame */
    body.velocity[1] = 0.7;
    const dmb_id id = add_body(&s, &body);
    (void)add_user(&s, DMB_CONSTRAINT_NONHOLONOMIC, conveyor, DMB_PROVIDES_JACOBIAN, id, NULL);
    const dmb_sim_options options = sharp_options(0.9, 1e-10);
    (void)mechanism_start(&s, &options);
    for (int k = 0; k < 2000; k++) {
        take_steps(&s, 1e-3, 1);
        const double t = dmb_sim_time(s.sim);
        const dmb_place at = dmb_station(id, 0, 0.0);
        worst[0] = fmax(worst[0], fabs(motion_at(&s, at, DMB_FRAME_WORLD).velocity[0] - sin(2.0 * t)));
        worst[1] = fmax(worst[1], fabs(pose_at(&s, at).position[0] - 0.5 * (1.0 - cos(2.0 * t))));
    }
    check_below("speed on the conveyor [m/s]", worst[0], 1e-12);
    check_below("way on the conveyor [m]", worst[1], 1e-5);
    check_below("balance over input", energy_of(&s).error, 1e-4);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(knife_on_an_incline), cmocka_unit_test(sledge),
        cmocka_unit_test(rolling_down),        cmocka_unit_test(rolling_in_a_circle),
        cmocka_unit_test(wobbling_coin),       cmocka_unit_test(three_ways_to_a_sphere),
        cmocka_unit_test(far_from_the_origin), cmocka_unit_test(moving_plane),
        cmocka_unit_test(speed_of_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
