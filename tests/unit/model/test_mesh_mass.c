/* Masses of the scene against those of the drawing: total, first moment and inertia, however it is meshed. */
#include "model_test.h"

#include "model/mesh.h"

/* Total weight and its first moment about the rig end: sum over nodes of m x + b_x. */
static void weights(const dmb_scene *scene, double *mass, double *moment)
{
    *mass = *moment = 0.0;
    for (uint32_t i = 0; i < scene->node_count; ++i) {
        *mass += scene->weight_mass[i];
        *moment += scene->weight_mass[i] * scene->reference_position[3 * i] + scene->weight_moment[3 * i];
    }
}

static double rigid_mass_mass(const dmb_scene *scene)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < scene->rigid_mass_count; ++i) sum += scene->rigid_masses[i].mass;
    return sum;
}

static double element_mass(const dmb_scene *scene)
{
    double sum = 0.0;
    for (uint32_t e = 0; e < scene->element_count; ++e) {
        const dmb_element_type *type = &scene->types[scene->element_type[e]];
        sum += type->mass_per_metre * type->length;
    }
    return sum;
}

static void total_mass_and_first_moment(void **state)
{
    dmb_model *model = new_model();
    const dmb_pipe_def pipe = s1_pipe();
    const double m = 14.2050261; /* [kg/m] */
    const dmb_scene *scene;
    double mass, moment;
    (void)state;
    add_pipes(model, &pipe, 20);
    scene = compiled(model);
    weights(scene, &mass, &moment);
    assert_near(scene->mass, 30.0 * m, 1e-7);
    assert_near(mass, scene->mass, 1e-14);
    assert_near(moment, mass * 15.0, 1e-14);
    assert_near(element_mass(scene), scene->mass, 1e-14);
    assert_int_equal(scene->rigid_mass_count, 0);
    /* +- m L/12 at the ends of the string, nothing between */
    assert_near(scene->weight_moment[0], m * 1.5 * 1.5 / 12.0, 1e-7);
    assert_near(scene->weight_moment[3 * 20], -m * 1.5 * 1.5 / 12.0, 1e-7);
    assert_close(scene->weight_moment[3 * 7], 0.0, 1e-12);
    assert_near(scene->weight_mass[7], m * 1.5, 1e-7);
    assert_near(scene->gravity[2], -9.81, 0.0);
    dmb_model_destroy(&model);
}

/* Joints, rigid pipes, rig head and bit: mass and first moment are those of the drawing, however it is meshed. */
static void every_part_is_weighed(void **state)
{
    dmb_pipe_def pipe = s1_pipe();
    dmb_body_def head = dmb_body_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    (void)state;
    pipe.joint_length = 0.2;
    pipe.joint_outer_diameter = 0.085;
    pipe.joint_inner_diameter = 0.04;
    head.attach = DMB_ATTACH_START;
    head.mass = 150.0;
    head.centre[0] = -0.4;
    for (int32_t kinds = 0; kinds < 8; ++kinds) { /* each of three runs flexible or rigid */
        dmb_model *model = new_model();
        const dmb_scene *scene;
        double mass, moment, joint, body, expected = 0.0, expected_moment = 0.0;
        for (int run = 0; run < 3; ++run) {
            pipe.kind = kinds >> run & 1 ? DMB_PIPE_RIGID : DMB_PIPE_FLEXIBLE;
            pipe.elements = (uint32_t)run + 1;
            add_pipes(model, &pipe, 2);
        }
        assert_ok(dmb_model_add_body(model, &head, NULL));
        assert_ok(dmb_model_add_bit(model, &bit, NULL));
        joint = 7850.0 * acos(-1.0) / 4.0 * (0.085 * 0.085 - 0.04 * 0.04) * 0.2;
        body = 7850.0 * acos(-1.0) / 4.0 * (0.073 * 0.073 - 0.055 * 0.055) * 1.3;
        for (int i = 0; i < 6; ++i) {
            expected += joint + body;
            expected_moment += body * (1.5 * i + 0.65) + joint * (1.5 * i + 1.4);
        }
        expected += 150.0 + 5.0;
        expected_moment += 150.0 * -0.4 + 5.0 * 9.05;
        scene = compiled(model);
        weights(scene, &mass, &moment);
        assert_near(scene->mass, expected, 1e-14);
        assert_near(mass, expected, 1e-14);
        assert_near(moment, expected_moment, 1e-13);
        assert_near(rigid_mass_mass(scene) + element_mass(scene), expected, 1e-14);
        for (uint32_t i = 1; i < scene->rigid_mass_count; ++i)
            assert_true(scene->rigid_masses[i - 1].node < scene->rigid_masses[i].node);
        dmb_model_destroy(&model);
    }
}

