
#include <math.h>
#include <string.h>

#include "analysis/buckling/buckling.h"
#include "analysis/linear/linear.h"
#include "analysis/static/static.h"
#include "math/dense.h"
#include "math/so3.h"
#include "sim/access.h"
#include "sim/layout.h"
#include "system/assemble/drives.h"
#include "system/constrain/constrain.h"
#include "system/solve/solve.h"

/* ---- Rotation of a node ------------------------------------------------------------------------------------------ */

/* Restriction of the rotation Q to the free components, of which a support leaves three, two (a plane), one or none. In
 * a plane it is the nearest rotation to the 2 x 2 part of Q; one component alone does not turn. */
static void restrict_turn(const double Q[9], const uint8_t *solved, double out[9])
{
    uint32_t free[3], count = 0;
    for (uint32_t i = 0; i < 3; i++)
        if (solved[i]) free[count++] = i;
    for (uint32_t i = 0; i < 9; i++) out[i] = count == 3 ? Q[i] : i % 4 == 0;
    if (count != 2) return;
    /* polar factor of two rows and columns */
    const uint32_t a = free[0], b = free[1];
    const double angle = atan2(Q[3 * b + a] - Q[3 * a + b], Q[3 * a + a] + Q[3 * b + b]);
    out[3 * a + a] = out[3 * b + b] = cos(angle);
    out[3 * b + a] = sin(angle);
    out[3 * a + b] = -sin(angle);
}

/* T of a node, size x size; the identity for an axial-torsional node, whose axis does not rotate. */
static void turn_of_node(const dmb_sim *sim, uint32_t node, double *T)
{
    const uint32_t size = sim->scene->layout.size[node];
    const uint8_t *solved = sim->scene->solved_row + sim->scene->layout.row[node];
    double now[9], trial[9], Q[9], part[9];
    for (uint32_t i = 0; i < size * size; i++) T[i] = i % (size + 1) == 0;
    if (size != DMB_NODE_SIX_DOF) return;
    dmb_quat_to_matrix(sim->now.quaternion + 4 * (size_t)node, now);
    dmb_quat_to_matrix(sim->trial.quaternion + 4 * (size_t)node, trial);
    for (uint32_t i = 0; i < 3; i++)
        for (uint32_t j = 0; j < 3; j++)
            Q[3 * i + j] = now[i] * trial[j] + now[3 + i] * trial[3 + j] + now[6 + i] * trial[6 + j];
    for (uint32_t half = 0; half < 6; half += 3) {
        restrict_turn(Q, solved + half, part);
        for (uint32_t i = 0; i < 3; i++)
            for (uint32_t j = 0; j < 3; j++) T[6 * (half + i) + half + j] = part[3 * i + j];
    }
}

/* ---- Products ---------------------------------------------------------------------------------------------------- */

typedef struct square {
    const double *values;
    uint32_t size;
} square;

/* A (n x m) <- X A Y^T, X (n x n), Y (m x m); transposed: X^T A Y. room: workspace of n m */
static void congruence(square left, square right, int transposed, double *A, double *workspace)
{
    const uint32_t n = left.size, m = right.size;
    const double *X = left.values, *Y = right.values;
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = 0; j < m; j++) {
            double sum = 0.0;
            for (uint32_t k = 0; k < n; k++)
                sum += (transposed ? X[(size_t)n * k + i] : X[(size_t)n * i + k]) * A[(size_t)m * k + j];
            workspace[(size_t)m * i + j] = sum;
        }
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = 0; j < m; j++) {
            double sum = 0.0;
            for (uint32_t k = 0; k < m; k++)
                sum += workspace[(size_t)m * i + k] * (transposed ? Y[(size_t)m * k + j] : Y[(size_t)m * j + k]);
            A[(size_t)m * i + j] = sum;
        }
}

/* K_now = T K_trial T^T (eq:buckling.frames), block by block of the chains without joints. T of two neighbours is at
 * hand at a time. */
void dmb_frames_turn_chains(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    const dmb_block_layout *layout = &scene->layout;
    double T[2][36], workspace[36];
    for (uint32_t c = 0; c < scene->chain_count; c++) {
        const uint32_t first = scene->chains[c].first, end = first + scene->chains[c].count;
        if (scene->chains[c].jointed) continue;
        turn_of_node(sim, first, T[first % 2]);
        for (uint32_t i = first; i < end; i++) {
            const square x = {T[i % 2], layout->size[i]};
            const square y = {T[(i + 1) % 2], i + 1 < end ? layout->size[i + 1] : 0};
            congruence(x, x, 0, sim->stiffness_diagonal + layout->diag[i], workspace);
            if (y.size == 0) continue;
            turn_of_node(sim, i + 1, T[(i + 1) % 2]);
            congruence(x, y, 0, sim->stiffness_upper + layout->link[i], workspace);
            congruence(y, x, 0, sim->stiffness_lower + layout->link[i], workspace);
        }
    }
}

