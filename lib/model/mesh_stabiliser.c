/* Stabilisers: their order along the strings, and the nodes that carry them. They are placed in two steps, because they
 * divide elements: before the strings are meshed their places are sorted and checked, afterwards each finds its
 * node. */
#include <math.h>
#include <string.h>

#include "model/field_check.h"
#include "model/mesh.h"
#include "model/model.h"
#include "model/section.h"

static const dmb_stabiliser_def *def_of(const dmb_mesh *mesh, uint32_t ring)
{
    return DMB_LIST_AT(const dmb_stabiliser_def, mesh->model->rings, ring);
}

static dmb_check check_of(const dmb_mesh *mesh, uint32_t ring, dmb_message *text)
{
    return dmb_check_of(&mesh->model->message, dmb_model_part_text(mesh->model, DMB_PART_STABILISER, ring, text),
                        DMB_NONE);
}

/* ---- Order ------------------------------------------------------------------------------------------------------- */

static int32_t place_stabiliser(dmb_mesh *mesh, uint32_t i)
{
    const dmb_stabiliser_def *def = def_of(mesh, i);
    dmb_message text;
    dmb_check check = check_of(mesh, i, &text);
    if (mesh->strings.count == 0 && mesh->model->strings.count == 0) {
        dmb_message_set(check.message, "%s: belongs to the model's first string, and there is none; add pipes",
                        check.part);
        return DMB_ERR_ID;
    }
    const uint32_t string = dmb_mesh_string_of(mesh, def->string);
    const dmb_pipe_run *run = dmb_mesh_run_with(mesh, string, def->pipe);
    if (run == NULL) {
        const uint32_t pipes = DMB_LIST_AT(const dmb_string_plan, mesh->model->strings, string)->pipes;
        dmb_message_set(check.message,
                        "%s: pipe = %u, must be < %u, the pipes of string %u; add pipes or move the stabiliser",
                        check.part, def->pipe, pipes, string);
        return DMB_ERR_VALUE;
    }
    const bool in_joint = def->fraction * run->def.length > dmb_pipe_body_length(&run->def);
    double diameters[2];
    dmb_pipe_diameters(&run->def, in_joint, diameters);
    if (def->outer_diameter < diameters[0]) {
        dmb_message_set(check.message,
                        "%s: outer_diameter = %g m, must be >= %g m, that of %s %u of string %u, which it sits on",
                        check.part, def->outer_diameter, diameters[0], in_joint ? "the tool joint of pipe" : "pipe",
                        def->pipe, string);
        return DMB_ERR_GEOMETRY;
    }
    const dmb_mesh_ring ring = {
        .along = def->fraction * run->def.length, .string = string, .pipe = def->pipe, .ring = i};
    return dmb_vector_append(&mesh->ring_order, &mesh->model->allocator, &ring, 1);
}

/* [m] Distance from the middle of a stabiliser to that of the next one on its string. */
static double way_to_next(const dmb_mesh *mesh, const dmb_mesh_ring *ring, double enough)
{
    double way = ring[1].along - ring->along;
    for (uint32_t pipe = ring->pipe; pipe < ring[1].pipe && way < enough; pipe++)
        way += dmb_mesh_run_with(mesh, ring->string, pipe)->def.length;
    return way;
}

static int32_t check_apart(const dmb_mesh *mesh, const dmb_mesh_ring *ring)
{
    const double need = 0.5 * (def_of(mesh, ring->ring)->length + def_of(mesh, ring[1].ring)->length);
    dmb_message text, other;
    const double way = way_to_next(mesh, ring, need);
    if (way >= need * (1.0 - 1e-9)) return DMB_OK;
    dmb_check check = check_of(mesh, ring[1].ring, &text);
    const dmb_check before = check_of(mesh, ring->ring, &other);
    dmb_message_set(
        check.message,
        "%s: its middle (pipe %u) is %g m behind that of %s, must be >= %g m, half of both lengths; move one, "
        "or make them one stabiliser",
        check.part, ring[1].pipe, way, before.part, need);
    return DMB_ERR_GEOMETRY;
}

int32_t dmb_mesh_ring_places(dmb_mesh *mesh)
{
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < mesh->model->rings.count && status >= 0; i++) status = place_stabiliser(mesh, i);
    if (status < 0) return status;
    dmb_mesh_ring *items = mesh->ring_order.items;
    dmb_mesh_sort_places(items, mesh->ring_order.count);
    for (size_t i = 0; i + 1 < mesh->ring_order.count; i++) {
        if (items[i].string != items[i + 1].string) continue;
        status = check_apart(mesh, items + i);
        if (status < 0) return status;
    }
    return DMB_OK;
}

/* ---- Elements of a pipe ------------------------------------------------------------------------------------------ */

