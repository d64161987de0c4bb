/* The stiffness K of a static state and the signs of its eigenvalues. Elimination counts exactly the signs of a matrix
 * whose entries differ from those of K by some eps sqrt(s_i s_j), s the size of a row (eq:signs.size). So the counts of
 * K + 4 eps S and K - 4 eps S, S = diag(s), enclose that of K: where they agree it is exact, and the eigenvalues by
 * which they differ are of rounding size (eq:signs.bounds). S scales as K does: units do not matter. */
#include "analysis/linear/linear.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "math/inertia.h"
#include "sim/access.h"
#include "sim/node.h"
#include "system/constrain/constrain.h"
#include "system/solve/solve.h"

/* 4 eps */
#define DMB_SIGNS_PART 0x1p-50
/* A diagonal entry may be the small difference of large ones: so much of the largest of its node counts at least; in
 * nodes that joints connect, whose forces take part, all of it. */
#define DMB_SIGNS_FLOOR 1e-6

/* ---- Sizes of rows ----------------------------------------------------------------------------------------------- */

static double arm_square_of(const dmb_scene *scene)
{
    return scene->length_scale * scene->length_scale;
}

/* Rows of a constraint's nodes are at least as large as its own tangent. */
static void add_tangent(const dmb_sim *sim, const dmb_constraint *c, double *size)
{
    const dmb_scene *scene = sim->scene;
    const double *T = sim->constraint_tangent + c->tangent, arm_square = arm_square_of(scene);
    double most = 0.0;
    for (int pass = 0; pass < 2; pass++)
        for (uint32_t a = 0; a < c->node_count; a++) {
            const uint32_t rows = scene->layout.size[c->node[a]], row = scene->layout.row[c->node[a]];
            for (uint32_t i = 0; i < rows; i++) {
                const double weight = 2 * i < rows ? 1.0 : arm_square;
                const size_t at = c->column[a] + i;
                if (!scene->solved_row[row + i]) continue;
                if (pass == 0) most = fmax(most, fabs(T[at * c->columns + at]) / weight);
                if (pass == 1) size[row + i] = fmax(size[row + i], weight * most);
            }
        }
}

void dmb_stiffness_row_sizes(const dmb_sim *sim, double *size)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t row = scene->layout.row[i];
        const int connected = scene->cluster_count > 0 && scene->node_cluster[i] != DMB_NONE;
        dmb_block_row_sizes(scene->layout.size[i], dmb_stiffness_of(sim, i), arm_square_of(scene),
                            scene->solved_row + row, connected ? 1.0 : DMB_SIGNS_FLOOR, size + row);
    }
    for (uint32_t k = 0; k < scene->constraint_count; k++) add_tangent(sim, scene->constraints + k, size);
}

/* ---- Counts ------------------------------------------------------------------------------------------------------ */

static uint32_t negative_of_chains(const dmb_sim *sim, double part)
{
    const dmb_scene *scene = sim->scene;
    const dmb_block_raise raise = {part, arm_square_of(scene), DMB_SIGNS_FLOOR, scene->solved_row};
    uint32_t negative = 0;
    for (uint32_t c = 0; c < scene->chain_count; c++)
        if (!scene->chains[c].jointed)
            negative +=
                dmb_block_negative(&scene->layout, sim->stiffness_diagonal, sim->stiffness_lower, sim->stiffness_upper,
                                   &raise, scene->chains[c].first, scene->chains[c].count);
    return negative;
}

typedef struct row_storage {
    double *size, *diagonal; /* (rows) of the nodes of jointed chains: sizes, diagonal of K as it is */
} row_storage;

/* K + part S in the rows of jointed chains; part 0: K. */
static void raise_joints(dmb_sim *sim, const row_storage *rows, double part)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t n = scene->layout.size[i], row = scene->layout.row[i];
        double *D = dmb_stiffness_of(sim, i);
        if (!scene->chains[scene->node_chain[i]].jointed) continue;
        for (uint32_t c = 0; c < n; c++) D[(size_t)(n + 1) * c] = rows->diagonal[row + c] + part * rows->size[row + c];
    }
}

static void keep_diagonal(const dmb_sim *sim, double *diagonal)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->node_count; i++)
        for (uint32_t c = 0; c < scene->layout.size[i]; c++)
            diagonal[scene->layout.row[i] + c] = dmb_stiffness_of(sim, i)[(size_t)(scene->layout.size[i] + 1) * c];
}

/* A block may be singular before its turn though the whole is not: a little further on it is not. */
#define DMB_SIGNS_TRIES 3

