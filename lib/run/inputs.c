/* Inputs that the caller sets between steps. All or none of a call:
 *
 *     check      each id and value; nothing is changed by a refusal
 *     keep       present values and starts of transitions; with stuck places the whole state
 *     assign     new values; a transition starts at the present value and rate (eq:drive.reference)
 *     update     own scene, stuck places
 *     check      limits of drives, which two inputs may have set
 *     jump       consistent accelerations (dmb_system_jump)
 *     record     energy of released stuck places and of changed weight, factors, log
 *
 * A failure of the last check or of the jump puts everything back. Forces jump with inputs. Without consistent
 * accelerations the a of generalized-alpha would belong to the old forces, and the steps after it would be of first
 * order only. */
#include <math.h>
#include <string.h>

#include "model/describe.h"
#include "model/field_check.h"
#include "sim/access.h"
#include "sim/layout.h"
#include "sim/node.h"
#include "sim/own_scene.h"
#include "system/assemble/assemble.h"
#include "system/assemble/energy.h"
#include "system/assemble/ledger.h"
#include "system/constrain/constrain.h"
#include "system/solve/solve.h"
#include "system/system.h"

/* ---- Set points and joints --------------------------------------------------------------------------------------- */

static int32_t refuse(dmb_sim *sim, int32_t status, const char *why)
{
    dmb_message_set(&sim->message, "%s", why);
    return status;
}

/* A value equal to the present one does nothing: setting it in every step costs no jump. */
static int32_t jump_to(dmb_sim *sim, uint32_t index, double value)
{
    const double before = sim->drive_input[index];
    if (before == value || (isnan(before) && isnan(value))) return DMB_OK;
    sim->drive_input[index] = value;
    const int32_t status = dmb_system_jump(sim);
    if (status < 0) sim->drive_input[index] = before;
    return status;
}

/* Fails if an input prescribes the target of this drive: only one of them may. */
static int32_t refuse_input(dmb_sim *sim, uint32_t drive)
{
    dmb_message name;
    for (uint32_t i = 0; i < sim->scene->input_count; i++) {
        const dmb_scene_input *input = sim->scene->inputs + i;
        if (input->target != DMB_TARGET_SET_POINT || input->index != drive) continue;
        dmb_message_set(&sim->message, "%s: its set point is input %u (%s), set that by dmb_sim_set_input",
                        dmb_drive_text(sim->scene, drive, &name), i, input->name);
        return DMB_ERR_UNSUPPORTED;
    }
    return DMB_OK;
}

/* A motion drive is refused: its speed would jump. A drive whose set point is an input takes values by
 * dmb_sim_set_input only. */
static int32_t set_drive(dmb_sim *sim, dmb_id drive, double value)
{
    const uint32_t index = dmb_model_part_index(sim->model, drive, DMB_PART_DRIVE);
    dmb_message name;
    if (index >= sim->scene->drive_count) return refuse(sim, DMB_ERR_ID, "drive: the id names no drive of this model");
    if (sim->scene->drives[index].kind == DMB_DRIVE_MOTION) {
        dmb_message_set(
            &sim->message,
            "%s: its kind is DMB_DRIVE_MOTION, whose speed may not jump; describe an input of its set point",
            dmb_drive_text(sim->scene, index, &name));
        return DMB_ERR_UNSUPPORTED;
    }
    if (refuse_input(sim, index) < 0) return DMB_ERR_UNSUPPORTED;
    if (isinf(value)) {
        dmb_message_field(&sim->message, dmb_drive_text(sim->scene, index, &name), DMB_NONE, "value", value,
                          "finite, or NaN for the time function");
        return DMB_ERR_NOT_FINITE;
    }
    if (isgreater(fabs(value), DMB_FORCE_MAX)) { /* limit as in descriptions: beyond it work and power overflow */
        dmb_message_field(&sim->message, dmb_drive_text(sim->scene, index, &name), DMB_NONE, "value", value,
                          "from -1e30 to 1e30, or NaN for the time function");
        return DMB_ERR_VALUE;
    }
    return jump_to(sim, index,
                   isnan(value) ? (double)NAN
                                : value); /* a single NaN pattern, so that equal states have equal hashes */
}

int32_t dmb_sim_set_drive(dmb_sim *sim, dmb_id drive, double value)
{
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_CHANGING);
    return status < 0 ? status : dmb_sim_leave(sim, set_drive(sim, drive, value));
}

/* Sets the state of a joint for the caller. */

