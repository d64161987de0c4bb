/* Strings and bodies as nodes and elements: types of elements, their kernels, batches of neighbours with one kernel. A
 * string is a chain of nodes:
 *
 *     flexible, axial-torsional pipe   one node more than elements, shared with the pipe before
 *     rigid pipes in a row             one node, to which all of them are fixed at arms along its axis
 *     tool joint                       rigid arm and mass of the last element's far node
 *     fixed body, bit, stabiliser      fixed to a node at an arm */
#include <math.h>
#include <string.h>

#include "model/field_check.h"
#include "model/mesh.h"
#include "model/model.h"
#include "model/section.h"

/* Equal elements are mostly near each other: a run of pipes has four types at most. */
enum { RECENT_TYPES = 8, NUMBERS = sizeof(dmb_element_type) / sizeof(double) };

/* True for equal types, which contain numbers only. */
static bool same_type(const dmb_element_type *a, const dmb_element_type *b)
{
    return dmb_same_numbers((const double *)(const void *)a, (const double *)(const void *)b, NUMBERS);
}

/* Index of an equal type among the latest, or of a new one. */
static int32_t shared_type(dmb_mesh *mesh, const dmb_element_type *type, uint32_t *index)
{
    const size_t count = mesh->types.count;
    for (size_t i = count; i > 0 && i + RECENT_TYPES > count; --i) {
        if (!same_type(DMB_VECTOR_AT(const dmb_element_type, &mesh->types, i - 1), type)) continue;
        *index = (uint32_t)(i - 1);
        return DMB_OK;
    }
    *index = (uint32_t)count;
    return dmb_vector_append(&mesh->types, &mesh->model->allocator, type, 1);
}

static bool alike(const dmb_mesh_element *a, const dmb_mesh_element *b)
{
    return a->run == b->run && dmb_same_numbers(a->arm, b->arm, 2) && dmb_same_numbers(&a->length, &b->length, 1);
}

int32_t dmb_mesh_check_mud(const dmb_mesh *mesh, const dmb_pipe_def *def)
{
    const dmb_model *model = mesh->model;
    const double added = model->environment.added_mass, hole = model->wall.diameter;
    if (added < 0.0 && (model->wall_count == 0 || !(hole > fmax(def->outer_diameter, dmb_joint_diameter(def))))) {
        dmb_message_set(&mesh->model->message,
                        "environment: added_mass = -1, must be with a wall whose diameter is above that of the pipes, "
                        "%g m here; add one, or give the coefficient",
                        fmax(def->outer_diameter, dmb_joint_diameter(def)));
        return DMB_ERR_VALUE;
    }
    return DMB_OK;
}

/* Adds the transverse added mass of mud. */
static int32_t add_mud(const dmb_mesh *mesh, const dmb_pipe_def *def, const dmb_mud *mud, dmb_element_type *type)
{
    const double added = mesh->model->environment.added_mass, hole = mesh->model->wall.diameter;
    if (!(added > 0.0 || added < 0.0)) return DMB_OK;
    const int32_t status = dmb_mesh_check_mud(mesh, def);
    if (status >= 0) dmb_element_add_sideways(def, dmb_mud_inertia(def, mud, added, hole), type);
    return status;
}

/* Elements of equal run, length and arms share the constants of the element before. Weight and displacement of the mud
 * are per element; the added mass of mud acts across only. */
static int32_t find_type(dmb_mesh *mesh, dmb_mesh_element *element, const dmb_mesh_element *before)
{
    const dmb_pipe_def *def = &dmb_mesh_run_at(mesh, element->run)->def;
    dmb_element_type type;
    if (before != NULL && before->curved == element->curved && alike(element, before)) {
        element->type = before->type;
        return DMB_OK;
    }
    const double damping_time = mesh->features & DMB_FEATURE_DAMPING ? def->damping_time : 0.0;
    dmb_element_type_along(def, element->length, element->arm, damping_time, &type);
    const dmb_environment_def *e = &mesh->model->environment;
    const dmb_mud mud = {e->fluid_density, e->inner_density};
    type.weight_mass = dmb_buoyancy_factor(def, 0, &mud) * type.mass_per_metre * type.length;
    type.displaced = type.mass_per_metre * type.length / def->density;
    if (!(mud.inside < 0.0)) type.displaced += dmb_inner_area(def, 0) * type.length;
    const int32_t status = add_mud(mesh, def, &mud, &type);
    if (status < 0) return status;
    if (element->curved) dmb_element_make_curved(def, &type);
    return shared_type(mesh, &type, &element->type);
}

