/* Sections inside the flexible element, for numbers that are doubles or lanes of doubles (math/real.h). The shapes of
 * bending are added to the helix between its ends: H(x) = exp(x d) exp(c(x) d), see query/motion.c
 * (eq:beam.section-pose). */
#ifndef DMB_ELEMENT_SECTION_MATH_H
#define DMB_ELEMENT_SECTION_MATH_H

#include "element/beam_math.h"

typedef struct dmb_section_shape {
    dmb_real x;       /* [-] fraction of the flexible length */
    dmb_real move[2]; /* [-] lateral displacement per unit of d_y, d_z: N3 - x */
    dmb_real turn[2]; /* [rad/m] rotation of the section per unit of d_y, d_z: G3 */
} dmb_section_shape;

/* Constants of element_type.h that sections require. */
typedef struct dmb_section_constants {
    dmb_real length, arm[2];       /* [m] */
    dmb_real bending[2], shear[2]; /* [N m2, N] of the planes of d_y and d_z */
} dmb_section_constants;

/* Pose of a section relative to end A of the element, and the parts of its map. */
typedef struct dmb_section_frame {
    dmb_real R[2][9], x[2][3]; /* exponentials of x d and of c(x) d */
    dmb_se3_tangent T[2];      /* their tangents */
    dmb_se3_inverse_tangent S;
} dmb_section_frame;

static inline void dmb_section_load_constants(const dmb_element_type *type, int lane, dmb_section_constants *c)
{
    const double *K = type->strain_stiffness;
    dmb_real_set_lane(&c->length, lane, type->length);
    for (int i = 0; i < 2; i++) {
        dmb_real_set_lane(&c->arm[i], lane, type->arm[i]);
        dmb_real_set_lane(&c->bending[i], lane, K[5 - i]);
        dmb_real_set_lane(&c->shear[i], lane, K[1 + i]);
    }
}

/* Per bending plane P = 12 EI/(GA L^2), q = 1/(1+P): N3 - x = (3x^2 - 2x^3 - x) q, G3 = 6 (x - x^2) q/L */
static inline void dmb_section_shape_of(const dmb_section_constants *c, dmb_real x, dmb_section_shape *shape)
{
    shape->x = x;
    for (int i = 0; i < 2; i++) {
        const dmb_real P = 12.0 * c->bending[i] / (c->shear[i] * c->length * c->length), q = 1.0 / (1.0 + P);
        shape->move[i] = x * ((3.0 - 2.0 * x) * x - 1.0) * q;
        shape->turn[i] = 6.0 * x * (1.0 - x) * q / c->length;
    }
}

/* out = c(x) d. Linear in d, so that it also applies to rates. A slope dz/dx is a rotation -theta_y. */
static inline void dmb_section_shape_correct(const dmb_section_shape *shape, const dmb_real d[6], dmb_real out[6])
{
    out[0] = out[3] = dmb_real_of(0.0);
    out[1] = shape->move[0] * d[1];
    out[2] = shape->move[1] * d[2];
    out[4] = -shape->turn[1] * d[2];
    out[5] = shape->turn[0] * d[1];
}

/* d = log(H_A^-1 H_B) of the flexible ends. Ra: axes of node a in the world; span: from node a to node b, world. */
static inline void dmb_section_strain(const dmb_real arm[2], const dmb_real qa[4], const dmb_real Ra[9],
                                      const dmb_real qb[4], const dmb_real span[3], dmb_real d[6])
{
    dmb_real q[4], x[3], far_arm[3] = {-arm[1], dmb_real_of(0.0), dmb_real_of(0.0)};
    dmb_quat_between(qa, qb, q);
    dmb_mat3_tvec(Ra, span, x);
    dmb_quat_rotate(q, far_arm, far_arm);
    dmb_vec3_add(x, far_arm, x);
    x[0] = x[0] - arm[0];
    dmb_se3_log_from_quat(q, x, NULL, d);
}

static inline void dmb_section_exp(const dmb_real h[6], dmb_real R[9], dmb_real x[3], dmb_se3_tangent *T)
{
    const dmb_so3_coefficients k = dmb_so3_coefficients_or(h + 3, NULL);
    dmb_se3_exp(h, &k, R, x);
    dmb_se3_tangent_at(h, &k, T);
}

