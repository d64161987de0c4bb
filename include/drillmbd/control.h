/* libdrillmbd - what a controller or an operator moves while a scene runs. Described with the model, set between steps
 * of each sim by itself: the compiled scene that sims share never changes, and one without inputs pays nothing. */
#ifndef DRILLMBD_CONTROL_H
#define DRILLMBD_CONTROL_H

#include "output.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Inputs ------------------------------------------------------------------------------------------------------ */
enum {
    DMB_TARGET_SET_POINT = 0,          /* of a drive: the value in the place of its programme; its excitation goes on */
    DMB_TARGET_GAIN = 1,               /* [N s/m, N m s] of a CONTROL drive, >= 0 */
    DMB_TARGET_INTEGRAL_GAIN = 2,      /* [N/m, N m] of a CONTROL drive, >= 0 */
    DMB_TARGET_LIMIT_LOW = 3,          /* [N, N m] of a CONTROL drive; below its limit_high */
    DMB_TARGET_LIMIT_HIGH = 4,         /* [N, N m] of a CONTROL drive; above its limit_low */
    DMB_TARGET_LOAD_FACTOR = 5,        /* [-] of a load, in the place of its programme */
    DMB_TARGET_BIT_LOAD = 6,           /* [N] bottom-hole load of a bit, in the place of its programme */
    DMB_TARGET_FRICTION = 7,           /* [-] factor >= 0 of both friction coefficients of the wall; 1: as described */
    DMB_TARGET_FLUID_DENSITY = 8,      /* [kg/m3] >= 0 of the environment */
    DMB_TARGET_LATERAL_DAMPING = 9,    /* [N s/m2] >= 0 of the environment */
    DMB_TARGET_AXIAL_DAMPING = 10,     /* [N s/m2] >= 0 of the environment */
    DMB_TARGET_TORSIONAL_DAMPING = 11, /* [N s] >= 0 of the environment */
    DMB_TARGET_COUNT = 12
};
enum { DMB_OUTSIDE_REFUSED = 0, DMB_OUTSIDE_CLAMPED = 1 };
typedef struct dmb_input_def {
    uint32_t struct_size;
    int32_t target;    /* DMB_TARGET_..., default DMB_TARGET_SET_POINT */
    char name[24];     /* required, of its own among the inputs, ends with 0 */
    dmb_id part;       /* drive, load or bit; {0, 0} of wall and environment */
    double initial;    /* [unit of the target] at time 0, within the bounds; NaN (default): as described, which for a
                          set point, load factor and bit load is its programme, until the input is set */
    double low, high;  /* [unit of the target] bounds, low <= high; default -1e30 and 1e30: as far as the target goes */
    double rate_limit; /* [unit/s] of a set point, load factor or bit load: the most it changes in a second, > 0; 0
                          (default): it jumps. Required for the set point of a MOTION drive: largest acceleration */
    double slope_limit; /* [unit/s2] the most that rate changes in a second, > 0 (largest jerk); 0 (default): it jumps.
                           The value then gets to what is set in the least time that both limits allow */
    int32_t outside;    /* DMB_OUTSIDE_...: a value beyond the bounds is refused (default) or taken for the bound */
    int32_t reserved;
} dmb_input_def;
DMB_SIZED_STRUCT(dmb_input_def)
/* Errors: DMB_ERR_ID; DMB_ERR_VALUE for bounds, limits, a name that another input has, a target that has one already;
 * DMB_ERR_UNSUPPORTED where the part has no such target. */
DMB_API int32_t dmb_model_add_input(dmb_model *model, const dmb_input_def *def, dmb_id *input);

typedef struct dmb_input_info {
    uint32_t struct_size;
    int32_t target; /* DMB_TARGET_... */
    dmb_id input;
    dmb_id part;
    char name[24];
    char unit[16];                  /* "rad/s", "-", ... ends with 0 */
    double low, high;               /* [unit] in force: the narrower of its own bounds and those of the target */
    double rate_limit, slope_limit; /* [unit/s, unit/s2] 0: none */
} dmb_input_info;
DMB_SIZED_STRUCT(dmb_input_info)
/* [-] inputs described so far; 0 for what is no model. */
DMB_API uint32_t dmb_model_input_count(const dmb_model *model);
/* Input number `index` in the order of description. Errors: DMB_ERR_NULL, _HANDLE, _STRUCT_SIZE, _ID (no such input).
 */
DMB_API int32_t dmb_model_get_input(const dmb_model *model, uint32_t index, dmb_input_info *info);
/* The input of that name. DMB_ERR_ID where there is none. */
DMB_API int32_t dmb_model_find_input(const dmb_model *model, const char *name, dmb_id *input);

/* From now on the input is `value`, or goes there within its limits; accelerations are made to fit what jumps. A change
 * of density changes the energy of weight, which counts as work of loads. DMB_NOTE_CLAMPED where the bound was taken
 * instead. Setting what is set already does nothing. Errors, which change nothing: DMB_ERR_ID, _NOT_FINITE, _VALUE
 * (bounds; limit_low not below limit_high), _CALLBACK, _SINGULAR. O(number of elements). */
DMB_API int32_t dmb_sim_set_input(dmb_sim *sim, dmb_id input, double value);
/* Several at once, all or none, arrays of shape (count); of one named twice the last counts. */
DMB_API int32_t dmb_sim_set_inputs(dmb_sim *sim, const dmb_id *inputs, const double *values, uint32_t count);

