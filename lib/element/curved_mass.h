/* Mass of a curved element (eq:curved.kinetic-energy), for numbers that are doubles or lanes of doubles.
 *
 * Kinetic energy of the helix with its bending shapes to first order: translation of the centre of mass, rotation at
 * the speed w of the mean axes with the inertia J(d), constants C for the motion relative to these, and S, which makes
 * an axisymmetric element that spins about its own curved axis free of inertia forces. Rigid motions have the mass,
 * momentum and energy of the curved body; at rest the mass of the straight element results. Forces are derived from
 * Lagrange's equations (eq:curved.forces), so that the power of inertia is the rate of the energy for any d. */
#ifndef DMB_ELEMENT_CURVED_MASS_H
#define DMB_ELEMENT_CURVED_MASS_H

#include "element/curved_motion.h"

/* Generalised forces conjugate to the centre's velocity, to the middle's angular velocity, and to d'. */
typedef struct dmb_curved_force {
    dmb_real F[3], N[3], D[6];
} dmb_curved_force;

/* ---- Angular momentum -------------------------------------------------------------------------------------------- */

/* J w (eq:curved.inertia) in two parts: y x (w x y) of the centre line, with the moments p of its three vectors; and
 * the axes of the sections, with their weights r. */
typedef struct dmb_curved_spin {
    dmb_real A[3], B[3], C[3], p[3][3]; /* w x U, w x W, w x Z */
    dmb_real dot[3], r[3];              /* of e, g, f */
    dmb_real momentum[3];
} dmb_curved_spin;

static inline void dmb_curved_spin_at(const dmb_curved_constants *c, const dmb_curved_shape *s, const dmb_real w[3],
                                      dmb_curved_spin *out)
{
    const dmb_real across = c->rotary[0] - c->rotary[1], even = s->even[0] + s->beta[0] * s->beta[0];
    dmb_real y[3];
    dmb_vec3_cross(w, s->U, out->A);
    dmb_vec3_cross(w, s->W, out->B);
    dmb_vec3_cross(w, s->Z, out->C);
    for (int i = 0; i < 3; i++) {
        out->p[0][i] = (1.0 / 12.0) * out->A[i] + s->odd[0] * out->B[i];
        out->p[1][i] = s->odd[0] * out->A[i] + s->square[0] * out->B[i];
        out->p[2][i] = s->even[0] * out->C[i];
    }
    dmb_vec3_scale(c->rotary[1], w, out->momentum);
    dmb_vec3_cross(s->U, out->p[0], y);
    dmb_vec3_axpy(c->mass, y, out->momentum);
    dmb_vec3_cross(s->W, out->p[1], y);
    dmb_vec3_axpy(c->mass, y, out->momentum);
    dmb_vec3_cross(s->Z, out->p[2], y);
    dmb_vec3_axpy(c->mass, y, out->momentum);
    out->dot[0] = dmb_vec3_dot(s->e, w);
    out->dot[1] = dmb_vec3_dot(s->g, w);
    out->dot[2] = dmb_vec3_dot(s->f, w);
    out->r[0] = out->dot[0] + s->beta[0] * out->dot[1];
    out->r[1] = s->beta[0] * out->dot[0] + even * out->dot[1];
    out->r[2] = s->sine[0] * out->dot[2];
    dmb_vec3_axpy(across * out->r[0], s->e, out->momentum);
    dmb_vec3_axpy(across * out->r[1], s->g, out->momentum);
    dmb_vec3_axpy(across * out->r[2], s->f, out->momentum);
}

/* Rates of the vectors of a shape. */
typedef struct dmb_curved_rates {
    dmb_real U[3], Z[3], W[3], e[3], f[3], g[3], square; /* the last is the rate of |O|^2 */
} dmb_curved_rates;

