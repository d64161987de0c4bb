/* Rotors: bodies that may spin fast on joints, and their axis of spin (system/constrain/rotor.h). They are bodies of
 * revolution whose joints are also invariant under rotation about that axis: in axes that do not spin with the body,
 * their equations then have no terms that vary with the spin. An asymmetric body would have terms at twice its spin,
 * which steps of half a radian do not resolve and which make its nutation grow (a top with moments across its axis
 * that differ by a tenth, at one radian a step): such a body is integrated in its own axes.
 *
 * The axis is that of a bearing of the body; without bearings the line from a pivot to the centre of mass, or else an
 * axis of inertia through the centre of mass. A body clamped in rotation to a part without such an axis has none. */
#include "model/field_check.h"
#include "model/mesh.h"

#include <math.h>

/* [-] relative difference of the moments across the axis, or angle to an axis of inertia; permits values in single
 * precision */
#define DMB_ROUND 1e-6
/* [-] offset of the centre of mass from the axis over the radius of inertia across it: an unbalance */
#define DMB_BALANCED 1e-2
/* [-] largest difference of equal directions, and of equal places over their size */
#define DMB_ALIGNED 1e-6

enum { OF_NOTHING, OF_BEARING, OF_PIVOT };

static dmb_mesh_rotor *rotor_at(const dmb_mesh *mesh, size_t i)
{
    return DMB_VECTOR_AT(dmb_mesh_rotor, &mesh->rotors, i);
}

/* ---- Inertia ----------------------------------------------------------------------------------------------------- */

static const dmb_rigid_mass *mass_of(const dmb_mesh *mesh, uint32_t node)
{
    return DMB_VECTOR_AT(dmb_rigid_mass, &mesh->rigid_masses, dmb_mesh_node_at(mesh, node)->rigid_mass);
}

/* Centre of mass from the node, and J there. */
static void central_inertia(const dmb_mesh *mesh, const dmb_mesh_rotor *rotor, double c[3], double J[9])
{
    const dmb_rigid_mass *body = mass_of(mesh, rotor->rotor.node);
    const double *I = body->inertia, m = body->mass;
    dmb_vec3_scale(1.0 / m, body->moment, c);
    const double full[9] = {I[0], I[3], I[4], I[3], I[1], I[5], I[4], I[5], I[2]}, cc = dmb_vec3_dot(c, c);
    for (int i = 0; i < 9; ++i) J[i] = full[i] + m * c[i / 3] * c[i % 3] - (i % 4 == 0 ? m * cc : 0.0);
}

/* A unit vector across e. */
static void across(const double e[3], double t[3])
{
    const int k = fabs(e[0]) < 0.6 ? 0 : 1;
    double unit[3] = {0.0, 0.0, 0.0};
    unit[k] = 1.0;
    dmb_vec3_axpy(-e[k], e, unit);
    dmb_vec3_scale(1.0 / dmb_vec3_norm(unit), unit, t);
}

/* True if the mass is axisymmetric about the axis e through the point x: equal moments across it, m d^2 small, d the
 * distance of the centre from the axis. */
static bool is_round(const dmb_mesh *mesh, const dmb_mesh_rotor *rotor, const double e[3], const double x[3])
{
    double c[3], J[9], s[3], t[3], Js[3], Jt[3], d[3];
    central_inertia(mesh, rotor, c, J);
    across(e, s);
    dmb_vec3_cross(e, s, t);
    dmb_mat3_vec(J, s, Js);
    dmb_mat3_vec(J, t, Jt);
    const double ss = dmb_vec3_dot(s, Js), tt = dmb_vec3_dot(t, Jt), st = dmb_vec3_dot(s, Jt);
    const double es = dmb_vec3_dot(e, Js), et = dmb_vec3_dot(e, Jt), half = 0.5 * (ss - tt), mean = 0.5 * (ss + tt);
    dmb_vec3_sub(c, x, c);
    dmb_vec3_cross(e, c, d);
    return sqrt(half * half + st * st + es * es + et * et) <= DMB_ROUND * mean &&
           mass_of(mesh, rotor->rotor.node)->mass * dmb_vec3_norm_squared(d) <= DMB_BALANCED * DMB_BALANCED * mean;
}

/* J <- G^T J G, and the columns of axes rotated too, with the rotation G in the plane p, q that makes J_pq 0 (Jacobi
 * 1846). */
