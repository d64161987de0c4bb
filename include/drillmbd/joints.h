/* libdrillmbd - joints, couplings of their coordinates, and the caller's own constraints. */
#ifndef DRILLMBD_JOINTS_H
#define DRILLMBD_JOINTS_H

#include "model.h"

DMB_C_BEGIN

/* ---- Joints ------------------------------------------------------------------------------------------------------
 * A joint holds frame b on one part against frame a on another. Its coordinates are frame b seen from frame a: X, Y, Z
 * the origin of b in a [m]; RX, RY, RZ the angles of the rotation Ry(RY) Rz(RZ) Rx(RX) from a to b [rad], RX and RY
 * counted over full turns. The x axis of the frames is the joint's axis. Parts need not fit as described,
 * dmb_sim_create brings them together; but axes that a joint keeps parallel (x; fixed, prismatic, translational, cross
 * slide: y too) should be less than a right angle apart: where they end up pointing against each other it is refused,
 * DMB_ERR_GEOMETRY. So is, at creation, in statics and in a run, |RZ| within 0.01 rad of a right angle, where RX and RY
 * are not defined: of a universal joint, and of others with springs, dampers, stops, friction, drives or couplings on
 * an angle; and a rim that rolls and lies flat (sine of its angle with the plane 1e-3). Locked and open joints may
 * be there. */
enum {
    DMB_JOINT_FIXED = 0,
    DMB_JOINT_REVOLUTE = 1,       /* RX free */
    DMB_JOINT_PRISMATIC = 2,      /* X free */
    DMB_JOINT_CYLINDRICAL = 3,    /* X, RX free */
    DMB_JOINT_UNIVERSAL = 4,      /* RY, RZ free: crossed axes y of a and z of b */
    DMB_JOINT_SPHERICAL = 5,      /* RX, RY, RZ free */
    DMB_JOINT_PLANAR = 6,         /* Y, Z, RX free: x is the normal of the plane */
    DMB_JOINT_POINT_ON_LINE = 7,  /* X, RX, RY, RZ free: origin of b on the x axis of a */
    DMB_JOINT_POINT_ON_HOLE = 8,  /* origin of b on the axis of the hole; a must be the ground (support, centraliser) */
    DMB_JOINT_DISTANCE = 9,       /* origins `length` apart */
    DMB_JOINT_FREE = 10,          /* holds nothing: carries springs, dampers, stops, friction */
    DMB_JOINT_KNIFE_EDGE = 11,    /* nonholonomic: the origin of b does not move along y of b (no lateral slip) */
    DMB_JOINT_ROLLING = 12,       /* a rim of radius `length` about x of b rolls without slip on the plane y, z of a; it
                                     stands on the side x > 0 */
    DMB_JOINT_TRANSLATIONAL = 13, /* X, Y, Z free: b does not turn against a */
    DMB_JOINT_CROSS_SLIDE = 14,   /* Y, Z free: two slides across each other */
    DMB_JOINT_SCHOENFLIES = 15    /* X, Y, Z, RX free: x of b stays parallel to x of a */
};
enum {
    DMB_JOINT_ACTIVE = 0, /* constrains as its kind says */
    DMB_JOINT_LOCKED = 1, /* holds all six coordinates where they were when it was locked */
    DMB_JOINT_OPEN = 2    /* holds nothing; its springs, dampers, stops and friction do not act */
};
typedef struct dmb_joint_def {
    uint32_t struct_size;
    int32_t kind;          /* DMB_JOINT_..., default DMB_JOINT_FIXED */
    char name[24];         /* for messages and look-up (names.h), ends with 0; default "" */
    dmb_place place_a;     /* node of a string (pipe end, element end), a body or a bit; part {0, 0}: the ground */
    dmb_place place_b;     /* node, body or bit as place_a, not the ground */
    double origin_a[3];    /* [m] of frame a, in the frame of place a (ground: world); default 0, shape (3) */
    double axis_a[3];      /* [-] its x axis, any length > 0; default (1, 0, 0), shape (3) */
    double normal_a[3];    /* [-] its y axis, made perpendicular to x; 0 (default): y of the place's frame, or z if x
                              is along that; shape (3) */
    double origin_b[3];    /* [m] of frame b, in the frame of place b, shape (3) */
    double axis_b[3];      /* [-] shape (3) */
    double normal_b[3];    /* [-] shape (3) */
    int32_t match;         /* 1: frame b is where frame a is at time 0 as described, and origin_b, axis_b, normal_b
                              are ignored; 0 (default): frame b as given */
    int32_t state;         /* DMB_JOINT_... at time 0; default DMB_JOINT_ACTIVE */
    double length;         /* [m] of DISTANCE, radius of ROLLING; > 0; default 1 */
    double stiffness[6];   /* [N/m, N m/rad] of springs along the coordinates, >= 0; default 0, shape (6) */
    double damping[6];     /* [N s/m, N m s] >= 0; not there without DMB_FEATURE_DAMPING; default 0, shape (6) */
    double rest[6];        /* [m, rad] where the springs are unstressed; default 0, shape (6) */
    double friction[6];    /* [N, N m] friction that does not depend on the reaction, >= 0; not there without
                              DMB_FEATURE_FRICTION; default 0, shape (6) */
    double friction_speed; /* [m/s, rad/s] over which friction is smoothed, f s/sqrt(s^2 + friction_speed^2), > 0;
                              default 1e-3 */
    double stop_low[6];    /* [m, rad] default -1e30, shape (6) */
    double stop_high[6];   /* [m, rad] > stop_low; default 1e30, shape (6) */
    double stop_stiffness; /* [N/m, N m/rad] of the stops, > 0; default 1e6 */
    double stop_damping;   /* [N s/m, N m s] while in the stop, never pulling, >= 0; default 0 */
    int32_t initial_mask;  /* [-] coordinates that are given below, bits 1 << DMB_X ...; they must be free, and no
                              more than 6 with the joint's equations: 5 of KNIFE_EDGE and DISTANCE, 3 of ROLLING,
                              none of a joint described locked; of one described open they count all the same;
                              default 0 */
    int32_t reserved;
    double initial_position[6]; /* [m, rad] at time 0, shape (6) */
    double initial_speed[6];    /* [m/s, rad/s] at time 0, shape (6) */
} dmb_joint_def;
DMB_SIZED_STRUCT(dmb_joint_def)
/* Adds a joint. Errors: DMB_ERR_ID; DMB_ERR_VALUE for a part joined to itself, an axis of zero length, two grounds. */
DMB_API int32_t dmb_model_add_joint(dmb_model *model, const dmb_joint_def *def, dmb_id *joint);

