#include "model/frame_axes.h"

#include <math.h>

#include "math/vec3.h"

#define DMB_ALONG 1e-6 /* [rad] directions closer than this span no plane */

static double largest_of(const double a[3])
{
    return fmax(fabs(a[0]), fmax(fabs(a[1]), fabs(a[2])));
}

/* Unit vector along a, whatever the length; false for none. */
static bool unit_along(const double a[3], double out[3])
{
    const double scale = largest_of(a);
    if (!(scale > 0.0)) return false;
    for (int i = 0; i < 3; ++i) out[i] = a[i] / scale;
    dmb_vec3_scale(1.0 / dmb_vec3_norm(out), out, out);
    return true;
}

/* y := unit vector across x next to direction. Twice, so that rounding of the first pass goes too. */
static bool across(const double x[3], const double direction[3], double y[3])
{
    double d[3];
    if (!unit_along(direction, d)) return false;
    for (int pass = 0; pass < 2; ++pass) {
        dmb_vec3_axpy(-dmb_vec3_dot(x, d), x, d);
        if (pass == 0 && dmb_vec3_norm(d) < DMB_ALONG) return false;
        if (!unit_along(d, d)) return false;
    }
    dmb_vec3_copy(d, y);
    return true;
}

bool dmb_frame_axes(const double axis[3], const double normal[3], double M[9])
{
    const double ey[3] = {0.0, 1.0, 0.0}, ez[3] = {0.0, 0.0, 1.0};
    double x[3], y[3] = {0.0}, z[3];
    if (!unit_along(axis, x)) return false;
    if (largest_of(normal) > 0.0) {
        if (!across(x, normal, y)) return false;
    } else if (!across(x, ey, y)) {
        (void)across(x, ez, y);
    }
    dmb_vec3_cross(x, y, z);
    for (int i = 0; i < 3; ++i) dmb_vec3_set(x[i], y[i], z[i], M + 3 * i);
    return true;
}
