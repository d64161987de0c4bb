/* Terms of joints in the residual: springs, dampers, stops, friction and drives along their coordinates, and the forces
 * of constraint; and the tangent of all that. A generalised force f on a coordinate with gradient J is the wrench J^T
 * f. */
#ifndef DMB_SYSTEM_ASSEMBLE_JOINT_FORCES_H
#define DMB_SYSTEM_ASSEMBLE_JOINT_FORCES_H

#include "system/assemble/evaluation.h"

/* Onto constraint_tangent, which is cleared before. */
int32_t dmb_gather_joints(dmb_evaluation *evaluation);

#endif
