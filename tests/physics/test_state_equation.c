/* The state equation: rates against closed forms and differences of poses, an outside Runge-Kutta against the library's
 * own steps and a reference of high order, and scenes that have a memory. Equations: eq:joints.state-equation,
 * eq:joints.chart, eq:joints.chart-rate, eq:joints.accelerations, eq:joints.velocity-partition. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mechanism.h"
#include "ode.h"

enum { STATES_MAX = 200 };

typedef struct equation {
    dmb_state_equation *of;
    uint32_t count; /* numbers of y */
    double time;
    double y[STATES_MAX];
} equation;

static void must_hold(int32_t status)
{
    dmb_error error = dmb_error_default();
    if (status >= 0) return;
    (void)dmb_last_error(&error);
    fail_msg("status %d: %s", (int)status, error.message);
}

static equation equation_of(const rig *s)
{
    equation e = {.of = NULL};
    must(s, dmb_state_equation_create(s->sim, &e.of));
    e.count = 2 * dmb_state_equation_count(e.of);
    assert_in_range(e.count, 0, STATES_MAX);
    must_hold(dmb_state_equation_origin(e.of, &e.time, e.y));
    return e;
}

static void classical_step(equation *e, double h)
{
    static const double at[4] = {0.0, 0.5, 0.5, 1.0}, weight[4] = {1.0, 2.0, 2.0, 1.0};
    double k[STATES_MAX] = {0.0}, sum[STATES_MAX] = {0.0}, there[STATES_MAX];
    for (int stage = 0; stage < 4; stage++) {
        for (uint32_t i = 0; i < e->count; i++) there[i] = e->y[i] + h * at[stage] * k[i];
        must_hold(dmb_state_equation_rate(e->of, e->time + h * at[stage], there, k));
        for (uint32_t i = 0; i < e->count; i++) sum[i] += h / 6.0 * weight[stage] * k[i];
    }
    for (uint32_t i = 0; i < e->count; i++) e->y[i] += sum[i];
    e->time += h;
}

static void integrate(equation *e, double h, uint32_t steps)
{
    for (uint32_t i = 0; i < steps; i++) classical_step(e, h);
}

static const dmb_sim *evaluate(equation *e)
{
    double rate[STATES_MAX];
    must_hold(dmb_state_equation_rate(e->of, e->time, e->y, rate));
    return dmb_state_equation_sim(e->of);
}

static dmb_joint_state joint_of(const dmb_sim *sim, dmb_id joint)
{
    dmb_joint_state state = dmb_joint_state_default();
    must_hold(dmb_query_joint(sim, joint, &state));
    return state;
}

/* ---- A pendulum: closed forms ------------------------------------------------------------------------------------ */

/* A bar of length 1, hinged at its end in the origin: a'' = -3/2 g cos a by the angle from x, and at the hinge, mass m,
 * along the bar -m/2 a'^2 + m g sin a, across it m g cos a - m/2 * 3/2 g cos a = m g cos a/4. */
static void a_pendulum_by_closed_forms(void **state)
{
    (void)state;
    const double angle = 0.7, speed = 2.3, g = 9.81, m = 3.0;
    const bar rod = {{0.0, 0.0}, {cos(angle), sin(angle)}, m};
    double rate[STATES_MAX];
    rig s;
    rig_open(&s, 0.0, 0.0, -g);
    dmb_body_def body = bar_body(&rod);
    body.velocity[2] = 0.5 * speed;
    body.velocity[4] = -speed;
    const dmb_id part = add_body(&s, &body);
    const dmb_id hinge = add_hinge(&s, "hinge", DMB_JOINT_REVOLUTE, pin_ground(0.0, 0.0), pin_on(part, -0.5));
    (void)mechanism_start(&s, NULL);
    const uint64_t before = rig_hash(&s);
    equation e = equation_of(&s);
    assert_int_equal(e.count, 2);
    must_hold(dmb_state_equation_rate(e.of, 0.0, e.y, rate));
    const dmb_joint_state at = joint_of(dmb_state_equation_sim(e.of), hinge);
    check_close("angular acceleration", at.acceleration[DMB_RX], -1.5 * g * cos(angle), 1e-12);
    const double along = m * (-0.5 * speed * speed + g * sin(angle)), across = 0.25 * m * g * cos(angle);
    check_close("reaction, x", at.reaction[0], along * cos(angle) - across * sin(angle), 1e-11);
    check_close("reaction, z", at.reaction[2], along * sin(angle) + across * cos(angle), 1e-11);
    assert_int_equal(rig_hash(&s), before);
    uint32_t row;
    must_hold(dmb_state_equation_rows(e.of, &row));
    dmb_row where = dmb_row_default();
    must(&s, dmb_query_row(s.sim, row, &where));
    assert_int_equal(where.part.index, part.index);
    dmb_state_equation_destroy(&e.of);
    assert_null(e.of);
    rig_close(&s);
}

