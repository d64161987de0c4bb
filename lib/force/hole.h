/* The hole's axis: a straight line, or circular arcs through the stations of a survey (minimum curvature method).
 * World frame: x north, y west, z up (right-handed): inclination 90 deg and azimuth 0 point along +x, azimuth 90 deg
 * (east) along -y. Pure functions; all read-only after setup. */
#ifndef DMB_FORCE_HOLE_H
#define DMB_FORCE_HOLE_H

#include <stdint.h>

#include "drillmbd/scene.h"
#include "force/friction_law.h"
#include "force/normal_law.h"
#include "math/vec3.h"

#define DMB_HOLE_DOGLEG_MAX 2.5 /* [rad] largest change of direction between two stations */

/* A station and the arc from it to the next one. */
typedef struct dmb_hole_station {
    double depth;      /* [m] measured depth */
    double curvature;  /* [rad/m] of the arc, 0 where straight and at the last station */
    double point[3];   /* [m] on the axis, world frame */
    double tangent[3]; /* [-] unit, towards greater depth */
    double normal[3];  /* [-] unit, towards the centre of the arc; 0 where straight */
    double carried[3]; /* [-] unit, normal to the axis: y axis of the frame that is transported along the axis without
                          twist */
} dmb_hole_station;

typedef struct dmb_hole_piece dmb_hole_piece; /* below */

typedef struct dmb_hole {
    const dmb_hole_station *station; /* shape (stations), owned by the caller; NULL for a straight hole */
    uint32_t stations;               /* [-] 0 for a straight hole */
    uint32_t pieces;                 /* [-] 0: constant wall properties */
    double origin[3];                /* [m] point of measured depth 0 of a straight hole, world frame */
    double direction[3];             /* [-] unit, of a straight hole */
    double radius;                   /* [m]; with pieces: that of the first piece */
    const dmb_hole_piece *piece;     /* shape (pieces), owned by the caller */
    double friction;                 /* [-] factor on the friction of the pieces; 1 unless an input changes it */
    const double *widening; /* [m] by cutters, at their stations, owned by a sim; NULL: no widening; shape (cuts) */
    uint32_t cuts;          /* [-] stations at which cutters widen the hole, 0: none; requires pieces */
    uint32_t reserved;
    double cut_start, cut_spacing; /* [m] measured depth of the first one, and their spacing */
} dmb_hole;

static inline int32_t dmb_hole_is_straight(const dmb_hole *hole)
{
    return hole->stations == 0;
}

/* Straight hole from origin [m] (depth 0) along direction (any length > 0).
 * Errors: DMB_ERR_NOT_FINITE, DMB_ERR_VALUE (direction of length 0); the hole is unchanged after an error. */
int32_t dmb_hole_setup_straight(dmb_hole *hole, const double origin[3], const double direction[3], double radius);

/* Surveyed hole. survey (stations,3): measured depth [m] strictly increasing, inclination from the downward vertical
 * and azimuth clockwise seen from above, from +x (north) towards -y (east) [rad]. origin [m]: position of the first
 * station. storage: the caller's array of `stations` entries, which the hole refers to. A survey without a bend becomes
 * a straight hole. Returns -1, or the index of the first bad station (not finite, depth not increasing, dogleg from the
 * previous station above DMB_HOLE_DOGLEG_MAX; 0 for fewer than two stations). Minimum curvature: eq:hole.arc.
 * O(stations). */
int64_t dmb_hole_setup_survey(dmb_hole *hole, uint32_t stations, const double *survey, const double origin[3],
                              double radius, dmb_hole_station *storage);

/* Point x [m], unit tangent t and curvature vector [rad/m] (dt/ds, towards the centre) of the axis at measured depth
 * s [m]. Straight beyond both ends. t and curvature may be NULL. O(log stations). */
void dmb_hole_frame(const dmb_hole *hole, double s, double x[3], double t[3], double curvature[3]);