/* A rigid start with its node at the rig end: the first element stands off its node. */
static void weight_beyond_an_arm(void **state)
{
    dmb_model *model = new_model();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    const dmb_scene *scene;
    double mass, moment;
    (void)state;
    string.start_free = DMB_FREE_SPHERICAL;
    assert_ok(dmb_model_add_string(model, &string, NULL));
    pipe.kind = DMB_PIPE_RIGID;
    add_pipes(model, &pipe, 2);
    pipe.kind = DMB_PIPE_FLEXIBLE;
    pipe.eccentricity = 1e-3;
    add_pipes(model, &pipe, 3);
    scene = compiled(model);
    weights(scene, &mass, &moment);
    assert_near(scene->types[0].arm[0], 3.0, 0.0);
    assert_near(moment, mass * 3.75, 1e-14);
    /* product of inertia of the eccentric half element 3 m ahead of the node */
    assert_near(scene->rigid_masses[0].inertia[3], -0.75 * 14.2050261 * 3.0 * 1e-3, 1e-7);
    dmb_model_destroy(&model);
}

/* J about the node from J of the centre (eq:motion.rigid-mass). */
static void rigid_mass_is_the_spatial_inertia(void **state)
{
    dmb_rigid_mass rigid_mass = {0};
    const double c[3] = {0.5, -0.2, 0.1}, J[6] = {1.0, 2.0, 3.0, 0.1, 0.2, 0.3}, e[2] = {0.003, -0.004};
    dmb_rigid_mass direct = {0}, shifted = {0};
    const double at[3] = {0.7, 0.0, 0.0}, moved[3] = {0.7, 0.003, -0.004}, none[6] = {0};
    (void)state;
    dmb_rigid_mass_add(&rigid_mass, 4.0, c, J);
    assert_near(rigid_mass.mass, 4.0, 0.0);
    assert_near(rigid_mass.moment[1], -0.8, 1e-15);
    assert_near(rigid_mass.inertia[0], 1.0 + 4.0 * 0.05, 1e-15);
    assert_near(rigid_mass.inertia[1], 2.0 + 4.0 * 0.26, 1e-15);
    assert_near(rigid_mass.inertia[3], 0.1 + 4.0 * 0.1, 1e-15);
    assert_near(rigid_mass.inertia[5], 0.3 + 4.0 * 0.02, 1e-15);
    dmb_rigid_mass_add(&direct, 4.0, moved, none);
    dmb_rigid_mass_add(&shifted, 4.0, at, none);
    dmb_rigid_mass_shift(&shifted, 4.0, 0.7, e);
    for (int i = 0; i < 3; ++i) assert_close(shifted.moment[i], direct.moment[i], 1e-15);
    for (int i = 0; i < 6; ++i) assert_close(shifted.inertia[i], direct.inertia[i], 1e-15);
}

