/* All calls of LAPACK, for analyses: no step calls this. Dense eigenproblems, and the rank of a set of equations.
 * Matrices are column by column without gaps; all work is the caller's. Each returns 0, or what LAPACK says of a
 * failure. */
#ifndef DMB_MATH_BRIDGE_LAPACKE_H
#define DMB_MATH_BRIDGE_LAPACKE_H

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
/* A x = (re + i im) x (dgeev); A is overwritten. Conjugate pairs stand together, im > 0 first, and x of that is column
 * k of V plus i times column k + 1. */
int32_t dmb_eigen_general(size_t n, double *A, double *re, double *im, double *V, double *work);

/* Rank of a set of equations, by QR with column pivoting of the transposed matrix (LAPACK dgeqp3), and the singular
 * values at its two ends (dgesvd). For analyses only: no step calls this. No allocation: LAPACK works
 * in the caller's memory. */

/* Above so many equations or coordinates singular values are estimated by the diagonal of R. */
enum { DMB_RANK_SINGULAR_MAX = 300 };
/* Most equations, and most coordinates: what LAPACK needs is counted in 32 bits. */
enum { DMB_RANK_SIDE_MAX = 1 << 25 };

typedef struct dmb_rank {
    uint32_t rank;
    int32_t exact;            /* 1: the two values below are singular values, 0: estimates */
    double largest, smallest; /* [-] first and rank-th singular value; 1 and 1 where the rank is 0 */
} dmb_rank;

/* Doubles of work for a matrix of that shape; SIZE_MAX if that overflows, or a side is above
 * DMB_RANK_SIDE_MAX. */
size_t dmb_rank_work(uint32_t rows, uint32_t columns);

/* B: shape (rows, columns), row-major, left alone. Rows are scaled to unit length in columns times weight (>= 0), as a
 * partition does (constraint/partition.h); rows of zeros (shorter than 1e-300) and rows that are not finite count as
 * redundant. Row k of R ends the rank when its diagonal is at most `tolerance`.
 * order: shape (rows): the first `rank` rows are independent, the rest redundant, in the order of pivoting. */
void dmb_rank_of_rows(const double *B, uint32_t rows, uint32_t columns, const double *weight, double tolerance,
                      double *work, int32_t *order, dmb_rank *out);

#endif
