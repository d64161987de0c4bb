/* Points of the hole's axis nearest to a given point: tracked from a known arc, or searched within a range of depths.
 * The distance has a minimum where the point lies in the plane across the axis (eq:hole.foot); a hole that turns back
 * has several. */
#include <float.h>
#include <math.h>
#include <stddef.h>

#include "force/hole.h"
#include "math/elementary.h"
#include "math/vec3.h"

/* [m] Signed distance of x from a station's plane, positive towards greater depth. */
static double beyond(const dmb_hole_station *station, const double x[3])
{
    double u[3];

    dmb_vec3_sub(x, station->point, u);
    return dmb_vec3_dot(u, station->tangent);
}

/* Arc whose end planes enclose x, searched from the hinted one. The last station represents the line beyond it. Both
 * planes of an arc pass through its centre, so that they enclose (bend below pi) the sector of the arc itself. */
static uint32_t find_segment(const dmb_hole *hole, const double x[3], uint32_t hint)
{
    const uint32_t last = hole->stations - 1;
    uint32_t i = hint < last ? hint : last;

    while (i > 0 && beyond(&hole->station[i], x) < 0.0) --i;
    while (i < last && beyond(&hole->station[i + 1], x) >= 0.0) ++i;
    return i;
}

/* Closest point on the arc of a station (eq:hole.project), u = x - p, k its curvature: with c = (1 - k u.n)/rho and a =
 * (u.t)/rho, rho = |(1 - k u.n, k u.t)|, the angle is atan2(k a, c), the point p + a t + k a^2/(1 + c) n and the
 * tangent c t + k a n. No term is lost as k goes to 0. */
static void project_on_arc(const dmb_hole_station *from, const double x[3], double *s, double point[3],
                           double tangent[3])
{
    const double k = from->curvature;
    double u[3];

    dmb_vec3_sub(x, from->point, u);
    const double ahead = dmb_vec3_dot(u, from->tangent);
    const double towards = 1.0 - k * dmb_vec3_dot(u, from->normal);
    const double rho = sqrt(towards * towards + k * ahead * (k * ahead));
    const double a = rho > 0.0 ? ahead / rho : 0.0; /* at the centre of the arc all points are equally near */
    const double c = rho > 0.0 ? towards / rho : 1.0;
    const double sideways = k * a * a / (1.0 + c);

    *s = from->depth + (k != 0.0 ? dmb_atan2(k * a, c) / k : ahead);
    for (int i = 0; i < 3; ++i) {
        point[i] = from->point[i] + a * from->tangent[i] + sideways * from->normal[i];
        tangent[i] = c * from->tangent[i] + k * a * from->normal[i];
    }
}

static void project_on_line(const double origin[3], const double direction[3], const double x[3], double *r,
                            double point[3], double tangent[3])
{
    dmb_line_project(origin, direction, x, r, point);
    dmb_vec3_copy(direction, tangent);
}

/* Moves from the hinted arc to its neighbours, so that a point that moves on keeps its minimum. */
void dmb_hole_project(const dmb_hole *hole, const double x[3], double *s, uint32_t *segment, double point[3],
                      double tangent[3])
{
    if (dmb_hole_is_straight(hole)) {
        *segment = 0;
        project_on_line(hole->origin, hole->direction, x, s, point, tangent);
        return;
    }
    *segment = find_segment(hole, x, *segment);
    const dmb_hole_station *from = &hole->station[*segment];
    if (*segment == hole->stations - 1 || beyond(from, x) < 0.0) {
        project_on_line(from->point, from->tangent, x, s, point, tangent);
        *s += from->depth;
        return;
    }
    project_on_arc(from, x, s, point, tangent);
}

/* ---- Without a known arc ----------------------------------------------------------------------------------------- */

/* 1 if the distance from x has a minimum on that arc, or on the line that replaces it beyond either end. */
static int has_foot(const dmb_hole *hole, const double x[3], uint32_t arc)
{
    const int after_start = arc == 0 || beyond(&hole->station[arc], x) >= 0.0;
    return after_start && (arc + 1 == hole->stations || beyond(&hole->station[arc + 1], x) < 0.0);
}

/* A minimum of the distance. */
typedef struct foot {
    double distance, depth, off; /* [m, m, -] off: deviation from the requested depth or direction, which decides
                                    between two equally near minima */
    uint32_t arc;
} foot;

static foot foot_on(const dmb_hole *hole, const double x[3], uint32_t arc, double middle, const double direction[3])
{
    foot f = {.arc = arc};
    double point[3], tangent[3];
    dmb_hole_project(hole, x, &f.depth, &f.arc, point, tangent);
    dmb_vec3_sub(x, point, point);
    f.distance = dmb_vec3_norm(point);
    f.off = direction != NULL ? -fabs(dmb_vec3_dot(tangent, direction)) : fabs(f.depth - middle);
    return f;
}

/* At a crossing of the hole with itself both minima are equally near: the requested depth or direction decides. */
static int is_better(const foot *a, const foot *b)
{
    if (fabs(a->distance - b->distance) > DMB_HOLE_CROSSING) return a->distance < b->distance;
    return a->off < b->off;
}

uint32_t dmb_hole_search(const dmb_hole *hole, const double x[3], double middle, double reach,
                         const double direction[3], double *depth)
{
    if (dmb_hole_is_straight(hole)) {
        *depth = foot_on(hole, x, 0, middle, direction).depth;
        return 0;
    }
    const uint32_t start = dmb_hole_segment_at(hole, middle);
    foot best = foot_on(hole, x, start, middle, direction);
    if (!(fabs(best.depth - middle) <= reach)) best.distance = DBL_MAX;
    for (uint32_t i = dmb_hole_segment_at(hole, middle - reach); i < hole->stations; i++) {
        if (i > start && hole->station[i].depth > middle + reach) break;
        if (!has_foot(hole, x, i)) continue;
        const foot found = foot_on(hole, x, i, middle, direction);
        if (fabs(found.depth - middle) <= reach && is_better(&found, &best)) best = found;
    }
    *depth = best.depth;
    return best.arc;
}

uint32_t dmb_hole_next_foot(const dmb_hole *hole, const double x[3], uint32_t arc)
{
    const uint32_t count = dmb_hole_is_straight(hole) ? 1 : hole->stations;
    while (arc < count && count > 1 && !has_foot(hole, x, arc)) arc++;
    return arc;
}
