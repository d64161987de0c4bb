/* Joints, couplings, the caller's constraints and forces, and their rows, as the compiled scene has them. */
#ifndef DMB_MODEL_SCENE_CONSTRAINT_H
#define DMB_MODEL_SCENE_CONSTRAINT_H

#include <stdint.h>

#include "drillmbd/scene.h"
#include "fields/bounds.h"

/* A material point at any place, or a point of the ground. */
typedef struct dmb_scene_point {
    double x[3];      /* [m] ground: world; else in the frame of the node, or of the section inside the element */
    double fraction;  /* [-] of the element's flexible length */
    uint32_t node;    /* DMB_NONE: the ground; node a of the element */
    uint32_t element; /* DMB_NONE: rigid with the node */
} dmb_scene_point;

/* Kind of part that a constraint belongs to. */
enum {
    DMB_OF_JOINT = 0,
    DMB_OF_COUPLING = 1,
    DMB_OF_DRIVE = 2,
    DMB_OF_CALLBACK = 3,
    DMB_OF_SPRING = 4,
    DMB_OF_FORCE = 5
};
enum { DMB_CONSTRAINT_NODES = 8, DMB_CONSTRAINT_COLUMNS = 48 };

/* A frame fixed to a node's frame, or standing in the world. */
typedef struct dmb_scene_frame {
    double x[3];   /* [m] origin: in the node's frame; of the ground: world */
    double M[9];   /* [-] axes as columns, row-major */
    uint32_t node; /* DMB_NONE: the ground */
    uint32_t reserved;
} dmb_scene_frame;

typedef struct dmb_scene_joint {
    dmb_scene_frame a, b;
    double span[3]; /* [m] origin of node b less origin of node a (or of the world) at time 0, world, exact */
    double length;  /* [m] of DISTANCE, radius of ROLLING */
    double initial_position[6], initial_speed[6];
    int32_t kind;  /* DMB_JOINT_... */
    int32_t state; /* at time 0 */
    int32_t initial_mask;
    int32_t law_mask;     /* coordinates that have a law */
    uint32_t law;         /* first of its six laws in `laws`; DMB_NONE: none acts */
    uint32_t constraint;  /* its constraint (even if it has no rows now) */
    uint32_t first_drive; /* its drives in joint_drives */
    uint32_t drive_count;
    char name[24];
} dmb_scene_joint;

/* sum of factor[i] times coordinate i keeps its value */
enum { DMB_COUPLED = 4 };
typedef struct dmb_scene_coupling {
    double factor[DMB_COUPLED];
    uint32_t joint[DMB_COUPLED];
    int32_t component[DMB_COUPLED];
    uint32_t constraint;
    uint32_t count; /* [-] coordinates, 2 .. 4 */
    char name[24];
} dmb_scene_coupling;

typedef struct dmb_scene_callback {
    dmb_scene_frame place[DMB_CONSTRAINT_PLACES]; /* frames of its places */
    dmb_constraint_fn callback;
    void *context;
    uint32_t rows, count;
    int32_t kind; /* DMB_CONSTRAINT_... */
    int32_t provides;
    uint32_t constraint;
    uint32_t reserved;
    char name[24];
} dmb_scene_callback;

/* The caller's force. */
typedef struct dmb_scene_force {
    dmb_scene_point point[DMB_CONSTRAINT_PLACES]; /* where no joint is */
    uint32_t joint[DMB_CONSTRAINT_PLACES];        /* DMB_NONE: a point */
    int32_t component[DMB_CONSTRAINT_PLACES];
    dmb_force_fn callback;
    dmb_accept_fn accept; /* NULL: none */
    void *context;
    double pose_step, speed_step;
    uint32_t count;
    uint32_t state, states; /* first number of its state, and how many */
    uint32_t reserved;
    int32_t frame, provides;
    uint32_t constraint; /* DMB_NONE: within a node or an element */
    char name[24];
} dmb_scene_force;

/* Rows of one joint (room for six, so that it can be locked), coupling, joint drive or callback; of springs and forces
 * one that is always idle. Its columns are all rows of its nodes, held ones too. */
typedef struct dmb_constraint {
    int32_t kind;   /* DMB_OF_... */
    uint32_t index; /* which joint, coupling, drive, callback, spring, force */
    uint32_t row;   /* first of its constraint rows */
    uint32_t rows;  /* room */
    uint32_t node_count;
    uint32_t node[DMB_CONSTRAINT_NODES];   /* distinct */
    uint32_t column[DMB_CONSTRAINT_NODES]; /* first column of each node in this constraint */
    uint32_t columns;
    uint32_t jacobian; /* start of its (rows x columns) in constraint_jacobian */
    uint32_t tangent;  /* start of its (columns x columns) in constraint_tangent */
    uint32_t cluster;
    uint32_t block; /* of the pattern that its multipliers belong to; of a sparse cluster only */
} dmb_constraint;

#endif