static void pendulum_rate(void *context, double t, const double *y, double *rate)
{
    (void)context;
    (void)t;
    rate[0] = y[1];
    rate[1] = -1.5 * 9.81 * cos(y[0]);
}

/* Largest error of the angle over 2 s; the origin follows the bar every 0.1 s. */
static double turn_over(double h)
{
    const bar rod = {{0.0, 0.0}, {1.0, 0.0}, 1.0};
    double want[2] = {0.0, 8.0}, worst = 0.0;
    rig s;
    rig_open(&s, 0.0, 0.0, -9.81);
    dmb_body_def body = bar_body(&rod);
    body.velocity[2] = 4.0;
    body.velocity[4] = -8.0;
    const dmb_id part = add_body(&s, &body);
    const dmb_id hinge = add_hinge(&s, "hinge", DMB_JOINT_REVOLUTE, pin_ground(0.0, 0.0), pin_on(part, -0.5));
    (void)mechanism_start(&s, NULL);
    equation e = equation_of(&s);
    rig_close(&s); /* the equation stays */
    for (int i = 0; i < 20; i++) {
        integrate(&e, h, (uint32_t)lround(0.1 / h));
        must_hold(dmb_state_equation_begin(e.of, e.time, e.y));
        ode_solve(pendulum_rate, NULL, 0.1 * i, 0.1 * (i + 1), 400, 2, want);
        const dmb_joint_state at = joint_of(dmb_state_equation_sim(e.of), hinge);
        worst = fmax(worst, fabs(at.position[DMB_RX] - want[0]));
        assert_true(at.violation <= 1e-14);
    }
    assert_true(fabs(want[0]) > 2.0 * PI);
    dmb_state_equation_destroy(&e.of);
    return worst;
}

static void a_pendulum_that_turns_over(void **state)
{
    (void)state;
    const double coarse = turn_over(5e-3), fine = turn_over(2.5e-3);
    check_order("angle of the pendulum", coarse, fine, 4.0, 0.15);
    check_below("with the smaller step", fine, 1e-9);
}

/* ---- Four-bars --------------------------------------------------------------------------------------------------- */

/* Two four-bars in a row with equal bars of length and mass 1: 3 a'' = -3.5 g cos a (test_joint_fourbars). */
static void four_bars_rate(void *context, double t, const double *y, double *rate)
{
    (void)context;
    (void)t;
    rate[0] = y[1];
    rate[1] = -3.5 / 3.0 * 9.81 * cos(y[0]);
}

static rig open_four_bars(dmb_id *first, const dmb_sim_options *options)
{
    static const uint32_t left[4] = {0, 1, 1, 2}, right[4] = {3, 3, 4, 4};
    static const double end[4] = {-0.5, 0.5, -0.5, 0.5};
    dmb_id bars[5];
    rig s;
    rig_open(&s, 0.0, 0.0, -9.81);
    for (int i = 0; i < 5; i++) {
        const double x = i < 3 ? i : i - 3;
        const bar crank = {{x, 0.0}, {x, 1.0}, 1.0}, coupler = {{x, 1.0}, {x + 1.0, 1.0}, 1.0};
        dmb_body_def body = bar_body(i < 3 ? &crank : &coupler);
        body.velocity[i < 3 ? 2 : 0] = i < 3 ? -0.5 : 1.0;
        body.velocity[4] = i < 3 ? 1.0 : 0.0;
        bars[i] = add_body(&s, &body);
    }
    for (uint32_t i = 0; i < 3; i++) {
        const dmb_id foot = add_hinge(&s, "", DMB_JOINT_REVOLUTE, pin_ground(i, 0.0), pin_on(bars[i], -0.5));
        if (i == 0) *first = foot;
    }
    for (uint32_t i = 0; i < 4; i++)
        (void)add_hinge(&s, "", DMB_JOINT_REVOLUTE, pin_on(bars[left[i]], 0.5), pin_on(bars[right[i]], end[i]));
    (void)mechanism_start(&s, options);
    return s;
}

