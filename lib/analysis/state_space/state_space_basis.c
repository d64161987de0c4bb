/* Basis X of the coordinates (eq:response.state-space): unit motions of all independent coordinates, or of a reduced
 * model modes first, then quasi-static shapes, orthonormalised in M in this order: the modes keep their span, and a
 * static shape adds only its part that the modes do not contain. */
#include <math.h>
#include <string.h>

#include "analysis/modes/modes.h"
#include "analysis/state_space/state_space.h"
#include "math/dense.h"
#include "sim/node.h"

/* [-] A shape is dependent on earlier ones if its orthogonal component is below this fraction of its length in M. */
#define DMB_SHAPE_NEW 1e-6
/* [-] Pivot over the largest entry of its block below which a motion is unconstrained but for rounding. */
#define DMB_SHAPE_HELD 1e-13

static double *shape(const dmb_space_work *w, uint32_t i)
{
    return w->space->shapes + (size_t)w->linear->rows * i;
}

/* ---- Unit motions ------------------------------------------------------------------------------------------------ */

static int32_t unit_motions(dmb_space_work *w)
{
    const uint32_t n = w->linear->coordinates;
    double *z = w->work;
    memset(z, 0, n * sizeof(double));
    for (uint32_t i = 0; i < n; i++) {
        z[i] = 1.0;
        dmb_linear_expand(w->linear, z, shape(w, i));
        z[i] = 0.0;
    }
    w->space->info.coordinates = n;
    return DMB_OK;
}

/* ---- Orthonormal shapes ------------------------------------------------------------------------------------------ */

/* Adds x to the basis unless it depends on earlier shapes; x and three arrays after `work` are overwritten.
 * Gram-Schmidt twice. */
static void add_shape(dmb_space_work *w, const double *x)
{
    const uint32_t rows = w->linear->rows, count = w->space->info.coordinates;
    double *to = shape(w, count), *product = w->work + rows;
    dmb_linear_multiply(w->linear, &w->linear->mass, x, memset(product, 0, rows * sizeof(double)));
    const double length = sqrt(dmb_dot(rows, x, product));
    if (!(length > 0.0) || !isfinite(length)) return;
    for (uint32_t r = 0; r < rows; r++) to[r] = x[r] / length;
    for (int pass = 0; pass < 2; pass++) {
        dmb_linear_multiply(w->linear, &w->linear->mass, to, memset(product, 0, rows * sizeof(double)));
        for (uint32_t i = 0; i < count; i++) {
            const double part = dmb_dot(rows, shape(w, i), product);
            for (uint32_t r = 0; r < rows; r++) to[r] -= part * shape(w, i)[r];
        }
    }
    dmb_linear_multiply(w->linear, &w->linear->mass, to, memset(product, 0, rows * sizeof(double)));
    const double left = sqrt(dmb_dot(rows, to, product));
    if (!(left > DMB_SHAPE_NEW)) return;
    for (uint32_t r = 0; r < rows; r++) to[r] /= left;
    w->space->info.coordinates++;
}

/* ---- Modes ------------------------------------------------------------------------------------------------------- */

static int32_t refuse(const dmb_space_work *w, const char *why)
{
    dmb_message_set(&w->sim->message, "state space options: %s", why);
    return DMB_ERR_VALUE;
}

static uint32_t mode_count(const dmb_space_work *w)
{
    return w->options.mode_list != NULL ? w->options.mode_count : w->options.modes->count;
}

/* A damped mode adds real and imaginary part: together they span the plane in which it moves. */
static int32_t add_modes(dmb_space_work *w)
{
    const dmb_modes *modes = w->options.modes;
    const uint32_t rows = w->linear->rows;
    if (modes->rows != rows || modes->state->model != w->sim->model)
        return refuse(w, "modes must be those of a sim of the same model");
    for (uint32_t k = 0; k < mode_count(w); k++) {
        const uint32_t i = w->options.mode_list != NULL ? (uint32_t)w->options.mode_list[k] : k;
        if (i >= modes->count) return refuse(w, "mode_list must hold numbers 0 .. count of the modes - 1");
        add_shape(w, modes->re + (size_t)rows * i);
        if (modes->im != NULL) add_shape(w, modes->im + (size_t)rows * i);
    }
    w->space->info.mode_shapes = w->space->info.coordinates;
    return DMB_OK;
}

/* ---- Quasi-static shapes ----------------------------------------------------------------------------------------- */

/* K + w0^2 M, w0 = 2 pi shift: regular with unconstrained motions, too, if shift > 0. */
static int32_t factor(dmb_space_work *w)
{
    const double omega = DMB_TWO_PI * w->options.shift;
    dmb_block_weakest weakest = {.ratio = 1.0};
    const int64_t bad = dmb_linear_factor(w->linear, 1.0, 0.0, omega * omega, &weakest);
    if (bad < 0 && weakest.ratio > DMB_SHAPE_HELD) return DMB_OK;
    const dmb_owner owner = dmb_owner_of_node(&w->linear->scene, bad >= 0 ? (uint32_t)bad : weakest.block);
    dmb_message_set(
        &w->sim->message,
        "state space: shift = %g Hz: nothing holds %s there, so that it has no quasi-static shape; choose a "
        "shift > 0 far below the frequencies that count, or static_correction 0",
        w->options.shift, owner.text.text);
    return DMB_ERR_SINGULAR;
}

/* Adds (K + w^2 M)^-1 f, f in w->work + 2 rows. */
static void add_solution(dmb_space_work *w)
{
    const uint32_t rows = w->linear->rows;
    double *x = w->work + 2 * (size_t)rows;
    for (uint32_t r = 0; r < rows; r++)
        if (!w->linear->scene.solved_row[r]) x[r] = 0.0;
    dmb_linear_solve(w->linear, x);
    add_shape(w, x);
}

/* For a force its static response; for a prescribed motion p the responses to the three forces by which it acts on
 * other rows, K p, C p and M p. */
static int32_t add_statics(dmb_space_work *w)
{
    const uint32_t rows = w->linear->rows;
    double *f = w->work + 2 * (size_t)rows;
    const int32_t status = w->input_count > 0 ? factor(w) : DMB_OK;
    for (uint32_t i = 0; i < w->input_count && status >= 0; i++) {
        const dmb_linear_excitation *e = w->inputs + i;
        for (int kind = 2; kind >= 0 && e->law == DMB_EXCITE_MOTION; kind--) {
            dmb_sparse_times(&w->space->whole, kind, e->re, f);
            add_solution(w);
        }
        if (e->law == DMB_EXCITE_MOTION) continue;
        memcpy(f, e->re, rows * sizeof(double));
        add_solution(w);
    }
    return status;
}

uint64_t dmb_space_basis_workspace(const dmb_space_work *w)
{
    const uint64_t n = w->linear->coordinates;
    if (w->options.form != DMB_STATE_REDUCED) return n;
    const uint64_t modes = mode_count(w), each = w->options.modes->im != NULL ? 2 : 1;
    const uint64_t room = each * modes + (w->options.static_correction ? 3 * (uint64_t)w->input_count : 0);
    return 1 + room; /* a dependent shape is written before it is omitted */
}

int32_t dmb_space_make_basis(dmb_space_work *w)
{
    if (w->options.form == DMB_STATE_FULL) return unit_motions(w);
    int32_t status = add_modes(w);
    if (status >= 0 && w->options.static_correction) status = add_statics(w);
    return status;
}
