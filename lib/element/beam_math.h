/* The mathematics of the flexible element, in a number that is a double or lanes of doubles (math/real.h).
 *
 * Relative nodal coordinates: d = log(H_A^-1 H_B), strain (d - d0)/L, diagonal stiffness (Sonneville, Cardona, Bruls
 * 2014). Blind to rigid motion and to the number of revolutions. */
#ifndef DMB_ELEMENT_BEAM_MATH_H
#define DMB_ELEMENT_BEAM_MATH_H

#include "element/element_type.h"
#include "math/se3.h"

/* [rad] above this relative rotation in one element the logarithm is refused, well below its branch at pi. */
#define DMB_BEAM_ROTATION_MAX 2.5

/* The constants of element_type.h that a step needs, as numbers of this file's kind. */
typedef struct dmb_beam_constants {
    dmb_real stiffness[6], rest[6]; /* [N/m, N m/rad], [m, rad] */
    dmb_real arm[2];                /* [m] */
    dmb_real damping_time;          /* [s] */
    dmb_real axial[2], torsion[2], bending[2][6]; /* [kg], [kg m2], mixed: dmb_beam_mass */
} dmb_beam_constants;

/* Relative pose of the two ends and the operator that goes with it. */
typedef struct dmb_beam_shape {
    dmb_real d[6];                    /* [m, rad] log(H_A^-1 H_B) */
    dmb_so3_inverse_coefficients k;   /* of d's rotation */
    dmb_se3_inverse_tangent T;        /* T6(d)^-1; its reverse is T6(-d)^-1 */
} dmb_beam_shape;

/* Tangent blocks of an element, rows (A, B) by columns (A, B), each shape (6, 6). */
typedef struct dmb_beam_blocks {
    dmb_real aa[36], ab[36], ba[36], bb[36];
} dmb_beam_blocks;

/* Puts the constants of a type into one lane. */
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
    for (int i = 0; i < 2; i++) dmb_real_set_lane(&c->arm[i], lane, type->arm[i]);
    dmb_beam_load_mass(&type->mass, lane, c);
    dmb_real_set_lane(&c->damping_time, lane, type->damping_time);
}

/* ---- Shape and forces -------------------------------------------------------------------------------------------- */

/* Shape from the nodes' orientations, node A's rotation matrix, the vector from node A to node B [m], world frame. */
static inline void dmb_beam_shape_at(const dmb_beam_constants *c, int arms, const dmb_real quaternion_a[4],
                                     const dmb_real rotation_a[9], const dmb_real quaternion_b[4],
                                     const dmb_real span[3], dmb_beam_shape *shape)
{
    dmb_real q[4], x[3];
    dmb_quat_between(quaternion_a, quaternion_b, q);
    dmb_mat3_tvec(rotation_a, span, x);
    if (arms) { /* H_A moved by arm[0], H_B by -arm[1] along their own x */
        dmb_real arm[3] = {-c->arm[1], dmb_real_of(0.0), dmb_real_of(0.0)};
        dmb_quat_rotate(q, arm, arm);
        dmb_vec3_add(x, arm, x);
        x[0] -= c->arm[0];
    }
    dmb_se3_log_from_quat(q, x, &shape->k, shape->d);
    dmb_se3_inverse_tangent_at(shape->d, &shape->k, &shape->T);
}

/* 1 where the relative rotation is within DMB_BEAM_ROTATION_MAX in every lane; not so for a NaN. */
static inline int dmb_beam_rotation_holds(const dmb_beam_shape *shape)
{
    return dmb_real_below(dmb_vec3_norm_squared(shape->d + 3),
                          dmb_real_of(DMB_BEAM_ROTATION_MAX * DMB_BEAM_ROTATION_MAX));
}

/* Velocity of an element's end from that of its node, arm [m] along x from the node to the end; in place. */
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

/* d' = P V [m/s, rad/s] from the velocities of the element's ends, P = [-T6(-d)^-1, T6(d)^-1]. */
static inline void dmb_beam_strain_rate(const dmb_beam_shape *shape, const dmb_real velocity_a[6],
                                        const dmb_real velocity_b[6], dmb_real rate[6])
{
    dmb_real a[6];
    dmb_se3_tangent_apply_reverse(&shape->T, velocity_a, a);
    dmb_se3_tangent_apply(&shape->T, velocity_b, rate);
    for (int i = 0; i < 6; i++) rate[i] -= a[i];
}

