/* One list for each struct that describes a scene: a row for each field, which has
 *
 *     FIELD(T, number, name, unit, bound, default)
 *     ARRAY(T, number, name, counted, width, unit, bound, default)    width elements for each of `counted`, a field
 *
 * From these come the defaults (T_init), the checks of single fields with their messages, the memory of refused parts
 * and the scene record. Type and size of a field are those of the struct, whose text stands in
 * include/drillmbd/scene.h; tests compare the two (unit_fields, python test_fields). A new field is a member there and
 * a row here. Its number is the next one of its list and never changes, as scene records name fields by it. The name is
 * checked first, other fields in the order of the rows, relations between fields after them (model/describe_*.c).
 * `bound` is one of
 *
 *     WITHIN(low, high)         BETWEEN(low, high), ends excluded   ZERO_OR(low, high)    NOT_GIVEN_OR(low, high)
 *     ABOVE(low), finite
 *     BITS(mask)                SET of components                   MOTION, a closed one  TEXT, a name
 *     PART(kind)                PART_OR_NONE(kind)                  PLACE                 GROUND_OR_PLACE
 *     POINTER, which is there   FINITE   ANY, which no check of one field can tell */
#ifndef DMB_FIELDS_LISTS_H
#define DMB_FIELDS_LISTS_H

/* clang-format off */

#define DMB_ENVIRONMENT_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, gravity, "m/s2", WITHIN(-DMB_ACCELERATION_MAX, DMB_ACCELERATION_MAX), {0.0, 0.0, -9.81}) \
    FIELD(T, 2, fluid_density, "kg/m3", WITHIN(0.0, DMB_DENSITY_MAX), 0.0) \
    FIELD(T, 3, lateral_damping, "N s/m2", WITHIN(0.0, DMB_DAMPING_MAX), 0.0) \
    FIELD(T, 4, axial_damping, "N s/m2", WITHIN(0.0, DMB_DAMPING_MAX), 0.0) \
    FIELD(T, 5, torsional_damping, "N s", WITHIN(0.0, DMB_DAMPING_MAX), 0.0) \
    FIELD(T, 6, inner_density, "kg/m3", NOT_GIVEN_OR(0.0, DMB_DENSITY_MAX), DMB_NOT_GIVEN) \
    FIELD(T, 7, added_mass, "-", NOT_GIVEN_OR(0.0, DMB_NUMBER_MAX), 0.0) \
    FIELD(T, 8, flow_rate, "m3/s", WITHIN(0.0, DMB_FLOW_MAX), 0.0) \
    FIELD(T, 9, consistency, "Pa s", ZERO_OR(DMB_CONSISTENCY_MIN, DMB_CONSISTENCY_MAX), 0.0) \
    FIELD(T, 10, flow_exponent, "-", WITHIN(DMB_FLOW_EXPONENT_MIN, DMB_FLOW_EXPONENT_MAX), 1.0) \
    FIELD(T, 11, yield_stress, "Pa", WITHIN(0.0, DMB_YIELD_STRESS_MAX), 0.0) \
    FIELD(T, 12, nozzle_area, "m2", ZERO_OR(DMB_AREA_MIN, DMB_FLOW_MAX), 0.0) \
    FIELD(T, 13, flow_eccentricity, "-", WITHIN(0.0, DMB_FLOW_ECCENTRICITY_MAX), 0.0)

#define DMB_SEGMENT_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, kind, "", WITHIN(DMB_SEGMENT_CONSTANT, DMB_SEGMENT_PER_REVOLUTION), DMB_SEGMENT_CONSTANT) \
    FIELD(T, 2, x0, "s", WITHIN(-DMB_TIME_MAX, DMB_TIME_MAX), 0.0) \
    FIELD(T, 3, x1, "s", WITHIN(-DMB_TIME_MAX, DMB_TIME_MAX), 1.0) \
    FIELD(T, 4, h0, "unit of the time function", WITHIN(-DMB_FORCE_MAX, DMB_FORCE_MAX), 0.0) \
    FIELD(T, 5, h1, "unit of the time function", WITHIN(-DMB_FORCE_MAX, DMB_FORCE_MAX), 0.0) \
    FIELD(T, 6, omega, "rad/s", WITHIN(-DMB_SPEED_MAX, DMB_SPEED_MAX), 0.0) \
    FIELD(T, 7, phase, "rad", WITHIN(-DMB_ANGLE_MAX, DMB_ANGLE_MAX), 0.0) \
    ARRAY(T, 8, table_time, table_count, 1, "s", ANY, NULL) \
    ARRAY(T, 9, table_value, table_count, 1, "unit of the time function", ANY, NULL) \
    FIELD(T, 10, table_count, "-", ANY, 0) \
    FIELD(T, 11, provides, "", ANY, 0) \
    FIELD(T, 12, callback, "", ANY, NULL) \
    FIELD(T, 13, callback_context, "", ANY, NULL) \
    FIELD(T, 14, of, "", PART_OR_NONE(DMB_PART_TIME_FUNCTION), {0, 0}) \
    FIELD(T, 15, share, "-", WITHIN(-DMB_SPEED_MAX, DMB_SPEED_MAX), 0.0) \
    FIELD(T, 16, order, "-", WITHIN(-DMB_ORDER_MAX, DMB_ORDER_MAX), 1.0)