/* Rotation of the hole's frame at depth s, (3,3) row by row: its columns are the tangent, y = z_world x t (horizontal),
 * and z = t x y; identity for a hole along +x. A hole within 1e-9 rad of the vertical has no horizontal direction: y is
 * then the world's y axis (the limit of azimuth 0). */
void dmb_hole_frame_rotation(const dmb_hole *hole, double s, double R[9]);

/* Rotation of the frame that is transported along the axis without twist, (3,3) row by row: its x axis is the tangent.
 * It is the hole's frame at the first station (a straight hole: everywhere). From there it turns by t x dt/ds per
 * metre, also through the vertical (eq:hole.carried). Exact along arcs. O(log stations). */
void dmb_hole_carried_rotation(const dmb_hole *hole, double s, double R[9]);

/* Rotation (3,3), in world axes, that transports a frame along the axis from depth `from` to depth `to` without twist.
 */
void dmb_hole_carry(const dmb_hole *hole, double from, double to, double R[9]);

/* Rotation rate of the hole's frame per metre of depth [rad/m], world axes, from unit tangent t and curvature vector
 * dt/ds: t x dt/ds, and the rate about t that keeps the y axis horizontal. */
void dmb_hole_frame_rate(const double t[3], const double curvature[3], double w[3]);

/* Rotation rate of the tangent per metre of depth [rad/m], without twist, world axes: curvature times the binormal,
 * which is constant along an arc; 0 where the axis is straight. depth and segment as returned by dmb_hole_project. */
void dmb_hole_arc_bend(const dmb_hole *hole, double depth, uint32_t segment, double bend[3]);

/* Index of the arc at measured depth s: that of the last station at or before s, or 0 before the first station and for
 * a straight hole. O(log stations). */
uint32_t dmb_hole_segment_at(const dmb_hole *hole, double s);

/* Computes the closest point of the axis to x near a known depth: its measured depth *s, point [m] and unit tangent.
 * *segment is the arc at which the search starts (any value is permitted), and returns the arc found (0 for a straight
 * hole); *s is output only. Closed form on lines and arcs, therefore exact to round-off. From the start the search
 * descends to the first minimum of the distance: an axis may have several, where it turns by more than 90 deg or
 * crosses itself, so the start must be the arc of a measured depth known to be near x (dmb_hole_segment_at, or the arc
 * found before). Continuous from arc to arc while x is nearer to the axis than its radius of curvature. O(1) with a
 * good start. */
void dmb_hole_project(const dmb_hole *hole, const double x[3], double *s, uint32_t *segment, double point[3],
                      double tangent[3]);

#define DMB_HOLE_CROSSING 1e-6 /* [m] two minima whose distances differ by less count as a crossing of the axis */

/* Depth of the point of the axis nearest to x, among the minima of the distance with measured depths within `reach` [m]
 * of `middle`. If there is none, the minimum that the descent from `middle` reaches. reach = INFINITY: the whole axis.
 * Of two minima at a crossing it is the one whose tangent is parallel to `direction` (unit, world; NULL: the one nearer
 * to `middle`). Returns the arc, *depth is the measured depth. O(stations within reach). */
uint32_t dmb_hole_search(const dmb_hole *hole, const double x[3], double middle, double reach,
                         const double direction[3], double *depth);

/* First arc, from `arc` on, with a minimum of the distance from x. Returns the number of stations (1 for a straight
 * hole) or more if no further arc has one. */
uint32_t dmb_hole_next_foot(const dmb_hole *hole, const double x[3], uint32_t arc);

/* Radial offset of x from the axis (eq:contact.frame): u = x - axis_point without its component along tangent, *e = |u|
 * [m], n = u/e. Below e = 1e-12 m (concentric) the direction is undefined and n is n_last, the last direction; n may be
 * n_last. */
void dmb_radial(const double x[3], const double axis_point[3], const double tangent[3], const double n_last[3],
                double *e, double n[3]);

/* Distance from a straight axis, for numbers that are doubles or lanes of doubles (math/real.h). */

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

