#include "unit.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

unit_status unit_tell(const unit *u, unit_status status, const char *format, ...)
{
    char text[1024];
    if (!u->log || (status <= UNIT_WARNING && !u->logs)) return status;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    u->log(u->log_context, status, status <= UNIT_WARNING ? "logStatusWarning" : "logStatusError", text);
    return status;
}

unit_status unit_require(const unit *u, unsigned modes, const char *call)
{
    static const char *const names[UNIT_MODES] = {"instantiated", "initialization", "event",
                                                  "step",         "terminated",     "failed"};
    if (modes >> u->mode & 1u) return UNIT_OK;
    return unit_tell(u, UNIT_ERROR, "call refused: %s in mode \"%s\"; see the state machine of the standard", call,
                     names[u->mode]);
}

/* ---- Life ---------------------------------------------------------------------------------------------------------
 */
static void warn(void *context, int32_t level, const char *text)
{
    if (level <= DMB_LOG_WARNING) unit_tell(context, UNIT_WARNING, "%s", text);
}

static int list_inputs(unit *u)
{
    u->input_count = dmb_model_input_count(u->scene.model);
    u->event_count = dmb_model_event_count(u->scene.model);
    u->inputs = calloc(u->input_count + 1u, sizeof *u->inputs);
    u->values = calloc(u->input_count + 1u, sizeof *u->values);
    u->is_set = calloc(u->input_count + 1u, sizeof *u->is_set);
    if (!u->inputs || !u->values || !u->is_set) return -1;
    for (uint32_t i = 0; i < u->input_count; ++i) {
        u->inputs[i] = dmb_input_info_default();
        if (dmb_model_get_input(u->scene.model, i, &u->inputs[i]) < 0) return -1;
    }
    return 0;
}

static int open_scene(unit *u, const char *folder, const char *token)
{
    char path[4096];
    const int length = snprintf(path, sizeof path, "%s/scene.bin", folder);
    if (length < 0 || (size_t)length >= sizeof path) {
        unit_tell(u, UNIT_ERROR, "unit refused: the path of its resources has %d characters, must be < 4096", length);
        return -1;
    }
    if (scene_open(&u->scene, path, warn, u) != 0) {
        unit_tell(u, UNIT_ERROR, "%s", u->scene.message);
        return -1;
    }
    if (!token || strcmp(token, u->scene.token) != 0) {
        unit_tell(u, UNIT_ERROR,
                  "unit refused: token %s of the model description, %s holds %s; take both from one unit",
                  token ? token : "NULL", path, u->scene.token);
        return -1;
    }
    return 0;
}

unit *unit_create(const char *folder, const char *token, unit_log_fn log, void *log_context, int logs)
{
    unit *u = calloc(1, sizeof *u);
    if (!u) return NULL;
    u->log = log;
    u->log_context = log_context;
    u->logs = logs;
    if (open_scene(u, folder, token) != 0) {
        unit_destroy(u);
        return NULL;
    }
    if (list_inputs(u) != 0) {
        unit_tell(u, UNIT_ERROR, "unit refused: no memory for its %u inputs", u->input_count);
        unit_destroy(u);
        return NULL;
    }
    u->step = u->scene.settings.step;
    return u;
}

void unit_destroy(unit *u)
{
    if (!u) return;
    dmb_sim_destroy(&u->sim);
    scene_close(&u->scene);
    free(u->inputs);
    free(u->values);
    free(u->is_set);
    free(u);
}

unit_status unit_begin(unit *u, double start)
{
    if (unit_require(u, 1u << UNIT_INSTANTIATED, "enter initialization mode") != UNIT_OK) return UNIT_ERROR;
    if (start != 0.0)
        return unit_tell(u, UNIT_ERROR,
                         "start refused: start time = %g s, must be 0: time functions of the scene begin there", start);
    u->mode = UNIT_INITIALISING;
    return UNIT_OK;
}

unit_status unit_reset(unit *u)
{
    dmb_sim_destroy(&u->sim);
    memset(u->is_set, 0, u->input_count * sizeof *u->is_set);
    memset(u->told, 0, sizeof u->told);
    u->step = u->scene.settings.step;
    u->mode = UNIT_INSTANTIATED;
    return UNIT_OK;
}

/* ---- The sim at time 0 --------------------------------------------------------------------------------------------
 */
/* The others, parameters, are there in the static state already. */
int unit_input_is_controlled(const dmb_input_info *input)
{
    return input->target == DMB_TARGET_SET_POINT || input->target == DMB_TARGET_LOAD_FACTOR ||
           input->target == DMB_TARGET_BIT_LOAD;
}

