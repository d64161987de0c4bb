/* Outputs: one number queried from a sim, for recorders, windows, responses and events. quantity_name contains their
 * names; dmb_output_value is the only function that computes their values. Each value comes from the query that a
 * program would call, so that an output and the query cannot differ. Arrays of values here are in the order of their
 * numbers in drillmbd/ask.h; quantities of a place or joint with six components begin at multiples of ten, and the last
 * digit is the component. */
#include "query/query.h"

#include <math.h>
#include <stddef.h>

#include "drillmbd/scene.h"
#include "sim/access.h"

static int32_t pose_value(const dmb_sim *sim, const dmb_output *output, double *value)
{
    dmb_pose pose = dmb_pose_default();
    const int32_t status = dmb_answer_pose(sim, output->place, &pose);
    if (status < 0) return status;
    *value = output->quantity >= DMB_OUTPUT_POSITION_X ? pose.position[output->quantity - DMB_OUTPUT_POSITION_X]
                                                       : pose.displacement[output->quantity];
    return DMB_OK;
}

/* Component of velocity (0) or acceleration (1) in a frame. */
static int32_t motion_value(const dmb_sim *sim, const dmb_output *output, int32_t frame, int32_t rate,
                            int32_t component, double *value)
{
    dmb_motion motion = dmb_motion_default();
    int32_t status;
    motion.frame = frame;
    status = dmb_answer_motion(sim, output->place, &motion);
    if (status < 0) return status;
    *value = rate == 0 ? motion.velocity[component] : motion.acceleration[component];
    return DMB_OK;
}

static int32_t section_value(const dmb_sim *sim, const dmb_output *output, double *value)
{
    dmb_section section = dmb_section_default();
    const int32_t status = dmb_answer_section(sim, output->place, &section), q = output->quantity;
    if (status < 0) return status;
    if (q == DMB_OUTPUT_AXIAL_FORCE) *value = section.force[0];
    if (q == DMB_OUTPUT_TORQUE) *value = section.force[3];
    if (q == DMB_OUTPUT_BENDING_MOMENT) *value = hypot(section.force[4], section.force[5]);
    if (q >= DMB_OUTPUT_SECTION_FORCE && q < DMB_OUTPUT_SECTION_FORCE + 6)
        *value = section.force[q - DMB_OUTPUT_SECTION_FORCE];
    if (q >= DMB_OUTPUT_SECTION_STRAIN && q < DMB_OUTPUT_SECTION_STRAIN + 6)
        *value = section.strain[q - DMB_OUTPUT_SECTION_STRAIN];
    return DMB_OK;
}

/* Values of the first quantities, those of query.h, except sections, drives, bits and the ledger. */
static int32_t first_value(const dmb_sim *sim, const dmb_output *output, double *value)
{
    const int32_t q = output->quantity;
    if (q >= DMB_OUTPUT_VELOCITY_X && q <= DMB_OUTPUT_VELOCITY_Z)
        return motion_value(sim, output, DMB_FRAME_WORLD, 0, q - DMB_OUTPUT_VELOCITY_X, value);
    if (q <= DMB_OUTPUT_POSITION_Z) return pose_value(sim, output, value);
    if (q == DMB_OUTPUT_SPIN) return motion_value(sim, output, DMB_FRAME_BODY, 0, DMB_RX, value);
    if (q == DMB_OUTPUT_ROTATION) return dmb_answer_rotation(sim, output->place, value);
    if (q == DMB_OUTPUT_KINETIC_ENERGY)
        return dmb_answer_kinetic_energy(sim, output->place.part, output->place.pipe, value);
    return dmb_normal_force_at(sim, output->place.part, output->place.pipe, value);
}

static int32_t drive_value(const dmb_sim *sim, const dmb_output *output, double *value)
{
    dmb_drive_state drive = dmb_drive_state_default();
    const int32_t status = dmb_answer_drive(sim, output->place.part, &drive);
    if (status < 0) return status;
    switch (output->quantity) {
    case DMB_OUTPUT_DRIVE_FORCE: *value = drive.force; break;
    case DMB_OUTPUT_DRIVE_SPEED: *value = drive.speed; break;
    case DMB_OUTPUT_DRIVE_TARGET: *value = drive.target; break;
    case DMB_OUTPUT_DRIVE_POSITION: *value = drive.position; break;
    case DMB_OUTPUT_DRIVE_POWER: *value = drive.power; break;
    case DMB_OUTPUT_DRIVE_COMMAND: *value = drive.command; break;
    case DMB_OUTPUT_DRIVE_MADE: *value = drive.made; break;
    default: *value = drive.work;
    }
    return DMB_OK;
}