static int32_t set_joint(dmb_sim *sim, dmb_id joint, int32_t state)
{
    const uint32_t j = dmb_model_part_index(sim->model, joint, DMB_PART_JOINT);
    if (j >= sim->scene->joint_count) {
        dmb_message_set(&sim->message, "joint: the id names no joint of this model");
        return DMB_ERR_ID;
    }
    if (state < DMB_JOINT_ACTIVE || state > DMB_JOINT_OPEN) {
        dmb_message_field(&sim->message, "joint", j, "state", state, "from 0 to 2");
        return DMB_ERR_VALUE;
    }
    return dmb_joint_switch(sim, j, state);
}

int32_t dmb_sim_set_joint(dmb_sim *sim, dmb_id joint, int32_t state)
{
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_CHANGING);
    return status < 0 ? status : dmb_sim_leave(sim, set_joint(sim, joint, state));
}

/* ---- Inputs ------------------------------------------------------------------------------------------------------ */

/* Inputs set between steps: all or none, with consistent accelerations after jumps. */

/* Values set by a call: the caller's arrays, or records of a log. */
typedef struct settings {
    const dmb_id *inputs;
    const double *values;
    const dmb_input_record *records;
    uint32_t count;
    int32_t clamped;
} settings;

static const dmb_scene_input *input_at(const dmb_sim *sim, uint32_t i)
{
    return sim->scene->inputs + i;
}

static uint32_t index_of(const dmb_sim *sim, const settings *given, uint32_t k)
{
    const uint32_t i = given->records != NULL ? given->records[k].input
                                              : dmb_model_part_index(sim->model, given->inputs[k], DMB_PART_INPUT);
    return i < sim->scene->input_count ? i : DMB_NONE;
}

static double value_of(const settings *given, uint32_t k)
{
    return given->records != NULL ? given->records[k].value : given->values[k];
}

/* ---- Checks ------------------------------------------------------------------------------------------------------ */

static int32_t refuse_value(dmb_sim *sim, uint32_t i, double value)
{
    const dmb_scene_input *input = input_at(sim, i);
    dmb_message name;
    dmb_message_set(&sim->message, "%s: value = %g, must be from %g to %g; set one of these, or give it other bounds",
                    dmb_part_text(&name, "input", i, input->name, sizeof input->name), value, input->low, input->high);
    return DMB_ERR_VALUE;
}

static int32_t check(dmb_sim *sim, settings *given)
{
    dmb_message name;
    for (uint32_t k = 0; k < given->count; k++) {
        const uint32_t i = index_of(sim, given, k);
        const double value = value_of(given, k);
        if (i == DMB_NONE) {
            dmb_message_set(&sim->message, "input: number %u of those to set names no input of this model", k);
            return DMB_ERR_ID;
        }
        const dmb_scene_input *input = input_at(sim, i);
        if (!isfinite(value)) {
            dmb_message_field(&sim->message, dmb_part_text(&name, "input", i, input->name, sizeof input->name),
                              DMB_NONE, "value", value, "finite");
            return DMB_ERR_NOT_FINITE;
        }
        if (input->target == DMB_TARGET_STUCK && value > 0.0 && value < 1.0) {
            dmb_message_field(&sim->message, dmb_part_text(&name, "input", i, input->name, sizeof input->name),
                              DMB_NONE, "value", value, "0 (free) or 1 (stuck)");
            return DMB_ERR_VALUE;
        }
        if (value >= input->low && value <= input->high) continue;
        if (input->outside == DMB_OUTSIDE_REFUSED) return refuse_value(sim, i, value);
        given->clamped = 1;
    }
    return DMB_OK;
}

/* Checks the limits of controlled drives after all values are set. */
static int32_t check_limits(dmb_sim *sim)
{
    dmb_message name;
    for (uint32_t i = 0; i < sim->scene->input_count; i++) {
        const dmb_scene_input *input = input_at(sim, i);
        if (input->target != DMB_TARGET_LIMIT_LOW && input->target != DMB_TARGET_LIMIT_HIGH) continue;
        const dmb_scene_drive *drive = sim->scene->drives + input->index;
        if (drive->limit_low < drive->limit_high) continue;
        dmb_message_set(
            &sim->message, "%s: limit_low = %g of its drive, must be < limit_high = %g; set both in one call",
            dmb_part_text(&name, "input", i, input->name, sizeof input->name), drive->limit_low, drive->limit_high);
        return DMB_ERR_VALUE;
    }
    return DMB_OK;
}

/* ---- Setting ----------------------------------------------------------------------------------------------------- */

