/* Putting a scene together: Gauss-Newton on all equations of position, shortest moves first (Wehage, Haug 1982). */
#ifndef DMB_SYSTEM_CONSTRAIN_ASSEMBLY_H
#define DMB_SYSTEM_CONSTRAIN_ASSEMBLY_H

#include "system/constrain/joint_state.h"

/* Closes the joints from the described poses of now: poses move until every equation holds and joints stand where their
 * initial coordinates say, speeds likewise. Fills counters->assembly. Errors with a message: DMB_ERR_GEOMETRY (the
 * joint that does not fit, and by how much), DMB_ERR_CALLBACK. system/constrain/assembly */
int32_t dmb_assemble(dmb_sim *sim);
/* Refuses a joint whose frames, in the trial, point against each other where it keeps them parallel: its equations hold
 * there too. DMB_ERR_GEOMETRY with a message. */
int32_t dmb_joint_refuse_flip(dmb_sim *sim, uint32_t joint);
/* Largest changes of the speeds from now to trial into counters->projection. */
void dmb_note_projection(dmb_sim *sim);
/* Refuses speeds of the trial that do not satisfy an equation, one that was dropped included: DMB_ERR_GEOMETRY. */
int32_t dmb_assembled_speeds(dmb_evaluation *evaluation);

#endif
