/* Lowest eigenvalue of K x = mu E x, K the symmetric stiffness of a state, E the lateral displacements of its nodes
 * (eq:buckling.softest). Methods in their order:
 *
 *   1. a lower bound p near the value expected: K - p E has no negative eigenvalue (Sylvester's law of inertia)
 *   2. Lanczos vectors of (K - p E)^-1 E from the expected shape. The lateral spectrum of a string in its hole is
 *      dense: about 0 instead of p there would be up to hundreds of them
 *   3. the result is the lowest eigenvalue if no eigenvalue is counted just below it; otherwise bisection by counts
 *      (Parlett, The symmetric eigenvalue problem, 3.3) */
#include <math.h>
#include <string.h>

#include "analysis/static/static.h"
#include "base/memory.h"
#include "math/dense.h"
#include "math/inertia.h"
#include "math/krylov.h"
#include "sim/access.h"
#include "system/solve/solve.h"

/* Fractions of the expected value: the first lower bound, and the next one relative to the last that failed. */
#define DMB_SOFTEST_BELOW 0.9
#define DMB_SOFTEST_FURTHER 0.6
/* [-] Residual of the Lanczos vectors, whose square over the distance to the next value is the error; margin below the
 * result at which eigenvalues are counted, and width of the interval at which bisection ends. */
#define DMB_SOFTEST_TOLERANCE 1e-5
#define DMB_SOFTEST_MARGIN 1e-7
/* Relative change of a shift at which a block is singular. */
#define DMB_SOFTEST_ASIDE 1e-13
enum { DMB_SOFTEST_ASIDES = 4, DMB_SOFTEST_SMOOTHINGS = 2, DMB_SOFTEST_BRACKET = 60 };
/* Vectors after which the iteration is started again from its last shape, with a bound nearer by this factor; and
 * number of starts. */
#define DMB_SOFTEST_NEARER 0.05
enum { DMB_SOFTEST_VECTORS = 20, DMB_SOFTEST_STARTS = 6 };

/* ---- Memory ------------------------------------------------------------------------------------------------------ */

static void lay_out(dmb_arena *arena, const dmb_scene *scene, dmb_softest *s)
{
    const dmb_block_layout *layout = &scene->layout;
    s->diagonal = DMB_ARENA_DOUBLES(arena, layout->diag[layout->n]);
    s->lower = DMB_ARENA_DOUBLES(arena, layout->link[layout->n - 1]);
    s->upper = DMB_ARENA_DOUBLES(arena, layout->link[layout->n - 1]);
    s->lateral = DMB_ARENA_DOUBLES(arena, scene->row_count);
    s->product = DMB_ARENA_DOUBLES(arena, scene->row_count);
    s->solution = DMB_ARENA_DOUBLES(arena, scene->row_count);
    s->multiplier = DMB_ARENA_DOUBLES(arena, scene->constraint_row_count);
}

int32_t dmb_softest_open(const dmb_sim *sim, dmb_softest *s)
{
    const dmb_scene *scene = dmb_dense_scene(sim->scene);
    dmb_arena arena;
    dmb_arena_count(&arena);
    lay_out(&arena, scene, s);
    s->bytes = dmb_arena_block_size(&arena);
    s->block = dmb_allocate(&sim->allocator, s->bytes);
    if (s->block == NULL) return DMB_ERR_NO_MEMORY;
    dmb_arena_place(&arena, s->block, s->bytes);
    lay_out(&arena, scene, s);
    return DMB_OK;
}

void dmb_softest_close(dmb_softest *s, const dmb_sim *sim)
{
    if (s->block != NULL) dmb_release(&sim->allocator, s->block, s->bytes);
    memset(s, 0, sizeof *s);
}

/* ---- K and E ----------------------------------------------------------------------------------------------------- */

/* Diagonal of E; returns its number of ones. Twist and stretch of a long string are softer than its lateral stiffness,
 * and do not change with its load: therefore E omits them. */
static uint32_t make_lateral(dmb_softest *s)
{
    const dmb_scene *scene = s->sim->scene;
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t size = scene->layout.size[i], row = scene->layout.row[i];
        for (uint32_t c = 0; c < size; c++) {
            const int moves = size == DMB_NODE_SIX_DOF && (c == 1 || c == 2) && scene->solved_row[row + c];
            s->lateral[row + c] = moves;
            count += (uint32_t)moves;
        }
    }
    return count;
}

static void keep_matrix(dmb_softest *s)
{
    const dmb_sim *sim = s->sim;
    const dmb_block_layout *layout = &sim->scene->layout;
    const size_t link = layout->link[layout->n - 1] * sizeof(double);
    memcpy(s->diagonal, sim->stiffness_diagonal, layout->diag[layout->n] * sizeof(double));
    memcpy(s->lower, sim->stiffness_lower, link);
    memcpy(s->upper, sim->stiffness_upper, link);
}

