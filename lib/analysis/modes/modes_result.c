/* Storage of a computed mode: normalisation, separation from rigid-body motions, order, memory. */
#include <math.h>
#include <string.h>

#include "analysis/modes/modes.h"
#include "base/memory.h"
#include "base/sized_struct.h"
#include "math/dense.h"
#include "math/real.h"
#include "system/system.h"

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
    const double size = 1.0 / sqrt(xx + yy), phase = -0.5 * atan2(2.0 * xy, xx - yy);
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

/* Real part of the circular component of one sense: y and z of a vector's complex amplitude (re, im), Y and Z, as (Y +
 * sign i Z)/2 e1 and the corresponding amplitude: the circle from y to z (sign 1), e1 = (1, -i), or from z to y (sign
 * -1), e1 = (1, i). */
static void add_circle(const double *re, const double *im, double sign, double *out)
{
    out[0] = 0.5 * (re[0] - sign * im[1]);
    out[1] = 0.5 * (sign * im[0] + re[1]);
}

/* d^H M d of the circles of one sense in d = x + i y. Real and imaginary parts contribute equally: twice the real
 * part. */
static double circling(const dmb_mode_search *search, const double *x, const double *y, double sign)
{
    const dmb_block_layout *layout = &search->linear->scene.layout;
    const size_t n = search->linear->rows;
    double *circle = search->work, *product = circle + n;
    memset(circle, 0, n * sizeof(double));
    for (uint32_t i = 0; i < layout->n; i++)
        for (uint32_t c = 1; c < layout->size[i] && layout->size[i] == DMB_NODE_SIX_DOF; c += 3) {
            const size_t at = (size_t)layout->row[i] + c;
            add_circle(x + at, y + at, sign, circle + at);
        }
    dmb_linear_multiply(search->linear, &search->linear->mass, circle, product);
    return 2.0 * dmb_dot(n, circle, product);
}

/* x^H M x of the other components: axial and torsional motion, and axial-torsional nodes. */
static double not_circling(const dmb_mode_search *search, const double *x)
{
    const dmb_block_layout *layout = &search->linear->scene.layout;
    const size_t n = search->linear->rows;
    double *rest = search->work, *product = rest + n;
    memcpy(rest, x, n * sizeof(double));
    for (uint32_t i = 0; i < layout->n; i++)
        for (uint32_t c = 1; c < layout->size[i] && layout->size[i] == DMB_NODE_SIX_DOF; c += 3)
            rest[layout->row[i] + c] = rest[layout->row[i] + c + 1] = 0.0;
    dmb_linear_multiply(search->linear, &search->linear->mass, rest, product);
    return dmb_dot(n, rest, product);
}

/* Forward less backward over the sum of the parts. The sum is d^H M d = 1 if the mass is axisymmetric; eccentric mass
 * couples the parts, and their sum differs from 1. */
static double whirl_of(const dmb_mode_search *search, const double *x, const double *y)
{
    const double forward = circling(search, x, y, 1.0), backward = circling(search, x, y, -1.0);
    const double sum = forward + backward + not_circling(search, x) + not_circling(search, y);
    return (forward - backward) / sum;
}

/* ---- Rigid-body motions ------------------------------------------------------------------------------------------ */

/* Largest squared fraction of a shape orthogonal to the rigid-body motions if it consists of them. */
#define DMB_BESIDE_RIGID 1e-6
/* The same for a motion that drag damps so little that no other force acts. */
#define DMB_BESIDE_DRIFT 1e-10
/* Rounding of damping over its terms; [1/s] rates below the second bound count as 0. */
#define DMB_DRIFT_NOISE 1e-12
#define DMB_DRIFT_LEAST 1e-15

/* x^T M x of the component orthogonal to the rigid-body motions; adds that of x to *whole. */
static double beside_rigid(const dmb_mode_search *search, const double *x, double *whole)
{
    const size_t n = search->linear->rows;
    double *product = search->work, sum;
    dmb_linear_multiply(search->linear, &search->linear->mass, x, product);
    *whole += sum = dmb_dot(n, x, product);
    for (uint32_t i = 0; i < search->rigid_count; i++) {
        const double part = dmb_dot(n, search->rigid_momentum + n * i, x);
        sum -= part * part;
    }
    return sum;
}

