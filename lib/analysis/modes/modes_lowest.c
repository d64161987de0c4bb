/* Modes of smallest |s|. Methods in their order:
 *
 *   1. dense, if that is faster (dmb_modes_is_dense)
 *   2. symmetric: find_counted. A short iteration from the shift near 0, whose result counts of eigenvalues confirm; if
 *      it has not resolved all, further ones from nearer shifts (find_nearer), confirmed once more
 *   3. find_confirmed: iterations that random vectors confirm, up to DMB_COUNT_TRIES times with more modes
 *   4. if those do not converge, find_converged: all modes by the dense method up to DMB_ALL_INSTEAD coordinates;
 *      otherwise the converged modes without the last, computed once more
 *
 * For symmetric problems a short iteration from 0 finds separated modes. It does not resolve a dense band, such as the
 * lateral modes of a string on the wall
 *
 *     s_k^2 = -(k_wall + EI (k pi/L)^4)/m.
 *
 * Its estimates, with their residuals, bound the edge of the band from below. A shift just there separates the modes
 * near the edge some hundred times better, and so on until they have converged; a count at each shift confirms the
 * modes below it (eq:modes.shift-invert, eq:modes.count, eq:modes.nearer). */
#include <math.h>

#include "analysis/modes/modes.h"

/* Margin below the last mode wanted for the comparison with a count: it excludes modes equal to the last. */
#define DMB_COUNT_MARGIN 1e-9
#define DMB_COUNT_NOISE 64.0
/* Subspace dimension of an iteration, beyond one vector for each mode: few more vectors separate modes less than a
 * nearer shift. */
enum { DMB_VECTORS = 20 };
/* Largest number of nearer shifts, and of counts that place each; beyond the first, it is so much nearer to the known
 * modes. */
enum { DMB_NEARER = 12, DMB_PLACES = 8 };
#define DMB_NEARER_KNOWN 0.25
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

/* ---- Nearer shifts ------------------------------------------------------------------------------------------------
 */

/* Keeps the modes found below the next shift and places it there: between `known`, up to which the modes of positive
 * squares are complete, and the lower bound of the first one that has not converged. `negative`: number of eigenvalues
 * below 0. Result: 0 if the counts do not confirm the modes below any such shift. */
static int place_shift(dmb_mode_search *search, double known, int64_t negative)
{
    double p = search->shift + search->next;
    for (int i = 0; i < DMB_PLACES && search->next > 0.0; i++, p = known + DMB_NEARER_KNOWN * (p - known)) {
        if (!(p - known > DMB_COUNT_NOISE * search->noise)) return 0;
        const int64_t below = dmb_modes_count_below(search, &p, 1e-9 * p);
        const uint32_t found = found_within(search->modes, p);
        if (below < 0 || below - negative != (int64_t)found) continue;
        search->modes->count = found;
        search->shift = p;
        return 1;
    }
    return 0;
}

/* Modes of positive squares: short iterations, each from a shift nearer to those that the last one has not resolved,
 * and below them, so that they are the largest values of the operator. */
static int32_t find_positive(dmb_mode_search *search, int64_t negative)
{
    const uint32_t wanted = wanted_of(search);
    double known = 0.0;
    int32_t status = DMB_OK;
    dmb_modes_keep_squares(search->modes, 0, 0.0, (double)INFINITY);
    search->partly = search->counted = search->above = 1;
    search->most = DMB_VECTORS + (size_t)wanted;
    for (int i = 0; i < DMB_NEARER && search->modes->count < wanted && status >= 0; i++) {
        status = place_shift(search, known, negative) ? DMB_OK : DMB_ERR_NO_CONVERGENCE;
        known = search->shift;
        search->pinned = 0;
        if (status >= 0) status = dmb_modes_sparse(search, wanted - search->modes->count);
        dmb_modes_sort(search->modes, search->modes->count);
    }
    search->partly = search->counted = search->above = 0;
    search->most = 0;
    return status >= 0 && search->modes->count < wanted ? DMB_ERR_NO_CONVERGENCE : status;
}

/* The modes by nearer shifts; those of unstable states have negative squares, which counts alone locate. */
static int32_t find_nearer(dmb_mode_search *search)
{
    double zero = -DMB_COUNT_NOISE * search->noise;
    const int64_t negative = dmb_modes_count_below(search, &zero, zero);
    if (negative < 0) return DMB_ERR_NO_CONVERGENCE;
    if (negative == 0) search->definite = -zero;
    const int32_t status = find_positive(search, negative);
    if (status < 0 || negative == 0) return status;
    const double last = square_of(search->modes, wanted_of(search) - 1);
    return dmb_modes_squares(search, -last * (1.0 + DMB_COUNT_MARGIN), zero);
}

/* ---- Search ------------------------------------------------------------------------------------------------------ */

/* A short iteration from the shift near 0, and nearer shifts for what it does not resolve. *done: 1 if the counts
 * confirm the modes. */
static int32_t find_counted(dmb_mode_search *search, int *done)
{
    const uint32_t wanted = search->options->count;
    search->partly = search->counted = 1;
    search->most = DMB_VECTORS + (size_t)wanted;
    int32_t status = dmb_modes_sparse(search, wanted);
    search->partly = search->counted = 0;
    search->most = 0;
    if (status == DMB_ERR_NO_CONVERGENCE) return DMB_OK;
    if (status < 0) return status;
    dmb_modes_sort(search->modes, search->modes->count);
    const int witness = confirmed(search);
    *done = witness == 1;
    if (witness != 0) return DMB_OK;
    status = find_nearer(search);
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
