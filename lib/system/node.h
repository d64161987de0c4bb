/* Pose and speed of a node whatever its kind: a PATH node's pose follows from its place on the hole's axis. */
#ifndef DMB_SYSTEM_NODE_H
#define DMB_SYSTEM_NODE_H

#include "state.h"

/* Rotation (body to world, row-major) and displacement [m] (world, from reference_position) of a node. */
void dmb_node_pose(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t node, double rotation[9],
                   double displacement[3]);
/* Body-frame 6-vector from an array over rows (velocity or acceleration): PATH rows become components x and rx, on a
 * curved hole with the turning of the axis. */
void dmb_node_vector(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t node, const double *rows,
                     double vector[6]);
/* Columns of the body-frame motion of a PATH node per unit of its two rows, shape (2, 6); rotation is its present one. */
void dmb_path_columns(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t node,
                      const double rotation[9], double columns[12]);
/* [m] measured depth of a PATH node. */
double dmb_path_depth(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t node);

/* How many FULL nodes follow one another from this one on; 0: it is a PATH node. */
uint32_t dmb_count_full_nodes(const dmb_scene *scene, uint32_t node);
static inline uint32_t dmb_full_nodes_at(const dmb_scene *scene, uint32_t node)
{
    return scene->layout.size[node] == DMB_NODE_FULL ? dmb_count_full_nodes(scene, node) : 0;
}
/* Element before (side 0) or after (side 1) a node; UINT32_MAX at the ends of its chain. */
uint32_t dmb_element_between(const dmb_scene *scene, uint32_t node, uint32_t side);

#endif
