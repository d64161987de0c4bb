/* Compilation of a described model into a scene: the steps of dmb_model_compile in their order (table in mesh.h). A
 * failing step leaves the model as it was, with a message about the part that caused it. */
#include "model/mesh.h"

#include <math.h>

#include "base/memory.h"
#include "base/message.h"
#include "base/value_check.h"
#include "force/hole.h"
#include "model/describe.h"
#include "model/field_check.h"
#include "model/scene.h"

void dmb_mesh_init(dmb_mesh *mesh, dmb_model *model, const dmb_compile_options *options)
{
    const dmb_mesh empty = {
        .model = model,
        .options = *options,
        .stations = {.item_size = sizeof(dmb_hole_station)},
        .pieces = {.item_size = sizeof(dmb_hole_piece)},
        .run_order = {.item_size = sizeof(uint32_t)},
        .run_start = {.item_size = sizeof(uint32_t)},
        .nodes = {.item_size = sizeof(dmb_mesh_node)},
        .elements = {.item_size = sizeof(dmb_mesh_element)},
        .types = {.item_size = sizeof(dmb_element_type)},
        .batches = {.item_size = sizeof(dmb_batch)},
        .rigid_masses = {.item_size = sizeof(dmb_rigid_mass)},
        .added_masses = {.item_size = sizeof(dmb_added_mass)},
        .sites = {.item_size = sizeof(dmb_site)},
        .inside = {.item_size = sizeof(dmb_scene_point)},
        .axial_torsional_sites = {.item_size = sizeof(dmb_axial_torsional_site)},
        .drives = {.item_size = sizeof(dmb_scene_drive)},
        .actuators = {.item_size = sizeof(dmb_actuator_law)},
        .gain_tables = {.item_size = sizeof(dmb_gain_table)},
        .loads = {.item_size = sizeof(dmb_scene_load)},
        .bits = {.item_size = sizeof(dmb_scene_bit)},
        .load_points = {.item_size = sizeof(dmb_scene_point)},
        .springs = {.item_size = sizeof(dmb_scene_spring)},
        .spring_points = {.item_size = sizeof(dmb_spring_point)},
        .forces = {.item_size = sizeof(dmb_scene_force)},
        .stuck = {.item_size = sizeof(dmb_scene_stuck)},
        .flow_pieces = {.item_size = sizeof(dmb_flow_piece)},
        .inputs = {.item_size = sizeof(dmb_scene_input)},
        .events = {.item_size = sizeof(dmb_scene_event)},
        .joints = {.item_size = sizeof(dmb_scene_joint)},
        .rotors = {.item_size = sizeof(dmb_mesh_rotor)},
        .couplings = {.item_size = sizeof(dmb_scene_coupling)},
        .callbacks = {.item_size = sizeof(dmb_scene_callback)},
        .laws = {.item_size = sizeof(dmb_joint_law)},
        .driven = {.item_size = sizeof(uint8_t)},
        .constraints = {.item_size = sizeof(dmb_constraint)},
        .clusters = {.item_size = sizeof(dmb_cluster)},
        .cluster_nodes = {.item_size = sizeof(uint32_t)},
        .strings = {.item_size = sizeof(dmb_string_map)},
        .pipes = {.item_size = sizeof(dmb_pipe_map)},
        .bodies = {.item_size = sizeof(dmb_body_map)},
        .ring_order = {.item_size = sizeof(dmb_mesh_ring)},
        .divisions = {.item_size = sizeof(dmb_mesh_ring)},
        .rings = {.item_size = sizeof(dmb_ring_map)},
    };
    *mesh = empty;
}

