/* Double roots of one shape. If two roots s and their two shapes coincide (the straight motion of a free string in
 * rotating axes, a critically damped oscillator, the edge of flutter), rounding eta of the equations separates them by
 * the root of eta, in any direction of the plane: each has that error, with a residual of eta. Their mean does not
 * (Kato, Perturbation Theory for Linear Operators, II.2: the sum of a group of roots is smooth in the matrix), and
 * neither does the mean of their shapes (eq:modes.double):
 *
 *     s = s0 -+ d,   x = u -+ d w,   Q(s0) u = 0,   Q'(s0) u + Q(s0) w = 0,   Q(s0) (x1 + x2)/2 = O(d^2) = O(eta)
 *
 * Roots are therefore returned as their mean if their shapes are parallel and the residual of the mean is no larger
 * than theirs: the equations do not separate them. Roots that differ by more than rounding fail that test by d^2. A
 * pair near the real axis is two real roots: of its shape, or, if x and y are not parallel, of these two, if the
 * residual of each is no larger than that of the pair. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "analysis/modes/modes.h"
#include "base/memory.h"
#include "math/dense.h"

/* Roots are compared within this multiple of the root of their residual, |s| being 1. Roots that agree to this multiple
 * of the residual itself need no mean: equal roots of several shapes, which may be parallel by chance. */
#define DMB_DOUBLE_NEAR 16.0
#define DMB_DOUBLE_EQUAL 16.0
/* 1 - |cosine| of parallel shapes, and of equal shapes. */
#define DMB_DOUBLE_PARALLEL 0.05
#define DMB_DOUBLE_SAME 1e-10
/* Residual of the mean: largest multiple of the residual of the roots, plus rounding. */
#define DMB_DOUBLE_RESIDUAL 8.0
#define DMB_DOUBLE_ROUNDING (16.0 * DBL_EPSILON)

typedef struct joining {
    dmb_mode_search *search;
    double *x, *y;    /* sum of shapes, shape (rows) */
    double *residual; /* [-] of each mode, shape (count) */
    double *near;     /* [1/s] radius of comparison, shape (count) */
    uint8_t *member;  /* 1: in the present group; 2: in a joined group, shape (count) */
    uint32_t count;   /* number of modes found */
    uint32_t weight;  /* number of roots in the group */
    double s[2];      /* [1/s] their sum */
    double most;      /* largest residual */
    double spread;    /* [1/s] largest distance from the first */
    double aslant;    /* largest 1 - abs(cosine) */
} joining;

/* x_i^H M x_j, or of their real parts alone. */
static void form(const dmb_mode_search *search, uint32_t i, uint32_t j, int real, double c[2])
{
    const dmb_modes *modes = search->modes;
    const size_t n = modes->rows;
    double *Mx = search->work, *My = Mx + n;
    const double *x = modes->re + n * i, *y = modes->im + n * i;
    dmb_linear_multiply(search->linear, &search->linear->mass, modes->re + n * j, Mx);
    c[0] = dmb_dot(n, x, Mx);
    c[1] = 0.0;
    if (real) return;
    dmb_linear_multiply(search->linear, &search->linear->mass, modes->im + n * j, My);
    c[0] += dmb_dot(n, y, My);
    c[1] = dmb_dot(n, x, My) - dmb_dot(n, y, Mx);
}

/* Adds mode j to the group, at a distance from its first root, its shape rotated by the phase of c. */
static void add_member(joining *g, uint32_t j, int real, double apart, const double c[2])
{
    const dmb_modes *modes = g->search->modes;
    const size_t n = modes->rows;
    const double *s = modes->s + 2 * (size_t)j, *x = modes->re + n * j, *y = modes->im + n * j;
    const uint32_t roots = real && s[1] > 0.0 ? 2 : 1; /* with its conjugate */
    const double size = hypot(c[0], c[1]), e[2] = {roots * c[0] / size, -(roots * c[1]) / size};
    for (size_t r = 0; r < n; r++) {
        g->x[r] += e[0] * x[r] - (real ? 0.0 : e[1] * y[r]);
        g->y[r] += real ? 0.0 : e[0] * y[r] + e[1] * x[r];
    }
    g->s[0] += roots * s[0];
    g->s[1] += real ? 0.0 : s[1];
    g->weight += roots;
    g->most = fmax(g->most, g->residual[j]);
    g->spread = fmax(g->spread, apart);
    g->member[j] = 1;
}

/* Collects the modes with roots near that of mode i and shapes parallel to its own. */
static void collect(joining *g, uint32_t i, int real)
{
    const dmb_modes *modes = g->search->modes;
    const double *a = modes->s + 2 * (size_t)i;
    memset(g->x, 0, 2 * (size_t)modes->rows * sizeof(double));
    g->s[0] = g->s[1] = g->most = g->spread = g->aslant = 0.0;
    g->weight = 0;
    for (uint32_t j = i; j < g->count; j++) {
        const double *b = modes->s + 2 * (size_t)j, reach = fmax(g->near[i], g->near[j]);
        double c[2];
        if (g->member[j] != 0 || modes->rigid[j] || (real && b[1] > g->near[j])) continue;
        const double apart = hypot(a[0] - b[0], real ? b[1] : a[1] - b[1]);
        if (apart > reach) continue;
        form(g->search, i, j, real, c);
        if (!(1.0 - hypot(c[0], c[1]) <= DMB_DOUBLE_PARALLEL)) continue;
        g->aslant = fmax(g->aslant, 1.0 - hypot(c[0], c[1]));
        add_member(g, j, real, apart, c);
    }
}

