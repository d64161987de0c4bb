/* Pose, unwrapped rotation and motion: of sections inside elements, of places, of points offset from them. */
#include "query/query.h"

#include <math.h>

#include "element/beam.h"
#include "math/mat6.h"
#include "math/se3.h"
#include "math/vec3.h"
#include "sim/access.h"
#include "sim/node.h"

/* ---- Between nodes ----------------------------------------------------------------------------------------------- */

/* Pose of a section inside an element, relative to the element's end A:
 *
 *     H(x) = exp(x d) exp(c(x) d),   x = 0 at A .. 1 at B,   d = log(H_A^-1 H_B)
 *
 * exp(x d) is the element's own helix, exact for any uniform strain (Sonneville, Cardona, Bruls 2014). It distributes
 * the lateral part of d uniformly; c redistributes it as the S-shape of the Timoshenko cubic shapes N3, G3
 * (eq:beam.section-pose), which is consistent with the shear force of the corrected stiffness 1/GA* = 1/GA + L^2/(12
 * EI). To first order in the bending of the element both together are the shapes N1 .. N4, G1 .. G4 about the frame in
 * the middle, so that a beam loaded at its nodes is exact between them. c is 0 at both ends, so that nodes are
 * reproduced. */

void dmb_end_pose_at_start(const dmb_scene *scene, uint32_t node, dmb_end_pose *pose)
{
    dmb_quat_to_matrix(scene->reference_quaternion + 4 * (size_t)node, pose->rotation);
    dmb_vec3_zero(pose->displacement);
}

void dmb_relative_pose(const dmb_scene *scene, uint32_t element, const dmb_end_pose *a, const dmb_end_pose *b,
                       double d[6])
{
    double x[3];
    dmb_vec3_sub(b->displacement, a->displacement, x);
    dmb_vec3_add(x, scene->element_span + 3 * (size_t)element, x);
    dmb_section_ends(&scene->types[scene->element_type[element]], a->rotation, b->rotation, x, d);
}

/* Axial-torsional elements on the hole's axis have no bending of their own and therefore no bending shape. */
void dmb_material_point_shape(const dmb_scene *scene, const dmb_material_point *material_point,
                              dmb_section_shape *shape)
{
    const uint32_t a = scene->element_node[material_point->element];
    const int path =
        scene->layout.size[a] == DMB_NODE_AXIAL_TORSIONAL && scene->layout.size[a + 1] == DMB_NODE_AXIAL_TORSIONAL;
    dmb_section_shape_at(&scene->types[scene->element_type[material_point->element]], material_point->fraction, !path,
                         shape);
}

/* Section relative to node a: rotation Q and position r [m]. */
static void section_from_node(const dmb_scene *scene, const dmb_material_point *material_point, const dmb_end_pose *a,
                              const dmb_end_pose *b, double Q[9], double r[3])
{
    dmb_section_shape shape;
    double d[6];
    dmb_relative_pose(scene, material_point->element, a, b, d);
    dmb_material_point_shape(scene, material_point, &shape);
    dmb_section_pose(&scene->types[scene->element_type[material_point->element]], &shape, d, Q, r);
}

/* Computes the position from a node and the vector r relative to it; `before` is that vector in world axes at the
 * start. The displacement is computed without subtraction of world positions. */
static void place_from_node(const dmb_scene *scene, uint32_t node, const dmb_end_pose *now, const double r[3],
                            const double before[3], dmb_material_point_pose *pose)
{
    double moved[3];
    dmb_mat3_vec(now->rotation, r, moved);
    dmb_vec3_add(scene->reference_position + 3 * (size_t)node, now->displacement, pose->position);
    dmb_vec3_add(pose->position, moved, pose->position);
    dmb_vec3_sub(moved, before, pose->displacement);
    dmb_vec3_add(pose->displacement, now->displacement, pose->displacement);
}

static void fixed_pose(const dmb_scene *scene, const dmb_configuration *configuration,
                       const dmb_material_point *material_point, dmb_material_point_pose *pose)
{
    const double arm[3] = {material_point->arm, 0.0, 0.0};
    double before[3];
    dmb_end_pose now, start;
    dmb_end_pose_now(scene, configuration, material_point->node, &now);
    dmb_end_pose_at_start(scene, material_point->node, &start);
    dmb_mat3_copy(now.rotation, pose->rotation);
    dmb_mat3_vec(start.rotation, arm, before);
    place_from_node(scene, material_point->node, &now, arm, before, pose);
}

