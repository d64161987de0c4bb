/* Motion of a curved element (element/curved_mass.h): of its deformation, of the axes in its middle, of its centre. */
#ifndef DMB_ELEMENT_CURVED_MOTION_H
#define DMB_ELEMENT_CURVED_MOTION_H

#include "element/curved_shape.h"

/* Velocities and accelerations, axes of the middle. */
typedef struct dmb_curved_motion {
    dmb_real rate[6], second[6]; /* d', d'' */
    dmb_real w[3], turning[3];   /* [rad/s] of the middle, [rad/s2] */
    dmb_real mean[3], change[3]; /* of the mean axes */
    dmb_real V[3], A[3];         /* [m/s], [m/s2] of the centre */
} dmb_curved_motion;

/* Half the sum of two vectors of the ends, in the axes of the middle. */
static inline void dmb_curved_mean(const dmb_curved_shape *shape, const dmb_real a[3], const dmb_real b[3],
                                   dmb_real out[3])
{
    dmb_real x[3];
    dmb_curved_to_middle(shape, 1.0, a, x);
    dmb_curved_to_middle(shape, -1.0, b, out);
    for (int i = 0; i < 3; i++) out[i] = 0.5 * (x[i] + out[i]);
}

/* Adds Gamma d' to an angular velocity. */
static inline void dmb_curved_add_turn(const dmb_curved_constants *c, const dmb_real rate[6], dmb_real w[3])
{
    w[1] -= c->turn[1] * rate[2];
    w[2] += c->turn[0] * rate[1];
}

/* d' (eq:beam.strain-rate), w_m (eq:curved.middle-rate), and V. */
static inline void dmb_curved_velocity(const dmb_curved_constants *c, const dmb_curved_shape *shape,
                                       const dmb_real v[12], dmb_curved_motion *motion)
{
    const dmb_real *O = shape->d + 3, *rate = motion->rate, *dO = motion->rate + 3;
    dmb_real y[3], G[3];
    dmb_se3_inverse_tangents_apply(shape->d, &shape->k, v, v + 6, motion->rate);
    dmb_curved_mean(shape, v + 3, v + 9, motion->w);
    dmb_vec3_cross(O, dO, y);
    dmb_vec3_axpy(-0.25 * shape->half.b, y, motion->w);
    dmb_vec3_copy(motion->w, motion->mean);
    dmb_curved_add_turn(c, rate, motion->mean);
    dmb_curved_mean(shape, v, v + 6, motion->V);
    dmb_vec3_cross(motion->w, shape->z, y);
    dmb_vec3_add(motion->V, y, motion->V);
    dmb_curved_scale(c, shape->gamma[0], rate, G); /* z' = G x O' + G' x O */
    dmb_vec3_axpy(2.0 * dmb_vec3_dot(O, dO) * shape->gamma[1], shape->d, G);
    dmb_vec3_cross(G, O, y);
    dmb_vec3_add(motion->V, y, motion->V);
    dmb_vec3_cross(shape->G, dO, y);
    dmb_vec3_add(motion->V, y, motion->V);
}

/* d'' = T6^-1(d) v_B' - T6^-1(-d) v_A' + (X(d, v_B) + X(-d, v_A)) d' */
static inline void dmb_curved_second(const dmb_curved_shape *shape, const dmb_real v[12], const dmb_real a[12],
                                     dmb_curved_motion *motion)
{
    dmb_real back[6], turned[6];
    dmb_se3_tangent X, Xa;
    for (int i = 0; i < 6; i++) back[i] = -shape->d[i];
    dmb_se3_velocity_derivative_at(shape->d, v + 6, &shape->k, &X);
    dmb_se3_velocity_derivative_at(back, v, &shape->k, &Xa);
    dmb_mat3_add(X.S, Xa.S, X.S);
    dmb_mat3_add(X.B, Xa.B, X.B);
    dmb_se3_tangent_apply(&X, motion->rate, turned);
    dmb_se3_inverse_tangents_apply(shape->d, &shape->k, a, a + 6, motion->second);
    for (int i = 0; i < 6; i++) motion->second[i] += turned[i];
}

