/* Blocks of six rows, the size of element blocks, in vectors: a row is a vector of four numbers and one of two if the
 * compiler supports it, otherwise six numbers. Operations and their order are those of block_inverse.h for any size. */
#ifndef DMB_MATH_BLOCK_SIX_H
#define DMB_MATH_BLOCK_SIX_H

#include "math/block_rows.h"

/* A block D, the off-diagonal blocks that couple its rows to its neighbour (U) and the neighbour's to it (L), and D of
 * the neighbour. */
typedef struct block_parts {
    double *D, *U, *L, *next;
} block_parts;

/* ---- Rows -------------------------------------------------------------------------------------------------------- */

#if defined(DMB_LANES) && defined(__has_builtin)
#if DMB_LANES >= 4 && __has_builtin(__builtin_shufflevector)
#define DMB_BLOCK_SIX_VECTORS
#endif
#endif

#ifdef DMB_BLOCK_SIX_VECTORS

typedef double six_four __attribute__((vector_size(32)));
typedef double six_two __attribute__((vector_size(16)));
typedef double six_four_anywhere __attribute__((vector_size(32), aligned(8)));
typedef double six_two_anywhere __attribute__((vector_size(16), aligned(8)));
typedef int64_t six_four_bits __attribute__((vector_size(32)));
typedef int64_t six_two_bits __attribute__((vector_size(16)));
typedef six_four six_number; /* the same number four times */
typedef struct six_row {
    six_four a;
    six_two b;
} six_row;

DMB_BLOCK_KERNEL six_row six_load(const double *from)
{
    const six_row x = {*(const six_four_anywhere *)from, *(const six_two_anywhere *)(from + 4)};
    return x;
}
DMB_BLOCK_KERNEL void six_store(six_row x, double *to)
{
    *(six_four_anywhere *)to = x.a;
    *(six_two_anywhere *)(to + 4) = x.b;
}
DMB_BLOCK_KERNEL six_number six_of(double x)
{
    const six_number all = {x, x, x, x};
    return all;
}
DMB_BLOCK_KERNEL six_two six_half(six_number x)
{
    return __builtin_shufflevector(x, x, 0, 1);
}
/* Number k of a row. */
DMB_BLOCK_KERNEL six_number six_spread(six_row x, int k)
{
    return k == 0   ? __builtin_shufflevector(x.a, x.a, 0, 0, 0, 0)
           : k == 1 ? __builtin_shufflevector(x.a, x.a, 1, 1, 1, 1)
           : k == 2 ? __builtin_shufflevector(x.a, x.a, 2, 2, 2, 2)
           : k == 3 ? __builtin_shufflevector(x.a, x.a, 3, 3, 3, 3)
           : k == 4 ? __builtin_shufflevector(x.b, x.b, 0, 0, 0, 0)
                    : __builtin_shufflevector(x.b, x.b, 1, 1, 1, 1);
}
DMB_BLOCK_KERNEL double six_number_at(six_row x, int k)
{
    return k < 4 ? x.a[k & 3] : x.b[k & 1];
}
/* f x, y + f x, y - f x, x + y, x - y */
DMB_BLOCK_KERNEL six_row six_times(six_number f, six_row x)
{
    const six_row out = {f * x.a, six_half(f) * x.b};
    return out;
}
DMB_BLOCK_KERNEL six_row six_plus(six_row x, six_row y)
{
    const six_row out = {x.a + y.a, x.b + y.b};
    return out;
}
DMB_BLOCK_KERNEL six_row six_minus(six_row x, six_row y)
{
    const six_row out = {x.a - y.a, x.b - y.b};
    return out;
}
/* The row with number k replaced by 0, or by 1. */
DMB_BLOCK_KERNEL six_row six_with(six_row x, int k, int one)
{
    static const int64_t keep[6][6] = {{0, -1, -1, -1, -1, -1}, {-1, 0, -1, -1, -1, -1}, {-1, -1, 0, -1, -1, -1},
                                       {-1, -1, -1, 0, -1, -1}, {-1, -1, -1, -1, 0, -1}, {-1, -1, -1, -1, -1, 0}};
    static const double unit[6][6] = {{1, 0, 0, 0, 0, 0}, {0, 1, 0, 0, 0, 0}, {0, 0, 1, 0, 0, 0},
                                      {0, 0, 0, 1, 0, 0}, {0, 0, 0, 0, 1, 0}, {0, 0, 0, 0, 0, 1}};
    if (k < 4) {
        const six_four_bits kept = (six_four_bits)x.a & (six_four_bits)six_load((const double *)keep[k]).a;
        x.a = (six_four)(one ? kept | (six_four_bits)six_load(unit[k]).a : kept);
    } else {
        const six_two_bits kept = (six_two_bits)x.b & (six_two_bits)six_load((const double *)keep[k]).b;
        x.b = (six_two)(one ? kept | (six_two_bits)six_load(unit[k]).b : kept);
    }
    return x;
}
/* The larger magnitude of each column. */
DMB_BLOCK_KERNEL six_four six_larger(six_four most, six_four x)
{
    const six_four size = (six_four)((six_four_bits)x & INT64_MAX);
    const six_four_bits more = (six_four_bits)(size > most);
    return (six_four)(((six_four_bits)size & more) | ((six_four_bits)most & ~more));
}