/* One rigid body out of many pipes has the inertia of one long tube. */
static void merged_pipes_are_one_tube(void **state)
{
    dmb_model *model = new_model();
    dmb_pipe_def pipe = s1_pipe();
    const dmb_scene *scene;
    const double ro = 0.0365, ri = 0.0275, m = 14.2050261 * 15.0;
    (void)state;
    pipe.kind = DMB_PIPE_RIGID;
    add_pipes(model, &pipe, 10);
    scene = compiled(model);
    assert_int_equal(scene->rigid_mass_count, 1);
    assert_near(scene->rigid_masses[0].mass, m, 1e-7);
    assert_near(scene->rigid_masses[0].moment[0], m * 7.5, 1e-7);
    assert_near(scene->rigid_masses[0].inertia[0], m * (ro * ro + ri * ri) / 2.0, 1e-7);
    assert_near(scene->rigid_masses[0].inertia[1], m * ((ro * ro + ri * ri) / 4.0 + 15.0 * 15.0 / 3.0), 1e-7);
    dmb_model_destroy(&model);
}

static void buoyancy_takes_from_pipes_and_joints(void **state)
{
    dmb_model *model = new_model();
    dmb_pipe_def pipe = s1_pipe();
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_body_def head = dmb_body_def_default();
    const dmb_scene *scene;
    double mass, moment;
    (void)state;
    environment.fluid_density = 1200.0;
    assert_ok(dmb_model_set_environment(model, &environment));
    pipe.joint_length = 0.2;
    pipe.joint_mass = 9.0;
    add_pipes(model, &pipe, 3);
    pipe.kind = DMB_PIPE_RIGID;
    add_pipes(model, &pipe, 2);
    head.attach = DMB_ATTACH_START;
    head.mass = 100.0;
    assert_ok(dmb_model_add_body(model, &head, NULL));
    scene = compiled(model);
    weights(scene, &mass, &moment);
    assert_near(mass, (scene->mass - 100.0) * (1.0 - 1200.0 / 7850.0) + 100.0, 1e-14);
    dmb_model_destroy(&model);
}

static const dmb_scene *eccentric_scene(dmb_model **model, double spread, double angle_spread, uint32_t seed,
                                        int32_t features)
{
    dmb_pipe_def pipe = s1_pipe();
    pipe.eccentricity = 1e-3;
    pipe.eccentricity_angle = 0.5;
    pipe.eccentricity_spread = spread;
    pipe.angle_spread = angle_spread;
    pipe.seed = seed;
    *model = new_model();
    add_pipes(*model, &pipe, 5);
    return compiled_with(*model, features, -1);
}

/* Half of each element's mass times the offset on each node; types stay shared; no mass is added. */
static void eccentric_rigid_masses(void **state)
{
    dmb_model *model;
    const dmb_scene *scene = eccentric_scene(&model, 0.0, 0.0, 1, DMB_FEATURE_ALL);
    const double half = 0.5 * 1.5 * 14.2050261, ey = 1e-3 * cos(0.5), ez = 1e-3 * sin(0.5);
    (void)state;
    assert_int_equal(scene->rigid_mass_count, 6);
    assert_int_equal(scene->type_count, 1);
    assert_int_equal(scene->rigid_count, 0);
    for (uint32_t i = 0; i < 6; ++i) {
        const dmb_rigid_mass *rigid_mass = &scene->rigid_masses[i];
        const double m = i == 0 || i == 5 ? half : 2.0 * half;
        assert_int_equal(rigid_mass->node, i);
        assert_near(rigid_mass->mass, 0.0, 0.0);
        assert_near(rigid_mass->moment[0], 0.0, 0.0);
        assert_near(rigid_mass->moment[1], m * ey, 1e-7);
        assert_near(rigid_mass->moment[2], m * ez, 1e-7);
        assert_near(rigid_mass->inertia[0], m * 1e-6, 1e-7);
        assert_near(rigid_mass->inertia[1], m * ez * ez, 1e-7);
        assert_near(rigid_mass->inertia[5], -m * ey * ez, 1e-7);
        assert_near(scene->weight_moment[3 * i + 1], m * ey, 1e-7);
    }
    dmb_model_destroy(&model);
    scene = eccentric_scene(&model, 0.0, 0.0, 1, DMB_FEATURE_ALL & ~DMB_FEATURE_ECCENTRICITY);
    assert_int_equal(scene->rigid_mass_count, 0);
    assert_int_equal(scene->features & DMB_FEATURE_ECCENTRICITY, 0);
    dmb_model_destroy(&model);
}

