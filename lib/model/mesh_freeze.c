/* The finished scene in one block: counts first, then the arrays are laid out twice (counting, placing), then filled. */
#include <string.h>

#include "base/allocator.h"
#include "base/arena.h"
#include "math/mat6.h"
#include "math/so3.h"
#include "model/limits.h"
#include "model/mesh.h"

/* The layout's arrays and the hole's stations, which the scene sees as read-only. */
typedef struct writable {
    uint8_t *size;
    uint32_t *row, *diag, *link;
    dmb_hole_station *stations;
} writable;

/* ---- Counts ------------------------------------------------------------------------------------------------------ */

/* Free rows and rows that are unknowns, as bits of the node's rows. */
static uint8_t free_rows(const dmb_mesh_node *node)
{
    if (node->size == DMB_NODE_FULL) return node->free;
    return (uint8_t)((node->free >> DMB_X & 1) | (node->free >> DMB_RX & 1) << 1);
}

static uint8_t prescribed_rows(const dmb_mesh_node *node)
{
    if (node->size == DMB_NODE_FULL) return node->prescribed;
    return (uint8_t)((node->prescribed >> DMB_X & 1) | (node->prescribed >> DMB_RX & 1) << 1);
}

static void count_rows(const dmb_mesh *mesh, dmb_scene *scene)
{
    for (uint32_t i = 0; i < mesh->nodes.count; ++i) {
        const dmb_mesh_node *node = dmb_mesh_node_at(mesh, i);
        const uint8_t open = free_rows(node), moved = prescribed_rows(node);
        scene->row_count += node->size;
        scene->rigid_count += node->rigid;
        for (uint32_t k = 0; k < node->size; ++k) {
            const uint32_t is_open = open >> k & 1, is_moved = moved >> k & 1;
            scene->free_count += is_open & ~is_moved;
            scene->prescribed_count += is_moved;
            scene->held_count += 1 - (is_open & ~is_moved);
        }
    }
}

/* Fixed joints as one would count them on the drawing: between neighbouring pipes, between a pipe and its tool joint, and
 * where a body or a bit is fixed to a string. */
static uint32_t structural_joints(const dmb_mesh *mesh)
{
    const dmb_model *model = mesh->model;
    uint32_t count = (uint32_t)(mesh->pipes.count - mesh->strings.count) + mesh->tool_joints + model->bits.count;
    for (uint32_t i = 0; i < model->bodies.count; ++i) {
        if (DMB_LIST_AT(const dmb_body_def, model->bodies, i)->attach != DMB_ATTACH_NONE) ++count;
    }
    return count;
}

static void count_parts(const dmb_mesh *mesh, dmb_scene *scene)
{
    scene->node_count = (uint32_t)mesh->nodes.count;
    scene->element_count = (uint32_t)mesh->elements.count;
    scene->type_count = (uint32_t)mesh->types.count;
    scene->batch_count = (uint32_t)mesh->batches.count;
    scene->chain_count = (uint32_t)(mesh->nodes.count - mesh->elements.count); /* a chain has one node more than elements */
    scene->lump_count = (uint32_t)mesh->lumps.count;
    scene->site_count = (uint32_t)mesh->sites.count;
    scene->path_site_count = (uint32_t)mesh->path_sites.count;
    scene->drive_count = (uint32_t)mesh->drives.count;
    scene->load_count = (uint32_t)mesh->loads.count;
    scene->bit_count = (uint32_t)mesh->bits.count;
    scene->programme_count = mesh->model->programmes.count;
    scene->string_count = (uint32_t)mesh->strings.count;
    scene->pipe_count = (uint32_t)mesh->pipes.count;
    scene->body_count = (uint32_t)mesh->bodies.count; /* bits included */
    scene->history_count = mesh->history_count;
    scene->structural_joint_count = structural_joints(mesh);
    count_rows(mesh, scene);
}

/* ---- Layout of the block ----------------------------------------------------------------------------------------- */

