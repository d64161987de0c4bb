/* Pose and twist of the point of action of a force, and the mapping of wrenches there to the rows of its nodes. */
#ifndef DMB_SYSTEM_ASSEMBLE_POINT_MOTION_H
#define DMB_SYSTEM_ASSEMBLE_POINT_MOTION_H

#include "system/assemble/evaluation.h"

enum { DMB_POINT_COLUMNS = 12 };

/* Motion of a point, in the axes of its node or of its section; of the ground: world axes. */
typedef struct dmb_point_motion {
    double R[9]; /* [-] axes, body to world, row-major */
    double x[3]; /* [m] relative to the position of its node at time 0 (of the ground: to the world's origin), world */
    double map[72]; /* V by the body-frame velocities of its nodes, shape (6, 12) */
    double V[6];    /* [m/s, rad/s] of the point in its axes */
    double v[12];   /* [m/s, rad/s] of its nodes */
    double d[6];    /* [m, rad] of the element it is in */
    const dmb_scene_point *point;
    uint32_t nodes; /* 0: ground, 1: a node, 2: an element */
    uint32_t node[2];
} dmb_point_motion;

void dmb_point_motion_of(const dmb_scene *scene, const dmb_configuration *configuration, const dmb_scene_point *point,
                         dmb_point_motion *motion);
/* Adds the wrench w at the point, in its axes, to its nodes. */
void dmb_point_apply(dmb_sim *sim, const dmb_point_motion *motion, const double w[6]);
/* K, shape (12, 12): change of map^T w by body-frame displacements of the nodes at constant w in the axes of the point.
 */
void dmb_point_map_tangent(const dmb_scene *scene, const dmb_point_motion *motion, const double w[6], double K[144]);

/* Nodes of a force with consecutive rows, and its tangent by body-frame displacements or velocities, shape (columns,
 * columns), with the sign of the residual (-d force). */
typedef struct dmb_force_tangent {
    uint32_t nodes, columns;
    uint32_t node[DMB_CONSTRAINT_NODES], column[DMB_CONSTRAINT_NODES]; /* first column of each */
    double K[DMB_CONSTRAINT_COLUMNS * DMB_CONSTRAINT_COLUMNS];
} dmb_force_tangent;

/* Starts without nodes; adds the nodes of a point. */
void dmb_force_tangent_begin(dmb_force_tangent *tangent);
void dmb_force_tangent_touch(const dmb_scene *scene, const dmb_point_motion *motion, dmb_force_tangent *tangent);
/* Clears K after all nodes have been added. */
void dmb_force_tangent_clear(dmb_force_tangent *tangent);
/* row (shape (columns)) += values, shape (12), in the columns of the point's nodes. */
void dmb_force_tangent_columns(const dmb_scene *scene, const dmb_force_tangent *tangent, const dmb_point_motion *motion,
                               const double values[12], double *row);
/* row (shape (columns)) += w map in the columns of the point's nodes. */
void dmb_force_tangent_row(const dmb_scene *scene, const dmb_force_tangent *tangent, const dmb_point_motion *motion,
                           const double w[6], double *row);
/* K += factor A, shape (12, 12), rows and columns of one point. */
void dmb_force_tangent_block(const dmb_scene *scene, dmb_force_tangent *tangent, const dmb_point_motion *motion,
                             double factor, const double A[144]);
/* Adds K, by displacements or by velocities, to the blocks of the chain, or to the tangent of the constraint unless
 * that is DMB_NONE. Overwrites K. */
enum { DMB_BY_DISPLACEMENT = 0, DMB_BY_VELOCITY = 1 };
void dmb_force_tangent_add(const dmb_evaluation *evaluation, uint32_t constraint, int by, dmb_force_tangent *tangent);

#endif
