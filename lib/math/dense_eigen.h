/* Dense eigenproblems in C alone, for builds without LAPACK and for machines where it cannot be loaded: slower than
 * LAPACK by a few times, equal to rounding. Matrices are column by column without gaps; all work is the caller's. Each
 * returns 0, or > 0 where it fails. */
#ifndef DMB_MATH_DENSE_EIGEN_H
#define DMB_MATH_DENSE_EIGEN_H

#include <stddef.h>
#include <stdint.h>

/* A x = value x, A symmetric, its lower triangle read: values ascending; A becomes the orthonormal vectors. work:
 * (n^2). */
int32_t dmb_dense_symmetric(size_t n, double *A, double *values, double *work);
/* K x = value M x, both symmetric, M positive definite: values ascending; K becomes the vectors, X^T M X = I; M becomes
 * its Cholesky factor. work: (n^2). > n: M is not positive definite. */
int32_t dmb_dense_pair(size_t n, double *K, double *M, double *values, double *work);
/* A x = (re + i im) x; A is overwritten. Conjugate pairs stand together, im > 0 first, and x of that is column k of V
 * plus i times column k + 1. Vectors have length 1. work: (5 n). */
int32_t dmb_dense_general(size_t n, double *A, double *re, double *im, double *V, double *work);

/* Householder QR with column pivoting of a (height, width): R in the upper triangle, order[k]: column, from 0, that
 * stands at k. work: (height). */
void dmb_dense_pivoted_qr(size_t height, size_t width, double *a, int32_t *order, double *work);
/* Singular values, falling, of the upper trapezoid (n, width), n <= width, of a matrix whose columns are `height`
 * apart; overwritten. */
void dmb_dense_singular(size_t n, size_t width, size_t height, double *a, double *values);

#endif
