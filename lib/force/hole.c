/* The hole's axis from a survey, frames on it, and the constants of the wall by depth.
 *
 *     quantity                 representation                              equation
 *     ----------------------   -----------------------------------------   ------------------------------------------
 *     axis                     line, or arcs between stations              eq:hole.arc, tangents eq:hole.tangent
 *     frame of the hole        tangent, horizontal y, z = t x y            not defined by the axis where it is vertical
 *     frame without twist      carried from station to station             eq:hole.carried
 *     radius, stiffness, ...   parabolas between depths (pieces)           eq:hole.section
 *     widening by cutters      values at stations, joined as above         eq:hole.cut
 *
 * Within an arc all of them have closed forms; beyond the first and the last station the axis is straight. */
#include "force/hole.h"

#include <math.h>
#include <stddef.h>

#include "math/elementary.h"
#include "math/vec3.h"

#define DMB_BEND_MIN 1e-12      /* [rad] a smaller change of direction counts as straight */
#define DMB_HORIZONTAL_MIN 1e-9 /* [-] horizontal part of the tangent below which the hole counts as vertical */

/* Normalises a. First divides by the largest component, so that no finite length over- or underflows. Returns 0 if the
 * length is 0. */
static int normalise(double a[3])
{
    const double largest = fmax(fabs(a[0]), fmax(fabs(a[1]), fabs(a[2])));

    if (!(largest > 0.0)) return 0;
    dmb_vec3_set(a[0] / largest, a[1] / largest, a[2] / largest, a);
    const double length = dmb_vec3_norm(a);
    dmb_vec3_set(a[0] / length, a[1] / length, a[2] / length, a);
    return 1;
}

static int finite3(const double a[3])
{
    return isfinite(a[0]) && isfinite(a[1]) && isfinite(a[2]);
}

/* ---- Setup ------------------------------------------------------------------------------------------------------- */

int32_t dmb_hole_setup_straight(dmb_hole *hole, const double origin[3], const double direction[3], double radius)
{
    double unit[3];

    if (!finite3(origin) || !finite3(direction) || !isfinite(radius)) return DMB_ERR_NOT_FINITE;
    dmb_vec3_copy(direction, unit);
    if (!normalise(unit)) return DMB_ERR_VALUE;
    hole->station = NULL;
    hole->stations = 0;
    hole->pieces = 0;
    hole->piece = NULL;
    hole->friction = 1.0;
    dmb_vec3_copy(origin, hole->origin);
    dmb_vec3_copy(unit, hole->direction);
    hole->radius = radius;
    return DMB_OK;
}

/* y axis of the hole's frame: horizontal and normal to the tangent; for a vertical hole the world's y axis. */
static void side_of(const double t[3], double y[3])
{
    dmb_vec3_set(0.0 - t[1], t[0], 0.0, y);
    if (dmb_vec3_norm(y) < DMB_HORIZONTAL_MIN) {
        dmb_vec3_set(0.0, 1.0, 0.0, y);
        dmb_vec3_axpy(-t[1], t, y);
    }
    (void)normalise(y);
}

/* eq:hole.tangent, normalised: sines and cosines are rounded. */
static void survey_tangent(const double row[3], double t[3])
{
    double sine, cosine, sine_azimuth, cosine_azimuth;

    dmb_sin_cos(row[1], &sine, &cosine);
    dmb_sin_cos(row[2], &sine_azimuth, &cosine_azimuth);
    t[0] = sine * cosine_azimuth;
    t[1] = 0.0 - sine * sine_azimuth; /* y is west; 0 stays +0 */
    t[2] = -cosine;
    (void)normalise(t);
}

/* Sets the arc of a station from its tangent and the next one's. Returns 0 if the dogleg is above DMB_HOLE_DOGLEG_MAX.
 * The angle is that of atan2(|t0 x t1|, t0 . t1), exact also for small bends; n is towards the centre of the arc. */