/* ---- Reduced system ---------------------------------------------------------------------------------------------- */

static uint32_t largest_block(const dmb_scene *scene)
{
    uint32_t largest = DMB_NODE_SIX_DOF;
    for (uint32_t k = 0; k < scene->cluster_count; k++)
        if (scene->clusters[k].columns > largest) largest = scene->clusters[k].columns;
    return largest;
}

void dmb_frames_lay_out(dmb_arena *arena, const dmb_scene *scene, dmb_frames *frames)
{
    const size_t largest = scene->cluster_count ? largest_block(scene) : 0;
    frames->turn = DMB_ARENA_DOUBLES(arena, scene->cluster_count ? scene->pattern.values : 0);
    frames->workspace = DMB_ARENA_DOUBLES(arena, 2 * largest * largest);
    frames->pivot = DMB_ARENA_ARRAY(arena, uint32_t, largest);
}

/* Stores the rows of T R of a node of cluster k that are independent coordinates in W (width x width). */
static void put_rows(const dmb_sim *sim, uint32_t k, uint32_t node, uint32_t width, double *W)
{
    const dmb_scene *scene = sim->scene;
    const uint32_t size = scene->layout.size[node], rank = sim->partition_rank[k];
    double T[36];
    turn_of_node(sim, node, T);
    for (uint32_t c = 0; c < size; c++) {
        const uint32_t place = sim->cluster_place[scene->clusters[k].column + scene->node_place[node] + c];
        if (place < rank) continue;
        const size_t independent = place - rank;
        double *row = W + width * independent;
        for (uint32_t j = 0; j < size; j++) {
            uint32_t one;
            const double *G = dmb_reduced_null_space_row(sim, k, scene->node_place[node] + j, &one);
            if (T[size * c + j] == 0.0) continue;
            if (G == NULL) row[one] += T[size * c + j];
            for (uint32_t m = 0; G != NULL && m < width; m++) row[m] += T[size * c + j] * G[m];
        }
    }
}

static uint32_t node_of_block(const dmb_scene *scene, uint32_t block)
{
    uint32_t node = 0;
    while (scene->node_block[node] != block) node++;
    return node;
}

/* W of a block, n x n: independent coordinates of the present axes by those of the trial, y_now = W y_trial. W contains
 * the rows of T R, R = [G; I] of eq:static.blocks, that belong to independent coordinates. */
static void rows_of_block(const dmb_sim *sim, uint32_t block, uint32_t n, double *W)
{
    const dmb_scene *scene = sim->scene;
    memset(W, 0, (size_t)n * n * sizeof(double));
    for (uint32_t k = 0; k < scene->cluster_count; k++) {
        const dmb_cluster *cluster = scene->clusters + k;
        if (cluster->block != block) continue;
        for (uint32_t i = cluster->node; i < cluster->node + cluster->node_count; i++)
            put_rows(sim, k, scene->cluster_nodes[i], n, W);
        return;
    }
    turn_of_node(sim, node_of_block(scene, block), W);
}

/* With V = W^-1, y_trial = V y_now: K_now = V^T K_trial V for all blocks. 0 if a W is singular: the coordinates that
 * are independent in the present axes are not in the trial's. */
int dmb_frames_turn_reduced(dmb_sim *sim, const dmb_frames *frames)
{
    const dmb_block_pattern *pattern = &sim->scene->pattern;
    const uint32_t largest = largest_block(sim->scene);
    double *values = sim->reduced_value, *W = frames->workspace,
           *workspace = frames->workspace + (size_t)largest * largest;
    for (uint32_t k = 0; k < pattern->n; k++) {
        const uint32_t n = sim->reduced_size[pattern->order[k]];
        double *V = frames->turn + pattern->diagonal[k];
        rows_of_block(sim, pattern->order[k], n, W);
        for (size_t i = 0; i < (size_t)n * n; i++) V[i] = i % (n + 1) == 0;
        if (n > 0 && dmb_dense_factor(n, W, frames->pivot) >= 0) return 0;
        dmb_dense_solve(n, n, W, frames->pivot, V);
    }
    for (uint32_t k = 0; k < pattern->n; k++) {
        const square v = {frames->turn + pattern->diagonal[k], sim->reduced_size[pattern->order[k]]};
        congruence(v, v, 1, values + pattern->diagonal[k], workspace);
        for (uint32_t e = pattern->column[k]; e < pattern->column[k + 1]; e++) {
            const uint32_t later = pattern->later[e];
            const square z = {frames->turn + pattern->diagonal[later], sim->reduced_size[pattern->order[later]]};
            congruence(v, z, 1, values + pattern->upper[e], workspace);
            congruence(z, v, 1, values + pattern->lower[e], workspace);
        }
    }
    return 1;
}

