/* The last call that failed, of each thread, as data and as text. It is written where a public call fails and by
 * nothing else, so that a call that succeeds costs nothing; it is the thread's own, so that questions to one sim from
 * several threads do not race. */
#ifndef DMB_BASE_FAILURE_H
#define DMB_BASE_FAILURE_H

#include <stdint.h>

#include "base/message.h"

/* The object whose call failed. serial tells it from an earlier one at its address, and a call from later ones. */
typedef struct dmb_failed_object {
    const void *object; /* NULL: none of which a message could be asked */
    uint64_t serial;
} dmb_failed_object;

/* The caller's function that sees each failing call; NULL: none. */
typedef struct dmb_error_handler {
    dmb_error_fn function;
    void *context;
} dmb_error_handler;

/* Numbers of a value that was refused, known where the message is written: kept until a call fails with that text. */
typedef struct dmb_refused_number {
    double value, low, high; /* low, high: NaN where the bound is no range */
} dmb_refused_number;
void dmb_failure_note(const dmb_message *message, const dmb_refused_number *number);

/* A public call of `of` (NULL: of no model or sim) fails: its error is the last one of the thread, and the handler
 * (NULL: none) sees it. text NULL or empty: that of the status, after "<call>: ". Returns status. */
int32_t dmb_failure(const dmb_failed_object *of, const dmb_error_handler *handler, int32_t status, const char *call,
                    const char *text);
/* The same of an object that has no message of its own. Passes on what is no failure. */
static inline int32_t dmb_failed(const char *call, int32_t status)
{
    return status >= 0 ? status : dmb_failure(NULL, NULL, status, call, NULL);
}
/* The message of the last failing call if it was one of `of`; else NULL. */
const char *dmb_failure_text(const dmb_failed_object *of);
/* From now on the last failure is none of this object; dmb_last_error still tells it. */
void dmb_failure_forget(const dmb_failed_object *of);

#endif
