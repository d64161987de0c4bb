/* Numbers of lanes from memory into vectors and back, in one of two ways: four numbers of each lane at a time,
 * transposed in registers, where the compiler has a word for that; else one by one. */
#ifndef DMB_KERNEL_LANE_VECTORS_H
#define DMB_KERNEL_LANE_VECTORS_H

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

#endif
