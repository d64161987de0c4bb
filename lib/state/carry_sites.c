/* What the places at the wall remember, carried over from place to place. A place of the old scene may be missing in
 * the new one and the other way round: a guided rig end does not meet the wall. */
#include <math.h>
#include <string.h>

#include "state/carry_over.h"

/* [m] within which two places on one node are the same. */
#define DMB_SAME_PLACE 1e-9

#define DMB_COPY_SITE(field, width)                                                       \
    memcpy(sim->now.field + (width) * (size_t)s, from->now.field + (width) * (size_t)old, \
           (width) * sizeof *sim->now.field)

static int32_t bristles_go_on(const dmb_sim *sim, const dmb_sim *from)
{
    return dmb_scene_has_bristles(sim->scene) && dmb_scene_has_bristles(from->scene);
}

static void carry_site(dmb_sim *sim, uint32_t s, const dmb_sim *from, uint32_t old, int32_t what)
{
    if (bristles_go_on(sim, from)) {
        DMB_COPY_SITE(site_bristle, 2);
        DMB_COPY_SITE(site_sticks, 1);
    }
    if (what == DMB_CARRY_BRISTLES) return;
    DMB_COPY_SITE(site_normal, 3);
    DMB_COPY_SITE(site_depth, 1);
    DMB_COPY_SITE(site_segment, 1);
    DMB_COPY_SITE(site_penetration, 1);
    DMB_COPY_SITE(site_approach, 1);
    DMB_COPY_SITE(site_slip, 2);
}

static void carry_path_site(dmb_sim *sim, uint32_t s, const dmb_sim *from, uint32_t old, int32_t what)
{
    if (bristles_go_on(sim, from)) {
        DMB_COPY_SITE(path_bristle, 2);
        DMB_COPY_SITE(path_sticks, 1);
    }
    if (what == DMB_CARRY_ALL) DMB_COPY_SITE(path_slip, 2);
}

/* As at time 0: open, and where it is described; the restart finds it from there. */
static void begin_site(dmb_sim *sim, uint32_t s)
{
    const dmb_site *site = sim->scene->sites + s;
    const double down[3] = {0.0, 0.0, -1.0};
    memcpy(sim->now.site_normal + 3 * (size_t)s, down, sizeof down);
    sim->now.site_depth[s] = sim->scene->reference_depth[site->node] + site->offset;
    sim->now.site_segment[s] = 0;
    sim->now.site_penetration[s] = sim->now.site_approach[s] = 0.0;
    memset(sim->now.site_slip + 2 * (size_t)s, 0, 2 * sizeof(double));
    if (!dmb_scene_has_bristles(sim->scene)) return;
    memset(sim->now.site_bristle + 2 * (size_t)s, 0, 2 * sizeof(double));
    sim->now.site_sticks[s] = 0;
}

static void begin_path_site(dmb_sim *sim, uint32_t s)
{
    memset(sim->now.path_slip + 2 * (size_t)s, 0, 2 * sizeof(double));
    if (!dmb_scene_has_bristles(sim->scene)) return;
    memset(sim->now.path_bristle + 2 * (size_t)s, 0, 2 * sizeof(double));
    sim->now.path_sticks[s] = 0;
}

/* ---- Which place was it? ----------------------------------------------------------------------------------------- */

/* The node of `from` a node comes from, UINT32_MAX for none; and the way between them along body x. O(strings). */
static uint32_t old_node(const dmb_scene *scene, const dmb_scene *from, uint32_t node, double *arm)
{
    *arm = 0.0;
    for (uint32_t s = 0; s < scene->string_count; s++) {
        const dmb_string_map *map = scene->strings + s;
        if (node < map->first_node || node - map->first_node >= map->node_count) continue;
        const dmb_common_string common = dmb_common_string_of(scene, from, s);
        if (node < common.to) return UINT32_MAX;
        const uint32_t old = common.from + (node - common.to);
        *arm = dmb_carried_arm(scene, node, from, old, s);
        return old;
    }
    return from->node_count - (scene->node_count - node); /* free bodies come after the strings, in their order */
}

/* Places stand along the strings in both scenes, so one pass over both will do. */
static void carry_string_sites(dmb_sim *sim, const dmb_sim *from, int32_t what)
{
    const dmb_scene *scene = sim->scene, *was = from->scene;
    uint32_t k = 0;
    for (uint32_t s = 0; s < scene->site_count; s++) {
        const dmb_site *site = scene->sites + s;
        double arm;
        if (what == DMB_CARRY_ALL) begin_site(sim, s);
        if (dmb_model_part_index(sim->model, site->part, DMB_PART_STRING) == UINT32_MAX) continue;
        const uint32_t old = old_node(scene, was, site->node, &arm);
        const double offset = site->offset + arm;
        if (old == UINT32_MAX) continue;
        while (k < was->site_count && (was->sites[k].node < old ||
                                       (was->sites[k].node == old && was->sites[k].offset < offset - DMB_SAME_PLACE)))
            k++;
        if (k < was->site_count && was->sites[k].node == old && was->sites[k].offset <= offset + DMB_SAME_PLACE &&
            dmb_model_part_index(from->model, was->sites[k].part, DMB_PART_STRING) != UINT32_MAX)
            carry_site(sim, s, from, k, what);
    }
}

/* A rig head moves on to another place; its ring begins there anew. */
static void carry_body_sites(dmb_sim *sim, const dmb_sim *from, int32_t what)
{
    for (uint32_t b = 0; b < sim->scene->body_count; b++) {
        const dmb_body_map *body = sim->scene->bodies + b, *was = from->scene->bodies + b;
        double arm;
        if (body->site == UINT32_MAX || was->site == UINT32_MAX) continue;
        if (old_node(sim->scene, from->scene, body->node, &arm) != was->node) continue;
        if (fabs(body->arm + arm - was->arm) <= DMB_SAME_PLACE) carry_site(sim, body->site, from, was->site, what);
    }
}

static void carry_path_sites(dmb_sim *sim, const dmb_sim *from, int32_t what)
{
    uint32_t k = 0;
    for (uint32_t s = 0; s < sim->scene->path_site_count; s++) {
        double arm;
        const uint32_t old = old_node(sim->scene, from->scene, sim->scene->path_sites[s].node, &arm);
        if (what == DMB_CARRY_ALL) begin_path_site(sim, s);
        while (old != UINT32_MAX && k < from->scene->path_site_count && from->scene->path_sites[k].node < old) k++;
        if (k < from->scene->path_site_count && from->scene->path_sites[k].node == old)
            carry_path_site(sim, s, from, k, what);
    }
}

void dmb_carry_sites(dmb_sim *sim, const dmb_sim *from, int32_t what)
{
    carry_string_sites(sim, from, what);
    carry_body_sites(sim, from, what);
    carry_path_sites(sim, from, what);
}
