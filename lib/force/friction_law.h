/* Friction laws: two components of tangential force at the contact point (axial, circumferential).
 * N is the normal force [N >= 0, or N/m; the result has its unit], v the sliding velocity of the pipe's contact point
 * over the wall [m/s]. All derivatives are exact and include the falling Stribeck branch. Pure functions for numbers
 * that are doubles or lanes of doubles (math/real.h). If dF_dv is NULL, the tangent is not computed. */
#ifndef DMB_FORCE_FRICTION_LAW_H
#define DMB_FORCE_FRICTION_LAW_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "drillmbd/scene.h"
#include "math/real.h"

enum { DMB_FRICTION_POINTS = 8, DMB_FRICTION_STATES = 16 }; /* [-] of a table, of a state, as of dmb_wall_def */
/* Kind of the caller's law in sliding on and on, which has no memory (dmb_sliding_law). */
enum { DMB_FRICTION_CALLBACK_SLIDING = 1000 };

typedef struct dmb_friction_law {
    int32_t kind;              /* DMB_FRICTION_... */
    int32_t points;            /* [-] of a table that replaces the Stribeck curve; 0: none */
    double mu_static;          /* [-]; numbers from here to the table belong to the fingerprint of a model */
    double mu_dynamic;         /* [-] */
    double stribeck_speed;     /* [m/s] v_s > 0 */
    double smoothing_speed;    /* [m/s] v_eps of COULOMB and STRIBECK, v0 of AMBROSIO; > 0 */
    double full_speed;         /* [m/s] v1 of AMBROSIO, > v0 */
    double bristle_stiffness;  /* [1/m] sigma0 > 0, tangential stiffness over normal force */
    double bristle_damping;    /* [s/m] sigma1 >= 0, tangential damping over normal force */
    const double *table_speed; /* [m/s] 0 and then strictly increasing, shape (points) */
    const double
        *table_mu; /* [-] coefficients there, shape (points); scaled by mu_dynamic over the last one, which is > 0 */
    double peak_bump, peak_level; /* [-] A and B of eq:friction.peak, set by dmb_friction_law_of; 0: no correction */
    dmb_friction_fn callback;     /* of CALLBACK */
    dmb_accept_fn accept;         /* NULL: none */
    void *context;
    uint32_t states; /* [-] numbers of the state of a contact point: 2 of BRISTLE; 0: no memory */
    uint32_t reserved;
} dmb_friction_law;

/* A law with coefficients of the place, which differ from lane to lane in a hole of sections. */
typedef struct dmb_local_friction {
    dmb_real mu_static, mu_dynamic; /* [-] */
    const dmb_friction_law *law;    /* all other constants */
    int32_t *failed;                /* raised to 1 where the caller's function fails; NULL: nobody asks */
} dmb_local_friction;

static inline dmb_local_friction dmb_local_friction_of(const dmb_friction_law *law)
{
    const dmb_local_friction local = {dmb_real_of(law->mu_static), dmb_real_of(law->mu_dynamic), law, NULL};
    return local;
}

/* Returns the law with the constants for which STRIBECK has the maximum mu_static N (eq:friction.peak). Its decay is no
 * steeper than smoothing resolves: stribeck_speed is at least 0.3 smoothing_speed. The maximum of a table is its first
 * coefficient; its static part must extend beyond smoothing_speed. Other laws are returned unchanged. */
dmb_friction_law dmb_friction_law_of(dmb_friction_law law);

/* 1: the law has a memory (bristles), i.e. a state beside position and velocity. The only place that decides this; a
 * new law with memory also needs its state in lib/sim/sim.h and its force beside dmb_friction_bristle. */
static inline int dmb_friction_has_memory(const dmb_friction_law *law)
{
    return law->kind == DMB_FRICTION_BRISTLE || law->kind == DMB_FRICTION_CALLBACK;
}

/* 1: the law is the caller's. */
static inline int dmb_friction_is_called(const dmb_friction_law *law)
{
    return law->kind == DMB_FRICTION_CALLBACK || law->kind == DMB_FRICTION_CALLBACK_SLIDING;
}

/* Results of the caller's law [N, N s/m, -]. */
typedef struct dmb_friction_result {
    double force[2], by_slip[4], by_normal[2];
} dmb_friction_result;

