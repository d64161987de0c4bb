/* A mode that was found: normalised, and told whether it is rigid. */
#include <math.h>
#include <string.h>

#include "analysis/modes.h"
#include "math/dot.h"

/* x + i y times the phase that makes its real part largest, over the root of d^H M d. */
static void normalise(const dmb_mode_search *search, double *x, double *y)
{
    const size_t n = search->linear->rows;
    double *Mx = search->work, *My = Mx + n, xx, yy = 0.0, xy = 0.0;
    dmb_linear_multiply(search->linear, &search->linear->mass, x, Mx);
    xx = dmb_dot(n, x, Mx);
    if (y != NULL) {
        dmb_linear_multiply(search->linear, &search->linear->mass, y, My);
        yy = dmb_dot(n, y, My);
        xy = dmb_dot(n, x, My);
    }
    const double size = xx + yy > 0.0 ? 1.0 / sqrt(xx + yy) : 0.0, phase = -0.5 * atan2(2.0 * xy, xx - yy);
    const double c = size * cos(phase), s = size * sin(phase);
    uint32_t most = 0;
    for (uint32_t i = 0; i < n; i++) {
        const double re = x[i];
        x[i] = c * re - (y != NULL ? s * y[i] : 0.0);
        if (y != NULL) y[i] = s * re + c * y[i];
        if (fabs(x[i]) > fabs(x[most])) most = i;
    }
    for (size_t i = 0; x[most] < 0.0 && i < n; i++) {
        x[i] = i == most ? x[i] : -x[i];
        if (y != NULL) y[i] = -y[i];
    }
    x[most] = fabs(x[most]);
}

int32_t dmb_modes_add_square(dmb_mode_search *search, double square, const double *x)
{
    int32_t status = dmb_modes_add(search, 0.0, 0.0, x, NULL);
    if (status < 0) return status;
    dmb_modes *modes = search->modes;
    const uint32_t k = modes->count - 1;
    double *d = modes->re + (size_t)modes->rows * k;
    const double sharp = dmb_modes_sharpen(search, square, d), s = sqrt(fabs(sharp));
    modes->rigid[k] = !search->pinned && dmb_modes_is_rigid(search, s, 0.0, d, NULL);
    modes->s[2 * (size_t)k] = !modes->rigid[k] && sharp < 0.0 ? s : 0.0;
    modes->s[2 * (size_t)k + 1] = !modes->rigid[k] && sharp > 0.0 ? s : 0.0;
    return DMB_OK;
}

int32_t dmb_modes_add(dmb_mode_search *search, double re, double im, const double *x, const double *y)
{
    dmb_modes *modes = search->modes;
    const size_t rows = modes->rows;
    if (modes->count == modes->capacity) {
        const int32_t status = dmb_modes_reserve(modes, 2 * modes->capacity + 16, search->general);
        if (status < 0) return status;
    }
    const uint32_t k = modes->count++;
    double *to = modes->re + rows * k, *also = modes->im != NULL ? modes->im + rows * k : NULL;
    memcpy(to, x, rows * sizeof(double));
    if (y != NULL) memcpy(also, y, rows * sizeof(double));
    normalise(search, to, y != NULL ? also : NULL);
    modes->rigid[k] = !search->pinned && dmb_modes_is_rigid(search, re, im, to, y != NULL ? also : NULL);
    modes->s[2 * (size_t)k] = modes->rigid[k] ? 0.0 : re;
    modes->s[2 * (size_t)k + 1] = modes->rigid[k] ? 0.0 : im;
    return DMB_OK;
}
