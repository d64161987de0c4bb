/* Nonsense in every field of every definition: a clean status and a message, or a scene that is finite throughout; and
 * the model goes on unharmed either way. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include <float.h>
#include <math.h>

#include "base/value_check.h"
#include "drillmbd/scene.h"
#include "model/model.h"

/* ---- What there is to describe ----------------------------------------------------------------------------------- */

enum { REAL = 0, WHOLE = 1, COUNT = 2 }; /* double, int32_t, uint32_t */

typedef struct field {
    const char *name;
    size_t offset;
    int type;
    int size;
} field;

typedef union any_def {
    uint32_t struct_size;
    dmb_environment_def environment;
    dmb_segment term;
    dmb_wall_def wall;
    dmb_hole_section section;
    dmb_string_def string;
    dmb_pipe_def pipe;
    dmb_body_def body;
    dmb_bit_def bit;
    dmb_drive_def drive;
    dmb_load_def load;
    dmb_joint_def joint;
    dmb_coupling_def coupling;
    dmb_constraint_def constraint;
    dmb_spring_def spring;
    dmb_force_def force;
    dmb_stuck_def stuck;
    dmb_stabiliser_def ring;
} any_def;

/* A model that every definition fits into, and the ids it needs. */
typedef struct scene_under_test {
    dmb_model *model;
    dmb_id string, time_function;
} scene_under_test;

static scene_under_test begin(int with_wall)
{
    scene_under_test s;
    const dmb_wall_def wall = dmb_wall_def_default();
    const dmb_string_def string = dmb_string_def_default();
    const dmb_segment term = dmb_segment_default();
    memset(&s, 0, sizeof s);
    assert_int_equal(dmb_model_create(NULL, &s.model), DMB_OK);
    if (with_wall) assert_int_equal(dmb_model_add_wall(s.model, &wall, NULL), DMB_OK);
    assert_int_equal(dmb_model_add_string(s.model, &string, &s.string), DMB_OK);
    assert_int_equal(dmb_model_add_time_function(s.model, &term, 1, &s.time_function), DMB_OK);
    return s;
}

static void add_one_pipe(scene_under_test *s)
{
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    assert_int_equal(dmb_model_add_pipes(s->model, &pipe, 1, NULL), DMB_OK);
}

typedef struct kind_of_def {
    const char *name;
    const field *fields;
    size_t field_count;
    void (*fill)(const scene_under_test *s, any_def *def);
    int32_t (*add)(dmb_model *model, const any_def *def);
} kind_of_def;

#define F(T, member, type, size)                     \
    {                                                \
#member, offsetof(T, member), (type), (size) \
    }
#define FIELDS(array) array, sizeof array / sizeof array[0]

static const field environment_fields[] = {
    F(dmb_environment_def, reserved, COUNT, 1),     F(dmb_environment_def, gravity, REAL, 3),
    F(dmb_environment_def, fluid_density, REAL, 1), F(dmb_environment_def, lateral_damping, REAL, 1),
    F(dmb_environment_def, axial_damping, REAL, 1), F(dmb_environment_def, torsional_damping, REAL, 1),
    F(dmb_environment_def, inner_density, REAL, 1), F(dmb_environment_def, added_mass, REAL, 1),
    F(dmb_environment_def, flow_rate, REAL, 1),     F(dmb_environment_def, consistency, REAL, 1),
    F(dmb_environment_def, flow_exponent, REAL, 1), F(dmb_environment_def, yield_stress, REAL, 1),
    F(dmb_environment_def, nozzle_area, REAL, 1),   F(dmb_environment_def, flow_eccentricity, REAL, 1)};
static void fill_environment(const scene_under_test *s, any_def *def)
{
    (void)s;
    def->environment = dmb_environment_def_default();
}
static int32_t add_environment(dmb_model *model, const any_def *def)
{
    return dmb_model_set_environment(model, &def->environment);
}

static const field segment_fields[] = {
    F(dmb_segment, kind, WHOLE, 1),        F(dmb_segment, x0, REAL, 1),       F(dmb_segment, x1, REAL, 1),
    F(dmb_segment, h0, REAL, 1),           F(dmb_segment, h1, REAL, 1),       F(dmb_segment, omega, REAL, 1),
    F(dmb_segment, share, REAL, 1),        F(dmb_segment, order, REAL, 1),    F(dmb_segment, phase, REAL, 1),
    F(dmb_segment, table_count, COUNT, 1), F(dmb_segment, provides, WHOLE, 1)};
static void fill_segment(const scene_under_test *s, any_def *def)
{
    (void)s;
    def->term = dmb_segment_default();
    def->term.kind = DMB_SEGMENT_STEP;
}
static void fill_table(const scene_under_test *s, any_def *def)
{
    static const double time[] = {0.0, 1.0}, value[] = {1.0, 2.0};
    fill_segment(s, def);
    def->term.kind = DMB_SEGMENT_TABLE;
    def->term.table_time = time;
    def->term.table_value = value;
    def->term.table_count = 2;
}
static int32_t add_segment(dmb_model *model, const any_def *def)
{
    /* the table is only as long as it is: larger counts are the caller's lie, and no library can see it */
    if (def->term.kind == DMB_SEGMENT_TABLE && def->term.table_count > 2 && def->term.table_count <= 1u << 20)
        return DMB_OK;
    return dmb_model_add_time_function(model, &def->term, 1, NULL);
}

static const field wall_fields[] = {
    F(dmb_wall_def, survey_count, COUNT, 1),   F(dmb_wall_def, origin, REAL, 3),
    F(dmb_wall_def, direction, REAL, 3),       F(dmb_wall_def, diameter, REAL, 1),
    F(dmb_wall_def, normal_law, WHOLE, 1),     F(dmb_wall_def, friction_law, WHOLE, 1),
    F(dmb_wall_def, stiffness, REAL, 1),       F(dmb_wall_def, exponent, REAL, 1),
    F(dmb_wall_def, restitution, REAL, 1),     F(dmb_wall_def, damping, REAL, 1),
    F(dmb_wall_def, impact_depth, REAL, 1),    F(dmb_wall_def, approach_speed, REAL, 1),
    F(dmb_wall_def, mu_static, REAL, 1),       F(dmb_wall_def, mu_dynamic, REAL, 1),
    F(dmb_wall_def, stribeck_speed, REAL, 1),  F(dmb_wall_def, smoothing_speed, REAL, 1),
    F(dmb_wall_def, full_speed, REAL, 1),      F(dmb_wall_def, bristle_stiffness, REAL, 1),
    F(dmb_wall_def, bristle_damping, REAL, 1), F(dmb_wall_def, friction_table_count, COUNT, 1)};
