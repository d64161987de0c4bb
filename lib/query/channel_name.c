/* Names, units and places of all channels, by rising number. Names are part of the interface: they do not change. */
#include <stddef.h>
#include <string.h>

#include "drillmbd/output.h"
#include "query/channel.h"

/* clang-format off */
static const dmb_channel_entry names[] = {
    {DMB_CHANNEL_DISPLACEMENT_X, "displacement_x", "m", DMB_AT_PLACE},
    {DMB_CHANNEL_DISPLACEMENT_Y, "displacement_y", "m", DMB_AT_PLACE},
    {DMB_CHANNEL_DISPLACEMENT_Z, "displacement_z", "m", DMB_AT_PLACE},
    {DMB_CHANNEL_VELOCITY_X, "velocity_x", "m/s", DMB_AT_PLACE},
    {DMB_CHANNEL_VELOCITY_Y, "velocity_y", "m/s", DMB_AT_PLACE},
    {DMB_CHANNEL_VELOCITY_Z, "velocity_z", "m/s", DMB_AT_PLACE},
    {DMB_CHANNEL_POSITION_X, "position_x", "m", DMB_AT_PLACE},
    {DMB_CHANNEL_POSITION_Y, "position_y", "m", DMB_AT_PLACE},
    {DMB_CHANNEL_POSITION_Z, "position_z", "m", DMB_AT_PLACE},
    {DMB_CHANNEL_ROTATION, "rotation", "rad", DMB_AT_PLACE},
    {DMB_CHANNEL_SPIN, "spin", "rad/s", DMB_AT_PLACE},
    {DMB_CHANNEL_AXIAL_FORCE, "axial_force", "N", DMB_AT_SECTION},
    {DMB_CHANNEL_TORQUE, "torque", "N m", DMB_AT_SECTION},
    {DMB_CHANNEL_BENDING_MOMENT, "bending_moment", "N m", DMB_AT_SECTION},
    {DMB_CHANNEL_KINETIC_ENERGY, "kinetic_energy", "J", DMB_AT_PART},
    {DMB_CHANNEL_NORMAL_FORCE, "normal_force", "N", DMB_AT_PART},
    {DMB_CHANNEL_DRIVE_FORCE, "drive_force", "N or N m", DMB_AT_DRIVE},
    {DMB_CHANNEL_DRIVE_SPEED, "drive_speed", "m/s or rad/s", DMB_AT_DRIVE},
    {DMB_CHANNEL_BIT_WEIGHT, "bit_weight", "N", DMB_AT_BIT},
    {DMB_CHANNEL_ENERGY_ERROR, "energy_error", "-", DMB_AT_SCENE},
    {DMB_CHANNEL_HOOK_LOAD, "hook_load", "N", DMB_AT_STRING},
    {DMB_CHANNEL_ROTATION_TORQUE, "rotation_torque", "N m", DMB_AT_STRING},
    {DMB_CHANNEL_WEIGHT_ON_BIT, "weight_on_bit", "N", DMB_AT_STRING},
    {DMB_CHANNEL_TORQUE_ON_BIT, "torque_on_bit", "N m", DMB_AT_STRING},
    {DMB_CHANNEL_RATE_OF_PENETRATION, "rate_of_penetration", "m/s", DMB_AT_STRING},
    {DMB_CHANNEL_BIT_SPEED, "bit_speed", "rad/s", DMB_AT_STRING},
    {DMB_CHANNEL_BIT_DEPTH, "bit_depth", "m", DMB_AT_STRING},
    {DMB_CHANNEL_ROTARY_SPEED, "rotary_speed", "rad/s", DMB_AT_STRING},
    {DMB_CHANNEL_FEED_SPEED, "feed_speed", "m/s", DMB_AT_STRING},
    {DMB_CHANNEL_STRETCH, "stretch", "m", DMB_AT_STRING},
    {DMB_CHANNEL_WIND_UP, "wind_up", "rad", DMB_AT_STRING},
    {DMB_CHANNEL_OFF_BOTTOM, "off_bottom", "-", DMB_AT_STRING},
    {DMB_CHANNEL_RIG_FORCE, "rig_force", "N", DMB_AT_STRING},
    {DMB_CHANNEL_RIG_TORQUE, "rig_torque", "N m", DMB_AT_STRING},
    {DMB_CHANNEL_BIT_ADVANCE, "bit_advance", "m", DMB_AT_BIT},
    {DMB_CHANNEL_BIT_BOTTOM, "bit_bottom", "m", DMB_AT_BIT},
    {DMB_CHANNEL_BIT_DEPTH_OF_CUT, "bit_depth_of_cut", "m", DMB_AT_BIT},
    {DMB_CHANNEL_BIT_ROCK_WEIGHT, "bit_rock_weight", "N", DMB_AT_BIT},
    {DMB_CHANNEL_BIT_TORQUE, "bit_torque", "N m", DMB_AT_BIT},
    {DMB_CHANNEL_BIT_LOAD, "bit_load", "N", DMB_AT_BIT},
    {DMB_CHANNEL_BIT_ON_BOTTOM, "bit_on_bottom", "-", DMB_AT_BIT},
    {DMB_CHANNEL_DRIVE_TARGET, "drive_target", "unit of the programme", DMB_AT_DRIVE},
    {DMB_CHANNEL_DRIVE_POSITION, "drive_position", "m or rad", DMB_AT_DRIVE},
    {DMB_CHANNEL_DRIVE_POWER, "drive_power", "W", DMB_AT_DRIVE},
    {DMB_CHANNEL_DRIVE_WORK, "drive_work", "J", DMB_AT_DRIVE},
    {DMB_CHANNEL_SITE_GAP, "site_gap", "m", DMB_AT_SITE},
    {DMB_CHANNEL_SITE_NORMAL_FORCE, "site_normal_force", "N", DMB_AT_SITE},
    {DMB_CHANNEL_SITE_APPROACH, "site_approach", "m/s", DMB_AT_SITE},
    {DMB_CHANNEL_SITE_FRICTION_AXIAL, "site_friction_axial", "N", DMB_AT_SITE},
    {DMB_CHANNEL_SITE_FRICTION_AROUND, "site_friction_around", "N", DMB_AT_SITE},
    {DMB_CHANNEL_SITE_SLIP_AXIAL, "site_slip_axial", "m/s", DMB_AT_SITE},
    {DMB_CHANNEL_SITE_SLIP_AROUND, "site_slip_around", "m/s", DMB_AT_SITE},
    {DMB_CHANNEL_SITE_CLOSED, "site_closed", "-", DMB_AT_SITE},
    {DMB_CHANNEL_SITE_STICKS, "site_sticks", "-", DMB_AT_SITE},
    {DMB_CHANNEL_CONTACTS_CLOSED, "contacts_closed", "-", DMB_AT_SCENE},
    {DMB_CHANNEL_CONTACTS_NORMAL_FORCE, "contacts_normal_force", "N", DMB_AT_SCENE},
    {DMB_CHANNEL_CONTACTS_FRICTION_AXIAL, "contacts_friction_axial", "N", DMB_AT_SCENE},
    {DMB_CHANNEL_CONTACTS_FRICTION_AROUND, "contacts_friction_around", "N", DMB_AT_SCENE},
    {DMB_CHANNEL_CONTACTS_DEEPEST, "contacts_deepest", "m", DMB_AT_SCENE},
    {DMB_CHANNEL_ENERGY_KINETIC, "energy_kinetic", "J", DMB_AT_SCENE},
    {DMB_CHANNEL_ENERGY_STRAIN, "energy_strain", "J", DMB_AT_SCENE},
    {DMB_CHANNEL_ENERGY_GRAVITY, "energy_gravity", "J", DMB_AT_SCENE},
    {DMB_CHANNEL_ENERGY_CONTACT, "energy_contact", "J", DMB_AT_SCENE},
    {DMB_CHANNEL_ENERGY_DRIVES, "energy_drives", "J", DMB_AT_SCENE},
    {DMB_CHANNEL_ENERGY_LOADS, "energy_loads", "J", DMB_AT_SCENE},
    {DMB_CHANNEL_ENERGY_FRICTION, "energy_friction", "J", DMB_AT_SCENE},
    {DMB_CHANNEL_ENERGY_IMPACT, "energy_impact", "J", DMB_AT_SCENE},
    {DMB_CHANNEL_ENERGY_DAMPING, "energy_damping", "J", DMB_AT_SCENE},
    {DMB_CHANNEL_ENERGY_ROCK, "energy_rock", "J", DMB_AT_SCENE},
    {DMB_CHANNEL_ENERGY_SCHEME, "energy_scheme", "J", DMB_AT_SCENE},
    {DMB_CHANNEL_ENERGY_INPUT, "energy_input", "J", DMB_AT_SCENE},
    {DMB_CHANNEL_ENERGY_BALANCE, "energy_balance", "J", DMB_AT_SCENE},
    {DMB_CHANNEL_ENERGY_UNEXPLAINED, "energy_unexplained", "J", DMB_AT_SCENE},
    {DMB_CHANNEL_MOMENTUM_X, "momentum_x", "kg m/s", DMB_AT_SCENE},
    {DMB_CHANNEL_MOMENTUM_Y, "momentum_y", "kg m/s", DMB_AT_SCENE},
    {DMB_CHANNEL_MOMENTUM_Z, "momentum_z", "kg m/s", DMB_AT_SCENE},
    {DMB_CHANNEL_ANGULAR_MOMENTUM_X, "angular_momentum_x", "kg m2/s", DMB_AT_SCENE},
    {DMB_CHANNEL_ANGULAR_MOMENTUM_Y, "angular_momentum_y", "kg m2/s", DMB_AT_SCENE},
    {DMB_CHANNEL_ANGULAR_MOMENTUM_Z, "angular_momentum_z", "kg m2/s", DMB_AT_SCENE},
    {DMB_CHANNEL_MASS, "mass", "kg", DMB_AT_SCENE},
    {DMB_CHANNEL_CENTRE_X, "centre_x", "m", DMB_AT_SCENE},
    {DMB_CHANNEL_CENTRE_Y, "centre_y", "m", DMB_AT_SCENE},
    {DMB_CHANNEL_CENTRE_Z, "centre_z", "m", DMB_AT_SCENE},
    {DMB_CHANNEL_STEPS, "steps", "-", DMB_AT_SCENE},
    {DMB_CHANNEL_REJECTED, "rejected", "-", DMB_AT_SCENE},
    {DMB_CHANNEL_ITERATIONS, "iterations", "-", DMB_AT_SCENE},
    {DMB_CHANNEL_LIMITED_STEPS, "limited_steps", "-", DMB_AT_SCENE},
    {DMB_CHANNEL_MOST_ITERATIONS, "most_iterations", "-", DMB_AT_SCENE},
    {DMB_CHANNEL_LARGEST_RESIDUAL, "largest_residual", "-", DMB_AT_SCENE},
    {DMB_CHANNEL_SWITCHES, "switches", "-", DMB_AT_SCENE},
    {DMB_CHANNEL_DEPENDENT, "dependent", "-", DMB_AT_SCENE},
    {DMB_CHANNEL_REDUNDANT, "redundant", "-", DMB_AT_SCENE},
    {DMB_CHANNEL_VIOLATION, "violation", "m or -", DMB_AT_SCENE},
    {DMB_CHANNEL_JOINT_POSITION, "joint_position_x", "m", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_POSITION + 1, "joint_position_y", "m", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_POSITION + 2, "joint_position_z", "m", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_POSITION + 3, "joint_position_rx", "rad", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_POSITION + 4, "joint_position_ry", "rad", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_POSITION + 5, "joint_position_rz", "rad", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_SPEED, "joint_speed_x", "m/s", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_SPEED + 1, "joint_speed_y", "m/s", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_SPEED + 2, "joint_speed_z", "m/s", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_SPEED + 3, "joint_speed_rx", "rad/s", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_SPEED + 4, "joint_speed_ry", "rad/s", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_SPEED + 5, "joint_speed_rz", "rad/s", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_ACCELERATION, "joint_acceleration_x", "m/s2", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_ACCELERATION + 1, "joint_acceleration_y", "m/s2", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_ACCELERATION + 2, "joint_acceleration_z", "m/s2", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_ACCELERATION + 3, "joint_acceleration_rx", "rad/s2", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_ACCELERATION + 4, "joint_acceleration_ry", "rad/s2", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_ACCELERATION + 5, "joint_acceleration_rz", "rad/s2", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_REACTION, "joint_reaction_x", "N", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_REACTION + 1, "joint_reaction_y", "N", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_REACTION + 2, "joint_reaction_z", "N", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_REACTION + 3, "joint_reaction_rx", "N m", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_REACTION + 4, "joint_reaction_ry", "N m", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_REACTION + 5, "joint_reaction_rz", "N m", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_REACTION_BODY, "joint_reaction_body_x", "N", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_REACTION_BODY + 1, "joint_reaction_body_y", "N", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_REACTION_BODY + 2, "joint_reaction_body_z", "N", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_REACTION_BODY + 3, "joint_reaction_body_rx", "N m", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_REACTION_BODY + 4, "joint_reaction_body_ry", "N m", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_REACTION_BODY + 5, "joint_reaction_body_rz", "N m", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_ACTION, "joint_action_x", "N", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_ACTION + 1, "joint_action_y", "N", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_ACTION + 2, "joint_action_z", "N", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_ACTION + 3, "joint_action_rx", "N m", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_ACTION + 4, "joint_action_ry", "N m", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_ACTION + 5, "joint_action_rz", "N m", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_VIOLATION, "joint_violation", "m or -", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_STATE, "joint_state", "-", DMB_AT_JOINT},
    {DMB_CHANNEL_JOINT_ROWS, "joint_rows", "-", DMB_AT_JOINT},
    {DMB_CHANNEL_MULTIPLIER, "multiplier_0", "N or N m", DMB_AT_CONSTRAINT},
    {DMB_CHANNEL_MULTIPLIER + 1, "multiplier_1", "N or N m", DMB_AT_CONSTRAINT},
    {DMB_CHANNEL_MULTIPLIER + 2, "multiplier_2", "N or N m", DMB_AT_CONSTRAINT},
    {DMB_CHANNEL_MULTIPLIER + 3, "multiplier_3", "N or N m", DMB_AT_CONSTRAINT},
    {DMB_CHANNEL_MULTIPLIER + 4, "multiplier_4", "N or N m", DMB_AT_CONSTRAINT},
    {DMB_CHANNEL_MULTIPLIER + 5, "multiplier_5", "N or N m", DMB_AT_CONSTRAINT},
    {DMB_CHANNEL_REACTION, "reaction_x", "N", DMB_AT_PART},
    {DMB_CHANNEL_REACTION + 1, "reaction_y", "N", DMB_AT_PART},
    {DMB_CHANNEL_REACTION + 2, "reaction_z", "N", DMB_AT_PART},
    {DMB_CHANNEL_REACTION + 3, "reaction_rx", "N m", DMB_AT_PART},
    {DMB_CHANNEL_REACTION + 4, "reaction_ry", "N m", DMB_AT_PART},
    {DMB_CHANNEL_REACTION + 5, "reaction_rz", "N m", DMB_AT_PART},
    {DMB_CHANNEL_SECTION_FORCE, "section_force_x", "N", DMB_AT_SECTION},
    {DMB_CHANNEL_SECTION_FORCE + 1, "section_force_y", "N", DMB_AT_SECTION},
    {DMB_CHANNEL_SECTION_FORCE + 2, "section_force_z", "N", DMB_AT_SECTION},
    {DMB_CHANNEL_SECTION_FORCE + 3, "section_force_rx", "N m", DMB_AT_SECTION},
    {DMB_CHANNEL_SECTION_FORCE + 4, "section_force_ry", "N m", DMB_AT_SECTION},
    {DMB_CHANNEL_SECTION_FORCE + 5, "section_force_rz", "N m", DMB_AT_SECTION},
    {DMB_CHANNEL_SECTION_STRAIN, "section_strain_x", "-", DMB_AT_SECTION},
    {DMB_CHANNEL_SECTION_STRAIN + 1, "section_strain_y", "-", DMB_AT_SECTION},
    {DMB_CHANNEL_SECTION_STRAIN + 2, "section_strain_z", "-", DMB_AT_SECTION},
    {DMB_CHANNEL_SECTION_STRAIN + 3, "section_strain_rx", "rad/m", DMB_AT_SECTION},
    {DMB_CHANNEL_SECTION_STRAIN + 4, "section_strain_ry", "rad/m", DMB_AT_SECTION},
    {DMB_CHANNEL_SECTION_STRAIN + 5, "section_strain_rz", "rad/m", DMB_AT_SECTION},
    {DMB_CHANNEL_WORLD_VELOCITY, "world_velocity_x", "m/s", DMB_AT_PLACE},
    {DMB_CHANNEL_WORLD_VELOCITY + 1, "world_velocity_y", "m/s", DMB_AT_PLACE},
    {DMB_CHANNEL_WORLD_VELOCITY + 2, "world_velocity_z", "m/s", DMB_AT_PLACE},
    {DMB_CHANNEL_WORLD_VELOCITY + 3, "world_velocity_rx", "rad/s", DMB_AT_PLACE},
    {DMB_CHANNEL_WORLD_VELOCITY + 4, "world_velocity_ry", "rad/s", DMB_AT_PLACE},
    {DMB_CHANNEL_WORLD_VELOCITY + 5, "world_velocity_rz", "rad/s", DMB_AT_PLACE},
    {DMB_CHANNEL_WORLD_ACCELERATION, "world_acceleration_x", "m/s2", DMB_AT_PLACE},
    {DMB_CHANNEL_WORLD_ACCELERATION + 1, "world_acceleration_y", "m/s2", DMB_AT_PLACE},
    {DMB_CHANNEL_WORLD_ACCELERATION + 2, "world_acceleration_z", "m/s2", DMB_AT_PLACE},
    {DMB_CHANNEL_WORLD_ACCELERATION + 3, "world_acceleration_rx", "rad/s2", DMB_AT_PLACE},
    {DMB_CHANNEL_WORLD_ACCELERATION + 4, "world_acceleration_ry", "rad/s2", DMB_AT_PLACE},
    {DMB_CHANNEL_WORLD_ACCELERATION + 5, "world_acceleration_rz", "rad/s2", DMB_AT_PLACE},
    {DMB_CHANNEL_BODY_VELOCITY, "body_velocity_x", "m/s", DMB_AT_PLACE},
    {DMB_CHANNEL_BODY_VELOCITY + 1, "body_velocity_y", "m/s", DMB_AT_PLACE},
    {DMB_CHANNEL_BODY_VELOCITY + 2, "body_velocity_z", "m/s", DMB_AT_PLACE},
    {DMB_CHANNEL_BODY_VELOCITY + 3, "body_velocity_rx", "rad/s", DMB_AT_PLACE},
    {DMB_CHANNEL_BODY_VELOCITY + 4, "body_velocity_ry", "rad/s", DMB_AT_PLACE},
    {DMB_CHANNEL_BODY_VELOCITY + 5, "body_velocity_rz", "rad/s", DMB_AT_PLACE},
    {DMB_CHANNEL_BODY_ACCELERATION, "body_acceleration_x", "m/s2", DMB_AT_PLACE},
    {DMB_CHANNEL_BODY_ACCELERATION + 1, "body_acceleration_y", "m/s2", DMB_AT_PLACE},
    {DMB_CHANNEL_BODY_ACCELERATION + 2, "body_acceleration_z", "m/s2", DMB_AT_PLACE},
    {DMB_CHANNEL_BODY_ACCELERATION + 3, "body_acceleration_rx", "rad/s2", DMB_AT_PLACE},
    {DMB_CHANNEL_BODY_ACCELERATION + 4, "body_acceleration_ry", "rad/s2", DMB_AT_PLACE},
    {DMB_CHANNEL_BODY_ACCELERATION + 5, "body_acceleration_rz", "rad/s2", DMB_AT_PLACE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_DISTANCE, "profile_distance", "m", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_DEPTH, "profile_depth", "m", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_X, "profile_x", "m", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_Y, "profile_y", "m", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_Z, "profile_z", "m", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_DEVIATION, "profile_deviation", "m", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_DEVIATION_SIDE, "profile_deviation_side", "m", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_DEVIATION_UP, "profile_deviation_up", "m", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_AXIAL_FORCE, "profile_axial_force", "N", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_EFFECTIVE_FORCE, "profile_effective_force", "N", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_TORQUE, "profile_torque", "N m", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_BENDING_MOMENT, "profile_bending_moment", "N m", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_SHEAR_FORCE, "profile_shear_force", "N", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_CURVATURE, "profile_curvature", "rad/m", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_NORMAL_FORCE, "profile_normal_force", "N/m", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_FRICTION_AXIAL, "profile_friction_axial", "N/m", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_FRICTION_AROUND, "profile_friction_around", "N/m", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_VON_MISES, "profile_von_mises", "Pa", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_YIELD_SHARE, "profile_yield_share", "-", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_SINUSOIDAL_SHARE, "profile_sinusoidal_share", "-", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_HELICAL_SHARE, "profile_helical_share", "-", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_VELOCITY_AXIAL, "profile_velocity_axial", "m/s", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_VELOCITY_LATERAL, "profile_velocity_lateral", "m/s", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_SPIN, "profile_spin", "rad/s", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_ACCELERATION_AXIAL, "profile_acceleration_axial", "m/s2", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_ACCELERATION_LATERAL, "profile_acceleration_lateral", "m/s2", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_ROTATION, "profile_rotation", "rad", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_DISPLACEMENT_X, "profile_displacement_x", "m", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_DISPLACEMENT_Y, "profile_displacement_y", "m", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_DISPLACEMENT_Z, "profile_displacement_z", "m", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_SHEAR_Y, "profile_shear_y", "N", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_SHEAR_Z, "profile_shear_z", "N", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_MOMENT_Y, "profile_moment_y", "N m", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_MOMENT_Z, "profile_moment_z", "N m", DMB_AT_PIPE},
    {DMB_CHANNEL_PROFILE + DMB_PROFILE_GAP, "profile_gap", "m", DMB_AT_PIPE},
    {DMB_CHANNEL_WINDOW_MINIMUM, "window_minimum", "unit of the channel", DMB_AT_WINDOW},
    {DMB_CHANNEL_WINDOW_MAXIMUM, "window_maximum", "unit of the channel", DMB_AT_WINDOW},
    {DMB_CHANNEL_WINDOW_MEAN, "window_mean", "unit of the channel", DMB_AT_WINDOW},
    {DMB_CHANNEL_WINDOW_RMS, "window_rms", "unit of the channel", DMB_AT_WINDOW},
    {DMB_CHANNEL_STICK_SLIP_INDEX, "stick_slip_index", "-", DMB_AT_WINDOW},
    {DMB_CHANNEL_WINDOW_LOW_SHARE, "window_low_share", "-", DMB_AT_WINDOW},
};
/* clang-format on */

