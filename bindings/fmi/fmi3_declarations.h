/* Types of the Functional Mock-up Interface 3.0 that the unit needs, written from the standard's text: base types from
 * section 2.2.2, status from 2.2.3, callbacks and common functions from 2.2 and 2.3, co-simulation from 4.2. */
#ifndef DMB_FMI_FMI3_DECLARATIONS_H
#define DMB_FMI_FMI3_DECLARATIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef void *fmi3Instance;            /* 2.2.2: handles and base types */
typedef void *fmi3InstanceEnvironment; /* of the importer, handed back to its callbacks */
typedef void *fmi3FMUState;
typedef uint32_t fmi3ValueReference;
typedef float fmi3Float32;
typedef double fmi3Float64;
typedef int8_t fmi3Int8;
typedef uint8_t fmi3UInt8;
typedef int16_t fmi3Int16;
typedef uint16_t fmi3UInt16;
typedef int32_t fmi3Int32;
typedef uint32_t fmi3UInt32;
typedef int64_t fmi3Int64;
typedef uint64_t fmi3UInt64;
typedef bool fmi3Boolean;
typedef char fmi3Char;
typedef const fmi3Char *fmi3String;
typedef uint8_t fmi3Byte;
typedef const fmi3Byte *fmi3Binary;
typedef bool fmi3Clock;

typedef enum fmi3Status { /* 2.2.3 */
                          fmi3OK,
                          fmi3Warning,
                          fmi3Discard,
                          fmi3Error,
                          fmi3Fatal
} fmi3Status;
typedef enum fmi3DependencyKind { /* 2.2.10 */
                                  fmi3Independent,
                                  fmi3Constant,
                                  fmi3Fixed,
                                  fmi3Tunable,
                                  fmi3Discrete,
                                  fmi3Dependent
} fmi3DependencyKind;
typedef enum fmi3IntervalQualifier { /* 2.2.9 */
                                     fmi3IntervalNotYetKnown,
                                     fmi3IntervalUnchanged,
                                     fmi3IntervalChanged
} fmi3IntervalQualifier;

/* 2.3.1 and 4.2.2: callbacks that the importer gives at instantiation */
typedef void (*fmi3LogMessageCallback)(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category,
                                       fmi3String message);
typedef void (*fmi3ClockUpdateCallback)(fmi3InstanceEnvironment environment);
typedef void (*fmi3IntermediateUpdateCallback)(fmi3InstanceEnvironment environment, fmi3Float64 time,
                                               fmi3Boolean wants_inputs, fmi3Boolean has_outputs,
                                               fmi3Boolean is_finished, fmi3Boolean can_return_early,
                                               fmi3Boolean *early_return_requested, fmi3Float64 *early_return_time);
typedef void (*fmi3LockPreemptionCallback)(void);
typedef void (*fmi3UnlockPreemptionCallback)(void);

#endif
