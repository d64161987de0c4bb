#include "element/beam.h"

#include <string.h>

int32_t dmb_beam_deform(const dmb_element_type *type, const double quaternion_a[4], const double rotation_a[9],
                        const double quaternion_b[4], const double span[3], dmb_beam_shape *shape)
{
    double q[4], x[3];
    dmb_quat_between(quaternion_a, quaternion_b, q);
    dmb_mat3_tvec(rotation_a, span, x);
    if (type->arm[0] != 0.0 || type->arm[1] != 0.0) { /* H_A moved by arm[0], H_B by -arm[1] along their own x */
        double arm[3] = {-type->arm[1], 0.0, 0.0};
        dmb_quat_rotate(q, arm, arm);
        dmb_vec3_add(x, arm, x);
        x[0] -= type->arm[0];
    }
    dmb_se3_log_from_quat(q, x, &shape->k, shape->d);
    const double angle2 = dmb_vec3_norm_squared(shape->d + 3);
    if (!(angle2 <= DMB_BEAM_ROTATION_MAX * DMB_BEAM_ROTATION_MAX)) return -1;
    dmb_se3_inverse_tangent_at(shape->d, &shape->k, &shape->T);
    return 0;
}

/* P = [-T6(-d)^-1, T6(d)^-1] */
void dmb_beam_strain_rate(const dmb_beam_shape *shape, const double velocity_a[6], const double velocity_b[6],
                          double rate[6])
{
    double a[6];
    dmb_se3_tangent_apply_reverse(&shape->T, velocity_a, a);
    dmb_se3_tangent_apply(&shape->T, velocity_b, rate);
    for (int i = 0; i < 6; i++) rate[i] -= a[i];
}

void dmb_beam_stress(const dmb_element_type *type, const double d[6], double stress[6])
{
    for (int i = 0; i < 6; i++) stress[i] = type->stiffness[i] * (d[i] - type->rest[i]);
}

void dmb_beam_add_force(const dmb_beam_shape *shape, const double stress[6], double force_a[6], double force_b[6])
{
    double a[6], b[6];
    dmb_se3_tangent_apply_reverse_transpose(&shape->T, stress, a);
    dmb_se3_tangent_apply_transpose(&shape->T, stress, b);
    for (int i = 0; i < 6; i++) {
        force_a[i] -= a[i];
        force_b[i] += b[i];
    }
}

/* Material part P^T (K/L) P, T6(-d)^-1 = R: [R^T k R, -R^T k T; -T^T k R, T^T k T] */
static void material_stiffness(const double k[6], const dmb_se3_tangent *T, const dmb_se3_tangent *R,
                               dmb_beam_blocks *out)
{
    dmb_se3_tangent_congruence(R, k, R, out->aa);
    dmb_se3_tangent_congruence(T, k, T, out->bb);
    dmb_se3_tangent_congruence(R, k, T, out->ab);
    for (int i = 0; i < 36; i++) out->ab[i] = -out->ab[i];
    dmb_mat6_transpose(out->ab, out->ba);
}

/* Geometric part [D1(-d, s); D1(d, s)] P */
static void add_geometric_stiffness(const dmb_beam_shape *shape, const double stress[6], const dmb_se3_tangent *R,
                                    dmb_beam_blocks *out)
{
    dmb_se3_stress_blocks plus, minus;
    dmb_se3_stress_blocks_at(shape->d, stress, &shape->k, &plus, &minus);
    dmb_se3_stress_times_tangent(-1.0, &minus, R, out->aa);
    dmb_se3_stress_times_tangent(1.0, &minus, &shape->T, out->ab);
    dmb_se3_stress_times_tangent(-1.0, &plus, R, out->ba);
    dmb_se3_stress_times_tangent(1.0, &plus, &shape->T, out->bb);
}

