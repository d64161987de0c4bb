#include "query/relative_pose.h"

#include "math/se3.h"
#include "system/node.h"

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
    const dmb_element_type *type = &scene->types[scene->element_type[element]];
    const double far_arm[3] = {-type->arm[1], 0.0, 0.0};
    double R[9], x[3], arm[3];
    dmb_mat3_mul_tn(a->rotation, b->rotation, R);
    dmb_vec3_sub(b->displacement, a->displacement, x);
    dmb_vec3_add(x, scene->element_span + 3 * (size_t)element, x);
    dmb_mat3_tvec(a->rotation, x, x);
    dmb_mat3_vec(R, far_arm, arm);
    dmb_vec3_add(x, arm, x);
    x[0] -= type->arm[0];
    dmb_se3_log(R, x, NULL, d);
}

/* Bars on the hole's axis do not bend by themselves: no bending shape. */
void dmb_spot_shape(const dmb_scene *scene, const dmb_spot *spot, dmb_section_shape *shape)
{
    const uint32_t a = scene->element_node[spot->element];
    const int path = scene->layout.size[a] == DMB_NODE_PATH && scene->layout.size[a + 1] == DMB_NODE_PATH;
    dmb_section_shape_at(&scene->types[scene->element_type[spot->element]], spot->fraction, !path, shape);
}