/* See dmb_radial. */
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

/* ---- Constants of the wall by depth ------------------------------------------------------------------------------ */

/* Wall properties by measured depth: parabolic pieces, joined with a continuous slope.
 *
 * A contact ring of radius r at distance e from the axis and depth s has the penetration d = e - (R(s) - r), and the
 * wall stores
 *     U = l K(s) d^(n+1)/(n+1)                                  (eq:hole.section-force).
 * With rho = R'(s) ds/dx, ds/dx = J t, J = 1/(1 - e n.k) on an axis of curvature vector k, the penetration changes by
 *     dd = g . dx,   g = n - rho t,
 * so that the wall's force, including damping, acts along -g. Where K changes, the force -J l K' d^(n+1)/(n+1) along t
 * is added: together exactly the derivative of U. Friction acts along and around the axis and depends on N. The
 * contribution of the wall's slope to it is of second order in R' and is neglected, as is the moment of the axial part
 * about the ring's centre. */

/* [-] Largest permitted |dR/ds|. */
#define DMB_HOLE_SLOPE_MAX 1.0

enum {
    DMB_WALL_RADIUS,
    DMB_WALL_STIFFNESS,
    DMB_WALL_RESTITUTION,
    DMB_WALL_DAMPING,
    DMB_WALL_MU_STATIC,
    DMB_WALL_MU_DYNAMIC,
    DMB_WALL_STRENGTH,
    DMB_WALL_COUNT
};

/* value + r (slope + r bend), r [m] beyond depth */
struct dmb_hole_piece {
    double depth; /* [m] where it begins; the first piece also holds above its depth */
    double value[DMB_WALL_COUNT], slope[DMB_WALL_COUNT], bend[DMB_WALL_COUNT];
    double factor; /* [-] mu of the normal law from the restitution, if that is constant */
};

/* Piece at depth s of a hole with pieces. O(log pieces). */
const dmb_hole_piece *dmb_hole_piece_at(const dmb_hole *hole, double s);

static inline double dmb_hole_piece_value(const dmb_hole_piece *piece, int which, double s)
{
    const double r = s - piece->depth;
    return piece->value[which] + r * (piece->slope[which] + r * piece->bend[which]);
}

/* Cutters widen a hole by values at equally spaced stations. Between two stations the widening changes by two
 * parabolas, as around a section. It is 0 beyond both ends. */

/* [m] radius of the hole as described, without widening */
static inline double dmb_hole_described_radius(const dmb_hole *hole, double s)
{
    return hole->pieces == 0 ? hole->radius : dmb_hole_piece_value(dmb_hole_piece_at(hole, s), DMB_WALL_RADIUS, s);
}
/* [m, -, 1/m] widening at a depth and its derivatives by depth. O(1). */
void dmb_hole_widening_at(const dmb_hole *hole, double s, double widening[3]);
/* [-] Weight of the value at station j in the widening at depth s: widening = sum of weights times values. */
double dmb_hole_fraction_of_cut(const dmb_hole *hole, uint32_t j, double s);

static inline double dmb_hole_cut_depth(const dmb_hole *hole, uint32_t j)
{
    return hole->cut_start + j * hole->cut_spacing;
}
/* [m] radius of the hole, widening included */
static inline double dmb_hole_radius(const dmb_hole *hole, double s)
{
    double widening[3];
    if (hole->widening == NULL) return dmb_hole_described_radius(hole, s);
    dmb_hole_widening_at(hole, s, widening);
    return dmb_hole_described_radius(hole, s) + widening[0];
}
/* [m] Smallest described radius between two depths, and its depth *where. O(pieces between). */
double dmb_hole_least_radius(const dmb_hole *hole, double s0, double s1, double *where);

/* Laws at a depth: those of the whole hole with the constants of that depth. Without pieces they are returned
 * unchanged. */
