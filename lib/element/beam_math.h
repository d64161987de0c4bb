/* Mathematics of the flexible element, for numbers that are doubles or lanes of doubles (math/real.h).
 *
 * The deformation is the pose of end B relative to end A, d = log(H_A^-1 H_B) (eq:kinematics.relative-pose), which is
 * invariant under rigid motion and whole revolutions. With x = d - d0 the strain times length is (eq:beam.strain)
 *
 *     e_x = x_x + (b_y x_y^2 + b_z x_z^2)/2,   p = O_z x_y - O_y x_z,
 *     e_y = x_y - h_y O_z p,   e_z = x_z + h_z O_y p,   rotations e = O - O0
 *
 * b: bending inside the element does not shorten it (eq:beam.axial-shear), otherwise elements in tension would buckle;
 * h: a curved element is softer laterally (eq:beam.curvature-softening). Forces and tangent: eq:beam.force,
 * eq:beam.tangent. */
#ifndef DMB_ELEMENT_BEAM_MATH_H
#define DMB_ELEMENT_BEAM_MATH_H

#include "element/element_type.h"
#include "math/se3.h"

/* [rad] largest relative rotation in one element; above it the logarithm is rejected, well below its branch at pi. */
#define DMB_BEAM_ROTATION_MAX 2.5

/* Constants of element_type.h that a step requires, as numbers of this file's kind. */
typedef struct dmb_beam_constants {
    dmb_real stiffness[6], rest[6];               /* [N/m, N m/rad], [m, rad] */
    dmb_real coupling[2], bend[2];                /* [1/m] b, [-] h, of the planes y and z */
    dmb_real arm[2];                              /* [m] */
    dmb_real damping_time;                        /* [s] */
    dmb_real axial[2], torsion[2], bending[2][6]; /* [kg], [kg m2], mixed: dmb_beam_mass */
} dmb_beam_constants;

/* E is the identity except for the translation rows (1, slope; 0, move), of which (y, z) also have the columns (O_y,
 * O_z), turn. */
typedef struct dmb_beam_map {
    dmb_real slope[2], move[4]; /* [-] */
    dmb_real turn[4];           /* [m] */
} dmb_beam_map;

/* Relative pose of the two ends and its operators. */
typedef struct dmb_beam_shape {
    dmb_real d[6];                  /* [m, rad] log(H_A^-1 H_B) */
    dmb_so3_inverse_coefficients k; /* of d's rotation */
    dmb_se3_inverse_tangent T;      /* T6(d)^-1; its reverse is T6(-d)^-1 */
    dmb_beam_map E;
} dmb_beam_shape;

/* Tangent blocks of an element, rows (A, B) by columns (A, B), each shape (6, 6). */
typedef struct dmb_beam_blocks {
    dmb_real aa[36], ab[36], ba[36], bb[36];
} dmb_beam_blocks;

/* Copies the mass constants of a type into one lane. */
static inline void dmb_beam_load_mass(const dmb_beam_mass *mass, int lane, dmb_beam_constants *c)
{
    for (int i = 0; i < 6; i++) {
        dmb_real_set_lane(&c->bending[0][i], lane, mass->bending[0][i]);
        dmb_real_set_lane(&c->bending[1][i], lane, mass->bending[1][i]);
    }
    for (int i = 0; i < 2; i++) {
        dmb_real_set_lane(&c->axial[i], lane, mass->axial[i]);
        dmb_real_set_lane(&c->torsion[i], lane, mass->torsion[i]);
    }
}

static inline void dmb_beam_load_constants(const dmb_element_type *type, int lane, dmb_beam_constants *c)
{
    for (int i = 0; i < 6; i++) {
        dmb_real_set_lane(&c->stiffness[i], lane, type->stiffness[i]);
        dmb_real_set_lane(&c->rest[i], lane, type->rest[i]);
    }
    for (int i = 0; i < 2; i++) {
        dmb_real_set_lane(&c->coupling[i], lane, type->coupling[i]);
        dmb_real_set_lane(&c->bend[i], lane, type->bend[i]);
        dmb_real_set_lane(&c->arm[i], lane, type->arm[i]);
    }
    dmb_beam_load_mass(dmb_element_constant_mass(type), lane, c);
    dmb_real_set_lane(&c->damping_time, lane, type->damping_time);
}

