/* Rigid-body motions of a scene whose stiffness is singular. Where elimination meets a pivot that is rounding, the
 * unknown is pinned to the ground by a spring, until K + pins can be factored. A force on one pin then moves the bodies
 * rigidly, the others staying where they are: these motions r_i are the kernel of K. On forces that they are orthogonal
 * to, (K + pins)^-1 is an inverse of K, and no shift has to compete with the lowest eigenvalues. */
#include <math.h>
#include <string.h>

#include "analysis/modes.h"
#include "base/allocator.h"
#include "math/dot.h"

enum { DMB_PINS_MAX = 24 };
/* A pivot this small against its block may be rounding, or the softness of a long string. */
#define DMB_WEAK 1e-11
/* What C makes of a motion it leaves alone, over its terms. */
#define DMB_UNDAMPED 1e-11

typedef struct pin {
    size_t at; /* in the diagonal storage of K */
    uint32_t row;
    uint32_t reserved;
    double stiffness;
} pin;

typedef struct pins {
    pin list[DMB_PINS_MAX];
    uint32_t count;
} pins;

static double *entry(const dmb_linear *linear, const pin *p)
{
    return linear->stiffness.diagonal + p->at;
}

/* Factors K with the pins; K itself is left as it was. */
static int64_t factor_pinned(dmb_linear *linear, const pins *all, dmb_block_weakest *weakest)
{
    double kept[DMB_PINS_MAX] = {0.0};
    for (uint32_t i = 0; i < all->count; i++) {
        kept[i] = *entry(linear, all->list + i);
        *entry(linear, all->list + i) += all->list[i].stiffness;
    }
    const int64_t bad = dmb_linear_factor(linear, 1.0, 0.0, 0.0, weakest);
    for (uint32_t i = all->count; i-- > 0;) *entry(linear, all->list + i) = kept[i];
    return bad;
}

static void add_pin(const dmb_linear *linear, const dmb_block_weakest *weakest, pins *all)
{
    const dmb_block_layout *layout = &linear->scene.layout;
    const uint32_t node = weakest->block, size = layout->size[node];
    const double *D = linear->stiffness.diagonal + layout->diag[node];
    pin *p = all->list + all->count++;
    p->at = layout->diag[node] + (size_t)(size + 1) * weakest->unknown;
    p->row = layout->row[node] + weakest->unknown;
    p->reserved = 0;
    p->stiffness = fabs(D[(size_t)(size + 1) * weakest->unknown]);
    for (size_t i = 0; p->stiffness == 0.0 && i < (size_t)size * size; i++) p->stiffness = fabs(D[i]);
    if (p->stiffness == 0.0) p->stiffness = 1.0; /* a body that nothing touches */
}

void dmb_modes_take_rigid(const dmb_mode_search *search, const double *from, const double *by, double *x)
{
    const size_t rows = search->linear->rows;
    for (uint32_t i = 0; i < search->rigid_count; i++) {
        const double part = dmb_dot(rows, from + rows * i, x);
        for (size_t r = 0; r < rows; r++) x[r] -= part * by[rows * i + r];
    }
}

/* The motion of a pin, orthogonal to those before; 0 if it is not rigid. */
static int take_motion(dmb_mode_search *search, const pin *p)
{
    dmb_linear *linear = search->linear;
    const size_t rows = linear->rows;
    double *x = search->rigid + rows * search->rigid_count, *Mx = search->rigid_momentum + rows * search->rigid_count;
    memset(x, 0, rows * sizeof(double));
    x[p->row] = p->stiffness;
    dmb_linear_solve(linear, x);
    for (int pass = 0; pass < 2; pass++) dmb_modes_take_rigid(search, search->rigid_momentum, search->rigid, x);
    dmb_linear_multiply(linear, &linear->mass, x, Mx);
    const double size = sqrt(dmb_dot(rows, x, Mx));
    if (!(size > 0.0) || !isfinite(size)) return 0;
    for (size_t r = 0; r < rows; r++) {
        x[r] /= size;
        Mx[r] /= size;
    }
    dmb_linear_multiply(linear, &linear->stiffness, x, search->work);
    const double square = fabs(dmb_dot(rows, x, search->work));
    if (!dmb_modes_is_rigid(search, sqrt(square), 0.0, x, NULL)) return 0;
    search->rigid_count++;
    return 1;
}

static int32_t reserve(dmb_mode_search *search, uint32_t count)
{
    const size_t rows = search->linear->rows;
    search->rigid_bytes = 2 * rows * count * sizeof(double);
    search->rigid = dmb_allocate(&search->linear->allocator, search->rigid_bytes);
    if (search->rigid == NULL) return DMB_ERR_NO_MEMORY;
    search->rigid_momentum = search->rigid + rows * count;
    return DMB_OK;
}

void dmb_modes_forget_rigid(dmb_mode_search *search)
{
    if (search->rigid != NULL) dmb_release(&search->linear->allocator, search->rigid, search->rigid_bytes);
    search->rigid = search->rigid_momentum = NULL;
    search->rigid_count = 0;
}

/* Pins wherever elimination meets a pivot that may be rounding. */
static void place_pins(dmb_linear *linear, pins *all)
{
    dmb_block_weakest weakest = {(double)INFINITY, 0, 0};
    for (all->count = 0; all->count < DMB_PINS_MAX;) {
        const int64_t bad = factor_pinned(linear, all, &weakest);
        if (bad < 0 && !(weakest.ratio < DMB_WEAK)) return;
        add_pin(linear, &weakest, all);
    }
}

/* Whether a force on each pin moves the bodies rigidly: what is only soft bends. */
static int all_are_rigid(dmb_mode_search *search, const pins *all)
{
    search->rigid_count = 0;
    if (factor_pinned(search->linear, all, NULL) >= 0) return 0;
    for (uint32_t i = 0; i < all->count; i++)
        if (!take_motion(search, all->list + i)) return 0;
    return 1;
}

int32_t dmb_modes_pin(dmb_mode_search *search)
{
    pins all;
    if (search->linear->scene.cluster_count) return 0;
    place_pins(search->linear, &all);
    if (all.count == 0 || all.count == DMB_PINS_MAX) return 0;
    const int32_t status = reserve(search, all.count);
    if (status < 0) return status;
    for (; all.count > 0; all.count--) /* the last ones were the least weak */
        if (all_are_rigid(search, &all)) return 1;
    dmb_modes_forget_rigid(search);
    return 0;
}

/* C r = 0 to rounding of its terms; r . C x vanishes for any x where C^T r does, which a few x tell. */
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