/* One call of the caller's law. If it fails, DMB_ERR_CALLBACK and NaN. */
int32_t dmb_friction_call(const dmb_friction_law *law, const dmb_friction_at *at, const dmb_law_memory *memory,
                          dmb_friction_result *to);

/* 1: the kind has a static coefficient, or a table of the coefficient over the speed. */
static inline int dmb_friction_has_static(int32_t kind)
{
    return kind == DMB_FRICTION_STRIBECK || kind == DMB_FRICTION_BRISTLE;
}

/* [-] Largest friction over normal force. */
static inline dmb_real dmb_friction_most(const dmb_local_friction *local)
{
    if (!dmb_friction_has_static(local->law->kind)) return local->mu_dynamic;
    return dmb_real_max(local->mu_static, local->mu_dynamic);
}

/* Friction as a function of velocity alone. F [unit of N] is the force on the pipe, dF_dv its tangent (2,2) row by row,
 * dF_dN its derivative with respect to N (2).
 *   COULOMB, STRIBECK: F = -mu(s) N v/s, s = sqrt(|v|^2 + v_eps^2), mu constant (mu_dynamic) or the Stribeck curve
 *   mu_d + (mu_s - mu_d) exp(-s/v_s) (eq:friction.smooth, eq:friction.stribeck), raised to the maximum mu_s
 *   (eq:friction.peak). BRISTLE returns the STRIBECK result without that correction, which is the limit of the law in
 * sliding. AMBROSIO: mu_d N opposite to v times 0 up to v0, (|v| - v0)/(v1 - v0) up to v1, 1 beyond
 * (eq:friction.ambrosio). F = 0 at v = 0. A law smoothed in this way creeps under load, BRISTLE does not. */
static inline void dmb_friction_smooth_at(const dmb_local_friction *local, dmb_real N, const dmb_real v[2],
                                          dmb_real F[2], dmb_real *dF_dv, dmb_real dF_dN[2]);
static inline void dmb_friction_smooth(const dmb_friction_law *law, dmb_real N, const dmb_real v[2], dmb_real F[2],
                                       dmb_real *dF_dv, dmb_real dF_dN[2])
{
    const dmb_local_friction local = dmb_local_friction_of(law);
    dmb_friction_smooth_at(&local, N, v, F, dF_dv, dF_dN);
}

/* Friction with memory: elastic bristles of deflection z [m] that truly stick. One step of length h [s] (>= 0) from
 * deflection z_old and sliding velocity v_old, ends at v (eq:friction.bristle):
 *   z* = z_old + h (v_old + v)/2
 *   z  = z* brought back onto the circle |z| <= mu/sigma0
 *   q  = sigma0 z + sigma1 v brought back onto the circle |q| <= mu,   F = -N q
 * with mu = mu_static where the accepted step before stuck (stuck != 0), else mu_d + (mu_s - mu_d) exp(-|v|/v_s).
 * So it breaks away at mu_static however fast it is loaded or vibrates in sticking, and slides on the Stribeck curve
 * from the step after. (With the curve in sticking too, as in LuGre, the bristles' own speed lowers the limit.)
 * The damping counts in sticking and fades out at the limit: |F| <= mu N always, F = -mu N v/|v| in steady sliding.
 * Both projections are continuous in v. Returns 1 if neither acts. The caller passes this as `stuck` of the
 * next step, never between iterations of one step. The tangent has kinks at the circles and, with mu_s > mu_d, at v = 0
 * while sliding (the derivative of |v| there counts as 0). h = 0 keeps z_old, cut back to the limit.
 * The caller keeps z, v and sticks of accepted steps, and starts a contact, or one regained, at z = 0 and stuck = 0. F,
 * dF_dv, dF_dN as above. z_old and v_old may be z and v. */
static inline dmb_mask dmb_friction_bristle(const dmb_local_friction *local, dmb_real N, const dmb_real v[2],
                                            const dmb_real z_old[2], const dmb_real v_old[2], dmb_mask stuck, double h,
                                            dmb_real z[2], dmb_real F[2], dmb_real *dF_dv, dmb_real dF_dN[2]);

#define DMB_STRIBECK_END 100.0 /* [-] from this many v_s on, exp(-s/v_s) (1e-44) counts as 0 */

