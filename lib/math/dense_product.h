/* Products of dense square matrices, column by column without gaps, for analyses: no step calls this. */
#ifndef DMB_MATH_DENSE_PRODUCT_H
#define DMB_MATH_DENSE_PRODUCT_H

#include <stddef.h>

/* A <- X^T A X, all of shape (n, n); work: shape (n + 1, n). O(n^3) */
void dmb_dense_congruence(size_t n, const double *X, double *A, double *work);
/* y = A x, A of shape (n, n). */
void dmb_dense_times(size_t n, const double *A, const double *x, double *y);

#endif
