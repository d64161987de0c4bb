/* Calls on a sim: one at a time, with the reads that a caller's function may make meanwhile.
 *
 *     state of the sim       its functions may            in
 *     --------------------   --------------------------   --------------------------------------------------------
 *     DMB_BUSY_NOT           call anything
 *     DMB_BUSY_READABLE      query (dmb_sim_check)        steps and analyses: the accepted state is complete
 *     DMB_BUSY_CHANGING      call nothing on it           inputs, restore, statics; in steps the solution after a jump
 *
 * A call within a call that may change the sim fails with DMB_ERR_ORDER, and the outer one goes on. */
#include "sim/access.h"

#include <math.h>

#include "base/sized_struct.h"
#include "base/value_check.h"
#include "drillmbd/analyse.h"
#include "drillmbd/run.h"
#include "model/field_check.h"
#include "sim/sim.h"

/* ---- Calls ------------------------------------------------------------------------------------------------------- */

void dmb_sim_refuse_re_entry(dmb_sim *sim)
{
    dmb_message_set(&sim->message,
                    "sim: in a call of its own at time %g, whose callback, allocator or log function may "
                    "not change it; do so when that call has returned",
                    sim->clock->time);
}

/* Failure of a call. Two cases report nothing here, because the outer call reports for them: a call that is part of
 * another one (dmb_sim_hand_on), and one on a copy for an analysis, whose progress is that of the original sim. */
int32_t dmb_sim_fail(const dmb_sim *sim, int32_t status, const char *call, const char *text)
{
    if (sim == NULL) return dmb_failure(NULL, NULL, status, call, text);
    if (!dmb_handle_is(sim, DMB_HANDLE_SIM)) return dmb_failure(NULL, NULL, status, call, text);
    if (sim->progress->nested > 0 || sim->progress != &sim->own_progress) return status; /* a copy for an analysis */
    const dmb_failed_object of = {sim, sim->calls};
    return dmb_failure(&of, &sim->model->on_error, status, call, text);
}

static int32_t take(dmb_sim *sim, int32_t busy)
{
    if (sim == NULL) return dmb_sim_fail(sim, DMB_ERR_NULL, "sim", NULL);
    if (!dmb_handle_is(sim, DMB_HANDLE_SIM)) return dmb_sim_fail(sim, DMB_ERR_HANDLE, "sim", NULL);
    if (sim->busy != DMB_BUSY_NOT) {
        dmb_sim_refuse_re_entry(sim);
        return dmb_sim_fail(sim, DMB_ERR_ORDER, "sim", sim->message.text);
    }
    sim->busy = busy;
    return DMB_OK;
}

int32_t dmb_sim_enter(dmb_sim *sim, int32_t busy)
{
    const int32_t status = take(sim, busy);
    if (status == DMB_OK) {
        sim->calls++;
        dmb_message_clear(&sim->message);
        dmb_progress_begin(sim);
    }
    return status;
}

int32_t dmb_sim_occupy(const dmb_sim *sim)
{
    const int32_t status = take((dmb_sim *)sim, DMB_BUSY_READABLE);
    if (status == DMB_OK) dmb_progress_begin((dmb_sim *)sim);
    return status;
}

/* A cancellation replaces whatever failure it caused. A failure of a callback has a message of its own where the place
 * is known; the general one is for the others. `calls` counts up twice per call, at its start and at its end: texts of
 * failures are kept by it (dmb_failure_text), so that the message of an earlier call, or of one that a callback made,
 * is not read as that of the last one. */
int32_t dmb_sim_leave(dmb_sim *sim, int32_t status)
{
    sim->busy = DMB_BUSY_NOT;
    sim->calls++; /* calls that its callbacks made in vain are over */
    if (status == DMB_ERR_CALLBACK && sim->message.text[0] == '\0')
        dmb_message_set(
            &sim->message,
            "sim: the callback of a time function, force or constraint failed or gave a value beyond +-1e30 on "
            "the step from time %g",
            sim->clock->time);
    if (status >= 0) return status;
    if (!sim->progress->cancelled) return dmb_sim_fail(sim, status, "sim", sim->message.text);
    dmb_message_set(&sim->message,
                    "sim: the caller's progress function ended the call at time %g, %g %% of it done; repeat "
                    "it for its result",
                    sim->clock->time, floor(100.0 * sim->progress->done + 0.5));
    return dmb_sim_fail(sim, DMB_ERR_CANCELLED, "sim", sim->message.text);
}

/* An analysis calls public functions on its own sim. Within them the sim is free, failures are left to the outer call,
 * and progress 0 to 1 of the inner call counts from `from` to `to` of the outer one. */
void dmb_sim_hand_on(dmb_sim *sim, double from, double to)
{
    sim->busy = DMB_BUSY_NOT;
    sim->progress->nested++;
    sim->progress->from = from;
    sim->progress->to = to;
}

