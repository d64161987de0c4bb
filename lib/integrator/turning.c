#include "integrator/turning.h"

#include "math/so3.h"
#include "system/node.h"

#define DMB_TURNING_MAX (2.0 * (DMB_PI - 2.5)) /* [rad] */

/* [rad2] square of what a node turned about its own axes in the step. */
static double turned_squared(const dmb_sim *sim, uint32_t node)
{
    const double *z = sim->increment + sim->scene->layout.row[node];
    return sim->scene->layout.size[node] == DMB_NODE_FULL ? dmb_vec3_norm_squared(z + 3) : z[1] * z[1];
}

/* z_B - R^T z_A, R the orientation of B seen from A */
static double turned_apart(const dmb_sim *sim, uint32_t a)
{
    double Ra[9], Rb[9], u[3], za[6], zb[6], world[3], apart[3];
    dmb_node_pose(sim->scene, &sim->now, a, Ra, u);
    dmb_node_pose(sim->scene, &sim->now, a + 1, Rb, u);
    dmb_node_vector(sim->scene, &sim->now, a, sim->increment, za);
    dmb_node_vector(sim->scene, &sim->now, a + 1, sim->increment, zb);
    dmb_mat3_vec(Ra, za + 3, world);
    dmb_mat3_tvec(Rb, world, apart);
    dmb_vec3_sub(zb + 3, apart, apart);
    return dmb_vec3_norm(apart);
}

uint32_t dmb_element_turned_too_far(const dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t e = 0; e < scene->element_count; e++) {
        const uint32_t a = scene->element_node[e];
        if (scene->layout.size[a] == DMB_NODE_PATH && scene->layout.size[a + 1] == DMB_NODE_PATH) continue;
        const double squares = turned_squared(sim, a) + turned_squared(sim, a + 1); /* (x + y)^2 <= 2 (x^2 + y^2) */
        if (2.0 * squares <= DMB_TURNING_MAX * DMB_TURNING_MAX) continue;           /* nearly always */
        if (!(turned_apart(sim, a) <= DMB_TURNING_MAX)) return e;
    }
    return UINT32_MAX;
}
