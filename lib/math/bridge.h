/* All calls of LAPACK, the only other library. Analyses use it, steps never: dense eigenproblems, and the rank of a set
 * of equations. Without LAPACK, bridge_eigen.c is used; its results are equal to rounding. Matrices are
 * column-major without gaps; all workspace belongs to the caller. Each function returns 0, or the error code of LAPACK.
 */
#ifndef DMB_MATH_BRIDGE_H
#define DMB_MATH_BRIDGE_H

#include <stddef.h>
#include <stdint.h>

#include "drillmbd/base.h"

/* 1 if the library belongs to the build and can be called; a library that is loaded on demand is loaded by this call.
 */
int dmb_has_lapack(void);

/* Largest number of rows: LAPACK counts its workspace in integers of 32 bits. */
enum { DMB_EIGEN_MAX = 32766 };

/* Doubles of workspace for n rows, of dmb_eigen_symmetric and _pair, and of dmb_eigen_general; SIZE_MAX above
 * DMB_EIGEN_MAX, and if they exceed the address space. */
size_t dmb_eigen_work(size_t n);
size_t dmb_eigen_general_work(size_t n);

/* A x = value x, A symmetric (dsyevd): values ascending; A becomes the orthonormal vectors. */
int32_t dmb_eigen_symmetric(size_t n, double *A, double *values, double *work);
/* K x = value M x, both symmetric, M positive definite (dsygvd): values ascending; K becomes the vectors, X^T M X = I;
 * M is overwritten. A result > n means that M is not positive definite. */
int32_t dmb_eigen_pair(size_t n, double *K, double *M, double *values, double *work);
/* A x = (re + i im) x (dgeev); A is overwritten. Conjugate pairs are adjacent, im > 0 first; the vector of the first is
 * column k of V plus i times column k + 1. */
int32_t dmb_eigen_general(size_t n, double *A, double *re, double *im, double *V, double *work);

/* Rank of a set of equations, by QR with column pivoting of the transposed matrix (LAPACK dgeqp3), and the singular
 * values at its two ends (dgesvd). For analyses only: no step calls this. No allocation: LAPACK works
 * in the caller's memory. */

/* Above this number of equations or coordinates, singular values are estimated from the diagonal of R. */
enum { DMB_RANK_SINGULAR_MAX = 300 };
/* Largest number of equations, and of coordinates: LAPACK counts its workspace in 32 bits. */
enum { DMB_RANK_SIDE_MAX = 1 << 25 };

typedef struct dmb_rank {
    uint32_t rank;
    int32_t exact;            /* 1: the two values below are singular values, 0: estimates */
    double largest, smallest; /* [-] first and rank-th singular value; 1 and 1 if the rank is 0 */
} dmb_rank;

/* Doubles of workspace for a matrix of that shape; SIZE_MAX if that overflows, or a side is above DMB_RANK_SIDE_MAX. */
size_t dmb_rank_work(uint32_t rows, uint32_t columns);

/* Rows in sequence, and weights of the columns. */
typedef struct dmb_weighted_rows {
    const double *values; /* (rows, columns) */
    uint32_t rows, columns;
    const double *weight; /* (columns) */
} dmb_weighted_rows;

/* B: shape (rows, columns), row-major, unchanged. Rows are scaled to unit length in columns times weight (>= 0), as a
 * partition does (constraint/partition.h); rows of zeros (shorter than 1e-300) and rows that are not finite count as
 * redundant. The rank is the number of rows of R before the first diagonal entry of at most `tolerance`.
 * order: shape (rows): the first `rank` rows are independent, the others redundant, in the order of pivoting. */
void dmb_rank_of_rows(const dmb_weighted_rows *of, double tolerance, double *work, int32_t *order, dmb_rank *out);

/* ---- bridge_load.c ----------------------------------------------------------------------------------------------- */

/* Libraries that are loaded when a call first requires them, and remain loaded: a program that only steps never loads
 * them. No data are stored here between calls, so that threads share nothing: opening a library that is already loaded
 * costs the loader some microseconds. */

typedef void (*dmb_foreign)(void);

/* Finds functions by name in the library of that SONAME; returns 0 if the library or one of them is missing. */
int dmb_foreign_load(const char *soname, size_t count, const char *const *names, dmb_foreign *functions);

/* ---- bridge_eigen.c, bridge_eigen_general.c ---------------------------------------------------------------------- */

/* Dense eigenproblems in C only, for builds without LAPACK and for machines on which it cannot be loaded: slower than
 * LAPACK by a few times, equal to rounding. Matrices are column-major without gaps; all workspace belongs to the
 * caller. Each function returns 0, or > 0 if it fails. */

/* A x = value x, A symmetric, only its lower triangle is used: values ascending; A becomes the orthonormal vectors.
 * work: (n^2). */
int32_t dmb_dense_symmetric(size_t n, double *A, double *values, double *work);
/* K x = value M x, both symmetric, M positive definite: values ascending; K becomes the vectors, X^T M X = I; M becomes
 * its Cholesky factor. work: (n^2). A result > n means that M is not positive definite. */
int32_t dmb_dense_pair(size_t n, double *K, double *M, double *values, double *work);
/* A x = (re + i im) x; A is overwritten. Conjugate pairs are adjacent, im > 0 first; the vector of the first is column
 * k of V plus i times column k + 1. Vectors have length 1. work: (5 n). */
int32_t dmb_dense_general(size_t n, double *A, double *re, double *im, double *V, double *work);

/* Householder QR with column pivoting of a (height, width): R in the upper triangle, order[k]: original column, from 0,
 * at position k. work: (height). */
void dmb_dense_pivoted_qr(size_t height, size_t width, double *a, int32_t *order, double *work);
/* Singular values, descending, of the upper trapezoid (n, width), n <= width, of a matrix with columns `height` apart;
 * overwritten. */
void dmb_dense_singular(size_t n, size_t width, size_t height, double *a, double *values);

#endif
