/* Axial-torsional nodes lie on the wall (Johancsik, Friesen, Dawson 1984): the side force balances weight and tension
 * in a curved hole across the axis, N = | w_across + T kappa n | l, and friction acts along and around the axis. */
#include <string.h>

#include "element/beam.h"
#include "math/vec3.h"
#include "sim/node.h"
#include "system/assemble/assemble.h"
#include "system/assemble/energy.h"
#include "system/assemble/evaluation.h"

/* [m] Elongation of an element at the trial; stored by a mixed element. */
static double stretch_of(const dmb_sim *sim, uint32_t element)
{
    const dmb_scene *scene = sim->scene;
    const dmb_element_type *type = scene->types + scene->element_type[element];
    const uint32_t a = scene->element_node[element];
    const double *u = sim->trial.displacement + 3 * a;
    if (scene->layout.size[a] != DMB_NODE_AXIAL_TORSIONAL || scene->layout.size[a + 1] != DMB_NODE_AXIAL_TORSIONAL)
        return dmb_beam_stretch(type, sim->element_strain + 6 * (size_t)element);
    return (u[3] - u[0]) + (type->length - type->rest[0]);
}

/* Mean tension of the elements on both sides of a node [N]. */
static double tension_at(const dmb_sim *sim, uint32_t node)
{
    const dmb_scene *scene = sim->scene;
    double sum = 0.0;
    uint32_t count = 0;
    for (uint32_t e = 0; e < 2; e++) {
        const uint32_t element = dmb_element_between(scene, node, e);
        if (element == DMB_NONE) continue;
        sum += scene->types[scene->element_type[element]].stiffness[0] * stretch_of(sim, element);
        count++;
    }
    return count ? sum / count : 0.0;
}

/* Side force [N], its outward unit direction and the tangent of the hole (world), its derivative by tension [-]. */
typedef struct side {
    double N, direction[3], tangent[3], by_tension;
} side;

static void side_force(const dmb_scene *scene, const dmb_configuration *c, const dmb_axial_torsional_site *site,
                       double tension, double load_factor, side *out)
{
    double point[3], curvature[3], u[3], *tangent = out->tangent;
    dmb_hole_frame(&scene->hole, dmb_axial_torsional_depth(scene, c, site->node), point, tangent, curvature);
    dmb_vec3_scale(load_factor * scene->weight_mass[site->node], scene->gravity, u);
    dmb_vec3_axpy(-dmb_vec3_dot(u, tangent), tangent, u);
    dmb_vec3_axpy(tension * site->length, curvature, u);
    out->N = dmb_vec3_norm(u);
    dmb_vec3_scale(out->N > 0.0 ? 1.0 / out->N : 0.0, u, out->direction);
    out->by_tension = site->length * dmb_vec3_dot(out->direction, curvature);
}

/* Tension of an element grows with the advance of its far node: adds dF/dT dT/ds to the rows of the node. */
static void add_tension_tangent(dmb_sim *sim, uint32_t node, const double dF_dT[2])
{
    const dmb_scene *scene = sim->scene;
    const uint32_t before = dmb_element_between(scene, node, 0), after = dmb_element_between(scene, node, 1);
    const double share = before != DMB_NONE && after != DMB_NONE ? 0.5 : 1.0;
    const dmb_block_layout *layout = &scene->layout;
    for (uint32_t k = 0; k < 2; k++) {
        const double d = -share * dF_dT[k]; /* of the residual */
        if (before != DMB_NONE && layout->size[node - 1] == DMB_NODE_AXIAL_TORSIONAL) {
            const double stiffness = scene->types[scene->element_type[before]].stiffness[0];
            dmb_stiffness_of(sim, node)[2 * k] += d * stiffness;
            sim->stiffness_lower[layout->link[node - 1] + 2 * k] -= d * stiffness;
        }
        if (after != DMB_NONE && layout->size[node + 1] == DMB_NODE_AXIAL_TORSIONAL) {
            const double stiffness = scene->types[scene->element_type[after]].stiffness[0];
            dmb_stiffness_of(sim, node)[2 * k] -= d * stiffness;
            sim->stiffness_upper[layout->link[node] + 2 * k] += d * stiffness;
        }
    }
}

/* Friction [N] and its derivatives by speed and side force. */
typedef struct axial_torsional_friction {
    double F[2], dv[4], dN[2];
} axial_torsional_friction;