static void fill_wall(const scene_under_test *s, any_def *def)
{
    (void)s;
    def->wall = dmb_wall_def_default();
}
static int32_t add_wall(dmb_model *model, const any_def *def)
{
    return dmb_model_add_wall(model, &def->wall, NULL);
}

static const field section_fields[] = {
    F(dmb_hole_section, shape, WHOLE, 1),     F(dmb_hole_section, depth, REAL, 1),
    F(dmb_hole_section, transition, REAL, 1), F(dmb_hole_section, diameter, REAL, 1),
    F(dmb_hole_section, stiffness, REAL, 1),  F(dmb_hole_section, restitution, REAL, 1),
    F(dmb_hole_section, damping, REAL, 1),    F(dmb_hole_section, mu_static, REAL, 1),
    F(dmb_hole_section, mu_dynamic, REAL, 1), F(dmb_hole_section, strength, REAL, 1)};
static void fill_section(const scene_under_test *s, any_def *def)
{
    (void)s;
    def->section = dmb_hole_section_default();
}
static int32_t add_section(dmb_model *model, const any_def *def)
{
    return dmb_model_add_hole_sections(model, &def->section, 1);
}

static const field string_fields[] = {
    F(dmb_string_def, follows_hole, WHOLE, 1), F(dmb_string_def, start_depth, REAL, 1),
    F(dmb_string_def, offset, REAL, 2),        F(dmb_string_def, position, REAL, 3),
    F(dmb_string_def, rotation, REAL, 3),      F(dmb_string_def, velocity, REAL, 6),
    F(dmb_string_def, start_free, WHOLE, 1),   F(dmb_string_def, end_free, WHOLE, 1)};
static void fill_string(const scene_under_test *s, any_def *def)
{
    (void)s;
    def->string = dmb_string_def_default();
    def->string.follows_hole = 0;
}
static int32_t add_string(dmb_model *model, const any_def *def)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    const int32_t status = dmb_model_add_string(model, &def->string, &pipe.string);
    return status < 0 ? status : dmb_model_add_pipes(model, &pipe, 2, NULL);
}

static const field pipe_fields[] = {F(dmb_pipe_def, kind, WHOLE, 1),
                                    F(dmb_pipe_def, string.index, COUNT, 1),
                                    F(dmb_pipe_def, string.generation, COUNT, 1),
                                    F(dmb_pipe_def, elements, COUNT, 1),
                                    F(dmb_pipe_def, seed, COUNT, 1),
                                    F(dmb_pipe_def, length, REAL, 1),
                                    F(dmb_pipe_def, outer_diameter, REAL, 1),
                                    F(dmb_pipe_def, inner_diameter, REAL, 1),
                                    F(dmb_pipe_def, young_modulus, REAL, 1),
                                    F(dmb_pipe_def, poisson_ratio, REAL, 1),
                                    F(dmb_pipe_def, density, REAL, 1),
                                    F(dmb_pipe_def, shear_factor, REAL, 1),
                                    F(dmb_pipe_def, damping_time, REAL, 1),
                                    F(dmb_pipe_def, joint_length, REAL, 1),
                                    F(dmb_pipe_def, joint_outer_diameter, REAL, 1),
                                    F(dmb_pipe_def, joint_inner_diameter, REAL, 1),
                                    F(dmb_pipe_def, joint_mass, REAL, 1),
                                    F(dmb_pipe_def, joint_inertia, REAL, 2),
                                    F(dmb_pipe_def, eccentricity, REAL, 1),
                                    F(dmb_pipe_def, eccentricity_angle, REAL, 1),
                                    F(dmb_pipe_def, eccentricity_spread, REAL, 1),
                                    F(dmb_pipe_def, angle_spread, REAL, 1),
                                    F(dmb_pipe_def, curvature, REAL, 3),
                                    F(dmb_pipe_def, section_stiffness, REAL, 6),
                                    F(dmb_pipe_def, section_mass, REAL, 1),
                                    F(dmb_pipe_def, section_inertia, REAL, 2)};
static void fill_pipe(const scene_under_test *s, any_def *def)
{
    def->pipe = dmb_pipe_def_default();
    def->pipe.string = s->string;
    def->pipe.joint_length = 0.1;
    def->pipe.elements = 2;
}
static int32_t add_pipe(dmb_model *model, const any_def *def)
{
    return dmb_model_add_pipes(model, &def->pipe, 3, NULL);
}

static const field body_fields[] = {F(dmb_body_def, attach, WHOLE, 1),
                                    F(dmb_body_def, string.index, COUNT, 1),
                                    F(dmb_body_def, string.generation, COUNT, 1),
                                    F(dmb_body_def, mass, REAL, 1),
                                    F(dmb_body_def, centre, REAL, 3),
                                    F(dmb_body_def, inertia, REAL, 6),
                                    F(dmb_body_def, position, REAL, 3),
                                    F(dmb_body_def, rotation, REAL, 3),
                                    F(dmb_body_def, velocity, REAL, 6),
                                    F(dmb_body_def, free_mask, WHOLE, 1),
                                    F(dmb_body_def, reserved, WHOLE, 1),
                                    F(dmb_body_def, contact_diameter, REAL, 1),
                                    F(dmb_body_def, contact_length, REAL, 1),
                                    F(dmb_body_def, displaced_volume, REAL, 1),
                                    F(dmb_body_def, added_mass, REAL, 2)};
static void fill_body(const scene_under_test *s, any_def *def)
{
    (void)s;
    def->body = dmb_body_def_default();
}
static int32_t add_body(dmb_model *model, const any_def *def)
{
    return dmb_model_add_body(model, &def->body, NULL);
}

