/* Rotations: exponential, logarithm, tangent operators, quaternions (scalar first); eq:kinematics.exp-rotation and the
 * equations after it.
 *
 * O is a rotation vector, t = |O| its angle, x = t^2. Every coefficient is a smooth function of x, and up to the angle
 * pi a polynomial gives it: no trigonometric call, no division by a small angle, and results that do not depend on the
 * mathematics library of the host. */
#ifndef DMB_MATH_SO3_H
#define DMB_MATH_SO3_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "math/real.h"
#include "math/vec3.h"

/* Coefficients of rotations away from zero, where the short series below ends; doubles only, not inlined. a, b, a2, db,
 * da2 at x = |O|^2. */
void dmb_so3_far_coefficients(double x, double out[5]);
/* c, e, e2 at x = |O|^2; singular at |O| = 2 pi, as the inverse is. */
void dmb_so3_far_inverse_coefficients(double x, double out[3]);
/* f with O = f v for the quaternion (q0; v), q0 >= 0, n = |v|^2. */
double dmb_quat_far_log_factor(double q0, double n);

/* Squared angles: the short series holds below the first, the long one below the second (just above pi^2). */
#define DMB_SO3_SMALL 0.25
#define DMB_SO3_MEDIUM 10.5

/* a = sin t/t   b = (1-cos t)/t^2   a2 = (t-sin t)/t^3   db = b'/t   da2 = a2'/t */
typedef struct dmb_so3_coefficients {
    dmb_real a, b, a2, db, da2;
} dmb_so3_coefficients;

/* c = (1-g)/x with g = (t/2) cot(t/2)   e = c'/t   e2 = e'/t */
typedef struct dmb_so3_inverse_coefficients {
    dmb_real c, e, e2;
} dmb_so3_inverse_coefficients;

/* s4 = sum (-x)^k/(2k+4)!   s5 = sum (-x)^k/(2k+5)!, the tails of the series of eq:kinematics.coefficients */
static inline void dmb_so3_tails(dmb_real x, int terms, dmb_real *s4, dmb_real *s5)
{
    static const double c4[13] = {4.1666666666666664e-02,  -1.3888888888888889e-03, 2.4801587301587302e-05,
                                  -2.7557319223985888e-07, 2.0876756987868100e-09,  -1.1470745597729725e-11,
                                  4.7794773323873853e-14,  -1.5619206968586225e-16, 4.1103176233121648e-19,
                                  -8.8967913924505741e-22, 1.6117375710961184e-24,  -2.4795962632247976e-27,
                                  3.2798892370698378e-30};
    static const double c5[13] = {8.3333333333333332e-03,  -1.9841269841269841e-04, 2.7557319223985893e-06,
                                  -2.5052108385441720e-08, 1.6059043836821613e-10,  -7.6471637318198164e-13,
                                  2.8114572543455206e-15,  -8.2206352466243295e-18, 1.9572941063391263e-20,
                                  -3.8681701706306841e-23, 6.4469502843844736e-26,  -9.1836898637955460e-29,
                                  1.1309962886447716e-31};
    dmb_real u = dmb_real_of(c4[terms - 1]), v = dmb_real_of(c5[terms - 1]);
    for (int k = terms - 2; k >= 0; k--) {
        u = u * x + c4[k];
        v = v * x + c5[k];
    }
    *s4 = u;
    *s5 = v;
}

/* a2 = 1/6 - x s5, b = 1/2 - x s4, a = 1 - x a2; db = (a-2b)/x and da2 = (b-3 a2)/x (eq:kinematics.coefficient-rates)
 * become series without division. */
static inline void dmb_so3_coefficients_series(dmb_real x, int terms, dmb_so3_coefficients *k)
{
    dmb_real s4, s5;
    dmb_so3_tails(x, terms, &s4, &s5);
    k->a2 = 1.0 / 6.0 - x * s5;
    k->b = 0.5 - x * s4;
    k->a = 1.0 - x * k->a2;
    k->db = 2.0 * s4 - k->a2;
    k->da2 = 3.0 * s5 - s4;
}

