/* Contact points inside elements side by side: for the wall a contact point is one on a node of its own, whose pose H
 * and velocity V are those of the section (eq:contact.inside):
 *
 *     V = A(d) v,   residual r = A^T f,   f = -wrench(H, V)
 *     dr = (d A^T) f + A^T [f_H A + f_V dA v] dq + A^T f_V A dv
 *
 * with A the map of element/section_math.h, v the velocities of both nodes, dq their body-frame displacements, and
 * f_H, f_V the derivatives by force/contact_law.h for a node. Both nodes have six degrees of freedom. */
#ifndef DMB_KERNEL_LANES_WALL_INSIDE_H
#define DMB_KERNEL_LANES_WALL_INSIDE_H

#include "element/section_math.h"
#include "kernel/lanes_wall.h"

#if DMB_REAL_LANES == 8
extern const dmb_kernels dmb_kernels_4;

/* In halves: at the full width blocks would take more stack than the library states. Same bits. */
static void walls_inside(dmb_wall_args *args, const dmb_inside_args *inside)
{
    dmb_kernels_4.walls_inside(args, inside);
}

/* There are none at the full width. */
static inline void section_velocity_before(const dmb_wall_args *args, const wall_group *g, dmb_real V[3])
{
    (void)args, (void)g;
    dmb_vec3_zero(V);
}
#else

/* Sections of a group, and the places of their far nodes; the near ones are those of the group. */
typedef struct wall_section {
    dmb_section_shape shape;
    dmb_real d[6];
    dmb_section_constants constants;
    dmb_real v[12];
    dmb_section_frame frame;
    const dmb_inside_args *args;
    lane_places node, row;
} wall_section;

/* Motion of both nodes at one instant. */
typedef struct wall_section_nodes {
    const double *displacement, *quaternion, *velocity;
} wall_section_nodes;

static inline void places_ahead(const lane_places *from, size_t by, lane_places *to)
{
    to->together = from->together;
    for (int l = 0; l < (from->together ? 1 : DMB_REAL_LANES); l++) to->place[l] = from->place[l] + by;
}

static inline size_t node_of(const wall_group *g, int lane)
{
    return g->node.together ? g->node.place[0] + (size_t)lane : g->node.place[lane];
}

static inline void load_sections(const dmb_wall_args *args, const dmb_inside_args *inside, wall_group *g,
                                 wall_section *in)
{
    dmb_real fraction = dmb_real_of(0.0);
    load_sites(args, g);
    g->offset = dmb_real_of(0.0); /* the section itself */
    g->inside = in;
    in->args = inside;
    places_ahead(&g->node, 1, &in->node);
    places_ahead(&g->row, 6, &in->row);
    for (int l = 0; l < DMB_REAL_LANES; l++) {
        const size_t point = place_at(&g->site, (uint32_t)l);
        const uint32_t element = inside->node_element[node_of(g, l)];
        dmb_section_load_constants(inside->types + inside->element_type[element], l, &in->constants);
        dmb_real_set_lane(&fraction, l, inside->fraction[inside->stride * point]);
    }
    dmb_section_shape_of(&in->constants, fraction, &in->shape);
}

/* Vector from node a to node b [m], world. */
static inline void load_section_span(const wall_section_nodes *nodes, const wall_group *g, const wall_section *in,
                                     dmb_real ua[3], dmb_real span[3])
{
    dmb_real ub[3];
    load_at(nodes->displacement, 3, 3, &g->node, ua);
    load_at(nodes->displacement, 3, 3, &in->node, ub);
    for (int l = 0; l < DMB_REAL_LANES; l++) {
        const double *at = in->args->span + 3 * (size_t)in->args->node_element[node_of(g, l)];
        for (int i = 0; i < 3; i++) dmb_real_set_lane(span + i, l, at[i]);
    }
    for (int i = 0; i < 3; i++) span[i] = span[i] + (ub[i] - ua[i]);
}

/* Pose, in the group's R and x, and velocity V of the sections; Ra: axes of the near nodes. */
static inline void move_sections(const dmb_wall_args *args, const wall_section_nodes *nodes, wall_group *g,
                                 wall_section *in, dmb_real V[6])
{
    dmb_real qa[4], qb[4], Ra[9], Q[9], ua[3], span[3], r[3];
    load_at(nodes->quaternion, 4, 4, &g->node, qa);
    load_at(nodes->quaternion, 4, 4, &in->node, qb);
    dmb_quat_to_matrix(qa, Ra);
    load_section_span(nodes, g, in, ua, span);
    dmb_section_strain(in->constants.arm, qa, Ra, qb, span, in->d);
    dmb_section_frame_at(&in->shape, in->d, &in->frame);
    dmb_section_place(&in->frame, in->constants.arm[0], Q, r);
    dmb_mat3_mul(Ra, Q, g->R);
    dmb_mat3_vec(Ra, r, r);
    load_at(args->reference, 3, 3, &g->node, g->x);
    for (int i = 0; i < 3; i++) g->x[i] = g->x[i] + (ua[i] + r[i]);
    if (!args->dynamic) return;
    load_at(nodes->velocity, 1, 6, &g->row, in->v);
    load_at(nodes->velocity, 1, 6, &in->row, in->v + 6);
    dmb_section_twist(in->constants.arm, &in->shape, &in->frame, in->v, V);
}

