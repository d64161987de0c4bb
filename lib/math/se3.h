/* Poses: exponential, logarithm, tangent operators of SE(3) and their derivatives.
 *
 * h = (U; O): translation part U, rotation vector O. A pose is (R, x) or (q, x). Arguments named k are coefficients
 * already evaluated at |O|^2, so that an element evaluates its series once; with NULL they are evaluated here.
 * Formulas: eq:kinematics.exp-pose to eq:kinematics.reversal. */
#ifndef DMB_MATH_SE3_H
#define DMB_MATH_SE3_H

#include "math/mat6.h"
#include "math/so3.h"
#include "math/vec3.h"

/* A 6x6 matrix [S, B; 0, S], the form of T6 and T6^-1. For -h the blocks are transposed. */
typedef struct dmb_se3_tangent {
    dmb_real S[9];
    dmb_real B[9];
} dmb_se3_tangent;

typedef dmb_se3_tangent dmb_se3_inverse_tangent;

/* A 6x6 matrix [0, J; J, H], the shape of the stress derivative. */
typedef struct dmb_se3_stress_blocks {
    dmb_real J[9];
    dmb_real H[9];
} dmb_se3_stress_blocks;

/* out = y + p O x y + q O x (O x y); out may be y */
static inline void dmb_so3_polynomial_apply(const dmb_real O[3], dmb_real p, dmb_real q, const dmb_real y[3],
                                            dmb_real out[3])
{
    dmb_real c[3], d[3];
    dmb_vec3_cross(O, y, c);
    dmb_vec3_cross(O, c, d);
    dmb_vec3_copy(y, out);
    dmb_vec3_axpy(p, c, out);
    dmb_vec3_axpy(q, d, out);
}

/* (R, x) = exp h = (exp O, T(O)^T U) */
static inline void dmb_se3_exp(const dmb_real h[6], const dmb_so3_coefficients *k, dmb_real R[9], dmb_real x[3])
{
    const dmb_so3_coefficients f = dmb_so3_coefficients_or(h + 3, k);
    dmb_so3_exp(h + 3, &f, R);
    dmb_so3_polynomial_apply(h + 3, f.b, f.a2, h, x);
}

/* (q, x) = exp h. From a, b, a2 of the half angle those of the whole angle are b = a^2/2, a2 = (a2 + a b)/4: sums of
 * terms of equal sign. */
static inline void dmb_se3_exp_to_quat(const dmb_real h[6], dmb_real q[4], dmb_real x[3])
{
    dmb_so3_coefficients half;
    dmb_quat_exp_half(h + 3, &half, q);
    dmb_so3_polynomial_apply(h + 3, 0.5 * half.a * half.a, 0.25 * (half.a2 + half.a * half.b), h, x);
}

/* (q, x) <- (q, x) exp h: one step of a body-frame increment */
static inline void dmb_se3_advance(dmb_real q[4], dmb_real x[3], const dmb_real h[6])
{
    dmb_real dq[4], dx[3];
    dmb_se3_exp_to_quat(h, dq, dx);
    dmb_quat_rotate(q, dx, dx);
    dmb_vec3_add(x, dx, x);
    dmb_quat_mul(q, dq, q);
    dmb_quat_normalize(q);
}

/* d = log (q, x) = (S(O)^T x; O). Returns the coefficients at |O|^2 in k unless k is NULL. */
static inline void dmb_se3_log_from_quat(const dmb_real q[4], const dmb_real x[3], dmb_so3_inverse_coefficients *k,
                                         dmb_real d[6])
{
    dmb_real O[3];
    dmb_quat_log(q, O);
    const dmb_so3_inverse_coefficients f = dmb_so3_inverse_coefficients_or(O, NULL);
    dmb_so3_polynomial_apply(O, dmb_real_of(-0.5), f.c, x, d);
    dmb_vec3_copy(O, d + 3);
    if (k) *k = f;
}

#ifndef DMB_LANES
/* d = log (R, x) */
static inline void dmb_se3_log(const double R[9], const double x[3], dmb_so3_inverse_coefficients *k, double d[6])
{
    double q[4];
    dmb_quat_from_matrix(R, q);
    dmb_se3_log_from_quat(q, x, k, d);
}
#endif

/* Derivative of I + p O~ + q O~^2 in the direction U of O, p and q being functions of |O|:
 *    p U~ + q (U~O~ + O~U~) + (O.U)(dp O~ + dq O~^2), with U~O~ + O~U~ = O U^T + U O^T - 2 (O.U) I */
