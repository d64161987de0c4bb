/* Jointed chains of the dynamic stiffness in independent coordinates, frequencies side by side: block-sparse
 * elimination in the operations of math/complex_sparse and with its row pivoting, of each lane its own, so that a
 * frequency gets the same bits alone, in any group and in any width. With D = A_kk and the later blocks i, j that k is
 * coupled with,
 *
 *     W_kj = D^-1 A_kj,    A_ij -= A_ik W_kj,    b_k <- D^-1 b_k,  b_i -= A_ik b_k;   backwards  b_k -= W_kj b_j
 *
 * Blocks have any size; they are computed in strips of six columns, which fit into registers. */
#ifndef DMB_KERNEL_LANES_RESPONSE_JOINTED_H
#define DMB_KERNEL_LANES_RESPONSE_JOINTED_H

#include "kernel/lanes_response.h"

typedef struct jointed_lanes {
    response_lanes all;
    const dmb_jointed_response_args *args;
    double *pivots; /* of the present block: row exchanged with each row, in each lane */
} jointed_lanes;

enum { STRIP = 6 };

/* kernel(n, w, ...) of blocks of n rows and strips of w columns, with constants for the nodes of beams */
#define JOINTED_BY_SIZE(kernel, n, w, ...) \
    ((n) == 6 && (w) == STRIP ? kernel(6, STRIP, __VA_ARGS__) : kernel(n, w, __VA_ARGS__))

/* Number i of an array of the present lanes. */
static inline double *number_at(double *from, size_t i)
{
    return from + 2 * (size_t)DMB_REAL_LANES * i;
}

static inline double *block_at(const jointed_lanes *l, size_t offset)
{
    return number_at(l->args->work, offset);
}

/* Rows of the block at a position of the order of elimination, and the first row of its right-hand sides. */
static inline size_t size_at(const jointed_lanes *l, uint32_t position)
{
    return l->args->size[l->args->pattern->order[position]];
}

static inline double *sides_at(const jointed_lanes *l, uint32_t position)
{
    return side_of(&l->all, l->args->row[l->args->pattern->order[position]]);
}

/* ---- Pivots ------------------------------------------------------------------------------------------------------ */

/* Row of the largest entry of column k from row k on, of each lane, as a number; the first of them where some are
 * equal. */
static inline dmb_real largest_row(size_t n, size_t k, const double *D)
{
    dmb_real most = complex_size(load_number(D, n * k + k)), found = dmb_real_of((double)k);
    for (size_t i = k + 1; i < n; i++) {
        const dmb_real size = complex_size(load_number(D, n * i + k));
        const dmb_mask larger = dmb_mask_less(most, size);
        most = dmb_real_select(larger, size, most);
        found = dmb_real_select(larger, dmb_real_of((double)i), found);
    }
    return found;
}

static inline dmb_mask mask_of_row(dmb_real found, size_t i)
{
    const dmb_real row = dmb_real_of((double)i);
    return dmb_mask_at_most(found, row) & dmb_mask_at_most(row, found);
}

/* Exchanges row k of A (n x m) with the row found, a different one in each lane; usually no exchange is needed. */
static inline void exchange_rows(size_t n, size_t m, size_t k, dmb_real found, double *A)
{
    if (!dmb_mask_any(dmb_mask_less(dmb_real_of((double)k), found))) return;
    for (size_t i = k + 1; i < n; i++) {
        const dmb_mask mask = mask_of_row(found, i);
        for (size_t j = 0; j < m; j++) {
            lane_complex a = load_number(A, m * k + j), b = load_number(A, m * i + j);
            complex_exchange(mask, &a, &b);
            store_number(a, m * k + j, A);
            store_number(b, m * i + j, A);
        }
    }
}

static inline dmb_real load_pivot(const jointed_lanes *l, size_t k)
{
    return load_number(l->pivots, k).re;
}

static inline void exchange_block(const jointed_lanes *l, size_t n, size_t m, double *A)
{
    for (size_t k = 0; k < n; k++) exchange_rows(n, m, k, load_pivot(l, k), A);
}

static inline void exchange_rows_of_sides(const jointed_lanes *l, size_t n, double *b)
{
    const size_t next = row_stride(&l->all);
    for (size_t k = 0; k < n; k++) {
        const dmb_real found = load_pivot(l, k);
        if (!dmb_mask_any(dmb_mask_less(dmb_real_of((double)k), found))) continue;
        for (size_t i = k + 1; i < n; i++) exchange_sides(&l->all, mask_of_row(found, i), b + next * k, b + next * i);
    }
}

/* ---- One block --------------------------------------------------------------------------------------------------- */