static void section_pose(const dmb_scene *scene, const dmb_configuration *configuration,
                         const dmb_material_point *material_point, dmb_material_point_pose *pose)
{
    const uint32_t a = scene->element_node[material_point->element], b = a + 1;
    dmb_end_pose now_a, now_b, start_a, start_b;
    double Q[9], Q_start[9], r[3], r_start[3], before[3];
    dmb_end_pose_now(scene, configuration, a, &now_a);
    dmb_end_pose_now(scene, configuration, b, &now_b);
    dmb_end_pose_at_start(scene, a, &start_a);
    dmb_end_pose_at_start(scene, b, &start_b);
    section_from_node(scene, material_point, &now_a, &now_b, Q, r);
    section_from_node(scene, material_point, &start_a, &start_b, Q_start, r_start);
    dmb_mat3_mul(now_a.rotation, Q, pose->rotation);
    dmb_mat3_vec(start_a.rotation, r_start, before);
    place_from_node(scene, a, &now_a, r, before, pose);
}

void dmb_material_point_pose_of(const dmb_scene *scene, const dmb_configuration *configuration,
                                const dmb_material_point *material_point, dmb_material_point_pose *pose)
{
    if (material_point->fixed)
        fixed_pose(scene, configuration, material_point, pose);
    else if (dmb_is_on_curved_axis(scene, material_point))
        dmb_axis_pose_of(scene, configuration, material_point, pose);
    else
        section_pose(scene, configuration, material_point, pose);
}

void dmb_material_point_start_axes(const dmb_scene *scene, const dmb_material_point *material_point, double R[9])
{
    dmb_end_pose a, b;
    double Q[9], r[3];
    dmb_end_pose_at_start(scene, material_point->node, &a);
    if (material_point->fixed) {
        dmb_mat3_copy(a.rotation, R);
        return;
    }
    if (dmb_is_on_curved_axis(scene, material_point)) {
        dmb_axis_start_rotation(scene, material_point, a.rotation, R);
        return;
    }
    dmb_end_pose_at_start(scene, material_point->node + 1, &b);
    section_from_node(scene, material_point, &a, &b, Q, r);
    dmb_mat3_mul(a.rotation, Q, R);
}

static void node_motion(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t node, double arm,
                        dmb_material_point_motion *motion)
{
    dmb_node_vector(scene, configuration, node, configuration->velocity, motion->velocity);
    dmb_node_vector(scene, configuration, node, configuration->acceleration, motion->acceleration);
    dmb_arm_velocity(arm, motion->velocity);
    dmb_arm_velocity(arm, motion->acceleration);
}

/* W = T6(h) h', W' = T6(h) (h'' - X(h, W) h') with X = d/dh (T6^-1(h) W): velocity of exp h and its rate */
static void motion_of_exp(const double h[6], const double rate[6], const double second[6],
                          dmb_material_point_motion *out)
{
    dmb_se3_tangent T;
    double X[36], y[6];
    dmb_se3_tangent_at(h, NULL, &T);
    dmb_se3_tangent_apply(&T, rate, out->velocity);
    dmb_se3_velocity_derivative(h, out->velocity, NULL, X);
    dmb_mat6_vec(X, rate, y);
    for (int i = 0; i < 6; i++) y[i] = second[i] - y[i];
    dmb_se3_tangent_apply(&T, y, out->acceleration);
}

/* Motion of the frame exp h relative to a moving frame: V <- Ad^-1 V + W, V' <- Ad^-1 V' - W^ (Ad^-1 V) + W' */
static void follow(const double h[6], const double rate[6], const double second[6], dmb_material_point_motion *motion)
{
    dmb_material_point_motion own;
    double R[9], x[3], turned[6];
    motion_of_exp(h, rate, second, &own);
    dmb_se3_exp(h, NULL, R, x);
    dmb_adjoint_inverse_apply(R, x, motion->velocity, motion->velocity);
    dmb_adjoint_inverse_apply(R, x, motion->acceleration, motion->acceleration);
    dmb_ad_apply(own.velocity, motion->velocity, turned);
    for (int i = 0; i < 6; i++) {
        motion->acceleration[i] += own.acceleration[i] - turned[i];
        motion->velocity[i] += own.velocity[i];
    }
}

