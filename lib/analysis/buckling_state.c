/* Stiffness about the present state and how it changes with the pattern of loads:
 *     K = dr/dx,   x' = -K^-1 dr/dfactor,   G = d/dfactor K(x + factor x', factor)
 * G by a central difference of the exact tangent, so that what the state does before it buckles is in it. With joints K
 * is that of the independent coordinates, R^T K R with the forces of constraint in it, and so is its difference: R and
 * those forces change along the response too. All in the frames of the present state (frames.h). */
#include <string.h>

#include "analysis/buckling.h"
#include "analysis/stability.h"
#include "analysis/stiffness.h"
#include "analysis/symmetry.h"
#include "system/cluster.h"
#include "system/joint_state.h"
#include "system/linked.h"
#include "system/solve.h"

/* The pattern moves the state by this part of an element for the difference. */
#define DMB_DIFFERENCE_MOVE 1e-6

static int32_t unstable(dmb_sim *sim, int32_t negative)
{
    dmb_message_set(&sim->message,
                    "buckling: the state is not stable, its stiffness has negative eigenvalues = %d, must be 0; find a "
                    "stable one with dmb_analysis_static first",
                    negative);
    return DMB_ERR_ORDER;
}

/* x' by the factors of K, which has to be that of a stable state; a motion drive moves its own row by 1. */
static int32_t respond(dmb_buckling *buckling, dmb_sim *sim, dmb_static_search *search)
{
    dmb_sim *work = buckling->work;
    dmb_block_weakest weakest;
    dmb_stability found = {0};
    int64_t bad = -1;
    const int32_t status = dmb_stability_judge(search, 0, &weakest, &bad, &found);
    if (status < 0) return status;
    if (bad >= 0 || weakest.ratio < DMB_LOOSE_PIVOT)
        return dmb_stiffness_explain(sim, "buckling", bad >= 0 ? (uint32_t)bad : weakest.block);
    buckling->info.stiffness = found.stiffness;
    if (found.negative != 0) return unstable(sim, found.negative);
    memcpy(work->correction, buckling->response, work->scene->row_count * sizeof(double));
    dmb_solve_correction(work);
    memcpy(buckling->response, work->correction, work->scene->row_count * sizeof(double));
    if (buckling->pattern.row != UINT32_MAX) buckling->response[buckling->pattern.row] = 1.0;
    return DMB_OK;
}

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

/* The trial moved by `factor` along the response, its joints closed with the partition as it is: the three matrices are
 * in the same coordinates. */
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

static void add_to(size_t n, double factor, const double *from, double *to)
{
    for (size_t i = 0; i < n; i++) to[i] += factor * from[i];
}

/* A += factor K of the evaluation, its rows held, in the frames of the present state. 0 where that cannot be done. */
static int take_matrix(dmb_buckling *buckling, const dmb_evaluation *evaluation, double factor, dmb_pencil_matrix *A)
{
    dmb_sim *work = evaluation->sim;
    const dmb_block_layout *layout = &work->scene->layout;
    const size_t link = layout->link[layout->n - 1];
    dmb_system_iteration_matrix(evaluation);
    dmb_frames_turn_chains(work);
    add_to(layout->diag[layout->n], factor, work->stiffness_diagonal, A->diagonal);
    add_to(link, factor, work->stiffness_lower, A->lower);
    add_to(link, factor, work->stiffness_upper, A->upper);
    if (work->scene->cluster_count == 0) return 1;
    dmb_linked_assemble(work);
    if (!dmb_frames_turn_linked(work, &buckling->frames)) return 0;
    add_to(work->scene->pattern.values, factor, work->linked_value, A->linked);
    return 1;
}

/* Its symmetric part: in an equilibrium of forces with a potential the rest is rounding. */
static void make_symmetric(const dmb_sim *work, dmb_pencil_matrix *A)
{
    dmb_make_blocks_symmetric(&work->scene->layout, A->diagonal, A->lower, A->upper);
    if (work->scene->cluster_count) dmb_make_linked_symmetric(work, A->linked);
}

static int32_t differences(dmb_buckling *buckling, dmb_static_search *search, double step)
{
    dmb_pencil *pencil = &buckling->pencil;
    for (int side = -1; side <= 1; side += 2) {
        const int32_t status = evaluate_at(buckling, search, side * step);
        if (status < 0) return status;
        if (!take_matrix(buckling, &search->evaluation, 0.5 * side / step, &pencil->G)) return DMB_ERR_SINGULAR;
    }
    if (buckling->info.stiffness == DMB_STIFFNESS_UNSYMMETRIC) return DMB_OK;
    make_symmetric(buckling->work, &pencil->K);
    make_symmetric(buckling->work, &pencil->G);
    return DMB_OK;
}

