/* Constants of an element against the exact beam: stiffness at its nodes, mass as integral of the shapes
 * (eq:beam.shear-correction, eq:beam.mass, eq:beam.axial-mass). */
#include "model_test.h"

#include "element/beam.h"
#include "model/section.h"

static const double no_arm[2] = {0.0, 0.0};

static void stiffness_is_nodally_exact(void **state)
{
    const dmb_pipe_def pipe = s1_pipe();
    dmb_element_type type;
    const double L = 1.5, EI = 198411.2, GA = 0.5 * 3.800070e8 / 2.6;
    (void)state;
    dmb_element_type_of(&pipe, no_arm, 0.25, &type);
    assert_near(type.length, L, 0.0);
    assert_near(type.stiffness[0], 3.800070e8 / L, 1e-6);
    assert_near(type.stiffness[1], 1.0 / (1.0 / GA + L * L / (12.0 * EI)) / L, 1e-6);
    assert_near(type.stiffness[2], type.stiffness[1], 1e-15);
    assert_near(type.stiffness[3], 152623.98 / L, 1e-7);
    assert_near(type.stiffness[4], EI / L, 1e-6);
    assert_near(type.strain_stiffness[1], GA, 1e-6);
    assert_near(type.damping_time, 0.25, 0.0);
    assert_near(type.mass_per_metre, 14.20503, 1e-6);
    /* tip deflection of a cantilever under a unit force: L^3/3EI + L/GA = (rotation at the middle) + shear of the
     * element */
    const double tip = L * L / 4.0 / type.stiffness[4] + 1.0 / type.stiffness[1];
    assert_near(tip, L * L * L / (3.0 * EI) + L / GA, 1e-6);
}

/* Shear along y goes with bending about z. */
static void planes_are_paired(void **state)
{
    dmb_pipe_def pipe = s1_pipe();
    dmb_element_type type;
    const double K[6] = {1e6, 2e5, 3e5, 4e3, 5e3, 6e3};
    (void)state;
    memcpy(pipe.section_stiffness, K, sizeof K);
    pipe.elements = 3;
    dmb_element_type_of(&pipe, no_arm, 0.0, &type);
    assert_near(type.length, 0.5, 1e-15);
    assert_near(type.stiffness[1], 1.0 / (1.0 / 2e5 + 0.25 / (12.0 * 6e3)) / 0.5, 1e-14);
    assert_near(type.stiffness[2], 1.0 / (1.0 / 3e5 + 0.25 / (12.0 * 5e3)) / 0.5, 1e-14);
}

static void rest_shape_and_arms(void **state)
{
    dmb_pipe_def pipe = s1_pipe();
    dmb_element_type type;
    const double arm[2] = {0.25, 0.5};
    (void)state;
    pipe.elements = 2;
    pipe.joint_length = 0.5;
    pipe.curvature[0] = 0.1;
    pipe.curvature[1] = 0.2;
    pipe.curvature[2] = 0.3;
    dmb_element_type_of(&pipe, arm, 0.0, &type);
    assert_near(type.length, 0.5, 0.0);
    assert_near(type.rest[0], 0.5, 0.0);
    assert_near(type.rest[1], 0.0, 0.0);
    assert_near(type.rest[3], 0.05, 1e-15);
    assert_near(type.rest[4], 0.10, 1e-15);
    assert_near(type.rest[5], 0.15, 1e-15);
    assert_near(type.arm[0], 0.25, 0.0);
    assert_near(type.arm[1], 0.5, 0.0);
}

/* The 8 x 8 integral of eq:beam.mass by a rule of many points, as an independent sum. */
static double shape_integral(double mass, double rotary, double P, double L, int i, int j)
{
    const int n = 2000;
    double sum = 0.0;
    for (int k = 0; k <= n; ++k) { /* Simpson */
        const double x = (double)k / n, q = 1.0 / (1.0 + P), weight = k == 0 || k == n ? 1.0 : k % 2 ? 4.0 : 2.0;
        const double N[4] = {(1 - 3 * x * x + 2 * x * x * x + P * (1 - x)) * q,
                             L * (x - 2 * x * x + x * x * x + P * (x - x * x) / 2) * q,
                             (3 * x * x - 2 * x * x * x + P * x) * q,
                             L * (-x * x + x * x * x - P * (x - x * x) / 2) * q};
        const double G[4] = {6 * (x * x - x) * q / L, (1 - 4 * x + 3 * x * x + P * (1 - x)) * q,
                             -6 * (x * x - x) * q / L, (3 * x * x - 2 * x + P * x) * q};
        sum += weight * (mass * N[i] * N[j] + rotary * G[i] * G[j]);
    }
    return sum * L / (3.0 * n);
}