/* K - p E in the place of the iteration matrix. */
static void shift(dmb_softest *s, double p)
{
    dmb_sim *sim = s->sim;
    const dmb_block_layout *layout = &sim->scene->layout;
    const size_t link = layout->link[layout->n - 1] * sizeof(double);
    memcpy(sim->stiffness_diagonal, s->diagonal, layout->diag[layout->n] * sizeof(double));
    memcpy(sim->stiffness_lower, s->lower, link);
    memcpy(sim->stiffness_upper, s->upper, link);
    for (uint32_t i = 0; i < layout->n; i++)
        for (uint32_t c = 0; c < layout->size[i]; c++)
            dmb_stiffness_of(sim, i)[(size_t)(layout->size[i] + 1) * c] -= p * s->lateral[layout->row[i] + c];
}

/* Factors K - p E; 0 if a block stays singular. */
static int factor(dmb_softest *s, double p)
{
    dmb_block_weakest unused;
    for (int k = 0; k < DMB_SOFTEST_ASIDES; k++) {
        shift(s, p - k * DMB_SOFTEST_ASIDE * fabs(p));
        if (dmb_factor_stiffness(s->sim, &unused) < 0) return 1;
    }
    return 0;
}

/* 1: eigenvalues below p exist, 0: none; -1: they cannot be counted. */
static int exist_below(dmb_softest *s, double p)
{
    const dmb_scene *scene = s->sim->scene;
    const dmb_block_raise raise = {.share = -p, .amount = s->lateral};
    for (uint32_t c = 0; c < scene->chain_count; c++)
        if (!scene->chains[c].jointed && dmb_block_negative(&scene->layout, s->diagonal, s->lower, s->upper, &raise,
                                                            scene->chains[c].first, scene->chains[c].count) > 0)
            return 1;
    if (scene->cluster_count == 0) return 0;
    return factor(s, p) ? dmb_reduced_negative(s->sim) > 0 : -1;
}

/* ---- Lanczos vectors --------------------------------------------------------------------------------------------- */

static void metric(void *context, const double *x, double *y)
{
    const dmb_softest *s = context;
    for (uint32_t i = 0; i < s->sim->scene->row_count; i++) y[i] = s->lateral[i] * x[i];
}

/* y = (K - p E)^-1 E x by the present factors, which solve for the negative. */
static void apply(void *context, const double *x, const double *Ex, double *y)
{
    const dmb_softest *s = context;
    (void)x;
    for (uint32_t i = 0; i < s->sim->scene->row_count; i++) y[i] = -Ex[i];
    dmb_solve_for(s->sim, y, y);
}

/* Displacements under random lateral forces; the first time under those of the expected shape. */
static void draw(void *context, uint64_t *seed, double *x)
{
    dmb_softest *s = context;
    for (uint32_t i = 0; i < s->sim->scene->row_count; i++) {
        *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        s->product[i] = s->lateral[i] * (s->guess != NULL ? s->guess[i] : (double)(*seed >> 11) * 0x1p-52 - 1.0);
    }
    s->guess = NULL;
    apply(s, NULL, s->product, x);
}

static int32_t go_on(void *context)
{
    const dmb_softest *s = context;
    return dmb_progress_pulse(s->sim);
}

/* Value and shape nearest above the lower bound p: *value is an upper bound, also if they did not converge. Returns 1:
 * converged, 0: not. */
static int32_t iterate(dmb_softest *s, double p, double *value, double *x)
{
    const dmb_operator inverse = {.context = s,
                                  .length = s->sim->scene->row_count,
                                  .dimension = s->dimension,
                                  .symmetric = 1,
                                  .partly = 2,
                                  .counted = 1,
                                  .most = DMB_SOFTEST_VECTORS,
                                  .metric = metric,
                                  .apply = apply,
                                  .draw = draw,
                                  .go_on = go_on};
    dmb_krylov found;
    s->guess = x;
    const int32_t status = dmb_krylov_largest(&inverse, 1, 1, DMB_SOFTEST_TOLERANCE, &s->sim->allocator, &found);
    if (status < 0) return status;
    const int some = found.count > 0 && found.re[0] > 0.0, converged = some && !(found.next > 0.0);
    if (some) {
        *value = p + 1.0 / found.re[0];
        memcpy(x, found.x, s->sim->scene->row_count * sizeof(double));
    }
    dmb_krylov_release(&found);
    return some ? converged : DMB_ERR_NO_CONVERGENCE;
}

/* Scales to unit length in E. */
static void scale(const dmb_softest *s, double *x)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < s->sim->scene->row_count; i++) sum += s->lateral[i] * x[i] * x[i];
    for (uint32_t i = 0; i < s->sim->scene->row_count && sum > 0.0; i++) x[i] /= sqrt(sum);
}

/* ---- Bounds ------------------------------------------------------------------------------------------------------ */

/* Expected value without a guess: the Rayleigh quotient of displacements under random forces, smoothed. It is not below
 * the lowest eigenvalue if K is positive definite. NaN if K is singular. */
