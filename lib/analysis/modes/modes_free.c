/* Modes without rigid-body motions: strain energy as a test of an eigenvalue, and pinned or projected motions. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "analysis/modes/modes.h"
#include "base/memory.h"
#include "element/beam.h"
#include "math/dense.h"
#include "system/assemble/energy.h"

/* Rounding of d^H K d in units of its terms, of which there are at most some hundred thousand. */
#define DMB_REFINE_UNITS 64.0

double dmb_modes_twice_strain_energy(const dmb_modes *modes, double *rows)
{
    dmb_configuration moved = modes->state->now;
    double sum = 0.0;
    moved.velocity = rows;
    for (uint32_t e = 0; e < modes->state->scene->element_count; e++) {
        const dmb_element_type *type = modes->state->scene->types + modes->state->scene->element_type[e];
        double rate[6];
        dmb_element_strain_rate(modes->state->scene, &moved, e, rate);
        for (int i = 0; i < 6; i++) sum += type->stiffness[i] * rate[i] * rate[i];
        sum += dmb_beam_cross_energy(type, rate);
    }
    return sum;
}

/* d^H K d is twice the strain energy if there is no preload, wall or spring, and then the energy is more accurate: its
 * terms are squares of small differences, those of K d cancel. With n elements per bending wave K d loses eps n^4 of
 * it, the energy eps n^2. The energy is used if the two differ by the rounding of K d alone. */
double dmb_modes_refine(const dmb_mode_search *search, double square, double *x)
{
    const dmb_linear *linear = search->linear;
    double terms = 0.0;
    for (uint32_t i = 0; i < linear->scene.node_count; i++)
        for (uint32_t c = 0; c < linear->scene.layout.size[i]; c++) {
            const double z = x[linear->scene.layout.row[i] + c];
            terms += linear->stiffness_size[linear->scene.layout.row[i] + c] * z * z;
        }
    const double twice = dmb_modes_twice_strain_energy(search->modes, x);
    return fabs(square - twice) <= DMB_REFINE_UNITS * DBL_EPSILON * terms ? twice : square;
}

/* Pinning of rigid-body motions: K with pins to the ground in as many rows as there are motions can be factored, and on
 * forces orthogonal to the motions (K + pins)^-1 is an inverse of K, so that no shift competes with the lowest
 * eigenvalues. The rows are those in which the motions r_i differ most, measured by mass, one after the other: (K +
 * pins) x = 0 means x . pins x = 0 as r_i . K = 0, so x is none of them. */

/* [-] C does not act on a motion if their product is below this fraction of its terms. */
#define DMB_UNDAMPED 1e-11

typedef struct pin {
    double *entry; /* entry of K */
    double before, stiffness;
} pin;

void dmb_modes_add_rigid(const dmb_mode_search *search, const double *from, const double *by, double *x)
{
    const size_t rows = search->linear->rows;
    for (uint32_t i = 0; search->apart && i < search->rigid_count; i++) {
        const double part = dmb_dot(rows, from + rows * i, x);
        for (size_t r = 0; r < rows; r++) x[r] -= part * by[rows * i + r];
    }
}

void dmb_modes_forget_rigid(dmb_mode_search *search)
{
    dmb_release(&search->linear->allocator, search->rigid, search->rigid_bytes);
    search->rigid = search->rigid_momentum = NULL;
    search->rigid_count = 0;
}

/* ---- Pins -------------------------------------------------------------------------------------------------------- */

/* Motions by rows, each row times the root of its mass; 0 in dependent rows. W: shape (rows, rigid_count). */
static void weigh_rows(const dmb_mode_search *search, double *W)
{
    const dmb_linear *linear = search->linear;
    const dmb_block_layout *layout = &linear->scene.layout;
    const size_t m = search->rigid_count, rows = linear->rows;
    memset(W, 0, rows * m * sizeof(double));
    for (uint32_t n = 0, i = 0; n < layout->n; n++)
        for (uint32_t k = 0; k < layout->size[n]; k++) {
            const uint32_t row = layout->row[n] + k;
            if (i == linear->coordinates || linear->row_of[i] != row) continue;
            const double weight = sqrt(fmax(dmb_linear_diagonal(linear, &linear->mass, n, k), 0.0));
            for (size_t j = 0; j < m; j++) W[m * row + j] = weight * search->rigid[rows * j + row];
            i++;
        }
}

