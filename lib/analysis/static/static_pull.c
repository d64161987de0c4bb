/* The pull along strings in statics that do not converge: the advice on refinement needs it. */
#include "analysis/static/static.h"
#include "math/vec3.h"
#include "sim/layout.h"
#include "sim/node.h"

static int is_free_along(const dmb_scene *scene, uint32_t node)
{
    return scene->solved_row[scene->layout.row[node] + DMB_X] != 0;
}

static void take(const dmb_scene *scene, uint32_t string, uint32_t node, double tension, dmb_static_pull *most)
{
    const uint32_t e = dmb_element_between(scene, node, 1);
    if (!(tension > most->tension) || e == DMB_NONE) return;
    const dmb_element_type *type = &scene->types[scene->element_type[e]];
    most->tension = tension;
    most->string = string;
    most->element = type->length;
    most->bending = sqrt(fmin(type->strain_stiffness[4], type->strain_stiffness[5]) / tension);
}

/* The tension of an element is the sum of the forces along beyond it, from the end that is free; the residual is their
 * negative. */
static void look_along(const dmb_sim *sim, uint32_t s, dmb_static_pull *most)
{
    const dmb_scene *scene = sim->scene;
    const uint32_t first = scene->strings[s].first_node, last = first + scene->strings[s].node_count - 1;
    double sum = 0.0;
    if (first == last || is_free_along(scene, first) == is_free_along(scene, last)) return;
    if (is_free_along(scene, last)) {
        for (uint32_t i = last; i > first; i--) {
            sum -= sim->residual[scene->layout.row[i]];
            take(scene, s, i - 1, sum, most);
        }
        return;
    }
    for (uint32_t i = first; i < last; i++) {
        sum += sim->residual[scene->layout.row[i]];
        take(scene, s, i, sum, most);
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
    if (dmb_static_begin(search) < 0 || dmb_static_evaluate(search) < 0) return 0;
    for (uint32_t s = 0; s < scene->string_count; s++)
        if (scene->layout.size[scene->strings[s].first_node] == DMB_NODE_FULL) look_along(sim, s, most);
    return most->string != DMB_NONE;
}