/* ---- Shape and forces -------------------------------------------------------------------------------------------- */

/* Computes E for the element's d. */
static inline void dmb_beam_map_at(const dmb_beam_constants *c, const dmb_real d[6], dmb_beam_map *E)
{
    const dmb_real y = d[1] - c->rest[1], z = d[2] - c->rest[2], p = d[5] * y - d[4] * z;
    const dmb_real hy = c->bend[0] * d[5], hz = c->bend[1] * d[4];
    E->slope[0] = c->coupling[0] * y;
    E->slope[1] = c->coupling[1] * z;
    E->move[0] = 1.0 - hy * d[5];
    E->move[1] = hy * d[4];
    E->move[2] = hz * d[5];
    E->move[3] = 1.0 - hz * d[4];
    E->turn[0] = hy * z;
    E->turn[1] = -(c->bend[0] * p + hy * y);
    E->turn[2] = c->bend[1] * p - hz * z;
    E->turn[3] = hz * y;
}

/* Computes the rate of E for the rate of d. */
static inline void dmb_beam_map_rate(const dmb_beam_constants *c, const dmb_real d[6], const dmb_real rate[6],
                                     dmb_beam_map *E)
{
    const dmb_real y = d[1] - c->rest[1], z = d[2] - c->rest[2], dy = rate[1], dz = rate[2];
    const dmb_real p = rate[5] * y + d[5] * dy - rate[4] * z - d[4] * dz, cross = rate[5] * d[4] + d[5] * rate[4];
    E->slope[0] = c->coupling[0] * dy;
    E->slope[1] = c->coupling[1] * dz;
    E->move[0] = -2.0 * c->bend[0] * d[5] * rate[5];
    E->move[1] = c->bend[0] * cross;
    E->move[2] = c->bend[1] * cross;
    E->move[3] = -2.0 * c->bend[1] * d[4] * rate[4];
    E->turn[0] = c->bend[0] * (rate[5] * z + d[5] * dz);
    E->turn[1] = -(c->bend[0] * (p + rate[5] * y + d[5] * dy));
    E->turn[2] = c->bend[1] * (p - rate[4] * z - d[4] * dz);
    E->turn[3] = c->bend[1] * (rate[4] * y + d[4] * dy);
}

/* Computes the operators of a shape whose d and k are set. */
DMB_REAL_INLINE void dmb_beam_operators_at(const dmb_beam_constants *c, dmb_beam_shape *shape)
{
    dmb_se3_inverse_tangent_at(shape->d, &shape->k, &shape->T);
    dmb_beam_map_at(c, shape->d, &shape->E);
}

/* Computes the shape from the orientations of the nodes, node A's rotation matrix, and the vector from node A to node B
 * [m], world frame. */
DMB_REAL_INLINE void dmb_beam_shape_at(const dmb_beam_constants *c, int arms, const dmb_real quaternion_a[4],
                                       const dmb_real rotation_a[9], const dmb_real quaternion_b[4],
                                       const dmb_real span[3], dmb_beam_shape *shape)
{
    dmb_real q[4], x[3];
    dmb_quat_between(quaternion_a, quaternion_b, q);
    dmb_mat3_tvec(rotation_a, span, x);
    if (arms) { /* H_A displaced by arm[0], H_B by -arm[1] along their own x */
        dmb_real arm[3] = {-c->arm[1], dmb_real_of(0.0), dmb_real_of(0.0)};
        dmb_quat_rotate(q, arm, arm);
        dmb_vec3_add(x, arm, x);
        x[0] -= c->arm[0];
    }
    dmb_se3_log_from_quat(q, x, &shape->k, shape->d);
    dmb_beam_operators_at(c, shape);
}

/* 1 if the relative rotation is within DMB_BEAM_ROTATION_MAX in every lane; 0 for NaN. */
static inline int dmb_beam_rotation_holds(const dmb_beam_shape *shape)
{
    return dmb_real_below(dmb_vec3_norm_squared(shape->d + 3),
                          dmb_real_of(DMB_BEAM_ROTATION_MAX * DMB_BEAM_ROTATION_MAX));
}

/* Velocity of an element's end from that of its node, arm [m] along x from the node to the end (eq:kinematics.arm); in
 * place. */
