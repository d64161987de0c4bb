/* Symmetry of the tangent of the flexible element, with all its terms of axial load and curvature: increments of poses
 * do not commute, so second derivatives of an energy differ by what it does along their bracket,
 *     K_ij - K_ji = f . [e_j, e_i],   [(u, w), (p, r)] = (w x p + u x r, w x r),
 * f the forces on the nodes (left-invariant fields; Marsden, Ratiu, Introduction to Mechanics and Symmetry, 9). Held
 * against it: any shape; stress 0, where K is symmetric; and a conservative load in equilibrium, where K with the
 * load's own part is. */
#include <lapacke.h>
#include <string.h>

#include "check.h"

#include "element/beam.h"
#include "model/section.h"

/* A pipe whose stiffnesses are of one size, so that no term hides behind another, bent and twisted at rest. */
static void soft_type(dmb_element_type *type)
{
    static const double stiffness[6] = {7.0, 4.0, 5.0, 3.0, 2.0, 2.5}, arm[2] = {0.15, 0.25};
    dmb_pipe_def def = dmb_pipe_def_default();
    def.length = 1.3;
    for (int i = 0; i < 6; i++) def.section_stiffness[i] = stiffness[i];
    for (int i = 0; i < 3; i++) def.curvature[i] = 0.2 * (i - 1);
    def.section_mass = 1.1;
    dmb_element_type_of(&def, arm, 0.0, type);
}

/* Pose of node B seen from node A. */
typedef struct pose {
    double q[4], x[3];
} pose;

/* Forces on the nodes, internal, and their derivative by increments of A (0 .. 5) and B in body frames. */
static void tangent_of(const dmb_element_type *type, const pose *b, double f[12], double K[144])
{
    static const double q[4] = {1.0}, R[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    dmb_beam_shape shape;
    dmb_beam_blocks k;
    dmb_beam_constants c;
    double s[6];
    assert_int_equal(dmb_beam_deform(type, q, R, b->q, b->x, &shape), 0);
    dmb_beam_stress(type, &shape, s);
    memset(f, 0, 12 * sizeof *f);
    dmb_beam_add_force(&shape, s, f, f + 6);
    dmb_arm_wrench(type->arm[0], f);
    dmb_arm_wrench(-type->arm[1], f + 6);
    dmb_beam_load_constants(type, 0, &c);
    dmb_beam_stiffness_blocks(&c, &shape, s, &k);
    dmb_beam_blocks_to_nodes(type->arm, &k);
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) {
            K[12 * i + j] = k.aa[6 * i + j];
            K[12 * i + 6 + j] = k.ab[6 * i + j];
            K[12 * (6 + i) + j] = k.ba[6 * i + j];
            K[12 * (6 + i) + 6 + j] = k.bb[6 * i + j];
        }
}

/* f . [e_j, e_i] of one node. */
static double along_bracket(const double f[6], int j, int i)
{
    double a[6] = {0.0}, b[6] = {0.0}, u[3], v[3], w[3];
    a[j] = b[i] = 1.0;
    dmb_vec3_cross(a + 3, b, u);
    dmb_vec3_cross(a, b + 3, v);
    dmb_vec3_cross(a + 3, b + 3, w);
    return dmb_vec3_dot(f, u) + dmb_vec3_dot(f, v) + dmb_vec3_dot(f + 3, w);
}

/* Largest of K_ij - K_ji - f . [e_j, e_i], and of K_ij - K_ji alone. */
static void asymmetry(const double f[12], const double K[144], double worst[2])
{
    for (int i = 0; i < 12; i++)
        for (int j = 0; j < 12; j++) {
            const double skew = K[12 * i + j] - K[12 * j + i];
            const double bracket = i / 6 == j / 6 ? along_bracket(f + 6 * (i / 6), j % 6, i % 6) : 0.0;
            worst[0] = fmax(worst[0], fabs(skew - bracket));
            worst[1] = fmax(worst[1], fabs(skew));
        }
}