static const field bit_fields[] = {F(dmb_bit_def, rock_law, WHOLE, 1),
                                   F(dmb_bit_def, string.index, COUNT, 1),
                                   F(dmb_bit_def, string.generation, COUNT, 1),
                                   F(dmb_bit_def, load.index, COUNT, 1),
                                   F(dmb_bit_def, load.generation, COUNT, 1),
                                   F(dmb_bit_def, mass, REAL, 1),
                                   F(dmb_bit_def, inertia, REAL, 2),
                                   F(dmb_bit_def, diameter, REAL, 1),
                                   F(dmb_bit_def, length, REAL, 1),
                                   F(dmb_bit_def, radius, REAL, 1),
                                   F(dmb_bit_def, intrinsic_energy, REAL, 1),
                                   F(dmb_bit_def, cutting_ratio, REAL, 1),
                                   F(dmb_bit_def, contact_strength, REAL, 1),
                                   F(dmb_bit_def, wear_length, REAL, 1),
                                   F(dmb_bit_def, contact_friction, REAL, 1),
                                   F(dmb_bit_def, intrusion_depth, REAL, 1),
                                   F(dmb_bit_def, stabiliser.index, COUNT, 1),
                                   F(dmb_bit_def, stabiliser.generation, COUNT, 1),
                                   F(dmb_bit_def, inner_radius, REAL, 1),
                                   F(dmb_bit_def, bottom, REAL, 1),
                                   F(dmb_bit_def, blades, COUNT, 1),
                                   F(dmb_bit_def, history, COUNT, 1),
                                   F(dmb_bit_def, side_cutting, REAL, 1),
                                   F(dmb_bit_def, walk_angle, REAL, 1),
                                   F(dmb_bit_def, added_mass, REAL, 2)};
static void fill_bit(const scene_under_test *s, any_def *def)
{
    def->bit = dmb_bit_def_default();
    def->bit.rock_law = DMB_ROCK_REGENERATIVE;
    def->bit.load = s->time_function;
}
static int32_t add_bit(dmb_model *model, const any_def *def)
{
    return dmb_model_add_bit(model, &def->bit, NULL);
}

static const field drive_fields[] = {F(dmb_drive_def, kind, WHOLE, 1),
                                     F(dmb_drive_def, part.index, COUNT, 1),
                                     F(dmb_drive_def, part.generation, COUNT, 1),
                                     F(dmb_drive_def, component, WHOLE, 1),
                                     F(dmb_drive_def, reserved, WHOLE, 1),
                                     F(dmb_drive_def, time_function.index, COUNT, 1),
                                     F(dmb_drive_def, time_function.generation, COUNT, 1),
                                     F(dmb_drive_def, excitation.index, COUNT, 1),
                                     F(dmb_drive_def, excitation.generation, COUNT, 1),
                                     F(dmb_drive_def, gain, REAL, 1),
                                     F(dmb_drive_def, integral_gain, REAL, 1),
                                     F(dmb_drive_def, limit_low, REAL, 1),
                                     F(dmb_drive_def, limit_high, REAL, 1),
                                     F(dmb_drive_def, mud_pressure, REAL, 1)};
static void fill_drive(const scene_under_test *s, any_def *def)
{
    def->drive = dmb_drive_def_default();
    def->drive.time_function = s->time_function;
}
static int32_t add_drive(dmb_model *model, const any_def *def)
{
    return dmb_model_add_drive(model, &def->drive, NULL);
}

static const field load_fields[] = {F(dmb_load_def, frame, WHOLE, 1),
                                    F(dmb_load_def, place.part.index, COUNT, 1),
                                    F(dmb_load_def, place.part.generation, COUNT, 1),
                                    F(dmb_load_def, place.pipe, COUNT, 1),
                                    F(dmb_load_def, place.reserved, COUNT, 1),
                                    F(dmb_load_def, place.fraction, REAL, 1),
                                    F(dmb_load_def, force, REAL, 3),
                                    F(dmb_load_def, moment, REAL, 3),
                                    F(dmb_load_def, time_function.index, COUNT, 1),
                                    F(dmb_load_def, time_function.generation, COUNT, 1),
                                    F(dmb_load_def, offset, REAL, 3)};
static void fill_load(const scene_under_test *s, any_def *def)
{
    def->load = dmb_load_def_default();
    def->load.place = dmb_station(s->string, 0, 1.0);
}
static int32_t add_load(dmb_model *model, const any_def *def)
{
    return dmb_model_add_load(model, &def->load, NULL);
}

#define PLACE_FIELDS(T, place)                                                                           \
    F(T, place.part.index, COUNT, 1), F(T, place.part.generation, COUNT, 1), F(T, place.pipe, COUNT, 1), \
        F(T, place.reserved, COUNT, 1), F(T, place.fraction, REAL, 1)

static const field joint_fields[] = {
    F(dmb_joint_def, kind, WHOLE, 1),          PLACE_FIELDS(dmb_joint_def, place_a),
    PLACE_FIELDS(dmb_joint_def, place_b),      F(dmb_joint_def, origin_a, REAL, 3),
    F(dmb_joint_def, axis_a, REAL, 3),         F(dmb_joint_def, normal_a, REAL, 3),
    F(dmb_joint_def, origin_b, REAL, 3),       F(dmb_joint_def, axis_b, REAL, 3),
    F(dmb_joint_def, normal_b, REAL, 3),       F(dmb_joint_def, match, WHOLE, 1),
    F(dmb_joint_def, state, WHOLE, 1),         F(dmb_joint_def, length, REAL, 1),
    F(dmb_joint_def, stiffness, REAL, 6),      F(dmb_joint_def, damping, REAL, 6),
    F(dmb_joint_def, rest, REAL, 6),           F(dmb_joint_def, friction, REAL, 6),
    F(dmb_joint_def, friction_speed, REAL, 1), F(dmb_joint_def, stop_low, REAL, 6),
    F(dmb_joint_def, stop_high, REAL, 6),      F(dmb_joint_def, stop_stiffness, REAL, 1),
    F(dmb_joint_def, stop_damping, REAL, 1),   F(dmb_joint_def, initial_mask, WHOLE, 1),
    F(dmb_joint_def, reserved, WHOLE, 1),      F(dmb_joint_def, initial_position, REAL, 6),
    F(dmb_joint_def, initial_speed, REAL, 6)};
static void fill_joint(const scene_under_test *s, any_def *def)
{
    def->joint = dmb_joint_def_default();
    def->joint.kind = DMB_JOINT_DISTANCE;
    def->joint.place_b = dmb_station(s->string, 0, 1.0);
    def->joint.stiffness[0] = 1.0;
}
static void fill_joint_between(const scene_under_test *s, any_def *def)
{
    const dmb_body_def body = dmb_body_def_default();
    dmb_id id;
    fill_joint(s, def);
    assert_int_equal(dmb_model_add_body(s->model, &body, &id), DMB_OK);
    def->joint.kind = DMB_JOINT_PLANAR;
    def->joint.match = 1;
    def->joint.place_a = dmb_station(id, 0, 0.0);
}
static int32_t add_joint(dmb_model *model, const any_def *def)
{
    return dmb_model_add_joint(model, &def->joint, NULL);
}

