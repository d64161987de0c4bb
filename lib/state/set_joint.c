/* The caller's hand on a joint. */
#include "state/handle.h"
#include "system/joint_state.h"

static int32_t set_joint(dmb_sim *sim, dmb_id joint, int32_t state)
{
    const uint32_t j = dmb_model_part_index(sim->model, joint, DMB_PART_JOINT);
    if (j >= sim->scene->joint_count) {
        dmb_message_set(&sim->message, "joint: the id names no joint of this model");
        return DMB_ERR_ID;
    }
    if (state < DMB_JOINT_ACTIVE || state > DMB_JOINT_OPEN) {
        dmb_message_field(&sim->message, "joint", j, "state", state, "from 0 to 2");
        return DMB_ERR_VALUE;
    }
    return dmb_joint_switch(sim, j, state);
}

int32_t dmb_sim_set_joint(dmb_sim *sim, dmb_id joint, int32_t state)
{
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_CHANGING);
    return status < 0 ? status : dmb_sim_leave(sim, set_joint(sim, joint, state));
}
