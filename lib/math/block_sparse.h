/* Direct solver for block-sparse systems of symmetric pattern and unsymmetric values, made for drill strings with
 * branches and loops:
 *
 *     sum_j A_ij x_j = b_i,    A_ij of size_i rows and size_j columns, there where the pattern couples i and j
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
 * blocks by their LU factors with reciprocal pivots, A_kj by A_kk^-1 A_kj where k is eliminated before j, and A_jk by
 * what is left of it when k's turn comes. */
typedef struct dmb_block_sparse {
    double *values;       /* (pattern->values) */
    uint32_t *pivot;      /* (pattern->rows) row of its block exchanged with this one; written by factoring */
    const uint32_t *size; /* (n) rows of block i now, 0 .. capacity */
} dmb_block_sparse;

/* A_ii, size_i x size_i, row-major without gaps. */
static inline double *dmb_block_sparse_diagonal(const dmb_block_pattern *pattern, const dmb_block_sparse *matrix,
                                                uint32_t i)
{
    return matrix->values + pattern->diagonal[pattern->position[i]];
}

/* y = A x, not factored; x and y apart, rows as in dmb_block_sparse_solve. Entries of y outside the blocks are left
 * alone. */
void dmb_block_sparse_multiply(const dmb_block_pattern *pattern, const dmb_block_sparse *matrix, const uint32_t *row,
                               const double *x, double *y);

/* All values zero, fill included: has to come before the values of every new factorisation. */
void dmb_block_sparse_clear(const dmb_block_pattern *pattern, dmb_block_sparse *matrix);

/* Factor in place. -1 when done, else the first singular block met in the order of elimination, by the caller's number;
 * the matrix is half-way then. A pivot is too small below DMB_BLOCK_PIVOT_MIN, or when it is not finite. */
int64_t dmb_block_sparse_factor(const dmb_block_pattern *pattern, dmb_block_sparse *matrix);

/* The same, same bits, also reporting the weakest pivot: of all blocks, or the failing one when a block is singular.
 * The block goes by the caller's number; ratio is infinite where there is no unknown at all. */
int64_t dmb_block_sparse_factor_watched(const dmb_block_pattern *pattern, dmb_block_sparse *matrix,
                                        dmb_block_weakest *weakest);

/* Solve with a factored matrix. rhs: b on entry, x on return; the rows of block i begin at rhs[row[i]] (row: (n)) and
 * stand where the caller wants them, as long as blocks do not overlap. Other entries of rhs are left alone. */
void dmb_block_sparse_solve(const dmb_block_pattern *pattern, const dmb_block_sparse *matrix, const uint32_t *row,
                            double *rhs);

#endif
