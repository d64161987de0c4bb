/* Axial-torsional nodes side by side: their weight and damping, and friction where they lie on the wall (Johancsik,
 * Friesen, Dawson 1984): the side force balances weight and tension T in a curved hole across the axis,
 * N = | w_across + T l kappa n |, and friction acts along and around the axis. */
#ifndef DMB_KERNEL_LANES_AXIAL_TORSIONAL_NODE_H
#define DMB_KERNEL_LANES_AXIAL_TORSIONAL_NODE_H

#include <stddef.h>

#include "force/friction_law.h"
#include "force/hole.h"
#include "kernel/kernels.h"
#include "kernel/lane_group.h"
#include "math/real_sine.h"
#include "math/so3.h"
#include "math/vec3.h"

typedef struct wall_node_group {
    lane_group node;
    uint32_t arc; /* of the hole, of the last lane */
    uint32_t reserved;
    dmb_real depth;                    /* [m] measured */
    dmb_real tangent[3], curvature[3]; /* [-, 1/m] of the hole, in a curved one */
    dmb_real v[2], residual[2], scale[2];
    dmb_real by_depth[2]; /* [N/m, N] derivative of the residual by the depth, in a curved hole */
} wall_node_group;

static inline int is_curved(const dmb_axial_torsional_node_args *args)
{
    return args->hole != NULL && !dmb_hole_is_straight(args->hole);
}

/* Arc at depth s as dmb_hole_segment_at finds it; the search starts at the arc of the previous node. */
static inline uint32_t arc_from(const dmb_hole *hole, double s, uint32_t arc)
{
    while (arc + 1 < hole->stations && hole->station[arc + 1].depth <= s) arc++;
    while (arc > 0 && s < hole->station[arc].depth) arc--;
    return arc;
}

/* Station and arc of each lane: above the first station the axis is straight. */
typedef struct arc_lanes {
    dmb_real tangent[3], normal[3], curvature, beyond; /* [m] behind the station */
} arc_lanes;

/* All lanes on the arc of the last group. */
static inline void load_one_arc(const dmb_axial_torsional_node_args *args, const wall_node_group *g, arc_lanes *arcs)
{
    const dmb_hole_station *station = args->hole->station + g->arc;
    for (int i = 0; i < 3; i++) {
        arcs->tangent[i] = dmb_real_of(station->tangent[i]);
        arcs->normal[i] = dmb_real_of(station->normal[i]);
    }
    arcs->curvature = dmb_real_of(station->curvature);
    arcs->beyond = g->depth - station->depth;
}

static inline int are_on_one_arc(const dmb_axial_torsional_node_args *args, const wall_node_group *g)
{
    const dmb_hole_station *station = args->hole->station + g->arc;
    return g->arc + 1 < args->hole->stations && !dmb_mask_any(dmb_mask_less(g->depth, dmb_real_of(station->depth))) &&
           dmb_real_below(g->depth, dmb_real_of(station[1].depth));
}

static inline void load_arcs(const dmb_axial_torsional_node_args *args, wall_node_group *g, arc_lanes *arcs)
{
    if (are_on_one_arc(args, g)) {
        load_one_arc(args, g, arcs);
        return;
    }
    for (int l = 0; l < DMB_REAL_LANES; l++) {
        const double s = dmb_real_lane(&g->depth, l);
        g->arc = arc_from(args->hole, s, g->arc);
        const dmb_hole_station *station = args->hole->station + g->arc;
        for (int i = 0; i < 3; i++) {
            dmb_real_set_lane(arcs->tangent + i, l, station->tangent[i]);
            dmb_real_set_lane(arcs->normal + i, l, station->normal[i]);
        }
        dmb_real_set_lane(&arcs->curvature, l, s < station->depth ? 0.0 : station->curvature);
        dmb_real_set_lane(&arcs->beyond, l, s - station->depth);
    }
}

