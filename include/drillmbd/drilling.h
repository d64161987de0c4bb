/* libdrillmbd - torque and drag: what a string needs at the rig to be moved steadily in its hole, at any depth. The
 * soft string of Johancsik, Friesen, Dawson 1984 in three dimensions: weight, wall and axial force in balance, no
 * bending stiffness, full friction against the motion. For the stiff string ask dmb_analysis_static with slip_axial and
 * slip_rotation, and hold the two against each other. */
#ifndef DRILLMBD_DRILLING_H
#define DRILLMBD_DRILLING_H

#include "sim.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    DMB_OPERATION_PICK_UP = 0,   /* pulled without turning */
    DMB_OPERATION_SLACK_OFF = 1, /* lowered or pushed without turning */
    DMB_OPERATION_ROTATE = 2,    /* turned off bottom */
    DMB_OPERATION_DRILL = 3,     /* turned and fed, with load and torque on the bit */
    DMB_OPERATION_SLIDE = 4,     /* fed without turning the string, with load and the motor's torque on the bit */
    DMB_OPERATION_BACK_REAM = 5, /* turned and pulled */
    DMB_OPERATION_COUNT = 6
};
typedef struct dmb_operation {
    uint32_t struct_size;
    uint32_t reserved;
    double axial_speed;   /* [m/s] along the hole, > 0 into it; default 0 */
    double rotary_speed;  /* [rad/s]; friction acts along the sum of both speeds at the pipe's surface; default 0 */
    double weight_on_bit; /* [N] against the string's end, along the hole; default 0 */
    double torque_on_bit; /* [N m] >= 0, against the rotation; default 0 */
} dmb_operation;
DMB_SIZED_STRUCT(dmb_operation)
/* Usual speeds of an operation DMB_OPERATION_...: 0.1 m/s up or down, 1 rev/s, fed by 0.005 m/s while drilling; loads
 * on the bit 0, to be filled in. Errors: DMB_ERR_NULL, _STRUCT_SIZE, _VALUE. */
DMB_API int32_t dmb_operation_usual(int32_t operation, dmb_operation *out);
/* "pick-up", "slack-off", ...; NULL for a number that is none. */
DMB_API const char *dmb_operation_name(int32_t operation);

typedef struct dmb_torque_drag_options {
    uint32_t struct_size;
    int32_t post_buckling; /* 1 (default): a helix presses r F^2/(4 EI) per metre more on the wall (Mitchell 1986) where
                              the compression F is above the load of helical buckling; 0: not */
    dmb_id string;         /* {0, 0}: the model's first string */
    double friction;       /* [-] coefficient of all the hole, 0 .. 10; -1 (default): the wall's mu_dynamic */
    const double *depths; /* [m] measured depths of the string's far end, shape (depth_count), beyond its start_depth by
                             at most its length; NULL: one, where it ends as described */
    uint32_t depth_count; /* [-] 1 .. 2^20; default 1 */
    uint32_t reserved;
} dmb_torque_drag_options;
DMB_SIZED_STRUCT(dmb_torque_drag_options)

typedef struct dmb_torque_drag_row {
    uint32_t struct_size;
    int32_t locked;      /* 1: compression grows beyond 1 % of EA on the way up: no push at the rig does this; hook
                            load, torque and what is looked for along the string are NaN */
    double depth;        /* [m] measured depth of the far end */
    double hook_load;    /* [N] effective axial force at the rig end, > 0: the rig pulls, < 0: it pushes */
    double torque;       /* [N m] at the rig end, against friction and bit */
    double transfer;     /* [-] share of a little more push at the rig that arrives at the bit; 1 without friction */
    double lowest_force; /* [N] least effective axial force; most compressed where < 0 */
    double lowest_at;    /* [m] measured depth where */
    double sinusoidal_share; /* [-] largest share of the load of sinusoidal buckling, as of a profile */
    double helical_share;    /* [-] likewise of helical buckling */
    double buckled_at;       /* [m] measured depth where that is */
    double helix_length;     /* [m] of string above the load of helical buckling */
    double yield_share;      /* [-] largest von Mises stress over yield_strength, bending to the hole's curvature
                                included; NaN where a pipe has no yield_strength */
    double yield_at;         /* [m] measured depth where */
    double stretch;          /* [m] by the effective force, > 0 longer */
    double wind_up;          /* [rad] of the rig end against the bit */
    double wall_force;       /* [N] sum over the string */
} dmb_torque_drag_row;
DMB_SIZED_STRUCT(dmb_torque_drag_row)

/* One row for each depth and operation, shape (depth_count, operation_count), the size of each what the first says. The
 * string hangs together with its described pipes counted from the far end: at a depth less than where it is described
 * the first pipes are not there yet. Bodies and bits at the far end weigh as described. Ends and places beyond the
 * survey lie on the straight continuation. The sim is asked for its model only and does not change.
 * Errors: DMB_ERR_UNSUPPORTED without a hole or for a string that does not follow it, DMB_ERR_VALUE, _NOT_FINITE, _ID,
 * _CANCELLED; rows are not written then. O(depths x operations x (pipes' runs + stations + length / 2 m)). */
DMB_API int32_t dmb_analysis_torque_drag(dmb_sim *sim, const dmb_torque_drag_options *options,
                                         const dmb_operation *operations, uint32_t operation_count,
                                         dmb_torque_drag_row *rows);

/* Along the string in one operation at the first of the depths: at station_count (2 .. 2^20) places spread evenly from
 * the rig end to the far end. Arrays of shape (station_count), each may be NULL: measured depth [m], effective axial
 * force [N], torque [N m], wall force per metre [N/m]. Errors as above; DMB_ERR_NO_CONVERGENCE where the string locks
 * up. */
DMB_API int32_t dmb_analysis_torque_drag_profile(dmb_sim *sim, const dmb_torque_drag_options *options,
                                                 const dmb_operation *operation, uint32_t station_count, double *depth,
                                                 double *axial_force, double *torque, double *wall_force);

enum { DMB_MEASURED_HOOK_LOAD = 0, DMB_MEASURED_TORQUE = 1 };
/* The friction coefficient, 0 .. 10, that explains a hook load [N] or torque [N m] measured at the rig in one operation
 * at the first of the depths. DMB_ERR_VALUE where none does: the message tells the range. About 60 times the work of a
 * row. */
DMB_API int32_t dmb_analysis_friction_factor(dmb_sim *sim, const dmb_torque_drag_options *options,
                                             const dmb_operation *operation, int32_t measured, double value,
                                             double *friction);

#ifdef __cplusplus
}
#endif
#endif
