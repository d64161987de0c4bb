/* Direct solver for complex block-sparse systems with symmetric pattern and non-symmetric values,
 *
 *     sum_j A_ij x_j = b_i,    A_ij of size_i rows and size_j columns, where the pattern couples i and j
 *
 * for the dynamic stiffness K + i w C - w^2 M of strings, also if joints connect them. Real and imaginary parts are in
 * separate arrays. Block elimination in the order of the pattern (block_pattern.h), with row pivoting inside each
 * diagonal block; no allocation and a fixed order of operations; blocks may have any size from 0 up to their capacity.
 */
#ifndef DMB_MATH_COMPLEX_SPARSE_H
#define DMB_MATH_COMPLEX_SPARSE_H

#include "math/block_pattern.h"
#include "math/block_tridiagonal.h"

/* An array of complex numbers, real parts and imaginary parts. */
typedef struct dmb_complex_array {
    double *re;
    double *im;
} dmb_complex_array;

/* Each block is row-major without gaps, at its offset in the pattern. Factoring overwrites diagonal blocks by their LU
 * factors with reciprocal pivots, A_kj by A_kk^-1 A_kj if k is eliminated before j, and A_jk by its value when k is
 * eliminated. */
typedef struct dmb_complex_sparse {
    dmb_complex_array values; /* (pattern->values) */
    uint32_t *pivot;          /* (pattern->rows) row of its block exchanged with this one; written by factoring */
    const uint32_t *size;     /* (n) present number of rows of block i, 0 .. capacity */
} dmb_complex_sparse;

/* All values are required, 0 in the fill. Returns -1 on success, otherwise the first singular block in the order of
 * elimination; the matrix is then partly factored. */
int64_t dmb_complex_sparse_factor(const dmb_block_pattern *pattern, const dmb_complex_sparse *matrix);
/* b on entry, x on return; the rows of block i begin at rhs[row[i]]. */
void dmb_complex_sparse_solve(const dmb_block_pattern *pattern, const dmb_complex_sparse *matrix, const uint32_t *row,
                              dmb_complex_array rhs);

/* ---- Chains ------------------------------------------------------------------------------------------------------ */

/* The pattern of a chain is its layout (block_tridiagonal.h): each block is coupled with the next one only,
 *
 *     lower_{i-1} x_{i-1} + diagonal_i x_i + upper_i x_{i+1} = b_i
 *
 * and the order is that of the chain. Factoring overwrites diagonal and upper as above; lower is unchanged. */
typedef struct dmb_complex_block_matrix {
    dmb_complex_array diagonal; /* size_i x size_i */
    dmb_complex_array lower;    /* lower_i: size_{i+1} x size_i */
    dmb_complex_array upper;    /* upper_i: size_i x size_{i+1} */
    uint32_t *pivot;            /* (rows) row of its block exchanged with this one; written by factoring */
} dmb_complex_block_matrix;

/* Factors blocks [first, first + count) in place. Returns -1 on success, otherwise the index of the first singular
 * block; the matrix is then partly factored. */
int64_t dmb_complex_block_factor(const dmb_block_layout *layout, const dmb_complex_block_matrix *matrix, uint32_t first,
                                 uint32_t count);
/* Solves with a factored range. rhs (all rows of the layout): b on entry, x on return, in the rows of the range. */
void dmb_complex_block_solve(const dmb_block_layout *layout, const dmb_complex_block_matrix *matrix, uint32_t first,
                             uint32_t count, dmb_complex_array rhs);

#endif
