/* The caller's log. Never used during a step. */
#ifndef DMB_BASE_LOG_H
#define DMB_BASE_LOG_H

#include "drillmbd/base.h"

typedef struct dmb_log {
    dmb_log_fn write; /* NULL: silent */
    void *context;
} dmb_log;

static inline void dmb_log_text(const dmb_log *log, int32_t level, const char *text)
{
    if (log->write != NULL) log->write(log->context, level, text);
}

#endif
