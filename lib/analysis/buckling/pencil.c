/* Symmetric pencil K + factor G (eq:buckling.pencil) of block-tridiagonal matrices, and block-sparse ones if joints
 * connect chains, K positive definite: its critical factors > 0, counted by Sylvester's law of inertia, computed by
 * bisection, and their vectors by inverse iteration (Parlett, The symmetric eigenvalue problem, 3.3 and 4.2).
 *
 * A vector has the rows of the scene, 0 in those of jointed chains, followed by the reduced coordinates of these. */
#include "analysis/buckling/buckling.h"

#include <math.h>
#include <string.h>

#include "math/dense.h"
#include "math/inertia.h"
#include "math/krylov.h"
#include "sim/access.h"

static size_t reduced_values(const dmb_scene *scene)
{
    return scene->cluster_count ? scene->pattern.values : 0;
}

static size_t reduced_rows(const dmb_scene *scene)
{
    return scene->cluster_count ? scene->pattern.rows : 0;
}

static void lay_out_matrix(dmb_arena *arena, const dmb_scene *scene, dmb_pencil_matrix *A)
{
    const dmb_block_layout *layout = &scene->layout;
    A->diagonal = DMB_ARENA_DOUBLES(arena, layout->diag[layout->n]);
    A->lower = DMB_ARENA_DOUBLES(arena, layout->link[layout->n - 1]);
    A->upper = DMB_ARENA_DOUBLES(arena, layout->link[layout->n - 1]);
    A->jointed = DMB_ARENA_DOUBLES(arena, reduced_values(scene));
}

uint32_t dmb_pencil_unknowns(const dmb_scene *scene)
{
    return scene->row_count + (uint32_t)reduced_rows(scene);
}

void dmb_pencil_lay_out(dmb_arena *arena, const dmb_scene *scene, dmb_pencil *pencil)
{
    size_t largest = 0;
    for (uint32_t k = 0; k < scene->cluster_count; k++)
        if (scene->clusters[k].columns > largest) largest = scene->clusters[k].columns;
    pencil->scene = scene;
    pencil->unknowns = dmb_pencil_unknowns(scene);
    lay_out_matrix(arena, scene, &pencil->K);
    lay_out_matrix(arena, scene, &pencil->G);
    lay_out_matrix(arena, scene, &pencil->work);
    pencil->pivot = DMB_ARENA_ARRAY(arena, uint8_t, scene->row_count);
    pencil->reduced_pivot = DMB_ARENA_ARRAY(arena, uint32_t, reduced_rows(scene));
    pencil->workspace = DMB_ARENA_DOUBLES(arena, largest * largest);
    pencil->image = DMB_ARENA_DOUBLES(arena, pencil->unknowns);
    pencil->iterate = DMB_ARENA_DOUBLES(arena, pencil->unknowns);
}

static void combine(size_t n, const double *K, double factor, const double *G, double *out)
{
    for (size_t i = 0; i < n; i++) out[i] = K[i] + factor * G[i];
}

static void shift(dmb_pencil *pencil, double factor)
{
    const dmb_block_layout *layout = &pencil->scene->layout;
    const size_t link = layout->link[layout->n - 1];
    combine(layout->diag[layout->n], pencil->K.diagonal, factor, pencil->G.diagonal, pencil->work.diagonal);
    combine(link, pencil->K.lower, factor, pencil->G.lower, pencil->work.lower);
    combine(link, pencil->K.upper, factor, pencil->G.upper, pencil->work.upper);
    combine(reduced_values(pencil->scene), pencil->K.jointed, factor, pencil->G.jointed, pencil->work.jointed);
}

static dmb_block_sparse sparse_of(const dmb_pencil *pencil, const dmb_pencil_matrix *A)
{
    const dmb_block_sparse matrix = {A->jointed, pencil->reduced_pivot, pencil->sim->reduced_size};
    return matrix;
}

/* Number of negative eigenvalues of K + factor G: chains without joints directly, the others by the factors of
 * `work`. */