/* to[6 j + i] = row[i][j] */
DMB_BLOCK_KERNEL void six_store_columns(const six_row r[6], double *to)
{
#define DMB_PAIR(x, y, ...) __builtin_shufflevector(x, y, __VA_ARGS__)
    const six_four e = DMB_PAIR(r[0].a, r[1].a, 0, 4, 2, 6), o = DMB_PAIR(r[0].a, r[1].a, 1, 5, 3, 7);
    const six_four f = DMB_PAIR(r[2].a, r[3].a, 0, 4, 2, 6), p = DMB_PAIR(r[2].a, r[3].a, 1, 5, 3, 7);
    const six_four g = DMB_PAIR(r[4].a, r[5].a, 0, 4, 2, 6), q = DMB_PAIR(r[4].a, r[5].a, 1, 5, 3, 7);
    const six_row columns[6] = {{DMB_PAIR(e, f, 0, 1, 4, 5), DMB_PAIR(g, g, 0, 1)},
                                {DMB_PAIR(o, p, 0, 1, 4, 5), DMB_PAIR(q, q, 0, 1)},
                                {DMB_PAIR(e, f, 2, 3, 6, 7), DMB_PAIR(g, g, 2, 3)},
                                {DMB_PAIR(o, p, 2, 3, 6, 7), DMB_PAIR(q, q, 2, 3)},
                                {DMB_PAIR(DMB_PAIR(r[0].b, r[1].b, 0, 2), DMB_PAIR(r[2].b, r[3].b, 0, 2), 0, 1, 2, 3),
                                 DMB_PAIR(r[4].b, r[5].b, 0, 2)},
                                {DMB_PAIR(DMB_PAIR(r[0].b, r[1].b, 1, 3), DMB_PAIR(r[2].b, r[3].b, 1, 3), 0, 1, 2, 3),
                                 DMB_PAIR(r[4].b, r[5].b, 1, 3)}};
#undef DMB_PAIR
    for (int j = 0; j < 6; j++) six_store(columns[j], to + 6 * j);
}

#else

typedef double six_number;
typedef struct six_row {
    double x[6];
} six_row;

DMB_BLOCK_KERNEL six_row six_load(const double *from)
{
    six_row x;
    for (int j = 0; j < 6; j++) x.x[j] = from[j];
    return x;
}
DMB_BLOCK_KERNEL void six_store(six_row x, double *to)
{
    for (int j = 0; j < 6; j++) to[j] = x.x[j];
}
DMB_BLOCK_KERNEL six_number six_of(double x)
{
    return x;
}
DMB_BLOCK_KERNEL six_number six_spread(six_row x, int k)
{
    return x.x[k];
}
DMB_BLOCK_KERNEL double six_number_at(six_row x, int k)
{
    return x.x[k];
}
DMB_BLOCK_KERNEL six_row six_times(six_number f, six_row x)
{
    for (int j = 0; j < 6; j++) x.x[j] = f * x.x[j];
    return x;
}
DMB_BLOCK_KERNEL six_row six_plus(six_row x, six_row y)
{
    for (int j = 0; j < 6; j++) x.x[j] += y.x[j];
    return x;
}
DMB_BLOCK_KERNEL six_row six_minus(six_row x, six_row y)
{
    for (int j = 0; j < 6; j++) x.x[j] -= y.x[j];
    return x;
}
DMB_BLOCK_KERNEL six_row six_with(six_row x, int k, int one)
{
    x.x[k] = one ? 1.0 : 0.0;
    return x;
}
DMB_BLOCK_KERNEL void six_store_columns(const six_row r[6], double *to)
{
    for (int j = 0; j < 6; j++)
        for (int i = 0; i < 6; i++) to[6 * j + i] = r[i].x[j];
}

#endif

/* ---- Blocks ------------------------------------------------------------------------------------------------------ */

/* A block during inversion. */
typedef struct six_block {
    six_row a[6];
    int exchanged[6], any;
} six_block;

