/* The axis of the hole. */
#include "model/mesh.h"

static int32_t refuse_station(dmb_message *message, const dmb_wall_def *wall, uint32_t station)
{
    const double *row = wall->survey + 3 * (size_t)station;
    dmb_message_set(
        message,
        "wall: station %u at measured depth %g m, inclination %g and azimuth %g rad, must turn by <= %g rad "
        "from the station before",
        station, row[0], row[1], row[2], DMB_HOLE_DOGLEG_MAX);
    return DMB_ERR_GEOMETRY;
}

int32_t dmb_mesh_hole(dmb_mesh *mesh)
{
    const dmb_wall_def *wall = &mesh->model->wall;
    const double radius = 0.5 * wall->diameter;
    if (mesh->model->wall_count == 0) return DMB_OK;
    mesh->has_hole = 1;
    if (wall->survey_count == 0) return dmb_hole_setup_straight(&mesh->hole, wall->origin, wall->direction, radius);
    const int32_t status = dmb_vector_append(&mesh->stations, &mesh->model->allocator, NULL, wall->survey_count);
    if (status < 0) return status;
    const int64_t bad = dmb_hole_setup_survey(&mesh->hole, wall->survey_count, wall->survey, wall->origin, radius,
                                              mesh->stations.items);
    return bad < 0 ? DMB_OK : refuse_station(&mesh->model->message, wall, (uint32_t)bad);
}
