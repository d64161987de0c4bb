/* Every T_init against the headers' words. */
#include "model_test.h"

#include "drillmbd/analyse.h"

#define EVERY_STRUCT(X)    \
    X(dmb_allocator)       \
    X(dmb_model_options)   \
    X(dmb_environment_def) \
    X(dmb_segment)         \
    X(dmb_wall_def)        \
    X(dmb_string_def)      \
    X(dmb_pipe_def)        \
    X(dmb_body_def)        \
    X(dmb_bit_def)         \
    X(dmb_joint_def)       \
    X(dmb_coupling_def)    \
    X(dmb_constraint_def)  \
    X(dmb_drive_def)       \
    X(dmb_load_def)        \
    X(dmb_compile_options) \
    X(dmb_model_info)      \
    X(dmb_sim_options)     \
    X(dmb_step_report)     \
    X(dmb_pose)            \
    X(dmb_motion)          \
    X(dmb_section)         \
    X(dmb_contact)         \
    X(dmb_contact_total)   \
    X(dmb_energy)          \
    X(dmb_momentum)        \
    X(dmb_drive_state)     \
    X(dmb_joint_state)     \
    X(dmb_bit_state)       \
    X(dmb_statistics)      \
    X(dmb_recorder)        \
    X(dmb_static_options)  \
    X(dmb_static_report)

