#include "system/node.h"

#include "math/mat6.h"
#include "math/so3.h"

double dmb_path_depth(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t node)
{
    return scene->reference_depth[node] + configuration->displacement[3 * node];
}

/* Turned by `turn` about the axis of the hole where it now is; without a hole the line through its pose at time 0. */
static void path_pose(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t node, double rotation[9],
                      double displacement[3])
{
    const double advance = configuration->displacement[3 * node];
    const double spin[3] = {configuration->turn[node], 0.0, 0.0};
    double frame[9], twist[9];
    dmb_so3_exp(spin, NULL, twist);
    dmb_quat_to_matrix(scene->reference_quaternion + 4 * node, frame);
    if (scene->has_hole && !dmb_hole_is_straight(&scene->hole)) {
        double point[3], tangent[3], curvature[3], start[3];
        dmb_hole_frame(&scene->hole, scene->reference_depth[node], start, tangent, curvature);
        dmb_hole_frame(&scene->hole, dmb_path_depth(scene, configuration, node), point, tangent, curvature);
        dmb_hole_frame_rotation(&scene->hole, dmb_path_depth(scene, configuration, node), frame);
        dmb_vec3_sub(point, start, displacement);
    } else {
        const double along[3] = {advance, 0.0, 0.0};
        dmb_mat3_vec(frame, along, displacement);
    }
    dmb_mat3_mul(frame, twist, rotation);
}

void dmb_node_pose(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t node, double rotation[9],
                   double displacement[3])
{
    if (scene->layout.size[node] == DMB_NODE_PATH) {
        path_pose(scene, configuration, node, rotation, displacement);
        return;
    }
    dmb_quat_to_matrix(configuration->quaternion + 4 * node, rotation);
    dmb_vec3_copy(configuration->displacement + 3 * node, displacement);
}

void dmb_path_columns(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t node,
                      const double rotation[9], double columns[12])
{
    for (int i = 0; i < 12; i++) columns[i] = 0.0;
    columns[0] = columns[9] = 1.0;
    if (scene->has_hole && !dmb_hole_is_straight(&scene->hole)) {
        double point[3], tangent[3], curvature[3], turning[3];
        dmb_hole_frame(&scene->hole, dmb_path_depth(scene, configuration, node), point, tangent, curvature);
        dmb_hole_turning(tangent, curvature, turning);
        dmb_mat3_tvec(rotation, turning, columns + 3);
    }
}

void dmb_node_vector(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t node, const double *rows,
                     double vector[6])
{
    const double *row = rows + scene->layout.row[node];
    if (scene->layout.size[node] == DMB_NODE_FULL) {
        dmb_vec6_copy(row, vector);
        return;
    }
    double rotation[9], displacement[3], columns[12];
    dmb_node_pose(scene, configuration, node, rotation, displacement);
    dmb_path_columns(scene, configuration, node, rotation, columns);
    for (int i = 0; i < 6; i++) vector[i] = columns[i] * row[0] + columns[6 + i] * row[1];
}

uint32_t dmb_count_full_nodes(const dmb_scene *scene, uint32_t node)
{
    uint32_t end = node;
    if (scene->row_count == DMB_NODE_FULL * scene->node_count) return scene->node_count - node;
    while (end < scene->node_count && scene->layout.size[end] == DMB_NODE_FULL) end++;
    return end - node;
}

uint32_t dmb_element_between(const dmb_scene *scene, uint32_t node, uint32_t side)
{
    if (side == 1) return scene->node_element[node];
    return node > 0 ? scene->node_element[node - 1] : UINT32_MAX;
}
