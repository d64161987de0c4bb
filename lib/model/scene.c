/* Computed from a finished scene: forces of flowing mud, warnings of contact points that never touch, the dense scene
 * for analyses, masses beside places for bounds of frequencies. */
#include "model/scene.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/memory.h"
#include "math/vec3.h"
#include "model/field_check.h"

/* ---- Mud that flows ---------------------------------------------------------------------------------------------- */

static void add_pull(dmb_scene *scene, uint32_t node, double pull, double lever)
{
    scene->flow_node[2 * (size_t)node] += pull;
    scene->flow_node[2 * (size_t)node + 1] += pull * lever;
}

/* Forces of mud on elements as a uniform load on the cubic shape: halves with the moments +- w L^2/12, w L/2 times L/6.
 */
void dmb_scene_fill_pulls(dmb_scene *scene)
{
    memset(scene->flow_element, 0, scene->element_count * sizeof(double));
    memset(scene->flow_node, 0, 2 * (size_t)scene->node_count * sizeof(double));
    for (uint32_t i = 0; i < scene->flow_count; ++i) {
        const dmb_flow_piece *piece = scene->flow_pieces + i;
        const double pull = piece->annulus.pull * piece->length;
        if (piece->element == DMB_NONE) {
            add_pull(scene, piece->node, pull, piece->lever[0]);
            continue;
        }
        scene->flow_element[piece->element] = pull;
        add_pull(scene, scene->element_node[piece->element], 0.5 * pull, piece->lever[0]);
        add_pull(scene, scene->element_node[piece->element] + 1, 0.5 * pull, piece->lever[1]);
    }
}

/* Losses of all pieces at another rate. The shape of the annulus does not depend on the rate, and stays. */
void dmb_scene_set_flow(dmb_scene *scene, double rate)
{
    double before[2] = {0.0, 0.0};
    scene->flow.rate = rate;
    for (uint32_t i = 0; i < scene->flow_count; ++i) {
        dmb_flow_piece *piece = scene->flow_pieces + i;
        piece->bore = dmb_bore_loss(&scene->flow, piece->diameter[1]);
        piece->annulus = dmb_annulus_loss_by(&scene->flow, piece->diameter[0], piece->hole, &piece->shape);
        piece->before[0] = before[0];
        piece->before[1] = before[1];
        before[0] += piece->length * piece->bore.gradient;
        before[1] += piece->length * piece->annulus.gradient;
    }
    dmb_scene_fill_pulls(scene);
}

/* ---- Rings that a support keeps off the wall -----------------------------------------------------------------------
 */

static const double same_point = 1e-9; /* [m] */

/* A point that stays on the axis of the hole is as far from the wall as the clearance. */
static bool is_on_axis(const dmb_scene *scene, const dmb_body_map *body, const dmb_scene_joint *joint)
{
    const double *x = joint->b.x;
    if (joint->kind != DMB_JOINT_POINT_ON_HOLE || joint->state == DMB_JOINT_OPEN) return false;
    if (body->site == DMB_NONE || joint->b.node != body->node) return false;
    return fabs(x[0] - scene->sites[body->site].offset) <= same_point && fabs(x[1]) <= same_point &&
           fabs(x[2]) <= same_point;
}

/* Name of the support or joint that constrains the contact point: "its support", a joint by name, or NULL. */
static const char *holder(const dmb_scene *scene, const dmb_body_map *body, dmb_message *text)
{
    if (body->supported_site) return "the support (free_mask; start_free or end_free of its string)";
    for (uint32_t j = 0; j < scene->joint_count; ++j) {
        const dmb_scene_joint *joint = &scene->joints[j];
        if (is_on_axis(scene, body, joint)) return dmb_part_text(text, "joint", j, joint->name, sizeof joint->name);
    }
    return NULL;
}

uint32_t dmb_supported_site(const dmb_scene *scene, uint32_t from, dmb_message *text)
{
    const uint32_t rings = scene->body_count - scene->ring_count, bodies = rings - scene->bit_count;
    dmb_message part;
    for (uint32_t i = from; i < scene->body_count; ++i) {
        dmb_message name;
        const char *by = holder(scene, &scene->bodies[i], &name);
        if (by == NULL) continue;
        const uint32_t first = i < bodies ? 0 : i < rings ? bodies : rings;
        dmb_part_text(&part,
                      i < bodies  ? "body"
                      : i < rings ? "bit"
                                  : "stabiliser",
                      i - first, scene->bodies[i].name, sizeof scene->bodies[i].name);
        if (i >= rings) {
            dmb_message_set(text, "%s: it never touches the wall, %s holds it sideways: free it there, or move it",
                            part.text, by);
            return i;
        }
        dmb_message_set(
            text, "%s: its contact ring never touches the wall, %s holds it sideways: free it there, or give no %s",
            part.text, by, i < bodies ? "contact_diameter" : "diameter");
        return i;
    }
    return DMB_NONE;
}

/* ---- The scene for analyses with dense clusters ------------------------------------------------------------------ */