/* Elastic stress K (d - d0)/L [N, N m]. */
static inline void dmb_beam_elastic_stress(const dmb_beam_constants *c, const dmb_real d[6], dmb_real stress[6])
{
    for (int i = 0; i < 6; i++) stress[i] = c->stiffness[i] * (d[i] - c->rest[i]);
}

/* Internal forces g = P^T s on the element's ends (residual side), added to force_a and force_b. */
static inline void dmb_beam_add_force(const dmb_beam_shape *shape, const dmb_real stress[6], dmb_real force_a[6],
                                      dmb_real force_b[6])
{
    dmb_real a[6], b[6];
    dmb_se3_tangent_apply_reverse_transpose(&shape->T, stress, a);
    dmb_se3_tangent_apply_transpose(&shape->T, stress, b);
    for (int i = 0; i < 6; i++) {
        force_a[i] -= a[i];
        force_b[i] += b[i];
    }
}

/* ---- Stiffness and damping --------------------------------------------------------------------------------------- */

/* Material part P^T (K/L) P, T6(-d)^-1 = R: [R^T k R, -R^T k T; -T^T k R, T^T k T] */
static inline void dmb_beam_material_stiffness(const dmb_real k[6], const dmb_se3_tangent *T, const dmb_se3_tangent *R,
                               dmb_beam_blocks *out)
{
    dmb_se3_tangent_congruence(R, k, R, out->aa);
    dmb_se3_tangent_congruence(T, k, T, out->bb);
    dmb_se3_tangent_congruence(R, k, T, out->ab);
    for (int i = 0; i < 36; i++) out->ab[i] = -out->ab[i];
    dmb_mat6_transpose(out->ab, out->ba);
}

/* Geometric part [D1(-d, s); D1(d, s)] P */
static inline void dmb_beam_add_geometric_stiffness(const dmb_beam_shape *shape, const dmb_real stress[6],
                                                    const dmb_se3_tangent *R, dmb_beam_blocks *out)
{
    dmb_se3_stress_blocks plus, minus;
    dmb_se3_stress_blocks_at(shape->d, stress, &shape->k, &plus, &minus);
    dmb_se3_stress_times_tangent(dmb_real_of(-1.0), &minus, R, out->aa);
    dmb_se3_stress_times_tangent(dmb_real_of(1.0), &minus, &shape->T, out->ab);
    dmb_se3_stress_times_tangent(dmb_real_of(-1.0), &plus, R, out->ba);
    dmb_se3_stress_times_tangent(dmb_real_of(1.0), &plus, &shape->T, out->bb);
}

/* d g/d pose (body-frame increments of both ends) = P^T (K/L) P + geometric part with `stress`; written to blocks. */
static inline void dmb_beam_stiffness_blocks(const dmb_beam_constants *c, const dmb_beam_shape *shape,
                                             const dmb_real stress[6], dmb_beam_blocks *blocks)
{
    dmb_se3_tangent R;
    dmb_se3_tangent_reverse(&shape->T, &R);
    dmb_beam_material_stiffness(c->stiffness, &shape->T, &R, blocks);
    dmb_beam_add_geometric_stiffness(shape, stress, &R, blocks);
}

/* The same with damping, which takes part in the stiffness too: s gains tau K d'/L with d' = P V. Its derivative by V is
 * tau P^T (K/L) P, written to `damping` times `factor`; by the pose it is tau P^T (K/L) X P with X = d(d')/dd =
 * X(d, V_B) + X(-d, V_A), both of THEORY 3's operators. So the material part becomes P^T (K/L) (1 + tau X) P. */