/* Two to four joint coordinates that go together: coordinate 0 - ratio * coordinate 1 keeps its value of time 0. Gear:
 * two revolutes; screw: X and RX of one cylindrical joint, ratio = lead/(2 pi). A third and a fourth one go off too,
 * each with its ratio. Differential: cage - 0.5 left - 0.5 right; planetary gear: carrier, sun, ring; tackle: ropes. */
typedef struct dmb_coupling_def {
    uint32_t struct_size;
    int32_t reserved;
    char name[24];                             /* for messages and look-up (names.h), ends with 0; default "" */
    dmb_id joint[2];                           /* may be the same */
    int32_t component[2];                      /* DMB_X .. DMB_RZ, free in its joint; default DMB_RX */
    double ratio;                              /* [-, m/rad, rad/m] not 0; default 1 */
    dmb_id third_joint;                        /* {0, 0} (default): two coordinates */
    dmb_id fourth_joint;                       /* {0, 0} (default): none */
    int32_t third_component, fourth_component; /* DMB_X .. DMB_RZ, free in its joint; default DMB_RX */
    double third_ratio, fourth_ratio;          /* [-, m/rad, rad/m] not 0; default 1 */
} dmb_coupling_def;
DMB_SIZED_STRUCT(dmb_coupling_def)
DMB_API int32_t dmb_model_add_coupling(dmb_model *model, const dmb_coupling_def *def, dmb_id *coupling);

/* The caller's constraint on the poses of `place_count` places. poses[i]: position [m] in the world (3), rotation
 * matrix from the place's frame to the world, row-major (9). DMB_CONSTRAINT_HOLONOMIC: value = C(q, t), jacobian = dC
 * by body-frame displacements (translation; rotation) of the places; DMB_CONSTRAINT_NONHOLONOMIC: A(q, t) v + b(q, t) =
 * 0 with value = b and jacobian = A, v the body-frame velocities. Must write value; jacobian is not NULL and must be
 * written where `provides` says so. Returns 0, or nonzero to stop. Pure: same values for the same poses and time, from
 * any thread; it is also called at poses and times near those of the run, for differences. */
enum { DMB_CONSTRAINT_HOLONOMIC = 0, DMB_CONSTRAINT_NONHOLONOMIC = 1 };
enum { DMB_PROVIDES_JACOBIAN = 1 };
typedef int32_t (*dmb_constraint_fn)(void *context, double time, uint32_t place_count, const double (*poses)[12],
                                     double *value /* (row_count) */,
                                     double *jacobian /* (row_count, 6 place_count), row-major */);
typedef struct dmb_constraint_def {
    uint32_t struct_size;
    int32_t kind;         /* DMB_CONSTRAINT_..., default DMB_CONSTRAINT_HOLONOMIC */
    char name[24];        /* for messages and look-up (names.h), ends with 0; default "" */
    uint32_t row_count;   /* [-] equations, 1 .. 6; default 1 */
    uint32_t place_count; /* [-] 1 .. 4; default 1 */
    dmb_place place[4];   /* as of a joint, not the ground, shape (place_count) */
    int32_t provides;     /* DMB_PROVIDES_JACOBIAN or 0 (default): built by differences. Nonholonomic must provide it.
                             A Jacobian of its own is compared with differences when a sim is made:
                             DMB_ERR_CALLBACK */
    int32_t reserved;
    dmb_constraint_fn callback; /* required */
    void *callback_context;
} dmb_constraint_def;
DMB_SIZED_STRUCT(dmb_constraint_def)
DMB_API int32_t dmb_model_add_constraint(dmb_model *model, const dmb_constraint_def *def, dmb_id *constraint);

DMB_C_END
#endif