void dmb_mesh_release(dmb_mesh *mesh)
{
    dmb_vector *const all[] = {&mesh->stations,
                               &mesh->pieces,
                               &mesh->run_order,
                               &mesh->run_start,
                               &mesh->nodes,
                               &mesh->elements,
                               &mesh->types,
                               &mesh->batches,
                               &mesh->rigid_masses,
                               &mesh->sites,
                               &mesh->axial_torsional_sites,
                               &mesh->drives,
                               &mesh->loads,
                               &mesh->actuators,
                               &mesh->bits,
                               &mesh->joints,
                               &mesh->couplings,
                               &mesh->callbacks,
                               &mesh->laws,
                               &mesh->driven,
                               &mesh->constraints,
                               &mesh->clusters,
                               &mesh->cluster_nodes,
                               &mesh->strings,
                               &mesh->pipes,
                               &mesh->bodies,
                               &mesh->inputs,
                               &mesh->load_points,
                               &mesh->springs,
                               &mesh->spring_points,
                               &mesh->events,
                               &mesh->forces,
                               &mesh->ring_order,
                               &mesh->divisions,
                               &mesh->rings,
                               &mesh->inside,
                               &mesh->stuck,
                               &mesh->flow_pieces,
                               &mesh->gain_tables,
                               &mesh->added_masses,
                               &mesh->rotors};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; ++i) dmb_vector_release(all[i], &mesh->model->allocator);
}

/* ---- Counting ---------------------------------------------------------------------------------------------------- */

/* Runs sorted by string with one pass to count and one to place; runs of a string keep their order. Counts are entered
 * two places behind their string, so that after summing start[s + 1] is where string s begins; placing moves it on to
 * the end of s, which is where s + 1 begins: in the end start[s] and start[s + 1] enclose the runs of s. */
static int32_t order_runs(dmb_mesh *mesh)
{
    const dmb_model *model = mesh->model;
    const uint32_t strings = model->strings.count, runs = model->runs.count;
    int32_t status = dmb_vector_append(&mesh->run_start, &model->allocator, NULL, (size_t)strings + 2);
    if (status >= 0) status = dmb_vector_append(&mesh->run_order, &model->allocator, NULL, runs);
    if (status < 0) return status;
    uint32_t *start = mesh->run_start.items, *order = mesh->run_order.items;
    for (uint32_t i = 0; i < runs; ++i) ++start[dmb_mesh_run_at(mesh, i)->string + 2];
    for (uint32_t s = 2; s < strings + 2; ++s) start[s] += start[s - 1];
    for (uint32_t i = 0; i < runs; ++i) order[start[dmb_mesh_run_at(mesh, i)->string + 1]++] = i;
    return DMB_OK;
}

static uint64_t elements_of(const dmb_mesh *mesh, const dmb_pipe_run *run)
{
    return dmb_mesh_kind(mesh, run) == DMB_PIPE_RIGID ? 0 : (uint64_t)run->count * run->def.elements;
}

/* Upper bound of the points at which forces divide elements. */
static uint64_t points_of(const dmb_model *model)
{
    uint64_t count = (uint64_t)model->loads.count + model->stuck.count + 2 * (uint64_t)model->springs.count;
    for (uint32_t i = 0; i < model->forces.count; ++i)
        count += DMB_LIST_AT(const dmb_force_def, model->forces, i)->place_count;
    return count;
}

/* Upper bounds of nodes and elements: each string has one node more than elements, each free body one node, each
 * stabiliser and each point of a force at most one. They are reserved at once: lists that grew by halves would need two
 * and a half times the memory of a long string while they are copied. Too many fail here, before any is made. */
int32_t dmb_mesh_count(dmb_mesh *mesh)
{
    const dmb_model *model = mesh->model;
    uint64_t elements = 0, pipes = 0;
    int32_t status = order_runs(mesh);
    for (uint32_t i = 0; i < model->runs.count; ++i) {
        elements += elements_of(mesh, dmb_mesh_run_at(mesh, i)); /* 2^24 runs of 2^30 at most */
        pipes += dmb_mesh_run_at(mesh, i)->count;
    }
    elements += model->rings.count + points_of(model);
    const uint64_t nodes = elements + model->strings.count + model->bodies.count;
    if (status >= 0 && (nodes > (uint64_t)DMB_NODES_MAX || pipes > (uint64_t)DMB_NODES_MAX)) {
        dmb_message_set(&mesh->model->message, "model: nodes = %zu and pipes = %zu, must be <= %u each", (size_t)nodes,
                        (size_t)pipes, (uint32_t)DMB_NODES_MAX);
        return DMB_ERR_TOO_LARGE;
    }
    if (status >= 0) status = dmb_vector_reserve(&mesh->nodes, &model->allocator, (size_t)nodes);
    if (status >= 0) status = dmb_vector_reserve(&mesh->elements, &model->allocator, (size_t)elements);
    if (status >= 0) status = dmb_vector_reserve(&mesh->pipes, &model->allocator, (size_t)pipes);
    return status;
}

