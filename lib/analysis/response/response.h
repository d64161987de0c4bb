/* Result of dmb_analysis_response. */
#ifndef DMB_ANALYSIS_RESPONSE_RESPONSE_H
#define DMB_ANALYSIS_RESPONSE_RESPONSE_H

#include "drillmbd/response.h"

struct dmb_response {
    uint32_t magic;
    uint32_t points, inputs, outputs;
    int32_t undamped; /* 1: no structural damping, and no motion meets a damping force */
    int32_t reserved;
    dmb_allocator allocator;
    double *amplitude, *phase; /* shape (inputs) */
    double *frequency;         /* [Hz] shape (points) */
    double *value;             /* real and imaginary parts, shape (points, inputs, outputs, 2) */
    void *block;               /* amplitude, phase */
    size_t block_size;
    void *table; /* frequency, value */
    size_t table_size;
};

/* Without points; NULL if there is no memory. */
dmb_response *dmb_response_new(const dmb_allocator *allocator, uint32_t inputs, uint32_t outputs);
/* A table of that many points, its numbers not written, in place of what the response has, which the caller gives back
 * with dmb_release. DMB_OK or DMB_ERR_NO_MEMORY, which changes nothing. */
int32_t dmb_response_resize(dmb_response *response, uint32_t points);

/* Output at a point for all inputs with their amplitudes and phases. */
void dmb_response_combined(const dmb_response *response, size_t point, uint32_t output, double value[2]);

/* Real and imaginary parts of the first output of an input at a point; outputs follow. */
static inline double *dmb_response_value(const dmb_response *response, size_t point, size_t input)
{
    return response->value + 2 * response->outputs * (response->inputs * point + input);
}

#endif