static inline void dmb_so3_polynomial_derivative(const dmb_real h[6], dmb_real p, dmb_real q, dmb_real dp, dmb_real dq,
                                                 dmb_real out[9])
{
    const dmb_real *U = h, *O = h + 3;
    const dmb_real along = dmb_vec3_dot(O, U), half = 0.5 * dq * along;
    dmb_real v[3], r[3];
    dmb_vec3_scale(p, U, v);
    dmb_vec3_axpy(dp * along, O, v);
    dmb_skew(v, out);
    dmb_vec3_scale(q, U, r); /* symmetric part O r^T + r O^T - 2 (O.r) I, r = q U + dq (O.U)/2 O */
    dmb_vec3_axpy(half, O, r);
    dmb_mat3_add_outer(dmb_real_of(1.0), O, r, out);
    dmb_mat3_add_outer(dmb_real_of(1.0), r, O, out);
    const dmb_real trace = 2.0 * dmb_vec3_dot(O, r);
    for (int i = 0; i < 9; i += 4) out[i] -= trace;
}

/* T6(h) = [T, B; 0, T]: body velocity = T6(h) h' (eq:kinematics.tangent-pose). Block S is T(O). */
static inline void dmb_se3_tangent_at(const dmb_real h[6], const dmb_so3_coefficients *k, dmb_se3_tangent *T)
{
    const dmb_so3_coefficients f = dmb_so3_coefficients_or(h + 3, k);
    dmb_so3_tangent(h + 3, &f, T->S);
    dmb_so3_polynomial_derivative(h, -f.b, f.a2, -f.db, f.da2, T->B);
}

/* T6(h)^-1 = [S, B; 0, S] (eq:kinematics.inverse-tangent-pose) */
static inline void dmb_se3_inverse_tangent_at(const dmb_real h[6], const dmb_so3_inverse_coefficients *k,
                                              dmb_se3_inverse_tangent *T)
{
    const dmb_so3_inverse_coefficients f = dmb_so3_inverse_coefficients_or(h + 3, k);
    dmb_so3_inverse_tangent(h + 3, &f, T->S);
    dmb_so3_polynomial_derivative(h, dmb_real_of(0.5), f.c, dmb_real_of(0.0), f.e, T->B);
}

/* The same operator at -h: the blocks transposed. */
static inline void dmb_se3_tangent_reverse(const dmb_se3_tangent *T, dmb_se3_tangent *restrict out)
{
    dmb_mat3_transpose(T->S, out->S);
    dmb_mat3_transpose(T->B, out->B);
}

/* rows x 6 block: K <- K T6 = [a S, a B + b S] row by row */
static inline void dmb_se3_times_tangent(dmb_real *K, uint32_t rows, const dmb_se3_tangent *T)
{
    for (uint32_t r = 0; r < rows; r++) {
        dmb_real *a = K + 6 * r, b[3], c[3];
        dmb_mat3_tvec(T->B, a, b);
        dmb_mat3_tvec(T->S, a + 3, c);
        dmb_vec3_add(b, c, a + 3);
        dmb_mat3_tvec(T->S, a, a);
    }
}

/* out = [S, B; 0, S] */
static inline void dmb_se3_tangent_matrix(const dmb_se3_tangent *T, dmb_real out[36])
{
    dmb_mat6_zero(out);
    dmb_mat6_set_block(T->S, 0, 0, out);
    dmb_mat6_set_block(T->B, 0, 1, out);
    dmb_mat6_set_block(T->S, 1, 1, out);
}

/* out = T v = (S u + B w; S w); out may be v */
static inline void dmb_se3_tangent_apply(const dmb_se3_tangent *T, const dmb_real v[6], dmb_real out[6])
{
    dmb_real b[3];
    dmb_mat3_vec(T->B, v + 3, b);
    dmb_mat3_vec(T->S, v + 3, out + 3);
    dmb_mat3_vec(T->S, v, out);
    dmb_vec3_add(out, b, out);
}

/* out = T^T s = (S^T n; B^T n + S^T m), s = (n; m); out may be s */
static inline void dmb_se3_tangent_apply_transpose(const dmb_se3_tangent *T, const dmb_real s[6], dmb_real out[6])
{
    dmb_real b[3];
    dmb_mat3_tvec(T->B, s, b);
    dmb_mat3_tvec(T->S, s, out);
    dmb_mat3_tvec(T->S, s + 3, out + 3);
    dmb_vec3_add(out + 3, b, out + 3);
}

