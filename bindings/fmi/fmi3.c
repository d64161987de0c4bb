/* The functions of FMI 3.0 for co-simulation; sections are those of the standard. */
#include "fmi3_declarations.h"

#include <stdlib.h>
#include <string.h>

#include "unit.h"

#if defined(_WIN32)
#define FMI3_EXPORT __declspec(dllexport)
#else
#define FMI3_EXPORT __attribute__((visibility("default")))
#endif
/* Each function is declared before its definition, for compilers that ask for it. */
#define FUNCTION(result, name, ...)       \
    FMI3_EXPORT result name(__VA_ARGS__); \
    result name(__VA_ARGS__)

typedef struct instance {
    unit *u;
    fmi3LogMessageCallback log;
    fmi3InstanceEnvironment environment;
    int event_mode, early_return;
} instance;

static void forward(void *context, unit_status status, const char *category, const char *text)
{
    const instance *of = context;
    if (of->log) of->log(of->environment, (fmi3Status)status, category, text);
}

static unit *unit_of(fmi3Instance handle)
{
    return handle ? ((instance *)handle)->u : NULL;
}

static fmi3Status refused(fmi3Instance handle, const char *call)
{
    unit *u = unit_of(handle);
    if (u) unit_tell(u, UNIT_ERROR, "call refused: %s is not offered by this unit; see modelDescription.xml", call);
    return fmi3Error;
}

/* ---- 2.3.1, 4.2.1: instances --------------------------------------------------------------------------------------
 */
FUNCTION(const char *, fmi3GetVersion, void)
{
    return "3.0";
}

FUNCTION(fmi3Instance, fmi3InstantiateCoSimulation, fmi3String name, fmi3String token, fmi3String resources,
         fmi3Boolean visible, fmi3Boolean logs, fmi3Boolean event_mode, fmi3Boolean early_return,
         const fmi3ValueReference intermediate[], size_t intermediate_count, fmi3InstanceEnvironment environment,
         fmi3LogMessageCallback log, fmi3IntermediateUpdateCallback update)
{
    (void)name, (void)visible, (void)intermediate, (void)intermediate_count, (void)update;
    instance *made = calloc(1, sizeof *made);
    if (!made) return NULL;
    made->log = log;
    made->environment = environment;
    made->event_mode = event_mode;
    made->early_return = early_return;
    if (resources) {
        made->u = unit_create(resources, token, forward, made, logs);
    } else {
        forward(made, UNIT_ERROR, "logStatusError",
                "unit refused: resource path is NULL, must be the folder of scene.bin");
    }
    if (made->u) return made;
    free(made);
    return NULL;
}

FUNCTION(void, fmi3FreeInstance, fmi3Instance handle)
{
    if (!handle) return;
    unit_destroy(unit_of(handle));
    free(handle);
}

FUNCTION(fmi3Status, fmi3SetDebugLogging, fmi3Instance handle, fmi3Boolean logs, size_t count,
         const fmi3String categories[])
{
    (void)count, (void)categories;
    if (!handle) return fmi3Error;
    unit_of(handle)->logs = logs;
    return fmi3OK;
}

/* ---- 2.3: modes ---------------------------------------------------------------------------------------------------
 */
FUNCTION(fmi3Status, fmi3EnterInitializationMode, fmi3Instance handle, fmi3Boolean has_tolerance, fmi3Float64 tolerance,
         fmi3Float64 start, fmi3Boolean has_stop, fmi3Float64 stop)
{
    (void)has_tolerance, (void)tolerance, (void)has_stop, (void)stop;
    return handle ? (fmi3Status)unit_begin(unit_of(handle), start) : fmi3Error;
}

FUNCTION(fmi3Status, fmi3ExitInitializationMode, fmi3Instance handle)
{
    unit *u = unit_of(handle);
    if (!u || unit_require(u, 1u << UNIT_INITIALISING, "fmi3ExitInitializationMode") != UNIT_OK) return fmi3Error;
    if (unit_prepare(u) != UNIT_OK) return fmi3Error;
    u->mode = ((instance *)handle)->event_mode ? UNIT_AT_EVENT : UNIT_STEPPING;
    return fmi3OK;
}

