/* Pose, unwrapped rotation and motion of a place. */
#include "math/mat6.h"
#include "math/vec3.h"
#include "query/interpolation.h"
#include "sim/access.h"

DMB_DECLARE_STRUCT(dmb_pose)

int32_t dmb_query_pose(const dmb_sim *sim, dmb_place place, dmb_pose *pose)
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

int32_t dmb_query_rotation(const dmb_sim *sim, dmb_place place, double *angle)
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

int32_t dmb_query_motion(const dmb_sim *sim, dmb_place place, dmb_motion *motion)
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
