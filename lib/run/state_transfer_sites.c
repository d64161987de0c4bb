/* Transfer of the memory of contact points. Points are matched by node and place along body x; both scenes have them in
 * the order of their strings, so one pass over both suffices. A point without a counterpart starts open, as at time 0:
 * one on added pipe, one that came free where a support was (a supported rig end has no wall contact), one of a body
 * that moved. It has no tracked depth yet and is placed last, by the advance of the next point of its chain. */
#include <math.h>
#include <string.h>

#include "run/run.h"
#include "sim/node.h"
#include "system/assemble/assemble.h"

/* [m] largest distance of equal contact points on one node */
#define DMB_SAME_PLACE 1e-9

#define DMB_COPY_SITE(field, width)                                                       \
    memcpy(sim->now.field + (width) * (size_t)s, from->now.field + (width) * (size_t)old, \
           (width) * sizeof *sim->now.field)

static void transfer_touch(dmb_sim *sim, uint32_t s, const dmb_sim *from, uint32_t old)
{
    if (dmb_scene_has_touch(sim->scene) && dmb_scene_has_touch(from->scene)) DMB_COPY_SITE(site_touch, DMB_TOUCH_SIZE);
}

/* Copies age and touch of a contact once more, because the evaluation at the restart overwrites them. */
static void transfer_again(dmb_sim *sim, uint32_t s, const dmb_sim *from, uint32_t old)
{
    if (sim->site_age[s] == 0 || from->site_age[old] == 0) return;
    sim->site_age[s] = from->site_age[old];
    transfer_touch(sim, s, from, old);
}

static void transfer_site(dmb_sim *sim, uint32_t s, const dmb_sim *from, uint32_t old, int32_t what)
{
    if (dmb_scene_has_bristles(sim->scene)) { /* the law of friction is the same in both */
        DMB_COPY_SITE(site_bristle, sim->scene->friction_law.states);
        DMB_COPY_SITE(site_sticks, 1);
    }
    if (what == DMB_TRANSFER_AGAIN) {
        transfer_again(sim, s, from, old);
        return;
    }
    DMB_COPY_SITE(site_normal, 3);
    DMB_COPY_SITE(site_depth, 1);
    DMB_COPY_SITE(site_segment, 1);
    DMB_COPY_SITE(site_penetration, 1);
    DMB_COPY_SITE(site_impact_speed, 1);
    DMB_COPY_SITE(site_slip, 2);
    transfer_touch(sim, s, from, old);
}

static void transfer_axial_torsional_site(dmb_sim *sim, uint32_t s, const dmb_sim *from, uint32_t old, int32_t what)
{
    if (dmb_scene_has_bristles(sim->scene)) { /* the law of friction is the same in both */
        DMB_COPY_SITE(axial_torsional_bristle, sim->scene->friction_law.states);
        DMB_COPY_SITE(axial_torsional_sticks, 1);
    }
    if (what == DMB_TRANSFER_ALL) DMB_COPY_SITE(axial_torsional_slip, 2);
}

/* Initial state as at time 0: open; its position on the axis is found after the others are transferred
 * (place_new_sites). */
static void begin_site(dmb_sim *sim, uint32_t s)
{
    const double down[3] = {0.0, 0.0, -1.0};
    memcpy(sim->now.site_normal + 3 * (size_t)s, down, sizeof down);
    sim->now.site_segment[s] = DMB_NONE;
    sim->now.site_penetration[s] = sim->now.site_impact_speed[s] = 0.0;
    memset(sim->now.site_slip + 2 * (size_t)s, 0, 2 * sizeof(double));
    if (dmb_scene_has_touch(sim->scene))
        memset(sim->now.site_touch + DMB_TOUCH_SIZE * (size_t)s, 0, DMB_TOUCH_SIZE * sizeof(double));
    const size_t states = sim->scene->friction_law.states;
    if (!dmb_scene_has_bristles(sim->scene)) return;
    memset(sim->now.site_bristle + states * s, 0, states * sizeof(double));
    sim->now.site_sticks[s] = 0;
}

static void begin_axial_torsional_site(dmb_sim *sim, uint32_t s)
{
    memset(sim->now.axial_torsional_slip + 2 * (size_t)s, 0, 2 * sizeof(double));
    const size_t states = sim->scene->friction_law.states;
    if (!dmb_scene_has_bristles(sim->scene)) return;
    memset(sim->now.axial_torsional_bristle + states * s, 0, states * sizeof(double));
    sim->now.axial_torsional_sticks[s] = 0;
}

