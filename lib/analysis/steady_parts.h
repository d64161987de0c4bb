/* What the pieces of steady states are to each other. */
#ifndef DMB_ANALYSIS_STEADY_PARTS_H
#define DMB_ANALYSIS_STEADY_PARTS_H

#include "analysis/steady.h"

/* [-] Directions and speeds that differ by no more than this are one. */
#define DMB_STEADY_SAME 1e-9

#define REFUSE(sim, ...) (dmb_message_set(&(sim)->message, "static: " __VA_ARGS__), DMB_ERR_UNSUPPORTED)

/* Speed that a motion drive prescribes; the trial holds those of the present time (dmb_system_prescribe). */
static inline double dmb_steady_target(const dmb_sim *sim, uint32_t drive)
{
    return sim->trial.drive_target[drive];
}

/* Speeds of the strings, from the drives. DMB_ERR_UNSUPPORTED with a message, DMB_ERR_NO_MEMORY. */
int32_t dmb_steady_choose_sliding(dmb_sim *sim, dmb_steady *steady);
/* Joints and the accepted state's poses allow the velocities; or DMB_ERR_UNSUPPORTED with a message. */
int32_t dmb_steady_check_joints(dmb_steady *steady, dmb_evaluation *evaluation);

#endif
