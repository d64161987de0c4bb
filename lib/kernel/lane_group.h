/* Groups of places of a run that are side by side. Their numbers go into lanes and out of them in one of two ways: four
 * numbers of each lane at a time, transposed in registers, where the compiler has a word for that; else one by one. */
#ifndef DMB_KERNEL_LANE_GROUP_H
#define DMB_KERNEL_LANE_GROUP_H

#include <string.h>

#include "math/real.h"

/* The number of values that are loaded is a constant at each call; loops over them are unrolled only in place. They
 * stand once for tests/coverage, which counts their branches. */
#if defined(__GNUC__) && !defined(DMB_COUNTED)
#define DMB_LANES_INLINE static inline __attribute__((always_inline))
#else
#define DMB_LANES_INLINE static inline
#endif
/* Copies of the last group of a run: once, out of the way of all others. */
#if defined(__GNUC__)
#define DMB_LANES_CALL static __attribute__((noinline, unused))
#else
#define DMB_LANES_CALL static inline
#endif

#if defined(DMB_LANES) && defined(__has_builtin)
#if DMB_LANES >= 4 && __has_builtin(__builtin_shufflevector)
#define DMB_LANES_TRANSPOSED
#endif
#endif

/* Places of a group of lanes in a run: behind its end the last one is taken again, and left out when results are
 * stored. */
typedef struct lane_group {
    uint32_t first, used;
} lane_group;

static inline lane_group group_at(uint32_t first, uint32_t count)
{
    const lane_group g = {first, count - first < DMB_REAL_LANES ? count - first : DMB_REAL_LANES};
    return g;
}

static inline size_t place_at(const lane_group *g, uint32_t lane)
{
    return (size_t)g->first + (lane < g->used ? lane : g->used - 1);
}

static inline int is_whole(const lane_group *g)
{
    return DMB_REAL_LANES == 1 || g->used == DMB_REAL_LANES;
}

/* One bit for each lane that is not one again. */
static inline uint32_t lanes_used(const lane_group *g)
{
    return (1u << g->used) - 1;
}

/* Places of lanes in a run of something else. */
typedef struct lane_places {
    size_t place[DMB_REAL_LANES];
    int32_t together; /* 1: the numbers of each lane stand behind those of the one before */
    int32_t reserved;
} lane_places;

/* ---- Numbers that do not stand one lane behind the other: copied to where they do ---------------------------------
 */

/* `count` numbers of each lane from places of `size` numbers to rows of `stride`. */
DMB_LANES_CALL void gather_rest(const double *from, size_t size, uint32_t count, size_t stride, const lane_group *g,
                                double *rows)
{
    for (uint32_t l = 0; l < DMB_REAL_LANES; l++)
        for (uint32_t i = 0; i < count; i++) rows[stride * l + i] = from[size * place_at(g, l) + i];
}

DMB_LANES_CALL void scatter_rest(const double *rows, uint32_t count, const lane_group *g, double *to)
{
    for (size_t i = 0; i < (size_t)count * g->used; i++) to[(size_t)count * g->first + i] = rows[i];
}

DMB_LANES_CALL void gather_places(const double *from, size_t size, uint32_t count, const lane_places *places,
                                  double *rows)
{
    for (uint32_t l = 0; l < DMB_REAL_LANES; l++)
        for (uint32_t i = 0; i < count; i++) rows[count * l + i] = from[size * places->place[l] + i];
}

/* ---- Four numbers of each lane ----------------------------------------------------------------------------------- */

#ifdef DMB_LANES_TRANSPOSED

typedef double lane_row __attribute__((vector_size(32)));
typedef double lane_row_anywhere __attribute__((vector_size(32), aligned(8)));

DMB_LANES_INLINE lane_row load_row(const double *from)
{
    return *(const lane_row_anywhere *)from;
}

DMB_LANES_INLINE void store_row(lane_row row, double *to)
{
    *(lane_row_anywhere *)to = row;
}

