/* A contact point inside an element is treated by the wall as one on a separate node, whose pose H and velocity V are
 * those of the section:
 *
 *     V = A(d) v,   residual r = A^T f,   f = -wrench(H, V)
 *     dr = (d A^T) f + A^T [f_H A + f_V dA v] dq + A^T f_V A dv
 *
 * with A the map of element/beam.h, v the velocities of both nodes, dq their body-frame displacements, and
 * f_H, f_V the derivatives by force/contact_law.h for a node. */
#include "system/assemble/assemble.h"

#include <string.h>

#include "element/beam.h"
#include "math/mat6.h"
#include "math/so3.h"
#include "sim/node.h"
#include "system/assemble/bounces.h"

/* Element of the contact points, evaluated once for all of them. */
typedef struct host {
    const dmb_element_type *type;
    uint32_t element, node;
    int32_t bending;
    double Ra[9], ua[3]; /* of its first node */
    double d[6], v[12];
} host;

static void host_of(const dmb_scene *scene, const dmb_configuration *c, const dmb_scene_point *point, host *of)
{
    double Rb[9], ub[3], span[3];
    const uint32_t a = point->node;
    of->type = scene->types + scene->element_type[point->element];
    of->element = point->element;
    of->node = a;
    of->bending =
        scene->layout.size[a] != DMB_NODE_AXIAL_TORSIONAL || scene->layout.size[a + 1] != DMB_NODE_AXIAL_TORSIONAL;
    dmb_node_pose(scene, c, a, of->Ra, of->ua);
    dmb_node_pose(scene, c, a + 1, Rb, ub);
    dmb_vec3_sub(ub, of->ua, span);
    dmb_vec3_add(span, scene->element_span + 3 * (size_t)point->element, span);
    dmb_section_ends(of->type, of->Ra, Rb, span, of->d);
    dmb_node_vector(scene, c, a, c->velocity, of->v);
    dmb_node_vector(scene, c, a + 1, c->velocity, of->v + 6);
}

/* A section of it: R = R_a R_1 R_2, x = u_a + R_a (r_1 + R_1 r_2), V = A v. */
typedef struct section {
    dmb_section_shape shape;
    dmb_section_frame frame;
    double R[9], x[3], V[6];
} section;

static void section_of(const host *of, const dmb_scene_point *point, section *at)
{
    double Q[9], r[3];
    dmb_section_shape_at(of->type, point->fraction, of->bending, &at->shape);
    dmb_section_frame_at(&at->shape, of->d, &at->frame);
    dmb_section_twist(of->type, &at->shape, &at->frame, of->v, at->V);
    dmb_mat3_mul(at->frame.R[0], at->frame.R[1], Q);
    dmb_mat3_vec(at->frame.R[0], at->frame.x[1], r);
    dmb_vec3_add(r, at->frame.x[0], r);
    r[0] += of->type->arm[0];
    dmb_mat3_mul(of->Ra, Q, at->R);
    dmb_mat3_vec(of->Ra, r, at->x);
    dmb_vec3_add(at->x, of->ua, at->x);
}

/* Node that represents the section. */
typedef struct section_node {
    double displacement[3], quaternion[4], velocity[6];
    double now_quaternion[4], now_velocity[6];
    double residual[6], scale[6], stiffness[36], inertia[36];
    dmb_site site;
} section_node;

static void read_motion(const section *motion, double quaternion[4], double velocity[6])
{
    dmb_quat_from_matrix(motion->R, quaternion);
    dmb_quat_normalize(quaternion);
    dmb_vec6_copy(motion->V, velocity);
}

static void read_node(const dmb_sim *sim, uint32_t s, const section *motion, section_node *at)
{
    memset(at, 0, sizeof *at);
    dmb_vec3_copy(motion->x, at->displacement);
    read_motion(motion, at->quaternion, at->velocity);
    at->site = sim->scene->sites[s];
    at->site.node = 0;
    at->site.offset = 0.0;
    at->now_quaternion[0] = 1.0;
}

/* ---- Tangent ----------------------------------------------------------------------------------------------------- */

/* out (6, 12) += M B */
static void add_product(const double M[36], const double B[72], double out[72])
{
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++)
            for (int k = 0; k < 12; k++) out[12 * i + k] += M[6 * i + j] * B[12 * j + k];
}

/* out (12, 12) += A^T B */
static void add_transposed_product(const double A[72], const double B[72], double out[144])
{
    for (int i = 0; i < 6; i++)
        for (int r = 0; r < 12; r++)
            for (int k = 0; k < 12; k++) out[12 * r + k] += A[12 * i + r] * B[12 * i + k];
}

