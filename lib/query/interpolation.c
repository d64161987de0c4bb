#include "query/interpolation.h"

#include "element/beam.h"
#include "math/se3.h"
#include "sim/node.h"

void dmb_end_pose_now(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t node, dmb_end_pose *pose)
{
    dmb_node_pose(scene, configuration, node, pose->rotation, pose->displacement);
}

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

/* Bars on the hole's axis do not bend by themselves: no bending shape. */
void dmb_material_point_shape(const dmb_scene *scene, const dmb_material_point *material_point,
                              dmb_section_shape *shape)
{
    const uint32_t a = scene->element_node[material_point->element];
    const int path = scene->layout.size[a] == DMB_NODE_PATH && scene->layout.size[a + 1] == DMB_NODE_PATH;
    dmb_section_shape_at(&scene->types[scene->element_type[material_point->element]], material_point->fraction, !path,
                         shape);
}

/* Section seen from node a: rotation Q and place r [m]. */
static void section_from_node(const dmb_scene *scene, const dmb_material_point *material_point, const dmb_end_pose *a,
                              const dmb_end_pose *b, double Q[9], double r[3])
{
    dmb_section_shape shape;
    double d[6];
    dmb_relative_pose(scene, material_point->element, a, b, d);
    dmb_material_point_shape(scene, material_point, &shape);
    dmb_section_pose(&scene->types[scene->element_type[material_point->element]], &shape, d, Q, r);
}

/* From a node and a place r seen from it, now and at the start. The displacement never subtracts world positions. */
static void place_from_node(const dmb_scene *scene, uint32_t node, const dmb_end_pose *now, const double r[3],
                            const double rotation_start[9], const double r_start[3], dmb_material_point_pose *pose)
{
    double moved[3], before[3];
    dmb_mat3_vec(now->rotation, r, moved);
    dmb_mat3_vec(rotation_start, r_start, before);
    dmb_vec3_add(scene->reference_position + 3 * (size_t)node, now->displacement, pose->position);
    dmb_vec3_add(pose->position, moved, pose->position);
    dmb_vec3_sub(moved, before, pose->displacement);
    dmb_vec3_add(pose->displacement, now->displacement, pose->displacement);
}

static void fixed_pose(const dmb_scene *scene, const dmb_configuration *configuration,
                       const dmb_material_point *material_point, dmb_material_point_pose *pose)
{
    const double arm[3] = {material_point->arm, 0.0, 0.0};
    dmb_end_pose now, start;
    dmb_end_pose_now(scene, configuration, material_point->node, &now);
    dmb_end_pose_at_start(scene, material_point->node, &start);
    dmb_mat3_copy(now.rotation, pose->rotation);
    place_from_node(scene, material_point->node, &now, arm, start.rotation, arm, pose);
}

static void section_pose(const dmb_scene *scene, const dmb_configuration *configuration,
                         const dmb_material_point *material_point, dmb_material_point_pose *pose)
{
    const uint32_t a = scene->element_node[material_point->element], b = a + 1;
    dmb_end_pose now_a, now_b, start_a, start_b;
    double Q[9], Q_start[9], r[3], r_start[3];
    dmb_end_pose_now(scene, configuration, a, &now_a);
    dmb_end_pose_now(scene, configuration, b, &now_b);
    dmb_end_pose_at_start(scene, a, &start_a);
    dmb_end_pose_at_start(scene, b, &start_b);
    section_from_node(scene, material_point, &now_a, &now_b, Q, r);
    section_from_node(scene, material_point, &start_a, &start_b, Q_start, r_start);
    dmb_mat3_mul(now_a.rotation, Q, pose->rotation);
    place_from_node(scene, a, &now_a, r, start_a.rotation, r_start, pose);
}

void dmb_material_point_pose_of(const dmb_scene *scene, const dmb_configuration *configuration,
                                const dmb_material_point *material_point, dmb_material_point_pose *pose)
{
    if (material_point->fixed)
        fixed_pose(scene, configuration, material_point, pose);
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

/* From a frame to the frame exp h seen from it: V <- Ad^-1 V + W, V' <- Ad^-1 V' - W^ (Ad^-1 V) + W' */
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

/* d' = T6^-1(d) V_B - T6^-1(-d) V_A and its derivative, X(d, V_B) d' and X(-d, V_A) d' from the operators */
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

void dmb_material_point_motion_of(const dmb_scene *scene, const dmb_configuration *configuration,
                                  const dmb_material_point *material_point, dmb_material_point_motion *motion)
{
    if (material_point->fixed)
        node_motion(scene, configuration, material_point->node, material_point->arm, motion);
    else
        section_motion(scene, configuration, material_point, motion);
}

double dmb_material_point_turn(const dmb_configuration *configuration, const dmb_material_point *material_point)
{
    const double *turn = configuration->turn + material_point->node;
    if (material_point->fixed) return turn[0];
    return turn[0] + material_point->fraction * (turn[1] - turn[0]);
}

/* Arc of the hole in which a measured depth lies: where to start looking. */
static uint32_t segment_at(const dmb_hole *hole, double depth)
{
    uint32_t low = 0, high = hole->stations;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (hole->station[middle].depth <= depth)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* A PATH node knows its depth exactly; elsewhere the axis is searched from where the node is about. */
double dmb_material_point_depth(const dmb_scene *scene, const dmb_configuration *configuration,
                                const dmb_material_point *material_point, const double x[3])
{
    double depth, point[3], tangent[3];
    uint32_t segment = 0;
    if (!scene->has_hole) return 0.0;
    if (material_point->fixed && material_point->arm == 0.0 &&
        scene->layout.size[material_point->node] == DMB_NODE_PATH)
        return dmb_path_depth(scene, configuration, material_point->node);
    if (!dmb_hole_is_straight(&scene->hole))
        segment = segment_at(&scene->hole, scene->reference_depth[material_point->node] + material_point->arm +
                                               configuration->displacement[3 * (size_t)material_point->node]);
    dmb_hole_project(&scene->hole, x, &depth, &segment, point, tangent);
    return depth;
}