/* row -= F W: F one row of n numbers, W rows of m numbers, of which the first w columns are read */
DMB_BLOCK_KERNEL void subtract_strip(size_t n, size_t w, const double *F, size_t m, const double *W, lane_complex *row)
{
    for (size_t p = 0; p < n; p++) {
        const lane_complex f = load_number(F, p);
        DMB_BLOCK_UNROLL
        for (size_t j = 0; j < w; j++) complex_subtract(f, load_number(W, m * p + j), row + j);
    }
}

/* Columns k + 1 .. n - 1 of row i -= f times those of row k. */
DMB_BLOCK_KERNEL void subtract_row(size_t n, size_t k, size_t i, lane_complex f, double *D)
{
    for (size_t j = k + 1; j < n; j++) {
        lane_complex sum = load_number(D, n * i + j);
        complex_subtract(f, load_number(D, n * k + j), &sum);
        store_number(sum, n * i + j, D);
    }
}

/* D = L R in place, the reciprocals of R's diagonal in place of that. first: coordinate of the first row */
DMB_BLOCK_KERNEL int factor_jointed(size_t n, size_t w, jointed_lanes *l, uint32_t first, double *D)
{
    (void)w;
    for (size_t k = 0; k < n; k++) {
        const lane_complex found = {largest_row(n, k, D), dmb_real_of(0.0)};
        store_number(found, k, l->pivots);
        exchange_rows(n, n, k, found.re, D);
        const lane_complex pivot = load_number(D, n * k + k), inverse = complex_inverse(pivot);
        watch_pivot(&l->all, l->args->stiffness[first + k], l->args->mass[first + k], pivot, inverse);
        store_number(inverse, n * k + k, D);
        for (size_t i = k + 1; i < n; i++) {
            const lane_complex f = complex_times(inverse, load_number(D, n * i + k));
            store_number(f, n * i + k, D);
            subtract_row(n, k, i, f, D);
        }
    }
    return 0;
}

/* w columns of W <- D^-1 W, W in rows of m numbers that were exchanged already */
DMB_BLOCK_KERNEL int solve_strip(size_t n, size_t w, size_t m, double *D, double *W)
{
    lane_complex row[STRIP] = {{dmb_real_of(0.0), dmb_real_of(0.0)}};
    for (size_t i = 1; i < n; i++) {
        DMB_BLOCK_UNROLL
        for (size_t j = 0; j < w; j++) row[j] = load_number(W, m * i + j);
        subtract_strip(i, w, number_at(D, n * i), m, W, row);
        DMB_BLOCK_UNROLL
        for (size_t j = 0; j < w; j++) store_number(row[j], m * i + j, W);
    }
    for (size_t i = n; i-- > 0;) {
        const lane_complex inverse = load_number(D, n * i + i);
        DMB_BLOCK_UNROLL
        for (size_t j = 0; j < w; j++) row[j] = load_number(W, m * i + j);
        subtract_strip(n - i - 1, w, number_at(D, n * i + i + 1), m, number_at(W, m * (i + 1)), row);
        DMB_BLOCK_UNROLL
        for (size_t j = 0; j < w; j++) store_number(complex_times(inverse, row[j]), m * i + j, W);
    }
    return 0;
}

/* Row i of A (p x m), w columns of it, -= that of L (p x n) times W (n x m); A and W in rows of m numbers */
DMB_BLOCK_KERNEL int update_strip(size_t n, size_t w, size_t m, const double *L, const double *W, double *A)
{
    lane_complex row[STRIP] = {{dmb_real_of(0.0), dmb_real_of(0.0)}};
    DMB_BLOCK_UNROLL
    for (size_t j = 0; j < w; j++) row[j] = load_number(A, j);
    subtract_strip(n, w, L, m, W, row);
    DMB_BLOCK_UNROLL
    for (size_t j = 0; j < w; j++) store_number(row[j], j, A);
    return 0;
}

static inline size_t strip_width(size_t m, size_t j)
{
    return m - j < STRIP ? m - j : STRIP;
}

/* W (n x m) <- D^-1 W */
static void solve_jointed_block(const jointed_lanes *l, size_t n, size_t m, double *D, double *W)
{
    exchange_block(l, n, m, W);
    for (size_t j = 0; j < m; j += STRIP) {
        const size_t w = strip_width(m, j);
        (void)JOINTED_BY_SIZE(solve_strip, n, w, m, D, number_at(W, j));
    }
}

/* A (p x m) -= L (p x n) W (n x m) */
static void update_jointed_block(size_t p, size_t n, size_t m, double *L, double *W, double *A)
{
    for (size_t j = 0; j < m; j += STRIP) {
        const size_t w = strip_width(m, j);
        for (size_t i = 0; i < p; i++)
            (void)JOINTED_BY_SIZE(update_strip, n, w, m, number_at(L, n * i), number_at(W, j), number_at(A, m * i + j));
    }
}

