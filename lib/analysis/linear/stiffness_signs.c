/* The stiffness K of a static state and the signs of its eigenvalues. Elimination counts exactly the signs of a matrix
 * whose entries differ from those of K by some eps sqrt(s_i s_j), s the size of a row (eq:signs.size). A residual r
 * that rounding or the tolerance leaves has a stiffness too, because its direction rotates with the nodes. With the
 * diagonal T of both (eq:signs.amount), the counts of K + T and K - T enclose that of K: if they agree it is exact, and
 * the eigenvalues by which they differ are of rounding size (eq:signs.bounds). T scales as K does, so that units do not
 * matter. */
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
/* [-] A diagonal entry may be the small difference of large ones: the size of a row is at least this fraction of the
 * largest one of its node, weighted; for nodes on joints, whose forces contribute, the whole of it (eta of
 * eq:signs.size). */
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

static void row_sizes(const dmb_sim *sim, double *size)
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

/* Norm of components [first, end) of the residual of a node, without constrained ones. */
static double residual_of(const dmb_sim *sim, uint32_t node, uint32_t first, uint32_t end)
{
    const uint32_t row = sim->scene->layout.row[node];
    double sum = 0.0;
    for (uint32_t c = first; c < end; c++)
        if (sim->scene->solved_row[row + c]) sum += sim->residual[row + c] * sim->residual[row + c];
    return sqrt(sum);
}

/* A shape with displacements d and rotations a moves the force r of a node by a x d/2 to second order, and |r . a x d|
 * <= |r| (d^2/L + L a^2)/2, with L the length of the longest string, which may rotate as a whole. */
static void add_residual(const dmb_sim *sim, double *amount)
{
    const dmb_scene *scene = sim->scene;
    double length = 0.0;
    for (uint32_t c = 0; c < scene->chain_count; c++)
        length = fmax(length, scene->chains[c].length * scene->chains[c].count);
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t n = scene->layout.size[i], row = scene->layout.row[i];
        const double force = residual_of(sim, i, 0, n / 2), moment = residual_of(sim, i, n / 2, n);
        for (uint32_t c = 0; c < n; c++)
            if (scene->solved_row[row + c])
                amount[row + c] += 2 * c < n ? 0.5 * force / length : 0.5 * force * length + moment;
    }
}

void dmb_stiffness_amounts(const dmb_sim *sim, double *amount)
{
    row_sizes(sim, amount);
    for (uint32_t i = 0; i < sim->scene->row_count; i++) amount[i] *= DMB_SIGNS_PART;
    add_residual(sim, amount);
}

/* ---- Counts ------------------------------------------------------------------------------------------------------ */

static uint32_t negative_of_chains(const dmb_sim *sim, const dmb_block_raise *raise)
{
    const dmb_scene *scene = sim->scene;
    uint32_t negative = 0;
    for (uint32_t c = 0; c < scene->chain_count; c++)
        if (!scene->chains[c].jointed)
            negative += dmb_block_negative(&scene->layout, sim->stiffness_diagonal, sim->stiffness_lower,
                                           sim->stiffness_upper, raise, scene->chains[c].first, scene->chains[c].count);
    return negative;
}

typedef struct row_storage {
    double *amount, *diagonal; /* (rows) T, and the diagonal of K as it is */
} row_storage;

/* K + share T in the rows of jointed chains, whose reduced system is then assembled from them. */
static void raise_joints(dmb_sim *sim, const row_storage *rows, double share)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t n = scene->layout.size[i], row = scene->layout.row[i];
        double *D = dmb_stiffness_of(sim, i);
        if (!scene->chains[scene->node_chain[i]].jointed) continue;
        for (uint32_t c = 0; c < n; c++)
            D[(size_t)(n + 1) * c] = rows->diagonal[row + c] + share * rows->amount[row + c];
    }
}

static void keep_diagonal(const dmb_sim *sim, double *diagonal)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->node_count; i++)
        for (uint32_t c = 0; c < scene->layout.size[i]; c++)
            diagonal[scene->layout.row[i] + c] = dmb_stiffness_of(sim, i)[(size_t)(scene->layout.size[i] + 1) * c];
}

