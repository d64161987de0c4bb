/* Names, units and places of all outputs, in order of their numbers. Names are part of the interface: they must not
 * change. */
#include <stddef.h>
#include <string.h>

#include "base/failure.h"
#include "drillmbd/ask.h"
#include "query/query.h"

/* ---- Outputs ---------------------------------------------------------------------------------------------------- */

/* clang-format off */
static const dmb_output_entry names[] = {
    {"displacement_x", "m", DMB_OUTPUT_DISPLACEMENT_X, DMB_AT_PLACE},
    {"displacement_y", "m", DMB_OUTPUT_DISPLACEMENT_Y, DMB_AT_PLACE},
    {"displacement_z", "m", DMB_OUTPUT_DISPLACEMENT_Z, DMB_AT_PLACE},
    {"velocity_x", "m/s", DMB_OUTPUT_VELOCITY_X, DMB_AT_PLACE},
    {"velocity_y", "m/s", DMB_OUTPUT_VELOCITY_Y, DMB_AT_PLACE},
    {"velocity_z", "m/s", DMB_OUTPUT_VELOCITY_Z, DMB_AT_PLACE},
    {"position_x", "m", DMB_OUTPUT_POSITION_X, DMB_AT_PLACE},
    {"position_y", "m", DMB_OUTPUT_POSITION_Y, DMB_AT_PLACE},
    {"position_z", "m", DMB_OUTPUT_POSITION_Z, DMB_AT_PLACE},
    {"rotation", "rad", DMB_OUTPUT_ROTATION, DMB_AT_PLACE},
    {"spin", "rad/s", DMB_OUTPUT_SPIN, DMB_AT_PLACE},
    {"axial_force", "N", DMB_OUTPUT_AXIAL_FORCE, DMB_AT_SECTION},
    {"torque", "N m", DMB_OUTPUT_TORQUE, DMB_AT_SECTION},
    {"bending_moment", "N m", DMB_OUTPUT_BENDING_MOMENT, DMB_AT_SECTION},
    {"kinetic_energy", "J", DMB_OUTPUT_KINETIC_ENERGY, DMB_AT_PART},
    {"normal_force", "N", DMB_OUTPUT_NORMAL_FORCE, DMB_AT_PART},
    {"drive_force", "N or N m", DMB_OUTPUT_DRIVE_FORCE, DMB_AT_DRIVE},
    {"drive_speed", "m/s or rad/s", DMB_OUTPUT_DRIVE_SPEED, DMB_AT_DRIVE},
    {"bit_weight", "N", DMB_OUTPUT_BIT_WEIGHT, DMB_AT_BIT},
    {"energy_error", "-", DMB_OUTPUT_ENERGY_ERROR, DMB_AT_SCENE},
    {"hook_load", "N", DMB_OUTPUT_HOOK_LOAD, DMB_AT_STRING},
    {"rotation_torque", "N m", DMB_OUTPUT_ROTATION_TORQUE, DMB_AT_STRING},
    {"weight_on_bit", "N", DMB_OUTPUT_WEIGHT_ON_BIT, DMB_AT_STRING},
    {"torque_on_bit", "N m", DMB_OUTPUT_TORQUE_ON_BIT, DMB_AT_STRING},
    {"rate_of_penetration", "m/s", DMB_OUTPUT_RATE_OF_PENETRATION, DMB_AT_STRING},
    {"bit_speed", "rad/s", DMB_OUTPUT_BIT_SPEED, DMB_AT_STRING},
    {"bit_depth", "m", DMB_OUTPUT_BIT_DEPTH, DMB_AT_STRING},
    {"rotary_speed", "rad/s", DMB_OUTPUT_ROTARY_SPEED, DMB_AT_STRING},
    {"feed_speed", "m/s", DMB_OUTPUT_FEED_SPEED, DMB_AT_STRING},
    {"stretch", "m", DMB_OUTPUT_STRETCH, DMB_AT_STRING},
    {"wind_up", "rad", DMB_OUTPUT_WIND_UP, DMB_AT_STRING},
    {"off_bottom", "-", DMB_OUTPUT_OFF_BOTTOM, DMB_AT_STRING},
    {"rig_force", "N", DMB_OUTPUT_RIG_FORCE, DMB_AT_STRING},
    {"rig_torque", "N m", DMB_OUTPUT_RIG_TORQUE, DMB_AT_STRING},
    {"bit_advance", "m", DMB_OUTPUT_BIT_ADVANCE, DMB_AT_BIT},
    {"bit_bottom", "m", DMB_OUTPUT_BIT_BOTTOM, DMB_AT_BIT},
    {"bit_depth_of_cut", "m", DMB_OUTPUT_BIT_DEPTH_OF_CUT, DMB_AT_BIT},
    {"bit_rock_weight", "N", DMB_OUTPUT_BIT_ROCK_WEIGHT, DMB_AT_BIT},
    {"bit_torque", "N m", DMB_OUTPUT_BIT_TORQUE, DMB_AT_BIT},
    {"bit_load", "N", DMB_OUTPUT_BIT_LOAD, DMB_AT_BIT},
    {"bit_on_bottom", "-", DMB_OUTPUT_BIT_ON_BOTTOM, DMB_AT_BIT},
    {"stuck", "-", DMB_OUTPUT_STUCK, DMB_AT_STUCK},
    {"stuck_force", "N", DMB_OUTPUT_STUCK_FORCE, DMB_AT_STUCK},
    {"stuck_torque", "N m", DMB_OUTPUT_STUCK_TORQUE, DMB_AT_STUCK},
    {"drive_target", "unit of the time function", DMB_OUTPUT_DRIVE_TARGET, DMB_AT_DRIVE},
    {"drive_position", "m or rad", DMB_OUTPUT_DRIVE_POSITION, DMB_AT_DRIVE},
    {"drive_power", "W", DMB_OUTPUT_DRIVE_POWER, DMB_AT_DRIVE},
    {"drive_work", "J", DMB_OUTPUT_DRIVE_WORK, DMB_AT_DRIVE},
    {"drive_command", "N or N m", DMB_OUTPUT_DRIVE_COMMAND, DMB_AT_DRIVE},
    {"drive_made", "N or N m", DMB_OUTPUT_DRIVE_MADE, DMB_AT_DRIVE},
    {"contact_gap", "m", DMB_OUTPUT_CONTACT_GAP, DMB_AT_CONTACT},
    {"contact_normal_force", "N", DMB_OUTPUT_CONTACT_NORMAL_FORCE, DMB_AT_CONTACT},
    {"contact_approach", "m/s", DMB_OUTPUT_CONTACT_APPROACH, DMB_AT_CONTACT},
    {"contact_friction_axial", "N", DMB_OUTPUT_CONTACT_FRICTION_AXIAL, DMB_AT_CONTACT},
    {"contact_friction_around", "N", DMB_OUTPUT_CONTACT_FRICTION_AROUND, DMB_AT_CONTACT},
    {"contact_slip_axial", "m/s", DMB_OUTPUT_CONTACT_SLIP_AXIAL, DMB_AT_CONTACT},
    {"contact_slip_around", "m/s", DMB_OUTPUT_CONTACT_SLIP_AROUND, DMB_AT_CONTACT},
    {"contact_closed", "-", DMB_OUTPUT_CONTACT_CLOSED, DMB_AT_CONTACT},
    {"contact_sticks", "-", DMB_OUTPUT_CONTACT_STICKS, DMB_AT_CONTACT},
    {"contacts_closed", "-", DMB_OUTPUT_CONTACTS_CLOSED, DMB_AT_SCENE},
    {"contacts_normal_force", "N", DMB_OUTPUT_CONTACTS_NORMAL_FORCE, DMB_AT_SCENE},
    {"contacts_friction_axial", "N", DMB_OUTPUT_CONTACTS_FRICTION_AXIAL, DMB_AT_SCENE},
    {"contacts_friction_around", "N", DMB_OUTPUT_CONTACTS_FRICTION_AROUND, DMB_AT_SCENE},
    {"contacts_deepest", "m", DMB_OUTPUT_CONTACTS_DEEPEST, DMB_AT_SCENE},
    {"energy_kinetic", "J", DMB_OUTPUT_ENERGY_KINETIC, DMB_AT_SCENE},
    {"energy_strain", "J", DMB_OUTPUT_ENERGY_STRAIN, DMB_AT_SCENE},
    {"energy_gravity", "J", DMB_OUTPUT_ENERGY_GRAVITY, DMB_AT_SCENE},
    {"energy_contact", "J", DMB_OUTPUT_ENERGY_CONTACT, DMB_AT_SCENE},
    {"energy_drives", "J", DMB_OUTPUT_ENERGY_DRIVES, DMB_AT_SCENE},
    {"energy_loads", "J", DMB_OUTPUT_ENERGY_LOADS, DMB_AT_SCENE},
    {"energy_friction", "J", DMB_OUTPUT_ENERGY_FRICTION, DMB_AT_SCENE},
    {"energy_impact", "J", DMB_OUTPUT_ENERGY_IMPACT, DMB_AT_SCENE},
    {"energy_damping", "J", DMB_OUTPUT_ENERGY_DAMPING, DMB_AT_SCENE},
    {"energy_rock", "J", DMB_OUTPUT_ENERGY_ROCK, DMB_AT_SCENE},
    {"energy_scheme", "J", DMB_OUTPUT_ENERGY_SCHEME, DMB_AT_SCENE},
    {"energy_input", "J", DMB_OUTPUT_ENERGY_INPUT, DMB_AT_SCENE},
    {"energy_balance", "J", DMB_OUTPUT_ENERGY_BALANCE, DMB_AT_SCENE},
    {"energy_unexplained", "J", DMB_OUTPUT_ENERGY_UNEXPLAINED, DMB_AT_SCENE},
    {"momentum_x", "kg m/s", DMB_OUTPUT_MOMENTUM_X, DMB_AT_SCENE},
    {"momentum_y", "kg m/s", DMB_OUTPUT_MOMENTUM_Y, DMB_AT_SCENE},
    {"momentum_z", "kg m/s", DMB_OUTPUT_MOMENTUM_Z, DMB_AT_SCENE},
    {"angular_momentum_x", "kg m2/s", DMB_OUTPUT_ANGULAR_MOMENTUM_X, DMB_AT_SCENE},
    {"angular_momentum_y", "kg m2/s", DMB_OUTPUT_ANGULAR_MOMENTUM_Y, DMB_AT_SCENE},
    {"angular_momentum_z", "kg m2/s", DMB_OUTPUT_ANGULAR_MOMENTUM_Z, DMB_AT_SCENE},
    {"mass", "kg", DMB_OUTPUT_MASS, DMB_AT_SCENE},
    {"centre_x", "m", DMB_OUTPUT_CENTRE_X, DMB_AT_SCENE},
    {"centre_y", "m", DMB_OUTPUT_CENTRE_Y, DMB_AT_SCENE},
    {"centre_z", "m", DMB_OUTPUT_CENTRE_Z, DMB_AT_SCENE},
    {"steps", "-", DMB_OUTPUT_STEPS, DMB_AT_SCENE},
    {"rejected", "-", DMB_OUTPUT_REJECTED, DMB_AT_SCENE},
    {"iterations", "-", DMB_OUTPUT_ITERATIONS, DMB_AT_SCENE},
    {"limited_steps", "-", DMB_OUTPUT_LIMITED_STEPS, DMB_AT_SCENE},
    {"most_iterations", "-", DMB_OUTPUT_MOST_ITERATIONS, DMB_AT_SCENE},
    {"largest_residual", "-", DMB_OUTPUT_LARGEST_RESIDUAL, DMB_AT_SCENE},
    {"switches", "-", DMB_OUTPUT_SWITCHES, DMB_AT_SCENE},
    {"dependent", "-", DMB_OUTPUT_DEPENDENT, DMB_AT_SCENE},
    {"redundant", "-", DMB_OUTPUT_REDUNDANT, DMB_AT_SCENE},
    {"violation", "m or -", DMB_OUTPUT_VIOLATION, DMB_AT_SCENE},
    {"spring_length", "m", DMB_OUTPUT_SPRING_LENGTH, DMB_AT_SPRING},
    {"spring_elongation", "m", DMB_OUTPUT_SPRING_ELONGATION, DMB_AT_SPRING},
    {"spring_speed", "m/s", DMB_OUTPUT_SPRING_SPEED, DMB_AT_SPRING},
    {"spring_force", "N", DMB_OUTPUT_SPRING_FORCE, DMB_AT_SPRING},
    {"spring_elastic", "N", DMB_OUTPUT_SPRING_ELASTIC, DMB_AT_SPRING},
    {"spring_damper", "N", DMB_OUTPUT_SPRING_DAMPER, DMB_AT_SPRING},
    {"spring_energy", "J", DMB_OUTPUT_SPRING_ENERGY, DMB_AT_SPRING},
    {"input_present", "unit of the input", DMB_OUTPUT_INPUT_PRESENT, DMB_AT_INPUT},
    {"input_rate", "unit of the input/s", DMB_OUTPUT_INPUT_RATE, DMB_AT_INPUT},
    {"input_value", "unit of the input", DMB_OUTPUT_INPUT_VALUE, DMB_AT_INPUT},
    {"joint_position_x", "m", DMB_OUTPUT_JOINT_POSITION, DMB_AT_JOINT},
    {"joint_position_y", "m", DMB_OUTPUT_JOINT_POSITION + 1, DMB_AT_JOINT},
    {"joint_position_z", "m", DMB_OUTPUT_JOINT_POSITION + 2, DMB_AT_JOINT},
    {"joint_position_rx", "rad", DMB_OUTPUT_JOINT_POSITION + 3, DMB_AT_JOINT},
    {"joint_position_ry", "rad", DMB_OUTPUT_JOINT_POSITION + 4, DMB_AT_JOINT},
    {"joint_position_rz", "rad", DMB_OUTPUT_JOINT_POSITION + 5, DMB_AT_JOINT},
    {"joint_speed_x", "m/s", DMB_OUTPUT_JOINT_SPEED, DMB_AT_JOINT},
    {"joint_speed_y", "m/s", DMB_OUTPUT_JOINT_SPEED + 1, DMB_AT_JOINT},
    {"joint_speed_z", "m/s", DMB_OUTPUT_JOINT_SPEED + 2, DMB_AT_JOINT},
    {"joint_speed_rx", "rad/s", DMB_OUTPUT_JOINT_SPEED + 3, DMB_AT_JOINT},
    {"joint_speed_ry", "rad/s", DMB_OUTPUT_JOINT_SPEED + 4, DMB_AT_JOINT},
    {"joint_speed_rz", "rad/s", DMB_OUTPUT_JOINT_SPEED + 5, DMB_AT_JOINT},
    {"joint_acceleration_x", "m/s2", DMB_OUTPUT_JOINT_ACCELERATION, DMB_AT_JOINT},
    {"joint_acceleration_y", "m/s2", DMB_OUTPUT_JOINT_ACCELERATION + 1, DMB_AT_JOINT},
    {"joint_acceleration_z", "m/s2", DMB_OUTPUT_JOINT_ACCELERATION + 2, DMB_AT_JOINT},
    {"joint_acceleration_rx", "rad/s2", DMB_OUTPUT_JOINT_ACCELERATION + 3, DMB_AT_JOINT},
    {"joint_acceleration_ry", "rad/s2", DMB_OUTPUT_JOINT_ACCELERATION + 4, DMB_AT_JOINT},
    {"joint_acceleration_rz", "rad/s2", DMB_OUTPUT_JOINT_ACCELERATION + 5, DMB_AT_JOINT},
    {"joint_reaction_x", "N", DMB_OUTPUT_JOINT_REACTION, DMB_AT_JOINT},
    {"joint_reaction_y", "N", DMB_OUTPUT_JOINT_REACTION + 1, DMB_AT_JOINT},
    {"joint_reaction_z", "N", DMB_OUTPUT_JOINT_REACTION + 2, DMB_AT_JOINT},
    {"joint_reaction_rx", "N m", DMB_OUTPUT_JOINT_REACTION + 3, DMB_AT_JOINT},
    {"joint_reaction_ry", "N m", DMB_OUTPUT_JOINT_REACTION + 4, DMB_AT_JOINT},
    {"joint_reaction_rz", "N m", DMB_OUTPUT_JOINT_REACTION + 5, DMB_AT_JOINT},
    {"joint_reaction_body_x", "N", DMB_OUTPUT_JOINT_REACTION_BODY, DMB_AT_JOINT},
    {"joint_reaction_body_y", "N", DMB_OUTPUT_JOINT_REACTION_BODY + 1, DMB_AT_JOINT},
    {"joint_reaction_body_z", "N", DMB_OUTPUT_JOINT_REACTION_BODY + 2, DMB_AT_JOINT},
    {"joint_reaction_body_rx", "N m", DMB_OUTPUT_JOINT_REACTION_BODY + 3, DMB_AT_JOINT},
    {"joint_reaction_body_ry", "N m", DMB_OUTPUT_JOINT_REACTION_BODY + 4, DMB_AT_JOINT},
    {"joint_reaction_body_rz", "N m", DMB_OUTPUT_JOINT_REACTION_BODY + 5, DMB_AT_JOINT},
    {"joint_action_x", "N", DMB_OUTPUT_JOINT_ACTION, DMB_AT_JOINT},
    {"joint_action_y", "N", DMB_OUTPUT_JOINT_ACTION + 1, DMB_AT_JOINT},
    {"joint_action_z", "N", DMB_OUTPUT_JOINT_ACTION + 2, DMB_AT_JOINT},
    {"joint_action_rx", "N m", DMB_OUTPUT_JOINT_ACTION + 3, DMB_AT_JOINT},
    {"joint_action_ry", "N m", DMB_OUTPUT_JOINT_ACTION + 4, DMB_AT_JOINT},
    {"joint_action_rz", "N m", DMB_OUTPUT_JOINT_ACTION + 5, DMB_AT_JOINT},
    {"joint_violation", "m or -", DMB_OUTPUT_JOINT_VIOLATION, DMB_AT_JOINT},
    {"joint_state", "-", DMB_OUTPUT_JOINT_STATE, DMB_AT_JOINT},
    {"joint_rows", "-", DMB_OUTPUT_JOINT_ROWS, DMB_AT_JOINT},
    {"multiplier_0", "N or N m", DMB_OUTPUT_MULTIPLIER, DMB_AT_CONSTRAINT},
    {"multiplier_1", "N or N m", DMB_OUTPUT_MULTIPLIER + 1, DMB_AT_CONSTRAINT},
    {"multiplier_2", "N or N m", DMB_OUTPUT_MULTIPLIER + 2, DMB_AT_CONSTRAINT},
    {"multiplier_3", "N or N m", DMB_OUTPUT_MULTIPLIER + 3, DMB_AT_CONSTRAINT},
    {"multiplier_4", "N or N m", DMB_OUTPUT_MULTIPLIER + 4, DMB_AT_CONSTRAINT},
    {"multiplier_5", "N or N m", DMB_OUTPUT_MULTIPLIER + 5, DMB_AT_CONSTRAINT},
    {"reaction_x", "N", DMB_OUTPUT_REACTION, DMB_AT_PART},
    {"reaction_y", "N", DMB_OUTPUT_REACTION + 1, DMB_AT_PART},
    {"reaction_z", "N", DMB_OUTPUT_REACTION + 2, DMB_AT_PART},
    {"reaction_rx", "N m", DMB_OUTPUT_REACTION + 3, DMB_AT_PART},
    {"reaction_ry", "N m", DMB_OUTPUT_REACTION + 4, DMB_AT_PART},
    {"reaction_rz", "N m", DMB_OUTPUT_REACTION + 5, DMB_AT_PART},
    {"section_force_x", "N", DMB_OUTPUT_SECTION_FORCE, DMB_AT_SECTION},
    {"section_force_y", "N", DMB_OUTPUT_SECTION_FORCE + 1, DMB_AT_SECTION},
    {"section_force_z", "N", DMB_OUTPUT_SECTION_FORCE + 2, DMB_AT_SECTION},
    {"section_force_rx", "N m", DMB_OUTPUT_SECTION_FORCE + 3, DMB_AT_SECTION},
    {"section_force_ry", "N m", DMB_OUTPUT_SECTION_FORCE + 4, DMB_AT_SECTION},
    {"section_force_rz", "N m", DMB_OUTPUT_SECTION_FORCE + 5, DMB_AT_SECTION},
    {"section_strain_x", "-", DMB_OUTPUT_SECTION_STRAIN, DMB_AT_SECTION},
    {"section_strain_y", "-", DMB_OUTPUT_SECTION_STRAIN + 1, DMB_AT_SECTION},
    {"section_strain_z", "-", DMB_OUTPUT_SECTION_STRAIN + 2, DMB_AT_SECTION},
    {"section_strain_rx", "rad/m", DMB_OUTPUT_SECTION_STRAIN + 3, DMB_AT_SECTION},
    {"section_strain_ry", "rad/m", DMB_OUTPUT_SECTION_STRAIN + 4, DMB_AT_SECTION},
    {"section_strain_rz", "rad/m", DMB_OUTPUT_SECTION_STRAIN + 5, DMB_AT_SECTION},
    {"world_velocity_x", "m/s", DMB_OUTPUT_WORLD_VELOCITY, DMB_AT_PLACE},
    {"world_velocity_y", "m/s", DMB_OUTPUT_WORLD_VELOCITY + 1, DMB_AT_PLACE},
    {"world_velocity_z", "m/s", DMB_OUTPUT_WORLD_VELOCITY + 2, DMB_AT_PLACE},
    {"world_velocity_rx", "rad/s", DMB_OUTPUT_WORLD_VELOCITY + 3, DMB_AT_PLACE},
    {"world_velocity_ry", "rad/s", DMB_OUTPUT_WORLD_VELOCITY + 4, DMB_AT_PLACE},
    {"world_velocity_rz", "rad/s", DMB_OUTPUT_WORLD_VELOCITY + 5, DMB_AT_PLACE},
    {"world_acceleration_x", "m/s2", DMB_OUTPUT_WORLD_ACCELERATION, DMB_AT_PLACE},
    {"world_acceleration_y", "m/s2", DMB_OUTPUT_WORLD_ACCELERATION + 1, DMB_AT_PLACE},
    {"world_acceleration_z", "m/s2", DMB_OUTPUT_WORLD_ACCELERATION + 2, DMB_AT_PLACE},
    {"world_acceleration_rx", "rad/s2", DMB_OUTPUT_WORLD_ACCELERATION + 3, DMB_AT_PLACE},
    {"world_acceleration_ry", "rad/s2", DMB_OUTPUT_WORLD_ACCELERATION + 4, DMB_AT_PLACE},
    {"world_acceleration_rz", "rad/s2", DMB_OUTPUT_WORLD_ACCELERATION + 5, DMB_AT_PLACE},
    {"body_velocity_x", "m/s", DMB_OUTPUT_BODY_VELOCITY, DMB_AT_PLACE},
    {"body_velocity_y", "m/s", DMB_OUTPUT_BODY_VELOCITY + 1, DMB_AT_PLACE},
    {"body_velocity_z", "m/s", DMB_OUTPUT_BODY_VELOCITY + 2, DMB_AT_PLACE},
    {"body_velocity_rx", "rad/s", DMB_OUTPUT_BODY_VELOCITY + 3, DMB_AT_PLACE},
    {"body_velocity_ry", "rad/s", DMB_OUTPUT_BODY_VELOCITY + 4, DMB_AT_PLACE},
    {"body_velocity_rz", "rad/s", DMB_OUTPUT_BODY_VELOCITY + 5, DMB_AT_PLACE},
    {"body_acceleration_x", "m/s2", DMB_OUTPUT_BODY_ACCELERATION, DMB_AT_PLACE},
    {"body_acceleration_y", "m/s2", DMB_OUTPUT_BODY_ACCELERATION + 1, DMB_AT_PLACE},
    {"body_acceleration_z", "m/s2", DMB_OUTPUT_BODY_ACCELERATION + 2, DMB_AT_PLACE},
    {"body_acceleration_rx", "rad/s2", DMB_OUTPUT_BODY_ACCELERATION + 3, DMB_AT_PLACE},
    {"body_acceleration_ry", "rad/s2", DMB_OUTPUT_BODY_ACCELERATION + 4, DMB_AT_PLACE},
    {"body_acceleration_rz", "rad/s2", DMB_OUTPUT_BODY_ACCELERATION + 5, DMB_AT_PLACE},
    {"vibration_x", "m", DMB_OUTPUT_VIBRATION, DMB_AT_VIBRATION},
    {"vibration_y", "m", DMB_OUTPUT_VIBRATION + 1, DMB_AT_VIBRATION},
    {"vibration_z", "m", DMB_OUTPUT_VIBRATION + 2, DMB_AT_VIBRATION},
    {"vibration_rx", "rad", DMB_OUTPUT_VIBRATION + 3, DMB_AT_VIBRATION},
    {"vibration_ry", "rad", DMB_OUTPUT_VIBRATION + 4, DMB_AT_VIBRATION},
    {"vibration_rz", "rad", DMB_OUTPUT_VIBRATION + 5, DMB_AT_VIBRATION},
    {"vibration_body_x", "m", DMB_OUTPUT_VIBRATION_BODY, DMB_AT_VIBRATION},
    {"vibration_body_y", "m", DMB_OUTPUT_VIBRATION_BODY + 1, DMB_AT_VIBRATION},
    {"vibration_body_z", "m", DMB_OUTPUT_VIBRATION_BODY + 2, DMB_AT_VIBRATION},
    {"vibration_body_rx", "rad", DMB_OUTPUT_VIBRATION_BODY + 3, DMB_AT_VIBRATION},
    {"vibration_body_ry", "rad", DMB_OUTPUT_VIBRATION_BODY + 4, DMB_AT_VIBRATION},
    {"vibration_body_rz", "rad", DMB_OUTPUT_VIBRATION_BODY + 5, DMB_AT_VIBRATION},
    {"vibration_velocity_x", "m/s", DMB_OUTPUT_VIBRATION_VELOCITY, DMB_AT_VIBRATION},
    {"vibration_velocity_y", "m/s", DMB_OUTPUT_VIBRATION_VELOCITY + 1, DMB_AT_VIBRATION},
    {"vibration_velocity_z", "m/s", DMB_OUTPUT_VIBRATION_VELOCITY + 2, DMB_AT_VIBRATION},
    {"vibration_velocity_rx", "rad/s", DMB_OUTPUT_VIBRATION_VELOCITY + 3, DMB_AT_VIBRATION},
    {"vibration_velocity_ry", "rad/s", DMB_OUTPUT_VIBRATION_VELOCITY + 4, DMB_AT_VIBRATION},
    {"vibration_velocity_rz", "rad/s", DMB_OUTPUT_VIBRATION_VELOCITY + 5, DMB_AT_VIBRATION},
    {"vibration_velocity_body_x", "m/s", DMB_OUTPUT_VIBRATION_VELOCITY_BODY, DMB_AT_VIBRATION},
    {"vibration_velocity_body_y", "m/s", DMB_OUTPUT_VIBRATION_VELOCITY_BODY + 1, DMB_AT_VIBRATION},
    {"vibration_velocity_body_z", "m/s", DMB_OUTPUT_VIBRATION_VELOCITY_BODY + 2, DMB_AT_VIBRATION},
    {"vibration_velocity_body_rx", "rad/s", DMB_OUTPUT_VIBRATION_VELOCITY_BODY + 3, DMB_AT_VIBRATION},
    {"vibration_velocity_body_ry", "rad/s", DMB_OUTPUT_VIBRATION_VELOCITY_BODY + 4, DMB_AT_VIBRATION},
    {"vibration_velocity_body_rz", "rad/s", DMB_OUTPUT_VIBRATION_VELOCITY_BODY + 5, DMB_AT_VIBRATION},
    {"vibration_acceleration_x", "m/s2", DMB_OUTPUT_VIBRATION_ACCELERATION, DMB_AT_VIBRATION},
    {"vibration_acceleration_y", "m/s2", DMB_OUTPUT_VIBRATION_ACCELERATION + 1, DMB_AT_VIBRATION},
    {"vibration_acceleration_z", "m/s2", DMB_OUTPUT_VIBRATION_ACCELERATION + 2, DMB_AT_VIBRATION},
    {"vibration_acceleration_rx", "rad/s2", DMB_OUTPUT_VIBRATION_ACCELERATION + 3, DMB_AT_VIBRATION},
    {"vibration_acceleration_ry", "rad/s2", DMB_OUTPUT_VIBRATION_ACCELERATION + 4, DMB_AT_VIBRATION},
    {"vibration_acceleration_rz", "rad/s2", DMB_OUTPUT_VIBRATION_ACCELERATION + 5, DMB_AT_VIBRATION},
    {"vibration_acceleration_body_x", "m/s2", DMB_OUTPUT_VIBRATION_ACCELERATION_BODY, DMB_AT_VIBRATION},
    {"vibration_acceleration_body_y", "m/s2", DMB_OUTPUT_VIBRATION_ACCELERATION_BODY + 1, DMB_AT_VIBRATION},
    {"vibration_acceleration_body_z", "m/s2", DMB_OUTPUT_VIBRATION_ACCELERATION_BODY + 2, DMB_AT_VIBRATION},
    {"vibration_acceleration_body_rx", "rad/s2", DMB_OUTPUT_VIBRATION_ACCELERATION_BODY + 3, DMB_AT_VIBRATION},
    {"vibration_acceleration_body_ry", "rad/s2", DMB_OUTPUT_VIBRATION_ACCELERATION_BODY + 4, DMB_AT_VIBRATION},
    {"vibration_acceleration_body_rz", "rad/s2", DMB_OUTPUT_VIBRATION_ACCELERATION_BODY + 5, DMB_AT_VIBRATION},
    {"profile_distance", "m", DMB_OUTPUT_PROFILE + DMB_PROFILE_DISTANCE, DMB_AT_PIPE},
    {"profile_depth", "m", DMB_OUTPUT_PROFILE + DMB_PROFILE_DEPTH, DMB_AT_PIPE},
    {"profile_x", "m", DMB_OUTPUT_PROFILE + DMB_PROFILE_X, DMB_AT_PIPE},
    {"profile_y", "m", DMB_OUTPUT_PROFILE + DMB_PROFILE_Y, DMB_AT_PIPE},
    {"profile_z", "m", DMB_OUTPUT_PROFILE + DMB_PROFILE_Z, DMB_AT_PIPE},
    {"profile_deviation", "m", DMB_OUTPUT_PROFILE + DMB_PROFILE_DEVIATION, DMB_AT_PIPE},
    {"profile_deviation_side", "m", DMB_OUTPUT_PROFILE + DMB_PROFILE_DEVIATION_SIDE, DMB_AT_PIPE},
    {"profile_deviation_up", "m", DMB_OUTPUT_PROFILE + DMB_PROFILE_DEVIATION_UP, DMB_AT_PIPE},
    {"profile_axial_force", "N", DMB_OUTPUT_PROFILE + DMB_PROFILE_AXIAL_FORCE, DMB_AT_PIPE},
    {"profile_effective_force", "N", DMB_OUTPUT_PROFILE + DMB_PROFILE_EFFECTIVE_FORCE, DMB_AT_PIPE},
    {"profile_torque", "N m", DMB_OUTPUT_PROFILE + DMB_PROFILE_TORQUE, DMB_AT_PIPE},
    {"profile_bending_moment", "N m", DMB_OUTPUT_PROFILE + DMB_PROFILE_BENDING_MOMENT, DMB_AT_PIPE},
    {"profile_shear_force", "N", DMB_OUTPUT_PROFILE + DMB_PROFILE_SHEAR_FORCE, DMB_AT_PIPE},
    {"profile_curvature", "rad/m", DMB_OUTPUT_PROFILE + DMB_PROFILE_CURVATURE, DMB_AT_PIPE},
    {"profile_normal_force", "N/m", DMB_OUTPUT_PROFILE + DMB_PROFILE_NORMAL_FORCE, DMB_AT_PIPE},
    {"profile_friction_axial", "N/m", DMB_OUTPUT_PROFILE + DMB_PROFILE_FRICTION_AXIAL, DMB_AT_PIPE},
    {"profile_friction_around", "N/m", DMB_OUTPUT_PROFILE + DMB_PROFILE_FRICTION_AROUND, DMB_AT_PIPE},
    {"profile_von_mises", "Pa", DMB_OUTPUT_PROFILE + DMB_PROFILE_VON_MISES, DMB_AT_PIPE},
    {"profile_yield_share", "-", DMB_OUTPUT_PROFILE + DMB_PROFILE_YIELD_SHARE, DMB_AT_PIPE},
    {"profile_sinusoidal_share", "-", DMB_OUTPUT_PROFILE + DMB_PROFILE_SINUSOIDAL_SHARE, DMB_AT_PIPE},
    {"profile_helical_share", "-", DMB_OUTPUT_PROFILE + DMB_PROFILE_HELICAL_SHARE, DMB_AT_PIPE},
    {"profile_velocity_axial", "m/s", DMB_OUTPUT_PROFILE + DMB_PROFILE_VELOCITY_AXIAL, DMB_AT_PIPE},
    {"profile_velocity_lateral", "m/s", DMB_OUTPUT_PROFILE + DMB_PROFILE_VELOCITY_LATERAL, DMB_AT_PIPE},
    {"profile_spin", "rad/s", DMB_OUTPUT_PROFILE + DMB_PROFILE_SPIN, DMB_AT_PIPE},
    {"profile_acceleration_axial", "m/s2", DMB_OUTPUT_PROFILE + DMB_PROFILE_ACCELERATION_AXIAL, DMB_AT_PIPE},
    {"profile_acceleration_lateral", "m/s2", DMB_OUTPUT_PROFILE + DMB_PROFILE_ACCELERATION_LATERAL, DMB_AT_PIPE},
    {"profile_rotation", "rad", DMB_OUTPUT_PROFILE + DMB_PROFILE_ROTATION, DMB_AT_PIPE},
    {"profile_displacement_x", "m", DMB_OUTPUT_PROFILE + DMB_PROFILE_DISPLACEMENT_X, DMB_AT_PIPE},
    {"profile_displacement_y", "m", DMB_OUTPUT_PROFILE + DMB_PROFILE_DISPLACEMENT_Y, DMB_AT_PIPE},
    {"profile_displacement_z", "m", DMB_OUTPUT_PROFILE + DMB_PROFILE_DISPLACEMENT_Z, DMB_AT_PIPE},
    {"profile_shear_y", "N", DMB_OUTPUT_PROFILE + DMB_PROFILE_SHEAR_Y, DMB_AT_PIPE},
    {"profile_shear_z", "N", DMB_OUTPUT_PROFILE + DMB_PROFILE_SHEAR_Z, DMB_AT_PIPE},
    {"profile_moment_y", "N m", DMB_OUTPUT_PROFILE + DMB_PROFILE_MOMENT_Y, DMB_AT_PIPE},
    {"profile_moment_z", "N m", DMB_OUTPUT_PROFILE + DMB_PROFILE_MOMENT_Z, DMB_AT_PIPE},
    {"profile_gap", "m", DMB_OUTPUT_PROFILE + DMB_PROFILE_GAP, DMB_AT_PIPE},
    {"window_minimum", "unit of the output", DMB_OUTPUT_WINDOW_MINIMUM, DMB_AT_WINDOW},
    {"window_maximum", "unit of the output", DMB_OUTPUT_WINDOW_MAXIMUM, DMB_AT_WINDOW},
    {"window_mean", "unit of the output", DMB_OUTPUT_WINDOW_MEAN, DMB_AT_WINDOW},
    {"window_rms", "unit of the output", DMB_OUTPUT_WINDOW_RMS, DMB_AT_WINDOW},
    {"stick_slip_index", "-", DMB_OUTPUT_STICK_SLIP_INDEX, DMB_AT_WINDOW},
    {"window_low_share", "-", DMB_OUTPUT_WINDOW_LOW_SHARE, DMB_AT_WINDOW},
};
/* clang-format on */

