/* Blocks of the chains that joints connect. */
#ifndef DMB_MODEL_SCENE_LINK_H
#define DMB_MODEL_SCENE_LINK_H

#include "model/scene.h"

/* After everything else of the scene is filled: columns and places of the clusters' nodes, linked chains, blocks,
 * pattern and links. Does nothing without clusters. Errors: DMB_ERR_NO_MEMORY, DMB_ERR_TOO_LARGE, with no pattern
 * left. */
int32_t dmb_scene_link(dmb_scene *scene, const dmb_allocator *allocator);

#endif