#define DMB_WALL_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, survey_count, "-", ZERO_OR(2, 1 << 16), 0) \
    ARRAY(T, 2, survey, survey_count, 3, "m, rad, rad", ANY, NULL) \
    FIELD(T, 3, origin, "m", WITHIN(-DMB_POSITION_MAX, DMB_POSITION_MAX), {0.0}) \
    FIELD(T, 4, direction, "-", FINITE, {1.0, 0.0, 0.0}) \
    FIELD(T, 5, diameter, "m", WITHIN(DMB_LENGTH_MIN, DMB_LENGTH_MAX), 0.094) \
    FIELD(T, 6, normal_law, "", WITHIN(DMB_NORMAL_NONE, DMB_NORMAL_IMPACT), DMB_NORMAL_EXACT) \
    FIELD(T, 7, friction_law, "", WITHIN(DMB_FRICTION_NONE, DMB_FRICTION_CALLBACK), DMB_FRICTION_STRIBECK) \
    FIELD(T, 8, stiffness, "N/m^(n+1)", WITHIN(DMB_STIFFNESS_MIN, DMB_STIFFNESS_MAX), 1e7) \
    FIELD(T, 9, exponent, "-", WITHIN(1.0, 3.0), 1.0) \
    FIELD(T, 10, restitution, "-", WITHIN(0.0, 1.0), 0.4) \
    FIELD(T, 11, damping, "N s/m2", WITHIN(0.0, DMB_DAMPING_MAX), 0.0) \
    FIELD(T, 12, impact_depth, "m", WITHIN(DMB_DEPTH_MIN, DMB_LENGTH_MAX), 1e-4) \
    FIELD(T, 13, approach_speed, "m/s", WITHIN(DMB_SPEED_MIN, DMB_SPEED_MAX), 0.01) \
    FIELD(T, 14, mu_static, "-", WITHIN(0.0, DMB_NUMBER_MAX), 0.35) \
    FIELD(T, 15, mu_dynamic, "-", WITHIN(0.0, DMB_NUMBER_MAX), 0.30) \
    FIELD(T, 16, stribeck_speed, "m/s", WITHIN(DMB_SPEED_MIN, DMB_SPEED_MAX), 1e-2) \
    FIELD(T, 17, smoothing_speed, "m/s", WITHIN(DMB_SPEED_MIN, DMB_SPEED_MAX), 1e-3) \
    FIELD(T, 18, full_speed, "m/s", WITHIN(DMB_SPEED_MIN, DMB_SPEED_MAX), 1e-2) \
    FIELD(T, 19, bristle_stiffness, "1/m", WITHIN(DMB_NUMBER_MIN, DMB_DAMPING_MAX), 1e4) \
    FIELD(T, 20, bristle_damping, "s/m", WITHIN(0.0, DMB_DAMPING_MAX), 0.0) \
    FIELD(T, 21, name, "", TEXT, "") \
    FIELD(T, 22, cut_spacing, "m", ZERO_OR(DMB_LENGTH_MIN, DMB_LENGTH_MAX), 0.0) \
    FIELD(T, 23, cut_start, "m", WITHIN(-DMB_POSITION_MAX, DMB_POSITION_MAX), 0.0) \
    FIELD(T, 24, cut_end, "m", WITHIN(-DMB_POSITION_MAX, DMB_POSITION_MAX), 0.0) \
    FIELD(T, 25, friction_table_count, "-", ZERO_OR(2, DMB_FRICTION_POINTS), 0) \
    ARRAY(T, 26, friction_table_speed, friction_table_count, 1, "m/s", WITHIN(0.0, DMB_SPEED_MAX), {0.0}) \
    ARRAY(T, 27, friction_table_mu, friction_table_count, 1, "-", WITHIN(0.0, DMB_NUMBER_MAX), {0.0}) \
    FIELD(T, 28, friction_state_count, "-", WITHIN(0, DMB_FRICTION_STATES), 0) \
    FIELD(T, 29, friction_callback, "", ANY, NULL) \
    FIELD(T, 30, friction_context, "", ANY, NULL) \
    FIELD(T, 31, friction_accept, "", ANY, NULL)

#define DMB_HOLE_SECTION_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, shape, "", WITHIN(DMB_HOLE_STEP, DMB_HOLE_LINE), DMB_HOLE_STEP) \
    FIELD(T, 2, depth, "m", WITHIN(-DMB_POSITION_MAX, DMB_POSITION_MAX), 0.0) \
    FIELD(T, 3, transition, "m", WITHIN(DMB_LENGTH_MIN, DMB_LENGTH_MAX), 0.1) \
    FIELD(T, 4, diameter, "m", NOT_GIVEN_OR(DMB_LENGTH_MIN, DMB_LENGTH_MAX), DMB_NOT_GIVEN) \
    FIELD(T, 5, stiffness, "N/m^(n+1)", NOT_GIVEN_OR(DMB_STIFFNESS_MIN, DMB_STIFFNESS_MAX), DMB_NOT_GIVEN) \
    FIELD(T, 6, restitution, "-", NOT_GIVEN_OR(0.0, 1.0), DMB_NOT_GIVEN) \
    FIELD(T, 7, damping, "N s/m2", NOT_GIVEN_OR(0.0, DMB_DAMPING_MAX), DMB_NOT_GIVEN) \
    FIELD(T, 8, mu_static, "-", NOT_GIVEN_OR(0.0, DMB_NUMBER_MAX), DMB_NOT_GIVEN) \
    FIELD(T, 9, mu_dynamic, "-", NOT_GIVEN_OR(0.0, DMB_NUMBER_MAX), DMB_NOT_GIVEN) \
    FIELD(T, 10, strength, "Pa", WITHIN(0.0, DMB_MODULUS_MAX), 0.0) \
    FIELD(T, 11, name, "", TEXT, "")

