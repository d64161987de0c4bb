/* Contact points on the wall of the hole, side by side. Contributions are summed in the order of the contact points;
 * those without contact add nothing. */
#ifndef DMB_KERNEL_LANES_WALL_H
#define DMB_KERNEL_LANES_WALL_H

#include <stddef.h>

#include "element/beam_math.h"
#include "force/contact_law.h"
#include "force/hole.h"
#include "kernel/kernels.h"
#include "kernel/lane_group.h"
#include "math/so3.h"

/* Laws of the whole hole. */
typedef struct wall_laws {
    dmb_local_normal normal;
    dmb_local_friction friction;
} wall_laws;

/* Contact points of a group. */
typedef struct wall_group {
    dmb_real offset, clearance, length;
    dmb_real x[3];                                 /* [m] their centres, world */
    dmb_real R[9], normal[3], tangent[3], bend[3]; /* bend: [rad/m] body axes, of a hole that is not straight */
    dmb_real penetration, impact_speed;
    dmb_mask touches, own;         /* own: contact points with a mean force over the step (eq:contact.mean) */
    dmb_real pressed;              /* [N] their mean force at the penetration of rest, in the first evaluation */
    dmb_real heat;                 /* [W] their power dissipated in the wall */
    dmb_real turned;               /* [-] cosine of the angle between the normals at the start and now */
    dmb_real kept[DMB_TOUCH_SIZE]; /* touch history of contact points in contact */
    dmb_real bristle[2];           /* [m] of contact points in contact */
    dmb_contact_frame frame;
    dmb_section_contact section;        /* in a hole with sections */
    const dmb_local_normal *normal_law; /* at the contact points */
    const dmb_local_friction *friction_law;
    lane_places node, row;
    uint32_t touching; /* bit mask of the lanes in contact, without lanes that repeat the last contact point */
    uint32_t sticking; /* bit mask of those that stick (bristle law) */
    lane_group site;
    const struct wall_section *inside; /* of contact points inside elements; NULL: they are on nodes */
} wall_group;

/* Velocity of the contact points at the last accepted state, in world axes; in kernel/lanes_wall_inside.h. */
static inline void section_velocity_before(const dmb_wall_args *args, const wall_group *g, dmb_real V[3]);

/* In a hole with sections the wall's constants depend on the measured depth of the contact point. */
static inline int has_sections(const dmb_wall_args *args)
{
    return args->hole->pieces > 0;
}

static inline wall_laws laws_of(const dmb_wall_args *args)
{
    static const dmb_friction_law none = {.kind = DMB_FRICTION_NONE};
    wall_laws laws = {dmb_local_normal_of(args->normal_law),
                      dmb_local_friction_of(args->friction_law != NULL ? args->friction_law : &none)};
    laws.friction.failed = args->failed;
    return laws;
}

_Static_assert(offsetof(dmb_site, length) == 3 * sizeof(double), "offset, radius, clearance, length");

DMB_LANES_CALL void find_places(const dmb_wall_args *args, wall_group *g)
{
    for (uint32_t l = 0; l < DMB_REAL_LANES; l++) {
        g->node.place[l] = args->sites[place_at(&g->site, l)].node;
        g->row.place[l] = args->row[g->node.place[l]];
    }
}

/* Contact points are stored in the order of their nodes. If the nodes of a group are neighbours with six rows each,
 * rows and blocks are contiguous. */
static inline void load_places(const dmb_wall_args *args, wall_group *g)
{
    const size_t first = args->sites[g->site.first].node;
    size_t node = first, apart = 0;
    for (uint32_t l = 1; l < DMB_REAL_LANES; l++) {
        node = args->sites[place_at(&g->site, l)].node;
        apart |= node - first - l;
    }
    g->node.place[0] = first;
    g->row.place[0] = args->row[first];
    apart |= args->row[node] - g->row.place[0] - 6 * (size_t)(DMB_REAL_LANES - 1);
    g->node.together = g->row.together = apart == 0;
    if (apart != 0) find_places(args, g);
}

static inline void load_sites(const dmb_wall_args *args, wall_group *g)
{
    enum { NUMBERS = sizeof(dmb_site) / sizeof(double) };
    dmb_real head[4];
    load_places(args, g);
    load((const double *)(const void *)args->sites, NUMBERS, 4, &g->site, 0, head);
    g->offset = head[0];
    g->frame.radius = head[1];
    g->clearance = head[2];
    g->length = head[3];
}

