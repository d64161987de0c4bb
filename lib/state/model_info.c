/* Counts of a compiled model. They stand here because one of them is the size of a sim. */
#include "base/handle.h"
#include "base/sized_struct.h"
#include "state/layout.h"

DMB_DECLARE_STRUCT(dmb_model_info)

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
    info->model_bytes = scene->bytes;
    info->sim_bytes = dmb_sim_bytes(scene);
    info->mass = scene->mass;
    info->length = scene->length;
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
