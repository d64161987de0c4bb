/* Norm of the residual against its bound, and linear algebra of a Newton iteration.
 *
 *     factors (sim->factors)   made by                    solved by                                     used in
 *     ----------------------   ------------------------   -------------------------------------------   ---------------
 *     FRESH                    dmb_factor_matrix          inverses of blocks, from both ends            steps
 *                                                         (eq:integration.elimination)
 *     REUSED                   dmb_keep_factors, a step   the same, in the frames of that step          steps without
 *                              of the same length                                                       joints
 *     LU                       dmb_factor_stiffness       block LU with pivots                          statics, start
 *     (with joints)            dmb_reduced_factor         reduced system of the jointed chains          all
 *
 * A mass matrix is the iteration matrix of an evaluation of inertia alone (make_mass_matrix). */
#include "system/solve/solve.h"

#include <float.h>
#include <string.h>

#include "kernel/kernels.h"
#include "sim/chunks.h"
#include "sim/node.h"

/* [-] Residual counted as zero, in units of the rounding of poses times EA/L of stiff elements. */
#define DMB_ROUNDING_UNITS 4.0

typedef struct norms {
    double rest, all; /* squares of the residual and of its terms, [N2] */
} norms;

/* Completes the sums of nodes of one size: translations have weight 1, rotations 1/`arm`. The kernels sum DMB_SQUARES
 * columns side by side; column c holds component c mod size, so that nodes of 2 and of 6 rows share one loop. */
static void add_components(uint32_t size, double arm, const double *rest, const double *all, norms *n)
{
    for (uint32_t c = 0; c < DMB_SQUARES; c++) {
        const double weight = 2 * (c % size) < size ? 1.0 : arm;
        n->rest += weight * rest[c];
        n->all += weight * all[c];
    }
}

/* Number of consecutive nodes from `first` on with the same number of rows, 2 or 6. */
static uint32_t nodes_alike(const dmb_scene *scene, uint32_t first, uint32_t end)
{
    const uint32_t rows = scene->layout.row[end] - scene->layout.row[first];
    uint32_t i = first + 1;
    if (rows == scene->layout.size[first] * (end - first)) return end - first;
    while (i < end && scene->layout.size[i] == scene->layout.size[first]) i++;
    return i - first;
}

/* Rows of nodes of one size, summed in chunks. */
typedef struct square_chunks {
    const dmb_sim *sim;
    uint32_t row, count, size, pieces; /* first row, nodes, rows of each */
} square_chunks;

static void sum_chunks(void *work, uint32_t first, uint32_t end)
{
    const square_chunks *in = work;
    const dmb_sim *sim = in->sim;
    for (uint32_t i = first; i < end; i++) {
        const uint32_t begin = dmb_chunk_begin(in->count, in->pieces, i), row = in->row + in->size * begin;
        const uint32_t count = dmb_chunk_begin(in->count, in->pieces, i + 1) - begin;
        dmb_chunk_squares *out = sim->chunk_squares + i;
        sim->scene->kernels->squares(in->size * count, sim->residual + row, sim->scale_row + row,
                                     sim->scene->solved_row + row, out->rest, out->all);
    }
}

static void squares_of(const dmb_sim *sim, uint32_t row, uint32_t count, uint32_t size, dmb_chunk_squares *sum)
{
    square_chunks in = {sim, row, count, size, dmb_chunks_of(count)};
    if (in.pieces == 1) {
        sim->scene->kernels->squares(size * count, sim->residual + row, sim->scale_row + row,
                                     sim->scene->solved_row + row, sum->rest, sum->all);
        return;
    }
    memset(sum, 0, sizeof *sum);
    dmb_chunks_run(sim, in.pieces, 1, sum_chunks, &in);
    for (uint32_t i = 0; i < in.pieces; i++)
        for (uint32_t c = 0; c < DMB_SQUARES; c++) {
            sum->rest[c] += sim->chunk_squares[i].rest[c];
            sum->all[c] += sim->chunk_squares[i].all[c];
        }
}

/* Of one chain: moments are divided by its length, so that a residual is compared with forces of the same part. */
static norms norms_of(const dmb_sim *sim, const dmb_chain *chain)
{
    const dmb_scene *scene = sim->scene;
    const double arm = 1.0 / (chain->length * chain->length);
    const uint32_t end = chain->first + chain->count;
    norms n = {0.0, 0.0};
    for (uint32_t i = chain->first, count; i < end; i += count) {
        const uint32_t size = scene->layout.size[i];
        dmb_chunk_squares sum;
        count = nodes_alike(scene, i, end);
        squares_of(sim, scene->layout.row[i], count, size, &sum);
        add_components(size, arm, sum.rest, sum.all, &n);
    }
    return n;
}

