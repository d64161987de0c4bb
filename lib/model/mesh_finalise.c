/* The finished scene in one block: counts, then layout in two passes (counting, placing), then contents. */
#include "base/memory.h"
#include "force/hole.h"
#include "force/unilateral.h"
#include "math/vec3.h"
#include "model/field_check.h"
#include "model/mesh.h"
#include "model/scene.h"

/* ---- Counts ------------------------------------------------------------------------------------------------------ */

/* Rows are free (solved for), prescribed by a motion drive, or held by a support; the last two are the constrained
 * ones, whose residual is a reaction. */
static void count_rows(const dmb_mesh *mesh, dmb_scene *scene)
{
    for (uint32_t i = 0; i < mesh->nodes.count; ++i) {
        const dmb_mesh_node *node = dmb_mesh_node_at(mesh, i);
        const uint8_t open = dmb_free_rows(node), moved = dmb_prescribed_rows(node);
        scene->row_count += node->size;
        scene->rigid_count += node->rigid;
        for (uint32_t k = 0; k < node->size; ++k) {
            const uint32_t is_open = open >> k & 1, is_moved = moved >> k & 1;
            scene->free_count += is_open & ~is_moved;
            scene->prescribed_count += is_moved;
            scene->constrained_count += 1 - (is_open & ~is_moved);
        }
    }
}

static int moves(const double velocity[6])
{
    for (int k = 0; k < 6; ++k)
        if (velocity[k] != 0.0) return 1;
    return 0;
}

/* True if a string or a body is described in motion. */
static int starts_in_motion(const dmb_mesh *mesh)
{
    const dmb_model *model = mesh->model;
    for (uint32_t i = 0; i < mesh->strings.count; ++i)
        if (moves(dmb_mesh_string_def(mesh, i)->velocity)) return 1;
    for (uint32_t i = 0; i < model->bodies.count; ++i)
        if (moves(DMB_LIST_AT(const dmb_body_def, model->bodies, i)->velocity)) return 1;
    return 0;
}

/* Number of fixed joints as in a drawing: between neighbouring pipes, between a pipe and its tool joint, and between a
 * string and a body or bit fixed to it. */
static uint32_t structural_joints(const dmb_mesh *mesh)
{
    const dmb_model *model = mesh->model;
    uint32_t count = (uint32_t)(mesh->pipes.count - mesh->strings.count) + mesh->tool_joints + model->bits.count +
                     model->rings.count;
    for (uint32_t i = 0; i < model->bodies.count; ++i) {
        if (DMB_LIST_AT(const dmb_body_def, model->bodies, i)->attach != DMB_ATTACH_NONE) ++count;
    }
    return count;
}

/* True for a chain of one node without supports, motion drives and connections. */
static int is_free_rigid(const dmb_mesh *mesh, uint32_t i)
{
    const dmb_mesh_node *node = dmb_mesh_node_at(mesh, i);
    const int alone = node->string == DMB_NONE || dmb_mesh_string_at(mesh, node->string)->node_count == 1;
    return alone && node->size == DMB_NODE_SIX_DOF && node->rigid_mass != DMB_NONE &&
           dmb_free_rows(node) == DMB_SET_ALL && dmb_prescribed_rows(node) == 0;
}

/* None with joints anywhere: the projection onto constraints acts on velocities in body axes, while
 * eq:integration.free-rigid integrates those of the centre of mass in other axes. */
static uint32_t count_free_rigids(const dmb_mesh *mesh)
{
    uint32_t count = 0;
    if (mesh->clusters.count > 0) return 0;
    for (uint32_t i = 0; i < mesh->nodes.count; ++i) count += is_free_rigid(mesh, i) ? 1 : 0;
    return count;
}