/* Stiffness about the present state and its derivative by the pattern of loads (eq:buckling.pencil):
 *     K = dr/dx,   x' = -K^-1 dr/dfactor,   G = d/dfactor K(x + factor x', factor)
 * G by a central difference of the exact tangent, so that it contains the prebuckling displacements. With joints K is
 * that of the independent coordinates, R^T K R with the constraint forces, and so is its difference: R and those forces
 * change along the response too. All matrices are in the frames of the present state. */

/* Displacement for the difference, as a fraction of the length scale. */
#define DMB_DIFFERENCE_MOVE 1e-6

static int32_t unstable(dmb_sim *sim, int32_t negative)
{
    if (negative < 0)
        dmb_message_set(&sim->message,
                        "buckling: the stability of the state is not resolved, the negative eigenvalues of its "
                        "unsymmetric stiffness could not be counted; use fewer elements");
    else
        dmb_message_set(
            &sim->message,
            "buckling: the state is not stable, its stiffness has negative eigenvalues = %d, must be 0; find a "
            "stable one with dmb_analysis_static first",
            negative);
    return DMB_ERR_ORDER;
}

/* x' by the factors of K, which must be that of a stable state; a motion drive moves its own row by 1. */
static int32_t respond(dmb_buckling *buckling, dmb_sim *sim, dmb_static_search *search)
{
    dmb_sim *work = buckling->work;
    dmb_block_weakest weakest;
    dmb_stability found = {.amount = buckling->amount};
    int64_t bad = -1;
    const int32_t status = dmb_stability_judge(search, 0, &weakest, &bad, &found);
    if (status < 0) return status;
    if (bad >= 0 || weakest.ratio < DMB_UNCONSTRAINED_PIVOT)
        return dmb_stiffness_explain(sim, "buckling", bad >= 0 ? (uint32_t)bad : weakest.block);
    buckling->info.stiffness = found.stiffness;
    /* along the path pairs of negative ones may arise from a complex pair, although det K has not passed 0 */
    const int on_the_way = buckling->info.linearisations > 0 && found.stiffness == DMB_STIFFNESS_UNSYMMETRIC;
    if (found.negative != 0 && !on_the_way) return unstable(sim, found.negative);
    dmb_solve_for(work, buckling->response, buckling->response);
    if (buckling->pattern.row != DMB_NONE) buckling->response[buckling->pattern.row] = 1.0;
    return DMB_OK;
}

/* Step of the factor: the response moves no node by more than DMB_DIFFERENCE_MOVE length scales. 1 if the loads move
 * nothing: K is then linear in the factor, and every step gives the same difference. */
static double difference_of(const dmb_buckling *buckling, double given)
{
    const dmb_scene *scene = buckling->work->scene;
    double most = 0.0;
    if (given > 0.0) return given;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t size = scene->layout.size[i], row = scene->layout.row[i];
        for (uint32_t c = 0; c < size; c++)
            most = fmax(most, fabs(buckling->response[row + c]) * (2 * c < size ? 1.0 : scene->length_scale));
    }
    return most > 0.0 ? DMB_DIFFERENCE_MOVE * scene->length_scale / most : 1.0;
}

/* Moves the trial by `factor` along the response and closes its joints with the same partition, so that the three
 * matrices have the same coordinates. */
static int32_t place_at(dmb_buckling *buckling, dmb_static_search *search, double factor)
{
    dmb_sim *work = buckling->work;
    dmb_configuration_copy(work, &work->now, &work->trial);
    memset(work->increment, 0, work->scene->row_count * sizeof(double));
    dmb_load_pattern_set(&buckling->pattern, &search->evaluation, buckling->at + factor);
    if (factor != 0.0) dmb_static_displace(work, buckling->response, factor);
    if (work->scene->cluster_count == 0) return DMB_OK;
    const int32_t status = dmb_clusters_settle(&search->evaluation, DMB_SETTLE_POSE, 0);
    if (status >= 0) dmb_joints_follow(&search->evaluation);
    return status;
}

