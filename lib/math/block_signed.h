/* Factors of symmetric block-sparse matrices with positive and negative pivots,
 *
 *     A = U^T S U,   S = diag(+-1),
 *
 * such as [I B^T; B 0]: quasi-definite matrices have them in every order of elimination, without exchanges between
 * blocks (Vanderbei, SIAM J. Optim. 5, 1995). In each block the rows with positive pivots come first. Pattern and order
 * are those of block_pattern.h; of the values only the diagonal blocks (upper triangles) and the blocks `upper` are
 * used. No allocation; the order of operations is fixed.
 *
 * A negative pivot is compared with the squared length of its row, stored in `length`: their ratio after elimination is
 * the squared sine of the angle between the row of B and the earlier rows. */
#ifndef DMB_MATH_BLOCK_SIGNED_H
#define DMB_MATH_BLOCK_SIGNED_H

#include "math/block_pattern.h"

typedef struct dmb_block_signed {
    double *values;       /* (pattern->values) */
    const uint32_t *size; /* (n) present number of rows of block i; 0: the block is absent */
    const uint32_t *plus; /* (n) of them with positive pivots, the first ones */
    const uint32_t *row;  /* (n) first row of block i in vectors */
    double *length;       /* (rows) in: square of the length of rows with negative pivots; out: pivot over it */
    uint32_t *order;      /* (rows) workspace of the choice */
} dmb_block_signed;

/* Sets the values of all present blocks to zero. */
void dmb_block_signed_clear(const dmb_block_pattern *pattern, const dmb_block_signed *matrix);
/* Factors in place. A row with a negative pivot below `weak` times its length is excluded: solutions are 0 there and
 * its equation is ignored. Returns -1 on success, otherwise the first block with an invalid pivot (at most 1e-16 of its
 * length, or not finite). */
int64_t dmb_block_signed_factor(const dmb_block_pattern *pattern, const dmb_block_signed *matrix, double weak);
/* The same for a choice of rows: in each block the row with the largest remainder is first; rows below `weak` and rows
 * of zero length are excluded. The values are invalid afterwards; `length` contains the pivots, 0 for excluded rows, in
 * the order of the rows. */
void dmb_block_signed_choose(const dmb_block_pattern *pattern, const dmb_block_signed *matrix, double weak);
/* x <- A^-1 x from the factors. Entries of absent blocks are unchanged. */
void dmb_block_signed_solve(const dmb_block_pattern *pattern, const dmb_block_signed *matrix, double *x);

#endif