/* The operator at -h, without forming it: (S^T u + B^T w; S^T w); out may be v */
static inline void dmb_se3_tangent_apply_reverse(const dmb_se3_tangent *T, const dmb_real v[6], dmb_real out[6])
{
    dmb_real b[3];
    dmb_mat3_tvec(T->B, v + 3, b);
    dmb_mat3_tvec(T->S, v + 3, out + 3);
    dmb_mat3_tvec(T->S, v, out);
    dmb_vec3_add(out, b, out);
}

/* Its transpose: (S n; B n + S m); out may be s */
static inline void dmb_se3_tangent_apply_reverse_transpose(const dmb_se3_tangent *T, const dmb_real s[6],
                                                           dmb_real out[6])
{
    dmb_real b[3];
    dmb_mat3_vec(T->B, s, b);
    dmb_mat3_vec(T->S, s, out);
    dmb_mat3_vec(T->S, s + 3, out + 3);
    dmb_vec3_add(out + 3, b, out + 3);
}

/* Both of T6(h)^-1 and T6(-h)^-1 without the matrices (eq:beam.both-ends): S = P + O~/2 and B = Q + U~/2 with
 * P = I + c O~^2 and Q = c (U~O~ + O~U~) + e (O.U) O~^2, both symmetric. */

/* out = P a + Q b */
DMB_REAL_INLINE void dmb_se3_symmetric_apply(const dmb_real h[6], const dmb_so3_inverse_coefficients *k,
                                             const dmb_real a[3], const dmb_real b[3], dmb_real out[3])
{
    const dmb_real *U = h, *O = h + 3;
    dmb_real x[3], y[3], sum[3];
    dmb_vec3_cross(U, b, sum);
    dmb_vec3_cross(O, a, x);
    dmb_vec3_add(sum, x, x);
    dmb_vec3_cross(O, x, sum); /* O x (O x a + U x b) */
    dmb_vec3_cross(O, b, x);
    dmb_vec3_cross(U, x, y);
    dmb_vec3_add(sum, y, sum);
    dmb_vec3_cross(O, x, y);
    dmb_vec3_copy(a, out);
    dmb_vec3_axpy(k->c, sum, out);
    dmb_vec3_axpy(k->e * dmb_vec3_dot(O, U), y, out);
}

/* out = b + c O x (O x b) */
DMB_REAL_INLINE void dmb_so3_symmetric_apply(const dmb_real O[3], dmb_real c, const dmb_real b[3], dmb_real out[3])
{
    dmb_real x[3];
    dmb_vec3_cross(O, b, x);
    dmb_vec3_cross(O, x, x);
    dmb_vec3_copy(b, out);
    dmb_vec3_axpy(c, x, out);
}

/* out = T6(h)^-1 vb - T6(-h)^-1 va: [P, Q; 0, P] times the difference plus [O~, U~; 0, O~] times the mean of both. */
DMB_REAL_INLINE void dmb_se3_inverse_tangents_apply(const dmb_real h[6], const dmb_so3_inverse_coefficients *k,
                                                    const dmb_real va[6], const dmb_real vb[6], dmb_real out[6])
{
    const dmb_real *U = h, *O = h + 3;
    dmb_real difference[6], mean[6], x[3];
    for (int i = 0; i < 6; i++) {
        difference[i] = vb[i] - va[i];
        mean[i] = 0.5 * (va[i] + vb[i]);
    }
    dmb_se3_symmetric_apply(h, k, difference, difference + 3, out);
    dmb_so3_symmetric_apply(O, k->c, difference + 3, out + 3);
    dmb_vec3_cross(O, mean, x);
    dmb_vec3_add(out, x, out);
    dmb_vec3_cross(U, mean + 3, x);
    dmb_vec3_add(out, x, out);
    dmb_vec3_cross(O, mean + 3, x);
    dmb_vec3_add(out + 3, x, out + 3);
}

/* back = T6(-h)^-T s and ahead = T6(h)^-T s */
DMB_REAL_INLINE void dmb_se3_inverse_tangents_transpose(const dmb_real h[6], const dmb_so3_inverse_coefficients *k,
                                                        const dmb_real s[6], dmb_real back[6], dmb_real ahead[6])
{
    const dmb_real *U = h, *O = h + 3;
    dmb_real sum[6], turn[6], x[3];
    dmb_so3_symmetric_apply(O, k->c, s, sum);
    dmb_se3_symmetric_apply(h, k, s + 3, s, sum + 3);
    dmb_vec3_cross(O, s, turn);
    dmb_vec3_cross(O, s + 3, turn + 3);
    dmb_vec3_cross(U, s, x);
    dmb_vec3_add(turn + 3, x, turn + 3);
    for (int i = 0; i < 6; i++) {
        back[i] = sum[i] + 0.5 * turn[i];
        ahead[i] = sum[i] - 0.5 * turn[i];
    }
}