/* Residual and stiffness of the state moved by `factor` along the response. */
static int32_t evaluate_at(dmb_buckling *buckling, dmb_static_search *search, double factor)
{
    const int32_t status = place_at(buckling, search, factor);
    return status < 0 ? status : dmb_system_evaluate(&search->evaluation);
}

/* Sets a matrix to 0 before summation. */
static void clear(const dmb_scene *scene, dmb_pencil_matrix *A)
{
    const size_t link = scene->layout.link[scene->layout.n - 1] * sizeof(double);
    memset(A->diagonal, 0, scene->layout.diag[scene->layout.n] * sizeof(double));
    memset(A->lower, 0, link);
    memset(A->upper, 0, link);
    if (scene->cluster_count) memset(A->jointed, 0, scene->pattern.values * sizeof(double));
}

static void add_to(size_t n, double factor, const double *from, double *to)
{
    for (size_t i = 0; i < n; i++) to[i] += factor * from[i];
}

/* K + T, T the rounding level of its rows (eq:signs.amount). */
static void raise_diagonal(dmb_sim *work, const double *amount)
{
    const dmb_block_layout *layout = &work->scene->layout;
    for (uint32_t i = 0; i < layout->n; i++)
        for (uint32_t c = 0; c < layout->size[i]; c++)
            dmb_stiffness_of(work, i)[(size_t)(layout->size[i] + 1) * c] += amount[layout->row[i] + c];
}

/* A += factor K of the evaluation, with constrained rows, in the frames of the present state. 0 if that is not
 * possible. raised 1: of K + T. */
static int copy_matrix(dmb_buckling *buckling, const dmb_evaluation *evaluation, double factor, int raised,
                       dmb_pencil_matrix *A)
{
    dmb_sim *work = evaluation->sim;
    const dmb_block_layout *layout = &work->scene->layout;
    const size_t link = layout->link[layout->n - 1];
    dmb_system_iteration_matrix(evaluation);
    if (raised) raise_diagonal(work, buckling->amount);
    dmb_frames_turn_chains(work);
    add_to(layout->diag[layout->n], factor, work->stiffness_diagonal, A->diagonal);
    add_to(link, factor, work->stiffness_lower, A->lower);
    add_to(link, factor, work->stiffness_upper, A->upper);
    if (work->scene->cluster_count == 0) return 1;
    dmb_reduced_assemble(work);
    if (!dmb_frames_turn_reduced(work, &buckling->frames)) return 0;
    add_to(work->scene->pattern.values, factor, work->reduced_value, A->jointed);
    return 1;
}

/* Replaces a matrix by its symmetric part: at an equilibrium under forces with a potential the skew part is
 * rounding. */
static void make_symmetric(const dmb_sim *work, dmb_pencil_matrix *A)
{
    dmb_make_blocks_symmetric(&work->scene->layout, A->diagonal, A->lower, A->upper);
    if (work->scene->cluster_count) dmb_make_reduced_symmetric(work, A->jointed);
}

/* Message if a state displaced by the difference cannot be evaluated. */
static int32_t explain_difference(dmb_sim *sim, double step, int32_t status)
{
    if (status >= 0 || dmb_is_final(status) || sim->message.text[0] != '\0') return status;
    dmb_message_set(&sim->message,
                    "buckling: the stiffness cannot be evaluated at a distance of step = %g from the state: %s; choose "
                    "a smaller step, or 0 for the default",
                    step, dmb_status_text(status));
    return status;
}

static int32_t differences(dmb_buckling *buckling, dmb_static_search *search, double step)
{
    dmb_pencil *pencil = &buckling->pencil;
    for (int side = -1; side <= 1; side += 2) {
        const int32_t status = evaluate_at(buckling, search, side * step);
        if (status < 0) return status;
        if (!copy_matrix(buckling, &search->evaluation, 0.5 * side / step, 0, &pencil->G)) return DMB_ERR_SINGULAR;
    }
    if (buckling->info.stiffness == DMB_STIFFNESS_UNSYMMETRIC) return DMB_OK;
    make_symmetric(buckling->work, &pencil->K);
    make_symmetric(buckling->work, &pencil->G);
    return DMB_OK;
}

/* K and the derivative of the residual by the factor, at an equilibrium. */
static int32_t stiffness_now(dmb_buckling *buckling, dmb_sim *sim, dmb_static_search *search)
{
    int32_t status = evaluate_at(buckling, search, 0.0);
    if (status >= 0) status = dmb_stiffness_balanced(sim, "buckling", &search->evaluation);
    if (status >= 0)
        status = dmb_load_pattern_derivative(&buckling->pattern, &search->evaluation, buckling->at, buckling->response);
    if (status >= 0 && !copy_matrix(buckling, &search->evaluation, 1.0, 0, &buckling->pencil.K))
        status = DMB_ERR_SINGULAR;
    return status;
}