/* struct_size is told, a wrong size and NULL are refused, and no byte beyond the size is written. */
#define CHECK_STRUCT(T)                                                                      \
    do {                                                                                     \
        union {                                                                              \
            T object;                                                                        \
            unsigned char bytes[sizeof(T) + 16];                                             \
        } u;                                                                                 \
        memset(u.bytes, 0xA5, sizeof u.bytes);                                               \
        assert_ok(T##_init(&u.object, (uint32_t)sizeof(T)));                                 \
        assert_int_equal(u.object.struct_size, sizeof(T));                                   \
        assert_int_equal(u.bytes[sizeof(T)], 0xA5);                                          \
        assert_ok(T##_init(&u.object, (uint32_t)sizeof(T) + 8));                             \
        assert_int_equal(u.bytes[sizeof(T) + 7], 0);                                         \
        assert_int_equal(u.bytes[sizeof(T) + 8], 0xA5);                                      \
        assert_int_equal(T##_init(&u.object, (uint32_t)sizeof(T) - 4), DMB_ERR_STRUCT_SIZE); \
        assert_int_equal(T##_init(&u.object, 0), DMB_ERR_STRUCT_SIZE);                       \
        assert_int_equal(T##_init(NULL, (uint32_t)sizeof(T)), DMB_ERR_NULL);                 \
        const T given = T##_default();                                                       \
        assert_int_equal(given.struct_size, sizeof(T));                                      \
    } while (0);

static void sizes(void **state)
{
    (void)state;
    EVERY_STRUCT(CHECK_STRUCT)
}

static void surroundings(void **state)
{
    const dmb_environment_def e = dmb_environment_def_default();
    const dmb_segment t = dmb_segment_default();
    (void)state;
    assert_near(e.gravity[2], -9.81, 0.0);
    assert_near(e.fluid_density + e.lateral_damping + e.axial_damping + e.torsional_damping, 0.0, 0.0);
    assert_int_equal(t.kind, DMB_SEGMENT_CONSTANT);
    assert_near(t.x0, 0.0, 0.0);
    assert_near(t.x1, 1.0, 0.0);
    assert_near(t.h0 + t.h1 + t.omega + t.phase, 0.0, 0.0);
    assert_null(t.callback);
}

static void wall(void **state)
{
    const dmb_wall_def w = dmb_wall_def_default();
    (void)state;
    assert_int_equal(w.survey_count, 0);
    assert_null(w.survey);
    assert_near(w.direction[0], 1.0, 0.0);
    assert_near(w.diameter, 0.094, 0.0);
    assert_int_equal(w.normal_law, DMB_NORMAL_EXACT);
    assert_int_equal(w.friction_law, DMB_FRICTION_STRIBECK);
    assert_near(w.stiffness, 1e7, 0.0);
    assert_near(w.exponent, 1.0, 0.0);
    assert_near(w.restitution, 0.4, 0.0);
    assert_near(w.damping, 0.0, 0.0);
    assert_near(w.impact_depth, 1e-4, 0.0);
    assert_near(w.approach_speed, 0.01, 0.0);
    assert_near(w.mu_static, 0.35, 0.0);
    assert_near(w.mu_dynamic, 0.30, 0.0);
    assert_near(w.stribeck_speed, 1e-2, 0.0);
    assert_near(w.smoothing_speed, 1e-3, 0.0);
    assert_near(w.full_speed, 1e-2, 0.0);
    assert_near(w.bristle_stiffness, 1e4, 0.0);
    assert_near(w.bristle_damping, 0.0, 0.0);
}

static void strings_and_pipes(void **state)
{
    const dmb_string_def s = dmb_string_def_default();
    const dmb_pipe_def p = dmb_pipe_def_default();
    (void)state;
    assert_int_equal(s.follows_hole, 1);
    assert_int_equal(s.start_free, DMB_FREE_CYLINDRICAL);
    assert_int_equal(s.end_free, DMB_FREE_ALL);
    assert_int_equal(p.kind, DMB_PIPE_FLEXIBLE);
    assert_int_equal(p.elements, 1);
    assert_int_equal(p.seed, 1);
    assert_near(p.length, 1.0, 0.0);
    assert_near(p.outer_diameter, 0.073, 0.0);
    assert_near(p.inner_diameter, 0.061, 0.0);
    assert_near(p.young_modulus, 2.1e11, 0.0);
    assert_near(p.poisson_ratio, 0.3, 0.0);
    assert_near(p.density, 7850.0, 0.0);
    assert_near(p.shear_factor, 0.5, 0.0);
    assert_near(p.damping_time + p.joint_length + p.joint_mass + p.eccentricity + p.section_mass, 0.0, 0.0);
}

static void bodies_and_bits(void **state)
{
    const dmb_body_def b = dmb_body_def_default();
    const dmb_bit_def t = dmb_bit_def_default();
    (void)state;
    assert_int_equal(b.attach, DMB_ATTACH_NONE);
    assert_near(b.mass, 1.0, 0.0);
    assert_near(b.inertia[0] + b.inertia[1] + b.inertia[2], 3e-3, 1e-15);
    assert_int_equal(b.free_mask, DMB_FREE_ALL);
    assert_near(b.contact_diameter, 0.0, 0.0);
    assert_near(b.contact_length, 1.0, 0.0);
    assert_int_equal(t.rock_law, DMB_ROCK_NONE);
    assert_near(t.mass, 5.0, 0.0);
    assert_near(t.diameter, 0.092, 0.0);
    assert_near(t.length, 0.1, 0.0);
    assert_near(t.radius, 0.047, 0.0);
    assert_near(t.intrinsic_energy, 1e7, 0.0);
    assert_near(t.cutting_ratio, 0.6, 0.0);
    assert_near(t.contact_strength, 1e7, 0.0);
    assert_near(t.wear_length, 1e-3, 0.0);
    assert_near(t.contact_friction, 0.5, 0.0);
    assert_near(t.intrusion_depth, 1e-4, 0.0);
    assert_near(t.bottom, 0.0, 0.0);
    assert_int_equal(t.blades, 4);
    assert_int_equal(t.history, 1024);
}

static void joints(void **state)
{
    const dmb_joint_def j = dmb_joint_def_default();
    (void)state;
    assert_int_equal(j.kind, DMB_JOINT_FIXED);
    assert_string_equal(j.name, "");
    assert_int_equal(j.place_a.part.generation, 0);
    assert_near(j.axis_a[0], 1.0, 0.0);
    assert_near(j.axis_b[0], 1.0, 0.0);
    assert_int_equal(j.match, 0);
    assert_int_equal(j.state, DMB_JOINT_ACTIVE);
    assert_near(j.length, 1.0, 0.0);
    assert_near(j.friction_speed, 1e-3, 0.0);
    assert_near(j.stop_stiffness, 1e6, 0.0);
    assert_near(j.stop_damping, 0.0, 0.0);
    assert_int_equal(j.initial_mask, DMB_FREE_NONE);
    for (int k = 0; k < 6; ++k) {
        assert_near(j.stiffness[k] + j.damping[k] + j.rest[k] + j.friction[k], 0.0, 0.0);
        assert_near(j.stop_low[k], -1e30, 0.0);
        assert_near(j.stop_high[k], 1e30, 0.0);
        assert_near(j.initial_position[k] + j.initial_speed[k], 0.0, 0.0);
    }
}

static void couplings_and_constraints(void **state)
{
    const dmb_coupling_def c = dmb_coupling_def_default();
    const dmb_constraint_def f = dmb_constraint_def_default();
    (void)state;
    assert_int_equal(c.component[0], DMB_RX);
    assert_int_equal(c.component[1], DMB_RX);
    assert_near(c.ratio, 1.0, 0.0);
    assert_int_equal(f.kind, DMB_CONSTRAINT_HOLONOMIC);
    assert_int_equal(f.row_count, 1);
    assert_int_equal(f.place_count, 1);
    assert_int_equal(f.provides, 0);
    assert_null(f.callback);
}

static void actions_and_options(void **state)
{
    const dmb_drive_def d = dmb_drive_def_default();
    const dmb_load_def l = dmb_load_def_default();
    const dmb_compile_options c = dmb_compile_options_default();
    (void)state;
    assert_int_equal(d.kind, DMB_DRIVE_MOTION);
    assert_int_equal(d.component, DMB_X);
    assert_near(d.gain + d.integral_gain, 0.0, 0.0);
    assert_near(d.limit_low, -1e30, 0.0);
    assert_near(d.limit_high, 1e30, 0.0);
    assert_int_equal(l.frame, DMB_FRAME_WORLD);
    assert_int_equal(c.features, DMB_FEATURE_ALL);
    assert_int_equal(c.pipe_kind, -1);
}

static void runs_and_analyses(void **state)
{
    const dmb_sim_options s = dmb_sim_options_default();
    const dmb_static_options a = dmb_static_options_default();
    (void)state;
    assert_int_equal(s.max_iterations, 12);
    assert_null(s.allocator);
    assert_near(s.spectral_radius, 0.8, 0.0);
    assert_near(s.newton_tolerance, 0.0, 0.0);
    assert_near(s.tolerance_translation, 1e-6, 0.0);
    assert_near(s.tolerance_rotation, 1e-5, 0.0);
    assert_near(s.step_min, 1e-9, 0.0);
    assert_near(s.step_max, 0.1, 0.0);
    assert_int_equal(s.max_cuts, 12);
    assert_int_equal(s.bounded_work, 0);
    assert_int_equal(s.energy_ledger, 1);
    assert_int_equal(s.constraint_method, DMB_METHOD_INDEPENDENT);
    assert_int_equal(a.max_iterations, 60);
    assert_near(a.tolerance, 1e-10, 0.0);
    assert_int_equal(a.load_steps, 0);
    assert_int_equal(a.lay_on_wall, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(sizes),
        TEST(surroundings),
        TEST(wall),
        TEST(strings_and_pipes),
        TEST(bodies_and_bits),
        TEST(joints),
        TEST(couplings_and_constraints),
        TEST(actions_and_options),
        TEST(runs_and_analyses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