static inline void load_motion(const dmb_wall_args *args, wall_group *g)
{
    dmb_real q[4], u[3];
    load_at(args->quaternion, 4, 4, &g->node, q);
    dmb_quat_to_matrix(q, g->R);
    load_at(args->reference, 3, 3, &g->node, g->x);
    load_at(args->displacement, 3, 3, &g->node, u);
    for (int i = 0; i < 3; i++) g->x[i] = g->x[i] + u[i] + g->R[3 * i] * g->offset;
    if (!args->dynamic) return;
    load_at(args->velocity, 1, 6, &g->row, g->frame.V);
    dmb_arm_velocity(g->offset, g->frame.V);
}

/* Closest points of a surveyed axis, found one by one. */
static inline void project_survey(const dmb_wall_args *args, wall_group *g, dmb_real point[3])
{
    for (int l = 0; l < DMB_REAL_LANES; l++) {
        const size_t s = place_at(&g->site, (uint32_t)l);
        const double x[3] = {dmb_real_lane(g->x, l), dmb_real_lane(g->x + 1, l), dmb_real_lane(g->x + 2, l)};
        double at[3], tangent[3], bend[3];
        args->trial.segment[s] = args->now.segment[s];
        dmb_hole_project(args->hole, x, &args->trial.depth[s], &args->trial.segment[s], at, tangent);
        dmb_hole_arc_bend(args->hole, args->trial.depth[s], args->trial.segment[s], bend);
        for (int i = 0; i < 3; i++) {
            dmb_real_set_lane(point + i, l, at[i]);
            dmb_real_set_lane(g->tangent + i, l, tangent[i]);
            dmb_real_set_lane(g->bend + i, l, bend[i]);
        }
    }
    dmb_mat3_tvec(g->R, g->bend, g->bend);
}

/* A straight hole: depth = (x - origin) . direction. */
static inline void project_line(const dmb_wall_args *args, wall_group *g, dmb_real point[3])
{
    dmb_real depth;
    dmb_line_project(args->hole->origin, args->hole->direction, g->x, &depth, point);
    for (int i = 0; i < 3; i++) g->tangent[i] = dmb_real_of(args->hole->direction[i]);
    store_line(depth, &g->site, args->trial.depth);
    for (uint32_t l = 0; l < g->site.used; l++) args->trial.segment[place_at(&g->site, (uint32_t)l)] = 0;
}

DMB_LANES_INLINE void locate(const dmb_wall_args *args, wall_group *g)
{
    dmb_real point[3], last[3];
    if (dmb_hole_is_straight(args->hole))
        project_line(args, g, point);
    else
        project_survey(args, g, point);
    load(args->now.normal, 3, 3, &g->site, 0, last);
    dmb_radial_at(g->x, point, g->tangent, last, &g->frame.distance, g->normal);
    g->turned = dmb_vec3_dot(last, g->normal);
    store(g->normal, 3, &g->site, args->trial.normal);
}

static inline void node_velocity_before(const dmb_wall_args *args, const wall_group *g, dmb_real V[3])
{
    dmb_real q[4], R[9], v[6];
    load_at(args->now_velocity, 1, 6, &g->row, v);
    load_at(args->now_quaternion, 4, 4, &g->node, q);
    dmb_arm_velocity(g->offset, v);
    dmb_quat_to_matrix(q, R);
    dmb_mat3_vec(R, v, V);
}

/* [m/s] Speed of the contact points at the last accepted state, along the present normal: the point may have crossed
 * the axis since. */
static inline dmb_real speed_before(const dmb_wall_args *args, const wall_group *g)
{
    dmb_real V[3];
    if (g->inside != NULL)
        section_velocity_before(args, g, V);
    else
        node_velocity_before(args, g, V);
    if (has_sections(args)) return dmb_vec3_dot(g->normal, V) - g->section.rho * dmb_vec3_dot(g->tangent, V);
    return dmb_vec3_dot(g->normal, V);
}

/* Impact speed v0 of the restitution laws: the normal speed at the last accepted state before contact. Without contact
 * the field holds the present normal speed. A contact point that opens and closes within one step has the speed of its
 * separation. */
DMB_LANES_INLINE void set_impact_speed(const dmb_wall_args *args, wall_group *g)
{
    const dmb_real zero = dmb_real_of(0.0);
    const dmb_real back = args->own_factor > 0.0 ? load_line(args->site_history, &g->site) : zero;
    const dmb_real penetration = load_line(args->now.penetration, &g->site);
    const dmb_real impact_speed = load_line(args->now.impact_speed, &g->site);
    const dmb_mask touches = dmb_mask_less(zero, g->penetration), returns = dmb_mask_less(zero, back);
    const dmb_mask touched = dmb_mask_less(zero, penetration);
    dmb_real closed = impact_speed;
    if (dmb_mask_any(touches & dmb_mask_not(touched | returns)))
        closed = dmb_real_select(touched, impact_speed, speed_before(args, g));
    closed = dmb_real_select(returns, back, closed);
    g->impact_speed = dmb_real_select(touches, closed, dmb_real_select(touched, impact_speed, g->frame.speed[0]));
}

