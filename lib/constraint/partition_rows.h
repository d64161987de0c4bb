/* Operations on matrix rows, for the files partition_*.c. Sums use four partial sums, because a single one would limit
 * the speed by its latency; their order is fixed. For rows with few entries the nonzero places are listed: the matrix
 * of a component with many joints is sparse. */
#ifndef DMB_CONSTRAINT_PARTITION_ROWS_H
#define DMB_CONSTRAINT_PARTITION_ROWS_H

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "constraint/partition.h"
#include "math/block_kernel.h"

#define DMB_PARTITION_ROW_MIN 1e-300 /* shorter rows count as zero */
#define DMB_CLEARLY (1.0 + 1e-6)     /* a later candidate for the pivot must be larger by this factor */
#define DMB_PLACES 96                /* largest number of listed places per row */

/* y[j] -= f x[j] */
static inline void row_subtract(size_t n, double f, const double *restrict x, double *restrict y)
{
    for (size_t j = 0; j < n; j++) y[j] -= f * x[j];
}

static inline void row_multiply(size_t n, double f, double *x)
{
    for (size_t j = 0; j < n; j++) x[j] *= f;
}

static inline double dot(size_t n, const double *x, const double *y)
{
    double sum[4] = {0.0, 0.0, 0.0, 0.0};
    size_t j = 0;
    for (; j + 4 <= n; j += 4)
        for (size_t i = 0; i < 4; i++) sum[i] += x[j + i] * y[j + i];
    for (; j < n; j++) sum[0] += x[j] * y[j];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

static inline double larger(double a, double b)
{
    return a > b ? a : b;
}

/* Lists the places of nonzero entries of a row, for row_subtract_at. If there are more than DMB_PLACES or more than a
 * third of the row, none are listed and n is returned. */
static inline size_t find_places(size_t n, const double *x, uint32_t *places)
{
    const size_t most = n / 3 < DMB_PLACES ? n / 3 : DMB_PLACES;
    size_t count = 0;
    for (size_t j = 0; j < n; j++) {
        if (x[j] == 0.0) continue;
        if (count == most) return n;
        places[count++] = (uint32_t)j;
    }
    return count;
}

/* row_subtract, restricted to the places of x if they are listed. */
static inline void row_subtract_at(size_t n, size_t count, const uint32_t *places, double f, const double *restrict x,
                                   double *restrict y)
{
    if (count == n) {
        row_subtract(n, f, x, y);
        return;
    }
    for (size_t i = 0; i < count; i++) y[places[i]] -= f * x[places[i]];
}

static inline double square(double a)
{
    return a * a;
}

/* As dot. */
static inline double sum_of_squares(size_t n, const double *b, const double *weight, double scale)
{
    double sum[4] = {0.0, 0.0, 0.0, 0.0};
    size_t j = 0;
    for (; j + 4 <= n; j += 4)
        for (size_t i = 0; i < 4; i++) sum[i] += square(b[j + i] * weight[j + i] * scale);
    for (; j < n; j++) sum[0] += square(b[j] * weight[j] * scale);
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/* 2-norm of a row in weighted columns. A second pass is made only if squares leave the range of doubles. */
static inline double row_length(size_t n, const double *b, const double *weight)
{
    const double sum = sum_of_squares(n, b, weight, 1.0);
    if (sum > 1e-280 && sum < 1e280) return sqrt(sum);
    const double scale = sum < 1.0 ? 0x1p600 : 0x1p-600;
    return sqrt(sum_of_squares(n, b, weight, scale)) / scale;
}

static inline bool usable(double length)
{
    return length >= DMB_PARTITION_ROW_MIN && length <= DBL_MAX;
}

/* Pivot row k of B. */
static inline const double *pivot_row_of(const double *B, uint32_t stride, const dmb_partition *p, size_t k)
{
    return B + (size_t)p->row_order[k] * stride;
}

/* Nonzero places of a matrix row: the blocks of columns as a set of bits, and the stretches of columns within them. */

#define DMB_STRETCH_BLOCKS 64   /* blocks of columns; a set of them is a uint64_t */
#define DMB_STRETCH_BLOCK_MIN 8 /* columns */
#define DMB_STRETCH_DENSE 32    /* up to this number of columns there is one block and one stretch, including zeros */
#define DMB_STRETCHES 8         /* of a row; columns between further ones count as nonzero */
#define DMB_STRETCH_GAP 3       /* largest number of zeros within a stretch */

/* Stretch from .. to - 1 of columns. */
typedef struct column_range {
    size_t from, to;
} column_range;

static inline size_t block_size(size_t columns)
{
    if (columns <= DMB_STRETCH_DENSE) return DMB_STRETCH_DENSE;
    const size_t size = (columns + DMB_STRETCH_BLOCKS - 1) / DMB_STRETCH_BLOCKS;
    return size > DMB_STRETCH_BLOCK_MIN ? size : DMB_STRETCH_BLOCK_MIN;
}

static inline size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Set of the blocks in which a row has nonzero entries. */
static inline uint64_t find_blocks(size_t n, const double *b)
{
    const size_t size = block_size(n);
    uint64_t blocks = n <= DMB_STRETCH_DENSE, bit = 1;
    for (size_t from = 0; from < n && n > DMB_STRETCH_DENSE; from += size, bit <<= 1) {
        const size_t to = smaller(from + size, n);
        for (size_t j = from; j < to; j++)
            if (b[j] != 0.0) {
                blocks |= bit;
                break;
            }
    }
    return blocks;
}

/* Stretches of nonzero entries of a row, at most DMB_STRETCHES; returns their number. */
static inline size_t find_stretches(size_t n, const double *b, uint64_t blocks, column_range *stretches)
{
    const size_t size = block_size(n);
    size_t count = 0;
    if (n <= DMB_STRETCH_DENSE) {
        stretches[0] = (column_range){0, n};
        return 1;
    }
    for (size_t from = 0; from < n && blocks != 0; from += size, blocks >>= 1) {
        const size_t to = blocks & 1 ? smaller(from + size, n) : from;
        for (size_t j = from; j < to; j++) {
            if (b[j] == 0.0) continue;
            if (count == 0 || (count < DMB_STRETCHES && j > stretches[count - 1].to + DMB_STRETCH_GAP))
                stretches[count++].from = j;
            stretches[count - 1].to = j + 1;
        }
    }
    return count;
}

/* Sum of a_j b_j weight_j^2, in four partial sums as above. */
static inline double weighted_dot(size_t n, const double *a, const double *b, const double *weight)
{
    double sum[4] = {0.0, 0.0, 0.0, 0.0};
    size_t j = 0;
    for (; j + 4 <= n; j += 4)
        for (size_t i = 0; i < 4; i++) sum[i] += a[j + i] * weight[j + i] * (b[j + i] * weight[j + i]);
    for (; j < n; j++) sum[0] += a[j] * weight[j] * (b[j] * weight[j]);
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

static inline double dot_in_stretches(size_t count, const column_range *stretches, const double *a, const double *b,
                                      const double *weight)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) {
        const size_t from = stretches[i].from;
        sum += weighted_dot(stretches[i].to - from, a + from, b + from, weight + from);
    }
    return sum;
}

#endif