static inline void dmb_beam_damped_blocks(const dmb_beam_constants *c, const dmb_beam_shape *shape,
                                          const dmb_real stress[6], const dmb_real velocity_a[6],
                                          const dmb_real velocity_b[6], dmb_real factor, dmb_beam_blocks *stiffness,
                                          dmb_beam_blocks *damping)
{
    dmb_real k[6], back[6];
    dmb_se3_tangent R, X, Xa, YT = shape->T, YR;
    for (int i = 0; i < 6; i++) {
        k[i] = factor * c->damping_time * c->stiffness[i];
        back[i] = -shape->d[i];
    }
    dmb_se3_tangent_reverse(&shape->T, &R);
    dmb_beam_material_stiffness(k, &shape->T, &R, damping);
    dmb_se3_velocity_derivative_at(shape->d, velocity_b, &shape->k, &X);
    dmb_se3_velocity_derivative_at(back, velocity_a, &shape->k, &Xa);
    dmb_mat3_add(X.S, Xa.S, X.S);
    dmb_mat3_add(X.B, Xa.B, X.B);
    YR = R;
    dmb_se3_add_tangent_product(c->damping_time, &X, &shape->T, &YT);
    dmb_se3_add_tangent_product(c->damping_time, &X, &R, &YR);
    dmb_se3_tangent_congruence(&R, c->stiffness, &YR, stiffness->aa);
    dmb_se3_tangent_congruence(&R, c->stiffness, &YT, stiffness->ab);
    dmb_se3_tangent_congruence(&shape->T, c->stiffness, &YR, stiffness->ba);
    dmb_se3_tangent_congruence(&shape->T, c->stiffness, &YT, stiffness->bb);
    for (int i = 0; i < 36; i++) {
        stiffness->ab[i] = -stiffness->ab[i];
        stiffness->ba[i] = -stiffness->ba[i];
    }
    dmb_beam_add_geometric_stiffness(shape, stress, &R, stiffness);
}

/* ---- Inertia ----------------------------------------------------------------------------------------------------- */

/* One bending plane: u and t of both ends; the second plane enters with t = -theta_y. */
static inline void dmb_beam_bending_times(const dmb_real m[6], dmb_real ua, dmb_real ta, dmb_real ub, dmb_real tb,
                                          dmb_real out[4])
{
    out[0] = m[0] * ua + m[1] * ta + m[2] * ub + m[3] * tb;
    out[1] = m[1] * ua + m[4] * ta - m[3] * ub + m[5] * tb;
    out[2] = m[2] * ua - m[3] * ta + m[0] * ub - m[1] * tb;
    out[3] = m[3] * ua + m[5] * ta - m[1] * ub + m[4] * tb;
}

/* Momentum p = M v of both ends [kg m/s, kg m2/s]; the same product gives M times accelerations. */
static inline void dmb_beam_momentum(const dmb_beam_constants *mass, const dmb_real va[6], const dmb_real vb[6],
                                     dmb_real pa[6], dmb_real pb[6])
{
    dmb_real y[4], z[4];
    dmb_beam_bending_times(mass->bending[0], va[1], va[5], vb[1], vb[5], y);
    dmb_beam_bending_times(mass->bending[1], va[2], -va[4], vb[2], -vb[4], z);
    pa[0] = mass->axial[0] * va[0] + mass->axial[1] * vb[0];
    pb[0] = mass->axial[1] * va[0] + mass->axial[0] * vb[0];
    pa[3] = mass->torsion[0] * va[3] + mass->torsion[1] * vb[3];
    pb[3] = mass->torsion[1] * va[3] + mass->torsion[0] * vb[3];
    pa[1] = y[0], pa[5] = y[1], pb[1] = y[2], pb[5] = y[3];
    pa[2] = z[0], pa[4] = -z[1], pb[2] = z[2], pb[4] = -z[3];
}

/* The ten numbers of one 6x6 block of M: axial, torsion and per plane uu, ut, tu, tt. */
typedef struct dmb_beam_mass_block {
    dmb_real axial, torsion, uu[2], ut[2], tu[2], tt[2];
} dmb_beam_mass_block;

static inline void dmb_beam_block_aa(const dmb_beam_constants *m, double side, dmb_beam_mass_block *out)
{
    out->axial = m->axial[0];
    out->torsion = m->torsion[0];
    for (int p = 0; p < 2; p++) {
        out->uu[p] = m->bending[p][0];
        out->ut[p] = out->tu[p] = dmb_real_of(side) * m->bending[p][1];
        out->tt[p] = m->bending[p][4];
    }
}

static inline void dmb_beam_block_ab(const dmb_beam_constants *m, double side, dmb_beam_mass_block *out)
{
    out->axial = m->axial[1];
    out->torsion = m->torsion[1];
    for (int p = 0; p < 2; p++) {
        out->uu[p] = m->bending[p][2];
        out->ut[p] = dmb_real_of(side) * m->bending[p][3];
        out->tu[p] = -out->ut[p];
        out->tt[p] = m->bending[p][5];
    }
}

