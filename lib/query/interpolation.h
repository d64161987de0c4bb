/* Pose and motion of a spot: of its node, moved by a rigid arm, or of a section between two nodes. */
#ifndef DMB_QUERY_INTERPOLATION_H
#define DMB_QUERY_INTERPOLATION_H

#include "query/spot.h"

typedef struct dmb_spot_pose {
    double rotation[9];     /* [-] body to world, row-major */
    double position[3];     /* [m] world */
    double displacement[3]; /* [m] world, position less that at time 0 as described */
} dmb_spot_pose;

void dmb_spot_pose_of(const dmb_scene *scene, const dmb_configuration *configuration, const dmb_spot *spot,
                      dmb_spot_pose *pose);

/* Velocity [m/s, rad/s] and its rate [m/s2, rad/s2] in the axes of the section: the exact time derivatives of the pose
 * above. */
typedef struct dmb_spot_motion {
    double velocity[6];
    double acceleration[6];
} dmb_spot_motion;

void dmb_spot_motion_of(const dmb_scene *scene, const dmb_configuration *configuration, const dmb_spot *spot,
                        dmb_spot_motion *motion);

/* [rad] turn about the pipe's axis since time 0, linear between nodes */
double dmb_spot_turn(const dmb_configuration *configuration, const dmb_spot *spot);

/* [m] measured depth of the closest point of the hole's axis to x; 0 without a hole. O(log stations). */
double dmb_spot_depth(const dmb_scene *scene, const dmb_configuration *configuration, const dmb_spot *spot,
                      const double x[3]);

#endif
