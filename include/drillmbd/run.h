/* libdrillmbd - simulation of a compiled scene: create, step, advance, snapshots, inputs, events. */
#ifndef DRILLMBD_RUN_H
#define DRILLMBD_RUN_H
#include "scene.h"
DMB_C_BEGIN
typedef struct dmb_sim dmb_sim; /* one simulation of a compiled scene */
/* One thread at a time. Errors of every function of this header, which change nothing: DMB_ERR_NULL, _HANDLE, _STRUCT_SIZE,
 * _VALUE, _ORDER (within a call on the sim); of ids and numbers _ID, _NOT_FINITE. Reports may be NULL. Steps, inputs and
 * snapshots allocate nothing. Further errors are listed at each function. */

enum {
    DMB_METHOD_INDEPENDENT = 0, /* the step solves for independent coordinates, found by partition */
    DMB_METHOD_MULTIPLIERS = 1 /* it solves for all coordinates and the multipliers, for comparison; not in statics */
};
typedef void (*dmb_part_fn)(void *work, uint32_t index); /* one part of the work of a step */
/* Long strings on several cores, with threads of the caller's (examples/programming, Threads; examples/two_cores). It calls
 * part(work, i) once for each i < count, in any threads and order, and returns 0 when all have returned; another value, or parts
 * left out, end the step with DMB_ERR_CALLBACK, the sim unchanged. Results have the same bits in any number of parts. */
typedef int32_t (*dmb_parallel_fn)(void *context, uint32_t count, dmb_part_fn part, void *work);
typedef struct dmb_sim_options {
    uint32_t struct_size, max_iterations; /* [-] Newton iterations of one step, 1 .. 1000; default 12 */
    const dmb_allocator *allocator; /* copied; NULL: the model's */
    dmb_log_fn log; /* NULL: silent */
    void *log_context;
    double spectral_radius; /* [-] of generalized-alpha at infinite frequency, 0 .. 1; default 0.8 */
    double newton_tolerance; /* [-] 0 (default): iterations leave a few hundredths of the step's own error at most, and a residual
        below 1e-7 of the forces' work (lib/theory/integration.md). 1e-14 .. 1e-1: they end at this residual over the norm of the
        balancing forces */
    double tolerance_translation, tolerance_rotation; /* [m; rad] local error in dmb_sim_advance, > 0; default 1e-6, 1e-5 */
    double step_min, step_max; /* [s] shortest step of dmb_sim_advance and part of a divided step, > 0; longest, > step_min;
        default 1e-9, 0.1 */
    uint32_t max_cuts; /* [-] times a step that does not converge is halved, 0 .. 30; default 12 */
    int32_t bounded_work; /* 1: dmb_sim_step does one step of at most max_iterations and accepts a finite result with
        DMB_NOTE_WORK_LIMITED unless it grows a millionfold; such a step is not divided at breakpoints, and fails if a stop or
        one-sided spring turns a body by more than a radian in it; for control loops; default 0 */
    int32_t energy_ledger; /* 1 (default): keep the energy ledger; 0: it is not computed */
    uint32_t max_steps; /* [-] accepted steps in one dmb_sim_advance, then DMB_NOTE_STOPPED; 0 (default): no bound */
    int32_t constraint_method, reserved; /* DMB_METHOD_..., algebra of joints in a step; default DMB_METHOD_INDEPENDENT */
    dmb_parallel_fn parallel; /* NULL (default): steps are made in the thread of the call alone. Not for functions of Python */
    void *parallel_context;
    uint32_t parallel_parts, parallel_least; /* [-] most parts at once, 1 .. 64 (the equations of a chain have two); elements of a
        scene from which on `parallel` is called; default 2, 1000 */
    double assembly_energy; /* [J] most that dmb_sim_create may store in flexible pipes to close joints, >= 0; default 1e-3, the
        rounding of described places. More is DMB_ERR_GEOMETRY */
} dmb_sim_options;
DMB_SIZED_STRUCT(dmb_sim_options)
/* Bytes of the block that dmb_sim_create_in needs. O(1). Errors: DMB_ERR_ORDER (model not compiled), _TOO_LARGE. */
DMB_API int32_t dmb_sim_memory_size(const dmb_model *model, const dmb_sim_options *options, size_t *size);
/* Makes a sim at time 0 in the described pose and speed, which holds the model until it is destroyed. options may be NULL. To
 * close joints, rigid bodies are moved over any distance and rotation, then strings as rigid bodies as far as their supports
 * leave them free, and only then pipes are strained (assembly_energy). DMB_NOTE_PROJECTED: initial velocities did not fit the
 * allowed motion, or joints were closed; dmb_sim_message states by how much. Errors, in dmb_model_message: DMB_ERR_ORDER (model
 * not compiled), _NO_MEMORY, _TOO_LARGE, _CALLBACK, _ROTATION, _SINGULAR, _NO_CONVERGENCE, _UNSUPPORTED, _GEOMETRY (joints that
 * cannot be closed, or only by more than assembly_energy); *sim is NULL then. O(elements). */
