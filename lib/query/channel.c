/* Channels: one number asked of a sim, for recorders, windows, responses and events. quantity_name has their names;
 * dmb_channel_value is the one owner of their values. */
#include "query/query.h"

#include <math.h>
#include <stddef.h>

#include "drillmbd/bha.h"
#include "drillmbd/control.h"
#include "drillmbd/forces.h"
#include "sim/access.h"

static int32_t pose_value(const dmb_sim *sim, const dmb_channel *channel, double *value)
{
    dmb_pose pose = dmb_pose_default();
    const int32_t status = dmb_query_pose(sim, channel->place, &pose);
    if (status < 0) return status;
    *value = channel->quantity >= DMB_CHANNEL_POSITION_X ? pose.position[channel->quantity - DMB_CHANNEL_POSITION_X]
                                                         : pose.displacement[channel->quantity];
    return DMB_OK;
}

/* Component of velocity (0) or acceleration (1) in a frame. */
static int32_t motion_value(const dmb_sim *sim, const dmb_channel *channel, int32_t frame, int32_t rate,
                            int32_t component, double *value)
{
    dmb_motion motion = dmb_motion_default();
    int32_t status;
    motion.frame = frame;
    status = dmb_query_motion(sim, channel->place, &motion);
    if (status < 0) return status;
    *value = rate == 0 ? motion.velocity[component] : motion.acceleration[component];
    return DMB_OK;
}

static int32_t section_value(const dmb_sim *sim, const dmb_channel *channel, double *value)
{
    dmb_section section = dmb_section_default();
    const int32_t status = dmb_query_section(sim, channel->place, &section), q = channel->quantity;
    if (status < 0) return status;
    if (q == DMB_CHANNEL_AXIAL_FORCE) *value = section.force[0];
    if (q == DMB_CHANNEL_TORQUE) *value = section.force[3];
    if (q == DMB_CHANNEL_BENDING_MOMENT) *value = hypot(section.force[4], section.force[5]);
    if (q >= DMB_CHANNEL_SECTION_FORCE && q < DMB_CHANNEL_SECTION_FORCE + 6)
        *value = section.force[q - DMB_CHANNEL_SECTION_FORCE];
    if (q >= DMB_CHANNEL_SECTION_STRAIN && q < DMB_CHANNEL_SECTION_STRAIN + 6)
        *value = section.strain[q - DMB_CHANNEL_SECTION_STRAIN];
    return DMB_OK;
}

/* Of the first numbers, those of query.h, but for sections, drives, bits and the ledger. */
static int32_t first_value(const dmb_sim *sim, const dmb_channel *channel, double *value)
{
    const int32_t q = channel->quantity;
    if (q >= DMB_CHANNEL_VELOCITY_X && q <= DMB_CHANNEL_VELOCITY_Z)
        return motion_value(sim, channel, DMB_FRAME_WORLD, 0, q - DMB_CHANNEL_VELOCITY_X, value);
    if (q <= DMB_CHANNEL_POSITION_Z) return pose_value(sim, channel, value);
    if (q == DMB_CHANNEL_SPIN) return motion_value(sim, channel, DMB_FRAME_BODY, 0, DMB_RX, value);
    if (q == DMB_CHANNEL_ROTATION) return dmb_query_rotation(sim, channel->place, value);
    if (q == DMB_CHANNEL_KINETIC_ENERGY)
        return dmb_query_kinetic_energy(sim, channel->place.part, channel->place.pipe, value);
    return dmb_normal_force_at(sim, channel->place.part, channel->place.pipe, value);
}

static int32_t drive_value(const dmb_sim *sim, const dmb_channel *channel, double *value)
{
    dmb_drive_state drive = dmb_drive_state_default();
    const int32_t status = dmb_query_drive(sim, channel->place.part, &drive);
    if (status < 0) return status;
    switch (channel->quantity) {
    case DMB_CHANNEL_DRIVE_FORCE: *value = drive.force; break;
    case DMB_CHANNEL_DRIVE_SPEED: *value = drive.speed; break;
    case DMB_CHANNEL_DRIVE_TARGET: *value = drive.target; break;
    case DMB_CHANNEL_DRIVE_POSITION: *value = drive.position; break;
    case DMB_CHANNEL_DRIVE_POWER: *value = drive.power; break;
    case DMB_CHANNEL_DRIVE_COMMAND: *value = drive.command; break;
    case DMB_CHANNEL_DRIVE_MADE: *value = drive.made; break;
    default: *value = drive.work;
    }
    return DMB_OK;
}