/* t = cos(k r) T + sin(k r) n, dt/ds = k (cos(k r) n - sin(k r) T) (eq:hole.arc) */
static inline void find_frames(const dmb_axial_torsional_node_args *args, wall_node_group *g)
{
    arc_lanes arcs;
    dmb_real sine, cosine;
    load_arcs(args, g, &arcs);
    dmb_real_sin_cos(arcs.curvature * arcs.beyond, &sine, &cosine);
    for (int i = 0; i < 3; i++) {
        g->tangent[i] = cosine * arcs.tangent[i] + sine * arcs.normal[i];
        g->curvature[i] = arcs.curvature * (cosine * arcs.normal[i] - sine * arcs.tangent[i]);
    }
}

static inline void place_nodes(const dmb_axial_torsional_node_args *args, wall_node_group *g)
{
    dmb_real u[3];
    load(args->displacement, 3, 3, &g->node, 0, u);
    if (args->hole != NULL) g->depth = load_line(args->depth, &g->node) + u[0];
    if (is_curved(args)) find_frames(args, g);
    load(args->velocity, 2, 2, &g->node, 0, g->v);
    load(args->residual, 2, 2, &g->node, 0, g->residual);
    load(args->scale, 2, 2, &g->node, 0, g->scale);
}

static inline void push(wall_node_group *g, int row, dmb_real force)
{
    g->residual[row] = g->residual[row] - force;
    g->scale[row] = g->scale[row] + dmb_real_abs(force);
}

/* A node advances along the hole's axis, in a straight hole or none along the x axis of its initial pose. In a bend the
 * component of the weight along the axis changes with the depth by w . kappa n (eq:motion.weight-along). */
static inline void weigh_along(dmb_axial_torsional_node_args *args, wall_node_group *g)
{
    dmb_real q[4], R[9], along[3], gravity[3];
    for (int i = 0; i < 3; i++) gravity[i] = dmb_real_of(args->gravity[i]);
    if (is_curved(args)) {
        dmb_vec3_copy(g->tangent, along);
    } else {
        load(args->quaternion, 4, 4, &g->node, 0, q);
        dmb_quat_to_matrix(q, R);
        for (int i = 0; i < 3; i++) along[i] = R[3 * i];
    }
    const dmb_real weight = args->load_factor * load_line(args->weight_mass, &g->node);
    const dmb_real force = weight * dmb_vec3_dot(along, gravity);
    push(g, 0, force);
    if (is_curved(args)) g->by_depth[0] = g->by_depth[0] - weight * dmb_vec3_dot(g->curvature, gravity);
    if (args->dynamic) add_each(force * g->v[0], &g->node, &args->potential);
}

/* Axial and torsional damping. */
static inline void damp_along(dmb_axial_torsional_node_args *args, wall_node_group *g, dmb_real C[4])
{
    dmb_real c[5];
    load(args->damping, 5, 5, &g->node, 0, c);
    const dmb_real f[2] = {-c[0] * g->v[0], -c[1] * g->v[1]};
    push(g, 0, f[0]);
    push(g, 1, f[1]);
    add_each(f[0] * g->v[0] + f[1] * g->v[1], &g->node, &args->damping_power);
    C[0] = C[0] + args->velocity_factor * c[0];
    C[3] = C[3] + args->velocity_factor * c[1];
}

_Static_assert(offsetof(dmb_axial_torsional_site, length) == sizeof(double), "radius, length");

/* Of the contact points: side force [N] and its derivatives by tension [-] and depth [N/m]. */
typedef struct side_force {
    dmb_real radius, length, N, by_tension, by_depth;
} side_force;

/* Radius and length are the first two numbers of a contact point. */
static inline void load_contact_points(const dmb_axial_torsional_node_args *args, const wall_node_group *g,
                                       side_force *side)
{
    enum { NUMBERS = sizeof(dmb_axial_torsional_site) / sizeof(double) };
    dmb_real head[NUMBERS];
    load((const double *)(const void *)args->sites, NUMBERS, NUMBERS, &g->node, 0, head);
    side->radius = head[0];
    side->length = head[1];
}

/* Along an arc the curvature vector changes along the axis alone, where the side force has no component: the change
 * with depth is that of the weight across the axis, dN/ds = -(w . t) (kappa n . u/N). */