/* ---- Which place was it? ----------------------------------------------------------------------------------------- */

/* The node of `from` a node comes from, DMB_NONE for none; and the way between them along body x. O(strings). */
static uint32_t old_node(const dmb_scene *scene, const dmb_scene *from, uint32_t node, double *arm)
{
    *arm = 0.0;
    for (uint32_t s = 0; s < scene->string_count; s++) {
        const dmb_string_map *map = scene->strings + s;
        if (node - map->first_node >= map->node_count) continue; /* unsigned wrap-around also excludes earlier nodes */
        const dmb_common_string common = dmb_common_string_of(scene, from, s);
        if (node < common.to) return DMB_NONE;
        const uint32_t old = common.from + (node - common.to);
        *arm = dmb_state_transfer_arm(scene, node, from, old, s);
        return old;
    }
    return from->node_count - (scene->node_count - node); /* free bodies come after the strings, in their order */
}

/* Contact points are ordered along the strings in both scenes, so one pass over both suffices. */
static void transfer_string_sites(dmb_sim *sim, const dmb_sim *from, int32_t what)
{
    const dmb_scene *scene = sim->scene, *was = from->scene;
    uint32_t k = 0;
    for (uint32_t s = 0; s < dmb_node_sites(scene); s++) {
        const dmb_site *site = scene->sites + s;
        double arm;
        if (what == DMB_TRANSFER_ALL) begin_site(sim, s);
        if (dmb_model_part_index(sim->model, site->part, DMB_PART_STRING) == DMB_NONE) continue;
        const uint32_t old = old_node(scene, was, site->node, &arm);
        const double offset = site->offset + arm;
        if (old == DMB_NONE) continue;
        while (k < dmb_node_sites(was) &&
               (was->sites[k].node < old ||
                (was->sites[k].node == old && (was->sites[k].offset < offset - DMB_SAME_PLACE ||
                                               was->sites[k].part.index >> 24 == DMB_PART_STABILISER))))
            k++;
        if (k < dmb_node_sites(was) && was->sites[k].node == old && was->sites[k].offset <= offset + DMB_SAME_PLACE &&
            dmb_model_part_index(from->model, was->sites[k].part, DMB_PART_STRING) != DMB_NONE)
            transfer_site(sim, s, from, k, what);
    }
}

/* Pipes are equal, so points inside elements are matched by their index from the end. */
static void transfer_inside_sites(dmb_sim *sim, const dmb_sim *from, int32_t what)
{
    const dmb_scene *scene = sim->scene, *was = from->scene;
    uint32_t k = 0;
    for (uint32_t i = 0; i < scene->inside_count; i++) {
        const uint32_t s = dmb_node_sites(scene) + i;
        double arm;
        if (what == DMB_TRANSFER_ALL) begin_site(sim, s);
        const uint32_t old = old_node(scene, was, scene->inside[i].node, &arm);
        while (old != DMB_NONE && k < was->inside_count &&
               (was->inside[k].node < old ||
                (was->inside[k].node == old && was->inside[k].fraction < scene->inside[i].fraction)))
            k++;
        if (old == DMB_NONE || k == was->inside_count || was->inside[k].node != old) continue;
        if (was->inside[k].fraction <= scene->inside[i].fraction)
            transfer_site(sim, s, from, dmb_node_sites(was) + k, what);
    }
}

/* A rig head moves to another position; its contact point is new there. */
static void transfer_body_sites(dmb_sim *sim, const dmb_sim *from, int32_t what)
{
    for (uint32_t b = 0; b < sim->scene->body_count - sim->scene->ring_count; b++) {
        const dmb_body_map *body = sim->scene->bodies + b, *was = from->scene->bodies + b;
        double arm;
        if (body->site == DMB_NONE || was->site == DMB_NONE) continue;
        if (old_node(sim->scene, from->scene, body->node, &arm) != was->node) continue;
        if (fabs(body->arm + arm - was->arm) <= DMB_SAME_PLACE) transfer_site(sim, body->site, from, was->site, what);
    }
}

/* Stabilisers are ordered along the strings in both scenes. One on an added pipe is new; one with another index at the
 * same place is transferred. */
