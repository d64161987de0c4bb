/* The pose of a section inside an element, seen from the element's end A:
 *
 *     H(x) = exp(x d) exp(c(x) d),   x = 0 at A .. 1 at B,   d = log(H_A^-1 H_B)
 *
 * exp(x d) is the element's own helix, exact for any uniform strain (Sonneville, Cardona, Bruls 2014). It spreads the
 * sideways part of d evenly; c puts it onto the S of the Timoshenko cubic shapes N3, G3 (THEORY 3), which is where the
 * shear force of the corrected stiffness 1/GA* = 1/GA + L^2/(12 EI) belongs. To first order in the bending of the
 * element the two together are the shapes N1 .. N4, G1 .. G4 about the frame in the middle, so that a beam loaded at
 * its nodes is exact in between. c is 0 at both ends: nodes are reproduced. */
#ifndef DMB_QUERY_MOTION_H
#define DMB_QUERY_MOTION_H

#include "element/beam.h"
#include "query/place.h"

/* The two nodes of an element seen from each other. */

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

/* Shape of the section at a point inside an element. */
void dmb_material_point_shape(const dmb_scene *scene, const dmb_material_point *point, dmb_section_shape *shape);

/* Pose and motion of a point: of its node, moved by a rigid arm, or of a section between two nodes. */

typedef struct dmb_material_point_pose {
    double rotation[9];     /* [-] body to world, row-major */
    double position[3];     /* [m] world */
    double displacement[3]; /* [m] world, position less that at time 0 as described */
} dmb_material_point_pose;

void dmb_material_point_pose_of(const dmb_scene *scene, const dmb_configuration *configuration,
                                const dmb_material_point *point, dmb_material_point_pose *pose);

/* Axes of the point at time 0 as described, body to world. */
void dmb_material_point_start_axes(const dmb_scene *scene, const dmb_material_point *point, double R[9]);

/* Velocity [m/s, rad/s] and its rate [m/s2, rad/s2] in the axes of the section: the exact time derivatives of the pose
 * above. */
typedef struct dmb_material_point_motion {
    double velocity[6];
    double acceleration[6];
} dmb_material_point_motion;

void dmb_material_point_motion_of(const dmb_scene *scene, const dmb_configuration *configuration,
                                  const dmb_material_point *point, dmb_material_point_motion *motion);

/* [rad] turn about the pipe's axis since time 0, linear between nodes */
double dmb_material_point_turn(const dmb_configuration *configuration, const dmb_material_point *point);

/* [m] measured depth of the closest point of the hole's axis to x; 0 without a hole. O(log stations). */
double dmb_material_point_depth(const dmb_scene *scene, const dmb_configuration *configuration,
                                const dmb_material_point *point, const double x[3]);

#endif