static int32_t bit_value(const dmb_sim *sim, const dmb_channel *channel, double *value)
{
    dmb_bit_state bit = dmb_bit_state_default();
    const int32_t status = dmb_query_bit(sim, channel->place.part, &bit);
    if (status < 0) return status;
    switch (channel->quantity) {
    case DMB_CHANNEL_BIT_WEIGHT: *value = bit.weight + bit.load; break;
    case DMB_CHANNEL_BIT_ADVANCE: *value = bit.advance; break;
    case DMB_CHANNEL_BIT_BOTTOM: *value = bit.bottom; break;
    case DMB_CHANNEL_BIT_DEPTH_OF_CUT: *value = bit.depth_of_cut; break;
    case DMB_CHANNEL_BIT_ROCK_WEIGHT: *value = bit.weight; break;
    case DMB_CHANNEL_BIT_TORQUE: *value = bit.torque; break;
    case DMB_CHANNEL_BIT_LOAD: *value = bit.load; break;
    default: *value = bit.on_bottom;
    }
    return DMB_OK;
}

static int32_t stuck_value(const dmb_sim *sim, const dmb_channel *channel, double *value)
{
    dmb_stuck_state stuck = dmb_stuck_state_default();
    const int32_t status = dmb_query_stuck(sim, channel->place.part, &stuck);
    if (status < 0) return status;
    const double values[] = {stuck.stuck, stuck.force[0], stuck.force[3]};
    *value = values[channel->quantity - DMB_CHANNEL_STUCK];
    return DMB_OK;
}

static int32_t spring_value(const dmb_sim *sim, const dmb_channel *channel, double *value)
{
    dmb_spring_state s = dmb_spring_state_default();
    const int32_t status = dmb_query_spring(sim, channel->place.part, &s);
    if (status < 0) return status;
    const double values[] = {s.length, s.elongation, s.speed, s.force, s.elastic, s.damper, s.energy};
    *value = values[channel->quantity - DMB_CHANNEL_SPRING_LENGTH];
    return DMB_OK;
}

static int32_t input_value(const dmb_sim *sim, const dmb_channel *channel, double *value)
{
    dmb_input_state input = dmb_input_state_default();
    const int32_t status = dmb_sim_get_input(sim, channel->place.part, &input);
    if (status < 0) return status;
    const double values[] = {input.present, input.rate, input.value};
    *value = values[channel->quantity - DMB_CHANNEL_INPUT_PRESENT];
    return DMB_OK;
}

static int32_t site_value(const dmb_sim *sim, const dmb_channel *channel, double *value)
{
    dmb_contact contact = dmb_contact_default();
    const int32_t status = dmb_query_contact(sim, channel->place.pipe, &contact);
    if (status < 0) return status;
    const double values[] = {contact.gap,         contact.normal_force, contact.approach,
                             contact.friction[0], contact.friction[1],  contact.slip[0],
                             contact.slip[1],     contact.closed,       contact.sticks};
    *value = values[channel->quantity - DMB_CHANNEL_SITE_GAP];
    return DMB_OK;
}

static int32_t contacts_value(const dmb_sim *sim, int32_t quantity, double *value)
{
    dmb_contact_total sum = dmb_contact_total_default();
    const int32_t status = dmb_query_contact_total(sim, &sum);
    if (status < 0) return status;
    const double values[] = {sum.closed, sum.normal_force, sum.friction[0], sum.friction[1], sum.deepest};
    *value = values[quantity - DMB_CHANNEL_CONTACTS_CLOSED];
    return DMB_OK;
}

static int32_t energy_value(const dmb_sim *sim, int32_t quantity, double *value)
{
    dmb_energy e = dmb_energy_default();
    const int32_t status = dmb_query_energy(sim, &e);
    if (status < 0) return status;
    const double values[] = {e.kinetic, e.strain,  e.gravity, e.contact, e.drives, e.loads,   e.friction,
                             e.impact,  e.damping, e.rock,    e.scheme,  e.input,  e.balance, e.unexplained};
    *value = quantity == DMB_CHANNEL_ENERGY_ERROR ? e.error : values[quantity - DMB_CHANNEL_ENERGY_KINETIC];
    return DMB_OK;
}

static int32_t momentum_value(const dmb_sim *sim, int32_t quantity, double *value)
{
    dmb_momentum m = dmb_momentum_default();
    const int32_t status = dmb_query_momentum(sim, &m);
    if (status < 0) return status;
    const double values[] = {m.linear[0],  m.linear[1], m.linear[2], m.angular[0], m.angular[1],
                             m.angular[2], m.mass,      m.centre[0], m.centre[1],  m.centre[2]};
    *value = values[quantity - DMB_CHANNEL_MOMENTUM_X];
    return DMB_OK;
}