static const field coupling_fields[] = {F(dmb_coupling_def, reserved, WHOLE, 1),
                                        F(dmb_coupling_def, joint[0].index, COUNT, 1),
                                        F(dmb_coupling_def, joint[0].generation, COUNT, 1),
                                        F(dmb_coupling_def, joint[1].index, COUNT, 1),
                                        F(dmb_coupling_def, joint[1].generation, COUNT, 1),
                                        F(dmb_coupling_def, component, WHOLE, 2),
                                        F(dmb_coupling_def, ratio, REAL, 1)};
static void fill_coupling(const scene_under_test *s, any_def *def)
{
    any_def joint;
    dmb_id id;
    fill_joint(s, &joint);
    joint.joint.kind = DMB_JOINT_CYLINDRICAL;
    assert_int_equal(dmb_model_add_joint(s->model, &joint.joint, &id), DMB_OK);
    def->coupling = dmb_coupling_def_default();
    def->coupling.joint[0] = def->coupling.joint[1] = id;
    def->coupling.component[0] = DMB_X;
}
static int32_t add_coupling(dmb_model *model, const any_def *def)
{
    return dmb_model_add_coupling(model, &def->coupling, NULL);
}

static const field spring_fields[] = {F(dmb_spring_def, acts, WHOLE, 1),      PLACE_FIELDS(dmb_spring_def, place_a),
                                      PLACE_FIELDS(dmb_spring_def, place_b),  F(dmb_spring_def, offset_a, REAL, 3),
                                      F(dmb_spring_def, offset_b, REAL, 3),   F(dmb_spring_def, free_length, REAL, 1),
                                      F(dmb_spring_def, stiffness, REAL, 1),  F(dmb_spring_def, damping, REAL, 1),
                                      F(dmb_spring_def, preload, REAL, 1),    F(dmb_spring_def, table_count, COUNT, 1),
                                      F(dmb_spring_def, table_kind, WHOLE, 1)};
static void fill_spring(const scene_under_test *s, any_def *def)
{
    static const double elongation[65536] = {0.0, 1.0}, force[65536] = {0.0, 2.0}; /* as many as may be asked for */
    def->spring = dmb_spring_def_default();
    def->spring.place_a = dmb_station(s->string, 0, 0.3);
    def->spring.place_b = dmb_station(s->string, 0, 1.0);
    def->spring.offset_a[1] = 0.5;
    def->spring.stiffness = 1.0;
    def->spring.table_elongation = elongation;
    def->spring.table_force = force;
    def->spring.table_count = 2;
}
static int32_t add_spring(dmb_model *model, const any_def *def)
{
    return dmb_model_add_spring(model, &def->spring, NULL);
}

static const field stuck_fields[] = {PLACE_FIELDS(dmb_stuck_def, place),   F(dmb_stuck_def, holds, WHOLE, 1),
                                     F(dmb_stuck_def, stuck, WHOLE, 1),    F(dmb_stuck_def, stiffness, REAL, 3),
                                     F(dmb_stuck_def, damping, REAL, 3),   F(dmb_stuck_def, overpull, REAL, 1),
                                     F(dmb_stuck_def, overtorque, REAL, 1)};
static void fill_stuck(const scene_under_test *s, any_def *def)
{
    def->stuck = dmb_stuck_def_default();
    def->stuck.place = dmb_station(s->string, 0, 0.3);
}
static int32_t add_stuck(dmb_model *model, const any_def *def)
{
    return dmb_model_add_stuck(model, &def->stuck, NULL);
}

static int32_t any_force(void *context, double time, uint32_t count, const double (*poses)[12],
                         const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                         const dmb_law_memory *memory)
{
    (void)memory;
    (void)context, (void)time, (void)count, (void)poses, (void)velocities, (void)forces, (void)tangent, (void)potential;
    return 0;
}
static const field force_fields[] = {F(dmb_force_def, frame, WHOLE, 1),     F(dmb_force_def, place_count, COUNT, 1),
                                     F(dmb_force_def, provides, WHOLE, 1),  PLACE_FIELDS(dmb_force_def, place[0]),
                                     PLACE_FIELDS(dmb_force_def, place[1]), F(dmb_force_def, offset, REAL, 6),
                                     F(dmb_force_def, pose_step, REAL, 1),  F(dmb_force_def, speed_step, REAL, 1)};
static void fill_force(const scene_under_test *s, any_def *def)
{
    def->force = dmb_force_def_default();
    def->force.place_count = 2;
    def->force.place[0] = dmb_station(s->string, 0, 0.3);
    def->force.place[1] = dmb_station(s->string, 0, 1.0);
    def->force.callback = any_force;
}
static int32_t add_force(dmb_model *model, const any_def *def)
{
    return dmb_model_add_force(model, &def->force, NULL);
}

static const field ring_fields[] = {
    F(dmb_stabiliser_def, pipe, COUNT, 1),          F(dmb_stabiliser_def, fraction, REAL, 1),
    F(dmb_stabiliser_def, outer_diameter, REAL, 1), F(dmb_stabiliser_def, length, REAL, 1),
    F(dmb_stabiliser_def, mass, REAL, 1),           F(dmb_stabiliser_def, inertia, REAL, 2),
    F(dmb_stabiliser_def, density, REAL, 1),        F(dmb_stabiliser_def, added_mass, REAL, 2),
};
static void fill_ring(const scene_under_test *s, any_def *def)
{
    def->ring = dmb_stabiliser_def_default();
    def->ring.string = s->string;
}
static int32_t add_stabiliser(dmb_model *model, const any_def *def)
{
    return dmb_model_add_stabiliser(model, &def->ring, NULL);
}

static int32_t any_constraint(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                              double *jacobian)
{
    (void)context, (void)time, (void)count, (void)poses, (void)value, (void)jacobian;
    return 0;
}
static const field constraint_fields[] = {
    F(dmb_constraint_def, kind, WHOLE, 1),        F(dmb_constraint_def, row_count, COUNT, 1),
    F(dmb_constraint_def, place_count, COUNT, 1), PLACE_FIELDS(dmb_constraint_def, place[0]),
    PLACE_FIELDS(dmb_constraint_def, place[1]),   F(dmb_constraint_def, provides, WHOLE, 1),
    F(dmb_constraint_def, reserved, WHOLE, 1)};
static void fill_constraint(const scene_under_test *s, any_def *def)
{
    def->constraint = dmb_constraint_def_default();
    def->constraint.place_count = 2;
    def->constraint.place[0] = dmb_station(s->string, 0, 0.0);
    def->constraint.place[1] = dmb_station(s->string, 0, 1.0);
    def->constraint.callback = any_constraint;
}
static int32_t add_constraint(dmb_model *model, const any_def *def)
{
    return dmb_model_add_constraint(model, &def->constraint, NULL);
}

