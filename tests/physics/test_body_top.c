/* One body on three rotations or free: the heavy top, free tumbling, and their reactions. */
#include <stdio.h>
#include <string.h>

#include "ode.h"
#include "rig.h"

/* Rigid body about a fixed point: y = quaternion (scalar first), body-frame angular velocity. */
typedef struct body_data {
    double J[3];      /* [kg m2] principal, at the fixed point */
    double mass;      /* [kg] */
    double centre[3]; /* [m] */
    double g[3];      /* [m/s2] world */
} body_data;

static void cross(const double a[3], const double b[3], double c[3])
{
    const double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
    c[0] = x, c[1] = y, c[2] = z;
}

static void matrix_of(const double q[4], double R[9])
{
    const double n = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) R[3 * i + j] = 2.0 * q[1 + i] * q[1 + j] / n;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        R[4 * i] += (2.0 * q[0] * q[0]) / n - 1.0;
        R[3 * k + j] += 2.0 * q[0] * q[1 + i] / n;
        R[3 * j + k] -= 2.0 * q[0] * q[1 + i] / n;
    }
}

static void turn_back(const double R[9], const double x[3], double out[3])
{
    for (int i = 0; i < 3; i++) out[i] = R[i] * x[0] + R[3 + i] * x[1] + R[6 + i] * x[2];
}

/* J w' = J w x w + m c x R^T g */
static void angular_acceleration(const body_data *b, const double *y, double out[3])
{
    double R[9], g[3], p[3], t[3];
    const double *w = y + 4;
    matrix_of(y, R);
    turn_back(R, b->g, g);
    for (int i = 0; i < 3; i++) p[i] = b->J[i] * w[i];
    cross(p, w, out);
    cross(b->centre, g, t);
    for (int i = 0; i < 3; i++) out[i] = (out[i] + b->mass * t[i]) / b->J[i];
}

static void body_rate(void *context, double t, const double *y, double *rate)
{
    const double *q = y, *w = y + 4;
    (void)t;
    rate[0] = -0.5 * (q[1] * w[0] + q[2] * w[1] + q[3] * w[2]);
    rate[1] = 0.5 * (q[0] * w[0] + q[2] * w[2] - q[3] * w[1]);
    rate[2] = 0.5 * (q[0] * w[1] + q[3] * w[0] - q[1] * w[2]);
    rate[3] = 0.5 * (q[0] * w[2] + q[1] * w[1] - q[2] * w[0]);
    angular_acceleration((const body_data *)context, y, rate + 4);
}

/* Force at the fixed point in body axes, m (a_c - g). */
static void fixed_point_force(const body_data *b, const double *y, double out[3])
{
    double R[9], g[3], a[3], t[3], u[3];
    const double *w = y + 4;
    angular_acceleration(b, y, a);
    cross(a, b->centre, t);
    cross(w, b->centre, u);
    cross(w, u, u);
    matrix_of(y, R);
    turn_back(R, b->g, g);
    for (int i = 0; i < 3; i++) out[i] = b->mass * (t[i] + u[i] - g[i]);
}

/* ---- Heavy top --------------------------------------------------------------------------------------------------- */

/* Geradin, Cardona 2001; Bruls, Cardona 2010: m 15, J (.234375, .46875, .234375) at the centre, centre at (0, 1, 0). */
static const body_data top = {{15.234375, 0.46875, 15.234375}, 15.0, {0.0, 1.0, 0.0}, {0.0, 0.0, -9.81}};
static const double top_start[7] = {1.0, 0.0, 0.0, 0.0, 0.0, 150.0, -4.61538};