static int32_t statistics_value(const dmb_sim *sim, int32_t quantity, double *value)
{
    dmb_statistics s = dmb_statistics_default();
    const int32_t status = dmb_query_statistics(sim, &s);
    if (status < 0) return status;
    const double values[] = {(double)s.steps,   (double)s.rejected, (double)s.iterations, (double)s.limited_steps,
                             s.most_iterations, s.largest_residual, (double)s.switches,   s.dependent,
                             s.redundant,       s.violation};
    *value = values[quantity - DMB_CHANNEL_STEPS];
    return DMB_OK;
}

static int32_t scene_value(const dmb_sim *sim, const dmb_channel *channel, double *value)
{
    const int32_t q = channel->quantity;
    if (q == DMB_CHANNEL_ENERGY_ERROR) return energy_value(sim, q, value);
    if (q <= DMB_CHANNEL_CONTACTS_DEEPEST) return contacts_value(sim, q, value);
    if (q <= DMB_CHANNEL_ENERGY_UNEXPLAINED) return energy_value(sim, q, value);
    return q <= DMB_CHANNEL_CENTRE_Z ? momentum_value(sim, q, value) : statistics_value(sim, q, value);
}

static int32_t joint_value(const dmb_sim *sim, const dmb_channel *channel, double *value)
{
    const int32_t q = channel->quantity, c = q % 10;
    dmb_joint_state joint = dmb_joint_state_default();
    const int in_body = q >= DMB_CHANNEL_JOINT_REACTION_BODY && q < DMB_CHANNEL_JOINT_ACTION;
    joint.frame = in_body ? DMB_FRAME_BODY : DMB_FRAME_WORLD;
    const int32_t status = dmb_query_joint(sim, channel->place.part, &joint);
    if (status < 0) return status;
    switch (q - c) {
    case DMB_CHANNEL_JOINT_POSITION: *value = joint.position[c]; break;
    case DMB_CHANNEL_JOINT_SPEED: *value = joint.speed[c]; break;
    case DMB_CHANNEL_JOINT_ACCELERATION: *value = joint.acceleration[c]; break;
    case DMB_CHANNEL_JOINT_REACTION:
    case DMB_CHANNEL_JOINT_REACTION_BODY: *value = joint.reaction[c]; break;
    case DMB_CHANNEL_JOINT_ACTION: *value = joint.action[c]; break;
    default:
        if (q == DMB_CHANNEL_JOINT_VIOLATION) *value = joint.violation;
        if (q == DMB_CHANNEL_JOINT_STATE) *value = joint.state;
        if (q == DMB_CHANNEL_JOINT_ROWS) *value = joint.constraint_rows;
    }
    return DMB_OK;
}

static int32_t multiplier_value(const dmb_sim *sim, const dmb_channel *channel, double *value)
{
    const uint32_t k = (uint32_t)(channel->quantity - DMB_CHANNEL_MULTIPLIER);
    double multipliers[6];
    uint32_t count = 0;
    const int32_t status = dmb_query_multipliers(sim, channel->place.part, multipliers, &count);
    if (status < 0) return status;
    if (k >= count) return DMB_ERR_VALUE;
    *value = multipliers[k];
    return DMB_OK;
}

static int32_t reaction_value(const dmb_sim *sim, const dmb_channel *channel, double *value)
{
    double reaction[6];
    const int32_t status = dmb_query_reaction(sim, channel->place.part, reaction);
    if (status >= 0) *value = reaction[channel->quantity - DMB_CHANNEL_REACTION];
    return status;
}

static int32_t place_value(const dmb_sim *sim, const dmb_channel *channel, double *value)
{
    const int32_t q = channel->quantity, c = q % 10;
    switch (q - c) {
    case DMB_CHANNEL_WORLD_VELOCITY: return motion_value(sim, channel, DMB_FRAME_WORLD, 0, c, value);
    case DMB_CHANNEL_WORLD_ACCELERATION: return motion_value(sim, channel, DMB_FRAME_WORLD, 1, c, value);
    case DMB_CHANNEL_BODY_VELOCITY: return motion_value(sim, channel, DMB_FRAME_BODY, 0, c, value);
    case DMB_CHANNEL_BODY_ACCELERATION: return motion_value(sim, channel, DMB_FRAME_BODY, 1, c, value);
    default: return first_value(sim, channel, value);
    }
}

