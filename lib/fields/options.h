/* One list for each struct of options of a call, with rows as in fields/lists.h. From these come the defaults (T_init),
 * the checks of single fields with their messages (dmb_options_get), and the ranges that the package of Python states
 * for the tables of a scene file (python test_fields). Relations between fields stand where the options are read.
 * Options are not part of a scene record, so that their numbers have no further use. */
#ifndef DMB_FIELDS_OPTIONS_H
#define DMB_FIELDS_OPTIONS_H

/* clang-format off */

#define DMB_SIM_OPTIONS_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, max_iterations, "-", WITHIN(1, 1000), 12) \
    FIELD(T, 2, allocator, "", ANY, NULL) \
    FIELD(T, 3, log, "", ANY, NULL) \
    FIELD(T, 4, log_context, "", ANY, NULL) \
    FIELD(T, 5, spectral_radius, "-", WITHIN(0.0, 1.0), 0.8) \
    FIELD(T, 6, newton_tolerance, "-", ZERO_OR(1e-14, 0.1), 0.0) \
    FIELD(T, 7, tolerance_translation, "m", ABOVE(0.0), 1e-6) \
    FIELD(T, 8, tolerance_rotation, "rad", ABOVE(0.0), 1e-5) \
    FIELD(T, 9, step_min, "s", ABOVE(0.0), 1e-9) \
    FIELD(T, 10, step_max, "s", ABOVE(0.0), 0.1) \
    FIELD(T, 11, max_cuts, "-", WITHIN(0, 30), 12) \
    FIELD(T, 12, bounded_work, "", WITHIN(0, 1), 0) \
    FIELD(T, 13, energy_ledger, "", WITHIN(0, 1), 1) \
    FIELD(T, 14, max_steps, "-", ANY, 0) \
    FIELD(T, 15, constraint_method, "", WITHIN(DMB_METHOD_INDEPENDENT, DMB_METHOD_MULTIPLIERS), DMB_METHOD_INDEPENDENT) \
    FIELD(T, 16, parallel, "", ANY, NULL) \
    FIELD(T, 17, parallel_context, "", ANY, NULL) \
    FIELD(T, 18, parallel_parts, "-", WITHIN(1, DMB_PARALLEL_MAX), 2) \
    FIELD(T, 19, parallel_least, "-", ANY, 1000) \
    FIELD(T, 20, assembly_energy, "J", WITHIN(0.0, DMB_OPTION_MAX), 1e-3)

#define DMB_STATIC_OPTIONS_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, max_iterations, "-", WITHIN(1, 10000), 60) \
    FIELD(T, 2, tolerance, "-", WITHIN(1e-15, 0.1), 1e-10) \
    FIELD(T, 3, slip_axial, "m/s", WITHIN(-DMB_SLIP_MAX, DMB_SLIP_MAX), 0.0) \
    FIELD(T, 4, slip_rotation, "rad/s", WITHIN(-DMB_SLIP_MAX, DMB_SLIP_MAX), 0.0) \
    FIELD(T, 5, load_steps, "-", WITHIN(0, 10000), 0) \
    FIELD(T, 6, lay_on_wall, "", WITHIN(0, 1), 1) \
    FIELD(T, 7, steady, "", WITHIN(DMB_STEADY_AUTO, DMB_STEADY_RIGID), DMB_STEADY_AUTO)

#define DMB_BUCKLING_OPTIONS_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, count, "-", WITHIN(1, 10000), 1) \
    FIELD(T, 2, scale, "", WITHIN(DMB_SCALE_ALL, DMB_SCALE_PART), DMB_SCALE_LOADS) \
    FIELD(T, 3, follow, "", WITHIN(0, 1), 1) \
    FIELD(T, 4, part, "", ANY, {0, 0}) \
    FIELD(T, 5, factor_max, "unit of the factor", WITHIN(1e-300, DMB_OPTION_MAX), DMB_FACTOR_MAX) \
    FIELD(T, 6, tolerance, "-", WITHIN(1e-15, 0.1), 1e-10) \
    FIELD(T, 7, step, "unit of the factor", WITHIN(0.0, DMB_FORCE_MAX), 0.0) \
    FIELD(T, 8, slip_axial, "m/s", WITHIN(-DMB_SLIP_MAX, DMB_SLIP_MAX), 0.0) \
    FIELD(T, 9, slip_rotation, "rad/s", WITHIN(-DMB_SLIP_MAX, DMB_SLIP_MAX), 0.0)