/* d' = T6^-1(d) V_B - T6^-1(-d) V_A (eq:beam.strain-rate) and its derivative: T6^-1(d) V_B' - T6^-1(-d) V_A' and, from
 * the operators, X(d, V_B) d' + X(-d, V_A) d', whose second sign is that of the second term times that of -d. */
static void strain_rates(const double d[6], const dmb_material_point_motion *a, const dmb_material_point_motion *b,
                         double rate[6], double second[6])
{
    dmb_se3_inverse_tangent T;
    double back[6], X[36], Xa[36], left[6], turned[6];
    dmb_se3_inverse_tangent_at(d, NULL, &T);
    dmb_se3_tangent_apply(&T, b->velocity, rate);
    dmb_se3_tangent_apply_reverse(&T, a->velocity, left);
    for (int i = 0; i < 6; i++) {
        rate[i] -= left[i];
        back[i] = -d[i];
    }
    dmb_se3_velocity_derivative(d, b->velocity, NULL, X);
    dmb_se3_velocity_derivative(back, a->velocity, NULL, Xa);
    dmb_mat6_add(X, Xa, X);
    dmb_mat6_vec(X, rate, turned);
    dmb_se3_tangent_apply(&T, b->acceleration, second);
    dmb_se3_tangent_apply_reverse(&T, a->acceleration, left);
    for (int i = 0; i < 6; i++) second[i] += turned[i] - left[i];
}

/* V at A, then along exp(x d) and exp(c(x) d) in turn (eq:beam.section-pose): both exponents are linear in d, so their
 * rates are those of d with the same shapes. */
static void section_motion(const dmb_scene *scene, const dmb_configuration *configuration,
                           const dmb_material_point *material_point, dmb_material_point_motion *motion)
{
    const dmb_element_type *type = &scene->types[scene->element_type[material_point->element]];
    const uint32_t a = scene->element_node[material_point->element], b = a + 1;
    dmb_material_point_motion far_end;
    dmb_section_shape shape;
    dmb_end_pose pose_a, pose_b;
    double d[6], rate[6], second[6], h[3][6], c[3][6];
    dmb_end_pose_now(scene, configuration, a, &pose_a);
    dmb_end_pose_now(scene, configuration, b, &pose_b);
    dmb_relative_pose(scene, material_point->element, &pose_a, &pose_b, d);
    node_motion(scene, configuration, a, type->arm[0], motion);
    node_motion(scene, configuration, b, -type->arm[1], &far_end);
    strain_rates(d, motion, &far_end, rate, second);
    dmb_material_point_shape(scene, material_point, &shape);
    for (int i = 0; i < 6; i++) {
        h[0][i] = shape.x * d[i];
        h[1][i] = shape.x * rate[i];
        h[2][i] = shape.x * second[i];
    }
    dmb_section_shape_correct(&shape, d, c[0]);
    dmb_section_shape_correct(&shape, rate, c[1]);
    dmb_section_shape_correct(&shape, second, c[2]);
    follow(h[0], h[1], h[2], motion);
    follow(c[0], c[1], c[2], motion);
}

/* Accelerations of a quasi-static state: the acceleration of the point in the world is 0, so that its body-frame rate
 * is -w x v. */
static void rest(dmb_material_point_motion *motion)
{
    dmb_vec3_cross(motion->velocity, motion->velocity + 3, motion->acceleration);
    dmb_vec3_zero(motion->acceleration + 3);
}

void dmb_material_point_motion_of(const dmb_scene *scene, const dmb_configuration *configuration,
                                  const dmb_material_point *material_point, dmb_material_point_motion *motion)
{
    if (material_point->fixed)
        node_motion(scene, configuration, material_point->node, material_point->arm, motion);
    else if (dmb_is_on_curved_axis(scene, material_point))
        dmb_axis_motion_of(scene, configuration, material_point, motion);
    else
        section_motion(scene, configuration, material_point, motion);
    if (dmb_is_quasi_static(configuration)) rest(motion);
}