static int negative_of_joints(dmb_sim *sim, const row_storage *rows, double part, uint32_t *negative)
{
    for (int k = 0; k < DMB_SIGNS_TRIES; k++, part *= 1.25) {
        raise_joints(sim, rows, part);
        if (dmb_reduced_factor(sim, DMB_METHOD_INDEPENDENT, NULL) >= 0) continue;
        *negative += dmb_reduced_negative(sim);
        return 1;
    }
    return 0;
}

static int32_t count_joints(dmb_sim *sim, int both, uint32_t counts[2], int *counted)
{
    const size_t bytes = 2 * (size_t)sim->scene->row_count * sizeof(double);
    row_storage rows = {.size = dmb_allocate(&sim->allocator, bytes)};
    if (rows.size == NULL) return DMB_ERR_NO_MEMORY;
    rows.diagonal = rows.size + sim->scene->row_count;
    dmb_stiffness_row_sizes(sim, rows.size);
    keep_diagonal(sim, rows.diagonal);
    *counted = negative_of_joints(sim, &rows, DMB_SIGNS_PART, &counts[0]);
    if (both) *counted = negative_of_joints(sim, &rows, -DMB_SIGNS_PART, &counts[1]) && *counted;
    raise_joints(sim, &rows, 0.0);
    dmb_release(&sim->allocator, rows.size, bytes);
    return DMB_OK;
}

int32_t dmb_stiffness_signs_of(dmb_sim *sim, int both, dmb_signs *out)
{
    uint32_t counts[2] = {negative_of_chains(sim, DMB_SIGNS_PART), both ? negative_of_chains(sim, -DMB_SIGNS_PART) : 0};
    int counted = 1;
    const int32_t status = sim->scene->cluster_count ? count_joints(sim, both, counts, &counted) : DMB_OK;
    out->negative = counted ? (int32_t)counts[0] : -1;
    out->unresolved = counted && both && counts[1] > counts[0] ? (int32_t)(counts[1] - counts[0]) : 0;
    out->bound = dmb_stiffness_largest(sim) * DMB_SIGNS_PART;
    return status;
}

double dmb_stiffness_largest(const dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    double most = 0.0;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t size = scene->layout.size[i], row = scene->layout.row[i];
        for (uint32_t c = 0; c < size; c++) {
            const double weight = 2 * c < size ? 1.0 : arm_square_of(scene);
            const double stiffness = dmb_stiffness_of(sim, i)[(size_t)(size + 1) * c] / weight;
            if (scene->solved_row[row + c]) most = fmax(most, fabs(stiffness));
        }
    }
    return most;
}

double dmb_stiffness_rounding_of(const dmb_sim *sim, const double *size, const double *x)
{
    const dmb_scene *scene = sim->scene;
    double above = 0.0, below = 0.0;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t n = scene->layout.size[i], row = scene->layout.row[i];
        for (uint32_t c = 0; c < n; c++) {
            const double square = x[row + c] * x[row + c];
            above += size[row + c] * square;
            below += (2 * c < n ? 1.0 : arm_square_of(scene)) * square;
        }
    }
    return below > 0.0 ? DMB_SIGNS_PART * above / below : 0.0;
}

int64_t dmb_stiffness_factor(dmb_sim *sim, dmb_block_weakest *weakest, int32_t *negative)
{
    const uint32_t chains = negative_of_chains(sim, DMB_SIGNS_PART);
    const int64_t bad = dmb_factor_stiffness(sim, weakest);
    *negative = bad >= 0 ? 0 : (int32_t)(chains + (sim->scene->cluster_count ? dmb_reduced_negative(sim) : 0));
    return bad;
}

/* ---- Messages ---------------------------------------------------------------------------------------------------- */

/* Residual of a state, relative to the forces that balance in it, up to which it counts as equilibrium. */
#define DMB_STATE_BALANCED 1e-6

int32_t dmb_stiffness_balanced(dmb_sim *sim, const char *who, const dmb_evaluation *evaluation)
{
    const dmb_residual_norm norm = dmb_residual_norm_of(evaluation, DMB_STATE_BALANCED);
    if (norm.converged) return DMB_OK;
    dmb_message_set(&sim->message,
                    "%s: the state is no equilibrium, relative residual = %g, must be <= %g; call dmb_analysis_static "
                    "first",
                    who, norm.relative, DMB_STATE_BALANCED);
    return DMB_ERR_ORDER;
}

int32_t dmb_stiffness_explain(dmb_sim *sim, const char *who, uint32_t node)
{
    const dmb_owner owner = dmb_owner_of_node(sim->scene, node);
    dmb_message_set(&sim->message, "%s: %s: nothing holds it, the stiffness is singular", who, owner.text.text);
    return DMB_ERR_SINGULAR;
}