static inline void find_side_force(const dmb_axial_torsional_node_args *args, wall_node_group *g, side_force *side)
{
    const int curved = is_curved(args);
    const dmb_real zero = dmb_real_of(0.0), one = dmb_real_of(1.0);
    const dmb_real weight = args->load_factor * load_line(args->weight_mass, &g->node);
    dmb_real u[3], t[3];
    for (int i = 0; i < 3; i++) {
        u[i] = weight * args->gravity[i];
        t[i] = curved ? g->tangent[i] : dmb_real_of(args->hole->direction[i]);
    }
    const dmb_real along = dmb_vec3_dot(u, t);
    dmb_vec3_axpy(-along, t, u);
    if (curved) dmb_vec3_axpy(load_line(args->tension, &g->node) * side->length, g->curvature, u);
    side->N = dmb_real_sqrt(dmb_vec3_dot(u, u));
    side->by_tension = side->by_depth = zero;
    if (!curved) return;
    const dmb_mask presses = dmb_mask_less(zero, side->N);
    dmb_vec3_scale(dmb_real_select(presses, one / dmb_real_select(presses, side->N, one), zero), u, u);
    side->by_tension = side->length * dmb_vec3_dot(u, g->curvature);
    side->by_depth = -along * dmb_vec3_dot(u, g->curvature);
}

/* The friction law with the coefficients of each place. */
static inline dmb_local_friction law_at(const dmb_axial_torsional_node_args *args, const wall_node_group *g)
{
    dmb_local_friction local = dmb_local_friction_of(args->friction_law);
    local.failed = args->failed;
    for (int l = 0; l < DMB_REAL_LANES && args->hole->pieces > 0; l++) {
        double mu_static, mu_dynamic;
        dmb_friction_coefficients_at(args->hole, dmb_real_lane(&g->depth, l), &mu_static, &mu_dynamic);
        dmb_real_set_lane(&local.mu_static, l, mu_static);
        dmb_real_set_lane(&local.mu_dynamic, l, mu_dynamic);
    }
    return local;
}

/* Friction [N], and its derivatives by speed and side force. */
typedef struct wall_friction {
    dmb_real F[2], dv[4], dN[2];
} wall_friction;

static inline void bristle_friction(const dmb_axial_torsional_node_args *args, const wall_node_group *g,
                                    const dmb_local_friction *law, dmb_real N, const dmb_real v[2],
                                    wall_friction *friction)
{
    dmb_real z_old[2], v_old[2], z[2], stuck = dmb_real_of(0.0);
    load(args->now_bristle, 2, 2, &g->node, 0, z_old);
    load(args->now_slip, 2, 2, &g->node, 0, v_old);
    for (int l = 0; l < DMB_REAL_LANES; l++)
        dmb_real_set_lane(&stuck, l, args->now_sticks[place_at(&g->node, (uint32_t)l)] ? 1.0 : 0.0);
    const dmb_mask sticks = dmb_friction_bristle(law, N, v, z_old, v_old, dmb_mask_less(dmb_real_of(0.0), stuck),
                                                 args->step, z, friction->F, friction->dv, friction->dN);
    const uint32_t bits = dmb_mask_bits(sticks);
    store(z, 2, &g->node, args->bristle);
    for (uint32_t l = 0; l < g->node.used; l++) args->sticks[g->node.first + l] = (int32_t)(bits >> l & 1);
}

DMB_LANES_CALL void called_friction(const dmb_axial_torsional_node_args *args, const wall_node_group *g,
                                    const dmb_local_friction *law, dmb_real N, const dmb_real v[2],
                                    wall_friction *friction)
{
    dmb_real v_old[2];
    dmb_law_memory memory[DMB_REAL_LANES];
    dmb_friction_at at[DMB_REAL_LANES];
    uint32_t lanes = 0;
    load(args->now_slip, 2, 2, &g->node, 0, v_old);
    for (int l = 0; l < DMB_REAL_LANES; l++) {
        const size_t first = args->friction_law->states * (size_t)place_at(&g->node, (uint32_t)l);
        const dmb_law_memory of = {args->now_bristle + first, args->bristle + first, args->step};
        memory[l] = of;
        at[l] = dmb_friction_arguments(law, &N, v, v_old, l);
        lanes |= ((uint32_t)l < g->node.used ? 1u : 0u) << l;
    }
    dmb_friction_called(law, at, memory, lanes, friction->F, friction->dv, friction->dN);
}