static inline void dmb_section_frame_at(const dmb_section_shape *shape, const dmb_real d[6], dmb_section_frame *frame)
{
    dmb_real h[6], c[6];
    for (int i = 0; i < 6; i++) h[i] = shape->x * d[i];
    dmb_section_shape_correct(shape, d, c);
    dmb_section_exp(h, frame->R[0], frame->x[0], &frame->T[0]);
    dmb_section_exp(c, frame->R[1], frame->x[1], &frame->T[1]);
    dmb_se3_inverse_tangent_at(d, NULL, &frame->S);
}

/* Rotation Q of the section and its position r [m] in the frame of node a. */
static inline void dmb_section_place(const dmb_section_frame *frame, dmb_real arm, dmb_real Q[9], dmb_real r[3])
{
    dmb_mat3_mul(frame->R[0], frame->R[1], Q);
    dmb_mat3_vec(frame->R[0], frame->x[1], r);
    dmb_vec3_add(r, frame->x[0], r);
    r[0] = r[0] + arm;
}

/* V <- Ad^-1(exp h) V + T6(h) h' */
static inline void dmb_section_follow(const dmb_real R[9], const dmb_real x[3], const dmb_se3_tangent *T,
                                      const dmb_real rate[6], dmb_real v[6])
{
    dmb_real own[6];
    dmb_se3_tangent_apply(T, rate, own);
    dmb_adjoint_inverse_apply(R, x, v, v);
    for (int i = 0; i < 6; i++) v[i] += own[i];
}

/* V = map v (eq:motion.section-map): the velocity of end A, propagated along the two exponentials of H(x). */
static inline void dmb_section_twist(const dmb_real arm[2], const dmb_section_shape *shape,
                                     const dmb_section_frame *frame, const dmb_real v[12], dmb_real V[6])
{
    dmb_real far[6], near_rate[6], rate[6], part[6];
    dmb_vec6_copy(v, V);
    dmb_vec6_copy(v + 6, far);
    dmb_arm_velocity(arm[0], V);
    dmb_arm_velocity(-arm[1], far);
    dmb_se3_tangent_apply(&frame->S, far, rate);
    dmb_se3_tangent_apply_reverse(&frame->S, V, near_rate);
    for (int i = 0; i < 6; i++) rate[i] -= near_rate[i];
    for (int i = 0; i < 6; i++) part[i] = shape->x * rate[i];
    dmb_section_follow(frame->R[0], frame->x[0], &frame->T[0], part, V);
    dmb_section_shape_correct(shape, rate, part);
    dmb_section_follow(frame->R[1], frame->x[1], &frame->T[1], part, V);
}

/* out = Ad^-T(exp h) w: (R f; R m + x x R f) */
static inline void dmb_section_pull(const dmb_real R[9], const dmb_real x[3], const dmb_real w[6], dmb_real out[6])
{
    dmb_real moment[3];
    dmb_mat3_vec(R, w, out);
    dmb_mat3_vec(R, w + 3, out + 3);
    dmb_vec3_cross(x, out, moment);
    dmb_vec3_add(out + 3, moment, out + 3);
}

/* out += the transpose of dmb_section_shape_correct */
static inline void dmb_section_shape_transpose(const dmb_section_shape *shape, const dmb_real s[6], dmb_real out[6])
{
    out[1] += shape->move[0] * s[1] + shape->turn[0] * s[5];
    out[2] += shape->move[1] * s[2] - shape->turn[1] * s[4];
}

/* f = map^T w */
static inline void dmb_section_wrench(const dmb_real arm[2], const dmb_section_shape *shape,
                                      const dmb_section_frame *frame, const dmb_real w[6], dmb_real f[12])
{
    dmb_real at_chord[6], stress[6], part[6];
    dmb_section_pull(frame->R[1], frame->x[1], w, at_chord);
    dmb_se3_tangent_apply_transpose(&frame->T[0], at_chord, stress);
    for (int i = 0; i < 6; i++) stress[i] *= shape->x;
    dmb_se3_tangent_apply_transpose(&frame->T[1], w, part);
    dmb_section_shape_transpose(shape, part, stress);
    dmb_section_pull(frame->R[0], frame->x[0], at_chord, f);
    dmb_se3_tangent_apply_reverse_transpose(&frame->S, stress, part);
    for (int i = 0; i < 6; i++) f[i] -= part[i];
    dmb_se3_tangent_apply_transpose(&frame->S, stress, f + 6);
    dmb_arm_wrench(arm[0], f);
    dmb_arm_wrench(-arm[1], f + 6);
}

/* ---- Changes with d (eq:motion.section-change) --------------------------------------------------------------------
 */

