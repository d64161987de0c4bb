/* Why the last dmb_sim_create of a model failed. Threads share a compiled model, which never changes then, so each
 * thread has the reason of its own last failure. */
#ifndef DMB_MODEL_CREATE_MESSAGE_H
#define DMB_MODEL_CREATE_MESSAGE_H

#include "model/model.h"

/* In the calling thread, until the next create or description of the model there. */
void dmb_create_message_set(const dmb_model *model, const char *text);
void dmb_create_message_clear(const dmb_model *model);
/* NULL: none of this model in this thread. */
const char *dmb_create_message(const dmb_model *model);

#endif