static fmi3Status change_mode(fmi3Instance handle, unit_mode from, unit_mode to, const char *call)
{
    unit *u = unit_of(handle);
    if (!u || unit_require(u, 1u << from, call) != UNIT_OK) return fmi3Error;
    u->mode = to;
    return fmi3OK;
}

FUNCTION(fmi3Status, fmi3EnterEventMode, fmi3Instance handle)
{
    if (handle && !((instance *)handle)->event_mode) return refused(handle, "event mode, which was not asked for,");
    return change_mode(handle, UNIT_STEPPING, UNIT_AT_EVENT, "fmi3EnterEventMode");
}

FUNCTION(fmi3Status, fmi3EnterStepMode, fmi3Instance handle)
{
    return change_mode(handle, UNIT_AT_EVENT, UNIT_STEPPING, "fmi3EnterStepMode");
}

FUNCTION(fmi3Status, fmi3UpdateDiscreteStates, fmi3Instance handle, fmi3Boolean *needs_update, fmi3Boolean *terminate,
         fmi3Boolean *nominals_changed, fmi3Boolean *states_changed, fmi3Boolean *next_defined, fmi3Float64 *next)
{
    (void)next;
    unit *u = unit_of(handle);
    if (!u || unit_require(u, 1u << UNIT_AT_EVENT, "fmi3UpdateDiscreteStates") != UNIT_OK) return fmi3Error;
    fmi3Boolean *const answers[] = {needs_update, terminate, nominals_changed, states_changed, next_defined};
    for (size_t i = 0; i < sizeof answers / sizeof *answers; ++i)
        if (answers[i]) *answers[i] = false;
    return fmi3OK;
}

FUNCTION(fmi3Status, fmi3EvaluateDiscreteStates, fmi3Instance handle)
{
    return handle ? fmi3OK : fmi3Error;
}

FUNCTION(fmi3Status, fmi3Terminate, fmi3Instance handle)
{
    unit *u = unit_of(handle);
    if (!u || unit_require(u, 1u << UNIT_AT_EVENT | 1u << UNIT_STEPPING, "fmi3Terminate") != UNIT_OK) return fmi3Error;
    u->mode = UNIT_TERMINATED;
    return fmi3OK;
}

FUNCTION(fmi3Status, fmi3Reset, fmi3Instance handle)
{
    return handle ? (fmi3Status)unit_reset(unit_of(handle)) : fmi3Error;
}

/* ---- 4.2.1: steps -------------------------------------------------------------------------------------------------
 */
FUNCTION(fmi3Status, fmi3DoStep, fmi3Instance handle, fmi3Float64 time, fmi3Float64 length, fmi3Boolean no_going_back,
         fmi3Boolean *needs_event, fmi3Boolean *terminate, fmi3Boolean *early, fmi3Float64 *last_time)
{
    (void)no_going_back;
    const instance *of = handle;
    if (!of || !needs_event || !terminate || !early || !last_time) return fmi3Error;
    unit_reached reached = {time, 0};
    *needs_event = *terminate = *early = false;
    *last_time = time;
    if (!(length > 0.0)) {
        return (fmi3Status)unit_tell(of->u, UNIT_ERROR, "step refused: communication step size = %g s, must be > 0",
                                     length);
    }
    const unit_status status = unit_advance(of->u, time, length, of->early_return, &reached);
    if (status > UNIT_WARNING) return (fmi3Status)status;
    *needs_event = reached.at_event && of->event_mode;
    *early = reached.time < time + length;
    *last_time = reached.time;
    return (fmi3Status)status;
}

/* ---- 2.2.6: values ------------------------------------------------------------------------------------------------
 */