/* K and the derivative of the residual by the factor, in an equilibrium. */
static int32_t stiffness_now(dmb_buckling *buckling, dmb_sim *sim, dmb_static_search *search)
{
    int32_t status = evaluate_at(buckling, search, 0.0);
    if (status >= 0) status = dmb_stiffness_balanced(sim, "buckling", &search->evaluation);
    if (status >= 0)
        status = dmb_load_pattern_derivative(&buckling->pattern, &search->evaluation, buckling->at, buckling->response);
    if (status >= 0 && !take_matrix(buckling, &search->evaluation, 1.0, &buckling->pencil.K)) status = DMB_ERR_SINGULAR;
    return status;
}

/* The reduction of the state itself, which shapes are expanded by. */
static int32_t keep_reduction(dmb_buckling *buckling, dmb_static_search *search)
{
    if (buckling->work->scene->cluster_count == 0) return DMB_OK;
    const int32_t status = evaluate_at(buckling, search, 0.0);
    if (status < 0) return status;
    dmb_system_iteration_matrix(&search->evaluation);
    dmb_linked_assemble(buckling->work);
    return DMB_OK;
}

void dmb_buckling_expand(dmb_buckling *buckling, const double *vector, double *shape)
{
    dmb_sim *work = buckling->work;
    const uint32_t rows = work->scene->row_count;
    if (work->scene->cluster_count == 0) return; /* the same */
    memcpy(work->correction, vector, rows * sizeof(double));
    memcpy(work->linked_solution, vector + rows, work->scene->pattern.rows * sizeof(double));
    dmb_linked_expand(work);
    memcpy(shape, work->correction, rows * sizeof(double));
}

static int32_t stable(dmb_buckling *buckling, dmb_sim *sim)
{
    uint32_t negative;
    if (buckling->info.stiffness == DMB_STIFFNESS_UNSYMMETRIC) return DMB_OK; /* judged before */
    if (!dmb_pencil_count(&buckling->pencil, 0.0, &negative)) {
        dmb_message_set(&sim->message,
                        "buckling: the stiffness is singular, its negative eigenvalues cannot be counted");
        return DMB_ERR_SINGULAR;
    }
    return negative == 0 ? DMB_OK : unstable(sim, (int32_t)negative);
}

/* Matrices to be summed up begin with zeros. */
static void clear(dmb_buckling *buckling)
{
    const dmb_scene *scene = buckling->work->scene;
    const size_t link = scene->layout.link[scene->layout.n - 1] * sizeof(double);
    dmb_pencil_matrix *const both[2] = {&buckling->pencil.K, &buckling->pencil.G};
    for (int k = 0; k < 2; k++) {
        memset(both[k]->diagonal, 0, scene->layout.diag[scene->layout.n] * sizeof(double));
        memset(both[k]->lower, 0, link);
        memset(both[k]->upper, 0, link);
        if (scene->cluster_count) memset(both[k]->linked, 0, scene->pattern.values * sizeof(double));
    }
}

/* The trial in the state at rest, with a partition that suits it. */
static int32_t begin(dmb_buckling *buckling, dmb_static_search *search)
{
    dmb_sim *work = buckling->work;
    memset(work->increment, 0, work->scene->row_count * sizeof(double));
    dmb_configuration_copy(work, &work->now, &work->trial);
    work->linked_mode->row = UINT32_MAX;
    const int32_t status = dmb_system_prescribe(&search->evaluation);
    return status >= 0 && work->scene->cluster_count ? dmb_static_settle(search) : status;
}

int32_t dmb_buckling_linearise(dmb_buckling *buckling, dmb_sim *sim, const dmb_buckling_options *options)
{
    dmb_static_search search;
    dmb_static_set_up(&search, buckling->work, NULL);
    dmb_static_slip(&search, options->slip_axial, options->slip_rotation);
    int32_t status = begin(buckling, &search);
    if (status < 0) return status;
    dmb_load_pattern_begin(&buckling->pattern, buckling->work);
    clear(buckling);
    status = stiffness_now(buckling, sim, &search);
    if (status >= 0) status = respond(buckling, sim, &search);
    if (status >= 0) status = differences(buckling, &search, difference_of(buckling, options->step));
    if (status >= 0) status = keep_reduction(buckling, &search);
    return status < 0 ? status : stable(buckling, sim);
}