static inline dmb_real dmb_friction_norm(dmb_real a, dmb_real b)
{
    return dmb_real_sqrt(a * a + b * b);
}

/* ---- Smooth laws ---------------------------------------------------------------------------------------------------
 */

/* y(s) and y'(s) of the table as given (eq:friction.table): linear between its points, constant beyond the last one. */
static inline dmb_real dmb_friction_table(const dmb_friction_law *law, dmb_real s, dmb_real *slope)
{
    const double *x = law->table_speed, *y = law->table_mu;
    dmb_real mu = dmb_real_of(y[0]);
    *slope = dmb_real_of(0.0);
    for (int k = 0; k + 1 < law->points; ++k) {
        const dmb_mask beyond = dmb_mask_less(dmb_real_of(x[k]), s);
        const double rise = (y[k + 1] - y[k]) / (x[k + 1] - x[k]);
        mu = dmb_real_select(beyond, y[k] + rise * (s - x[k]), mu);
        *slope = dmb_real_select(beyond, dmb_real_of(rise), *slope);
    }
    const dmb_mask end = dmb_mask_at_most(dmb_real_of(x[law->points - 1]), s);
    *slope = dmb_real_select(end, dmb_real_of(0.0), *slope);
    return dmb_real_select(end, dmb_real_of(y[law->points - 1]), mu);
}

/* Remaining fraction of static friction at s: E = exp(-s/v_s) and E'(s). */
static inline dmb_real dmb_stribeck_decay(const dmb_friction_law *law, dmb_real s, dmb_real *slope)
{
    const dmb_mask end = dmb_mask_at_most(dmb_real_of(DMB_STRIBECK_END * law->stribeck_speed), s);
    const dmb_real zero = dmb_real_of(0.0);
    *slope = zero;
    if (!dmb_mask_any(dmb_mask_not(end))) return zero;
    const dmb_real left = dmb_real_select(end, zero, dmb_real_exp(-s / law->stribeck_speed));
    *slope = -left / law->stribeck_speed;
    return left;
}

/* mu(s) and mu'(s) of the table, or of the Stribeck curve mu_d + (mu_s - mu_d) exp(-s/v_s). A table is scaled with
 * mu_d, so that factors and sections of the hole, which set mu_d, scale all of it. */
static inline dmb_real dmb_stribeck(const dmb_local_friction *local, dmb_real s, dmb_real *slope)
{
    const dmb_friction_law *law = local->law;
    if (law->points > 0) {
        const dmb_real scale = local->mu_dynamic / law->table_mu[law->points - 1];
        const dmb_real mu = dmb_friction_table(law, s, slope);
        *slope = scale * *slope;
        return scale * mu;
    }
    const dmb_real zero = dmb_real_of(0.0), bump = local->mu_static - local->mu_dynamic;
    const dmb_mask constant = dmb_mask_at_most(bump, zero) & dmb_mask_at_most(zero, bump);
    *slope = zero;
    if (!dmb_mask_any(dmb_mask_not(constant))) return local->mu_dynamic;
    const dmb_real left = dmb_stribeck_decay(law, s, slope);
    *slope = dmb_real_select(constant, zero, bump * *slope);
    return dmb_real_select(constant, local->mu_dynamic, local->mu_dynamic + bump * left);
}

/* F = -N f v, dF/dv = -N [f I + g v v^T] with g = (df/d|v|)/|v|, dF/dN = -f v */
static inline void dmb_friction_radial(dmb_real N, const dmb_real v[2], dmb_real f, dmb_real g, dmb_real F[2],
                                       dmb_real *dF_dv, dmb_real dF_dN[2])
{
    dF_dN[0] = -f * v[0];
    dF_dN[1] = -f * v[1];
    F[0] = N * dF_dN[0];
    F[1] = N * dF_dN[1];
    if (dF_dv == NULL) return;
    dF_dv[0] = -N * (f + g * v[0] * v[0]);
    dF_dv[1] = dF_dv[2] = -N * g * v[0] * v[1];
    dF_dv[3] = -N * (f + g * v[1] * v[1]);
}

