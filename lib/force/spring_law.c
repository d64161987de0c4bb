/* Laws of springs between points (table, one-sided) and of joint coordinates (spring, damper, friction, stop), with
 * exact derivatives and potentials (forms: spring_law.h). A damper never makes a one-sided force change its sign: where
 * it would, the whole force is 0, and with it the derivatives. */
#include "force/spring_law.h"

#include <math.h>

#include "drillmbd/scene.h"

/* ---- Springs between points -------------------------------------------------------------------------------------- */

#define DMB_SLACK_FAR 1e9 /* [m] bound of all elongations */

/* ---- Table ------------------------------------------------------------------------------------------------------- */

static double slope_between(const dmb_spring_point *p)
{
    return (p[1].force - p[0].force) / (p[1].elongation - p[0].elongation);
}

/* Fritsch and Butland 1984: weighted harmonic mean of the slopes on both sides, 0 where they differ in sign. */
static double inner_slope(const dmb_spring_point *p)
{
    const double h0 = p[0].elongation - p[-1].elongation, h1 = p[1].elongation - p[0].elongation;
    const double d0 = slope_between(p - 1), d1 = slope_between(p);
    if (!(d0 * d1 > 0.0)) return 0.0;
    const double w0 = 2.0 * h1 + h0, w1 = h1 + 2.0 * h0;
    return (w0 + w1) / (w0 / d0 + w1 / d1);
}

static void set_slopes(dmb_spring_point *points, uint32_t count, int cubic)
{
    for (uint32_t i = 0; i + 1 < count; i++) points[i].slope[0] = points[i].slope[1] = slope_between(points + i);
    points[count - 1].slope[0] = points[count - 1].slope[1] = points[count - 2].slope[1];
    if (!cubic) return;
    for (uint32_t i = 1; i + 1 < count; i++) points[i - 1].slope[1] = points[i].slope[0] = inner_slope(points + i);
}

/* On a segment of length h the Hermite cubic integrates to h (f0 + f1)/2 + h^2 (s0 - s1)/12. */
void dmb_spring_table_prepare(dmb_spring_point *points, uint32_t count, int cubic)
{
    set_slopes(points, count, cubic);
    points[0].energy = 0.0;
    for (uint32_t i = 0; i + 1 < count; i++) {
        const dmb_spring_point *p = points + i;
        const double h = p[1].elongation - p[0].elongation;
        points[i + 1].energy =
            p->energy + h * (0.5 * (p[0].force + p[1].force) + h * (p->slope[0] - p->slope[1]) / 12.0);
    }
}

typedef struct table_value {
    double force, slope, energy;
} table_value;

/* Extrapolation by a straight line from a point. */
static table_value beyond(const dmb_spring_point *p, double x, double slope)
{
    const double h = x - p->elongation;
    const table_value value = {p->force + slope * h, slope, p->energy + h * (p->force + 0.5 * slope * h)};
    return value;
}

/* f0 + h (s0 u + a u^2 + b u^3), a = 3 d - 2 s0 - s1, b = s0 + s1 - 2 d, u = 0 .. 1, d the slope between. E and slope
 * are the integral and the derivative of the same polynomial, so that the force is the gradient of E. */
static table_value inside(const dmb_spring_point *p, double x)
{
    const double h = p[1].elongation - p[0].elongation, u = (x - p->elongation) / h, d = slope_between(p);
    const double s0 = p->slope[0], a = 3.0 * d - 2.0 * s0 - p->slope[1], b = s0 + p->slope[1] - 2.0 * d;
    const table_value value = {p->force + h * u * (s0 + u * (a + u * b)), s0 + u * (2.0 * a + 3.0 * u * b),
                               p->energy + h * u * (p->force + h * u * (s0 / 2.0 + u * (a / 3.0 + u * b / 4.0)))};
    return value;
}

static table_value table_at(const dmb_spring_law *law, const dmb_spring_point *points, double x)
{
    const table_value none = {0.0, 0.0, 0.0};
    uint32_t low = 0, high = law->count;
    if (law->count == 0) return none;
    if (x <= points[0].elongation) return beyond(points, x, points[0].slope[0]);
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (points[middle].elongation <= x)
            low = middle;
        else
            high = middle;
    }
    return low + 1 == law->count ? beyond(points + low, x, points[low].slope[0]) : inside(points + low, x);
}

/* ---- Law --------------------------------------------------------------------------------------------------------- */

static double elastic_at(const dmb_spring_law *law, const dmb_spring_point *points, double x)
{
    return law->preload + law->stiffness * x + table_at(law, points, x).force;
}

/* Integral of the two-sided elastic force, up to a constant. */
static double integral_at(const dmb_spring_law *law, const dmb_spring_point *points, double x)
{
    return x * (law->preload + 0.5 * law->stiffness * x) + table_at(law, points, x).energy;
}

/* Zero of a nondecreasing force, by bisection to the last bit. Where the force is 0 over an interval, slack is the end
 * at which the force begins. */
