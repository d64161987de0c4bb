/* Drives, loads and bits, from the parts they are described on to nodes. */
#include <math.h>
#include <string.h>

#include "math/elementary.h"
#include "math/so3.h"
#include "model/describe.h"
#include "model/field_check.h"
#include "model/mesh.h"

static uint32_t time_function_of(const dmb_mesh *mesh, dmb_id id)
{
    return dmb_model_part_index(mesh->model, id, DMB_PART_TIME_FUNCTION); /* DMB_NONE for none */
}

/* ---- Drives ------------------------------------------------------------------------------------------------------ */

/* DMB_NONE for a joint. */
static uint32_t driven_node(const dmb_mesh *mesh, dmb_id part)
{
    if (dmb_model_part_index(mesh->model, part, DMB_PART_JOINT) != DMB_NONE) return DMB_NONE;
    const uint32_t body = dmb_model_part_index(mesh->model, part, DMB_PART_BODY);
    if (body != DMB_NONE) return DMB_VECTOR_AT(dmb_body_map, &mesh->bodies, body)->node;
    return dmb_mesh_string_at(mesh, dmb_mesh_string_of(mesh, part))->start_node;
}

/* An axial-torsional node has no other components than those along and about its axis. */
static bool is_free(const dmb_mesh_node *node, int32_t component)
{
    const int32_t mask = node->size == DMB_NODE_AXIAL_TORSIONAL ? node->free & DMB_SET_CYLINDRICAL : node->free;
    return (mask >> component & 1) != 0;
}

/* Reserves a component for a MOTION drive in the mask of reserved components. */
static int32_t reserve_component(dmb_mesh *mesh, uint32_t drive, const dmb_drive_def *def, uint8_t *taken)
{
    dmb_message part;
    dmb_check check = dmb_check_of(&mesh->model->message,
                                   dmb_part_text(&part, "drive", drive, def->name, sizeof def->name), DMB_NONE);
    const uint8_t bit = (uint8_t)(1 << def->component);
    if (def->kind != DMB_DRIVE_MOTION) return DMB_OK;
    if ((*taken & bit) != 0) {
        dmb_check_fail(&check, DMB_ERR_VALUE, "component", def->component, "moved by one MOTION drive only");
    }
    *taken |= bit;
    return check.status;
}

static int32_t prescribe(dmb_mesh *mesh, uint32_t drive, const dmb_drive_def *def, dmb_mesh_node *node)
{
    dmb_message part;
    dmb_check check = dmb_check_of(&mesh->model->message,
                                   dmb_part_text(&part, "drive", drive, def->name, sizeof def->name), DMB_NONE);
    if (!is_free(node, def->component)) {
        dmb_check_fail(&check, DMB_ERR_VALUE, "component", def->component, "free where the drive acts");
        return check.status;
    }
    return reserve_component(mesh, drive, def, &node->prescribed);
}

static bool has_actuator(const dmb_drive_def *def)
{
    return def->kind != DMB_DRIVE_MOTION && (def->delay > 0.0 || def->force_rate > 0.0 || def->lag > 0.0 ||
                                             def->drag > 0.0 || def->back_drag > 0.0 || def->curve_count > 0);
}

static int32_t add_actuator(dmb_mesh *mesh, const dmb_drive_def *def)
{
    dmb_actuator_law law = {.delay = def->delay,
                            .rate_limit = def->force_rate,
                            .lag = def->lag,
                            .drag = {def->drag, def->back_drag},
                            .points = def->curve_count};
    memcpy(law.speed, def->curve_speed, sizeof law.speed);
    memcpy(law.force, def->curve_force, sizeof law.force);
    if (law.delay > 0.0) law.line = mesh->delays++;
    return dmb_vector_append(&mesh->actuators, &mesh->model->allocator, &law, 1);
}

static int32_t add_gain_table(dmb_mesh *mesh, const dmb_drive_def *def)
{
    dmb_gain_table table = {.points = def->gain_count};
    memcpy(table.error, def->gain_error, sizeof table.error);
    memcpy(table.force, def->gain_force, sizeof table.force);
    return dmb_vector_append(&mesh->gain_tables, &mesh->model->allocator, &table, 1);
}

/* The drive's time function; of a drive with a constant value one that compile adds behind those of the description,
 * which keep their numbers. */
