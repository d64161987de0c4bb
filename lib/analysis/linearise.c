#include "analysis/linearise.h"

#include <string.h>

#include "analysis/linearise_parts.h"
#include "system/cluster.h"

static void spin_node(dmb_sim *work, uint32_t node, double spin)
{
    const uint32_t row = work->scene->layout.row[node] + (work->scene->layout.size[node] == DMB_NODE_PATH ? 1 : 3);
    work->now.velocity[row] = work->trial.velocity[row] = spin;
}

/* The strings of the state turning about their own axes. */
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

/* The partition of the state, its rows and factors; and the forces of constraint, which the tangents take as given. */
static int32_t settle(dmb_sim *work)
{
    dmb_evaluation evaluation = dmb_linear_evaluation(work);
    memset(work->increment, 0, work->scene->row_count * sizeof(double));
    work->linked_mode->row = UINT32_MAX;
    return work->scene->cluster_count ? dmb_clusters_settle(&evaluation, 0, 0) : DMB_OK;
}

static int32_t take_multipliers(dmb_sim *work)
{
    dmb_evaluation evaluation = dmb_linear_evaluation(work);
    return work->scene->cluster_count ? dmb_system_evaluate(&evaluation) : DMB_OK;
}

static int32_t take_matrices(dmb_linear *linear, const dmb_linear_options *options)
{
    dmb_sim *work = linear->work;
    dmb_evaluation evaluation = dmb_linear_evaluation(work);
    double *before = work->trial.pseudo_acceleration; /* which no force depends on */
    work->linked_mode->multipliers = 1;               /* they are given */
    int32_t status = dmb_system_evaluate(&evaluation);
    memcpy(before, work->correction, linear->rows * sizeof(double));
    dmb_linear_freeze(linear, options);
    if (status >= 0) status = dmb_linear_take_stiffness_and_mass(linear);
    if (status >= 0) dmb_linear_add_dead_loads(linear, before);
    if (status >= 0 && options->contact == DMB_LINEAR_CONTACT_CLOSED) dmb_linear_close_contacts(linear, options->gap);
    return status < 0 ? status : dmb_linear_take_damping(linear);
}

/* What is left over may be rounding of poses, which the stiffness tells. */
static int32_t judge_rounding(dmb_linear *linear)
{
    linear->work->linked_mode->multipliers = 1;
    const int32_t status = dmb_linear_take_stiffness_and_mass(linear);
    linear->work->linked_mode->multipliers = 0;
    dmb_linear_judge_rounding(linear);
    return status;
}

static int32_t linearise(dmb_linear *linear, const dmb_linear_options *options)
{
    dmb_sim *work = linear->work;
    if (options->spin != 0.0) spin_strings(work, options->spin);
    int32_t status = settle(work);
    if (status >= 0) status = dmb_linear_take_balance(linear);
    if (status >= 0 && !linear->balanced) status = take_multipliers(work);
    if (status >= 0 && !linear->balanced) status = judge_rounding(linear);
    if (status >= 0) dmb_linear_take_steady_accelerations(linear);
    if (status >= 0) status = take_multipliers(work);
    if (status >= 0) status = take_matrices(linear, options);
    work->linked_mode->multipliers = 0;
    if (status < 0) return status;
    dmb_linear_judge_rounding(linear);
    dmb_linear_turn_frames(linear, options->still);
    dmb_linear_take_stiffness_size(linear);
    return dmb_linear_make_coordinates(linear);
}

int32_t dmb_linear_make(const dmb_sim *sim, const dmb_linear_options *options, dmb_linear **linear)
{
    int32_t status = dmb_progress_pulse(sim);
    if (status < 0) return status;
    *linear = dmb_linear_allocate(sim);
    if (*linear == NULL) return DMB_ERR_NO_MEMORY;
    status = linearise(*linear, options);
    if (status < 0) dmb_linear_release(linear);
    return status;
}
