/* The hole's axis: a straight line, or circular arcs through the stations of a survey (minimum curvature method).
 * World frame: z up, so inclination 90 deg and azimuth 0 point along +x. Pure functions; all read-only after setup. */
#ifndef DMB_FORCE_HOLE_H
#define DMB_FORCE_HOLE_H

#include <stdint.h>

#include "drillmbd/model.h"
#include "math/vec3.h"

#define DMB_HOLE_DOGLEG_MAX 2.5 /* [rad] largest change of direction between two stations */

/* A station and the arc that leads from it to the next one. */
typedef struct dmb_hole_station {
    double depth;      /* [m] measured depth */
    double curvature;  /* [rad/m] of the arc, 0 where straight and at the last station */
    double point[3];   /* [m] on the axis, world frame */
    double tangent[3]; /* [-] unit, towards greater depth */
    double normal[3];  /* [-] unit, towards the centre of the arc; 0 where straight */
} dmb_hole_station;

typedef struct dmb_hole_piece dmb_hole_piece; /* force/hole_section.h */

typedef struct dmb_hole {
    const dmb_hole_station *station; /* shape (stations), the caller's; NULL for a straight hole */
    uint32_t stations;               /* [-] 0 for a straight hole */
    uint32_t pieces;                 /* [-] 0: the same wall everywhere */
    double origin[3];                /* [m] where measured depth is 0 on a straight hole, world frame */
    double direction[3];             /* [-] unit, of a straight hole */
    double radius;                   /* [m]; where there are pieces, above them */
    const dmb_hole_piece *piece;     /* shape (pieces), the caller's */
    double friction;                 /* [-] factor on the friction of the pieces; 1 but for inputs */
} dmb_hole;

static inline int32_t dmb_hole_is_straight(const dmb_hole *hole)
{
    return hole->stations == 0;
}

/* Straight hole from origin [m] (depth 0) along direction (any length > 0).
 * Errors: DMB_ERR_NOT_FINITE, DMB_ERR_VALUE (direction of length 0); the hole is untouched then. */
int32_t dmb_hole_setup_straight(dmb_hole *hole, const double origin[3], const double direction[3], double radius);

/* Surveyed hole. survey (stations,3): measured depth [m] strictly increasing, inclination from the downward vertical
 * and azimuth from +x towards +y [rad]. origin [m]: the first station's place. storage: the caller's array of
 * `stations` entries, kept by the hole. A survey without any bend becomes a straight hole.
 * Returns -1, or the index of the first bad station (not finite, depth not increasing, dogleg from the one before
 * above DMB_HOLE_DOGLEG_MAX; 0 for fewer than two stations). Minimum curvature: Taylor, Mason 1972. O(stations). */
int64_t dmb_hole_setup_survey(dmb_hole *hole, uint32_t stations, const double *survey, const double origin[3],
                              double radius, dmb_hole_station *storage);

/* Point x [m], unit tangent t and curvature vector [rad/m] (dt/ds, towards the centre) of the axis at measured depth
 * s [m]. Straight beyond both ends. t and curvature may be NULL. O(log stations). */
void dmb_hole_frame(const dmb_hole *hole, double s, double x[3], double t[3], double curvature[3]);

/* Rotation of the hole's frame at depth s, (3,3) row by row: its columns are the tangent, y = z_world x t (horizontal),
 * and z = t x y; identity for a hole along +x. A hole within 1e-9 rad of the vertical has no horizontal of its own:
 * there y is the world's y axis (what azimuth 0 tends to). */
void dmb_hole_frame_rotation(const dmb_hole *hole, double s, double R[9]);

/* Turning of that frame per metre of depth [rad/m], world axes, from unit tangent t and curvature vector dt/ds:
 * t x dt/ds, and about t what keeps its y axis horizontal. */
void dmb_hole_frame_rate(const double t[3], const double curvature[3], double w[3]);

/* [rad/m] Turning of the tangent per metre of depth without any about itself, world axes: curvature times the binormal,
 * which is one vector all along an arc; 0 where the axis is straight. depth and segment as dmb_hole_project gives
 * them. */
void dmb_hole_arc_bend(const dmb_hole *hole, double depth, uint32_t segment, double bend[3]);

/* Closest point of the axis to x: its measured depth *s, point and unit tangent. *segment is the arc tried first, in
 * any range, and comes back as the arc found (0 for a straight hole); *s is written only. Closed form on lines and
 * arcs, so exact to round-off. The arc is the one whose end planes enclose x: continuous from arc to arc, and the same
 * whatever the hint as long as x is nearer to the axis than its radius of curvature and the axis turns by less than 90
 * deg between hint and answer. O(1) with a good hint. */
void dmb_hole_project(const dmb_hole *hole, const double x[3], double *s, uint32_t *segment, double point[3],
                      double tangent[3]);

/* Radial offset of x from the axis: u = x - axis_point without its part along tangent, *e = |u| [m], n = u/e.
 * Below e = 1e-12 m (concentric) there is no direction and n is n_last, the last one known; n may be n_last. */
void dmb_radial(const double x[3], const double axis_point[3], const double tangent[3], const double n_last[3],
                double *e, double n[3]);

/* Distance from a straight axis, in a number that is a double or lanes of doubles (math/real.h). */

#define DMB_HOLE_CONCENTRIC 1e-12 /* [m] */

/* Closest point to x [m] of the line through origin along the unit direction, *s [m] from its origin. */
static inline void dmb_line_project(const double origin[3], const double direction[3], const dmb_real x[3], dmb_real *s,
                                    dmb_real point[3])
{
    const dmb_real r =
        (x[0] - origin[0]) * direction[0] + (x[1] - origin[1]) * direction[1] + (x[2] - origin[2]) * direction[2];
    for (int i = 0; i < 3; i++) point[i] = origin[i] + r * direction[i];
    *s = r;
}

/* As dmb_radial. */
static inline void dmb_radial_at(const dmb_real x[3], const dmb_real axis_point[3], const dmb_real tangent[3],
                                 const dmb_real n_last[3], dmb_real *e, dmb_real n[3])
{
    dmb_real u[3];
    dmb_vec3_sub(x, axis_point, u);
    dmb_vec3_axpy(-dmb_vec3_dot(u, tangent), tangent, u);
    *e = dmb_real_sqrt(dmb_vec3_dot(u, u));
    const dmb_mask concentric = dmb_mask_less(*e, dmb_real_of(DMB_HOLE_CONCENTRIC));
    const dmb_real divisor = dmb_real_select(concentric, dmb_real_of(1.0), *e);
    for (int i = 0; i < 3; i++) n[i] = dmb_real_select(concentric, n_last[i], u[i] / divisor);
}

#endif
