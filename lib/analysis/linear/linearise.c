/* The linear system about the accepted state of a sim:
 *
 *     M d'' + C d' + K d = f,     d: small body-frame displacements of the nodes, shape (rows)
 *
 * Six rows (translation; rotation) of a six-DOF node, H = H0 exp(d), two (along the hole; about its axis) of an
 * axial-torsional node. Rows constrained by supports and motion drives are zero, with their columns. With joints d = R
 * z, z being the independent coordinates of the partition; otherwise z are the solved rows:
 *
 *     R^T M R z'' + R^T C R z' + R^T K R z = R^T f
 *
 * Velocities of the perturbed motion in the body frame are v + d' + v^ d and accelerations a + d'' + v^ d' + a^ d, with
 * v^ = ad(v): exp(-d) H0^-1 (H0 exp(d))' to first order. With M, C_v = dr/dv and K_H = dr/dH of the residual r that
 * steps solve, at given body-frame v and a,
 *
 *     C = C_v + M v^,     K = K_H + C_v v^ + M a^                                   (eq:modes.linear)
 *
 * so that gyroscopic and centrifugal terms of a steadily spinning string are in C and K. Their entries are constant
 * there, because it is a relative equilibrium; elsewhere in a run they are those of the instant. Axes that do not take
 * part in the spin w about a node's x axis rotate d back, d <- exp(w^ t) d, H = G exp(d) exp(w t): with g = v - w
 * velocities of the perturbed motion are v + d' + g^ d, and their rates a + d'' + g^ d' - w^ (d' + g^ d) + b^ d with b
 * = a + w^ g, the rate of g in these axes:
 *
 *     C = C_v - M w^ + M g^,     K = K_H + (C_v - M w^) g^ + M b^,                   (eq:modes.still-axes)
 *
 * constant for axisymmetric parts, even if a rotating string lies on the wall. Effects with a memory are treated as
 * follows:
 *
 *     bristles that stick         stiffness
 *     integral gain of a drive    stiffness of its row, without the term of v^ d, which vanishes for drives along
 *                                 and about the axis
 *     regenerative rock law       none: the surface cut so far is prescribed
 *     nonholonomic equation       constrains d as it constrains d'
 *     friction                    derivative of its law; a law that is smooth at rest is a damper there */
#include "analysis/linear/linear.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "math/mat6.h"
#include "math/vec3.h"
#include "sim/access.h"
#include "sim/node.h"
#include "system/constrain/constrain.h"
#include "system/solve/solve.h"
#include "system/system.h"

static void spin_node(dmb_sim *work, uint32_t node, double spin)
{
    const uint32_t row =
        work->scene->layout.row[node] + (work->scene->layout.size[node] == DMB_NODE_AXIAL_TORSIONAL ? 1 : 3);
    work->now.velocity[row] = work->trial.velocity[row] = spin;
}

/* Sets the spin of the strings about their own axes. */
static void spin_strings(dmb_sim *work, double spin)
{
    const dmb_scene *scene = work->scene;
    for (uint32_t i = 0; i < scene->pipe_count; i++) {
        const dmb_pipe_map *pipe = scene->pipes + i;
        if (pipe->elements == 0) spin_node(work, pipe->node, spin);
        for (uint32_t e = pipe->element; e < pipe->element + pipe->elements; e++)
            for (uint32_t end = 0; end < 2; end++) spin_node(work, scene->element_node[e] + end, spin);
    }
}

/* Partition of the state, its rows and factors; constraint forces, which the tangents use. */
static int32_t settle(const dmb_linear *linear)
{
    dmb_sim *work = linear->work;
    dmb_evaluation evaluation = dmb_linear_evaluation(linear);
    memset(work->increment, 0, work->scene->row_count * sizeof(double));
    work->reduced_mode->row = DMB_NONE;
    return work->scene->cluster_count ? dmb_clusters_settle(&evaluation, 0, 0) : DMB_OK;
}