static double expect(dmb_softest *s, double *x)
{
    const uint32_t rows = s->sim->scene->row_count;
    uint64_t seed = 1;
    double forces = 0.0, length = 0.0;
    s->guess = NULL;
    if (!factor(s, 0.0)) return (double)NAN;
    draw(s, &seed, x);
    for (uint32_t i = 0; i < rows; i++) s->product[i] = s->lateral[i] * x[i];
    apply(s, NULL, s->product, s->solution);
    for (uint32_t i = 0; i < rows; i++) {
        forces += s->solution[i] * s->product[i];
        length += s->lateral[i] * s->solution[i] * s->solution[i];
    }
    memcpy(x, s->solution, rows * sizeof(double));
    return length > 0.0 ? forces / length : (double)NAN;
}

/* A lower bound near the expected value, which is counted: positive, or for an unstable state negative. *high: the
 * least number below which eigenvalues were counted, or infinite. 0 if there is none. From 0.9 of the expected value
 * in steps of 0.6 down to 1e-6 of it, then 0, then negative numbers whose size grows about fourfold: an unstable
 * state has a negative lowest value of unknown size. */
static int find_below(dmb_softest *s, double expected, double *low, double *high)
{
    const double unit = fabs(expected);
    *low = expected > 0.0 ? DMB_SOFTEST_BELOW * expected : 0.0;
    *high = (double)INFINITY;
    for (int k = 0; k < DMB_SOFTEST_BRACKET && unit > 0.0; k++) {
        const int below = exist_below(s, *low);
        if (below <= 0) return below == 0;
        *high = *low;
        *low = *low > 1e-6 * unit ? DMB_SOFTEST_FURTHER * *low : *low > 0.0 ? 0.0 : 4.0 * *low - unit;
    }
    return 0;
}

/* Bisects up to the margin. 0 if eigenvalues cannot be counted. */
static int bisect(dmb_softest *s, double *low, double *high)
{
    while (*high - *low > DMB_SOFTEST_MARGIN * fmax(fabs(*low), fabs(*high))) {
        const double middle = 0.5 * (*low + *high);
        const int below = dmb_progress_pulse(s->sim) < 0 ? -1 : exist_below(s, middle);
        if (below < 0) return 0;
        *(below ? high : low) = middle;
        if (*high - *low < 1e-300) break;
    }
    return 1;
}

/* Some number below which eigenvalues exist, and a lower bound that is nearer. 0 if there is none. */
static int find_above(dmb_softest *s, double unit, double *low, double *high)
{
    for (int k = 0; k < DMB_SOFTEST_BRACKET && !isfinite(*high); k++) {
        const double next = *low + ldexp(unit, k);
        const int below = exist_below(s, next);
        if (below < 0) return 0;
        *(below ? high : low) = next;
    }
    return isfinite(*high);
}

/* By bisection; the shape from inverse iterations at its lower end. */
static int32_t find_by_counts(dmb_softest *s, double unit, double low, double high, double *value, double *x)
{
    if (!find_above(s, unit, &low, &high) || !bisect(s, &low, &high) || !factor(s, low)) return DMB_ERR_NO_CONVERGENCE;
    *value = 0.5 * (low + high);
    for (int k = 0; k < DMB_SOFTEST_SMOOTHINGS; k++) {
        metric(s, x, s->product);
        apply(s, NULL, s->product, x);
        scale(s, x);
    }
    return DMB_OK;
}

/* After each start eigenvalues are counted below value - margin:
 *
 *     Lanczos vectors  eigenvalues there   then
 *     converged        none                done
 *     converged        some                bisection by counts: a lower value was missed
 *     not converged    none                next start from this nearer bound, with the last shape
 *     not converged    some                next start from the same bound; `high` is lowered
 *     either           not countable       bisection by counts */
static int32_t find(dmb_softest *s, int guessed, double *value, double *x)
{
    const double expected = guessed ? *value : expect(s, x), unit = fabs(expected);
    double low, high;
    if (!isfinite(expected) || !find_below(s, expected, &low, &high)) return DMB_ERR_NO_CONVERGENCE;
    for (int k = 0; k < DMB_SOFTEST_STARTS && factor(s, low); k++) {
        const int32_t status = iterate(s, low, value, x);
        if (status < 0 && status != DMB_ERR_NO_CONVERGENCE) return status;
        if (status < 0) break;
        const double margin = status > 0 ? DMB_SOFTEST_MARGIN * fabs(*value) : DMB_SOFTEST_NEARER * (*value - low);
        const int below = exist_below(s, *value - margin);
        if (status > 0 && below == 0) return DMB_OK;
        if (below == 0) low = *value - margin;
        if (below > 0) high = fmin(high, *value - margin);
        if (status > 0 || below < 0) break;
    }
    return find_by_counts(s, unit, low, high, value, x);
}

int32_t dmb_softest_find(dmb_softest *s, dmb_sim *sim, int guessed, double *value, double *shape)
{
    const size_t multipliers = sim->scene->constraint_row_count * sizeof(double);
    s->sim = sim;
    s->dimension = make_lateral(s);
    if (s->dimension == 0) return DMB_ERR_NO_CONVERGENCE;
    keep_matrix(s);
    memcpy(s->multiplier, sim->trial.multiplier, multipliers);
    const int32_t status = find(s, guessed, value, shape), pulse = dmb_progress_pulse(sim);
    memcpy(sim->trial.multiplier, s->multiplier, multipliers);
    return pulse < 0 ? pulse : status;
}