static void expect_mass(const double m[6], double mass, double rotary, double P, double L)
{
    assert_near(m[0], shape_integral(mass, rotary, P, L, 0, 0), 1e-11);
    assert_near(m[0], shape_integral(mass, rotary, P, L, 2, 2), 1e-11);
    assert_near(m[1], shape_integral(mass, rotary, P, L, 0, 1), 1e-11);
    assert_near(m[1], -shape_integral(mass, rotary, P, L, 2, 3), 1e-11);
    assert_near(m[2], shape_integral(mass, rotary, P, L, 0, 2), 1e-11);
    assert_near(m[3], shape_integral(mass, rotary, P, L, 0, 3), 1e-11);
    assert_near(m[3], -shape_integral(mass, rotary, P, L, 2, 1), 1e-11);
    assert_near(m[4], shape_integral(mass, rotary, P, L, 1, 1), 1e-11);
    assert_near(m[4], shape_integral(mass, rotary, P, L, 3, 3), 1e-11);
    assert_near(m[5], shape_integral(mass, rotary, P, L, 1, 3), 1e-11);
}

static void mass_is_the_integral_of_the_shapes(void **state)
{
    dmb_pipe_section s = {{1e6, 2e5, 3e5, 4e3, 5e3, 6e3}, 14.0, {0.02, 0.3}};
    dmb_beam_mass m;
    const double L = 0.7, share[2] = {1.0, 0.5};
    (void)state;
    dmb_beam_mass_of(&s, L, share, &m);
    assert_near(m.axial[0], 14.0 * L * 5.0 / 12.0, 1e-15);
    assert_near(m.axial[1], 14.0 * L / 12.0, 1e-15);
    assert_near(m.torsion[0], 0.02 * L * 3.0 / 8.0, 1e-15);
    assert_near(m.torsion[1], 0.02 * L / 8.0, 1e-15);
    expect_mass(m.bending[0], 14.0, 0.3, 12.0 * 6e3 / (2e5 * L * L), L);
    expect_mass(m.bending[1], 14.0, 0.3, 12.0 * 5e3 / (3e5 * L * L), L);
}

/* Without shear and rotary inertia: 156, 22, 54, -13, 4, -3 over 420. */
static void slender_limit(void **state)
{
    const dmb_pipe_section s = {{1.0, 1e30, 1e30, 1.0, 1.0, 1.0}, 2.0, {0.0, 0.0}};
    const double L = 3.0, m = 2.0 * 3.0 / 420.0;
    const double expected[6] = {156 * m, 22 * L * m, 54 * m, -13 * L * m, 4 * L * L * m, -3 * L * L * m};
    const double share[2] = {1.0, 1.0};
    dmb_beam_mass mass;
    (void)state;
    dmb_beam_mass_of(&s, L, share, &mass);
    for (int i = 0; i < 6; ++i) assert_near(mass.bending[0][i], expected[i], 1e-14);
}

/* Momentum of rigid motion: m and the moment of inertia about the middle, whatever the shear flexibility. */
static void rigid_motion_has_the_right_momentum(void **state)
{
    dmb_pipe_def pipe = s1_pipe();
    dmb_pipe_section s;
    dmb_element_type type;
    const double L = 1.5, va[6] = {1.0, 2.0, 3.0, 0.0, 0.0, 0.0};
    double pa[6], pb[6];
    (void)state;
    dmb_section_of(&pipe, &s);
    dmb_element_type_of(&pipe, no_arm, 0.0, &type);
    dmb_beam_mass_times(&type.mass, va, va, pa, pb);
    for (int i = 0; i < 3; ++i) assert_near(pa[i] + pb[i], s.mass * L * va[i], 1e-14);
    assert_close(pa[5] + pb[5] + L * pb[1], s.mass * L * L / 2.0 * va[1], 1e-13 * s.mass);
    for (int axis = 4; axis < 6; ++axis) { /* spin about the middle */
        double wa[6] = {0}, wb[6] = {0};
        const int side = axis == 5 ? 1 : 2;
        const double sign = axis == 5 ? 1.0 : -1.0;
        wa[axis] = wb[axis] = 1.0;
        wa[side] = -sign * L / 2.0;
        wb[side] = sign * L / 2.0;
        dmb_beam_mass_times(&type.mass, wa, wb, pa, pb);
        const double spin = pa[axis] + pb[axis] + sign * L / 2.0 * (pb[side] - pa[side]);
        assert_near(spin, s.mass * L * L * L / 12.0 + s.inertia[1] * L, 1e-13);
        assert_close(pa[side] + pb[side], 0.0, 1e-13);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(stiffness_is_nodally_exact),         TEST(planes_are_paired), TEST(rest_shape_and_arms),
        TEST(mass_is_the_integral_of_the_shapes), TEST(slender_limit),     TEST(rigid_motion_has_the_right_momentum),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
