/* Stability of a static state: criteria in their order. Each is tried only if the previous ones leave the result open.
 *
 *   symmetric K      signs of K (inertia of the factors), with unresolved eigenvalues if `thorough`
 *   non-symmetric K  1. look_for_none: symmetric part H + rho D positive definite, then the same of W K with friction
 *                       turned (stability_friction.c): no negative eigenvalue
 *                    2. the 12, 36, 108 eigenvalues nearest 0, until their count is complete, or agrees with the sign
 *                       of det K (`thorough`: at least the 36 nearest)
 *                    3. `thorough` only: all eigenvalues, up to 400 coordinates; beyond, -1 if none was negative
 *
 * The functions also measure the asymmetry of an iteration matrix of statics and form its symmetric part. */
#include "analysis/static/static.h"

#include <math.h>
#include <string.h>

#include "analysis/linear/linear.h"
#include "math/inertia.h"
#include "math/krylov.h"
#include "sim/access.h"
#include "system/solve/solve.h"

/* Fraction of the largest stiffness, rotations over the length scale, that counts as 0 for a non-symmetric one. */
#define DMB_STIFFNESS_ROUNDING 1e-14

/* ---- Symmetric part ---------------------------------------------------------------------------------------------- */

/* Replaces U and L^T of shape (n, m) by their mean. */
static void average_link(uint32_t n, uint32_t m, double *U, double *L)
{
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = 0; j < m; j++)
            U[(size_t)m * i + j] = L[(size_t)n * j + i] = 0.5 * (U[(size_t)m * i + j] + L[(size_t)n * j + i]);
}

static void average_block(uint32_t n, double *D)
{
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = 0; j < i; j++)
            D[(size_t)n * i + j] = D[(size_t)n * j + i] = 0.5 * (D[(size_t)n * i + j] + D[(size_t)n * j + i]);
}

void dmb_make_blocks_symmetric(const dmb_block_layout *layout, double *diagonal, double *lower, double *upper)
{
    for (uint32_t k = 0; k < layout->n; k++) {
        average_block(layout->size[k], diagonal + layout->diag[k]);
        if (k + 1 < layout->n)
            average_link(layout->size[k], layout->size[k + 1], upper + layout->link[k], lower + layout->link[k]);
    }
}

void dmb_make_reduced_symmetric(const dmb_sim *sim, double *values)
{
    const dmb_block_pattern *pattern = &sim->scene->pattern;
    for (uint32_t k = 0; k < pattern->n; k++) {
        const uint32_t n = sim->reduced_size[pattern->order[k]];
        average_block(n, values + pattern->diagonal[k]);
        for (uint32_t e = pattern->column[k]; e < pattern->column[k + 1]; e++)
            average_link(n, sim->reduced_size[pattern->order[pattern->later[e]]], values + pattern->upper[e],
                         values + pattern->lower[e]);
    }
}

/* ---- Asymmetry --------------------------------------------------------------------------------------------------- */

/* Largest relative difference of entries ij of A, shape (n, m), and ji of B, shape (m, n); D: diagonal blocks of i and
 * j. */
static double worst_pair(uint32_t n, uint32_t m, const double *A, const double *B, const double *const D[2],
                         double rounding)
{
    double worst = 0.0;
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = 0; j < m; j++) {
            const double apart = fabs(A[(size_t)m * i + j] - B[(size_t)n * j + i]);
            if (!(apart > rounding)) continue;
            const double size = sqrt(fabs(D[0][(size_t)(n + 1) * i] * D[1][(size_t)(m + 1) * j]));
            worst = fmax(worst, apart / fmax(size, rounding));
        }
    return worst;
}