static int survey_arc(dmb_hole_station *from, const dmb_hole_station *to)
{
    double axis[3];

    dmb_vec3_cross(from->tangent, to->tangent, axis);
    const double bend = dmb_atan2(dmb_vec3_norm(axis), dmb_vec3_dot(from->tangent, to->tangent));
    if (!(bend <= DMB_HOLE_DOGLEG_MAX)) return 0;
    from->curvature = 0.0;
    dmb_vec3_zero(from->normal);
    if (bend < DMB_BEND_MIN) return 1;
    from->curvature = bend / (to->depth - from->depth);
    dmb_vec3_cross(axis, from->tangent, from->normal);
    return normalise(from->normal);
}

/* x(r) = p + sin(k r)/k t + (1 - cos(k r))/k n (eq:hole.arc) and its two derivatives, at distance r beyond a station, k
 * its curvature. 1 - cos(k r) = 2 sin^2(k r/2) keeps its digits for small bends. */
static void along_arc(const dmb_hole_station *from, double r, double x[3], double t[3], double curvature[3])
{
    const double angle = from->curvature * r;
    double sine, cosine;

    dmb_sin_cos(angle, &sine, &cosine);
    const double half = dmb_sin(0.5 * angle);
    const double forward = from->curvature != 0.0 ? sine / from->curvature : r;
    const double sideways = from->curvature != 0.0 ? 2.0 * half * half / from->curvature : 0.0;

    for (int i = 0; i < 3; ++i) {
        x[i] = from->point[i] + forward * from->tangent[i] + sideways * from->normal[i];
        t[i] = cosine * from->tangent[i] + sine * from->normal[i];
        curvature[i] = from->curvature * (cosine * from->normal[i] - sine * from->tangent[i]);
    }
}

/* If all stations have the same direction, the hole becomes a straight line, which is faster. The origin is moved back
 * to measured depth 0. */
static void straighten(dmb_hole *hole)
{
    for (uint32_t i = 0; i < hole->stations; ++i)
        if (hole->station[i].curvature != 0.0) return;
    dmb_vec3_copy(hole->station->point, hole->origin);
    dmb_vec3_axpy(-hole->station->depth, hole->station->tangent, hole->origin);
    dmb_vec3_copy(hole->station->tangent, hole->direction);
    hole->station = NULL;
    hole->stations = 0;
}

/* Parallel transport of a normal vector to distance r along a station's arc: v = a n + b (t x n) becomes a (cos n - sin
 * t) + b (t x n). */
static void carry(const dmb_hole_station *from, double r, const double across[3], double carried[3])
{
    double sine, cosine;
    const double a = dmb_vec3_dot(across, from->normal);
    dmb_sin_cos(from->curvature * r, &sine, &cosine);
    dmb_vec3_copy(across, carried);
    dmb_vec3_axpy(a * (cosine - 1.0), from->normal, carried);
    dmb_vec3_axpy(-a * sine, from->tangent, carried);
}

/* Transports the normal vector to the next station and makes it orthogonal to the tangent, of length 1, so that
 * rounding does not accumulate. */
static void carry_to(const dmb_hole_station *from, dmb_hole_station *to)
{
    carry(from, to->depth - from->depth, from->carried, to->carried);
    dmb_vec3_axpy(-dmb_vec3_dot(to->carried, to->tangent), to->tangent, to->carried);
    (void)normalise(to->carried);
}

/* The point of a station is the end of the arc before it, so that the axis is continuous to rounding. */
static int64_t place_stations(uint32_t stations, const double *survey, const double origin[3],
                              dmb_hole_station *storage)
{
    double unused_tangent[3], unused_curvature[3];

    for (uint32_t i = 0; i < stations; ++i) {
        const double *row = survey + 3 * (size_t)i;
        dmb_hole_station *station = &storage[i];
        if (!finite3(row) || (i > 0 && !(row[0] > storage[i - 1].depth))) return (int64_t)i;
        station->depth = row[0];
        station->curvature = 0.0;
        dmb_vec3_zero(station->normal);
        survey_tangent(row, station->tangent);
        dmb_vec3_copy(origin, station->point);
        if (i == 0) side_of(station->tangent, station->carried);
        if (i == 0) continue;
        if (!survey_arc(station - 1, station)) return (int64_t)i;
        carry_to(station - 1, station);
        along_arc(station - 1, row[0] - station[-1].depth, station->point, unused_tangent, unused_curvature);
    }
    return -1;
}

