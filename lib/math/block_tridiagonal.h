/* Direct solver for block-tridiagonal systems with blocks of 1 to 6 rows, for the tangent matrix of a drill string:
 *
 *     lower_{i-1} x_{i-1} + diagonal_i x_i + upper_i x_{i+1} = b_i
 *
 * Block elimination with row pivoting inside each diagonal block, cost linear in the number of blocks, no allocation
 * and a fixed order of operations. Several chains may follow each other in one layout: each is a range [first, first +
 * count) of blocks, and the off-diagonal block between two chains is neither read nor written. Different ranges
 * may run in different threads. */
#ifndef DMB_MATH_BLOCK_TRIDIAGONAL_H
#define DMB_MATH_BLOCK_TRIDIAGONAL_H

#include <stddef.h>
#include <stdint.h>

#include "math/block_kernel.h"

#define DMB_BLOCK_SIZE_MAX 6

/* Offsets of the blocks. All arrays belong to the caller. */
typedef struct dmb_block_layout {
    uint32_t n;           /* number of blocks */
    const uint8_t *size;  /* (n) rows of block i, 1..6; 6-6 and 2-2 neighbours are fast */
    const uint32_t *row;  /* (n+1) first row of block i; the last entry is the number of rows */
    const uint32_t *diag; /* (n+1) start of block i in the diagonal storage; the last entry is its length */
    const uint32_t *link; /* (n) start of link i,i+1 in lower and upper; the last entry is their length */
} dmb_block_layout;

/* Lengths required by a layout. */
typedef struct dmb_block_totals {
    uint32_t rows;
    uint32_t diagonal; /* doubles in the diagonal storage */
    uint32_t link;     /* doubles in lower, and as many in upper */
} dmb_block_totals;

/* The blocks, each row-major. Factoring overwrites diagonal by its LU factors with reciprocal pivots and upper_i by
 * diagonal_i^-1 upper_i; they and lower are then column-major, as required by the solver. */
typedef struct dmb_block_matrix {
    double *diagonal; /* size_i x size_i */
    double *lower;    /* lower_i: size_{i+1} x size_i */
    double *upper;    /* upper_i: size_i x size_{i+1} */
    uint8_t *pivot;   /* (rows) row of its block exchanged with this one; written by factoring */
} dmb_block_matrix;

/* Computes the totals for n blocks of the given sizes. Returns 0, or -1 if a size is not 1..6 or a total overflows. */
int32_t dmb_block_count(uint32_t n, const uint8_t *size, dmb_block_totals *totals);

/* Computes row (n+1), diag (n+1) and link (n) from sizes that dmb_block_count has accepted. */
void dmb_block_fill(uint32_t n, const uint8_t *size, uint32_t *row, uint32_t *diag, uint32_t *link);

/* Factors blocks [first, first + count) in place. Returns -1 on success, otherwise the index of the first singular
 * block; the matrix is then partly factored. */
int64_t dmb_block_factor(const dmb_block_layout *layout, dmb_block_matrix *matrix, uint32_t first, uint32_t count);

/* The same with a report of the weakest pivot: of the whole range, or of the singular block if there is one. */
int64_t dmb_block_factor_watched(const dmb_block_layout *layout, dmb_block_matrix *matrix, uint32_t first,
                                 uint32_t count, dmb_block_weakest *weakest);

/* Solves with a factored range. rhs (all rows of the layout): b on entry, x on return, in the rows of the range. */
void dmb_block_solve(const dmb_block_layout *layout, const dmb_block_matrix *matrix, uint32_t first, uint32_t count,
                     double *rhs);

/* y = A x with an unfactored range; x and y (all rows of the layout) must not overlap. */
void dmb_block_multiply(const dmb_block_layout *layout, const dmb_block_matrix *matrix, uint32_t first, uint32_t count,
                        const double *x, double *y);

#endif
