/* Added mass of mud on a solid of revolution about the x axis of its node (eq:mud.kirchhoff): S along the axis;
 * laterally by slices, where a slice at x has the velocity v_y + x w_z and v_z - x w_y; no inertia about x. M is
 * symmetric and constant in the body frame, so that with p = M v, v = (u; w), Kirchhoff's equations of a solid in an
 * ideal fluid hold: forces
 * -p_u' - w x p_u, moments -p_w' - w x p_w - u x p_u, the last term is the Munk moment. */
#ifndef DMB_ELEMENT_ADDED_MASS_H
#define DMB_ELEMENT_ADDED_MASS_H

#include "element/element_type.h"
#include "math/mat6.h"

/* p = M v [kg m/s, kg m2/s] */
static inline void dmb_added_mass_times(const dmb_added_mass *added, const double v[6], double p[6])
{
    const double *s = added->across;
    dmb_vec3_set(added->along * v[0], s[0] * v[1] + s[1] * v[5], s[0] * v[2] - s[1] * v[4], p);
    dmb_vec3_set(0.0, s[2] * v[4] - s[1] * v[2], s[2] * v[5] + s[1] * v[1], p + 3);
}

/* Adds factor times M. */
static inline void dmb_added_mass_add(const dmb_added_mass *added, double factor, double M[36])
{
    const double *s = added->across;
    M[0] += factor * added->along;
    M[7] += factor * s[0], M[14] += factor * s[0];
    M[11] += factor * s[1], M[31] += factor * s[1];
    M[16] -= factor * s[1], M[26] -= factor * s[1];
    M[28] += factor * s[2], M[35] += factor * s[2];
}

/* Adds mass_factor M + velocity_factor C, where C v' is the derivative of -ad(v)^T M v: C = -ad(v)^T M - A(p). */
static inline void dmb_added_mass_add_tangent(const dmb_added_mass *added, const double v[6], const double p[6],
                                              double mass_factor, double velocity_factor, double out[36])
{
    double M[36], A[36], column[6];
    dmb_mat6_zero(M);
    dmb_added_mass_add(added, 1.0, M);
    dmb_mat6_axpy(mass_factor, M, out);
    for (int j = 0; j < 6; j++) { /* M is symmetric: a row is a column */
        dmb_ad_transpose(v, M + 6 * j, column);
        for (int i = 0; i < 6; i++) out[6 * i + j] -= velocity_factor * column[i];
    }
    dmb_ad_transpose_derivative(p, A);
    dmb_mat6_axpy(-velocity_factor, A, out);
}

#endif
