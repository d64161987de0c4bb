/* The SE(3) element one at a time (equations in element/beam_math.h), and its sections (eq:beam.section-pose): the same
 * formulas as the lanes of the kernels, for queries, compilation and forces at points. */
#include "element/beam.h"

#include <string.h>

#include "element/beam_element.h"
#include "math/mat6.h"
#include "math/se3.h"

/* ---- The element ------------------------------------------------------------------------------------------------- */

static dmb_beam_constants constants_of(const dmb_element_type *type)
{
    dmb_beam_constants c;
    dmb_beam_load_constants(type, 0, &c);
    return c;
}

int32_t dmb_beam_deform(const dmb_element_type *type, const double quaternion_a[4], const double rotation_a[9],
                        const double quaternion_b[4], const double span[3], dmb_beam_shape *shape)
{
    const dmb_beam_constants c = constants_of(type);
    const int arms = type->arm[0] != 0.0 || type->arm[1] != 0.0;
    dmb_beam_shape_at(&c, arms, quaternion_a, rotation_a, quaternion_b, span, shape);
    return dmb_beam_rotation_holds(shape) ? 0 : -1;
}

void dmb_beam_strain_of(const dmb_element_type *type, const dmb_beam_shape *shape, double e[6])
{
    const dmb_beam_constants c = constants_of(type);
    dmb_beam_strain(&c, shape, e);
}

void dmb_beam_stress(const dmb_element_type *type, const dmb_beam_shape *shape, double stress[6])
{
    double e[6];
    dmb_beam_strain_of(type, shape, e);
    dmb_beam_stiffness_times(type, e, stress);
}

/* e . K_x e of the off-diagonal stiffness K_x of a bent unstressed shape; 0 for a straight one. */
double dmb_beam_cross_energy(const dmb_element_type *type, const double e[6])
{
    double s[6] = {0.0};
    if (!dmb_element_is_curved(type)) return 0.0;
    dmb_curved_add_cross(type->curved.cross, e, s);
    return dmb_vec6_dot(e, s);
}

void dmb_beam_stiffness_times(const dmb_element_type *type, const double e[6], double stress[6])
{
    for (int i = 0; i < 6; i++) stress[i] = type->stiffness[i] * e[i];
    if (dmb_element_is_curved(type)) dmb_curved_add_cross(type->curved.cross, e, stress);
}

/* Axial strain with the coupling of eq:beam.axial-shear, times the length. */
double dmb_beam_stretch(const dmb_element_type *type, const double d[6])
{
    double x[3];
    dmb_vec3_sub(d, type->rest, x);
    return x[0] + 0.5 * (type->coupling[0] * x[1] * x[1] + type->coupling[1] * x[2] * x[2]);
}

void dmb_beam_mass_times(const dmb_beam_mass *mass, const double va[6], const double vb[6], double pa[6], double pb[6])
{
    dmb_beam_constants c;
    dmb_beam_load_mass(mass, 0, &c);
    dmb_beam_momentum(&c, va, vb, pa, pb);
}

/* ---- Sections inside the element --------------------------------------------------------------------------------- */

void dmb_section_shape_at(const dmb_element_type *type, double x, int bending, dmb_section_shape *shape)
{
    dmb_section_constants c;
    dmb_section_load_constants(type, 0, &c);
    const dmb_section_shape straight = {.x = x};
    *shape = straight;
    if (bending) dmb_section_shape_of(&c, x, shape);
}

/* d = log of the pose of end B as seen from end A, both moved from their nodes by the rigid arms
 * (eq:kinematics.arm). */
void dmb_section_ends(const dmb_element_type *type, const double Ra[9], const double Rb[9], const double span[3],
                      double d[6])
{
    const double far_arm[3] = {-type->arm[1], 0.0, 0.0};
    double R[9], x[3], arm[3];
    dmb_mat3_mul_tn(Ra, Rb, R);
    dmb_mat3_tvec(Ra, span, x);
    dmb_mat3_vec(R, far_arm, arm);
    dmb_vec3_add(x, arm, x);
    x[0] -= type->arm[0];
    dmb_se3_log(R, x, NULL, d);
}