static inline void dmb_curved_cross_rate(const dmb_real O[3], const dmb_real dO[3], const dmb_real y[3],
                                         const dmb_real dy[3], dmb_real out[3])
{
    dmb_real x[3];
    dmb_vec3_cross(dO, y, x);
    dmb_vec3_cross(O, dy, out);
    dmb_vec3_add(out, x, out);
}

static inline void dmb_curved_rates_at(const dmb_curved_constants *c, const dmb_curved_shape *s, const dmb_real rate[6],
                                       dmb_curved_rates *out)
{
    const dmb_real *O = s->d + 3, *dO = rate + 3;
    dmb_curved_spread(c, rate, out->U);
    dmb_curved_cross_rate(O, dO, s->U, out->U, out->Z);
    dmb_curved_cross_rate(O, dO, s->Z, out->Z, out->W);
    dmb_curved_tilt(c, rate, dmb_real_of(0.0), out->e);
    dmb_curved_cross_rate(O, dO, s->e, out->e, out->f);
    dmb_curved_cross_rate(O, dO, s->f, out->f, out->g);
    out->square = 2.0 * dmb_vec3_dot(O, dO);
}

/* out += f (y' x p + y x p') */
static inline void dmb_curved_add_moment(dmb_real f, const dmb_real y[3], const dmb_real dy[3], const dmb_real p[3],
                                         const dmb_real dp[3], dmb_real out[3])
{
    dmb_real x[3];
    dmb_curved_cross_rate(y, dy, p, dp, x);
    dmb_vec3_axpy(f, x, out);
}

/* (J w)' = J w' + J' w: the derivative of each product of dmb_curved_spin_at. */
static inline void dmb_curved_spin_rate(const dmb_curved_constants *c, const dmb_curved_shape *s,
                                        const dmb_curved_spin *spin, const dmb_curved_rates *q,
                                        const dmb_curved_motion *motion, dmb_real out[3])
{
    const dmb_real *w = motion->mean, *dw = motion->change, across = c->rotary[0] - c->rotary[1], t = q->square;
    const dmb_real even = s->even[0] + s->beta[0] * s->beta[0];
    const dmb_real even1 = s->even[1] + 2.0 * s->beta[0] * s->beta[1];
    dmb_real A[3], B[3], C[3], p[3][3], dot[3], r[3];
    dmb_curved_cross_rate(w, dw, s->U, q->U, A);
    dmb_curved_cross_rate(w, dw, s->W, q->W, B);
    dmb_curved_cross_rate(w, dw, s->Z, q->Z, C);
    for (int i = 0; i < 3; i++) {
        p[0][i] = (1.0 / 12.0) * A[i] + s->odd[0] * B[i] + t * s->odd[1] * spin->B[i];
        p[1][i] = s->odd[0] * A[i] + s->square[0] * B[i] + t * (s->odd[1] * spin->A[i] + s->square[1] * spin->B[i]);
        p[2][i] = s->even[0] * C[i] + t * s->even[1] * spin->C[i];
    }
    dmb_vec3_scale(c->rotary[1], dw, out);
    dmb_curved_add_moment(c->mass, s->U, q->U, spin->p[0], p[0], out);
    dmb_curved_add_moment(c->mass, s->W, q->W, spin->p[1], p[1], out);
    dmb_curved_add_moment(c->mass, s->Z, q->Z, spin->p[2], p[2], out);
    dot[0] = dmb_vec3_dot(q->e, w) + dmb_vec3_dot(s->e, dw);
    dot[1] = dmb_vec3_dot(q->g, w) + dmb_vec3_dot(s->g, dw);
    dot[2] = dmb_vec3_dot(q->f, w) + dmb_vec3_dot(s->f, dw);
    r[0] = dot[0] + s->beta[0] * dot[1] + t * s->beta[1] * spin->dot[1];
    r[1] = s->beta[0] * dot[0] + even * dot[1] + t * (s->beta[1] * spin->dot[0] + even1 * spin->dot[1]);
    r[2] = s->sine[0] * dot[2] + t * s->sine[1] * spin->dot[2];
    dmb_vec3_axpy(across * r[0], s->e, out);
    dmb_vec3_axpy(across * r[1], s->g, out);
    dmb_vec3_axpy(across * r[2], s->f, out);
    dmb_vec3_axpy(across * spin->r[0], q->e, out);
    dmb_vec3_axpy(across * spin->r[1], q->g, out);
    dmb_vec3_axpy(across * spin->r[2], q->f, out);
}

