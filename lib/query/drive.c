/* Drives and bits at the accepted state. */
#include "sim/access.h"
#include "system/assemble/bit.h"
#include "system/assemble/drives.h"

DMB_DECLARE_STRUCT(dmb_drive_state)

int32_t dmb_query_drive(const dmb_sim *sim, dmb_id drive, dmb_drive_state *state)
{
    const int32_t status = dmb_ask(sim, state);
    dmb_drive_state answer = {0};
    uint32_t i;
    if (status < 0) return status;
    i = dmb_model_part_index(sim->model, drive, DMB_PART_DRIVE);
    if (i >= sim->scene->drive_count) return DMB_ERR_ID;
    answer.target = sim->now.drive_target[i];
    answer.position = sim->now.drive_position[i];
    answer.speed = dmb_drive_speed(sim->scene, &sim->now, i);
    answer.force = sim->now.drive_force[i];
    answer.power = answer.force * answer.speed;
    answer.work = sim->drive_work[i];
    answer.command = answer.made = answer.force;
    if (sim->scene->drives[i].actuator != DMB_NONE) {
        answer.command = dmb_actuator_flow_of(&sim->now, sim->scene->drives[i].actuator)->command;
        answer.made = dmb_actuator_flow_of(&sim->now, sim->scene->drives[i].actuator)->force;
    }
    return dmb_drive_state_write(state, &answer);
}

DMB_DECLARE_STRUCT(dmb_bit_state)

int32_t dmb_query_bit(const dmb_sim *sim, dmb_id bit, dmb_bit_state *state)
{
    const int32_t status = dmb_ask(sim, state);
    dmb_bit_state answer = {0};
    dmb_bit_rock_result rock;
    uint32_t i;
    if (status < 0) return status;
    i = dmb_model_part_index(sim->model, bit, DMB_PART_BIT);
    if (i >= sim->scene->bit_count) return DMB_ERR_ID;
    dmb_bit_force_of(sim, i, &rock, &answer.load);
    answer.on_bottom = rock.on_bottom;
    answer.advance = sim->now.bit_advance[i];
    answer.bottom = sim->now.bit_bottom[i];
    answer.depth_of_cut = rock.depth_of_cut;
    answer.weight = rock.weight_on_bit;
    answer.torque = rock.torque_on_bit;
    answer.side_speed = dmb_bit_side_of(sim, i, answer.side_force);
    return dmb_bit_state_write(state, &answer);
}
