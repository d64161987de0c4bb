/* Points of a frequency response: one by one, or in groups of lanes, with the same bits. */
#include <math.h>

#include "analysis/response/response.h"
#include "math/so3.h"
#include "sim/access.h"
#include "sim/node.h"

/* ---- One frequency ----------------------------------------------------------------------------------------------- */

static int32_t no_displacement(const dmb_response_work *w, uint32_t input)
{
    dmb_message_set(&w->sim->message, "excitation %u: at frequency 0 a speed has no displacement to respond to", input);
    return DMB_ERR_SINGULAR;
}

/* to = (re + i im) from */
static void scale_rows(uint32_t rows, double re, double im, dmb_complex_array from, dmb_complex_array to)
{
    const double *restrict a = from.re, *restrict b = from.im;
    double *restrict to_re = to.re, *restrict to_im = to.im;
    for (uint32_t r = 0; r < rows; r++) to_re[r] = re * a[r] - im * b[r];
    for (uint32_t r = 0; r < rows; r++) to_im[r] = re * b[r] + im * a[r];
}

/* Right-hand side of an input into x: forces, also stored in f, or displacements prescribed by a drive. By the law of
 * the excitation, for unit amplitude of the quantity that is prescribed:
 *
 *     force                 f
 *     inertia (unbalance)   w^2 f (eq:response.eccentric)
 *     target of a control   (k_p + k_i/(i w)) f
 *     speed of a motion     displacements p/(i w): no forces of its own, and undefined at w = 0 */
static int32_t load(dmb_response_work *w, uint32_t input, double omega)
{
    const dmb_linear_excitation *e = w->excitations + input;
    const dmb_complex_array rows = {e->re, e->im};
    const int integral = e->law == DMB_EXCITE_CONTROL && e->integral_gain != 0.0;
    const double kept = e->law == DMB_EXCITE_MOTION ? 0.0 : 1.0;
    double re = 1.0, im = 0.0;
    if (omega == 0.0 && (integral || e->law == DMB_EXCITE_MOTION)) return no_displacement(w, input);
    if (e->law == DMB_EXCITE_INERTIA) re = omega * omega;
    if (e->law == DMB_EXCITE_CONTROL) re = e->gain, im = integral ? -e->integral_gain / omega : 0.0;
    if (e->law == DMB_EXCITE_MOTION) re = 0.0, im = -1.0 / omega;
    if (!isfinite(im)) return no_displacement(w, input);
    scale_rows(w->linear->rows, re, im, rows, w->x);
    if (w->needs_forces) scale_rows(w->linear->rows, kept * re, kept * im, rows, w->f);
    return DMB_OK;
}

static int32_t nothing_holds(const dmb_response_work *w, double frequency, uint32_t node)
{
    const dmb_owner owner = dmb_owner_of_node(&w->linear->scene, node);
    dmb_message_set(&w->sim->message,
                    "frequency %g Hz: %s: nothing holds it there, the dynamic stiffness is "
                    "singular",
                    frequency, owner.text.text);
    return DMB_ERR_SINGULAR;
}

/* Outputs at a point for an excitation; x, f of the work are those of this point. */
static void write_values(dmb_response_work *w, dmb_response *response, uint32_t point, uint32_t excitation)
{
    const double s[2] = {0.0, w->stiffness.omega};
    double *value = dmb_response_value(response, point, excitation);
    (void)dmb_linear_change_of(&w->turned, w->linear, s, w->x.re, w->x.im);
    for (uint32_t k = 0; k < w->output_count; k++) {
        const dmb_complex_number found =
            dmb_linear_output_value(&w->stiffness, w->outputs + k, w->excitations + excitation, w->x, w->f);
        value[2 * (size_t)k] = found.re;
        value[2 * (size_t)k + 1] = found.im;
    }
}

static int32_t is_motion(const dmb_response_work *w, uint32_t excitation)
{
    return w->excitations[excitation].law == DMB_EXCITE_MOTION;
}

static double omega_of(const dmb_response *response, uint32_t point)
{
    return DMB_TWO_PI * response->frequency[point];
}

