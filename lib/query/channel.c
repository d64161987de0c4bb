#include "query/channel.h"

#include <math.h>
#include <stddef.h>

#include "query/place.h"

const dmb_channel_name *dmb_channel_name_of(int32_t quantity)
{
    static const dmb_channel_name names[DMB_CHANNEL_COUNT] = {
        [DMB_CHANNEL_DISPLACEMENT_X] = {"displacement_x", "m"},
        [DMB_CHANNEL_DISPLACEMENT_Y] = {"displacement_y", "m"},
        [DMB_CHANNEL_DISPLACEMENT_Z] = {"displacement_z", "m"},
        [DMB_CHANNEL_VELOCITY_X] = {"velocity_x", "m/s"},
        [DMB_CHANNEL_VELOCITY_Y] = {"velocity_y", "m/s"},
        [DMB_CHANNEL_VELOCITY_Z] = {"velocity_z", "m/s"},
        [DMB_CHANNEL_POSITION_X] = {"position_x", "m"},
        [DMB_CHANNEL_POSITION_Y] = {"position_y", "m"},
        [DMB_CHANNEL_POSITION_Z] = {"position_z", "m"},
        [DMB_CHANNEL_ROTATION] = {"rotation", "rad"},
        [DMB_CHANNEL_SPIN] = {"spin", "rad/s"},
        [DMB_CHANNEL_AXIAL_FORCE] = {"axial_force", "N"},
        [DMB_CHANNEL_TORQUE] = {"torque", "N m"},
        [DMB_CHANNEL_BENDING_MOMENT] = {"bending_moment", "N m"},
        [DMB_CHANNEL_KINETIC_ENERGY] = {"kinetic_energy", "J"},
        [DMB_CHANNEL_NORMAL_FORCE] = {"normal_force", "N"},
        [DMB_CHANNEL_DRIVE_FORCE] = {"drive_force", "N or N m"},
        [DMB_CHANNEL_DRIVE_SPEED] = {"drive_speed", "m/s or rad/s"},
        [DMB_CHANNEL_BIT_WEIGHT] = {"bit_weight", "N"},
        [DMB_CHANNEL_ENERGY_ERROR] = {"energy_error", "-"},
    };
    return quantity >= 0 && quantity < DMB_CHANNEL_COUNT ? &names[quantity] : NULL;
}

static int32_t pose_value(const dmb_sim *sim, const dmb_channel *channel, double *value)
{
    dmb_pose pose = dmb_pose_default();
    const int32_t status = dmb_query_pose(sim, channel->place, &pose);
    if (status < 0) return status;
    *value = channel->quantity >= DMB_CHANNEL_POSITION_X ? pose.position[channel->quantity - DMB_CHANNEL_POSITION_X]
                                                         : pose.displacement[channel->quantity];
    return DMB_OK;
}

static int32_t motion_value(const dmb_sim *sim, const dmb_channel *channel, double *value)
{
    dmb_motion motion = dmb_motion_default();
    int32_t status;
    motion.frame = channel->quantity == DMB_CHANNEL_SPIN ? DMB_FRAME_BODY : DMB_FRAME_WORLD;
    status = dmb_query_motion(sim, channel->place, &motion);
    if (status < 0) return status;
    *value =
        motion.velocity[channel->quantity == DMB_CHANNEL_SPIN ? DMB_RX : channel->quantity - DMB_CHANNEL_VELOCITY_X];
    return DMB_OK;
}

static int32_t section_value(const dmb_sim *sim, const dmb_channel *channel, double *value)
{
    dmb_section section = dmb_section_default();
    const int32_t status = dmb_query_section(sim, channel->place, &section);
    if (status < 0) return status;
    if (channel->quantity == DMB_CHANNEL_AXIAL_FORCE) *value = section.force[0];
    if (channel->quantity == DMB_CHANNEL_TORQUE) *value = section.force[3];
    if (channel->quantity == DMB_CHANNEL_BENDING_MOMENT) *value = hypot(section.force[4], section.force[5]);
    return DMB_OK;
}

static int32_t drive_value(const dmb_sim *sim, const dmb_channel *channel, double *value)
{
    dmb_drive_state drive = dmb_drive_state_default();
    const int32_t status = dmb_query_drive(sim, channel->place.part, &drive);
    if (status < 0) return status;
    *value = channel->quantity == DMB_CHANNEL_DRIVE_FORCE ? drive.force : drive.speed;
    return DMB_OK;
}

static int32_t bit_value(const dmb_sim *sim, const dmb_channel *channel, double *value)
{
    dmb_bit_state bit = dmb_bit_state_default();
    const int32_t status = dmb_query_bit(sim, channel->place.part, &bit);
    if (status < 0) return status;
    *value = bit.weight + bit.load;
    return DMB_OK;
}

static int32_t energy_error(const dmb_sim *sim, double *value)
{
    dmb_energy energy = dmb_energy_default();
    const int32_t status = dmb_query_energy(sim, &energy);
    if (status < 0) return status;
    *value = energy.error;
    return DMB_OK;
}

int32_t dmb_channel_value(const dmb_sim *sim, const dmb_channel *channel, double *value)
{
    switch (channel->quantity) {
    case DMB_CHANNEL_DISPLACEMENT_X:
    case DMB_CHANNEL_DISPLACEMENT_Y:
    case DMB_CHANNEL_DISPLACEMENT_Z:
    case DMB_CHANNEL_POSITION_X:
    case DMB_CHANNEL_POSITION_Y:
    case DMB_CHANNEL_POSITION_Z: return pose_value(sim, channel, value);
    case DMB_CHANNEL_VELOCITY_X:
    case DMB_CHANNEL_VELOCITY_Y:
    case DMB_CHANNEL_VELOCITY_Z:
    case DMB_CHANNEL_SPIN: return motion_value(sim, channel, value);
    case DMB_CHANNEL_ROTATION: return dmb_query_rotation(sim, channel->place, value);
    case DMB_CHANNEL_AXIAL_FORCE:
    case DMB_CHANNEL_TORQUE:
    case DMB_CHANNEL_BENDING_MOMENT: return section_value(sim, channel, value);
    case DMB_CHANNEL_KINETIC_ENERGY:
        return dmb_query_kinetic_energy(sim, channel->place.part, channel->place.pipe, value);
    case DMB_CHANNEL_NORMAL_FORCE: return dmb_normal_force_at(sim, channel->place.part, channel->place.pipe, value);
    case DMB_CHANNEL_DRIVE_FORCE:
    case DMB_CHANNEL_DRIVE_SPEED: return drive_value(sim, channel, value);
    case DMB_CHANNEL_BIT_WEIGHT: return bit_value(sim, channel, value);
    case DMB_CHANNEL_ENERGY_ERROR: return energy_error(sim, value);
    default: return DMB_ERR_VALUE;
    }
}