static double four_bars_by_steps(double h, double *angle)
{
    const dmb_sim_options options = sharp_options(0.8, 1e-12);
    dmb_id foot;
    rig s = open_four_bars(&foot, &options);
    take_steps(&s, h, (uint32_t)lround(0.6 / h));
    *angle = joint_at(&s, foot).position[DMB_RX];
    rig_close(&s);
    return *angle;
}

static void four_bars_by_runge_kutta(void **state)
{
    (void)state;
    dmb_id foot;
    double want[2] = {0.5 * PI, -1.0}, steps[2], own[2];
    double angle[2];
    ode_solve(four_bars_rate, NULL, 0.0, 0.6, 4000, 2, want);
    for (int k = 0; k < 2; k++) {
        rig s = open_four_bars(&foot, NULL);
        equation e = equation_of(&s);
        assert_int_equal(e.count, 2);
        integrate(&e, 5e-3 / (1 + k), 120U * (1U + (uint32_t)k));
        angle[k] = joint_of(evaluate(&e), foot).position[DMB_RX];
        own[k] = fabs(angle[k] - want[0]);
        dmb_state_equation_destroy(&e.of);
        rig_close(&s);
    }
    check_order("angle by the outside integrator", own[0], own[1], 4.0, 0.3);
    check_below("with a step of 2.5e-3", own[1], 1e-9);
    for (int k = 0; k < 2; k++) steps[k] = fabs(four_bars_by_steps(2e-3 / (1 + k), &angle[0]) - angle[1]);
    check_order("dmb_sim_step against it", steps[0], steps[1], 2.0, 0.1);
}

/* ---- A linkage that a drive turns over and over ------------------------------------------------------------------ */

/* A drag link in the plane of y and z: crank from (0, 0) to (0.3, 0), coupler to (0.3, 0.3), rocker from (0.1, 0).
 * Crank and rocker make whole turns. The crank is at rest up to 4 s and turns by 9 rad/s from 4.2 s on, moved by a
 * drive on itself or on its joint. */
typedef struct linkage {
    rig s;
    dmb_id rocker; /* its joint with the ground */
} linkage;

static dmb_id add_axle(rig *s, dmb_id a, const double at_a[2], dmb_id b, const double at_b[2])
{
    dmb_joint_def joint = joint_between(DMB_JOINT_REVOLUTE, dmb_station(a, 0, 0.0), dmb_station(b, 0, 0.0));
    memcpy(joint.origin_a + 1, at_a, 2 * sizeof *at_a);
    memcpy(joint.origin_b + 1, at_b, 2 * sizeof *at_b);
    return add_joint(s, &joint);
}

static linkage open_linkage(int on_joint)
{
    static const double place[3][2] = {{0.0, 0.0}, {0.3, 0.15}, {0.2, 0.15}};
    linkage m;
    dmb_id part[3];
    rig_open(&m.s, 0.0, 0.0, -9.81);
    for (int i = 0; i < 3; i++) {
        dmb_body_def body = dmb_body_def_default();
        memcpy(body.position + 1, place[i], sizeof place[i]);
        if (i == 0 && !on_joint) body.free_mask = DMB_FREE_RX;
        part[i] = add_body(&m.s, &body);
    }
    const double none[2] = {0.0, 0.0};
    dmb_id driven = part[0];
    if (on_joint) driven = add_axle(&m.s, ground_id, none, part[0], none);
    (void)add_axle(&m.s, part[0], (double[2]){0.3, 0.0}, part[1], (double[2]){0.0, -0.15});
    (void)add_axle(&m.s, part[1], (double[2]){0.0, 0.15}, part[2], (double[2]){0.1, 0.15});
    m.rocker = add_axle(&m.s, ground_id, (double[2]){0.1, 0.0}, part[2], (double[2]){-0.1, -0.15});
    const dmb_segment start = {
        .struct_size = sizeof start, .kind = DMB_SEGMENT_STEP, .x0 = 4.0, .x1 = 4.2, .h0 = 0.0, .h1 = 9.0};
    (void)add_simple_drive(&m.s, DMB_DRIVE_MOTION, driven, DMB_RX, add_time_function(&m.s, &start, 1));
    (void)mechanism_start(&m.s, NULL);
    return m;
}

