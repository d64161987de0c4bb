/* Direct solver for complex block-tridiagonal systems, the layout being that of block_tridiagonal.h:
 *
 *     lower_{i-1} x_{i-1} + diagonal_i x_i + upper_i x_{i+1} = b_i
 *
 * made for the dynamic stiffness K + i w C - w^2 M of a drill string at one frequency. Real and imaginary parts stand
 * in arrays of their own, so that the kernels run along rows of doubles. Block elimination with row pivoting inside
 * each diagonal block, cost linear in the number of blocks, no allocation, always the same order of operations. */
#ifndef DMB_MATH_BLOCK_COMPLEX_H
#define DMB_MATH_BLOCK_COMPLEX_H

#include "math/block_tridiagonal.h"

/* Numbers of one array, real parts and imaginary parts. */
typedef struct dmb_complex_array {
    double *re;
    double *im;
} dmb_complex_array;

/* The blocks, each row-major. Factoring overwrites diagonal by its LU factors with reciprocal pivots, upper_i by
 * diagonal_i^-1 upper_i, and leaves lower as it is. */
typedef struct dmb_complex_block_matrix {
    dmb_complex_array diagonal; /* size_i x size_i */
    dmb_complex_array lower;    /* lower_i: size_{i+1} x size_i */
    dmb_complex_array upper;    /* upper_i: size_i x size_{i+1} */
    uint8_t *pivot;             /* (rows) row of its block exchanged with this one; written by factoring */
} dmb_complex_block_matrix;

/* Factor blocks [first, first + count) in place. -1 when done, else the index of the first singular block, the matrix
 * then being half-way. */
int64_t dmb_complex_block_factor(const dmb_block_layout *layout, const dmb_complex_block_matrix *matrix, uint32_t first,
                                 uint32_t count);

/* Solve with a factored range. rhs (all rows of the layout): b on entry, x on return, in the rows of the range. */
void dmb_complex_block_solve(const dmb_block_layout *layout, const dmb_complex_block_matrix *matrix, uint32_t first,
                             uint32_t count, dmb_complex_array rhs);

#endif
