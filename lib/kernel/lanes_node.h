/* Nodes side by side: rigid masses, weight and external damping. */
#ifndef DMB_KERNEL_LANES_NODE_H
#define DMB_KERNEL_LANES_NODE_H

#include "element/rigid_mass.h"
#include "force/weight_and_damping.h"
#include "kernel/kernels.h"
#include "kernel/lane_group.h"

/* Nodes of a group, with what is added to their rows and blocks. */
typedef struct node_group {
    lane_group place;
    dmb_real v[6], residual[6], scale[6];
    dmb_real C[36]; /* inertia block */
} node_group;

static inline void node_apply(const dmb_real force[6], node_group *g)
{
    for (int i = 0; i < 6; i++) {
        g->residual[i] = g->residual[i] - force[i];
        g->scale[i] = g->scale[i] + dmb_real_abs(force[i]);
    }
}

/* Rigid masses stand in the order of their nodes; *next becomes the first that is not before the group. Returns 1 if it
 * is on one of the group's nodes. */
static inline int has_rigid_masses(const dmb_node_force_run *run, const lane_group *g, uint32_t *next)
{
    while (*next < run->rigid_mass_count && run->rigid_masses[*next].node < run->first + g->place[0]) (*next)++;
    return *next < run->rigid_mass_count && run->rigid_masses[*next].node <= run->first + g->place[DMB_REAL_LANES - 1];
}

/* Constants of the rigid_masses on a group of nodes, from `next` on; 0 where there is none. */
static inline void load_rigid_masses(const dmb_node_force_run *run, const lane_group *g, uint32_t next,
                                     dmb_rigid_mass_constants *c)
{
    static const dmb_rigid_mass none;
    for (int l = 0; l < DMB_REAL_LANES; l++) {
        const size_t node = run->first + g->place[l];
        while (next < run->rigid_mass_count && run->rigid_masses[next].node < node) next++;
        const int has = next < run->rigid_mass_count && run->rigid_masses[next].node == node;
        dmb_rigid_mass_load(has ? run->rigid_masses + next : &none, l, c);
    }
}

/* f = M v' - v^^T p */
static inline void add_rigid_masses(dmb_node_force_run *run, uint32_t next, node_group *g)
{
    dmb_rigid_mass_constants rigid_mass;
    dmb_real a[6], f[6], p[6], turning[6];
    load_rigid_masses(run, &g->place, next, &rigid_mass);
    load(run->acceleration, 6, 6, &g->place, 0, a);
    dmb_rigid_mass_momentum(&rigid_mass, a, f);
    const dmb_real power = dmb_vec6_dot(g->v, f);
    for (uint32_t l = 0; l < g->place.used; l++) run->inertia_power -= dmb_real_lane(&power, (int)l);
    dmb_rigid_mass_momentum(&rigid_mass, g->v, p);
    dmb_ad_transpose(g->v, p, turning);
    for (int i = 0; i < 6; i++) f[i] = -f[i];
    node_apply(f, g); /* one by one: on a free body these two are all that balances */
    node_apply(turning, g);
    if (run->tangent) dmb_rigid_mass_add_tangent(&rigid_mass, g->v, p, run->mass_factor, run->velocity_factor, g->C);
}

static inline void store_weight_tangent(const dmb_node_force_run *run, const lane_group *g, const dmb_real force[6],
                                        const dmb_real turning[9])
{
    const dmb_real zero = dmb_real_of(0.0), *f = force;
    const dmb_real rows[6][4] = {{zero, zero, f[2], -f[1]},
                                 {zero, -f[2], zero, f[0]},
                                 {zero, f[1], -f[0], zero},
                                 {zero, -turning[0], -turning[1], -turning[2]},
                                 {zero, -turning[3], -turning[4], -turning[5]},
                                 {zero, -turning[6], -turning[7], -turning[8]}};
    double *to[DMB_REAL_LANES];
    for (int l = 0; l < DMB_REAL_LANES; l++) to[l] = run->stiffness + 36 * g->place[l] + 2;
    for (uint32_t i = 0; i < 6; i++) add_four(rows[i], lanes_used(g), to, 6 * i);
}

static inline void add_weight(dmb_node_force_run *run, node_group *g)
{
    dmb_real q[4], R[9], mass, moment[3], force[6], turning[9];
    load(run->quaternion, 4, 4, &g->place, 0, q);
    dmb_quat_to_matrix(q, R);
    mass = load_line(run->weight_mass, &g->place);
    load(run->weight_moment, 3, 3, &g->place, 0, moment);
    dmb_vec3_scale(dmb_real_of(run->load_factor), moment, moment);
    dmb_weight_at(run->gravity, R, run->load_factor * mass, moment, force, turning);
    node_apply(force, g);
    if (run->dynamic) {
        const dmb_real power = dmb_vec6_dot(force, g->v);
        for (uint32_t l = 0; l < g->place.used; l++) run->potential += dmb_real_lane(&power, (int)l);
    }
    if (run->tangent) store_weight_tangent(run, &g->place, force, turning);
}

static inline void add_damping(dmb_node_force_run *run, node_group *g)
{
    dmb_real c[5], force[6];
    load(run->damping, 5, 5, &g->place, 0, c);
    dmb_damping_force(c, g->v, force);
    node_apply(force, g);
    const dmb_real power = dmb_vec6_dot(force, g->v);
    for (uint32_t l = 0; l < g->place.used; l++) run->damping_power += dmb_real_lane(&power, (int)l);
    if (run->tangent) dmb_damping_add_tangent(c, run->velocity_factor, g->C);
}

static void node_forces(dmb_node_force_run *run)
{
    uint32_t next = 0;
    for (uint32_t first = 0; first < run->count; first += DMB_REAL_LANES) {
        node_group g;
        g.place = group_at(first, run->count);
        const int rigid_masses = has_rigid_masses(run, &g.place, &next),
                  inertia = run->tangent && (rigid_masses || run->damping);
        load(run->residual, 6, 6, &g.place, 0, g.residual);
        load(run->scale, 6, 6, &g.place, 0, g.scale);
        if (run->dynamic) load(run->velocity, 6, 6, &g.place, 0, g.v);
        if (inertia) load(run->inertia, 36, 36, &g.place, 0, g.C);
        if (rigid_masses) add_rigid_masses(run, next, &g);
        if (run->gravity) add_weight(run, &g);
        if (run->damping) add_damping(run, &g);
        store(g.residual, 6, &g.place, run->residual);
        store(g.scale, 6, &g.place, run->scale);
        if (inertia) store(g.C, 36, &g.place, run->inertia);
    }
}

#endif
