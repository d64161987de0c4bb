/* Inputs as described. */
#ifndef DMB_MODEL_DESCRIBE_CONTROL_H
#define DMB_MODEL_DESCRIBE_CONTROL_H

#include "drillmbd/control.h"

/* Bounds in force: the narrower of the input's own and those of its target. */
double dmb_input_low(const dmb_input_def *def);
double dmb_input_high(const dmb_input_def *def);
/* 1: it stands in the place of a programme, and may be on its way. */
int dmb_input_is_programme(int32_t target);

#endif
