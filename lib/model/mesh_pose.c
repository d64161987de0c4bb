/* Poses at time 0: along the hole's axis, along a line, or along the unstressed shape. */
#include "math/mat6.h"
#include "math/se3.h"
#include "model/mesh.h"
#include "model/section.h"

typedef struct pose {
    double q[4], x[3];
} pose;

static void move_along(pose *p, double distance)
{
    const double along[3] = {distance, 0.0, 0.0};
    double step[3];
    dmb_quat_rotate(p->q, along, step);
    dmb_vec3_add(p->x, step, p->x);
}

static void set_node(dmb_mesh_node *node, const pose *p)
{
    dmb_quat_copy(p->q, node->quaternion);
    dmb_vec3_copy(p->x, node->position);
}

static pose pose_of(const double position[3], const double rotation[3])
{
    pose p;
    dmb_quat_exp(rotation, p.q);
    dmb_quat_normalize(p.q);
    dmb_vec3_copy(position, p.x);
    return p;
}

/* ---- Strings on the hole's axis ---------------------------------------------------------------------------------- */

static void hole_frame(const dmb_mesh *mesh, double depth, double q[4])
{
    double R[9];
    dmb_hole_frame_rotation(&mesh->hole, depth, R);
    dmb_quat_from_matrix(R, q);
    dmb_quat_normalize(q);
}

/* Rotates q by the smallest rotation that aligns its x axis with t. The frames of neighbouring nodes then differ
 * without twist about the axis, so a string placed in a spatially curved hole starts free of torsion. */
static void turn_to(const double t[3], double q[4])
{
    const double ex[3] = {1.0, 0.0, 0.0};
    double x[3], turn[4];
    dmb_quat_rotate(q, ex, x);
    dmb_vec3_cross(x, t, turn + 1);
    if (dmb_vec3_norm(turn + 1) < 1e-14) return; /* straight: keep the very same frame */
    turn[0] = 1.0 + dmb_vec3_dot(x, t);          /* half-angle form: (1 + cos, sin axis) */
    dmb_quat_mul(turn, q, q);
    dmb_quat_normalize(q);
}

/* Transports a frame along the axis, as for axial-torsional nodes in every step. */
static void carry(const dmb_mesh *mesh, double from, double to, double q[4])
{
    double turn[9], turned[4];
    dmb_hole_carry(&mesh->hole, from, to, turn);
    dmb_quat_from_matrix(turn, turned);
    dmb_quat_mul(turned, q, q);
    dmb_quat_normalize(q);
}

/* Poses in a hole. The rig end has the frame of the hole; further frames are transported without twist, between
 * axial-torsional nodes along the axis itself, so that these rotate about it by torsion only, wherever they move. */
static void place_in_hole(dmb_mesh *mesh, const dmb_string_def *def, dmb_mesh_node *node, const dmb_mesh_node *before)
{
    double tangent[3], shift[3] = {0.0, def->offset[0], def->offset[1]}, frame[4];
    node->depth = def->start_depth + node->at;
    dmb_hole_frame(&mesh->hole, node->depth, node->position, tangent, NULL);
    hole_frame(mesh, node->depth, frame);
    dmb_quat_rotate(frame, shift, shift);
    dmb_vec3_add(node->position, shift, node->position);
    dmb_quat_copy(frame, node->quaternion);
    if (before == NULL) return;
    dmb_quat_copy(before->quaternion, node->quaternion);
    if (node->size == DMB_NODE_AXIAL_TORSIONAL && before->size == DMB_NODE_AXIAL_TORSIONAL &&
        !dmb_hole_is_straight(&mesh->hole))
        carry(mesh, before->depth, node->depth, node->quaternion);
    else
        turn_to(tangent, node->quaternion);
}

/* [m] from node to node along an unbent element. */
static double straight_length(const dmb_mesh_element *element)
{
    return element->arm[0] + element->length + element->arm[1];
}

/* Vector between two nodes. In a straight hole it is direction times length, because a difference of large coordinates
 * loses digits. */
static void span_between(const dmb_mesh *mesh, dmb_mesh_element *element)
{
    const dmb_mesh_node *a = dmb_mesh_node_at(mesh, element->node), *b = a + 1;
    const double along[3] = {straight_length(element), 0.0, 0.0};
    double straight[3], difference[3];
    dmb_quat_rotate(a->quaternion, along, straight);
    dmb_vec3_sub(b->position, a->position, element->span);
    dmb_vec3_sub(element->span, straight, difference);
    if (!dmb_same_numbers(a->quaternion, b->quaternion, 4)) return;
    if (dmb_vec3_norm(difference) > 1e-9 * (along[0] + dmb_vec3_norm(a->position))) return;
    dmb_vec3_copy(straight, element->span);
}

static void string_in_hole(dmb_mesh *mesh, uint32_t string)
{
    const dmb_string_def *def = dmb_mesh_string_def(mesh, string);
    const dmb_string_map *map = dmb_mesh_string_at(mesh, string);
    dmb_mesh_node *node = dmb_mesh_node_at(mesh, map->first_node);
    for (uint32_t i = 0; i < map->node_count; ++i) place_in_hole(mesh, def, node + i, i > 0 ? node + i - 1 : NULL);
}

