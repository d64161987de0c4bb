/* Chains (strings and bodies) moved as rigid bodies to close joints at the start; no element is strained by it.
 *
 * Placement by joints (dmb_place_by_joints): let H = (R, p) be frame b of a joint seen from frame a as described, with
 * coordinates c (eq:joints.coordinates, eq:joints.placement). The joint holds at H* with c* = c in the free
 * coordinates, the given value in those that the caller gives, and 0 in the others, so that frames are never flipped.
 * If the chain of a is placed, that of b follows by the world motion that rotates by Q about the origin x_b of frame b
 * and translates by d,
 *
 *     Q = R_a R* R^T R_a^T        d = R_a (p* - p)
 *
 * and the chain of a, if that of b is placed, by Q = R_b R*^T R R_b^T, d = R_b R*^T (p - p*). Chains placed first: the
 * ground and chains constrained at several nodes; then chains constrained at one node; then free ones. From each of
 * them, joints are passed in both orders of the list until no further chain can be placed. This closes every tree of
 * joints over any distance and rotation; joints that close loops remain open. */
#include <math.h>
#include <string.h>

#include "math/se3.h"
#include "math/so3.h"
#include "math/vec3.h"
#include "sim/node.h"
#include "system/constrain/constrain.h"

/* ---- Rigid motion of a chain ------------------------------------------------------------------------------------- */

uint32_t dmb_chain_base(const dmb_scene *scene, const dmb_chain *chain, double open[6])
{
    uint32_t base = DMB_NONE, held = 0;
    for (int c = 0; c < 6; c++) open[c] = 1.0;
    for (uint32_t i = chain->first; i < chain->first + chain->count; i++) {
        const uint8_t *solved = scene->solved_row + scene->layout.row[i];
        uint32_t here = 0;
        if (scene->layout.size[i] != DMB_NODE_SIX_DOF) return DMB_NONE;
        for (int c = 0; c < 6; c++) here += solved[c] == 0;
        if (here == 0) continue;
        if (++held > 1) return DMB_NONE;
        base = i;
        for (int c = 0; c < 6; c++) open[c] = solved[c] ? 1.0 : 0.0;
    }
    return base == DMB_NONE ? chain->first : base;
}

/* Node i moves with the rigid body; `turned` is Q as a quaternion. */
static void move_node(dmb_sim *sim, uint32_t i, const dmb_rigid_motion *motion, const double turned[4])
{
    const double *X = sim->scene->reference_position, *u = motion->before;
    const size_t at = 3 * (size_t)i, from = 3 * (size_t)motion->node;
    double *ui = sim->trial.displacement + at, *q = sim->trial.quaternion + 4 * (size_t)i, away[3], to[3];
    for (size_t k = 0; k < 3; k++) away[k] = (X[at + k] - X[from + k]) + (ui[k] - u[k]);
    dmb_mat3_vec(motion->Q, away, to);
    for (int k = 0; k < 3; k++) ui[k] += (motion->after[k] - u[k]) + (to[k] - away[k]);
    dmb_quat_mul(turned, q, q);
    dmb_quat_normalize(q);
}

void dmb_chain_follow(dmb_sim *sim, const dmb_chain *chain, const dmb_rigid_motion *motion)
{
    double turned[4];
    dmb_quat_from_matrix(motion->Q, turned);
    for (uint32_t i = chain->first; i < chain->first + chain->count; i++)
        if (i != motion->node) move_node(sim, i, motion, turned);
}

/* ---- Where a joint holds ----------------------------------------------------------------------------------------- */

/* Coordinates that remain unchanged, by kind of joint; DMB_NO_FORM for kinds without such a form. */
#define DMB_NO_FORM 0xFFu
static uint32_t free_coordinates(const dmb_scene_joint *joint)
{
    switch (joint->kind) {
    case DMB_JOINT_POINT_ON_HOLE: return dmb_joint_free_mask(DMB_JOINT_POINT_ON_LINE);
    case DMB_JOINT_DISTANCE: return dmb_joint_free_mask(DMB_JOINT_DISTANCE);
    case DMB_JOINT_ROLLING:
    case DMB_JOINT_KNIFE_EDGE: return DMB_NO_FORM;
    default:
        return joint->kind == DMB_JOINT_FREE && joint->initial_mask == 0 ? DMB_NO_FORM
                                                                         : dmb_joint_free_mask(joint->kind);
    }
}

