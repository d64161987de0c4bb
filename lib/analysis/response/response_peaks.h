/* More points where transfer functions have peaks. */
#ifndef DMB_ANALYSIS_RESPONSE_RESPONSE_PEAKS_H
#define DMB_ANALYSIS_RESPONSE_RESPONSE_PEAKS_H

#include "analysis/response/response.h"

/* Puts a point into the middle of every interval beside a peak of the magnitude of a transfer function. *fresh, shape
 * (points), 1 where the point is new and only its frequency is written; the caller gives it back with dmb_release, NULL
 * where there is nothing new. DMB_OK or DMB_ERR_NO_MEMORY. */
int32_t dmb_response_split_peaks(dmb_response *response, uint8_t **fresh);

#endif
