/* libdrillmbd - torque and drag: forces and torque at the rig that move a string steadily in its hole, at any depth.
 * The soft string of Johancsik, Friesen, Dawson 1984 in three dimensions: weight, wall and axial force in balance, no
 * bending stiffness, full friction against the motion. For the stiff string ask dmb_analysis_static with slip_axial and
 * slip_rotation. Pressures of circulation and tripping. Fatigue of places during a run. */
#ifndef DRILLMBD_DRILLING_H
#define DRILLMBD_DRILLING_H

#include "sim.h"

DMB_C_BEGIN

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
    double friction; /* [-] coefficient of all the hole, 0 .. 10; -1 (default): the wall's mu_dynamic at each depth */
    const double *depths; /* [m] measured depths of the string's far end, shape (depth_count), beyond its start_depth by
                             at most its length; NULL: one, where it ends as described */
    uint32_t depth_count; /* [-] 1 .. 2^20; default 1 */
    int32_t friction_by_depth; /* of dmb_analysis_friction_factor: 0 (default): it finds one coefficient for all the
                                  hole; 1: the factor on the wall's mu_dynamic at each depth (hole.h) */
} dmb_torque_drag_options;
DMB_SIZED_STRUCT(dmb_torque_drag_options)

typedef struct dmb_torque_drag_row {
    uint32_t struct_size;
    int32_t locked;      /* 1: compression exceeds 1 % of EA below the rig: no push at the rig does this; hook load,
                            torque and the values along the string are NaN */
    double depth;        /* [m] measured depth of the far end */
    double hook_load;    /* [N] effective axial force at the rig end, > 0: the rig pulls, < 0: it pushes */
    double torque;       /* [N m] at the rig end, against friction and bit */
    double transfer;     /* [-] share of a little more push at the rig that arrives at the bit; 1 without friction */
    double lowest_force; /* [N] least effective axial force; most compressed where < 0 */
    double lowest_at;    /* [m] measured depth where */
    double sinusoidal_share; /* [-] largest share of the load of sinusoidal buckling, as of a profile; NaN where a
                                compressed part is not pressed to the wall */
    double helical_share;    /* [-] the same of helical buckling */
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

/* One row for each depth and operation, shape (depth_count, operation_count), the struct_size of the first holds for
 * all. The string hangs together with its described pipes counted from the far end: at a depth less than where it is
 * described the first pipes are not there yet. Bodies and bits at the far end weigh as described. Ends and places
 * beyond the survey lie on the straight continuation. Mud that flows pulls and thrusts by the diameters at each depth;
 * pressures are left out of yield_share. Of the sim only the model is used; it does not change. Errors:
 * DMB_ERR_UNSUPPORTED without a hole, for a string that does not follow it, has stabilisers, or below its rig end a
 * joint that holds something (not DMB_JOINT_FREE), a load, spring or force, or a place described stuck; DMB_ERR_VALUE,
 * _NOT_FINITE, _ID, _CANCELLED; rows are not written then. O(depths x operations x (pipes' runs + stations + length / 2
 * m)). */
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
/* The friction coefficient, 0 .. 10 (or factor, friction_by_depth), that explains a hook load [N] or torque [N m]
 * measured at the rig in one operation at the first of the depths. DMB_ERR_VALUE where none does: the message states
 * the range. About 60 times the work of a row. */
DMB_API int32_t dmb_analysis_friction_factor(dmb_sim *sim, const dmb_torque_drag_options *options,
                                             const dmb_operation *operation, int32_t measured, double value,
                                             double *friction);

/* ---- Hydraulics -------------------------------------------------------------------------------------------------- */
typedef struct dmb_hydraulics {
    uint32_t struct_size;
    uint32_t reserved;
    double depth;               /* [m] measured depth of the string's far end */
    double vertical_depth;      /* [m] of it below the start of the string, along gravity; < 0 above it */
    double bore_loss;           /* [Pa] down the string at the flow_rate, by friction */
    double bit_loss;            /* [Pa] through nozzle_area */
    double annulus_loss;        /* [Pa] up the annulus, by friction */
    double pump_pressure;       /* [Pa] sum of the three and of the difference of the columns; motors are left out */
    double circulating_density; /* [kg/m3] fluid_density + annulus_loss/(g vertical_depth); NaN if that is <= 0 */
    double trip_pressure;       /* [Pa] of the closed string at the trip speed, more going in, less coming out */
    double surge_density;       /* [kg/m3] fluid_density + trip_pressure/(g vertical_depth); NaN if that is <= 0 */
    double swab_density;        /* [kg/m3] fluid_density - trip_pressure/(g vertical_depth); NaN if that is <= 0 */
    double reynolds;            /* [-] largest of bore, annulus and trip */
} dmb_hydraulics;
DMB_SIZED_STRUCT(dmb_hydraulics)
/* Pressures of the mud of the environment with the string's far end at a measured depth [m], beyond its start_depth by
 * at most its length, in steady flow, without gel strength (Burkhardt 1961); trip speeds 0 .. 10 m/s. Errors:
 * DMB_ERR_UNSUPPORTED without a flow_rate, DMB_ERR_VALUE, _NOT_FINITE, _NULL, _STRUCT_SIZE. O(length / 2 m). */
DMB_API int32_t dmb_analysis_hydraulics(dmb_sim *sim, double depth, double trip_speed, dmb_hydraulics *answer);

/* ---- Fatigue -----------------------------------------------------------------------------------------------------
 * Axial stress at points of the outer surface, N_e/A + M r/I by the diameters, which turn with the pipe; counted by the
 * rainflow method in memory that does not grow, and summed to a damage (Palmgren 1924; Miner 1945) by the S-N curve
 * N = curve_cycles (S/curve_stress)^-slope of the stress amplitude S, half a cycle's range. Turning points are
 * distinguished by `classes` levels, which ranges are compared by too; a cycle counts with the stress at its own. */
typedef struct dmb_fatigue dmb_fatigue;
typedef struct dmb_fatigue_options {
    uint32_t struct_size;
    uint32_t classes; /* [-] levels of stress, 8 .. 65536; default 1024 */
    uint32_t points;  /* [-] points around a section, 2 .. 360, the first on its y axis; default 8 */
    uint32_t reserved;
    double stress_range;     /* [Pa] levels spread over -stress_range .. stress_range, > 0; default 1e9 */
    double concentration;    /* [-] factor on the stress, >= 1; default 1 */
    double curve_stress;     /* [Pa] amplitude that is borne for curve_cycles, > 0; the user's, no default */
    double curve_cycles;     /* [-] > 0; default 1e6 */
    double slope;            /* [-] 1 .. 50; the user's, no default */
    double endurance;        /* [Pa] amplitudes up to this do no damage, >= 0; default 0 */
    double tensile_strength; /* [Pa] of Goodman's rule, S/(1 - mean/tensile_strength) for a mean above 0; 0 (default):
                                the mean does not count */
} dmb_fatigue_options;
DMB_SIZED_STRUCT(dmb_fatigue_options)

typedef struct dmb_fatigue_result {
    uint32_t struct_size;
    uint32_t point;   /* [-] the point of the section with the largest damage, or else the largest range */
    uint64_t samples; /* [-] */
    uint64_t clipped; /* [-] of them beyond stress_range, at any point: cycles wholly beyond it are missed */
    double damage;    /* [-] 1: the S-N curve is reached; cycles that are not closed count half; INFINITY where the mean
                         stress of a cycle reaches tensile_strength: the section breaks at once */
    double cycles;    /* [-] at that point, halves included */
    double largest_range; /* [Pa] of them */
    double lowest;        /* [Pa] stress at that point, concentration included */
    double highest;       /* [Pa] highest stress there */
    double time;          /* [s] between the first and the last sample */
    double life;          /* [s] time until damage 1 at this rate; INFINITY without damage, 0 with an infinite one */
} dmb_fatigue_result;
DMB_SIZED_STRUCT(dmb_fatigue_result)

/* Places on flexible or axial-torsional pipes, place_count 1 .. 65536; memory from the model's allocator, about 24
 * bytes a class and point. Errors: DMB_ERR_VALUE (dmb_sim_message says why), _NOT_FINITE, _ID, _UNSUPPORTED (rigid
 * pipes; axial-torsional ones in a hole that bends), _NO_MEMORY; *fatigue is NULL then. */
DMB_API int32_t dmb_fatigue_create(dmb_sim *sim, const dmb_fatigue_options *options, const dmb_place *places,
                                   uint32_t place_count, dmb_fatigue **fatigue);
/* Takes a sample; call it after each step, 20 times a revolution or more: stress peaks between samples are not counted.
 * Another sim of the same model may be given. Allocates nothing. O(places x points). */
DMB_API int32_t dmb_fatigue_take(dmb_fatigue *fatigue, const dmb_sim *sim);
DMB_API int32_t dmb_fatigue_get(const dmb_fatigue *fatigue, uint32_t place, dmb_fatigue_result *result);
/* Cycles by range at the point that the result names: cycles[i] of a range of i times 2 stress_range/classes [Pa],
 * shape (classes). */
DMB_API int32_t dmb_fatigue_histogram(const dmb_fatigue *fatigue, uint32_t place, double *cycles);
/* The counts so far as bytes in the caller's memory, with which another dmb_fatigue of the same options and places
 * continues bit for bit, in another process too. Allocate nothing. Errors, which change nothing: DMB_ERR_NULL, _HANDLE,
 * _VALUE (another size; bytes that are no counts of these options). O(places x points x classes). */
DMB_API int32_t dmb_fatigue_snapshot_size(const dmb_fatigue *fatigue, size_t *size);
DMB_API int32_t dmb_fatigue_snapshot(const dmb_fatigue *fatigue, void *block, size_t size);
DMB_API int32_t dmb_fatigue_restore(dmb_fatigue *fatigue, const void *block, size_t size);
/* Sets *fatigue to NULL. NULL-safe. */
DMB_API void dmb_fatigue_destroy(dmb_fatigue **fatigue);

DMB_C_END
#endif
