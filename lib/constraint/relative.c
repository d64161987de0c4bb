#include "constraint/relative.h"

#include <stddef.h>

#include "math/mat6.h"

void dmb_relative_place(const double Ra[9], const double Rb[9], const double from_a_to_b[3], dmb_relative *relative)
{
    dmb_mat3_mul_tn(Ra, Rb, relative->R);
    dmb_mat3_tvec(Ra, from_a_to_b, relative->p);
}

/* out = s Ad((R, x)^-1), (R, x)^-1 = (R^T, -R^T x) */
static void inverse_adjoint(double s, const double R[9], const double x[3], double out[36])
{
    double Rt[9], y[3];
    dmb_mat3_transpose(R, Rt);
    dmb_mat3_tvec(R, x, y);
    dmb_vec3_scale(-1.0, y, y);
    dmb_adjoint6(Rt, y, out);
    for (int i = 0; i < 36; i++) out[i] *= s;
}

/* Ad(H^-1) Ad(marker_a^-1) = Ad((marker_a H)^-1), and marker_a H = (Ma R, xa + Ma p) is frame b seen from body a. */
void dmb_relative_maps(const double *xa, const double *Ma, const double xb[3], const double Mb[9],
                       dmb_relative *relative)
{
    double R[9], x[3];
    inverse_adjoint(1.0, Mb, xb, relative->to_b);
    dmb_mat6_zero(relative->to_a);
    if (xa == NULL || Ma == NULL) return;
    dmb_mat3_mul(Ma, relative->R, R);
    dmb_mat3_vec(Ma, relative->p, x);
    dmb_vec3_add(xa, x, x);
    inverse_adjoint(-1.0, R, x, relative->to_a);
}

/* H' = H V^, so that to_a' = -ad(V) to_a, while to_b is constant: convective = to_a' v_a. */
void dmb_relative_motion(const double *va, const double vb[6], dmb_relative *relative)
{
    double a[6] = {0.0};
    dmb_mat6_vec(relative->to_b, vb, relative->V);
    if (va != NULL) dmb_mat6_vec(relative->to_a, va, a);
    for (int i = 0; i < 6; i++) relative->V[i] += a[i];
    dmb_ad_apply(relative->V, a, relative->convective);
    for (int i = 0; i < 6; i++) relative->convective[i] = -relative->convective[i];
}

void dmb_relative_pull_back(const dmb_relative *relative, const double w[6], double *wa, double wb[6])
{
    if (wa != NULL) dmb_mat6_tvec(relative->to_a, w, wa);
    dmb_mat6_tvec(relative->to_b, w, wb);
}

/* The block of K from row `row` and column `column` on: A^T W B */
static void set_block(const double A[36], const double W[36], const double B[36], int row, int column, double K[144])
{
    double WB[36], block[36];
    dmb_mat6_mul(W, B, WB);
    dmb_mat6_mul_tn(A, WB, block);
    for (int i = 0; i < 6; i++) dmb_vec6_copy(block + 6 * i, K + 12 * (row + i) + column);
}

/* Rows b: to_b^T W xi. Rows a have d(to_a)^T w = -to_a^T ad(xi)^T w = -to_a^T A(w) xi besides (dmb_ad_transpose_...):
 *     K = [to_a^T (W - A(w)); to_b^T W] [to_a, to_b] */
void dmb_relative_tangent(const dmb_relative *relative, const double w[6], const double W[36], double K[144])
{
    double Wa[36];
    dmb_ad_transpose_derivative(w, Wa);
    for (int i = 0; i < 36; i++) Wa[i] = W[i] - Wa[i];
    set_block(relative->to_a, Wa, relative->to_a, 0, 0, K);
    set_block(relative->to_a, Wa, relative->to_b, 0, 6, K);
    set_block(relative->to_b, W, relative->to_a, 6, 0, K);
    set_block(relative->to_b, W, relative->to_b, 6, 6, K);
}
