/* Places that are stuck: springs and dampers to the pose where they got stuck, until they let go (THEORY 8). */
#ifndef DMB_SYSTEM_ASSEMBLE_STUCK_H
#define DMB_SYSTEM_ASSEMBLE_STUCK_H

#include "system/assemble/evaluation.h"

enum { DMB_STUCK_COORDINATES = 4 }; /* along, sideways y and z, about the axis */

/* Offset and force of a place that is held, in the axes of the anchor. */
typedef struct dmb_stuck_hold {
    double s[DMB_STUCK_COORDINATES];     /* [m, m, m, rad] */
    double force[DMB_STUCK_COORDINATES]; /* [N, N, N, N m] k s + c s', on the ground */
} dmb_stuck_hold;

/* Residual, tangent and powers of all places that are stuck. */
void dmb_gather_stuck(dmb_evaluation *evaluation);
/* [J] stored in their springs. */
double dmb_stuck_energy(const dmb_sim *sim, const dmb_configuration *configuration);
/* Of a place that is stuck; without rates the dampers do not act. */
void dmb_stuck_hold_of(const dmb_sim *sim, const dmb_configuration *configuration, uint32_t i, int rates,
                       dmb_stuck_hold *hold);
/* [-] Largest force over that at which it lets go; 0 where it is not stuck. */
double dmb_stuck_share(const dmb_sim *sim, const dmb_configuration *configuration, uint32_t i, int rates);
/* [-] The largest of all places. */
double dmb_stuck_largest_share(const dmb_sim *sim, const dmb_configuration *configuration, int rates);

/* At time 0, as described or as its input says. */
void dmb_stuck_start(dmb_sim *sim, uint32_t i);
/* In the accepted pose it gets stuck, or free. */
void dmb_stuck_set(dmb_sim *sim, uint32_t i, int32_t held);
/* As the inputs were before, which are those that are set again: an anchor was taken by what had been free only. */
void dmb_stuck_put_back(dmb_sim *sim);

/* From a sim of another model, whose nodes begin elsewhere: stuck where it was in the world. */
void dmb_stuck_transfer(dmb_sim *sim, const dmb_sim *from, uint32_t i);

#endif
