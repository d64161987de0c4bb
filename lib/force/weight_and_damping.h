/* Weight and external damping of a node, for numbers that are doubles or lanes of doubles (math/real.h). */
#ifndef DMB_FORCE_WEIGHT_AND_DAMPING_H
#define DMB_FORCE_WEIGHT_AND_DAMPING_H

#include "math/mat6.h"

/* Body-frame weight m R^T g [N] and its moment b x R^T g [N m] (eq:motion.weight). Both change with a rotation of the
 * body: d(R^T g) = (R^T g)~ dtheta. The rotation columns of the residual therefore contain -force~ in the translation
 * rows and -`by_rotation` = -b~ (R^T g)~ in the rotation rows. */
static inline void dmb_weight_at(const double gravity[3], const dmb_real R[9], dmb_real mass, const dmb_real moment[3],
                                 dmb_real force[6], dmb_real by_rotation[9])
{
    dmb_real g[3];
    for (int i = 0; i < 3; i++) g[i] = R[i] * gravity[0] + R[3 + i] * gravity[1] + R[6 + i] * gravity[2];
    dmb_vec3_scale(mass, g, force);
    dmb_vec3_cross(moment, g, force + 3);
    dmb_skew_product(moment, g, by_rotation);
}

/* Damping force of pipe along x: the lateral velocity of a slice at x is v_y + x w_z and v_z - x w_y. c: axial,
 * torsional, and lateral times the integrals of 1, x, x^2. */
static inline void dmb_damping_force(const dmb_real c[5], const dmb_real v[6], dmb_real force[6])
{
    dmb_vec3_set(-c[0] * v[0], -c[2] * v[1] - c[3] * v[5], -c[2] * v[2] + c[3] * v[4], force);
    dmb_vec3_set(-c[1] * v[3], c[3] * v[2] - c[4] * v[4], -c[3] * v[1] - c[4] * v[5], force + 3);
}

/* Adds minus its derivative by velocity, times `factor`, to C. */
static inline void dmb_damping_add_tangent(const dmb_real c[5], double factor, dmb_real C[36])
{
    C[0] += factor * c[0], C[21] += factor * c[1];
    C[7] += factor * c[2], C[14] += factor * c[2];
    C[11] += factor * c[3], C[31] += factor * c[3];
    C[16] -= factor * c[3], C[26] -= factor * c[3];
    C[28] += factor * c[4], C[35] += factor * c[4];
}

#endif