dmb_normal_law dmb_normal_law_at(const dmb_hole *hole, const dmb_normal_law *law, double s);
dmb_friction_law dmb_friction_law_at(const dmb_hole *hole, const dmb_friction_law *law, double s);
/* Its coefficients at a depth of a hole with pieces. */
void dmb_friction_coefficients_at(const dmb_hole *hole, double s, double *mu_static, double *mu_dynamic);

/* Wall properties at a depth, with derivatives by depth. */
typedef struct dmb_local_wall {
    dmb_normal_law normal;
    dmb_friction_law friction;
    double radius, radius_slope, radius_bend; /* [m, -, 1/m] */
    double stiffness_slope, stiffness_bend;   /* of normal.stiffness, per m, per m2 */
    double factor_slope, damping_slope;       /* of normal.mu and normal.damping, per m */
    double mu_static_slope, mu_dynamic_slope; /* [1/m] */
} dmb_local_wall;

/* J [-]: displacement along an axis of curvature vector k [1/m] per unit of displacement of a ring at distance e on the
 * side n. */
static inline dmb_real dmb_hole_advance(dmb_real e, const dmb_real n[3], const dmb_real k[3])
{
    return 1.0 / (1.0 - e * (n[0] * k[0] + n[1] * k[1] + n[2] * k[2]));
}
/* [m^(n+1)] d^(n+1)/(n+1): energy stored per metre of wall and unit of K */
static inline dmb_real dmb_wall_unit_energy(const dmb_normal_law *law, dmb_real d)
{
    return dmb_normal_reduced_power(law->exponent, d) * d * d / (law->exponent + 1.0);
}

/* Computes the wall properties at depth s of a hole with pieces. softer [-]: divisor of the stiffness. */
void dmb_local_wall_at(const dmb_hole *hole, const dmb_normal_law *normal, const dmb_friction_law *friction, double s,
                       double softer, dmb_local_wall *out);

/* A ring against a wall whose constants change along the hole: what that adds to the force and the tangent of
 * force/contact_law.h. Equations above; in body axes, in a number that is a double or lanes of doubles (math/real.h).
 */

#include "force/contact_law.h"

typedef struct dmb_section_contact {
    dmb_local_normal normal; /* laws there */
    dmb_local_friction friction;
    dmb_real radius, radius_slope, radius_bend; /* derivatives by depth as in dmb_local_wall */
    dmb_real stiffness_slope, stiffness_bend, factor_slope, damping_slope;
    dmb_real mu_static_slope, mu_dynamic_slope;
    dmb_real curvature[3]; /* [1/m] k of the axis, body axes; 0 of a straight hole */
    dmb_real advance, rho; /* [-] J, R' J */
    dmb_real stored;       /* [N] l K' d^(n+1)/(n+1): dU/ds without the contribution of R' */
    dmb_real stored_slope; /* [N/m] its derivatives by s and d: */
    dmb_real stored_by_depth;
    dmb_real along;       /* [N] N rho - J dU/ds along t */
    dmb_real by_place[3]; /* [N/m] dF_k/ds of (-N, F_t, F_b) at constant d and rate of d */
} dmb_section_contact;

/* The wall of one lane; laws have all but the constants of the place. */
static inline void dmb_section_set_wall(const dmb_local_wall *wall, int lane, dmb_section_contact *c)
{
    dmb_real_set_lane(&c->normal.stiffness, lane, wall->normal.stiffness);
    dmb_real_set_lane(&c->normal.damping, lane, wall->normal.damping);
    dmb_real_set_lane(&c->normal.mu, lane, wall->normal.mu);
    dmb_real_set_lane(&c->friction.mu_static, lane, wall->friction.mu_static);
    dmb_real_set_lane(&c->friction.mu_dynamic, lane, wall->friction.mu_dynamic);
    dmb_real_set_lane(&c->radius, lane, wall->radius);
    dmb_real_set_lane(&c->radius_slope, lane, wall->radius_slope);
    dmb_real_set_lane(&c->radius_bend, lane, wall->radius_bend);
    dmb_real_set_lane(&c->stiffness_slope, lane, wall->stiffness_slope);
    dmb_real_set_lane(&c->stiffness_bend, lane, wall->stiffness_bend);
    dmb_real_set_lane(&c->factor_slope, lane, wall->factor_slope);
    dmb_real_set_lane(&c->damping_slope, lane, wall->damping_slope);
    dmb_real_set_lane(&c->mu_static_slope, lane, wall->mu_static_slope);
    dmb_real_set_lane(&c->mu_dynamic_slope, lane, wall->mu_dynamic_slope);
}

