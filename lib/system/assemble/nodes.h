/* Forces of single nodes: rigid masses, gravity, external damping. */
#ifndef DMB_SYSTEM_ASSEMBLE_NODES_H
#define DMB_SYSTEM_ASSEMBLE_NODES_H

#include "system/assemble/evaluation.h"
#include "system/assemble/point_motion.h"

void dmb_gather_nodes(dmb_evaluation *evaluation);
void dmb_gather_loads(dmb_evaluation *evaluation);
void dmb_gather_flow(dmb_evaluation *evaluation);

/* Described loads that act at a point inside an element, or off the axis of a node. */

/* factor times the load; frame (body to world) of its components unless it follows the body. */
void dmb_gather_point_load(dmb_evaluation *evaluation, const dmb_scene_load *load, double factor,
                           const double frame[9]);

#endif
