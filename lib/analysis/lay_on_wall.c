/* A string at rest lies on the low side of its hole. Starting there, the wall is closed from the first iteration on and
 * Newton does not meet the softness of a string that hangs free. */
#include "analysis/static_state.h"
#include "math/vec3.h"

static double sink(const dmb_scene *scene, const dmb_site *site, double weight)
{
    return pow(weight / (scene->normal_law.stiffness * site->length), 1.0 / scene->normal_law.exponent);
}

static void lay_site(dmb_sim *sim, const dmb_site *site)
{
    const dmb_scene *scene = sim->scene;
    const uint32_t node = site->node;
    double *u = sim->trial.displacement + 3 * node, x[3], point[3], tangent[3], down[3];
    double depth = scene->reference_depth[node];
    uint32_t segment = 0;
    dmb_vec3_add(scene->reference_position + 3 * node, u, x);
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

static int free_sideways(const dmb_scene *scene, uint32_t node)
{
    const uint8_t *solved = scene->solved_row + scene->layout.row[node];
    return scene->layout.size[node] == DMB_NODE_FULL && solved[DMB_Y] && solved[DMB_Z];
}

void dmb_static_lay_on_wall(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    if (!(scene->features & DMB_FEATURE_GRAVITY)) return;
    for (uint32_t s = 0; s < scene->site_count; s++) {
        const dmb_site *site = scene->sites + s;
        const int first = s == 0 || scene->sites[s - 1].node != site->node;
        if (first && site->offset == 0.0 && site->clearance >= 0.0 && free_sideways(scene, site->node))
            lay_site(sim, site);
    }
}