static int32_t bit_value(const dmb_sim *sim, const dmb_output *output, double *value)
{
    dmb_bit_state bit = dmb_bit_state_default();
    const int32_t status = dmb_answer_bit(sim, output->place.part, &bit);
    if (status < 0) return status;
    switch (output->quantity) {
    case DMB_OUTPUT_BIT_WEIGHT: *value = bit.weight + bit.load; break;
    case DMB_OUTPUT_BIT_ADVANCE: *value = bit.advance; break;
    case DMB_OUTPUT_BIT_BOTTOM: *value = bit.bottom; break;
    case DMB_OUTPUT_BIT_DEPTH_OF_CUT: *value = bit.depth_of_cut; break;
    case DMB_OUTPUT_BIT_ROCK_WEIGHT: *value = bit.weight; break;
    case DMB_OUTPUT_BIT_TORQUE: *value = bit.torque; break;
    case DMB_OUTPUT_BIT_LOAD: *value = bit.load; break;
    default: *value = bit.on_bottom;
    }
    return DMB_OK;
}

static int32_t stuck_value(const dmb_sim *sim, const dmb_output *output, double *value)
{
    dmb_stuck_state stuck = dmb_stuck_state_default();
    const int32_t status = dmb_answer_stuck(sim, output->place.part, &stuck);
    if (status < 0) return status;
    const double values[] = {stuck.stuck, stuck.force[0], stuck.force[3]};
    *value = values[output->quantity - DMB_OUTPUT_STUCK];
    return DMB_OK;
}

static int32_t spring_value(const dmb_sim *sim, const dmb_output *output, double *value)
{
    dmb_spring_state s = dmb_spring_state_default();
    const int32_t status = dmb_answer_spring(sim, output->place.part, &s);
    if (status < 0) return status;
    const double values[] = {s.length, s.elongation, s.speed, s.force, s.elastic, s.damper, s.energy};
    *value = values[output->quantity - DMB_OUTPUT_SPRING_LENGTH];
    return DMB_OK;
}

static int32_t input_value(const dmb_sim *sim, const dmb_output *output, double *value)
{
    dmb_input_state input = dmb_input_state_default();
    const int32_t status = dmb_sim_get_input(sim, output->place.part, &input);
    if (status < 0) return status;
    const double values[] = {input.present, input.rate, input.value};
    *value = values[output->quantity - DMB_OUTPUT_INPUT_PRESENT];
    return DMB_OK;
}

static int32_t site_value(const dmb_sim *sim, const dmb_output *output, double *value)
{
    dmb_contact contact = dmb_contact_default();
    const int32_t status = dmb_answer_contact(sim, output->place.pipe, &contact);
    if (status < 0) return status;
    const double values[] = {contact.gap,         contact.normal_force, contact.approach,
                             contact.friction[0], contact.friction[1],  contact.slip[0],
                             contact.slip[1],     contact.closed,       contact.sticks};
    *value = values[output->quantity - DMB_OUTPUT_CONTACT_GAP];
    return DMB_OK;
}

static int32_t contacts_value(const dmb_sim *sim, int32_t quantity, double *value)
{
    dmb_contact_total sum = dmb_contact_total_default();
    const int32_t status = dmb_answer_contact_total(sim, &sum);
    if (status < 0) return status;
    const double values[] = {sum.closed, sum.normal_force, sum.friction[0], sum.friction[1], sum.deepest};
    *value = values[quantity - DMB_OUTPUT_CONTACTS_CLOSED];
    return DMB_OK;
}

static int32_t energy_value(const dmb_sim *sim, int32_t quantity, double *value)
{
    dmb_energy e = dmb_energy_default();
    const int32_t status = dmb_answer_energy(sim, &e);
    if (status < 0) return status;
    const double values[] = {e.kinetic, e.strain,  e.gravity, e.contact, e.drives, e.loads,   e.friction,
                             e.impact,  e.damping, e.rock,    e.scheme,  e.input,  e.balance, e.unexplained};
    *value = quantity == DMB_OUTPUT_ENERGY_ERROR ? e.error : values[quantity - DMB_OUTPUT_ENERGY_KINETIC];
    return DMB_OK;
}

