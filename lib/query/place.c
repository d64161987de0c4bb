/* Places of the user in the mesh: rigidly connected to a node or inside an element; pipes, bodies and contact points by
 * number. */
#include "query/query.h"

#include <math.h>
#include <stddef.h>

#include "system/assemble/assemble.h"

const dmb_pipe_map *dmb_pipe_of(const dmb_sim *sim, dmb_id string, uint32_t pipe, int32_t *status)
{
    const uint32_t index = dmb_model_part_index(sim->model, string, DMB_PART_STRING);
    const dmb_string_map *map;
    *status = DMB_ERR_ID;
    if (index >= sim->scene->string_count) return NULL;
    map = &sim->scene->strings[index];
    *status = DMB_ERR_VALUE;
    if (pipe >= map->pipe_count) return NULL;
    *status = DMB_OK;
    return &sim->scene->pipes[map->first_pipe + pipe];
}

/* The scene lists the described bodies first, then the bits, then the contact rings. */
uint32_t dmb_body_index(const dmb_sim *sim, dmb_id id)
{
    uint32_t index = dmb_model_part_index(sim->model, id, DMB_PART_BODY);
    if (index == DMB_NONE) {
        index = dmb_model_part_index(sim->model, id, DMB_PART_BIT);
        if (index != DMB_NONE) index += sim->model->bodies.count;
    }
    if (index == DMB_NONE && sim->scene->ring_count > 0) {
        index = dmb_model_part_index(sim->model, id, DMB_PART_STABILISER);
        if (index != DMB_NONE) index += sim->model->bodies.count + sim->model->bits.count;
    }
    return index < sim->scene->body_count ? index : DMB_NONE;
}

static void fix(dmb_material_point *point, uint32_t node, double arm)
{
    point->node = node;
    point->arm = arm;
    point->fixed = 1;
}

/* Point in the tool joint, measured back from the far end so that fraction 1 is exactly at the end. */
static void place_in_joint(const dmb_scene *scene, const dmb_pipe_map *pipe, double back, dmb_material_point *point)
{
    const uint32_t last = pipe->element + pipe->elements - 1;
    point->element = last;
    point->fraction = 1.0;
    point->beyond = pipe->joint - back;
    fix(point, scene->element_node[last] + 1, point->beyond - scene->types[scene->element_type[last]].arm[1]);
}

static const dmb_element_type *type_of(const dmb_scene *scene, uint32_t element)
{
    return scene->types + scene->element_type[element];
}

/* Position along a pipe in element lengths: the number of elements before the place plus the fraction of the next one.
 */
static double count_lengths(const dmb_scene *scene, const dmb_pipe_map *pipe, double along)
{
    const uint32_t last = pipe->elements - 1;
    uint32_t k = 0;
    double start = 0.0;
    if (!pipe->divided) return along / ((pipe->length - pipe->joint) / pipe->elements);
    while (k < last && along >= start + type_of(scene, pipe->element + k)->length)
        start += type_of(scene, pipe->element + k++)->length;
    return k + (along - start) / type_of(scene, pipe->element + k)->length;
}

/* Point at `along` [m] from the near end of the pipe, on its flexible part. */
static void place_in_element(const dmb_scene *scene, const dmb_pipe_map *pipe, double along, dmb_material_point *point)
{
    const uint32_t last = pipe->elements - 1;
    const double position = count_lengths(scene, pipe, along);
    const uint32_t k = position < last ? (uint32_t)position : last;
    const dmb_element_type *type = type_of(scene, pipe->element + k);
    point->element = pipe->element + k;
    point->fraction = fmin(position - k, 1.0);
    point->node = scene->element_node[point->element];
    if (!(point->fraction > 0.0)) fix(point, point->node, type->arm[0]);
    if (!(point->fraction < 1.0)) fix(point, point->node + 1, -type->arm[1]);
}

/* Where a place of a pipe is in the mesh, by its fraction of the pipe's length:
 *
 *     rigid pipe           fixed to its one node, at its distance from it
 *     in the tool joint    fixed to the far node of the last element
 *     else                 in an element; at its ends fixed to the node there */
int32_t dmb_string_point_of(const dmb_sim *sim, dmb_place place, dmb_material_point *point)
{
    static const dmb_material_point nowhere = {0, DMB_NONE, 0.0, 0.0, 0.0, 0, 0};
    int32_t status;
    const dmb_pipe_map *pipe = dmb_pipe_of(sim, place.part, place.pipe, &status);
    double back;
    *point = nowhere;
    if (pipe == NULL) return status;
    if (!isfinite(place.fraction)) return DMB_ERR_NOT_FINITE;
    if (!(place.fraction >= 0.0 && place.fraction <= 1.0)) return DMB_ERR_VALUE;
    back = (1.0 - place.fraction) * pipe->length;
    if (pipe->elements == 0) {
        fix(point, pipe->node, pipe->start + place.fraction * pipe->length);
    } else if (pipe->joint > 0.0 && back <= pipe->joint) {
        place_in_joint(sim->scene, pipe, back, point);
    } else {
        place_in_element(sim->scene, pipe, place.fraction * pipe->length, point);
    }
    return DMB_OK;
}

int32_t dmb_material_point_of(const dmb_sim *sim, dmb_place place, dmb_material_point *point)
{
    const uint32_t body = dmb_body_index(sim, place.part);
    dmb_material_point found = {0, DMB_NONE, 0.0, 0.0, 0.0, 0, 0};
    if (body != DMB_NONE) {
        if (!isfinite(place.fraction)) return DMB_ERR_NOT_FINITE;
        if (place.pipe != 0 || place.fraction != 0.0) return DMB_ERR_VALUE;
        fix(&found, sim->scene->bodies[body].node, sim->scene->bodies[body].arm);
    } else {
        const int32_t status = dmb_string_point_of(sim, place, &found);
        if (status < 0) return status;
    }
    *point = found;
    return DMB_OK;
}