static double asymmetry_of_chain(const dmb_sim *sim, const dmb_chain *chain, double rounding)
{
    const dmb_block_layout *layout = &sim->scene->layout;
    double worst = 0.0;
    for (uint32_t k = chain->first; k < chain->first + chain->count; k++) {
        const uint32_t n = layout->size[k];
        const double *D = sim->stiffness_diagonal + layout->diag[k];
        const double *const here[2] = {D, D}, *const next[2] = {D, sim->stiffness_diagonal + layout->diag[k + 1]};
        worst = fmax(worst, worst_pair(n, n, D, D, here, rounding));
        if (k + 1 == chain->first + chain->count) continue;
        worst = fmax(worst, worst_pair(n, layout->size[k + 1], sim->stiffness_upper + layout->link[k],
                                       sim->stiffness_lower + layout->link[k], next, rounding));
    }
    return worst;
}

static double asymmetry_of_reduced(const dmb_sim *sim, double rounding)
{
    const dmb_block_pattern *pattern = &sim->scene->pattern;
    const double *values = sim->reduced_value;
    double worst = 0.0;
    for (uint32_t k = 0; k < pattern->n; k++) {
        const uint32_t n = sim->reduced_size[pattern->order[k]];
        const double *D = values + pattern->diagonal[k];
        const double *const here[2] = {D, D};
        worst = fmax(worst, worst_pair(n, n, D, D, here, rounding));
        for (uint32_t e = pattern->column[k]; e < pattern->column[k + 1]; e++) {
            const uint32_t later = pattern->later[e];
            const double *const both[2] = {D, values + pattern->diagonal[later]};
            worst = fmax(worst, worst_pair(n, sim->reduced_size[pattern->order[later]], values + pattern->upper[e],
                                           values + pattern->lower[e], both, rounding));
        }
    }
    return worst;
}

double dmb_asymmetry_of(const dmb_sim *sim, double rounding)
{
    const dmb_scene *scene = sim->scene;
    const double arm = fmax(1.0, scene->length_scale), unit = rounding * arm * arm;
    double worst = scene->cluster_count ? asymmetry_of_reduced(sim, unit) : 0.0;
    for (uint32_t c = 0; c < scene->chain_count; c++)
        if (!scene->chains[c].jointed) worst = fmax(worst, asymmetry_of_chain(sim, scene->chains + c, unit));
    return worst;
}

/* ---- Iteration matrix raised by rho D ---------------------------------------------------------------------------- */

static void raise_diagonal(dmb_sim *sim, double rho, int jointed)
{
    const dmb_scene *scene = sim->scene;
    const double rotation_weight = scene->length_scale * scene->length_scale;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t size = scene->layout.size[i], row = scene->layout.row[i];
        if (scene->chains[scene->node_chain[i]].jointed != jointed) continue;
        for (uint32_t c = 0; c < size; c++)
            if (scene->solved_row[row + c])
                dmb_stiffness_of(sim, i)[(size_t)(size + 1) * c] += rho * (2 * c < size ? 1.0 : rotation_weight);
    }
}

/* *none: 1 if K has no real eigenvalue below -rho, since H + rho D (friction_turned: that of W K, rho reduced by 1 -
 * |f|/2) has no negative one; 0: it has some, a block is singular during elimination, or no friction can be turned. The
 * blocks are overwritten. Errors: those of dmb_static_evaluate, DMB_ERR_NO_MEMORY. */
