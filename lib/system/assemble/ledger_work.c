/* Excess of the trapezoidal rule over the first term of eq:motion.work, class by class (eq:motion.trapezoid-excess):
 *
 *     class                                  forces and speeds
 *     ------------------------------------   ----------------------------------------------------------------------
 *     friction on the hole's axis            stored with the configurations
 *     rock on bits                           stored with the configurations
 *     friction and dampers of joints         functions of the stored speeds alone
 *     dampers of springs between points      from the motion of both configurations
 *     external and material damping          closed form, C (v1 - v0)^2 h/4
 *     friction of six-DOF contact points     from both configurations, within ten steps of their touch
 *
 * The normal force of the wall stays with the trapezoidal rule, so that the loss of the scheme in contacts that open
 * and close within steps is visible in the balance. */
#include "system/assemble/ledger.h"

#include <string.h>

#include "force/spring_law.h"
#include "force/weight_and_damping.h"
#include "sim/node.h"
#include "system/assemble/assemble.h"
#include "system/assemble/bounces.h"

/* Sum over `count` forces, four at a time. */
static double excess_of(const dmb_ledger_parts *parts, size_t count, const double *f0, const double *s0,
                        const double *f1, const double *s1)
{
    double sum[4] = {0.0, 0.0, 0.0, 0.0};
    size_t i = 0;
    for (; i + 4 <= count; i += 4)
        for (size_t k = 0; k < 4; k++)
            sum[k] += (parts->first * f0[i + k] - parts->second * f1[i + k]) * (s0[i + k] - s1[i + k]);
    for (; i < count; i++) sum[0] += (parts->first * f0[i] - parts->second * f1[i]) * (s0[i] - s1[i]);
    return 0.5 * ((sum[0] + sum[1]) + (sum[2] + sum[3]));
}

double dmb_ledger_friction_excess(const dmb_sim *sim, const dmb_ledger_parts *parts)
{
    const dmb_configuration *a = &sim->now, *b = &sim->trial;
    if (sim->scene->friction_law.kind == DMB_FRICTION_NONE || dmb_is_quasi_static(a)) return 0.0;
    return excess_of(parts, 2 * (size_t)sim->scene->axial_torsional_site_count, a->axial_torsional_friction,
                     a->axial_torsional_slip, b->axial_torsional_friction, b->axial_torsional_slip);
}

double dmb_ledger_rock_excess(const dmb_sim *sim, const dmb_ledger_parts *parts)
{
    const dmb_configuration *a = &sim->now, *b = &sim->trial;
    return excess_of(parts, 4 * (size_t)sim->scene->bit_count, a->bit_force, a->bit_speed, b->bit_force, b->bit_speed);
}

/* Damper and friction of a law, both functions of the speed alone. */
static void law_excess(const dmb_joint_law *law, const dmb_ledger_parts *parts, double s0, double s1, double *friction,
                       double *damping)
{
    dmb_joint_force a, b;
    if (s0 == s1) return;
    dmb_joint_force_at(law, 0.0, s0, &a);
    dmb_joint_force_at(law, 0.0, s1, &b);
    *friction += dmb_ledger_excess(parts, a.friction, s0, b.friction, s1);
    *damping += dmb_ledger_excess(parts, a.damper, s0, b.damper, s1);
}

void dmb_ledger_joint_excess(const dmb_sim *sim, const dmb_ledger_parts *parts, double *friction, double *damping)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t j = 0; scene->law_count > 0 && j < scene->joint_count; j++) {
        const dmb_scene_joint *joint = scene->joints + j;
        if (joint->law == DMB_NONE || sim->joint_state[j] == DMB_JOINT_OPEN) continue;
        for (uint32_t i = joint->law; i < joint->law + 6; i++)
            law_excess(scene->laws + i, parts, sim->now.law_speed[i], sim->trial.law_speed[i], friction, damping);
    }
}

/* Dampers of two-sided springs; one-sided springs are integrated by bounces. */
double dmb_ledger_spring_excess(const dmb_sim *sim, const dmb_ledger_parts *parts)
{
    const dmb_scene *scene = sim->scene;
    double sum = 0.0;
    for (uint32_t i = 0; i < scene->spring_count; i++) {
        dmb_spring_motion a, b;
        if (scene->springs[i].law.acts != DMB_SPRING_BOTH || !(scene->springs[i].law.damping > 0.0)) continue;
        dmb_spring_motion_of(scene, &sim->now, i, 1, &a);
        dmb_spring_motion_of(scene, &sim->trial, i, 1, &b);
        sum += dmb_ledger_excess(parts, -a.force.damper, a.rate, -b.force.damper, b.rate);
    }
    return sum;
}