/* Computes the coefficients at x = |O|^2; exact limits at x = 0. */
static inline void dmb_so3_coefficients_at(dmb_real x, dmb_so3_coefficients *k)
{
    dmb_so3_coefficients_series(x, 7, k);
    if (dmb_real_below(x, dmb_real_of(DMB_SO3_SMALL))) return;
    for (int lane = 0; lane < DMB_REAL_LANES; lane++) {
        const double far = dmb_real_lane(&x, lane);
        double f[5];
        if (far < DMB_SO3_SMALL) continue;
        dmb_so3_far_coefficients(far, f);
        dmb_real_set_lane(&k->a, lane, f[0]);
        dmb_real_set_lane(&k->b, lane, f[1]);
        dmb_real_set_lane(&k->a2, lane, f[2]);
        dmb_real_set_lane(&k->db, lane, f[3]);
        dmb_real_set_lane(&k->da2, lane, f[4]);
    }
}

/* c = sum |B_2k| x^(k-1)/(2k)!, with e = 2 dc/dx and e2 = 2 de/dx term by term */
static inline void dmb_so3_inverse_coefficients_series(dmb_real x, dmb_so3_inverse_coefficients *k)
{
    static const double c[9] = {8.3333333333333329e-02, 1.3888888888888889e-03, 3.3068783068783071e-05,
                                8.2671957671957675e-07, 2.0876756987868100e-08, 5.2841901386874932e-10,
                                1.3382536530684679e-11, 3.3896802963225827e-13, 8.5860620562778452e-15};
    static const double e[9] = {2.7777777777777779e-03, 1.3227513227513228e-04, 4.9603174603174603e-06,
                                1.6701405590294480e-07, 5.2841901386874934e-09, 1.6059043836821613e-10,
                                4.7455524148516162e-12, 1.3737699290044552e-13, 3.9147636574045110e-15};
    static const double e2[9] = {2.6455026455026457e-04, 1.9841269841269841e-05, 1.0020843354176687e-06,
                                 4.2273521109499947e-08, 1.6059043836821615e-09, 5.6946628978219391e-11,
                                 1.9232779006062372e-12, 6.2636218518472176e-14, 1.9832410182096826e-15};
    dmb_real u = dmb_real_of(c[8]), v = dmb_real_of(e[8]), w = dmb_real_of(e2[8]);
    for (int i = 7; i >= 0; i--) {
        u = u * x + c[i];
        v = v * x + e[i];
        w = w * x + e2[i];
    }
    k->c = u;
    k->e = v;
    k->e2 = w;
}

/* Computes the coefficients of the inverse tangent at x = |O|^2; singular at t = 2 pi, as the inverse is. */
static inline void dmb_so3_inverse_coefficients_at(dmb_real x, dmb_so3_inverse_coefficients *k)
{
    dmb_so3_inverse_coefficients_series(x, k);
    if (dmb_real_below(x, dmb_real_of(DMB_SO3_SMALL))) return;
    for (int lane = 0; lane < DMB_REAL_LANES; lane++) {
        const double far = dmb_real_lane(&x, lane);
        double f[3];
        if (far < DMB_SO3_SMALL) continue;
        dmb_so3_far_inverse_coefficients(far, f);
        dmb_real_set_lane(&k->c, lane, f[0]);
        dmb_real_set_lane(&k->e, lane, f[1]);
        dmb_real_set_lane(&k->e2, lane, f[2]);
    }
}

/* Returns the given coefficients, or those of O if k is NULL. */
static inline dmb_so3_coefficients dmb_so3_coefficients_or(const dmb_real O[3], const dmb_so3_coefficients *k)
{
    dmb_so3_coefficients own;
    if (k) return *k;
    dmb_so3_coefficients_at(dmb_vec3_norm_squared(O), &own);
    return own;
}

static inline dmb_so3_inverse_coefficients dmb_so3_inverse_coefficients_or(const dmb_real O[3],
                                                                           const dmb_so3_inverse_coefficients *k)
{
    dmb_so3_inverse_coefficients own;
    if (k) return *k;
    dmb_so3_inverse_coefficients_at(dmb_vec3_norm_squared(O), &own);
    return own;
}