static int32_t look_at_symmetric_part(dmb_static_search *state, double rho, int friction_turned, int *none)
{
    dmb_sim *sim = state->sim;
    const dmb_scene *scene = sim->scene;
    uint32_t negative = 0;
    double most = 0.0;
    const int32_t status = dmb_static_evaluate(state);
    *none = 0;
    if (status < 0) return status;
    dmb_system_iteration_matrix(&state->evaluation);
    const int32_t turned = friction_turned ? dmb_stability_turn_friction(&state->evaluation, &most) : 1;
    if (turned <= 0) return turned;
    rho *= 1.0 - 0.5 * most;
    raise_diagonal(sim, rho, 0);
    for (uint32_t c = 0; c < scene->chain_count; c++)
        if (!scene->chains[c].jointed)
            negative += dmb_block_negative(&scene->layout, sim->stiffness_diagonal, sim->stiffness_lower,
                                           sim->stiffness_upper, NULL, scene->chains[c].first, scene->chains[c].count);
    *none = negative == 0;
    if (scene->cluster_count == 0 || !*none) return DMB_OK;
    raise_diagonal(sim, rho, 1);
    dmb_reduced_assemble(sim);
    dmb_make_reduced_symmetric(sim, sim->reduced_value);
    dmb_block_sparse matrix = {sim->reduced_value, sim->reduced_pivot, sim->reduced_size};
    *none = dmb_block_sparse_factor(&scene->pattern, &matrix) < 0 && dmb_reduced_negative(sim) == 0;
    return DMB_OK;
}

/* ---- Real eigenvalues nearest 0 ---------------------------------------------------------------------------------- */

/* y = D x */
static void metric(void *context, const double *x, double *y)
{
    const dmb_sim *sim = context;
    const dmb_scene *scene = sim->scene;
    const double rotation_weight = scene->length_scale * scene->length_scale;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t size = scene->layout.size[i], row = scene->layout.row[i];
        for (uint32_t c = 0; c < size; c++) y[row + c] = (2 * c < size ? 1.0 : rotation_weight) * x[row + c];
    }
}

/* y = K^-1 D x by the present factors, which solve for -K^-1 */
static void apply(void *context, const double *x, const double *Dx, double *y)
{
    dmb_sim *sim = context;
    (void)x;
    for (uint32_t i = 0; i < sim->scene->row_count; i++) y[i] = -Dx[i];
    dmb_solve_for(sim, y, y);
}

/* Random start vector: the displacement under random forces, so that supports and joints permit it. */
static void draw(void *context, uint64_t *seed, double *x)
{
    dmb_sim *sim = context;
    const uint32_t rows = sim->scene->row_count;
    for (uint32_t i = 0; i < rows; i++) {
        *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        x[i] = (double)(*seed >> 11) * 0x1p-52 - 1.0;
    }
    dmb_solve_for(sim, x, x);
}

static int32_t go_on(void *context)
{
    return dmb_progress_pulse(context);
}

/* Number of eigenvalues: solved rows less the independent constraints of the joints. */
static uint32_t coordinates_of(const dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    uint32_t count = 0, rank = 0;
    for (uint32_t i = 0; i < scene->row_count; i++) count += scene->solved_row[i] != 0;
    for (uint32_t k = 0; k < scene->cluster_count; k++) rank += sim->partition_rank[k];
    return count - rank;
}

/* [-] Rounding splits a real double eigenvalue into two, or into a pair this close to the real axis. */
#define DMB_REAL_PAIR 1e-5

/* Number of real negative values among 1/value, without those within the rounding level. */
static int32_t count_negative(const dmb_krylov *found, double rounding)
{
    int32_t negative = 0;
    for (uint32_t i = 0; i < found->count; i++) {
        const int pair = found->im[i] != 0.0;
        if (fabs(found->im[i]) > DMB_REAL_PAIR * fabs(found->re[i])) continue;
        if (found->re[i] < 0.0 && -1.0 / found->re[i] > rounding) negative += pair ? 2 : 1;
    }
    return negative;
}

/* ---- Sign of the determinant ------------------------------------------------------------------------------------- */

/* 1: negative determinant. Row exchanges and negative pivots change the sign; factors have the reciprocal pivots on
 * their diagonals. */
static int is_negative(uint32_t n, const double *LU, int exchanged)
{
    int odd = exchanged;
    for (uint32_t k = 0; k < n; k++) odd ^= LU[(size_t)(n + 1) * k] < 0.0;
    return odd;
}