/* Ambrosio 2003: friction increases from 0 at v0 to its full value at v1. f = mu_d c/|v|. */
static inline void dmb_friction_ambrosio(const dmb_local_friction *local, dmb_real speed, dmb_real *f, dmb_real *g)
{
    const dmb_friction_law *law = local->law;
    const double width = law->full_speed - law->smoothing_speed;
    const dmb_mask slow = dmb_mask_at_most(speed, dmb_real_of(law->smoothing_speed));
    const dmb_mask fast = dmb_mask_at_most(dmb_real_of(law->full_speed), speed);
    const dmb_real zero = dmb_real_of(0.0), v = dmb_real_select(slow, dmb_real_of(1.0), speed);
    const dmb_real full = local->mu_dynamic / v;
    *f = dmb_real_select(fast, full, local->mu_dynamic * (v - law->smoothing_speed) / (width * v));
    *g = dmb_real_select(fast, -full / (v * v), local->mu_dynamic * law->smoothing_speed / (width * v * v * v));
    *f = dmb_real_select(slow, zero, *f);
    *g = dmb_real_select(slow, zero, *g);
}

/* E(s) in 0 .. 1 and E'(s) of the table: (y - y_n)/(y_0 - y_n), with y_0 > y_n. */
static inline dmb_real dmb_friction_table_decay(const dmb_friction_law *law, dmb_real s, dmb_real *slope)
{
    const double last = law->table_mu[law->points - 1], height = law->table_mu[0] - last;
    const dmb_real zero = dmb_real_of(0.0), one = dmb_real_of(1.0);
    const dmb_real left = (dmb_friction_table(law, s, slope) - last) / height;
    const dmb_mask under = dmb_mask_at_most(left, zero), over = dmb_mask_at_most(one, left);
    *slope = dmb_real_select(under | over, zero, *slope / height);
    return dmb_real_select(under, zero, dmb_real_select(over, one, left));
}

/* Static friction (eq:friction.peak). The smoothed curve f0 = mu(s) r, r = |v|/s, stays below mu_s everywhere, because
 * it falls before smoothing ends. With y = r E, the largest value of which is 1/kappa,
 *     |v| f = f0 + y^4 [A (mu_s - mu_d) + B mu_d (1 - r)],   A = (kappa - 1) kappa^3,   B = kappa^4
 * has its maximum mu_s at the maximum of y: both parts, r + B y^4 (1 - r) of mu_d and y + A y^4 of mu_s - mu_d, are 1
 * there and less elsewhere. It is linear in both coefficients, and f0 in the limit v_eps = 0. f and g gain
 *     w c,   w = r^3 E^4/s,   c = [...],   and (w c)'/|v| = r E^3/s^3 [3 E + 4 r^2 (s E' - E)] c - r^2 E^4 B mu_d
 * v_eps^2/s^5 */
static inline void dmb_friction_reach_static(const dmb_local_friction *local, dmb_real speed, dmb_real s, dmb_real *f,
                                             dmb_real *g)
{
    dmb_real slope;
    const dmb_friction_law *law = local->law;
    const double eps2 = law->smoothing_speed * law->smoothing_speed;
    const dmb_real mu_d = local->mu_dynamic;
    const dmb_real mu_s =
        law->points > 0 ? mu_d * (law->table_mu[0] / law->table_mu[law->points - 1]) : local->mu_static;
    const dmb_real E = law->points > 0 ? dmb_friction_table_decay(law, s, &slope) : dmb_stribeck_decay(law, s, &slope);
    const dmb_real i = 1.0 / s, r = speed * i, cube = E * E * E, i3 = i * i * i;
    const dmb_real c = law->peak_bump * (mu_s - mu_d) + law->peak_level * mu_d * (1.0 - r);
    *f = *f + r * r * r * cube * E * i * c;
    *g = *g + r * cube * i3 *
                  ((3.0 * E + 4.0 * r * r * (s * slope - E)) * c - r * E * i * i * (law->peak_level * mu_d * eps2));
}