void dmb_beam_stiffness(const dmb_element_type *type, const dmb_beam_shape *shape, const double stress[6],
                        dmb_beam_blocks *blocks)
{
    dmb_se3_tangent R;
    dmb_se3_tangent_reverse(&shape->T, &R);
    material_stiffness(type->stiffness, &shape->T, &R, blocks);
    add_geometric_stiffness(shape, stress, &R, blocks);
}

/* out += s (rows of T6(-d)^-T or T6(d)^-T) diag(k) N, N any 6x6 */
static void add_rows(double s, const dmb_se3_tangent *T, const double k[6], const double N[36], double out[36])
{
    double full[36], kN[36], product[36];
    dmb_se3_tangent_matrix(T, full);
    for (int i = 0; i < 36; i++) kN[i] = k[i / 6] * N[i];
    dmb_mat6_mul_tn(full, kN, product);
    dmb_mat6_axpy(s, product, out);
}

/* s gains tau K d'/L with d' = P V. Its derivative by V is tau P^T (K/L) P, by the pose tau P^T (K/L) X P with
 * X = d(d')/dd = X(d, V_B) + X(-d, V_A), both of THEORY 3's operators. */
void dmb_beam_damping(const dmb_element_type *type, const dmb_beam_shape *shape, const double velocity_a[6],
                      const double velocity_b[6], double factor, dmb_beam_blocks *stiffness, dmb_beam_blocks *damping)
{
    double k[6], back[6], X[36], Xa[36], full[36], XT[36], XR[36];
    dmb_se3_tangent R;
    for (int i = 0; i < 6; i++) {
        k[i] = factor * type->damping_time * type->stiffness[i];
        back[i] = -shape->d[i];
    }
    dmb_se3_tangent_reverse(&shape->T, &R);
    material_stiffness(k, &shape->T, &R, damping);
    for (int i = 0; i < 6; i++) k[i] = type->damping_time * type->stiffness[i];
    dmb_se3_velocity_derivative(shape->d, velocity_b, &shape->k, X);
    dmb_se3_velocity_derivative(back, velocity_a, &shape->k, Xa);
    dmb_mat6_add(X, Xa, X);
    dmb_se3_tangent_matrix(&shape->T, full);
    dmb_mat6_mul(X, full, XT);
    dmb_se3_tangent_matrix(&R, full);
    dmb_mat6_mul(X, full, XR);
    add_rows(1.0, &R, k, XR, stiffness->aa);
    add_rows(-1.0, &R, k, XT, stiffness->ab);
    add_rows(-1.0, &shape->T, k, XR, stiffness->ba);
    add_rows(1.0, &shape->T, k, XT, stiffness->bb);
}

/* One bending plane: u and t of both ends; the second plane enters with t = -theta_y. */
static void bending_times(const double m[6], double ua, double ta, double ub, double tb, double out[4])
{
    out[0] = m[0] * ua + m[1] * ta + m[2] * ub + m[3] * tb;
    out[1] = m[1] * ua + m[4] * ta - m[3] * ub + m[5] * tb;
    out[2] = m[2] * ua - m[3] * ta + m[0] * ub - m[1] * tb;
    out[3] = m[3] * ua + m[5] * ta - m[1] * ub + m[4] * tb;
}

void dmb_beam_mass_times(const dmb_beam_mass *mass, const double va[6], const double vb[6], double pa[6], double pb[6])
{
    double y[4], z[4];
    bending_times(mass->bending[0], va[1], va[5], vb[1], vb[5], y);
    bending_times(mass->bending[1], va[2], -va[4], vb[2], -vb[4], z);
    pa[0] = mass->axial[0] * va[0] + mass->axial[1] * vb[0];
    pb[0] = mass->axial[1] * va[0] + mass->axial[0] * vb[0];
    pa[3] = mass->torsion[0] * va[3] + mass->torsion[1] * vb[3];
    pb[3] = mass->torsion[1] * va[3] + mass->torsion[0] * vb[3];
    pa[1] = y[0], pa[5] = y[1], pb[1] = y[2], pb[5] = y[3];
    pa[2] = z[0], pa[4] = -z[1], pb[2] = z[2], pb[4] = -z[3];
}

