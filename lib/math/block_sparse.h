/* Direct solver for block-sparse systems with symmetric pattern and non-symmetric values, for drill strings with
 * branches and loops:
 *
 *     sum_j A_ij x_j = b_i,    A_ij of size_i rows and size_j columns, where the pattern couples i and j
 *
 * Block elimination in the order of the pattern, with row pivoting inside each diagonal block, no allocation, always
 * the same order of operations. Blocks of 6 rows are fast; any size up to the capacity works, 0 too: such a block
 * has no unknowns. Sizes may change from one factorisation to the next.
 *
 * Order of calls: pattern once (block_pattern.h); then per matrix dmb_block_sparse_clear, add values at
 * dmb_block_sparse_diagonal and _entry (or at offsets found once), _factor, _solve as often as needed. */
#ifndef DMB_MATH_BLOCK_SPARSE_H
#define DMB_MATH_BLOCK_SPARSE_H

#include "math/block_kernel.h"
#include "math/block_pattern.h"

/* A matrix. All arrays belong to the caller; each thread has its own values and pivot. Factoring overwrites diagonal
 * blocks by their LU factors with reciprocal pivots, A_kj by A_kk^-1 A_kj if k is eliminated before j, and A_jk by its
 * value when k is eliminated. */
typedef struct dmb_block_sparse {
    double *values;       /* (pattern->values) */
    uint32_t *pivot;      /* (pattern->rows) row of its block exchanged with this one; written by factoring */
    const uint32_t *size; /* (n) present number of rows of block i, 0 .. capacity */
} dmb_block_sparse;

/* A_ii, size_i x size_i, row-major without gaps. */
static inline double *dmb_block_sparse_diagonal(const dmb_block_pattern *pattern, const dmb_block_sparse *matrix,
                                                uint32_t i)
{
    return matrix->values + pattern->diagonal[pattern->position[i]];
}

/* y = A x for a matrix that is not factored; x and y must not overlap, rows as in dmb_block_sparse_solve. Entries of y
 * outside the blocks are unchanged. */
void dmb_block_sparse_multiply(const dmb_block_pattern *pattern, const dmb_block_sparse *matrix, const uint32_t *row,
                               const double *x, double *y);

/* Sets all values to zero, fill included: required before the values of every new factorisation. */
void dmb_block_sparse_clear(const dmb_block_pattern *pattern, dmb_block_sparse *matrix);

/* Factors in place. Returns -1 on success, otherwise the first singular block in the order of elimination, by the
 * caller's number; the matrix is then partly factored. A pivot is invalid below DMB_BLOCK_PIVOT_MIN, or if it is not
 * finite. */
int64_t dmb_block_sparse_factor(const dmb_block_pattern *pattern, dmb_block_sparse *matrix);

/* The same with bitwise equal results, and a report of the weakest pivot: of all blocks, or of the singular block if
 * there is one. The block has the caller's number; ratio is infinite if there are no unknowns. */
int64_t dmb_block_sparse_factor_watched(const dmb_block_pattern *pattern, dmb_block_sparse *matrix,
                                        dmb_block_weakest *weakest);

/* Solves with a factored matrix. rhs: b on entry, x on return; the rows of block i begin at rhs[row[i]] (row: (n)),
 * which may be any place as long as blocks do not overlap. Other entries of rhs are unchanged. */
void dmb_block_sparse_solve(const dmb_block_pattern *pattern, const dmb_block_sparse *matrix, const uint32_t *row,
                            double *rhs);

#endif