/* f = mu(s)/s, g = (mu'/s - mu/s^2)/s with ds/d|v| = |v|/s */
static inline void dmb_friction_smoothed(const dmb_local_friction *local, dmb_real speed, dmb_real *f, dmb_real *g)
{
    const dmb_friction_law *law = local->law;
    const dmb_real zero = dmb_real_of(0.0), s = dmb_friction_norm(speed, dmb_real_of(law->smoothing_speed));
    const dmb_mask rests = dmb_mask_at_most(s, zero);
    dmb_real slope = zero, mu = local->mu_dynamic;
    if (law->kind != DMB_FRICTION_COULOMB) mu = dmb_stribeck(local, s, &slope);
    const dmb_real divisor = dmb_real_select(rests, dmb_real_of(1.0), s);
    *f = dmb_real_select(rests, zero, mu / divisor);
    *g = dmb_real_select(rests, zero, (slope - *f) / (divisor * divisor));
    if (law->kind != DMB_FRICTION_COULOMB && law->peak_level > 0.0) dmb_friction_reach_static(local, speed, s, f, g);
}

/* Arguments of the caller's law in a lane. */
static inline dmb_friction_at dmb_friction_arguments(const dmb_local_friction *local, const dmb_real *N,
                                                     const dmb_real v[2], const dmb_real v_old[2], int lane)
{
    const dmb_friction_at at = {.normal_force = dmb_real_lane(N, lane) > 0.0 ? dmb_real_lane(N, lane) : 0.0,
                                .slip = {dmb_real_lane(v, lane), dmb_real_lane(v + 1, lane)},
                                .slip_before = {dmb_real_lane(v_old, lane), dmb_real_lane(v_old + 1, lane)},
                                .mu_static = dmb_real_lane(&local->mu_static, lane),
                                .mu_dynamic = dmb_real_lane(&local->mu_dynamic, lane)};
    return at;
}

/* The caller's law in the lanes of `lanes`, one by one; 0 in others. at, memory: of each lane. */
static inline void dmb_friction_called(const dmb_local_friction *local, const dmb_friction_at *at,
                                       const dmb_law_memory *memory, uint32_t lanes, dmb_real F[2], dmb_real *dF_dv,
                                       dmb_real dF_dN[2])
{
    for (int l = 0; l < DMB_REAL_LANES; l++) {
        dmb_friction_result of = {{0.0}, {0.0}, {0.0}};
        if ((lanes >> l & 1) != 0 && dmb_friction_call(local->law, at + l, memory + l, &of) < 0 &&
            local->failed != NULL)
            *local->failed = 1;
        for (int i = 0; i < 2; i++) dmb_real_set_lane(F + i, l, of.force[i]);
        for (int i = 0; i < 2; i++) dmb_real_set_lane(dF_dN + i, l, of.by_normal[i]);
        for (int i = 0; dF_dv != NULL && i < 4; i++) dmb_real_set_lane(dF_dv + i, l, of.by_slip[i]);
    }
}

/* The caller's law in sliding on and on. */
static inline void dmb_friction_slide_called(const dmb_local_friction *local, dmb_real N, const dmb_real v[2],
                                             dmb_real F[2], dmb_real *dF_dv, dmb_real dF_dN[2])
{
    static const double none[DMB_FRICTION_STATES] = {0.0};
    double unused[DMB_FRICTION_STATES];
    const dmb_law_memory memory = {none, unused, (double)INFINITY};
    dmb_law_memory memories[DMB_REAL_LANES];
    dmb_friction_at at[DMB_REAL_LANES];
    uint32_t lanes = 0;
    for (int l = 0; l < DMB_REAL_LANES; l++) {
        at[l] = dmb_friction_arguments(local, &N, v, v, l);
        memories[l] = memory;
        lanes |= (at[l].normal_force > 0.0 ? 1u : 0u) << l;
    }
    dmb_friction_called(local, at, memories, lanes, F, dF_dv, dF_dN);
}

static inline void dmb_friction_smooth_at(const dmb_local_friction *local, dmb_real N, const dmb_real v[2],
                                          dmb_real F[2], dmb_real *dF_dv, dmb_real dF_dN[2])
{
    if (dmb_friction_is_called(local->law)) {
        dmb_friction_slide_called(local, N, v, F, dF_dv, dF_dN);
        return;
    }
    const dmb_real speed = dmb_friction_norm(v[0], v[1]);
    dmb_real f = dmb_real_of(0.0), g = dmb_real_of(0.0);
    if (local->law->kind == DMB_FRICTION_AMBROSIO)
        dmb_friction_ambrosio(local, speed, &f, &g);
    else if (local->law->kind != DMB_FRICTION_NONE)
        dmb_friction_smoothed(local, speed, &f, &g);
    dmb_friction_radial(N, v, f, g, F, dF_dv, dF_dN);
}

