/* Elements with the constant mass of straight ones, and their bend in a state (eq:curved.kinetic-energy). */
#include <math.h>

#include "analysis/model_check/model_check.h"
#include "math/vec3.h"
#include "model/section.h"
#include "sim/node.h"

/* [rad] Angle between the axes of the nodes of an element. */
static double bend_of(const dmb_sim *sim, uint32_t element)
{
    const uint32_t a = sim->scene->element_node[element];
    double Ra[9], Rb[9], u[3], chord = 0.0;
    dmb_node_pose(sim->scene, &sim->now, a, Ra, u);
    dmb_node_pose(sim->scene, &sim->now, a + 1, Rb, u);
    for (int i = 0; i < 9; i += 3) chord += (Rb[i] - Ra[i]) * (Rb[i] - Ra[i]);
    return 2.0 * asin(fmin(1.0, 0.5 * sqrt(chord)));
}

/* [-] Relative error of the momentum, (1/8 + r^2/L^2) a^2, r the radius of gyration of the sections, from the inertia
 * of the ends about a lateral axis. */
static double error_of(const dmb_element_type *type, double bend)
{
    const double mass = 2.0 * (type->mass.axial[0] + type->mass.axial[1]);
    const double rotary = type->mass.torsion[0] + type->mass.torsion[1]; /* half the polar inertia, as of a tube */
    return (0.125 + rotary / (mass * type->length * type->length)) * bend * bend;
}

/* Rounds up to two digits for the report. */
static double two_digits(double x)
{
    if (!(x > 0.0)) return 0.0;
    const double unit = pow(10.0, floor(log10(x)) - 1.0);
    return unit * ceil(x / unit - 1e-9);
}

static int is_axial_torsional_element(const dmb_scene *scene, uint32_t node)
{
    return scene->layout.size[node] == DMB_NODE_AXIAL_TORSIONAL &&
           scene->layout.size[node + 1] == DMB_NODE_AXIAL_TORSIONAL;
}

dmb_bent_elements dmb_find_bent(const dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    dmb_bent_elements bent = {0};
    for (uint32_t e = 0; e < scene->element_count; e++) {
        const dmb_element_type *type = scene->types + scene->element_type[e];
        if (is_axial_torsional_element(scene, scene->element_node[e])) continue;
        if (dmb_element_is_curved(type)) {
            bent.following++;
            continue;
        }
        const double bend = bend_of(sim, e);
        bent.constant++;
        if (bend > 1.000001 * DMB_CURVED_BEND) bent.beyond++;
        if (!(bend > bent.bend)) continue;
        bent.bend = bend;
        bent.error = error_of(type, bend);
        bent.node = scene->element_node[e];
    }
    bent.bend = two_digits(bent.bend);
    bent.error = two_digits(bent.error);
    return bent;
}