#define DMB_STRING_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, follows_hole, "", WITHIN(0, 1), 1) \
    FIELD(T, 2, start_depth, "m", WITHIN(-DMB_POSITION_MAX, DMB_POSITION_MAX), 0.0) \
    FIELD(T, 3, offset, "m", WITHIN(-DMB_LENGTH_MAX, DMB_LENGTH_MAX), {0.0}) \
    FIELD(T, 4, position, "m", WITHIN(-DMB_POSITION_MAX, DMB_POSITION_MAX), {0.0}) \
    FIELD(T, 5, rotation, "rad", WITHIN(-DMB_ANGLE_MAX, DMB_ANGLE_MAX), {0.0}) \
    FIELD(T, 6, velocity, "m/s, rad/s", WITHIN(-DMB_SPEED_MAX, DMB_SPEED_MAX), {0.0}) \
    FIELD(T, 7, start_free, "-", MOTION, DMB_FREE_CYLINDRICAL) \
    FIELD(T, 8, end_free, "-", MOTION, DMB_FREE_ALL) \
    FIELD(T, 9, name, "", TEXT, "")

#define DMB_PIPE_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, kind, "", WITHIN(DMB_PIPE_FLEXIBLE, DMB_PIPE_RIGID), DMB_PIPE_FLEXIBLE) \
    FIELD(T, 2, string, "", ANY, {0, 0}) \
    FIELD(T, 3, elements, "-", WITHIN(1, DMB_PIPE_ELEMENTS_MAX), 1) \
    FIELD(T, 4, seed, "-", ANY, 1) \
    FIELD(T, 5, length, "m", WITHIN(DMB_LENGTH_MIN, DMB_LENGTH_MAX), 1.0) \
    FIELD(T, 6, outer_diameter, "m", WITHIN(DMB_LENGTH_MIN, DMB_LENGTH_MAX), 0.073) \
    FIELD(T, 7, inner_diameter, "m", WITHIN(0.0, DMB_LENGTH_MAX), 0.061) \
    FIELD(T, 8, young_modulus, "Pa", WITHIN(DMB_MODULUS_MIN, DMB_MODULUS_MAX), 2.1e11) \
    FIELD(T, 9, poisson_ratio, "-", BETWEEN(-1.0, 0.5), 0.3) \
    FIELD(T, 10, density, "kg/m3", WITHIN(DMB_DENSITY_MIN, DMB_DENSITY_MAX), 7850.0) \
    FIELD(T, 11, shear_factor, "-", WITHIN(DMB_NUMBER_MIN, DMB_NUMBER_MAX), 0.5) \
    FIELD(T, 12, damping_time, "s", WITHIN(0.0, DMB_TIME_MAX), 0.0) \
    FIELD(T, 13, joint_length, "m", WITHIN(0.0, DMB_LENGTH_MAX), 0.0) \
    FIELD(T, 14, joint_outer_diameter, "m", ZERO_OR(DMB_LENGTH_MIN, DMB_LENGTH_MAX), 0.0) \
    FIELD(T, 15, joint_inner_diameter, "m", ZERO_OR(DMB_LENGTH_MIN, DMB_LENGTH_MAX), 0.0) \
    FIELD(T, 16, joint_mass, "kg", ZERO_OR(DMB_MASS_MIN, DMB_MASS_MAX), 0.0) \
    FIELD(T, 17, joint_inertia, "kg m2", ZERO_OR(DMB_INERTIA_MIN, DMB_INERTIA_MAX), {0.0}) \
    FIELD(T, 18, eccentricity, "m", WITHIN(0.0, DMB_LENGTH_MAX), 0.0) \
    FIELD(T, 19, eccentricity_angle, "rad", WITHIN(-DMB_ANGLE_MAX, DMB_ANGLE_MAX), 0.0) \
    FIELD(T, 20, eccentricity_spread, "m", WITHIN(0.0, DMB_LENGTH_MAX), 0.0) \
    FIELD(T, 21, angle_spread, "rad", WITHIN(0.0, DMB_ANGLE_MAX), 0.0) \
    FIELD(T, 22, curvature, "rad/m", WITHIN(-DMB_CURVATURE_MAX, DMB_CURVATURE_MAX), {0.0}) \
    FIELD(T, 23, section_stiffness, "N, N, N, N m2, N m2, N m2", ZERO_OR(DMB_STIFFNESS_MIN, \
          DMB_STIFFNESS_MAX), {0.0}) \
    FIELD(T, 24, section_mass, "kg/m", ZERO_OR(DMB_MASS_MIN, DMB_MASS_MAX), 0.0) \
    FIELD(T, 25, section_inertia, "kg m", ZERO_OR(DMB_INERTIA_MIN, DMB_INERTIA_MAX), {0.0}) \
    FIELD(T, 26, yield_strength, "Pa", ZERO_OR(DMB_MODULUS_MIN, DMB_MODULUS_MAX), 0.0) \
    FIELD(T, 27, name, "", TEXT, "") \
    FIELD(T, 28, contact_points, "-", ZERO_OR(3, DMB_LOBATTO_MOST), 0)

