/* Rotations: exponential, logarithm, tangent operators, quaternions (scalar first).
 *
 * O is a rotation vector, t = |O| its angle, x = t^2. Every coefficient is a smooth function of x, and up to the
 * angle pi a polynomial gives it: no trigonometric call, no division by a small angle, the same bits whatever the
 * mathematics library of the host. */
#ifndef DMB_MATH_SO3_H
#define DMB_MATH_SO3_H

#include <math.h>
#include <stddef.h>

#include "math/vec3.h"

#define DMB_PI 3.14159265358979323846

/* Squared angles: below the first a short series does, below the second (just above pi^2) the long one. */
#define DMB_SO3_SMALL 0.25
#define DMB_SO3_MEDIUM 10.5

/* a = sin t/t   b = (1-cos t)/t^2   a2 = (t-sin t)/t^3   db = b'/t   da2 = a2'/t */
typedef struct dmb_so3_coefficients {
    double a, b, a2, db, da2;
} dmb_so3_coefficients;

/* c = (1-g)/x with g = (t/2) cot(t/2)   e = c'/t   e2 = e'/t */
typedef struct dmb_so3_inverse_coefficients {
    double c, e, e2;
} dmb_so3_inverse_coefficients;

/* s4 = sum (-x)^k/(2k+4)!   s5 = sum (-x)^k/(2k+5)! */
static inline void dmb_so3_tails(double x, int terms, double *s4, double *s5)
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
    double u = c4[terms - 1], v = c5[terms - 1];
    for (int k = terms - 2; k >= 0; k--) {
        u = u * x + c4[k];
        v = v * x + c5[k];
    }
    *s4 = u;
    *s5 = v;
}

/* a2 = 1/6 - x s5, b = 1/2 - x s4, a = 1 - x a2, and db = (a-2b)/x, da2 = (b-3 a2)/x lose their division. */
static inline void dmb_so3_coefficients_series(double x, int terms, dmb_so3_coefficients *k)
{
    double s4, s5;
    dmb_so3_tails(x, terms, &s4, &s5);
    k->a2 = 1.0 / 6.0 - x * s5;
    k->b = 0.5 - x * s4;
    k->a = 1.0 - x * k->a2;
    k->db = 2.0 * s4 - k->a2;
    k->da2 = 3.0 * s5 - s4;
}

static inline void dmb_so3_coefficients_closed(double x, dmb_so3_coefficients *k)
{
    const double t = sqrt(x), s = sin(0.5 * t);
    k->a = sin(t) / t;
    k->b = 2.0 * s * s / x;
    k->a2 = (1.0 - k->a) / x;
    k->db = (k->a - 2.0 * k->b) / x;
    k->da2 = (k->b - 3.0 * k->a2) / x;
}

/* The coefficients at x = |O|^2; exact limits at x = 0. */
static inline void dmb_so3_coefficients_at(double x, dmb_so3_coefficients *k)
{
    if (x < DMB_SO3_SMALL)
        dmb_so3_coefficients_series(x, 7, k);
    else if (x < DMB_SO3_MEDIUM)
        dmb_so3_coefficients_series(x, 13, k);
    else
        dmb_so3_coefficients_closed(x, k);
}

/* c = sum |B_2k| x^(k-1)/(2k)!, with e = 2 dc/dx and e2 = 2 de/dx term by term */
static inline void dmb_so3_inverse_coefficients_series(double x, dmb_so3_inverse_coefficients *k)
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
    double u = c[8], v = e[8], w = e2[8];
    for (int i = 7; i >= 0; i--) {
        u = u * x + c[i];
        v = v * x + e[i];
        w = w * x + e2[i];
    }
    k->c = u;
    k->e = v;
    k->e2 = w;
}

/* c = sum 2/((2 pi k)^2 - x): all terms are positive, so nothing cancels. Poles k = 1, 2 as they stand, the rest,
 * regular up to t = 6 pi, as a series. */
