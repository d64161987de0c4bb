/* Parts that were refused. A caller who overlooks a refusal would compile another scene than the one described, so the
 * model remembers each until it is added after all or the caller lets it go. */
#ifndef DMB_MODEL_REFUSED_H
#define DMB_MODEL_REFUSED_H

#include <stddef.h>
#include <stdint.h>

#include "base/message.h"

/* Of the first ones all is known; of more only the number. */
enum { DMB_REFUSED_KEPT = 8, DMB_REFUSED_BYTES = 768 };

typedef struct dmb_refusal {
    const char *part; /* the kind: "body", "pipes", ... */
    int32_t status;
    uint32_t count; /* of pipes or terms, 1 of other parts */
    size_t size;    /* [byte] of the definition; 0: it could not be read, or there is one such part a model */
    dmb_message message;
    unsigned char definition[DMB_REFUSED_BYTES]; /* as it was read */
} dmb_refusal;

typedef struct dmb_refusals {
    uint32_t kept;    /* in first, oldest first */
    uint32_t further; /* beyond those */
    dmb_refusal first[DMB_REFUSED_KEPT];
} dmb_refusals;

/* One call that adds a part: its kind, what it was given, how it ended. */
typedef struct dmb_described {
    const char *part;
    const void *definition; /* NULL with size 0: one such part a model */
    size_t size;
    uint32_t count;
} dmb_described;

void dmb_refused_remember(dmb_refusals *refused, const dmb_described *given, int32_t status,
                          const dmb_message *message);
/* The part was added: the oldest refusal of the same part is forgotten. It is the same part if both definitions have
 * the same name; without names, if they differ in no more than one field. */
void dmb_refused_added(dmb_refusals *refused, const dmb_described *given);
/* DMB_OK, or the status and the message of the oldest refusal. */
int32_t dmb_refused_check(const dmb_refusals *refused, dmb_message *message);

#endif
