/* The model check as a struct. */
#include <string.h>

#include "analysis/model_check.h"
#include "base/handle.h"
#include "base/sized_struct.h"

DMB_DECLARE_STRUCT(dmb_check_report)

/* ---- Counts ------------------------------------------------------------------------------------------------------ */

/* As one would count them on the drawing: what is fixed to a string is a part, though it has no unknowns of its own. */
static void count_parts(const dmb_scene *scene, dmb_check_report *report)
{
    report->rigid_parts = scene->body_count; /* bits included */
    for (uint32_t i = 0; i < scene->pipe_count; i++) {
        const dmb_pipe_map *pipe = scene->pipes + i;
        report->flexible_parts += pipe->elements > 0;
        report->rigid_parts += pipe->elements == 0;
        report->rigid_parts += pipe->joint > 0.0;
    }
    report->elements = scene->element_count;
    report->structural_joints = scene->structural_joint_count;
}

static void count_joints(const dmb_sim *sim, dmb_check_report *report)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t j = 0; j < scene->joint_count; j++) {
        const int open = sim->joint_state[j] == DMB_JOINT_OPEN;
        report->open_joints += (uint32_t)open;
        report->locked_joints += sim->joint_state[j] == DMB_JOINT_LOCKED;
        report->joints[scene->joints[j].kind] += !open;
    }
    report->couplings = scene->coupling_count;
    report->constraints = scene->callback_count;
}

static void count_actions(const dmb_scene *scene, dmb_check_report *report)
{
    for (uint32_t i = 0; i < scene->drive_count; i++)
        report->motion_drives += scene->drives[i].kind == DMB_DRIVE_MOTION;
    report->other_drives = scene->drive_count - report->motion_drives;
    report->loads = scene->load_count;
}

static void count_freedoms(const dmb_scene *scene, const dmb_cluster_rank *rank, dmb_check_report *report)
{
    report->coordinates = scene->row_count;
    report->prescribed = scene->prescribed_count;
    report->held = scene->row_count - scene->free_count - scene->prescribed_count;
    report->rows = rank->rows;
    report->rank = rank->rank;
    report->redundant = rank->rows - rank->rank;
    report->gruebler = (int64_t)scene->free_count - (int64_t)rank->rows;
    report->freedoms = scene->free_count - rank->rank;
    report->largest_misfit = rank->misfit;
    report->condition = rank->condition;
}

static void count_solver(const dmb_scene *scene, dmb_check_report *report)
{
    report->sparse_nodes = scene->linked_count;
    report->tridiagonal_nodes = scene->node_count - scene->linked_count;
    report->blocks = scene->block_count;
    report->fill = scene->pattern.fill;
    report->clusters = scene->cluster_count;
    for (uint32_t k = 0; k < scene->cluster_count; k++)
        if (scene->clusters[k].columns > report->largest_cluster) report->largest_cluster = scene->clusters[k].columns;
}

/* ---- Check ------------------------------------------------------------------------------------------------------- */

static void count_line(void *context, const char *text)
{
    uint32_t *lines = context;
    (void)text;
    ++*lines;
}

static int32_t make(const dmb_sim *sim, dmb_model_check *check)
{
    dmb_check_report *report = &check->report;
    uint32_t lines = 0;
    memset(check, 0, sizeof *check);
    check->sim = sim;
    int32_t status = dmb_cluster_rank_make(sim, &check->rank);
    if (status >= 0) status = dmb_find_loose_parts(sim, &check->loose);
    if (status < 0) {
        dmb_cluster_rank_release(sim, &check->rank);
        return status;
    }
    count_parts(sim->scene, report);
    count_joints(sim, report);
    count_actions(sim->scene, report);
    count_freedoms(sim->scene, &check->rank, report);
    count_solver(sim->scene, report);
    dmb_model_check_warnings(check, count_line, &lines);
    report->warnings = lines;
    return DMB_OK;
}

int32_t dmb_model_check_open(const dmb_sim *sim, dmb_model_check *check)
{
    int32_t status = dmb_sim_occupy(sim);
    if (status < 0) return status;
    status = make(sim, check);
    return status < 0 ? dmb_sim_leave((dmb_sim *)sim, status) : DMB_OK;
}

void dmb_model_check_close(dmb_model_check *check)
{
    dmb_cluster_rank_release(check->sim, &check->rank);
    (void)dmb_sim_leave((dmb_sim *)check->sim, DMB_OK);
}

int32_t dmb_analysis_check(const dmb_sim *sim, dmb_check_report *report)
{
    dmb_model_check check;
    if (sim == NULL || report == NULL) return DMB_ERR_NULL;
    int32_t status = dmb_model_check_open(sim, &check);
    if (status < 0) return status;
    status = dmb_check_report_write(report, &check.report);
    dmb_model_check_close(&check);
    return status;
}
