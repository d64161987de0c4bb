#include "analysis/answer.h"

static double of_motion(const dmb_sim *sim, const dmb_output *o, int32_t *status)
{
    dmb_motion motion = dmb_motion_default();
    motion.frame = o->frame;
    *status = dmb_query_motion(sim, o->place, &motion);
    return o->kind == DMB_OUTPUT_VELOCITY ? motion.velocity[o->component] : motion.acceleration[o->component];
}

static double of_section(const dmb_sim *sim, const dmb_output *o, int32_t *status)
{
    dmb_section section = dmb_section_default();
    *status = dmb_query_section(sim, o->place, &section);
    return o->kind == DMB_OUTPUT_SECTION_FORCE ? section.force[o->component] : section.strain[o->component];
}

static double of_contact(const dmb_sim *sim, const dmb_output *o, int32_t *status)
{
    dmb_contact contact = dmb_contact_default();
    *status = dmb_query_contact(sim, o->place.pipe, &contact);
    return o->component == DMB_Z ? contact.normal_force : contact.friction[o->component == DMB_Y];
}

static double of_drive(const dmb_sim *sim, const dmb_output *o, int32_t *status)
{
    dmb_drive_state state = dmb_drive_state_default();
    *status = dmb_query_drive(sim, o->place.part, &state);
    return state.force;
}

static double of_guide(const dmb_sim *sim, const dmb_output *o, int32_t *status)
{
    double reaction[6] = {0.0};
    *status = dmb_query_reaction(sim, o->place.part, reaction);
    return reaction[o->component];
}

static double of_joint(const dmb_sim *sim, const dmb_output *o, int32_t *status)
{
    dmb_joint_state state = dmb_joint_state_default();
    state.frame = o->frame;
    *status = dmb_query_joint(sim, o->place.part, &state);
    switch (o->kind) {
    case DMB_OUTPUT_JOINT_POSITION: return state.position[o->component];
    case DMB_OUTPUT_JOINT_SPEED: return state.speed[o->component];
    case DMB_OUTPUT_JOINT_ACCELERATION: return state.acceleration[o->component];
    case DMB_OUTPUT_JOINT_REACTION: return state.reaction[o->component];
    default: return state.action[o->component];
    }
}

static double of_multiplier(const dmb_sim *sim, const dmb_output *o, int32_t *status)
{
    double multipliers[6] = {0.0};
    uint32_t count = 0;
    *status = dmb_query_multipliers(sim, o->place.part, multipliers, &count);
    if (*status >= 0 && (uint32_t)o->component >= count) *status = DMB_ERR_VALUE;
    return multipliers[o->component];
}

static double of_bit(const dmb_sim *sim, const dmb_output *o, int32_t *status)
{
    dmb_bit_state state = dmb_bit_state_default();
    *status = dmb_query_bit(sim, o->place.part, &state);
    return o->component == DMB_X ? state.weight : state.torque;
}

double dmb_answer_of(const dmb_sim *sim, const dmb_output *output, int32_t *status)
{
    switch (output->kind) {
    case DMB_OUTPUT_VELOCITY:
    case DMB_OUTPUT_ACCELERATION: return of_motion(sim, output, status);
    case DMB_OUTPUT_SECTION_FORCE:
    case DMB_OUTPUT_SECTION_STRAIN: return of_section(sim, output, status);
    case DMB_OUTPUT_CONTACT: return of_contact(sim, output, status);
    case DMB_OUTPUT_DRIVE: return of_drive(sim, output, status);
    case DMB_OUTPUT_REACTION: return of_guide(sim, output, status);
    case DMB_OUTPUT_MULTIPLIER: return of_multiplier(sim, output, status);
    case DMB_OUTPUT_BIT: return of_bit(sim, output, status);
    default: return of_joint(sim, output, status);
    }
}