typedef struct dmb_input_state {
    uint32_t struct_size;
    int32_t is_set; /* 0: its programme is in force, since it was not set yet */
    double value;   /* [unit] what is set; of a programme its value now */
    double present; /* [unit] in force now, on the way to `value` */
    double rate;    /* [unit/s] of it */
    double arrives; /* [s] time at which it is or was there; 0 of a programme */
} dmb_input_state;
DMB_SIZED_STRUCT(dmb_input_state)
/* Errors: DMB_ERR_NULL, _HANDLE, _STRUCT_SIZE, _ID, _CALLBACK. */
DMB_API int32_t dmb_sim_get_input(const dmb_sim *sim, dmb_id input, dmb_input_state *state);

/* ---- Input log: what was set when, in the caller's memory ---------------------------------------------------------
 */
typedef struct dmb_input_record {
    double time;    /* [s] of the sim when it was set */
    double value;   /* [unit of the input] as taken, clamped where it was */
    uint32_t input; /* [-] number of the input in the order of description */
    uint32_t call;  /* [-] number of the call that set it: those of one call are set at once */
} dmb_input_record;
/* From now on what is set is written into `records`, shape (capacity), which the caller keeps alive; from its beginning
 * on. NULL with 0: no more. A call that sets more than there is room for sets it and returns DMB_NOTE_FULL. The log is
 * neither saved in snapshots nor hashed. Errors: DMB_ERR_NULL, _HANDLE, _ORDER. */
DMB_API int32_t dmb_sim_record_inputs(dmb_sim *sim, dmb_input_record *records, uint32_t capacity);
/* [-] records written since then; 0 for what is no sim. */
DMB_API uint32_t dmb_sim_recorded_inputs(const dmb_sim *sim);
/* Sets what the log has from record *next on up to the present time, call by call, and moves *next beyond what is set.
 * Called before each step of a run that steps as the recorded one did, it gives the same states, bit for bit. Errors:
 * as dmb_sim_set_inputs, with *next at the call that was refused; DMB_ERR_VALUE too for times that decrease. */
DMB_API int32_t dmb_sim_replay_inputs(dmb_sim *sim, const dmb_input_record *records, uint32_t count, uint32_t *next);

/* ---- Events ------------------------------------------------------------------------------------------------------
 * An event is an output that crosses a level, looked for at the ends of steps: a crossing that is undone within one
 * step is not seen. The first one is located by steps really taken to it, so the state lies on it: at most `tolerance`
 * in time beyond the crossing, on the far side of the level. */
enum {
    DMB_EVENT_EITHER = 0,  /* from one side of the level to the other; a start on the level itself is on no side */
    DMB_EVENT_RISING = 1,  /* to above the level, from it or from below */
    DMB_EVENT_FALLING = 2, /* to below the level, from it or from above */
    DMB_EVENTS_MAX = 64    /* of one model */
};
typedef struct dmb_event_def {
    uint32_t struct_size;
    int32_t direction;  /* DMB_EVENT_..., default DMB_EVENT_RISING */
    char name[24];      /* required, of its own among the events, ends with 0 */
    dmb_channel output; /* as of a recorder */
    double level;       /* [unit of the output] default 0 */
    double hold;        /* [s] it is told when the output has stayed beyond the level for so long, >= 0 and 0 with
                           DMB_EVENT_EITHER; default 0 */
    double tolerance;   /* [s] 1e-12 .. 1, default 1e-9; no less than the rounding of time allows */
} dmb_event_def;
DMB_SIZED_STRUCT(dmb_event_def)
/* Errors: DMB_ERR_VALUE for fields and a name that another event has; DMB_ERR_TOO_LARGE beyond DMB_EVENTS_MAX. An
 * output that the scene does not have is refused by dmb_sim_create: the query's error. */
DMB_API int32_t dmb_model_add_event(dmb_model *model, const dmb_event_def *def, dmb_id *event);

typedef struct dmb_event_info {
    uint32_t struct_size;
    int32_t direction;
    dmb_id event;
    char name[24];
    dmb_channel output;
    double level, hold, tolerance; /* as described */
} dmb_event_info;
DMB_SIZED_STRUCT(dmb_event_info)
/* As of inputs. */
DMB_API uint32_t dmb_model_event_count(const dmb_model *model);
DMB_API int32_t dmb_model_get_event(const dmb_model *model, uint32_t index, dmb_event_info *info);
DMB_API int32_t dmb_model_find_event(const dmb_model *model, const char *name, dmb_id *event);

typedef struct dmb_event_report {
    uint32_t struct_size;
    uint32_t count;  /* [-] events told: those within the tolerance of the first count as at once with it */
    uint64_t events; /* [-] bit i: event number i in the order of description is told */
    double time;     /* [s] reached */
    double located;  /* [s] at most so long after the crossing; 0 where none is told, and where a `hold` ends */
} dmb_event_report;
DMB_SIZED_STRUCT(dmb_event_report)
/* As dmb_sim_advance, but ends at the first event on the way, DMB_NOTE_EVENT; dmb_sim_message names those told. What is
 * beyond its level when the call begins is told when it has come back and crosses again; a `hold` that began in a call
 * before goes on. Costs a copy of the state a step, and some six more steps for each crossing. Either report may be
 * NULL. Errors: as dmb_sim_advance, with the state the last accepted one, before any crossing that was not located;
 * DMB_ERR_VALUE without events. */
DMB_API int32_t dmb_sim_advance_to_event(dmb_sim *sim, double time, dmb_event_report *event, dmb_step_report *report);

#ifdef __cplusplus
}
#endif
#endif