/* Transposed derivative of O x (O x y), once = O x y: `works` are conjugate to y, to `once` and to the whole. Adds to
 * the first two, and to the force conjugate to O. */
static inline void dmb_curved_back(const dmb_real O[3], const dmb_real y[3], const dmb_real once[3],
                                   dmb_real works[3][3], dmb_real of_O[3])
{
    dmb_real x[3];
    dmb_vec3_cross(once, works[2], x);
    dmb_vec3_add(of_O, x, of_O);
    dmb_vec3_cross(works[2], O, x);
    dmb_vec3_add(works[1], x, works[1]);
    dmb_vec3_cross(y, works[1], x);
    dmb_vec3_add(of_O, x, of_O);
    dmb_vec3_cross(works[1], O, x);
    dmb_vec3_add(works[0], x, works[0]);
}

/* D -= gradient of w.J(d) w/2 by d. */
static inline void dmb_curved_subtract_gradient(const dmb_curved_constants *c, const dmb_curved_shape *s,
                                                const dmb_curved_spin *spin, const dmb_real w[3], dmb_real D[6])
{
    const dmb_real *O = s->d + 3, across = c->rotary[0] - c->rotary[1];
    const dmb_real even1 = s->even[1] + 2.0 * s->beta[0] * s->beta[1];
    dmb_real line_works[3][3], axis_works[3][3], of_U[3], of_O[3];
    static const int order[3] = {0, 2, 1}; /* p of U, Z, W; r of e, f, g */
    for (int i = 0; i < 3; i++) {
        dmb_vec3_cross(spin->p[order[i]], w, line_works[i]);
        dmb_vec3_scale(c->mass, line_works[i], line_works[i]);
        dmb_vec3_scale(across * spin->r[order[i]], w, axis_works[i]);
    }
    dmb_vec3_zero(of_O);
    dmb_curved_back(O, s->U, s->Z, line_works, of_O);
    dmb_curved_back(O, s->e, s->f, axis_works, of_O);
    const dmb_real line = 2.0 * s->odd[1] * dmb_vec3_dot(spin->A, spin->B) +
                          s->square[1] * dmb_vec3_norm_squared(spin->B) + s->even[1] * dmb_vec3_norm_squared(spin->C);
    const dmb_real axis = 2.0 * s->beta[1] * spin->dot[0] * spin->dot[1] + even1 * spin->dot[1] * spin->dot[1] +
                          s->sine[1] * spin->dot[2] * spin->dot[2];
    dmb_vec3_axpy(c->mass * line + across * axis, O, of_O);
    dmb_curved_spread(c, line_works[0], of_U);
    of_U[1] += c->tilt[0] * axis_works[0][1];
    of_U[2] += c->tilt[1] * axis_works[0][2];
    for (int i = 0; i < 3; i++) {
        D[i] -= of_U[i];
        D[3 + i] -= of_O[i];
    }
}

/* ---- Spin of the material ---------------------------------------------------------------------------------------- */

/* S of eq:curved.spin: Z = O x U is the lateral bow of the line; k and q make the energy vanish, to the second order of
 * d, for an axisymmetric element that spins about its own curved axis, d' = -w_x e_x x d. */
typedef struct dmb_curved_spinning {
    dmb_real Z1[3], Z2[3];      /* Z', Z'' */
    dmb_real bow, bow_rate;     /* E, E' */
    dmb_real straight, k, q[2]; /* b_0; q by plane */
} dmb_curved_spinning;