static dmb_id open_top(rig *s, const dmb_sim_options *options)
{
    dmb_body_def body = dmb_body_def_default();
    rig_open(s, 0.0, 0.0, -9.81);
    body.free_mask = DMB_FREE_SPHERICAL;
    body.mass = 15.0;
    body.centre[1] = 1.0;
    body.inertia[0] = body.inertia[2] = 0.234375;
    body.inertia[1] = 0.46875;
    memcpy(body.velocity + 3, top_start + 4, 3 * sizeof(double));
    const dmb_id id = add_body(s, &body);
    assert_int_equal(rig_start(s, options), DMB_OK);
    return id;
}

typedef struct top_error {
    double place, component, speed, reaction;
} top_error;

static top_error error_of_top(const rig *s, dmb_id id, const double *y)
{
    const dmb_pose pose = pose_at(s, dmb_station(id, 0, 0.0));
    const dmb_motion motion = motion_at(s, dmb_station(id, 0, 0.0), DMB_FRAME_BODY);
    double R[9], got[3], want[3], reaction[6], force[3];
    top_error e;
    matrix_of(y, R);
    for (int i = 0; i < 3; i++) {
        got[i] = pose.rotation[3 * i + 1];
        want[i] = R[3 * i + 1];
    }
    must(s, dmb_query_reaction(s->sim, id, reaction));
    fixed_point_force(&top, y, force);
    double place = 0.0, speed = 0.0, sum = 0.0;
    for (int i = 0; i < 3; i++) {
        place += (got[i] - want[i]) * (got[i] - want[i]);
        speed += (motion.velocity[3 + i] - y[4 + i]) * (motion.velocity[3 + i] - y[4 + i]);
        sum += (reaction[i] - force[i]) * (reaction[i] - force[i]);
        assert_true(reaction[3 + i] == 0.0);
    }
    e.component = largest_difference(3, got, want);
    e.place = sqrt(place), e.speed = sqrt(speed), e.reaction = sqrt(sum);
    return e;
}

static top_error top_at(double t, double h, double r)
{
    rig s;
    double y[7];
    dmb_sim_options options = dmb_sim_options_default();
    options.spectral_radius = r;
    options.newton_tolerance = 1e-13;
    const dmb_id id = open_top(&s, &options);
    memcpy(y, top_start, sizeof y);
    ode_solve(body_rate, (void *)&top, 0.0, t, 4000, 7, y);
    take_steps(&s, h, (uint32_t)lround(t / h));
    const top_error e = error_of_top(&s, id, y);
    rig_close(&s);
    return e;
}

/* The reference solution of this file against CASES.md at 0.5 s. */
static void reference_of_the_top(void **state)
{
    (void)state;
    const double place[3] = {-0.7024683, -0.02116518, -0.71140026}, speed[3] = {-0.4710531, 150.0, 5.90108305};
    double y[7], R[9], x[3];
    memcpy(y, top_start, sizeof y);
    ode_solve(body_rate, (void *)&top, 0.0, 0.5, 2000, 7, y);
    matrix_of(y, R);
    for (int i = 0; i < 3; i++) x[i] = R[3 * i + 1];
    check_below("reference: centre at 0.5 s", largest_difference(3, x, place), 1e-7);
    check_below("reference: angular velocity", largest_difference(3, y + 4, speed), 1e-7);
}

/* Errors at 1 s with r 0.9: 1.989e-5, 4.972e-6, 1.243e-6 m in the norm, by the scheme on SO(3) in axes that do not spin
 * with the top (eq:motion.rotor); a separate recurrence in the rotation alone agrees to four digits. In axes that spin
 * with it they are 8.28e-2, 2.06e-2, 5.15e-3; CASES.md tells 6.61e-2, 1.66e-2, 4.15e-3 of those. */