/* out = I + p O~ + q O~^2, with O~^2 = O O^T - x I */
static inline void dmb_so3_polynomial(const dmb_real O[3], dmb_real p, dmb_real q, dmb_real out[9])
{
    const dmb_real d = 1.0 - q * dmb_vec3_norm_squared(O);
    const dmb_real xy = q * O[0] * O[1], xz = q * O[0] * O[2], yz = q * O[1] * O[2];
    dmb_vec3_set(d + q * O[0] * O[0], xy - p * O[2], xz + p * O[1], out);
    dmb_vec3_set(xy + p * O[2], d + q * O[1] * O[1], yz - p * O[0], out + 3);
    dmb_vec3_set(xz - p * O[1], yz + p * O[0], d + q * O[2] * O[2], out + 6);
}

/* R = exp(O) (eq:kinematics.exp-rotation); k may be NULL */
static inline void dmb_so3_exp(const dmb_real O[3], const dmb_so3_coefficients *k, dmb_real R[9])
{
    const dmb_so3_coefficients f = dmb_so3_coefficients_or(O, k);
    dmb_so3_polynomial(O, f.a, f.b, R);
}

/* T(O) (eq:kinematics.tangent-rotation): body angular velocity = T(O) O'; T(-O) = T^T; k may be NULL */
static inline void dmb_so3_tangent(const dmb_real O[3], const dmb_so3_coefficients *k, dmb_real T[9])
{
    const dmb_so3_coefficients f = dmb_so3_coefficients_or(O, k);
    dmb_so3_polynomial(O, -f.b, f.a2, T);
}

/* S(O) = T(O)^-1 (eq:kinematics.inverse-tangent-rotation); S(-O) = S^T; k may be NULL */
static inline void dmb_so3_inverse_tangent(const dmb_real O[3], const dmb_so3_inverse_coefficients *k, dmb_real S[9])
{
    const dmb_so3_inverse_coefficients f = dmb_so3_inverse_coefficients_or(O, k);
    dmb_so3_polynomial(O, dmb_real_of(0.5), f.c, S);
}

static inline void dmb_quat_copy(const dmb_real q[4], dmb_real out[4])
{
    for (int i = 0; i < 4; i++) out[i] = q[i];
}

static inline void dmb_quat_conj(const dmb_real q[4], dmb_real out[4])
{
    out[0] = q[0];
    dmb_vec3_scale(dmb_real_of(-1.0), q + 1, out + 1);
}

/* out = p q; out may be p or q */
static inline void dmb_quat_mul(const dmb_real p[4], const dmb_real q[4], dmb_real out[4])
{
    const dmb_real w = p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3];
    const dmb_real x = p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2];
    const dmb_real y = p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1];
    const dmb_real z = p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0];
    out[0] = w;
    dmb_vec3_set(x, y, z, out + 1);
}

/* out = p^-1 q for unit p: q relative to p */
static inline void dmb_quat_between(const dmb_real p[4], const dmb_real q[4], dmb_real out[4])
{
    dmb_real c[4];
    dmb_quat_conj(p, c);
    dmb_quat_mul(c, q, out);
}

/* Normalises q. Within 1e-8 of unit length one Newton step of 1/sqrt is exact: no root, no division. */
static inline void dmb_quat_normalize(dmb_real q[4])
{
    const dmb_real n = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], d = n - 1.0;
    dmb_real s = 1.0 - 0.5 * d;
    if (!dmb_real_below(dmb_real_abs(d), dmb_real_of(1e-8)))
        for (int lane = 0; lane < DMB_REAL_LANES; lane++)
            if (!(fabs(dmb_real_lane(&d, lane)) < 1e-8))
                dmb_real_set_lane(&s, lane, 1.0 / sqrt(dmb_real_lane(&n, lane)));
    for (int i = 0; i < 4; i++) q[i] *= s;
}