/* A 6x6 matrix [U, V; X, W]. */
typedef struct dmb_se3_rows {
    dmb_real U[9], V[9], X[9], W[9];
} dmb_se3_rows;

/* C = T^T Z for a T6 = [S, B; 0, S]: [S^T U, S^T V; B^T U + S^T X, B^T V + S^T W]. Only the last two rows of X are
 * nonzero. */
static inline void dmb_se3_tangent_times_rows(const dmb_se3_tangent *T, const dmb_se3_rows *Z, dmb_real *restrict C)
{
    dmb_real block[9];
    dmb_mat3_mul_tn(T->S, Z->U, block);
    dmb_mat6_set_block(block, 0, 0, C);
    dmb_mat3_mul_tn(T->S, Z->V, block);
    dmb_mat6_set_block(block, 0, 1, C);
    dmb_mat3_mul_tn(T->B, Z->U, block);
    for (int i = 1; i < 3; i++) dmb_mat3_add_outer(dmb_real_of(1.0), T->S + 3 * i, Z->X + 3 * i, block);
    dmb_mat6_set_block(block, 1, 0, C);
    dmb_mat3_mul_tn(T->B, Z->V, block);
    dmb_mat6_set_block(block, 1, 1, C);
    dmb_mat3_mul_tn(T->S, Z->W, block);
    dmb_mat6_add_block(dmb_real_of(1.0), block, 1, 1, C);
}

/* The same for a symmetric product. */
static inline void dmb_se3_tangent_times_own_rows(const dmb_se3_tangent *T, const dmb_se3_rows *Z, dmb_real *restrict C)
{
    dmb_real block[9], turned[9];
    dmb_mat3_mul_tn(T->S, Z->U, block);
    dmb_mat6_set_block(block, 0, 0, C);
    dmb_mat3_mul_tn(T->S, Z->V, block);
    dmb_mat6_set_block(block, 0, 1, C);
    dmb_mat3_transpose(block, turned);
    dmb_mat6_set_block(turned, 1, 0, C);
    dmb_mat3_mul_tn(T->B, Z->V, block);
    dmb_mat6_set_block(block, 1, 1, C);
    dmb_mat3_mul_tn(T->S, Z->W, block);
    dmb_mat6_add_block(dmb_real_of(1.0), block, 1, 1, C);
}

/* out = (r.a) I + r a^T - 2 a r^T, the gradient of r x (r x a) with respect to r */
static inline void dmb_so3_double_cross_gradient(const dmb_real r[3], const dmb_real a[3], dmb_real out[9])
{
    const dmb_real d = dmb_vec3_dot(r, a);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) out[3 * i + j] = (i == j ? d + r[i] * a[j] : r[i] * a[j]) + -2.0 * a[i] * r[j];
}

/* d/dO (c O~^2 a) = c ((O.a) I + O a^T - 2 a O^T) + e w O^T, w = O x (O x a). Odd in O: the part of both J and Jm that
 * changes sign with h. */
static inline void dmb_so3_square_derivative(const dmb_real O[3], const dmb_real a[3],
                                             const dmb_so3_inverse_coefficients *k, dmb_real out[9])
{
    dmb_real r[3], w[3];
    dmb_vec3_scale(k->c, O, r);
    dmb_so3_double_cross_gradient(r, a, out);
    dmb_vec3_cross(O, a, w);
    dmb_vec3_cross(O, w, w);
    dmb_mat3_add_outer(k->e, w, O, out);
}

/* Hh(h, n), the change of the above as O moves along U; odd in h. With s = O.U and r = c U + e s O:
 * (r.n) I + r n^T - 2 n r^T + (e p + e2 s w) O^T + e w U^T,  p = (O.n)U + (n.U)O - 2 s n */
static inline void dmb_se3_square_second_derivative(const dmb_real h[6], const dmb_real n[3],
                                                    const dmb_so3_inverse_coefficients *k, dmb_real out[9])
{
    const dmb_real *U = h, *O = h + 3;
    const dmb_real s = dmb_vec3_dot(O, U);
    dmb_real r[3], w[3], p[3];
    dmb_vec3_scale(k->c, U, r);
    dmb_vec3_axpy(k->e * s, O, r);
    dmb_so3_double_cross_gradient(r, n, out);
    dmb_vec3_cross(O, n, w);
    dmb_vec3_cross(O, w, w);
    dmb_vec3_scale(k->e * dmb_vec3_dot(O, n), U, p);
    dmb_vec3_axpy(k->e * dmb_vec3_dot(n, U), O, p);
    dmb_vec3_axpy(-2.0 * k->e * s, n, p);
    dmb_vec3_axpy(k->e2 * s, w, p);
    dmb_mat3_add_outer(dmb_real_of(1.0), p, O, out);
    dmb_mat3_add_outer(k->e, w, U, out);
}

