/* Kernels of block elimination are written once, with the sizes n (this block) and m (the next, 0 at the end of a
 * chain) as arguments. DMB_BLOCK_BY_SIZE passes constants for 6-6 and 2-2, so that the compiler generates kernels of
 * fixed size; other pairs use the same source with variable sizes. */
#ifndef DMB_MATH_BLOCK_KERNEL_H
#define DMB_MATH_BLOCK_KERNEL_H

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The kernels must be inlined for constant sizes even if the compiler considers them long. They exist once for
 * tests/coverage, which counts their branches, and in builds for small size (-Os). */
#if defined(__GNUC__) && !defined(DMB_COUNTED) && !defined(__OPTIMIZE_SIZE__)
#define DMB_BLOCK_KERNEL static inline __attribute__((always_inline))
#else
#define DMB_BLOCK_KERNEL static inline
#endif

/* Triangular loops are too irregular for gcc to unroll automatically. */
#if defined(__GNUC__) && !defined(__clang__) && !defined(__OPTIMIZE_SIZE__)
#define DMB_BLOCK_UNROLL _Pragma("GCC unroll 6")
#else
#define DMB_BLOCK_UNROLL
#endif

/* kernel(n, m, ...) with constants for the two frequent pairs of neighbours */
#define DMB_BLOCK_BY_SIZE(kernel, n, m, ...)            \
    ((n) == 6 && (m) == 6   ? kernel(6, 6, __VA_ARGS__) \
     : (n) == 2 && (m) == 2 ? kernel(2, 2, __VA_ARGS__) \
                            : kernel(n, m, __VA_ARGS__))

/* A pivot smaller than this (or not finite) makes a block singular. */
#define DMB_BLOCK_PIVOT_MIN 1e-300
/* A pivot smaller than this fraction of its block (or of stiffness and inertia of its row) is rounding: the unknown is
 * unconstrained. A cantilever of 10000 elements still has 1e-13, 100 m of unsupported pipe 1e-9. */
#define DMB_UNCONSTRAINED_PIVOT 1e-14

/* Report of the weakest pivot: a small ratio means that the unknown is almost unconstrained. */
typedef struct dmb_block_weakest {
    double ratio; /* |pivot| / largest entry of its diagonal block before elimination; infinity if there is no block */
    uint32_t block;   /* index of the block */
    uint32_t unknown; /* index of the unknown inside the block */
} dmb_block_weakest;

static inline bool dmb_block_pivot_holds(double pivot)
{
    return fabs(pivot) >= DMB_BLOCK_PIVOT_MIN && fabs(pivot) <= DBL_MAX;
}

/* Row of the largest entry of column k, among rows k .. n-1 of A (n x n); it becomes row k. */
DMB_BLOCK_KERNEL size_t dmb_block_pivot_row(size_t n, size_t k, const double *A)
{
    size_t p = k;
    for (size_t i = k + 1; i < n; i++)
        if (fabs(A[n * i + k]) > fabs(A[n * p + k])) p = i;
    return p;
}

/* Exchanges two rows of n numbers. */
DMB_BLOCK_KERNEL void dmb_block_swap(size_t n, double *restrict x, double *restrict y)
{
    for (size_t j = 0; j < n; j++) {
        const double t = x[j];
        x[j] = y[j];
        y[j] = t;
    }
}

/* The largest magnitude in a block of n rows and columns. */
static inline double dmb_block_largest(size_t n, const double *D)
{
    double largest = 0.0;
    for (size_t i = 0; i < n * n; i++)
        if (fabs(D[i]) > largest) largest = fabs(D[i]);
    return largest;
}

/* Compares the pivots of a factored block of n >= 1 rows, the reciprocals on its diagonal, with the weakest
 * so far. failed: the column without a pivot, or < 0. */
static inline void dmb_block_watch(size_t n, const double *D, double largest, int64_t failed, uint32_t block,
                                   dmb_block_weakest *weakest)
{
    size_t k = failed < 0 ? 0 : (size_t)failed;
    for (size_t i = 1; failed < 0 && i < n; i++)
        if (fabs(D[(n + 1) * i]) > fabs(D[(n + 1) * k])) k = i;
    const double ratio = failed < 0 ? 1.0 / (fabs(D[(n + 1) * k]) * largest) : 0.0;
    if (!(failed >= 0 || ratio < weakest->ratio)) return;
    weakest->ratio = ratio;
    weakest->block = block;
    weakest->unknown = (uint32_t)k;
}

#endif