/* 1: det K < 0, by the factors of dmb_factor_stiffness. */
static int determinant_is_negative(const dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    const dmb_block_pattern *pattern = &scene->pattern;
    int odd = 0;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t n = scene->layout.size[i];
        int exchanged = 0;
        if (scene->chains[scene->node_chain[i]].jointed) continue;
        for (uint32_t k = 0; k < n; k++) exchanged ^= sim->pivot[scene->layout.row[i] + k] != k;
        odd ^= is_negative(n, sim->stiffness_diagonal + scene->layout.diag[i], exchanged);
    }
    for (uint32_t b = 0; scene->cluster_count && b < pattern->n; b++) {
        const uint32_t n = sim->reduced_size[pattern->order[b]];
        int exchanged = 0;
        for (uint32_t k = 0; k < n; k++) exchanged ^= sim->reduced_pivot[pattern->pivot[b] + k] != k;
        odd ^= is_negative(n, sim->reduced_value + pattern->diagonal[b], exchanged);
    }
    return odd ^ (scene->cluster_count ? (int)(dmb_reduced_sparse_rows(sim) & 1) : 0);
}

/* ---- Divergence -------------------------------------------------------------------------------------------------- */

#define DMB_DIVERGENCE_FIRST 12
#define DMB_DIVERGENCE_THOROUGH 36
#define DMB_DIVERGENCE_MOST 108
#define DMB_DIVERGENCE_ALL 400 /* largest number of coordinates for which all eigenvalues are computed */
#define DMB_DIVERGENCE_TOLERANCE 1e-8

typedef struct search {
    dmb_static_search *state;
    double rounding;
    int32_t odd;  /* 1: det K < 0 */
    int complete; /* 1: no other negative eigenvalues exist */
    int32_t negative;
    uint32_t wanted, dimension;
} search;

/* Limit of products for the orthogonalisation, by the square of the number of vectors times their length. */
#define DMB_DIVERGENCE_WORK 5e8
#define DMB_DIVERGENCE_LEAST 48

static size_t most_vectors(uint32_t rows)
{
    return (size_t)fmax(DMB_DIVERGENCE_LEAST, sqrt(DMB_DIVERGENCE_WORK / rows));
}

/* *none 1: a symmetric part excludes eigenvalues below -rho. The factors are overwritten. */
static int32_t look_for_none(dmb_static_search *state, double rho, int *none)
{
    const int32_t status = look_at_symmetric_part(state, rho, 0, none);
    return status < 0 || *none ? status : look_at_symmetric_part(state, rho, 1, none);
}

/* Restores the iteration matrix and its factors. */
static int32_t factor_again(dmb_static_search *state)
{
    dmb_block_weakest unused;
    const int32_t status = dmb_static_evaluate(state);
    if (status < 0) return status;
    dmb_system_iteration_matrix(&state->evaluation);
    (void)dmb_factor_stiffness(state->sim, &unused);
    return DMB_OK;
}

/* Eigenvalues nearest 0, and whether they are all that matter: beyond the last one found, of modulus 1/last, none is
 * negative if a symmetric part raised by that modulus is positive definite. That test overwrites the factors, which are
 * restored even after an error. */
static int32_t look(search *s)
{
    dmb_sim *sim = s->state->sim;
    const dmb_operator inverse = {.context = sim,
                                  .length = sim->scene->row_count,
                                  .dimension = s->dimension,
                                  .most = most_vectors(sim->scene->row_count),
                                  .metric = metric,
                                  .apply = apply,
                                  .draw = draw,
                                  .go_on = go_on};
    dmb_krylov found;
    const int32_t status =
        dmb_krylov_largest(&inverse, s->wanted, 2, DMB_DIVERGENCE_TOLERANCE, &sim->allocator, &found);
    if (status < 0) {
        (void)factor_again(s->state);
        return status;
    }
    s->negative = count_negative(&found, s->rounding);
    const double last = found.count ? hypot(found.re[found.count - 1], found.im[found.count - 1]) : 0.0;
    dmb_krylov_release(&found);
    s->complete = s->wanted >= s->dimension;
    const int32_t looked = s->complete || !(last > 0.0) ? DMB_OK : look_for_none(s->state, 1.0 / last, &s->complete);
    return looked < 0 ? looked : factor_again(s->state);
}

