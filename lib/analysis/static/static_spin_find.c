/* Unconstrained spins of strings: the search for them, and the check that the equilibrium does not depend on their
 * constraint. Joints may carry a torque to other parts, so that jointed chains need a global criterion:
 *
 *     chain without joints   K w + e_x x r = 0 in all solved rows, up to rounding (eq:static.spin)
 *     jointed chain          with stiffness k added at the candidates c, (K + k E E^T) z = k e_c: the fraction of the
 *                            torque that other supports carry is 1 - E^T z. This matrix is singular if K is, and its
 *                            null space is that of K restricted to the candidates
 *
 * The second criterion factorises K, and is used only if a jointed chain has a candidate. The spins found by the first
 * one take part in it: without the stiffness added there K would be singular. */
#include "analysis/static/static.h"

#include <math.h>
#include <string.h>

#include "system/solve/solve.h"

/* [-] Rounding level of eq:static.spin, over the root of the product of the two diagonal entries. */
#define DMB_SPIN_ROUNDING 1e-11

/* [-] Fraction of a unit torque at one node that other supports carry; below it the torque is unresisted. */
#define DMB_SPIN_SHARE 1e-10

/* [-] Stiffness added at a node in a jointed chain over its own: the remaining rotation is negligible. */
#define DMB_SPIN_STIFFER 1e6

/* Entry of e_x x r of a node; 0 for axial-torsional nodes (size 2). */
static double turned_residual(const dmb_sim *sim, uint32_t node, uint32_t c)
{
    const double *r = sim->residual + sim->scene->layout.row[node];
    if (sim->scene->layout.size[node] != DMB_NODE_SIX_DOF || c % 3 == 0) return 0.0;
    return c % 3 == 1 ? -r[c + 1] : r[c - 1];
}

/* Row c of a node in K w + e_x x r. */
static double spin_force(dmb_sim *sim, const dmb_chain *chain, uint32_t node, uint32_t c)
{
    const dmb_scene *scene = sim->scene;
    const dmb_block_layout *layout = &scene->layout;
    const uint32_t n = layout->size[node];
    double sum =
        dmb_stiffness_of(sim, node)[(size_t)n * c + dmb_static_spin_row(scene, node)] + turned_residual(sim, node, c);
    if (node > chain->first) {
        const uint32_t m = layout->size[node - 1];
        sum += sim->stiffness_lower[layout->link[node - 1] + (size_t)m * c + dmb_static_spin_row(scene, node - 1)];
    }
    if (node + 1 < chain->first + chain->count) {
        const uint32_t m = layout->size[node + 1];
        sum += sim->stiffness_upper[layout->link[node] + (size_t)m * c + dmb_static_spin_row(scene, node + 1)];
    }
    return sum;
}

static int nothing_resists_node(dmb_sim *sim, const dmb_chain *chain, uint32_t node)
{
    const dmb_scene *scene = sim->scene;
    const uint32_t n = scene->layout.size[node];
    const uint8_t *solved = scene->solved_row + scene->layout.row[node];
    const double *K = dmb_stiffness_of(sim, node), own = fabs(*dmb_static_spin_stiffness(sim, node));
    if (!solved[dmb_static_spin_row(scene, node)]) return 0;
    for (uint32_t c = 0; c < n; c++) {
        const double size = sqrt(own * fabs(K[(size_t)(n + 1) * c]));
        if (solved[c] && !(fabs(spin_force(sim, chain, node, c)) <= DMB_SPIN_ROUNDING * fmax(size, own))) return 0;
    }
    return 1;
}

static int nothing_resists(dmb_sim *sim, const dmb_chain *chain)
{
    for (uint32_t i = chain->first; i < chain->first + chain->count; i++)
        if (!nothing_resists_node(sim, chain, i)) return 0;
    return 1;
}

/* M (n, n), column by column: the fraction of the torque at candidate c that is missing at candidate i.
 * DMB_ERR_SINGULAR if a motion other than these spins is unconstrained, too. */
static int32_t shares(dmb_static_search *search, double *M)
{
    dmb_sim *sim = search->sim;
    const dmb_scene *scene = sim->scene;
    const uint32_t n = search->spin_count;
    dmb_block_weakest weakest;
    const int32_t status = dmb_static_evaluate(search);
    if (status < 0) return status;
    dmb_static_fix_axes(sim);
    dmb_system_iteration_matrix(&search->evaluation);
    if (dmb_factor_stiffness(sim, &weakest) >= 0) return DMB_ERR_SINGULAR;
    for (uint32_t c = 0; c < n; c++) {
        const uint32_t node = search->spins[c].node;
        memset(sim->correction, 0, scene->row_count * sizeof(double));
        sim->correction[scene->layout.row[node] + dmb_static_spin_row(scene, node)] = -search->spins[c].stiffness;
        dmb_solve_for(sim, sim->correction, sim->correction);
        for (uint32_t i = 0; i < n; i++) {
            const uint32_t at = search->spins[i].node;
            M[n * i + c] = (i == c) - sim->correction[scene->layout.row[at] + dmb_static_spin_row(scene, at)];
        }
    }
    return DMB_OK;
}