int32_t dmb_channel_value(const dmb_sim *sim, const dmb_channel *channel, double *value)
{
    const dmb_channel_entry *name = dmb_channel_name_of(channel->quantity);
    if (name == NULL) return DMB_ERR_VALUE;
    switch (name->place) {
    case DMB_AT_SECTION: return section_value(sim, channel, value);
    case DMB_AT_PIPE: return dmb_profile_value(sim, channel->place, channel->quantity - DMB_CHANNEL_PROFILE, value);
    case DMB_AT_PART:
        return channel->quantity >= DMB_CHANNEL_REACTION ? reaction_value(sim, channel, value)
                                                         : first_value(sim, channel, value);
    case DMB_AT_STRING: return dmb_driller_value(sim, channel, value);
    case DMB_AT_BIT: return bit_value(sim, channel, value);
    case DMB_AT_STUCK: return stuck_value(sim, channel, value);
    case DMB_AT_SPRING: return spring_value(sim, channel, value);
    case DMB_AT_INPUT: return input_value(sim, channel, value);
    case DMB_AT_DRIVE: return drive_value(sim, channel, value);
    case DMB_AT_JOINT: return joint_value(sim, channel, value);
    case DMB_AT_CONSTRAINT: return multiplier_value(sim, channel, value);
    case DMB_AT_SITE: return site_value(sim, channel, value);
    case DMB_AT_SCENE: return scene_value(sim, channel, value);
    case DMB_AT_WINDOW: return DMB_ERR_UNSUPPORTED;
    default: return place_value(sim, channel, value);
    }
}

int32_t dmb_query_channel(const dmb_sim *sim, const dmb_channel *channel, double *value)
{
    const int32_t status = dmb_ask(sim, value);
    double found = 0.0;
    if (status < 0) return status;
    if (channel == NULL) return DMB_ERR_NULL;
    const int32_t answer = dmb_channel_value(sim, channel, &found);
    if (answer >= 0) *value = found;
    return answer;
}

/* ---- Refusals ---------------------------------------------------------------------------------------------------- */

static const char *wanted(int32_t place)
{
    switch (place) {
    case DMB_AT_PLACE: return "place must be on a string, body or bit of this model";
    case DMB_AT_SECTION: return "place must be on a flexible or axial-torsional pipe of a string";
    case DMB_AT_PIPE: return "place must be on a pipe of a string";
    case DMB_AT_PART: return "place must name a pipe of a string, a body or a bit";
    case DMB_AT_STRING:
        return "place.part must be a string, or {0, 0} for the first, that has what is read: a bit, with a rock law "
               "for off_bottom, or a flexible first pipe";
    case DMB_AT_BIT: return "place.part must be a bit";
    case DMB_AT_STUCK: return "place.part must be a stuck place";
    case DMB_AT_SPRING: return "place.part must be a spring";
    case DMB_AT_INPUT: return "place.part must be an input";
    case DMB_AT_DRIVE: return "place.part must be a drive";
    case DMB_AT_JOINT: return "place.part must be a joint";
    case DMB_AT_CONSTRAINT: return "place.part must be a joint, coupling, constraint or joint drive with that row";
    case DMB_AT_SITE: return "place.pipe must be a contact site, below info.contact_sites";
    case DMB_AT_SCENE: return "switch on what it is read from in the options of the sim (energy_ledger)";
    default: return "it is a number of a window: record it by a recorder with a window, or ask dmb_window_get";
    }
}

static int32_t refuse(dmb_sim *sim, uint32_t i, const dmb_channel *channel, int32_t status)
{
    const dmb_channel_entry *name = dmb_channel_name_of(channel->quantity);
    if (name == NULL)
        dmb_message_set(&sim->message, "channel %u: quantity = %d, must be one that dmb_channel_name knows", i,
                        (int)channel->quantity);
    else
        dmb_message_set(&sim->message, "channel %u, %s at pipe %u, fraction %g: %s; %s", i, name->name,
                        channel->place.pipe, channel->place.fraction, dmb_status_text(status), wanted(name->place));
    return status;
}

int32_t dmb_channel_check(dmb_sim *sim, const dmb_channel *channels, uint32_t channel_count)
{
    if (sim == NULL || channels == NULL) return DMB_ERR_NULL;
    int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    if (status < 0) return status;
    for (uint32_t i = 0; i < channel_count && status >= 0; i++) {
        double unused;
        status = dmb_channel_value(sim, channels + i, &unused);
        if (status < 0) status = refuse(sim, i, channels + i, status);
    }
    return dmb_sim_leave(sim, status);
}
