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
static inline int has_rigid_masses(const dmb_node_force_job *job, const lane_group *g, uint32_t *next)
{
    while (*next < job->rigid_mass_count && job->rigid_masses[*next].node < job->first + g->place[0]) (*next)++;
    return *next < job->rigid_mass_count && job->rigid_masses[*next].node <= job->first + g->place[DMB_REAL_LANES - 1];
}

/* Constants of the rigid_masses on a group of nodes, from `next` on; 0 where there is none. */
static inline void load_rigid_masses(const dmb_node_force_job *job, const lane_group *g, uint32_t next,
                                     dmb_rigid_mass_constants *c)
{
    static const dmb_rigid_mass none;
    for (int l = 0; l < DMB_REAL_LANES; l++) {
        const size_t node = job->first + g->place[l];
        while (next < job->rigid_mass_count && job->rigid_masses[next].node < node) next++;
        const int has = next < job->rigid_mass_count && job->rigid_masses[next].node == node;
        dmb_rigid_mass_load(has ? job->rigid_masses + next : &none, l, c);
    }
}

/* f = M v' - v^^T p */
static inline void add_rigid_masses(dmb_node_force_job *job, uint32_t next, node_group *g)
{
    dmb_rigid_mass_constants rigid_mass;
    dmb_real a[6], f[6], p[6], gyroscopic[6];
    load_rigid_masses(job, &g->place, next, &rigid_mass);
    load(job->acceleration, 6, 6, &g->place, 0, a);
    dmb_rigid_mass_momentum(&rigid_mass, a, f);
    const dmb_real power = dmb_vec6_dot(g->v, f);
    for (uint32_t l = 0; l < g->place.used; l++) job->inertia_power -= dmb_real_lane(&power, (int)l);
    dmb_rigid_mass_momentum(&rigid_mass, g->v, p);
    dmb_ad_transpose(g->v, p, gyroscopic);
    for (int i = 0; i < 6; i++) f[i] = -f[i];
    node_apply(f, g); /* one by one: on a free body these two are all that balances */
    node_apply(gyroscopic, g);
    if (job->tangent) dmb_rigid_mass_add_tangent(&rigid_mass, g->v, p, job->mass_factor, job->velocity_factor, g->C);
}

static inline void store_weight_tangent(const dmb_node_force_job *job, const lane_group *g, const dmb_real force[6],
                                        const dmb_real by_rotation[9])
{
    const dmb_real zero = dmb_real_of(0.0), *f = force;
    const dmb_real rows[6][4] = {{zero, zero, f[2], -f[1]},
                                 {zero, -f[2], zero, f[0]},
                                 {zero, f[1], -f[0], zero},
                                 {zero, -by_rotation[0], -by_rotation[1], -by_rotation[2]},
                                 {zero, -by_rotation[3], -by_rotation[4], -by_rotation[5]},
                                 {zero, -by_rotation[6], -by_rotation[7], -by_rotation[8]}};
    double *to[DMB_REAL_LANES];
    for (int l = 0; l < DMB_REAL_LANES; l++) to[l] = job->stiffness + 36 * g->place[l] + 2;
    for (uint32_t i = 0; i < 6; i++) add_four(rows[i], lanes_used(g), to, 6 * i);
}

static inline void add_weight(dmb_node_force_job *job, node_group *g)
{
    dmb_real q[4], R[9], mass, moment[3], force[6], by_rotation[9];
    load(job->quaternion, 4, 4, &g->place, 0, q);
    dmb_quat_to_matrix(q, R);
    mass = load_line(job->weight_mass, &g->place);
    load(job->weight_moment, 3, 3, &g->place, 0, moment);
    dmb_vec3_scale(dmb_real_of(job->load_factor), moment, moment);
    dmb_weight_at(job->gravity, R, job->load_factor * mass, moment, force, by_rotation);
    node_apply(force, g);
    if (job->dynamic) {
        const dmb_real power = dmb_vec6_dot(force, g->v);
        for (uint32_t l = 0; l < g->place.used; l++) job->potential += dmb_real_lane(&power, (int)l);
    }
    if (job->tangent) store_weight_tangent(job, &g->place, force, by_rotation);
}

static inline void add_damping(dmb_node_force_job *job, node_group *g)
{
    dmb_real c[5], force[6];
    load(job->damping, 5, 5, &g->place, 0, c);
    dmb_damping_force(c, g->v, force);
    node_apply(force, g);
    const dmb_real power = dmb_vec6_dot(force, g->v);
    for (uint32_t l = 0; l < g->place.used; l++) job->damping_power += dmb_real_lane(&power, (int)l);
    if (job->tangent) dmb_damping_add_tangent(c, job->velocity_factor, g->C);
}

static void node_forces(dmb_node_force_job *job)
{
    uint32_t next = 0;
    for (uint32_t first = 0; first < job->count; first += DMB_REAL_LANES) {
        node_group g;
        g.place = group_at(first, job->count);
        const int rigid_masses = has_rigid_masses(job, &g.place, &next),
                  inertia = job->tangent && (rigid_masses || job->damping);
        load(job->residual, 6, 6, &g.place, 0, g.residual);
        load(job->scale, 6, 6, &g.place, 0, g.scale);
        if (job->dynamic) load(job->velocity, 6, 6, &g.place, 0, g.v);
        if (inertia) load(job->inertia, 36, 36, &g.place, 0, g.C);
        if (rigid_masses) add_rigid_masses(job, next, &g);
        if (job->gravity) add_weight(job, &g);
        if (job->damping) add_damping(job, &g);
        store(g.residual, 6, &g.place, job->residual);
        store(g.scale, 6, &g.place, job->scale);
        if (inertia) store(g.C, 36, &g.place, job->inertia);
    }
}

#endif