/* The row whose number k is largest, among row k and those below it; the first of equal ones. */
DMB_BLOCK_KERNEL int six_pivot_row(const six_row a[6], int k)
{
    int p = k;
    double most = fabs(six_number_at(a[k], k));
    DMB_BLOCK_UNROLL
    for (int i = k + 1; i < 6; i++) {
        const double size = fabs(six_number_at(a[i], k));
        if (size > most) most = size, p = i;
    }
    return p;
}

DMB_BLOCK_KERNEL void six_exchange(six_row a[6], int k, int p)
{
    DMB_BLOCK_UNROLL
    for (int i = k + 1; i < 6; i++) {
        if (i != p) continue;
        const six_row t = a[k];
        a[k] = a[i];
        a[i] = t;
    }
}

/* Step k of Gauss-Jordan. Returns 0, or 1 without a pivot. */
DMB_BLOCK_KERNEL int six_invert_step(int k, six_block *d)
{
    const int p = six_pivot_row(d->a, k);
    d->exchanged[k] = p;
    if (p != k) {
        d->any = 1;
        six_exchange(d->a, k, p);
    }
    const double pivot = six_number_at(d->a[k], k);
    if (!dmb_block_pivot_holds(pivot)) return 1;
    const six_row row = six_times(six_of(1.0 / pivot), six_with(d->a[k], k, 1));
    DMB_BLOCK_UNROLL
    for (int i = 0; i < 6; i++)
        if (i != k) d->a[i] = six_minus(six_with(d->a[i], k, 0), six_times(six_spread(d->a[i], k), row));
    d->a[k] = row;
    return 0;
}

DMB_BLOCK_KERNEL void six_begin(const double *D, six_block *d)
{
    for (int i = 0; i < 6; i++) d->a[i] = six_load(D + 6 * i);
    d->any = 0;
}

/* Stores X in D by columns, which are exchanged in reverse order of the rows. */
DMB_BLOCK_KERNEL void six_end(six_block *d, double *D)
{
    six_store_columns(d->a, D);
    if (!d->any) return;
    for (int k = 5; k >= 0; k--)
        if (d->exchanged[k] != k) dmb_block_swap(6, D + 6 * k, D + 6 * d->exchanged[k]);
    for (int i = 0; i < 6; i++) {
        double row[6];
        for (int j = 0; j < 6; j++) row[j] = D[6 * j + i];
        d->a[i] = six_load(row);
    }
}

/* sum_k f[k stride] x[k] */
DMB_BLOCK_KERNEL six_row six_combine(const double *f, int stride, const six_row x[6])
{
    six_row sum = six_times(six_of(f[0]), x[0]);
    DMB_BLOCK_UNROLL
    for (int k = 1; k < 6; k++) sum = six_plus(sum, six_times(six_of(f[k * stride]), x[k]));
    return sum;
}

/* Updates the neighbour: G = L X, D_next -= G U, W = X U; G is stored in L, W in U, by columns. */
DMB_BLOCK_KERNEL void six_pass_on(const six_block *d, const block_parts *p)
{
    six_row G[6], W[6], U[6];
    for (int i = 0; i < 6; i++) G[i] = six_combine(p->L + 6 * i, 1, d->a);
    six_store_columns(G, p->L);
    for (int k = 0; k < 6; k++) U[k] = six_load(p->U + 6 * k);
    DMB_BLOCK_UNROLL
    for (int i = 0; i < 6; i++) {
        six_row next = six_load(p->next + 6 * i);
        DMB_BLOCK_UNROLL
        for (int k = 0; k < 6; k++) next = six_minus(next, six_times(six_of(p->L[6 * k + i]), U[k]));
        six_store(next, p->next + 6 * i);
    }
    for (int i = 0; i < 6; i++) W[i] = six_combine(p->D + i, 6, U);
    six_store_columns(W, p->U);
}

/* Factors one block, or two uncoupled blocks with interleaved steps. Returns 0, or 1 or 2: number of the block without
 * a pivot. */
DMB_BLOCK_KERNEL int six_factor(const block_parts *p)
{
    six_block d;
    six_begin(p->D, &d);
    DMB_BLOCK_UNROLL
    for (int k = 0; k < 6; k++)
        if (six_invert_step(k, &d)) return 1;
    six_end(&d, p->D);
    if (p->next) six_pass_on(&d, p);
    return 0;
}

DMB_BLOCK_KERNEL int six_factor_two(const block_parts *p, const block_parts *q)
{
    six_block d, e;
    six_begin(p->D, &d);
    six_begin(q->D, &e);
    DMB_BLOCK_UNROLL
    for (int k = 0; k < 6; k++) {
        if (six_invert_step(k, &d)) return 1;
        if (six_invert_step(k, &e)) return 2;
    }
    six_end(&d, p->D);
    six_end(&e, q->D);
    six_pass_on(&d, p);
    six_pass_on(&e, q);
    return 0;
}

