/* Modes of a band, chunk by chunk. Each iteration returns the modes nearest its shift, therefore all modes within its
 * reach: reaches cover the band.
 *
 *     symmetric:  the eigenvalues s^2 are real, and the signs of the factors of K - s^2 M count them: a chunk is
 *                 divided until an iteration finds the counted number (eq:modes.count)
 *     general:    the roots s lie in the half plane im >= 0; a rectangle that an iteration from its centre does not
 *                 reach to its corners is divided in two
 *
 * A root s = a + i b, |s| = r, of a shape x with x^H M x = 1, x^H C x = c + i g and K symmetric, x^H K x = k, has
 *
 *     a (1 + k/r^2) + c = 0        (real part of its equation over s, eq:modes.strip)
 *
 * so that with K and d (M + K/high^2) -+ C positive definite no root of r <= high has -+a > d. Then the roots lie in a
 * strip along the imaginary axis, which counts of w^2 divide before the iteration. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "analysis/modes/modes.h"
#include "base/memory.h"
#include "math/real.h"

/* Modes per chunk; extra modes; chunks in the queue; divisions per chunk. */
enum { DMB_PIECE = 24, DMB_MARGIN = 6, DMB_PIECES = 128, DMB_CUTS = 60 };
/* Smallest relative width of a chunk of eigenvalues: for shrinking, for division; multiple of the rounding level. */
#define DMB_NARROW 1e-4
#define DMB_RESOLVED 1e-12
#define DMB_NARROW_NOISE 256.0
/* Half width of a root strip over the band's upper edge. */
#define DMB_STRIP_WIDEST 0.5
#define DMB_STRIP_LEAST 1e-5
/* A shift that hits a root moves by this fraction of its rectangle. */
#define DMB_ASIDE 0.01
/* Fraction of the reach that is accepted. */
#define DMB_SURE 0.98

/* ---- Symmetric --------------------------------------------------------------------------------------------------- */

/* Chunk of the line, and the number of eigenvalues below its ends, without those of separated rigid-body motions. */
typedef struct interval {
    double from, to;
    int64_t below_from, below_to;
    int cuts;
} interval;

static double square_of(const dmb_modes *modes, uint32_t i)
{
    const double *s = modes->s + 2 * (size_t)i;
    return s[0] > 0.0 ? -s[0] * s[0] : s[1] * s[1];
}

uint32_t dmb_modes_keep_squares(dmb_modes *modes, uint32_t first, double from, double to)
{
    uint32_t kept = first;
    for (uint32_t i = first; i < modes->count; i++) {
        const double square = square_of(modes, i);
        if (square < from || square >= to) continue;
        if (kept != i) dmb_modes_exchange(modes, kept, i);
        kept++;
    }
    modes->count = kept;
    return kept - first;
}

int64_t dmb_modes_count_below(const dmb_mode_search *search, double *square, double aside)
{
    for (int i = 0; i < 4; i++, *square += aside) {
        const int64_t count = dmb_linear_count(search->linear, *square);
        if (count >= 0) return count - (*square > 0.0 && search->apart ? (int64_t)search->rigid_count : 0);
    }
    return -1;
}

/* 1: the chunk is too narrow for division, as one eigenvalue or several that are nearly equal. */
static int is_narrow(const interval *piece, double part, const dmb_mode_search *search)
{
    return piece->to - piece->from <=
           part * fmax(fabs(piece->from), fabs(piece->to)) + DMB_NARROW_NOISE * search->noise;
}

/* Densest part of a chunk: the part that contains at least this fraction of the eigenvalues is halved until neither
 * half does, since an iteration from its middle separates them best. */
#define DMB_DENSE_PART 0.6
enum { DMB_DENSE_HALVES = 10 };

static interval densest_part(const dmb_mode_search *search, const interval *piece)
{
    interval part = *piece;
    const double least = DMB_DENSE_PART * (double)(piece->below_to - piece->below_from);
    for (int i = 0; i < DMB_DENSE_HALVES && !is_narrow(&part, DMB_RESOLVED, search); i++) {
        double middle = 0.5 * (part.from + part.to);
        const int64_t below = dmb_modes_count_below(search, &middle, 1e-3 * (part.to - part.from));
        if (below < 0) return part;
        if ((double)(below - part.below_from) >= least) {
            part.to = middle;
            part.below_to = below;
        } else if ((double)(part.below_to - below) >= least) {
            part.from = middle;
            part.below_from = below;
        } else {
            return part;
        }
    }
    return part;
}