static int count_shifted(dmb_pencil *pencil, uint32_t *negative)
{
    const dmb_scene *scene = pencil->scene;
    *negative = 0;
    for (uint32_t c = 0; c < scene->chain_count; c++)
        if (!scene->chains[c].jointed)
            *negative += dmb_block_negative(&scene->layout, pencil->work.diagonal, pencil->work.lower,
                                            pencil->work.upper, NULL, scene->chains[c].first, scene->chains[c].count);
    if (scene->cluster_count == 0) return 1;
    dmb_block_sparse matrix = sparse_of(pencil, &pencil->work);
    if (dmb_block_sparse_factor(&scene->pattern, &matrix) >= 0) return 0;
    *negative += dmb_block_sparse_negative(&scene->pattern, &matrix, pencil->workspace);
    return 1;
}

/* If a block is singular at a factor although the whole is not, the factor changes: by this fraction of itself; where
 * that does not help, as beside a limit point, where K is singular to rounding, by a factor that changes K in the same
 * digits. */
#define DMB_ASIDE 1e-13
#define DMB_ASIDE_TRIES 8

static double largest(size_t n, const double *values, double most)
{
    for (size_t i = 0; i < n; i++) most = fmax(most, fabs(values[i]));
    return most;
}

static double size_of(const dmb_pencil *pencil, const dmb_pencil_matrix *A)
{
    const dmb_block_layout *layout = &pencil->scene->layout;
    return largest(reduced_values(pencil->scene), A->jointed, largest(layout->diag[layout->n], A->diagonal, 0.0));
}

/* Try number k >= 1 beside a factor. */
static double aside_of(const dmb_pencil *pencil, double factor, int k)
{
    const int relative = factor != 0.0 && k <= DMB_ASIDE_TRIES / 2;
    if (relative) return k * DMB_ASIDE * factor;
    const double G = size_of(pencil, &pencil->G);
    return G > 0.0 ? k * DMB_ASIDE * size_of(pencil, &pencil->K) / G : 0.0;
}

int dmb_pencil_count(dmb_pencil *pencil, double factor, uint32_t *count)
{
    *count = 0;
    if (dmb_progress_pulse(pencil->sim) < 0) return 0;
    for (int k = 0; k < DMB_ASIDE_TRIES; k++) {
        shift(pencil, k == 0 ? factor : factor + aside_of(pencil, factor, k));
        if (count_shifted(pencil, count)) return 1;
    }
    *count = 0;
    return 0;
}

/* Ends of an interval that contains factor number k, and the numbers of factors below them. */
typedef struct interval {
    double low, high;
    uint32_t below_low, below_high;
} interval;

/* 1 if more than k factors lie below this one, 0 if not, -1 if they cannot be counted. */
static int exceeds(dmb_pencil *pencil, double factor, uint32_t k, uint32_t *count)
{
    return dmb_pencil_count(pencil, factor, count) ? *count > k : -1;
}

/* Powers of 4 from the guess on, upwards or downwards, until the factor lies between low and high: 1. 0 if it is beyond
 * `most`, -1 if it cannot be counted. */
static int bracket(dmb_pencil *pencil, uint32_t k, double guess, double most, interval *i)
{
    *i = (interval){0.0, fmin(guess, most), 0, 0};
    int beyond = exceeds(pencil, i->high, k, &i->below_high);
    if (beyond > 0) {
        for (i->low = 0.25 * i->high; i->low > 1e-300; i->low *= 0.25) {
            beyond = exceeds(pencil, i->low, k, &i->below_low);
            if (beyond <= 0) break;
            i->high = i->low;
            i->below_high = i->below_low;
        }
        return beyond < 0 ? -1 : 1;
    }
    while (beyond == 0) {
        if (i->high >= most) return 0;
        i->low = i->high;
        i->below_low = i->below_high;
        i->high = fmin(4.0 * i->high, most);
        beyond = exceeds(pencil, i->high, k, &i->below_high);
    }
    return beyond;
}

/* Halves the interval. 0 if factors cannot be counted. */
static int halve(dmb_pencil *pencil, uint32_t k, interval *i)
{
    uint32_t count;
    const double middle = 0.5 * (i->low + i->high);
    const int beyond = exceeds(pencil, middle, k, &count);
    *(beyond > 0 ? &i->high : &i->low) = middle;
    *(beyond > 0 ? &i->below_high : &i->below_low) = count;
    return beyond >= 0;
}

/* ---- Vectors ----------------------------------------------------------------------------------------------------- */

