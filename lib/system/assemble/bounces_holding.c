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
/* [-] Over the force of the law: amplitude of an oscillation at the spring's own frequency above which a law begins to
 * have mean forces, that below which it is followed again, and change in the step above which it has them in any case
 * (eq:unilateral.bias). The force is at least that of a deflection with this share of the kinetic energy of its nodes.
 */
#define DMB_HOLD_BEGIN 5e-3
#define DMB_HOLD_END 2.5e-3
#define DMB_HOLD_CHANGE 0.3
#define DMB_HOLD_SHARE 1e-3

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

static law_nodes nodes_of(const dmb_sim *sim, uint32_t u)
{
    const uint32_t law = dmb_bounce_law_of(sim->scene, u);
    if (law == DMB_NONE) return nodes_of_spring(sim->scene, u - sim->scene->law_count);
    law_nodes of = nodes_of_joint(sim, dmb_bounce_joint_of(sim->scene, law));
    of.is_couple = law % 6 >= 3;
    return of;
}

/* [-] (h w)^2 of the law on the adjacent mass. */
static double stiffness_number(const dmb_sim *sim, uint32_t u, const law_nodes *of, double h)
{
    double mobility = 0.0;
    dmb_unilateral_end end;
    dmb_bounce_end_at(sim->scene, u, sim->now.bounce_place[u], &end);
    for (int k = 0; k < 2; k++)
        if (of->node[k] != DMB_NONE)
            mobility += dmb_node_mobility(sim->scene, of->node[k], of->is_couple ? NULL : of->x[k]);
    return h * h * end.slope * mobility;
}

/* 1: the step does not resolve the law. */
static int is_stiff(const dmb_sim *sim, uint32_t u, const law_nodes *of, double h)
{
    return stiffness_number(sim, u, of, h) > DMB_HOLD_RESOLVED;
}

/* [J] Kinetic energy at the start by the adjacent mass: of the translation of the point and of the rotation. */
static double kinetic_beside(const dmb_sim *sim, uint32_t node, const double *x)
{
    const double *v = sim->now.velocity + sim->scene->layout.row[node];
    const double moves = dmb_node_mobility(sim->scene, node, x), turns = dmb_node_mobility(sim->scene, node, NULL);
    double speed[3], energy = 0.0;
    dmb_vec3_cross(v + 3, x, speed);
    dmb_vec3_add(v, speed, speed);
    if (moves > 0.0) energy += 0.5 * dmb_vec3_norm_squared(speed) / moves;
    if (turns > 0.0) energy += 0.5 * dmb_vec3_norm_squared(v + 3) / turns;
    return energy;
}

/* [N, N m] Largest force at the start, and as reached, of the springs, or stops, of a joint that are of one unit:
 * components of a force that turns pass 0. */
static double force_beside(const dmb_sim *sim, uint32_t u, int reached)
{
    const uint32_t law = dmb_bounce_law_of(sim->scene, u);
    dmb_unilateral_end a, b;
    double most = 0.0;
    for (uint32_t i = 0; i < (law == DMB_NONE ? 1 : 3); i++) {
        dmb_bounce_ends(sim, law == DMB_NONE ? u : u - law % 3 + i, &a, &b);
        most = fmax(most, fmax(fabs(a.force), reached ? fabs(b.force) : 0.0));
    }
    return most;
}

/* [N, N m] What changes of the force are compared with. */
static double force_scale(const dmb_sim *sim, uint32_t u, const law_nodes *of, double slope, int reached)
{
    double kinetic = 0.0;
    for (int k = 0; k < 2; k++)
        if (of->node[k] != DMB_NONE) kinetic += kinetic_beside(sim, of->node[k], of->x[k]);
    const double most = force_beside(sim, u, reached);
    return sqrt(most * most + DMB_HOLD_SHARE * 2.0 * slope * kinetic);
}

/* 1: the force changes in the trial by another amount than by the rates of its place at both ends, the speeds and
 * `bias`. */
