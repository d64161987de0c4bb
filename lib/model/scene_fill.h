/* Filling the arrays of a scene from a finished mesh. */
#ifndef DMB_MODEL_SCENE_FILL_H
#define DMB_MODEL_SCENE_FILL_H

#include "model/mesh.h"

/* The layout's arrays and the hole's stations, which the scene sees as read-only. */
typedef struct dmb_scene_storage {
    uint8_t *size;
    uint32_t *row, *diag, *link;
    dmb_hole_station *stations;
} dmb_scene_storage;

/* Free rows, and rows that MOTION drives move, as bits of the node's own rows. */
static inline uint8_t dmb_free_rows(const dmb_mesh_node *node)
{
    if (node->size == DMB_NODE_FULL) return node->free;
    return (uint8_t)((node->free >> DMB_X & 1) | (node->free >> DMB_RX & 1) << 1);
}

static inline uint8_t dmb_prescribed_rows(const dmb_mesh_node *node)
{
    if (node->size == DMB_NODE_FULL) return node->prescribed;
    return (uint8_t)((node->prescribed >> DMB_X & 1) | (node->prescribed >> DMB_RX & 1) << 1);
}

/* All arrays of a scene whose counts are set and whose arrays have their places. DMB_ERR_TOO_LARGE if the blocks cannot
 * be counted in 32 bits. */
int32_t dmb_scene_fill(const dmb_mesh *mesh, dmb_scene *scene, dmb_scene_storage *storage);

#endif