enum { NAME_COUNT = sizeof names / sizeof names[0] };

/* First entry whose number is not below; the numbers of query.h are their places. */
static size_t place_of(int32_t quantity)
{
    size_t low = 0, high = NAME_COUNT;
    if (quantity >= 0 && quantity < DMB_CHANNEL_COUNT) return (size_t)quantity;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (names[middle].quantity < quantity)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

const dmb_channel_entry *dmb_channel_name_of(int32_t quantity)
{
    const size_t at = place_of(quantity);
    return at < NAME_COUNT && names[at].quantity == quantity ? &names[at] : NULL;
}

const char *dmb_channel_name(int32_t quantity, const char **unit)
{
    const dmb_channel_entry *found = dmb_channel_name_of(quantity);
    if (unit != NULL) *unit = found != NULL ? found->unit : NULL;
    return found != NULL ? found->name : NULL;
}

int32_t dmb_channel_quantity(const char *name, int32_t *quantity)
{
    if (name == NULL || quantity == NULL) return DMB_ERR_NULL;
    for (size_t i = 0; i < NAME_COUNT; i++) {
        if (strcmp(names[i].name, name) != 0) continue;
        *quantity = names[i].quantity;
        return DMB_OK;
    }
    return DMB_ERR_VALUE;
}

int32_t dmb_channel_next(int32_t quantity)
{
    const size_t at = quantity < 0 ? 0 : quantity == INT32_MAX ? NAME_COUNT : place_of(quantity + 1);
    return at < NAME_COUNT ? names[at].quantity : -1;
}
