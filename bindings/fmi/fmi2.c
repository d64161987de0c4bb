/* The functions of FMI 2.0 for co-simulation; sections are those of the standard. */
#include "fmi2_declarations.h"

#include <stdlib.h>
#include <string.h>

#include "unit.h"

#if defined(_WIN32)
#define FMI2_EXPORT __declspec(dllexport)
#else
#define FMI2_EXPORT __attribute__((visibility("default")))
#endif
/* Each function is declared before its definition, for compilers that ask for it. */
#define FUNCTION(result, name, ...)       \
    FMI2_EXPORT result name(__VA_ARGS__); \
    result name(__VA_ARGS__)

typedef struct component {
    unit *u;
    fmi2CallbackFunctions callbacks;
    char *name;
    double last_time; /* [s] that the last step reached */
} component;

static void forward(void *context, unit_status status, const char *category, const char *text)
{
    const component *of = context;
    const char *format = strchr(text, '%') ? "%s" : text; /* importers in Python print the format as it is */
    if (of->callbacks.logger)
        of->callbacks.logger(of->callbacks.componentEnvironment, of->name, (fmi2Status)status, category, format, text);
}

static unit *unit_of(fmi2Component handle)
{
    return handle ? ((component *)handle)->u : NULL;
}

static fmi2Status refused(fmi2Component handle, const char *call)
{
    unit *u = unit_of(handle);
    if (u) unit_tell(u, UNIT_ERROR, "call refused: %s is not offered by this unit; see modelDescription.xml", call);
    return fmi2Error;
}

/* ---- 2.1.4, 2.1.5: instances --------------------------------------------------------------------------------------
 */
FUNCTION(const char *, fmi2GetTypesPlatform, void)
{
    return "default";
}
FUNCTION(const char *, fmi2GetVersion, void)
{
    return "2.0";
}

static int hexadecimal(char digit)
{
    if (digit >= '0' && digit <= '9') return digit - '0';
    if (digit >= 'a' && digit <= 'f') return digit - 'a' + 10;
    return digit >= 'A' && digit <= 'F' ? digit - 'A' + 10 : -1;
}

/* The folder that a URI "file:///a%20b" or "file:/a" names; a plain path stays what it is. malloc. */
static char *folder_of(const char *uri)
{
    char *folder = malloc(strlen(uri) + 1u), *out = folder;
    if (!folder) return NULL;
    if (strncmp(uri, "file:", 5) == 0) {
        uri += 5;
        if (strncmp(uri, "//", 2) == 0) uri += 2;
        if (strncmp(uri, "localhost/", 10) == 0) uri += 9;
#if defined(_WIN32)
        if (uri[0] == '/' && uri[1] != 0 && uri[2] == ':') ++uri;
#endif
        for (; *uri; ++uri) {
            const int high = *uri == '%' ? hexadecimal(uri[1]) : -1, low = high >= 0 ? hexadecimal(uri[2]) : -1;
            *out++ = low >= 0 ? (char)(16 * high + low) : *uri;
            if (low >= 0) uri += 2;
        }
        *out = 0;
    } else {
        memcpy(folder, uri, strlen(uri) + 1u);
    }
    return folder;
}

static unit *open_unit(component *made, fmi2Type type, fmi2String token, fmi2String resources, int logs)
{
    if (type != fmi2CoSimulation || !resources) {
        forward(made, UNIT_ERROR, "logStatusError",
                resources ? "unit refused: it is one for co-simulation; instantiate it so"
                          : "unit refused: resource location is NULL, must be the folder of scene.bin");
        return NULL;
    }
    char *folder = folder_of(resources);
    unit *u = folder ? unit_create(folder, token, forward, made, logs) : NULL;
    free(folder);
    return u;
}

FUNCTION(void, fmi2FreeInstance, fmi2Component handle)
{
    component *of = handle;
    if (!of) return;
    unit_destroy(of->u);
    free(of->name);
    free(of);
}

FUNCTION(fmi2Component, fmi2Instantiate, fmi2String name, fmi2Type type, fmi2String token, fmi2String resources,
         const fmi2CallbackFunctions *callbacks, fmi2Boolean visible, fmi2Boolean logs)
{
    (void)visible;
    component *made = calloc(1, sizeof *made);
    if (!made) return NULL;
    if (callbacks) made->callbacks = *callbacks;
    const size_t length = strlen(name ? name : "") + 1u;
    made->name = malloc(length);
    if (made->name) {
        memcpy(made->name, name ? name : "", length);
        made->u = open_unit(made, type, token, resources, logs);
    }
    if (made->u) return made;
    fmi2FreeInstance(made);
    return NULL;
}