static int32_t momentum_value(const dmb_sim *sim, int32_t quantity, double *value)
{
    dmb_momentum m = dmb_momentum_default();
    const int32_t status = dmb_answer_momentum(sim, &m);
    if (status < 0) return status;
    const double values[] = {m.linear[0],  m.linear[1], m.linear[2], m.angular[0], m.angular[1],
                             m.angular[2], m.mass,      m.centre[0], m.centre[1],  m.centre[2]};
    *value = values[quantity - DMB_OUTPUT_MOMENTUM_X];
    return DMB_OK;
}

static int32_t statistics_value(const dmb_sim *sim, int32_t quantity, double *value)
{
    dmb_statistics s = dmb_statistics_default();
    const int32_t status = dmb_answer_statistics(sim, &s);
    if (status < 0) return status;
    const double values[] = {(double)s.steps,   (double)s.rejected, (double)s.iterations, (double)s.limited_steps,
                             s.most_iterations, s.largest_residual, (double)s.switches,   s.dependent,
                             s.redundant,       s.violation};
    *value = values[quantity - DMB_OUTPUT_STEPS];
    return DMB_OK;
}

static int32_t scene_value(const dmb_sim *sim, const dmb_output *output, double *value)
{
    const int32_t q = output->quantity;
    if (q == DMB_OUTPUT_ENERGY_ERROR) return energy_value(sim, q, value);
    if (q <= DMB_OUTPUT_CONTACTS_DEEPEST) return contacts_value(sim, q, value);
    if (q <= DMB_OUTPUT_ENERGY_UNEXPLAINED) return energy_value(sim, q, value);
    return q <= DMB_OUTPUT_CENTRE_Z ? momentum_value(sim, q, value) : statistics_value(sim, q, value);
}

static int32_t joint_value(const dmb_sim *sim, const dmb_output *output, double *value)
{
    const int32_t q = output->quantity, c = q % 10;
    dmb_joint_state joint = dmb_joint_state_default();
    const int in_body = q >= DMB_OUTPUT_JOINT_REACTION_BODY && q < DMB_OUTPUT_JOINT_ACTION;
    joint.frame = in_body ? DMB_FRAME_BODY : DMB_FRAME_WORLD;
    const int32_t status = dmb_answer_joint(sim, output->place.part, &joint);
    if (status < 0) return status;
    switch (q - c) {
    case DMB_OUTPUT_JOINT_POSITION: *value = joint.position[c]; break;
    case DMB_OUTPUT_JOINT_SPEED: *value = joint.speed[c]; break;
    case DMB_OUTPUT_JOINT_ACCELERATION: *value = joint.acceleration[c]; break;
    case DMB_OUTPUT_JOINT_REACTION:
    case DMB_OUTPUT_JOINT_REACTION_BODY: *value = joint.reaction[c]; break;
    case DMB_OUTPUT_JOINT_ACTION: *value = joint.action[c]; break;
    default:
        if (q == DMB_OUTPUT_JOINT_VIOLATION) *value = joint.violation;
        if (q == DMB_OUTPUT_JOINT_STATE) *value = joint.state;
        if (q == DMB_OUTPUT_JOINT_ROWS) *value = joint.constraint_rows;
    }
    return DMB_OK;
}

static int32_t multiplier_value(const dmb_sim *sim, const dmb_output *output, double *value)
{
    const uint32_t k = (uint32_t)(output->quantity - DMB_OUTPUT_MULTIPLIER);
    double multipliers[6];
    uint32_t count = 0;
    const int32_t status = dmb_answer_multipliers(sim, output->place.part, multipliers, &count);
    if (status < 0) return status;
    if (k >= count) return DMB_ERR_VALUE;
    *value = multipliers[k];
    return DMB_OK;
}

static int32_t reaction_value(const dmb_sim *sim, const dmb_output *output, double *value)
{
    double reaction[6];
    const int32_t status = dmb_answer_reaction(sim, output->place.part, reaction);
    if (status >= 0) *value = reaction[output->quantity - DMB_OUTPUT_REACTION];
    return status;
}