/* Constants of the wall at each contact point of the group; those without a dependence on depth are those of the hole.
 */
static inline void load_walls(const dmb_wall_args *args, const wall_laws *laws, wall_group *g)
{
    dmb_section_contact *section = &g->section;
    section->normal = laws->normal;
    section->friction = laws->friction;
    for (int l = 0; l < DMB_REAL_LANES; l++) {
        dmb_local_wall wall;
        dmb_local_wall_at(args->hole, args->normal_law, laws->friction.law,
                          args->trial.depth[place_at(&g->site, (uint32_t)l)], args->softer, &wall);
        dmb_section_set_wall(&wall, l, section);
    }
}

/* Constants of the wall at the contact points, and the normal speed relative to a wall whose radius changes with depth.
 */
static inline void enter_section(const dmb_wall_args *args, const wall_laws *laws, wall_group *g)
{
    dmb_vec3_zero(g->section.curvature);
    if (!dmb_hole_is_straight(args->hole)) dmb_vec3_cross(g->bend, g->frame.t, g->section.curvature);
    load_walls(args, laws, g);
    dmb_section_contact_at(&g->frame, &g->section);
    g->clearance = g->section.radius - g->frame.radius;
    if (args->dynamic) g->frame.speed[0] = g->frame.speed[0] - g->section.rho * dmb_vec3_dot(g->frame.t, g->frame.V);
}

static inline void read_laws(const dmb_wall_args *args, const wall_laws *laws, wall_group *g)
{
    g->normal_law = &laws->normal;
    g->friction_law = &laws->friction;
    if (!has_sections(args)) return;
    enter_section(args, laws, g);
    g->normal_law = &g->section.normal;
    g->friction_law = &g->section.friction;
}

/* Normal, penetration and speeds of the contact points, written to the trial configuration. */
DMB_LANES_INLINE void place_sites(const dmb_wall_args *args, const wall_laws *laws, wall_group *g)
{
    locate(args, g);
    dmb_contact_frame_at(g->R, g->normal, g->tangent, &g->frame);
    if (args->dynamic)
        dmb_contact_speeds(&g->frame);
    else
        dmb_contact_static_speeds(args->slip, &g->frame);
    read_laws(args, laws, g);
    g->penetration = g->frame.distance - g->clearance;
    set_impact_speed(args, g);
    store_line(g->penetration, &g->site, args->trial.penetration);
    store_line(g->impact_speed, &g->site, args->trial.impact_speed);
    store(g->frame.speed + 1, 2, &g->site, args->trial.slip);
}

static inline int is_called(const dmb_wall_args *args)
{
    return args->friction_law != NULL && args->friction_law->kind == DMB_FRICTION_CALLBACK;
}

/* Without contact the state of the caller's law is 0; in contact it has written it. */
static inline void keep_called(const dmb_wall_args *args, const wall_group *g)
{
    for (uint32_t l = 0; l < g->site.used; l++) {
        const size_t s = g->site.first + l;
        args->trial.sticks[s] = 0;
        if ((g->touching >> l & 1) == 0)
            memset(args->trial.bristle + args->states * s, 0, args->states * sizeof(double));
    }
}

/* Without contact the bristle deflection is 0. */
static inline void keep_bristles(const dmb_wall_args *args, const wall_group *g)
{
    const dmb_real zero = dmb_real_of(0.0);
    const dmb_real z[2] = {dmb_real_select(g->touches, g->bristle[0], zero),
                           dmb_real_select(g->touches, g->bristle[1], zero)};
    store(z, 2, &g->site, args->trial.bristle);
    for (uint32_t l = 0; l < g->site.used; l++)
        args->trial.sticks[g->site.first + l] = (int32_t)((g->sticking & g->touching) >> l & 1);
}

/* Evaluations without friction leave the deflection of contact points in contact unchanged. */
static inline void begin_bristles(const dmb_wall_args *args, wall_group *g)
{
    g->sticking = 0;
    g->bristle[0] = g->bristle[1] = dmb_real_of(0.0);
    if (g->touching == 0 || (args->friction_law != NULL && args->dynamic)) return;
    load(args->trial.bristle, 2, 2, &g->site, 0, g->bristle);
    for (uint32_t l = 0; l < g->site.used; l++)
        g->sticking |= (args->trial.sticks[g->site.first + l] != 0 ? 1u : 0u) << l;
}

