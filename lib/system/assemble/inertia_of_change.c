/* Inertia forces M a of a change a of the accelerations, by a diagonal mass: part of the residual that the initial
 * guess of a step would leave (integrator/prediction), which needs a size and no more. One pass without a factorisation
 * or an evaluation.
 *
 *     row              lumped mass of an element's end
 *     --------------   ---------------------------------------------------------------------
 *     x, rotation x    sum of its row in eq:beam.axial-mass: half of the element
 *     y, z             sum of the two entries by displacements in eq:beam.mass
 *     rotation y, z    the diagonal entry of eq:beam.mass alone
 *
 * Rigid masses count with mass and moments about the node; first moments and products are left out. */
#include <string.h>

#include "system/assemble/assemble.h"

/* Inertia forces of a change of the accelerations, by lumped masses. */

/* [kg, kg m2] Lumped inertia times the factor, by the rows of a six-DOF end. */
typedef struct lumped {
    double row[6];
} lumped;

static lumped half_of(const dmb_element_type *type, double factor)
{
    const dmb_beam_mass *m = &type->mass;
    lumped half = {{m->axial[0] + m->axial[1], m->bending[0][0] + m->bending[0][2], m->bending[1][0] + m->bending[1][2],
                    m->torsion[0] + m->torsion[1], m->bending[1][4], m->bending[0][4]}};
    for (int k = 0; k < 6; k++) half.row[k] *= factor;
    return half;
}

static void add_node(uint32_t size, const lumped *mass, const double *z, double *force)
{
    if (size == DMB_NODE_AXIAL_TORSIONAL) {
        force[0] += mass->row[DMB_X] * z[0];
        force[1] += mass->row[DMB_RX] * z[1];
        return;
    }
    for (uint32_t k = 0; k < 6; k++) force[k] += mass->row[k] * z[k];
}

/* Adds both ends of an element between six-DOF nodes, whose rows are consecutive. */
static void add_both(const lumped *half, const double *restrict z, double *restrict force)
{
    for (uint32_t k = 0; k < 6; k++) force[k] += half->row[k] * z[k];
    for (uint32_t k = 0; k < 6; k++) force[6 + k] += half->row[k] * z[6 + k];
}

/* The same of axial-torsional nodes. */
static void add_both_axial_torsional(const lumped *half, const double *restrict z, double *restrict force)
{
    for (uint32_t k = 0; k < 4; k++) force[k] += half->row[k & 1 ? DMB_RX : DMB_X] * z[k];
}

void dmb_inertia_of_change(const dmb_scene *scene, const double *change, double factor, double *force)
{
    lumped half = {{0.0}};
    memset(force, 0, scene->row_count * sizeof *force);
    for (uint32_t e = 0; e < scene->element_count; e++) {
        const uint32_t a = scene->element_node[e], row = scene->layout.row[a], next = scene->layout.row[a + 1];
        if (e == 0 || scene->element_type[e] != scene->element_type[e - 1])
            half = half_of(scene->types + scene->element_type[e], factor);
        if (scene->layout.size[a] + scene->layout.size[a + 1] == 2 * DMB_NODE_SIX_DOF) {
            add_both(&half, change + row, force + row);
            continue;
        }
        if (scene->layout.size[a] + scene->layout.size[a + 1] == 2 * DMB_NODE_AXIAL_TORSIONAL) {
            add_both_axial_torsional(&half, change + row, force + row);
            continue;
        }
        add_node(scene->layout.size[a], &half, change + row, force + row);
        add_node(scene->layout.size[a + 1], &half, change + next, force + next);
    }
    for (uint32_t i = 0; i < scene->rigid_mass_count; i++) {
        const dmb_rigid_mass *m = scene->rigid_masses + i;
        const lumped mass = {{factor * m->mass, factor * m->mass, factor * m->mass, factor * m->inertia[0],
                              factor * m->inertia[1], factor * m->inertia[2]}};
        const uint32_t row = scene->layout.row[m->node];
        add_node(scene->layout.size[m->node], &mass, change + row, force + row);
    }
}
