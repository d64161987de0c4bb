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

/* y and z of a vector's complex amplitude (re, im), Y and Z, as (Y + sign i Z)/2 e1 and the amplitude that belongs to
 * it: the circle from y to z (sign 1), e1 = (1, -i), or from z to y (sign -1), e1 = (1, i); its real part to `out`. */
static void take_circle(const double *re, const double *im, double sign, double *out)
{
    out[0] = 0.5 * (re[0] - sign * im[1]);
    out[1] = 0.5 * (sign * im[0] + re[1]);
}

/* d^H M d of the circles of one sense in d = x + i y. Their real and imaginary parts are alike: twice that of the real
 * one. */
static double circling(const dmb_mode_search *search, const double *x, const double *y, double sign)
{
    const dmb_block_layout *layout = &search->linear->scene.layout;
    const size_t n = search->linear->rows;
    double *circle = search->work, *product = circle + n;
    memset(circle, 0, n * sizeof(double));
    for (uint32_t i = 0; i < layout->n; i++)
        for (uint32_t c = 1; c < layout->size[i] && layout->size[i] == DMB_NODE_FULL; c += 3) {
            const size_t at = (size_t)layout->row[i] + c;
            take_circle(x + at, y + at, sign, circle + at);
        }
    dmb_linear_multiply(search->linear, &search->linear->mass, circle, product);
    return 2.0 * dmb_dot(n, circle, product);
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
    modes->whirl[k] = y != NULL ? circling(search, to, also, 1.0) - circling(search, to, also, -1.0) : 0.0;
    return DMB_OK;
}
