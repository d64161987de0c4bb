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

#if defined(DMB_LANES) && defined(__has_builtin)
#if DMB_LANES >= 4 && __has_builtin(__builtin_shufflevector)
#define DMB_LANES_TRANSPOSED
#endif
#endif

/* Places of a group of lanes in a run: behind its end the last one is taken again, and left out when results are
 * stored. */
typedef struct lane_group {
    size_t place[DMB_REAL_LANES];
    uint32_t used;
} lane_group;

static inline lane_group group_at(uint32_t first, uint32_t count)
{
    lane_group g;
    g.used = count - first < DMB_REAL_LANES ? count - first : DMB_REAL_LANES;
    for (uint32_t l = 0; l < DMB_REAL_LANES; l++) g.place[l] = l < g.used ? first + l : count - 1;
    return g;
}

/* One bit for each lane that is not one again. */
static inline uint32_t lanes_used(const lane_group *g)
{
    return (1u << g->used) - 1;
}

/* A number of each lane. */
DMB_LANES_INLINE dmb_real load_one(const double *from, size_t size, const lane_group *g)
{
    dmb_real x = dmb_real_of(from[size * g->place[0]]);
    for (int l = 1; l < DMB_REAL_LANES; l++) dmb_real_set_lane(&x, l, from[size * g->place[l]]);
    return x;
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
#define DMB_LANES_JOIN(from, size, g, k) load_row((from) + (size) * (g)->place[k])
#else
#define DMB_LANES_FIRST(rows, k) __builtin_shufflevector((rows)[k], (rows)[k], 0, 1, 2, 3)
#define DMB_LANES_SECOND(rows, k) __builtin_shufflevector((rows)[k], (rows)[k], 4, 5, 6, 7)
#define DMB_LANES_JOIN(from, size, g, k)                                                                              \
    __builtin_shufflevector(load_row((from) + (size) * (g)->place[k]), load_row((from) + (size) * (g)->place[4 + k]), \
                            0, 1, 2, 3, 4, 5, 6, 7)
#endif

DMB_LANES_INLINE void load_four(const double *from, size_t size, const lane_group *g, dmb_real x[4])
{
    const dmb_real rows[4] = {DMB_LANES_JOIN(from, size, g, 0), DMB_LANES_JOIN(from, size, g, 1),
                              DMB_LANES_JOIN(from, size, g, 2), DMB_LANES_JOIN(from, size, g, 3)};
    lanes_transpose(rows, x);
}

DMB_LANES_INLINE void store_four(const dmb_real x[4], size_t size, const lane_group *g, double *to)
{
    dmb_real rows[4];
    lanes_transpose(x, rows);
    store_row(DMB_LANES_FIRST(rows, 0), to + size * g->place[0]);
    if (g->used > 1) store_row(DMB_LANES_FIRST(rows, 1), to + size * g->place[1]);
    if (g->used > 2) store_row(DMB_LANES_FIRST(rows, 2), to + size * g->place[2]);
    if (g->used > 3) store_row(DMB_LANES_FIRST(rows, 3), to + size * g->place[3]);
#if DMB_LANES == 8
    if (g->used > 4) store_row(DMB_LANES_SECOND(rows, 0), to + size * g->place[4]);
    if (g->used > 5) store_row(DMB_LANES_SECOND(rows, 1), to + size * g->place[5]);
    if (g->used > 6) store_row(DMB_LANES_SECOND(rows, 2), to + size * g->place[6]);
    if (g->used > 7) store_row(DMB_LANES_SECOND(rows, 3), to + size * g->place[7]);
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

#else

DMB_LANES_INLINE void load_four(const double *from, size_t size, const lane_group *g, dmb_real x[4])
{
    for (uint32_t i = 0; i < 4; i++) x[i] = load_one(from + i, size, g);
}

DMB_LANES_INLINE void store_four(const dmb_real x[4], size_t size, const lane_group *g, double *to)
{
    for (uint32_t l = 0; l < g->used; l++)
        for (uint32_t i = 0; i < 4; i++) to[size * g->place[l] + i] = dmb_real_lane(x + i, (int)l);
}

DMB_LANES_INLINE void add_four(const dmb_real x[4], uint32_t lanes, double *const to[DMB_REAL_LANES], uint32_t at)
{
    for (int l = 0; l < DMB_REAL_LANES; l++)
        for (uint32_t i = 0; lanes >> l & 1 && i < 4; i++) to[l][at + i] += dmb_real_lane(x + i, l);
}

#endif

/* ---- Any number of them ------------------------------------------------------------------------------------------ */

/* x[i] = numbers i of `size` at each place, i < count */
DMB_LANES_INLINE void load(const double *from, size_t size, uint32_t count, const lane_group *g, uint32_t next,
                           dmb_real *x)
{
    uint32_t i = 0;
    from += size * next;
    for (; i + 4 <= count; i += 4) load_four(from + i, size, g, x + i);
    if (i < count && count > 4) /* some twice */
        load_four(from + count - 4, size, g, x + count - 4);
    else
        for (; i < count; i++) x[i] = load_one(from + i, size, g);
}

DMB_LANES_INLINE void store(const dmb_real *x, uint32_t size, const lane_group *g, double *to)
{
    uint32_t i = 0;
    for (; i + 4 <= size; i += 4) store_four(x + i, size, g, to + i);
    if (i < size && size > 4)
        store_four(x + size - 4, size, g, to + size - 4);
    else
        for (; i < size; i++)
            for (uint32_t l = 0; l < g->used; l++) to[size * g->place[l] + i] = dmb_real_lane(x + i, (int)l);
}

/* One number of each place, in groups whose places follow one another. */
DMB_LANES_INLINE dmb_real load_line(const double *from, const lane_group *g)
{
    dmb_real x;
    if (g->used < DMB_REAL_LANES) return load_one(from, 1, g);
    memcpy(&x, from + g->place[0], sizeof x);
    return x;
}

DMB_LANES_INLINE void store_line(dmb_real x, const lane_group *g, double *to)
{
    if (g->used < DMB_REAL_LANES)
        store(&x, 1, g, to);
    else
        memcpy(to + g->place[0], &x, sizeof x);
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
    store(sum, count, g, to);
}

/* The far node of the last element, `used` being those of the last group. */
DMB_LANES_INLINE void chain_end(const dmb_real *before, uint32_t count, uint32_t used, double *to)
{
    for (uint32_t i = 0; i < count; i++) to[i] += dmb_real_lane(before + i, (int)used - 1);
}

#endif