/* Angle of the rocker from its start, by the triangle of its pivot and both ends of the coupler, at an angle of the
 * crank that is reached in small parts. */
static double rocker_angle(double crank)
{
    const double length = sqrt(0.04 + 0.09);
    double last = 0.0, start = 0.0;
    for (int i = 0; i <= 2000; i++) {
        const double y = 0.3 * cos(crank * i / 2000) - 0.1, z = 0.3 * sin(crank * i / 2000), d = hypot(y, z);
        const double angle = atan2(z, y) + acos((d * d + length * length - 0.09) / (2.0 * d * length));
        if (i == 0) last = start = angle;
        last += remainder(angle - last, 2.0 * PI);
    }
    return last - start;
}

/* Its revolutions are counted and its branch is kept, however late the drive begins. */
static void a_linkage_that_turns(void **state)
{
    (void)state;
    for (int on_joint = 0; on_joint < 2; on_joint++) {
        linkage m = open_linkage(on_joint);
        equation e = equation_of(&m.s);
        assert_int_equal(e.count, 0);
        for (int i = 1; i <= 12; i++) {
            e.time = 4.2 + 0.43 * i;
            const double want = rocker_angle(9.0 * (e.time - 4.1));
            check_close("angle of the rocker", joint_of(evaluate(&e), m.rocker).position[DMB_RX], want, 1e-12);
        }
        dmb_state_equation_destroy(&e.of);
        rig_close(&m.s);
    }
}

/* A drive of an open joint moves nothing, however long. */
static void a_drive_of_an_open_joint(void **state)
{
    (void)state;
    const double none[2] = {0.0, 0.0}, time = 500.0, want = -9.81;
    rig s;
    rig_open(&s, 0.0, 0.0, want);
    const dmb_body_def body = dmb_body_def_default();
    const dmb_id part = add_body(&s, &body), axle = add_axle(&s, ground_id, none, part, none);
    (void)add_simple_drive(&s, DMB_DRIVE_MOTION, axle, DMB_RX, add_constant(&s, 9.0));
    (void)mechanism_start(&s, NULL);
    must(&s, dmb_sim_set_joint(s.sim, axle, DMB_JOINT_OPEN));
    equation e = equation_of(&s);
    double rate[STATES_MAX];
    assert_int_equal(e.count, 12);
    must_hold(dmb_state_equation_rate(e.of, time, e.y, rate));
    check_close("acceleration", rate[6 + DMB_Z], want, 1e-14);
    check_close("spin, as before it opened", rate[DMB_RX], 9.0, 1e-14);
    dmb_state_equation_destroy(&e.of);
    rig_close(&s);
}

/* ---- A string, gears, drives: differences of poses --------------------------------------------------------------- */

/* A bent string that a top drive feeds and turns, a body by a universal joint at its end, a geared wheel and a crank
 * that a drive turns. */
typedef struct machine {
    rig s;
    dmb_id string, body, wheel[2], crank;
} machine;