/* Compares a residual with its bound. The rounding of poses counts with elements and joints; for bodies alone at rest;
 * and on springs without walls in a step after a correction by its own tangent: the forces of a stiff spring that has
 * come to rest are nothing but rounding. Overflow never converges, because everything is small relative to infinity. */
static int32_t judge(const dmb_evaluation *evaluation, const dmb_chain *chain, double tolerance, double part, norms n)
{
    const double floor = DMB_ROUNDING_UNITS * DBL_EPSILON;
    if (!(n.all <= DBL_MAX)) return 0;
    if (n.rest <= tolerance * tolerance * n.all) return DMB_CONVERGED;
    const dmb_scene *scene = evaluation->sim->scene;
    const int corrected = !evaluation->dynamic || (evaluation->extrapolated && scene->site_count == 0);
    const int stiff = chain->count > 1 || chain->jointed || (corrected && scene->element_count == 0);
    if (stiff && n.rest <= floor * floor * evaluation->rounding) return DMB_AT_ROUNDING;
    return n.rest <= part ? DMB_SMALL_PART : 0;
}

/* [N2] Squared bound of a chain from its initial residual. share and most are those of eq:integration.stop: a fraction
 * of the start, but below a fraction of the forces. */
static double part_of(const dmb_sim *sim, uint32_t c, const dmb_residual_bound *bound, norms n)
{
    if (!(bound->share > 0.0)) return 0.0;
    return fmin(bound->share * bound->share * sim->chain_start[c], bound->most * bound->most * n.all);
}

static double relative_of(norms n)
{
    if (!(n.all <= DBL_MAX)) return (double)INFINITY;
    return n.all > 0.0 ? sqrt(n.rest / n.all) : 0.0;
}

/* The worse of two results of comparisons. Order from worst to best: above the bound, a small part of the start, at
 * rounding, converged. */
static int32_t worse(int32_t a, int32_t b)
{
    if (a == 0 || b == 0) return 0;
    if (a == DMB_SMALL_PART || b == DMB_SMALL_PART) return DMB_SMALL_PART;
    return a == DMB_AT_ROUNDING ? a : b;
}

/* Every chain must meet its own bound: a light body beside a heavy string is not compared with the string's forces. The
 * bound returned is that of the chain which exceeds its bound most. */
dmb_residual_norm dmb_residual_norm_within(const dmb_evaluation *evaluation, const dmb_residual_bound *bound)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    dmb_residual_norm norm = {0.0, 0.0, 0.0, bound->tolerance, DMB_CONVERGED, 0};
    double excess = 0.0;
    for (uint32_t c = 0; c < scene->chain_count; c++) {
        const norms n = norms_of(sim, scene->chains + c);
        if (bound->start) sim->chain_start[c] = n.rest;
        const double part = part_of(sim, c, bound, n), relative = relative_of(n);
        norm.converged = worse(norm.converged, judge(evaluation, scene->chains + c, bound->tolerance, part, n));
        norm.relative = fmax(norm.relative, relative);
        if (n.all > 0.0) norm.start = fmax(norm.start, sqrt(sim->chain_start[c] / n.all));
        norm.balance += n.all;
        if (!(bound->share > 0.0)) continue;
        const double own = n.all > 0.0 ? fmax(bound->tolerance, sqrt(part / n.all)) : bound->tolerance;
        if (relative > excess * own) {
            excess = relative / own;
            norm.bound = own;
        }
    }
    norm.balance = sqrt(norm.balance);
    return norm;
}

void dmb_residual_begins_at(dmb_sim *sim)
{
    for (uint32_t c = 0; c < sim->scene->chain_count; c++)
        sim->chain_start[c] = norms_of(sim, sim->scene->chains + c).rest;
}

dmb_residual_norm dmb_residual_norm_of(const dmb_evaluation *evaluation, double tolerance)
{
    const dmb_residual_bound bound = {tolerance, 0.0, 0.0, 0};
    return dmb_residual_norm_within(evaluation, &bound);
}

static dmb_block_matrix matrix_of(const dmb_sim *sim)
{
    const dmb_block_matrix matrix = {sim->stiffness_diagonal, sim->stiffness_lower, sim->stiffness_upper, sim->pivot};
    return matrix;
}

/* ---- Chains, both ends of each at once --------------------------------------------------------------------------- */

/* Smallest number of blocks of a chain whose ends are factorised as separate chunks. */
enum { DMB_ENDS_FROM = 64 };