#define DMB_STABILISER_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, pipe, "-", ANY, 0) \
    FIELD(T, 2, string, "", PART_OR_NONE(DMB_PART_STRING), {0, 0}) \
    FIELD(T, 3, fraction, "-", WITHIN(0.0, 1.0), 0.5) \
    FIELD(T, 4, outer_diameter, "m", WITHIN(DMB_LENGTH_MIN, DMB_LENGTH_MAX), 0.09) \
    FIELD(T, 5, length, "m", WITHIN(DMB_LENGTH_MIN, DMB_LENGTH_MAX), 0.3) \
    FIELD(T, 6, mass, "kg", ZERO_OR(DMB_MASS_MIN, DMB_MASS_MAX), 0.0) \
    FIELD(T, 7, inertia, "kg m2", ZERO_OR(DMB_INERTIA_MIN, DMB_INERTIA_MAX), {0.0}) \
    FIELD(T, 8, density, "kg/m3", WITHIN(DMB_DENSITY_MIN, DMB_DENSITY_MAX), 7850.0) \
    FIELD(T, 9, name, "", TEXT, "") \
    FIELD(T, 10, added_mass, "kg", NOT_GIVEN_OR(0.0, DMB_MASS_MAX), {0.0, DMB_NOT_GIVEN})

#define DMB_BODY_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, attach, "", WITHIN(DMB_ATTACH_NONE, DMB_ATTACH_END), DMB_ATTACH_NONE) \
    FIELD(T, 2, string, "", PART_OR_NONE(DMB_PART_STRING), {0, 0}) \
    FIELD(T, 3, mass, "kg", WITHIN(DMB_MASS_MIN, DMB_MASS_MAX), 1.0) \
    FIELD(T, 4, centre, "m", WITHIN(-DMB_LENGTH_MAX, DMB_LENGTH_MAX), {0.0}) \
    FIELD(T, 5, inertia, "kg m2", WITHIN(-DMB_INERTIA_MAX, DMB_INERTIA_MAX), {1e-3, 1e-3, 1e-3, 0.0, 0.0, 0.0}) \
    FIELD(T, 6, position, "m", WITHIN(-DMB_POSITION_MAX, DMB_POSITION_MAX), {0.0}) \
    FIELD(T, 7, rotation, "rad", WITHIN(-DMB_ANGLE_MAX, DMB_ANGLE_MAX), {0.0}) \
    FIELD(T, 8, velocity, "m/s, rad/s", WITHIN(-DMB_SPEED_MAX, DMB_SPEED_MAX), {0.0}) \
    FIELD(T, 9, free_mask, "-", MOTION, DMB_FREE_ALL) \
    FIELD(T, 10, contact_diameter, "m", ZERO_OR(DMB_LENGTH_MIN, DMB_LENGTH_MAX), 0.0) \
    FIELD(T, 11, contact_length, "m", WITHIN(DMB_LENGTH_MIN, DMB_LENGTH_MAX), 1.0) \
    FIELD(T, 12, name, "", TEXT, "") \
    FIELD(T, 13, displaced_volume, "m3", WITHIN(0.0, DMB_MASS_MAX), 0.0) \
    FIELD(T, 14, added_mass, "kg", WITHIN(0.0, DMB_MASS_MAX), {0.0})

#define DMB_BIT_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, rock_law, "", WITHIN(DMB_ROCK_NONE, DMB_ROCK_REGENERATIVE), DMB_ROCK_NONE) \
    FIELD(T, 2, string, "", PART_OR_NONE(DMB_PART_STRING), {0, 0}) \
    FIELD(T, 3, load, "N", PART_OR_NONE(DMB_PART_TIME_FUNCTION), {0, 0}) \
    FIELD(T, 4, mass, "kg", WITHIN(DMB_MASS_MIN, DMB_MASS_MAX), 5.0) \
    FIELD(T, 5, inertia, "kg m2", ZERO_OR(DMB_INERTIA_MIN, DMB_INERTIA_MAX), {0.0}) \
    FIELD(T, 6, diameter, "m", ZERO_OR(DMB_LENGTH_MIN, DMB_LENGTH_MAX), 0.092) \
    FIELD(T, 7, length, "m", WITHIN(DMB_LENGTH_MIN, DMB_LENGTH_MAX), 0.1) \
    FIELD(T, 8, radius, "m", WITHIN(DMB_LENGTH_MIN, DMB_LENGTH_MAX), 0.047) \
    FIELD(T, 9, intrinsic_energy, "Pa", WITHIN(DMB_MODULUS_MIN, DMB_MODULUS_MAX), 1e7) \
    FIELD(T, 10, cutting_ratio, "-", WITHIN(DMB_NUMBER_MIN, DMB_NUMBER_MAX), 0.6) \
    FIELD(T, 11, contact_strength, "Pa", WITHIN(0.0, DMB_MODULUS_MAX), 1e7) \
    FIELD(T, 12, wear_length, "m", WITHIN(0.0, DMB_LENGTH_MAX), 1e-3) \
    FIELD(T, 13, contact_friction, "-", WITHIN(0.0, DMB_NUMBER_MAX), 0.5) \
    FIELD(T, 14, intrusion_depth, "m", WITHIN(DMB_DEPTH_MIN, DMB_LENGTH_MAX), 1e-4) \
    FIELD(T, 15, bottom, "m", WITHIN(0.0, DMB_LENGTH_MAX), 0.0) \
    FIELD(T, 16, blades, "-", WITHIN(1, 64), 4) \
    FIELD(T, 17, history, "-", WITHIN(64, 1 << 20), 1024) \
    FIELD(T, 18, name, "", TEXT, "") \
    FIELD(T, 19, side_cutting, "-", WITHIN(0.0, 1e3), 0.0) \
    FIELD(T, 20, walk_angle, "rad", WITHIN(-1.5, 1.5), 0.0) \
    FIELD(T, 21, displaced_volume, "m3", WITHIN(0.0, DMB_MASS_MAX), 0.0) \
    FIELD(T, 22, stabiliser, "", PART_OR_NONE(DMB_PART_STABILISER), {0, 0}) \
    FIELD(T, 23, inner_radius, "m", WITHIN(0.0, DMB_LENGTH_MAX), 0.0) \
    FIELD(T, 24, added_mass, "kg", WITHIN(0.0, DMB_MASS_MAX), {0.0})

