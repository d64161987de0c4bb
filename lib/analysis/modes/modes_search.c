/* Choice of the modes that are sought, and of the method. */
#include <float.h>
#include <math.h>

#include "analysis/modes/modes.h"
#include "math/real.h"

/* Up to so many coordinates, or where a third of all modes is asked for, the dense way is the faster one. */
enum { DMB_DENSE_COORDINATES = 60, DMB_DENSE_SHARE = 3 };
enum { DMB_SCALE_MODES = 12 };
/* A band of more modes is divided. Damped roots stand in a plane, where many pieces make one search. */
enum { DMB_BAND_AT_ONCE = 64, DMB_ROOTS_AT_ONCE = 256, DMB_ROOTS_BY_STRIP = 32 };
/* The last of the modes wanted is left out of the count, with those equal to it; a count that does not fit is tried
 * again. */
#define DMB_COUNT_MARGIN 1e-6
#define DMB_COUNT_NOISE 64.0
enum { DMB_COUNT_TRIES = 3 };
/* The inverse of a singular K that cannot be pinned is taken this many times the noise of its eigenvalues off 0. */
#define DMB_SHIFT_NOISE 1e5

static int is_dense(const dmb_mode_search *search, uint32_t wanted)
{
    const uint32_t n = search->linear->coordinates;
    return search->options->select == DMB_MODES_ALL || n <= DMB_DENSE_COORDINATES || wanted > n / DMB_DENSE_SHARE;
}

/* Rigid-body motions are apart where K is symmetric and no damping feels them. */
static int32_t set_rigid_apart(dmb_mode_search *search)
{
    const int32_t status = dmb_modes_find_rigid(search);
    if (status < 0 || search->rigid_count == 0) return status;
    search->apart = search->modes->info.asymmetry <= DMB_MODES_ASYMMETRY &&
                    (search->options->kind == DMB_MODES_UNDAMPED || dmb_modes_rigid_undamped(search));
    return DMB_OK;
}

/* Some of the lowest modes with a shift that is small for sure, and so not sharp: the lowest |s|^2 that is not noise,
 * or 0. */
static int32_t find_scale(dmb_mode_search *search, double *square)
{
    const uint32_t n = search->linear->coordinates;
    const double away = DMB_SHIFT_NOISE * search->noise;
    search->shift = search->general ? sqrt(away) : -away;
    *square = 0.0;
    const int32_t status = dmb_modes_sparse(search, n < DMB_SCALE_MODES ? n : DMB_SCALE_MODES);
    for (uint32_t i = 0; i < search->modes->count && status >= 0; i++) {
        const double here = dmb_modes_size(search->modes, i) * dmb_modes_size(search->modes, i);
        if (here > DMB_RIGID_NOISE * search->noise && (*square == 0.0 || here < *square)) *square = here;
    }
    search->modes->count = 0;
    return status;
}

/* No shift where K is regular or pinned; else a real one off the eigenvalues of a stable system, as far as the lowest
 * of them that is not 0. */
static int32_t choose_shift(dmb_mode_search *search)
{
    double square;
    int32_t status = DMB_OK;
    if (search->apart) {
        status = dmb_modes_pin(search);
        if (status < 0 || search->pinned) return status;
    } else {
        dmb_block_weakest weakest = {(double)INFINITY, 0, 0};
        const int64_t bad = dmb_linear_factor(search->linear, 1.0, 0.0, 0.0, &weakest);
        if (bad < 0 && !(weakest.ratio < DMB_LOOSE_PIVOT) && search->rigid_count == 0) return DMB_OK;
    }
    if (is_dense(search, search->options->count)) return DMB_OK;
    status = find_scale(search, &square);
    if (status >= 0 && square > 0.0) search->shift = search->general ? sqrt(square) : -square;
    return status;
}

/* The number of modes of |s| below that of the last one wanted the search has missed, by the count of eigenvalues
 * between the negative and the positive square; nothing can be counted where those are noise, with joints or damping.
 */
static uint32_t missed(const dmb_mode_search *search)
{
    const dmb_modes *modes = search->modes;
    const uint32_t last = search->options->count - 1, apart = search->apart ? search->rigid_count : 0;
    if (last < apart || modes->count <= last - apart) return 0;
    const double size = dmb_modes_size(modes, last - apart);
    const double square = size * size * (1.0 - DMB_COUNT_MARGIN) - DMB_COUNT_NOISE * search->noise;
    if (search->general || search->linear->scene.cluster_count) return 0;
    if (!(square > DMB_RIGID_NOISE * search->noise)) return 0;
    uint32_t found = apart;
    for (uint32_t i = 0; i < modes->count; i++) found += dmb_modes_size(modes, i) * dmb_modes_size(modes, i) < square;
    const uint32_t there =
        dmb_linear_count_below(search->linear, square) - dmb_linear_count_below(search->linear, -square);
    return there > found ? there - found : 0;
}

