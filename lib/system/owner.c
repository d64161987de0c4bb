#include "system/owner.h"

static uint32_t pipe_at(const dmb_scene *scene, const dmb_string_map *string, uint32_t node)
{
    uint32_t found = 0;
    for (uint32_t i = 0; i < string->pipe_count; i++)
        if (scene->pipes[string->first_pipe + i].node <= node) found = i;
    return found;
}

dmb_owner dmb_owner_of_node(const dmb_scene *scene, uint32_t node)
{
    dmb_owner owner = {"string", 0, 0};
    for (uint32_t i = 0; i < scene->string_count; i++) {
        const dmb_string_map *string = scene->strings + i;
        if (node < string->first_node || node >= string->first_node + string->node_count) continue;
        owner.index = i;
        owner.pipe = pipe_at(scene, string, node);
        return owner;
    }
    owner.kind = "body";
    for (uint32_t i = 0; i < scene->body_count; i++)
        if (scene->bodies[i].node == node) owner.index = i;
    return owner;
}

dmb_owner dmb_owner_of_element(const dmb_scene *scene, uint32_t element)
{
    return dmb_owner_of_node(scene, scene->element_node[element]);
}

uint32_t dmb_node_of_row(const dmb_scene *scene, uint32_t row)
{
    uint32_t low = 0, high = scene->node_count;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (scene->layout.row[middle] <= row)
            low = middle;
        else
            high = middle;
    }
    return low;
}

uint32_t dmb_constraint_of_part(const dmb_sim *sim, dmb_id part)
{
    const dmb_scene *scene = sim->scene;
    const uint32_t joint = dmb_model_part_index(sim->model, part, DMB_PART_JOINT);
    const uint32_t coupling = dmb_model_part_index(sim->model, part, DMB_PART_COUPLING);
    const uint32_t drive = dmb_model_part_index(sim->model, part, DMB_PART_DRIVE);
    const uint32_t callback = dmb_model_part_index(sim->model, part, DMB_PART_CONSTRAINT);
    if (joint < scene->joint_count) return scene->joints[joint].constraint;
    if (coupling < scene->coupling_count) return scene->couplings[coupling].constraint;
    if (drive < scene->drive_count) return scene->drives[drive].constraint;
    return callback < scene->callback_count ? scene->callbacks[callback].constraint : UINT32_MAX;
}
