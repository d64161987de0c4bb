#include "model/create_message.h"

typedef struct create_failure {
    uint32_t stamp; /* of the model; 0: no failure. No two models of a process have the same */
    dmb_message message;
} create_failure;

/* The only memory of the library outside its objects beside the stamp: a slot in the model would be written by one
 * thread while another one reads it. */
static _Thread_local create_failure last_failure;

void dmb_create_message_set(const dmb_model *model, const char *text)
{
    last_failure.stamp = model->stamp;
    dmb_message_set(&last_failure.message, "%s", text);
}

void dmb_create_message_clear(const dmb_model *model)
{
    if (last_failure.stamp == model->stamp) last_failure.stamp = 0;
}

const char *dmb_create_message(const dmb_model *model)
{
    return last_failure.stamp == model->stamp ? last_failure.message.text : NULL;
}