static void take_nodes(dmb_arena *arena, const dmb_scene *counts, dmb_scene *to, writable *w)
{
    const size_t n = counts->node_count, rows = counts->row_count, held = counts->held_count;
    w->size = DMB_ARENA_ARRAY(arena, uint8_t, n);
    w->row = DMB_ARENA_ARRAY(arena, uint32_t, n + 1);
    w->diag = DMB_ARENA_ARRAY(arena, uint32_t, n + 1);
    w->link = DMB_ARENA_ARRAY(arena, uint32_t, n);
    to->reference_position = DMB_ARENA_DOUBLES(arena, 3 * n);
    to->reference_quaternion = DMB_ARENA_DOUBLES(arena, 4 * n);
    to->reference_depth = DMB_ARENA_DOUBLES(arena, n);
    to->initial_velocity = DMB_ARENA_DOUBLES(arena, rows);
    to->free_row = DMB_ARENA_ARRAY(arena, uint8_t, rows);
    to->solved_row = DMB_ARENA_ARRAY(arena, uint8_t, rows);
    to->held_node = DMB_ARENA_ARRAY(arena, uint32_t, held);
    to->held_component = DMB_ARENA_ARRAY(arena, uint32_t, held);
    to->weight_mass = DMB_ARENA_DOUBLES(arena, n);
    to->weight_moment = DMB_ARENA_DOUBLES(arena, 3 * n);
    to->node_damping = DMB_ARENA_DOUBLES(arena, 3 * n);
    to->node_element = DMB_ARENA_ARRAY(arena, uint32_t, n);
    to->chains = DMB_ARENA_ARRAY(arena, dmb_chain, counts->chain_count);
    to->lumps = DMB_ARENA_ARRAY(arena, dmb_lump, counts->lump_count);
}

static void take_elements(dmb_arena *arena, const dmb_scene *counts, dmb_scene *to)
{
    const size_t e = counts->element_count;
    to->types = (dmb_element_type *)dmb_arena_take(arena, counts->type_count, sizeof *to->types, DMB_ALIGNMENT);
    to->element_type = DMB_ARENA_ARRAY(arena, uint32_t, e);
    to->element_node = DMB_ARENA_ARRAY(arena, uint32_t, e);
    to->element_span = DMB_ARENA_DOUBLES(arena, 3 * e);
    to->batches = DMB_ARENA_ARRAY(arena, dmb_batch, counts->batch_count);
}

static void take_rest(dmb_arena *arena, const dmb_scene *counts, dmb_scene *to, writable *w, size_t stations)
{
    w->stations = DMB_ARENA_ARRAY(arena, dmb_hole_station, stations);
    to->sites = DMB_ARENA_ARRAY(arena, dmb_site, counts->site_count);
    to->path_sites = DMB_ARENA_ARRAY(arena, dmb_path_site, counts->path_site_count);
    to->drives = DMB_ARENA_ARRAY(arena, dmb_scene_drive, counts->drive_count);
    to->loads = DMB_ARENA_ARRAY(arena, dmb_scene_load, counts->load_count);
    to->bits = DMB_ARENA_ARRAY(arena, dmb_scene_bit, counts->bit_count);
    to->strings = DMB_ARENA_ARRAY(arena, dmb_string_map, counts->string_count);
    to->pipes = DMB_ARENA_ARRAY(arena, dmb_pipe_map, counts->pipe_count);
    to->bodies = DMB_ARENA_ARRAY(arena, dmb_body_map, counts->body_count);
}

/* The struct comes first, so that its address is that of the block. Its counts are copied, its arrays point behind it. */
static dmb_scene *lay_out(dmb_arena *arena, const dmb_scene *counts, writable *w, size_t stations)
{
    dmb_scene nowhere = *counts;
    dmb_scene *scene = DMB_ARENA_ARRAY(arena, dmb_scene, 1);
    dmb_scene *to = scene != NULL ? scene : &nowhere;
    *to = *counts;
    take_nodes(arena, counts, to, w);
    take_elements(arena, counts, to);
    take_rest(arena, counts, to, w, stations);
    return scene;
}

/* ---- Nodes ------------------------------------------------------------------------------------------------------- */

static int32_t fill_layout(const dmb_mesh *mesh, dmb_scene *scene, writable *w)
{
    dmb_block_totals totals;
    for (uint32_t i = 0; i < scene->node_count; ++i) w->size[i] = dmb_mesh_node_at(mesh, i)->size;
    if (dmb_block_count(scene->node_count, w->size, &totals) < 0) return DMB_ERR_TOO_LARGE;
    dmb_block_fill(scene->node_count, w->size, w->row, w->diag, w->link);
    scene->layout.n = scene->node_count;
    scene->layout.size = w->size;
    scene->layout.row = w->row;
    scene->layout.diag = w->diag;
    scene->layout.link = w->link;
    return DMB_OK;
}

static void fill_pose(const dmb_mesh *mesh, dmb_scene *scene, uint32_t i)
{
    const dmb_mesh_node *node = dmb_mesh_node_at(mesh, i);
    const dmb_environment_def *e = &mesh->model->environment;
    double *damping = scene->node_damping + 3 * (size_t)i;
    dmb_vec3_copy(node->position, scene->reference_position + 3 * (size_t)i);
    dmb_quat_copy(node->quaternion, scene->reference_quaternion + 4 * (size_t)i);
    scene->reference_depth[i] = node->depth;
    scene->weight_mass[i] = node->weight_mass;
    dmb_vec3_copy(node->weight_moment, scene->weight_moment + 3 * (size_t)i);
    if ((scene->features & DMB_FEATURE_DAMPING) == 0) return;
    dmb_vec3_set(e->axial_damping * node->damped_length, e->lateral_damping * node->damped_length,
                 e->torsional_damping * node->damped_length, damping);
}

