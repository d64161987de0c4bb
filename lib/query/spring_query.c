/* Springs between points, and poses off a place. */
#include <math.h>

#include "base/sized_struct.h"
#include "drillmbd/forces.h"
#include "math/mat6.h"
#include "math/vec3.h"
#include "query/interpolation.h"
#include "sim/access.h"
#include "system/assemble/springs.h"

DMB_DEFINE_INIT(dmb_spring_state, 136, {.length = 0.0})

static void world_point(const dmb_scene *scene, const dmb_point_motion *point, double x[3])
{
    dmb_vec3_copy(point->x, x);
    if (point->nodes > 0) dmb_vec3_add(x, scene->reference_position + 3 * (size_t)point->node[0], x);
}

int32_t dmb_query_spring(const dmb_sim *sim, dmb_id spring, dmb_spring_state *state)
{
    const int32_t status = dmb_ask(sim, state);
    dmb_spring_state answer = {0};
    dmb_spring_motion m;
    if (status < 0) return status;
    const uint32_t i = dmb_model_part_index(sim->model, spring, DMB_PART_SPRING);
    if (i >= sim->scene->spring_count) return DMB_ERR_ID;
    const dmb_scene_spring *s = sim->scene->springs + i;
    dmb_spring_motion_of(sim->scene, &sim->now, i, 1, &m);
    answer.length = m.length;
    answer.elongation = m.length - s->free_length;
    answer.speed = m.rate;
    answer.elastic = m.force.elastic;
    answer.damper = m.force.damper;
    answer.force = m.force.elastic + m.force.damper;
    answer.energy = dmb_spring_energy_at(&s->law, sim->scene->spring_points + s->law.first, answer.elongation);
    dmb_vec3_copy(m.n, answer.direction);
    world_point(sim->scene, &m.a, answer.point_a);
    world_point(sim->scene, &m.b, answer.point_b);
    return dmb_spring_state_write(state, &answer);
}

/* ---- Poses and motions off a place ------------------------------------------------------------------------------- */

static int32_t check_offset(const double offset[3])
{
    if (offset == NULL) return DMB_ERR_NULL;
    for (int k = 0; k < 3; k++)
        if (!isfinite(offset[k])) return DMB_ERR_NOT_FINITE;
    return DMB_OK;
}

DMB_DECLARE_STRUCT(dmb_pose)

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

int32_t dmb_query_pose_at(const dmb_sim *sim, dmb_place place, const double offset[3], dmb_pose *pose)
{
    dmb_pose answer = dmb_pose_default();
    dmb_material_point point;
    double R0[9];
    int32_t status = dmb_ask(sim, pose);
    if (status >= 0) status = check_offset(offset);
    if (status >= 0) status = dmb_query_pose(sim, place, &answer);
    if (status >= 0) status = dmb_material_point_of(sim, place, &point);
    if (status < 0) return status;
    dmb_material_point_start_axes(sim->scene, &point, R0);
    move_pose(offset, R0, &answer);
    answer.depth = dmb_material_point_depth(sim->scene, &sim->now, &point, answer.position);
    return dmb_pose_write(pose, &answer);
}

DMB_DECLARE_STRUCT(dmb_motion)

/* v + w x r, and a + w' x r in the axes of the body, with w x (w x r) more in the world. */
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

int32_t dmb_query_motion_at(const dmb_sim *sim, dmb_place place, const double offset[3], dmb_motion *motion)
{
    dmb_motion answer;
    dmb_pose pose = dmb_pose_default();
    double r[3];
    int32_t status = dmb_ask(sim, motion);
    if (status >= 0) status = dmb_motion_read(&answer, motion);
    if (status >= 0) status = check_offset(offset);
    if (status >= 0) status = dmb_query_motion(sim, place, &answer);
    if (status >= 0) status = dmb_query_pose(sim, place, &pose);
    if (status < 0) return status;
    dmb_vec3_copy(offset, r);
    if (answer.frame == DMB_FRAME_WORLD) dmb_mat3_vec(pose.rotation, offset, r);
    move_motion(r, answer.frame == DMB_FRAME_WORLD, &answer);
    return dmb_motion_write(motion, &answer);
}
