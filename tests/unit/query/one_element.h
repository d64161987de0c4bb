/* A scene of one flexible element between two free nodes, made by hand, for tests of what lies between them. */
#ifndef DMB_TESTS_ONE_ELEMENT_H
#define DMB_TESTS_ONE_ELEMENT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "close.h"
#include "math/se3.h"
#include "query/query.h"

typedef struct one_element {
    dmb_scene scene;
    dmb_configuration configuration;
    dmb_element_type type;
    uint8_t size[2];
    uint32_t row[3], element_type[1], element_node[1];
    double reference_position[6], reference_quaternion[8], reference_depth[2], span[3];
    double displacement[6], quaternion[8], turn[2], velocity[12], acceleration[12], friction_slip[2];
} one_element;

/* A straight element of length L along the frame R0 at x0, with rigid arms, E I = 1 scaled stiffnesses. */
static inline void one_element_make(one_element *o, double length, double near_arm, double far_arm, double shear)
{
    const double O0[3] = {0.3, -0.2, 0.7};
    const double along[3] = {near_arm + length + far_arm, 0.0, 0.0};
    double q[4];
    memset(o, 0, sizeof *o);
    o->size[0] = o->size[1] = DMB_NODE_SIX_DOF;
    o->row[1] = 6, o->row[2] = 12;
    o->scene.node_count = 2, o->scene.row_count = 12, o->scene.element_count = o->scene.type_count = 1;
    o->scene.layout.n = 2, o->scene.layout.size = o->size, o->scene.layout.row = o->row;
    o->scene.types = &o->type, o->scene.element_type = o->element_type, o->scene.element_node = o->element_node;
    o->scene.element_span = o->span;
    o->scene.reference_position = o->reference_position;
    o->scene.reference_quaternion = o->reference_quaternion;
    o->scene.reference_depth = o->reference_depth;
    o->type.length = length;
    o->type.arm[0] = near_arm, o->type.arm[1] = far_arm;
    o->type.rest[0] = length;
    dmb_vec3_set(1e4, shear, 2.0 * shear, o->type.strain_stiffness);
    dmb_vec3_set(1.5, 2.0, 1.0, o->type.strain_stiffness + 3);
    o->configuration.displacement = o->displacement, o->configuration.quaternion = o->quaternion;
    o->configuration.turn = o->turn, o->configuration.velocity = o->velocity;
    o->configuration.acceleration = o->acceleration;
    o->configuration.friction_slip = o->friction_slip;
    dmb_quat_exp(O0, q);
    dmb_vec3_set(10.0, -3.0, 2.0, o->reference_position);
    dmb_quat_rotate(q, along, o->span);
    dmb_vec3_add(o->reference_position, o->span, o->reference_position + 3);
    for (int i = 0; i < 2; i++) {
        dmb_quat_copy(q, o->reference_quaternion + 4 * i);
        dmb_quat_copy(q, o->quaternion + 4 * i);
    }
}

/* A node moved by exp h from where it is. */
static inline void one_element_move(one_element *o, int node, const double h[6])
{
    dmb_se3_advance(o->quaternion + 4 * node, o->displacement + 3 * node, h);
}

static inline dmb_material_point one_element_spot(double x)
{
    const dmb_material_point point = {0, 0, 0.0, x, 0.0, 0, 0};
    return point;
}

static inline dmb_material_point_pose one_element_pose(const one_element *o, double x)
{
    const dmb_material_point point = one_element_spot(x);
    dmb_material_point_pose pose;
    dmb_material_point_pose_of(&o->scene, &o->configuration, &point, &pose);
    return pose;
}

static inline dmb_material_point_motion one_element_motion(const one_element *o, double x)
{
    const dmb_material_point point = one_element_spot(x);
    dmb_material_point_motion motion;
    dmb_material_point_motion_of(&o->scene, &o->configuration, &point, &motion);
    return motion;
}

#endif
