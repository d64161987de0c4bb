/* Described loads: dead (world or hole frame) and follower (body frame), each times its programme. */
#include <string.h>

#include "element/beam.h"
#include "system/evaluation.h"
#include "system/node.h"

static void frame_of_load(const dmb_sim *sim, const dmb_scene_load *load, double R[9])
{
    const dmb_scene *scene = sim->scene;
    if (load->frame == DMB_FRAME_HOLE && scene->has_hole) {
        double x[3], point[3], tangent[3], s = scene->reference_depth[load->node];
        uint32_t segment = 0;
        dmb_vec3_add(scene->reference_position + 3 * load->node, sim->trial.displacement + 3 * load->node, x);
        dmb_hole_project(&scene->hole, x, &s, &segment, point, tangent);
        dmb_hole_frame_rotation(&scene->hole, s, R);
    } else if (load->frame == DMB_FRAME_HOLE) {
        dmb_quat_to_matrix(scene->reference_quaternion + 4 * load->node, R);
    } else {
        dmb_mat3_identity(R);
    }
}

/* Body-frame wrench at the place of the load. */
static void wrench_of(const dmb_sim *sim, const dmb_scene_load *load, double factor, double w[6])
{
    double R[9], body[9], f[3], unused[3];
    dmb_vec3_scale(factor, load->force, w);
    dmb_vec3_scale(factor, load->moment, w + 3);
    if (load->frame == DMB_FRAME_BODY) return;
    frame_of_load(sim, load, R);
    dmb_node_pose(sim->scene, &sim->trial, load->node, body, unused);
    for (int k = 0; k < 6; k += 3) {
        dmb_mat3_vec(R, w + k, f);
        dmb_mat3_tvec(body, f, w + k);
    }
}

static void gather_load(dmb_evaluation *evaluation, const dmb_scene_load *load, double factor)
{
    dmb_sim *sim = evaluation->sim;
    double w[6], v[6], K[36];
    wrench_of(sim, load, evaluation->load_factor * factor, w);
    if (evaluation->tangent && load->frame != DMB_FRAME_BODY && sim->scene->layout.size[load->node] == DMB_NODE_FULL) {
        dmb_mat6_zero(K); /* d(R^T f) = (R^T f)~ dtheta */
        dmb_mat6_add_skew(1.0, w, 0, 1, K);
        dmb_mat6_add_skew(1.0, w + 3, 1, 1, K);
        dmb_beam_block_to_nodes(load->arm, 0.0, K);
        dmb_mat6_axpy(-1.0, K, dmb_stiffness_of(sim, load->node));
    }
    dmb_arm_wrench(load->arm, w);
    dmb_apply_wrench(sim, load->node, w);
    if (!evaluation->dynamic) return;
    dmb_node_vector(sim->scene, &sim->trial, load->node, sim->trial.velocity, v);
    evaluation->power[DMB_POWER_LOADS] += dmb_vec6_dot(w, v);
}

void dmb_gather_loads(dmb_evaluation *evaluation)
{
    const dmb_sim *sim = evaluation->sim;
    for (uint32_t i = 0; i < sim->scene->load_count; i++)
        gather_load(evaluation, sim->scene->loads + i, sim->trial.load_factor[i]);
}
