/* Number of negative eigenvalues of a symmetric block-tridiagonal matrix (Sylvester's law of inertia): what the sign of
 * a stiffness is judged by, and what counts the critical factors below a given one (Sturm sequence). */
#ifndef DMB_MATH_BLOCK_INERTIA_H
#define DMB_MATH_BLOCK_INERTIA_H

#include "math/block_sparse.h"
#include "math/block_tridiagonal.h"

/* Of the symmetric part of blocks [first, first + count), none of them factored; the matrix is left alone. raise (all
 * rows of the layout), if not NULL, is added to its diagonal. A pivot of 0 counts as positive. Linear in the number of
 * blocks. */
uint32_t dmb_block_negative(const dmb_block_layout *layout, const double *diagonal, const double *lower,
                            const double *upper, const double *raise, uint32_t first, uint32_t count);

/* Of a symmetric block-sparse matrix, from its factors: what the elimination has left of each block when its turn came
 * has as many in all as the matrix (Haynsworth 1968). room: the square of the largest block, of those that have more
 * than 6 rows. */
uint32_t dmb_block_sparse_negative(const dmb_block_pattern *pattern, const dmb_block_sparse *factored, double *room);

#endif