/* Columns d_y and d_z of c(x): along[j], shape (6). */
static inline void dmb_section_bending(const dmb_section_shape *shape, dmb_real along[2][6])
{
    for (int i = 0; i < 6; i++) along[0][i] = along[1][i] = dmb_real_of(0.0);
    along[0][1] = shape->move[0];
    along[0][5] = shape->turn[0];
    along[1][2] = shape->move[1];
    along[1][4] = -shape->turn[1];
}

/* Change of Ad^-T(exp h) w as exp h moves by its own twist y, before Ad^-T: (O x f; O x m + U x f), y = (U; O), w = (f;
 * m) */
static inline void dmb_section_turn_wrench(const dmb_real w[6], const dmb_real y[6], dmb_real out[6])
{
    dmb_real moved[3];
    dmb_vec3_cross(y + 3, w, out);
    dmb_vec3_cross(y + 3, w + 3, out + 3);
    dmb_vec3_cross(y, w, moved);
    dmb_vec3_add(out + 3, moved, out + 3);
}

/* out = [0, J; J, H] y */
static inline void dmb_section_stress_apply(const dmb_se3_stress_blocks *D, const dmb_real y[6], dmb_real out[6])
{
    dmb_real turned[3];
    dmb_mat3_vec(D->J, y + 3, out);
    dmb_mat3_vec(D->J, y, out + 3);
    dmb_mat3_vec(D->H, y + 3, turned);
    dmb_vec3_add(out + 3, turned, out + 3);
}

static inline void dmb_section_column(const dmb_real M[36], int column, dmb_real out[6])
{
    for (int i = 0; i < 6; i++) out[i] = M[6 * i + column];
}

static inline void dmb_section_add_column(const dmb_real x[6], int column, dmb_real M[36])
{
    for (int i = 0; i < 6; i++) M[6 * i + column] += x[i];
}

/* s = x T1^T a + c^T T2^T w with a = Ad^-T(exp c) w, the dual vector of d; its change ds, shape (6, 6), and the two
 * columns da that a has. */
typedef struct dmb_section_stress {
    dmb_real a[6], s[6], ds[36], da[2][6];
} dmb_section_stress;

/* The part by the correction c(x) d, of the columns d_y and d_z. */
static inline void dmb_section_stress_bent(const dmb_section_shape *shape, const dmb_section_frame *frame,
                                           const dmb_real d[6], const dmb_real w[6], dmb_section_stress *out)
{
    dmb_real along[2][6], c[6], part[6], moved[6];
    dmb_se3_stress_blocks Z;
    dmb_section_bending(shape, along);
    dmb_section_shape_correct(shape, d, c);
    dmb_se3_tangent_apply_transpose(&frame->T[1], w, part);
    dmb_section_shape_transpose(shape, part, out->s);
    dmb_se3_stress_blocks_at(c, part, NULL, &Z, NULL);
    for (int j = 0; j < 2; j++) {
        dmb_real by[6] = {dmb_real_of(0.0), dmb_real_of(0.0), dmb_real_of(0.0),
                          dmb_real_of(0.0), dmb_real_of(0.0), dmb_real_of(0.0)};
        dmb_se3_tangent_apply(&frame->T[1], along[j], moved);
        dmb_section_turn_wrench(w, moved, part);
        dmb_section_pull(frame->R[1], frame->x[1], part, out->da[j]);
        dmb_se3_tangent_apply_transpose(&frame->T[0], out->da[j], part);
        for (int i = 0; i < 6; i++) by[i] = shape->x * part[i];
        dmb_section_stress_apply(&Z, along[j], part);
        dmb_se3_tangent_apply_transpose(&frame->T[1], part, moved);
        for (int i = 0; i < 6; i++) moved[i] = -moved[i];
        dmb_section_shape_transpose(shape, moved, by);
        dmb_section_add_column(by, 1 + j, out->ds);
    }
}