void dmb_pencil_multiply(const dmb_pencil *pencil, const dmb_pencil_matrix *A, const double *x, double *y)
{
    const dmb_scene *scene = pencil->scene;
    const dmb_block_matrix matrix = {A->diagonal, A->lower, A->upper, pencil->pivot};
    memset(y, 0, pencil->unknowns * sizeof(double));
    for (uint32_t c = 0; c < scene->chain_count; c++)
        if (!scene->chains[c].jointed)
            dmb_block_multiply(&scene->layout, &matrix, scene->chains[c].first, scene->chains[c].count, x, y);
    if (scene->cluster_count == 0) return;
    const dmb_block_sparse reduced = sparse_of(pencil, A);
    dmb_block_sparse_multiply(&scene->pattern, &reduced, pencil->sim->reduced_row, x + scene->row_count,
                              y + scene->row_count);
}

int dmb_pencil_shift_and_factor(dmb_pencil *pencil, double factor)
{
    const dmb_scene *scene = pencil->scene;
    dmb_block_matrix matrix = {pencil->work.diagonal, pencil->work.lower, pencil->work.upper, pencil->pivot};
    shift(pencil, factor);
    for (uint32_t c = 0; c < scene->chain_count; c++)
        if (!scene->chains[c].jointed &&
            dmb_block_factor(&scene->layout, &matrix, scene->chains[c].first, scene->chains[c].count) >= 0)
            return 0;
    if (scene->cluster_count == 0) return 1;
    dmb_block_sparse reduced = sparse_of(pencil, &pencil->work);
    return dmb_block_sparse_factor(&scene->pattern, &reduced) < 0;
}

void dmb_pencil_solve(const dmb_pencil *pencil, double *x)
{
    const dmb_scene *scene = pencil->scene;
    const dmb_block_matrix matrix = {pencil->work.diagonal, pencil->work.lower, pencil->work.upper, pencil->pivot};
    for (uint32_t c = 0; c < scene->chain_count; c++)
        if (!scene->chains[c].jointed)
            dmb_block_solve(&scene->layout, &matrix, scene->chains[c].first, scene->chains[c].count, x);
    if (scene->cluster_count == 0) return;
    const dmb_block_sparse reduced = sparse_of(pencil, &pencil->work);
    dmb_block_sparse_solve(&scene->pattern, &reduced, pencil->sim->reduced_row, x + scene->row_count);
}

/* Orthogonalises vectors of one factor in x . G x, which is negative for factors > 0. */
static void split_apart(dmb_pencil *pencil, const double *other, uint32_t others, double *x)
{
    const uint32_t rows = pencil->unknowns;
    for (uint32_t k = 0; k < others; k++) {
        const double *y = other + (size_t)k * rows;
        dmb_pencil_multiply(pencil, &pencil->G, y, pencil->image);
        const double share = dmb_dot(rows, pencil->image, x) / dmb_dot(rows, pencil->image, y);
        for (uint32_t i = 0; i < rows; i++) x[i] -= share * y[i];
    }
}

static void normalise(uint32_t rows, double *x)
{
    double most = 0.0;
    for (uint32_t i = 0; i < rows; i++) most = fmax(most, fabs(x[i]));
    for (uint32_t i = 0; i < rows; i++) x[i] /= most;
}

static int is_reduced(const dmb_scene *scene, uint32_t node)
{
    return scene->cluster_count > 0 && scene->node_block[node] != DMB_NONE;
}

/* Random vector with a component in the wanted one; the same in every run. */
void dmb_pencil_draw(const dmb_pencil *pencil, uint64_t seed, double *x)
{
    const dmb_scene *scene = pencil->scene;
    for (uint32_t i = 0; i < pencil->unknowns; i++) {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        x[i] = (double)(seed >> 11) / 9007199254740992.0 - 0.5;
    }
    for (uint32_t i = 0; i < scene->node_count; i++)
        if (is_reduced(scene, i)) memset(x + scene->layout.row[i], 0, scene->layout.size[i] * sizeof(double));
}

/* ---- Factors ----------------------------------------------------------------------------------------------------- */