static int find_slack(dmb_spring_law *law, const dmb_spring_point *points)
{
    double low = -DMB_SLACK_FAR, high = DMB_SLACK_FAR;
    if (!(elastic_at(law, points, low) < 0.0) || !(elastic_at(law, points, high) > 0.0)) return 0;
    for (int i = 0; i < 1200; i++) {
        const double middle = 0.5 * (low + high), force = elastic_at(law, points, middle);
        if (middle <= low || middle >= high) break;
        if (force < 0.0 || (law->acts == DMB_SPRING_TENSION && force == 0.0))
            low = middle;
        else
            high = middle;
    }
    law->slack = law->acts == DMB_SPRING_TENSION ? low : high;
    return 1;
}

int dmb_spring_law_prepare(dmb_spring_law *law, const dmb_spring_point *points)
{
    law->slack = 0.0;
    if (law->acts != DMB_SPRING_BOTH && !find_slack(law, points)) return 0;
    law->zero = integral_at(law, points, law->slack);
    return 1;
}

static int is_slack(const dmb_spring_law *law, double elongation)
{
    if (law->acts == DMB_SPRING_TENSION) return elongation <= law->slack;
    return law->acts == DMB_SPRING_COMPRESSION && elongation >= law->slack;
}

/* 1 if the damper would reverse the sign of the total force of a one-sided spring; the total force is then 0. */
static int turns_round(const dmb_spring_law *law, const dmb_spring_force *force)
{
    const double sum = force->elastic + force->damper;
    return law->acts == DMB_SPRING_TENSION ? sum < 0.0 : law->acts == DMB_SPRING_COMPRESSION && sum > 0.0;
}

void dmb_spring_force_at(const dmb_spring_law *law, const dmb_spring_point *points, double elongation, double speed,
                         dmb_spring_force *force)
{
    const dmb_spring_force none = {0.0, 0.0, 0.0, 0.0};
    *force = none;
    if (is_slack(law, elongation)) return;
    const table_value table = table_at(law, points, elongation);
    force->elastic = law->preload + law->stiffness * elongation + table.force;
    force->damper = law->damping * speed;
    if (turns_round(law, force)) {
        force->damper = -force->elastic;
        return;
    }
    force->by_elongation = law->stiffness + table.slope;
    force->by_speed = law->damping;
}

double dmb_spring_energy_at(const dmb_spring_law *law, const dmb_spring_point *points, double elongation)
{
    return is_slack(law, elongation) ? 0.0 : integral_at(law, points, elongation) - law->zero;
}

/* ---- Springs, stops and friction of joints ----------------------------------------------------------------------- */

#define DMB_NO_STOP 1e29 /* a bound this far away counts as none */

static int stop_acts(const dmb_joint_law *law)
{
    return law->stop_stiffness > 0.0 && (fabs(law->stop_low) < DMB_NO_STOP || fabs(law->stop_high) < DMB_NO_STOP);
}

int dmb_joint_law_acts(const dmb_joint_law *law)
{
    return law->stiffness > 0.0 || law->damping > 0.0 || law->friction > 0.0 || stop_acts(law);
}

double dmb_joint_stop_depth(const dmb_joint_law *law, double position)
{
    if (!stop_acts(law)) return 0.0;
    if (position > law->stop_high) return position - law->stop_high;
    return position < law->stop_low ? position - law->stop_low : 0.0;
}

/* -f s/n, n = sqrt(s^2 + s0^2), and its derivative -f s0^2/n^3 */
static void add_friction(const dmb_joint_law *law, double speed, dmb_joint_force *force)
{
    const double s0 = law->friction_speed;
    const double n = sqrt(speed * speed + s0 * s0);

    if (!(law->friction > 0.0) || n == 0.0) return;
    force->friction = -law->friction * (speed / n);
    force->by_speed -= law->friction / n * (s0 / n) * (s0 / n);
}

/* On either side the force is -(K d + c s) with the signed d. If that would pull, the damper cancels the spring's
 * force. */
static void add_stop(const dmb_joint_law *law, double position, double speed, dmb_joint_force *force)
{
    const double d = dmb_joint_stop_depth(law, position);
    const double spring = -law->stop_stiffness * d;
    const double damper = -law->stop_damping * speed;

    if (d == 0.0) return;
    const int pushes = d > 0.0 ? spring + damper < 0.0 : spring + damper > 0.0;
    force->stop = spring;
    force->stop_damper = pushes ? damper : -spring;
    if (!pushes) return;
    force->by_position -= law->stop_stiffness;
    force->by_speed -= law->stop_damping;
}

void dmb_joint_force_at(const dmb_joint_law *law, double position, double speed, dmb_joint_force *force)
{
    force->spring = -law->stiffness * (position - law->rest);
    force->damper = -law->damping * speed;
    force->friction = force->stop = force->stop_damper = 0.0;
    force->by_position = -law->stiffness;
    force->by_speed = -law->damping;
    add_friction(law, speed, force);
    add_stop(law, position, speed, force);
    force->force = force->spring + force->damper + force->friction + (force->stop + force->stop_damper);
}

double dmb_joint_law_energy(const dmb_joint_law *law, double position)
{
    const double stretch = position - law->rest;
    const double d = dmb_joint_stop_depth(law, position);
    return 0.5 * law->stiffness * stretch * stretch + 0.5 * law->stop_stiffness * d * d;
}