double dmb_material_point_turn(const dmb_configuration *configuration, const dmb_material_point *material_point)
{
    const double *turn = configuration->turn + material_point->node;
    if (material_point->fixed) return turn[0];
    return turn[0] + material_point->fraction * (turn[1] - turn[0]);
}

/* [m] distance from the near node to a section, along the undeformed element. */
static double along(const dmb_scene *scene, const dmb_material_point *material_point)
{
    if (material_point->fixed) return material_point->arm;
    const dmb_element_type *type = &scene->types[scene->element_type[material_point->element]];
    return type->arm[0] + material_point->fraction * type->length;
}

/* The depth of an axial-torsional node is known exactly; otherwise the axis is searched near the approximate depth of
 * the section.
 */
double dmb_material_point_depth(const dmb_scene *scene, const dmb_configuration *configuration,
                                const dmb_material_point *material_point, const double x[3])
{
    double depth, point[3], tangent[3];
    if (!scene->has_hole) return 0.0;
    if (material_point->fixed && material_point->arm == 0.0 &&
        scene->layout.size[material_point->node] == DMB_NODE_AXIAL_TORSIONAL)
        return dmb_axial_torsional_depth(scene, configuration, material_point->node);
    uint32_t segment = dmb_node_segment(scene, configuration, material_point->node, along(scene, material_point), x);
    dmb_hole_project(&scene->hole, x, &depth, &segment, point, tangent);
    return depth;
}

/* ---- At a place -------------------------------------------------------------------------------------------------- */

DMB_DECLARE_STRUCT(dmb_pose)

int32_t dmb_answer_pose(const dmb_sim *sim, dmb_place place, dmb_pose *pose)
{
    int32_t status = dmb_ask(sim, pose);
    dmb_material_point point;
    dmb_material_point_pose found;
    dmb_pose answer = {0};
    if (status == DMB_OK) status = dmb_material_point_of(sim, place, &point);
    if (status < 0) return status;
    dmb_material_point_pose_of(sim->scene, &sim->now, &point, &found);
    dmb_vec3_copy(found.position, answer.position);
    dmb_mat3_copy(found.rotation, answer.rotation);
    dmb_vec3_copy(found.displacement, answer.displacement);
    answer.depth = dmb_material_point_depth(sim->scene, &sim->now, &point, found.position);
    return dmb_pose_write(pose, &answer);
}

int32_t dmb_answer_rotation(const dmb_sim *sim, dmb_place place, double *angle)
{
    int32_t status = dmb_ask(sim, angle);
    dmb_material_point point;
    if (status == DMB_OK) status = dmb_material_point_of(sim, place, &point);
    if (status < 0) return status;
    *angle = dmb_material_point_turn(&sim->now, &point);
    return DMB_OK;
}

DMB_DECLARE_STRUCT(dmb_motion)

/* World axes: R u, R w; the acceleration of a point is R (a_u + w x u), its rotation's R a_w. */
static void to_world(const dmb_material_point_motion *body, const double R[9], dmb_motion *out)
{
    const double *v = body->velocity, *a = body->acceleration;
    double total[3];
    dmb_vec3_cross(v + 3, v, total);
    dmb_vec3_add(total, a, total);
    dmb_mat3_vec(R, v, out->velocity);
    dmb_mat3_vec(R, v + 3, out->velocity + 3);
    dmb_mat3_vec(R, total, out->acceleration);
    dmb_mat3_vec(R, a + 3, out->acceleration + 3);
}