/* The centre of mass of an eccentric pipe with a joint, flexible or rigid, is at its eccentricity. */
static void eccentric_joints_too(void **state)
{
    (void)state;
    for (int rigid = 0; rigid < 2; ++rigid) {
        dmb_pipe_def pipe = s1_pipe();
        dmb_model *model = new_model();
        const dmb_scene *scene;
        double sum = 0.0;
        pipe.kind = rigid ? DMB_PIPE_RIGID : DMB_PIPE_FLEXIBLE;
        pipe.joint_length = 0.3;
        pipe.joint_mass = 12.0;
        pipe.eccentricity = 2e-3;
        add_pipes(model, &pipe, 1);
        scene = compiled(model);
        for (uint32_t i = 0; i < scene->rigid_mass_count; ++i) sum += scene->rigid_masses[i].moment[1];
        assert_near(sum, scene->mass * 2e-3, 1e-14);
        dmb_model_destroy(&model);
    }
}

static void random_eccentricity_is_reproducible(void **state)
{
    dmb_model *a, *b, *c;
    const dmb_scene *sa = eccentric_scene(&a, 5e-4, 3.0, 7, DMB_FEATURE_ALL);
    const dmb_scene *sb = eccentric_scene(&b, 5e-4, 3.0, 7, DMB_FEATURE_ALL);
    const dmb_scene *sc = eccentric_scene(&c, 5e-4, 3.0, 8, DMB_FEATURE_ALL);
    (void)state;
    assert_memory_equal(sa->rigid_masses, sb->rigid_masses, 6 * sizeof(dmb_rigid_mass));
    assert_memory_not_equal(sa->rigid_masses, sc->rigid_masses, 6 * sizeof(dmb_rigid_mass));
    dmb_model_destroy(&a);
    dmb_model_destroy(&b);
    dmb_model_destroy(&c);
}

static void random_eccentricity_is_uniform(void **state)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    const uint32_t n = 100000;
    double mean = 0.0, square = 0.0, low = 1.0, high = 0.0;
    (void)state;
    pipe.eccentricity = 2e-3;
    pipe.eccentricity_spread = 1e-3;
    for (uint32_t i = 0; i < n; ++i) {
        double e[2];
        dmb_pipe_offset(&pipe, i, e);
        const double r = sqrt(e[0] * e[0] + e[1] * e[1]);
        mean += r / n;
        square += (r - 2e-3) * (r - 2e-3) / n;
        low = fmin(low, r);
        high = fmax(high, r);
    }
    assert_true(low >= 1e-3 - 1e-15 && high <= 3e-3 + 1e-15);
    assert_close(mean, 2e-3, 1e-5);
    assert_near(square, 1e-6 / 3.0, 1e-2);
    pipe.eccentricity = 0.0; /* half of the draws are cut at 0 */
    uint32_t zeros = 0;
    for (uint32_t i = 0; i < n; ++i) {
        double e[2];
        dmb_pipe_offset(&pipe, i, e);
        zeros += e[0] * e[0] + e[1] * e[1] > 0.0 ? 0 : 1;
    }
    assert_true(zeros > 49000 && zeros < 51000);
}