static const kind_of_def kinds[] = {
    {"environment", FIELDS(environment_fields), fill_environment, add_environment},
    {"segment", FIELDS(segment_fields), fill_segment, add_segment},
    {"table", FIELDS(segment_fields), fill_table, add_segment},
    {"wall", FIELDS(wall_fields), fill_wall, add_wall},
    {"string", FIELDS(string_fields), fill_string, add_string},
    {"pipe", FIELDS(pipe_fields), fill_pipe, add_pipe},
    {"body", FIELDS(body_fields), fill_body, add_body},
    {"bit", FIELDS(bit_fields), fill_bit, add_bit},
    {"drive", FIELDS(drive_fields), fill_drive, add_drive},
    {"load", FIELDS(load_fields), fill_load, add_load},
    {"joint", FIELDS(joint_fields), fill_joint, add_joint},
    {"joint between", FIELDS(joint_fields), fill_joint_between, add_joint},
    {"coupling", FIELDS(coupling_fields), fill_coupling, add_coupling},
    {"constraint", FIELDS(constraint_fields), fill_constraint, add_constraint},
    {"spring", FIELDS(spring_fields), fill_spring, add_spring},
    {"hole section", FIELDS(section_fields), fill_section, add_section},
    {"force", FIELDS(force_fields), fill_force, add_force},
    {"stuck", FIELDS(stuck_fields), fill_stuck, add_stuck},
    {"stabiliser", FIELDS(ring_fields), fill_ring, add_stabiliser},
};
enum { KINDS = sizeof kinds / sizeof kinds[0], WALL = 3 };

/* ---- A scene without a number that is not finite ----------------------------------------------------------------- */

static void expect_finite(const double *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!dmb_is_finite(values[i])) fail_msg("a number of the scene is not finite");
}

static void expect_frame(const dmb_scene_frame *frame)
{
    expect_finite(frame->x, 3);
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            const double *M = frame->M;
            const double product = M[3 * i] * M[3 * k] + M[3 * i + 1] * M[3 * k + 1] + M[3 * i + 2] * M[3 * k + 2];
            assert_true(fabs(product - (i == k ? 1.0 : 0.0)) < 1e-14);
        }
    }
}

static void expect_finite_springs(const dmb_scene *s)
{
    for (size_t i = 0; i < s->spring_count; ++i) {
        expect_finite(s->springs[i].a.x, 4);
        expect_finite(s->springs[i].b.x, 4);
        expect_finite(s->springs[i].span, 4);
        expect_finite(&s->springs[i].law.stiffness, 5);
    }
    expect_finite((const double *)s->spring_points, s->spring_point_count * sizeof *s->spring_points / sizeof(double));
    for (size_t i = 0; i < s->load_point_count; ++i) expect_finite(s->load_points[i].x, 4);
}

static void expect_finite_joints(const dmb_scene *s)
{
    for (size_t i = 0; i < s->joint_count; ++i) {
        expect_frame(&s->joints[i].a);
        expect_frame(&s->joints[i].b);
        expect_finite(s->joints[i].span, 3);
        expect_finite(&s->joints[i].length, 1);
    }
    expect_finite((const double *)s->laws, s->law_count * sizeof *s->laws / sizeof(double));
}

static void expect_finite_scene(const dmb_scene *s)
{
    const size_t n = s->node_count, e = s->element_count;
    expect_finite(s->reference_position, 3 * n);
    expect_finite(s->reference_quaternion, 4 * n);
    expect_finite(s->reference_depth, n);
    expect_finite(s->initial_velocity, s->velocity_count);
    expect_finite(s->weight_mass, n);
    expect_finite(s->weight_moment, 3 * n);
    expect_finite(s->node_damping, 5 * n);
    expect_finite(s->element_span, 3 * e);
    expect_finite(&s->mass, 3);
    expect_finite_joints(s);
    expect_finite_springs(s);
    for (size_t i = 0; i < s->type_count; ++i) {
        expect_finite((const double *)&s->types[i], sizeof *s->types / sizeof(double));
        for (int k = 0; k < 6; ++k) assert_true(s->types[i].stiffness[k] > 0.0);
        assert_true(s->types[i].mass.axial[0] > 0.0 && s->types[i].mass.bending[0][0] > 0.0);
    }
    for (size_t i = 0; i < s->rigid_mass_count; ++i) {
        expect_finite(&s->rigid_masses[i].mass, 1);
        expect_finite(s->rigid_masses[i].moment, 3);
        expect_finite(s->rigid_masses[i].inertia, 6);
    }
    for (size_t i = 0; i < s->site_count; ++i) {
        expect_finite(&s->sites[i].offset, 4);
        assert_true(s->sites[i].clearance >= 0.0 && s->sites[i].length > 0.0);
    }
    for (size_t i = 0; i < n; ++i) {
        const double *q = s->reference_quaternion + 4 * i;
        assert_true(fabs(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1.0) < 1e-12);
    }
}

/* ---- One field at a time ----------------------------------------------------------------------------------------- */

static int is_documented(int32_t status)
{
    return status == DMB_OK || status == DMB_ERR_NULL || status == DMB_ERR_ID || status == DMB_ERR_VALUE ||
           status == DMB_ERR_NOT_FINITE || status == DMB_ERR_TOO_LARGE || status == DMB_ERR_UNSUPPORTED;
}

static int is_documented_of_compile(int32_t status)
{
    return status == DMB_OK || status == DMB_ERR_VALUE || status == DMB_ERR_GEOMETRY || status == DMB_ERR_UNSUPPORTED ||
           status == DMB_ERR_TOO_LARGE;
}

static void put(any_def *def, const field *f, int component, double value)
{
    unsigned char *place = (unsigned char *)def + f->offset;
    if (f->type == REAL) {
        memcpy(place + 8 * component, &value, sizeof value);
    } else if (f->type == WHOLE) {
        const int32_t whole = (int32_t)value;
        memcpy(place + 4 * component, &whole, sizeof whole);
    } else {
        const uint32_t count = (uint32_t)value;
        memcpy(place + 4 * component, &count, sizeof count);
    }
}

/* Directions may be of any length, and what does not count is not looked at. */
static int is_any_number(const field *f)
{
    const char *const names[] = {"direction", "axis_a", "normal_a", "axis_b", "normal_b"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        if (strcmp(f->name, names[i]) == 0) return 1;
    }
    return 0;
}

static int is_unused(const any_def *right, const kind_of_def *kind, const field *f)
{
    if (kind->add != add_joint) return 0;
    if (strncmp(f->name, "place_a", 7) == 0) return right->joint.place_a.part.generation == 0;
    return right->joint.match == 1 && f->name[strlen(f->name) - 2] == '_' && f->name[strlen(f->name) - 1] == 'b';
}

