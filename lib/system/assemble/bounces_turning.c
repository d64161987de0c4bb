/* Mean forces of stops and springs on nodes that turn in the step (eq:unilateral.turning, eq:unilateral.gyroscopic).
 *
 * In its own axes a node moves along H0 exp(s z), 0 <= s <= 1, so that a coordinate x changes by J z, J the mean of its
 * gradient along that way. A mean force pushes along the mean of both ends instead of along that of the end, else its
 * work is not G (x1 - x0) where the body turns. A force that acts at the end of the step only makes the speeds jump by
 * Dv; gyroscopic forces g(v), quadratic in v and without power in a motion, are then not without power over the step,
 * h/4 Dv . (g1 - g0), of the first order in the angle a step. With g1 - g(Dv)/2 in the place of g1 they are the force
 * of the mean speed, (v0 + v1)/2 . g((v0 + v1)/2) = 0. */
#include "system/assemble/bounces.h"

#include <string.h>

#include "element/rigid_mass.h"
#include "math/se3.h"
#include "math/so3.h"
#include "math/vec3.h"
#include "system/assemble/assemble.h"
#include "system/constrain/rotor.h"

int dmb_bounce_turns(const dmb_sim *sim, uint32_t node)
{
    return node != DMB_NONE && sim->scene->layout.size[node] == DMB_NODE_SIX_DOF;
}

/* ---- Free rigid bodies -------------------------------------------------------------------------------------------
 *
 * Their increments are (z, theta) of the centre of mass, in the axes of the start, and of the rotation. With
 * E = exp(theta) a wrench (f, m) on the node at the end has along them the components
 *     F = E f,   T = m - c x f,
 * at the start F = f. The mean of both ends is that of F and that of T. */

static void rotation_matrix(const dmb_sim *sim, uint32_t node, double E[9])
{
    dmb_so3_exp(sim->increment + sim->scene->layout.row[node] + 3, NULL, E);
}

static const double *centre_of(const dmb_sim *sim, uint32_t rigid)
{
    return sim->scene->free_rigids[rigid].centre;
}

void dmb_bounce_carry(const dmb_sim *sim, uint32_t node, double w[6], double *tangent)
{
    const uint32_t rigid = dmb_free_rigid_on(sim->scene, node);
    const uint32_t rotor = dmb_rotor_on(sim->scene, node);
    double E[9], f[3], m[3], block[9], moment[9];
    if (tangent != NULL) memset(tangent, 0, 18 * sizeof *tangent);
    if (rotor != DMB_NONE) dmb_rotor_carry_wrench(sim, rotor, w);
    if (rigid == DMB_NONE) return;
    const double *c = centre_of(sim, rigid);
    rotation_matrix(sim, node, E);
    dmb_mat3_tvec(E, w, f);
    dmb_vec3_sub(f, w, m);
    dmb_vec3_cross(c, m, m);
    dmb_vec3_add(w + 3, m, w + 3);
    dmb_vec3_copy(f, w);
    if (tangent == NULL) return;
    dmb_skew(f, block); /* d(E^T F) = (E^T F) x dtheta */
    dmb_skew_product(c, f, moment);
    for (int i = 0; i < 9; i++) tangent[i] = block[i], tangent[9 + i] = moment[i];
}

void dmb_bounce_travel(const dmb_sim *sim, uint32_t node, double z[6])
{
    memset(z, 0, 6 * sizeof *z);
    if (node == DMB_NONE) return;
    dmb_vec6_copy(sim->increment + sim->scene->layout.row[node], z);
    dmb_rotor_add_travel(sim, node, z);
}

/* [m, rad] J z of a node */
static double along(const dmb_sim *sim, uint32_t node, const double J[6])
{
    double z[6];
    if (node == DMB_NONE) return 0.0;
    dmb_bounce_travel(sim, node, z);
    const uint32_t rigid = dmb_free_rigid_on(sim->scene, node);
    if (rigid == DMB_NONE) return dmb_vec6_dot(J, z);
    double E[9], F[3], T[3];
    rotation_matrix(sim, node, E);
    dmb_mat3_vec(E, J, F);
    dmb_vec3_cross(centre_of(sim, rigid), J, T);
    dmb_vec3_sub(J + 3, T, T);
    return dmb_vec3_dot(F, z) + dmb_vec3_dot(T, z + 3);
}

/* [rad2] rotation in the step below which the mean of both ends is the mean */
#define DMB_TURN_LEAST 1e-12