DMB_LANES_CALL void called(const dmb_wall_args *args, const wall_group *g, dmb_real N, dmb_real F[2],
                           dmb_real by_speed[4], dmb_real by_normal[2])
{
    dmb_real v_old[2];
    dmb_law_memory memory[DMB_REAL_LANES];
    dmb_friction_at at[DMB_REAL_LANES];
    load(args->now.slip, 2, 2, &g->site, 0, v_old);
    for (int l = 0; l < DMB_REAL_LANES; l++) {
        const size_t first = args->states * (size_t)place_at(&g->site, (uint32_t)l);
        const dmb_law_memory of = {args->now.bristle + first, args->trial.bristle + first, args->step};
        memory[l] = of;
        at[l] = dmb_friction_arguments(g->friction_law, &N, g->frame.speed + 1, v_old, l);
    }
    dmb_friction_called(g->friction_law, at, memory, g->touching, F, by_speed, by_normal);
}

static inline void bristles(const dmb_wall_args *args, wall_group *g, dmb_real N, dmb_real F[2], dmb_real by_speed[4],
                            dmb_real by_normal[2])
{
    const dmb_real *v = g->frame.speed + 1;
    dmb_real z_old[2], v_old[2], stuck = dmb_real_of(0.0);
    load(args->now.bristle, 2, 2, &g->site, 0, z_old);
    load(args->now.slip, 2, 2, &g->site, 0, v_old);
    for (int l = 0; l < DMB_REAL_LANES; l++)
        dmb_real_set_lane(&stuck, l, args->now.sticks[place_at(&g->site, (uint32_t)l)] ? 1.0 : 0.0);
    const dmb_mask sticks =
        dmb_friction_bristle(g->friction_law, N, v, z_old, v_old, dmb_mask_less(dmb_real_of(0.0), stuck), args->step,
                             g->bristle, F, by_speed, by_normal);
    g->sticking = dmb_mask_bits(sticks);
}

/* In the first evaluation of a step the friction tangent of contact points with a mean force is evaluated at the force
 * N0 at which the contact point alone comes to rest, and at the predicted slip, or at slip 0 if friction can stop it
 * within the step. From the predicted slip Newton would alternate across the steep part of the law. */
DMB_LANES_CALL void rub_at_start(const dmb_wall_args *args, const wall_group *g, dmb_real N, dmb_real F[2],
                                 dmb_real by_speed[4], dmb_real by_normal[2])
{
    const dmb_local_friction *law = g->friction_law;
    const dmb_real zero = dmb_real_of(0.0), *v = g->frame.speed + 1;
    const dmb_real N0 = dmb_real_select(g->own, g->pressed, N);
    const dmb_real per_force = args->slows / (args->own_factor * g->length);
    const dmb_mask stops =
        g->own & dmb_mask_less(dmb_friction_norm(v[0], v[1]), per_force * dmb_friction_most(law) * N0);
    const dmb_real at[2] = {dmb_real_select(stops, zero, v[0]), dmb_real_select(stops, zero, v[1])};
    dmb_friction_smooth_at(law, N0, at, F, by_speed, by_normal);
    for (int k = 0; k < 2; k++)
        F[k] = F[k] + by_normal[k] * (N - N0) + by_speed[2 * k] * (v[0] - at[0]) + by_speed[2 * k + 1] * (v[1] - at[1]);
}

static inline void add_friction(const dmb_wall_args *args, wall_group *g, dmb_contact_force *c)
{
    const dmb_real zero = dmb_real_of(0.0);
    dmb_real F[2], by_speed[4] = {zero, zero, zero, zero}, by_normal[2];
    if (is_called(args) && args->dynamic)
        called(args, g, -c->F[0], F, by_speed, by_normal);
    else if (dmb_friction_has_memory(args->friction_law) && args->dynamic)
        bristles(args, g, -c->F[0], F, by_speed, by_normal);
    else if (args->yield > 0.0 && dmb_mask_any(g->own))
        rub_at_start(args, g, -c->F[0], F, by_speed, by_normal);
    else
        dmb_friction_smooth_at(g->friction_law, -c->F[0], g->frame.speed + 1, F,
                               args->tangent && args->dynamic ? by_speed : NULL, by_normal);
    dmb_contact_add_friction(F, by_speed, by_normal, c);
}