/* ---- Strings on their own ---------------------------------------------------------------------------------------- */

/* d0 of an element: stretch 1 along x and the unstressed twist and curvature, times the length. */
static void rest_of(const dmb_pipe_def *def, double length, double d[6])
{
    dmb_vec3_set(length, 0.0, 0.0, d);
    dmb_vec3_scale(length, def->curvature, d + 3);
}

/* H_b = H_a arm_0 exp(d0) arm_1; the span is the change of x. */
static void advance(const dmb_mesh *mesh, dmb_mesh_element *element, pose *p)
{
    double d[6], q[4], x[3], arm[3] = {element->arm[1], 0.0, 0.0};
    rest_of(&dmb_mesh_run_at(mesh, element->run)->def, element->length, d);
    dmb_se3_exp_to_quat(d, q, x);
    dmb_quat_rotate(q, arm, arm);
    dmb_vec3_add(x, arm, x);
    x[0] += element->arm[0];
    dmb_quat_rotate(p->q, x, element->span);
    dmb_vec3_add(p->x, element->span, p->x);
    dmb_quat_mul(p->q, q, p->q);
    dmb_quat_normalize(p->q);
}

static bool is_straight(const dmb_mesh *mesh, uint32_t string)
{
    const uint32_t *start = mesh->run_start.items, *order = mesh->run_order.items;
    for (uint32_t i = start[string]; i < start[string + 1]; ++i) {
        if (dmb_vec3_norm(dmb_mesh_run_at(mesh, order[i])->def.curvature) > 0.0) return false;
    }
    return true;
}

/* Nodes by successive relative poses of the unstressed shape from the rig end; of a straight string each from the rig
 * end itself. */
static void string_on_its_own(dmb_mesh *mesh, uint32_t string, uint32_t *element)
{
    const dmb_string_def *def = dmb_mesh_string_def(mesh, string);
    const dmb_string_map *map = dmb_mesh_string_at(mesh, string);
    const pose rig = pose_of(def->position, def->rotation);
    const bool straight = is_straight(mesh, string);
    pose p = rig;
    move_along(&p, -map->start_arm);
    for (uint32_t i = 0; i < map->node_count; ++i) {
        dmb_mesh_node *node = dmb_mesh_node_at(mesh, map->first_node + i);
        if (i > 0) advance(mesh, dmb_mesh_element_at(mesh, (*element)++), &p);
        if (straight) { /* from the rig end each time, so that no error accumulates */
            p = rig;
            move_along(&p, node->at);
        }
        set_node(node, &p);
    }
}

/* ---- Bend -------------------------------------------------------------------------------------------------------- */

/* [rad] between the axes of an element's ends as described. */
static double bend_of(const dmb_mesh *mesh, const dmb_mesh_element *element)
{
    const dmb_mesh_node *a = dmb_mesh_node_at(mesh, element->node);
    double q[4];
    dmb_quat_between(a->quaternion, a[1].quaternion, q);
    return 2.0 * sqrt(q[2] * q[2] + q[3] * q[3]);
}

/* Curved mass and stiffness (element/curved_mass.h) for an element that is bent unstressed, bent as described by more
 * than DMB_CURVED_BEND, or thick against its length. */
bool dmb_mesh_is_curved(const dmb_mesh *mesh, const dmb_mesh_element *element)
{
    const dmb_pipe_def *def = &dmb_mesh_run_at(mesh, element->run)->def;
    dmb_pipe_section section;
    dmb_section_of(def, &section);
    const double radius = sqrt(section.inertia[1] / section.mass);
    return fabs(def->curvature[1]) > 0.0 || fabs(def->curvature[2]) > 0.0 || bend_of(mesh, element) > DMB_CURVED_BEND ||
           radius > DMB_CURVED_THICK * element->length;
}

/* ---- All --------------------------------------------------------------------------------------------------------- */

static void place_free_body(dmb_mesh *mesh, dmb_mesh_node *node)
{
    const dmb_body_def *def = DMB_LIST_AT(const dmb_body_def, mesh->model->bodies, node->body);
    const pose p = pose_of(def->position, def->rotation);
    set_node(node, &p);
}

int32_t dmb_mesh_poses(dmb_mesh *mesh)
{
    uint32_t element = 0;
    for (uint32_t s = 0; s < mesh->strings.count; ++s) {
        if (!dmb_mesh_follows_hole(mesh, s)) {
            string_on_its_own(mesh, s, &element);
            continue;
        }
        string_in_hole(mesh, s);
        for (uint32_t i = 1; i < dmb_mesh_string_at(mesh, s)->node_count; ++i, ++element) {
            span_between(mesh, dmb_mesh_element_at(mesh, element));
        }
    }
    for (uint32_t i = 0; i < mesh->nodes.count; ++i) {
        dmb_mesh_node *node = dmb_mesh_node_at(mesh, i);
        if (node->string == DMB_NONE) place_free_body(mesh, node);
    }
    return DMB_OK;
}
