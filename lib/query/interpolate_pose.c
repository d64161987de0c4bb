#include "math/se3.h"
#include "query/interpolation.h"
#include "query/relative_pose.h"

/* Section seen from node a: rotation Q and place r [m]. */
static void section_from_node(const dmb_scene *scene, const dmb_spot *spot, const dmb_end_pose *a,
                              const dmb_end_pose *b, double Q[9], double r[3])
{
    const dmb_element_type *type = &scene->types[scene->element_type[spot->element]];
    dmb_section_shape shape;
    double d[6], h[6], c[6], R1[9], R2[9], x2[3];
    dmb_relative_pose(scene, spot->element, a, b, d);
    dmb_spot_shape(scene, spot, &shape);
    for (int i = 0; i < 6; i++) h[i] = shape.x * d[i];
    dmb_section_shape_correct(&shape, d, c);
    dmb_se3_exp(h, NULL, R1, r);
    dmb_se3_exp(c, NULL, R2, x2);
    dmb_mat3_mul(R1, R2, Q);
    dmb_mat3_vec(R1, x2, x2);
    dmb_vec3_add(r, x2, r);
    r[0] += type->arm[0];
}

/* From a node and a place r seen from it, now and at the start. The displacement never subtracts world positions. */
static void place_from_node(const dmb_scene *scene, uint32_t node, const dmb_end_pose *now, const double r[3],
                            const double rotation_start[9], const double r_start[3], dmb_spot_pose *pose)
{
    double moved[3], before[3];
    dmb_mat3_vec(now->rotation, r, moved);
    dmb_mat3_vec(rotation_start, r_start, before);
    dmb_vec3_add(scene->reference_position + 3 * (size_t)node, now->displacement, pose->position);
    dmb_vec3_add(pose->position, moved, pose->position);
    dmb_vec3_sub(moved, before, pose->displacement);
    dmb_vec3_add(pose->displacement, now->displacement, pose->displacement);
}

static void fixed_pose(const dmb_scene *scene, const dmb_configuration *configuration, const dmb_spot *spot,
                       dmb_spot_pose *pose)
{
    const double arm[3] = {spot->arm, 0.0, 0.0};
    dmb_end_pose now, start;
    dmb_end_pose_now(scene, configuration, spot->node, &now);
    dmb_end_pose_at_start(scene, spot->node, &start);
    dmb_mat3_copy(now.rotation, pose->rotation);
    place_from_node(scene, spot->node, &now, arm, start.rotation, arm, pose);
}

static void section_pose(const dmb_scene *scene, const dmb_configuration *configuration, const dmb_spot *spot,
                         dmb_spot_pose *pose)
{
    const uint32_t a = scene->element_node[spot->element], b = a + 1;
    dmb_end_pose now_a, now_b, start_a, start_b;
    double Q[9], Q_start[9], r[3], r_start[3];
    dmb_end_pose_now(scene, configuration, a, &now_a);
    dmb_end_pose_now(scene, configuration, b, &now_b);
    dmb_end_pose_at_start(scene, a, &start_a);
    dmb_end_pose_at_start(scene, b, &start_b);
    section_from_node(scene, spot, &now_a, &now_b, Q, r);
    section_from_node(scene, spot, &start_a, &start_b, Q_start, r_start);
    dmb_mat3_mul(now_a.rotation, Q, pose->rotation);
    place_from_node(scene, a, &now_a, r, start_a.rotation, r_start, pose);
}

void dmb_spot_pose_of(const dmb_scene *scene, const dmb_configuration *configuration, const dmb_spot *spot,
                      dmb_spot_pose *pose)
{
    if (spot->fixed)
        fixed_pose(scene, configuration, spot, pose);
    else
        section_pose(scene, configuration, spot, pose);
}
