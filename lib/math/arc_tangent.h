/* The angle of a direction in the plane, in the number of math/real.h. */
#ifndef DMB_MATH_ARC_TANGENT_H
#define DMB_MATH_ARC_TANGENT_H

#include "math/real.h"

/* atan2(y, x) by atan(r) = sum (-r^2)^k r/(2k+1), r the smaller of |x|, |y| over the larger, brought below tan(pi/8) by
 * atan(r) = pi/4 + atan((r - 1)/(r + 1)). No call, so that it goes side by side; NaN where both are 0,
 * and -0 counts as 0. */
static inline dmb_real dmb_real_atan2(dmb_real y, dmb_real x)
{
    static const double odd[22] = {1.0,        1.0 / 3.0,  1.0 / 5.0,  1.0 / 7.0,  1.0 / 9.0,  1.0 / 11.0,
                                   1.0 / 13.0, 1.0 / 15.0, 1.0 / 17.0, 1.0 / 19.0, 1.0 / 21.0, 1.0 / 23.0,
                                   1.0 / 25.0, 1.0 / 27.0, 1.0 / 29.0, 1.0 / 31.0, 1.0 / 33.0, 1.0 / 35.0,
                                   1.0 / 37.0, 1.0 / 39.0, 1.0 / 41.0, 1.0 / 43.0};
    const dmb_real zero = dmb_real_of(0.0), ax = dmb_real_abs(x), ay = dmb_real_abs(y);
    const dmb_mask steep = dmb_mask_less(ax, ay);
    const dmb_real large = dmb_real_select(steep, ay, ax), small = dmb_real_select(steep, ax, ay);
    const dmb_mask wide = dmb_mask_less(0.41421356237309503 * large, small);
    const dmb_real r = dmb_real_select(wide, small - large, small) / dmb_real_select(wide, small + large, large);
    const dmb_real z = -(r * r);
    dmb_real angle = dmb_real_of(odd[21]);
    for (int k = 20; k >= 0; k--) angle = angle * z + odd[k];
    angle = angle * r + dmb_real_select(wide, dmb_real_of(0.25 * DMB_PI), zero);
    angle = dmb_real_select(steep, 0.5 * DMB_PI - angle, angle);
    angle = dmb_real_select(dmb_mask_less(x, zero), DMB_PI - angle, angle);
    return dmb_real_follow(y, angle);
}

#endif