/* 1: found the counted number, from shifts in a part of the chunk; 0: not. */
static int32_t search_interval(dmb_mode_search *search, const interval *piece, interval part, uint32_t there)
{
    dmb_modes *modes = search->modes;
    const uint32_t first = modes->count;
    int32_t status = DMB_ERR_SINGULAR;
    search->window[0] = piece->from;
    search->window[1] = piece->to;
    search->enough = there;
    for (int i = 0; i < 3 && status == DMB_ERR_SINGULAR; i++) { /* a shift may hit an eigenvalue */
        search->shift = part.from + (0.5 + 0.01 * i) * (part.to - part.from);
        modes->count = first;
        status = dmb_modes_sparse(search, there + DMB_MARGIN + search->rigid_count);
    }
    search->enough = 0;
    if (status < 0 && status != DMB_ERR_NO_CONVERGENCE) return status;
    if (status >= 0 && dmb_modes_keep_squares(modes, first, piece->from, piece->to) == there) return 1;
    modes->count = first;
    return 0;
}

/* Removes halves of the chunk without eigenvalues: a shift among the eigenvalues separates them, a distant one does
 * not. Results: the middle of the remainder, and the number below it; 0 if that cannot be counted. */
static int shrink(const dmb_mode_search *search, interval *piece, double *middle, int64_t *below)
{
    for (int i = 0; i < DMB_CUTS; i++) {
        *middle = piece->from + 0.4567 * (piece->to - piece->from);
        *below = dmb_modes_count_below(search, middle, 1e-3 * (piece->to - piece->from));
        if (*below < 0) return 0;
        if (*below == piece->below_from && !is_narrow(piece, DMB_NARROW, search))
            piece->from = *middle;
        else if (*below == piece->below_to && !is_narrow(piece, DMB_NARROW, search))
            piece->to = *middle;
        else
            break;
    }
    return 1;
}

typedef struct pieces {
    interval waiting[DMB_PIECES];
    uint32_t count;
} pieces;

static void push(pieces *all, const interval *piece, double from, double to, int64_t below_from, int64_t below_to)
{
    if (below_to > below_from) all->waiting[all->count++] = (interval){from, to, below_from, below_to, piece->cuts + 1};
}

/* 1: the eigenvalues are much denser in a part of the chunk than in the whole; that part becomes a chunk. */
#define DMB_MUCH_DENSER 32.0

static int set_apart(pieces *all, const interval *piece, const interval *part)
{
    if (!(piece->to - piece->from > DMB_MUCH_DENSER * (part->to - part->from))) return 0;
    if (part->below_to - part->below_from == piece->below_to - piece->below_from) return 0;
    push(all, piece, part->to, piece->to, part->below_to, piece->below_to);
    push(all, piece, part->from, part->to, part->below_from, part->below_to);
    push(all, piece, piece->from, part->from, piece->below_from, part->below_from);
    return 1;
}

/* 1: the modes of the chunk were added, or it was divided. */
static int32_t search_piece(dmb_mode_search *search, pieces *all, interval piece)
{
    const int64_t there = piece.below_to - piece.below_from;
    double middle;
    int64_t below;
    if (!shrink(search, &piece, &middle, &below)) return DMB_ERR_NO_CONVERGENCE;
    const int final = piece.cuts == DMB_CUTS || all->count + 3 > DMB_PIECES;
    if (there <= DMB_PIECE) {
        const interval part = densest_part(search, &piece);
        if (!final && set_apart(all, &piece, &part)) return 1;
        const int32_t status = search_interval(search, &piece, part, (uint32_t)there);
        if (status != 0) return status;
    }
    if (final || is_narrow(&piece, DMB_RESOLVED, search)) return DMB_ERR_NO_CONVERGENCE;
    push(all, &piece, middle, piece.to, below, piece.below_to);
    push(all, &piece, piece.from, middle, piece.below_from, below);
    return 1;
}

static int32_t search_squares(dmb_mode_search *search, interval whole)
{
    pieces all = {.count = 0};
    int32_t status = DMB_OK;
    whole.below_from = dmb_modes_count_below(search, &whole.from, -1e-9 * fabs(whole.from));
    whole.below_to = dmb_modes_count_below(search, &whole.to, 1e-9 * fabs(whole.to));
    if (whole.below_from < 0 || whole.below_to < 0) return DMB_ERR_NO_CONVERGENCE;
    push(&all, &whole, whole.from, whole.to, whole.below_from, whole.below_to);
    while (all.count > 0 && status >= 0) {
        all.count--;
        status = search_piece(search, &all, all.waiting[all.count]);
    }
    return status < 0 ? status : DMB_OK;
}

