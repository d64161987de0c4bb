#include <string.h>

#include "base/allocator.h"
#include "state/layout.h"
#include "system/cluster.h"

dmb_sim *dmb_state_copy(const dmb_sim *sim)
{
    dmb_field from[DMB_FIELD_MAX], to[DMB_FIELD_MAX];
    const size_t bytes = dmb_sim_bytes(sim->scene);
    void *block = bytes == SIZE_MAX ? NULL : dmb_allocate(&sim->allocator, bytes);
    dmb_sim *copy = dmb_sim_carve(sim->scene, block, bytes);
    if (copy == NULL) return NULL;
    copy->model = sim->model;
    copy->options = sim->options;
    copy->allocator = sim->allocator;
    dmb_clusters_prepare(copy); /* before the partition of the state takes its place */
    const size_t count = dmb_sim_fields(sim, DMB_GROUP_NOW, DMB_GROUP_MEMORY, from);
    (void)dmb_sim_fields(copy, DMB_GROUP_NOW, DMB_GROUP_MEMORY, to);
    for (size_t i = 0; i < count; i++) memcpy(to[i].data, from[i].data, from[i].bytes);
    dmb_configuration_copy(copy, &copy->now, &copy->trial);
    return copy;
}

void dmb_state_discard(dmb_sim *copy)
{
    if (copy == NULL) return;
    const dmb_allocator allocator = copy->allocator;
    dmb_release(&allocator, copy->block, copy->block_size);
}
