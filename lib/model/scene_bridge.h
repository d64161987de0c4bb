/* Joints that are bridges: without one of them the parts beyond it hang together with nothing else, neither by joints nor
 * by the ground. */
#ifndef DMB_MODEL_SCENE_BRIDGE_H
#define DMB_MODEL_SCENE_BRIDGE_H

#include "model/scene.h"

/* beyond (shape (constraint_count)): of a bridge the node on the side that the ground is not on, else UINT32_MAX. The
 * equations of couplings and callbacks connect all their nodes and the ground; those of joint drives go with their joint.
 * Tarjan, A note on finding the bridges of a graph, 1974. Linear. DMB_OK, DMB_ERR_NO_MEMORY. */
int32_t dmb_scene_bridges(const dmb_scene *scene, const dmb_allocator *allocator, uint32_t *beyond);

#endif