/* Adds -K, transformed from the contact points to their nodes, to the diagonal blocks of the nodes. */
static inline void subtract_blocks(const dmb_wall_args *args, const wall_group *g, uint32_t touching, int arms,
                                   dmb_real K[36], double *blocks)
{
    double *to[DMB_REAL_LANES];
    if (arms) dmb_beam_block_to_nodes(g->offset, g->offset, K);
    for (int i = 0; i < 36; i++) K[i] = -K[i];
    for (int l = 0; l < DMB_REAL_LANES; l++)
        to[l] = blocks + args->diagonal[g->node.together ? g->node.place[0] + (size_t)l : g->node.place[l]];
    add_lanes(K, 36, touching, to);
}

/* d wrench/d pose of the contact points, in their body axes. */
static inline void find_pose_tangent(const dmb_wall_args *args, const wall_group *g, const dmb_contact_force *c,
                                     const dmb_real wrench[6], dmb_real K[36])
{
    const int friction = args->friction_law != NULL;
    const dmb_real *bend = dmb_hole_is_straight(args->hole) ? NULL : g->bend;
    dmb_contact_pose_tangent(&g->frame, c, wrench, friction, K);
    if (bend != NULL) dmb_contact_add_bend(&g->frame, c, g->bend, wrench, friction, K);
    if (has_sections(args)) dmb_section_pose_tangent(&g->frame, c, &g->section, bend, friction, K);
}

/* The same by velocity, times a factor. */
static inline void find_velocity_tangent(const dmb_wall_args *args, const wall_group *g, const dmb_contact_force *c,
                                         double factor, dmb_real K[36])
{
    const int friction = args->friction_law != NULL;
    dmb_contact_velocity_tangent(&g->frame, c, factor, friction, K);
    if (has_sections(args)) dmb_section_velocity_tangent(&g->frame, c, &g->section, factor, friction, K);
}

static inline void add_tangent(const dmb_wall_args *args, const wall_group *g, uint32_t touching, int arms,
                               const dmb_contact_force *c, const dmb_real wrench[6])
{
    dmb_real K[36];
    find_pose_tangent(args, g, c, wrench, K);
    subtract_blocks(args, g, touching, arms, K, args->stiffness);
    if (!args->dynamic) return;
    find_velocity_tangent(args, g, c, args->velocity_factor, K);
    subtract_blocks(args, g, touching, arms, K, args->inertia);
}

/* [N2] Square of the rounding of the normal force: the distance to the axis is a difference of world coordinates, of
 * which those along the normal contribute. */
static inline dmb_real rounding_of(const wall_group *g, dmb_real stiffness)
{
    dmb_real reach = dmb_real_of(0.0);
    for (int i = 0; i < 3; i++) reach = reach + dmb_real_abs(g->normal[i] * g->x[i]);
    const dmb_real force = stiffness * reach;
    return force * force;
}

/* Adds the wrench of each contact point to the rows of its node. Adding -0.0 is exact. */
DMB_LANES_INLINE void add_rows(const wall_group *g, const dmb_real x[6], double *rows)
{
    const dmb_real nothing = dmb_real_of(-0.0);
    dmb_real sum[6];
    double *to[DMB_REAL_LANES];
    if (DMB_REAL_LANES == 1 || g->row.together) {
        load_at(rows, 1, 6, &g->row, sum);
        for (int i = 0; i < 6; i++) sum[i] = sum[i] + dmb_real_select(g->touches, x[i], nothing);
        store_together(sum, 6, rows + g->row.place[0]);
        return;
    }
    for (int l = 0; l < DMB_REAL_LANES; l++) to[l] = rows + g->row.place[l];
    add_lanes(x, 6, g->touching, to);
}

static inline void add_touching(dmb_real x, const wall_group *g, double *to)
{
    add_each(dmb_real_select(g->touches, x, dmb_real_of(-0.0)), &g->site, to);
}

/* [W] Powers of a mean force: dissipated in the wall, friction with the weight of the trapezoidal rule at the end of
 * the step, and the remaining potential part (eq:contact.mean). */
static inline void set_own_powers(const dmb_wall_args *args, const wall_group *g, const dmb_contact_force *c,
                                  dmb_real power[3])
{
    const dmb_real *v = g->frame.speed;
    const dmb_real rubs = (2.0 / args->own_factor) * power[2];
    const dmb_real rest = c->F[0] * v[0] - g->heat + (power[2] - rubs);
    power[0] = dmb_real_select(g->own, rest, power[0]);
    power[1] = dmb_real_select(g->own, g->heat, power[1]);
    power[2] = dmb_real_select(g->own, rubs, power[2]);
}

