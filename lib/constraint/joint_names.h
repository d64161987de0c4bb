/* What people call joints and their equations, for reports. */
#ifndef DMB_CONSTRAINT_JOINT_NAMES_H
#define DMB_CONSTRAINT_JOINT_NAMES_H

#include "constraint/joint.h"

/* "revolute" and the like; "joint" for a kind that is none. */
const char *dmb_joint_kind_name(int32_t kind);
/* What row `row` of a kind holds, seen from frame a: "position y", "rotation about z". A locked joint has the rows of
 * DMB_ROWS_FIXED. "row" where the kind has no such row. */
const char *dmb_joint_row_name(int32_t kind, uint32_t row);

#endif