static int has_ends(const dmb_chain *chain)
{
    return chain->count >= DMB_ENDS_FROM && !chain->jointed;
}

/* Chunk 2 c + side is an end of chain c. */
typedef struct ends_work {
    const dmb_sim *sim;
    dmb_block_matrix matrix;
    double *rhs;
    int32_t away, reserved;
} ends_work;

/* Factorises ends of chains; the first singular block of each end goes into end_singular. */
static void factor_ends(void *work, uint32_t first, uint32_t end)
{
    ends_work *in = work;
    const dmb_scene *scene = in->sim->scene;
    for (uint32_t i = first; i < end; i++) {
        const dmb_chain *chain = scene->chains + i / 2;
        if (!has_ends(chain)) continue;
        in->sim->end_singular[i] =
            scene->kernels->factor_part(&scene->layout, &in->matrix, chain->first, chain->count, i % 2);
    }
}

/* The singular block that a serial factorisation would find first, alternating between both ends. The message then
 * names the same node with and without threads. */
static int64_t first_singular(const dmb_chain *chain, const int64_t at[2])
{
    const uint32_t last = chain->first + chain->count - 1, extra = chain->count % 2 == 0;
    if (at[0] < 0 || at[1] < 0) return at[0] < 0 ? at[1] : at[0];
    return at[0] - chain->first <= (int64_t)last - at[1] + extra ? at[0] : at[1];
}

/* parts: the ends have been eliminated as chunks, the middle block is left (part 2). */
static int64_t factor_chain(const dmb_sim *sim, dmb_block_matrix *matrix, uint32_t c, int parts)
{
    const dmb_scene *scene = sim->scene;
    const dmb_chain *chain = scene->chains + c;
    if (chain->jointed) return -1;
    if (!parts || !has_ends(chain)) return scene->kernels->factor(&scene->layout, matrix, chain->first, chain->count);
    const int64_t bad = first_singular(chain, sim->end_singular + 2 * (size_t)c);
    return bad >= 0 ? bad : scene->kernels->factor_part(&scene->layout, matrix, chain->first, chain->count, 2);
}

/* Factorises chains without joints. */
static int64_t factor_chains(const dmb_sim *sim, dmb_block_matrix *matrix)
{
    const int parts = dmb_chunks_are_open(sim);
    ends_work work = {sim, *matrix, NULL, 0, 0};
    int64_t bad = -1;
    if (parts) dmb_chunks_run(sim, 2 * sim->scene->chain_count, 1, factor_ends, &work);
    for (uint32_t c = 0; c < sim->scene->chain_count && bad < 0; c++) bad = factor_chain(sim, matrix, c, parts);
    return bad;
}

static void solve_ends(void *work, uint32_t first, uint32_t end)
{
    const ends_work *in = work;
    const dmb_scene *scene = in->sim->scene;
    for (uint32_t i = first; i < end; i++) {
        const dmb_chain *chain = scene->chains + i / 2;
        if (has_ends(chain))
            (in->away ? scene->kernels->away_part : scene->kernels->towards_part)(
                &scene->layout, &in->matrix, chain->first, chain->count, i % 2, in->rhs);
    }
}

static void solve_chain(const dmb_scene *scene, const dmb_block_matrix *factors, uint32_t c, int parts, double *z)
{
    const dmb_chain *chain = scene->chains + c;
    if (chain->jointed) return;
    if (parts && has_ends(chain))
        scene->kernels->towards_part(&scene->layout, factors, chain->first, chain->count, 2, z);
    else
        scene->kernels->solve(&scene->layout, factors, chain->first, chain->count, z);
}

/* With threads: both ends towards the middle, the middle, then away from it; without, the same operations in one call.
 * The bits are equal, because each end has its own rows. */
static void solve_chains(const dmb_sim *sim, const dmb_block_matrix *factors, double *z)
{
    const uint32_t chains = sim->scene->chain_count;
    const int parts = dmb_chunks_are_open(sim);
    ends_work work = {sim, *factors, z, 0, 0};
    if (parts) dmb_chunks_run(sim, 2 * chains, 1, solve_ends, &work);
    for (uint32_t c = 0; c < chains; c++) solve_chain(sim->scene, factors, c, parts, z);
    work.away = 1;
    if (parts) dmb_chunks_run(sim, 2 * chains, 1, solve_ends, &work);
}