const dmb_pipe_run *dmb_pipe_run_of(const dmb_model *model, uint32_t string, uint32_t pipe)
{
    const dmb_pipe_run *runs = model->runs.items;
    for (uint32_t i = 0; i < model->runs.count; i++) {
        if (runs[i].string == string && pipe >= runs[i].first && pipe - runs[i].first < runs[i].count) return &runs[i];
    }
    return NULL;
}

/* A contact point of either kind, by its number. */
typedef struct site_owner {
    dmb_id part;
    uint32_t pipe, node;
} site_owner;

static site_owner owner_of(const dmb_scene *scene, uint32_t site)
{
    site_owner owner;
    if (site < scene->site_count) {
        const dmb_site *full = &scene->sites[site];
        owner.part = full->part, owner.pipe = full->pipe, owner.node = full->node;
    } else {
        const dmb_axial_torsional_site *path = &scene->axial_torsional_sites[site - scene->site_count];
        owner.part = path->part, owner.pipe = path->pipe, owner.node = path->node;
    }
    return owner;
}

static int32_t is_on_string(dmb_id part)
{
    return (part.index >> 24 == DMB_PART_STRING) | (part.index >> 24 == DMB_PART_STABILISER);
}

/* First contact point in first .. end that is not on a string, or whose node is at least `node`: contact points of
 * strings and rings are in the order of their nodes, those of bodies are last. */
static uint32_t first_at(const dmb_scene *scene, uint32_t first, uint32_t end, uint32_t node)
{
    while (first < end) {
        const uint32_t middle = first + (end - first) / 2;
        const site_owner owner = owner_of(scene, middle);
        if (is_on_string(owner.part) && owner.node < node)
            first = middle + 1;
        else
            end = middle;
    }
    return first;
}

/* In a rigid section the contact points of all its pipes are on one node. */
static uint32_t search(const dmb_scene *scene, uint32_t first, uint32_t end, dmb_id string, uint32_t pipe,
                       uint32_t node)
{
    for (uint32_t i = first_at(scene, first, end, node); i < end; i++) {
        const site_owner owner = owner_of(scene, i);
        if (owner.node != node) break;
        if (owner.part.index == string.index && owner.pipe == pipe) return i;
    }
    return DMB_NONE;
}

static uint32_t site_on_string(const dmb_scene *scene, dmb_id string, uint32_t pipe, uint32_t node)
{
    const uint32_t full = scene->site_count;
    const uint32_t found = search(scene, 0, dmb_node_sites(scene), string, pipe, node);
    return found != DMB_NONE ? found
                             : search(scene, full, full + scene->axial_torsional_site_count, string, pipe, node);
}

/* Node at the far end of a pipe's first `elements` elements. */
static uint32_t node_after(const dmb_scene *scene, const dmb_pipe_map *pipe, uint32_t elements)
{
    return pipe->elements > 0 ? scene->element_node[pipe->element] + elements : pipe->node;
}

/* The contact point at the node behind `elements` elements of a pipe; 0: at its near end, which belongs to the pipe
 * before it, or for the first pipe to the string itself (pipe DMB_NONE). */
uint32_t dmb_site_after(const dmb_sim *sim, dmb_id string, uint32_t pipe, uint32_t elements)
{
    const dmb_scene *scene = sim->scene;
    const dmb_string_map *map = &scene->strings[dmb_model_part_index(sim->model, string, DMB_PART_STRING)];
    const dmb_pipe_map *pipes = &scene->pipes[map->first_pipe];
    if (elements > 0) return site_on_string(scene, string, pipe, node_after(scene, &pipes[pipe], elements));
    if (pipe == 0) return site_on_string(scene, string, DMB_NONE, map->start_node);
    return site_on_string(scene, string, pipe - 1, node_after(scene, &pipes[pipe - 1], pipes[pipe - 1].elements));
}

uint32_t dmb_site_of(const dmb_sim *sim, dmb_id part, uint32_t pipe)
{
    const uint32_t body = dmb_body_index(sim, part);
    const dmb_string_map *map;
    const dmb_pipe_map *pipe_map;
    if (body != DMB_NONE) return sim->scene->bodies[body].site;
    map = &sim->scene->strings[dmb_model_part_index(sim->model, part, DMB_PART_STRING)];
    pipe_map = &sim->scene->pipes[map->first_pipe + pipe];
    return site_on_string(sim->scene, part, pipe, node_after(sim->scene, pipe_map, pipe_map->elements));
}

double dmb_site_normal_force(const dmb_sim *sim, uint32_t site)
{
    const uint32_t full = sim->scene->site_count;
    dmb_site_force force;
    if (site == DMB_NONE) return 0.0;
    if (site < full)
        dmb_site_force_of(sim->scene, &sim->now, site, &force);
    else
        dmb_axial_torsional_site_force(sim->scene, &sim->now, site - full, &force);
    return force.normal_force;
}

int32_t dmb_normal_force_at(const dmb_sim *sim, dmb_id part, uint32_t pipe, double *force)
{
    int32_t status = DMB_OK;
    if (dmb_body_index(sim, part) == DMB_NONE)
        (void)dmb_pipe_of(sim, part, pipe, &status);
    else if (pipe != 0)
        status = DMB_ERR_VALUE;
    if (status < 0) return status;
    *force = dmb_site_normal_force(sim, dmb_site_of(sim, part, pipe));
    return DMB_OK;
}