FUNCTION(fmi2Status, fmi2SetDebugLogging, fmi2Component handle, fmi2Boolean logs, size_t count,
         const fmi2String categories[])
{
    (void)count, (void)categories;
    if (!handle) return fmi2Error;
    unit_of(handle)->logs = logs;
    return fmi2OK;
}

/* ---- 2.1.6: modes -------------------------------------------------------------------------------------------------
 */
FUNCTION(fmi2Status, fmi2SetupExperiment, fmi2Component handle, fmi2Boolean has_tolerance, fmi2Real tolerance,
         fmi2Real start, fmi2Boolean has_stop, fmi2Real stop)
{
    (void)has_tolerance, (void)tolerance, (void)has_stop, (void)stop;
    unit *u = unit_of(handle);
    if (!u || unit_require(u, 1u << UNIT_INSTANTIATED, "fmi2SetupExperiment") != UNIT_OK) return fmi2Error;
    if (start == 0.0) return fmi2OK;
    return (fmi2Status)unit_tell(
        u, UNIT_ERROR, "start refused: start time = %g s, must be 0: time functions of the scene begin there", start);
}

FUNCTION(fmi2Status, fmi2EnterInitializationMode, fmi2Component handle)
{
    return handle ? (fmi2Status)unit_begin(unit_of(handle), 0.0) : fmi2Error;
}

FUNCTION(fmi2Status, fmi2ExitInitializationMode, fmi2Component handle)
{
    unit *u = unit_of(handle);
    if (!u || unit_require(u, 1u << UNIT_INITIALISING, "fmi2ExitInitializationMode") != UNIT_OK) return fmi2Error;
    if (unit_prepare(u) != UNIT_OK) return fmi2Error;
    u->mode = UNIT_STEPPING;
    return fmi2OK;
}

FUNCTION(fmi2Status, fmi2Terminate, fmi2Component handle)
{
    unit *u = unit_of(handle);
    if (!u || unit_require(u, 1u << UNIT_STEPPING, "fmi2Terminate") != UNIT_OK) return fmi2Error;
    u->mode = UNIT_TERMINATED;
    return fmi2OK;
}

FUNCTION(fmi2Status, fmi2Reset, fmi2Component handle)
{
    return handle ? (fmi2Status)unit_reset(unit_of(handle)) : fmi2Error;
}

/* ---- 4.2.2, 4.2.3: steps ------------------------------------------------------------------------------------------
 */
FUNCTION(fmi2Status, fmi2DoStep, fmi2Component handle, fmi2Real time, fmi2Real length, fmi2Boolean no_going_back)
{
    (void)no_going_back;
    component *of = handle;
    unit_reached reached = {time, 0};
    if (!of) return fmi2Error;
    const unit_status status = unit_advance(of->u, time, length, 0, &reached);
    if (status <= UNIT_WARNING) of->last_time = reached.time;
    return (fmi2Status)status;
}

FUNCTION(fmi2Status, fmi2CancelStep, fmi2Component handle)
{
    return refused(handle, "an asynchronous step");
}

FUNCTION(fmi2Status, fmi2GetStatus, fmi2Component handle, fmi2StatusKind kind, fmi2Status *value)
{
    (void)kind, (void)value;
    return handle ? fmi2Discard : fmi2Error; /* steps are not asynchronous: 4.2.3 */
}

FUNCTION(fmi2Status, fmi2GetRealStatus, fmi2Component handle, fmi2StatusKind kind, fmi2Real *value)
{
    const component *of = handle;
    if (!of || !value) return fmi2Error;
    if (kind != fmi2LastSuccessfulTime) return fmi2Discard;
    *value = of->last_time;
    return fmi2OK;
}

FUNCTION(fmi2Status, fmi2GetIntegerStatus, fmi2Component handle, fmi2StatusKind kind, fmi2Integer *value)
{
    (void)kind, (void)value;
    return handle ? fmi2Discard : fmi2Error;
}

FUNCTION(fmi2Status, fmi2GetBooleanStatus, fmi2Component handle, fmi2StatusKind kind, fmi2Boolean *value)
{
    if (!handle || !value) return fmi2Error;
    if (kind != fmi2Terminated) return fmi2Discard;
    *value = 0;
    return fmi2OK;
}

FUNCTION(fmi2Status, fmi2GetStringStatus, fmi2Component handle, fmi2StatusKind kind, fmi2String *value)
{
    (void)kind, (void)value;
    return handle ? fmi2Discard : fmi2Error;
}

