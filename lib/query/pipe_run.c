#include "query/pipe_run.h"

#include <stddef.h>

const dmb_pipe_run *dmb_pipe_run_of(const dmb_model *model, uint32_t string, uint32_t pipe)
{
    const dmb_pipe_run *runs = model->runs.items;
    for (uint32_t i = 0; i < model->runs.count; i++) {
        if (runs[i].string == string && pipe >= runs[i].first && pipe - runs[i].first < runs[i].count) return &runs[i];
    }
    return NULL;
}