void dmb_sim_resume(dmb_sim *sim)
{
    sim->busy = DMB_BUSY_READABLE;
    sim->progress->nested--;
    sim->progress->from = 0.0;
    sim->progress->to = 1.0;
}

/* The caller's progress function, called at bounded intervals of a long call, which it may cancel. */

void dmb_progress_begin(dmb_sim *sim)
{
    if (sim->progress->nested > 0 || sim->progress->function == NULL) return;
    sim->progress->done = sim->progress->from = 0.0;
    sim->progress->to = 1.0;
    sim->progress->cancelled = 0;
}

/* Progress never goes back: an inner call that starts over does not undo what has been reported. */
void dmb_progress_at(const dmb_sim *sim, double fraction)
{
    dmb_progress *progress = sim->progress;
    if (progress->function == NULL) return;
    const double part = fmin(fmax(fraction, 0.0), 1.0);
    progress->done = fmax(progress->done, progress->from + (progress->to - progress->from) * part);
}

int32_t dmb_progress_report(const dmb_sim *sim)
{
    dmb_progress *progress = sim->progress;
    if (!progress->cancelled) progress->cancelled = progress->function(progress->context, progress->done) != 0;
    return progress->cancelled ? DMB_ERR_CANCELLED : DMB_OK;
}

int32_t dmb_progress_end(const dmb_sim *sim, int32_t status)
{
    return sim->progress->cancelled ? DMB_ERR_CANCELLED : status;
}

int32_t dmb_sim_set_progress(dmb_sim *sim, dmb_progress_fn function, void *context)
{
    const int32_t status = dmb_sim_occupy(sim); /* the message stays */
    if (status < 0) return status;
    sim->progress->cancelled = 0;
    sim->progress->function = function;
    sim->progress->context = context;
    return dmb_sim_leave(sim, DMB_OK);
}

int32_t dmb_sim_set_on_step(dmb_sim *sim, dmb_step_fn function, void *context)
{
    const int32_t status = dmb_sim_occupy(sim);
    if (status < 0) return status;
    sim->on_step = function;
    sim->on_step_context = context;
    return dmb_sim_leave(sim, DMB_OK);
}

/* ---- Options ----------------------------------------------------------------------------------------------------- */

int32_t dmb_sim_options_get(dmb_sim_options *out, const dmb_sim_options *given, dmb_message *message)
{
    dmb_check check = dmb_check_of(message, "sim options", DMB_NONE);
    dmb_sim_options read;
    dmb_options_get(&check, DMB_OPTIONS_OF(dmb_sim_options), given, &read);
    dmb_check_above_field(&check, "step_max", read.step_max, "step_min", read.step_min);
    if (check.status == DMB_OK) *out = read;
    return check.status;
}

/* Defaults of the structs of sim.h, query.h and analysis.h, as documented there. The number is the struct's size in its
 * first release. */

/* clang-format off */
DMB_DEFINE_INIT(dmb_step_report, 48, {.steps = 0})

DMB_DEFINE_INIT(dmb_pose, 136, {.depth = 0.0})

DMB_DEFINE_INIT(dmb_motion, 104, {.frame = DMB_FRAME_WORLD})

DMB_DEFINE_INIT(dmb_section, 104, {.reserved = 0})

DMB_DEFINE_INIT(dmb_contact, 120, {.closed = 0})

DMB_DEFINE_INIT(dmb_contact_total, 40, {.closed = 0})

DMB_DEFINE_INIT(dmb_energy, 128, {.kinetic = 0.0})

DMB_DEFINE_INIT(dmb_momentum, 88, {.mass = 0.0})

DMB_DEFINE_INIT(dmb_drive_state, 56, {.target = 0.0})

DMB_DEFINE_INIT(dmb_joint_state, 272, {.frame = DMB_FRAME_WORLD})

DMB_DEFINE_INIT(dmb_bit_state, 56, {.on_bottom = 0})

DMB_DEFINE_INIT(dmb_statistics, 72, {.steps = 0})

DMB_DEFINE_INIT(dmb_recorder, 48, {.output_count = 0})

DMB_DEFINE_INIT(dmb_static_report, 40, {.iterations = 0})

DMB_DEFINE_INIT(dmb_buckling_info, 56, {.count = 0})

DMB_DEFINE_INIT(dmb_path_point, 56, {.number = 0})

DMB_DEFINE_INIT(dmb_path_report, 56, {.points = 0})

DMB_DEFINE_INIT(dmb_check_report, 192, {.rigid_parts = 0})

DMB_DEFINE_INIT(dmb_modes_info, 48, {.count = 0})

DMB_DEFINE_INIT(dmb_mode, 128, {.rigid = 0})

DMB_DEFINE_INIT(dmb_mode_shape, 104, {.frame = DMB_FRAME_WORLD})
/* clang-format on */
