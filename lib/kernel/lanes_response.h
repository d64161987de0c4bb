/* Chains of the dynamic stiffness A(w) = (1 + i eta) K + i w C - w^2 M, frequencies side by side, with D_i, U_i and L_i
 * the blocks of A:
 *
 *     W_i = D_i^-1 U_i,  b_i <- D_i^-1 b_i,   D_{i+1} -= L_i W_i,  b_{i+1} -= L_i b_i;   backwards  b_i -= W_i b_{i+1}
 *
 * in the operations of math/complex_sparse and with its row pivoting, of each lane its own: a frequency gets the same
 * bits alone, in any group and in any width. D and L are never stored: both are made of M, C and K where they are
 * needed. */
#ifndef DMB_KERNEL_LANES_RESPONSE_H
#define DMB_KERNEL_LANES_RESPONSE_H

#include <string.h>

#include "kernel/kernels.h"
#include "kernel/lane_group.h"
#include "math/block_kernel.h"

typedef struct lane_complex {
    dmb_real re, im;
} lane_complex;

/* Frequencies of one call that are computed side by side, one in each lane. */
typedef struct response_lanes {
    dmb_real omega, square;    /* [rad/s], [rad2/s2] */
    double structural_damping; /* [-] eta */
    uint32_t columns, stride;  /* right-hand sides, and their capacity */
    double *sides;             /* first number of these frequencies */
    uint32_t bad;              /* one bit for each lane where a pivot is too small */
    uint32_t reserved;
    const dmb_response_args *args; /* of a chain without joints */
} response_lanes;

/* Rows of block i: of D_i, of U_i, and of the right-hand sides, in place. */
typedef struct response_rows {
    lane_complex D[LANES_BLOCK], U[LANES_BLOCK];
    double *sides;
} response_rows;

/* ---- Complex numbers --------------------------------------------------------------------------------------------- */

DMB_LANES_INLINE lane_complex complex_times(lane_complex f, lane_complex x)
{
    const lane_complex product = {f.re * x.re - f.im * x.im, f.re * x.im + f.im * x.re};
    return product;
}

DMB_LANES_INLINE void complex_subtract(lane_complex f, lane_complex x, lane_complex *y)
{
    y->re = y->re - (f.re * x.re - f.im * x.im);
    y->im = y->im - (f.re * x.im + f.im * x.re);
}

/* 1/(a + i b) (Smith 1962) */
DMB_LANES_INLINE lane_complex complex_inverse(lane_complex x)
{
    const dmb_mask steep = dmb_mask_less(dmb_real_abs(x.re), dmb_real_abs(x.im));
    const dmb_real large = dmb_real_select(steep, x.im, x.re), small = dmb_real_select(steep, x.re, x.im);
    const dmb_real q = small / large, d = large + small * q, one = dmb_real_of(1.0);
    const lane_complex inverse = {dmb_real_select(steep, q, one) / d, -dmb_real_select(steep, one, q) / d};
    return inverse;
}

DMB_LANES_INLINE dmb_real complex_size(lane_complex x)
{
    return dmb_real_abs(x.re) + dmb_real_abs(x.im);
}

DMB_LANES_INLINE void complex_exchange(dmb_mask mask, lane_complex *x, lane_complex *y)
{
    const lane_complex a = *x, b = *y;
    x->re = dmb_real_select(mask, b.re, a.re);
    x->im = dmb_real_select(mask, b.im, a.im);
    y->re = dmb_real_select(mask, a.re, b.re);
    y->im = dmb_real_select(mask, a.im, b.im);
}

/* Entries of right-hand sides: all frequencies of the call, real parts before imaginary parts. */
DMB_LANES_INLINE lane_complex load_side(const double *from)
{
    lane_complex x;
    memcpy(&x.re, from, sizeof x.re);
    memcpy(&x.im, from + DMB_FREQUENCIES, sizeof x.im);
    return x;
}

DMB_LANES_INLINE void store_side(lane_complex x, double *to)
{
    memcpy(to, &x.re, sizeof x.re);
    memcpy(to + DMB_FREQUENCIES, &x.im, sizeof x.im);
}