static int32_t place_value(const dmb_sim *sim, const dmb_output *output, double *value)
{
    const int32_t q = output->quantity, c = q % 10;
    switch (q - c) {
    case DMB_OUTPUT_WORLD_VELOCITY: return motion_value(sim, output, DMB_FRAME_WORLD, 0, c, value);
    case DMB_OUTPUT_WORLD_ACCELERATION: return motion_value(sim, output, DMB_FRAME_WORLD, 1, c, value);
    case DMB_OUTPUT_BODY_VELOCITY: return motion_value(sim, output, DMB_FRAME_BODY, 0, c, value);
    case DMB_OUTPUT_BODY_ACCELERATION: return motion_value(sim, output, DMB_FRAME_BODY, 1, c, value);
    default: return first_value(sim, output, value);
    }
}

int32_t dmb_output_value(const dmb_sim *sim, const dmb_output *output, double *value)
{
    const dmb_output_entry *name = dmb_output_name_of(output->quantity);
    if (name == NULL) return DMB_ERR_VALUE;
    switch (name->place) {
    case DMB_AT_SECTION: return section_value(sim, output, value);
    case DMB_AT_PIPE: return dmb_profile_value(sim, output->place, output->quantity - DMB_OUTPUT_PROFILE, value);
    case DMB_AT_PART:
        return output->quantity >= DMB_OUTPUT_REACTION ? reaction_value(sim, output, value)
                                                       : first_value(sim, output, value);
    case DMB_AT_STRING: return dmb_driller_value(sim, output, value);
    case DMB_AT_BIT: return bit_value(sim, output, value);
    case DMB_AT_STUCK: return stuck_value(sim, output, value);
    case DMB_AT_SPRING: return spring_value(sim, output, value);
    case DMB_AT_INPUT: return input_value(sim, output, value);
    case DMB_AT_DRIVE: return drive_value(sim, output, value);
    case DMB_AT_JOINT: return joint_value(sim, output, value);
    case DMB_AT_CONSTRAINT: return multiplier_value(sim, output, value);
    case DMB_AT_CONTACT: return site_value(sim, output, value);
    case DMB_AT_SCENE: return scene_value(sim, output, value);
    case DMB_AT_VIBRATION:
    case DMB_AT_WINDOW: return DMB_ERR_UNSUPPORTED;
    default: return place_value(sim, output, value);
    }
}

int32_t dmb_answer_output(const dmb_sim *sim, const dmb_output *output, double *value)
{
    const int32_t status = dmb_ask(sim, value);
    double found = 0.0;
    if (status < 0) return status;
    if (output == NULL) return DMB_ERR_NULL;
    const int32_t answer = dmb_output_value(sim, output, &found);
    if (answer >= 0) *value = found;
    return answer;
}

/* ---- Calls ------------------------------------------------------------------------------------------------------- */

int32_t dmb_query_output(const dmb_sim *sim, const dmb_output *output, double *value)
{
    const int32_t status = dmb_answer_output(sim, output, value);
    dmb_message why;
    if (status >= 0) return status;
    dmb_message_clear(&why);
    if (dmb_sim_check(sim) == DMB_OK && output != NULL && value != NULL)
        dmb_output_explain(sim->model, output, 0, status, &why);
    return dmb_sim_fail(sim, status, "output", why.text);
}

double dmb_sim_value(const dmb_sim *sim, int32_t quantity, dmb_place place)
{
    const dmb_output output = {place, quantity, 0};
    double value = 0.0;
    return dmb_query_output(sim, &output, &value) < 0 ? (double)NAN : value;
}

int32_t dmb_output_check(dmb_sim *sim, const dmb_output *outputs, uint32_t output_count)
{
    if (sim == NULL || outputs == NULL) return dmb_sim_failed(sim, "outputs", DMB_ERR_NULL);
    int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    if (status < 0) return status;
    for (uint32_t i = 0; i < output_count && status >= 0; i++) {
        double unused;
        status = dmb_output_value(sim, outputs + i, &unused);
        if (status < 0) dmb_output_explain(sim->model, outputs + i, i, status, &sim->message);
    }
    return dmb_sim_leave(sim, status);
}