/* Stores the mean in place of each of its modes; for modes that represent a conjugate pair, once more at the end. */
static int32_t put_mean(joining *g, uint32_t mean)
{
    dmb_modes *modes = g->search->modes;
    const size_t n = modes->rows;
    uint32_t more = 0;
    int32_t status = DMB_OK;
    for (uint32_t j = 0; j < g->count; j++) {
        if (g->member[j] != 1) continue;
        const double *s = modes->s + 2 * (size_t)mean;
        more += s[1] == 0.0 && modes->s[2 * (size_t)j + 1] > 0.0;
        dmb_modes_put(g->search, j, s[0], s[1], modes->re + n * mean, s[1] > 0.0 ? modes->im + n * mean : NULL);
        g->member[j] = 2;
    }
    memcpy(g->x, modes->re + n * mean, n * sizeof(double));
    const double root = modes->s[2 * (size_t)mean];
    for (uint32_t k = 0; k < more && status >= 0; k++) status = dmb_modes_add(g->search, root, 0.0, g->x, NULL);
    return status;
}

/* 1: the group is one root. */
static int32_t join_group(joining *g, uint32_t i, int real)
{
    dmb_modes *modes = g->search->modes;
    int32_t status = DMB_OK;
    collect(g, i, real);
    const double equal = DMB_DOUBLE_EQUAL * (g->most + DBL_EPSILON) * dmb_modes_size(modes, i);
    if (g->weight > 1 && (g->spread > equal || g->aslant <= DMB_DOUBLE_SAME)) {
        status = dmb_modes_add(g->search, g->s[0] / g->weight, g->s[1] / g->weight, g->x, real ? NULL : g->y);
        if (status < 0) return status;
        const uint32_t mean = --modes->count;
        if (dmb_modes_defect(g->search, mean).value <= DMB_DOUBLE_RESIDUAL * g->most + DMB_DOUBLE_ROUNDING) {
            modes->info.double_roots += g->weight;
            status = put_mean(g, mean);
            return status < 0 ? status : 1;
        }
    }
    for (uint32_t j = i; j < g->count; j++) g->member[j] &= 2;
    return 0;
}

/* 1: the pair, near the real axis, is two real roots of two shapes. */
static int32_t part_pair(joining *g, uint32_t i)
{
    dmb_modes *modes = g->search->modes;
    const size_t bytes = modes->rows * sizeof(double);
    const uint32_t first = modes->count, second = first + 1;
    const double root = modes->s[2 * (size_t)i], least = DMB_DOUBLE_RESIDUAL * g->residual[i] + DMB_DOUBLE_ROUNDING;
    memcpy(g->x, modes->re + modes->rows * (size_t)i, bytes);
    memcpy(g->y, modes->im + modes->rows * (size_t)i, bytes);
    if (!dmb_modes_are_two_shapes(g->search, g->y)) return 0;
    int32_t status = dmb_modes_add(g->search, root, 0.0, g->x, NULL);
    if (status >= 0) status = dmb_modes_add(g->search, root, 0.0, g->y, NULL);
    if (status < 0) return status;
    const int apart =
        dmb_modes_defect(g->search, first).value <= least && dmb_modes_defect(g->search, second).value <= least;
    if (apart) dmb_modes_exchange(modes, i, second);
    if (apart) g->member[i] = 2;
    modes->count = apart ? second : first;
    return apart;
}

static void measure(joining *g)
{
    const dmb_modes *modes = g->search->modes;
    for (uint32_t i = 0; i < g->count; i++) {
        g->residual[i] = dmb_modes_defect(g->search, i).value;
        g->near[i] = DMB_DOUBLE_NEAR * sqrt(g->residual[i] + DBL_EPSILON) * dmb_modes_size(modes, i);
    }
}

int32_t dmb_modes_join(dmb_mode_search *search)
{
    dmb_modes *modes = search->modes;
    const size_t rows = modes->rows, count = modes->count, bytes = (2 * rows + 2 * count) * sizeof(double) + count;
    const int damped = search->options->kind == DMB_MODES_DAMPED;
    joining g = {.search = search, .count = (uint32_t)count};
    int32_t status = DMB_OK;
    g.x = dmb_allocate(&search->linear->allocator, bytes);
    if (g.x == NULL) return DMB_ERR_NO_MEMORY;
    double *block = g.x;
    g.y = block + rows;
    g.residual = g.y + rows;
    g.near = g.residual + count;
    g.member = (uint8_t *)(g.near + count);
    memset(g.member, 0, count);
    measure(&g);
    for (uint32_t i = 0; i < count && status >= 0; i++) {
        if (modes->rigid[i] || g.member[i] != 0) continue;
        const double im = modes->s[2 * (size_t)i + 1];
        if (damped && im > 0.0 && im <= g.near[i]) status = part_pair(&g, i);
        if (status == 0 && damped && im <= g.near[i]) status = join_group(&g, i, 1);
        if (status == 0) status = join_group(&g, i, 0);
        status = status < 0 ? status : DMB_OK;
    }
    dmb_release(&search->linear->allocator, block, bytes);
    return status;
}