/* z'' = G x O'' + 2 G' x O' + G'' x O, added with w' x z + w x (w x z) + 2 w x z' */
static inline void dmb_curved_add_offset(const dmb_curved_constants *c, const dmb_curved_shape *shape,
                                         dmb_curved_motion *motion)
{
    const dmb_real *O = shape->d + 3, *d1 = motion->rate, *d2 = motion->second;
    const dmb_real s = 2.0 * dmb_vec3_dot(O, d1 + 3);
    const dmb_real s1 = 2.0 * (dmb_vec3_norm_squared(d1 + 3) + dmb_vec3_dot(O, d2 + 3));
    dmb_real G1[3], G2[3], y[3], z1[3];
    dmb_curved_scale(c, shape->gamma[0], d1, G1);
    dmb_vec3_axpy(s * shape->gamma[1], shape->d, G1);
    dmb_curved_scale(c, shape->gamma[0], d2, G2);
    dmb_vec3_axpy(2.0 * s * shape->gamma[1], d1, G2);
    dmb_vec3_axpy(s * s * shape->gamma[2] + s1 * shape->gamma[1], shape->d, G2);
    dmb_vec3_cross(shape->G, d1 + 3, z1);
    dmb_vec3_cross(G1, O, y);
    dmb_vec3_add(z1, y, z1);
    dmb_vec3_cross(shape->G, d2 + 3, y);
    dmb_vec3_add(motion->A, y, motion->A);
    dmb_vec3_cross(G1, d1 + 3, y);
    dmb_vec3_axpy(dmb_real_of(2.0), y, motion->A);
    dmb_vec3_cross(G2, O, y);
    dmb_vec3_add(motion->A, y, motion->A);
    dmb_vec3_cross(motion->turning, shape->z, y);
    dmb_vec3_add(motion->A, y, motion->A);
    dmb_vec3_cross(motion->w, z1, y);
    dmb_vec3_axpy(dmb_real_of(2.0), y, motion->A);
    dmb_vec3_cross(motion->w, shape->z, y);
    dmb_vec3_cross(motion->w, y, y);
    dmb_vec3_add(motion->A, y, motion->A);
}

/* Acceleration of a point, u' + w x u. */
static inline void dmb_curved_point(const dmb_real v[6], const dmb_real a[6], dmb_real out[3])
{
    dmb_vec3_cross(v + 3, v, out);
    dmb_vec3_add(out, a, out);
}

/* Requires the velocities; w_m' = (R^T w_A' + R w_B')/2 + w_m x E + E',  E = -b/4 O x O'. */
static inline void dmb_curved_acceleration(const dmb_curved_constants *c, const dmb_curved_shape *shape,
                                           const dmb_real v[12], const dmb_real a[12], dmb_curved_motion *motion)
{
    const dmb_real *O = shape->d + 3, *d1 = motion->rate + 3;
    dmb_real E[3], y[3], near_end[3], far_end[3];
    dmb_curved_second(shape, v, a, motion);
    dmb_curved_mean(shape, a + 3, a + 9, motion->turning);
    dmb_vec3_cross(O, d1, y);
    dmb_vec3_scale(-0.25 * shape->half.b, y, E);
    dmb_vec3_axpy(-0.0625 * shape->half.db * dmb_vec3_dot(O, d1), y, motion->turning);
    dmb_vec3_cross(motion->w, E, y);
    dmb_vec3_add(motion->turning, y, motion->turning);
    dmb_vec3_cross(O, motion->second + 3, y);
    dmb_vec3_axpy(-0.25 * shape->half.b, y, motion->turning);
    dmb_vec3_copy(motion->turning, motion->change);
    dmb_curved_add_turn(c, motion->second, motion->change);
    dmb_curved_point(v, a, near_end);
    dmb_curved_point(v + 6, a + 6, far_end);
    dmb_curved_mean(shape, near_end, far_end, motion->A);
    dmb_curved_add_offset(c, shape, motion);
}

#endif