int64_t dmb_factor_matrix(dmb_sim *sim, int32_t method)
{
    const dmb_scene *scene = sim->scene;
    *sim->factors = DMB_FACTORS_FRESH;
    dmb_block_matrix matrix = matrix_of(sim);
    const int64_t bad = factor_chains(sim, &matrix);
    if (bad >= 0) return bad;
    return scene->cluster_count ? dmb_reduced_factor(sim, method, NULL) : -1;
}

/* LU with pivots inside the blocks: without mass in the diagonal its blocks may be nearly singular, and the weakest
 * pivot shows motion that nothing constrains. */
int64_t dmb_factor_stiffness(dmb_sim *sim, dmb_block_weakest *weakest)
{
    const dmb_scene *scene = sim->scene;
    *sim->factors = DMB_FACTORS_LU;
    dmb_block_matrix matrix = matrix_of(sim);
    dmb_block_weakest chain_weakest;
    weakest->ratio = (double)INFINITY;
    for (uint32_t c = 0; c < scene->chain_count; c++) {
        const dmb_chain *chain = scene->chains + c;
        if (chain->jointed) continue;
        const int64_t bad =
            dmb_block_factor_watched(&scene->layout, &matrix, chain->first, chain->count, &chain_weakest);
        if (chain_weakest.ratio < weakest->ratio) *weakest = chain_weakest;
        if (bad >= 0) return bad;
    }
    if (scene->cluster_count == 0) return -1;
    const int64_t bad = dmb_reduced_factor(sim, DMB_METHOD_INDEPENDENT, &chain_weakest);
    if (chain_weakest.ratio < weakest->ratio) *weakest = chain_weakest;
    return bad;
}

static void clear_stiffness(void *work, uint32_t first, uint32_t end)
{
    const dmb_sim *sim = work;
    const uint32_t *diag = sim->scene->layout.diag;
    memset(sim->stiffness_diagonal + diag[first], 0, (diag[end] - diag[first]) * sizeof(double));
}

/* Mass matrix: the iteration matrix without stiffness. Elements observe inertia_only; the tangents that other forces
 * have added to the diagonal blocks are cleared. */
static int32_t make_mass_matrix(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    evaluation->inertia_only = 1;
    const int32_t status = dmb_system_evaluate(evaluation);
    evaluation->inertia_only = 0;
    if (status < 0) return status;
    dmb_chunks_run(sim, sim->scene->node_count, DMB_GRAIN, clear_stiffness, sim);
    memset(sim->constraint_tangent, 0, sim->scene->tangent_count * sizeof(double));
    dmb_system_iteration_matrix(evaluation);
    return status;
}

int32_t dmb_factor_mass(dmb_evaluation *evaluation)
{
    dmb_block_weakest unused;
    const int32_t status = make_mass_matrix(evaluation);
    if (status < 0) return status;
    const int64_t bad = dmb_factor_stiffness(evaluation->sim, &unused);
    evaluation->element = (uint32_t)bad;
    return bad >= 0 ? DMB_ERR_SINGULAR : DMB_OK;
}

int32_t dmb_factor_mass_in_step(dmb_evaluation *evaluation)
{
    const int32_t status = make_mass_matrix(evaluation);
    if (status < 0) return status;
    const int64_t bad = dmb_factor_matrix(evaluation->sim, DMB_METHOD_INDEPENDENT);
    evaluation->element = (uint32_t)bad;
    return bad >= 0 ? DMB_ERR_SINGULAR : DMB_OK;
}

static void clear_constrained(const dmb_scene *scene, double *z)
{
    for (uint32_t i = 0; i < scene->constrained_count; i++)
        z[scene->layout.row[scene->constrained_node[i]] + scene->constrained_component[i]] = 0.0;
}

/* Solves with the LU factors of dmb_factor_stiffness. */
static void solve_stiffness(const dmb_scene *scene, const dmb_block_matrix *factors, double *z)
{
    for (uint32_t c = 0; c < scene->chain_count; c++)
        if (!scene->chains[c].jointed)
            dmb_block_solve(&scene->layout, factors, scene->chains[c].first, scene->chains[c].count, z);
}

/* Prescribed rows of the right-hand side are 0 (their residual is a reaction), so that z is 0 there. */
void dmb_solve_for(dmb_sim *sim, const double *residual, double *z)
{
    const dmb_scene *scene = sim->scene;
    const dmb_block_matrix matrix = matrix_of(sim);
    scene->kernels->negate(scene->row_count, residual, z);
    clear_constrained(scene, z);
    if (*sim->factors == DMB_FACTORS_REUSED) {
        dmb_solve_reused(sim, z);
        return;
    }
    if (*sim->factors == DMB_FACTORS_LU)
        solve_stiffness(scene, &matrix, z);
    else
        solve_chains(sim, &matrix, z);
    if (scene->cluster_count) dmb_reduced_solve(sim, z);
}