static inline void dmb_arm_velocity(dmb_real arm, dmb_real v[6])
{
    v[1] += arm * v[5];
    v[2] -= arm * v[4];
}
/* Wrench on the node from that on the element's end; the transpose of the above. */
static inline void dmb_arm_wrench(dmb_real arm, dmb_real f[6])
{
    f[4] -= arm * f[2];
    f[5] += arm * f[1];
}

/* d' = P V [m/s, rad/s] from the velocities of the element's ends (eq:beam.strain-rate). */
DMB_REAL_INLINE void dmb_beam_shape_rate(const dmb_beam_shape *shape, const dmb_real velocity_a[6],
                                         const dmb_real velocity_b[6], dmb_real rate[6])
{
    dmb_se3_inverse_tangents_apply(shape->d, &shape->k, velocity_a, velocity_b, rate);
}

/* e' = E P V [m/s, rad/s] */
DMB_REAL_INLINE void dmb_beam_strain_rate(const dmb_beam_shape *shape, const dmb_real velocity_a[6],
                                          const dmb_real velocity_b[6], dmb_real rate[6])
{
    const dmb_beam_map *E = &shape->E;
    dmb_beam_shape_rate(shape, velocity_a, velocity_b, rate);
    const dmb_real y = rate[1], z = rate[2];
    rate[0] += E->slope[0] * y + E->slope[1] * z;
    rate[1] = E->move[0] * y + E->move[1] * z + E->turn[0] * rate[4] + E->turn[1] * rate[5];
    rate[2] = E->move[2] * y + E->move[3] * z + E->turn[2] * rate[4] + E->turn[3] * rate[5];
}

/* e [m, rad], strain times length. */
static inline void dmb_beam_strain(const dmb_beam_constants *c, const dmb_beam_shape *shape, dmb_real e[6])
{
    for (int i = 0; i < 6; i++) e[i] = shape->d[i] - c->rest[i];
    const dmb_real *O = shape->d + 3, p = O[2] * e[1] - O[1] * e[2];
    e[0] += 0.5 * (shape->E.slope[0] * e[1] + shape->E.slope[1] * e[2]);
    e[1] -= c->bend[0] * O[2] * p;
    e[2] += c->bend[1] * O[1] * p;
}

/* Elastic stress S = (K/L) e [N, N m]. */
static inline void dmb_beam_elastic_stress(const dmb_beam_constants *c, const dmb_beam_shape *shape, dmb_real stress[6])
{
    dmb_beam_strain(c, shape, stress);
    for (int i = 0; i < 6; i++) stress[i] = c->stiffness[i] * stress[i];
}

/* s = E^T S: stress conjugate to d instead of e. */
static inline void dmb_beam_wrench(const dmb_beam_shape *shape, const dmb_real stress[6], dmb_real s[6])
{
    const dmb_beam_map *E = &shape->E;
    dmb_vec6_copy(stress, s);
    s[1] = E->slope[0] * stress[0] + E->move[0] * stress[1] + E->move[2] * stress[2];
    s[2] = E->slope[1] * stress[0] + E->move[1] * stress[1] + E->move[3] * stress[2];
    s[4] += E->turn[0] * stress[1] + E->turn[2] * stress[2];
    s[5] += E->turn[1] * stress[1] + E->turn[3] * stress[2];
}

/* Adds the internal forces g = P^T E^T S (eq:beam.force) on the element's ends, residual side, to force_a and force_b.
 */
static inline void dmb_beam_add_force(const dmb_beam_shape *shape, const dmb_real stress[6], dmb_real force_a[6],
                                      dmb_real force_b[6])
{
    dmb_real s[6], a[6], b[6];
    dmb_beam_wrench(shape, stress, s);
    dmb_se3_inverse_tangents_transpose(shape->d, &shape->k, s, a, b);
    for (int i = 0; i < 6; i++) {
        force_a[i] -= a[i];
        force_b[i] += b[i];
    }
}

/* ---- Stiffness and damping --------------------------------------------------------------------------------------- */

/* A 6x6 matrix in the coordinates of d: [u, g; g^T, w], where g and w couple (y, z) and (O_y, O_z) only. */
typedef struct dmb_beam_material {
    dmb_real u[9], g[4], torsion, w[4];
} dmb_beam_material;