/* Counts rows and storage of constraints and components from the ends of the last ones. */
static void count_constraints(const dmb_mesh *mesh, dmb_scene *scene)
{
    scene->joint_count = (uint32_t)mesh->joints.count;
    scene->coupling_count = (uint32_t)mesh->couplings.count;
    scene->callback_count = (uint32_t)mesh->callbacks.count;
    scene->law_count = (uint32_t)mesh->laws.count;
    scene->constraint_count = (uint32_t)mesh->constraints.count;
    scene->cluster_count = (uint32_t)mesh->clusters.count;
    scene->constraint_node_count = (uint32_t)mesh->cluster_nodes.count;
    if (scene->constraint_count == 0) return;
    const dmb_constraint *last = DMB_VECTOR_AT(dmb_constraint, &mesh->constraints, mesh->constraints.count - 1);
    const dmb_cluster *cluster = DMB_VECTOR_AT(dmb_cluster, &mesh->clusters, mesh->clusters.count - 1);
    scene->constraint_row_count = last->row + last->rows;
    scene->jacobian_count = last->jacobian + last->rows * last->columns;
    scene->tangent_count = last->tangent + last->columns * last->columns;
    scene->cluster_column_count = cluster->column + cluster->columns;
}

/* Number of stops of joints, springs, and springs of joints, numbered together if any of them may have a mean force. */
static uint32_t count_unilaterals(const dmb_mesh *mesh)
{
    int any = 0;
    for (uint32_t i = 0; i < mesh->laws.count; i++) {
        const dmb_joint_law *law = DMB_VECTOR_AT(dmb_joint_law, &mesh->laws, i);
        any |= dmb_stop_acts(law) || law->stiffness > 0.0;
    }
    for (uint32_t i = 0; i < mesh->springs.count; i++) {
        const dmb_spring_law *law = &DMB_VECTOR_AT(dmb_scene_spring, &mesh->springs, i)->law;
        any |= dmb_spring_can_open(law) || law->stiffness > 0.0;
    }
    return any ? (uint32_t)(2 * mesh->laws.count + mesh->springs.count) : 0;
}

static void count_inputs(const dmb_mesh *mesh, dmb_scene *scene)
{
    scene->input_count = (uint32_t)mesh->inputs.count;
    scene->event_count = (uint32_t)mesh->events.count;
    for (uint32_t i = 0; i < scene->input_count; ++i) {
        const int32_t target = DMB_VECTOR_AT(dmb_scene_input, &mesh->inputs, i)->target;
        if (target == DMB_TARGET_FLUID_DENSITY) scene->has_density_input = 1;
        if (target >= DMB_TARGET_LATERAL_DAMPING && target <= DMB_TARGET_TORSIONAL_DAMPING)
            scene->has_damping_input = 1;
        if (target == DMB_TARGET_FLOW_RATE) scene->has_flow_input = 1;
    }
}

static int32_t has_callback(const dmb_mesh *mesh)
{
    for (uint32_t i = 0; i < mesh->model->time_functions.count; ++i) {
        const dmb_time_function *time_function = (const dmb_time_function *)mesh->model->time_functions.items + i;
        for (uint32_t k = 0; k < time_function->count; ++k)
            if (time_function->segments[k].kind == DMB_SEGMENT_CALLBACK) return 1;
    }
    return mesh->forces.count > 0 || mesh->callbacks.count > 0 ||
           mesh->model->wall.friction_law == DMB_FRICTION_CALLBACK;
}