#define DMB_JOINT_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, kind, "", WITHIN(DMB_JOINT_FIXED, DMB_JOINT_SCHOENFLIES), DMB_JOINT_FIXED) \
    FIELD(T, 2, name, "", TEXT, "") \
    FIELD(T, 3, place_a, "", GROUND_OR_PLACE, {{0, 0}, 0, 0, 0.0}) \
    FIELD(T, 4, place_b, "", GROUND_OR_PLACE, {{0, 0}, 0, 0, 0.0}) \
    FIELD(T, 5, origin_a, "m", WITHIN(-DMB_POSITION_MAX, DMB_POSITION_MAX), {0.0}) \
    FIELD(T, 6, axis_a, "-", FINITE, {1.0, 0.0, 0.0}) \
    FIELD(T, 7, normal_a, "-", FINITE, {0.0}) \
    FIELD(T, 8, origin_b, "m", ANY, {0.0}) \
    FIELD(T, 9, axis_b, "-", ANY, {1.0, 0.0, 0.0}) \
    FIELD(T, 10, normal_b, "-", ANY, {0.0}) \
    FIELD(T, 11, match, "", WITHIN(0, 1), 0) \
    FIELD(T, 12, state, "", WITHIN(DMB_JOINT_ACTIVE, DMB_JOINT_OPEN), DMB_JOINT_ACTIVE) \
    FIELD(T, 13, length, "m", WITHIN(0.0, DMB_LENGTH_MAX), 1.0) \
    FIELD(T, 14, stiffness, "N/m, N m/rad", WITHIN(0.0, DMB_STIFFNESS_MAX), {0.0}) \
    FIELD(T, 15, damping, "N s/m, N m s", WITHIN(0.0, DMB_DAMPING_MAX), {0.0}) \
    FIELD(T, 16, rest, "m, rad", WITHIN(-DMB_POSITION_MAX, DMB_POSITION_MAX), {0.0}) \
    FIELD(T, 17, friction, "N, N m", WITHIN(0.0, DMB_FORCE_MAX), {0.0}) \
    FIELD(T, 18, friction_speed, "m/s, rad/s", WITHIN(DMB_SPEED_MIN, DMB_SPEED_MAX), 1e-3) \
    FIELD(T, 19, stop_low, "m, rad", WITHIN(-DMB_STOP_MAX, DMB_STOP_MAX), \
          {-DMB_UNLIMITED, -DMB_UNLIMITED, -DMB_UNLIMITED, -DMB_UNLIMITED, -DMB_UNLIMITED, -DMB_UNLIMITED}) \
    FIELD(T, 20, stop_high, "m, rad", WITHIN(-DMB_STOP_MAX, DMB_STOP_MAX), \
          {DMB_UNLIMITED, DMB_UNLIMITED, DMB_UNLIMITED, DMB_UNLIMITED, DMB_UNLIMITED, DMB_UNLIMITED}) \
    FIELD(T, 21, stop_stiffness, "N/m, N m/rad", WITHIN(DMB_STIFFNESS_MIN, DMB_STIFFNESS_MAX), 1e6) \
    FIELD(T, 22, stop_damping, "N s/m, N m s", WITHIN(0.0, DMB_DAMPING_MAX), 0.0) \
    FIELD(T, 23, initial_mask, "-", SET, DMB_FREE_NONE) \
    FIELD(T, 24, initial_position, "m, rad", WITHIN(-DMB_POSITION_MAX, DMB_POSITION_MAX), {0.0}) \
    FIELD(T, 25, initial_speed, "m/s, rad/s", WITHIN(-DMB_SPEED_MAX, DMB_SPEED_MAX), {0.0})