/* E^T diag(k) E */
static inline void dmb_beam_material_at(const dmb_real k[6], const dmb_beam_map *E, dmb_beam_material *D)
{
    D->u[0] = k[0];
    D->torsion = k[3];
    for (int i = 0; i < 2; i++) {
        D->u[1 + i] = D->u[3 * (1 + i)] = k[0] * E->slope[i];
        for (int j = 0; j < 2; j++) {
            const dmb_real y = k[1] * E->move[i], z = k[2] * E->move[2 + i];
            D->u[3 * (1 + i) + 1 + j] = k[0] * E->slope[i] * E->slope[j] + y * E->move[j] + z * E->move[2 + j];
            D->g[2 * i + j] = y * E->turn[j] + z * E->turn[2 + j];
            D->w[2 * i + j] = k[1] * E->turn[i] * E->turn[j] + k[2] * E->turn[2 + i] * E->turn[2 + j];
        }
        D->w[3 * i] += k[4 + i];
    }
}

/* D += H, of S_x b/2 x^2 and q p with q = h_z S_z O_y - h_y S_y O_z */
static inline void dmb_beam_add_curved_strain(const dmb_beam_constants *c, const dmb_real d[6],
                                              const dmb_real stress[6], dmb_beam_material *D)
{
    const dmb_real y = d[1] - c->rest[1], z = d[2] - c->rest[2];
    const dmb_real Y = c->bend[0] * stress[1], Z = c->bend[1] * stress[2], q = Z * d[4] - Y * d[5];
    D->u[4] += stress[0] * c->coupling[0];
    D->u[8] += stress[0] * c->coupling[1];
    D->g[0] += Z * d[5];
    D->g[1] += q - Y * d[5];
    D->g[2] -= q + Z * d[4];
    D->g[3] += Y * d[4];
    D->w[0] -= 2.0 * Z * z;
    D->w[1] += Z * y + Y * z;
    D->w[2] += Z * y + Y * z;
    D->w[3] -= 2.0 * Y * y;
}

/* Z = D T */
static inline void dmb_beam_material_rows(const dmb_beam_material *D, const dmb_se3_tangent *T, dmb_se3_rows *Z)
{
    dmb_mat3_mul(D->u, T->S, Z->U);
    dmb_mat3_mul(D->u, T->B, Z->V);
    dmb_vec3_scale(D->torsion, T->S, Z->W);
    dmb_vec3_zero(Z->X);
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 3; j++) {
            const int to = 3 * (1 + i) + j;
            const dmb_real *g = D->g, *w = D->w + 2 * i, *S = T->S + 3 + j, *B = T->B + 3 + j;
            Z->V[to] += g[2 * i] * S[0] + g[2 * i + 1] * S[3];
            Z->X[to] = g[i] * S[0] + g[2 + i] * S[3];
            Z->W[to] = (g[i] * B[0] + g[2 + i] * B[3]) + (w[0] * S[0] + w[1] * S[3]);
        }
}

/* P^T D P with a symmetric D, T6(-d)^-1 = R: [R^T D R, -R^T D T; -T^T D R, T^T D T] */
static inline void dmb_beam_material_stiffness(const dmb_beam_material *D, const dmb_se3_tangent *T,
                                               const dmb_se3_tangent *R, dmb_beam_blocks *out)
{
    dmb_se3_rows ahead, back;
    dmb_beam_material_rows(D, T, &ahead);
    dmb_beam_material_rows(D, R, &back);
    dmb_se3_tangent_times_own_rows(R, &back, out->aa);
    dmb_se3_tangent_times_own_rows(T, &ahead, out->bb);
    dmb_se3_tangent_times_rows(R, &ahead, out->ab);
    for (int i = 0; i < 36; i++) out->ab[i] = -out->ab[i];
    dmb_mat6_transpose(out->ab, out->ba);
}

/* [-R, T]^T [-back, ahead] */
static inline void dmb_beam_rows_stiffness(const dmb_se3_tangent *T, const dmb_se3_tangent *R,
                                           const dmb_se3_rows *ahead, const dmb_se3_rows *back, dmb_beam_blocks *out)
{
    dmb_se3_tangent_times_rows(R, back, out->aa);
    dmb_se3_tangent_times_rows(R, ahead, out->ab);
    dmb_se3_tangent_times_rows(T, back, out->ba);
    dmb_se3_tangent_times_rows(T, ahead, out->bb);
    for (int i = 0; i < 36; i++) {
        out->ab[i] = -out->ab[i];
        out->ba[i] = -out->ba[i];
    }
}

