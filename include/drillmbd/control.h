/* libdrillmbd - inputs that a controller or an operator moves while a scene runs, set between steps of each sim
 * without compiling again, and events at which a run stops. */
#ifndef DRILLMBD_CONTROL_H
#define DRILLMBD_CONTROL_H

#include "output.h"

DMB_C_BEGIN
/* clang-format off */
enum { /* quantity that an input sets; 1 .. 4 are of CONTROL drives, 7 .. 11, 14 of wall and environment, >= 0 */
    DMB_TARGET_SET_POINT = 0, /* of a drive, instead of its time function; its excitation continues */
    DMB_TARGET_GAIN = 1, DMB_TARGET_INTEGRAL_GAIN = 2, /* [N s/m, N m s], [N/m, N m] >= 0 */
    DMB_TARGET_LIMIT_LOW = 3, DMB_TARGET_LIMIT_HIGH = 4, /* [N, N m] the first below the second */
    DMB_TARGET_LOAD_FACTOR = 5, DMB_TARGET_BIT_LOAD = 6, /* [-] of a load, [N] of a bit, replaces its time function */
    DMB_TARGET_FRICTION = 7, DMB_TARGET_FLUID_DENSITY = 8, /* [-] factor of both coefficients of the wall, [kg/m3] */
    DMB_TARGET_LATERAL_DAMPING = 9, DMB_TARGET_AXIAL_DAMPING = 10, /* [N s/m2] */
    DMB_TARGET_TORSIONAL_DAMPING = 11, /* [N s] */
    DMB_TARGET_STUCK = 12, /* [-] 1: a place is stuck from now on, 0: it is free (bha.h) */
    DMB_TARGET_COUNT = 13, /* of the targets above, for programs that were built before others were added */
    DMB_TARGET_FLOW_RATE = 14 /* [m3/s] of mud, >= 0; all that flow needs of string, hole and mud must be there */
};
/* clang-format on */
/* Joint states (active, locked, open) are no inputs: dmb_sim_set_joint changes speeds by an impulse and may fail for
 * states that do not fit, while an input is a number that is set or clamped, and is in force as long as its sim exists.
 * A log replays a run with switches when the program repeats these calls at the same times, between its
 * dmb_sim_replay_inputs and its step. A place that is fixed and released by an input is DMB_TARGET_STUCK. */
enum { DMB_OUTSIDE_REFUSED = 0, DMB_OUTSIDE_CLAMPED = 1 };
typedef struct dmb_input_def {
    uint32_t struct_size;
    int32_t target;    /* DMB_TARGET_..., default DMB_TARGET_SET_POINT */
    char name[24];     /* required, unique among the inputs, ends with 0 */
    dmb_id part;       /* drive, load, bit or stuck place; {0, 0} of wall and environment */
    double initial;    /* [unit of the target] at time 0, within the bounds; NaN (default): as described, which for 0, 5
                          and 6 is the time function, until the input is set */
    double low, high;  /* [unit of the target] bounds, low <= high; default -1e30 and 1e30: as far as the target goes */
    double rate_limit; /* [unit/s] of 0, 5, 6: the most it changes in a second, > 0; 0 (default): it jumps. Required for
                          the set point of a MOTION drive: largest acceleration */
    double slope_limit; /* [unit/s2] the most that rate changes in a second, > 0 (largest jerk); 0 (default): it jumps.
                           The value then reaches the set point in the least time that both limits allow */
    int32_t outside;    /* DMB_OUTSIDE_...: a value beyond the bounds is refused (default) or taken for the bound */
    int32_t reserved;
} dmb_input_def;
DMB_SIZED_STRUCT(dmb_input_def)
/* Errors: DMB_ERR_ID; DMB_ERR_VALUE for bounds, limits, a name that another input has, a target that has one already;
 * DMB_ERR_UNSUPPORTED where the part has no such target. */
DMB_API int32_t dmb_model_add_input(dmb_model *model, const dmb_input_def *def, dmb_id *input);
typedef struct dmb_input_info {
    uint32_t struct_size;
    int32_t target;                            /* DMB_TARGET_... */
    dmb_id input, part;                        /* its own id, and the part it acts on */
    char name[24];                             /* ends with 0 */
    char unit[16];                             /* "rad/s", "-", ... ends with 0 */
    double low, high, rate_limit, slope_limit; /* bounds in force: the narrower of its own and those of the target */
} dmb_input_info;
DMB_SIZED_STRUCT(dmb_input_info)
/* [-] inputs described so far; 0 for a bad handle. Number `index` in that order, by name: DMB_ERR_ID for none. */
DMB_API uint32_t dmb_model_input_count(const dmb_model *model);
DMB_API int32_t dmb_model_get_input(const dmb_model *model, uint32_t index, dmb_input_info *info);
DMB_API int32_t dmb_model_find_input(const dmb_model *model, const char *name, dmb_id *input);
/* From now on the inputs, shape (count), have these values, or go there within their limits; all or none; accelerations
 * are adapted to jumps. A change of density changes the energy of weight, which counts as work of loads.
 * DMB_NOTE_CLAMPED where a bound was taken instead. Setting a value again does nothing. Errors, which change
 * nothing: DMB_ERR_ID, _NOT_FINITE, _VALUE (bounds; limits of a drive), _CALLBACK, _SINGULAR. O(elements). */