/* Computes the reduction of the state itself, which expands the shapes. */
static int32_t keep_reduction(dmb_buckling *buckling, dmb_static_search *search)
{
    if (buckling->work->scene->cluster_count == 0) return DMB_OK;
    const int32_t status = evaluate_at(buckling, search, 0.0);
    if (status < 0) return status;
    dmb_system_iteration_matrix(&search->evaluation);
    dmb_reduced_assemble(buckling->work);
    return DMB_OK;
}

void dmb_buckling_expand(dmb_buckling *buckling, const double *vector, double *shape)
{
    dmb_sim *work = buckling->work;
    const uint32_t rows = work->scene->row_count;
    if (work->scene->cluster_count == 0) return; /* shape and vector are the same array */
    memcpy(shape, vector, rows * sizeof(double));
    memcpy(work->reduced_solution, vector + rows, work->scene->pattern.rows * sizeof(double));
    dmb_reduced_expand(work, shape);
}

/* An eigenvalue at the rounding level is no instability (dmb_stability_judge has found none beyond): K + T has none. */
static int32_t raise_stiffness(dmb_buckling *buckling, dmb_static_search *search)
{
    dmb_pencil *pencil = &buckling->pencil;
    const int32_t status = evaluate_at(buckling, search, 0.0);
    if (status < 0) return status;
    clear(pencil->scene, &pencil->K);
    if (!copy_matrix(buckling, &search->evaluation, 1.0, 1, &pencil->K)) return DMB_ERR_SINGULAR;
    make_symmetric(buckling->work, &pencil->K);
    return DMB_OK;
}

/* K itself is counted once more in the form in which pencil.c uses it: positive definite as eq:buckling.pencil
 * requires. If it has negative eigenvalues that statics had found within rounding, K + T takes its place. */
static int32_t stable(dmb_buckling *buckling, dmb_sim *sim, dmb_static_search *search)
{
    uint32_t negative;
    if (buckling->info.stiffness == DMB_STIFFNESS_UNSYMMETRIC) return DMB_OK; /* assessed before */
    for (int raised = 0; raised < 2; raised++) {
        if (!dmb_pencil_count(&buckling->pencil, 0.0, &negative)) {
            dmb_message_set(&sim->message,
                            "buckling: the stiffness is singular, its negative eigenvalues cannot be counted");
            return DMB_ERR_SINGULAR;
        }
        if (negative == 0) return DMB_OK;
        const int32_t status = raised ? DMB_OK : raise_stiffness(buckling, search);
        if (status < 0) return status;
    }
    return unstable(sim, (int32_t)negative);
}

/* Sets the trial to the state at rest, with a well-conditioned partition. */
static int32_t begin(dmb_buckling *buckling, dmb_static_search *search)
{
    dmb_sim *work = buckling->work;
    memset(work->increment, 0, work->scene->row_count * sizeof(double));
    dmb_configuration_copy(work, &work->now, &work->trial);
    work->reduced_mode->row = DMB_NONE;
    const int32_t status = dmb_system_prescribe(&search->evaluation);
    return status >= 0 && work->scene->cluster_count ? dmb_static_settle(search) : status;
}

/* Order: K and q at the state, the response by its factors, two states beside it for G, the check
 * of K, and the state itself again, because the reduction of the joints expands the shapes. */
int32_t dmb_buckling_linearise(dmb_buckling *buckling, dmb_sim *sim, const dmb_buckling_options *options)
{
    dmb_static_search search;
    dmb_static_set_up(&search, buckling->work, NULL);
    dmb_static_slip(&search, options->slip_axial, options->slip_rotation);
    int32_t status = begin(buckling, &search);
    if (status < 0) return status;
    dmb_load_pattern_begin(&buckling->pattern, buckling->work);
    clear(buckling->pencil.scene, &buckling->pencil.K);
    clear(buckling->pencil.scene, &buckling->pencil.G);
    status = stiffness_now(buckling, sim, &search);
    if (status >= 0) status = respond(buckling, sim, &search);
    if (status >= 0) {
        const double step = difference_of(buckling, options->step);
        status = explain_difference(sim, step, differences(buckling, &search, step));
    }
    if (status >= 0) status = stable(buckling, sim, &search);
    return status < 0 ? status : keep_reduction(buckling, &search);
}