static void add_block(const dmb_evaluation *evaluation, const dmb_point_motion *motion, int by, const double K[144])
{
    dmb_force_tangent tangent;
    dmb_force_tangent_begin(&tangent);
    dmb_force_tangent_touch(evaluation->sim->scene, motion, &tangent);
    dmb_force_tangent_clear(&tangent);
    dmb_force_tangent_block(evaluation->sim->scene, &tangent, motion, 1.0, K);
    dmb_force_tangent_add(evaluation, DMB_NONE, by, &tangent);
}

/* The two nodes, for additions to their blocks. */
static void nodes_of(const host *of, dmb_point_motion *motion)
{
    motion->nodes = 2;
    motion->node[0] = of->node;
    motion->node[1] = of->node + 1;
}

/* dA v enters with the velocity tangent f_V, dA dq with that by displacements. */
static void add_tangent(const dmb_evaluation *evaluation, const host *of, const section *in, const section_node *at)
{
    double map[72], K[144], W[72], rows[72] = {0.0};
    dmb_point_motion motion;
    nodes_of(of, &motion);
    dmb_section_map(of->type, &in->shape, of->d, map);
    dmb_section_map_changes(of->type, &in->shape, &in->frame, of->d, at->residual, of->v, K, W);
    add_product(at->stiffness, map, rows);
    if (evaluation->dynamic) add_product(at->inertia, W, rows);
    add_transposed_product(map, rows, K);
    add_block(evaluation, &motion, DMB_BY_DISPLACEMENT, K);
    if (!evaluation->dynamic) return;
    memset(rows, 0, sizeof rows);
    memset(K, 0, sizeof K);
    add_product(at->inertia, map, rows);
    add_transposed_product(map, rows, K);
    add_block(evaluation, &motion, DMB_BY_VELOCITY, K);
}

/* ---- Forces ------------------------------------------------------------------------------------------------------ */

static int touches(const dmb_sim *sim, uint32_t s, const section_node *at)
{
    return sim->trial.site_penetration[s] > 0.0 || at->site.clearance <= 0.0 || sim->site_mode[s] != 0;
}

/* Contact force of one point, added to the sums given. */
static void press(const dmb_evaluation *evaluation, uint32_t s, section_node *at, const dmb_wall_args *sums,
                  dmb_wall_args *args)
{
    static const uint32_t first = 0;
    const dmb_scene *scene = evaluation->sim->scene;
    *args = *sums;
    args->count = 1;
    args->sites = &at->site;
    args->row = args->diagonal = &first;
    args->reference += 3 * (size_t)dmb_inside_point(scene, s)->node;
    args->displacement = at->displacement;
    args->quaternion = at->quaternion;
    args->velocity = at->velocity;
    args->now_quaternion = at->now_quaternion;
    args->now_velocity = at->now_velocity;
    args->velocity_factor = 1.0;
    args->residual = at->residual;
    args->scale = at->scale;
    args->stiffness = at->stiffness;
    args->inertia = at->inertia;
    dmb_wall_args_skip(args, s);
    dmb_kernels_of(1)->walls(args);
}

/* 1: the contact point reaches the wall within the step at the speed of the accepted motion. */
static int meets(const dmb_sim *sim, uint32_t s)
{
    return sim->trial.site_penetration[s] > 0.0 && !(sim->now.site_penetration[s] > 0.0);
}

static void read_before(const dmb_sim *sim, uint32_t s, const section *motion, section_node *at)
{
    host then;
    section before;
    host_of(sim->scene, &sim->now, dmb_inside_point(sim->scene, s), &then);
    section_of(&then, dmb_inside_point(sim->scene, s), &before);
    read_node(sim, s, motion, at);
    read_motion(&before, at->now_quaternion, at->now_velocity);
}

static void gather(dmb_evaluation *evaluation, const host *of, uint32_t s, dmb_wall_args *sums)
{
    dmb_sim *sim = evaluation->sim;
    dmb_wall_args args;
    section in;
    section_node at;
    section_of(of, dmb_inside_point(sim->scene, s), &in);
    read_node(sim, s, &in, &at);
    press(evaluation, s, &at, sums, &args);
    if (meets(sim, s)) {
        read_before(sim, s, &in, &at);
        press(evaluation, s, &at, sums, &args);
    }
    sums->rounding = args.rounding;
    sums->potential = args.potential;
    sums->impact = args.impact;
    sums->friction = args.friction;
    if (!touches(sim, s, &at)) return;
    double w[6], f[12];
    for (int i = 0; i < 6; i++) w[i] = -at.residual[i];
    dmb_section_wrench(of->type, &in.shape, &in.frame, w, f);
    dmb_apply_wrench(sim, of->node, f);
    dmb_apply_wrench(sim, of->node + 1, f + 6);
    if (evaluation->tangent) add_tangent(evaluation, of, &in, &at);
}