/* Pairs of numbers from two vectors, in each half of them alike. */
#if DMB_LANES == 4
#define DMB_LANES_EVEN 0, 4, 2, 6
#define DMB_LANES_ODD 1, 5, 3, 7
#define DMB_LANES_LOW 0, 1, 4, 5
#define DMB_LANES_HIGH 2, 3, 6, 7
#else
#define DMB_LANES_EVEN 0, 8, 2, 10, 4, 12, 6, 14
#define DMB_LANES_ODD 1, 9, 3, 11, 5, 13, 7, 15
#define DMB_LANES_LOW 0, 1, 8, 9, 4, 5, 12, 13
#define DMB_LANES_HIGH 2, 3, 10, 11, 6, 7, 14, 15
#endif

/* x[i]: number i of each lane; out[k]: the four numbers of lane k, and of lane 4 + k; or the other way round. */
DMB_LANES_INLINE void lanes_transpose(const dmb_real x[4], dmb_real out[4])
{
    const dmb_real a = __builtin_shufflevector(x[0], x[1], DMB_LANES_EVEN);
    const dmb_real b = __builtin_shufflevector(x[0], x[1], DMB_LANES_ODD);
    const dmb_real c = __builtin_shufflevector(x[2], x[3], DMB_LANES_EVEN);
    const dmb_real d = __builtin_shufflevector(x[2], x[3], DMB_LANES_ODD);
    out[0] = __builtin_shufflevector(a, c, DMB_LANES_LOW);
    out[1] = __builtin_shufflevector(b, d, DMB_LANES_LOW);
    out[2] = __builtin_shufflevector(a, c, DMB_LANES_HIGH);
    out[3] = __builtin_shufflevector(b, d, DMB_LANES_HIGH);
}

/* The four numbers of one lane, from the first and the second half of transposed vectors. */
#if DMB_LANES == 4
#define DMB_LANES_FIRST(rows, k) (rows)[k]
#define DMB_LANES_JOIN(at, size, k) load_row((at) + (size) * (k))
#else
#define DMB_LANES_FIRST(rows, k) __builtin_shufflevector((rows)[k], (rows)[k], 0, 1, 2, 3)
#define DMB_LANES_SECOND(rows, k) __builtin_shufflevector((rows)[k], (rows)[k], 4, 5, 6, 7)
#define DMB_LANES_JOIN(at, size, k) \
    __builtin_shufflevector(load_row((at) + (size) * (k)), load_row((at) + (size) * (4 + (k))), 0, 1, 2, 3, 4, 5, 6, 7)
#endif

/* Four numbers of each lane, `size` of them from one lane to the next. */
DMB_LANES_INLINE void load_four(const double *at, size_t size, dmb_real x[4])
{
    const dmb_real rows[4] = {DMB_LANES_JOIN(at, size, 0), DMB_LANES_JOIN(at, size, 1), DMB_LANES_JOIN(at, size, 2),
                              DMB_LANES_JOIN(at, size, 3)};
    lanes_transpose(rows, x);
}

DMB_LANES_INLINE void store_four(const dmb_real x[4], size_t size, double *to)
{
    dmb_real rows[4];
    lanes_transpose(x, rows);
    for (int k = 0; k < 4; k++) store_row(DMB_LANES_FIRST(rows, k), to + size * (size_t)k);
#if DMB_LANES == 8
    for (int k = 0; k < 4; k++) store_row(DMB_LANES_SECOND(rows, k), to + size * (size_t)(4 + k));
#endif
}

DMB_LANES_INLINE void add_row(lane_row row, double *to)
{
    store_row(load_row(to) + row, to);
}