/* ---- Features of a scene: those requested by the options and present in the description ---- */

static bool has_gravity(const dmb_model *model)
{
    const double *g = model->environment.gravity;
    return fabs(g[0]) > 0.0 || fabs(g[1]) > 0.0 || fabs(g[2]) > 0.0;
}

static bool has_contact(const dmb_model *model)
{
    return model->wall_count > 0 && model->wall.normal_law != DMB_NORMAL_NONE;
}

static bool has_eccentricity(const dmb_model *model)
{
    for (uint32_t i = 0; i < model->runs.count; ++i) {
        if (dmb_pipe_is_eccentric(&DMB_LIST_AT(const dmb_pipe_run, model->runs, i)->def)) return true;
    }
    return false;
}

static bool has_excitation(const dmb_model *model)
{
    for (uint32_t i = 0; i < model->drives.count; ++i) {
        if (!dmb_id_is_none(DMB_LIST_AT(const dmb_drive_def, model->drives, i)->excitation)) return true;
    }
    return false;
}

static bool has_rock(const dmb_model *model)
{
    for (uint32_t i = 0; i < model->bits.count; ++i) {
        if (DMB_LIST_AT(const dmb_bit_def, model->bits, i)->rock_law != DMB_ROCK_NONE ||
            DMB_LIST_AT(const dmb_bit_def, model->bits, i)->side_cutting > 0.0)
            return true;
    }
    return false;
}

static bool has_damping(const dmb_mesh *mesh)
{
    const dmb_model *model = mesh->model;
    const dmb_environment_def *e = &model->environment;
    if (e->axial_damping > 0.0 || e->lateral_damping > 0.0 || e->torsional_damping > 0.0) return true;
    for (uint32_t i = 0; i < model->inputs.count; ++i) {
        const int32_t target = DMB_LIST_AT(const dmb_input_def, model->inputs, i)->target;
        if (target >= DMB_TARGET_LATERAL_DAMPING && target <= DMB_TARGET_TORSIONAL_DAMPING) return true;
    }
    for (uint32_t i = 0; i < model->runs.count; ++i) {
        const dmb_pipe_run *run = dmb_mesh_run_at(mesh, i);
        if (run->def.damping_time > 0.0 && dmb_mesh_kind(mesh, run) != DMB_PIPE_RIGID) return true;
    }
    return false;
}

/* A feature that the description does not use is switched off, so that a step does not test for it and its arrays do
 * not exist. Friction needs contact; damping also counts if an input may bring it. */
int32_t dmb_mesh_features(const dmb_mesh *mesh)
{
    const dmb_model *model = mesh->model;
    const bool contact = has_contact(model) && (mesh->options.features & DMB_FEATURE_CONTACT) != 0;
    int32_t described = contact ? DMB_FEATURE_CONTACT : 0;
    if (has_gravity(model)) described |= DMB_FEATURE_GRAVITY;
    if (contact && model->wall.friction_law != DMB_FRICTION_NONE) described |= DMB_FEATURE_FRICTION;
    if (has_eccentricity(model)) described |= DMB_FEATURE_ECCENTRICITY;
    if (has_excitation(model)) described |= DMB_FEATURE_EXCITATION;
    if (has_rock(model)) described |= DMB_FEATURE_ROCK;
    if (has_damping(mesh)) described |= DMB_FEATURE_DAMPING;
    return described & mesh->options.features;
}

/* ---- Compile ----------------------------------------------------------------------------------------------------- */

/* dmb_model_compile: from the description to the scene of a step. */

static int32_t read_options(dmb_model *model, const dmb_compile_options *given, dmb_compile_options *read)
{
    dmb_check check = dmb_check_of(&model->message, "compile options", DMB_NONE);
    *read = dmb_compile_options_default();
    if (given != NULL) {
        const int32_t status = dmb_compile_options_read(read, given);
        if (status < 0) return status;
    }
    dmb_check_fields(&check, model, DMB_FIELDS_OF(dmb_compile_options), read);
    return check.status;
}