static machine open_machine(void)
{
    machine m;
    dmb_pipe_def pipe = beam_pipe(0.5, 1, 2e5, 1e5, 500.0, 400.0);
    dmb_joint_def joint;
    rig_open(&m.s, 0.0, 0.0, -9.81);
    pipe.damping_time = 1e-4;
    m.string = add_beam(&m.s, &pipe, DMB_FREE_CYLINDRICAL);
    (void)add_pipes(&m.s, &pipe, 1);
    const dmb_segment spin[2] = {
        {.struct_size = sizeof(dmb_segment), .kind = DMB_SEGMENT_CONSTANT, .h0 = 40.0},
        {.struct_size = sizeof(dmb_segment), .kind = DMB_SEGMENT_HARMONIC, .h1 = 3.0, .omega = 5.0}};
    (void)add_simple_drive(&m.s, DMB_DRIVE_MOTION, m.string, DMB_RX, add_time_function(&m.s, spin, 2));
    (void)add_simple_drive(&m.s, DMB_DRIVE_MOTION, m.string, DMB_X, add_time_function(&m.s, spin + 1, 1));
    dmb_body_def body = dmb_body_def_default();
    body.position[0] = 1.2;
    body.inertia[0] = 0.02, body.inertia[1] = 0.03, body.inertia[2] = 0.04;
    m.body = add_body(&m.s, &body);
    joint = joint_between(DMB_JOINT_UNIVERSAL, dmb_station(m.string, 1, 1.0), dmb_station(m.body, 0, 0.0));
    joint.match = 1;
    joint.origin_a[0] = 0.1;
    joint.stiffness[DMB_RZ] = 20.0;
    (void)add_joint(&m.s, &joint);
    dmb_id axle[2];
    for (int i = 0; i < 2; i++) {
        dmb_body_def wheel = dmb_body_def_default();
        wheel.position[1] = 1.0 + 0.3 * i;
        for (int k = 0; k < 3; k++) wheel.inertia[k] = 0.05;
        wheel.velocity[3] = i == 0 ? 30.0 : -60.0;
        m.wheel[i] = add_body(&m.s, &wheel);
        joint = joint_between(DMB_JOINT_REVOLUTE, (dmb_place){0}, dmb_station(m.wheel[i], 0, 0.0));
        joint.match = 1;
        joint.damping[DMB_RX] = 0.1;
        axle[i] = add_joint(&m.s, &joint);
    }
    dmb_coupling_def gear = dmb_coupling_def_default();
    gear.joint[0] = axle[0], gear.joint[1] = axle[1];
    gear.ratio = -0.5;
    dmb_id unused;
    must_model(&m.s, dmb_model_add_coupling(m.s.model, &gear, &unused));
    const bar rod = {{-1.0, 0.0}, {-1.0, 0.4}, 2.0};
    m.crank = add_bar(&m.s, &rod);
    const dmb_id pivot = add_hinge(&m.s, "", DMB_JOINT_REVOLUTE, pin_ground(-1.0, 0.0), pin_on(m.crank, -0.2));
    (void)add_simple_drive(&m.s, DMB_DRIVE_MOTION, pivot, DMB_RX, add_time_function(&m.s, spin + 1, 1));
    (void)mechanism_start(&m.s, NULL);
    return m;
}

typedef struct sight {
    double x[7][3], R[7][9], v[7][6], a[7][6];
} sight;

static void look(const machine *m, const dmb_sim *sim, sight *to)
{
    const dmb_place places[7] = {dmb_station(m->string, 0, 0.0),   dmb_station(m->string, 0, 1.0),
                                 dmb_station(m->string, 1, 1.0),   dmb_station(m->body, 0, 0.0),
                                 dmb_station(m->wheel[0], 0, 0.0), dmb_station(m->wheel[1], 0, 0.0),
                                 dmb_station(m->crank, 0, 0.0)};
    for (int i = 0; i < 7; i++) {
        dmb_pose pose = dmb_pose_default();
        dmb_motion motion = dmb_motion_default();
        must_hold(dmb_query_pose(sim, places[i], &pose));
        must_hold(dmb_query_motion(sim, places[i], &motion));
        memcpy(to->x[i], pose.position, sizeof pose.position);
        memcpy(to->R[i], pose.rotation, sizeof pose.rotation);
        memcpy(to->v[i], motion.velocity, sizeof motion.velocity);
        memcpy(to->a[i], motion.acceleration, sizeof motion.acceleration);
    }
}

/* World rotation rate by R' R^T of two rotations 2 h apart. */
static void spin_of(const double R0[9], const double R1[9], const double R[9], double h, double w[3])
{
    double D[9], S[9];
    for (int i = 0; i < 9; i++) D[i] = (R1[i] - R0[i]) / (2.0 * h);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            S[3 * i + k] = D[3 * i] * R[3 * k] + D[3 * i + 1] * R[3 * k + 1] + D[3 * i + 2] * R[3 * k + 2];
    w[0] = 0.5 * (S[7] - S[5]), w[1] = 0.5 * (S[2] - S[6]), w[2] = 0.5 * (S[3] - S[1]);
}

static void compare_rates(const sight *before, const sight *at, const sight *after, double h, double worst[3])
{
    for (int i = 0; i < 7; i++) {
        double w[3];
        spin_of(before->R[i], after->R[i], at->R[i], h, w);
        for (int k = 0; k < 3; k++) {
            worst[0] = fmax(worst[0], fabs((after->x[i][k] - before->x[i][k]) / (2.0 * h) - at->v[i][k]));
            worst[1] = fmax(worst[1], fabs(w[k] - at->v[i][3 + k]));
        }
        for (int k = 0; k < 6; k++)
            worst[2] = fmax(worst[2], fabs((after->v[i][k] - before->v[i][k]) / (2.0 * h) - at->a[i][k]));
    }
}