/* [m] Largest distance of a section from the line through the ends. */
static double sag_of(const dmb_sim *sim, const dmb_element_type *type, uint32_t element)
{
    const double *d = sim->element_strain + 6 * (size_t)element;
    double sag = 0.0;
    for (int i = 1; i < 3; i++)
        sag += fabs(d[i]) + fabs(type->rest[i]) + type->length * (fabs(d[3 + i]) + fabs(type->rest[3 + i]));
    return sag;
}

/* [m] Largest displacement of a section in the step: with the nodes, by their rotation across the axis, and about the
 * line through them by their rotation about it. */
static double reach_of(const dmb_sim *sim, const dmb_scene_point *point)
{
    const double *a = sim->increment + sim->scene->layout.row[point->node];
    const double *b = sim->increment + sim->scene->layout.row[point->node + 1];
    const dmb_element_type *type = sim->scene->types + sim->scene->element_type[point->element];
    const double length = type->length + fabs(type->arm[0]) + fabs(type->arm[1]);
    const double across = fabs(a[4]) + fabs(a[5]) + fabs(b[4]) + fabs(b[5]), about = fabs(a[3]) + fabs(b[3]);
    return dmb_vec3_norm(a) + dmb_vec3_norm(b) + length * across + sag_of(sim, type, point->element) * about;
}

/* 1: the contact point cannot touch within the step. Its distance from the axis of the hole changes by no more than its
 * displacement; not used in holes whose wall has sections. */
static int stays_open(const dmb_evaluation *evaluation, const dmb_scene_point *point, uint32_t s)
{
    const dmb_sim *sim = evaluation->sim;
    const dmb_block_layout *layout = &sim->scene->layout;
    if (!evaluation->dynamic || !(evaluation->step > 0.0) || sim->scene->hole.pieces > 0) return 0;
    if (layout->size[point->node] != DMB_NODE_SIX_DOF || layout->size[point->node + 1] != DMB_NODE_SIX_DOF) return 0;
    return sim->now.site_penetration[s] + 2.0 * reach_of(sim, point) < 0.0;
}

void dmb_assemble_contacts_inside(dmb_evaluation *evaluation, int waiting, dmb_wall_args *args)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    host of = {.type = NULL};
    for (uint32_t s = dmb_node_sites(scene); s < scene->site_count; s++) {
        const dmb_scene_point *point = dmb_inside_point(scene, s);
        const int waits = stays_open(evaluation, point, s);
        if (waits && !waiting) {
            sim->trial.site_penetration[s] = sim->now.site_penetration[s];
            dmb_vec3_copy(sim->now.site_normal + 3 * (size_t)s, sim->trial.site_normal + 3 * (size_t)s);
        }
        if (waits != waiting) continue;
        if (of.type == NULL || of.element != point->element) host_of(scene, &sim->trial, point, &of);
        gather(evaluation, &of, s, args);
    }
}

void dmb_site_axes(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t s, double R[9])
{
    if (!dmb_is_inside(scene, s)) {
        dmb_quat_to_matrix(configuration->quaternion + 4 * (size_t)scene->sites[s].node, R);
        return;
    }
    dmb_point_motion motion;
    dmb_point_motion_of(scene, configuration, dmb_inside_point(scene, s), &motion);
    memcpy(R, motion.R, sizeof motion.R);
}

void dmb_site_add_wrench(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t s, double factor,
                         const double w[6], double *rows)
{
    const dmb_site *site = scene->sites + s;
    double f[6];
    if (!dmb_is_inside(scene, s)) {
        dmb_vec6_copy(w, f);
        dmb_arm_wrench(site->offset, f);
        for (uint32_t i = 0; i < 6; i++) rows[scene->layout.row[site->node] + i] += factor * f[i];
        return;
    }
    dmb_point_motion motion;
    dmb_point_motion_of(scene, configuration, dmb_inside_point(scene, s), &motion);
    for (uint32_t k = 0; k < 12; k++) {
        double sum = 0.0;
        for (uint32_t i = 0; i < 6; i++) sum += motion.map[12 * i + k] * w[i];
        rows[scene->layout.row[motion.node[k / 6]] + k % 6] += factor * sum;
    }
}