static int32_t find_driven_value(const dmb_mesh *mesh, const dmb_drive_def *def, uint32_t *time_function)
{
    if (dmb_id_is_none(def->time_function)) return dmb_model_append_constant(mesh->model, def->value, time_function);
    *time_function = time_function_of(mesh, def->time_function);
    return DMB_OK;
}

static int32_t add_drive(dmb_mesh *mesh, uint32_t i)
{
    const dmb_drive_def *def = DMB_LIST_AT(const dmb_drive_def, mesh->model->drives, i);
    const bool excited = (mesh->features & DMB_FEATURE_EXCITATION) != 0;
    const uint32_t joint = dmb_model_part_index(mesh->model, def->part, DMB_PART_JOINT);
    dmb_scene_drive drive = {.gain = def->gain,
                             .integral_gain = def->integral_gain,
                             .limit_low = def->limit_low,
                             .limit_high = def->limit_high,
                             .mud_pressure = def->mud_pressure,
                             .node = driven_node(mesh, def->part),
                             .row = DMB_NONE,
                             .kind = def->kind,
                             .component = def->component,
                             .excitation = excited ? time_function_of(mesh, def->excitation) : DMB_NONE,
                             .joint = joint,
                             .constraint = DMB_NONE,
                             .actuator = has_actuator(def) ? (uint32_t)mesh->actuators.count : DMB_NONE,
                             .table = def->gain_count > 0 ? (uint32_t)mesh->gain_tables.count : DMB_NONE};
    memcpy(drive.name, def->name, sizeof drive.name);
    int32_t status = joint != DMB_NONE ? reserve_component(mesh, i, def, DMB_VECTOR_AT(uint8_t, &mesh->driven, joint))
                                       : prescribe(mesh, i, def, dmb_mesh_node_at(mesh, drive.node));
    if (status >= 0) status = find_driven_value(mesh, def, &drive.time_function);
    if (status < 0) return status;
    if (drive.actuator != DMB_NONE && add_actuator(mesh, def) < 0) return DMB_ERR_NO_MEMORY;
    if (drive.table != DMB_NONE && add_gain_table(mesh, def) < 0) return DMB_ERR_NO_MEMORY;
    return dmb_vector_append(&mesh->drives, &mesh->model->allocator, &drive, 1);
}

/* ---- Loads ------------------------------------------------------------------------------------------------------- */

static bool is_shifted(const double offset[3])
{
    return fabs(offset[0]) > 0.0 || fabs(offset[1]) > 0.0 || fabs(offset[2]) > 0.0;
}

/* A load on the axis of a node acts at the node, the cheapest form; elsewhere it acts at a point. */
static int32_t place_load(dmb_mesh *mesh, uint32_t i, const dmb_load_def *def, dmb_scene_load *load)
{
    dmb_message part;
    dmb_check check =
        dmb_check_of(&mesh->model->message, dmb_part_text(&part, "load", i, def->name, sizeof def->name), DMB_NONE);
    dmb_mesh_place place = {0, 0.0};
    if (!is_shifted(def->offset) && dmb_mesh_place_of(mesh, &def->place, &place)) {
        load->node = place.node;
        load->arm = place.arm;
        return DMB_OK;
    }
    const dmb_scene_point point = dmb_mesh_point(&check, mesh, "place", &def->place, def->offset);
    if (check.status < 0) return check.status;
    load->node = point.node;
    load->point = (uint32_t)mesh->load_points.count;
    return dmb_vector_append(&mesh->load_points, &mesh->model->allocator, &point, 1);
}

static int32_t add_load(dmb_mesh *mesh, uint32_t i)
{
    const dmb_load_def *def = DMB_LIST_AT(const dmb_load_def, mesh->model->loads, i);
    dmb_scene_load load = {
        .frame = def->frame, .time_function = time_function_of(mesh, def->time_function), .point = DMB_NONE};
    for (int k = 0; k < 3; ++k) {
        load.force[k] = def->force[k];
        load.moment[k] = def->moment[k];
    }
    memcpy(load.name, def->name, sizeof load.name);
    const int32_t status = place_load(mesh, i, def, &load);
    return status < 0 ? status : dmb_vector_append(&mesh->loads, &mesh->model->allocator, &load, 1);
}

/* ---- Bits -------------------------------------------------------------------------------------------------------- */