/* Computes J and rho of the ring; wall and curvature must be set. */
static inline void dmb_section_contact_at(const dmb_contact_frame *f, dmb_section_contact *c)
{
    c->advance = dmb_hole_advance(f->distance, f->n, c->curvature);
    c->rho = c->radius_slope * c->advance;
}

/* [N/m2] dN/ds per metre of pipe at penetration d with rate `rate`. */
static inline dmb_real dmb_section_normal_slope(const dmb_section_contact *c, dmb_real d, dmb_real rate,
                                                dmb_real impact_speed)
{
    const dmb_normal_law *law = c->normal.law;
    const dmb_real power = dmb_normal_reduced_power(law->exponent, d) * d, one = dmb_real_of(1.0);
    dmb_real slope;
    if (law->kind == DMB_NORMAL_NONE) return dmb_real_of(0.0);
    if (law->kind == DMB_NORMAL_KELVIN_VOIGT || law->kind == DMB_NORMAL_IMPACT)
        return c->stiffness_slope * power + c->damping_slope * dmb_normal_damping(law, one, d, &slope) * rate;
    const dmb_real ratio = rate / dmb_real_max(impact_speed, dmb_real_of(law->impact_floor));
    return power * (c->stiffness_slope * (1.0 + c->normal.mu * ratio) + c->normal.stiffness * c->factor_slope * ratio);
}

/* The same of the mean force over a step of length h from the depth `before`, which is linear in K, mu and c. */
static inline dmb_real dmb_section_mean_slope(const dmb_section_contact *c, dmb_real before, dmb_real d,
                                              dmb_real impact_speed, dmb_mask plastic, double h)
{
    const dmb_local_normal slopes = {c->normal.law, c->stiffness_slope, c->damping_slope, c->normal.mu};
    const dmb_real factor = dmb_normal_factor(&c->normal, impact_speed);
    const dmb_real floored = dmb_real_max(impact_speed, dmb_real_of(c->normal.law->impact_floor));
    dmb_normal_parts p, by_place;
    if (c->normal.law->kind == DMB_NORMAL_NONE) return dmb_real_of(0.0);
    dmb_normal_parts_of(&c->normal, before, d, factor, plastic, h, &p);
    dmb_normal_parts_of(&slopes, before, d, factor, plastic, h, &by_place);
    return by_place.elastic + by_place.damper + c->factor_slope / floored * p.rise / h;
}

/* Derivatives of F_t and F_b by depth through the friction coefficients: smooth laws are linear in them; bristles
 * (memory) are mu N at their limit. */
static inline void dmb_section_friction_slope(const dmb_contact_frame *f, const dmb_contact_force *force, int memory,
                                              const dmb_section_contact *c, dmb_real by_place[2])
{
    const dmb_real zero = dmb_real_of(0.0), mu = c->friction.mu_dynamic;
    const dmb_real N = -force->F[0], limit = N * mu, F = dmb_friction_norm(force->F[1], force->F[2]);
    if (dmb_friction_is_called(c->friction.law)) { /* which may leave the coefficients aside */
        by_place[0] = by_place[1] = zero;
        return;
    }
    if (memory) {
        const dmb_mask slides = dmb_mask_less(zero, limit) & dmb_mask_at_most((1.0 - 1e-9) * limit, F);
        const dmb_real divisor = dmb_real_select(slides, mu, dmb_real_of(1.0));
        for (int k = 0; k < 2; k++)
            by_place[k] = dmb_real_select(slides, force->F[1 + k] / divisor * c->mu_dynamic_slope, zero);
        return;
    }
    const dmb_local_friction slopes = {c->mu_static_slope, c->mu_dynamic_slope, c->friction.law, NULL};
    dmb_real by_normal[2];
    dmb_friction_smooth_at(&slopes, N, f->speed + 1, by_place, NULL, by_normal);
}

