/* The flexible element by itself: forces against the energy, tangents against differences, momentum, mass, refusals.
 * Reference of every tangent: six-point central differences (error h^6) of the forces; of the forces: of the energy.
 * Checks eq:beam.strain-rate, eq:beam.strain, eq:beam.force, eq:beam.tangent, eq:beam.damping and eq:kinematics.arm. */
#include <string.h>

#include "check.h"

#include "element/beam.h"
#include "element/beam_element.h"
#include "element/rigid_mass.h"
#include "math/quadrature.h"
#include "math/se3.h"
#include "model/section.h"

/* A short stubby pipe whose stiffnesses are of one size, so that no term hides behind another. */
static void soft_type(double damping_time, const double arm[2], dmb_element_type *type)
{
    static const double stiffness[6] = {7.0, 4.0, 5.0, 3.0, 2.0, 2.5};
    dmb_pipe_def def = dmb_pipe_def_default();
    def.length = 1.3;
    for (int i = 0; i < 6; i++) def.section_stiffness[i] = stiffness[i];
    for (int i = 0; i < 3; i++) def.curvature[i] = 0.2 * (i - 1);
    def.section_mass = 1.1;
    def.section_inertia[0] = 0.3;
    def.section_inertia[1] = 0.2;
    dmb_element_type_of(&def, arm, damping_time, type);
}

/* Blocks of one element: beam_math.h with the constants of its type. */
static void stiffness_of(const dmb_element_type *type, const dmb_beam_shape *shape, const double stress[6],
                         dmb_beam_blocks *blocks)
{
    dmb_beam_constants c;
    dmb_beam_load_constants(type, 0, &c);
    dmb_beam_stiffness_blocks(&c, shape, stress, blocks);
}

static void damped_of(const dmb_element_type *type, const dmb_beam_shape *shape, const double stress[6],
                      const double velocity_a[6], const double velocity_b[6], double factor, dmb_beam_blocks *stiffness,
                      dmb_beam_blocks *damping)
{
    dmb_beam_constants c;
    dmb_beam_load_constants(type, 0, &c);
    dmb_beam_damped_blocks(&c, shape, stress, velocity_a, velocity_b, factor, stiffness, damping);
}

static void add_inertia_tangent(const dmb_beam_mass *mass, const double va[6], const double vb[6], const double pa[6],
                                const double pb[6], double mass_factor, double velocity_factor, dmb_beam_blocks *blocks)
{
    dmb_beam_constants c;
    dmb_beam_load_mass(mass, 0, &c);
    dmb_beam_add_inertia_blocks(&c, va, vb, pa, pb, mass_factor, velocity_factor, 0, blocks);
}

typedef struct two_ends {
    double qa[4], qb[4], xa[3], xb[3], va[6], vb[6];
} two_ends;

/* Node B from node A by a relative rotation of that angle about a random axis, both anywhere. */
static void draw_ends(uint64_t *seed, double angle, two_ends *ends)
{
    double h[6], r[3];
    for (int i = 0; i < 6; i++) h[i] = draw_between(seed, -1.0, 1.0);
    dmb_vec3_zero(ends->qa + 1);
    ends->qa[0] = 1.0;
    dmb_vec3_zero(ends->xa);
    dmb_se3_advance(ends->qa, ends->xa, h);
    for (int i = 0; i < 3; i++) r[i] = draw_between(seed, -1.0, 1.0);
    dmb_vec3_scale(angle / dmb_vec3_norm(r), r, h + 3);
    h[0] = 1.2;
    h[1] = draw_between(seed, -0.4, 0.4);
    h[2] = draw_between(seed, -0.4, 0.4);
    dmb_quat_copy(ends->qa, ends->qb);
    dmb_vec3_copy(ends->xa, ends->xb);
    dmb_se3_advance(ends->qb, ends->xb, h);
    for (int i = 0; i < 6; i++) {
        ends->va[i] = draw_between(seed, -1.0, 1.0);
        ends->vb[i] = draw_between(seed, -1.0, 1.0);
    }
}