/* All inputs, or all parameters, that were set, at once. */
static int32_t set_all(unit *u, int controlled)
{
    dmb_id *ids = malloc((u->input_count + 1u) * sizeof *ids);
    double *values = malloc((u->input_count + 1u) * sizeof *values);
    uint32_t count = 0;
    int32_t status = DMB_ERR_NO_MEMORY;
    if (ids && values) {
        for (uint32_t i = 0; i < u->input_count; ++i) {
            if (!u->is_set[i] || unit_input_is_controlled(&u->inputs[i]) != controlled) continue;
            ids[count] = u->inputs[i].input;
            values[count++] = u->values[i];
        }
        status = count > 0 ? dmb_sim_set_inputs(u->sim, ids, values, count) : DMB_OK;
    }
    free(ids);
    free(values);
    return status;
}

/* Parameters, the static state, inputs; *failed tells where it ended. */
static int32_t start_sim(unit *u, const char **failed)
{
    *failed = "parameters";
    int32_t status = set_all(u, 0);
    if (status >= 0 && u->scene.settings.has_static) {
        *failed = "static state";
        status = dmb_analysis_static(u->sim, &u->scene.settings.statics, NULL);
        if (status > 0) unit_tell(u, UNIT_WARNING, "%s: %s", dmb_status_text(status), dmb_sim_message(u->sim));
    }
    if (status < 0) return status;
    *failed = "inputs";
    return set_all(u, 1);
}

unit_status unit_prepare(unit *u)
{
    const unit_mode before = u->mode;
    const char *failed;
    if (u->sim) return UNIT_OK;
    if (u->mode == UNIT_FAILED)
        return unit_tell(u, UNIT_ERROR,
                         "call refused: the start of this unit failed; reset it, then give other values");
    u->mode = UNIT_FAILED; /* an importer that does not read the status of the start gets no values */
    if (dmb_sim_create(u->scene.model, &u->scene.settings.sim, &u->sim) < 0)
        return unit_tell(u, UNIT_ERROR, "start failed: %s", dmb_model_message(u->scene.model));
    if (start_sim(u, &failed) >= 0) {
        u->mode = before;
        return UNIT_OK;
    }
    unit_tell(u, UNIT_ERROR, "start failed: %s at time 0: %s", failed, dmb_sim_message(u->sim));
    dmb_sim_destroy(&u->sim);
    return UNIT_ERROR;
}

/* ---- Variables ----------------------------------------------------------------------------------------------------
 */
static unit_status unknown(const unit *u, uint32_t reference, const char *type)
{
    return unit_tell(
        u, UNIT_ERROR,
        "value reference refused: %u is no %s here: time 0, step 1, inputs %d .. + %u, outputs %d .. + %u, "
        "counts of events %d .. + %u",
        reference, type, UNIT_INPUTS, u->input_count, UNIT_OUTPUTS, u->scene.settings.output_count, UNIT_EVENTS,
        u->event_count);
}

int unit_has_input(const unit *u, uint32_t reference)
{
    return reference >= UNIT_INPUTS && reference < UNIT_INPUTS + u->input_count && reference < UNIT_OUTPUTS;
}

int unit_has_output(const unit *u, uint32_t reference)
{
    return reference >= UNIT_OUTPUTS && reference < UNIT_OUTPUTS + u->scene.settings.output_count &&
           reference < UNIT_EVENTS;
}

static unit_status get_input(unit *u, uint32_t i, double *value)
{
    if (!u->sim && u->is_set[i]) {
        *value = u->values[i];
        return UNIT_OK;
    }
    if (unit_prepare(u) != UNIT_OK) return UNIT_ERROR;
    dmb_input_state state = dmb_input_state_default();
    if (dmb_sim_get_input(u->sim, u->inputs[i].input, &state) < 0)
        return unit_tell(u, UNIT_ERROR, "input %s cannot be read: %s", u->inputs[i].name, dmb_sim_message(u->sim));
    *value = state.value;
    return UNIT_OK;
}

static unit_status get_output(unit *u, uint32_t i, double *value)
{
    if (unit_prepare(u) != UNIT_OK) return UNIT_ERROR;
    const int32_t status = dmb_query_output(u->sim, &u->scene.settings.outputs[i], value);
    if (status >= 0) return UNIT_OK;
    (void)dmb_output_check(u->sim, &u->scene.settings.outputs[i], 1);
    return unit_tell(u, UNIT_ERROR, "output %u cannot be read: %s: %s", i, dmb_status_text(status),
                     dmb_sim_message(u->sim));
}