int32_t dmb_answer_motion(const dmb_sim *sim, dmb_place place, dmb_motion *motion)
{
    int32_t status = dmb_ask(sim, motion);
    dmb_material_point point;
    dmb_material_point_pose pose;
    dmb_material_point_motion body;
    dmb_motion answer;
    if (status == DMB_OK) status = dmb_motion_read(&answer, motion);
    if (status < 0) return status;
    if (answer.frame != DMB_FRAME_WORLD && answer.frame != DMB_FRAME_BODY) return DMB_ERR_VALUE;
    status = dmb_material_point_of(sim, place, &point);
    if (status < 0) return status;
    dmb_material_point_motion_of(sim->scene, &sim->now, &point, &body);
    if (answer.frame == DMB_FRAME_WORLD) {
        dmb_material_point_pose_of(sim->scene, &sim->now, &point, &pose);
        to_world(&body, pose.rotation, &answer);
    } else {
        dmb_vec6_copy(body.velocity, answer.velocity);
        dmb_vec6_copy(body.acceleration, answer.acceleration);
    }
    return dmb_motion_write(motion, &answer);
}

/* ---- Poses and motions of points offset from a place ------------------------------------------------------------- */

static int32_t check_finite(const double *values, int count)
{
    for (int k = 0; k < count; k++)
        if (!isfinite(values[k])) return DMB_ERR_NOT_FINITE;
    return DMB_OK;
}

static int32_t check_offset(const double offset[3])
{
    return offset == NULL ? DMB_ERR_NULL : check_finite(offset, 3);
}

/* R0: axes of the place at time 0 as described. */
static void move_pose(const double offset[3], const double R0[9], dmb_pose *pose)
{
    double now[3], start[3];
    dmb_mat3_vec(pose->rotation, offset, now);
    dmb_mat3_vec(R0, offset, start);
    dmb_vec3_add(pose->position, now, pose->position);
    dmb_vec3_add(pose->displacement, now, pose->displacement);
    dmb_vec3_sub(pose->displacement, start, pose->displacement);
}

int32_t dmb_answer_pose_at(const dmb_sim *sim, dmb_place place, const double offset[3], dmb_pose *pose)
{
    dmb_pose answer = dmb_pose_default();
    dmb_material_point point;
    double R0[9];
    int32_t status = dmb_ask(sim, pose);
    if (status >= 0) status = check_offset(offset);
    if (status >= 0) status = dmb_answer_pose(sim, place, &answer);
    if (status >= 0) status = dmb_material_point_of(sim, place, &point);
    if (status < 0) return status;
    dmb_material_point_start_axes(sim->scene, &point, R0);
    move_pose(offset, R0, &answer);
    status = check_finite(answer.position, 3); /* offsets are not bounded, so that the sum may overflow */
    if (status < 0) return status;
    answer.depth = dmb_material_point_depth(sim->scene, &sim->now, &point, answer.position);
    return dmb_pose_write(pose, &answer);
}

/* v + w x r, and a + w' x r in the axes of the body; in the world w x (w x r) is added. */
static void move_motion(const double r[3], int32_t world, dmb_motion *motion)
{
    const double *w = motion->velocity + 3;
    double v[3], a[3], turn[3];
    dmb_vec3_cross(w, r, v);
    dmb_vec3_cross(motion->acceleration + 3, r, a);
    dmb_vec3_cross(w, v, turn);
    dmb_vec3_add(motion->velocity, v, motion->velocity);
    dmb_vec3_add(motion->acceleration, a, motion->acceleration);
    if (world) dmb_vec3_add(motion->acceleration, turn, motion->acceleration);
}

int32_t dmb_answer_motion_at(const dmb_sim *sim, dmb_place place, const double offset[3], dmb_motion *motion)
{
    dmb_motion answer;
    dmb_pose pose = dmb_pose_default();
    double r[3];
    int32_t status = dmb_ask(sim, motion);
    if (status >= 0) status = dmb_motion_read(&answer, motion);
    if (status >= 0) status = check_offset(offset);
    if (status >= 0) status = dmb_answer_motion(sim, place, &answer);
    if (status >= 0) status = dmb_answer_pose(sim, place, &pose);
    if (status < 0) return status;
    dmb_vec3_copy(offset, r);
    if (answer.frame == DMB_FRAME_WORLD) dmb_mat3_vec(pose.rotation, offset, r);
    move_motion(r, answer.frame == DMB_FRAME_WORLD, &answer);
    status = check_finite(answer.velocity, 6);
    if (status >= 0) status = check_finite(answer.acceleration, 6);
    return status < 0 ? status : dmb_motion_write(motion, &answer);
}
