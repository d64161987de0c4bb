#include "system/contact_slope.h"

#include <string.h>

#include "force/contact_math.h"
#include "system/wall_contact.h"

void dmb_contact_slope_of(const dmb_scene *scene, const dmb_configuration *c, uint32_t site, dmb_contact_slope *out)
{
    const int full = site < scene->site_count;
    double friction[2];
    dmb_site_force f;
    memset(out, 0, sizeof *out);
    if (full)
        dmb_site_force_of(scene, c, site, &f);
    else
        dmb_path_site_force_of(scene, c, site - scene->site_count, &f);
    if (!f.closed) return;
    if (full) {
        const double length = scene->sites[site].length;
        double force;
        dmb_normal_force(&scene->normal_law, fmax(f.penetration, DMB_CONTACT_PENETRATION), f.rate,
                         c->site_approach[site], &force, &out->normal_by_depth, &out->normal_by_rate);
        out->normal_by_depth *= length;
        out->normal_by_rate *= length;
    }
    if (scene->friction_law.kind == DMB_FRICTION_NONE) return;
    dmb_friction_smooth(&scene->friction_law, f.normal_force, f.slip, friction, out->friction_by_slip,
                        out->friction_by_normal);
}

uint32_t dmb_contact_node(const dmb_scene *scene, uint32_t site)
{
    return site < scene->site_count ? scene->sites[site].node : scene->path_sites[site - scene->site_count].node;
}