/* Elimination with complete pivoting; resisted[i] = 1 for each remaining pivot. The number of other rows is the
 * dimension of the null space. */
static void find_resisted(uint32_t n, double *M, uint8_t *resisted)
{
    memset(resisted, 0, n);
    for (uint32_t k = 0; k < n; k++) {
        uint32_t p = n;
        for (uint32_t i = 0; i < n; i++)
            if (!resisted[i] && (p == n || fabs(M[n * i + i]) > fabs(M[n * p + p]))) p = i;
        if (!(fabs(M[n * p + p]) > DMB_SPIN_SHARE)) return;
        resisted[p] = 1;
        for (uint32_t i = 0; i < n; i++) {
            if (resisted[i]) continue;
            const double factor = M[n * i + p] / M[n * p + p];
            for (uint32_t j = 0; j < n; j++) M[n * i + j] -= factor * M[n * p + j];
        }
    }
}

static int is_listed(const dmb_static_search *search, uint32_t node)
{
    for (uint32_t i = 0; i < search->spin_count; i++)
        if (search->spins[i].node == node) return 1;
    return 0;
}

/* Lists the strings in jointed chains (jointed 1), or the unresisted strings of other chains. */
static void list(dmb_static_search *search, int jointed)
{
    dmb_sim *sim = search->sim;
    const dmb_scene *scene = sim->scene;
    for (uint32_t s = 0; s < scene->string_count && search->spin_count < DMB_STATIC_SPINS; s++) {
        const dmb_chain *chain = scene->chains + scene->node_chain[scene->strings[s].first_node];
        const uint32_t node = jointed ? scene->strings[s].first_node : chain->first;
        if ((int)chain->jointed != jointed || is_listed(search, node)) continue;
        if (!scene->solved_row[scene->layout.row[node] + dmb_static_spin_row(scene, node)]) continue;
        if (!jointed && !nothing_resists(sim, chain)) continue;
        search->spins[search->spin_count++] =
            (dmb_static_spin){.node = node, .stiffness = fabs(*dmb_static_spin_stiffness(sim, node))};
    }
}

/* Keeps the candidates without a pivot, one for each dimension of the null space. A matrix that is singular despite the
 * added stiffness constrains no spin: the iteration that follows fails and names the block. */
static int32_t keep_unresisted(dmb_static_search *search)
{
    double M[DMB_STATIC_SPINS * DMB_STATIC_SPINS];
    uint8_t resisted[DMB_STATIC_SPINS];
    const uint32_t n = search->spin_count;
    const int32_t status = shares(search, M);
    search->spin_count = 0;
    if (status == DMB_ERR_SINGULAR) return DMB_OK;
    if (status < 0) return status;
    find_resisted(n, M, resisted);
    for (uint32_t i = 0; i < n; i++) {
        dmb_static_spin spin = search->spins[i];
        if (resisted[i]) continue;
        if (search->sim->scene->chains[search->sim->scene->node_chain[spin.node]].jointed)
            spin.stiffness *= DMB_SPIN_STIFFER;
        search->spins[search->spin_count++] = spin;
    }
    return DMB_OK;
}

/* Chains without joints first: their spins are certain, those of jointed chains are candidates. Beyond DMB_STATIC_SPINS
 * strings an unconstrained spin is not constrained, and the iteration finds a singular matrix. */
int32_t dmb_static_find_spins(dmb_static_search *search)
{
    search->spin_count = 0;
    search->evaluation.extrapolated = 0;
    const int32_t status = dmb_static_evaluate(search);
    if (status < 0) return status;
    list(search, 0);
    const uint32_t alone = search->spin_count;
    list(search, 1);
    return search->spin_count > alone ? keep_unresisted(search) : DMB_OK;
}

/* Evaluates once without the constraints: the residual of the constrained rows must vanish in the norm of all rows.
 * Otherwise the spin with the largest torque is named. */
int32_t dmb_static_check_spins(dmb_static_search *search)
{
    const uint32_t count = search->spin_count;
    search->unbalanced = DMB_NONE;
    if (count == 0) return DMB_OK;
    search->spin_count = 0;
    search->evaluation.extrapolated = 0;
    search->evaluation.tangent = 0;
    const int32_t status = dmb_static_evaluate(search);
    search->evaluation.tangent = 1;
    search->spin_count = count;
    if (status < 0) return status;
    const dmb_residual_norm norm = dmb_residual_norm_of(&search->evaluation, search->options->tolerance);
    if (norm.converged) return DMB_OK;
    search->residual = norm.relative;
    for (uint32_t i = 0; i < count; i++)
        if (search->unbalanced == DMB_NONE ||
            fabs(search->spins[i].torque) > fabs(search->spins[search->unbalanced].torque))
            search->unbalanced = i;
    search->block = search->spins[search->unbalanced].node;
    return DMB_ERR_SINGULAR;
}

int dmb_static_may_be_caught(const dmb_scene *scene)
{
    return scene->spring_count > 0 || scene->force_count > 0 || scene->stuck_count > 0 || scene->law_count > 0 ||
           scene->callback_count > 0;
}