static unit_status get_one(unit *u, uint32_t reference, double *value)
{
    if (reference == UNIT_TIME) {
        *value = u->sim ? dmb_sim_time(u->sim) : 0.0;
    } else if (reference == UNIT_STEP) {
        *value = u->step;
    } else if (unit_has_input(u, reference)) {
        return get_input(u, reference - UNIT_INPUTS, value);
    } else if (unit_has_output(u, reference)) {
        return get_output(u, reference - UNIT_OUTPUTS, value);
    } else {
        return unknown(u, reference, "real number");
    }
    return UNIT_OK;
}

unit_status unit_get(unit *u, const uint32_t *references, size_t count, double *values)
{
    for (size_t i = 0; i < count; ++i)
        if (get_one(u, references[i], &values[i]) != UNIT_OK) return UNIT_ERROR;
    return UNIT_OK;
}

unit_status unit_get_counts(unit *u, const uint32_t *references, size_t count, int32_t *values)
{
    for (size_t i = 0; i < count; ++i) {
        const uint32_t event = references[i] - UNIT_EVENTS; /* wraps round below */
        if (event >= u->event_count) return unknown(u, references[i], "integer");
        values[i] = (int32_t)(u->told[event] & INT32_MAX);
    }
    return UNIT_OK;
}

/* ---- Setting ------------------------------------------------------------------------------------------------------
 */
/* Before steps: the value waits for the sim, which is made anew. */
static unit_status set_early(unit *u, uint32_t i, double value)
{
    u->values[i] = value;
    u->is_set[i] = 1;
    dmb_sim_destroy(&u->sim);
    return UNIT_OK;
}

static unit_status check_early(const unit *u, uint32_t reference, double value)
{
    if (reference == UNIT_STEP) {
        if (!(value >= 0.0 && value <= 1e18))
            return unit_tell(u, UNIT_DISCARD, "value refused: step = %g s, must be 0 .. 1e18; 0: chosen by the library",
                             value);
        if (value > 0.0 && u->event_count > 0)
            return unit_tell(u, UNIT_DISCARD,
                             "value refused: step = %g s, must be 0 in a scene with events, which are found by "
                             "steps of the library's choice; take the events away or leave it",
                             value);
        return UNIT_OK;
    }
    if (!unit_has_input(u, reference)) return unknown(u, reference, "input or parameter");
    if (!isfinite(value))
        return unit_tell(u, UNIT_DISCARD, "value refused: input %s = %g %s, must be finite",
                         u->inputs[reference - UNIT_INPUTS].name, value, u->inputs[reference - UNIT_INPUTS].unit);
    return UNIT_OK;
}

static unit_status set_now(unit *u, const uint32_t *references, size_t count, const double *values)
{
    dmb_id *ids = malloc((count + 1u) * sizeof *ids);
    int32_t status = DMB_ERR_NO_MEMORY;
    if (ids) {
        for (size_t i = 0; i < count; ++i) ids[i] = u->inputs[references[i] - UNIT_INPUTS].input;
        status = dmb_sim_set_inputs(u->sim, ids, values, (uint32_t)count);
        free(ids);
    }
    if (status < 0) return unit_tell(u, UNIT_DISCARD, "inputs refused: %s", dmb_sim_message(u->sim));
    if (status == DMB_NOTE_CLAMPED) return unit_tell(u, UNIT_OK, "%s", dmb_sim_message(u->sim));
    return UNIT_OK;
}

unit_status unit_set(unit *u, const uint32_t *references, size_t count, const double *values)
{
    if (unit_require(u, 1u << UNIT_INSTANTIATED | 1u << UNIT_INITIALISING | 1u << UNIT_AT_EVENT | 1u << UNIT_STEPPING,
                     "set") != UNIT_OK)
        return UNIT_ERROR;
    const int early = u->mode <= UNIT_INITIALISING;
    for (size_t i = 0; i < count; ++i) {
        const unit_status status = check_early(u, references[i], values[i]);
        if (status != UNIT_OK) return status;
        if (!early && references[i] == UNIT_STEP)
            return unit_tell(u, UNIT_ERROR,
                             "value refused: step = %g s is fixed; set it before the end of initialization", values[i]);
    }
    if (!early) return count > 0 ? set_now(u, references, count, values) : UNIT_OK;
    for (size_t i = 0; i < count; ++i) {
        if (references[i] == UNIT_STEP)
            u->step = values[i];
        else
            set_early(u, references[i] - UNIT_INPUTS, values[i]);
    }
    return UNIT_OK;
}
