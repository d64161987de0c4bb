/* 6x6 matrices (row-major, 36 numbers), 6-vectors (translation; rotation) and the adjoint maps of SE(3).
 * Vector functions may overwrite their inputs; matrix products require a separate output. */
#ifndef DMB_MATH_MAT6_H
#define DMB_MATH_MAT6_H

#include "math/vec3.h"

static inline void dmb_vec6_copy(const dmb_real a[6], dmb_real out[6])
{
    for (int i = 0; i < 6; i++) out[i] = a[i];
}

static inline dmb_real dmb_vec6_dot(const dmb_real a[6], const dmb_real b[6])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] + a[4] * b[4] + a[5] * b[5];
}

static inline void dmb_mat6_zero(dmb_real A[36])
{
    for (int i = 0; i < 36; i++) A[i] = dmb_real_of(0.0);
}

static inline void dmb_mat6_copy(const dmb_real A[36], dmb_real out[36])
{
    for (int i = 0; i < 36; i++) out[i] = A[i];
}

/* C = A + B; C may be A or B */
static inline void dmb_mat6_add(const dmb_real A[36], const dmb_real B[36], dmb_real C[36])
{
    for (int i = 0; i < 36; i++) C[i] = A[i] + B[i];
}

/* B += s A */
static inline void dmb_mat6_axpy(dmb_real s, const dmb_real A[36], dmb_real B[36])
{
    for (int i = 0; i < 36; i++) B[i] += s * A[i];
}

static inline void dmb_mat6_transpose(const dmb_real A[36], dmb_real *restrict out)
{
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) out[6 * i + j] = A[6 * j + i];
}

/* A += s a b^T */
static inline void dmb_mat6_add_outer(dmb_real s, const dmb_real a[6], const dmb_real b[6], dmb_real A[36])
{
    for (int i = 0; i < 6; i++) {
        const dmb_real f = s * a[i];
        for (int j = 0; j < 6; j++) A[6 * i + j] += f * b[j];
    }
}

/* The 3x3 block (i, j), i, j = 0 or 1, of a 6x6 matrix: write, add to. */
static inline void dmb_mat6_set_block(const dmb_real block[9], int i, int j, dmb_real A[36])
{
    for (int r = 0; r < 3; r++) dmb_vec3_copy(block + 3 * r, A + 18 * i + 6 * r + 3 * j);
}

static inline void dmb_mat6_add_block(dmb_real s, const dmb_real block[9], int i, int j, dmb_real A[36])
{
    for (int r = 0; r < 3; r++) dmb_vec3_axpy(s, block + 3 * r, A + 18 * i + 6 * r + 3 * j);
}

/* The block (i, j) += s a~ */
static inline void dmb_mat6_add_skew(dmb_real s, const dmb_real a[3], int i, int j, dmb_real A[36])
{
    dmb_real *block = A + 18 * i + 3 * j;
    block[1] -= s * a[2];
    block[2] += s * a[1];
    block[6] += s * a[2];
    block[8] -= s * a[0];
    block[12] -= s * a[1];
    block[13] += s * a[0];
}

/* y[j] = sum_k a[k * step] B[k][j]: one row of a product, along whole rows of B so that it vectorises */
static inline void dmb_mat6_row(const dmb_real *a, int step, const dmb_real B[36], dmb_real *restrict y)
{
    for (int j = 0; j < 6; j++) y[j] = a[0] * B[j];
    for (int k = 1; k < 6; k++)
        for (int j = 0; j < 6; j++) y[j] += a[k * step] * B[6 * k + j];
}

/* C = A B */
static inline void dmb_mat6_mul(const dmb_real A[36], const dmb_real B[36], dmb_real *restrict C)
{
    for (int i = 0; i < 6; i++) dmb_mat6_row(A + 6 * i, 1, B, C + 6 * i);
}

/* C = A^T B */
static inline void dmb_mat6_mul_tn(const dmb_real A[36], const dmb_real B[36], dmb_real *restrict C)
{
    for (int i = 0; i < 6; i++) dmb_mat6_row(A + i, 6, B, C + 6 * i);
}

