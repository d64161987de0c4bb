/* Nodes inside pipes: stabilisers, and the points of loads, springs, forces and stuck places, divide their elements, so
 * that a concentrated force acts at a node (eq:beam.section-pose). */
#include <math.h>

#include "model/field_check.h"
#include "model/mesh.h"
#include "model/model.h"
#include "model/section.h"

double dmb_ring_reach(const dmb_pipe_def *def)
{
    return 0.25 * def->outer_diameter;
}

/* ---- Places in their order --------------------------------------------------------------------------------------- */

/* Run that contains a pipe; runs of a string are ordered by pipe. */
const dmb_pipe_run *dmb_mesh_run_with(const dmb_mesh *mesh, uint32_t string, uint32_t pipe)
{
    const uint32_t *order = mesh->run_order.items;
    uint32_t low = *DMB_VECTOR_AT(uint32_t, &mesh->run_start, string);
    uint32_t high = *DMB_VECTOR_AT(uint32_t, &mesh->run_start, string + 1u);
    if (low == high) return NULL;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (dmb_mesh_run_at(mesh, order[middle])->first <= pipe)
            low = middle;
        else
            high = middle;
    }
    const dmb_pipe_run *run = dmb_mesh_run_at(mesh, order[low]);
    return pipe - run->first < run->count ? run : NULL;
}

static bool comes_before(const dmb_mesh_ring *a, const dmb_mesh_ring *b)
{
    if (a->string != b->string) return a->string < b->string;
    if (a->pipe != b->pipe) return a->pipe < b->pipe;
    return a->along < b->along;
}

/* Sinks item i of a heap whose largest item comes first. */
static void sink(dmb_mesh_ring *items, size_t i, size_t count)
{
    for (size_t child = 2 * i + 1; child < count; child = 2 * i + 1) {
        if (child + 1 < count && comes_before(items + child, items + child + 1)) child++;
        if (!comes_before(items + i, items + child)) return;
        const dmb_mesh_ring moved = items[i];
        items[i] = items[child];
        items[child] = moved;
        i = child;
    }
}

/* Heapsort (Williams 1964): in place, n log n for any order. */
void dmb_mesh_sort_places(dmb_mesh_ring *items, size_t count)
{
    for (size_t i = count / 2; i-- > 0;) sink(items, i, count);
    for (size_t end = count; end-- > 1;) {
        const dmb_mesh_ring largest = items[0];
        items[0] = items[end];
        items[end] = largest;
        sink(items, 0, end);
    }
}

static dmb_ring_range range_in(const dmb_vector *places, uint32_t string, uint32_t pipe)
{
    const dmb_mesh_ring *items = places->items, begin = {.along = -1.0, .string = string, .pipe = pipe};
    size_t low = 0, high = places->count;
    dmb_ring_range range = {NULL, 0};
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (comes_before(items + middle, &begin))
            low = middle + 1;
        else
            high = middle;
    }
    for (; low < places->count && items[low].string == string && items[low].pipe == pipe; low++) {
        if (range.count++ == 0) range.first = items + low;
    }
    return range;
}

dmb_ring_range dmb_mesh_rings_of(const dmb_mesh *mesh, uint32_t string, uint32_t pipe)
{
    return range_in(&mesh->ring_order, string, pipe);
}

dmb_ring_range dmb_mesh_divisions_of(const dmb_mesh *mesh, uint32_t string, uint32_t pipe)
{
    return range_in(&mesh->divisions, string, pipe);
}

/* ---- Points of forces -------------------------------------------------------------------------------------------- */

/* True if a point is so close to a stabiliser that it uses the node of that. */
static bool is_by_stabiliser(const dmb_mesh *mesh, const dmb_mesh_ring *point, double reach)
{
    const dmb_ring_range rings = dmb_mesh_rings_of(mesh, point->string, point->pipe);
    for (uint32_t i = 0; i < rings.count; i++)
        if (fabs(rings.first[i].along - point->along) <= reach) return true;
    return false;
}

/* Adds a place on the flexible length of an elastic pipe; other places are rigid with a node, or rejected by their part
 * (mesh_action.c, mesh_force.c). */
static int32_t add_point(dmb_mesh *mesh, const dmb_place *place)
{
    const uint32_t string = dmb_model_part_index(mesh->model, place->part, DMB_PART_STRING);
    const dmb_pipe_run *run = string == DMB_NONE ? NULL : dmb_mesh_run_with(mesh, string, place->pipe);
    if (run == NULL || dmb_mesh_kind(mesh, run) == DMB_PIPE_RIGID) return DMB_OK;
    const double along = place->fraction * run->def.length, reach = dmb_ring_reach(&run->def);
    const dmb_mesh_ring point = {.along = along, .string = string, .pipe = place->pipe, .ring = DMB_NONE};
    if (!(along > reach) || !(along < dmb_pipe_body_length(&run->def) - reach)) return DMB_OK;
    if (is_by_stabiliser(mesh, &point, reach)) return DMB_OK;
    return dmb_vector_append(&mesh->divisions, &mesh->model->allocator, &point, 1);
}

static int32_t add_springs(dmb_mesh *mesh)
{
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < mesh->model->springs.count && status >= 0; i++) {
        const dmb_spring_def *def = &DMB_LIST_AT(const dmb_spring_plan, mesh->model->springs, i)->def;
        status = add_point(mesh, &def->place_a);
        if (status >= 0) status = add_point(mesh, &def->place_b);
    }
    return status;
}

static int32_t add_forces(dmb_mesh *mesh)
{
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < mesh->model->forces.count; i++) {
        const dmb_force_def *def = DMB_LIST_AT(const dmb_force_def, mesh->model->forces, i);
        for (uint32_t k = 0; k < def->place_count && status >= 0; k++) status = add_point(mesh, &def->place[k]);
    }
    return status;
}

int32_t dmb_mesh_divisions(dmb_mesh *mesh)
{
    const dmb_model *model = mesh->model;
    int32_t status =
        dmb_vector_append(&mesh->divisions, &model->allocator, mesh->ring_order.items, mesh->ring_order.count);
    for (uint32_t i = 0; i < model->loads.count && status >= 0; i++)
        status = add_point(mesh, &DMB_LIST_AT(const dmb_load_def, model->loads, i)->place);
    if (status >= 0) status = add_springs(mesh);
    for (uint32_t i = 0; i < model->stuck.count && status >= 0; i++)
        status = add_point(mesh, &DMB_LIST_AT(const dmb_stuck_def, model->stuck, i)->place);
    if (status >= 0) status = add_forces(mesh);
    if (status >= 0) dmb_mesh_sort_places(mesh->divisions.items, mesh->divisions.count);
    return status;
}
