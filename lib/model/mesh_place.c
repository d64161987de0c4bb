#include "model/mesh_place.h"

#include <math.h>

#define DMB_WITHIN 1e-9 /* [-] of a pipe: what the caller's fraction may be off */

/* The tool joint, counted back from the far end so that fraction 1 falls on it without round-off; then the ends of the
 * equal elements. */
static bool place_on_elastic(const dmb_mesh *mesh, const dmb_pipe_map *map, double fraction, dmb_mesh_place *found)
{
    const dmb_mesh_element *first = dmb_mesh_element_at(mesh, map->element), *last = first + map->elements - 1;
    const double back = (1.0 - fraction) * map->length;
    const double position = fraction * map->length * map->elements / (map->length - map->joint);
    const double k = floor(position + 0.5);
    if (back <= map->joint) {
        found->node = last->node + 1;
        found->arm = map->joint - back - last->arm[1];
        return true;
    }
    if (fabs(position - k) > DMB_WITHIN * map->elements) return false;
    if (k < 0.5) {
        found->node = first->node;
        found->arm = first->arm[0];
    } else {
        found->node = first->node + (uint32_t)k;
        found->arm = k < map->elements - 0.5 ? 0.0 : -last->arm[1];
    }
    return true;
}

static bool place_on_string(const dmb_mesh *mesh, uint32_t string, const dmb_place *place, dmb_mesh_place *found)
{
    const dmb_pipe_map *map = dmb_mesh_pipe_at(mesh, dmb_mesh_string_at(mesh, string)->first_pipe + place->pipe);
    if (map->elements > 0) return place_on_elastic(mesh, map, place->fraction, found);
    found->node = map->node;
    found->arm = map->start + place->fraction * map->length;
    return true;
}

bool dmb_mesh_place_of(const dmb_mesh *mesh, const dmb_place *place, dmb_mesh_place *found)
{
    const dmb_model *model = mesh->model;
    const uint32_t string = dmb_model_part_index(model, place->part, DMB_PART_STRING);
    const uint32_t bit = dmb_model_part_index(model, place->part, DMB_PART_BIT);
    const uint32_t body =
        bit != UINT32_MAX ? model->bodies.count + bit : dmb_model_part_index(model, place->part, DMB_PART_BODY);
    if (string != UINT32_MAX) return place_on_string(mesh, string, place, found);
    found->node = DMB_VECTOR_AT(dmb_body_map, &mesh->bodies, body)->node;
    found->arm = DMB_VECTOR_AT(dmb_body_map, &mesh->bodies, body)->arm;
    return true;
}