/* e_x.(a x b) */
static inline dmb_real dmb_curved_area(const dmb_real a[3], const dmb_real b[3])
{
    return a[1] * b[2] - a[2] * b[1];
}

/* out += f e_x x a */
static inline void dmb_curved_add_across(dmb_real f, const dmb_real a[3], dmb_real out[3])
{
    out[1] -= f * a[2];
    out[2] += f * a[1];
}

static inline void dmb_curved_spinning_at(const dmb_curved_constants *c, const dmb_curved_shape *s,
                                          const dmb_real rate[6], dmb_curved_spinning *out)
{
    const dmb_real *O = s->d + 3, L = 12.0 * c->sixth, across = c->rotary[0] - c->rotary[1];
    dmb_real U1[3];
    dmb_curved_spread(c, rate, U1);
    dmb_curved_cross_rate(O, rate + 3, s->U, U1, out->Z1);
    out->Z1[0] = dmb_real_of(0.0);
    out->bow = c->mass * s->even[0];
    out->bow_rate = 2.0 * c->mass * s->even[1] * dmb_vec3_dot(O, rate + 3);
    out->straight = (1.0 / 720.0) * c->mass * L * L;
    out->k = 0.25 * (c->moving[4] + c->moving[5]) - 0.5 * out->straight - (1.0 / 24.0) * across;
    for (int i = 0; i < 2; i++) {
        const dmb_real off = 1.0 + 12.0 * c->offset[i] - c->turn[i] * L;
        out->q[i] = (1.0 / 24.0) * c->mass * off * off + across * c->tilt[i] * c->turn[i] +
                    0.5 * c->rotary[1] * c->turn[i] * c->turn[i];
    }
}

/* C_U w_x e_x x U */
static inline void dmb_curved_sway(const dmb_curved_constants *c, dmb_real w, const dmb_real U[3], dmb_real out[3])
{
    dmb_vec3_set(dmb_real_of(0.0), -w * c->moving[1] * U[2], w * c->moving[2] * U[1], out);
}

/* Adds to D the force conjugate to Z' = O' x U + O x U', from the lateral force F. */
static inline void dmb_curved_add_bow_force(const dmb_curved_constants *c, const dmb_curved_shape *s,
                                            const dmb_real F[3], dmb_real D[6])
{
    dmb_real y[3], x[3];
    dmb_vec3_cross(s->U, F, y);
    dmb_vec3_add(D + 3, y, D + 3);
    dmb_vec3_cross(F, s->d + 3, y);
    dmb_curved_spread(c, y, x);
    dmb_vec3_add(D, x, D);
}

/* Adds the derivatives of S by w and d' to N and D. */
static inline void dmb_curved_add_spin_momentum(const dmb_curved_constants *c, const dmb_curved_shape *s,
                                                const dmb_curved_motion *motion, dmb_curved_force *f)
{
    const dmb_real *d = s->d, *rate = motion->rate, w = motion->w[0];
    dmb_curved_spinning n;
    dmb_real sway[3], whole[3], F[3];
    dmb_curved_spinning_at(c, s, rate, &n);
    const dmb_real q = 0.5 * (n.q[0] + n.q[1]);
    dmb_curved_sway(c, w, d, sway);
    dmb_vec3_set(dmb_real_of(0.0), c->moving[1] * rate[1] + sway[1], c->moving[2] * rate[2] + sway[2], whole);
    f->N[0] += n.bow * dmb_curved_area(s->Z, n.Z1) + n.k * dmb_curved_area(d + 3, rate + 3) +
               q * dmb_curved_area(d, rate) + dmb_curved_area(d, whole);
    dmb_vec3_scale(n.bow, n.Z1, F);
    dmb_curved_add_across(n.bow * w, s->Z, F);
    dmb_curved_add_bow_force(c, s, F, f->D);
    for (int i = 4; i < 6; i++) f->D[i] -= n.straight * rate[i];
    dmb_curved_add_across(n.k * w, d + 3, f->D + 3);
    dmb_curved_add_across(q * w, d, f->D);
    dmb_vec3_add(f->D, sway, f->D);
}