/* The blocks J(n) and J(m) + Hh of eq:beam.stress-derivative, s = (n; m), at h and at -h together: n~/2 and m~/2 stay,
 * the rest changes sign. Either of plus and minus may be NULL. */
static inline void dmb_se3_stress_blocks_at(const dmb_real h[6], const dmb_real s[6],
                                            const dmb_so3_inverse_coefficients *k, dmb_se3_stress_blocks *plus,
                                            dmb_se3_stress_blocks *minus)
{
    const dmb_so3_inverse_coefficients f = dmb_so3_inverse_coefficients_or(h + 3, k);
    dmb_real N[9], M[9], J[9], H[9], Hh[9];
    dmb_skew(s, N);
    dmb_skew(s + 3, M);
    dmb_so3_square_derivative(h + 3, s, &f, J);
    dmb_so3_square_derivative(h + 3, s + 3, &f, H);
    dmb_se3_square_second_derivative(h, s, &f, Hh);
    for (int i = 0; i < 9; i++) {
        H[i] += Hh[i];
        if (plus) plus->J[i] = 0.5 * N[i] + J[i];
        if (plus) plus->H[i] = 0.5 * M[i] + H[i];
        if (minus) minus->J[i] = 0.5 * N[i] - J[i];
        if (minus) minus->H[i] = 0.5 * M[i] - H[i];
    }
}

/* out += f [0, J; J, H] [S, B; 0, S] = f [0, J S; J S, J B + H S]: one block of an element's geometric stiffness */
static inline void dmb_se3_stress_times_tangent(dmb_real f, const dmb_se3_stress_blocks *D, const dmb_se3_tangent *T,
                                                dmb_real out[36])
{
    dmb_real block[9];
    dmb_mat3_mul(D->J, T->S, block);
    dmb_mat6_add_block(f, block, 0, 1, out);
    dmb_mat6_add_block(f, block, 1, 0, out);
    dmb_mat3_mul(D->J, T->B, block);
    dmb_mat6_add_block(f, block, 1, 1, out);
    dmb_mat3_mul(D->H, T->S, block);
    dmb_mat6_add_block(f, block, 1, 1, out);
}

/* X(h, v) = d/dh (T6(h)^-1 v) at fixed v = (u; w): [Jm(w), Jm(u) + Hh(w); 0, Jm(w)], Jm(a) = -a~/2 + the odd part. It
 * has the form of T6 and is returned as such. */
static inline void dmb_se3_velocity_derivative_at(const dmb_real h[6], const dmb_real v[6],
                                                  const dmb_so3_inverse_coefficients *k, dmb_se3_tangent *X)
{
    const dmb_so3_inverse_coefficients f = dmb_so3_inverse_coefficients_or(h + 3, k);
    dmb_real skew[9], J[9], H[9];
    dmb_so3_square_derivative(h + 3, v + 3, &f, X->S);
    dmb_skew(v + 3, skew);
    dmb_mat3_axpy(dmb_real_of(-0.5), skew, X->S);
    dmb_so3_square_derivative(h + 3, v, &f, J);
    dmb_skew(v, skew);
    dmb_mat3_axpy(dmb_real_of(-0.5), skew, J);
    dmb_se3_square_second_derivative(h, v + 3, &f, H);
    dmb_mat3_add(J, H, X->B);
}

/* The same as a full matrix. */
static inline void dmb_se3_velocity_derivative(const dmb_real h[6], const dmb_real v[6],
                                               const dmb_so3_inverse_coefficients *k, dmb_real out[36])
{
    dmb_se3_tangent X;
    dmb_se3_velocity_derivative_at(h, v, k, &X);
    dmb_se3_tangent_matrix(&X, out);
}

/* out += s X T: [J S, J B + H S; 0, J S] */
static inline void dmb_se3_add_tangent_product(dmb_real s, const dmb_se3_tangent *X, const dmb_se3_tangent *T,
                                               dmb_se3_tangent *out)
{
    dmb_real product[9];
    dmb_mat3_mul(X->S, T->S, product);
    dmb_mat3_axpy(s, product, out->S);
    dmb_mat3_mul(X->S, T->B, product);
    dmb_mat3_axpy(s, product, out->B);
    dmb_mat3_mul(X->B, T->S, product);
    dmb_mat3_axpy(s, product, out->B);
}

#endif