static inline void add_forces(const dmb_wall_args *args, const wall_group *g, const dmb_real wrench[6])
{
    dmb_real force[6], magnitude[6];
    for (int i = 0; i < 6; i++) {
        force[i] = -wrench[i];
        magnitude[i] = dmb_real_abs(wrench[i]);
    }
    add_rows(g, force, args->residual);
    add_rows(g, magnitude, args->scale);
}

static inline void add_wall_powers(dmb_wall_args *args, const wall_group *g, const dmb_contact_force *c)
{
    const dmb_real *v = g->frame.speed;
    add_touching(rounding_of(g, c->by_depth[0]), g, &args->rounding);
    if (!args->dynamic) return;
    dmb_real power[3] = {-(c->elastic * v[0]), (c->F[0] + c->elastic) * v[0], c->F[1] * v[1] + c->F[2] * v[2]};
    if (dmb_mask_any(g->own)) set_own_powers(args, g, c, power);
    if (has_sections(args))
        power[0] = power[0] - g->section.stored * g->section.advance * dmb_vec3_dot(g->frame.t, g->frame.V);
    add_touching(power[0], g, &args->potential);
    add_touching(power[1], g, &args->impact);
    add_touching(power[2], g, &args->friction);
}

/* ---- Mean force of a step in which contact closes or opens (system/assemble/bounces.h) --------------------
 */

/* Contact points whose mark is at least `least`. */
static inline dmb_mask those_of(const uint8_t *marks, double least, const wall_group *g)
{
    dmb_real marked = dmb_real_of(0.0);
    for (int l = 0; l < DMB_REAL_LANES; l++) dmb_real_set_lane(&marked, l, marks[place_at(&g->site, (uint32_t)l)]);
    return dmb_mask_at_most(dmb_real_of(least), marked);
}

/* Contact points that close in the step, or change to the other side of the hole, without being resolved, and those
 * already integrated by a mean force. Contact points without clearance never open. */
static inline dmb_mask with_mean_force(const dmb_wall_args *args, const wall_group *g)
{
    const dmb_real zero = dmb_real_of(0.0), before = load_line(args->now.penetration, &g->site);
    const dmb_mask meets =
        dmb_mask_less(zero, g->penetration) & (dmb_mask_at_most(before, zero) | dmb_mask_less(g->turned, zero));
    const dmb_mask own = (meets & those_of(args->coarse, DMB_SITE_COARSE, g)) | those_of(args->mode, 1.0, g);
    return own & dmb_mask_less(zero, g->clearance);
}

/* [N/m] Derivative of the mean force with the measured depth, in a hole with sections. */
static inline dmb_real mean_slope(const dmb_wall_args *args, const wall_group *g)
{
    return args->own_factor * dmb_section_mean_slope(&g->section, load_line(args->now.penetration, &g->site),
                                                     g->penetration, g->impact_speed,
                                                     those_of(args->coarse, DMB_SITE_PLASTIC, g), args->step);
}

/* Axial component of the wall force where the radius changes with depth, and derivatives of the laws with depth. */
static inline void press_section(const dmb_wall_args *args, wall_group *g, const dmb_contact_force *c,
                                 dmb_real wrench[6])
{
    const int friction = args->friction_law != NULL;
    const dmb_real depth = dmb_real_max(g->penetration, dmb_real_of(DMB_CONTACT_PENETRATION));
    dmb_real slope = dmb_section_normal_slope(&g->section, depth, g->frame.speed[0], g->impact_speed);
    if (dmb_mask_any(g->own)) slope = dmb_real_select(g->own, mean_slope(args, g), slope);
    const dmb_section_site site = {.length = g->length,
                                   .penetration = depth,
                                   .normal_slope = slope,
                                   .friction = friction,
                                   .memory = args->dynamic && friction && dmb_friction_has_memory(args->friction_law)};
    dmb_section_force(&g->frame, c, &site, &g->section);
    dmb_vec3_axpy(g->section.along, g->frame.t, wrench);
}

/* [-] Ratio of the predicted penetration to that of rest above which the tangent is taken at rest: farther away Newton
 * only halves the distance in each iteration. */
#define DMB_MEAN_FAR 3.0

DMB_LANES_CALL void mean_of(const dmb_wall_args *args, const wall_group *g, dmb_real depth, dmb_normal_mean *mean)
{
    dmb_normal_mean_at(g->normal_law, load_line(args->now.penetration, &g->site), depth, g->impact_speed,
                       those_of(args->coarse, DMB_SITE_PLASTIC, g), args->step, mean);
}