/* Of a ring that touches. */
typedef struct dmb_section_site {
    dmb_real length;          /* [m] of wall that it represents */
    dmb_real penetration;     /* [m] d */
    dmb_real normal_slope;    /* [N/m2] dN/ds per metre of pipe where N is not 0 */
    int32_t friction, memory; /* 1: friction acts; by bristles */
} dmb_section_site;

static inline void dmb_section_force(const dmb_contact_frame *f, const dmb_contact_force *force,
                                     const dmb_section_site *ring, dmb_section_contact *c)
{
    const dmb_normal_law *law = c->normal.law;
    const dmb_real zero = dmb_real_of(0.0), d = ring->penetration, length = ring->length;
    const dmb_real unit = length * dmb_wall_unit_energy(law, d);
    const dmb_mask pushes = dmb_mask_less(force->F[0], zero);
    const dmb_real divisor = dmb_real_select(pushes, force->F[0], dmb_real_of(1.0));
    dmb_real by_friction[2] = {zero, zero};
    c->stored = c->stiffness_slope * unit;
    c->stored_slope = c->stiffness_bend * unit;
    c->stored_by_depth = length * c->stiffness_slope * dmb_normal_reduced_power(law->exponent, d) * d;
    c->along = -force->F[0] * c->rho - c->advance * c->stored;
    c->by_place[0] = dmb_real_select(pushes, -length * ring->normal_slope, zero);
    if (ring->friction) dmb_section_friction_slope(f, force, ring->memory, c, by_friction);
    for (int k = 0; k < 2; k++) {
        const dmb_real by_normal = dmb_real_select(pushes, -force->F[1 + k] / divisor, zero); /* dF/dN = F/N */
        c->by_place[1 + k] = by_friction[k] - by_normal * c->by_place[0];
    }
}

/* Derivative by the pose of the part -rho t . V of the penetration rate; the part n . V is in dmb_section_normal_row.
 */
static inline void dmb_section_rate_row(const dmb_contact_frame *f, const dmb_section_contact *c, const dmb_real *bend,
                                        dmb_real row[6])
{
    const dmb_real along = dmb_vec3_dot(f->t, f->V), J = c->advance;
    dmb_real a[3], by_place = -c->radius_bend * J * along;
    dmb_vec3_cross(f->V, f->t, row + 3);
    dmb_vec3_scale(-c->rho, row + 3, row + 3);
    if (bend != NULL) {
        dmb_vec3_cross(f->t, f->V, a);
        by_place = by_place - c->rho * dmb_vec3_dot(bend, a);
    }
    dmb_vec3_scale(by_place * J, f->t, row);
    dmb_vec3_axpy(-c->radius_slope * along * J * J, c->curvature, row);
}

/* Derivative of n . V by the pose: rotation of the body, rotation around the axis, bend of the hole. */
static inline void dmb_section_normal_row(const dmb_contact_frame *f, const dmb_section_contact *c,
                                          const dmb_real bend[3], dmb_real row[6])
{
    dmb_real a[3];
    dmb_vec3_zero(row);
    dmb_vec3_cross(f->V, f->n, row + 3);
    const dmb_mask swings = dmb_mask_less(dmb_real_of(DMB_CONTACT_PINNED), f->distance);
    const dmb_real one = dmb_real_of(1.0), by = dmb_vec3_dot(f->b, f->V) / dmb_real_select(swings, f->distance, one);
    dmb_vec3_axpy(dmb_real_select(swings, by, dmb_real_of(0.0)), f->b, row);
    if (bend == NULL) return;
    dmb_vec3_cross(f->n, f->V, a);
    dmb_vec3_axpy(c->advance * dmb_vec3_dot(bend, a), f->t, row);
}

