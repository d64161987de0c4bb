/* A recorder as the caller filled it, checked. */
#ifndef DMB_OUTPUT_RECORDER_H
#define DMB_OUTPUT_RECORDER_H

#include "drillmbd/query.h"

/* Copies the caller's struct. Errors: DMB_ERR_NULL, _STRUCT_SIZE, _NOT_FINITE, _VALUE. */
int32_t dmb_recorder_take_struct(dmb_recorder *out, const dmb_recorder *given);

#endif