/* Places of each cluster's matrices in shared arrays: rows by columns, rows by rows, columns by columns. (rows +
 * columns)^2 is more than any of them, so that one sum in doubles bounds all three before sizes are added. */
int32_t dmb_scene_place_storage(uint32_t count, dmb_cluster *clusters, dmb_scene *scene)
{
    size_t dense = 0, square = 0, full = 0;
    double most = 0.0; /* above each of them */
    for (uint32_t c = 0; c < count; ++c) {
        dmb_cluster *cluster = clusters + c;
        cluster->dense = dense;
        cluster->square = square;
        cluster->full = full;
        if (cluster->sparse) continue;
        most += ((double)cluster->rows + cluster->columns) * ((double)cluster->rows + cluster->columns);
        if (most > (double)(SIZE_MAX / 2)) return 0;
        dense += (size_t)cluster->rows * cluster->columns;
        square += (size_t)cluster->rows * cluster->rows;
        full += (size_t)cluster->columns * cluster->columns;
    }
    scene->dense_count = dense;
    scene->square_count = square;
    scene->six_dof_count = full;
    return 1;
}

static int fits(const dmb_scene *scene)
{
    for (uint32_t c = 0; c < scene->cluster_count; ++c) {
        const dmb_cluster *cluster = scene->clusters + c;
        if (cluster->columns > DMB_CLUSTER_COLUMNS_MAX || cluster->rows > DMB_CLUSTER_ROWS_MAX) return 0;
    }
    return 1;
}

/* The struct and the arrays that differ from the scene; all others are the scene's. */
static dmb_scene *lay_out(dmb_arena *arena, const dmb_scene *scene)
{
    dmb_scene nowhere;
    dmb_scene *made = DMB_ARENA_ARRAY(arena, dmb_scene, 1), *to = made != NULL ? made : &nowhere;
    *to = *scene;
    to->clusters = DMB_ARENA_ARRAY(arena, dmb_cluster, scene->cluster_count);
    to->node_block = DMB_ARENA_ARRAY(arena, uint32_t, scene->node_count);
    to->off_diagonal_offset = DMB_ARENA_ARRAY(arena, size_t, 2 * (size_t)scene->node_count);
    return made;
}

/* Steps and statics solve large clusters by sparse matrices, linear analyses need G of eq:joints.partition itself. They
 * work on a second scene that differs in its clusters, blocks and pattern alone and shares everything else, where these
 * are small enough (fits); otherwise there is none, and the analyses say so. */
int32_t dmb_scene_make_dense(dmb_scene *scene, const dmb_allocator *allocator)
{
    dmb_arena arena;
    if (scene->sparse_count == 0 || !fits(scene)) return DMB_OK;
    dmb_arena_count(&arena);
    (void)lay_out(&arena, scene);
    const size_t bytes = dmb_arena_block_size(&arena);
    void *block = dmb_allocate(allocator, bytes);
    if (block == NULL) return DMB_ERR_NO_MEMORY;
    dmb_arena_place(&arena, block, bytes);
    dmb_scene *dense = lay_out(&arena, scene);
    memcpy(dense->clusters, scene->clusters, scene->cluster_count * sizeof *dense->clusters);
    for (uint32_t c = 0; c < dense->cluster_count; ++c) dense->clusters[c].sparse = 0;
    memset(&dense->pattern, 0, sizeof dense->pattern);
    dense->bytes = bytes;
    const int32_t status = dmb_scene_place_storage(dense->cluster_count, dense->clusters, dense)
                               ? dmb_scene_number_blocks(dense, allocator)
                               : DMB_ERR_TOO_LARGE;
    if (status < 0)
        dmb_release(allocator, block, bytes);
    else
        scene->dense = dense;
    return status;
}

void dmb_scene_release_dense(const dmb_scene *dense, const dmb_allocator *allocator)
{
    if (dense == NULL) return;
    dmb_scene whole = *dense;
    dmb_block_pattern_release(&whole.pattern, allocator);
    dmb_release(allocator, (void *)(uintptr_t)dense, whole.bytes);
}

/* ---- Mobility of contact sites ----------------------------------------------------------------------------------- */

/* [kg] Half of the elements on both sides: the adjacent mass, by which mobilities bound frequencies without the mass
 * matrix (eq:contact.coarse, eq:unilateral.holding). */
static double mass_beside(const dmb_scene *scene, uint32_t node)
{
    double mass = 0.0;
    for (uint32_t k = node == 0 ? 1 : 0; k < 2; ++k) {
        const uint32_t e = scene->node_element[node - (k == 0)];
        if (e == DMB_NONE) continue;
        const dmb_element_type *type = scene->types + scene->element_type[e];
        mass += 0.5 * type->mass_per_metre * type->length;
    }
    return mass;
}

/* Rigid mass on a node; they are ordered by node; NULL: none. */
static const dmb_rigid_mass *rigid_mass_on(const dmb_scene *scene, uint32_t node)
{
    uint32_t low = 0, high = scene->rigid_mass_count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (scene->rigid_masses[middle].node < node)
            low = middle + 1;
        else
            high = middle;
    }
    return low < scene->rigid_mass_count && scene->rigid_masses[low].node == node ? scene->rigid_masses + low : NULL;
}