int64_t dmb_hole_setup_survey(dmb_hole *hole, uint32_t stations, const double *survey, const double origin[3],
                              double radius, dmb_hole_station *storage)
{
    if (stations < 2 || !finite3(origin) || !isfinite(radius)) return 0;
    const int64_t bad = place_stations(stations, survey, origin, storage);
    if (bad >= 0) return bad;
    hole->station = storage;
    hole->stations = stations;
    hole->pieces = 0;
    hole->piece = NULL;
    hole->friction = 1.0;
    dmb_vec3_copy(storage->point, hole->origin);
    dmb_vec3_copy(storage->tangent, hole->direction);
    hole->radius = radius;
    straighten(hole);
    return -1;
}

/* ---- Place to frame ---------------------------------------------------------------------------------------------- */

static void along_line(const double p[3], const double direction[3], double r, double x[3], double t[3],
                       double curvature[3])
{
    dmb_vec3_copy(p, x);
    dmb_vec3_axpy(r, direction, x);
    dmb_vec3_copy(direction, t);
    dmb_vec3_zero(curvature);
}

uint32_t dmb_hole_segment_at(const dmb_hole *hole, double s)
{
    uint32_t low = 0;
    uint32_t high = hole->stations;

    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (hole->station[middle].depth <= s)
            low = middle;
        else
            high = middle;
    }
    return low;
}

void dmb_hole_frame(const dmb_hole *hole, double s, double x[3], double t[3], double curvature[3])
{
    double own_t[3], own_curvature[3];
    double *tangent = t != NULL ? t : own_t;
    double *bend = curvature != NULL ? curvature : own_curvature;

    if (dmb_hole_is_straight(hole)) {
        along_line(hole->origin, hole->direction, s, x, tangent, bend);
        return;
    }
    const dmb_hole_station *from = &hole->station[dmb_hole_segment_at(hole, s)];
    if (s < from->depth) /* before the first station; the last one's curvature is 0 */
        along_line(from->point, from->tangent, s - from->depth, x, tangent, bend);
    else
        along_arc(from, s - from->depth, x, tangent, bend);
}

static void columns_of(const double t[3], const double y[3], double R[9])
{
    double z[3];
    dmb_vec3_cross(t, y, z);
    for (int i = 0; i < 3; i++) {
        R[3 * i] = t[i];
        R[3 * i + 1] = y[i];
        R[3 * i + 2] = z[i];
    }
}

void dmb_hole_frame_rotation(const dmb_hole *hole, double s, double R[9])
{
    double x[3], t[3], y[3];

    dmb_hole_frame(hole, s, x, t, NULL);
    side_of(t, y);
    columns_of(t, y, R);
}

void dmb_hole_carried_rotation(const dmb_hole *hole, double s, double R[9])
{
    double x[3], t[3], y[3];
    if (dmb_hole_is_straight(hole)) {
        dmb_hole_frame_rotation(hole, s, R);
        return;
    }
    const dmb_hole_station *from = &hole->station[dmb_hole_segment_at(hole, s)];
    dmb_hole_frame(hole, s, x, t, NULL);
    carry(from, fmax(0.0, s - from->depth), from->carried, y);
    columns_of(t, y, R);
}

/* Rotation from the carried frame at one depth to that at another, in world axes. */
void dmb_hole_carry(const dmb_hole *hole, double from, double to, double R[9])
{
    double before[9], after[9];
    dmb_hole_carried_rotation(hole, from, before);
    dmb_hole_carried_rotation(hole, to, after);
    dmb_mat3_mul_nt(after, before, R);
}

/* ---- About the axis ---------------------------------------------------------------------------------------------- */

void dmb_radial(const double x[3], const double axis_point[3], const double tangent[3], const double n_last[3],
                double *e, double n[3])
{
    dmb_radial_at(x, axis_point, tangent, n_last, e, n);
}

void dmb_hole_arc_bend(const dmb_hole *hole, double depth, uint32_t segment, double bend[3])
{
    dmb_vec3_zero(bend);
    if (dmb_hole_is_straight(hole)) return;
    const dmb_hole_station *arc = hole->station + segment;
    if (arc->curvature == 0.0 || depth < arc->depth) return;
    dmb_vec3_cross(arc->tangent, arc->normal, bend);
    dmb_vec3_scale(arc->curvature, bend, bend);
}