/* ds = -x^2 T1^T Z(x d, T1^T a): from T1^T d(T1^-T) T1^T */
static inline void dmb_section_stress_at(const dmb_section_shape *shape, const dmb_section_frame *frame,
                                         const dmb_real d[6], const dmb_real w[6], dmb_section_stress *out)
{
    dmb_real h[6], part[6], block[9], turned[9];
    dmb_se3_stress_blocks Z;
    const dmb_real minus = -(shape->x * shape->x);
    for (int i = 0; i < 6; i++) h[i] = shape->x * d[i];
    dmb_section_pull(frame->R[1], frame->x[1], w, out->a);
    dmb_se3_tangent_apply_transpose(&frame->T[0], out->a, part);
    for (int i = 0; i < 6; i++) out->s[i] = shape->x * part[i];
    dmb_se3_stress_blocks_at(h, part, NULL, &Z, NULL);
    dmb_mat6_zero(out->ds);
    dmb_mat3_mul_tn(frame->T[0].S, Z.J, block);
    dmb_mat6_add_block(minus, block, 0, 1, out->ds);
    dmb_mat6_add_block(minus, block, 1, 0, out->ds);
    dmb_mat3_mul_tn(frame->T[0].B, Z.J, block);
    dmb_mat3_mul_tn(frame->T[0].S, Z.H, turned);
    dmb_mat3_add(block, turned, block);
    dmb_mat6_add_block(minus, block, 1, 1, out->ds);
    dmb_section_stress_bent(shape, frame, d, w, out);
}

/* Change of map^T w on node a and on node b, each shape (6, 6), with d at constant w. */
static inline void dmb_section_force_change(const dmb_real arm[2], const dmb_section_shape *shape,
                                            const dmb_section_frame *frame, const dmb_real d[6], const dmb_real w[6],
                                            dmb_real Fa[36], dmb_real Fb[36])
{
    dmb_section_stress stress;
    dmb_se3_stress_blocks plus, minus;
    dmb_section_stress_at(shape, frame, d, w, &stress);
    dmb_se3_stress_blocks_at(d, stress.s, NULL, &plus, &minus);
    for (int k = 0; k < 6; k++) {
        dmb_real unit[6], ds[6], x[6], turned[6], f[6];
        for (int i = 0; i < 6; i++) unit[i] = dmb_real_of(i == k ? 1.0 : 0.0);
        dmb_section_column(stress.ds, k, ds);
        dmb_se3_tangent_apply_transpose(&frame->S, ds, f);
        dmb_section_stress_apply(&plus, unit, x);
        for (int i = 0; i < 6; i++) f[i] += x[i];
        dmb_arm_wrench(-arm[1], f);
        for (int i = 0; i < 6; i++) Fb[6 * i + k] = f[i];
        dmb_se3_tangent_apply(&frame->T[0], unit, x); /* the twist of exp(x d), over x */
        dmb_section_turn_wrench(stress.a, x, turned);
        for (int i = 0; i < 6; i++) turned[i] = shape->x * turned[i];
        for (int i = 0; i < 6 && (k == 1 || k == 2); i++) turned[i] += stress.da[k - 1][i];
        dmb_section_pull(frame->R[0], frame->x[0], turned, f);
        dmb_se3_tangent_apply_reverse_transpose(&frame->S, ds, turned);
        dmb_section_stress_apply(&minus, unit, x);
        for (int i = 0; i < 6; i++) f[i] += x[i] - turned[i];
        dmb_arm_wrench(arm[0], f);
        for (int i = 0; i < 6; i++) Fa[6 * i + k] = f[i];
    }
}

/* Velocities on the way from the nodes to the section. */
typedef struct dmb_section_motion {
    dmb_real near[6], far[6], rate[6]; /* of the ends, d' */
    dmb_real carried[6], own[6];       /* behind exp(x d): of end A there, and T1 x d' */
} dmb_section_motion;

static inline void dmb_section_motion_at(const dmb_real arm[2], const dmb_section_shape *shape,
                                         const dmb_section_frame *frame, const dmb_real v[12], dmb_section_motion *m)
{
    dmb_real part[6];
    dmb_vec6_copy(v, m->near);
    dmb_vec6_copy(v + 6, m->far);
    dmb_arm_velocity(arm[0], m->near);
    dmb_arm_velocity(-arm[1], m->far);
    dmb_se3_tangent_apply(&frame->S, m->far, m->rate);
    dmb_se3_tangent_apply_reverse(&frame->S, m->near, part);
    for (int i = 0; i < 6; i++) m->rate[i] -= part[i];
    for (int i = 0; i < 6; i++) part[i] = shape->x * m->rate[i];
    dmb_se3_tangent_apply(&frame->T[0], part, m->own);
    dmb_adjoint_inverse_apply(frame->R[0], frame->x[0], m->near, m->carried);
}