/* R = Ry(RY) Rz(RZ) Rx(RX) */
static void rotation_of(const double angle[3], double R[9])
{
    double turn[3][9], yz[9];
    for (int i = 0; i < 3; i++) {
        double about[3] = {0.0, 0.0, 0.0};
        about[i] = angle[i];
        dmb_so3_exp(about, NULL, turn[i]);
    }
    dmb_mat3_mul(turn[1], turn[2], yz);
    dmb_mat3_mul(yz, turn[0], R);
}

/* Scales p to the distance of the joint; along the x axis of frame a if the two points coincide. */
static void stretch_to(double length, double p[3])
{
    const double now = dmb_vec3_norm(p);
    if (now > 0.0)
        dmb_vec3_scale(length / now, p, p);
    else
        dmb_vec3_set(length, 0.0, 0.0, p);
}

/* H* of joint j from H; 0: the joint does not determine it. */
static int place_of_joint(const dmb_sim *sim, uint32_t j, const dmb_relative *now, double R[9], double p[3])
{
    static const double none[2] = {0.0, 0.0};
    const dmb_scene_joint *joint = sim->scene->joints + j;
    const uint32_t left = free_coordinates(joint);
    const double *lock = sim->joint_lock + 12 * (size_t)j;
    dmb_joint_coordinates c;
    if (sim->joint_state[j] == DMB_JOINT_LOCKED) {
        dmb_mat3_copy(lock, R);
        dmb_vec3_copy(lock + 9, p);
        return 1;
    }
    if (sim->joint_state[j] != DMB_JOINT_ACTIVE || left == DMB_NO_FORM) return 0;
    dmb_joint_coordinates_at(now->R, now->p, now->V, none, &c);
    for (uint32_t i = 0; i < 6; i++) {
        if ((left >> i & 1) == 0) c.value[i] = 0.0;
        if (joint->initial_mask >> i & 1) c.value[i] = joint->initial_position[i];
    }
    dmb_vec3_copy(c.value, p);
    if (joint->kind == DMB_JOINT_DISTANCE) stretch_to(joint->length, p);
    rotation_of(c.value + 3, R);
    return 1;
}

/* ---- Placement --------------------------------------------------------------------------------------------------- */

/* Mark of a placed chain, in the increment of its first row. */
static double *mark_of_chain(dmb_sim *sim, uint32_t node)
{
    const dmb_scene *scene = sim->scene;
    return sim->increment + scene->layout.row[scene->chains[scene->node_chain[node]].first];
}

static int is_placed(dmb_sim *sim, uint32_t node)
{
    return node == DMB_NONE || *mark_of_chain(sim, node) > 0.0;
}

/* Joint that places a chain. */
typedef struct placing {
    uint32_t joint;
    int of_b; /* 1: the chain of frame b moves, 0: that of frame a */
    dmb_relative now;
    double R[9], p[3]; /* H* */
} placing;

/* Motion of that chain by Q and d, given at the node of the joint. */
static void motion_of(const dmb_sim *sim, const placing *by, dmb_rigid_motion *motion)
{
    const dmb_scene *scene = sim->scene;
    const dmb_scene_frame *b = &scene->joints[by->joint].b;
    const double *X = scene->reference_position;
    double node_b[9], unused[9], ub[3], Rb[9], arm[3], x[3], left[9], shift[3], d[3], Ra[9];
    dmb_node_pose(scene, &sim->trial, b->node, node_b, ub);
    dmb_node_pose(scene, &sim->trial, motion->node, unused, motion->before);
    dmb_mat3_mul(node_b, b->M, Rb);
    dmb_mat3_vec(node_b, b->x, arm);
    dmb_mat3_mul_nt(Rb, by->of_b ? by->now.R : by->R, Ra); /* axes of frame a, before or after */
    dmb_mat3_mul(Ra, by->of_b ? by->R : by->now.R, left);
    dmb_mat3_mul_nt(left, Rb, motion->Q);
    dmb_vec3_sub(by->p, by->now.p, shift);
    dmb_vec3_scale(by->of_b ? 1.0 : -1.0, shift, shift);
    dmb_mat3_vec(Ra, shift, d);
    for (size_t i = 0; i < 3; i++) /* the node from the origin of frame b */
        x[i] = (X[3 * (size_t)motion->node + i] - X[3 * (size_t)b->node + i]) + (motion->before[i] - ub[i]) - arm[i];
    dmb_mat3_vec(motion->Q, x, motion->after);
    for (int i = 0; i < 3; i++) motion->after[i] += motion->before[i] - x[i] + d[i];
}

#define DMB_SUPPORT_ROUNDING 1e-9 /* [-] largest component of a motion, relative to its size, that counts as 0 */