static int32_t solve_alone(dmb_response_work *w, dmb_response *response, uint32_t point)
{
    const double omega = omega_of(response, point);
    const int64_t bad = dmb_dynamic_stiffness_factor(&w->stiffness, omega);
    if (bad >= 0) return nothing_holds(w, response->frequency[point], (uint32_t)bad);
    for (uint32_t i = 0; i < w->excitation_count; i++) {
        const int32_t status = load(w, i, omega);
        if (status < 0) return status;
        dmb_dynamic_stiffness_solve(&w->stiffness, is_motion(w, i), w->x);
        write_values(w, response, point, i);
    }
    return DMB_OK;
}

/* ---- Side by side ------------------------------------------------------------------------------------------------ */

/* Excitations first .. first + count - 1, right-hand sides solved together. */
typedef struct batch {
    uint32_t first, count;
} batch;

/* Right-hand sides of all points. Returns one bit for each point without one. */
static uint32_t put_sides(dmb_response_work *w, const dmb_response_points *points, const batch *b)
{
    uint32_t none = 0;
    for (uint32_t l = 0; l < points->count; l++)
        for (uint32_t c = 0; c < b->count; c++) {
            const uint32_t i = b->first + c;
            if (load(w, i, w->group.omega[l]) < 0)
                none |= 1u << l;
            else
                dmb_dynamic_group_put(&w->group, l, c, is_motion(w, i), w->x);
        }
    return none;
}

/* The lanes hold only displacements: forces are set again where outputs need them, and prescribed ones for motions. */
static void get_values(dmb_response_work *w, dmb_response *response, uint32_t point, uint32_t lane, const batch *b)
{
    for (uint32_t c = 0; c < b->count; c++) {
        const uint32_t i = b->first + c;
        if (w->needs_forces || is_motion(w, i)) (void)load(w, i, w->group.omega[lane]); /* checked by put_sides */
        dmb_dynamic_group_get(&w->group, lane, c, is_motion(w, i), w->x);
        write_values(w, response, point, i);
    }
}

/* Points without a solution, one bit each in *alone, are solved by solve_alone, which finds the solution or the reason.
 */
static int32_t solve_batch(dmb_response_work *w, dmb_response *response, const dmb_response_points *points,
                           const batch *b, uint32_t *alone)
{
    const uint32_t done = *alone;
    *alone |= put_sides(w, points, b);
    *alone |= dmb_dynamic_group_solve(&w->group, b->count);
    for (uint32_t l = 0; l < points->count; l++) {
        const uint32_t point = points->point[l];
        const int32_t told = b->first == 0 ? dmb_progress_pulse(w->sim) : DMB_OK;
        if (told < 0) return told;
        if ((done >> l & 1) != 0) continue;
        const int32_t status = (*alone >> l & 1) != 0 ? solve_alone(w, response, point) : DMB_OK;
        if (status < 0) return status;
        if ((*alone >> l & 1) == 0) get_values(w, response, point, l, b);
    }
    return DMB_OK;
}

static int32_t solve_group(dmb_response_work *w, dmb_response *response, const dmb_response_points *points)
{
    int32_t status = DMB_OK;
    uint32_t alone = 0;
    w->group.used = points->count;
    for (uint32_t l = 0; l < points->count; l++) w->group.omega[l] = omega_of(response, points->point[l]);
    for (uint32_t i = 0; i < w->excitation_count && status >= 0; i += w->group.columns) {
        const uint32_t left = w->excitation_count - i;
        const batch b = {i, left < w->group.columns ? left : w->group.columns};
        status = solve_batch(w, response, points, &b, &alone);
    }
    return status;
}

int32_t dmb_response_solve(dmb_response_work *w, dmb_response *response, const dmb_response_points *points)
{
    if (points->count > 1) return solve_group(w, response, points);
    for (uint32_t l = 0; l < points->count; l++) {
        const int32_t told = dmb_progress_pulse(w->sim);
        const int32_t status = told < 0 ? told : solve_alone(w, response, points->point[l]);
        if (status < 0) return status;
    }
    return DMB_OK;
}