/* Numbers of W, of the present lanes alone. */
DMB_LANES_INLINE void store_number(lane_complex x, size_t i, double *to)
{
    double *at = to + 2 * (size_t)DMB_REAL_LANES * i;
    memcpy(at, &x.re, sizeof x.re);
    memcpy(at + DMB_REAL_LANES, &x.im, sizeof x.im);
}

DMB_LANES_INLINE lane_complex load_number(const double *from, size_t i)
{
    const double *at = from + 2 * (size_t)DMB_REAL_LANES * i;
    lane_complex x;
    memcpy(&x.re, at, sizeof x.re);
    memcpy(&x.im, at + DMB_REAL_LANES, sizeof x.im);
    return x;
}

/* From a row of the right-hand sides to the next one, and the first number of a row. */
static inline size_t row_stride(const response_lanes *l)
{
    return 2 * (size_t)DMB_FREQUENCIES * l->stride;
}

static inline double *side_of(const response_lanes *l, uint32_t row)
{
    return l->sides + row_stride(l) * row;
}

static inline void set_frequencies(response_lanes *l, const double *omega)
{
    memcpy(&l->omega, omega, sizeof l->omega);
    l->square = l->omega * l->omega;
}

/* ---- One block --------------------------------------------------------------------------------------------------- */

DMB_BLOCK_KERNEL void assemble_block(const response_lanes *l, int count, const dmb_response_blocks *blocks, size_t at,
                                     lane_complex *A)
{
    const double *M = blocks->mass + at, *C = blocks->damping + at, *K = blocks->stiffness + at;
    const double eta = l->structural_damping;
    for (int e = 0; e < count; e++) {
        A[e].re = K[e] - l->square * M[e];
        A[e].im = l->omega * C[e] + eta * K[e];
    }
}

/* Constrained rows are identity. */
DMB_BLOCK_KERNEL void assemble_diagonal(const response_lanes *l, int n, uint32_t i, lane_complex *D)
{
    const dmb_block_layout *layout = l->args->layout;
    assemble_block(l, n * n, &l->args->diagonal, layout->diag[i], D);
    for (int k = 0; k < n; k++)
        if (!l->args->solved[layout->row[i] + (uint32_t)k]) D[n * k + k].re = dmb_real_of(1.0);
}

DMB_LANES_CALL void exchange_sides(const response_lanes *l, dmb_mask mask, double *x, double *y)
{
    for (uint32_t c = 0; c < l->columns; c++) {
        const size_t at = 2 * (size_t)DMB_FREQUENCIES * c;
        lane_complex a = load_side(x + at), b = load_side(y + at);
        complex_exchange(mask, &a, &b);
        store_side(a, x + at);
        store_side(b, y + at);
    }
}

/* Row of the largest entry of column k from row k on, of each lane, as a number; the first of them where some are
 * equal. */
DMB_BLOCK_KERNEL dmb_real pivot_row(int n, int k, const lane_complex *D)
{
    dmb_real most = complex_size(D[n * k + k]), found = dmb_real_of(k);
    for (int i = k + 1; i < n; i++) {
        const dmb_real size = complex_size(D[n * i + k]);
        const dmb_mask larger = dmb_mask_less(most, size);
        most = dmb_real_select(larger, size, most);
        found = dmb_real_select(larger, dmb_real_of(i), found);
    }
    return found;
}

/* Exchanges row k with the row of its pivot, a different row in each lane; usually no exchange is needed. */
DMB_BLOCK_KERNEL void invert_pivot(const response_lanes *l, int n, int m, int k, response_rows *r)
{
    const size_t next = row_stride(l);
    const dmb_real found = pivot_row(n, k, r->D);
    if (!dmb_mask_any(dmb_mask_less(dmb_real_of(k), found))) return;
    for (int i = k + 1; i < n; i++) {
        const dmb_mask mask = dmb_mask_at_most(found, dmb_real_of(i)) & dmb_mask_at_most(dmb_real_of(i), found);
        for (int j = k; j < n; j++) complex_exchange(mask, r->D + n * k + j, r->D + n * i + j);
        for (int j = 0; j < m; j++) complex_exchange(mask, r->U + m * k + j, r->U + m * i + j);
        exchange_sides(l, mask, r->sides + next * (size_t)k, r->sides + next * (size_t)i);
    }
}