DMB_LANES_INLINE void add_four(const dmb_real x[4], uint32_t lanes, double *const to[DMB_REAL_LANES], uint32_t at)
{
    dmb_real rows[4];
    lanes_transpose(x, rows);
    if (lanes & 1) add_row(DMB_LANES_FIRST(rows, 0), to[0] + at);
    if (lanes & 2) add_row(DMB_LANES_FIRST(rows, 1), to[1] + at);
    if (lanes & 4) add_row(DMB_LANES_FIRST(rows, 2), to[2] + at);
    if (lanes & 8) add_row(DMB_LANES_FIRST(rows, 3), to[3] + at);
#if DMB_LANES == 8
    if (lanes & 16) add_row(DMB_LANES_SECOND(rows, 0), to[4] + at);
    if (lanes & 32) add_row(DMB_LANES_SECOND(rows, 1), to[5] + at);
    if (lanes & 64) add_row(DMB_LANES_SECOND(rows, 2), to[6] + at);
    if (lanes & 128) add_row(DMB_LANES_SECOND(rows, 3), to[7] + at);
#endif
}

/* ---- One, two or three numbers of each lane: the vectors in which they stand --------------------------------------
 */

typedef dmb_real dmb_real_anywhere __attribute__((aligned(8)));

DMB_LANES_INLINE dmb_real load_vector(const double *from)
{
    return *(const dmb_real_anywhere *)from;
}

DMB_LANES_INLINE void store_vector(dmb_real x, double *to)
{
    *(dmb_real_anywhere *)to = x;
}

#if DMB_LANES == 4
#define DMB_PAIR_EVEN 0, 2, 4, 6
#define DMB_PAIR_ODD 1, 3, 5, 7
#define DMB_PAIR_LOW 0, 4, 1, 5
#define DMB_PAIR_HIGH 2, 6, 3, 7
#define DMB_THREE_LOAD_0 0, 3, 6, 0
#define DMB_THREE_LOAD_1 1, 4, 7, 0
#define DMB_THREE_LOAD_2 2, 5, 0, 0
#define DMB_THREE_LAST_0 0, 1, 2, 5
#define DMB_THREE_LAST_1 0, 1, 2, 6
#define DMB_THREE_LAST_2 0, 1, 4, 7
#define DMB_THREE_STORE_0 0, 4, 0, 1
#define DMB_THREE_STORE_1 5, 0, 2, 6
#define DMB_THREE_STORE_2 0, 3, 7, 0
#define DMB_THREE_WITH_0 0, 1, 4, 3
#define DMB_THREE_WITH_1 0, 5, 2, 3
#define DMB_THREE_WITH_2 6, 1, 2, 7
#else
#define DMB_PAIR_EVEN 0, 2, 4, 6, 8, 10, 12, 14
#define DMB_PAIR_ODD 1, 3, 5, 7, 9, 11, 13, 15
#define DMB_PAIR_LOW 0, 8, 1, 9, 2, 10, 3, 11
#define DMB_PAIR_HIGH 4, 12, 5, 13, 6, 14, 7, 15
#define DMB_THREE_LOAD_0 0, 3, 6, 9, 12, 15, 0, 0
#define DMB_THREE_LOAD_1 1, 4, 7, 10, 13, 0, 0, 0
#define DMB_THREE_LOAD_2 2, 5, 8, 11, 14, 0, 0, 0
#define DMB_THREE_LAST_0 0, 1, 2, 3, 4, 5, 10, 13
#define DMB_THREE_LAST_1 0, 1, 2, 3, 4, 8, 11, 14
#define DMB_THREE_LAST_2 0, 1, 2, 3, 4, 9, 12, 15
#define DMB_THREE_STORE_0 0, 8, 0, 1, 9, 0, 2, 10
#define DMB_THREE_STORE_1 0, 3, 11, 0, 4, 12, 0, 5
#define DMB_THREE_STORE_2 13, 0, 6, 14, 0, 7, 15, 0
#define DMB_THREE_WITH_0 0, 1, 8, 3, 4, 9, 6, 7
#define DMB_THREE_WITH_1 10, 1, 2, 11, 4, 5, 12, 7
#define DMB_THREE_WITH_2 0, 13, 2, 3, 14, 5, 6, 15
#endif