static int32_t kernel_of(const dmb_mesh *mesh, const dmb_mesh_element *element)
{
    const bool a = dmb_mesh_node_at(mesh, element->node)->size == DMB_NODE_SIX_DOF;
    const bool b = dmb_mesh_node_at(mesh, element->node + 1)->size == DMB_NODE_SIX_DOF;
    if (a && b) return DMB_KERNEL_BEAM;
    return a || b ? DMB_KERNEL_MIXED : DMB_KERNEL_AXIAL_TORSIONAL;
}

/* Adds an element to its batch; a new batch starts if the kernel or the kind of mass changes, or at the end of a chain.
 */
static int32_t add_to_batch(dmb_mesh *mesh, uint32_t e)
{
    const dmb_mesh_element *element = dmb_mesh_element_at(mesh, e);
    if (e > 0 && element[-1].kernel == element->kernel && element[-1].curved == element->curved &&
        element[-1].node + 1 == element->node) {
        ++DMB_VECTOR_AT(dmb_batch, &mesh->batches, mesh->batches.count - 1)->count;
        return DMB_OK;
    }
    const dmb_batch batch = {e, 1, element->kernel, element->curved};
    return dmb_vector_append(&mesh->batches, &mesh->model->allocator, &batch, 1);
}

int32_t dmb_mesh_types(dmb_mesh *mesh)
{
    int32_t status = DMB_OK;
    for (uint32_t e = 0; e < mesh->elements.count && status >= 0; ++e) {
        dmb_mesh_element *element = dmb_mesh_element_at(mesh, e);
        element->kernel = kernel_of(mesh, element);
        element->curved = element->kernel != DMB_KERNEL_AXIAL_TORSIONAL && dmb_mesh_is_curved(mesh, element);
        status = find_type(mesh, element, e > 0 ? element - 1 : NULL);
        if (status >= 0) status = add_to_batch(mesh, e);
    }
    return status;
}

/* ---- Strings ----
 *
 * A string is divided from its rig end on into stretches of rigid pipes, each one body with one node, and runs of
 * elastic pipes, in which every element adds a node. */

typedef struct string_iterator {
    dmb_mesh *mesh;
    dmb_string_map *map;
    uint32_t string;
    uint32_t place, end; /* in run_order */
    uint32_t node;       /* last node; DMB_NONE: none yet */
    double at;           /* [m] from the rig end */
    double arm;          /* [m] from the last node to here along its x axis */
} string_iterator;

static const dmb_pipe_run *run_at(const string_iterator *iterator, uint32_t place)
{
    return dmb_mesh_run_at(iterator->mesh, *DMB_VECTOR_AT(uint32_t, &iterator->mesh->run_order, place));
}

/* Adds a node, for which the counting step has reserved memory. */
static uint32_t push_node(string_iterator *iterator, uint8_t size, double at)
{
    const dmb_mesh_node node = {.at = at,
                                .string = iterator->string,
                                .rigid_mass = DMB_NONE,
                                .added_mass = DMB_NONE,
                                .size = size,
                                .free = DMB_SET_ALL};
    (void)dmb_vector_append(&iterator->mesh->nodes, &iterator->mesh->model->allocator, &node, 1);
    return (uint32_t)iterator->mesh->nodes.count - 1;
}

static void push_element(string_iterator *iterator, uint32_t run, double length, double far_arm)
{
    const dmb_mesh_element element = {
        .arm = {iterator->arm, far_arm}, .length = length, .node = iterator->node, .run = run};
    (void)dmb_vector_append(&iterator->mesh->elements, &iterator->mesh->model->allocator, &element, 1);
    iterator->arm = 0.0;
}

