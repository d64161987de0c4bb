#include "query/spot.h"

#include <math.h>
#include <stddef.h>

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

/* The scene lists the described bodies first, then the bits. */
uint32_t dmb_body_index(const dmb_sim *sim, dmb_id id)
{
    uint32_t index = dmb_model_part_index(sim->model, id, DMB_PART_BODY);
    if (index == UINT32_MAX) {
        index = dmb_model_part_index(sim->model, id, DMB_PART_BIT);
        if (index != UINT32_MAX) index += sim->model->bodies.count;
    }
    return index < sim->scene->body_count ? index : UINT32_MAX;
}

static void fix(dmb_spot *spot, uint32_t node, double arm)
{
    spot->node = node;
    spot->arm = arm;
    spot->fixed = 1;
}

/* The tool joint, counted back from the far end so that fraction 1 falls on it without round-off. */
static void place_in_joint(const dmb_scene *scene, const dmb_pipe_map *pipe, double back, dmb_spot *spot)
{
    const uint32_t last = pipe->element + pipe->elements - 1;
    spot->element = last;
    spot->fraction = 1.0;
    spot->beyond = pipe->joint - back;
    fix(spot, scene->element_node[last] + 1, spot->beyond - scene->types[scene->element_type[last]].arm[1]);
}

/* `along` [m] from the pipe's near end, on its flexible part; the elements of a pipe are of one length. */
static void place_in_element(const dmb_scene *scene, const dmb_pipe_map *pipe, double along, dmb_spot *spot)
{
    const double length = (pipe->length - pipe->joint) / pipe->elements;
    const uint32_t last = pipe->elements - 1;
    const double position = along / length;
    const uint32_t k = position < last ? (uint32_t)position : last;
    const dmb_element_type *type = &scene->types[scene->element_type[pipe->element + k]];
    spot->element = pipe->element + k;
    spot->fraction = fmin(position - k, 1.0);
    spot->node = scene->element_node[spot->element];
    if (!(spot->fraction > 0.0)) fix(spot, spot->node, type->arm[0]);
    if (!(spot->fraction < 1.0)) fix(spot, spot->node + 1, -type->arm[1]);
}

static int32_t place_on_string(const dmb_sim *sim, dmb_place place, dmb_spot *spot)
{
    int32_t status;
    const dmb_pipe_map *pipe = dmb_pipe_of(sim, place.part, place.pipe, &status);
    double back;
    if (pipe == NULL) return status;
    if (!isfinite(place.fraction)) return DMB_ERR_NOT_FINITE;
    if (!(place.fraction >= 0.0 && place.fraction <= 1.0)) return DMB_ERR_VALUE;
    back = (1.0 - place.fraction) * pipe->length;
    if (pipe->elements == 0) {
        fix(spot, pipe->node, pipe->start + place.fraction * pipe->length);
    } else if (pipe->joint > 0.0 && back <= pipe->joint) {
        place_in_joint(sim->scene, pipe, back, spot);
    } else {
        place_in_element(sim->scene, pipe, place.fraction * pipe->length, spot);
    }
    return DMB_OK;
}

int32_t dmb_spot_of(const dmb_sim *sim, dmb_place place, dmb_spot *spot)
{
    const uint32_t body = dmb_body_index(sim, place.part);
    dmb_spot found = {0, DMB_SPOT_RIGID, 0.0, 0.0, 0.0, 0, 0};
    if (body != UINT32_MAX) {
        if (!isfinite(place.fraction)) return DMB_ERR_NOT_FINITE;
        if (place.pipe != 0 || place.fraction != 0.0) return DMB_ERR_VALUE;
        fix(&found, sim->scene->bodies[body].node, sim->scene->bodies[body].arm);
    } else {
        const int32_t status = place_on_string(sim, place, &found);
        if (status < 0) return status;
    }
    *spot = found;
    return DMB_OK;
}
