/* A speed controller as a unit of its own (FMI 3.0): u = clamp(kp e + I), I' = ki e, which stops while u is at its
 * limit. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fmi3_declarations.h"

#define FMI3_EXPORT __attribute__((visibility("default")))
#define FUNCTION(result, name, ...)       \
    FMI3_EXPORT result name(__VA_ARGS__); \
    result name(__VA_ARGS__)

enum { TIME, TARGET, MEASURED, TORQUE, GAIN, INTEGRAL_GAIN, LIMIT, INTEGRAL, VARIABLES }; /* value references */
typedef struct controller {
    double value[VARIABLES];
    fmi3InstanceEnvironment environment;
    fmi3LogMessageCallback log;
} controller;

static const double start[VARIABLES] = {0.0, 0.0, 0.0, 0.0, 40.0, 25.0, 3000.0, 0.0};

static fmi3Status refused(fmi3Instance handle, const char *call)
{
    const controller *c = handle;
    if (c && c->log) c->log(c->environment, fmi3Error, "logStatusError", call);
    return fmi3Error;
}

#define FMI3_REFUSED(handle, call) refused((handle), "call refused: " call " is not offered by this unit")
#include "fmi3_not_offered.h"

FUNCTION(const char *, fmi3GetVersion, void)
{
    return "3.0";
}

FUNCTION(fmi3Instance, fmi3InstantiateCoSimulation, fmi3String name, fmi3String token, fmi3String resources,
         fmi3Boolean visible, fmi3Boolean logs, fmi3Boolean event_mode, fmi3Boolean early_return,
         const fmi3ValueReference intermediate[], size_t intermediate_count, fmi3InstanceEnvironment environment,
         fmi3LogMessageCallback log, fmi3IntermediateUpdateCallback update)
{
    (void)name, (void)resources, (void)visible, (void)logs, (void)event_mode, (void)early_return;
    (void)intermediate, (void)intermediate_count, (void)update;
    if (!token || strcmp(token, "{speed-controller-1}") != 0) return NULL;
    controller *c = calloc(1, sizeof *c);
    if (!c) return NULL;
    memcpy(c->value, start, sizeof start);
    c->environment = environment;
    c->log = log;
    return c;
}

FUNCTION(void, fmi3FreeInstance, fmi3Instance handle)
{
    free(handle);
}

FUNCTION(fmi3Status, fmi3Reset, fmi3Instance handle)
{
    memcpy(((controller *)handle)->value, start, sizeof start);
    return fmi3OK;
}

FUNCTION(fmi3Status, fmi3EnterInitializationMode, fmi3Instance handle, fmi3Boolean has_tolerance, fmi3Float64 tolerance,
         fmi3Float64 time, fmi3Boolean has_stop, fmi3Float64 stop)
{
    (void)has_tolerance, (void)tolerance, (void)has_stop, (void)stop;
    ((controller *)handle)->value[TIME] = time;
    return fmi3OK;
}

#define NOTHING(name)                               \
    FUNCTION(fmi3Status, name, fmi3Instance handle) \
    {                                               \
        return handle ? fmi3OK : fmi3Error;         \
    }
NOTHING(fmi3ExitInitializationMode)
NOTHING(fmi3EnterStepMode)
NOTHING(fmi3Terminate)

FUNCTION(fmi3Status, fmi3SetDebugLogging, fmi3Instance handle, fmi3Boolean logs, size_t count,
         const fmi3String categories[])
{
    (void)logs, (void)count, (void)categories;
    return handle ? fmi3OK : fmi3Error;
}

FUNCTION(fmi3Status, fmi3GetFloat64, fmi3Instance handle, const fmi3ValueReference references[], size_t count,
         fmi3Float64 values[], size_t value_count)
{
    if (count != value_count) return refused(handle, "values refused: as many as value references are needed");
    for (size_t i = 0; i < count; ++i) {
        if (references[i] >= VARIABLES) return refused(handle, "value reference refused: must be 0 .. 7");
        values[i] = ((const controller *)handle)->value[references[i]];
    }
    return fmi3OK;
}

FUNCTION(fmi3Status, fmi3SetFloat64, fmi3Instance handle, const fmi3ValueReference references[], size_t count,
         const fmi3Float64 values[], size_t value_count)
{
    controller *c = handle;
    if (count != value_count) return refused(handle, "values refused: as many as value references are needed");
    for (size_t i = 0; i < count; ++i) {
        const int is_settable =
            references[i] == TARGET || references[i] == MEASURED || (references[i] >= GAIN && references[i] <= LIMIT);
        if (!is_settable) return refused(handle, "value reference refused: must be 1, 2 or 4 .. 6 to be set");
        if (!isfinite(values[i])) return refused(handle, "value refused: must be finite");
        c->value[references[i]] = values[i];
    }
    return fmi3OK;
}

/* One step of the controller by explicit Euler, whatever its length. */
FUNCTION(fmi3Status, fmi3DoStep, fmi3Instance handle, fmi3Float64 time, fmi3Float64 length, fmi3Boolean no_going_back,
         fmi3Boolean *needs_event, fmi3Boolean *terminate, fmi3Boolean *early, fmi3Float64 *last_time)
{
    (void)no_going_back;
    double *v = ((controller *)handle)->value;
    const double error = v[TARGET] - v[MEASURED], asked = v[GAIN] * error + v[INTEGRAL];
    v[TORQUE] = fmin(fmax(asked, -v[LIMIT]), v[LIMIT]);
    if (v[TORQUE] == asked) v[INTEGRAL] += v[INTEGRAL_GAIN] * error * length;
    *needs_event = *terminate = *early = false;
    *last_time = v[TIME] = time + length;
    return fmi3OK;
}