/* Refused with a message, or compiled into finite numbers; then the model takes what is right. */
static void try_one(const kind_of_def *kind, const field *f, int component, double value)
{
    scene_under_test s = begin(kind != &kinds[WALL]);
    any_def def, right;
    int32_t status;
    kind->fill(&s, &def);
    right = def;
    put(&def, f, component, value);
    status = kind->add(s.model, &def);
    const int matters = f->type == REAL && !is_unused(&right, kind, f);
    if (!is_documented(status) || (matters && !isfinite(value) && status != DMB_ERR_NOT_FINITE) ||
        (matters && fabs(value) >= DBL_MAX && status == DMB_OK && !is_any_number(f))) {
        fail_msg("%s: %s[%d] = %g gives %s", kind->name, f->name, component, value, dmb_status_name(status));
    }
    if (status < 0) {
        assert_true(strlen(dmb_model_message(s.model)) > 0);
        assert_int_equal(kind->add(s.model, &right), DMB_OK);
    }
    add_one_pipe(&s);
    const int32_t compiled = dmb_model_compile(s.model, NULL);
    if (!is_documented_of_compile(compiled) || (status < 0 && compiled != DMB_OK)) {
        fail_msg("%s: %s[%d] = %g compiles to %s: %s", kind->name, f->name, component, value, dmb_status_name(compiled),
                 dmb_model_message(s.model));
    }
    assert_true(strlen(dmb_model_message(s.model)) > 0);
    if (compiled == DMB_OK) expect_finite_scene(s.model->scene);
    dmb_model_destroy(&s.model);
}

static void try_field(const kind_of_def *kind, const field *f)
{
    static const double reals[] = {(double)NAN,
                                   (double)INFINITY,
                                   -(double)INFINITY,
                                   -1.0,
                                   0.0,
                                   -0.0,
                                   1.0,
                                   DBL_MAX,
                                   -DBL_MAX,
                                   5e-324,
                                   DBL_MIN,
                                   1e-30,
                                   1e30,
                                   1e15,
                                   1e9,
                                   1e6,
                                   1e-6,
                                   1e-12,
                                   2.5};
    static const double wholes[] = {INT32_MIN, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 63.0, 64.0, INT32_MAX};
    static const double counts[] = {0.0, 1.0, 2.0, 65.0, 1024.0, 1025.0, 1048576.0, 4294967295.0};
    const double *values = f->type == REAL ? reals : f->type == WHOLE ? wholes : counts;
    const size_t count = f->type == REAL    ? sizeof reals / sizeof reals[0]
                         : f->type == WHOLE ? sizeof wholes / sizeof wholes[0]
                                            : sizeof counts / sizeof counts[0];
    for (int component = 0; component < f->size; ++component) {
        for (size_t i = 0; i < count; ++i) try_one(kind, f, component, values[i]);
    }
}

static void every_field(void **state)
{
    (void)state;
    for (size_t k = 0; k < KINDS; ++k) {
        for (size_t i = 0; i < kinds[k].field_count; ++i) try_field(&kinds[k], &kinds[k].fields[i]);
    }
}

/* Fields whose wrong values must be refused, whatever else is allowed. */
static void what_must_be_refused(void **state)
{
    static const struct {
        size_t kind;
        const char *field;
        double value;
    } cases[] = {{1, "x1", 0.0},
                 {1, "x1", -1.0},
                 {1, "kind", 8.0},
                 {2, "table_count", 0.0},
                 {3, "diameter", 0.0},
                 {3, "diameter", -1.0},
                 {3, "exponent", 0.5},
                 {3, "restitution", 1.5},
                 {3, "stiffness", 0.0},
                 {3, "mu_static", 0.1},
                 {3, "stribeck_speed", 0.0},
                 {3, "survey_count", 1.0},
                 {5, "length", 0.0},
                 {5, "length", -1.0},
                 {5, "outer_diameter", 0.061},
                 {5, "outer_diameter", 0.0},
                 {5, "inner_diameter", 0.073},
                 {5, "inner_diameter", -1.0},
                 {5, "poisson_ratio", 0.5},
                 {5, "poisson_ratio", -1.0},
                 {5, "young_modulus", 0.0},
                 {5, "density", 0.0},
                 {5, "joint_length", 1.0},
                 {5, "elements", 0.0},
                 {5, "elements", 1025.0},
                 {5, "eccentricity", -1.0},
                 {6, "mass", 0.0},
                 {6, "mass", -1.0},
                 {6, "inertia", 0.0},
                 {6, "contact_length", 0.0},
                 {7, "blades", 0.0},
                 {7, "blades", 65.0},
                 {7, "history", 63.0},
                 {7, "length", 0.0},
                 {8, "component", 6.0},
                 {8, "limit_high", -1e30},
                 {8, "time_function.generation", 0.0},
                 {9, "place.fraction", 1.5},
                 {14, "free_length", -2.0},
                 {14, "stiffness", -1.0},
                 {14, "damping", -1.0},
                 {14, "table_count", 1.0},
                 {14, "table_kind", 2.0},
                 {14, "acts", 3.0},
                 {9, "frame", 3.0},
                 {10, "kind", 16.0},
                 {10, "place_b.fraction", 1.5},
                 {10, "axis_a", 0.0},
                 {10, "length", 0.0},
                 {10, "friction_speed", 0.0},
                 {10, "stop_high", -1e30},
                 {10, "stop_stiffness", 0.0},
                 {10, "state", 3.0},
                 {11, "place_a.fraction", 0.5},
                 {11, "initial_mask", 1.0},
                 {11, "match", 2.0},
                 {12, "ratio", 0.0},
                 {12, "component", 1.0},
                 {12, "joint[1].generation", 0.0},
                 {13, "row_count", 0.0},
                 {13, "row_count", 7.0},
                 {13, "place_count", 5.0},
                 {13, "kind", 2.0},
                 {13, "provides", 2.0}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        const kind_of_def *kind = &kinds[cases[i].kind];
        scene_under_test s = begin(cases[i].kind != WALL);
        const field *f = kind->fields;
        any_def def;
        while (strcmp(f->name, cases[i].field) != 0) ++f;
        kind->fill(&s, &def);
        put(&def, f, 0, cases[i].value);
        if (kind->add(s.model, &def) >= 0) fail_msg("%s: %s = %g is taken", kind->name, f->name, cases[i].value);
        const char *dot = strrchr(f->name, '.'); /* ids are named as a whole */
        if (dot == NULL) assert_non_null(strstr(dmb_model_message(s.model), f->name));
        dmb_model_destroy(&s.model);
    }
}