static int32_t update_multipliers(const dmb_linear *linear)
{
    dmb_evaluation evaluation = dmb_linear_evaluation(linear);
    return linear->work->scene->cluster_count ? dmb_system_evaluate(&evaluation) : DMB_OK;
}

static int32_t allocate_matrices(dmb_linear *linear, const dmb_linear_options *options)
{
    dmb_sim *work = linear->work;
    dmb_evaluation evaluation = dmb_linear_evaluation(linear);
    evaluation.given = 1;
    int32_t status = dmb_system_evaluate(&evaluation);
    memcpy(linear->with_contacts, work->residual, linear->rows * sizeof(double));
    dmb_linear_finalise(linear, options);
    if (status >= 0) status = dmb_linear_read_stiffness_and_mass(linear);
    if (status >= 0) dmb_linear_add_dead_loads(linear, linear->with_contacts);
    if (status >= 0 && options->contact == DMB_CONTACT_CLOSED) dmb_linear_close_contacts(linear, options->gap);
    return status < 0 ? status : dmb_linear_read_damping(linear);
}

/* Tests whether the residual is rounding of poses, from the stiffness. */
static int32_t judge_rounding(dmb_linear *linear)
{
    const int32_t status = dmb_linear_read_stiffness_and_mass(linear);
    dmb_linear_judge_rounding(linear);
    return status;
}

/* Order: joints are settled and the balance is found, because both steady accelerations and multipliers enter the
 * tangents. If the residual is not balanced, the stiffness decides whether it is rounding of the poses; this is
 * repeated with the final stiffness. */
static int32_t linearise(dmb_linear *linear, const dmb_linear_options *options)
{
    dmb_sim *work = linear->work;
    if (options->spin != 0.0) spin_strings(work, options->spin);
    linear->load_factor = 1.0 + options->load_growth;
    int32_t status = settle(linear);
    if (status >= 0) status = dmb_linear_evaluate_balance(linear);
    if (status >= 0 && !linear->balanced) status = update_multipliers(linear);
    if (status >= 0 && !linear->balanced) status = judge_rounding(linear);
    if (status >= 0) dmb_linear_set_steady_accelerations(linear);
    if (status >= 0) status = update_multipliers(linear);
    if (status >= 0) status = allocate_matrices(linear, options);
    if (status < 0) return status;
    dmb_linear_judge_rounding(linear);
    dmb_linear_turn_frames(linear, options->inertial_axes);
    dmb_linear_find_turning_on_wall(linear, options);
    dmb_linear_set_stiffness_size(linear);
    return dmb_linear_make_coordinates(linear);
}

int32_t dmb_linear_make(const dmb_sim *sim, const dmb_linear_options *options, dmb_linear **linear)
{
    int32_t status = dmb_progress_pulse(sim);
    if (status < 0) return status;
    *linear = dmb_linear_allocate(sim);
    if (*linear == NULL) return DMB_ERR_NO_MEMORY;
    (*linear)->inertial_axes = options->inertial_axes;
    status = linearise(*linear, options);
    if (status >= 0) status = dmb_linear_find_turning(*linear, sim);
    if (status < 0) dmb_linear_release(linear);
    return status;
}

/* Memory of the linear system. */

static void lay_out_matrix(dmb_arena *arena, const dmb_scene *scene, dmb_linear_matrix *A)
{
    const dmb_block_layout *layout = &scene->layout;
    A->diagonal = DMB_ARENA_DOUBLES(arena, layout->diag[layout->n]);
    A->lower = DMB_ARENA_DOUBLES(arena, layout->link[layout->n - 1]);
    A->upper = DMB_ARENA_DOUBLES(arena, layout->link[layout->n - 1]);
    A->joints = DMB_ARENA_DOUBLES(arena, scene->tangent_count);
}

/* Entries of R: one of an independent row, as many as its cluster has columns of a dependent one at most. */
static size_t entries_of(const dmb_scene *scene)
{
    size_t sum = scene->row_count;
    for (uint32_t k = 0; k < scene->cluster_count; k++)
        sum += (size_t)scene->clusters[k].columns * scene->clusters[k].columns;
    return sum;
}

