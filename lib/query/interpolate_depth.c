#include "query/interpolation.h"
#include "system/node.h"

double dmb_spot_turn(const dmb_configuration *configuration, const dmb_spot *spot)
{
    const double *turn = configuration->turn + spot->node;
    if (spot->fixed) return turn[0];
    return turn[0] + spot->fraction * (turn[1] - turn[0]);
}

/* Arc of the hole in which a measured depth lies: where to start looking. */
static uint32_t segment_at(const dmb_hole *hole, double depth)
{
    uint32_t low = 0, high = hole->stations;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (hole->station[middle].depth <= depth)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* A PATH node knows its depth exactly; elsewhere the axis is searched from where the node is about. */
double dmb_spot_depth(const dmb_scene *scene, const dmb_configuration *configuration, const dmb_spot *spot,
                      const double x[3])
{
    double depth, point[3], tangent[3];
    uint32_t segment = 0;
    if (!scene->has_hole) return 0.0;
    if (spot->fixed && spot->arm == 0.0 && scene->layout.size[spot->node] == DMB_NODE_PATH)
        return dmb_path_depth(scene, configuration, spot->node);
    if (!dmb_hole_is_straight(&scene->hole))
        segment = segment_at(&scene->hole, scene->reference_depth[spot->node] + spot->arm +
                                               configuration->displacement[3 * (size_t)spot->node]);
    dmb_hole_project(&scene->hole, x, &depth, &segment, point, tangent);
    return depth;
}