static void rotate_plane(double J[9], double axes[9], int p, int q)
{
    const double pq = J[3 * p + q];
    if (!(fabs(pq) > 0.0)) return;
    const double theta = (J[4 * q] - J[4 * p]) / (2.0 * pq);
    const double tangent = (theta < 0.0 ? -1.0 : 1.0) / (fabs(theta) + sqrt(1.0 + theta * theta));
    const double c = 1.0 / sqrt(1.0 + tangent * tangent), s = tangent * c;
    double G[9], half[9];
    dmb_mat3_identity(G);
    G[4 * p] = G[4 * q] = c;
    G[3 * p + q] = s;
    G[3 * q + p] = -s;
    dmb_mat3_mul_tn(G, J, half);
    dmb_mat3_mul(half, G, J);
    J[3 * p + q] = J[3 * q + p] = 0.0;
    dmb_mat3_mul(axes, G, half);
    dmb_mat3_copy(half, axes);
}

/* The axes of inertia, as columns. */
static void axes_of_inertia(const double J[9], double axes[9])
{
    double A[9];
    dmb_mat3_copy(J, A);
    dmb_mat3_identity(axes);
    for (int sweep = 0; sweep < 6; ++sweep)
        for (int p = 0; p < 2; ++p)
            for (int q = p + 1; q < 3; ++q) rotate_plane(A, axes, p, q);
}

/* ---- Joints ------------------------------------------------------------------------------------------------------ */

/* True if the part may spin about the x axis of the joint on this part. */
static bool is_bearing(int32_t kind, bool of_b)
{
    return kind == DMB_JOINT_REVOLUTE || kind == DMB_JOINT_CYLINDRICAL || kind == DMB_JOINT_UNIVERSAL ||
           kind == DMB_JOINT_PLANAR || kind == DMB_JOINT_SCHOENFLIES || (kind == DMB_JOINT_ROLLING && of_b);
}

/* True if the joint permits no relative rotation. */
static bool is_clamp(int32_t kind)
{
    return kind == DMB_JOINT_FIXED || kind == DMB_JOINT_PRISMATIC || kind == DMB_JOINT_TRANSLATIONAL ||
           kind == DMB_JOINT_CROSS_SLIDE;
}

static bool is_pivot(int32_t kind)
{
    return kind == DMB_JOINT_SPHERICAL || kind == DMB_JOINT_POINT_ON_LINE || kind == DMB_JOINT_POINT_ON_HOLE ||
           kind == DMB_JOINT_DISTANCE;
}

static void x_axis(const dmb_scene_frame *frame, double e[3])
{
    for (int i = 0; i < 3; ++i) e[i] = frame->M[3 * i];
}

/* Sets the axis e through x if the mass is axisymmetric about it. */
static bool set_axis(const dmb_mesh *mesh, dmb_mesh_rotor *rotor, const double e[3], const double x[3], int32_t from)
{
    if (!is_round(mesh, rotor, e, x)) return false;
    dmb_vec3_cross(x, e, rotor->rotor.twist);
    dmb_vec3_copy(e, rotor->rotor.twist + 3);
    rotor->from = from;
    return true;
}

/* The line from a pivot at x to the centre of mass. */
static void offer_pivot(const dmb_mesh *mesh, dmb_mesh_rotor *rotor, const double x[3])
{
    double c[3], J[9], e[3];
    central_inertia(mesh, rotor, c, J);
    dmb_vec3_sub(c, x, e);
    const double arm = dmb_vec3_norm(e);
    if (!(arm > 0.0)) return;
    dmb_vec3_scale(1.0 / arm, e, e);
    (void)set_axis(mesh, rotor, e, x, OF_PIVOT);
}

/* Candidate axis from one frame of a joint on this body: the first valid bearing, otherwise the first pivot. */
static void offer(const dmb_mesh *mesh, dmb_mesh_rotor *rotor, const dmb_scene_frame *frame, int32_t kind, bool of_b)
{
    double e[3];
    if (is_bearing(kind, of_b)) {
        rotor->bearings = 1;
        x_axis(frame, e);
        if (rotor->from != OF_BEARING) (void)set_axis(mesh, rotor, e, frame->x, OF_BEARING);
    }
    if (is_pivot(kind) && rotor->from == OF_NOTHING) offer_pivot(mesh, rotor, frame->x);
}

/* An axis of inertia of a body without bearings. */
static void offer_inertia(const dmb_mesh *mesh, dmb_mesh_rotor *rotor)
{
    double c[3], J[9], axes[9];
    if (rotor->from != OF_NOTHING || rotor->bearings) return;
    central_inertia(mesh, rotor, c, J);
    axes_of_inertia(J, axes);
    for (int k = 0; k < 3; ++k) {
        const double e[3] = {axes[k], axes[3 + k], axes[6 + k]};
        if (set_axis(mesh, rotor, e, c, OF_PIVOT)) return;
    }
}

