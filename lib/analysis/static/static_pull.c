/* The pull along strings in a hole that bends: where it presses them, and what statics do with it. */
#include "analysis/static/static.h"
#include "sim/access.h"
#include "sim/layout.h"
#include "sim/node.h"

int dmb_static_is_free_along(const dmb_scene *scene, uint32_t node)
{
    return scene->solved_row[scene->layout.row[node] + DMB_X] != 0;
}

/* The tension of an element is the sum of the forces along beyond it, from the end that is free; the residual is their
 * negative. */
int dmb_static_tensions(dmb_sim *sim, uint32_t string)
{
    const dmb_scene *scene = sim->scene;
    const uint32_t first = scene->strings[string].first_node, last = first + scene->strings[string].node_count - 1;
    const int back = dmb_static_is_free_along(scene, last);
    double sum = 0.0;
    if (scene->layout.size[first] != DMB_NODE_FULL || first == last) return 0;
    if (dmb_static_is_free_along(scene, first) == back) return 0;
    for (uint32_t k = first; k < last; k++) {
        const uint32_t i = back ? first + last - k : k;
        sum += (back ? -1.0 : 1.0) * sim->residual[scene->layout.row[i]];
        sim->pull_tension[back ? i - 1 : i] = sum;
    }
    return 1;
}

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
        if (dmb_static_tensions(sim, s)) take(scene, s, sim->pull_tension, most);
    return most->string != DMB_NONE;
}

/* On a wall as soft as tension presses rings into it by this many times their clearance moves of that size open and
 * close none; then it gets harder by a factor with each state found. */
static const double pressed_in[] = {10.0, 1.0};
#define DMB_HARDER 10.0

static int32_t harden(dmb_static_search *search, double softness)
{
    int32_t status = DMB_OK;
    for (; status >= 0 && softness > 1.0; softness /= DMB_HARDER) {
        search->evaluation.wall_softness = softness;
        status = dmb_static_newton(search);
    }
    search->evaluation.wall_softness = 0.0;
    return status < 0 ? status : dmb_static_newton(search);
}

int32_t dmb_static_from_pull(dmb_static_search *search)
{
    int32_t status = DMB_ERR_NO_CONVERGENCE;
    for (size_t k = 0; k < sizeof pressed_in / sizeof *pressed_in; k++) {
        dmb_static_pull pull;
        const int32_t found = dmb_static_find_pull(search, &pull);
        if (found <= 0) return found < 0 ? found : status;
        search->load_steps = 1;
        dmb_static_lay_by_pull(search);
        status = harden(search, dmb_static_softness(search, &pull, pressed_in[k]));
        if (status >= 0 || dmb_is_final(status)) return status;
    }
    return status;
}