/* y = A x; y may be x */
static inline void dmb_mat6_vec(const dmb_real A[36], const dmb_real x[6], dmb_real y[6])
{
    dmb_real t[6];
    for (int i = 0; i < 6; i++) t[i] = dmb_vec6_dot(A + 6 * i, x);
    dmb_vec6_copy(t, y);
}

/* y = A^T x; y may be x */
static inline void dmb_mat6_tvec(const dmb_real A[36], const dmb_real x[6], dmb_real y[6])
{
    dmb_real t[6];
    dmb_mat6_row(x, 1, A, t);
    dmb_vec6_copy(t, y);
}

/* out = ad(v) y = (w x yu + u x yw; w x yw) */
static inline void dmb_ad_apply(const dmb_real v[6], const dmb_real y[6], dmb_real out[6])
{
    dmb_real a[3], b[3], c[3];
    dmb_vec3_cross(v + 3, y, a);
    dmb_vec3_cross(v, y + 3, b);
    dmb_vec3_cross(v + 3, y + 3, c);
    dmb_vec3_add(a, b, out);
    dmb_vec3_copy(c, out + 3);
}

/* out = ad(v)^T p = (-w x pu; -u x pu - w x pw): the coadjoint of eq:motion.euler-poincare */
DMB_REAL_INLINE void dmb_ad_transpose(const dmb_real v[6], const dmb_real p[6], dmb_real out[6])
{
    dmb_real a[3], b[3], c[3];
    dmb_vec3_cross(p, v + 3, a);
    dmb_vec3_cross(p, v, b);
    dmb_vec3_cross(p + 3, v + 3, c);
    dmb_vec3_copy(a, out);
    dmb_vec3_add(b, c, out + 3);
}

/* out = A(p) (eq:motion.gyroscopic), so that ad(v)^T p = A(p) v: its derivative with respect to v at fixed p */
static inline void dmb_ad_transpose_derivative(const dmb_real p[6], dmb_real out[36])
{
    dmb_real P[9];
    dmb_mat6_zero(out);
    dmb_skew(p, P);
    dmb_mat6_set_block(P, 0, 1, out);
    dmb_mat6_set_block(P, 1, 0, out);
    dmb_skew(p + 3, P);
    dmb_mat6_set_block(P, 1, 1, out);
}

/* Ad(R,x) = [R, x~R; 0, R] (eq:kinematics.adjoint) */
static inline void dmb_adjoint6(const dmb_real R[9], const dmb_real x[3], dmb_real out[36])
{
    dmb_real X[9], XR[9];
    dmb_skew(x, X);
    dmb_mat3_mul(X, R, XR);
    dmb_mat6_zero(out);
    dmb_mat6_set_block(R, 0, 0, out);
    dmb_mat6_set_block(XR, 0, 1, out);
    dmb_mat6_set_block(R, 1, 1, out);
}

/* out = Ad(R,x) v = (R u + x x (R w); R w) */
static inline void dmb_adjoint_apply(const dmb_real R[9], const dmb_real x[3], const dmb_real v[6], dmb_real out[6])
{
    dmb_real w[3], u[3], c[3];
    dmb_mat3_vec(R, v + 3, w);
    dmb_mat3_vec(R, v, u);
    dmb_vec3_cross(x, w, c);
    dmb_vec3_add(u, c, out);
    dmb_vec3_copy(w, out + 3);
}

/* out = Ad(R,x)^-1 v = (R^T (u - x x w); R^T w) */
static inline void dmb_adjoint_inverse_apply(const dmb_real R[9], const dmb_real x[3], const dmb_real v[6],
                                             dmb_real out[6])
{
    dmb_real u[3], c[3];
    dmb_vec3_cross(x, v + 3, c);
    dmb_vec3_sub(v, c, u);
    dmb_mat3_tvec(R, v + 3, out + 3);
    dmb_mat3_tvec(R, u, out);
}

#endif
