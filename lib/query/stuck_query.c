/* Places that can be stuck. */
#include <math.h>
#include <string.h>

#include "base/sized_struct.h"
#include "drillmbd/bha.h"
#include "sim/access.h"
#include "system/assemble/stuck.h"

DMB_DEFINE_INIT(dmb_stuck_state, 88, {.stuck = 0})

int32_t dmb_query_stuck(const dmb_sim *sim, dmb_id stuck, dmb_stuck_state *state)
{
    const int32_t status = dmb_ask(sim, state);
    dmb_stuck_state answer = {0};
    if (status < 0) return status;
    const uint32_t i = dmb_model_part_index(sim->model, stuck, DMB_PART_STUCK);
    if (i >= sim->scene->stuck_count) return DMB_ERR_ID;
    const dmb_scene_stuck *of = sim->scene->stuck + i;
    if (sim->stuck_held[i]) {
        const double stiffness[4] = {of->stiffness[0], of->stiffness[2], of->stiffness[2], of->stiffness[1]};
        dmb_stuck_hold hold;
        dmb_stuck_hold_of(sim, &sim->now, i, 1, &hold);
        answer.stuck = 1;
        memcpy(answer.offset, hold.s, sizeof answer.offset);
        for (int k = 0; k < DMB_STUCK_COORDINATES; k++) {
            answer.force[k] = -hold.force[k];
            answer.energy += 0.5 * stiffness[k] * hold.s[k] * hold.s[k];
        }
        answer.share = dmb_stuck_share(sim, &sim->now, i, 1);
    }
    return dmb_stuck_state_write(state, &answer);
}