/* q = (cos(t/2), sin(t/2) O/t): with the coefficients at the half angle, cos = 1 - (x/4) b and sin(t/2)/t = a/2; these
 * coefficients are returned. */
static inline void dmb_quat_exp_half(const dmb_real O[3], dmb_so3_coefficients *half, dmb_real q[4])
{
    const dmb_real y = 0.25 * dmb_vec3_norm_squared(O);
    dmb_so3_coefficients_at(y, half);
    q[0] = 1.0 - y * half->b;
    dmb_vec3_scale(0.5 * half->a, O, q + 1);
}

static inline void dmb_quat_exp(const dmb_real O[3], dmb_real q[4])
{
    dmb_so3_coefficients half;
    dmb_quat_exp_half(O, &half, q);
}

/* f with O = f v, for q0 >= 0: f = 2 atan(|v|/q0)/|v|. Below about a quarter of a radian
 * atan(r)/r = sum (-r^2)^k/(2k+1), no call. */
static inline dmb_real dmb_quat_log_factor(dmb_real q0, const dmb_real v[3])
{
    static const double odd[10] = {1.0,        1.0 / 3.0,  1.0 / 5.0,  1.0 / 7.0,  1.0 / 9.0,
                                   1.0 / 11.0, 1.0 / 13.0, 1.0 / 15.0, 1.0 / 17.0, 1.0 / 19.0};
    const dmb_real n = dmb_vec3_norm_squared(v), square = q0 * q0, r = -n / square;
    dmb_real f = dmb_real_of(odd[9]);
    for (int k = 8; k >= 0; k--) f = f * r + odd[k];
    f = 2.0 * f / q0;
    if (dmb_real_below(64.0 * n, square)) return f;
    for (int lane = 0; lane < DMB_REAL_LANES; lane++) {
        const double far = dmb_real_lane(&n, lane), near = dmb_real_lane(&square, lane);
        if (!(64.0 * far < near)) dmb_real_set_lane(&f, lane, dmb_quat_far_log_factor(dmb_real_lane(&q0, lane), far));
    }
    return f;
}

/* O = log q (eq:kinematics.log-rotation), |O| <= pi, from the branch q0 >= 0 of q and -q; independent of the length of
 * q */
static inline void dmb_quat_log(const dmb_real q[4], dmb_real O[3])
{
    const dmb_real f = dmb_quat_log_factor(dmb_real_abs(q[0]), q + 1);
    dmb_vec3_scale(dmb_real_follow(q[0], f), q + 1, O);
}

/* R = I + 2 q0 v~ + 2 v~^2 */
DMB_REAL_INLINE void dmb_quat_to_matrix(const dmb_real q[4], dmb_real R[9])
{
    const dmb_real x = 2.0 * q[1], y = 2.0 * q[2], z = 2.0 * q[3];
    const dmb_real xx = x * q[1], yy = y * q[2], zz = z * q[3];
    const dmb_real xy = x * q[2], xz = x * q[3], yz = y * q[3];
    const dmb_real wx = x * q[0], wy = y * q[0], wz = z * q[0];
    dmb_vec3_set(1.0 - (yy + zz), xy - wz, xz + wy, R);
    dmb_vec3_set(xy + wz, 1.0 - (xx + zz), yz - wx, R + 3);
    dmb_vec3_set(xz - wy, yz + wx, 1.0 - (xx + yy), R + 6);
}

#ifndef DMB_LANES

/* Row `pivot` of 4 q q^T, computed from R: divided by its length it is q up to sign. */
static inline void dmb_quat_matrix_row(const double R[9], int pivot, double q[4])
{
    const double wx = R[7] - R[5], wy = R[2] - R[6], wz = R[3] - R[1];
    const double xy = R[1] + R[3], xz = R[2] + R[6], yz = R[5] + R[7];
    const double row[4][4] = {{1.0 + R[0] + R[4] + R[8], wx, wy, wz},
                              {wx, 1.0 + R[0] - R[4] - R[8], xy, xz},
                              {wy, xy, 1.0 - R[0] + R[4] - R[8], yz},
                              {wz, xz, yz, 1.0 - R[0] - R[4] + R[8]}};
    dmb_quat_copy(row[pivot], q);
}