static void count_parts(const dmb_mesh *mesh, dmb_scene *scene)
{
    scene->node_count = (uint32_t)mesh->nodes.count;
    scene->element_count = (uint32_t)mesh->elements.count;
    scene->type_count = (uint32_t)mesh->types.count;
    scene->batch_count = (uint32_t)mesh->batches.count;
    scene->chain_count =
        (uint32_t)(mesh->nodes.count - mesh->elements.count); /* a chain has one node more than elements */
    scene->rigid_mass_count = (uint32_t)mesh->rigid_masses.count;
    scene->added_mass_count = (uint32_t)mesh->added_masses.count;
    scene->site_count = (uint32_t)mesh->sites.count;
    scene->inside_count = (uint32_t)mesh->inside.count;
    scene->axial_torsional_site_count = (uint32_t)mesh->axial_torsional_sites.count;
    scene->drive_count = (uint32_t)mesh->drives.count;
    scene->actuator_count = (uint32_t)mesh->actuators.count;
    scene->gain_table_count = (uint32_t)mesh->gain_tables.count;
    scene->delay_count = mesh->delays;
    scene->load_count = (uint32_t)mesh->loads.count;
    scene->bit_count = (uint32_t)mesh->bits.count;
    scene->load_point_count = (uint32_t)mesh->load_points.count;
    scene->force_count = (uint32_t)mesh->forces.count;
    scene->force_states = mesh->force_states;
    scene->stuck_count = (uint32_t)mesh->stuck.count;
    scene->flow_count = (uint32_t)mesh->flow_pieces.count;
    scene->spring_count = (uint32_t)mesh->springs.count;
    scene->unilateral_count = count_unilaterals(mesh);
    scene->spring_point_count = (uint32_t)mesh->spring_points.count;
    scene->time_function_count = mesh->model->time_functions.count;
    scene->has_callback = has_callback(mesh);
    scene->string_count = (uint32_t)mesh->strings.count;
    scene->pipe_count = (uint32_t)mesh->pipes.count;
    scene->body_count = (uint32_t)mesh->bodies.count; /* including bits and stabilisers */
    scene->ring_count = (uint32_t)mesh->rings.count;
    scene->history_count = mesh->history_count;
    scene->structural_joint_count = structural_joints(mesh);
    scene->free_rigid_count = count_free_rigids(mesh);
    scene->rotor_count = (uint32_t)mesh->rotors.count;
    count_rows(mesh, scene);
    scene->velocity_count = starts_in_motion(mesh) ? scene->row_count : 0;
    count_constraints(mesh, scene);
    count_inputs(mesh, scene);
}

/* ---- Layout of the block ----------------------------------------------------------------------------------------- */

static void allocate_nodes(dmb_arena *arena, const dmb_scene *counts, dmb_scene *to, dmb_scene_storage *w)
{
    const size_t n = counts->node_count, rows = counts->row_count, held = counts->constrained_count;
    w->size = DMB_ARENA_ARRAY(arena, uint8_t, n);
    w->row = DMB_ARENA_ARRAY(arena, uint32_t, n + 1);
    w->diag = DMB_ARENA_ARRAY(arena, uint32_t, n + 1);
    w->link = DMB_ARENA_ARRAY(arena, uint32_t, n);
    to->reference_position = DMB_ARENA_DOUBLES(arena, 3 * n);
    to->reference_quaternion = DMB_ARENA_DOUBLES(arena, 4 * n);
    to->reference_depth = DMB_ARENA_DOUBLES(arena, n);
    to->initial_velocity = DMB_ARENA_DOUBLES(arena, counts->velocity_count);
    to->free_row = DMB_ARENA_ARRAY(arena, uint8_t, rows);
    to->solved_row = DMB_ARENA_ARRAY(arena, uint8_t, rows);
    to->constrained_node = DMB_ARENA_ARRAY(arena, uint32_t, held);
    to->constrained_component = DMB_ARENA_ARRAY(arena, uint32_t, held);
    to->weight_mass = DMB_ARENA_DOUBLES(arena, n);
    to->weight_moment = DMB_ARENA_DOUBLES(arena, 3 * n);
    to->node_damping = DMB_ARENA_DOUBLES(arena, 5 * n);
    if (counts->has_density_input) to->displaced = DMB_ARENA_DOUBLES(arena, 2 * n);
    if (counts->has_damping_input) to->damped_length = DMB_ARENA_DOUBLES(arena, 3 * n);
    to->node_element = DMB_ARENA_ARRAY(arena, uint32_t, n);
    to->chains = DMB_ARENA_ARRAY(arena, dmb_chain, counts->chain_count);
    to->node_chain = DMB_ARENA_ARRAY(arena, uint32_t, n);
    to->rigid_masses = DMB_ARENA_ARRAY(arena, dmb_rigid_mass, counts->rigid_mass_count);
    if (counts->added_mass_count > 0)
        to->added_masses = DMB_ARENA_ARRAY(arena, dmb_added_mass, counts->added_mass_count);
    to->free_rigids = DMB_ARENA_ARRAY(arena, dmb_free_rigid, counts->free_rigid_count);
    if (counts->rotor_count > 0) to->rotors = DMB_ARENA_ARRAY(arena, dmb_scene_rotor, counts->rotor_count);
}