#define DMB_COUPLING_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, name, "", TEXT, "") \
    FIELD(T, 2, joint, "", ANY, {{0, 0}}) \
    FIELD(T, 3, component, "", ANY, {DMB_RX, DMB_RX}) \
    FIELD(T, 4, ratio, "-, m/rad, rad/m", ANY, 1.0) \
    FIELD(T, 5, third_joint, "", ANY, {0, 0}) \
    FIELD(T, 6, fourth_joint, "", ANY, {0, 0}) \
    FIELD(T, 7, third_component, "", ANY, DMB_RX) \
    FIELD(T, 8, fourth_component, "", ANY, DMB_RX) \
    FIELD(T, 9, third_ratio, "-, m/rad, rad/m", ANY, 1.0) \
    FIELD(T, 10, fourth_ratio, "-, m/rad, rad/m", ANY, 1.0)

#define DMB_CONSTRAINT_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, kind, "", WITHIN(DMB_CONSTRAINT_HOLONOMIC, DMB_CONSTRAINT_NONHOLONOMIC), DMB_CONSTRAINT_HOLONOMIC) \
    FIELD(T, 2, name, "", TEXT, "") \
    FIELD(T, 3, row_count, "-", WITHIN(1, DMB_CONSTRAINT_ROWS), 1) \
    FIELD(T, 4, place_count, "-", WITHIN(1, DMB_CONSTRAINT_PLACES), 1) \
    ARRAY(T, 5, place, place_count, 1, "", PLACE, {{{0, 0}, 0, 0, 0.0}}) \
    FIELD(T, 6, provides, "", BITS(DMB_PROVIDES_JACOBIAN), 0) \
    FIELD(T, 7, callback, "", POINTER, NULL) \
    FIELD(T, 8, callback_context, "", ANY, NULL)

#define DMB_DRIVE_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, kind, "", WITHIN(DMB_DRIVE_MOTION, DMB_DRIVE_CONTROL), DMB_DRIVE_MOTION) \
    FIELD(T, 2, part, "", ANY, {0, 0}) \
    FIELD(T, 3, component, "", WITHIN(DMB_X, DMB_RZ), DMB_X) \
    FIELD(T, 4, time_function, "", PART_OR_NONE(DMB_PART_TIME_FUNCTION), {0, 0}) \
    FIELD(T, 5, excitation, "", PART_OR_NONE(DMB_PART_TIME_FUNCTION), {0, 0}) \
    FIELD(T, 6, gain, "N s/m, N m s", WITHIN(0.0, DMB_FORCE_MAX), 0.0) \
    FIELD(T, 7, integral_gain, "N/m, N m", WITHIN(0.0, DMB_FORCE_MAX), 0.0) \
    FIELD(T, 8, limit_low, "N, N m", WITHIN(-DMB_FORCE_MAX, DMB_FORCE_MAX), -DMB_UNLIMITED) \
    FIELD(T, 9, limit_high, "N, N m", WITHIN(-DMB_FORCE_MAX, DMB_FORCE_MAX), DMB_UNLIMITED) \
    FIELD(T, 10, name, "", TEXT, "") \
    FIELD(T, 11, delay, "s", ZERO_OR(DMB_ACTUATOR_TIME_MIN, DMB_DELAY_MAX), 0.0) \
    FIELD(T, 12, force_rate, "N/s, N m/s", ZERO_OR(DMB_SPEED_MIN, DMB_FORCE_MAX), 0.0) \
    FIELD(T, 13, lag, "s", ZERO_OR(DMB_ACTUATOR_TIME_MIN, DMB_TIME_MAX), 0.0) \
    FIELD(T, 14, drag, "N s/m, N m s", WITHIN(0.0, DMB_FORCE_MAX), 0.0) \
    FIELD(T, 15, back_drag, "N s/m, N m s", WITHIN(0.0, DMB_FORCE_MAX), 0.0) \
    FIELD(T, 16, inertia, "kg m2", ZERO_OR(DMB_INERTIA_MIN, DMB_INERTIA_MAX), 0.0) \
    FIELD(T, 17, curve_count, "-", ZERO_OR(2, DMB_CURVE_POINTS), 0) \
    ARRAY(T, 18, curve_speed, curve_count, 1, "m/s, rad/s", WITHIN(-DMB_SPEED_MAX, DMB_SPEED_MAX), {0.0}) \
    ARRAY(T, 19, curve_force, curve_count, 1, "N, N m", WITHIN(0.0, DMB_FORCE_MAX), {0.0}) \
    FIELD(T, 20, gain_count, "-", ZERO_OR(2, DMB_GAIN_POINTS), 0) \
    ARRAY(T, 21, gain_error, gain_count, 1, "m/s, rad/s", WITHIN(-DMB_SPEED_MAX, DMB_SPEED_MAX), {0.0}) \
    ARRAY(T, 22, gain_force, gain_count, 1, "N, N m", WITHIN(-DMB_FORCE_MAX, DMB_FORCE_MAX), {0.0}) \
    FIELD(T, 23, mud_pressure, "Pa/(N m)", WITHIN(0.0, DMB_MODULUS_MAX), 0.0) \
    FIELD(T, 24, value, "m/s, rad/s; N, N m of LOAD", WITHIN(-DMB_FORCE_MAX, DMB_FORCE_MAX), 0.0)

