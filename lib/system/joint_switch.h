/* Joints that lock, open and close in a run. Speeds that the new equations do not allow change by the impulse of least
 * kinetic energy, M (v+ - v-) + B^T impulse = 0, B v+ + rate = 0. */
#ifndef DMB_SYSTEM_JOINT_SWITCH_H
#define DMB_SYSTEM_JOINT_SWITCH_H

#include "system/constrain/joint_state.h"

/* dmb_sim_set_joint for a joint that exists. system/joint_switch */
int32_t dmb_joint_switch(dmb_sim *sim, uint32_t joint, int32_t state);

#endif