/* Geometric part of eq:beam.tangent, s = E^T S */
static inline void dmb_beam_add_geometric_stiffness(const dmb_beam_shape *shape, const dmb_real stress[6],
                                                    const dmb_se3_tangent *R, dmb_beam_blocks *out)
{
    dmb_se3_stress_blocks plus, minus;
    dmb_real s[6];
    dmb_beam_wrench(shape, stress, s);
    dmb_se3_stress_blocks_at(shape->d, s, &shape->k, &plus, &minus);
    dmb_se3_stress_times_tangent(dmb_real_of(-1.0), &minus, R, out->aa);
    dmb_se3_stress_times_tangent(dmb_real_of(1.0), &minus, &shape->T, out->ab);
    dmb_se3_stress_times_tangent(dmb_real_of(-1.0), &plus, R, out->ba);
    dmb_se3_stress_times_tangent(dmb_real_of(1.0), &plus, &shape->T, out->bb);
}

/* d g/d pose (body-frame increments of both ends), with H and s of the geometric part from `stress` (S); overwrites the
 * blocks. */
static inline void dmb_beam_stiffness_blocks(const dmb_beam_constants *c, const dmb_beam_shape *shape,
                                             const dmb_real stress[6], dmb_beam_blocks *blocks)
{
    dmb_se3_tangent R;
    dmb_beam_material D;
    dmb_se3_tangent_reverse(&shape->T, &R);
    dmb_beam_material_at(c->stiffness, &shape->E, &D);
    dmb_beam_add_curved_strain(c, shape->d, stress, &D);
    dmb_beam_material_stiffness(&D, &shape->T, &R, blocks);
    dmb_beam_add_geometric_stiffness(shape, stress, &R, blocks);
}

/* Z += f E^T (K/L) (E X + E') T: change of the damping stress with one end, E' the rate of E. */
static inline void dmb_beam_add_viscous_rows(const dmb_beam_constants *c, const dmb_beam_map *E,
                                             const dmb_beam_map *rate, const dmb_se3_tangent *X,
                                             const dmb_se3_tangent *T, dmb_se3_rows *Z)
{
    const dmb_real f = c->damping_time, *k = c->stiffness;
    dmb_se3_tangent Y;
    for (int i = 0; i < 9; i++) Y.S[i] = Y.B[i] = dmb_real_of(0.0);
    dmb_se3_add_tangent_product(f, X, T, &Y);
    for (int j = 0; j < 3; j++) {
        const dmb_real *YS = Y.S + j, *YB = Y.B + j, *S = T->S + j, *B = T->B + j;
        dmb_real U[3], V[3];
        U[0] = YS[0] + E->slope[0] * YS[3] + E->slope[1] * YS[6] + f * (rate->slope[0] * S[3] + rate->slope[1] * S[6]);
        V[0] = YB[0] + E->slope[0] * YB[3] + E->slope[1] * YB[6] + f * (rate->slope[0] * B[3] + rate->slope[1] * B[6]);
        for (int i = 0; i < 2; i++) {
            const dmb_real *m = E->move + 2 * i, *t = E->turn + 2 * i, *dm = rate->move + 2 * i,
                           *dt = rate->turn + 2 * i;
            U[1 + i] = m[0] * YS[3] + m[1] * YS[6] + f * (dm[0] * S[3] + dm[1] * S[6]);
            V[1 + i] = m[0] * YB[3] + m[1] * YB[6] + t[0] * YS[3] + t[1] * YS[6] +
                       f * (dm[0] * B[3] + dm[1] * B[6] + dt[0] * S[3] + dt[1] * S[6]);
        }
        for (int i = 0; i < 3; i++) {
            U[i] *= k[i];
            V[i] *= k[i];
            Z->W[3 * i + j] += k[3 + i] * YS[3 * i];
        }
        Z->U[j] += U[0];
        Z->V[j] += V[0];
        for (int i = 0; i < 2; i++) {
            const int to = 3 * (1 + i) + j;
            Z->U[to] += E->slope[i] * U[0] + E->move[i] * U[1] + E->move[2 + i] * U[2];
            Z->V[to] += E->slope[i] * V[0] + E->move[i] * V[1] + E->move[2 + i] * V[2];
            Z->X[to] += E->turn[i] * U[1] + E->turn[2 + i] * U[2];
            Z->W[to] += E->turn[i] * V[1] + E->turn[2 + i] * V[2];
        }
    }
}