static void external_damping_goes_by_length(void **state)
{
    dmb_model *model = new_model();
    dmb_pipe_def pipe = s1_pipe();
    dmb_environment_def environment = dmb_environment_def_default();
    const dmb_scene *scene;
    double sum = 0.0;
    (void)state;
    environment.lateral_damping = 10.0;
    environment.axial_damping = 2.0;
    environment.torsional_damping = 0.5;
    assert_ok(dmb_model_set_environment(model, &environment));
    pipe.joint_length = 0.2;
    pipe.elements = 2;
    add_pipes(model, &pipe, 4);
    pipe.kind = DMB_PIPE_RIGID;
    add_pipes(model, &pipe, 3);
    scene = compiled(model);
    assert_int_equal(scene->features & DMB_FEATURE_DAMPING, DMB_FEATURE_DAMPING);
    assert_near(scene->node_damping[0], 2.0 * 0.325, 1e-14);
    assert_near(scene->node_damping[5 + 2], 10.0 * (0.325 + 0.325), 1e-14);
    for (uint32_t i = 0; i < scene->node_count; ++i) sum += scene->node_damping[5 * i + 1];
    assert_near(sum, 0.5 * 10.5, 1e-14);
    dmb_model_destroy(&model);
}

static void what_is_left_out_is_not_there(void **state)
{
    dmb_model *model = new_model();
    dmb_pipe_def pipe = s1_pipe();
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    const dmb_scene *scene;
    (void)state;
    environment.lateral_damping = 10.0;
    assert_ok(dmb_model_set_environment(model, &environment));
    add_wall(model);
    pipe.damping_time = 1e-4;
    pipe.eccentricity = 1e-3;
    add_pipes(model, &pipe, 4);
    drive.time_function = drive.excitation = add_constant(model, 1.0);
    assert_ok(dmb_model_add_drive(model, &drive, NULL));
    bit.rock_law = DMB_ROCK_REGENERATIVE;
    assert_ok(dmb_model_add_bit(model, &bit, NULL));
    scene = compiled_with(model, 0, -1);
    assert_int_equal(scene->features, 0);
    assert_near(scene->gravity[2], 0.0, 0.0);
    assert_int_equal(scene->site_count, 0);
    assert_int_equal(scene->axial_torsional_site_count, 0);
    assert_int_equal(scene->normal_law.kind, DMB_NORMAL_NONE);
    assert_int_equal(scene->friction_law.kind, DMB_FRICTION_NONE);
    assert_near(scene->types[0].damping_time, 0.0, 0.0);
    assert_near(scene->node_damping[1], 0.0, 0.0);
    assert_int_equal(scene->drives[0].excitation, DMB_NONE);
    assert_int_equal(scene->bits[0].law.kind, DMB_ROCK_NONE);
    assert_int_equal(scene->history_count, 0);
    assert_int_equal(scene->rigid_mass_count, 1); /* the bit */
    dmb_model_destroy(&model);
}

/* All features are asked for; none is described. */
static void what_is_not_described_is_not_there(void **state)
{
    dmb_model *model = new_model();
    const dmb_pipe_def pipe = s1_pipe();
    dmb_environment_def environment = dmb_environment_def_default();
    const dmb_scene *scene;
    (void)state;
    environment.gravity[2] = 0.0;
    assert_ok(dmb_model_set_environment(model, &environment));
    add_pipes(model, &pipe, 4);
    scene = compiled(model);
    assert_int_equal(scene->features, 0);
    assert_int_equal(scene->has_hole, 0);
    dmb_model_destroy(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(total_mass_and_first_moment),
        TEST(every_part_is_weighed),
        TEST(weight_beyond_an_arm),
        TEST(rigid_mass_is_the_spatial_inertia),
        TEST(merged_pipes_are_one_tube),
        TEST(buoyancy_takes_from_pipes_and_joints),
        TEST(eccentric_rigid_masses),
        TEST(eccentric_joints_too),
        TEST(random_eccentricity_is_reproducible),
        TEST(random_eccentricity_is_uniform),
        TEST(external_damping_goes_by_length),
        TEST(what_is_left_out_is_not_there),
        TEST(what_is_not_described_is_not_there),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
