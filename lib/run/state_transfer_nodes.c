/* Transfer of nodes. The world pose of a matched node is kept; displacements u are stored relative to the described
 * position x0, which differs between the scenes, x = x0 + u. Taken from positions, the shift x0 - x0' of each node
 * would have the rounding of its distance from the origin, which over an element is a strain. Described distances
 * between neighbours (`element_span`) are exact, so the shift is carried from the far end from node to node by their
 * differences:
 *
 *     (u' - u)_a = (u' - u)_b + (span' - span) + (offset_a - offset_b),  from x_b - x_a = span + u_b - u_a
 *
 * Added nodes are appended at the rig end as one rigid body with the first matched node, without strain. */
#include <math.h>
#include <string.h>

#include "element/beam.h"
#include "math/mat6.h"
#include "math/se3.h"
#include "run/run.h"
#include "sim/node.h"

/* [m, rad] permitted difference of the described lines of axial-torsional pipes */
#define DMB_SAME_LINE 1e-6

static int is_axial_torsional(const dmb_scene *scene, uint32_t node)
{
    return scene->layout.size[node] == DMB_NODE_AXIAL_TORSIONAL;
}

/* [m] Distance along body x from the node to the end of the parts fixed to it, towards the far end. */
static double arm_ahead(const dmb_scene *scene, uint32_t node, uint32_t string)
{
    const uint32_t element = scene->node_element[node];
    if (element == DMB_NONE) return scene->strings[string].end_arm;
    return scene->types[scene->element_type[element]].arm[0];
}

double dmb_state_transfer_arm(const dmb_scene *scene, uint32_t node, const dmb_scene *from, uint32_t old,
                              uint32_t string)
{
    return arm_ahead(from, old, string) - arm_ahead(scene, node, string);
}

/* Rotation about the node's own axis relative to its described pose, on the revolution nearest to `near`. */
static double turn_of(const dmb_scene *scene, uint32_t node, const double q[4], double near)
{
    double between[4];
    dmb_quat_between(scene->reference_quaternion + 4 * (size_t)node, q, between);
    return dmb_quat_twist(between, near);
}

/* ---- Matched nodes ----------------------------------------------------------------------------------------------- */

/* Iteration from the far end to the rig end of a string. */
typedef struct iterator {
    double shift[3];             /* [m] new less old displacement of the last node, world */
    double offset[3];            /* [m] new less old place of the last node, world: along its arm */
    double along;                /* [m] the same shift along the axis of axial-torsional nodes */
    int32_t was_axial_torsional; /* 1: the last node was an axial-torsional node */
    int32_t started;
} iterator;

/* shift_a - shift_b = span - span_old + offset_a - offset_b, from x_b - x_a = span + u_b - u_a in both scenes */
static void shift_to(const dmb_scene *scene, uint32_t node, const dmb_scene *from, uint32_t old, const double offset[3],
                     iterator *w)
{
    const double *to = scene->reference_position + 3 * (size_t)node, *was = from->reference_position + 3 * (size_t)old;
    const double *span = NULL, *span_old = NULL;
    if (w->started) {
        span = scene->element_span + 3 * (size_t)scene->node_element[node];
        span_old = from->element_span + 3 * (size_t)from->node_element[old];
    }
    for (int i = 0; i < 3; i++) {
        if (w->started)
            w->shift[i] += (span[i] - span_old[i]) + (offset[i] - w->offset[i]);
        else
            w->shift[i] = (was[i] - to[i]) + offset[i];
        w->offset[i] = offset[i];
    }
    w->started = 1;
}

static void transfer_six_dof(dmb_sim *sim, uint32_t node, const dmb_sim *from, uint32_t old, double arm,
                             const double shift[3])
{
    const double *q = from->now.quaternion + 4 * (size_t)old;
    double *v = sim->now.velocity + sim->scene->layout.row[node];
    const int same = memcmp(sim->scene->reference_quaternion + 4 * (size_t)node,
                            from->scene->reference_quaternion + 4 * (size_t)old, 4 * sizeof(double)) == 0;
    dmb_vec3_add(from->now.displacement + 3 * (size_t)old, shift, sim->now.displacement + 3 * (size_t)node);
    dmb_quat_copy(q, sim->now.quaternion + 4 * (size_t)node);
    sim->now.turn[node] = same ? from->now.turn[old] : turn_of(sim->scene, node, q, from->now.turn[old]);
    dmb_vec6_copy(from->now.velocity + from->scene->layout.row[old], v);
    dmb_arm_velocity(arm, v);
}

