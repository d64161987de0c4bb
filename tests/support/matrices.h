/* Full matrices of what the library only applies, and other maps that its tests hold it against. */
#ifndef DMB_TESTS_MATRICES_H
#define DMB_TESTS_MATRICES_H

#include "math/se3.h"

static inline double determinant_of(const double A[9])
{
    double c[3];
    dmb_vec3_cross(A + 3, A + 6, c);
    return dmb_vec3_dot(A, c);
}

/* O = log R, |O| <= pi */
static inline void log_of_rotation(const double R[9], double O[3])
{
    double q[4];
    dmb_quat_from_matrix(R, q);
    dmb_quat_log(q, O);
}

/* T6(h) as a full matrix */
static inline void tangent_matrix(const double h[6], double out[36])
{
    dmb_se3_tangent T;
    dmb_se3_tangent_at(h, NULL, &T);
    dmb_se3_tangent_matrix(&T, out);
}

/* T6(h)^-1 as a full matrix */
static inline void inverse_tangent_matrix(const double h[6], double out[36])
{
    dmb_se3_inverse_tangent T;
    dmb_se3_inverse_tangent_at(h, NULL, &T);
    dmb_se3_tangent_matrix(&T, out);
}

/* out = [0, J; J, H] */
static inline void stress_matrix(const dmb_se3_stress_blocks *D, double out[36])
{
    dmb_mat6_zero(out);
    dmb_mat6_set_block(D->J, 0, 1, out);
    dmb_mat6_set_block(D->J, 1, 0, out);
    dmb_mat6_set_block(D->H, 1, 1, out);
}

/* D1(h, s) = d/dh (T6(h)^-T s) at fixed s */
static inline void stress_derivative_matrix(const double h[6], const double s[6], double out[36])
{
    dmb_se3_stress_blocks D;
    dmb_se3_stress_blocks_at(h, s, NULL, &D, NULL);
    stress_matrix(&D, out);
}

#endif