DMB_API int32_t dmb_sim_create(dmb_model *model, const dmb_sim_options *options, dmb_sim **sim);
/* The same in the caller's block of at least dmb_sim_memory_size bytes, any alignment; the allocator is not used. Errors as
 * dmb_sim_create; DMB_ERR_TOO_LARGE. */
DMB_API int32_t dmb_sim_create_in(dmb_model *model, const dmb_sim_options *options, void *block, size_t size, dmb_sim **sim);
/* Gives the memory back and sets *sim to NULL; does nothing within a call on this sim. NULL-safe. */
DMB_API void dmb_sim_destroy(dmb_sim **sim);
/* Message of the last call on this sim that failed or has a note; of queries, of this thread. Never NULL; until the next call. */
DMB_API const char *dmb_sim_message(const dmb_sim *sim);
DMB_API double dmb_sim_time(const dmb_sim *sim); /* [s] of the last accepted state; NaN for NULL */
/* [-] fraction, 0 .. 1, of the call that is done: never falls within a call, and is a guess where the work cannot be foreseen.
 * Returns 0, or nonzero to end the call. */
typedef int32_t (*dmb_progress_fn)(void *context, double fraction);
/* From now on dmb_sim_step, _steps, _advance and all analyses of this sim call `function` at bounded intervals
 * (examples/programming, Runs) in the thread of the call (an eigenproblem of LAPACK is one interval). Nonzero ends the call with
 * DMB_ERR_CANCELLED and nothing changed (dmb_sim_steps and dmb_analysis_stepped_sine: in the last accepted state; dmb_sim_advance
 * there with DMB_NOTE_CANCELLED). NULL (default): none. Not in snapshots and hashes. */
DMB_API int32_t dmb_sim_set_progress(dmb_sim *sim, dmb_progress_fn function, void *context);
/* Sees the sim after an accepted step; may query, record and save it, not change it. Nonzero ends the call. */
typedef int32_t (*dmb_step_fn)(void *context, const dmb_sim *sim);
/* From now on `function` is called in the thread of the call after each dmb_sim_step, each step of dmb_sim_steps and each of
 * dmb_sim_advance and _advance_to_event that is accepted for good: not parts of a divided step, nor steps that are repeated to
 * locate an event. Nonzero before the end of the call: DMB_NOTE_STOPPED. dmb_analysis_stepped_sine calls it too, and is not ended
 * by it. NULL (default): none. Not in snapshots and hashes. */
DMB_API int32_t dmb_sim_set_on_step(dmb_sim *sim, dmb_step_fn function, void *context);
typedef struct dmb_step_report {
    uint32_t struct_size, steps; /* [-] accepted integration steps in this call */
    uint32_t iterations, rejected; /* [-] Newton iterations, rejected steps included; steps tried and not accepted */
    uint32_t most_iterations, reserved; /* [-] of an accepted step */
    double time, residual; /* [s; -] reached; largest relative residual of an accepted step */
    double last_step; /* [s] length of the last accepted step */
} dmb_step_report;
DMB_SIZED_STRUCT(dmb_step_report)
/* Advances by `duration` [s], > 0 and <= 1e18, in one step of generalized-alpha (lib/theory/integration.md), divided at
 * breakpoints of time functions, and halved where Newton does not converge (DMB_NOTE_STEP_CUT). Notes too: DMB_NOTE_WORK_LIMITED.
 * Errors: DMB_ERR_NO_CONVERGENCE, _SINGULAR, _ROTATION, _GEOMETRY (a joint where its angles are not defined), _CALLBACK,
 * _NOT_FINITE, _CANCELLED; the state is then that before the call. O(elements) an iteration. */