/* Marks the lanes where a pivot is zero, not finite, or of rounding size compared with K and w^2 M. */
static inline void watch_pivot(response_lanes *l, double K, double M, lane_complex pivot, lane_complex inverse)
{
    const dmb_real size = complex_size(pivot), most = dmb_real_max(dmb_real_abs(inverse.re), dmb_real_abs(inverse.im));
    const dmb_mask holds =
        dmb_mask_at_most(dmb_real_of(DMB_BLOCK_PIVOT_MIN), size) & dmb_mask_at_most(size, dmb_real_of(DBL_MAX));
    const dmb_mask loose = dmb_mask_less(dmb_real_of(1.0), most * (K + l->square * M) * DMB_UNCONSTRAINED_PIVOT);
    l->bad |= dmb_mask_bits(dmb_mask_not(holds) | loose);
}

/* y -= f x of right-hand sides. */
static inline void subtract_sides(uint32_t columns, lane_complex f, const double *x, double *y)
{
    for (uint32_t c = 0; c < columns; c++) {
        const size_t at = 2 * (size_t)DMB_FREQUENCIES * c;
        lane_complex sum = load_side(y + at);
        complex_subtract(f, load_side(x + at), &sum);
        store_side(sum, y + at);
    }
}

static inline void scale_sides(uint32_t columns, lane_complex f, double *x)
{
    for (uint32_t c = 0; c < columns; c++) {
        const size_t at = 2 * (size_t)DMB_FREQUENCIES * c;
        store_side(complex_times(f, load_side(x + at)), x + at);
    }
}

/* U <- L^-1 U, b <- L^-1 b, with D = L R; R is left in D, the reciprocals of its diagonal in place of that. */
DMB_BLOCK_KERNEL void solve_lower(response_lanes *l, int n, int m, uint32_t i, response_rows *r)
{
    const uint32_t columns = l->columns;
    const size_t next = row_stride(l);
    const double *K = l->args->diagonal.stiffness + l->args->layout->diag[i];
    const double *M = l->args->diagonal.mass + l->args->layout->diag[i];
    lane_complex *D = r->D, *U = r->U;
    for (int k = 0; k < n; k++) {
        invert_pivot(l, n, m, k, r);
        const lane_complex inverse = complex_inverse(D[n * k + k]);
        watch_pivot(l, fabs(K[n * k + k]), fabs(M[n * k + k]), D[n * k + k], inverse);
        D[n * k + k] = inverse;
        for (int p = k + 1; p < n; p++) {
            const lane_complex f = complex_times(inverse, D[n * p + k]);
            for (int j = k + 1; j < n; j++) complex_subtract(f, D[n * k + j], D + n * p + j);
            for (int j = 0; j < m; j++) complex_subtract(f, U[m * k + j], U + m * p + j);
            subtract_sides(columns, f, r->sides + next * (size_t)k, r->sides + next * (size_t)p);
        }
    }
}

/* U <- R^-1 U, which is W, b <- R^-1 b. */
DMB_BLOCK_KERNEL void solve_upper(const response_lanes *l, int n, int m, response_rows *r, double *W)
{
    const uint32_t columns = l->columns;
    const size_t next = row_stride(l);
    for (int k = n - 1; k >= 0; k--) {
        lane_complex row[DMB_BLOCK_SIZE_MAX];
        for (int j = 0; j < m; j++) row[j] = r->U[m * k + j];
        for (int p = k + 1; p < n; p++) {
            for (int j = 0; j < m; j++) complex_subtract(r->D[n * k + p], r->U[m * p + j], row + j);
            subtract_sides(columns, r->D[n * k + p], r->sides + next * (size_t)p, r->sides + next * (size_t)k);
        }
        for (int j = 0; j < m; j++) {
            r->U[m * k + j] = complex_times(r->D[n * k + k], row[j]);
            store_number(r->U[m * k + j], (size_t)m * (size_t)k + (size_t)j, W);
        }
        scale_sides(columns, r->D[n * k + k], r->sides + next * (size_t)k);
    }
}