static void friction(const dmb_evaluation *evaluation, uint32_t p, double N, const double v[2],
                     axial_torsional_friction *out)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    dmb_friction_law local;
    const dmb_friction_law *law = dmb_contact_friction_law(scene, &sim->trial, scene->site_count + p, &local);
    if (dmb_friction_has_memory(law) && evaluation->steady) {
        const dmb_friction_law sliding = dmb_sliding_law(law);
        dmb_friction_smooth(&sliding, N, v, out->F, out->dv, out->dN);
    } else if (dmb_friction_has_memory(law) && evaluation->dynamic) {
        const dmb_local_friction with = dmb_local_friction_of(law);
        sim->trial.axial_torsional_sticks[p] = dmb_friction_bristle(
            &with, N, v, sim->now.axial_torsional_bristle + 2 * p, sim->now.axial_torsional_slip + 2 * p,
            sim->now.axial_torsional_sticks[p], evaluation->step, sim->trial.axial_torsional_bristle + 2 * p, out->F,
            out->dv, out->dN);
    } else {
        dmb_friction_smooth(law, N, v, out->F, out->dv, out->dN);
    }
}

static void assemble_axial_torsional_site(dmb_evaluation *evaluation, uint32_t p)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    const dmb_axial_torsional_site *site = scene->axial_torsional_sites + p;
    const double *row = sim->trial.velocity + scene->layout.row[site->node];
    const double spin = evaluation->dynamic ? row[1] : evaluation->slip[1];
    const double v[2] = {evaluation->dynamic ? row[0] : evaluation->slip[0], site->radius * spin};
    side press;
    axial_torsional_friction rub;
    side_force(scene, &sim->trial, site, tension_at(sim, site->node), evaluation->load_factor, &press);
    memcpy(sim->trial.axial_torsional_slip + 2 * p, v, sizeof v);
    memset(sim->trial.axial_torsional_friction + 2 * p, 0, 2 * sizeof(double));
    if (!evaluation->dynamic && !evaluation->slipping) return;
    friction(evaluation, p, press.N, v, &rub);
    const double by_tension = press.by_tension, *F = rub.F, *dv = rub.dv, *dN = rub.dN;
    if (evaluation->dynamic) memcpy(sim->trial.axial_torsional_friction + 2 * p, F, sizeof rub.F);
    const double wrench[6] = {F[0], 0.0, 0.0, site->radius * F[1], 0.0, 0.0};
    dmb_apply_wrench(sim, site->node, wrench);
    evaluation->power[DMB_POWER_FRICTION] += evaluation->dynamic ? F[0] * v[0] + F[1] * v[1] : 0.0;
    if (!evaluation->tangent) return;
    const double dF_dT[2] = {dN[0] * by_tension, site->radius * dN[1] * by_tension};
    if (by_tension != 0.0 && !evaluation->inertia_only) add_tension_tangent(sim, site->node, dF_dT);
    if (!evaluation->dynamic) return;
    double *C = dmb_inertia_of(sim, site->node);
    const double s = evaluation->velocity_factor, r = site->radius;
    C[0] -= s * dv[0];
    C[1] -= s * r * dv[1];
    C[2] -= s * r * dv[2];
    C[3] -= s * r * r * dv[3];
}

void dmb_assemble_axial_torsional_friction(dmb_evaluation *evaluation)
{
    for (uint32_t p = 0; p < evaluation->sim->scene->axial_torsional_site_count; p++)
        assemble_axial_torsional_site(evaluation, p);
}

void dmb_axial_torsional_site_force(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t p,
                                    dmb_site_force *out)
{
    const dmb_axial_torsional_site *site = scene->axial_torsional_sites + p;
    side press;
    double tension = 0.0;
    uint32_t count = 0;
    memset(out, 0, sizeof *out);
    for (uint32_t e = 0; e < 2; e++) {
        double force[12];
        const uint32_t element = dmb_element_between(scene, site->node, e);
        if (element == DMB_NONE) continue;
        dmb_element_section_force(scene, configuration, element, force);
        tension += force[0];
        count++;
    }
    if (count) tension /= count;
    side_force(scene, configuration, site, tension, 1.0, &press);
    out->normal_force = press.N;
    dmb_vec3_copy(press.direction, out->normal);
    dmb_vec3_copy(press.tangent, out->tangent);
    out->closed = out->normal_force > 0.0;
    memcpy(out->slip, configuration->axial_torsional_slip + 2 * p, sizeof out->slip);
    const int32_t bristles = dmb_scene_has_bristles(scene);
    dmb_friction_law local;
    const dmb_friction_law *law = dmb_contact_friction_law(scene, configuration, scene->site_count + p, &local);
    dmb_finished_friction(law, bristles ? configuration->axial_torsional_bristle + 2 * p : NULL,
                          bristles ? configuration->axial_torsional_sticks[p] : 0, out);
}
