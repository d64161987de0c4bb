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

/* out += factor J */
static inline void dmb_lump_add_inertia(const double J[6], double factor, double out[9])
{
    const double full[9] = {J[0], J[3], J[4], J[3], J[1], J[5], J[4], J[5], J[2]};
    dmb_mat3_axpy(factor, full, out);
}

/* Adds mass_factor M + velocity_factor C_t, C_t = -v^^T M - A(p), p = M v, v = (u; w):
 * -v^^T M = [m w~, -w~ b~; m u~ + w~ b~, -u~ b~ + w~ J] */
static inline void dmb_lump_add_inertia_tangent(const dmb_lump *lump, const double v[6], const double p[6],
                                                double mass_factor, double velocity_factor, double out[36])
{
    const double m = lump->mass, s = velocity_factor;
    double u[9], w[9], b[9], J[9], wb[9], ub[9], wJ[9];
    dmb_skew(v, u);
    dmb_skew(v + 3, w);
    dmb_skew(lump->moment, b);
    dmb_mat3_zero(J);
    dmb_lump_add_inertia(lump->inertia, 1.0, J);
    dmb_mat3_mul(w, b, wb);
    dmb_mat3_mul(u, b, ub);
    dmb_mat3_mul(w, J, wJ);
    for (int i = 0; i < 9; i++) J[i] = mass_factor * J[i] + s * (wJ[i] - ub[i]);
    out[0] += mass_factor * m;
    out[7] += mass_factor * m;
    out[14] += mass_factor * m;
    dmb_mat6_add_skew(s * m, v + 3, 0, 0, out);
    dmb_mat6_add_skew(-mass_factor, lump->moment, 0, 1, out);
    dmb_mat6_add_block(-s, wb, 0, 1, out);
    dmb_mat6_add_skew(mass_factor, lump->moment, 1, 0, out);
    dmb_mat6_add_skew(s * m, v, 1, 0, out);
    dmb_mat6_add_block(s, wb, 1, 0, out);
    dmb_mat6_add_block(1.0, J, 1, 1, out);
    dmb_mat6_add_skew(-s, p, 0, 1, out);
    dmb_mat6_add_skew(-s, p, 1, 0, out);
    dmb_mat6_add_skew(-s, p + 3, 1, 1, out);
}

#endif