/* ---- Several fields at a time ------------------------------------------------------------------------------------ */

static uint32_t lottery = 12345;
static uint32_t draw(uint32_t below)
{
    lottery = lottery * 1664525u + 1013904223u;
    return (lottery >> 8) % below;
}

/* Powers of ten far apart, so that products of what is accepted would overflow if the bounds were too wide. */
static double any_value(const field *f)
{
    if (f->type != REAL) return draw(8) == 0 ? draw(2000) : draw(4);
    const double magnitude = pow(10.0, (int)draw(62) - 26);
    return draw(4) == 0 ? -magnitude : magnitude;
}

static void many_fields_at_once(void **state)
{
    int accepted = 0;
    (void)state;
    for (int i = 0; i < 20000; ++i) {
        const kind_of_def *kind = &kinds[draw(8) < 4 ? 5 : draw(KINDS)];
        scene_under_test s = begin(kind != &kinds[WALL]);
        any_def def;
        kind->fill(&s, &def);
        for (uint32_t k = 1 + draw(4); k > 0; --k) {
            const field *f = &kind->fields[draw((uint32_t)kind->field_count)];
            put(&def, f, (int)draw((uint32_t)f->size), any_value(f));
        }
        const int32_t status = kind->add(s.model, &def);
        if (!is_documented(status)) fail_msg("%s: %s", kind->name, dmb_status_name(status));
        add_one_pipe(&s);
        if (status == DMB_OK && dmb_model_compile(s.model, NULL) == DMB_OK) {
            expect_finite_scene(s.model->scene);
            ++accepted;
        }
        dmb_model_destroy(&s.model);
    }
    assert_true(accepted > 500);
}

static void counts_of_pipes(void **state)
{
    static const uint32_t refused[] = {0, (1u << 20) + 1, UINT32_MAX};
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    scene_under_test s = begin(1);
    (void)state;
    for (int i = 0; i < 3; ++i) {
        assert_int_equal(dmb_model_add_pipes(s.model, &pipe, refused[i], NULL), DMB_ERR_VALUE);
        assert_non_null(strstr(dmb_model_message(s.model), "count"));
    }
    for (int i = 0; i < 16; ++i) assert_int_equal(dmb_model_add_pipes(s.model, &pipe, 1u << 20, NULL), DMB_OK);
    assert_int_equal(dmb_model_add_pipes(s.model, &pipe, 1, NULL), DMB_ERR_TOO_LARGE);
    assert_true(strlen(dmb_model_message(s.model)) > 0);
    dmb_model_destroy(&s.model);
}

/* ---- Arrays ------------------------------------------------------------------------------------------------------ */

static void tables(void **state)
{
    static const struct {
        double time[3], value[3];
        int32_t status;
    } cases[] = {{{0, 1, 2}, {1, 2, 3}, DMB_OK},
                 {{0, 0, 2}, {1, 2, 3}, DMB_ERR_VALUE},
                 {{0, 2, 1}, {1, 2, 3}, DMB_ERR_VALUE},
                 {{0, 5e-324, 1}, {1, 2, 3}, DMB_ERR_VALUE},
                 {{0, 1, (double)NAN}, {1, 2, 3}, DMB_ERR_NOT_FINITE},
                 {{0, 1, (double)INFINITY}, {1, 2, 3}, DMB_ERR_NOT_FINITE},
                 {{0, 1, 2}, {1, (double)NAN, 3}, DMB_ERR_NOT_FINITE},
                 {{0, 1, 2}, {1, 2, DBL_MAX}, DMB_ERR_VALUE},
                 {{-DBL_MAX, 1, 2}, {1, 2, 3}, DMB_ERR_VALUE}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        scene_under_test s = begin(0);
        dmb_segment term = dmb_segment_default();
        term.kind = DMB_SEGMENT_TABLE;
        term.table_time = cases[i].time;
        term.table_value = cases[i].value;
        term.table_count = 3;
        assert_int_equal(dmb_model_add_time_function(s.model, &term, 1, NULL), cases[i].status);
        if (cases[i].status < 0)
            assert_non_null(strstr(dmb_model_message(s.model), "time function 1, segment 0: table_"));
        term.table_value = NULL;
        assert_int_equal(dmb_model_add_time_function(s.model, &term, 1, NULL), DMB_ERR_NULL);
        dmb_model_destroy(&s.model);
    }
}

static void surveys(void **state)
{
    static const struct {
        double survey[6];
        int32_t status;
    } cases[] = {
        {{0, 1.5, 0, 10, 1.4, 0}, DMB_OK},
        {{0, 1.5, 0, 0, 1.4, 0}, DMB_ERR_VALUE},
        {{10, 1.5, 0, 0, 1.4, 0}, DMB_ERR_VALUE},
        {{0, 1.5, 0, 5e-324, 1.4, 0}, DMB_ERR_VALUE},
        {{0, 1.5, 0, (double)NAN, 1.4, 0}, DMB_ERR_NOT_FINITE},
        {{0, (double)INFINITY, 0, 10, 1.4, 0}, DMB_ERR_NOT_FINITE},
        {{0, 1.5, 0, 10, 1.4, DBL_MAX}, DMB_ERR_VALUE},
        {{0, 0, -6.2831853071796, 10, 3.1415926535898, 6.2831853071796}, DMB_OK}, /* the bounds, as text gives them */
        {{0, 90, 0, 10, 91, 0}, DMB_ERR_VALUE},                                   /* degrees */
        {{0, -0.01, 0, 10, 0, 0}, DMB_ERR_VALUE},
        {{0, 1.5, 0, 10, 3.15, 0}, DMB_ERR_VALUE},
        {{0, 1.5, 0, 10, 1.5, 45}, DMB_ERR_VALUE},
        {{0, 1.5, -6.3, 10, 1.5, 0}, DMB_ERR_VALUE}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        scene_under_test s = begin(0);
        dmb_wall_def wall = dmb_wall_def_default();
        wall.survey = cases[i].survey;
        wall.survey_count = 2;
        assert_int_equal(dmb_model_add_wall(s.model, &wall, NULL), cases[i].status);
        if (cases[i].status < 0) {
            assert_non_null(strstr(dmb_model_message(s.model), "wall, station"));
            wall.survey = NULL;
            assert_int_equal(dmb_model_add_wall(s.model, &wall, NULL), DMB_ERR_NULL);
        }
        dmb_model_destroy(&s.model);
    }
}

