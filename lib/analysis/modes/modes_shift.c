/* The shift with which a search for modes begins, and the choice of the dense method. */

#include <math.h>

#include "analysis/modes/modes.h"

/* The dense method is faster up to so many coordinates, or if a third of all modes is requested. */
enum { DMB_DENSE_COORDINATES = 60, DMB_DENSE_SHARE = 3 };

enum { DMB_SCALE_MODES = 12 };

/* Shift of a singular K that cannot be pinned, in multiples of the rounding level of its eigenvalues. */
#define DMB_SHIFT_NOISE 1e5

int dmb_modes_is_dense(const dmb_mode_search *search, uint32_t wanted)
{
    const uint32_t n = search->linear->coordinates;
    return n <= DMB_DENSE_COORDINATES || wanted > n / DMB_DENSE_SHARE;
}

/* Scale of the lowest modes by an iteration with a shift that is certainly small, and therefore inaccurate: the lowest
 * |s|^2 [1/s2] above the rounding level, or 0. */
static int32_t find_scale(dmb_mode_search *search, double *square)
{
    const uint32_t n = search->linear->coordinates;
    const double away = DMB_SHIFT_NOISE * search->noise;
    search->shift = search->general ? sqrt(away) : -away;
    *square = 0.0;
    search->partly = 1; /* the lowest mode is sufficient */
    const int32_t status = dmb_modes_sparse(search, n < DMB_SCALE_MODES ? n : DMB_SCALE_MODES);
    search->partly = 0;
    for (uint32_t i = 0; i < search->modes->count && status >= 0; i++) {
        const double here = dmb_modes_size(search->modes, i) * dmb_modes_size(search->modes, i);
        if (here > DMB_RIGID_NOISE * search->noise && (*square == 0.0 || here < *square)) *square = here;
    }
    search->modes->count = 0;
    return status;
}

/* The shift has the distance of the lowest nonzero eigenvalue from 0. */
int32_t dmb_modes_choose_shift(dmb_mode_search *search)
{
    double square;
    int32_t status = DMB_OK;
    search->shift = 0.0;
    if (search->apart) {
        status = dmb_modes_pin(search);
        if (status < 0 || search->pinned) return status;
    } else {
        dmb_block_weakest weakest = {(double)INFINITY, 0, 0};
        const int64_t bad = dmb_linear_factor(search->linear, 1.0, 0.0, 0.0, &weakest);
        if (bad < 0 && !(weakest.ratio < DMB_UNCONSTRAINED_PIVOT) && search->rigid_count == 0) return DMB_OK;
    }
    if (dmb_modes_is_dense(search, search->options->count)) return DMB_OK;
    status = find_scale(search, &square);
    if (status >= 0 && square > 0.0) search->shift = search->general ? sqrt(square) : -square;
    return status;
}
