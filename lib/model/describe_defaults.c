/* Defaults of the structs of model.h and forces.h, as documented there. The number is the struct's size in its first
 * release. */
#include "model/describe.h"

/* clang-format off */
DMB_DEFINE_INIT(dmb_model_options, 48, {.log = NULL})

DMB_DEFINE_INIT(dmb_environment_def, 64, {.gravity = {0.0, 0.0, -9.81}, .inner_density = -1.0, .flow_exponent = 1.0})

DMB_DEFINE_INIT(dmb_segment, 96, {.kind = DMB_SEGMENT_CONSTANT, .x1 = 1.0})

DMB_DEFINE_INIT(dmb_wall_def, 184, {
    .direction = {1.0, 0.0, 0.0},
    .diameter = 0.094,
    .normal_law = DMB_NORMAL_EXACT,
    .friction_law = DMB_FRICTION_STRIBECK,
    .stiffness = 1e7,
    .exponent = 1.0,
    .restitution = 0.4,
    .impact_depth = 1e-4,
    .approach_speed = 0.01,
    .mu_static = 0.35,
    .mu_dynamic = 0.30,
    .stribeck_speed = 1e-2,
    .smoothing_speed = 1e-3,
    .full_speed = 1e-2,
    .bristle_stiffness = 1e4,
})

DMB_DEFINE_INIT(dmb_string_def, 136, {
    .follows_hole = 1,
    .start_free = DMB_FREE_CYLINDRICAL,
    .end_free = DMB_FREE_ALL,
})

DMB_DEFINE_INIT(dmb_pipe_def, 264, {
    .kind = DMB_PIPE_FLEXIBLE,
    .elements = 1,
    .seed = 1,
    .length = 1.0,
    .outer_diameter = 0.073,
    .inner_diameter = 0.061,
    .young_modulus = 2.1e11,
    .poisson_ratio = 0.3,
    .density = 7850.0,
    .shear_factor = 0.5,
})

DMB_DEFINE_INIT(dmb_body_def, 216, {
    .attach = DMB_ATTACH_NONE,
    .mass = 1.0,
    .inertia = {1e-3, 1e-3, 1e-3, 0.0, 0.0, 0.0},
    .free_mask = DMB_FREE_ALL,
    .contact_length = 1.0,
})

DMB_DEFINE_INIT(dmb_bit_def, 136, {
    .rock_law = DMB_ROCK_NONE,
    .mass = 5.0,
    .diameter = 0.092,
    .length = 0.1,
    .radius = 0.047,
    .intrinsic_energy = 1e7,
    .cutting_ratio = 0.6,
    .contact_strength = 1e7,
    .wear_length = 1e-3,
    .contact_friction = 0.5,
    .intrusion_depth = 1e-4,
    .blades = 4,
    .history = 1024,
})

DMB_DEFINE_INIT(dmb_joint_def, 656, {
    .kind = DMB_JOINT_FIXED,
    .initial_mask = DMB_FREE_NONE,
    .axis_a = {1.0, 0.0, 0.0},
    .axis_b = {1.0, 0.0, 0.0},
    .state = DMB_JOINT_ACTIVE,
    .length = 1.0,
    .friction_speed = 1e-3,
    .stop_low = {-1e30, -1e30, -1e30, -1e30, -1e30, -1e30},
    .stop_high = {1e30, 1e30, 1e30, 1e30, 1e30, 1e30},
    .stop_stiffness = 1e6,
})

DMB_DEFINE_INIT(dmb_coupling_def, 64, {
    .component = {DMB_RX, DMB_RX},
    .ratio = 1.0,
    .third_component = DMB_RX,
    .fourth_component = DMB_RX,
    .third_ratio = 1.0,
    .fourth_ratio = 1.0,
})

DMB_DEFINE_INIT(dmb_constraint_def, 160, {.kind = DMB_CONSTRAINT_HOLONOMIC, .row_count = 1, .place_count = 1})

DMB_DEFINE_INIT(dmb_drive_def, 72, {
    .kind = DMB_DRIVE_MOTION,
    .component = DMB_X,
    .limit_low = -1e30,
    .limit_high = 1e30,
})

DMB_DEFINE_INIT(dmb_load_def, 88, {.frame = DMB_FRAME_WORLD})

DMB_DEFINE_INIT(dmb_force_def, 280, {.place_count = 1, .pose_step = 1e-5, .speed_step = 1e-5})

DMB_DEFINE_INIT(dmb_stuck_def, 128, {
    .holds = DMB_STUCK_AXIAL | DMB_STUCK_ROTATION,
    .stuck = 1,
    .stiffness = {1e9, 1e8, 1e9},
})

DMB_DEFINE_INIT(dmb_spring_def, 184, {.acts = DMB_SPRING_BOTH, .free_length = -1.0})

DMB_DEFINE_INIT(dmb_compile_options, 16, {.features = DMB_FEATURE_ALL, .pipe_kind = -1})

DMB_DEFINE_INIT(dmb_model_info, 72, {.strings = 0})
/* clang-format on */