DMB_LANES_INLINE void load_few(const double *at, size_t stride, uint32_t count, dmb_real *x)
{
    (void)stride; /* it is count */
    const dmb_real a = load_vector(at);
    if (count == 1) {
        x[0] = a;
        return;
    }
    const dmb_real b = load_vector(at + DMB_LANES);
    if (count == 2) {
        x[0] = __builtin_shufflevector(a, b, DMB_PAIR_EVEN);
        x[1] = __builtin_shufflevector(a, b, DMB_PAIR_ODD);
        return;
    }
    const dmb_real c = load_vector(at + 2 * DMB_LANES);
    x[0] = __builtin_shufflevector(__builtin_shufflevector(a, b, DMB_THREE_LOAD_0), c, DMB_THREE_LAST_0);
    x[1] = __builtin_shufflevector(__builtin_shufflevector(a, b, DMB_THREE_LOAD_1), c, DMB_THREE_LAST_1);
    x[2] = __builtin_shufflevector(__builtin_shufflevector(a, b, DMB_THREE_LOAD_2), c, DMB_THREE_LAST_2);
}

DMB_LANES_INLINE void store_few(const dmb_real *x, uint32_t count, double *to)
{
    if (count == 1) {
        store_vector(x[0], to);
        return;
    }
    if (count == 2) {
        store_vector(__builtin_shufflevector(x[0], x[1], DMB_PAIR_LOW), to);
        store_vector(__builtin_shufflevector(x[0], x[1], DMB_PAIR_HIGH), to + DMB_LANES);
        return;
    }
    const dmb_real a = __builtin_shufflevector(x[0], x[1], DMB_THREE_STORE_0);
    const dmb_real b = __builtin_shufflevector(x[0], x[1], DMB_THREE_STORE_1);
    const dmb_real c = __builtin_shufflevector(x[0], x[1], DMB_THREE_STORE_2);
    store_vector(__builtin_shufflevector(a, x[2], DMB_THREE_WITH_0), to);
    store_vector(__builtin_shufflevector(b, x[2], DMB_THREE_WITH_1), to + DMB_LANES);
    store_vector(__builtin_shufflevector(c, x[2], DMB_THREE_WITH_2), to + 2 * DMB_LANES);
}

#else

DMB_LANES_INLINE void load_few(const double *at, size_t stride, uint32_t count, dmb_real *x)
{
    for (uint32_t i = 0; i < count; i++) {
        x[i] = dmb_real_of(at[i]);
        for (int l = 1; l < DMB_REAL_LANES; l++) dmb_real_set_lane(x + i, l, at[stride * (size_t)l + i]);
    }
}

DMB_LANES_INLINE void store_few(const dmb_real *x, uint32_t count, double *to)
{
    for (int l = 0; l < DMB_REAL_LANES; l++)
        for (uint32_t i = 0; i < count; i++) to[count * (uint32_t)l + i] = dmb_real_lane(x + i, l);
}

DMB_LANES_INLINE void add_four(const dmb_real x[4], uint32_t lanes, double *const to[DMB_REAL_LANES], uint32_t at)
{
    for (int l = 0; l < DMB_REAL_LANES; l++)
        for (uint32_t i = 0; lanes >> l & 1 && i < 4; i++) to[l][at + i] += dmb_real_lane(x + i, l);
}

#endif

/* ---- Any number of them ------------------------------------------------------------------------------------------ */

/* x[i] = number i < count of each lane, `stride` numbers from one lane to the next; fewer than four stand close. */
DMB_LANES_INLINE void load_together(const double *at, size_t stride, uint32_t count, dmb_real *x)
{
#ifdef DMB_LANES_TRANSPOSED
    if (count > 3) {
        for (uint32_t i = 0; i + 4 <= count; i += 4) load_four(at + i, stride, x + i);
        if (count % 4 != 0) load_four(at + count - 4, stride, x + count - 4); /* some twice */
        return;
    }
#endif
    load_few(at, stride, count, x);
}