/* ---- 2.1.7: values ------------------------------------------------------------------------------------------------
 */
FUNCTION(fmi2Status, fmi2GetReal, fmi2Component handle, const fmi2ValueReference references[], size_t count,
         fmi2Real values[])
{
    return handle ? (fmi2Status)unit_get(unit_of(handle), references, count, values) : fmi2Error;
}

FUNCTION(fmi2Status, fmi2SetReal, fmi2Component handle, const fmi2ValueReference references[], size_t count,
         const fmi2Real values[])
{
    return handle ? (fmi2Status)unit_set(unit_of(handle), references, count, values) : fmi2Error;
}

FUNCTION(fmi2Status, fmi2GetInteger, fmi2Component handle, const fmi2ValueReference references[], size_t count,
         fmi2Integer values[])
{
    return handle ? (fmi2Status)unit_get_counts(unit_of(handle), references, count, values) : fmi2Error;
}

/* The unit has no variables of the other types: nothing can be asked but nothing. */
#define NO_VARIABLES(name, type)                                                                          \
    FUNCTION(fmi2Status, name, fmi2Component handle, const fmi2ValueReference references[], size_t count, \
             type values[])                                                                               \
    {                                                                                                     \
        (void)references, (void)values;                                                                   \
        return handle && count == 0 ? fmi2OK : refused(handle, #name);                                    \
    }
NO_VARIABLES(fmi2SetInteger, const fmi2Integer)
NO_VARIABLES(fmi2GetBoolean, fmi2Boolean)
NO_VARIABLES(fmi2SetBoolean, const fmi2Boolean)
NO_VARIABLES(fmi2GetString, fmi2String)
NO_VARIABLES(fmi2SetString, const fmi2String)

/* ---- 2.1.8: states ------------------------------------------------------------------------------------------------
 */
FUNCTION(fmi2Status, fmi2GetFMUstate, fmi2Component handle, fmi2FMUstate *state)
{
    return (fmi2Status)unit_state_get(unit_of(handle), state);
}

FUNCTION(fmi2Status, fmi2SetFMUstate, fmi2Component handle, fmi2FMUstate state)
{
    return (fmi2Status)unit_state_set(unit_of(handle), state);
}

FUNCTION(fmi2Status, fmi2FreeFMUstate, fmi2Component handle, fmi2FMUstate *state)
{
    return (fmi2Status)unit_state_free(unit_of(handle), state);
}

FUNCTION(fmi2Status, fmi2SerializedFMUstateSize, fmi2Component handle, fmi2FMUstate state, size_t *size)
{
    return (fmi2Status)unit_state_size(unit_of(handle), state, size);
}

FUNCTION(fmi2Status, fmi2SerializeFMUstate, fmi2Component handle, fmi2FMUstate state, fmi2Byte bytes[], size_t size)
{
    return (fmi2Status)unit_state_write(unit_of(handle), state, bytes, size);
}

FUNCTION(fmi2Status, fmi2DeSerializeFMUstate, fmi2Component handle, const fmi2Byte bytes[], size_t size,
         fmi2FMUstate *state)
{
    return (fmi2Status)unit_state_read(unit_of(handle), bytes, size, state);
}

/* ---- 2.1.9: directional derivatives ---------------------------------------------------------------------------------
 */
FUNCTION(fmi2Status, fmi2GetDirectionalDerivative, fmi2Component handle, const fmi2ValueReference unknowns[],
         size_t unknown_count, const fmi2ValueReference knowns[], size_t known_count, const fmi2Real seed[],
         fmi2Real sensitivity[])
{
    if (!handle) return fmi2Error;
    return (fmi2Status)unit_derivative(unit_of(handle), unknowns, unknown_count, knowns, known_count, seed,
                                       sensitivity);
}

/* ---- Not offered, as modelDescription.xml says: 4.2.1 ---------------------------------------------------------------
 */
FUNCTION(fmi2Status, fmi2SetRealInputDerivatives, fmi2Component handle, const fmi2ValueReference references[],
         size_t count, const fmi2Integer orders[], const fmi2Real values[])
{
    (void)references, (void)count, (void)orders, (void)values;
    return refused(handle, "fmi2SetRealInputDerivatives");
}

FUNCTION(fmi2Status, fmi2GetRealOutputDerivatives, fmi2Component handle, const fmi2ValueReference references[],
         size_t count, const fmi2Integer orders[], fmi2Real values[])
{
    (void)references, (void)count, (void)orders, (void)values;
    return refused(handle, "fmi2GetRealOutputDerivatives");
}