/* The same with damping, which contributes to the stiffness too: tau (K/L) E d' with d' = P V is added to S. Its
 * derivative by V is tau P^T E^T (K/L) E P, written to `damping` times `factor`; by the pose it is tau P^T E^T (K/L) (E
 * X + E') P with X = d(d')/dd = X(d, V_B) + X(-d, V_A) (eq:beam.damping). */
static inline void dmb_beam_damped_blocks(const dmb_beam_constants *c, const dmb_beam_shape *shape,
                                          const dmb_real stress[6], const dmb_real velocity_a[6],
                                          const dmb_real velocity_b[6], dmb_real factor, dmb_beam_blocks *stiffness,
                                          dmb_beam_blocks *damping)
{
    dmb_real k[6], back[6], rate[6];
    dmb_se3_tangent R, X, Xa;
    dmb_beam_material D;
    dmb_beam_map moving;
    dmb_se3_rows Za, Zb;
    for (int i = 0; i < 6; i++) {
        k[i] = factor * c->damping_time * c->stiffness[i];
        back[i] = -shape->d[i];
    }
    dmb_se3_tangent_reverse(&shape->T, &R);
    dmb_beam_material_at(k, &shape->E, &D);
    dmb_beam_material_stiffness(&D, &shape->T, &R, damping);
    dmb_se3_velocity_derivative_at(shape->d, velocity_b, &shape->k, &X);
    dmb_se3_velocity_derivative_at(back, velocity_a, &shape->k, &Xa);
    dmb_mat3_add(X.S, Xa.S, X.S);
    dmb_mat3_add(X.B, Xa.B, X.B);
    dmb_beam_shape_rate(shape, velocity_a, velocity_b, rate);
    dmb_beam_map_rate(c, shape->d, rate, &moving);
    dmb_beam_material_at(c->stiffness, &shape->E, &D);
    dmb_beam_add_curved_strain(c, shape->d, stress, &D);
    dmb_beam_material_rows(&D, &shape->T, &Zb);
    dmb_beam_material_rows(&D, &R, &Za);
    dmb_beam_add_viscous_rows(c, &shape->E, &moving, &X, &shape->T, &Zb);
    dmb_beam_add_viscous_rows(c, &shape->E, &moving, &X, &R, &Za);
    dmb_beam_rows_stiffness(&shape->T, &R, &Zb, &Za, stiffness);
    dmb_beam_add_geometric_stiffness(shape, stress, &R, stiffness);
}

/* ---- Transfer from ends to nodes --------------------------------------------------------------------------------- */

/* Transfers one tangent block from ends to nodes: rows by the transpose of the arm `left`, columns by the arm `right`
 * [m], node to end along x. */
static inline void dmb_beam_block_to_nodes(dmb_real left, dmb_real right, dmb_real K[36])
{
    for (int i = 0; i < 36; i += 6) { /* columns: v_end = v_node + arm */
        K[i + 4] -= right * K[i + 2];
        K[i + 5] += right * K[i + 1];
    }
    for (int j = 0; j < 6; j++) {
        K[24 + j] -= left * K[12 + j];
        K[30 + j] += left * K[6 + j];
    }
}

/* Transfers tangent blocks from the element's ends to its nodes, arms [m] along x. */
static inline void dmb_beam_blocks_to_nodes(const dmb_real arm[2], dmb_beam_blocks *blocks)
{
    dmb_beam_block_to_nodes(arm[0], arm[0], blocks->aa);
    dmb_beam_block_to_nodes(arm[0], -arm[1], blocks->ab);
    dmb_beam_block_to_nodes(-arm[1], arm[0], blocks->ba);
    dmb_beam_block_to_nodes(-arm[1], -arm[1], blocks->bb);
}

#endif