static void push_pipe(string_iterator *iterator, const dmb_pipe_run *run, double start, uint32_t node, uint32_t element)
{
    const bool rigid = element == DMB_NONE;
    const dmb_pipe_map pipe = {.start = start,
                               .length = run->def.length,
                               .joint = run->def.joint_length,
                               .node = node,
                               .element = element,
                               .elements = rigid ? 0 : run->def.elements,
                               .kind = dmb_mesh_kind(iterator->mesh, run)};
    (void)dmb_vector_append(&iterator->mesh->pipes, &iterator->mesh->model->allocator, &pipe, 1);
    if (run->def.joint_length > 0.0) ++iterator->mesh->tool_joints;
}

/* ---- Elastic pipes ----------------------------------------------------------------------------------------------- */

/* A pipe in the walk. */
typedef struct pipe_iterator {
    double near; /* [m] from the rig end to the pipe's near end */
    uint32_t run, number;
    uint8_t size; /* of its nodes */
} pipe_iterator;

/* Adds nodes of stabilisers and forces inside one of the pipe's equal elements, from `from` to `to` [m] of the pipe.
 * Returns the position of the last node before `to`. */
static double divide(string_iterator *iterator, const pipe_iterator *pipe, double from, double to,
                     dmb_ring_range *places)
{
    const double reach = dmb_ring_reach(&dmb_mesh_run_at(iterator->mesh, pipe->run)->def);
    for (; places->count > 0 && places->first->along < to; ++places->first, --places->count) {
        const double at = places->first->along;
        if (at - from <= reach || to - at <= reach) continue;
        push_element(iterator, pipe->run, at - from, 0.0);
        iterator->node = push_node(iterator, pipe->size, pipe->near + at);
        from = at;
    }
    return from;
}

/* Equal elements, divided at stabilisers and forces with nodes of their own; the tool joint is the far arm of the last
 * one. */
static void mesh_pipe(string_iterator *iterator, const pipe_iterator *pipe)
{
    const dmb_pipe_def *def = &dmb_mesh_run_at(iterator->mesh, pipe->run)->def;
    const double length = (def->length - def->joint_length) / def->elements;
    dmb_ring_range places = dmb_mesh_divisions_of(iterator->mesh, iterator->string, pipe->number);
    for (uint32_t e = 1; e <= def->elements; ++e) {
        const bool last = e == def->elements;
        const double start = (e - 1) * length, end = e * length;
        const double from = places.count > 0 ? divide(iterator, pipe, start, end, &places) : start;
        push_element(iterator, pipe->run, from > start ? end - from : length, last ? def->joint_length : 0.0);
        iterator->node = push_node(iterator, pipe->size, last ? pipe->near + def->length : pipe->near + e * length);
    }
}

/* The map was pushed with the described number of elements; stabilisers and forces have increased it. */
static void mesh_and_count(string_iterator *iterator, const pipe_iterator *pipe)
{
    const uint32_t before = (uint32_t)iterator->mesh->elements.count;
    mesh_pipe(iterator, pipe);
    dmb_pipe_map *map = dmb_mesh_pipe_at(iterator->mesh, (uint32_t)iterator->mesh->pipes.count - 1);
    const uint32_t elements = (uint32_t)iterator->mesh->elements.count - before;
    map->divided = elements != map->elements;
    map->elements = elements;
}

/* A node is axial-torsional if all its elements are. */
static void mesh_elastic_run(string_iterator *iterator, uint32_t run_index)
{
    const dmb_pipe_run *run = dmb_mesh_run_at(iterator->mesh, run_index);
    const bool path = dmb_mesh_kind(iterator->mesh, run) == DMB_PIPE_AXIAL_TORSIONAL;
    const uint8_t size = path ? DMB_NODE_AXIAL_TORSIONAL : DMB_NODE_SIX_DOF;
    if (iterator->node == DMB_NONE) {
        iterator->node = push_node(iterator, size, 0.0);
        iterator->map->start_node = iterator->node;
    } else if (!path) {
        dmb_mesh_node_at(iterator->mesh, iterator->node)->size = DMB_NODE_SIX_DOF;
    }
    for (uint32_t i = 0; i < run->count; ++i) {
        push_pipe(iterator, run, 0.0, iterator->node, (uint32_t)iterator->mesh->elements.count);
        const pipe_iterator pipe = {iterator->at + i * run->def.length, run_index, run->first + i, size};
        mesh_and_count(iterator, &pipe);
    }
    iterator->at += run->count * run->def.length;
}