static dmb_bit_rock_law rock_law_of(const dmb_bit_def *def, bool wanted)
{
    const dmb_bit_rock_law law = {.kind = wanted ? def->rock_law : DMB_ROCK_NONE,
                                  .blades = def->blades,
                                  .radius = def->radius,
                                  .inner_radius = def->inner_radius,
                                  .intrinsic_energy = def->intrinsic_energy,
                                  .cutting_ratio = def->cutting_ratio,
                                  .contact_strength = def->contact_strength,
                                  .wear_length = def->wear_length,
                                  .contact_friction = def->contact_friction,
                                  .intrusion_depth = def->intrusion_depth};
    return law;
}

/* Side cutting is omitted without rock; axial-torsional nodes do not move sideways. The resistance is D = 2 pi zeta eps
 * (a - b)/I of eq:bit.side, a surface from b to a in the place of the disc. */
static int32_t add_side(dmb_mesh *mesh, uint32_t i, const dmb_bit_def *def, dmb_scene_bit *bit)
{
    if (!(def->side_cutting > 0.0) || (mesh->features & DMB_FEATURE_ROCK) == 0) return DMB_OK;
    if (dmb_mesh_node_at(mesh, bit->node)->size != DMB_NODE_SIX_DOF) {
        dmb_message_set(
            &mesh->model->message,
            "bit %u: side_cutting = %g, must be 0 behind axial-torsional pipes, which do not move sideways; "
            "describe flexible pipes",
            i, def->side_cutting);
        return DMB_ERR_UNSUPPORTED;
    }
    bit->side.resistance =
        DMB_TWO_PI * def->cutting_ratio * def->intrinsic_energy * (def->radius - def->inner_radius) / def->side_cutting;
    dmb_sin_cos(def->walk_angle, &bit->side.sine, &bit->side.cosine);
    return DMB_OK;
}

/* A bit starts at its reference point and cuts at its far end; a reamer cuts at the middle of its stabiliser. */
static void set_face(const dmb_mesh *mesh, const dmb_bit_def *def, dmb_scene_bit *bit)
{
    bit->face = bit->length = def->length;
    if (!bit->reamer) return;
    const uint32_t ring = dmb_model_part_index(mesh->model, def->stabiliser, DMB_PART_STABILISER);
    bit->face = 0.0;
    bit->length = 0.5 * DMB_LIST_AT(const dmb_stabiliser_def, mesh->model->rings, ring)->length;
}

static int32_t add_bit(dmb_mesh *mesh, uint32_t i)
{
    const dmb_bit_def *def = DMB_LIST_AT(const dmb_bit_def, mesh->model->bits, i);
    const dmb_body_map *map = DMB_VECTOR_AT(dmb_body_map, &mesh->bodies, mesh->model->bodies.count + i);
    dmb_scene_bit bit = {.law = rock_law_of(def, (mesh->features & DMB_FEATURE_ROCK) != 0),
                         .bottom = def->bottom,
                         .node = map->node,
                         .load = time_function_of(mesh, def->load),
                         .history_first = mesh->history_count,
                         .arm = map->arm,
                         .reamer = !dmb_id_is_none(def->stabiliser)};
    set_face(mesh, def, &bit);
    if (bit.law.kind == DMB_ROCK_REGENERATIVE) bit.history_capacity = def->history;
    if (bit.history_capacity > UINT32_MAX - mesh->history_count) return DMB_ERR_TOO_LARGE;
    mesh->history_count += bit.history_capacity;
    const int32_t status = add_side(mesh, i, def, &bit);
    return status < 0 ? status : dmb_vector_append(&mesh->bits, &mesh->model->allocator, &bit, 1);
}

int32_t dmb_mesh_actions(dmb_mesh *mesh)
{
    const dmb_model *model = mesh->model;
    int32_t status = dmb_vector_append(&mesh->driven, &model->allocator, NULL, mesh->joints.count);
    for (uint32_t i = 0; i < model->drives.count && status >= 0; ++i) status = add_drive(mesh, i);
    for (uint32_t i = 0; i < model->loads.count && status >= 0; ++i) status = add_load(mesh, i);
    for (uint32_t i = 0; i < model->bits.count && status >= 0; ++i) status = add_bit(mesh, i);
    return status;
}
