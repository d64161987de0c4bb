/* Copy of a sim for analyses; the sim is unchanged. The copy is of the dense scene if the sim's has sparse components,
 * because analyses need independent coordinates. Order: block, options, own scene, then the state; its partition
 * replaces the one that the preparation has chosen. Sparse components have rows chosen only, so a dense copy of them
 * chooses its own. */
#include "system/system.h"

#include <string.h>

#include "base/memory.h"
#include "model/field_check.h"
#include "sim/layout.h"
#include "sim/own_scene.h"
#include "system/constrain/constrain.h"

/* Chooses the partition; of sparse constraint components only rows are chosen. */
static int32_t choose(dmb_sim *copy)
{
    dmb_evaluation evaluation;
    memset(&evaluation, 0, sizeof evaluation);
    evaluation.sim = copy;
    evaluation.time = copy->clock->time;
    evaluation.load_factor = 1.0;
    const int32_t status = dmb_clusters_assemble(&evaluation);
    if (status >= 0) dmb_clusters_choose(copy);
    return status;
}

void dmb_state_assign(const dmb_sim *sim, dmb_sim *copy)
{
    dmb_field from[DMB_FIELD_MAX], to[DMB_FIELD_MAX];
    const size_t count = dmb_sim_fields(sim, DMB_GROUP_NOW, DMB_GROUP_MEMORY, from);
    (void)dmb_sim_fields(copy, DMB_GROUP_NOW, DMB_GROUP_MEMORY, to);
    for (size_t i = 0; i < count; i++) memcpy(to[i].data, from[i].data, from[i].bytes);
    dmb_configuration_copy(copy, &copy->now, &copy->trial);
    dmb_own_scene_update(copy);
}

dmb_sim *dmb_state_copy(const dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene->sparse_count ? sim->scene->dense : sim->scene;
    const size_t bytes = scene != NULL ? dmb_sim_bytes(scene) : SIZE_MAX;
    void *block = bytes == SIZE_MAX ? NULL : dmb_allocate(&sim->allocator, bytes);
    dmb_sim *copy = dmb_sim_carve(scene, block, bytes);
    if (copy == NULL) return NULL;
    copy->model = sim->model;
    copy->progress = sim->progress;
    copy->options = sim->options;
    copy->allocator = sim->allocator;
    dmb_own_scene_copy(copy, sim);
    dmb_clusters_prepare(copy); /* before the partition of the state takes its place */
    dmb_state_assign(sim, copy);
    if (sim->scene->sparse_count && choose(copy) < 0) {
        dmb_state_discard(copy);
        return NULL;
    }
    return copy;
}

int32_t dmb_state_copy_check(dmb_sim *sim, const char *who)
{
    const dmb_scene *scene = sim->scene;
    const dmb_cluster *largest = scene->clusters;
    dmb_message name;
    if (scene->sparse_count == 0 || scene->dense != NULL) return DMB_OK;
    for (uint32_t k = 1; k < scene->cluster_count; k++)
        if (scene->clusters[k].rows + scene->clusters[k].columns > largest->rows + largest->columns)
            largest = scene->clusters + k;
    dmb_constraint_text(scene, largest->constraint, &name);
    dmb_message_set(&sim->message,
                    "%s: cluster of %s: coordinates = %u, must be <= %d, equations = %u, must be <= %d, since they are "
                    "made independent by dense matrices; flexible pipes between joints divide a cluster",
                    who, name.text, largest->columns, DMB_CLUSTER_COLUMNS_MAX, largest->rows, DMB_CLUSTER_ROWS_MAX);
    return DMB_ERR_TOO_LARGE;
}

void dmb_state_discard(dmb_sim *copy)
{
    if (copy == NULL) return;
    const dmb_allocator allocator = copy->allocator;
    dmb_release(&allocator, copy->block, copy->block_size);
}