/* The ten numbers of one 6x6 block of M: axial, torsion and per plane uu, ut, tu, tt. */
typedef struct mass_block {
    double axial, torsion, uu[2], ut[2], tu[2], tt[2];
} mass_block;

static void block_aa(const dmb_beam_mass *m, double side, mass_block *out)
{
    out->axial = m->axial[0];
    out->torsion = m->torsion[0];
    for (int p = 0; p < 2; p++) {
        out->uu[p] = m->bending[p][0];
        out->ut[p] = out->tu[p] = side * m->bending[p][1];
        out->tt[p] = m->bending[p][4];
    }
}

static void block_ab(const dmb_beam_mass *m, double side, mass_block *out)
{
    out->axial = m->axial[1];
    out->torsion = m->torsion[1];
    for (int p = 0; p < 2; p++) {
        out->uu[p] = m->bending[p][2];
        out->ut[p] = side * m->bending[p][3];
        out->tu[p] = -out->ut[p];
        out->tt[p] = m->bending[p][5];
    }
}

/* out += L M_block; M_block has entries (0,0) (3,3), (1,1) (1,5) (5,1) (5,5), (2,2) (2,4) (4,2) (4,4) */
static void add_times_block(const double L[36], const mass_block *m, double out[36])
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
static void inertia_rows(const double v[6], double mass_factor, double velocity_factor, double L[36])
{
    dmb_mat6_zero(L);
    dmb_mat6_add_skew(velocity_factor, v + 3, 0, 0, L);
    dmb_mat6_add_skew(velocity_factor, v + 3, 1, 1, L);
    dmb_mat6_add_skew(velocity_factor, v, 1, 0, L);
    for (int i = 0; i < 36; i += 7) L[i] += mass_factor;
}

/* out -= factor A(p), A(p) = [0, pu~; pu~, pw~] */
static void subtract_momentum(const double p[6], double factor, double out[36])
{
    dmb_mat6_add_skew(-factor, p, 0, 1, out);
    dmb_mat6_add_skew(-factor, p, 1, 0, out);
    dmb_mat6_add_skew(-factor, p + 3, 1, 1, out);
}

void dmb_beam_add_inertia_tangent(const dmb_beam_mass *mass, const double va[6], const double vb[6], const double pa[6],
                                  const double pb[6], double mass_factor, double velocity_factor,
                                  dmb_beam_blocks *blocks)
{
    double L[36];
    mass_block m;
    inertia_rows(va, mass_factor, velocity_factor, L);
    block_aa(mass, 1.0, &m);
    add_times_block(L, &m, blocks->aa);
    block_ab(mass, 1.0, &m);
    add_times_block(L, &m, blocks->ab);
    subtract_momentum(pa, velocity_factor, blocks->aa);
    inertia_rows(vb, mass_factor, velocity_factor, L);
    block_aa(mass, -1.0, &m);
    add_times_block(L, &m, blocks->bb);
    block_ab(mass, -1.0, &m);
    add_times_block(L, &m, blocks->ba);
    subtract_momentum(pb, velocity_factor, blocks->bb);
}

/* K -> rows moved by the transpose of the left arm, columns by the right arm */
void dmb_beam_block_to_nodes(double left, double right, double K[36])
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

void dmb_beam_blocks_to_nodes(const double arm[2], dmb_beam_blocks *blocks)
{
    dmb_beam_block_to_nodes(arm[0], arm[0], blocks->aa);
    dmb_beam_block_to_nodes(arm[0], -arm[1], blocks->ab);
    dmb_beam_block_to_nodes(-arm[1], arm[0], blocks->ba);
    dmb_beam_block_to_nodes(-arm[1], -arm[1], blocks->bb);
}
