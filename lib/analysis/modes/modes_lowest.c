/* Modes of smallest |s|. Methods in their order:
 *
 *   1. dense, if that is faster (dmb_modes_is_dense)
 *   2. symmetric: find_counted. A short iteration from the shift near 0, whose result counts of eigenvalues confirm; if
 *      they contradict it, the interval from counts (find_interval), confirmed once more
 *   3. find_confirmed: iterations that random vectors confirm, up to DMB_COUNT_TRIES times with more modes
 *   4. if those do not converge, find_converged: all modes by the dense method up to DMB_ALL_INSTEAD coordinates;
 *      otherwise the converged modes without the last, computed once more
 *
 * For symmetric problems a short iteration from 0 finds separated modes. It does not resolve a dense band, such as the
 * lateral modes of a string on the wall
 *
 *     s_k^2 = -(k_wall + EI (k pi/L)^4)/m.
 *
 * Counts then locate an interval that contains the modes wanted and few others; a shift inside it separates them
 * (eq:modes.shift-invert, eq:modes.count). */
#include <math.h>

#include "analysis/modes/modes.h"

/* Margin below the last mode wanted for the comparison with a count: it excludes modes equal to the last. */
#define DMB_COUNT_MARGIN 1e-9
#define DMB_COUNT_NOISE 64.0
/* An upper estimate may be the eigenvalue itself: the end of an interval is beyond it by this fraction. */
#define DMB_ESTIMATE_MARGIN 1e-8
/* Subspace dimension of the first iteration: constant, and per mode. */
enum { DMB_FIRST_VECTORS = 28, DMB_FIRST_SHARE = 1 };
/* Largest number of extra modes in the interval; largest number of bracketing steps. */
enum { DMB_BEYOND = 6, DMB_BRACKET = 100 };
/* Largest number of iterations without counts. */
enum { DMB_COUNT_TRIES = 3 };
/* Coordinates up to which all modes are computed if some of the lowest do not converge; for more coordinates, number of
 * the last converged modes that are omitted, beyond which others may be missing. */
enum { DMB_ALL_INSTEAD = 400, DMB_LEFT_OUT = 1 };

/* ---- Counts ------------------------------------------------------------------------------------------------------ */

/* Number of modes with |s|^2 below a square, without separated motions; -1 if it cannot be counted. */
static int64_t count_within(dmb_mode_search *search, double square)
{
    double high = square, low = -square;
    const int64_t below = dmb_modes_count_below(search, &high, 1e-9 * square);
    if (below < 0 || (search->definite > 0.0 && square >= search->definite)) return below;
    const int64_t negative = dmb_modes_count_below(search, &low, -1e-9 * square);
    if (negative == 0) search->definite = square;
    return negative < 0 ? -1 : below - negative;
}

static double square_of(const dmb_modes *modes, uint32_t i)
{
    return dmb_modes_size(modes, i) * dmb_modes_size(modes, i);
}

static uint32_t found_within(const dmb_modes *modes, double square)
{
    uint32_t found = 0;
    for (uint32_t i = 0; i < modes->count; i++) found += square_of(modes, i) < square;
    return found;
}

static uint32_t wanted_of(const dmb_mode_search *search)
{
    const uint32_t count = search->options->count, apart = search->apart ? search->rigid_count : 0;
    return count > apart ? count - apart : 0;
}

/* [1/s2] Just below the square of mode number `last`, above the rounding level of eigenvalues 0 so that it can be
 * counted; or 0. */
static double countable(const dmb_mode_search *search, uint32_t last)
{
    const double square = square_of(search->modes, last) * (1.0 - DMB_COUNT_MARGIN) - DMB_COUNT_NOISE * search->noise;
    return square > DMB_RIGID_NOISE * search->noise ? square : 0.0;
}

