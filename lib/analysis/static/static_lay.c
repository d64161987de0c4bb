/* Where a search begins: strings lie on the low side of their hole, or where tension in a bend presses them. The wall
 * is then closed from the first iteration on, and Newton does not meet the softness of a string that hangs free. */
#include <math.h>

#include "analysis/static/static.h"
#include "math/vec3.h"
#include "sim/node.h"

/* [m] Penetration under a force [N] */
static double sink(const dmb_scene *scene, const dmb_site *site, double force)
{
    return pow(force / (scene->normal_law.stiffness * site->length), 1.0 / scene->normal_law.exponent);
}

static int free_sideways(const dmb_scene *scene, uint32_t node)
{
    const uint8_t *solved = scene->solved_row + scene->layout.row[node];
    return scene->layout.size[node] == DMB_NODE_FULL && solved[DMB_Y] && solved[DMB_Z];
}

/* A node lies with its first ring, where that stands at the node. */
static int lies(const dmb_scene *scene, uint32_t s)
{
    const dmb_site *site = scene->sites + s;
    const int first = s == 0 || scene->sites[s - 1].node != site->node;
    return first && site->offset == 0.0 && site->clearance >= 0.0 && free_sideways(scene, site->node);
}

/* ---- By weight --------------------------------------------------------------------------------------------------- */

static void lay_site(dmb_sim *sim, const dmb_site *site)
{
    const dmb_scene *scene = sim->scene;
    const uint32_t node = site->node;
    double *u = sim->trial.displacement + 3 * (size_t)node, x[3], point[3], tangent[3], down[3];
    double depth = scene->reference_depth[node];
    uint32_t segment = 0;
    dmb_vec3_add(scene->reference_position + 3 * (size_t)node, u, x);
    dmb_hole_project(&scene->hole, x, &depth, &segment, point, tangent);
    dmb_vec3_copy(scene->gravity, down);
    dmb_vec3_axpy(-dmb_vec3_dot(down, tangent), tangent, down);
    const double across = dmb_vec3_norm(down);
    if (!(across > 1e-9 * dmb_vec3_norm(scene->gravity))) return;
    dmb_vec3_scale((site->clearance + sink(scene, site, scene->weight_mass[node] * across)) / across, down, down);
    dmb_vec3_add(point, down, down);
    dmb_vec3_sub(down, x, down);
    dmb_vec3_add(u, down, u);
}

void dmb_static_lay_on_wall(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    if (!(scene->features & DMB_FEATURE_GRAVITY)) return;
    for (uint32_t s = 0; s < scene->site_count; s++)
        if (lies(scene, s)) lay_site(sim, scene->sites + s);
}

/* ---- By weight and tension --------------------------------------------------------------------------------------- */

/* Torque and drag of a soft string (Johancsik, Friesen, Dawson 1984): a node at this depth lies on the side to which
 * weight and tension in the bend press it, u = w + T k l, and the wall bears |u|. */
static void lay_pressed(const dmb_static_search *search, const dmb_site *site, double depth, double tension)
{
    dmb_sim *sim = search->sim;
    const dmb_scene *scene = sim->scene;
    const uint32_t node = site->node;
    double point[3], t[3], k[3], u[3];
    dmb_hole_frame(&scene->hole, depth, point, t, k);
    dmb_vec3_scale(scene->weight_mass[node], scene->gravity, u);
    dmb_vec3_axpy(-dmb_vec3_dot(u, t), t, u);
    dmb_vec3_axpy(tension * site->length, k, u);
    const double across = dmb_vec3_norm(u);
    if (across > 0.0) dmb_vec3_axpy((site->clearance + sink(scene, site, across)) / across, u, point);
    dmb_vec3_sub(point, scene->reference_position + 3 * (size_t)node, sim->trial.displacement + 3 * (size_t)node);
}

/* Stretch from the end that is held: how far each node goes along. */
static void stretch(dmb_sim *sim, const dmb_string_map *string)
{
    const dmb_scene *scene = sim->scene;
    const double *tension = sim->pull_tension;
    const uint32_t first = string->first_node, count = string->node_count;
    const int back = dmb_static_is_free_along(scene, first);
    double sum = 0.0;
    sim->pull_stretch[back ? first + count - 1 : first] = 0.0;
    for (uint32_t k = 1; k < count; k++) {
        const uint32_t i = back ? first + count - 1 - k : first + k, near = back ? i : i - 1;
        const uint32_t e = dmb_element_between(scene, near, 1);
        if (e != DMB_NONE)
            sum += (back ? -1.0 : 1.0) * tension[near] / scene->types[scene->element_type[e]].stiffness[0];
        sim->pull_stretch[i] = sum;
    }
}

void dmb_static_lay_by_pull(dmb_static_search *search)
{
    dmb_sim *sim = search->sim;
    const dmb_scene *scene = sim->scene;
    const double *tension = sim->pull_tension, *along = sim->pull_stretch;
    for (uint32_t i = 0, s = 0; i < scene->string_count; i++) {
        const dmb_string_map *string = scene->strings + i;
        const uint32_t end = string->first_node + string->node_count;
        const int known = dmb_static_tensions(sim, i);
        if (known) stretch(sim, string);
        for (; s < scene->site_count && scene->sites[s].node < end; s++) {
            const uint32_t node = scene->sites[s].node;
            if (!known || node < string->first_node || !lies(scene, s)) continue;
            const double behind = tension[node + 1 < end ? node : node - 1];
            const double before = node > string->first_node ? tension[node - 1] : behind;
            lay_pressed(search, scene->sites + s, scene->reference_depth[node] + along[node], 0.5 * (before + behind));
        }
    }
}

double dmb_static_softness(const dmb_static_search *search, const dmb_static_pull *pull, double part)
{
    const dmb_scene *scene = search->sim->scene;
    double most = 1.0, point[3], t[3], k[3];
    for (uint32_t s = 0; s < scene->site_count; s++) {
        const dmb_site *site = scene->sites + s;
        if (!lies(scene, s)) continue;
        dmb_hole_frame(&scene->hole, scene->reference_depth[site->node], point, t, k);
        const double force = pull->tension * dmb_vec3_norm(k) * site->length;
        const double depth = force > 0.0 ? sink(scene, site, force) : site->clearance;
        most = fmax(most, pow(part * site->clearance / depth, scene->normal_law.exponent));
    }
    return fmin(most, DMB_SOFTEST);
}

/* ---- Walls that are stiff for their clearance -------------------------------------------------------------------- */

int dmb_static_find_stiff_wall(const dmb_scene *scene, dmb_static_stiff_wall *out)
{
    double least = DMB_STIFF_WALL;
    for (uint32_t s = 0; s < scene->site_count; s++) {
        const dmb_site *site = scene->sites + s;
        const uint32_t e = dmb_element_between(scene, site->node, 0);
        const double force = scene->weight_mass[site->node] * dmb_vec3_norm(scene->gravity);
        if (!lies(scene, s) || e == DMB_NONE || !(force > 0.0)) continue;
        const double depth = sink(scene, site, force);
        if (!(depth < least * site->clearance)) continue;
        least = depth / site->clearance;
        *out = (dmb_static_stiff_wall){.depth = depth, .clearance = site->clearance};
        out->element = scene->types[scene->element_type[e]].length;
        out->softer = scene->normal_law.stiffness * pow(10.0 * least, scene->normal_law.exponent);
    }
    return least < DMB_STIFF_WALL;
}