/* [N/m] Largest of the rows of displacements, and of rotations over the square of the length scale. */
static double largest_amount(const dmb_sim *sim, const double *amount)
{
    const dmb_scene *scene = sim->scene;
    double most = 0.0;
    for (uint32_t i = 0; i < scene->node_count; i++)
        for (uint32_t c = 0; c < scene->layout.size[i]; c++) {
            const double weight = 2 * c < scene->layout.size[i] ? 1.0 : arm_square_of(scene);
            most = fmax(most, amount[scene->layout.row[i] + c] / weight);
        }
    return most;
}

/* A block may be singular during elimination although the matrix is not. Count again with T slightly larger. */
#define DMB_SIGNS_TRIES 3

static int negative_of_joints(dmb_sim *sim, const row_storage *rows, double share, int32_t *negative)
{
    for (int k = 0; k < DMB_SIGNS_TRIES; k++, share *= 1.25) {
        raise_joints(sim, rows, share);
        if (dmb_reduced_factor(sim, DMB_METHOD_INDEPENDENT, NULL) >= 0) continue;
        *negative += (int32_t)dmb_reduced_negative(sim);
        return 1;
    }
    return 0;
}

/* Negative eigenvalues of K + share T: of chains without joints, plus those of the reduced system of jointed ones. -1:
 * not counted. */
static int32_t count(dmb_sim *sim, const row_storage *rows, double share)
{
    const dmb_block_raise raise = {.share = share, .amount = rows->amount};
    int32_t negative = (int32_t)negative_of_chains(sim, &raise);
    if (sim->scene->cluster_count == 0) return negative;
    return negative_of_joints(sim, rows, share, &negative) ? negative : -1;
}

/* K is unchanged at the end: chains are counted without changing it, and the diagonal of jointed ones is restored
 * (share 0). */
int32_t dmb_stiffness_signs_of(dmb_sim *sim, int both, double *amount, dmb_signs *out)
{
    const size_t rows = sim->scene->row_count, bytes = 2 * rows * sizeof(double);
    row_storage room = {.amount = dmb_allocate(&sim->allocator, bytes)};
    if (room.amount == NULL) return DMB_ERR_NO_MEMORY;
    room.diagonal = room.amount + rows;
    dmb_stiffness_amounts(sim, room.amount);
    keep_diagonal(sim, room.diagonal);
    const int32_t above = count(sim, &room, 1.0), below = both ? count(sim, &room, -1.0) : above;
    if (sim->scene->cluster_count) raise_joints(sim, &room, 0.0);
    out->negative = above < 0 || below < 0 ? -1 : above;
    out->unresolved = out->negative >= 0 && below > above ? below - above : 0;
    out->bound = largest_amount(sim, room.amount);
    if (amount != NULL) memcpy(amount, room.amount, rows * sizeof(double));
    dmb_release(&sim->allocator, room.amount, bytes);
    return DMB_OK;
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

/* x . T x / x . W x: by how much T can move the eigenvalue of the shape x, in the metric of lengths W in which its
 * value is given. */
double dmb_stiffness_rounding_of(const dmb_sim *sim, const double *amount, const double *x)
{
    const dmb_scene *scene = sim->scene;
    double above = 0.0, below = 0.0;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t n = scene->layout.size[i], row = scene->layout.row[i];
        for (uint32_t c = 0; c < n; c++) {
            const double square = x[row + c] * x[row + c];
            above += amount[row + c] * square;
            below += (2 * c < n ? 1.0 : arm_square_of(scene)) * square;
        }
    }
    return below > 0.0 ? above / below : 0.0;
}

/* Factors of K, and the count of K + T with T of rounding alone (part 4 eps) in the chains without joints: neither
 * residual nor jointed chains are allowed for. */
int64_t dmb_stiffness_factor(dmb_sim *sim, dmb_block_weakest *weakest, int32_t *negative)
{
    const dmb_scene *scene = sim->scene;
    const dmb_block_raise raise = {.part = DMB_SIGNS_PART,
                                   .arm_square = arm_square_of(scene),
                                   .floor = DMB_SIGNS_FLOOR,
                                   .solved = scene->solved_row};
    const uint32_t chains = negative_of_chains(sim, &raise);
    const int64_t bad = dmb_factor_stiffness(sim, weakest);
    *negative = bad >= 0 ? 0 : (int32_t)(chains + (scene->cluster_count ? dmb_reduced_negative(sim) : 0));
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