/* 1: the counts confirm the sorted modes up to the last one wanted. 0: they do not; -1: cannot be counted. */
static int confirmed(dmb_mode_search *search)
{
    const dmb_modes *modes = search->modes;
    const uint32_t wanted = wanted_of(search);
    if (wanted == 0) return 1;
    if (modes->count < wanted) return 0;
    const double square = countable(search, wanted - 1);
    if (!(square > 0.0)) return -1;
    const int64_t there = count_within(search, square);
    return there < 0 ? -1 : there == (int64_t)found_within(modes, square);
}

/* ---- Interval ---------------------------------------------------------------------------------------------------- */

typedef struct bracket {
    double low, high;       /* [1/s2] */
    int64_t within, beyond; /* number of modes with |s|^2 below low, fewer than wanted, and below high, enough */
} bracket;

/* Upper end from the estimate of the iteration, doubled until enough modes are below it. */
static int32_t open_bracket(dmb_mode_search *search, bracket *b)
{
    const double estimate = (1.0 + DMB_ESTIMATE_MARGIN) * (search->reach + fabs(search->shift));
    b->high = fmax(estimate, 1.0001 * b->low) + DMB_COUNT_NOISE * search->noise;
    if (!(b->high > 0.0)) return DMB_ERR_NO_CONVERGENCE;
    for (int i = 0; i < DMB_BRACKET; i++, b->high *= 2.0) {
        b->beyond = count_within(search, b->high);
        if (b->beyond < 0) return DMB_ERR_NO_CONVERGENCE;
        if (b->beyond >= (int64_t)wanted_of(search)) return DMB_OK;
        b->low = b->high;
        b->within = b->beyond;
    }
    return DMB_ERR_NO_CONVERGENCE;
}

/* Narrows the interval to an upper end with few extra modes: by bisection, alternating with the growth of eigenvalues
 * as the fourth power of their number, as at the edge of a band of bending modes. */
static int32_t close_bracket(dmb_mode_search *search, bracket *b)
{
    const int64_t wanted = wanted_of(search);
    for (int i = 0; i < DMB_BRACKET && b->beyond > wanted + DMB_BEYOND; i++) {
        const double width = b->high - b->low;
        const double share = ((double)(wanted - b->within) + 0.5 * DMB_BEYOND) / (double)(b->beyond - b->within);
        const double middle = b->low + width * (i % 2 == 0 ? fmin(0.5, share * share * share * share) : 0.5);
        if (!(width > DMB_COUNT_NOISE * search->noise) || !(middle > b->low)) break;
        const int64_t here = count_within(search, middle);
        if (here < 0) return DMB_ERR_NO_CONVERGENCE;
        if (here >= wanted) {
            b->high = middle;
            b->beyond = here;
        } else {
            b->low = middle;
            b->within = here;
        }
    }
    return DMB_OK;
}

/* Keeps the modes found so far if the counts confirm them. Result: the square up to which they are complete, or 0. */
static double keep_confirmed(dmb_mode_search *search)
{
    dmb_modes *modes = search->modes;
    if (modes->count == 0) return 0.0;
    const double last = square_of(modes, modes->count - 1);
    const double square = last * (1.0 + DMB_COUNT_MARGIN) + DMB_COUNT_NOISE * search->noise;
    if (!(last > DMB_RIGID_NOISE * search->noise) || count_within(search, square) != (int64_t)modes->count) {
        modes->count = 0;
        return 0.0;
    }
    return square;
}

/* Interval and its modes by counts alone. */
static int32_t find_interval(dmb_mode_search *search)
{
    bracket b = {.low = keep_confirmed(search)};
    const double known = b.low;
    b.within = search->modes->count;
    int32_t status = open_bracket(search, &b);
    if (status >= 0) status = close_bracket(search, &b);
    if (status < 0) return status;
    if (known == 0.0) return dmb_modes_squares(search, -b.high, b.high);
    status = dmb_modes_squares(search, known, b.high);
    return status < 0 ? status : dmb_modes_squares(search, -b.high, -known);
}