static int32_t silent(void *context, double time, double out[3])
{
    (void)context;
    (void)time;
    (void)out;
    return 0;
}

static void callbacks_and_counts_of_terms(void **state)
{
    scene_under_test s = begin(0);
    dmb_segment terms[65];
    (void)state;
    for (int i = 0; i < 65; ++i) terms[i] = dmb_segment_default();
    assert_int_equal(dmb_model_add_time_function(s.model, terms, 0, NULL), DMB_ERR_VALUE);
    assert_int_equal(dmb_model_add_time_function(s.model, terms, 65, NULL), DMB_ERR_VALUE);
    assert_int_equal(dmb_model_add_time_function(s.model, terms, 64, NULL), DMB_OK);
    terms[0].kind = DMB_SEGMENT_CALLBACK;
    assert_int_equal(dmb_model_add_time_function(s.model, terms, 1, NULL), DMB_ERR_NULL);
    assert_non_null(strstr(dmb_model_message(s.model), "callback"));
    terms[0].callback = silent;
    terms[0].provides = 4;
    assert_int_equal(dmb_model_add_time_function(s.model, terms, 1, NULL), DMB_ERR_VALUE);
    terms[0].provides = DMB_PROVIDES_RATE | DMB_PROVIDES_INTEGRAL;
    assert_int_equal(dmb_model_add_time_function(s.model, terms, 1, NULL), DMB_OK);
    dmb_model_destroy(&s.model);
}

static int32_t add_alone(scene_under_test *s, const dmb_segment *term, const char *named)
{
    const int32_t status = dmb_model_add_time_function(s->model, term, 1, NULL);
    if (status < 0) assert_non_null(strstr(dmb_model_message(s->model), named));
    return status;
}

/* A segment per revolution follows a time function of this model that is given by numbers; a table that repeats ends as
 * it begins. */
static void periodic_and_per_revolution(void **state)
{
    double time[3] = {0.0, 0.5, 1.0}, value[3] = {1.0, 2.0, 1.0};
    scene_under_test s = begin(0), other = begin(0);
    dmb_segment swing = dmb_segment_default(), pulse = dmb_segment_default(), called = dmb_segment_default();
    dmb_id swings, calls;
    (void)state;
    swing.kind = DMB_SEGMENT_PER_REVOLUTION;
    assert_int_equal(add_alone(&s, &swing, "of"), DMB_ERR_ID);
    swing.of = s.string;
    assert_int_equal(add_alone(&s, &swing, "of"), DMB_ERR_ID);
    swing.of = other.time_function;
    assert_int_equal(add_alone(&s, &swing, "of"), DMB_ERR_ID);
    swing.of = s.time_function;
    swing.order = 0.0;
    assert_int_equal(add_alone(&s, &swing, "order"), DMB_ERR_VALUE);
    swing.order = 2.0;
    assert_int_equal(dmb_model_add_time_function(s.model, &swing, 1, &swings), DMB_OK);
    called.kind = DMB_SEGMENT_CALLBACK;
    called.callback = silent;
    assert_int_equal(dmb_model_add_time_function(s.model, &called, 1, &calls), DMB_OK);
    swing.of = swings;
    assert_int_equal(add_alone(&s, &swing, "PER_REVOLUTION, must be CONSTANT"), DMB_ERR_UNSUPPORTED);
    swing.of = calls;
    assert_int_equal(add_alone(&s, &swing, "CALLBACK, must be CONSTANT"), DMB_ERR_UNSUPPORTED);
    pulse.kind = DMB_SEGMENT_PERIODIC;
    pulse.table_time = time;
    pulse.table_value = value;
    pulse.table_count = 1;
    assert_int_equal(add_alone(&s, &pulse, "table_count"), DMB_ERR_VALUE);
    pulse.table_count = 2;
    assert_int_equal(add_alone(&s, &pulse, "table_value"), DMB_ERR_VALUE);
    pulse.table_count = 3;
    assert_int_equal(add_alone(&s, &pulse, ""), DMB_OK);
    time[2] = 5e-7, time[1] = 2e-7;
    assert_int_equal(add_alone(&s, &pulse, "table_time"), DMB_ERR_VALUE);
    dmb_model_destroy(&s.model);
    dmb_model_destroy(&other.model);
}

/* struct_size of every definition: garbage is refused. */
static void struct_sizes(void **state)
{
    static const uint32_t sizes[] = {0, 1, 4, 8, 12, 0x7FFFFFF8u, 0xFFFFFFF8u, UINT32_MAX};
    (void)state;
    for (size_t k = 0; k < KINDS; ++k) {
        for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; ++i) {
            scene_under_test s = begin(k != WALL);
            any_def def;
            kinds[k].fill(&s, &def);
            def.struct_size = sizes[i];
            assert_int_equal(kinds[k].add(s.model, &def), DMB_ERR_STRUCT_SIZE);
            assert_true(strlen(dmb_model_message(s.model)) > 0);
            dmb_model_destroy(&s.model);
        }
    }
}

static void inertia_must_be_positive_definite(void **state)
{
    static const struct {
        double inertia[6];
        int32_t status;
    } cases[] = {{{1, 1, 1, 0, 0, 0}, DMB_OK},
                 {{0.55, 0.55, 1, 0.45, 0, 0}, DMB_OK},
                 {{1, 1, 1, 1, 0, 0}, DMB_ERR_VALUE},
                 {{1, 1, 1, 0.6, 0.6, -0.6}, DMB_ERR_VALUE},
                 {{1e-15, 5.5e-16, 5.5e-16, 0, 0, 4.5e-16}, DMB_OK},
                 {{1e17, 5.5e16, 5.5e16, 0, 0, 4.5e16}, DMB_OK},
                 {{1, -1, 1, 0, 0, 0}, DMB_ERR_VALUE}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        scene_under_test s = begin(0);
        dmb_body_def body = dmb_body_def_default();
        memcpy(body.inertia, cases[i].inertia, sizeof body.inertia);
        assert_int_equal(dmb_model_add_body(s.model, &body, NULL), cases[i].status);
        dmb_model_destroy(&s.model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_field),
        cmocka_unit_test(what_must_be_refused),
        cmocka_unit_test(many_fields_at_once),
        cmocka_unit_test(counts_of_pipes),
        cmocka_unit_test(tables),
        cmocka_unit_test(surveys),
        cmocka_unit_test(callbacks_and_counts_of_terms),
        cmocka_unit_test(periodic_and_per_revolution),
        cmocka_unit_test(struct_sizes),
        cmocka_unit_test(inertia_must_be_positive_definite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