/* Component c of twelve, by a body-frame increment of node A (0 .. 5) or node B. */
static two_ends moved(const two_ends *ends, int c, double step)
{
    two_ends out = *ends;
    double h[6] = {0.0};
    h[c % 6] = step;
    if (c < 6)
        dmb_se3_advance(out.qa, out.xa, h);
    else
        dmb_se3_advance(out.qb, out.xb, h);
    return out;
}

static void shape_of(const dmb_element_type *type, const two_ends *ends, dmb_beam_shape *shape)
{
    double R[9], span[3];
    dmb_quat_to_matrix(ends->qa, R);
    dmb_vec3_sub(ends->xb, ends->xa, span);
    assert_int_equal(dmb_beam_deform(type, ends->qa, R, ends->qb, span, shape), 0);
}

static double energy(const dmb_element_type *type, const two_ends *ends)
{
    dmb_beam_shape shape;
    double e[6], sum = 0.0;
    shape_of(type, ends, &shape);
    dmb_beam_strain_of(type, &shape, e);
    for (int i = 0; i < 6; i++) sum += 0.5 * type->stiffness[i] * e[i] * e[i];
    return sum;
}

/* Internal force on the nodes, material damping included. */
static void node_force(const dmb_element_type *type, const two_ends *ends, double f[12])
{
    dmb_beam_shape shape;
    double s[6], rate[6], va[6], vb[6];
    memset(f, 0, 12 * sizeof *f);
    shape_of(type, ends, &shape);
    dmb_beam_stress(type, &shape, s);
    dmb_vec6_copy(ends->va, va);
    dmb_vec6_copy(ends->vb, vb);
    dmb_arm_velocity(type->arm[0], va);
    dmb_arm_velocity(-type->arm[1], vb);
    dmb_beam_strain_rate(&shape, va, vb, rate);
    for (int i = 0; i < 6; i++) s[i] += type->damping_time * type->stiffness[i] * rate[i];
    dmb_beam_add_force(&shape, s, f, f + 6);
    dmb_arm_wrench(type->arm[0], f);
    dmb_arm_wrench(-type->arm[1], f + 6);
}

/* Blocks as one 12 x 12 matrix. */
static void assemble(const dmb_beam_blocks *b, double K[144])
{
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) {
            K[12 * i + j] = b->aa[6 * i + j];
            K[12 * i + 6 + j] = b->ab[6 * i + j];
            K[12 * (6 + i) + j] = b->ba[6 * i + j];
            K[12 * (6 + i) + 6 + j] = b->bb[6 * i + j];
        }
}

static const double no_arm[2] = {0.0, 0.0}, arms[2] = {0.15, 0.25};
static const double angles[] = {1e-9, 1e-5, 0.01, 0.3, 1.0, 1.7, 2.1};
#define ANGLES (sizeof angles / sizeof angles[0])

/* Strain rate e' = E P V is the time derivative of e. */
static void strain_rate_is_the_derivative_of_the_strain(void **state)
{
    (void)state;
    uint64_t seed = 11;
    double worst = 0.0;
    for (size_t k = 0; k < 8 * ANGLES; k++) {
        dmb_element_type type;
        dmb_beam_shape shape;
        two_ends ends;
        double f[6][6], rate[6];
        soft_type(0.0, no_arm, &type);
        draw_ends(&seed, angles[k % ANGLES], &ends);
        shape_of(&type, &ends, &shape);
        dmb_beam_strain_rate(&shape, ends.va, ends.vb, rate);
        for (int p = 0; p < 6; p++) {
            two_ends at = ends;
            double h[6];
            for (int i = 0; i < 6; i++) h[i] = ends.va[i] * difference6_place[p] * 1e-3;
            dmb_se3_advance(at.qa, at.xa, h);
            for (int i = 0; i < 6; i++) h[i] = ends.vb[i] * difference6_place[p] * 1e-3;
            dmb_se3_advance(at.qb, at.xb, h);
            shape_of(&type, &at, &shape);
            dmb_beam_strain_of(&type, &shape, f[p]);
        }
        for (int i = 0; i < 6; i++) {
            const double v[6] = {f[0][i], f[1][i], f[2][i], f[3][i], f[4][i], f[5][i]};
            worst = fmax(worst, fabs(rate[i] - difference6(v, 1e-3)));
        }
    }
    check_below("strain rate against differences of the strain", worst, 2e-12);
}

