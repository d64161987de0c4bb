/* Unconstrained rotations of strings about their own axes: constrained during the iteration, and reported.
 *
 * Strings are axisymmetric: if all nodes of a string rotate by phi about their own axes, H_i <- H_i exp(phi e_RX),
 * elements, wall and weight exert the same forces, and the residual in the axes of the nodes rotates back by phi. With
 * w = (e_RX, e_RX, ...) the tangent obeys (eq:static.spin)
 *
 *     K w + e_x x r = 0
 *
 * unless something resists the rotation. Newton's matrix is then singular, and its correction along w is rounding:
 * therefore the rotation of one node is constrained, which selects one of the equivalent equilibria. The torque in that
 * row is the sum of the torques about the axis, and must be 0 in equilibrium. */
#include <math.h>
#include <string.h>

#include "analysis/static/static.h"

uint32_t dmb_static_spin_row(const dmb_scene *scene, uint32_t node)
{
    return scene->layout.size[node] == DMB_NODE_SIX_DOF ? DMB_RX : 1;
}

double *dmb_static_spin_stiffness(dmb_sim *sim, uint32_t node)
{
    const uint32_t c = dmb_static_spin_row(sim->scene, node);
    return dmb_stiffness_of(sim, node) + (size_t)(sim->scene->layout.size[node] + 1) * c;
}

void dmb_static_apply_spins(dmb_static_search *search)
{
    dmb_sim *sim = search->sim;
    for (uint32_t i = 0; i < search->spin_count; i++) {
        dmb_static_spin *spin = search->spins + i;
        double *torque =
            sim->residual + sim->scene->layout.row[spin->node] + dmb_static_spin_row(sim->scene, spin->node);
        spin->torque = *torque;
        *torque = 0.0;
        if (search->evaluation.tangent) *dmb_static_spin_stiffness(sim, spin->node) += spin->stiffness;
    }
}

/* Subtracts the multiple of w that a correction contains, which is arbitrary. */
void dmb_static_correct_spins(dmb_static_search *search)
{
    dmb_sim *sim = search->sim;
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < search->spin_count; i++) {
        const uint32_t node = search->spins[i].node;
        const dmb_chain *chain = scene->chains + scene->node_chain[node];
        const double angle = sim->correction[scene->layout.row[node] + dmb_static_spin_row(scene, node)];
        if (chain->jointed) continue;
        for (uint32_t k = chain->first; k < chain->first + chain->count; k++)
            sim->correction[scene->layout.row[k] + dmb_static_spin_row(scene, k)] -= angle;
    }
}