/* At random states, far from the origin too: the pose along y + s f changes by the velocity, the velocity by the
 * acceleration, also of what is dependent or prescribed. */
static void rates_are_those_of_poses(void **state)
{
    (void)state;
    const double h = 1e-6;
    uint64_t seed = 11;
    machine m = open_machine();
    equation e = equation_of(&m.s);
    uint32_t rows[STATES_MAX];
    must_hold(dmb_state_equation_rows(e.of, rows));
    assert_int_equal(e.count, 2 * (12 + 2 + 1));
    for (int trial = 0; trial < 6; trial++) {
        double y[STATES_MAX], rate[STATES_MAX], there[STATES_MAX], worst[3] = {0.0};
        sight at[3];
        const double time = draw_between(&seed, 0.0, 3.0), size = trial == 0 ? 0.0 : 0.05 * trial;
        for (uint32_t i = 0; i < e.count; i++)
            y[i] = e.y[i] + size * draw_between(&seed, -1.0, 1.0) * (i < e.count / 2 ? 1.0 : 10.0);
        for (uint32_t i = 0; i < e.count / 2; i++) {
            dmb_row row = dmb_row_default();
            must(&m.s, dmb_query_row(m.s.sim, rows[i], &row));
            if (row.part.index == m.string.index && row.component == DMB_RX) /* the string turns with its top drive */
                y[i] += 40.0 * time + 0.6 * (1.0 - cos(5.0 * time));
            if (row.part.index == m.string.index && row.component == DMB_X) y[i] += 0.6 * (1.0 - cos(5.0 * time));
        }
        must_hold(dmb_state_equation_rate(e.of, time, y, rate));
        look(&m, dmb_state_equation_sim(e.of), &at[1]);
        for (int side = 0; side < 3; side += 2) {
            for (uint32_t i = 0; i < e.count; i++) there[i] = y[i] + (side - 1) * h * rate[i];
            double unused[STATES_MAX];
            must_hold(dmb_state_equation_rate(e.of, time + (side - 1) * h, there, unused));
            look(&m, dmb_state_equation_sim(e.of), &at[side]);
        }
        compare_rates(&at[0], &at[1], &at[2], h, worst);
        double scale[2] = {1.0, 1.0};
        for (int i = 0; i < 7; i++) scale[0] = fmax(scale[0], largest(6, at[1].v[i]));
        for (int i = 0; i < 7; i++) scale[1] = fmax(scale[1], largest(6, at[1].a[i]));
        print_message("  state %d: largest velocity %g, acceleration %g\n", trial, scale[0], scale[1]);
        check_below("velocity by poses", worst[0] / scale[0], 1e-8);
        check_below("spin by poses", worst[1] / scale[0], 1e-8);
        check_below("acceleration by velocities", worst[2] / scale[1], 1e-7);
    }
    dmb_state_equation_destroy(&e.of);
    rig_close(&m.s);
}

/* Equal y have equal bits, whatever was asked in between; the sim goes on as if it had not been asked. */
static void equal_states_have_equal_bits(void **state)
{
    (void)state;
    machine m = open_machine(), other = open_machine();
    double first[STATES_MAX], rate[STATES_MAX], far[STATES_MAX];
    take_steps(&m.s, 1e-4, 5);
    take_steps(&other.s, 1e-4, 5);
    equation e = equation_of(&m.s);
    memcpy(far, e.y, sizeof far);
    for (uint32_t i = 0; i < e.count; i++) far[i] += 0.01 * (double)(i % 5);
    must_hold(dmb_state_equation_rate(e.of, e.time + 1e-3, far, first));
    must_hold(dmb_state_equation_rate(e.of, e.time, e.y, rate));
    must_hold(dmb_state_equation_rate(e.of, e.time + 1e-3, far, rate));
    assert_memory_equal(first, rate, e.count * sizeof *rate);
    take_steps(&m.s, 1e-4, 5);
    take_steps(&other.s, 1e-4, 5);
    assert_int_equal(rig_hash(&m.s), rig_hash(&other.s));
    dmb_state_equation_destroy(&e.of);
    rig_close(&m.s);
    rig_close(&other.s);
}

/* ---- A string on the wall ---------------------------------------------------------------------------------------- */