/* [kg m2] Torsional inertia of the elements beside a node. */
static double torsion_beside(const dmb_scene *scene, uint32_t node)
{
    double inertia = 0.0;
    for (uint32_t k = node == 0 ? 1 : 0; k < 2; ++k) {
        const uint32_t e = scene->node_element[node - (k == 0)];
        if (e != DMB_NONE) inertia += scene->types[scene->element_type[e]].mass.torsion[0];
    }
    return inertia;
}

/* Inverse of the inertia about the centre of mass c, J - m (c.c I - c c^T). 0 if it has none. */
static int invert_inertia(const dmb_rigid_mass *rigid, const double c[3], double inverse[9])
{
    const double *J = rigid->inertia, m = rigid->mass, square = dmb_vec3_norm_squared(c);
    const double xx = J[0] - m * (square - c[0] * c[0]), xy = J[3] + m * c[0] * c[1];
    const double yy = J[1] - m * (square - c[1] * c[1]), xz = J[4] + m * c[0] * c[2];
    const double zz = J[2] - m * (square - c[2] * c[2]), yz = J[5] + m * c[1] * c[2];
    const double cofactor[9] = {yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy,
                                xz * yz - xy * zz, xx * zz - xz * xz, xy * xz - xx * yz,
                                xy * yz - xz * yy, xy * xz - xx * yz, xx * yy - xy * xy};
    const double determinant = xx * cofactor[0] + xy * cofactor[1] + xz * cofactor[2];
    for (int i = 0; i < 9; i++) inverse[i] = cofactor[i] / determinant;
    return determinant > 0.0;
}

/* 1/m + the largest eigenvalue of r~^T J^-1 r~, r = x - c, which has rank 2: with the eigenvalues a >= b its trace is a
 * + b and the square of its norm a^2 + b^2, hence a = (trace + sqrt(2 norm^2 - trace^2))/2. The norm of J^-1 for a
 * couple. Infinite for inertias that vanish to rounding, 1/m for none. */
static double rigid_mobility(const dmb_rigid_mass *rigid, const double *x)
{
    const double *J = rigid->inertia;
    const double of_mass = x != NULL && rigid->mass > 0.0 ? 1.0 / rigid->mass : 0.0;
    double c[3], r[3], skew[9], inverse[9], half[9], whole[9], norm = 0.0;
    if (!(J[0] + J[1] + J[2] > 0.0)) return of_mass;
    for (int i = 0; i < 3; i++) c[i] = rigid->mass > 0.0 ? rigid->moment[i] / rigid->mass : 0.0;
    if (!invert_inertia(rigid, c, inverse)) return (double)INFINITY;
    for (int i = 0; i < 9; i++) norm += inverse[i] * inverse[i];
    if (x == NULL) return sqrt(norm);
    dmb_vec3_sub(x, c, r);
    dmb_skew(r, skew);
    dmb_mat3_mul(inverse, skew, half);
    dmb_mat3_mul_tn(skew, half, whole);
    const double trace = whole[0] + whole[4] + whole[8];
    norm = 0.0;
    for (int i = 0; i < 9; i++) norm += whole[i] * whole[i];
    return of_mass + 0.5 * (trace + sqrt(fmax(2.0 * norm - trace * trace, 0.0)));
}

double dmb_node_mobility(const dmb_scene *scene, uint32_t node, const double *x)
{
    const dmb_rigid_mass *rigid = rigid_mass_on(scene, node);
    const double torsion = torsion_beside(scene, node);
    if (!(torsion > 0.0) && rigid != NULL) return rigid_mobility(rigid, x);
    const double mass = mass_beside(scene, node) + (rigid != NULL ? rigid->mass : 0.0);
    const double of_turn = torsion > 0.0 ? 1.0 / torsion : 0.0;
    if (x == NULL) return of_turn;
    return (mass > 0.0 ? 1.0 / mass : 0.0) + dmb_vec3_norm_squared(x) * of_turn;
}

/* 1/m, m being half of the elements beside the node and what is rigid on it; inside an element half of that. For bodies
 * plus a^2/J for their rotation, at the distance a from the node. */
double dmb_site_mobility(const dmb_scene *scene, uint32_t s)
{
    const dmb_site *site = scene->sites + s;
    const dmb_rigid_mass *rigid = rigid_mass_on(scene, site->node);
    const double beside = mass_beside(scene, site->node);
    if (dmb_is_inside(scene, s)) return 1.0 / beside;
    const double mass = beside + (rigid != NULL ? rigid->mass : 0.0);
    double mobility = mass > 0.0 ? 1.0 / mass : 0.0;
    if (beside > 0.0 || rigid == NULL) return mobility;
    const double inertia = fmin(rigid->inertia[1], rigid->inertia[2]);
    return inertia > 0.0 ? mobility + site->offset * site->offset / inertia : mobility;
}