static fmi3Status counts_differ(fmi3Instance handle, size_t references, size_t values)
{
    unit_tell(unit_of(handle), UNIT_ERROR,
              "values refused: %zu for %zu value references, must be as many: all are scalars", values, references);
    return fmi3Error;
}

FUNCTION(fmi3Status, fmi3GetFloat64, fmi3Instance handle, const fmi3ValueReference references[], size_t count,
         fmi3Float64 values[], size_t value_count)
{
    if (!handle) return fmi3Error;
    if (count != value_count) return counts_differ(handle, count, value_count);
    return (fmi3Status)unit_get(unit_of(handle), references, count, values);
}

FUNCTION(fmi3Status, fmi3SetFloat64, fmi3Instance handle, const fmi3ValueReference references[], size_t count,
         const fmi3Float64 values[], size_t value_count)
{
    if (!handle) return fmi3Error;
    if (count != value_count) return counts_differ(handle, count, value_count);
    return (fmi3Status)unit_set(unit_of(handle), references, count, values);
}

FUNCTION(fmi3Status, fmi3GetInt32, fmi3Instance handle, const fmi3ValueReference references[], size_t count,
         fmi3Int32 values[], size_t value_count)
{
    if (!handle) return fmi3Error;
    if (count != value_count) return counts_differ(handle, count, value_count);
    return (fmi3Status)unit_get_counts(unit_of(handle), references, count, values);
}

/* ---- 2.2.8: states ------------------------------------------------------------------------------------------------
 */
FUNCTION(fmi3Status, fmi3GetFMUState, fmi3Instance handle, fmi3FMUState *state)
{
    return (fmi3Status)unit_state_get(unit_of(handle), state);
}

FUNCTION(fmi3Status, fmi3SetFMUState, fmi3Instance handle, fmi3FMUState state)
{
    return (fmi3Status)unit_state_set(unit_of(handle), state);
}

FUNCTION(fmi3Status, fmi3FreeFMUState, fmi3Instance handle, fmi3FMUState *state)
{
    return (fmi3Status)unit_state_free(unit_of(handle), state);
}

FUNCTION(fmi3Status, fmi3SerializedFMUStateSize, fmi3Instance handle, fmi3FMUState state, size_t *size)
{
    return (fmi3Status)unit_state_size(unit_of(handle), state, size);
}

FUNCTION(fmi3Status, fmi3SerializeFMUState, fmi3Instance handle, fmi3FMUState state, fmi3Byte bytes[], size_t size)
{
    return (fmi3Status)unit_state_write(unit_of(handle), state, bytes, size);
}

FUNCTION(fmi3Status, fmi3DeserializeFMUState, fmi3Instance handle, const fmi3Byte bytes[], size_t size,
         fmi3FMUState *state)
{
    return (fmi3Status)unit_state_read(unit_of(handle), bytes, size, state);
}

/* ---- 2.2.11: directional derivatives ------------------------------------------------------------------------------
 */
FUNCTION(fmi3Status, fmi3GetDirectionalDerivative, fmi3Instance handle, const fmi3ValueReference unknowns[],
         size_t unknown_count, const fmi3ValueReference knowns[], size_t known_count, const fmi3Float64 seed[],
         size_t seed_count, fmi3Float64 sensitivity[], size_t sensitivity_count)
{
    if (!handle) return fmi3Error;
    if (known_count != seed_count) return counts_differ(handle, known_count, seed_count);
    if (unknown_count != sensitivity_count) return counts_differ(handle, unknown_count, sensitivity_count);
    return (fmi3Status)unit_derivative(unit_of(handle), unknowns, unknown_count, knowns, known_count, seed,
                                       sensitivity);
}

#define FMI3_HAS_INTEGERS
#define FMI3_HAS_DERIVATIVES
#define FMI3_HAS_EVENTS
#define FMI3_HAS_STATES
#define FMI3_REFUSED(handle, call) refused((handle), (call))
#include "fmi3_not_offered.h"
