/* Factors of symmetric block-sparse matrices of which some pivots are positive and the others negative,
 *
 *     A = U^T S U,   S = diag(+-1),
 *
 * such as [I B^T; B 0]: quasi-definite matrices have them in every order of elimination, without exchanges between
 * blocks (Vanderbei, SIAM J. Optim. 5, 1995). In each block the rows with positive pivots come first. Pattern and order
 * are those of block_pattern.h; of the values only the diagonal blocks (upper triangles) and the blocks `upper` are
 * used. No allocation, always the same order of operations.
 *
 * A negative pivot is judged against the length of its row, the square that stands in `length`: what elimination leaves
 * of it is the square of the sine of the angle between the row of B and those before it. */
#ifndef DMB_MATH_BLOCK_SIGNED_H
#define DMB_MATH_BLOCK_SIGNED_H

#include "math/block_pattern.h"

typedef struct dmb_block_signed {
    double *values;       /* (pattern->values) */
    const uint32_t *size; /* (n) rows of block i now; 0: it is not there */
    const uint32_t *plus; /* (n) of them with positive pivots, the first ones */
    const uint32_t *row;  /* (n) where the rows of block i begin in vectors */
    double *length;       /* (rows) in: square of the length of rows with negative pivots; out: pivot over it */
    uint32_t *order;      /* (rows) room for choosing */
} dmb_block_signed;

/* Zeros where the blocks that are there have their values. */
void dmb_block_signed_clear(const dmb_block_pattern *pattern, const dmb_block_signed *matrix);
/* Factors in place. A row with a negative pivot of less than `weak` of its length is left out: solutions have 0 there
 * and its equation is not counted. -1 when done, else the first block with a pivot that is none (at most 1e-16 of its
 * length, or not finite). */
int64_t dmb_block_signed_factor(const dmb_block_pattern *pattern, const dmb_block_signed *matrix, double weak);
/* The same for a choice of rows: in each block the longest remainder first, rows below `weak` left out, also such of no
 * length. The values are of no use afterwards; `length` has the pivots, 0 of rows left out, in the order of the
 * rows. */
void dmb_block_signed_choose(const dmb_block_pattern *pattern, const dmb_block_signed *matrix, double weak);
/* x <- A^-1 x by factors. Entries of other blocks are left alone. */
void dmb_block_signed_solve(const dmb_block_pattern *pattern, const dmb_block_signed *matrix, double *x);

#endif