/* D_{i+1} -= L_i W_i, b_{i+1} -= L_i b_i; D is that of block i + 1. */
DMB_BLOCK_KERNEL void update_block(const response_lanes *l, int n, int m, uint32_t i, response_rows *r)
{
    const dmb_block_layout *layout = l->args->layout;
    const size_t next = row_stride(l);
    lane_complex L[LANES_BLOCK];
    assemble_diagonal(l, m, i + 1, r->D);
    assemble_block(l, m * n, &l->args->lower, layout->link[i], L);
    for (int p = 0; p < m; p++) {
        lane_complex row[DMB_BLOCK_SIZE_MAX];
        for (int j = 0; j < m; j++) row[j] = r->D[m * p + j];
        for (int c = 0; c < n; c++)
            for (int j = 0; j < m; j++) complex_subtract(L[n * p + c], r->U[m * c + j], row + j);
        for (int j = 0; j < m; j++) r->D[m * p + j] = row[j];
        double *side = side_of(l, layout->row[i + 1] + (uint32_t)p);
        for (int c = 0; c < n; c++) subtract_sides(l->columns, L[n * p + c], r->sides + next * (size_t)c, side);
    }
}

/* ---- The chain --------------------------------------------------------------------------------------------------- */

/* Block i, D of which is in `r`; m is the size of the next one, 0 at the end of the chain. */
DMB_BLOCK_KERNEL int forward_block(int n, int m, response_lanes *l, uint32_t i, response_rows *r)
{
    const dmb_block_layout *layout = l->args->layout;
    double *W = l->args->work + 2 * (size_t)DMB_REAL_LANES * (layout->link[i] - layout->link[l->args->first]);
    r->sides = side_of(l, layout->row[i]);
    assemble_block(l, n * m, &l->args->upper, layout->link[i], r->U);
    solve_lower(l, n, m, i, r);
    solve_upper(l, n, m, r, W);
    if (m > 0) update_block(l, n, m, i, r);
    return 0;
}

/* b_i -= W_i b_{i+1} */
DMB_BLOCK_KERNEL int backward_block(int n, int m, const response_lanes *l, uint32_t i)
{
    const dmb_block_layout *layout = l->args->layout;
    const uint32_t columns = l->columns;
    const double *W = l->args->work + 2 * (size_t)DMB_REAL_LANES * (layout->link[i] - layout->link[l->args->first]);
    const double *x = side_of(l, layout->row[i + 1]);
    double *b = side_of(l, layout->row[i]);
    for (uint32_t c = 0; c < columns; c++) {
        const size_t next = row_stride(l), at = 2 * (size_t)DMB_FREQUENCIES * c;
        lane_complex found[DMB_BLOCK_SIZE_MAX];
        for (int j = 0; j < m; j++) found[j] = load_side(x + next * (size_t)j + at);
        for (int p = 0; p < n; p++) {
            lane_complex sum = load_side(b + next * (size_t)p + at);
            for (int j = 0; j < m; j++)
                complex_subtract(load_number(W, (size_t)m * (size_t)p + (size_t)j), found[j], &sum);
            store_side(sum, b + next * (size_t)p + at);
        }
    }
    return 0;
}

static void response_chain(response_lanes *l)
{
    const dmb_block_layout *layout = l->args->layout;
    const uint32_t first = l->args->first, end = first + l->args->count;
    response_rows rows;
    assemble_diagonal(l, layout->size[first], first, rows.D);
    for (uint32_t i = first; i < end; i++) {
        const int n = layout->size[i], m = i + 1 < end ? layout->size[i + 1] : 0;
        (void)DMB_BLOCK_BY_SIZE(forward_block, n, m, l, i, &rows);
    }
    for (uint32_t i = end - 1; i-- > first;) {
        const int n = layout->size[i], m = layout->size[i + 1];
        (void)DMB_BLOCK_BY_SIZE(backward_block, n, m, l, i);
    }
}

static void responses(dmb_response_args *args)
{
    args->bad = 0;
    for (uint32_t lane = 0; lane < args->used; lane += DMB_REAL_LANES) {
        response_lanes l = {.structural_damping = args->structural_damping,
                            .columns = args->columns,
                            .stride = args->stride,
                            .sides = args->sides + lane,
                            .args = args};
        set_frequencies(&l, args->omega + lane);
        response_chain(&l);
        args->bad |= l.bad << lane;
    }
    args->bad &= (1u << args->used) - 1;
}

#endif