enum { NAME_COUNT = sizeof names / sizeof names[0] };

/* First entry whose number is not lower; entries of query.h are at the index of their number. */
static size_t place_of(int32_t quantity)
{
    size_t low = 0, high = NAME_COUNT;
    if (quantity >= 0 && quantity <= DMB_OUTPUT_ENERGY_ERROR) return (size_t)quantity;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (names[middle].quantity < quantity)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

const dmb_output_entry *dmb_output_name_of(int32_t quantity)
{
    const size_t at = place_of(quantity);
    return at < NAME_COUNT && names[at].quantity == quantity ? &names[at] : NULL;
}

const char *dmb_output_name(int32_t quantity, const char **unit)
{
    const dmb_output_entry *found = dmb_output_name_of(quantity);
    if (unit != NULL) *unit = found != NULL ? found->unit : NULL;
    return found != NULL ? found->name : NULL;
}

int32_t dmb_output_quantity(const char *name, int32_t *quantity)
{
    if (name == NULL || quantity == NULL) return dmb_failed("output", DMB_ERR_NULL);
    for (size_t i = 0; i < NAME_COUNT; i++) {
        if (strcmp(names[i].name, name) != 0) continue;
        *quantity = names[i].quantity;
        return DMB_OK;
    }
    return dmb_failed("output", DMB_ERR_VALUE);
}

int32_t dmb_output_next(int32_t quantity)
{
    const size_t at = quantity < 0 ? 0 : quantity == INT32_MAX ? NAME_COUNT : place_of(quantity + 1);
    return at < NAME_COUNT ? names[at].quantity : -1;
}

/* ---- Profiles ---------------------------------------------------------------------------------------------------- */

/* Names, units and required groups of the quantities of a profile. */

static const struct quantity {
    const char *name, *unit;
    int32_t groups;
} quantities_of[DMB_PROFILE_QUANTITIES] = {
    [DMB_PROFILE_DISTANCE] = {"distance", "m", DMB_TAKES_STATION},
    [DMB_PROFILE_DEPTH] = {"depth", "m", DMB_TAKES_POSE},
    [DMB_PROFILE_X] = {"x", "m", DMB_TAKES_POSE},
    [DMB_PROFILE_Y] = {"y", "m", DMB_TAKES_POSE},
    [DMB_PROFILE_Z] = {"z", "m", DMB_TAKES_POSE},
    [DMB_PROFILE_DEVIATION] = {"deviation", "m", DMB_TAKES_POSE},
    [DMB_PROFILE_DEVIATION_SIDE] = {"deviation_side", "m", DMB_TAKES_POSE},
    [DMB_PROFILE_DEVIATION_UP] = {"deviation_up", "m", DMB_TAKES_POSE},
    [DMB_PROFILE_AXIAL_FORCE] = {"axial_force", "N", DMB_TAKES_POSE | DMB_TAKES_SECTION | DMB_TAKES_PRESSURE},
    [DMB_PROFILE_EFFECTIVE_FORCE] = {"effective_force", "N", DMB_TAKES_SECTION},
    [DMB_PROFILE_TORQUE] = {"torque", "N m", DMB_TAKES_SECTION},
    [DMB_PROFILE_BENDING_MOMENT] = {"bending_moment", "N m", DMB_TAKES_SECTION | DMB_TAKES_BENDING},
    [DMB_PROFILE_SHEAR_FORCE] = {"shear_force", "N", DMB_TAKES_SECTION},
    [DMB_PROFILE_CURVATURE] = {"curvature", "rad/m", DMB_TAKES_SECTION | DMB_TAKES_BENDING},
    [DMB_PROFILE_NORMAL_FORCE] = {"normal_force", "N/m", DMB_TAKES_CONTACT},
    [DMB_PROFILE_FRICTION_AXIAL] = {"friction_axial", "N/m", DMB_TAKES_CONTACT},
    [DMB_PROFILE_FRICTION_AROUND] = {"friction_around", "N/m", DMB_TAKES_CONTACT},
    [DMB_PROFILE_VON_MISES] = {"von_mises", "Pa", DMB_TAKES_SECTION | DMB_TAKES_LIMITS | DMB_TAKES_BENDING},
    [DMB_PROFILE_YIELD_SHARE] = {"yield_share", "-", DMB_TAKES_SECTION | DMB_TAKES_LIMITS | DMB_TAKES_BENDING},
    [DMB_PROFILE_SINUSOIDAL_SHARE] = {"sinusoidal_share", "-", DMB_TAKES_POSE | DMB_TAKES_SECTION | DMB_TAKES_BUCKLING},
    [DMB_PROFILE_HELICAL_SHARE] = {"helical_share", "-", DMB_TAKES_POSE | DMB_TAKES_SECTION | DMB_TAKES_BUCKLING},
    [DMB_PROFILE_VELOCITY_AXIAL] = {"velocity_axial", "m/s", DMB_TAKES_MOTION},
    [DMB_PROFILE_VELOCITY_LATERAL] = {"velocity_lateral", "m/s", DMB_TAKES_MOTION},
    [DMB_PROFILE_SPIN] = {"spin", "rad/s", DMB_TAKES_MOTION},
    [DMB_PROFILE_ACCELERATION_AXIAL] = {"acceleration_axial", "m/s2", DMB_TAKES_MOTION},
    [DMB_PROFILE_ACCELERATION_LATERAL] = {"acceleration_lateral", "m/s2", DMB_TAKES_MOTION},
    [DMB_PROFILE_ROTATION] = {"rotation", "rad", DMB_TAKES_POSE},
    [DMB_PROFILE_DISPLACEMENT_X] = {"displacement_x", "m", DMB_TAKES_POSE},
    [DMB_PROFILE_DISPLACEMENT_Y] = {"displacement_y", "m", DMB_TAKES_POSE},
    [DMB_PROFILE_DISPLACEMENT_Z] = {"displacement_z", "m", DMB_TAKES_POSE},
    [DMB_PROFILE_SHEAR_Y] = {"shear_y", "N", DMB_TAKES_SECTION},
    [DMB_PROFILE_SHEAR_Z] = {"shear_z", "N", DMB_TAKES_SECTION},
    [DMB_PROFILE_MOMENT_Y] = {"moment_y", "N m", DMB_TAKES_SECTION},
    [DMB_PROFILE_MOMENT_Z] = {"moment_z", "N m", DMB_TAKES_SECTION},
    [DMB_PROFILE_GAP] = {"gap", "m", DMB_TAKES_CONTACT},
};

static int is_quantity(int32_t quantity)
{
    return quantity >= 0 && quantity < DMB_PROFILE_QUANTITIES;
}

int32_t dmb_profile_groups(int32_t quantity)
{
    return is_quantity(quantity) ? quantities_of[quantity].groups : -1;
}

const char *dmb_profile_name(int32_t quantity, const char **unit)
{
    if (unit != NULL) *unit = is_quantity(quantity) ? quantities_of[quantity].unit : NULL;
    return is_quantity(quantity) ? quantities_of[quantity].name : NULL;
}