#define DMB_PATH_OPTIONS_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, max_points, "-", WITHIN(1, 1000000), 200) \
    FIELD(T, 2, max_iterations, "-", WITHIN(2, 1000), 15) \
    FIELD(T, 3, scale, "", WITHIN(DMB_SCALE_ALL, DMB_SCALE_PART), DMB_SCALE_LOADS) \
    FIELD(T, 4, part, "", ANY, {0, 0}) \
    FIELD(T, 5, place, "", ANY, {{0, 0}, 0, 0, 0.0}) \
    FIELD(T, 6, component, "", WITHIN(DMB_X, DMB_Z), DMB_X) \
    FIELD(T, 7, branch, "", WITHIN(-1, 1), 0) \
    FIELD(T, 8, factor_end, "unit of the factor", WITHIN(-DMB_FORCE_MAX, DMB_FORCE_MAX), 1.0) \
    FIELD(T, 9, displacement_end, "m", WITHIN(-DMB_STOP_MAX, DMB_STOP_MAX), DMB_UNLIMITED) \
    FIELD(T, 10, first_step, "unit of the factor", WITHIN(0.0, DMB_FORCE_MAX), 0.0) \
    FIELD(T, 11, step_max, "m", ABOVE(0.0), DMB_UNLIMITED) \
    FIELD(T, 12, branch_size, "m", WITHIN(0.0, DMB_LENGTH_MAX), 0.0) \
    FIELD(T, 13, tolerance, "-", WITHIN(1e-15, 0.1), 1e-10) \
    FIELD(T, 14, slip_axial, "m/s", WITHIN(-DMB_SLIP_MAX, DMB_SLIP_MAX), 0.0) \
    FIELD(T, 15, slip_rotation, "rad/s", WITHIN(-DMB_SLIP_MAX, DMB_SLIP_MAX), 0.0) \
    FIELD(T, 16, callback, "", ANY, NULL) \
    FIELD(T, 17, callback_context, "", ANY, NULL)

#define DMB_MODES_OPTIONS_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, kind, "", WITHIN(DMB_MODES_UNDAMPED, DMB_MODES_DAMPED), DMB_MODES_UNDAMPED) \
    FIELD(T, 2, select, "", WITHIN(DMB_MODES_LOWEST, DMB_MODES_BAND), DMB_MODES_LOWEST) \
    FIELD(T, 3, count, "-", WITHIN(1, UINT32_MAX - 1), 10) \
    FIELD(T, 4, band, "Hz", WITHIN(0.0, 1e12), {0.0, 100.0}) \
    FIELD(T, 5, contact, "", WITHIN(DMB_CONTACT_AS_IS, DMB_CONTACT_CLOSED), DMB_CONTACT_AS_IS) \
    FIELD(T, 6, friction, "", WITHIN(0, 1), 1) \
    FIELD(T, 7, contact_gap, "m", WITHIN(0.0, DMB_LENGTH_MAX), 0.0) \
    FIELD(T, 8, equilibrium_tolerance, "-", ABOVE(0.0), 1e-6) \
    FIELD(T, 9, axes, "", WITHIN(DMB_MODES_AXES_TURNING, DMB_MODES_AXES_AT_REST), DMB_MODES_AXES_TURNING) \
    FIELD(T, 10, spin, "rad/s", WITHIN(-DMB_SLIP_MAX, DMB_SLIP_MAX), 0.0)

