/* Rotations away from zero. */
#include "math/so3.h"

#include <math.h>

#include "math/elementary.h"
#include "math/vec3.h"

/* ---- Large angles ------------------------------------------------------------------------------------------------ */

/* a = sin t/t, b = (1 - cos t)/t^2 from the half angle, and the others from a and b, t = sqrt x: beyond pi there is no
 * cancellation. */
static void dmb_so3_coefficients_closed(double x, dmb_so3_coefficients *k)
{
    const double t = sqrt(x), s = dmb_sin(0.5 * t);
    k->a = dmb_sin(t) / t;
    k->b = 2.0 * s * s / x;
    k->a2 = (1.0 - k->a) / x;
    k->db = (k->a - 2.0 * k->b) / x;
    k->da2 = (k->b - 3.0 * k->a2) / x;
}

void dmb_so3_far_coefficients(double x, double out[5])
{
    dmb_so3_coefficients k;
    if (x < DMB_SO3_MEDIUM)
        dmb_so3_coefficients_series(x, 13, &k);
    else
        dmb_so3_coefficients_closed(x, &k);
    out[0] = k.a, out[1] = k.b, out[2] = k.a2, out[3] = k.db, out[4] = k.da2;
}

/* c = sum 2/((2 pi k)^2 - x): all terms are positive, so that there is no cancellation. The poles k = 1, 2 are
 * evaluated directly, the remaining sum, regular up to t = 6 pi, as a series. */
static void dmb_so3_inverse_coefficients_poles(double x, dmb_so3_inverse_coefficients *k)
{
    static const double c[10] = {2.0007593556872226e-02, 2.5438120688625620e-05, 5.5845683904944151e-08,
                                 1.4088241574761048e-10, 3.7567162002157979e-13, 1.0280125375360461e-15,
                                 2.8500221292137911e-18, 7.9555754107198446e-21, 2.2289326645537012e-23,
                                 6.2574711508057725e-26};
    static const double e[10] = {5.0876241377251241e-05, 2.2338273561977660e-07, 8.4529449448566277e-10,
                                 3.0053729601726383e-12, 1.0280125375360461e-14, 3.4200265550565496e-17,
                                 1.1137805575007783e-19, 3.5662922632859219e-22, 1.1263448071450389e-24,
                                 3.5173460985819363e-27};
    static const double e2[10] = {4.4676547123955320e-07, 3.3811779779426511e-09, 1.8032237761035829e-11,
                                  8.2241003002883685e-14, 3.4200265550565496e-16, 1.3365366690009339e-18,
                                  4.9928091686002903e-21, 1.8021516914320623e-23, 6.3312229774474842e-26,
                                  2.1761726580254931e-28};
    const double p = 1.0 / (39.478417604357432 - x), q = 1.0 / (157.91367041742973 - x);
    double u = c[9], v = e[9], w = e2[9];
    for (int i = 8; i >= 0; i--) {
        u = u * x + c[i];
        v = v * x + e[i];
        w = w * x + e2[i];
    }
    k->c = 2.0 * (p + q) + u;
    k->e = 4.0 * (p * p + q * q) + v;
    k->e2 = 16.0 * (p * p * p + q * q * q) + w;
}

/* e = (ib + g - 2)/x^2, ib = (t/2)^2/sin^2(t/2)   e2 = ((dib + dg)/x^2 - 4 e/t)/t */
static void dmb_so3_inverse_coefficients_closed(double x, dmb_so3_inverse_coefficients *k)
{
    const double t = sqrt(x), h = 0.5 * t;
    double s, c;
    dmb_sin_cos(h, &s, &c);
    const double g = h * c / s, ib = h * h / (s * s);
    const double dib = ib / h * (1.0 - g), dg = (g - ib) / t;
    k->c = (1.0 - g) / x;
    k->e = (ib + g - 2.0) / (x * x);
    k->e2 = ((dib + dg) / (x * x) - 4.0 * k->e / t) / t;
}

void dmb_so3_far_inverse_coefficients(double x, double out[3])
{
    dmb_so3_inverse_coefficients k;
    if (x < DMB_SO3_MEDIUM)
        dmb_so3_inverse_coefficients_poles(x, &k);
    else
        dmb_so3_inverse_coefficients_closed(x, &k);
    out[0] = k.c, out[1] = k.e, out[2] = k.e2;
}

/* O = f v: the angle is 2 atan2(|v|, q0). */
double dmb_quat_far_log_factor(double q0, double n)
{
    return n > 0.0 ? 2.0 * dmb_atan2(sqrt(n), q0) / sqrt(n) : 2.0;
}

/* ---- Axes from two directions ------------------------------------------------------------------------------------ */

#define DMB_ALONG 1e-6 /* [rad] directions closer than this define no plane */

static double largest_of(const double a[3])
{
    return fmax(fabs(a[0]), fmax(fabs(a[1]), fabs(a[2])));
}

/* Unit vector along a, for any length; false for length 0. */
static bool unit_along(const double a[3], double out[3])
{
    const double scale = largest_of(a);
    if (!(scale > 0.0)) return false;
    for (int i = 0; i < 3; ++i) out[i] = a[i] / scale;
    dmb_vec3_scale(1.0 / dmb_vec3_norm(out), out, out);
    return true;
}

/* y := unit vector normal to x in the direction of `direction`. Two passes, so that rounding of the first one is
 * removed. */
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