static int oscillates(const dmb_sim *sim, uint32_t u, double h, double amplitude, double bias)
{
    dmb_unilateral_end a, b;
    const law_nodes of = nodes_of(sim, u);
    dmb_bounce_ends(sim, u, &a, &b);
    const double change = b.force - a.force, force = force_scale(sim, u, &of, fmax(a.slope, b.slope), 1);
    const double at_start = change - h * a.slope * (sim->now.bounce_speed[u] + bias),
                 at_end = change - h * b.slope * (sim->trial.bounce_speed[u] + bias);
    const double hw = sqrt(fmax(1.0, stiffness_number(sim, u, &of, h)));
    return fmax(fabs(at_start), fabs(at_end)) > amplitude * hw * force || fabs(change) > DMB_HOLD_CHANGE * force;
}

/* 1: it does at the end of a step, whose bias is known. */
static int still_oscillates(const dmb_sim *sim, uint32_t u, double h)
{
    return oscillates(sim, u, h, DMB_HOLD_END, sim->bounce_mode[u] == DMB_BOUNCE_OWN ? sim->bounce_bias[u] : 0.0);
}

int dmb_bounce_is_unresolved(const dmb_sim *sim, uint32_t u, double h)
{
    const uint32_t law = dmb_bounce_law_of(sim->scene, u);
    if (law == DMB_NONE) return still_oscillates(sim, u, h);
    for (uint32_t i = 0; i < 6; i++) {
        const uint32_t stop = law - law % 6 + i, spring = dmb_bounce_of_law(sim->scene, stop);
        if (sim->bounce_turns[stop] && still_oscillates(sim, stop, h)) return 1;
        if (sim->bounce_turns[spring] && still_oscillates(sim, spring, h)) return 1;
    }
    return 0;
}

/* 1: the law has a mean force from the start of the step on, by the speed there, or is to have one by the motion
 * reached. */
static int is_due(const dmb_sim *sim, uint32_t u, double h, int reached)
{
    dmb_unilateral_end a, b;
    const law_nodes of = nodes_of(sim, u);
    if (sim->bounce_age[u] < 0.0) return 1;
    if (reached) return oscillates(sim, u, h, DMB_HOLD_BEGIN, 0.0);
    dmb_bounce_ends(sim, u, &a, &b);
    return h * a.slope * fabs(sim->now.bounce_speed[u]) > DMB_HOLD_CHANGE * force_scale(sim, u, &of, a.slope, 0);
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
    uint8_t holds[12] = {0}, due = 0;
    law_nodes of = {.node = {DMB_NONE, DMB_NONE}};
    if (turning) of = nodes_of_joint(sim, joint);
    for (uint32_t i = 0; i < 12 && turning; i++) {
        const uint32_t u = i < 6 ? j->law + i : dmb_bounce_of_law(sim->scene, j->law + i - 6);
        of.is_couple = i % 6 >= 3;
        holds[i] = may_hold(sim->scene, u) && is_stiff(sim, u, &of, h);
        due |= holds[i] && is_due(sim, u, h, reached);
    }
    for (uint32_t i = 0; i < 12; i++) {
        const uint32_t u = i < 6 ? j->law + i : dmb_bounce_of_law(sim->scene, j->law + i - 6);
        mark(sim, u, holds[i] && due, reached);
    }
}

static void mark_spring(dmb_sim *sim, uint32_t spring, double h, int reached)
{
    const uint32_t u = dmb_bounce_of_spring(sim->scene, spring);
    const law_nodes of = nodes_of_spring(sim->scene, spring);
    const int stiff = may_hold(sim->scene, u) && is_stiff(sim, u, &of, h) && is_due(sim, u, h, reached);
    const int turning =
        stiff && (turns(sim, of.node, h, reached) || turn_of_line(sim, spring, h, reached) > DMB_HOLD_TURN);
    mark(sim, u, turning, reached);
}

/* Called twice in a step: at its start by the speeds there, and with `reached` by the motion of the trial, which can
 * only add laws: one that was marked keeps its mean force to the end of the step. */
void dmb_bounces_mark_turning(dmb_sim *sim, double h, int reached)
{
    const dmb_scene *scene = sim->scene;
    if (scene->unilateral_count == 0) return;
    for (uint32_t j = 0; j < scene->joint_count; j++)
        if (scene->joints[j].law != DMB_NONE) mark_joint(sim, j, h, reached);
    for (uint32_t i = 0; i < scene->spring_count; i++) mark_spring(sim, i, h, reached);
}
