/* Reaction at a guided end: the residual that is left in the rows that are not solved for. */
#include "element/beam.h"
#include "query/place.h"
#include "sim/access.h"
#include "sim/sim.h"

/* The rows of the node as components of a wrench; free ones carry none. */
static void held_wrench(const dmb_sim *sim, uint32_t node, double wrench[6])
{
    static const uint32_t path_component[2] = {DMB_X, DMB_RX};
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < 6; i++) wrench[i] = 0.0;
    for (uint32_t i = 0; i < scene->held_count; i++) {
        const uint32_t c = scene->held_component[i];
        if (scene->held_node[i] != node) continue;
        wrench[scene->layout.size[node] == DMB_NODE_PATH ? path_component[c] : c] = sim->held_reaction[i];
    }
}

int32_t dmb_query_reaction(const dmb_sim *sim, dmb_id part, double reaction[6])
{
    const int32_t status = dmb_ask(sim, reaction);
    uint32_t string, body, node;
    double arm;
    if (status < 0) return status;
    string = dmb_model_part_index(sim->model, part, DMB_PART_STRING);
    body = dmb_body_index(sim, part);
    if (string < sim->scene->string_count) {
        node = sim->scene->strings[string].start_node;
        arm = sim->scene->strings[string].start_arm;
    } else if (body != DMB_NONE) {
        node = sim->scene->bodies[body].node;
        arm = sim->scene->bodies[body].arm;
    } else {
        return DMB_ERR_ID;
    }
    held_wrench(sim, node, reaction);
    dmb_arm_wrench(-arm, reaction); /* from the node to the part's reference point */
    return DMB_OK;
}
