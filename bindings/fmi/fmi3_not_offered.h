/* Functions of FMI 3.0 that a unit does not offer: included once by the file that has those it does. That file defines
 * FUNCTION (declaration and head of an exported function) and FMI3_REFUSED(handle, call), the answer to a call by name,
 * a literal; FMI3_HAS_INTEGERS where it has fmi3GetInt32, FMI3_HAS_EVENTS where it has event mode, FMI3_HAS_STATES
 * where states can be saved, FMI3_HAS_DERIVATIVES where it has fmi3GetDirectionalDerivative. */
#include "fmi3_declarations.h"

/* ---- 4.2.1, 3.2.1, 5.2.1: instances of other kinds ------------------------------------------------------------------
 */
static fmi3Instance fmi3_other_kind(fmi3InstanceEnvironment environment, fmi3LogMessageCallback log)
{
    if (log)
        log(environment, fmi3Error, "logStatusError", "unit refused: it is one for co-simulation; instantiate it so");
    return NULL;
}

FUNCTION(fmi3Instance, fmi3InstantiateModelExchange, fmi3String name, fmi3String token, fmi3String resources,
         fmi3Boolean visible, fmi3Boolean logs, fmi3InstanceEnvironment environment, fmi3LogMessageCallback log)
{
    (void)name, (void)token, (void)resources, (void)visible, (void)logs;
    return fmi3_other_kind(environment, log);
}

FUNCTION(fmi3Instance, fmi3InstantiateScheduledExecution, fmi3String name, fmi3String token, fmi3String resources,
         fmi3Boolean visible, fmi3Boolean logs, fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
         fmi3ClockUpdateCallback clock, fmi3LockPreemptionCallback lock, fmi3UnlockPreemptionCallback unlock)
{
    (void)name, (void)token, (void)resources, (void)visible, (void)logs, (void)clock, (void)lock, (void)unlock;
    return fmi3_other_kind(environment, log);
}

