/* A co-simulation unit of a scene: what fmi2.c and fmi3.c have in common. Each instance has a model and a sim of its
 * own; nothing is shared. Functions give UNIT_OK or tell the log what was refused. */
#ifndef DMB_FMI_UNIT_H
#define DMB_FMI_UNIT_H

#include "scene_file.h"

typedef enum unit_status { /* numbers of fmi2Status and fmi3Status */
                           UNIT_OK = 0,
                           UNIT_WARNING = 1,
                           UNIT_DISCARD = 2, /* refused, nothing changed */
                           UNIT_ERROR = 3
} unit_status;

/* Value references, by number of the input, output or event in the scene. */
enum {
    UNIT_TIME = 0,        /* [s] independent */
    UNIT_STEP = 1,        /* [s] fixed parameter: steps within a communication step; 0: chosen by the library */
    UNIT_INPUTS = 100000, /* tunable parameters among them */
    UNIT_OUTPUTS = 200000,
    UNIT_EVENTS = 300000, /* integers: how often an event was told */
    UNIT_END = 400000
};

typedef enum unit_mode {
    UNIT_INSTANTIATED = 0,
    UNIT_INITIALISING = 1,
    UNIT_AT_EVENT = 2,
    UNIT_STEPPING = 3,
    UNIT_TERMINATED = 4,
    UNIT_FAILED = 5, /* the start failed: only reset, a state that was saved before, or the end of the unit */
    UNIT_MODES = 6
} unit_mode;

typedef void (*unit_log_fn)(void *context, unit_status status, const char *category, const char *text);

typedef struct unit {
    scene_file scene;
    dmb_sim *sim; /* NULL before it is asked for */
    unit_mode mode;
    double step;                       /* [s] UNIT_STEP */
    uint32_t input_count, event_count; /* [-] */
    dmb_input_info *inputs;            /* shape (input_count) */
    double *values;                /* [unit of the input] what was set before there was a sim, shape (input_count) */
    uint32_t *is_set;              /* [-] 1 where it was, shape (input_count) */
    uint32_t told[DMB_EVENTS_MAX]; /* [-] UNIT_EVENTS, shape (event_count) */
    unit_log_fn log;
    void *log_context;
    int logs; /* 1: notes and warnings go to the log too */
} unit;

/* folder: where scene.bin is. NULL where it is refused, the log knows why. */
unit *unit_create(const char *folder, const char *token, unit_log_fn log, void *log_context, int logs);
void unit_destroy(unit *u);
#if defined(__MINGW32__) && !defined(__clang__) /* there "printf" is the one of the system, which has no %zu */
#define UNIT_PRINTF_LIKE __attribute__((format(gnu_printf, 3, 4)))
#elif defined(__GNUC__)
#define UNIT_PRINTF_LIKE __attribute__((format(printf, 3, 4)))
#else
#define UNIT_PRINTF_LIKE
#endif
/* Tells the log; gives `status` back. */
unit_status unit_tell(const unit *u, unit_status status, const char *format, ...) UNIT_PRINTF_LIKE;
/* UNIT_OK in one of the modes (mask of 1 << unit_mode). */
unit_status unit_require(const unit *u, unsigned modes, const char *call);

/* [-] 1: a value reference of the unit's inputs, tunable parameters among them; of its outputs. */
int unit_has_input(const unit *u, uint32_t reference);
int unit_has_output(const unit *u, uint32_t reference);
/* [-] 1: an input, which moves the run from time 0 on; 0: a tunable parameter. As CONTROLLED of drillmbd/fmu.py. */
int unit_input_is_controlled(const dmb_input_info *input);
unit_status unit_get(unit *u, const uint32_t *references, size_t count, double *values);
unit_status unit_get_counts(unit *u, const uint32_t *references, size_t count, int32_t *values);
unit_status unit_set(unit *u, const uint32_t *references, size_t count, const double *values);

/* sensitivity = derivatives of the outputs `unknowns` by the inputs `knowns`, times seed, shape (known_count), at the
 * present time with the state held; shape (unknown_count). Nothing is changed. */
unit_status unit_derivative(unit *u, const uint32_t *unknowns, size_t unknown_count, const uint32_t *knowns,
                            size_t known_count, const double *seed, double *sensitivity);

unit_status unit_begin(unit *u, double start); /* initialization mode */
unit_status unit_prepare(unit *u); /* makes the sim at time 0, where it is not there; UNIT_FAILED if it cannot */
unit_status unit_reset(unit *u);

typedef struct unit_reached {
    double time;  /* [s] */
    int at_event; /* [-] 1: an event was told at this time */
} unit_reached;
/* From `time`, where the unit must be, on by `length` [s]; stops_early: at the first event. */
unit_status unit_advance(unit *u, double time, double length, int stops_early, unit_reached *reached);

/* All that changes, as bytes: the functions for states of FMI 2.0 and 3.0. A state belongs to its caller until
 * unit_state_free. Bytes that are none of this unit are refused, and nothing changes. u may be NULL: UNIT_ERROR. */
unit_status unit_state_get(unit *u, void **state); /* one that was there is replaced */
unit_status unit_state_set(unit *u, const void *state);
unit_status unit_state_free(const unit *u, void **state);
unit_status unit_state_size(const unit *u, const void *state, size_t *size);
unit_status unit_state_write(const unit *u, const void *state, void *bytes, size_t size);
unit_status unit_state_read(const unit *u, const void *bytes, size_t size, void **state);

#endif