/* Input values and starts of transitions, for put_back. */
static void keep(dmb_sim *sim)
{
    const size_t count = sim->scene->input_count;
    memcpy(sim->input_before, sim->input_value, count * sizeof(double));
    memcpy(sim->input_before + count, sim->input_begin, 3 * count * sizeof(double));
}

/* Makes places stuck whose input is 1; newly stuck ones in the present pose. */
static void set_stuck(dmb_sim *sim)
{
    for (uint32_t i = 0; i < sim->scene->stuck_count; i++) {
        const uint32_t input = sim->scene->stuck[i].input;
        if (input != DMB_NONE) dmb_stuck_set(sim, i, sim->input_value[input] > 0.5);
    }
}

static void put_back(dmb_sim *sim)
{
    const size_t count = sim->scene->input_count;
    memcpy(sim->input_value, sim->input_before, count * sizeof(double));
    memcpy(sim->input_begin, sim->input_before + count, 3 * count * sizeof(double));
    if (sim->scene->stuck_count) dmb_state_restore(sim); /* including the poses of stuck places */
    dmb_own_scene_update(sim);
}

/* Starts the transition to a new value at the present one. A value without limits changes at once. */
static int32_t aim(dmb_sim *sim, uint32_t i, double value)
{
    const dmb_scene_input *input = input_at(sim, i);
    double *begin = sim->input_begin + 3 * (size_t)i;
    int32_t status = DMB_OK;
    begin[0] = sim->clock->time;
    begin[1] = value;
    begin[2] = 0.0;
    if (input->rate_limit > 0.0 || input->slope_limit > 0.0) status = dmb_input_present(sim, i, begin + 1, begin + 2);
    sim->input_value[i] = value;
    if (status < 0)
        dmb_message_set(&sim->message,
                        "input (%s): the callback of the time function it takes over failed or gave a value "
                        "beyond +-1e30 at time %g",
                        input->name, sim->clock->time);
    return status;
}

static double taken(const dmb_scene_input *input, double value)
{
    return fmin(fmax(value, input->low), input->high);
}

/* True if the value of input i is another than before the call. */
static int has_changed(const dmb_sim *sim, uint32_t i)
{
    return !isnan(sim->input_value[i]) && !(sim->input_value[i] == sim->input_before[i]);
}

/* Assigns values; of several values for one input the last is used, and all start from the present one. */
static int32_t assign(dmb_sim *sim, const settings *given, int32_t *changed, int32_t *forget)
{
    int32_t status = DMB_OK;
    for (uint32_t k = 0; k < given->count && status >= 0; k++) {
        const uint32_t i = index_of(sim, given, k);
        const double value = taken(input_at(sim, i), value_of(given, k));
        if (value == sim->input_value[i]) continue;
        status = aim(sim, i, value);
        *changed = 1;
        if (!dmb_input_is_time_function(input_at(sim, i)->target)) *forget = 1;
    }
    return status;
}

static int moves_weight(const dmb_sim *sim)
{
    return sim->scene->has_density_input && sim->options.energy_ledger;
}

/* Records what has changed, each once. A full log is a note, not a failure: values are set all the same. */
static int32_t note(dmb_sim *sim)
{
    dmb_input_log *log = &sim->input_log;
    for (uint32_t i = 0; i < sim->scene->input_count && log->records != NULL; i++) {
        const dmb_input_record record = {sim->clock->time, sim->input_value[i], i, log->calls};
        if (!has_changed(sim, i)) continue;
        if (log->count == log->capacity) {
            dmb_message_set(&sim->message, "input log: its %u records are full, later values are not in it",
                            log->capacity);
            return DMB_NOTE_FULL;
        }
        log->records[log->count++] = record;
    }
    log->calls++;
    return DMB_OK;
}

/* Kept factors are of the old gains, damping and weights, but not of time functions, which change the residual alone.
 * With an input of density the potential energy changes without a force doing work: the ledger gets the difference as a
 * change. */
static int32_t apply(dmb_sim *sim, const settings *given)
{
    const double weight = moves_weight(sim) ? dmb_gravity_energy(sim->scene, &sim->now) : 0.0;
    const double stored = dmb_stuck_energy(sim, &sim->now);
    int32_t changed = 0, forget = 0;
    int32_t status = assign(sim, given, &changed, &forget);
    if (!changed) return status;
    if (status >= 0) {
        dmb_own_scene_update(sim);
        set_stuck(sim);
        status = check_limits(sim);
    }
    if (status >= 0) status = dmb_system_jump(sim);
    if (status < 0) return status;
    if (sim->scene->stuck_count) dmb_stuck_lose(sim, stored);
    if (forget) dmb_forget_factors(sim); /* they were made with the old values */
    if (moves_weight(sim)) dmb_ledger_add_change(sim, dmb_gravity_energy(sim->scene, &sim->now) - weight);
    return note(sim);
}