uint32_t dmb_mesh_element_along(const dmb_mesh *mesh, const dmb_pipe_map *pipe, double along, double *fraction)
{
    const uint32_t last = pipe->elements - 1;
    uint32_t k = 0;
    double start = 0.0;
    while (k < last && along >= start + dmb_mesh_element_at(mesh, pipe->element + k)->length)
        start += dmb_mesh_element_at(mesh, pipe->element + k++)->length;
    *fraction = fmin((along - start) / dmb_mesh_element_at(mesh, pipe->element + k)->length, 1.0);
    return pipe->element + k;
}

/* ---- Nodes ------------------------------------------------------------------------------------------------------- */

/* Nearest node of the pipe, and the distance from it along body x. The far node may be behind the pipe, in its tool
 * joint or in rigid pipes. */
static dmb_mesh_place node_near(const dmb_mesh *mesh, const dmb_pipe_map *pipe, double along)
{
    const double body = pipe->length - pipe->joint;
    double fraction = 0.0;
    if (pipe->elements == 0) return (dmb_mesh_place){pipe->node, pipe->start + along};
    const uint32_t e = along < body ? dmb_mesh_element_along(mesh, pipe, along, &fraction) : 0;
    const uint32_t last = pipe->element + pipe->elements - 1;
    if (along >= body) {
        const dmb_mesh_element *end = dmb_mesh_element_at(mesh, last);
        return (dmb_mesh_place){end->node + 1, along - body - end->arm[1]};
    }
    const dmb_mesh_element *element = dmb_mesh_element_at(mesh, e);
    if (fraction < 0.5) return (dmb_mesh_place){element->node, element->arm[0] + fraction * element->length};
    return (dmb_mesh_place){element->node + 1, (fraction - 1.0) * element->length - element->arm[1]};
}

/* Arm of a stabiliser that has divided an element: 0 except for rounding. */
static double arm_of(double arm)
{
    return fabs(arm) < 1e-9 ? 0.0 : arm;
}

/* [m] of the near end of each pipe that has rings, going on from `*number` at `*at`. */
static double start_of(const dmb_mesh *mesh, const dmb_mesh_ring *ring, uint32_t *string, uint32_t *number, double *at)
{
    if (*string != ring->string) *number = 0, *at = 0.0;
    *string = ring->string;
    while (*number < ring->pipe) {
        const dmb_pipe_run *run = dmb_mesh_run_with(mesh, ring->string, *number);
        const uint32_t left = run->count - (*number - run->first), want = ring->pipe - *number;
        const uint32_t pass = left < want ? left : want;
        *at += pass * run->def.length;
        *number += pass;
    }
    return *at;
}

/* Reamers to the middles of their rings. */
static void place_reamers(dmb_mesh *mesh, uint32_t first)
{
    const dmb_model *model = mesh->model;
    for (uint32_t i = 0; i < model->bits.count; i++) {
        const dmb_bit_def *bit = DMB_LIST_AT(const dmb_bit_def, model->bits, i);
        const uint32_t ring = dmb_model_part_index(model, bit->stabiliser, DMB_PART_STABILISER);
        if (ring == DMB_NONE) continue;
        const dmb_body_map *on = DMB_VECTOR_AT(const dmb_body_map, &mesh->bodies, first + ring);
        dmb_body_map *map = DMB_VECTOR_AT(dmb_body_map, &mesh->bodies, model->bodies.count + i);
        map->node = on->node;
        map->arm = on->arm;
    }
}

int32_t dmb_mesh_rings(dmb_mesh *mesh)
{
    const dmb_model *model = mesh->model;
    const uint32_t first = (uint32_t)mesh->bodies.count;
    uint32_t string = DMB_NONE, number = 0;
    double at = 0.0;
    int32_t status = dmb_vector_append(&mesh->bodies, &model->allocator, NULL, model->rings.count);
    for (size_t i = 0; i < mesh->ring_order.count && status >= 0; i++) {
        const dmb_mesh_ring *ring = DMB_VECTOR_AT(const dmb_mesh_ring, &mesh->ring_order, i);
        const dmb_stabiliser_def *def = def_of(mesh, ring->ring);
        const uint32_t pipe = dmb_mesh_string_at(mesh, ring->string)->first_pipe + ring->pipe;
        const dmb_mesh_place place = node_near(mesh, dmb_mesh_pipe_at(mesh, pipe), ring->along);
        dmb_body_map *map = DMB_VECTOR_AT(dmb_body_map, &mesh->bodies, first + ring->ring);
        *map = (dmb_body_map){.node = place.node, .site = DMB_NONE, .arm = arm_of(place.arm)};
        memcpy(map->name, def->name, sizeof map->name);
        const dmb_ring_map along = {.at = start_of(mesh, ring, &string, &number, &at) + ring->along,
                                    .half_length = 0.5 * def->length,
                                    .string = ring->string,
                                    .body = first + ring->ring};
        status = dmb_vector_append(&mesh->rings, &model->allocator, &along, 1);
    }
    if (status >= 0) place_reamers(mesh, first);
    return status;
}