static void lay_out(dmb_arena *arena, const dmb_scene *scene, dmb_linear *to)
{
    const size_t rows = scene->row_count;
    lay_out_matrix(arena, scene, &to->mass);
    lay_out_matrix(arena, scene, &to->damping);
    lay_out_matrix(arena, scene, &to->stiffness);
    to->spin = DMB_ARENA_DOUBLES(arena, rows);
    to->rest = DMB_ARENA_DOUBLES(arena, rows);
    to->change = DMB_ARENA_DOUBLES(arena, rows);
    to->stiffness_size = DMB_ARENA_DOUBLES(arena, rows);
    to->with_contacts = DMB_ARENA_DOUBLES(arena, rows);
    to->residual = DMB_ARENA_DOUBLES(arena, rows);
    to->row_of = DMB_ARENA_ARRAY(arena, uint32_t, rows);
    to->start = DMB_ARENA_ARRAY(arena, uint32_t, rows + 1);
    to->column = DMB_ARENA_ARRAY(arena, uint32_t, entries_of(scene));
    to->value = DMB_ARENA_DOUBLES(arena, entries_of(scene));
    to->constrained_columns = DMB_ARENA_DOUBLES(arena, 54 * (size_t)scene->constrained_count);
    to->constrained_rows = DMB_ARENA_DOUBLES(arena, 54 * (size_t)scene->constrained_count);
    to->whole_joints = DMB_ARENA_DOUBLES(arena, 3 * (size_t)scene->tangent_count);
}

dmb_linear *dmb_linear_allocate(const dmb_sim *sim)
{
    dmb_arena arena;
    dmb_linear nowhere;
    dmb_linear *linear = dmb_allocate(&sim->allocator, sizeof *linear);
    if (linear == NULL) return NULL;
    linear->allocator = sim->allocator;
    const dmb_scene *scene = dmb_dense_scene(sim->scene);
    linear->scene = *scene;
    linear->rows = scene->row_count;
    dmb_arena_count(&arena);
    lay_out(&arena, scene, &nowhere);
    linear->block_size = dmb_arena_block_size(&arena);
    linear->block = dmb_allocate(&sim->allocator, linear->block_size);
    if (linear->block != NULL) linear->work = dmb_state_copy(sim);
    if (linear->work == NULL) {
        dmb_linear_release(&linear);
        return NULL;
    }
    dmb_arena_place(&arena, linear->block, linear->block_size);
    lay_out(&arena, scene, linear);
    return linear;
}

void dmb_linear_release(dmb_linear **linear)
{
    if (*linear == NULL) return;
    const dmb_allocator allocator = (*linear)->allocator;
    dmb_state_discard((*linear)->work);
    dmb_release(&allocator, (*linear)->block, (*linear)->block_size);
    dmb_release(&allocator, *linear, sizeof **linear);
    *linear = NULL;
}

/* Distance of a state from an equilibrium. */

/* Units of rounding of a pose that count as rounding of the residual. */
#define DMB_LINEAR_ROUNDING (16.0 * DBL_EPSILON)

/* Largest force on a solved row; moments over the length that belongs to the chain (mean element). */
static void find_largest(dmb_linear *linear)
{
    const dmb_scene *scene = &linear->scene;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t size = scene->layout.size[i], row = scene->layout.row[i];
        const double arm = 1.0 / scene->chains[scene->node_chain[i]].length;
        for (uint32_t c = 0; c < size; c++) {
            const double force = fabs(linear->residual[row + c]) * (2 * c < size ? 1.0 : arm);
            if (!scene->solved_row[row + c] || !(force > linear->largest_force)) continue;
            linear->largest_force = force;
            linear->largest_node = i;
        }
    }
}

/* Accelerations of the trial in a relative equilibrium: zero at constant body-frame velocities; -ad(w) g if strings
 * slide and rotate with their axes at rest, V = g + w, w the spin about the node's x axis (analysis/static/static.h).
 */
