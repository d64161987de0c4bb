/* Initial guess: strings lie on the low side of their hole, or on the side to which their tension presses them in a
 * curved hole. Contacts are then closed from the first iteration on, and Newton does not encounter the softness of a
 * string that hangs freely. */
#include <math.h>

#include "analysis/linear/linear.h"
#include "analysis/static/static.h"
#include "math/so3.h"
#include "math/vec3.h"
#include "sim/layout.h"
#include "sim/node.h"
#include "system/assemble/drives.h"
#include <string.h>

/* [m] Penetration under a force [N] */
static double sink(const dmb_scene *scene, const dmb_site *site, double depth, double force)
{
    const dmb_normal_law law = dmb_normal_law_at(&scene->hole, &scene->normal_law, depth);
    return pow(force / (law.stiffness * site->length), 1.0 / law.exponent);
}

/* 1: the initial guess places the node by this ring, the first ring of its node, at the node itself. */
static int lies(const dmb_scene *scene, uint32_t s)
{
    const dmb_site *site = scene->sites + s;
    const int first = s == 0 || scene->sites[s - 1].node != site->node;
    return first && !dmb_is_inside(scene, s) && site->offset == 0.0 && site->clearance >= 0.0 &&
           dmb_static_is_free_across(scene, site->node);
}

/* ---- By weight --------------------------------------------------------------------------------------------------- */

/* Places the node on the low side of its cross-section of the hole, with the penetration that its weight across causes.
 * In a vertical hole (less than 1e-9 of the weight across) no side is low, and the node stays. */
static void guess_site(dmb_sim *sim, const dmb_site *site)
{
    const dmb_scene *scene = sim->scene;
    const uint32_t node = site->node;
    double *u = sim->trial.displacement + 3 * (size_t)node, x[3], point[3], tangent[3], down[3];
    double depth;
    dmb_vec3_add(scene->reference_position + 3 * (size_t)node, u, x);
    uint32_t segment = dmb_node_segment(scene, &sim->now, node, 0.0, x);
    dmb_hole_project(&scene->hole, x, &depth, &segment, point, tangent);
    dmb_vec3_copy(scene->gravity, down);
    dmb_vec3_axpy(-dmb_vec3_dot(down, tangent), tangent, down);
    const double across = dmb_vec3_norm(down);
    if (!(across > 1e-9 * dmb_vec3_norm(scene->gravity))) return;
    const double in = sink(scene, site, depth, scene->weight_mass[node] * across);
    dmb_vec3_scale((dmb_site_clearance(scene, site, depth) + in) / across, down, down);
    dmb_vec3_add(point, down, down);
    dmb_vec3_sub(down, x, down);
    dmb_vec3_add(u, down, u);
    dmb_vec3_scale(-1.0, down, down);
    dmb_static_stay_along(sim, node, down);
}

void dmb_static_guess_on_wall(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    if (!(scene->features & DMB_FEATURE_GRAVITY)) return;
    for (uint32_t s = 0; s < scene->site_count; s++)
        if (lies(scene, s)) guess_site(sim, scene->sites + s);
}

/* ---- Tension of strings ------------------------------------------------------------------------------------------ */

/* The tension of an element is the sum of the axial forces beyond it, from the free end; the residual is their
 * negative. */
int dmb_static_tensions(dmb_sim *sim, uint32_t string)
{
    const dmb_scene *scene = sim->scene;
    const uint32_t first = scene->strings[string].first_node, last = first + scene->strings[string].node_count - 1;
    const int back = dmb_static_is_free_along(scene, last);
    double sum = 0.0;
    if (scene->layout.size[first] != DMB_NODE_SIX_DOF || first == last) return 0;
    if (dmb_static_is_free_along(scene, first) == back) return 0;
    for (uint32_t k = first; k < last; k++) {
        const uint32_t i = back ? first + last - k : k;
        sum += (back ? -1.0 : 1.0) * sim->residual[scene->layout.row[i]];
        dmb_static_pulls(sim)[back ? i - 1 : i] = sum;
    }
    return 1;
}

/* Largest tension of all strings, with sqrt(EI/T) of its element by the softer bending direction. */
static void take(const dmb_scene *scene, uint32_t string, const double *tension, dmb_static_pull *most)
{
    const dmb_string_map *map = scene->strings + string;
    for (uint32_t i = map->first_node; i + 1 < map->first_node + map->node_count; i++) {
        const uint32_t e = dmb_element_between(scene, i, 1);
        if (!(tension[i] > most->tension) || e == DMB_NONE) continue;
        const dmb_element_type *type = &scene->types[scene->element_type[e]];
        most->tension = tension[i];
        most->string = string;
        most->element = type->length;
        most->bending = sqrt(fmin(type->strain_stiffness[4], type->strain_stiffness[5]) / tension[i]);
    }
}

/* The tension is that of the starting pose, by weight, loads and drives without stretch or friction. Only in curved
 * holes and without joints. A failed evaluation counts as "no tension", unless its error is final. */
