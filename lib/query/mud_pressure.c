#include "query/mud_pressure.h"

#include <math.h>

#include "base/sized_struct.h"
#include "drillmbd/query.h"
#include "force/hole.h"
#include "model/section.h"
#include "sim/access.h"
#include "sim/node.h"

DMB_DEFINE_INIT(dmb_flow_state, 96, {.rate = 0.0})

/* ---- At rest ----------------------------------------------------------------------------------------------------- */

static double at_rest(const dmb_scene *scene, uint32_t string, double density, const double x[3])
{
    double top[3], below[3];
    if (scene->has_hole)
        dmb_hole_frame(&scene->hole, dmb_hole_is_straight(&scene->hole) ? 0.0 : scene->hole.station[0].depth, top, NULL,
                       NULL);
    else
        dmb_vec3_copy(scene->reference_position + 3 * (size_t)scene->strings[string].start_node, top);
    dmb_vec3_sub(x, top, below);
    return fmax(0.0, density * dmb_vec3_dot(scene->gravity, below));
}

/* ---- Flow -------------------------------------------------------------------------------------------------------- */

/* The end of the string on its node's axis, world. */
static void end_position(const dmb_sim *sim, uint32_t node, double arm, double x[3])
{
    double R[9], u[3];
    dmb_node_pose(sim->scene, &sim->now, node, R, u);
    dmb_vec3_add(sim->scene->reference_position + 3 * (size_t)node, u, x);
    for (int k = 0; k < 3; k++) x[k] += arm * R[3 * k];
}

/* [Pa] lost between the rig end and a distance: in the bore, in the annulus. */
static void losses_to(const dmb_scene *scene, double distance, double loss[2])
{
    uint32_t low = 0, high = scene->flow_count - 1;
    while (low < high) {
        const uint32_t middle = low + (high - low + 1) / 2;
        if (scene->flow_pieces[middle].from <= distance)
            low = middle;
        else
            high = middle - 1;
    }
    const dmb_flow_piece *piece = scene->flow_pieces + low;
    const double along = fmin(distance - piece->from, piece->length);
    loss[0] = piece->before[0] + along * piece->bore.gradient;
    loss[1] = piece->before[1] + along * piece->annulus.gradient;
}

static dmb_mud_pressure in_flow(const dmb_sim *sim, double distance, const double x[3])
{
    const dmb_scene *scene = sim->scene;
    const dmb_string_map *string = scene->strings;
    double here[2], end[2], bottom[3], below[3];
    losses_to(scene, distance, here);
    losses_to(scene, string->length, end);
    end_position(sim, string->end_node, string->end_arm, bottom);
    dmb_vec3_sub(bottom, x, below);
    const dmb_mud_pressure p = {.outside = at_rest(scene, 0, scene->flow.outside, x) + here[1],
                                .inside = at_rest(scene, 0, scene->flow.outside, bottom) + end[1] +
                                          dmb_nozzle_loss(&scene->flow) + end[0] - here[0] -
                                          scene->flow.inside * dmb_vec3_dot(scene->gravity, below)};
    return p;
}

dmb_mud_pressure dmb_mud_pressure_at(const dmb_sim *sim, uint32_t string, double distance, const double x[3])
{
    const dmb_scene *scene = sim->scene;
    const dmb_mud mud = dmb_mud_of(scene);
    if (scene->flow_count > 0) return in_flow(sim, distance, x);
    dmb_mud_pressure p = {.outside = at_rest(scene, string, mud.outside, x)};
    p.inside = mud.inside < 0.0 ? p.outside : at_rest(scene, string, mud.inside, x);
    return p;
}

/* ---- The call ---------------------------------------------------------------------------------------------------- */

/* [m] (1 - 2 nu)(p_i A_i - p_o A_o)/(E A) L by Lame's stresses, and rho Q V/(E A) L, at the piece's near end; both are
 * straight between its ends but for the bend of the string. */
static double stretch_of(const dmb_sim *sim, const dmb_flow_piece *piece)
{
    const dmb_scene *scene = sim->scene;
    const double Ao = dmb_ring_area(piece->diameter[0], 0.0), Ai = dmb_ring_area(piece->diameter[1], 0.0);
    double x[3], sum = 0.0;
    if (piece->element == DMB_NONE || !(piece->steel > 0.0)) return 0.0;
    for (uint32_t end = 0; end < 2; end++) {
        const double at = piece->from + (end ? piece->length : 0.0);
        end_position(sim, scene->element_node[piece->element] + end, 0.0, x);
        const dmb_mud_pressure p = in_flow(sim, at, x);
        sum += 0.5 * (1.0 - 2.0 * piece->poisson) * (p.inside * Ai - p.outside * Ao);
    }
    sum += scene->flow.inside * scene->flow.rate * scene->flow.rate / Ai;
    return sum * piece->length / piece->steel;
}

static void sum_pieces(const dmb_sim *sim, dmb_flow_state *answer)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->flow_count; i++) {
        const dmb_flow_piece *piece = scene->flow_pieces + i;
        answer->bore_loss += piece->bore.gradient * piece->length;
        answer->annulus_loss += piece->annulus.gradient * piece->length;
        answer->drag += piece->annulus.pull * piece->length;
        answer->bore_reynolds = fmax(answer->bore_reynolds, piece->bore.reynolds);
        answer->annulus_reynolds = fmax(answer->annulus_reynolds, piece->annulus.reynolds);
        answer->pressure_stretch += stretch_of(sim, piece);
    }
}

int32_t dmb_query_flow(const dmb_sim *sim, dmb_flow_state *flow)
{
    const int32_t status = dmb_ask(sim, flow);
    dmb_flow_state answer = {0};
    double top[3], bottom[3], along[3];
    if (status < 0) return status;
    const dmb_scene *scene = sim->scene;
    if (scene->flow_count == 0) return dmb_flow_state_write(flow, &answer);
    end_position(sim, scene->strings[0].start_node, scene->strings[0].start_arm, top);
    end_position(sim, scene->strings[0].end_node, scene->strings[0].end_arm, bottom);
    dmb_vec3_sub(bottom, top, along);
    sum_pieces(sim, &answer);
    answer.rate = scene->flow.rate;
    answer.bit_loss = dmb_nozzle_loss(&scene->flow);
    answer.thrust = dmb_nozzle_thrust(&scene->flow);
    answer.column = (scene->flow.outside - scene->flow.inside) * dmb_vec3_dot(scene->gravity, along);
    answer.pump_pressure = answer.bore_loss + answer.bit_loss + answer.annulus_loss + answer.column;
    return dmb_flow_state_write(flow, &answer);
}
