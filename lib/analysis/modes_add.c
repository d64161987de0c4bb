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

/* x^H M x of the rest: motion along and around, and nodes that do not leave the axis. */
static double not_circling(const dmb_mode_search *search, const double *x)
{
    const dmb_block_layout *layout = &search->linear->scene.layout;
    const size_t n = search->linear->rows;
    double *rest = search->work, *product = rest + n;
    memcpy(rest, x, n * sizeof(double));
    for (uint32_t i = 0; i < layout->n; i++)
        for (uint32_t c = 1; c < layout->size[i] && layout->size[i] == DMB_NODE_FULL; c += 3)
            rest[layout->row[i] + c] = rest[layout->row[i] + c + 1] = 0.0;
    dmb_linear_multiply(search->linear, &search->linear->mass, rest, product);
    return dmb_dot(n, rest, product);
}

/* Forward less backward over the sum of the parts. That is d^H M d = 1 where the mass is round; eccentric mass couples
 * the parts, and their sum differs from 1. */
static double whirl_of(const dmb_mode_search *search, const double *x, const double *y)
{
    const double forward = circling(search, x, y, 1.0), backward = circling(search, x, y, -1.0);
    const double sum = forward + backward + not_circling(search, x) + not_circling(search, y);
    return sum > 0.0 ? (forward - backward) / sum : 0.0;
}

/* ---- Rigid-body motions ------------------------------------------------------------------------------------------ */

/* A motion of which so much is left, by its square, is one of its own. */
#define DMB_MOTION_NEW 1e-4

/* Takes the rigid-body motions before mode k out of x; part of the square of 1 that is left of it. */
static double take_apart(const dmb_mode_search *search, uint32_t k, double *x)
{
    const dmb_modes *modes = search->modes;
    const size_t n = modes->rows;
    double *product = search->work;
    for (uint32_t i = 0; i < k; i++) {
        const double *r = modes->re + n * i;
        if (!modes->rigid[i]) continue;
        dmb_linear_multiply(search->linear, &search->linear->mass, r, product);
        const double part = dmb_dot(n, product, x);
        for (size_t j = 0; j < n; j++) x[j] -= part * r[j];
    }
    dmb_linear_multiply(search->linear, &search->linear->mass, x, product);
    return dmb_dot(n, x, product);
}

/* x as the next rigid-body mode: what is left of it beside those before, or nothing if that is rounding; `always`:
 * itself then. `x` is not in the place that it goes to. */
static void add_motion(const dmb_mode_search *search, const double *x, int always)
{
    dmb_modes *modes = search->modes;
    const uint32_t k = modes->count;
    const size_t n = modes->rows;
    double *to = modes->re + n * k;
    memcpy(to, x, n * sizeof(double));
    if (take_apart(search, k, to) >= DMB_MOTION_NEW)
        (void)take_apart(search, k, to);
    else if (always)
        memcpy(to, x, n * sizeof(double));
    else
        return;
    memset(modes->im + n * k, 0, n * sizeof(double));
    normalise(search, to, NULL);
    modes->s[2 * (size_t)k] = modes->s[2 * (size_t)k + 1] = modes->whirl[k] = 0.0;
    modes->rigid[k] = 1;
    modes->count++;
}

/* Roots 0 of several rigid-body motions come with any combination of these, of rounding's choice, and where two such
 * roots come out as a complex pair, its real and imaginary part are two motions. Without damping each motion has the
 * root twice, and pairs that come later make up the same motions again. */
static void add_rigid(const dmb_mode_search *search, const double *x, const double *y)
{
    const size_t n = search->modes->rows;
    double *kept = search->work + 2 * n;
    memcpy(kept, x, n * sizeof(double));
    if (y != NULL) memcpy(kept + n, y, n * sizeof(double));
    add_motion(search, kept, y == NULL);
    if (y != NULL) add_motion(search, kept + n, 0);
}

/* ---- Adding ------------------------------------------------------------------------------------------------------ */

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

/* Room for one more, or for both parts of a pair. */
static int32_t make_room(dmb_mode_search *search)
{
    dmb_modes *modes = search->modes;
    if (modes->count + 2 <= modes->capacity) return DMB_OK;
    return dmb_modes_reserve(modes, 2 * modes->capacity + 16, search->general);
}

int32_t dmb_modes_add(dmb_mode_search *search, double re, double im, const double *x, const double *y)
{
    dmb_modes *modes = search->modes;
    const size_t rows = modes->rows;
    const int32_t status = make_room(search);
    if (status < 0) return status;
    const uint32_t k = modes->count;
    double *to = modes->re + rows * k, *also = modes->im != NULL ? modes->im + rows * k : NULL;
    memcpy(to, x, rows * sizeof(double));
    if (y != NULL)
        memcpy(also, y, rows * sizeof(double));
    else if (also != NULL)
        memset(also, 0, rows * sizeof(double)); /* a mode found before may have stood here */
    normalise(search, to, y != NULL ? also : NULL);
    modes->rigid[k] = !search->pinned && dmb_modes_is_rigid(search, re, im, to, y != NULL ? also : NULL);
    if (modes->rigid[k] && search->general) {
        add_rigid(search, to, y != NULL ? also : NULL);
        return DMB_OK;
    }
    modes->count++;
    modes->s[2 * (size_t)k] = modes->rigid[k] ? 0.0 : re;
    modes->s[2 * (size_t)k + 1] = modes->rigid[k] ? 0.0 : im;
    modes->whirl[k] = y != NULL ? whirl_of(search, to, also) : 0.0;
    return DMB_OK;
}
