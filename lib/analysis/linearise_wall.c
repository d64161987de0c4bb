/* The wall as it is, left out, or closed. */
#include <math.h>

#include "analysis/linearise_parts.h"
#include "math/mat6.h"
#include "math/so3.h"

void dmb_linear_freeze(dmb_linear *linear, const dmb_linear_options *options)
{
    if (options->contact == DMB_LINEAR_CONTACT_OPEN) linear->scene.site_count = linear->scene.path_site_count = 0;
    if (options->no_friction) linear->scene.friction_law.kind = DMB_FRICTION_NONE;
    linear->work->scene = &linear->scene;
}

/* Forces that the frozen scene lacks stay as dead loads, with what they add to the stiffness by the body turning under
 * them, d(R^T f) = (R^T f)~ dtheta: the state is the same equilibrium. `before`: residual with them. */
void dmb_linear_add_dead_loads(dmb_linear *linear, const double *before)
{
    const dmb_block_layout *layout = &linear->scene.layout;
    for (uint32_t i = 0; i < layout->n; i++) {
        double w[6];
        if (layout->size[i] != DMB_NODE_FULL) continue;
        for (uint32_t k = 0; k < 6; k++)
            w[k] = linear->work->correction[layout->row[i] + k] - before[layout->row[i] + k];
        dmb_mat6_add_skew(-1.0, w, 0, 1, linear->stiffness.diagonal + layout->diag[i]);
        dmb_mat6_add_skew(-1.0, w + 3, 1, 1, linear->stiffness.diagonal + layout->diag[i]);
    }
}

/* [N/m] of the wall under a ring that carries the weight of its node, a newton at least. */
static double wall_stiffness(const dmb_scene *scene, const dmb_site *site)
{
    const double weight = fmax(scene->weight_mass[site->node] * dmb_vec3_norm(scene->gravity), 1.0);
    const double K = site->length * scene->normal_law.stiffness, exponent = scene->normal_law.exponent;
    return K * exponent * pow(weight / K, (exponent - 1.0) / exponent);
}

/* k j j^T, j = (n; offset e_x x n) in body axes: the ring may not move across the wall. */
static void add_wall(dmb_linear *linear, const dmb_site *site, double stiffness, const double normal[3])
{
    const double arm[3] = {site->offset, 0.0, 0.0};
    double j[6], R[9];
    dmb_quat_to_matrix(linear->work->trial.quaternion + 4 * (size_t)site->node, R);
    dmb_mat3_tvec(R, normal, j);
    dmb_vec3_cross(arm, j, j + 3);
    dmb_mat6_add_outer(stiffness, j, j, linear->stiffness.diagonal + linear->scene.layout.diag[site->node]);
}

double dmb_linear_wall_stiffness(const dmb_linear *linear, uint32_t s, double gap)
{
    const dmb_site *site = linear->scene.sites + s;
    const double penetration = linear->work->trial.site_penetration[s];
    if (penetration > 0.0 || site->clearance == 0.0 || penetration < -gap) return 0.0;
    return wall_stiffness(&linear->scene, site);
}

void dmb_linear_close_contacts(dmb_linear *linear, double gap)
{
    for (uint32_t s = 0; s < linear->scene.site_count; s++) {
        const double stiffness = dmb_linear_wall_stiffness(linear, s, gap);
        if (stiffness > 0.0)
            add_wall(linear, linear->scene.sites + s, stiffness, linear->work->trial.site_normal + 3 * (size_t)s);
    }
}