/* Unit spin in the frame of a joint: velocity of its origin, direction. */
static void spin_at(const dmb_mesh_rotor *rotor, const dmb_scene_frame *frame, double out[6])
{
    dmb_adjoint_inverse_apply(frame->M, frame->x, rotor->rotor.twist, out);
}

/* True if the equations of a joint are invariant when its frame rotates about the axis. Equations on the direction of
 * the x axis require it along the spin axis; equations on the origin require it on that axis. */
static bool stays(const dmb_mesh_rotor *rotor, const dmb_scene_frame *frame, int32_t kind, bool of_b)
{
    double spin[6];
    spin_at(rotor, frame, spin);
    const double size = dmb_vec3_norm(frame->x) + dmb_vec3_norm(rotor->rotor.twist); /* [m] */
    const bool on_axis = dmb_vec3_norm(spin) <= DMB_ALIGNED * size;
    const bool along = fabs(spin[4]) <= DMB_ALIGNED && fabs(spin[5]) <= DMB_ALIGNED;
    switch (kind) {
    case DMB_JOINT_FREE: return true;
    case DMB_JOINT_PLANAR:
    case DMB_JOINT_SCHOENFLIES: return along;
    case DMB_JOINT_ROLLING: return along && (on_axis || !of_b);
    case DMB_JOINT_SPHERICAL:
    case DMB_JOINT_DISTANCE:
    case DMB_JOINT_POINT_ON_HOLE: return on_axis;
    case DMB_JOINT_POINT_ON_LINE: return on_axis && (along || of_b);
    case DMB_JOINT_REVOLUTE:
    case DMB_JOINT_CYLINDRICAL:
    case DMB_JOINT_UNIVERSAL: return on_axis && along;
    case DMB_JOINT_KNIFE_EDGE: return false;
    default: return true; /* clamps are checked at both ends */
    }
}

static void compare(dmb_mesh_rotor *rotor, const dmb_scene_frame *frame, int32_t kind, bool of_b)
{
    if (rotor->from != OF_NOTHING && !stays(rotor, frame, kind, of_b)) rotor->from = OF_NOTHING;
}

/* ---- Bodies ------------------------------------------------------------------------------------------------------ */

/* True for a chain of one node in a scene with joints that is free, or free to rotate about its reference point. */
static bool may_spin(const dmb_mesh *mesh, uint32_t i)
{
    const dmb_mesh_node *node = dmb_mesh_node_at(mesh, i);
    const bool alone = node->string == DMB_NONE || dmb_mesh_string_at(mesh, node->string)->node_count == 1;
    const bool is_free = node->free == DMB_SET_ALL && mesh->clusters.count > 0;
    return alone && node->size == DMB_NODE_SIX_DOF && node->rigid_mass != DMB_NONE && node->prescribed == 0 &&
           (is_free || node->free == DMB_SET_SPHERICAL) && mass_of(mesh, i)->mass > 0.0;
}

static int32_t add_bodies(dmb_mesh *mesh)
{
    static const double origin[3];
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < mesh->nodes.count && status >= 0; ++i) {
        dmb_mesh_rotor rotor = {.rotor = {.node = i}, .from = OF_NOTHING};
        if (!may_spin(mesh, i)) continue;
        if (dmb_mesh_node_at(mesh, i)->free == DMB_SET_SPHERICAL) offer_pivot(mesh, &rotor, origin);
        status = dmb_vector_append(&mesh->rotors, &mesh->model->allocator, &rotor, 1);
    }
    return status;
}

/* The body of a node, or NULL; they stand in the order of their nodes. */
static dmb_mesh_rotor *body_of(const dmb_mesh *mesh, uint32_t node)
{
    size_t first = 0, end = mesh->rotors.count;
    while (first < end) {
        const size_t middle = first + (end - first) / 2;
        if (rotor_at(mesh, middle)->rotor.node < node)
            first = middle + 1;
        else
            end = middle;
    }
    if (node == DMB_NONE || first == mesh->rotors.count || rotor_at(mesh, first)->rotor.node != node) return NULL;
    return rotor_at(mesh, first);
}

static const dmb_scene_joint *joint_at(const dmb_mesh *mesh, size_t j)
{
    return DMB_VECTOR_AT(dmb_scene_joint, &mesh->joints, j);
}

typedef enum pass { OFFER, COMPARE } pass;

