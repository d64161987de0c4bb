#include "element/beam.h"
#include "query/interpolation.h"
#include "query/relative_pose.h"
#include "system/node.h"

static void node_motion(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t node, double arm,
                        dmb_spot_motion *motion)
{
    dmb_node_vector(scene, configuration, node, configuration->velocity, motion->velocity);
    dmb_node_vector(scene, configuration, node, configuration->acceleration, motion->acceleration);
    dmb_arm_velocity(arm, motion->velocity);
    dmb_arm_velocity(arm, motion->acceleration);
}

/* W = T6(h) h', W' = T6(h) (h'' - X(h, W) h') with X = d/dh (T6^-1(h) W): velocity of exp h and its rate */
static void motion_of_exp(const double h[6], const double rate[6], const double second[6], dmb_spot_motion *out)
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
static void follow(const double h[6], const double rate[6], const double second[6], dmb_spot_motion *motion)
{
    dmb_spot_motion own;
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
static void strain_rates(const double d[6], const dmb_spot_motion *a, const dmb_spot_motion *b, double rate[6],
                         double second[6])
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

static void section_motion(const dmb_scene *scene, const dmb_configuration *configuration, const dmb_spot *spot,
                           dmb_spot_motion *motion)
{
    const dmb_element_type *type = &scene->types[scene->element_type[spot->element]];
    const uint32_t a = scene->element_node[spot->element], b = a + 1;
    dmb_spot_motion far_end;
    dmb_section_shape shape;
    dmb_end_pose pose_a, pose_b;
    double d[6], rate[6], second[6], h[3][6], c[3][6];
    dmb_end_pose_now(scene, configuration, a, &pose_a);
    dmb_end_pose_now(scene, configuration, b, &pose_b);
    dmb_relative_pose(scene, spot->element, &pose_a, &pose_b, d);
    node_motion(scene, configuration, a, type->arm[0], motion);
    node_motion(scene, configuration, b, -type->arm[1], &far_end);
    strain_rates(d, motion, &far_end, rate, second);
    dmb_spot_shape(scene, spot, &shape);
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

void dmb_spot_motion_of(const dmb_scene *scene, const dmb_configuration *configuration, const dmb_spot *spot,
                        dmb_spot_motion *motion)
{
    if (spot->fixed)
        node_motion(scene, configuration, spot->node, spot->arm, motion);
    else
        section_motion(scene, configuration, spot, motion);
}