void dmb_solve_correction(dmb_sim *sim)
{
    dmb_solve_for(sim, sim->residual, sim->correction);
}

static void swap_blocks(double **a, double **b)
{
    double *const other = *a;
    *a = *b;
    *b = other;
}

/* Pointers are exchanged, no numbers. */
void dmb_factors_swap(dmb_sim *sim, dmb_factor_set *with)
{
    uint8_t *const pivot = sim->pivot;
    const int32_t kind = *sim->factors;
    swap_blocks(&sim->stiffness_diagonal, &with->diagonal);
    swap_blocks(&sim->stiffness_lower, &with->lower);
    swap_blocks(&sim->stiffness_upper, &with->upper);
    sim->pivot = with->pivot;
    with->pivot = pivot;
    *sim->factors = with->kind;
    with->kind = kind;
}

void dmb_solve_refined(dmb_sim *sim, const dmb_block_matrix *matrix, double *product)
{
    const dmb_scene *scene = sim->scene;
    const uint32_t rows = scene->row_count;
    dmb_solve_correction(sim);
    for (uint32_t c = 0; c < scene->chain_count; c++)
        dmb_block_multiply(&scene->layout, matrix, scene->chains[c].first, scene->chains[c].count, sim->correction,
                           product);
    for (uint32_t i = 0; i < rows; i++) product[i] += sim->residual[i];
    dmb_solve_for(sim, product, product);
    for (uint32_t i = 0; i < rows; i++) sim->correction[i] += product[i];
}

/* The factors change place with those kept before, whose memory the next matrix overwrites. */
void dmb_keep_factors(dmb_sim *sim, const double *quaternion)
{
    swap_blocks(&sim->stiffness_diagonal, &sim->reused_diagonal);
    swap_blocks(&sim->stiffness_lower, &sim->reused_lower);
    swap_blocks(&sim->stiffness_upper, &sim->reused_upper);
    if (sim->scene->site_count) memcpy(sim->reused_quaternion, quaternion, 4 * sim->scene->node_count * sizeof(double));
}

/* Factors are saved and hashed with the state: without factors the memory is zero, so that equal states have equal
 * bytes. */
void dmb_forget_factors(dmb_sim *sim)
{
    const dmb_block_layout *layout = &sim->scene->layout;
    const uint32_t n = sim->scene->node_count;
    memset(sim->reuse, 0, sizeof *sim->reuse);
    if (sim->scene->cluster_count) return; /* no memory for them */
    memset(sim->reused_diagonal, 0, layout->diag[n] * sizeof(double));
    memset(sim->reused_lower, 0, layout->link[n - 1] * sizeof(double));
    memset(sim->reused_upper, 0, layout->link[n - 1] * sizeof(double));
    if (sim->scene->site_count) memset(sim->reused_quaternion, 0, 4 * n * sizeof(double));
}

/* Transforms rows of six-DOF nodes from one set of body frames to another. */
typedef struct twist_work {
    const dmb_scene *scene;
    const double *from, *to;
    double *rows;
} twist_work;

static void twist_nodes(void *work, uint32_t first, uint32_t end)
{
    const twist_work *in = work;
    for (uint32_t i = first, count; i < end; i += count) {
        count = dmb_six_dof_nodes_before(in->scene, i, end);
        const dmb_twist_args args = {count, 0, in->from + 4 * i, in->to + 4 * i, in->rows + in->scene->layout.row[i]};
        if (count > 0)
            in->scene->kernels->twist(&args);
        else
            count = 1;
    }
}

static void twist_rows(const dmb_sim *sim, const double *from, const double *to, double *rows)
{
    twist_work work = {sim->scene, from, to, rows};
    dmb_chunks_run(sim, sim->scene->node_count, DMB_GRAIN, twist_nodes, &work);
}

/* z is in the frames of the trial, the factors in those of the step that made them. */
void dmb_solve_reused(const dmb_sim *sim, double *z)
{
    const dmb_block_matrix factors = {sim->reused_diagonal, sim->reused_lower, sim->reused_upper, NULL};
    const int twisted = sim->scene->site_count > 0;
    if (twisted) twist_rows(sim, sim->trial.quaternion, sim->reused_quaternion, z);
    solve_chains(sim, &factors, z);
    if (twisted) twist_rows(sim, sim->reused_quaternion, sim->trial.quaternion, z);
    clear_constrained(sim->scene,
                      z); /* the twist moves them, and so may factors that were restored from forged bytes */
}
