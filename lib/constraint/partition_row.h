/* Rows of matrices, for the files partition_*.c. Sums run in four parts, because one would wait for itself; their order
 * is fixed. Of rows with few entries the places are listed: a cluster of many joints is sparse. */
#ifndef DMB_CONSTRAINT_PARTITION_ROW_H
#define DMB_CONSTRAINT_PARTITION_ROW_H

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "constraint/partition.h"

#define DMB_PARTITION_ROW_MIN 1e-300 /* shorter rows count as zero */
#define DMB_CLEARLY (1.0 + 1e-6)     /* a later candidate for pivot must be larger by this factor */
#define DMB_PLACES 96                /* listed of a row at a time */

/* y[j] -= f x[j] */
static inline void row_subtract(size_t n, double f, const double *restrict x, double *restrict y)
{
    for (size_t j = 0; j < n; j++) y[j] -= f * x[j];
}

static inline void row_multiply(size_t n, double f, double *x)
{
    for (size_t j = 0; j < n; j++) x[j] *= f;
}

static inline void row_swap(size_t n, double *restrict x, double *restrict y)
{
    for (size_t j = 0; j < n; j++) {
        const double t = x[j];
        x[j] = y[j];
        y[j] = t;
    }
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

/* Places of what is not zero in a row, for row_subtract_at: none are listed, and n returned, where they are more than
 * DMB_PLACES or more than a third. */
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

/* row_subtract, only at the places of x if they are listed. */
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

/* 2-norm of a row in weighted columns. A second pass, only where squares leave the range of doubles. */
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

#endif