static inline void dmb_so3_inverse_coefficients_poles(double x, dmb_so3_inverse_coefficients *k)
{
    static const double c[10] = {2.0007593556872226e-02, 2.5438120688625620e-05, 5.5845683904944151e-08,
                                 1.4088241574761048e-10, 3.7567162002157979e-13, 1.0280125375360461e-15,
                                 2.8500221292137911e-18, 7.9555754107198446e-21, 2.2289326645537012e-23,
                                 6.2574711508057725e-26};
    static const double e[10] = {5.0876241377251241e-05, 2.2338273561977660e-07, 8.4529449448566277e-10,
                                 3.0053729601726383e-12, 1.0280125375360461e-14, 3.4200265550565496e-17,
                                 1.1137805575007783e-19, 3.5662922632859219e-22, 1.1263448071450389e-24,
                                 3.5173460985819363e-27};
    static const double e2[10] = {4.4676547123955320e-07, 3.3811779779426511e-09, 1.8032237761035829e-11,
                                  8.2241003002883685e-14, 3.4200265550565496e-16, 1.3365366690009339e-18,
                                  4.9928091686002903e-21, 1.8021516914320623e-23, 6.3312229774474842e-26,
                                  2.1761726580254931e-28};
    const double p = 1.0 / (39.478417604357432 - x), q = 1.0 / (157.91367041742973 - x);
    double u = c[9], v = e[9], w = e2[9];
    for (int i = 8; i >= 0; i--) {
        u = u * x + c[i];
        v = v * x + e[i];
        w = w * x + e2[i];
    }
    k->c = 2.0 * (p + q) + u;
    k->e = 4.0 * (p * p + q * q) + v;
    k->e2 = 16.0 * (p * p * p + q * q * q) + w;
}

/* e = (ib + g - 2)/x^2, ib = (t/2)^2/sin^2(t/2)   e2 = ((dib + dg)/x^2 - 4 e/t)/t */
static inline void dmb_so3_inverse_coefficients_closed(double x, dmb_so3_inverse_coefficients *k)
{
    const double t = sqrt(x), h = 0.5 * t, s = sin(h);
    const double g = h * cos(h) / s, ib = h * h / (s * s);
    const double dib = ib / h * (1.0 - g), dg = (g - ib) / t;
    k->c = (1.0 - g) / x;
    k->e = (ib + g - 2.0) / (x * x);
    k->e2 = ((dib + dg) / (x * x) - 4.0 * k->e / t) / t;
}

/* The coefficients of the inverse tangent at x = |O|^2; singular at t = 2 pi, where the inverse is. */
static inline void dmb_so3_inverse_coefficients_at(double x, dmb_so3_inverse_coefficients *k)
{
    if (x < DMB_SO3_SMALL)
        dmb_so3_inverse_coefficients_series(x, k);
    else if (x < DMB_SO3_MEDIUM)
        dmb_so3_inverse_coefficients_poles(x, k);
    else
        dmb_so3_inverse_coefficients_closed(x, k);
}

/* The given coefficients, or those of O when there are none (NULL). */
static inline dmb_so3_coefficients dmb_so3_coefficients_or(const double O[3], const dmb_so3_coefficients *k)
{
    dmb_so3_coefficients own;
    if (k) return *k;
    dmb_so3_coefficients_at(dmb_vec3_norm_squared(O), &own);
    return own;
}

static inline dmb_so3_inverse_coefficients dmb_so3_inverse_coefficients_or(const double O[3],
                                                                           const dmb_so3_inverse_coefficients *k)
{
    dmb_so3_inverse_coefficients own;
    if (k) return *k;
    dmb_so3_inverse_coefficients_at(dmb_vec3_norm_squared(O), &own);
    return own;
}

