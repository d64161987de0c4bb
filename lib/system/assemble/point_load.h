/* Described loads that act at a point inside an element, or off the axis of a node. */
#ifndef DMB_SYSTEM_ASSEMBLE_POINT_LOAD_H
#define DMB_SYSTEM_ASSEMBLE_POINT_LOAD_H

#include "system/assemble/point_motion.h"

/* factor times the load; frame (body to world) of its components unless it follows the body. */
void dmb_gather_point_load(dmb_evaluation *evaluation, const dmb_scene_load *load, double factor,
                           const double frame[9]);

#endif
