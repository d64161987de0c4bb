/* Options of the static start, checked. */
#ifndef DMB_ANALYSIS_STATIC_OPTIONS_H
#define DMB_ANALYSIS_STATIC_OPTIONS_H

#include "state.h"

/* Defaults overlaid with what is given (may be NULL); on refusal a message naming the field. */
int32_t dmb_static_options_take(dmb_sim *sim, const dmb_static_options *given, dmb_static_options *out);

#endif
