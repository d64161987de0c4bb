/* Counts of a compiled model. They stand here because one of them is the size of a sim. */
#include "base/handle.h"
#include "base/sized_struct.h"
#include "constraint/joint.h"
#include "state/layout.h"

DMB_DECLARE_STRUCT(dmb_model_info)

static int32_t is_open(const dmb_scene *scene, uint32_t joint)
{
    return scene->joints[joint].state == DMB_JOINT_OPEN;
}

static uint32_t joint_rows(const dmb_scene_joint *joint)
{
    if (joint->state == DMB_JOINT_OPEN) return 0;
    return joint->state == DMB_JOINT_LOCKED ? DMB_CONSTRAINT_ROWS : dmb_joint_row_count(joint->kind);
}

/* Equations at time 0: those of open joints, and on their coordinates, do not count. */
static uint32_t active_rows(const dmb_scene *scene)
{
    uint32_t rows = 0;
    for (uint32_t i = 0; i < scene->joint_count; ++i) rows += joint_rows(&scene->joints[i]);
    for (uint32_t i = 0; i < scene->coupling_count; ++i) {
        const uint32_t *joint = scene->couplings[i].joint;
        if (!is_open(scene, joint[0]) && !is_open(scene, joint[1])) ++rows;
    }
    for (uint32_t i = 0; i < scene->drive_count; ++i) {
        const dmb_scene_drive *drive = &scene->drives[i];
        if (drive->constraint != UINT32_MAX && !is_open(scene, drive->joint)) ++rows;
    }
    for (uint32_t i = 0; i < scene->callback_count; ++i) rows += scene->callbacks[i].rows;
    return rows;
}

static void fill_info(const dmb_scene *scene, dmb_model_info *info)
{
    info->strings = scene->string_count;
    info->pipes = scene->pipe_count;
    info->rigid_bodies = scene->rigid_count;
    info->nodes = scene->node_count;
    info->elements = scene->element_count;
    info->contact_sites = scene->site_count + scene->path_site_count;
    info->freedoms = scene->free_count;
    info->prescribed = scene->prescribed_count;
    info->structural_joints = scene->structural_joint_count;
    info->model_bytes = scene->bytes + scene->pattern.block_size;
    if (scene->dense != NULL) info->model_bytes += scene->dense->bytes + scene->dense->pattern.block_size;
    info->sim_bytes = dmb_sim_bytes(scene);
    info->mass = scene->mass;
    info->length = scene->length;
    info->joints = scene->joint_count;
    info->constraint_rows = active_rows(scene);
    info->clusters = scene->cluster_count;
    info->linked_nodes = scene->linked_count;
}

int32_t dmb_model_get_info(const dmb_model *model, dmb_model_info *info)
{
    dmb_model_info answer = dmb_model_info_default();
    if (model == NULL || info == NULL) return DMB_ERR_NULL;
    if (!dmb_handle_is(model, DMB_HANDLE_MODEL)) return DMB_ERR_HANDLE;
    if (model->scene == NULL) return DMB_ERR_ORDER;
    fill_info(model->scene, &answer);
    return dmb_model_info_write(info, &answer);
}