/* q of R, q0 >= 0. The largest of 4 q_i^2 is at least 1, so that the division is always safe. */
static inline void dmb_quat_from_matrix(const double R[9], double q[4])
{
    const double s[4] = {R[0] + R[4] + R[8], R[0] - R[4] - R[8], R[4] - R[0] - R[8], R[8] - R[0] - R[4]};
    int pivot = 0;
    for (int i = 1; i < 4; i++)
        if (s[i] > s[pivot]) pivot = i;
    dmb_quat_matrix_row(R, pivot, q);
    const double f = 0.5 / sqrt(q[pivot]), g = q[0] < 0.0 ? -f : f;
    for (int i = 0; i < 4; i++) q[i] *= g;
}

#endif

/* out = R(q) v = v + 2 u x (u x v + q0 v), q = (q0; u); out may be v */
static inline void dmb_quat_rotate(const dmb_real q[4], const dmb_real v[3], dmb_real out[3])
{
    dmb_real c[3], d[3];
    dmb_vec3_cross(q + 1, v, c);
    dmb_vec3_axpy(q[0], v, c);
    dmb_vec3_cross(q + 1, c, d);
    dmb_vec3_copy(v, out);
    dmb_vec3_axpy(dmb_real_of(2.0), d, out);
}

/* out = R(q)^T v; out may be v */
static inline void dmb_quat_rotate_inverse(const dmb_real q[4], const dmb_real v[3], dmb_real out[3])
{
    dmb_real c[4];
    dmb_quat_conj(q, c);
    dmb_quat_rotate(c, v, out);
}

/* Rotation about the x axis in q = swing * twist [rad]: 2 atan2(qx, q0), in the turn nearest to the predicted angle.
 * Undefined if the swing is a half turn (qx = q0 = 0), in which case the prediction is returned. */
static inline dmb_real dmb_quat_twist(const dmb_real q[4], dmb_real predicted)
{
    const double whole = 6755399441055744.0; /* 1.5 2^52: adding and subtracting it rounds to an integer */
    const dmb_real angle = 2.0 * dmb_real_atan2(q[1], q[0]);
    const dmb_real turns = ((predicted - angle) / DMB_TWO_PI + whole) - whole;
    const dmb_real twist = angle + DMB_TWO_PI * turns;
    return dmb_real_select(dmb_mask_at_most(q[0] * q[0] + q[1] * q[1], dmb_real_of(0.0)), predicted, twist);
}

/* x <- R x for both vectors of x, R the same twist: its half angle has cosine q0/n and sine qx/n, n^2 = q0^2 + qx^2.
 * Undefined if the swing is a half turn; x is then unchanged. */
static inline void dmb_quat_twist_pair(const dmb_real q[4], dmb_real x[6])
{
    const dmb_real n2 = q[0] * q[0] + q[1] * q[1];
    const dmb_mask none = dmb_mask_at_most(n2, dmb_real_of(0.0));
    const dmb_real by = 1.0 / dmb_real_select(none, dmb_real_of(1.0), n2);
    const dmb_real c = dmb_real_select(none, dmb_real_of(1.0), (q[0] * q[0] - q[1] * q[1]) * by);
    const dmb_real s = 2.0 * q[0] * q[1] * by;
    for (int i = 1; i < 6; i += 3) {
        const dmb_real y = c * x[i] - s * x[i + 1];
        x[i + 1] = s * x[i] + c * x[i + 1];
        x[i] = y;
    }
}

/* Axes of a frame from two directions. M, axes as columns, row-major, orthonormal to rounding: x along axis, y along
 * normal minus its component along x. For normal = 0 the normal is y of the surrounding frame, or z if x is along y.
 * False, with M unchanged, if the axis is zero or the normal is parallel to it within 1e-6 rad. All numbers must be
 * finite. */
bool dmb_frame_axes(const double axis[3], const double normal[3], double M[9]);

#endif