/* Inertia of the bow: the rate of its part of D minus its gradient. */
static inline void dmb_curved_add_bow_inertia(const dmb_curved_constants *c, const dmb_curved_shape *s,
                                              const dmb_curved_motion *motion, const dmb_curved_spinning *n,
                                              dmb_real D[6])
{
    const dmb_real w = motion->w[0], turning = motion->turning[0];
    const dmb_real slope = 0.5 * dmb_vec3_norm_squared(n->Z1) + w * dmb_curved_area(s->Z, n->Z1);
    dmb_real F[3];
    for (int i = 0; i < 3; i++) F[i] = n->bow_rate * n->Z1[i] + n->bow * n->Z2[i];
    dmb_curved_add_across(n->bow_rate * w + n->bow * turning, s->Z, F);
    dmb_curved_add_across(2.0 * n->bow * w, n->Z1, F);
    dmb_curved_add_bow_force(c, s, F, D);
    dmb_vec3_axpy(-2.0 * c->mass * s->even[1] * slope, s->d + 3, D + 3);
}

/* Z'', lateral components */
static inline void dmb_curved_bow_second(const dmb_curved_constants *c, const dmb_curved_shape *s,
                                         const dmb_curved_motion *motion, dmb_real out[3])
{
    dmb_real U1[3], U2[3], x[3];
    dmb_curved_spread(c, motion->rate, U1);
    dmb_curved_spread(c, motion->second, U2);
    dmb_curved_cross_rate(s->d + 3, motion->second + 3, s->U, U2, out);
    dmb_vec3_cross(motion->rate + 3, U1, x);
    dmb_vec3_axpy(dmb_real_of(2.0), x, out);
    out[0] = dmb_real_of(0.0);
}

/* Adds the inertia forces of S: the rate of N, rotated with the middle, and the rate of D minus the gradient by d. */
static inline void dmb_curved_add_spin_inertia(const dmb_curved_constants *c, const dmb_curved_shape *s,
                                               const dmb_curved_motion *motion, dmb_curved_force *f)
{
    const dmb_real *d = s->d, *rate = motion->rate, *second = motion->second, *w = motion->w;
    const dmb_real turning = motion->turning[0];
    dmb_curved_spinning n;
    dmb_real sway[3], at_rate[3], turned[3], whole[3], change[3];
    dmb_curved_spinning_at(c, s, rate, &n);
    dmb_curved_bow_second(c, s, motion, n.Z2);
    const dmb_real q = 0.5 * (n.q[0] + n.q[1]);
    dmb_curved_sway(c, w[0], d, sway);
    dmb_curved_sway(c, w[0], rate, at_rate);
    dmb_curved_sway(c, turning, d, turned);
    dmb_vec3_zero(whole);
    dmb_vec3_zero(change);
    for (int i = 1; i < 3; i++) {
        whole[i] = c->moving[i] * rate[i] + sway[i];
        change[i] = c->moving[i] * second[i] + at_rate[i] + turned[i];
        f->D[i] += at_rate[i] + turned[i];
        f->D[3 + i] -= n.straight * second[3 + i];
    }
    const dmb_real N = n.bow * dmb_curved_area(s->Z, n.Z1) + n.k * dmb_curved_area(d + 3, rate + 3) +
                       q * dmb_curved_area(d, rate) + dmb_curved_area(d, whole);
    f->N[0] += n.bow_rate * dmb_curved_area(s->Z, n.Z1) + n.bow * dmb_curved_area(s->Z, n.Z2) +
               n.k * dmb_curved_area(d + 3, second + 3) + q * dmb_curved_area(d, second) +
               dmb_curved_area(rate, whole) + dmb_curved_area(d, change);
    f->N[1] += w[2] * N;
    f->N[2] -= w[1] * N;
    dmb_curved_add_across(w[0], whole, f->D); /* minus the gradient by U: -w_x (whole x e_x) */
    dmb_curved_add_across(n.k * turning, d + 3, f->D + 3);
    dmb_curved_add_across(2.0 * n.k * w[0], rate + 3, f->D + 3);
    dmb_curved_add_across(q * turning, d, f->D);
    dmb_curved_add_across(2.0 * q * w[0], rate, f->D);
    dmb_curved_add_bow_inertia(c, s, motion, &n, f->D);
}

