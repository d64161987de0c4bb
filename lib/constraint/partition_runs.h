/* Where a row of a matrix is not zero: the blocks of columns, a set of bits, and the runs of columns within them. */
#ifndef DMB_CONSTRAINT_PARTITION_RUNS_H
#define DMB_CONSTRAINT_PARTITION_RUNS_H

#include <stddef.h>
#include <stdint.h>

#define DMB_RUN_BLOCKS 64   /* of columns; a set of them is a uint64_t */
#define DMB_RUN_BLOCK_MIN 8 /* columns */
#define DMB_RUN_DENSE 32    /* so many columns, or fewer, are one block and one run, whatever is zero */
#define DMB_RUNS 8          /* of a row; what lies between further ones counts as not zero */
#define DMB_RUN_GAP 3       /* zeros within a run */

/* Stretch from .. to - 1 of columns. */
typedef struct run {
    size_t from, to;
} run;

static inline size_t block_size(size_t columns)
{
    if (columns <= DMB_RUN_DENSE) return DMB_RUN_DENSE;
    const size_t size = (columns + DMB_RUN_BLOCKS - 1) / DMB_RUN_BLOCKS;
    return size > DMB_RUN_BLOCK_MIN ? size : DMB_RUN_BLOCK_MIN;
}

static inline size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Blocks in which a row is not zero. */
static inline uint64_t find_blocks(size_t n, const double *b)
{
    const size_t size = block_size(n);
    uint64_t blocks = n <= DMB_RUN_DENSE, bit = 1;
    for (size_t from = 0; from < n && n > DMB_RUN_DENSE; from += size, bit <<= 1) {
        const size_t to = smaller(from + size, n);
        for (size_t j = from; j < to; j++)
            if (b[j] != 0.0) {
                blocks |= bit;
                break;
            }
    }
    return blocks;
}

/* Runs of what is not zero in a row, at most DMB_RUNS; returns their number. */
static inline size_t find_runs(size_t n, const double *b, uint64_t blocks, run *runs)
{
    const size_t size = block_size(n);
    size_t count = 0;
    if (n <= DMB_RUN_DENSE) {
        runs[0] = (run){0, n};
        return 1;
    }
    for (size_t from = 0; from < n && blocks != 0; from += size, blocks >>= 1) {
        const size_t to = blocks & 1 ? smaller(from + size, n) : from;
        for (size_t j = from; j < to; j++) {
            if (b[j] == 0.0) continue;
            if (count == 0 || (count < DMB_RUNS && j > runs[count - 1].to + DMB_RUN_GAP)) runs[count++].from = j;
            runs[count - 1].to = j + 1;
        }
    }
    return count;
}

/* Sum of a_j b_j weight_j^2, in four parts as in partition_row.h. */
static inline double weighted_dot(size_t n, const double *a, const double *b, const double *weight)
{
    double sum[4] = {0.0, 0.0, 0.0, 0.0};
    size_t j = 0;
    for (; j + 4 <= n; j += 4)
        for (size_t i = 0; i < 4; i++) sum[i] += a[j + i] * weight[j + i] * (b[j + i] * weight[j + i]);
    for (; j < n; j++) sum[0] += a[j] * weight[j] * (b[j] * weight[j]);
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

static inline double dot_in_runs(size_t count, const run *runs, const double *a, const double *b, const double *weight)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) {
        const size_t from = runs[i].from;
        sum += weighted_dot(runs[i].to - from, a + from, b + from, weight + from);
    }
    return sum;
}

#endif