void dmb_section_pose(const dmb_element_type *type, const dmb_section_shape *shape, const double d[6], double Q[9],
                      double r[3])
{
    double h[6], c[6], R1[9], R2[9], x2[3];
    for (int i = 0; i < 6; i++) h[i] = shape->x * d[i];
    dmb_section_shape_correct(shape, d, c);
    dmb_se3_exp(h, NULL, R1, r);
    dmb_se3_exp(c, NULL, R2, x2);
    dmb_mat3_mul(R1, R2, Q);
    dmb_mat3_vec(R1, x2, x2);
    dmb_vec3_add(r, x2, r);
    r[0] += type->arm[0];
}

/* d' = T6^-1(d) V_B - T6^-1(-d) V_A for unit velocities of the nodes, transferred to the ends by their arms. */
void dmb_section_strain_map(const dmb_element_type *type, const double d[6], double map[72])
{
    dmb_se3_inverse_tangent T;
    dmb_se3_inverse_tangent_at(d, NULL, &T);
    for (int k = 0; k < 12; k++) {
        double v[6] = {0.0}, out[6];
        v[k % 6] = 1.0;
        dmb_arm_velocity(k < 6 ? type->arm[0] : -type->arm[1], v);
        if (k < 6)
            dmb_se3_tangent_apply_reverse(&T, v, out);
        else
            dmb_se3_tangent_apply(&T, v, out);
        for (int i = 0; i < 6; i++) map[12 * i + k] = k < 6 ? -out[i] : out[i];
    }
}

/* Velocity of the section: that of end A, propagated along the two exponentials of H(x) (eq:motion.section-map). */
void dmb_section_map(const dmb_element_type *type, const dmb_section_shape *shape, const double d[6], double map[72])
{
    double h[6], c[6], R[2][9], x[2][3], strain[72];
    dmb_se3_tangent T[2];
    for (int i = 0; i < 6; i++) h[i] = shape->x * d[i];
    dmb_section_shape_correct(shape, d, c);
    dmb_se3_exp(h, NULL, R[0], x[0]);
    dmb_se3_exp(c, NULL, R[1], x[1]);
    dmb_se3_tangent_at(h, NULL, &T[0]);
    dmb_se3_tangent_at(c, NULL, &T[1]);
    dmb_section_strain_map(type, d, strain);
    for (int k = 0; k < 12; k++) {
        double v[6] = {0.0}, rate[6], part[6];
        if (k < 6) v[k] = 1.0;
        dmb_arm_velocity(type->arm[0], v);
        for (int i = 0; i < 6; i++) rate[i] = strain[12 * i + k];
        for (int i = 0; i < 6; i++) part[i] = shape->x * rate[i];
        dmb_section_follow(R[0], x[0], &T[0], part, v);
        dmb_section_shape_correct(shape, rate, part);
        dmb_section_follow(R[1], x[1], &T[1], part, v);
        for (int i = 0; i < 6; i++) map[12 * i + k] = v[i];
    }
}

#define DMB_SECTION_STEP \
    1e-3 /* [rad; element lengths] step of differences: errors of 1e-12 of the map and of rounding */

/* The map depends on d only, whose change is given by the strain map: four-point differences of fourth order along each
 * of its six components (weights 1, -8, 8, -1 of 12). */
void dmb_section_map_tangent(const dmb_element_type *type, const dmb_section_shape *shape, const double d[6],
                             const double w[6], double K[144])
{
    static const double weight[4] = {1.0 / 12.0, -8.0 / 12.0, 8.0 / 12.0, -1.0 / 12.0};
    static const double place[4] = {-2.0, -1.0, 1.0, 2.0};
    double by_d[12][6] = {{0.0}}, strain[72];
    dmb_section_strain_map(type, d, strain);
    for (int c = 0; c < 6; c++)
        for (int k = 0; k < 4; k++) {
            const double step = DMB_SECTION_STEP * (c < 3 ? type->length : 1.0);
            double moved[6], map[72];
            dmb_vec6_copy(d, moved);
            moved[c] += place[k] * step;
            dmb_section_map(type, shape, moved, map);
            for (int i = 0; i < 72; i++) by_d[i % 12][c] += weight[k] / step * map[i] * w[i / 12];
        }
    memset(K, 0, 144 * sizeof(double));
    for (int r = 0; r < 12; r++)
        for (int c = 0; c < 6; c++)
            for (int k = 0; k < 12; k++) K[12 * r + k] += by_d[r][c] * strain[12 * c + k];
}
