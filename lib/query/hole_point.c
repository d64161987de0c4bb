/* The hole's axis at a measured depth. */
#include <math.h>

#include "base/handle.h"
#include "base/sized_struct.h"
#include "drillmbd/query.h"
#include "force/hole.h"
#include "math/real.h"
#include "model/limits.h"
#include "model/model.h"
#include "model/scene.h"

DMB_DEFINE_INIT(dmb_hole_point, 120, {.beyond = DMB_HOLE_SURVEYED})

#define VERTICAL 1e-9 /* [-] no azimuth within this of the vertical */

static int32_t hole_of(const dmb_model *model, const dmb_hole **hole)
{
    if (model == NULL) return DMB_ERR_NULL;
    if (!dmb_handle_is(model, DMB_HANDLE_MODEL)) return DMB_ERR_HANDLE;
    if (model->scene == NULL) return DMB_ERR_ORDER;
    if (!model->scene->has_hole) return DMB_ERR_UNSUPPORTED;
    *hole = &model->scene->hole;
    return DMB_OK;
}

/* As described: a survey without a bend is a straight hole inside. */
static int32_t beyond(const dmb_wall_def *wall, double depth)
{
    if (wall->survey_count == 0) return DMB_HOLE_SURVEYED;
    if (depth < wall->survey[0]) return DMB_HOLE_ABOVE;
    return depth > wall->survey[3 * (size_t)(wall->survey_count - 1)] ? DMB_HOLE_BELOW : DMB_HOLE_SURVEYED;
}

static void direction(dmb_hole_point *point)
{
    const double *t = point->tangent;
    const double across = hypot(t[0], t[1]);
    point->inclination = atan2(across, -t[2]);
    point->azimuth = across > VERTICAL ? atan2(t[1], t[0]) : 0.0;
}

int32_t dmb_query_hole(const dmb_model *model, double depth, dmb_hole_point *point)
{
    const dmb_hole *hole;
    dmb_hole_point answer = {0};
    double bend[3];
    const int32_t status = hole_of(model, &hole);
    if (status < 0) return status;
    if (point == NULL) return DMB_ERR_NULL;
    if (!isfinite(depth)) return DMB_ERR_NOT_FINITE;
    if (fabs(depth) > DMB_POSITION_MAX) return DMB_ERR_VALUE;
    dmb_hole_frame(hole, depth, answer.position, answer.tangent, bend);
    answer.beyond = beyond(&model->wall, depth);
    answer.curvature = dmb_vec3_norm(bend);
    for (int i = 0; i < 3; i++) answer.normal[i] = answer.curvature > 0.0 ? bend[i] / answer.curvature : 0.0;
    answer.dogleg_severity = answer.curvature * 30.0 * 180.0 / DMB_PI;
    direction(&answer);
    answer.diameter = 2.0 * hole->radius;
    return dmb_hole_point_write(point, &answer);
}
