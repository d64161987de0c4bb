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
#include "system/constrain/constrain.h"

/* [rad] rotation of the gradient in a step, and [-] (h w)^2 of the law on the adjacent mass, above which it has a mean
 * force */
#define DMB_HOLD_TURN 0.01
#define DMB_HOLD_RESOLVED 1.0
/* [-] Change of the force in the step over the force, below which the trapezoidal rule keeps the energy and a spring
 * that turns steadily has its law's reactions. */
#define DMB_HOLD_CHANGE 1e-4

/* Nodes that a law acts on, and the points [m] of its force there. */
typedef struct law_nodes {
    uint32_t node[2];
    double x[2][3];
    int is_couple;
} law_nodes;

static law_nodes nodes_of_spring(const dmb_scene *scene, uint32_t spring)
{
    const dmb_scene_spring *s = scene->springs + spring;
    law_nodes of = {.node = {s->a.node, s->b.node}};
    dmb_vec3_copy(s->a.x, of.x[0]);
    dmb_vec3_copy(s->b.x, of.x[1]);
    return of;
}

/* Both forces of a joint act at the origin of its frame b. */
static law_nodes nodes_of_joint(const dmb_sim *sim, uint32_t joint)
{
    const dmb_scene_joint *j = sim->scene->joints + joint;
    law_nodes of = {.node = {j->a.node, j->b.node}};
    dmb_relative relative;
    dmb_joint_motion_of(sim->scene, &sim->now, joint, &relative, NULL);
    dmb_mat3_vec(j->a.M, relative.p, of.x[0]);
    dmb_vec3_add(of.x[0], j->a.x, of.x[0]);
    dmb_vec3_copy(j->b.x, of.x[1]);
    return of;
}

/* 1: the step does not resolve the law. */
static int is_stiff(const dmb_sim *sim, uint32_t u, const law_nodes *of, double h)
{
    double mobility = 0.0;
    dmb_unilateral_end end;
    dmb_bounce_end_at(sim->scene, u, sim->now.bounce_place[u], &end);
    for (int k = 0; k < 2; k++)
        if (of->node[k] != DMB_NONE)
            mobility += dmb_node_mobility(sim->scene, of->node[k], of->is_couple ? NULL : of->x[k]);
    return h * h * end.slope * mobility > DMB_HOLD_RESOLVED;
}

/* 1: the force changes in the step, at the speed of its start, or as reached. */
static int changes(const dmb_sim *sim, uint32_t u, double h, int reached)
{
    dmb_unilateral_end a, b;
    dmb_bounce_ends(sim, u, &a, &b);
    if (reached) return fabs(b.force - a.force) > DMB_HOLD_CHANGE * fmax(fabs(a.force), fabs(b.force));
    return h * a.slope * fabs(sim->now.bounce_speed[u]) > DMB_HOLD_CHANGE * fabs(a.force);
}

/* [rad] Rotation of a node in the step: at the speed of its start, or as reached. */
static double turn_of(const dmb_sim *sim, uint32_t node, double h, int reached)
{
    double z[6];
    if (!dmb_bounce_turns(sim, node)) return 0.0;
    dmb_bounce_travel(sim, node, z);
    return reached ? dmb_vec3_norm(z + 3) : h * dmb_vec3_norm(sim->now.velocity + sim->scene->layout.row[node] + 3);
}

/* [rad] Rotation of the line of a spring in the same time. */
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

static int turns(const dmb_sim *sim, const uint32_t node[2], double h, int reached)
{
    for (int k = 0; k < 2; k++)
        if (turn_of(sim, node[k], h, reached) > DMB_HOLD_TURN) return 1;
    return 0;
}

static void mark(dmb_sim *sim, uint32_t u, int turning, int reached)
{
    if (!reached || turning) sim->bounce_turns[u] = (uint8_t)turning;
}

/* Laws of a joint that is open have no force. Where one of them has a mean force, the others have it too. */
static void mark_joint(dmb_sim *sim, uint32_t joint, double h, int reached)
{
    const dmb_scene_joint *j = sim->scene->joints + joint;
    const uint32_t node[2] = {j->a.node, j->b.node};
    const int turning = sim->joint_state[joint] != DMB_JOINT_OPEN && turns(sim, node, h, reached);
    uint8_t holds[12] = {0}, changing = 0;
    law_nodes of = {.node = {DMB_NONE, DMB_NONE}};
    if (turning) of = nodes_of_joint(sim, joint);
    for (uint32_t i = 0; i < 12 && turning; i++) {
        const uint32_t u = i < 6 ? j->law + i : dmb_bounce_of_law(sim->scene, j->law + i - 6);
        of.is_couple = i % 6 >= 3;
        holds[i] = may_hold(sim->scene, u) && is_stiff(sim, u, &of, h);
        changing |= holds[i] && changes(sim, u, h, reached);
    }
    for (uint32_t i = 0; i < 12; i++) {
        const uint32_t u = i < 6 ? j->law + i : dmb_bounce_of_law(sim->scene, j->law + i - 6);
        mark(sim, u, holds[i] && changing, reached);
    }
}

static void mark_spring(dmb_sim *sim, uint32_t spring, double h, int reached)
{
    const uint32_t u = dmb_bounce_of_spring(sim->scene, spring);
    const law_nodes of = nodes_of_spring(sim->scene, spring);
    const int stiff = may_hold(sim->scene, u) && is_stiff(sim, u, &of, h) && changes(sim, u, h, reached);
    const int turning =
        stiff && (turns(sim, of.node, h, reached) || turn_of_line(sim, spring, h, reached) > DMB_HOLD_TURN);
    mark(sim, u, turning, reached);
}

void dmb_bounces_mark_turning(dmb_sim *sim, double h, int reached)
{
    const dmb_scene *scene = sim->scene;
    if (scene->unilateral_count == 0) return;
    for (uint32_t j = 0; j < scene->joint_count; j++)
        if (scene->joints[j].law != DMB_NONE) mark_joint(sim, j, h, reached);
    for (uint32_t i = 0; i < scene->spring_count; i++) mark_spring(sim, i, h, reached);
}