DMB_API int32_t dmb_sim_step(dmb_sim *sim, double duration, dmb_step_report *report);
/* `count` calls of dmb_sim_step with the same duration in one, with the same bits. *done (may be NULL): [-] accepted calls. The
 * report has the sums and maxima of them all. The status is the largest note of a step, with its message, DMB_NOTE_STOPPED, or
 * the error that ended the calls, as dmb_sim_step; the state is then that after *done of them. */
DMB_API int32_t dmb_sim_steps(dmb_sim *sim, double duration, uint32_t count, uint32_t *done, dmb_step_report *report);
/* Advances to `time` [s] with steps chosen to hold the tolerances of the local error of each step, bounded_work or not. Errors of
 * steps add up over a run, to some thousand times the tolerances in 10 s: repeat it with a tenth of the tolerances to estimate
 * the error at its end. DMB_NOTE_TOLERANCE where a step of step_min was too long for them; before that DMB_NOTE_STOPPED after
 * max_steps, DMB_NOTE_CANCELLED. Errors as dmb_sim_step; the state is then the last accepted one. */
DMB_API int32_t dmb_sim_advance(dmb_sim *sim, double time, dmb_step_report *report);
/* From now on the drive's time function is the constant `value` [unit of its time function]; NaN: its time function again. For
 * DMB_DRIVE_LOAD and DMB_DRIVE_CONTROL; accelerations are made to fit the jump. DMB_ERR_UNSUPPORTED for DMB_DRIVE_MOTION, whose
 * speed may not jump, and where an input moves the set point (scene.h). */
DMB_API int32_t dmb_sim_set_drive(dmb_sim *sim, dmb_id drive, double value);
/* From now on the joint is DMB_JOINT_ACTIVE, _LOCKED (where it is) or _OPEN. Speeds that no longer fit change by the impulse of
 * least kinetic energy (DMB_NOTE_PROJECTED, the message gives the change), which goes to `impact` (examples/programming, Joints
 * and strings that change). A joint that a motion drive moves cannot be locked. Errors: DMB_ERR_GEOMETRY (parts or couplings do
 * not fit within 1e-6 m and rad; a drive's speed cannot be reached), _SINGULAR, _NO_CONVERGENCE, _CALLBACK. */
DMB_API int32_t dmb_sim_set_joint(dmb_sim *sim, dmb_id joint, int32_t state);
/* Continues from the state of `from` in a sim of another model that has pipes more or fewer at the rig end of its strings; the
 * start of its strings and its time functions may differ, all else must be of the same kind and number (DMB_ERR_VALUE names the
 * difference). examples/programming, Joints and strings that change, has the rules. Do it at rest: speeds that the supports of
 * the new rig end do not allow are projected (DMB_NOTE_PROJECTED). Errors: DMB_ERR_GEOMETRY (a joint does not fit), _SINGULAR,
 * _NO_CONVERGENCE, _ROTATION, _CALLBACK. O(elements). */
DMB_API int32_t dmb_sim_transfer_state(dmb_sim *sim, const dmb_sim *from);
/* Snapshot of all that changes: bytes, save into and restore from the caller's memory. It fits every sim of the same compiled
 * model with the same options, which continues bit for bit. Bytes that are no state of it, forged ones too, are refused
 * (DMB_ERR_VALUE, the message states field, value and bound); accepted bytes cannot lead a step out of bounds. About 0.9 kB an
 * element are factors kept from step to step (none with joints). */
DMB_API int32_t dmb_sim_snapshot_size(const dmb_sim *sim, size_t *size);
DMB_API int32_t dmb_sim_snapshot(const dmb_sim *sim, void *block, size_t size);
DMB_API int32_t dmb_sim_restore(dmb_sim *sim, const void *block, size_t size);
/* FNV-1a hash of all that changes; equal states give equal hashes on one build. */
DMB_API int32_t dmb_sim_hash(const dmb_sim *sim, uint64_t *hash);

/* ---- Inputs ----------------------------------------------------------------------------------------------------- */
/* From now on the inputs, shape (count), have these values, or approach them within their rate limits; all are set or none.
 * Accelerations are adapted to jumps. The energy of weight that a change of density adds is work of loads. Setting a value again
 * does nothing. DMB_NOTE_CLAMPED where a bound was taken instead, _FULL (log). Errors: DMB_ERR_VALUE (bounds; limits of a drive),
 * _CALLBACK, _SINGULAR, _UNSUPPORTED. O(elements). */