/* The search makes sure of what it finds; the count is a second witness. Where they still differ after some more modes
 * were sought, an eigenvalue stands at the edge of the count. */
static int32_t find_lowest(dmb_mode_search *search)
{
    uint32_t wanted = search->options->count;
    if (is_dense(search, wanted)) return dmb_modes_dense(search);
    for (int tries = 1;; tries++) {
        const int32_t status = dmb_modes_sparse(search, wanted);
        if (status < 0) return status;
        dmb_modes_sort(search->modes, search->modes->count);
        const uint32_t here = search->modes->count + search->rigid_count;
        const uint32_t more = here < search->options->count && wanted < search->linear->coordinates
                                  ? search->options->count - here /* pairs that were told once */
                                  : missed(search);
        if (more == 0 || tries == DMB_COUNT_TRIES) return DMB_OK;
        wanted += more + 2;
        search->modes->count = 0;
        if (is_dense(search, wanted)) return dmb_modes_dense(search);
        const int32_t again = choose_shift(search); /* the count has taken the factors */
        if (again < 0) return again;
    }
}

/* Whether the modes found reach beyond the band: what lies nearest the shift is complete. */
static int covers_band(const dmb_mode_search *search, double low, double high)
{
    double farthest = 0.0;
    for (uint32_t i = 0; i < search->modes->count; i++) {
        const double size = dmb_modes_size(search->modes, i), square = size * size;
        farthest = fmax(farthest, search->general ? size : fabs(square - search->shift));
    }
    if (search->general) return farthest > DMB_TWO_PI * high;
    const double edge = DMB_TWO_PI * high, other = DMB_TWO_PI * low;
    return farthest > fmax(fabs(edge * edge - search->shift), fabs(other * other - search->shift));
}

/* Many roots, by the undamped modes below the upper edge: those that stand in a strip are searched for piece by piece,
 * others refused where they are too many. 1: found; 0: they are few. */
static int32_t find_many_roots(dmb_mode_search *search, double low, double high)
{
    const double edge = DMB_TWO_PI * high;
    double strip[2];
    const int64_t below = dmb_linear_count(search->linear, edge * edge);
    if (below > DMB_ROOTS_BY_STRIP && dmb_modes_find_strip(search, high, strip)) {
        const int32_t status = dmb_modes_band_of_roots(search, low, high);
        return status < 0 ? status : 1;
    }
    if (below > DMB_ROOTS_AT_ONCE) {
        dmb_message_set(search->message,
                        "modes: some %u damped modes lie below band[1] = %g Hz, and friction, joints or strong damping "
                        "let them stand anywhere: must be <= %d; lower it, or take undamped modes",
                        (uint32_t)below, high, (int)DMB_ROOTS_AT_ONCE);
        return DMB_ERR_TOO_LARGE;
    }
    return 0;
}

/* In a band above 0 the shift stands in its middle, unless the problem is general: a real shift stays at 0. */
static int32_t find_band(dmb_mode_search *search)
{
    const double low = search->options->band[0], high = search->options->band[1];
    if (low > 0.0 && !search->general) {
        search->shift = 0.5 * DMB_TWO_PI * DMB_TWO_PI * (low * low + high * high);
        search->pinned = 0;
    }
    if (search->general && !is_dense(search, 16)) {
        const int32_t status = find_many_roots(search, low, high);
        if (status != 0) return status < 0 ? status : DMB_OK;
        const int32_t again = choose_shift(search); /* the counts have taken the factors */
        if (again < 0) return again;
    }
    const uint32_t most = search->general ? DMB_ROOTS_AT_ONCE : DMB_BAND_AT_ONCE;
    for (uint32_t wanted = 16; wanted <= most; wanted *= 2) {
        search->modes->count = 0;
        if (is_dense(search, wanted)) return dmb_modes_dense(search);
        const int32_t status = dmb_modes_sparse(search, wanted);
        if (status >= 0 && covers_band(search, low, high)) return status;
        if (status < 0 && status != DMB_ERR_NO_CONVERGENCE) return status;
    }
    return (search->general ? dmb_modes_band_of_roots : dmb_modes_band_of_squares)(search, low, high);
}

int32_t dmb_modes_find(dmb_mode_search *search)
{
    const dmb_modes_options *options = search->options;
    int32_t status = set_rigid_apart(search);
    if (status >= 0 && options->select != DMB_MODES_ALL) status = choose_shift(search);
    if (status >= 0)
        status = options->select == DMB_MODES_LOWEST ? find_lowest(search)
                 : options->select == DMB_MODES_ALL  ? dmb_modes_dense(search)
                                                     : find_band(search);
    if (status >= 0) status = dmb_modes_put_rigid(search);
    if (status == DMB_ERR_NO_CONVERGENCE) dmb_message_set(search->message, "modes: the eigenvalues did not converge");
    return status;
}
