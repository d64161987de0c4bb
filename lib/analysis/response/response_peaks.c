/* More points where transfer functions have peaks. */
#include <math.h>
#include <string.h>

#include "analysis/response/response.h"
#include "base/memory.h"

/* [-] Values below this fraction of a function's largest magnitude are rounding and have no peaks. */
#define DMB_PEAK_FLOOR 1e-10
/* [-] Smallest interval over its frequency that is divided. */
#define DMB_PEAK_WIDTH 1e-12

static double magnitude(const dmb_response *response, size_t point, size_t pair)
{
    const double *value = dmb_response_value(response, point, 0) + 2 * pair;
    return hypot(value[0], value[1]);
}

/* Marks the intervals i, i + 1 on both sides of each inner maximum; a plateau has none. */
static void mark_pair(const dmb_response *response, size_t pair, uint8_t *split)
{
    const size_t n = response->points;
    double largest = 0.0;
    for (size_t i = 0; i < n; i++) largest = fmax(largest, magnitude(response, i, pair));
    for (size_t i = 1; i + 1 < n; i++) {
        const double here = magnitude(response, i, pair);
        if (!(here > DMB_PEAK_FLOOR * largest)) continue;
        if (here > magnitude(response, i - 1, pair) && here >= magnitude(response, i + 1, pair))
            split[i - 1] = split[i] = 1;
    }
}

static uint32_t mark(const dmb_response *response, uint8_t *split)
{
    const size_t pairs = (size_t)response->excitations * response->outputs;
    const double *f = response->frequency;
    uint32_t count = 0;
    for (size_t k = 0; k < pairs; k++) mark_pair(response, k, split);
    for (size_t i = 0; i + 1 < response->points; i++) {
        if (!(f[i + 1] - f[i] > DMB_PEAK_WIDTH * f[i + 1])) split[i] = 0;
        count += split[i];
    }
    return count;
}

/* Table with the old points and a new one in the middle of each marked interval, whose value is left to the caller. */
static void merge(const dmb_response *old, const uint8_t *split, dmb_response *response, uint8_t *fresh)
{
    const size_t stride = 2 * (size_t)old->excitations * old->outputs;
    size_t to = 0;
    for (size_t i = 0; i < old->points; i++) {
        response->frequency[to] = old->frequency[i];
        memcpy(response->value + stride * to++, old->value + stride * i, stride * sizeof(double));
        if (i + 1 == old->points || !split[i]) continue;
        response->frequency[to] = 0.5 * (old->frequency[i] + old->frequency[i + 1]);
        fresh[to++] = 1;
    }
}

/* A failure leaves the response as it was. */
int32_t dmb_response_split_peaks(dmb_response *response, uint8_t **fresh)
{
    const dmb_response old = *response;
    uint8_t *split = dmb_allocate(&old.allocator, old.points);
    *fresh = NULL;
    if (split == NULL) return DMB_ERR_NO_MEMORY;
    const uint32_t added = mark(response, split);
    int32_t status = DMB_OK;
    if (added > 0) {
        *fresh = dmb_allocate(&old.allocator, old.points + added);
        status = *fresh == NULL ? DMB_ERR_NO_MEMORY : dmb_response_resize(response, old.points + added);
        if (status == DMB_OK) {
            merge(&old, split, response, *fresh);
            dmb_release(&old.allocator, old.table, old.table_size);
        } else if (*fresh != NULL) {
            dmb_release(&old.allocator, *fresh, old.points + added);
            *fresh = NULL;
        }
    }
    dmb_release(&old.allocator, split, old.points);
    return status;
}
