#include "system/contact_slope.h"

#include <string.h>

#include "force/contact_math.h"
#include "math/so3.h"
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

/* ---- Friction of a ring that slips ------------------------------------------------------------------------------- */

/* Closest point of the hole's axis to a ring, and the frame there. */
static void frame_of(const dmb_evaluation *evaluation, uint32_t s, dmb_contact_frame *f)
{
    const dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    const dmb_site *site = scene->sites + s;
    double R[9], x[3], at[3], tangent[3], depth = sim->trial.site_depth[s];
    uint32_t segment = sim->trial.site_segment[s];
    dmb_quat_to_matrix(sim->trial.quaternion + 4 * (size_t)site->node, R);
    dmb_vec3_add(scene->reference_position + 3 * (size_t)site->node, sim->trial.displacement + 3 * (size_t)site->node,
                 x);
    for (int i = 0; i < 3; i++) x[i] += R[3 * i] * site->offset;
    dmb_hole_project(&scene->hole, x, &depth, &segment, at, tangent);
    f->radius = site->radius;
    dmb_contact_frame_at(R, sim->trial.site_normal + 3 * (size_t)s, tangent, f);
}

/* Forces along and around for a unit of normal force; 0: it does not slip. */
static int friction_by_normal(const dmb_evaluation *evaluation, uint32_t s, double radius, double by_normal[2])
{
    const dmb_sim *sim = evaluation->sim;
    dmb_friction_law law = sim->scene->friction_law;
    double v[2] = {evaluation->slip[0], radius * evaluation->slip[1]}, force[2], by_speed[4];
    if (evaluation->dynamic) memcpy(v, sim->trial.site_slip + 2 * (size_t)s, sizeof v);
    if (law.kind == DMB_FRICTION_NONE || (v[0] == 0.0 && v[1] == 0.0)) return 0;
    if (evaluation->steady && dmb_scene_has_bristles(sim->scene)) law = dmb_sliding_law(&law);
    dmb_friction_smooth(&law, 1.0, v, force, by_speed, by_normal);
    return 1;
}

int dmb_contact_friction_by_normal(const dmb_evaluation *evaluation, uint32_t site, double n[3], double f[6])
{
    const dmb_site *ring = evaluation->sim->scene->sites + site;
    double by_normal[2];
    dmb_contact_frame frame;
    if (!(evaluation->sim->trial.site_penetration[site] > 0.0)) return 0;
    if (!friction_by_normal(evaluation, site, ring->radius, by_normal)) return 0;
    frame_of(evaluation, site, &frame);
    for (int i = 0; i < 3; i++) {
        n[i] = frame.n[i];
        f[i] = -(by_normal[0] * frame.t[i] + by_normal[1] * frame.b[i]);
        f[3 + i] = -(by_normal[0] * frame.turn_t[i] + by_normal[1] * frame.turn_b[i]);
    }
    f[4] -= ring->offset * f[2]; /* its moment about the node */
    f[5] += ring->offset * f[1];
    return 1;
}
