/* The wall's constants by measured depth: pieces of parabolas, joined without a kink.
 *
 * A ring of radius r at distance e from the axis and depth s goes d = e - (R(s) - r) into the wall, which stores
 *     U = l K(s) d^(n+1)/(n+1).
 * With rho = R'(s) ds/dx, ds/dx = J t, J = 1/(1 - e n.k) on an axis of curvature vector k, the way in grows by
 *     dd = g . dx,   g = n - rho t,
 * so the force of the wall acts along -g, also the damped part, and where K changes there is -J l K' d^(n+1)/(n+1)
 * along t beside: exactly the derivative of U. Friction acts along and around the axis by N; what the slope of the wall
 * adds to it is of second order in R' and left out, and so is the moment of the axial part about the ring's centre. */
#ifndef DMB_FORCE_HOLE_SECTION_H
#define DMB_FORCE_HOLE_SECTION_H

#include "force/friction_law.h"
#include "force/hole.h"
#include "force/normal_law.h"

/* [-] Steepest change of the radius. */
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
    double depth; /* [m] where it begins; the first one holds above it too */
    double value[DMB_WALL_COUNT], slope[DMB_WALL_COUNT], bend[DMB_WALL_COUNT];
    double factor; /* [-] mu of the normal law by its restitution, where that does not change */
};

/* Piece at a depth, of a hole with pieces. O(log pieces). */
const dmb_hole_piece *dmb_hole_piece_at(const dmb_hole *hole, double s);

static inline double dmb_hole_piece_value(const dmb_hole_piece *piece, int which, double s)
{
    const double r = s - piece->depth;
    return piece->value[which] + r * (piece->slope[which] + r * piece->bend[which]);
}

/* [m] */
static inline double dmb_hole_radius(const dmb_hole *hole, double s)
{
    return hole->pieces == 0 ? hole->radius : dmb_hole_piece_value(dmb_hole_piece_at(hole, s), DMB_WALL_RADIUS, s);
}
/* [m] Smallest radius between two depths, and where. O(pieces between). */
double dmb_hole_least_radius(const dmb_hole *hole, double s0, double s1, double *where);

/* Laws at a depth: those of the whole hole with the constants there. The same without pieces. */
dmb_normal_law dmb_normal_law_at(const dmb_hole *hole, const dmb_normal_law *law, double s);
dmb_friction_law dmb_friction_law_at(const dmb_hole *hole, const dmb_friction_law *law, double s);

/* The wall at a place, with derivatives by depth. */
typedef struct dmb_local_wall {
    dmb_normal_law normal;
    dmb_friction_law friction;
    double radius, radius_slope, radius_bend; /* [m, -, 1/m] */
    double stiffness_slope, stiffness_bend;   /* of normal.stiffness, per m, per m2 */
    double factor_slope, damping_slope;       /* of normal.mu and normal.damping, per m */
    double mu_static_slope, mu_dynamic_slope; /* [1/m] */
} dmb_local_wall;

/* J: way along an axis of curvature vector k [1/m] for a unit of its own of a ring at distance e on the side n. */
static inline double dmb_hole_advance(double e, const double n[3], const double k[3])
{
    return 1.0 / (1.0 - e * (n[0] * k[0] + n[1] * k[1] + n[2] * k[2]));
}
/* [m^(n+1)] d^(n+1)/(n+1): what a metre of wall stores for a unit of K */
double dmb_wall_unit_energy(const dmb_normal_law *law, double d);

/* softer [-]: factor that the stiffness is divided by. Of a hole with pieces. */
void dmb_local_wall_at(const dmb_hole *hole, const dmb_normal_law *normal, const dmb_friction_law *friction, double s,
                       double softer, dmb_local_wall *out);

#endif
