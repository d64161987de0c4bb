/* Stiffness about the present state and how it changes with the pattern of loads:
 *     K = dr/dx,   x' = -K^-1 dr/dfactor,   G = d/dfactor K(x + factor x', factor)
 * G by a central difference of the exact tangent, so that what the state does before it buckles is in it. */
#include <string.h>

#include "analysis/buckling.h"
#include "analysis/stiffness.h"
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

/* Stiffness, its rows held, of the state moved by `factor` along the response. */
static int32_t stiffness_at(dmb_buckling *buckling, dmb_static_search *search, double factor)
{
    dmb_sim *work = buckling->work;
    dmb_configuration_copy(work, &work->now, &work->trial);
    dmb_load_pattern_set(&buckling->pattern, &search->evaluation, factor);
    int32_t status = factor != 0.0 ? dmb_static_move(search, buckling->response, factor) : DMB_OK;
    if (status >= 0) status = dmb_system_evaluate(&search->evaluation);
    return status;
}

static void take_matrix(const dmb_sim *work, double factor, dmb_pencil_matrix *A)
{
    const dmb_block_layout *layout = &work->scene->layout;
    const size_t link = layout->link[layout->n - 1];
    for (size_t i = 0; i < layout->diag[layout->n]; i++) A->diagonal[i] += factor * work->stiffness_diagonal[i];
    for (size_t i = 0; i < link; i++) A->lower[i] += factor * work->stiffness_lower[i];
    for (size_t i = 0; i < link; i++) A->upper[i] += factor * work->stiffness_upper[i];
}

/* Its symmetric part: in an equilibrium without friction the rest is rounding. */
static void make_symmetric(const dmb_scene *scene, dmb_pencil_matrix *A)
{
    const dmb_block_layout *layout = &scene->layout;
    for (uint32_t k = 0; k < layout->n; k++) {
        const uint32_t n = layout->size[k], m = k + 1 < layout->n ? layout->size[k + 1] : 0;
        double *D = A->diagonal + layout->diag[k], *U = A->upper + layout->link[k], *L = A->lower + layout->link[k];
        for (uint32_t i = 0; i < n; i++)
            for (uint32_t j = 0; j < i; j++) D[n * i + j] = D[n * j + i] = 0.5 * (D[n * i + j] + D[n * j + i]);
        for (uint32_t i = 0; i < n; i++)
            for (uint32_t j = 0; j < m; j++) U[m * i + j] = L[n * j + i] = 0.5 * (U[m * i + j] + L[n * j + i]);
    }
}

static int32_t differences(dmb_buckling *buckling, dmb_static_search *search, double step)
{
    dmb_sim *work = buckling->work;
    dmb_pencil *pencil = &buckling->pencil;
    for (int side = -1; side <= 1; side += 2) {
        const int32_t status = stiffness_at(buckling, search, side * step);
        if (status < 0) return status;
        dmb_system_iteration_matrix(&search->evaluation);
        take_matrix(work, 0.5 * side / step, &pencil->G);
    }
    make_symmetric(work->scene, &pencil->K);
    make_symmetric(work->scene, &pencil->G);
    return DMB_OK;
}

/* K and the derivative of the residual by the factor, in an equilibrium. */
static int32_t stiffness_now(dmb_buckling *buckling, dmb_sim *sim, dmb_static_search *search)
{
    int32_t status = stiffness_at(buckling, search, 0.0);
    if (status >= 0) status = dmb_stiffness_balanced(sim, "buckling", &search->evaluation);
    if (status >= 0)
        status = dmb_load_pattern_derivative(&buckling->pattern, &search->evaluation, 0.0, buckling->response);
    if (status < 0) return status;
    dmb_system_iteration_matrix(&search->evaluation);
    take_matrix(buckling->work, 1.0, &buckling->pencil.K);
    return DMB_OK;
}

static int32_t stable(dmb_buckling *buckling, dmb_sim *sim)
{
    const uint32_t negative = dmb_pencil_count(&buckling->pencil, 0.0);
    if (negative == 0) return DMB_OK;
    dmb_message_set(&sim->message,
                    "buckling: the state is not stable, its stiffness has negative eigenvalues = %u, must be 0",
                    negative);
    return DMB_ERR_ORDER;
}

int32_t dmb_buckling_linearise(dmb_buckling *buckling, dmb_sim *sim, const dmb_buckling_options *options)
{
    dmb_static_search search;
    dmb_static_set_up(&search, buckling->work, NULL);
    dmb_static_slip(&search, options->slip_axial, options->slip_rotation);
    memset(buckling->work->increment, 0, buckling->work->scene->row_count * sizeof(double));
    int32_t status = dmb_system_prescribe(&search.evaluation);
    if (status < 0) return status;
    dmb_load_pattern_begin(&buckling->pattern, buckling->work);
    status = stiffness_now(buckling, sim, &search);
    if (status >= 0) status = respond(buckling, sim);
    if (status >= 0) status = differences(buckling, &search, difference_of(buckling, options->step));
    return status < 0 ? status : stable(buckling, sim);
}
