/* Outputs of a stepped sine, asked at one instant. */
#ifndef DMB_ANALYSIS_RESPONSE_STEPPED_SINE_H
#define DMB_ANALYSIS_RESPONSE_STEPPED_SINE_H

#include "drillmbd/response.h"

typedef struct dmb_stepped_sine_output {
    dmb_output output;
    double start[9]; /* [-] axes of the place at the call, columns, world */
} dmb_stepped_sine_output;

/* Takes the pose of the call. Errors: those of the queries. */
int32_t dmb_stepped_sine_output_begin(const dmb_sim *sim, dmb_stepped_sine_output *output);
/* Value now, of an output that has begun. */
double dmb_stepped_sine_sample(const dmb_sim *sim, const dmb_stepped_sine_output *output);

#endif