/* [m] Change of the advance of an axial-torsional node that preserves its position; without a hole, along its line. */
static double axial_torsional_shift(const dmb_scene *scene, uint32_t node, const dmb_scene *from, uint32_t old)
{
    const double ex[3] = {1.0, 0.0, 0.0};
    double line[3], between[3];
    if (scene->has_hole) return from->reference_depth[old] - scene->reference_depth[node];
    dmb_quat_rotate(scene->reference_quaternion + 4 * (size_t)node, ex, line);
    dmb_vec3_sub(from->reference_position + 3 * (size_t)old, scene->reference_position + 3 * (size_t)node, between);
    return dmb_vec3_dot(line, between);
}

/* Frame of the old node, carried along the axis to the described depth of the new one. */
static void carried_frame(const dmb_scene *scene, uint32_t node, const dmb_scene *from, uint32_t old, double q[4])
{
    double turn[9], turned[4];
    dmb_quat_copy(from->reference_quaternion + 4 * (size_t)old, q);
    if (!scene->has_hole || dmb_hole_is_straight(&scene->hole)) return;
    dmb_hole_carry(&scene->hole, from->reference_depth[old], scene->reference_depth[node], turn);
    dmb_quat_from_matrix(turn, turned);
    dmb_quat_mul(turned, q, q);
}

static void transfer_axial_torsional(dmb_sim *sim, uint32_t node, const dmb_sim *from, uint32_t old, double along)
{
    const dmb_scene *scene = sim->scene;
    double q[4];
    double *u = sim->now.displacement + 3 * (size_t)node;
    const double turn = from->now.turn[old];
    dmb_vec3_set(from->now.displacement[3 * (size_t)old] + along, 0.0, 0.0, u);
    dmb_quat_copy(scene->reference_quaternion + 4 * (size_t)node, sim->now.quaternion + 4 * (size_t)node);
    carried_frame(scene, node, from->scene, old, q);
    sim->now.turn[node] = turn + turn_of(scene, node, q, 0.0);
    memcpy(sim->now.velocity + scene->layout.row[node], from->now.velocity + from->scene->layout.row[old],
           DMB_NODE_AXIAL_TORSIONAL * sizeof(double));
}

/* Continues from the actual position of the node; an error if its line differs from the old one. */
static int32_t follow_path(dmb_sim *sim, uint32_t node, const dmb_sim *from, uint32_t old, const double R_old[9],
                           const double u_old[3], uint32_t string, iterator *w)
{
    const double *to = sim->scene->reference_position + 3 * (size_t)node;
    const double *was = from->scene->reference_position + 3 * (size_t)old;
    double R[9], u[3], off = 0.0;
    dmb_node_pose(sim->scene, &sim->now, node, R, u);
    for (int i = 0; i < 3; i++) {
        w->shift[i] = u[i] - u_old[i];
        w->offset[i] = 0.0;
        off = fmax(off, fabs((to[i] - was[i]) + w->shift[i]));
        for (int k = 0; k < 3; k++) off = fmax(off, fabs(R[3 * i + k] - R_old[3 * i + k]));
    }
    if (off <= DMB_SAME_LINE) return DMB_OK;
    dmb_message name;
    dmb_message_set(&sim->message,
                    "state transfer: %s: its axial-torsional pipes are described off the line they "
                    "are on, by %g m or rad",
                    dmb_string_text(sim->scene, string, &name), off);
    return DMB_ERR_VALUE;
}

static int32_t transfer_node(dmb_sim *sim, uint32_t node, const dmb_sim *from, uint32_t old, uint32_t string,
                             iterator *w)
{
    const double arm = dmb_state_transfer_arm(sim->scene, node, from->scene, old, string);
    double R[9], u[3], offset[3];
    dmb_node_pose(from->scene, &from->now, old, R, u);
    dmb_vec3_set(arm * R[0], arm * R[3], arm * R[6], offset);
    if (!is_axial_torsional(sim->scene, node)) {
        shift_to(sim->scene, node, from->scene, old, offset, w);
        transfer_six_dof(sim, node, from, old, arm, w->shift);
        w->was_axial_torsional = 0;
        return DMB_OK;
    }
    if (!w->was_axial_torsional) w->along = axial_torsional_shift(sim->scene, node, from->scene, old);
    transfer_axial_torsional(sim, node, from, old, w->along);
    w->was_axial_torsional = w->started = 1;
    return follow_path(sim, node, from, old, R, u, string, w);
}

/* ---- Added nodes ------------------------------------------------------------------------------------------------- */