/* Computes all eigenvalues. */
static int32_t look_at_all(search *s)
{
    s->wanted = s->dimension;
    const int32_t status = look(s);
    return status == DMB_ERR_NO_CONVERGENCE ? DMB_OK : status;
}

/* The sign of det K is the parity of the number of negative real eigenvalues, because complex pairs have positive
 * products: a count of the wrong parity has missed one. -1 is returned if no count was complete or had the right
 * parity. */
static int32_t judge_unsymmetric(dmb_static_search *state, int thorough, dmb_stability *out)
{
    search s = {.state = state,
                .rounding = out->rounding,
                .odd = determinant_is_negative(state->sim),
                .wanted = DMB_DIVERGENCE_FIRST,
                .dimension = coordinates_of(state->sim)};
    int none;
    out->odd = s.odd;
    int32_t status = look_for_none(state, out->rounding, &none);
    if (status >= 0) status = factor_again(state);
    out->negative = 0;
    if (status < 0 || none) return status;
    out->negative = -1;
    for (int agrees = 0; !s.complete && s.wanted <= DMB_DIVERGENCE_MOST &&
                         !(agrees && !(thorough && s.wanted <= DMB_DIVERGENCE_THOROUGH));
         s.wanted *= 3) {
        if (s.wanted > s.dimension) s.wanted = s.dimension;
        const int32_t looked = look(&s);
        if (looked == DMB_ERR_NO_CONVERGENCE) return DMB_OK;
        if (looked < 0) return looked;
        agrees = (s.negative & 1) == s.odd;
        if (s.complete || agrees) out->negative = s.negative;
    }
    if (!thorough || s.complete) return DMB_OK;
    status = s.dimension <= DMB_DIVERGENCE_ALL ? look_at_all(&s) : DMB_OK;
    out->negative = s.complete || s.negative > 0 ? s.negative : -1;
    return status;
}

/* ---- Assessment -------------------------------------------------------------------------------------------------- */

/* Signs of a symmetric K, and its factors. */
static int32_t judge_symmetric(dmb_sim *sim, int thorough, dmb_block_weakest *weakest, int64_t *bad, dmb_stability *out)
{
    dmb_signs signs;
    const int32_t status = dmb_stiffness_signs_of(sim, thorough, out->amount, &signs);
    *bad = dmb_factor_stiffness(sim, weakest);
    out->negative = signs.negative;
    out->odd = signs.negative & 1;
    out->unresolved = signs.unresolved;
    out->bound = signs.bound;
    return status;
}

int32_t dmb_stability_judge(dmb_static_search *state, int thorough, dmb_block_weakest *weakest, int64_t *bad,
                            dmb_stability *out)
{
    dmb_sim *sim = state->sim;
    dmb_system_iteration_matrix(&state->evaluation);
    if (sim->scene->cluster_count) dmb_reduced_assemble(sim);
    out->rounding = out->bound = DMB_STIFFNESS_ROUNDING * dmb_stiffness_largest(sim);
    out->unresolved = 0;
    out->asymmetry = dmb_asymmetry_of(sim, out->rounding);
    out->stiffness = out->asymmetry > DMB_UNSYMMETRIC ? DMB_STIFFNESS_UNSYMMETRIC : DMB_STIFFNESS_SYMMETRIC;
    if (out->stiffness == DMB_STIFFNESS_SYMMETRIC) return judge_symmetric(sim, thorough, weakest, bad, out);
    if (out->amount != NULL) dmb_stiffness_amounts(sim, out->amount);
    *bad = dmb_factor_stiffness(sim, weakest);
    out->negative = out->odd = 0;
    return *bad >= 0 ? DMB_OK : judge_unsymmetric(state, thorough, out);
}
