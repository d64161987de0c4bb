/* Vectors of three and 3x3 matrices (row-major, 9 numbers). Vector functions may overwrite their inputs; matrix
 * products require a separate output. */
#ifndef DMB_MATH_VEC3_H
#define DMB_MATH_VEC3_H

#include "math/real.h"

static inline void dmb_vec3_set(dmb_real x, dmb_real y, dmb_real z, dmb_real out[3])
{
    out[0] = x;
    out[1] = y;
    out[2] = z;
}

static inline void dmb_vec3_zero(dmb_real out[3])
{
    dmb_vec3_set(dmb_real_of(0.0), dmb_real_of(0.0), dmb_real_of(0.0), out);
}

static inline void dmb_vec3_copy(const dmb_real a[3], dmb_real out[3])
{
    dmb_vec3_set(a[0], a[1], a[2], out);
}

static inline dmb_real dmb_vec3_dot(const dmb_real a[3], const dmb_real b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline dmb_real dmb_vec3_norm_squared(const dmb_real a[3])
{
    return dmb_vec3_dot(a, a);
}

#ifndef DMB_LANES
static inline double dmb_vec3_norm(const double a[3])
{
    return sqrt(dmb_vec3_dot(a, a));
}
#endif

/* out = a x b */
static inline void dmb_vec3_cross(const dmb_real a[3], const dmb_real b[3], dmb_real out[3])
{
    dmb_vec3_set(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0], out);
}

/* out = s a */
static inline void dmb_vec3_scale(dmb_real s, const dmb_real a[3], dmb_real out[3])
{
    dmb_vec3_set(s * a[0], s * a[1], s * a[2], out);
}

/* out = a + b */
static inline void dmb_vec3_add(const dmb_real a[3], const dmb_real b[3], dmb_real out[3])
{
    dmb_vec3_set(a[0] + b[0], a[1] + b[1], a[2] + b[2], out);
}

/* out = a - b */
static inline void dmb_vec3_sub(const dmb_real a[3], const dmb_real b[3], dmb_real out[3])
{
    dmb_vec3_set(a[0] - b[0], a[1] - b[1], a[2] - b[2], out);
}

/* y += s x */
static inline void dmb_vec3_axpy(dmb_real s, const dmb_real x[3], dmb_real y[3])
{
    dmb_vec3_set(y[0] + s * x[0], y[1] + s * x[1], y[2] + s * x[2], y);
}

/* out = a~, so that a~ b = a x b */
static inline void dmb_skew(const dmb_real a[3], dmb_real out[9])
{
    const dmb_real zero = dmb_real_of(0.0);
    dmb_vec3_set(zero, -a[2], a[1], out);
    dmb_vec3_set(a[2], zero, -a[0], out + 3);
    dmb_vec3_set(-a[1], a[0], zero, out + 6);
}

/* out = a~ b~ = b a^T - (a . b) I, without the products that are 0 */
static inline void dmb_skew_product(const dmb_real a[3], const dmb_real b[3], dmb_real out[9])
{
    const dmb_real x = a[0] * b[0], y = a[1] * b[1], z = a[2] * b[2];
    dmb_vec3_set(-z - y, b[0] * a[1], b[0] * a[2], out);
    dmb_vec3_set(b[1] * a[0], -z - x, b[1] * a[2], out + 3);
    dmb_vec3_set(b[2] * a[0], b[2] * a[1], -y - x, out + 6);
}

static inline void dmb_mat3_zero(dmb_real A[9])
{
    for (int i = 0; i < 9; i++) A[i] = dmb_real_of(0.0);
}

static inline void dmb_mat3_identity(dmb_real A[9])
{
    dmb_mat3_zero(A);
    A[0] = A[4] = A[8] = dmb_real_of(1.0);
}

static inline void dmb_mat3_copy(const dmb_real A[9], dmb_real out[9])
{
    for (int i = 0; i < 9; i++) out[i] = A[i];
}

/* C = A + B; C may be A or B */
static inline void dmb_mat3_add(const dmb_real A[9], const dmb_real B[9], dmb_real C[9])
{
    for (int i = 0; i < 9; i++) C[i] = A[i] + B[i];
}

/* B += s A */
static inline void dmb_mat3_axpy(dmb_real s, const dmb_real A[9], dmb_real B[9])
{
    for (int i = 0; i < 9; i++) B[i] += s * A[i];
}

/* A += s a b^T */
static inline void dmb_mat3_add_outer(dmb_real s, const dmb_real a[3], const dmb_real b[3], dmb_real A[9])
{
    for (int i = 0; i < 3; i++) dmb_vec3_axpy(s * a[i], b, A + 3 * i);
}

static inline void dmb_mat3_transpose(const dmb_real A[9], dmb_real *restrict out)
{
    for (int i = 0; i < 3; i++) dmb_vec3_set(A[i], A[3 + i], A[6 + i], out + 3 * i);
}

/* C = A B */
static inline void dmb_mat3_mul(const dmb_real A[9], const dmb_real B[9], dmb_real *restrict C)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) C[3 * i + j] = A[3 * i] * B[j] + A[3 * i + 1] * B[3 + j] + A[3 * i + 2] * B[6 + j];
}

/* C = A^T B */
static inline void dmb_mat3_mul_tn(const dmb_real A[9], const dmb_real B[9], dmb_real *restrict C)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) C[3 * i + j] = A[i] * B[j] + A[3 + i] * B[3 + j] + A[6 + i] * B[6 + j];
}

/* C = A B^T */
static inline void dmb_mat3_mul_nt(const dmb_real A[9], const dmb_real B[9], dmb_real *restrict C)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) C[3 * i + j] = dmb_vec3_dot(A + 3 * i, B + 3 * j);
}

/* y = A x; y may be x */
DMB_REAL_INLINE void dmb_mat3_vec(const dmb_real A[9], const dmb_real x[3], dmb_real y[3])
{
    dmb_vec3_set(dmb_vec3_dot(A, x), dmb_vec3_dot(A + 3, x), dmb_vec3_dot(A + 6, x), y);
}

/* y = A^T x; y may be x */
DMB_REAL_INLINE void dmb_mat3_tvec(const dmb_real A[9], const dmb_real x[3], dmb_real y[3])
{
    const dmb_real a = x[0], b = x[1], c = x[2];
    dmb_vec3_set(A[0] * a + A[3] * b + A[6] * c, A[1] * a + A[4] * b + A[7] * c, A[2] * a + A[5] * b + A[8] * c, y);
}

#endif
