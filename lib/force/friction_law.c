#include "force/friction_law.h"

#include <math.h>

#define STRIBECK_END 100.0 /* [-] from this many v_s on, exp(-s/v_s) (1e-44, later denormal) counts as 0 */

static double norm(double a, double b)
{
    return sqrt(a * a + b * b);
}

/* mu(s) and mu'(s) of the Stribeck curve mu_d + (mu_s - mu_d) exp(-s/v_s) */
static double stribeck(const dmb_friction_law *law, double s, double *slope)
{
    *slope = 0.0;
    if (law->mu_static == law->mu_dynamic || s >= STRIBECK_END * law->stribeck_speed) return law->mu_dynamic;
    const double bump = (law->mu_static - law->mu_dynamic) * exp(-s / law->stribeck_speed);
    *slope = -bump / law->stribeck_speed;
    return law->mu_dynamic + bump;
}

/* F = -N f v, dF/dv = -N [f I + g v v^T] with g = (df/d|v|)/|v|, dF/dN = -f v */
static void radial_law(double N, const double v[2], double f, double g, double F[2], double dF_dv[4], double dF_dN[2])
{
    dF_dN[0] = -f * v[0];
    dF_dN[1] = -f * v[1];
    F[0] = N * dF_dN[0];
    F[1] = N * dF_dN[1];
    dF_dv[0] = -N * (f + g * v[0] * v[0]);
    dF_dv[1] = dF_dv[2] = -N * g * v[0] * v[1];
    dF_dv[3] = -N * (f + g * v[1] * v[1]);
}

/* Ambrosio 2003: friction fades in between v0 and v1. f = mu_d c/|v|. */
static void ambrosio(const dmb_friction_law *law, double speed, double *f, double *g)
{
    const double width = law->full_speed - law->smoothing_speed;

    *f = *g = 0.0;
    if (speed <= law->smoothing_speed) return;
    if (speed >= law->full_speed) {
        *f = law->mu_dynamic / speed;
        *g = -*f / (speed * speed);
        return;
    }
    *f = law->mu_dynamic * (speed - law->smoothing_speed) / (width * speed);
    *g = law->mu_dynamic * law->smoothing_speed / (width * speed * speed * speed);
}

/* f = mu(s)/s, g = (mu'/s - mu/s^2)/s with ds/d|v| = |v|/s */
static void smoothed(const dmb_friction_law *law, double speed, double *f, double *g)
{
    const double s = norm(speed, law->smoothing_speed);
    double slope = 0.0;
    double mu = law->mu_dynamic;

    *f = *g = 0.0;
    if (s == 0.0) return;
    if (law->kind != DMB_FRICTION_COULOMB) mu = stribeck(law, s, &slope);
    *f = mu / s;
    *g = (slope - *f) / (s * s);
}

void dmb_friction_smooth(const dmb_friction_law *law, double N, const double v[2], double F[2], double dF_dv[4],
                         double dF_dN[2])
{
    const double speed = norm(v[0], v[1]);
    double f = 0.0;
    double g = 0.0;

    if (law->kind == DMB_FRICTION_AMBROSIO)
        ambrosio(law, speed, &f, &g);
    else if (law->kind != DMB_FRICTION_NONE)
        smoothed(law, speed, &f, &g);
    radial_law(N, v, f, g, F, dF_dv, dF_dN);
}

/* Brings a vector back onto the circle |x| <= limit, radially, and its derivative dx (2,2) with it:
 * d(limit x/|x|) = limit/|x| (I - e e^T) dx + e d_limit^T, e = x/|x|. Returns 1 where it had to. */
static int32_t onto_circle(double x[2], double dx[4], double limit, const double d_limit[2])
{
    const double length = norm(x[0], x[1]);

    if (!(length > limit)) return 0;
    const double e[2] = {x[0] / length, x[1] / length};
    const double ratio = limit / length;
    for (int j = 0; j < 2; ++j) {
        const double along = e[0] * dx[j] + e[1] * dx[2 + j];
        dx[j] = ratio * (dx[j] - e[0] * along) + e[0] * d_limit[j];
        dx[2 + j] = ratio * (dx[2 + j] - e[1] * along) + e[1] * d_limit[j];
    }
    x[0] = limit * e[0];
    x[1] = limit * e[1];
    return 1;
}

/* Limit of friction over normal force and its gradient: mu_static from sticking, else the Stribeck curve at |v|. */
static double bristle_limit(const dmb_friction_law *law, const double v[2], int32_t stuck, double d_mu[2])
{
    const double speed = norm(v[0], v[1]);
    double slope;
    const double mu = stribeck(law, speed, &slope);
    const double factor = speed > 0.0 && stuck == 0 ? slope / speed : 0.0;

    d_mu[0] = factor * v[0];
    d_mu[1] = factor * v[1];
    return stuck == 0 ? mu : law->mu_static;
}

void dmb_friction_bristle(const dmb_friction_law *law, double N, const double v[2], const double z_old[2],
                          const double v_old[2], int32_t stuck, double h, double z[2], double F[2], double dF_dv[4],
                          double dF_dN[2], int32_t *sticks)
{
    const double sigma0 = law->bristle_stiffness;
    const double sigma1 = law->bristle_damping;
    double d_mu[2];
    const double mu = bristle_limit(law, v, stuck, d_mu);
    const double d_limit[2] = {d_mu[0] / sigma0, d_mu[1] / sigma0};
    double dq[4] = {0.5 * h, 0.0, 0.0, 0.5 * h};

    z[0] = z_old[0] + 0.5 * h * (v_old[0] + v[0]);
    z[1] = z_old[1] + 0.5 * h * (v_old[1] + v[1]);
    *sticks = onto_circle(z, dq, mu / sigma0, d_limit) == 0;

    double q[2] = {sigma0 * z[0], sigma0 * z[1]};
    for (int i = 0; i < 4; ++i) dq[i] *= sigma0;
    if (sigma1 != 0.0) { /* without damping q is inside already */
        q[0] += sigma1 * v[0];
        q[1] += sigma1 * v[1];
        dq[0] += sigma1;
        dq[3] += sigma1;
        if (onto_circle(q, dq, mu, d_mu) != 0) *sticks = 0;
    }
    for (int i = 0; i < 2; ++i) {
        dF_dN[i] = -q[i];
        F[i] = -N * q[i];
    }
    for (int i = 0; i < 4; ++i) dF_dv[i] = -N * dq[i];
}

double dmb_friction_power(const double F[2], const double v[2])
{
    return -(F[0] * v[0] + F[1] * v[1]);
}

double dmb_friction_bristle_energy(const dmb_friction_law *law, double N, const double z[2])
{
    return 0.5 * N * law->bristle_stiffness * (z[0] * z[0] + z[1] * z[1]);
}