int32_t dmb_modes_squares(dmb_mode_search *search, double from, double to)
{
    search->pinned = 0;
    search->partly = search->counted = 1; /* modes in the chunk converge first, and the counts confirm them */
    const int32_t status = search_squares(search, (interval){.from = from, .to = to});
    search->partly = search->counted = 0;
    return status;
}

int32_t dmb_modes_band_of_squares(dmb_mode_search *search, double low, double high)
{
    const double a = DMB_TWO_PI * low * DMB_TWO_PI * low, b = DMB_TWO_PI * high * DMB_TWO_PI * high;
    const double edge = 1e-9 * b; /* modes at the ends of the band are selected by their frequencies */
    search->modes->count = 0;
    if (a <= edge) return dmb_modes_squares(search, -b - edge, b + edge);
    const int32_t status = dmb_modes_squares(search, a - edge, b + edge);
    return status < 0 ? status : dmb_modes_squares(search, -b - edge, -a + edge);
}

/* ---- General ----------------------------------------------------------------------------------------------------- */

typedef struct rectangle {
    double re[2], im[2];
    int cuts;
} rectangle;

/* An iteration: its shift, smallest operator value, and roots. */
typedef struct reach {
    double growth, omega, least;
    double root[2 * DMB_PIECE][2];
    uint32_t count;
} reach;

typedef struct covering {
    dmb_mode_search *search;
    double low, high; /* [1/s] limits of |s| */
    dmb_vector reaches;
    int strip; /* 1: all roots are near the imaginary axis; counts of w^2 locate them approximately */
} covering;

static int holds(const rectangle *r, const double s[2])
{
    return s[0] >= r->re[0] && s[0] < r->re[1] && s[1] >= r->im[0] && s[1] < r->im[1];
}

/* 1: the reach contains all roots of a rectangle: |value| of the operator, whose logarithm is harmonic, is smallest on
 * its boundary. */
static int covers(const reach *w, const rectangle *r)
{
    enum { POINTS = 24 };
    for (int side = 0; side < 4; side++)
        for (int i = 0; i <= POINTS; i++) {
            const double x = (double)i / POINTS;
            const double re = side < 2 ? r->re[side] : r->re[0] + x * (r->re[1] - r->re[0]);
            const double im = side < 2 ? r->im[0] + x * (r->im[1] - r->im[0]) : r->im[side - 2];
            if (!(DMB_SURE * dmb_shifted_value(w->growth, w->omega, re, im) > w->least)) return 0;
        }
    return 1;
}

/* 1: an earlier iteration has covered it and found no root in it. */
static int is_empty(const covering *c, const rectangle *r)
{
    for (size_t i = 0; i < c->reaches.count; i++) {
        const reach *w = DMB_VECTOR_AT(const reach, &c->reaches, i);
        uint32_t inside = 0;
        if (!covers(w, r)) continue;
        for (uint32_t k = 0; k < w->count; k++) inside += holds(r, w->root[k]) != 0;
        if (inside == 0) return 1;
    }
    return 0;
}

/* 1: the whole rectangle is outside the band. */
static int is_outside(const covering *c, const rectangle *r)
{
    const double near_re = fmax(fmax(r->re[0], -r->re[1]), 0.0), near = hypot(near_re, r->im[0]);
    const double far = hypot(fmax(fabs(r->re[0]), fabs(r->re[1])), r->im[1]);
    return near > c->high || far < c->low;
}

/* Real part of the shift: near the imaginary axis for roots of low damping, not on the circle about growth through its
 * own conjugate. */
static double shift_growth(const rectangle *r)
{
    const double width = r->re[1] - r->re[0];
    if (r->im[0] > 0.0 && r->re[0] < 0.0 && r->re[1] > 0.0) return fmin(0.03 * width, r->re[1]);
    return 0.5 * (r->re[0] + r->re[1]);
}

/* 1: the rectangle is complete, its modes added; 0: not reached to its corners. */
static int32_t search_rectangle(covering *c, const rectangle *r)
{
    dmb_modes *modes = c->search->modes;
    const uint32_t first = modes->count;
    reach w = {.growth = shift_growth(r), .omega = r->im[0] > 0.0 ? 0.5 * (r->im[0] + r->im[1]) : 0.0};
    const double aside = DMB_ASIDE * fmax(r->re[1] - r->re[0], r->im[1] - r->im[0]);
    int32_t status = dmb_modes_shifted(c->search, &w.growth, w.omega, aside, DMB_PIECE, &w.least);
    if (status == DMB_ERR_NO_CONVERGENCE) return 0; /* too far from all roots, or at one */
    if (status < 0) return status;
    for (uint32_t i = first; i < modes->count && w.count < 2 * DMB_PIECE; i++, w.count++)
        memcpy(w.root[w.count], modes->s + 2 * (size_t)i, 2 * sizeof(double));
    status = dmb_vector_append(&c->reaches, &c->search->linear->allocator, &w, 1);
    if (status < 0) return status;
    const int done = covers(&w, r);
    uint32_t kept = first;
    for (uint32_t i = first; i < modes->count && done; i++) {
        if (!holds(r, modes->s + 2 * (size_t)i)) continue;
        if (kept != i) dmb_modes_exchange(modes, kept, i);
        kept++;
    }
    modes->count = kept;
    return done;
}