#define DMB_RESPONSE_OPTIONS_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, points, "-", WITHIN(1, 1000000), 1000) \
    FIELD(T, 2, frequency_low, "Hz", WITHIN(0.0, DMB_FREQUENCY_MAX), 1.0) \
    FIELD(T, 3, frequency_high, "Hz", WITHIN(0.0, DMB_FREQUENCY_MAX), 100.0) \
    FIELD(T, 4, frequencies, "Hz", ANY, NULL) \
    FIELD(T, 5, logarithmic, "", WITHIN(0, 1), 0) \
    FIELD(T, 6, refinement, "-", WITHIN(0, DMB_REFINEMENT_MAX), 0) \
    FIELD(T, 7, structural_damping, "-", WITHIN(0.0, 1e3), 0.0) \
    FIELD(T, 8, equilibrium_tolerance, "-", WITHIN(1e-6, 1.0), 1e-6) \
    FIELD(T, 9, contact, "", WITHIN(DMB_CONTACT_AS_IS, DMB_CONTACT_CLOSED), DMB_CONTACT_AS_IS) \
    FIELD(T, 10, friction, "", WITHIN(0, 1), 1) \
    FIELD(T, 11, contact_gap, "m", WITHIN(0.0, DMB_LENGTH_MAX), 0.0) \
    FIELD(T, 12, axes, "", WITHIN(DMB_RESPONSE_AXES_TURNING, DMB_RESPONSE_AXES_AT_REST), DMB_RESPONSE_AXES_TURNING) \
    FIELD(T, 13, spin, "rad/s", WITHIN(-DMB_SLIP_MAX, DMB_SLIP_MAX), 0.0)

#define DMB_STEPPED_SINE_OPTIONS_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, steps_per_period, "-", WITHIN(16, 1000000), 100) \
    FIELD(T, 2, periods, "-", WITHIN(1, 10000), 4) \
    FIELD(T, 3, windows, "-", WITHIN(3, 1000000), 500) \
    FIELD(T, 4, harmonics, "-", WITHIN(1, DMB_STEPPED_SINE_HARMONICS_MAX), 3) \
    FIELD(T, 5, tolerance, "-", WITHIN(1e-12, 1.0), 1e-3) \
    FIELD(T, 6, floor, "unit of the output", WITHIN(1e-300, DMB_FORCE_MAX), 1e-12)

#define DMB_ORDER_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, order, "-", WITHIN(1e-3, 1e3), 1.0) \
    FIELD(T, 2, excitation, "", ANY, {(uint32_t)sizeof(dmb_excitation), DMB_EXCITATION_ECCENTRICITY, .amplitude = 1.0})

#define DMB_SPEEDS_OPTIONS_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, points, "-", WITHIN(2, 100000), 200) \
    FIELD(T, 2, speed_low, "rad/s", WITHIN(1e-6, DMB_SLIP_MAX), 1.0) \
    FIELD(T, 3, speed_high, "rad/s", WITHIN(1e-6, DMB_SLIP_MAX), 30.0) \
    FIELD(T, 4, threshold, "-", WITHIN(1e-9, 1e9), 1.0) \
    FIELD(T, 5, margin, "-", WITHIN(0.0, 0.5), 0.03) \
    FIELD(T, 6, refinement, "-", WITHIN(0, DMB_REFINEMENT_MAX), 12) \
    FIELD(T, 7, contact, "", WITHIN(DMB_CONTACT_AS_IS, DMB_CONTACT_CLOSED), DMB_CONTACT_AS_IS) \
    FIELD(T, 8, friction, "", WITHIN(0, 1), 0) \
    FIELD(T, 9, contact_gap, "m", WITHIN(0.0, DMB_LENGTH_MAX), 0.0) \
    FIELD(T, 10, structural_damping, "-", WITHIN(0.0, 1e3), 0.0) \
    FIELD(T, 11, equilibrium_tolerance, "-", WITHIN(1e-6, 1.0), 1e-6) \
    FIELD(T, 12, report, "", ANY, NULL) \
    FIELD(T, 13, spin, "rad/s", WITHIN(-DMB_SLIP_MAX, DMB_SLIP_MAX), 0.0)

#define DMB_FATIGUE_OPTIONS_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, classes, "-", WITHIN(8, 65536), 1024) \
    FIELD(T, 2, points, "-", WITHIN(2, 360), 8) \
    FIELD(T, 3, stress_range, "Pa", WITHIN(1.0, DMB_MODULUS_MAX), 1e9) \
    FIELD(T, 4, concentration, "-", WITHIN(1.0, 100.0), 1.0) \
    FIELD(T, 5, curve_stress, "Pa", WITHIN(1.0, DMB_MODULUS_MAX), 0.0) \
    FIELD(T, 6, curve_cycles, "-", WITHIN(1.0, 1e30), 1e6) \
    FIELD(T, 7, slope, "-", WITHIN(1.0, 50.0), 0.0) \
    FIELD(T, 8, endurance, "Pa", WITHIN(0.0, DMB_MODULUS_MAX), 0.0) \
    FIELD(T, 9, tensile_strength, "Pa", WITHIN(0.0, DMB_MODULUS_MAX), 0.0)