/* About t the rate is t . w = z . y' with y = e_z x t, normalised. Across t it is t x k, as of the carried frame. Where
 * the horizontal part of t is below 1e-9, the rate about t is left out. */
void dmb_hole_frame_rate(const double t[3], const double curvature[3], double w[3])
{
    const double across = t[0] * t[0] + t[1] * t[1];
    dmb_vec3_cross(t, curvature, w);
    if (across > 1e-18) dmb_vec3_axpy(t[2] * (t[0] * curvature[1] - t[1] * curvature[0]) / across, t, w);
}

/* ---- Constants of the wall by depth ------------------------------------------------------------------------------ */

const dmb_hole_piece *dmb_hole_piece_at(const dmb_hole *hole, double s)
{
    uint32_t low = 0, high = hole->pieces;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (hole->piece[middle].depth <= s)
            low = middle;
        else
            high = middle;
    }
    return hole->piece + low;
}

/* The least value of each parabola between two depths: at its ends or, if it opens upwards, at its vertex. */
double dmb_hole_least_radius(const dmb_hole *hole, double s0, double s1, double *where)
{
    double least = hole->radius;
    *where = s0;
    if (hole->pieces == 0) return least;
    least = dmb_hole_described_radius(hole, s0);
    const dmb_hole_piece *piece = dmb_hole_piece_at(hole, s0), *end = hole->piece + hole->pieces;
    for (; piece < end; piece++) {
        const double stop = piece + 1 < end ? fmin(s1, piece[1].depth) : s1;
        const double slope = piece->slope[DMB_WALL_RADIUS], bend = piece->bend[DMB_WALL_RADIUS];
        const double bottom = bend > 0.0 ? piece->depth - 0.5 * slope / bend : s0;
        const double at[2] = {stop, fmin(fmax(bottom, fmax(s0, piece->depth)), stop)};
        for (int i = 0; i < 2; i++) {
            const double here = dmb_hole_piece_value(piece, DMB_WALL_RADIUS, at[i]);
            if (!(here < least)) continue;
            least = here;
            *where = at[i];
        }
        if (!(stop < s1)) break;
    }
    return least;
}

/* ---- Widened by cutters ------------------------------------------------------------------------------------------ */

/* Fraction of the distance between two stations, 0 .. 1, to the fraction of the step between their values, with
 * derivatives. Two parabolas joined in the middle (eq:hole.section). */
static void part_of_step(double x, double step[3])
{
    const double y = 1.0 - x;
    step[0] = x < 0.5 ? 2.0 * x * x : 1.0 - 2.0 * y * y;
    step[1] = 4.0 * (x < 0.5 ? x : y);
    step[2] = x < 0.5 ? 4.0 : -4.0;
}

void dmb_hole_widening_at(const dmb_hole *hole, double s, double widening[3])
{
    const double u = (s - hole->cut_start) / hole->cut_spacing;
    double step[3];
    dmb_vec3_zero(widening);
    if (!(u > 0.0 && u < (double)(hole->cuts - 1))) return;
    const uint32_t i = (uint32_t)u;
    const double from = hole->widening[i], by = hole->widening[i + 1] - from;
    part_of_step(u - (double)i, step);
    widening[0] = from + by * step[0];
    widening[1] = by * step[1] / hole->cut_spacing;
    widening[2] = by * step[2] / (hole->cut_spacing * hole->cut_spacing);
}

/* By how much the radius at s grows if station j is widened by 1. */
double dmb_hole_fraction_of_cut(const dmb_hole *hole, uint32_t j, double s)
{
    const double x = 1.0 - fabs((s - hole->cut_start) / hole->cut_spacing - (double)j);
    double step[3];
    if (!(x > 0.0)) return 0.0;
    part_of_step(x, step);
    return step[0];
}

/* Sets mu from the restitution at depth s. */
static void set_restitution(const dmb_hole_piece *piece, double s, dmb_normal_law *law)
{
    if (piece->slope[DMB_WALL_RESTITUTION] == 0.0 && piece->bend[DMB_WALL_RESTITUTION] == 0.0)
        law->mu = piece->factor;
    else
        *law = dmb_normal_law_of(*law, dmb_hole_piece_value(piece, DMB_WALL_RESTITUTION, s));
}