DMB_LANES_CALL void move_sections_before(const dmb_wall_args *args, const wall_group *g, dmb_real V[3])
{
    const wall_section_nodes nodes = {g->inside->args->now_displacement, args->now_quaternion, args->now_velocity};
    wall_group then;
    wall_section in = *g->inside;
    dmb_real v[6];
    then.node = g->node;
    then.row = g->row;
    for (int i = 0; i < 6; i++) v[i] = dmb_real_of(0.0);
    move_sections(args, &nodes, &then, &in, v);
    dmb_mat3_vec(then.R, v, V);
}

static inline void section_velocity_before(const dmb_wall_args *args, const wall_group *g, dmb_real V[3])
{
    move_sections_before(args, g, V);
}

/* ---- Tangent ----------------------------------------------------------------------------------------------------- */

/* Parts of the tangent are calls, so that their stack is used again by the next. */

/* The map A by nodes: rows of A are the transposes of A^T of unit wrenches. */
DMB_LANES_CALL void find_map(const wall_section *in, dmb_real A[2][36])
{
    for (int k = 0; k < 6; k++) {
        dmb_real unit[6], f[12];
        for (int i = 0; i < 6; i++) unit[i] = dmb_real_of(i == k ? 1.0 : 0.0);
        dmb_section_wrench(in->constants.arm, &in->shape, &in->frame, unit, f);
        dmb_vec6_copy(f, A[0] + 6 * k);
        dmb_vec6_copy(f + 6, A[1] + 6 * k);
    }
}

/* K = G dd/dq of both nodes, dd/dq = (-T6^-1(-d), T6^-1(d)), transferred by the arms. */
DMB_LANES_CALL void by_nodes(const wall_section *in, const dmb_real G[36], dmb_real Ka[36], dmb_real Kb[36])
{
    dmb_se3_tangent back;
    const dmb_real none = dmb_real_of(0.0);
    dmb_se3_tangent_reverse(&in->frame.S, &back);
    for (int i = 0; i < 36; i++) {
        Ka[i] = -G[i];
        Kb[i] = G[i];
    }
    dmb_se3_times_tangent(Ka, 6, &back);
    dmb_se3_times_tangent(Kb, 6, &in->frame.S);
    dmb_beam_block_to_nodes(none, in->constants.arm[0], Ka);
    dmb_beam_block_to_nodes(none, -in->constants.arm[1], Kb);
}

/* K[i][j] += A_i^T M A_j */
DMB_LANES_CALL void add_mapped(dmb_real A[2][36], const dmb_real M[36], dmb_real K[2][2][36])
{
    dmb_real MA[36], product[36];
    for (int j = 0; j < 2; j++) {
        dmb_mat6_mul(M, A[j], MA);
        for (int i = 0; i < 2; i++) {
            dmb_mat6_mul_tn(A[i], MA, product);
            dmb_mat6_add(K[i][j], product, K[i][j]);
        }
    }
}

/* Diagonal blocks are added lane by lane, since neighbours share nodes. */
DMB_LANES_CALL void add_diagonal(const dmb_wall_args *args, const wall_group *g, dmb_real K[2][2][36], double *blocks)
{
    double rows[2][DMB_REAL_LANES * LANES_BLOCK];
    for (int i = 0; i < 2; i++) store_together(K[i][i], LANES_BLOCK, rows[i]);
    for (int l = 0; l < DMB_REAL_LANES; l++) {
        double *to = blocks + args->diagonal[node_of(g, l)]; /* the far node's block is the next one */
        if (!(g->touching >> l & 1)) continue;
        for (int k = 0; k < LANES_BLOCK; k++) to[k] += rows[0][LANES_BLOCK * l + k];
        for (int k = 0; k < LANES_BLOCK; k++) to[LANES_BLOCK + k] += rows[1][LANES_BLOCK * l + k];
    }
}

static inline void add_off_diagonal(const wall_group *g, const wall_section *in, dmb_real K[2][2][36])
{
    const dmb_inside_args *args = in->args;
    double *upper[DMB_REAL_LANES], *lower[DMB_REAL_LANES];
    for (int l = 0; l < DMB_REAL_LANES; l++) {
        upper[l] = args->upper + args->link[node_of(g, l)];
        lower[l] = args->lower + args->link[node_of(g, l)];
    }
    add_lanes(K[0][1], LANES_BLOCK, g->touching, upper);
    add_lanes(K[1][0], LANES_BLOCK, g->touching, lower);
}

/* Blocks by pose of the columns' node become those by the increment z of the step: times T6(z). Diagonal blocks get it
 * later, with the others of their node. */
DMB_LANES_CALL void by_increments(const wall_group *g, const wall_section *in, dmb_real K[2][2][36])
{
    for (int j = 0; j < 2; j++) {
        dmb_real z[6];
        dmb_se3_tangent T;
        load_at(in->args->increment, 1, 6, j == 0 ? &g->row : &in->row, z);
        dmb_se3_tangent_at(z, NULL, &T);
        dmb_se3_times_tangent(K[1 - j][j], 6, &T);
    }
}