static void steady_accelerations(dmb_linear *linear, int sliding)
{
    const dmb_scene *scene = &linear->scene;
    dmb_configuration *trial = &linear->work->trial;
    memset(trial->acceleration, 0, linear->rows * sizeof(double));
    for (uint32_t i = 0; sliding && i < scene->node_count; i++) {
        const uint32_t row = scene->layout.row[i];
        double w[6] = {0.0}, g[6], *a = trial->acceleration + row;
        if (scene->layout.size[i] != DMB_NODE_SIX_DOF) continue;
        dmb_vec6_copy(trial->velocity + row, g);
        w[3] = g[3];
        g[3] = 0.0;
        dmb_ad_apply(w, g, a);
        for (int k = 0; k < 6; k++) a[k] = -a[k];
    }
}

/* Residual with those accelerations. */
static int32_t balance_of(dmb_linear *linear, int sliding, dmb_residual_norm *norm)
{
    dmb_sim *work = linear->work;
    dmb_evaluation evaluation = dmb_linear_evaluation(linear);
    steady_accelerations(linear, sliding);
    const int32_t status = dmb_system_evaluate(&evaluation);
    memcpy(work->trial.acceleration, work->now.acceleration, linear->rows * sizeof(double));
    if (status >= 0) *norm = dmb_residual_norm_of(&evaluation, DMB_LINEAR_BALANCED);
    return status;
}

/* Both kinds of relative equilibria are tried, the one with the smaller residual counts: constant body-frame velocities
 * (rigid), or axes at rest (sliding). */
int32_t dmb_linear_evaluate_balance(dmb_linear *linear)
{
    dmb_residual_norm rigid = {0}, sliding = {0}, best;
    int32_t status = balance_of(linear, 1, &sliding);
    if (status >= 0) status = balance_of(linear, 0, &rigid);
    if (status < 0) return status;
    best = rigid;
    linear->slides = !rigid.converged && sliding.relative < rigid.relative;
    if (linear->slides) {
        status = balance_of(linear, 1, &sliding);
        best = sliding;
    }
    if (status < 0) return status;
    linear->relative_residual = best.relative;
    linear->balanced = best.converged != 0;
    memcpy(linear->residual, linear->work->residual, linear->rows * sizeof(double));
    find_largest(linear);
    return DMB_OK;
}

/* Replaces the accelerations of an equilibrium by the steady ones. Those in the sim contain rounding of the residual
 * over the masses, which M a^ and the multipliers would turn into a stiffness. */
void dmb_linear_set_steady_accelerations(dmb_linear *linear)
{
    if (!linear->balanced) return;
    steady_accelerations(linear, linear->slides);
    memcpy(linear->work->now.acceleration, linear->work->trial.acceleration, linear->rows * sizeof(double));
}

/* Rounding of poses: eps |x| of a displacement causes forces sqrt(K_ii K_tt) eps |x| through the stiffness, K_tt the
 * largest of the node's translations; angles are rounded to eps. The residual of an unloaded string is of this size. */
void dmb_linear_judge_rounding(dmb_linear *linear)
{
    const dmb_scene *scene = &linear->scene;
    dmb_linear_set_stiffness_size(linear);
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t size = scene->layout.size[i], row = scene->layout.row[i];
        double rotation[9], place[3], most = 0.0;
        dmb_node_pose(scene, &linear->work->now, i, rotation, place);
        dmb_vec3_add(place, scene->reference_position + 3 * (size_t)i, place);
        for (uint32_t c = 0; 2 * c < size; c++) most = fmax(most, linear->stiffness_size[row + c]);
        for (uint32_t c = 0; c < size; c++) {
            const double own = linear->stiffness_size[row + c], angle = 2 * c < size ? 0.0 : own;
            const double rounding = DMB_LINEAR_ROUNDING * (dmb_vec3_norm(place) * sqrt(own * most) + angle);
            if (scene->solved_row[row + c] && !(fabs(linear->residual[row + c]) <= rounding)) return;
        }
    }
    linear->balanced = 1;
}
