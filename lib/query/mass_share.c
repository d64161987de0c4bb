#include "query/mass_share.h"

#include <string.h>

#include "element/lump.h"
#include "model/eccentricity.h"
#include "model/lump_sum.h"
#include "model/section.h"
#include "query/pipe_run.h"

void dmb_describe_pipe(const dmb_sim *sim, uint32_t string, uint32_t pipe, dmb_described_pipe *out)
{
    const dmb_scene *scene = sim->scene;
    memset(out, 0, sizeof *out);
    out->map = &scene->pipes[scene->strings[string].first_pipe + pipe];
    out->def = &dmb_pipe_run_of(sim->model, string, pipe)->def;
    out->string = string;
    out->number = pipe;
    out->eccentric = (scene->features & DMB_FEATURE_ECCENTRICITY) && dmb_pipe_is_eccentric(out->def);
    if (out->eccentric) dmb_pipe_offset(out->def, pipe, out->offset);
}

static void begin(dmb_lump *share, uint32_t node)
{
    memset(share, 0, sizeof *share);
    share->node = node;
}

/* A solid of revolution with its centre at x [m] along the node's axis, and beside it by the pipe's offset. */
static void add_part(dmb_lump *share, const dmb_rigid_part *part, double x, const dmb_described_pipe *pipe)
{
    const double centre[3] = {x, 0.0, 0.0};
    const double inertia[6] = {part->inertia[0], part->inertia[1], part->inertia[1], 0.0, 0.0, 0.0};
    dmb_lump_add(share, part->mass, centre, inertia);
    if (pipe != NULL && pipe->eccentric) dmb_lump_shift(share, part->mass, x, pipe->offset);
}

void dmb_rigid_pipe_share(const dmb_described_pipe *pipe, dmb_lump *share)
{
    dmb_rigid_part part;
    begin(share, pipe->map->node);
    dmb_rigid_pipe_of(pipe->def, &part);
    add_part(share, &part, pipe->map->start + 0.5 * dmb_pipe_body_length(pipe->def), pipe);
}

/* The joint ends where the pipe does; behind a flexible pipe the node may stand further on, in rigid pipes. */
void dmb_joint_share(const dmb_scene *scene, const dmb_described_pipe *pipe, dmb_lump *share)
{
    const dmb_pipe_map *map = pipe->map;
    double x = map->start + map->length - 0.5 * map->joint;
    uint32_t node = map->node;
    dmb_rigid_part part;
    if (map->elements > 0) {
        const uint32_t last = map->element + map->elements - 1;
        node = scene->element_node[last] + 1;
        x = 0.5 * map->joint - scene->types[scene->element_type[last]].arm[1];
    }
    begin(share, node);
    dmb_joint_of(pipe->def, &part);
    add_part(share, &part, x, pipe);
}

void dmb_eccentric_share(const dmb_scene *scene, const dmb_described_pipe *pipe, uint32_t element, uint32_t end,
                         dmb_lump *share)
{
    const dmb_element_type *type = &scene->types[scene->element_type[element]];
    begin(share, scene->element_node[element] + end);
    dmb_lump_shift(share, 0.5 * type->mass_per_metre * type->length, end ? -type->arm[1] : type->arm[0], pipe->offset);
}

/* A bit's reference point is the string's end; its centre is half its length beyond. */
static void bit_share(const dmb_bit_def *def, double arm, dmb_lump *share)
{
    dmb_rigid_part part;
    dmb_bit_body_of(def, &part);
    add_part(share, &part, arm + 0.5 * def->length, NULL);
}

void dmb_body_share(const dmb_sim *sim, uint32_t body, dmb_lump *share)
{
    const dmb_body_map *map = &sim->scene->bodies[body];
    const uint32_t bodies = sim->model->bodies.count;
    const dmb_body_def *def;
    double centre[3];
    begin(share, map->node);
    if (body >= bodies) {
        bit_share((const dmb_bit_def *)sim->model->bits.items + (body - bodies), map->arm, share);
        return;
    }
    def = (const dmb_body_def *)sim->model->bodies.items + body;
    dmb_vec3_copy(def->centre, centre);
    centre[0] += map->arm;
    dmb_lump_add(share, def->mass, centre, def->inertia);
}

/* On the hole's axis only mass and the inertia about it are felt. */
double dmb_share_kinetic_energy(const dmb_sim *sim, const dmb_lump *share)
{
    const double *v = sim->now.velocity + sim->scene->layout.row[share->node];
    double p[6];
    if (sim->scene->layout.size[share->node] == DMB_NODE_PATH)
        return 0.5 * (share->mass * v[0] * v[0] + share->inertia[0] * v[1] * v[1]);
    dmb_lump_mass_times(share, v, p);
    return 0.5 * dmb_vec6_dot(v, p);
}
