/* Groups of places of a run that are side by side: how their numbers go into lanes and out of them, and how the
 * elements of a chain add to their nodes. */
#ifndef DMB_KERNEL_LANE_GROUP_H
#define DMB_KERNEL_LANE_GROUP_H

#include "kernel/lane_vectors.h"

/* Copies of the last group of a run: once, out of the way of all others. */
#if defined(__GNUC__)
#define DMB_LANES_CALL static __attribute__((noinline, unused))
#else
#define DMB_LANES_CALL static inline
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
DMB_LANES_CALL void load_rest(const double *from, size_t size, uint32_t count, size_t stride, const lane_group *g,
                              double *rows)
{
    for (uint32_t l = 0; l < DMB_REAL_LANES; l++)
        for (uint32_t i = 0; i < count; i++) rows[stride * l + i] = from[size * place_at(g, l) + i];
}

DMB_LANES_CALL void scatter_rest(const double *rows, uint32_t count, const lane_group *g, double *to)
{
    for (size_t i = 0; i < (size_t)count * g->used; i++) to[(size_t)count * g->first + i] = rows[i];
}

DMB_LANES_CALL void load_lane_places(const double *from, size_t size, uint32_t count, const lane_places *places,
                                     double *rows)
{
    for (uint32_t l = 0; l < DMB_REAL_LANES; l++)
        for (uint32_t i = 0; i < count; i++) rows[count * l + i] = from[size * places->place[l] + i];
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
        load_rest(from + size * next, size, count, size, g, rows);
        at = rows;
    }
    load_together(at, size, count, x);
}

DMB_LANES_INLINE void load_block(const double *from, const lane_group *g, dmb_real x[LANES_BLOCK])
{
    const double *at = from + LANES_BLOCK * (size_t)g->first;
    double rows[DMB_REAL_LANES * LANES_BLOCK];
    if (!is_whole(g)) {
        load_rest(from, LANES_BLOCK, LANES_BLOCK, LANES_BLOCK, g, rows);
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
        load_lane_places(from, size, count, places, rows);
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