/* x . K x / -x . G x, which is stationary at the factors */
static double quotient(dmb_pencil *pencil, const double *x)
{
    dmb_pencil_multiply(pencil, &pencil->K, x, pencil->image);
    const double stiff = dmb_dot(pencil->unknowns, x, pencil->image);
    dmb_pencil_multiply(pencil, &pencil->G, x, pencil->image);
    return -stiff / dmb_dot(pencil->unknowns, x, pencil->image);
}

/* x <- (K + f G)^-1 G x by the present factors, scaled */
static void improve(dmb_pencil *pencil, double *x)
{
    dmb_pencil_multiply(pencil, &pencil->G, x, pencil->image);
    memcpy(x, pencil->image, pencil->unknowns * sizeof(double));
    dmb_pencil_solve(pencil, x);
    normalise(pencil->unknowns, x);
}

/* The iteration ends at a change by this fraction of the tolerance, or after so many factorisations; if it fails, it is
 * repeated after so many bisections. */
#define DMB_PENCIL_CHANGE 0.1
enum { DMB_PENCIL_SMOOTHINGS = 6, DMB_PENCIL_QUOTIENTS = 6, DMB_PENCIL_HALVES = 8 };

/* Rayleigh quotient iteration from the middle of an interval that contains one factor; it converges with the third
 * order. Result: the factor; NaN if the counts just below and above do not confirm it. */
static double iterate(dmb_pencil *pencil, uint32_t k, const interval *i, double tolerance)
{
    double *x = pencil->iterate, factor = 0.5 * (i->low + i->high), last = (double)INFINITY;
    uint32_t below, above;
    dmb_pencil_draw(pencil, 88172645463325252u, x);
    if (!dmb_pencil_shift_and_factor(pencil, factor)) return (double)NAN;
    for (int j = 0; j < DMB_PENCIL_SMOOTHINGS; j++) improve(pencil, x);
    for (int j = 0; fabs(factor - last) > DMB_PENCIL_CHANGE * tolerance * fabs(factor); j++) {
        last = factor;
        if (j > 0) improve(pencil, x);
        factor = quotient(pencil, x);
        if (!(factor > i->low && factor < i->high) || j == DMB_PENCIL_QUOTIENTS) return (double)NAN;
        if (!dmb_pencil_shift_and_factor(pencil, factor)) return (double)NAN;
    }
    const int confirmed = dmb_pencil_count(pencil, factor * (1.0 - 0.5 * tolerance), &below) &&
                          dmb_pencil_count(pencil, factor * (1.0 + 0.5 * tolerance), &above) && below <= k && above > k;
    return confirmed ? factor : (double)NAN;
}

/* Bracket by counts, then bisection. As soon as the interval contains this factor alone, the Rayleigh quotient
 * iteration replaces the further bisections; if it fails, it is tried again after DMB_PENCIL_HALVES further ones. */
double dmb_pencil_factor(dmb_pencil *pencil, uint32_t k, double guess, double most, double tolerance)
{
    interval i;
    const int found = bracket(pencil, k, guess, most, &i);
    if (found <= 0) return found == 0 ? (double)INFINITY : (double)NAN;
    for (int isolated = 0; i.high - i.low > tolerance * i.high;) {
        if (i.below_high == i.below_low + 1 && isolated++ % DMB_PENCIL_HALVES == 0) {
            const double factor = iterate(pencil, k, &i, tolerance);
            if (!isnan(factor)) return factor;
        }
        if (!halve(pencil, k, &i)) return (double)NAN;
    }
    return 0.5 * (i.low + i.high);
}

/* Offset from the factor: one iteration gives 7 digits relative to distant vectors, and one digit less for each factor
 * of ten by which their relative distance is smaller. */
#define DMB_PENCIL_OFFSET 1e-7
#define DMB_PENCIL_ITERATIONS 6

double dmb_pencil_vector(dmb_pencil *pencil, double factor, const double *other, uint32_t others, double *x)
{
    dmb_pencil_draw(pencil, 88172645463325252u + others, x);
    if (!dmb_pencil_shift_and_factor(pencil, factor * (1.0 - DMB_PENCIL_OFFSET))) return factor;
    for (int k = 0; k < DMB_PENCIL_ITERATIONS; k++) {
        split_apart(pencil, other, others, x);
        improve(pencil, x);
    }
    split_apart(pencil, other, others, x);
    return quotient(pencil, x);
}