/* *depth [m]: penetration at which the contact point alone comes to rest, if the prediction (free flight) is far from
 * it. */
static inline void come_to_rest(const dmb_wall_args *args, const wall_group *g, dmb_real *depth)
{
    enum { CORRECTIONS = 12 };
    const dmb_real before = load_line(args->now.penetration, &g->site), predicted = *depth;
    for (int k = 0; k < CORRECTIONS; k++) {
        dmb_normal_mean mean;
        mean_of(args, g, *depth, &mean);
        dmb_normal_mean_correct(predicted, dmb_real_of(args->yield), &mean, depth);
    }
    const dmb_real way = DMB_MEAN_FAR * dmb_real_abs(*depth - before);
    *depth = dmb_real_select(dmb_mask_less(way, predicted - *depth), *depth, predicted);
}

/* Force at the end of the step that is equivalent to the mean force (eq:contact.mean). The dissipated power counts
 * twice there (trapezoidal rule). Predicted depths are those of free flight, from which Newton converges slowly;
 * therefore the tangent is taken at the depth at which the contact point alone comes to rest. */
static inline void set_mean_force(const dmb_wall_args *args, wall_group *g, dmb_contact_force *c)
{
    dmb_normal_mean mean;
    const dmb_real scale = args->own_factor * g->length;
    dmb_real depth = g->penetration;
    if (args->yield > 0.0) come_to_rest(args, g, &depth);
    mean_of(args, g, depth, &mean);
    g->pressed = scale * mean.force;
    mean.force = mean.force + mean.d_depth * (g->penetration - depth);
    dmb_contact_set_own(g->own, scale * mean.force, scale * mean.d_depth, c);
    g->heat = -(2.0 / args->step) * (g->length * mean.taken);
}

/* If the history of the step already contains the mean force G, the force at the end of the step is own_factor (N - G)
 * + G instead of own_factor N. Friction is that of the whole mean force N. */
static inline void subtract_history(const dmb_wall_args *args, const wall_group *g, dmb_contact_force *c,
                                    dmb_real wrench[6])
{
    const dmb_real zero = dmb_real_of(0.0), carried = dmb_real_max(-load_line(args->site_history, &g->site), zero);
    const dmb_real off = dmb_real_select(g->own, (args->own_factor - 1.0) * carried, zero);
    c->F[0] = c->F[0] + off;
    for (int i = 0; i < 3; i++) wrench[i] = wrench[i] + off * g->frame.n[i];
}

static inline void keep_presses(const dmb_wall_args *args, const wall_group *g, dmb_real force)
{
    const uint32_t bits = dmb_mask_bits(g->touches & dmb_mask_less(dmb_real_of(0.0), force));
    for (uint32_t l = 0; l < g->site.used; l++) args->presses[g->site.first + l] = (uint8_t)(bits >> l & 1);
}

/* Weight of the damping in steps with touch or release (eq:touch.weights), and the history that it needs. Contact
 * points without clearance never open. */
static inline void weigh(const dmb_wall_args *args, const wall_group *g, dmb_normal_touch *touch,
                         dmb_real kept[DMB_TOUCH_SIZE])
{
    const dmb_real zero = dmb_real_of(0.0), one = dmb_real_of(1.0);
    dmb_real was[DMB_TOUCH_SIZE];
    load(args->now.touch, DMB_TOUCH_SIZE, DMB_TOUCH_SIZE, &g->site, 0, was);
    for (int i = 0; i < DMB_TOUCH_SIZE; i++) kept[i] = zero;
    kept[DMB_TOUCH_TIME] = was[DMB_TOUCH_TIME];
    touch->weight = one;
    touch->by_depth = zero;
    if (!args->dynamic || !(args->step > 0.0)) return;
    const dmb_mask opens = g->touches & dmb_mask_not(dmb_mask_at_most(g->clearance, zero));
    const dmb_real before = load_line(args->now.penetration, &g->site);
    dmb_normal_touch_at(dmb_real_select(opens, before, one), g->penetration, dmb_real_of(args->step), was, touch, kept);
    if (!dmb_mask_any(g->own)) return;
    touch->weight = dmb_real_select(g->own, one, touch->weight);
    touch->by_depth = dmb_real_select(g->own, zero, touch->by_depth);
    for (int i = 0; i < DMB_TOUCH_SIZE; i++) kept[i] = dmb_real_select(g->own, zero, kept[i]);
}

/* Without contact the touch history holds only the (tensile) force that the law would give; the time of opening is
 * interpolated from it. */
