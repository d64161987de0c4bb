/* Options of a frequency response, checked. */
#ifndef DMB_ANALYSIS_RESPONSE_RESPONSE_OPTIONS_H
#define DMB_ANALYSIS_RESPONSE_RESPONSE_OPTIONS_H

#include "base/message.h"
#include "drillmbd/response.h"

enum { DMB_RESPONSE_INPUTS_MAX = 1024, DMB_STEPPED_SINE_HARMONICS_MAX = 16 };

/* Defaults overlaid with what is given (may be NULL); on refusal a message naming the field. */
int32_t dmb_response_options_take(const dmb_response_options *given, dmb_message *message, dmb_response_options *out);
/* Struct number i of the caller's array, whose items are as far apart as the first one says; its fields checked as far
 * as that needs no scene. */
int32_t dmb_input_take(const dmb_input *inputs, uint32_t i, dmb_message *message, dmb_input *out);
int32_t dmb_output_take(const dmb_output *outputs, uint32_t i, dmb_message *message, dmb_output *out);
/* Likewise of a stepped sine, at a frequency that is checked too. */
int32_t dmb_stepped_sine_options_take(const dmb_stepped_sine_options *given, double frequency, dmb_message *message,
                                      dmb_stepped_sine_options *out);
/* Frequency number i [Hz] of the grid. */
double dmb_response_grid(const dmb_response_options *options, uint32_t i);

#endif