/* ---- Rigid pipes ------------------------------------------------------------------------------------------------- */

/* True if the support or a drive at the rig end acts on components that differ along the body's axis. */
static bool start_is_pinned(const string_iterator *iterator)
{
    const dmb_model *model = iterator->mesh->model;
    if (!dmb_set_is_axial(dmb_free_set(dmb_mesh_string_def(iterator->mesh, iterator->string)->start_free))) return true;
    for (uint32_t i = 0; i < model->drives.count; ++i) {
        const dmb_drive_def *drive = DMB_LIST_AT(const dmb_drive_def, model->drives, i);
        const bool on_body = dmb_model_part_index(model, drive->part, DMB_PART_BODY) != DMB_NONE;
        if (on_body || dmb_mesh_string_of(iterator->mesh, drive->part) != iterator->string) continue;
        if (drive->component != DMB_X && drive->component != DMB_RX) return true;
    }
    return false;
}

static bool end_is_pinned(const string_iterator *iterator)
{
    return !dmb_set_is_axial(dmb_free_set(dmb_mesh_string_def(iterator->mesh, iterator->string)->end_free));
}

/* Position of the node of a stretch of rigid pipes: at a pinned end, because supports act at nodes; otherwise at the
 * end where neighbouring elements need no arms, or the near end. */
static int32_t choose_near_end(const string_iterator *iterator, uint32_t next, bool *near)
{
    const bool first = iterator->node == DMB_NONE, last = next == iterator->end;
    const bool hold_start = first && start_is_pinned(iterator), hold_end = last && end_is_pinned(iterator);
    dmb_message string;
    *near = hold_start || (last && !hold_end);
    if (!hold_start || !hold_end) return DMB_OK;
    dmb_message_set(&iterator->mesh->model->message,
                    "%s: start_free (or a drive) and end_free hold both ends of one rigid body at points, must "
                    "be one of them",
                    dmb_model_part_text(iterator->mesh->model, DMB_PART_STRING, iterator->string, &string));
    return DMB_ERR_UNSUPPORTED;
}

/* Places the node at the near or the far end of the stretch; an existing node moves. */
static void place_rigid_node(string_iterator *iterator, double length, bool near)
{
    const double ahead = near ? 0.0 : length;
    if (iterator->node == DMB_NONE) {
        iterator->node = push_node(iterator, DMB_NODE_SIX_DOF, ahead);
        iterator->map->start_node = iterator->node;
        iterator->map->start_arm = 0.0 - ahead;
    } else {
        dmb_mesh_node *node = dmb_mesh_node_at(iterator->mesh, iterator->node);
        node->size = DMB_NODE_SIX_DOF;
        node->at = iterator->at + ahead;
        dmb_mesh_element_at(iterator->mesh, (uint32_t)iterator->mesh->elements.count - 1)->arm[1] += ahead;
    }
    dmb_mesh_node_at(iterator->mesh, iterator->node)->rigid = 1;
    iterator->arm = length - ahead;
}

/* Runs [place, next) are rigid and form one body. */
static int32_t mesh_rigid_stretch(string_iterator *iterator, uint32_t next)
{
    double length = 0.0, start;
    bool near;
    int32_t status = choose_near_end(iterator, next, &near);
    if (status < 0) return status;
    for (uint32_t i = iterator->place; i < next; ++i)
        length += run_at(iterator, i)->count * run_at(iterator, i)->def.length;
    place_rigid_node(iterator, length, near);
    start = iterator->arm - length;
    for (uint32_t i = iterator->place; i < next; ++i) {
        const dmb_pipe_run *run = run_at(iterator, i);
        for (uint32_t k = 0; k < run->count; ++k) {
            push_pipe(iterator, run, start + k * run->def.length, iterator->node, DMB_NONE);
        }
        start += run->count * run->def.length;
    }
    iterator->at += length;
    return DMB_OK;
}