/* out += L M_block; M_block has entries (0,0) (3,3), (1,1) (1,5) (5,1) (5,5), (2,2) (2,4) (4,2) (4,4) */
static inline void dmb_beam_add_times_block(const dmb_real L[36], const dmb_beam_mass_block *m, dmb_real out[36])
{
    for (int i = 0; i < 36; i += 6) {
        out[i] += L[i] * m->axial;
        out[i + 1] += L[i + 1] * m->uu[0] + L[i + 5] * m->tu[0];
        out[i + 2] += L[i + 2] * m->uu[1] - L[i + 4] * m->tu[1];
        out[i + 3] += L[i + 3] * m->torsion;
        out[i + 4] += L[i + 4] * m->tt[1] - L[i + 2] * m->ut[1];
        out[i + 5] += L[i + 1] * m->ut[0] + L[i + 5] * m->tt[0];
    }
}

/* L = mass_factor I - velocity_factor v^^T */
static inline void dmb_beam_inertia_rows(const dmb_real v[6], dmb_real mass_factor, dmb_real velocity_factor,
                                         dmb_real L[36])
{
    dmb_mat6_zero(L);
    dmb_mat6_add_skew(velocity_factor, v + 3, 0, 0, L);
    dmb_mat6_add_skew(velocity_factor, v + 3, 1, 1, L);
    dmb_mat6_add_skew(velocity_factor, v, 1, 0, L);
    for (int i = 0; i < 36; i += 7) L[i] += mass_factor;
}

/* out -= factor A(p), A(p) = [0, pu~; pu~, pw~] */
static inline void dmb_beam_subtract_momentum(const dmb_real p[6], dmb_real factor, dmb_real out[36])
{
    dmb_mat6_add_skew(-factor, p, 0, 1, out);
    dmb_mat6_add_skew(-factor, p, 1, 0, out);
    dmb_mat6_add_skew(-factor, p + 3, 1, 1, out);
}

/* Adds mass_factor M + velocity_factor C_t to blocks, C_t = -blkdiag(v^^T) M - blkdiag(A(p)) (gyroscopic). */
static inline void dmb_beam_add_inertia_blocks(const dmb_beam_constants *mass, const dmb_real va[6],
                                               const dmb_real vb[6], const dmb_real pa[6], const dmb_real pb[6],
                                               dmb_real mass_factor, dmb_real velocity_factor, dmb_beam_blocks *blocks)
{
    dmb_real L[36];
    dmb_beam_mass_block m;
    dmb_beam_inertia_rows(va, mass_factor, velocity_factor, L);
    dmb_beam_block_aa(mass, 1.0, &m);
    dmb_beam_add_times_block(L, &m, blocks->aa);
    dmb_beam_block_ab(mass, 1.0, &m);
    dmb_beam_add_times_block(L, &m, blocks->ab);
    dmb_beam_subtract_momentum(pa, velocity_factor, blocks->aa);
    dmb_beam_inertia_rows(vb, mass_factor, velocity_factor, L);
    dmb_beam_block_aa(mass, -1.0, &m);
    dmb_beam_add_times_block(L, &m, blocks->bb);
    dmb_beam_block_ab(mass, -1.0, &m);
    dmb_beam_add_times_block(L, &m, blocks->ba);
    dmb_beam_subtract_momentum(pb, velocity_factor, blocks->bb);
}

/* One tangent block from ends to nodes: rows by the arm `left`, columns by the arm `right` [m], node to end along x.
 * K -> rows moved by the transpose of the left arm, columns by the right arm */
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

/* Moves tangent blocks from the element's ends to its nodes, arms [m] along x. */
static inline void dmb_beam_blocks_to_nodes(const dmb_real arm[2], dmb_beam_blocks *blocks)
{
    dmb_beam_block_to_nodes(arm[0], arm[0], blocks->aa);
    dmb_beam_block_to_nodes(arm[0], -arm[1], blocks->ab);
    dmb_beam_block_to_nodes(-arm[1], arm[0], blocks->ba);
    dmb_beam_block_to_nodes(-arm[1], -arm[1], blocks->bb);
}

#endif