DMB_API int32_t dmb_sim_set_input(dmb_sim *sim, dmb_id input, double value);
DMB_API int32_t dmb_sim_set_inputs(dmb_sim *sim, const dmb_id *inputs, const double *values, uint32_t count);
typedef struct dmb_input_state {
    uint32_t struct_size;
    int32_t is_set; /* 0: its time function is in force, since it was not set yet */
    double value; /* [unit] set point; of a time function its value now */
    double present, rate; /* [unit; unit/s] in force now, changing towards `value` */
    double arrives; /* [s] time at which `present` reaches or reached `value`; 0 with a time function */
} dmb_input_state;
DMB_SIZED_STRUCT(dmb_input_state)
DMB_API int32_t dmb_sim_get_input(const dmb_sim *sim, dmb_id input, dmb_input_state *state);
/* Frozen. One line of the log of inputs. */
typedef struct dmb_input_record {
    double time, value; /* [s; unit of the input] time of the sim; value that was set, after clamping */
    uint32_t input; /* [-] number of the input in the order of description */
    uint32_t call; /* [-] number of the call that set it: those of one call are set at once */
} dmb_input_record;
/* From now on set points go into `records`, shape (capacity), which the caller keeps alive; NULL with 0: no more. A call beyond
 * the capacity still sets its value: DMB_NOTE_FULL. The log is neither saved in snapshots nor hashed. */
DMB_API int32_t dmb_sim_record_inputs(dmb_sim *sim, dmb_input_record *records, uint32_t capacity);
DMB_API uint32_t dmb_sim_recorded_inputs(const dmb_sim *sim); /* [-] records since then; 0 for an invalid handle */
/* Sets the values of the log from record *next on up to the present time, call by call, and moves *next beyond them. Called
 * before each step of a run that steps as the recorded one did, it gives the same states, bit for bit. Notes and errors as
 * dmb_sim_set_inputs, with *next at the call that was refused; DMB_ERR_VALUE too for times that decrease. */
DMB_API int32_t dmb_sim_replay_inputs(dmb_sim *sim, const dmb_input_record *records, uint32_t count, uint32_t *next);

/* ---- Events ----------------------------------------------------------------------------------------------------- */
typedef struct dmb_event_report {
    uint32_t struct_size, count; /* [-] events reported: those within the tolerance of the first count as simultaneous */
    uint64_t events; /* [-] bit i: event number i in the order of description is reported */
    double time; /* [s] reached */
    double located; /* [s] bound of the time from the crossing to `time`; 0 without an event, and where a `hold` ends; of
        dmb_sim_steps_to_event the length of the step that contains the crossing or the end of the hold */
    double crossing; /* [s] time of the crossing, of the first of several, before its `hold`; NaN without an event */
} dmb_event_report;
DMB_SIZED_STRUCT(dmb_event_report)
/* As dmb_sim_advance, but ends at the first event: DMB_NOTE_EVENT, dmb_sim_message names those reported. One that is beyond its
 * level at the start is reported when it has come back and crosses again; a `hold` continues from call to call. Costs a copy of
 * the state a step, some six steps a crossing. Notes and errors as dmb_sim_advance; DMB_ERR_VALUE: no events. */
DMB_API int32_t dmb_sim_advance_to_event(dmb_sim *sim, double time, dmb_event_report *event, dmb_step_report *report);
/* As dmb_sim_steps, with the same bits, but ends after the step in which the first event is: DMB_NOTE_EVENT. No step is changed:
 * `events` has all of that step, and `crossing` is where the parabola through the output at three ends of steps meets the level
 * (lib/theory/integration.md), with an error of order 3 where the output is smooth, else up to the step. dmb_sim_advance_to_event
 * takes shorter steps where tolerances ask. Notes, errors as dmb_sim_steps; DMB_ERR_VALUE: no events. */
DMB_API int32_t dmb_sim_steps_to_event(dmb_sim *sim, double duration, uint32_t count, uint32_t *done, dmb_event_report *event,
                                       dmb_step_report *report);
DMB_C_END
#endif