/* ---- Bristles ------------------------------------------------------------------------------------------------------
 */

/* Projects a vector radially onto the disc |x| <= limit, and its derivative dx (2,2) accordingly:
 * d(limit x/|x|) = limit/|x| (I - e e^T) dx + e d_limit^T, e = x/|x| (eq:friction.projection). Returns the lanes that
 * were outside. */
static inline dmb_mask dmb_onto_circle(dmb_real x[2], dmb_real dx[4], dmb_real limit, const dmb_real d_limit[2])
{
    const dmb_real length = dmb_friction_norm(x[0], x[1]);
    const dmb_mask outside = dmb_mask_less(limit, length);
    if (!dmb_mask_any(outside)) return outside;
    const dmb_real divisor = dmb_real_select(outside, length, dmb_real_of(1.0));
    const dmb_real e[2] = {x[0] / divisor, x[1] / divisor}, ratio = limit / divisor;
    for (int j = 0; j < 2; ++j) {
        const dmb_real along = e[0] * dx[j] + e[1] * dx[2 + j];
        for (int i = 0; i < 2; ++i) {
            const dmb_real moved = ratio * (dx[2 * i + j] - e[i] * along) + e[i] * d_limit[j];
            dx[2 * i + j] = dmb_real_select(outside, moved, dx[2 * i + j]);
        }
    }
    for (int i = 0; i < 2; ++i) x[i] = dmb_real_select(outside, limit * e[i], x[i]);
    return outside;
}

/* Friction limit over normal force and its gradient: mu_static if stuck, otherwise the Stribeck curve at |v|. */
static inline dmb_real dmb_bristle_limit(const dmb_local_friction *local, const dmb_real v[2], dmb_mask stuck,
                                         dmb_real d_mu[2])
{
    const dmb_real zero = dmb_real_of(0.0), speed = dmb_friction_norm(v[0], v[1]);
    const dmb_mask slides = dmb_mask_less(zero, speed) & dmb_mask_not(stuck);
    dmb_real slope;
    const dmb_real mu = dmb_stribeck(local, speed, &slope);
    const dmb_real divisor = dmb_real_select(slides, speed, dmb_real_of(1.0));
    const dmb_real factor = dmb_real_select(slides, slope / divisor, zero);
    d_mu[0] = factor * v[0];
    d_mu[1] = factor * v[1];
    return dmb_real_select(stuck, local->mu_static, mu);
}

static inline dmb_mask dmb_friction_bristle(const dmb_local_friction *local, dmb_real N, const dmb_real v[2],
                                            const dmb_real z_old[2], const dmb_real v_old[2], dmb_mask stuck, double h,
                                            dmb_real z[2], dmb_real F[2], dmb_real *dF_dv, dmb_real dF_dN[2])
{
    const double sigma0 = local->law->bristle_stiffness, sigma1 = local->law->bristle_damping;
    const dmb_real zero = dmb_real_of(0.0), half = dmb_real_of(0.5 * h);
    dmb_real d_mu[2], dq[4] = {half, zero, zero, half};
    const dmb_real mu = dmb_bristle_limit(local, v, stuck, d_mu);
    const dmb_real d_limit[2] = {d_mu[0] / sigma0, d_mu[1] / sigma0};
    for (int i = 0; i < 2; ++i) z[i] = z_old[i] + 0.5 * h * (v_old[i] + v[i]);
    dmb_mask slides = dmb_onto_circle(z, dq, mu / sigma0, d_limit);

    dmb_real q[2] = {sigma0 * z[0], sigma0 * z[1]};
    for (int i = 0; i < 4; ++i) dq[i] *= sigma0;
    if (sigma1 != 0.0) { /* without damping q is within the disc already */
        q[0] += sigma1 * v[0];
        q[1] += sigma1 * v[1];
        dq[0] += sigma1;
        dq[3] += sigma1;
        slides = slides | dmb_onto_circle(q, dq, mu, d_mu);
    }
    for (int i = 0; i < 2; ++i) {
        dF_dN[i] = -q[i];
        F[i] = -N * q[i];
    }
    for (int i = 0; dF_dv != NULL && i < 4; ++i) dF_dv[i] = -N * dq[i];
    return dmb_mask_not(slides);
}

#endif