DMB_LANES_INLINE void store_together(const dmb_real *x, uint32_t count, double *to)
{
#ifdef DMB_LANES_TRANSPOSED
    if (count > 3) {
        for (uint32_t i = 0; i + 4 <= count; i += 4) store_four(x + i, count, to + i);
        if (count % 4 != 0) store_four(x + count - 4, count, to + count - 4);
        return;
    }
#endif
    store_few(x, count, to);
}

/* The most numbers of a place, but for blocks of six rows and columns. */
enum { LANES_FEW = 6, LANES_BLOCK = 36 };

/* x[i] = number i of `size` at each place, i < count, `next` places on */
DMB_LANES_INLINE void load(const double *from, size_t size, uint32_t count, const lane_group *g, uint32_t next,
                           dmb_real *x)
{
    const double *at = from + size * ((size_t)g->first + next);
    double rows[DMB_REAL_LANES * LANES_FEW];
    if (!is_whole(g)) {
        gather_rest(from + size * next, size, count, size, g, rows);
        at = rows;
    }
    load_together(at, size, count, x);
}

DMB_LANES_INLINE void load_block(const double *from, const lane_group *g, dmb_real x[LANES_BLOCK])
{
    const double *at = from + LANES_BLOCK * (size_t)g->first;
    double rows[DMB_REAL_LANES * LANES_BLOCK];
    if (!is_whole(g)) {
        gather_rest(from, LANES_BLOCK, LANES_BLOCK, LANES_BLOCK, g, rows);
        at = rows;
    }
    load_together(at, LANES_BLOCK, LANES_BLOCK, x);
}

DMB_LANES_INLINE void store(const dmb_real *x, uint32_t size, const lane_group *g, double *to)
{
    double rows[DMB_REAL_LANES * LANES_FEW];
    const int whole = is_whole(g);
    store_together(x, size, whole ? to + (size_t)size * g->first : rows);
    if (!whole) scatter_rest(rows, size, g, to);
}

DMB_LANES_INLINE void store_block(const dmb_real x[LANES_BLOCK], const lane_group *g, double *to)
{
    double rows[DMB_REAL_LANES * LANES_BLOCK];
    const int whole = is_whole(g);
    store_together(x, LANES_BLOCK, whole ? to + LANES_BLOCK * (size_t)g->first : rows);
    if (!whole) scatter_rest(rows, LANES_BLOCK, g, to);
}

/* x[i] = number i < count behind each place, a place being `size` numbers */
DMB_LANES_INLINE void load_at(const double *from, size_t size, uint32_t count, const lane_places *places, dmb_real *x)
{
    const double *at = from + size * places->place[0];
    double rows[DMB_REAL_LANES * 6];
    if (DMB_REAL_LANES > 1 && !places->together) {
        gather_places(from, size, count, places, rows);
        at = rows;
    }
    load_together(at, count, count, x);
}

/* One number of each place. */
DMB_LANES_INLINE dmb_real load_line(const double *from, const lane_group *g)
{
    dmb_real x;
    load(from, 1, 1, g, 0, &x);
    return x;
}

DMB_LANES_INLINE void store_line(dmb_real x, const lane_group *g, double *to)
{
    store(&x, 1, g, to);
}

/* to += the number of each lane, one after the other */
DMB_LANES_INLINE void add_each(dmb_real x, const lane_group *g, double *to)
{
    double sum = *to;
    if (is_whole(g))
        for (int l = 0; l < DMB_REAL_LANES; l++) sum += dmb_real_lane(&x, l);
    else
        for (uint32_t l = 0; l < g->used; l++) sum += dmb_real_lane(&x, (int)l);
    *to = sum;
}

/* to[l][i] += lane l of x[i], i < count >= 4, for the lanes given, one bit each; lane by lane, for some may go to the
 * same place. */
DMB_LANES_INLINE void add_lanes(const dmb_real *x, uint32_t count, uint32_t lanes, double *const to[DMB_REAL_LANES])
{
    uint32_t i = 0;
    for (; i + 4 <= count; i += 4) add_four(x + i, lanes, to, i);
    if (i == count) return;
    dmb_real rest[4]; /* 0 where it is done */
    for (uint32_t k = 0; k < 4; k++) rest[k] = count - 4 + k < i ? dmb_real_of(0.0) : x[count - 4 + k];
    add_four(rest, lanes, to, count - 4);
}

