/* Kinetic energy part by part: a pipe's own, eccentricity included, and half of what is fixed to its two ends: its tool
 * joint, that of the pipe before it, and the bodies and bits at the ends of the string. */
#include "query/ask.h"
#include "query/mass_share.h"
#include "query/spot.h"
#include "system/energy.h"

static double elastic_body(const dmb_sim *sim, const dmb_described_pipe *pipe)
{
    double sum = 0.0;
    dmb_lump share;
    for (uint32_t i = 0; i < pipe->map->elements; i++) {
        const uint32_t element = pipe->map->element + i;
        sum += dmb_element_kinetic_energy(sim->scene, &sim->now, element);
        for (uint32_t end = 0; pipe->eccentric && end < 2; end++) {
            dmb_eccentric_share(sim->scene, pipe, element, end, &share);
            sum += dmb_share_kinetic_energy(sim, &share);
        }
    }
    return sum;
}

static double rigid_body(const dmb_sim *sim, const dmb_described_pipe *pipe)
{
    dmb_lump share;
    dmb_rigid_pipe_share(pipe, &share);
    return dmb_share_kinetic_energy(sim, &share);
}

static double joint_energy(const dmb_sim *sim, const dmb_described_pipe *pipe)
{
    dmb_lump share;
    if (!(pipe->map->joint > 0.0)) return 0.0;
    dmb_joint_share(sim->scene, pipe, &share);
    return dmb_share_kinetic_energy(sim, &share);
}

static double body_energy(const dmb_sim *sim, uint32_t body)
{
    dmb_lump share;
    dmb_body_share(sim, body, &share);
    return dmb_share_kinetic_energy(sim, &share);
}

/* Bodies and bits fixed to one end of a string; an id that names nothing is the first string. */
static double end_bodies(const dmb_sim *sim, uint32_t string, int32_t attach)
{
    const dmb_model *model = sim->model;
    const dmb_body_def *body = model->bodies.items;
    const dmb_bit_def *bit = model->bits.items;
    double sum = 0.0;
    for (uint32_t i = 0; i < sim->scene->body_count; i++) {
        const int is_bit = i >= model->bodies.count;
        const dmb_id id = is_bit ? bit[i - model->bodies.count].string : body[i].string;
        const uint32_t named = dmb_model_part_index(model, id, DMB_PART_STRING);
        const int32_t end = is_bit ? DMB_ATTACH_END : body[i].attach;
        if (end == attach && (named == UINT32_MAX ? 0 : named) == string) sum += body_energy(sim, i);
    }
    return sum;
}

static double end_energy(const dmb_sim *sim, const dmb_described_pipe *pipe)
{
    double sum = joint_energy(sim, pipe);
    if (pipe->number > 0) {
        dmb_described_pipe before;
        dmb_describe_pipe(sim, pipe->string, pipe->number - 1, &before);
        sum += joint_energy(sim, &before);
    } else {
        sum += end_bodies(sim, pipe->string, DMB_ATTACH_START);
    }
    if (pipe->number + 1 == sim->scene->strings[pipe->string].pipe_count)
        sum += end_bodies(sim, pipe->string, DMB_ATTACH_END);
    return sum;
}

static int32_t pipe_energy(const dmb_sim *sim, dmb_id part, uint32_t number, double *energy)
{
    dmb_described_pipe pipe;
    int32_t status;
    if (dmb_pipe_of(sim, part, number, &status) == NULL) return status;
    dmb_describe_pipe(sim, dmb_model_part_index(sim->model, part, DMB_PART_STRING), number, &pipe);
    *energy = pipe.map->elements > 0 ? elastic_body(sim, &pipe) : rigid_body(sim, &pipe);
    *energy += 0.5 * end_energy(sim, &pipe);
    return DMB_OK;
}

int32_t dmb_query_kinetic_energy(const dmb_sim *sim, dmb_id part, uint32_t pipe, double *energy)
{
    const int32_t status = dmb_ask(sim, energy);
    uint32_t body;
    if (status < 0) return status;
    body = dmb_body_index(sim, part);
    if (body == UINT32_MAX) return pipe_energy(sim, part, pipe, energy);
    if (pipe != 0) return DMB_ERR_VALUE;
    *energy = body_energy(sim, body);
    return DMB_OK;
}
