/* Force on an axial-torsional node by the wall, for queries: the side force balances weight and tension across the
 * axis, as in the kernels (kernel/lanes_axial_torsional_node.h). */
#include <string.h>

#include "math/vec3.h"
#include "sim/node.h"
#include "system/assemble/assemble.h"
#include "system/assemble/energy.h"

/* Side force [N], its outward unit direction and the tangent of the hole (world). */
typedef struct side_load {
    double N, direction[3], tangent[3];
} side_load;

/* Across the axis weight g m and tension in the bend T k balance the wall (eq:drilling.wall-force): N = |m (g - (g.t)
 * t) + T l k| over the length l of the contact point, outward along that vector. */
static void side_force(const dmb_scene *scene, const dmb_configuration *c, const dmb_axial_torsional_site *site,
                       double tension, side_load *out)
{
    double point[3], curvature[3], u[3], *tangent = out->tangent;
    dmb_hole_frame(&scene->hole, dmb_axial_torsional_depth(scene, c, site->node), point, tangent, curvature);
    dmb_vec3_scale(scene->weight_mass[site->node], scene->gravity, u);
    dmb_vec3_axpy(-dmb_vec3_dot(u, tangent), tangent, u);
    dmb_vec3_axpy(tension * site->length, curvature, u);
    out->N = dmb_vec3_norm(u);
    dmb_vec3_scale(out->N > 0.0 ? 1.0 / out->N : 0.0, u, out->direction);
}

void dmb_axial_torsional_site_force(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t p,
                                    dmb_site_force *out)
{
    const dmb_axial_torsional_site *site = scene->axial_torsional_sites + p;
    side_load side;
    double tension = 0.0;
    uint32_t count = 0;
    memset(out, 0, sizeof *out);
    for (uint32_t e = 0; e < 2; e++) {
        double force[12];
        const uint32_t element = dmb_element_between(scene, site->node, e);
        if (element == DMB_NONE) continue;
        dmb_element_section_force(scene, configuration, element, force);
        tension += force[0];
        count++;
    }
    if (count) tension /= count;
    side_force(scene, configuration, site, tension, &side);
    out->normal_force = side.N;
    dmb_vec3_copy(side.direction, out->normal);
    dmb_vec3_copy(side.tangent, out->tangent);
    out->closed = out->normal_force > 0.0;
    memcpy(out->slip, configuration->axial_torsional_slip + 2 * p, sizeof out->slip);
    const int32_t bristles = dmb_scene_has_bristles(scene);
    dmb_friction_law local;
    const dmb_friction_law *law = dmb_contact_friction_law(scene, configuration, scene->site_count + p, &local);
    dmb_finished_friction(
        law, bristles ? configuration->axial_torsional_bristle + scene->friction_law.states * (size_t)p : NULL,
        bristles ? configuration->axial_torsional_sticks[p] : 0, out);
}