/* [1/s] c = x^H C x over x^H M x = whole, and its rounding by its terms. */
static double damping_of(const dmb_mode_search *search, const double *x, const double *y, double whole, double *noise)
{
    const dmb_linear *linear = search->linear;
    const double *const parts[2] = {x, y};
    double *product = search->work, c = 0.0, terms = 0.0;
    for (int i = 0; i < 2 && parts[i] != NULL; i++) {
        dmb_linear_multiply(linear, &linear->damping, parts[i], product);
        c += dmb_dot(linear->rows, parts[i], product);
        dmb_linear_terms(linear, &linear->damping, parts[i], product);
        for (uint32_t r = 0; r < linear->rows; r++) terms += fabs(parts[i][r]) * product[r];
    }
    *noise = fmax(DMB_DRIFT_NOISE * terms / whole, DMB_DRIFT_LEAST);
    return c / whole;
}

/* If drag damps a motion, K x = 0 has the roots 0 and -c; the latter is a separate mode. */
int dmb_modes_is_rigid_root(const dmb_mode_search *search, double re, double im, const double *x, const double *y)
{
    double whole = 0.0, beside = 0.0, noise = 0.0, c = 0.0;
    if (search->rigid_count == 0 || search->apart) return 0;
    beside = beside_rigid(search, x, &whole) + (y != NULL ? beside_rigid(search, y, &whole) : 0.0);
    if (!(beside <= DMB_BESIDE_RIGID * whole)) return 0;
    if (search->options->kind == DMB_MODES_DAMPED) c = damping_of(search, x, y, whole, &noise);
    if (re * re + im * im > fmax(DMB_RIGID_NOISE * search->noise, noise * noise)) return 0;
    return !(c > noise && hypot(re + c, im) < 0.5 * c);
}

/* [1/s] Refined real root s of shape x that is not a rigid-body root: rounding of K hides slow drag. From C alone,
 * because K x, which is 0 but for rounding, would dominate. */
static double drift(const dmb_mode_search *search, double s, const double *x)
{
    const size_t n = search->linear->rows;
    double *r = search->work + 2 * n, whole = 0.0, kept = 0.0, noise;
    if (search->rigid_count == 0 || search->apart || search->options->kind != DMB_MODES_DAMPED) return s;
    if (!(beside_rigid(search, x, &whole) <= DMB_BESIDE_DRIFT * whole)) return s;
    memset(r, 0, n * sizeof(double));
    for (uint32_t i = 0; i < search->rigid_count; i++) {
        const double part = dmb_dot(n, search->rigid_momentum + n * i, x);
        for (size_t k = 0; k < n; k++) r[k] += part * search->rigid[n * i + k];
        kept += part * part;
    }
    return -damping_of(search, r, NULL, kept, &noise);
}

/* ---- Adding ------------------------------------------------------------------------------------------------------ */

/* Ensures capacity for one more mode. */
static int32_t make_room(dmb_mode_search *search)
{
    dmb_modes *modes = search->modes;
    if (modes->count < modes->capacity) return DMB_OK;
    return dmb_modes_reserve(modes, 2 * modes->capacity + 16, search->general);
}

void dmb_modes_put(dmb_mode_search *search, uint32_t k, double re, double im, const double *x, const double *y)
{
    dmb_modes *modes = search->modes;
    const size_t rows = modes->rows;
    double *to = modes->re + rows * k, *also = modes->im != NULL ? modes->im + rows * k : NULL;
    if (also == NULL) y = NULL; /* only general pencils have complex shapes */
    memcpy(to, x, rows * sizeof(double));
    if (y != NULL)
        memcpy(also, y, rows * sizeof(double));
    else if (also != NULL)
        memset(also, 0, rows * sizeof(double)); /* a previous mode may have been stored here */
    normalise(search, to, y != NULL ? also : NULL);
    modes->rigid[k] = 0;
    modes->s[2 * (size_t)k] = re;
    modes->s[2 * (size_t)k + 1] = im;
    modes->whirl[k] = y != NULL ? whirl_of(search, to, also) : 0.0;
}

int32_t dmb_modes_add(dmb_mode_search *search, double re, double im, const double *x, const double *y)
{
    const int32_t status = make_room(search);
    if (status < 0) return status;
    dmb_modes_put(search, search->modes->count++, re, im, x, y);
    return DMB_OK;
}