/* No variables of these types: nothing can be asked but nothing. */
#define NO_VARIABLES(type)                                                                                        \
    FUNCTION(fmi3Status, fmi3Get##type, fmi3Instance handle, const fmi3ValueReference references[], size_t count, \
             fmi3##type values[], size_t value_count)                                                             \
    {                                                                                                             \
        (void)references, (void)values;                                                                           \
        return handle && count == 0 && value_count == 0 ? fmi3OK                                                  \
                                                        : FMI3_REFUSED(handle, "a variable of the type " #type);  \
    }                                                                                                             \
    NO_SETTING(type)
#define NO_SETTING(type)                                                                                          \
    FUNCTION(fmi3Status, fmi3Set##type, fmi3Instance handle, const fmi3ValueReference references[], size_t count, \
             const fmi3##type values[], size_t value_count)                                                       \
    {                                                                                                             \
        (void)references, (void)values;                                                                           \
        return handle && count == 0 && value_count == 0 ? fmi3OK                                                  \
                                                        : FMI3_REFUSED(handle, "an input of the type " #type);    \
    }
NO_VARIABLES(Float32)
NO_VARIABLES(Int8)
NO_VARIABLES(UInt8)
NO_VARIABLES(Int16)
NO_VARIABLES(UInt16)
#if defined(FMI3_HAS_INTEGERS)
NO_SETTING(Int32)
#else
NO_VARIABLES(Int32)
#endif
NO_VARIABLES(UInt32)
NO_VARIABLES(Int64)
NO_VARIABLES(UInt64)
NO_VARIABLES(Boolean)
NO_VARIABLES(String)

FUNCTION(fmi3Status, fmi3GetBinary, fmi3Instance handle, const fmi3ValueReference references[], size_t count,
         size_t sizes[], fmi3Binary values[], size_t value_count)
{
    (void)references, (void)sizes, (void)values;
    return handle && count == 0 && value_count == 0 ? fmi3OK : FMI3_REFUSED(handle, "a variable of the type Binary");
}

FUNCTION(fmi3Status, fmi3SetBinary, fmi3Instance handle, const fmi3ValueReference references[], size_t count,
         const size_t sizes[], const fmi3Binary values[], size_t value_count)
{
    (void)references, (void)sizes, (void)values;
    return handle && count == 0 && value_count == 0 ? fmi3OK : FMI3_REFUSED(handle, "an input of the type Binary");
}

FUNCTION(fmi3Status, fmi3GetClock, fmi3Instance handle, const fmi3ValueReference references[], size_t count,
         fmi3Clock values[])
{
    (void)references, (void)values;
    return handle && count == 0 ? fmi3OK : FMI3_REFUSED(handle, "a clock");
}

FUNCTION(fmi3Status, fmi3SetClock, fmi3Instance handle, const fmi3ValueReference references[], size_t count,
         const fmi3Clock values[])
{
    (void)references, (void)values;
    return handle && count == 0 ? fmi3OK : FMI3_REFUSED(handle, "a clock");
}

/* ---- Not offered, as modelDescription.xml says: 2.2.7, 2.2.9 .. 2.2.11, 2.3.4 -------------------------------------
 */
#define NOT_OFFERED(name, ...)                                   \
    FUNCTION(fmi3Status, name, fmi3Instance handle, __VA_ARGS__) \
    {                                                            \
        return FMI3_REFUSED(handle, #name);                      \
    }
#define REFERENCES const fmi3ValueReference references[], size_t count
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif
NOT_OFFERED(fmi3GetNumberOfVariableDependencies, fmi3ValueReference reference, size_t *count)
NOT_OFFERED(fmi3GetVariableDependencies, fmi3ValueReference dependent, size_t dependent_elements[],
            fmi3ValueReference independents[], size_t independent_elements[], fmi3DependencyKind kinds[], size_t count)
#ifndef FMI3_HAS_DERIVATIVES
NOT_OFFERED(fmi3GetDirectionalDerivative, REFERENCES, const fmi3ValueReference knowns[], size_t known_count,
            const fmi3Float64 seed[], size_t seed_count, fmi3Float64 sensitivity[], size_t sensitivity_count)
#endif
NOT_OFFERED(fmi3GetAdjointDerivative, REFERENCES, const fmi3ValueReference knowns[], size_t known_count,
            const fmi3Float64 seed[], size_t seed_count, fmi3Float64 sensitivity[], size_t sensitivity_count)
NOT_OFFERED(fmi3GetOutputDerivatives, REFERENCES, const fmi3Int32 orders[], fmi3Float64 values[], size_t value_count)
NOT_OFFERED(fmi3GetIntervalDecimal, REFERENCES, fmi3Float64 intervals[], fmi3IntervalQualifier qualifiers[])
NOT_OFFERED(fmi3GetIntervalFraction, REFERENCES, fmi3UInt64 counters[], fmi3UInt64 resolutions[],
            fmi3IntervalQualifier qualifiers[])
NOT_OFFERED(fmi3GetShiftDecimal, REFERENCES, fmi3Float64 shifts[])
NOT_OFFERED(fmi3GetShiftFraction, REFERENCES, fmi3UInt64 counters[], fmi3UInt64 resolutions[])
NOT_OFFERED(fmi3SetIntervalDecimal, REFERENCES, const fmi3Float64 intervals[])
NOT_OFFERED(fmi3SetIntervalFraction, REFERENCES, const fmi3UInt64 counters[], const fmi3UInt64 resolutions[])
NOT_OFFERED(fmi3SetShiftDecimal, REFERENCES, const fmi3Float64 shifts[])
NOT_OFFERED(fmi3SetShiftFraction, REFERENCES, const fmi3UInt64 counters[], const fmi3UInt64 resolutions[])
NOT_OFFERED(fmi3ActivateModelPartition, fmi3ValueReference clock, fmi3Float64 time)
NOT_OFFERED(fmi3SetTime, fmi3Float64 time)
NOT_OFFERED(fmi3SetContinuousStates, const fmi3Float64 states[], size_t count)
NOT_OFFERED(fmi3GetContinuousStates, fmi3Float64 states[], size_t count)
NOT_OFFERED(fmi3GetContinuousStateDerivatives, fmi3Float64 derivatives[], size_t count)
NOT_OFFERED(fmi3GetEventIndicators, fmi3Float64 indicators[], size_t count)
NOT_OFFERED(fmi3GetNominalsOfContinuousStates, fmi3Float64 nominals[], size_t count)
NOT_OFFERED(fmi3GetNumberOfEventIndicators, size_t *count)
NOT_OFFERED(fmi3GetNumberOfContinuousStates, size_t *count)
NOT_OFFERED(fmi3CompletedIntegratorStep, fmi3Boolean no_going_back, fmi3Boolean *enter_event_mode,
            fmi3Boolean *terminate)
FUNCTION(fmi3Status, fmi3EnterContinuousTimeMode, fmi3Instance handle)
{
    return FMI3_REFUSED(handle, "model exchange");
}
FUNCTION(fmi3Status, fmi3EnterConfigurationMode, fmi3Instance handle)
{
    return FMI3_REFUSED(handle, "configuration mode");
}
FUNCTION(fmi3Status, fmi3ExitConfigurationMode, fmi3Instance handle)
{
    return FMI3_REFUSED(handle, "configuration mode");
}

#if !defined(FMI3_HAS_EVENTS)
FUNCTION(fmi3Status, fmi3EnterEventMode, fmi3Instance handle)
{
    return FMI3_REFUSED(handle, "event mode");
}
FUNCTION(fmi3Status, fmi3EvaluateDiscreteStates, fmi3Instance handle)
{
    return FMI3_REFUSED(handle, "event mode");
}
NOT_OFFERED(fmi3UpdateDiscreteStates, fmi3Boolean *needs_update, fmi3Boolean *terminate, fmi3Boolean *nominals_changed,
            fmi3Boolean *states_changed, fmi3Boolean *next_defined, fmi3Float64 *next)
#endif
#if !defined(FMI3_HAS_STATES)
NOT_OFFERED(fmi3GetFMUState, fmi3FMUState *state)
NOT_OFFERED(fmi3SetFMUState, fmi3FMUState state)
NOT_OFFERED(fmi3FreeFMUState, fmi3FMUState *state)
NOT_OFFERED(fmi3SerializedFMUStateSize, fmi3FMUState state, size_t *size)
NOT_OFFERED(fmi3SerializeFMUState, fmi3FMUState state, fmi3Byte bytes[], size_t size)
NOT_OFFERED(fmi3DeserializeFMUState, const fmi3Byte bytes[], size_t size, fmi3FMUState *state)
#endif

#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif
#undef NOT_OFFERED
#undef REFERENCES
#undef NO_VARIABLES
#undef NO_SETTING