static void allocate_elements(dmb_arena *arena, const dmb_scene *counts, dmb_scene *to)
{
    const size_t e = counts->element_count;
    to->types = (dmb_element_type *)dmb_arena_allocate(arena, counts->type_count, sizeof *to->types, DMB_ALIGNMENT);
    to->element_type = DMB_ARENA_ARRAY(arena, uint32_t, e);
    to->element_node = DMB_ARENA_ARRAY(arena, uint32_t, e);
    to->element_span = DMB_ARENA_DOUBLES(arena, 3 * e);
    to->batches = DMB_ARENA_ARRAY(arena, dmb_batch, counts->batch_count);
}

static void allocate_rest(dmb_arena *arena, const dmb_scene *counts, dmb_scene *to, dmb_scene_storage *w,
                          const dmb_hole *hole)
{
    w->stations = DMB_ARENA_ARRAY(arena, dmb_hole_station, hole->stations);
    w->pieces = DMB_ARENA_ARRAY(arena, dmb_hole_piece, hole->pieces);
    to->sites = DMB_ARENA_ARRAY(arena, dmb_site, counts->site_count);
    to->axial_torsional_sites = DMB_ARENA_ARRAY(arena, dmb_axial_torsional_site, counts->axial_torsional_site_count);
    if (hole->stations > 0) to->near_contact = DMB_ARENA_ARRAY(arena, uint32_t, counts->node_count);
    if (counts->inside_count > 0) to->inside = DMB_ARENA_ARRAY(arena, dmb_scene_point, counts->inside_count);
    to->drives = DMB_ARENA_ARRAY(arena, dmb_scene_drive, counts->drive_count);
    if (counts->actuator_count > 0) to->actuators = DMB_ARENA_ARRAY(arena, dmb_actuator_law, counts->actuator_count);
    if (counts->gain_table_count > 0)
        to->gain_tables = DMB_ARENA_ARRAY(arena, dmb_gain_table, counts->gain_table_count);
    to->loads = DMB_ARENA_ARRAY(arena, dmb_scene_load, counts->load_count);
    to->bits = DMB_ARENA_ARRAY(arena, dmb_scene_bit, counts->bit_count);
    if (counts->input_count > 0) to->inputs = DMB_ARENA_ARRAY(arena, dmb_scene_input, counts->input_count);
    to->load_points = DMB_ARENA_ARRAY(arena, dmb_scene_point, counts->load_point_count);
    to->springs = DMB_ARENA_ARRAY(arena, dmb_scene_spring, counts->spring_count);
    to->forces = DMB_ARENA_ARRAY(arena, dmb_scene_force, counts->force_count);
    to->stuck = DMB_ARENA_ARRAY(arena, dmb_scene_stuck, counts->stuck_count);
    if (counts->flow_count > 0) {
        to->flow_pieces = DMB_ARENA_ARRAY(arena, dmb_flow_piece, counts->flow_count);
        to->flow_element = DMB_ARENA_DOUBLES(arena, counts->element_count);
        to->flow_node = DMB_ARENA_DOUBLES(arena, 2 * (size_t)counts->node_count);
    }
    to->spring_points = DMB_ARENA_ARRAY(arena, dmb_spring_point, counts->spring_point_count);
    if (counts->event_count > 0) to->events = DMB_ARENA_ARRAY(arena, dmb_scene_event, counts->event_count);
    to->strings = DMB_ARENA_ARRAY(arena, dmb_string_map, counts->string_count);
    to->pipes = DMB_ARENA_ARRAY(arena, dmb_pipe_map, counts->pipe_count);
    to->bodies = DMB_ARENA_ARRAY(arena, dmb_body_map, counts->body_count);
    if (counts->ring_count > 0) to->rings = DMB_ARENA_ARRAY(arena, dmb_ring_map, counts->ring_count);
}

