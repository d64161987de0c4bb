/* Types of the Functional Mock-up Interface 2.0 that the unit needs, written from the standard's text: base types from
 * section 2.1.2, status from 2.1.3, callbacks from 2.1.5, status of a step from 4.2.3. */
#ifndef DMB_FMI_FMI2_DECLARATIONS_H
#define DMB_FMI_FMI2_DECLARATIONS_H

#include <stddef.h>

typedef void *fmi2Component; /* 2.1.2: handles and base types */
typedef void *fmi2ComponentEnvironment;
typedef void *fmi2FMUstate;
typedef unsigned int fmi2ValueReference;
typedef double fmi2Real;
typedef int fmi2Integer;
typedef int fmi2Boolean; /* 0 or 1 */
typedef char fmi2Char;
typedef const fmi2Char *fmi2String;
typedef char fmi2Byte;

typedef enum fmi2Status { /* 2.1.3 */
                          fmi2OK,
                          fmi2Warning,
                          fmi2Discard,
                          fmi2Error,
                          fmi2Fatal,
                          fmi2Pending
} fmi2Status;
typedef enum fmi2Type { /* 2.1.5 */
                        fmi2ModelExchange,
                        fmi2CoSimulation
} fmi2Type;
typedef enum fmi2StatusKind { /* 4.2.3 */
                              fmi2DoStepStatus,
                              fmi2PendingStatus,
                              fmi2LastSuccessfulTime,
                              fmi2Terminated
} fmi2StatusKind;

typedef struct fmi2CallbackFunctions { /* 2.1.5 */
    void (*logger)(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category,
                   fmi2String message, ...);
    void *(*allocateMemory)(size_t count, size_t size);
    void (*freeMemory)(void *block);
    void (*stepFinished)(fmi2ComponentEnvironment environment, fmi2Status status);
    fmi2ComponentEnvironment componentEnvironment;
} fmi2CallbackFunctions;

#endif
