/* Error-controlled steps against as many equal ones: a double pendulum of bars, errors of both against an
 * independent integration, as root mean squares over several ends. Steps that change without need lose what equal steps
 * take back within a swing (eq:integration.energy-left); the bounds hold what is reached, steps and rejections are
 * counts. Checks eq:integration.error-ahead. */
#include <string.h>

#include "mechanism.h"
#include "ode.h"

enum { ENDS = 5, BODIES = 2 };
static const double end_part[ENDS] = {0.43, 0.58, 0.71, 0.87, 1.0};

typedef struct swing {
    double angle, time; /* [rad] of the upper bar at rest, the lower one 1.3 times that; [s] of the longest run */
    double ratio;       /* [-] most that the error may be over that of equal steps */
    double rejected;    /* [-] most rejected steps over steps */
} swing;

typedef struct pendulum {
    rig s;
    dmb_id bars[BODIES];
} pendulum;

static pendulum open_pendulum(const swing *w, double tolerance)
{
    const double a = w->angle, b = 1.3 * w->angle;
    const bar upper = {{0.0, 0.0}, {sin(a), -cos(a)}, 1.0};
    const bar lower = {{sin(a), -cos(a)}, {sin(a) + sin(b), -cos(a) - cos(b)}, 1.0};
    dmb_sim_options options = sharp_options(0.8, 1e-11);
    pendulum p;
    options.tolerance_translation = options.tolerance_rotation = tolerance;
    rig_open(&p.s, 0.0, 0.0, -9.81);
    p.bars[0] = add_bar(&p.s, &upper);
    p.bars[1] = add_bar(&p.s, &lower);
    (void)add_hinge(&p.s, "upper", DMB_JOINT_REVOLUTE, pin_ground(0.0, 0.0), pin_on(p.bars[0], -0.5));
    (void)add_hinge(&p.s, "lower", DMB_JOINT_REVOLUTE, pin_on(p.bars[0], 0.5), pin_on(p.bars[1], -0.5));
    assert_int_equal(mechanism_start(&p.s, &options), DMB_OK);
    return p;
}

/* Two uniform bars of 1 m and 1 kg, angles from the direction of gravity: (angle, angle, speed, speed). */
static void rate_of(void *context, double t, const double *y, double *rate)
{
    (void)context, (void)t;
    const double c = 0.5 * cos(y[0] - y[1]), s = 0.5 * sin(y[0] - y[1]), m = 4.0 / 3.0, n = 1.0 / 3.0;
    const double f = -s * y[3] * y[3] - 1.5 * 9.81 * sin(y[0]), g = s * y[2] * y[2] - 0.5 * 9.81 * sin(y[1]);
    const double det = m * n - c * c;
    rate[0] = y[2];
    rate[1] = y[3];
    rate[2] = (n * f - c * g) / det;
    rate[3] = (m * g - c * f) / det;
}

/* Square of the distance of both middles from where they ought to be. */
static double off_squared(const pendulum *p, const swing *w, double time)
{
    double y[4] = {w->angle, 1.3 * w->angle, 0.0, 0.0}, sum = 0.0;
    ode_solve(rate_of, NULL, 0.0, time, 1000, 4, y);
    const double want[BODIES][2] = {{0.5 * sin(y[0]), -0.5 * cos(y[0])},
                                    {sin(y[0]) + 0.5 * sin(y[1]), -cos(y[0]) - 0.5 * cos(y[1])}};
    for (int i = 0; i < BODIES; i++) {
        const dmb_pose pose = pose_at(&p->s, dmb_station(p->bars[i], 0, 0.0));
        sum += pow(pose.position[0] - want[i][0], 2.0) + pow(pose.position[2] - want[i][1], 2.0);
    }
    return sum;
}

static void compare(const swing *w, double tolerance)
{
    double controlled = 0.0, equal = 0.0, steps = 0.0, rejected = 0.0;
    for (int k = 0; k < ENDS; k++) {
        const double time = w->time * end_part[k];
        dmb_step_report report = dmb_step_report_default();
        pendulum p = open_pendulum(w, tolerance), q = open_pendulum(w, tolerance);
        must(&p.s, dmb_sim_advance(p.s.sim, time, &report));
        take_steps(&q.s, time / report.steps, report.steps);
        controlled += off_squared(&p, w, time);
        equal += off_squared(&q, w, time);
        steps += report.steps;
        rejected += report.rejected;
        rig_close(&p.s);
        rig_close(&q.s);
    }
    print_message("    %.1f rad, tolerance %.0e: %.0f steps, %.0f rejected, error %.3g m, of equal steps %.3g m\n",
                  w->angle, tolerance, steps / ENDS, rejected / ENDS, sqrt(controlled / ENDS), sqrt(equal / ENDS));
    check_below("error over that of as many equal steps", sqrt(controlled / equal), w->ratio);
    check_below("rejected steps over steps", rejected / steps, w->rejected);
}

/* 1.2, 1.4, 2.7 and 4.5 with the error of each step by itself, 1 to 3 % rejected. */
static void double_pendulum(void **state)
{
    static const swing swings[] = {
        {0.3, 5.0, 1.15, 0.01}, {1.0, 5.0, 1.25, 0.01}, {1.6, 3.0, 1.75, 0.01}, {2.2, 2.0, 3.7, 0.01}};
    (void)state;
    for (int k = 0; k < 4; k++)
        for (double tolerance = 1e-5; tolerance > 5e-8; tolerance *= 0.1) compare(swings + k, tolerance);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(double_pendulum)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