/* Which rows are free, solved and held; held is the number of held rows so far. */
static void fill_rows(const dmb_mesh *mesh, dmb_scene *scene, uint32_t i, uint32_t *held)
{
    const dmb_mesh_node *node = dmb_mesh_node_at(mesh, i);
    const uint8_t open = free_rows(node), moved = prescribed_rows(node);
    const uint32_t first = scene->layout.row[i];
    for (uint32_t k = 0; k < node->size; ++k) {
        scene->free_row[first + k] = (uint8_t)(open >> k & 1);
        scene->solved_row[first + k] = (uint8_t)((open & ~moved) >> k & 1);
        if (scene->solved_row[first + k]) continue;
        scene->held_node[*held] = i;
        scene->held_component[*held] = k;
        ++*held;
    }
}

/* Velocity of the string as a rigid body at a FULL node: Ad(H)^-1 of the rig end's, H the node seen from it. PATH nodes
 * slide and turn on the axis as the rig end does, so that the string keeps its length on a curved axis too. */
static void string_velocity(const dmb_mesh *mesh, const dmb_mesh_node *node, double v[6])
{
    const dmb_string_map *map = dmb_mesh_string_at(mesh, node->string);
    const dmb_mesh_node *start = dmb_mesh_node_at(mesh, map->start_node);
    const double *given = dmb_mesh_string_def(mesh, node->string)->velocity;
    double q[4], R[9], x[3];
    dmb_vec6_copy(given, v);
    if (node->size == DMB_NODE_PATH) return;
    dmb_quat_between(start->quaternion, node->quaternion, q);
    dmb_quat_to_matrix(q, R);
    dmb_vec3_sub(node->position, start->position, x);
    dmb_quat_rotate_inverse(start->quaternion, x, x);
    x[0] -= map->start_arm; /* the rig end may stand behind the node that carries it */
    dmb_adjoint_inverse_apply(R, x, given, v);
}

static void fill_velocity(const dmb_mesh *mesh, dmb_scene *scene, uint32_t i)
{
    const dmb_mesh_node *node = dmb_mesh_node_at(mesh, i);
    double *row = scene->initial_velocity + scene->layout.row[i], v[6];
    if (node->string == UINT32_MAX) {
        dmb_vec6_copy(DMB_LIST_AT(const dmb_body_def, mesh->model->bodies, node->body)->velocity, row);
        return;
    }
    string_velocity(mesh, node, v);
    if (node->size == DMB_NODE_FULL) {
        dmb_vec6_copy(v, row);
        return;
    }
    row[0] = v[DMB_X];
    row[1] = v[DMB_RX];
}

/* Lumps were made string by string; here they go by node. */
static void fill_lumps(const dmb_mesh *mesh, dmb_scene *scene)
{
    dmb_lump *next = scene->lumps;
    for (uint32_t i = 0; i < scene->node_count; ++i) {
        const uint32_t lump = dmb_mesh_node_at(mesh, i)->lump;
        if (lump != UINT32_MAX) *next++ = *DMB_VECTOR_AT(dmb_lump, &mesh->lumps, lump);
    }
}

static void fill_chains(const dmb_mesh *mesh, dmb_scene *scene)
{
    uint32_t chain = 0;
    for (uint32_t i = 0; i < scene->node_count; i += scene->chains[chain++].count) {
        const dmb_mesh_node *node = dmb_mesh_node_at(mesh, i);
        scene->chains[chain].first = i;
        scene->chains[chain].count =
            node->string == UINT32_MAX ? 1 : dmb_mesh_string_at(mesh, node->string)->node_count;
    }
}

static void fill_nodes(const dmb_mesh *mesh, dmb_scene *scene)
{
    uint32_t held = 0;
    for (uint32_t i = 0; i < scene->node_count; ++i) {
        fill_pose(mesh, scene, i);
        fill_rows(mesh, scene, i, &held);
        fill_velocity(mesh, scene, i);
        scene->node_element[i] = UINT32_MAX;
    }
    fill_chains(mesh, scene);
    fill_lumps(mesh, scene);
}

/* ---- Elements and the rest --------------------------------------------------------------------------------------- */

static void copy_items(const dmb_vector *from, void *to)
{
    if (from->count > 0) memcpy(to, from->items, from->count * from->item_size);
}

