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