/* Node b seen from node a of an unstressed element: arm, exp d0, arm. */
static void rest_pose(const dmb_element_type *type, double q[4], double x[3])
{
    const double ahead[3] = {type->arm[1], 0.0, 0.0};
    double moved[3];
    dmb_se3_exp_to_quat(type->rest, q, x);
    dmb_quat_rotate(q, ahead, moved);
    dmb_vec3_add(x, moved, x);
    x[0] += type->arm[0];
}

/* Node a before node b as one rigid body with it: x_a = x_b - R_a x, V_a = Ad V_b. */
static void add_six_dof(dmb_sim *sim, uint32_t a, const dmb_element_type *type, const double span[3])
{
    const double *qb = sim->now.quaternion + 4 * ((size_t)a + 1), *ub = sim->now.displacement + 3 * ((size_t)a + 1);
    double *qa = sim->now.quaternion + 4 * (size_t)a, *ua = sim->now.displacement + 3 * (size_t)a;
    double q[4], x[3], back[4], R[9], far[3];
    rest_pose(type, q, x);
    dmb_quat_conj(q, back);
    dmb_quat_mul(qb, back, qa);
    dmb_quat_normalize(qa);
    dmb_quat_rotate(qa, x, far);
    for (int i = 0; i < 3; i++) ua[i] = ub[i] + (span[i] - far[i]);
    sim->now.turn[a] = turn_of(sim->scene, a, qa, sim->now.turn[a + 1]);
    dmb_quat_to_matrix(q, R);
    dmb_adjoint_apply(R, x, sim->now.velocity + sim->scene->layout.row[a + 1],
                      sim->now.velocity + sim->scene->layout.row[a]);
}

static void add_path(dmb_sim *sim, uint32_t a, const dmb_element_type *type)
{
    const double *ub = sim->now.displacement + 3 * ((size_t)a + 1);
    dmb_vec3_set(ub[0] + (type->length - type->rest[0]), 0.0, 0.0, sim->now.displacement + 3 * (size_t)a);
    dmb_quat_copy(sim->scene->reference_quaternion + 4 * (size_t)a, sim->now.quaternion + 4 * (size_t)a);
    sim->now.turn[a] = sim->now.turn[a + 1] - type->rest[3];
    memcpy(sim->now.velocity + sim->scene->layout.row[a], sim->now.velocity + sim->scene->layout.row[a + 1],
           DMB_NODE_AXIAL_TORSIONAL * sizeof(double));
}

static void add_node(dmb_sim *sim, uint32_t a)
{
    const dmb_scene *scene = sim->scene;
    const uint32_t element = scene->node_element[a];
    const dmb_element_type *type = scene->types + scene->element_type[element];
    if (is_axial_torsional(scene, a))
        add_path(sim, a, type);
    else
        add_six_dof(sim, a, type, scene->element_span + 3 * (size_t)element);
}

/* ---- All --------------------------------------------------------------------------------------------------------- */

/* Matched nodes from the far end on, then added ones towards the rig. */
static int32_t transfer_string(dmb_sim *sim, const dmb_sim *from, uint32_t string)
{
    const dmb_common_string common = dmb_common_string_of(sim->scene, from->scene, string);
    iterator w = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 0.0, 0, 0};
    int32_t status = DMB_OK;
    for (uint32_t i = common.nodes; i-- > 0 && status >= 0;)
        status = transfer_node(sim, common.to + i, from, common.from + i, string, &w);
    for (uint32_t a = common.to; a-- > sim->scene->strings[string].first_node && status >= 0;) add_node(sim, a);
    return status;
}

static void transfer_body(dmb_sim *sim, uint32_t node, const dmb_sim *from, uint32_t old)
{
    double shift[3];
    dmb_vec3_sub(from->scene->reference_position + 3 * (size_t)old, sim->scene->reference_position + 3 * (size_t)node,
                 shift);
    transfer_six_dof(sim, node, from, old, 0.0, shift);
}

int32_t dmb_state_transfer_nodes(dmb_sim *sim, const dmb_sim *from)
{
    const dmb_body_def *def = sim->model->bodies.items;
    int32_t status = DMB_OK;
    for (uint32_t s = 0; s < sim->scene->string_count && status >= 0; s++) status = transfer_string(sim, from, s);
    for (uint32_t b = 0; b < sim->model->bodies.count; b++)
        if (def[b].attach == DMB_ATTACH_NONE)
            transfer_body(sim, sim->scene->bodies[b].node, from, from->scene->bodies[b].node);
    return status;
}