/* The shape at rest, moved by a stretch and a random rest: pulled, pushed, sheared, twisted, bent. */
static void draw_pose(uint64_t *seed, double stretch, double rest, pose *b)
{
    double h[6];
    for (int i = 0; i < 6; i++) h[i] = rest * draw_between(seed, -1.0, 1.0);
    h[0] += 1.3 + stretch;
    memset(b, 0, sizeof *b);
    b->q[0] = 1.0;
    dmb_se3_advance(b->q, b->x, h);
}

static void skew_part_is_that_of_the_bracket(void **state)
{
    static const double stretches[] = {-0.5, -0.1, 0.0, 0.2, 1.0}, rests[] = {0.01, 0.3, 1.0};
    dmb_element_type type;
    uint64_t seed = 21;
    double worst[2] = {0.0, 0.0};
    (void)state;
    soft_type(&type);
    for (int k = 0; k < 150; k++) {
        pose b;
        double f[12], K[144];
        draw_pose(&seed, stretches[k % 5], rests[k % 3], &b);
        tangent_of(&type, &b, f, K);
        asymmetry(f, K, worst);
    }
    check_below("skew part of the tangent less that of the bracket", worst[0], 1e-12);
    assert_true(worst[1] > 1.0); /* not for want of forces */
}

/* Newton to where node B is in balance under a force F with fixed direction in A's frame; K_bb with the load's part:
 * f - R^T F changes by K h + w x R^T F. */
static void settle(const dmb_element_type *type, const double F[3], pose *b, double f[12], double K[144])
{
    for (int n = 0; n < 60; n++) {
        double R[9], local[3], A[36], h[6];
        lapack_int pivot[6];
        tangent_of(type, b, f, K);
        dmb_quat_to_matrix(b->q, R);
        dmb_mat3_tvec(R, F, local);
        for (int i = 0; i < 3; i++) f[6 + i] -= local[i];
        for (int j = 0; j < 3; j++) {
            double e[3] = {0.0}, change[3];
            e[j] = 1.0;
            dmb_vec3_cross(e, local, change); /* of -R^T F is + w x R^T F */
            for (int i = 0; i < 3; i++) K[12 * (6 + i) + 9 + j] += change[i];
        }
        for (int i = 0; i < 6; i++) {
            for (int j = 0; j < 6; j++) A[6 * i + j] = K[12 * (6 + i) + 6 + j];
            h[i] = -f[6 + i];
        }
        if (largest(6, f + 6) < 1e-14) return;
        assert_int_equal(LAPACKE_dgesv(LAPACK_ROW_MAJOR, 6, 1, A, 6, pivot, h, 1), 0);
        const double size = largest(6, h), scale = size > 0.3 ? 0.3 / size : 1.0;
        for (int i = 0; i < 6; i++) h[i] *= scale;
        dmb_se3_advance(b->q, b->x, h);
    }
}

/* Force 0: the state of no stress. */
static void conservative_loads_keep_symmetry(void **state)
{
    static const double F[][3] = {
        {0.0, 0.0, 0.0}, {5.0, 0.0, 0.0}, {20.0, 1.0, -2.0}, {-0.5, 0.1, 0.0}, {0.3, 2.0, 1.0}};
    dmb_element_type type;
    (void)state;
    soft_type(&type);
    for (size_t k = 0; k < sizeof F / sizeof *F; k++) {
        uint64_t seed = 5;
        double f[12], K[144], worst = 0.0;
        pose b;
        draw_pose(&seed, 0.0, 0.05, &b);
        settle(&type, F[k], &b, f, K);
        check_below("what is out of balance", largest(6, f + 6), 1e-13);
        for (int i = 6; i < 12; i++)
            for (int j = 6; j < 12; j++) worst = fmax(worst, fabs(K[12 * i + j] - K[12 * j + i]));
        check_below("    skew part of the tangent at node B, the load's included", worst, 1e-12);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(skew_part_is_that_of_the_bracket),
        cmocka_unit_test(conservative_loads_keep_symmetry),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