static void fill_elements(const dmb_mesh *mesh, dmb_scene *scene)
{
    double length = 0.0;
    for (uint32_t e = 0; e < scene->element_count; ++e) {
        const dmb_mesh_element *element = dmb_mesh_element_at(mesh, e);
        scene->element_type[e] = element->type;
        scene->element_node[e] = element->node;
        scene->node_element[element->node] = e;
        dmb_vec3_copy(element->span, scene->element_span + 3 * (size_t)e);
        length += DMB_VECTOR_AT(dmb_element_type, &mesh->types, element->type)->length;
    }
    scene->length_scale = scene->element_count > 0 ? length / scene->element_count : 1.0;
    copy_items(&mesh->types, scene->types);
    copy_items(&mesh->batches, scene->batches);
}

static void fill_drives(const dmb_mesh *mesh, dmb_scene *scene)
{
    copy_items(&mesh->drives, scene->drives);
    for (uint32_t i = 0; i < scene->drive_count; ++i) {
        dmb_scene_drive *drive = scene->drives + i;
        const bool path = scene->layout.size[drive->node] == DMB_NODE_PATH;
        const uint32_t component = (uint32_t)drive->component;
        drive->row = scene->layout.row[drive->node] + (path ? component / (uint32_t)DMB_RX : component);
    }
}

static void fill_parts(const dmb_mesh *mesh, dmb_scene *scene)
{
    copy_items(&mesh->sites, scene->sites);
    copy_items(&mesh->path_sites, scene->path_sites);
    copy_items(&mesh->loads, scene->loads);
    copy_items(&mesh->bits, scene->bits);
    copy_items(&mesh->strings, scene->strings);
    copy_items(&mesh->pipes, scene->pipes);
    copy_items(&mesh->bodies, scene->bodies);
    scene->programmes = mesh->model->programmes.items; /* frozen with the model, which outlives the scene */
    for (uint32_t s = 0; s < scene->string_count; ++s) scene->length += scene->strings[s].length;
}

/* ---- Wall -------------------------------------------------------------------------------------------------------- */

static void fill_laws(const dmb_model *model, dmb_scene *scene)
{
    const dmb_wall_def *w = &model->wall;
    const bool contact = (scene->features & DMB_FEATURE_CONTACT) != 0;
    const bool friction = (scene->features & DMB_FEATURE_FRICTION) != 0;
    const dmb_friction_law law = {.kind = friction ? w->friction_law : DMB_FRICTION_NONE,
                                  .mu_static = w->mu_static,
                                  .mu_dynamic = w->mu_dynamic,
                                  .stribeck_speed = w->stribeck_speed,
                                  .smoothing_speed = w->smoothing_speed,
                                  .full_speed = w->full_speed,
                                  .bristle_stiffness = w->bristle_stiffness,
                                  .bristle_damping = w->bristle_damping};
    dmb_normal_law_setup(&scene->normal_law, contact ? w->normal_law : DMB_NORMAL_NONE, w->stiffness, w->exponent,
                         w->restitution, w->damping, w->impact_depth, w->approach_speed);
    scene->friction_law = law;
}

/* The hole keeps a pointer to its stations: from now on to the scene's own. */
static void fill_hole(const dmb_mesh *mesh, dmb_scene *scene, writable *w)
{
    scene->has_hole = mesh->has_hole;
    scene->hole = mesh->hole;
    if (mesh->hole.stations == 0) return;
    copy_items(&mesh->stations, w->stations);
    scene->hole.station = w->stations;
}

int32_t dmb_mesh_freeze(const dmb_mesh *mesh, dmb_scene **out)
{
    const dmb_allocator *allocator = &mesh->model->allocator;
    const size_t stations = mesh->hole.stations;
    dmb_scene counts = {.features = mesh->features, .mass = mesh->mass};
    dmb_arena arena;
    writable w;
    count_parts(mesh, &counts);
    if (counts.features & DMB_FEATURE_GRAVITY) dmb_vec3_copy(mesh->model->environment.gravity, counts.gravity);
    dmb_arena_count(&arena);
    (void)lay_out(&arena, &counts, &w, stations);
    counts.bytes = dmb_arena_block_size(&arena);
    if (arena.overflow) return DMB_ERR_TOO_LARGE;
    void *block = dmb_allocate(allocator, counts.bytes);
    if (block == NULL) return DMB_ERR_NO_MEMORY;
    dmb_arena_place(&arena, block, counts.bytes);
    dmb_scene *scene = lay_out(&arena, &counts, &w, stations);
    if (arena.overflow || fill_layout(mesh, scene, &w) < 0) {
        dmb_release(allocator, block, counts.bytes);
        return DMB_ERR_TOO_LARGE;
    }
    fill_nodes(mesh, scene);
    fill_elements(mesh, scene);
    fill_parts(mesh, scene);
    fill_drives(mesh, scene);
    fill_laws(mesh->model, scene);
    fill_hole(mesh, scene, &w);
    *out = scene;
    return DMB_OK;
}