#define DMB_LOAD_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, frame, "", WITHIN(DMB_FRAME_WORLD, DMB_FRAME_HOLE), DMB_FRAME_WORLD) \
    FIELD(T, 2, place, "", PLACE, {{0, 0}, 0, 0, 0.0}) \
    FIELD(T, 3, force, "N", WITHIN(-DMB_FORCE_MAX, DMB_FORCE_MAX), {0.0}) \
    FIELD(T, 4, moment, "N m", WITHIN(-DMB_FORCE_MAX, DMB_FORCE_MAX), {0.0}) \
    FIELD(T, 5, time_function, "-", PART_OR_NONE(DMB_PART_TIME_FUNCTION), {0, 0}) \
    FIELD(T, 6, name, "", TEXT, "") \
    FIELD(T, 7, offset, "m", WITHIN(-DMB_LENGTH_MAX, DMB_LENGTH_MAX), {0.0})

#define DMB_SPRING_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, acts, "", WITHIN(DMB_SPRING_BOTH, DMB_SPRING_COMPRESSION), DMB_SPRING_BOTH) \
    FIELD(T, 2, name, "", TEXT, "") \
    FIELD(T, 3, place_a, "", GROUND_OR_PLACE, {{0, 0}, 0, 0, 0.0}) \
    FIELD(T, 4, place_b, "", GROUND_OR_PLACE, {{0, 0}, 0, 0, 0.0}) \
    FIELD(T, 5, offset_a, "m", WITHIN(-DMB_POSITION_MAX, DMB_POSITION_MAX), {0.0}) \
    FIELD(T, 6, offset_b, "m", WITHIN(-DMB_POSITION_MAX, DMB_POSITION_MAX), {0.0}) \
    FIELD(T, 7, free_length, "m", NOT_GIVEN_OR(0.0, DMB_LENGTH_MAX), DMB_NOT_GIVEN) \
    FIELD(T, 8, stiffness, "N/m", WITHIN(0.0, DMB_STIFFNESS_MAX), 0.0) \
    FIELD(T, 9, damping, "N s/m", WITHIN(0.0, DMB_DAMPING_MAX), 0.0) \
    FIELD(T, 10, preload, "N", WITHIN(-DMB_FORCE_MAX, DMB_FORCE_MAX), 0.0) \
    FIELD(T, 13, table_count, "-", ZERO_OR(2, 1 << 16), 0) \
    ARRAY(T, 11, table_elongation, table_count, 1, "m", WITHIN(-DMB_POSITION_MAX, DMB_POSITION_MAX), NULL) \
    ARRAY(T, 12, table_force, table_count, 1, "N", WITHIN(-DMB_FORCE_MAX, DMB_FORCE_MAX), NULL) \
    FIELD(T, 14, table_kind, "", WITHIN(DMB_TABLE_LINES, DMB_TABLE_CUBIC), DMB_TABLE_LINES)

#define DMB_FORCE_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, frame, "", WITHIN(DMB_FRAME_WORLD, DMB_FRAME_BODY), DMB_FRAME_WORLD) \
    FIELD(T, 2, name, "", TEXT, "") \
    FIELD(T, 3, place_count, "-", WITHIN(1, DMB_CONSTRAINT_PLACES), 1) \
    FIELD(T, 4, provides, "", BITS(DMB_PROVIDES_TANGENT | DMB_PROVIDES_POTENTIAL), 0) \
    ARRAY(T, 5, place, place_count, 1, "", ANY, {{{0, 0}, 0, 0, 0.0}}) \
    ARRAY(T, 6, offset, place_count, 3, "m", ANY, {0.0}) \
    ARRAY(T, 7, component, place_count, 1, "", ANY, {0}) \
    FIELD(T, 8, pose_step, "m, rad", WITHIN(1e-12, 1.0), 1e-5) \
    FIELD(T, 9, speed_step, "m/s, rad/s", WITHIN(1e-12, 1.0), 1e-5) \
    FIELD(T, 10, callback, "", POINTER, NULL) \
    FIELD(T, 11, callback_context, "", ANY, NULL) \
    FIELD(T, 12, state_count, "-", WITHIN(0, 65536), 0) \
    FIELD(T, 13, accept, "", ANY, NULL)

#define DMB_STUCK_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, holds, "", BITS(DMB_STUCK_AXIAL | DMB_STUCK_ROTATION | DMB_STUCK_LATERAL), \
          DMB_STUCK_AXIAL | DMB_STUCK_ROTATION) \
    FIELD(T, 2, name, "", TEXT, "") \
    FIELD(T, 3, place, "", PLACE, {{0, 0}, 0, 0, 0.0}) \
    FIELD(T, 4, stuck, "", WITHIN(0, 1), 1) \
    FIELD(T, 5, stiffness, "N/m, N m/rad, N/m", WITHIN(DMB_DEPTH_MIN, DMB_STIFFNESS_MAX), {1e9, 1e8, 1e9}) \
    FIELD(T, 6, damping, "N s/m, N m s, N s/m", WITHIN(0.0, DMB_DAMPING_MAX), {0.0}) \
    FIELD(T, 7, overpull, "N", ZERO_OR(DMB_DEPTH_MIN, DMB_FORCE_MAX), 0.0) \
    FIELD(T, 8, overtorque, "N m", ZERO_OR(DMB_DEPTH_MIN, DMB_FORCE_MAX), 0.0)

