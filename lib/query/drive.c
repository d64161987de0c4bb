#include "query/ask.h"
#include "system/drives.h"

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
    return dmb_drive_state_write(state, &answer);
}