/* ---- Forces ------------------------------------------------------------------------------------------------------ */

/* Adds to D the force conjugate to z' from F: G x O + ... with G of the centre; `along` [m] is subtracted from gamma
 * for U_x. */
static inline void dmb_curved_add_offset_force(const dmb_curved_constants *c, const dmb_curved_shape *shape,
                                               const dmb_real G[3], const dmb_real F[3], dmb_real D[6])
{
    const dmb_real *O = shape->d + 3;
    dmb_real y[3], x[3];
    dmb_vec3_cross(F, G, y);
    dmb_vec3_add(D + 3, y, D + 3);
    dmb_vec3_cross(O, F, y);
    dmb_curved_scale(c, shape->gamma[0], y, x);
    dmb_vec3_add(D, x, D);
    dmb_vec3_axpy(2.0 * shape->gamma[1] * dmb_vec3_dot(shape->d, y), O, D + 3);
}

/* Adds the forces on the ends, by the transposes of dmb_curved_velocity; the contribution of F at z is already in N and
 * D. */
static inline void dmb_curved_add_to_ends(const dmb_curved_shape *shape, dmb_curved_force *f, dmb_real ends[12])
{
    dmb_real a[6], b[6], y[3];
    dmb_vec3_cross(f->N, shape->d + 3, y);
    dmb_vec3_axpy(-0.25 * shape->half.b, y, f->D + 3);
    dmb_se3_inverse_tangents_transpose(shape->d, &shape->k, f->D, a, b);
    for (int i = 0; i < 6; i++) {
        ends[i] -= a[i];
        ends[6 + i] += b[i];
    }
    dmb_curved_from_middle(shape, 1.0, f->F, y);
    dmb_vec3_axpy(dmb_real_of(0.5), y, ends);
    dmb_curved_from_middle(shape, 1.0, f->N, y);
    dmb_vec3_axpy(dmb_real_of(0.5), y, ends + 3);
    dmb_curved_from_middle(shape, -1.0, f->F, y);
    dmb_vec3_axpy(dmb_real_of(0.5), y, ends + 6);
    dmb_curved_from_middle(shape, -1.0, f->N, y);
    dmb_vec3_axpy(dmb_real_of(0.5), y, ends + 9);
}

/* Adds all contributions of the force F on the centre. */
static inline void dmb_curved_apply(const dmb_curved_constants *c, const dmb_curved_shape *shape, dmb_curved_force *f,
                                    dmb_real ends[12])
{
    dmb_real y[3];
    dmb_vec3_cross(shape->z, f->F, y);
    dmb_vec3_add(f->N, y, f->N);
    dmb_curved_add_offset_force(c, shape, shape->G, f->F, f->D);
    dmb_curved_add_to_ends(shape, f, ends);
}