/* The order of the steps is that of their data (table in mesh.h). Each of them checks what it reads: the first part
 * that is wrong ends compilation with its message. */
static int32_t make_scene(dmb_mesh *mesh, dmb_scene **scene)
{
    static int32_t (*const steps[])(dmb_mesh *) = {
        dmb_mesh_hole,    dmb_mesh_count,       dmb_mesh_check,  dmb_mesh_ring_places, dmb_mesh_divisions,
        dmb_mesh_strings, dmb_mesh_bodies,      dmb_mesh_rings,  dmb_mesh_poses,       dmb_mesh_depths,
        dmb_mesh_types,   dmb_mesh_masses,      dmb_mesh_sites,  dmb_mesh_joints,      dmb_mesh_actions,
        dmb_mesh_forces,  dmb_mesh_constraints, dmb_mesh_inputs, dmb_mesh_flow,        dmb_mesh_rotors,
    };
    int32_t status = DMB_OK;
    mesh->features = dmb_mesh_features(mesh);
    for (size_t i = 0; i < sizeof steps / sizeof steps[0] && status >= 0; ++i) status = steps[i](mesh);
    if (status < 0) return status;
    return dmb_mesh_finalise(mesh, scene);
}

typedef uint32_t (*dmb_warning)(const dmb_scene *scene, uint32_t from, dmb_message *text);

/* Writes each warning to the log, and the first also into the message. */
static void warn(dmb_model *model, const dmb_scene *scene)
{
    static const dmb_warning warnings[] = {dmb_supported_site, dmb_followed_input};
    const dmb_log log = {model->log, model->log_context};
    const dmb_message counts = model->message;
    dmb_message text;
    int first = 1;
    for (size_t k = 0; k < sizeof warnings / sizeof warnings[0]; ++k)
        for (uint32_t i = warnings[k](scene, 0, &text); i != DMB_NONE; i = warnings[k](scene, i + 1, &text)) {
            dmb_log_text(&log, DMB_LOG_WARNING, text.text);
            if (first) dmb_message_set(&model->message, "warning: %s; %s", text.text, counts.text);
            first = 0;
        }
}

static void tell(dmb_model *model, const dmb_scene *scene)
{
    const dmb_log log = {model->log, model->log_context};
    dmb_message joints;
    dmb_message_clear(&joints);
    if (scene->cluster_count > 0) {
        dmb_message_set(&joints, "%u joints, %u constraints in %u clusters, ", scene->joint_count,
                        scene->constraint_count, scene->cluster_count);
    }
    dmb_message_set(
        &model->message, "compiled: %u nodes, %u elements, %u contact points, %s%u degrees_of_freedom, %zu bytes",
        scene->node_count, scene->element_count, scene->site_count, joints.text, scene->free_count, scene->bytes);
    dmb_log_text(&log, DMB_LOG_INFO, model->message.text);
}

/* The description is unchanged after an error. Drives with a constant value get time functions behind those of the
 * description; they exist during compilation only and are dropped either way, because the scene has its own copies. */
int32_t dmb_model_compile(dmb_model *model, const dmb_compile_options *options)
{
    dmb_compile_options read;
    dmb_scene *scene = NULL;
    dmb_mesh mesh;
    int32_t status = dmb_describe_open(model, "compile", model);
    if (status < 0) return status;
    status = dmb_refused_check(&model->refused, &model->message);
    if (status >= 0) status = read_options(model, options, &read);
    if (status >= 0) {
        const uint32_t described = model->time_functions.count;
        dmb_mesh_init(&mesh, model, &read);
        status = make_scene(&mesh, &scene);
        dmb_mesh_release(&mesh);
        if (status < 0) dmb_model_drop_time_functions(model, described);
        model->constants = model->time_functions.count - described;
        model->time_functions.count = described; /* the scene alone has the constants */
    }
    if (status < 0) return dmb_describe_close(model, "compile", status);
    tell(model, scene);
    warn(model, scene);
    model->scene = scene;
    return dmb_describe_close(model, "compile", DMB_OK);
}