/* ---- Strings ----------------------------------------------------------------------------------------------------- */

static bool is_rigid(const string_iterator *iterator, uint32_t place)
{
    return dmb_mesh_kind(iterator->mesh, run_at(iterator, place)) == DMB_PIPE_RIGID;
}

static int32_t mesh_pieces(string_iterator *iterator)
{
    while (iterator->place < iterator->end) {
        uint32_t next = iterator->place;
        while (next < iterator->end && is_rigid(iterator, next)) ++next;
        if (next > iterator->place) {
            const int32_t status = mesh_rigid_stretch(iterator, next);
            if (status < 0) return status;
        } else {
            mesh_elastic_run(iterator, *DMB_VECTOR_AT(uint32_t, &iterator->mesh->run_order, next));
            ++next;
        }
        iterator->place = next;
    }
    return DMB_OK;
}

static int32_t mesh_string(dmb_mesh *mesh, uint32_t string)
{
    const dmb_string_def *def = dmb_mesh_string_def(mesh, string);
    dmb_string_map *map = dmb_mesh_string_at(mesh, string);
    string_iterator iterator = {.mesh = mesh, .map = map, .string = string, .node = DMB_NONE};
    int32_t status;
    iterator.place = *DMB_VECTOR_AT(uint32_t, &mesh->run_start, string);
    iterator.end = *DMB_VECTOR_AT(uint32_t, &mesh->run_start, string + 1u);
    map->first_pipe = (uint32_t)mesh->pipes.count;
    map->first_node = (uint32_t)mesh->nodes.count;
    status = mesh_pieces(&iterator);
    if (status < 0) return status;
    map->pipe_count = (uint32_t)mesh->pipes.count - map->first_pipe;
    map->node_count = (uint32_t)mesh->nodes.count - map->first_node;
    map->end_node = iterator.node;
    map->end_arm = iterator.arm;
    map->length = iterator.at;
    dmb_mesh_node_at(mesh, map->start_node)->free &= dmb_free_set(def->start_free);
    dmb_mesh_node_at(mesh, map->end_node)->free &= dmb_free_set(def->end_free);
    return DMB_OK;
}

int32_t dmb_mesh_strings(dmb_mesh *mesh)
{
    const uint32_t count = mesh->model->strings.count;
    int32_t status = dmb_vector_append(&mesh->strings, &mesh->model->allocator, NULL, count);
    for (uint32_t s = 0; s < count && status >= 0; ++s) status = mesh_string(mesh, s);
    return status;
}

/* ---- Bodies: nodes of free bodies, and the nodes that bodies and bits are fixed to ---- */

static uint32_t push_free_body(dmb_mesh *mesh, uint32_t body, const dmb_body_def *def)
{
    const dmb_mesh_node node = {.string = DMB_NONE,
                                .body = body,
                                .rigid_mass = DMB_NONE,
                                .added_mass = DMB_NONE,
                                .size = DMB_NODE_SIX_DOF,
                                .free = dmb_free_set(def->free_mask),
                                .rigid = 1};
    (void)dmb_vector_append(&mesh->nodes, &mesh->model->allocator, &node, 1); /* room was reserved */
    return (uint32_t)mesh->nodes.count - 1;
}

static dmb_body_map map_of(dmb_mesh *mesh, uint32_t body, const dmb_body_def *def)
{
    dmb_body_map map = {0, DMB_NONE, 0.0, 0, 0, ""};
    memcpy(map.name, def->name, sizeof map.name);
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

/* A bit's reference point is the string's end; its centre is half its length beyond. Reamers are placed later, with
 * their stabilisers (mesh_stabiliser). */
static dmb_body_map bit_map_of(const dmb_mesh *mesh, const dmb_bit_def *def)
{
    const dmb_string_map *string =
        dmb_mesh_string_at(mesh, dmb_id_is_none(def->stabiliser) ? dmb_mesh_string_of(mesh, def->string) : 0);
    dmb_body_map map = {string->end_node, DMB_NONE, string->end_arm, 0, 0, ""};
    memcpy(map.name, def->name, sizeof map.name);
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
