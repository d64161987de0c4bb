/* The order of modes, and which of them are kept. */
#include <math.h>

#include "analysis/modes.h"

#define DMB_TWO_PI 6.283185307179586477

double dmb_modes_size(const dmb_modes *modes, uint32_t i)
{
    return hypot(modes->s[2 * (size_t)i], modes->s[2 * (size_t)i + 1]);
}

static void swap(double *a, double *b, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        const double kept = a[i];
        a[i] = b[i];
        b[i] = kept;
    }
}

void dmb_modes_exchange(dmb_modes *modes, uint32_t i, uint32_t j)
{
    const size_t rows = modes->rows;
    const uint8_t rigid = modes->rigid[i];
    modes->rigid[i] = modes->rigid[j];
    modes->rigid[j] = rigid;
    swap(modes->s + 2 * (size_t)i, modes->s + 2 * (size_t)j, 2);
    swap(modes->whirl + i, modes->whirl + j, 1);
    swap(modes->re + rows * i, modes->re + rows * j, rows);
    if (modes->im != NULL) swap(modes->im + rows * i, modes->im + rows * j, rows);
}

void dmb_modes_sort(dmb_modes *modes, uint32_t keep)
{
    for (uint32_t i = 0; i < modes->count && i < keep; i++) {
        uint32_t least = i;
        for (uint32_t j = i + 1; j < modes->count; j++)
            if (dmb_modes_size(modes, j) < dmb_modes_size(modes, least)) least = j;
        if (least != i) dmb_modes_exchange(modes, i, least);
    }
    if (modes->count > keep) modes->count = keep;
}

void dmb_modes_keep_band(dmb_modes *modes, double low, double high)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < modes->count; i++) {
        const double f = dmb_modes_size(modes, i) / DMB_TWO_PI;
        if (f < low || f > high) continue;
        if (kept != i) dmb_modes_exchange(modes, kept, i);
        kept++;
    }
    modes->count = kept;
}

int32_t dmb_modes_put_rigid(dmb_mode_search *search)
{
    dmb_modes *modes = search->modes;
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < search->rigid_count && status >= 0; i++) {
        status = dmb_modes_add(search, 0.0, 0.0, search->rigid + (size_t)modes->rows * i, NULL);
        if (status >= 0) modes->rigid[modes->count - 1] = 1;
    }
    return status;
}