static double energy_error(const dmb_element_type *type, const two_ends *ends)
{
    double f[12], worst = 0.0;
    node_force(type, ends, f);
    for (int c = 0; c < 12; c++) {
        double E[6];
        for (int p = 0; p < 6; p++) {
            const two_ends at = moved(ends, c, 2e-3 * difference6_place[p]);
            E[p] = energy(type, &at);
        }
        worst = fmax(worst, fabs(f[c] - difference6(E, 2e-3)));
    }
    return worst / largest(12, f);
}

static void force_is_the_gradient_of_the_energy(void **state)
{
    (void)state;
    uint64_t seed = 3;
    double worst = 0.0;
    for (size_t k = 0; k < 16 * ANGLES; k++) {
        dmb_element_type type;
        two_ends ends;
        soft_type(0.0, k % 2 ? arms : no_arm, &type);
        draw_ends(&seed, angles[k % ANGLES], &ends);
        worst = fmax(worst, energy_error(&type, &ends));
    }
    check_below("internal force against the gradient of the energy", worst, 2e-11);
}

static double stiffness_error(const dmb_element_type *type, const two_ends *ends)
{
    dmb_beam_shape shape;
    dmb_beam_blocks blocks, damping;
    double s[6], K[144], worst = 0.0, va[6], vb[6];
    shape_of(type, ends, &shape);
    dmb_beam_stress(type, &shape, s);
    dmb_vec6_copy(ends->va, va);
    dmb_vec6_copy(ends->vb, vb);
    dmb_arm_velocity(type->arm[0], va);
    dmb_arm_velocity(-type->arm[1], vb);
    double rate[6];
    dmb_beam_strain_rate(&shape, va, vb, rate);
    for (int i = 0; i < 6; i++) s[i] += type->damping_time * type->stiffness[i] * rate[i];
    if (type->damping_time != 0.0)
        damped_of(type, &shape, s, va, vb, 1.0, &blocks, &damping);
    else
        stiffness_of(type, &shape, s, &blocks);
    dmb_beam_blocks_to_nodes(type->arm, &blocks);
    assemble(&blocks, K);
    for (int c = 0; c < 12; c++) {
        double f[6][12];
        for (int p = 0; p < 6; p++) {
            const two_ends at = moved(ends, c, 1e-3 * difference6_place[p]);
            node_force(type, &at, f[p]);
        }
        for (int i = 0; i < 12; i++) {
            const double v[6] = {f[0][i], f[1][i], f[2][i], f[3][i], f[4][i], f[5][i]};
            worst = fmax(worst, fabs(K[12 * i + c] - difference6(v, 1e-3)));
        }
    }
    return worst / largest(144, K);
}

static double worst_stiffness(double damping_time, uint64_t seed)
{
    double worst = 0.0;
    for (size_t k = 0; k < 16 * ANGLES; k++) {
        dmb_element_type type;
        two_ends ends;
        soft_type(damping_time, k % 2 ? arms : no_arm, &type);
        draw_ends(&seed, angles[k % ANGLES], &ends);
        worst = fmax(worst, stiffness_error(&type, &ends));
    }
    return worst;
}

static void stiffness_is_the_derivative_of_the_force(void **state)
{
    (void)state;
    check_below("material and geometric stiffness against differences", worst_stiffness(0.0, 5), 1e-10);
}

static void damped_stiffness_is_the_derivative_of_the_force(void **state)
{
    (void)state;
    check_below("stiffness with material damping against differences", worst_stiffness(0.4, 7), 1e-10);
}