/* G, shape (12, 6): change of A^T f with d at constant f = -wrench. */
DMB_LANES_CALL void find_force_change(const wall_section *in, const dmb_real wrench[6], dmb_real G[2][36])
{
    dmb_real f[6];
    for (int i = 0; i < 6; i++) f[i] = -wrench[i];
    dmb_section_force_change(in->constants.arm, &in->shape, &in->frame, in->d, f, G[0], G[1]);
}

/* G += A^T f_V dV/dd */
DMB_LANES_CALL void add_twist_change(const wall_section *in, dmb_real A[2][36], const dmb_real V[36], dmb_real G[2][36])
{
    dmb_real W[36], M[36];
    dmb_section_twist_change(in->constants.arm, &in->shape, &in->frame, in->d, in->v, W);
    dmb_mat6_mul(V, W, M);
    for (int i = 0; i < 2; i++) {
        dmb_mat6_mul_tn(A[i], M, W);
        dmb_mat6_add(G[i], W, G[i]);
    }
}

/* Adds C = A^T f_V A times the factor of the step. V: f_V; K: workspace. */
DMB_LANES_CALL void add_inertia(const dmb_wall_args *args, const wall_group *g, const wall_section *in,
                                dmb_real A[2][36], dmb_real V[36], dmb_real K[2][2][36])
{
    for (int i = 0; i < 36; i++) V[i] = args->velocity_factor * V[i];
    for (int i = 0; i < 4; i++) dmb_mat6_zero(K[i / 2][i % 2]);
    add_mapped(A, V, K);
    add_diagonal(args, g, K, args->inertia);
    add_off_diagonal(g, in, K);
}

/* M = f_H */
DMB_LANES_CALL void find_pose(const dmb_wall_args *args, const wall_group *g, const dmb_contact_force *c,
                              const dmb_real wrench[6], dmb_real M[36])
{
    find_pose_tangent(args, g, c, wrench, M);
    for (int i = 0; i < 36; i++) M[i] = -M[i];
}

DMB_LANES_CALL void add_inside_tangent(const dmb_wall_args *args, const wall_group *g, const wall_section *in,
                                       const dmb_contact_force *c, const dmb_real wrench[6])
{
    dmb_real A[2][36], G[2][36], M[36], K[2][2][36];
    find_map(in, A);
    find_force_change(in, wrench, G);
    if (args->dynamic) {
        find_velocity_tangent(args, g, c, -1.0, M);
        add_twist_change(in, A, M, G);
        add_inertia(args, g, in, A, M, K);
    }
    for (int i = 0; i < 2; i++) by_nodes(in, G[i], K[i][0], K[i][1]);
    find_pose(args, g, c, wrench, M);
    add_mapped(A, M, K);
    add_diagonal(args, g, K, args->stiffness);
    if (in->args->inertia_only) return;
    if (args->dynamic) by_increments(g, in, K);
    add_off_diagonal(g, in, K);
}

/* ---- Forces ------------------------------------------------------------------------------------------------------ */

/* Rows of both nodes are neighbours. */
static inline void add_inside_forces(const dmb_wall_args *args, const wall_group *g, const dmb_real f[12])
{
    enum { ROWS = 12 };
    double rows[DMB_REAL_LANES * ROWS];
    store_together(f, ROWS, rows);
    for (int l = 0; l < DMB_REAL_LANES; l++) {
        const size_t row = g->row.together ? g->row.place[0] + 6 * (size_t)l : g->row.place[l];
        const double *from = rows + ROWS * (size_t)l;
        for (int i = 0; i < ROWS && g->touching >> l & 1; i++) {
            args->residual[row + (size_t)i] -= from[i];
            args->scale[row + (size_t)i] += fabs(from[i]);
        }
    }
}

static inline void press_inside(dmb_wall_args *args, wall_group *g, const wall_section *in)
{
    dmb_contact_force c;
    dmb_real wrench[6], f[12];
    find_force(args, g, &c, wrench);
    if (args->tangent) add_inside_tangent(args, g, in, &c, wrench);
    dmb_section_wrench(in->constants.arm, &in->shape, &in->frame, wrench, f);
    add_inside_forces(args, g, f);
    add_wall_powers(args, g, &c);
}

static void walls_inside(dmb_wall_args *args, const dmb_inside_args *inside)
{
    const wall_section_nodes nodes = {args->displacement, args->quaternion, args->velocity};
    const wall_laws laws = laws_of(args);
    for (uint32_t first = 0; first < args->count; first += DMB_REAL_LANES) {
        wall_group g;
        wall_section in;
        g.site = group_at(first, args->count);
        load_sections(args, inside, &g, &in);
        move_sections(args, &nodes, &g, &in, g.frame.V);
        place_sites(args, &laws, &g);
        find_touching(args, &g);
        if (g.touching) press_inside(args, &g, &in);
        keep_memory(args, &g);
    }
}

#endif

#endif