/* 1: the supports of the chain's base permit the motion, i.e. constrained components of the logarithm of the base's
 * motion are 0. */
static int is_allowed(const dmb_sim *sim, const dmb_chain *chain, const dmb_rigid_motion *motion)
{
    const dmb_scene *scene = sim->scene;
    const double *X = scene->reference_position;
    double open[6], R[9], u[3], away[3], to[3], x[3], QR[9], turned[9], z[6], size = 1.0;
    const uint32_t base = dmb_chain_base(scene, chain, open);
    if (base == DMB_NONE) return 0;
    dmb_node_pose(scene, &sim->trial, base, R, u);
    for (size_t k = 0; k < 3; k++)
        away[k] = (X[3 * (size_t)base + k] - X[3 * (size_t)motion->node + k]) + (u[k] - motion->before[k]);
    dmb_mat3_vec(motion->Q, away, to);
    for (int k = 0; k < 3; k++) to[k] += motion->after[k] - motion->before[k] - away[k];
    dmb_mat3_tvec(R, to, x);
    dmb_mat3_mul(motion->Q, R, QR);
    dmb_mat3_mul_tn(R, QR, turned);
    dmb_se3_log(turned, x, NULL, z);
    for (int c = 0; c < 6; c++) size = fmax(size, fabs(z[c]));
    for (int c = 0; c < 6; c++)
        if (open[c] == 0.0 && fabs(z[c]) > DMB_SUPPORT_ROUNDING * size) return 0;
    return 1;
}

/* Moves the chain of frame b or a to close joint j; 0: its supports do not permit that and it stays. */
static int place_by(dmb_sim *sim, uint32_t j, int of_b)
{
    const dmb_scene *scene = sim->scene;
    placing by = {.joint = j, .of_b = of_b};
    dmb_rigid_motion motion = {.node = of_b ? scene->joints[j].b.node : scene->joints[j].a.node};
    const dmb_chain *chain = scene->chains + scene->node_chain[motion.node];
    double turned[4];
    dmb_joint_motion(scene, &sim->trial, j, &by.now, NULL);
    if (!place_of_joint(sim, j, &by.now, by.R, by.p)) return 0;
    motion_of(sim, &by, &motion);
    if (!is_allowed(sim, chain, &motion)) return 0;
    dmb_chain_follow(sim, chain, &motion);
    dmb_quat_from_matrix(motion.Q, turned);
    move_node(sim, motion.node, &motion, turned);
    *mark_of_chain(sim, motion.node) = 1.0;
    return 1;
}

/* One pass over the joints, up or down the list; returns the number of chains placed. */
static uint32_t place_neighbours(dmb_sim *sim, int down)
{
    const dmb_scene *scene = sim->scene;
    uint32_t count = 0;
    for (uint32_t k = 0; k < scene->joint_count; k++) {
        const uint32_t j = down ? scene->joint_count - 1 - k : k, a = scene->joints[j].a.node,
                       b = scene->joints[j].b.node;
        const int has_a = is_placed(sim, a), has_b = is_placed(sim, b);
        if (has_a != has_b) count += (uint32_t)place_by(sim, j, has_a);
    }
    return count;
}

static void place_all_from_here(dmb_sim *sim)
{
    int down = 0;
    while (place_neighbours(sim, down) + place_neighbours(sim, !down) > 0) down = !down;
}

/* Rank of a chain: 0 constrained at several nodes or on the axis of the hole (it does not move), 1 at one node, 2 free.
 */
static int rank_of(const dmb_scene *scene, const dmb_chain *chain)
{
    double open[6], sum = 0.0;
    if (dmb_chain_base(scene, chain, open) == DMB_NONE) return 0;
    for (int c = 0; c < 6; c++) sum += open[c];
    return sum == 0.0 ? 0 : sum < 6.0 ? 1 : 2;
}

void dmb_place_by_joints(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    memset(sim->increment, 0, scene->row_count * sizeof(double));
    for (uint32_t c = 0; c < scene->chain_count; c++)
        if (rank_of(scene, scene->chains + c) == 0) *mark_of_chain(sim, scene->chains[c].first) = 1.0;
    place_all_from_here(sim);
    for (int rank = 1; rank <= 2; rank++)
        for (uint32_t c = 0; c < scene->chain_count; c++) {
            const uint32_t first = scene->chains[c].first;
            if (is_placed(sim, first) || !scene->chains[c].jointed || rank_of(scene, scene->chains + c) != rank)
                continue;
            *mark_of_chain(sim, first) = 1.0;
            place_all_from_here(sim);
        }
    memset(sim->increment, 0, scene->row_count * sizeof(double));
}