/* out = I + p O~ + q O~^2, with O~^2 = O O^T - x I */
static inline void dmb_so3_polynomial(const double O[3], double p, double q, double out[9])
{
    const double d = 1.0 - q * dmb_vec3_norm_squared(O);
    const double xy = q * O[0] * O[1], xz = q * O[0] * O[2], yz = q * O[1] * O[2];
    dmb_vec3_set(d + q * O[0] * O[0], xy - p * O[2], xz + p * O[1], out);
    dmb_vec3_set(xy + p * O[2], d + q * O[1] * O[1], yz - p * O[0], out + 3);
    dmb_vec3_set(xz - p * O[1], yz + p * O[0], d + q * O[2] * O[2], out + 6);
}

/* R = exp(O) = I + a O~ + b O~^2; k may be NULL */
static inline void dmb_so3_exp(const double O[3], const dmb_so3_coefficients *k, double R[9])
{
    const dmb_so3_coefficients f = dmb_so3_coefficients_or(O, k);
    dmb_so3_polynomial(O, f.a, f.b, R);
}

/* T(O) = I - b O~ + a2 O~^2: body angular velocity = T(O) O'; T(-O) = T^T; k may be NULL */
static inline void dmb_so3_tangent(const double O[3], const dmb_so3_coefficients *k, double T[9])
{
    const dmb_so3_coefficients f = dmb_so3_coefficients_or(O, k);
    dmb_so3_polynomial(O, -f.b, f.a2, T);
}

/* S(O) = T(O)^-1 = I + O~/2 + c O~^2; S(-O) = S^T; k may be NULL */
static inline void dmb_so3_inverse_tangent(const double O[3], const dmb_so3_inverse_coefficients *k, double S[9])
{
    const dmb_so3_inverse_coefficients f = dmb_so3_inverse_coefficients_or(O, k);
    dmb_so3_polynomial(O, 0.5, f.c, S);
}

static inline void dmb_quat_identity(double q[4])
{
    q[0] = 1.0;
    q[1] = q[2] = q[3] = 0.0;
}

static inline void dmb_quat_copy(const double q[4], double out[4])
{
    for (int i = 0; i < 4; i++) out[i] = q[i];
}

static inline void dmb_quat_conj(const double q[4], double out[4])
{
    out[0] = q[0];
    dmb_vec3_scale(-1.0, q + 1, out + 1);
}

/* out = p q; out may be p or q */
static inline void dmb_quat_mul(const double p[4], const double q[4], double out[4])
{
    const double w = p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3];
    const double x = p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2];
    const double y = p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1];
    const double z = p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0];
    out[0] = w;
    dmb_vec3_set(x, y, z, out + 1);
}

/* out = p^-1 q for unit p: q seen from p */
static inline void dmb_quat_between(const double p[4], const double q[4], double out[4])
{
    double c[4];
    dmb_quat_conj(p, c);
    dmb_quat_mul(c, q, out);
}

/* To unit length. Within 1e-8 of it one Newton step of 1/sqrt is exact: no root, no division. */
static inline void dmb_quat_normalize(double q[4])
{
    const double n = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], d = n - 1.0;
    const double s = fabs(d) < 1e-8 ? 1.0 - 0.5 * d : 1.0 / sqrt(n);
    for (int i = 0; i < 4; i++) q[i] *= s;
}

/* q = (cos(t/2), sin(t/2) O/t): with the coefficients at the half angle, cos = 1 - (x/4) b and sin(t/2)/t = a/2 */
static inline void dmb_quat_exp(const double O[3], double q[4])
{
    const double y = 0.25 * dmb_vec3_norm_squared(O);
    dmb_so3_coefficients half;
    dmb_so3_coefficients_at(y, &half);
    q[0] = 1.0 - y * half.b;
    dmb_vec3_scale(0.5 * half.a, O, q + 1);
}

/* q <- q exp(O), kept at unit length: one step of a body-frame increment */
static inline void dmb_quat_advance(double q[4], const double O[3])
{
    double d[4];
    dmb_quat_exp(O, d);
    dmb_quat_mul(q, d, q);
    dmb_quat_normalize(q);
}

