/* The description behind a pipe of a compiled string. */
#ifndef DMB_QUERY_PIPE_RUN_H
#define DMB_QUERY_PIPE_RUN_H

#include "model/model.h"

/* The call of dmb_model_add_pipes that made a pipe; NULL if there is none. O(number of such calls). */
const dmb_pipe_run *dmb_pipe_run_of(const dmb_model *model, uint32_t string, uint32_t pipe);

#endif