void dmb_modes_put_square(dmb_mode_search *search, uint32_t k, double square, const double *x)
{
    dmb_modes *modes = search->modes;
    dmb_modes_put(search, k, 0.0, 0.0, x, NULL);
    const double sharp = dmb_modes_refine(search, square, modes->re + (size_t)modes->rows * k), s = sqrt(fabs(sharp));
    modes->s[2 * (size_t)k] = sharp < 0.0 ? s : 0.0;
    modes->s[2 * (size_t)k + 1] = sharp > 0.0 ? s : 0.0;
}

int32_t dmb_modes_add_square(dmb_mode_search *search, double square, const double *x)
{
    const int32_t status = make_room(search);
    if (status < 0) return status;
    dmb_modes_put_square(search, search->modes->count++, square, x);
    return DMB_OK;
}

/* A real root of two shapes, as of a column that diverges in two planes, may appear as a pair that rounding has moved
 * off the real axis by DMB_REAL_PAIR; or, depending on the BLAS, by the multiple DMB_REAL_PAIR_NOISE of the effect on s
 * of the rounding level of eigenvalues s^2, up to DMB_REAL_PAIR_MOST. Real and imaginary part are then shapes of it,
 * unless one of them is below the fraction DMB_REAL_SHAPES of the other: that is a double root of one shape
 * (dmb_modes_join). */
#define DMB_REAL_PAIR 1e-9
#define DMB_REAL_PAIR_NOISE 16.0
#define DMB_REAL_PAIR_MOST 1e-6
#define DMB_REAL_SHAPES 1e-4

int dmb_modes_are_two_shapes(const dmb_mode_search *search, const double *y)
{
    double *My = search->work;
    dmb_linear_multiply(search->linear, &search->linear->mass, y, My);
    return dmb_dot(search->linear->rows, y, My) > DMB_REAL_SHAPES * DMB_REAL_SHAPES;
}

int dmb_modes_is_real_pair(const dmb_mode_search *search, double re, double im, double *x, double *y)
{
    const double size = fabs(re), most = DMB_REAL_PAIR_MOST * size;
    const double noise = size > 0.0 ? fmin(DMB_REAL_PAIR_NOISE * search->noise / size, most) : 0.0;
    if (!(fabs(im) <= fmax(DMB_REAL_PAIR * size, noise))) return 0;
    normalise(search, x, y);
    return dmb_modes_are_two_shapes(search, y);
}

/* The decaying half of a divergence pair (s, -s) is not a separate mode. */
static int32_t read_real(dmb_mode_search *search, double re, const double *x)
{
    if (search->options->kind == DMB_MODES_UNDAMPED && re < 0.0) return DMB_OK;
    if (dmb_modes_is_rigid_root(search, re, 0.0, x, NULL)) return DMB_OK;
    return dmb_modes_add(search, drift(search, re, x), 0.0, x, NULL);
}

int32_t dmb_modes_add_root(dmb_mode_search *search, double re, double im, double *x, double *y)
{
    if (im == 0.0) return read_real(search, re, x);
    if (dmb_modes_is_real_pair(search, re, im, x, y)) {
        const int32_t status = read_real(search, re, x);
        return status < 0 ? status : read_real(search, re, y);
    }
    if (dmb_modes_is_rigid_root(search, re, im, x, y)) return DMB_OK;
    return dmb_modes_add(search, re, im, x, y);
}

/* Order and selection of modes. */

double dmb_modes_size(const dmb_modes *modes, uint32_t i)
{
    return hypot(modes->s[2 * (size_t)i], modes->s[2 * (size_t)i + 1]);
}

static void swap(double *a, double *b, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        const double kept = a[i];
        a[i] = b[i];
        b[i] = kept;
    }
}

void dmb_modes_exchange(dmb_modes *modes, uint32_t i, uint32_t j)
{
    const size_t rows = modes->rows;
    const uint8_t rigid = modes->rigid[i];
    modes->rigid[i] = modes->rigid[j];
    modes->rigid[j] = rigid;
    swap(modes->s + 2 * (size_t)i, modes->s + 2 * (size_t)j, 2);
    swap(modes->whirl + i, modes->whirl + j, 1);
    swap(modes->re + rows * i, modes->re + rows * j, rows);
    if (modes->im != NULL) swap(modes->im + rows * i, modes->im + rows * j, rows);
}