/* The force is linear in velocity: one difference of any length is exact. */
static void damping_is_the_derivative_by_velocity(void **state)
{
    (void)state;
    uint64_t seed = 9;
    double worst = 0.0;
    for (size_t k = 0; k < 8 * ANGLES; k++) {
        dmb_element_type type;
        dmb_beam_shape shape;
        dmb_beam_blocks unused, damping;
        two_ends ends;
        double C[144];
        const double factor = 1.7;
        soft_type(0.4, k % 2 ? arms : no_arm, &type);
        draw_ends(&seed, angles[k % ANGLES], &ends);
        shape_of(&type, &ends, &shape);
        const double stress[6] = {0.0};
        damped_of(&type, &shape, stress, ends.va, ends.vb, factor, &unused, &damping);
        dmb_beam_blocks_to_nodes(type.arm, &damping);
        assemble(&damping, C);
        for (int c = 0; c < 12; c++) {
            two_ends plus = ends, minus = ends;
            double a[12], b[12];
            *(c < 6 ? plus.va + c : plus.vb + (c - 6)) += 0.5;
            *(c < 6 ? minus.va + c : minus.vb + (c - 6)) -= 0.5;
            node_force(&type, &plus, a);
            node_force(&type, &minus, b);
            for (int i = 0; i < 12; i++)
                worst = fmax(worst, fabs(C[12 * i + c] - factor * (a[i] - b[i])) / largest(144, C));
        }
    }
    check_below("damping against differences", worst, 1e-14);
}

/* Inertia force M a - v^^T M v of both ends. */
static void inertia_force(const dmb_beam_mass *mass, const double v[12], const double a[12], double f[12])
{
    double p[12], g[6];
    dmb_beam_mass_times(mass, a, a + 6, f, f + 6);
    dmb_beam_mass_times(mass, v, v + 6, p, p + 6);
    for (int k = 0; k < 12; k += 6) {
        dmb_ad_transpose(v + k, p + k, g);
        for (int i = 0; i < 6; i++) f[k + i] -= g[i];
    }
}

/* Quadratic in velocity, linear in acceleration: differences of any length are exact. */
static void inertia_tangent_is_the_derivative_of_the_inertia_force(void **state)
{
    (void)state;
    uint64_t seed = 13;
    dmb_element_type type;
    soft_type(0.0, no_arm, &type);
    double v[12], a[12], p[12], worst = 0.0;
    for (int k = 0; k < 12; k++) {
        dmb_beam_blocks blocks;
        double C[144];
        const double fm = draw_between(&seed, 0.0, 2.0), fv = draw_between(&seed, 0.0, 2.0);
        for (int i = 0; i < 12; i++) v[i] = draw_between(&seed, -1.0, 1.0), a[i] = draw_between(&seed, -1.0, 1.0);
        dmb_beam_mass_times(&type.mass, v, v + 6, p, p + 6);
        memset(&blocks, 0, sizeof blocks);
        add_inertia_tangent(&type.mass, v, v + 6, p, p + 6, fm, fv, &blocks);
        assemble(&blocks, C);
        for (int c = 0; c < 12; c++) {
            double vp[12], vm[12], ap[12], am[12], plus[12], minus[12];
            memcpy(vp, v, sizeof v), memcpy(vm, v, sizeof v), memcpy(ap, a, sizeof a), memcpy(am, a, sizeof a);
            vp[c] += 0.5 * fv, vm[c] -= 0.5 * fv, ap[c] += 0.5 * fm, am[c] -= 0.5 * fm;
            inertia_force(&type.mass, vp, ap, plus);
            inertia_force(&type.mass, vm, am, minus);
            for (int i = 0; i < 12; i++)
                worst = fmax(worst, fabs(C[12 * i + c] - (plus[i] - minus[i])) / largest(144, C));
        }
    }
    check_below("inertia tangent against differences", worst, 1e-14);
}

