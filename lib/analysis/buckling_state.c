/* Stiffness about the present state and how it changes with the pattern of loads:
 *     K = dr/dx,   x' = -K^-1 dr/dfactor,   G = d/dfactor K(x + factor x', factor)
 * G by a central difference of the exact tangent, so that what the state does before it buckles is in it. With joints K
 * is that of the independent coordinates, R^T K R with the forces of constraint in it, and so is its difference: R and
 * those forces change along the response too. */
#include <string.h>

#include "analysis/buckling.h"
#include "analysis/stiffness.h"
#include "system/cluster.h"
#include "system/joint_state.h"
#include "system/linked.h"
#include "system/solve.h"

/* The pattern moves the state by this part of an element for the difference. */
#define DMB_DIFFERENCE_MOVE 1e-6

/* x' by the factors of K; a motion drive moves its own row by 1. */
static int32_t respond(dmb_buckling *buckling, dmb_sim *sim)
{
    dmb_sim *work = buckling->work;
    dmb_block_weakest weakest;
    const int64_t bad = dmb_factor_stiffness(work, &weakest);
    if (bad >= 0 || weakest.ratio < DMB_LOOSE_PIVOT)
        return dmb_stiffness_explain(sim, "buckling", bad >= 0 ? (uint32_t)bad : weakest.block);
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
    dmb_load_pattern_set(&buckling->pattern, &search->evaluation, factor);
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

/* A += factor K of the evaluation, its rows held. */
static void take_matrix(const dmb_evaluation *evaluation, double factor, dmb_pencil_matrix *A)
{
    dmb_sim *work = evaluation->sim;
    const dmb_block_layout *layout = &work->scene->layout;
    const size_t link = layout->link[layout->n - 1];
    dmb_system_iteration_matrix(evaluation);
    add_to(layout->diag[layout->n], factor, work->stiffness_diagonal, A->diagonal);
    add_to(link, factor, work->stiffness_lower, A->lower);
    add_to(link, factor, work->stiffness_upper, A->upper);
    if (work->scene->cluster_count == 0) return;
    dmb_linked_assemble(work);
    add_to(work->scene->pattern.values, factor, work->linked_value, A->linked);
}

/* U and L^T of shape (n, m) become their mean, and L its transpose. */
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

static void make_linked_symmetric(const dmb_sim *work, dmb_pencil_matrix *A)
{
    const dmb_block_pattern *pattern = &work->scene->pattern;
    for (uint32_t k = 0; k < pattern->n; k++) {
        const uint32_t n = work->linked_size[pattern->order[k]];
        average_block(n, A->linked + pattern->diagonal[k]);
        for (uint32_t e = pattern->column[k]; e < pattern->column[k + 1]; e++)
            average_link(n, work->linked_size[pattern->order[pattern->later[e]]], A->linked + pattern->upper[e],
                         A->linked + pattern->lower[e]);
    }
}

/* Its symmetric part: in an equilibrium without friction the rest is rounding. */
static void make_symmetric(const dmb_sim *work, dmb_pencil_matrix *A)
{
    const dmb_block_layout *layout = &work->scene->layout;
    for (uint32_t k = 0; k < layout->n; k++) {
        average_block(layout->size[k], A->diagonal + layout->diag[k]);
        if (k + 1 < layout->n)
            average_link(layout->size[k], layout->size[k + 1], A->upper + layout->link[k], A->lower + layout->link[k]);
    }
    if (work->scene->cluster_count) make_linked_symmetric(work, A);
}

static int32_t differences(dmb_buckling *buckling, dmb_static_search *search, double step)
{
    dmb_pencil *pencil = &buckling->pencil;
    for (int side = -1; side <= 1; side += 2) {
        const int32_t status = evaluate_at(buckling, search, side * step);
        if (status < 0) return status;
        take_matrix(&search->evaluation, 0.5 * side / step, &pencil->G);
    }
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
        status = dmb_load_pattern_derivative(&buckling->pattern, &search->evaluation, 0.0, buckling->response);
    if (status >= 0) take_matrix(&search->evaluation, 1.0, &buckling->pencil.K);
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
    if (!dmb_pencil_count(&buckling->pencil, 0.0, &negative)) {
        dmb_message_set(&sim->message,
                        "buckling: the stiffness is singular, its negative eigenvalues cannot be counted");
        return DMB_ERR_SINGULAR;
    }
    if (negative == 0) return DMB_OK;
    dmb_message_set(&sim->message,
                    "buckling: the state is not stable, its stiffness has negative eigenvalues = %u, must be 0",
                    negative);
    return DMB_ERR_ORDER;
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
    status = stiffness_now(buckling, sim, &search);
    if (status >= 0) status = respond(buckling, sim);
    if (status >= 0) status = differences(buckling, &search, difference_of(buckling, options->step));
    if (status >= 0) status = keep_reduction(buckling, &search);
    return status < 0 ? status : stable(buckling, sim);
}