/* b <- D^-1 b of right-hand sides */
static void solve_jointed_sides(const jointed_lanes *l, size_t n, const double *D, double *b)
{
    const uint32_t columns = l->all.columns;
    const size_t next = row_stride(&l->all);
    exchange_rows_of_sides(l, n, b);
    for (size_t i = 1; i < n; i++)
        for (size_t j = 0; j < i; j++) subtract_sides(columns, load_number(D, n * i + j), b + next * j, b + next * i);
    for (size_t i = n; i-- > 0;) {
        for (size_t j = i + 1; j < n; j++)
            subtract_sides(columns, load_number(D, n * i + j), b + next * j, b + next * i);
        scale_sides(columns, load_number(D, n * i + i), b + next * i);
    }
}

/* y (p rows) -= A (p x n) x of right-hand sides */
static void update_jointed_sides(const jointed_lanes *l, size_t p, size_t n, const double *A, const double *x,
                                 double *y)
{
    const size_t next = row_stride(&l->all);
    for (size_t i = 0; i < p; i++)
        for (size_t j = 0; j < n; j++)
            subtract_sides(l->all.columns, load_number(A, n * i + j), x + next * j, y + next * i);
}

/* ---- The system -------------------------------------------------------------------------------------------------- */

static void assemble_jointed(const jointed_lanes *l)
{
    for (size_t e = 0; e < l->args->pattern->values; e++) {
        lane_complex A;
        assemble_block(&l->all, 1, &l->args->blocks, e, &A);
        store_number(A, e, l->args->work);
    }
}

/* A_ij -= A_ik W_kj for the later blocks i of entry a, and j of entry a and of each later entry, in both orders. */
static void update_from_entry(const jointed_lanes *l, size_t n, uint32_t a, uint32_t end)
{
    const dmb_block_pattern *pattern = l->args->pattern;
    const uint32_t i = pattern->later[a];
    const size_t p = size_at(l, i);
    double *L = block_at(l, pattern->lower[a]), *W = block_at(l, pattern->upper[a]);
    update_jointed_block(p, n, p, L, W, block_at(l, pattern->diagonal[i]));
    for (uint32_t b = a + 1; b < end; b++) {
        const uint32_t j = pattern->later[b], target = dmb_block_pattern_entry(pattern, i, j);
        const size_t q = size_at(l, j);
        update_jointed_block(p, n, q, L, block_at(l, pattern->upper[b]), block_at(l, pattern->upper[target]));
        update_jointed_block(q, n, p, block_at(l, pattern->lower[b]), W, block_at(l, pattern->lower[target]));
    }
}

/* Eliminates the block at position k, right-hand sides included. */
static void eliminate_jointed(jointed_lanes *l, uint32_t k)
{
    const dmb_block_pattern *pattern = l->args->pattern;
    const uint32_t begin = pattern->column[k], end = pattern->column[k + 1];
    const size_t n = size_at(l, k);
    double *D = block_at(l, pattern->diagonal[k]), *b = sides_at(l, k);
    /* NOLINTNEXTLINE(misc-redundant-expression): the macro compares both sizes of a block, which is square here */
    (void)JOINTED_BY_SIZE(factor_jointed, n, n, l, l->args->row[pattern->order[k]], D);
    solve_jointed_sides(l, n, D, b);
    for (uint32_t e = begin; e < end; e++) {
        const size_t m = size_at(l, pattern->later[e]);
        solve_jointed_block(l, n, m, D, block_at(l, pattern->upper[e]));
        update_jointed_sides(l, m, n, block_at(l, pattern->lower[e]), b, sides_at(l, pattern->later[e]));
    }
    for (uint32_t e = begin; e < end; e++) update_from_entry(l, n, e, end);
}

static void substitute_jointed(const jointed_lanes *l, uint32_t k)
{
    const dmb_block_pattern *pattern = l->args->pattern;
    for (uint32_t e = pattern->column[k]; e < pattern->column[k + 1]; e++)
        update_jointed_sides(l, size_at(l, k), size_at(l, pattern->later[e]), block_at(l, pattern->upper[e]),
                             sides_at(l, pattern->later[e]), sides_at(l, k));
}

static void jointed_responses(dmb_jointed_response_args *args)
{
    const uint32_t blocks = args->pattern->n;
    args->bad = 0;
    for (uint32_t lane = 0; lane < args->used; lane += DMB_REAL_LANES) {
        jointed_lanes l = {.all = {.structural_damping = args->structural_damping,
                                   .columns = args->columns,
                                   .stride = args->stride,
                                   .sides = args->sides + lane},
                           .args = args,
                           .pivots = number_at(args->work, args->pattern->values)};
        set_frequencies(&l.all, args->omega + lane);
        assemble_jointed(&l);
        for (uint32_t k = 0; k < blocks; k++) eliminate_jointed(&l, k);
        for (uint32_t k = blocks; k-- > 0;) substitute_jointed(&l, k);
        args->bad |= l.all.bad << lane;
    }
    args->bad &= (1u << args->used) - 1;
}

#endif