/* The same for a rigid mass with its centre off the axis (eq:motion.rigid-mass). */
static void rigid_mass_tangent_is_the_derivative_of_its_force(void **state)
{
    (void)state;
    uint64_t seed = 17;
    const dmb_rigid_mass rigid_mass = {2.0, {0.3, -0.4, 0.2}, {1.0, 1.3, 1.5, 0.1, -0.2, 0.15}, 0, 0};
    double v[6], a[6], p[6], C[36] = {0.0}, worst = 0.0;
    dmb_rigid_mass_constants constants;
    for (int i = 0; i < 6; i++) v[i] = draw_between(&seed, -1.0, 1.0), a[i] = draw_between(&seed, -1.0, 1.0);
    dmb_rigid_mass_times(&rigid_mass, v, p);
    dmb_rigid_mass_load(&rigid_mass, 0, &constants);
    dmb_rigid_mass_add_tangent(&constants, v, p, 0.7, 1.9, C);
    for (int c = 0; c < 6; c++) {
        double f[2][6];
        for (int side = 0; side < 2; side++) {
            const double e = side ? 0.5 : -0.5;
            double vs[6], as[6], g[6];
            dmb_vec6_copy(v, vs), dmb_vec6_copy(a, as);
            vs[c] += 1.9 * e, as[c] += 0.7 * e;
            dmb_rigid_mass_times(&rigid_mass, as, f[side]);
            dmb_rigid_mass_times(&rigid_mass, vs, p);
            dmb_ad_transpose(vs, p, g);
            for (int i = 0; i < 6; i++) f[side][i] -= g[i];
        }
        for (int i = 0; i < 6; i++) worst = fmax(worst, fabs(C[6 * i + c] - (f[1][i] - f[0][i])));
    }
    check_below("inertia tangent of a rigid mass against differences", worst, 1e-14);
}

/* Wrench in a body frame at x, as force and moment about the origin in world axes, added to sum. */
static void add_to_world(const double q[4], const double x[3], const double f[6], double sum[6])
{
    double force[3], moment[3], arm[3];
    dmb_quat_rotate(q, f, force);
    dmb_quat_rotate(q, f + 3, moment);
    dmb_vec3_cross(x, force, arm);
    for (int i = 0; i < 3; i++) sum[i] += force[i], sum[3 + i] += moment[i] + arm[i];
}

/* Free element: p' = ad_v^T p - g in each body frame, so the spatial momentum Ad^-T p changes by -Ad^-T g, and the sum
 * over the ends is zero because the energy does not see rigid motion. */
static void internal_forces_leave_the_spatial_momentum_alone(void **state)
{
    (void)state;
    uint64_t seed = 19;
    double worst = 0.0;
    for (size_t k = 0; k < 16 * ANGLES; k++) {
        dmb_element_type type;
        two_ends ends;
        double f[12], sum[6] = {0.0};
        soft_type(0.4, k % 2 ? arms : no_arm, &type);
        draw_ends(&seed, angles[k % ANGLES], &ends);
        node_force(&type, &ends, f);
        add_to_world(ends.qa, ends.xa, f, sum);
        add_to_world(ends.qb, ends.xb, f + 6, sum);
        worst = fmax(worst, largest(6, sum) / largest(12, f));
    }
    check_below("sum of the wrenches on a free element", worst, 5e-15);
}

/* Total mass, centre and inertia of a straight element moved as a rigid body, and its kinetic energy. */
static void mass_carries_rigid_motion_exactly(void **state)
{
    (void)state;
    uint64_t seed = 23;
    dmb_pipe_def def = dmb_pipe_def_default();
    dmb_pipe_section section;
    dmb_element_type type;
    double worst = 0.0;
    def.length = 1.5;
    dmb_element_type_of(&def, no_arm, 0.0, &type);
    dmb_section_of(&def, &section);
    const double L = def.length, m = section.mass * L;
    const double across = section.inertia[1] * L + m * L * L / 3.0; /* about end A */
    for (int k = 0; k < 20; k++) {
        double va[6], vb[6], pa[6], pb[6], sum[6];
        for (int i = 0; i < 6; i++) va[i] = vb[i] = draw_between(&seed, -1.0, 1.0);
        dmb_arm_velocity(L, vb);
        dmb_beam_mass_times(&type.mass, va, vb, pa, pb);
        dmb_arm_wrench(L, pb);
        for (int i = 0; i < 6; i++) sum[i] = pa[i] + pb[i];
        const double c = 0.5 * L, *w = va + 3;
        const double want[6] = {m * va[0],
                                m * (va[1] + c * w[2]),
                                m * (va[2] - c * w[1]),
                                section.inertia[0] * L * w[0],
                                across * w[1] - m * c * va[2],
                                across * w[2] + m * c * va[1]};
        worst = fmax(worst, largest_difference(6, sum, want) / largest(6, want));
    }
    check_below("momentum of a rigidly moved element", worst, 5e-15);
}