#define DMB_TORQUE_DRAG_OPTIONS_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, post_buckling, "", WITHIN(0, 1), 1) \
    FIELD(T, 2, string, "", ANY, {0, 0}) \
    FIELD(T, 3, friction, "-", NOT_GIVEN_OR(0.0, DMB_FRICTION_MAX), DMB_NOT_GIVEN) \
    FIELD(T, 4, depths, "m", ANY, NULL) \
    FIELD(T, 5, depth_count, "-", WITHIN(1, 1 << 20), 1) \
    FIELD(T, 6, friction_by_depth, "", WITHIN(0, 1), 0)

#define DMB_STATE_SPACE_OPTIONS_FIELDS(FIELD, ARRAY, T) \
    FIELD(T, 1, form, "", WITHIN(DMB_STATE_FULL, DMB_STATE_MATRICES), DMB_STATE_FULL) \
    FIELD(T, 2, motion, "", WITHIN(DMB_MOTION_SPEED, DMB_MOTION_ACCELERATION), DMB_MOTION_SPEED) \
    FIELD(T, 3, static_correction, "", WITHIN(0, 1), 1) \
    FIELD(T, 4, modes, "", ANY, NULL) \
    FIELD(T, 5, mode_list, "-", ANY, NULL) \
    FIELD(T, 6, mode_count, "-", ANY, 0) \
    FIELD(T, 7, contact, "", WITHIN(DMB_CONTACT_AS_IS, DMB_CONTACT_CLOSED), DMB_CONTACT_AS_IS) \
    FIELD(T, 8, friction, "", WITHIN(0, 1), 1) \
    FIELD(T, 9, contact_gap, "m", WITHIN(0.0, DMB_LENGTH_MAX), 0.0) \
    FIELD(T, 10, equilibrium_tolerance, "-", WITHIN(1e-6, 1.0), 1e-6) \
    FIELD(T, 11, shift, "Hz", WITHIN(0.0, DMB_FREQUENCY_MAX), 0.0)

/* X(number, struct, word in messages, kind of its id, size in the first release, fields), as in fields/lists.h. */
#define DMB_OPTIONS(X) \
    X(0, dmb_sim_options, "sim options", 0, 96, DMB_SIM_OPTIONS_FIELDS) \
    X(0, dmb_static_options, "static options", 0, 40, DMB_STATIC_OPTIONS_FIELDS) \
    X(0, dmb_buckling_options, "buckling options", 0, 64, DMB_BUCKLING_OPTIONS_FIELDS) \
    X(0, dmb_path_options, "path options", 0, 136, DMB_PATH_OPTIONS_FIELDS) \
    X(0, dmb_modes_options, "modes options", 0, 56, DMB_MODES_OPTIONS_FIELDS) \
    X(0, dmb_response_options, "response options", 0, 72, DMB_RESPONSE_OPTIONS_FIELDS) \
    X(0, dmb_stepped_sine_options, "sine options", 0, 40, DMB_STEPPED_SINE_OPTIONS_FIELDS) \
    X(0, dmb_order, "order", 0, 72, DMB_ORDER_FIELDS) \
    X(0, dmb_speeds_options, "speeds options", 0, 80, DMB_SPEEDS_OPTIONS_FIELDS) \
    X(0, dmb_fatigue_options, "fatigue", 0, 72, DMB_FATIGUE_OPTIONS_FIELDS) \
    X(0, dmb_torque_drag_options, "torque and drag options", 0, 40, DMB_TORQUE_DRAG_OPTIONS_FIELDS) \
    X(0, dmb_state_space_options, "state space options", 0, 72, DMB_STATE_SPACE_OPTIONS_FIELDS)

/* clang-format on */

#endif