void dmb_modes_sort(dmb_modes *modes, uint32_t keep)
{
    for (uint32_t i = 0; i < modes->count && i < keep; i++) {
        uint32_t least = i;
        for (uint32_t j = i + 1; j < modes->count; j++)
            if (dmb_modes_size(modes, j) < dmb_modes_size(modes, least)) least = j;
        if (least != i) dmb_modes_exchange(modes, i, least);
    }
    if (modes->count > keep) modes->count = keep;
}

void dmb_modes_keep_band(dmb_modes *modes, double low, double high)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < modes->count; i++) {
        const double f = dmb_modes_size(modes, i) / DMB_TWO_PI;
        if (f < low || f > high) continue;
        if (kept != i) dmb_modes_exchange(modes, kept, i);
        kept++;
    }
    modes->count = kept;
}

int32_t dmb_modes_put_rigid(dmb_mode_search *search)
{
    dmb_modes *modes = search->modes;
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < search->rigid_count && status >= 0; i++) {
        status = dmb_modes_add(search, 0.0, 0.0, search->rigid + (size_t)modes->rows * i, NULL);
        if (status >= 0) modes->rigid[modes->count - 1] = 1;
    }
    return status;
}

/* Memory of the modes. */

static size_t bytes_of(const dmb_modes *modes, uint32_t capacity, int32_t with_im)
{
    return ((size_t)capacity * 3 + (size_t)capacity * modes->rows * (with_im ? 2 : 1)) * sizeof(double) + capacity;
}

static void place(dmb_modes *modes, void *block, uint32_t capacity, int32_t with_im)
{
    modes->s = block;
    modes->re = modes->s + 2 * (size_t)capacity;
    modes->im = with_im ? modes->re + (size_t)capacity * modes->rows : NULL;
    modes->whirl = modes->re + (size_t)capacity * modes->rows * (with_im ? 2 : 1);
    modes->rigid = (uint8_t *)(modes->whirl + capacity);
    modes->capacity = capacity;
}

int32_t dmb_modes_reserve(dmb_modes *modes, uint32_t capacity, int32_t with_im)
{
    const dmb_modes old = *modes;
    const size_t part = (size_t)old.count * old.rows * sizeof(double);
    void *block = dmb_allocate(&modes->allocator, bytes_of(modes, capacity, with_im));
    if (block == NULL) return DMB_ERR_NO_MEMORY;
    place(modes, block, capacity, with_im);
    if (old.s == NULL) return DMB_OK;
    memcpy(modes->s, old.s, 2 * (size_t)old.count * sizeof(double));
    memcpy(modes->re, old.re, part);
    if (old.im != NULL && modes->im != NULL) memcpy(modes->im, old.im, part);
    memcpy(modes->whirl, old.whirl, old.count * sizeof(double));
    memcpy(modes->rigid, old.rigid, old.count);
    dmb_release(&modes->allocator, old.s, bytes_of(&old, old.capacity, old.im != NULL));
    return DMB_OK;
}

void dmb_modes_destroy(dmb_modes **modes)
{
    if (modes == NULL || *modes == NULL) return;
    dmb_modes *m = *modes;
    *modes = NULL;
    if (!dmb_handle_is(m, DMB_HANDLE_MODES)) return;
    const dmb_allocator allocator = m->allocator;
    dmb_model *model = m->state != NULL ? m->state->model : NULL;
    m->magic = DMB_HANDLE_DEAD;
    if (m->s != NULL) dmb_release(&allocator, m->s, bytes_of(m, m->capacity, m->im != NULL));
    dmb_state_discard(m->state);
    if (model != NULL) dmb_model_release(model);
    dmb_release(&allocator, m, sizeof *m);
}

int32_t dmb_modes_open(const dmb_sim *sim, dmb_modes **modes)
{
    dmb_modes *m = dmb_allocate(&sim->allocator, sizeof *m);
    if (m == NULL) return DMB_ERR_NO_MEMORY;
    m->magic = DMB_HANDLE_MODES;
    m->allocator = sim->allocator;
    m->rows = sim->scene->row_count;
    m->state = dmb_state_copy(sim);
    if (m->state != NULL) {
        m->state->magic = DMB_HANDLE_SIM;             /* queries read through it */
        m->state->progress = &m->state->own_progress; /* it may outlive the sim */
        dmb_model_hold(m->state->model);
    }
    *modes = m;
    return m->state != NULL ? DMB_OK : DMB_ERR_NO_MEMORY;
}
