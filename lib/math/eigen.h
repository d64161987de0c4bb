/* Dense eigenproblems by LAPACK (eigen_lapacke.c), for analyses: no step calls this. Matrices are column by column
 * without gaps; all work is the caller's. Each returns 0, or what LAPACK says of a failure. */
#ifndef DMB_MATH_EIGEN_H
#define DMB_MATH_EIGEN_H

#include <stddef.h>
#include <stdint.h>

/* Most rows: LAPACK counts its work in integers of 32 bits. */
enum { DMB_EIGEN_MAX = 32766 };

/* Doubles of work for n rows, of dmb_eigen_symmetric and _pair, and of dmb_eigen_general; SIZE_MAX above DMB_EIGEN_MAX,
 * and where they do not fit the address space. */
size_t dmb_eigen_work(size_t n);
size_t dmb_eigen_general_work(size_t n);

/* A x = value x, A symmetric (dsyevd): values ascending; A becomes the orthonormal vectors. */
int32_t dmb_eigen_symmetric(size_t n, double *A, double *values, double *work);
/* K x = value M x, both symmetric, M positive definite (dsygvd): values ascending; K becomes the vectors, X^T M X = I;
 * M is overwritten. > n: M is not positive definite. */
int32_t dmb_eigen_pair(size_t n, double *K, double *M, double *values, double *work);
/* A x = (re + i im) x (dgeev); A is overwritten. Conjugate pairs stand together, im > 0 first, and x of that is column k
 * of V plus i times column k + 1. */
int32_t dmb_eigen_general(size_t n, double *A, double *re, double *im, double *V, double *work);

#endif
