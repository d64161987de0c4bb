/* Rigid mass on a node: spatial inertia [m I, -b~; b~, J] at the node, body frame, constant. */
#ifndef DMB_ELEMENT_LUMP_H
#define DMB_ELEMENT_LUMP_H

#include "element/element_type.h"
#include "math/mat6.h"

static inline void dmb_lump_inertia_times(const double J[6], const double w[3], double out[3])
{
    dmb_vec3_set(J[0] * w[0] + J[3] * w[1] + J[4] * w[2], J[3] * w[0] + J[1] * w[1] + J[5] * w[2],
                 J[4] * w[0] + J[5] * w[1] + J[2] * w[2], out);
}

/* p = (m u - b x w; b x u + J w) */
static inline void dmb_lump_mass_times(const dmb_lump *lump, const double v[6], double p[6])
{
    double c[3], j[3];
    dmb_vec3_cross(v + 3, lump->moment, c);
    dmb_vec3_scale(lump->mass, v, p);
    dmb_vec3_add(p, c, p);
    dmb_vec3_cross(lump->moment, v, c);
    dmb_lump_inertia_times(lump->inertia, v + 3, j);
    dmb_vec3_add(c, j, p + 3);
}

/* M as a matrix */
static inline void dmb_lump_matrix(const dmb_lump *lump, double M[36])
{
    const double *J = lump->inertia;
    const double full[9] = {J[0], J[3], J[4], J[3], J[1], J[5], J[4], J[5], J[2]};
    double b[9];
    dmb_mat6_zero(M);
    M[0] = M[7] = M[14] = lump->mass;
    dmb_skew(lump->moment, b);
    dmb_mat6_add_block(-1.0, b, 0, 1, M);
    dmb_mat6_add_block(1.0, b, 1, 0, M);
    dmb_mat6_set_block(full, 1, 1, M);
}

/* Adds mass_factor M + velocity_factor C_t, C_t = -v^^T M - A(p), p = M v. */
static inline void dmb_lump_add_inertia_tangent(const dmb_lump *lump, const double v[6], const double p[6],
                                                double mass_factor, double velocity_factor, double out[36])
{
    double M[36], ad[36], adM[36], A[36];
    dmb_lump_matrix(lump, M);
    dmb_ad6(v, ad);
    dmb_mat6_mul_tn(ad, M, adM);
    dmb_ad_transpose_derivative(p, A);
    for (int i = 0; i < 36; i++) out[i] += mass_factor * M[i] - velocity_factor * (adM[i] + A[i]);
}

#endif