static rig open_string_on_wall(const dmb_sim_options *options, dmb_id *string)
{
    dmb_wall_def wall = s1_hole();
    dmb_pipe_def pipe = s1_pipe();
    rig s;
    rig_open(&s, 0.0, 0.0, -9.81);
    wall.normal_law = DMB_NORMAL_KELVIN_VOIGT;
    wall.damping = 2e3;
    wall.friction_law = DMB_FRICTION_STRIBECK;
    wall.smoothing_speed = 0.01;
    wall.stribeck_speed = 0.1;
    (void)add_wall(&s, &wall);
    dmb_string_def def = dmb_string_def_default();
    def.offset[1] = -(0.047 - 0.0365 + 2e-5); /* pressed into the wall a little */
    def.start_free = DMB_FREE_ALL;
    *string = add_string(&s, &def);
    pipe.string = *string;
    pipe.damping_time = 1e-5;
    (void)add_pipes(&s, &pipe, 2);
    const dmb_segment ramp = {.struct_size = sizeof ramp, .kind = DMB_SEGMENT_HARMONIC, .h1 = 60.0, .omega = 300.0};
    (void)add_simple_drive(&s, DMB_DRIVE_LOAD, *string, DMB_RX, add_time_function(&s, &ramp, 1));
    (void)add_simple_drive(&s, DMB_DRIVE_LOAD, *string, DMB_X, add_time_function(&s, &ramp, 1));
    (void)rig_start(&s, options);
    return s;
}

static void end_of(const dmb_sim *sim, dmb_id string, double out[12])
{
    dmb_pose pose = dmb_pose_default();
    dmb_motion motion = dmb_motion_default();
    must_hold(dmb_query_pose(sim, dmb_station(string, 1, 1.0), &pose));
    must_hold(dmb_query_motion(sim, dmb_station(string, 1, 1.0), &motion));
    memcpy(out, pose.position, sizeof pose.position);
    memcpy(out + 3, pose.rotation, 3 * sizeof *out);
    memcpy(out + 6, motion.velocity, 6 * sizeof *out);
}

static void a_string_on_the_wall(void **state)
{
    (void)state;
    const dmb_sim_options options = sharp_options(0.8, 1e-12);
    dmb_id string;
    double want[2][12], error[3];
    for (int k = 0; k < 2; k++) {
        rig s = open_string_on_wall(&options, &string);
        equation e = equation_of(&s);
        integrate(&e, 1e-5 / (1 + k), 400U * (1U + (uint32_t)k));
        end_of(evaluate(&e), string, want[k]);
        dmb_contact_total total = dmb_contact_total_default();
        must_hold(dmb_query_contact_total(dmb_state_equation_sim(e.of), &total));
        assert_int_equal(total.closed, 3);
        dmb_state_equation_destroy(&e.of);
        rig_close(&s);
    }
    tell("change of the reference with half its step", largest_difference(12, want[0], want[1]));
    for (int k = 0; k < 3; k++) {
        double got[12];
        rig s = open_string_on_wall(&options, &string);
        const double h = 1e-5 / (1 << k);
        take_steps(&s, h, (uint32_t)lround(4e-3 / h));
        end_of(s.sim, string, got);
        error[k] = largest_difference(12, got, want[1]);
        rig_close(&s);
    }
    check_order("steps of the library against it", error[0], error[1], 2.0, 0.2);
    check_order("with half the step", error[1], error[2], 2.0, 0.2);
    check_below("at the last of them", error[2], 1e-5);
}

/* ---- Refusals ---------------------------------------------------------------------------------------------------- */

enum { BRISTLES, RESTITUTION, ROCK, INTEGRAL, LAG, STUCK, KNIFE, ACROSS, CASES };
static const char *const said[CASES] = {"BRISTLE",  "normal_law", "rock_law",     "integral_gain",
                                        "actuator", "stuck",      "nonholonomic", "path"};

