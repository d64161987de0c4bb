/* What the queries answer now, for outputs of a response. */
#ifndef DMB_ANALYSIS_ANSWER_H
#define DMB_ANALYSIS_ANSWER_H

#include "drillmbd/response.h"

/* The value of an output of any kind but DMB_OUTPUT_DISPLACEMENT, which depends on where it is counted from. *status:
 * errors of the query. */
double dmb_answer_of(const dmb_sim *sim, const dmb_output *output, int32_t *status);

#endif
