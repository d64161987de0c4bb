/* A state in the middle of a motion for the tests of lib/system. */
#ifndef DMB_TESTS_STIRRED_RIG_H
#define DMB_TESTS_STIRRED_RIG_H

#include <string.h>

#include "full_rig.h"

#include "math/se3.h"
#include "sim/layout.h"
#include "sim/sim.h"

static inline void push_into_wall(dmb_sim *sim, uint32_t s)
{
    const dmb_site *site = sim->scene->sites + s;
    const double deeper = sim->scene->hole.pieces > 0 ? 0.15 : 0.0; /* the wall is not where it was */
    const double want = site->clearance + 0.02 + 0.01 * (s % 3) + deeper;
    double *u = sim->now.displacement + 3 * site->node;
    u[1] = 0.4 * want;
    u[2] = -0.9 * want;
}

static inline void stir_nodes(dmb_sim *sim, uint64_t *seed)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        double h[6];
        for (int k = 0; k < 6; k++) h[k] = draw_between(seed, -0.08, 0.08);
        if (scene->layout.size[i] == DMB_NODE_AXIAL_TORSIONAL) {
            sim->now.displacement[3 * i] = h[0];
            sim->now.turn[i] = 3.0 * h[3];
        } else {
            h[3] *= 3.0, h[4] *= 3.0, h[5] *= 3.0;
            dmb_se3_advance(sim->now.quaternion + 4 * i, sim->now.displacement + 3 * i, h);
        }
    }
    for (uint32_t i = 0; i < scene->row_count; i++) {
        sim->now.velocity[i] = draw_between(seed, 0.2, 1.2) * (i % 5 == 0 ? -1.0 : 1.0);
        sim->now.acceleration[i] = draw_between(seed, -2.0, 2.0);
    }
}

/* Puts now and trial of the sim into the middle of a motion: everything moved, turned and fast, every ring in the wall.
 */
static inline void stir(rig *s, uint64_t seed)
{
    dmb_sim *sim = s->sim;
    const uint32_t bristles = dmb_scene_has_bristles(sim->scene) ? 1 : 0;
    for (uint32_t i = 0; i < sim->scene->site_count; i++) push_into_wall(sim, i);
    stir_nodes(sim, &seed);
    for (uint32_t i = 0; i < sim->scene->site_count; i++) {
        sim->now.site_penetration[i] = 1e-3; /* so the speed of impact is not taken anew */
        sim->now.site_impact_speed[i] = 0.4;
        if (bristles) sim->now.site_sticks[i] = (int32_t)(i % 2);
        for (uint32_t k = 0; k < 2 * bristles; k++)
            sim->now.site_bristle[2 * i + k] = draw_between(&seed, -0.003, 0.003);
        for (uint32_t k = 0; k < 2; k++) sim->now.site_slip[2 * i + k] = draw_between(&seed, -0.3, 0.3);
    }
    for (uint32_t i = 0; i < sim->scene->axial_torsional_site_count; i++) {
        if (bristles) sim->now.axial_torsional_sticks[i] = (int32_t)(i % 2);
        for (uint32_t k = 0; k < 2 * bristles; k++)
            sim->now.axial_torsional_bristle[2 * i + k] = draw_between(&seed, -0.003, 0.003);
    }
    for (uint32_t k = 0; k < sim->scene->bit_count; k++) sim->now.bit_bottom[k] = -0.3; /* well into the rock */
    dmb_configuration_copy(sim, &sim->now, &sim->trial);
    memset(sim->increment, 0, sim->scene->row_count * sizeof(double));
}

#endif
