#include "math/vec3.h"
#include "query/ask.h"
#include "query/interpolation.h"

DMB_DECLARE_STRUCT(dmb_pose)

int32_t dmb_query_pose(const dmb_sim *sim, dmb_place place, dmb_pose *pose)
{
    int32_t status = dmb_ask(sim, pose);
    dmb_spot spot;
    dmb_spot_pose found;
    dmb_pose answer = {0};
    if (status == DMB_OK) status = dmb_spot_of(sim, place, &spot);
    if (status < 0) return status;
    dmb_spot_pose_of(sim->scene, &sim->now, &spot, &found);
    dmb_vec3_copy(found.position, answer.position);
    dmb_mat3_copy(found.rotation, answer.rotation);
    dmb_vec3_copy(found.displacement, answer.displacement);
    answer.depth = dmb_spot_depth(sim->scene, &sim->now, &spot, found.position);
    return dmb_pose_write(pose, &answer);
}