/* Adds the momentum p = dT/dv of both ends for the velocities of a motion. */
static inline void dmb_curved_add_momentum(const dmb_curved_constants *c, const dmb_curved_shape *shape,
                                           const dmb_curved_motion *motion, dmb_real p[12])
{
    dmb_curved_spin spin;
    dmb_curved_force f;
    dmb_curved_spin_at(c, shape, motion->mean, &spin);
    dmb_vec3_scale(c->mass, motion->V, f.F);
    dmb_vec3_copy(spin.momentum, f.N);
    for (int i = 0; i < 6; i++) f.D[i] = c->moving[i] * motion->rate[i];
    f.D[1] += c->turn[0] * spin.momentum[2];
    f.D[2] -= c->turn[1] * spin.momentum[1];
    dmb_curved_add_spin_momentum(c, shape, motion, &f);
    dmb_curved_apply(c, shape, &f, p);
}

/* Adds the inertia forces: m A at the centre, (J w)' + w_m x J w about it, C d'' + Gamma^T (J w)' minus the gradient of
 * the energy. */
static inline void dmb_curved_add_inertia(const dmb_curved_constants *c, const dmb_curved_shape *shape,
                                          const dmb_real v[12], const dmb_real a[12], dmb_real ends[12])
{
    dmb_curved_motion motion;
    dmb_curved_spin spin;
    dmb_curved_rates rates;
    dmb_curved_force f;
    dmb_real change[3];
    dmb_curved_velocity(c, shape, v, &motion);
    dmb_curved_acceleration(c, shape, v, a, &motion);
    dmb_curved_spin_at(c, shape, motion.mean, &spin);
    dmb_curved_rates_at(c, shape, motion.rate, &rates);
    dmb_curved_spin_rate(c, shape, &spin, &rates, &motion, change);
    dmb_vec3_scale(c->mass, motion.A, f.F);
    dmb_vec3_cross(motion.w, spin.momentum, f.N);
    dmb_vec3_add(f.N, change, f.N);
    for (int i = 0; i < 6; i++) f.D[i] = c->moving[i] * motion.second[i];
    f.D[1] += c->turn[0] * change[2];
    f.D[2] -= c->turn[1] * change[1];
    dmb_curved_subtract_gradient(c, shape, &spin, motion.mean, f.D);
    dmb_curved_add_spin_inertia(c, shape, &motion, &f);
    dmb_curved_apply(c, shape, &f, ends);
}

/* ---- Weight ------------------------------------------------------------------------------------------------------ */

/* The nodes carry the weight at (x_A + x_B)/2 + L/12 (R_A - R_B) e_x; the centre of weight is displaced from it by R_m
 * times this offset (eq:curved.weight). */
static inline void dmb_curved_weight_offset(const dmb_curved_constants *c, const dmb_curved_shape *shape,
                                            dmb_real offset[3], dmb_real G[3])
{
    dmb_vec3_copy(shape->G, G);
    G[0] -= c->sixth * shape->half.a;
    dmb_vec3_cross(G, shape->d + 3, offset);
}

/* Adds the force due to that offset to the ends, residual side; F: minus the weight in the axes of the middle [N]. */
static inline void dmb_curved_add_weight(const dmb_curved_constants *c, const dmb_curved_shape *shape,
                                         const dmb_real F[3], dmb_real ends[12])
{
    const dmb_real *O = shape->d + 3;
    const dmb_so3_coefficients *h = &shape->half;
    const dmb_real slope = -2.0 * h->a2 - 0.25 * dmb_vec3_norm_squared(O) * h->da2; /* a'/t at O/2 */
    dmb_curved_force f;
    dmb_real offset[3], G[3], y[3];
    dmb_curved_weight_offset(c, shape, offset, G);
    dmb_vec3_zero(f.F);
    dmb_vec3_cross(offset, F, f.N);
    for (int i = 0; i < 6; i++) f.D[i] = dmb_real_of(0.0);
    dmb_curved_add_offset_force(c, shape, G, F, f.D);
    dmb_vec3_cross(O, F, y);
    dmb_vec3_axpy(-0.25 * c->sixth * slope * y[0], O, f.D + 3);
    dmb_curved_add_to_ends(shape, &f, ends);
}

#endif