static void read_joints(const dmb_mesh *mesh, pass what)
{
    for (size_t j = 0; j < mesh->joints.count; ++j) {
        const dmb_scene_joint *joint = joint_at(mesh, j);
        for (int end = 0; end < 2; ++end) {
            const dmb_scene_frame *frame = end == 0 ? &joint->a : &joint->b;
            dmb_mesh_rotor *rotor = body_of(mesh, frame->node);
            if (rotor == NULL) continue;
            if (what == OFFER)
                offer(mesh, rotor, frame, joint->kind, end == 1);
            else
                compare(rotor, frame, joint->kind, end == 1);
        }
    }
}

static void read_callbacks(const dmb_mesh *mesh)
{
    for (size_t i = 0; i < mesh->callbacks.count; ++i) {
        const dmb_scene_callback *callback = DMB_VECTOR_AT(dmb_scene_callback, &mesh->callbacks, i);
        for (uint32_t k = 0; k < callback->count; ++k) {
            dmb_mesh_rotor *rotor = body_of(mesh, callback->place[k].node);
            if (rotor != NULL) rotor->from = OF_NOTHING;
        }
    }
}

/* True if both ends of a clamp spin about the same line, or about parallel lines if the clamp slides transversely. */
static bool spin_alike(const dmb_mesh_rotor *a, const dmb_mesh_rotor *b, const dmb_scene_joint *joint)
{
    double of_a[6], of_b[6];
    spin_at(a, &joint->a, of_a);
    spin_at(b, &joint->b, of_b);
    const double sign = dmb_vec3_dot(of_a + 3, of_b + 3) < 0.0 ? -1.0 : 1.0;
    const double size =
        dmb_vec3_norm(of_a) + dmb_vec3_norm(of_b) + dmb_vec3_norm(joint->a.x) + dmb_vec3_norm(joint->b.x);
    const bool slides = joint->kind == DMB_JOINT_TRANSLATIONAL || joint->kind == DMB_JOINT_CROSS_SLIDE;
    for (int i = slides ? 3 : 0; i < 6; ++i)
        if (fabs(of_a[i] - sign * of_b[i]) > DMB_ALIGNED * (i < 3 ? size : 1.0)) return false;
    return true;
}

/* 1 if a clamp removes the axis of one of its ends. A node without a body that may spin belongs to a string, or has
 * supports. */
static int clamp(const dmb_mesh *mesh, const dmb_scene_joint *joint)
{
    dmb_mesh_rotor *a = body_of(mesh, joint->a.node), *b = body_of(mesh, joint->b.node);
    const bool a_spins = a != NULL && a->from != OF_NOTHING, b_spins = b != NULL && b->from != OF_NOTHING;
    if (!is_clamp(joint->kind) || (!a_spins && !b_spins)) return 0;
    if (a_spins && b_spins && spin_alike(a, b, joint)) return 0;
    if (a != NULL) a->from = OF_NOTHING;
    if (b != NULL) b->from = OF_NOTHING;
    return 1;
}

/* Along chains of clamps. */
static void read_clamps(const dmb_mesh *mesh)
{
    for (int more = 1; more;) {
        more = 0;
        for (size_t j = 0; j < mesh->joints.count; ++j) more |= clamp(mesh, joint_at(mesh, j));
    }
}

/* The axis of a body whose reference point is constrained must pass through that point. */
static void compare_support(const dmb_mesh *mesh, dmb_mesh_rotor *rotor)
{
    const dmb_scene_frame point = {.M = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}};
    if (dmb_mesh_node_at(mesh, rotor->rotor.node)->free == DMB_SET_ALL) return;
    compare(rotor, &point, DMB_JOINT_SPHERICAL, true);
    dmb_vec3_zero(rotor->rotor.twist);
}

int32_t dmb_mesh_rotors(dmb_mesh *mesh)
{
    size_t kept = 0;
    const int32_t status = add_bodies(mesh);
    if (status < 0) return status;
    read_joints(mesh, OFFER);
    for (size_t i = 0; i < mesh->rotors.count; ++i) offer_inertia(mesh, rotor_at(mesh, i));
    for (size_t i = 0; i < mesh->rotors.count; ++i) compare_support(mesh, rotor_at(mesh, i));
    read_joints(mesh, COMPARE);
    read_callbacks(mesh);
    read_clamps(mesh);
    for (size_t i = 0; i < mesh->rotors.count; ++i)
        if (rotor_at(mesh, i)->from != OF_NOTHING) *rotor_at(mesh, kept++) = *rotor_at(mesh, i);
    mesh->rotors.count = kept;
    return DMB_OK;
}
