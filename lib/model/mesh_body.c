/* Nodes of free bodies, and the nodes that bodies and bits are fixed to. */
#include "model/mesh.h"

static uint32_t push_free_body(dmb_mesh *mesh, uint32_t body, const dmb_body_def *def)
{
    const dmb_mesh_node node = {.string = UINT32_MAX,
                                .body = body,
                                .lump = UINT32_MAX,
                                .size = DMB_NODE_FULL,
                                .free = (uint8_t)def->free_mask,
                                .rigid = 1};
    (void)dmb_vector_append(&mesh->nodes, &mesh->model->allocator, &node, 1); /* room was reserved */
    return (uint32_t)mesh->nodes.count - 1;
}

static dmb_body_map map_of(dmb_mesh *mesh, uint32_t body, const dmb_body_def *def)
{
    dmb_body_map map = {0, UINT32_MAX, 0.0};
    if (def->attach == DMB_ATTACH_NONE) {
        map.node = push_free_body(mesh, body, def);
        return map;
    }
    const dmb_string_map *string = dmb_mesh_string_at(mesh, dmb_mesh_string_of(mesh, def->string));
    const bool at_start = def->attach == DMB_ATTACH_START;
    map.node = at_start ? string->start_node : string->end_node;
    map.arm = at_start ? string->start_arm : string->end_arm;
    return map;
}

/* A bit's reference point is the string's end; its centre is half its length beyond. */
static dmb_body_map bit_map_of(const dmb_mesh *mesh, const dmb_bit_def *def)
{
    const dmb_string_map *string = dmb_mesh_string_at(mesh, dmb_mesh_string_of(mesh, def->string));
    const dmb_body_map map = {string->end_node, UINT32_MAX, string->end_arm};
    return map;
}

int32_t dmb_mesh_bodies(dmb_mesh *mesh)
{
    const dmb_model *model = mesh->model;
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < model->bodies.count && status >= 0; ++i) {
        const dmb_body_map map = map_of(mesh, i, DMB_LIST_AT(const dmb_body_def, model->bodies, i));
        status = dmb_vector_append(&mesh->bodies, &model->allocator, &map, 1);
    }
    for (uint32_t i = 0; i < model->bits.count && status >= 0; ++i) {
        const dmb_body_map map = bit_map_of(mesh, DMB_LIST_AT(const dmb_bit_def, model->bits, i));
        status = dmb_vector_append(&mesh->bodies, &model->allocator, &map, 1);
    }
    return status;
}