#define DMB_SUB_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, string, "", ANY, {0, 0}) \
    FIELD(T, 2, length, "m", ANY, 0.0) \
    FIELD(T, 3, body, "", ANY, NULL) \
    FIELD(T, 4, before, "", ANY, NULL) \
    FIELD(T, 5, after, "", ANY, NULL) \
    FIELD(T, 6, section, "", ANY, NULL)

#define DMB_INPUT_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, target, "", WITHIN(DMB_TARGET_SET_POINT, DMB_TARGET_FLOW_RATE), DMB_TARGET_SET_POINT) \
    FIELD(T, 2, name, "", TEXT, "") \
    FIELD(T, 3, part, "", ANY, {0, 0}) \
    FIELD(T, 4, initial, "unit of the target", ANY, (double)NAN) \
    FIELD(T, 5, low, "unit of the target", WITHIN(-DMB_FORCE_MAX, DMB_FORCE_MAX), -DMB_UNLIMITED) \
    FIELD(T, 6, high, "unit of the target", WITHIN(-DMB_FORCE_MAX, DMB_FORCE_MAX), DMB_UNLIMITED) \
    FIELD(T, 7, rate_limit, "unit/s", ZERO_OR(DMB_SPEED_MIN, DMB_FORCE_MAX), 0.0) \
    FIELD(T, 8, slope_limit, "unit/s2", ZERO_OR(DMB_SPEED_MIN, DMB_FORCE_MAX), 0.0) \
    FIELD(T, 9, outside, "", WITHIN(DMB_OUTSIDE_REFUSED, DMB_OUTSIDE_CLAMPED), DMB_OUTSIDE_REFUSED)

#define DMB_EVENT_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, direction, "", WITHIN(DMB_EVENT_EITHER, DMB_EVENT_FALLING), DMB_EVENT_RISING) \
    FIELD(T, 2, name, "", TEXT, "") \
    FIELD(T, 3, output, "", ANY, {{{0, 0}, 0, 0, 0.0}, 0, 0}) \
    FIELD(T, 4, level, "unit of the output", WITHIN(-DMB_FORCE_MAX, DMB_FORCE_MAX), 0.0) \
    FIELD(T, 5, hold, "s", WITHIN(0.0, DMB_TIME_MAX), 0.0) \
    FIELD(T, 6, tolerance, "s", WITHIN(DMB_TIME_MIN, 1.0), 1e-9)

#define DMB_COMPILE_OPTIONS_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, features, "", BITS(DMB_FEATURE_ALL), DMB_FEATURE_ALL) \
    FIELD(T, 2, pipe_kind, "", WITHIN(DMB_NOT_GIVEN, DMB_PIPE_RIGID), DMB_NOT_GIVEN)

/* X(number, struct, part in messages, kind of its id, size in the first release, fields): numbers never change. */
#define DMB_DESCRIBED(X) \
    X(1, dmb_environment_def, "environment", 0, 64, DMB_ENVIRONMENT_FIELDS) \
    X(2, dmb_segment, "time function", DMB_PART_TIME_FUNCTION, 120, DMB_SEGMENT_FIELDS) \
    X(3, dmb_wall_def, "wall", DMB_PART_WALL, 184, DMB_WALL_FIELDS) \
    X(4, dmb_hole_section, "hole sections", 0, 104, DMB_HOLE_SECTION_FIELDS) \
    X(5, dmb_string_def, "string", DMB_PART_STRING, 136, DMB_STRING_FIELDS) \
    X(6, dmb_pipe_def, "pipes", 0, 264, DMB_PIPE_FIELDS) \
    X(7, dmb_stabiliser_def, "stabiliser", DMB_PART_STABILISER, 96, DMB_STABILISER_FIELDS) \
    X(8, dmb_body_def, "body", DMB_PART_BODY, 216, DMB_BODY_FIELDS) \
    X(9, dmb_bit_def, "bit", DMB_PART_BIT, 136, DMB_BIT_FIELDS) \
    X(10, dmb_joint_def, "joint", DMB_PART_JOINT, 656, DMB_JOINT_FIELDS) \
    X(11, dmb_coupling_def, "coupling", DMB_PART_COUPLING, 64, DMB_COUPLING_FIELDS) \
    X(12, dmb_constraint_def, "constraint", DMB_PART_CONSTRAINT, 160, DMB_CONSTRAINT_FIELDS) \
    X(13, dmb_drive_def, "drive", DMB_PART_DRIVE, 80, DMB_DRIVE_FIELDS) \
    X(14, dmb_load_def, "load", DMB_PART_LOAD, 88, DMB_LOAD_FIELDS) \
    X(15, dmb_spring_def, "spring", DMB_PART_SPRING, 184, DMB_SPRING_FIELDS) \
    X(16, dmb_force_def, "force", DMB_PART_FORCE, 296, DMB_FORCE_FIELDS) \
    X(17, dmb_stuck_def, "stuck", DMB_PART_STUCK, 128, DMB_STUCK_FIELDS) \
    X(18, dmb_sub_def, "sub", 0, 56, DMB_SUB_FIELDS) \
    X(19, dmb_input_def, "input", DMB_PART_INPUT, 88, DMB_INPUT_FIELDS) \
    X(20, dmb_event_def, "event", DMB_PART_EVENT, 88, DMB_EVENT_FIELDS) \
    X(21, dmb_compile_options, "scene", 0, 16, DMB_COMPILE_OPTIONS_FIELDS)

/* clang-format on */

#endif
