/* Springs whose gradient turns in steps that do not resolve them (eq:unilateral.holding).
 *
 * A force that follows its law at the end of the step has, over the step, the work of the trapezoidal rule, which
 * differs from the energy stored by k/4 (J1 - J0) z (x1 - x0). Where the step resolves the motion this is of third
 * order; where it does not, the energy grows without bound. Such laws have a mean force in each step, also those that
 * are never open, with the numerical damping of the spectral radius. */
#include "system/assemble/bounces.h"

#include <math.h>

#include "math/vec3.h"
#include "system/assemble/assemble.h"

/* [rad] rotation of the gradient in a step, and [-] (h w)^2 of the law on the adjacent mass, above which it has a mean
 * force */
#define DMB_HOLD_TURN 0.01
#define DMB_HOLD_RESOLVED 1.0

/* Nodes that a law acts on, and the arms [m] of its force there; infinite: it is a couple. */
typedef struct law_nodes {
    uint32_t node[2];
    double arm[2];
} law_nodes;

static law_nodes nodes_of(const dmb_scene *scene, uint32_t u)
{
    const uint32_t law = dmb_bounce_law_of(scene, u);
    if (law == DMB_NONE) {
        const dmb_scene_spring *s = scene->springs + (u - scene->law_count);
        const law_nodes of = {{s->a.node, s->b.node}, {dmb_vec3_norm(s->a.x), dmb_vec3_norm(s->b.x)}};
        return of;
    }
    const dmb_scene_joint *j = scene->joints + dmb_bounce_joint_of(scene, law);
    const double couple = law % 6 >= 3 ? (double)INFINITY : 0.0;
    const law_nodes of = {{j->a.node, j->b.node},
                          {fmax(couple, dmb_vec3_norm(j->a.x)), fmax(couple, dmb_vec3_norm(j->b.x))}};
    return of;
}

/* 1: the step does not resolve the law. */
static int is_stiff(const dmb_sim *sim, uint32_t u, const law_nodes *of, double h)
{
    double mobility = 0.0;
    dmb_unilateral_end end;
    dmb_bounce_end_at(sim->scene, u, sim->now.bounce_place[u], &end);
    for (int k = 0; k < 2; k++)
        if (of->node[k] != DMB_NONE) mobility += dmb_node_mobility(sim->scene, of->node[k], of->arm[k]);
    return h * h * end.slope * mobility > DMB_HOLD_RESOLVED;
}

/* [rad] Rotation of a node in the step: at the speed of its start, or as reached. */
static double turn_of(const dmb_sim *sim, uint32_t node, double h, int reached)
{
    double z[6];
    if (!dmb_bounce_turns(sim, node)) return 0.0;
    dmb_bounce_travel(sim, node, z);
    return reached ? dmb_vec3_norm(z + 3) : h * dmb_vec3_norm(sim->now.velocity + sim->scene->layout.row[node] + 3);
}

/* [rad] Rotation of the line of a spring, likewise. */
static double turn_of_line(const dmb_sim *sim, uint32_t spring, double h, int reached)
{
    dmb_spring_motion a, b;
    double v[3], va[3], change[3];
    dmb_spring_motion_of(sim->scene, &sim->now, spring, 1, &a);
    if (reached) {
        dmb_spring_motion_of(sim->scene, &sim->trial, spring, 0, &b);
        dmb_vec3_sub(b.n, a.n, change);
        return dmb_vec3_norm(change);
    }
    dmb_mat3_vec(a.b.R, a.b.V, v);
    dmb_mat3_vec(a.a.R, a.a.V, va);
    dmb_vec3_sub(v, va, v);
    dmb_vec3_cross(a.n, v, change);
    return h * dmb_vec3_norm(change) / a.length;
}

/* 1: two-sided, or one-sided without a damper. Dampers remove what lasting contacts gain, and with a mean force those
 * that open within the step would need very small steps. */
static int may_hold(const dmb_scene *scene, uint32_t u)
{
    return dmb_bounce_holds(scene, u) || (dmb_bounce_can_open(scene, u) && dmb_bounce_damping(scene, u) == 0.0);
}

static int is_turning(const dmb_sim *sim, uint32_t u, double h, int reached)
{
    const law_nodes of = nodes_of(sim->scene, u);
    if (!may_hold(sim->scene, u) || !is_stiff(sim, u, &of, h)) return 0;
    for (int k = 0; k < 2; k++)
        if (turn_of(sim, of.node[k], h, reached) > DMB_HOLD_TURN) return 1;
    if (dmb_bounce_law_of(sim->scene, u) != DMB_NONE) return 0;
    return turn_of_line(sim, u - sim->scene->law_count, h, reached) > DMB_HOLD_TURN;
}

void dmb_bounces_mark_turning(dmb_sim *sim, double h, int reached)
{
    for (uint32_t u = 0; u < sim->scene->unilateral_count; u++)
        if (!reached || !sim->bounce_turns[u]) sim->bounce_turns[u] = (uint8_t)is_turning(sim, u, h, reached);
}