/* ---- Solutions --------------------------------------------------------------------------------------------------- */

/* A x with two independent sums, of even and of odd columns */
DMB_BLOCK_KERNEL six_row six_product(const double *A, six_row x)
{
    six_row even = six_times(six_spread(x, 0), six_load(A)), odd = six_times(six_spread(x, 1), six_load(A + 6));
    even = six_plus(even, six_times(six_spread(x, 2), six_load(A + 12)));
    odd = six_plus(odd, six_times(six_spread(x, 3), six_load(A + 18)));
    even = six_plus(even, six_times(six_spread(x, 4), six_load(A + 24)));
    odd = six_plus(odd, six_times(six_spread(x, 5), six_load(A + 30)));
    return six_plus(even, odd);
}

/* Neighbour's b -= G x, which is also returned; b <- X x */
DMB_BLOCK_KERNEL six_row six_towards(const double *X, const double *G, six_row x, double *b, double *next)
{
    const six_row passed = six_minus(six_load(next), six_product(G, x));
    six_store(passed, next);
    six_store(six_product(X, x), b);
    return passed;
}

/* b <- b - W x, also returned */
DMB_BLOCK_KERNEL six_row six_away(const double *W, six_row x, double *b)
{
    const six_row y = six_minus(six_load(b), six_product(W, x));
    six_store(y, b);
    return y;
}

/* Solves a whole chain of `count` blocks with the off-diagonal blocks `upper` and `lower`. The two halves are
 * interleaved. */
static inline void six_solve(uint32_t count, const double *diagonal, const double *upper, const double *lower,
                             double *b)
{
    const uint32_t above = count / 2, below = (count - 1) / 2;
    const double *D = diagonal, *G = lower, *E = diagonal + 36 * (size_t)(count - 1);
    const double *H = upper + 36 * (size_t)(count > 1 ? count - 2 : 0);
    double *p = b, *q = b + 6 * (size_t)(count - 1);
    six_row x = six_load(p), y = six_load(q);
    if (above > below) {
        x = six_towards(D, G, x, p, p + 6);
        D += 36, G += 36, p += 6;
    }
    for (uint32_t k = 0; k < below; k++) {
        x = six_towards(D, G, x, p, p + 6);
        y = six_towards(E, H, y, q, q - 6);
        D += 36, G += 36, p += 6;
        E -= 36, H -= 36, q -= 6;
    }
    x = y = six_product(D, six_load(p));
    six_store(x, p);
    const double *W = upper + 36 * (size_t)above, *V = lower + 36 * (size_t)above;
    q = p;
    for (uint32_t k = 0; k < below; k++) {
        W -= 36, p -= 6, q += 6;
        x = six_away(W, x, p);
        y = six_away(V, y, q);
        V += 36;
    }
    if (above > below) six_away(W - 36, x, p - 6);
}

/* The same in the parts of block_inverse.h: 0 the upper end, 1 the lower end, 2 the blocks between them. */
static inline void six_towards_part(uint32_t count, const double *D, const double *upper, const double *lower,
                                    int32_t part, double *b)
{
    const size_t above = count / 2, below = (count - 1) / 2, last = count - 1;
    if (part == 0) {
        six_row x = six_load(b);
        for (size_t i = 0; i + 1 < above; i++) x = six_towards(D + 36 * i, lower + 36 * i, x, b + 6 * i, b + 6 * i + 6);
    } else if (part == 1) {
        six_row y = six_load(b + 6 * last);
        for (size_t i = last; i > above + 1; i--)
            y = six_towards(D + 36 * i, upper + 36 * (i - 1), y, b + 6 * i, b + 6 * (i - 1));
    } else {
        const size_t i = above - 1, j = above + 1;
        if (above > 0) (void)six_towards(D + 36 * i, lower + 36 * i, six_load(b + 6 * i), b + 6 * i, b + 6 * above);
        if (below > 0) (void)six_towards(D + 36 * j, upper + 36 * above, six_load(b + 6 * j), b + 6 * j, b + 6 * above);
        six_store(six_product(D + 36 * above, six_load(b + 6 * above)), b + 6 * above);
    }
}

static inline void six_away_part(uint32_t count, const double *upper, const double *lower, int32_t part, double *b)
{
    const size_t middle = count / 2;
    six_row x = six_load(b + 6 * middle);
    for (size_t i = middle; part == 0 && i-- > 0;) x = six_away(upper + 36 * i, x, b + 6 * i);
    for (size_t i = middle + 1; part == 1 && i < count; i++) x = six_away(lower + 36 * (i - 1), x, b + 6 * i);
}

#endif