static dmb_normal_law normal_at(const dmb_hole_piece *piece, const dmb_normal_law *law, double s)
{
    dmb_normal_law local = *law;
    local.stiffness = dmb_hole_piece_value(piece, DMB_WALL_STIFFNESS, s);
    local.damping = dmb_hole_piece_value(piece, DMB_WALL_DAMPING, s);
    set_restitution(piece, s, &local);
    return local;
}

static dmb_friction_law friction_at(const dmb_hole_piece *piece, const dmb_friction_law *law, double factor, double s)
{
    dmb_friction_law local = *law;
    local.mu_static = factor * dmb_hole_piece_value(piece, DMB_WALL_MU_STATIC, s);
    local.mu_dynamic = factor * dmb_hole_piece_value(piece, DMB_WALL_MU_DYNAMIC, s);
    return local;
}

void dmb_friction_coefficients_at(const dmb_hole *hole, double s, double *mu_static, double *mu_dynamic)
{
    const dmb_hole_piece *piece = dmb_hole_piece_at(hole, s);
    *mu_static = hole->friction * dmb_hole_piece_value(piece, DMB_WALL_MU_STATIC, s);
    *mu_dynamic = hole->friction * dmb_hole_piece_value(piece, DMB_WALL_MU_DYNAMIC, s);
}

dmb_normal_law dmb_normal_law_at(const dmb_hole *hole, const dmb_normal_law *law, double s)
{
    return hole->pieces == 0 ? *law : normal_at(dmb_hole_piece_at(hole, s), law, s);
}

dmb_friction_law dmb_friction_law_at(const dmb_hole *hole, const dmb_friction_law *law, double s)
{
    return hole->pieces == 0 ? *law : friction_at(dmb_hole_piece_at(hole, s), law, hole->friction, s);
}

static double slope_of(const dmb_hole_piece *piece, int which, double s)
{
    return piece->slope[which] + 2.0 * (s - piece->depth) * piece->bend[which];
}

static void add_widening(const dmb_hole *hole, double s, dmb_local_wall *wall)
{
    double widening[3];
    dmb_hole_widening_at(hole, s, widening);
    wall->radius += widening[0];
    wall->radius_slope += widening[1];
    wall->radius_bend += widening[2];
}

/* With the derivatives by depth that enter eq:hole.section-force and its tangent. */
void dmb_local_wall_at(const dmb_hole *hole, const dmb_normal_law *normal, const dmb_friction_law *friction, double s,
                       double softer, dmb_local_wall *out)
{
    const dmb_hole_piece *piece = dmb_hole_piece_at(hole, s);
    const double of_restitution = slope_of(piece, DMB_WALL_RESTITUTION, s);
    out->normal = normal_at(piece, normal, s);
    out->normal.stiffness /= softer;
    out->friction = friction_at(piece, friction, hole->friction, s);
    out->radius = dmb_hole_piece_value(piece, DMB_WALL_RADIUS, s);
    out->radius_slope = slope_of(piece, DMB_WALL_RADIUS, s);
    out->radius_bend = 2.0 * piece->bend[DMB_WALL_RADIUS];
    if (hole->widening != NULL) add_widening(hole, s, out);
    out->stiffness_slope = slope_of(piece, DMB_WALL_STIFFNESS, s) / softer;
    out->stiffness_bend = 2.0 * piece->bend[DMB_WALL_STIFFNESS] / softer;
    out->damping_slope = slope_of(piece, DMB_WALL_DAMPING, s);
    out->factor_slope = 0.0;
    if (of_restitution != 0.0)
        out->factor_slope = of_restitution *
                            dmb_normal_factor_slope(&out->normal, dmb_hole_piece_value(piece, DMB_WALL_RESTITUTION, s));
    out->mu_static_slope = hole->friction * slope_of(piece, DMB_WALL_MU_STATIC, s);
    out->mu_dynamic_slope = hole->friction * slope_of(piece, DMB_WALL_MU_DYNAMIC, s);
}