int32_t dmb_static_find_pull(dmb_static_search *search, dmb_static_pull *most)
{
    dmb_sim *sim = search->sim;
    const dmb_scene *scene = sim->scene;
    *most = (dmb_static_pull){0.0, 0.0, 0.0, DMB_NONE};
    if (scene->site_count == 0 || scene->cluster_count > 0 || dmb_hole_is_straight(&scene->hole)) return 0;
    dmb_state_restore(sim);
    search->evaluation.load_factor = 1.0;
    search->evaluation.tangent = 0;
    search->evaluation.extrapolated = 0;
    int32_t status = dmb_static_begin(search);
    if (status >= 0) status = dmb_static_evaluate(search);
    search->evaluation.tangent = 1;
    if (status < 0) return dmb_is_final(status) ? status : 0;
    for (uint32_t s = 0; s < scene->string_count; s++)
        if (dmb_static_tensions(sim, s)) take(scene, s, dmb_static_pulls(sim), most);
    return most->string != DMB_NONE;
}

/* ---- By weight and tension --------------------------------------------------------------------------------------- */

/* Soft-string torque and drag (Johancsik, Friesen, Dawson 1984; eq:drilling.soft-string): a node at this depth lies on
 * the side to which weight and tension in the curved hole press it, u = w + T k l (eq:static.pull), and the wall
 * carries |u|. */
static void guess_pressed(const dmb_static_search *search, const dmb_site *site, double depth, double tension)
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
    const double clearance = dmb_site_clearance(scene, site, depth);
    if (across > 0.0) dmb_vec3_axpy((clearance + sink(scene, site, depth, across)) / across, u, point);
    double *moved = sim->trial.displacement + 3 * (size_t)node, back[3];
    dmb_vec3_sub(point, scene->reference_position + 3 * (size_t)node, point);
    dmb_vec3_sub(moved, point, back);
    dmb_vec3_copy(point, moved);
    dmb_static_stay_along(sim, node, back);
}

/* Elongation from the constrained end: axial displacement of each node [m]. */
static void stretch(dmb_sim *sim, const dmb_string_map *string)
{
    const dmb_scene *scene = sim->scene;
    const double *tension = dmb_static_pulls(sim);
    double *along = dmb_static_stretches(sim);
    const uint32_t first = string->first_node, count = string->node_count;
    const int back = dmb_static_is_free_along(scene, first);
    double sum = 0.0;
    along[back ? first + count - 1 : first] = 0.0;
    for (uint32_t k = 1; k < count; k++) {
        const uint32_t i = back ? first + count - 1 - k : first + k, near = back ? i : i - 1;
        const uint32_t e = dmb_element_between(scene, near, 1);
        if (e != DMB_NONE)
            sum += (back ? -1.0 : 1.0) * tension[near] / scene->types[scene->element_type[e]].stiffness[0];
        along[i] = sum;
    }
}

void dmb_static_guess_by_pull(dmb_static_search *search)
{
    dmb_sim *sim = search->sim;
    const dmb_scene *scene = sim->scene;
    const double *tension = dmb_static_pulls(sim), *along = dmb_static_stretches(sim);
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
            guess_pressed(search, scene->sites + s, scene->reference_depth[node] + along[node],
                          0.5 * (before + behind));
        }
    }
}

/* The penetration under T k l grows as the stiffness to the power -1/p. For each ring the factor is (part clearance /
 * penetration)^p; the largest one is returned, within 1 .. DMB_SOFTEST. */
double dmb_static_softness(const dmb_static_search *search, const dmb_static_pull *pull, double part)
{
    const dmb_scene *scene = search->sim->scene;
    double most = 1.0, point[3], t[3], k[3];
    for (uint32_t s = 0; s < scene->site_count; s++) {
        const dmb_site *site = scene->sites + s;
        if (!lies(scene, s)) continue;
        const double place = scene->reference_depth[site->node];
        dmb_hole_frame(&scene->hole, place, point, t, k);
        const double force = pull->tension * dmb_vec3_norm(k) * site->length;
        const double depth = force > 0.0 ? sink(scene, site, place, force) : site->clearance;
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
        const double depth = sink(scene, site, scene->reference_depth[site->node], force);
        if (!(depth < least * site->clearance)) continue;
        least = depth / site->clearance;
        *out = (dmb_static_stiff_wall){.depth = depth, .clearance = site->clearance};
        out->element = scene->types[scene->element_type[e]].length;
        out->softer = scene->normal_law.stiffness * pow(10.0 * least, scene->normal_law.exponent);
    }
    return least < DMB_STIFF_WALL;
}

/* Starts from the accepted state `now`: a strategy that failed leaves nothing in the next one. */
int32_t dmb_static_begin(dmb_static_search *search)
{
    dmb_sim *sim = search->sim;
    dmb_configuration_copy(sim, &sim->now, &sim->trial);
    memset(sim->increment, 0, sim->scene->row_count * sizeof(double));
    int32_t status = dmb_system_prescribe(&search->evaluation);
    if (status >= 0 && search->options->lay_on_wall) dmb_static_guess_on_wall(sim);
    if (status < 0 || sim->scene->cluster_count == 0) return status;
    sim->reduced_mode->row = DMB_NONE;
    return dmb_static_settle(search);
}
