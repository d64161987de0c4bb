/* Distance from a straight axis, in a number that is a double or lanes of doubles (math/real.h). */
#ifndef DMB_FORCE_HOLE_MATH_H
#define DMB_FORCE_HOLE_MATH_H

#include "math/vec3.h"

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
