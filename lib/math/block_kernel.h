/* Kernels of block eliminations are written once, with the sizes n (this block) and m (the next, 0 at the end of a
 * chain) as arguments. DMB_BLOCK_BY_SIZE passes constants for 6-6 and 2-2, so the compiler makes kernels of fixed size;
 * other pairs take the same source with sizes from memory. */
#ifndef DMB_MATH_BLOCK_KERNEL_H
#define DMB_MATH_BLOCK_KERNEL_H

/* The kernels must be folded for constant sizes even where the compiler finds them long. */
#if defined(__GNUC__)
#define DMB_BLOCK_KERNEL static inline __attribute__((always_inline))
#else
#define DMB_BLOCK_KERNEL static inline
#endif

/* Triangles are too irregular for gcc to unroll of its own accord. */
#if defined(__GNUC__) && !defined(__clang__)
#define DMB_BLOCK_UNROLL _Pragma("GCC unroll 6")
#else
#define DMB_BLOCK_UNROLL
#endif

/* kernel(n, m, ...) with constants for the two frequent pairs of neighbours */
#define DMB_BLOCK_BY_SIZE(kernel, n, m, ...)            \
    ((n) == 6 && (m) == 6   ? kernel(6, 6, __VA_ARGS__) \
     : (n) == 2 && (m) == 2 ? kernel(2, 2, __VA_ARGS__) \
                            : kernel(n, m, __VA_ARGS__))

#endif