static int32_t set(dmb_sim *sim, settings *given)
{
    int32_t status = check(sim, given);
    if (status < 0 || given->count == 0) return status;
    keep(sim);
    if (sim->scene->stuck_count) dmb_state_back_up(sim);
    status = apply(sim, given);
    if (status < 0) put_back(sim);
    if (status != DMB_OK || !given->clamped) return status;
    dmb_message_set(&sim->message, "input: a value beyond the bounds was taken for the bound, as its definition says");
    return DMB_NOTE_CLAMPED;
}

static int32_t set_all(dmb_sim *sim, const dmb_id *inputs, const double *values, uint32_t count)
{
    settings given = {.inputs = inputs, .values = values, .count = count};
    if (count > 0 && (inputs == NULL || values == NULL)) return DMB_ERR_NULL;
    return set(sim, &given);
}

int32_t dmb_sim_set_inputs(dmb_sim *sim, const dmb_id *inputs, const double *values, uint32_t count)
{
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_CHANGING);
    return status < 0 ? status : dmb_sim_leave(sim, set_all(sim, inputs, values, count));
}

int32_t dmb_sim_set_input(dmb_sim *sim, dmb_id input, double value)
{
    return dmb_sim_set_inputs(sim, &input, &value, 1);
}

/* ---- Log --------------------------------------------------------------------------------------------------------- */

static int32_t record(dmb_sim *sim, dmb_input_record *records, uint32_t capacity)
{
    if ((records == NULL) != (capacity == 0)) {
        dmb_message_set(&sim->message, "input log: records and capacity = %u must be both given, or NULL and 0",
                        capacity);
        return records == NULL ? DMB_ERR_NULL : DMB_ERR_VALUE;
    }
    sim->input_log = (dmb_input_log){.records = records, .capacity = capacity};
    return DMB_OK;
}

int32_t dmb_sim_record_inputs(dmb_sim *sim, dmb_input_record *records, uint32_t capacity)
{
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_CHANGING);
    return status < 0 ? status : dmb_sim_leave(sim, record(sim, records, capacity));
}

uint32_t dmb_sim_recorded_inputs(const dmb_sim *sim)
{
    return sim != NULL && dmb_handle_is(sim, DMB_HANDLE_SIM) ? sim->input_log.count : 0;
}

static int32_t refuse_time(dmb_sim *sim, uint32_t i, double time)
{
    const dmb_field_value is = {"time", i, time};
    dmb_message_component(&sim->message, "input log", DMB_NONE, &is, "finite and not before that of the record before");
    return isfinite(time) ? DMB_ERR_VALUE : DMB_ERR_NOT_FINITE;
}

/* Records of the call that begins at `first`, if they are due. */
static int32_t due(dmb_sim *sim, const dmb_input_record *records, uint32_t count, uint32_t first, uint32_t *end)
{
    *end = first;
    if (first > 0 && records[first].time < records[first - 1].time) return refuse_time(sim, first, records[first].time);
    if (records[first].time > sim->clock->time) return DMB_OK;
    for (; *end < count && records[*end].call == records[first].call; ++*end)
        if (!(records[*end].time == records[first].time)) return refuse_time(sim, *end, records[*end].time);
    return DMB_OK;
}

/* Records of one call are set by one call, since their values may be valid together only. Calls due are set in their
 * order, up to the time of the sim. */
static int32_t replay(dmb_sim *sim, const dmb_input_record *records, uint32_t count, uint32_t *next)
{
    if (next == NULL || (count > 0 && records == NULL)) return DMB_ERR_NULL;
    while (*next < count) {
        uint32_t end;
        int32_t status = due(sim, records, count, *next, &end);
        settings given = {.records = records + *next, .count = end - *next};
        if (status >= 0 && end == *next) return DMB_OK;
        if (status >= 0) status = set(sim, &given);
        if (status < 0) return status;
        *next = end;
    }
    return DMB_OK;
}

int32_t dmb_sim_replay_inputs(dmb_sim *sim, const dmb_input_record *records, uint32_t count, uint32_t *next)
{
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_CHANGING);
    return status < 0 ? status : dmb_sim_leave(sim, replay(sim, records, count, next));
}