/* ---- Chains: element l of a run adds to node l and to node l + 1 ------------------------------------------------- */

/* Lane l is lane l - 1 of x; the first is the last one of the group before. */
DMB_LANES_INLINE dmb_real lanes_behind(dmb_real before, dmb_real x)
{
#if DMB_REAL_LANES == 1
    (void)x;
    return before;
#elif !defined(DMB_LANES_TRANSPOSED)
    dmb_real behind = x;
    for (int l = 0; l < DMB_REAL_LANES; l++)
        dmb_real_set_lane(&behind, l, l > 0 ? dmb_real_lane(&x, l - 1) : dmb_real_lane(&before, DMB_REAL_LANES - 1));
    return behind;
#elif DMB_LANES == 4
    return __builtin_shufflevector(before, x, 3, 4, 5, 6);
#else
    return __builtin_shufflevector(before, x, 7, 8, 9, 10, 11, 12, 13, 14);
#endif
}

/* Lane l is lane l + 1 of x; the last one is given. */
DMB_LANES_INLINE dmb_real lanes_ahead(dmb_real x, double last)
{
#if DMB_REAL_LANES == 1
    (void)x;
    return last;
#elif !defined(DMB_LANES_TRANSPOSED)
    dmb_real ahead = dmb_real_of(last);
    for (int l = 0; l + 1 < DMB_REAL_LANES; l++) dmb_real_set_lane(&ahead, l, dmb_real_lane(&x, l + 1));
    return ahead;
#elif DMB_LANES == 4
    return __builtin_shufflevector(x, dmb_real_of(last), 1, 2, 3, 4);
#else
    return __builtin_shufflevector(x, dmb_real_of(last), 1, 2, 3, 4, 5, 6, 7, 8);
#endif
}

/* Numbers of the near and of the far nodes of elements; `last` is the run's last node, which stands for all behind it.
 */
DMB_LANES_INLINE void load_ends(const double *from, uint32_t count, const lane_group *nodes, uint32_t last, dmb_real *a,
                                dmb_real *b)
{
    const uint32_t next = nodes->first + DMB_REAL_LANES;
    const double *far = from + (size_t)count * (next < last ? next : last);
    load(from, count, count, nodes, 0, a);
    for (uint32_t i = 0; i < count; i++) b[i] = lanes_ahead(a[i], far[i]);
}

/* Numbers of the first node, which something else may have added to. */
DMB_LANES_INLINE void chain_begin(const double *to, uint32_t count, dmb_real *before)
{
    for (uint32_t i = 0; i < count; i++) before[i] = dmb_real_of(to[i]);
}

/* Node l of the group gets a of element l and b of element l - 1, as if these had been added to 0 in their order;
 * `before` keeps b for the next group. Nodes are written whole, once: to read them again lane by lane behind wider
 * writes keeps the processor waiting. */
DMB_LANES_INLINE void chain_store(const dmb_real *a, const dmb_real *b, uint32_t count, const lane_group *g,
                                  dmb_real *before, double *to)
{
    dmb_real sum[36];
    for (uint32_t i = 0; i < count; i++) {
        const dmb_real far = b[i] + 0.0; /* no -0, as after 0 + b */
        sum[i] = lanes_behind(before[i], far) + a[i];
        before[i] = far;
    }
    if (count == LANES_BLOCK)
        store_block(sum, g, to);
    else
        store(sum, count, g, to);
}

/* The far node of the last element, `used` being those of the last group. */
DMB_LANES_INLINE void chain_end(const dmb_real *before, uint32_t count, uint32_t used, double *to)
{
    for (uint32_t i = 0; i < count; i++) to[i] += dmb_real_lane(before + i, (int)used - 1);
}

#endif
