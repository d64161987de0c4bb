/* The hole: its axis and the laws of its wall. */
#ifndef DMB_MODEL_DESCRIBE_WALL_H
#define DMB_MODEL_DESCRIBE_WALL_H

#include "model/model.h"

/* Frees the wall's copy of the survey. */
void dmb_wall_release(dmb_wall_def *wall, const dmb_allocator *allocator);

#endif
