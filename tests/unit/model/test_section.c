/* Constants of pipes, joints and bits against closed forms and sums over thin discs. */
#include "model_test.h"

#include "model/section.h"

/* Reference string S1 of lib/theory/limits.md */
static void reference_string(void **state)
{
    const dmb_pipe_def pipe = s1_pipe();
    dmb_pipe_section s;
    (void)state;
    dmb_section_of(&pipe, &s);
    assert_near(s.stiffness[0] / pipe.young_modulus, 1.809557e-3, 1e-6);
    assert_near(s.stiffness[4] / pipe.young_modulus, 9.448151e-7, 1e-6);
    assert_near(s.stiffness[0], 3.800070e8, 1e-6);
    assert_near(s.stiffness[4], 198411.2, 1e-6);
    assert_near(s.stiffness[5], 198411.2, 1e-6);
    assert_near(s.stiffness[3], 152623.98, 1e-7);
    assert_near(s.mass, 14.20503, 1e-6);
    assert_near(s.mass * 9.81, 139.3513, 1e-6);
    assert_near(sqrt(s.stiffness[0] / s.mass), 5172.194, 1e-6);
    assert_near(sqrt(s.stiffness[3] / s.inertia[0]), 3207.659, 1e-6);
    assert_near(sqrt(s.stiffness[0] * s.mass), 73471.13, 1e-6);
    assert_near(sqrt(s.stiffness[3] * s.inertia[0]), 47.58111794, 1e-9);
    assert_near(s.stiffness[1], 0.5 * s.stiffness[0] / 2.6, 1e-15);
    assert_near(s.stiffness[2], s.stiffness[1], 1e-15);
    assert_near(s.inertia[0], 2.0 * s.inertia[1], 1e-15);
}

static void what_is_given_goes_first(void **state)
{
    dmb_pipe_def pipe = s1_pipe();
    dmb_pipe_section s;
    (void)state;
    for (int i = 0; i < 6; ++i) pipe.section_stiffness[i] = 10.0 + i;
    pipe.section_mass = 3.0;
    pipe.section_inertia[0] = 4.0;
    pipe.section_inertia[1] = 5.0;
    dmb_section_of(&pipe, &s);
    for (int i = 0; i < 6; ++i) assert_near(s.stiffness[i], 10.0 + i, 0.0);
    assert_near(s.mass, 3.0, 0.0);
    assert_near(s.inertia[0], 4.0, 0.0);
    assert_near(s.inertia[1], 5.0, 0.0);
}

/* A wall of a nanometre: the difference of squares would have lost most digits. */
static void thin_wall_keeps_its_digits(void **state)
{
    dmb_pipe_def pipe = s1_pipe();
    dmb_pipe_section s;
    (void)state;
    pipe.outer_diameter = 1.0 + 0x1p-30;
    pipe.inner_diameter = 1.0;
    dmb_section_of(&pipe, &s);
    assert_near(s.mass, pipe.density * acos(-1.0) / 4.0 * 0x1p-30 * (2.0 + 0x1p-30), 1e-15);
}

/* Slices of the pipe and of the joint make up the rigid pipe: compare with sums over thin discs. */
static void rigid_pipe_is_a_solid_of_revolution(void **state)
{
    dmb_pipe_def pipe = s1_pipe();
    dmb_rigid_part part;
    const double ro = 0.0365, ri = 0.0275;
    (void)state;
    pipe.joint_length = 0.3;
    dmb_rigid_pipe_of(&pipe, &part);
    assert_near(part.mass, 14.20503 * 1.2, 1e-6);
    assert_near(part.inertia[0], part.mass * (ro * ro + ri * ri) / 2.0, 1e-14);
    assert_near(part.inertia[1], part.mass * (3.0 * (ro * ro + ri * ri) + 1.2 * 1.2) / 12.0, 1e-14);
}

static void joint_from_geometry_or_as_given(void **state)
{
    dmb_pipe_def pipe = s1_pipe();
    dmb_rigid_part part;
    (void)state;
    dmb_joint_of(&pipe, &part);
    assert_near(part.mass, 0.0, 0.0);
    assert_near(dmb_joint_diameter(&pipe), 0.0, 0.0);
    pipe.joint_length = 0.2;
    dmb_joint_of(&pipe, &part);
    assert_near(part.mass, 14.20503 * 0.2, 1e-6);
    assert_near(dmb_joint_diameter(&pipe), 0.073, 0.0);
    pipe.joint_outer_diameter = 0.09;
    pipe.joint_inner_diameter = 0.04;
    dmb_joint_of(&pipe, &part);
    assert_near(part.mass, 7850.0 * acos(-1.0) / 4.0 * (0.09 * 0.09 - 0.04 * 0.04) * 0.2, 1e-14);
    assert_near(part.inertia[0], part.mass * (0.09 * 0.09 + 0.04 * 0.04) / 8.0, 1e-14);
    assert_near(part.inertia[1], part.mass * ((0.09 * 0.09 + 0.04 * 0.04) / 16.0 + 0.04 / 12.0), 1e-14);
    assert_near(dmb_joint_diameter(&pipe), 0.09, 0.0);
    pipe.joint_mass = 7.0;
    pipe.joint_inertia[0] = 0.1;
    pipe.joint_inertia[1] = 0.2;
    dmb_joint_of(&pipe, &part);
    assert_near(part.mass, 7.0, 0.0);
    assert_near(part.inertia[0], 0.1, 0.0);
    assert_near(part.inertia[1], 0.2, 0.0);
}

static void bit_is_a_solid_cylinder(void **state)
{
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_rigid_part part;
    (void)state;
    dmb_bit_body_of(&bit, &part);
    assert_near(part.inertia[0], 0.5 * 5.0 * 0.046 * 0.046, 1e-15);
    assert_near(part.inertia[1], 5.0 * (3.0 * 0.046 * 0.046 + 0.01) / 12.0, 1e-15);
    bit.diameter = 0.0;
    dmb_bit_body_of(&bit, &part);
    assert_near(part.inertia[0], 0.5 * 5.0 * 0.047 * 0.047, 1e-15);
    bit.inertia[0] = 1.0;
    bit.inertia[1] = 2.0;
    dmb_bit_body_of(&bit, &part);
    assert_near(part.inertia[0], 1.0, 0.0);
    assert_near(part.inertia[1], 2.0, 0.0);
}

static void buoyancy(void **state)
{
    const dmb_pipe_def pipe = s1_pipe();
    (void)state;
    const dmb_mud none = {0.0, -1.0}, mud = {1200.0, -1.0}, mercury = {13600.0, -1.0}, full = {1200.0, 1000.0};
    dmb_pipe_section section;
    dmb_section_of(&pipe, &section);
    const double bore = dmb_ring_area(pipe.inner_diameter, 0.0);
    assert_near(dmb_buoyancy_factor(&pipe, 0, &none), 1.0, 0.0);
    assert_near(dmb_buoyancy_factor(&pipe, 0, &mud), 1.0 - 1200.0 / 7850.0, 1e-15);
    assert_true(dmb_buoyancy_factor(&pipe, 0, &mercury) < 0.0); /* floats */
    assert_near(dmb_buoyancy_factor(&pipe, 0, &full), 1.0 - 1200.0 / 7850.0 - 200.0 * bore / section.mass, 1e-15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(reference_string),
        TEST(what_is_given_goes_first),
        TEST(thin_wall_keeps_its_digits),
        TEST(rigid_pipe_is_a_solid_of_revolution),
        TEST(joint_from_geometry_or_as_given),
        TEST(bit_is_a_solid_cylinder),
        TEST(buoyancy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
