/* Drives, loads and bits, from the parts they are described on to nodes. */
#include "model/field_check.h"
#include "model/mesh.h"

static uint32_t programme_of(const dmb_mesh *mesh, dmb_id id)
{
    return dmb_model_part_index(mesh->model, id, DMB_PART_PROGRAMME); /* UINT32_MAX for none */
}

/* ---- Drives ------------------------------------------------------------------------------------------------------ */

static uint32_t driven_node(const dmb_mesh *mesh, dmb_id part)
{
    const uint32_t body = dmb_model_part_index(mesh->model, part, DMB_PART_BODY);
    if (body != UINT32_MAX) return DMB_VECTOR_AT(dmb_body_map, &mesh->bodies, body)->node;
    return dmb_mesh_string_at(mesh, dmb_mesh_string_of(mesh, part))->start_node;
}

/* A PATH node has no other components than those along and about its axis. */
static bool is_free(const dmb_mesh_node *node, int32_t component)
{
    const int32_t mask = node->size == DMB_NODE_PATH ? node->free & DMB_FREE_CYLINDRICAL : node->free;
    return (mask >> component & 1) != 0;
}

/* A MOTION drive takes the component for itself. */
static int32_t prescribe(dmb_mesh *mesh, uint32_t drive, const dmb_drive_def *def, dmb_mesh_node *node)
{
    dmb_check check = dmb_check_of(&mesh->model->message, "drive", drive);
    const uint8_t bit = (uint8_t)(1 << def->component);
    if (!is_free(node, def->component)) {
        dmb_check_fail(&check, DMB_ERR_VALUE, "component", def->component, "free where the drive acts");
    }
    if (def->kind != DMB_DRIVE_MOTION || check.status < 0) return check.status;
    if ((node->prescribed & bit) != 0) {
        dmb_check_fail(&check, DMB_ERR_VALUE, "component", def->component, "moved by one MOTION drive only");
    }
    node->prescribed |= bit;
    return check.status;
}

static int32_t add_drive(dmb_mesh *mesh, uint32_t i)
{
    const dmb_drive_def *def = DMB_LIST_AT(const dmb_drive_def, mesh->model->drives, i);
    const bool excited = (mesh->features & DMB_FEATURE_EXCITATION) != 0;
    const dmb_scene_drive drive = {.gain = def->gain,
                                   .integral_gain = def->integral_gain,
                                   .limit_low = def->limit_low,
                                   .limit_high = def->limit_high,
                                   .node = driven_node(mesh, def->part),
                                   .kind = def->kind,
                                   .component = def->component,
                                   .programme = programme_of(mesh, def->programme),
                                   .excitation = excited ? programme_of(mesh, def->excitation) : UINT32_MAX};
    const int32_t status = prescribe(mesh, i, def, dmb_mesh_node_at(mesh, drive.node));
    if (status < 0) return status;
    return dmb_vector_append(&mesh->drives, &mesh->model->allocator, &drive, 1);
}

/* ---- Loads ------------------------------------------------------------------------------------------------------- */

/* Node and arm of the near or far end of a pipe. */
static void pipe_end(const dmb_mesh *mesh, uint32_t string, uint32_t pipe, bool far, dmb_scene_load *load)
{
    const dmb_pipe_map *map = dmb_mesh_pipe_at(mesh, dmb_mesh_string_at(mesh, string)->first_pipe + pipe);
    load->node = map->node;
    load->arm = map->start + (far ? map->length : 0.0);
    if (map->elements == 0) return;
    const dmb_mesh_element *first = dmb_mesh_element_at(mesh, map->element), *last = first + map->elements - 1;
    load->node = far ? last->node + 1 : first->node;
    load->arm = far ? map->joint - last->arm[1] : first->arm[0];
}

static void load_place(const dmb_mesh *mesh, const dmb_place *place, dmb_scene_load *load)
{
    const dmb_model *model = mesh->model;
    const uint32_t string = dmb_model_part_index(model, place->part, DMB_PART_STRING);
    const uint32_t bit = dmb_model_part_index(model, place->part, DMB_PART_BIT);
    const uint32_t body =
        bit != UINT32_MAX ? model->bodies.count + bit : dmb_model_part_index(model, place->part, DMB_PART_BODY);
    if (string != UINT32_MAX) {
        pipe_end(mesh, string, place->pipe, place->fraction > 0.5, load);
        return;
    }
    load->node = DMB_VECTOR_AT(dmb_body_map, &mesh->bodies, body)->node;
    load->arm = DMB_VECTOR_AT(dmb_body_map, &mesh->bodies, body)->arm;
}

static int32_t add_load(dmb_mesh *mesh, uint32_t i)
{
    const dmb_load_def *def = DMB_LIST_AT(const dmb_load_def, mesh->model->loads, i);
    dmb_scene_load load = {.frame = def->frame, .programme = programme_of(mesh, def->programme)};
    for (int k = 0; k < 3; ++k) {
        load.force[k] = def->force[k];
        load.moment[k] = def->moment[k];
    }
    load_place(mesh, &def->place, &load);
    return dmb_vector_append(&mesh->loads, &mesh->model->allocator, &load, 1);
}

/* ---- Bits -------------------------------------------------------------------------------------------------------- */

static dmb_bit_rock_law rock_law_of(const dmb_bit_def *def, bool wanted)
{
    const dmb_bit_rock_law law = {.kind = wanted ? def->rock_law : DMB_ROCK_NONE,
                                  .blades = def->blades,
                                  .radius = def->radius,
                                  .intrinsic_energy = def->intrinsic_energy,
                                  .cutting_ratio = def->cutting_ratio,
                                  .contact_strength = def->contact_strength,
                                  .wear_length = def->wear_length,
                                  .contact_friction = def->contact_friction,
                                  .intrusion_depth = def->intrusion_depth};
    return law;
}

static int32_t add_bit(dmb_mesh *mesh, uint32_t i)
{
    const dmb_bit_def *def = DMB_LIST_AT(const dmb_bit_def, mesh->model->bits, i);
    const dmb_body_map *map = DMB_VECTOR_AT(dmb_body_map, &mesh->bodies, mesh->model->bodies.count + i);
    dmb_scene_bit bit = {.law = rock_law_of(def, (mesh->features & DMB_FEATURE_ROCK) != 0),
                         .bottom = def->bottom,
                         .node = map->node,
                         .load = programme_of(mesh, def->load),
                         .history_first = mesh->history_count,
                         .arm = map->arm};
    if (bit.law.kind == DMB_ROCK_REGENERATIVE) bit.history_capacity = def->history;
    if (bit.history_capacity > UINT32_MAX - mesh->history_count) return DMB_ERR_TOO_LARGE;
    mesh->history_count += bit.history_capacity;
    return dmb_vector_append(&mesh->bits, &mesh->model->allocator, &bit, 1);
}

int32_t dmb_mesh_actions(dmb_mesh *mesh)
{
    const dmb_model *model = mesh->model;
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < model->drives.count && status >= 0; ++i) status = add_drive(mesh, i);
    for (uint32_t i = 0; i < model->loads.count && status >= 0; ++i) status = add_load(mesh, i);
    for (uint32_t i = 0; i < model->bits.count && status >= 0; ++i) status = add_bit(mesh, i);
    return status;
}