static void transfer_stabiliser_sites(dmb_sim *sim, const dmb_sim *from, int32_t what)
{
    const dmb_scene *scene = sim->scene, *was = from->scene;
    uint32_t k = 0;
    for (uint32_t i = 0; i < scene->ring_count; i++) {
        const dmb_body_map *ring = scene->bodies + scene->rings[i].body;
        double arm;
        const uint32_t old = old_node(scene, was, ring->node, &arm);
        if (old == DMB_NONE || ring->site == DMB_NONE) continue;
        while (k < was->ring_count && was->bodies[was->rings[k].body].node < old) k++;
        for (uint32_t j = k; j < was->ring_count && was->bodies[was->rings[j].body].node == old; j++) {
            const dmb_body_map *other = was->bodies + was->rings[j].body;
            if (other->site != DMB_NONE && fabs(ring->arm + arm - other->arm) <= DMB_SAME_PLACE)
                transfer_site(sim, ring->site, from, other->site, what);
        }
    }
}

static void transfer_axial_torsional_sites(dmb_sim *sim, const dmb_sim *from, int32_t what)
{
    uint32_t k = 0;
    for (uint32_t s = 0; s < sim->scene->axial_torsional_site_count; s++) {
        double arm;
        const uint32_t old = old_node(sim->scene, from->scene, sim->scene->axial_torsional_sites[s].node, &arm);
        if (what == DMB_TRANSFER_ALL) begin_axial_torsional_site(sim, s);
        while (old != DMB_NONE && k < from->scene->axial_torsional_site_count &&
               from->scene->axial_torsional_sites[k].node < old)
            k++;
        if (k < from->scene->axial_torsional_site_count && from->scene->axial_torsional_sites[k].node == old)
            transfer_axial_torsional_site(sim, s, from, k, what);
    }
}

/* ---- Places that begin anew -------------------------------------------------------------------------------------- */

static double described_depth(const dmb_scene *scene, uint32_t s)
{
    return scene->reference_depth[scene->sites[s].node] + scene->sites[s].offset;
}

/* [m] Depth of the next transferred contact point of the same chain less its described depth; NAN: there is none. */
static double advance_of_chain(const dmb_sim *sim, uint32_t s)
{
    const dmb_scene *scene = sim->scene;
    const uint32_t chain = scene->node_chain[scene->sites[s].node];
    for (uint32_t k = 0; k < scene->site_count; k++)
        if (sim->now.site_segment[k] != DMB_NONE && scene->node_chain[scene->sites[k].node] == chain &&
            scene->sites[k].node >= scene->sites[s].node)
            return sim->now.site_depth[k] - described_depth(scene, k);
    return (double)NAN;
}

/* Places a new contact point by the advance of its chain; without transferred points at the nearest depth within twice
 * the displacement of the node. */
static void place_new_site(dmb_sim *sim, uint32_t s)
{
    const dmb_scene *scene = sim->scene;
    const uint32_t node = scene->sites[s].node;
    const double advance = advance_of_chain(sim, s), described = described_depth(scene, s);
    double R[9], u[3], x[3], depth = described;
    dmb_node_pose(scene, &sim->now, node, R, u);
    for (int i = 0; i < 3; i++)
        x[i] = scene->reference_position[3 * (size_t)node + (size_t)i] + u[i] + R[3 * i] * scene->sites[s].offset;
    if (isfinite(advance))
        depth = described + advance;
    else
        (void)dmb_hole_search(&scene->hole, x, described, 2.0 * dmb_vec3_norm(u) + scene->length_scale, NULL, &depth);
    dmb_contact_place(sim, s, depth);
}

/* Places new contact points from the far end on, because each serves those before it. */
static void place_new_sites(dmb_sim *sim)
{
    for (uint32_t s = sim->scene->site_count; s-- > 0;)
        if (sim->now.site_segment[s] == DMB_NONE) place_new_site(sim, s);
}

void dmb_state_transfer_sites(dmb_sim *sim, const dmb_sim *from, int32_t what)
{
    transfer_string_sites(sim, from, what);
    transfer_inside_sites(sim, from, what);
    transfer_body_sites(sim, from, what);
    transfer_stabiliser_sites(sim, from, what);
    transfer_axial_torsional_sites(sim, from, what);
    if (what == DMB_TRANSFER_ALL) place_new_sites(sim);
}