/* Adds to K the derivative of the force along t: its change with N, with rho and with the stored energy. */
static inline void dmb_section_add_along(const dmb_contact_frame *f, const dmb_contact_force *force,
                                         const dmb_section_contact *c, const dmb_real dF[6], dmb_real K[36])
{
    const dmb_real zero = dmb_real_of(0.0), none[3] = {zero, zero, zero};
    const dmb_real J = c->advance, N = -force->F[0];
    dmb_real row[6];
    for (int i = 0; i < 6; i++) row[i] = -c->rho * dF[i];
    dmb_vec3_axpy(J * J * (N * c->radius_bend - c->stored_slope) + J * c->stored_by_depth * c->rho, f->t, row);
    dmb_vec3_axpy(-J * c->stored_by_depth, f->n, row);
    dmb_vec3_axpy(J * J * (N * c->radius_slope - c->stored), c->curvature, row);
    dmb_contact_add_direction(f->t, none, row, K);
}

/* bend: NULL of a straight hole. K of dmb_contact_pose_tangent, made with the whole wrench, becomes that of the wall of
 * sections. */
static inline void dmb_section_pose_tangent(const dmb_contact_frame *f, const dmb_contact_force *force,
                                            const dmb_section_contact *c, const dmb_real *bend, int friction,
                                            dmb_real K[36])
{
    const dmb_real zero = dmb_real_of(0.0), none[3] = {zero, zero, zero};
    const dmb_real *direction[3] = {f->n, f->t, f->b}, *turn[3] = {none, f->turn_t, f->turn_b};
    dmb_real rate[6], normal[6], more[6], dF[6];
    dmb_section_rate_row(f, c, bend, rate);
    dmb_section_normal_row(f, c, bend, normal);
    for (int k = 0; k < (friction ? 3 : 1); k++) {
        const dmb_real by_rate = k == 0 ? force->normal_rate : force->by_speed[k - 1][0];
        for (int i = 0; i < 6; i++) more[i] = by_rate * rate[i];
        dmb_vec3_axpy(c->by_place[k] * c->advance - force->by_depth[k] * c->rho, f->t, more);
        if (k == 0)
            for (int i = 0; i < 6; i++) dF[i] = more[i] + by_rate * normal[i];
        dmb_contact_add_direction(direction[k], turn[k], more, K);
    }
    dmb_vec3_axpy(force->by_depth[0], f->n, dF);
    dmb_section_add_along(f, force, c, dF, K);
}

/* Changes K of dmb_contact_velocity_tangent in the same way: g replaces n. */
static inline void dmb_section_velocity_tangent(const dmb_contact_frame *f, const dmb_contact_force *force,
                                                const dmb_section_contact *c, double factor, int friction,
                                                dmb_real K[36])
{
    const dmb_real zero = dmb_real_of(0.0), none[3] = {zero, zero, zero};
    dmb_real row[6] = {zero, zero, zero, zero, zero, zero}, a[3];
    dmb_vec3_scale(-factor * c->rho, f->t, row);
    dmb_vec3_scale(force->normal_rate, f->n, a);
    dmb_contact_add_direction(a, none, row, K); /* n (g - n)^T */
    for (int k = 0; friction && k < 2; k++) {
        dmb_real forward[3], around[3];
        dmb_vec3_scale(force->by_speed[k][0], k == 0 ? f->t : f->b, forward);
        dmb_vec3_scale(force->by_speed[k][0], k == 0 ? f->turn_t : f->turn_b, around);
        dmb_contact_add_direction(forward, around, row, K);
    }
    for (int i = 0; i < 3; i++) row[i] += factor * f->n[i]; /* (g - n) g^T */
    dmb_vec3_scale(-c->rho * force->normal_rate, f->t, a);
    dmb_contact_add_direction(a, none, row, K);
}

#endif