/* Change of d', X(d, v_B) + X(-d, v_A). */
static inline void dmb_section_rate_change(const dmb_real d[6], const dmb_section_motion *m, dmb_se3_tangent *X)
{
    dmb_se3_tangent near;
    dmb_real back[6];
    for (int i = 0; i < 6; i++) back[i] = -d[i];
    dmb_se3_velocity_derivative_at(d, m->far, NULL, X);
    dmb_se3_velocity_derivative_at(back, m->near, NULL, &near);
    dmb_mat3_add(X->S, near.S, X->S);
    dmb_mat3_add(X->B, near.B, X->B);
}

/* Change of the velocity behind exp(x d): x (ad(Ad^-1 v_A) T1 + T1 (X - X(x d, T1 x d'))), moved on by Ad^-1 of
 * exp(c(x) d). */
static inline void dmb_section_chord_change(const dmb_section_shape *shape, const dmb_section_frame *frame,
                                            const dmb_real d[6], const dmb_section_motion *m, const dmb_se3_tangent *X,
                                            dmb_se3_tangent *out)
{
    dmb_se3_tangent ad, Y, V;
    dmb_real h[6], block[9], moved[9];
    for (int i = 0; i < 6; i++) h[i] = shape->x * d[i];
    dmb_skew(m->carried + 3, ad.S);
    dmb_skew(m->carried, ad.B);
    dmb_se3_velocity_derivative_at(h, m->own, NULL, &Y);
    for (int i = 0; i < 9; i++) {
        Y.S[i] = X->S[i] - Y.S[i];
        Y.B[i] = X->B[i] - Y.B[i];
        V.S[i] = V.B[i] = dmb_real_of(0.0);
    }
    dmb_se3_add_tangent_product(shape->x, &ad, &frame->T[0], &V);
    dmb_se3_add_tangent_product(shape->x, &frame->T[0], &Y, &V);
    dmb_skew(frame->x[1], block);
    dmb_mat3_mul(block, V.S, moved);
    for (int i = 0; i < 9; i++) moved[i] = V.B[i] - moved[i];
    dmb_mat3_mul_tn(frame->R[1], V.S, out->S);
    dmb_mat3_mul_tn(frame->R[1], moved, out->B);
}

/* The part by the correction c(x) d: T2 c(x) X, and in the columns d_y and d_z ad(V_1) T2 - T2 X(c d, T2 c d'). */
static inline void dmb_section_bent_change(const dmb_section_shape *shape, const dmb_section_frame *frame,
                                           const dmb_real d[6], const dmb_section_motion *m, const dmb_se3_tangent *X,
                                           dmb_real W[36])
{
    dmb_real along[2][6], c[6], part[6], before[6], twist[6], turned[6];
    dmb_se3_tangent Xc;
    dmb_section_bending(shape, along);
    dmb_section_shape_correct(shape, d, c);
    dmb_section_shape_correct(shape, m->rate, part);
    dmb_se3_tangent_apply(&frame->T[1], part, part);
    dmb_se3_velocity_derivative_at(c, part, NULL, &Xc);
    for (int i = 0; i < 6; i++) before[i] = m->carried[i] + m->own[i];
    dmb_adjoint_inverse_apply(frame->R[1], frame->x[1], before, before);
    for (int j = 0; j < 2; j++) {
        dmb_real row[6];
        dmb_vec3_copy(X->S + 3 * (1 + j), row);
        dmb_vec3_copy(X->B + 3 * (1 + j), row + 3);
        dmb_se3_tangent_apply(&frame->T[1], along[j], twist);
        dmb_mat6_add_outer(dmb_real_of(1.0), twist, row, W);
        dmb_se3_tangent_apply(&Xc, along[j], turned);
        dmb_se3_tangent_apply(&frame->T[1], turned, turned);
        dmb_ad_apply(before, twist, part);
        for (int i = 0; i < 6; i++) part[i] -= turned[i];
        dmb_section_add_column(part, 1 + j, W);
    }
}

/* Change of V = map v with d at constant v, shape (6, 6). */
static inline void dmb_section_twist_change(const dmb_real arm[2], const dmb_section_shape *shape,
                                            const dmb_section_frame *frame, const dmb_real d[6], const dmb_real v[12],
                                            dmb_real W[36])
{
    dmb_section_motion m;
    dmb_se3_tangent X, V;
    dmb_section_motion_at(arm, shape, frame, v, &m);
    dmb_section_rate_change(d, &m, &X);
    dmb_section_chord_change(shape, frame, d, &m, &X, &V);
    dmb_se3_tangent_matrix(&V, W);
    dmb_section_bent_change(shape, frame, d, &m, &X, W);
}

#endif