static rig open_with(int which)
{
    dmb_wall_def wall = s1_hole();
    dmb_pipe_def pipe = s1_pipe();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_body_def body = dmb_body_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, -9.81);
    wall.normal_law = which == RESTITUTION ? DMB_NORMAL_EXACT : DMB_NORMAL_IMPACT;
    if (which == BRISTLES) wall.friction_law = DMB_FRICTION_BRISTLE;
    (void)add_wall(&s, &wall);
    const dmb_id string = add_pipes(&s, &pipe, 1), part = add_body(&s, &body);
    if (which == ROCK) {
        dmb_bit_def bit = dmb_bit_def_default();
        dmb_id unused;
        bit.rock_law = DMB_ROCK_RATE;
        must_model(&s, dmb_model_add_bit(s.model, &bit, &unused));
    }
    drive.part = string;
    drive.component = DMB_RX;
    drive.kind = DMB_DRIVE_CONTROL;
    drive.gain = 10.0;
    if (which == INTEGRAL) drive.integral_gain = 1.0;
    if (which == LAG) drive.lag = 0.01;
    if (which == ACROSS) {
        drive.kind = DMB_DRIVE_MOTION;
        drive.gain = 0.0;
        drive.part = part;
        drive.component = DMB_Y;
    }
    (void)add_drive(&s, &drive);
    if (which == STUCK) {
        dmb_stuck_def stuck = dmb_stuck_def_default();
        dmb_id unused;
        stuck.place = dmb_station(part, 0, 0.0);
        must_model(&s, dmb_model_add_stuck(s.model, &stuck, &unused));
    }
    if (which == KNIFE) (void)add_joint_between(&s, DMB_JOINT_KNIFE_EDGE, (dmb_place){0}, dmb_station(part, 0, 0.0));
    (void)rig_start(&s, NULL);
    return s;
}

static void a_memory_is_refused_by_name(void **state)
{
    (void)state;
    for (int which = 0; which <= CASES; which++) {
        rig s = open_with(which);
        dmb_state_equation *made = (dmb_state_equation *)&s;
        const uint64_t before = rig_hash(&s);
        const int32_t status = dmb_state_equation_create(s.sim, &made);
        assert_int_equal(rig_hash(&s), before);
        if (which == CASES) {
            assert_int_equal(status, DMB_OK);
            dmb_state_equation_destroy(&made);
        } else {
            print_message("  %s\n", dmb_sim_message(s.sim));
            assert_int_equal(status, DMB_ERR_UNSUPPORTED);
            assert_null(made);
            assert_non_null(strstr(dmb_sim_message(s.sim), said[which]));
        }
        rig_close(&s);
    }
}

static void expect_refusal(int32_t status, int32_t want, const char *text)
{
    dmb_error error = dmb_error_default();
    (void)dmb_last_error(&error);
    print_message("  %s\n", error.message);
    assert_int_equal(status, want);
    assert_non_null(strstr(error.message, text));
}

static void a_state_that_is_none(void **state)
{
    (void)state;
    dmb_id foot;
    rig s = open_four_bars(&foot, NULL);
    equation e = equation_of(&s);
    double y[2], rate[2] = {7.0, 7.0};
    memcpy(y, e.y, sizeof y);
    y[0] = (double)NAN;
    expect_refusal(dmb_state_equation_rate(e.of, 0.0, y, rate), DMB_ERR_NOT_FINITE, "y[0]");
    assert_non_null(dmb_state_equation_sim(e.of)); /* still that of before */
    y[0] = 1e31;
    expect_refusal(dmb_state_equation_rate(e.of, 0.0, y, rate), DMB_ERR_VALUE, "y[0]");
    expect_refusal(dmb_state_equation_rate(e.of, (double)INFINITY, e.y, rate), DMB_ERR_NOT_FINITE, "time");
    y[0] = 1e6;
    expect_refusal(dmb_state_equation_rate(e.of, 0.0, y, rate), DMB_ERR_GEOMETRY, "dmb_state_equation_begin");
    assert_null(dmb_state_equation_sim(e.of));
    y[0] = 1.2; /* further than the coordinate, which is that of a bar of length 1, can go or be told apart */
    const int32_t status = dmb_state_equation_rate(e.of, 0.0, y, rate);
    assert_true(status < 0);
    assert_true(rate[0] == 7.0 && rate[1] == 7.0);
    must_hold(dmb_state_equation_rate(e.of, 0.0, e.y, rate));
    assert_non_null(dmb_state_equation_sim(e.of));
    dmb_state_equation_destroy(&e.of);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_pendulum_by_closed_forms),   cmocka_unit_test(a_pendulum_that_turns_over),
        cmocka_unit_test(four_bars_by_runge_kutta),     cmocka_unit_test(rates_are_those_of_poses),
        cmocka_unit_test(equal_states_have_equal_bits), cmocka_unit_test(a_string_on_the_wall),
        cmocka_unit_test(a_memory_is_refused_by_name),  cmocka_unit_test(a_state_that_is_none),
        cmocka_unit_test(a_linkage_that_turns),         cmocka_unit_test(a_drive_of_an_open_joint),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
