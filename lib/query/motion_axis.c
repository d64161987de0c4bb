/* Sections of axial-torsional elements in a curved hole. These elements stay on the axis: a section between the depths
 * s_A and s_B of two nodes is at s = (1 - f) s_A + f s_B, with the frame of A transported along the axis and the
 * fraction f of the torsion. */
#include "element/beam.h"
#include "math/mat6.h"
#include "math/se3.h"
#include "math/so3.h"
#include "math/vec3.h"
#include "query/query.h"
#include "sim/node.h"

int dmb_is_on_curved_axis(const dmb_scene *scene, const dmb_material_point *material_point)
{
    if (material_point->fixed || !scene->has_hole || dmb_hole_is_straight(&scene->hole)) return 0;
    const uint32_t a = scene->element_node[material_point->element];
    return scene->layout.size[a] == DMB_NODE_AXIAL_TORSIONAL && scene->layout.size[a + 1] == DMB_NODE_AXIAL_TORSIONAL;
}

/* [-] fraction of the distance from node to node, rigid arms included. */
static double fraction_of(const dmb_scene *scene, const dmb_material_point *material_point)
{
    const dmb_element_type *type = &scene->types[scene->element_type[material_point->element]];
    return (type->arm[0] + material_point->fraction * type->length) / (type->arm[0] + type->length + type->arm[1]);
}

/* Position on the axis at the section minus the linear interpolation of the positions at the nodes [m]. */
static double bow_of(const dmb_scene *scene, const double ends[2], double f, double bow[3])
{
    const double s = ends[0] + f * (ends[1] - ends[0]);
    double p[3], a[3], b[3];
    dmb_hole_frame(&scene->hole, s, p, NULL, NULL);
    dmb_hole_frame(&scene->hole, ends[0], a, NULL, NULL);
    dmb_hole_frame(&scene->hole, ends[1], b, NULL, NULL);
    for (int i = 0; i < 3; i++) bow[i] = (1.0 - f) * (p[i] - a[i]) + f * (p[i] - b[i]);
    return s;
}

/* The displacement is the difference of the bows now and at the start plus the interpolated displacement of the nodes:
 * no world positions are subtracted, which would lose digits far from the origin. */
void dmb_axis_pose_of(const dmb_scene *scene, const dmb_configuration *configuration,
                      const dmb_material_point *material_point, dmb_material_point_pose *pose)
{
    const uint32_t a = scene->element_node[material_point->element];
    const double f = fraction_of(scene, material_point);
    const double *x = scene->reference_position + 3 * (size_t)a;
    const double now[2] = {dmb_axial_torsional_depth(scene, configuration, a),
                           dmb_axial_torsional_depth(scene, configuration, a + 1)};
    const double torsion[3] = {f * (configuration->turn[a + 1] - configuration->turn[a]), 0.0, 0.0};
    double bow[3], bow_start[3], carried[9], twist[9];
    dmb_end_pose end_a, end_b;
    dmb_end_pose_now(scene, configuration, a, &end_a);
    dmb_end_pose_now(scene, configuration, a + 1, &end_b);
    (void)bow_of(scene, scene->reference_depth + a, f, bow_start);
    dmb_hole_carry(&scene->hole, now[0], bow_of(scene, now, f, bow), carried);
    for (int i = 0; i < 3; i++) {
        const double moved = (1.0 - f) * end_a.displacement[i] + f * end_b.displacement[i];
        pose->displacement[i] = moved + (bow[i] - bow_start[i]);
        pose->position[i] = ((1.0 - f) * x[i] + f * x[i + 3]) + (moved + bow[i]);
    }
    dmb_mat3_mul(carried, end_a.rotation, pose->rotation);
    dmb_so3_exp(torsion, NULL, twist);
    dmb_mat3_copy(pose->rotation, carried);
    dmb_mat3_mul(carried, twist, pose->rotation);
}

/* V = (v; R^T (v t x k) + w e_x); rows are interpolated in the same way as the position. */
static void axis_vector(const dmb_scene *scene, const dmb_material_point *material_point, double s, const double R[9],
                        const double *rows, double vector[6])
{
    const uint32_t a = scene->element_node[material_point->element];
    const double *row_a = rows + scene->layout.row[a], *row_b = rows + scene->layout.row[a + 1];
    const double f = fraction_of(scene, material_point);
    const double v = row_a[0] + f * (row_b[0] - row_a[0]);
    double p[3], t[3], k[3], turn[3];
    dmb_hole_frame(&scene->hole, s, p, t, k);
    dmb_vec3_cross(t, k, turn);
    dmb_vec3_set(v, 0.0, 0.0, vector);
    dmb_mat3_tvec(R, turn, vector + 3);
    dmb_vec3_scale(v, vector + 3, vector + 3);
    vector[3] += row_a[1] + f * (row_b[1] - row_a[1]);
}

void dmb_axis_motion_of(const dmb_scene *scene, const dmb_configuration *configuration,
                        const dmb_material_point *material_point, dmb_material_point_motion *motion)
{
    const uint32_t a = scene->element_node[material_point->element];
    const double s_a = dmb_axial_torsional_depth(scene, configuration, a),
                 s_b = dmb_axial_torsional_depth(scene, configuration, a + 1);
    const double s = s_a + fraction_of(scene, material_point) * (s_b - s_a);
    dmb_material_point_pose pose;
    dmb_axis_pose_of(scene, configuration, material_point, &pose);
    axis_vector(scene, material_point, s, pose.rotation, configuration->velocity, motion->velocity);
    axis_vector(scene, material_point, s, pose.rotation, configuration->acceleration, motion->acceleration);
}

void dmb_axis_start_rotation(const dmb_scene *scene, const dmb_material_point *material_point, const double R_a[9],
                             double R[9])
{
    const double *ends = scene->reference_depth + scene->element_node[material_point->element];
    double carried[9];
    dmb_hole_carry(&scene->hole, ends[0], ends[0] + fraction_of(scene, material_point) * (ends[1] - ends[0]), carried);
    dmb_mat3_mul(carried, R_a, R);
}

void dmb_end_pose_now(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t node, dmb_end_pose *pose)
{
    dmb_node_pose(scene, configuration, node, pose->rotation, pose->displacement);
}