/* Critical factors of a non-symmetric pencil (friction, moments with a fixed axis): K x = -factor G x is A x = x/factor
 * with A = -K^-1 G. Complex eigenvalues of A are not factors: det (K + factor G) does not vanish there. */

static void metric(void *context, const double *x, double *y)
{
    const dmb_pencil *pencil = context;
    memcpy(y, x, pencil->unknowns * sizeof(double));
}

static void apply(void *context, const double *x, const double *Gx, double *y)
{
    const dmb_pencil *pencil = context;
    (void)Gx;
    dmb_pencil_multiply(pencil, &pencil->G, x, y);
    for (uint32_t i = 0; i < pencil->unknowns; i++) y[i] = -y[i];
    dmb_pencil_solve(pencil, y);
}

static void draw(void *context, uint64_t *seed, double *x)
{
    const dmb_pencil *pencil = context;
    *seed += 0x9E3779B97F4A7C15u;
    dmb_pencil_draw(pencil, *seed | 1u, x);
    dmb_pencil_solve(pencil, x);
}

static int32_t go_on(void *context)
{
    const dmb_pencil *pencil = context;
    return dmb_progress_pulse(pencil->sim);
}

/* [-] Rounding splits a real double eigenvalue into two, or into a pair this close to the real axis. */
#define DMB_REAL_PAIR 1e-5
#define DMB_GENERAL_TOLERANCE 1e-9
#define DMB_GENERAL_MORE 10
#define DMB_GENERAL_MOST 120
/* A value below this fraction of the largest is rounding of 0, not a factor. */
#define DMB_GENERAL_NOISE 1e-7

/* `most`: largest factor wanted. A double value appears as a pair: both parts of its complex vector then span its
 * plane. */
static uint32_t take(const dmb_krylov *values, size_t length, uint32_t wanted, double most, double *factors,
                     double *vectors)
{
    const double noise = values->count ? DMB_GENERAL_NOISE * hypot(values->re[0], values->im[0]) : 0.0;
    uint32_t found = 0;
    for (uint32_t i = 0; i < values->count && found < wanted; i++) {
        const size_t n = length;
        const int pair = values->im[i] != 0.0;
        if (values->re[i] <= noise || values->re[i] * most < 1.0 || fabs(values->im[i]) > DMB_REAL_PAIR * values->re[i])
            continue;
        for (int part = 0; part <= pair && found < wanted; part++, found++) {
            factors[found] = 1.0 / values->re[i];
            memcpy(vectors + n * found, (part ? values->y : values->x) + n * i, n * sizeof(double));
        }
    }
    return found;
}

/* The largest real positive eigenvalues 1/factor of A. Complex ones and negative ones may be larger: the number of
 * values is tripled until enough factors are among them, all values are known, or DMB_GENERAL_MOST is exceeded. Fewer
 * factors than requested are a result, not an error, and no proof that there are none beyond. */
int32_t dmb_pencil_general(dmb_pencil *pencil, const dmb_pencil_search *search, double *factors, double *vectors,
                           uint32_t *found)
{
    const uint32_t wanted = search->wanted;
    const dmb_operator inverse = {.context = pencil,
                                  .length = pencil->unknowns,
                                  .dimension = pencil->unknowns,
                                  .metric = metric,
                                  .apply = apply,
                                  .draw = draw,
                                  .go_on = go_on};
    *found = 0;
    if (!dmb_pencil_shift_and_factor(pencil, 0.0)) return DMB_ERR_SINGULAR;
    for (uint32_t values = 2 * wanted + DMB_GENERAL_MORE; *found < wanted; values *= 3) {
        dmb_krylov largest;
        if (values > pencil->unknowns) values = pencil->unknowns;
        const int32_t status =
            dmb_krylov_largest(&inverse, values, 2, DMB_GENERAL_TOLERANCE, search->allocator, &largest);
        if (status < 0) return *found > 0 && status == DMB_ERR_NO_CONVERGENCE ? DMB_OK : status;
        *found = take(&largest, pencil->unknowns, wanted, search->most, factors, vectors);
        dmb_krylov_release(&largest);
        if (values >= pencil->unknowns || values > DMB_GENERAL_MOST) break;
    }
    return DMB_OK;
}