static void mass_matrix_is_symmetric(void **state)
{
    (void)state;
    dmb_element_type type;
    double M[144];
    soft_type(0.0, no_arm, &type);
    for (int c = 0; c < 12; c++) {
        double e[12] = {0.0}, p[12];
        e[c] = 1.0;
        dmb_beam_mass_times(&type.mass, e, e + 6, p, p + 6);
        for (int i = 0; i < 12; i++) M[12 * i + c] = p[i];
    }
    for (int i = 0; i < 12; i++)
        for (int j = 0; j < 12; j++) assert_true(M[12 * i + j] == M[12 * j + i]);
}

/* One element, clamped at A, with a tip force: P L^3/(3 EI) + P L/GA, rotation P L^2/(2 EI), to first order. */
static void one_element_is_exact_in_linear_bending(void **state)
{
    (void)state;
    dmb_pipe_def def = dmb_pipe_def_default();
    dmb_element_type type;
    dmb_beam_shape shape;
    dmb_beam_blocks blocks;
    def.length = 1.5;
    dmb_element_type_of(&def, no_arm, 0.0, &type);
    memset(&shape, 0, sizeof shape);
    const double qi[4] = {1.0, 0.0, 0.0, 0.0}, R[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    const double span[3] = {def.length, 0.0, 0.0}, stress[6] = {0.0}, *K = type.strain_stiffness, L = def.length;
    assert_int_equal(dmb_beam_deform(&type, qi, R, qi, span, &shape), 0);
    stiffness_of(&type, &shape, stress, &blocks);
    const double kuu = blocks.bb[7], kut = blocks.bb[11], ktt = blocks.bb[35];
    const double determinant = kuu * ktt - kut * kut;
    check_relative("tip deflection of one element", ktt / determinant, L * L * L / (3.0 * K[5]) + L / K[1], 1e-13);
    check_relative("tip rotation of one element", -kut / determinant, L * L / (2.0 * K[5]), 1e-13);
}

/* ---- Shape between the ends -------------------------------------------------------------------------------------- */

/* Strain of an element with both nodes at d from each other, as a pose. */
static void strain_at(const dmb_element_type *type, const double d[6], double e[6])
{
    const double qa[4] = {1.0, 0.0, 0.0, 0.0}, R[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    dmb_beam_shape shape;
    double qb[4], span[3];
    dmb_se3_exp_to_quat(d, qb, span);
    assert_int_equal(dmb_beam_deform(type, qa, R, qb, span, &shape), 0);
    dmb_beam_strain_of(type, &shape, e);
}

/* Bending share sigma of the flexibility to a force across in the plane of x and y. */
static double straight_type(double shear_stiffness, dmb_element_type *type)
{
    dmb_pipe_def def = dmb_pipe_def_default();
    def.length = 2.0;
    for (int i = 0; i < 6; i++) def.section_stiffness[i] = i == 1 || i == 2 ? shear_stiffness : 3.0;
    def.section_mass = 1.0;
    dmb_element_type_of(&def, no_arm, 0.0, type);
    return 1.0 / (1.0 + 12.0 * 3.0 / (shear_stiffness * def.length * def.length));
}

/* A chord turned by g against both end sections: mean of u' + t w' - t^2/2 over the cubic of eq:beam.cubic-slope, which
 * closes (mean slope g) and has one shear. */
static void turned_chord_is_as_long_as_its_cubic(void **state)
{
    static const double stiffness[3] = {1e6, 30.0, 2.0};
    const dmb_gauss_rule *rule = dmb_gauss(4);
    (void)state;
    for (int k = 0; k < 3; k++) {
        dmb_element_type type;
        const double sigma = straight_type(stiffness[k], &type), P = 1.0 / sigma - 1.0, g = 0.01;
        const double d[6] = {type.length, g * type.length, 0.0, 0.0, 0.0, 0.0};
        double e[6], slope = 0.0, stretch = 0.0, shear = 0.0;
        for (int p = 0; p < rule->count; p++) {
            const double x = rule->node[p], w = sigma * g * (6.0 * (x - x * x) + P), t = 6.0 * sigma * g * (x - x * x);
            slope += rule->weight[p] * w;
            stretch += rule->weight[p] * (t * w - 0.5 * t * t);
            shear = fmax(shear, fabs(w - t - sigma * P * g));
        }
        strain_at(&type, d, e);
        check_relative("mean slope of the cubic", slope, g, 1e-14);
        check_below("change of its shear", shear, 1e-16);
        check_relative("stretch of the element", e[0] / type.length, stretch, 1e-10);
    }
}

/* End of a line of length 1 whose sections are turned by Theta (x + 1/2) + s t(x), as the coordinate y of its
 * logarithm; t = (x^2 - 1/4)(1 + x). */
static double sideways(double Theta, double s)
{
    const dmb_gauss_rule *rule = dmb_gauss(5);
    double R[9] = {0.0}, x[3] = {0.0}, d[6];
    for (int k = 0; k < 50; k++)
        for (int p = 0; p < rule->count; p++) {
            const double at = (k + rule->node[p]) / 50.0 - 0.5, t = (at * at - 0.25) * (1.0 + at);
            x[0] += rule->weight[p] / 50.0 * cos(Theta * (at + 0.5) + s * t);
            x[1] += rule->weight[p] / 50.0 * sin(Theta * (at + 0.5) + s * t);
        }
    R[0] = R[4] = cos(Theta);
    R[3] = sin(Theta);
    R[1] = -R[3];
    R[8] = 1.0;
    dmb_se3_log(R, x, NULL, d);
    return d[1];
}

/* Integral of cos(Theta x) f(x), x from -1/2 to 1/2: of that t (kind 0), or of the rotations by a unit force. */
static double along_the_bend(double Theta, int kind)
{
    const dmb_gauss_rule *rule = dmb_gauss(5);
    double sum = 0.0;
    for (int k = 0; k < 50; k++)
        for (int p = 0; p < rule->count; p++) {
            const double x = (k + rule->node[p]) / 50.0 - 0.5;
            const double f =
                kind == 0 ? (x * x - 0.25) * (1.0 + x) : (cos(Theta * x) - cos(0.5 * Theta)) / (Theta * Theta);
            sum += rule->weight[p] / 50.0 * cos(Theta * x) * f;
        }
    return sum;
}

static double kappa(double Theta)
{
    return 0.5 * Theta / sin(0.5 * Theta);
}

/* Sideways motion of a bent element by small rotations of its sections (eq:beam.bent-sideways). */
static void bent_ends_move_sideways(void **state)
{
    (void)state;
    for (double Theta = 0.3; Theta < 2.0; Theta += 0.4) {
        double f[6];
        for (int p = 0; p < 6; p++) f[p] = sideways(Theta, 1e-2 * difference6_place[p]);
        check_close("sideways per rotation", difference6(f, 1e-2), kappa(Theta) * along_the_bend(Theta, 0), 1e-12);
    }
}

/* Flexibility of a slender bent element over that of a straight one: 12 kappa^2 times the integral, its series
 * (eq:beam.bent-flexibility), and the element, whose strain counts it to the square of the bend. */
static void flexibility_errors(double Theta, double errors[2])
{
    dmb_element_type type;
    const double y = 1e-3, square = Theta * Theta;
    double e[2][6];
    (void)straight_type(1e12, &type);
    for (int k = 0; k < 2; k++) {
        const double d[6] = {type.length, k ? y : -y, 0.0, 0.0, 0.0, Theta};
        strain_at(&type, d, e[k]);
    }
    const double exact = 12.0 * kappa(Theta) * kappa(Theta) * along_the_bend(Theta, 1);
    errors[0] = fabs(1.0 + square / 30.0 + square * square / 840.0 - exact);
    errors[1] = fabs(pow((e[1][1] - e[0][1]) / (2.0 * y), -2.0) - exact);
}

static void bent_elements_are_softer_sideways(void **state)
{
    double coarse[2], fine[2];
    (void)state;
    flexibility_errors(0.8, coarse);
    flexibility_errors(0.4, fine);
    check_order("error of the series", coarse[0], fine[0], 6.0, 0.1);
    check_order("error of the element", coarse[1], fine[1], 4.0, 0.1);
}

/* The opposite quaternion is the same pose; the logarithm must not take the long way round. */
static void sign_of_a_quaternion_does_not_matter(void **state)
{
    (void)state;
    uint64_t seed = 29;
    dmb_element_type type;
    soft_type(0.0, arms, &type);
    for (size_t k = 0; k < 4 * ANGLES; k++) {
        two_ends ends;
        dmb_beam_shape one, other;
        draw_ends(&seed, angles[k % ANGLES], &ends);
        shape_of(&type, &ends, &one);
        for (int i = 0; i < 4; i++) ends.qb[i] = -ends.qb[i];
        shape_of(&type, &ends, &other);
        assert_true(largest_difference(6, one.d, other.d) < 1e-15);
    }
}

static int32_t deform_by(double angle)
{
    dmb_element_type type;
    dmb_beam_shape shape;
    soft_type(0.0, no_arm, &type);
    const double qa[4] = {1.0, 0.0, 0.0, 0.0}, R[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    const double span[3] = {1.0, 0.1, 0.0}, turn[3] = {0.0, angle, 0.0};
    double qb[4];
    dmb_quat_exp(turn, qb);
    return dmb_beam_deform(&type, qa, R, qb, span, &shape);
}

/* Hard case 10: near pi the logarithm is refused, never flipped. */
static void large_relative_rotation_is_refused(void **state)
{
    (void)state;
    assert_int_equal(deform_by(2.4999), 0);
    assert_int_equal(deform_by(2.5001), -1);
    assert_int_equal(deform_by(PI), -1);
    assert_int_equal(deform_by(-3.0), -1);
    assert_int_equal(deform_by((double)NAN), -1);
    assert_int_equal(deform_by((double)INFINITY), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strain_rate_is_the_derivative_of_the_strain),
        cmocka_unit_test(force_is_the_gradient_of_the_energy),
        cmocka_unit_test(stiffness_is_the_derivative_of_the_force),
        cmocka_unit_test(damped_stiffness_is_the_derivative_of_the_force),
        cmocka_unit_test(damping_is_the_derivative_by_velocity),
        cmocka_unit_test(inertia_tangent_is_the_derivative_of_the_inertia_force),
        cmocka_unit_test(rigid_mass_tangent_is_the_derivative_of_its_force),
        cmocka_unit_test(internal_forces_leave_the_spatial_momentum_alone),
        cmocka_unit_test(mass_carries_rigid_motion_exactly),
        cmocka_unit_test(mass_matrix_is_symmetric),
        cmocka_unit_test(one_element_is_exact_in_linear_bending),
        cmocka_unit_test(turned_chord_is_as_long_as_its_cubic),
        cmocka_unit_test(bent_ends_move_sideways),
        cmocka_unit_test(bent_elements_are_softer_sideways),
        cmocka_unit_test(sign_of_a_quaternion_does_not_matter),
        cmocka_unit_test(large_relative_rotation_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