/* f with O = f v, for q0 >= 0: f = 2 atan(|v|/q0)/|v|. Below about a quarter of a radian
 * atan(r)/r = sum (-r^2)^k/(2k+1), no call. */
static inline double dmb_quat_log_factor(double q0, const double v[3])
{
    static const double odd[10] = {1.0,        1.0 / 3.0,  1.0 / 5.0,  1.0 / 7.0,  1.0 / 9.0,
                                   1.0 / 11.0, 1.0 / 13.0, 1.0 / 15.0, 1.0 / 17.0, 1.0 / 19.0};
    const double n = dmb_vec3_norm_squared(v);
    if (64.0 * n < q0 * q0) {
        const double r = -n / (q0 * q0);
        double s = odd[9];
        for (int k = 8; k >= 0; k--) s = s * r + odd[k];
        return 2.0 * s / q0;
    }
    return n > 0.0 ? 2.0 * atan2(sqrt(n), q0) / sqrt(n) : 2.0;
}

/* O = log q, |O| <= pi, from the branch q0 >= 0 of q and -q; the length of q does not matter */
static inline void dmb_quat_log(const double q[4], double O[3])
{
    const double sign = q[0] < 0.0 ? -1.0 : 1.0;
    dmb_vec3_scale(sign * dmb_quat_log_factor(sign * q[0], q + 1), q + 1, O);
}

/* R = I + 2 q0 v~ + 2 v~^2 */
static inline void dmb_quat_to_matrix(const double q[4], double R[9])
{
    const double x = 2.0 * q[1], y = 2.0 * q[2], z = 2.0 * q[3];
    const double xx = x * q[1], yy = y * q[2], zz = z * q[3];
    const double xy = x * q[2], xz = x * q[3], yz = y * q[3];
    const double wx = x * q[0], wy = y * q[0], wz = z * q[0];
    dmb_vec3_set(1.0 - (yy + zz), xy - wz, xz + wy, R);
    dmb_vec3_set(xy + wz, 1.0 - (xx + zz), yz - wx, R + 3);
    dmb_vec3_set(xz - wy, yz + wx, 1.0 - (xx + yy), R + 6);
}

/* Row `pivot` of 4 q q^T, read off R: divided by its length it is q up to sign. */
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

/* q of R, q0 >= 0. The largest of 4 q_i^2 is at least 1, so the division is always safe. */
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

/* out = R(q) v = v + 2 u x (u x v + q0 v), q = (q0; u); out may be v */
static inline void dmb_quat_rotate(const double q[4], const double v[3], double out[3])
{
    double c[3], d[3];
    dmb_vec3_cross(q + 1, v, c);
    dmb_vec3_axpy(q[0], v, c);
    dmb_vec3_cross(q + 1, c, d);
    dmb_vec3_copy(v, out);
    dmb_vec3_axpy(2.0, d, out);
}

/* out = R(q)^T v; out may be v */
static inline void dmb_quat_rotate_inverse(const double q[4], const double v[3], double out[3])
{
    double c[4];
    dmb_quat_conj(q, c);
    dmb_quat_rotate(c, v, out);
}

/* Rotation about the x axis in q = swing * twist: 2 atan2(qx, q0), on the turn nearest to the predicted angle.
 * Undefined where the swing is a half turn (qx = q0 = 0); the prediction is returned there. */
static inline double dmb_quat_twist(const double q[4], double predicted)
{
    if (q[0] == 0.0 && q[1] == 0.0) return predicted;
    const double angle = 2.0 * atan2(q[1], q[0]);
    return angle + 2.0 * DMB_PI * floor((predicted - angle) / (2.0 * DMB_PI) + 0.5);
}

/* O = log R, |O| <= pi */
static inline void dmb_so3_log(const double R[9], double O[3])
{
    double q[4];
    dmb_quat_from_matrix(R, q);
    dmb_quat_log(q, O);
}

#endif