static inline void keep_touch(const dmb_wall_args *args, wall_group *g)
{
    const dmb_local_normal *law = g->normal_law;
    const dmb_real zero = dmb_real_of(0.0);
    dmb_real kept[DMB_TOUCH_SIZE] = {zero, zero, zero, zero};
    if (g->touching != lanes_used(&g->site)) {
        const dmb_real way = dmb_real_abs(g->penetration);
        const dmb_real spring = law->stiffness * dmb_normal_reduced_power(law->law->exponent, way) * way;
        kept[DMB_TOUCH_FORCE] = law->damping * g->frame.speed[0] - spring;
    }
    for (int i = 0; g->touching != 0 && i < DMB_TOUCH_SIZE; i++)
        kept[i] = dmb_real_select(g->touches, g->kept[i], kept[i]);
    store(kept, DMB_TOUCH_SIZE, &g->site, args->trial.touch);
}

/* Normal force, its damping weighted where that jumps at touch. */
DMB_LANES_INLINE void press_normally(const dmb_wall_args *args, wall_group *g, dmb_contact_force *c)
{
    const dmb_local_normal *law = g->normal_law;
    dmb_contact_depth at = {dmb_real_max(g->penetration, dmb_real_of(DMB_CONTACT_PENETRATION)), g->impact_speed, NULL};
    if (!args->touches) {
        dmb_contact_normal_force(law, &g->frame, g->length, &at, c);
        if (dmb_mask_any(g->own)) set_mean_force(args, g, c);
        return;
    }
    dmb_normal_touch touch;
    weigh(args, g, &touch, g->kept);
    at.touch = &touch;
    dmb_contact_normal_force(law, &g->frame, g->length, &at, c);
    g->kept[DMB_TOUCH_FORCE] = c->whole;
    if (has_sections(args)) g->section.damping_slope = g->section.damping_slope * touch.weight;
    if (dmb_mask_any(g->own)) set_mean_force(args, g, c);
}

/* Contact forces and their wrench in body axes. */
DMB_LANES_INLINE void find_force(const dmb_wall_args *args, wall_group *g, dmb_contact_force *c, dmb_real wrench[6])
{
    const int friction = args->friction_law != NULL;
    c->F[1] = c->F[2] = dmb_real_of(0.0);
    press_normally(args, g, c);
    if (friction) add_friction(args, g, c);
    if (args->bounces) keep_presses(args, g, -c->F[0]);
    dmb_contact_wrench(&g->frame, c, friction, wrench);
    if (has_sections(args)) press_section(args, g, c, wrench);
    if (dmb_mask_any(g->own)) subtract_history(args, g, c, wrench);
}

static inline void press(dmb_wall_args *args, wall_group *g)
{
    const int arms =
        dmb_mask_any(dmb_mask_less(g->offset, dmb_real_of(0.0)) | dmb_mask_less(dmb_real_of(0.0), g->offset));
    dmb_contact_force c;
    dmb_real wrench[6];
    find_force(args, g, &c, wrench);
    if (args->tangent) add_tangent(args, g, g->touching, arms, &c, wrench);
    dmb_arm_wrench(g->offset, wrench);
    add_forces(args, g, wrench);
    add_wall_powers(args, g, &c);
}

/* Contact points that touch. */
DMB_LANES_INLINE void find_touching(const dmb_wall_args *args, wall_group *g)
{
    const dmb_real zero = dmb_real_of(0.0);
    g->own = dmb_mask_less(zero, zero);
    if (args->bounces) g->own = with_mean_force(args, g);
    g->touches = dmb_mask_less(zero, g->penetration) | dmb_mask_at_most(g->clearance, zero) | g->own;
    g->touching = dmb_mask_bits(g->touches) & lanes_used(&g->site);
    if (args->bristles && !args->called) begin_bristles(args, g);
    if (g->touching == 0 && args->bounces) keep_presses(args, g, zero);
}

/* Bristles and touch history, which the next step reads. */
static inline void keep_memory(const dmb_wall_args *args, wall_group *g)
{
    if (args->bristles && !args->called) keep_bristles(args, g);
    if (args->bristles && args->called) keep_called(args, g);
    if (args->touches) keep_touch(args, g);
}

static void walls(dmb_wall_args *args)
{
    const wall_laws laws = laws_of(args);
    for (uint32_t first = 0; first < args->count; first += DMB_REAL_LANES) {
        wall_group g;
        g.site = group_at(first, args->count);
        g.inside = NULL;
        load_sites(args, &g);
        load_motion(args, &g);
        place_sites(args, &laws, &g);
        find_touching(args, &g);
        if (g.touching) press(args, &g);
        keep_memory(args, &g);
    }
}

#endif
