/* The values of a frequency response: storage by points, transfer functions, combined outputs. One table: frequencies
 * of all points, then for each point the complex transfer functions, excitation by excitation, output by output. */
#include "analysis/response/response.h"

#include <math.h>
#include <string.h>

#include "analysis/linear/linear.h"
#include "base/failure.h"
#include "base/memory.h"
#include "base/sized_struct.h"
#include "drillmbd/analyse.h"
#include "sim/access.h"

dmb_response *dmb_response_new(const dmb_allocator *allocator, uint32_t excitations, uint32_t outputs)
{
    dmb_response *response = dmb_allocate(allocator, sizeof *response);
    if (response == NULL) return NULL;
    response->magic = DMB_HANDLE_RESPONSE;
    response->excitations = excitations;
    response->outputs = outputs;
    response->allocator = *allocator;
    response->block_size = 2 * (size_t)excitations * sizeof(double) + outputs * sizeof(dmb_output);
    response->block = dmb_allocate(allocator, response->block_size);
    if (response->block == NULL) dmb_response_destroy(&response);
    if (response == NULL) return NULL;
    response->amplitude = response->block;
    response->phase = response->amplitude + excitations;
    response->output = (dmb_output *)(void *)(response->phase + excitations);
    return response;
}

/* Sizes: at most 1e6 points and those of refinement, 1024 excitations and outputs: below 2^63 bytes. */
int32_t dmb_response_resize(dmb_response *response, uint32_t points)
{
    const uint64_t numbers = (uint64_t)points * (1 + 2 * (uint64_t)response->excitations * response->outputs);
    if (numbers > SIZE_MAX / sizeof(double)) return DMB_ERR_NO_MEMORY;
    const size_t size = (size_t)numbers * sizeof(double);
    double *table = dmb_allocate(&response->allocator, size);
    if (table == NULL) return DMB_ERR_NO_MEMORY;
    response->table = table;
    response->table_size = size;
    response->points = points;
    response->frequency = table;
    response->value = table + points;
    return DMB_OK;
}

void dmb_response_destroy(dmb_response **response)
{
    if (response == NULL) return;
    dmb_response *found = *response;
    *response = NULL;
    if (!dmb_handle_is(found, DMB_HANDLE_RESPONSE)) return;
    const dmb_allocator allocator = found->allocator;
    found->magic = DMB_HANDLE_DEAD;
    if (found->table != NULL) dmb_release(&allocator, found->table, found->table_size);
    if (found->block != NULL) dmb_release(&allocator, found->block, found->block_size);
    dmb_release(&allocator, found, sizeof *found);
}

static int32_t ask(const dmb_response *response, const void *answer)
{
    if (response == NULL) return DMB_ERR_NULL;
    if (!dmb_handle_is(response, DMB_HANDLE_RESPONSE)) return DMB_ERR_HANDLE;
    return answer != NULL ? DMB_OK : DMB_ERR_NULL;
}

int32_t dmb_response_dimensions(const dmb_response *response, uint32_t dimensions[3])
{
    const int32_t status = ask(response, dimensions);
    if (status < 0) return dmb_failed("response", status);
    dimensions[0] = response->points;
    dimensions[1] = response->excitations;
    dimensions[2] = response->outputs;
    return DMB_OK;
}

int32_t dmb_response_frequencies(const dmb_response *response, double *frequencies)
{
    const int32_t status = ask(response, frequencies);
    if (status == DMB_OK) memcpy(frequencies, response->frequency, response->points * sizeof(double));
    return dmb_failed("response", status);
}

/* to += amplitude e^(i phase) value */
static void add_input(const dmb_response *response, size_t point, uint32_t input, uint32_t output, double to[2])
{
    const double *value = dmb_response_value(response, point, input) + 2 * (size_t)output;
    const double re = response->amplitude[input] * cos(response->phase[input]);
    const double im = response->amplitude[input] * sin(response->phase[input]);
    to[0] += re * value[0] - im * value[1];
    to[1] += re * value[1] + im * value[0];
}

/* Excitations superpose because the response is linear: sum of amplitude e^(i phase) times transfer function. */
void dmb_response_combined(const dmb_response *response, size_t point, uint32_t output, double value[2])
{
    value[0] = value[1] = 0.0;
    for (uint32_t i = 0; i < response->excitations; i++) add_input(response, point, i, output, value);
}

int32_t dmb_response_transfer(const dmb_response *response, uint32_t input, uint32_t output, double *values)
{
    const int32_t status = ask(response, values);
    if (status < 0) return dmb_failed("response", status);
    if (output >= response->outputs || (input >= response->excitations && input != DMB_COMBINED))
        return dmb_failed("response", DMB_ERR_VALUE);
    for (size_t point = 0; point < response->points; point++) {
        double *to = values + 2 * point;
        if (input != DMB_COMBINED)
            memcpy(to, dmb_response_value(response, point, input) + 2 * (size_t)output, 2 * sizeof(double));
        else
            dmb_response_combined(response, point, output, to);
    }
    return DMB_OK;
}