/* No arrays, not even empty ones, without joints. */
static void allocate_joints(dmb_arena *arena, const dmb_scene *counts, dmb_scene *to)
{
    const size_t n = counts->node_count;
    if (counts->constraint_count == 0) return;
    to->joints = DMB_ARENA_ARRAY(arena, dmb_scene_joint, counts->joint_count);
    to->joint_drives = DMB_ARENA_ARRAY(arena, uint32_t, counts->drive_count);
    to->couplings = DMB_ARENA_ARRAY(arena, dmb_scene_coupling, counts->coupling_count);
    to->callbacks = DMB_ARENA_ARRAY(arena, dmb_scene_callback, counts->callback_count);
    to->laws = DMB_ARENA_ARRAY(arena, dmb_joint_law, counts->law_count);
    to->constraints = DMB_ARENA_ARRAY(arena, dmb_constraint, counts->constraint_count);
    to->clusters = DMB_ARENA_ARRAY(arena, dmb_cluster, counts->cluster_count);
    to->cluster_nodes = DMB_ARENA_ARRAY(arena, uint32_t, counts->constraint_node_count);
    to->cluster_columns = DMB_ARENA_ARRAY(arena, uint32_t, counts->cluster_column_count);
    to->node_block = DMB_ARENA_ARRAY(arena, uint32_t, n);
    to->node_place = DMB_ARENA_ARRAY(arena, uint32_t, n);
    to->node_cluster = DMB_ARENA_ARRAY(arena, uint32_t, n);
    to->off_diagonal_offset = DMB_ARENA_ARRAY(arena, size_t, 2 * n);
}

/* The struct is first, so that its address is that of the block. Its counts are copied, its arrays follow it. */
static dmb_scene *lay_out(dmb_arena *arena, const dmb_scene *counts, dmb_scene_storage *w, const dmb_hole *hole)
{
    dmb_scene nowhere = *counts;
    dmb_scene *scene = DMB_ARENA_ARRAY(arena, dmb_scene, 1);
    dmb_scene *to = scene != NULL ? scene : &nowhere;
    *to = *counts;
    allocate_nodes(arena, counts, to, w);
    allocate_elements(arena, counts, to);
    allocate_rest(arena, counts, to, w, hole);
    allocate_joints(arena, counts, to);
    return scene;
}

/* ---- Freeze ------------------------------------------------------------------------------------------------------ */

/* The same layout runs twice, on an arena that counts and on one that places: the size of the block cannot differ from
 * that of its contents. Only storage whose size follows from the finished scene (patterns, dense components) is
 * allocated after it. */
int32_t dmb_mesh_finalise(const dmb_mesh *mesh, dmb_scene **out)
{
    const dmb_allocator *allocator = &mesh->model->allocator;
    const dmb_hole *hole = &mesh->hole;
    dmb_scene counts = {.model = mesh->model,
                        .features = mesh->features,
                        .mass = mesh->mass,
                        .fluid_density = mesh->model->environment.fluid_density,
                        .inner_density = mesh->model->environment.inner_density};
    dmb_arena arena;
    dmb_scene_storage w;
    count_parts(mesh, &counts);
    if (counts.features & DMB_FEATURE_GRAVITY) dmb_vec3_copy(mesh->model->environment.gravity, counts.gravity);
    dmb_arena_count(&arena);
    (void)lay_out(&arena, &counts, &w, hole);
    counts.bytes = dmb_arena_block_size(&arena);
    void *block = dmb_allocate(allocator, counts.bytes);
    if (block == NULL) return DMB_ERR_NO_MEMORY;
    dmb_arena_place(&arena, block, counts.bytes);
    dmb_scene *scene = lay_out(&arena, &counts, &w, hole);
    int32_t status = dmb_scene_fill(mesh, scene, &w);
    if (status >= 0 && !dmb_scene_place_storage(scene->cluster_count, scene->clusters, scene))
        status = DMB_ERR_TOO_LARGE;
    if (status >= 0) status = dmb_scene_number_blocks(scene, allocator);
    if (status >= 0) status = dmb_scene_make_dense(scene, allocator);
    if (status < 0) {
        dmb_block_pattern_release(&scene->pattern, allocator);
        dmb_release(allocator, block, counts.bytes);
    } else {
        *out = scene;
    }
    return status;
}