/* K d'^2 tau/L of the change of d' over the step, along and about the axis, in which elements are stiff. Bending is
 * left with the trapezoidal rule. */
static double element_loss(const dmb_sim *sim, uint32_t e)
{
    const dmb_block_layout *layout = &sim->scene->layout;
    const dmb_element_type *type = sim->scene->types + sim->scene->element_type[e];
    const uint32_t a = sim->scene->element_node[e], ra = layout->row[a], rb = layout->row[a + 1];
    const uint32_t ta = ra + (layout->size[a] == DMB_NODE_AXIAL_TORSIONAL ? 1 : 3);
    const uint32_t tb = rb + (layout->size[a + 1] == DMB_NODE_AXIAL_TORSIONAL ? 1 : 3);
    const double *v0 = sim->now.velocity, *v1 = sim->trial.velocity;
    const double stretch = (v1[rb] - v1[ra]) - (v0[rb] - v0[ra]), twist = (v1[tb] - v1[ta]) - (v0[tb] - v0[ta]);
    return type->damping_time * (type->stiffness[0] * stretch * stretch + type->stiffness[3] * twist * twist);
}

/* v^T C v of the change of v over the step. */
static double node_loss(const dmb_sim *sim, uint32_t node)
{
    const uint32_t row = sim->scene->layout.row[node];
    const double *c = sim->scene->node_damping + 5 * (size_t)node;
    double v[6], force[6];
    if (sim->scene->layout.size[node] == DMB_NODE_AXIAL_TORSIONAL) {
        for (uint32_t i = 0; i < 2; i++) v[i] = sim->trial.velocity[row + i] - sim->now.velocity[row + i];
        return c[0] * v[0] * v[0] + c[1] * v[1] * v[1];
    }
    for (uint32_t i = 0; i < 6; i++) v[i] = sim->trial.velocity[row + i] - sim->now.velocity[row + i];
    dmb_damping_force(c, v, force);
    return -dmb_vec6_dot(force, v);
}

/* A linear damper dissipates C ((v0 + v1)/2)^2 h; the trapezoidal rule gives C (v1 - v0)^2 h/4 more. */
double dmb_ledger_damping_excess(const dmb_sim *sim, const dmb_ledger_parts *parts)
{
    const dmb_scene *scene = sim->scene;
    double sum = 0.0;
    for (uint32_t e = 0; scene->damped && e < scene->element_count; e++) sum += element_loss(sim, e);
    for (uint32_t i = 0; scene->features & DMB_FEATURE_DAMPING && i < scene->node_count; i++) sum += node_loss(sim, i);
    return -0.25 * (parts->first + parts->second) * sum;
}

/* Friction force of a contact point as used by the step. */
static void friction_of(const dmb_sim *sim, const dmb_configuration *c, uint32_t s, dmb_site_force *f)
{
    dmb_site_force_of(sim->scene, c, s, f);
    if (f->penetration > 0.0)
        dmb_site_weighted_force(sim, c, s, f);
    else
        f->friction[0] = f->friction[1] = 0.0;
}

/* released_power is the part of the power at the start that the trapezoidal rule counts after the opening of contacts.
 */
double dmb_ledger_wall_excess(const dmb_sim *sim, const dmb_ledger_parts *parts, int released)
{
    double sum = released ? parts->first * *sim->released_power : 0.0;
    if (sim->scene->friction_law.kind == DMB_FRICTION_NONE || dmb_is_quasi_static(&sim->now)) return sum;
    for (uint32_t s = 0; s < sim->scene->site_count; s++) {
        dmb_site_force a, b;
        if (!(sim->trial.site_penetration[s] > 0.0) || (double)sim->site_age[s] >= DMB_BOUNCE_STEPS) continue;
        if (dmb_site_has_mean(sim, s)) continue; /* the work of a mean force is that of the step */
        friction_of(sim, &sim->now, s, &a);
        friction_of(sim, &sim->trial, s, &b);
        for (int i = 0; i < 2; i++) sum += dmb_ledger_excess(parts, a.friction[i], a.slip[i], b.friction[i], b.slip[i]);
    }
    return sum;
}

void dmb_ledger_copy_forces(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    dmb_configuration *a = &sim->now;
    const dmb_configuration *b = &sim->trial;
    if (scene->friction_law.kind != DMB_FRICTION_NONE)
        memcpy(a->axial_torsional_friction, b->axial_torsional_friction,
               2 * scene->axial_torsional_site_count * sizeof(double));
    memcpy(a->bit_force, b->bit_force, 4 * scene->bit_count * sizeof(double));
    memcpy(a->bit_speed, b->bit_speed, 4 * scene->bit_count * sizeof(double));
    memcpy(a->law_speed, b->law_speed, scene->law_count * sizeof(double));
}