static void heavy_top_is_of_second_order(void **state)
{
    (void)state;
    const double table[3] = {6.61e-2, 1.66e-2, 4.15e-3}, norm[3] = {1.98892e-5, 4.97237e-6, 1.24316e-6};
    top_error e[4];
    for (int k = 0; k < 4; k++) {
        e[k] = top_at(1.0, 1e-3 / (1 << k), 0.9);
        print_message("    h %.3g: centre off by %.4g m, velocity %.4g rad/s, reaction %.4g N\n", 1e-3 / (1 << k),
                      e[k].place, e[k].speed, e[k].reaction);
        if (k < 3) check_below("    largest component over CASES.md", e[k].component / table[k], 1.0);
        if (k < 3) check_relative("    norm against the recurrence in the rotation", e[k].place, norm[k], 1e-4);
        if (k == 0) continue;
        check_order("    centre", e[k - 1].place, e[k].place, 2.0, 0.01);
        check_order("    angular velocity", e[k - 1].speed, e[k].speed, 2.0, 0.01);
        check_order("    reaction", e[k - 1].reaction, e[k].reaction, 2.0, 0.01);
    }
}

/* ---- Free tumbling ----------------------------------------------------------------------------------------------- */

/* A T-handle in free flight, spun about its middle axis, flips over and back (Dzhanibekov). */
static const body_data handle = {{1.0, 2.0, 3.0}, 1.0, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
static const double handle_start[7] = {1.0, 0.0, 0.0, 0.0, 0.01, 6.0, 0.02};

typedef struct tumble {
    double momentum, energy, attitude, path;
} tumble;

static tumble tumble_at(double t, double h, double r)
{
    rig s;
    tumble out;
    double y[7], R[9];
    dmb_body_def body = dmb_body_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    for (int i = 0; i < 3; i++) body.inertia[i] = handle.J[i];
    body.velocity[0] = 0.5;
    memcpy(body.velocity + 3, handle_start + 4, 3 * sizeof(double));
    const dmb_id id = add_body(&s, &body);
    options.spectral_radius = r;
    options.newton_tolerance = 1e-13;
    (void)rig_start(&s, &options);
    const dmb_momentum before = momentum_of(&s);
    const double kinetic = energy_of(&s).kinetic;
    take_steps(&s, h, (uint32_t)lround(t / h));
    const dmb_momentum after = momentum_of(&s);
    const dmb_pose pose = pose_at(&s, dmb_station(id, 0, 0.0));
    memcpy(y, handle_start, sizeof y);
    ode_solve(body_rate, (void *)&handle, 0.0, t, 2000, 7, y);
    matrix_of(y, R);
    const double straight[3] = {0.5 * t, 0.0, 0.0};
    out.momentum = largest_difference(3, after.angular, before.angular) / 12.0;
    out.energy = fabs(energy_of(&s).kinetic / kinetic - 1.0);
    out.attitude = largest_difference(9, pose.rotation, R);
    out.path = largest_difference(3, pose.position, straight);
    assert_true(after.mass == 1.0);
    rig_close(&s);
    return out;
}

static void tumbling_keeps_momentum_and_energy(void **state)
{
    (void)state;
    tumble e[3];
    for (int k = 0; k < 3; k++) {
        e[k] = tumble_at(10.0, 2e-3 / (1 << k), 0.9);
        print_message("    h %.3g: momentum off by %.3g, energy %.3g (relative), attitude %.3g, path %.3g m\n",
                      2e-3 / (1 << k), e[k].momentum, e[k].energy, e[k].attitude, e[k].path);
    }
    check_below("momentum at h 1e-3", e[1].momentum, 2e-5);
    check_below("energy at h 1e-3", e[1].energy, 1e-6);
    check_order("momentum", e[1].momentum, e[2].momentum, 2.0, 0.02);
    check_order("energy", e[1].energy, e[2].energy, 2.0, 0.02);
    check_order("attitude", e[1].attitude, e[2].attitude, 2.0, 0.05);
    for (int k = 0; k < 3; k++) check_below("path: straight to rounding", e[k].path, 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reference_of_the_top),
        cmocka_unit_test(heavy_top_is_of_second_order),
        cmocka_unit_test(tumbling_keeps_momentum_and_energy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
