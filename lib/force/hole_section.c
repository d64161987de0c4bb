#include "force/hole_section.h"

#include <math.h>

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

double dmb_hole_least_radius(const dmb_hole *hole, double s0, double s1, double *where)
{
    double least = hole->radius;
    *where = s0;
    if (hole->pieces == 0) return least;
    least = dmb_hole_radius(hole, s0);
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

/* mu of the restitution there. */
static void take_restitution(const dmb_hole_piece *piece, double s, dmb_normal_law *law)
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
    take_restitution(piece, s, &local);
    return local;
}

static dmb_friction_law friction_at(const dmb_hole_piece *piece, const dmb_friction_law *law, double factor, double s)
{
    dmb_friction_law local = *law;
    local.mu_static = factor * dmb_hole_piece_value(piece, DMB_WALL_MU_STATIC, s);
    local.mu_dynamic = factor * dmb_hole_piece_value(piece, DMB_WALL_MU_DYNAMIC, s);
    return local;
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

double dmb_wall_unit_energy(const dmb_normal_law *law, double d)
{
    return dmb_normal_reduced_power(law->exponent, d) * d * d / (law->exponent + 1.0);
}
