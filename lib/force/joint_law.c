#include "force/joint_law.h"

#include <math.h>

#define DMB_NO_STOP 1e29 /* a bound this far away is none */

static int stop_acts(const dmb_joint_law *law)
{
    return law->stop_stiffness > 0.0 && (fabs(law->stop_low) < DMB_NO_STOP || fabs(law->stop_high) < DMB_NO_STOP);
}

int dmb_joint_law_acts(const dmb_joint_law *law)
{
    return law->stiffness > 0.0 || law->damping > 0.0 || law->friction > 0.0 || stop_acts(law);
}

/* d with the sign of the side: > 0 above stop_high, < 0 below stop_low, 0 between. */
static double beyond(const dmb_joint_law *law, double position)
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

/* On either side -(K d + c s) with the signed d, unless that would pull: then the damper takes the spring's share back.
 */
static void add_stop(const dmb_joint_law *law, double position, double speed, dmb_joint_force *force)
{
    const double d = beyond(law, position);
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
    const double d = beyond(law, position);
    return 0.5 * law->stiffness * stretch * stretch + 0.5 * law->stop_stiffness * d * d;
}