/* ---- Search ------------------------------------------------------------------------------------------------------ */

/* A short iteration from the shift near 0, and the interval that it does not resolve. *done: 1 if the counts confirm
 * the modes. */
static int32_t find_counted(dmb_mode_search *search, int *done)
{
    const uint32_t wanted = search->options->count;
    search->partly = search->counted = 1;
    search->most = DMB_FIRST_VECTORS + DMB_FIRST_SHARE * (size_t)wanted;
    int32_t status = dmb_modes_sparse(search, wanted);
    search->partly = search->counted = 0;
    search->most = 0;
    if (status == DMB_ERR_NO_CONVERGENCE) return DMB_OK;
    if (status < 0) return status;
    dmb_modes_sort(search->modes, search->modes->count);
    const int witness = confirmed(search);
    *done = witness == 1;
    if (witness != 0) return DMB_OK;
    status = find_interval(search);
    if (status == DMB_ERR_NO_CONVERGENCE || status == DMB_ERR_SINGULAR) return DMB_OK;
    if (status < 0) return status;
    dmb_modes_sort(search->modes, search->modes->count);
    *done = confirmed(search) == 1;
    return DMB_OK;
}

/* If roots beyond some do not converge: with few coordinates all modes, otherwise the converged ones, which a separate
 * iteration confirms. */
static int32_t find_converged(dmb_mode_search *search, uint32_t wanted)
{
    const uint32_t apart = search->apart ? search->rigid_count : 0;
    if (search->linear->coordinates <= DMB_ALL_INSTEAD) return dmb_modes_dense(search);
    search->modes->count = 0;
    search->partly = 1;
    int32_t status = dmb_modes_sparse(search, wanted);
    search->partly = 0;
    const uint32_t converged = search->modes->count;
    const double crowded = search->reach;
    search->modes->count = 0;
    if (status < 0 || converged <= DMB_LEFT_OUT) return status < 0 ? status : DMB_ERR_NO_CONVERGENCE;
    status = dmb_modes_sparse(search, converged - DMB_LEFT_OUT + apart);
    search->crowded = crowded + fabs(search->shift);
    return status;
}

/* Without counts the iteration confirms itself by random vectors. Pairs are returned once and reduce the number of
 * modes. */
static int32_t find_confirmed(dmb_mode_search *search)
{
    uint32_t wanted = search->options->count;
    if (search->general) wanted++; /* a double root may be at the end */
    for (int tries = 1;; tries++) {
        if (dmb_modes_is_dense(search, wanted)) return dmb_modes_dense(search);
        const int32_t status = dmb_modes_sparse(search, wanted);
        if (status == DMB_ERR_NO_CONVERGENCE) return find_converged(search, wanted);
        if (status < 0) return status;
        dmb_modes_sort(search->modes, search->modes->count);
        const uint32_t here = search->modes->count + search->rigid_count;
        const int missing = !search->general && confirmed(search) == 0;
        uint32_t more = missing ? 1 : 0;
        if (here < search->options->count && wanted < search->linear->coordinates) more = search->options->count - here;
        if (more == 0 || tries == DMB_COUNT_TRIES) return missing ? DMB_ERR_NO_CONVERGENCE : DMB_OK;
        wanted += more + 2;
        search->modes->count = 0;
        const int32_t again = dmb_modes_choose_shift(search); /* the counts have overwritten the factors */
        if (again < 0) return again;
    }
}

int32_t dmb_modes_lowest(dmb_mode_search *search)
{
    int done = 0;
    if (dmb_modes_is_dense(search, search->options->count)) return dmb_modes_dense(search);
    if (!search->general) {
        int32_t status = find_counted(search, &done);
        if (status < 0 || done) return status;
        search->modes->count = 0;
        status = dmb_modes_choose_shift(search); /* the counts have overwritten the factors */
        if (status < 0) return status;
    }
    return find_confirmed(search);
}
