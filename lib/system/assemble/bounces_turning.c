/* Mean forces of stops and springs on nodes that turn in the step (eq:unilateral.turning, eq:unilateral.gyroscopic).
 *
 * In its own axes a node moves along H0 exp(s z), 0 <= s <= 1, so that a coordinate x changes by J z, J the mean of its
 * gradient along that way. A mean force pushes along the mean of both ends instead of along that of the end, else its
 * work is not G (x1 - x0) where the body turns. A force that acts at the end of the step only makes the speeds jump by
 * Dv; gyroscopic forces g(v), quadratic in v and without power in a motion, are then not without power over the step,
 * h/4 Dv . (g1 - g0), of the first order in the angle a step. With g1 - g(Dv)/2 in the place of g1 they are the force
 * of the mean speed, (v0 + v1)/2 . g((v0 + v1)/2) = 0. */
#include "system/assemble/bounces.h"

#include "element/rigid_mass.h"
#include "math/se3.h"
#include "math/vec3.h"
#include "system/assemble/assemble.h"
#include "system/constrain/rotor.h"

int dmb_bounce_turns(const dmb_sim *sim, uint32_t node)
{
    return node != DMB_NONE && sim->scene->layout.size[node] == DMB_NODE_SIX_DOF && sim->scene->free_rigid_count == 0 &&
           dmb_rotor_on(sim->scene, node) == DMB_NONE;
}

/* [m, rad] J z of a node */
static double along(const dmb_sim *sim, uint32_t node, const double J[6])
{
    return node == DMB_NONE ? 0.0 : dmb_vec6_dot(J, sim->increment + sim->scene->layout.row[node]);
}

static const double *rotation_of(const dmb_sim *sim, uint32_t node)
{
    static const double none[3] = {0.0};
    return node == DMB_NONE ? none : sim->increment + sim->scene->layout.row[node] + 3;
}

/* [rad2] rotation in the step below which the mean of both ends is the mean */
#define DMB_TURN_LEAST 1e-12

void dmb_bounce_close_gap(const dmb_sim *sim, uint32_t u, uint32_t a, double Ja[6], uint32_t b, double Jb[6])
{
    if ((a != DMB_NONE && !dmb_bounce_turns(sim, a)) || (b != DMB_NONE && !dmb_bounce_turns(sim, b))) return;
    const double *ta = rotation_of(sim, a), *tb = rotation_of(sim, b);
    const double squares = dmb_vec3_norm_squared(ta) + dmb_vec3_norm_squared(tb);
    if (!(squares > DMB_TURN_LEAST)) return;
    const double moved = sim->trial.bounce_place[u] - sim->now.bounce_place[u];
    const double rest = (moved - along(sim, a, Ja) - along(sim, b, Jb)) / squares;
    for (int i = 0; i < 3; i++) {
        Ja[3 + i] += rest * ta[i];
        Jb[3 + i] += rest * tb[i];
    }
}

/* Dv, in the axes in which the node is integrated. */
static void jump_of(const dmb_sim *sim, uint32_t node, double jump[6])
{
    const uint32_t row = sim->scene->layout.row[node], rotor = dmb_rotor_on(sim->scene, node);
    const double *v1 = sim->trial.velocity + row, *v0 = sim->now.velocity + row;
    for (uint32_t i = 0; i < 6; i++) jump[i] = v1[i] - v0[i];
    if (rotor == DMB_NONE) return;
    const dmb_rotor_step *step = sim->rotor_step + rotor;
    for (uint32_t i = 0; i < 6; i++) jump[i] = v1[i] - step->spin[i] - step->start[i];
}

/* -g(Dv)/2 at the weight of the end of the step, 1/(4 g') g(Dv); `factor` times that. */
static void add_gyroscopic(dmb_evaluation *evaluation, const dmb_rigid_mass *mass, double factor)
{
    dmb_sim *sim = evaluation->sim;
    const double part = 0.25 * evaluation->own_factor;
    double jump[6], p[6], turning[6];
    dmb_rigid_mass_constants c;
    jump_of(sim, mass->node, jump);
    dmb_rigid_mass_times(mass, jump, p);
    dmb_ad_transpose(jump, p, turning); /* -g(Dv) */
    for (int i = 0; i < 6; i++) turning[i] *= -factor * part;
    dmb_apply_wrench(sim, mass->node, turning);
    if (!evaluation->tangent) return;
    dmb_rigid_mass_load(mass, 0, &c);
    dmb_rigid_mass_add_tangent(&c, jump, p, 0.0, -factor * part * evaluation->velocity_factor,
                               dmb_inertia_of(sim, mass->node));
}

void dmb_bounces_add_gyroscopic(dmb_evaluation *evaluation, double factor)
{
    const dmb_scene *scene = evaluation->sim->scene;
    if (scene->free_rigid_count > 0) return;
    for (uint32_t i = 0; i < scene->rigid_mass_count; i++)
        if (scene->layout.size[scene->rigid_masses[i].node] == DMB_NODE_SIX_DOF)
            add_gyroscopic(evaluation, scene->rigid_masses + i, factor);
}

void dmb_bounces_turn(dmb_evaluation *evaluation)
{
    if (evaluation->own_factor > 0.0 && *evaluation->sim->laws_bounce) dmb_bounces_add_gyroscopic(evaluation, 1.0);
}

/* [rad], [-] rotation in a step over that of the speed at its start */
#define DMB_TURN_FREE 1.0
#define DMB_TURN_SHARE 2.0

uint32_t dmb_bounces_overturn(const dmb_sim *sim, double h)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; *sim->laws_bounce && i < scene->rigid_mass_count; i++) {
        const uint32_t node = scene->rigid_masses[i].node, row = scene->layout.row[node];
        if (!dmb_bounce_turns(sim, node)) continue;
        const double turned = dmb_vec3_norm(sim->increment + row + 3);
        const double free = h * dmb_vec3_norm(sim->now.velocity + row + 3);
        if (turned > DMB_TURN_FREE + DMB_TURN_SHARE * free) return node;
    }
    return DMB_NONE;
}