DMB_API int32_t dmb_sim_set_input(dmb_sim *sim, dmb_id input, double value);
DMB_API int32_t dmb_sim_set_inputs(dmb_sim *sim, const dmb_id *inputs, const double *values, uint32_t count);
typedef struct dmb_input_state {
    uint32_t struct_size;
    int32_t is_set;       /* 0: its time function is in force, since it was not set yet */
    double value;         /* [unit] set point; of a time function its value now */
    double present, rate; /* [unit, unit/s] in force now, changing towards `value` */
    double arrives;       /* [s] time at which it is or was there; 0 of a time function */
} dmb_input_state;
DMB_SIZED_STRUCT(dmb_input_state)
DMB_API int32_t dmb_sim_get_input(const dmb_sim *sim, dmb_id input, dmb_input_state *state);
/* Frozen. One line of the log of inputs. */
typedef struct dmb_input_record {
    double time, value; /* [s] of the sim, [unit of the input] as taken, clamped where it was */
    uint32_t input;     /* [-] number of the input in the order of description */
    uint32_t call;      /* [-] number of the call that set it: those of one call are set at once */
} dmb_input_record;
/* From now on set points go into `records`, shape (capacity), which the caller keeps alive; NULL with 0: no more. A
 * call beyond the capacity still sets its value: DMB_NOTE_FULL. The log is neither saved in snapshots nor hashed. */
DMB_API int32_t dmb_sim_record_inputs(dmb_sim *sim, dmb_input_record *records, uint32_t capacity);
DMB_API uint32_t dmb_sim_recorded_inputs(const dmb_sim *sim); /* [-] since then; 0 for a handle of no sim */
/* Sets the values of the log from record *next on up to the present time, call by call, and moves *next beyond them.
 * Called before each step of a run that steps as the recorded one did, it gives the same states, bit for bit. Errors:
 * as dmb_sim_set_inputs, with *next at the call that was refused; DMB_ERR_VALUE too for times that decrease. */
DMB_API int32_t dmb_sim_replay_inputs(dmb_sim *sim, const dmb_input_record *records, uint32_t count, uint32_t *next);
/* An event is an output that crosses a level, evaluated at the ends of steps: a crossing and return within one step
 * is missed. It is located by steps really taken to it, so the state lies on it: at most `tolerance` in time
 * beyond the first crossing, on the far side of the level. From one side to the other (a start on the level is on
 * neither); to above it, from it or from below; to below. */
enum { DMB_EVENT_EITHER = 0, DMB_EVENT_RISING = 1, DMB_EVENT_FALLING = 2, DMB_EVENTS_MAX = 64 };
typedef struct dmb_event_def {
    uint32_t struct_size;
    int32_t direction; /* DMB_EVENT_..., default DMB_EVENT_RISING */
    char name[24];     /* required, unique among the events, ends with 0 */
    dmb_output output; /* as of a recorder; dmb_sim_create fails if the scene does not have it */
    double level;      /* [unit of the output] default 0 */
    double hold;       /* [s] reported when the output has stayed beyond so long, >= 0, 0 with EITHER; default 0 */
    double tolerance;  /* [s] 1e-12 .. 1, default 1e-9; no less than the rounding of time allows */
} dmb_event_def;
DMB_SIZED_STRUCT(dmb_event_def)
DMB_API int32_t dmb_model_add_event(dmb_model *model, const dmb_event_def *def, dmb_id *event);
DMB_API uint32_t dmb_model_event_count(const dmb_model *model); /* as of inputs; get: as described */
DMB_API int32_t dmb_model_get_event(const dmb_model *model, uint32_t index, dmb_event_def *event);
DMB_API int32_t dmb_model_find_event(const dmb_model *model, const char *name, dmb_id *event);
typedef struct dmb_event_report {
    uint32_t struct_size;
    uint32_t count;  /* [-] events reported: those within the tolerance of the first count as simultaneous */
    uint64_t events; /* [-] bit i: event number i in the order of description is reported */
    double time;     /* [s] reached */
    double located;  /* [s] at most so long after the crossing; 0 without an event, and where a `hold` ends */
} dmb_event_report;
DMB_SIZED_STRUCT(dmb_event_report)
/* As dmb_sim_advance, but ends at the first event: DMB_NOTE_EVENT, dmb_sim_message names those reported. One
 * that is beyond its level at the start is reported when it has come back and crosses again; a `hold` continues from
 * call to call. Costs a copy of the state a step, some six steps a crossing. Reports may be NULL.
 * DMB_ERR_VALUE: no events. */
DMB_API int32_t dmb_sim_advance_to_event(dmb_sim *sim, double time, dmb_event_report *event, dmb_step_report *report);

DMB_C_END
#endif
