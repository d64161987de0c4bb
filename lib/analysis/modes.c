#include "analysis/modes.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/allocator.h"
#include "base/check.h"
#include "base/handle.h"
#include "base/sized_struct.h"
#include "system/energy.h"
#include "system/owner.h"

DMB_DECLARE_STRUCT(dmb_modes_options)

#define DMB_TWO_PI 6.283185307179586477

/* Up to so many coordinates, or where a third of all modes is asked for, the dense way is the faster one. */
enum { DMB_DENSE_COORDINATES = 60, DMB_DENSE_SHARE = 3 };
enum { DMB_SCALE_MODES = 12 };
/* The last of the modes wanted is left out of the count, with those equal to it; a count that does not fit is tried
 * again. */
#define DMB_COUNT_MARGIN 1e-6
#define DMB_COUNT_NOISE 64.0
enum { DMB_COUNT_TRIES = 3 };
/* The inverse of a singular K that cannot be pinned is taken this many times the noise of its eigenvalues off 0. */
#define DMB_SHIFT_NOISE 1e5
/* A rigid-body mode: an eigenvalue of up to so much noise, and this part of the strain energy there could be. */
#define DMB_RIGID_NOISE 1e3
#define DMB_RIGID_STRAIN 1e-19
/* Rounding of d^H K d in units of its terms: their number is in the hundreds of thousands at most. */
#define DMB_SHARPEN_UNITS 64.0

/* ---- The store --------------------------------------------------------------------------------------------------- */

static size_t bytes_of(const dmb_modes *modes, uint32_t capacity, int32_t with_im)
{
    return ((size_t)capacity * 2 + (size_t)capacity * modes->rows * (with_im ? 2 : 1)) * sizeof(double) + capacity;
}