void dmb_bounce_close_gap(const dmb_sim *sim, uint32_t u, uint32_t a, double Ja[6], uint32_t b, double Jb[6])
{
    if ((a != DMB_NONE && !dmb_bounce_turns(sim, a)) || (b != DMB_NONE && !dmb_bounce_turns(sim, b))) return;
    double za[6], zb[6];
    const double *ta = za + 3, *tb = zb + 3;
    dmb_bounce_travel(sim, a, za);
    dmb_bounce_travel(sim, b, zb);
    const double squares = dmb_vec3_norm_squared(ta) + dmb_vec3_norm_squared(tb);
    if (!(squares > DMB_TURN_LEAST)) return;
    const double moved = sim->trial.bounce_place[u] - sim->now.bounce_place[u];
    const double rest = (moved - along(sim, a, Ja) - along(sim, b, Jb)) / squares;
    for (int i = 0; i < 3; i++) {
        Ja[3 + i] += rest * ta[i];
        Jb[3 + i] += rest * tb[i];
    }
}

/* Dv, in the axes in which the node is integrated; of a free rigid body only the rotation about its centre of mass, to
 * which the translation is not coupled. */
static void jump_of(const dmb_sim *sim, uint32_t node, double jump[6])
{
    const uint32_t row = sim->scene->layout.row[node], rotor = dmb_rotor_on(sim->scene, node);
    const uint32_t rigid = dmb_free_rigid_on(sim->scene, node);
    const double *v1 = sim->trial.velocity + row, *v0 = sim->now.velocity + row;
    for (uint32_t i = 0; i < 6; i++) jump[i] = v1[i] - v0[i];
    if (rigid != DMB_NONE) dmb_vec3_cross(centre_of(sim, rigid), jump + 3, jump);
    if (rotor == DMB_NONE) return;
    const dmb_rotor_step *step = sim->rotor_step + rotor;
    for (uint32_t i = 0; i < 6; i++) jump[i] = v1[i] - step->spin[i] - step->start[i];
}

/* C <- C (0, c~; 0, I): by the rotation of a free rigid body, whose jump is (c~; I) times that of the rotation. */
static void about_centre(const double c[3], double C[36])
{
    double block[9], skew[9], product[9];
    dmb_skew(c, skew);
    for (int r = 0; r < 2; r++) {
        for (int i = 0; i < 9; i++) block[i] = C[18 * r + 6 * (i / 3) + i % 3];
        dmb_mat3_mul(block, skew, product);
        dmb_mat6_add_block(1.0, product, r, 1, C);
        dmb_mat3_zero(block);
        dmb_mat6_set_block(block, r, 0, C);
    }
}

/* `factor` times the derivative of -ad(jump)^T p by the velocity of the node. */
static void add_turning_tangent(dmb_sim *sim, const dmb_rigid_mass *mass, const double jump[6], const double p[6],
                                double factor)
{
    const uint32_t rigid = dmb_free_rigid_on(sim->scene, mass->node);
    double C[36] = {0.0};
    dmb_rigid_mass_constants c;
    dmb_rigid_mass_load(mass, 0, &c);
    dmb_rigid_mass_add_tangent(&c, jump, p, 0.0, factor, rigid == DMB_NONE ? dmb_inertia_of(sim, mass->node) : C);
    if (rigid == DMB_NONE) return;
    about_centre(centre_of(sim, rigid), C);
    dmb_mat6_axpy(1.0, C, dmb_inertia_of(sim, mass->node));
}

/* -g(Dv)/2 at the weight of the end of the step, 1/(4 g') g(Dv); `factor` times that. */
static void add_gyroscopic(dmb_evaluation *evaluation, const dmb_rigid_mass *mass, double factor)
{
    dmb_sim *sim = evaluation->sim;
    const double part = 0.25 * evaluation->own_factor;
    double jump[6], p[6], turning[6];
    jump_of(sim, mass->node, jump);
    dmb_rigid_mass_times(mass, jump, p);
    dmb_ad_transpose(jump, p, turning); /* -g(Dv) */
    for (int i = 0; i < 6; i++) turning[i] *= -factor * part;
    dmb_apply_wrench(sim, mass->node, turning);
    if (evaluation->tangent) add_turning_tangent(sim, mass, jump, p, -factor * part * evaluation->velocity_factor);
}

void dmb_bounces_add_gyroscopic(dmb_evaluation *evaluation, double factor)
{
    const dmb_scene *scene = evaluation->sim->scene;
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
        if (!dmb_bounce_turns(sim, node) || dmb_rotor_on(scene, node) != DMB_NONE) continue;
        const double turned = dmb_vec3_norm(sim->increment + row + 3);
        const double free = h * dmb_vec3_norm(sim->now.velocity + row + 3);
        if (turned > DMB_TURN_FREE + DMB_TURN_SHARE * free) return node;
    }
    return DMB_NONE;
}