/* C -= factor dF/dv, by the speeds along the hole and of rotation; stores dF/dT for the tangent of the elements. */
static inline void add_friction_tangent(const dmb_axial_torsional_node_args *args, wall_node_group *g,
                                        const side_force *side, const wall_friction *friction, dmb_real C[4])
{
    const double s = args->velocity_factor;
    const dmb_real r = side->radius;
    g->by_depth[0] = g->by_depth[0] - friction->dN[0] * side->by_depth;
    g->by_depth[1] = g->by_depth[1] - r * friction->dN[1] * side->by_depth;
    const dmb_real by_tension[2] = {friction->dN[0] * side->by_tension, r * friction->dN[1] * side->by_tension};
    if (args->by_tension != NULL) store(by_tension, 2, &g->node, args->by_tension);
    if (!args->dynamic) return;
    C[0] = C[0] - s * friction->dv[0];
    C[1] = C[1] - s * r * friction->dv[1];
    C[2] = C[2] - s * r * friction->dv[2];
    C[3] = C[3] - s * r * r * friction->dv[3];
}

static inline void add_node_friction(dmb_axial_torsional_node_args *args, wall_node_group *g, dmb_real C[4])
{
    const dmb_real zero = dmb_real_of(0.0), still[2] = {zero, zero};
    side_force side;
    wall_friction friction;
    load_contact_points(args, g, &side);
    const dmb_real v[2] = {args->dynamic ? g->v[0] : dmb_real_of(args->slip[0]),
                           side.radius * (args->dynamic ? g->v[1] : dmb_real_of(args->slip[1]))};
    store(v, 2, &g->node, args->trial_slip);
    store(still, 2, &g->node, args->friction);
    if (args->friction_law == NULL) return;
    const dmb_local_friction law = law_at(args, g);
    find_side_force(args, g, &side);
    if (args->dynamic && args->friction_law->kind == DMB_FRICTION_CALLBACK)
        called_friction(args, g, &law, side.N, v, &friction);
    else if (args->dynamic && dmb_friction_has_memory(args->friction_law))
        bristle_friction(args, g, &law, side.N, v, &friction);
    else
        dmb_friction_smooth_at(&law, side.N, v, friction.F, friction.dv, friction.dN);
    if (args->dynamic) store(friction.F, 2, &g->node, args->friction);
    push(g, 0, friction.F[0]);
    push(g, 1, side.radius * friction.F[1]);
    if (args->dynamic) add_each(friction.F[0] * v[0] + friction.F[1] * v[1], &g->node, &args->friction_power);
    if (args->tangent) add_friction_tangent(args, g, &side, &friction, C);
}

static inline void add_by_depth(const dmb_axial_torsional_node_args *args, const wall_node_group *g)
{
    dmb_real K[4];
    load(args->stiffness, 4, 4, &g->node, 0, K);
    K[0] = K[0] + g->by_depth[0];
    K[2] = K[2] + g->by_depth[1];
    store(K, 4, &g->node, args->stiffness);
}

static void axial_torsional_nodes(dmb_axial_torsional_node_args *args)
{
    const dmb_real zero = dmb_real_of(0.0);
    wall_node_group g;
    memset(&g, 0, sizeof g);
    for (uint32_t first = 0; first < args->count; first += DMB_REAL_LANES) {
        dmb_real C[4] = {zero, zero, zero, zero};
        g.node = group_at(first, args->count);
        g.by_depth[0] = g.by_depth[1] = zero;
        place_nodes(args, &g);
        if (args->tangent) load(args->inertia, 4, 4, &g.node, 0, C);
        if (args->weighs) weigh_along(args, &g);
        if (args->damping != NULL) damp_along(args, &g, C);
        if (args->sites != NULL) add_node_friction(args, &g, C);
        store(g.residual, 2, &g.node, args->residual);
        store(g.scale, 2, &g.node, args->scale);
        if (args->tangent) store(C, 4, &g.node, args->inertia);
        if (args->tangent && is_curved(args)) add_by_depth(args, &g);
    }
}

#endif
