/* The two nodes of an element seen from each other. */
#ifndef DMB_QUERY_RELATIVE_POSE_H
#define DMB_QUERY_RELATIVE_POSE_H

#include "query/section_shape.h"
#include "query/spot.h"

typedef struct dmb_end_pose {
    double rotation[9];     /* [-] body to world, row-major */
    double displacement[3]; /* [m] world, from reference_position */
} dmb_end_pose;

/* Pose of a node in a configuration, and at time 0 as described. */
void dmb_end_pose_now(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t node,
                      dmb_end_pose *pose);
void dmb_end_pose_at_start(const dmb_scene *scene, uint32_t node, dmb_end_pose *pose);

/* d = log(H_A^-1 H_B) of the element's flexible ends from the poses of its nodes, whatever their kind. */
void dmb_relative_pose(const dmb_scene *scene, uint32_t element, const dmb_end_pose *a, const dmb_end_pose *b,
                       double d[6]);

/* Shape of the section at a spot inside an element. */
void dmb_spot_shape(const dmb_scene *scene, const dmb_spot *spot, dmb_section_shape *shape);

#endif
