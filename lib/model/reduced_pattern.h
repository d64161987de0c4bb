/* Blocks of the chains that joints connect. */
#ifndef DMB_MODEL_REDUCED_PATTERN_H
#define DMB_MODEL_REDUCED_PATTERN_H

#include "model/scene.h"

/* After everything else of the scene is filled: columns and places of the clusters' nodes, jointed chains, blocks,
 * pattern and links. Does nothing without clusters. Errors: DMB_ERR_NO_MEMORY, DMB_ERR_TOO_LARGE, with no pattern
 * left. */
int32_t dmb_scene_link(dmb_scene *scene, const dmb_allocator *allocator);

/* Joints that are bridges: without one of them the parts beyond it hang together with nothing else, neither by joints
 * nor by the ground. */

/* beyond (shape (constraint_count)): of a bridge the node on the side that the ground is not on, else DMB_NONE. The
 * equations of couplings and callbacks connect all their nodes and the ground; those of joint drives go with their
 * joint. Tarjan, A note on finding the bridges of a graph, 1974. Linear. DMB_OK, DMB_ERR_NO_MEMORY. */
int32_t dmb_scene_bridges(const dmb_scene *scene, const dmb_allocator *allocator, uint32_t *beyond);

#endif