/* Selects the longest row and projects its direction out of all rows. */
static uint32_t next_pin(size_t rows, size_t m, double *W, double *direction)
{
    size_t most = 0;
    double square = -1.0;
    for (size_t r = 0; r < rows; r++) {
        const double here = dmb_dot(m, W + m * r, W + m * r);
        if (here > square) square = here, most = r;
    }
    for (size_t j = 0; j < m; j++) direction[j] = W[m * most + j] / sqrt(square);
    for (size_t r = 0; r < rows; r++) {
        const double part = dmb_dot(m, W + m * r, direction);
        for (size_t j = 0; j < m; j++) W[m * r + j] -= part * direction[j];
    }
    return (uint32_t)most;
}

/* A pin has the magnitude of the diagonal entry, or that given by its mass. */
static void place_pin(const dmb_mode_search *search, uint32_t row, pin *p)
{
    const dmb_linear *linear = search->linear;
    const dmb_block_layout *layout = &linear->scene.layout;
    uint32_t low = 0, high = layout->n;
    while (high - low > 1) { /* the node of the row */
        const uint32_t middle = low + (high - low) / 2;
        *(layout->row[middle] <= row ? &low : &high) = middle;
    }
    const size_t at = layout->diag[low] + (size_t)(layout->size[low] + 1) * (row - layout->row[low]);
    p->entry = linear->stiffness.diagonal + at;
    p->before = *p->entry;
    p->stiffness = fabs(p->before);
    if (!(p->stiffness > 0.0)) p->stiffness = linear->mass.diagonal[at] * fmax(search->noise / DMB_NOISE, 1.0);
}

/* Factors K with pins; K itself is restored. */
static int64_t factor_pinned(dmb_mode_search *search, double *W)
{
    const size_t m = search->rigid_count, rows = search->linear->rows;
    double *direction = W + rows * m;
    pin *pins = (pin *)(void *)(direction + m);
    weigh_rows(search, W);
    for (size_t i = 0; i < m; i++) {
        place_pin(search, next_pin(rows, m, W, direction), pins + i);
        *pins[i].entry = pins[i].before + pins[i].stiffness;
    }
    dmb_block_weakest weakest;
    const int64_t bad = dmb_linear_factor(search->linear, 1.0, 0.0, 0.0, &weakest);
    for (size_t i = m; i-- > 0;) *pins[i].entry = pins[i].before;
    return bad >= 0 || weakest.ratio < DMB_UNCONSTRAINED_PIVOT ? 0 : -1;
}

int32_t dmb_modes_pin(dmb_mode_search *search)
{
    const size_t m = search->rigid_count, rows = search->linear->rows;
    const size_t bytes = (rows * m + m) * sizeof(double) + m * sizeof(pin);
    double *W = dmb_allocate(&search->linear->allocator, bytes);
    if (W == NULL) return DMB_ERR_NO_MEMORY;
    search->pinned = factor_pinned(search, W) < 0;
    dmb_release(&search->linear->allocator, W, bytes);
    return DMB_OK;
}
/* C r = 0 to rounding of its terms; r . C x vanishes for any x if C^T r does, which a few x verify. */
int dmb_modes_rigid_undamped(const dmb_mode_search *search)
{
    const dmb_linear *linear = search->linear;
    const dmb_block_layout *layout = &linear->scene.layout;
    const size_t rows = linear->rows;
    double *x = search->work, *y = x + rows;
    uint64_t seed = 3;
    for (uint32_t i = 0; i < search->rigid_count; i++) {
        const double *r = search->rigid + rows * i;
        double terms = 0.0, across = 0.0;
        dmb_linear_multiply(linear, &linear->damping, r, y);
        for (uint32_t n = 0; n < layout->n; n++)
            for (uint32_t c = 0; c < layout->size[n]; c++) {
                const uint32_t row = layout->row[n] + c;
                const double d = linear->damping.diagonal[layout->diag[n] + (layout->size[n] + 1) * c];
                terms += d * d * r[row] * r[row];
                seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
                x[row] = linear->scene.solved_row[row] ? ((seed >> 40 & 1) != 0 ? 1.0 : -1.0) : 0.0;
                across += d * d * x[row] * x[row];
            }
        if (dmb_dot(rows, y, y) > DMB_UNDAMPED * DMB_UNDAMPED * terms) return 0;
        dmb_linear_multiply(linear, &linear->damping, x, y);
        const double left = dmb_dot(rows, r, y);
        if (left * left > DMB_UNDAMPED * DMB_UNDAMPED * across * dmb_dot(rows, r, r)) return 0;
    }
    return 1;
}