static void place(dmb_modes *modes, void *block, uint32_t capacity, int32_t with_im)
{
    modes->s = block;
    modes->re = modes->s + 2 * (size_t)capacity;
    modes->im = with_im ? modes->re + (size_t)capacity * modes->rows : NULL;
    modes->rigid = (uint8_t *)(modes->re + (size_t)capacity * modes->rows * (with_im ? 2 : 1));
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

static int32_t open_modes(const dmb_sim *sim, dmb_modes **modes)
{
    dmb_modes *m = dmb_allocate(&sim->allocator, sizeof *m);
    if (m == NULL) return DMB_ERR_NO_MEMORY;
    m->magic = DMB_HANDLE_MODES;
    m->allocator = sim->allocator;
    m->rows = sim->scene->row_count;
    m->state = dmb_state_copy(sim);
    if (m->state != NULL) {
        m->state->magic = DMB_HANDLE_SIM; /* queries look through it */
        dmb_model_hold(m->state->model);
    }
    *modes = m;
    return m->state != NULL ? DMB_OK : DMB_ERR_NO_MEMORY;
}

/* ---- A mode ------------------------------------------------------------------------------------------------------ */

static double dot(size_t n, const double *a, const double *b)
{
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

static double diagonal_of(const dmb_linear *linear, const dmb_linear_matrix *A, uint32_t node, uint32_t c)
{
    const dmb_block_layout *layout = &linear->scene.layout;
    return A->diagonal[layout->diag[node] + (layout->size[node] + 1) * c];
}

/* x + i y times the phase that makes its real part largest, over the root of d^H M d. */
static void normalise(const dmb_mode_search *search, double *x, double *y)
{
    const size_t n = search->linear->rows;
    double *Mx = search->work, *My = Mx + n, xx, yy = 0.0, xy = 0.0;
    dmb_linear_multiply(search->linear, &search->linear->mass, x, Mx);
    xx = dot(n, x, Mx);
    if (y != NULL) {
        dmb_linear_multiply(search->linear, &search->linear->mass, y, My);
        yy = dot(n, y, My);
        xy = dot(n, x, My);
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

/* Strain energy over what the elements would store if each end moved alone: 0 but for rounding in rigid motion. */
static double strain_ratio(const dmb_modes *modes, double *rows)
{
    const dmb_scene *scene = modes->state->scene;
    dmb_configuration moved = modes->state->now;
    double stored = 0.0, possible = 0.0;
    moved.velocity = rows;
    for (uint32_t e = 0; e < scene->element_count; e++) {
        const dmb_element_type *type = scene->types + scene->element_type[e];
        const uint32_t a = scene->element_node[e], step = scene->layout.size[a] == DMB_NODE_PATH ? 3 : 1;
        double rate[6];
        dmb_element_strain_rate(scene, &moved, e, rate);
        for (uint32_t i = 0; i < 6; i++) stored += type->stiffness[i] * rate[i] * rate[i];
        for (uint32_t i = 0; i < scene->layout.size[a]; i++) {
            const double z = rows[scene->layout.row[a] + i];
            possible += type->stiffness[(size_t)i * step] * z * z;
        }
    }
    return possible > 0.0 ? stored / possible : 0.0;
}

static double strain_energy(const dmb_modes *modes, double *rows)
{
    dmb_configuration moved = modes->state->now;
    double sum = 0.0;
    moved.velocity = rows;
    for (uint32_t e = 0; e < modes->state->scene->element_count; e++) {
        const dmb_element_type *type = modes->state->scene->types + modes->state->scene->element_type[e];
        double rate[6];
        dmb_element_strain_rate(modes->state->scene, &moved, e, rate);
        for (int i = 0; i < 6; i++) sum += 0.5 * type->stiffness[i] * rate[i] * rate[i];
    }
    return sum;
}

int dmb_modes_is_rigid(const dmb_mode_search *search, double re, double im, double *x, double *y)
{
    const dmb_modes *modes = search->modes;
    if (re * re + im * im > DMB_RIGID_NOISE * search->noise) return 0;
    return strain_ratio(modes, x) <= DMB_RIGID_STRAIN && (y == NULL || strain_ratio(modes, y) <= DMB_RIGID_STRAIN);
}

/* d^H K d is the strain energy twice where there is neither preload nor wall nor spring, and then the energy is the
 * sharper of the two: its terms are squares of small differences, those of K d cancel. With n elements to a bending
 * wave K d keeps eps n^4 of it, the energy eps n^2. It is taken where the two differ by the rounding of K d alone. */
double dmb_modes_sharpen(const dmb_mode_search *search, double square, double *x)
{
    const dmb_linear *linear = search->linear;
    double terms = 0.0;
    for (uint32_t i = 0; i < linear->scene.node_count; i++)
        for (uint32_t c = 0; c < linear->scene.layout.size[i]; c++) {
            const double z = x[linear->scene.layout.row[i] + c];
            terms += fabs(diagonal_of(linear, &linear->stiffness, i, c)) * z * z;
        }
    const double twice = 2.0 * strain_energy(search->modes, x);
    return fabs(square - twice) <= DMB_SHARPEN_UNITS * DBL_EPSILON * terms ? twice : square;
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

/* ---- Order ------------------------------------------------------------------------------------------------------- */

static double modulus(const dmb_modes *modes, uint32_t i)
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

static void exchange(dmb_modes *modes, uint32_t i, uint32_t j)
{
    const size_t rows = modes->rows;
    const uint8_t rigid = modes->rigid[i];
    modes->rigid[i] = modes->rigid[j];
    modes->rigid[j] = rigid;
    swap(modes->s + 2 * (size_t)i, modes->s + 2 * (size_t)j, 2);
    swap(modes->re + rows * i, modes->re + rows * j, rows);
    if (modes->im != NULL) swap(modes->im + rows * i, modes->im + rows * j, rows);
}

void dmb_modes_sort(dmb_modes *modes, uint32_t keep)
{
    for (uint32_t i = 0; i < modes->count && i < keep; i++) {
        uint32_t least = i;
        for (uint32_t j = i + 1; j < modes->count; j++)
            if (modulus(modes, j) < modulus(modes, least)) least = j;
        if (least != i) exchange(modes, i, least);
    }
    if (modes->count > keep) modes->count = keep;
}

static void keep_band(dmb_modes *modes, double low, double high)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < modes->count; i++) {
        const double f = modulus(modes, i) / DMB_TWO_PI;
        if (f < low || f > high) continue;
        if (kept != i) exchange(modes, kept, i);
        kept++;
    }
    modes->count = kept;
}

/* ---- Search ------------------------------------------------------------------------------------------------------ */

static void measure(dmb_mode_search *search)
{
    const dmb_linear *linear = search->linear;
    const dmb_block_layout *layout = &linear->scene.layout;
    double most = 0.0;
    for (uint32_t i = 0; i < layout->n; i++)
        for (uint32_t c = 0; c < layout->size[i]; c++) {
            const double m = diagonal_of(linear, &linear->mass, i, c);
            if (m > 0.0) most = fmax(most, fabs(diagonal_of(linear, &linear->stiffness, i, c)) / m);
        }
    search->noise = DBL_EPSILON * most;
    search->modes->info.unbalance = linear->unbalance;
    search->modes->info.coordinates = linear->coordinates;
    search->modes->info.asymmetry = dmb_linear_asymmetry(linear, &linear->stiffness, search->work);
    search->general =
        search->options->kind == DMB_MODES_DAMPED || !(search->modes->info.asymmetry <= DMB_MODES_ASYMMETRY);
}

static int is_dense(const dmb_mode_search *search, uint32_t wanted)
{
    const uint32_t n = search->linear->coordinates;
    return search->options->select == DMB_MODES_ALL || n <= DMB_DENSE_COORDINATES || wanted > n / DMB_DENSE_SHARE;
}

/* Rigid-body motions, where K is singular by them alone and they are free of damping. */
static int32_t set_rigid_apart(dmb_mode_search *search)
{
    if (!(search->modes->info.asymmetry <= DMB_MODES_ASYMMETRY)) return DMB_OK;
    const int32_t found = dmb_modes_pin(search);
    if (found <= 0) return found;
    search->pinned = search->options->kind == DMB_MODES_UNDAMPED || dmb_modes_rigid_undamped(search);
    if (!search->pinned) dmb_modes_forget_rigid(search);
    return DMB_OK;
}

/* Some of the lowest modes with a shift that is small for sure, and so not sharp: the lowest |s|^2 that is not noise,
 * or 0. */
static int32_t find_scale(dmb_mode_search *search, double *square)
{
    const uint32_t n = search->linear->coordinates;
    const double away = DMB_SHIFT_NOISE * search->noise;
    search->shift = search->general ? sqrt(away) : -away;
    *square = 0.0;
    const int32_t status = dmb_modes_sparse(search, n < DMB_SCALE_MODES ? n : DMB_SCALE_MODES);
    for (uint32_t i = 0; i < search->modes->count && status >= 0; i++) {
        const double here = modulus(search->modes, i) * modulus(search->modes, i);
        if (here > DMB_RIGID_NOISE * search->noise && (*square == 0.0 || here < *square)) *square = here;
    }
    search->modes->count = 0;
    return status;
}

/* No shift where K is regular or pinned; else a real one off the eigenvalues of a stable system, as far as the lowest
 * of them that is not 0. */
static int32_t choose_shift(dmb_mode_search *search)
{
    dmb_block_weakest weakest = {(double)INFINITY, 0, 0};
    const int64_t bad = dmb_linear_factor(search->linear, 1.0, 0.0, 0.0, &weakest);
    int32_t status = set_rigid_apart(search);
    double square;
    if (status < 0 || search->pinned || (bad < 0 && !(weakest.ratio < DMB_MODES_LOOSE))) return status;
    if (is_dense(search, search->options->count)) return DMB_OK;
    status = find_scale(search, &square);
    if (status >= 0 && square > 0.0) search->shift = search->general ? sqrt(square) : -square;
    return status;
}

/* The eigenvalues 0 that rigid-body motions have among those found, twice where s is sought, give way to the motions
 * themselves: roots next to a double one are far off. */
static int32_t put_rigid(dmb_mode_search *search)
{
    dmb_modes *modes = search->modes;
    uint32_t roots = modes->info.dense ? (search->general ? 2 : 1) * search->rigid_count : 0;
    dmb_modes_sort(modes, modes->count);
    uint32_t first = 0;
    while (roots > 0 && first < modes->count) {
        const uint32_t here = search->general && modes->s[2 * first + 1] > 0.0 ? 2 : 1;
        roots -= here < roots ? here : roots;
        first++;
    }
    for (uint32_t i = first; i < modes->count; i++) exchange(modes, i - first, i);
    modes->count -= first;
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < search->rigid_count && status >= 0; i++) {
        status = dmb_modes_add(search, 0.0, 0.0, search->rigid + (size_t)modes->rows * i, NULL);
        if (status >= 0) modes->rigid[modes->count - 1] = 1;
    }
    return status;
}

/* How many modes of |s| below that of the last one wanted the search has missed, by the count of eigenvalues between
 * the negative and the positive square; nothing can be counted where those are noise, with joints or damping. */
static uint32_t missed(const dmb_mode_search *search)
{
    const dmb_modes *modes = search->modes;
    const uint32_t last = search->options->count - 1, apart = search->rigid_count;
    if (last < apart || modes->count <= last - apart) return 0;
    const double size = modulus(modes, last - apart);
    const double square = size * size * (1.0 - DMB_COUNT_MARGIN) - DMB_COUNT_NOISE * search->noise;
    if (search->general || search->linear->scene.cluster_count) return 0;
    if (!(square > DMB_RIGID_NOISE * search->noise)) return 0;
    uint32_t found = apart;
    for (uint32_t i = 0; i < modes->count; i++) found += modulus(modes, i) * modulus(modes, i) < square;
    const uint32_t there =
        dmb_linear_count_below(search->linear, square) - dmb_linear_count_below(search->linear, -square);
    return there > found ? there - found : 0;
}

/* The search makes sure of what it finds; the count is a second witness. Where they still differ after some more modes
 * were sought, an eigenvalue stands at the edge of the count. */
static int32_t find_lowest(dmb_mode_search *search)
{
    uint32_t wanted = search->options->count;
    if (is_dense(search, wanted)) return dmb_modes_dense(search);
    for (int tries = 1;; tries++) {
        const int32_t status = dmb_modes_sparse(search, wanted);
        if (status < 0) return status;
        dmb_modes_sort(search->modes, search->modes->count);
        const uint32_t more = missed(search);
        if (more == 0 || tries == DMB_COUNT_TRIES) return DMB_OK;
        wanted += more + 2;
        search->modes->count = 0;
        if (is_dense(search, wanted)) return dmb_modes_dense(search);
        dmb_modes_forget_rigid(search);
        const int32_t again = choose_shift(search); /* the count has taken the factors */
        if (again < 0) return again;
    }
}

/* Whether the modes found reach beyond the band: what lies nearest the shift is complete. */
static int covers_band(const dmb_mode_search *search, double low, double high)
{
    double farthest = 0.0;
    for (uint32_t i = 0; i < search->modes->count; i++) {
        const double size = modulus(search->modes, i), square = size * size;
        farthest = fmax(farthest, search->general ? size : fabs(square - search->shift));
    }
    if (search->general) return farthest > DMB_TWO_PI * high;
    const double edge = DMB_TWO_PI * high, other = DMB_TWO_PI * low;
    return farthest > fmax(fabs(edge * edge - search->shift), fabs(other * other - search->shift));
}

/* In a band above 0 the shift stands in its middle, unless the problem is general: a real shift stays at 0. */
static int32_t find_band(dmb_mode_search *search)
{
    const double low = search->options->band[0], high = search->options->band[1];
    if (low > 0.0 && !search->general) {
        search->shift = 0.5 * DMB_TWO_PI * DMB_TWO_PI * (low * low + high * high);
        search->pinned = 0; /* the rigid-body motions stay apart */
    }
    for (uint32_t wanted = 16;; wanted *= 2) {
        search->modes->count = 0;
        if (is_dense(search, wanted)) return dmb_modes_dense(search);
        const int32_t status = dmb_modes_sparse(search, wanted);
        if (status < 0 || covers_band(search, low, high)) return status;
    }
}

/* ---- Residual ---------------------------------------------------------------------------------------------------- */

/* out += (a + i b) A (x + i y), real and imaginary part */
typedef struct complex_rows {
    double *re, *im, *product;
} complex_rows;

static void add_product(const dmb_linear *linear, const dmb_linear_matrix *A, double a, double b, const double *d,
                        int imaginary, const complex_rows *out)
{
    dmb_linear_multiply(linear, A, d, out->product);
    for (uint32_t i = 0; i < linear->rows; i++) {
        out->re[i] += (imaginary ? -b : a) * out->product[i];
        out->im[i] += (imaginary ? a : b) * out->product[i];
    }
}

static double norm_of_terms(const dmb_linear *linear, const double *x, double square)
{
    const dmb_block_layout *layout = &linear->scene.layout;
    double sum = 0.0;
    for (uint32_t i = 0; i < layout->n; i++)
        for (uint32_t c = 0; c < layout->size[i]; c++) {
            const double k = fabs(diagonal_of(linear, &linear->stiffness, i, c));
            const double m = diagonal_of(linear, &linear->mass, i, c), z = x[layout->row[i] + c];
            sum += (k + square * m) * (k + square * m) * z * z;
        }
    return sum;
}

static double residual_of(const dmb_mode_search *search, uint32_t k)
{
    const dmb_linear *linear = search->linear;
    const size_t rows = linear->rows;
    const complex_rows out = {search->work, search->work + rows, search->work + 2 * rows};
    const double *s = search->modes->s + 2 * (size_t)k;
    double left = 0.0, terms = 0.0;
    memset(out.re, 0, 2 * rows * sizeof(double));
    for (int imaginary = 0; imaginary < (search->modes->im != NULL ? 2 : 1); imaginary++) {
        const double *d = (imaginary ? search->modes->im : search->modes->re) + rows * k;
        add_product(linear, &linear->stiffness, 1.0, 0.0, d, imaginary, &out);
        add_product(linear, &linear->mass, s[0] * s[0] - s[1] * s[1], 2.0 * s[0] * s[1], d, imaginary, &out);
        if (search->options->kind == DMB_MODES_DAMPED)
            add_product(linear, &linear->damping, s[0], s[1], d, imaginary, &out);
        terms += norm_of_terms(linear, d, s[0] * s[0] + s[1] * s[1]);
    }
    for (int imaginary = 0; imaginary < 2; imaginary++) {
        double *g = search->work + 3 * rows;
        dmb_linear_restrict(linear, imaginary ? out.im : out.re, g);
        left += dot(linear->coordinates, g, g);
    }
    return terms > 0.0 ? sqrt(left / terms) : 0.0;
}

/* ---- The call ---------------------------------------------------------------------------------------------------- */

static int32_t take_options(const dmb_modes_options *given, dmb_modes_options *out, dmb_message *message)
{
    dmb_check check = dmb_check_of(message, "modes options", DMB_NO_INDEX);
    (void)dmb_modes_options_init(out, (uint32_t)sizeof *out);
    if (given != NULL) {
        const int32_t status = dmb_modes_options_read(out, given);
        if (status < 0) {
            dmb_message_set(message, "modes options: struct_size is not one this library knows");
            return status;
        }
    }
    dmb_check_choice(&check, "kind", out->kind, DMB_MODES_UNDAMPED, DMB_MODES_DAMPED);
    dmb_check_choice(&check, "select", out->select, DMB_MODES_LOWEST, DMB_MODES_BAND);
    dmb_check_count(&check, "count", out->count, 1, UINT32_MAX - 1);
    dmb_check_within(&check, "band[0]", out->band[0], 0.0, 1e12);
    dmb_check_above_field(&check, "band[1]", out->band[1], "band[0]", out->band[0]);
    dmb_check_within(&check, "band[1]", out->band[1], 0.0, 1e12);
    dmb_check_choice(&check, "contact", out->contact, DMB_CONTACT_AS_IS, DMB_CONTACT_CLOSED);
    dmb_check_choice(&check, "friction", out->friction, 0, 1);
    dmb_check_within(&check, "contact_gap", out->contact_gap, 0.0, 1e6);
    dmb_check_above(&check, "equilibrium_tolerance", out->equilibrium_tolerance, 0.0);
    return check.status;
}

static int32_t check_balance(const dmb_mode_search *search)
{
    const dmb_linear *linear = search->linear;
    const double allowed = search->options->equilibrium_tolerance;
    if (linear->unbalance <= allowed || (linear->balanced && allowed >= DMB_LINEAR_BALANCED)) return DMB_OK;
    const dmb_owner owner = dmb_owner_of_node(&linear->scene, linear->largest_node);
    dmb_message_set(
        search->message,
        "modes: the state is no equilibrium: residual = %g of the forces, must be <= %g; up to %g N at %s %u, "
        "pipe %u",
        linear->unbalance, allowed, linear->largest_force, owner.kind, owner.index, owner.pipe);
    return DMB_ERR_VALUE;
}

static int32_t check_count(const dmb_mode_search *search)
{
    const uint32_t n = search->linear->coordinates, count = search->options->count;
    if (n == 0) {
        dmb_message_set(search->message, "modes: the scene has no coordinates that are free to move");
        return DMB_ERR_VALUE;
    }
    if (search->options->select != DMB_MODES_LOWEST || count <= n) return DMB_OK;
    dmb_message_set(search->message, "modes options: count = %u, must be <= %u, the number of coordinates", count, n);
    return DMB_ERR_VALUE;
}

static int32_t find(dmb_mode_search *search)
{
    const dmb_modes_options *options = search->options;
    int32_t status = choose_shift(search);
    if (status >= 0)
        status = options->select == DMB_MODES_LOWEST ? find_lowest(search)
                 : options->select == DMB_MODES_ALL  ? dmb_modes_dense(search)
                                                     : find_band(search);
    if (status >= 0 && search->rigid_count > 0) status = put_rigid(search);
    if (status == DMB_ERR_NO_CONVERGENCE) dmb_message_set(search->message, "modes: the eigenvalues did not converge");
    return status;
}

/* The ones asked for, in order, and what is told about all of them. */
static int32_t finish(dmb_mode_search *search)
{
    const dmb_modes_options *options = search->options;
    dmb_modes *modes = search->modes;
    if (options->select == DMB_MODES_BAND) keep_band(modes, options->band[0], options->band[1]);
    dmb_modes_sort(modes, options->select == DMB_MODES_LOWEST ? options->count : modes->count);
    if (modes->count == 0) {
        dmb_message_set(search->message, "modes options: no mode in band = %g .. %g Hz", options->band[0],
                        options->band[1]);
        return DMB_ERR_VALUE;
    }
    modes->info.count = modes->count;
    for (uint32_t k = 0; k < modes->count; k++) {
        modes->info.rigid += modes->rigid[k];
        modes->info.residual = fmax(modes->info.residual, residual_of(search, k));
    }
    return DMB_OK;
}

static int32_t search_modes(dmb_mode_search *search)
{
    int32_t status = check_balance(search);
    if (status >= 0) status = check_count(search);
    if (status < 0) return status;
    measure(search);
    status = find(search);
    return status < 0 ? status : finish(search);
}

static int32_t analyse(const dmb_sim *sim, const dmb_modes_options *options, dmb_message *message, dmb_modes *modes)
{
    const dmb_linear_options how = {options->contact, !options->friction, options->contact_gap};
    const size_t bytes = 6 * (size_t)modes->rows * sizeof(double);
    dmb_mode_search search;
    memset(&search, 0, sizeof search);
    search.options = options;
    search.modes = modes;
    search.message = message;
    int32_t status = dmb_linear_make(sim, &how, &search.linear);
    if (status < 0) return status;
    search.work = dmb_allocate(&modes->allocator, bytes);
    status = search.work != NULL ? search_modes(&search) : DMB_ERR_NO_MEMORY;
    if (search.rigid != NULL) dmb_modes_forget_rigid(&search);
    dmb_release(&modes->allocator, search.work, bytes);
    dmb_linear_release(&search.linear);
    return status;
}

int32_t dmb_analysis_modes(dmb_sim *sim, const dmb_modes_options *options, dmb_modes **modes)
{
    dmb_modes_options taken;
    if (modes == NULL) return DMB_ERR_NULL;
    *modes = NULL;
    if (sim == NULL) return DMB_ERR_NULL;
    if (!dmb_handle_is(sim, DMB_HANDLE_SIM)) return DMB_ERR_HANDLE;
    dmb_message_clear(&sim->message);
    int32_t status = take_options(options, &taken, &sim->message);
    if (status >= 0) status = open_modes(sim, modes);
    if (status >= 0) status = analyse(sim, &taken, &sim->message, *modes);
    if (status < 0) dmb_modes_destroy(modes);
    return status;
}