/* Divides along the longer side, off the middle, where roots are frequent; a rectangle that contains the imaginary axis
 * is last, and is reduced to a square about it. */
static void cut(const rectangle *r, rectangle out[2])
{
    const double width = r->re[1] - r->re[0], height = r->im[1] - r->im[0];
    const int axis = r->re[0] < 0.0 && r->re[1] > 0.0, left = -r->re[0] > r->re[1];
    out[0] = out[1] = *r;
    out[0].cuts = out[1].cuts = r->cuts + 1;
    if (axis && r->im[0] > 0.0 && width > 1.2 * height && (left ? -r->re[0] : r->re[1]) > 0.6 * height) {
        if (left)
            out[0].re[1] = out[1].re[0] = -0.5 * height;
        else
            out[0].re[0] = out[1].re[1] = 0.5 * height;
    } else if (width > (axis ? 1.2 : 1.0) * height) {
        out[0].re[1] = out[1].re[0] = r->re[0] + 0.4567 * width;
    } else {
        out[0].im[1] = out[1].im[0] = r->im[0] + 0.4567 * height;
    }
}

/* 1: a strip chunk has more roots than an iteration from its middle is certain to find. */
static int is_crowded(const covering *c, const rectangle *r)
{
    dmb_linear *linear = c->search->linear;
    if (!c->strip || r->im[1] - r->im[0] <= r->re[1] - r->re[0]) return 0;
    const uint32_t below = dmb_linear_count_below(linear, r->im[0] * r->im[0]);
    return dmb_linear_count_below(linear, r->im[1] * r->im[1]) > below + DMB_PIECE / 2;
}

static int32_t cover(covering *c, rectangle all)
{
    rectangle waiting[DMB_PIECES];
    uint32_t count = 0;
    waiting[count++] = all;
    while (count > 0) {
        const rectangle r = waiting[--count];
        if (is_outside(c, &r) || is_empty(c, &r)) continue;
        const int32_t status = is_crowded(c, &r) ? 0 : search_rectangle(c, &r);
        if (status < 0) return status;
        if (status > 0) continue;
        if (r.cuts == DMB_CUTS || count + 2 > DMB_PIECES) return DMB_ERR_NO_CONVERGENCE;
        cut(&r, waiting + count);
        count += 2;
    }
    return DMB_OK;
}

/* 1: no root of |s| <= high has a sign * real part beyond d. */
static int is_beside(dmb_mode_search *search, double high, double sign, double d)
{
    return dmb_linear_negative(search->linear, d / (high * high), sign, d) == 0;
}

/* A weak skew part of K moves real parts by less than DMB_STRIP_LEAST of the edge (eq:modes.skew). */
int dmb_modes_find_strip(dmb_mode_search *search, double high, double strip[2])
{
    const double edge = DMB_TWO_PI * high;
    if (search->linear->scene.cluster_count > 0 || search->modes->info.asymmetry > DMB_MODES_WEAK) return 0;
    if (dmb_linear_negative(search->linear, 1.0, 0.0, DMB_RIGID_NOISE * search->noise) > 0) return 0;
    for (int side = 0; side < 2; side++) {
        double d = DMB_STRIP_WIDEST * edge;
        const double sign = side ? 1.0 : -1.0;
        if (!is_beside(search, edge, sign, d)) return 0;
        while (d > DMB_STRIP_LEAST * edge && is_beside(search, edge, sign, 0.7 * d)) d *= 0.7;
        strip[side] = sign * d;
    }
    return 1;
}

int32_t dmb_modes_band_of_roots(dmb_mode_search *search, double low, double high)
{
    covering c = {
        .search = search, .low = DMB_TWO_PI * low, .high = DMB_TWO_PI * high, .reaches = dmb_vector_of(sizeof(reach))};
    const double edge = (1.0 + 1e-9) * c.high;
    rectangle all = {{-edge, edge}, {0.0, edge}, 0};
    c.strip = dmb_modes_find_strip(search, high, all.re);
    search->modes->count = 0;
    const int32_t status = cover(&c, all);
    dmb_vector_release(&c.reaches, &search->linear->allocator);
    return status;
}
